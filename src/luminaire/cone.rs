//! Light cone: illuminance on the axis and the size of the lit patch at distances, and the equivalent cone of the beam.

use super::beam::{BEAM_FRACTION, Definition, angles};
use super::distribution::{Distribution, System};

/// What the beam makes on a plane across the axis at one distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConeRow {
    /// Distance from the luminaire along its axis (nadir; the photometric axis for Types A and B), m.
    pub distance_m: f64,
    /// Illuminance on the axis, lx (W/m² for radiometric tables), the luminaire taken as a point: I/d².
    pub axis_lx: f64,
    /// Width of the beam along C0–C180 and along C90–C270, m: `2 d tan(β/2)` of the beam angle β, as if it lay evenly about the
    /// axis; `None` where the plane is dark or its beam is 180° or wider.
    pub width_m: [Option<f64>; 2],
}

/// Rows of the cone diagram for the half-peak beam ([`Definition::Fwhm`]) at the distances given, metres.
#[must_use]
pub fn cone(distribution: &Distribution, distances_m: &[f64]) -> Vec<ConeRow> {
    let beam = angles(distribution, BEAM_FRACTION, Definition::Fwhm);
    let axis = distribution.at(0.0, 0.0);
    let row = |distance_m: &f64| {
        let width = |angle: f64| (angle < 180.0).then(|| 2.0 * distance_m * (0.5 * angle).to_radians().tan());
        ConeRow {
            distance_m: *distance_m,
            axis_lx: axis / (distance_m * distance_m),
            width_m: [beam.c0_c180, beam.c90_c270].map(|angle| angle.and_then(width)),
        }
    };
    distances_m.iter().map(row).collect()
}

/// The circular cone that stands for a beam of any shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EquivalentCone {
    /// Full angle of the circular cone whose solid angle is that of the beam, degrees: `2 acos(1 − Ω/2π)`.
    pub angle_deg: f64,
    /// Solid angle of all directions with at least half of the maximum, sr.
    pub solid_angle_sr: f64,
    /// Flux in these directions, lm (W for radiometric tables).
    pub flux: f64,
}

/// Cells per degree of the sum over directions.
const CELLS_PER_DEG: u32 = 2;

/// The equivalent cone of the half-peak beam; `None` for a dark table.
///
/// The directions are summed in cells of ½° × ½° of the table's own angles with their exact solid angles; a beam of 10° is met
/// within 0.05°.
#[must_use]
pub fn equivalent_cone(distribution: &Distribution) -> Option<EquivalentCone> {
    let (peak, ..) = distribution.peak();
    if peak <= 0.0 {
        return None;
    }
    let (h0, h1, v0, v1) = match distribution.system() {
        System::TypeC => (0, 360, 0, 180),
        System::TypeA | System::TypeB => (-90, 90, -90, 90),
    };
    let step = 1.0 / f64::from(CELLS_PER_DEG);
    let cells = |from: i32, to: i32| {
        (0..(to - from).unsigned_abs() * CELLS_PER_DEG).map(move |i| f64::from(from) + step * (f64::from(i) + 0.5))
    };
    // Solid angle of a cell: its width about the axis times the exact integral of the latitude's measure.
    let half = 0.5 * step.to_radians();
    let measure = |h: f64, v: f64| {
        2.0 * half
            * 2.0
            * half.sin()
            * match distribution.system() {
                System::TypeC => v.to_radians().sin(),
                System::TypeA => v.to_radians().cos(),
                System::TypeB => h.to_radians().cos(),
            }
    };
    let (mut solid_angle_sr, mut flux) = (0.0, 0.0);
    for h in cells(h0, h1) {
        for v in cells(v0, v1) {
            let value = distribution.at(h, v);
            if value >= BEAM_FRACTION * peak {
                solid_angle_sr += measure(h, v);
                flux += value * measure(h, v);
            }
        }
    }
    let angle_deg = 2.0 * (1.0 - solid_angle_sr / std::f64::consts::TAU).clamp(-1.0, 1.0).acos().to_degrees();
    Some(EquivalentCone { angle_deg, solid_angle_sr, flux })
}

#[cfg(test)]
mod tests {
    use super::super::distribution::Symmetry;
    use super::*;

    #[test]
    fn a_round_beam_is_its_own_equivalent() {
        // Half of the maximum at 15°.
        let d = Distribution::new(
            System::TypeC,
            Symmetry::Rotational,
            vec![0.0],
            vec![0.0, 30.0, 90.0],
            vec![1000.0, 0.0, 0.0],
        )
        .expect("sound");
        let e = equivalent_cone(&d).expect("lit");
        assert!((e.angle_deg - 30.0).abs() < 0.05, "{e:?}");
        assert!((e.flux / d.flux_between(0.0, 15.0) - 1.0).abs() < 1e-3);
        let rows = cone(&d, &[1.0, 2.0]);
        assert!((rows[1].axis_lx - 250.0).abs() < 1e-12);
        let width = 4.0 * 15f64.to_radians().tan();
        assert!(rows[1].width_m.iter().all(|w| (w.expect("lit") - width).abs() < 1e-12));
    }
}

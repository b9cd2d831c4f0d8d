//! Light cone: illuminance on the axis and the size of the lit patch at distances, and the equivalent cone of the beam.

use super::beam::{BEAM_FRACTION, Definition, angles};
use super::distribution::{Distribution, Symmetry, System, locate};

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
const CELLS_PER_DEG: f64 = 2.0;

/// The equivalent cone of the half-peak beam; `None` for a dark table.
///
/// The tabulated directions are summed in cells of ½° × ½° of the table's own angles with their exact solid angles, and counted
/// as often as the symmetry repeats them; a beam of 10° is met within 0.05°.
#[must_use]
pub fn equivalent_cone(distribution: &Distribution) -> Option<EquivalentCone> {
    let (peak, ..) = distribution.peak();
    if peak <= 0.0 {
        return None;
    }
    let system = distribution.system();
    let horizontal = distribution.horizontal_deg();
    let (across, step_h) = match distribution.symmetry() {
        Symmetry::Rotational => (vec![(0, 0.0, horizontal[0])], 360.0),
        _ => cells(horizontal),
    };
    let (along, step_v) = cells(distribution.vertical_deg());
    // Solid angle of a cell: its width about the axis times the exact integral of the latitude's measure.
    let (about, latitude) = if system == System::TypeB { (step_v, step_h) } else { (step_h, step_v) };
    let cell_sr = distribution.copies() * about.to_radians() * 2.0 * (0.5 * latitude.to_radians()).sin();
    let planes = horizontal.len();
    let mut row = vec![0.0; planes];
    let (mut solid_angle_sr, mut flux) = (0.0, 0.0);
    for &(i, t, v) in &along {
        for (plane, value) in row.iter_mut().enumerate() {
            let values = distribution.plane(plane);
            *value = values[i] + t * (values[(i + 1).min(values.len() - 1)] - values[i]);
        }
        for &(j, s, h) in &across {
            let value = row[j] + s * (row[(j + 1).min(planes - 1)] - row[j]);
            if value >= BEAM_FRACTION * peak {
                let measure = match system {
                    System::TypeC => v.to_radians().sin(),
                    System::TypeA => v.to_radians().cos(),
                    System::TypeB => h.to_radians().cos(),
                };
                solid_angle_sr += cell_sr * measure;
                flux += cell_sr * measure * value;
            }
        }
    }
    let angle_deg = 2.0 * (1.0 - solid_angle_sr / std::f64::consts::TAU).clamp(-1.0, 1.0).acos().to_degrees();
    Some(EquivalentCone { angle_deg, solid_angle_sr, flux })
}

/// Cells of about ½° between the first and the last angle: where the middle of each lies among the angles (index, fraction), and
/// its angle; and the width of a cell, degrees.
fn cells(angles: &[f64]) -> (Vec<(usize, f64, f64)>, f64) {
    let (first, span) = (angles[0], angles[angles.len() - 1] - angles[0]);
    let count = (span * CELLS_PER_DEG).ceil();
    let step = if count > 0.0 { span / count } else { 0.0 };
    let middle = |i: u32| {
        let angle = first + step * (f64::from(i) + 0.5);
        let (index, fraction) = locate(angles, angle);
        (index, fraction, angle)
    };
    ((0..count as u32).map(middle).collect(), step)
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

//! Beam and field angles in the two principal planes, in the three definitions that are in use.

use super::cut::Cut;
use super::distribution::Distribution;

/// Which two directions an angle lies between; `fraction` is ½ for the beam and ⅒ for the field angle.
///
/// Three definitions because makers, standards and programs differ, and on batwing or noisy distributions by tens of degrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Definition {
    /// Full width at a fraction of the *plane's* maximum: from that maximum outwards, both ways, to the first direction below.
    Fwhm,
    /// Between the outermost directions of the plane that reach the fraction of the maximum of *all* planes (IES LM-35, NEMA FA 1).
    Outermost,
    /// From nadir outwards, both ways, to the first direction below the fraction of the intensity at nadir (CIE 121, EN 13032-2
    /// half-peak angle of lamps that are brightest on the axis).
    OfNadir,
}

impl Definition {
    /// All definitions, in the order of the reports.
    pub const ALL: [Self; 3] = [Self::Fwhm, Self::Outermost, Self::OfNadir];

    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fwhm => "fwhm",
            Self::Outermost => "outermost",
            Self::OfNadir => "of_nadir",
        }
    }
}

/// An angle in both principal planes, degrees; `None` where the plane is dark (or, by its definition, dark at nadir).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneAngles {
    /// How it is defined.
    pub definition: Definition,
    /// In the plane C0–C180; for Types A and B along the horizontal angle at V = 0.
    pub c0_c180: Option<f64>,
    /// In the plane C90–C270; for Types A and B along the vertical angle at H = 0.
    pub c90_c270: Option<f64>,
}

/// Fraction of the maximum (or of nadir) that bounds the beam.
pub const BEAM_FRACTION: f64 = 0.5;
/// Fraction that bounds the field.
pub const FIELD_FRACTION: f64 = 0.1;

/// Beam angles (½) in all definitions.
#[must_use]
pub fn beam_angles(distribution: &Distribution) -> [PlaneAngles; 3] {
    Definition::ALL.map(|d| angles(distribution, BEAM_FRACTION, d))
}

/// Field angles (⅒) in all definitions.
#[must_use]
pub fn field_angles(distribution: &Distribution) -> [PlaneAngles; 3] {
    Definition::ALL.map(|d| angles(distribution, FIELD_FRACTION, d))
}

/// The angle at a fraction in both principal planes. Crossings between the table's entries are those of its interpolation; a plane
/// that never falls below the fraction ends where its table ends.
#[must_use]
pub fn angles(distribution: &Distribution, fraction: f64, definition: Definition) -> PlaneAngles {
    let along = |plane_deg: f64| {
        let limits = Cut::of(distribution, plane_deg).limits(fraction, definition, distribution.peak().0);
        limits.map(|(low, high)| high - low)
    };
    PlaneAngles { definition, c0_c180: along(0.0), c90_c270: along(90.0) }
}

#[cfg(test)]
mod tests {
    use super::super::distribution::{Symmetry, System};
    use super::*;

    #[test]
    fn a_batwing_shows_the_three_definitions_apart() {
        // Peak 100 at 40°, 30 at nadir, zero at 60°.
        let d = Distribution::new(
            System::TypeC,
            Symmetry::Rotational,
            vec![0.0],
            vec![0.0, 40.0, 60.0],
            vec![30.0, 100.0, 0.0],
        )
        .expect("a sound table");
        let [fwhm, outermost, nadir] = beam_angles(&d).map(|a| a.c0_c180.expect("lit"));
        // One wing: from 40 − 50/70·40 to 40 + 10.
        assert!((fwhm - (50.0 - 40.0 * 20.0 / 70.0)).abs() < 1e-12, "{fwhm}");
        assert!((outermost - 100.0).abs() < 1e-12);
        // 15 on the outer flank: 40 + 17.
        assert!((nadir - 114.0).abs() < 1e-12);
    }

    #[test]
    fn dark_planes_have_no_angle() {
        let dark = |v: Vec<f64>| {
            Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vec![0.0, 90.0], v).expect("sound")
        };
        assert!(beam_angles(&dark(vec![0.0, 0.0])).iter().all(|a| a.c0_c180.is_none()));
        let [fwhm, outermost, nadir] = beam_angles(&dark(vec![0.0, 1.0])).map(|a| a.c90_c270);
        assert!(fwhm.is_some() && outermost.is_some() && nadir.is_none());
    }
}

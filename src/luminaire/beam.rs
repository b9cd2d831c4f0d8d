//! Beam and field angles in the two principal planes, in the three definitions that are in use.

use super::distribution::{Distribution, Interpolation, System};

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
    let along = |first: bool| Slice::of(distribution, first).angle(fraction, definition, distribution.peak().0);
    PlaneAngles { definition, c0_c180: along(true), c90_c270: along(false) }
}

/// A cut through the axis: signed angle from it, degrees ascending, and the value there.
struct Slice<'d> {
    distribution: &'d Distribution,
    /// Along C0–C180 or the horizontal angle, else across.
    first: bool,
    angles: Vec<f64>,
    values: Vec<f64>,
}

impl<'d> Slice<'d> {
    fn of(distribution: &'d Distribution, first: bool) -> Self {
        let angles = match (distribution.system(), first) {
            // C180 (C270) counts negative; both halves share the value at nadir, which is that of C0 (C90).
            (System::TypeC, _) => mirrored(distribution.vertical_deg()),
            (_, true) if distribution.horizontal_deg()[0] >= 0.0 => mirrored(distribution.horizontal_deg()),
            (_, true) => distribution.horizontal_deg().to_vec(),
            (_, false) => distribution.vertical_deg().to_vec(),
        };
        let mut slice = Self { distribution, first, angles, values: Vec::new() };
        slice.values = slice.angles.iter().map(|a| slice.at(*a)).collect();
        slice
    }

    fn at(&self, angle: f64) -> f64 {
        match (self.distribution.system(), self.first) {
            (System::TypeC, _) => {
                let c = if self.first { 0.0 } else { 90.0 } + if angle < 0.0 { 180.0 } else { 0.0 };
                self.distribution.at(c, angle.abs())
            }
            (_, true) => self.distribution.at(angle, 0.0),
            (_, false) => self.distribution.at(0.0, angle),
        }
    }

    fn angle(&self, fraction: f64, definition: Definition, peak: f64) -> Option<f64> {
        match definition {
            Definition::Fwhm => {
                let top = (0..self.values.len()).rev().max_by(|a, b| self.values[*a].total_cmp(&self.values[*b]))?;
                self.outwards(top, fraction * self.values[top])
            }
            Definition::OfNadir => {
                let axis = self.angles.iter().position(|a| *a == 0.0)?;
                self.outwards(axis, fraction * self.values[axis])
            }
            Definition::Outermost => self.outermost(fraction * peak),
        }
    }

    /// Width about an entry up to the first value below the threshold on either side.
    fn outwards(&self, from: usize, threshold: f64) -> Option<f64> {
        if threshold <= 0.0 {
            return None;
        }
        let low = (0..from).rev().find(|&i| self.values[i] < threshold);
        let high = (from + 1..self.values.len()).find(|&i| self.values[i] < threshold);
        let low = low.map_or(self.angles[0], |i| self.crossing(i, i + 1, threshold));
        let high = high.map_or(self.angles[self.angles.len() - 1], |i| self.crossing(i, i - 1, threshold));
        Some(high - low)
    }

    /// Width between the outermost entries that reach the threshold.
    fn outermost(&self, threshold: f64) -> Option<f64> {
        if threshold <= 0.0 {
            return None;
        }
        let first = self.values.iter().position(|v| *v >= threshold)?;
        let last = self.values.iter().rposition(|v| *v >= threshold)?;
        let low = if first == 0 { self.angles[0] } else { self.crossing(first - 1, first, threshold) };
        let end = self.values.len() - 1;
        let high = if last == end { self.angles[end] } else { self.crossing(last + 1, last, threshold) };
        Some(high - low)
    }

    /// Angle between an entry below the threshold and a neighbour that reaches it.
    fn crossing(&self, below: usize, above: usize, threshold: f64) -> f64 {
        if self.distribution.interpolation() == Interpolation::MonotoneCubic {
            // Monotone between the two: halving the interval until nothing is left of it finds the only crossing.
            let (mut low, mut high) = (self.angles[below], self.angles[above]);
            for _ in 0..f64::MANTISSA_DIGITS {
                let middle = 0.5 * (low + high);
                *if self.at(middle) < threshold { &mut low } else { &mut high } = middle;
            }
            return 0.5 * (low + high);
        }
        let t = (threshold - self.values[below]) / (self.values[above] - self.values[below]);
        self.angles[below] + t * (self.angles[above] - self.angles[below])
    }
}

/// Non-negative angles and their negatives, zero once.
fn mirrored(angles: &[f64]) -> Vec<f64> {
    let negative = angles.iter().rev().filter(|a| **a > 0.0).map(|a| -a);
    negative.chain(angles.iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::distribution::Symmetry;
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

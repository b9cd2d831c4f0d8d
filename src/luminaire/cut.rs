//! A cut through the photometric axis: intensity over one signed angle, as beam angles and diagrams need it.

use glam::DVec3;

use super::beam::Definition;
use super::distribution::{Distribution, Interpolation, System};

/// Intensity in one plane through the axis. Between entries it is interpolated as the distribution is; beyond them it is zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut<'d> {
    distribution: &'d Distribution,
    /// C of the positive half, degrees.
    plane_deg: f64,
    /// Signed angle from the axis, degrees, strictly ascending: positive in the half-plane asked for, negative in the one across.
    pub angles_deg: Vec<f64>,
    /// The intensity at each, in the distribution's unit.
    pub values: Vec<f64>,
}

/// Step of cuts through Type A and B tables that run along neither of their angles, degrees.
const STEP_DEG: f64 = 0.5;

impl<'d> Cut<'d> {
    /// The cut through the half-planes at `plane_deg` (C, degrees) and `plane_deg + 180`.
    ///
    /// For Type C its entries are the table's γ. For Types A and B, 0 is the cut along the horizontal angle at V = 0, 90 the one
    /// along the vertical angle at H = 0, with the table's entries; planes between are sampled every half degree.
    #[must_use]
    pub fn of(distribution: &'d Distribution, plane_deg: f64) -> Self {
        let plane_deg = plane_deg.rem_euclid(360.0);
        let native = (distribution.system() != System::TypeC).then_some(plane_deg);
        let angles_deg = match native {
            // C180 (C270) counts negative; both halves share the value at nadir, which is that of C0 (C90).
            None => mirrored(distribution.vertical_deg()),
            Some(0.0) if distribution.horizontal_deg()[0] >= 0.0 => mirrored(distribution.horizontal_deg()),
            Some(0.0) => distribution.horizontal_deg().to_vec(),
            Some(90.0) => distribution.vertical_deg().to_vec(),
            Some(_) => (-180..=180).map(|i| STEP_DEG * f64::from(i)).collect(),
        };
        let mut cut = Self { distribution, plane_deg, angles_deg, values: Vec::new() };
        cut.values = cut.angles_deg.iter().map(|a| cut.at(*a)).collect();
        cut
    }

    /// The intensity at a signed angle from the axis, degrees.
    #[must_use]
    pub fn at(&self, angle_deg: f64) -> f64 {
        let d = self.distribution;
        if d.system() == System::TypeC {
            return d.at(self.plane_deg + if angle_deg < 0.0 { 180.0 } else { 0.0 }, angle_deg.abs());
        }
        match self.plane_deg {
            0.0 => d.at(angle_deg, 0.0),
            90.0 => d.at(0.0, angle_deg),
            roll => {
                let (sin, cos) = angle_deg.to_radians().sin_cos();
                let (sin_roll, cos_roll) = roll.to_radians().sin_cos();
                d.towards(DVec3::new(sin * cos_roll, sin * sin_roll, -cos))
            }
        }
    }

    /// The two signed angles, degrees, between which the intensity reaches `fraction` by the definition; `peak` is the maximum of
    /// all planes. `None` where the plane (or, by its definition, nadir) is dark.
    #[must_use]
    pub fn limits(&self, fraction: f64, definition: Definition, peak: f64) -> Option<(f64, f64)> {
        match definition {
            Definition::Fwhm => {
                let top = (0..self.values.len()).rev().max_by(|a, b| self.values[*a].total_cmp(&self.values[*b]))?;
                self.outwards(top, fraction * self.values[top])
            }
            Definition::OfNadir => {
                let axis = self.angles_deg.iter().position(|a| *a == 0.0)?;
                self.outwards(axis, fraction * self.values[axis])
            }
            Definition::Outermost => self.outermost(fraction * peak),
        }
    }

    /// Angles about an entry up to the first value below the threshold on either side.
    fn outwards(&self, from: usize, threshold: f64) -> Option<(f64, f64)> {
        if threshold <= 0.0 {
            return None;
        }
        let low = (0..from).rev().find(|&i| self.values[i] < threshold);
        let high = (from + 1..self.values.len()).find(|&i| self.values[i] < threshold);
        let low = low.map_or(self.angles_deg[0], |i| self.crossing(i, i + 1, threshold));
        let high = high.map_or(self.angles_deg[self.angles_deg.len() - 1], |i| self.crossing(i, i - 1, threshold));
        Some((low, high))
    }

    /// Angles of the outermost entries that reach the threshold.
    fn outermost(&self, threshold: f64) -> Option<(f64, f64)> {
        if threshold <= 0.0 {
            return None;
        }
        let first = self.values.iter().position(|v| *v >= threshold)?;
        let last = self.values.iter().rposition(|v| *v >= threshold)?;
        let low = if first == 0 { self.angles_deg[0] } else { self.crossing(first - 1, first, threshold) };
        let end = self.values.len() - 1;
        let high = if last == end { self.angles_deg[end] } else { self.crossing(last + 1, last, threshold) };
        Some((low, high))
    }

    /// Angle between an entry below the threshold and a neighbour that reaches it.
    fn crossing(&self, below: usize, above: usize, threshold: f64) -> f64 {
        if self.distribution.interpolation() == Interpolation::MonotoneCubic {
            // Monotone between the two: halving the interval until nothing is left of it finds the only crossing.
            let (mut low, mut high) = (self.angles_deg[below], self.angles_deg[above]);
            for _ in 0..f64::MANTISSA_DIGITS {
                let middle = 0.5 * (low + high);
                *if self.at(middle) < threshold { &mut low } else { &mut high } = middle;
            }
            return 0.5 * (low + high);
        }
        let t = (threshold - self.values[below]) / (self.values[above] - self.values[below]);
        self.angles_deg[below] + t * (self.angles_deg[above] - self.angles_deg[below])
    }
}

/// Non-negative angles and their negatives, zero once.
fn mirrored(angles: &[f64]) -> Vec<f64> {
    let negative = angles.iter().rev().filter(|a| **a > 0.0).map(|a| -a);
    negative.chain(angles.iter().copied()).collect()
}

//! Bins in half and difference angles of an isotropic, reciprocal material: the layout of the MERL tables.
//!
//! Bin (h, d, p) covers
//!
//! ```text
//! θ_h: ((h … h+1)/n_h)² · 90°      narrow at the mirror direction
//! θ_d: (d … d+1)/n_d · 90°
//! φ_d: (p … p+1)/n_p · 180°        φ_d and φ_d + 180° are one place (reciprocity)
//! ```
//!
//! A look-up finds its bin without an arc function: sin²θ_h, sin²θ_d and a ratio that rises with φ_d are compared with the bins'
//! borders, of which one step into a table of some thousand cells leaves a single one each. The bin is that of the exact
//! angles except within rounding (1e-14 rad) of a border.
//!
//! Reference: W. Matusik et al., *A Data-Driven Reflectance Model*, ACM Trans. Graph. 22 (2003).

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::axis::zone;
use super::{Channel, Entry, Error, Known};
use crate::brdf::coordinates::HalfDiff;

/// Number of bins in θ_h, θ_d, φ_d.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resolution {
    /// Bins in θ_h, 1 to 180.
    pub theta_h: usize,
    /// Bins in θ_d, 1 to 180.
    pub theta_d: usize,
    /// Bins in φ_d, 1 to 360.
    pub phi_d: usize,
}

impl Resolution {
    /// The MERL tables': 90 × 90 × 180.
    pub const MERL: Self = Self { theta_h: 90, theta_d: 90, phi_d: 180 };

    /// Number of bins.
    #[must_use]
    pub fn bins(self) -> usize {
        self.theta_h * self.theta_d * self.phi_d
    }

    /// Half and difference angles in the middle of a bin (of √θ_h, θ_d, φ_d); φ_h is 0.
    #[must_use]
    pub fn centre(self, bin: usize) -> HalfDiff {
        let [h, d, p] = self.unflatten(bin).map(|i| i as f64 + 0.5);
        HalfDiff {
            theta_h: (h / self.theta_h as f64).powi(2) * FRAC_PI_2,
            phi_h: 0.0,
            theta_d: d / self.theta_d as f64 * FRAC_PI_2,
            phi_d: p / self.phi_d as f64 * PI,
        }
    }

    fn unflatten(self, bin: usize) -> [usize; 3] {
        [bin / (self.theta_d * self.phi_d), bin / self.phi_d % self.theta_d, bin % self.phi_d]
    }

    fn check(self) -> Result<(), Error> {
        let within = |what, n: usize, most: usize, expected| match n {
            n if (1..=most).contains(&n) => Ok(()),
            n => Err(Error::Range { what, value: n as f64, expected }),
        };
        within("bins in θ_h", self.theta_h, 180, "1 to 180")?;
        within("bins in θ_d", self.theta_d, 180, "1 to 180")?;
        within("bins in φ_d", self.phi_d, 360, "1 to 360")
    }
}

/// A table of bins, three or any other number of channels.
#[derive(Debug, Clone, PartialEq)]
pub struct HalfAngle {
    resolution: Resolution,
    channels: Vec<Channel>,
    /// Bin by bin (φ_d fastest), the channels of a bin side by side: a look-up touches one cache line. NaN where missing.
    values: Vec<f32>,
    half: Borders,
    difference: Borders,
    azimuth: Borders,
}

impl HalfAngle {
    /// A table of values in 1/sr, bin by bin with φ_d running fastest, then θ_d, then θ_h; the channels of a bin side by side.
    /// NaN marks a bin as missing (in all its channels, if in one).
    ///
    /// # Errors
    /// [`Error::Range`] for numbers of bins out of range, [`Error::Count`] for another number of values.
    pub fn new(resolution: Resolution, channels: Vec<Channel>, mut values: Vec<f32>) -> Result<Self, Error> {
        resolution.check()?;
        let expected = resolution.bins() * channels.len();
        if values.len() != expected || expected == 0 {
            return Err(Error::Count { what: "values", found: values.len(), expected });
        }
        for bin in values.chunks_exact_mut(channels.len()) {
            if bin.iter().any(|v| !v.is_finite()) {
                bin.fill(f32::NAN);
            }
        }
        let Resolution { theta_h, theta_d, phi_d } = resolution;
        let squared_sine = |angle: f64| angle.sin().powi(2);
        let half_border = |i: f64| squared_sine((i / theta_h as f64).powi(2) * FRAC_PI_2);
        let half = Borders::new(theta_h, 1.0, half_border, fourth_root);
        let difference = Borders::new(theta_d, 1.0, |i| squared_sine(i / theta_d as f64 * FRAC_PI_2), |s| s);
        let azimuth = Borders::new(phi_d, 2.0, |i| pseudo_angle(i / phi_d as f64 * PI), |p| p);
        Ok(Self { resolution, channels, values, half, difference, azimuth })
    }

    /// Number of bins per angle.
    #[must_use]
    pub fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// What the values of a bin belong to.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The values of a bin; NaN where it is missing.
    #[must_use]
    pub fn bin(&self, bin: usize) -> &[f32] {
        let n = self.channels.len();
        &self.values[bin * n..][..n]
    }

    /// Number of bins, and how many are missing.
    #[must_use]
    pub fn coverage(&self) -> (usize, usize) {
        let bins = self.values.chunks_exact(self.channels.len());
        (bins.len(), bins.filter(|b| b[0].is_nan()).count())
    }

    /// The bin of two directions above the horizon.
    #[must_use]
    #[inline]
    pub fn bin_of(&self, incident: DVec3, outgoing: DVec3) -> usize {
        let h = incident + outgoing;
        let across2 = h.x * h.x + h.y * h.y;
        let length2 = across2 + h.z * h.z;
        let (along, sideways) = if across2 > 0.0 {
            // Both times |h| |h_xy|.
            let along = h.z * (h.x * incident.x + h.y * incident.y) - across2 * incident.z;
            (along, length2.sqrt() * (h.x * incident.y - h.y * incident.x))
        } else {
            (incident.x, incident.y)
        };
        // φ_d modulo 180°: the half plane of positive sines. Without a branch, as nobody can guess the sign.
        let turned = (sideways < 0.0) | ((sideways == 0.0) & (along < 0.0));
        let along = f64::from_bits(along.to_bits() ^ u64::from(turned) << 63);
        let sum = along.abs() + sideways.abs();
        let h = self.half.find(across2, length2, fourth_root);
        // |ω_i + ω_o|² + |ω_i − ω_o|² = 4 for unit vectors.
        let d = self.difference.find(4.0 - length2, 4.0, |s| s);
        // Where θ_d is 0 there is no azimuth.
        let p = if sum > 0.0 { self.azimuth.find(sum - along, sum, |p| p) } else { 0 };
        (h * self.resolution.theta_d + d) * self.resolution.phi_d + p
    }

    /// The values of the bin of two directions above the horizon, in single precision as they are kept; NaN where it is missing.
    #[must_use]
    #[inline]
    pub fn nearest(&self, incident: DVec3, outgoing: DVec3) -> &[f32] {
        self.bin(self.bin_of(incident, outgoing))
    }

    /// Writes the values of the bin of two directions above the horizon. A missing bin takes those of the measured one nearest
    /// in θ_d, at the same θ_h and φ_d.
    pub fn value(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) -> Known {
        let bin = self.bin_of(incident, outgoing);
        let (found, known) = match self.bin(bin)[0].is_nan() {
            false => (bin, Known::Measured),
            true => match self.measured_beside(bin) {
                Some(found) => (found, Known::Inferred),
                None => (bin, Known::Missing),
            },
        };
        values.iter_mut().zip(self.bin(found)).for_each(|(v, b)| *v = f64::from(*b));
        known
    }

    /// Visits the middles of the bins that have values and lie above the horizon. A bin's measure is the exact integral of
    /// dω_i dω_o = 4 cosθ_d dω_h dω_d over it.
    pub fn entries(&self, visit: &mut dyn FnMut(&Entry<'_>)) {
        let r = self.resolution;
        let square = |i: f64| (i / r.theta_h as f64).powi(2) * FRAC_PI_2;
        let half: Vec<(f64, f64, f64)> = (0..r.theta_h)
            .map(|h| {
                let (sin, cos) = square(h as f64 + 0.5).sin_cos();
                (sin, cos, zone([square(h as f64), square(h as f64 + 1.0)]))
            })
            .collect();
        let border = |d: usize| d as f64 / r.theta_d as f64 * FRAC_PI_2;
        let difference: Vec<(f64, f64, f64)> = (0..r.theta_d)
            .map(|d| {
                let (sin, cos) = (0.5 * (border(d) + border(d + 1))).sin_cos();
                (sin, cos, 2.0 * (border(d + 1).sin().powi(2) - border(d).sin().powi(2)))
            })
            .collect();
        let azimuth: Vec<(f64, f64)> =
            (0..r.phi_d).map(|p| ((p as f64 + 0.5) / r.phi_d as f64 * PI).sin_cos()).collect();
        let mut values = vec![0.0; self.channels.len()];
        for (bin, stored) in self.values.chunks_exact(self.channels.len()).enumerate() {
            if stored[0].is_nan() {
                continue;
            }
            let [h, d, p] = r.unflatten(bin);
            let ((sin_h, cos_h, zone_h), (sin_d, cos_d, zone_d), (sin_p, cos_p)) = (half[h], difference[d], azimuth[p]);
            let (x, y) = (sin_d * cos_p, sin_d * sin_p);
            let incident = DVec3::new(cos_h * x + sin_h * cos_d, y, cos_h * cos_d - sin_h * x);
            let outgoing = DVec3::new(sin_h * cos_d - cos_h * x, -y, cos_h * cos_d + sin_h * x);
            if incident.z > 0.0 && outgoing.z > 0.0 {
                values.iter_mut().zip(stored).for_each(|(v, s)| *v = f64::from(*s));
                visit(&Entry { incident, outgoing, measure: zone_h * zone_d, values: &values });
            }
        }
    }

    fn measured_beside(&self, bin: usize) -> Option<usize> {
        let [h, d, p] = self.resolution.unflatten(bin);
        let at = |d: usize| (h * self.resolution.theta_d + d) * self.resolution.phi_d + p;
        let steps = 1..self.resolution.theta_d;
        let beside = steps.flat_map(|s| [d.checked_sub(s), Some(d + s).filter(|d| *d < self.resolution.theta_d)]);
        beside.flatten().map(at).find(|&b| !self.bin(b)[0].is_nan())
    }
}

/// Rises with θ_h almost as √θ_h does, as the borders do.
fn fourth_root(s: f32) -> f32 {
    s.sqrt().sqrt()
}

/// 1 − cosφ/(|cosφ| + sinφ): rises from 0 to 2 with φ from 0 to π.
fn pseudo_angle(phi: f64) -> f64 {
    let (sin, cos) = phi.sin_cos();
    1.0 - cos / (cos.abs() + sin.abs())
}

/// Borders of bins in a measure that rises with the angle, and the bin that each of many equal cells begins in.
///
/// The cells are so narrow that none holds two borders: one comparison decides.
#[derive(Debug, Clone, PartialEq)]
struct Borders {
    /// Lower border of each bin, and a last one that nothing reaches.
    lower: Vec<f64>,
    /// The bin at the beginning of each cell of the key.
    first: Vec<u16>,
    /// Cells per unit of the key.
    scale: f32,
}

/// Rounding of a key in single precision, relative: what lies as close to the beginning of a cell may be on either side of it.
const KEY_ERROR: f32 = 1e-6;

impl Borders {
    /// Borders `border(0) … border(bins)`, looked up by `key` of the measure, which runs from 0 to `top`.
    #[expect(clippy::cast_possible_truncation, reason = "keys are single, bins few")]
    fn new(bins: usize, top: f32, border: impl Fn(f64) -> f64, key: impl Fn(f32) -> f32) -> Self {
        let mut lower: Vec<f64> = (0..bins).map(|i| border(i as f64)).collect();
        let keys: Vec<f32> = lower.iter().map(|b| key(*b as f32)).collect();
        lower.push(f64::INFINITY);
        // Doubled until no cell, widened by the rounding of keys, holds two borders.
        let mut cells = 256_usize;
        loop {
            let scale = cells as f32 / top;
            let last_below = |k: f32| keys.partition_point(|b| *b <= k).max(1) - 1;
            let begin = |c: usize| last_below(c as f32 / scale * (1.0 - KEY_ERROR));
            let end = |c: usize| last_below((c + 1) as f32 / scale * (1.0 + KEY_ERROR));
            if cells >= 1 << 16 || (0..=cells).all(|c| end(c) - begin(c) <= 1) {
                return Self { first: (0..=cells).map(|c| begin(c) as u16).collect(), lower, scale };
            }
            cells *= 2;
        }
    }

    /// The bin of a measure given as a fraction, so that no division in double precision is needed.
    #[inline]
    fn find(&self, over: f64, under: f64, key: impl Fn(f32) -> f32) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "saturates, and is cut to the cells"
        )]
        let cell = (key(over as f32 / under as f32) * self.scale) as usize;
        let bin = usize::from(self.first[cell.min(self.first.len() - 1)]);
        bin + usize::from(over >= self.lower[bin + 1] * under)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_comparison_decides_at_every_resolution() {
        for (theta_h, theta_d, phi_d) in [(90, 90, 180), (180, 180, 360), (45, 45, 36), (1, 1, 1), (180, 1, 7)] {
            let resolution = Resolution { theta_h, theta_d, phi_d };
            let table = HalfAngle::new(resolution, vec![Channel::Wavelength(550.0)], vec![0.0; resolution.bins()]);
            let table = table.expect("a table");
            for borders in [&table.half, &table.difference, &table.azimuth] {
                assert!(borders.first.len() <= 1 << 15, "{resolution:?}: {} cells", borders.first.len());
            }
        }
    }
}

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
//! A look-up finds its bin without a square root or an arc function: tan²θ_h, tan²θ_d and tan²φ_d, of which the vectors give the
//! squares, are compared with those of the bins' borders. The bin is that of the exact angles except within rounding (1e-14 rad)
//! of a border. Many look-ups are faster in one call ([`HalfAngle::bins_of`]): the arithmetic of a run of pairs is vector code, and the
//! table is not waited for before the next pair is begun.
//!
//! Reference: W. Matusik et al., *A Data-Driven Reflectance Model*, ACM Trans. Graph. 22 (2003).

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;

use glam::DVec3;
use pulp::{Arch, Simd, WithSimd};

use super::axis::zone;
use super::borders::Borders;
use super::{Channel, Entry, Error, Known};
use crate::brdf::coordinates::HalfDiff;

/// Pairs of directions whose arithmetic is done together.
const RUN: usize = 64;

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

    /// The bin of half and difference angles in radians, by the definition; φ_d + 180° is the place of φ_d.
    #[must_use]
    pub fn bin(self, angles: &HalfDiff) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "saturates, and is cut to the bins"
        )]
        let place = |share: f64, bins: usize| ((share * bins as f64) as usize).min(bins - 1);
        let h = place((angles.theta_h / FRAC_PI_2).sqrt(), self.theta_h);
        let d = place(angles.theta_d / FRAC_PI_2, self.theta_d);
        let p = place(angles.phi_d.rem_euclid(PI) / PI, self.phi_d);
        (h * self.theta_d + d) * self.phi_d + p
    }

    fn unflatten(self, bin: usize) -> [usize; 3] {
        [bin / (self.theta_d * self.phi_d), bin / self.phi_d % self.theta_d, bin % self.phi_d]
    }

    /// # Errors
    /// [`Error::Range`] for numbers of bins out of range.
    pub(in crate::brdf) fn check(self) -> Result<(), Error> {
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
    beside: Beside,
}

/// By bin, which θ_d of its θ_h and φ_d has values and is nearest; made when first a missing bin is asked for. It follows from the values, so that
/// tables are the same with it or without.
#[derive(Debug, Clone, Default)]
struct Beside(OnceLock<Vec<u8>>);

/// In [`Beside`]: there is none.
const NONE: u8 = u8::MAX;

impl PartialEq for Beside {
    fn eq(&self, _: &Self) -> bool {
        true
    }
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
        Ok(Self::of_bins(resolution, channels, values))
    }

    /// The same of values that are sound: as many as there should be, and NaN in all channels of a bin or in none.
    pub(in crate::brdf) fn of_bins(resolution: Resolution, channels: Vec<Channel>, values: Vec<f32>) -> Self {
        let Resolution { theta_h, theta_d, phi_d } = resolution;
        let squared_tangent = |angle: f64| angle.tan().powi(2);
        let half = (0..theta_h).map(|i| squared_tangent((i as f64 / theta_h as f64).powi(2) * FRAC_PI_2));
        let difference = (0..theta_d).map(|i| squared_tangent(i as f64 / theta_d as f64 * FRAC_PI_2));
        // Up to 90°; the others lie the other way round.
        let azimuth = (0..phi_d.div_ceil(2)).map(|i| squared_tangent(i as f64 / phi_d as f64 * PI));
        let (half, difference, azimuth) = (Borders::new(half), Borders::new(difference), Borders::new(azimuth));
        Self { resolution, channels, values, half, difference, azimuth, beside: Beside::default() }
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
        self.find(squared_tangents(incident, outgoing))
    }

    /// The bins of many pairs of directions above the horizon, ω_i first: as [`HalfAngle::bin_of`] has them, in less time.
    ///
    /// # Panics
    /// Where there is not one place in `bins` for each pair.
    pub fn bins_of(&self, pairs: &[(DVec3, DVec3)], bins: &mut [usize]) {
        assert_eq!(pairs.len(), bins.len(), "one bin per pair");
        Arch::new().dispatch(Many { table: self, pairs, bins });
    }

    #[inline(always)]
    fn find(&self, [half, difference, azimuth]: [f64; 3]) -> usize {
        let (h, d) = (self.half.find(half), self.difference.find(difference));
        let p = self.azimuth.find(azimuth.abs());
        // Without a branch, as nobody can guess the sign.
        let p = if azimuth < 0.0 { self.resolution.phi_d - 1 - p } else { p };
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
        self.write(self.bin_of(incident, outgoing), values)
    }

    /// Writes the values of the first bin that has some at the same difference angles and θ_h of 1 − 1/n, 1 − 2/n … 1/n of that of a place, n =
    /// `steps`; whether there is one. The normal itself, where φ_d means nothing, is left to the caller.
    pub(super) fn value_towards_normal(&self, here: &HalfDiff, steps: u32, values: &mut [f64]) -> bool {
        let at = |step: u32| HalfDiff { theta_h: here.theta_h * f64::from(step) / f64::from(steps), ..*here };
        let mut last = None;
        (1..steps).rev().any(|step| {
            let bin = self.resolution.bin(&at(step));
            // Not again of a bin that had none.
            last.replace(bin) != Some(bin) && self.write(bin, values) != Known::Missing
        })
    }

    /// Writes the values of a bin as [`HalfAngle::value`] does.
    fn write(&self, bin: usize, values: &mut [f64]) -> Known {
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
        let [h, _, p] = self.resolution.unflatten(bin);
        let nearest = self.beside.0.get_or_init(|| self.nearest_measured())[bin];
        (nearest != NONE).then(|| (h * self.resolution.theta_d + usize::from(nearest)) * self.resolution.phi_d + p)
    }

    /// [`Beside`]: of two that are as near the one of smaller θ_d.
    fn nearest_measured(&self) -> Vec<u8> {
        let Resolution { theta_d, phi_d, .. } = self.resolution;
        let mut out = vec![NONE; self.resolution.bins()];
        // Zones of one θ_h: down from the last measured θ_d, then back with the next above where that is nearer.
        for (values, out) in
            self.values.chunks_exact(theta_d * phi_d * self.channels.len()).zip(out.chunks_exact_mut(theta_d * phi_d))
        {
            let is_measured = |d: usize, p: usize| !values[(d * phi_d + p) * self.channels.len()].is_nan();
            let mut last = vec![NONE; phi_d];
            for d in 0..theta_d {
                for (p, last) in last.iter_mut().enumerate() {
                    if is_measured(d, p) {
                        *last = number(d);
                    }
                    out[d * phi_d + p] = *last;
                }
            }
            last.fill(NONE);
            for d in (0..theta_d).rev() {
                for (p, next) in last.iter_mut().enumerate() {
                    if is_measured(d, p) {
                        *next = number(d);
                    }
                    let below = &mut out[d * phi_d + p];
                    let nearer = *below == NONE || usize::from(*next) - d < d - usize::from(*below);
                    if *next != NONE && nearer {
                        *below = *next;
                    }
                }
            }
        }
        out
    }
}

/// A number of a bin in θ_d, of 180 at most.
fn number(d: usize) -> u8 {
    u8::try_from(d).expect("checked: at most 180 bins")
}

/// tan²θ_h, tan²θ_d, and tan²φ_d with the sign of tanφ_d; where there is no azimuth (θ_d is 0), 0.
#[inline(always)]
fn squared_tangents(incident: DVec3, outgoing: DVec3) -> [f64; 3] {
    let h = incident + outgoing;
    let across2 = h.x * h.x + h.y * h.y;
    let length2 = across2 + h.z * h.z;
    // ω_i along the meridian of h and across it, both times |h| |h_xy|, the second yet without |h|; x is the meridian of the pole.
    let pole = across2 == 0.0;
    let along = h.z * (h.x * incident.x + h.y * incident.y) - across2 * incident.z;
    let along = if pole { h.z * incident.x } else { along };
    let sideways = if pole { incident.y } else { h.x * incident.y - h.y * incident.x };
    let azimuth = sideways * sideways * length2 / (along * along).max(f64::MIN_POSITIVE);
    let sign = (along.to_bits() ^ sideways.to_bits()) & (1 << 63);
    // |ω_i + ω_o|² + |ω_i − ω_o|² = 4 for unit vectors.
    [across2 / (h.z * h.z), (4.0 - length2).max(0.0) / length2, f64::from_bits(azimuth.to_bits() | sign)]
}

/// One call of [`HalfAngle::bins_of`], compiled once per instruction set.
struct Many<'a> {
    table: &'a HalfAngle,
    pairs: &'a [(DVec3, DVec3)],
    bins: &'a mut [usize],
}

impl WithSimd for Many<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut tangents = [[0.0; RUN]; 3];
        for (pairs, bins) in self.pairs.chunks(RUN).zip(self.bins.chunks_mut(RUN)) {
            for (k, (incident, outgoing)) in pairs.iter().enumerate() {
                let [h, d, p] = squared_tangents(*incident, *outgoing);
                (tangents[0][k], tangents[1][k], tangents[2][k]) = (h, d, p);
            }
            for (k, bin) in bins.iter_mut().enumerate() {
                *bin = self.table.find([tangents[0][k], tangents[1][k], tangents[2][k]]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;

    /// A missing bin takes the values of the nearest in θ_d, of two that are as near those of the smaller one: by search, in tables of every coverage.
    #[test]
    fn missing_bins_take_their_nearest_neighbour() {
        let resolution = Resolution { theta_h: 3, theta_d: 17, phi_d: 6 };
        let mut random = Stream::new(3, 0);
        for coverage in [0.0, 0.02, 0.3, 1.0] {
            let mut value = |bin: usize| if random.uniform() < coverage { bin as f32 } else { f32::NAN };
            let values: Vec<f32> = (0..resolution.bins()).map(&mut value).collect();
            let table = HalfAngle::new(resolution, vec![Channel::Wavelength(550.0)], values.clone()).expect("a table");
            for (bin, value) in values.iter().enumerate().filter(|(_, v)| v.is_nan()) {
                let [h, d, p] = resolution.unflatten(bin);
                let all = (0..resolution.theta_d).map(|other| (other.abs_diff(d), (h * 17 + other) * 6 + p));
                let expected = all.filter(|(_, bin)| !values[*bin].is_nan()).min();
                assert_eq!(table.measured_beside(bin), expected.map(|(_, bin)| bin), "{coverage}: {bin} {value}");
            }
        }
    }

    #[test]
    fn borders_of_every_resolution_are_apart_in_few_cells() {
        for (theta_h, theta_d, phi_d) in [(90, 90, 180), (180, 180, 360), (45, 45, 36), (1, 1, 1), (180, 1, 7)] {
            let resolution = Resolution { theta_h, theta_d, phi_d };
            let table = HalfAngle::new(resolution, vec![Channel::Wavelength(550.0)], vec![0.0; resolution.bins()]);
            let table = table.expect("a table");
            for borders in [&table.half, &table.difference, &table.azimuth] {
                assert!(borders.cells() <= 1 << 12, "{resolution:?}: {} cells", borders.cells());
            }
        }
    }
}

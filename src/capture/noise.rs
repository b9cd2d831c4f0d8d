//! The noise of codes, from photographs alone: how much a pixel differs from the mean of its four neighbours.
//!
//! ```text
//! r = z − (z₁ + z₂ + z₃ + z₄)/4      var(r) = 5/4 σ²(z)      for smooth pictures and noise that is not correlated
//! ```
//!
//! Residuals are gathered by the mean code of the five pixels. Of each code and those within three of it, residuals beyond four robust standard
//! deviations are edges and do not count. Developed photographs whose noise was smoothed show less than there is: the result is a least value
//! then.

use std::io::{Read, Seek};

use super::response::LEVELS;
use super::rows::PhotoRows;
use super::{Error, Photo};

/// Quarters of codes up to which residuals are counted.
const QUARTERS: usize = 256;
/// Codes on either side that are counted together.
const AROUND: usize = 3;
/// Residuals that a code takes.
const ENOUGH: f64 = 100.0;
/// Robust standard deviations beyond which a residual is an edge.
const FAR: f64 = 4.0;
/// Samples that are looked at at once.
const SAMPLES_AT_ONCE: usize = 1 << 22;
/// Standard deviation of a rounding to whole codes.
const ROUNDING: f64 = 0.288_675_134_594_812_9;

/// Standard error of a code, per channel and code.
#[derive(Debug, Clone, PartialEq)]
pub struct Noise {
    /// `sigma[channel][code]`, in codes of 0 to 255.
    sigma: Vec<Vec<f64>>,
}

impl Noise {
    /// The same for all codes.
    #[must_use]
    pub fn constant(channels: usize, sigma: f64) -> Self {
        Self { sigma: vec![vec![sigma; LEVELS]; channels] }
    }

    /// Channels it is known for.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.sigma.len()
    }

    /// Standard error of a code, between whole ones linear.
    #[must_use]
    pub fn at(&self, channel: usize, code: f64) -> f64 {
        let code = code.clamp(0.0, (LEVELS - 1) as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to codes")]
        let k = (code as usize).min(LEVELS - 2);
        let all = &self.sigma[channel];
        all[k] + (code - k as f64) * (all[k + 1] - all[k])
    }
}

/// Residuals of photographs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Residuals {
    /// `counts[channel][code][quarters of a code]`.
    counts: Vec<Vec<Vec<u32>>>,
}

impl Residuals {
    /// Adds a photograph.
    pub fn add(&mut self, photo: &Photo) {
        let (w, h, n) = (photo.width, photo.height, photo.channels);
        self.counts.resize(n.max(self.counts.len()), vec![vec![0; QUARTERS]; LEVELS]);
        for y in 1..h.saturating_sub(1) {
            for x in 1..w.saturating_sub(1) {
                for c in 0..n {
                    let i = (y * w + x) * n + c;
                    let around = photo.code(i - n) + photo.code(i + n) + photo.code(i - w * n) + photo.code(i + w * n);
                    let here = photo.code(i);
                    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "codes are 0 to 255")]
                    let (mean, off) = (
                        ((around + here) / 5.0).round() as usize,
                        (4.0 * (here - 0.25 * around).abs()).round() as usize,
                    );
                    self.counts[c][mean.min(LEVELS - 1)][off.min(QUARTERS - 1)] += 1;
                }
            }
        }
    }

    /// Adds a photograph by its rows.
    ///
    /// # Errors
    /// [`Error::Undecodable`] where the file is damaged; the rows before count.
    pub fn add_rows<R: Read + Seek + Send>(&mut self, rows: &mut PhotoRows<R>) -> Result<(), Error> {
        let at_once = (SAMPLES_AT_ONCE / (rows.width * rows.channels).max(1)).max(1);
        let mut piece = rows.next(at_once)?;
        loop {
            self.add(&piece);
            let below = rows.next(at_once)?;
            if below.height == 0 {
                return Ok(());
            }
            // The last row has no row below it yet, and needs the one above.
            piece = piece.rows(piece.height.saturating_sub(2)..piece.height);
            piece.append(&below);
        }
    }

    /// Adds the residuals of others.
    pub fn merge(&mut self, other: &Self) {
        let more = other.counts.len().saturating_sub(self.counts.len());
        self.counts.extend(std::iter::repeat_n(vec![vec![0; QUARTERS]; LEVELS], more));
        let codes = self.counts.iter_mut().flatten().zip(other.counts.iter().flatten());
        codes.for_each(|(mine, theirs)| mine.iter_mut().zip(theirs).for_each(|(a, b)| *a += b));
    }

    /// The noise; codes that hardly occur have that of the nearest ones, without any it is that of rounding.
    #[must_use]
    pub fn noise(&self) -> Noise {
        let channel = |codes: &Vec<Vec<u32>>| {
            let known: Vec<Option<f64>> = (0..LEVELS).map(|z| sigma(codes, z)).collect();
            let nearest = |z: usize| {
                let by_distance = |k: &usize| k.abs_diff(z);
                (0..LEVELS).filter(|k| known[*k].is_some()).min_by_key(by_distance).and_then(|k| known[k])
            };
            (0..LEVELS).map(|z| known[z].or_else(|| nearest(z)).unwrap_or(ROUNDING).max(ROUNDING)).collect()
        };
        Noise { sigma: self.counts.iter().map(channel).collect() }
    }
}

fn sigma(codes: &[Vec<u32>], z: usize) -> Option<f64> {
    let mut all = [0.0; QUARTERS];
    for near in &codes[z.saturating_sub(AROUND)..(z + AROUND + 1).min(LEVELS)] {
        all.iter_mut().zip(near).for_each(|(a, n)| *a += f64::from(*n));
    }
    let total: f64 = all.iter().sum();
    if total < ENOUGH {
        return None;
    }
    let mut below = 0.0;
    let median = all.iter().position(|n| {
        below += n;
        below >= 0.5 * total
    })?;
    let reach = FAR * 1.4826 * (median.max(1) as f64 + 0.5);
    let near = || all.iter().zip(0_u32..).filter(|(_, q)| f64::from(*q) <= reach);
    let count: f64 = near().map(|(n, _)| n).sum();
    let square: f64 = near().map(|(n, q)| n * (f64::from(q) / 4.0).powi(2)).sum();
    // 5/4 of the variance is in r.
    Some((square / count / 1.25).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::photo::Codes;
    use crate::math::random::Stream;

    #[test]
    fn noise_that_grows_with_the_code_is_found_beside_an_edge() {
        let (side, truth) = (200, |code: f64| 0.5 + code / 60.0);
        let code = |i: usize| {
            let (x, y) = (i % side, i / side);
            let level = if x < 150 { 40.0 + 0.8 * x as f64 } else { 220.0 };
            let mut random = Stream::new(7, i as u64);
            let normal = (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
            let code = (level + 0.01 * y as f64 + truth(level) * normal).round().clamp(0.0, 255.0) as u8;
            code
        };
        let photo =
            Photo { width: side, height: side, channels: 1, codes: Codes::Eight((0..side * side).map(code).collect()) };
        let mut all = Residuals::default();
        all.add(&photo);
        let noise = all.noise();
        for z in [60.0, 100.0, 140.0] {
            // Rounding to whole codes adds its own; 7 codes × 250 pixels: 2.4 % of σ, three times that.
            let expected = truth(z).hypot(ROUNDING);
            assert!((noise.at(0, z) / expected - 1.0).abs() < 0.08, "{z}: {} {expected}", noise.at(0, z));
        }
        assert_eq!(Residuals::default().noise(), Noise { sigma: vec![] });
        assert!((Noise::constant(3, 1.5).at(2, 77.7) - 1.5).abs() < 1e-15);
    }
}

//! A stack of exposures into linear radiance, with a standard error per sample and a mask.
//!
//! ```text
//! E = Σ w_j x_j / Σ w_j     x_j = g(z_j)/t_j     1/w_j = var(x_j) = (x_j · d ln g/dz · σ_z)² + (x_j σ_g)²
//! ```
//!
//! σ_z is the error of a code, σ_g that of the response. The weight does not use the noisy x_j itself where a better one is there: it is
//! the mean of the exposures so far, so that dark noise does not draw the result down. Exposures are added one after another: memory
//! does not grow with their number, three numbers per sample.

use super::response::Curve;
use super::{Error, Photo};

/// Codes outside of these, of 0 to 255, are dark or saturated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The lowest code used.
    pub dark: f64,
    /// The highest.
    pub saturated: f64,
}

impl Default for Range {
    fn default() -> Self {
        Self { dark: 2.0, saturated: 250.0 }
    }
}

/// What became of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// One exposure or more within the range.
    Valid,
    /// Too bright in all; the radiance given is the least it can be.
    Saturated,
    /// Too dark in all; the radiance given is the most it can be.
    Dark,
    /// Dark in one and saturated in another, with none between: the radiance given is a middle, its error half the way.
    Gap,
}

/// A sum over exposures.
#[derive(Debug, Clone)]
pub struct Merge {
    width: usize,
    height: usize,
    channels: usize,
    range: Range,
    noise: f64,
    /// Σ w x and Σ w.
    sums: Vec<[f32; 2]>,
    /// Bounds from codes out of range: the radiance is above the first and below the second.
    bounds: Vec<[f32; 2]>,
    size: String,
}

/// Radiances of a stack, each up to the factor of its channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1 or 3.
    pub channels: usize,
    /// Radiances, interleaved.
    pub radiance: Vec<f32>,
    /// Their standard errors; infinite where only a bound is known.
    pub standard_error: Vec<f32>,
    /// What became of each.
    pub states: Vec<State>,
}

impl Merge {
    /// An empty sum for photographs like `first`; `noise` is the standard error of a code, of 0 to 255.
    #[must_use]
    pub fn new(first: &Photo, range: Range, noise: f64) -> Self {
        let samples = first.width * first.height * first.channels;
        Self {
            width: first.width,
            height: first.height,
            channels: first.channels,
            range,
            noise,
            sums: vec![[0.0; 2]; samples],
            bounds: vec![[0.0, f32::INFINITY]; samples],
            size: first.size(),
        }
    }

    /// Adds an exposure.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::Time`].
    ///
    /// # Panics
    /// Without a curve per channel.
    pub fn add(&mut self, name: &str, time_s: f64, photo: &Photo, curves: &[Curve]) -> Result<(), Error> {
        assert_eq!(curves.len(), self.channels, "a curve per channel");
        if photo.size() != self.size {
            return Err(Error::Size { name: name.to_owned(), found: photo.size(), expected: self.size.clone() });
        }
        if !(time_s > 0.0 && time_s.is_finite()) {
            return Err(Error::Time { name: name.to_owned(), time_s });
        }
        let tables: Vec<Table> = curves.iter().map(|c| Table::new(c, time_s, self.noise)).collect();
        for (i, (sum, bound)) in self.sums.iter_mut().zip(&mut self.bounds).enumerate() {
            let (code, table) = (photo.code(i), &tables[i % self.channels]);
            let (x, relative) = table.at(code);
            #[expect(clippy::cast_possible_truncation, reason = "deliberate: pixels are f32")]
            if code > self.range.saturated {
                bound[0] = bound[0].max(table.at(self.range.saturated).0 as f32);
            } else if code < self.range.dark {
                bound[1] = bound[1].min(table.at(self.range.dark).0 as f32);
            } else {
                let best = if sum[1] > 0.0 { f64::from(sum[0]) / f64::from(sum[1]) } else { x };
                let w = 1.0 / (best * relative).powi(2);
                sum[0] += (w * x) as f32;
                sum[1] += w as f32;
            }
        }
        Ok(())
    }

    /// The radiances.
    #[must_use]
    pub fn finish(self) -> Merged {
        let mut merged = Merged {
            width: self.width,
            height: self.height,
            channels: self.channels,
            radiance: Vec::with_capacity(self.sums.len()),
            standard_error: Vec::with_capacity(self.sums.len()),
            states: Vec::with_capacity(self.sums.len()),
        };
        for ([above, weight], [least, most]) in self.sums.into_iter().zip(self.bounds) {
            let (x, error, state) = if weight > 0.0 {
                (above / weight, weight.sqrt().recip(), State::Valid)
            } else if least > 0.0 && most.is_finite() {
                (0.5 * (least + most), 0.5 * (most - least).abs(), State::Gap)
            } else if least > 0.0 {
                (least, f32::INFINITY, State::Saturated)
            } else {
                (most, f32::INFINITY, State::Dark)
            };
            merged.radiance.push(x);
            merged.standard_error.push(error);
            merged.states.push(state);
        }
        merged
    }
}

/// Radiance and its relative standard error at 1/16 codes: a curve costs an exponential per entry, not per pixel.
struct Table(Vec<(f64, f64)>);

/// Entries per code.
const FINE: f64 = 16.0;

impl Table {
    fn new(curve: &Curve, time_s: f64, noise: f64) -> Self {
        let entry = |k: u32| {
            let code = f64::from(k) / FINE;
            // Where the curve is flat a code tells nothing: the least slope is that of a code in a thousand.
            let slope = curve.slope(code).max(1e-3);
            let relative = (slope * noise).hypot(curve.standard_error(code));
            (curve.ln_exposure(code).exp() / time_s, relative)
        };
        Self((0..=255 * 16).map(entry).collect())
    }

    fn at(&self, code: f64) -> (f64, f64) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "codes are 0 to 255")]
        let k = (code * FINE).round() as usize;
        self.0[k.min(self.0.len() - 1)]
    }
}

impl Merged {
    /// Samples in each state: valid, saturated, dark, gap.
    #[must_use]
    pub fn counts(&self) -> [usize; 4] {
        let count = |state: State| self.states.iter().filter(|s| **s == state).count();
        [State::Valid, State::Saturated, State::Dark, State::Gap].map(count)
    }
}

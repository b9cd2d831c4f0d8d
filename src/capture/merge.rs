//! A stack of exposures into linear radiance, with a standard error per sample and a mask.
//!
//! ```text
//! E = Σ w_j x_j / Σ w_j     x_j = g(z_j)/t_j     1/w_j = var(x_j) = (x_j · d ln g/dz · σ_z)² + (x_j σ_g)²
//! ```
//!
//! σ_z is the error of a code, σ_g that of the response. The weight does not use the noisy x_j itself where a better one is there, nor the
//! errors of the noisy code: it is the mean of the exposures so far that says which code there should be and what its errors are, so that
//! noise does not choose its own weight. The longest exposure comes first where that is to mean most. Exposures are added one after another:
//! memory does not grow with their number: 16 bytes per sample.

use rayon::prelude::*;

use super::noise::Noise;
use super::radiance::Radiance;
use super::response::Curve;
use super::{Error, Photo};
use crate::image::{self, Channel, Description, Meaning, Region, Source};

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
    channels: usize,
    range: Range,
    noise: Noise,
    /// Σ w x and Σ w.
    sums: Vec<[f32; 2]>,
    /// Bounds from codes out of range: the radiance is above the first and below the second.
    bounds: Vec<[f32; 2]>,
    size: String,
    description: Description,
}

/// What is known of the radiance of one sample, up to the factor of its channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The radiance, or its bound.
    pub radiance: f32,
    /// Its standard error; infinite where only a bound is known.
    pub standard_error: f32,
    /// What became of it.
    pub state: State,
}

/// How radiance follows from a code.
#[derive(Debug, Clone, PartialEq)]
pub enum Respond {
    /// In proportion: code 255 is a radiance of 1 at 1 s.
    Linear,
    /// By a curve per channel.
    Curves(Vec<Curve>),
}

impl Merge {
    /// An empty sum for photographs like `first`.
    ///
    /// # Panics
    /// Where the noise is that of fewer channels.
    #[must_use]
    pub fn new(first: &Photo, range: Range, noise: Noise) -> Self {
        assert!(noise.channels() >= first.channels, "noise for every channel");
        let samples = first.width * first.height * first.channels;
        Self {
            width: first.width,
            channels: first.channels,
            range,
            noise,
            sums: vec![[0.0; 2]; samples],
            bounds: vec![[0.0, f32::INFINITY]; samples],
            size: first.size(),
            description: describe(first.width, first.height, first.channels),
        }
    }

    /// Adds an exposure.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::Time`].
    ///
    /// # Panics
    /// Without a curve per channel.
    pub fn add(&mut self, name: &str, time_s: f64, photo: &Photo, respond: &Respond) -> Result<(), Error> {
        if photo.size() != self.size {
            return Err(Error::Size { name: name.to_owned(), found: photo.size(), expected: self.size.clone() });
        }
        if !(time_s > 0.0 && time_s.is_finite()) {
            return Err(Error::Time { name: name.to_owned(), time_s });
        }
        let tables: Vec<Table> = match respond {
            Respond::Linear => vec![Table::Linear { time_s }; self.channels],
            Respond::Curves(curves) => {
                curves.iter().enumerate().map(|(c, curve)| Table::new(curve, time_s, c, &self.noise)).collect()
            }
        };
        assert_eq!(tables.len(), self.channels, "a curve per channel");
        let (range, noise, channels) = (self.range, &self.noise, self.channels);
        let all = self.sums.par_iter_mut().zip(&mut self.bounds).enumerate().with_min_len(1 << 14);
        all.for_each(|(i, (sum, bound))| {
            let (code, table, channel) = (photo.code(i), &tables[i % channels], i % channels);
            let x = table.radiance(code);
            let best = (sum[1] > 0.0).then(|| f64::from(sum[0]) / f64::from(sum[1]));
            // Whether it is too dark is asked of the code that should be there: noise that lifts a dark one must not select itself.
            let expected = best.map_or(code, |best| table.code(best));
            #[expect(clippy::cast_possible_truncation, reason = "deliberate: pixels are f32")]
            if code > range.saturated {
                bound[0] = bound[0].max(table.radiance(range.saturated) as f32);
            } else if expected < range.dark {
                bound[1] = bound[1].min(table.radiance(range.dark) as f32);
            } else {
                let w = 1.0 / (best.unwrap_or(x) * table.relative(expected, channel, noise)).powi(2);
                sum[0] += (w * x) as f32;
                sum[1] += w as f32;
            }
        });
        Ok(())
    }

    /// Sample `i`, interleaved: (y·width + x)·channels + c.
    #[must_use]
    pub fn sample(&self, i: usize) -> Sample {
        let ([above, weight], [least, most]) = (self.sums[i], self.bounds[i]);
        let (radiance, standard_error, state) = if weight > 0.0 {
            (above / weight, weight.sqrt().recip(), State::Valid)
        } else if least > 0.0 && most.is_finite() {
            (0.5 * (least + most), 0.5 * (most - least).abs(), State::Gap)
        } else if least > 0.0 {
            (least, f32::INFINITY, State::Saturated)
        } else {
            (most, f32::INFINITY, State::Dark)
        };
        Sample { radiance, standard_error, state }
    }

    /// The result as a picture of radiance, with its standard errors and states.
    #[must_use]
    pub fn radiance(&self) -> Radiance {
        let samples = || (0..self.sums.len()).map(|i| self.sample(i));
        Radiance {
            width: self.width,
            height: self.description.height,
            channels: self.channels,
            time_s: 1.0,
            values: samples().map(|s| s.radiance).collect(),
            errors: Some(samples().map(|s| s.standard_error).collect()),
            states: Some(samples().map(|s| s.state).collect()),
        }
    }

    /// Samples in each state: valid, saturated, dark, gap.
    #[must_use]
    pub fn counts(&self) -> [usize; 4] {
        let mut counts = [0; 4];
        (0..self.sums.len()).for_each(|i| counts[self.sample(i).state as usize] += 1);
        counts
    }
}

/// Names of the channels of a photograph.
fn names(channels: usize) -> &'static [&'static str] {
    if channels == 1 { &["Y"] } else { &["R", "G", "B"] }
}

/// Radiances as `R`, `G`, `B` (or `Y`), their standard errors as `standard_error.R` …, what became of each as `state.R` …: 0 valid,
/// 1 saturated, 2 dark, 3 gap.
fn describe(width: usize, height: usize, channels: usize) -> Description {
    let prefixes = ["", "standard_error.", "state."];
    let planes = prefixes
        .iter()
        .flat_map(|p| names(channels).iter().map(move |n| Channel::new(format!("{p}{n}"), "", Meaning::Other)));
    Description::planes(width, height, planes.collect())
}

/// The result as an image, without a copy of it.
impl Source for Merge {
    fn description(&self) -> &Description {
        &self.description
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), image::Error> {
        let mut rows = out.chunks_exact_mut(region.width.max(1));
        for y in region.y..region.y + region.height {
            for channel in channels {
                let Some(row) = rows.next() else { return Ok(()) };
                let (kind, c) = (channel / self.channels, channel % self.channels);
                for (x, value) in (region.x..).zip(row) {
                    let sample = self.sample((y * self.width + x) * self.channels + c);
                    *value = match kind {
                        0 => sample.radiance,
                        1 => sample.standard_error,
                        _ => f32::from(sample.state as u8),
                    };
                }
            }
        }
        Ok(())
    }
}

/// Radiance and its relative standard error by code. Of a curve they are tabulated at 1/16 codes: an exponential per entry, not per
/// pixel.
#[derive(Clone)]
enum Table {
    Linear { time_s: f64 },
    Curve(Vec<(f64, f64)>),
}

/// Entries per code.
const FINE: u32 = 16;
/// The greatest code.
const TOP: f64 = 255.0;

impl Table {
    fn new(curve: &Curve, time_s: f64, channel: usize, noise: &Noise) -> Self {
        let entry = |k: u32| {
            let code = f64::from(k) / f64::from(FINE);
            // Where the curve is flat a code tells nothing: the least slope is that of a code in a thousand.
            let slope = curve.slope(code).max(1e-3);
            let relative = (slope * noise.at(channel, code)).hypot(curve.standard_error(code));
            (curve.ln_exposure(code).exp() / time_s, relative)
        };
        Self::Curve((0..=255 * FINE).map(entry).collect())
    }

    fn entry(entries: &[(f64, f64)], code: f64) -> (f64, f64) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "codes are 0 to 255")]
        let k = (code * f64::from(FINE)).round() as usize;
        entries[k.min(entries.len() - 1)]
    }

    /// The radiance that a code stands for.
    fn radiance(&self, code: f64) -> f64 {
        match self {
            Self::Linear { time_s } => code / TOP / time_s,
            Self::Curve(entries) => Self::entry(entries, code).0,
        }
    }

    /// The relative standard error of the radiance at a code.
    fn relative(&self, code: f64, channel: usize, noise: &Noise) -> f64 {
        match self {
            Self::Linear { .. } => noise.at(channel, code) / code,
            Self::Curve(entries) => Self::entry(entries, code).1,
        }
    }

    /// The code that a radiance should have, 0 to 255.
    fn code(&self, radiance: f64) -> f64 {
        match self {
            Self::Linear { time_s } => (radiance * time_s * TOP).min(TOP),
            Self::Curve(entries) => entries.partition_point(|e| e.0 < radiance) as f64 / f64::from(FINE),
        }
    }
}

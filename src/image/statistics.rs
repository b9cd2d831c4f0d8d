//! Range, mean, odd values and histogram of an image, in one pass.

use rayon::prelude::*;

use super::error::Error;
use super::source::{Region, SAMPLES_AT_ONCE, Source, pieces};

/// Binary exponents of an `f32`, those of denormals together.
const OCTAVES: usize = 255;

/// What one channel holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelStatistics {
    /// Smallest finite sample; infinity where there is none.
    pub min: f32,
    /// Largest finite sample; minus infinity where there is none.
    pub max: f32,
    sum: f64,
    /// Finite samples.
    pub finite: u64,
    /// NaN.
    pub nan: u64,
    /// Infinite, of either sign.
    pub infinite: u64,
    /// Below zero, infinity included.
    pub negative: u64,
    /// Exactly zero.
    pub zero: u64,
}

impl Default for ChannelStatistics {
    fn default() -> Self {
        let (min, max) = (f32::INFINITY, f32::NEG_INFINITY);
        Self { min, max, sum: 0.0, finite: 0, nan: 0, infinite: 0, negative: 0, zero: 0 }
    }
}

impl ChannelStatistics {
    /// Mean of the finite samples; `None` without any.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.finite > 0).then(|| self.sum / self.finite as f64)
    }

    pub(super) fn add(&mut self, value: f32) {
        self.negative += u64::from(value < 0.0);
        self.zero += u64::from(value == 0.0);
        if value.is_finite() {
            self.min = self.min.min(value);
            self.max = self.max.max(value);
            self.sum += f64::from(value);
            self.finite += 1;
        } else if value.is_nan() {
            self.nan += 1;
        } else {
            self.infinite += 1;
        }
    }

    fn merge(&mut self, other: &Self) {
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
        self.sum += other.sum;
        self.finite += other.finite;
        self.nan += other.nan;
        self.infinite += other.infinite;
        self.negative += other.negative;
        self.zero += other.zero;
    }
}

/// What an image holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// By channel, in the order asked for.
    pub channels: Vec<ChannelStatistics>,
    octaves: Vec<u64>,
}

impl Statistics {
    /// Positive finite samples of all channels by octave: lower end, upper end (twice it) and number, from the first octave that
    /// has any to the last. Denormals are in one bin from 0.
    #[must_use]
    pub fn histogram(&self) -> Vec<(f64, f64, u64)> {
        let first = self.octaves.iter().position(|n| *n > 0);
        let last = self.octaves.iter().rposition(|n| *n > 0);
        let (Some(first), Some(last)) = (first, last) else { return Vec::new() };
        let edge = |e: usize| if e == 0 { 0.0 } else { f64::powi(2.0, i32::try_from(e).unwrap_or(0) - 127) };
        (first..=last).map(|e| (edge(e), edge(e + 1), self.octaves[e])).collect()
    }

    /// Reads the channels listed of a whole image; `progress` is told the pixels done after each piece.
    ///
    /// # Errors
    /// Those of the source.
    pub fn of(source: &mut dyn Source, channels: &[usize], mut progress: impl FnMut(usize)) -> Result<Self, Error> {
        let whole = Region::rows(source.description(), 0, source.description().height);
        let mut samples = Vec::new();
        let mut out = Self { channels: vec![ChannelStatistics::default(); channels.len()], octaves: vec![0; OCTAVES] };
        if channels.is_empty() {
            return Ok(out);
        }
        for piece in pieces(whole, source.block(), SAMPLES_AT_ONCE / channels.len()) {
            samples.resize(piece.pixels() * channels.len(), 0.0);
            source.read(piece, channels, &mut samples)?;
            let rows = samples.par_chunks_exact(channels.len() * piece.width);
            let empty = || (vec![ChannelStatistics::default(); channels.len()], vec![0_u64; OCTAVES]);
            let (found, octaves) = rows
                .fold(empty, |(mut found, mut octaves), row| {
                    for (channel, plane) in found.iter_mut().zip(row.chunks_exact(piece.width)) {
                        for value in plane {
                            channel.add(*value);
                            if *value > 0.0 && value.is_finite() {
                                octaves[(value.to_bits() >> 23) as usize] += 1;
                            }
                        }
                    }
                    (found, octaves)
                })
                .reduce(empty, |(mut a, mut p), (b, q)| {
                    a.iter_mut().zip(&b).for_each(|(a, b)| a.merge(b));
                    p.iter_mut().zip(&q).for_each(|(p, q)| *p += q);
                    (a, p)
                });
            out.channels.iter_mut().zip(&found).for_each(|(a, b)| a.merge(b));
            out.octaves.iter_mut().zip(&octaves).for_each(|(p, q)| *p += q);
            progress(piece.pixels());
        }
        Ok(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{Channel, Description, Meaning, Memory};

    #[test]
    fn odd_values_are_counted_and_do_not_spoil_the_range() {
        let description = Description::planes(8, 1, vec![Channel::new("Y", "", Meaning::Photopic)]);
        let samples = vec![1.0, 1.5, 4.0, 0.0, -2.0, f32::NAN, f32::INFINITY, 1e-40];
        let all = Statistics::of(&mut Memory::new(description, samples), &[0], |_| ()).expect("memory does not fail");
        let c = all.channels[0];
        assert_eq!((c.min, c.max, c.finite, c.nan, c.infinite, c.negative, c.zero), (-2.0, 4.0, 6, 1, 1, 1, 1));
        // (1 + 1.5 + 4 + 0 − 2 + 1e-40) / 6
        assert!((c.mean().expect("finite samples") - 0.75).abs() < 1e-15);
        let bins = all.histogram();
        assert_eq!(bins.first().map(|b| (b.0, b.2)), Some((0.0, 1)));
        assert_eq!(bins.iter().find(|b| b.0 == 1.0), Some(&(1.0, 2.0, 2)));
        assert_eq!(bins.last(), Some(&(4.0, 8.0, 1)));
    }
}

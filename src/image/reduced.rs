//! An image with fewer bands and fewer pixels, made as it is read.

use super::description::{Channel, Description, Meaning};
use super::error::Error;
use super::source::{self, Region, SAMPLES_AT_ONCE, Source};
use crate::finding::Finding;

/// How bands become fewer. Between the bands of the image the spectrum is taken as straight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Bands {
    /// The values at wavelengths in equal steps from the first band to the last: what a renderer of so many wavelengths has.
    #[default]
    Sampled,
    /// The means over equal parts of the range: what a camera of so many filters sees.
    Averaged,
}

impl Bands {
    /// Its word in reports and on the command line.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Sampled => "sampled",
            Self::Averaged => "averaged",
        }
    }
}

/// Why an image cannot be reduced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ReductionError {
    /// Fewer bands than two, or no fewer than there are.
    #[error("found {found} bands asked for of an image of {own}; expected 2 or more, and no more than it has")]
    Count {
        /// Asked for.
        found: usize,
        /// Bands of the image.
        own: usize,
    },
    /// No pixels.
    #[error("found means over blocks of 0 pixels; expected 1 or more")]
    Block,
}

/// A source whose bands are made of those of another, and whose pixels are means over square blocks of its pixels; a block that the edge
/// cuts is the mean of what there is.
///
/// With fewer bands, everything that is no band is left out: it belongs to the bands that are gone. Means are taken in `f64`; a sample that
/// is no number makes those that it is in no numbers.
pub struct Reduced<S> {
    source: S,
    description: Description,
    /// Per channel the channels that it is made of, and their weights.
    parts: Vec<Parts>,
    block: usize,
    samples: Vec<f32>,
}

impl<S: Source> Reduced<S> {
    /// The image with `bands` of its bands (all channels as they are where that is `None`), each pixel the mean of `block` × `block`.
    ///
    /// # Errors
    /// [`ReductionError`].
    pub fn new(source: S, bands: Option<(usize, Bands)>, block: usize) -> Result<Self, ReductionError> {
        if block == 0 {
            return Err(ReductionError::Block);
        }
        let mut description = source.description().clone();
        description.width = description.width.div_ceil(block);
        description.height = description.height.div_ceil(block);
        let mut parts: Vec<Parts> = (0..description.channels.len()).map(|c| vec![(c, 1.0)]).collect();
        if let Some((count, how)) = bands {
            let own = description.bands();
            if count < 2 || count > own.len() {
                return Err(ReductionError::Count { found: count, own: own.len() });
            }
            let made = made_of(&own, count, how);
            let unit = description.channels[own[0].0].unit.clone();
            let channel = |(wavelength_nm, width, _): &(f64, f64, Parts)| {
                let fwhm_nm = (how == Bands::Averaged).then_some(*width);
                let meaning = Meaning::Band { wavelength_nm: *wavelength_nm, fwhm_nm, good: true };
                Channel::new(format!("{wavelength_nm} nm"), unit.clone(), meaning)
            };
            description.channels = made.iter().map(channel).collect();
            parts = made.into_iter().map(|(.., parts)| parts).collect();
        }
        Ok(Self { source, description, parts, block, samples: Vec::new() })
    }
}

/// Channels of an image, and the weight of each.
type Parts = Vec<(usize, f64)>;

/// Wavelength, width and parts of each of `count` bands made of others, ascending.
fn made_of(own: &[(usize, f64)], count: usize, how: Bands) -> Vec<(f64, f64, Parts)> {
    let (first, last) = (own[0].1, own[own.len() - 1].1);
    let one = |i: usize| match how {
        Bands::Sampled => {
            let step = (last - first) / (count - 1) as f64;
            let at = if i + 1 == count { last } else { first + step * i as f64 };
            (at, step, straight(own, at).into_iter().filter(|(_, w)| *w != 0.0).collect())
        }
        Bands::Averaged => {
            let width = (last - first) / count as f64;
            let (from, to) = (first + width * i as f64, first + width * (i + 1) as f64);
            let mut parts = Parts::new();
            // The mean of a straight line over a piece is its value in the middle.
            for pair in own.windows(2) {
                let (a, b) = (pair[0].1.max(from), pair[1].1.min(to));
                if b > a {
                    for (channel, weight) in straight(own, 0.5 * (a + b)) {
                        let weight = weight * (b - a) / width;
                        match parts.iter_mut().find(|(c, _)| *c == channel) {
                            Some((_, w)) => *w += weight,
                            None => parts.push((channel, weight)),
                        }
                    }
                }
            }
            (0.5 * (from + to), width, parts)
        }
    };
    (0..count).map(one).collect()
}

/// The two bands about a wavelength and their weights.
fn straight(own: &[(usize, f64)], at_nm: f64) -> [(usize, f64); 2] {
    let above = own.partition_point(|(_, nm)| *nm <= at_nm).clamp(1, own.len() - 1);
    let ((a, low), (b, high)) = (own[above - 1], own[above]);
    let share = ((at_nm - low) / (high - low)).clamp(0.0, 1.0);
    [(a, 1.0 - share), (b, share)]
}

impl<S: Source> Source for Reduced<S> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn block(&self) -> (usize, usize) {
        let (width, height) = self.source.block();
        (width.div_ceil(self.block), height.div_ceil(self.block))
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        let mut needed: Vec<usize> = channels.iter().flat_map(|c| self.parts[*c].iter().map(|(n, _)| *n)).collect();
        needed.sort_unstable();
        needed.dedup();
        let place = |channel: usize| needed.partition_point(|n| *n < channel);
        let parts: Vec<Parts> =
            channels.iter().map(|c| self.parts[*c].iter().map(|(n, w)| (place(*n), *w)).collect()).collect();
        let (block, whole) = (self.block, self.source.description());
        let (x, width) = (region.x * block, ((region.x + region.width) * block).min(whole.width) - region.x * block);
        let last_row = whole.height;
        let at_once = (SAMPLES_AT_ONCE / (width * needed.len() * block).max(1)).max(1);
        let mut sums = vec![0.0_f64; region.width];
        for from in (0..region.height).step_by(at_once) {
            let rows = at_once.min(region.height - from);
            let y = (region.y + from) * block;
            let height = (y + rows * block).min(last_row) - y;
            self.samples.resize(width * height * needed.len(), 0.0);
            self.source.read(Region { x, y, width, height }, &needed, &mut self.samples)?;
            for row in 0..rows {
                let lines = row * block..((row + 1) * block).min(height);
                for (k, parts) in parts.iter().enumerate() {
                    sums.fill(0.0);
                    for line in lines.clone() {
                        for (channel, weight) in parts {
                            let start = (line * needed.len() + channel) * width;
                            let samples = self.samples[start..start + width].chunks(block);
                            for (sum, samples) in sums.iter_mut().zip(samples) {
                                *sum += weight * samples.iter().map(|v| f64::from(*v)).sum::<f64>();
                            }
                        }
                    }
                    let start = ((from + row) * channels.len() + k) * region.width;
                    let of_block = |column: usize| (width - column * block).min(block) * lines.len();
                    for (column, (value, sum)) in out[start..start + region.width].iter_mut().zip(&sums).enumerate() {
                        #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
                        let mean = (sum / of_block(column) as f64) as f32;
                        *value = mean;
                    }
                }
            }
        }
        Ok(())
    }

    fn findings(&self) -> Vec<Finding> {
        self.source.findings()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Memory;

    /// Bands at 400, 410, … nm; the sample at (x, y) is that of `f`.
    fn cube(width: usize, height: usize, bands: usize, f: impl Fn(usize, usize, f64) -> f64) -> Memory {
        let nm = |b: usize| 400.0 + 10.0 * b as f64;
        let channels = (0..bands).map(|b| Channel::band(format!("{}", nm(b)), "", nm(b))).collect();
        let mut samples = Vec::new();
        for y in 0..height {
            for b in 0..bands {
                samples.extend((0..width).map(|x| f(x, y, nm(b)) as f32));
            }
        }
        Memory::new(Description::planes(width, height, channels), samples)
    }

    fn reduced(cube: Memory, bands: Option<(usize, Bands)>, block: usize) -> Memory {
        Memory::load(&mut Reduced::new(cube, bands, block).expect("it can be")).expect("memory does not fail")
    }

    #[test]
    fn a_straight_spectrum_keeps_its_values_and_its_means() {
        let line = |_: usize, _: usize, nm: f64| nm / 100.0;
        for (how, first, step) in [(Bands::Sampled, 400.0, 75.0), (Bands::Averaged, 430.0, 60.0)] {
            let few = reduced(cube(1, 1, 31, line), Some((5, how)), 1);
            for (i, channel) in few.description().channels.iter().enumerate() {
                let Meaning::Band { wavelength_nm, .. } = channel.meaning else { panic!("a band") };
                assert!((wavelength_nm - (first + step * i as f64)).abs() < 1e-9, "{how:?} {wavelength_nm}");
                assert!((f64::from(few.at(0, 0, i)) - wavelength_nm / 100.0).abs() < 1e-6, "{how:?} {i}");
            }
        }
    }

    #[test]
    fn means_over_parts_keep_the_integral() {
        // ∫ of the straight lines is that of the trapezoids.
        let f = |_: usize, _: usize, nm: f64| ((nm * 7.3) % 11.0) + 1.0;
        let whole = cube(1, 1, 31, f);
        let trapezoids: f64 = (0..30).map(|i| 5.0 * f64::from(whole.at(0, 0, i) + whole.at(0, 0, i + 1))).sum();
        for count in [2, 7, 16, 31] {
            let few = reduced(whole.clone(), Some((count, Bands::Averaged)), 1);
            let sum: f64 = (0..count).map(|i| f64::from(few.at(0, 0, i)) * 300.0 / count as f64).sum();
            assert!((sum / trapezoids - 1.0).abs() < 1e-6, "{count}: {sum} {trapezoids}");
        }
    }

    #[test]
    fn blocks_are_means_also_at_the_edges_and_by_region() {
        let f = |x: usize, y: usize, nm: f64| (x + 10 * y) as f64 + nm;
        let small = reduced(cube(5, 3, 2, f), None, 2);
        assert_eq!((small.description().width, small.description().height), (3, 2));
        // x 0–1, y 0–1: 5.5; x 4 alone, y 0–1: 4 + 5; x 2–3, y 2: 2.5 + 20.
        assert_eq!([small.at(0, 0, 0), small.at(2, 0, 0), small.at(1, 1, 1)], [405.5, 409.0, 432.5]);
        let mut source = Reduced::new(cube(5, 3, 2, f), None, 2).expect("it can be");
        let mut out = [0.0; 2];
        source.read(Region { x: 1, y: 1, width: 2, height: 1 }, &[1], &mut out).expect("read");
        assert_eq!(out, [432.5, 434.0]);
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let flat = |_: usize, _: usize, _: f64| 1.0;
        let refused = |bands, block| Reduced::new(cube(2, 2, 4, flat), bands, block).err();
        assert_eq!(refused(Some((5, Bands::Sampled)), 1), Some(ReductionError::Count { found: 5, own: 4 }));
        assert_eq!(refused(Some((1, Bands::Averaged)), 1), Some(ReductionError::Count { found: 1, own: 4 }));
        assert_eq!(refused(None, 0), Some(ReductionError::Block));
    }
}

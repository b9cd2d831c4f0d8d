//! Figures of parts of an image: what a luminance meter would read there, and how even it is.
//!
//! - [`Shape`]: pixels, rectangles, polygons, circles, and spots of a given angle as a camera sees them ([`View`]).
//! - [`probe`]: mean spectrum, photopic quantity with its spread, and XYZ of a shape, in two passes over its pixels and bounded
//!   memory.
//! - [`profile`](profile()): the pixels along a line.

pub mod profile;
pub mod shape;
pub mod view;

pub use profile::{Line, Sample, profile};
pub use shape::{Pixels, Shape, ShapeError};
pub use view::{Projection, View};

use super::description::Description;
use super::error::Error;
use super::photometric::Photometric;
use super::source::{Region, SAMPLES_AT_ONCE, Source, pieces};
use crate::math::order::{Coarse, Fine};

/// What is looked at in each pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Measures {
    /// Channels whose mean is wanted: the good bands by wavelength, or all channels where there are none.
    pub channels: Vec<usize>,
    /// The photopic quantity, where the image has one.
    pub luminance: Option<Photometric>,
    /// X, Y, Z, where the image has them.
    pub xyz: Option<Photometric>,
}

impl Measures {
    /// The channels of an image and the planes given.
    #[must_use]
    pub fn new(image: &Description, luminance: Option<Photometric>, xyz: Option<Photometric>) -> Self {
        let bands: Vec<usize> = image.bands().into_iter().map(|(channel, _)| channel).collect();
        let channels = if bands.is_empty() { (0..image.channels.len()).collect() } else { bands };
        Self { channels, luminance, xyz }
    }

    fn planes(&self) -> usize {
        self.channels.len() + 4
    }

    /// Reads a region: its channels, its luminance, its X, Y, Z; the latter two empty where there are none.
    fn read(&self, source: &mut dyn Source, region: Region, buffers: &mut Buffers) -> Result<(), Error> {
        buffers.channels.resize(region.pixels() * self.channels.len(), 0.0);
        source.read(region, &self.channels, &mut buffers.channels)?;
        if let Some(luminance) = &self.luminance {
            buffers.luminance.resize(region.pixels(), 0.0);
            luminance.of(&mut *source).read(region, &[0], &mut buffers.luminance)?;
        }
        if let Some(xyz) = &self.xyz {
            buffers.xyz.resize(region.pixels() * 3, 0.0);
            xyz.of(&mut *source).read(region, &[0, 1, 2], &mut buffers.xyz)?;
        }
        Ok(())
    }
}

/// Samples of a region, in the order of [`crate::image`].
#[derive(Default)]
struct Buffers {
    channels: Vec<f32>,
    luminance: Vec<f32>,
    xyz: Vec<f32>,
}

impl Buffers {
    /// The samples of one pixel: its channels, luminance, X, Y, Z. `x` and `y` count from the region's corner.
    fn pixel(&self, measures: &Measures, region: Region, x: usize, y: usize, out: &mut Vec<f64>) {
        out.clear();
        let mut take = |samples: &[f32], planes: usize| {
            out.extend((0..planes).map(|p| f64::from(samples[(y * planes + p) * region.width + x])));
        };
        take(&self.channels, measures.channels.len());
        if measures.luminance.is_some() {
            take(&self.luminance, 1);
        }
        if measures.xyz.is_some() {
            take(&self.xyz, 3);
        }
    }
}

/// The photopic quantity over a shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    /// Mean; of a spot weighted by solid angle, as a meter reads it.
    pub mean: f64,
    /// Standard deviation of the pixels about it (divided by their number, not by one less), with the same weights.
    pub standard_deviation: f64,
    /// Smallest value.
    pub min: f64,
    /// Its column and row.
    pub min_at: (usize, usize),
    /// Largest value.
    pub max: f64,
    /// Its column and row.
    pub max_at: (usize, usize),
    /// The percentiles asked for, of pixels alike: see [`Fine::quantiles`].
    pub percentiles: Vec<f64>,
}

impl Spread {
    /// Overall uniformity U₀, minimum over mean (EN 12665, EN 12464-1; of road luminance U_o in EN 13201-3); `None` where the mean
    /// is 0.
    #[must_use]
    pub fn u0(&self) -> Option<f64> {
        (self.mean > 0.0).then(|| self.min / self.mean)
    }

    /// Diversity U_d, minimum over maximum; `None` where the maximum is 0. Times 100 it is the uniformity of displays (IDMS).
    #[must_use]
    pub fn ud(&self) -> Option<f64> {
        (self.max > 0.0).then(|| self.min / self.max)
    }
}

/// The figures of a shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Pixels of the shape.
    pub pixels: u64,
    /// Those that count: all of their samples are finite, and the photopic quantity is not negative.
    pub counted: u64,
    /// Pixels with a sample that is NaN.
    pub nan: u64,
    /// Pixels with an infinite sample, and none that is NaN.
    pub infinite: u64,
    /// Pixels whose photopic quantity is below zero, and all finite.
    pub negative: u64,
    /// Mean of the photopic quantity with the negative pixels, where there are any: what dark noise leaves unbiased.
    pub mean_with_negative: Option<f64>,
    /// Solid angle of the pixels of a spot, sr.
    pub solid_angle_sr: Option<f64>,
    /// Means of [`Measures::channels`], in the samples' unit; empty where no pixel counts, as `luminance` and `xyz` are.
    pub channels: Vec<f64>,
    /// The photopic quantity.
    pub luminance: Option<Spread>,
    /// Mean X, Y, Z.
    pub xyz: Option<[f64; 3]>,
}

/// Looks at a shape: the mean of the samples of its pixels and the spread of their photopic quantity, with `percentiles` from 0 to
/// 100.
///
/// One rule for all figures: a pixel counts where all of its samples are finite and its photopic quantity is not negative. So
/// the mean spectrum has the mean luminance.
///
/// # Errors
/// Those of the source.
///
/// # Panics
/// Where the pixels or the channels lie outside of the image.
pub fn probe(
    source: &mut dyn Source,
    measures: &Measures,
    shape: &Shape,
    pixels: &Pixels,
    percentiles: &[f64],
) -> Result<Probe, Error> {
    let count = measures.channels.len();
    let mut sums = Sums::new(count);
    visit(source, measures, pixels, |(x, y), samples| sums.add((x, y), shape.weight(x, y), samples, measures))?;
    let mut out = Probe {
        pixels: pixels.count(),
        counted: sums.counted,
        nan: sums.nan,
        infinite: sums.infinite,
        negative: sums.negative,
        mean_with_negative: (sums.negative > 0).then(|| sums.luminance_all / sums.weight_all),
        solid_angle_sr: matches!(shape, Shape::Spot { .. }).then_some(sums.weight_shape),
        channels: Vec::new(),
        luminance: None,
        xyz: None,
    };
    if sums.counted == 0 {
        return Ok(out);
    }
    let mean = |sum: &f64| sum / sums.weight;
    out.channels = sums.samples[..count].iter().map(mean).collect();
    if measures.xyz.is_some() {
        let at = count + usize::from(measures.luminance.is_some());
        out.xyz = Some(std::array::from_fn(|k| mean(&sums.samples[at + k])));
    }
    if measures.luminance.is_some() {
        let fractions: Vec<f64> = percentiles.iter().map(|p| p / 100.0).collect();
        let mut fine = sums.coarse.refine(&fractions);
        if !fractions.is_empty() {
            visit(source, measures, pixels, |_, samples| {
                if kind(samples, count, true) == Kind::Counts {
                    add(&mut fine, samples[count]);
                }
            })?;
        }
        out.luminance = Some(Spread {
            mean: sums.mean,
            standard_deviation: (sums.squares / sums.weight).sqrt(),
            min: sums.min.0,
            min_at: sums.min.1,
            max: sums.max.0,
            max_at: sums.max.1,
            percentiles: fine.quantiles(),
        });
    }
    Ok(out)
}

#[expect(clippy::cast_possible_truncation, reason = "it was an f32")]
fn add(fine: &mut Fine, value: f64) {
    fine.add(value as f32);
}

/// Whether a pixel takes part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Counts,
    NotANumber,
    Infinite,
    Negative,
}

fn kind(samples: &[f64], channels: usize, luminance: bool) -> Kind {
    if samples.iter().all(|v| v.is_finite()) {
        if luminance && samples[channels] < 0.0 { Kind::Negative } else { Kind::Counts }
    } else if samples.iter().any(|v| v.is_nan()) {
        Kind::NotANumber
    } else {
        Kind::Infinite
    }
}

struct Sums {
    counted: u64,
    nan: u64,
    infinite: u64,
    negative: u64,
    /// Weights of the pixels that count; with the negative ones; of all.
    weight: f64,
    weight_all: f64,
    weight_shape: f64,
    luminance_all: f64,
    samples: Vec<f64>,
    /// Running mean and sum of squared distances from it (Welford), which do not cancel.
    mean: f64,
    squares: f64,
    min: (f64, (usize, usize)),
    max: (f64, (usize, usize)),
    coarse: Coarse,
}

impl Sums {
    fn new(channels: usize) -> Self {
        Self {
            counted: 0,
            nan: 0,
            infinite: 0,
            negative: 0,
            weight: 0.0,
            weight_all: 0.0,
            weight_shape: 0.0,
            luminance_all: 0.0,
            samples: vec![0.0; channels + 4],
            mean: 0.0,
            squares: 0.0,
            min: (f64::INFINITY, (0, 0)),
            max: (f64::NEG_INFINITY, (0, 0)),
            coarse: Coarse::default(),
        }
    }

    fn add(&mut self, at: (usize, usize), weight: f64, samples: &[f64], measures: &Measures) {
        self.weight_shape += weight;
        let channels = measures.channels.len();
        let luminance = measures.luminance.is_some().then(|| samples[channels]);
        match kind(samples, channels, luminance.is_some()) {
            Kind::Counts => self.counted += 1,
            Kind::NotANumber => self.nan += 1,
            Kind::Infinite => self.infinite += 1,
            Kind::Negative => {
                self.negative += 1;
                self.weight_all += weight;
                self.luminance_all += weight * samples[channels];
            }
        }
        if kind(samples, channels, luminance.is_some()) != Kind::Counts {
            return;
        }
        self.weight += weight;
        self.weight_all += weight;
        self.samples.iter_mut().zip(samples).for_each(|(sum, v)| *sum += weight * v);
        let Some(value) = luminance else { return };
        self.luminance_all += weight * value;
        let from_mean = value - self.mean;
        self.mean += weight / self.weight * from_mean;
        self.squares += weight * from_mean * (value - self.mean);
        if value < self.min.0 {
            self.min = (value, at);
        }
        if value > self.max.0 {
            self.max = (value, at);
        }
        #[expect(clippy::cast_possible_truncation, reason = "it was an f32")]
        self.coarse.add(value as f32);
    }
}

/// Reads the pixels piece by piece and shows each: its place, and its channels, luminance, X, Y, Z.
fn visit(
    source: &mut dyn Source,
    measures: &Measures,
    pixels: &Pixels,
    mut see: impl FnMut((usize, usize), &[f64]),
) -> Result<(), Error> {
    let (mut buffers, mut samples) = (Buffers::default(), Vec::new());
    for piece in pieces(pixels.bounds(), source.block(), SAMPLES_AT_ONCE / measures.planes()) {
        if pixels.within(piece).next().is_none() {
            continue;
        }
        measures.read(source, piece, &mut buffers)?;
        for (y, columns) in pixels.within(piece) {
            for x in columns {
                buffers.pixel(measures, piece, x - piece.x, y - piece.y, &mut samples);
                see((x, y), &samples);
            }
        }
    }
    Ok(())
}

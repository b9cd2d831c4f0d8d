//! How far two images are apart: plane by plane, in luminance, and in colour.
//!
//! Both are read side by side in pieces; nothing grows with their size. Pixels in which either image is NaN or infinite are left
//! out of a plane's figures and counted.

use rayon::prelude::*;

use super::description::{Channel, Description, Meaning};
use super::error::Error;
use super::source::{self, Region, SAMPLES_AT_ONCE, Source, pieces};
use crate::colorimetry::difference::{ciede2000, lab};
use crate::finding::Finding;
use crate::math::order::Coarse;

/// Samples read at a time: two images with their conversions hold several times as many.
const AT_ONCE: usize = SAMPLES_AT_ONCE / 8;

/// How far plane b is from plane a, which is the reference.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Difference {
    /// Pixels compared.
    pub pixels: u64,
    /// Pixels left out, NaN or infinite in either image.
    pub left_out: u64,
    sum: f64,
    squares: f64,
    reference_squares: f64,
    relative_sum: f64,
    relative_pixels: u64,
    /// Largest value of a, the peak of [`Difference::psnr_db`].
    pub peak: f64,
    /// Largest |b − a| and its pixel.
    pub largest: Option<(f64, [usize; 2])>,
    /// Largest |b − a|/|a| over pixels with a ≠ 0, and its pixel.
    pub largest_relative: Option<(f64, [usize; 2])>,
}

impl Difference {
    fn add(&mut self, a: f32, b: f32, at: [usize; 2]) {
        if !(a.is_finite() && b.is_finite()) {
            self.left_out += 1;
            return;
        }
        let (a, b) = (f64::from(a), f64::from(b));
        let d = b - a;
        let larger = |old: Option<(f64, [usize; 2])>, new: f64| old.is_none_or(|(o, _)| new > o);
        self.peak = if self.pixels == 0 { a } else { self.peak.max(a) };
        self.pixels += 1;
        self.sum += d;
        self.squares += d * d;
        self.reference_squares += a * a;
        if larger(self.largest, d.abs()) {
            self.largest = Some((d.abs(), at));
        }
        if a != 0.0 {
            let relative = (d / a).abs();
            self.relative_sum += relative;
            self.relative_pixels += 1;
            if larger(self.largest_relative, relative) {
                self.largest_relative = Some((relative, at));
            }
        }
    }

    /// The mean of b − a; NaN without pixels, as all that follow.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum / self.pixels as f64
    }

    /// √(mean (b − a)²).
    #[must_use]
    pub fn rmse(&self) -> f64 {
        (self.squares / self.pixels as f64).sqrt()
    }

    /// √(Σ (b − a)²/Σ a²); 0 for equal planes, infinite where only a is black.
    #[must_use]
    pub fn relative_rmse(&self) -> f64 {
        if self.squares == 0.0 && self.pixels > 0 { 0.0 } else { (self.squares / self.reference_squares).sqrt() }
    }

    /// The mean of |b − a|/|a| over pixels with a ≠ 0.
    #[must_use]
    pub fn mean_relative(&self) -> f64 {
        self.relative_sum / self.relative_pixels as f64
    }

    /// 20 lg(peak/rmse) dB; infinite for equal planes.
    #[must_use]
    pub fn psnr_db(&self) -> f64 {
        20.0 * (self.peak / self.rmse()).log10()
    }
}

/// Compares channels of two images of the same size, pair by pair (numbers in a and b).
///
/// # Errors
/// Where either cannot be read.
///
/// # Panics
/// Where the sizes differ.
pub fn differences(a: &mut dyn Source, b: &mut dyn Source, pairs: &[(usize, usize)]) -> Result<Vec<Difference>, Error> {
    let (of_a, of_b): (Vec<usize>, Vec<usize>) = pairs.iter().copied().unzip();
    let mut out = vec![Difference::default(); pairs.len()];
    side_by_side(a, b, (&of_a, &of_b), |piece, a, b| {
        let width = piece.width;
        out.par_iter_mut().enumerate().for_each(|(k, out)| {
            for y in 0..piece.height {
                let row = (y * pairs.len() + k) * width;
                for (x, (a, b)) in a[row..][..width].iter().zip(&b[row..][..width]).enumerate() {
                    out.add(*a, *b, [piece.x + x, piece.y + y]);
                }
            }
        });
    })?;
    Ok(out)
}

/// Reads channels of two images of one size in the same pieces.
fn side_by_side(
    a: &mut dyn Source,
    b: &mut dyn Source,
    channels: (&[usize], &[usize]),
    mut each: impl FnMut(Region, &[f32], &[f32]),
) -> Result<(), Error> {
    assert_eq!(size(a), size(b), "images of one size");
    let whole = Region::rows(a.description(), 0, a.description().height);
    let (mut left, mut right) = (Vec::new(), Vec::new());
    let count = channels.0.len().max(1);
    for piece in pieces(whole, a.block(), AT_ONCE / (2 * count)) {
        left.resize(piece.pixels() * channels.0.len(), 0.0);
        right.resize(piece.pixels() * channels.1.len(), 0.0);
        a.read(piece, channels.0, &mut left)?;
        b.read(piece, channels.1, &mut right)?;
        each(piece, &left, &right);
    }
    Ok(())
}

fn size(source: &dyn Source) -> (usize, usize) {
    (source.description().width, source.description().height)
}

/// What a [`Map`] shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Show {
    /// CIEDE2000 of X, Y, Z; NaN where either image has none.
    DeltaE {
        /// X, Y, Z of the white of CIELAB.
        white: [f64; 3],
    },
    /// (b − a)/a of the first plane; NaN where a = 0.
    Relative,
}

/// The difference of two images, pixel by pixel, as an image of one plane.
pub struct Map<'a> {
    a: Box<dyn Source + 'a>,
    b: Box<dyn Source + 'a>,
    show: Show,
    description: Description,
}

impl<'a> Map<'a> {
    /// The map of two images of one size: of X, Y, Z for [`Show::DeltaE`], of one plane else.
    ///
    /// # Panics
    /// Where the sizes differ.
    #[must_use]
    pub fn new(a: Box<dyn Source + 'a>, b: Box<dyn Source + 'a>, show: Show) -> Self {
        assert_eq!(size(&*a), size(&*b), "images of one size");
        let name = match show {
            Show::DeltaE { .. } => "deltaE2000",
            Show::Relative => "relative",
        };
        let (width, height) = size(&*a);
        let description = Description::planes(width, height, vec![Channel::new(name, "", Meaning::Other)]);
        Self { a, b, show, description }
    }
}

impl Source for Map<'_> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn block(&self) -> (usize, usize) {
        self.a.block()
    }

    #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        let show = self.show;
        let planes: &[usize] = if matches!(show, Show::Relative) { &[0] } else { &[0, 1, 2] };
        let mut samples = [const { Vec::new() }; 2];
        for piece in pieces(region, self.a.block(), AT_ONCE / (2 * planes.len())) {
            for (samples, source) in samples.iter_mut().zip([&mut self.a, &mut self.b]) {
                samples.resize(piece.pixels() * planes.len(), 0.0);
                source.read(piece, planes, samples)?;
            }
            let [a, b] = &samples;
            let row_of = |y: usize| (y - piece.y) * planes.len() * piece.width;
            let rows = out.par_chunks_exact_mut(region.width).skip(piece.y - region.y).take(piece.height);
            rows.enumerate().for_each(|(y, row)| {
                let start = row_of(piece.y + y);
                for (x, out) in row[piece.x - region.x..][..piece.width].iter_mut().enumerate() {
                    let of = |samples: &[f32], k: usize| f64::from(samples[start + k * piece.width + x]);
                    *out = match show {
                        Show::Relative if of(a, 0) == 0.0 => f64::NAN,
                        Show::Relative => (of(b, 0) - of(a, 0)) / of(a, 0),
                        Show::DeltaE { white } => {
                            let [p, q] = [a, b].map(|s| lab([0, 1, 2].map(|k| of(s, k)), white));
                            if p.iter().chain(&q).all(|v| v.is_finite()) { ciede2000(p, q) } else { f64::NAN }
                        }
                    } as f32;
                }
            });
        }
        Ok(())
    }

    fn findings(&self) -> Vec<Finding> {
        [self.a.findings(), self.b.findings()].concat()
    }
}

/// Figures of a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Pixels with a value.
    pub pixels: u64,
    /// Pixels without.
    pub left_out: u64,
    /// Mean; NaN without pixels.
    pub mean: f64,
    /// Largest value and its pixel.
    pub largest: Option<(f64, [usize; 2])>,
    /// Quantiles asked for, exact between two values in proportion (Hyndman & Fan 1996, type 7).
    pub quantiles: Vec<f64>,
}

/// Figures of the first plane of an image, in two passes; NaN and infinite values are left out.
///
/// # Errors
/// Where it cannot be read.
pub fn summary(source: &mut dyn Source, fractions: &[f64]) -> Result<Summary, Error> {
    let mut coarse = Coarse::default();
    let (mut sum, mut left_out, mut largest) = (0.0, 0, None::<(f64, [usize; 2])>);
    plane(source, |value, at| {
        if value.is_finite() {
            coarse.add(value);
            let value = f64::from(value);
            sum += value;
            if largest.is_none_or(|(l, _)| value > l) {
                largest = Some((value, at));
            }
        } else {
            left_out += 1;
        }
    })?;
    let mut fine = coarse.refine(fractions);
    plane(source, |value, _| {
        if value.is_finite() {
            fine.add(value);
        }
    })?;
    let pixels = coarse.total();
    Ok(Summary { pixels, left_out, mean: sum / pixels as f64, largest, quantiles: fine.quantiles() })
}

fn plane(source: &mut dyn Source, mut each: impl FnMut(f32, [usize; 2])) -> Result<(), Error> {
    let whole = Region::rows(source.description(), 0, source.description().height);
    let mut samples = Vec::new();
    for piece in pieces(whole, source.block(), AT_ONCE) {
        samples.resize(piece.pixels(), 0.0);
        source.read(piece, &[0], &mut samples)?;
        for (i, value) in samples.iter().enumerate() {
            each(*value, [piece.x + i % piece.width, piece.y + i / piece.width]);
        }
    }
    Ok(())
}

/// Channels of two images with the same meaning, and those of either without a counterpart, by name: bands by wavelength (within
/// 0.001 nm), other planes by name.
#[must_use]
pub fn matched(a: &Description, b: &Description) -> (Vec<(usize, usize)>, Vec<String>) {
    let wavelength = |c: &Channel| match c.meaning {
        Meaning::Band { wavelength_nm, .. } => Some(wavelength_nm),
        _ => None,
    };
    let same = |p: &Channel, q: &Channel| match (wavelength(p), wavelength(q)) {
        (Some(p), Some(q)) => (p - q).abs() <= 1e-3,
        (None, None) => p.name == q.name,
        _ => false,
    };
    let mut pairs = Vec::new();
    let mut alone = Vec::new();
    for (i, channel) in a.channels.iter().enumerate() {
        match b.channels.iter().position(|other| same(channel, other)) {
            Some(j) => pairs.push((i, j)),
            None => alone.push(channel.name.clone()),
        }
    }
    let lonely = |j: &usize| pairs.iter().all(|(_, k)| k != j);
    alone.extend((0..b.channels.len()).filter(lonely).map(|j| b.channels[j].name.clone()));
    (pairs, alone)
}

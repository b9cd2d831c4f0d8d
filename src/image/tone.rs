//! Tone mapping: from luminances to what a screen shows. The last step before an encoded picture, and never on a measurement.
//!
//! | operator | value shown of x | source |
//! |---|---|---|
//! | linear | x | – |
//! | Reinhard | of luminance: L (1 + L/L_white²)/(1 + L); R, G, B in proportion | E. Reinhard et al., "Photographic tone reproduction for digital images", SIGGRAPH 2002, eq. 4 |
//! | filmic | of R, G and B: h(2x)/h(11.2), h(x) = (x(Ax + CB) + DE)/(x(Ax + B) + DF) − E/F | J. Hable, "Uncharted 2: HDR lighting", GDC 2010 |
//!
//! x is linear RGB times 2^EV and, with a key a, times a/L̄: the log-average luminance L̄ (ibid., eq. 1 and 2) is shown as a. The
//! log-average is the exponential of the mean logarithm of the pixels that are not black; the paper adds a small δ to all of them
//! instead, which a black border would dominate. L_white is the largest L of the image, so that nothing is cut (ibid.).

use std::fmt;

use rayon::prelude::*;

use super::description::{Description, Meaning};
use super::error::{Error, ErrorKind};
use super::source::{self, Region, SAMPLES_AT_ONCE, Source, pieces};
use super::tristimulus::luminance_weights;
use crate::colorimetry::rgb::Encoding;
use crate::finding::Finding;

/// The curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// Exposure alone.
    Linear,
    /// Reinhard et al. 2002, global.
    Reinhard,
    /// Hable 2010.
    Filmic,
}

impl fmt::Display for Operator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Linear => "linear",
            Self::Reinhard => "Reinhard 2002",
            Self::Filmic => "filmic (Hable 2010)",
        })
    }
}

/// What is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The curve.
    pub operator: Operator,
    /// Exposure in stops.
    pub exposure_ev: f64,
    /// What the log-average luminance is shown as; without one, (1, 1, 1) stays (1, 1, 1) before the curve.
    pub key: Option<f64>,
}

/// Hable's constants: shoulder and linear strength, linear angle, toe strength, toe numerator and denominator, linear white.
const A: f64 = 0.15;
const B: f64 = 0.50;
const C: f64 = 0.10;
const D: f64 = 0.20;
const E: f64 = 0.02;
const F: f64 = 0.30;
const W: f64 = 11.2;
/// His exposure before the curve.
const BIAS: f64 = 2.0;

fn hable(x: f64) -> f64 {
    (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F
}

/// Luminances of a whole image.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Luminances {
    log_average: f64,
    largest: f64,
}

/// What happens to a pixel.
#[derive(Debug, Clone, Copy)]
struct Curve {
    operator: Operator,
    /// 2^EV and key over log-average.
    scale: f64,
    /// 1/L_white², scaled.
    white: f64,
    weights: [f64; 3],
}

/// An image of linear RGB as an encoded picture.
pub struct Toned<S> {
    source: S,
    description: Description,
    curve: Curve,
    encoding: Encoding,
    channels: [usize; 3],
    samples: Vec<f32>,
}

impl<S: Source> Toned<S> {
    /// The image `source`, linear RGB, through the curve and encoded. Its pixels are read once for the luminances where the
    /// settings need them.
    ///
    /// # Errors
    /// Where the image is no linear RGB; with a key or the Reinhard operator, where no pixel is brighter than black; those of the
    /// source.
    pub fn new(mut source: S, settings: Settings) -> Result<Self, Error> {
        let mut description = source.description().clone();
        let no_rgb = || {
            let expected = "linear RGB, for tone mapping makes a picture to look at, no measurement".to_owned();
            Error::from(ErrorKind::Unsupported { found: "another kind of image".to_owned(), expected })
        };
        let [r, g, b] = [0, 1, 2].map(|k| description.find(Meaning::Primary(k)));
        let (Some(r), Some(g), Some(b)) = (r, g, b) else { return Err(no_rgb()) };
        let channels = [r, g, b];
        let rgb = description.rgb.as_mut().filter(|rgb| !rgb.encoded).ok_or_else(no_rgb)?;
        let weights = luminance_weights(&rgb.space).ok_or_else(no_rgb)?;
        rgb.encoded = true;
        let encoding = rgb.encoding();
        let target = format!("encoded {}", rgb.space.name);
        // What is shown is no longer in proportion to light.
        rgb.white_luminance = None;
        let mut scale = f64::powf(2.0, settings.exposure_ev);
        let mut white = 0.0;
        let mut text = format!("{}, {} EV", settings.operator, settings.exposure_ev);
        if settings.key.is_some() || settings.operator == Operator::Reinhard {
            let found = luminances(&mut source, channels, weights)?;
            if let Some(key) = settings.key {
                scale *= key / found.log_average;
                text.push_str(&format!(", key {key}, log-average {:.6e}", found.log_average));
            }
            let largest = found.largest * scale;
            white = 1.0 / (largest * largest);
            if settings.operator == Operator::Reinhard {
                text.push_str(&format!(", white {:.6e}", found.largest));
            }
        }
        description.channels = channels.map(|c| description.channels[c].clone()).to_vec();
        description.set_attribute("photopic:target", target);
        description.set_attribute("photopic:tone", text);
        let curve = Curve { operator: settings.operator, scale, white, weights };
        Ok(Self { source, description, curve, encoding, channels, samples: Vec::new() })
    }
}

impl Curve {
    /// What is shown of linear RGB, before encoding.
    fn show(&self, rgb: [f64; 3]) -> [f64; 3] {
        let x = rgb.map(|v| v * self.scale);
        match self.operator {
            Operator::Linear => x,
            Operator::Reinhard => {
                let l = x[0] * self.weights[0] + x[1] * self.weights[1] + x[2] * self.weights[2];
                // Below black there is nothing to compress.
                let factor = if l > 0.0 { (1.0 + l * self.white) / (1.0 + l) } else { 1.0 };
                x.map(|v| v * factor)
            }
            Operator::Filmic => x.map(|v| hable(BIAS * v.max(0.0)) / hable(W)),
        }
    }
}

/// One pass over the image.
fn luminances(source: &mut dyn Source, channels: [usize; 3], weights: [f64; 3]) -> Result<Luminances, Error> {
    let whole = Region::rows(source.description(), 0, source.description().height);
    let mut samples = Vec::new();
    let (mut logarithms, mut count, mut largest) = (0.0, 0_u64, 0.0_f64);
    for piece in pieces(whole, source.block(), SAMPLES_AT_ONCE / 3) {
        samples.resize(3 * piece.pixels(), 0.0);
        source.read(piece, &channels, &mut samples)?;
        let of_row = |row: &[f32]| {
            let value = |k: usize, x: usize| weights[k] * f64::from(row[k * piece.width + x]);
            let lit = (0..piece.width).map(|x| value(0, x) + value(1, x) + value(2, x));
            lit.filter(|l| *l > 0.0 && l.is_finite())
                .fold((0.0, 0, 0.0_f64), |(sum, n, top), l| (sum + l.ln(), n + 1, top.max(l)))
        };
        // Rows are added in their order, so that the sum is the same on any number of threads.
        let rows: Vec<_> = samples.par_chunks_exact(3 * piece.width).map(of_row).collect();
        for (sum, n, top) in rows {
            (logarithms, count, largest) = (logarithms + sum, count + n, largest.max(top));
        }
    }
    if count == 0 {
        let found = "no pixel above black".to_owned();
        return Err(ErrorKind::Unexpected { found, expected: "an image with light in it".to_owned() }.into());
    }
    Ok(Luminances { log_average: (logarithms / count as f64).exp(), largest })
}

impl<S: Source> Source for Toned<S> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn block(&self) -> (usize, usize) {
        self.source.block()
    }

    #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        let mut samples = std::mem::take(&mut self.samples);
        samples.resize(3 * region.pixels(), 0.0);
        self.source.read(region, &self.channels, &mut samples)?;
        let width = region.width;
        let rows =
            samples.par_chunks_exact(3 * width.max(1)).zip(out.par_chunks_exact_mut((channels.len() * width).max(1)));
        let (curve, encoding) = (self.curve, self.encoding);
        rows.for_each(|(row, out)| {
            for x in 0..width {
                let shown = curve.show([0, 1, 2].map(|k| f64::from(row[k * width + x])));
                for (k, channel) in channels.iter().enumerate() {
                    out[k * width + x] = encoding.encode(shown[*channel]) as f32;
                }
            }
        });
        self.samples = samples;
        Ok(())
    }

    fn findings(&self) -> Vec<Finding> {
        self.source.findings()
    }
}

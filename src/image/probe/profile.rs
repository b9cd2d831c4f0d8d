//! The pixels along a line.

use super::shape::ShapeError;
use super::{Buffers, Measures};
use crate::image::error::Error;
use crate::image::{Region, Source};

/// A line from the centre of one pixel to that of another, given by column and row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line {
    /// Its first pixel.
    pub from: (usize, usize),
    /// Its last pixel.
    pub to: (usize, usize),
}

impl Line {
    /// Its pixels in order: one for each column, or for each row where it is steeper than 45°, the one whose centre is nearest
    /// to the line.
    ///
    /// # Errors
    /// [`ShapeError::Beyond`] where an end lies outside of an image of `width` × `height` pixels.
    pub fn pixels(&self, width: usize, height: usize) -> Result<Vec<(usize, usize)>, ShapeError> {
        let (a, b) = (self.from, self.to);
        if a.0.max(b.0) >= width || a.1.max(b.1) >= height {
            let shape = format!("line from {}, {} to {}, {}", a.0, a.1, b.0, b.1);
            return Err(ShapeError::Beyond { shape, width, height });
        }
        let steps = a.0.abs_diff(b.0).max(a.1.abs_diff(b.1));
        // a + (b − a) i / steps to the nearest whole number, halves upwards, in whole numbers.
        let between = |a: usize, b: usize, i: usize| match steps {
            0 => a,
            steps => (2 * (a * (steps - i) + b * i) + steps) / (2 * steps),
        };
        Ok((0..=steps).map(|i| (between(a.0, b.0, i), between(a.1, b.1, i))).collect())
    }
}

/// One pixel of a profile; samples are as they are, NaN and infinite ones too.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Its column and row.
    pub at: (usize, usize),
    /// Distance of its centre from that of the first one, pixels.
    pub distance_px: f64,
    /// Samples of [`Measures::channels`].
    pub channels: Vec<f64>,
    /// The photopic quantity.
    pub luminance: Option<f64>,
    /// X, Y, Z.
    pub xyz: Option<[f64; 3]>,
}

/// Reads the pixels of a line, those of [`Line::pixels`].
///
/// # Errors
/// Those of the source.
///
/// # Panics
/// Where a pixel or a channel lies outside of the image.
pub fn profile(source: &mut dyn Source, measures: &Measures, pixels: &[(usize, usize)]) -> Result<Vec<Sample>, Error> {
    let Some(&first) = pixels.first() else { return Ok(Vec::new()) };
    let (mut buffers, mut samples) = (Buffers::default(), Vec::new());
    let mut out = Vec::with_capacity(pixels.len());
    // Runs within one row are read at once.
    for run in pixels.chunk_by(|a, b| a.1 == b.1) {
        let columns = run.iter().map(|p| p.0);
        let (left, right) = (columns.clone().min().unwrap_or(0), columns.max().unwrap_or(0));
        let region = Region { x: left, y: run[0].1, width: right - left + 1, height: 1 };
        measures.read(source, region, &mut buffers)?;
        for &at in run {
            buffers.pixel(measures, region, at.0 - left, 0, &mut samples);
            let mut rest = samples.iter().copied();
            let channels = rest.by_ref().take(measures.channels.len()).collect();
            let luminance = if measures.luminance.is_some() { rest.next() } else { None };
            let xyz = measures.xyz.is_some().then(|| std::array::from_fn(|_| rest.next().unwrap_or(f64::NAN)));
            let distance_px = (at.0 as f64 - first.0 as f64).hypot(at.1 as f64 - first.1 as f64);
            out.push(Sample { at, distance_px, channels, luminance, xyz });
        }
    }
    Ok(out)
}

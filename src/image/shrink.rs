//! One plane of an image made small enough to look at, by averaging over areas.

use super::error::Error;
use super::source::{Region, SAMPLES_AT_ONCE, Source, pieces};
use super::statistics::ChannelStatistics;

/// A plane in memory, and what the whole of it holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row from the top; NaN where no sample is finite.
    pub values: Vec<f32>,
    /// Range, mean and odd values of the samples, not of the averages.
    pub statistics: ChannelStatistics,
}

/// Which part of two averages a pixel belongs to: the first one, its share of that, and the share of the next.
#[derive(Debug, Clone, Copy)]
struct Share {
    at: usize,
    first: f64,
    second: f64,
}

/// The share of each of `from` pixels in `to` averages of equal width, `to` being no more.
fn shares(from: usize, to: usize) -> Vec<Share> {
    // In units of 1/to of a pixel everything is whole.
    (0..from)
        .map(|i| {
            let (start, end) = (i * to, (i + 1) * to);
            let at = start / from;
            let border = ((at + 1) * from).min(end);
            Share { at, first: (border - start) as f64 / to as f64, second: (end - border) as f64 / to as f64 }
        })
        .collect()
}

impl Picture {
    /// Reads a channel of an image and averages it down to at most `width` × `height` pixels, the sides in proportion. A value is
    /// the mean of the finite samples of its rectangle, each with the area that it has in it; a smaller image stays as it is.
    ///
    /// # Errors
    /// Those of the source.
    ///
    /// # Panics
    /// Where the channel is not one of the image.
    pub fn of(source: &mut dyn Source, channel: usize, width: usize, height: usize) -> Result<Self, Error> {
        let (from_width, from_height) = (source.description().width, source.description().height);
        let factor = (width.max(1) as f64 / from_width as f64).min(height.max(1) as f64 / from_height as f64).min(1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not above the side")]
        let side = |from: usize| ((from as f64 * factor).round() as usize).clamp(1, from.max(1));
        let (width, height) = (side(from_width), side(from_height));
        let (across, down) = (shares(from_width, width), shares(from_height, height));
        // Sum and area; one more column and row take what has no share.
        let stride = width + 1;
        let mut sums = vec![(0.0_f64, 0.0_f64); stride * (height + 1)];
        let mut statistics = ChannelStatistics::default();
        let mut samples = Vec::new();
        for piece in pieces(Region::rows(source.description(), 0, from_height), source.block(), SAMPLES_AT_ONCE) {
            samples.resize(piece.pixels(), 0.0);
            source.read(piece, &[channel], &mut samples)?;
            for (y, row) in (piece.y..).zip(samples.chunks_exact(piece.width)) {
                let down = down[y];
                for (across, value) in across[piece.x..].iter().zip(row) {
                    statistics.add(*value);
                    if !value.is_finite() {
                        continue;
                    }
                    let value = f64::from(*value);
                    let corner = down.at * stride + across.at;
                    for (place, area) in [
                        (corner, down.first * across.first),
                        (corner + 1, down.first * across.second),
                        (corner + stride, down.second * across.first),
                        (corner + stride + 1, down.second * across.second),
                    ] {
                        sums[place].0 += area * value;
                        sums[place].1 += area;
                    }
                }
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
        let mean = |(sum, area): &(f64, f64)| if *area > 0.0 { (sum / area) as f32 } else { f32::NAN };
        let rows = sums.chunks_exact(stride).take(height);
        Ok(Self { width, height, values: rows.flat_map(|row| row[..width].iter().map(mean)).collect(), statistics })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{Channel, Description, Meaning, Memory};

    fn picture(width: usize, samples: Vec<f32>, to: usize) -> Picture {
        let channels = vec![Channel::new("Y", "cd/m²", Meaning::Photopic)];
        let description = Description::planes(width, samples.len() / width, channels);
        Picture::of(&mut Memory::new(description, samples), 0, to, 1000).expect("memory does not fail")
    }

    #[test]
    fn averages_are_by_area() {
        // Five pixels to two: 1, 2 and half of 3; half of 3, 4 and 5.
        let p = picture(5, vec![1.0, 2.0, 3.0, 4.0, 5.0], 2);
        assert_eq!((p.width, p.height, p.values), (2, 1, vec![(1.0 + 2.0 + 1.5) / 2.5, (1.5 + 4.0 + 5.0) / 2.5]));
        assert_eq!(p.statistics.mean(), Some(3.0));
        let p = picture(4, vec![1.0, f32::NAN, f32::NAN, f32::INFINITY, 3.0, 5.0, f32::NAN, f32::NAN], 2);
        assert_eq!((p.values[0], p.values[1].is_nan()), (3.0, true));
        assert_eq!((p.statistics.nan, p.statistics.infinite), (4, 1));
    }

    #[test]
    fn the_mean_stays_and_a_small_image_is_not_touched() {
        let samples: Vec<f32> = (0..37 * 23).map(|i| ((i * 7919) % 1009) as f32).collect();
        let mean = samples.iter().map(|v| f64::from(*v)).sum::<f64>() / samples.len() as f64;
        for to in [1, 2, 7, 36] {
            let p = picture(37, samples.clone(), to);
            let got = p.values.iter().map(|v| f64::from(*v)).sum::<f64>() / p.values.len() as f64;
            // Each average is rounded to a float.
            assert!((got / mean - 1.0).abs() < 1e-7, "{to}: {got} {mean}");
        }
        for to in [37, 1000] {
            assert_eq!(picture(37, samples.clone(), to).values, samples);
        }
    }
}

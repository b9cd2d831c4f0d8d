//! Pictures with less noise: every pixel borrows from those around it that look alike.
//!
//! A picture is sampled in two halves that know nothing of one another. Each half is filtered by weights that the luminance of the *other* one
//! gives (`weights`), so that no pixel is chosen for its own noise, and by a fit to what the camera saw there (`fit`): edges and textures
//! that no light made are kept. All bands are filtered by the same numbers. The picture is the mean of both, by their samples.
//!
//! The price is a bias, in exchange for noise. It is measured, not guessed: what one half was filtered to is compared with the other half as it was
//! sampled,
//!
//! ```text
//! ε² = mean over the pixels of [(D_A − B)² − σ²_B + (D_B − A)² − σ²_A] / (2 (L² + (L̄/100)²))
//! ```
//!
//! which is, on average, the squared relative error of a filtered half; that of their mean is no greater (convexity of the square). Readings
//! are never filtered.
//!
//! | file | what it is |
//! |---|---|
//! | [`record`], `rows` | what is kept of a row of pixels; the rows of a picture |
//! | `filter` | a row of pixels, filtered |
//! | `weights` | how alike two pixels are |
//! | `fit` | what each neighbour counts |
//! | `plane`, `tile` | one number per pixel; some pixels of a row and those about them |

use rayon::prelude::*;

use crate::image::description::Description;
use crate::image::error::Error;
use crate::image::source::{self, Region, Source};
use filter::Filter;
use plane::Plane;
use record::{HALVES, Layout, narrow};
use rows::Rows;
use weights::Guide;

mod filter;
mod fit;
mod plane;
pub mod record;
mod rows;
#[cfg(test)]
mod tests;
mod tile;
mod weights;

/// The share of the mean luminance that errors of dark pixels are told relative to.
pub const DARK: f64 = 0.01;

/// How far a picture is off, relative: the root of the mean squared error of luminance over the pixels, each relative to √(L² + (L̄/100)²) of the
/// filtered picture; 0 where its own noise hides it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Price {
    /// As it was sampled.
    pub before: f64,
    /// As it was filtered, at most (but for what is estimated from noise).
    pub after: f64,
}

/// A filtered picture.
#[derive(Debug)]
pub struct Denoised {
    description: Description,
    /// Row by row, all channels one behind the other.
    rows: Vec<Vec<f32>>,
    price: Price,
}

/// Filters the rows of a picture, as [`Film::records`](super::film::Film::records) gives them; `tristimulus` is what each band adds to X, Y and Z.
///
/// # Panics
/// Where there are no rows, or not of the length that the description asks for.
#[must_use]
pub fn denoise(description: Description, tristimulus: &[[f64; 3]], rows: &[Vec<f32>]) -> Denoised {
    let layout = Layout { bands: tristimulus.len() };
    let width = description.width;
    assert!(rows.len() == description.height && rows.iter().all(|row| row.len() == layout.channels() * width), "rows");
    let records = Rows { layout, rows, width };
    let luminous: Vec<f64> = tristimulus.iter().map(|xyz| xyz[1]).collect();
    let halves = [0, 1].map(|half| records.luminance(half, &luminous));
    let guides = [0, 1].map(|half| {
        let variance = |x: usize, y: usize| match records.count(x, y, half) > 1.0 {
            true => records.at(x, y, layout.variance(half)),
            // Where faults left no second sample, one says nothing of itself.
            false => (halves[0].at(x, y) - halves[1].at(x, y)).powi(2) * records.share(x, y, 1 - half),
        };
        let variance = Plane::of(width, rows.len(), variance).smooth();
        Guide { luminance: halves[half].clone(), variance }
    });
    let filtered: Vec<[Vec<f32>; HALVES]> = (0..rows.len())
        .into_par_iter()
        .map_init(
            || Filter::new(width),
            |filter, y| [0, 1].map(|half| filter.row(&records, &guides[1 - half], half, y)),
        )
        .collect();
    let shown = [0, 1].map(|half| {
        Plane::sums(width, rows.len(), |y| luminous.iter().copied().zip(filtered[y][half].chunks_exact(width)))
    });
    let price = price(&records, &halves, &shown);
    let rows = filtered.into_par_iter().enumerate();
    let rows = rows.map(|(y, halves)| joined(&records, y, &halves, tristimulus)).collect();
    Denoised { description, rows, price }
}

/// The errors of a picture, by comparing halves: their luminance as it was sampled and as it was filtered.
fn price(records: &Rows<'_>, sampled: &[Plane; HALVES], filtered: &[Plane; HALVES]) -> Price {
    let (width, height) = (records.width, records.rows.len());
    let both = Plane::of(width, height, |x, y| {
        [0, 1].map(|half| records.share(x, y, half) * filtered[half].at(x, y)).iter().sum()
    });
    let pixels = (width * height) as f64;
    let total: f64 = (0..height).flat_map(|y| both.row(y)).map(|l| f64::from(*l)).sum();
    let dark = DARK * total / pixels;
    let of_row = |y: usize| {
        let (mut before, mut after) = (0.0, 0.0);
        for x in 0..width {
            let relative_to = both.at(x, y).powi(2) + dark * dark;
            if relative_to == 0.0 {
                continue;
            }
            let samples = [0, 1].map(|half| sampled[half].at(x, y));
            let shares = [0, 1].map(|half| records.share(x, y, half));
            // σ² of a sample over the number of both halves, times their shares, is on average:
            let square = (samples[0] - samples[1]).powi(2);
            before += square * shares[0] * shares[1] / relative_to;
            for half in [0, 1] {
                let off = (filtered[half].at(x, y) - samples[1 - half]).powi(2) - square * shares[half];
                after += 0.5 * off / relative_to;
            }
        }
        [before, after]
    };
    // Added row by row in their order: any number of threads gives the same bits.
    let rows: Vec<[f64; 2]> = (0..height).into_par_iter().map(of_row).collect();
    let [before, after] = rows.iter().fold([0.0; 2], |sum, row| [sum[0] + row[0], sum[1] + row[1]]);
    Price { before: (before / pixels).sqrt(), after: (after / pixels).max(0.0).sqrt() }
}

/// The mean of both halves of a row: the bands, then X, Y, Z.
fn joined(records: &Rows<'_>, y: usize, halves: &[Vec<f32>; HALVES], tristimulus: &[[f64; 3]]) -> Vec<f32> {
    let (width, bands) = (records.width, tristimulus.len());
    let mut row = vec![0.0; (bands + 3) * width];
    let shares: Vec<[f64; 2]> = (0..width).map(|x| [0, 1].map(|half| records.share(x, y, half))).collect();
    let (out, colours) = row.split_at_mut(bands * width);
    let mut xyz = vec![0.0; 3 * width];
    for (band, (out, by)) in out.chunks_exact_mut(width).zip(tristimulus).enumerate() {
        let [a, b] = halves.each_ref().map(|half| &half[band * width..][..width]);
        for (out, ((a, b), shares)) in out.iter_mut().zip(a.iter().zip(b).zip(&shares)) {
            *out = narrow(shares[0] * f64::from(*a) + shares[1] * f64::from(*b));
        }
        for (sums, by) in xyz.chunks_exact_mut(width).zip(by) {
            sums.iter_mut().zip(&*out).for_each(|(sum, value)| *sum += by * f64::from(*value));
        }
    }
    colours.iter_mut().zip(xyz).for_each(|(colour, sum)| *colour = narrow(sum));
    row
}

impl Denoised {
    /// What was paid and what was got.
    #[must_use]
    pub fn price(&self) -> Price {
        self.price
    }
}

impl Source for Denoised {
    fn description(&self) -> &Description {
        &self.description
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        let width = self.description.width;
        for (row, out) in self.rows[region.y..].iter().zip(out.chunks_exact_mut((region.width * channels.len()).max(1)))
        {
            for (channel, out) in channels.iter().zip(out.chunks_exact_mut(region.width)) {
                out.copy_from_slice(&row[channel * width + region.x..][..region.width]);
            }
        }
        Ok(())
    }
}

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
//! | `plane` | one number per pixel |

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
mod weights;

/// The share of the mean luminance that errors of dark pixels are told relative to.
const DARK: f64 = 0.01;

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
    let price = price(&records, &halves, &filtered, &luminous);
    let rows = filtered.into_par_iter().enumerate();
    let rows = rows.map(|(y, halves)| joined(&records, y, &halves, tristimulus)).collect();
    Denoised { description, rows, price }
}

/// The errors of a picture, by comparing halves.
fn price(records: &Rows<'_>, halves: &[Plane; HALVES], filtered: &[[Vec<f32>; HALVES]], luminous: &[f64]) -> Price {
    let (width, height) = (records.width, records.rows.len());
    let of = |x: usize, y: usize, half: usize| -> f64 {
        let bands = filtered[y][half].chunks_exact(width).map(|band| f64::from(band[x]));
        bands.zip(luminous).map(|(b, l)| b * l).sum()
    };
    let both =
        Plane::of(width, height, |x, y| [0, 1].map(|half| records.share(x, y, half) * of(x, y, half)).iter().sum());
    let places = || (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixels = (width * height) as f64;
    let dark = DARK * places().map(|(x, y)| both.at(x, y)).sum::<f64>() / pixels;
    let (mut before, mut after) = (0.0, 0.0);
    for (x, y) in places() {
        let relative_to = both.at(x, y).powi(2) + dark * dark;
        if relative_to == 0.0 {
            continue;
        }
        let sampled = [0, 1].map(|half| halves[half].at(x, y));
        let shares = [0, 1].map(|half| records.share(x, y, half));
        // σ² of a sample over the number of both halves, times their shares, is on average:
        let square = (sampled[0] - sampled[1]).powi(2);
        before += square * shares[0] * shares[1] / relative_to;
        for half in [0, 1] {
            let other = 1 - half;
            let off = (of(x, y, half) - sampled[other]).powi(2) - square * shares[half];
            after += 0.5 * off / relative_to;
        }
    }
    Price { before: (before / pixels).sqrt(), after: (after / pixels).max(0.0).sqrt() }
}

/// The mean of both halves of a row: the bands, then X, Y, Z.
fn joined(records: &Rows<'_>, y: usize, halves: &[Vec<f32>; HALVES], tristimulus: &[[f64; 3]]) -> Vec<f32> {
    let (width, bands) = (records.width, tristimulus.len());
    let mut row = vec![0.0; (bands + 3) * width];
    for x in 0..width {
        let shares = [0, 1].map(|half| records.share(x, y, half));
        let mut xyz = [0.0; 3];
        for (band, by) in tristimulus.iter().enumerate() {
            let place = band * width + x;
            let value: f64 = [0, 1].map(|half| shares[half] * f64::from(halves[half][place])).iter().sum();
            xyz.iter_mut().zip(by).for_each(|(sum, by)| *sum += value * by);
            row[place] = narrow(value);
        }
        (bands..).zip(xyz).for_each(|(channel, sum)| row[channel * width + x] = narrow(sum));
    }
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

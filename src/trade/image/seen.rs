//! How an image of a trade is seen: its tristimulus values pixel by pixel, and how far they are from those of the whole image.

use super::{COUNT, ImageError};
use crate::colorimetry::Observer;
use crate::colorimetry::chromaticity::xyz_of_xy;
use crate::colorimetry::difference::{ciede2000, lab};
use crate::colorimetry::rgb::SRGB;
use crate::image::kernel::Weights;
use crate::image::{Channel, Content, Description, Memory, Plan, Settings, Source, Target};
use crate::math::interpolate;
use crate::photometry::alpha_opic;

/// The spline is sampled this many times as finely.
const REFINEMENT: usize = 4;

/// The planes of an image, pixel by pixel.
pub(super) struct Seen {
    pub(super) xyz: Vec<[f32; 3]>,
    /// `None` where the bands do not reach.
    pub(super) melanopic: Option<Vec<f32>>,
    pub(super) width: usize,
}

impl Seen {
    pub(super) fn of(image: &Memory, settings: &Settings) -> Result<Self, ImageError> {
        let plan = Plan::new(image.description(), &Target::Xyz(Observer::Cie1931), settings)?.value;
        let xyz = triples(&planes(image, &plan), image.description().width);
        Ok(Self { xyz, melanopic: melanopic(image, settings), width: image.description().width })
    }
}

/// X, Y and Z pixel by pixel, of planes row by row.
pub(super) fn triples(planes: &[f32], width: usize) -> Vec<[f32; 3]> {
    let rows = planes.chunks_exact(3 * width.max(1));
    rows.flat_map(|row| (0..width).map(move |x| [row[x], row[width + x], row[2 * width + x]])).collect()
}

/// What a plan makes of an image, row by row and plane by plane.
pub(super) fn planes(image: &Memory, plan: &Plan) -> Vec<f32> {
    let (width, channels) = (image.description().width, image.description().channels.len());
    let outputs = plan.description().channels.len();
    let mut out = vec![0.0; image.description().pixels() * outputs];
    let mut row = Vec::with_capacity(plan.channels().len() * width);
    for (samples, out) in image.samples().chunks_exact(channels * width).zip(out.chunks_exact_mut(outputs * width)) {
        row.clear();
        plan.channels().iter().for_each(|c| row.extend_from_slice(&samples[c * width..(c + 1) * width]));
        plan.row(&row, width, out);
    }
    out
}

pub(super) fn melanopic(image: &Memory, settings: &Settings) -> Option<Vec<f32>> {
    let receptor = alpha_opic::RECEPTORS.iter().position(|r| *r == "melanopic")?;
    let target = Target::AlphaOpic { receptor, equivalent_daylight: false };
    let plan = Plan::new(image.description(), &target, settings).ok()?.value;
    Some(planes(image, &plan))
}

/// The whole image, and what its errors are measured by.
pub(super) struct Reference {
    seen: Seen,
    /// Tristimulus values of white.
    white: [f64; 3],
    mean_y: f64,
    mean_melanopic: f64,
    /// CIELAB, pixel by pixel.
    lab: Vec<[f64; 3]>,
}

impl Reference {
    pub(super) fn new(description: &Description, seen: Seen, settings: &Settings) -> Result<Self, ImageError> {
        let y = || seen.xyz.iter().map(|p| f64::from(p[1])).filter(|y| y.is_finite());
        let (sum, largest) = (y().sum::<f64>(), y().fold(0.0, f64::max));
        if !(sum > 0.0 && largest > 0.0) {
            return Err(ImageError::Dark);
        }
        let white = if description.content == Content::Reflectance {
            diffuser(description, settings)?
        } else {
            xyz_of_xy(SRGB.white).map_or([largest; 3], |white| white.map(|v| v * largest))
        };
        let lab = seen.xyz.iter().map(|p| lab(p.map(f64::from), white)).collect();
        let melanopic = seen.melanopic.as_deref().unwrap_or_default();
        let mean_melanopic = melanopic.iter().map(|v| f64::from(*v)).sum::<f64>() / melanopic.len() as f64;
        Ok(Self { white, mean_y: sum / seen.xyz.len() as f64, mean_melanopic, lab, seen })
    }

    /// The errors of [`FIGURES`] of an image whose pixels stand for blocks of these.
    pub(super) fn errors(&self, other: &Seen, block: usize) -> [Option<f64>; COUNT] {
        let width = self.seen.width;
        let place = |i: usize| (i / width / block) * other.width + (i % width) / block;
        let (mut count, mut coloured) = (0_usize, 0_usize);
        let (mut squares, mut apart, mut colours, mut worst) = (0.0, 0.0, 0.0, 0.0_f64);
        for (i, own) in self.seen.xyz.iter().enumerate() {
            let (a, b) = (own.map(f64::from), other.xyz[place(i)].map(f64::from));
            if !a.iter().all(|v| v.is_finite()) {
                continue;
            }
            if !b.iter().all(|v| v.is_finite()) {
                // Beyond what half precision holds.
                return [None; COUNT];
            }
            count += 1;
            squares += (a[1] - b[1]).powi(2);
            let sums = [a, b].map(|p| p.iter().sum::<f64>());
            if sums.iter().all(|s| *s > 0.0) {
                coloured += 1;
                apart += (a[0] / sums[0] - b[0] / sums[1]).powi(2) + (a[1] / sums[0] - b[1] / sums[1]).powi(2);
            }
            let difference = ciede2000(self.lab[i], lab(b, self.white));
            colours += difference;
            worst = worst.max(difference);
        }
        let melanopic = self.seen.melanopic.as_ref().zip(other.melanopic.as_ref()).map(|(own, found)| {
            let squares = own.iter().enumerate().map(|(i, v)| f64::from(v - found[place(i)]).powi(2));
            (squares.filter(|s| s.is_finite()).sum::<f64>() / own.len() as f64).sqrt() / self.mean_melanopic
        });
        let count = count as f64;
        let all = [
            Some((squares / count).sqrt() / self.mean_y),
            Some((apart / coloured as f64).sqrt()),
            Some(colours / count),
            Some(worst),
            melanopic,
        ];
        all.map(|e| e.filter(|e| e.is_finite()))
    }
}

/// Tristimulus values of the perfect diffuser under the light of the settings.
pub(super) fn diffuser(description: &Description, settings: &Settings) -> Result<[f64; 3], ImageError> {
    let white = Description { width: 1, height: 1, ..description.clone() };
    let samples = vec![1.0; white.channels.len()];
    let seen = Seen::of(&Memory::new(white, samples), settings)?;
    Ok(seen.xyz[0].map(f64::from))
}

/// The image with [`REFINEMENT`] times as many bands, on the spline through its own.
pub(super) fn refined(image: &Memory) -> Memory {
    let description = image.description();
    let bands = description.bands();
    let nm: Vec<f64> = bands.iter().map(|(_, nm)| *nm).collect();
    let steps = (bands.len() - 1) * REFINEMENT;
    let fine = |i: usize| {
        let (at, part) = (i / REFINEMENT, i % REFINEMENT);
        if part == 0 { nm[at] } else { nm[at] + (nm[at + 1] - nm[at]) * part as f64 / REFINEMENT as f64 }
    };
    let fine: Vec<f64> = (0..=steps).map(fine).collect();
    // Splines are linear in their values: once for each band, then weights.
    let weights: Vec<Vec<f64>> = (0..nm.len())
        .map(|band| {
            let unit: Vec<f64> = (0..nm.len()).map(|i| if i == band { 1.0 } else { 0.0 }).collect();
            let slopes = interpolate::spline_slopes(&nm, &unit);
            fine.iter().map(|at| interpolate::hermite(&nm, &unit, &slopes, *at)).collect()
        })
        .collect();
    let columns: Vec<Vec<f64>> = (0..fine.len()).map(|i| weights.iter().map(|w| w[i]).collect()).collect();
    let kernel = Weights::new(&columns);
    let (width, channels) = (description.width, description.channels.len());
    let unit = description.channels[bands[0].0].unit.clone();
    let mut fine_description = description.clone();
    fine_description.channels = fine.iter().map(|nm| Channel::band(format!("{nm} nm"), unit.clone(), *nm)).collect();
    let mut samples = vec![0.0; description.pixels() * fine.len()];
    let mut row = Vec::with_capacity(bands.len() * width);
    let rows = image.samples().chunks_exact(channels * width);
    for (own, out) in rows.zip(samples.chunks_exact_mut(fine.len() * width)) {
        row.clear();
        bands.iter().for_each(|(c, _)| row.extend_from_slice(&own[c * width..(c + 1) * width]));
        kernel.apply(&row, width, out, width);
    }
    Memory::new(fine_description, samples)
}

//! How an image of a trade is kept: with fewer bands, pixels or bits, or in RGB.

use exr::prelude::f16;

use super::seen::{Seen, diffuser, melanopic, planes, triples};
use super::{Choice, ImageError, Spectral};
use crate::colorimetry::Observer;
use crate::colorimetry::rgb::SRGB;
use crate::constants::SecondRadiation;
use crate::illuminant::named;
use crate::image::kernel::Weights;
use crate::image::reduced::Reduced;
use crate::image::{Channel, Content, Description, Error, Memory, Plan, PlanError, Settings, Source, Target};

/// The image in RGB, and the way from there to X, Y and Z.
pub(super) struct Rgb {
    image: Memory,
    to_xyz: Weights,
}

impl Rgb {
    pub(super) fn of(image: &Memory, settings: &Settings) -> Result<Self, ImageError> {
        let description = image.description();
        let degenerate = || PlanError::Degenerate { space: SRGB.name.to_owned() };
        let to_xyz = SRGB.to_xyz().ok_or_else(degenerate)?;
        let from_xyz = to_xyz.inverse();
        let reflects = description.content == Content::Reflectance;
        let mut under = settings.clone();
        let mut light = glam::DVec3::ONE;
        if reflects {
            light = from_xyz * glam::DVec3::from(diffuser(description, settings)?);
            let d65 = named::source("D65", SecondRadiation::default());
            under.illuminant = d65.ok().map(|d65| (d65.name, d65.spectrum));
            under.white_luminance = None;
        }
        let seen = Seen::of(image, &under)?;
        let white =
            if reflects { from_xyz * glam::DVec3::from(diffuser(description, &under)?) } else { glam::DVec3::ONE };
        let (width, height) = (description.width, description.height);
        let mut samples = vec![0.0; 3 * seen.xyz.len()];
        for (pixel, xyz) in seen.xyz.iter().enumerate() {
            let rgb = (from_xyz * glam::DVec3::from(xyz.map(f64::from)) / white).max(glam::DVec3::ZERO);
            let (x, y) = (pixel % width, pixel / width);
            for k in 0..3 {
                samples[(3 * y + k) * width + x] = rgb[k] as f32;
            }
        }
        let channels = ["R", "G", "B"].map(|n| Channel::new(n, "", crate::image::Meaning::Other)).to_vec();
        // Column k of the matrix is what channel k gives.
        let columns: Vec<Vec<f64>> =
            (0..3).map(|out| (0..3).map(|k| to_xyz.col(k)[out] * light[k]).collect()).collect();
        let image = Memory::new(Description::planes(width, height, channels), samples);
        Ok(Self { image, to_xyz: Weights::new(&columns) })
    }
}

/// An image as a trial keeps it.
pub(super) struct Kept {
    image: Memory,
    way: Way,
}

enum Way {
    Plan(Box<Plan>),
    Rgb(Weights),
}

impl Kept {
    pub(super) fn new(image: &Memory, rgb: &Rgb, choice: Choice, settings: &Settings) -> Result<Self, ImageError> {
        let (source, bands) = match choice.spectral {
            Spectral::Own => (image, None),
            Spectral::Fewer(n, how) => (image, Some((n, how))),
            Spectral::Rgb => (&rgb.image, None),
        };
        // The counts are those of the image: neither this nor reading from memory fails.
        let reduced = Reduced::new(source.clone(), bands, choice.block);
        let none = |_: Error| ImageError::Dark;
        let mut reduced = reduced.map_err(|_| ImageError::Bands { found: 0 })?;
        let mut kept = Memory::load(&mut reduced).map_err(none)?;
        if choice.half {
            let samples = kept.samples().iter().map(|v| f16::from_f32(*v).to_f32()).collect();
            kept = Memory::new(kept.description().clone(), samples);
        }
        let way = match choice.spectral {
            Spectral::Rgb => Way::Rgb(rgb.to_xyz.clone()),
            _ => Way::Plan(Box::new(Plan::new(kept.description(), &Target::Xyz(Observer::Cie1931), settings)?.value)),
        };
        Ok(Self { image: kept, way })
    }

    /// X, Y and Z, row by row and plane by plane.
    pub(super) fn xyz(&self) -> Vec<f32> {
        match &self.way {
            Way::Plan(plan) => planes(&self.image, plan),
            Way::Rgb(weights) => {
                let width = self.image.description().width;
                let mut out = vec![0.0; self.image.samples().len()];
                let rows = self.image.samples().chunks_exact(3 * width).zip(out.chunks_exact_mut(3 * width));
                rows.for_each(|(row, out)| weights.apply(row, width, out, width));
                out
            }
        }
    }

    pub(super) fn seen(&self, settings: &Settings) -> Result<Seen, ImageError> {
        let width = self.image.description().width;
        let melanopic = match self.way {
            Way::Plan(_) => melanopic(&self.image, settings),
            Way::Rgb(_) => None,
        };
        Ok(Seen { xyz: triples(&self.xyz(), width), melanopic, width })
    }
}

//! From the photographs of a manifest to linear pictures: camera, noise, response, merged exposures, vignetting.

use std::collections::HashMap;

use glam::DVec2;
use rayon::prelude::*;

use super::brdf;
use super::calibrate::find_views;
use super::photos::Photos;
use super::response::{disagreements, read_table, samples};
use crate::capture::Error;
use crate::capture::camera::{Calibration, calibrate_lean};
use crate::capture::flat::Vignetting;
use crate::capture::manifest::{Exposure, Shows, Stack};
use crate::capture::merge::{Merge, Range, Respond};
use crate::capture::noise::{Noise, Residuals};
use crate::capture::radiance::Radiance;
use crate::capture::response::{Curve, Sampling, check_order, consistency, smooth};
use crate::cli::Failure;
use crate::finding::{Finding, Location};

/// Standard deviations of the noise of a dark code from which on a code is of use.
const ABOVE_NOISE: f64 = 4.0;
/// About how many pixels of each stack the response is found from.
const PIXELS: usize = 4096;
/// Rms of a flat field from which on it is told that it is none.
const UNEVEN: f64 = 0.01;
/// Pictures are kept up to so many samples, about 1 GiB with their errors; beyond, they are merged again when they are asked for.
const KEPT: usize = 100_000_000;

/// What photographs are developed with.
pub(super) struct Darkroom {
    /// The camera, where the board told it.
    pub calibration: Option<Calibration>,
    /// Of codes; `None` where all pictures are linear.
    pub noise: Option<Noise>,
    /// What the flat field told.
    pub vignetting: Option<Vignetting>,
    respond: Option<Respond>,
    /// Per channel, radiance over what merging gives.
    scale: Option<Vec<f64>>,
    kept: HashMap<String, Radiance>,
}

impl Darkroom {
    /// Calibrates camera, noise, response and vignetting, as far as the manifest has what it takes and does not state the result.
    pub(super) fn open(photos: &mut Photos) -> Result<Self, Failure> {
        let mut room =
            Self { calibration: None, noise: None, vignetting: None, respond: None, scale: None, kept: HashMap::new() };
        room.calibrate(photos)?;
        if room.find_noise(photos)? {
            room.find_response(photos)?;
        }
        room.find_vignetting(photos)?;
        Ok(room)
    }

    /// The response, where photographs were developed with one.
    pub(super) fn curves(&self) -> Option<&[Curve]> {
        if let Some(Respond::Curves(curves)) = &self.respond { Some(curves) } else { None }
    }

    fn calibrate(&mut self, photos: &mut Photos) -> Result<(), Failure> {
        let wanting = photos.manifest.camera.as_ref().is_some_and(|c| c.lens().is_err());
        let Some(board) = photos.manifest.board.clone().filter(|b| wanting && !b.views.is_empty()) else {
            return Ok(());
        };
        photos.notes.stage(&format!("camera: {} views of the board", board.views.len()));
        let views = find_views(photos, &board.views, board.corners, board.square_m.unwrap_or(1.0));
        let found = calibrate_lean(&views).map_err(|e| {
            photos.notes.print(&photos.findings);
            Failure::Message(e.to_string())
        })?;
        if let Some(camera) = &mut photos.manifest.camera {
            camera.set_lens(&found.camera);
        }
        self.calibration = Some(found);
        Ok(())
    }

    /// Measures the noise of all photographs of stacks that are not linear; whether there are such.
    fn find_noise(&mut self, photos: &mut Photos) -> Result<bool, Failure> {
        let stacks = photos.manifest.stack.clone();
        let mut residuals: Option<Residuals> = None;
        photos.notes.stage(&format!("noise: {} stacks", stacks.len()));
        for stack in &stacks {
            // Those that cannot be read are told when they are merged; a stack is of one kind.
            let mut decoded = Vec::new();
            for exposure in &stack.exposures {
                decoded.extend(photos.photo(&exposure.photo));
                if decoded.last().is_some_and(crate::capture::Photo::is_linear) {
                    decoded.clear();
                    break;
                }
            }
            let each: Vec<Residuals> = decoded
                .par_iter()
                .map(|p| {
                    let mut one = Residuals::default();
                    one.add(p);
                    one
                })
                .collect();
            for one in &each {
                residuals.get_or_insert_default().merge(one);
            }
        }
        self.noise = residuals.map(|r| r.noise());
        Ok(self.noise.is_some())
    }

    fn find_response(&mut self, photos: &mut Photos) -> Result<(), Failure> {
        let stated = photos.manifest.response.clone();
        self.respond = Some(match &stated.file {
            _ if stated.linear => Respond::Linear,
            Some(file) => {
                let path = photos.path(file);
                let bytes = photos.bytes(&path)?;
                Respond::Curves(read_table(&path, &bytes)?)
            }
            None => {
                photos.notes.stage("response");
                let stacks = samples(photos, Sampling { pixels: PIXELS })?;
                let failed = |e: Error| Failure::Message(e.to_string());
                check_order(&stacks).map_err(failed)?;
                let (Some(noise), dark) = (&self.noise, self.range().dark) else { return Ok(()) };
                let curves = smooth(&stacks, noise, dark).map_err(failed)?;
                disagreements(photos, &consistency(&stacks, &curves));
                Respond::Curves(curves)
            }
        });
        Ok(())
    }

    /// Codes that are of use: those above the noise of the dark.
    fn range(&self) -> Range {
        let default = Range::default();
        let Some(noise) = &self.noise else { return default };
        let dark = (0..noise.channels()).map(|c| ABOVE_NOISE * noise.at(c, 0.0)).fold(default.dark, f64::max);
        Range { dark, ..default }
    }

    fn find_vignetting(&mut self, photos: &mut Photos) -> Result<(), Failure> {
        let flat = photos.manifest.stack.iter().find(|s| s.shows == Shows::Flat).cloned();
        let Some(flat) = flat else { return Ok(()) };
        if photos.manifest.flat.is_some() && !photos.manifest.wavelengths_nm().is_empty() {
            let words = "found a [flat] of known radiance beside stacks of narrow bands, whose filters it does not tell; expected strengths \
                         of the lights with unit_w_per_m2_sr, or a reference";
            return Err(Failure::Message(words.to_owned()));
        }
        photos.notes.stage("vignetting");
        let (picture, _) = self.merged(photos, &flat)?;
        let lens = photos.manifest.camera.as_ref().and_then(|c| c.lens().ok());
        let centre = lens.map(|l| DVec2::new(l.intrinsics.cx, l.intrinsics.cy));
        let found = Vignetting::fit(&flat.name, &picture, centre).map_err(|e| Failure::Message(e.to_string()))?;
        if found.rms > UNEVEN {
            let words = format!("the flat field differs from a smooth falloff by {:.1} % rms", 100.0 * found.rms);
            let place = Location::default().of_item(&flat.name);
            photos
                .findings
                .push(Finding::warning("K026", words).hint("is it evenly lit, out of focus and clean?").at(place));
        }
        if let Some(stated) = &photos.manifest.flat {
            let (bands, level) = (&stated.radiance, &found.level);
            if bands.len() != 1 && bands.len() != level.len() {
                return Err(Failure::Message(format!(
                    "found {} radiances in [flat]; expected one, or one for each of the {} channels",
                    bands.len(),
                    level.len()
                )));
            }
            let factor = |(c, l): (usize, &f64)| bands[c.min(bands.len() - 1)] / l;
            self.scale = Some(level.iter().enumerate().map(factor).collect());
            // From here on a sample of 1 is a radiance of 1.
            photos.manifest.radiance.unit_w_per_m2_sr = Some(1.0);
        }
        self.vignetting = Some(found);
        Ok(())
    }

    /// The linear picture of a stack, without vignetting, and its name: the one that there is, or its exposures merged.
    pub(super) fn picture(&mut self, photos: &mut Photos, stack: &Stack) -> Result<(Radiance, String), Failure> {
        if let Some(picture) = self.kept.remove(&stack.name) {
            return Ok((picture, stack.name.clone()));
        }
        let (mut picture, name) = self.merged(photos, stack)?;
        if let Some(vignetting) = &self.vignetting {
            vignetting.undo(&mut picture);
        }
        if let Some(scale) = self.scale.as_ref().filter(|s| s.len() == picture.channels) {
            picture.scale(scale);
        }
        if picture.states.is_some() {
            // What merging took as valid may still be beyond the limits of the manifest.
            picture.mark(&photos.manifest.radiance);
        }
        Ok((picture, name))
    }

    /// Keeps a picture for the next time that it is asked for, if there is room.
    pub(super) fn keep(&mut self, stack: &Stack, picture: Radiance) {
        let samples: usize = self.kept.values().map(|p| p.values.len()).sum();
        if samples + picture.values.len() <= KEPT {
            self.kept.insert(stack.name.clone(), picture);
        }
    }

    fn merged(&self, photos: &mut Photos, stack: &Stack) -> Result<(Radiance, String), Failure> {
        let (Some(respond), Some(noise)) = (&self.respond, &self.noise) else { return brdf::picture(photos, stack) };
        if let [one] = stack.exposures.as_slice()
            && photos.photo(&one.photo).is_ok_and(|p| p.is_linear())
        {
            return brdf::picture(photos, stack);
        }
        photos.notes.stage(&format!("merging {}", stack.name));
        let mut exposures: Vec<&Exposure> = stack.exposures.iter().collect();
        let time = |e: &Exposure| e.time_s.unwrap_or(0.0);
        // The longest tells most of the dark, and what the others should be.
        exposures.sort_by(|a, b| time(b).total_cmp(&time(a)));
        let range = self.range();
        let mut merge: Option<Merge> = None;
        for exposure in exposures {
            let added = photos.exposure(exposure).and_then(|(photo, time_s)| {
                if photo.channels > noise.channels() {
                    return Err(Failure::Message(format!("found {}; expected it like the others", photo.size())));
                }
                let sum = merge.get_or_insert_with(|| Merge::new(&photo, range, noise.clone()));
                let respond = if photo.is_linear() { &Respond::Linear } else { respond };
                sum.add(&exposure.photo, time_s, &photo, respond).map_err(|e| Failure::Message(e.to_string()))
            });
            if let Err(failure) = added {
                photos.left_out(&exposure.photo, &failure);
            }
        }
        let merge = merge.filter(|m| m.counts()[0] > 0).ok_or_else(|| {
            let why = "no exposure of it has a sample within the range".to_owned();
            Failure::Message(Error::Nothing { stack: stack.name.clone(), why }.to_string())
        })?;
        Ok((merge.radiance(), stack.name.clone()))
    }
}

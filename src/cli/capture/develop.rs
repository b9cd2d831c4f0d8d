//! From the photographs of a manifest to linear pictures: camera, noise, response, merged exposures, vignetting.

use std::collections::HashMap;
use std::fs::File;

use glam::DVec2;
use rayon::prelude::*;

use super::calibrate::find_views;
use super::photos::Photos;
use super::response::{disagreements, read_table, samples};
use crate::capture::Error;
use crate::capture::camera::{Calibration, calibrate_lean};
use crate::capture::flat::Vignetting;
use crate::capture::manifest::{Shows, Stack};
use crate::capture::merge::{Merge, Range, Respond};
use crate::capture::noise::{Noise, Residuals};
use crate::capture::radiance::{Radiance, RadianceRows};
use crate::capture::response::{Curve, Sampling, check_order, consistency, smooth};
use crate::capture::rows::PhotoRows;
use crate::cli::Failure;
use crate::finding::{Finding, Location};

/// Standard deviations of the noise of a dark code from which on a code is of use.
const ABOVE_NOISE: f64 = 4.0;
/// About how many pixels of each stack the response is found from.
const PIXELS: usize = 4096;
/// Rms of a flat field from which on it is told that it is none.
const UNEVEN: f64 = 0.01;
/// Pictures are kept up to so many samples, about 270 MB with their errors; beyond, they are merged again when they are asked for.
const KEPT: usize = 30_000_000;
/// Samples of a picture that are made at once.
const SAMPLES_AT_ONCE: usize = 1 << 22;

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
    kept: HashMap<String, Vec<Radiance>>,
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
            let mut opened = Vec::new();
            for exposure in &stack.exposures {
                opened.extend(photos.rows(&exposure.photo));
                if opened.last().is_some_and(|p| p.is_linear) {
                    opened.clear();
                    break;
                }
            }
            let each: Vec<Residuals> = opened
                .par_iter_mut()
                .map(|rows| {
                    let mut one = Residuals::default();
                    // What is damaged is told when it is merged.
                    let _ = one.add_rows(rows);
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
        let picture = self.merged(photos, &flat)?.whole(photos, self)?;
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

    /// The linear picture of a stack, without vignetting, from its top: the one that there is, or its exposures merged.
    pub(super) fn develop(&mut self, photos: &mut Photos, stack: &Stack) -> Result<Developing, Failure> {
        match self.kept.remove(&stack.name) {
            Some(pieces) => Ok(Developing::kept(&stack.name, pieces)),
            None => self.merged(photos, stack),
        }
    }

    /// The same as a whole.
    pub(super) fn picture(&mut self, photos: &mut Photos, stack: &Stack) -> Result<Radiance, Failure> {
        self.develop(photos, stack)?.whole(photos, self)
    }

    /// For how many samples of pictures there is room.
    pub(super) fn room(&self) -> usize {
        KEPT.saturating_sub(self.kept.values().flatten().map(|p| p.values.len()).sum())
    }

    /// Keeps the pieces of a picture for the next time that it is asked for; none where there was no room for them.
    pub(super) fn keep(&mut self, stack: &Stack, pieces: Vec<Radiance>) {
        if !pieces.is_empty() {
            self.kept.insert(stack.name.clone(), pieces);
        }
    }

    /// What merging gives, without vignetting and in its scale.
    fn finish(&self, photos: &Photos, piece: &mut Radiance, top: usize) {
        if let Some(vignetting) = &self.vignetting {
            vignetting.undo(piece, top);
        }
        if let Some(scale) = self.scale.as_ref().filter(|s| s.len() == piece.channels) {
            piece.scale(scale);
        }
        if piece.states.is_some() {
            // What merging took as valid may still be beyond the limits of the manifest.
            piece.mark(&photos.manifest.radiance);
        }
    }

    fn merged(&self, photos: &mut Photos, stack: &Stack) -> Result<Developing, Failure> {
        let (Some(_), Some(noise)) = (&self.respond, &self.noise) else { return Developing::linear(photos, stack) };
        if let [one] = stack.exposures.as_slice()
            && photos.rows(&one.photo).is_ok_and(|p| p.is_linear)
        {
            return Developing::linear(photos, stack);
        }
        photos.notes.stage(&format!("merging {}", stack.name));
        Developing::exposures(photos, stack, noise.channels())
    }
}

/// A picture from its top: rows are asked for, and made when they are.
pub(super) struct Developing {
    /// What to call it.
    pub name: String,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1 or 3.
    pub channels: usize,
    given: usize,
    from: From,
}

enum From {
    /// Pieces that were made before.
    Kept(std::vec::IntoIter<Radiance>),
    /// A linear picture.
    Linear(RadianceRows<File>),
    /// Exposures, the longest first: it tells most of the dark, and what the others should be.
    Exposures(Vec<Opened>),
}

/// An exposure that is being read.
struct Opened {
    photo: String,
    time_s: f64,
    rows: PhotoRows<File>,
}

impl Developing {
    fn kept(name: &str, pieces: Vec<Radiance>) -> Self {
        let (width, channels) = pieces.first().map_or((0, 1), |p| (p.width, p.channels));
        let height = pieces.iter().map(|p| p.height).sum();
        Self { name: name.to_owned(), width, height, channels, given: 0, from: From::Kept(pieces.into_iter()) }
    }

    fn linear(photos: &mut Photos, stack: &Stack) -> Result<Self, Failure> {
        let [exposure] = stack.exposures.as_slice() else {
            return Err(Failure::Message(format!(
                "found {} exposures in {}; expected one linear picture: `photopic capture merge` makes it",
                stack.exposures.len(),
                stack.name
            )));
        };
        let path = photos.path(&exposure.photo);
        // A picture that says nothing of its time, such as a merged one, is radiance already.
        let time_s = photos.time_s(exposure)?.unwrap_or(1.0);
        let wrong = |e: Error| Failure::Message(format!("{path}: {e}"));
        if !(time_s > 0.0 && time_s.is_finite()) {
            return Err(wrong(Error::Time { name: exposure.photo.clone(), time_s }));
        }
        let rows = RadianceRows::open(photos.file(&path)?, time_s).map_err(wrong)?;
        let (width, height, channels) = (rows.width, rows.height, rows.channels);
        Ok(Self { name: path, width, height, channels, given: 0, from: From::Linear(rows) })
    }

    fn exposures(photos: &mut Photos, stack: &Stack, channels: usize) -> Result<Self, Failure> {
        let mut opened: Vec<Opened> = Vec::new();
        for exposure in &stack.exposures {
            let photo = exposure.photo.clone();
            let found = photos.exposure_rows(exposure).and_then(|(rows, time_s)| match time_s {
                t if !(t > 0.0 && t.is_finite()) => {
                    Err(Failure::Message(Error::Time { name: photo.clone(), time_s }.to_string()))
                }
                _ if rows.channels > channels => {
                    Err(Failure::Message(format!("found {}; expected it like the others", rows.size())))
                }
                _ => Ok(Opened { photo, time_s, rows }),
            });
            match found {
                Ok(one) => opened.push(one),
                Err(failure) => photos.left_out(&exposure.photo, &failure),
            }
        }
        opened.sort_by(|a, b| b.time_s.total_cmp(&a.time_s));
        let Some(first) = opened.first() else {
            let why = "no exposure of it can be read".to_owned();
            return Err(Failure::Message(Error::Nothing { stack: stack.name.clone(), why }.to_string()));
        };
        let (expected, width, height) = (first.rows.size(), first.rows.width, first.rows.height);
        let channels = first.rows.channels;
        for other in opened.extract_if(.., |o| o.rows.size() != expected) {
            let error = Error::Size { name: other.photo.clone(), found: other.rows.size(), expected: expected.clone() };
            photos.left_out(&other.photo, &Failure::Message(error.to_string()));
        }
        Ok(Self { name: stack.name.clone(), width, height, channels, given: 0, from: From::Exposures(opened) })
    }

    /// The next rows; `None` when there are no more, or where a file is damaged: what came before counts, and it is told.
    pub(super) fn next(&mut self, photos: &mut Photos, room: &Darkroom) -> Result<Option<Radiance>, Failure> {
        let (top, left) = (self.given, self.height - self.given);
        let rows = (SAMPLES_AT_ONCE / (self.width * self.channels).max(1)).max(1).min(left);
        if rows == 0 {
            return Ok(None);
        }
        let damaged = |path: &str, error: &Error| {
            let after = if top > 0 { format!("from row {top} on: ") } else { String::new() };
            Failure::Message(format!("{after}{path}: {error}"))
        };
        let piece = match &mut self.from {
            From::Kept(pieces) => {
                let piece = pieces.next();
                self.given += piece.as_ref().map_or(left, |p| p.height);
                return Ok(piece);
            }
            From::Linear(picture) => match picture.next(rows) {
                Ok(piece) => Some(piece),
                Err(error) if top == 0 => return Err(damaged(&self.name, &error)),
                Err(error) => {
                    photos.left_out(&self.name, &damaged(&self.name, &error));
                    None
                }
            },
            From::Exposures(opened) => {
                let (Some(respond), Some(noise)) = (&room.respond, &room.noise) else { return Ok(None) };
                let mut parts = Vec::with_capacity(opened.len());
                opened.retain_mut(|one| match one.rows.next(rows) {
                    Ok(part) => {
                        parts.push(part);
                        true
                    }
                    Err(error) => {
                        let path = photos.path(&one.photo);
                        photos.left_out(&one.photo, &damaged(&path, &error));
                        false
                    }
                });
                let mut merge: Option<Merge> = None;
                for (one, part) in opened.iter().zip(&parts) {
                    let sum = merge.get_or_insert_with(|| Merge::new(part, room.range(), noise.clone()));
                    let respond = if one.rows.is_linear { &Respond::Linear } else { respond };
                    sum.add(&one.photo, one.time_s, part, respond).map_err(|e| Failure::Message(e.to_string()))?;
                }
                merge.map(|m| m.radiance())
            }
        };
        let Some(mut piece) = piece else {
            self.given = self.height;
            return Ok(None);
        };
        self.given += piece.height;
        room.finish(photos, &mut piece, top);
        Ok(Some(piece))
    }

    /// All rows.
    fn whole(mut self, photos: &mut Photos, room: &Darkroom) -> Result<Radiance, Failure> {
        let mut out: Option<Radiance> = None;
        while let Some(piece) = self.next(photos, room)? {
            match &mut out {
                None => out = Some(piece),
                Some(all) => all.append(&piece),
            }
        }
        out.ok_or_else(|| {
            let why = "no exposure of it can be read".to_owned();
            Failure::Message(Error::Nothing { stack: self.name, why }.to_string())
        })
    }
}

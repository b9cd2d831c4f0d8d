//! The measurements of a run: strengths of the lights, and what each picture gives.

use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

use super::message;
use super::shots::{Shot, Taking, shots};
use crate::brdf::table::{Channel, Resolution};
use crate::capture::brdf::{Counts, Gathered, Observations, Scene, Seen, reference_factor_sd, strength_from};
use crate::capture::lamp::Pattern;
use crate::capture::manifest::Shows;
use crate::capture::setup::{Light, Place};
use crate::capture::{Error, Photo};
use crate::cli::Failure;
use crate::cli::capture::develop::Darkroom;
use crate::cli::capture::photos::Photos;
use crate::cli::output::Whole;
use crate::finding::Finding;
use crate::report::capture_brdf::{self, Scale, StackSeen};

/// Samples that are kept of all measurements; beyond, an even draw of them.
const DRAWN: usize = 6_000_000;

/// Deviation of a reference from being diffuse above which it is told.
const UNEVEN: f64 = 0.02;

/// Pixels of the object.
pub(super) fn mask_of(photos: &mut Photos, path: &str) -> Result<Vec<bool>, Failure> {
    let bytes = photos.bytes(path)?;
    let picture = Photo::decode(&bytes).map_err(|e| Failure::Message(format!("{path}: {e}")))?;
    Ok(picture.luma().iter().map(|v| *v > 127.5).collect())
}

/// What is measured so far.
pub(super) struct Run {
    pub scene: Scene,
    pub mask: Option<Vec<bool>>,
    pub room: Darkroom,
    pub seen: Vec<StackSeen>,
    pub all: Option<Gathered>,
    /// Of the bins.
    pub resolution: Resolution,
    /// Of each light of the manifest, where it does not shine alike to all sides.
    pub patterns: Vec<Option<Arc<Pattern>>>,
    /// Of each light of the manifest, per band or one for all.
    pub strengths: Vec<Vec<f64>>,
    /// Columns and rows of the pictures.
    pub size: (usize, usize),
}

impl Run {
    /// The strengths of all lights: from the reference, as stated, or all alike.
    pub(super) fn strengths(&mut self, photos: &mut Photos) -> Result<Scale, Failure> {
        let lights = photos.manifest.light.clone();
        let of_object = shots(&photos.manifest, Shows::Object)?;
        if let Some(reference) = photos.manifest.reference.clone() {
            let (mut uneven, mut light_sd) = (0.0_f64, 0.0_f64);
            let of_reference = shots(&photos.manifest, Shows::Reference)?;
            for (light, pattern) in lights.iter().zip(&self.patterns) {
                let Some(shot) = of_reference.iter().find(|s| s.light == light.name) else {
                    if of_object.iter().any(|s| s.light == light.name) {
                        return Err(Failure::Message(format!(
                            "found no stack that shows the reference under light {}; expected one for each light",
                            light.name
                        )));
                    }
                    self.strengths.push(vec![1.0]);
                    continue;
                };
                let picture = shot.open(photos, &mut self.room)?;
                let name = picture.name.clone();
                let ones = vec![1.0; picture.channels];
                let mut seen = Gathered::new(Observations::new(picture.channels), self.resolution, DRAWN);
                let scene = self.scene.lit_by(pattern.clone());
                let (mask, mut counts) = (self.mask.as_deref(), Counts::default());
                picture.strips(photos, &self.room, &mut |strip| {
                    let found = scene.observe_rows(strip, light.place, &ones, mask, &mut |s| seen.push(s));
                    counts.add(&found.map_err(|e| Failure::Message(format!("{name}: {e}")))?);
                    Ok(())
                })?;
                let seen = seen.kept;
                let Some(strength) = strength_from(&seen, &reference) else {
                    let why =
                        if seen.is_empty() { counts.why() } else { "its reflectances are not as many as its bands" };
                    return Err(message(Error::Nothing { stack: shot.name.clone(), why: why.to_owned() }));
                };
                uneven = uneven.max(strength.deviation_rms);
                light_sd = light_sd.max(strength.relative_errors.iter().copied().fold(0.0, f64::max));
                self.strengths.push(strength.values);
            }
            if uneven > UNEVEN {
                let words = format!("the reference differs from a diffuse one by {:.1} % rms", 100.0 * uneven);
                photos
                    .findings
                    .push(Finding::warning("K013", words).hint("the scale is off by as much, or the geometry is"));
            }
            let factor_sd = reference_factor_sd(&reference);
            let reflectance = reference.reflectance;
            return Ok(Scale::Reference { reflectance, factor_sd, light_sd, deviation_rms: uneven });
        }
        let stated = lights.iter().filter(|l| l.strength.is_some()).count();
        if stated != 0 && stated != lights.len() {
            let words = "found a strength for some of the lights; expected it for all of them, or for none";
            return Err(Failure::Message(words.to_owned()));
        }
        if stated == 0 && lights.len() > 1 {
            let words = "no light has a stated strength: all are taken as equally strong";
            photos
                .findings
                .push(Finding::warning("K012", words).hint("state intensity_w_per_sr, even in arbitrary units"));
        }
        let unit = photos.manifest.radiance.unit_w_per_m2_sr.filter(|_| stated > 0);
        let of = |l: &Light| {
            let all = l.strength.clone().unwrap_or_else(|| vec![1.0]);
            all.iter().map(|s| s / unit.unwrap_or(1.0)).collect()
        };
        self.strengths = lights.iter().map(of).collect();
        Ok(unit.map_or(Scale::Relative { factor: 1.0 }, |unit| Scale::Strengths { unit_w_per_m2_sr: unit }))
    }

    /// Measures all stacks of the object; those that cannot be used are left out.
    pub(super) fn observe(&mut self, photos: &mut Photos) -> Result<(), Failure> {
        let shots = shots(&photos.manifest, Shows::Object)?;
        if shots.is_empty() {
            let words = "found no [[stack]] of the object in the manifest; expected one per light";
            return Err(Failure::Message(words.to_owned()));
        }
        for shot in &shots {
            let lights = &photos.manifest.light;
            let Some(number) = lights.iter().position(|l| l.name == shot.light) else {
                let (name, wanted) = (&shot.name, &shot.light);
                let words = format!("stack {name}: found no [[light]] called {wanted}; expected `light` to name one");
                return Err(Failure::Message(words));
            };
            let place = lights[number].place;
            // A mistake in the set-up ends the run; a picture that is of no use does not.
            let picture = match shot.open(photos, &mut self.room) {
                Ok(found) => found,
                Err(failure) if shots.len() > 1 => {
                    photos.left_out(&shot.name, &failure);
                    continue;
                }
                Err(failure) => return Err(failure),
            };
            if self.all.is_none() {
                let nm = photos.manifest.wavelengths_nm();
                let narrow = (!nm.is_empty()).then(|| Observations::of_wavelengths(&nm));
                let none = narrow.unwrap_or_else(|| Observations::new(picture.channels));
                self.all = Some(Gathered::new(none, self.resolution, DRAWN));
            }
            let name = picture.name.clone();
            if let Err(failure) = self.one(photos, shot, picture, place, number) {
                match failure {
                    Missed::Unread(failure) if shots.len() > 1 => photos.left_out(&shot.name, &failure),
                    Missed::Unread(failure) => return Err(failure),
                    Missed::Unusable(error @ Error::Nothing { .. }) if shots.len() > 1 => {
                        photos.left_out(&shot.name, &message(error));
                    }
                    Missed::Unusable(error) => return Err(Failure::Message(format!("{name}: {error}"))),
                }
            }
        }
        // Without a measurement there is no result.
        self.all.take_if(|all| all.count == 0);
        Ok(())
    }

    fn one(
        &mut self,
        photos: &mut Photos,
        shot: &Shot,
        picture: Taking,
        place: Place,
        light: usize,
    ) -> Result<(), Missed> {
        let Some(all) = &mut self.all else { return Ok(()) };
        let (size, bands) = (picture.size, picture.channels);
        if all.kept.channels.len() != bands {
            let expected = format!("{} channel(s)", all.kept.channels.len());
            let found = format!("{} × {} pixels in {bands} channel(s)", size.0, size.1);
            return Err(Missed::Unusable(Error::Size { name: picture.name, found, expected }));
        }
        let strength = match self.strengths[light].as_slice() {
            [one] => vec![*one; bands],
            each => each.to_vec(),
        };
        let scene = self.scene.lit_by(self.patterns[light].clone());
        let (mask, mut counts) = (self.mask.as_deref(), Counts::default());
        let mut failed = None;
        let read = picture.strips(photos, &self.room, &mut |strip| {
            match scene.observe_rows(strip, place, &strength, mask, &mut |s| all.push(s)) {
                Ok(found) => counts.add(&found),
                Err(error) => {
                    failed = Some(error);
                    return Err(Failure::Reported);
                }
            }
            Ok(())
        });
        if let Some(error) = failed {
            return Err(Missed::Unusable(error));
        }
        read.map_err(Missed::Unread)?;
        self.size = size;
        self.seen.push(StackSeen {
            name: shot.name.clone(),
            light: shot.light.clone(),
            place,
            pattern: self.patterns[light].clone(),
            counts,
            strength,
            deviation: None,
        });
        if counts.valid == 0 {
            return Err(Missed::Unusable(Error::Nothing { stack: shot.name.clone(), why: counts.why().to_owned() }));
        }
        Ok(())
    }

    /// Writes every measurement, times `factor`, as CSV: the pictures are measured once more.
    pub(super) fn write_measurements(
        &mut self,
        photos: &mut Photos,
        channels: &[Channel],
        factor: f64,
        path: &Path,
    ) -> Result<(), Failure> {
        photos.notes.stage(&format!("measurements: {}", path.display()));
        let read: Vec<String> = photos.inputs.iter().map(|i| i.path.clone()).collect();
        let mut whole = Whole::open(path, &read)?;
        let mut out = BufWriter::with_capacity(1 << 18, whole.file());
        let cannot = |e: std::io::Error| Failure::Message(format!("{}: cannot be written: {e}", path.display()));
        out.write_all(capture_brdf::measurements_header(channels).as_bytes()).map_err(cannot)?;
        let shots = shots(&photos.manifest, Shows::Object)?;
        for seen in self.seen.iter().filter(|s| s.counts.valid > 0) {
            let Some(shot) = shots.iter().find(|s| s.name == seen.name) else { continue };
            let scene = self.scene.lit_by(seen.pattern.clone());
            let (mask, room, mut rows) = (self.mask.as_deref(), &mut self.room, String::new());
            photos.untold(|photos| {
                shot.open(photos, room)?.strips(photos, room, &mut |strip| {
                    rows.clear();
                    let mut add = |s: &Seen<'_>| capture_brdf::measurement(&mut rows, &seen.name, s, factor);
                    scene.observe_rows(strip, seen.place, &seen.strength, mask, &mut add).map_err(message)?;
                    out.write_all(rows.as_bytes()).map_err(cannot)
                })
            })?;
        }
        out.flush().map_err(cannot)?;
        drop(out);
        whole.finish()
    }
}

/// Why a picture gave nothing.
enum Missed {
    /// It could not be read.
    Unread(Failure),
    /// It, or the set-up, is of no use.
    Unusable(Error),
}

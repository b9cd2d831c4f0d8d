//! The measurements of a run: strengths of the lights, and what each picture gives.

use super::message;
use super::shots::{Shot, shots};
use crate::capture::brdf::{Counts, Observations, Scene, Seen, reference_factor_sd, strength_from};
use crate::capture::manifest::{Exposure, Shows, Stack};
use crate::capture::photo::exif_time_s;
use crate::capture::radiance::Radiance;
use crate::capture::setup::{Light, Place};
use crate::capture::{Error, Photo};
use crate::cli::Failure;
use crate::cli::capture::develop::Darkroom;
use crate::cli::capture::photos::Photos;
use crate::finding::Finding;
use crate::report::capture_brdf::{Scale, StackSeen};

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
    /// Stack by number in `seen` and pixel of each measurement, where they are asked for.
    pub places: Option<Vec<(usize, (usize, usize))>>,
    pub seen: Vec<StackSeen>,
    pub all: Option<Observations>,
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
            for light in &lights {
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
                let (picture, name) = shot.picture(photos, &mut self.room)?;
                let mut seen = Observations::new(picture.channels);
                let ones = vec![1.0; picture.channels];
                let counts = self
                    .scene
                    .observe(&picture, light.place, &ones, self.mask.as_deref(), &mut |s| seen.push(s))
                    .map_err(|e| Failure::Message(format!("{name}: {e}")))?;
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
            let (picture, name) = match shot.picture(photos, &mut self.room) {
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
                self.all = Some(narrow.unwrap_or_else(|| Observations::new(picture.channels)));
            }
            if let Err(failure) = self.one(shot, &name, &picture, place, number) {
                match failure {
                    Error::Nothing { .. } if shots.len() > 1 => photos.left_out(&shot.name, &message(failure)),
                    _ => return Err(Failure::Message(format!("{name}: {failure}"))),
                }
            }
        }
        // Without a measurement there is no result.
        self.all.take_if(|all| all.is_empty());
        Ok(())
    }

    fn one(&mut self, shot: &Shot, name: &str, picture: &Radiance, place: Place, light: usize) -> Result<(), Error> {
        let Some(all) = &mut self.all else { return Ok(()) };
        if all.channels.len() != picture.channels {
            let expected = format!("{} channel(s)", all.channels.len());
            return Err(Error::Size { name: name.to_owned(), found: picture.size(), expected });
        }
        let strength = match self.strengths[light].as_slice() {
            [one] => vec![*one; picture.channels],
            each => each.to_vec(),
        };
        let mut visit = |s: &Seen<'_>| {
            all.push(s);
            if let Some(places) = &mut self.places {
                places.push((self.seen.len(), s.pixel));
            }
        };
        let counts: Counts = self.scene.observe(picture, place, &strength, self.mask.as_deref(), &mut visit)?;
        self.size = (picture.width, picture.height);
        self.seen.push(StackSeen {
            name: shot.name.clone(),
            light: shot.light.clone(),
            place,
            counts,
            strength,
            deviation: None,
        });
        if counts.valid == 0 {
            return Err(Error::Nothing { stack: shot.name.clone(), why: counts.why().to_owned() });
        }
        Ok(())
    }
}

/// The picture of a stack, and its path.
pub(in crate::cli::capture) fn picture(photos: &mut Photos, stack: &Stack) -> Result<(Radiance, String), Failure> {
    let [Exposure { photo, time_s }] = stack.exposures.as_slice() else {
        return Err(Failure::Message(format!(
            "found {} exposures in {}; expected one linear picture: `photopic capture merge` makes it",
            stack.exposures.len(),
            stack.name
        )));
    };
    let path = photos.path(photo);
    let bytes = photos.bytes(&path)?;
    // A picture that says nothing of its time, such as a merged one, is radiance already.
    let time_s = time_s.or_else(|| exif_time_s(&bytes)).unwrap_or(1.0);
    let wrong = |e: Error| Failure::Message(format!("{path}: {e}"));
    if !(time_s > 0.0 && time_s.is_finite()) {
        return Err(wrong(Error::Time { name: photo.clone(), time_s }));
    }
    let picture = Radiance::decode(&bytes, time_s).map_err(wrong)?;
    Ok((picture, path))
}

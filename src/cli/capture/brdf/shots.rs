//! What is measured at once: a stack, or the stacks of a light in all narrow bands.

use crate::capture::manifest::{Manifest, Shows, Stack};
use crate::capture::radiance::Radiance;
use crate::cli::Failure;
use crate::cli::capture::develop::Darkroom;
use crate::cli::capture::photos::Photos;

/// One view under one light.
pub(super) struct Shot {
    /// Of the stack; of several, that of their light.
    pub name: String,
    /// The light by name.
    pub light: String,
    /// One, or one per band with rising wavelengths.
    stacks: Vec<Stack>,
    /// The bands that there should be.
    wavelengths_nm: Vec<f64>,
}

/// All of the object, or of the reference, in the order of the manifest.
pub(super) fn shots(manifest: &Manifest, shows: Shows) -> Result<Vec<Shot>, Failure> {
    let wavelengths_nm = manifest.wavelengths_nm();
    let mut out: Vec<Shot> = Vec::new();
    for stack in manifest.stack.iter().filter(|s| s.shows == shows) {
        if stack.wavelength_nm.is_none() != wavelengths_nm.is_empty() {
            return Err(Failure::Message(format!(
                "stack {}: found {} wavelength_nm beside stacks of the object that have {}; expected one for each stack, or for none",
                stack.name,
                if stack.wavelength_nm.is_none() { "no" } else { "a" },
                if wavelengths_nm.is_empty() { "none" } else { "some" },
            )));
        }
        let light = stack.lit_by();
        match out.iter_mut().find(|s| stack.wavelength_nm.is_some() && s.light == light) {
            Some(shot) => shot.stacks.push(stack.clone()),
            None => out.push(Shot {
                name: if stack.wavelength_nm.is_some() { light.to_owned() } else { stack.name.clone() },
                light: light.to_owned(),
                stacks: vec![stack.clone()],
                wavelengths_nm: wavelengths_nm.clone(),
            }),
        }
    }
    for shot in &mut out {
        shot.stacks.sort_by(|a, b| a.wavelength_nm.unwrap_or(0.0).total_cmp(&b.wavelength_nm.unwrap_or(0.0)));
    }
    Ok(out)
}

impl Shot {
    /// Its picture in linear radiance, and what to call it.
    pub(super) fn picture(&self, photos: &mut Photos, room: &mut Darkroom) -> Result<(Radiance, String), Failure> {
        if let ([stack], true) = (self.stacks.as_slice(), self.wavelengths_nm.is_empty()) {
            return room.picture(photos, stack);
        }
        let found: Vec<f64> = self.stacks.iter().filter_map(|s| s.wavelength_nm).collect();
        if found != self.wavelengths_nm {
            return Err(Failure::Message(format!(
                "found stacks of light {} at {found:?} nm; expected one at each of {:?} nm",
                self.light, self.wavelengths_nm
            )));
        }
        let pictures = self.stacks.iter().map(|stack| Ok(room.picture(photos, stack)?.0));
        let pictures = pictures.collect::<Result<Vec<_>, Failure>>()?;
        let wrong = |e| Failure::Message(format!("{}: {e}", self.name));
        Ok((Radiance::of_bands(pictures, &photos.manifest.radiance).map_err(wrong)?, self.name.clone()))
    }
}

//! What is measured at once: a stack, or the stacks of a light in all narrow bands.

use crate::capture::Error;
use crate::capture::manifest::{Manifest, Shows, Stack};
use crate::capture::radiance::{Radiance, Strip, Strips};
use crate::cli::Failure;
use crate::cli::capture::develop::{Darkroom, Developing};
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
    /// Opens its picture in linear radiance.
    pub(super) fn open(&self, photos: &mut Photos, room: &mut Darkroom) -> Result<Taking, Failure> {
        if let ([stack], true) = (self.stacks.as_slice(), self.wavelengths_nm.is_empty()) {
            let one = room.develop(photos, stack)?;
            let (size, channels, name) = ((one.width, one.height), one.channels, one.name.clone());
            return Ok(Taking { name, size, channels, bands: vec![one], narrow: false });
        }
        let found: Vec<f64> = self.stacks.iter().filter_map(|s| s.wavelength_nm).collect();
        if found != self.wavelengths_nm {
            return Err(Failure::Message(format!(
                "found stacks of light {} at {found:?} nm; expected one at each of {:?} nm",
                self.light, self.wavelengths_nm
            )));
        }
        let bands = self.stacks.iter().map(|stack| room.develop(photos, stack));
        let bands = bands.collect::<Result<Vec<_>, Failure>>()?;
        let size = bands.first().map_or((0, 0), |b| (b.width, b.height));
        if let Some(n) = bands.iter().position(|b| (b.width, b.height) != size) {
            let (name, b) = (format!("the picture of band {}", n + 1), &bands[n]);
            let found = format!("{} × {} pixels", b.width, b.height);
            let error = Error::Size { name, found, expected: format!("{} × {} pixels", size.0, size.1) };
            return Err(Failure::Message(format!("{}: {error}", self.name)));
        }
        Ok(Taking { name: self.name.clone(), size, channels: bands.len(), bands, narrow: true })
    }
}

/// The picture of a shot, from its top.
pub(super) struct Taking {
    /// What to call it.
    pub name: String,
    /// Columns and rows.
    pub size: (usize, usize),
    /// Bands.
    pub channels: usize,
    bands: Vec<Developing>,
    narrow: bool,
}

impl Taking {
    /// The next rows; `None` when there are no more.
    pub(super) fn next(&mut self, photos: &mut Photos, room: &Darkroom) -> Result<Option<Radiance>, Failure> {
        let mut pieces = Vec::with_capacity(self.bands.len());
        for band in &mut self.bands {
            let Some(piece) = band.next(photos, room)? else { return Ok(None) };
            pieces.push(piece);
        }
        match pieces.pop() {
            Some(one) if !self.narrow => Ok(Some(one)),
            last => {
                pieces.extend(last);
                let wrong = |e| Failure::Message(format!("{}: {e}", self.name));
                Radiance::of_bands(pieces, &photos.manifest.radiance).map(Some).map_err(wrong)
            }
        }
    }

    /// Visits all of it in strips.
    pub(super) fn strips(
        mut self,
        photos: &mut Photos,
        room: &Darkroom,
        visit: &mut dyn FnMut(&Strip<'_>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut strips = Strips::new(self.size.1);
        while let Some(piece) = self.next(photos, room)? {
            visit(&strips.add(piece))?;
        }
        Ok(())
    }
}

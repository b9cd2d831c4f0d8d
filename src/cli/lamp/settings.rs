//! `--settings`: a file with settings of a lamp, as `trade lamp --settings` writes it.

use std::fs;
use std::path::Path;

use serde::Deserialize;

use super::interpolation::Choice;
use crate::cli::Failure;
use crate::finding::Checked;
use crate::luminaire::Luminaire;
use crate::luminaire::transform::fewer_angles;
use crate::mistake::{self, Mistake};

/// What the file says.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settings {
    every_horizontal: Option<usize>,
    every_vertical: Option<usize>,
    pub interpolation: Option<Choice>,
    /// Of no concern where there is no distance.
    pub near_ratio: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    lamp: toml::Spanned<Settings>,
}

impl Settings {
    /// Reads a file; without one there are no settings.
    pub(super) fn read(path: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = path else { return Ok(Self::default()) };
        let place = path.display();
        let text = fs::read_to_string(path)
            .map_err(|e| Failure::Message(format!("{place}: cannot be read: {e}; expected settings (TOML)")))?;
        let at = |m: Mistake| Failure::Message(format!("{place}:{m}"));
        let file: File = mistake::parse(&text).map_err(at)?;
        let settings = *file.lamp.get_ref();
        if [settings.every_horizontal, settings.every_vertical].contains(&Some(0)) {
            let message = "every 0th angle; expected 1 (all of them) or more";
            return Err(at(Mistake::at(&text, &file.lamp.span(), message)));
        }
        Ok(settings)
    }

    /// Leaves out the angles that the file does not want.
    pub(super) fn thin(&self, luminaire: &Luminaire) -> Result<Checked<Luminaire>, Failure> {
        let every = [self.every_horizontal, self.every_vertical].map(|n| n.unwrap_or(1));
        fewer_angles(luminaire, every).map_err(|e| Failure::Message(e.to_string()))
    }
}

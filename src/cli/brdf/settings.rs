//! `--settings`: a file with the form of a material, as `trade brdf --settings` writes it.

use std::fs;
use std::path::Path;

use serde::Deserialize;

use super::numbers::Bins;
use crate::brdf::description::template::Template;
use crate::cli::Failure;
use crate::mistake::{self, Mistake};

/// The bins of a table, or a model to be fitted.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    resolution: Option<String>,
    model: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    brdf: toml::Spanned<Section>,
}

/// What `read` finds in the file.
type Read<T> = Result<T, Failure>;

fn read<T>(path: &Path, of: impl FnOnce(&Section) -> Result<T, String>) -> Read<T> {
    let place = path.display();
    let text = fs::read_to_string(path)
        .map_err(|e| Failure::Message(format!("{place}: cannot be read: {e}; expected settings (TOML)")))?;
    let at = |m: Mistake| Failure::Message(format!("{place}:{m}"));
    let file: File = mistake::parse(&text).map_err(at)?;
    of(file.brdf.get_ref()).map_err(|message| at(Mistake::at(&text, &file.brdf.span(), &message)))
}

/// The bins that the file asks for.
pub(super) fn bins(path: &Path) -> Read<Bins> {
    read(path, |s| {
        let found = s.resolution.as_ref().ok_or("found no `resolution`; expected one such as \"45x45x36\"")?;
        found.parse()
    })
}

/// The model that the file asks for.
pub(super) fn model(path: &Path) -> Read<Template> {
    read(path, |s| {
        let found = s.model.as_ref().ok_or("found no `model`; expected one such as \"lambert + ggx\"")?;
        found.parse().map_err(|e: crate::brdf::description::Error| e.to_string())
    })
}

//! `--settings`: a file with a scene's `[render]` keys, as `trade render --settings` writes it.

use std::fs;
use std::path::Path;

use serde::Deserialize;

use crate::cli::Failure;
use crate::mistake::{self, Mistake};
use crate::render::description::{Model, Render, Solver};

/// What stands in place of the scene's.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settings {
    meter_samples: Option<u64>,
    solver: Option<Solver>,
    max_edges: Option<u32>,
    wavelength_tolerance: Option<f64>,
    model: Option<Model>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    render: toml::Spanned<Settings>,
}

impl Settings {
    /// Reads a file.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let place = path.display();
        let text = fs::read_to_string(path)
            .map_err(|e| Failure::Message(format!("{place}: cannot be read: {e}; expected settings (TOML)")))?;
        let at = |m: Mistake| Failure::Message(format!("{place}:{m}"));
        let file: File = mistake::parse(&text).map_err(at)?;
        let settings = *file.render.get_ref();
        let wrong = |message: &str| Err(at(Mistake::at(&text, &file.render.span(), message)));
        if settings.meter_samples == Some(0) {
            return wrong("`meter_samples` is 0; expected at least 1");
        }
        if settings.wavelength_tolerance.is_some_and(|t| t <= 0.0) {
            return wrong("`wavelength_tolerance` is not positive; expected a relative error");
        }
        Ok(settings)
    }

    /// Puts them in place.
    pub(super) fn apply(&self, render: &mut Render) {
        render.meter_samples = self.meter_samples.unwrap_or(render.meter_samples);
        render.solver = self.solver.unwrap_or(render.solver);
        render.max_edges = self.max_edges.or(render.max_edges);
        render.wavelength_tolerance = self.wavelength_tolerance.unwrap_or(render.wavelength_tolerance);
        render.model = self.model.unwrap_or(render.model);
    }
}

//! `--settings`: a file with a scene's `[render]` keys, as `trade render --settings` writes it.

use std::fs;
use std::path::Path;

use serde::Deserialize;

use crate::cli::Failure;
use crate::mistake::{self, Mistake};
use crate::render::description::{self, Carried, Model, Render, Solver};
use crate::render::sampler::Points;

/// What stands in place of the scene's.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settings {
    #[serde(default, deserialize_with = "description::samples")]
    samples: Option<u64>,
    adaptive: Option<bool>,
    #[serde(default, deserialize_with = "description::samples")]
    meter_samples: Option<u64>,
    solver: Option<Solver>,
    max_edges: Option<Edges>,
    #[serde(default, deserialize_with = "description::roulette_from")]
    roulette_from: Option<u32>,
    virtual_lights: Option<bool>,
    guiding: Option<bool>,
    pub denoise: Option<bool>,
    #[serde(default, deserialize_with = "description::branches")]
    branches: Option<u32>,
    polarisation: Option<bool>,
    sampler: Option<Points>,
    wavelengths_per_path: Option<Carried>,
    #[serde(default, deserialize_with = "description::wavelength_step")]
    wavelength_step_nm: Option<f64>,
    #[serde(default, deserialize_with = "description::wavelength_tolerance")]
    wavelength_tolerance: Option<f64>,
    model: Option<Model>,
    /// The file, for those who join the parts of a render.
    #[serde(skip)]
    pub text: String,
}

/// The longest path.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(untagged, expecting = "found something else; expected a number of edges, or \"any\"")]
enum Edges {
    Most(u32),
    Any(Any),
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Any {
    Any,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    render: Settings,
}

impl Settings {
    /// Reads a file.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let place = path.display().to_string();
        let text = fs::read_to_string(path)
            .map_err(|e| Failure::Message(format!("{place}: cannot be read: {e}; expected settings (TOML)")))?;
        if text.trim().is_empty() {
            return Err(Failure::Message(format!("{place}:1:1: found nothing; expected a table [render]")));
        }
        Self::parse(&place, text)
    }

    /// Of the text of a file that is at `place`; nothing stands in place of anything where it is empty.
    pub(super) fn parse(place: &str, text: String) -> Result<Self, Failure> {
        if text.is_empty() {
            return Ok(Self::default());
        }
        let at = |m: Mistake| Failure::Message(format!("{place}:{m}"));
        let file: File = mistake::parse(&text).map_err(at)?;
        Ok(Self { text, ..file.render })
    }

    /// Puts them in place.
    pub(super) fn apply(&self, render: &mut Render) {
        render.samples = self.samples.unwrap_or(render.samples);
        render.adaptive = self.adaptive.unwrap_or(render.adaptive);
        render.meter_samples = self.meter_samples.unwrap_or(render.meter_samples);
        render.solver = self.solver.unwrap_or(render.solver);
        render.max_edges = match self.max_edges {
            None => render.max_edges,
            Some(Edges::Most(edges)) => Some(edges),
            Some(Edges::Any(Any::Any)) => None,
        };
        render.roulette_from = self.roulette_from.unwrap_or(render.roulette_from);
        render.virtual_lights = self.virtual_lights.or(render.virtual_lights);
        render.guiding = self.guiding.or(render.guiding);
        let denoise = self.denoise.map(|filtered| toml::Spanned::new(0..0, filtered));
        render.denoise = denoise.or(render.denoise.take());
        render.branches = self.branches.or(render.branches);
        render.polarisation = self.polarisation.or(render.polarisation);
        render.sampler = self.sampler.unwrap_or(render.sampler);
        render.wavelengths_per_path = self.wavelengths_per_path.unwrap_or(render.wavelengths_per_path);
        render.wavelength_tolerance = self.wavelength_tolerance.unwrap_or(render.wavelength_tolerance);
        // A tolerance is asked for instead of a step.
        let step = render.wavelength_step_nm.filter(|_| self.wavelength_tolerance.is_none());
        render.wavelength_step_nm = self.wavelength_step_nm.or(step);
        render.model = self.model.unwrap_or(render.model);
    }
}

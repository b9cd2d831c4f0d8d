//! How the tables of lamp files are interpolated.

use clap::{Args, ValueEnum};
use serde::Deserialize;

use crate::luminaire::Interpolation;
use crate::luminaire::format::File;

/// The choice, for verbs that interpolate.
#[derive(Debug, Args)]
pub(super) struct InterpolationArgs {
    /// The intensity between the entries of the table.
    #[arg(long, value_name = "KIND")]
    interpolation: Option<Choice>,
}

#[derive(Debug, Clone, Copy, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Choice {
    /// Linear in both angles, as the trade's tools have it; what is done without a choice.
    Bilinear,
    /// Smooth, exact at the entries, never beyond its neighbours (PCHIP).
    MonotoneCubic,
}

impl InterpolationArgs {
    pub(super) fn value(&self) -> Interpolation {
        self.or(None)
    }

    /// What the command line says, else what a file of settings says.
    pub(super) fn or(&self, settings: Option<Choice>) -> Interpolation {
        match self.interpolation.or(settings) {
            None | Some(Choice::Bilinear) => Interpolation::Bilinear,
            Some(Choice::MonotoneCubic) => Interpolation::MonotoneCubic,
        }
    }
}

/// Has the table of a file interpolated as said.
pub(super) fn interpolate(file: &mut File, interpolation: Interpolation) {
    let table = &mut file.luminaire.distribution;
    if table.interpolation() != interpolation {
        *table = table.clone().with_interpolation(interpolation);
    }
}

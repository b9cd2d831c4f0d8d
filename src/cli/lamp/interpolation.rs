//! How the tables of lamp files are interpolated.

use clap::{Args, ValueEnum};

use crate::luminaire::Interpolation;
use crate::luminaire::format::File;

/// The choice, for verbs that interpolate.
#[derive(Debug, Args)]
pub(super) struct InterpolationArgs {
    /// The intensity between the entries of the table.
    #[arg(long, value_name = "KIND", default_value = "bilinear")]
    interpolation: Choice,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Choice {
    /// Linear in both angles, as the trade's tools have it.
    Bilinear,
    /// Smooth, exact at the entries, never beyond its neighbours (PCHIP).
    MonotoneCubic,
}

impl InterpolationArgs {
    pub(super) fn value(&self) -> Interpolation {
        match self.interpolation {
            Choice::Bilinear => Interpolation::Bilinear,
            Choice::MonotoneCubic => Interpolation::MonotoneCubic,
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

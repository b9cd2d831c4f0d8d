//! How the tables of lamp files are interpolated.

use std::borrow::Cow;

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

/// The file with its table interpolated as said.
pub(super) fn declared(file: &File, interpolation: Interpolation) -> Cow<'_, File> {
    if file.luminaire.distribution.interpolation() == interpolation {
        return Cow::Borrowed(file);
    }
    let mut file = file.clone();
    file.luminaire.distribution = file.luminaire.distribution.with_interpolation(interpolation);
    Cow::Owned(file)
}

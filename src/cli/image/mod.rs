//! `image`: spectral images; one file per verb.

mod compare;
mod convert;
mod falsecolor;
mod info;
mod look;
mod open;
mod probe;
mod save;
mod seen;

use clap::Subcommand;

use super::{Failure, Talk};

/// Verbs of `image`.
#[derive(Debug, Subcommand)]
pub(super) enum ImageCommand {
    /// Size, bands, units, range, odd values and histogram.
    Info(info::InfoArgs),
    /// Luminance, XYZ, RGB and other planes of an image, spectral or in colours, or the image in another format.
    Convert(Box<convert::ConvertArgs>),
    /// How far one image is from another: per band, in luminance and in colour. Exit code 1 beyond --tolerance.
    Compare(Box<compare::CompareArgs>),
    /// What a meter would read in pixels, rectangles, polygons, circles, spots and along lines: spectra, nits, XYZ, uniformity.
    Probe(Box<probe::ProbeArgs>),
    /// A false-colour picture of the luminance with its legend, or a quick look in the terminal.
    Falsecolor(Box<falsecolor::FalsecolorArgs>),
}

pub(super) fn run(command: ImageCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        ImageCommand::Info(arguments) => info::info(&arguments, talk),
        ImageCommand::Convert(arguments) => convert::convert(&arguments, talk),
        ImageCommand::Compare(arguments) => compare::run(&arguments, talk),
        ImageCommand::Probe(arguments) => probe::run(&arguments, talk),
        ImageCommand::Falsecolor(arguments) => falsecolor::run(&arguments, talk),
    }
}

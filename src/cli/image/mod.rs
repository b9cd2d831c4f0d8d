//! `image`: spectral images; one file per verb.

mod convert;
mod info;
mod open;
mod save;

use clap::Subcommand;

use super::{Failure, Talk};

/// Verbs of `image`.
#[derive(Debug, Subcommand)]
pub(super) enum ImageCommand {
    /// Size, bands, units, range, odd values and histogram.
    Info(info::InfoArgs),
    /// Luminance, XYZ, RGB and other planes of an image, spectral or in colours, or the image in another format.
    Convert(Box<convert::ConvertArgs>),
}

pub(super) fn run(command: ImageCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        ImageCommand::Info(arguments) => info::info(&arguments, talk),
        ImageCommand::Convert(arguments) => convert::convert(&arguments, talk),
    }
}

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
mod settings;

pub(super) use self::convert::MeaningArgs;
pub(super) use self::open::{Reading, open};
use clap::Subcommand;

use super::{Failure, Talk};
use crate::image::{Description, Region};
use crate::report::envelope::Input;

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

/// A whole picture of a file as it says itself what it is, for those who need all of it at once.
pub(super) fn whole(path: &str) -> Result<(Description, Vec<f32>, Vec<Input>), Failure> {
    let reading = open::Reading {
        wavelengths: None,
        wavelength_unit: None,
        reflectance: false,
        linear: false,
        gain: 1.0,
        dark: 0.0,
    };
    let mut opened = open::open(&[path.to_owned()], &reading)?;
    let inputs = opened.inputs()?;
    let description = opened.source.description().clone();
    let channels: Vec<usize> = (0..description.channels.len()).collect();
    let mut samples = vec![0.0; description.pixels() * channels.len()];
    let all = Region::rows(&description, 0, description.height);
    opened.source.read(all, &channels, &mut samples).map_err(|e| Failure::Message(e.to_string()))?;
    Ok((description, samples, inputs))
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

//! `trade`: what each speed knob costs in accuracy, measured on the user's own input; one file per kind of input.

mod brdf;
mod capture;
mod image;
mod lamp;
mod output;
mod render;
mod spectrum;
mod target;

use clap::Subcommand;

pub(super) use self::capture::BINS as CAPTURE_BINS;
pub(super) use self::target::Target;

use super::{Failure, Talk};

/// Kinds of input.
#[derive(Debug, Subcommand)]
pub(super) enum TradeCommand {
    /// Step, interpolation, rule, range and precision of the integration of a spectrum.
    Spectrum(spectrum::SpectrumArgs),
    /// Bins, models and principal components of a material.
    Brdf(Box<brdf::BrdfArgs>),
    /// Lights, exposures and pixels of the photographs of an object of known shape.
    Capture(Box<capture::CaptureArgs>),
    /// Bands, pixels and precision of a spectral image.
    Image(Box<image::ImageArgs>),
    /// Angles, interpolation and precision of a lamp's table, and from where on the lamp is a point.
    Lamp(lamp::LampArgs),
    /// Samples, solver, path length, wavelengths and extent of the model of a scene's meters and pictures.
    Render(render::RenderArgs),
}

pub(super) fn run(command: TradeCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        TradeCommand::Spectrum(a) => spectrum::trade(&a, talk),
        TradeCommand::Brdf(a) => brdf::trade(&a, talk),
        TradeCommand::Capture(a) => capture::trade(&a, talk),
        TradeCommand::Image(a) => image::trade(&a, talk),
        TradeCommand::Lamp(a) => lamp::trade(&a, talk),
        TradeCommand::Render(a) => render::trade(&a, talk),
    }
}

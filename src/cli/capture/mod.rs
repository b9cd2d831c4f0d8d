//! `capture`: photographs of known geometry; one file per verb.

mod brdf;
mod calibrate;
mod develop;
mod lights;
mod merge;
mod photos;
mod response;

use clap::Subcommand;

pub(super) use self::brdf::{FITTED, Retaken, Taken};

use super::{Failure, Talk};

/// Verbs of `capture`.
#[derive(Debug, Subcommand)]
pub(super) enum CaptureCommand {
    /// The curve from code to exposure, from one scene at several exposure times; how well the exposures agree.
    Response(response::ResponseArgs),
    /// Exposures into linear radiance with its standard error and a mask, as EXR.
    Merge(merge::MergeArgs),
    /// Focal lengths, principal point and distortion from photographs of a chessboard.
    Calibrate(calibrate::CalibrateArgs),
    /// Where the lights were, from a mirror ball or a diffuse one; the surroundings as a picture.
    Lights(lights::LightsArgs),
    /// The BRDF of a photographed sphere, cylinder, plane or mesh, with its uncertainty: measured bins and fitted models.
    Brdf(brdf::BrdfArgs),
    /// Print the JSON schema of the manifest.
    Schema,
}

pub(super) fn run(command: CaptureCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        CaptureCommand::Response(a) => response::response(&a, talk),
        CaptureCommand::Merge(a) => merge::merge(&a, talk),
        CaptureCommand::Calibrate(a) => calibrate::calibrate(&a, talk),
        CaptureCommand::Lights(a) => lights::lights(&a, talk),
        CaptureCommand::Brdf(a) => brdf::brdf(&a, talk),
        CaptureCommand::Schema => {
            use std::io::Write;
            Ok(writeln!(std::io::stdout().lock(), "{:#}", crate::capture::manifest::schema())?)
        }
    }
}

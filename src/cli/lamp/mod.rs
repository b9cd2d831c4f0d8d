//! `lamp`: goniometric lamp data checked, analysed and converted; one file per verb.

mod check;
mod convert;
mod files;
mod interpolation;
mod load;
mod transform_args;

use clap::{Args, Subcommand};

use self::files::{FilesArgs, files};
use self::interpolation::InterpolationArgs;
use super::{Failure, Talk};
use crate::luminaire::format::File;
use crate::report::lamp as report;

/// Verbs of `lamp`.
#[derive(Debug, Subcommand)]
pub(super) enum LampCommand {
    /// Facts and figures: flux, peak, beam, zones, luminance.
    Info(InfoArgs),
    /// Findings; exit code 1 where there are errors among them.
    Check(FilesArgs),
    /// The corrected UGR table (CIE 190): 19 rooms, crosswise and endwise.
    Ugr(FilesArgs),
    /// Zonal-cavity coefficients of utilisation, per cent.
    Cu(FilesArgs),
    /// Another format: .ies (LM-63), .ldt (EULUMDAT) or .xml (TM-33-23), by the name of the output.
    Convert(Box<convert::ConvertArgs>),
}

/// Arguments of `lamp info`.
#[derive(Debug, Args)]
pub(super) struct InfoArgs {
    #[command(flatten)]
    files: FilesArgs,
    #[command(flatten)]
    interpolation: InterpolationArgs,
}

fn info(arguments: &InfoArgs, talk: Talk) -> Result<(), Failure> {
    let interpolation = arguments.interpolation.value();
    let figures = |file: &File| Ok(report::info(&interpolation::declared(file, interpolation)));
    files(&arguments.files, talk, "lamp info", &figures, &report::info_text)
}

pub(super) fn run(command: LampCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        LampCommand::Info(a) => info(&a, talk),
        LampCommand::Ugr(a) => {
            files(&a, talk, "lamp ugr", &|f| report::ugr(f).map_err(|e| e.to_string()), &report::rows_text)
        }
        LampCommand::Cu(a) => {
            files(&a, talk, "lamp cu", &|f| report::cu(f).map_err(|e| e.to_string()), &report::rows_text)
        }
        LampCommand::Check(a) => check::check(&a, talk),
        LampCommand::Convert(a) => convert::convert(&a, talk),
    }
}

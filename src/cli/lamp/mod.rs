//! `lamp`: goniometric lamp data checked, analysed and converted; one file per verb.

mod check;
mod convert;
mod files;
mod grid;
mod load;

use clap::Subcommand;

use self::files::{FilesArgs, files};
use super::{Failure, Talk};
use crate::report::lamp as report;

/// Verbs of `lamp`.
#[derive(Debug, Subcommand)]
pub(super) enum LampCommand {
    /// Facts and figures: flux, peak, beam, zones, luminance.
    Info(FilesArgs),
    /// Findings; exit code 1 where there are errors among them.
    Check(FilesArgs),
    /// The corrected UGR table (CIE 190): 19 rooms, crosswise and endwise.
    Ugr(FilesArgs),
    /// Zonal-cavity coefficients of utilisation, per cent.
    Cu(FilesArgs),
    /// Another format: .ies (LM-63), .ldt (EULUMDAT) or .xml (TM-33-23), by the name of the output.
    Convert(convert::ConvertArgs),
    /// Illuminance of one or many luminaires on a plane: figures, table, isolux plot, picture.
    Grid(Box<grid::GridArgs>),
}

pub(super) fn run(command: LampCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        LampCommand::Info(a) => files(&a, talk, "lamp info", &|f| Ok(report::info(f)), &report::info_text),
        LampCommand::Ugr(a) => {
            files(&a, talk, "lamp ugr", &|f| report::ugr(f).map_err(|e| e.to_string()), &report::rows_text)
        }
        LampCommand::Cu(a) => {
            files(&a, talk, "lamp cu", &|f| report::cu(f).map_err(|e| e.to_string()), &report::rows_text)
        }
        LampCommand::Check(a) => check::check(&a, talk),
        LampCommand::Convert(a) => convert::convert(&a, talk),
        LampCommand::Grid(a) => grid::grid(&a, talk),
    }
}

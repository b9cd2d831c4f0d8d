//! `lamp`: goniometric lamp data checked, analysed, converted and drawn; one file per verb.

mod check;
mod convert;
mod files;
mod load;
mod plot;

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
    /// Diagrams as .svg or .png: a sheet as in a maker's datasheet, or one diagram; several files together or each for itself.
    Plot(plot::PlotArgs),
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
        LampCommand::Plot(a) => plot::plot(&a, talk),
    }
}

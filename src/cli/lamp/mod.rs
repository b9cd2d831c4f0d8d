//! `lamp`: goniometric lamp data checked, analysed, converted and drawn.

mod compare;
mod convert;
mod files;
mod grid;
mod interpolation;
mod load;
mod plot;
mod settings;
mod spectral;
mod transform_args;

use clap::{Args, Subcommand};
use serde_json::Map;

use self::files::{FilesArgs, Verb, files};
use self::interpolation::InterpolationArgs;
pub(super) use self::load::load;
use super::{Failure, Talk};
use crate::luminaire::Interpolation;
use crate::report::lamp as report;

/// Verbs of `lamp`.
#[derive(Debug, Subcommand)]
pub(super) enum LampCommand {
    /// Facts and figures: flux, peak, beam and field angles, zones, luminance, cone, ratings.
    ///
    /// Each figure names its definition; in JSON they stand under `settings.definitions`.
    Info(InfoArgs),
    /// Findings; exit code 1 where there are errors among them.
    ///
    /// Says of each file whether it passes, and every finding with its code, place and hint (docs/findings.md lists the codes).
    Check(FilesArgs),
    /// The corrected UGR table (CIE 190, CIE 117): 19 rooms, five sets of reflectances, crosswise and endwise.
    ///
    /// For the luminaire's own flux and a spacing of a quarter of the height above the eyes (S/H 0.25).
    Ugr(FilesArgs),
    /// Zonal-cavity coefficients of utilisation, per cent: room cavity ratios 0 to 10, floor cavity 20 %.
    Cu(FilesArgs),
    /// Two files side by side: flux, peak, beam, shape, and whether one is the other turned; exit code 1 beyond --tolerance.
    Compare(compare::CompareArgs),
    /// The lamp with a spectrum: watts, photons, melanopic and hazard-weighted figures; colour over angle of angular spectra.
    Spectral(spectral::SpectralArgs),
    /// Other formats: LM-63, EULUMDAT, TM-33, CSV, light sources for Radiance, pbrt and Mitsuba, a picture.
    Convert(Box<convert::ConvertArgs>),
    /// Diagrams as .svg or .png: a sheet as in a maker's datasheet, or one diagram; several files together or each for itself.
    Plot(plot::PlotArgs),
    /// Illuminance of one or many luminaires on a plane: figures, table, isolux plot, picture.
    Grid(Box<grid::GridArgs>),
}

/// Arguments of `lamp info`.
#[derive(Debug, Args)]
pub(super) struct InfoArgs {
    #[command(flatten)]
    files: FilesArgs,
    #[command(flatten)]
    interpolation: InterpolationArgs,
}

pub(super) fn run(command: LampCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        LampCommand::Info(a) => {
            let verb = Verb {
                command: "lamp info",
                interpolation: a.interpolation.value(),
                settings: Map::from_iter([("definitions".to_owned(), report::definitions())]),
                figures: |file| Ok(report::info(&file.value)),
                text: |path, object, _| report::info_text(path, object),
                table: report::Table::info(),
                judges: false,
            };
            files(&a.files, talk, &verb)
        }
        LampCommand::Check(a) => {
            let verb = Verb {
                command: "lamp check",
                interpolation: Interpolation::Bilinear,
                settings: Map::new(),
                figures: |file| Ok(report::check(file)),
                text: report::check_text,
                table: report::Table::check(),
                judges: true,
            };
            files(&a, talk, &verb)
        }
        LampCommand::Ugr(a) => {
            let verb = Verb {
                command: "lamp ugr",
                interpolation: Interpolation::Bilinear,
                settings: Map::new(),
                figures: |file| report::ugr(&file.value).map_err(|e| e.to_string()),
                text: |path, object, _| report::ugr_text(path, object),
                table: report::Table::ugr(),
                judges: false,
            };
            files(&a, talk, &verb)
        }
        LampCommand::Cu(a) => {
            let verb = Verb {
                command: "lamp cu",
                interpolation: Interpolation::Bilinear,
                settings: Map::new(),
                figures: |file| report::cu(&file.value).map_err(|e| e.to_string()),
                text: |path, object, _| report::cu_text(path, object),
                table: report::Table::cu(),
                judges: false,
            };
            files(&a, talk, &verb)
        }
        LampCommand::Compare(a) => compare::compare(&a, talk),
        LampCommand::Spectral(a) => spectral::spectral(&a, talk),
        LampCommand::Convert(a) => convert::convert(&a, talk),
        LampCommand::Plot(a) => plot::plot(&a, talk),
        LampCommand::Grid(a) => grid::grid(&a, talk),
    }
}

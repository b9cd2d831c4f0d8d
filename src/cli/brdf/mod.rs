//! `brdf`: materials described in words or files, audited, evaluated and drawn; one file per verb.

mod check;
mod compress;
mod convert;
mod eval;
mod fit;
mod load;
mod numbers;
mod plot;
mod settings;

use clap::Subcommand;

pub(super) use check::WAVELENGTHS_NM;
pub(super) use compress::open_basis;
pub(super) use load::{BandArgs, Loaded, Ready, Subject, load, prepare};
pub(super) use numbers::Bins;

use super::{Failure, Talk};

/// Verbs of `brdf`.
#[derive(Debug, Subcommand)]
pub(super) enum BrdfCommand {
    /// Parameters, kind, albedo and the nine reflectances of Nicodemus.
    Info(check::InfoArgs),
    /// Reciprocity, energy, sign, symmetry and coverage; exit code 1 where they fail.
    Check(check::CheckArgs),
    /// Values at lists of directions.
    Eval(eval::EvalArgs),
    /// Tables and models as MERL, ALTA or CSV files.
    Convert(convert::ConvertArgs),
    /// Models fitted to measured tables, with standard errors, and compared.
    Fit(fit::FitArgs),
    /// Lobes, albedo and a lit sphere as SVG or PNG.
    Plot(plot::PlotArgs),
    /// Compact forms of measured materials: principal components, and whole tables from a few measured directions.
    #[command(subcommand)]
    Compress(compress::CompressCommand),
}

pub(super) fn run(command: BrdfCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        BrdfCommand::Info(a) => check::info(&a, talk),
        BrdfCommand::Check(a) => check::check(&a, talk),
        BrdfCommand::Eval(a) => eval::eval(&a, talk),
        BrdfCommand::Convert(a) => convert::convert(a, talk),
        BrdfCommand::Fit(a) => fit::fit(a, talk),
        BrdfCommand::Plot(a) => plot::plot(&a, talk),
        BrdfCommand::Compress(command) => compress::run(command, talk),
    }
}

//! `trade spectrum`.

use clap::Args;
use serde_json::json;

use super::output::{Asked, Traded, settings_file};
use super::target::{must_be_defined, place};
use crate::cli::convert::single;
use crate::cli::{Failure, Talk};
use crate::constants::SecondRadiation;
use crate::conversion::Settings;
use crate::trade::spectrum::{FIGURES, sweep};

/// A spectrum, and the error asked for.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic trade spectrum data/spectra/office-led.csv --error 0.1%
  photopic trade spectrum LED-B3 --figure cct_k --error 5K --settings led.toml && photopic convert LED-B3 --settings led.toml
  photopic trade spectrum lamp.csv --csv > trade.csv")]
pub(in crate::cli) struct SpectrumArgs {
    /// A spectrum file, `-`, or a source by name.
    #[arg(value_name = "FILE")]
    file: String,
    /// The spectrum of this name, where the file holds several.
    #[arg(long, value_name = "NAME")]
    select: Option<String>,
    /// The figure whose error counts: radiometric, photopic, scotopic, chromaticity_uv_prime, cct_k, duv, cri_ra, tm30_rf, melanopic,
    /// photons.
    #[arg(long, value_name = "KEY", default_value = "photopic")]
    figure: String,
    #[command(flatten)]
    asked: Asked,
}

pub(super) fn trade(arguments: &SpectrumArgs, talk: Talk) -> Result<(), Failure> {
    let asked = &arguments.asked;
    asked.check()?;
    let figure = place(&FIGURES, &arguments.figure)?;
    asked.error.as_ref().map(|t| t.of(&FIGURES[figure])).transpose()?;
    let path = &arguments.file;
    let read = single(path, arguments.select.as_deref(), None, SecondRadiation::default())
        .map_err(|e| Failure::Message(e.message))?;
    let found = sweep(&read.measured.spectrum, &Settings::default(), read.defined, asked.repeats as usize)
        .map_err(|e| Failure::Message(format!("{path}: {e}")))?;
    must_be_defined(path, &found.sweep, figure)?;
    let traded = Traded {
        command: "trade spectrum",
        path,
        inputs: vec![read.input],
        sweep: &found.sweep,
        figure: &arguments.figure,
        // Its errors are relative or of ratios, which know no level.
        findings: read.findings.into_iter().filter(|f| !matches!(f.code, "P001" | "S010")).collect(),
    };
    let settings = |trial: usize| {
        let choice = found.choices[trial];
        let resampling = choice.resampling;
        settings_file(
            &format!("photopic trade spectrum {path}"),
            "convert",
            &[
                ("rule", choice.contract.rule.map(|r| json!(r.word()))),
                ("range_nm", choice.contract.range_nm.map(|(low, high)| json!([low, high]))),
                ("resample_nm", resampling.map(|r| json!(r.step_nm))),
                ("thin", choice.thinning.map(|t| json!(t))),
                ("interpolation", resampling.map(|r| json!(r.interpolation.word()))),
            ],
        )
    };
    asked.answer(traded, settings, talk)
}

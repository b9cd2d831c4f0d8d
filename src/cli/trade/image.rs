//! `trade image`.

use clap::Args;
use serde_json::json;

use super::output::{Asked, Traded, settings_file};
use super::target::{must_be_defined, place};
use crate::cli::image::{MeaningArgs, Reading, open};
use crate::cli::{Failure, Talk};
use crate::trade::image::{FIGURES, Spectral, middle, sweep};

/// A spectral image, and the error asked for.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic trade image cube.exr --error 0.5%
  photopic trade image leaf.hdr --illuminant LED-B3 --figure delta_e_2000 --error 1 --plot bands.svg
  photopic trade image cube.exr --error 1% --settings small.toml && photopic image convert cube.exr -o small.exr --to cube --settings small.toml")]
pub(in crate::cli) struct ImageArgs {
    /// A spectral image (EXR, ENVI, NPY, a folder or a list of grey pictures), or `-`. Of a large one the middle is tried.
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<String>,
    /// The figure whose error counts: luminance, chromaticity_xy, delta_e_2000, delta_e_2000_worst, melanopic.
    #[arg(long, value_name = "KEY", default_value = "luminance")]
    figure: String,
    #[command(flatten)]
    asked: Asked,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    meaning: MeaningArgs,
}

pub(super) fn trade(arguments: &ImageArgs, talk: Talk) -> Result<(), Failure> {
    let asked = &arguments.asked;
    asked.check()?;
    let figure = place(&FIGURES, &arguments.figure)?;
    asked.error.as_ref().map(|t| t.of(&FIGURES[figure])).transpose()?;
    let settings = arguments.meaning.settings()?;
    let mut opened = open(&arguments.images, &arguments.reading)?;
    let path = opened.path.clone();
    let message = |e: &dyn std::fmt::Display| Failure::Message(format!("{path}: {e}"));
    let image = middle(&mut opened.source).map_err(|e| Failure::Message(e.to_string()))?;
    let found = sweep(&image, &settings, asked.repeats as usize).map_err(|e| message(&e))?;
    must_be_defined(&path, &found.sweep, figure)?;
    let mut findings = std::mem::take(&mut opened.findings);
    findings.extend(opened.source.findings());
    let traded = Traded {
        command: "trade image",
        path: &path,
        inputs: opened.inputs()?,
        sweep: &found.sweep,
        figure: &arguments.figure,
        findings,
    };
    let settings = |trial: usize| {
        let choice = found.choices[trial];
        let fewer = match choice.spectral {
            Spectral::Fewer(n, how) => Some((n, how.word())),
            Spectral::Own | Spectral::Rgb => None,
        };
        settings_file(
            &format!("photopic trade image {path}"),
            "image",
            &[
                ("bands", fewer.map(|(n, _)| json!(n))),
                ("filter", fewer.map(|(_, how)| json!(how))),
                ("block", Some(json!(choice.block))),
                ("half", Some(json!(choice.half))),
            ],
        )
    };
    asked.answer(traded, settings, talk)
}

//! `trade brdf`.

use clap::Args;
use serde_json::json;

use super::output::{Asked, Traded, settings_file};
use super::target::place;
use crate::cli::brdf::{BandArgs, Loaded, Ready, WAVELENGTHS_NM, load, open_basis, prepare};
use crate::cli::{Failure, Talk};
use crate::report::envelope::Input;
use crate::trade::brdf::{Choice, FIGURES, sweep};

/// A material, and the error asked for.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic trade brdf gold.binary --error 0.1 --plot gold.svg
  photopic trade brdf paint.binary --basis merl.pca --figure albedo --error 0.01
  photopic trade brdf paint.binary --error 0.2 --settings paint.toml && photopic brdf convert paint.binary -o small.binary --settings paint.toml

A settings file names bins, which `brdf convert` takes, or a model, which `brdf fit` takes.")]
pub(in crate::cli) struct BrdfArgs {
    /// A measured table, a TOML file, a description such as 'ggx(alpha=0.1, medium=Au)', or `-`.
    #[arg(value_name = "MATERIAL")]
    material: String,
    /// The figure whose error counts: ln_rms (0.1 is about 10 % of the values), albedo.
    #[arg(long, value_name = "KEY", default_value = "ln_rms")]
    figure: String,
    /// Principal components to be tried: a basis of `brdf compress train`.
    #[arg(long, value_name = "BASIS")]
    basis: Option<String>,
    #[command(flatten)]
    bands: BandArgs,
    #[command(flatten)]
    asked: Asked,
}

pub(super) fn trade(arguments: &BrdfArgs, talk: Talk) -> Result<(), Failure> {
    let (asked, path) = (&arguments.asked, &arguments.material);
    asked.check()?;
    let figure = place(&FIGURES, &arguments.figure)?;
    asked.error.as_ref().map(|t| t.of(&FIGURES[figure])).transpose()?;
    let Loaded { input, spectra, subject, .. } = load(path, arguments.bands.format);
    let subject = subject.map_err(Failure::Message)?;
    let Ready { bands, brdf } =
        prepare(path, &subject.value, &arguments.bands, &WAVELENGTHS_NM).map_err(Failure::Message)?;
    let basis = arguments.basis.as_deref().map(open_basis).transpose()?;
    let found = sweep(
        brdf.as_ref(),
        &bands,
        subject.value.bins(),
        basis.as_ref().map(|(basis, _)| basis),
        asked.repeats as usize,
    )
    .map_err(|e| Failure::Message(format!("{path}: {e}")))?;
    let mut inputs = vec![input];
    inputs.extend(spectra);
    inputs.extend(arguments.basis.iter().zip(&basis).map(|(path, (_, checksum))| Input {
        path: path.clone(),
        sha256: Some(checksum.0.iter().map(|b| format!("{b:02x}")).collect()),
    }));
    let traded = Traded {
        command: "trade brdf",
        path,
        inputs,
        sweep: &found.sweep,
        figure: &arguments.figure,
        findings: subject.findings,
    };
    let settings = |trial: usize| {
        let choice = &found.choices[trial];
        let resolution = match choice {
            Choice::Bins(r) => Some(json!(format!("{}x{}x{}", r.theta_h, r.theta_d, r.phi_d))),
            Choice::Own | Choice::Model(_) | Choice::Components(_) => None,
        };
        let model = if let Choice::Model(words) = choice { Some(json!(words)) } else { None };
        settings_file(&format!("photopic trade brdf {path}"), "brdf", &[("resolution", resolution), ("model", model)])
    };
    asked.answer(traded, settings, talk)
}

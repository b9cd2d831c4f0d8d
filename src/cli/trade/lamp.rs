//! `trade lamp`.

use clap::Args;
use serde_json::json;

use super::output::{Asked, Traded, settings_file};
use super::target::{must_be_defined, place};
use crate::cli::lamp::load;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::luminaire::grid::has_opening;
use crate::trade::lamp::{FIGURES, sweep};

/// A lamp, and the error asked for.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic trade lamp data/lamps/street.ies --height 8 --error 1%
  photopic trade lamp panel.ldt --figure flux --error 0.5% --settings few.toml && photopic lamp grid panel.ldt --height 3 --settings few.toml
  photopic trade lamp panel.ldt --figure illuminance_5x --plot five-times.svg")]
pub(in crate::cli) struct LampArgs {
    /// A lamp file (IES LM-63, EULUMDAT, TM-33), or `-`.
    #[arg(value_name = "FILE")]
    file: String,
    /// The figure whose error counts: flux, peak_intensity, beam_angle_c0_c180, beam_angle_c90_c270, mean_illuminance (of the floor),
    /// illuminance (the floor's worst point, as a share of the mean; what lies between the entries of a coarse table is often more than 1 %
    /// there), illuminance_1x, _2x, _5x, _10x (facing the lamp, so many times its
    /// largest dimension away).
    #[arg(long, value_name = "KEY", default_value = "mean_illuminance")]
    figure: String,
    /// How high above the floor the lamp hangs, m.
    #[arg(long, value_name = "M", default_value_t = 3.0)]
    height: f64,
    /// Repair what can be repaired safely; each repair is listed.
    #[arg(long)]
    repair: bool,
    #[command(flatten)]
    asked: Asked,
}

pub(super) fn trade(arguments: &LampArgs, talk: Talk) -> Result<(), Failure> {
    let (asked, path) = (&arguments.asked, &arguments.file);
    asked.check()?;
    let figure = place(&FIGURES, &arguments.figure)?;
    asked.error.as_ref().map(|t| t.of(&FIGURES[figure])).transpose()?;
    let loaded = load(path, arguments.repair);
    let file = loaded.file.map_err(|(message, _)| Failure::Message(message))?;
    let lamp = file.value.luminaire;
    let found =
        sweep(&lamp, arguments.height, asked.repeats as usize).map_err(|e| Failure::Message(format!("{path}: {e}")))?;
    must_be_defined(path, &found.sweep, figure)?;
    let mut findings = file.findings;
    if !has_opening(&lamp) {
        let message = "the luminous opening is not known: the luminaire is taken as a point at any distance";
        findings.push(Finding::info("L601", message).at(Location::default().in_file(path)));
    }
    let traded = Traded {
        command: "trade lamp",
        path,
        inputs: vec![loaded.input],
        sweep: &found.sweep,
        figure: &arguments.figure,
        findings,
    };
    let settings = |trial: usize| {
        let choice = found.choices[trial];
        let [horizontal, vertical] = choice.every;
        settings_file(
            &format!("photopic trade lamp {path}"),
            "lamp",
            &[
                ("every_horizontal", Some(json!(horizontal))),
                ("every_vertical", Some(json!(vertical))),
                ("interpolation", Some(json!(choice.interpolation.name()))),
                ("near_ratio", Some(json!(choice.near_ratio))),
            ],
        )
    };
    asked.answer(traded, settings, talk)
}

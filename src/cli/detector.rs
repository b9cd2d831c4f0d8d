//! `detector`: responsivities of photometers, and what lamps make of them.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::convert::{all, budget};
use super::notes::Notes;
use super::output::Sink;
use super::{Failure, Talk};
use crate::constants::SecondRadiation;
use crate::finding::{Finding, Location};
use crate::photometry::detector::{self, Plan};
use crate::report::detector as report;
use crate::report::envelope::Envelope;
use crate::spectrum::format::Measured;
use crate::spectrum::{Quantity, Spectrum};
use crate::uncertainty;

/// Lamps that every detector is asked about where the user names none.
const LAMPS: [&str; 12] =
    ["D65", "FL2", "FL11", "HP1", "LED-B1", "LED-B2", "LED-B3", "LED-B4", "LED-B5", "LED-BH1", "LED-RGB1", "LED-V1"];

/// Arguments of `detector`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
A reading times the mismatch factor is right for the lamp (ISO/CIE 19476). Detectors are ranked by their largest mismatch.

Examples:
  photopic detector head.csv
  photopic detector head.csv other.csv --lamp lamps.csv --lamp FL11
  photopic detector head.csv --uncertainty budget.toml --json")]
pub(super) struct DetectorArgs {
    /// Relative spectral responsivities, one or several as columns; `-` for standard input.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    /// A lamp to measure: a file with one or several as columns, or a source by name (repeatable); by default a choice of CIE's
    /// illuminants.
    #[arg(long, value_name = "LAMP")]
    lamp: Vec<String>,
    /// The source of the detector's calibration, a file or a name; by default illuminant A by its formula.
    #[arg(long, value_name = "SOURCE")]
    calibration: Option<String>,
    /// A budget of the responsivities (TOML, docs/uncertainty.md).
    #[arg(long = "uncertainty", value_name = "BUDGET")]
    budget: Option<PathBuf>,
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One table with a header row: a row per detector and lamp.
    #[arg(long)]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Names of which a second, third … of one spelling is numbered: factors are told by name.
fn told_apart(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for name in names {
        let free = |n: &usize| !out.contains(&format!("{name} ({n})"));
        let taken = out.contains(&name);
        let number = (2..).find(free).unwrap_or(2);
        out.push(if taken { format!("{name} ({number})") } else { name });
    }
    out
}

pub(super) fn run(arguments: &DetectorArgs, talk: Talk) -> Result<(), Failure> {
    let c2 = SecondRadiation::default();
    let budget = arguments.budget.as_deref().map(budget::read).transpose()?;
    let named = LAMPS.map(str::to_owned);
    let lamp_files = if arguments.lamp.is_empty() { &named[..] } else { &arguments.lamp };
    let inputs: Vec<String> =
        arguments.files.iter().chain(&arguments.lamp).chain(&arguments.calibration).cloned().collect();
    if inputs.iter().filter(|i| *i == "-").count() > 1 {
        return Err(Failure::Message("`-` given twice; expected standard input once".into()));
    }
    let mut sink = Sink::open(arguments.output.as_deref(), &inputs)?;
    let mut notes = Notes::new(&inputs, talk);
    let calibrated = arguments.calibration.as_deref().unwrap_or("illuminant A");
    let settings =
        json!({"calibration_source": calibrated, "f1_prime_range_nm": detector::RANGE_NM, "f1_prime_step_nm": 1});
    let mut envelope = Envelope::begin(Vec::new(), "detector", &settings)?;
    let mut load = |path: &String| -> Option<Vec<Measured>> {
        match all(path, Some(Quantity::Relative), c2) {
            Ok((measured, input, _)) => {
                envelope.input(input);
                Some(measured)
            }
            Err(refused) => {
                notes.refuse(&refused.message);
                envelope.finding(*refused.finding);
                None
            }
        }
    };
    let calibration = match &arguments.calibration {
        None => Some(detector::illuminant_a()),
        Some(path) => load(path).and_then(|m| m.into_iter().next()).map(|m| m.spectrum),
    };
    let lamps: Vec<Measured> = lamp_files.iter().filter_map(&mut load).flatten().collect();
    let files: Vec<(&String, Option<Vec<Measured>>)> = arguments.files.iter().map(|path| (path, load(path))).collect();
    let Some(calibration) = calibration else { return Err(Failure::Reported) };
    let sources: Vec<&Spectrum> = lamps.iter().map(|l| &l.spectrum).collect();
    let names = told_apart(lamps.iter().map(|l| l.name.clone()));
    let mut found = Vec::new();
    for (path, measured) in &files {
        for one in measured.iter().flatten() {
            let place = || Location::default().in_file(path).of_item(&one.name);
            let grid = one.spectrum.grid();
            let plan = Plan::new(grid, &calibration, &sources).map_err(|e| Failure::Message(e.to_string()))?;
            let (low, high) = grid.range_nm();
            let mut findings = Vec::new();
            if low > detector::RANGE_NM.0 || high < detector::RANGE_NM.1 {
                let message = format!("the responsivity covers {low}–{high} nm of 380–780 nm; it counts as 0 beyond");
                findings.push(Finding::warning("D001", message));
            }
            let worth = budget.as_ref().map(|b| {
                let own = b.with_column(one.spectrum.grid(), one.standard.as_deref());
                uncertainty::detector::evaluate(&plan, &own, &one.spectrum)
            });
            let worth = worth.transpose();
            let uncertainty = match worth {
                Ok(checked) => checked.map(|c| {
                    findings.extend(c.findings);
                    c.value
                }),
                Err(why) => {
                    notes.refuse(&format!("{path} [{}]: {why}", one.name));
                    findings.push(Finding::error("P000", why.to_string()));
                    None
                }
            };
            let findings: Vec<Finding> = findings.into_iter().map(|f| f.at(place())).collect();
            notes.print(&findings);
            findings.into_iter().for_each(|f| envelope.finding(f));
            let figures = plan.figures(one.spectrum.values());
            found.push(report::Detector { path: (*path).clone(), name: one.name.clone(), figures, uncertainty });
        }
    }
    let ranked = report::ranks(&found);
    for (detector, rank) in found.iter().zip(&ranked) {
        envelope.result(&report::json(detector, &names, calibrated, *rank))?;
    }
    let document = envelope.end()?;
    let plain = match (arguments.json, arguments.csv) {
        (true, _) => document,
        (_, true) => report::csv(&found, &names).into_bytes(),
        _ => report::text(&found, &names, calibrated, &ranked).into_bytes(),
    };
    sink.write_all(&plain)?;
    sink.finish(!notes.failed || arguments.json)?;
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::told_apart;

    #[test]
    fn lamps_of_one_name_are_numbered() {
        let names = ["lamp", "D65", "lamp", "lamp"].map(str::to_owned);
        assert_eq!(told_apart(names.into_iter()), ["lamp", "D65", "lamp (2)", "lamp (3)"]);
    }
}

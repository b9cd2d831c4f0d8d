//! `lamp compare`: two lamp files side by side.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::load::load;
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::luminaire::compare as luminaire;
use crate::report::envelope::Envelope;
use crate::report::lamp as report;

/// Arguments of `lamp compare`.
#[derive(Debug, Args)]
pub(in crate::cli) struct CompareArgs {
    /// A lamp file, or `-`.
    #[arg(value_name = "A")]
    a: String,
    /// The lamp file to set beside it.
    #[arg(value_name = "B")]
    b: String,
    /// Exit with 1 where flux, peak or shape (mean absolute difference) differ by more, such as 1% or 0.01.
    #[arg(long, value_parser = fraction)]
    tolerance: Option<f64>,
    /// One JSON document.
    #[arg(long)]
    json: bool,
    /// Repair what can be repaired safely; each repair is listed.
    #[arg(long)]
    repair: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

fn fraction(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let number = match text.strip_suffix('%') {
        Some(percent) => percent.trim().parse::<f64>().map(|v| v / 100.0),
        None => text.parse(),
    };
    number
        .ok()
        .filter(|v| *v >= 0.0 && v.is_finite())
        .ok_or_else(|| format!("`{text}`; expected a part such as 1% or 0.01"))
}

pub(super) fn compare(arguments: &CompareArgs, talk: Talk) -> Result<(), Failure> {
    let inputs = [arguments.a.clone(), arguments.b.clone()];
    if inputs.iter().all(|i| i == "-") {
        return Err(Failure::Message("`-` given twice; expected standard input once".into()));
    }
    let mut sink = Sink::open(arguments.output.as_deref(), &inputs)?;
    let mut notes = Notes::new(&inputs, talk);
    let settings = json!({"repair": arguments.repair, "tolerance": arguments.tolerance});
    let mut envelope = Envelope::begin(Vec::new(), "lamp compare", &settings)?;
    let mut lamps = Vec::new();
    for path in &inputs {
        let loaded = load(path, arguments.repair);
        envelope.input(loaded.input);
        match loaded.file {
            Ok(file) => {
                notes.print(&file.findings);
                file.findings.into_iter().for_each(|f| envelope.finding(f));
                lamps.push(file.value.luminaire);
            }
            Err((message, finding)) => {
                notes.refuse(&message);
                envelope.finding(*finding);
            }
        }
    }
    let paths = [arguments.a.as_str(), arguments.b.as_str()];
    let mut plain = String::new();
    let mut passes = true;
    if let [a, b] = &lamps[..] {
        match luminaire::compare(a, b) {
            Ok(compared) => {
                passes = arguments.tolerance.is_none_or(|t| compared.within(t));
                plain = report::compare_text(paths, [a, b], &compared, arguments.tolerance);
                envelope.result(&report::compare(paths, [a, b], &compared, arguments.tolerance).into())?;
                if a.kind != b.kind {
                    let message = "the intensities are of different kinds: flux and peak are not compared";
                    let hint = "`lamp spectral -o` converts one with its spectrum";
                    let finding = Finding::warning("L520", message).hint(hint);
                    notes.print(std::slice::from_ref(&finding));
                    envelope.finding(finding);
                }
            }
            Err(why) => {
                let path = paths[usize::from(why.which == "second")];
                notes.refuse(&format!("{path}: {why}"));
                envelope.finding(Finding::error("L000", why.to_string()).at(Location::default().in_file(path)));
            }
        }
    }
    let document = envelope.end()?;
    sink.write_all(if arguments.json { &document } else { plain.as_bytes() })?;
    sink.finish(!notes.failed || arguments.json)?;
    match (notes.failed, passes) {
        (true, _) => Err(Failure::Reported),
        (false, true) => Ok(()),
        (false, false) => Err(Failure::No),
    }
}

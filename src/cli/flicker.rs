//! `flicker`: light over time.

use std::fs;
use std::io::{self, Read, Write};
use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use sha2::{Digest, Sha256};

use super::convert::positive;
use super::notes::Notes;
use super::output::Sink;
use super::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::photometry::flicker::{self, waveform};
use crate::report::envelope::{Envelope, Input};
use crate::report::flicker::{self as report, Flicker, Limits};

/// Arguments of `flicker`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
The file is delimited text: time in the first column, light in the others. SVM needs a second at 4 kHz, Pst LM three minutes (at least 40 s)
at 2 kHz. Regulation (EU) 2019/2020 wants Pst LM <= 1.0 and SVM <= 0.4 of LED light sources at full load.

Examples:
  photopic flicker lamp.csv
  photopic flicker scope.csv --svm-limit 0.4 --pst-lm-limit 1.0     (exit code 1 where one is exceeded)
  photopic flicker samples.txt --rate 20000 --json")]
pub(super) struct FlickerArgs {
    /// Waveforms; `-` for standard input.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    /// Sampling rate (Hz) of a file without a column of time.
    #[arg(long, value_name = "HZ", value_parser = positive)]
    rate: Option<f64>,
    /// Largest SVM allowed.
    #[arg(long, value_name = "SVM", value_parser = positive)]
    svm_limit: Option<f64>,
    /// Largest Pst LM allowed.
    #[arg(long, value_name = "PST", value_parser = positive)]
    pst_lm_limit: Option<f64>,
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One table with a header row: a row per waveform.
    #[arg(long)]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The bytes of a file or of standard input.
fn bytes(path: &str) -> io::Result<Vec<u8>> {
    if path != "-" {
        return fs::read(path);
    }
    let mut all = Vec::new();
    io::stdin().read_to_end(&mut all)?;
    Ok(all)
}

pub(super) fn run(arguments: &FlickerArgs, talk: Talk) -> Result<(), Failure> {
    if arguments.files.iter().filter(|f| *f == "-").count() > 1 {
        return Err(Failure::Message("`-` given twice; expected standard input once".into()));
    }
    let limits = Limits { svm: arguments.svm_limit, pst_lm: arguments.pst_lm_limit };
    let mut sink = Sink::open(arguments.output.as_deref(), &arguments.files)?;
    let mut notes = Notes::counting(arguments.files.len(), talk);
    let settings = json!({"rate_hz": arguments.rate});
    let mut envelope = Envelope::begin(Vec::new(), "flicker", &settings)?;
    let mut done: Vec<Flicker> = Vec::new();
    for path in &arguments.files {
        let mut refuse = |message: String, envelope: &mut Envelope<Vec<u8>>| {
            notes.refuse(&message);
            envelope.finding(Finding::error("F000", message).at(Location::default().in_file(path)));
        };
        let read = match bytes(path) {
            Ok(read) => read,
            Err(e) => {
                refuse(format!("{path}: cannot be read: {e}; expected a waveform"), &mut envelope);
                envelope.input(Input { path: path.clone(), sha256: None });
                continue;
            }
        };
        let sha256 = Sha256::digest(&read).iter().map(|b| format!("{b:02x}")).collect();
        envelope.input(Input { path: path.clone(), sha256: Some(sha256) });
        let (waves, mut findings) = match waveform::parse(&String::from_utf8_lossy(&read), arguments.rate) {
            Ok(parsed) => parsed,
            Err(mistake) => {
                refuse(format!("{path}:{mistake}"), &mut envelope);
                continue;
            }
        };
        findings = findings.into_iter().map(|f| f.at(Location::default().in_file(path))).collect();
        for (name, wave) in waves {
            let place = Location::default().in_file(path).of_item(&name);
            match flicker::evaluate(&wave) {
                Ok(found) => {
                    findings.extend(found.findings.into_iter().map(|f| f.at(place.clone())));
                    let duration_s = wave.values.len() as f64 / wave.rate_hz;
                    let (path, rate_hz) = (path.clone(), wave.rate_hz);
                    done.push(Flicker { path, name, rate_hz, duration_s, figures: found.value });
                }
                Err(why) => refuse(format!("{place}: {why}"), &mut envelope),
            }
        }
        notes.print(&findings);
        findings.into_iter().for_each(|f| envelope.finding(f));
    }
    for one in &done {
        envelope.result(&report::json(one, &limits))?;
    }
    let document = envelope.end()?;
    let plain = match (arguments.json, arguments.csv) {
        (true, _) => document,
        (_, true) => report::csv(&done).into_bytes(),
        _ => report::text(&done, &limits).into_bytes(),
    };
    sink.write_all(&plain)?;
    sink.finish(!notes.failed || arguments.json)?;
    match (notes.failed, done.iter().all(|f| limits.kept(&f.figures))) {
        (true, _) => Err(Failure::Reported),
        (false, true) => Ok(()),
        (false, false) => Err(Failure::No),
    }
}

//! `selfcheck`: the extremes and reference cases, run on this machine.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::notes::Notes;
use super::output::Sink;
use super::writer::csv_row;
use super::{Failure, Talk};
use crate::report::envelope::Envelope;
use crate::report::selfcheck as report;
use crate::selfcheck;

/// The form of the answer.
#[derive(Debug, Args)]
pub(super) struct SelfcheckArgs {
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One table, a row per case.
    #[arg(long)]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub(super) fn run(arguments: &SelfcheckArgs, talk: Talk) -> Result<(), Failure> {
    let mut sink = Sink::open(arguments.output.as_deref(), &[])?;
    let checks = selfcheck::run();
    let findings = report::findings(&checks);
    Notes::counting(1, talk).print(&findings);
    let passes = findings.is_empty();
    if arguments.json {
        let mut envelope = Envelope::begin(Vec::new(), "selfcheck", &json!({}))?;
        checks.iter().try_for_each(|c| envelope.result(&report::json(c)))?;
        findings.into_iter().for_each(|f| envelope.finding(f));
        sink.write_all(&envelope.end()?)?;
    } else if arguments.csv {
        sink.write_all(&csv_row(&report::COLUMNS.map(str::to_owned)))?;
        checks.iter().try_for_each(|c| sink.write_all(&csv_row(&report::row(c))))?;
    } else {
        sink.write_all(report::text(&checks).as_bytes())?;
    }
    sink.finish(true)?;
    if passes { Ok(()) } else { Err(Failure::No) }
}

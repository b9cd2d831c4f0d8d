//! What all trades take and give: the error asked for, and table, plot and settings.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::target::{Target, place};
use crate::cli::convert::format_of;
use crate::cli::notes::Notes;
use crate::cli::output::{Sink, same_file, write_file};
use crate::cli::writer::csv_row;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location, Severity};
use crate::plot::{draw, trade_panel};
use crate::report::envelope::{Envelope, Input};
use crate::report::trade::{Answer, header};
use crate::trade::Sweep;

/// What is asked for, and where the answer goes.
#[derive(Debug, Args)]
pub(super) struct Asked {
    /// Error to stay within: per cent or a fraction for relative figures, else in the figure's unit (`0.5%`, `20K`). Recommends the
    /// fastest setting that guarantees it; exit code 1 where none does.
    #[arg(long, value_name = "ERROR")]
    pub error: Option<Target>,
    /// Measurements of the time of each setting.
    #[arg(long, value_name = "N", default_value_t = 11, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub repeats: u32,
    /// Write the recommended setting to a file that the tool itself takes by `--settings`.
    #[arg(long, value_name = "FILE", requires = "error")]
    pub settings: Option<PathBuf>,
    /// Draw error over time, with the front of what nothing beats: a .svg or .png file.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    pub json: bool,
    /// One table, a row per setting.
    #[arg(long)]
    pub csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// What was traded.
pub(super) struct Traded<'a> {
    pub command: &'static str,
    pub path: &'a str,
    pub inputs: Vec<Input>,
    pub sweep: &'a Sweep,
    /// The key of the figure whose error counts.
    pub figure: &'a str,
    /// What the reader noticed.
    pub findings: Vec<Finding>,
}

impl Asked {
    /// Refuses names of outputs that clash, and errors that do not fit, before the long run.
    pub(super) fn check(&self) -> Result<(), Failure> {
        self.plot.as_deref().map(format_of).transpose()?;
        let named: Vec<&Path> =
            [&self.output, &self.plot, &self.settings].into_iter().filter_map(Option::as_deref).collect();
        let twice = named.iter().enumerate().find(|(i, a)| named[..*i].iter().any(|b| same_file(a, b)));
        twice.map_or(Ok(()), |(_, path)| {
            let message = format!("{}: named for two outputs; expected a file for each", path.display());
            Err(Failure::Message(message))
        })
    }

    /// Writes everything; `settings` makes the file of the recommended trial.
    pub(super) fn answer(
        &self,
        traded: Traded<'_>,
        settings: impl Fn(usize) -> String,
        talk: Talk,
    ) -> Result<(), Failure> {
        let Traded { command, path, inputs, sweep, figure, mut findings } = traded;
        let figure = place(&sweep.figures, figure)?;
        let target = self.error.as_ref().map(|t| t.of(&sweep.figures[figure])).transpose()?;
        let answer = Answer { path, sweep, figure, target };
        let read: Vec<String> = inputs.iter().map(|i| i.path.clone()).collect();
        let found = answer.findings().into_iter().map(|f| f.at(Location::default().in_file(path)));
        findings.extend(found);
        let notes = Notes::counting(1, talk);
        notes.print(&findings);
        let missed = findings.iter().any(|f| f.severity == Severity::Error);
        let mut sink = Sink::open(self.output.as_deref(), &read)?;
        if self.json {
            let asked = json!({"figure": sweep.figures[figure].key, "error": target, "repeats": self.repeats});
            let mut envelope = Envelope::begin(Vec::new(), command, &asked)?;
            envelope.result(&answer.json())?;
            findings.into_iter().for_each(|f| envelope.finding(f));
            inputs.into_iter().for_each(|i| envelope.input(i));
            sink.write_all(&envelope.end()?)?;
        } else if self.csv {
            sink.write_all(&csv_row(&header(sweep)))?;
            answer.rows().iter().try_for_each(|row| sink.write_all(&csv_row(row)))?;
        } else {
            sink.write_all(answer.text().as_bytes())?;
        }
        sink.finish(true)?;
        if let Some(to) = &self.plot {
            let panel = trade_panel(sweep, path, figure, target);
            let picture = draw(&[panel.into()], None, format_of(to)?);
            write_file(to, &picture.map_err(|e| Failure::Message(e.to_string()))?, &read)?;
        }
        if let (Some(to), Some(trial)) = (&self.settings, answer.recommended()) {
            write_file(to, settings(trial).as_bytes(), &read)?;
        }
        if missed { Err(Failure::No) } else { Ok(()) }
    }
}

/// The text of a file of settings: where it comes from, a section and its values.
pub(super) fn settings_file(source: &str, section: &str, values: &[(&str, Option<Value>)]) -> String {
    let mut out = format!("# {source}\n[{section}]\n");
    for (key, value) in values {
        if let Some(value) = value {
            // Numbers, words in quotes and lists are written alike in JSON and TOML.
            out += &format!("{key} = {value}\n");
        }
    }
    out
}

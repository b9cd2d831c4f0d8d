//! Verbs that give one object of figures per file.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use rayon::prelude::*;
use serde_json::{Map, Value, json};

use super::load::{Loaded, load};
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::luminaire::format::File;
use crate::report::envelope::Envelope;

/// Files read at a time.
pub(super) const FILES_AT_ONCE: usize = 256;

/// Input files and the form of the answer.
#[derive(Debug, Args)]
pub(in crate::cli) struct FilesArgs {
    /// Lamp files (IES LM-63, EULUMDAT, TM-33), or `-`.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<String>,
    /// One JSON document.
    #[arg(long)]
    pub json: bool,
    /// Repair what can be repaired safely; each repair is listed.
    #[arg(long)]
    pub repair: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// The figures of one file, or why it has none.
type Figured = Result<Map<String, Value>, String>;
/// How figures are made of a file.
type Figures<'a> = dyn Fn(&File) -> Figured + Sync + 'a;

pub(super) fn files(
    arguments: &FilesArgs,
    talk: Talk,
    command: &str,
    figures: &Figures<'_>,
    text: &dyn Fn(&str, &Map<String, Value>) -> String,
) -> Result<(), Failure> {
    let mut sink = Sink::open(arguments.output.as_deref(), &arguments.files)?;
    let mut notes = Notes::new(&arguments.files, talk);
    let mut envelope = Envelope::begin(Vec::new(), command, &json!({"repair": arguments.repair}))?;
    let mut plain = String::new();
    let mut results = 0;
    for paths in arguments.files.chunks(FILES_AT_ONCE) {
        let loaded: Vec<(Loaded, Option<Figured>)> = paths
            .par_iter()
            .map(|path| {
                let loaded = load(path, arguments.repair);
                let figures = loaded.file.as_ref().ok().map(|f| figures(&f.value));
                (loaded, figures)
            })
            .collect();
        for (loaded, figures) in loaded {
            let path = loaded.input.path.clone();
            envelope.input(loaded.input);
            match (loaded.file, figures) {
                (Ok(file), Some(Ok(object))) => {
                    if results > 0 {
                        plain.push('\n');
                    }
                    results += 1;
                    plain.push_str(&text(&path, &object));
                    let mut with_path = Map::from_iter([("path".to_owned(), path.into())]);
                    with_path.extend(object);
                    envelope.result(&with_path.into())?;
                    notes.print(&file.findings);
                    file.findings.into_iter().for_each(|f| envelope.finding(f));
                }
                (Ok(_), Some(Err(why))) => {
                    notes.refuse(&format!("{path}: {why}"));
                    envelope.finding(Finding::error("L000", why).at(Location::default().in_file(&path)));
                }
                (Err((message, finding)), _) => {
                    notes.refuse(&message);
                    envelope.finding(*finding);
                }
                (Ok(_), None) => {}
            }
        }
    }
    let document = envelope.end()?;
    sink.write_all(if arguments.json { &document } else { plain.as_bytes() })?;
    sink.finish(results > 0 || arguments.json)?;
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

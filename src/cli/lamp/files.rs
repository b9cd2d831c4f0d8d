//! Verbs that give one object of figures per file: read in parallel, reported in the order given, written as they come.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use rayon::prelude::*;
use serde_json::{Map, Value, json};

use super::interpolation::interpolate;
use super::load::{Loaded, load};
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::writer::{Writer, csv_row};
use crate::cli::{Failure, Talk};
use crate::finding::{Checked, Finding, Location};
use crate::luminaire::Interpolation;
use crate::luminaire::format::File;
use crate::report::envelope::Envelope;
use crate::report::lamp as report;

/// Files read at a time: what is held in memory.
pub(super) const FILES_AT_ONCE: usize = 256;

/// Input files and the form of the answer.
#[derive(Debug, Args)]
pub(in crate::cli) struct FilesArgs {
    /// Lamp files (IES LM-63, EULUMDAT, TM-33), folders with such files, or `-`.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<String>,
    /// One JSON document with every figure in full precision.
    #[arg(long, conflicts_with = "csv")]
    pub json: bool,
    /// One table with a header: a row per file, or the rows of the table asked for.
    #[arg(long)]
    pub csv: bool,
    /// Repair what can be repaired safely; each repair is listed.
    #[arg(long)]
    pub repair: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// The figures of one file, or why it has none.
type Figured = Result<Map<String, Value>, String>;

/// What a verb makes of a file.
pub(super) struct Verb {
    pub command: &'static str,
    /// How the tables are taken between their entries.
    pub interpolation: Interpolation,
    /// Settings of the run, besides the arguments.
    pub settings: Map<String, Value>,
    /// The object of the file, or why it has none.
    pub figures: fn(&Checked<File>) -> Figured,
    /// The object for people.
    pub text: fn(&str, &Map<String, Value>, &[Finding]) -> String,
    pub table: report::Table,
    /// The findings are the answer, and not said beside it.
    pub judges: bool,
}

/// One file, ready to be written.
struct Done {
    loaded: Loaded,
    figures: Option<Result<(Vec<u8>, bool), String>>,
}

pub(super) fn files(arguments: &FilesArgs, talk: Talk, verb: &Verb) -> Result<(), Failure> {
    let paths = expanded(&arguments.files)?;
    let mut sink = Sink::open(arguments.output.as_deref(), &paths)?;
    let mut settings = Map::from_iter([("repair".to_owned(), json!(arguments.repair))]);
    settings.extend(verb.settings.clone());
    let mut writer = if arguments.json {
        Writer::json(Envelope::begin(&mut sink, verb.command, &settings.into())?)
    } else {
        if arguments.csv {
            sink.write_all(&csv_row(&verb.table.header()))?;
        }
        Writer::plain(&mut sink)
    };
    let mut notes = Notes::counting(paths.len(), talk);
    let mut all_pass = true;
    for chunk in paths.chunks(FILES_AT_ONCE) {
        let progress = notes.progress.clone();
        let done: Vec<Done> = chunk
            .par_iter()
            .map(|path| {
                let done = one(path, arguments, verb);
                progress.inc(1);
                done
            })
            .collect();
        for Done { loaded, figures } in done {
            let path = loaded.input.path.clone();
            match (loaded.file, figures) {
                (Ok(file), Some(Ok((bytes, passes)))) => {
                    all_pass &= passes;
                    writer.result(&bytes)?;
                    if !verb.judges {
                        notes.print(&file.findings);
                    }
                    file.findings.into_iter().for_each(|f| writer.finding(f));
                }
                (Ok(_), Some(Err(why))) => {
                    notes.refuse(&format!("{path}: {why}"));
                    writer.finding(Finding::error("L000", why).at(Location::default().in_file(&path)));
                }
                (Err((message, finding)), _) => {
                    notes.refuse(&message);
                    writer.finding(*finding);
                }
                (Ok(_), None) => {}
            }
            writer.input(loaded.input);
        }
    }
    notes.progress.finish_and_clear();
    let results = writer.end()?;
    sink.finish(results > 0 || arguments.json)?;
    match (notes.failed, all_pass) {
        (true, _) => Err(Failure::Reported),
        (false, false) => Err(Failure::No),
        (false, true) => Ok(()),
    }
}

/// Reads a file and renders its object; whether it passes, of the verb that judges.
fn one(path: &str, arguments: &FilesArgs, verb: &Verb) -> Done {
    let mut loaded = load(path, arguments.repair);
    if let Ok(file) = &mut loaded.file {
        interpolate(&mut file.value, verb.interpolation);
    }
    let figures = loaded.file.as_ref().ok().map(|file| {
        let mut object = Map::from_iter([("path".to_owned(), path.into())]);
        object.extend((verb.figures)(file)?);
        let passes = object.get("passes") != Some(&Value::Bool(false));
        let bytes = if arguments.json {
            Value::from(object).to_string().into_bytes()
        } else if arguments.csv {
            verb.table.rows(&object).iter().flat_map(|row| csv_row(row)).collect()
        } else {
            (verb.text)(path, &object, &file.findings).into_bytes()
        };
        Ok((bytes, passes))
    });
    Done { loaded, figures }
}

/// The inputs, with the lamp files of a folder in the order of their names in its place.
fn expanded(inputs: &[String]) -> Result<Vec<String>, Failure> {
    if inputs.iter().filter(|path| *path == "-").count() > 1 {
        return Err(Failure::Message("`-` given twice; expected standard input once".to_owned()));
    }
    let mut out = Vec::with_capacity(inputs.len());
    for input in inputs {
        if input == "-" || !fs::metadata(input).is_ok_and(|m| m.is_dir()) {
            out.push(input.clone());
            continue;
        }
        let entries = fs::read_dir(input).map_err(|e| Failure::Message(format!("{input}: cannot be read: {e}")))?;
        let lamp = |path: &PathBuf| {
            let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
            matches!(ending.as_str(), "ies" | "ldt" | "xml") && path.is_file()
        };
        let paths = entries.filter_map(|entry| Some(entry.ok()?.path())).filter(lamp);
        let mut paths: Vec<String> = paths.filter_map(|p| p.to_str().map(str::to_owned)).collect();
        if paths.is_empty() {
            let message = format!("{input}: a folder without lamp files; expected some that end in .ies, .ldt or .xml");
            return Err(Failure::Message(message));
        }
        paths.sort_unstable();
        out.extend(paths);
    }
    Ok(out)
}

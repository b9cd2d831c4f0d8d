//! `lamp`: goniometric lamp data checked and analysed.

use std::fs;
use std::io::{self, Read, Write};
use std::path::PathBuf;

use clap::{Args, Subcommand};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};

use super::notes::Notes;
use super::output::{self, Sink};
use super::{Failure, Talk};
use crate::finding::{Checked, Finding, Location, Severity};
use crate::luminaire::format::{self, File, ReadOptions, eulumdat, ies, tm33};
use crate::report::envelope::{Envelope, Input};
use crate::report::lamp as report;

/// Files read at a time.
const FILES_AT_ONCE: usize = 256;

/// Verbs of `lamp`.
#[derive(Debug, Subcommand)]
pub(super) enum LampCommand {
    /// Facts and figures: flux, peak, beam, zones, luminance.
    Info(FilesArgs),
    /// Findings; exit code 1 where there are errors among them.
    Check(FilesArgs),
    /// The corrected UGR table (CIE 190): 19 rooms, crosswise and endwise.
    Ugr(FilesArgs),
    /// Zonal-cavity coefficients of utilisation, per cent.
    Cu(FilesArgs),
    /// Another format: .ies (LM-63), .ldt (EULUMDAT) or .xml (TM-33-23), by the name of the output.
    Convert(ConvertArgs),
}

/// Input files and the form of the answer.
#[derive(Debug, Args)]
pub(super) struct FilesArgs {
    /// Lamp files (IES LM-63, EULUMDAT, TM-33), or `-`.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
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

/// Arguments of `lamp convert`.
#[derive(Debug, Args)]
pub(super) struct ConvertArgs {
    /// A lamp file, or `-`.
    #[arg(value_name = "FILE")]
    file: String,
    /// The file to write: its ending says the format.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Edition of LM-63 to write: 1986, 1991, 1995, 2002, 2019.
    #[arg(long, value_name = "YEAR", default_value = "2019", value_parser = edition)]
    lm63: ies::Version,
    /// Repair what can be repaired safely; each repair is listed.
    #[arg(long)]
    repair: bool,
}

fn edition(text: &str) -> Result<ies::Version, String> {
    ies::Version::of_year(text)
        .ok_or_else(|| format!("`{text}` is no edition; expected 1986, 1991, 1995, 2002 or 2019"))
}

pub(super) fn run(command: LampCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        LampCommand::Info(a) => files(&a, talk, "lamp info", &|f| Ok(report::info(f)), &report::info_text),
        LampCommand::Ugr(a) => {
            files(&a, talk, "lamp ugr", &|f| report::ugr(f).map_err(|e| e.to_string()), &report::rows_text)
        }
        LampCommand::Cu(a) => {
            files(&a, talk, "lamp cu", &|f| report::cu(f).map_err(|e| e.to_string()), &report::rows_text)
        }
        LampCommand::Check(a) => check(&a, talk),
        LampCommand::Convert(a) => convert(&a, talk),
    }
}

/// A file read, with its checksum.
struct Loaded {
    input: Input,
    file: Result<Checked<File>, (String, Box<Finding>)>,
}

fn load(path: &str, repair: bool) -> Loaded {
    let bytes = if path == "-" {
        let mut bytes = Vec::new();
        io::stdin().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        fs::read(path)
    };
    let place = Location::default().in_file(path);
    match bytes {
        Err(error) => {
            let message = format!("cannot be read: {error}; expected a readable lamp file");
            let finding = Finding::error("L000", message.clone()).at(place);
            Loaded {
                input: Input { path: path.to_owned(), sha256: None },
                file: Err((format!("{path}: {message}"), Box::new(finding))),
            }
        }
        Ok(bytes) => {
            let sha256 = Some(Sha256::digest(&bytes).iter().map(|b| format!("{b:02x}")).collect());
            let file = format::open(&bytes, &ReadOptions { format: None, repair }).map_err(|error| {
                let error = error.in_file(path);
                let mut finding = Finding::error("L000", error.kind().to_string()).at(error.location().clone());
                finding.hint = error.hint().map(str::to_owned);
                (error.to_string(), Box::new(finding))
            });
            let file = file.map(|mut checked| {
                for finding in &mut checked.findings {
                    finding.location.path = Some(path.to_owned());
                }
                checked
            });
            Loaded { input: Input { path: path.to_owned(), sha256 }, file }
        }
    }
}

/// The figures of one file, or why it has none.
type Figured = Result<Map<String, Value>, String>;
/// How figures are made of a file.
type Figures<'a> = dyn Fn(&File) -> Figured + Sync + 'a;

fn files(
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

fn check(arguments: &FilesArgs, talk: Talk) -> Result<(), Failure> {
    let mut sink = Sink::open(arguments.output.as_deref(), &arguments.files)?;
    let mut notes = Notes::new(&arguments.files, talk);
    let mut envelope = Envelope::begin(Vec::new(), "lamp check", &json!({"repair": arguments.repair}))?;
    let mut plain = String::new();
    let mut errors = 0;
    for paths in arguments.files.chunks(FILES_AT_ONCE) {
        let loaded: Vec<Loaded> = paths.par_iter().map(|path| load(path, arguments.repair)).collect();
        for Loaded { input, file } in loaded {
            let path = input.path.clone();
            envelope.input(input);
            match file {
                Ok(file) => {
                    let worst = file.findings.iter().filter(|f| f.severity == Severity::Error).count();
                    errors += worst;
                    plain.push_str(&format!("{path}: {} findings, {worst} errors\n", file.findings.len()));
                    for finding in &file.findings {
                        plain.push_str(&format!("  {finding}\n"));
                    }
                    let object = json!({"path": path, "format": file.value.format.to_string(), "format_version": file.value.version, "findings": file.findings.len(), "errors": worst, "passes": worst == 0});
                    envelope.result(&object)?;
                    file.findings.into_iter().for_each(|f| envelope.finding(f));
                }
                Err((message, finding)) => {
                    notes.refuse(&message);
                    envelope.finding(*finding);
                }
            }
        }
    }
    let document = envelope.end()?;
    sink.write_all(if arguments.json { &document } else { plain.as_bytes() })?;
    sink.finish(true)?;
    match (notes.failed, errors) {
        (true, _) => Err(Failure::Reported),
        (false, 0) => Ok(()),
        (false, _) => Err(Failure::No),
    }
}

fn convert(arguments: &ConvertArgs, talk: Talk) -> Result<(), Failure> {
    let inputs = [arguments.file.clone()];
    let notes = Notes::new(&inputs, talk);
    let file = load(&arguments.file, arguments.repair).file.map_err(|(message, _)| Failure::Message(message))?;
    notes.print(&file.findings);
    let lamp = &file.value.luminaire;
    let ending = arguments.output.extension().and_then(|e| e.to_str()).map(str::to_lowercase);
    let written = match ending.as_deref() {
        Some("ies") => ies::write(lamp, arguments.lm63),
        Some("ldt") => eulumdat::write(lamp),
        Some("xml") => tm33::write(lamp),
        _ => {
            let message = format!("{}: expected a name ending in .ies, .ldt or .xml", arguments.output.display());
            return Err(Failure::Message(message));
        }
    };
    let Checked { value, findings } = written.map_err(|e| Failure::Message(format!("{}: {e}", arguments.file)))?;
    notes.print(&findings);
    output::write_file(&arguments.output, value.as_bytes(), &inputs)
}

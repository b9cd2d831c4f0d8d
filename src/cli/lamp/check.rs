//! `lamp check`: the findings of lamp files.

use std::io::Write;

use rayon::prelude::*;
use serde_json::json;

use super::files::{FILES_AT_ONCE, FilesArgs};
use super::load::{Loaded, load};
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::finding::Severity;
use crate::report::envelope::Envelope;

pub(super) fn check(arguments: &FilesArgs, talk: Talk) -> Result<(), Failure> {
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

//! `lamp convert`: lamp files in another format.

mod target;

use std::path::{Path, PathBuf};

use clap::Args;
use rayon::prelude::*;

use self::target::{Choice, Target, encode};
use super::files::FILES_AT_ONCE;
use super::load::load;
use super::transform_args::TransformArgs;
use crate::cli::notes::Notes;
use crate::cli::places::Places;
use crate::cli::{Failure, Talk};
use crate::finding::Finding;
use crate::luminaire::format::ies;

/// Arguments of `lamp convert`.
#[derive(Debug, Args)]
pub(in crate::cli) struct ConvertArgs {
    /// Lamp files (IES LM-63, EULUMDAT, TM-33), or `-`.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    /// The file to write, a folder for many (`DIR/`), or `-`. An ending .ies, .ldt, .xml (TM-33), .csv, .rad, .pbrt or .exr
    /// says the format.
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// The format, where the name of the output does not say it.
    #[arg(long, value_name = "FORMAT", value_enum)]
    to: Option<Target>,
    /// Edition of LM-63 to write: 1986, 1991, 1995, 2002, 2019.
    #[arg(long, value_name = "YEAR", default_value = "2019", value_parser = edition)]
    lm63: ies::Version,
    /// Pixels on a side of the pictures of pbrt (1024), mitsuba (512 per face of a cube) and exr (1024 high).
    #[arg(long, value_name = "N")]
    pixels: Option<usize>,
    /// Repair what can be repaired safely; each repair is listed.
    #[arg(long)]
    repair: bool,
    #[command(flatten)]
    transform: TransformArgs,
}

fn edition(text: &str) -> Result<ies::Version, String> {
    ies::Version::of_year(text)
        .ok_or_else(|| format!("`{text}` is no edition; expected 1986, 1991, 1995, 2002 or 2019"))
}

pub(super) fn convert(arguments: &ConvertArgs, talk: Talk) -> Result<(), Failure> {
    let target = arguments.to.or_else(|| Target::of_name(&arguments.output)).ok_or_else(|| {
        let message = "expected a name ending in .ies, .ldt, .xml, .csv, .rad, .pbrt or .exr, or --to FORMAT";
        Failure::Message(format!("{}: {message}", arguments.output.display()))
    })?;
    let choice = Choice { target, lm63: arguments.lm63, pixels: arguments.pixels };
    let read: Vec<String> =
        arguments.files.iter().map(String::as_str).chain(arguments.transform.inputs()).map(str::to_owned).collect();
    let places = Places::of(&arguments.files, &read, &arguments.output, target.ending())?;
    places.prepare()?;
    let mut notes = Notes::new(&arguments.files, talk);
    let indices: Vec<usize> = (0..arguments.files.len()).collect();
    for indices in indices.chunks(FILES_AT_ONCE) {
        let done: Vec<(Vec<Finding>, Result<(), Failure>)> =
            indices.par_iter().map(|i| one(arguments, &places, choice, *i)).collect();
        for (findings, outcome) in done {
            notes.print(&findings);
            match outcome {
                Ok(()) => {}
                Err(Failure::BrokenPipe) => return Err(Failure::BrokenPipe),
                Err(failure) => notes.refuse(&failure.to_string()),
            }
        }
    }
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

/// Load, encode, write: the findings on the way, and how it ended.
fn one(arguments: &ConvertArgs, places: &Places, choice: Choice, index: usize) -> (Vec<Finding>, Result<(), Failure>) {
    let mut findings = Vec::new();
    let outcome = write_one(arguments, places, choice, index, &mut findings);
    (findings, outcome)
}

fn write_one(
    arguments: &ConvertArgs,
    places: &Places,
    choice: Choice,
    index: usize,
    findings: &mut Vec<Finding>,
) -> Result<(), Failure> {
    let path = &arguments.files[index];
    let stem = places.stem(index).map_err(Failure::Message)?;
    let file = load(path, arguments.repair).file.map_err(|(message, _)| Failure::Message(message))?;
    findings.extend(file.findings);
    let from = file.value.format;
    let transformed = arguments.transform.apply(file.value, arguments.repair).map_err(|failure| match failure {
        Failure::Message(message) => Failure::Message(format!("{path}: {message}")),
        other => other,
    })?;
    let encoded =
        encode(&transformed.value, from, &stem, choice).map_err(|e| Failure::Message(format!("{path}: {e}")))?;
    findings.extend(transformed.findings.into_iter().chain(encoded.findings).map(|mut finding| {
        finding.location.path.get_or_insert_with(|| path.clone());
        finding
    }));
    if !choice.target.is_one_file() && places.main(index).is_ok_and(|main| main == Path::new("-")) {
        let message = "-: standard output holds one file and this format has several; expected a name";
        return Err(Failure::Message(message.to_owned()));
    }
    let named: Vec<(&str, &[u8])> = encoded.value.iter().map(|f| (f.suffix.as_str(), f.bytes.as_slice())).collect();
    places.write(index, &named)
}

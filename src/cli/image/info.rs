//! `image info`.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::look::{When, look};
use super::open::{Reading, Watched, open};
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::constants::SecondRadiation;
use crate::finding::{Finding, Location};
use crate::illuminant::named;
use crate::image::{Content, Photometric, Settings, Source, Statistics};
use crate::photometry::luminous::Efficiency;
use crate::plot::luminance::FalseColour;
use crate::report::envelope::Envelope;
use crate::report::image as report;

/// Arguments of `image info`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  photopic image info cube.hdr
  photopic image info render.exr --json
  photopic image info scene.pic
  photopic image info render.exr --look
  photopic image info stack/ --wavelengths bands.csv")]
pub(in crate::cli) struct InfoArgs {
    /// Images: EXR, ENVI (header or data), NPY, Radiance, PNG, JPEG, TIFF, folders of grey pictures, `-` for standard input.
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<String>,
    #[command(flatten)]
    reading: Reading,
    /// Also show it in the terminal; `--look=always` in a pipe, too.
    #[arg(long, value_enum, value_name = "WHEN", num_args = 0..=1, require_equals = true, default_missing_value = "auto")]
    look: Option<When>,
    /// One JSON document.
    #[arg(long, conflicts_with = "look")]
    json: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub(super) fn info(arguments: &InfoArgs, talk: Talk) -> Result<(), Failure> {
    let mut sink = Sink::open(arguments.output.as_deref(), &arguments.images)?;
    let mut notes = Notes::new(&arguments.images, talk);
    let mut envelope = Envelope::begin(Vec::new(), "image info", &json!({}))?;
    let mut plain = String::new();
    for path in &arguments.images {
        let one = || {
            let opened = open(std::slice::from_ref(path), &arguments.reading)?;
            let inputs = if arguments.json { opened.inputs()? } else { Vec::new() };
            let mut source = Watched { source: opened.source, progress: notes.progress.clone() };
            let channels: Vec<usize> = (0..source.description().channels.len()).collect();
            let statistics =
                Statistics::of(&mut source, &channels, |_| ()).map_err(|e| Failure::Message(e.to_string()))?;
            let looked = match arguments.look.filter(|when| when.now(arguments.output.as_deref())) {
                Some(_) => quick_look(&mut source)?,
                None => String::new(),
            };
            let findings: Vec<Finding> = opened.findings.into_iter().chain(source.findings()).collect();
            Ok((inputs, source.description().clone(), statistics, findings, looked))
        };
        match one() {
            Ok((inputs, description, statistics, findings, looked)) => {
                inputs.into_iter().for_each(|input| envelope.input(input));
                if !plain.is_empty() {
                    plain.push('\n');
                }
                plain.push_str(&report::info_text(path, &description, &statistics));
                plain.push_str(&looked);
                let mut object = serde_json::Map::from_iter([("path".to_owned(), path.clone().into())]);
                object.extend(report::info(&description, &statistics));
                envelope.result(&object.into())?;
                notes.print(&findings);
                findings.into_iter().for_each(|f| envelope.finding(f));
            }
            Err(Failure::Message(message)) => {
                notes.refuse(&message);
                envelope.finding(Finding::error("I000", message).at(Location::default().in_file(path)));
            }
            Err(other) => return Err(other),
        }
    }
    let document = envelope.end()?;
    sink.write_all(if arguments.json { &document } else { plain.as_bytes() })?;
    sink.finish(!plain.is_empty() || arguments.json)?;
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

/// The image in false colours: its luminance, or that of a reflectance under D65.
fn quick_look(source: &mut dyn Source) -> Result<String, Failure> {
    let d65 = named::source("D65", SecondRadiation::default());
    let lit = source.description().content == Content::Reflectance;
    let illuminant = d65.ok().filter(|_| lit).map(|d65| (d65.name, d65.spectrum));
    let settings = Settings { illuminant, ..Settings::default() };
    match Photometric::luminance(source.description(), Efficiency::default(), &settings) {
        Ok(way) => look(source, &way.value, &FalseColour::default()),
        Err(why) => Ok(format!("  no picture: {why}\n")),
    }
}

//! `require`: the simplest model that carries an input within an error, and the error of a simpler one.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde_json::json;

use super::brdf::{BandArgs, Loaded, Ready, WAVELENGTHS_NM, load as load_material, prepare};
use super::capture::{FITTED, Retaken};
use super::convert::single;
use super::image::{MeaningArgs, Reading, open as open_image};
use super::lamp::load as load_lamp;
use super::notes::Notes;
use super::output::Sink;
use super::render::Scene;
use super::trade::{CAPTURE_BINS as BINS, Target};
use super::writer::csv_row;
use super::{Failure, Talk};
use crate::brdf::fit::Options;
use crate::constants::SecondRadiation;
use crate::finding::{Finding, Location};
use crate::illuminant::named;
use crate::render::description::Description;
use crate::report::envelope::{Envelope, Input};
use crate::report::require as report;
use crate::trade::Figure;
use crate::trade::image::middle;
use crate::trade::require::{self, Requirement};
use crate::{brdf, luminaire};

/// Inputs and the error that is allowed.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic require data/scenes/office.toml --error 1%
  photopic require capture.toml --error 5%
  photopic require data/lamps/street.ies --height 8 LED-B3 'lambert + ggx(alpha=0.2, eta=1.5)' cube.exr --json

A rung is needed where all simpler ones are beyond the error; the rung below is told with its measured error.")]
pub(super) struct RequireArgs {
    /// Scenes, lamps, spectra (files or names), materials (tables or descriptions), spectral images, manifests of photographs: told apart by
    /// their content.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    /// Error to stay within: per cent, or a fraction.
    #[arg(long, value_name = "ERROR", default_value = "1%")]
    error: Target,
    /// What the inputs are, where their content does not say it; with it an input may be `-`.
    #[arg(long = "as", value_enum, value_name = "KIND")]
    kind: Option<Kind>,
    /// How high above the floor lamps hang, m.
    #[arg(long, value_name = "M", default_value_t = 3.0)]
    height: f64,
    /// Samples of a scene's meter in each of the runs, instead of the scene's.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    meter_samples: Option<u64>,
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One table, a row per rung.
    #[arg(long)]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    meaning: MeaningArgs,
}

/// Kinds of input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// A scene (TOML).
    Scene,
    /// A lamp (IES LM-63, EULUMDAT, TM-33).
    Lamp,
    /// A spectrum.
    Spectrum,
    /// A BRDF, table or model.
    Material,
    /// A spectral image.
    Image,
    /// A manifest of photographs of an object, as for `capture brdf`.
    Capture,
}

impl Kind {
    fn word(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Lamp => "lamp",
            Self::Spectrum => "spectrum",
            Self::Material => "material",
            Self::Image => "image",
            Self::Capture => "capture",
        }
    }
}

/// What an input requires, and what was read for it.
struct Answered {
    kind: Kind,
    requirements: Vec<Requirement>,
    inputs: Vec<Input>,
    findings: Vec<Finding>,
}

pub(super) fn run(arguments: &RequireArgs, talk: Talk) -> Result<(), Failure> {
    let most = arguments.error.of(&Figure::relative("the requirement"))?;
    let mut sink = Sink::open(arguments.output.as_deref(), &arguments.files)?;
    let mut notes = Notes::counting(1, talk);
    let mut envelope = Envelope::begin(Vec::new(), "require", &json!({"error": most, "height_m": arguments.height}))?;
    let (mut text, mut table) = (String::new(), csv_row(&report::COLUMNS.map(str::to_owned)));
    let mut missed = false;
    for path in &arguments.files {
        match answer(path, arguments, most, talk) {
            Ok(answered) => {
                let Answered { kind, requirements, inputs, mut findings } = answered;
                findings.extend(
                    report::findings(&requirements, most).into_iter().map(|f| f.at(Location::default().in_file(path))),
                );
                missed |= requirements.iter().any(|r| r.needed.is_none());
                notes.print(&findings);
                envelope.result(&report::json(path, kind.word(), &requirements))?;
                inputs.into_iter().for_each(|i| envelope.input(i));
                findings.into_iter().for_each(|f| envelope.finding(f));
                text += &report::text(path, kind.word(), &requirements, most);
                report::rows(path, &requirements).iter().for_each(|row| table.extend(csv_row(row)));
            }
            Err(Failure::Message(message)) => {
                notes.refuse(&message);
                envelope.finding(Finding::error("T000", message).at(Location::default().in_file(path)));
            }
            Err(failure) => return Err(failure),
        }
    }
    let document = envelope.end()?;
    sink.write_all(match (arguments.json, arguments.csv) {
        (true, _) => &document,
        (_, true) => &table,
        _ => text.as_bytes(),
    })?;
    sink.finish(true)?;
    match (notes.failed, missed) {
        (true, _) => Err(Failure::Reported),
        (_, true) => Err(Failure::No),
        _ => Ok(()),
    }
}

fn answer(path: &str, arguments: &RequireArgs, most: f64, talk: Talk) -> Result<Answered, Failure> {
    let kind = match arguments.kind {
        Some(kind) => kind,
        None => kind_of(path)?,
    };
    let message = |e: &dyn std::fmt::Display| Failure::Message(format!("{path}: {e}"));
    let of = |requirements, inputs, findings| Ok(Answered { kind, requirements, inputs, findings });
    match kind {
        Kind::Scene => {
            let scene = Scene::read(path)?;
            let at = |e: &dyn std::fmt::Display| Failure::Message(format!("{path}:{e}"));
            let mut description = Description::parse(&scene.text).map_err(|e| at(&e))?;
            let render = &mut description.render;
            render.meter_samples = arguments.meter_samples.unwrap_or(render.meter_samples);
            let found = require::scene(&scene.text, &description, &scene, most).map_err(|e| at(&e))?;
            of(found, scene.inputs(), Vec::new())
        }
        Kind::Lamp => {
            let loaded = load_lamp(path, false);
            let file = loaded.file.map_err(|(message, _)| Failure::Message(message))?;
            let found = require::lamp(&file.value.luminaire, arguments.height, most).map_err(|e| message(&e))?;
            of(found, vec![loaded.input], file.findings)
        }
        Kind::Spectrum => {
            let read = single(path, None, None, SecondRadiation::default()).map_err(|e| Failure::Message(e.message))?;
            let found = require::spectrum(&read.measured.spectrum, read.defined, most).map_err(|e| message(&e))?;
            // Errors are relative, which know no level.
            let findings = read.findings.into_iter().filter(|f| !matches!(f.code, "P001" | "S010")).collect();
            of(found, vec![read.input], findings)
        }
        Kind::Material => {
            let bands = BandArgs::default();
            let Loaded { input, spectra, subject, .. } = load_material(path, None);
            let subject = subject.map_err(Failure::Message)?;
            let Ready { bands, brdf } =
                prepare(path, &subject.value, &bands, &WAVELENGTHS_NM).map_err(Failure::Message)?;
            let found =
                require::material(brdf.as_ref(), &bands, subject.value.bins(), most).map_err(|e| message(&e))?;
            of(found, std::iter::once(input).chain(spectra).collect(), subject.findings)
        }
        Kind::Image => {
            let mut opened = open_image(std::slice::from_ref(&path.to_owned()), &arguments.reading)?;
            let settings = arguments.meaning.settings()?;
            let image = middle(&mut opened.source).map_err(|e| Failure::Message(e.to_string()))?;
            let found = require::image(&image, &settings, most).map_err(|e| message(&e))?;
            let inputs = opened.inputs()?;
            of(found, inputs, opened.findings)
        }
        Kind::Capture => {
            let photos = Retaken::open(path, talk)?;
            let options = Options { places: Some(FITTED), ..Options::default() };
            // The finest comes first.
            let (mut inputs, mut findings) = (None, Vec::new());
            let found = require::capture((photos.lights, photos.exposures), &options, BINS, most, |choice| {
                let taken = photos.measure(choice).map_err(|e| e.to_string())?;
                if inputs.is_none() {
                    (inputs, findings) = (Some(taken.inputs), taken.findings);
                }
                Ok((taken.all, taken.pixel_variance_sd))
            });
            let found = found.map_err(|e| message(&e))?;
            of(found, inputs.unwrap_or_default(), findings)
        }
    }
}

/// The kind of an input by its name and content.
fn kind_of(path: &str) -> Result<Kind, Failure> {
    if path == "-" {
        return Err(Failure::Message("-: standard input is read but once; expected --as KIND with it".to_owned()));
    }
    let place = Path::new(path);
    if !place.exists() {
        // Their readers tell what is wrong with a name that is none.
        return Ok(if path.contains('(') && !named::is_name(path) { Kind::Material } else { Kind::Spectrum });
    }
    if place.is_dir() {
        return Ok(Kind::Image);
    }
    let cannot = |e: std::io::Error| Failure::Message(format!("{path}: cannot be read: {e}; expected a readable file"));
    let mut start = Vec::new();
    File::open(place).map_err(cannot)?.take(8).read_to_end(&mut start).map_err(cannot)?;
    let of_image: [&[u8]; 5] = [&[0x76, 0x2f, 0x31, 0x01], b"\x93NUMPY", b"ENVI", b"\x89PNG", b"#?"];
    if of_image.iter().any(|magic| start.starts_with(magic)) {
        return Ok(Kind::Image);
    }
    let bytes = fs::read(place).map_err(cannot)?;
    let text = std::str::from_utf8(&bytes).unwrap_or_default();
    let has = |table: &str| text.lines().any(|line| line.trim_start().starts_with(table));
    if ["[[stack]]", "[[ball]]", "[board]", "[camera]"].into_iter().any(has) {
        return Ok(Kind::Capture);
    }
    if ["[[sensor]]", "[[shape]]", "[render]"].into_iter().any(has) {
        return Ok(Kind::Scene);
    }
    if luminaire::format::detect(&bytes).is_some() {
        return Ok(Kind::Lamp);
    }
    let toml = place.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    Ok(if toml || brdf::format::detect(&bytes).is_some() { Kind::Material } else { Kind::Spectrum })
}

//! `brdf convert`: materials as MERL, ALTA or CSV files.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rayon::prelude::*;
use serde_json::json;

use super::load::{BandArgs, Loaded, Subject, load, on_bands, prepare};
use super::numbers::{Bins, Numbers, check_theta_above};
use super::settings;
use crate::brdf::Brdf;
use crate::brdf::format::alta::{self, Encoding};
use crate::brdf::format::convert::{Net, RGB_NM, bins, nodes, sampled};
use crate::brdf::format::{csv, merl};
use crate::brdf::table::{Channel, Error, Resolution, Table};
use crate::cli::notes::Notes;
use crate::cli::places::Places;
use crate::cli::{Failure, Talk};
use crate::finding::{Checked, Finding, Location};
use crate::report::envelope::{Envelope, Input};

/// The formats that are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Target {
    /// MERL `.binary`: three channels in bins of half and difference angles.
    Merl,
    /// ALTA, text.
    Alta,
    /// ALTA, binary.
    AltaBinary,
    /// CSV of points.
    Csv,
}

impl Target {
    fn of_name(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_lowercase().as_str() {
            "binary" => Some(Self::Merl),
            "alta" => Some(Self::Alta),
            "csv" => Some(Self::Csv),
            _ => None,
        }
    }

    /// The ending of its files.
    fn ending(self) -> &'static str {
        match self {
            Self::Merl => "binary",
            Self::Alta | Self::AltaBinary => "alta",
            Self::Csv => "csv",
        }
    }
}

/// Materials, the files to write, and where the materials are asked.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct ConvertArgs {
    /// Measured tables, descriptions such as 'ggx(alpha=0.1, medium=Au)', TOML files, or `-`.
    #[arg(required = true, value_name = "MATERIAL")]
    materials: Vec<String>,
    /// The file to write, a folder for many (`DIR/`), or `-`. An ending .binary (MERL), .alta or .csv says the format.
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// The format, where the name of the output does not say it.
    #[arg(long, value_name = "FORMAT", value_enum)]
    to: Option<Target>,
    #[command(flatten)]
    bands: BandArgs,
    /// Write the best guess where nothing was measured: into the bins of a MERL file, or at the angles asked for.
    #[arg(long)]
    fill: bool,
    /// Bins of a MERL file in θh, θd and φd; other programs expect 90x90x180.
    #[arg(long, value_name = "HxDxP")]
    resolution: Option<Bins>,
    /// A file with the bins, as `trade brdf --settings` writes it; --resolution goes before it.
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
    /// Angles of incidence of the points, degrees. A table is written at its own places unless one of these four is given; a
    /// model at 0:85:5.
    #[arg(long, value_name = "DEG")]
    theta_i: Option<Numbers>,
    /// Outgoing angles of the points; 0:85:5.
    #[arg(long, value_name = "DEG")]
    theta_o: Option<Numbers>,
    /// Azimuths between the two directions; 0:345:15.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    phi: Option<Numbers>,
    /// Azimuths of incidence, for anisotropic materials; 0:330:30.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    phi_i: Option<Numbers>,
    /// One JSON document: what was written where, and the findings.
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "Examples:
  photopic brdf convert paint.bsdf -o paint.csv
  photopic brdf convert paint.csv --wavelength 650,550,450 --fill -o paint.binary
  photopic brdf convert 'ggx(alpha=0.1, medium=Au)' -o gold.binary
  photopic brdf convert felt.bsdf paint.csv 'ggx(alpha=0.1, eta=1.5)' --to alta -o tables/
  photopic brdf convert gold.binary --theta-i 0:80:10 --theta-o 0:80:2 --phi 0,180 -o - --to csv";

/// A range of angles for those that are not given.
fn range(given: Option<&Numbers>, last: f64, step: f64) -> Vec<f64> {
    let count = (last / step) as u32;
    given.map_or_else(|| (0..=count).map(|i| step * f64::from(i)).collect(), |n| n.0.clone())
}

impl ConvertArgs {
    fn check(&self, target: Target) -> Result<(), Failure> {
        let refuse = |message: String| Err(Failure::Message(message));
        if target == Target::Merl && self.asks_for_a_net() {
            return refuse(
                "--theta-i, --theta-o, --phi: a MERL file has its own bins; expected ALTA or CSV".to_owned(),
            );
        }
        if target != Target::Merl && self.resolution.is_some() {
            return refuse(
                "--resolution: are the bins of a MERL file; expected angles for points: --theta-i".to_owned(),
            );
        }
        if target != Target::Merl && self.fill && !self.asks_for_a_net() {
            return refuse(
                "--fill: a table's own places are measured; expected a MERL file, or angles: --theta-i".to_owned(),
            );
        }
        for (name, list) in self.net_lists() {
            if name.starts_with("theta") {
                list.0.iter().try_for_each(|theta| check_theta_above(name, *theta))?;
            }
            if let Some(v) = list.0.iter().enumerate().find(|(i, v)| list.0[..*i].contains(v)).map(|(_, v)| v) {
                return refuse(format!("--{name} has {v} twice; expected each angle once"));
            }
        }
        Ok(())
    }

    fn net_lists(&self) -> impl Iterator<Item = (&'static str, &Numbers)> {
        let lists =
            [("theta-i", &self.theta_i), ("theta-o", &self.theta_o), ("phi", &self.phi), ("phi-i", &self.phi_i)];
        lists.into_iter().filter_map(|(name, list)| Some((name, list.as_ref()?)))
    }

    fn asks_for_a_net(&self) -> bool {
        self.net_lists().next().is_some()
    }

    fn net(&self) -> Net {
        Net {
            theta_i_deg: range(self.theta_i.as_ref(), 85.0, 5.0),
            theta_o_deg: range(self.theta_o.as_ref(), 85.0, 5.0),
            phi_deg: range(self.phi.as_ref(), 345.0, 15.0),
            phi_i_deg: range(self.phi_i.as_ref(), 330.0, 30.0),
        }
    }

    fn encode(&self, path: &str, target: Target, material: &Material<'_>) -> Result<Checked<Vec<u8>>, String> {
        let wrong = |e: Error| format!("{path}: {e}");
        let Material { brdf, bands, table } = *material;
        let encoding = match target {
            Target::Merl => {
                let resolution = self.resolution.map_or(Resolution::MERL, |b| b.0);
                let made = bins(brdf, bands, resolution, self.fill).map_err(|e| match e {
                    Error::Count { .. } => format!("{}; --channels or --wavelength choose", wrong(e)),
                    e => wrong(e),
                })?;
                return Ok(made.map(|table| merl::write(&table).expect("three channels")));
            }
            Target::Alta => Some(Encoding::Text),
            Target::AltaBinary => Some(Encoding::Binary),
            Target::Csv => None,
        };
        let Checked { value: points, mut findings } = match table {
            Some(table) if !self.asks_for_a_net() => nodes(table),
            _ => sampled(brdf, bands, &self.net(), self.fill),
        }
        .map_err(wrong)?;
        let written = match encoding {
            Some(encoding) => alta::write(&points, encoding),
            None => csv::write(&points).map(String::into_bytes),
        };
        findings.extend(written.findings);
        Ok(Checked { value: written.value, findings })
    }
}

/// What is written: a table has places of its own.
#[derive(Clone, Copy)]
struct Material<'a> {
    brdf: &'a dyn Brdf,
    bands: &'a [Channel],
    table: Option<&'a Table>,
}

pub(super) fn convert(mut arguments: ConvertArgs, talk: Talk) -> Result<(), Failure> {
    if let (None, Some(file)) = (arguments.resolution, &arguments.settings) {
        arguments.resolution = Some(settings::bins(file)?);
    }
    let (arguments, paths) = (&arguments, &arguments.materials);
    let target = arguments.to.or_else(|| Target::of_name(&arguments.output)).ok_or_else(|| {
        let output = arguments.output.display();
        Failure::Message(format!("{output}: expected a name ending in .binary, .alta or .csv, or --to FORMAT"))
    })?;
    arguments.check(target)?;
    if arguments.json && arguments.output == Path::new("-") {
        let message = "-: standard output holds the JSON document; expected the name of a file or folder for the table";
        return Err(Failure::Message(message.to_owned()));
    }
    let places = Places::of(paths, paths, &arguments.output, target.ending())?;
    places.prepare()?;
    let mut notes = Notes::new(paths, talk);
    let settings =
        json!({"format": target.to_possible_value().map(|v| v.get_name().to_owned()), "fill": arguments.fill});
    let mut envelope = Envelope::begin(Vec::new(), "brdf convert", &settings)?;
    let indices: Vec<usize> = (0..paths.len()).collect();
    for indices in indices.chunks(rayon::current_num_threads()) {
        let done: Vec<Done> = indices.par_iter().map(|i| one(arguments, &places, target, *i)).collect();
        for (done, path) in done.into_iter().zip(indices.iter().map(|i| &paths[*i])) {
            done.inputs.into_iter().for_each(|input| envelope.input(input));
            notes.print(&done.findings);
            done.findings.into_iter().for_each(|f| envelope.finding(f));
            match done.outcome {
                Ok(output) => envelope.result(&json!({"path": path, "output": output.display().to_string()}))?,
                Err(Failure::BrokenPipe) => return Err(Failure::BrokenPipe),
                Err(failure) => {
                    let message = failure.to_string();
                    notes.refuse(&message);
                    envelope.finding(Finding::error("B000", message).at(Location::default().in_file(path)));
                }
            }
        }
    }
    let document = envelope.end()?;
    if arguments.json {
        io::stdout().write_all(&document)?;
    }
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

/// What became of an input.
struct Done {
    /// The material's file and those of its spectra.
    inputs: Vec<Input>,
    findings: Vec<Finding>,
    /// Where the table was written.
    outcome: Result<PathBuf, Failure>,
}

/// Loads, encodes and writes one material.
fn one(arguments: &ConvertArgs, places: &Places, target: Target, index: usize) -> Done {
    let path = &arguments.materials[index];
    let Loaded { input, spectra, subject, .. } = load(path, arguments.bands.format);
    let inputs = std::iter::once(input).chain(spectra).collect();
    let mut findings = Vec::new();
    let write = || -> Result<PathBuf, Failure> {
        let place = places.main(index).map_err(Failure::Message)?;
        let read = subject.map_err(Failure::Message)?;
        findings.extend(read.findings);
        let written = encoded(arguments, path, target, &read.value).map_err(Failure::Message)?;
        findings.extend(written.findings.into_iter().map(|f| f.at(Location::default().in_file(path))));
        places.write(index, &[("", &written.value)])?;
        Ok(place.to_owned())
    };
    let outcome = write();
    Done { inputs, findings, outcome }
}

/// The bytes of a material's file.
fn encoded(arguments: &ConvertArgs, path: &str, target: Target, subject: &Subject) -> Result<Checked<Vec<u8>>, String> {
    let (described, table);
    let material = match subject {
        Subject::Described(_) => {
            described = prepare(path, subject, &arguments.bands, &RGB_NM)?;
            Material { brdf: described.brdf.as_ref(), bands: &described.bands, table: None }
        }
        Subject::Measured(file) => {
            table = on_bands(path, &file.table, &arguments.bands)?;
            Material { brdf: &table, bands: table.channels(), table: Some(&table) }
        }
    };
    if material.brdf.is_delta() {
        let words = "nothing but a Dirac lobe, which has no values; expected a material with values";
        return Err(format!("{path}: {words}"));
    }
    let mut written = arguments.encode(path, target, &material)?;
    if material.brdf.has_delta() {
        let words = "light leaves in a Dirac lobe, which has a reflectance and no value: it is not in the file";
        written.findings.push(Finding::warning("B006", words));
    }
    Ok(written)
}

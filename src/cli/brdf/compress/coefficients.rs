//! `brdf compress encode` and `decode`.

use std::io::Write;

use clap::Args;
use serde_json::json;

use super::input::load;
use super::{Form, Reconstructed, open_basis, table_of};
use crate::brdf::compress::Error;
use crate::brdf::compress::file::{BasisFile, Checksum};
use crate::brdf::table::{Channel, Known};
use crate::cli::brdf::load::{bytes_of, hex};
use crate::cli::brdf::numbers::Numbers;
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::report::brdf_compress::{self as report, Encoded};
use crate::report::envelope::{Envelope, Input};

/// A material, a basis and the form of the answer.
#[derive(Debug, Args)]
#[command(after_help = "Example: photopic brdf compress encode gold.binary --basis merl.basis -k 10 --csv -o gold.csv")]
pub(in crate::cli) struct EncodeArgs {
    /// The material: a MERL binary or another isotropic table, a description, a TOML file, or `-`.
    material: String,
    /// The basis, from `brdf compress train`.
    #[arg(short, long, value_name = "FILE")]
    basis: String,
    /// Coefficients per channel, the first of the basis; all of them where not given.
    #[arg(short = 'k', long, value_name = "K")]
    components: Option<usize>,
    /// Wavelengths, nm, of a material that is given by wavelength.
    #[arg(short, long, value_name = "NM", default_value = "650,550,450")]
    wavelength: Numbers,
    #[command(flatten)]
    form: Form,
}

pub(super) fn encode(arguments: &EncodeArgs, talk: Talk) -> Result<(), Failure> {
    let inputs = [arguments.material.clone(), arguments.basis.clone()];
    let mut sink = Sink::open(arguments.form.output.as_deref(), &inputs)?;
    let (file, checksum) = open_basis(&arguments.basis)?;
    let count = arguments.components.unwrap_or(file.basis.components());
    if !(1..=file.basis.components()).contains(&count) {
        let most = file.basis.components();
        return Err(Failure::Message(format!("-k is {count}; expected 1 to {most}, which the basis has")));
    }
    let notes = Notes::counting(1, talk);
    let settings = json!({"basis": arguments.basis, "components": count, "wavelengths_nm": arguments.wavelength.0});
    let mut envelope = Envelope::begin(Vec::new(), "brdf compress encode", &settings)?;
    let loaded = load(&arguments.material, file.grid.resolution(), &arguments.wavelength.0);
    loaded.inputs.into_iter().for_each(|input| envelope.input(input));
    let (table, mut findings) = loaded.table.map_err(Failure::Message)?;
    let failed = |e: Error| Failure::Message(format!("{}: {e}", arguments.material));
    let mut encoded = Encoded { channels: table.channels().to_vec(), coefficients: Vec::new(), rms_ln: Vec::new() };
    let mut lacking = 0;
    for channel in 0..table.channels().len() {
        let column = file.grid.column(&table, channel).map_err(failed)?;
        lacking = column.iter().filter(|v| v.is_nan()).count();
        let mut coefficients = file.basis.project(&column).map_err(failed)?;
        coefficients.truncate(count);
        let back = file.basis.reconstruct(&coefficients).map_err(failed)?;
        encoded.rms_ln.push(file.basis.distance(&back, &column).map_err(failed)?);
        encoded.coefficients.push(coefficients);
    }
    if lacking > 0 {
        let bins = file.grid.bins().len();
        let message = format!(
            "{lacking} of the basis's {bins} bins are not measured: the coefficients are the most probable ones"
        );
        findings.push(Finding::info("B302", message).at(Location::default().in_file(&arguments.material)));
    }
    notes.print(&findings);
    findings.into_iter().for_each(|f| envelope.finding(f));
    let mut object = encoded.json(&checksum);
    object.insert("path".to_owned(), arguments.material.clone().into());
    envelope.result(&object.into())?;
    let document = envelope.end()?;
    sink.write_all(&match (arguments.form.json, arguments.form.csv) {
        (true, _) => document,
        (_, true) => table_of(encoded.rows(&checksum)),
        _ => encoded.text(&arguments.material).into_bytes(),
    })?;
    sink.finish(true)
}

/// Coefficients, a basis, and where the table goes.
#[derive(Debug, Args)]
#[command(after_help = "Example: photopic brdf compress decode gold.csv --basis merl.basis -o gold.binary")]
pub(in crate::cli) struct DecodeArgs {
    /// The coefficients: the CSV of `brdf compress encode`, or `-`.
    coefficients: String,
    /// The basis that they belong to.
    #[arg(short, long, value_name = "FILE")]
    basis: String,
    #[command(flatten)]
    to: Reconstructed,
}

pub(super) fn decode(arguments: &DecodeArgs, talk: Talk) -> Result<(), Failure> {
    let path = &arguments.coefficients;
    let (file, checksum) = open_basis(&arguments.basis)?;
    let bytes = bytes_of(path)
        .map_err(|e| Failure::Message(format!("{path}: cannot be read: {e}; expected coefficients as CSV")))?;
    let encoded = parse(&bytes, &checksum).map_err(|message| Failure::Message(format!("{path}:{message}")))?;
    let input = Input { path: path.clone(), sha256: Some(hex(&bytes)) };
    let columns: Vec<Vec<f32>> = (encoded.coefficients.iter())
        .map(|c| file.basis.reconstruct(c))
        .collect::<Result<_, Error>>()
        .map_err(|e| Failure::Message(format!("{path}: {e}")))?;
    let known = vec![Known::Inferred; file.grid.bins().len()];
    let rebuilt =
        Rebuilt { command: "brdf compress decode", file: &file, checksum: &checksum, encoded, columns, known };
    rebuilt.finish(&arguments.to, input, &[path.clone(), arguments.basis.clone()], talk)
}

/// A reconstructed table before it is written.
pub(super) struct Rebuilt<'a> {
    pub command: &'static str,
    pub file: &'a BasisFile,
    pub checksum: &'a Checksum,
    pub encoded: Encoded,
    /// Values by channel, over the bins that take part.
    pub columns: Vec<Vec<f32>>,
    /// How each of those bins is known.
    pub known: Vec<Known>,
}

impl Rebuilt<'_> {
    /// Writes the files and reports.
    pub(super) fn finish(self, to: &Reconstructed, input: Input, paths: &[String], talk: Talk) -> Result<(), Failure> {
        let grid = &self.file.grid;
        let table = grid
            .table(self.encoded.channels.clone(), &self.columns)
            .map_err(|e| Failure::Message(format!("{}: {e}", input.path)))?;
        let mut known = vec![Known::Missing; grid.resolution().bins()];
        grid.bins().iter().zip(&self.known).for_each(|(bin, k)| known[*bin] = *k);
        to.write(&table, &known, paths)?;
        let counts = report::known(&known);
        let text = report::known_text(&to.output.to_string_lossy(), &counts);
        let mut envelope = Envelope::begin(Vec::new(), self.command, &json!({"basis": paths[1]}))?;
        let mut object = self.encoded.json(self.checksum);
        object.insert("path".to_owned(), input.path.clone().into());
        object.extend(counts);
        envelope.input(input);
        envelope.result(&object.into())?;
        let document = envelope.end()?;
        let mut sink = Sink::open(None, paths)?;
        if to.json {
            sink.write_all(&document)?;
        } else if !talk.quiet {
            sink.write_all(text.as_bytes())?;
        }
        sink.finish(true)
    }
}

/// Reads the CSV of coefficients; messages begin with line and column.
fn parse(bytes: &[u8], checksum: &Checksum) -> Result<Encoded, String> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let names = ["basis", "channel", "component", "coefficient"];
    let headers = reader.headers().map_err(|e| format!(" {e}"))?.clone();
    let mut at = [0; 4];
    for (place, name) in at.iter_mut().zip(names) {
        let found = headers.iter().position(|h| h == name);
        *place = found.ok_or_else(|| format!("1:1: found no column `{name}`; expected {}", names.join(", ")))?;
    }
    let mut encoded = Encoded { channels: Vec::new(), coefficients: Vec::new(), rms_ln: Vec::new() };
    for record in reader.records() {
        let record = record.map_err(|e| format!(" {e}"))?;
        let line = record.position().map_or(0, csv::Position::line);
        let cell = |i: usize| record.get(at[i]).unwrap_or("");
        let wrong = |i: usize, expected: &str| {
            Err(format!("{line}:{}: found `{}` for {}; expected {expected}", at[i] + 1, cell(i), names[i]))
        };
        if cell(0) != checksum.short() {
            return wrong(0, &format!("{}, the basis that was given", checksum.short()));
        }
        let channel = Channel::Named(cell(1).to_owned());
        if encoded.channels.last() != Some(&channel) {
            if encoded.channels.contains(&channel) {
                return wrong(1, "the coefficients of a channel one after another");
            }
            encoded.channels.push(channel);
            encoded.coefficients.push(Vec::new());
        }
        let Some(coefficients) = encoded.coefficients.last_mut() else { continue };
        if cell(2).parse() != Ok(coefficients.len() + 1) {
            return wrong(2, &format!("{}, as they are counted", coefficients.len() + 1));
        }
        match cell(3).parse::<f64>() {
            Ok(value) if value.is_finite() => coefficients.push(value),
            _ => return wrong(3, "a finite number"),
        }
    }
    if encoded.channels.is_empty() {
        return Err("1:1: found no rows; expected coefficients".to_owned());
    }
    Ok(encoded)
}

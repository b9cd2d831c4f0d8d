//! `brdf compress directions` and `infer`.

use std::io::Write;

use clap::Args;
use serde_json::json;

use super::coefficients::Rebuilt;
use super::{Form, Reconstructed, open_basis, table_of};
use crate::brdf::compress::Grid;
use crate::brdf::table::{Known, Points, Table};
use crate::cli::brdf::load::{Loaded, Subject, load};
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::geometry::direction::{phi, theta};
use crate::report::brdf_compress::{self as report, Encoded};
use crate::report::envelope::{Envelope, Input};

/// A basis, and how many directions.
#[derive(Debug, Args)]
#[command(after_help = "Example: photopic brdf compress directions --basis merl.basis -n 10 --csv -o measure.csv

Measure there, add the columns `channel` and `value` (a row for each channel), and give the file to `brdf compress infer`.")]
pub(in crate::cli) struct DirectionsArgs {
    /// The basis, from `brdf compress train`.
    #[arg(short, long, value_name = "FILE")]
    basis: String,
    /// Directions, at most as many as the basis has components.
    #[arg(short = 'n', long, value_name = "N", default_value_t = 20)]
    count: usize,
    #[command(flatten)]
    form: Form,
}

pub(super) fn directions(arguments: &DirectionsArgs, talk: Talk) -> Result<(), Failure> {
    let inputs = [arguments.basis.clone()];
    let mut sink = Sink::open(arguments.form.output.as_deref(), &inputs)?;
    let (file, checksum) = open_basis(&arguments.basis)?;
    if arguments.count == 0 {
        return Err(Failure::Message("-n is 0; expected at least 1 direction".to_owned()));
    }
    let chosen = file.basis.choose(arguments.count);
    let settings = json!({"count": arguments.count});
    let mut envelope = Envelope::begin(Vec::new(), "brdf compress directions", &settings)?;
    envelope.input(Input { path: arguments.basis.clone(), sha256: None });
    let mut findings = Vec::new();
    let place = || Location::default().in_file(&arguments.basis);
    if chosen.len() < arguments.count {
        let message = format!("{} directions, one for each component, instead of {}", chosen.len(), arguments.count);
        findings.push(Finding::warning("B303", message).at(place()));
    }
    if file.weighted {
        let message =
            "the basis was weighted for coefficients: directions are chosen better from one trained without --weighted";
        findings.push(Finding::warning("B304", message).at(place()));
    }
    Notes::counting(1, talk).print(&findings);
    findings.into_iter().for_each(|f| envelope.finding(f));
    envelope.result(&report::directions(&file.grid, &chosen, &checksum))?;
    let document = envelope.end()?;
    sink.write_all(&match (arguments.form.json, arguments.form.csv) {
        (true, _) => document,
        (_, true) => table_of(report::directions_rows(&file.grid, &chosen)),
        _ => report::directions_text(&file.grid, &chosen).into_bytes(),
    })?;
    sink.finish(true)
}

/// Values measured in a few directions, a basis, and where the table goes.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: photopic brdf compress infer measured.csv --basis merl.basis -o paint.binary --mask paint.mask"
)]
pub(in crate::cli) struct InferArgs {
    /// The measured values: a CSV with the columns theta_i_deg, phi_i_deg, theta_o_deg, phi_o_deg, channel and value (1/sr), or another
    /// list of points, or `-`. They keep their values in the table; all else is inferred.
    points: String,
    /// The basis, from `brdf compress train`.
    #[arg(short, long, value_name = "FILE")]
    basis: String,
    #[command(flatten)]
    to: Reconstructed,
}

pub(super) fn infer(arguments: &InferArgs, talk: Talk) -> Result<(), Failure> {
    let path = &arguments.points;
    let (file, checksum) = open_basis(&arguments.basis)?;
    let Loaded { input, subject, .. } = load(path, None);
    let read = subject.map_err(Failure::Message)?;
    Notes::counting(1, talk).print(&read.findings);
    let points = points(read.value)
        .map_err(|found| Failure::Message(format!("{path}: found {found}; expected a list of measured points")))?;
    let bins = bins(&points, &file.grid).map_err(|message| Failure::Message(format!("{path}: {message}")))?;
    let mut encoded = Encoded { channels: points.channels().to_vec(), coefficients: Vec::new(), rms_ln: Vec::new() };
    let (mut columns, mut known) = (Vec::new(), vec![Known::Inferred; file.grid.bins().len()]);
    for channel in 0..points.channels().len() {
        let measured: Vec<(usize, f64)> = bins.iter().zip(points.iter()).map(|(b, p)| (*b, p.2[channel])).collect();
        let inferred = file.basis.infer(&measured).map_err(|e| Failure::Message(format!("{path}: {e}")))?;
        encoded.coefficients.push(inferred.coefficients);
        columns.push(inferred.values);
        known = inferred.known;
    }
    let rebuilt = Rebuilt { command: "brdf compress infer", file: &file, checksum: &checksum, encoded, columns, known };
    rebuilt.finish(&arguments.to, input, &[path.clone(), arguments.basis.clone()], talk)
}

/// The points of a list, or what there is instead.
fn points(subject: Subject) -> Result<Points, String> {
    match subject {
        Subject::Measured(file) => match file.table {
            Table::Points(points) => Ok(points),
            _ => Err(format!("a {} table", file.format)),
        },
        Subject::Described(_) => Err("a model".to_owned()),
    }
}

/// The bin of each point.
fn bins(points: &Points, grid: &Grid) -> Result<Vec<usize>, String> {
    let mut out: Vec<usize> = Vec::with_capacity(points.len());
    for (number, (i, o, _)) in points.iter().enumerate() {
        let said = || {
            let turned = (phi(o) - phi(i)).to_degrees().rem_euclid(360.0);
            let (ti, to) = (theta(i).to_degrees(), theta(o).to_degrees());
            format!("found point {} at θi {ti:.3}°, θo {to:.3}°, φo − φi {turned:.3}°", number + 1)
        };
        let Some(bin) = grid.bin_of(i, o) else {
            return Err(format!("{}; expected a bin that the basis has: both directions above the horizon", said()));
        };
        if let Some(earlier) = out.iter().position(|b| *b == bin) {
            let message = format!("{}, in the same bin as point {}; expected one value per bin", said(), earlier + 1);
            return Err(message);
        }
        out.push(bin);
    }
    Ok(out)
}

//! `capture response`: from codes to exposure.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use nalgebra::{DMatrix, DVector};
use serde_json::json;

use super::photos::{Form, Given, Photos};
use crate::capture::response::{
    self, Consistency, Curve, Exposures, Sampling, check_order, consistency, debevec, monotone, robertson,
};
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::report::capture as report;

/// How the curve is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Method {
    /// Never decreasing, robust, with standard errors.
    Monotone,
    /// Debevec and Malik 1997, as OpenCV has it with λ = 10; may decrease.
    Debevec,
    /// Robertson et al. 2003.
    Robertson,
}

/// Photographs, method and the form of the answer.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  photopic capture response capture.toml
  photopic capture response memorial*.png --times shutter_times.txt --csv -o response.csv
  photopic capture response IMG_*.JPG --json                (times from EXIF)")]
pub(in crate::cli) struct ResponseArgs {
    #[command(flatten)]
    given: Given,
    /// How the curve is found.
    #[arg(long, value_enum, default_value = "monotone")]
    method: Method,
    /// About how many pixels of each stack are taken, on an even grid; 70 for debevec, as in OpenCV, otherwise 4000. Of those that tell
    /// something monotone uses at most 2000 per channel.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..))]
    pixels: Option<u32>,
    #[command(flatten)]
    form: Form,
    /// The curves as one table, which `capture merge --response` reads.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Offset of an exposure from the others, in ln, from which on it is named: a sixth of a stop.
const DISAGREES: f64 = 0.12;
/// λ of Debevec's method in OpenCV.
const LAMBDA: f64 = 10.0;
/// Rounds of Robertson's method in OpenCV.
const ROUNDS: usize = 30;

pub(super) fn response(a: &ResponseArgs, talk: Talk) -> Result<(), Failure> {
    let mut photos = Photos::open("capture response", &a.given, talk)?;
    let pixels = a.pixels.map(|p| p as usize);
    let (curves, agreement) = find(&mut photos, a.method, pixels)?;
    let channels = curves.len();
    for (c, curve) in curves.iter().enumerate().filter(|(_, c)| c.decreasing_steps() > 0) {
        let message = format!(
            "the curve of channel {} decreases at {} of 255 steps",
            report::channel_name(channels, c),
            curve.decreasing_steps()
        );
        photos.findings.push(Finding::warning("K003", message).hint("--method monotone never does"));
    }
    let method = a.method.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned());
    let settings = json!({"method": method, "pixels": pixels});
    let text = if a.csv { report::response_csv(&curves) } else { report::response_text(&curves, &agreement) };
    let result = report::response(&curves, &agreement);
    photos.print(&settings, &[result], &text, a.form.json, a.output.as_deref())
}

/// Reads all stacks and finds the response; exposures that cannot be read are left out.
pub(super) fn find(
    photos: &mut Photos,
    method: Method,
    pixels: Option<usize>,
) -> Result<(Vec<Curve>, Consistency), Failure> {
    let sampling = Sampling { pixels: pixels.unwrap_or(if method == Method::Debevec { 70 } else { 4000 }) };
    let stacks = samples(photos, sampling)?;
    let failed = |e: crate::capture::Error| Failure::Message(e.to_string());
    check_order(&stacks).map_err(failed)?;
    let curves = match method {
        Method::Monotone => monotone(&stacks),
        Method::Debevec => debevec(&stacks, LAMBDA),
        Method::Robertson => robertson(&stacks, ROUNDS),
    }
    .map_err(failed)?;
    let agreement = consistency(&stacks, &curves);
    disagreements(photos, &agreement);
    Ok((curves, agreement))
}

/// Names exposures that disagree with the others.
pub(super) fn disagreements(photos: &mut Photos, agreement: &Consistency) {
    for share in agreement.exposures.iter().filter(|s| s.samples > 0 && s.offset_ln.abs() > DISAGREES) {
        let message = format!(
            "disagrees with the other exposures of {} by a factor of {:.3}",
            share.stack,
            share.offset_ln.exp()
        );
        let hint = format!("is its time of {} s right, and was nothing moved?", share.time_s);
        let place = Location::default().of_item(&share.name);
        photos.findings.push(Finding::warning("K002", message).hint(hint).at(place));
    }
}

/// The samples of all stacks; exposures that cannot be read are left out.
pub(super) fn samples(photos: &mut Photos, sampling: Sampling) -> Result<Vec<Exposures>, Failure> {
    let described = photos.manifest.stack.clone();
    let mut stacks = Vec::new();
    for stack in &described {
        let mut samples = Exposures::new(&stack.name);
        for exposure in &stack.exposures {
            let taken = photos.exposure(exposure).and_then(|(photo, time_s)| {
                samples.add(&exposure.photo, time_s, &photo, sampling).map_err(|e| Failure::Message(e.to_string()))
            });
            if let Err(failure) = taken {
                photos.left_out(&exposure.photo, &failure);
            }
        }
        if samples.times_s.len() > 1 {
            stacks.push(samples);
        }
    }
    if stacks.is_empty() {
        photos.notes.print(&photos.findings);
        let message =
            "found no stack of two or more exposures that can be read; expected one at several exposure times";
        return Err(Failure::Message(message.to_owned()));
    }
    if stacks.iter().any(|s| s.channels != stacks[0].channels) {
        let message = "found grey and coloured stacks; expected one kind";
        return Err(Failure::Message(message.to_owned()));
    }
    Ok(stacks)
}

/// Reads the table that `capture response --csv` writes; of the covariances it has the diagonals.
pub(super) fn read_table(path: &str, bytes: &[u8]) -> Result<Vec<Curve>, Failure> {
    let wrong = |line: usize, found: String| {
        let expected = "a table of `capture response --csv`, code and ln g per channel for codes 0 to 255";
        Failure::Message(format!("{path}:{line}:1: found {found}; expected {expected}"))
    };
    let mut reader = csv::Reader::from_reader(bytes);
    let headers = reader.headers().map_err(|e| wrong(1, e.to_string()))?.clone();
    let columns: Vec<usize> = (0..headers.len()).filter(|i| headers[*i].starts_with("ln_g_")).collect();
    if !matches!(columns.len(), 1 | 3) {
        return Err(wrong(1, format!("{} columns `ln_g_…`", columns.len())));
    }
    let errors: Vec<Option<usize>> = columns
        .iter()
        .map(|c| headers.iter().position(|h| headers[*c].strip_prefix("ln_g_") == h.strip_prefix("standard_error_")))
        .collect();
    let mut curves = vec![Curve { ln_g: Vec::new(), covariance: None }; columns.len()];
    let mut variances = vec![Vec::new(); columns.len()];
    for (n, row) in reader.records().enumerate() {
        let row = row.map_err(|e| wrong(n + 2, e.to_string()))?;
        let number = |column: usize| {
            let cell = row.get(column).unwrap_or_default();
            let value = cell.trim().parse::<f64>().ok().filter(|v| v.is_finite());
            value.ok_or_else(|| wrong(n + 2, format!("`{cell}`")))
        };
        for (c, column) in columns.iter().enumerate() {
            curves[c].ln_g.push(number(*column)?);
            // Of methods without standard errors the cells are empty.
            if let Some(column) = errors[c].filter(|e| !row.get(*e).unwrap_or_default().trim().is_empty()) {
                variances[c].push(number(column)?.powi(2));
            }
        }
    }
    if curves[0].ln_g.len() != response::LEVELS {
        return Err(wrong(1, format!("{} rows", curves[0].ln_g.len())));
    }
    for (curve, variances) in curves.iter_mut().zip(variances).filter(|(_, v)| v.len() == response::LEVELS) {
        curve.covariance = Some(DMatrix::from_diagonal(&DVector::from_vec(variances)));
    }
    Ok(curves)
}

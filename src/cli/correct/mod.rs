//! `correct`: raw spectra into corrected ones, with a record of what was done.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::convert::{all, positive, range_nm};
use super::notes::Notes;
use super::output::{self, Sink};
use super::{Failure, Talk};
use crate::constants::SecondRadiation;
use crate::correction::description::{self, Description};
use crate::correction::{self, Plan, lines::Element};
use crate::finding::{Checked, Finding, Location};
use crate::report::correction::{self as report, Named};
use crate::report::envelope::{Envelope, Input};
use crate::spectrum::Quantity;
use crate::spectrum::format::Measured;

mod plan;

/// Arguments of `correct`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Corrections are made in this order: dark signal, integration time, stray light, wavelengths, bandwidth, smoothing, resampling. What was
done stands above the table and in the JSON. A corrected file beside a budget with `[[noise]] column = true` goes into
`convert --uncertainty`; where errors are correlated, --covariance writes what `[[noise]] covariance` takes.

Examples:
  photopic correct raw.csv --dark dark.csv --integration-time 0.2 -o lamp.csv
  photopic correct lamp.csv --fwhm 5 --resample 1 --interpolation cubic
  photopic correct raw.csv --line-lamp hgar.csv --element Hg --element Ar --degree 3
  photopic correct raw.csv --corrections instrument.toml --covariance cov.csv -o lamp.csv
  photopic correct --schema")]
pub(super) struct CorrectArgs {
    /// Spectra as an instrument gives them, one or several as columns; `-` for standard input.
    #[arg(required_unless_present = "schema", value_name = "FILE")]
    files: Vec<String>,
    /// What the spectra are of, where the file does not say: irradiance, radiance, flux, …, relative.
    #[arg(long, value_name = "QUANTITY")]
    quantity: Option<Quantity>,
    /// Corrections (TOML, docs/corrections.md); options given here go before it.
    #[arg(long, value_name = "FILE")]
    corrections: Option<PathBuf>,
    #[command(flatten)]
    asked: Asked,
    #[command(flatten)]
    output: Output,
}

/// Corrections.
#[derive(Debug, Args)]
#[command(next_help_heading = "Corrections")]
pub(super) struct Asked {
    /// A spectrum read without light, subtracted.
    #[arg(long, value_name = "FILE")]
    dark: Option<String>,
    /// Integration time (s) by which samples are divided.
    #[arg(long, value_name = "S", value_parser = positive)]
    integration_time: Option<f64>,
    /// A stray-light matrix (CSV: wavelengths in the first row and column).
    #[arg(long, value_name = "FILE")]
    stray_light: Option<String>,
    /// A lamp of known lines, read by the same instrument: fits the wavelengths.
    #[arg(long, value_name = "FILE", requires = "element")]
    line_lamp: Option<String>,
    /// An element in the lamp of known lines: Ne, Ar, Kr, Cd, Hg (repeatable).
    #[arg(long, value_name = "SYMBOL", requires = "line_lamp")]
    element: Vec<Element>,
    /// Degree of the polynomial of the wavelengths, 3 by default.
    #[arg(long, value_name = "N", requires = "line_lamp", value_parser = clap::value_parser!(u8).range(1..=6))]
    degree: Option<u8>,
    /// Full width (nm) at half maximum of a triangular slit, corrected for.
    #[arg(long, value_name = "NM", value_parser = positive)]
    fwhm: Option<f64>,
    /// How a bandwidth is corrected: by differences, or by iterations.
    #[arg(long, value_enum, requires = "fwhm")]
    method: Option<Method>,
    /// Savitzky-Golay smoothing: samples in the window, odd, and degree, such as 7,2.
    #[arg(long, value_name = "WINDOW,DEGREE", value_parser = window)]
    smooth: Option<(usize, usize)>,
    /// Resample to this step (nm).
    #[arg(long, value_name = "NM", value_parser = positive)]
    resample: Option<f64>,
    /// Range of --resample (nm); by default all multiples of the step inside the spectrum.
    #[arg(long, value_name = "LOW-HIGH", value_parser = range_nm, requires = "resample")]
    range: Option<(f64, f64)>,
    /// Interpolation of --resample.
    #[arg(long, value_enum, requires = "resample")]
    interpolation: Option<Interpolation>,
    /// An order-sorting filter holds second orders back from this wavelength (nm) on.
    #[arg(long, value_name = "NM", value_parser = positive)]
    order_filter: Option<f64>,
}

/// Output.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(super) struct Output {
    /// One JSON document instead of the corrected table.
    #[arg(long)]
    json: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write the covariance of the samples (one spectrum), for `[[noise]] covariance` of a budget.
    #[arg(long, value_name = "FILE")]
    covariance: Option<PathBuf>,
    /// Print the JSON schema of corrections.
    #[arg(long, conflicts_with_all = ["files", "corrections"])]
    schema: bool,
}

/// How a bandwidth is corrected.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub(super) enum Method {
    /// By differences, for a triangular slit (Stearns and Stearns 1988).
    Stearns,
    /// By iterations (Richardson 1972, Lucy 1974).
    RichardsonLucy,
}

/// Interpolations that carry errors exactly.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub(super) enum Interpolation {
    /// Straight lines.
    Linear,
    /// Sprague (CIE 167).
    Sprague,
    /// Natural cubic spline.
    Cubic,
}

fn window(text: &str) -> Result<(usize, usize), String> {
    let found = text.split_once(',').and_then(|(w, d)| Some((w.trim().parse().ok()?, d.trim().parse().ok()?)));
    found.ok_or_else(|| format!("`{text}`; expected an odd number of samples and a degree, such as 7,2"))
}

pub(super) fn run(arguments: &CorrectArgs, talk: Talk) -> Result<(), Failure> {
    if arguments.output.schema {
        return Ok(writeln!(std::io::stdout().lock(), "{:#}", description::schema())?);
    }
    let (description, folder) = match &arguments.corrections {
        None => (Description::default(), PathBuf::new()),
        Some(path) => (plan::read(path)?, path.parent().map(PathBuf::from).unwrap_or_default()),
    };
    let title = description.title.clone();
    let mut loaded = plan::Loader::new(folder);
    let plan = plan::build(&description, &arguments.asked, arguments.quantity, &mut loaded)?;
    let mut inputs: Vec<String> = arguments.files.clone();
    inputs.extend(loaded.inputs.iter().map(|i| i.path.clone()));
    inputs.extend(arguments.corrections.iter().map(|p| p.display().to_string()));
    if inputs.iter().filter(|i| *i == "-").count() > 1 {
        return Err(Failure::Message("`-` given twice; expected standard input once".into()));
    }
    if let (Some(a), Some(b)) = (&arguments.output.output, &arguments.output.covariance)
        && output::same_file(a, b)
    {
        let message = format!("{}: named for the spectrum and for its covariance; expected two files", a.display());
        return Err(Failure::Message(message));
    }
    let mut sink = Sink::open(arguments.output.output.as_deref(), &inputs)?;
    let mut notes = Notes::new(&inputs, talk);
    let settings = json!({"title": title, "files": loaded.inputs});
    let mut envelope = Envelope::begin(Vec::new(), "correct", &settings)?;
    let mut done: Vec<Named> = Vec::new();
    let mut sources = Vec::new();
    notes.print(&loaded.findings);
    loaded.findings.drain(..).for_each(|f| envelope.finding(f));
    for path in &arguments.files {
        let (measured, input, mut findings) = match all(path, arguments.quantity, SecondRadiation::default()) {
            Ok(read) => read,
            Err(refused) => {
                notes.refuse(&refused.message);
                envelope.finding(*refused.finding);
                continue;
            }
        };
        sources.push(input);
        let several = measured.len() > 1;
        for one in measured {
            let place = Location::default().in_file(path);
            let place = if several { place.of_item(&one.name) } else { place };
            match corrected(one, path, &plan, loaded.dark) {
                Ok(found) => {
                    findings.extend(found.findings.into_iter().map(|f| f.at(place.clone())));
                    done.push(found.value);
                }
                Err(why) => {
                    notes.refuse(&format!("{place}: {why}"));
                    envelope.finding(Finding::error("X000", why).at(place));
                }
            }
        }
        notes.print(&findings);
        findings.into_iter().for_each(|f| envelope.finding(f));
    }
    if let Some(path) = &arguments.output.covariance {
        let [one] = &done[..] else {
            let message = format!("--covariance: {} spectra; expected one", done.len());
            return Err(Failure::Message(message));
        };
        let Some(matrix) = one.corrected.covariance() else {
            let message = "--covariance: no uncertainty is known; expected a column u(…) in the file, or [noise]";
            return Err(Failure::Message(message.into()));
        };
        let text = report::covariance(one.corrected.spectrum.wavelengths_nm(), &matrix);
        output::write_file(path, text.as_bytes(), &inputs)?;
    }
    for one in &done {
        envelope.result(&report::json(one))?;
    }
    // A lamp's own reading may be what is corrected.
    let new: Vec<Input> = loaded.inputs.into_iter().filter(|i| !sources.contains(i)).collect();
    sources.extend(new);
    sources.iter().for_each(|i| envelope.input(i.clone()));
    let document = envelope.end()?;
    let alike =
        done.windows(2).all(|w| w[0].corrected.spectrum.wavelengths_nm() == w[1].corrected.spectrum.wavelengths_nm());
    if !arguments.output.json && !alike {
        let message =
            "the corrected spectra have different wavelengths; expected --resample, one file at a time, or --json";
        return Err(Failure::Message(message.into()));
    }
    // A JSON document without results still says why; a table without any says nothing.
    let table = match (arguments.output.json, done.is_empty()) {
        (true, _) => document,
        (false, true) => Vec::new(),
        (false, false) => report::csv(&done, &sources, title.as_deref()).into_bytes(),
    };
    sink.write_all(&table)?;
    sink.finish(!notes.failed || arguments.output.json)?;
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

/// One spectrum corrected; `dark` is what the dark spectrum is of.
fn corrected(one: Measured, path: &str, plan: &Plan, dark: Option<Quantity>) -> Result<Checked<Named>, String> {
    if let Some(dark) = dark.filter(|d| *d != one.quantity) {
        return Err(format!(
            "{}, and the dark spectrum {dark}; expected both of one quantity and unit (--quantity says it of both)",
            one.quantity
        ));
    }
    let found = correction::apply(&one.spectrum, one.standard.as_deref(), plan).map_err(|e| e.to_string())?;
    // Counts per second are no radiometric quantity any more.
    let quantity = if plan.integration_time.is_some() { Quantity::Relative } else { one.quantity };
    Ok(found.map(|corrected| Named { path: path.to_owned(), name: one.name, quantity, corrected }))
}

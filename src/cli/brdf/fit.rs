//! `brdf fit`: models fitted to measured tables and compared.

use std::io::Write;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::load::load_table;
use super::numbers::{Numbers, check_lobes};
use super::plot::format_of;
use super::settings;
use crate::brdf::description::template::Template;
use crate::brdf::fit::{self, Fit, Options, Samples, Scope, Selection};
use crate::brdf::table::Table;
use crate::cli::notes::Notes;
use crate::cli::output::{Sink, write_file};
use crate::cli::{Failure, Talk};
use crate::finding::{Checked, Finding, Location};
use crate::plot::brdf_fit::{lobes_panel, scatter_panel};
use crate::plot::{Panel, draw};
use crate::report::brdf_fit as report;
use crate::report::envelope::Envelope;

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Metric {
    /// Cosine-weighted RMS difference, 1/sr.
    Cosine,
    /// RMS difference of ln(f cosθ + ε).
    Log,
    /// RMS of the difference over the larger of the value and ε.
    Relative,
    /// Largest cosine-weighted difference, approached by powers up to 64; no standard errors.
    Largest,
}

/// How much a place counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Weights {
    /// By its part of both hemispheres; scattered points alike.
    SolidAngle,
    /// All alike.
    Equal,
}

/// Tables, models, how to fit and the form of the answer.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct FitArgs {
    /// Measured tables of any format that `brdf info` reads; `-` is standard input.
    #[arg(required = true, value_name = "DATA")]
    data: Vec<String>,
    /// A model with open parameters; several are compared.
    ///
    /// `?` is open, `?0.2` open from 0.2 on; a model without parentheses has all of its numbers open, inside parentheses what has a
    /// default keeps it. `lambert + ggx`, `lambert(reflectance=?) + ?*ward(ks=1, alpha=?)`, `ggx(eta=?1.5)`.
    #[arg(short, long = "model", required_unless_present = "settings", value_name = "MODEL")]
    models: Vec<Template>,
    /// A file with a model more, as `trade brdf --settings` writes it.
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
    /// What is minimised; all measures are reported.
    #[arg(long, value_enum, default_value = "cosine")]
    metric: Metric,
    /// ε of the logarithmic and the relative measure, 1/sr.
    #[arg(long, value_name = "X", default_value_t = Options::default().epsilon)]
    epsilon: f64,
    /// How much each place counts.
    #[arg(long, value_enum, default_value = "solid-angle")]
    weights: Weights,
    /// Largest angle to the normal of either direction, degrees: near the horizon measurements are poor.
    #[arg(long, value_name = "DEG", default_value_t = 90.0)]
    max_theta: f64,
    /// Bands to fit, counted from 1; all by default.
    #[arg(long, value_name = "N", value_delimiter = ',')]
    band: Vec<usize>,
    /// Parameters with one value for all bands: `f0`, `ggx.f0`, `2.f0` for the second model of a sum, `all`.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    shared: Vec<String>,
    /// Parameters with a value per band, where others are shared by `all`.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    per_band: Vec<String>,
    /// Number of starts.
    #[arg(long, value_name = "N", default_value_t = Options::default().starts)]
    starts: usize,
    /// Fit to so many places only, drawn evenly from the table: faster, with standard errors larger by the root of the part.
    #[arg(long, value_name = "N")]
    subsample: Option<usize>,
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One table, a row per fit.
    #[arg(long)]
    csv: bool,
    /// Write the best model as a material file, which the other verbs read.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draw data and best model: a name ending in .svg or .png.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Angles of incidence of the lobes drawn, degrees.
    #[arg(long, value_name = "DEG", default_value = "15,45,70")]
    theta_i: Numbers,
}

const EXAMPLES: &str = "Examples:
  photopic brdf fit gold.binary --model ggx --max-theta 80
  photopic brdf fit paint.binary -m 'lambert + ggx' -m 'lambert + beckmann' -m ward --shared f0 --csv
  photopic brdf fit points.csv -m 'lambert + ?*ward(ks=1)' --metric log -o paint.toml --plot paint.svg
  photopic brdf eval paint.toml";

impl FitArgs {
    fn options(&self) -> Options {
        let metric = match self.metric {
            Metric::Cosine => fit::Metric::Cosine,
            Metric::Log => fit::Metric::Log,
            Metric::Relative => fit::Metric::Relative,
            Metric::Largest => fit::Metric::Largest,
        };
        Options {
            metric,
            epsilon: self.epsilon,
            scope: Scope { shared: self.shared.clone(), per_band: self.per_band.clone() },
            starts: self.starts,
            places: self.subsample,
            ..Options::default()
        }
    }

    fn selection(&self) -> Selection {
        let weighting = match self.weights {
            Weights::SolidAngle => fit::Weighting::SolidAngle,
            Weights::Equal => fit::Weighting::Equal,
        };
        let bands = (!self.band.is_empty()).then(|| self.band.iter().map(|b| b.saturating_sub(1)).collect());
        Selection { max_theta_deg: self.max_theta, bands, weighting }
    }

    fn check(&self) -> Result<(), Failure> {
        let refuse = |message: String| Err(Failure::Message(message));
        if !(self.epsilon > 0.0 && self.epsilon.is_finite()) {
            return refuse(format!("--epsilon is {}; expected a number above 0", self.epsilon));
        }
        if !(self.max_theta > 0.0 && self.max_theta <= 90.0) {
            return refuse(format!("--max-theta is {}; expected above 0 to 90 degrees", self.max_theta));
        }
        if self.starts == 0 || self.subsample == Some(0) || self.band.contains(&0) {
            return refuse("found 0 for --starts, --subsample or --band; expected 1 or more".to_owned());
        }
        if self.data.len() > 1 && (self.output.is_some() || self.plot.is_some()) {
            return refuse(format!("{} tables; expected one with -o or --plot", self.data.len()));
        }
        check_lobes(&self.theta_i)
    }
}

pub(super) fn fit(mut arguments: FitArgs, talk: Talk) -> Result<(), Failure> {
    if let Some(file) = &arguments.settings {
        arguments.models.push(settings::model(file)?);
    }
    let arguments = &arguments;
    arguments.check()?;
    let picture = arguments.plot.as_deref().map(|p| format_of("--plot", p)).transpose()?;
    let (options, selection) = (arguments.options(), arguments.selection());
    let mut sink = Sink::open(None, &arguments.data)?;
    let mut envelope = Envelope::begin(Vec::new(), "brdf fit", &report::settings(&options, &selection))?;
    let mut notes = Notes::new(&arguments.data, talk);
    let mut table_out = csv::WriterBuilder::new().terminator(csv::Terminator::Any(b'\n')).from_writer(Vec::new());
    let wrong = |e: csv::Error| Failure::Message(e.to_string());
    table_out.write_record(report::COLUMNS).map_err(wrong)?;
    let mut plain = String::new();
    for path in &arguments.data {
        let (input, table) = load_table(path);
        envelope.input(input);
        let place = || Location::default().in_file(path);
        let samples = table.and_then(|Checked { value: table, findings }| {
            let samples = Samples::new(&table, &selection).map_err(|e| format!("{path}: {e}"))?;
            Ok((table, findings, samples))
        });
        let (table, mut findings, samples) = match samples {
            Ok(found) => found,
            Err(message) => {
                notes.refuse(&message);
                envelope.finding(Finding::error("B000", message).at(place()));
                continue;
            }
        };
        let mut fits: Vec<Fit> = Vec::new();
        for template in &arguments.models {
            let scope = options.scope.of(template, &arguments.models);
            match fit::fit(template, &samples, &Options { scope, ..options.clone() }) {
                Ok(fit) => fits.push(fit),
                Err(error) => {
                    let message = format!("{path}: {template}: {error}");
                    notes.refuse(&message);
                    envelope.finding(Finding::error("B000", message).at(place()));
                }
            }
        }
        let comparison = fit::compare(&fits.iter().collect::<Vec<_>>());
        findings.extend(report::findings(&samples, &fits, comparison.as_ref(), &options));
        let findings: Vec<Finding> = findings.into_iter().map(|f| f.at(place())).collect();
        notes.print(&findings);
        findings.into_iter().for_each(|f| envelope.finding(f));
        if fits.is_empty() {
            continue;
        }
        let answer =
            report::Answer { path, samples: &samples, fits: &fits, comparison: comparison.as_ref(), options: &options };
        if arguments.json {
            envelope.result(&report::object(&answer).into())?;
        } else if arguments.csv {
            report::rows(&answer).iter().try_for_each(|r| table_out.write_record(r)).map_err(wrong)?;
        } else {
            plain.push_str(&report::text(&answer));
        }
        let best = &fits[report::best(&answer)];
        if let Some(output) = &arguments.output {
            write_file(output, report::material_file(path, best, &options).as_bytes(), &arguments.data)?;
        }
        if let (Some(output), Some(format)) = (&arguments.plot, picture) {
            let panels = panels(&table, &samples, best, arguments);
            let bytes = draw(&panels, None, format).map_err(|e| Failure::Message(e.to_string()))?;
            write_file(output, &bytes, &arguments.data)?;
        }
    }
    let document = envelope.end()?;
    let table_out = table_out.into_inner().map_err(|e| Failure::Message(e.to_string()))?;
    sink.write_all(match (arguments.json, arguments.csv) {
        (true, _) => &document,
        (_, true) => &table_out,
        _ => plain.as_bytes(),
    })?;
    sink.finish(true)?;
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

/// Data against the model, of the middle band.
fn panels(table: &Table, samples: &Samples, best: &Fit, arguments: &FitArgs) -> Vec<Panel> {
    let band = samples.channels().len() / 2;
    let in_table = arguments.band.get(band).map_or(band, |b| b - 1);
    let title = format!("{}, {}", best.template, samples.channels()[band]);
    vec![
        lobes_panel(table, in_table, best.brdf.as_ref(), band, &arguments.theta_i.0, title).into(),
        scatter_panel(samples, best.brdf.as_ref(), band).into(),
    ]
}

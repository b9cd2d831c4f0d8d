//! `convert`: spectra in, figures out; many inputs in parallel, reported in the order given.

use std::io::Write;
use std::path::Path;

use indicatif::ProgressBar;
use rayon::prelude::*;
use serde_json::{Map, Value, json};

use self::input::{Checksum, Counted, Item, Loaded, Said};
use super::notes::Notes;
use super::output::{self, Sink};
use super::writer::{Writer, csv_row};
use super::{Failure, Talk};
use crate::conversion::{Conversion, Converter};
use crate::finding::{Checked, Finding, Location};
use crate::photometry::transfer;
use crate::report::envelope::{Envelope, Input};
use crate::report::{conversion as json_report, csv as csv_report, text, uncertainty as uncertainty_report};
use crate::spectrum::format::{Measured, Printed, RowStream};
use crate::spectrum::{Quantity, Spectrum};
use crate::uncertainty::budget::Budget;
use crate::uncertainty::{self, Uncertainty};

mod args;
pub(super) mod budget;
mod input;
mod measures;
mod picture;
mod settings;
mod stream;

pub(super) use args::{ConvertArgs, RuleArg, positive};
use input::Refused;
pub(super) use input::{Single, all, single};
pub(super) use measures::{length, range_nm};
pub(super) use picture::format_of;

/// Inputs opened and converted at a time.
const INPUTS_AT_ONCE: usize = 64;

/// Everything a conversion needs that does not change during a run.
struct Job<'a> {
    arguments: &'a ConvertArgs,
    converter: Converter,
    budget: Option<Budget>,
    table: csv_report::Table,
    form: Form,
}

impl Job<'_> {
    /// Whether a finding of a reader still holds: of negative samples the conversion says more, with their effect; that a
    /// spectrum is relative is settled by a level, and wanted of a reflectance.
    fn tells(&self, finding: &Finding) -> bool {
        let settings = self.converter.settings();
        let ratios_do = settings.level.is_some() || settings.illuminant.is_some();
        finding.code != "S005" && !(ratios_do && matches!(finding.code, "S010" | "P001"))
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Text,
    Json,
    Csv,
}

/// The figures of a spectrum, and what they are worth.
struct Converted {
    conversion: Conversion,
    uncertainty: Option<Uncertainty>,
}

/// One converted spectrum, ready to be written, and what was noticed.
struct Done {
    bytes: Vec<u8>,
    findings: Vec<Finding>,
    drawn: Option<picture::Kept>,
}

pub(super) fn run(mut arguments: ConvertArgs, talk: Talk) -> Result<(), Failure> {
    if arguments.uncertainty.budget_schema {
        return Ok(writeln!(std::io::stdout().lock(), "{:#}", crate::uncertainty::budget::schema())?);
    }
    if let Some(path) = arguments.integration.settings.clone() {
        settings::apply(&path, &mut arguments.integration)?;
    }
    let settings = arguments.settings()?;
    let budget = arguments.uncertainty.budget.as_deref().map(budget::read).transpose()?;
    settings.geometry.check().map_err(|e| Failure::Message(e.to_string()))?;
    if arguments.files.iter().filter(|f| *f == "-").count() > 1 {
        return Err(Failure::Message("`-` given twice; expected standard input once".into()));
    }
    let plot = arguments.output.plot.as_deref().map(picture::format_of).transpose()?;
    let budget_plot = arguments.uncertainty.budget_plot.as_deref().map(picture::format_of).transpose()?;
    let form = match (arguments.output.json, arguments.output.csv) {
        (true, _) => Form::Json,
        (_, true) => Form::Csv,
        _ => Form::Text,
    };
    let table = csv_report::Table::new(
        settings.groups,
        settings.mesopic_adaptation.is_some(),
        settings.illuminant.is_some(),
        budget.is_some(),
    );
    let settings_json = json_report::settings(&settings);
    let job = Job { arguments: &arguments, converter: Converter::new(settings), budget, table, form };
    if let (Some(results), Some(picture)) = (&arguments.output.output, &arguments.output.plot)
        && output::same_file(results, picture)
    {
        let message = format!("{}: named for the results and for the picture; expected two files", picture.display());
        return Err(Failure::Message(message));
    }
    let mut sink = Sink::open(arguments.output.output.as_deref(), &arguments.files)?;
    let mut writer = match form {
        Form::Json => Writer::json(Envelope::begin(&mut sink, "convert", &settings_json)?),
        Form::Csv => {
            sink.write_all(&csv_row(job.table.header()))?;
            Writer::plain(&mut sink)
        }
        Form::Text => Writer::plain(&mut sink),
    };
    let mut notes = Notes::new(&arguments.files, talk);
    let mut kept = Vec::new();
    let reports = arguments.output.report.is_some();
    let (mut read, mut noticed) = (Vec::new(), Vec::new());
    for paths in arguments.files.chunks(INPUTS_AT_ONCE) {
        let mut opened: Vec<Result<Opened, Refused>> = Vec::with_capacity(paths.len());
        paths.par_iter().map(|path| open(&job, path, &notes.progress)).collect_into_vec(&mut opened);
        for (path, opened) in paths.iter().zip(opened) {
            match opened {
                Err(refused) => {
                    notes.refuse(&refused.message);
                    writer.finding(*refused.finding);
                    writer.input(Input { path: path.clone(), sha256: None });
                }
                Ok(Opened::Done(done, input, findings)) => {
                    let mut all = findings;
                    for one in done {
                        match one {
                            Ok(one) => {
                                writer.result(&one.bytes)?;
                                all.extend(one.findings);
                                kept.extend(one.drawn);
                            }
                            Err(refused) => {
                                notes.refuse(&refused.message);
                                writer.finding(*refused.finding);
                            }
                        }
                    }
                    notes.print(&all);
                    if reports {
                        noticed.extend(all.iter().cloned());
                        read.push(input.clone());
                    }
                    all.into_iter().for_each(|f| writer.finding(f));
                    writer.input(input);
                }
                Ok(Opened::Stream(stream, checksum)) => {
                    let found = stream::convert_stream(&job, path, *stream, &mut writer, &mut notes)?;
                    found.into_iter().for_each(|f| writer.finding(f));
                    writer.input(checksum.input(path));
                }
            }
        }
    }
    notes.progress.finish_and_clear();
    let written = writer.end()?;
    // A JSON document without results still says why; a table or a text without any says nothing.
    sink.finish(written > 0 || job.form == Form::Json)?;
    if let (Some(path), Some(format)) = (&arguments.output.plot, plot) {
        let kind = (arguments.output.plot_kind, arguments.output.plot_tolerances);
        let picture = picture::draw(&kept, job.converter.settings(), kind, format)?;
        output::write_file(path, &picture, &arguments.files)?;
    }
    if let Some(path) = &arguments.output.report {
        let light = arguments.colour.illuminant.as_deref().map(Path::new).filter(|path| path.exists());
        for path in light.into_iter().chain(arguments.uncertainty.budget.as_deref()) {
            read.push(budget::input(path)?);
        }
        let page = picture::page(&kept, job.converter.settings(), &settings_json, &read, &noticed)?;
        output::write_file(path, page.html().as_bytes(), &arguments.files)?;
    }
    if let (Some(path), Some(format)) = (&arguments.uncertainty.budget_plot, budget_plot) {
        output::write_file(path, &picture::draw_budget(&kept, format)?, &arguments.files)?;
    }
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

/// An input whose spectra in memory are converted, or a stream still to be read.
enum Opened {
    Done(Vec<Result<Done, Refused>>, Input, Vec<Finding>),
    Stream(Box<RowStream<Counted>>, Checksum),
}

fn open(job: &Job<'_>, path: &str, progress: &ProgressBar) -> Result<Opened, Refused> {
    let reading = &job.arguments.reading;
    let said = Said { quantity: reading.quantity, unit: reading.unit.as_ref() };
    let options = job.arguments.read_options();
    let c2 = job.converter.settings().c2;
    match input::open(path, &options, said, c2, progress)? {
        Loaded::Stream(stream, checksum) => Ok(Opened::Stream(stream, checksum)),
        Loaded::Spectra(items, input, findings) => {
            let several = items.len() > 1;
            let (chosen, missing) = select(path, items, &reading.select);
            let mut done: Vec<Result<Done, Refused>> =
                chosen.par_iter().map(|item| item_done(job, path, item, several)).collect();
            done.extend(missing.map(Err));
            let findings = findings.into_iter().filter(|f| job.tells(f)).map(|f| in_file(f, path)).collect();
            Ok(Opened::Done(done, input, findings))
        }
    }
}

/// The spectra asked for by name, and a word on each name that is not there.
fn select(path: &str, items: Vec<Item>, names: &[String]) -> (Vec<Item>, Option<Refused>) {
    let known: Vec<String> = items.iter().map(|i| i.measured.name.clone()).collect();
    let missing: Vec<&str> =
        names.iter().filter(|n| !known.iter().any(|k| same_name(k, n))).map(String::as_str).collect();
    let refused = (!missing.is_empty()).then(|| {
        let some: Vec<&str> = known.iter().take(12).map(String::as_str).collect();
        let more = if known.len() > some.len() { ", …" } else { "" };
        let message = format!("no spectrum named {}; expected one of {}{more}", missing.join(" or "), some.join(", "));
        Refused::plain(path, &message)
    });
    (items.into_iter().filter(|i| wanted(&i.measured.name, names)).collect(), refused)
}

fn same_name(a: &str, b: &str) -> bool {
    a.to_lowercase() == b.to_lowercase()
}

fn wanted(name: &str, names: &[String]) -> bool {
    names.is_empty() || names.iter().any(|n| same_name(n, name))
}

fn in_file(mut finding: Finding, path: &str) -> Finding {
    finding.location.path = Some(path.to_owned());
    finding
}

fn item_done(job: &Job<'_>, path: &str, item: &Item, several: bool) -> Result<Done, Refused> {
    let Measured { name, quantity, spectrum, standard } = &item.measured;
    let heading = if several { format!("{path} [{name}]") } else { path.to_owned() };
    let place = Location::default().in_file(path);
    let place = if several { place.of_item(name) } else { place };
    let refuse = |message: &str| Refused {
        message: format!("{heading}: {message}"),
        finding: Box::new(Finding::error("P000", message).at(place.clone())),
    };
    let Checked { value: Converted { conversion: value, uncertainty }, mut findings } =
        convert(job, name, *quantity, (spectrum, standard.as_deref())).map_err(|m| refuse(&m))?;
    // The steps of a tabulated illuminant are its definition, not a coarse measurement of it.
    findings.retain(|f| !(item.defined && f.code == "P003"));
    for finding in &mut findings {
        finding.location = place.clone();
    }
    let bytes = render(job, path, &heading, (&value, uncertainty.as_ref()), &item.printed);
    let reports = job.arguments.output.report.is_some();
    let wanted = reports || job.arguments.output.plot.is_some() || job.arguments.uncertainty.budget_plot.is_some();
    let drawn = wanted.then(|| {
        // A column's header says less than the file's name, where the file holds nothing else.
        let file = std::path::Path::new(path).file_stem().map_or(path.into(), |s| s.to_string_lossy());
        let title = if several { name.clone() } else { file.into_owned() };
        let result =
            if reports { object(job, path, (&value, uncertainty.as_ref()), &item.printed).0 } else { Map::new() };
        picture::Kept { name: title, conversion: value, spectrum: spectrum.clone(), uncertainty, result }
    });
    Ok(Done { bytes, findings, drawn })
}

/// Converts, and refuses quantities that were asked for and do not follow.
fn convert(
    job: &Job<'_>,
    name: &str,
    quantity: Quantity,
    (spectrum, standard): (&Spectrum, Option<&[f64]>),
) -> Result<Checked<Converted>, String> {
    let mut out = job.converter.convert(name, quantity, spectrum).map_err(|e| e.to_string())?;
    for wanted in &job.arguments.geometry.to {
        if out.value.absolute.iter().all(|f| f.quantity != *wanted) {
            let from = out.value.quantity;
            let what = if from == Quantity::Relative { "a relative spectrum" } else { from.word() };
            return Err(format!(
                "{what} does not give {wanted} by itself; expected the geometry that connects them: {}",
                transfer::what_connects(from, *wanted)
            ));
        }
    }
    let uncertainty = match &job.budget {
        None => None,
        Some(budget) => {
            let budget = budget.with_column(spectrum.grid(), standard);
            let found =
                uncertainty::evaluate(&job.converter, &budget, quantity, spectrum).map_err(|e| e.to_string())?;
            out.findings.extend(found.findings);
            Some(found.value)
        }
    };
    Ok(out.map(|conversion| Converted { conversion, uncertainty }))
}

/// The object in `results[]`, and what the instrument printed beside ours.
fn object(
    job: &Job<'_>,
    path: &str,
    (c, uncertainty): (&Conversion, Option<&Uncertainty>),
    printed: &[Printed],
) -> (Map<String, Value>, Vec<Value>) {
    let mut object = Map::new();
    object.insert("path".into(), path.into());
    object.extend(json_report::json(c, job.converter.settings()));
    object.extend(uncertainty.map(|u| uncertainty_report::json(u, c)).unwrap_or_default());
    let compared = json_report::instrument(&object, printed);
    if !compared.is_empty() {
        object.insert("instrument".into(), json!(compared));
    }
    (object, compared)
}

fn render(
    job: &Job<'_>,
    path: &str,
    heading: &str,
    (c, uncertainty): (&Conversion, Option<&Uncertainty>),
    printed: &[Printed],
) -> Vec<u8> {
    let settings = job.converter.settings();
    let uncertain = uncertainty.filter(|_| job.form == Form::Text).map(|u| uncertainty_report::text(u, c));
    if job.form == Form::Text && printed.is_empty() {
        return (text::conversion(heading, c, settings) + &uncertain.unwrap_or_default()).into_bytes();
    }
    let (object, compared) = object(job, path, (c, uncertainty), printed);
    match job.form {
        Form::Text => {
            let mut out = text::conversion(heading, c, settings);
            out.push_str(&text::instrument(&compared));
            out.push_str(&uncertain.unwrap_or_default());
            out.into_bytes()
        }
        Form::Json => serde_json::to_vec(&Value::Object(object)).unwrap_or_default(),
        Form::Csv => csv_row(&job.table.row(&object)),
    }
}

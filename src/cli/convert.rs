//! `convert`: spectra in, figures out; many inputs in parallel, reported in the order given.

use std::io::{self, Write};

use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use serde_json::{Map, Value, json};

use super::convert_args::ConvertArgs;
use super::input::{self, Checksum, Counted, Item, Loaded, Refused, Said};
use super::output::{self, Sink};
use super::{Failure, Talk, convert_plot};
use crate::conversion::{Conversion, Converter};
use crate::finding::{Checked, Finding, Location, Severity};
use crate::photometry::transfer;
use crate::report::envelope::Envelope;
use crate::report::{conversion as json_report, csv as csv_report, text};
use crate::spectrum::format::{Measured, Printed, Row, RowStream, Scale};
use crate::spectrum::{Quantity, Spectrum};

/// Inputs opened and converted at a time.
const INPUTS_AT_ONCE: usize = 64;
/// Rows of a stream converted at a time: what memory holds of it.
const ROWS_AT_ONCE: usize = 2048;
/// From this many bytes of input a progress bar is worth its place.
const LONG_BYTES: u64 = 8 << 20;
/// Findings of one code printed per input before the rest is counted.
const PRINTED_PER_CODE: usize = 3;
/// Rows that cannot be read, reported per input before the rest is counted.
const ERRORS_PER_INPUT: usize = 20;

/// Everything a conversion needs that does not change during a run.
struct Job<'a> {
    arguments: &'a ConvertArgs,
    converter: Converter,
    table: csv_report::Table,
    form: Form,
}

impl Job<'_> {
    /// Whether a finding of a reader still holds: of negative samples the conversion says more, with their effect; that a
    /// spectrum is relative is settled by a level.
    fn tells(&self, finding: &Finding) -> bool {
        finding.code != "S005"
            && !(self.converter.settings().level.is_some() && matches!(finding.code, "S010" | "P001"))
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Text,
    Json,
    Csv,
}

/// One converted spectrum, ready to be written, and what was noticed.
struct Done {
    bytes: Vec<u8>,
    findings: Vec<Finding>,
    drawn: Option<convert_plot::Kept>,
}

pub(super) fn run(arguments: ConvertArgs, talk: Talk) -> Result<(), Failure> {
    let settings = arguments.settings();
    settings.geometry.check().map_err(|e| Failure::Message(e.to_string()))?;
    if arguments.files.iter().filter(|f| *f == "-").count() > 1 {
        return Err(Failure::Message("`-` given twice; expected standard input once".into()));
    }
    let plot = arguments.output.plot.as_deref().map(convert_plot::format_of).transpose()?;
    let form = match (arguments.output.json, arguments.output.csv) {
        (true, _) => Form::Json,
        (_, true) => Form::Csv,
        _ => Form::Text,
    };
    let table = csv_report::Table::new(settings.groups, settings.mesopic_adaptation.is_some());
    let settings_json = json_report::settings(&settings);
    let job = Job { arguments: &arguments, converter: Converter::new(settings), table, form };
    let mut sink = Sink::open(arguments.output.output.as_deref(), &arguments.files)?;
    let mut writer = match form {
        Form::Json => Writer::Json(Envelope::begin(&mut sink, "convert", &settings_json)?),
        Form::Csv => {
            sink.write_all(&csv_row(job.table.header()))?;
            Writer::Plain(&mut sink, false)
        }
        Form::Text => Writer::Plain(&mut sink, false),
    };
    let mut notes = Notes { talk, failed: false, progress: progress(&arguments.files, talk) };
    let mut kept = Vec::new();
    for paths in arguments.files.chunks(INPUTS_AT_ONCE) {
        let mut opened: Vec<Result<Opened, Refused>> = Vec::with_capacity(paths.len());
        paths.par_iter().map(|path| open(&job, path, &notes.progress)).collect_into_vec(&mut opened);
        for (path, opened) in paths.iter().zip(opened) {
            match opened {
                Err(refused) => {
                    notes.refuse(&refused.message);
                    writer.finding(refused.finding);
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
                                writer.finding(refused.finding);
                            }
                        }
                    }
                    notes.print(&all);
                    all.into_iter().for_each(|f| writer.finding(f));
                    writer.input(input);
                }
                Ok(Opened::Stream(stream, checksum)) => {
                    let found = convert_stream(&job, path, *stream, &mut writer, &mut notes)?;
                    found.into_iter().for_each(|f| writer.finding(f));
                    writer.input(checksum.input(path));
                }
            }
        }
    }
    notes.progress.finish_and_clear();
    writer.end()?;
    sink.finish()?;
    if let (Some(path), Some(format)) = (&arguments.output.plot, plot) {
        let picture = convert_plot::draw(&kept, job.converter.settings(), arguments.output.plot_kind, format)?;
        output::write_file(path, &picture, &arguments.files)?;
    }
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

/// An input whose spectra in memory are converted, or a stream still to be read.
enum Opened {
    Done(Vec<Result<Done, Refused>>, crate::report::envelope::Input, Vec<Finding>),
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
            let chosen = select(path, items, &reading.select)?;
            let done = chosen.par_iter().map(|item| item_done(job, path, item, several)).collect();
            let findings = findings.into_iter().filter(|f| job.tells(f)).map(|f| in_file(f, path)).collect();
            Ok(Opened::Done(done, input, findings))
        }
    }
}

/// The spectra asked for by name.
fn select(path: &str, items: Vec<Item>, names: &[String]) -> Result<Vec<Item>, Refused> {
    if names.is_empty() {
        return Ok(items);
    }
    let known: Vec<String> = items.iter().map(|i| i.measured.name.clone()).collect();
    let chosen: Vec<Item> = items.into_iter().filter(|i| wanted(&i.measured.name, names)).collect();
    if chosen.is_empty() {
        let some: Vec<&str> = known.iter().take(12).map(String::as_str).collect();
        let more = if known.len() > some.len() { ", …" } else { "" };
        return Err(Refused::plain(
            path,
            &format!("no spectrum named {}; expected one of {}{more}", names.join(" or "), some.join(", ")),
        ));
    }
    Ok(chosen)
}

fn wanted(name: &str, names: &[String]) -> bool {
    names.is_empty() || names.iter().any(|n| n.to_lowercase() == name.to_lowercase())
}

fn in_file(mut finding: Finding, path: &str) -> Finding {
    finding.location.path = Some(path.to_owned());
    finding
}

fn item_done(job: &Job<'_>, path: &str, item: &Item, several: bool) -> Result<Done, Refused> {
    let Measured { name, quantity, spectrum } = &item.measured;
    let heading = if several { format!("{path} [{name}]") } else { path.to_owned() };
    let place = Location::default().in_file(path);
    let place = if several { place.of_item(name) } else { place };
    let refuse = |message: &str| Refused {
        message: format!("{heading}: {message}"),
        finding: Finding::error("P000", message).at(place.clone()),
    };
    let Checked { value, mut findings } = convert(job, name, *quantity, spectrum).map_err(|m| refuse(&m))?;
    // The steps of a tabulated illuminant are its definition, not a coarse measurement of it.
    findings.retain(|f| !(item.defined && f.code == "P003"));
    for finding in &mut findings {
        finding.location = place.clone();
    }
    let bytes = render(job, path, &heading, &value, &item.printed);
    let drawn = job.arguments.output.plot.is_some().then(|| {
        // A column's header says less than the file's name, where the file holds nothing else.
        let file = std::path::Path::new(path).file_stem().map_or(path.into(), |s| s.to_string_lossy());
        let title = if several { name.clone() } else { file.into_owned() };
        convert_plot::Kept { name: title, conversion: value, spectrum: spectrum.clone() }
    });
    Ok(Done { bytes, findings, drawn })
}

/// Converts, and refuses quantities that were asked for and do not follow.
fn convert(job: &Job<'_>, name: &str, quantity: Quantity, spectrum: &Spectrum) -> Result<Checked<Conversion>, String> {
    let out = job.converter.convert(name, quantity, spectrum).map_err(|e| e.to_string())?;
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
    Ok(out)
}

fn render(job: &Job<'_>, path: &str, heading: &str, c: &Conversion, printed: &[Printed]) -> Vec<u8> {
    let settings = job.converter.settings();
    if job.form == Form::Text && printed.is_empty() {
        return text::conversion(heading, c, settings).into_bytes();
    }
    let mut object = Map::new();
    object.insert("path".into(), path.into());
    object.extend(json_report::json(c, settings));
    let compared = json_report::instrument(&object, printed);
    match job.form {
        Form::Text => {
            let mut out = text::conversion(heading, c, settings);
            out.push_str(&text::instrument(&compared));
            out.into_bytes()
        }
        Form::Json => {
            if !compared.is_empty() {
                object.insert("instrument".into(), json!(compared));
            }
            serde_json::to_vec(&Value::Object(object)).unwrap_or_default()
        }
        Form::Csv => csv_row(&job.table.row(&object)),
    }
}

fn csv_row(cells: &[String]) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // A vector takes every byte.
    let _ = writer.write_record(cells);
    writer.into_inner().unwrap_or_default()
}

/// Where rendered results go.
enum Writer<'a> {
    Json(Envelope<&'a mut Sink>),
    /// Text or CSV; whether a result was written already.
    Plain(&'a mut Sink, bool),
}

impl Writer<'_> {
    fn result(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Json(envelope) => envelope.result_bytes(bytes),
            Self::Plain(out, began) => {
                // A blank line between reports; CSV rows end in theirs and begin with no heading.
                if *began && bytes.ends_with(b"\n") && bytes.iter().filter(|b| **b == b'\n').count() > 1 {
                    out.write_all(b"\n")?;
                }
                *began = true;
                out.write_all(bytes)
            }
        }
    }

    fn finding(&mut self, finding: Finding) {
        if let Self::Json(envelope) = self {
            envelope.finding(finding);
        }
    }

    fn input(&mut self, input: crate::report::envelope::Input) {
        if let Self::Json(envelope) = self {
            envelope.input(input);
        }
    }

    fn end(self) -> io::Result<()> {
        match self {
            Self::Json(envelope) => envelope.end().map(|_| ()),
            Self::Plain(out, _) => out.flush(),
        }
    }
}

/// What is said on standard error.
struct Notes {
    talk: Talk,
    failed: bool,
    progress: ProgressBar,
}

impl Notes {
    fn say(&self, line: &str) {
        self.progress.suspend(|| {
            let _ = writeln!(io::stderr().lock(), "{line}");
        });
    }

    fn refuse(&mut self, message: &str) {
        self.failed = true;
        self.say(message);
    }

    /// Prints findings, a few of each code, and counts the rest.
    fn print(&self, findings: &[Finding]) {
        let least = match (self.talk.quiet, self.talk.verbose) {
            (true, _) => Severity::Error,
            (_, true) => Severity::Info,
            _ => Severity::Warning,
        };
        let mut counts: Vec<(&str, usize)> = Vec::new();
        for finding in findings.iter().filter(|f| f.severity >= least) {
            let at = counts.iter().position(|(code, _)| *code == finding.code).unwrap_or_else(|| {
                counts.push((finding.code, 0));
                counts.len() - 1
            });
            counts[at].1 += 1;
            if counts[at].1 <= PRINTED_PER_CODE {
                self.say(&finding.to_string());
            }
        }
        for (code, count) in counts.into_iter().filter(|(_, count)| *count > PRINTED_PER_CODE) {
            self.say(&format!("  … and {} more of {code}", count - PRINTED_PER_CODE));
        }
    }
}

fn progress(paths: &[String], talk: Talk) -> ProgressBar {
    let size = |path: &String| std::fs::metadata(path).map_or(0, |m| if m.is_file() { m.len() } else { 0 });
    let total: u64 = paths.iter().map(size).sum();
    if total < LONG_BYTES || !super::may_draw(talk) {
        return ProgressBar::hidden();
    }
    let template = "{bar:40} {bytes}/{total_bytes} {bytes_per_sec}, {eta} left";
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(total).with_style(style)
}

/// Findings of a stream, the first of each code with the number of rows it was met in.
#[derive(Default)]
struct Tally(Vec<(Finding, usize)>);

impl Tally {
    fn add(&mut self, finding: Finding) {
        match self.0.iter_mut().find(|(f, _)| f.code == finding.code) {
            Some((_, count)) => *count += 1,
            None => self.0.push((finding, 1)),
        }
    }

    fn into_findings(self) -> Vec<Finding> {
        let tell = |(mut finding, count): (Finding, usize)| {
            if count > 1 {
                finding.message.push_str(&format!(" (this row is the first of {count})"));
            }
            finding
        };
        self.0.into_iter().map(tell).collect()
    }
}

/// Converts a table with one spectrum per row, batch by batch.
fn convert_stream(
    job: &Job<'_>,
    path: &str,
    mut stream: RowStream<Counted>,
    writer: &mut Writer<'_>,
    notes: &mut Notes,
) -> Result<Vec<Finding>, Failure> {
    let reading = &job.arguments.reading;
    let mut found = Tally::default();
    let Checked { value: scale, findings } = match stream.scale(reading.quantity, reading.unit.as_ref()) {
        Ok(scale) => scale,
        Err(error) => {
            let refused = Refused::new(path, error);
            notes.refuse(&refused.message);
            return Ok(vec![refused.finding]);
        }
    };
    let mut errors = Vec::new();
    let mut failures = 0_usize;
    let mut chosen = 0_usize;
    let grid = std::sync::Arc::clone(stream.grid());
    loop {
        let batch = match stream.next_batch(ROWS_AT_ONCE) {
            Ok(Some(batch)) => batch,
            Ok(None) => break,
            Err(error) => {
                let refused = Refused::new(path, error);
                notes.refuse(&refused.message);
                errors.push(refused.finding);
                break;
            }
        };
        let done: Vec<Option<Result<Done, Refused>>> = batch
            .into_par_iter()
            .map(|row| match row {
                Err(error) => Some(Err(Refused::new(path, error))),
                Ok(row) => wanted(&row.name, &reading.select).then(|| row_done(job, path, &grid, &scale, row)),
            })
            .collect();
        for one in done.into_iter().flatten() {
            chosen += 1;
            match one {
                Ok(one) => {
                    writer.result(&one.bytes)?;
                    one.findings.into_iter().for_each(|f| found.add(f));
                }
                Err(refused) => {
                    failures += 1;
                    notes.failed = true;
                    if failures <= ERRORS_PER_INPUT {
                        notes.say(&refused.message);
                        errors.push(refused.finding);
                    }
                }
            }
        }
    }
    if failures > ERRORS_PER_INPUT {
        let message = format!("{} more rows of this input could not be converted", failures - ERRORS_PER_INPUT);
        notes.say(&format!("{path}: {message}"));
        errors.push(Finding::error("S000", message).at(Location::default().in_file(path)));
    }
    if chosen == 0 && !reading.select.is_empty() {
        let refused = Refused::plain(path, &format!("no spectrum named {}", reading.select.join(" or ")));
        notes.refuse(&refused.message);
        errors.push(refused.finding);
    }
    let own = findings.into_iter().chain(stream.findings()).filter(|f| job.tells(f));
    let mut all: Vec<Finding> = own.map(|f| in_file(f, path)).collect();
    all.extend(found.into_findings());
    notes.print(&all);
    all.extend(errors);
    Ok(all)
}

fn row_done(
    job: &Job<'_>,
    path: &str,
    grid: &std::sync::Arc<crate::spectrum::Grid>,
    scale: &Scale,
    row: Row,
) -> Result<Done, Refused> {
    let place = Location::line(row.line).in_file(path).of_item(&row.name);
    let refuse = |message: &str| Refused {
        message: format!("{place}: {message}"),
        finding: Finding::error("P000", message).at(place.clone()),
    };
    let spectrum = scale.apply(grid, row.values).map_err(|e| refuse(&e.to_string()))?;
    let Checked { value, mut findings } = convert(job, &row.name, scale.quantity, &spectrum).map_err(|m| refuse(&m))?;
    for finding in &mut findings {
        finding.location = place.clone();
    }
    let heading = format!("{path} [{}]", row.name);
    Ok(Done { bytes: render(job, path, &heading, &value, &[]), findings, drawn: None })
}

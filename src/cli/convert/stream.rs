//! Tables with one spectrum per row: read, converted in parallel and written batch by batch, so that memory holds a batch and
//! not the file.

use std::sync::Arc;

use rayon::prelude::*;

use super::input::{Counted, Refused};
use super::{Converted, Done, Job, convert, in_file, render, same_name, wanted};
use crate::cli::Failure;
use crate::cli::notes::Notes;
use crate::cli::writer::Writer;
use crate::finding::{Checked, Finding, Location};
use crate::spectrum::Grid;
use crate::spectrum::format::{Row, RowStream, Scale};

/// Rows converted at a time: what memory holds of the table.
const ROWS_AT_ONCE: usize = 2048;
/// Rows that cannot be read, reported per input before the rest is counted.
const ERRORS_PER_INPUT: usize = 20;

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
pub(super) fn convert_stream(
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
            return Ok(vec![*refused.finding]);
        }
    };
    let mut errors = Vec::new();
    let mut failures = 0_usize;
    let mut missing: Vec<&String> = reading.select.iter().collect();
    let grid = Arc::clone(stream.grid());
    loop {
        let batch = match stream.next_batch(ROWS_AT_ONCE) {
            Ok(Some(batch)) => batch,
            Ok(None) => break,
            Err(error) => {
                let refused = Refused::new(path, error);
                notes.refuse(&refused.message);
                errors.push(*refused.finding);
                break;
            }
        };
        if !missing.is_empty() {
            missing.retain(|name| !batch.iter().flatten().any(|row| same_name(&row.name, name)));
        }
        let done: Vec<Option<Result<Done, Refused>>> = batch
            .into_par_iter()
            .map(|row| match row {
                Err(error) => Some(Err(Refused::new(path, error))),
                Ok(row) => wanted(&row.name, &reading.select).then(|| row_done(job, path, &grid, &scale, row)),
            })
            .collect();
        for one in done.into_iter().flatten() {
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
                        errors.push(*refused.finding);
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
    if !missing.is_empty() {
        let names: Vec<&str> = missing.iter().map(|n| n.as_str()).collect();
        let refused = Refused::plain(path, &format!("no spectrum named {}", names.join(" or ")));
        notes.refuse(&refused.message);
        errors.push(*refused.finding);
    }
    let own = findings.into_iter().chain(stream.findings()).filter(|f| job.tells(f));
    let mut all: Vec<Finding> = own.map(|f| in_file(f, path)).collect();
    all.extend(found.into_findings());
    notes.print(&all);
    all.extend(errors);
    Ok(all)
}

fn row_done(job: &Job<'_>, path: &str, grid: &Arc<Grid>, scale: &Scale, row: Row) -> Result<Done, Refused> {
    let place = Location::line(row.line).in_file(path).of_item(&row.name);
    let refuse = |message: &str| Refused {
        message: format!("{place}: {message}"),
        finding: Box::new(Finding::error("P000", message).at(place.clone())),
    };
    let spectrum = scale.apply(grid, row.values).map_err(|e| refuse(&e.to_string()))?;
    let Checked { value: Converted { conversion, uncertainty }, mut findings } =
        convert(job, &row.name, scale.quantity, (&spectrum, None)).map_err(|m| refuse(&m))?;
    for finding in &mut findings {
        finding.location = place.clone();
    }
    let heading = format!("{path} [{}]", row.name);
    let bytes = render(job, path, &heading, (&conversion, uncertainty.as_ref()), &[]);
    Ok(Done { bytes, findings, drawn: None })
}

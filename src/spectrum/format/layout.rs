//! Which way a delimited table lies: one spectrum per column under a wavelength column, or one per row under a heading of
//! wavelengths.
//!
//! Rows need a heading of wavelengths: three or more cells that are numbers, alike but for the number (`R_380`, `380nm`) and in
//! order; two where they state nm. A label column in front of them may hold anything. A table of bare numbers lies in rows only
//! if its first row is evenly spaced and its first column is not in order; where both are in order it is refused. A cell such
//! as `wavelength` heads the column below it, so that `wavelength,3000,4000,5000` over 380, 381 … holds columns named by
//! numbers.

use std::collections::HashMap;

use super::super::WavelengthUnit;
use super::axis::{self, Axis};
use super::dialect::{Dialect, Record};
use super::error::{Error, ErrorKind};
use super::field::split;
use super::header::{self, WavelengthHeading};
use super::number::{self, Cell};
use super::{Layout, ReadOptions};
use crate::finding::Location;

/// Records among which a heading is looked for.
const PREAMBLE: usize = 400;

/// Records whose labels tell what the first column is.
const LABELS: usize = 64;

/// A heading of wavelengths over rows of values.
#[derive(Debug)]
pub(super) struct RowHeading {
    /// Its index among the records; data follow.
    pub index: usize,
    /// Cells of the heading.
    pub cells: usize,
    /// Which cells hold wavelengths, in file order.
    pub columns: Vec<usize>,
    /// The wavelengths in file order and unit.
    pub axis: Axis,
    pub unit: Option<WavelengthUnit>,
    /// The cell with the name of a row.
    pub name: Option<usize>,
}

/// Looks for a heading of wavelengths; `None` for a table of columns.
pub(super) fn rows(
    records: &[Record<'_>],
    dialect: Dialect,
    options: &ReadOptions,
) -> Result<Option<RowHeading>, Error> {
    match options.layout {
        Some(Layout::Columns) => return Ok(None),
        Some(Layout::Rows) => return forced(records, dialect).map(Some),
        None => {}
    }
    for (index, record) in records.iter().enumerate().take(PREAMBLE) {
        let candidate = Candidate::new(records, index, dialect);
        if candidate.group.is_empty() {
            // Wavelengths head a column here, and everything below is its data.
            let cell = split(record.text, dialect.separator).position(|f| header::axis(f.raw).is_some());
            if cell.is_some_and(|cell| candidate.number_below(records, cell)) {
                return Ok(None);
            }
            continue;
        }
        match candidate.verdict(records)? {
            Verdict::Rows => return candidate.heading(record).map(Some),
            Verdict::Columns => return Ok(None),
            Verdict::Neither => {}
        }
    }
    Ok(None)
}

fn forced(records: &[Record<'_>], dialect: Dialect) -> Result<RowHeading, Error> {
    for (index, record) in records.iter().enumerate().take(PREAMBLE) {
        let candidate = Candidate::new(records, index, dialect);
        if 2 * candidate.group.len() >= candidate.cells.max(2) {
            return candidate.heading(record);
        }
    }
    let expected = "a heading of wavelengths, such as name,380,381, over rows of values";
    Err(Error::whole(ErrorKind::NoSpectrum { expected }))
}

/// Whether a heading says that names of spectra stand below it.
fn heads_names(corner: &str) -> bool {
    const WORDS: [&str; 15] = [
        "name",
        "id",
        "sample",
        "label",
        "title",
        "no",
        "nr",
        "number",
        "index",
        "lamp",
        "spectrum",
        "file",
        "time",
        "timestamp",
        "date",
    ];
    corner.to_lowercase().split(|c: char| !c.is_alphabetic()).any(|word| WORDS.contains(&word))
}

enum Verdict {
    Rows,
    Columns,
    Neither,
}

/// A record that may be a heading of wavelengths.
struct Candidate {
    index: usize,
    dialect: Dialect,
    cells: usize,
    /// Cells that are wavelengths alike, with their place.
    group: Vec<(usize, usize, WavelengthHeading)>,
    /// The other cells: index and text.
    others: Vec<(usize, String)>,
}

impl Candidate {
    fn new(records: &[Record<'_>], index: usize, dialect: Dialect) -> Self {
        let mut all: Vec<(usize, usize, WavelengthHeading)> = Vec::new();
        let mut others = Vec::new();
        let mut cells = 0;
        for field in split(records[index].text, dialect.separator) {
            match header::wavelength_heading(&field.text(), dialect.decimal) {
                Some(heading) => all.push((cells, field.start, heading)),
                None => others.push((cells, field.text().into_owned())),
            }
            cells += 1;
        }
        // Headings alike but for the number; the largest such group, of equal ones the first.
        let mut counts: HashMap<(&str, Option<WavelengthUnit>), usize> = HashMap::new();
        for (_, _, h) in &all {
            *counts.entry((&h.prefix, h.unit)).or_default() += 1;
        }
        let best = all.iter().rev().max_by_key(|(_, _, h)| counts[&(h.prefix.as_str(), h.unit)]);
        let best = best.map(|(_, _, h)| (h.prefix.clone(), h.unit));
        let (group, rest): (Vec<_>, Vec<_>) =
            all.into_iter().partition(|(_, _, h)| best.as_ref().is_some_and(|(p, u)| *p == h.prefix && *u == h.unit));
        others.extend(rest.into_iter().map(|(cell, _, h)| (cell, format!("{}{}", h.prefix, h.value))));
        others.sort_by_key(|(cell, _)| *cell);
        Self { index, dialect, cells, group, others }
    }

    fn unit(&self) -> Option<WavelengthUnit> {
        self.group.first().and_then(|(_, _, h)| h.unit)
    }

    fn values(&self) -> impl Iterator<Item = f64> + '_ {
        self.group.iter().map(|(_, _, h)| h.value)
    }

    fn verdict(&self, records: &[Record<'_>]) -> Result<Verdict, Error> {
        let stated = self.unit();
        let unit = stated.unwrap_or_default();
        let bare = self.group.first().is_some_and(|(_, _, h)| h.prefix.is_empty());
        if self.group.len() < if stated.is_some() { 2 } else { 3 } || !self.followed_by_numbers(records) {
            return Ok(Verdict::Neither);
        }
        // `lamp1,lamp2,lamp3` are alike and in order, too, but no wavelengths.
        if !self.values().all(|v| axis::is_plausible_nm(unit.to_nm(v)) && (bare || stated.is_some() || v >= 100.0)) {
            return Ok(Verdict::Neither);
        }
        let Some((first, corner)) = self.others.first() else { return self.verdict_on_numbers(records) };
        let (numeric, ordered) = self.labels(records, *first);
        let heads_axis = self.others.iter().any(|(_, text)| header::axis(text).is_some());
        if numeric && ordered && heads_axis {
            return Ok(Verdict::Columns);
        }
        if self.axis_below(records) {
            return Ok(Verdict::Neither);
        }
        if numeric && ordered && bare && stated.is_none() && !heads_names(corner) {
            return Err(self.ambiguous(records));
        }
        Ok(Verdict::Rows)
    }

    /// A table of nothing but numbers.
    fn verdict_on_numbers(&self, records: &[Record<'_>]) -> Result<Verdict, Error> {
        let values: Vec<f64> = self.values().collect();
        let step = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
        let even = values.iter().enumerate().all(|(i, v)| (v - values[0] - step * i as f64).abs() <= 1e-6 * step.abs());
        if !even || step == 0.0 {
            return Ok(Verdict::Columns);
        }
        let mut column = Axis::default();
        for record in records[self.index..].iter().take(LABELS) {
            let value = split(record.text, self.dialect.separator).next();
            let value = value.and_then(|f| number::parse(f.raw, self.dialect.decimal).number());
            if value.is_none_or(|v| column.push(v, record.line, Location::default).is_err()) {
                return Ok(Verdict::Rows);
            }
        }
        Err(self.ambiguous(records))
    }

    fn ambiguous(&self, records: &[Record<'_>]) -> Error {
        let found = "wavelengths in the first row as well as in the first column".to_owned();
        records[self.index].error(0, ErrorKind::Ambiguous { found }).with_hint("say --layout rows or --layout columns")
    }

    fn number_below(&self, records: &[Record<'_>], cell: usize) -> bool {
        let Some(next) = records.get(self.index + 1) else { return false };
        let field = split(next.text, self.dialect.separator).nth(cell);
        field.is_some_and(|f| number::parse(f.raw, self.dialect.decimal).number().is_some())
    }

    /// Whether half of the cells below the wavelengths are numbers.
    fn followed_by_numbers(&self, records: &[Record<'_>]) -> bool {
        let Some(next) = records.get(self.index + 1) else { return false };
        let cells: Vec<&str> = split(next.text, self.dialect.separator).map(|f| f.raw).collect();
        let numbers = self.group.iter().filter(|(cell, _, _)| {
            cells.get(*cell).is_some_and(|c| number::parse(c, self.dialect.decimal).number().is_some())
        });
        2 * numbers.count() >= self.group.len()
    }

    /// Whether the labels below are all numbers, and whether these could be wavelengths in order.
    fn labels(&self, records: &[Record<'_>], cell: usize) -> (bool, bool) {
        let mut labels = Axis::default();
        let mut ordered = true;
        for record in records[self.index + 1..].iter().take(LABELS) {
            let Some(field) = split(record.text, self.dialect.separator).nth(cell) else { continue };
            match number::parse(field.raw, self.dialect.decimal) {
                Cell::Number(value) => {
                    ordered &=
                        axis::is_plausible_nm(value) && labels.push(value, record.line, Location::default).is_ok();
                }
                _ => return (false, false),
            }
        }
        (true, ordered)
    }

    /// Whether a wavelength column begins below: then this is a line of facts about the columns, such as their Ra.
    fn axis_below(&self, records: &[Record<'_>]) -> bool {
        let first = |record: &Record<'_>| split(record.text, self.dialect.separator).next().map(|f| f.raw.to_owned());
        records[self.index + 1..].windows(2).take(LABELS).any(|pair| {
            first(&pair[0]).is_some_and(|cell| header::axis(&cell).is_some())
                && first(&pair[1]).is_some_and(|cell| number::parse(&cell, self.dialect.decimal).number().is_some())
        })
    }

    fn heading(&self, record: &Record<'_>) -> Result<RowHeading, Error> {
        let mut axis = Axis::default();
        for (_, start, heading) in &self.group {
            axis.push(heading.value, record.line, || record.place(*start))?;
        }
        const NAMES: [&str; 6] = ["name", "sample_name", "label", "title", "sample", "id"];
        let named = NAMES.iter().find_map(|name| self.others.iter().find(|(_, text)| text.eq_ignore_ascii_case(name)));
        Ok(RowHeading {
            index: self.index,
            cells: self.cells,
            columns: self.group.iter().map(|(cell, _, _)| *cell).collect(),
            axis,
            unit: self.unit().or_else(|| self.corner_unit()),
            name: named.or(self.others.first()).map(|(cell, _)| *cell),
        })
    }

    /// The unit that the corner states: `nm,380,381` or `wavelength [nm],380,381`.
    fn corner_unit(&self) -> Option<WavelengthUnit> {
        self.others.iter().find_map(|(_, text)| match header::axis(text) {
            Some(header::AxisUnit::Stated(unit)) => Some(unit),
            _ => None,
        })
    }
}

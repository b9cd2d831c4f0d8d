//! Delimited tables with one spectrum per row: what their heading fixes, and the reading of one row.

use std::sync::Arc;

use super::super::{Grid, Quantity, SpectralUnit};
use super::ReadOptions;
use super::axis;
use super::columns::cell_error;
use super::dialect::{Dialect, Record};
use super::error::{Error, ErrorKind};
use super::field::{Field, split};
use super::header::{self, AxisUnit};
use super::layout::RowHeading;
use super::number::{self, Cell};
use crate::finding::{Finding, Location};

/// One row of a table: a spectrum on the grid that all rows share.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The label of the row; empty where the table has none.
    pub name: String,
    /// One finite value per wavelength of the grid, in the file's unit.
    pub values: Vec<f64>,
    /// Line of the input, from 1.
    pub line: u64,
}

/// What the heading of a table of rows fixes.
#[derive(Debug, Clone)]
pub(super) struct RowTable {
    pub grid: Arc<Grid>,
    pub quantity: Option<Quantity>,
    pub unit: Option<SpectralUnit>,
    /// Names of the cells that are neither wavelength nor name, with their place in a row.
    pub facts: Vec<(usize, String)>,
    dialect: Dialect,
    cells: usize,
    columns: Vec<usize>,
    name: Option<usize>,
    descends: bool,
}

impl RowTable {
    pub(super) fn new(
        heading: RowHeading,
        record: &Record<'_>,
        dialect: Dialect,
        options: &ReadOptions,
        findings: &mut Vec<Finding>,
    ) -> Result<Self, Error> {
        let place = Location::at(record.line, 1);
        let stated = heading.unit.map_or(AxisUnit::NotStated, AxisUnit::Stated);
        let unit = axis::unit(&stated, options.wavelength_unit, &place, findings)?;
        let descends = heading.axis.descends();
        if descends {
            findings.push(axis::reversed(place.clone()));
        }
        let grid = axis::grid(heading.axis.nanometres(unit), &place)?;
        let texts: Vec<String> = split(record.text, dialect.separator).map(|f| f.text().into_owned()).collect();
        // The corner may say what the numbers are: `irradiance [W/m2/nm],380,381`.
        let corner = heading.name.map(|cell| header::value(&texts[cell])).unwrap_or_default();
        let facts =
            (0..heading.cells).filter(|c| heading.columns.binary_search(c).is_err() && Some(*c) != heading.name);
        Ok(Self {
            grid,
            quantity: corner.quantity,
            unit: corner.unit,
            facts: facts.map(|c| (c, texts[c].clone())).collect(),
            dialect,
            cells: heading.cells,
            columns: heading.columns,
            name: heading.name,
            descends,
        })
    }

    /// Reads one row.
    pub(super) fn read(&self, record: Record<'_>) -> Result<Row, Error> {
        let mut row = Row { name: String::new(), values: Vec::with_capacity(self.columns.len()), line: record.line };
        let mut cells = 0;
        for field in split(record.text, self.dialect.separator) {
            if self.columns.get(row.values.len()) == Some(&cells) {
                match number::parse(field.raw, self.dialect.decimal) {
                    Cell::Number(value) => row.values.push(value),
                    _ => return Err(self.value_error(&record, &field, &row)),
                }
            } else if self.name == Some(cells) {
                row.name = field.text().into_owned();
            }
            if field.unclosed {
                return Err(record.error(field.start, ErrorKind::UnclosedQuote));
            }
            if cells >= self.cells && !field.raw.is_empty() {
                let found = cells + 1 + split(record.text, self.dialect.separator).skip(cells + 1).count();
                let kind = ErrorKind::TooManyColumns { found, expected: self.cells };
                return Err(record.error(field.start, kind));
            }
            cells += 1;
        }
        if row.values.len() < self.columns.len() {
            let kind = ErrorKind::MissingColumn { found: cells, expected: self.cells };
            return Err(record.error(record.text.len(), kind));
        }
        if self.descends {
            row.values.reverse();
        }
        Ok(row)
    }

    #[cold]
    fn value_error(&self, record: &Record<'_>, field: &Field<'_>, row: &Row) -> Error {
        if number::parse(field.raw, self.dialect.decimal) == Cell::Missing {
            let kind = ErrorKind::MissingValue { found: field.raw.to_owned(), name: row.name.clone() };
            return record.error(field.start, kind).with_hint("delete the row, or fill in a value you can answer for");
        }
        cell_error(record, field, self.dialect, "value")
    }

    /// The other cells of a row, by their heading.
    pub(super) fn facts(&self, record: Record<'_>) -> Vec<(String, String)> {
        let mut facts = Vec::with_capacity(self.facts.len());
        if !self.facts.is_empty() {
            let fields: Vec<_> = split(record.text, self.dialect.separator).collect();
            for (cell, name) in &self.facts {
                facts.extend(fields.get(*cell).map(|field| (name.clone(), field.text().into_owned())));
            }
        }
        facts
    }
}

/// Negative samples met, in any number of spectra.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Negatives {
    count: u64,
    minimum: f64,
    at: Location,
}

impl Negatives {
    pub(super) fn add(&mut self, values: &[f64], place: impl Fn() -> Location) {
        for &value in values {
            if value < 0.0 {
                self.count += 1;
                if value < self.minimum {
                    self.minimum = value;
                    self.at = place();
                }
            }
        }
    }

    /// The finding that there are some; they stay as they are, since dark noise has to average out.
    pub(super) fn finding(&self) -> Option<Finding> {
        let message = format!("{} negative samples were kept, the lowest {}", self.count, self.minimum);
        (self.count > 0).then(|| Finding::warning("S005", message).at(self.at.clone()))
    }
}

//! Delimited text: CSV, TSV and whatever spreadsheets and scripts make of them.
//!
//! Above the table may stand `key,value` or `key: value` lines and comments (`#`, `%`, `//`, `!`): they become metadata. A key
//! `unit` or `quantity` among them states these for all spectra of the file. After the table nothing may follow.

use super::super::Spectrum;
use super::super::{Quantity, SpectralUnit};
use super::columns;
use super::dialect::{self, Dialect, Lines, Record};
use super::error::{Error, ErrorKind};
use super::field::{Separator, split};
use super::header::{self, UnitText};
use super::layout;
use super::rows::{Negatives, RowTable};
use super::{Entry, Format, ReadOptions, SpectrumFile, item, printed};
use crate::finding::{Checked, Finding, Location};

/// A table of rows as its first lines tell it.
pub(super) struct Head {
    pub table: RowTable,
    pub metadata: Vec<(String, String)>,
    pub findings: Vec<Finding>,
    /// The line of the heading; rows follow.
    pub line: u64,
}

/// A text sorted into records, with its dialect.
struct Table<'a> {
    text: &'a str,
    lines: Lines<'a>,
    dialect: Dialect,
}

impl<'a> Table<'a> {
    fn new(text: &'a str, options: &ReadOptions) -> Result<Self, Error> {
        let lines = dialect::lines(text, 1);
        if lines.records.is_empty() {
            return Err(Error::whole(ErrorKind::Empty));
        }
        let dialect = Dialect::find(&lines.records, lines.declared, options)?;
        Ok(Self { text, lines, dialect })
    }

    /// Facts above the table, and all comments.
    fn metadata<'r>(&self, above: impl Iterator<Item = &'r Record<'r>>) -> Vec<(String, String)> {
        let mut facts = Vec::new();
        for (comment, _) in &self.lines.comments {
            facts.extend(fact(comment.text));
        }
        for record in above {
            let cells: Vec<String> =
                split(record.text, self.dialect.separator).map(|f| f.text().into_owned()).collect();
            match &cells[..] {
                [key, value, ..]
                    if self.dialect.separator != Separator::Blanks && !value.is_empty() && !key.contains(": ") =>
                {
                    facts.push((key.trim_end_matches(':').to_owned(), cells[1..].join(" ").trim().to_owned()));
                }
                _ => facts.extend(fact(record.text)),
            }
        }
        facts
    }
}

/// `key: value`, `key = value` or a remark without key.
fn fact(line: &str) -> Option<(String, String)> {
    let line = line.trim().trim_matches('"').trim();
    if line.is_empty() {
        return None;
    }
    let (key, value) = line.split_once(':').or_else(|| line.split_once('=')).unwrap_or(("", line));
    Some((key.trim().to_owned(), value.trim_matches([' ', '\t', ',', ';', '"']).to_owned()))
}

/// What a fact above the table states for all of its spectra.
fn stated(metadata: &[(String, String)], findings: &mut Vec<Finding>) -> (Option<Quantity>, Option<SpectralUnit>) {
    let value = |keys: &[&str]| {
        metadata.iter().find(|(key, _)| keys.contains(&key.to_lowercase().as_str())).map(|(_, value)| value.as_str())
    };
    let quantity = value(&["quantity", "spectral quantity"]).and_then(|q| q.parse().ok());
    let Some(text) = value(&["unit", "units", "value unit", "spectral unit"]) else { return (quantity, None) };
    match header::unit(text) {
        UnitText::Unit(unit) => (quantity, Some(unit)),
        UnitText::Dimensionless => (quantity.or(Some(Quantity::Relative)), None),
        UnitText::Other => {
            let message = format!("`{text}` is no unit of a spectrum that is understood here");
            findings.push(Finding::warning("S006", message).hint("say the unit with --unit"));
            (quantity, None)
        }
    }
}

/// Reads the heading of a table of rows from the beginning of its text; `None` for a table of columns.
pub(super) fn head(text: &str, options: &ReadOptions) -> Result<Option<Head>, Error> {
    let table = Table::new(text, options)?;
    let Some(heading) = layout::rows(&table.lines.records, table.dialect, options)? else { return Ok(None) };
    Ok(Some(table.head(heading, options)?))
}

impl Table<'_> {
    fn head(&self, heading: layout::RowHeading, options: &ReadOptions) -> Result<Head, Error> {
        let mut findings = Vec::new();
        let metadata = self.metadata(self.lines.records[..heading.index].iter());
        let record = self.lines.records[heading.index];
        let mut table = RowTable::new(heading, &record, self.dialect, options, &mut findings)?;
        let (quantity, unit) = stated(&metadata, &mut findings);
        table.quantity = table.quantity.or(quantity);
        table.unit = table.unit.or(unit);
        Ok(Head { table, metadata, findings, line: record.line })
    }
}

/// Reads a whole table.
pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Checked<SpectrumFile>, Error> {
    let table = Table::new(text, options)?;
    match layout::rows(&table.lines.records, table.dialect, options)? {
        Some(heading) => read_rows(&table, heading, options),
        None => read_columns(&table, options),
    }
}

fn read_rows(
    table: &Table<'_>,
    heading: layout::RowHeading,
    options: &ReadOptions,
) -> Result<Checked<SpectrumFile>, Error> {
    let first = heading.index + 1;
    let Head { table: rows, metadata, mut findings, .. } = table.head(heading, options)?;
    let mut entries = Vec::with_capacity(table.lines.records.len() - first);
    let mut negatives = Negatives::default();
    for record in &table.lines.records[first..] {
        let row = rows.read(*record)?;
        let location = Location::line(row.line);
        negatives.add(&row.values, || item(location.clone(), &row.name));
        let spectrum = Spectrum::density(rows.grid.clone(), row.values).map_err(|e| Error::new(location.clone(), e))?;
        entries.push(Entry {
            name: row.name,
            spectrum,
            standard: None,
            quantity: rows.quantity,
            unit: rows.unit.clone(),
            printed: Vec::new(),
            metadata: rows.facts(*record),
            location,
        });
    }
    if entries.is_empty() {
        let expected = "rows of values below the heading of wavelengths";
        return Err(Error::at(table.lines.records[first - 1].line, 1, ErrorKind::NoSpectrum { expected }));
    }
    findings.extend(negatives.finding());
    Ok(Checked { value: SpectrumFile { format: Format::Delimited, entries, metadata }, findings })
}

fn read_columns(table: &Table<'_>, options: &ReadOptions) -> Result<Checked<SpectrumFile>, Error> {
    let mut findings = Vec::new();
    // A comment right above the first record may be the heading of a table without another.
    let comment = table.lines.comments.iter().rev().find(|(_, before)| *before == 0).map(|(record, _)| *record);
    let records = dialect::join_quoted(table.text, &table.lines.records, table.dialect.separator)?;
    let (mut entries, head) = columns::read(&records, table.dialect, comment, options, &mut findings)?;
    let above = (0..head.data).filter(|at| Some(*at) != head.heading && Some(*at) != head.units);
    let metadata = table.metadata(above.map(|at| &records[at]));
    let (quantity, unit) = stated(&metadata, &mut findings);
    // Figures above a table of several spectra belong to nobody knows which.
    let alone = entries.len() == 1;
    for entry in &mut entries {
        entry.quantity = entry.quantity.or(quantity);
        entry.unit = entry.unit.take().or_else(|| unit.clone());
        if alone {
            entry.printed = metadata.iter().filter_map(|(label, text)| printed::known_figure(label, text)).collect();
        }
        let mut negatives = Negatives::default();
        negatives.add(entry.spectrum.values(), || item(entry.location.clone(), &entry.name));
        findings.extend(negatives.finding());
    }
    Ok(Checked { value: SpectrumFile { format: Format::Delimited, entries, metadata }, findings })
}

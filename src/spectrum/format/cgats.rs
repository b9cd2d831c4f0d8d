//! CGATS.17 (ISO 28178) tables, with the keywords of X-Rite and Gretag software (`LGOROWLENGTH`).
//!
//! Fields such as `SPECTRAL_NM380`, `SPEC_380`, `nm380` or `R_380` hold the samples, in nm. They are reflectance or transmittance
//! factors unless a keyword such as `MEAS_TYPE` says otherwise. A file may hold several tables; each set is one line.

use std::collections::HashMap;
use std::sync::Arc;

use super::super::{Grid, Quantity, Spectrum, WavelengthUnit};
use super::axis::{self, Axis};
use super::error::{Error, ErrorKind};
use super::field::{Field, Separator, split};
use super::header::{self, AxisUnit};
use super::instrument;
use super::rows::Negatives;
use super::text::{Places, place};
use super::{Entry, Format, ReadOptions, SpectrumFile, item};
use crate::finding::{Checked, Finding, Location};

/// Whether a text is such a file.
pub(super) fn matches(head: &str) -> bool {
    let first = head.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default().to_ascii_uppercase();
    ["CGATS", "IT8", "ISO28178", "LGOROWLENGTH"].iter().any(|start| first.starts_with(start))
        || head.lines().any(|line| line.trim() == "BEGIN_DATA_FORMAT")
}

pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Checked<SpectrumFile>, Error> {
    let mut reader = Reader { options, metadata: Vec::new(), entries: Vec::new(), findings: Vec::new() };
    let mut lines = (1u64..).zip(text.lines()).map(|(number, line)| Line { number, text: without_comment(line) });
    let mut table = Table::default();
    let mut last = 1;
    while let Some(line) = lines.next() {
        last = line.number;
        match line.text.trim() {
            "" => {}
            "BEGIN_DATA_FORMAT" => table.fields = reader.fields(&mut lines, line, &table)?,
            "BEGIN_DATA" => {
                reader.data(&mut lines, line, &table)?;
                table = Table::default();
            }
            _ => reader.keyword(line, &mut table)?,
        }
    }
    if reader.entries.is_empty() {
        let expected = "a table with spectral fields such as SPECTRAL_NM380, between BEGIN_DATA and END_DATA";
        return Err(Error::at(last, 1, ErrorKind::NoSpectrum { expected }));
    }
    if reader.entries.iter().all(|e| e.quantity == Some(Quantity::Relative)) {
        let message = "spectral fields of CGATS.17 are reflectance or transmittance factors by definition: ratios";
        reader.findings.push(Finding::info("S007", message).at(reader.entries[0].location.clone()));
    }
    let Reader { metadata, entries, findings, .. } = reader;
    Ok(Checked { value: SpectrumFile { format: Format::Cgats, entries, metadata }, findings })
}

#[derive(Clone, Copy)]
struct Line<'a> {
    number: u64,
    text: &'a str,
}

impl<'a> Line<'a> {
    fn place(&self, byte: usize) -> Location {
        place(self.text, self.number, byte)
    }

    /// Values separated by TABs, or by blanks where there is no TAB; empty ones at the end do not count.
    fn fields(&self) -> Vec<Field<'a>> {
        let separator = if self.text.contains('\t') { Separator::Byte(b'\t') } else { Separator::Blanks };
        let mut fields: Vec<_> = split(self.text, separator).collect();
        while fields.last().is_some_and(|f| f.raw.is_empty() && !f.quoted) {
            fields.pop();
        }
        fields
    }
}

/// The line up to a `#` outside of quotation marks.
fn without_comment(line: &str) -> &str {
    let mut quoted = false;
    for (at, c) in line.char_indices() {
        match c {
            '"' => quoted = !quoted,
            '#' if !quoted => return &line[..at],
            _ => {}
        }
    }
    line
}

/// What precedes the data of one table.
#[derive(Default)]
struct Table {
    fields: Vec<(String, Location)>,
    stated_fields: Option<u64>,
    stated_sets: Option<u64>,
}

struct Reader<'o> {
    options: &'o ReadOptions,
    metadata: Vec<(String, String)>,
    entries: Vec<Entry>,
    findings: Vec<Finding>,
}

impl Reader<'_> {
    fn keyword(&mut self, line: Line<'_>, table: &mut Table) -> Result<(), Error> {
        let text = line.text.trim();
        let (key, value) = text.split_once([' ', '\t']).unwrap_or((text, ""));
        let value = value.trim().trim_matches('"');
        let count = || {
            let found = value.to_owned();
            let at = line.place(line.text.len() - line.text.trim_start().len() + key.len() + 1);
            value.parse::<u64>().map_err(|_| Error::new(at, ErrorKind::NotANumber { found, what: "count" }))
        };
        match key {
            "NUMBER_OF_FIELDS" => table.stated_fields = Some(count()?),
            "NUMBER_OF_SETS" => table.stated_sets = Some(count()?),
            "END_DATA" | "END_DATA_FORMAT" => {
                let expected = key.replace("END", "BEGIN");
                let kind = ErrorKind::Unexpected { found: key.to_owned(), expected: format!("{expected} before it") };
                return Err(Error::new(line.place(0), kind));
            }
            _ if value.is_empty() => self.metadata.push((String::new(), key.to_owned())),
            _ => self.metadata.push((key.to_owned(), value.to_owned())),
        }
        Ok(())
    }

    fn fields<'a>(
        &self,
        lines: &mut impl Iterator<Item = Line<'a>>,
        begin: Line<'_>,
        table: &Table,
    ) -> Result<Vec<(String, Location)>, Error> {
        let mut fields = Vec::new();
        for line in lines {
            if line.text.trim() == "END_DATA_FORMAT" {
                let found = fields.len() as u64;
                return match table.stated_fields {
                    Some(stated) if stated != found => {
                        Err(Error::new(line.place(0), ErrorKind::CountMismatch { what: "fields", stated, found }))
                    }
                    _ => Ok(fields),
                };
            }
            let mut places = Places::new(line.text, line.number);
            let names = split(line.text, Separator::Blanks);
            fields.extend(names.map(|f| (f.text().into_owned(), places.of(f.start))));
        }
        Err(unended(begin, "END_DATA_FORMAT"))
    }

    fn data<'a>(
        &mut self,
        lines: &mut impl Iterator<Item = Line<'a>>,
        begin: Line<'_>,
        table: &Table,
    ) -> Result<(), Error> {
        if table.fields.is_empty() {
            let kind = ErrorKind::Unexpected {
                found: "BEGIN_DATA".to_owned(),
                expected: "the names of its fields (BEGIN_DATA_FORMAT) before it".to_owned(),
            };
            return Err(Error::new(begin.place(0), kind));
        }
        let spectral = Spectral::new(table, self.options, &mut self.findings)?;
        let relative = !self.emissive();
        let mut negatives = Negatives::default();
        let mut sets = 0;
        for line in lines {
            let text = line.text.trim();
            if text.is_empty() {
                continue;
            }
            if text == "END_DATA" {
                self.findings.extend(negatives.finding());
                return match table.stated_sets {
                    Some(stated) if stated != sets => {
                        Err(Error::new(line.place(0), ErrorKind::CountMismatch { what: "sets", stated, found: sets }))
                    }
                    _ => Ok(()),
                };
            }
            sets += 1;
            let fields = line.fields();
            check_width(&line, &fields, table.fields.len())?;
            let Some(spectral) = &spectral else { continue };
            let mut entry = spectral.entry(&line, &fields, table, self.options)?;
            entry.quantity = relative.then_some(Quantity::Relative);
            // A second table on the same wavelengths shares the grid of the first.
            if let Some(first) = self.entries.first()
                && first.spectrum.grid() == entry.spectrum.grid()
            {
                let grid = Arc::clone(first.spectrum.grid());
                entry.spectrum = Spectrum::density(grid, entry.spectrum.values().to_vec())
                    .map_err(|error| Error::new(entry.location.clone(), error))?;
            }
            negatives.add(entry.spectrum.values(), || item(entry.location.clone(), &entry.name));
            self.entries.push(entry);
        }
        Err(unended(begin, "END_DATA"))
    }

    /// Whether a keyword says that light was measured and no surface.
    fn emissive(&self) -> bool {
        self.metadata.iter().any(|(key, value)| {
            let value = value.to_ascii_uppercase();
            matches!(key.as_str(), "MEAS_TYPE" | "MEASUREMENT_TYPE" | "MEASUREMENT_MODE")
                && ["EMISSI", "AMBIENT", "RADIAN"].iter().any(|word| value.contains(word))
        })
    }
}

fn unended(begin: Line<'_>, end: &str) -> Error {
    let kind =
        ErrorKind::Unexpected { found: "the end of the file".to_owned(), expected: format!("{end} after this line") };
    Error::new(begin.place(0), kind)
}

fn check_width(line: &Line<'_>, fields: &[Field<'_>], expected: usize) -> Result<(), Error> {
    let found = fields.len();
    if let Some(open) = fields.iter().find(|f| f.unclosed) {
        return Err(Error::new(line.place(open.start), ErrorKind::UnclosedQuote));
    }
    if found < expected {
        return Err(Error::new(line.place(line.text.len()), ErrorKind::MissingColumn { found, expected }));
    }
    match fields.get(expected) {
        Some(extra) => Err(Error::new(line.place(extra.start), ErrorKind::TooManyColumns { found, expected })),
        None => Ok(()),
    }
}

/// The spectral fields of a table.
struct Spectral {
    grid: Arc<Grid>,
    columns: Vec<usize>,
    descends: bool,
}

impl Spectral {
    fn new(table: &Table, options: &ReadOptions, findings: &mut Vec<Finding>) -> Result<Option<Self>, Error> {
        /// No field of a colour is numbered as high.
        const LOWEST: f64 = 100.0;
        let headings = table.fields.iter().enumerate().filter_map(|(at, (name, place))| {
            header::wavelength_heading(name, '.').filter(|h| h.value >= LOWEST).map(|h| (at, h, place))
        });
        let all: Vec<_> = headings.collect();
        let mut alike: HashMap<&str, usize> = HashMap::new();
        for (_, heading, _) in &all {
            *alike.entry(&heading.prefix).or_default() += 1;
        }
        let Some((_, best, _)) = all.iter().rev().max_by_key(|(_, h, _)| alike[h.prefix.as_str()]) else {
            let place = table.fields.first().map(|(_, place)| place.clone()).unwrap_or_default();
            findings.push(Finding::info("S009", "a table without spectral fields was not read").at(place));
            return Ok(None);
        };
        let mut axis = Axis::default();
        let mut columns = Vec::new();
        let first = best.prefix.clone();
        let mut begins = Location::default();
        for (at, heading, place) in all.iter().filter(|(_, h, _)| h.prefix == first) {
            if columns.is_empty() {
                begins = (*place).clone();
            }
            axis.push(heading.value, place.line.unwrap_or_default(), || (*place).clone())?;
            columns.push(*at);
        }
        let unit =
            axis::unit(&AxisUnit::Stated(WavelengthUnit::Nanometre), options.wavelength_unit, &begins, findings)?;
        let descends = axis.descends();
        if descends {
            findings.push(axis::reversed(begins.clone()));
        }
        Ok(Some(Self { grid: axis::grid(axis.nanometres(unit), &begins)?, columns, descends }))
    }

    fn entry(
        &self,
        line: &Line<'_>,
        fields: &[Field<'_>],
        table: &Table,
        options: &ReadOptions,
    ) -> Result<Entry, Error> {
        let decimal = instrument::decimal(self.columns.iter().map(|c| fields[*c].raw), options);
        let mut values = Vec::with_capacity(self.columns.len());
        for column in &self.columns {
            let field = &fields[*column];
            values.push(instrument::number(field.raw, decimal, "value", || line.place(field.start))?);
        }
        if self.descends {
            values.reverse();
        }
        let location = Location::line(line.number);
        let spectrum =
            Spectrum::density(Arc::clone(&self.grid), values).map_err(|e| Error::new(location.clone(), e))?;
        const NAMES: [&str; 4] = ["SAMPLE_NAME", "SAMPLENAME", "SAMPLE_ID", "SAMPLEID"];
        let name = NAMES.iter().find_map(|n| table.fields.iter().position(|(field, _)| field.eq_ignore_ascii_case(n)));
        let others = (0..fields.len()).filter(|at| self.columns.binary_search(at).is_err() && Some(*at) != name);
        let metadata = others.map(|at| (table.fields[at].0.clone(), fields[at].text().into_owned())).collect();
        let name = name.map(|at| fields[at].text().into_owned()).unwrap_or_default();
        Ok(Entry {
            name,
            spectrum,
            standard: None,
            quantity: None,
            unit: None,
            printed: Vec::new(),
            metadata,
            location,
        })
    }
}

//! Delimited tables with one spectrum per column.

use std::sync::Arc;

use super::super::{Grid, Quantity, Spectrum};
use super::axis::{self, Axis};
use super::dialect::{Dialect, Record};
use super::error::{Error, ErrorKind};
use super::field::{Field, split};
use super::header::{self, AxisUnit, UnitText, ValueHeading};
use super::number::{self, Cell};
use super::text::Places;
use super::{Entry, ReadOptions, item};
use crate::finding::{Finding, Location};

/// A value column while it is read; a missing cell is NaN, which no input can hold.
struct Column {
    cell: usize,
    heading: ValueHeading,
    place: Location,
    /// Which of the table's wavelength columns it belongs to.
    axis: usize,
    /// It holds the standard uncertainties of the column before it.
    uncertainty: bool,
    values: Vec<f64>,
}

/// A wavelength column.
struct AxisColumn {
    cell: usize,
    unit: AxisUnit,
    place: Location,
    axis: Axis,
    /// The record of each wavelength.
    rows: Vec<usize>,
}

/// What stands above the data.
pub(super) struct Head {
    /// The heading, where there is one.
    pub heading: Option<usize>,
    /// A line of units under the heading.
    pub units: Option<usize>,
    /// The first record of data.
    pub data: usize,
}

/// Reads the columns of a table; `comment` is a comment line right above the data, which may be its heading.
pub(super) fn read(
    records: &[Record<'_>],
    dialect: Dialect,
    comment: Option<Record<'_>>,
    options: &ReadOptions,
    findings: &mut Vec<Finding>,
) -> Result<(Vec<Entry>, Head), Error> {
    let head = find_head(records, dialect)?;
    let width = split(records[head.data].text, dialect.separator).count();
    let heading = match head.heading {
        Some(at) => Some(records[at]),
        None => comment.filter(|c| is_heading(*c, dialect, width)),
    };
    let first = records[head.data].place(0);
    let (mut axes, mut columns) = plan(heading, first, width, dialect, findings);
    if let Some(at) = head.units {
        apply_units(&records[at], dialect, &mut axes, &mut columns)?;
    }
    for (index, record) in records.iter().enumerate().skip(head.data) {
        read_record(record, index, dialect, &mut axes, &mut columns)?;
    }
    let entries = Assembly { records, dialect, options, findings }.entries(axes, columns)?;
    Ok((entries, head))
}

/// Finds heading, line of units and first data record.
fn find_head(records: &[Record<'_>], dialect: Dialect) -> Result<Head, Error> {
    let cells = |at: usize| split(records[at].text, dialect.separator);
    let mut heading: Option<(usize, usize)> = None;
    let mut units = None;
    let mut data = None;
    for at in 0..records.len() {
        if let Some(cell) = cells(at).position(|f| header::axis(&f.text()).is_some()) {
            if at > 0
                && is_unit_line(&records[at], dialect, cell)
                && is_text_line(&records[at - 1], dialect, cells(at).count())
            {
                heading = Some((at - 1, cell));
                units = Some(at);
            } else {
                heading = Some((at, cell));
                units = None;
            }
            continue;
        }
        let cell = heading.map_or(0, |(_, cell)| cell);
        let first = cells(at).nth(cell).map(|f| number::parse(f.raw, dialect.decimal));
        if matches!(first, Some(Cell::Number(_))) && cells(at).count() > 1 {
            data = Some(at);
            break;
        }
    }
    let below = units.or(heading.map(|(at, _)| at));
    let Some(data) = data else { return Err(no_data(records, dialect, heading, below)) };
    match (heading, below) {
        (Some((at, cell)), Some(below)) => {
            // Whatever stands between heading and data should have been data.
            if below + 1 < data {
                return Err(not_a_wavelength(&records[below + 1], dialect, cell));
            }
            Ok(Head { heading: Some(at), units, data })
        }
        _ => {
            let above = data.checked_sub(1);
            if let Some(above) = above
                && cells(above).next().is_some_and(|f| begins_like_number(f.raw, dialect.decimal))
                && cells(above).count() == cells(data).count()
            {
                return Err(not_a_wavelength(&records[above], dialect, 0));
            }
            Ok(Head {
                heading: above.filter(|a| is_text_line(&records[*a], dialect, cells(data).count())),
                units: None,
                data,
            })
        }
    }
}

fn no_data(records: &[Record<'_>], dialect: Dialect, heading: Option<(usize, usize)>, below: Option<usize>) -> Error {
    if let (Some((_, cell)), Some(next)) = (heading, below.and_then(|at| records.get(at + 1))) {
        return not_a_wavelength(next, dialect, cell);
    }
    let expected = "a table of wavelengths and values, in columns or in rows";
    let line = records.last().map_or(1, |r| r.line);
    Error::at(line, 1, ErrorKind::NoSpectrum { expected })
        .with_hint("say --separator, --decimal, --layout or --format where the file is told wrongly")
}

fn begins_like_number(cell: &str, decimal: char) -> bool {
    matches!(number::parse(cell, decimal), Cell::NotFinite)
        || cell.trim_start_matches(['+', '-', '.', ',']).starts_with(|c: char| c.is_ascii_digit())
}

fn not_a_wavelength(record: &Record<'_>, dialect: Dialect, cell: usize) -> Error {
    match split(record.text, dialect.separator).nth(cell) {
        Some(field) => cell_error(record, &field, dialect, "wavelength"),
        None => {
            let found = split(record.text, dialect.separator).count();
            record.error(record.text.len(), ErrorKind::MissingColumn { found, expected: cell + 1 })
        }
    }
}

/// The error of a cell that should have been a number.
pub(super) fn cell_error(record: &Record<'_>, field: &Field<'_>, dialect: Dialect, what: &'static str) -> Error {
    let found = field.text().into_owned();
    match number::parse(field.raw, dialect.decimal) {
        Cell::NotFinite => record.error(field.start, ErrorKind::NotFinite { found, what }),
        _ => {
            let error = record.error(field.start, ErrorKind::NotANumber { found, what });
            match (dialect.decimal, field.raw.contains(','), field.raw.contains('.')) {
                ('.', true, _) => error.with_hint("if commas are decimal marks, say --decimal ,"),
                (',', _, true) => error.with_hint("if points are decimal marks, say --decimal ."),
                _ => error,
            }
        }
    }
}

/// A record without numbers and with the cells of the data.
fn is_text_line(record: &Record<'_>, dialect: Dialect, width: usize) -> bool {
    let mut cells = 0;
    let mut first_is_text = true;
    for field in split(record.text, dialect.separator) {
        first_is_text &= cells > 0 || number::parse(field.raw, dialect.decimal).number().is_none();
        cells += 1;
    }
    first_is_text && cells == width
}

/// `nm;W/m²/nm` or `[nm],[a.u.],`: nothing but units.
fn is_unit_line(record: &Record<'_>, dialect: Dialect, axis_cell: usize) -> bool {
    split(record.text, dialect.separator).enumerate().all(|(cell, field)| {
        let text = field.text();
        if cell == axis_cell {
            return matches!(header::axis(&text), Some(AxisUnit::Stated(_))) && text.len() < 16;
        }
        text.is_empty() || header::axis(&text).is_some() || !matches!(header::unit(&text), UnitText::Other)
    })
}

fn is_heading(comment: Record<'_>, dialect: Dialect, width: usize) -> bool {
    let mut cells = split(comment.text, dialect.separator);
    cells.next().is_some_and(|f| header::axis(&f.text()).is_some()) && cells.count() + 1 == width
}

/// Which cells are wavelengths and which are values. A wavelength column governs the columns after it up to the next one.
fn plan(
    heading: Option<Record<'_>>,
    first: Location,
    width: usize,
    dialect: Dialect,
    findings: &mut Vec<Finding>,
) -> (Vec<AxisColumn>, Vec<Column>) {
    let mut axes: Vec<AxisColumn> = Vec::new();
    let mut columns = Vec::new();
    let new_axis = |cell, unit, place| AxisColumn { cell, unit, place, axis: Axis::default(), rows: Vec::new() };
    let Some(record) = heading else {
        let column = |cell| Column {
            cell,
            heading: ValueHeading::default(),
            place: first.clone(),
            axis: 0,
            uncertainty: false,
            values: Vec::new(),
        };
        axes.push(new_axis(0, AxisUnit::NotStated, first.clone()));
        return (axes, (1..width).map(column).collect());
    };
    let fields: Vec<_> = split(record.text, dialect.separator).collect();
    let mut places = Places::new(record.text, record.line);
    let units: Vec<Option<AxisUnit>> = fields.iter().map(|f| header::axis(&f.text())).collect();
    // A lone wavelength column at the end governs the columns before it; without any, the first column is one.
    let lone_last = units.iter().rposition(Option::is_some) == Some(fields.len() - 1)
        && units.iter().filter(|u| u.is_some()).count() == 1;
    if lone_last || units.iter().all(Option::is_none) {
        let cell = if lone_last { fields.len() - 1 } else { 0 };
        axes.push(new_axis(cell, units[cell].clone().unwrap_or(AxisUnit::NotStated), record.place(fields[cell].start)));
    }
    let lone = !axes.is_empty();
    for (cell, (field, unit)) in fields.iter().zip(units).enumerate() {
        if lone && cell == axes[0].cell {
            continue;
        }
        let place = places.of(field.start);
        if let Some(unit) = unit {
            axes.push(new_axis(cell, unit, place));
            continue;
        }
        let Some(axis) = axes.len().checked_sub(1) else {
            let message = format!("the column `{}` before the wavelengths was not read", field.text());
            findings.push(Finding::info("S009", message).at(place));
            continue;
        };
        let follows = columns.last().is_some_and(|c: &Column| c.axis == axis && !c.uncertainty);
        let uncertainty = follows && header::is_uncertainty(&field.text());
        if uncertainty {
            let message =
                format!("the column `{}` holds the standard uncertainties of the one before it", field.text());
            let hint = "a budget uses it with [[noise]] column = true";
            findings.push(Finding::info("S019", message).at(place.clone()).hint(hint));
        }
        let heading = header::value(&field.text());
        if let Some(unit) = heading.not_understood.as_ref().filter(|_| !uncertainty) {
            let finding =
                Finding::warning("S006", format!("`{unit}` is no unit of a spectrum that is understood here"));
            findings.push(finding.at(place.clone()).hint("say the unit with --unit"));
        }
        columns.push(Column { cell, heading, place, axis, uncertainty, values: Vec::new() });
    }
    (axes, columns)
}

fn apply_units(
    record: &Record<'_>,
    dialect: Dialect,
    axes: &mut [AxisColumn],
    columns: &mut [Column],
) -> Result<(), Error> {
    let fields: Vec<_> = split(record.text, dialect.separator).collect();
    for axis in axes {
        let Some(field) = fields.get(axis.cell) else { continue };
        let stated = header::axis(&field.text()).unwrap_or(AxisUnit::NotStated);
        if let (AxisUnit::Stated(above), AxisUnit::Stated(here)) = (&axis.unit, &stated)
            && above != here
        {
            let found = format!("wavelengths in {} under a heading in {}", here.symbol(), above.symbol());
            return Err(record.error(field.start, ErrorKind::Ambiguous { found }));
        }
        if stated != AxisUnit::NotStated {
            axis.unit = stated;
        }
    }
    for column in columns {
        match fields.get(column.cell).map(|f| header::unit(&f.text())) {
            Some(UnitText::Unit(unit)) => column.heading.unit = Some(unit),
            Some(UnitText::Dimensionless) => column.heading.quantity = Some(Quantity::Relative),
            Some(UnitText::Other) | None => {}
        }
    }
    Ok(())
}

fn read_record(
    record: &Record<'_>,
    index: usize,
    dialect: Dialect,
    axes: &mut [AxisColumn],
    columns: &mut [Column],
) -> Result<(), Error> {
    let fields: Vec<Field<'_>> = split(record.text, dialect.separator).collect();
    let width = axes.iter().map(|a| a.cell).chain(columns.iter().map(|c| c.cell)).max().unwrap_or(0) + 1;
    if let Some(extra) = fields.iter().skip(width).find(|f| !f.raw.is_empty()) {
        let kind = ErrorKind::TooManyColumns { found: fields.len(), expected: width };
        let error = record.error(extra.start, kind);
        return Err(match dialect.decimal {
            '.' => error.with_hint("if commas are decimal marks, say --decimal , and --separator"),
            _ => error,
        });
    }
    let several = axes.len() > 1;
    let mut has_row = vec![false; axes.len()];
    for (axis, has_row) in axes.iter_mut().zip(&mut has_row) {
        let Some(field) = fields.get(axis.cell) else {
            if several {
                continue;
            }
            let kind = ErrorKind::MissingColumn { found: fields.len(), expected: width };
            return Err(record.error(record.text.len(), kind));
        };
        match number::parse(field.raw, dialect.decimal) {
            Cell::Number(value) => {
                axis.axis.push(value, record.line, || record.place(field.start))?;
                axis.rows.push(index);
                *has_row = true;
            }
            // Of several pairs of columns one may end before the others.
            Cell::Missing if several => {}
            _ => return Err(cell_error(record, field, dialect, "wavelength")),
        }
    }
    for column in columns {
        let cell = fields.get(column.cell).map(|f| (f, number::parse(f.raw, dialect.decimal)));
        match cell {
            Some((_, Cell::Number(value))) if has_row[column.axis] => column.values.push(value),
            None | Some((_, Cell::Missing)) if has_row[column.axis] => column.values.push(f64::NAN),
            None | Some((_, Cell::Missing)) => {}
            Some((field, Cell::Number(_))) => return Err(cell_error_without_wavelength(record, field)),
            Some((field, _)) => return Err(cell_error(record, field, dialect, "value")),
        }
    }
    Ok(())
}

fn cell_error_without_wavelength(record: &Record<'_>, field: &Field<'_>) -> Error {
    let kind = ErrorKind::Unexpected {
        found: format!("the value `{}` without a wavelength", field.raw),
        expected: "both".to_owned(),
    };
    record.error(field.start, kind)
}

/// Makes entries of what was read.
struct Assembly<'a, 'f> {
    records: &'a [Record<'a>],
    dialect: Dialect,
    options: &'a ReadOptions,
    findings: &'f mut Vec<Finding>,
}

/// The grid of some of the rows of a wavelength column.
struct Shared {
    axis: usize,
    rows: std::ops::Range<usize>,
    grid: Arc<Grid>,
}

impl Assembly<'_, '_> {
    fn entries(mut self, axes: Vec<AxisColumn>, columns: Vec<Column>) -> Result<Vec<Entry>, Error> {
        let mut nanometres = Vec::with_capacity(axes.len());
        for axis in &axes {
            let unit = axis::unit(&axis.unit, self.options.wavelength_unit, &axis.place, self.findings)?;
            nanometres.push(axis.axis.nanometres(unit));
            if axis.axis.descends() {
                self.findings.push(axis::reversed(axis.place.clone()));
            }
        }
        // Grids of the wavelength column at hand, and the first of all: another column often holds the same wavelengths.
        let mut shared: Vec<Shared> = Vec::new();
        let mut first: Option<Arc<Grid>> = None;
        let mut entries = Vec::with_capacity(columns.len());
        for column in columns {
            let axis = &axes[column.axis];
            let Some(rows) = self.rows_of(axis, &column)? else { continue };
            let total = column.values.len();
            let mut values = column.values;
            values.truncate(rows.end);
            values.drain(..rows.start);
            // In nm and ascending, what was first may be last.
            let rows = if axis.axis.descends() {
                values.reverse();
                total - rows.end..total - rows.start
            } else {
                rows
            };
            shared.retain(|s| s.axis == column.axis);
            let known = shared.iter().find(|s| s.rows == rows).map(|s| Arc::clone(&s.grid));
            let grid = match known {
                Some(grid) => grid,
                None => {
                    let grid = axis::grid(nanometres[column.axis][rows.clone()].to_vec(), &axis.place)?;
                    let grid = first.iter().find(|f| ***f == *grid).map_or(grid, Arc::clone);
                    shared.push(Shared { axis: column.axis, rows, grid: Arc::clone(&grid) });
                    grid
                }
            };
            first.get_or_insert_with(|| Arc::clone(&grid));
            let location = column.place;
            if column.uncertainty {
                let of = entries.last_mut().filter(|e: &&mut Entry| Arc::ptr_eq(e.spectrum.grid(), &grid));
                match of.filter(|_| values.iter().all(|u| *u >= 0.0)) {
                    Some(entry) => entry.standard = Some(values),
                    None => {
                        let message = format!(
                            "the column `{}` was not read: standard uncertainties are not negative and as many as the samples before them",
                            column.heading.name
                        );
                        self.findings.push(Finding::warning("S009", message).at(location));
                    }
                }
                continue;
            }
            let ValueHeading { name, quantity, unit, .. } = column.heading;
            let spectrum = Spectrum::density(grid, values).map_err(|e| Error::new(location.clone(), e))?;
            entries.push(Entry {
                name,
                spectrum,
                standard: None,
                quantity,
                unit,
                printed: Vec::new(),
                metadata: Vec::new(),
                location,
            });
        }
        if entries.is_empty() {
            let line = self.records.last().map_or(1, |r| r.line);
            return Err(Error::at(line, 1, ErrorKind::NoSpectrum { expected: "at least one column of values" }));
        }
        Ok(entries)
    }

    /// The rows that a column has values in; `None` for a column without any.
    fn rows_of(&mut self, axis: &AxisColumn, column: &Column) -> Result<Option<std::ops::Range<usize>>, Error> {
        let values = &column.values;
        let name = &column.heading.name;
        let Some(first) = values.iter().position(|v| !v.is_nan()) else {
            // Separators at the ends of lines make a column without name and values: nothing is lost with it.
            if !name.is_empty() {
                let finding = Finding::warning("S009", format!("the column `{name}` holds no value and was not read"));
                self.findings.push(finding.at(column.place.clone()));
            }
            return Ok(None);
        };
        let end = values.iter().rposition(|v| !v.is_nan()).map_or(first, |last| last + 1);
        if let Some(gap) = values[first..end].iter().position(|v| v.is_nan()) {
            return Err(self.gap(axis.rows[first + gap], column));
        }
        if end - first < values.len() {
            let message = format!(
                "{} of {} wavelengths have no value; the spectrum is shorter than the table",
                values.len() - (end - first),
                values.len()
            );
            let line = self.records[axis.rows[if first > 0 { 0 } else { end }]].line;
            self.findings.push(Finding::warning("S004", message).at(item(Location::line(line), name)));
        }
        Ok(Some(first..end))
    }

    fn gap(&self, row: usize, column: &Column) -> Error {
        let record = &self.records[row];
        let count = split(record.text, self.dialect.separator).count();
        match split(record.text, self.dialect.separator).nth(column.cell) {
            Some(field) => {
                let kind = ErrorKind::MissingValue { found: field.raw.to_owned(), name: column.heading.name.clone() };
                record.error(field.start, kind).with_hint("delete the row, or fill in a value you can answer for")
            }
            None => record
                .error(record.text.len(), ErrorKind::MissingColumn { found: count, expected: column.cell + 1 })
                .with_hint("delete the row, or fill in a value you can answer for"),
        }
    }
}

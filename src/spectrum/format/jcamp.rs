//! JCAMP-DX 4.24 and 5: labelled records `##LABEL=value`, spectra as `##XYDATA=(X++(Y..Y))` or `##XYPOINTS=(XY..XY)`.
//!
//! An axis in wavenumbers (1/CM) becomes wavelengths by λ = 10⁷/ν nm. What that does to the values depends on what they are:
//! ratios and densities per wavelength stay; a density per wavenumber, `…/cm-1`, is multiplied by |dν/dλ| = ν²/10⁷; of values
//! in no stated unit nobody can tell, and they are refused.

use super::super::{Per, Quantity, SpectralUnit, WavelengthUnit};
use super::asdf::{self, Line, Point};
use super::error::{Error, ErrorKind};
use super::header::{self, AxisUnit, UnitText};
use super::instrument::{self, Samples};
use super::text::place;
use super::{Entry, Format, ReadOptions, SpectrumFile};
use crate::finding::{Checked, Finding, Location};

/// Whether a text is such a file.
pub(super) fn matches(head: &str) -> bool {
    let first = head.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with("$$"));
    first.is_some_and(|line| line.starts_with("##") && line.contains('='))
}

/// Points at most, whatever count the file states: compressed tables claim many in few bytes.
const MOST_POINTS: u64 = 10_000_000;

/// A labelled data record.
struct Record<'a> {
    /// Label without blanks, `-`, `/`, `_`, upper case, as the standard compares them.
    label: String,
    written: &'a str,
    value: &'a str,
    /// Where the value begins.
    place: Location,
    lines: Vec<Line<'a>>,
}

fn records(text: &str) -> Vec<Record<'_>> {
    let mut records: Vec<Record<'_>> = Vec::new();
    for (number, raw) in (1u64..).zip(text.lines()) {
        let line = raw.split("$$").next().unwrap_or(raw);
        let begins = line.trim_start().strip_prefix("##").and_then(|rest| rest.split_once('='));
        if let Some((written, value)) = begins {
            let label =
                written.chars().filter(|c| !matches!(c, ' ' | '-' | '/' | '_')).collect::<String>().to_uppercase();
            let trimmed = value.trim_start();
            let place = place(line, number, line.len() - trimmed.len());
            records.push(Record {
                label,
                written: written.trim(),
                value: trimmed.trim_end(),
                place,
                lines: Vec::new(),
            });
        } else if let Some(record) = records.last_mut()
            && !line.trim().is_empty()
        {
            record.lines.push(Line { number, text: line });
        }
    }
    records
}

pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Checked<SpectrumFile>, Error> {
    let records = records(text);
    let mut entries = Vec::new();
    let mut findings = Vec::new();
    let mut start = 0;
    for (at, record) in records.iter().enumerate() {
        match record.label.as_str() {
            "TITLE" => start = at,
            "XYDATA" | "XYPOINTS" => {
                let end = records[at..].iter().position(|r| matches!(r.label.as_str(), "TITLE" | "END"));
                let end = end.map_or(records.len(), |n| at + n);
                let block = Block { records: &records[start..end], data: record, options };
                entries.push(block.entry(&mut findings)?);
            }
            "PEAKTABLE" | "PEAKASSIGNMENTS" | "NTUPLES" | "RADATA" | "DATATABLE" => {
                let kind = ErrorKind::Unsupported {
                    found: format!("##{}", record.written),
                    expected: "##XYDATA or ##XYPOINTS",
                };
                return Err(Error::new(record.place.clone(), kind));
            }
            _ => {}
        }
    }
    if entries.is_empty() {
        let expected = "##XYDATA=(X++(Y..Y)) or ##XYPOINTS=(XY..XY)";
        return Err(Error::at(text.lines().count().max(1) as u64, 1, ErrorKind::NoSpectrum { expected }));
    }
    Ok(Checked { value: SpectrumFile { format: Format::Jcamp, entries, metadata: Vec::new() }, findings })
}

/// The records of one spectrum.
struct Block<'a> {
    records: &'a [Record<'a>],
    data: &'a Record<'a>,
    options: &'a ReadOptions,
}

/// What an axis in wavenumbers does to the values.
enum Values {
    AsTheyAre,
    PerWavenumber,
}

impl Block<'_> {
    fn get(&self, label: &str) -> Option<&Record<'_>> {
        self.records.iter().find(|r| r.label == label)
    }

    fn number(&self, label: &str) -> Result<Option<f64>, Error> {
        let Some(record) = self.get(label) else { return Ok(None) };
        instrument::number(record.value, '.', "record", || record.place.clone()).map(Some)
    }

    fn factor(&self, label: &str) -> Result<f64, Error> {
        match self.number(label)? {
            Some(0.0) => {
                let place = self.get(label).map(|r| r.place.clone()).unwrap_or_default();
                let kind =
                    ErrorKind::Unexpected { found: "a factor of 0".to_owned(), expected: "another number".to_owned() };
                Err(Error::new(place, kind))
            }
            factor => Ok(factor.unwrap_or(1.0)),
        }
    }

    fn count(&self) -> Result<Option<u64>, Error> {
        let Some(record) = self.get("NPOINTS") else { return Ok(None) };
        let kind = || ErrorKind::NotANumber { found: record.value.to_owned(), what: "count" };
        let count = record.value.parse().map_err(|_| Error::new(record.place.clone(), kind()))?;
        if count > MOST_POINTS {
            let found = format!("{count} points");
            let kind = ErrorKind::Unexpected { found, expected: format!("at most {MOST_POINTS}") };
            return Err(Error::new(record.place.clone(), kind));
        }
        Ok(Some(count))
    }

    fn entry(&self, findings: &mut Vec<Finding>) -> Result<Entry, Error> {
        let mut points = self.points()?;
        let found = points.len() as u64;
        if let Some(stated) = self.count()?.filter(|stated| *stated != found) {
            let place = points.last().map_or(self.data.place.clone(), Point::place);
            return Err(Error::new(place, ErrorKind::CountMismatch { what: "points", stated, found }));
        }
        self.check_figures(&points, findings)?;
        let (mut quantity, mut unit, per_wavenumber) = self.y_units(findings);
        let stated = match self.get("XUNITS").map(|r| (r.value.to_uppercase(), r.value)) {
            None => AxisUnit::NotStated,
            Some((upper, written)) => match upper.as_str() {
                "NANOMETERS" | "NANOMETRES" | "NANOMETER" | "NM" => AxisUnit::Stated(WavelengthUnit::Nanometre),
                "MICROMETERS" | "MICROMETRES" | "MICROMETER" | "MICRONS" | "UM" => {
                    AxisUnit::Stated(WavelengthUnit::Micrometre)
                }
                "ANGSTROMS" | "ANGSTROM" => AxisUnit::Stated(WavelengthUnit::Angstrom),
                "1/CM" | "CM-1" | "CM^-1" if self.options.wavelength_unit.is_none() => {
                    let values = self.wavenumber_values(quantity, unit.as_ref(), per_wavenumber.as_ref())?;
                    if let (Values::PerWavenumber, Some(base)) = (&values, per_wavenumber.clone()) {
                        quantity = Some(base.quantity);
                        unit = Some(base);
                    }
                    self.to_wavelengths(&mut points, &values, findings)?;
                    AxisUnit::Stated(WavelengthUnit::Nanometre)
                }
                _ => AxisUnit::Unknown(written.to_owned()),
            },
        };
        let mut samples = Samples::default();
        for point in points {
            samples.push(point.x, point.y, point.line, || point.place())?;
        }
        if samples.values.is_empty() {
            return Err(Error::new(self.data.place.clone(), ErrorKind::NoSpectrum { expected: "points in the table" }));
        }
        let units = self.get("XUNITS").map_or_else(|| samples.place.clone(), |r| r.place.clone());
        let spectrum = samples.spectrum(&stated, &units, self.options, findings)?;
        let others =
            self.records.iter().filter(|r| !matches!(r.label.as_str(), "XYDATA" | "XYPOINTS" | "TITLE" | "END"));
        let metadata = others.map(|r| {
            let lines = std::iter::once(r.value).chain(r.lines.iter().map(|l| l.text.trim()));
            (r.written.to_owned(), lines.filter(|l| !l.is_empty()).collect::<Vec<_>>().join(" "))
        });
        Ok(Entry {
            name: self.get("TITLE").map(|r| r.value.to_owned()).unwrap_or_default(),
            spectrum,
            standard: None,
            quantity,
            unit,
            printed: Vec::new(),
            metadata: metadata.collect(),
            location: self.data.place.clone(),
        })
    }

    fn points(&self) -> Result<Vec<Point>, Error> {
        let form: String = self.data.value.chars().filter(|c| !c.is_whitespace()).collect();
        let most = self.count()?.unwrap_or(MOST_POINTS);
        let (x_factor, y_factor) = (self.factor("XFACTOR")?, self.factor("YFACTOR")?);
        match (self.data.label.as_str(), form.to_uppercase().as_str()) {
            ("XYPOINTS", "(XY..XY)") => {
                let pairs = asdf::pairs(&self.data.lines, most)?;
                let scaled = |p: Point| Point { x: p.x * x_factor, y: p.y * y_factor, ..p };
                Ok(pairs.into_iter().map(scaled).collect())
            }
            ("XYDATA", "(X++(Y..Y))") => self.evenly_spaced(most, x_factor, y_factor),
            (label, _) => {
                let expected = if label == "XYDATA" { "(X++(Y..Y))" } else { "(XY..XY)" };
                let kind = ErrorKind::Unsupported { found: format!("the form {}", self.data.value), expected };
                Err(Error::new(self.data.place.clone(), kind))
            }
        }
    }

    fn evenly_spaced(&self, most: u64, x_factor: f64, y_factor: f64) -> Result<Vec<Point>, Error> {
        let table = asdf::ordinates(&self.data.lines, most)?;
        let count = table.values.len();
        let Some(start) = table.abscissas.first() else { return Ok(Vec::new()) };
        let first = self.number("FIRSTX")?.unwrap_or(start.value * x_factor);
        let step = match (self.number("LASTX")?, self.number("DELTAX")?) {
            // The stated count, not the one met: a table cut short must not be stretched.
            (Some(last), _) if count > 1 => (last - first) / (self.count()?.unwrap_or(count as u64) as f64 - 1.0),
            (_, Some(step)) => step,
            (None, None) if count > 1 => {
                let kind = ErrorKind::Unexpected {
                    found: "no ##LASTX".to_owned(),
                    expected: "##FIRSTX, ##LASTX and ##NPOINTS".to_owned(),
                };
                return Err(Error::new(self.data.place.clone(), kind));
            }
            _ => 0.0,
        };
        let x = |index: usize| first + step * index as f64;
        for abscissa in &table.abscissas {
            let found = abscissa.value * x_factor;
            // Abscissas in the table are rounded; half a step tells a point too many or too few.
            let tolerance = (0.5 * step.abs()).max(0.5 * abscissa.digit * x_factor.abs());
            let fits = |index| (found - x(index)).abs() <= tolerance;
            if count > 1 && !fits(abscissa.index) && !(abscissa.checked && fits(abscissa.index + 1)) {
                let kind = ErrorKind::CheckMismatch { what: "abscissa", found, expected: x(abscissa.index) };
                let error = Error::at(abscissa.line, abscissa.column, kind);
                return Err(error.with_hint("an ordinate is missing or too many on the lines before"));
            }
        }
        let points = table.values.iter().zip(&table.lines).enumerate();
        Ok(points.map(|(i, (y, line))| Point { x: x(i), y: y * y_factor, line: *line, column: 1 }).collect())
    }

    /// The first, largest and smallest value that the file states.
    fn check_figures(&self, points: &[Point], findings: &mut Vec<Finding>) -> Result<(), Error> {
        let resolution = self.factor("YFACTOR")?.abs();
        let values = || points.iter().map(|p| p.y);
        let figures =
            [("FIRSTY", values().next()), ("MAXY", values().reduce(f64::max)), ("MINY", values().reduce(f64::min))];
        for (label, found) in figures {
            let (Some(record), Some(found)) = (self.get(label), found) else { continue };
            let stated = instrument::number(record.value, '.', "record", || record.place.clone())?;
            if (stated - found).abs() > (1e-3 * stated.abs().max(found.abs())).max(resolution) {
                let message = format!("##{label} is {stated}, the table has {found}");
                findings.push(Finding::warning("S017", message).at(record.place.clone()));
            }
        }
        Ok(())
    }

    /// Quantity and unit that `##YUNITS` states; last the unit per nm of a density per wavenumber.
    fn y_units(&self, findings: &mut Vec<Finding>) -> (Option<Quantity>, Option<SpectralUnit>, Option<SpectralUnit>) {
        let Some(record) = self.get("YUNITS") else { return (None, None, None) };
        const RATIOS: [&str; 6] =
            ["TRANSMITTANCE", "REFLECTANCE", "ABSORBANCE", "KUBELKA-MUNK", "EMISSIVITY", "RESPONSIVITY"];
        let upper = record.value.to_uppercase();
        if RATIOS.iter().any(|word| upper.contains(word)) {
            return (Some(Quantity::Relative), None, None);
        }
        let quantity = header::quantity(record.value);
        let lower = record.value.to_lowercase();
        let per_wavenumber =
            ["/cm-1", "/cm^-1", "/cm⁻¹", "/(cm-1)", "/(1/cm)"].iter().find(|end| lower.ends_with(**end));
        if let Some(base) = per_wavenumber.and_then(|end| record.value.get(..record.value.len() - end.len())) {
            return (quantity, None, parse_unit(&format!("{base}/nm")));
        }
        match parse_unit(record.value) {
            Some(unit) => (quantity, Some(unit), None),
            // `ARBITRARY UNITS` and `COUNTS` state that there is no unit, not what the values are per.
            None if matches!(header::unit(record.value), UnitText::Dimensionless) => (None, None, None),
            None => {
                let message = format!("`{}` is no unit of a spectrum that is understood here", record.value);
                findings
                    .push(Finding::warning("S006", message).at(record.place.clone()).hint("say the unit with --unit"));
                (quantity, None, None)
            }
        }
    }

    fn wavenumber_values(
        &self,
        quantity: Option<Quantity>,
        unit: Option<&SpectralUnit>,
        per_wavenumber: Option<&SpectralUnit>,
    ) -> Result<Values, Error> {
        if per_wavenumber.is_some() {
            return Ok(Values::PerWavenumber);
        }
        if quantity == Some(Quantity::Relative) || unit.is_some_and(|u| u.per == Per::Wavelength) {
            return Ok(Values::AsTheyAre);
        }
        let place = self.get("XUNITS").map(|r| r.place.clone()).unwrap_or_default();
        let found = "an axis in wavenumbers with values of which is not stated what they are per".to_owned();
        let expected = "a ratio, or YUNITS per wavelength (W/m2/nm) or per wavenumber (W/m2/cm-1)";
        let error = Error::new(place, ErrorKind::Unsupported { found, expected });
        Err(error.with_hint("convert the file to wavelengths: a density per wavenumber changes with the axis"))
    }

    fn to_wavelengths(&self, points: &mut [Point], values: &Values, findings: &mut Vec<Finding>) -> Result<(), Error> {
        for point in &mut *points {
            let wavenumber = point.x;
            if wavenumber <= 0.0 {
                return Err(Error::new(point.place(), ErrorKind::NotPositive { found: wavenumber }));
            }
            point.x = 1e7 / wavenumber;
            if matches!(values, Values::PerWavenumber) {
                point.y *= wavenumber * wavenumber / 1e7;
            }
        }
        let effect = match values {
            Values::AsTheyAre => "values unchanged, as they are ratios or densities per wavelength",
            Values::PerWavenumber => "densities per cm-1 multiplied by ν²/10⁷ to be per nm",
        };
        let place = self.get("XUNITS").map(|r| r.place.clone()).unwrap_or_default();
        findings.push(
            Finding::info("S015", format!("wavenumbers ν converted to wavelengths 10⁷/ν nm; {effect}")).at(place),
        );
        Ok(())
    }
}

/// A unit as written, or in the capitals that JCAMP-DX files use: `W/M2/NM`.
fn parse_unit(text: &str) -> Option<SpectralUnit> {
    let unit = |text: &str| match header::unit(text) {
        UnitText::Unit(unit) => Some(unit),
        _ => None,
    };
    let capitals = !text.contains(|c: char| c.is_ascii_lowercase());
    // Capitals hide whether `MW` is milli or mega: no prefix before W is guessed.
    unit(text)
        .or_else(|| capitals.then(|| unit(&text.replace("NM", "nm").replace("M2", "m2").replace("SR", "sr"))).flatten())
}

//! Ocean Optics OceanView and SpectraSuite text files.
//!
//! `key: value` lines up to one with `>>>>>Begin Spectral Data<<<<<`, then wavelength and value per line, up to the end or to
//! `>>>>>End …`. Values are counts unless the file says otherwise, and it has no fixed place to say so: a unit is taken from a key
//! such as `YAxis mode` or `Units` where there is one.

use super::super::WavelengthUnit;
use super::error::{Error, ErrorKind};
use super::field::{Separator, split};
use super::header::{self, AxisUnit, UnitText};
use super::instrument::{self, Samples};
use super::text::place;
use super::{Entry, Format, ReadOptions, SpectrumFile};
use crate::finding::{Checked, Location};

/// The key that says what the axis holds.
const X_AXIS: &str = "XAxis mode";

fn is_begin(line: &str) -> bool {
    line.contains(">>>>>Begin")
}

/// Whether a text is such a file.
pub(super) fn matches(head: &str) -> bool {
    head.lines().any(is_begin)
}

pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Checked<SpectrumFile>, Error> {
    let mut metadata = Vec::new();
    let mut lines = (1u64..).zip(text.lines());
    let mut begun = false;
    for (_, line) in lines.by_ref() {
        if is_begin(line) {
            begun = true;
            break;
        }
        let line = line.trim_start_matches(['#', ' ', '\t']).trim();
        // `Data from NAME Node` has no colon of its own.
        if let Some(name) = line.strip_prefix("Data from ").and_then(|rest| rest.strip_suffix(" Node")) {
            metadata.push(("Data from".to_owned(), name.to_owned()));
        } else if let Some((key, value)) = line.split_once(':') {
            metadata.push((key.trim().to_owned(), value.trim().to_owned()));
        } else if line.contains(char::is_alphanumeric) {
            metadata.push((String::new(), line.to_owned()));
        }
    }
    if !begun {
        let kind =
            ErrorKind::Unexpected { found: "no such line".into(), expected: ">>>>>Begin Spectral Data<<<<<".into() };
        return Err(Error::at(text.lines().count().max(1) as u64, 1, kind));
    }
    let body: Vec<(u64, &str)> =
        lines.take_while(|(_, line)| !line.contains(">>>>>End")).filter(|(_, line)| !line.trim().is_empty()).collect();
    let samples = samples(&body, options)?;
    if samples.values.is_empty() {
        let line = text.lines().count() as u64;
        return Err(Error::at(line, 1, ErrorKind::NoSpectrum { expected: "lines of wavelength and value" }));
    }
    let found = samples.values.len() as u64;
    if let Some(stated) = pixels(&metadata).filter(|stated| *stated != found) {
        let line = body.last().map_or(1, |(line, _)| *line);
        let kind = ErrorKind::CountMismatch { what: "samples", stated, found };
        return Err(Error::at(line, 1, kind).with_hint("the file may be cut off"));
    }
    let mut findings = Vec::new();
    let location = samples.place.clone();
    let units = text.lines().position(|line| line.contains(X_AXIS)).map_or(1, |line| line as u64 + 1);
    let spectrum = samples.spectrum(&axis_unit(&metadata), &Location::at(units, 1), options, &mut findings)?;
    let (quantity, unit) = y_axis(&metadata);
    let name = metadata.iter().find(|(key, _)| key == "Data from").map(|(_, name)| name.clone()).unwrap_or_default();
    let entry = Entry { name, spectrum, standard: None, quantity, unit, printed: Vec::new(), metadata, location };
    let file = SpectrumFile { format: Format::OceanView, entries: vec![entry], metadata: Vec::new() };
    Ok(Checked { value: file, findings })
}

fn samples(body: &[(u64, &str)], options: &ReadOptions) -> Result<Samples, Error> {
    let separator = match options.separator {
        Some(c) => Separator::from_char(c).unwrap_or(Separator::Blanks),
        None if body.first().is_some_and(|(_, line)| line.trim().contains([' ', '\t'])) => Separator::Blanks,
        None if body.first().is_some_and(|(_, line)| line.contains(';')) => Separator::Byte(b';'),
        None => Separator::Byte(b','),
    };
    let cells = body.iter().flat_map(|(_, line)| split(line, separator)).map(|f| f.raw);
    let decimal = instrument::decimal(cells, options);
    let mut samples = Samples::default();
    for (number, line) in body {
        let fields: Vec<_> = split(line, separator).collect();
        let at = |byte| place(line, *number, byte);
        match &fields[..] {
            [wavelength, value] => {
                let start = || at(wavelength.start);
                let nm = instrument::number(wavelength.raw, decimal, "wavelength", start)?;
                let value = instrument::number(value.raw, decimal, "value", || at(value.start))?;
                samples.push(nm, value, *number, start)?;
            }
            [_, _, third, ..] => {
                return Err(Error::new(
                    at(third.start),
                    ErrorKind::TooManyColumns { found: fields.len(), expected: 2 },
                ));
            }
            _ => return Err(Error::new(at(line.len()), ErrorKind::MissingColumn { found: fields.len(), expected: 2 })),
        }
    }
    Ok(samples)
}

/// The count that the file states.
fn pixels(metadata: &[(String, String)]) -> Option<u64> {
    metadata.iter().find(|(key, _)| key.starts_with("Number of Pixels")).and_then(|(_, value)| value.parse().ok())
}

/// Wavelengths are in nm, unless the file says that the axis holds something else.
fn axis_unit(metadata: &[(String, String)]) -> AxisUnit {
    match metadata.iter().find(|(key, _)| key == X_AXIS) {
        Some((_, mode)) if !mode.to_lowercase().starts_with("wavelength") => AxisUnit::Unknown(mode.clone()),
        _ => AxisUnit::Stated(WavelengthUnit::Nanometre),
    }
}

fn y_axis(metadata: &[(String, String)]) -> (Option<super::Quantity>, Option<super::SpectralUnit>) {
    let value = metadata.iter().find(|(key, _)| {
        let key = key.to_lowercase().replace([' ', '-'], "");
        key.starts_with("yaxis") || key == "units" || key == "unit"
    });
    let Some((_, text)) = value else { return (None, None) };
    let heading = header::value(text);
    match header::unit(text) {
        UnitText::Unit(unit) => (heading.quantity, Some(unit)),
        UnitText::Dimensionless => (Some(super::Quantity::Relative), None),
        UnitText::Other => (heading.quantity, heading.unit),
    }
}

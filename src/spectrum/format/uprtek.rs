//! UPRtek hand-held spectrometers (CV600, MK350 …): text files named `.xls`.
//!
//! Each line is a label, a TAB and a figure; samples have labels such as `380nm`. The unit of the samples is printed nowhere. It
//! is mW/(m²·nm): with it the samples add up to the printed LUX and IRR (W/m²), which is checked in every file.

use super::error::{Error, ErrorKind};
use super::instrument::{self, Defined, Facts, Samples};
use super::text::place;
use super::{Format, ReadOptions, SpectrumFile};
use crate::finding::Checked;

const DEFINED: Defined = Defined { unit: "mW/m2/nm", format: "UPRtek exports" };

/// Figures of the instrument, not of the light.
const SETTINGS: [&str; 2] = ["I-Time", "Serial Number"];

/// The wavelength of a sample's label.
fn sample(label: &str) -> Option<&str> {
    let number = label.strip_suffix("nm")?;
    number.starts_with(|c: char| c.is_ascii_digit()).then_some(number)
}

/// Whether a text is such a file.
pub(super) fn matches(head: &str) -> bool {
    head.lines().take(400).any(|line| line.split_once('\t').is_some_and(|(label, _)| sample(label.trim()).is_some()))
        && head.lines().any(|line| line.starts_with("Model Name\t") || line.starts_with("LUX\t"))
}

pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Checked<SpectrumFile>, Error> {
    let mut facts = Facts::default();
    let mut samples = Samples::default();
    let mut findings = Vec::new();
    let cells = text.lines().filter_map(|l| l.split_once('\t')).filter(|(l, _)| sample(l.trim()).is_some());
    let decimal = instrument::decimal(cells.map(|(_, value)| value), options);
    for (number, line) in (1..).zip(text.lines()) {
        let (label, value) = line.split_once('\t').unwrap_or((line, ""));
        let Some(wavelength) = sample(label.trim()) else {
            facts.add(label.trim(), value.trim(), &SETTINGS);
            continue;
        };
        let start = || place(line, number, 0);
        let value_start = || place(line, number, line.len() - value.trim_start().len());
        if value.trim().contains('\t') {
            let found = 1 + value.trim().split('\t').count();
            return Err(Error::new(value_start(), ErrorKind::TooManyColumns { found, expected: 2 }));
        }
        let wavelength = instrument::number(wavelength, decimal, "wavelength", start)?;
        let value = instrument::number(value.trim(), decimal, "value", value_start)?;
        samples.push(wavelength, value, number, start)?;
    }
    if samples.values.is_empty() {
        return Err(Error::whole(ErrorKind::NoSpectrum { expected: "lines such as 380nm, TAB, value" }));
    }
    let location = samples.place.clone();
    let spectrum = samples.in_nm(options, &mut findings)?;
    let name = facts.get("Memo").unwrap_or_default().to_owned();
    let entry = facts.entry(name, spectrum, &DEFINED, location, &mut findings);
    let file = SpectrumFile { format: Format::Uprtek, entries: vec![entry], metadata: Vec::new() };
    Ok(Checked { value: file, findings })
}

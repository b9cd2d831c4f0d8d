//! Sekonic C-700/C-7000/C-800 spectrometers: CSV with one label per line.
//!
//! Samples have labels such as `Spectral Data 380[nm]` and stand there twice, by 5 nm and by 1 nm: the finer block is read.
//! Their unit is printed nowhere. It is W/(m²·nm): with it the samples add up to the printed illuminance, which is checked in
//! every file.

use super::error::{Error, ErrorKind};
use super::field::{Separator, split};
use super::instrument::{self, Defined, Facts, Samples};
use super::text::place;
use super::{Format, ReadOptions, SpectrumFile};
use crate::finding::{Checked, Finding};

const DEFINED: Defined = Defined { unit: "W/m2/nm", format: "Sekonic exports" };

/// Figures of the instrument, not of the light.
const SETTINGS: [&str; 1] = ["Viewing Angle [°]"];

/// The wavelength of a sample's label.
fn sample(label: &str) -> Option<&str> {
    label.strip_prefix("Spectral Data ")?.split_once("[nm]").map(|(number, _)| number.trim())
}

/// Whether a text is such a file.
pub(super) fn matches(head: &str) -> bool {
    head.lines().any(|line| sample(line.trim_start_matches('"')).is_some())
}

pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Checked<SpectrumFile>, Error> {
    let mut facts = Facts::default();
    let mut blocks: Vec<Samples> = Vec::new();
    let mut findings = Vec::new();
    let separator = Separator::Byte(b',');
    for (number, line) in (1..).zip(text.lines()) {
        let mut cells = split(line, separator);
        let Some(label) = cells.next() else { continue };
        let Some(wavelength) = sample(label.raw) else {
            let values: Vec<_> = cells.map(|f| f.text().into_owned()).collect();
            facts.add(&label.text(), &values.join(", "), &SETTINGS);
            continue;
        };
        let Some(value) = cells.next() else {
            let kind = ErrorKind::MissingColumn { found: 1, expected: 2 };
            return Err(Error::new(place(line, number, line.len()), kind));
        };
        if let Some(extra) = cells.find(|f| !f.raw.is_empty()) {
            let kind = ErrorKind::TooManyColumns { found: split(line, separator).count(), expected: 2 };
            return Err(Error::new(place(line, number, extra.start), kind));
        }
        let start = || place(line, number, label.start);
        let wavelength = instrument::number(wavelength, '.', "wavelength", start)?;
        let value = instrument::number(value.raw, '.', "value", || place(line, number, value.start))?;
        // The next block begins anew at the first wavelength of the last one.
        let again = blocks.last().is_none_or(|block| block.values.len() > 1 && block.axis.values[0] == wavelength);
        if again {
            blocks.push(Samples::default());
        }
        if let Some(block) = blocks.last_mut() {
            block.push(wavelength, value, number, start)?;
        }
    }
    // The finest block; of equal ones the first.
    let best = (0..blocks.len()).rev().max_by_key(|at| blocks[*at].values.len());
    let Some(best) = best else {
        let expected = "lines such as Spectral Data 380[nm],value";
        return Err(Error::whole(ErrorKind::NoSpectrum { expected }));
    };
    let chosen = blocks.swap_remove(best);
    for other in &blocks {
        let message = format!(
            "the spectrum stands here again with {} samples; the one with {} was read",
            other.values.len(),
            chosen.values.len()
        );
        findings.push(Finding::info("S016", message).at(other.place.clone()));
        let line = other.place.line.unwrap_or_default();
        facts
            .metadata
            .push(("Other spectral block".to_owned(), format!("line {line}, {} samples", other.values.len())));
    }
    let location = chosen.place.clone();
    let spectrum = chosen.in_nm(options, &mut findings)?;
    let name = facts.get("Title").unwrap_or_default().to_owned();
    let entry = facts.entry(name, spectrum, &DEFINED, location, &mut findings);
    let file = SpectrumFile { format: Format::Sekonic, entries: vec![entry], metadata: Vec::new() };
    Ok(Checked { value: file, findings })
}

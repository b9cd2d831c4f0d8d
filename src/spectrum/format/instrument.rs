//! What the text exports of hand-held spectrometers have in common: label and figure per line, samples whose unit nobody
//! prints, and printed totals by which that unit can be checked.

use super::super::{SpectralUnit, Spectrum, WavelengthUnit};
use super::axis::{self, Axis};
use super::error::{Error, ErrorKind};
use super::header::AxisUnit;
use super::number::{self, Cell};
use super::rows::Negatives;
use super::{Entry, Printed, ReadOptions, printed};
use crate::constants::K_M;
use crate::finding::{Finding, Location};
use crate::tables;

/// A unit that follows from the format, with the format it follows from.
pub(super) struct Defined {
    pub unit: &'static str,
    pub format: &'static str,
}

/// How far a total may lie from the printed one: instruments round their figures and sum in their own way.
const TOLERANCE: f64 = 0.01;

/// The unit of a format's definition as long as the totals printed in the file do not contradict it, and the finding that
/// says so.
pub(super) fn checked_unit(
    defined: &Defined,
    spectrum: &Spectrum,
    figures: &[Printed],
    place: Location,
) -> (Option<SpectralUnit>, Finding) {
    // Units of formats are literals of this crate.
    let unit: Option<SpectralUnit> = defined.unit.parse().ok();
    let factor = unit.as_ref().map_or(1.0, |u| u.factor);
    let totals = [
        ("photopic.illuminance_lx", "K_m·∫E·V dλ", "lx", luminous(spectrum) * factor),
        ("radiometric.irradiance_w_per_m2", "∫E dλ", "W/m²", total(spectrum, |_| 1.0) * factor),
    ];
    let mut checks = Vec::new();
    let mut fits = true;
    for (key, formula, symbol, found) in totals {
        // A printed zero is met by any unit.
        let Some(figure) = figures.iter().find(|p| p.key == key && p.value != 0.0) else { continue };
        fits &= (found - figure.value).abs() <= TOLERANCE * figure.value.abs();
        checks.push(format!("{formula} = {found:.6} {symbol} for {} {} printed", figure.label, figure.text));
    }
    let claim = format!("spectral irradiance in {} by the definition of {}", defined.unit, defined.format);
    let finding = match (fits, checks.is_empty()) {
        (true, true) => Finding::info("S007", format!("{claim}; the file prints no total to check it by")),
        (true, false) => Finding::info("S007", format!("{claim}; checked: {}", checks.join(", "))),
        (false, _) => {
            Finding::warning("S008", format!("{claim} is contradicted: {}; no unit taken", checks.join(", ")))
                .hint("say --unit if you know it")
        }
    };
    (unit.filter(|_| fits), finding.at(place))
}

/// Trapezoidal sum over the samples with a weight over wavelength (nm): the rule by which the figures of instruments come out
/// to their last digits.
fn total(spectrum: &Spectrum, weight: impl Fn(f64) -> f64) -> f64 {
    let weighted = |i: usize| spectrum.values()[i] * weight(spectrum.wavelengths_nm()[i]);
    let intervals = spectrum.wavelengths_nm().windows(2).enumerate();
    intervals.map(|(i, nm)| (nm[1] - nm[0]) * (weighted(i) + weighted(i + 1)) / 2.0).sum()
}

/// Illuminance of samples in W/m²/nm, lx; V(λ) linear between its nanometres.
fn luminous(spectrum: &Spectrum) -> f64 {
    let Ok(table) = tables::get("photopic") else { return f64::NAN };
    let (nm, Some(v)) = (table.wavelengths_nm(), table.column("V")) else { return f64::NAN };
    K_M * total(spectrum, |wavelength| {
        let at = nm.partition_point(|n| *n < wavelength);
        if at == nm.len() || wavelength < nm[0] {
            return 0.0;
        }
        if nm[at] == wavelength || at == 0 {
            return v[at];
        }
        let t = (wavelength - nm[at - 1]) / (nm[at] - nm[at - 1]);
        v[at - 1] + t * (v[at] - v[at - 1])
    })
}

/// Samples on their way to a spectrum.
#[derive(Debug, Default)]
pub(super) struct Samples {
    pub axis: Axis,
    pub values: Vec<f64>,
    /// Where the first one stands.
    pub place: Location,
}

impl Samples {
    /// Adds a sample on a line; `place` is asked for the first one and for an error.
    pub(super) fn push(
        &mut self,
        wavelength: f64,
        value: f64,
        line: u64,
        place: impl Fn() -> Location,
    ) -> Result<(), Error> {
        if self.values.is_empty() {
            self.place = place();
        }
        self.axis.push(wavelength, line, place)?;
        self.values.push(value);
        Ok(())
    }

    /// The spectrum, its wavelengths in nm and ascending; `units` is where their unit stands.
    pub(super) fn spectrum(
        mut self,
        stated: &AxisUnit,
        units: &Location,
        options: &ReadOptions,
        findings: &mut Vec<Finding>,
    ) -> Result<Spectrum, Error> {
        let unit = axis::unit(stated, options.wavelength_unit, units, findings)?;
        if self.axis.descends() {
            self.values.reverse();
            findings.push(axis::reversed(self.place.clone()));
        }
        let grid = axis::grid(self.axis.nanometres(unit), &self.place)?;
        let mut negatives = Negatives::default();
        negatives.add(&self.values, || self.place.clone());
        findings.extend(negatives.finding());
        Spectrum::density(grid, self.values).map_err(|error| Error::new(self.place, error))
    }

    /// [`Samples::spectrum`] with wavelengths in nm, by format.
    pub(super) fn in_nm(self, options: &ReadOptions, findings: &mut Vec<Finding>) -> Result<Spectrum, Error> {
        let place = self.place.clone();
        self.spectrum(&AxisUnit::Stated(WavelengthUnit::Nanometre), &place, options, findings)
    }
}

/// A finite number, or the error that there is none.
pub(super) fn number(
    text: &str,
    decimal: char,
    what: &'static str,
    place: impl FnOnce() -> Location,
) -> Result<f64, Error> {
    match number::parse(text, decimal) {
        Cell::Number(value) => Ok(value),
        Cell::NotFinite => Err(Error::new(place(), ErrorKind::NotFinite { found: text.to_owned(), what })),
        Cell::Missing | Cell::Text => Err(Error::new(place(), ErrorKind::NotANumber { found: text.to_owned(), what })),
    }
}

/// The decimal mark of cells: the user's, else a comma where cells hold commas and no points.
pub(super) fn decimal<'a>(cells: impl Iterator<Item = &'a str>, options: &ReadOptions) -> char {
    if let Some(decimal) = options.decimal {
        return decimal;
    }
    let mut comma = false;
    for cell in cells {
        if cell.contains('.') {
            return '.';
        }
        comma |= cell.contains(',');
    }
    if comma { ',' } else { '.' }
}

/// Labelled lines of an instrument, sorted into figures and facts.
#[derive(Debug, Default)]
pub(super) struct Facts {
    pub printed: Vec<Printed>,
    pub metadata: Vec<(String, String)>,
}

impl Facts {
    /// Takes one line; `settings` are numbers that are no figures of the light.
    pub(super) fn add(&mut self, label: &str, text: &str, settings: &[&str]) {
        if text.is_empty() {
            return;
        }
        match printed::figure(label, text).filter(|_| !settings.contains(&label)) {
            Some(figure) => self.printed.push(figure),
            None => self.metadata.push((label.to_owned(), text.to_owned())),
        }
    }

    pub(super) fn get(&self, label: &str) -> Option<&str> {
        self.metadata.iter().find(|(l, _)| l == label).map(|(_, text)| text.as_str())
    }

    /// The entry of an instrument whose unit follows from its format.
    pub(super) fn entry(
        self,
        name: String,
        spectrum: Spectrum,
        defined: &Defined,
        place: Location,
        findings: &mut Vec<Finding>,
    ) -> Entry {
        let (unit, finding) = checked_unit(defined, &spectrum, &self.printed, place.clone());
        findings.push(finding);
        let quantity = unit.as_ref().map(|u| u.quantity);
        Entry {
            name,
            spectrum,
            standard: None,
            quantity,
            unit,
            printed: self.printed,
            metadata: self.metadata,
            location: place,
        }
    }
}

//! Wavelengths as a file lists them, on their way to a grid.

use std::sync::Arc;

use super::super::{Grid, WavelengthUnit};
use super::error::{Error, ErrorKind};
use super::header::AxisUnit;
use crate::finding::{Finding, Location};

/// Wavelengths below (above) which no file is about light: all of them there means another unit.
const PLAUSIBLE_NM: std::ops::RangeInclusive<f64> = 10.0..=100_000.0;

/// Wavelengths in file order and unit.
#[derive(Debug, Default)]
pub(super) struct Axis {
    pub values: Vec<f64>,
    lines: Vec<u64>,
}

impl Axis {
    /// Adds the next wavelength, which has to go on in the direction of the first two; `place` is asked only for an error.
    pub(super) fn push(&mut self, value: f64, line: u64, place: impl FnOnce() -> Location) -> Result<(), Error> {
        if value <= 0.0 {
            return Err(Error::new(place(), ErrorKind::NotPositive { found: value }));
        }
        if let [.., last] = self.values[..] {
            let onwards = value != last && (self.values.len() == 1 || (value < last) == self.descends());
            if !onwards {
                return Err(self.disorder(value, last, place()));
            }
        }
        self.values.push(value);
        self.lines.push(line);
        Ok(())
    }

    #[cold]
    fn disorder(&self, found: f64, previous: f64, location: Location) -> Error {
        match self.values.iter().position(|v| *v == found) {
            Some(at) => {
                let kind = ErrorKind::DuplicateWavelength { wavelength: found, first_line: self.lines[at] };
                Error::new(location, kind).with_hint("keep one of the two samples")
            }
            None => Error::new(location, ErrorKind::Unsorted { found, previous })
                .with_hint("sort the samples by wavelength"),
        }
    }

    /// Whether the wavelengths run from long to short.
    pub(super) fn descends(&self) -> bool {
        self.values.len() > 1 && self.values[1] < self.values[0]
    }

    /// The wavelengths in nm, ascending.
    pub(super) fn nanometres(&self, unit: WavelengthUnit) -> Vec<f64> {
        let mut nm: Vec<f64> = self.values.iter().map(|v| unit.to_nm(*v)).collect();
        if self.descends() {
            nm.reverse();
        }
        nm
    }
}

/// Checks that wavelengths (nm, ascending) are of light, and makes them a grid.
pub(super) fn grid(nm: Vec<f64>, location: &Location) -> Result<Arc<Grid>, Error> {
    if let (Some(&first), Some(&last)) = (nm.first(), nm.last())
        && (last < *PLAUSIBLE_NM.start() || first > *PLAUSIBLE_NM.end())
    {
        let kind = ErrorKind::ImplausibleWavelengths { first, last };
        return Err(
            Error::new(location.clone(), kind).with_hint("say the unit with --wavelength-unit (nm, um, m, angstrom)")
        );
    }
    Grid::new(nm).map(Arc::new).map_err(|error| Error::new(location.clone(), error))
}

/// Whether a number can be a wavelength in nm.
pub(super) fn is_plausible_nm(value: f64) -> bool {
    PLAUSIBLE_NM.contains(&value)
}

/// The unit of an axis: the user's word, else the file's, else nm, which is what files mean that state none.
pub(super) fn unit(
    stated: &AxisUnit,
    asked: Option<WavelengthUnit>,
    location: &Location,
    findings: &mut Vec<Finding>,
) -> Result<WavelengthUnit, Error> {
    match (stated, asked) {
        (AxisUnit::Stated(stated), Some(asked)) if *stated != asked => {
            let message =
                format!("wavelengths read in {} as asked; the file states {}", asked.symbol(), stated.symbol());
            findings.push(Finding::warning("S018", message).at(location.clone()));
            Ok(asked)
        }
        (AxisUnit::Stated(unit), _) => Ok(*unit),
        (_, Some(asked)) => Ok(asked),
        (AxisUnit::NotStated, None) => {
            let finding = Finding::info("S003", "the file states no unit of wavelength; nm taken by convention");
            findings.push(finding.at(location.clone()).hint("say another with --wavelength-unit"));
            Ok(WavelengthUnit::Nanometre)
        }
        (AxisUnit::Unknown(found), None) => {
            let kind =
                ErrorKind::UnknownUnit { found: found.clone(), expected: "wavelengths in nm, um, m or angstrom" };
            let hint = "convert the axis to wavelengths, or say its unit with --wavelength-unit";
            Err(Error::new(location.clone(), kind).with_hint(hint))
        }
    }
}

/// The finding that an axis ran from long to short.
pub(super) fn reversed(location: Location) -> Finding {
    Finding::info("S002", "wavelengths run from long to short; the samples were reversed").at(location)
}

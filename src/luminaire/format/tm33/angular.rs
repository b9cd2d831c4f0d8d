//! From the angular-spectral tables of a file to [`AngularSpectra`] of the luminaire as a whole.

use std::sync::Arc;

use super::super::error::{Error, ErrorKind};
use super::{AngularSpectral, Tm33, planes};
use crate::finding::Finding;
use crate::luminaire::{AngularSpectra, Distribution, transform};
use crate::spectrum::Grid;

/// More values than this in a sum over emitters with directions of their own are not made.
const MOST_VALUES: usize = 50_000_000;

impl Tm33 {
    /// The spectra by direction of all emitters added up; `None` where there are none, or, with a finding, where they are not
    /// those of the whole luminaire.
    pub(super) fn angular_spectra(&self, findings: &mut Vec<Finding>) -> Result<Option<AngularSpectra>, Error> {
        let tables: Vec<&AngularSpectral> = self.emitters.iter().filter_map(|e| e.angular_spectral.as_ref()).collect();
        let Some(first) = tables.first() else { return Ok(None) };
        let mut not_taken = |why: String| {
            let message = format!("the angular spectra were not taken: {why}");
            findings.push(Finding::warning("L316", message).at(first.location.clone()));
            Ok(None)
        };
        if tables.len() < self.emitters.len() {
            return not_taken(format!("{} of {} emitters have them", tables.len(), self.emitters.len()));
        }
        if tables.iter().any(|t| t.wavelengths_nm != first.wavelengths_nm) {
            return not_taken("the emitters' are of different wavelengths".to_owned());
        }
        let mut sums: Vec<Distribution> = Vec::with_capacity(first.wavelengths_nm.len());
        for wavelength in 0..first.wavelengths_nm.len() {
            let mut parts = Vec::with_capacity(tables.len());
            for table in tables.iter().filter_map(|t| t.at_wavelength(wavelength)) {
                // What there is to say of the angles was said of their sum over wavelength.
                parts.push(planes::distribution(&table, self.goniometer, &mut Vec::new())?);
            }
            let Some(sum) = transform::sum(&parts).map_err(|error| Error::new(first.location.clone(), error))? else {
                return Ok(None);
            };
            if sum.values().len().saturating_mul(first.wavelengths_nm.len()) > MOST_VALUES {
                return not_taken("the directions of all emitters together are too many".to_owned());
            }
            sums.push(sum);
        }
        let refused = |kind: ErrorKind| Error::new(first.location.clone(), kind);
        let grid = Grid::new(first.wavelengths_nm.clone()).map_err(|error| {
            refused(ErrorKind::OutOfRange {
                found: error.to_string(),
                field: "<AngularSpectral>".to_owned(),
                expected: "ascending wavelengths".to_owned(),
            })
        })?;
        AngularSpectra::new(Arc::new(grid), &sums).map(Some).map_err(|error| refused(error.into()))
    }
}

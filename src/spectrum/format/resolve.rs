//! From the file's numbers to SI per nanometre: what the file states, and the user's word.

use std::sync::Arc;

use super::super::quantity::UnitError;
use super::super::{Grid, Per, Quantity, Sampling, SpectralUnit, Spectrum};
use super::error::{Error, ErrorKind};
use super::{Entry, Measured, item};
use crate::finding::{Checked, Finding, Location};

/// How the samples of a file become SI per nm: worked out once, applied to each spectrum of the same file.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// What the samples are of.
    pub quantity: Quantity,
    /// The unit the samples are in; `None` for relative ones, which stay as they are.
    pub unit: Option<SpectralUnit>,
    /// What lies between the samples.
    pub sampling: Sampling,
}

/// The unit in which a quantity is taken where the user names only the quantity.
pub(super) fn si_per_nm(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Flux => "W/nm",
        Quantity::Intensity => "W/sr/nm",
        Quantity::Irradiance | Quantity::Exitance => "W/m2/nm",
        Quantity::Radiance => "W/m2/sr/nm",
        Quantity::Energy => "J/nm",
        Quantity::Exposure => "J/m2/nm",
        Quantity::Relative => "",
    }
}

fn same(a: &SpectralUnit, b: &SpectralUnit) -> bool {
    (a.factor, a.photons, a.quantity, a.per) == (b.factor, b.photons, b.quantity, b.per)
}

impl Scale {
    /// Settles quantity and unit of spectra with `samples` samples each, from what the file states and the user asks.
    ///
    /// # Errors
    /// [`ErrorKind::UnitMismatch`] where quantity and unit are of different dimensions.
    pub fn new(
        stated: (Option<Quantity>, Option<&SpectralUnit>),
        asked: (Option<Quantity>, Option<&SpectralUnit>),
        samples: usize,
        location: &Location,
    ) -> Result<Checked<Self>, Error> {
        let mut findings = Vec::new();
        let mut note = |finding: Finding| findings.push(finding.at(location.clone()));
        if let (Some(file), Some(user)) = (stated.1, asked.1)
            && !same(file, user)
        {
            note(Finding::warning("S013", format!("read in {} as asked; the file states {}", user.text, file.text)));
        }
        if let (Some(file), Some(user)) = (stated.0, asked.0)
            && file != user
        {
            note(Finding::warning("S013", format!("read as {user} as asked; the file states {file}")));
        }
        let chosen = asked.1.or(stated.1).cloned();
        let (quantity, unit) = match (asked.0, chosen) {
            (Some(Quantity::Relative), unit) => (Quantity::Relative, unit),
            (Some(quantity), Some(unit)) => (quantity, Some(fit(unit, quantity, asked.1.is_some(), location)?)),
            (Some(quantity), None) => {
                let text = si_per_nm(quantity);
                let message = format!("{quantity} as asked, without a unit: {text} taken");
                note(Finding::warning("S014", message).hint("say the unit with --unit"));
                (quantity, Some(text.parse().map_err(|e: UnitError| Error::new(location.clone(), e))?))
            }
            (None, Some(unit)) => match stated.0 {
                // A unit that the user gives settles what a relative file leaves open, and outvotes another quantity.
                Some(file) if asked.1.is_some() && fit(unit.clone(), file, true, location).is_err() => {
                    let message = format!("{} as the unit {} says; the file states {file}", unit.quantity, unit.text);
                    note(Finding::warning("S013", message));
                    (unit.quantity, Some(unit))
                }
                Some(Quantity::Relative) => (Quantity::Relative, Some(unit)),
                Some(file) => (file, Some(fit(unit, file, false, location)?)),
                None => (unit.quantity, Some(unit)),
            },
            (None, None) => {
                let message = match stated.0 {
                    Some(Quantity::Relative) => "the file states relative values: only ratios are reported".to_owned(),
                    Some(file) => format!("the file states {file} without a unit: only ratios are reported"),
                    None => "the file states no quantity or unit: only ratios are reported".to_owned(),
                };
                note(Finding::warning("S010", message).hint("say --quantity and --unit if you know them"));
                (Quantity::Relative, None)
            }
        };
        let mut sampling = Sampling::Density;
        if let Some(unit) = unit.as_ref().filter(|u| u.per == Per::Band) {
            sampling = Sampling::Lines;
            if !["band", "line", "bin"].iter().any(|word| unit.text.contains(word)) {
                let message = format!(
                    "the unit {} has no wavelength in it: each sample is taken as the amount in its own band",
                    unit.text
                );
                let hint = format!("if it is a density, say --unit {}/nm", unit.text);
                note(Finding::warning("S011", message).hint(hint));
            }
        }
        if samples == 1 && sampling == Sampling::Density {
            sampling = Sampling::Lines;
            note(Finding::warning("S012", "one sample has no width: it is taken as the amount in one line"));
        }
        let unit = unit.filter(|_| quantity != Quantity::Relative);
        Ok(Checked { value: Self { quantity, unit, sampling }, findings })
    }

    /// The values of a file as a spectrum in W or J, per m², sr and nm (or line) as the quantity asks.
    ///
    /// # Errors
    /// Where a value leaves the range of a double, or there are not as many values as wavelengths.
    pub fn apply(&self, grid: &Arc<Grid>, values: Vec<f64>) -> Result<Spectrum, super::super::Error> {
        Spectrum::new(Arc::clone(grid), self.scaled(grid, values), self.sampling)
    }

    /// Numbers in the file's unit in SI.
    fn scaled(&self, grid: &Grid, mut values: Vec<f64>) -> Vec<f64> {
        match &self.unit {
            Some(unit) if unit.photons => {
                for (value, wavelength) in values.iter_mut().zip(grid.wavelengths_nm()) {
                    *value = unit.to_si(*wavelength, *value);
                }
            }
            Some(unit) if unit.factor != 1.0 => values.iter_mut().for_each(|value| *value *= unit.factor),
            _ => {}
        }
        values
    }
}

fn fit(unit: SpectralUnit, quantity: Quantity, by_user: bool, location: &Location) -> Result<SpectralUnit, Error> {
    unit.as_quantity(quantity).map_err(|error| match error {
        UnitError::Mismatch { unit, of, asked } => {
            let error = Error::new(location.clone(), ErrorKind::UnitMismatch { unit, of, asked });
            let both = "--quantity and --unit have to agree";
            error.with_hint(if by_user { both } else { "say --quantity and --unit to overrule the file" })
        }
        other => Error::new(location.clone(), other),
    })
}

impl Entry {
    /// This entry in SI per nm; the grid stays shared.
    ///
    /// | file states | user says | result |
    /// |---|---|---|
    /// | unit | nothing | that unit, and its quantity |
    /// | unit | quantity of the same dimensions | that quantity (irradiance and exitance share a unit) |
    /// | unit | quantity of other dimensions | refused |
    /// | anything | unit | the user's unit, S013 where it differs |
    /// | no unit | quantity | SI per nm of that quantity, S014 |
    /// | no unit | nothing | relative, S010 |
    /// | anything | relative | relative |
    ///
    /// # Errors
    /// [`ErrorKind::UnitMismatch`] where quantity and unit are of different dimensions.
    pub fn resolve(&self, quantity: Option<Quantity>, unit: Option<&SpectralUnit>) -> Result<Checked<Measured>, Error> {
        let location = item(self.location.clone(), &self.name);
        let stated = (self.quantity, self.unit.as_ref());
        let Checked { value: scale, findings } =
            Scale::new(stated, (quantity, unit), self.spectrum.values().len(), &location)?;
        let spectrum = scale
            .apply(self.spectrum.grid(), self.spectrum.values().to_vec())
            .map_err(|error| Error::new(location, error))?;
        let standard = (self.standard.as_ref()).map(|u| scale.scaled(self.spectrum.grid(), u.clone()));
        Ok(Checked {
            value: Measured { name: self.name.clone(), quantity: scale.quantity, spectrum, standard },
            findings,
        })
    }
}

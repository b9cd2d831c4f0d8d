//! Reference illuminants of colour rendition: a blackbody, CIE daylight, or a mixture, of the test source's colour temperature.

use crate::constants::SecondRadiation;
use crate::illuminant::{Error, daylight, planck};
use crate::spectrum::Grid;
use crate::spectrum::integrate::Weighting;

/// Room for reference spectra, kept from one evaluation to the next.
#[derive(Debug, Clone, Default)]
pub struct ReferenceScratch {
    /// The reference.
    pub(super) spectrum: Vec<f64>,
    /// What is mixed into it.
    pub(super) other: Vec<f64>,
}

/// Reference spectra on one grid: the daylight components looked up once.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferencePlan {
    wavelengths_nm: Vec<f64>,
    daylight: [Vec<f64>; 3],
    c2: SecondRadiation,
}

impl ReferencePlan {
    /// Looks up the daylight components on the grid.
    ///
    /// # Errors
    /// [`Error::Table`] where the embedded table is broken.
    pub fn new(grid: &Grid, c2: SecondRadiation) -> Result<Self, Error> {
        let on_grid = |s: &Weighting| grid.wavelengths_nm().iter().map(|&w| s.at(w)).collect();
        let [s0, s1, s2] = daylight::components()?;
        Ok(Self {
            wavelengths_nm: grid.wavelengths_nm().to_vec(),
            daylight: [on_grid(&s0), on_grid(&s1), on_grid(&s2)],
            c2,
        })
    }

    /// Blackbody radiance on the grid, relative (1 near 560 nm), in place of what `out` held.
    pub fn planck(&self, kelvin: f64, out: &mut Vec<f64>) {
        let scale = planck::ln_radiance(560.0, kelvin, self.c2);
        let wavelengths = self.wavelengths_nm.iter();
        out.clear();
        if scale < -600.0 {
            out.extend(wavelengths.map(|&w| (planck::ln_radiance(w, kelvin, self.c2) - scale).exp()));
            return;
        }
        let scale = 1.0 / scale.exp();
        out.extend(wavelengths.map(|&w| planck::radiance(w, kelvin, self.c2) * scale));
    }

    /// CIE daylight on the grid (100 at 560 nm), M₁ and M₂ not rounded, in place of what `out` held.
    ///
    /// # Errors
    /// [`Error::DaylightRange`] outside 4000 K … 25000 K.
    pub fn daylight(&self, kelvin: f64, out: &mut Vec<f64>) -> Result<(), Error> {
        // The daylight locus is defined on the ITS-90 scale.
        let kelvin = kelvin * SecondRadiation::Its90.metre_kelvin() / self.c2.metre_kelvin();
        let [m1, m2] = daylight::multipliers(daylight::chromaticity(kelvin)?);
        let [s0, s1, s2] = &self.daylight;
        out.clear();
        out.extend((0..s0.len()).map(|i| s0[i] + m1 * s1[i] + m2 * s2[i]));
        Ok(())
    }
}

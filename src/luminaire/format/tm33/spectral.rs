//! Sums of angular-spectral intensity: over wavelength for each direction, over the sphere for each wavelength.

use super::{AngularSpectral, IntensityTable};
use crate::constants::{AVOGADRO, K_M, PLANCK, SPEED_OF_LIGHT};
use crate::luminaire::Kind;
use crate::photometry::luminous::Efficiency;
use crate::spectrum::integrate::{self, Contract, Rule, Weighting};
use crate::spectrum::{self, Grid, Sampling, Spectrum};

impl AngularSpectral {
    /// The spectral intensity in a tabulated direction, W/(sr·nm), multiplier applied; `None` beyond the table.
    ///
    /// # Errors
    /// None for what [`parse`](super::parse) gave.
    pub fn spectrum(&self, plane: usize, row: usize) -> Option<Result<Spectrum, spectrum::Error>> {
        if plane >= self.horizontal_deg.len() || row >= self.vertical_deg.len() {
            return None;
        }
        let count = self.wavelengths_nm.len();
        let from = (plane * self.vertical_deg.len() + row) * count;
        let values = self.values.get(from..from + count)?.iter().map(|v| v * self.multiplier).collect();
        Some(Grid::new(self.wavelengths_nm.clone()).and_then(|grid| Spectrum::density(grid, values)))
    }

    /// Intensity summed over all wavelengths in every direction: cd (K_m = 683.002 lm/W, V(λ)), W/sr or µmol/(s·sr), by
    /// straight lines between the samples.
    ///
    /// # Errors
    /// None for what [`parse`](super::parse) gave.
    pub fn summed(&self, kind: Kind) -> Result<IntensityTable, spectrum::Error> {
        let grid = Grid::new(self.wavelengths_nm.clone())?;
        let weights = weights(&grid, kind);
        let count = self.wavelengths_nm.len();
        let values = self.values.chunks_exact(count).map(|v| integrate::dot(&weights, v)).collect();
        Ok(IntensityTable {
            kind,
            absolute: self.absolute,
            symmetry: self.symmetry,
            multiplier: self.multiplier,
            horizontal_deg: self.horizontal_deg.clone(),
            vertical_deg: self.vertical_deg.clone(),
            values,
            flux: None,
            wavelength_range_nm: Some(grid.range_nm()),
            location: self.location.clone(),
        })
    }

    /// The intensity at one tabulated wavelength in every direction, W/(sr·nm), as a table; `None` beyond the wavelengths.
    #[must_use]
    pub fn at_wavelength(&self, index: usize) -> Option<IntensityTable> {
        let count = self.wavelengths_nm.len();
        let nm = *self.wavelengths_nm.get(index)?;
        Some(IntensityTable {
            kind: Kind::Radiant,
            absolute: self.absolute,
            symmetry: self.symmetry,
            multiplier: self.multiplier,
            horizontal_deg: self.horizontal_deg.clone(),
            vertical_deg: self.vertical_deg.clone(),
            values: self.values.iter().skip(index).step_by(count).copied().collect(),
            flux: None,
            wavelength_range_nm: Some((nm, nm)),
            location: self.location.clone(),
        })
    }
}

/// Weights of the samples for the sum over wavelength; a single wavelength is a line.
fn weights(grid: &Grid, kind: Kind) -> Vec<f64> {
    let (sampling, rule) =
        if grid.len() == 1 { (Sampling::Lines, Rule::Lines) } else { (Sampling::Density, Rule::Exact) };
    let contract = Contract { rule: Some(rule), range_nm: None };
    let of = |w: &Weighting| integrate::weights(grid, sampling, w, &contract).unwrap_or_else(|_| vec![0.0; grid.len()]);
    match kind {
        Kind::Luminous => of(&Efficiency::Cie1924.weighting()).into_iter().map(|w| w * K_M).collect(),
        Kind::Radiant => of(&Weighting::unity()),
        // λ/(N_A h c), µmol per joule.
        Kind::Photon => {
            let per_joule_nm = 1e-9 / (PLANCK * SPEED_OF_LIGHT * AVOGADRO) * 1e6;
            of(&Weighting::wavelength()).into_iter().map(|w| w * per_joule_nm).collect()
        }
    }
}

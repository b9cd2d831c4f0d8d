//! Photon numbers: totals over the spectrum and over photosynthetically active radiation (PAR, 400–700 nm).

use crate::constants::{AVOGADRO, PLANCK, SPEED_OF_LIGHT};
use crate::spectrum::integrate::{self, Contract, Rule, RuleError, Weighting, dot};
use crate::spectrum::{Grid, Sampling};

use super::luminous::ratio;

/// Photosynthetically active radiation, nm (DIN 5031-10; McCree 1972).
pub const PAR_NM: (f64, f64) = (400.0, 700.0);

/// µmol of photons per joule and nanometre of wavelength: λ/(N_A h c) = λ[nm] · 8.359 e-3.
const UMOL_PER_JOULE_NM: f64 = 1e-9 / (PLANCK * SPEED_OF_LIGHT * AVOGADRO) * 1e6;

/// The photons of one spectrum; "amount" is per second where the quantity is a power, per m² where it is per area, and so on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Photons {
    /// All photons of the spectrum, µmol.
    pub total_umol: f64,
    /// Number of all photons (100 W at 500 nm are 2.517·10²⁰ per second).
    pub total_count: f64,
    /// Photons of 400–700 nm, µmol: PPF of a flux, PPFD of an irradiance.
    pub par_umol: f64,
    /// PAR photons per joule of the whole spectrum, µmol/J.
    pub umol_per_j: Option<f64>,
    /// PAR photons per joule of radiation inside 400–700 nm, µmol/J.
    pub par_umol_per_par_j: Option<f64>,
}

/// The photon integrals compiled for one grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    total: Vec<f64>,
    par: Vec<f64>,
    energy: Vec<f64>,
    par_energy: Vec<f64>,
}

impl Plan {
    /// Compiles the integrals.
    ///
    /// A band with sharp ends is not summed: summation counts the samples on both ends in full and makes 400–700 nm a step too wide.
    /// Where the contract's rule is summation, photon integrals and the energy they are divided by use the trapezoid.
    ///
    /// # Errors
    /// [`RuleError`] where the contract's rule does not fit the grid.
    pub fn new(grid: &Grid, sampling: Sampling, contract: &Contract) -> Result<Self, RuleError> {
        let rule = match contract.rule_on(grid, sampling)? {
            Rule::Summation => Rule::Trapezoid,
            rule => rule,
        };
        let contract = Contract { rule: Some(rule), range_nm: contract.range_nm };
        let of = |w: &Weighting| integrate::weights(grid, sampling, w, &contract);
        let (low, high) = PAR_NM;
        Ok(Self {
            total: of(&Weighting::wavelength())?,
            par: of(&Weighting::wavelength_between(low, high))?,
            energy: of(&Weighting::unity())?,
            par_energy: of(&Weighting::band(low, high))?,
        })
    }

    /// The photons of a spectrum's values on the plan's grid.
    #[must_use]
    pub fn evaluate(&self, values: &[f64]) -> Photons {
        let total = dot(&self.total, values) * UMOL_PER_JOULE_NM;
        let par = dot(&self.par, values) * UMOL_PER_JOULE_NM;
        Photons {
            total_umol: total,
            total_count: total * 1e-6 * AVOGADRO,
            par_umol: par,
            umol_per_j: ratio(par, dot(&self.energy, values)),
            par_umol_per_par_j: ratio(par, dot(&self.par_energy, values)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hundred_watts_at_500_nm() {
        // Q = hc/λ: 100 W / (6.626 070 15e-34 · 299 792 458 / 500e-9) = 2.517 e20 per second.
        let grid = Grid::new(vec![500.0]).expect("one line");
        let plan = Plan::new(&grid, Sampling::Lines, &Contract::default()).expect("lines fit");
        let got = plan.evaluate(&[100.0]);
        let want = 100.0 * 500e-9 / (6.626_070_15e-34 * 299_792_458.0);
        assert!((got.total_count / want - 1.0).abs() < 1e-14, "{got:?}");
        assert!((got.total_count / 2.517e20 - 1.0).abs() < 2e-4, "{got:?}");
        assert!((got.par_umol / got.total_umol - 1.0).abs() < 1e-15);
    }

    #[test]
    fn an_equal_energy_spectrum_has_the_closed_form() {
        // ∫λ dλ from 400 to 700 = 165 000 nm², over 300 nm of it: 550 nm on average. The trapezoid is exact for a straight line.
        for (start, step, count) in [(400.0, 5.0, 61), (395.0, 5.0, 63), (390.0, 7.0, 46)] {
            let grid = Grid::uniform(start, step, count).expect("ascending");
            let plan = Plan::new(&grid, Sampling::Density, &Contract::default()).expect("fits");
            let got = plan.evaluate(&vec![1.0; count]);
            let per_par_joule = got.par_umol_per_par_j.expect("there is light");
            assert!((per_par_joule / (550.0 * UMOL_PER_JOULE_NM) - 1.0).abs() < 1e-13, "{per_par_joule}");
        }
    }
}

//! Reflecting samples under a light: weights compiled per grid for any set of reflectance spectra.

use crate::spectrum::integrate::{Contract, Quadrature, RuleError, Weighting, dot};
use crate::spectrum::{Grid, Sampling};

use super::observer::Observer;

/// An observer and a set of reflectances compiled for one grid, sampling and contract.
#[derive(Debug, Clone, PartialEq)]
pub struct SamplePlan {
    white: [Vec<f64>; 3],
    samples: Vec<[Vec<f64>; 3]>,
}

impl SamplePlan {
    /// Compiles the tristimulus weights of a white diffuser and of each reflectance (a weighting with values 0 to 1).
    ///
    /// A sample's weighting is the product ρ·x̄ at the observer's wavelengths, straight lines between.
    ///
    /// # Errors
    /// [`RuleError`] where the contract's rule does not fit the grid.
    pub fn new(
        observer: Observer,
        reflectances: &[Weighting],
        grid: &Grid,
        sampling: Sampling,
        contract: &Contract,
    ) -> Result<Self, RuleError> {
        let bars = observer.colour_matching_functions();
        // The three functions are columns of one table.
        let wavelengths = bars[0].wavelengths_nm();
        let rule = Quadrature::new(grid, sampling, &bars[0], contract)?;
        let under = |reflectance: &Weighting| {
            let rho: Vec<f64> = wavelengths.iter().map(|&w| reflectance.at(w)).collect();
            bars.each_ref().map(|bar| {
                let product: Vec<f64> = rho.iter().zip(bar.values()).map(|(r, v)| r * v).collect();
                rule.weights(&product)
            })
        };
        Ok(Self {
            white: bars.each_ref().map(|bar| rule.weights(bar.values())),
            samples: reflectances.iter().map(under).collect(),
        })
    }

    /// Tristimulus values of the light itself.
    #[must_use]
    pub fn white(&self, values: &[f64]) -> [f64; 3] {
        [0, 1, 2].map(|k| dot(&self.white[k], values))
    }

    /// Tristimulus values of every sample under the light, in the order of the reflectances.
    pub fn samples<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = [f64; 3]> + 'a {
        self.samples.iter().map(move |w| [0, 1, 2].map(|k| dot(&w[k], values)))
    }
}

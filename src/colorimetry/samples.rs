//! Reflecting samples under a light: weights compiled per grid for any set of reflectance spectra.

use crate::spectrum::integrate::{self, Contract, RuleError, Weighting, dot};
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
        let compile = |w: &Weighting| integrate::weights(grid, sampling, w, contract);
        let three = |reflectance: Option<&Weighting>| -> Result<[Vec<f64>; 3], RuleError> {
            let [x, y, z] = &bars;
            let of = |bar: &Weighting| match reflectance {
                None => compile(bar),
                Some(rho) => {
                    let product: Vec<f64> =
                        bar.wavelengths_nm().iter().zip(bar.values()).map(|(&w, v)| v * rho.at(w)).collect();
                    compile(&Weighting::table(bar.wavelengths_nm().to_vec(), product))
                }
            };
            Ok([of(x)?, of(y)?, of(z)?])
        };
        Ok(Self {
            white: three(None)?,
            samples: reflectances.iter().map(|r| three(Some(r))).collect::<Result<_, _>>()?,
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

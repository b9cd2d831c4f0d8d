//! Hazard-weighted radiation: blue light B(λ) and heat R(λ) on the retina, actinic ultraviolet S(λ) (IEC 62471:2006, ICNIRP).

use crate::spectrum::integrate::{self, Contract, RuleError, Weighting, dot};
use crate::spectrum::{Grid, Sampling};

use super::luminous::single;

/// The weightings: key in the results, name of the embedded table.
pub const WEIGHTINGS: [(&str, &str); 3] = [
    ("blue_light", "icnirp-blue-light-hazard"),
    ("actinic_uv", "icnirp-actinic-uv-hazard"),
    ("retinal_thermal", "icnirp-retinal-thermal-hazard"),
];

/// One hazard-weighted integral.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hazard {
    /// Key in the results.
    pub key: &'static str,
    /// ∫ X_λ w(λ) dλ in the unit of the samples times nm.
    pub weighted: f64,
    /// The part of the weighting's range, in nm, that the spectrum covers; `None` where it covers none.
    pub covered_nm: Option<(f64, f64)>,
    /// Whether it covers the whole range.
    pub complete: bool,
}

/// The weightings compiled for one grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    hazards: Vec<Weighted>,
}

/// One weighting on the plan's grid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Weighted {
    key: &'static str,
    weights: Vec<f64>,
    /// Of the weighting.
    pub(super) range_nm: (f64, f64),
    covered_nm: Option<(f64, f64)>,
    complete: bool,
}

impl Weighted {
    /// Compiles a weighting for a grid.
    pub(super) fn new(
        key: &'static str,
        weighting: &Weighting,
        grid: &Grid,
        sampling: Sampling,
        contract: &Contract,
    ) -> Result<Self, RuleError> {
        let weights = integrate::weights(grid, sampling, weighting, contract)?;
        let ((low, high), (first, last)) = (weighting.range_nm(), grid.range_nm());
        let (from, to) = contract.range_nm.unwrap_or((first, last));
        let covered = (low.max(first).max(from), high.min(last).min(to));
        // Of a line spectrum nothing lies beyond its lines.
        let whole = sampling == Sampling::Lines || (first <= low && last >= high);
        let complete = whole && contract.range_nm.is_none_or(|(from, to)| from <= low && to >= high);
        let covered_nm = (covered.0 <= covered.1).then_some(covered);
        Ok(Self { key, weights, range_nm: (low, high), covered_nm, complete })
    }

    /// The weighted integral of values on the grid.
    pub(super) fn evaluate(&self, values: &[f64]) -> Hazard {
        Hazard {
            key: self.key,
            weighted: dot(&self.weights, values),
            covered_nm: self.covered_nm,
            complete: self.complete,
        }
    }
}

impl Plan {
    /// Compiles the weightings.
    ///
    /// # Errors
    /// [`RuleError`] where the contract's rule does not fit the grid.
    pub fn new(grid: &Grid, sampling: Sampling, contract: &Contract) -> Result<Self, RuleError> {
        let compile = |(key, table)| Weighted::new(key, &single(table), grid, sampling, contract);
        Ok(Self { hazards: WEIGHTINGS.into_iter().map(compile).collect::<Result<_, _>>()? })
    }

    /// The weighted integrals of a spectrum's values on the plan's grid.
    pub fn evaluate<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = Hazard> + 'a {
        self.hazards.iter().map(|h| h.evaluate(values))
    }
}

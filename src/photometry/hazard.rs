//! Hazard-weighted radiation: retinal blue light B(λ) and actinic ultraviolet S(λ) (IEC 62471:2006, ICNIRP).

use crate::spectrum::integrate::{self, Contract, RuleError, Weighting, dot};
use crate::spectrum::{Grid, Sampling};
use crate::tables;

use super::luminous::single;

/// The weightings: key in the results, name of the embedded table.
pub const WEIGHTINGS: [(&str, &str); 2] =
    [("blue_light", "icnirp-blue-light-hazard"), ("actinic_uv", "icnirp-actinic-uv-hazard")];

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
struct Weighted {
    key: &'static str,
    weights: Vec<f64>,
    covered_nm: Option<(f64, f64)>,
    complete: bool,
}

impl Plan {
    /// Compiles those weightings whose tables are embedded.
    ///
    /// # Errors
    /// [`RuleError`] where the contract's rule does not fit the grid.
    pub fn new(grid: &Grid, sampling: Sampling, contract: &Contract) -> Result<Self, RuleError> {
        let mut hazards = Vec::with_capacity(WEIGHTINGS.len());
        for (key, table) in WEIGHTINGS {
            if tables::get(table).is_err() {
                continue;
            }
            let weighting: Weighting = single(table);
            let weights = integrate::weights(grid, sampling, &weighting, contract)?;
            let ((low, high), (first, last)) = (weighting.range_nm(), grid.range_nm());
            let covered = (low.max(first), high.min(last));
            // Of a line spectrum nothing lies beyond its lines.
            let complete = sampling == Sampling::Lines || (first <= low && last >= high);
            let covered_nm = (covered.0 <= covered.1).then_some(covered);
            hazards.push(Weighted { key, weights, covered_nm, complete });
        }
        Ok(Self { hazards })
    }

    /// The weighted integrals of a spectrum's values on the plan's grid.
    pub fn evaluate<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = Hazard> + 'a {
        self.hazards.iter().map(|h| Hazard {
            key: h.key,
            weighted: dot(&h.weights, values),
            covered_nm: h.covered_nm,
            complete: h.complete,
        })
    }
}

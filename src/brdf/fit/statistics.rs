//! What the minimum says about its parameters: standard errors, correlations, criteria.

use nalgebra::{DMatrix, DVector};

use super::metric::Metric;
use super::objective::{Objective, Sums};
use crate::math::least_squares::{End, Minimum, invert};

/// What is known of an estimate's error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Uncertainty {
    /// Standard error under equal variances, and the robust one; a common error of the samples is in both.
    Known {
        /// The root of s² (JᵀWJ)⁻¹ (and of the square of what the common error moves it by).
        standard: f64,
        /// Of any variances.
        robust: f64,
    },
    /// It rests at the lower bound.
    AtLow,
    /// It rests at the upper bound.
    AtHigh,
    /// The data do not tell it from others.
    Inseparable,
    /// The measure that was minimised has no error theory (the largest difference).
    Undefined,
}

/// An estimate of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Number of the open parameter.
    pub open: usize,
    /// Its band; `None` for one value for all bands.
    pub band: Option<usize>,
    /// The value.
    pub value: f64,
    /// Its error.
    pub uncertainty: Uncertainty,
}

/// For comparing models on the same values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Criteria {
    /// Parameters of the likelihood: the variables, and the variance.
    pub parameters: usize,
    /// Akaike's criterion.
    pub aic: f64,
    /// Corrected for few values; absent where there are too few of them.
    pub aicc: Option<f64>,
    /// Schwarz's criterion.
    pub bic: f64,
}

impl Criteria {
    /// From a sum of squares over `values` values (weights with a mean of 1) and a number of variables; `None` without a remainder.
    #[must_use]
    pub fn new(sum: f64, values: usize, variables: usize) -> Option<Self> {
        if !(sum > 0.0 && sum.is_finite()) {
            return None;
        }
        let (n, k) = (values as f64, (variables + 1) as f64);
        let likelihood = n * (sum / n).ln();
        let aic = likelihood + 2.0 * k;
        let aicc = (n - k - 1.0 > 0.0).then(|| aic + 2.0 * k * (k + 1.0) / (n - k - 1.0));
        Some(Self { parameters: variables + 1, aic, aicc, bic: likelihood + k * n.ln() })
    }
}

/// Everything that follows from the sums at the minimum.
pub(super) struct Spread {
    pub(super) estimates: Vec<Estimate>,
    pub(super) correlations: Vec<Vec<Option<f64>>>,
    pub(super) condition: f64,
    pub(super) inseparable: Vec<usize>,
    pub(super) criteria: Option<Criteria>,
}

/// Part of a loose direction (a unit vector) from which on a variable belongs to it.
const INVOLVED: f64 = 0.05;

pub(super) fn spread(objective: &Objective<'_>, found: &Minimum, metric: Metric) -> Spread {
    let coordinates = objective.coordinates;
    let n = objective.samples.len() * coordinates.bands;
    let free: Vec<usize> = (0..coordinates.count).filter(|v| found.resting[*v].is_none()).collect();
    let central = if metric == Metric::Largest { None } else { objective.central(&found.x) };
    let derivatives = coordinates.derivatives(&found.x);
    let (mut condition, mut weak) = (1.0, vec![false; coordinates.count]);
    let mut covariances: Option<(DMatrix<f64>, DMatrix<f64>)> = None;
    let mut criteria = None;
    if let Some(Sums { at, meat, common }) = central {
        criteria = Criteria::new(at.cost, n, coordinates.count);
        let inverse = invert(&at.normal, &free);
        condition = inverse.condition;
        for direction in &inverse.loose {
            free.iter().zip(direction).for_each(|(v, d)| weak[*v] |= d.abs() > INVOLVED);
        }
        let freedom = (n.saturating_sub(free.len())).max(1) as f64;
        // From variables to parameters.
        let turn = DMatrix::from_fn(coordinates.count, free.len(), |p, i| {
            derivatives[p].iter().filter(|(v, _)| *v == free[i]).map(|(_, d)| *d).sum::<f64>()
        });
        let filling = DMatrix::from_fn(free.len(), free.len(), |r, c| meat[(free[r], free[c])]);
        // What the common error moves the parameters by: all of them at once.
        let moved = &turn * (&inverse.matrix * DVector::from_fn(free.len(), |r, _| common[free[r]]));
        let shared = &moved * moved.transpose();
        let standard: DMatrix<f64> = &turn * (&inverse.matrix * (at.cost / freedom)) * turn.transpose() + &shared;
        let robust: DMatrix<f64> =
            &turn * (&inverse.matrix * filling * &inverse.matrix * (n as f64 / freedom)) * turn.transpose() + shared;
        covariances = Some((standard, robust));
    }
    let state = |p: usize, value: f64| {
        let of = &derivatives[p];
        let rests = of.iter().any(|(v, _)| found.resting[*v].is_some());
        // Of a pair, a sum of 1 is a rest for neither of the two, a value of 0 is one.
        match (&covariances, found.resting[p]) {
            (_, Some(End::Low)) if of.len() == 1 => Uncertainty::AtLow,
            (_, Some(End::High)) if of.len() == 1 => Uncertainty::AtHigh,
            _ if rests && value <= 0.0 => Uncertainty::AtLow,
            (None, _) => Uncertainty::Undefined,
            _ if of.iter().all(|(v, _)| found.resting[*v].is_some()) => Uncertainty::AtHigh,
            _ if of.iter().any(|(v, _)| weak[*v]) => Uncertainty::Inseparable,
            (Some((standard, robust)), _) => Uncertainty::Known {
                standard: standard[(p, p)].max(0.0).sqrt(),
                robust: robust[(p, p)].max(0.0).sqrt(),
            },
        }
    };
    let values = coordinates.values(&found.x);
    let mut estimates = Vec::with_capacity(coordinates.count);
    for (open, (column, values)) in coordinates.columns.iter().zip(&values).enumerate() {
        for (i, value) in values.iter().enumerate() {
            let band = (!column.shared).then_some(i);
            let uncertainty = state(column.first + i, *value);
            estimates.push(Estimate { open, band, value: *value, uncertainty });
        }
    }
    let inseparable = (0..estimates.len()).filter(|i| estimates[*i].uncertainty == Uncertainty::Inseparable).collect();
    let correlations = correlations(&estimates, covariances.as_ref().map(|(s, _)| s));
    Spread { estimates, correlations, condition, inseparable, criteria }
}

fn correlations(estimates: &[Estimate], covariance: Option<&DMatrix<f64>>) -> Vec<Vec<Option<f64>>> {
    let n = estimates.len();
    let Some(covariance) = covariance else { return vec![vec![None; n]; n] };
    let known = |i: usize| matches!(estimates[i].uncertainty, Uncertainty::Known { standard, .. } if standard > 0.0);
    let deviation: DVector<f64> = covariance.diagonal().map(|d| d.max(0.0).sqrt());
    let one = |r: usize, c: usize| {
        (known(r) && known(c)).then(|| if r == c { 1.0 } else { covariance[(r, c)] / (deviation[r] * deviation[c]) })
    };
    (0..n).map(|r| (0..n).map(|c| one(r, c)).collect()).collect()
}

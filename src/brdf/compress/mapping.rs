//! The log-relative mapping.

use rayon::prelude::*;

/// ε, in units of f w.
pub(super) const EPSILON: f64 = 1e-3;
/// Least weight of a bin.
pub(super) const LEAST_WEIGHT: f64 = 1e-3;

/// Weights and reference of every bin.
#[derive(Debug, Clone, PartialEq)]
pub struct Mapping {
    weights: Vec<f32>,
    /// ln(f_ref w + ε).
    reference: Vec<f32>,
}

#[expect(clippy::cast_possible_truncation, reason = "columns are kept in single precision")]
impl Mapping {
    /// The mapping relative to the median of columns, bin by bin.
    pub(super) fn of(weights: Vec<f32>, columns: &[Vec<f32>]) -> Self {
        let n = columns.len();
        let median = |bin: &mut Vec<f32>, i: usize, w: f32| {
            bin.iter_mut().zip(columns).for_each(|(b, c)| *b = c[i]);
            let (below, upper, _) = bin.select_nth_unstable_by(n / 2, f32::total_cmp);
            let upper = *upper;
            let lower = if n % 2 == 1 { upper } else { below.iter().copied().fold(f32::NEG_INFINITY, f32::max) };
            level(0.5 * (f64::from(lower) + f64::from(upper)), w) as f32
        };
        let indexed = weights.par_iter().enumerate();
        let reference = indexed.map_init(|| vec![0.0; n], |bin, (i, w)| median(bin, i, *w)).collect();
        Self { weights, reference }
    }

    /// Of weights and ln(f_ref w + ε).
    pub(super) fn of_reference(weights: Vec<f32>, reference: Vec<f32>) -> Self {
        Self { weights, reference }
    }

    /// ln(f_ref w + ε) of every bin.
    pub(super) fn reference(&self) -> &[f32] {
        &self.reference
    }

    /// Number of bins.
    #[must_use]
    pub fn bins(&self) -> usize {
        self.weights.len()
    }

    /// The weight max(cosθ_i cosθ_o, 0.001) of a bin.
    #[must_use]
    pub fn weight(&self, bin: usize) -> f64 {
        f64::from(self.weights[bin])
    }

    /// x of a value in 1/sr.
    #[must_use]
    pub fn forward(&self, bin: usize, value: f64) -> f64 {
        level(value, self.weights[bin]) - f64::from(self.reference[bin])
    }

    /// The value in 1/sr of x, not below 0.
    #[must_use]
    pub fn inverse(&self, bin: usize, x: f64) -> f64 {
        (((x + f64::from(self.reference[bin])).exp() - EPSILON) / self.weight(bin)).max(0.0)
    }
}

/// ln(f w + ε); what is negative counts as 0.
fn level(value: f64, weight: f32) -> f64 {
    (value.max(0.0) * f64::from(weight) + EPSILON).ln()
}

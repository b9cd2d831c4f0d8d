//! The log-relative mapping.

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
        let mut bin = vec![0.0_f32; columns.len()];
        let median = |(i, w): (usize, &f32)| {
            bin.iter_mut().zip(columns).for_each(|(b, c)| *b = c[i]);
            bin.sort_by(f32::total_cmp);
            let middle = 0.5 * (f64::from(bin[bin.len() / 2]) + f64::from(bin[(bin.len() - 1) / 2]));
            level(middle, *w) as f32
        };
        let reference = weights.iter().enumerate().map(median).collect();
        Self { weights, reference }
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

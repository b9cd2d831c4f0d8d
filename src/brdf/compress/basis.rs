//! A mean and orthonormal components over the bins of a set.

use std::sync::Arc;

use super::{Error, Mapping};

/// Components of a set of columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Basis {
    mapping: Arc<Mapping>,
    mean: Vec<f32>,
    /// Bin by bin, the components of a bin side by side.
    components: Vec<f32>,
    /// Variance of the set along each component, falling.
    variances: Vec<f64>,
}

impl Basis {
    pub(super) fn new(mapping: Arc<Mapping>, mean: Vec<f32>, components: Vec<f32>, variances: Vec<f64>) -> Self {
        Self { mapping, mean, components, variances }
    }

    /// The mapping between values and what the components span.
    #[must_use]
    pub fn mapping(&self) -> &Mapping {
        &self.mapping
    }

    /// Number of components.
    #[must_use]
    pub fn components(&self) -> usize {
        self.variances.len()
    }

    /// Variance of the set along each component, falling.
    #[must_use]
    pub fn variances(&self) -> &[f64] {
        &self.variances
    }

    /// The components at a bin.
    pub(super) fn row(&self, bin: usize) -> &[f32] {
        &self.components[bin * self.components()..][..self.components()]
    }

    /// x − x̄ of a value in 1/sr.
    pub(super) fn centred(&self, bin: usize, value: f64) -> f64 {
        self.mapping.forward(bin, value) - f64::from(self.mean[bin])
    }

    /// The coefficients of a column of values in 1/sr, one per bin.
    ///
    /// # Errors
    /// [`Error::Count`] for a column of another length.
    pub fn project(&self, column: &[f32]) -> Result<Vec<f64>, Error> {
        self.check("values in the column", column.len(), self.mapping.bins())?;
        let mut coefficients = vec![0.0; self.components()];
        for (bin, value) in column.iter().enumerate() {
            let x = self.centred(bin, f64::from(*value));
            coefficients.iter_mut().zip(self.row(bin)).for_each(|(c, b)| *c += x * f64::from(*b));
        }
        Ok(coefficients)
    }

    /// The column of coefficients, in 1/sr.
    ///
    /// # Errors
    /// [`Error::Count`] for another number of coefficients.
    pub fn reconstruct(&self, coefficients: &[f64]) -> Result<Vec<f32>, Error> {
        self.check("coefficients", coefficients.len(), self.components())?;
        let value = |bin: usize| {
            let sum: f64 = coefficients.iter().zip(self.row(bin)).map(|(c, b)| c * f64::from(*b)).sum();
            #[expect(clippy::cast_possible_truncation, reason = "columns are kept in single precision")]
            let single = self.mapping.inverse(bin, f64::from(self.mean[bin]) + sum) as f32;
            single
        };
        Ok((0..self.mapping.bins()).map(value).collect())
    }

    /// The distance of two columns: rms over bins of ln((f̂ w + ε)/(f w + ε)).
    ///
    /// # Errors
    /// [`Error::Count`] for columns of other lengths.
    pub fn distance(&self, a: &[f32], b: &[f32]) -> Result<f64, Error> {
        self.check("values in the first column", a.len(), self.mapping.bins())?;
        self.check("values in the second column", b.len(), self.mapping.bins())?;
        let x = |bin: usize, v: f32| self.mapping.forward(bin, f64::from(v));
        let squares = a.iter().zip(b).enumerate().map(|(bin, (a, b))| (x(bin, *a) - x(bin, *b)).powi(2));
        Ok((squares.sum::<f64>() / a.len() as f64).sqrt())
    }

    pub(super) fn check(&self, what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
        if found == expected { Ok(()) } else { Err(Error::Count { what, found, expected }) }
    }
}

//! A mean and orthonormal components over the bins of a set.

use std::sync::Arc;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use super::samples::NOISE;
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

    /// The mean of the set in x, bin by bin.
    pub(super) fn mean(&self) -> &[f32] {
        &self.mean
    }

    /// All components, bin by bin.
    pub(super) fn all(&self) -> &[f32] {
        &self.components
    }

    /// The coefficients of a column of values in 1/sr, one per bin, those of the largest variance first: the first of them are
    /// those of fewer components.
    ///
    /// Bins that are NaN do not take part. Where there are some, the components are not orthonormal over the others, and the
    /// coefficients are the most probable ones for the variances of the set:
    ///
    /// ```text
    /// c = (BᵀB + σ² V⁻¹)⁻¹ Bᵀ x,    σ² = 0.001
    /// ```
    ///
    /// # Errors
    /// [`Error::Count`] for a column of another length, [`Error::NothingInCommon`] for one of nothing but NaN.
    pub fn project(&self, column: &[f32]) -> Result<Vec<f64>, Error> {
        self.check("values in the column", column.len(), self.mapping.bins())?;
        let known = || column.iter().enumerate().filter(|(_, v)| !v.is_nan());
        let mut coefficients = vec![0.0; self.components()];
        for (bin, value) in known() {
            let x = self.centred(bin, f64::from(*value));
            coefficients.iter_mut().zip(self.row(bin)).for_each(|(c, b)| *c += x * f64::from(*b));
        }
        match known().count() {
            0 => return Err(Error::NothingInCommon),
            n if n == column.len() => return Ok(coefficients),
            _ => {}
        }
        let k = self.components();
        let mut system = DMatrix::from_diagonal(&DVector::from_iterator(k, self.variances.iter().map(|v| NOISE / v)));
        for (bin, _) in known() {
            let row = self.row(bin);
            for (i, a) in row.iter().enumerate() {
                row[..=i].iter().enumerate().for_each(|(j, b)| system[(i, j)] += f64::from(*a) * f64::from(*b));
            }
        }
        // Its lower half is all that is read; positive definite by its diagonal.
        let projected = DVector::from_vec(coefficients);
        let solved = Cholesky::new(system).map_or_else(|| DVector::zeros(k), |c| c.solve(&projected));
        Ok(solved.iter().copied().collect())
    }

    /// The column of coefficients, in 1/sr. Components without coefficient stay at the mean.
    ///
    /// # Errors
    /// [`Error::Count`] for more coefficients than there are components.
    pub fn reconstruct(&self, coefficients: &[f64]) -> Result<Vec<f32>, Error> {
        self.check("coefficients", coefficients.len(), coefficients.len().min(self.components()))?;
        let value = |bin: usize| {
            let sum: f64 = coefficients.iter().zip(self.row(bin)).map(|(c, b)| c * f64::from(*b)).sum();
            #[expect(clippy::cast_possible_truncation, reason = "columns are kept in single precision")]
            let single = self.mapping.inverse(bin, f64::from(self.mean[bin]) + sum) as f32;
            single
        };
        Ok((0..self.mapping.bins()).into_par_iter().map(value).collect())
    }

    /// The distance of two columns: rms over bins of ln((f̂ w + ε)/(f w + ε)). Bins that are NaN in either do not take part.
    ///
    /// # Errors
    /// [`Error::Count`] for columns of other lengths.
    pub fn distance(&self, a: &[f32], b: &[f32]) -> Result<f64, Error> {
        self.check("values in the first column", a.len(), self.mapping.bins())?;
        self.check("values in the second column", b.len(), self.mapping.bins())?;
        let x = |bin: usize, v: f32| self.mapping.forward(bin, f64::from(v));
        let known = a.iter().zip(b).enumerate().filter(|(_, (a, b))| !a.is_nan() && !b.is_nan());
        let squares = |(sum, n), (bin, (a, b)): (usize, (&f32, &f32))| (sum + (x(bin, *a) - x(bin, *b)).powi(2), n + 1);
        let (sum, n) = known.fold((0.0, 0_usize), squares);
        Ok((sum / n.max(1) as f64).sqrt())
    }

    pub(super) fn check(&self, what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
        if found == expected { Ok(()) } else { Err(Error::Count { what, found, expected }) }
    }
}

//! Principal components by way of the Gram matrix: there are far fewer columns than bins.
//!
//! ```text
//! G = X Xᵀ (columns × columns) = V Λ Vᵀ,     b_j = Xᵀ v_j/√λ_j,     variance of coefficient j = λ_j/columns
//! ```
//!
//! For a fixed number of components the columns are weighted once more: plain components minimise the *mean square* error, which a
//! few odd materials (mirrors) rule. Weights (r² + r²_median/10)^(−1/4), with r the plain residual of each column, bring it close
//! to the mean of r^(3/2), and the usual material closer to its truth.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rayon::prelude::*;

use super::{Basis, Error, Mapping};

/// Bins that are worked on at a time.
const BLOCK: usize = 4096;
/// Components below this share of the largest are rounding.
const NEGLIGIBLE: f64 = 1e-8;

/// Mapped columns without their mean, and their Gram matrix.
#[derive(Debug, Clone)]
pub struct Training {
    mapping: Arc<Mapping>,
    mean: Vec<f32>,
    columns: Vec<Vec<f32>>,
    gram: DMatrix<f64>,
}

impl Training {
    /// Maps columns of values in 1/sr; weights are max(cosθ_i cosθ_o, 0.001) of each bin.
    ///
    /// # Errors
    /// [`Error::TooFew`], [`Error::NothingInCommon`], [`Error::Count`] for a column of another length than the weights.
    pub fn new(mut columns: Vec<Vec<f32>>, weights: Vec<f32>) -> Result<Self, Error> {
        if columns.len() < 2 {
            return Err(Error::TooFew { found: columns.len() });
        }
        if weights.is_empty() {
            return Err(Error::NothingInCommon);
        }
        if let Some(column) = columns.iter().find(|c| c.len() != weights.len()) {
            return Err(Error::Count { what: "values in a column", found: column.len(), expected: weights.len() });
        }
        let mapping = Mapping::of(weights, &columns);
        #[expect(clippy::cast_possible_truncation, reason = "columns are kept in single precision")]
        columns.par_iter_mut().for_each(|column| {
            column.iter_mut().enumerate().for_each(|(bin, v)| *v = mapping.forward(bin, f64::from(*v)) as f32);
        });
        #[expect(clippy::cast_possible_truncation, reason = "columns are kept in single precision")]
        let mean_of =
            |bin: usize| (columns.iter().map(|c| f64::from(c[bin])).sum::<f64>() / columns.len() as f64) as f32;
        let mean: Vec<f32> = (0..mapping.bins()).into_par_iter().map(mean_of).collect();
        columns.par_iter_mut().for_each(|column| column.iter_mut().zip(&mean).for_each(|(v, m)| *v -= m));
        let gram = gram(&columns);
        Ok(Self { mapping: Arc::new(mapping), mean, columns, gram })
    }

    /// Number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns.len()
    }

    /// Variance of the set in x: the sum over all components.
    #[must_use]
    pub fn variance(&self) -> f64 {
        self.gram.trace() / self.columns.len() as f64
    }

    /// The best basis of so many components (fewer where the columns have no more).
    #[must_use]
    pub fn basis(&self, components: usize) -> Basis {
        let n = self.columns.len();
        let (plain, _) = self.directions(&DVector::repeat(n, 1.0), components);
        let scores = &self.gram * &plain;
        let residual = |c: usize| (self.gram[(c, c)] - scores.row(c).norm_squared()).max(0.0);
        let residuals: Vec<f64> = (0..n).map(residual).collect();
        let mut sorted = residuals.clone();
        sorted.sort_by(f64::total_cmp);
        let median = sorted[n / 2];
        let weight = |r: &f64| if median > 0.0 { ((r + 0.1 * median) / median).powf(-0.25) } else { 1.0 };
        let weights = DVector::from_iterator(n, residuals.iter().map(weight));
        let (weighted, variances) = self.directions(&weights, components);
        self.make(&weighted, variances)
    }

    /// All components up to a number, plainly: the covariance of the set, from which samples are chosen and columns inferred.
    #[must_use]
    pub fn covariance(&self, components: usize) -> Basis {
        let (plain, variances) = self.directions(&DVector::repeat(self.columns.len(), 1.0), components);
        self.make(&plain, variances)
    }

    /// Combinations of columns (one per matrix column) that give orthonormal components, and the variances along them.
    fn directions(&self, weights: &DVector<f64>, most: usize) -> (DMatrix<f64>, Vec<f64>) {
        let n = self.columns.len();
        let roots = weights.map(f64::sqrt);
        let scaled = DMatrix::from_fn(n, n, |i, j| roots[i] * self.gram[(i, j)] * roots[j]);
        let eigen = SymmetricEigen::new(scaled);
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let least = NEGLIGIBLE * eigen.eigenvalues[order[0]];
        order.retain(|&i| eigen.eigenvalues[i] > least.max(f64::MIN_POSITIVE));
        order.truncate(most);
        let of = |i: usize, j: usize| roots[i] * eigen.eigenvectors[(i, order[j])] / eigen.eigenvalues[order[j]].sqrt();
        let combinations = DMatrix::from_fn(n, order.len(), of);
        let total: f64 = weights.sum();
        (combinations, order.iter().map(|&i| eigen.eigenvalues[i] / total).collect())
    }

    fn make(&self, combinations: &DMatrix<f64>, variances: Vec<f64>) -> Basis {
        let k = combinations.ncols();
        let mut components = vec![0.0_f32; self.mapping.bins() * k];
        if k > 0 {
            // Transposed once: the product with a transpose is not the fast one.
            let turned = combinations.transpose();
            components.par_chunks_mut(BLOCK * k).enumerate().for_each(|(block, out)| {
                let product = &turned * self.block(block * BLOCK, out.len() / k);
                #[expect(clippy::cast_possible_truncation, reason = "components are kept in single precision")]
                out.iter_mut().zip(product.iter()).for_each(|(o, p)| *o = *p as f32);
            });
        }
        Basis::new(Arc::clone(&self.mapping), self.mean.clone(), components, variances)
    }

    fn block(&self, start: usize, bins: usize) -> DMatrix<f64> {
        block(&self.columns, start, bins)
    }
}

/// Some bins of all columns: one row per column.
fn block(columns: &[Vec<f32>], start: usize, bins: usize) -> DMatrix<f64> {
    DMatrix::from_fn(columns.len(), bins, |c, b| f64::from(columns[c][start + b]))
}

/// X Xᵀ, block by block, the sums in double precision.
fn gram(columns: &[Vec<f32>]) -> DMatrix<f64> {
    let (n, bins) = (columns.len(), columns[0].len());
    let zero = || DMatrix::zeros(n, n);
    let add = |mut sum: DMatrix<f64>, start: usize| {
        let x = block(columns, start, BLOCK.min(bins - start));
        sum.gemm(1.0, &x, &x.transpose(), 1.0);
        sum
    };
    let starts: Vec<usize> = (0..bins).step_by(BLOCK).collect();
    // In fixed groups, so that the sum does not depend on the number of threads.
    let groups: Vec<DMatrix<f64>> =
        starts.par_chunks(32).map(|group| group.iter().copied().fold(zero(), add)).collect();
    groups.into_iter().fold(zero(), |sum, g| sum + g)
}

//! A whole column from a few measured bins.
//!
//! The set says how columns vary: coefficients are independent with variances v_j. What a few bins tell is then a linear
//! prediction (ridge regression with the set as its prior), and how much stays unknown does not depend on the values, only on the
//! bins: each next one is the bin that lowers the total remaining variance most.
//!
//! ```text
//! L = B √v,   S = (I + L_sᵀ L_s/σ²)⁻¹          gain of bin b = |√v S l_b|²/(l_bᵀ S l_b + σ²)
//! c = √v L_sᵀ (L_s L_sᵀ + σ² I)⁻¹ x_s
//! ```
//!
//! σ² = 0.001 in x (3 % of f) stands for the noise of a measurement and keeps the system well conditioned.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use super::{Basis, Error};
use crate::brdf::table::Known;

/// Variance of a measured x.
pub(super) const NOISE: f64 = 1e-3;

/// A column of which some bins were measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Reconstruction {
    /// Values in 1/sr: measured ones as they were given.
    pub values: Vec<f32>,
    /// How each bin is known: [`Known::Measured`] or [`Known::Inferred`].
    pub known: Vec<Known>,
    /// The coefficients.
    pub coefficients: Vec<f64>,
}

impl Basis {
    /// The bins to measure, the most telling first: at most `count`, fewer where the set has fewer components.
    ///
    /// Needs as much memory again as the components.
    #[must_use]
    pub fn choose(&self, count: usize) -> Vec<usize> {
        let k = self.components();
        if k == 0 {
            return Vec::new();
        }
        let bins = self.mapping().bins();
        let deviations: Vec<f64> = self.variances().iter().map(|v| v.sqrt()).collect();
        #[expect(clippy::cast_possible_truncation, reason = "as precise as the components")]
        let scaled = |bin: usize, j: usize| (f64::from(self.row(bin)[j]) * deviations[j]) as f32;
        // S l_b of every bin, brought up to date with each chosen one.
        let mut remaining: Vec<f32> =
            (0..bins).flat_map(|bin| (0..k).map(move |j| (bin, j))).map(|(b, j)| scaled(b, j)).collect();
        let mut chosen = Vec::with_capacity(count.min(k));
        for _ in 0..count.min(k).min(bins) {
            let gain = |(bin, m): (usize, &[f32])| {
                let (mut own, mut all) = (NOISE, 0.0);
                for (j, m) in m.iter().enumerate() {
                    let m = f64::from(*m);
                    own += m * f64::from(scaled(bin, j));
                    all += m * m * self.variances()[j];
                }
                (all / own, bin)
            };
            let better = |a: (f64, usize), b: (f64, usize)| if b.0 > a.0 || (b.0 == a.0 && b.1 < a.1) { b } else { a };
            let (_, best) =
                remaining.par_chunks(k).enumerate().map(gain).reduce(|| (f64::NEG_INFINITY, usize::MAX), better);
            let direction: Vec<f64> = remaining[best * k..][..k].iter().map(|v| f64::from(*v)).collect();
            let own = NOISE + direction.iter().enumerate().map(|(j, d)| d * f64::from(scaled(best, j))).sum::<f64>();
            chosen.push(best);
            remaining.par_chunks_mut(k).enumerate().for_each(|(bin, m)| {
                let common =
                    direction.iter().enumerate().map(|(j, d)| d * f64::from(scaled(bin, j))).sum::<f64>() / own;
                #[expect(clippy::cast_possible_truncation, reason = "as precise as the components")]
                m.iter_mut().zip(&direction).for_each(|(m, d)| *m -= (common * d) as f32);
            });
        }
        chosen
    }

    /// The column of which the values of some bins were measured, in 1/sr.
    ///
    /// # Errors
    /// [`Error::Bin`] for a bin that the set does not have or that is given twice.
    pub fn infer(&self, measured: &[(usize, f64)]) -> Result<Reconstruction, Error> {
        let bins = self.mapping().bins();
        let mut known = vec![Known::Inferred; bins];
        for &(bin, _) in measured {
            match known.get_mut(bin) {
                Some(k @ Known::Inferred) => *k = Known::Measured,
                _ => return Err(Error::Bin { bin, bins }),
            }
        }
        let (n, k) = (measured.len(), self.components());
        let rows = DMatrix::from_fn(n, k, |i, j| f64::from(self.row(measured[i].0)[j]) * self.variances()[j].sqrt());
        let x = DVector::from_iterator(n, measured.iter().map(|&(bin, value)| self.centred(bin, value)));
        let system = &rows * rows.transpose() + DMatrix::identity(n, n) * NOISE;
        // Positive definite by its noise.
        let solved = Cholesky::new(system).map_or_else(|| DVector::zeros(n), |c| c.solve(&x));
        let scores = rows.tr_mul(&solved);
        let coefficients: Vec<f64> = scores.iter().zip(self.variances()).map(|(s, v)| s * v.sqrt()).collect();
        let mut values = self.reconstruct(&coefficients)?;
        for &(bin, value) in measured {
            #[expect(clippy::cast_possible_truncation, reason = "columns are kept in single precision")]
            let single = value as f32;
            values[bin] = single;
        }
        Ok(Reconstruction { values, known, coefficients })
    }
}

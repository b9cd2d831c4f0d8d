//! P. E. Debevec and J. Malik, *Recovering High Dynamic Range Radiance Maps from Photographs*, SIGGRAPH 1997, equation 3.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::{Curve, Exposures, GAUGE, LEVELS};
use crate::capture::Error;

/// Weight of a code: a triangle of 1 at the ends, as OpenCV has it (the paper's is 0 there).
fn hat(z: usize) -> f64 {
    if z < GAUGE { z as f64 + 1.0 } else { (LEVELS - z) as f64 }
}

/// ln g of each channel by least squares: all exposures of all pixels, and λ w(z) g''(z) = 0. With the stack sampled as
/// OpenCV does and λ = 10 it is what `CalibrateDebevec` solves; here in double precision and with the unknown radiances eliminated,
/// one 256 × 256 system per channel. It may decrease where few pixels have a code.
///
/// # Errors
/// [`Error::TooFew`] without two exposure times, [`Error::Singular`].
pub fn debevec(stacks: &[Exposures], lambda: f64) -> Result<Vec<Curve>, Error> {
    stacks.iter().try_for_each(Exposures::check)?;
    let channels = stacks.first().map_or(0, |s| s.channels);
    (0..channels).map(|c| solve(stacks, c, lambda)).collect()
}

/// The curve of one channel.
pub(super) fn solve(stacks: &[Exposures], channel: usize, lambda: f64) -> Result<Curve, Error> {
    let mut normal = DMatrix::zeros(LEVELS, LEVELS);
    let mut right = DVector::zeros(LEVELS);
    for stack in stacks {
        let ln_t: Vec<f64> = stack.times_s.iter().map(|t| t.ln()).collect();
        for pixel in 0..stack.pixels() {
            let codes: Vec<usize> = (0..ln_t.len()).map(|j| stack.code(j, pixel, channel)).collect();
            // The paper's weights multiply the equations: squared in the normal ones.
            let weights: Vec<f64> = codes.iter().map(|z| hat(*z).powi(2)).collect();
            eliminate(&mut normal, &mut right, &codes, &weights, &ln_t);
        }
    }
    for k in 1..LEVELS - 1 {
        let w = (lambda * hat(k)).powi(2);
        for (a, i) in [1.0, -2.0, 1.0].into_iter().zip(k - 1..) {
            for (b, j) in [1.0, -2.0, 1.0].into_iter().zip(k - 1..) {
                normal[(i, j)] += w * a * b;
            }
        }
    }
    normal[(GAUGE, GAUGE)] += 1.0;
    let solved = Cholesky::new(normal).ok_or(Error::Singular { what: "response" })?.solve(&right);
    let zero = solved[GAUGE];
    Ok(Curve { ln_g: solved.iter().map(|g| g - zero).collect(), covariance: None })
}

/// Adds Σ w (g(z) − e − ln t)² of one pixel with its best e to normal equations of g.
pub(super) fn eliminate(
    normal: &mut DMatrix<f64>,
    right: &mut DVector<f64>,
    codes: &[usize],
    weights: &[f64],
    ln_t: &[f64],
) {
    let total: f64 = weights.iter().sum();
    if total <= 0.0 {
        return;
    }
    let mean_ln_t = weights.iter().zip(ln_t).map(|(w, t)| w * t).sum::<f64>() / total;
    for (j, (z, w)) in codes.iter().zip(weights).enumerate().filter(|(_, (_, w))| **w > 0.0) {
        normal[(*z, *z)] += w;
        right[*z] += w * (ln_t[j] - mean_ln_t);
        for (other, v) in codes.iter().zip(weights) {
            normal[(*z, *other)] -= w * v / total;
        }
    }
}

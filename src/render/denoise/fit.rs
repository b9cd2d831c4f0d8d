//! What each neighbour counts towards a pixel, by a weighted fit of a plane to what the camera saw.
//!
//! ```text
//! min over (a, b) of Σ_q w_q (L_q − a − b·(f_q − f_p))² + λ Σ_k b_k² M_kk     L̂_p = a = Σ_q κ_q L_q
//! κ_q = w_q (s·x_q),   M s = e₀,   M = Σ_q w_q x_q x_qᵀ,   x_q = (1, f_q − f_p)
//! ```
//!
//! κ depends on the features and the weights alone, so that all bands are filtered by the same numbers.
//!
//! Reference: B. Bitterli, F. Rousselle, B. Moon, J. A. Iglesias-Guitián, D. Adler, K. Mitchell, W. Jarosz, J. Novák, *Nonlinearly Weighted
//! First-order Regression for Denoising Monte Carlo Renderings*, Computer Graphics Forum 35(4) (2016), sec. 4.

use nalgebra::{SMatrix, SVector};

use super::record::{FEATURES, narrow};

/// Unknowns: the value and its slopes.
const UNKNOWNS: usize = FEATURES + 1;
/// λ.
const RIDGE: f64 = 1e-3;

/// Sums of the fits of a row of pixels.
pub(super) struct Fits {
    width: usize,
    /// The lower half of M, row by row, each for all pixels: Σ w x_j x_k.
    sums: Vec<f32>,
    /// s, unknown by unknown.
    solutions: Vec<f32>,
}

/// Sums that a pixel has.
const SUMS: usize = UNKNOWNS * (UNKNOWNS + 1) / 2;

impl Fits {
    pub(super) fn new(width: usize) -> Self {
        Self { width, sums: vec![0.0; SUMS * width], solutions: vec![0.0; UNKNOWNS * width] }
    }

    /// Forgets all neighbours.
    pub(super) fn clear(&mut self) {
        self.sums.fill(0.0);
    }

    /// Adds neighbours of the pixels from `first` on: their weights and, feature by feature, by how much they differ.
    pub(super) fn add(&mut self, first: usize, weights: &[f32], differences: &[Vec<f32>; FEATURES]) {
        let mut sums = self.sums.chunks_exact_mut(self.width).map(|sums| &mut sums[first..][..weights.len()]);
        let mut next = || sums.next().expect("as many as there are pairs");
        next().iter_mut().zip(weights).for_each(|(sum, w)| *sum += w);
        for (j, a) in differences.iter().enumerate() {
            next().iter_mut().zip(weights.iter().zip(a)).for_each(|(sum, (w, a))| *sum += w * a);
            for b in &differences[..=j] {
                next()
                    .iter_mut()
                    .zip(weights.iter().zip(a.iter().zip(b)))
                    .for_each(|(sum, (w, (a, b)))| *sum += w * a * b);
            }
        }
    }

    /// Solves them.
    pub(super) fn solve(&mut self) {
        let width = self.width;
        for x in 0..width {
            let solution = solve(|pair| f64::from(self.sums[pair * width + x]));
            for (unknown, s) in solution.iter().enumerate() {
                self.solutions[unknown * width + x] = narrow(*s);
            }
        }
    }

    /// Writes κ of neighbours of the pixels from `first` on, given as to [`Fits::add`].
    pub(super) fn apply(&self, first: usize, weights: &[f32], differences: &[Vec<f32>; FEATURES], kernel: &mut [f32]) {
        let kernel = &mut kernel[..weights.len()];
        let mut solutions = self.solutions.chunks_exact(self.width).map(|s| &s[first..][..weights.len()]);
        let mut next = || solutions.next().expect("as many as unknowns");
        kernel.copy_from_slice(next());
        for difference in differences {
            kernel.iter_mut().zip(next().iter().zip(difference)).for_each(|(sum, (s, d))| *sum += s * d);
        }
        kernel.iter_mut().zip(weights).for_each(|(k, w)| *k *= w);
    }
}

/// s of a pixel, given the sums; 0 without neighbours.
fn solve(sum: impl Fn(usize) -> f64) -> [f64; UNKNOWNS] {
    let index = |j: usize, k: usize| j * (j + 1) / 2 + k;
    let mut solution = [0.0; UNKNOWNS];
    let total = sum(0);
    if total <= 0.0 {
        return solution;
    }
    // Scaled so that the diagonal is 1: features have different units. What does not vary says nothing.
    let scale: [f64; UNKNOWNS] = std::array::from_fn(|k| {
        let square = sum(index(k, k));
        if square > 0.0 { square.sqrt().recip() } else { 0.0 }
    });
    let matrix = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::from_fn(|j, k| match j == k {
        true if j == 0 => 1.0,
        true => 1.0 + RIDGE,
        false => scale[j] * scale[k] * sum(index(j.max(k), j.min(k))),
    });
    let mut right = SVector::<f64, UNKNOWNS>::zeros();
    right[0] = scale[0];
    match matrix.cholesky() {
        Some(factor) => {
            let scaled = factor.solve(&right);
            solution.iter_mut().zip(scaled.iter().zip(scale)).for_each(|(s, (v, scale))| *s = v * scale);
        }
        // Rounded away: the plain mean.
        None => solution[0] = 1.0 / total,
    }
    solution
}

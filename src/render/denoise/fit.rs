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
use super::tile::{TILE, Tile};

/// Unknowns: the value and its slopes.
const UNKNOWNS: usize = FEATURES + 1;
/// λ.
const RIDGE: f64 = 1e-3;

/// Sums that a pixel has.
const SUMS: usize = UNKNOWNS * (UNKNOWNS + 1) / 2;

/// The fits of a tile.
pub(super) struct Fits {
    /// The lower half of M, row by row: Σ w x_j x_k.
    sums: [Tile; SUMS],
    /// s.
    solutions: [Tile; UNKNOWNS],
}

impl Default for Fits {
    fn default() -> Self {
        Self { sums: [[0.0; TILE]; SUMS], solutions: [[0.0; TILE]; UNKNOWNS] }
    }
}

impl Fits {
    /// Forgets all neighbours.
    pub(super) fn clear(&mut self) {
        self.sums = [[0.0; TILE]; SUMS];
    }

    /// Adds a neighbour of each pixel: its weight and, feature by feature, by how much it differs.
    #[inline(always)]
    pub(super) fn add(&mut self, weights: &Tile, differences: &[Tile; FEATURES]) {
        let [first, ..] = &mut self.sums;
        for i in 0..TILE {
            first[i] += weights[i];
        }
        for j in 0..FEATURES {
            let sums = &mut self.sums[index(j + 1, 0)..];
            let mut weighted = [0.0; TILE];
            for i in 0..TILE {
                weighted[i] = weights[i] * differences[j][i];
                sums[0][i] += weighted[i];
            }
            for k in 0..=j {
                for i in 0..TILE {
                    sums[k + 1][i] += weighted[i] * differences[k][i];
                }
            }
        }
    }

    /// Solves them.
    #[inline(never)]
    pub(super) fn solve(&mut self) {
        for i in 0..TILE {
            let solution = solve(|pair| f64::from(self.sums[pair][i]));
            self.solutions.iter_mut().zip(solution).for_each(|(all, s)| all[i] = narrow(s));
        }
    }

    /// κ of a neighbour, given as to [`Fits::add`].
    #[inline(always)]
    pub(super) fn kernel(&self, weights: &Tile, differences: &[Tile; FEATURES]) -> Tile {
        let [mut kernel, slopes @ ..] = self.solutions;
        for k in 0..FEATURES {
            for i in 0..TILE {
                kernel[i] += slopes[k][i] * differences[k][i];
            }
        }
        for i in 0..TILE {
            kernel[i] *= weights[i];
        }
        kernel
    }
}

/// Where the sum of a pair of unknowns stands, j ≥ k.
#[inline(always)]
fn index(j: usize, k: usize) -> usize {
    j * (j + 1) / 2 + k
}

/// s of a pixel, given the sums; 0 without neighbours.
fn solve(sum: impl Fn(usize) -> f64) -> [f64; UNKNOWNS] {
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

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

use super::record::{FEATURES, narrow};
use super::tile::{TILE, Tile};

/// Unknowns at most: the value and its slopes.
const UNKNOWNS: usize = FEATURES + 1;
/// λ.
const RIDGE: f64 = 1e-3;

/// Sums that a pixel has.
const SUMS: usize = UNKNOWNS * (UNKNOWNS + 1) / 2;
/// Pixels that are solved for together: numbers of so many fill the widest register.
const LANES: usize = 8;
/// A number of each of them.
type Lanes = [f64; LANES];

/// The fits of a tile, by as many features as vary there.
pub(super) struct Fits {
    features: usize,
    /// The lower half of M, row by row: Σ w x_j x_k.
    sums: [Tile; SUMS],
    /// s.
    solutions: [Tile; UNKNOWNS],
}

impl Default for Fits {
    fn default() -> Self {
        Self { features: FEATURES, sums: [[0.0; TILE]; SUMS], solutions: [[0.0; TILE]; UNKNOWNS] }
    }
}

impl Fits {
    /// Forgets all neighbours; those to come have so many features.
    pub(super) fn start(&mut self, features: usize) {
        self.features = features;
        self.sums[..index(features + 1, 0)].fill([0.0; TILE]);
    }

    /// Adds a neighbour of each pixel: its weight and, feature by feature, by how much it differs.
    #[inline(always)]
    pub(super) fn add(&mut self, weights: &Tile, differences: &[Tile; FEATURES]) {
        let [first, ..] = &mut self.sums;
        for i in 0..TILE {
            first[i] += weights[i];
        }
        for j in 0..self.features {
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
    #[inline(always)]
    pub(super) fn solve(&mut self) {
        for first in (0..TILE).step_by(LANES) {
            let mut sums = [[0.0; LANES]; SUMS];
            for (sum, all) in sums.iter_mut().zip(&self.sums[..index(self.features + 1, 0)]) {
                for i in 0..LANES {
                    sum[i] = f64::from(all[first + i]);
                }
            }
            let solutions = solve(sums, self.features + 1);
            for (all, solution) in self.solutions.iter_mut().zip(&solutions[..=self.features]) {
                for i in 0..LANES {
                    all[first + i] = narrow(solution[i]);
                }
            }
        }
    }

    /// κ of a neighbour, given as to [`Fits::add`].
    #[inline(always)]
    pub(super) fn kernel(&self, weights: &Tile, differences: &[Tile; FEATURES]) -> Tile {
        let [first, slopes @ ..] = &self.solutions;
        let mut kernel = *first;
        for k in 0..self.features {
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

/// s of some pixels, given the sums of so many unknowns; 0 without neighbours. By Cholesky's factors of M, scaled so that its diagonal is 1, as features have
/// different units. What does not vary says nothing.
#[inline(always)]
fn solve(mut sums: [Lanes; SUMS], unknowns: usize) -> [Lanes; UNKNOWNS] {
    let total = sums[0];
    let mut scale = [[0.0; LANES]; UNKNOWNS];
    for k in 0..unknowns {
        let square = sums[index(k, k)];
        for i in 0..LANES {
            scale[k][i] = if square[i] > 0.0 { square[i].sqrt().recip() } else { 0.0 };
        }
    }
    for j in 0..unknowns {
        for k in 0..j {
            for i in 0..LANES {
                sums[index(j, k)][i] *= scale[j][i] * scale[k][i];
            }
        }
        sums[index(j, j)] = [if j == 0 { 1.0 } else { 1.0 + RIDGE }; LANES];
    }
    // M = L Lᵀ, L in the place of M but for its diagonal, of which the inverse is kept.
    let (mut inverse, mut sound) = ([[0.0; LANES]; UNKNOWNS], [true; LANES]);
    for j in 0..unknowns {
        for k in 0..=j {
            let mut left = sums[index(j, k)];
            for l in 0..k {
                for i in 0..LANES {
                    left[i] -= sums[index(j, l)][i] * sums[index(k, l)][i];
                }
            }
            if k < j {
                for i in 0..LANES {
                    sums[index(j, k)][i] = left[i] * inverse[k][i];
                }
            } else {
                for i in 0..LANES {
                    sound[i] &= left[i] > 0.0;
                    inverse[j][i] = left[i].sqrt().recip();
                }
            }
        }
    }
    // L y = e₀, Lᵀ s = y.
    let mut solution = [[0.0; LANES]; UNKNOWNS];
    solution[0] = scale[0];
    for j in 0..unknowns {
        for k in 0..j {
            for i in 0..LANES {
                solution[j][i] -= sums[index(j, k)][i] * solution[k][i];
            }
        }
        for i in 0..LANES {
            solution[j][i] *= inverse[j][i];
        }
    }
    for j in (0..unknowns).rev() {
        for k in j + 1..unknowns {
            for i in 0..LANES {
                solution[j][i] -= sums[index(k, j)][i] * solution[k][i];
            }
        }
        for i in 0..LANES {
            solution[j][i] *= inverse[j][i];
        }
    }
    for j in 0..unknowns {
        for i in 0..LANES {
            // Rounded away: the plain mean.
            let mean = if j == 0 { 1.0 / total[i] } else { 0.0 };
            let found = if sound[i] { solution[j][i] * scale[j][i] } else { mean };
            solution[j][i] = if total[i] > 0.0 { found } else { 0.0 };
        }
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;

    /// Against the equation that defines it, (M + λ diag(0, M₁₁, …)) s = e₀, of features in different units, one of which does not vary; the plain mean where
    /// there is nothing else to tell, and nothing without neighbours.
    #[test]
    fn what_is_solved_is_the_solution() {
        let (mut fits, mut stream) = (Fits::default(), Stream::new(12, 1));
        fits.start(FEATURES);
        let mut uniform = || stream.uniforms::<1>()[0] as f32;
        for _ in 0..40 {
            let mut weights: Tile = std::array::from_fn(|_| uniform());
            (weights[0], weights[63]) = (0.0, 0.0);
            let differences = std::array::from_fn(|feature| {
                let unit = if feature == 3 { 0.0 } else { 10_f32.powi(2 * (feature as i32) - 6) };
                std::array::from_fn(|i| if i == 1 { 0.0 } else { unit * (uniform() - 0.4) })
            });
            fits.add(&weights, &differences);
        }
        fits.solve();
        for i in 0..TILE {
            let m = |j: usize, k: usize| f64::from(fits.sums[index(j.max(k), j.min(k))][i]);
            let s: [f64; UNKNOWNS] = std::array::from_fn(|k| f64::from(fits.solutions[k][i]));
            if m(0, 0) == 0.0 {
                assert_eq!(s, [0.0; UNKNOWNS]);
                continue;
            }
            for j in 0..UNKNOWNS {
                let terms = (0..UNKNOWNS).map(|k| m(j, k) * (if j == k && j > 0 { 1.0 + RIDGE } else { 1.0 }) * s[k]);
                let (sum, size) = terms.fold((0.0, 0.0), |(sum, size), term: f64| (sum + term, size + term.abs()));
                // Solutions are kept in single precision: each term to half a unit in the last place.
                let expected = if j == 0 { 1.0 } else { 0.0 };
                assert!((sum - expected).abs() <= 0.5 * f64::from(f32::EPSILON) * size, "{i} {j}: {sum}");
            }
            if i == 1 {
                assert_eq!(s[1..], [0.0; FEATURES]);
            }
        }
    }
}

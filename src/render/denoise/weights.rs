//! How alike pixels are: weights of non-local means.
//!
//! ```text
//! w(p, q) = exp(−max(0, d)),   d = mean over the pixels of two patches of ((L_p − L_q)² − s²) / (k² s²),   s² = σ²_p + min(σ²_p, σ²_q)
//! ```
//!
//! What two pixels differ by through their noise alone is taken off, so that pixels count as alike that cannot be told apart. The paper divides by
//! σ²_p + σ²_q; here a quiet pixel takes nothing from one that may be as bright by its own noise alone, as at the rim of a caustic.
//!
//! Reference: F. Rousselle, C. Knaus, M. Zwicker, *Adaptive Rendering with Non-local Means Filtering*, ACM TOG 31(6) (2012), eq. 3 and 4.

use super::plane::Plane;
use crate::render::lanes::add;

/// Pixels to each side in a patch.
const PATCH: usize = 1;
/// k: what is told apart.
const STRENGTH: f32 = 1.0;

/// A luminance and its variance, pixel by pixel, by which pixels are compared.
pub(super) struct Guide {
    pub(super) luminance: Plane,
    /// Smooth: a single pixel's is a guess.
    pub(super) variance: Plane,
}

impl Guide {
    /// Writes the weights of the pixels (x + dx, y + dy) for all pixels x of row y; 0 outside of the picture. `scratch` has room for
    /// [`scratch`] of the row's length.
    #[inline(always)]
    pub(super) fn weigh(&self, y: usize, [dx, dy]: [isize; 2], scratch: &mut [f32], weights: &mut [f32]) {
        let (width, height) = (self.luminance.width(), self.luminance.height());
        weights.fill(0.0);
        let Some(columns) = overlap(width, dx) else { return };
        if y.checked_add_signed(dy).is_none_or(|row| row >= height) {
            return;
        }
        scratch.fill(0.0);
        // Between margins of 0, which patches at the picture's sides reach into.
        let distances = &mut scratch[PATCH..][..columns.len()];
        let mut rows = 0.0;
        for row in y.saturating_sub(PATCH)..(y + PATCH + 1).min(height) {
            let Some(beside) = row.checked_add_signed(dy).filter(|row| *row < height) else { continue };
            rows += 1.0;
            let shifted = columns.start.strict_add_signed(dx)..columns.end.strict_add_signed(dx);
            let [a, va] = [&self.luminance, &self.variance].map(|plane| &plane.row(row)[columns.clone()]);
            let [b, vb] = [&self.luminance, &self.variance].map(|plane| &plane.row(beside)[shifted.clone()]);
            for (i, distance) in distances.iter_mut().enumerate() {
                let (difference, variance) = (a[i] - b[i], va[i] + va[i].min(vb[i]));
                // Without noise whatever differs is told apart.
                *distance +=
                    (difference * difference - variance) / (STRENGTH * STRENGTH * variance + f32::MIN_POSITIVE);
            }
        }
        let weights = &mut weights[columns];
        for place in 0..=2 * PATCH {
            add(weights, &scratch[place..]);
        }
        let last = weights.len() - 1;
        for (at, weight) in weights.iter_mut().enumerate() {
            #[expect(clippy::cast_precision_loss, reason = "a few pixels")]
            let pixels = (at.min(PATCH) + (last - at).min(PATCH) + 1) as f32;
            let distance = *weight / (rows * pixels);
            *weight = -distance.max(0.0);
        }
        exponentiate(weights);
    }
}

/// The numbers of scratch that weighing needs for rows of a length.
pub(super) fn scratch(width: usize) -> usize {
    width + 2 * PATCH
}

/// eˣ of numbers that are not above 0, to 3·10⁻⁷ of it; 0 below −87. (That of the standard library is not compiled for many numbers at a time.)
#[inline(always)]
fn exponentiate(numbers: &mut [f32]) {
    /// Added to a number up to 2²² it leaves the nearest whole number in the last bits.
    const ROUND: f32 = 12_582_912.0;
    /// ln 2 in two parts, the first of few bits: its products with whole numbers are exact.
    const LN_2: [f32; 2] = [0.693_359_4, -2.121_944_4e-4];
    for number in numbers {
        let x = number.max(-87.0);
        let rounded = x * std::f32::consts::LOG2_E + ROUND;
        let whole = rounded - ROUND;
        // |r| ≤ ln 2 / 2: the series' next term is r⁷/5040 ≤ 1.2·10⁻⁷.
        let r = x - whole * LN_2[0] - whole * LN_2[1];
        let series = 1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r / 720.0)))));
        // 2ⁿ: n in the place of the exponent.
        let power = f32::from_bits((rounded.to_bits() << 23).wrapping_add(1.0_f32.to_bits()));
        *number = if *number < -87.0 { 0.0 } else { series * power };
    }
}

/// The columns x for which x + dx lies in a row as well.
pub(super) fn overlap(width: usize, dx: isize) -> Option<std::ops::Range<usize>> {
    let (start, end) = (dx.min(0).unsigned_abs(), width.checked_sub(dx.max(0).unsigned_abs())?);
    (start < end).then_some(start..end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_is_that_of_the_library() {
        let given: Vec<f32> = (0..100_000).map(|i| -1e-3 * i as f32).collect();
        let mut found = given.clone();
        exponentiate(&mut found);
        for (x, found) in given.iter().zip(found) {
            let expected = if *x < -87.0 { 0.0 } else { f64::from(*x).exp() };
            assert!((f64::from(found) - expected).abs() <= 3e-7 * expected, "{x} {found} {expected}");
        }
    }
}

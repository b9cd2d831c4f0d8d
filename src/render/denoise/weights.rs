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
    /// Writes the weights of the pixels (x + dx, y + dy) for all pixels x of row y; 0 outside of the picture. `scratch` has the row's length.
    pub(super) fn weigh(&self, y: usize, [dx, dy]: [isize; 2], scratch: &mut [f32], weights: &mut [f32]) {
        let (width, height) = (self.luminance.width(), self.luminance.height());
        weights.fill(0.0);
        let Some(columns) = overlap(width, dx) else { return };
        if y.checked_add_signed(dy).is_none_or(|row| row >= height) {
            return;
        }
        scratch.fill(0.0);
        let mut rows = 0.0;
        for row in y.saturating_sub(PATCH)..(y + PATCH + 1).min(height) {
            let Some(beside) = row.checked_add_signed(dy).filter(|row| *row < height) else { continue };
            rows += 1.0;
            let shifted = columns.start.strict_add_signed(dx)..columns.end.strict_add_signed(dx);
            let here = self.luminance.row(row)[columns.clone()].iter().zip(&self.variance.row(row)[columns.clone()]);
            let there = self.luminance.row(beside)[shifted.clone()].iter().zip(&self.variance.row(beside)[shifted]);
            for (distance, ((a, va), (b, vb))) in scratch[columns.clone()].iter_mut().zip(here.zip(there)) {
                let (difference, variance) = (a - b, va + va.min(*vb));
                // Without noise whatever differs is told apart.
                *distance +=
                    (difference * difference - variance) / (STRENGTH * STRENGTH * variance + f32::MIN_POSITIVE);
            }
        }
        let distances = &scratch[columns.clone()];
        for (at, weight) in weights[columns].iter_mut().enumerate() {
            let patch = &distances[at.saturating_sub(PATCH)..(at + PATCH + 1).min(distances.len())];
            #[expect(clippy::cast_precision_loss, reason = "a few pixels")]
            let distance = patch.iter().sum::<f32>() / (rows * patch.len() as f32);
            *weight = (-distance.max(0.0)).exp();
        }
    }
}

/// The columns x for which x + dx lies in a row as well.
pub(super) fn overlap(width: usize, dx: isize) -> Option<std::ops::Range<usize>> {
    let (start, end) = (dx.min(0).unsigned_abs(), width.checked_sub(dx.max(0).unsigned_abs())?);
    (start < end).then_some(start..end)
}

//! The choice of one light among many, for a point that is to be lit.

use glam::DVec3;

use crate::render::scene::Scene;

/// The lights' shares of the choice at one point: proportional to the bounds on what they can do there.
#[derive(Debug, Clone, Default)]
pub struct Choice {
    /// Running sums of the importances.
    sums: Vec<f64>,
}

impl Choice {
    /// Weighs all lights for the point `from`.
    pub fn prepare(&mut self, scene: &Scene, from: DVec3) {
        self.sums.clear();
        let mut sum = 0.0;
        self.sums.extend(scene.lights().iter().map(|light| {
            sum += light.importance(from);
            sum
        }));
    }

    /// A light drawn by one uniform number, with its probability and the number stretched to [0, 1) again; `None` where nothing shines.
    #[must_use]
    pub fn draw(&self, u: f64) -> Option<(usize, f64, f64)> {
        let total = *self.sums.last()?;
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let target = u * total;
        let index = self.sums.partition_point(|&s| s <= target).min(self.sums.len() - 1);
        let below = if index == 0 { 0.0 } else { self.sums[index - 1] };
        let share = self.sums[index] - below;
        Some((index, share / total, ((target - below) / share).clamp(0.0, 1.0 - f64::EPSILON / 2.0)))
    }

    /// The probability of a light.
    #[must_use]
    pub fn probability(&self, light: usize) -> f64 {
        let total = self.sums.last().copied().unwrap_or(0.0);
        let below = if light == 0 { 0.0 } else { self.sums[light - 1] };
        if total > 0.0 { (self.sums[light] - below) / total } else { 0.0 }
    }
}

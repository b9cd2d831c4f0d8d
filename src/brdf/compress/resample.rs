//! Materials of any kind on the bins of a resolution.

use glam::DVec3;
use rayon::prelude::*;

use super::Grid;
use crate::brdf::table::{Channel, HalfAngle, Resolution};

/// The table of what `at` gives in the middle of every bin that is above the horizon: it writes the values in 1/sr, one per channel, of
/// two directions, ω_i first, and tells whether they are known. The other bins are missing.
///
/// # Panics
/// Without channels, or for a resolution out of range.
#[must_use]
pub fn resample(
    resolution: Resolution,
    channels: Vec<Channel>,
    at: impl Fn(DVec3, DVec3, &mut [f64]) -> bool + Sync,
) -> HalfAngle {
    let n = channels.len();
    let grid = Grid::new(resolution);
    let mut values = vec![f32::NAN; n * resolution.bins()];
    let slow = n * resolution.theta_d * resolution.phi_d;
    values.par_chunks_mut(slow).enumerate().for_each(|(h, values)| {
        let of_angle = |h: usize| grid.bins().partition_point(|b| *b < h * slow / n);
        let mut found = vec![0.0; n];
        for i in of_angle(h)..of_angle(h + 1) {
            let (incident, outgoing) = grid.directions(i);
            if at(incident, outgoing, &mut found) {
                let place = (grid.bins()[i] - h * slow / n) * n;
                #[expect(clippy::cast_possible_truncation, reason = "tables are kept in single precision")]
                values[place..][..n].iter_mut().zip(&found).for_each(|(v, f)| *v = *f as f32);
            }
        }
    });
    HalfAngle::new(resolution, channels, values).expect("as many values as bins")
}

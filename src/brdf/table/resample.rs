//! Materials of any kind in bins of half and difference angles.

use glam::DVec3;
use rayon::prelude::*;

use super::{Channel, HalfAngle, Resolution};

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
    let mut values = vec![f32::NAN; n * resolution.bins()];
    let layer = resolution.theta_d * resolution.phi_d;
    values.par_chunks_mut(n * layer).enumerate().for_each(|(h, values)| {
        let mut found = vec![0.0; n];
        for (i, bin) in values.chunks_exact_mut(n).enumerate() {
            let (incident, outgoing) = resolution.centre(h * layer + i).directions();
            if incident.z > 0.0 && outgoing.z > 0.0 && at(incident, outgoing, &mut found) {
                #[expect(clippy::cast_possible_truncation, reason = "tables are kept in single precision")]
                bin.iter_mut().zip(&found).for_each(|(v, f)| *v = *f as f32);
            }
        }
    });
    HalfAngle::new(resolution, channels, values).expect("as many values as bins")
}

//! M. A. Robertson, S. Borman and R. L. Stevenson, *Estimation-theoretic approach to dynamic range enhancement using multiple
//! exposures*, Journal of Electronic Imaging 12 (2003), section 3.

use super::samples::nothing_shared;
use super::{Curve, Exposures, GAUGE, LEVELS};
use crate::capture::Error;

/// Weight of a code: a bell, 0 at the ends.
fn bell(z: usize) -> f64 {
    let at = 4.0 * z as f64 / (LEVELS - 1) as f64 - 2.0;
    ((-at * at).exp() - (-4.0_f64).exp()) / (1.0 - (-4.0_f64).exp())
}

/// ln g of each channel by alternating means from a linear start: radiances from g, then g at a code as the mean exposure of the
/// pixels that have it. Codes that no pixel within the range has are interpolated in ln g, those at the ends continued with the
/// slope beside them: no value is without number.
///
/// # Errors
/// [`Error::TooFew`] without two exposure times, [`Error::NothingShared`] without a pixel within the range.
pub fn robertson(stacks: &[Exposures], rounds: usize) -> Result<Vec<Curve>, Error> {
    stacks.iter().try_for_each(Exposures::check)?;
    let channels = stacks.first().map_or(0, |s| s.channels);
    (0..channels).map(|c| alternate(stacks, c, rounds)).collect()
}

fn alternate(stacks: &[Exposures], channel: usize, rounds: usize) -> Result<Curve, Error> {
    let mut ln_g = Curve::linear().ln_g;
    for _ in 0..rounds {
        let g: Vec<f64> = ln_g.iter().map(|l| l.exp()).collect();
        let (mut sums, mut counts) = (vec![0.0; LEVELS], vec![0.0; LEVELS]);
        for stack in stacks {
            for pixel in 0..stack.pixels() {
                let (mut above, mut below) = (0.0, 0.0);
                for (j, t) in stack.times_s.iter().enumerate() {
                    let z = stack.code(j, pixel, channel);
                    above += bell(z) * t * g[z];
                    below += bell(z) * t * t;
                }
                if below <= 0.0 {
                    continue;
                }
                for (j, t) in stack.times_s.iter().enumerate() {
                    let z = stack.code(j, pixel, channel);
                    // Pixels at the ends of the range say only that the exposure is beyond it.
                    if bell(z) > 0.0 {
                        sums[z] += above / below * t;
                        counts[z] += 1.0;
                    }
                }
            }
        }
        let known: Vec<(usize, f64)> = (0..LEVELS)
            .filter(|z| counts[*z] > 0.0 && sums[*z] > 0.0)
            .map(|z| (z, (sums[z] / counts[z]).ln()))
            .collect();
        if known.len() < 2 {
            return Err(nothing_shared(stacks, channel));
        }
        let next: Vec<f64> = (0..LEVELS).map(|z| between(&known, z)).collect();
        let gauge = next[GAUGE];
        ln_g = next.iter().map(|l| l - gauge).collect();
    }
    Ok(Curve { ln_g, covariance: None })
}

/// The line through the known codes beside `z`, or through the two nearest at an end.
fn between(known: &[(usize, f64)], z: usize) -> f64 {
    let above = known.partition_point(|(k, _)| *k < z).clamp(1, known.len() - 1);
    let ((a, low), (b, high)) = (known[above - 1], known[above]);
    low + (high - low) * (z as f64 - a as f64) / (b as f64 - a as f64)
}

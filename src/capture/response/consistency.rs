//! Whether exposures agree with one another.

use std::ops::RangeInclusive;

use super::{Curve, Exposures, weight};
use crate::capture::Error;

/// Share of the pixels of a pair of exposures from which on an order is believed: more than noise moves.
const MOST_OUT_OF_ORDER: f64 = 0.5;
/// Codes by which two exposures differ at least where they count: more than noise, also in the dark.
const TELLING: u8 = 8;
/// Codes that are compared: nearer to black, noise that cannot go below 0 draws the mean up; nearer to white, down.
const COMPARED: RangeInclusive<usize> = 16..=240;
/// Times closer than this factor are not ordered.
const DISTINCT: f64 = 1.2;

/// Agreement of one exposure with the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    /// The stack.
    pub stack: String,
    /// The photograph.
    pub name: String,
    /// Its time, s.
    pub time_s: f64,
    /// Weighted mean of ln(g(z)/t) less that of the pixel's other exposures; a wrong time shows here.
    pub offset_ln: f64,
    /// Weighted rms of the residuals.
    pub rms_ln: f64,
    /// Samples within the range.
    pub samples: usize,
}

/// Agreement of all exposures under a response.
#[derive(Debug, Clone, PartialEq)]
pub struct Consistency {
    /// Weighted rms of ln(g(z)/t) about the mean of its pixel, over all channels and stacks.
    pub rms_ln: f64,
    /// Each exposure.
    pub exposures: Vec<Share>,
}

/// Measures how far exposures disagree under curves, one per channel.
#[must_use]
pub fn consistency(stacks: &[Exposures], curves: &[Curve]) -> Consistency {
    let (mut square, mut total) = (0.0, 0.0);
    let mut exposures = Vec::new();
    for stack in stacks {
        let count = stack.times_s.len();
        let (mut offsets, mut squares) = (vec![0.0; count], vec![0.0; count]);
        let (mut weights, mut samples) = (vec![0.0; count], vec![0; count]);
        for pixel in 0..stack.pixels() {
            for (channel, curve) in curves.iter().enumerate() {
                let each: Vec<(usize, f64, f64)> = (0..count)
                    .map(|j| {
                        let z = stack.code(j, pixel, channel);
                        let w = if COMPARED.contains(&z) { weight(z as f64) * certainty(curve, z) } else { 0.0 };
                        (j, w, curve.ln_g[z] - stack.times_s[j].ln())
                    })
                    .filter(|(_, w, _)| *w > 0.0)
                    .collect();
                let sum: f64 = each.iter().map(|(_, w, _)| w).sum();
                if each.len() < 2 {
                    continue;
                }
                let mean = each.iter().map(|(_, w, e)| w * e).sum::<f64>() / sum;
                for (j, w, e) in each {
                    let others = (mean * sum - w * e) / (sum - w);
                    offsets[j] += w * (e - others);
                    squares[j] += w * (e - mean).powi(2);
                    weights[j] += w;
                    samples[j] += 1;
                }
            }
        }
        square += squares.iter().sum::<f64>();
        total += weights.iter().sum::<f64>();
        for j in 0..count {
            let w = f64::max(weights[j], f64::MIN_POSITIVE);
            exposures.push(Share {
                stack: stack.name.clone(),
                name: stack.names[j].clone(),
                time_s: stack.times_s[j],
                offset_ln: offsets[j] / w,
                rms_ln: (squares[j] / w).sqrt(),
                samples: samples[j],
            });
        }
    }
    Consistency { rms_ln: (square / f64::max(total, f64::MIN_POSITIVE)).sqrt(), exposures }
}

/// How much less a code says than that of a linear camera: where the curve is steep, as in the black of a scan, an error of a code is
/// a large one of ln g.
fn certainty(curve: &Curve, z: usize) -> f64 {
    let steepness = (z as f64 + 1.0) * curve.slope(z as f64);
    steepness.max(1.0).powi(-2)
}

/// Refuses stacks in which a longer exposure is darker than a shorter one, whatever the response: photographs or times swapped.
///
/// # Errors
/// [`Error::Order`], naming the pair that is furthest apart in time.
pub fn check_order(stacks: &[Exposures]) -> Result<(), Error> {
    let mut worst: Option<(f64, Error)> = None;
    for stack in stacks {
        for (long, longer_s) in stack.times_s.iter().enumerate() {
            for (short, shorter_s) in stack.times_s.iter().enumerate().filter(|(_, s)| **s * DISTINCT < *longer_s) {
                let pairs = stack.codes[long].iter().zip(&stack.codes[short]);
                let told = pairs.clone().filter(|(l, s)| l.abs_diff(**s) >= TELLING).count();
                let darker = pairs.filter(|(l, s)| s.saturating_sub(**l) >= TELLING).count();
                let share = darker as f64 / told.max(1) as f64;
                let ratio = longer_s / shorter_s;
                if share > MOST_OUT_OF_ORDER && worst.as_ref().is_none_or(|(r, _)| ratio > *r) {
                    let error = Error::Order {
                        longer: stack.names[long].clone(),
                        longer_s: *longer_s,
                        shorter: stack.names[short].clone(),
                        shorter_s: *shorter_s,
                        percent: 100.0 * share,
                    };
                    worst = Some((ratio, error));
                }
            }
        }
    }
    worst.map_or(Ok(()), |(_, error)| Err(error))
}

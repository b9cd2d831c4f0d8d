//! Whether exposures agree with one another.

use super::{Curve, Exposures, GAUGE, LEVELS};
use crate::capture::Error;

/// Share of the pixels of a pair of exposures from which on an order is believed: more than noise moves.
const MOST_OUT_OF_ORDER: f64 = 0.5;
/// Codes by which two exposures differ at least where they count: more than noise, also in the dark.
const TELLING: u8 = 8;
/// Standard deviations of the noise that a code is away from black and white where it is compared: nearer, noise that cannot go beyond the
/// end draws means inwards, by less than 1e-4 of its standard deviation from here on.
const CLEAR: f64 = 3.5;
/// Normal: standard deviations per median of the absolute value.
const PER_MEDIAN: f64 = 1.482_602_218_505_602;
/// Noise of ln g up to which a code is compared: of more than that the mean is not that of the exposure, because curves bend, most of all where
/// the black of a scan makes them steep.
const BLURRED: f64 = 0.25;
/// Least change of ln g over a code: where a curve is flat a code tells nothing.
const FLAT: f64 = 1e-3;
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

/// A sample: its exposure, its weight by the noise of codes, ln(g(z)/t).
type Sample = (usize, f64, f64);

/// The codes of a curve that are compared where a code has a `noise`: well inside of where it is neither blurred nor at an end. Both are
/// exclusive.
fn compared(curve: &Curve, noise: f64) -> (f64, f64) {
    let blurred = |z: &usize| curve.slope(*z as f64) * noise >= BLURRED;
    let low = (0..GAUGE).rev().find(blurred).unwrap_or(0);
    let high = (GAUGE..LEVELS).find(blurred).unwrap_or(LEVELS - 1);
    (low as f64 + CLEAR * noise, high as f64 - CLEAR * noise)
}

/// Calls `with` for each pixel and channel that two exposures show where a `noise` of so many codes lets them be compared.
fn each_pixel(stack: &Exposures, curves: &[Curve], noise: f64, with: &mut impl FnMut(&[Sample])) {
    let ranges: Vec<(f64, f64)> = curves.iter().map(|c| compared(c, noise)).collect();
    let mut seen: Vec<Sample> = Vec::new();
    for pixel in 0..stack.pixels() {
        for (channel, curve) in curves.iter().enumerate() {
            seen.clear();
            let (low, high) = ranges[channel];
            for (j, time_s) in stack.times_s.iter().enumerate() {
                let z = stack.code(j, pixel, channel);
                if low < z as f64 && (z as f64) < high {
                    let slope = curve.slope(z as f64).max(FLAT);
                    seen.push((j, slope.powi(-2), curve.ln_g[z] - time_s.ln()));
                }
            }
            if seen.len() > 1 {
                with(&seen);
            }
        }
    }
}

/// Sum of weights, and mean.
fn mean(samples: &[Sample]) -> (f64, f64) {
    let sum: f64 = samples.iter().map(|(_, w, _)| w).sum();
    (sum, samples.iter().map(|(_, w, e)| w * e).sum::<f64>() / sum)
}

/// Noise of a code: from the median of the residuals, which moved pixels do not disturb.
fn noise(stacks: &[Exposures], curves: &[Curve]) -> f64 {
    let mut residuals = Vec::new();
    for stack in stacks {
        each_pixel(stack, curves, 0.0, &mut |samples| {
            let n = samples.len() as f64;
            let (_, mean) = mean(samples);
            residuals.extend(samples.iter().map(|(_, w, e)| (n / (n - 1.0) * w).sqrt() * (e - mean).abs()));
        });
    }
    if residuals.is_empty() {
        return 0.0;
    }
    let middle = residuals.len() / 2;
    PER_MEDIAN * *residuals.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Measures how far exposures disagree under curves, one per channel. Samples weigh as the noise of codes has it: by (d ln g/dz)⁻².
#[must_use]
pub fn consistency(stacks: &[Exposures], curves: &[Curve]) -> Consistency {
    let noise = noise(stacks, curves);
    let (mut square, mut total) = (0.0, 0.0);
    let mut exposures = Vec::new();
    for stack in stacks {
        let count = stack.times_s.len();
        let (mut offsets, mut squares) = (vec![0.0; count], vec![0.0; count]);
        let (mut weights, mut samples) = (vec![0.0; count], vec![0; count]);
        each_pixel(stack, curves, noise, &mut |seen| {
            let (sum, mean) = mean(seen);
            for (j, w, e) in seen {
                let others = (mean * sum - w * e) / (sum - w);
                offsets[*j] += w * (e - others);
                squares[*j] += w * (e - mean).powi(2);
                weights[*j] += w;
                samples[*j] += 1;
            }
        });
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

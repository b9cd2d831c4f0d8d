//! Propagation of distributions (JCGM 101): seeded, in parallel, and the same to the last bit for any number of threads.
//!
//! Trials come in batches. Every trial draws from a stream of its own, named by the seed and its number, and leaves its figures in
//! its own row; the statistics of a batch are summed in the order of the trials. The adaptive procedure of JCGM 101, 7.9 adds
//! batches until twice the standard deviations of the averages over batches of estimate, standard uncertainty and both ends of the
//! interval are below half a unit of the last digit that the standard uncertainty is stated with. What is stated is the average over
//! batches, so that memory holds one batch.

use rayon::prelude::*;

use super::Outputs;
use super::budget::MonteCarlo;
use super::model::Model;
use crate::math::random::Stream;

/// Trials of a batch (JCGM 101, 7.9.4: the larger of 10⁴ and 100/(1 − p)).
const BATCH: u64 = 10_000;
/// Trials that a thread takes at a time.
const AT_ONCE: usize = 64;
/// Ends of the probabilistically symmetric interval of 95 %.
const ENDS: [f64; 2] = [0.025, 0.975];
/// A spread below this share of the estimate is rounding.
const ROUNDING: f64 = 1e-12;

/// What the trials say of one figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampled {
    /// Mean of the trials.
    pub mean: f64,
    /// Their standard deviation.
    pub standard: f64,
    /// 2.5 % and 97.5 % of the trials lie below these.
    pub expanded_95: [f64; 2],
    /// Share of the trials in which the figure is not defined; the other numbers are of the rest.
    pub undefined: f64,
    /// Standard errors of the four numbers before; infinite with a single batch.
    pub errors: [f64; 4],
}

/// All trials.
pub(super) struct Simulation {
    pub figures: Vec<Sampled>,
    pub trials: u64,
    /// The figures that had not settled at the last trial allowed; none where the number of trials was fixed.
    pub unsettled: Vec<usize>,
}

/// Half a unit of the last of `digits` significant digits of a standard uncertainty.
pub(super) fn tolerance(standard: f64, digits: i32) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "exponents of doubles are small")]
    let exponent = standard.log10().floor() as i32;
    0.5 * 10f64.powi(exponent - (digits - 1))
}

/// Mean, standard deviation and both ends, of one batch.
type Four = [f64; 4];

/// Simulates until all is told.
pub(super) fn simulate(model: &Model, figures: &impl Outputs, settings: &MonteCarlo) -> Simulation {
    let count = figures.count();
    let (batch, most) = match settings.trials {
        Some(trials) => {
            let batches = trials.div_ceil(BATCH);
            (trials.div_ceil(batches), batches)
        }
        None => (BATCH, settings.most_trials.div_ceil(BATCH)),
    };
    let mut table = vec![0.0; usize::try_from(batch).unwrap_or(usize::MAX) * count];
    let mut batches: Vec<Vec<(Four, f64)>> = Vec::new();
    let mut done = 0;
    let mut unsettled = Vec::new();
    while done < most {
        fill(model, figures, settings.seed, done * batch, &mut table);
        let column = |k: usize| statistics(table.iter().skip(k).step_by(count).copied());
        batches.push((0..count).into_par_iter().map(column).collect());
        done += 1;
        if settings.trials.is_none() && done > 1 {
            unsettled = (0..count).filter(|k| !settled(&combined(&batches, *k), settings.digits.0)).collect();
            if unsettled.is_empty() {
                break;
            }
        }
    }
    let figures = (0..count).map(|k| combined(&batches, k)).collect();
    Simulation { figures, trials: done * batch, unsettled }
}

/// The figures of a batch of trials, one row each.
fn fill(model: &Model, figures: &impl Outputs, seed: u64, first: u64, table: &mut [f64]) {
    let count = figures.count();
    let room = || (vec![0.0; model.values().len()], Vec::new(), Default::default());
    table.par_chunks_mut(count * AT_ONCE).enumerate().for_each_init(
        room,
        |(values, factors, scratch), (chunk, rows)| {
            for (i, row) in rows.chunks_exact_mut(count).enumerate() {
                let mut stream = Stream::new(seed, first + (chunk * AT_ONCE + i) as u64);
                model.trial(&mut stream, factors, values);
                figures.evaluate(values, scratch, row);
            }
        },
    );
}

/// The statistics of the defined values, and the share of the others.
fn statistics(values: impl Iterator<Item = f64>) -> (Four, f64) {
    let (mut kept, mut all) = (Vec::new(), 0_usize);
    for v in values {
        all += 1;
        if v.is_finite() {
            kept.push(v);
        }
    }
    let undefined = 1.0 - kept.len() as f64 / all as f64;
    if kept.len() < 2 {
        return ([f64::NAN; 4], undefined);
    }
    let n = kept.len() as f64;
    // About the first value, so that a spread far below the value keeps its digits.
    let origin = kept[0];
    let shift = kept.iter().map(|v| v - origin).sum::<f64>() / n;
    let squares: f64 = kept.iter().map(|v| (v - origin - shift).powi(2)).sum();
    kept.sort_unstable_by(f64::total_cmp);
    let [low, high] = ENDS.map(|share| {
        let place = share * (n - 1.0);
        let below = place.floor();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in the list")]
        let (i, t) = (below as usize, place - below);
        kept[i] + t * (kept[(i + 1).min(kept.len() - 1)] - kept[i])
    });
    ([origin + shift, (squares / (n - 1.0)).sqrt(), low, high], undefined)
}

/// The averages over batches of one figure, with their standard errors.
fn combined(batches: &[Vec<(Four, f64)>], figure: usize) -> Sampled {
    let n = batches.len() as f64;
    let of = |k: usize| batches.iter().map(move |b| b[figure].0[k]);
    let mean = |k: usize| of(k).sum::<f64>() / n;
    let error = |k: usize| {
        let m = mean(k);
        // JCGM 101, eq. 20.
        if n > 1.0 { (of(k).map(|v| (v - m).powi(2)).sum::<f64>() / (n * (n - 1.0))).sqrt() } else { f64::INFINITY }
    };
    Sampled {
        mean: mean(0),
        standard: mean(1),
        expanded_95: [mean(2), mean(3)],
        undefined: batches.iter().map(|b| b[figure].1).sum::<f64>() / n,
        errors: [0, 1, 2, 3].map(error),
    }
}

fn settled(s: &Sampled, digits: i32) -> bool {
    // What is nowhere defined, or does not vary, will not change.
    if !s.standard.is_finite() || s.standard <= ROUNDING * s.mean.abs() {
        return true;
    }
    let tolerance = tolerance(s.standard, digits);
    s.errors.iter().all(|e| 2.0 * e < tolerance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tolerance_is_half_a_unit_of_the_last_digit() {
        // JCGM 101, 7.9.2, example 1: u = 0.000 35 g with two digits is 35·10⁻⁵ g, δ = 5·10⁻⁶ g; example 3: u = 2 K, one digit, δ = 0.5 K.
        assert!((tolerance(0.000_35, 2) / 5e-6 - 1.0).abs() < 1e-12);
        assert!((tolerance(2.0, 1) / 0.5 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn statistics_are_those_of_numpy() {
        // numpy 2.3 of [1, 2, 3, 4, 10]: std(ddof=1) and quantile([.025, .975]); the NaN is left out.
        let ([mean, standard, low, high], undefined) = statistics([3.0, f64::NAN, 1.0, 10.0, 2.0, 4.0].into_iter());
        assert!((mean - 4.0).abs() < 1e-15 && (standard - 3.535_533_905_932_738).abs() < 1e-14, "{mean} {standard}");
        assert!((low - 1.1).abs() < 1e-14 && (high - 9.4).abs() < 1e-14, "{low} {high}");
        assert!((undefined - 1.0 / 6.0).abs() < 1e-15);
    }
}

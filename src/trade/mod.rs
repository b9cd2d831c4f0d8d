//! What a setting costs in time and what it costs in accuracy: sweeps over settings, each timed and compared with the best
//! reference there is; the front of those that nothing beats in both, and the cheapest that meets an error.
//!
//! Errors are distances from the reference, in the unit of their [`Figure`] and never negative. Where the error itself is an
//! estimate (from seeds), it has an interval; where it is computed, the interval has no width. The reference is not perfect either:
//! its own error ([`Sweep::reference_errors`]) is added wherever an error must be guaranteed, and differences below it are noise.

pub mod brdf;
pub mod capture;
pub mod image;
pub mod lamp;
pub mod picture;
pub mod render;
pub mod require;
pub mod spectrum;
pub mod timing;

use std::borrow::Cow;

use serde::Serialize;

use self::timing::Timing;

/// How a figure's errors are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Measure {
    /// |value/reference − 1|.
    Relative,
    /// |value − reference|, or the distance of points, in the figure's unit.
    Absolute,
}

/// A figure whose error is watched.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Figure {
    /// Its key, or the name of the sensor that reads it.
    pub key: Cow<'static, str>,
    /// Unit of its error: empty for relative errors and for numbers without one.
    pub unit: &'static str,
    /// How its error is measured.
    pub measure: Measure,
}

impl Figure {
    /// A figure with relative errors.
    #[must_use]
    pub const fn relative(key: &'static str) -> Self {
        Self { key: Cow::Borrowed(key), unit: "", measure: Measure::Relative }
    }

    /// A figure with errors in a unit.
    #[must_use]
    pub const fn absolute(key: &'static str, unit: &'static str) -> Self {
        Self { key: Cow::Borrowed(key), unit, measure: Measure::Absolute }
    }
}

/// An error with its interval at 95 % confidence. Of a method with seeds, `error` is the root of the mean square over them, and `high` what
/// 95 % of other runs stay below, with a confidence that holds for all settings of a sweep at once.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The best estimate.
    pub error: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Estimate {
    /// An error that is computed and not estimated.
    #[must_use]
    pub const fn exact(error: f64) -> Self {
        Self { error, low: error, high: error }
    }
}

/// A choice of settings that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The value of each knob, in words, in the order of [`Sweep::knobs`].
    pub settings: Vec<String>,
    /// Whether the program can be told to work like this; what cannot be told is measured, and never recommended.
    pub offered: bool,
    /// What it took.
    pub timing: Timing,
    /// Its errors, one per figure; `None` where the figure could not be determined.
    pub errors: Vec<Option<Estimate>>,
}

/// Trials of one input.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// What was compared with, in words.
    pub reference: String,
    /// The knobs.
    pub knobs: Vec<&'static str>,
    /// The figures.
    pub figures: Vec<Figure>,
    /// The error of the reference itself, one per figure; `None` where the reference has no such figure.
    pub reference_errors: Vec<Option<f64>>,
    /// The trials.
    pub trials: Vec<Trial>,
}

/// What turning one knob alone did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effect {
    /// The largest change of the error.
    pub error: f64,
    /// The largest ratio of the times.
    pub time_ratio: f64,
    /// Whether the error moved by more than the reference's own and than the intervals.
    pub matters: bool,
}

impl Sweep {
    /// The error of a trial that is guaranteed: the upper end of its interval and the reference's own error on top.
    #[must_use]
    pub fn bound(&self, trial: usize, figure: usize) -> Option<f64> {
        Some(self.trials[trial].errors[figure]?.high + self.reference_errors[figure]?)
    }

    /// Whether the trial cannot be told from the reference.
    #[must_use]
    pub fn is_within_noise(&self, trial: usize, figure: usize) -> bool {
        let (Some(e), Some(reference)) = (self.trials[trial].errors[figure], self.reference_errors[figure]) else {
            return false;
        };
        e.low <= reference
    }

    /// The trials that no other one beats in both time and guaranteed error (Pareto), from the fastest on.
    #[must_use]
    pub fn front(&self, figure: usize) -> Vec<usize> {
        let error = |i: &usize| self.bound(*i, figure);
        let mut order: Vec<usize> = (0..self.trials.len()).filter(|i| error(i).is_some()).collect();
        order.sort_by(|a, b| {
            let times = self.trials[*a].timing.median_s.total_cmp(&self.trials[*b].timing.median_s);
            times.then(error(a).unwrap_or_default().total_cmp(&error(b).unwrap_or_default()))
        });
        let mut best = f64::INFINITY;
        order.retain(|i| {
            let e = error(i).unwrap_or(f64::INFINITY);
            let better = e < best;
            best = best.min(e);
            better
        });
        order
    }

    /// The fastest trial offered whose guaranteed error is within the target.
    #[must_use]
    pub fn recommend(&self, figure: usize, target: f64) -> Option<usize> {
        let meets = |i: &usize| self.trials[*i].offered && self.bound(*i, figure).is_some_and(|e| e <= target);
        let time = |i: usize| self.trials[i].timing.median_s;
        (0..self.trials.len()).filter(meets).min_by(|a, b| time(*a).total_cmp(&time(*b)))
    }

    /// What a knob does: over all pairs of trials that differ in it alone. `None` where there is no such pair.
    #[must_use]
    pub fn effect(&self, knob: usize, figure: usize) -> Option<Effect> {
        let mut found: Option<Effect> = None;
        for (i, a) in self.trials.iter().enumerate() {
            for b in &self.trials[..i] {
                let differing = a.settings.iter().zip(&b.settings).enumerate().filter(|(_, (x, y))| x != y);
                if !differing.map(|(k, _)| k).eq([knob]) {
                    continue;
                }
                let (Some(x), Some(y), Some(own)) = (a.errors[figure], b.errors[figure], self.reference_errors[figure])
                else {
                    continue;
                };
                let ratio = a.timing.median_s / b.timing.median_s;
                let apart = (x.low - y.high).max(y.low - x.high);
                let one = Effect {
                    error: (x.error - y.error).abs(),
                    time_ratio: ratio.max(1.0 / ratio),
                    matters: apart > own,
                };
                found = Some(found.map_or(one, |f| Effect {
                    error: f.error.max(one.error),
                    time_ratio: f.time_ratio.max(one.time_ratio),
                    matters: f.matters || one.matters,
                }));
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(settings: [&str; 2], seconds: f64, error: f64) -> Trial {
        Trial {
            settings: settings.map(str::to_owned).to_vec(),
            offered: true,
            timing: Timing { median_s: seconds, low_s: seconds, high_s: seconds, repeats: 1 },
            errors: vec![Some(Estimate { error, low: 0.9 * error, high: 1.1 * error })],
        }
    }

    fn sweep() -> Sweep {
        Sweep {
            reference: "closed form".to_owned(),
            knobs: vec!["step", "rule"],
            figures: vec![Figure::relative("photopic")],
            reference_errors: vec![Some(0.001)],
            trials: vec![
                trial(["1", "sum"], 4.0, 0.01),
                trial(["5", "sum"], 2.0, 0.1),
                trial(["5", "exact"], 3.0, 0.2),
                trial(["1", "exact"], 8.0, 0.01),
            ],
        }
    }

    #[test]
    fn the_front_has_what_nothing_beats() {
        assert_eq!(sweep().front(0), [1, 0]);
    }

    #[test]
    fn the_fastest_that_meets_the_target_is_recommended_and_the_reference_counts() {
        let s = sweep();
        assert_eq!(s.recommend(0, 0.2), Some(1));
        // 0.11 + 0.001 is guaranteed and no less.
        assert_eq!((s.recommend(0, 0.1105), s.recommend(0, 0.1111)), (Some(0), Some(1)));
        assert_eq!((s.recommend(0, 0.0119), s.recommend(0, 0.0121)), (None, Some(0)));
    }

    #[test]
    fn a_knob_is_judged_by_the_pairs_that_differ_in_it_alone() {
        let s = sweep();
        let step = s.effect(0, 0).expect("pairs");
        assert!((step.error - 0.19).abs() < 1e-12 && step.matters);
        let rule = s.effect(1, 0).expect("pairs");
        assert!((rule.error - 0.1).abs() < 1e-12 && (rule.time_ratio - 2.0).abs() < 1e-12 && rule.matters);
        let mut quiet = s.clone();
        quiet.trials.truncate(1);
        quiet.trials.push(trial(["1", "exact"], 8.0, 0.0105));
        assert!(!quiet.effect(1, 0).expect("a pair").matters);
        assert_eq!(quiet.effect(0, 0), None);
    }
}

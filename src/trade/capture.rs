//! The trade of a photographed BRDF: how many lights, exposures and pixels it takes.
//!
//! | knob | values |
//! |---|---|
//! | `lights` | all under which the object was photographed, half, a quarter |
//! | `exposures` | all of a stack, half, one |
//! | `every` | every pixel; every 2nd, 4th, 8th of every so many-th row |
//!
//! **Figures**: `f_r_median` and `f_r_p90`, median and 90th percentile of |f/f₀ − 1| over the bins and bands of the finest setting, f the robust
//! mean of a bin; one that a setting does not measure is off by more than any number, so that a setting that loses half of the bins has no
//! median, and one that loses a tenth no 90th percentile; `coverage_lost`, the share of the finest setting's bins without a measurement; then each parameter of the
//! fitted model, relative.
//!
//! **Reference**: the finest setting, which is no truth: all errors are relative to it. Its own is that of its standard errors: their median and
//! 90th percentile over the bins, relative, and 1.96 of those of its parameters; they are on top of every error that is guaranteed. What a
//! parameter happened to be off by says little of another run: 1.96 of the setting's own standard errors are its interval. What camera, lights
//! and object are off from what is stated hits all settings alike and does not show.
//!
//! The time is that of everything: reading, developing, measuring, sorting into bins, fitting.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::timing::interleaved;
use super::{Estimate, Figure, Measure, Sweep, Trial};
use crate::brdf::description::template::Template;
use crate::brdf::fit::{self, Fit, Uncertainty};
use crate::brdf::table::Resolution;
use crate::capture::brdf::{Binned, Observations, bin};

/// Every so many-th pixel is tried.
const EVERY: [usize; 4] = [1, 2, 4, 8];
/// Standard errors that 95 % of a normal distribution are within.
const CONFIDENT: f64 = 1.96;
/// Share of the bins below the larger of the two figures of f_r.
const HIGH: f64 = 0.9;

/// The figures that do not depend on the model.
pub static FIGURES: [Figure; 3] =
    [Figure::relative("f_r_median"), Figure::relative("f_r_p90"), Figure::absolute("coverage_lost", "")];

/// How much was used in a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice {
    /// Lights.
    pub lights: usize,
    /// Exposures of a stack at most.
    pub exposures: usize,
    /// Every so many-th pixel of every so many-th row.
    pub every: usize,
}

/// All choices of what there is, the finest first.
#[must_use]
pub fn choices(lights: usize, exposures: usize) -> Vec<Choice> {
    let mut of_lights = vec![lights, lights.div_ceil(2), lights.div_ceil(4)];
    of_lights.dedup();
    let mut of_exposures = vec![exposures, exposures.div_ceil(2), 1];
    of_exposures.dedup();
    let with = |lights: usize| of_exposures.iter().map(move |exposures| (lights, *exposures));
    let both = of_lights.into_iter().flat_map(with);
    both.flat_map(|(lights, exposures)| EVERY.map(|every| Choice { lights, exposures, every })).collect()
}

/// A sweep, what was chosen in each of its trials, and what failed.
#[derive(Debug)]
pub struct CaptureSweep {
    /// The trials.
    pub sweep: Sweep,
    /// Their choices.
    pub choices: Vec<Choice>,
    /// Choices that gave no result, and why, in words.
    pub failed: Vec<(Choice, String)>,
}

/// What a setting gave.
pub(super) struct Outcome {
    pub all: Observations,
    pub binned: Binned,
    pub fit: Fit,
}

impl Outcome {
    /// Of measurements, or of why there are none.
    pub fn new(
        measured: Result<(Observations, f64), String>,
        (template, options): (&Template, &fit::Options),
        resolution: Resolution,
    ) -> Result<Self, CaptureError> {
        let (all, pixel_variance_sd) = measured.map_err(CaptureError::Measure)?;
        let samples = all.samples(pixel_variance_sd)?;
        let (binned, fit) = (bin(&all, resolution), fit::fit(template, &samples, options)?);
        Ok(Self { all, binned, fit })
    }
}

/// Why photographs could not be traded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CaptureError {
    /// Nothing was measured.
    #[error("{0}")]
    Measure(String),
    /// No fit.
    #[error(transparent)]
    Fit(#[from] fit::Error),
    /// No choices.
    #[error("found nothing to try; expected one setting or more")]
    NoChoice,
}

/// Choices that were tried and compared with the first of them, the finest.
pub(super) struct Compared {
    pub choices: Vec<Choice>,
    /// What they gave.
    pub outcomes: Vec<Outcome>,
    /// Their errors.
    pub errors: Vec<Vec<Option<Estimate>>>,
    pub figures: Vec<Figure>,
    pub reference_errors: Vec<Option<f64>>,
    pub failed: Vec<(Choice, String)>,
}

/// Tries the choices, the first of which is the finest.
pub(super) fn compare(
    choices: Vec<Choice>,
    mut outcome: impl FnMut(&Choice) -> Result<Outcome, CaptureError>,
) -> Result<Compared, CaptureError> {
    let (mut tried, mut outcomes, mut failed) = (Vec::new(), Vec::new(), Vec::new());
    for choice in choices {
        match outcome(&choice) {
            Ok(found) => {
                tried.push(choice);
                outcomes.push(found);
            }
            Err(error) if tried.is_empty() => return Err(error),
            Err(error) => failed.push((choice, error.to_string())),
        }
    }
    let finest = outcomes.first().ok_or(CaptureError::NoChoice)?;
    let parameters = finest.fit.estimates.iter().map(|e| {
        let name = finest.fit.name_of(e);
        let key = e.band.map_or_else(|| name.clone(), |b| format!("{name}.{}", finest.all.channels[b]));
        Figure { key: Cow::Owned(key), unit: "", measure: Measure::Relative }
    });
    let figures: Vec<Figure> = FIGURES.iter().cloned().chain(parameters).collect();
    let mut reference_errors = own_errors(&finest.binned).to_vec();
    reference_errors.extend(finest.fit.estimates.iter().map(|e| Some(CONFIDENT * relative_error(e)?)));
    let errors = outcomes.iter().map(|o| errors(finest, o)).collect();
    Ok(Compared { choices: tried, errors, figures, reference_errors, failed, outcomes })
}

/// Tries the choices, the first of which is the finest, each timed `repeats` times. `measure` does all from the photographs to the measurements,
/// and says the relative standard uncertainty of the variance of a pixel's area ([`Observations::samples`]).
///
/// # Errors
/// [`CaptureError`] of the finest; what another choice does is in [`CaptureSweep::failed`].
pub fn sweep(
    choices: Vec<Choice>,
    (template, options): (&Template, &fit::Options),
    resolution: Resolution,
    repeats: usize,
    mut measure: impl FnMut(&Choice) -> Result<(Observations, f64), String>,
) -> Result<CaptureSweep, CaptureError> {
    let mut outcome = |choice: &Choice| Outcome::new(measure(choice), (template, options), resolution);
    let compared = compare(choices, &mut outcome)?;
    let timings = interleaved(compared.choices.len(), repeats, |i| outcome(&compared.choices[i]))?;
    let Compared { choices, errors, figures, reference_errors, failed, .. } = compared;
    let trials = choices.iter().zip(timings).zip(errors).map(|((choice, timing), errors)| Trial {
        settings: [choice.lights, choice.exposures, choice.every].map(|n| n.to_string()).to_vec(),
        offered: true,
        timing,
        errors,
    });
    let sweep = Sweep {
        reference: "the finest setting: all lights, exposures and pixels".to_owned(),
        knobs: vec!["lights", "exposures", "every"],
        figures,
        reference_errors,
        trials: trials.collect(),
    };
    Ok(CaptureSweep { sweep, choices, failed })
}

/// The relative standard errors of the finest setting's bins: median and [`HIGH`] percentile; its coverage is what it is.
fn own_errors(finest: &Binned) -> [Option<f64>; 3] {
    let each = finest.bins.iter().flat_map(|b| b.errors.iter().zip(&b.values).map(|(e, v)| (e / v).abs()));
    let each: Vec<f64> = each.collect();
    [percentile(each.clone(), 0.5), percentile(each, HIGH), Some(0.0)]
}

/// Standard error of a parameter, relative; none where it has none, or rests at a bound.
fn relative_error(estimate: &fit::Estimate) -> Option<f64> {
    let Uncertainty::Known { standard, robust } = estimate.uncertainty else { return None };
    Some(standard.max(robust) / estimate.value.abs()).filter(|e| e.is_finite())
}

/// The errors of all figures against the finest setting.
fn errors(finest: &Outcome, found: &Outcome) -> Vec<Option<Estimate>> {
    let parameters = finest.fit.estimates.iter().zip(&found.fit.estimates).map(|(a, b)| {
        let (error, own) = ((b.value / a.value - 1.0).abs(), CONFIDENT * relative_error(b)?);
        let found = Estimate { error, low: (error - own).max(0.0), high: error + own };
        error.is_finite().then_some(found)
    });
    let figures = apart(&finest.binned, &found.binned).map(|e| e.map(Estimate::exact));
    figures.into_iter().chain(parameters).collect()
}

/// How far bins are from those of the finest setting: the errors of [`FIGURES`].
pub(super) fn apart(finest: &Binned, found: &Binned) -> [Option<f64>; 3] {
    let own: BTreeMap<usize, &[f64]> = found.bins.iter().map(|b| (b.bin, b.values.as_slice())).collect();
    let apart = finest.bins.iter().flat_map(|a| {
        let found = own.get(&a.bin);
        (a.values.iter().enumerate()).map(move |(band, a)| found.map_or(f64::INFINITY, |b| (b[band] / a - 1.0).abs()))
    });
    let apart: Vec<f64> = apart.collect();
    let lost = finest.bins.iter().filter(|b| !own.contains_key(&b.bin)).count();
    [percentile(apart.clone(), 0.5), percentile(apart, HIGH), Some(lost as f64 / finest.bins.len() as f64)]
}

/// The value below which a share of them lies (nearest rank); `None` where it is no finite number.
fn percentile(mut values: Vec<f64>, share: f64) -> Option<f64> {
    values.retain(|v| !v.is_nan());
    let place = ((share * values.len() as f64).ceil() as usize).saturating_sub(1);
    let value = (place < values.len()).then(|| *values.select_nth_unstable_by(place, f64::total_cmp).1);
    value.filter(|v| v.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::direction::{from_degrees, tangents};
    use crate::math::random::Stream;
    use glam::DVec3;

    const REFLECTANCE: f64 = 0.5;
    const NOISE: f64 = 0.05;
    const LIGHTS: usize = 8;

    /// What a camera far away sees of a white sphere under some of the lights: every so many-th of 24 × 24 pixels, with a relative noise.
    fn measured(choice: &Choice, seed: u64) -> Observations {
        let mut random = Stream::new(seed, 0);
        let mut all = Observations::new(1);
        for light in (0..LIGHTS).step_by(LIGHTS / choice.lights) {
            let towards = from_degrees(20.0 + 5.0 * light as f64, 360.0 / LIGHTS as f64 * light as f64);
            for (x, y) in (0..24).step_by(choice.every).flat_map(|y| (0..24).step_by(choice.every).map(move |x| (x, y)))
            {
                let at = |n: usize| (n as f64 + 0.5) / 12.0 - 1.0;
                let (x, y) = (at(x), at(y));
                let normal = DVec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt());
                if normal.z < 0.3 || normal.dot(towards) < 0.2 {
                    continue;
                }
                let (t, b) = tangents(normal);
                let local = |d: DVec3| DVec3::new(d.dot(t), d.dot(b), d.dot(normal));
                let [deviate, _] = random.normals();
                let value = REFLECTANCE * std::f64::consts::FRAC_1_PI;
                all.directions.push((local(towards), local(DVec3::Z)));
                all.values.push(value * (1.0 + NOISE * deviate));
                all.errors.push(NOISE * value);
                all.corrections.push(0.0);
            }
        }
        all
    }

    #[test]
    fn what_is_recommended_holds_in_95_of_100_other_captures() {
        let template: Template = "lambert".parse().expect("a model");
        let options = fit::Options::default();
        let resolution = Resolution { theta_h: 10, theta_d: 10, phi_d: 12 };
        let asked = 0.01;
        let model = (&template, &options);
        let found = sweep(choices(LIGHTS, 1), model, resolution, 1, |c| Ok((measured(c, 0), 0.0))).expect("a sweep");
        let figure =
            found.sweep.figures.iter().position(|f| f.key.starts_with("lambert.reflectance")).expect("a figure");
        let recommended = found.choices[found.sweep.recommend(figure, asked).expect("one will do")];
        assert!(recommended != found.choices[0], "{recommended:?}");
        let within = |seed: u64| {
            let outcome = Outcome::new(Ok((measured(&recommended, seed), 0.0)), model, resolution).expect("a fit");
            (outcome.fit.estimates[0].value / REFLECTANCE - 1.0).abs() <= asked
        };
        let held = (1..=200).filter(|seed| within(*seed)).count();
        assert!(held >= 190, "{held} of 200 with {recommended:?}");
        // One light with every 8th pixel: some 5 measurements of 5 % noise, which are off by 2 %, whatever they happened to be off by.
        let coarsest = found.choices.len() - 1;
        assert!(found.sweep.bound(coarsest, figure).is_none_or(|e| e > asked), "{:?}", found.sweep.trials[coarsest]);
    }
}

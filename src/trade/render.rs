//! The trade of a scene: how the readings of its meters change with samples, solver, path length, wavelengths and the extent of the
//! model.
//!
//! | knob | values |
//! |---|---|
//! | `meter_samples` | the scene's own, and 4, 16, 64, 256 times fewer |
//! | `solver` | path tracing; direct light with its mirror images (Whitted); direct light |
//! | `max_edges` | paths of any length, or cut after 3 and 6 edges |
//! | `roulette_from` | the edge from which on chance ends paths: the scene's own, the first, the 16th; of paths of 6 edges also never |
//! | `sampler` | scrambled Sobol' points; independent random numbers |
//! | `wavelengths` | as few as a tolerance allows: the scene's own, 10 times as much and as little; 8, 16, 32 and 81 of them |
//! | `wavelengths_per_path` | all; one, drawn for each path (hero wavelength) |
//! | `model` | what the scene requires, or everything |
//!
//! `bidirectional` is not tried: what it is for, light that glass and mirrors throw on a meter, paths miss however many there are.
//! Here a path with one wavelength takes about the time of one with all; what fewer wavelengths save is seen where there are 8.
//!
//! All but the samples are turned one at a time, at a sixteenth of the scene's samples.
//!
//! **Reference**: everything modelled, by path tracing without limit, four times the scene's samples, with a seed of its own; its own error
//! is 1.96 standard errors. **Errors** come from independent seeds: the root of the mean square distance from the reference, which holds noise
//! and bias alike; its upper end is the tolerance limit |b̄| + k s, below which 95 % of other runs stay. As the fastest of some 25 settings is
//! recommended, and luck is one way to be it, each limit holds with a confidence of 99.8 %: all of them at once in 95 % of sweeps.

use super::timing::{WARM_UPS, interleaved};
use super::{Estimate, Figure, Measure, Sweep, Trial};
use crate::math::student::{tolerance_95, two_sided_95};
use crate::render::bands::RANGE_NM;
use crate::render::build::{Built, Files, Kind, Meshes, Origin};
use crate::render::description::{Carried, Description, Error, Model, Render, Solver};
use crate::render::estimate::REPLICATES;
use crate::render::measure::{Board, Meter, Settings};
use crate::render::reading;
use crate::render::sampler::Points;
use crate::render::spool::Share;

/// Parts of the scene's samples that are tried.
const FEWER: [u64; 5] = [1, 4, 16, 64, 256];
/// The part at which the other knobs are turned.
const PART: u64 = 16;
/// Quantile of the normal distribution of a confidence of 99.8 %.
pub(super) const SURE: f64 = 2.878;
/// Times the scene's samples, for the reference.
pub(super) const MORE: u64 = 4;
/// Numbers of wavelengths that are tried.
const WAVELENGTHS: [u32; 4] = [8, 16, 32, 81];
/// The first edges at which chance may end a path that are tried.
const ROULETTE: [u32; 2] = [1, 16];
/// Edges of paths that are tried.
const EDGES: [u32; 2] = [3, 6];
/// The seeds of the reference and of the trials are this far apart from the scene's.
pub(super) const SEEDS: u64 = 1 << 32;

/// Why a scene could not be traded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The scene cannot be built.
    #[error(transparent)]
    Scene(#[from] Error),
    /// There is nothing to read.
    #[error("1:1: the scene has no meter; expected a sensor that reads a number, as `illuminance` does")]
    NoMeter,
    /// Filtered pictures have four samples a pixel at least, and those that are compared with them a quarter of the scene's.
    #[error("1:1: {0} samples a pixel; expected 16 or more, as pictures of a quarter are tried")]
    FewSamples(u64),
}

/// The knobs of meters and pictures alike.
pub(super) const SHARED: [&str; 7] =
    ["solver", "max_edges", "roulette_from", "sampler", "wavelengths", "wavelengths_per_path", "model"];

/// A sweep, and the settings of each of its trials.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderSweep {
    /// The trials; a figure per meter or grid, or that of a camera, by the sensor's name.
    pub sweep: Sweep,
    /// Their settings.
    pub choices: Vec<Render>,
}

/// A scene under one choice of settings.
pub(super) struct Choice {
    render: Render,
    built: Built,
    meters: Vec<(u64, Meter)>,
    /// Each meter or grid: the place of the instrument, and of its first meter on the board.
    read: Vec<(usize, usize)>,
}

impl Choice {
    pub(super) fn new(origin: Origin<'_>, description: &Description, render: Render) -> Result<Self, Error> {
        let mut description = description.clone();
        description.render = render.clone();
        let built = origin.build(&description)?;
        let (mut meters, mut read) = (Vec::new(), Vec::new());
        for (n, instrument) in built.instruments.iter().enumerate() {
            let own: &[Meter] = match &instrument.kind {
                Kind::Meter(meter) => std::slice::from_ref(meter),
                Kind::Grid { meters, .. } => meters,
                Kind::Camera(_) | Kind::Goniophotometer(_) | Kind::Gonioreflectometer(_) => continue,
            };
            read.push((n, meters.len()));
            meters.extend((0_u64..).zip(own).map(|(point, m)| (((n as u64) << 32) + point, m.clone())));
        }
        Ok(Self { render, built, meters, read })
    }

    /// What was built.
    pub(super) fn built(&self) -> &Built {
        &self.built
    }

    /// Whether there is nothing to read.
    pub(super) fn is_blind(&self) -> bool {
        self.read.is_empty()
    }

    /// Value and standard error of every meter and grid.
    pub(super) fn run(&self, seed: u64) -> Vec<(f64, f64)> {
        let settings = Settings { seed, ..self.built.settings.clone() };
        let mut board = Board::new(&self.built.scene, &settings, Share::WHOLE, self.meters.clone());
        board.sample_until(self.render.meter_samples.div_ceil(REPLICATES as u64));
        let bands = self.built.scene.bands();
        let of = |(instrument, first): &(usize, usize)| {
            let instrument = &self.built.instruments[*instrument];
            reading::of_board(instrument, &board, *first, bands, &self.built.quantities, None)
        };
        self.read.iter().filter_map(of).map(|r| (r.figure.value, r.figure.standard_error)).collect()
    }

    fn words(&self) -> Vec<String> {
        let samples = self.render.meter_samples.to_string();
        [samples].into_iter().chain(words(&self.render, &self.built)).collect()
    }
}

/// The values of the [`SHARED`] knobs.
pub(super) fn words(render: &Render, built: &Built) -> [String; 7] {
    [
        render.solver.word().to_owned(),
        render.max_edges.map_or_else(|| "any".to_owned(), |n| n.to_string()),
        match render.max_edges {
            Some(most) if most < render.roulette_from => "never".to_owned(),
            _ => render.roulette_from.to_string(),
        },
        render.sampler.word().to_owned(),
        match render.wavelength_step_nm {
            Some(_) => built.scene.bands().len().to_string(),
            None => format!("to {}", render.wavelength_tolerance),
        },
        render.wavelengths_per_path.word().to_owned(),
        if render.model == Model::Full { "full" } else { "minimal" }.to_owned(),
    ]
}

/// Tries a scene with `repeats` seeds (at least 5) for each choice of settings; `progress` is told how many renders are done, and of how many.
///
/// # Errors
/// [`RenderError`]: mistakes in the scene, or no meter in it.
pub fn sweep(
    text: &str,
    description: &Description,
    files: &dyn Files,
    repeats: usize,
    mut progress: impl FnMut(usize, usize),
) -> Result<RenderSweep, RenderError> {
    let own = Render { solver: Solver::Path, max_edges: None, ..description.render.clone() };
    let meshes = Meshes::default();
    let make = |render: Render| Choice::new(Origin::new(text, files, &meshes), description, render);
    let samples = MORE * own.meter_samples;
    let best = make(Render { model: Model::Full, meter_samples: samples, ..own.clone() })?;
    if best.is_blind() {
        return Err(RenderError::NoMeter);
    }
    let reference = best.run(own.seed.wrapping_sub(SEEDS));
    let figures = best.read.iter().map(|(n, _)| Figure {
        key: best.built.instruments[*n].name.clone().into(),
        unit: "",
        measure: Measure::Relative,
    });
    let figures = figures.collect();
    let choices = choices(&own).into_iter().map(make).collect::<Result<Vec<_>, _>>()?;
    let mut values = vec![Vec::new(); choices.len()];
    let repeats = repeats.max(5);
    let (mut done, all) = (0, choices.len() * (WARM_UPS + repeats));
    let timings = interleaved(choices.len(), repeats, |i| {
        progress(done, all);
        done += 1;
        let seed = own.seed.wrapping_add(SEEDS * (values[i].len() as u64 + 1));
        values[i].push(choices[i].run(seed));
        Ok::<_, RenderError>(())
    })?;
    let mut trials = Vec::with_capacity(choices.len());
    for ((choice, timing), values) in choices.iter().zip(timings).zip(&values) {
        let errors = reference.iter().enumerate().map(|(f, (truth, _))| {
            let off: Vec<f64> = values.iter().map(|v| v[f].0 / truth - 1.0).collect();
            off.iter().all(|v| v.is_finite()).then(|| of_seeds(&off))
        });
        trials.push(Trial { settings: choice.words(), offered: true, timing, errors: errors.collect() });
    }
    let own_error = |(value, standard_error): &(f64, f64)| {
        let error = 1.96 * standard_error / value.abs();
        error.is_finite().then_some(error)
    };
    let sweep = Sweep {
        reference: format!("everything modelled, paths of any length, {samples} samples of a meter, a seed of its own"),
        knobs: ["meter_samples"].into_iter().chain(SHARED).collect(),
        figures,
        reference_errors: reference.iter().map(own_error).collect(),
        trials,
    };
    Ok(RenderSweep { sweep, choices: choices.into_iter().map(|c| c.render).collect() })
}

/// The settings that are tried.
fn choices(own: &Render) -> Vec<Render> {
    // What is sampled in rounds of replicates cannot have fewer samples than those.
    let least = 4 * REPLICATES as u64;
    let with = |samples: u64| Render { meter_samples: samples.max(least), ..own.clone() };
    let mut out: Vec<Render> = FEWER.iter().map(|part| with(own.meter_samples / part)).collect();
    out.extend(turned(own, &with(own.meter_samples / PART)));
    unique(out)
}

/// The [`SHARED`] knobs of `some`, each turned alone.
pub(super) fn turned(own: &Render, some: &Render) -> Vec<Render> {
    let mut out = Vec::new();
    out.extend([Solver::Whitted, Solver::Direct].map(|solver| Render { solver, ..some.clone() }));
    out.extend(EDGES.map(|n| Render { max_edges: Some(n), ..some.clone() }));
    let [.., most] = EDGES;
    out.push(Render { max_edges: Some(most), roulette_from: most + 1, ..some.clone() });
    out.extend(ROULETTE.map(|roulette_from| Render { roulette_from, ..some.clone() }));
    out.extend([Points::Sobol, Points::Independent].map(|sampler| Render { sampler, ..some.clone() }));
    out.extend(
        [Carried::All, Carried::One].map(|wavelengths_per_path| Render { wavelengths_per_path, ..some.clone() }),
    );
    if own.wavelength_step_nm.is_none() {
        let tolerance = own.wavelength_tolerance;
        out.extend([10.0, 0.1].map(|f| Render { wavelength_tolerance: f * tolerance, ..some.clone() }));
    }
    out.extend(WAVELENGTHS.map(|n| Render { wavelength_step_nm: Some(step_nm(n)), ..some.clone() }));
    out.push(Render { model: if own.model == Model::Full { Model::Minimal } else { Model::Full }, ..some.clone() });
    out
}

/// Each once, in the order given.
pub(super) fn unique(all: Vec<Render>) -> Vec<Render> {
    let mut unique: Vec<Render> = Vec::new();
    for render in all {
        if !unique.contains(&render) {
            unique.push(render);
        }
    }
    unique
}

/// The step that divides the range into so many wavelengths, nm.
fn step_nm(count: u32) -> f64 {
    // To a thousandth, as it is written; no more than before, so that the last one is within the range.
    ((RANGE_NM.1 - RANGE_NM.0) / f64::from(count) * 1e3).floor() / 1e3
}

/// The error of runs with different seeds, from their relative distances.
fn of_seeds(off: &[f64]) -> Estimate {
    let n = off.len() as f64;
    let mean = off.iter().sum::<f64>() / n;
    let variance = off.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0);
    let limit = two_sided_95(n - 1.0) * variance.sqrt();
    let error = (off.iter().map(|v| v * v).sum::<f64>() / n).sqrt();
    Estimate {
        error,
        // What is certain of the bias, and half of the scatter: a sum of n ≥ 6 squares falls below a quarter of its mean in under 5 %.
        low: (mean.abs() - limit / n.sqrt()).max(0.5 * variance.sqrt()).min(error),
        high: mean.abs() + tolerance_95(n, SURE) * variance.sqrt(),
    }
}

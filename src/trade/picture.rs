//! The trade of a picture: how far the pixels of a camera are off, by its samples, by filtering, and by all else that tells how they are taken.
//!
//! | knob | values |
//! |---|---|
//! | `samples` | the scene's own a pixel, and 4 and 16 times fewer |
//! | `denoise` | no; yes, for each of these where it is possible |
//! | `adaptive` | yes; no |
//! | `branches`, `virtual_lights`, `guiding` | as the renderer finds best; 1 and 4; yes and no |
//! | `solver` | path tracing; with packets from the lights (bidirectional); direct light with its mirror images (Whitted); direct light |
//! | others | those of the [meters](super::render) |
//!
//! All but samples and filtering are turned one at a time, at a quarter of the scene's samples, but 16 at least: with fewer the renderer finds nothing out
//! about a picture before it renders it.
//!
//! **Error** of a picture x, by pictures r₁ and r₂ of other seeds that share no noise with it or with one another:
//!
//! ```text
//! ε² = mean over the pixels of (L_x − L_r₁)(L_x − L_r₂) / (L_r² + (L̄_r/100)²),   L_r = (L_r₁ + L_r₂)/2
//! ```
//!
//! which holds noise and bias of x, on average, and no noise of the references. **Reference**: everything modelled, by path tracing without limit, twice
//! four times the samples. Its own error is what ε would be seen to be of a picture without error, with a confidence of 95 %: its noise at each pixel,
//! averaged over all of them.

use super::render::{MORE, RenderError, RenderSweep, SEEDS, SHARED, SURE, turned, unique, words};
use super::timing::{WARM_UPS, interleaved};
use super::{Estimate, Figure, Measure, Sweep, Trial};
use crate::image::error::Error as ImageError;
use crate::image::source::{Region, Source};
use crate::math::student::{tolerance_95, two_sided_95};
use crate::render::build::{Built, Files, Kind, Meshes, Origin};
use crate::render::denoise::DARK;
use crate::render::description::{Description, Error, Model, Render, Solver};
use crate::render::film::Film;
use crate::render::measure::Settings;

/// Parts of the scene's samples that are tried.
const FEWER: [u64; 3] = [1, 4, 16];
/// The part at which the other knobs are turned.
const PART: u64 = 4;
/// Samples a pixel at least: enough for a survey, and a part of them to be filtered.
const LEAST: u64 = 16;
/// Numbers of branches that are tried.
const BRANCHES: [u32; 2] = [1, 4];
/// The knobs of pictures alone.
const OWN: [&str; 6] = ["samples", "denoise", "adaptive", "branches", "virtual_lights", "guiding"];

/// A scene under one choice of settings.
struct Choice {
    render: Render,
    built: Built,
}

impl Choice {
    fn new(origin: Origin<'_>, description: &Description, render: Render) -> Result<Self, Error> {
        let description = Description { render: render.clone(), ..description.clone() };
        Ok(Self { built: origin.build(&description)?, render })
    }

    /// The luminances of the picture of a camera, by its number among the instruments, row by row, cd/m².
    fn run(&self, camera: usize, seed: u64) -> Vec<f32> {
        let Kind::Camera(lens) = &self.built.instruments[camera].kind else { unreachable!("asked for a camera") };
        let settings = Settings { seed, ..self.built.settings.clone() };
        let tristimulus = &self.built.quantities.tristimulus;
        let instrument = (camera as u64) << 32;
        let mut film =
            Film::new(&self.built.scene, lens, &settings, instrument, self.render.samples, tristimulus, |_| ());
        film.survey(self.render.adaptive);
        if self.built.denoises { luminances(&mut film.denoised().1) } else { luminances(&mut film) }
            .expect("what is in memory can be read")
    }

    fn words(&self) -> Vec<String> {
        let yes = |is: bool| if is { "yes" } else { "no" }.to_owned();
        let chosen = |said: Option<String>| said.unwrap_or_else(|| "chosen".to_owned());
        let r = &self.render;
        let own = [
            r.samples.to_string(),
            yes(self.built.denoises),
            yes(r.adaptive),
            chosen(r.branches.map(|n| n.to_string())),
            chosen(r.virtual_lights.map(yes)),
            chosen(r.guiding.map(yes)),
        ];
        own.into_iter().chain(words(r, &self.built)).collect()
    }
}

/// Channel Y of a picture, the last but one.
fn luminances(picture: &mut dyn Source) -> Result<Vec<f32>, ImageError> {
    let description = picture.description();
    let (region, channel) = (Region::rows(description, 0, description.height), description.channels.len() - 2);
    let mut out = vec![0.0; region.width * region.height];
    picture.read(region, &[channel], &mut out)?;
    Ok(out)
}

/// Two pictures that others are compared with.
struct Reference {
    pictures: [Vec<f32>; 2],
    /// What squares of errors are relative to, of each pixel.
    scale: Vec<f64>,
}

impl Reference {
    fn new(pictures: [Vec<f32>; 2]) -> Self {
        let [a, b] = &pictures;
        let mean: Vec<f64> = a.iter().zip(b).map(|(a, b)| 0.5 * (f64::from(*a) + f64::from(*b))).collect();
        let dark = DARK * mean.iter().sum::<f64>() / mean.len() as f64;
        let scale = mean.iter().map(|l| l * l + dark * dark).collect();
        Self { pictures, scale }
    }

    /// The mean over the pixels of what is made of a pixel's luminances in both and of its scale; black pixels do not count.
    fn mean(&self, of: impl Fn(usize, [f64; 2], f64) -> f64) -> f64 {
        let [a, b] = &self.pictures;
        let pixels = a.iter().zip(b).zip(&self.scale).enumerate().filter(|(_, (_, scale))| **scale > 0.0);
        let sum: f64 = pixels.map(|(i, ((a, b), scale))| of(i, [f64::from(*a), f64::from(*b)], *scale)).sum();
        sum / self.scale.len() as f64
    }

    /// ε of a picture; 0 where the noise of the references hides it.
    fn error(&self, picture: &[f32]) -> f64 {
        let square = self.mean(|i, [a, b], scale| {
            let own = f64::from(picture[i]);
            (own - a) * (own - b) / scale
        });
        square.max(0.0).sqrt()
    }

    /// ε of a picture without error, at most, with a confidence of 95 %: a pixel's product has the variance σ⁴, and the difference of both, of variance
    /// 2 σ², has a mean fourth power of 12 σ⁴ (of normal noise; less of noise with tails, which makes this the larger).
    fn own_error(&self) -> f64 {
        let variance = self.mean(|_, [a, b], scale| ((a - b).powi(2) / scale).powi(2) / 12.0);
        (1.96 * (variance / self.scale.len() as f64).sqrt()).sqrt()
    }
}

/// Tries the picture of a camera, by its place among the sensors, with `repeats` seeds (at least 5) for each choice of settings; `progress` is told how many
/// renders are done, and of how many.
///
/// # Errors
/// [`RenderError`]: mistakes in the scene, or too few samples.
///
/// # Panics
/// Where there is no camera at that place.
pub fn sweep(
    text: &str,
    description: &Description,
    files: &dyn Files,
    repeats: usize,
    camera: usize,
    mut progress: impl FnMut(usize, usize),
) -> Result<RenderSweep, RenderError> {
    let own = Render { solver: Solver::Path, max_edges: None, denoise: None, ..description.render.clone() };
    if own.samples < LEAST {
        return Err(RenderError::FewSamples(own.samples));
    }
    let meshes = Meshes::default();
    let make = |render: Render| Choice::new(Origin::new(text, files, &meshes), description, render);
    let samples = MORE * own.samples;
    let best = make(Render { model: Model::Full, samples, ..own.clone() })?;
    let seeds = [1, 2].map(|n| own.seed.wrapping_sub(SEEDS * n));
    let reference = Reference::new(seeds.map(|seed| best.run(camera, seed)));
    let choices = choices(&own).into_iter().map(make).collect::<Result<Vec<_>, _>>()?;
    let mut errors = vec![Vec::new(); choices.len()];
    let repeats = repeats.max(5);
    let (mut done, all) = (0, choices.len() * (WARM_UPS + repeats));
    let timings = interleaved(choices.len(), repeats, |i| {
        progress(done, all);
        done += 1;
        let seed = own.seed.wrapping_add(SEEDS * (errors[i].len() as u64 + 1));
        errors[i].push(reference.error(&choices[i].run(camera, seed)));
        Ok::<_, RenderError>(())
    })?;
    let trials = choices.iter().zip(timings).zip(&errors);
    let trials = trials.map(|((choice, timing), errors)| Trial {
        settings: choice.words(),
        offered: true,
        timing,
        errors: vec![errors.iter().all(|e| e.is_finite()).then(|| of_seeds(errors))],
    });
    let key = best.built.instruments[camera].name.clone().into();
    let sweep = Sweep {
        reference: format!(
            "everything modelled, paths of any length, two pictures of {samples} samples a pixel with seeds of their own"
        ),
        knobs: OWN.into_iter().chain(SHARED).collect(),
        figures: vec![Figure { key, unit: "", measure: Measure::Relative }],
        reference_errors: vec![Some(reference.own_error()).filter(|e| e.is_finite())],
        trials: trials.collect(),
    };
    Ok(RenderSweep { sweep, choices: choices.into_iter().map(|c| c.render).collect() })
}

/// The settings that are tried.
fn choices(own: &Render) -> Vec<Render> {
    let filtered = |render: &Render| Render { denoise: Some(toml::Spanned::new(0..0, true)), ..render.clone() };
    let some = Render { samples: (own.samples / PART).max(LEAST), ..own.clone() };
    let mut out: Vec<Render> =
        FEWER.iter().map(|part| Render { samples: (own.samples / part).max(1), ..own.clone() }).collect();
    let sampled = out.clone();
    out.extend(sampled.iter().map(filtered).filter(|render| render.denoises() == Ok(true)));
    out.push(Render { adaptive: !own.adaptive, ..some.clone() });
    out.extend(BRANCHES.map(|n| Render { branches: Some(n), ..some.clone() }));
    out.extend([true, false].map(|is| Render { virtual_lights: Some(is), ..some.clone() }));
    out.extend([true, false].map(|is| Render { guiding: Some(is), ..some.clone() }));
    out.push(Render { solver: Solver::Bidirectional, ..some.clone() });
    out.extend(turned(own, &some));
    unique(out)
}

/// The error of pictures with different seeds.
fn of_seeds(errors: &[f64]) -> Estimate {
    let n = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / n;
    let deviation = (errors.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / (n - 1.0)).sqrt();
    let error = (errors.iter().map(|e| e * e).sum::<f64>() / n).sqrt();
    Estimate {
        error,
        low: (mean - two_sided_95(n - 1.0) * deviation / n.sqrt()).clamp(0.0, error),
        high: mean + tolerance_95(n, SURE) * deviation,
    }
}

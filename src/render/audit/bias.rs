//! What a reading loses to what the solver leaves out: paths cut at a number of edges, light that was reflected diffusely before.
//!
//! The same paths, of the same random numbers, are followed once as the solver does and once to their natural end. What the second
//! reads beyond the first is what is lost; as both share their beginnings, the difference has little scatter where little is lost.
//!
//! ```text
//! lost = R(all light) − R(as the solver follows it)
//! ```
//!
//! Materials lose light, too: microfacets of a BRDF that knows a single scattering drop what meets a second facet. How much their
//! albedo is short of it, [`single_scattering`] takes from the complete model of the same facets ([`Compensated`]).
//!
//! Nothing else biases a reading: no sample is clamped, and paths that chance ends are made up for by those that go on.

use glam::DVec3;
use rayon::prelude::*;

use super::figure;
use crate::brdf::{Brdf, parameter};
use crate::geometry::direction::from_degrees;
use crate::render::estimate::{Figure, REPLICATES, Replicate, stream};
use crate::render::integrator::limits::{Follow, Limits};
use crate::render::integrator::path::PathTracer;
use crate::render::material::compensated::Compensated;
use crate::render::measure::{Board, Meter, Settings};
use crate::render::scene::Scene;
use crate::render::sensor::camera::Camera;
use crate::render::spool::Share;

/// What a reading loses, in its own unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lost {
    /// How much more it would read with all light.
    pub lost: Figure,
    /// What it would read with all light, by the same paths.
    pub whole: Figure,
}

impl Lost {
    /// Lost over whole; 0 where there is nothing to lose.
    #[must_use]
    pub fn share(&self) -> f64 {
        if self.whole.value == 0.0 { 0.0 } else { self.lost.value / self.whole.value }
    }

    fn of(limited: &[Vec<Replicate>], whole: &[Vec<Replicate>], weights: &[f64]) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "a number of meters")]
        let n = limited.len() as f64;
        let mean = |all: &[Vec<Replicate>], r: usize| all.iter().map(|m| m[r].mean(weights)).sum::<f64>() / n;
        let lost: Vec<f64> = (0..REPLICATES).map(|r| mean(whole, r) - mean(limited, r)).collect();
        let all: Vec<f64> = (0..REPLICATES).map(|r| mean(whole, r)).collect();
        Self { lost: figure(&lost), whole: figure(&all) }
    }
}

/// The settings that lose nothing; `None` where these do not.
fn unlimited(settings: &Settings) -> Option<Settings> {
    let limits = Limits { follow: Follow::All, max_edges: None, shadows: true, ..settings.limits };
    (limits != settings.limits).then(|| Settings { limits, ..settings.clone() })
}

/// What the mean of some meters loses, from so many samples of each; `None` where nothing is left out. `weights` are those of the
/// reading's bands.
#[must_use]
pub fn of_meters(
    scene: &Scene,
    settings: &Settings,
    meters: &[(u64, Meter)],
    weights: &[f64],
    samples: u64,
) -> Option<Lost> {
    let whole = unlimited(settings)?;
    let run = |settings: &Settings| {
        let mut board = Board::new(scene, settings, Share::WHOLE, meters.to_vec());
        board.sample_until(samples.div_ceil(REPLICATES as u64));
        (0..meters.len()).map(|m| board.replicates(m).to_vec()).collect::<Vec<_>>()
    };
    Some(Lost::of(&run(settings), &run(&whole), weights))
}

/// The same for the mean of a picture, from so many rays at places of the picture drawn at random.
#[must_use]
pub fn of_picture(
    scene: &Scene,
    settings: &Settings,
    camera: &Camera,
    instrument: u64,
    weights: &[f64],
    samples: u64,
) -> Option<Lost> {
    let whole = unlimited(settings)?;
    let each = samples.div_ceil(REPLICATES as u64);
    let run = |settings: &Settings| {
        let one = |replicate: usize| {
            // Beyond the numbers of all pixels.
            let stream = stream(instrument, usize::MAX - replicate);
            let mut sampler = settings.sampler(stream);
            let mut tracer = PathTracer::new(scene, settings.limits, &settings.heroes);
            let mut sums = Replicate::new(scene.bands().len());
            let dark = vec![0.0; scene.bands().len()];
            for index in 0..each {
                sampler.start(index);
                let [u, v, lens @ ..] = sampler.four();
                let place = (u * f64::from(camera.width()), v * f64::from(camera.height()));
                match camera.ray(place.0, place.1, lens) {
                    Some(ray) => sums.add(stream, tracer.radiance(ray, &mut sampler)),
                    None => sums.add(stream, &dark),
                }
            }
            sums
        };
        vec![(0..REPLICATES).into_par_iter().map(one).collect::<Vec<_>>()]
    };
    Some(Lost::of(&run(settings), &run(&whole), weights))
}

/// How much the albedo of a material is short of that of its facets with all orders of scattering.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingleScattering {
    /// For light along the normal.
    pub at_0_deg: f64,
    /// For light at 60° to it.
    pub at_60_deg: f64,
    /// For light from everywhere (the mean over the hemisphere).
    pub mean: f64,
}

/// What the microfacets of a BRDF lose, weighed over its bands by `weights`; `None` where there are none.
///
/// # Errors
/// None for a sound BRDF: that of [`Compensated::new`].
pub fn single_scattering(brdf: &dyn Brdf, weights: &[f64]) -> Result<Option<SingleScattering>, parameter::Error> {
    let facets = brdf.microfacets();
    if facets.is_empty() {
        return Ok(None);
    }
    let total: f64 = weights.iter().sum();
    let mut sum = SingleScattering { at_0_deg: 0.0, at_60_deg: 0.0, mean: 0.0 };
    let (mut here, mut mean) = (vec![0.0; brdf.bands()], vec![0.0; brdf.bands()]);
    for (share, single) in facets {
        let whole = Compensated::new(single.clone())?;
        let weighed = |values: &[f64]| -> f64 {
            values.iter().zip(&share).zip(weights).map(|((v, s), w)| v * s * w).sum::<f64>() / total
        };
        whole.regained(from_degrees(60.0, 0.0), &mut here, &mut mean);
        sum.at_60_deg += weighed(&here);
        sum.mean += weighed(&mean);
        whole.regained(DVec3::Z, &mut here, &mut mean);
        sum.at_0_deg += weighed(&here);
    }
    Ok(Some(sum))
}

//! Readings of meters by path tracing.

use rayon::prelude::*;

use super::estimate::{Estimate, REPLICATES, Replicate, stream};
use super::integrator::path::{Limits, PathTracer};
use super::ray::SurfacePoint;
use super::sampler::Sampler;
use super::scene::Scene;
use super::sensor::response::Response;

/// A meter at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meter {
    /// Where it stands: its normal is the instrument's axis.
    pub point: SurfacePoint,
    /// What it makes of the radiance around it.
    pub response: Response,
}

/// How a solver is to be run.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Names all random numbers.
    pub seed: u64,
    /// What paths may do.
    pub limits: Limits,
    /// Running sums, up to 1, of the probabilities with which a band is kept where a path must be split, one per band.
    pub heroes: Vec<f64>,
}

impl Settings {
    /// For `bands` bands chosen alike.
    #[must_use]
    pub fn new(seed: u64, limits: Limits, bands: usize) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "a number of bands")]
        let heroes = (1..=bands).map(|b| b as f64 / bands as f64).collect();
        Self { seed, limits, heroes }
    }
}

/// A reading begun: no samples yet.
#[must_use]
pub fn replicates(bands: usize) -> Vec<Replicate> {
    vec![Replicate::new(bands); REPLICATES]
}

/// Takes `count` more samples in every replicate of the reading of a meter, which is number `instrument` of the render.
///
/// The same numbers come out for any number of threads, and in one go or in several.
pub fn extend(
    scene: &Scene,
    meter: &Meter,
    settings: &Settings,
    instrument: u64,
    count: u64,
    replicates: &mut [Replicate],
) {
    replicates.par_iter_mut().enumerate().for_each_init(
        || PathTracer::new(scene, settings.limits, &settings.heroes),
        |tracer, (index, replicate)| {
            let stream = stream(instrument, index);
            let mut sampler = Sampler::new(settings.seed, stream, 0);
            for _ in 0..count {
                sampler.start(replicate.samples());
                replicate.add(stream, tracer.reading(&meter.point, &meter.response, &mut sampler));
            }
        },
    );
}

/// The reading of a meter from `samples` samples, rounded up to a whole number per replicate.
#[must_use]
pub fn read(scene: &Scene, meter: &Meter, settings: &Settings, instrument: u64, samples: u64) -> Estimate {
    let mut parts = replicates(scene.bands().len());
    extend(scene, meter, settings, instrument, samples.div_ceil(REPLICATES as u64), &mut parts);
    Estimate::new(parts)
}

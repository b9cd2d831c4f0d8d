//! Readings of meters by path tracing, of flux by light tracing: as many samples as asked for, or until they are sure enough.

use std::sync::Arc;

use rayon::prelude::*;

use super::estimate::{Estimate, REPLICATES, Replicate, stream};
use super::goniophotometer::Leaving;
use super::integrator::bidirectional::{PacketTracer, Splats, Target as Seen};
use super::integrator::light::LightTracer;
use super::integrator::limits::Limits;
use super::integrator::path::PathTracer;
use super::light::shares::Shares;
use super::ray::SurfacePoint;
use super::sampler::{Points, Sampler};
use super::scene::Scene;
use super::sensor::response::Response;
use super::shape::Shape;
use super::spool::Share;

/// Where a meter reads.
#[derive(Debug, Clone)]
pub enum Place {
    /// At a point, whose normal is the instrument's axis.
    Point(SurfacePoint),
    /// All over a shape, on its outside: the mean over its area.
    Area(Arc<dyn Shape>),
    /// Around everything, whose lights are all in bounds: what leaves the scene, with [`Response::Flux`].
    Around,
}

/// A meter.
#[derive(Debug, Clone)]
pub struct Meter {
    /// Where it is.
    pub place: Place,
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
    /// How the random numbers lie.
    pub points: Points,
    /// Running sums, up to 1, of the probabilities with which a band is kept where a path must be split, one per band.
    pub heroes: Vec<f64>,
    /// Whether packets from the lights help paths from the camera and from meters
    /// ([`bidirectional`](super::integrator::bidirectional)).
    pub packets: bool,
    /// Whether virtual lights stand for light between diffuse surfaces in pictures ([`virtual_lights`](super::integrator::virtual_lights));
    /// without a word, where they make less noise in the same time.
    pub virtual_lights: Option<bool>,
    /// Ways by which a path of a picture leaves the first surface that scatters
    /// ([`PathTracer::branching`](super::integrator::path::PathTracer::branching)), 1 where packets help; without a word, as many as make
    /// least noise in the same time.
    pub branches: Option<u32>,
    /// Whether paths of pictures are guided to what comes over polished surfaces ([`guide`](super::integrator::guide)); without a word, where that
    /// pays.
    pub guiding: Option<bool>,
}

impl Settings {
    /// For `bands` bands chosen alike.
    #[must_use]
    pub fn new(seed: u64, limits: Limits, bands: usize) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "a number of bands")]
        let heroes = (1..=bands).map(|b| b as f64 / bands as f64).collect();
        Self {
            seed,
            limits,
            points: Points::default(),
            heroes,
            packets: false,
            virtual_lights: None,
            branches: None,
            guiding: None,
        }
    }

    /// The random numbers of a stream.
    #[must_use]
    pub fn sampler(&self, stream: u64) -> Sampler {
        Sampler::new(self.seed, stream, 0).with(self.points)
    }

    /// The same with bands kept in proportion to `weights`, one per band, all above 0.
    #[must_use]
    pub fn keeping(mut self, weights: &[f64]) -> Self {
        let (total, mut sum) = (weights.iter().sum::<f64>(), 0.0);
        for (hero, weight) in self.heroes.iter_mut().zip(weights) {
            sum += weight;
            *hero = sum / total;
        }
        self
    }
}

/// A number of meters and what they read so far.
///
/// The same numbers come out for any number of threads, in one go or in several, in one share or in many.
#[derive(Debug)]
pub struct Board<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    share: Share,
    meters: Vec<(u64, Meter)>,
    /// [`REPLICATES`] of each meter.
    replicates: Vec<Replicate>,
}

/// When to stop.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// The greatest standard error relative to the reading.
    pub relative: f64,
    /// Which meters must reach it, by their place on the board.
    pub meters: Vec<usize>,
    /// What each band adds to the reading that counts.
    pub weights: Vec<f64>,
}

impl<'a> Board<'a> {
    /// Meters, each with its number in the render, which names its random numbers; nothing is read yet.
    #[must_use]
    pub fn new(scene: &'a Scene, settings: &'a Settings, share: Share, meters: Vec<(u64, Meter)>) -> Self {
        let replicates = vec![Replicate::new(scene.bands().len()); REPLICATES * meters.len()];
        Self { scene, settings, share, meters, replicates }
    }

    /// Samples until every replicate of this share has `samples` of them.
    pub fn sample_until(&mut self, samples: u64) {
        let (scene, settings, share, meters) = (self.scene, self.settings, self.share, &self.meters);
        let bands = scene.bands().len();
        let shares = settings.packets.then(|| Shares::new(scene.lights(), bands));
        self.replicates.par_iter_mut().enumerate().filter(|(i, _)| share.has(i % REPLICATES)).for_each_init(
            || {
                let tracer = PathTracer::new(scene, settings.limits, &settings.heroes);
                let tracer = match &shares {
                    Some(shares) => tracer.beside(shares),
                    None => tracer,
                };
                (tracer, LightTracer::new(scene, &settings.heroes), Leaving::new(bands))
            },
            |(tracer, packets, leaving), (index, replicate)| {
                let (instrument, meter) = &meters[index / REPLICATES];
                let stream = stream(*instrument, index % REPLICATES);
                let mut sampler = settings.sampler(stream);
                let (seen, area_m2) = match &meter.place {
                    Place::Point(point) => (Some(Seen::Point(point, meter.response)), 0.0),
                    Place::Area(shape) => (Some(Seen::Area(shape.as_ref())), shape.area()),
                    Place::Around => (None, 0.0),
                };
                let beside = shares.as_ref().zip(seen);
                let mut beside = beside.map(|(shares, seen)| {
                    Beside::new(scene, settings, shares, seen, (*instrument, index % REPLICATES))
                });
                while replicate.samples() < samples {
                    let number = replicate.samples();
                    sampler.start(number);
                    let point = match &meter.place {
                        Place::Point(point) => *point,
                        Place::Area(shape) => {
                            let [u, v, w, _] = sampler.four();
                            shape.sample_area([u, v, w])
                        }
                        Place::Around => {
                            leaving.clear();
                            packets.packet(&mut sampler, leaving);
                            replicate.add(stream, leaving.flux());
                            continue;
                        }
                    };
                    let path = tracer.reading(&point, &meter.response, area_m2, &mut sampler);
                    replicate.add(stream, beside.as_mut().map_or(path, |beside| beside.add_to(path, number)));
                }
            },
        );
    }

    /// Samples in rounds, each doubling what there is, until the target is met or every replicate has `most` samples; whether it was
    /// met. `round` is told of the samples per replicate after each round.
    pub fn sample_to(&mut self, target: &Target, most: u64, mut round: impl FnMut(&Self, u64)) -> bool {
        /// Fewer samples than this say too little about their own scatter.
        const LEAST: u64 = 64;
        let mut samples = LEAST.min(most);
        loop {
            self.sample_until(samples);
            round(self, samples);
            let met = target.meters.iter().all(|&meter| {
                let figure = self.estimate(meter).figure(&target.weights);
                figure.standard_error <= target.relative * figure.value.abs()
            });
            if met || samples >= most {
                return met;
            }
            samples = (2 * samples).min(most);
        }
    }

    /// What a meter reads.
    #[must_use]
    pub fn estimate(&self, meter: usize) -> Estimate {
        Estimate::new(self.replicates(meter).to_vec())
    }

    /// The replicates of a meter.
    #[must_use]
    pub fn replicates(&self, meter: usize) -> &[Replicate] {
        &self.replicates[meter * REPLICATES..][..REPLICATES]
    }

    /// Puts a replicate in place that was sampled before.
    pub fn restore(&mut self, meter: usize, replicate: usize, state: Replicate) {
        self.replicates[meter * REPLICATES + replicate] = state;
    }
}

/// The packets beside the paths of a replicate: as many, with random numbers of their own.
struct Beside<'a> {
    tracer: PacketTracer<'a>,
    sampler: Sampler,
    splats: Splats,
    sum: Vec<f64>,
}

impl<'a> Beside<'a> {
    fn new(
        scene: &'a Scene,
        settings: &'a Settings,
        shares: &'a Shares,
        seen: Seen<'a>,
        (instrument, replicate): (u64, usize),
    ) -> Self {
        // Streams of another instrument: none is shared with a meter or a pixel.
        let stream = stream(instrument + (1 << 31), replicate);
        Self {
            tracer: PacketTracer::new(scene, settings.limits, &settings.heroes, shares, seen),
            sampler: settings.sampler(stream),
            splats: Splats::default(),
            sum: vec![0.0; scene.bands().len()],
        }
    }

    /// What a path found, and a packet of the same number.
    fn add_to(&mut self, path: &[f64], number: u64) -> &[f64] {
        self.splats.clear();
        self.sampler.start(number);
        self.tracer.packet(&mut self.sampler, &mut self.splats);
        self.sum.copy_from_slice(path);
        self.sum.iter_mut().zip(self.splats.last(path.len())).for_each(|(sum, more)| *sum += more);
        &self.sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_kept_by_their_weights() {
        let settings = Settings::new(1, Limits::default(), 4);
        assert_eq!(settings.heroes, [0.25, 0.5, 0.75, 1.0]);
        assert_eq!(settings.keeping(&[1.0, 4.0, 2.0, 1.0]).heroes, [0.125, 0.625, 0.875, 1.0]);
    }
}

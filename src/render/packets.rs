//! What packets of flux add to a picture: the part of it that [`PacketTracer`] finds.
//!
//! Packets are traced in rounds of a fixed number of streams, each by itself; then every pixel adds up what the streams brought it,
//! stream by stream. The order of every sum is that of the numbers of streams and packets, so that the same bits come out for any number of
//! threads. The picture is held as a whole, in `f64`: 8 bytes a pixel and band.
//!
//! A pixel's variance is that of independent packets, Σ(y − ȳ)²/(M (M − 1)) over all M of them, most of which bring it nothing. Packets
//! of a stream are spread evenly, which this estimate does not know: it errs to the safe side. One packet may be seen in several pixels;
//! the variance of the whole picture's mean is therefore that of what packets bring to all of them together.

use rayon::prelude::*;

use super::estimate::{Faults, stream};
use super::integrator::bidirectional::{PacketTracer, Splats, Target};
use super::integrator::guide::Guide;
use super::light::shares::Shares;
use super::measure::Settings;
use super::scene::Scene;
use super::sensor::camera::Camera;

/// Independent streams of packets.
const STREAMS: usize = 64;
/// Packets of a stream between two sums: so many that threads seldom wait, and so few that what they bring is small.
const ROUND: u64 = 256;
/// Parts of the picture that are summed at once.
const PARTS: usize = 16;

/// The part of a picture that packets find.
#[derive(Debug)]
pub struct PacketPicture {
    bands: usize,
    /// Row by row, the bands of each pixel: Σ over the packets.
    sums: Vec<f64>,
    /// Σ of the squares of the luminances, of each pixel.
    squares: Vec<f64>,
    packets: f64,
    /// Σ of the luminances that packets bring to all pixels together, and of their squares.
    together: [f64; 2],
    faults: Faults,
}

/// What one stream brought.
#[derive(Debug, Default)]
struct Brought {
    /// In this round.
    splats: Splats,
    /// In all rounds: as [`PacketPicture::together`].
    together: [f64; 2],
    faults: Faults,
}

/// How a picture is to be sampled by packets.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// What is to be seen.
    pub scene: &'a Scene,
    /// Who sees it.
    pub camera: &'a Camera,
    /// How the solver runs.
    pub settings: &'a Settings,
    /// Of the scene's lights.
    pub shares: &'a Shares,
    /// What guides the paths beside them.
    pub guide: Option<&'a Guide>,
    /// Number of the instrument in the render.
    pub instrument: u64,
    /// How many packets are sent for every pixel of the picture; rounded up to whole streams.
    pub per_pixel: u64,
    /// Per band, what it adds to X, Y and Z.
    pub tristimulus: &'a [[f64; 3]],
}

impl PacketPicture {
    /// Sends packets; `progress` is told of them as they are sent.
    pub fn of(task: &Task<'_>, progress: impl Fn(u64) + Sync) -> Self {
        let (bands, pixels) = (task.scene.bands().len(), task.camera.width() as usize * task.camera.height() as usize);
        let mut picture = Self {
            bands,
            sums: vec![0.0; pixels * bands],
            squares: vec![0.0; pixels],
            packets: 0.0,
            together: [0.0; 2],
            faults: Faults::default(),
        };
        let per_stream = (task.per_pixel * pixels as u64).div_ceil(STREAMS as u64);
        let mut brought: Vec<Brought> = (0..STREAMS).map(|_| Brought::default()).collect();
        for first in (0..per_stream).step_by(ROUND as usize) {
            let last = (first + ROUND).min(per_stream);
            brought.par_iter_mut().enumerate().for_each_init(
                || {
                    let (limits, heroes) = (task.settings.limits, &task.settings.heroes);
                    PacketTracer::new(task.scene, limits, heroes, task.shares, Target::Camera(task.camera))
                        .beside(task.guide)
                },
                |tracer, (number, Brought { splats, together, faults })| {
                    splats.clear();
                    // Streams of another instrument: none is shared with a pixel.
                    let stream = stream(task.instrument + (1 << 31), number);
                    let mut sampler = task.settings.sampler(stream);
                    for index in first..last {
                        sampler.start(index);
                        tracer.packet(&mut sampler, splats);
                        if !faults.accept(splats.last(bands), stream, index) {
                            splats.drop_last(bands);
                        }
                        let pixels = splats.last(bands).chunks_exact(bands);
                        let luminance: f64 = pixels.map(|values| luminance(values, task.tristimulus)).sum();
                        *together = [together[0] + luminance, together[1] + luminance * luminance];
                    }
                },
            );
            picture.add(&brought, task.tristimulus);
            progress((last - first) * STREAMS as u64);
        }
        for Brought { together: [sum, squares], faults, .. } in &brought {
            picture.together = [picture.together[0] + sum, picture.together[1] + squares];
            picture.faults.append(faults);
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of packets")]
        let packets = (per_stream * STREAMS as u64 - picture.faults.count()).max(1) as f64;
        Self { packets, ..picture }
    }

    /// Adds what the streams brought, in their order.
    fn add(&mut self, brought: &[Brought], tristimulus: &[[f64; 3]]) {
        let bands = self.bands;
        let part = self.squares.len().div_ceil(PARTS).max(1);
        let parts = self.sums.par_chunks_mut(part * bands).zip(self.squares.par_chunks_mut(part));
        parts.enumerate().for_each(|(number, (sums, squares))| {
            for (pixel, values) in brought.iter().flat_map(|b| b.splats.iter(bands)) {
                let Some(own) = pixel.checked_sub(number * part).filter(|own| *own < squares.len()) else { continue };
                sums[own * bands..].iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
                squares[own] += luminance(values, tristimulus).powi(2);
            }
        });
    }

    /// Adds to the bands of a pixel, by its place row by row.
    pub fn add_to(&self, pixel: usize, bands: &mut [f64]) {
        let sums = &self.sums[pixel * self.bands..];
        bands.iter_mut().zip(sums).for_each(|(band, sum)| *band += sum / self.packets);
    }

    /// The luminance that it adds to a pixel, and the variance of that.
    #[must_use]
    pub fn luminance(&self, pixel: usize, tristimulus: &[[f64; 3]]) -> (f64, f64) {
        let luminance = luminance(&self.sums[pixel * self.bands..], tristimulus) / self.packets;
        (luminance, self.variance(luminance, self.squares[pixel]))
    }

    /// Σ of the covariances of the luminances that it adds to any two pixels: both are brought by the same packets.
    #[must_use]
    pub fn covariance(&self, tristimulus: &[[f64; 3]]) -> f64 {
        let [sum, squares] = self.together;
        let own: f64 = (0..self.squares.len()).map(|pixel| self.luminance(pixel, tristimulus).1).sum();
        self.variance(sum / self.packets, squares) - own
    }

    /// Of a mean over the packets, from the sum of the squares.
    fn variance(&self, mean: f64, squares: f64) -> f64 {
        ((squares / self.packets - mean * mean) / (self.packets - 1.0).max(1.0)).max(0.0)
    }

    /// Packets that were left out.
    #[must_use]
    pub fn faults(&self) -> &Faults {
        &self.faults
    }
}

fn luminance(bands: &[f64], tristimulus: &[[f64; 3]]) -> f64 {
    bands.iter().zip(tristimulus).map(|(b, t)| b * t[1]).sum()
}

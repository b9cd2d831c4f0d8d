//! The rows of a picture as they are kept to be filtered.

use rayon::prelude::*;

use super::{Film, SURVEYED};
use crate::render::denoise::record::{Half, Layout, See};
use crate::render::denoise::{Denoised, denoise};
use crate::render::estimate::stream;
use crate::render::integrator::path::PathTracer;
use crate::render::lanes::weighted;
use crate::render::noise::{Gathered, Noise, Together};

/// Rays of a pixel at least: one of a half does not tell its noise, and what the other half says of it is not told apart from that one's own.
const FEWEST: u64 = 4;
/// Streams of the second half of the samples: halves that know nothing of one another.
const OTHER_HALF: u64 = SURVEYED - 3;
/// And of the rays that only look.
const LOOKED: u64 = SURVEYED - 4;
/// For so many samples a ray of the pixel only looks, up to a number: that takes little beside them, and edges are seen more sharply.
const LOOK: u64 = 4;
const MOST_LOOKS: u64 = 16;
/// Where they see bright things beside dark ones so many are sent.
const AT_EDGES: u64 = 64;

impl<F: Fn(u64) + Send + Sync> Film<'_, F> {
    /// Renders whole rows as they are kept to be filtered: the noise and the record of each, of the form that [`Layout`] has. For pictures without
    /// packets, of four samples a pixel or more.
    #[must_use]
    pub fn records(&self, rows: &[usize]) -> Vec<(Noise, Vec<f32>)> {
        rows.par_iter()
            .map_init(|| self.tracer(self.way, self.guide.as_ref()).seeing(), |tracer, &y| self.record(tracer, y))
            .collect()
    }

    /// Renders the whole picture and filters it, with the noise that it has as it was sampled. For the same pictures.
    #[must_use]
    pub fn denoised(&self) -> (Noise, Denoised) {
        let all: Vec<usize> = (0..self.description.height).collect();
        let (noises, rows): (Vec<Noise>, Vec<_>) = self.records(&all).into_iter().unzip();
        let mut noise = Noise::default();
        noises.iter().for_each(|row| noise.append(row));
        (noise, denoise(self.description.clone(), self.tristimulus, &rows))
    }

    fn record(&self, tracer: &mut PathTracer<'_>, y: usize) -> (Noise, Vec<f32>) {
        let (width, layout) = (self.description.width, Layout { bands: self.tristimulus.len() });
        let mut record = vec![0.0; layout.channels() * width];
        let mut pixels = vec![Gathered::default(); width];
        let mut together = 0.0;
        let all = |x: usize| self.number(x, y).max(FEWEST);
        for (half, streams) in [0, OTHER_HALF].into_iter().enumerate() {
            let number = |x: usize| if half == 0 { all(x) / 2 } else { all(x).div_ceil(2) };
            let mut halves = vec![Half::new(layout.bands); width];
            let mut noise = Together::default();
            self.columns(tracer, y, (0..width, streams), number, |x, (stream, index), sample, _| {
                let luminance = match sample {
                    Some((sample, _)) if !pixels[x].faults.accept(sample, stream, index) => return,
                    Some((sample, _)) => weighted(sample, &self.luminous),
                    None => 0.0,
                };
                let share = number(x) as f64 / all(x) as f64;
                noise.add(index, halves[x].luminance(), luminance, (number(x), share));
                halves[x].add(sample, self.camera.position(), luminance);
                pixels[x].add(luminance);
            });
            together += noise.variance();
            Half::write(&halves, layout, half, &mut record);
        }
        (0..width).for_each(|x| self.look(tracer, x, y).write(layout, x, width, &mut record));
        let mut noise = Noise::default();
        for pixel in &pixels {
            let (luminance, variance) = (pixel.mean, pixel.variance());
            noise.append(&Noise { pixels: 1, luminance, variance, faults: pixel.faults });
        }
        if tracer.virtual_lights().is_some() {
            noise.variance = together;
        }
        (self.progress)(width as u64 * self.samples);
        (noise, record)
    }

    /// What a few rays of a pixel see.
    fn look(&self, tracer: &mut PathTracer<'_>, x: usize, y: usize) -> See {
        let mut seen = See::default();
        let mut sampler = self.settings.sampler(stream(self.instrument + LOOKED, y * self.description.width + x));
        let few = self.samples.div_ceil(LOOK).min(MOST_LOOKS);
        for index in 0..AT_EDGES {
            if index >= few && !seen.is_at_an_edge() {
                break;
            }
            sampler.start(index);
            let [u, v, lens @ ..] = sampler.four();
            let ray = self.camera.ray(x as f64 + u, y as f64 + v, lens);
            seen.add(ray.and_then(|ray| tracer.look(ray)), self.camera.position());
        }
        seen
    }
}

//! The rows of a picture as they are kept to be filtered.

use rayon::prelude::*;

use super::{Film, SURVEYED};
use crate::image::source::Region;
use crate::render::denoise::record::{Half, Layout, See};
use crate::render::denoise::{Denoised, denoise};
use crate::render::estimate::stream;
use crate::render::integrator::path::PathTracer;
use crate::render::lanes::weighted;
use crate::render::noise::{Gathered, Noise, Together, in_common};

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
    /// Renders whole strips, given by their rows, as they are kept to be filtered: the noise and the record of each row, of the form that [`Layout`] has. For pictures without
    /// packets, of four samples a pixel or more.
    #[must_use]
    pub fn records(&self, rows: &[usize]) -> Vec<(Noise, Vec<f32>)> {
        (self.regions(rows).into_par_iter())
            .map_init(
                || self.tracer(self.way, self.guide.as_ref()).seeing(),
                |tracer, strip| self.record(tracer, strip),
            )
            .flatten_iter()
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

    fn record(&self, tracer: &mut PathTracer<'_>, strip: Region) -> Vec<(Noise, Vec<f32>)> {
        let (width, layout) = (strip.width, Layout { bands: self.tristimulus.len() });
        let mut records = vec![vec![0.0; layout.channels() * width]; strip.height];
        let mut pixels = vec![Gathered::default(); width * strip.height];
        let mut together = 0.0;
        let all = |x: usize, y: usize| self.number(x, y).max(FEWEST);
        let has_in_common = tracer.virtual_lights().is_some();
        for (half, streams) in [0, OTHER_HALF].into_iter().enumerate() {
            let number = |x: usize, y: usize| if half == 0 { all(x, y) / 2 } else { all(x, y).div_ceil(2) };
            let mut halves = vec![Half::new(layout.bands); pixels.len()];
            let mut noise = Together::default();
            self.take(tracer, (strip, streams), number, |place, (stream, index), sample, _| {
                let luminance = match sample {
                    Some((sample, _)) if !pixels[place].faults.accept(sample, stream, index) => return,
                    Some((sample, _)) => weighted(sample, &self.luminous),
                    None => 0.0,
                };
                if has_in_common {
                    let (x, y) = (place % width, strip.y + place / width);
                    let share = number(x, y) as f64 / all(x, y) as f64;
                    noise.add(index, halves[place].luminance(), luminance, (number(x, y), share));
                }
                halves[place].add(sample, self.camera.position(), luminance);
                pixels[place].add(luminance);
            });
            together += noise.variance();
            let rows = halves.chunks_exact(width).zip(&mut records);
            rows.for_each(|(halves, record)| Half::write(halves, layout, half, record));
        }
        let mut noises = vec![Noise::default(); strip.height];
        for (place, pixel) in pixels.iter().enumerate() {
            let (x, row) = (place % width, place / width);
            self.look(tracer, x, strip.y + row).write(layout, x, width, &mut records[row]);
            let (luminance, variance) = (pixel.mean, pixel.variance());
            noises[row].append(&Noise { pixels: 1, luminance, variance, faults: pixel.faults });
        }
        if has_in_common {
            in_common(&mut noises, together);
        }
        (self.progress)((width * strip.height) as u64 * self.samples);
        noises.into_iter().zip(records).collect()
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

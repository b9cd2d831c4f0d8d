//! A camera's picture of a solution, row by row as whoever writes it asks for them.

use rayon::prelude::*;

use super::gather::Gatherer;
use super::lights::spread;
use crate::image::description::Description;
use crate::image::error::Error;
use crate::image::source::{self, Region, Source};
use crate::render::noise::Noise;
use crate::render::sensor::camera::Camera;

/// Rays of a pixel at most: they only smooth edges.
const MOST_RAYS: u64 = 16;

/// A picture that is computed when it is read; its channels are those of [`crate::render::film::Film`].
pub struct Picture<'a, F> {
    gatherer: &'a Gatherer<'a>,
    camera: &'a Camera,
    /// Per band, what it adds to X, Y and Z.
    tristimulus: &'a [[f64; 3]],
    rays: u32,
    description: Description,
    progress: F,
    noise: Noise,
}

impl<'a, F: Fn(u64) + Send + Sync> Picture<'a, F> {
    /// Of `samples` rays a pixel, 16 at most; `progress` is told of pixels as they are done.
    #[must_use]
    pub fn new(
        gatherer: &'a Gatherer<'a>,
        camera: &'a Camera,
        description: Description,
        tristimulus: &'a [[f64; 3]],
        samples: u64,
        progress: F,
    ) -> Self {
        let rays = samples.clamp(1, MOST_RAYS) as u32;
        Self { gatherer, camera, tristimulus, rays, description, progress, noise: Noise::default() }
    }

    /// Luminance of what was computed so far; nothing of it is noise.
    #[must_use]
    pub fn noise(&self) -> Noise {
        self.noise
    }

    /// The means of the bands of a pixel, then X, Y, Z.
    fn pixel(&self, x: usize, y: usize, values: &mut [f64]) {
        values.fill(0.0);
        let (bands, xyz) = values.split_at_mut(self.tristimulus.len());
        for index in 0..self.rays {
            let [u, v, w] = spread(index, 0);
            #[expect(clippy::cast_precision_loss, reason = "a place on the picture")]
            let ray = self.camera.ray(x as f64 + u, y as f64 + v, [w, spread(index, 1)[0]]);
            let Some(ray) = ray else { continue };
            let radiance = self.gatherer.radiance(&ray);
            bands.iter_mut().zip(radiance).for_each(|(b, l)| *b += l / f64::from(self.rays));
        }
        for (component, sum) in xyz.iter_mut().enumerate() {
            *sum = bands.iter().zip(self.tristimulus).map(|(b, t)| b * t[component]).sum();
        }
    }
}

impl<F: Fn(u64) + Send + Sync> Source for Picture<'_, F> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        if out.is_empty() {
            return Ok(());
        }
        let this = &*self;
        let row = |(row, out): (usize, &mut [f32])| {
            let mut values = vec![0.0; this.description.channels.len()];
            let mut noise = Noise::default();
            for column in 0..region.width {
                this.pixel(region.x + column, region.y + row, &mut values);
                noise.pixels += 1;
                noise.luminance += values[this.tristimulus.len() + 1];
                for (place, channel) in channels.iter().enumerate() {
                    #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
                    let sample = values[*channel] as f32;
                    out[place * region.width + column] = sample;
                }
            }
            (this.progress)(region.width as u64);
            noise
        };
        let rows: Vec<Noise> = out.par_chunks_mut(region.width * channels.len()).enumerate().map(row).collect();
        rows.iter().for_each(|row| self.noise.append(row));
        Ok(())
    }
}

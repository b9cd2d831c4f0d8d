//! A camera's picture: radiance per band and tristimulus values, rendered row by row as whoever writes it asks for them.

use rayon::prelude::*;

use super::bands::Bands;
use super::estimate::{Faults, stream};
use super::integrator::path::PathTracer;
use super::light::shares::Shares;
use super::measure::Settings;
use super::packets::{PacketPicture, Task};
use super::sampler::Sampler;
use super::scatter::{self, Scatter, Scattered};
use super::scene::Scene;
use super::sensor::camera::Camera;
use crate::image::description::{Channel, Content, Description, Meaning};
use crate::image::error::Error;
use crate::image::source::{self, Region, Source};
use crate::spectrum::{Per, Quantity, SpectralUnit};

/// One of so many samples is spent on the survey.
const SURVEY: u64 = 16;

/// Samples of a pixel that [`Film::survey`] takes in a picture of `samples` a pixel.
#[must_use]
pub fn survey_samples(samples: u64) -> u64 {
    samples / SURVEY
}

/// The luminance of a picture and how sure it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Noise {
    /// Pixels rendered.
    pub pixels: u64,
    /// Σ of the luminances.
    pub luminance: f64,
    /// Σ of the variances of the pixels' means, estimated from the scatter of their samples. Samples of a pixel are spread
    /// evenly, which this estimate does not know: it errs to the safe side. The first pixel's has the covariances of all pixels that
    /// packets are seen in, so that the sum over a whole picture is n² times the variance of its mean.
    pub variance: f64,
    /// Samples left out of the means.
    pub faults: Faults,
}

/// A picture that is rendered when it is read.
///
/// Where packets help ([`Settings::packets`]), they are sent before anything is read, as many as samples of all pixels, and the whole
/// picture's part of them is kept in memory.
///
/// Its channels are the bands of the scene (spectral radiance), then X, Y, Z in cd/m² of the observer whose weights it was given.
/// The value of a pixel is the mean over the pixel's square (box filter). A region that is read twice is rendered twice, to the same
/// bits.
#[derive(Debug)]
pub struct Film<'a, F> {
    scene: &'a Scene,
    camera: &'a Camera,
    settings: &'a Settings,
    /// Number of the instrument in the render.
    instrument: u64,
    samples: u64,
    /// Per band, what it adds to X, Y and Z.
    tristimulus: &'a [[f64; 3]],
    description: Description,
    progress: F,
    noise: Noise,
    /// Samples of each pixel, row by row, where they are not all the same.
    shares: Option<Vec<u32>>,
    /// Where packets start, if they help.
    lights: Option<Shares>,
    /// What they found, once they were sent.
    packets: Option<PacketPicture>,
}

/// What a camera's picture holds: the bands, then X, Y, Z.
#[must_use]
pub fn description(bands: &Bands, camera: &Camera) -> Description {
    let unit = SpectralUnit {
        factor: 1.0,
        photons: false,
        quantity: Quantity::Radiance,
        per: Per::Wavelength,
        text: "W/m2/sr/nm".to_owned(),
    };
    let mut channels: Vec<Channel> =
        (bands.wavelengths_nm().iter()).map(|nm| Channel::band(format!("{nm} nm"), unit.text.clone(), *nm)).collect();
    channels
        .extend((["X", "Y", "Z"].into_iter().zip(0..)).map(|(n, i)| Channel::new(n, "cd/m2", Meaning::Tristimulus(i))));
    let (width, height) = (camera.width() as usize, camera.height() as usize);
    let content = Content::Light { quantity: Some(Quantity::Radiance), unit: Some(unit) };
    Description { width, height, channels, content, rgb: None, attributes: Vec::new() }
}

impl<'a, F: Fn(u64) + Send + Sync> Film<'a, F> {
    /// A picture of `samples` samples a pixel; `progress` is told of samples as they are taken, those of a survey as well.
    #[must_use]
    pub fn new(
        scene: &'a Scene,
        camera: &'a Camera,
        settings: &'a Settings,
        instrument: u64,
        samples: u64,
        tristimulus: &'a [[f64; 3]],
        progress: F,
    ) -> Self {
        let description = description(scene.bands(), camera);
        Self {
            scene,
            camera,
            settings,
            instrument,
            samples,
            tristimulus,
            description,
            progress,
            noise: Noise::default(),
            shares: None,
            lights: settings.packets.then(|| Shares::new(scene.lights(), scene.bands().len())),
            packets: None,
        }
    }

    /// Finds out with a sixteenth of the samples where the picture is noisy, and shares the samples out among the pixels accordingly (as
    /// many in all): those of large relative error σ/(L + ε) get more.
    ///
    /// The samples that it took are thrown away, so that no pixel's number of samples depends on their values, which would be a bias.
    /// With fewer than sixteen samples nothing is done.
    pub fn survey(&mut self) {
        self.send();
        if self.samples < SURVEY {
            return;
        }
        let (width, height) = (self.description.width, self.description.height);
        let mut scatter = Scatter::new(width, height);
        let rows: Vec<Vec<Scattered>> = (0..height)
            .into_par_iter()
            .map_init(|| self.tracer(), |tracer, y| self.surveyed(tracer, y, self.samples / SURVEY))
            .collect();
        rows.iter().enumerate().for_each(|(y, row)| scatter.add(y, row));
        self.shares = Some(scatter.samples(self.samples));
    }

    /// Sends the packets that help, if they were not sent yet.
    fn send(&mut self) {
        let Some(shares) = self.lights.as_ref().filter(|_| self.packets.is_none()) else { return };
        let task = Task {
            scene: self.scene,
            camera: self.camera,
            settings: self.settings,
            shares,
            instrument: self.instrument,
            per_pixel: self.samples,
            tristimulus: self.tristimulus,
        };
        self.packets = Some(PacketPicture::of(&task, &self.progress));
    }

    /// Luminance and noise of what was rendered so far.
    #[must_use]
    pub fn noise(&self) -> Noise {
        self.noise
    }

    fn tracer(&self) -> PathTracer<'_> {
        let tracer = PathTracer::new(self.scene, self.settings.limits, &self.settings.heroes);
        match &self.lights {
            Some(shares) => tracer.beside(shares),
            None => tracer,
        }
    }

    /// Luminances of some samples of each pixel of a row, by block.
    fn surveyed(&self, tracer: &mut PathTracer<'_>, y: usize, samples: u64) -> Vec<Scattered> {
        let width = self.description.width;
        let mut row = vec![Scattered::default(); width.div_ceil(scatter::BLOCK)];
        for x in 0..width {
            // Streams of another instrument: the picture's own numbers stay unknown.
            let pixel = stream(self.instrument + u64::from(u32::MAX), y * width + x);
            let mut sampler = self.settings.sampler(pixel);
            let packets = self.packets.as_ref();
            let known = packets.map_or(0.0, |p| p.luminance(y * width + x, self.tristimulus).0);
            for index in 0..samples {
                sampler.start(index);
                let sample = self.sample(tracer, x, y, &mut sampler);
                let luminance = sample.map_or(0.0, |s| s.iter().zip(self.tristimulus).map(|(s, t)| s * t[1]).sum());
                row[x / scatter::BLOCK].add(luminance, known);
            }
        }
        (self.progress)(width as u64 * samples);
        row
    }

    /// One sample of a pixel's radiance per band; `None` where the lens shows nothing.
    fn sample<'b>(
        &self,
        tracer: &'b mut PathTracer<'_>,
        x: usize,
        y: usize,
        sampler: &mut Sampler,
    ) -> Option<&'b [f64]> {
        let [u, v, lens @ ..] = sampler.four();
        #[expect(clippy::cast_precision_loss, reason = "a place on the picture")]
        let ray = self.camera.ray(x as f64 + u, y as f64 + v, lens)?;
        let picture_sr = self.camera.pixels() / self.camera.pixels_per_solid_angle(ray.direction);
        Some(tracer.picture_radiance(ray, picture_sr, sampler))
    }

    /// Renders one pixel: means per band into `bands`; what it adds to the noise.
    fn pixel(&self, tracer: &mut PathTracer<'_>, x: usize, y: usize, bands: &mut [f64]) -> Noise {
        bands.fill(0.0);
        let pixel = stream(self.instrument, y * self.description.width + x);
        let mut sampler = self.settings.sampler(pixel);
        let mut faults = Faults::default();
        // Welford's running mean and sum of squared deviations of the luminance.
        let (mut mean, mut squares, mut count) = (0.0, 0.0, 0.0);
        let own = |shares: &Vec<u32>| u64::from(shares[y * self.description.width + x]);
        let samples = self.shares.as_ref().map_or(self.samples, own);
        for index in 0..samples {
            sampler.start(index);
            let mut luminance = 0.0;
            if let Some(sample) = self.sample(tracer, x, y, &mut sampler) {
                if !faults.accept(sample, pixel, index) {
                    continue;
                }
                for ((b, s), t) in bands.iter_mut().zip(sample).zip(self.tristimulus) {
                    *b += s;
                    luminance += s * t[1];
                }
            }
            count += 1.0;
            let deviation = luminance - mean;
            mean += deviation / count;
            squares += deviation * (luminance - mean);
        }
        if count > 0.0 {
            bands.iter_mut().for_each(|b| *b /= count);
        }
        let mut variance = if count > 1.0 { squares / (count - 1.0) / count } else { 0.0 };
        if let Some(packets) = &self.packets {
            let pixel = y * self.description.width + x;
            packets.add_to(pixel, bands);
            let (luminance, own) = packets.luminance(pixel, self.tristimulus);
            mean += luminance;
            variance += own;
            if (x, y) == (0, 0) {
                faults.append(packets.faults());
                variance += packets.covariance(self.tristimulus);
            }
        }
        Noise { pixels: 1, luminance: mean, variance, faults }
    }

    /// Renders whole rows: the noise and the samples of all channels, one behind the other, of each. What [`Film::noise`] says stays.
    #[must_use]
    pub fn rows(&mut self, rows: &[usize]) -> Vec<(Noise, Vec<f32>)> {
        self.send();
        let this = &*self;
        let channels: Vec<usize> = (0..this.description.channels.len()).collect();
        rows.par_iter()
            .map_init(
                || this.tracer(),
                |tracer, &y| {
                    let region = Region::rows(&this.description, y, 1);
                    let mut samples = vec![0.0; region.width * channels.len()];
                    let noise = this.row(tracer, region, y, &channels, &mut samples);
                    (noise, samples)
                },
            )
            .collect()
    }

    fn row(&self, tracer: &mut PathTracer<'_>, region: Region, y: usize, channels: &[usize], out: &mut [f32]) -> Noise {
        let mut values = vec![0.0; self.description.channels.len()];
        let mut noise = Noise::default();
        for column in 0..region.width {
            let (bands, xyz) = values.split_at_mut(self.tristimulus.len());
            noise.append(&self.pixel(tracer, region.x + column, y, bands));
            for (component, sum) in xyz.iter_mut().enumerate() {
                *sum = bands.iter().zip(self.tristimulus).map(|(b, t)| b * t[component]).sum();
            }
            for (place, channel) in channels.iter().enumerate() {
                #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
                let sample = values[*channel] as f32;
                out[place * region.width + column] = sample;
            }
        }
        (self.progress)(region.width as u64 * self.samples);
        noise
    }
}

impl Noise {
    /// Adds that of the rows below.
    pub fn append(&mut self, later: &Self) {
        self.pixels += later.pixels;
        self.luminance += later.luminance;
        self.variance += later.variance;
        self.faults.append(&later.faults);
    }

    /// Root of the mean variance of the pixels over their mean luminance: the relative noise of the picture.
    #[must_use]
    pub fn relative(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
        let n = self.pixels.max(1) as f64;
        if self.luminance > 0.0 { (self.variance / n).sqrt() / (self.luminance / n) } else { 0.0 }
    }
}

impl<F: Fn(u64) + Send + Sync> Source for Film<'_, F> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        if out.is_empty() {
            return Ok(());
        }
        self.send();
        let this = &*self;
        let rows: Vec<Noise> = out
            .par_chunks_mut(region.width * channels.len())
            .enumerate()
            .map_init(|| this.tracer(), |tracer, (row, out)| this.row(tracer, region, region.y + row, channels, out))
            .collect();
        rows.iter().for_each(|row| self.noise.append(row));
        Ok(())
    }
}

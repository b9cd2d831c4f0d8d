//! A camera's picture: radiance per band and tristimulus values, rendered row by row as whoever writes it asks for them.

mod records;

use std::ops::Range;

use rayon::prelude::*;

use super::bands::Bands;
use super::estimate::{self, stream};
use super::guiding;
use super::integrator::guide::Guide;
use super::integrator::path::{PathTracer, Sight};
use super::integrator::virtual_lights::{self, VirtualLights};
use super::lanes::weighted;
use super::light::shares::Shares;
use super::measure::Settings;
use super::noise::{Gathered, Noise, Together};
use super::packets::{PacketPicture, Task};
use super::sampler::Sampler;
use super::scatter::{self, Scatter, Scattered};
use super::scene::Scene;
use super::sensor::camera::Camera;
use super::trial::{self, Attempt, Way};
use crate::image::description::{Channel, Content, Description, Meaning};
use crate::image::error::Error;
use crate::image::source::{self, Region, Source};
use crate::spectrum::{Per, Quantity, SpectralUnit};

/// One of so many samples is spent on the survey.
const SURVEY: u64 = 16;

/// Streams of another instrument are the survey's, others those of the trial: the picture's own numbers stay unknown.
const SURVEYED: u64 = u32::MAX as u64;
const TRIAL: u64 = SURVEYED - 1;
/// And those of the packets that guide.
const LEARNT: u64 = SURVEYED - 2;
/// One packet for so many samples is sent to guide them.
const PACKET: u64 = 2;
/// What guiding finds is seldom seen without it, so that a few samples make it look dearer than it is: by no more than this.
const UNSEEN: f64 = 2.0;
/// The bit in which the streams of their virtual lights differ from them.
const VIRTUAL: u64 = 1 << 30;

/// Samples of a pixel that [`Film::survey`] takes in a picture of `samples` a pixel.
#[must_use]
pub fn survey_samples(samples: u64) -> u64 {
    samples / SURVEY
}

/// Rays of the camera for so many samples: two at least where there are two samples, as one does not tell its noise.
fn rays(samples: u64, branches: u32) -> u64 {
    samples.div_ceil(u64::from(branches)).max(samples.min(2))
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
    /// Rays of the camera for each pixel on average: each is of as many samples as it has branches.
    rays: u64,
    /// Per band, what it adds to X, Y and Z.
    tristimulus: &'a [[f64; 3]],
    /// What it adds to Y.
    luminous: Vec<f64>,
    description: Description,
    progress: F,
    noise: Noise,
    /// Samples of each pixel, row by row, where they are not all the same.
    shares: Option<Vec<u32>>,
    /// What virtual lights would be made of.
    source: Option<virtual_lights::Source>,
    way: Way,
    /// What guides the paths.
    guide: Option<Guide>,
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
        let branches = if settings.packets { 1 } else { settings.branches.unwrap_or(1) };
        Self {
            scene,
            camera,
            settings,
            instrument,
            samples,
            rays: rays(samples, branches),
            tristimulus,
            luminous: tristimulus.iter().map(|xyz| xyz[1]).collect(),
            description,
            progress,
            noise: Noise::default(),
            shares: None,
            // A few samples are not tried with them.
            source: (settings.virtual_lights.unwrap_or(samples >= SURVEY) && !settings.packets)
                .then(|| virtual_lights::Source::of(scene, &settings.limits))
                .flatten(),
            way: Way { virtual_lights: settings.virtual_lights == Some(true), branches },
            guide: None,
            lights: settings.packets.then(|| Shares::new(scene.lights(), scene.bands().len())),
            packets: None,
        }
    }

    /// Finds out whether guiding pays and which way of taking samples, where that was not said ([`Settings`]). An adaptive picture is then looked
    /// at with a sixteenth of the samples to find where it is noisy, and the samples are shared out among the pixels accordingly (as many in
    /// all): those of large relative error σ/(L + ε) get more, those whose samples take much work fewer.
    ///
    /// The samples that it took are thrown away, so that nothing that is done depends on the values of those that count, which would be a
    /// bias. With fewer than sixteen samples nothing is found out.
    pub fn survey(&mut self, adaptive: bool) {
        let surveys = self.samples >= SURVEY;
        if self.settings.guiding.unwrap_or(surveys) {
            self.guide();
        }
        self.send();
        if !surveys {
            return;
        }
        let most = trial::most_branches(self.samples);
        if let Some(way) = trial::best(&self.ways(most), most, |way| self.attempt(way, self.guide.as_ref())) {
            self.way = way;
            self.rays = rays(self.samples, way.branches);
        }
        if !adaptive {
            return;
        }
        let (width, height) = (self.description.width, self.description.height);
        let mut scatter = Scatter::new(width, height);
        let rows: Vec<Vec<Scattered>> = (0..height)
            .into_par_iter()
            .map_init(
                || self.tracer(Way { branches: 1, ..self.way }, self.guide.as_ref()),
                |tracer, y| {
                    let row = self.surveyed(tracer, y, self.samples / SURVEY, SURVEYED);
                    (self.progress)(width as u64 * (self.samples / SURVEY));
                    row
                },
            )
            .collect();
        rows.iter().enumerate().for_each(|(y, row)| scatter.add(y, row));
        self.shares = Some(scatter.samples(self.rays));
    }

    /// Sends the packets that help, if they were not sent yet.
    fn send(&mut self) {
        let Some(shares) = self.lights.as_ref().filter(|_| self.packets.is_none()) else { return };
        let task = Task {
            scene: self.scene,
            camera: self.camera,
            settings: self.settings,
            shares,
            guide: self.guide.as_ref(),
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

    /// Learns what guides the paths, and forgets it where that was not asked for and does not pay.
    fn guide(&mut self) {
        let pixels = self.description.width as u64 * self.description.height as u64;
        let packets = pixels.saturating_mul(self.samples) / PACKET;
        let guide = guiding::learn(self.scene, self.settings, self.instrument + LEARNT, packets);
        // Packets to the lens are sent later and by it: the trial is that of the paths beside them.
        let way = Way { branches: 1, ..self.way };
        self.guide = guide.filter(|guide| {
            self.settings.guiding.is_some()
                || self.attempt(way, Some(guide)).price() < UNSEEN * self.attempt(way, None).price()
        });
    }

    /// Ways of taking samples that are to be compared: without a choice one.
    fn ways(&self, most_branches: u32) -> Vec<Way> {
        let virtual_lights = match self.settings.virtual_lights {
            None if self.source.is_some() => vec![false, true],
            said => vec![said == Some(true)],
        };
        let branches = if self.settings.packets { Some(1) } else { self.settings.branches };
        let tried = || trial::BRANCHES[..if most_branches > 1 { 2 } else { 1 }].to_vec();
        let branches = branches.map_or_else(tried, |said| vec![said]);
        let with = |virtual_lights| branches.iter().map(move |&branches| Way { virtual_lights, branches });
        virtual_lights.into_iter().flat_map(with).collect()
    }

    /// The work and the noise of a way of taking samples, by a few samples of every eighth row.
    fn attempt(&self, way: Way, guide: Option<&Guide>) -> Attempt {
        // Rays of a pixel: two are the fewest that scatter.
        let rays = if way.branches == 1 { 4 } else { 2 };
        let (width, height) = (self.description.width, self.description.height);
        let rows: Vec<usize> = (0..height).step_by(2 * scatter::BLOCK).collect();
        let rows: Vec<_> = (rows.into_par_iter())
            .map(|y| {
                let mut tracer = self.tracer(way, guide);
                let row = self.surveyed(&mut tracer, y, rays, TRIAL);
                (y, row, tracer.effort())
            })
            .collect();
        let mut scatter = Scatter::new(width, height);
        rows.iter().for_each(|(y, row, _)| scatter.add(*y, row));
        #[expect(clippy::cast_precision_loss, reason = "2 or 4")]
        let work = rows.iter().map(|row| row.2).sum::<f64>() / rays as f64;
        Attempt { way, work, variance: scatter.noise().powi(2) }
    }

    fn tracer<'b>(&'b self, way: Way, guide: Option<&'b Guide>) -> PathTracer<'b> {
        let (limits, heroes) = (&self.settings.limits, &self.settings.heroes);
        let tracer = PathTracer::new(self.scene, *limits, heroes).guided(guide).branching(way.branches);
        match (&self.lights, &self.source) {
            (Some(shares), _) => tracer.beside(shares),
            (None, Some(source)) if way.virtual_lights => {
                tracer.with(VirtualLights::new(self.scene, limits, heroes, source, way.branches))
            }
            (None, _) => tracer,
        }
    }

    /// Luminances of some samples of each pixel of a row, by block; `streams` tells their random numbers from others.
    fn surveyed(&self, tracer: &mut PathTracer<'_>, y: usize, samples: u64, streams: u64) -> Vec<Scattered> {
        let width = self.description.width;
        let mut pixels = vec![(Gathered::default(), 0.0); width];
        self.columns(
            tracer,
            y,
            (0..width, streams),
            |_| samples,
            |x, _, sample, work| {
                pixels[x].1 += work;
                let luminance = sample.map_or(0.0, |(sample, _)| weighted(sample, &self.luminous));
                if f64::is_finite(luminance) {
                    pixels[x].0.add(luminance);
                }
            },
        );
        let mut row = vec![Scattered::default(); width.div_ceil(scatter::BLOCK)];
        for (x, (pixel, work)) in pixels.iter().enumerate() {
            let packets = self.packets.as_ref();
            let known = packets.map_or(0.0, |p| p.luminance(y * width + x, self.tristimulus).0);
            row[x / scatter::BLOCK].add(pixel, known, *work);
        }
        row
    }

    /// Takes the samples of some pixels of a row, with virtual lights the first of all pixels, then the second of all. `number` is how many
    /// a pixel of the row has; `take` is told the pixel's column, the sample's stream and index, what it is, if the lens shows anything there, and the
    /// work that it took.
    fn columns(
        &self,
        tracer: &mut PathTracer<'_>,
        y: usize,
        (columns, streams): (Range<usize>, u64),
        number: impl Fn(usize) -> u64,
        mut take: impl FnMut(usize, (u64, u64), Option<(&[f64], &Sight)>, f64),
    ) {
        let width = self.description.width;
        let stream = |x: usize| stream(self.instrument + streams, y * width + x);
        if tracer.virtual_lights().is_none() {
            for x in columns {
                let own = stream(x);
                let mut sampler = self.settings.sampler(own);
                for index in 0..number(x) {
                    sampler.start(index);
                    let (sample, work) = self.sample(tracer, x, y, &mut sampler);
                    take(x, (own, index), sample, work);
                }
            }
            return;
        }
        // The sets are those of the whole row, whichever part of it is rendered.
        let numbers: Vec<u64> = (0..width).map(number).collect();
        let own = |x| (x, stream(x), self.settings.sampler(stream(x)));
        let mut pixels: Vec<(usize, u64, Sampler)> = columns.map(own).collect();
        let mut sets = virtual_lights::Sets::new(
            self.settings.sampler(estimate::stream(self.instrument + (streams ^ VIRTUAL), y)),
        );
        for index in 0..numbers.iter().copied().max().unwrap_or(0) {
            if let Some(lights) = tracer.virtual_lights() {
                sets.next(lights, numbers.iter().filter(|n| **n > index).count(), width);
            }
            for (x, own, sampler) in pixels.iter_mut().filter(|(x, ..)| numbers[*x] > index) {
                sampler.start(index);
                let (sample, work) = self.sample(tracer, *x, y, sampler);
                take(*x, (*own, index), sample, work);
            }
        }
    }

    /// One sample of a pixel's radiance per band, `None` where the lens shows nothing, and the work that it took ([`PathTracer::effort`]).
    fn sample<'b>(
        &self,
        tracer: &'b mut PathTracer<'_>,
        x: usize,
        y: usize,
        sampler: &mut Sampler,
    ) -> (Option<(&'b [f64], &'b Sight)>, f64) {
        let [u, v, lens @ ..] = sampler.four();
        #[expect(clippy::cast_precision_loss, reason = "a place on the picture")]
        let Some(ray) = self.camera.ray(x as f64 + u, y as f64 + v, lens) else { return (None, 1.0) };
        // Packets alone ask for it.
        let picture_sr = match self.lights {
            Some(_) => self.camera.pixels() / self.camera.pixels_per_solid_angle(ray.direction),
            None => 0.0,
        };
        let before = tracer.effort();
        tracer.picture_radiance(ray, picture_sr, sampler);
        let work = tracer.effort() - before;
        (Some((tracer.found(), tracer.sight())), work)
    }

    /// Renders whole rows: the noise and the samples of all channels, one behind the other, of each. What [`Film::noise`] says stays.
    #[must_use]
    pub fn rows(&mut self, rows: &[usize]) -> Vec<(Noise, Vec<f32>)> {
        self.send();
        let this = &*self;
        let channels: Vec<usize> = (0..this.description.channels.len()).collect();
        rows.par_iter()
            .map_init(
                || this.tracer(this.way, this.guide.as_ref()),
                |tracer, &y| {
                    let region = Region::rows(&this.description, y, 1);
                    let mut samples = vec![0.0; region.width * channels.len()];
                    let noise = this.row(tracer, region, y, &channels, &mut samples);
                    (noise, samples)
                },
            )
            .collect()
    }

    /// Samples of a pixel.
    fn number(&self, x: usize, y: usize) -> u64 {
        self.shares.as_ref().map_or(self.rays, |shares| u64::from(shares[y * self.description.width + x]))
    }

    fn row(&self, tracer: &mut PathTracer<'_>, region: Region, y: usize, channels: &[usize], out: &mut [f32]) -> Noise {
        let (width, bands) = (self.description.width, self.tristimulus.len());
        let mut pixels = vec![Gathered::default(); region.width];
        let mut sums = vec![0.0; region.width * bands];
        let number = |x: usize| self.number(x, y);
        let mut together = Together::default();
        self.columns(tracer, y, (region.x..region.x + region.width, 0), number, |x, (stream, index), sample, _| {
            let pixel = &mut pixels[x - region.x];
            let mut luminance = 0.0;
            if let Some((sample, _)) = sample {
                if !pixel.faults.accept(sample, stream, index) {
                    return;
                }
                sums[(x - region.x) * bands..].iter_mut().zip(sample).for_each(|(sum, s)| *sum += s);
                luminance = weighted(sample, &self.luminous);
            }
            together.add(index, pixel, luminance, (number(x), 1.0));
            pixel.add(luminance);
        });
        let mut values = vec![0.0; self.description.channels.len()];
        let mut noise = Noise::default();
        for (column, (gathered, sums)) in pixels.iter().zip(sums.chunks_exact(bands)).enumerate() {
            let (bands, xyz) = values.split_at_mut(bands);
            bands.iter_mut().zip(sums).for_each(|(b, sum)| *b = sum / gathered.count.max(1.0));
            noise.append(&self.pixel(gathered, y * width + region.x + column, bands));
            for (component, sum) in xyz.iter_mut().enumerate() {
                *sum = bands.iter().zip(self.tristimulus).map(|(b, t)| b * t[component]).sum();
            }
            for (place, channel) in channels.iter().enumerate() {
                #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
                let sample = values[*channel] as f32;
                out[place * region.width + column] = sample;
            }
        }
        if tracer.virtual_lights().is_some() {
            noise.variance = together.variance();
        }
        (self.progress)(region.width as u64 * self.samples);
        noise
    }

    /// What a pixel adds to the noise; adds to its bands what packets found there.
    fn pixel(&self, gathered: &Gathered, pixel: usize, bands: &mut [f64]) -> Noise {
        let mut noise =
            Noise { pixels: 1, luminance: gathered.mean, variance: gathered.variance(), faults: gathered.faults };
        if let Some(packets) = &self.packets {
            packets.add_to(pixel, bands);
            let (luminance, own) = packets.luminance(pixel, self.tristimulus);
            noise.luminance += luminance;
            noise.variance += own;
            if pixel == 0 {
                noise.faults.append(packets.faults());
                noise.variance += packets.covariance(self.tristimulus);
            }
        }
        noise
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
            .map_init(
                || this.tracer(this.way, this.guide.as_ref()),
                |tracer, (row, out)| this.row(tracer, region, region.y + row, channels, out),
            )
            .collect();
        rows.iter().for_each(|row| self.noise.append(row));
        Ok(())
    }
}

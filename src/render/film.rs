//! A camera's picture: radiance per band and tristimulus values, rendered row by row as whoever writes it asks for them.

mod records;

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
use super::noise::{Gathered, Noise, Together, in_common};
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
/// Lots of samples, with random numbers of their own each, by which a pixel's noise is found: the scatter of their means.
const TIMES: u64 = 2;

/// Streams of another instrument are the survey's, others those of the trial: the picture's own numbers stay unknown.
const SURVEYED: u64 = u32::MAX as u64;
const TRIAL: u64 = SURVEYED - 1;
/// And those of the packets that guide.
const LEARNT: u64 = SURVEYED - 2;
/// The bit in which the streams of the second lot differ from those of the first.
const AGAIN: u64 = 1 << 29;
/// One of so many strips is tried, of small pictures more: of as many pixels as these at least, or all.
const SPARSE: usize = 8;
const TRIED: usize = 1024;
/// One packet for so many samples is sent to guide them.
const PACKET: u64 = 2;
/// What guiding finds is seldom seen without it, so that a few samples make it look dearer than it is: by no more than this.
const UNSEEN: f64 = 2.0;
/// The bit in which the streams of their virtual lights differ from them.
const VIRTUAL: u64 = 1 << 30;

/// Pixels of a strip at most, unless it is a single row: rows that have their virtual lights in common and are rendered in one go.
const STRIP: usize = 1024;

/// Rows of a strip of a picture of so many columns, 4, 2 or 1: parts of a render are made of whole strips, the first of which begins with the first row.
#[must_use]
pub fn strip(columns: usize) -> usize {
    [scatter::BLOCK, scatter::BLOCK / 2].into_iter().find(|rows| rows * columns <= STRIP).unwrap_or(1)
}

/// Samples of a pixel that [`Film::survey`] takes in a picture of `samples` a pixel: an even number, 0 where it takes none.
#[must_use]
pub fn survey_samples(samples: u64) -> u64 {
    if samples < SURVEY { 0 } else { (samples / SURVEY).max(TIMES) / TIMES * TIMES }
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
    /// at with a sixteenth of the samples, two at least, to find where it is noisy, and the samples are shared out among the pixels accordingly (as many in
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
        let mut scatter = Scatter::new(self.description.width, self.description.height);
        let samples = survey_samples(self.samples);
        let blocks: Vec<(usize, Vec<Scattered>)> = (self.strips().into_par_iter())
            .map_init(
                || self.tracer(Way { branches: 1, ..self.way }, self.guide.as_ref()),
                |tracer, strip| {
                    let blocks = self.surveyed(tracer, strip, samples, SURVEYED);
                    (self.progress)((strip.width * strip.height) as u64 * samples);
                    (strip.y, blocks)
                },
            )
            .collect();
        blocks.iter().for_each(|(y, blocks)| scatter.add(*y, blocks));
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

    /// The strips of the picture.
    fn strips(&self) -> Vec<Region> {
        let rows = strip(self.description.width);
        let height = self.description.height;
        let first = (0..height).step_by(rows);
        first.map(|y| Region::rows(&self.description, y, rows.min(height - y))).collect()
    }

    /// The work and the noise of a way of taking samples, by a few samples of every eighth strip, of small pictures of more.
    fn attempt(&self, way: Way, guide: Option<&Guide>) -> Attempt {
        let rays = if way.branches == 1 { 2 * TIMES } else { TIMES };
        let strips = self.strips();
        let every = (self.description.width * self.description.height / TRIED).clamp(1, SPARSE);
        let first = ((every - 1) / 2).min(strips.len() - 1);
        let tried: Vec<Region> = strips.into_iter().skip(first).step_by(every).collect();
        let tried: Vec<_> = (tried.into_par_iter())
            .map(|strip| {
                let mut tracer = self.tracer(way, guide);
                let blocks = self.surveyed(&mut tracer, strip, rays, TRIAL);
                (strip.y, blocks, tracer.effort())
            })
            .collect();
        let mut scatter = Scatter::new(self.description.width, self.description.height);
        tried.iter().for_each(|(y, blocks, _)| scatter.add(*y, blocks));
        #[expect(clippy::cast_precision_loss, reason = "2 or 4")]
        let (rays, each) = (rays as f64, (rays / TIMES) as f64);
        let work = tried.iter().map(|strip| strip.2).sum::<f64>() / rays;
        Attempt { way, work, variance: each * scatter.noise().powi(2) }
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

    /// Luminances of some samples of each pixel of a strip, a multiple of [`TIMES`], by block; `streams` tells their random numbers from others.
    fn surveyed(&self, tracer: &mut PathTracer<'_>, strip: Region, samples: u64, streams: u64) -> Vec<Scattered> {
        let width = self.description.width;
        let mut pixels = vec![(Gathered::default(), 0.0); strip.width * strip.height];
        for time in 0..TIMES {
            let mut means = vec![Gathered::default(); pixels.len()];
            let number = |_, _| samples / TIMES;
            self.take(tracer, (strip, streams ^ (time * AGAIN)), number, |place, _, sample, work| {
                pixels[place].1 += work;
                let luminance = sample.map_or(0.0, |(sample, _)| weighted(sample, &self.luminous));
                if f64::is_finite(luminance) {
                    means[place].add(luminance);
                }
            });
            for ((pixel, _), mean) in pixels.iter_mut().zip(means) {
                if mean.count > 0.0 {
                    pixel.add(mean.mean);
                }
            }
        }
        let mut blocks = vec![Scattered::default(); width.div_ceil(scatter::BLOCK)];
        for (place, (pixel, work)) in pixels.iter().enumerate() {
            let packets = self.packets.as_ref();
            let known = packets.map_or(0.0, |p| p.luminance(strip.y * width + place, self.tristimulus).0);
            blocks[place % width / scatter::BLOCK].add(pixel, known, *work);
        }
        blocks
    }

    /// Takes the samples of the pixels of a region within a strip, with virtual lights the first of all pixels, then the second of all. `number` is how
    /// many the pixel of a column and a row has; `take` is told the pixel's place in the region, row by row, the sample's stream and index, what it
    /// is, if the lens shows anything there, and the work that it took.
    fn take(
        &self,
        tracer: &mut PathTracer<'_>,
        (region, streams): (Region, u64),
        number: impl Fn(usize, usize) -> u64,
        mut take: impl FnMut(usize, (u64, u64), Option<(&[f64], &Sight)>, f64),
    ) {
        let width = self.description.width;
        let rows = region.y..region.y + region.height;
        let places = rows.flat_map(|y| (region.x..region.x + region.width).map(move |x| (x, y)));
        let pixel = |(x, y)| {
            let own = stream(self.instrument + streams, y * width + x);
            (own, self.settings.sampler(own))
        };
        if tracer.virtual_lights().is_none() {
            for (place, (x, y)) in places.enumerate() {
                let (own, mut sampler) = pixel((x, y));
                for index in 0..number(x, y) {
                    sampler.start(index);
                    let (sample, work) = self.sample(tracer, x, y, &mut sampler);
                    take(place, (own, index), sample, work);
                }
            }
            return;
        }
        // The sets are those of the whole strip, whichever part of it is rendered.
        let rows = strip(width);
        let first = region.y / rows * rows;
        let all = (first..self.description.height.min(first + rows)).flat_map(|y| (0..width).map(move |x| (x, y)));
        let all: Vec<u64> = all.map(|(x, y)| number(x, y)).collect();
        let mut pixels: Vec<_> = places.map(|(x, y)| ((x, y), number(x, y), pixel((x, y)))).collect();
        let mut sets = virtual_lights::Sets::new(
            self.settings.sampler(estimate::stream(self.instrument + (streams ^ VIRTUAL), first)),
        );
        for index in 0..all.iter().copied().max().unwrap_or(0) {
            if let Some(lights) = tracer.virtual_lights() {
                sets.next(lights, all.iter().filter(|n| **n > index).count(), all.len());
            }
            for (place, ((x, y), number, (own, sampler))) in pixels.iter_mut().enumerate() {
                if *number > index {
                    sampler.start(index);
                    let (sample, work) = self.sample(tracer, *x, *y, sampler);
                    take(place, (*own, index), sample, work);
                }
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

    /// Renders whole strips, given by their rows: the noise and the samples of all channels, one behind the other, of each row. What [`Film::noise`]
    /// says stays.
    #[must_use]
    pub fn rows(&mut self, rows: &[usize]) -> Vec<(Noise, Vec<f32>)> {
        self.send();
        let this = &*self;
        let channels: Vec<usize> = (0..this.description.channels.len()).collect();
        let row = this.description.width * channels.len();
        (this.regions(rows).into_par_iter())
            .map_init(
                || this.tracer(this.way, this.guide.as_ref()),
                |tracer, strip| {
                    let mut samples = vec![0.0; strip.height * row];
                    let noise = this.strip(tracer, strip, &channels, &mut samples);
                    let rows = samples.chunks_exact(row).map(<[f32]>::to_vec);
                    noise.into_iter().zip(rows).collect::<Vec<_>>()
                },
            )
            .flatten_iter()
            .collect()
    }

    /// Rows, from the top, in parts that follow one another within a strip.
    fn regions(&self, rows: &[usize]) -> Vec<Region> {
        let strip = strip(self.description.width);
        let regions = rows.chunk_by(|a, b| a + 1 == *b && a / strip == b / strip);
        regions.map(|rows| Region::rows(&self.description, rows[0], rows.len())).collect()
    }

    /// Samples of a pixel.
    fn number(&self, x: usize, y: usize) -> u64 {
        self.shares.as_ref().map_or(self.rays, |shares| u64::from(shares[y * self.description.width + x]))
    }

    /// Renders a region within a strip: the noise of each row.
    fn strip(&self, tracer: &mut PathTracer<'_>, region: Region, channels: &[usize], out: &mut [f32]) -> Vec<Noise> {
        let (width, bands) = (self.description.width, self.tristimulus.len());
        let mut pixels = vec![Gathered::default(); region.width * region.height];
        let mut sums = vec![0.0; pixels.len() * bands];
        let number = |x, y| self.number(x, y);
        let own = |place: usize| number(region.x + place % region.width, region.y + place / region.width);
        let mut together = Together::default();
        let has_in_common = tracer.virtual_lights().is_some();
        self.take(tracer, (region, 0), number, |place, (stream, index), sample, _| {
            let pixel = &mut pixels[place];
            let mut luminance = 0.0;
            if let Some((sample, _)) = sample {
                if !pixel.faults.accept(sample, stream, index) {
                    return;
                }
                sums[place * bands..].iter_mut().zip(sample).for_each(|(sum, s)| *sum += s);
                luminance = weighted(sample, &self.luminous);
            }
            if has_in_common {
                together.add(index, pixel, luminance, (own(place), 1.0));
            }
            pixel.add(luminance);
        });
        let mut values = vec![0.0; self.description.channels.len()];
        let mut noises = vec![Noise::default(); region.height];
        for (place, (gathered, sums)) in pixels.iter().zip(sums.chunks_exact(bands)).enumerate() {
            let (row, column) = (place / region.width, place % region.width);
            let (bands, xyz) = values.split_at_mut(bands);
            bands.iter_mut().zip(sums).for_each(|(b, sum)| *b = sum / gathered.count.max(1.0));
            noises[row].append(&self.pixel(gathered, (region.y + row) * width + region.x + column, bands));
            for (component, sum) in xyz.iter_mut().enumerate() {
                *sum = bands.iter().zip(self.tristimulus).map(|(b, t)| b * t[component]).sum();
            }
            let out = &mut out[row * channels.len() * region.width..];
            for (place, channel) in channels.iter().enumerate() {
                #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
                let sample = values[*channel] as f32;
                out[place * region.width + column] = sample;
            }
        }
        if has_in_common {
            in_common(&mut noises, together.variance());
        }
        (self.progress)((region.width * region.height) as u64 * self.samples);
        noises
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

    fn block(&self) -> (usize, usize) {
        (self.description.width, strip(self.description.width))
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        if out.is_empty() {
            return Ok(());
        }
        self.send();
        let this = &*self;
        let row = region.width * channels.len();
        let all: Vec<usize> = (region.y..region.y + region.height).collect();
        let mut left = out;
        let mut parts = Vec::new();
        for strip in this.regions(&all) {
            let (part, rest) = left.split_at_mut(strip.height * row);
            left = rest;
            parts.push((Region { x: region.x, width: region.width, ..strip }, part));
        }
        let rows: Vec<Noise> = (parts.into_par_iter())
            .map_init(
                || this.tracer(this.way, this.guide.as_ref()),
                |tracer, (strip, out)| this.strip(tracer, strip, channels, out),
            )
            .flatten_iter()
            .collect();
        rows.iter().for_each(|row| self.noise.append(row));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sixteenth in two lots of one at least, of pictures that are surveyed at all.
    #[test]
    fn a_survey_is_of_two_lots() {
        let samples = [1, 15, 16, 47, 64, 80, 1 << 20];
        assert_eq!(samples.map(survey_samples), [0, 0, 2, 2, 4, 4, 1 << 16]);
    }
}

//! The pictures of a camera: the spectral one, and those made of it.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Parser;
use indicatif::ProgressBar;

use super::state::State;
use super::work::{self, Work};
use crate::cli::image::{self, ImageCommand};
use crate::cli::output::Whole;
use crate::cli::{Failure, Talk};
use crate::finding::Finding;
use crate::image::description::Description;
use crate::image::error::Error;
use crate::image::format::exr;
use crate::image::source::{Region, Source};
use crate::render::build::Built;
use crate::render::denoise::{Price, denoise};
use crate::render::description::sensor::Camera as Described;
use crate::render::film::{self, Film};
use crate::render::noise::Noise;
use crate::render::radiosity::gather::Gatherer;
use crate::render::radiosity::picture::Picture;
use crate::render::sensor::camera::Camera;
use crate::render::spool::Share;

/// What a picture is made with.
pub(super) struct Job<'a> {
    pub built: &'a Built,
    pub camera: &'a Camera,
    pub described: &'a Described,
    pub name: &'a str,
    pub instrument: u64,
    pub samples: u64,
    /// The samples go where the picture is noisy.
    pub adaptive: bool,
    pub folder: &'a Path,
    pub inputs: &'a [String],
    pub talk: Talk,
    /// Only a share is rendered: into the state, and no picture is written.
    pub is_part: bool,
    /// Is told what writing takes.
    pub writing: &'a Cell<Duration>,
}

/// A picture, and what reading it took: one that is rendered as it is read is not yet written.
struct Timed<'a> {
    source: &'a mut dyn Source,
    reading: Duration,
}

impl Source for Timed<'_> {
    fn description(&self) -> &Description {
        self.source.description()
    }

    fn block(&self) -> (usize, usize) {
        self.source.block()
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        let begun = Instant::now();
        let read = self.source.read(region, channels, out);
        self.reading += begun.elapsed();
        read
    }

    fn findings(&self) -> Vec<Finding> {
        self.source.findings()
    }
}

/// The verbs of `image`, to make pictures as a user would.
#[derive(Debug, Parser)]
struct Words {
    #[command(subcommand)]
    command: ImageCommand,
}

/// Where the spectral picture goes: pictures for the eye are made of it, and it is thrown away where nobody asked for it.
struct Place {
    path: PathBuf,
    /// Holds the picture until it is thrown away.
    folder: Option<tempfile::TempDir>,
}

impl Place {
    fn new(job: &Job<'_>) -> Result<Self, Failure> {
        if let Some(file) = &job.described.exr {
            return Ok(Self { path: job.folder.join(file), folder: None });
        }
        let folder = tempfile::tempdir()?;
        Ok(Self { path: folder.path().join("picture.exr"), folder: Some(folder) })
    }

    fn is_kept(&self) -> bool {
        self.folder.is_none()
    }
}

impl<'a> Job<'a> {
    /// Of the instrument `number` of a render.
    pub(super) fn new(work: &'a Work, job: &work::Job<'a>, number: usize, camera: &'a Camera) -> Self {
        let described = work.description.sensor[number].camera.as_ref();
        Self {
            built: &work.built,
            camera,
            described: described.expect("the instruments are those described").get_ref(),
            name: &work.built.instruments[number].name,
            instrument: (number as u64) << 32,
            samples: work.description.render.samples,
            adaptive: work.description.render.adaptive,
            folder: job.folder,
            inputs: &work.read,
            talk: job.talk,
            is_part: job.share != Share::WHOLE,
            writing: &work.writing,
        }
    }

    /// Computes the picture of a solution by radiosity and writes what the scene asks for.
    pub(super) fn solved(
        &self,
        gatherer: &Gatherer<'_>,
        progress: &ProgressBar,
        written: &mut Vec<String>,
    ) -> Result<Noise, Failure> {
        let place = Place::new(self)?;
        let description = film::description(self.built.scene.bands(), self.camera);
        let tristimulus = &self.built.quantities.tristimulus;
        let mut picture =
            Picture::new(gatherer, self.camera, description, tristimulus, self.samples, |pixels| progress.inc(pixels));
        self.write(&place.path, &mut picture)?;
        let noise = picture.noise();
        self.derive(&place, progress, written)?;
        Ok(noise)
    }

    /// The same with another number of samples a pixel.
    pub(super) fn with_samples(self, samples: u64) -> Self {
        Self { samples, ..self }
    }

    /// What a picture of so many samples a pixel takes, in samples.
    pub(super) fn work(&self) -> u64 {
        let survey = if self.adaptive { film::survey_samples(self.samples) } else { 0 };
        let packets = if self.built.settings.packets { self.samples } else { 0 };
        u64::from(self.camera.width()) * u64::from(self.camera.height()) * (self.samples + survey + packets)
    }

    /// Renders the picture and writes what the scene asks for: its noise, and how far the pixels are off where it is filtered. With a state, the
    /// rows go there first, as picture `state.1`.
    pub(super) fn render(
        &self,
        state: Option<(&mut State, usize)>,
        progress: &ProgressBar,
        written: &mut Vec<String>,
    ) -> Result<(Noise, Option<Price>), Failure> {
        let place = Place::new(self)?;
        let denoises = self.built.denoises;
        let mut film = Film::new(
            &self.built.scene,
            self.camera,
            &self.built.settings,
            self.instrument,
            self.samples,
            &self.built.quantities.tristimulus,
            |samples| progress.inc(samples),
        );
        let survey = |film: &mut Film<_>| film.survey(self.adaptive);
        let (noise, price) = match state {
            None if denoises => {
                survey(&mut film);
                let (noise, mut filtered) = film.denoised();
                self.write(&place.path, &mut filtered)?;
                (noise, Some(filtered.price()))
            }
            None => {
                survey(&mut film);
                self.write(&place.path, &mut film)?;
                (film.noise(), None)
            }
            Some((state, picture)) => {
                let rows =
                    |film: &mut Film<_>, rows: &[usize]| if denoises { film.records(rows) } else { film.rows(rows) };
                state.render(picture, &mut film, survey, rows)?;
                if self.is_part {
                    return Ok((Noise::default(), None));
                }
                if denoises {
                    let (noise, rows) = state.rows(picture)?;
                    let description = film.description().clone();
                    let mut filtered = denoise(description, &self.built.quantities.tristimulus, &rows);
                    self.write(&place.path, &mut filtered)?;
                    (noise, Some(filtered.price()))
                } else {
                    let mut stored = state.picture(picture, film.description().clone());
                    self.write(&place.path, &mut stored)?;
                    (stored.noise, None)
                }
            }
        };
        self.derive(&place, progress, written)?;
        Ok((noise, price))
    }

    /// Makes the pictures for the eye of the spectral one.
    fn derive(&self, place: &Place, progress: &ProgressBar, written: &mut Vec<String>) -> Result<(), Failure> {
        if place.is_kept() {
            written.push(place.path.display().to_string());
        }
        let begun = Instant::now();
        let from = place.path.display().to_string();
        for (verb, target) in [("falsecolor", &self.described.falsecolor), ("convert", &self.described.picture)] {
            let Some(target) = target else { continue };
            let to = self.folder.join(target).display().to_string();
            let mut words = vec!["image", verb, &from, "-o", &to];
            // A picture for the screen is tone-mapped; the spectral one beside it holds what was measured.
            words.extend(if verb == "falsecolor" { ["--title", self.name] } else { ["--tone", "reinhard"] });
            let words = Words::try_parse_from(words).map_err(|e| Failure::Message(e.to_string()))?;
            // What a tone curve cuts is no fault of the render.
            let quiet = Talk { quiet: true, verbose: false };
            progress.suspend(|| image::run(words.command, if self.talk.verbose { self.talk } else { quiet }))?;
            written.push(to);
        }
        self.writing.set(self.writing.get() + begun.elapsed());
        Ok(())
    }

    fn write(&self, place: &Path, source: &mut dyn Source) -> Result<(), Failure> {
        let begun = Instant::now();
        let mut whole = Whole::open(place, self.inputs)?;
        let mut timed = Timed { source, reading: Duration::ZERO };
        exr::write(whole.file(), &mut timed, exr::Depth::Float)
            .map_err(|e| Failure::Message(format!("{}: {e}", place.display())))?;
        whole.finish()?;
        self.writing.set(self.writing.get() + begun.elapsed().saturating_sub(timed.reading));
        Ok(())
    }
}

//! The pictures of a camera: the spectral one, and those made of it.

use std::path::Path;

use clap::Parser;
use indicatif::ProgressBar;

use super::state::State;
use crate::cli::image::{self, ImageCommand};
use crate::cli::output::Whole;
use crate::cli::{Failure, Talk};
use crate::image::format::exr;
use crate::image::source::Source;
use crate::render::build::Built;
use crate::render::description::sensor::Camera as Described;
use crate::render::film::{Film, Noise};
use crate::render::sensor::camera::Camera;

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
}

/// The verbs of `image`, to make pictures as a user would.
#[derive(Debug, Parser)]
struct Words {
    #[command(subcommand)]
    command: ImageCommand,
}

impl Job<'_> {
    /// Renders the picture and writes what the scene asks for. With a state, the rows go there first, as picture `state.1`.
    pub(super) fn render(
        &self,
        state: Option<(&mut State, usize)>,
        progress: &ProgressBar,
        written: &mut Vec<String>,
    ) -> Result<Noise, Failure> {
        let named = |file: &Option<String>| file.as_ref().map(|f| self.folder.join(f));
        let spectral = named(&self.described.exr);
        // Pictures for the eye are made of the spectral one, which is thrown away where nobody asked for it.
        let folder = tempfile::tempdir()?;
        let place = spectral.clone().unwrap_or_else(|| folder.path().join("picture.exr"));
        let samples = self.samples;
        let mut film = Film::new(
            &self.built.scene,
            self.camera,
            &self.built.settings,
            self.instrument,
            samples,
            &self.built.quantities.tristimulus,
            |pixels| progress.inc(pixels * samples),
        );
        let survey = |film: &mut Film<_>| {
            if self.adaptive {
                film.survey();
            }
        };
        let noise = match state {
            None => {
                survey(&mut film);
                self.write(&place, &mut film)?;
                film.noise()
            }
            Some((state, picture)) => {
                state.render(picture, &mut film, survey)?;
                if self.is_part {
                    return Ok(Noise::default());
                }
                let mut stored = state.picture(picture, film.description().clone());
                self.write(&place, &mut stored)?;
                stored.noise
            }
        };
        written.extend(spectral.iter().map(|p| p.display().to_string()));
        let from = place.display().to_string();
        for (verb, target) in [("falsecolor", &self.described.falsecolor), ("convert", &self.described.picture)] {
            let Some(target) = named(target) else { continue };
            let to = target.display().to_string();
            let mut words = vec!["image", verb, &from, "-o", &to];
            // A picture for the screen is tone-mapped; the spectral one beside it holds what was measured.
            words.extend(if verb == "falsecolor" { ["--title", self.name] } else { ["--tone", "reinhard"] });
            let words = Words::try_parse_from(words).map_err(|e| Failure::Message(e.to_string()))?;
            // What a tone curve cuts is no fault of the render.
            let quiet = Talk { quiet: true, verbose: false };
            progress.suspend(|| image::run(words.command, if self.talk.verbose { self.talk } else { quiet }))?;
            written.push(to);
        }
        Ok(noise)
    }

    fn write(&self, place: &Path, source: &mut dyn Source) -> Result<(), Failure> {
        let mut whole = Whole::open(place, self.inputs)?;
        exr::write(whole.file(), source, exr::Depth::Float)
            .map_err(|e| Failure::Message(format!("{}: {e}", place.display())))?;
        whole.finish()
    }
}

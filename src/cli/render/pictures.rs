//! The pictures of a camera: the spectral one, and those made of it.

use std::path::Path;

use clap::Parser;
use indicatif::ProgressBar;

use crate::cli::image::{self, ImageCommand};
use crate::cli::output::Whole;
use crate::cli::{Failure, Talk};
use crate::image::format::exr;
use crate::render::build::Built;
use crate::render::description::sensor::Camera as Described;
use crate::render::film::{Film, Noise};
use crate::render::sensor::camera::Camera;

/// What a picture is made with.
pub(super) struct Job<'a> {
    pub built: &'a Built,
    pub camera: &'a Camera,
    pub instrument: u64,
    pub samples: u64,
    pub folder: &'a Path,
    pub inputs: &'a [String],
    pub talk: Talk,
}

/// The verbs of `image`, to make pictures as a user would.
#[derive(Debug, Parser)]
struct Words {
    #[command(subcommand)]
    command: ImageCommand,
}

impl Job<'_> {
    /// Renders the picture and writes what the scene asks for.
    pub(super) fn render(
        &self,
        described: &Described,
        name: &str,
        progress: &ProgressBar,
        written: &mut Vec<String>,
    ) -> Result<Noise, Failure> {
        let named = |file: &Option<String>| file.as_ref().map(|f| self.folder.join(f));
        let (spectral, falsecolor, picture) =
            (named(&described.exr), named(&described.falsecolor), named(&described.picture));
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
        let mut whole = Whole::open(&place, self.inputs)?;
        exr::write(whole.file(), &mut film, exr::Depth::Float)
            .map_err(|e| Failure::Message(format!("{}: {e}", place.display())))?;
        whole.finish()?;
        let noise = film.noise();
        written.extend(spectral.iter().map(|p| p.display().to_string()));
        let from = place.display().to_string();
        for (verb, target) in [("falsecolor", falsecolor), ("convert", picture)] {
            let Some(target) = target else { continue };
            let to = target.display().to_string();
            let mut words = vec!["image", verb, &from, "-o", &to];
            // A picture for the screen is tone-mapped; the spectral one beside it holds what was measured.
            words.extend(if verb == "falsecolor" { ["--title", name] } else { ["--tone", "reinhard"] });
            let words = Words::try_parse_from(words).map_err(|e| Failure::Message(e.to_string()))?;
            progress.suspend(|| image::run(words.command, self.talk))?;
            written.push(to);
        }
        Ok(noise)
    }
}

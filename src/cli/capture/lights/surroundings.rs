//! The surroundings in a mirror ball, as a file.

use std::io::BufWriter;
use std::path::Path;

use super::run::Run;
use super::{LightsArgs, message};
use crate::capture::lights::environment;
use crate::capture::lights::view::Ball;
use crate::cli::Failure;
use crate::cli::capture::develop::Darkroom;
use crate::cli::capture::photos::Photos;
use crate::cli::output::Whole;
use crate::image::format::exr;
use crate::report::capture_lights::What;

impl Run {
    /// Writes the surroundings that the first mirror ball shows.
    pub(super) fn environment(
        &self,
        photos: &mut Photos,
        a: &LightsArgs,
        path: &Path,
        balls: &[Ball],
    ) -> Result<(), Failure> {
        let seen = self.seen.iter().find(|s| matches!(s.what, What::Highlight(_)));
        let seen = seen.ok_or_else(|| message("found no mirror ball; expected one for --environment"))?;
        let stack = photos.manifest.stack.iter().find(|s| s.name == seen.stack).cloned();
        let stack = stack.ok_or_else(|| message("found no stack of the mirror ball; expected one"))?;
        let picture = Darkroom::open(photos)?.picture(photos, &stack)?;
        let map =
            environment::equirectangular(&self.view, &balls[seen.ball], &picture, a.reflectance, a.width as usize);
        write_exr(photos, path, map)
    }
}

fn write_exr(photos: &Photos, path: &Path, mut map: crate::image::Memory) -> Result<(), Failure> {
    let read: Vec<String> = photos.inputs.iter().map(|i| i.path.clone()).collect();
    let mut whole = Whole::open(path, &read)?;
    let out = BufWriter::with_capacity(1 << 18, whole.file());
    exr::write(out, &mut map, exr::Depth::Float)
        .map_err(|e| Failure::Message(format!("{}: cannot be written: {e}", path.display())))?;
    whole.finish()
}

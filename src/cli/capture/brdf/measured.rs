//! From the photographs to all measurements: what `capture brdf` and `trade capture` have in common.

use super::align::align;
use super::lamps::patterns;
use super::run::{Run, mask_of};
use super::scene;
use crate::brdf::table::Resolution;
use crate::capture::brdf::{Gathered, Limits, Observations};
use crate::capture::camera::Edge;
use crate::cli::capture::develop::Darkroom;
use crate::cli::capture::photos::{Given, Photos};
use crate::cli::{Failure, Talk};
use crate::finding::Finding;
use crate::report::capture_brdf::Scale;
use crate::report::envelope::Input;
use crate::trade::capture::Choice;

/// The measurements, and what they rest on.
pub(super) struct Measured {
    pub run: Run,
    pub all: Gathered,
    pub aligned: Option<Edge>,
    pub scale: Scale,
}

/// Develops the photographs and measures the object in all of them, for bins of `resolution`; `mask` goes before that of the manifest.
pub(super) fn measure(
    photos: &mut Photos,
    limits: Limits,
    mask: Option<String>,
    resolution: Resolution,
) -> Result<Measured, Failure> {
    let mut room = Darkroom::open(photos)?;
    let aligned = align(photos, &mut room)?;
    let mut scene = scene(photos, limits)?;
    scene.placement_px = aligned.as_ref().map_or(0.0, |e| e.standard_error_px);
    let mask = mask.or_else(|| photos.manifest.mask().map(|m| photos.path(m)));
    let mask = mask.map(|path| mask_of(photos, &path)).transpose()?;
    let (seen, strengths, patterns) = (Vec::new(), Vec::new(), patterns(photos)?);
    let mut run = Run { scene, mask, room, seen, all: None, resolution, patterns, strengths, size: (0, 0) };
    let scale = run.strengths(photos)?;
    run.observe(photos)?;
    let Some(all) = run.all.take() else {
        photos.notes.print(&photos.findings);
        return Err(Failure::Message("found no stack with a usable pixel; expected one or more".to_owned()));
    };
    Ok(Measured { run, all, aligned, scale })
}

/// The photographs of a manifest, to be measured again and again with less of them.
pub(in crate::cli) struct Retaken {
    given: Given,
    talk: Talk,
    /// Lights under which the object was photographed.
    pub lights: usize,
    /// Exposures of a stack at most.
    pub exposures: usize,
}

/// What a choice gave.
pub(in crate::cli) struct Taken {
    /// All measurements, or an even draw of very many.
    pub all: Observations,
    /// Relative standard uncertainty of the variance of a pixel's area.
    pub pixel_variance_sd: f64,
    pub inputs: Vec<Input>,
    pub findings: Vec<Finding>,
}

impl Retaken {
    /// Reads the manifest.
    pub(in crate::cli) fn open(path: &str, talk: Talk) -> Result<Self, Failure> {
        if !super::is_manifest(path) {
            return Err(Failure::Message(format!("{path}: expected a manifest, whose name ends in .toml")));
        }
        let given = Given { files: vec![path.to_owned()], times: None };
        let photos = Photos::open("trade capture", &given, talk)?;
        let (lights, exposures) = (photos.manifest.lights_used().len(), photos.manifest.most_exposures());
        if lights == 0 || exposures == 0 {
            let words = "found no [[stack]] of the object in the manifest; expected one per light";
            return Err(Failure::Message(format!("{path}: {words}")));
        }
        Ok(Self { given, talk, lights, exposures })
    }

    /// Everything from the files to the measurements. Strengths are not brought to a customary size: they are the same for all choices.
    pub(in crate::cli) fn measure(&self, choice: &Choice) -> Result<Taken, Failure> {
        let mut photos = Photos::open("trade capture", &self.given, self.talk)?;
        photos.manifest.keep(choice.lights, choice.exposures);
        let limits = Limits { every: choice.every, ..Limits::default() };
        let Measured { run, all, .. } = measure(&mut photos, limits, None, Resolution::MERL)?;
        Ok(Taken {
            all: all.kept,
            pixel_variance_sd: run.scene.pixel_variance_sd,
            inputs: photos.inputs,
            findings: photos.findings,
        })
    }
}

//! What a scene requires: how many wavelengths, which paths of light, polarisation, scattering that knows a turn.
//!
//! Wavelengths are chosen by the renderer ([`crate::render::bands`]), which measures the error that each choice leaves on the products of
//! the scene's own spectra; so does multiplication in three colours, which the renderer does not offer. Paths are tried by rendering both ways: the meters are read with the same seeds under either, so that what the
//! paths have in common cancels; the error is the mean of the relative differences, with Student's limit at 95 % on top.

use super::{Requirement, Rung};
use crate::math::student::two_sided_95;
use crate::render::build::{Files, Meshes, Origin, error_in_rgb};
use crate::render::description::{Description, Model, Render, Solver};
use crate::trade::render::{Choice, RenderError};

/// Runs of each way.
const SEEDS: u64 = 8;
/// Samples of a meter in a run at most: both ways share their seeds, so that few tell them apart, and there are ways by the dozen.
const SAMPLES: u64 = 8192;
/// Errors in the sum over wavelength that are tried, from the largest on.
const TOLERANCES: [f64; 7] = [0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5];
/// Edges of paths that are tried.
const EDGES: [u32; 2] = [3, 6];

/// The requirements of a scene for the readings of its meters.
///
/// # Errors
/// [`RenderError`].
pub fn scene(
    text: &str,
    description: &Description,
    files: &dyn Files,
    most: f64,
) -> Result<Vec<Requirement>, RenderError> {
    let own = Render {
        solver: Solver::Path,
        max_edges: None,
        model: Model::Minimal,
        meter_samples: description.render.meter_samples.min(SAMPLES),
        ..description.render.clone()
    };
    let meshes = Meshes::default();
    let origin = Origin::new(text, files, &meshes);
    let with = |render: Render| Choice::new(origin, description, render);
    let reference = with(own.clone())?;
    if reference.is_blind() {
        return Err(RenderError::NoMeter);
    }
    let mut out = Vec::new();
    if reference.built().wavelength_error.is_some() {
        let mut rungs: Vec<Rung> = Vec::new();
        if let Some(error) = error_in_rgb(text, description, files)? {
            rungs.push(Rung { model: "RGB (linear sRGB)".to_owned(), error: Some(error) });
        }
        for wavelength_tolerance in TOLERANCES {
            let mut description = description.clone();
            description.render = Render { wavelength_tolerance, ..own.clone() };
            let built = origin.build(&description)?;
            let model = format!("{} wavelengths", built.scene.bands().len());
            if rungs.last().is_none_or(|r| r.model != model) {
                rungs.push(Rung { model, error: built.wavelength_error });
            }
        }
        let figure = "X, Y and Z of the scene's own spectra, against 1 nm";
        out.push(Requirement::new("wavelengths", figure, rungs, most));
    }
    let values = read(&reference);
    let worst = |choice: &Choice| {
        let found = read(choice);
        let meters = values.first().map_or(0, Vec::len);
        (0..meters).map(|m| difference(&values, &found, m)).max_by(f64::total_cmp).filter(|e| e.is_finite())
    };
    let figure = "the readings of the meters, the worst of them";
    let analysis = reference.built().analysis.clone();
    let mut rungs = Vec::new();
    for (model, render) in [
        ("direct light", Render { solver: Solver::Direct, ..own.clone() }),
        ("direct light and its mirror images", Render { solver: Solver::Whitted, ..own.clone() }),
    ] {
        rungs.push(Rung { model: model.to_owned(), error: worst(&with(render)?) });
    }
    for edges in EDGES {
        let cut = with(Render { max_edges: Some(edges), ..own.clone() })?;
        rungs.push(Rung { model: format!("paths of up to {edges} edges"), error: worst(&cut) });
    }
    rungs.push(Rung { model: "paths of any length".to_owned(), error: Some(0.0) });
    let mut paths = Requirement::new("paths", figure, rungs, most);
    if !analysis.global {
        "nothing scatters: there is only the light of the lamps".clone_into(&mut paths.because);
    }
    out.push(paths);
    let mut rungs = Vec::new();
    if analysis.polarisation {
        let without = with(Render { polarisation: Some(false), ..own.clone() })?;
        rungs.push(Rung { model: "unpolarised light".to_owned(), error: worst(&without) });
        rungs.push(Rung { model: "polarised light".to_owned(), error: Some(0.0) });
    } else {
        rungs.push(Rung { model: "unpolarised light".to_owned(), error: Some(0.0) });
    }
    let mut polarisation = Requirement::new("polarisation", figure, rungs, most);
    analysis.polarisation_because.clone_into(&mut polarisation.because);
    out.push(polarisation);
    out.push(stated("azimuth", &analysis.anisotropic, ["isotropic scattering", "anisotropic scattering"]));
    out.push(stated("fluorescence", &analysis.fluorescent, ["every wavelength for itself", "wavelengths that change"]));
    Ok(out)
}

/// What is so by the materials in use, and needs no measuring: without it the scene would be another one.
fn stated(question: &'static str, materials: &[String], [without, with]: [&str; 2]) -> Requirement {
    let (model, because) = match materials {
        [] => (without, "no material in use asks for more".to_owned()),
        some => (with, format!("by the materials {}", some.join(", "))),
    };
    let rungs = vec![Rung { model: model.to_owned(), error: Some(0.0) }];
    Requirement { because, ..Requirement::new(question, "", rungs, 0.0) }
}

/// The readings with each of the seeds.
fn read(choice: &Choice) -> Vec<Vec<f64>> {
    (0..SEEDS).map(|seed| choice.run(seed).into_iter().map(|(value, _)| value).collect()).collect()
}

/// |mean of the relative differences| of a meter and the limit of that mean at 95 %.
fn difference(reference: &[Vec<f64>], found: &[Vec<f64>], meter: usize) -> f64 {
    let n = reference.len() as f64;
    let truth = reference.iter().map(|r| r[meter]).sum::<f64>() / n;
    let off: Vec<f64> = reference.iter().zip(found).map(|(r, f)| (f[meter] - r[meter]) / truth).collect();
    if found.iter().zip(reference).all(|(f, r)| f[meter] == r[meter]) {
        // Also where both are dark.
        return 0.0;
    }
    let mean = off.iter().sum::<f64>() / n;
    let variance = off.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0);
    mean.abs() + two_sided_95(n - 1.0) * (variance / n).sqrt()
}

//! `capture brdf`: the BRDF of a photographed object of known shape.

mod align;
mod files;
mod fill;
mod lamps;
mod measured;
mod mesh;
mod report;
mod run;
mod settings;
mod shots;

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use serde_json::json;

use super::photos::{Form, Given, Photos, is_manifest};
use crate::brdf::description::template::Template;
use crate::brdf::fit::{self, Fit, Options, Selection, Weighting};
use crate::capture::brdf::{Binned, Gathered, Limits, Observations, Scene, apart, deviations};
use crate::capture::setup::Place;
use crate::cli::brdf::Bins;
use crate::cli::output::write_file;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::report::capture_brdf::{self, Scale, StackSeen};
use crate::report::capture_develop::{self, Developed};
use crate::report::{brdf_fit, capture_page};
use files::{Target, encode};
use fill::{FillArgs, Filler};
use measured::{Measured, measure};
pub(in crate::cli) use measured::{Retaken, Taken};
use settings::UseArgs;

/// Models that are fitted where none are named.
const MODELS: [&str; 5] = ["lambert", "phong", "blinn-phong", "ward", "lambert + ggx"];
/// Measurements that the fits use at most, drawn evenly: standard errors fall no further where the model is what limits.
pub(in crate::cli) const FITTED: usize = 40_000;

/// The manifest, which pixels, which models, and the form of the answer.
#[derive(Debug, Args)]
#[command(after_long_help = "\
The manifest states camera, object (a sphere, cylinder, plane or mesh) and lights; the stacks are exposures, or linear pictures, one each: EXR (as `capture merge` writes them,
with their standard errors and masks) or 16-bit linear TIFF. From exposures the noise of codes and, unless it is stated, the response are
found first; from a [board] the camera, brought into line with the edge of a sphere; from a flat stack the vignetting. Without the radiance of a sample and the strengths of the lights, and without a
reference of the object's shape, the result is relative: it is scaled so that the median of f_r is 0.3/π, and says so.

Examples:
  photopic capture brdf capture.toml
  photopic capture brdf capture.toml -o ball.binary -o ball.toml --json
  photopic capture brdf capture.toml --report ball.html
  photopic capture brdf capture.toml --csv > bins.csv
  photopic capture brdf capture.toml --fill model -o ball.binary
  photopic capture brdf capture.toml -m 'lambert + beckmann' -m phong --max-theta-o 70")]
pub(in crate::cli) struct BrdfArgs {
    #[command(flatten)]
    given: Given,
    /// A model to fit, as for `brdf fit`; several are compared. Without it lambert, phong, blinn-phong, ward and lambert + ggx.
    #[arg(short, long = "model", value_name = "MODEL")]
    models: Vec<Template>,
    /// Number of measurements that the fits use, drawn evenly.
    #[arg(long, value_name = "N", default_value_t = FITTED)]
    subsample: usize,
    /// Bins in θh, θd and φd.
    #[arg(long, value_name = "HxDxP")]
    resolution: Option<Bins>,
    /// Largest angle of the light to the normal, degrees; beyond it is the attached shadow.
    #[arg(long, value_name = "DEG", default_value_t = Limits::default().max_theta_i_deg)]
    max_theta_i: f64,
    /// Largest angle of the camera to the normal, degrees; beyond it is the silhouette.
    #[arg(long, value_name = "DEG", default_value_t = Limits::default().max_theta_o_deg)]
    max_theta_o: f64,
    /// Of a mesh, the largest part of the hemisphere above a point (weighted by cosine) that the mesh itself may fill; beyond it light comes from there
    /// too, and the pixel is masked.
    #[arg(long, value_name = "SHARE", default_value_t = Limits::default().max_self_view)]
    max_self_view: f64,
    #[command(flatten)]
    used: UseArgs,
    /// A picture of the size of the photographs, brighter than half where the object is, instead of the manifest's.
    #[arg(long, value_name = "PICTURE")]
    mask: Option<PathBuf>,
    #[command(flatten)]
    fill: FillArgs,
    #[command(flatten)]
    form: Form,
    /// The bins as one table, with their standard errors.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Write every measurement as CSV: stack, pixel, directions, f_r and its standard error per band.
    #[arg(long, value_name = "FILE")]
    measurements: Option<PathBuf>,
    /// Files to write: .binary (MERL, bins without measurement −1), .csv or .alta (points at the middles of bins), .toml (the best
    /// model as a material). With --fill also .binary.mask (the numbers of bins as in the table, then a byte per bin: 0 missing, 1
    /// inferred, 2 measured), and a column `known` in .csv.
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// A report with pictures as one HTML file: coverage, lobes against data, photographs beside the model, energy and
    /// reciprocity, what to photograph next.
    #[arg(long, value_name = "HTML")]
    report: Option<PathBuf>,
}

fn message(error: impl ToString) -> Failure {
    Failure::Message(error.to_string())
}

pub(super) fn brdf(a: &BrdfArgs, talk: Talk) -> Result<(), Failure> {
    for (name, deg) in [("--max-theta-i", a.max_theta_i), ("--max-theta-o", a.max_theta_o)] {
        if !(deg > 0.0 && deg < 90.0) {
            return Err(Failure::Message(format!("{name} is {deg}; expected above 0 to below 90 degrees")));
        }
    }
    if !(0.0..=1.0).contains(&a.max_self_view) {
        return Err(Failure::Message(format!("--max-self-view is {}; expected 0 to 1", a.max_self_view)));
    }
    if a.subsample == 0 {
        return Err(Failure::Message("found 0 for --subsample; expected 1 or more".to_owned()));
    }
    let used = a.used.read()?;
    let targets = a.output.iter().map(|p| Target::of(p)).collect::<Result<Vec<_>, _>>()?;
    let models = match a.models.as_slice() {
        [] => MODELS.iter().map(|m| m.parse().map_err(message)).collect::<Result<Vec<Template>, _>>()?,
        given => given.to_vec(),
    };
    let filler = Filler::open(&a.fill)?;
    let mut photos = Photos::open("capture brdf", &a.given, talk)?;
    photos.manifest.keep(used.lights.unwrap_or(usize::MAX), used.exposures.unwrap_or(usize::MAX));
    let limits = Limits {
        max_theta_i_deg: a.max_theta_i,
        max_theta_o_deg: a.max_theta_o,
        every: used.every,
        max_self_view: a.max_self_view,
    };
    let mask = a.mask.as_ref().map(|p| p.display().to_string());
    let resolution = a.resolution.map_or(filler.resolution(), |r| r.0);
    let Measured { mut run, mut all, aligned, scale } = measure(&mut photos, limits, mask, resolution)?;
    let camera = photos.manifest.camera.as_ref().and_then(|c| c.lens().ok());
    warn(&mut photos, &run.seen);
    photos.notes.stage("bins and fits");
    let mut binned = all.bin();
    let scale = relative(&mut photos, scale, &mut all.kept, &mut binned);
    if let Some(path) = &a.measurements {
        let factor = if let Scale::Relative { factor } = scale { factor } else { 1.0 };
        run.write_measurements(&mut photos, &all.kept.channels, factor, path)?;
    }
    if all.stride > 1 {
        let words = format!(
            "of {} measurements every {}-th is kept for fits and comparisons; bins rest on all of them",
            all.count, all.stride
        );
        photos.findings.push(Finding::info("K030", words).at(Location::default()));
    }
    let (count, drawn) = (all.count, kept_of(&all, &run.seen));
    let all = all.kept;
    let samples = all.samples(run.scene.pixel_variance_sd).map_err(message)?;
    let options = Options { places: Some(a.subsample), ..Options::default() };
    let mut fits: Vec<Fit> = Vec::new();
    for template in &models {
        match fit::fit(template, &samples, &options) {
            Ok(mut fit) => {
                fit.widen_errors();
                fits.push(fit);
            }
            Err(error) => photos.left_out(&template.to_string(), &message(error)),
        }
    }
    let comparison = fit::compare(&fits.iter().collect::<Vec<_>>());
    photos.findings.extend(brdf_fit::findings(&samples, &fits, comparison.as_ref(), &options));
    let path = a.given.files.join(" ");
    let answer = (!fits.is_empty()).then(|| brdf_fit::Answer {
        path: &path,
        samples: &samples,
        fits: &fits,
        comparison: comparison.as_ref(),
        options: &options,
    });
    if let Some(answer) = &answer {
        disagreements(&mut photos, &mut run.seen, &drawn, &all, &fits[brdf_fit::best(answer)]);
    }
    let table = binned.table(&all).map_err(message)?;
    let filling = filler.fill(&mut photos, &table, answer.as_ref(), &scale)?;
    let read: Vec<String> = photos.inputs.iter().map(|i| i.path.clone()).chain(a.used.file()).collect();
    for (path, target) in a.output.iter().zip(targets) {
        let files = match (target, &answer) {
            (Target::Material, Some(answer)) => {
                let file = brdf_fit::material_file(answer.path, &fits[brdf_fit::best(answer)], &options);
                vec![(path.clone(), file.into_bytes())]
            }
            (Target::Material, None) => return Err(Failure::Message("found no fit to write".to_owned())),
            _ => encode(target, &table, filling.as_ref().map(|f| &f.filled), path)?,
        };
        files.iter().try_for_each(|(path, bytes)| write_file(path, bytes, &read))?;
    }
    let selection = Selection { weighting: Weighting::Equal, ..Selection::default() };
    let mut settings = brdf_fit::settings(&options, &selection);
    settings["weights"] = if all.has_errors() { "1/(c sigma)^2" } else { "equal" }.into();
    settings["standard_error"] = "the larger of s^2 (J'WJ)^-1 and the robust one".into();
    if run.scene.pixel_variance_sd > 0.0 {
        settings["pixel_variance_relative_sd"] = run.scene.pixel_variance_sd.into();
    }
    settings["max_theta_i_deg"] = a.max_theta_i.into();
    settings["max_theta_o_deg"] = a.max_theta_o.into();
    if run.scene.kind() == "mesh" {
        settings["max_self_view"] = a.max_self_view.into();
    }
    settings["every"] = used.every.into();
    if let Some(lights) = used.lights {
        settings["lights"] = lights.into();
    }
    if let Some(exposures) = used.exposures {
        settings["exposures"] = exposures.into();
    }
    settings["resolution"] = json!([binned.resolution.theta_h, binned.resolution.theta_d, binned.resolution.phi_d]);
    let shown = capture_brdf::Answer {
        object: run.scene.kind(),
        seen: &run.seen,
        scale: &scale,
        all: &all,
        measurements: count,
        binned: &binned,
        filling: filling.as_ref(),
        fits: answer.as_ref(),
    };
    let mut object = capture_brdf::object(&shown);
    if a.report.is_some() || a.form.json {
        let mut more = report::more(&run.scene, run.size, &shown);
        if let Some(path) = &a.report {
            report::write(&mut photos, &mut run.room, &run.scene, &shown, &mut more, path)?;
        }
        if let serde_json::Value::Object(object) = &mut object {
            object.extend(capture_page::more(&more));
        }
    }
    let text = if a.csv { capture_brdf::csv(&shown) } else { capture_brdf::text(&shown) };
    let developed = Developed {
        camera: camera.as_ref(),
        calibration: run.room.calibration.as_ref(),
        edge: aligned.as_ref(),
        noise: run.room.noise.as_ref(),
        vignetting: run.room.vignetting.as_ref(),
    };
    capture_develop::add(&mut object, &developed);
    photos.print(&settings, &[object], &text, a.form.json, None)
}

/// Camera and object of the manifest.
fn scene(photos: &mut Photos, limits: Limits) -> Result<Scene, Failure> {
    match photos.manifest.mesh.clone() {
        Some(stated) if photos.manifest.objects() == 1 => {
            let mesh = Arc::new(mesh::Posed::open(photos, &stated)?);
            Scene::of_surface(&photos.manifest, mesh, limits).map_err(message)
        }
        _ => Scene::new(&photos.manifest, limits).map_err(message),
    }
}

/// How many measurements of each picture are kept.
fn kept_of(all: &Gathered, seen: &[StackSeen]) -> Vec<usize> {
    let mut first = 0;
    let of = |s: &StackSeen| {
        first += s.counts.valid;
        all.kept_of(first - s.counts.valid, s.counts.valid)
    };
    seen.iter().map(of).collect()
}

/// Pictures that the best fit does not describe as it does the others.
fn disagreements(photos: &mut Photos, seen: &mut [StackSeen], drawn: &[usize], all: &Observations, best: &Fit) {
    let found = deviations(all, drawn, best.brdf.as_ref());
    for n in apart(&found) {
        let percent = 100.0 * found[n].unwrap_or(0.0);
        let words =
            format!("{} is {percent:.0} % off the best model in the median, far more than the others", seen[n].name);
        let place = Location::default().of_item(&seen[n].name);
        let hint = "is it the picture of this light, and is the light where it is stated?";
        photos.findings.push(Finding::warning("K029", words).hint(hint).at(place));
    }
    seen.iter_mut().zip(found).for_each(|(s, d)| s.deviation = d);
}

/// One light tells little; pictures without usable pixels were told when they were met.
fn warn(photos: &mut Photos, seen: &[StackSeen]) {
    let mut places: Vec<Place> = Vec::new();
    for s in seen.iter().filter(|s| s.counts.valid > 0) {
        if !places.contains(&s.place) {
            places.push(s.place);
        }
    }
    if places.len() == 1 {
        let words = "one light only: the measurements cover one surface in the space of directions, and the fits guess the rest";
        photos.findings.push(
            Finding::warning("K010", words)
                .hint("eight lights from near the camera to behind the object tell much more"),
        );
    }
}

/// Brings a relative result to a customary size.
fn relative(photos: &mut Photos, scale: Scale, all: &mut Observations, binned: &mut Binned) -> Scale {
    let Scale::Relative { .. } = scale else { return scale };
    let mut sorted = all.values.clone();
    let half = sorted.len() / 2;
    let median = *sorted.select_nth_unstable_by(half, f64::total_cmp).1;
    let factor = capture_brdf::RELATIVE_MEDIAN / median;
    all.scale(factor);
    binned.scale(factor);
    let words = "neither strengths of the lights with the radiance of a sample nor a reference: the result is relative";
    let hint = "its median is 0.3/π; reflectances are ratios, not values";
    photos.findings.push(Finding::warning("K011", words).hint(hint).at(Location::default()));
    Scale::Relative { factor }
}

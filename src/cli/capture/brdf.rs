//! `capture brdf`: the BRDF of a photographed sphere.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::brdf_report;
use super::develop::Darkroom;
use super::photos::{Form, Given, Photos};
use crate::brdf::description::template::Template;
use crate::brdf::fit::{self, Fit, Options, Selection, Weighting};
use crate::brdf::format::alta::{self, Encoding};
use crate::brdf::format::convert::nodes;
use crate::brdf::format::{csv, merl};
use crate::brdf::table::{Resolution, Table};
use crate::capture::brdf::{
    Binned, Counts, Limits, Observations, Scene, Seen, bin, reference_factor_sd, strength_from,
};
use crate::capture::camera::{Edge, fit_to_sphere};
use crate::capture::lights::outline::Outline;
use crate::capture::lights::view::View;
use crate::capture::manifest::{Exposure, Shows, Stack};
use crate::capture::photo::exif_time_s;
use crate::capture::radiance::Radiance;
use crate::capture::setup::{Light, Place};
use crate::capture::{Error, Photo};
use crate::cli::brdf::Bins;
use crate::cli::output::write_file;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::report::capture_brdf::{self as report, Scale, StackSeen};
use crate::report::capture_develop::{self, Developed};
use crate::report::{brdf_fit, capture_page};

/// Models that are fitted where none are named.
const MODELS: [&str; 5] = ["lambert", "phong", "blinn-phong", "ward", "lambert + ggx"];
/// Measurements that the fits use at most, drawn evenly: standard errors fall no further where the model is what limits.
const FITTED: usize = 40_000;
/// Deviation of a reference from being diffuse above which it is told.
const UNEVEN: f64 = 0.02;

/// The manifest, which pixels, which models, and the form of the answer.
#[derive(Debug, Args)]
#[command(after_long_help = "\
The manifest states camera, sphere and lights; the stacks are exposures, or linear pictures, one each: EXR (as `capture merge` writes them,
with their standard errors and masks) or 16-bit linear TIFF. From exposures the noise of codes and, unless it is stated, the response are
found first; from a [board] the camera, brought into line with the edge of the sphere; from a flat stack the vignetting. Without the radiance of a sample and the strengths of the lights, and without a
reference sphere, the result is relative: it is scaled so that the median of f_r is 0.3/π, and says so.

Examples:
  photopic capture brdf capture.toml
  photopic capture brdf capture.toml -o ball.binary -o ball.toml --json
  photopic capture brdf capture.toml --report ball.html
  photopic capture brdf capture.toml --csv > bins.csv
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
    /// Use every N-th pixel of every N-th row.
    #[arg(long, value_name = "N", default_value_t = 1)]
    every: usize,
    /// A picture of the size of the photographs, brighter than half where the object is, instead of the manifest's.
    #[arg(long, value_name = "PICTURE")]
    mask: Option<PathBuf>,
    #[command(flatten)]
    form: Form,
    /// The bins as one table, with their standard errors.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Write every measurement as CSV: stack, pixel, directions, f_r and its standard error per band.
    #[arg(long, value_name = "FILE")]
    measurements: Option<PathBuf>,
    /// Files to write: .binary (MERL, bins without measurement −1), .csv or .alta (points at the middles of bins), .toml (the best
    /// model as a material).
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// A report with pictures as one HTML file: coverage, lobes against data, photographs beside the model, energy and
    /// reciprocity, what to photograph next.
    #[arg(long, value_name = "HTML")]
    report: Option<PathBuf>,
}

/// What a file is, by its ending.
#[derive(Clone, Copy, PartialEq)]
enum Target {
    Merl,
    Csv,
    Alta,
    Material,
}

impl Target {
    fn of(path: &Path) -> Result<Self, Failure> {
        match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
            Some("binary") => Ok(Self::Merl),
            Some("csv") => Ok(Self::Csv),
            Some("alta") => Ok(Self::Alta),
            Some("toml") => Ok(Self::Material),
            _ => Err(Failure::Message(format!(
                "{}: expected a name ending in .binary, .csv, .alta or .toml",
                path.display()
            ))),
        }
    }
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
    if a.every == 0 || a.subsample == 0 {
        return Err(Failure::Message("found 0 for --every or --subsample; expected 1 or more".to_owned()));
    }
    let targets = a.output.iter().map(|p| Target::of(p)).collect::<Result<Vec<_>, _>>()?;
    let models = match a.models.as_slice() {
        [] => MODELS.iter().map(|m| m.parse().map_err(message)).collect::<Result<Vec<Template>, _>>()?,
        given => given.to_vec(),
    };
    let mut photos = Photos::open("capture brdf", &a.given, talk)?;
    let limits = Limits { max_theta_i_deg: a.max_theta_i, max_theta_o_deg: a.max_theta_o, every: a.every };
    let mut room = Darkroom::open(&mut photos)?;
    let aligned = align(&mut photos, &mut room)?;
    let mut scene = Scene::new(&photos.manifest, limits).map_err(message)?;
    scene.placement_px = aligned.map_or(0.0, |e| e.standard_error_px);
    let stated = photos.manifest.sphere.as_ref().and_then(|s| s.mask.clone());
    let mask = a.mask.as_ref().map(|p| p.display().to_string()).or_else(|| stated.map(|m| photos.path(&m)));
    let mask = mask.map(|path| mask_of(&mut photos, &path)).transpose()?;
    let places = a.measurements.is_some().then(Vec::new);
    let camera = photos.manifest.camera.as_ref().and_then(|c| c.lens().ok());
    let mut run = Run { scene, mask, room, places, seen: Vec::new(), all: None, strengths: Vec::new(), size: (0, 0) };
    let scale = run.strengths(&mut photos)?;
    run.observe(&mut photos)?;
    let Some(mut all) = run.all else {
        photos.notes.print(&photos.findings);
        return Err(Failure::Message("found no stack with a usable pixel; expected one or more".to_owned()));
    };
    warn(&mut photos, &run.seen);
    let scale = relative(&mut photos, scale, &mut all);
    if let (Some(path), Some(places)) = (&a.measurements, &run.places) {
        let read: Vec<String> = photos.inputs.iter().map(|i| i.path.clone()).collect();
        write_file(path, report::measurements(&run.seen, places, &all).as_bytes(), &read)?;
    }
    let binned = bin(&all, a.resolution.map_or(Resolution::MERL, |r| r.0));
    let samples = all.samples().map_err(message)?;
    let options = Options { places: Some(a.subsample), ..Options::default() };
    let mut fits: Vec<Fit> = Vec::new();
    for template in &models {
        match fit::fit(template, &samples, &options) {
            Ok(fit) => fits.push(fit),
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
    let read: Vec<String> = photos.inputs.iter().map(|i| i.path.clone()).collect();
    for (path, target) in a.output.iter().zip(targets) {
        let bytes = match (target, &answer) {
            (Target::Material, Some(answer)) => {
                brdf_fit::material_file(answer.path, &fits[brdf_fit::best(answer)], &options).into_bytes()
            }
            (Target::Material, None) => return Err(Failure::Message("found no fit to write".to_owned())),
            _ => encode(target, &all, &binned, path)?,
        };
        write_file(path, &bytes, &read)?;
    }
    let selection = Selection { weighting: Weighting::Equal, ..Selection::default() };
    let mut settings = brdf_fit::settings(&options, &selection);
    settings["weights"] = if all.has_errors() { "1/(c sigma)^2" } else { "equal" }.into();
    settings["max_theta_i_deg"] = a.max_theta_i.into();
    settings["max_theta_o_deg"] = a.max_theta_o.into();
    settings["every"] = a.every.into();
    settings["resolution"] = json!([binned.resolution.theta_h, binned.resolution.theta_d, binned.resolution.phi_d]);
    let shown = report::Answer { seen: &run.seen, scale: &scale, all: &all, binned: &binned, fits: answer.as_ref() };
    let mut object = report::object(&shown);
    if a.report.is_some() || a.form.json {
        let mut more = brdf_report::more(&run.scene, run.size, &shown);
        if let Some(path) = &a.report {
            brdf_report::write(&mut photos, &mut run.room, &run.scene, &shown, &mut more, path)?;
        }
        if let serde_json::Value::Object(object) = &mut object {
            object.extend(capture_page::more(&more));
        }
    }
    let text = if a.csv { report::csv(&shown) } else { report::text(&shown) };
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

/// Brings a camera that the board told into line with the edge of the sphere in the brightest of all pictures.
fn align(photos: &mut Photos, room: &mut Darkroom) -> Result<Option<Edge>, Failure> {
    let Some(calibration) = room.calibration.clone() else { return Ok(None) };
    let (Some(sphere), Some(camera)) = (photos.manifest.sphere.clone(), photos.manifest.camera.clone()) else {
        return Ok(None);
    };
    let view = View::new(Some(&camera)).map_err(message)?;
    let stacks: Vec<Stack> = photos.manifest.stack.iter().filter(|s| s.shows == Shows::Object).cloned().collect();
    let mut brightest: Option<(usize, Vec<f32>)> = None;
    for stack in &stacks {
        // What cannot be read is told when it is measured.
        let Ok((picture, _)) = room.picture(photos, stack) else { continue };
        let luma = picture.values.chunks_exact(picture.channels).map(|p| p.iter().sum::<f32>());
        let (_, most) = brightest.get_or_insert_with(|| (picture.width, vec![0.0; picture.width * picture.height]));
        most.iter_mut().zip(luma).for_each(|(m, v)| *m = m.max(v));
        room.keep(stack, picture);
    }
    let centre = glam::DVec3::from_array(sphere.centre_m);
    let seen = brightest.and_then(|(width, most)| {
        let top = most.iter().copied().fold(0.0, f32::max).max(f32::MIN_POSITIVE);
        let levels: Vec<f32> = most.iter().map(|v| v / top * 1e5).collect();
        let expected = view.outline(&crate::capture::lights::view::Ball { centre, radius: sphere.radius_m })?;
        Outline::refined(&levels, width, &expected)
    });
    let errors = calibration.standard_errors;
    let own = view.axes().transpose() * (centre - glam::DVec3::from_array(camera.position_m));
    let edge = seen.and_then(|outline| {
        let prior = (errors[2].max(errors[3]), errors[0].max(errors[1]) / calibration.camera.intrinsics.fx);
        fit_to_sphere(calibration.camera, own, sphere.radius_m, &outline.points, prior)
    });
    match edge {
        Some(edge) => {
            let sigma = edge.moved_px.x / errors[2].max(1e-9);
            let words = format!(
                "the camera was brought into line with the edge of the sphere: principal point moved by {:.2}, {:.2} px, focal length by \
                 {:.3} %; the edge is {:.2} px rms off",
                edge.moved_px.x,
                edge.moved_px.y,
                100.0 * (edge.zoom - 1.0),
                edge.rms_px
            );
            let far = sigma.abs().max((edge.moved_px.y / errors[3].max(1e-9)).abs()) > 4.0;
            photos.findings.push(if far {
                Finding::warning("K027", words)
                    .hint("far more than the calibration allows: are camera and sphere where they are stated?")
            } else {
                Finding::info("K027", words)
            });
            if let Some(camera) = &mut photos.manifest.camera {
                camera.set_lens(&edge.camera);
            }
            Ok(Some(edge))
        }
        None => {
            let words = "no edge of the sphere was found: the camera is as the board told it";
            photos.findings.push(Finding::warning("K027", words).hint("a dark background shows it"));
            Ok(None)
        }
    }
}

/// Pixels of the object.
fn mask_of(photos: &mut Photos, path: &str) -> Result<Vec<bool>, Failure> {
    let bytes = photos.bytes(path)?;
    let picture = Photo::decode(&bytes).map_err(|e| Failure::Message(format!("{path}: {e}")))?;
    Ok(picture.luma().iter().map(|v| *v > 127.5).collect())
}

/// What is measured so far.
struct Run {
    scene: Scene,
    mask: Option<Vec<bool>>,
    room: Darkroom,
    /// Stack by number in `seen` and pixel of each measurement, where they are asked for.
    places: Option<Vec<(usize, (usize, usize))>>,
    seen: Vec<StackSeen>,
    all: Option<Observations>,
    /// Of each light of the manifest, per band or one for all.
    strengths: Vec<Vec<f64>>,
    /// Columns and rows of the pictures.
    size: (usize, usize),
}

impl Run {
    /// The strengths of all lights: from the reference, as stated, or all alike.
    fn strengths(&mut self, photos: &mut Photos) -> Result<Scale, Failure> {
        let lights = photos.manifest.light.clone();
        let used = |light: &Light, photos: &Photos| {
            let of = |s: &Stack| s.shows == Shows::Object && light_of(s) == light.name;
            photos.manifest.stack.iter().any(of)
        };
        if let Some(reference) = photos.manifest.reference.clone() {
            let (mut uneven, mut light_sd) = (0.0_f64, 0.0_f64);
            for light in &lights {
                let of = |s: &&Stack| s.shows == Shows::Reference && light_of(s) == light.name;
                let Some(stack) = photos.manifest.stack.iter().find(of).cloned() else {
                    if used(light, photos) {
                        return Err(Failure::Message(format!(
                            "found no stack that shows the reference under light {}; expected one for each light",
                            light.name
                        )));
                    }
                    self.strengths.push(vec![1.0]);
                    continue;
                };
                let (picture, name) = self.room.picture(photos, &stack)?;
                let mut seen = Observations::new(picture.channels);
                let ones = vec![1.0; picture.channels];
                let counts = self
                    .scene
                    .observe(&picture, light.place, &ones, self.mask.as_deref(), &mut |s| seen.push(s))
                    .map_err(|e| Failure::Message(format!("{name}: {e}")))?;
                let Some(strength) = strength_from(&seen, &reference) else {
                    let why =
                        if seen.is_empty() { counts.why() } else { "its reflectances are not as many as its bands" };
                    return Err(message(Error::Nothing { stack: stack.name, why: why.to_owned() }));
                };
                uneven = uneven.max(strength.deviation_rms);
                light_sd = light_sd.max(strength.relative_errors.iter().copied().fold(0.0, f64::max));
                self.strengths.push(strength.values);
            }
            if uneven > UNEVEN {
                let words = format!("the reference differs from a diffuse one by {:.1} % rms", 100.0 * uneven);
                photos
                    .findings
                    .push(Finding::warning("K013", words).hint("the scale is off by as much, or the geometry is"));
            }
            let factor_sd = reference_factor_sd(&reference);
            let reflectance = reference.reflectance;
            return Ok(Scale::Reference { reflectance, factor_sd, light_sd, deviation_rms: uneven });
        }
        let stated = lights.iter().filter(|l| l.strength.is_some()).count();
        if stated != 0 && stated != lights.len() {
            let words = "found a strength for some of the lights; expected it for all of them, or for none";
            return Err(Failure::Message(words.to_owned()));
        }
        if stated == 0 && lights.len() > 1 {
            let words = "no light has a stated strength: all are taken as equally strong";
            photos
                .findings
                .push(Finding::warning("K012", words).hint("state intensity_w_per_sr, even in arbitrary units"));
        }
        let unit = photos.manifest.radiance.unit_w_per_m2_sr.filter(|_| stated > 0);
        let of = |l: &Light| {
            let all = l.strength.clone().unwrap_or_else(|| vec![1.0]);
            all.iter().map(|s| s / unit.unwrap_or(1.0)).collect()
        };
        self.strengths = lights.iter().map(of).collect();
        Ok(unit.map_or(Scale::Relative { factor: 1.0 }, |unit| Scale::Strengths { unit_w_per_m2_sr: unit }))
    }

    /// Measures all stacks of the object; those that cannot be used are left out.
    fn observe(&mut self, photos: &mut Photos) -> Result<(), Failure> {
        let stacks: Vec<Stack> = photos.manifest.stack.iter().filter(|s| s.shows == Shows::Object).cloned().collect();
        if stacks.is_empty() {
            let words = "found no [[stack]] of the object in the manifest; expected one per light";
            return Err(Failure::Message(words.to_owned()));
        }
        for stack in &stacks {
            let lights = &photos.manifest.light;
            let wanted = light_of(stack);
            let Some(number) = lights.iter().position(|l| l.name == wanted) else {
                let words =
                    format!("stack {}: found no [[light]] called {wanted}; expected `light` to name one", stack.name);
                return Err(Failure::Message(words));
            };
            let place = lights[number].place;
            // A mistake in the set-up ends the run; a picture that is of no use does not.
            let (picture, name) = match self.room.picture(photos, stack) {
                Ok(found) => found,
                Err(failure) if stacks.len() > 1 => {
                    photos.left_out(&stack.name, &failure);
                    continue;
                }
                Err(failure) => return Err(failure),
            };
            if let Err(failure) = self.one(stack, &name, &picture, place, number) {
                match failure {
                    Error::Nothing { .. } if stacks.len() > 1 => photos.left_out(&stack.name, &message(failure)),
                    _ => return Err(Failure::Message(format!("{name}: {failure}"))),
                }
            }
        }
        Ok(())
    }

    fn one(&mut self, stack: &Stack, name: &str, picture: &Radiance, place: Place, light: usize) -> Result<(), Error> {
        let all = self.all.get_or_insert_with(|| Observations::new(picture.channels));
        if all.channels.len() != picture.channels {
            let expected = format!("{} channel(s)", all.channels.len());
            return Err(Error::Size { name: name.to_owned(), found: picture.size(), expected });
        }
        let strength = match self.strengths[light].as_slice() {
            [one] => vec![*one; picture.channels],
            each => each.to_vec(),
        };
        let mut visit = |s: &Seen<'_>| {
            all.push(s);
            if let Some(places) = &mut self.places {
                places.push((self.seen.len(), s.pixel));
            }
        };
        let counts: Counts = self.scene.observe(picture, place, &strength, self.mask.as_deref(), &mut visit)?;
        self.size = (picture.width, picture.height);
        if all.is_empty() {
            self.all = None;
        }
        self.seen.push(StackSeen {
            name: stack.name.clone(),
            light: light_of(stack).to_owned(),
            place,
            counts,
            strength,
        });
        if counts.valid == 0 {
            return Err(Error::Nothing { stack: stack.name.clone(), why: counts.why().to_owned() });
        }
        Ok(())
    }
}

/// Name of the light of a stack: its own where it names none.
fn light_of(stack: &Stack) -> &str {
    stack.light.as_deref().unwrap_or(&stack.name)
}

/// The picture of a stack, and its path.
pub(super) fn picture(photos: &mut Photos, stack: &Stack) -> Result<(Radiance, String), Failure> {
    let [Exposure { photo, time_s }] = stack.exposures.as_slice() else {
        return Err(Failure::Message(format!(
            "found {} exposures in {}; expected one linear picture: `photopic capture merge` makes it",
            stack.exposures.len(),
            stack.name
        )));
    };
    let path = photos.path(photo);
    let bytes = photos.bytes(&path)?;
    // A picture that says nothing of its time, such as a merged one, is radiance already.
    let time_s = time_s.or_else(|| exif_time_s(&bytes)).unwrap_or(1.0);
    let wrong = |e: Error| Failure::Message(format!("{path}: {e}"));
    if !(time_s > 0.0 && time_s.is_finite()) {
        return Err(wrong(Error::Time { name: photo.clone(), time_s }));
    }
    let picture = Radiance::decode(&bytes, time_s).map_err(wrong)?;
    Ok((picture, path))
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
fn relative(photos: &mut Photos, scale: Scale, all: &mut Observations) -> Scale {
    let Scale::Relative { .. } = scale else { return scale };
    let mut sorted = all.values.clone();
    let half = sorted.len() / 2;
    let median = *sorted.select_nth_unstable_by(half, f64::total_cmp).1;
    let factor = report::RELATIVE_MEDIAN / median;
    all.scale(factor);
    let words = "neither strengths of the lights with the radiance of a sample nor a reference: the result is relative";
    let hint = "its median is 0.3/π; reflectances are ratios, not values";
    photos.findings.push(Finding::warning("K011", words).hint(hint).at(Location::default()));
    Scale::Relative { factor }
}

/// The bins as a file.
fn encode(target: Target, all: &Observations, binned: &Binned, path: &Path) -> Result<Vec<u8>, Failure> {
    let table = binned.table(all).map_err(message)?;
    if target == Target::Merl {
        return merl::write(&table).ok_or_else(|| {
            let bands = all.channels.len();
            Failure::Message(format!(
                "{}: a MERL file has three channels; found {bands}; expected .csv or .alta",
                path.display()
            ))
        });
    }
    let points = nodes(&Table::HalfAngle(table)).map_err(message)?.value;
    Ok(match target {
        Target::Alta => alta::write(&points, Encoding::Text).value,
        _ => csv::write(&points).value.into_bytes(),
    })
}

//! `capture lights`: where the lights were, from photographs of balls.

mod balls;
mod compare;
mod notice;
mod run;
mod surroundings;

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::photos::{Form, Given, Photos, is_manifest};
use crate::capture::lights::adjust::{Start, adjust};
use crate::capture::lights::list;
use crate::capture::lights::view::View;
use crate::capture::manifest::{Shows, Stack};
use crate::capture::setup;
use crate::cli::{Failure, Talk};
use crate::report::capture_lights::{self as report, BallSeen};
use balls::BallInUse;
use notice::notice;
use run::Run;

/// Photographs, lists to compare and the form of the answer.
#[derive(Debug, Args)]
#[command(after_long_help = "\
A mirror ball shows the lamp: stacks that say shows = \"mirror-ball\". A diffuse ball (shows = \"object\" or \"reference\", with a [[ball]])
tells the direction of a distant light by its shading, to a few degrees. Without [camera] rays are parallel and directions are x to the
right, y upwards, z towards the camera. Two balls, or --distance, tell the place of a near light.

Examples:
  photopic capture lights capture.toml
  photopic capture lights chrome.*.png --mask chrome.mask.png --list lights.txt
  photopic capture lights capture.toml --environment surroundings.exr --json")]
pub(in crate::cli) struct LightsArgs {
    #[command(flatten)]
    given: Given,
    /// Mask of the ball, where photographs of a mirror ball are named directly.
    #[arg(long, value_name = "PICTURE")]
    mask: Option<PathBuf>,
    /// Directions from elsewhere to be compared: three numbers a line, or a name and three; by name, else in the order of the lights.
    #[arg(long, value_name = "FILE")]
    list: Vec<PathBuf>,
    /// Distance of all lamps from the first ball, m, where one ball is all there is.
    #[arg(long, value_name = "M")]
    distance: Option<f64>,
    /// Write the surroundings in the mirror ball of the first such stack as an equirectangular EXR.
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
    /// Width of that picture, pixels; it is half as high.
    #[arg(long, value_name = "PIXELS", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(2..=16384))]
    width: u32,
    /// Reflectance of the mirror ball.
    #[arg(long, value_name = "R", default_value_t = 1.0)]
    reflectance: f64,
    #[command(flatten)]
    form: Form,
    /// The lights as one table.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

fn message(error: impl ToString) -> Failure {
    Failure::Message(error.to_string())
}

pub(super) fn lights(a: &LightsArgs, talk: Talk) -> Result<(), Failure> {
    if a.distance.is_some_and(|d| !(d > 0.0 && d.is_finite())) || !(a.reflectance > 0.0 && a.reflectance <= 1.0) {
        let words = "found a --distance or --reflectance out of range; expected above 0 m, and above 0 to 1";
        return Err(Failure::Message(words.to_owned()));
    }
    let mut photos = Photos::open("capture lights", &a.given, talk)?;
    if !a.given.files.iter().any(|f| is_manifest(f)) {
        direct(&mut photos, a);
    }
    let view = View::new(photos.manifest.camera.as_ref()).map_err(message)?;
    let linear = photos.manifest.response.linear;
    let mut run = Run { view, linear, names: Vec::new(), balls: Vec::new(), seen: Vec::new(), points: Vec::new() };
    run.look(&mut photos)?;
    if run.seen.is_empty() {
        photos.notes.print(&photos.findings);
        let words = "found no photograph that tells a light; expected stacks with shows = \"mirror-ball\", or of a diffuse [[ball]]";
        return Err(Failure::Message(words.to_owned()));
    }
    let places = run.places(a.distance)?;
    let starts: Vec<Start> = run.balls.iter().map(|b| b.start.clone()).collect();
    let adjusted = adjust(view, &starts, &places, &run.observations()).map_err(message)?;
    let entanglement = run.entanglement(|k| report::direction(&adjusted, k));
    let mut compared = run.stated(&photos, &adjusted);
    for path in &a.list {
        let path = path.display().to_string();
        let text = String::from_utf8_lossy(&photos.bytes(&path)?).into_owned();
        let listed = list::parse(&text).map_err(|e| Failure::Message(format!("{path}:{e}")))?;
        compared.push(run.listed(&path, &listed, |k| report::direction(&adjusted, k))?);
    }
    let balls: Vec<BallSeen> = run.balls.iter().map(BallInUse::seen).collect();
    let answer = report::Answer {
        names: &run.names,
        balls: &balls,
        seen: &run.seen,
        adjusted: &adjusted,
        compared: &compared,
        entanglement: entanglement.as_ref(),
    };
    notice(&mut photos, &run, &answer);
    if let Some(path) = &a.environment {
        run.environment(&mut photos, a, path, &adjusted.balls)?;
    }
    let settings = json!({
        "distance_m": a.distance, "lists": a.list.iter().map(|p| p.display().to_string()).collect::<Vec<_>>(),
        "reflectance": a.reflectance, "view": if view.camera.is_some() { "camera" } else { "parallel" },
    });
    let text = if a.csv { report::csv(&answer) } else { report::text(&answer) };
    photos.print(&settings, &[report::object(&answer)], &text, a.form.json, a.output.as_deref())
}

/// Photographs named directly: each is a stack of a mirror ball under a light of the same name.
fn direct(photos: &mut Photos, a: &LightsArgs) {
    let stacks = photos.manifest.stack.drain(..).flat_map(|s| s.exposures);
    let one = |exposure: crate::capture::manifest::Exposure| {
        let name =
            Path::new(&exposure.photo).file_stem().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        Stack { shows: Shows::MirrorBall, ..Stack::new(name, vec![exposure]) }
    };
    photos.manifest.stack = stacks.map(one).collect();
    let mask = a.mask.as_ref().map(|m| m.display().to_string());
    photos.manifest.ball = vec![setup::Ball { name: "ball".to_owned(), mask, ..setup::Ball::default() }];
}

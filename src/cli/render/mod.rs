//! `render`: a scene in, readings and pictures out.

mod files;
mod pictures;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;

use super::notes::Notes;
use super::output::Sink;
use super::{Failure, Talk};
use crate::render::build::{Built, Kind, build};
use crate::render::description::{self, Description};
use crate::render::estimate::REPLICATES;
use crate::render::measure::{Board, Meter, Target};
use crate::render::reading::{self, Reading};
use crate::render::spool::Share;
use crate::report::envelope::Envelope;
use crate::report::render as report;

/// Arguments of `render`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
A scene is a TOML file of materials, shapes, lights and sensors; docs/scenes.md explains it, --schema prints its JSON schema.

Examples:
  photopic render data/scenes/office.toml
  photopic render room.toml --check
  photopic render room.toml --target '1 %' --json -o readings.json
  photopic render room.toml --samples 1024 --folder pictures")]
pub(super) struct RenderArgs {
    /// The scene; `-` is standard input.
    #[arg(required_unless_present = "schema", value_name = "SCENE")]
    scene: Option<String>,
    /// Say what the scene holds and needs; render nothing.
    #[arg(long)]
    check: bool,
    /// Print the JSON schema of scenes.
    #[arg(long, conflicts_with_all = ["check", "scene"])]
    schema: bool,
    /// Samples of a pixel, instead of the scene's.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    samples: Option<u64>,
    /// Samples of a meter, at most where there is a target, instead of the scene's.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    meter_samples: Option<u64>,
    /// Names all random numbers, instead of the scene's.
    #[arg(long, value_name = "NUMBER")]
    seed: Option<u64>,
    /// Sample the meters until their standard errors are this share of their readings; with a name or `lux` or `nits` only those.
    /// Exit code 1 where that takes more than the samples allowed.
    #[arg(long, value_name = "'SHARE % [WHICH]'", value_parser = target)]
    target: Option<TargetArg>,
    /// Folder for the pictures that the scene names; the current one without it.
    #[arg(long, value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// One JSON document.
    #[arg(long)]
    json: bool,
    /// Write the readings to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// A relative standard error and the meters that it is for.
#[derive(Debug, Clone, PartialEq)]
struct TargetArg {
    relative: f64,
    which: Option<String>,
}

fn target(text: &str) -> Result<TargetArg, String> {
    let expected = || format!("`{text}`; expected a share such as `1 %`, `1 % lux` or `0.5 % desk`");
    let (number, which) = text.split_once('%').ok_or_else(expected)?;
    let percent: f64 = number.trim().parse().ok().filter(|p| *p > 0.0 && *p < 1e6).ok_or_else(expected)?;
    let which = which.trim();
    Ok(TargetArg { relative: percent / 100.0, which: (!which.is_empty()).then(|| which.to_owned()) })
}

pub(super) fn run(arguments: &RenderArgs, talk: Talk) -> Result<(), Failure> {
    let a = arguments;
    let Some(path) = a.scene.as_deref() else {
        let mut sink = Sink::open(a.output.as_deref(), &[])?;
        writeln!(sink, "{:#}", description::schema())?;
        return sink.finish(true);
    };
    let begun = Instant::now();
    let scene = files::Scene::read(path)?;
    let wrong = |e: description::Error| Failure::Message(format!("{path}:{e}"));
    let mut description = Description::parse(&scene.text).map_err(wrong)?;
    let render = &mut description.render;
    render.samples = a.samples.unwrap_or(render.samples);
    render.meter_samples = a.meter_samples.unwrap_or(render.meter_samples);
    render.seed = a.seed.unwrap_or(render.seed);
    let built = build(&scene.text, &description, &scene).map_err(wrong)?;
    let inputs = scene.inputs();
    let read: Vec<String> = inputs.iter().map(|i| i.path.clone()).collect();
    let mut sink = Sink::open(a.output.as_deref(), &read)?;
    let settings = json!({
        "samples": description.render.samples,
        "meter_samples": description.render.meter_samples,
        "seed": description.render.seed,
        "replicates": REPLICATES,
    });
    let (result, text, reached) = if a.check {
        (report::contents(&built), report::contents_text(&built), true)
    } else {
        let notes = Notes::new(&[], talk);
        let (readings, written) = render_all(a, &description, &built, &read, talk)?;
        notes.print(&files::findings(path, &readings));
        let reached = readings.iter().all(|r| r.target.is_none_or(|t| t.1));
        let result = report::result(&built, &readings, &written, begun.elapsed().as_secs_f64());
        let mut text = report::text(&built, &readings);
        written.iter().for_each(|w| text.push_str(&format!("written: {w}\n")));
        (result, text, reached)
    };
    if a.json {
        let mut envelope = Envelope::begin(&mut sink, "render", &settings)?;
        inputs.into_iter().for_each(|i| envelope.input(i));
        envelope.result(&result)?;
        envelope.end()?;
    } else {
        sink.write_all(text.as_bytes())?;
    }
    sink.finish(true)?;
    if reached { Ok(()) } else { Err(Failure::No) }
}

fn render_all(
    a: &RenderArgs,
    description: &Description,
    built: &Built,
    read: &[String],
    talk: Talk,
) -> Result<(Vec<Reading>, Vec<String>), Failure> {
    // Every meter with its number in the render; instruments are 2³² numbers apart, so that none depends on another's points.
    let mut meters: Vec<(u64, Meter)> = Vec::new();
    let mut first = Vec::new();
    for (number, instrument) in (0_u64..).zip(&built.instruments) {
        first.push(meters.len());
        let own: &[Meter] = match &instrument.kind {
            Kind::Meter(meter) => std::slice::from_ref(meter),
            Kind::Grid { meters, .. } => meters,
            Kind::Camera(_) => &[],
        };
        meters.extend((0_u64..).zip(own).map(|(point, m)| ((number << 32) + point, m.clone())));
    }
    first.push(meters.len());
    let targets = targets(a, built)?;
    let per_replicate = description.render.meter_samples.div_ceil(REPLICATES as u64);
    let pixels: u64 = (built.instruments.iter())
        .map(|i| if let Kind::Camera(c) = &i.kind { u64::from(c.width()) * u64::from(c.height()) } else { 0 })
        .sum();
    // In units of samples, of meters and pixels alike.
    let meter_work = per_replicate * (REPLICATES * meters.len()) as u64;
    let progress = progress(meter_work + pixels * description.render.samples, talk);
    let mut board = Board::new(&built.scene, &built.settings, Share::WHOLE, meters);
    let points = |n: usize| first[n]..first[n + 1];
    let mut reached = vec![None; built.instruments.len()];
    let weights = built.quantities.luminous.clone();
    let wanted: Vec<(usize, f64)> = targets.iter().enumerate().filter_map(|(n, t)| Some((n, (*t)?))).collect();
    if wanted.is_empty() {
        // A few rounds, so that the bar moves.
        const ROUNDS: u64 = 64;
        for round in 1..=ROUNDS {
            let samples = per_replicate * round / ROUNDS;
            board.sample_until(samples);
            progress.set_position(meter_work * round / ROUNDS);
        }
    }
    for (n, relative) in &wanted {
        // Meters without a target get the samples of the last round as well.
        let target = Target { relative: *relative, meters: points(*n).collect(), weights: weights.clone() };
        let met = board.sample_to(&target, per_replicate, |_, samples| {
            progress.set_position(meter_work * samples / per_replicate);
        });
        reached[*n] = Some((*relative, met));
    }
    progress.set_position(meter_work);
    let bands = built.scene.bands();
    let (mut readings, mut written) = (Vec::new(), Vec::new());
    for (n, instrument) in built.instruments.iter().enumerate() {
        if let Kind::Camera(camera) = &instrument.kind {
            let described =
                description.sensor[n].camera.as_ref().expect("the instruments are those described").get_ref();
            let job = pictures::Job {
                built,
                camera,
                instrument: (n as u64) << 32,
                samples: description.render.samples,
                folder: a.folder.as_deref().unwrap_or(Path::new("")),
                inputs: read,
                talk,
            };
            let noise = job.render(described, &instrument.name, &progress, &mut written)?;
            readings.push(reading::of_picture(instrument, &noise, description.render.samples));
        } else if let Some(r) = reading::of_board(instrument, &board, first[n], bands, &built.quantities, reached[n]) {
            readings.push(r);
        }
    }
    progress.finish_and_clear();
    Ok((readings, written))
}

/// The target of each instrument: the scene's, or that of the command line where it is for it.
fn targets(a: &RenderArgs, built: &Built) -> Result<Vec<Option<f64>>, Failure> {
    let unit = |kind: &Kind| match kind {
        Kind::Meter(m) => Some(reading::quantity(&m.response).1),
        Kind::Grid { meters, .. } => Some(reading::quantity(&meters[0].response).1),
        Kind::Camera(_) => None,
    };
    let mut any = false;
    let targets = (built.instruments.iter())
        .map(|i| {
            let unit = unit(&i.kind)?;
            let Some(t) = &a.target else { return i.target };
            let meant = match t.which.as_deref() {
                None => true,
                Some("lux" | "lx") => unit == "lx",
                Some("nits" | "nit" | "cd/m2") => unit == "cd/m2",
                Some(name) => name == i.name,
            };
            any |= meant;
            if meant { Some(t.relative) } else { i.target }
        })
        .collect();
    match &a.target {
        Some(t) if !any => {
            let names: Vec<&str> =
                built.instruments.iter().filter(|i| unit(&i.kind).is_some()).map(|i| i.name.as_str()).collect();
            let which = t.which.as_deref().unwrap_or("any meter");
            Err(Failure::Message(format!(
                "--target: no meter is meant by `{which}`; expected lux, nits or one of: {}",
                names.join(", ")
            )))
        }
        _ => Ok(targets),
    }
}

/// A bar for what takes long; hidden where nobody watches.
fn progress(samples: u64, talk: Talk) -> ProgressBar {
    use std::io::IsTerminal;
    if talk.quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(samples);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent} %, {eta} left") {
        bar.set_style(style);
    }
    bar
}

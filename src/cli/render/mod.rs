//! `render`: a scene in, readings and pictures out.

mod audits;
mod files;
mod pictures;
mod radiosity;
mod settings;
mod sheets;
mod state;
mod work;

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::output::{self, Sink};
use super::{Failure, Talk};
use crate::render::build::{Built, Instrument, Kind};
use crate::render::description::{self, Model, Solver};
use crate::render::reading;
use crate::render::spool::Share;
use crate::report::render as report;
pub(super) use files::Scene;
use settings::Settings;
use state::State;
use work::{Job, Overrides, Work};

/// Arguments of `render`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
A scene is a TOML file of materials, shapes, lights and sensors; docs/scenes.md explains it, --schema prints its JSON schema.

Examples:
  photopic render data/scenes/office.toml
  photopic render room.toml --check
  photopic render room.toml --preview                          (a first look, no measurement)
  photopic render room.toml --target '1 %' --json -o readings.json
  photopic render room.toml --samples 1024 --folder pictures
  photopic render room.toml --checkpoint room.state            (run it again after a break)
  photopic render room.toml --shard 1/4 -o 1.shard; …; photopic merge *.shard")]
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
    /// A first look: direct light without shadows, one sample of a pixel and 64 of a meter. Its figures are no measurement.
    #[arg(long, conflicts_with_all = ["samples", "meter_samples", "target", "checkpoint", "resume", "shard"])]
    preview: bool,
    /// Samples of a pixel, instead of the scene's.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    samples: Option<u64>,
    /// Samples of a meter, at most where there is a target, instead of the scene's.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    meter_samples: Option<u64>,
    /// What is modelled, instead of the scene's: only what the scene requires (minimal), or everything (full): wavelengths 1 nm apart,
    /// polarisation, lights of no flux. Both agree within their error bars.
    #[arg(long, value_name = "EXTENT", value_parser = model)]
    model: Option<Model>,
    /// Filter pictures, whatever the scene says: less noise for a bias that is measured and told. Readings are not filtered.
    #[arg(long, conflicts_with = "preview")]
    denoise: bool,
    /// A file with `[render]` keys in place of the scene's, as `trade render --settings` writes it; options given here go before it.
    #[arg(long, value_name = "FILE", conflicts_with = "preview")]
    settings: Option<PathBuf>,
    /// Names all random numbers, instead of the scene's.
    #[arg(long, value_name = "NUMBER")]
    seed: Option<u64>,
    /// Sample the meters until their standard errors are this share of their readings; with a name or `lux`, `nits`, `lm` only those, with a camera's name or
    /// `picture` pictures until that of their mean luminance is. Exit code 1 where that takes more than the samples allowed.
    #[arg(long, value_name = "'SHARE % [WHICH]'", value_parser = target)]
    target: Option<TargetArg>,
    /// Keep the state of the render in a file, and go on from it where the file is there already.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["check", "target", "resume", "shard"])]
    checkpoint: Option<PathBuf>,
    /// Go on from the state that --checkpoint or --shard left behind, to the same bits as without the break.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["check", "target", "shard"])]
    resume: Option<PathBuf>,
    /// Render only part I of N (from 1) into the state file of -o; `photopic merge` joins the parts to the same bits as one run.
    #[arg(long, value_name = "I/N", value_parser = share, requires = "output", conflicts_with_all = ["check", "target", "json"])]
    shard: Option<Share>,
    /// Folder for the pictures that the scene names; the current one without it.
    #[arg(long, value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// Packets of flux that are sent through the scene to see where the energy goes; more make the audit's error bars narrower, 0
    /// leaves it out.
    #[arg(long, value_name = "COUNT", default_value_t = PACKETS)]
    packets: u64,
    /// One JSON document.
    #[arg(long)]
    json: bool,
    /// Write the readings to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Packets of the energy audit, where no number is given.
const PACKETS: u64 = 1 << 14;

/// A relative standard error and the sensors that it is for.
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

fn model(text: &str) -> Result<Model, String> {
    match text {
        "minimal" => Ok(Model::Minimal),
        "full" => Ok(Model::Full),
        _ => Err(format!("`{text}`; expected minimal or full")),
    }
}

fn share(text: &str) -> Result<Share, String> {
    let both = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
    match both {
        Some((index, count)) if (1..=count).contains(&index) => Ok(Share { index: index - 1, count }),
        _ => Err(format!("`{text}`; expected I/N, part I (1 to N) of N")),
    }
}

/// Arguments of `merge`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
The scene and its files are read again from where they were; the parts of one render have the same fingerprint.

Example:
  photopic merge *.shard --folder pictures --json -o readings.json")]
pub(super) struct MergeArgs {
    /// All parts that `photopic render --shard` wrote.
    #[arg(required = true, value_name = "SHARD")]
    shards: Vec<String>,
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

/// Where pictures go: there must be such a folder, which is asked before anything is rendered.
fn folder(given: Option<&Path>) -> Result<&Path, Failure> {
    match given {
        Some(folder) if !folder.is_dir() => {
            Err(Failure::Message(format!("{}: no such folder; expected one that is there", folder.display())))
        }
        Some(folder) => Ok(folder),
        None => Ok(Path::new("")),
    }
}

pub(super) fn run(arguments: &RenderArgs, talk: Talk) -> Result<(), Failure> {
    let a = arguments;
    let Some(path) = a.scene.as_deref() else {
        let mut sink = Sink::open(a.output.as_deref(), &[])?;
        writeln!(sink, "{:#}", description::schema())?;
        return sink.finish(true);
    };
    let preview = |count: u64| a.preview.then_some(count);
    let overrides = Overrides {
        solver: a.preview.then_some(Solver::Preview),
        samples: a.samples.or(preview(1)),
        meter_samples: a.meter_samples.or(preview(64)),
        seed: a.seed,
        model: a.model,
        denoise: a.denoise,
        target: a.target.as_ref().map(|t| t.relative),
        settings: a.settings.as_deref().map(Settings::read).transpose()?.unwrap_or_default(),
    };
    let work = Work::new(path, &overrides)?;
    if a.check {
        let result = (report::contents(&work.built), report::contents_text(&work.built));
        let findings = work.findings(&[], None, talk);
        return work.print("render", result, a.json, a.output.as_deref(), findings);
    }
    let keeps = a.checkpoint.is_some() || a.resume.is_some() || a.shard.is_some();
    if let Some(reason) = keeps.then(|| stateless(&work.built)).flatten() {
        return Err(Failure::Message(reason.to_owned()));
    }
    let place = a.checkpoint.as_deref().or(a.resume.as_deref()).or(a.output.as_deref().filter(|_| a.shard.is_some()));
    let share = a.shard.unwrap_or(Share::WHOLE);
    let mut state = match place.filter(|_| keeps) {
        Some(file) => {
            if work.read.iter().any(|input| output::same_file(Path::new(input), file)) {
                return Err(Failure::Message(output::overwrites(file)));
            }
            Some(State::open(file, &work.header(share, a.packets), a.resume.is_some())?)
        }
        None => None,
    };
    if work.built.radiosity.is_some() && a.target.is_some() {
        let message = "--target: the solver \"radiosity\" has no standard errors; expected a `patch_edge` in the scene";
        return Err(Failure::Message(message.to_owned()));
    }
    let targets = targets(a, &work.built)?;
    let job = Job { share, folder: folder(a.folder.as_deref())?, targets: &targets, talk };
    match work.render(&job, state.as_mut())? {
        None => Ok(()),
        Some(done) => work.report("render", done, a.json, a.output.as_deref(), talk, a.packets),
    }
}

/// Why no state can be kept of a scene.
fn stateless(built: &Built) -> Option<&'static str> {
    if built.radiosity.is_some() {
        return Some("the solver \"radiosity\" keeps no state; expected no --checkpoint, --resume and --shard");
    }
    let around = |kind: &Kind| matches!(kind, Kind::Goniophotometer(_) | Kind::Gonioreflectometer(_));
    if built.instruments.iter().any(|i| i.target.is_some()) {
        Some("the scene has a `target`, and a state is kept only for a number of samples; expected one or the other")
    } else if built.instruments.iter().any(|i| around(&i.kind)) {
        Some(
            "the scene has a goniophotometer or a gonioreflectometer, and a state is kept only for meters and pictures; expected a scene without it, or no --checkpoint, --resume and --shard",
        )
    } else {
        None
    }
}

pub(super) fn merge(a: &MergeArgs, talk: Talk) -> Result<(), Failure> {
    let mut state = State::join(&a.shards)?;
    let header = state.header().clone();
    let task = &header.task;
    let overrides = Overrides {
        solver: None,
        samples: Some(task.samples),
        meter_samples: Some(task.meter_samples),
        seed: Some(task.seed),
        model: Some(if task.full { Model::Full } else { Model::Minimal }),
        denoise: task.denoise,
        target: None,
        settings: Settings::parse(&format!("{}: settings", a.shards[0]), task.settings.clone())?,
    };
    let work = Work::new(&task.scene, &overrides)?;
    if work.fingerprint != header.fingerprint {
        let message = format!("{}: the scene or its files have changed since the shards were rendered", task.scene);
        return Err(Failure::Message(message));
    }
    let targets = vec![None; work.built.instruments.len()];
    let folder = folder(a.folder.as_deref())?;
    let job = Job { share: Share::WHOLE, folder, targets: &targets, talk };
    match work.render(&job, Some(&mut state))? {
        None => Ok(()),
        Some(done) => work.report("merge", done, a.json, a.output.as_deref(), talk, state.packets()),
    }
}

/// The target of each instrument: the scene's, or that of the command line where it is for it.
fn targets(a: &RenderArgs, built: &Built) -> Result<Vec<Option<f64>>, Failure> {
    let unit = |kind: &Kind| match kind {
        Kind::Meter(m) => Some(reading::quantity(&m.response).1),
        Kind::Grid { meters, .. } => Some(reading::quantity(&meters[0].response).1),
        // Its mean luminance.
        Kind::Camera(_) => Some("picture"),
        Kind::Goniophotometer(_) | Kind::Gonioreflectometer(_) => None,
    };
    let is_picture = |i: &Instrument| matches!(i.kind, Kind::Camera(_));
    // A target for no sensor by name is for all meters, or for pictures where there is nothing else.
    let only_pictures = built.instruments.iter().all(is_picture);
    let mut any = false;
    let targets = (built.instruments.iter())
        .map(|i| {
            let unit = unit(&i.kind)?;
            // A first look does not wait for the scene's own targets.
            if a.preview {
                return None;
            }
            let Some(t) = &a.target else { return i.target };
            let meant = match t.which.as_deref() {
                None => only_pictures || !is_picture(i),
                Some("lux" | "lx") => unit == "lx",
                Some("nits" | "nit" | "cd/m2") => unit == "cd/m2",
                Some("lm") => unit == "lm",
                Some("picture" | "pictures") => unit == "picture",
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
            let which = t.which.as_deref().unwrap_or("any sensor");
            Err(Failure::Message(format!(
                "--target: no sensor is meant by `{which}`; expected lux, nits, lm, picture or one of: {}",
                names.join(", ")
            )))
        }
        _ => Ok(targets),
    }
}

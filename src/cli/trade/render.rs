//! `trade render`.

use clap::Args;
use serde_json::json;

use super::output::{Asked, Traded, settings_file};
use super::target::place;
use crate::cli::notes::bar;
use crate::cli::render::Scene;
use crate::cli::{Failure, Talk};
use crate::render::description::sensor::Sensor;
use crate::render::description::{Description, Model};
use crate::trade::{picture, render};

/// A scene, and the error asked for.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic trade render data/scenes/office.toml --sensor desk --error '1 %' --plot trade.svg
  photopic trade render data/scenes/office.toml --sensor view --samples 64 --repeats 5
  photopic trade render room.toml --error 1% --settings fast.toml && photopic render room.toml --settings fast.toml")]
pub(in crate::cli) struct RenderArgs {
    /// The scene; `-` is standard input.
    #[arg(value_name = "SCENE")]
    scene: String,
    /// The sensor whose error counts, a meter, a grid or a camera; the first meter or grid without it, or the first camera where there is none.
    /// The error of a picture is the root mean square of its pixels' relative errors of luminance.
    #[arg(long, value_name = "NAME")]
    sensor: Option<String>,
    /// Samples of a meter at most, instead of the scene's.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    meter_samples: Option<u64>,
    /// Samples of a pixel, instead of the scene's.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    samples: Option<u64>,
    #[command(flatten)]
    asked: Asked,
}

pub(super) fn trade(arguments: &RenderArgs, talk: Talk) -> Result<(), Failure> {
    let (asked, path) = (&arguments.asked, &arguments.scene);
    asked.check()?;
    let scene = Scene::read(path)?;
    let mut description = Description::parse(&scene.text).map_err(|e| Failure::Message(format!("{path}:{e}")))?;
    let render = &mut description.render;
    render.meter_samples = arguments.meter_samples.unwrap_or(render.meter_samples);
    render.samples = arguments.samples.unwrap_or(render.samples);
    let sensors = &description.sensor;
    if let Some(name) = &arguments.sensor {
        let known: Vec<&str> = sensors.iter().map(|s| s.name.get_ref().as_str()).collect();
        if !known.contains(&name.as_str()) {
            let message = format!("--sensor {name}: no such sensor; expected one of {}", known.join(", "));
            return Err(Failure::Message(message));
        }
    }
    let is_camera = |s: &Sensor| s.camera.is_some();
    let camera = match &arguments.sensor {
        Some(name) => sensors.iter().position(|s| s.name.get_ref() == name).filter(|at| is_camera(&sensors[*at])),
        // Pictures take long: only where nothing else is there.
        None if sensors.iter().all(is_camera) => Some(0),
        None => None,
    };
    let (text, repeats) = (&scene.text, asked.repeats as usize);
    let bar = bar(0, "{bar:40} {pos}/{len} renders, {eta} left", true, talk);
    let progress = |done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    };
    let found = match camera {
        Some(camera) => picture::sweep(text, &description, &scene, repeats, camera, progress),
        None => render::sweep(text, &description, &scene, repeats, progress),
    };
    bar.finish_and_clear();
    let found = found.map_err(|e| Failure::Message(format!("{path}:{e}")))?;
    let first = found.sweep.figures.first().map_or_else(String::new, |f| f.key.to_string());
    let figure = arguments.sensor.clone().unwrap_or(first);
    place(&found.sweep.figures, &figure)?;
    let traded = Traded {
        command: "trade render",
        path,
        inputs: scene.inputs(),
        sweep: &found.sweep,
        figure: &figure,
        findings: Vec::new(),
    };
    let settings = |trial: usize| {
        let render = &found.choices[trial];
        let samples = match camera {
            Some(_) => vec![
                ("samples", Some(json!(render.samples))),
                ("adaptive", Some(json!(render.adaptive))),
                ("denoise", Some(json!(render.denoise.as_ref().is_some_and(|d| *d.get_ref())))),
                // What is chosen stays so.
                ("branches", render.branches.map(|n| json!(n))),
                ("virtual_lights", render.virtual_lights.map(|is| json!(is))),
                ("guiding", render.guiding.map(|is| json!(is))),
            ],
            None => vec![("meter_samples", Some(json!(render.meter_samples)))],
        };
        let others = [
            ("solver", Some(json!(render.solver.word()))),
            ("max_edges", Some(render.max_edges.map_or_else(|| json!("any"), |n| json!(n)))),
            ("roulette_from", Some(json!(render.roulette_from))),
            ("sampler", Some(json!(render.sampler.word()))),
            ("wavelengths_per_path", Some(json!(render.wavelengths_per_path.word()))),
            match render.wavelength_step_nm {
                Some(step) => ("wavelength_step_nm", Some(json!(step))),
                None => ("wavelength_tolerance", Some(json!(render.wavelength_tolerance))),
            },
            ("model", Some(json!(if render.model == Model::Full { "full" } else { "minimal" }))),
        ];
        let all: Vec<_> = samples.into_iter().chain(others).collect();
        settings_file(&format!("photopic trade render {path}"), "render", &all)
    };
    asked.answer(traded, settings, talk)
}

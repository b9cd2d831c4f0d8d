//! `trade render`.

use clap::Args;
use serde_json::json;

use super::output::{Asked, Traded, settings_file};
use super::target::place;
use crate::cli::render::Scene;
use crate::cli::{Failure, Talk};
use crate::render::description::{Description, Model};
use crate::trade::render::sweep;

/// A scene, and the error asked for.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic trade render data/scenes/office.toml --sensor desk --error '1 %' --plot trade.svg
  photopic trade render room.toml --error 1% --settings fast.toml && photopic render room.toml --settings fast.toml")]
pub(in crate::cli) struct RenderArgs {
    /// The scene; `-` is standard input. Its meters are read, not its pictures.
    #[arg(value_name = "SCENE")]
    scene: String,
    /// The sensor whose error counts; the first meter or grid without it.
    #[arg(long, value_name = "NAME")]
    sensor: Option<String>,
    /// Samples of a meter at most, instead of the scene's.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    meter_samples: Option<u64>,
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
    if let Some(name) = &arguments.sensor {
        let known: Vec<&str> = description.sensor.iter().map(|s| s.name.get_ref().as_str()).collect();
        if !known.contains(&name.as_str()) {
            let message = format!("--sensor {name}: no such sensor; expected one of {}", known.join(", "));
            return Err(Failure::Message(message));
        }
    }
    let found = sweep(&scene.text, &description, &scene, asked.repeats as usize)
        .map_err(|e| Failure::Message(format!("{path}:{e}")))?;
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
        settings_file(
            &format!("photopic trade render {path}"),
            "render",
            &[
                ("meter_samples", Some(json!(render.meter_samples))),
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
            ],
        )
    };
    asked.answer(traded, settings, talk)
}

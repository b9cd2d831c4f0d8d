//! `trade capture`.

use clap::Args;
use serde_json::json;

use super::output::{Asked, Traded, settings_file};
use super::target::{must_be_defined, place};
use crate::brdf::description::template::Template;
use crate::brdf::fit::Options;
use crate::brdf::table::Resolution;
use crate::cli::brdf::Bins;
use crate::cli::capture::{FITTED, Retaken, Taken};
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::trade::capture::{CaptureSweep, choices, sweep};

/// Bins in which settings are compared: coarse enough that few pixels still fill them.
pub(in crate::cli) const BINS: Resolution = Resolution { theta_h: 30, theta_d: 30, phi_d: 36 };

/// A manifest, and the error asked for.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic trade capture capture.toml --error 2% --repeats 3 --plot capture.svg
  photopic trade capture capture.toml -m 'lambert + ggx' --figure ggx.alpha --error 1%
  photopic trade capture capture.toml --error 2% --settings less.toml && photopic capture brdf capture.toml --settings less.toml

Errors are relative to the finest setting, which is no truth; its own standard error is on top of each that is guaranteed.
f_r is compared in the bins of the finest setting: where half of them are lost there is no median, and such a setting is not recommended by it.")]
pub(in crate::cli) struct CaptureArgs {
    /// The manifest, as for `capture brdf`.
    #[arg(value_name = "MANIFEST")]
    manifest: String,
    /// The figure whose error counts: f_r_median, f_r_p90, coverage_lost, or a parameter of the model such as lambert.reflectance.R.
    #[arg(long, value_name = "KEY", default_value = "f_r_median")]
    figure: String,
    /// The model whose parameters are watched.
    #[arg(short, long, value_name = "MODEL", default_value = "lambert")]
    model: Template,
    /// Bins in θh, θd and φd in which f_r is compared; 30x30x36 without it.
    #[arg(long, value_name = "HxDxP")]
    resolution: Option<Bins>,
    #[command(flatten)]
    asked: Asked,
}

pub(super) fn trade(arguments: &CaptureArgs, talk: Talk) -> Result<(), Failure> {
    let (asked, path) = (&arguments.asked, &arguments.manifest);
    asked.check()?;
    let photos = Retaken::open(path, talk)?;
    let options = Options { places: Some(FITTED), ..Options::default() };
    let resolution = arguments.resolution.map_or(BINS, |r| r.0);
    let (mut inputs, mut findings) = (None, Vec::new());
    let measure = |choice: &_| {
        let Taken { all, pixel_variance_sd, inputs: read, findings: found } =
            photos.measure(choice).map_err(|e| e.to_string())?;
        // The finest comes first.
        if inputs.is_none() {
            (inputs, findings) = (Some(read), found);
        }
        Ok((all, pixel_variance_sd))
    };
    let all = choices(photos.lights, photos.exposures);
    let repeats = asked.repeats as usize;
    let CaptureSweep { sweep, choices, failed } =
        sweep(all, (&arguments.model, &options), resolution, repeats, measure)
            .map_err(|e| Failure::Message(format!("{path}: {e}")))?;
    let figure = place(&sweep.figures, &arguments.figure)?;
    must_be_defined(path, &sweep, figure)?;
    findings.extend(failed.iter().map(|(choice, why)| {
        let words = format!("{} lights, {} exposures, every {}: {why}", choice.lights, choice.exposures, choice.every);
        Finding::info("T004", words).at(Location::default().in_file(path))
    }));
    let traded = Traded {
        command: "trade capture",
        path,
        inputs: inputs.unwrap_or_default(),
        sweep: &sweep,
        figure: &arguments.figure,
        findings,
    };
    let settings = |trial: usize| {
        let choice = choices[trial];
        settings_file(
            &format!("photopic trade capture {path}"),
            "capture",
            &[
                ("lights", Some(json!(choice.lights))),
                ("exposures", Some(json!(choice.exposures))),
                ("every", Some(json!(choice.every))),
            ],
        )
    };
    asked.answer(traded, settings, talk)
}

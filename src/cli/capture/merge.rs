//! `capture merge`: exposures into linear radiance.

use std::io::BufWriter;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::photos::{Form, Given, Photos};
use super::response::{Method, find, read_table};
use crate::capture::manifest::Stack;
use crate::capture::merge::{Merge, Range, Respond};
use crate::capture::noise::Noise;
use crate::cli::output::{Whole, overwrites, same_file};
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::image::format::exr;
use crate::report::capture as report;

/// Photographs, response and where the pictures go.
#[derive(Debug, Args)]
#[command(after_long_help = "\
An EXR has the radiances as R, G, B (or Y), their standard errors as standard_error.R …, and what became of each sample as state.R …:
0 valid, 1 saturated (the radiance is a lower bound), 2 dark (an upper bound), 3 dark in one and saturated in the other.

Examples:
  photopic capture merge capture.toml --folder merged
  photopic capture merge memorial*.png --times shutter_times.txt -o memorial.exr
  photopic capture merge raw*.tiff --times times.csv -o scene.exr")]
pub(in crate::cli) struct MergeArgs {
    #[command(flatten)]
    given: Given,
    /// A table that `capture response --csv` wrote; without it and the manifest's the response is found first.
    #[arg(long, value_name = "CSV", conflicts_with = "linear")]
    response: Option<PathBuf>,
    /// The codes are proportional to exposure, as those of EXR and of 16-bit TIFF are always taken.
    #[arg(long)]
    linear: bool,
    /// Codes below are dark.
    #[arg(long, value_name = "CODE", default_value_t = Range::default().dark)]
    dark: f64,
    /// Codes above are saturated.
    #[arg(long, value_name = "CODE", default_value_t = Range::default().saturated)]
    saturated: f64,
    /// Standard error of a code, of 0 to 255: noise and rounding.
    #[arg(long, value_name = "CODES", default_value_t = 1.0)]
    noise: f64,
    /// The picture of a single stack.
    #[arg(short, long, value_name = "FILE", conflicts_with = "folder")]
    output: Option<PathBuf>,
    /// Folder for the pictures, NAME.exr for each stack; the current one without it.
    #[arg(long, value_name = "FOLDER")]
    folder: Option<PathBuf>,
    #[command(flatten)]
    form: Form,
}

pub(super) fn merge(a: &MergeArgs, talk: Talk) -> Result<(), Failure> {
    if !(a.dark > 0.0 && a.dark < a.saturated && a.saturated <= 255.0 && a.noise > 0.0 && a.noise.is_finite()) {
        let message = format!(
            "--dark {}, --saturated {}, --noise {}; expected 0 < dark < saturated ≤ 255 and noise above 0",
            a.dark, a.saturated, a.noise
        );
        return Err(Failure::Message(message));
    }
    let mut photos = Photos::open("capture merge", &a.given, talk)?;
    let stacks = photos.manifest.stack.clone();
    if stacks.is_empty() || (a.output.is_some() && stacks.len() > 1) {
        let message = format!("found {} stacks; expected one with -o, or one or more with --folder", stacks.len());
        return Err(Failure::Message(message));
    }
    let mut respond = given_response(&mut photos, a)?;
    let (mut results, mut text) = (Vec::new(), String::new());
    for stack in &stacks {
        let default = a.folder.as_deref().unwrap_or(Path::new("")).join(format!("{}.exr", stack.name));
        let place = a.output.clone().unwrap_or(default);
        match one(&mut photos, a, stack, &mut respond, &place) {
            Ok(result) => {
                text.push_str(&report::merged_text(&result));
                results.push(result);
            }
            Err(Failure::Message(message)) if stacks.len() > 1 => {
                photos.left_out(&stack.name, &Failure::Message(message));
            }
            Err(failure) => {
                photos.notes.print(&photos.findings);
                return Err(failure);
            }
        }
    }
    let settings = json!({"dark": a.dark, "saturated": a.saturated, "noise": a.noise});
    photos.print(&settings, &results, &text, a.form.json, None)
}

fn given_response(photos: &mut Photos, a: &MergeArgs) -> Result<Option<Respond>, Failure> {
    let file = a.response.as_ref().map(|p| p.display().to_string());
    let file = file.or_else(|| photos.manifest.response.file.clone().map(|f| photos.path(&f)));
    Ok(match file {
        _ if a.linear || photos.manifest.response.linear => Some(Respond::Linear),
        Some(path) => {
            let bytes = photos.bytes(&path)?;
            Some(Respond::Curves(read_table(&path, &bytes)?))
        }
        None => None,
    })
}

fn one(
    photos: &mut Photos,
    a: &MergeArgs,
    stack: &Stack,
    respond: &mut Option<Respond>,
    place: &Path,
) -> Result<Value, Failure> {
    let mut merge: Option<Merge> = None;
    let mut used = Vec::new();
    for exposure in &stack.exposures {
        let opened = photos.exposure(exposure);
        let (photo, time_s) = match opened {
            Ok(opened) => opened,
            Err(failure) => {
                photos.left_out(&exposure.photo, &failure);
                continue;
            }
        };
        let curves = if photo.is_linear() {
            &Respond::Linear
        } else {
            if respond.is_none() {
                *respond = Some(Respond::Curves(find(photos, Method::Monotone, None)?.0));
            }
            respond.as_ref().unwrap_or(&Respond::Linear)
        };
        if let Respond::Curves(curves) = curves
            && curves.len() != photo.channels
        {
            let message = format!(
                "{}: found {}; expected the {} channels of the response",
                exposure.photo,
                photo.size(),
                curves.len()
            );
            return Err(Failure::Message(message));
        }
        let range = Range { dark: a.dark, saturated: a.saturated };
        let sum = merge.get_or_insert_with(|| Merge::new(&photo, range, Noise::constant(photo.channels, a.noise)));
        match sum.add(&exposure.photo, time_s, &photo, curves) {
            Ok(()) => used.push(exposure.photo.clone()),
            Err(error) => photos.left_out(&exposure.photo, &Failure::Message(error.to_string())),
        }
    }
    let Some(mut merge) = merge else {
        let message = format!("found no exposure of {} that can be read; expected one or more", stack.name);
        return Err(Failure::Message(message));
    };
    let counts = merge.counts();
    if counts[0] == 0 {
        let message = format!("found no sample within the range in {}; expected other exposure times", stack.name);
        return Err(Failure::Message(message));
    }
    let without = counts[1..].iter().sum::<usize>();
    if without > 0 {
        let total = counts.iter().sum::<usize>() as f64;
        let message = format!(
            "{:.2} % of the samples have only a bound: {} saturated, {} dark, {} between",
            100.0 * without as f64 / total,
            counts[1],
            counts[2],
            counts[3]
        );
        photos.findings.push(Finding::info("K008", message).at(Location::default().of_item(&stack.name)));
    }
    let read: Vec<String> = photos.inputs.iter().map(|i| i.path.clone()).collect();
    if read.iter().any(|input| same_file(Path::new(input), place)) {
        return Err(Failure::Message(overwrites(place)));
    }
    let mut whole = Whole::open(place, &read)?;
    let out = BufWriter::with_capacity(1 << 18, whole.file());
    let written = exr::write(out, &mut merge, exr::Depth::Float);
    written.map_err(|e| Failure::Message(format!("{}: cannot be written: {e}", place.display())))?;
    whole.finish()?;
    Ok(report::merged(&stack.name, &used, counts, &place.display().to_string()))
}

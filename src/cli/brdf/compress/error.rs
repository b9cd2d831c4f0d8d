//! `brdf compress error`.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::train::SetArgs;
use super::{Form, table_of};
use crate::brdf::compress::{Score, cross_validate};
use crate::cli::brdf::plot::format_of;
use crate::cli::notes::Notes;
use crate::cli::output::{Sink, same_file, write_file};
use crate::cli::{Failure, Talk};
use crate::plot::{CurvesPanel, NamedCurve, draw};
use crate::report::brdf_compress as report;
use crate::report::envelope::Envelope;

/// Largest number of components or directions.
const MOST: u64 = 300;

/// The set, how it is divided, and the form of the answer.
#[derive(Debug, Args)]
#[command(after_help = "Example: photopic brdf compress error *.binary --resolution 90x90x180 --plot error.svg")]
pub(in crate::cli) struct ErrorArgs {
    #[command(flatten)]
    set: SetArgs,
    /// Parts of the set (the 1st, 6th, … material in the first of five), each held out from a basis of the others.
    #[arg(long, value_name = "N", default_value_t = 5)]
    folds: usize,
    /// Numbers of components, and of measured directions.
    #[arg(short = 'n', long, value_name = "N", value_delimiter = ',', default_value = "1,2,5,10,15,20", value_parser = clap::value_parser!(u64).range(1..=MOST))]
    count: Vec<u64>,
    /// Also draw the error over the number: a name ending in .svg or .png.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    form: Form,
}

pub(super) fn error(arguments: &ErrorArgs, talk: Talk) -> Result<(), Failure> {
    let paths = &arguments.set.materials;
    let picture = arguments.plot.as_deref().map(|p| format_of("--plot", p).map(|f| (p, f))).transpose()?;
    if let (Some((p, _)), Some(o)) = (picture, &arguments.form.output)
        && same_file(p, o)
    {
        return Err(Failure::Message(format!("--plot {}: is the output as well; expected another file", p.display())));
    }
    let mut sink = Sink::open(arguments.form.output.as_deref(), paths)?;
    let mut notes = Notes::counting(paths.len(), talk);
    let settings = json!({"folds": arguments.folds, "wavelengths_nm": arguments.set.wavelength.0});
    let mut envelope = Envelope::begin(Vec::new(), "brdf compress error", &settings)?;
    let (collection, _) = arguments.set.collect(&mut notes, &mut envelope)?;
    let counts: Vec<usize> = arguments.count.iter().map(|n| usize::try_from(*n).unwrap_or(usize::MAX)).collect();
    let scores = cross_validate(&collection, arguments.folds, &counts).map_err(|e| Failure::Message(e.to_string()))?;
    if let Some((path, format)) = picture {
        let bytes = draw(&[panel(&scores).into()], None, format).map_err(|e| Failure::Message(e.to_string()))?;
        write_file(path, &bytes, paths)?;
    }
    envelope.result(&report::error(&scores))?;
    let document = envelope.end()?;
    sink.write_all(&match (arguments.form.json, arguments.form.csv) {
        (true, _) => document,
        (_, true) => table_of(report::error_rows(&scores)),
        _ => report::error_text(&scores).into_bytes(),
    })?;
    sink.finish(true)
}

/// The error over the number of components and of directions.
fn panel(scores: &[Score]) -> CurvesPanel {
    let mut order: Vec<&Score> = scores.iter().collect();
    order.sort_by_key(|s| s.count);
    let names = [
        "components, median",
        "components, 90 % below",
        "measured directions, median",
        "measured directions, 90 % below",
    ];
    let points = |i: usize| order.iter().map(|s| (s.count as f64, report::figures(s)[i])).collect();
    let curve =
        |(i, name): (usize, &&str)| NamedCurve { name: (*name).to_owned(), points: points(i), ..NamedCurve::default() };
    CurvesPanel {
        title: "what comes back of materials held out".to_owned(),
        x_label: "number of components, or of measured directions".to_owned(),
        x_step: None,
        y_label: "rms of ln(f w + 0.001)".to_owned(),
        curves: names.iter().enumerate().map(curve).collect(),
        logarithmic: true,
        level: None,
        ..CurvesPanel::default()
    }
}

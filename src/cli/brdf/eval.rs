//! `brdf eval`: values at lists of directions.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::check::Run;
use super::load::MaterialArgs;
use super::numbers::{Numbers, check_theta};
use crate::brdf::audit::Geometry;
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::report::brdf as report;
use crate::report::envelope::Envelope;

/// Most values of one run: more would not fit into memory as text.
const MOST_DIRECTIONS: usize = 4_000_000;

/// Materials, directions and the form of the answer. Angles are lists `0,30,60` or ranges `0:80:10`, in degrees; every
/// combination is evaluated.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic brdf eval 'lambert(reflectance=0.5)' --theta-i 0:60:30 --csv
  photopic brdf eval gold.binary --theta-i 45 --theta-o 0:85:5 --channels R")]
pub(in crate::cli) struct EvalArgs {
    #[command(flatten)]
    materials: MaterialArgs,
    /// Angles of incidence to the normal.
    #[arg(long, value_name = "DEG", default_value = "0:75:15", allow_hyphen_values = true)]
    theta_i: Numbers,
    /// Outgoing angles to the normal.
    #[arg(long, value_name = "DEG", default_value = "0:75:15", allow_hyphen_values = true)]
    theta_o: Numbers,
    /// Azimuths between the two directions: 0 is back towards the light, 180 towards the mirror direction.
    #[arg(long, value_name = "DEG", default_value = "0,180", allow_hyphen_values = true)]
    phi: Numbers,
    /// Azimuths of incidence, from the material's x axis: for anisotropic ones.
    #[arg(long, value_name = "DEG", default_value = "0", allow_hyphen_values = true)]
    phi_i: Numbers,
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One table, a row per direction and band.
    #[arg(long)]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub(super) fn eval(arguments: &EvalArgs, talk: Talk) -> Result<(), Failure> {
    let geometries = geometries(arguments)?;
    let paths = &arguments.materials.materials;
    let mut sink = Sink::open(arguments.output.as_deref(), paths)?;
    let mut run = Run {
        materials: &arguments.materials,
        default_nm: &[555.0],
        envelope: Envelope::begin(Vec::new(), "brdf eval", &json!({}))?,
        notes: Notes::new(paths, talk),
        say: true,
    };
    let mut plain = String::new();
    let mut table = csv::WriterBuilder::new().terminator(csv::Terminator::Any(b'\n')).from_writer(Vec::new());
    let wrong = |e: csv::Error| Failure::Message(e.to_string());
    table.write_record(report::EVAL_COLUMNS).map_err(wrong)?;
    run.each(|path, name, prepared, envelope| {
        if arguments.json {
            let mut object = report::eval(prepared, &geometries);
            object.insert("path".to_owned(), path.into());
            envelope.result(&object.into())?;
        } else if arguments.csv {
            report::eval_rows(path, prepared, &geometries)
                .iter()
                .try_for_each(|r| table.write_record(r))
                .map_err(wrong)?;
        } else {
            plain.push_str(&report::eval_text(name, prepared, &geometries));
        }
        Ok(report::eval_findings(prepared))
    })?;
    let document = run.envelope.end()?;
    let table = table.into_inner().map_err(|e| Failure::Message(e.to_string()))?;
    sink.write_all(match (arguments.json, arguments.csv) {
        (true, _) => &document,
        (_, true) => &table,
        _ => plain.as_bytes(),
    })?;
    sink.finish(true)?;
    if run.notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

/// Every combination of the angles.
fn geometries(a: &EvalArgs) -> Result<Vec<Geometry>, Failure> {
    let count = [&a.theta_i, &a.theta_o, &a.phi, &a.phi_i].iter().map(|n| n.0.len()).product::<usize>();
    if count > MOST_DIRECTIONS {
        let message = format!("{count} directions were asked for; expected at most {MOST_DIRECTIONS}");
        return Err(Failure::Message(message));
    }
    for (option, thetas) in [("theta-i", &a.theta_i), ("theta-o", &a.theta_o)] {
        thetas.0.iter().try_for_each(|theta| check_theta(option, *theta))?;
    }
    let mut out = Vec::with_capacity(count);
    for &phi_i_deg in &a.phi_i.0 {
        for &theta_i_deg in &a.theta_i.0 {
            for &theta_o_deg in &a.theta_o.0 {
                out.extend(a.phi.0.iter().map(|&phi_deg| Geometry { theta_i_deg, phi_i_deg, theta_o_deg, phi_deg }));
            }
        }
    }
    Ok(out)
}

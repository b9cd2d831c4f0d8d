//! `brdf check` and `brdf info`.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::load::{MaterialArgs, Subject, load, prepare};
use super::numbers::{check_half_angle, check_theta};
use crate::brdf::Brdf;
use crate::brdf::audit::{Limits, audit};
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::report::brdf as report;
use crate::report::envelope::Envelope;

/// Wavelengths of an audit where none are given, nm: within the tables of the metals.
pub(in crate::cli) const WAVELENGTHS_NM: [f64; 7] = [400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0];

/// Materials, limits and the form of the answer.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic brdf check 'phong(kd=0.1, ks=1, n=20, form=classic)'
  photopic brdf check gold.binary --reciprocity 0.2 --json")]
pub(in crate::cli) struct CheckArgs {
    #[command(flatten)]
    materials: MaterialArgs,
    /// Largest relative difference of exchanged directions that passes: 1e-6 for models, 0.1 for measured tables.
    #[arg(long, value_name = "X")]
    reciprocity: Option<f64>,
    /// Largest albedo that passes.
    #[arg(long, value_name = "X", default_value_t = Limits::default().albedo)]
    albedo: f64,
    /// Largest fraction of directions with negative values that passes.
    #[arg(long, value_name = "X", default_value_t = Limits::default().negative)]
    negative: f64,
    /// One JSON document.
    #[arg(long)]
    json: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Materials, geometry of the reflectances and the form of the answer.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  photopic brdf info 'ggx(alpha=0.1, medium=Au)' -w 450,550,650
  photopic brdf info blinds.xml paint.bsdf")]
pub(in crate::cli) struct InfoArgs {
    #[command(flatten)]
    materials: MaterialArgs,
    /// Angle of incidence of the reflectances, degrees.
    #[arg(long, value_name = "DEG", default_value_t = 8.0)]
    theta_i: f64,
    /// Outgoing angle of the reflectances, degrees, on the other side of the normal.
    #[arg(long, value_name = "DEG", default_value_t = 8.0)]
    theta_o: f64,
    /// Half of the opening angle of the cones of the reflectances, degrees.
    #[arg(long, value_name = "DEG", default_value_t = 5.0)]
    half_angle: f64,
    /// One JSON document.
    #[arg(long)]
    json: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// A run over the materials: what is done with each of those that could be prepared.
pub(super) struct Run<'a> {
    pub materials: &'a MaterialArgs,
    pub default_nm: &'a [f64],
    pub envelope: Envelope<Vec<u8>>,
    pub notes: Notes,
    /// Findings are said on standard error, and are not part of the text.
    pub say: bool,
}

impl Run<'_> {
    pub(super) fn each(
        &mut self,
        mut f: impl FnMut(&str, &str, &report::Prepared<'_>, &mut Envelope<Vec<u8>>) -> Result<Vec<Finding>, Failure>,
    ) -> Result<(), Failure> {
        let wanted = &self.materials.bands;
        for argument in &self.materials.materials {
            let loaded = load(argument, wanted.format);
            self.envelope.input(loaded.input);
            loaded.spectra.into_iter().for_each(|s| self.envelope.input(s));
            let prepared = (loaded.subject)
                .and_then(|read| prepare(argument, &read.value, wanted, self.default_nm).map(|ready| (read, ready)));
            match prepared {
                Ok((read, ready)) => {
                    let source = match &read.value {
                        Subject::Described(material) => report::Source::Described(material),
                        Subject::Measured(file) => report::Source::Measured(file),
                    };
                    let prepared = report::Prepared { source, bands: &ready.bands, brdf: ready.brdf.as_ref() };
                    self.notes.print(&read.findings);
                    read.findings.into_iter().for_each(|f| self.envelope.finding(f));
                    let place = || Location::default().in_file(argument);
                    let found = f(argument, &loaded.name, &prepared, &mut self.envelope)?;
                    let found: Vec<Finding> = found.into_iter().map(|f| f.at(place())).collect();
                    if self.say {
                        self.notes.print(&found);
                    }
                    found.into_iter().for_each(|f| self.envelope.finding(f));
                }
                Err(message) => {
                    self.notes.refuse(&message);
                    self.envelope.finding(Finding::error("B000", message).at(Location::default().in_file(argument)));
                }
            }
        }
        Ok(())
    }
}

pub(super) fn check(arguments: &CheckArgs, talk: Talk) -> Result<(), Failure> {
    let paths = &arguments.materials.materials;
    let limits = |brdf: &dyn Brdf| {
        let reciprocity = arguments.reciprocity.unwrap_or(Limits::of(brdf).reciprocity);
        Limits { reciprocity, albedo: arguments.albedo, negative: arguments.negative }
    };
    let mut sink = Sink::open(arguments.output.as_deref(), paths)?;
    let settings =
        json!({"reciprocity": arguments.reciprocity, "albedo": arguments.albedo, "negative": arguments.negative});
    let mut run = Run {
        materials: &arguments.materials,
        default_nm: &WAVELENGTHS_NM,
        envelope: Envelope::begin(Vec::new(), "brdf check", &settings)?,
        notes: Notes::new(paths, talk),
        say: false,
    };
    let (mut plain, mut fails) = (String::new(), false);
    run.each(|path, name, prepared, envelope| {
        let limits = limits(prepared.brdf);
        let audit = audit(prepared.brdf, &limits);
        fails |= !audit.passes;
        let findings = report::check_findings(prepared, &audit, &limits);
        plain.push_str(&report::check_text(name, prepared, &audit, &findings));
        let mut object = report::check(prepared, &audit);
        object.insert("path".to_owned(), path.into());
        envelope.result(&object.into())?;
        Ok(findings)
    })?;
    let document = run.envelope.end()?;
    sink.write_all(if arguments.json { &document } else { plain.as_bytes() })?;
    sink.finish(true)?;
    match (run.notes.failed, fails) {
        (true, _) => Err(Failure::Reported),
        (_, true) => Err(Failure::No),
        _ => Ok(()),
    }
}

pub(super) fn info(arguments: &InfoArgs, talk: Talk) -> Result<(), Failure> {
    check_theta("theta-i", arguments.theta_i)?;
    check_theta("theta-o", arguments.theta_o)?;
    check_half_angle("half-angle", arguments.half_angle)?;
    let nine = report::Nine {
        theta_i_deg: arguments.theta_i,
        theta_o_deg: arguments.theta_o,
        half_angle_deg: arguments.half_angle,
    };
    let paths = &arguments.materials.materials;
    let mut sink = Sink::open(arguments.output.as_deref(), paths)?;
    let settings = json!({"theta_i_deg": nine.theta_i_deg, "theta_o_deg": nine.theta_o_deg, "half_angle_deg": nine.half_angle_deg});
    let mut run = Run {
        materials: &arguments.materials,
        default_nm: &[555.0],
        envelope: Envelope::begin(Vec::new(), "brdf info", &settings)?,
        notes: Notes::new(paths, talk),
        say: true,
    };
    let mut plain = String::new();
    run.each(|path, name, prepared, envelope| {
        let audit = audit(prepared.brdf, &Limits::of(prepared.brdf));
        let mut object = report::info(prepared, &audit, &nine);
        plain.push_str(&report::info_text(name, prepared, &object));
        object.insert("path".to_owned(), path.into());
        envelope.result(&object.into())?;
        Ok(Vec::new())
    })?;
    let document = run.envelope.end()?;
    sink.write_all(if arguments.json { &document } else { plain.as_bytes() })?;
    sink.finish(!plain.is_empty() || arguments.json)?;
    if run.notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

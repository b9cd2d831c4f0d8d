//! `brdf compress train`.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::input::{Loaded, load};
use super::table_of;
use crate::brdf::compress::Collection;
use crate::brdf::compress::file::{BasisFile, Source};
use crate::cli::brdf::numbers::{Bins, Numbers};
use crate::cli::notes::Notes;
use crate::cli::output::{Sink, Whole, overwrites, same_file};
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::report::brdf_compress as report;
use crate::report::envelope::{Envelope, Input};

/// Most components of a basis.
const MOST_COMPONENTS: u64 = 300;

/// Materials and the bins on which they are taken.
#[derive(Debug, Args)]
pub(super) struct SetArgs {
    /// Materials: MERL binaries or other isotropic tables, descriptions such as 'ggx(alpha=0.1, medium=Au)', TOML files, or `-`.
    /// Each channel is a column of the set.
    #[arg(required = true, value_name = "MATERIAL")]
    pub materials: Vec<String>,
    /// Bins in θh, θd and φd.
    #[arg(long, value_name = "HxDxP", default_value = "90x90x180")]
    pub resolution: Bins,
    /// Wavelengths, nm, of materials that are given by wavelength: a column each.
    #[arg(short, long, value_name = "NM", default_value = "650,550,450")]
    pub wavelength: Numbers,
}

impl SetArgs {
    /// Reads the materials one after another; each is dropped before the next. A material that fails is reported.
    pub(super) fn collect(
        &self,
        notes: &mut Notes,
        envelope: &mut Envelope<Vec<u8>>,
    ) -> Result<(Collection, Vec<Input>), Failure> {
        let mut collection = Collection::new(self.resolution.0);
        let mut all_inputs = Vec::new();
        for argument in &self.materials {
            let Loaded { inputs, table } = load(argument, self.resolution.0, &self.wavelength.0);
            let added = table.and_then(|(table, findings)| {
                collection.add(&table).map_err(|e| format!("{argument}: {e}"))?;
                notes.print(&findings);
                findings.into_iter().for_each(|f| envelope.finding(f));
                Ok(())
            });
            if let Err(message) = added {
                notes.refuse(&message);
                envelope.finding(Finding::error("B000", message).at(Location::default().in_file(argument)));
            }
            inputs.iter().for_each(|input| envelope.input(input.clone()));
            all_inputs.extend(inputs);
            notes.progress.inc(1);
        }
        // A set that lacks a material is another set.
        if notes.failed { Err(Failure::Reported) } else { Ok((collection, all_inputs)) }
    }
}

/// The set, and what is made of it.
#[derive(Debug, Args)]
#[command(after_help = "Example: photopic brdf compress train *.binary -o merl.basis")]
pub(in crate::cli) struct TrainArgs {
    #[command(flatten)]
    set: SetArgs,
    /// The basis.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Components; fewer where the set has no more.
    #[arg(short = 'k', long, value_name = "K", default_value_t = 60, value_parser = clap::value_parser!(u64).range(1..=MOST_COMPONENTS))]
    components: u64,
    /// Weigh odd materials down: the best basis of exactly K components for coefficients, but not for fewer, nor for measured directions.
    #[arg(long)]
    weighted: bool,
    /// The report as one JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// The report as one table, a row per component.
    #[arg(long)]
    csv: bool,
}

pub(super) fn train(arguments: &TrainArgs, talk: Talk) -> Result<(), Failure> {
    let paths = &arguments.set.materials;
    if let Some(path) = paths.iter().find(|p| same_file(Path::new(p), &arguments.output)) {
        return Err(Failure::Message(overwrites(Path::new(path))));
    }
    let mut notes = Notes::counting(paths.len(), talk);
    let settings = json!({
        "components": arguments.components,
        "weighted": arguments.weighted,
        "wavelengths_nm": arguments.set.wavelength.0,
    });
    let mut envelope = Envelope::begin(Vec::new(), "brdf compress train", &settings)?;
    let (collection, inputs) = arguments.set.collect(&mut notes, &mut envelope)?;
    let (grid, training) = collection.train().map_err(|e| Failure::Message(e.to_string()))?;
    let components = usize::try_from(arguments.components).unwrap_or(usize::MAX);
    let basis = if arguments.weighted { training.basis(components) } else { training.covariance(components) };
    if basis.components() < components {
        let message = format!("the {} columns have {} components", training.columns(), basis.components());
        let finding =
            Finding::warning("B301", message).at(Location::default().in_file(&arguments.output.to_string_lossy()));
        notes.print(std::slice::from_ref(&finding));
        envelope.finding(finding);
    }
    let source = |input: Input| Source { name: input.path, sha256: input.sha256 };
    let file = BasisFile {
        grid,
        basis,
        weighted: arguments.weighted,
        columns: u32::try_from(training.columns()).unwrap_or(u32::MAX),
        variance: training.variance(),
        sources: inputs.into_iter().map(source).collect(),
    };
    drop(training);
    let mut whole = Whole::open(&arguments.output, paths)?;
    let checksum = file.write(&mut std::io::BufWriter::new(whole.file()))?;
    whole.finish()?;
    let path = arguments.output.to_string_lossy();
    envelope.result(&report::train(&file, &checksum))?;
    let document = envelope.end()?;
    let mut sink = Sink::open(None, paths)?;
    sink.write_all(&match (arguments.json, arguments.csv) {
        (true, _) => document,
        (_, true) => table_of(report::train_rows(&file)),
        _ => report::train_text(&path, &file, &checksum).into_bytes(),
    })?;
    sink.finish(true)
}

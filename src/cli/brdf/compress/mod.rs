//! `brdf compress`: a basis trained on a set of tables, coefficients and tables, directions to measure, tables from what was
//! measured there, and what all that loses.

mod coefficients;
mod error;
mod input;
mod samples;
mod train;

use std::fs::File;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};

use crate::brdf::compress::file::{BasisFile, Checksum};
use crate::brdf::table::{HalfAngle, Known};
use crate::cli::output::{overwrites, same_file, write_files};
use crate::cli::{Failure, Talk};

/// Verbs of `brdf compress`.
#[derive(Debug, Subcommand)]
pub(in crate::cli) enum CompressCommand {
    /// A basis from a set of materials.
    Train(train::TrainArgs),
    /// The coefficients of a material.
    Encode(coefficients::EncodeArgs),
    /// A table from coefficients.
    Decode(coefficients::DecodeArgs),
    /// The directions to measure, the most telling first.
    Directions(samples::DirectionsArgs),
    /// A table from values measured in a few directions.
    Infer(samples::InferArgs),
    /// What components and measured directions lose, by their number, on materials held out in turn.
    Error(error::ErrorArgs),
}

pub(super) fn run(command: CompressCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        CompressCommand::Train(a) => train::train(&a, talk),
        CompressCommand::Encode(a) => coefficients::encode(&a, talk),
        CompressCommand::Decode(a) => coefficients::decode(&a, talk),
        CompressCommand::Directions(a) => samples::directions(&a, talk),
        CompressCommand::Infer(a) => samples::infer(&a, talk),
        CompressCommand::Error(a) => error::error(&a, talk),
    }
}

/// The form of an answer.
#[derive(Debug, Args)]
struct Form {
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One table.
    #[arg(long)]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Where a reconstructed table goes.
#[derive(Debug, Args)]
struct Reconstructed {
    /// The table, a MERL binary; bins that the basis does not have are −1 in it.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// How each bin is known: the three numbers of bins as in a MERL binary, then a byte per bin in its order, 0 missing, 1
    /// inferred, 2 measured.
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// The report as one JSON document.
    #[arg(long)]
    json: bool,
}

/// Bytes of a mask.
fn mask_code(known: Known) -> u8 {
    match known {
        Known::Missing => 0,
        Known::Inferred => 1,
        Known::Measured => 2,
    }
}

impl Reconstructed {
    /// Writes table and mask, `known` having an entry per bin of the table.
    fn write(&self, table: &HalfAngle, known: &[Known], inputs: &[String]) -> Result<(), Failure> {
        let outputs = [Some(&self.output), self.mask.as_ref()].into_iter().flatten();
        let clash = |o: &&PathBuf| inputs.iter().any(|i| same_file(o, Path::new(i)));
        if let Some(output) = outputs.clone().find(clash) {
            return Err(Failure::Message(overwrites(output)));
        }
        if self.mask.as_ref().is_some_and(|m| same_file(m, &self.output)) {
            let message = format!("--mask {}: is the output as well; expected another file", self.output.display());
            return Err(Failure::Message(message));
        }
        let Some(bytes) = crate::brdf::format::merl::write(table) else {
            let message =
                format!("{} channels; expected three: a MERL binary holds red, green and blue", table.channels().len());
            return Err(Failure::Message(message));
        };
        let header = &bytes[..12];
        let mask: Vec<u8> = header.iter().copied().chain(known.iter().map(|k| mask_code(*k))).collect();
        let mut files = vec![(self.output.clone(), &bytes[..])];
        files.extend(self.mask.clone().map(|path| (path, &mask[..])));
        write_files(&files)
    }
}

/// Reads a basis; messages name the file.
pub(in crate::cli) fn open_basis(path: &str) -> Result<(BasisFile, Checksum), Failure> {
    let wrong = |e: &dyn std::fmt::Display| Failure::Message(format!("{path}: {e}"));
    let read = if path == "-" {
        BasisFile::read(&mut io::stdin().lock())
    } else {
        let file = File::open(path).map_err(|e| wrong(&format!("cannot be read: {e}; expected a basis")))?;
        BasisFile::read(&mut BufReader::with_capacity(1 << 18, file))
    };
    read.map_err(|e| wrong(&e))
}

/// Rows of cells as CSV.
fn table_of(rows: impl IntoIterator<Item = Vec<String>>) -> Vec<u8> {
    rows.into_iter().flat_map(|row| crate::cli::writer::csv_row(&row)).collect()
}

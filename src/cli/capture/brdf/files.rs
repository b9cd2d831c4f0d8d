//! The files of `capture brdf -o`.

use std::path::Path;

use super::message;
use crate::brdf::format::alta::{self, Encoding};
use crate::brdf::format::convert::nodes;
use crate::brdf::format::{csv, merl};
use crate::brdf::table::Table;
use crate::capture::brdf::{Binned, Observations};
use crate::cli::Failure;

/// What a file is, by its ending.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Target {
    Merl,
    Csv,
    Alta,
    Material,
}

impl Target {
    pub(super) fn of(path: &Path) -> Result<Self, Failure> {
        match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
            Some("binary") => Ok(Self::Merl),
            Some("csv") => Ok(Self::Csv),
            Some("alta") => Ok(Self::Alta),
            Some("toml") => Ok(Self::Material),
            _ => Err(Failure::Message(format!(
                "{}: expected a name ending in .binary, .csv, .alta or .toml",
                path.display()
            ))),
        }
    }
}

/// The bins as a file.
pub(super) fn encode(target: Target, all: &Observations, binned: &Binned, path: &Path) -> Result<Vec<u8>, Failure> {
    let table = binned.table(all).map_err(message)?;
    if target == Target::Merl {
        return merl::write(&table).ok_or_else(|| {
            let bands = all.channels.len();
            Failure::Message(format!(
                "{}: a MERL file has three channels; found {bands}; expected .csv or .alta",
                path.display()
            ))
        });
    }
    let points = nodes(&Table::HalfAngle(table)).map_err(message)?.value;
    Ok(match target {
        Target::Alta => alta::write(&points, Encoding::Text).value,
        _ => csv::write(&points).value.into_bytes(),
    })
}

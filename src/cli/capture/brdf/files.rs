//! The files of `capture brdf -o`.

use std::path::{Path, PathBuf};

use super::message;
use crate::brdf::format::alta::{self, Encoding};
use crate::brdf::format::convert::nodes;
use crate::brdf::format::{csv, merl};
use crate::brdf::table::{Channel, HalfAngle, Known, Table};
use crate::capture::brdf::Filled;
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

/// The file of a table, and that of the marks beside it where bins were filled and the format has no place for marks.
pub(super) fn encode(
    target: Target,
    table: &HalfAngle,
    filled: Option<&Filled>,
    path: &Path,
) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let table = filled.map_or(table, |f| &f.table);
    if target == Target::Merl {
        let bytes = merl::write(table).filter(|_| table.channels() == Channel::rgb()).ok_or_else(|| {
            let names = table.channels().iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
            Failure::Message(format!(
                "{}: a MERL file has red, green and blue; found {names}; expected .csv or .alta",
                path.display()
            ))
        })?;
        let beside = |f: &Filled| {
            let mut name = path.as_os_str().to_owned();
            name.push(".mask");
            (PathBuf::from(name), merl::mask(&f.table, &f.known))
        };
        return Ok([(path.to_owned(), bytes)].into_iter().chain(filled.map(beside)).collect());
    }
    let points = nodes(&Table::HalfAngle(table.clone())).map_err(message)?.value;
    let bytes = match (target, filled) {
        (Target::Alta, None) => alta::write(&points, Encoding::Text).value,
        (Target::Alta, Some(_)) => {
            let words = "an ALTA file has no place for what is inferred; expected .binary or .csv with --fill";
            return Err(Failure::Message(format!("{}: {words}", path.display())));
        }
        (_, None) => csv::write(&points).value.into_bytes(),
        (_, Some(f)) => {
            let known: Vec<Known> = points.iter().map(|(i, o, _)| f.known[table.bin_of(i, o)]).collect();
            csv::write_known(&points, &known).value.into_bytes()
        }
    };
    Ok(vec![(path.to_owned(), bytes)])
}

//! `--uncertainty`: the budget and the tables beside it.

use std::fs;
use std::path::Path;

use crate::cli::Failure;
use crate::uncertainty::budget::{Budget, Error};

/// Reads a budget; the tables that it names are relative to it.
pub(in crate::cli) fn read(path: &Path) -> Result<Budget, Failure> {
    let open = |path: &Path| fs::read_to_string(path).map_err(|e| format!("cannot be read: {e}"));
    let text = open(path).map_err(|why| Failure::Message(format!("{}: {why}; expected a budget", path.display())))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    Budget::parse(&text, |table| open(&folder.join(table))).map_err(|error| {
        Failure::Message(match error {
            Error::Budget(mistake) => format!("{}:{mistake}", path.display()),
            error => format!("{}: {error}", path.display()),
        })
    })
}

//! `--uncertainty`: the budget and the tables beside it.

use std::fs;
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::cli::Failure;
use crate::report::envelope::Input;
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

/// A budget or an illuminant as an input of a report.
pub(super) fn input(path: &Path) -> Result<Input, Failure> {
    let bytes = fs::read(path).map_err(|e| Failure::Message(format!("{}: cannot be read: {e}", path.display())))?;
    let sha256 = Sha256::digest(&bytes).iter().map(|b| format!("{b:02x}")).collect();
    Ok(Input { path: path.display().to_string(), sha256: Some(sha256) })
}

//! How much of the photographs is used, and `--settings`: a file that says so, as `trade capture --settings` writes it.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Deserialize;

use crate::cli::Failure;
use crate::mistake::{self, Mistake};

/// How much is used.
#[derive(Debug, Args)]
pub(super) struct UseArgs {
    /// Use every N-th pixel of every N-th row (1 without it).
    #[arg(long, value_name = "N")]
    every: Option<usize>,
    /// Use so many of the lights, evenly drawn in their order.
    #[arg(long, value_name = "N")]
    lights: Option<usize>,
    /// Use so many of the exposures of each stack, evenly drawn by their times.
    #[arg(long, value_name = "N")]
    exposures: Option<usize>,
    /// A file with these three, as `trade capture --settings` writes it; options given here go before it.
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    every: Option<usize>,
    lights: Option<usize>,
    exposures: Option<usize>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    capture: Section,
}

/// What the command line and the file say together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Used {
    pub every: usize,
    /// All, where it is not said.
    pub lights: Option<usize>,
    /// All, where it is not said.
    pub exposures: Option<usize>,
}

impl UseArgs {
    /// The file, which must not be overwritten.
    pub(super) fn file(&self) -> Option<String> {
        self.settings.as_ref().map(|p| p.display().to_string())
    }

    pub(super) fn read(&self) -> Result<Used, Failure> {
        let section = self.settings.as_deref().map(read).transpose()?.unwrap_or_default();
        let used = Used {
            every: self.every.or(section.every).unwrap_or(1),
            lights: self.lights.or(section.lights),
            exposures: self.exposures.or(section.exposures),
        };
        if used.every == 0 || [used.lights, used.exposures].contains(&Some(0)) {
            let words = "found 0 for --every, --lights or --exposures; expected 1 or more";
            return Err(Failure::Message(words.to_owned()));
        }
        Ok(used)
    }
}

fn read(path: &Path) -> Result<Section, Failure> {
    let place = path.display();
    let text = fs::read_to_string(path)
        .map_err(|e| Failure::Message(format!("{place}: cannot be read: {e}; expected settings (TOML)")))?;
    let file: File = mistake::parse(&text).map_err(|m: Mistake| Failure::Message(format!("{place}:{m}")))?;
    Ok(file.capture)
}

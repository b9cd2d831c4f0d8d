//! `--settings`: a file with what of an image is kept, as `trade image --settings` writes it.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde::Deserialize;

use crate::cli::Failure;
use crate::image::Source;
use crate::image::reduced::{Bands, Reduced};
use crate::mistake::{self, Mistake};

/// What is kept of an image.
#[derive(Debug, Args)]
#[command(next_help_heading = "Fewer bands and pixels (before all else)")]
pub(super) struct ReductionArgs {
    /// Make so many bands of those that there are.
    #[arg(long, value_name = "N")]
    bands: Option<usize>,
    /// How.
    #[arg(long, value_enum, value_name = "HOW", requires = "bands")]
    filter: Option<FilterArg>,
    /// Means over blocks of N × N pixels.
    #[arg(long, value_name = "N")]
    block: Option<usize>,
    /// A file with these settings, as `trade image --settings` writes it; options given here go before it.
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum, Deserialize)]
#[serde(rename_all = "lowercase")]
enum FilterArg {
    /// The values at wavelengths in equal steps, straight between the bands (without a choice).
    Sampled,
    /// The means over equal parts of the range.
    Averaged,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    bands: Option<usize>,
    filter: Option<FilterArg>,
    block: Option<usize>,
    half: Option<bool>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    image: Section,
}

/// What the command line and the file say together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reduction {
    bands: Option<(usize, Bands)>,
    block: usize,
    /// Half precision, by the file.
    pub half: bool,
}

impl ReductionArgs {
    /// The file, which must not be overwritten.
    pub(super) fn file(&self) -> Option<String> {
        self.settings.as_ref().map(|p| p.display().to_string())
    }

    pub(super) fn read(&self) -> Result<Reduction, Failure> {
        let section = self.settings.as_deref().map(read).transpose()?.unwrap_or_default();
        let filter = match self.filter.or(section.filter) {
            None | Some(FilterArg::Sampled) => Bands::Sampled,
            Some(FilterArg::Averaged) => Bands::Averaged,
        };
        Ok(Reduction {
            bands: self.bands.or(section.bands).map(|n| (n, filter)),
            block: self.block.or(section.block).unwrap_or(1),
            half: section.half.unwrap_or(false),
        })
    }
}

impl Reduction {
    /// The image with what is kept of it.
    pub(super) fn of(self, source: Box<dyn Source>, path: &str) -> Result<Box<dyn Source>, Failure> {
        if self.bands.is_none() && self.block == 1 {
            return Ok(source);
        }
        let reduced = Reduced::new(source, self.bands, self.block);
        Ok(Box::new(reduced.map_err(|e| Failure::Message(format!("{path}: {e}")))?))
    }
}

fn read(path: &Path) -> Result<Section, Failure> {
    let place = path.display();
    let text = fs::read_to_string(path)
        .map_err(|e| Failure::Message(format!("{place}: cannot be read: {e}; expected settings (TOML)")))?;
    let file: File = mistake::parse(&text).map_err(|m: Mistake| Failure::Message(format!("{place}:{m}")))?;
    Ok(file.image)
}

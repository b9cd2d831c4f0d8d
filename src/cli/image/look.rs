//! A quick look at an image in the terminal.

use std::io::{self, IsTerminal};

use clap::ValueEnum;

use crate::cli::Failure;
use crate::image::{Photometric, Picture, Source};
use crate::plot::luminance::FalseColour;
use crate::plot::terminal::{characters, half_blocks};
use crate::units::significant;

/// When an image is drawn in the terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum When {
    /// Where the output is a terminal.
    Auto,
    /// In files and pipes, too.
    Always,
}

impl When {
    /// Whether to draw, now that the output goes to `output`.
    pub(super) fn now(self, output: Option<&std::path::Path>) -> bool {
        let terminal = output.is_none_or(|p| p == std::path::Path::new("-")) && io::stdout().is_terminal();
        self == Self::Always || terminal
    }
}

/// Columns where the terminal does not say.
const COLUMNS: usize = 80;

fn columns() -> usize {
    let stated = std::env::var("COLUMNS").ok().and_then(|c| c.parse().ok());
    let found = terminal_size::terminal_size().map(|(width, _)| usize::from(width.0));
    found.or(stated).filter(|c| *c > 0).unwrap_or(COLUMNS)
}

/// Whether colours are unwanted (<https://no-color.org>).
fn plain() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty())
}

/// An image in false colours, in as many columns as the terminal has, with the scale beneath.
pub(super) fn look(source: &mut dyn Source, way: &Photometric, colours: &FalseColour) -> Result<String, Failure> {
    let picture =
        Picture::of(&mut *way.of(source), 0, columns(), usize::MAX).map_err(|e| Failure::Message(e.to_string()))?;
    let range = colours.range(&picture).map_err(|e| Failure::Message(e.to_string()))?;
    let value = |x: usize, y: usize| f64::from(picture.values[y * picture.width + x]);
    let (width, height) = (picture.width, picture.height);
    let low = significant(range.low, 3);
    let high = format!("{} {}", significant(range.high, 3), way.unit());
    let scale = if range.logarithmic { "logarithmic" } else { "linear" };
    let steps = 24;
    let share = |x: usize| (x as f64 + 0.5) / f64::from(steps);
    let (drawn, bar) = if plain() {
        let drawn = characters(width, height, |x, y| range.share(value(x, y)));
        (drawn, characters(24, 1, |x, _| share(x)))
    } else {
        let drawn = half_blocks(width, height, |x, y| range.colour(colours.map, value(x, y)));
        (drawn, half_blocks(24, 2, |x, _| colours.map.at(share(x))))
    };
    Ok(format!("{drawn}{low} {} {}, {scale}\n", bar.trim_end_matches('\n'), high.trim_end()))
}

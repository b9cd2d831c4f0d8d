//! Luminaires turned, converted between the photometric types, resampled, scaled, made symmetric and merged: one file per
//! subject.
//!
//! Each takes a luminaire and gives another with findings (L401–L408): what was resampled, on which grid and at what price, and
//! which facts of the luminaire no longer hold. What is exact for the bilinear intensity is done exactly: turning a Type C
//! table about its axis, averaging symmetric images, adding tables up. Everything else is sampled at the directions of a grid,
//! and the change of flux and peak is stated.

mod facts;
mod grid;
mod merge;
mod planes;
mod scale;
mod sum;
mod symmetrise;
mod thin;
mod turn;

pub use grid::{Axis, Grid, Resampling};
pub use merge::{Part, merge};
pub use scale::{Scale, scale};
pub(in crate::luminaire) use sum::sum;
pub use symmetrise::symmetrise;
pub use thin::{fewer_angles, thinned};
pub use turn::{Turn, turn};

use super::{Distribution, Kind};
use crate::finding::{Finding, Severity};
use crate::units::significant;

/// Why a luminaire could not be transformed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A table that the model refuses.
    #[error(transparent)]
    Table(#[from] super::Error),
    /// Light where Types A and B have no angles.
    #[error(
        "{:.2} % of the flux falls behind the luminaire, where Types A and B have no angles; expected light in the half space \
         before it: tilt it, or stay with Type C",
        share * 100.0
    )]
    Behind {
        /// Share of the flux, 0 to 1.
        share: f64,
    },
    /// A number that is none, or out of its range.
    #[error("{what}: {found}; expected {expected}")]
    Argument {
        /// What the number is.
        what: &'static str,
        /// The number.
        found: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A grid of more directions than are worth having.
    #[error("a table of {found} directions; expected at most {most}")]
    TooLarge {
        /// Directions asked for.
        found: usize,
        /// Directions allowed.
        most: usize,
    },
    /// A luminaire without light cannot be scaled to a flux.
    #[error("no flux to scale; expected a luminaire that gives light")]
    Dark,
    /// Absolute photometry has no lamps to rate.
    #[error(
        "the luminaire's lamps have no rated flux (absolute photometry); expected one, or scale to a flux of the luminaire"
    )]
    NoLampFlux,
    /// A symmetry that the angles of Types A and B do not have.
    #[error(
        "a Type A or B table can be mirrored about H 0° only; expected `quadrant`, or a conversion to Type C before"
    )]
    NotTypeC,
    /// Candela and W/sr do not add up.
    #[error("{first:?} and {other:?} intensities; expected luminaires of one kind")]
    Kinds {
        /// Of the first luminaire.
        first: Kind,
        /// Of another.
        other: Kind,
    },
    /// Nothing to merge.
    #[error("no luminaire; expected one or more")]
    Nothing,
}

/// More values than this in a table are refused: tables without common angles multiply.
const MOST_VALUES: usize = 10_000_000;

/// A change of flux or peak by more than this is a warning: a hundredth of a per cent.
pub const TOLERANCE: f64 = 1e-4;

/// What happened to the two figures that a conversion has to keep, relative to what they were.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Of the integrated flux.
    pub flux: f64,
    /// Of the largest intensity.
    pub peak: f64,
}

impl Change {
    /// From one table to another; 0 where there was nothing.
    #[must_use]
    pub fn between(before: &Distribution, after: &Distribution) -> Self {
        let relative = |a: f64, b: f64| if a == 0.0 { 0.0 } else { b / a - 1.0 };
        Self {
            flux: relative(before.total_flux(), after.total_flux()),
            peak: relative(before.peak().0, after.peak().0),
        }
    }

    fn finding(self, code: &'static str, what: &str) -> Finding {
        let severity =
            if self.flux.abs().max(self.peak.abs()) > TOLERANCE { Severity::Warning } else { Severity::Info };
        let message = format!("{what}: flux {}, peak {}", percent(self.flux), percent(self.peak));
        Finding::new(code, severity, message)
    }
}

/// A relative change in per cent with its sign; what is only rounding is none.
fn percent(change: f64) -> String {
    if change.abs() < 1e-9 {
        return "unchanged".to_owned();
    }
    let sign = if change > 0.0 { "+" } else { "−" };
    format!("{sign}{} %", significant(100.0 * change.abs(), 2))
}

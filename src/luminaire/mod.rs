//! Luminaires: an intensity distribution with the facts that belong to it.

mod angular;
pub mod beam;
pub mod bug;
pub mod colour;
pub mod compare;
pub mod cone;
pub mod cu;
mod cubic;
pub mod cut;
pub mod distribution;
pub mod export;
mod flux;
pub mod format;
pub mod grid;
pub mod keyword;
pub mod lcs;
pub mod luminance;
mod model;
pub mod nema;
pub mod placement;
mod room;
pub mod shape;
pub mod spacing;
pub mod spectral;
pub mod transform;
pub mod ugr;
mod unavailable;
pub mod zonal;

pub use angular::AngularSpectra;
pub use distribution::{Distribution, Interpolation, Symmetry, System};
pub use model::{Body, Kind, LampSet, Luminaire, Shape};
pub use unavailable::Unavailable;

/// Why a table of intensities was refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Angles that are not in order, or not in the range that the system and the symmetry ask for.
    #[error("{which} angles {} to {}; expected {expected}", found.0, found.1)]
    Angles {
        /// `horizontal` or `vertical`.
        which: &'static str,
        /// The two angles, degrees.
        found: (f64, f64),
        /// What was expected.
        expected: &'static str,
    },
    /// As many values as angle pairs are needed.
    #[error("{found} intensities; expected {expected}, one per pair of angles and at least one")]
    Count {
        /// Values given.
        found: usize,
        /// Values needed.
        expected: usize,
    },
    /// NaN or infinite.
    #[error("an intensity of {found}; expected a finite number")]
    Value {
        /// The value.
        found: f64,
    },
}

//! Lamps for other programs: a table for data analysis, and light sources for renderers.
//!
//! | target | files | what it holds | read back as |
//! |---|---|---|---|
//! | [`csv`] | `.csv` | the table, symmetric planes written out | linear in both angles |
//! | [`radiance`] | `.rad`, `.dat` | the opening's surfaces and a `brightdata` table | linear in both angles |
//! | [`pbrt`] | `.pbrt`, `.exr` | a `goniometric` light with its equal-area octahedral picture | nearest pixel |
//! | [`mitsuba`] | `.xml`, up to six `.exr` | six `projector`s about one point | bilinear on the faces of a cube |
//! | [`equirectangular`] | `.exr` | one picture over C and γ | as the reader likes |
//!
//! Bytes out; nothing is opened. All go by the luminaire's frame: −z is the photometric axis, +x is C0, +y is C90
//! ([`System`](super::System)); every file says so. Conventions, units and what is lost: `docs/lamp-exports.md`.
//!
//! # Findings
//!
//! | code | severity | meaning |
//! |---|---|---|
//! | L501 | info, warning | facts that the target cannot carry (a warning for the spectrum) |
//! | L502 | warning | negative intensities, which a light source cannot have, were written as 0 |
//! | L503 | info | the intensities are radiant or of photons: what the target's results then mean |
//! | L504 | info, warning | the light was sampled: the flux of what was written beside that of the lamp (a warning from 0.1 %) |
//! | L505 | info | the luminous opening was replaced by another surface or by a point |
//! | L506 | info | a table of Type A or B was sampled at the angles of Type C |

pub mod csv;
pub mod equirectangular;
pub mod mitsuba;
mod notes;
pub mod pbrt;
mod picture;
pub mod radiance;
mod table;

use std::ops::RangeInclusive;

use crate::finding::Checked;

/// Pixels on a side that a picture may have.
pub const PIXELS: RangeInclusive<usize> = 8..=8192;

/// One file of an export.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExportFile {
    /// What follows the common stem of the files' names, such as `.rad`.
    pub suffix: String,
    /// The file.
    pub bytes: Vec<u8>,
}

/// The files of an export, the one to be named by the user first, and what they do not carry.
pub type Exported = Result<Checked<Vec<ExportFile>>, Error>;

/// Why a lamp could not be exported.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A name that scene files cannot hold.
    #[error(
        "found the file name `{found}`; expected one without quotation marks, backslashes, control characters, `!` at its start and, for Mitsuba, `$`"
    )]
    Name {
        /// The name without its ending.
        found: String,
    },
    /// Too few or too many pixels.
    #[error("found {found} pixels on a side; expected {} to {}", PIXELS.start(), PIXELS.end())]
    Pixels {
        /// Pixels asked for.
        found: usize,
    },
    /// The picture could not be encoded.
    #[error("the picture could not be encoded: {message}")]
    Picture {
        /// The encoder's words.
        message: String,
    },
}

//! Why a file could not be read, and where in it.

use std::borrow::Cow;
use std::io;

use super::super::UnitError;
use crate::finding::{Located, Location};

fn shown(cell: &str) -> Cow<'static, str> {
    if cell.is_empty() { "an empty cell".into() } else { format!("`{cell}`").into() }
}

fn spectrum(name: &str) -> Cow<'static, str> {
    if name.is_empty() { "a spectrum".into() } else { format!("`{name}`").into() }
}

fn cells(count: usize) -> String {
    format!("{count} {}", if count == 1 { "cell" } else { "cells" })
}

/// What is wrong with an input; the text says what was found and what was expected.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Nothing but blank lines and comments.
    #[error("found an empty input; expected a spectrum")]
    Empty,
    /// The operating system could not read on.
    #[error("could not read: {message}")]
    Io {
        /// Kind of the failure.
        kind: io::ErrorKind,
        /// What the system says.
        message: String,
    },
    /// More than this reader holds in memory.
    #[error("found {what} of more than {limit} bytes; expected at most that")]
    TooLarge {
        /// What is too large.
        what: &'static str,
        /// The limit, bytes.
        limit: u64,
    },
    /// Not a text file.
    #[error("found {found}; expected text")]
    NotText {
        /// What it seems to be.
        found: &'static str,
    },
    /// A word that names no format.
    #[error("found the format name `{found}`; expected csv, tm27, cgats, jcamp, oceanview, uprtek or sekonic")]
    UnknownFormat {
        /// The word.
        found: String,
    },
    /// A part of the format is not there, or something else stands in its place.
    #[error("found {found}; expected {expected}")]
    Unexpected {
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
    /// A cell is not a number.
    #[error("found {}; expected a number for the {what}", shown(found))]
    NotANumber {
        /// The cell.
        found: String,
        /// What the cell is of: `wavelength`, `value` …
        what: &'static str,
    },
    /// NaN or infinity.
    #[error("found {}; expected a finite number for the {what}", shown(found))]
    NotFinite {
        /// The cell.
        found: String,
        /// What the cell is of.
        what: &'static str,
    },
    /// An empty cell (or `NA`, `-`) between two values of one spectrum.
    #[error("found {} between values of {}; expected a number", shown(found), spectrum(name))]
    MissingValue {
        /// The cell.
        found: String,
        /// The spectrum.
        name: String,
    },
    /// Too few cells in a row.
    #[error("found {}; expected {expected}", cells(*found))]
    MissingColumn {
        /// Cells met.
        found: usize,
        /// Cells expected.
        expected: usize,
    },
    /// Too many cells in a row.
    #[error("found {}; expected {expected}", cells(*found))]
    TooManyColumns {
        /// Cells met.
        found: usize,
        /// Cells expected.
        expected: usize,
    },
    /// One wavelength twice.
    #[error("found {wavelength} again (first on line {first_line}); expected each wavelength once")]
    DuplicateWavelength {
        /// The wavelength, in the file's unit.
        wavelength: f64,
        /// Where it stands first.
        first_line: u64,
    },
    /// Wavelengths neither ascend nor descend.
    #[error("found wavelength {found} after {previous}; expected wavelengths that only ascend or only descend")]
    Unsorted {
        /// The wavelength, in the file's unit.
        found: f64,
        /// The one before it.
        previous: f64,
    },
    /// A wavelength of zero or less.
    #[error("found wavelength {found}; expected a positive number")]
    NotPositive {
        /// The wavelength, in the file's unit.
        found: f64,
    },
    /// Wavelengths far outside of optics.
    #[error("found wavelengths {first} to {last} nm; expected some between 10 and 100000 nm")]
    ImplausibleWavelengths {
        /// The shortest, nm.
        first: f64,
        /// The longest, nm.
        last: f64,
    },
    /// A unit that the format or the file states is not understood.
    #[error("found the unit `{found}`; expected {expected}")]
    UnknownUnit {
        /// The unit as written.
        found: String,
        /// What is understood there.
        expected: &'static str,
    },
    /// The unit and the quantity do not belong together.
    #[error("found {unit} (a unit of {of}); expected a unit of {asked}")]
    UnitMismatch {
        /// The unit.
        unit: String,
        /// The quantity of the unit.
        of: super::Quantity,
        /// The quantity stated or asked for.
        asked: super::Quantity,
    },
    /// A count stated in the file is not the count met.
    #[error("found {found} as the count of {what}; expected {stated} as the file states")]
    CountMismatch {
        /// What is counted.
        what: &'static str,
        /// The count stated.
        stated: u64,
        /// The count met.
        found: u64,
    },
    /// A check value in the data does not agree with the data.
    #[error("found {found} for the {what}; expected {expected}")]
    CheckMismatch {
        /// What is checked.
        what: &'static str,
        /// The value met.
        found: f64,
        /// The value that follows from the rest of the file.
        expected: f64,
    },
    /// The input can be read in more than one way.
    #[error("found {found}; expected only one way to read it")]
    Ambiguous {
        /// What is ambiguous.
        found: String,
    },
    /// A quotation mark is opened and not closed.
    #[error("found an opening quotation mark without a closing one; expected it on the same line")]
    UnclosedQuote,
    /// Text without a spectrum in it.
    #[error("found no spectrum; expected {expected}")]
    NoSpectrum {
        /// What would have been one.
        expected: &'static str,
    },
    /// Not well-formed XML.
    #[error("found malformed XML ({message}); expected an IES TM-27-14 document")]
    Xml {
        /// What the XML parser says.
        message: String,
    },
    /// Legal, but not read by this program.
    #[error("found {found}; expected {expected}")]
    Unsupported {
        /// What was met.
        found: String,
        /// What is read.
        expected: &'static str,
    },
    /// Samples that make no spectrum, of a kind no other variant names.
    #[error(transparent)]
    Spectrum(#[from] super::super::Error),
    /// A quantity or unit that the user gave.
    #[error(transparent)]
    Unit(#[from] UnitError),
}

/// An [`ErrorKind`] with its place and a hint.
pub type Error = Located<ErrorKind>;

impl From<io::Error> for Error {
    fn from(error: io::Error) -> Self {
        Self::new(Location::default(), ErrorKind::Io { kind: error.kind(), message: error.to_string() })
    }
}

//! Why an image was refused or could not be written: where, what was found, what was expected.

use std::io;

use crate::finding::{Located, Location};

/// What is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Nothing in it.
    #[error("found an empty input; expected an image")]
    Empty,
    /// Not one of the formats.
    #[error("found {found}; expected an OpenEXR, ENVI, NPY, Radiance, PNG, JPEG or TIFF file, or a stack of pictures")]
    UnknownFormat {
        /// What it looks like.
        found: String,
    },
    /// A field that must be there is missing.
    #[error("found no `{field}`; expected {expected}")]
    Missing {
        /// Which field.
        field: String,
        /// What it would be.
        expected: String,
    },
    /// A value that the field cannot have.
    #[error("found {found} for {field}; expected {expected}")]
    Value {
        /// The text met.
        found: String,
        /// Which field.
        field: String,
        /// What it may be.
        expected: String,
    },
    /// A list of another length than announced.
    #[error("found {found} values for {field}; expected {expected}")]
    Count {
        /// Values met.
        found: usize,
        /// Which list.
        field: String,
        /// What is expected.
        expected: String,
    },
    /// Something else stands where a part of the format must be.
    #[error("found {found}; expected {expected}")]
    Unexpected {
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
    /// The file is shorter than its header announces.
    #[error("found {found} bytes; expected {expected}, as its header announces: the file is cut off")]
    CutOff {
        /// Bytes there.
        found: u64,
        /// Bytes announced.
        expected: u64,
    },
    /// Valid, but of a kind that is not read or written.
    #[error("found {found}, which is not supported; expected {expected}")]
    Unsupported {
        /// What it is.
        found: String,
        /// What is.
        expected: String,
    },
    /// The system's word while reading or writing.
    #[error("{message}")]
    Io {
        /// Its kind.
        kind: io::ErrorKind,
        /// What it says.
        message: String,
    },
    /// Wavelengths do not make a spectrum.
    #[error(transparent)]
    Spectrum(#[from] crate::spectrum::Error),
}

impl From<io::Error> for ErrorKind {
    fn from(error: io::Error) -> Self {
        Self::Io { kind: error.kind(), message: error.to_string() }
    }
}

/// An [`ErrorKind`] with its place and a hint.
pub type Error = Located<ErrorKind>;

impl<K: Into<ErrorKind>> From<K> for Error {
    fn from(kind: K) -> Self {
        Self::new(Location::default(), kind)
    }
}

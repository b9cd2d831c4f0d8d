//! Why an image was refused or could not be written: where, what was found, what was expected.

use std::fmt;
use std::io;

use crate::finding::Location;

/// What is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Nothing in it.
    #[error("found an empty input; expected an image")]
    Empty,
    /// Not one of the formats.
    #[error("found {found}; expected an OpenEXR, ENVI or NPY file, or a stack of pictures")]
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

/// An error with its place and, where there is one, advice.
#[derive(Debug, Clone, PartialEq)]
pub struct Error(Box<Report>);

#[derive(Debug, Clone, PartialEq)]
struct Report {
    location: Location,
    kind: ErrorKind,
    hint: Option<String>,
}

impl Error {
    /// An error at a place.
    #[must_use]
    pub fn new(location: Location, kind: impl Into<ErrorKind>) -> Self {
        Self(Box::new(Report { location, kind: kind.into(), hint: None }))
    }

    /// The same error with advice.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.0.hint = Some(hint.into());
        self
    }

    /// What is wrong.
    #[must_use]
    pub fn kind(&self) -> &ErrorKind {
        &self.0.kind
    }

    /// Where.
    #[must_use]
    pub fn location(&self) -> &Location {
        &self.0.location
    }

    /// What the user can do.
    #[must_use]
    pub fn hint(&self) -> Option<&str> {
        self.0.hint.as_deref()
    }

    /// The same error, in the file named.
    #[must_use]
    pub fn in_file(mut self, path: &str) -> Self {
        self.0.location.path.get_or_insert_with(|| path.to_owned());
        self
    }
}

impl<K: Into<ErrorKind>> From<K> for Error {
    fn from(kind: K) -> Self {
        Self::new(Location::default(), kind)
    }
}

impl std::error::Error for Error {}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = self.0.location.to_string();
        if !place.is_empty() {
            write!(f, "{place}: ")?;
        }
        write!(f, "{}", self.0.kind)?;
        match &self.0.hint {
            Some(hint) => write!(f, "; {hint}"),
            None => Ok(()),
        }
    }
}

//! Why a luminaire file was refused: where, what was found, what was expected.

use std::fmt;

use crate::finding::Location;

/// What is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Nothing in it.
    #[error("found an empty input; expected a luminaire file")]
    Empty,
    /// Not one of the formats.
    #[error("found no LM-63, EULUMDAT, TM-33 or CIE 102 file; expected one")]
    UnknownFormat,
    /// A binary file or text that cannot be decoded.
    #[error("found {found}; expected a text file")]
    NotText {
        /// What it is.
        found: &'static str,
    },
    /// Something that is no number where one must be.
    #[error("found `{found}`; expected a number for {field}")]
    NotANumber {
        /// The text met.
        found: String,
        /// Which field.
        field: String,
    },
    /// NaN or infinite.
    #[error("found {found}; expected a finite number for {field}")]
    NotFinite {
        /// The text met.
        found: String,
        /// Which field.
        field: String,
    },
    /// A number that the field cannot have.
    #[error("found {found} for {field}; expected {expected}")]
    OutOfRange {
        /// The text met.
        found: String,
        /// Which field.
        field: String,
        /// What it may be.
        expected: String,
    },
    /// A line that must be there is missing or another.
    #[error("found {found}; expected {expected}")]
    Unexpected {
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
    /// The file ends before the numbers it announces.
    #[error("found {found} numbers before the file ends; expected {expected} for {field}")]
    TooFew {
        /// Numbers met.
        found: usize,
        /// Numbers announced.
        expected: usize,
        /// Which field.
        field: String,
    },
    /// A count too large to be true.
    #[error("found {found} for {field}; expected at most {limit}")]
    TooLarge {
        /// The number.
        found: String,
        /// Which field.
        field: String,
        /// The limit.
        limit: u64,
    },
    /// Two statements that exclude one another.
    #[error("found {first} beside {second}; expected them to agree")]
    Contradiction {
        /// One.
        first: String,
        /// The other.
        second: String,
    },
    /// Broken XML.
    #[error("found broken XML ({message}); expected a well-formed document")]
    Xml {
        /// The parser's words.
        message: String,
    },
    /// The table does not make a distribution.
    #[error(transparent)]
    Table(#[from] crate::luminaire::Error),
    /// The table cannot be brought into the shape that is needed.
    #[error(transparent)]
    Transform(#[from] crate::luminaire::transform::Error),
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
    pub(crate) fn new(location: Location, kind: impl Into<ErrorKind>) -> Self {
        Self(Box::new(Report { location, kind: kind.into(), hint: None }))
    }

    /// The same error with advice.
    pub(crate) fn with_hint(mut self, hint: impl Into<String>) -> Self {
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
        self.0.location.path = Some(path.to_owned());
        self
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

//! Why a BRDF file was refused: where, what was found, what was expected.

use super::Format;
use crate::brdf::table;
use crate::finding::Located;

/// What is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Nothing in it.
    #[error("found an empty input; expected a BRDF table")]
    Empty,
    /// None of the formats.
    #[error("found {found}; expected a BRDF table ({})", formats())]
    Unknown {
        /// What it looks like.
        found: String,
    },
    /// Something that is no finite number where one must be.
    #[error("found `{found}`; expected a finite number for {field}")]
    NotANumber {
        /// The text met.
        found: String,
        /// Which field.
        field: String,
    },
    /// Something that cannot stand there.
    #[error("found {found}; expected {expected}")]
    Unexpected {
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
    /// The file ends before what it announces, or goes on after it.
    #[error("found {found} bytes; expected {expected} for {what}")]
    Length {
        /// Bytes in the file.
        found: u64,
        /// Bytes that it should have.
        expected: u64,
        /// For what.
        what: String,
    },
    /// It cannot be read.
    #[error("cannot be read: {message}; expected a BRDF table")]
    Io {
        /// The system's words.
        message: String,
    },
    /// Broken XML.
    #[error("found broken XML ({message}); expected a well-formed document")]
    Xml {
        /// The parser's words.
        message: String,
    },
    /// The numbers do not make a table.
    #[error(transparent)]
    Table(#[from] table::Error),
}

/// An [`ErrorKind`] with its place and a hint.
pub type Error = Located<ErrorKind>;

/// The formats that are read, by their names.
fn formats() -> String {
    Format::ALL.map(|f| f.to_string()).join(", ")
}

impl ErrorKind {
    /// [`ErrorKind::Unexpected`].
    pub(super) fn unexpected(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self::Unexpected { found: found.into(), expected: expected.into() }
    }
}

impl From<table::Error> for Error {
    fn from(error: table::Error) -> Self {
        Self::whole(error)
    }
}

//! Why a luminaire file was refused: where, what was found, what was expected.

use crate::finding::Located;

/// What is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Nothing in it.
    #[error("found an empty input; expected a luminaire file")]
    Empty,
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

/// An [`ErrorKind`] with its place and a hint.
pub type Error = Located<ErrorKind>;

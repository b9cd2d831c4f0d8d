//! What the readers of text share: decoding, lines, numbers with their places.

use std::borrow::Cow;

use encoding_rs::WINDOWS_1252;

use super::error::{Error, ErrorKind};
use crate::finding::Finding;

/// The text of a file without its mark, and a finding where its encoding had to be assumed.
pub(super) fn decode(bytes: &[u8]) -> (Cow<'_, str>, Option<Finding>) {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => (text.into(), None),
        Err(_) => {
            let finding = Finding::info("B101", "the text is not UTF-8 and was read as Windows-1252 (Latin-1)");
            (WINDOWS_1252.decode_without_bom_handling(bytes).0, Some(finding))
        }
    }
}

/// A line and its number, from 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'t> {
    pub(super) number: u64,
    pub(super) text: &'t str,
}

/// A word of a line and its column, from 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Word<'t> {
    pub(super) line: u64,
    pub(super) column: u64,
    pub(super) text: &'t str,
}

/// The lines of a text, ended by LF or CRLF.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    text.lines().zip(1..).map(|(text, number)| Line { number, text })
}

impl<'t> Line<'t> {
    /// The words between blanks.
    pub(super) fn words(self) -> impl Iterator<Item = Word<'t>> {
        self.split(char::is_whitespace).filter(|w| !w.text.is_empty())
    }

    /// The fields between separators, without blanks around them.
    pub(super) fn fields(self, separator: char) -> impl Iterator<Item = Word<'t>> {
        self.split(move |c| c == separator)
    }

    fn split(self, at: impl Fn(char) -> bool) -> impl Iterator<Item = Word<'t>> {
        let (mut column, text) = (1, self.text);
        text.split(at).map(move |field| {
            let blanks = field.chars().take_while(|c| c.is_whitespace()).count() as u64;
            let word = Word { line: self.number, column: column + blanks, text: field.trim() };
            column += field.chars().count() as u64 + 1;
            word
        })
    }

    /// An error at the beginning of the line.
    pub(super) fn error(self, kind: ErrorKind) -> Error {
        Error::at(self.number, 1, kind)
    }
}

impl Word<'_> {
    /// The finite number that the word is.
    pub(super) fn number(self, field: &str) -> Result<f64, Error> {
        match self.text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => {
                let found = self.text.chars().take(40).collect();
                Err(self.error(ErrorKind::NotANumber { found, field: field.to_owned() }))
            }
        }
    }

    /// The number of things that the word tells.
    pub(super) fn count(self, field: &str) -> Result<usize, Error> {
        self.text.parse().map_err(|_| {
            let found = format!("`{}`", self.text.chars().take(40).collect::<String>());
            self.error(ErrorKind::unexpected(found, format!("a whole number for {field}")))
        })
    }

    /// An error at the word.
    pub(super) fn error(self, kind: ErrorKind) -> Error {
        Error::at(self.line, self.column, kind)
    }
}

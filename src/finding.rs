//! What a reader or a calculation noticed without having to stop: findings with stable codes, and where they stand; and the
//! error of a reader that had to stop, with its place.
//!
//! Every other module may use this one; it imports nothing.

use std::borrow::Cow;
use std::fmt;

use serde::Serialize;

/// How much a [`Finding`] matters to whoever uses the number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing; the numbers stand as they are.
    Info,
    /// A number rests on an assumption or is less certain than its digits.
    Warning,
    /// A number could not be given.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Info => "info",
            Self::Warning => "warning",
            Self::Error => "error",
        })
    }
}

/// A place in an input; line and column count from 1, columns in characters of the decoded text.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash, Serialize)]
pub struct Location {
    /// The file as the user named it (`-` is standard input).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// Line, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<u64>,
    /// Column, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<u64>,
    /// The spectrum, lamp or figure meant, where an input holds several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub item: Option<String>,
}

impl Location {
    /// A line and a column of the input being read.
    #[must_use]
    pub fn at(line: u64, column: u64) -> Self {
        Self { line: Some(line), column: Some(column), ..Self::default() }
    }

    /// A line of the input being read.
    #[must_use]
    pub fn line(line: u64) -> Self {
        Self { line: Some(line), ..Self::default() }
    }

    /// The same place, in the file named.
    #[must_use]
    pub fn in_file(mut self, path: &str) -> Self {
        self.path = Some(path.to_owned());
        self
    }

    /// The same place, of the item named.
    #[must_use]
    pub fn of_item(mut self, item: &str) -> Self {
        self.item = Some(item.to_owned());
        self
    }
}

impl fmt::Display for Location {
    /// `FILE:LINE:COLUMN`, as far as each is known.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::with_capacity(4);
        parts.extend(self.path.clone());
        parts.extend(self.line.map(|n| n.to_string()));
        parts.extend(self.column.map(|n| n.to_string()));
        f.write_str(&parts.join(":"))?;
        match &self.item {
            Some(item) if parts.is_empty() => write!(f, "[{item}]"),
            Some(item) => write!(f, " [{item}]"),
            None => Ok(()),
        }
    }
}

/// Something a user should know about a result. Codes are stable and listed in `docs/findings.md`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// Stable code such as `S012`.
    pub code: &'static str,
    /// How much it matters.
    pub severity: Severity,
    /// One sentence: what was found and what follows from it.
    pub message: String,
    /// Where.
    pub location: Location,
    /// What the user can do about it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hint: Option<String>,
}

impl Finding {
    /// A finding without place or hint.
    #[must_use]
    pub fn new(code: &'static str, severity: Severity, message: impl Into<String>) -> Self {
        Self { code, severity, message: message.into(), location: Location::default(), hint: None }
    }

    /// A finding of severity [`Severity::Info`].
    #[must_use]
    pub fn info(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(code, Severity::Info, message)
    }

    /// A finding of severity [`Severity::Warning`].
    #[must_use]
    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(code, Severity::Warning, message)
    }

    /// A finding of severity [`Severity::Error`].
    #[must_use]
    pub fn error(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(code, Severity::Error, message)
    }

    /// The same finding with a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// The same finding at a place.
    #[must_use]
    pub fn at(mut self, location: Location) -> Self {
        self.location = location;
        self
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = self.location.to_string();
        if !place.is_empty() {
            write!(f, "{place}: ")?;
        }
        write!(f, "{} {}: {}", self.severity, self.code, self.message)?;
        match &self.hint {
            Some(hint) => write!(f, "; {hint}"),
            None => Ok(()),
        }
    }
}

/// A value together with what was noticed while obtaining it.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked<T> {
    /// The value.
    pub value: T,
    /// What was noticed, in the order it was met.
    pub findings: Vec<Finding>,
}

impl<T> Checked<T> {
    /// A value about which there is nothing to say.
    pub fn clean(value: T) -> Self {
        Self { value, findings: Vec::new() }
    }

    /// The same findings around another value.
    pub fn map<U>(self, f: impl FnOnce(T) -> U) -> Checked<U> {
        Checked { value: f(self.value), findings: self.findings }
    }
}

/// What is wrong with an input, where, and what its user can do about it: the error of every reader.
///
/// A reader has an enum of its own for what can be wrong, whose text says what was found and what was expected, and
/// `type Error = Located<ErrorKind>`. The whole displays as `FILE:LINE:COLUMN: found …; expected …; hint`, as far as each is
/// known. It is the size of a pointer, so that a `Result` with it costs nothing in a reader's loops.
#[derive(Debug, Clone, PartialEq)]
pub struct Located<Kind>(Box<Report<Kind>>);

#[derive(Debug, Clone, PartialEq)]
struct Report<Kind> {
    location: Location,
    kind: Kind,
    hint: Option<Cow<'static, str>>,
}

impl<Kind> Located<Kind> {
    /// An error at a place.
    pub fn new(location: Location, kind: impl Into<Kind>) -> Self {
        Self(Box::new(Report { location, kind: kind.into(), hint: None }))
    }

    /// An error at a line and a column, both from 1.
    pub fn at(line: u64, column: u64, kind: impl Into<Kind>) -> Self {
        Self::new(Location::at(line, column), kind)
    }

    /// An error of a text as a whole: at its beginning.
    pub fn whole(kind: impl Into<Kind>) -> Self {
        Self::at(1, 1, kind)
    }

    /// The same error with advice.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<Cow<'static, str>>) -> Self {
        self.0.hint = Some(hint.into());
        self
    }

    /// The same error, in the file named; one that names a file already, such as a band of a stack, keeps it.
    #[must_use]
    pub fn in_file(mut self, path: &str) -> Self {
        self.0.location.path.get_or_insert_with(|| path.to_owned());
        self
    }

    /// The same error of a text that begins so many lines further down in its file.
    #[must_use]
    pub fn below(mut self, lines: u64) -> Self {
        self.0.location.line = self.0.location.line.map(|line| line + lines);
        self
    }

    /// What is wrong.
    #[must_use]
    pub fn kind(&self) -> &Kind {
        &self.0.kind
    }

    /// Where: line and column wherever the fault is in the text. The path is left to whoever opened the file.
    #[must_use]
    pub fn location(&self) -> &Location {
        &self.0.location
    }

    /// What the user can do about it.
    #[must_use]
    pub fn hint(&self) -> Option<&str> {
        self.0.hint.as_deref()
    }
}

impl<Kind: fmt::Display> fmt::Display for Located<Kind> {
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

impl<Kind: std::error::Error> std::error::Error for Located<Kind> {
    /// What lies beneath the kind, whose own text is in this error's already.
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.kind.source()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Clone, PartialEq, thiserror::Error)]
    #[error("found `{0}`; expected a number")]
    struct NotANumber(&'static str);

    #[test]
    fn an_error_reads_as_far_as_its_place_is_known() {
        type Error = Located<NotANumber>;
        let bare = Error::new(Location::default(), NotANumber("x"));
        assert_eq!(bare.to_string(), "found `x`; expected a number");
        assert_eq!(bare.in_file("a.ies").to_string(), "a.ies: found `x`; expected a number");
        let full = Error::at(3, 7, NotANumber("x")).in_file("a.ies").with_hint("is it a decimal comma?");
        assert_eq!(full.clone().in_file("folder"), full);
        assert_eq!(full.to_string(), "a.ies:3:7: found `x`; expected a number; is it a decimal comma?");
        assert_eq!((full.kind(), full.hint()), (&NotANumber("x"), Some("is it a decimal comma?")));
        assert_eq!(Error::whole(NotANumber("x")).below(2).location(), &Location::at(3, 1));
        assert_eq!(size_of::<Error>(), size_of::<usize>());
    }
}

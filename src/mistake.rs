//! Mistakes in the files that people write (TOML): where they are, what was found and what was expected.

use std::ops::Range;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What is wrong with a file, and where.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{line}:{column}: {message}")]
pub struct Mistake {
    /// Line, from 1.
    pub line: u64,
    /// Column in characters, from 1.
    pub column: u64,
    /// What was found, and what was expected.
    pub message: String,
}

impl Mistake {
    /// At a range of bytes of the text.
    #[must_use]
    pub fn at(text: &str, span: &Range<usize>, message: impl Into<String>) -> Self {
        let before = text.get(..span.start).unwrap_or(text);
        let line = before.rsplit_once('\n').map_or(before, |(_, line)| line);
        Self {
            line: before.matches('\n').count() as u64 + 1,
            column: line.chars().count() as u64 + 1,
            message: message.into(),
        }
    }
}

/// Reads TOML whose numbers are all finite.
///
/// # Errors
/// The first mistake in TOML, in keys, in types and in units.
pub fn parse<T: DeserializeOwned>(text: &str) -> Result<T, Mistake> {
    if let Ok(table) = DeTable::parse(text) {
        let found = table.get_ref().iter().find_map(|(_, value)| not_finite(value));
        if let Some(span) = found {
            let found = text.get(span.clone()).unwrap_or_default();
            return Err(Mistake::at(text, &span, format!("found `{found}`; expected a finite number")));
        }
    }
    toml::from_str(text).map_err(|e| Mistake::at(text, &e.span().unwrap_or_default(), e.message()))
}

/// The place of the first number that is none or infinite, which TOML allows and no quantity is.
fn not_finite(value: &Spanned<DeValue<'_>>) -> Option<Range<usize>> {
    match value.get_ref() {
        DeValue::Float(number) => {
            let parsed = number.as_str().replace('_', "").parse::<f64>();
            parsed.is_ok_and(|n| !n.is_finite()).then(|| value.span())
        }
        DeValue::Array(items) => items.iter().find_map(not_finite),
        DeValue::Table(table) => table.iter().find_map(|(_, value)| not_finite(value)),
        _ => None,
    }
}

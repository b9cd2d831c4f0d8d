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
    toml::from_str(text).map_err(|e| Mistake::at(text, &e.span().unwrap_or_default(), in_words(e.message())))
}

/// The place of a value by its keys, from a table that begins at `at` or that holds a value there; `at` where there is none.
///
/// For what is found wrong after reading, in tables of which only the place was kept.
#[must_use]
pub fn place(text: &str, at: &Range<usize>, keys: &[&str]) -> Range<usize> {
    let Ok(root) = DeTable::parse(text) else { return at.clone() };
    let found = beneath(root.get_ref(), &root.span(), &|table, own| {
        let is_meant = own == at || table.iter().any(|(_, value)| value.span() == *at);
        let (first, rest) = keys.split_first().filter(|_| is_meant)?;
        let value = rest.iter().try_fold(table.get(*first)?, |value, key| value.get_ref().get(key));
        Some(value?.span())
    });
    found.unwrap_or_else(|| at.clone())
}

/// What `of` says first of a table or of those within it.
fn beneath<T>(
    table: &DeTable<'_>,
    span: &Range<usize>,
    of: &dyn Fn(&DeTable<'_>, &Range<usize>) -> Option<T>,
) -> Option<T> {
    fn within<T>(value: &Spanned<DeValue<'_>>, of: &dyn Fn(&DeTable<'_>, &Range<usize>) -> Option<T>) -> Option<T> {
        match value.get_ref() {
            DeValue::Table(table) => beneath(table, &value.span(), of),
            DeValue::Array(items) => items.iter().find_map(|item| within(item, of)),
            _ => None,
        }
    }
    of(table, span).or_else(|| table.iter().find_map(|(_, value)| within(value, of)))
}

/// A message of serde about types, in the words of TOML and not of Rust; others as they are.
fn in_words(message: &str) -> String {
    let types = message.strip_prefix("invalid type: ").or_else(|| message.strip_prefix("invalid value: "));
    let Some((found, expected)) = types.and_then(|m| m.rsplit_once(", expected ")) else {
        return message.to_owned();
    };
    let found = match found {
        "map" => "a table".to_owned(),
        "sequence" => "an array".to_owned(),
        _ => (found.strip_prefix("integer ").or_else(|| found.strip_prefix("floating point ")))
            .or_else(|| found.strip_prefix("boolean "))
            .map_or_else(|| found.replacen("string ", "the text ", 1), str::to_owned),
    };
    let expected = match expected {
        "a string" => "a text",
        "a boolean" => "true or false",
        "a map" => "a table",
        "a sequence" => "an array",
        "f32" | "f64" => "a number",
        "i8" | "i16" | "i32" | "i64" | "isize" => "a whole number",
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number, 0 or more",
        _ if expected.starts_with("struct ") => "a table",
        _ => expected,
    };
    format!("found {found}; expected {expected}")
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

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    #[expect(dead_code, reason = "only its mistakes are looked at")]
    struct File {
        name: Option<String>,
        count: Option<u32>,
        size: Option<f64>,
        on: Option<bool>,
        list: Option<Vec<f64>>,
        part: Option<Box<File>>,
    }

    #[test]
    fn types_are_told_in_the_words_of_toml() {
        for (text, message) in [
            ("name = 3", "1:8: found `3`; expected a text"),
            ("count = -1", "1:9: found `-1`; expected a whole number, 0 or more"),
            ("count = 1.5", "1:9: found `1.5`; expected a whole number, 0 or more"),
            ("size = \"a, expected b\"", "1:8: found the text \"a, expected b\"; expected a number"),
            ("size = { a = 1 }", "1:8: found a table; expected a number"),
            ("on = [1]", "1:6: found an array; expected true or false"),
            ("list = true", "1:8: found `true`; expected an array"),
            ("part = 1", "1:8: found `1`; expected a table"),
        ] {
            assert_eq!(parse::<File>(text).unwrap_err().to_string(), message);
        }
    }

    /// By a table's own place, inline or with a header, and by that of a value beside.
    #[test]
    fn a_value_has_its_place_by_its_keys() {
        let text = "[[a]]\nb = { c = 1, d = { e = 2 } }\n[[a]]\n[a.b]\nc = 3\nd.e = 4\n";
        let root = DeTable::parse(text).unwrap();
        let items = root.get_ref().get("a").unwrap().get_ref().as_array().unwrap();
        for (item, [c, e]) in items.iter().zip([["1", "2"], ["3", "4"]]) {
            let b = item.get_ref().get("b").unwrap();
            assert_eq!(&text[place(text, &b.span(), &["c"])], c);
            let c = b.get_ref().get("c").unwrap().span();
            assert_eq!(&text[place(text, &c, &["d", "e"])], e);
            assert_eq!(place(text, &c, &["none"]), c);
        }
    }
}

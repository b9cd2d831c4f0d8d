//! The file form: a table of TOML, by itself or inside a scene.
//!
//! ```toml
//! name = "varnished wood"           # optional, for reports
//! sum = [
//!     "0.9*lambert(reflectance=[[400, 0.05], [700, 0.4]])",
//!     { weight = 0.1, model = "ward", ks = 1, alpha_x = 0.05, alpha_y = 0.2 },
//! ]
//! ```
//!
//! A table is one `model` with its parameters and an optional `weight`, or a `sum` of such tables and of descriptions in text, or
//! `material = "…"`, a description in text. Values are as in text: numbers, words, `[a, b, c]`, `[[nm, value], …]`.

use std::ops::Range;

use ::toml::Spanned;
use ::toml::de::{DeArray, DeTable, DeValue};

use super::{Error, ErrorKind, Material, Part, Place, Raw, add, list, model, parse};

/// A material file.
#[derive(Debug, Clone)]
pub struct Named {
    /// Its name, where it has one.
    pub name: Option<String>,
    /// What it describes.
    pub material: Material,
}

/// Reads a material file.
///
/// # Errors
/// [`Error`] with the place in the file.
pub fn read(text: &str) -> Result<Named, Error> {
    let file = File { text };
    let table = DeTable::parse(text).map_err(|e| Error {
        place: file.place(&e.span().unwrap_or_default()),
        kind: ErrorKind::Syntax { found: e.message().to_owned(), expected: "TOML".to_owned() },
    })?;
    let mut name = None;
    let mut rest = Vec::new();
    for (key, value) in table.get_ref() {
        if key.get_ref() == "name" {
            name = Some(file.string(value)?.to_owned());
        } else {
            rest.push((key, value));
        }
    }
    Ok(Named { name, material: Material { parts: file.parts(&rest, &(0..0))? } })
}

type Entry<'a> = (&'a Spanned<std::borrow::Cow<'a, str>>, &'a Spanned<DeValue<'a>>);

struct File<'a> {
    text: &'a str,
}

impl File<'_> {
    fn place(&self, span: &Range<usize>) -> Place {
        let before = self.text.get(..span.start).unwrap_or(self.text);
        let line = before.rsplit_once('\n').map_or(before, |(_, line)| line);
        Place { line: before.matches('\n').count() as u64 + 1, column: line.chars().count() as u64 + 1 }
    }

    fn wrong(&self, value: &Spanned<DeValue<'_>>, expected: &str) -> Error {
        let found = format!("`{}`", self.text.get(value.span()).unwrap_or_default());
        Error { place: self.place(&value.span()), kind: ErrorKind::Syntax { found, expected: expected.to_owned() } }
    }

    fn string<'v>(&self, value: &'v Spanned<DeValue<'_>>) -> Result<&'v str, Error> {
        value.get_ref().as_str().ok_or_else(|| self.wrong(value, "a text in quotes"))
    }

    /// The parts of a table that stands at `span`.
    fn parts(&self, entries: &[Entry<'_>], span: &Range<usize>) -> Result<Vec<Part>, Error> {
        let get = |name: &str| entries.iter().find(|(key, _)| key.get_ref() == name).map(|(_, value)| *value);
        for alone in ["material", "sum"] {
            let other = entries.iter().find(|(key, _)| key.get_ref() != alone);
            if let (true, Some((other, _))) = (get(alone).is_some(), other) {
                let found = format!("`{}` beside `{alone}`", other.get_ref());
                let kind = ErrorKind::Syntax { found, expected: format!("`{alone}` alone") };
                return Err(Error { place: self.place(&other.span()), kind });
            }
        }
        if let Some(value) = get("material") {
            return self.text_parts(value);
        }
        if let Some(value) = get("sum") {
            let DeValue::Array(items) = value.get_ref() else {
                return Err(self.wrong(value, "a list of materials"));
            };
            return self.sum(items);
        }
        let Some(named) = get("model") else {
            let kind = ErrorKind::Syntax {
                found: "a table without material".to_owned(),
                expected: "`model`, `sum` or `material`".to_owned(),
            };
            return Err(Error { place: self.place(span), kind });
        };
        let model = model(self.string(named)?, self.place(&named.span()))?;
        let (mut weight, mut arguments) = (Raw::Number(1.0), Vec::new());
        for (key, value) in entries {
            let at = self.place(&value.span());
            match key.get_ref().as_ref() {
                "model" => {}
                "weight" => weight = self.value(value)?,
                name => add(&mut arguments, model, name, self.place(&key.span()), (self.value(value)?, at))?,
            }
        }
        Ok(vec![Part { weight, model, arguments, place: self.place(&named.span()) }])
    }

    fn sum(&self, items: &DeArray<'_>) -> Result<Vec<Part>, Error> {
        let mut parts = Vec::new();
        for item in items {
            match item.get_ref() {
                DeValue::Table(table) => {
                    let entries: Vec<Entry<'_>> = table.iter().collect();
                    parts.extend(self.parts(&entries, &item.span())?);
                }
                _ => parts.extend(self.text_parts(item)?),
            }
        }
        Ok(parts)
    }

    /// A description in text; its places are those in the file, for a text on one line.
    fn text_parts(&self, value: &Spanned<DeValue<'_>>) -> Result<Vec<Part>, Error> {
        let start = self.place(&value.span());
        let moved = |p: Place| {
            let column = if p.line == 1 { start.column + p.column } else { p.column };
            Place { line: start.line + p.line - 1, column }
        };
        let mut material =
            parse::material(self.string(value)?).map_err(|e| Error { place: moved(e.place), kind: e.kind })?;
        for part in &mut material.parts {
            part.place = moved(part.place);
            part.arguments.iter_mut().for_each(|a| a.place = moved(a.place));
        }
        Ok(material.parts)
    }

    fn value(&self, value: &Spanned<DeValue<'_>>) -> Result<Raw, Error> {
        const EXPECTED: &str = "a number, a word or a list";
        match value.get_ref() {
            DeValue::String(s) => Ok(Raw::Word(s.to_string())),
            DeValue::Integer(_) | DeValue::Float(_) => {
                let text = self.text.get(value.span()).unwrap_or_default().replace('_', "");
                let number = text.parse::<f64>().ok().filter(|v| v.is_finite());
                number.map(Raw::Number).ok_or_else(|| self.wrong(value, "a decimal number"))
            }
            DeValue::Array(items) => {
                let items = items.iter().map(|item| self.value(item)).collect::<Result<_, _>>()?;
                list(items, self.place(&value.span()))
            }
            _ => Err(self.wrong(value, EXPECTED)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_three_ways_to_write_a_material() {
        let one = read("name = \"gold\"\nmodel = \"ggx\"\nalpha = 0.1\nmedium = \"Au\"\n").expect("a model");
        assert_eq!((one.name.as_deref(), one.material.to_string()), (Some("gold"), "ggx(alpha=0.1, medium=Au)".into()));
        let text = read("material = \"0.5*mirror() + lambert(reflectance=0.5)\"").expect("a text");
        assert_eq!(text.material.to_string(), "0.5*mirror() + lambert(reflectance=0.5)");
        let sum = "sum = [\n \"0.5*mirror()\",\n { weight = 0.5, model = \"lambert\", reflectance = [[400, 0.1], [700, 1]] } ]";
        assert_eq!(
            read(sum).expect("a sum").material.to_string(),
            "0.5*mirror() + 0.5*lambert(reflectance=[[400.0, 0.1], [700.0, 1.0]])"
        );
    }

    #[test]
    fn errors_are_placed_in_the_file() {
        for (text, expected) in [
            ("model = \"ggx\"\nalpah = 0.1", "2:1: `ggx` has no parameter `alpah`"),
            ("model = \"ggz\"", "1:9: no model is called `ggz`"),
            ("model = ", "1:"),
            ("", "1:1: found a table without material; expected `model`, `sum` or `material`"),
            ("material = \"lambert(reflectance=0.1) + lambart()\"", "1:40: no model is called `lambart`"),
            ("sum = [3]", "1:8: found `3`; expected a text in quotes"),
            ("sum = []\nmodel = \"ggx\"", "2:1: found `model` beside `sum`; expected `sum` alone"),
            ("model = \"lambert\"\nreflectance = true", "2:15: found `true`; expected a number, a word or a list"),
        ] {
            let error = read(text).expect_err(text).to_string();
            assert!(error.starts_with(expected), "{text}: {error}");
        }
    }
}

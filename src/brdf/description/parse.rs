//! The text form: `weight*model(name=value, …) + …`.

use super::{Error, ErrorKind, Material, Part, Place, Raw, add, is_of_a_word, list, model, template};

/// Lists inside lists: a spectrum has two levels, more are nonsense.
const DEEPEST: usize = 2;

/// Reads a whole description.
pub(super) fn material(text: &str) -> Result<Material, Error> {
    read(text, false)
}

/// Reads a description in which values may be open.
pub(super) fn template(text: &str) -> Result<Material, Error> {
    read(text, true)
}

fn read(text: &str, open: bool) -> Result<Material, Error> {
    let mut reader = Reader { rest: text, place: Place { line: 1, column: 1 }, open };
    let mut parts = vec![reader.part()?];
    while reader.taken('+') {
        parts.push(reader.part()?);
    }
    match reader.peek() {
        None => Ok(Material { parts }),
        Some(_) => Err(reader.unexpected("`+` and another model, or the end")),
    }
}

struct Reader<'a> {
    rest: &'a str,
    place: Place,
    /// Values may be `?`, and models stand without parentheses.
    open: bool,
}

impl<'a> Reader<'a> {
    fn advance(&mut self, bytes: usize) -> &'a str {
        let (taken, rest) = self.rest.split_at(bytes);
        for c in taken.chars() {
            if c == '\n' {
                self.place = Place { line: self.place.line + 1, column: 1 };
            } else {
                self.place.column += 1;
            }
        }
        self.rest = rest;
        taken
    }

    fn peek(&mut self) -> Option<char> {
        let blanks = self.rest.len() - self.rest.trim_start().len();
        self.advance(blanks);
        self.rest.chars().next()
    }

    fn taken(&mut self, c: char) -> bool {
        let there = self.peek() == Some(c);
        if there {
            self.advance(c.len_utf8());
        }
        there
    }

    fn expect(&mut self, c: char, expected: &str) -> Result<(), Error> {
        if self.taken(c) { Ok(()) } else { Err(self.unexpected(expected)) }
    }

    fn unexpected(&mut self, expected: &str) -> Error {
        let found = self.peek().map_or("the end".to_owned(), |c| format!("`{c}`"));
        Error { place: self.place, kind: ErrorKind::Syntax { found, expected: expected.to_owned() } }
    }

    /// A run of the characters of names and numbers.
    fn word(&mut self) -> &'a str {
        self.peek();
        let end = self.rest.find(|c| !is_of_a_word(c)).unwrap_or(self.rest.len());
        self.advance(end)
    }

    fn number(&mut self) -> Result<f64, Error> {
        self.peek();
        let place = self.place;
        let mut end = 0;
        let mut previous = ' ';
        for c in self.rest.chars() {
            // A sign belongs to a number at its front and after its exponent's letter.
            let sign = "+-".contains(c) && (end == 0 || "eE".contains(previous));
            if !(sign || c.is_ascii_alphanumeric() || c == '.') {
                break;
            }
            end += c.len_utf8();
            previous = c;
        }
        let text = self.advance(end);
        match text.parse::<f64>() {
            Ok(v) if v.is_finite() => Ok(v),
            _ => Err(Error {
                place,
                kind: ErrorKind::Syntax { found: format!("`{text}`"), expected: "a number".to_owned() },
            }),
        }
    }

    fn part(&mut self) -> Result<Part, Error> {
        let first = self.peek();
        let place = self.place;
        let weight = match first {
            Some(c) if c.is_ascii_digit() || ".-[".contains(c) || (self.open && c == '?') => {
                let weight = self.value(0)?;
                self.expect('*', "`*` between a weight and its model")?;
                weight
            }
            _ => Raw::Number(1.0),
        };
        self.peek();
        let model_place = self.place;
        let name = self.word();
        if name.is_empty() {
            return Err(self.unexpected("a model such as `lambert(reflectance=0.5)`"));
        }
        let model = model(name, model_place)?;
        let mut part = Part { weight, model, arguments: Vec::new(), place };
        let bare = self.open && self.peek() != Some('(');
        if !bare {
            self.arguments(&mut part)?;
        }
        if self.open {
            template::complete(&mut part, bare);
        }
        Ok(part)
    }

    fn arguments(&mut self, part: &mut Part) -> Result<(), Error> {
        self.expect('(', "`(` and the model's parameters")?;
        while !self.taken(')') {
            if !part.arguments.is_empty() {
                self.expect(',', "`,` and another parameter, or `)`")?;
            }
            self.peek();
            let name_place = self.place;
            let name = self.word();
            if name.is_empty() {
                return Err(self.unexpected("a parameter's name"));
            }
            self.expect('=', "`=` and a value")?;
            self.peek();
            let value_place = self.place;
            let value = self.value(0)?;
            add(&mut part.arguments, part.model, name, name_place, (value, value_place))?;
        }
        Ok(())
    }

    fn value(&mut self, depth: usize) -> Result<Raw, Error> {
        match self.peek() {
            Some('[') if depth < DEEPEST => {
                let place = self.place;
                self.advance(1);
                let mut items = Vec::new();
                while !self.taken(']') {
                    if !items.is_empty() {
                        self.expect(',', "`,` and another value, or `]`")?;
                    }
                    items.push(self.value(depth + 1)?);
                }
                list(items, place)
            }
            Some('"') => {
                self.advance(1);
                let Some(end) = self.rest.find('"') else { return Err(self.unexpected("a closing `\"`")) };
                let word = self.advance(end).to_owned();
                self.advance(1);
                Ok(Raw::Word(word))
            }
            Some(c) if c.is_ascii_digit() || "+-.".contains(c) => Ok(Raw::Number(self.number()?)),
            Some('?') if self.open && depth == 0 => {
                self.advance(1);
                let start = self.rest.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
                Ok(Raw::Open(if start { Some(self.number()?) } else { None }))
            }
            Some(c) if c.is_alphabetic() => Ok(Raw::Word(self.word().to_owned())),
            _ => Err(self.unexpected("a number, a word or a list")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Bands;
    use super::*;

    fn error(text: &str) -> String {
        match text.parse::<Material>() {
            Err(e) => e.to_string(),
            Ok(m) => m.prepare(Bands::Wavelengths(&[555.0])).expect_err(text).to_string(),
        }
    }

    #[test]
    fn descriptions_read_back_as_they_are_printed() {
        for text in [
            "lambert(reflectance=0.5)",
            "0.25*lambert(reflectance=[[400.0, 0.1], [700.0, 0.9]]) + ggx(alpha=0.1, medium=Au)",
            "phong(kd=[0.1, 0.2, 0.3], ks=0.05, n=20, form=classic)",
            "mirror()",
        ] {
            assert_eq!(text.parse::<Material>().expect(text).to_string(), text);
        }
        let loose =
            " 2.5e-1 *lambert ( reflectance = \n 1e-1 )+GGX(alpha=.2,eta=1.5)".parse::<Material>().expect("loose");
        assert_eq!(loose.to_string(), "0.25*lambert(reflectance=0.1) + ggx(alpha=0.2, eta=1.5)");
    }

    #[test]
    fn errors_say_where_and_what() {
        for (text, expected) in [
            ("", "1:1: found the end; expected a model such as `lambert(reflectance=0.5)`"),
            ("lambert", "1:8: found the end; expected `(` and the model's parameters"),
            ("lambert(reflectance=0.5", "1:24: found the end; expected `,` and another parameter, or `)`"),
            ("lambert(reflectance=2)", "1:21: `reflectance` is 2; expected a number or spectrum from 0 to 1"),
            ("lambert()", "1:1: `reflectance` is missing; expected a number or spectrum from 0 to 1"),
            (
                "lambert(reflectance=red)",
                "1:21: found `red` for `reflectance`; expected a number or spectrum from 0 to 1",
            ),
            ("lambert(reflectance=0.1x)", "1:21: found `0.1x`; expected a number"),
            (
                "lambert(reflectance=[0.1,0.2,0.3])",
                "1:21: values of 3 channels, without wavelengths; expected a spectrum [[nm, value], …] or one number",
            ),
            (
                "lambert(reflectance=[[700,1],[400,1]])",
                "1:21: found a spectrum whose wavelengths do not rise; expected [[nm, value], …] from short to long wavelengths",
            ),
            (
                "ggx(alpha=0.1,\n  medium=Xx)",
                "2:10: no substance is called `Xx`; expected one of Ag, Al, Au, Cu, BK7, SF10, water",
            ),
            ("ggx(alpha=0.1, eta=1.5, f0=0.1)", "1:1: both `eta` and `f0` are given; expected one of them"),
            ("ggx(alpha=0.1, alpha=0.1)", "1:16: `alpha` is given twice; expected once"),
            (
                "ggx(alpha=0.1, eta=1.5) lambert(reflectance=1)",
                "1:25: found `l`; expected `+` and another model, or the end",
            ),
        ] {
            let got = error(text);
            // A conflict is shown at the second of the two.
            let expected = expected.replace("1:1: both", "1:28: both");
            assert_eq!(got, expected, "{text}");
        }
        assert!(
            error("lambart(reflectance=1)")
                .starts_with("1:1: no model is called `lambart`; expected one of lambert, oren-nayar")
        );
        assert!(error("lambert(rho=1)").starts_with(
            "1:9: `lambert` has no parameter `rho`; expected reflectance: a number or spectrum from 0 to 1"
        ));
        assert!(error("lambert(reflectance=[[[1,2]]])").contains("expected a number, a word or a list"));
    }
}

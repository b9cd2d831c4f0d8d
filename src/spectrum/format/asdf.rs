//! The tables of JCAMP-DX: `(X++(Y..Y))` in free format (AFFN) and in the compressed forms PAC, SQZ, DIF and DUP (ASDF), and
//! `(XY..XY)`.
//!
//! In compressed forms the first character of a number carries its sign and first digit: `@A…I` and `a…i` for a value (SQZ),
//! `%J…R` and `j…r` for the difference to the value before (DIF), `S…Zs` for how often the item before stands (DUP). `E` is an
//! exponent only where a sign follows it, as the standard has it.

use super::error::{Error, ErrorKind};
use super::instrument;
use super::text::place;
use crate::finding::Location;

/// A line of a table, with its number in the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    pub number: u64,
    pub text: &'a str,
}

impl Line<'_> {
    fn error(&self, byte: usize, kind: ErrorKind) -> Error {
        Error::new(place(self.text, self.number, byte), kind)
    }

    fn not_a_number(&self, byte: usize, end: usize, what: &'static str) -> Error {
        self.error(byte, ErrorKind::NotANumber { found: self.text[byte..end].to_owned(), what })
    }
}

/// One item of a compressed line.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Item {
    Value(f64),
    Difference(f64),
    /// How often the item before stands, itself included.
    Times(u64),
}

/// Sign and digit of a pseudo-digit.
fn pseudo_digit(byte: u8) -> Option<(Kind, char, bool)> {
    let digit = |from: u8, first: u8| char::from(b'0' + first + (byte - from));
    Some(match byte {
        b'@' => (Kind::Value, '0', false),
        b'A'..=b'I' => (Kind::Value, digit(b'A', 1), false),
        b'a'..=b'i' => (Kind::Value, digit(b'a', 1), true),
        b'%' => (Kind::Difference, '0', false),
        b'J'..=b'R' => (Kind::Difference, digit(b'J', 1), false),
        b'j'..=b'r' => (Kind::Difference, digit(b'j', 1), true),
        b'S'..=b'Z' => (Kind::Times, digit(b'S', 1), false),
        b's' => (Kind::Times, '9', false),
        _ => return None,
    })
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Value,
    Difference,
    Times,
}

/// The items of a line with the byte where each begins.
fn items(line: Line<'_>) -> Result<Vec<(usize, Item)>, Error> {
    let bytes = line.text.as_bytes();
    let mut items = Vec::new();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        if byte.is_ascii_whitespace() || matches!(byte, b',' | b';') {
            at += 1;
            continue;
        }
        let start = at;
        at += 1;
        let mut digits = String::new();
        let kind = match pseudo_digit(byte) {
            Some((kind, digit, negative)) => {
                if negative {
                    digits.push('-');
                }
                digits.push(digit);
                kind
            }
            None if byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.') => {
                digits.push(char::from(byte));
                Kind::Value
            }
            None => {
                let end = start + line.text[start..].chars().next().map_or(1, char::len_utf8);
                if byte == b'?' {
                    let kind = ErrorKind::MissingValue { found: "?".to_owned(), name: String::new() };
                    return Err(line.error(start, kind));
                }
                return Err(line.not_a_number(start, end, "value"));
            }
        };
        while let Some(&byte) = bytes.get(at)
            && (byte.is_ascii_digit() || byte == b'.')
        {
            digits.push(char::from(byte));
            at += 1;
        }
        if let (Some(b'E' | b'e'), Some(b'+' | b'-'), Some(b'0'..=b'9')) =
            (bytes.get(at), bytes.get(at + 1), bytes.get(at + 2))
        {
            let end = at + 2 + bytes[at + 2..].iter().take_while(|b| b.is_ascii_digit()).count();
            digits.push_str(&line.text[at..end]);
            at = end;
        }
        let wrong = || line.not_a_number(start, at, "value");
        let item = match kind {
            Kind::Times => Item::Times(digits.parse().map_err(|_| wrong())?),
            Kind::Value | Kind::Difference => {
                let value: f64 = digits.parse().map_err(|_| wrong())?;
                if !value.is_finite() {
                    let found = line.text[start..at].to_owned();
                    return Err(line.error(start, ErrorKind::NotFinite { found, what: "value" }));
                }
                if kind == Kind::Value { Item::Value(value) } else { Item::Difference(value) }
            }
        };
        items.push((start, item));
    }
    Ok(items)
}

/// Ordinates and abscissas as a table lists them, before any factor.
#[derive(Debug, Default)]
pub(super) struct Ordinates {
    pub values: Vec<f64>,
    /// Line of each ordinate.
    pub lines: Vec<u64>,
    /// The abscissa in front of each line.
    pub abscissas: Vec<Abscissa>,
}

/// The abscissa in front of a line of ordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Abscissa {
    /// The ordinate it belongs to; behind a check ordinate some writers mean the next one.
    pub index: usize,
    pub checked: bool,
    pub value: f64,
    /// One in its last printed digit.
    pub digit: f64,
    pub line: u64,
    pub column: u64,
}

/// Reads `(X++(Y..Y))`. A count of ordinates beyond `most` ends the reading with an error before memory is taken.
pub(super) fn ordinates(lines: &[Line<'_>], most: u64) -> Result<Ordinates, Error> {
    let mut out = Ordinates::default();
    let mut by_difference = false;
    for &line in lines {
        let items = items(line)?;
        let Some((&(start, abscissa), rest)) = items.split_first() else { continue };
        let Item::Value(value) = abscissa else { return Err(line.not_a_number(start, start + 1, "wavelength")) };
        let digits = line.text[start..].trim_start_matches(['+', '-']);
        let printed = digits.find(|c: char| !(c.is_ascii_digit() || c == '.')).map_or(digits, |end| &digits[..end]);
        let decimals = printed.split_once('.').map_or(0, |(_, decimals)| decimals.len().min(300));
        let digit = 10f64.powi(-(decimals as i32));
        let column = line.text[..start].chars().count() as u64 + 1;
        let mut abscissa =
            Abscissa { index: out.values.len(), checked: false, value, digit, line: line.number, column };
        // After differences a line begins with the last ordinate of the line before, as a check.
        let mut rest = rest;
        if by_difference && let (Some(&last), Some(&(at, item))) = (out.values.last(), rest.first()) {
            match item {
                Item::Value(check) if (check - last).abs() <= 1e-9 * last.abs() => {}
                Item::Value(found) => {
                    return Err(
                        line.error(at, ErrorKind::CheckMismatch { what: "check ordinate", found, expected: last })
                    );
                }
                _ => return Err(line.not_a_number(at, at + 1, "check ordinate")),
            }
            abscissa = Abscissa { index: abscissa.index - 1, checked: true, ..abscissa };
            rest = &rest[1..];
        }
        out.abscissas.push(abscissa);
        by_difference = out.extend(line, rest, most)? && !out.values.is_empty();
    }
    Ok(out)
}

impl Ordinates {
    /// Adds the items of a line; whether the last was a difference.
    fn extend(&mut self, line: Line<'_>, items: &[(usize, Item)], most: u64) -> Result<bool, Error> {
        let mut before: Option<Item> = None;
        for &(at, item) in items {
            let (step, times) = match item {
                Item::Times(times) => (before, times.checked_sub(1)),
                other => (Some(other), Some(1)),
            };
            let (Some(step), Some(times)) = (step, times) else {
                let kind = ErrorKind::Unexpected {
                    found: "a repetition of nothing".to_owned(),
                    expected: "a value or a difference to repeat".to_owned(),
                };
                return Err(line.error(at, kind));
            };
            let found = (self.values.len() as u64).saturating_add(times);
            if found > most {
                let kind =
                    ErrorKind::Unexpected { found: format!("{found} ordinates"), expected: format!("at most {most}") };
                return Err(line.error(at, kind));
            }
            for _ in 0..times {
                let value = match (step, self.values.last()) {
                    (Item::Difference(difference), Some(last)) => last + difference,
                    (Item::Value(value), _) => value,
                    _ => return Err(line.not_a_number(at, at + 1, "first value")),
                };
                self.values.push(value);
                self.lines.push(line.number);
            }
            before = Some(step);
        }
        // A line of nothing but its check ordinate ends in no difference.
        Ok(matches!(before, Some(Item::Difference(_))))
    }
}

/// One point, with the line and column where it stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
    pub line: u64,
    pub column: u64,
}

impl Point {
    pub(super) fn place(&self) -> Location {
        Location::at(self.line, self.column)
    }
}

/// Reads `(XY..XY)`: free format only.
pub(super) fn pairs(lines: &[Line<'_>], most: u64) -> Result<Vec<Point>, Error> {
    let mut pairs = Vec::new();
    for &line in lines {
        let mut start = None;
        let mut numbers: Vec<(usize, f64)> = Vec::new();
        let ends = line.text.char_indices().chain([(line.text.len(), ' ')]);
        for (at, c) in ends {
            let delimiter = c.is_whitespace() || matches!(c, ',' | ';');
            match (delimiter, start) {
                (false, None) => start = Some(at),
                (true, Some(from)) => {
                    let what = if numbers.len().is_multiple_of(2) { "wavelength" } else { "value" };
                    let text = &line.text[from..at];
                    let number = instrument::number(text, '.', what, || place(line.text, line.number, from))?;
                    numbers.push((from, number));
                    start = None;
                }
                _ => {}
            }
        }
        if numbers.len() % 2 == 1 {
            let kind = ErrorKind::MissingColumn { found: numbers.len(), expected: numbers.len() + 1 };
            return Err(line.error(line.text.len(), kind));
        }
        pairs.extend(numbers.chunks_exact(2).map(|pair| {
            let column = line.text[..pair[0].0].chars().count() as u64 + 1;
            Point { x: pair[0].1, y: pair[1].1, line: line.number, column }
        }));
        if pairs.len() as u64 > most {
            let kind =
                ErrorKind::Unexpected { found: format!("{} points", pairs.len()), expected: format!("at most {most}") };
            return Err(line.error(0, kind));
        }
    }
    Ok(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<f64>, Error> {
        let lines: Vec<_> = (1..).zip(text.lines()).map(|(number, text)| Line { number, text }).collect();
        ordinates(&lines, 1000).map(|o| o.values)
    }

    /// The example of the standard (McDonald & Wilks 1988, Table VII): one series in each of the forms.
    #[test]
    fn all_forms_hold_the_same_numbers() {
        let expected = vec![1.0, 2.0, 3.0, 3.0, 2.0, 1.0, 0.0, -1.0, -2.0, -3.0];
        for text in [
            "0 1 2 3 3 2 1 0 -1 -2 -3",
            "0+1+2+3+3+2+1+0-1-2-3",
            "0ABCCBA@abc",
            "0AJJ%jjjjjj",
            "0ABCTBA@abc",
            "0AJT%jX",
            "0AJT%jT\n5AjT\n7ajT",
            "0 1.0E+00 2 3 3 2 1 0 -1 -2 -30E-01",
        ] {
            assert_eq!(read(text), Ok(expected.clone()), "{text}");
        }
    }

    #[test]
    fn larger_numbers() {
        assert_eq!(read("-227.8b6764b6121c0618"), Ok(vec![-26764.0, -26121.0, -30618.0]));
        assert_eq!(read("1B23N5U"), Ok(vec![223.0, 278.0, 333.0, 388.0]));
    }

    #[test]
    fn broken_lines_are_refused() {
        for (text, line, column) in [
            ("0AJJ\n2D", 2, 2),
            ("0S", 1, 2),
            ("0J", 1, 2),
            ("0A?", 1, 3),
            ("0A T0000", 1, 4),
            ("0A&", 1, 3),
            ("0AZ999999999", 1, 3),
        ] {
            let error = read(text).expect_err(text);
            assert_eq!((error.location().line, error.location().column), (Some(line), Some(column)), "{text}: {error}");
        }
    }
}

//! The numbers of a file one after another, each error with its place.

use super::super::error::{Error, ErrorKind};
use super::super::text::place;
use super::number::{is_delimiter, number_at, token_end};

/// A cursor over the numbers behind the TILT line. Lines mean nothing there: numbers may be wrapped anywhere.
#[derive(Debug, Clone)]
pub(super) struct Numbers<'t> {
    text: &'t str,
    at: usize,
}

impl<'t> Numbers<'t> {
    /// The numbers from an offset of the text on.
    pub(super) fn new(text: &'t str, at: usize) -> Self {
        Self { text, at }
    }

    /// The offset behind the last number taken.
    pub(super) fn offset(&self) -> usize {
        self.at
    }

    /// The offset of the next number.
    pub(super) fn peek(&self) -> usize {
        let mut ahead = self.clone();
        ahead.skip();
        ahead.at
    }

    /// Skips delimiters; `false` where more than one comma stands between two numbers.
    #[inline]
    fn skip(&mut self) -> bool {
        let bytes = self.text.as_bytes();
        let mut commas = 0;
        while let Some(&byte) = bytes.get(self.at) {
            if !is_delimiter(byte) {
                break;
            }
            commas += u32::from(byte == b',');
            self.at += 1;
        }
        commas < 2
    }

    /// The next number, `index` (from 0) of `expected` that make up `field`.
    #[inline]
    pub(super) fn next(&mut self, field: &str, index: usize, expected: usize) -> Result<f64, Error> {
        if self.skip()
            && let Some((value, end)) = number_at(self.text.as_bytes(), self.at)
        {
            self.at = end;
            return Ok(value);
        }
        Err(self.error(field, index, expected))
    }

    /// As many numbers as announced, but no more are reserved than the rest of the text can hold.
    pub(super) fn take(&mut self, field: &str, count: usize) -> Result<Vec<f64>, Error> {
        if count > self.room() {
            let start = self.clone();
            for index in 0..count {
                self.next(field, index, count)?;
            }
            // Not reached: the text has no room for so many numbers.
            return Err(start.error(field, 0, count));
        }
        let mut values = Vec::with_capacity(count);
        for index in 0..count {
            values.push(self.next(field, index, count)?);
        }
        Ok(values)
    }

    /// The most numbers that the rest of the text can hold: each takes a digit and a delimiter.
    fn room(&self) -> usize {
        (self.text.len() - self.at) / 2 + 1
    }

    #[cold]
    fn error(&self, field: &str, index: usize, expected: usize) -> Error {
        let location = place(self.text, self.at);
        let field_of = || match expected {
            1 => field.to_owned(),
            _ => format!("{field} (number {} of {expected})", index + 1),
        };
        if self.at >= self.text.len() {
            return Error::new(location, ErrorKind::TooFew { found: index, expected, field: field.to_owned() });
        }
        let bytes = self.text.as_bytes();
        let before = self.text[..self.at].trim_end_matches(|c: char| u8::try_from(c).is_ok_and(is_delimiter)).len();
        if self.text[before..self.at].matches(',').count() > 1 {
            let kind = ErrorKind::NotANumber { found: ",,".to_owned(), field: field_of() };
            return Error::new(location, kind).with_hint("a value is missing between two commas");
        }
        let token = &self.text[self.at..token_end(bytes, self.at)];
        let found: String = token.chars().take(40).collect();
        let bare = token.trim_start_matches(['+', '-']).to_ascii_lowercase();
        let numeric = bare.replace('d', "e").parse::<f64>().is_ok_and(|v| !v.is_finite());
        if numeric || ["nan", "inf", "1.#", "#nan", "-nan"].iter().any(|word| bare.starts_with(word)) {
            return Error::new(location, ErrorKind::NotFinite { found, field: field_of() });
        }
        Error::new(location, ErrorKind::NotANumber { found, field: field_of() })
    }
}

/// What follows the table.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Rest {
    /// How many more numbers, and where the first stands.
    pub(super) numbers: Option<(usize, usize)>,
    /// Where text begins.
    pub(super) text: Option<usize>,
}

/// Looks at what follows the table: on its line, or on whole lines of numbers, more numbers; text otherwise.
pub(super) fn rest(text: &str, at: usize) -> Rest {
    let bytes = text.as_bytes();
    let mut found = Rest::default();
    let mut line = at;
    while line < bytes.len() {
        let end = bytes[line..].iter().position(|b| matches!(b, b'\n' | b'\r')).map_or(bytes.len(), |n| line + n);
        let mut i = line;
        let (mut count, mut first) = (0, line);
        loop {
            while i < end && is_delimiter(bytes[i]) {
                i += 1;
            }
            if i >= end {
                break;
            }
            match number_at(&bytes[..end], i) {
                Some((_, behind)) => {
                    first = if count == 0 { i } else { first };
                    count += 1;
                    i = behind;
                }
                None => {
                    // A sentence may begin with a number, but not on the table's own line.
                    let own = line == at && count > 0;
                    if own {
                        found.numbers.get_or_insert((0, first)).0 += count;
                    }
                    found.text = Some(if own || count == 0 { i } else { first });
                    return found;
                }
            }
        }
        if count > 0 {
            found.numbers.get_or_insert((0, first)).0 += count;
        }
        line = end + 1;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn announced_numbers_are_not_reserved_before_they_are_there() {
        let error = Numbers::new("1 2 3", 0).take("vertical angles", 1 << 40).expect_err("too few");
        let expected = ErrorKind::TooFew { found: 3, expected: 1 << 40, field: "vertical angles".into() };
        assert_eq!(error.kind(), &expected);
    }

    #[test]
    fn each_error_names_the_number_and_its_place() {
        let message = |text| Numbers::new(text, 0).take("candela", 3).expect_err("an error").to_string();
        assert_eq!(message("1 2\nx 4"), "2:1: found `x`; expected a number for candela (number 3 of 3)");
        assert!(message("1,,2,3").contains("between two commas"));
        assert!(message("1 NaN 3").contains("finite"));
        assert!(message("1 1e999 3").contains("finite"));
        assert!(message("1 1.#QNAN 3").contains("finite"));
    }

    #[test]
    fn what_follows_the_table_is_told_apart() {
        assert_eq!(rest("1 2  \r\n\n", 3), Rest::default());
        assert_eq!(rest("1 2\nEND 5", 3), Rest { numbers: None, text: Some(4) });
        assert_eq!(rest("1 2 3\n4 5\n", 3), Rest { numbers: Some((3, 4)), text: None });
        assert_eq!(rest("1 2\n2019 by me", 3), Rest { numbers: None, text: Some(4) });
        assert_eq!(rest("1 2 3 x", 3), Rest { numbers: Some((1, 4)), text: Some(6) });
    }
}

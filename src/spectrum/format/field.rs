//! Splitting a line into cells, keeping where each stands.
//!
//! The csv crate reads the same quoting but does not tell the column of a cell, and takes an unclosed quotation mark as the
//! beginning of a cell that swallows the rest of the file. Here each line stands for itself, so that one bad row costs one row.

use std::borrow::Cow;

/// What stands between two cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    /// Exactly one of this ASCII character.
    Byte(u8),
    /// One or more blanks or tabs.
    Blanks,
}

impl Separator {
    /// The separator that a user or a `sep=` line names; any blank but TAB means runs of blanks.
    pub(super) fn from_char(c: char) -> Option<Self> {
        match c {
            ' ' => Some(Self::Blanks),
            c if c.is_ascii() && !c.is_ascii_alphanumeric() && !matches!(c, '"' | '\n' | '\r' | '.' | '+' | '-') => {
                Some(Self::Byte(c as u8))
            }
            _ => None,
        }
    }
}

/// One cell of a line: its text without blanks around it, and the byte where that begins in the line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Field<'a> {
    pub raw: &'a str,
    pub start: usize,
    pub quoted: bool,
    pub unclosed: bool,
}

impl<'a> Field<'a> {
    /// The text with doubled quotation marks undone.
    pub(super) fn text(&self) -> Cow<'a, str> {
        if self.quoted && self.raw.contains("\"\"") { self.raw.replace("\"\"", "\"").into() } else { self.raw.into() }
    }
}

/// The cells of a line, in order. A line that ends in a separator has an empty last cell; blanks never do.
pub(super) struct Fields<'a> {
    line: &'a str,
    at: usize,
    separator: Separator,
    ended: bool,
}

pub(super) fn split(line: &str, separator: Separator) -> Fields<'_> {
    Fields { line, at: 0, separator, ended: false }
}

impl<'a> Fields<'a> {
    fn is_blank(&self, byte: u8) -> bool {
        matches!(byte, b' ' | b'\r') || (byte == b'\t' && self.separator != Separator::Byte(b'\t'))
    }

    fn ends(&self, byte: u8) -> bool {
        match self.separator {
            Separator::Byte(separator) => byte == separator,
            Separator::Blanks => matches!(byte, b' ' | b'\t' | b'\r'),
        }
    }

    /// The cell that begins with the quotation mark at `open`; `None` where text follows its end, as in `"a" b`.
    fn quoted(&mut self, open: usize) -> Option<Field<'a>> {
        let bytes = self.line.as_bytes();
        let mut close = open + 1;
        loop {
            match bytes.get(close) {
                None => {
                    self.ended = true;
                    return Some(Field { raw: &self.line[open + 1..], start: open, quoted: true, unclosed: true });
                }
                Some(b'"') if bytes.get(close + 1) == Some(&b'"') => close += 2,
                Some(b'"') => break,
                Some(_) => close += 1,
            }
        }
        let mut after = close + 1;
        while bytes.get(after).is_some_and(|b| self.is_blank(*b) && !self.ends(*b)) {
            after += 1;
        }
        match bytes.get(after) {
            None => self.ended = true,
            Some(byte) if self.ends(*byte) => self.at = after + 1,
            Some(_) => return None,
        }
        Some(Field { raw: &self.line[open + 1..close], start: open, quoted: true, unclosed: false })
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = Field<'a>;

    #[inline]
    fn next(&mut self) -> Option<Field<'a>> {
        if self.ended {
            return None;
        }
        let bytes = self.line.as_bytes();
        let mut start = self.at;
        while start < bytes.len() && self.is_blank(bytes[start]) {
            start += 1;
        }
        if start == bytes.len() && self.separator == Separator::Blanks {
            return None;
        }
        if bytes.get(start) == Some(&b'"')
            && let Some(field) = self.quoted(start)
        {
            return Some(field);
        }
        let end = bytes[start..].iter().position(|b| self.ends(*b)).map_or(bytes.len(), |n| start + n);
        self.ended = end == bytes.len();
        self.at = end + 1;
        let mut last = end;
        while last > start && self.is_blank(bytes[last - 1]) {
            last -= 1;
        }
        Some(Field { raw: &self.line[start..last], start, quoted: false, unclosed: false })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(line: &str, separator: Separator) -> Vec<(String, usize)> {
        split(line, separator).map(|f| (f.text().into_owned(), f.start)).collect()
    }

    fn owned(cells: &[(&str, usize)]) -> Vec<(String, usize)> {
        cells.iter().map(|(t, s)| ((*t).to_owned(), *s)).collect()
    }

    #[test]
    fn cells_keep_their_place() {
        let comma = Separator::Byte(b',');
        assert_eq!(cells("380, 0.1 ,", comma), owned(&[("380", 0), ("0.1", 5), ("", 10)]));
        assert_eq!(cells("\"a, \"\"b\"\"\" ,1", comma), owned(&[("a, \"b\"", 0), ("1", 12)]));
        assert_eq!(cells("5\" lamp,1", comma), owned(&[("5\" lamp", 0), ("1", 8)]));
        assert_eq!(cells("\"a\" b,1", comma), owned(&[("\"a\" b", 0), ("1", 6)]));
        assert_eq!(cells("", comma), owned(&[("", 0)]));
        assert_eq!(cells("a\t\tb", Separator::Byte(b'\t')), owned(&[("a", 0), ("", 2), ("b", 3)]));
        assert_eq!(cells("  380 \t 0,1  ", Separator::Blanks), owned(&[("380", 2), ("0,1", 8)]));
        assert!(split("\"a,b", comma).next().is_some_and(|f| f.unclosed));
    }
}

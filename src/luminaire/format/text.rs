//! From bytes to the text of a luminaire file: byte-order marks, UTF-16, Windows-1252, every kind of line end, Ctrl-Z.
//!
//! Text that is UTF-8 already (and so every ASCII file) is borrowed, not copied.

use std::borrow::Cow;

use encoding_rs::{Encoding, UTF_16BE, UTF_16LE, WINDOWS_1252};

use super::error::{Error, ErrorKind};
use crate::finding::{Finding, Location};

/// Text of a whole file, and the finding where its encoding had to be assumed.
#[derive(Debug)]
pub(super) struct Text<'a> {
    pub(super) text: Cow<'a, str>,
    pub(super) finding: Option<Finding>,
}

impl Text<'_> {
    /// All lines with their numbers.
    pub(super) fn lines(&self) -> Lines<'_> {
        Lines::new(&self.text)
    }
}

/// Files of other programs that users hand over by mistake, by their first bytes.
const SIGNATURES: [(&[u8], &str); 8] = [
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\xd0\xcf\x11\xe0", "an old Microsoft Office document"),
    (b"%PDF", "a PDF document"),
    (b"\x89PNG", "a PNG picture"),
    (b"\x89HDF", "an HDF5 file"),
    (b"\x76\x2f\x31\x01", "an OpenEXR picture"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"\xff\xd8\xff", "a JPEG picture"),
];

/// Decodes a whole file. What ends it for DOS (Ctrl-Z, zero padding) is cut off where nothing but blanks follows.
pub(super) fn decode(bytes: &[u8]) -> Result<Text<'_>, Error> {
    if let Some(&(_, found)) = SIGNATURES.iter().find(|(start, _)| bytes.starts_with(start)) {
        return Err(Error::new(Location::default(), ErrorKind::NotText { found })
            .with_hint("give the IES, LDT or XML file itself (unpacked)"));
    }
    let mut finding = None;
    let text: Cow<'_, str> = if let Some(encoding) = utf16(bytes) {
        let (text, malformed) = encoding.decode_with_bom_removal(bytes);
        if malformed {
            return Err(Error::new(Location::default(), ErrorKind::NotText { found: "malformed UTF-16" }));
        }
        text
    } else {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        match std::str::from_utf8(bytes) {
            Ok(text) => text.into(),
            Err(error) => {
                let place = place(&String::from_utf8_lossy(&bytes[..error.valid_up_to()]), error.valid_up_to());
                finding = Some(
                    Finding::info("L101", "the text is not UTF-8 and was read as Windows-1252 (Latin-1)").at(place),
                );
                WINDOWS_1252.decode_without_bom_handling(bytes).0
            }
        }
    };
    let text = without_end_mark(text);
    if let Some(at) = text.find('\0') {
        let found = "a NUL character (a binary file)";
        return Err(Error::new(place(&text, at), ErrorKind::NotText { found }));
    }
    if text.trim().is_empty() {
        return Err(Error::new(Location::default(), ErrorKind::Empty));
    }
    Ok(Text { text, finding })
}

/// The UTF-16 variant that the first bytes tell, by mark or by the zero halves of ASCII characters.
fn utf16(bytes: &[u8]) -> Option<&'static Encoding> {
    match bytes {
        [0xff, 0xfe, ..] => Some(UTF_16LE),
        [0xfe, 0xff, ..] => Some(UTF_16BE),
        [a, 0, b, 0, ..] if *a != 0 && *b != 0 => Some(UTF_16LE),
        [0, a, 0, b, ..] if *a != 0 && *b != 0 => Some(UTF_16BE),
        _ => None,
    }
}

/// Cuts off Ctrl-Z, zero bytes and blanks at the end, if there is a Ctrl-Z or zero byte among them.
fn without_end_mark(text: Cow<'_, str>) -> Cow<'_, str> {
    let end = text.trim_end_matches(|c: char| c == '\u{1a}' || c == '\0' || c.is_ascii_whitespace()).len();
    if !text[end..].contains(['\u{1a}', '\0']) {
        return text;
    }
    match text {
        Cow::Borrowed(text) => Cow::Borrowed(&text[..end]),
        Cow::Owned(mut text) => {
            text.truncate(end);
            Cow::Owned(text)
        }
    }
}

/// Where a byte offset of a text lies; lines end with LF, CRLF or CR.
pub(super) fn place(text: &str, offset: usize) -> Location {
    let before = text.get(..offset).unwrap_or(text);
    let bytes = before.as_bytes();
    let ends = |at: usize| match bytes[at] {
        b'\n' => true,
        // The CR of a CRLF ends no line by itself, even where the offset lies between the two.
        b'\r' => text.as_bytes().get(at + 1) != Some(&b'\n'),
        _ => false,
    };
    let count = (0..bytes.len()).filter(|&at| ends(at)).count() as u64;
    let start = (0..bytes.len()).rev().find(|&at| ends(at)).map_or(0, |at| at + 1);
    Location::at(1 + count, 1 + before[start..].chars().count() as u64)
}

/// A line without its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Line<'t> {
    /// Number, from 1.
    pub(super) number: u64,
    /// Byte offset of its first character in the text.
    pub(super) offset: usize,
    /// The characters before LF, CRLF or CR.
    pub(super) text: &'t str,
}

impl Line<'_> {
    /// The place of a byte offset within the line.
    pub(super) fn at(&self, offset: usize) -> Location {
        let before = self.text.get(..offset).unwrap_or(self.text);
        Location::at(self.number, 1 + before.chars().count() as u64)
    }
}

/// The lines of a text, ended by LF, CRLF or CR, also mixed.
#[derive(Debug, Clone)]
pub(super) struct Lines<'t> {
    text: &'t str,
    offset: usize,
    number: u64,
}

impl<'t> Lines<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        Self { text, offset: 0, number: 0 }
    }

    /// Byte offset of the next line.
    pub(super) fn offset(&self) -> usize {
        self.offset
    }
}

impl<'t> Iterator for Lines<'t> {
    type Item = Line<'t>;

    fn next(&mut self) -> Option<Line<'t>> {
        let rest = &self.text[self.offset..];
        if rest.is_empty() {
            return None;
        }
        let bytes = rest.as_bytes();
        let end = bytes.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(bytes.len());
        let mark = match bytes[end..] {
            [b'\r', b'\n', ..] => 2,
            [] => 0,
            _ => 1,
        };
        let offset = self.offset;
        self.offset += end + mark;
        self.number += 1;
        Some(Line { number: self.number, offset, text: &rest[..end] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<(u64, String)> {
        decode(bytes).expect("text").lines().map(|l| (l.number, l.text.to_owned())).collect()
    }

    #[test]
    fn line_ends_of_every_kind_count_the_same() {
        let expected: Vec<(u64, String)> =
            [(1, "a"), (2, ""), (3, "b"), (4, "c")].map(|(n, t)| (n, t.to_owned())).into();
        for text in ["a\n\nb\nc", "a\r\n\r\nb\r\nc\r\n", "a\r\rb\rc", "a\r\n\rb\nc\r", "a\n\nb\nc\n\u{1a}\0\0"] {
            assert_eq!(lines(text.as_bytes()), expected, "{text:?}");
        }
        for (text, offset, at) in [("a\r\nbc", 4, (2, 2)), ("a\rbc", 3, (2, 2)), ("é\nü", 3, (2, 1)), ("ab", 9, (1, 3))]
        {
            assert_eq!(place(text, offset), Location::at(at.0, at.1), "{text:?}");
        }
    }

    #[test]
    fn encodings_give_the_same_text_and_ascii_is_borrowed() {
        assert!(matches!(decode(b"IESNA:LM-63-2002\x1a").expect("text").text, Cow::Borrowed("IESNA:LM-63-2002")));
        let expected = vec![(1, "Größe".to_owned()), (2, "2".to_owned())];
        let wide: Vec<u16> = "Größe\n2".encode_utf16().collect();
        let le: Vec<u8> = [0xff, 0xfe].into_iter().chain(wide.iter().flat_map(|u| u.to_le_bytes())).collect();
        let be: Vec<u8> = wide.iter().flat_map(|u| u.to_be_bytes()).collect();
        for bytes in [&b"\xef\xbb\xbfGr\xc3\xb6\xc3\x9fe\n2"[..], b"Gr\xf6\xdfe\n2", &le, &be] {
            assert_eq!(lines(bytes), expected);
        }
        let assumed = decode(b"x\nGr\xf6\xdfe").expect("text").finding.expect("a finding");
        assert_eq!((assumed.code, assumed.location), ("L101", Location::at(2, 3)));
    }

    #[test]
    fn what_is_no_text_is_refused() {
        for bytes in [&b""[..], b"  \r\n", b"\x1a", b"PK\x03\x04....", b"abc\0def", b"\xff\xfe\x00\xd8"] {
            assert!(decode(bytes).is_err(), "{bytes:?}");
        }
    }
}

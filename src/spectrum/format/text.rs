//! From bytes to text: byte-order marks, UTF-16, Windows-1252, old line ends; and places in text.

use std::borrow::Cow;
use std::io::{self, Read};

use encoding_rs::{Decoder, Encoding, UTF_16BE, UTF_16LE, WINDOWS_1252};

use super::error::{Error, ErrorKind};
use crate::finding::{Finding, Location};

/// Text of a whole input, and the finding where its encoding had to be assumed.
pub(super) struct Text<'a> {
    pub text: Cow<'a, str>,
    pub finding: Option<Finding>,
}

/// Files of other programs that users hand over by mistake, by their first bytes.
const SIGNATURES: [(&[u8], &str); 8] = [
    (b"PK\x03\x04", "a ZIP archive or Excel workbook (.xlsx)"),
    (b"\xd0\xcf\x11\xe0", "an Excel workbook (.xls)"),
    (b"%PDF", "a PDF document"),
    (b"\x89PNG", "a PNG picture"),
    (b"\x89HDF", "an HDF5 file"),
    (b"\x76\x2f\x31\x01", "an OpenEXR picture"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"\xff\xd8\xff", "a JPEG picture"),
];

/// Refuses input that begins like a well-known binary format.
pub(super) fn refuse_signatures(bytes: &[u8]) -> Result<(), Error> {
    match SIGNATURES.iter().find(|(start, _)| bytes.starts_with(start)) {
        Some(&(_, found)) => {
            Err(Error::whole(ErrorKind::NotText { found }).with_hint("save the spectrum as CSV and give that file"))
        }
        None => Ok(()),
    }
}

/// The UTF-16 variant that the first bytes tell, by mark or by the zero halves of ASCII characters.
pub(super) fn utf16(bytes: &[u8]) -> Option<&'static Encoding> {
    match bytes {
        [0xff, 0xfe, ..] => Some(UTF_16LE),
        [0xfe, 0xff, ..] => Some(UTF_16BE),
        [a, 0, b, 0, ..] if *a != 0 && *b != 0 => Some(UTF_16LE),
        [0, a, 0, b, ..] if *a != 0 && *b != 0 => Some(UTF_16BE),
        _ => None,
    }
}

/// Decodes a whole input.
pub(super) fn decode(bytes: &[u8]) -> Result<Text<'_>, Error> {
    refuse_signatures(bytes)?;
    let mut finding = None;
    let text: Cow<'_, str> = if let Some(encoding) = utf16(bytes) {
        let (text, malformed) = encoding.decode_with_bom_removal(bytes);
        if malformed {
            return Err(Error::whole(ErrorKind::NotText { found: "malformed UTF-16" }));
        }
        text
    } else {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        match std::str::from_utf8(bytes) {
            Ok(text) => text.into(),
            Err(error) => {
                let line = 1 + bytes[..error.valid_up_to()].iter().filter(|b| **b == b'\n').count() as u64;
                finding = Some(windows_1252_finding(line));
                WINDOWS_1252.decode_without_bom_handling(bytes).0
            }
        }
    };
    if let Some(at) = text.find('\0') {
        return Err(Error::new(place(&text, 1, at), ErrorKind::NotText { found: "a NUL character (a binary file)" }));
    }
    Ok(Text { text: unix_lines(text), finding })
}

pub(super) fn windows_1252_finding(line: u64) -> Finding {
    Finding::info("S001", "the text is not UTF-8 and was read as Windows-1252 (Latin-1)").at(Location::line(line))
}

/// Decodes one line of a stream whose other lines may be in another encoding.
pub(super) fn decode_line(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(_) => WINDOWS_1252.decode_without_bom_handling(bytes).0,
    }
}

/// Carriage returns alone (classic Mac OS) become line feeds; the text keeps its length.
fn unix_lines(text: Cow<'_, str>) -> Cow<'_, str> {
    if !text.contains('\n') && text.contains('\r') { text.replace('\r', "\n").into() } else { text }
}

/// Where a byte offset of `text` lies, when `text` begins on `first_line`.
pub(super) fn place(text: &str, first_line: u64, offset: usize) -> Location {
    let before = text.get(..offset).unwrap_or(text);
    let start = before.rfind('\n').map_or(0, |at| at + 1);
    let line = first_line + before.bytes().filter(|b| *b == b'\n').count() as u64;
    Location::at(line, before[start..].chars().count() as u64 + 1)
}

/// Places of ascending byte offsets of one text: [`place`] for many cells of a long line without starting anew at each.
pub(super) struct Places<'a> {
    text: &'a str,
    at: usize,
    line: u64,
    column: u64,
}

impl<'a> Places<'a> {
    pub(super) fn new(text: &'a str, first_line: u64) -> Self {
        Self { text, at: 0, line: first_line, column: 1 }
    }

    pub(super) fn of(&mut self, offset: usize) -> Location {
        for c in self.text.get(self.at..offset).unwrap_or_default().chars() {
            (self.line, self.column) = if c == '\n' { (self.line + 1, 1) } else { (self.line, self.column + 1) };
        }
        self.at = offset;
        Location::at(self.line, self.column)
    }
}

/// A reader that hands out UTF-8 whatever of UTF-16, UTF-8 with mark or old line ends comes in. Bytes that are not UTF-8
/// pass unchanged: [`decode_line`] settles them.
pub(super) struct Utf8Reader<R> {
    inner: R,
    decoder: Option<Decoder>,
    raw: Vec<u8>,
    ready: Vec<u8>,
    taken: usize,
    started: bool,
    ended: bool,
    /// UTF-16 with a half character in it was met.
    pub malformed: bool,
}

/// Bytes taken from the inner reader at a time.
const BLOCK: usize = 256 * 1024;

impl<R: Read> Utf8Reader<R> {
    pub(super) fn new(inner: R) -> Self {
        Self {
            inner,
            decoder: None,
            raw: Vec::new(),
            ready: Vec::new(),
            taken: 0,
            started: false,
            ended: false,
            malformed: false,
        }
    }

    /// Reads into `self.raw` until `wanted` bytes are there or the input ends.
    fn fill_raw(&mut self, wanted: usize) -> io::Result<()> {
        while self.raw.len() < wanted && !self.ended {
            let before = self.raw.len();
            self.raw.resize(wanted, 0);
            let result = self.inner.read(&mut self.raw[before..]);
            self.raw.truncate(before + *result.as_ref().unwrap_or(&0));
            match result {
                Ok(0) => self.ended = true,
                Ok(_) => {}
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn start(&mut self) -> io::Result<()> {
        self.started = true;
        self.fill_raw(4)?;
        if let Some(encoding) = utf16(&self.raw) {
            self.decoder = Some(encoding.new_decoder_with_bom_removal());
        } else if self.raw.starts_with(b"\xef\xbb\xbf") {
            self.raw.drain(..3);
        }
        Ok(())
    }

    fn refill(&mut self) -> io::Result<()> {
        if !self.started {
            self.start()?;
        }
        self.ready.clear();
        self.taken = 0;
        self.fill_raw(BLOCK)?;
        let Some(decoder) = &mut self.decoder else {
            std::mem::swap(&mut self.ready, &mut self.raw);
            return Ok(());
        };
        let room = decoder.max_utf8_buffer_length(self.raw.len()).unwrap_or(4 * BLOCK);
        self.ready.resize(room, 0);
        let (_, read, written, malformed) = decoder.decode_to_utf8(&self.raw, &mut self.ready, self.ended);
        self.malformed |= malformed;
        self.ready.truncate(written);
        self.raw.drain(..read);
        Ok(())
    }
}

impl<R: Read> Read for Utf8Reader<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        // A block of UTF-16 may decode to nothing (half a character): only the end of the input may return zero.
        while self.taken == self.ready.len() && !(self.ended && self.started && self.raw.is_empty()) {
            self.refill()?;
        }
        let count = out.len().min(self.ready.len() - self.taken);
        out[..count].copy_from_slice(&self.ready[self.taken..self.taken + count]);
        self.taken += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_characters_and_lines() {
        let text = "µ,b\nçd,e";
        let mut places = Places::new(text, 7);
        for (offset, line, column) in [(0, 7, 1), (3, 7, 3), (5, 8, 1), (7, 8, 2), (9, 8, 4)] {
            assert_eq!(place(text, 7, offset), Location::at(line, column), "{offset}");
            assert_eq!(places.of(offset), Location::at(line, column), "{offset}");
        }
        // Inside of a character and beyond the end: a place all the same.
        assert_eq!(place(text, 1, 1).line, Some(2));
        assert_eq!(place(text, 1, 99).line, Some(2));
    }

    #[test]
    fn encodings_are_told() {
        let text = |bytes: &[u8]| decode(bytes).map(|t| (t.text.into_owned(), t.finding.is_some()));
        assert_eq!(text(b"a\xb5b"), Ok(("aµb".to_owned(), true)));
        assert_eq!(text("aµb".as_bytes()), Ok(("aµb".to_owned(), false)));
        assert_eq!(text(b"\xef\xbb\xbfa"), Ok(("a".to_owned(), false)));
        assert_eq!(text(b"\xff\xfea\0\xb5\0"), Ok(("aµ".to_owned(), false)));
        assert_eq!(text(b"a\0b\0"), Ok(("ab".to_owned(), false)));
        assert_eq!(text(b"\0a\0b"), Ok(("ab".to_owned(), false)));
        assert_eq!(text(b"a\rb\r"), Ok(("a\nb\n".to_owned(), false)));
        assert!(text(b"ab\0cd").is_err());
        assert!(text(b"\xd0\xcf\x11\xe0rest").is_err());
    }
}

//! From bytes to [`RawIes`].

use std::borrow::Cow;

use super::super::error::Error;
use super::super::text::{Text, decode, place};
use super::RawIes;
use super::header::header;
use super::table::Reader;
use crate::finding::{Checked, Finding};

/// How to read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Repair what can be repaired safely, and list each repair: numbers after the table are left out, a missing nadir row
    /// is added, a factor of 0 is taken as 1. Without it such files are refused or read as they stand.
    pub repair: bool,
}

/// Reads a file as it stands.
///
/// # Errors
/// As [`parse_with`].
pub fn parse(bytes: &[u8]) -> Result<Checked<RawIes>, Error> {
    parse_with(bytes, ReadOptions::default())
}

/// Reads a file with options.
///
/// # Errors
/// Anything that leaves a value in doubt: no TILT line, a token that is no number, NaN, counts that contradict the numbers
/// given, an unknown photometric type or unit, angles out of order or range. Each with its place and what was expected.
pub fn parse_with(bytes: &[u8], options: ReadOptions) -> Result<Checked<RawIes>, Error> {
    parse_text(&decode(bytes)?, options)
}

/// The same from text.
pub(in super::super) fn parse_text(decoded: &Text<'_>, options: ReadOptions) -> Result<Checked<RawIes>, Error> {
    let mut findings: Vec<Finding> = decoded.finding.iter().cloned().collect();
    let header = header(decoded, &mut findings)?;
    let text: &str = &decoded.text;
    let start = header.numbers;
    let mut reader = Reader::new(text, options);
    match reader.file(&header) {
        Ok(value) => {
            findings.append(&mut reader.findings);
            Ok(Checked { value, findings })
        }
        Err(error) => {
            // Commas are delimiters, but some programs write them for points: only where nothing else makes sense.
            let Some(swapped) = decimal_commas(text, start) else { return Err(error) };
            let mut reader = Reader::new(&swapped, options);
            let Ok(value) = reader.file(&header) else { return Err(error) };
            let message = "the numbers have decimal commas, where LM-63 has points; read as such because the file makes sense in no other way";
            findings.push(Finding::warning("L012", message).at(place(text, start)));
            findings.append(&mut reader.findings);
            Ok(Checked { value, findings })
        }
    }
}

/// The text with points for commas within numbers, if it has such commas and no points; offsets stay.
fn decimal_commas(text: &str, start: usize) -> Option<Cow<'_, str>> {
    let bytes = text.as_bytes();
    let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let within = |at: usize, byte: u8| bytes[at] == byte && at > start && digit(at - 1) && digit(at + 1);
    if !(start..bytes.len()).any(|at| within(at, b',')) || (start..bytes.len()).any(|at| within(at, b'.')) {
        return None;
    }
    let mut swapped = bytes.to_vec();
    for at in (start..bytes.len()).filter(|&at| within(at, b',')) {
        swapped[at] = b'.';
    }
    String::from_utf8(swapped).ok().map(Cow::Owned)
}

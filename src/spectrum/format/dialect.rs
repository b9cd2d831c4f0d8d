//! How a delimited text is written: its records, what separates their cells, and its decimal mark.
//!
//! The rule, where neither the user nor a `sep=` line says it: of TAB, `;`, `,` and runs of blanks, the separator is the one
//! under which the longest run of neighbouring lines has the same number (two or more) of cells with numbers among them; of
//! several with equally long runs, the first in this order. Under all but `,` a comma in a number is the decimal mark, if no
//! number of the run has a point. A comma is never a thousands mark.

use super::ReadOptions;
use super::error::{Error, ErrorKind};
use super::field::{Separator, split};
use super::number::{self, Cell};
use super::text::place;
use crate::finding::Location;

/// One line that is neither blank nor comment; a heading may hold line feeds inside of quotation marks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Record<'a> {
    /// Line on which it begins, from 1.
    pub line: u64,
    pub text: &'a str,
}

impl Record<'_> {
    /// Where a byte of the record lies.
    pub(super) fn place(&self, byte: usize) -> Location {
        place(self.text, self.line, byte)
    }

    /// An error at a byte of the record.
    pub(super) fn error(&self, byte: usize, kind: ErrorKind) -> Error {
        Error::new(self.place(byte), kind)
    }
}

/// The lines of a text, sorted.
pub(super) struct Lines<'a> {
    pub records: Vec<Record<'a>>,
    /// Comment lines without their mark, and the number of records before each.
    pub comments: Vec<(Record<'a>, usize)>,
    /// Separator of a leading `sep=` line.
    pub declared: Option<char>,
}

/// The text after a comment mark.
pub(super) fn comment(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let marks = ["#", "%", "//", "!"];
    marks
        .iter()
        .find_map(|mark| line.strip_prefix(mark))
        .map(|rest| rest.trim_start_matches(['#', '%', '!', '/']).trim())
}

/// Sorts the lines of `text`, the first of which is line `first_line` of the input.
pub(super) fn lines(text: &str, first_line: u64) -> Lines<'_> {
    let mut out = Lines { records: Vec::new(), comments: Vec::new(), declared: None };
    for (line, text) in (first_line..).zip(text.lines()) {
        if text.trim().is_empty() {
            continue;
        }
        if let Some(text) = comment(text) {
            out.comments.push((Record { line, text }, out.records.len()));
        } else if let Some(separator) = declared_separator(text).filter(|_| line == 1) {
            out.declared = Some(separator);
        } else {
            out.records.push(Record { line, text });
        }
    }
    out
}

fn declared_separator(line: &str) -> Option<char> {
    let rest = line.trim_matches(['"', '\r']);
    let rest = rest.get(..4).filter(|start| start.eq_ignore_ascii_case("sep="))?.len();
    let mut chars = line.trim_matches(['"', '\r'])[rest..].chars();
    chars.next().filter(|_| chars.next().is_none())
}

/// Joins records whose quotation marks span lines, as headings of spreadsheets do.
pub(super) fn join_quoted<'a>(
    text: &'a str,
    records: &[Record<'a>],
    separator: Separator,
) -> Result<Vec<Record<'a>>, Error> {
    const MOST: usize = 16;
    if !text.contains('"') {
        return Ok(records.to_vec());
    }
    let mut out = Vec::with_capacity(records.len());
    let mut rest = records;
    while let Some((first, after)) = rest.split_first() {
        rest = after;
        let mut joined = *first;
        let mut taken = 0;
        while let Some(open) = split(joined.text, separator).find(|f| f.unclosed) {
            let Some(next) = rest.get(taken).filter(|_| taken < MOST) else {
                return Err(first.error(open.start, ErrorKind::UnclosedQuote));
            };
            let start = offset(text, first.text);
            joined.text = &text[start..offset(text, next.text) + next.text.len()];
            taken += 1;
        }
        rest = &rest[taken..];
        out.push(joined);
    }
    Ok(out)
}

/// Where a slice of `text` begins in it.
fn offset(text: &str, part: &str) -> usize {
    part.as_ptr() as usize - text.as_ptr() as usize
}

/// Separator and decimal mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Dialect {
    pub separator: Separator,
    pub decimal: char,
}

/// Records looked at to find the separator.
const SAMPLE: usize = 4000;

impl Dialect {
    /// Finds how `records` are written.
    pub(super) fn find(records: &[Record<'_>], declared: Option<char>, options: &ReadOptions) -> Result<Self, Error> {
        let given = options.separator.or(declared);
        let separators = match given {
            Some(c) => vec![Separator::from_char(c).ok_or_else(|| {
                Error::whole(ErrorKind::Unexpected {
                    found: format!("the separator `{c}`"),
                    expected: "a tab, a blank, `,`, `;` or another ASCII sign".to_owned(),
                })
            })?],
            None => vec![Separator::Byte(b'\t'), Separator::Byte(b';'), Separator::Byte(b','), Separator::Blanks],
        };
        let sample = &records[..records.len().min(SAMPLE)];
        let mut best: Option<(Separator, Run)> = None;
        for separator in separators {
            let run = Run::longest(sample, separator, options.decimal);
            if best.as_ref().is_none_or(|(_, b)| run.length > b.length) {
                best = Some((separator, run));
            }
        }
        // The list of separators is never empty.
        let Some((separator, run)) = best else { return Err(Error::whole(ErrorKind::Empty)) };
        if given.is_none() && options.decimal.is_none() && separator == Separator::Byte(b',') {
            refuse_ambiguous_commas(records, &run)?;
        }
        let decimal = match options.decimal {
            Some(c @ ('.' | ',')) => c,
            Some(c) => {
                return Err(Error::whole(ErrorKind::Unexpected {
                    found: format!("the decimal mark `{c}`"),
                    expected: "`.` or `,`".to_owned(),
                }));
            }
            None => decimal(&sample[run.start..run.start + run.length], separator),
        };
        Ok(Self { separator, decimal })
    }
}

/// Neighbouring records with the same number of cells.
struct Run {
    start: usize,
    length: usize,
    cells: usize,
}

impl Run {
    fn longest(records: &[Record<'_>], separator: Separator, decimal: Option<char>) -> Self {
        let mut best = Self { start: 0, length: 0, cells: 0 };
        let mut current = Self { start: 0, length: 0, cells: 0 };
        for (index, record) in records.iter().enumerate() {
            let cells = numeric_cells(record.text, separator, decimal).unwrap_or(0);
            if cells == 0 || cells != current.cells {
                current = Self { start: index, length: 0, cells };
            }
            if cells > 0 {
                current.length += 1;
            }
            if current.length > best.length {
                best = Self { ..current };
            }
        }
        best
    }
}

/// The number of cells of a line, where there are two or more with at least one number and none that is a number cut at the
/// wrong places.
fn numeric_cells(line: &str, separator: Separator, decimal: Option<char>) -> Option<usize> {
    let mut cells = 0;
    let mut numbers = 0;
    for field in split(line, separator) {
        cells += 1;
        let commas = field.quoted || separator != Separator::Byte(b',');
        let number = (decimal != Some(',')
            && matches!(number::parse(field.raw, '.'), Cell::Number(_) | Cell::NotFinite))
            || (commas && decimal != Some('.') && matches!(number::parse(field.raw, ','), Cell::Number(_)));
        if number {
            numbers += 1;
        } else if looks_cut(field.raw) {
            return None;
        }
    }
    (cells >= 2 && numbers >= 1).then_some(cells)
}

/// Digits with separators between them.
fn looks_cut(cell: &str) -> bool {
    cell.bytes().any(|b| b.is_ascii_digit())
        && cell
            .bytes()
            .all(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b',' | b';' | b'e' | b'E' | b' ' | b'\t'))
}

fn decimal(records: &[Record<'_>], separator: Separator) -> char {
    let mut comma = false;
    for record in records {
        for field in split(record.text, separator) {
            if field.raw.contains('.') && number::parse(field.raw, '.').number().is_some() {
                return '.';
            }
            comma |= field.raw.contains(',') && number::parse(field.raw, ',').number().is_some();
        }
    }
    if comma { ',' } else { '.' }
}

/// `380,1,5` may be 380 with 1 and 5, 380.1 with 5 or 380 with 1.5. A point anywhere, a label in front or a heading with as
/// many cells settles it.
fn refuse_ambiguous_commas(records: &[Record<'_>], run: &Run) -> Result<(), Error> {
    let separator = Separator::Byte(b',');
    let data = &records[run.start..run.start + run.length];
    let Some(first) = data.first().filter(|_| run.cells > 2) else { return Ok(()) };
    let heading = run.start.checked_sub(1).map(|at| &records[at]);
    let headed = heading.is_some_and(|r| split(r.text, separator).count() == run.cells);
    let mut integers = true;
    for record in data {
        for field in split(record.text, separator) {
            let digits = field.raw.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-'));
            integers &= digits && !field.quoted;
        }
    }
    if headed || !integers {
        return Ok(());
    }
    let found = format!("{} integers between commas and no heading: some commas may be decimal marks", run.cells);
    Err(first.error(0, ErrorKind::Ambiguous { found }).with_hint("say --separator or --decimal"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(text: &str) -> Result<Dialect, Error> {
        let lines = lines(text, 1);
        Dialect::find(&lines.records, lines.declared, &ReadOptions::default())
    }

    #[test]
    fn separators_and_decimal_marks_are_found() {
        let byte = Separator::Byte;
        for (text, separator, decimal) in [
            ("380,0.1\n381,0.2\n", byte(b','), '.'),
            ("380;0,1\n381;0,2\n", byte(b';'), ','),
            ("380,5;0,1\n", byte(b';'), ','),
            ("380\t0.1\n381\t0.2\n", byte(b'\t'), '.'),
            ("380 0.1\n381  0.2\n", Separator::Blanks, '.'),
            ("380,5 0,1\n381,5 0,2\n", Separator::Blanks, ','),
            ("380, 0.1\n381, 0.2\n", byte(b','), '.'),
            ("\"380,5\",\"0,1\"\n\"381,5\",\"0,2\"\n", byte(b','), ','),
            ("sep=;\n380;0\n", byte(b';'), '.'),
            ("Gain 5\nAverages 3\nwl,v\n380,0.1\n381,0.2\n382,0.2\n", byte(b','), '.'),
            ("name;380;381\nLamp A;0,1;0,2\n", byte(b';'), ','),
            ("Lamp 1,0.1,0.2\nLamp 2,0.1,0.2\n", byte(b','), '.'),
            ("380,1\n381,2\n", byte(b','), '.'),
            ("wl,a,b\n380,1,5\n", byte(b','), '.'),
        ] {
            assert_eq!(find(text), Ok(Dialect { separator, decimal }), "{text}");
        }
        let error = find("380,1,5\n381,1,6\n").unwrap_err();
        assert!(matches!(error.kind(), ErrorKind::Ambiguous { .. }), "{error}");
    }
}

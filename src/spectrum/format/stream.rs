//! Reading without holding everything: tables of rows come in batches, everything else whole.

use std::fmt;
use std::io::Read;
use std::sync::Arc;

use rayon::prelude::*;

use super::super::{Grid, Quantity, SpectralUnit};
use super::delimited::{self, Head};
use super::dialect::{self, Record};
use super::error::{Error, ErrorKind};
use super::resolve::Scale;
use super::rows::{Negatives, Row, RowTable};
use super::text::{self, Utf8Reader};
use super::{Format, ReadOptions, SpectrumFile, detect, item, read};
use crate::finding::{Checked, Finding, Location};

/// Largest input held whole, bytes of UTF-8.
pub const LARGEST_WHOLE: u64 = 1 << 30;

/// Longest row of a stream, bytes.
pub const LONGEST_ROW: usize = 64 << 20;

/// Bytes in which the format and the heading are looked for.
const HEAD: usize = 1 << 20;

/// Bytes of rows held at a time, however many rows are asked for.
const BATCH: usize = 16 << 20;

/// An input, opened.
#[derive(Debug)]
pub enum Opened<R> {
    /// Read to its end.
    Whole(Checked<SpectrumFile>),
    /// A table of rows, read as far as its heading.
    Stream(Box<RowStream<R>>),
}

/// Opens an input of any format: tables of rows as a stream, the rest whole (at most [`LARGEST_WHOLE`]).
///
/// # Errors
/// As [`read`]; of a table of rows, only what is wrong up to and with its heading.
pub fn open<R: Read>(reader: R, options: &ReadOptions) -> Result<Opened<R>, Error> {
    let mut source = Source::new(reader);
    source.fill_head()?;
    text::refuse_signatures(&source.buffer)?;
    let format = options.format.unwrap_or_else(|| detect(&source.buffer));
    if format == Format::Delimited
        && let Some(head) = source.row_head(options)?
    {
        return Ok(Opened::Stream(Box::new(RowStream::new(source, head))));
    }
    source.fill_whole()?;
    let options = ReadOptions { format: Some(format), ..options.clone() };
    read(&source.buffer, &options).map(Opened::Whole)
}

fn without_line_end(line: &[u8]) -> &[u8] {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    line.strip_suffix(b"\r").unwrap_or(line)
}

/// A reader and what was read but not used.
struct Source<R> {
    reader: Utf8Reader<R>,
    buffer: Vec<u8>,
    ended: bool,
}

impl<R: Read> Source<R> {
    fn new(reader: R) -> Self {
        Self { reader: Utf8Reader::new(reader), buffer: Vec::new(), ended: false }
    }

    /// Adds up to `count` bytes.
    fn fill(&mut self, count: usize) -> Result<(), Error> {
        let read = self.reader.by_ref().take(count as u64).read_to_end(&mut self.buffer)?;
        self.ended = read < count;
        if self.reader.malformed {
            return Err(Error::whole(ErrorKind::NotText { found: "malformed UTF-16" }));
        }
        Ok(())
    }

    fn fill_head(&mut self) -> Result<(), Error> {
        // A heading of very many wavelengths may alone be longer than the usual head.
        while !self.ended && self.buffer.len() < LONGEST_ROW {
            self.fill(HEAD)?;
            if self.buffer.iter().filter(|b| **b == b'\n').take(3).count() == 3 {
                break;
            }
        }
        Ok(())
    }

    fn fill_whole(&mut self) -> Result<(), Error> {
        while !self.ended {
            if self.buffer.len() as u64 > LARGEST_WHOLE {
                let kind = ErrorKind::TooLarge { what: "an input", limit: LARGEST_WHOLE };
                return Err(
                    Error::whole(kind).with_hint("split it, or write one spectrum per row: rows are read as a stream")
                );
            }
            self.fill(BATCH)?;
        }
        Ok(())
    }

    fn row_head(&self, options: &ReadOptions) -> Result<Option<Head>, Error> {
        let end = if self.ended {
            self.buffer.len()
        } else {
            self.buffer.iter().rposition(|b| *b == b'\n').map_or(0, |at| at + 1)
        };
        // Old line ends, NUL and their like are for the whole reader to settle or to refuse.
        if !self.buffer[..end].contains(&b'\n') || self.buffer[..end].contains(&0) {
            return Ok(None);
        }
        delimited::head(&text::decode_line(&self.buffer[..end]), options)
    }
}

/// A table of rows, read in batches. Memory is bounded by the batch; all rows share one grid.
pub struct RowStream<R> {
    source: Source<R>,
    /// Bytes of the buffer already handed out.
    used: usize,
    /// Line of the first byte not handed out.
    line: u64,
    table: RowTable,
    metadata: Vec<(String, String)>,
    findings: Vec<Finding>,
    negatives: Negatives,
    decoded: Option<u64>,
    rows: u64,
}

impl<R> fmt::Debug for RowStream<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RowStream").field("line", &self.line).field("table", &self.table).finish_non_exhaustive()
    }
}

impl<R: Read> RowStream<R> {
    fn new(source: Source<R>, head: Head) -> Self {
        let Head { table, metadata, findings, line } = head;
        let skipped = source.buffer.iter().enumerate().filter(|(_, b)| **b == b'\n').nth(line as usize - 1);
        let used = skipped.map_or(source.buffer.len(), |(at, _)| at + 1);
        let negatives = Negatives::default();
        Self { source, used, line: line + 1, table, metadata, findings, negatives, decoded: None, rows: 0 }
    }

    /// The grid of all rows.
    #[must_use]
    pub fn grid(&self) -> &Arc<Grid> {
        &self.table.grid
    }

    /// The quantity, where the file states one.
    #[must_use]
    pub fn quantity(&self) -> Option<Quantity> {
        self.table.quantity
    }

    /// The unit of the values, where the file states one.
    #[must_use]
    pub fn unit(&self) -> Option<&SpectralUnit> {
        self.table.unit.as_ref()
    }

    /// Facts above the heading, label and text.
    #[must_use]
    pub fn metadata(&self) -> &[(String, String)] {
        &self.metadata
    }

    /// Rows handed out so far, bad ones included.
    #[must_use]
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// What was noticed so far; complete after the last batch.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        let decoded = self.decoded.map(text::windows_1252_finding);
        self.findings.iter().cloned().chain(decoded).chain(self.negatives.finding()).collect()
    }

    /// How rows become SI per nm: the file's quantity and unit with the user's word, as in
    /// [`Entry::resolve`](super::Entry::resolve).
    ///
    /// # Errors
    /// As there.
    pub fn scale(&self, quantity: Option<Quantity>, unit: Option<&SpectralUnit>) -> Result<Checked<Scale>, Error> {
        let stated = (self.table.quantity, self.table.unit.as_ref());
        Scale::new(stated, (quantity, unit), self.table.grid.len(), &Location::default())
    }

    /// The next rows, at most `max_rows`, in file order; `None` at the end. A bad row is an error in its place, the next one
    /// is read all the same. Numbers are parsed in parallel.
    ///
    /// # Errors
    /// Where the reader fails, or a row is longer than [`LONGEST_ROW`].
    pub fn next_batch(&mut self, max_rows: usize) -> Result<Option<Vec<Result<Row, Error>>>, Error> {
        loop {
            let lines = self.take_lines(max_rows.max(1))?;
            let Some(&(_, _, end)) = lines.last() else { return Ok(None) };
            let buffer = &self.source.buffer;
            let table = &self.table;
            let rows: Vec<(Option<Result<Row, Error>>, bool)> = lines
                .par_iter()
                .with_min_len(16)
                .map(|&(line, start, end)| {
                    let text = text::decode_line(without_line_end(&buffer[start..end]));
                    let blank = text.trim().is_empty() || dialect::comment(&text).is_some();
                    let row = (!blank).then(|| table.read(Record { line, text: &text }));
                    (row, matches!(text, std::borrow::Cow::Owned(_)))
                })
                .collect();
            self.used = end;
            if self.decoded.is_none() {
                self.decoded = rows.iter().position(|(_, decoded)| *decoded).map(|at| lines[at].0);
            }
            let rows: Vec<Result<Row, Error>> = rows.into_iter().filter_map(|(row, _)| row).collect();
            for row in rows.iter().flatten() {
                self.negatives.add(&row.values, || item(Location::line(row.line), &row.name));
            }
            self.rows += rows.len() as u64;
            if !rows.is_empty() {
                return Ok(Some(rows));
            }
        }
    }

    /// The next lines: number, and the bytes of the buffer from which to which they reach, line feed included.
    fn take_lines(&mut self, most: usize) -> Result<Vec<(u64, usize, usize)>, Error> {
        let mut lines = Vec::new();
        let mut start = self.used;
        let mut scanned = self.used;
        loop {
            let buffer = &self.source.buffer;
            while lines.len() < most
                && let Some(at) = buffer[scanned..].iter().position(|b| *b == b'\n')
            {
                scanned += at + 1;
                lines.push((self.line, start, scanned));
                self.line += 1;
                start = scanned;
            }
            if lines.len() == most || (!lines.is_empty() && scanned - self.used >= BATCH) {
                return Ok(lines);
            }
            if self.source.ended {
                if start < buffer.len() {
                    lines.push((self.line, start, buffer.len()));
                    self.line += 1;
                }
                return Ok(lines);
            }
            if buffer.len() - start > LONGEST_ROW {
                let kind = ErrorKind::TooLarge { what: "a row", limit: LONGEST_ROW as u64 };
                return Err(Error::new(Location::at(self.line, 1), kind));
            }
            // What was handed out makes room; places in the buffer move with the rest.
            let used = std::mem::take(&mut self.used);
            self.source.buffer.drain(..used);
            for (_, from, to) in &mut lines {
                (*from, *to) = (*from - used, *to - used);
            }
            start -= used;
            scanned = self.source.buffer.len();
            self.source.fill(HEAD)?;
        }
    }
}

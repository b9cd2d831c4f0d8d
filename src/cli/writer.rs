//! Where rendered results go, one after another.

use std::io::{self, Write};

use super::output::Sink;
use crate::finding::Finding;
use crate::report::envelope::{Envelope, Input};

/// Where rendered results go.
pub(super) struct Writer<'a> {
    form: Form<'a>,
    results: usize,
}

enum Form<'a> {
    Json(Envelope<&'a mut Sink>),
    /// Text or CSV.
    Plain(&'a mut Sink),
}

impl<'a> Writer<'a> {
    pub(super) fn json(envelope: Envelope<&'a mut Sink>) -> Self {
        Self { form: Form::Json(envelope), results: 0 }
    }

    pub(super) fn plain(sink: &'a mut Sink) -> Self {
        Self { form: Form::Plain(sink), results: 0 }
    }

    pub(super) fn result(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.results += 1;
        match &mut self.form {
            Form::Json(envelope) => envelope.result_bytes(bytes),
            Form::Plain(out) => {
                // A blank line between reports; a CSV row is one line.
                if self.results > 1 && bytes.iter().filter(|b| **b == b'\n').count() > 1 {
                    out.write_all(b"\n")?;
                }
                out.write_all(bytes)
            }
        }
    }

    pub(super) fn finding(&mut self, finding: Finding) {
        if let Form::Json(envelope) = &mut self.form {
            envelope.finding(finding);
        }
    }

    pub(super) fn input(&mut self, input: Input) {
        if let Form::Json(envelope) = &mut self.form {
            envelope.input(input);
        }
    }

    /// Ends the output and tells how many results it has.
    pub(super) fn end(self) -> io::Result<usize> {
        match self.form {
            Form::Json(envelope) => envelope.end().map(|_| ())?,
            Form::Plain(out) => out.flush()?,
        }
        Ok(self.results)
    }
}

/// The cells of one row of a table.
pub(super) fn csv_row(cells: &[String]) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // A vector takes every byte.
    let _ = writer.write_record(cells);
    writer.into_inner().unwrap_or_default()
}

//! Where rendered results go, one after another.

use std::io::{self, Write};

use crate::cli::output::Sink;
use crate::finding::Finding;
use crate::report::envelope::{Envelope, Input};

/// Where rendered results go.
pub(super) enum Writer<'a> {
    Json(Envelope<&'a mut Sink>),
    /// Text or CSV; whether a result was written already.
    Plain(&'a mut Sink, bool),
}

impl Writer<'_> {
    pub(super) fn result(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Json(envelope) => envelope.result_bytes(bytes),
            Self::Plain(out, began) => {
                // A blank line between reports; CSV rows end in theirs and begin with no heading.
                if *began && bytes.ends_with(b"\n") && bytes.iter().filter(|b| **b == b'\n').count() > 1 {
                    out.write_all(b"\n")?;
                }
                *began = true;
                out.write_all(bytes)
            }
        }
    }

    pub(super) fn finding(&mut self, finding: Finding) {
        if let Self::Json(envelope) = self {
            envelope.finding(finding);
        }
    }

    pub(super) fn input(&mut self, input: Input) {
        if let Self::Json(envelope) = self {
            envelope.input(input);
        }
    }

    pub(super) fn end(self) -> io::Result<()> {
        match self {
            Self::Json(envelope) => envelope.end().map(|_| ()),
            Self::Plain(out, _) => out.flush(),
        }
    }
}

//! The one envelope around all JSON output, written as a stream so that a hundred thousand results need no memory.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::Value;

use crate::finding::Finding;

/// An input of a run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Input {
    /// The path as the user gave it, `-` for standard input, or the name of a source.
    pub path: String,
    /// SHA-256 of its bytes, lower-case hexadecimal; absent for named sources.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
}

/// Writes `{"tool", "version", "command", "settings", "results": […], "findings": […], "inputs": […]}`.
///
/// `inputs` comes last because the checksum of a stream is known at its end; the order of keys means nothing in JSON.
#[derive(Debug)]
pub struct Envelope<W: Write> {
    out: W,
    results: usize,
    findings: Vec<Finding>,
    inputs: Vec<Input>,
}

impl<W: Write> Envelope<W> {
    /// Begins the document.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn begin(mut out: W, command: &str, settings: &Value) -> io::Result<Self> {
        let version = env!("CARGO_PKG_VERSION");
        write!(
            out,
            "{{\"tool\":\"photopic\",\"version\":\"{version}\",\"command\":{},\"settings\":",
            Value::from(command)
        )?;
        serde_json::to_writer(&mut out, settings)?;
        out.write_all(b",\"results\":[")?;
        Ok(Self { out, results: 0, findings: Vec::new(), inputs: Vec::new() })
    }

    /// Writes one result.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn result(&mut self, result: &Value) -> io::Result<()> {
        self.result_bytes(&serde_json::to_vec(result)?)
    }

    /// Writes one result that is JSON already: many are made in parallel and written one after another.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn result_bytes(&mut self, json: &[u8]) -> io::Result<()> {
        self.out.write_all(if self.results == 0 { b"\n" } else { b",\n" })?;
        self.results += 1;
        self.out.write_all(json)
    }

    /// Keeps a finding for the end of the document.
    pub fn finding(&mut self, finding: Finding) {
        self.findings.push(finding);
    }

    /// Keeps an input for the end of the document.
    pub fn input(&mut self, input: Input) {
        self.inputs.push(input);
    }

    /// Ends the document and gives the writer back.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn end(mut self) -> io::Result<W> {
        self.out.write_all(b"\n],\"findings\":")?;
        serde_json::to_writer(&mut self.out, &self.findings)?;
        self.out.write_all(b",\"inputs\":")?;
        serde_json::to_writer(&mut self.out, &self.inputs)?;
        self.out.write_all(b"}\n")?;
        self.out.flush()?;
        Ok(self.out)
    }
}

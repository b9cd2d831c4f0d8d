//! `lamp check`: the verdict on one file.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::finding::{Checked, Finding, Severity};
use crate::luminaire::format::File;

/// The object of `lamp check` in `results[]`.
#[must_use]
pub fn check(file: &Checked<File>) -> Map<String, Value> {
    let count = |severity| file.findings.iter().filter(|f| f.severity == severity).count();
    let errors = count(Severity::Error);
    let mut codes: Vec<&str> = file.findings.iter().map(|f| f.code).collect();
    codes.sort_unstable();
    codes.dedup();
    let facts = [
        ("format", json!(file.value.format.to_string())),
        ("format_version", json!(file.value.version)),
        ("passes", json!(errors == 0)),
        ("errors", json!(errors)),
        ("warnings", json!(count(Severity::Warning))),
        ("findings", json!(file.findings.len())),
        ("codes", json!(codes.join(" "))),
    ];
    facts.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

/// `lamp check` for people: the verdict, and each finding.
#[must_use]
pub fn check_text(path: &str, o: &Map<String, Value>, findings: &[Finding]) -> String {
    let count = |key: &str, word: &str| {
        let n = o.get(key).and_then(Value::as_u64).unwrap_or_default();
        format!("{n} {word}{}", if n == 1 { "" } else { "s" })
    };
    let verdict = if o.get("passes") == Some(&Value::Bool(true)) { "passes" } else { "does not pass" };
    let numbers = [count("errors", "error"), count("warnings", "warning"), count("findings", "finding")].join(", ");
    let version = o.get("format_version").and_then(Value::as_str).unwrap_or_default();
    let mut out = format!("{path}: {verdict} ({version}; {numbers})\n");
    for finding in findings {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "  {finding}");
    }
    out
}

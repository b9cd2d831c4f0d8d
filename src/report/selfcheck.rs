//! The self-check as JSON, text and table.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::finding::Finding;
use crate::selfcheck::Check;
use crate::units::significant;

/// The columns of the table.
pub const COLUMNS: [&str; 8] = ["area", "case", "source", "expected", "found", "error", "allowed", "passes"];

/// A case of the JSON document; what is no number is `null`.
#[must_use]
pub fn json(c: &Check) -> Value {
    json!({
        "area": c.area, "case": c.case, "source": c.source, "expected": c.expected, "found": c.found,
        "error": c.error(), "allowed": c.allowed, "passes": c.passes(),
    })
}

/// A row of the table.
#[must_use]
pub fn row(c: &Check) -> Vec<String> {
    let numbers = [c.expected, c.found, c.error(), c.allowed].map(|v| v.to_string());
    let words = [c.area, c.case, c.source].map(str::to_owned);
    words.into_iter().chain(numbers).chain([c.passes().to_string()]).collect()
}

/// For people.
#[must_use]
pub fn text(checks: &[Check]) -> String {
    let mut out = String::new();
    let width = checks.iter().map(|c| c.case.chars().count()).max().unwrap_or(0);
    let mut area = "";
    for c in checks {
        if c.area != area {
            area = c.area;
            let _ = writeln!(out, "{area}");
        }
        let (word, digits) = (if c.passes() { "ok  " } else { "OFF " }, significant(c.found, 6));
        let error = format!("off by {} of {}", significant(c.error(), 2), significant(c.allowed, 2));
        let _ = writeln!(out, "  {word} {:width$}  {digits:>12}  {error:28}  {}", c.case, c.source);
    }
    let failed = checks.iter().filter(|c| !c.passes()).count();
    let verdict = if failed == 0 { "all as expected".to_owned() } else { format!("{failed} off") };
    let _ = writeln!(out, "{} cases, {verdict} (errors are relative, absolute where 0 is expected)", checks.len());
    out
}

/// What is off.
#[must_use]
pub fn findings(checks: &[Check]) -> Vec<Finding> {
    let off = checks.iter().filter(|c| !c.passes()).map(|c| {
        let message = format!("{}: {} instead of {} ({})", c.case, c.found, c.expected, c.source);
        Finding::error("T010", message)
    });
    off.collect()
}

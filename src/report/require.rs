//! What inputs require of a model, as JSON, text and table.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::finding::Finding;
use crate::trade::require::{Requirement, Rung};
use crate::units::significant;

/// The columns of the table.
pub const COLUMNS: [&str; 6] = ["path", "question", "figure", "model", "error", "needed"];

/// The result of an input.
#[must_use]
pub fn json(path: &str, kind: &str, requirements: &[Requirement]) -> Value {
    let rung = |r: &Rung| json!({"model": r.model, "error": r.error});
    let one = |r: &Requirement| {
        let mut out = json!({
            "question": r.question,
            "needed": r.needed.map(|i| rung(&r.rungs[i])),
            "simpler": r.simpler().map(rung),
            "rungs": r.rungs.iter().map(rung).collect::<Vec<_>>(),
        });
        for (key, words) in [("figure", r.figure.as_str()), ("because", r.because.as_str())] {
            if !words.is_empty() {
                out[key] = words.into();
            }
        }
        out
    };
    json!({"path": path, "kind": kind, "requirements": requirements.iter().map(one).collect::<Vec<_>>()})
}

/// The rows of the table: one per rung.
#[must_use]
pub fn rows(path: &str, requirements: &[Requirement]) -> Vec<Vec<String>> {
    let of = |r: &Requirement| {
        let row = |(i, rung): (usize, &Rung)| {
            let error = rung.error.map_or_else(String::new, |e| e.to_string());
            let needed = (r.needed == Some(i)).to_string();
            vec![path.to_owned(), r.question.to_owned(), r.figure.clone(), rung.model.clone(), error, needed]
        };
        r.rungs.iter().enumerate().map(row).collect::<Vec<_>>()
    };
    requirements.iter().flat_map(of).collect()
}

/// An error in per cent, or that there is none.
fn within(error: Option<f64>) -> String {
    match error {
        None => "error unknown".to_owned(),
        Some(0.0) => "exact".to_owned(),
        Some(e) => format!("within {} %", significant(100.0 * e, 2)),
    }
}

/// For people.
#[must_use]
pub fn text(path: &str, kind: &str, requirements: &[Requirement], most: f64) -> String {
    let mut out = format!("{path} ({kind}), for {} %\n", significant(100.0 * most, 3));
    for r in requirements {
        let needed = r.needed.map_or_else(
            || "none of those tried".to_owned(),
            |i| format!("{} ({})", r.rungs[i].model, within(r.rungs[i].error)),
        );
        // Writing to a string cannot fail.
        let _ = writeln!(out, "  {:13} {needed}", r.question);
        if let Some(simpler) = r.simpler() {
            let word = if r.needed.is_some() { "simpler" } else { "the best" };
            let _ = writeln!(out, "  {:13} {word}: {} ({})", "", simpler.model, within(simpler.error));
        }
        for words in [&r.figure, &r.because].into_iter().filter(|w| !w.is_empty()) {
            let _ = writeln!(out, "  {:13} {words}", "");
        }
    }
    out
}

/// What no model that was tried carries.
#[must_use]
pub fn findings(requirements: &[Requirement], most: f64) -> Vec<Finding> {
    let missed = requirements.iter().filter(|r| r.needed.is_none()).map(|r| {
        let asked = significant(100.0 * most, 3);
        let best = r.simpler().map_or_else(String::new, |b| format!("; {} is {}", b.model, within(b.error)));
        Finding::error("T003", format!("{}: nothing that was tried is within {asked} %{best}", r.question))
    });
    missed.collect()
}

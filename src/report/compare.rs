//! `compare`: differences of two measurements, and their significance.

use std::fmt::Write;

use serde_json::{Value, json};

use super::uncertainty::measured_path;
use crate::spectrum::Quantity;
use crate::uncertainty::compare::Difference;
use crate::units::significant;

/// The differences with the JSON keys of their figures.
#[must_use]
pub fn keyed(all: &[Difference], quantity: Quantity) -> Vec<(String, Difference)> {
    all.iter().filter_map(|d| Some((measured_path(d.measurand, quantity)?, *d))).collect()
}

/// The largest |E_n|, and the figure that has it.
fn largest(all: &[(String, Difference)]) -> Option<&(String, Difference)> {
    all.iter().max_by(|a, b| a.1.e_n.abs().total_cmp(&b.1.e_n.abs()))
}

/// The object of a comparison in `results[]`.
#[must_use]
pub fn json(paths: [&str; 2], all: &[(String, Difference)]) -> Value {
    let figures = all.iter().map(|(key, d)| {
        json!({
            "key": key,
            "a": d.a.0,
            "b": d.b.0,
            "difference": d.a.0 - d.b.0,
            "expanded_a": d.a.1,
            "expanded_b": d.b.1,
            "correlation": d.correlation,
            "expanded_difference": d.expanded,
            "ratio": d.ratio().map(|r| r.0),
            "expanded_ratio": d.ratio().map(|r| r.1),
            "e_n": Some(d.e_n).filter(|e| e.is_finite()),
            "significant": d.is_significant(),
        })
    });
    json!({
        "path_a": paths[0],
        "path_b": paths[1],
        "figures": figures.collect::<Vec<_>>(),
        "largest_e_n": largest(all).map(|(key, d)| json!({"key": key, "e_n": Some(d.e_n).filter(|e| e.is_finite())})),
        "significant": all.iter().filter(|(_, d)| d.is_significant()).count(),
        "passes": all.iter().all(|(_, d)| !d.is_significant()),
    })
}

/// One row per figure.
#[must_use]
pub fn csv(all: &[(String, Difference)]) -> String {
    let mut out = String::from(
        "key,a,b,difference,expanded_a,expanded_b,correlation,expanded_difference,ratio,expanded_ratio,e_n,significant\n",
    );
    for (key, d) in all {
        let e_n = if d.e_n.is_finite() { d.e_n.to_string() } else { String::new() };
        let ratio = d.ratio().map_or_else(|| ",".to_owned(), |(ratio, expanded)| format!("{ratio},{expanded}"));
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{key},{},{},{},{},{},{},{},{ratio},{e_n},{}",
            d.a.0,
            d.b.0,
            d.a.0 - d.b.0,
            d.a.1,
            d.b.1,
            d.correlation,
            d.expanded,
            d.is_significant()
        );
    }
    out
}

/// A table for people: the significant differences first.
#[must_use]
pub fn text(paths: [&str; 2], all: &[(String, Difference)]) -> String {
    let mut out = format!("A: {}\nB: {}\n\n", paths[0], paths[1]);
    let mut sorted: Vec<&(String, Difference)> = all.iter().collect();
    sorted.sort_by(|a, b| b.1.e_n.abs().total_cmp(&a.1.e_n.abs()));
    let wide = all.iter().map(|(k, _)| k.len()).fold(6, usize::max);
    let _ = writeln!(
        out,
        "  {:<wide$} {:>12} {:>12} {:>12} {:>10} {:>10} {:>10} {:>7}",
        "figure", "A", "B", "A − B", "U95 of A", "U95 of B", "of A − B", "E_n"
    );
    for (key, d) in sorted {
        let mark = if d.is_significant() { "  significant" } else { "" };
        let show = |v: f64, digits| significant(v, digits);
        let _ = writeln!(
            out,
            "  {key:<wide$} {:>12} {:>12} {:>12} {:>10} {:>10} {:>10} {:>7.2}{mark}",
            show(d.a.0, 6),
            show(d.b.0, 6),
            show(d.a.0 - d.b.0, 3),
            show(d.a.1, 2),
            show(d.b.1, 2),
            show(d.expanded, 2),
            d.e_n
        );
    }
    let count = all.iter().filter(|(_, d)| d.is_significant()).count();
    let _ = writeln!(out, "\n  {count} of {} differences are significant (|E_n| > 1)", all.len());
    out
}

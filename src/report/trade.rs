//! Trades as JSON, text and table.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::finding::Finding;
use crate::trade::{Estimate, Measure, Sweep};
use crate::units::significant;

/// Digits shown for people; JSON has all.
const DIGITS: usize = 3;

/// A sweep and what is asked of it.
#[derive(Debug, Clone, Copy)]
pub struct Answer<'a> {
    /// The input.
    pub path: &'a str,
    /// The trials.
    pub sweep: &'a Sweep,
    /// Which figure's error is traded, by its place.
    pub figure: usize,
    /// The error asked for.
    pub target: Option<f64>,
}

impl Answer<'_> {
    /// The trial that is recommended.
    #[must_use]
    pub fn recommended(&self) -> Option<usize> {
        self.target.and_then(|t| self.sweep.recommend(self.figure, t))
    }

    /// An error in words: relative ones in per cent.
    fn words(&self, error: f64) -> String {
        let figure = &self.sweep.figures[self.figure];
        match (figure.measure, figure.unit) {
            (Measure::Relative, _) => format!("{} %", significant(100.0 * error, DIGITS)),
            (_, "") => significant(error, DIGITS),
            (_, unit) => format!("{} {unit}", significant(error, DIGITS)),
        }
    }

    fn settings(&self, trial: usize) -> Value {
        let values = self.sweep.knobs.iter().zip(&self.sweep.trials[trial].settings);
        values.map(|(knob, value)| ((*knob).to_owned(), value.as_str().into())).collect::<Map<_, _>>().into()
    }

    /// The result of the JSON document.
    #[must_use]
    pub fn json(&self) -> Value {
        let (sweep, front) = (self.sweep, self.sweep.front(self.figure));
        let errors = |of: &[Option<Estimate>]| {
            let pairs = sweep.figures.iter().zip(of);
            pairs.map(|(f, e)| (f.key.to_string(), json!(e))).collect::<Map<_, _>>()
        };
        let trial = |i: usize| {
            let t = &sweep.trials[i];
            json!({
                "settings": self.settings(i), "offered": t.offered, "time_s": t.timing, "errors": errors(&t.errors),
                "error_bound": sweep.bound(i, self.figure), "within_noise": sweep.is_within_noise(i, self.figure),
                "pareto": front.contains(&i),
            })
        };
        let effects = sweep.knobs.iter().enumerate().filter_map(|(k, knob)| {
            let e = sweep.effect(k, self.figure)?;
            Some(((*knob).to_owned(), json!({"error": e.error, "time_ratio": e.time_ratio, "matters": e.matters})))
        });
        let reference = sweep.figures.iter().zip(&sweep.reference_errors);
        json!({
            "path": self.path,
            "figure": &sweep.figures[self.figure],
            "target": self.target,
            "reference": sweep.reference,
            "reference_errors": reference.map(|(f, e)| (f.key.to_string(), json!(e))).collect::<Map<_, _>>(),
            "threads": rayon::current_num_threads(),
            "trials": (0..sweep.trials.len()).map(trial).collect::<Vec<_>>(),
            "effects": effects.collect::<Map<_, _>>(),
            "recommended": self.recommended().map(trial),
        })
    }

    /// What is to be said beside the figures.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        let missed = self.target.filter(|_| self.recommended().is_none()).map(|target| {
            let bounds = (0..self.sweep.trials.len()).filter(|i| self.sweep.trials[*i].offered);
            let least = bounds.filter_map(|i| self.sweep.bound(i, self.figure)).fold(f64::INFINITY, f64::min);
            let (key, least) = (&self.sweep.figures[self.figure].key, self.words(least));
            let message = format!("no setting brings {key} within {}; the best is within {least}", self.words(target));
            Finding::error("T001", message)
        });
        let idle = self.sweep.knobs.iter().enumerate().filter_map(|(k, knob)| {
            let effect = self.sweep.effect(k, self.figure).filter(|e| !e.matters)?;
            let message =
                format!("`{knob}` changes the error by no more than the reference's own error or the scatter");
            Some(
                Finding::info("T002", message)
                    .hint(format!("its time differs by a factor of {:.2}", effect.time_ratio)),
            )
        });
        missed.into_iter().chain(idle).collect()
    }

    /// For people: the front, what is recommended, and what each knob does.
    #[must_use]
    pub fn text(&self) -> String {
        let (sweep, key) = (self.sweep, &self.sweep.figures[self.figure].key);
        let mut out = format!("{}\n  reference   {}\n", self.path, sweep.reference);
        let own = sweep.reference_errors[self.figure].map_or_else(|| "unknown".to_owned(), |e| self.words(e));
        let _ = writeln!(out, "  its error   {own} ({key})");
        let repeats = sweep.trials.first().map_or(0, |t| t.timing.repeats);
        let threads = rayon::current_num_threads();
        let _ = writeln!(
            out,
            "  {} settings, {repeats} measurements of each in turns, {threads} threads of {} {}\n",
            sweep.trials.len(),
            std::env::consts::ARCH,
            std::env::consts::OS
        );
        let _ = writeln!(out, "  what nothing beats, from the fastest on ({key}):");
        let front = sweep.front(self.figure);
        let mut rows = vec![
            [&["error within", "time", "quartiles"], &sweep.knobs[..]]
                .concat()
                .iter()
                .map(|s| (*s).to_owned())
                .collect(),
        ];
        rows.extend(front.iter().map(|i| self.row(*i)));
        out.push_str(&aligned(&rows));
        if let Some(target) = self.target {
            let _ = writeln!(out, "\n  asked for within {}:", self.words(target));
            match self.recommended() {
                Some(i) => out.push_str(&aligned(&[self.row(i)])),
                None => out.push_str("    no setting\n"),
            }
        }
        out.push_str("\n  what one knob alone changes at most:\n");
        let effects = sweep.knobs.iter().enumerate().filter_map(|(k, knob)| {
            let e = sweep.effect(k, self.figure)?;
            let time = format!("time × {}", significant(e.time_ratio, DIGITS));
            let noise = if e.matters { "" } else { "within the noise" };
            Some(vec![(*knob).to_owned(), format!("error by {}", self.words(e.error)), time, noise.to_owned()])
        });
        out.push_str(&aligned(&effects.collect::<Vec<_>>()));
        out
    }

    fn row(&self, trial: usize) -> Vec<String> {
        let t = &self.sweep.trials[trial];
        let bound = self.sweep.bound(trial, self.figure).map_or_else(|| "unknown".to_owned(), |e| self.words(e));
        let spread = format!("{}–{}", seconds(t.timing.low_s), seconds(t.timing.high_s));
        [bound, seconds(t.timing.median_s), spread].into_iter().chain(t.settings.iter().cloned()).collect()
    }

    /// The rows of a table: one per trial.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<String>> {
        let front = self.sweep.front(self.figure);
        let row = |i: usize| {
            let t = &self.sweep.trials[i];
            let mut out = vec![self.path.to_owned()];
            out.extend(t.settings.iter().cloned());
            let times = [t.timing.median_s, t.timing.low_s, t.timing.high_s].map(|v| v.to_string());
            out.extend(times.into_iter().chain([t.timing.repeats.to_string()]));
            for e in &t.errors {
                let cell = |v: fn(&Estimate) -> f64| e.as_ref().map_or_else(String::new, |e| v(e).to_string());
                out.extend([cell(|e| e.error), cell(|e| e.low), cell(|e| e.high)]);
            }
            out.extend([t.offered.to_string(), front.contains(&i).to_string()]);
            out
        };
        (0..self.sweep.trials.len()).map(row).collect()
    }
}

/// The header of the table of a sweep.
#[must_use]
pub fn header(sweep: &Sweep) -> Vec<String> {
    let times = ["time_s", "time_low_s", "time_high_s", "repeats"];
    let errors = sweep.figures.iter().flat_map(|f| ["error", "low", "high"].map(|w| format!("{}_{w}", f.key)));
    let mut out = vec!["path".to_owned()];
    out.extend(sweep.knobs.iter().chain(&times).map(|s| (*s).to_owned()));
    out.extend(errors.chain(["offered", "pareto"].map(str::to_owned)));
    out
}

/// A time for people.
fn seconds(s: f64) -> String {
    let (factor, unit) = match s {
        s if s < 1e-3 => (1e6, "µs"),
        s if s < 1.0 => (1e3, "ms"),
        _ => (1.0, "s"),
    };
    format!("{} {unit}", significant(factor * s, DIGITS))
}

/// Columns of equal width.
fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| rows.iter().filter_map(|r| r.get(c)).map(|s| s.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut out = String::new();
    for row in rows {
        let mut line = "   ".to_owned();
        for (cell, width) in row.iter().zip(&widths) {
            let _ = write!(line, " {cell:width$} ");
        }
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out
}

//! `flicker`: percent flicker, flicker index, SVM and P_st^LM.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::photometry::flicker::Figures;
use crate::units::significant;

/// One waveform.
#[derive(Debug, Clone, PartialEq)]
pub struct Flicker {
    /// The file.
    pub path: String,
    /// The column's name.
    pub name: String,
    /// Samples per second.
    pub rate_hz: f64,
    /// Time that the samples cover, s.
    pub duration_s: f64,
    /// Its figures.
    pub figures: Figures,
}

/// What must not be exceeded.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Limits {
    /// Of SVM.
    pub svm: Option<f64>,
    /// Of P_st^LM.
    pub pst_lm: Option<f64>,
}

impl Limits {
    /// Whether a waveform keeps them; a figure that could not be determined does not.
    #[must_use]
    pub fn kept(&self, f: &Figures) -> bool {
        let within = |value: Option<f64>, limit: Option<f64>| limit.is_none_or(|l| value.is_some_and(|v| v <= l));
        within(f.svm, self.svm) && within(f.pst_lm, self.pst_lm)
    }

    fn any(&self) -> bool {
        self.svm.is_some() || self.pst_lm.is_some()
    }
}

/// The object of a waveform in `results[]`.
#[must_use]
pub fn json(f: &Flicker, limits: &Limits) -> Value {
    let g = &f.figures;
    let tones: Vec<Value> =
        g.tones.iter().map(|t| json!({"frequency_hz": t.frequency_hz, "amplitude": t.amplitude})).collect();
    let mut out = json!({
        "path": f.path,
        "name": f.name,
        "rate_hz": f.rate_hz,
        "duration_s": f.duration_s,
        "mean": g.mean,
        "percent_flicker": g.percent_flicker,
        "flicker_index": g.flicker_index,
        "fundamental_hz": g.fundamental.map(|t| t.frequency_hz),
        "tones": tones,
        "svm": g.svm,
        "pst_lm": g.pst_lm,
    });
    if limits.any() {
        out["limits"] = json!({"svm": limits.svm, "pst_lm": limits.pst_lm});
        out["passes"] = limits.kept(g).into();
    }
    out
}

/// One row per waveform.
#[must_use]
pub fn csv(all: &[Flicker]) -> String {
    let mut out = csv::Writer::from_writer(Vec::new());
    let cell = |v: Option<f64>| v.map_or(String::new(), |v| v.to_string());
    let header = [
        "path",
        "name",
        "rate_hz",
        "duration_s",
        "mean",
        "percent_flicker",
        "flicker_index",
        "fundamental_hz",
        "svm",
        "pst_lm",
    ];
    // A vector takes every byte.
    let _ = out.write_record(header);
    for f in all {
        let g = &f.figures;
        let numbers = [
            Some(f.rate_hz),
            Some(f.duration_s),
            Some(g.mean),
            Some(g.percent_flicker),
            Some(g.flicker_index),
            g.fundamental.map(|t| t.frequency_hz),
            g.svm,
            g.pst_lm,
        ];
        let cells = [f.path.clone(), f.name.clone()].into_iter().chain(numbers.map(cell));
        let _ = out.write_record(cells);
    }
    String::from_utf8(out.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// For people.
#[must_use]
pub fn text(all: &[Flicker], limits: &Limits) -> String {
    const TONES: usize = 6;
    let mut out = String::new();
    // Writing to a string cannot fail.
    for f in all {
        let g = &f.figures;
        let _ = writeln!(out, "{} [{}]", f.path, f.name);
        let mut row = |what: &str, value: String| {
            let _ = writeln!(out, "  {what:<26} {value}");
        };
        row("samples", format!("{} s at {} Hz", significant(f.duration_s, 4), significant(f.rate_hz, 6)));
        row("mean", significant(g.mean, 5));
        row("percent flicker", format!("{:.2} %", g.percent_flicker));
        row("flicker index", format!("{:.4}", g.flicker_index));
        let against = |value: Option<f64>, limit: Option<f64>| {
            let shown = value.map_or("– (too short or too slow)".to_owned(), |v| format!("{v:.3}"));
            match (value, limit) {
                (_, None) => shown,
                (Some(v), Some(l)) if v <= l => format!("{shown}   within {l}"),
                (_, Some(l)) => format!("{shown}   not within {l}"),
            }
        };
        row("SVM", against(g.svm, limits.svm));
        row("Pst LM", against(g.pst_lm, limits.pst_lm));
        let mut tones = g.tones.clone();
        tones.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
        for (i, t) in tones.iter().take(TONES).enumerate() {
            let value = format!("{} Hz, {} of the mean", significant(t.frequency_hz, 5), significant(t.amplitude, 3));
            row(if i == 0 { "strongest tones" } else { "" }, value);
        }
        out.push('\n');
    }
    out
}

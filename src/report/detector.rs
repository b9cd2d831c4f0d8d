//! `detector`: f₁′, mismatch factors and ranks.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::photometry::detector::Figures;
use crate::uncertainty::Stated;
use crate::uncertainty::detector::DetectorUncertainty;
use crate::units::significant;

/// One detector.
#[derive(Debug, Clone, PartialEq)]
pub struct Detector {
    /// The file.
    pub path: String,
    /// The responsivity's name in it.
    pub name: String,
    /// Its figures.
    pub figures: Figures,
    /// What they are worth, where asked for.
    pub uncertainty: Option<DetectorUncertainty>,
}

impl Detector {
    /// The largest |F − 1|, and the lamp's place.
    fn worst(&self) -> Option<(usize, f64)> {
        let off = self.figures.mismatch_factors.iter().map(|f| (f - 1.0).abs()).enumerate();
        off.filter(|(_, v)| v.is_finite()).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// The rank of each detector by its largest mismatch, 1 being the best; detectors without any come last.
#[must_use]
pub fn ranks(all: &[Detector]) -> Vec<usize> {
    let key = |d: &Detector| d.worst().map_or(f64::INFINITY, |(_, v)| v);
    all.iter().map(|d| 1 + all.iter().filter(|o| key(o) < key(d)).count()).collect()
}

fn number(value: f64) -> Value {
    Some(value).filter(|v| v.is_finite()).map_or(Value::Null, Value::from)
}

fn stated(s: Option<Stated>) -> Value {
    s.map_or(Value::Null, |s| json!({"standard": s.standard, "expanded_95": s.expanded_95}))
}

/// The object of a detector in `results[]`; `lamps` are their names.
#[must_use]
pub fn json(d: &Detector, lamps: &[String], calibration: &str, rank: usize) -> Value {
    let by_lamp = |value: &dyn Fn(usize) -> Value| -> Map<String, Value> {
        lamps.iter().enumerate().map(|(i, name)| (name.clone(), value(i))).collect()
    };
    let mut out = json!({
        "path": d.path,
        "name": d.name,
        "calibration_source": calibration,
        "f1_prime": number(d.figures.f1_prime),
        "mismatch_factor": by_lamp(&|i| number(d.figures.mismatch_factors[i])),
        "largest_mismatch": d.worst().map(|(i, v)| json!({"lamp": lamps[i], "absolute": v})),
        "rank": rank,
    });
    if let Some(u) = &d.uncertainty {
        let contributions = u.contributions.iter().map(|(name, standard)| {
            let factors = by_lamp(&|i| number(standard[i + 1]));
            json!({"name": name, "standard": {"f1_prime": number(standard[0]), "mismatch_factor": factors}})
        });
        let contributions: Vec<Value> = contributions.collect();
        out["uncertainty"] =
            json!({"f1_prime": stated(u.f1_prime), "mismatch_factor": by_lamp(&|i| stated(u.mismatch_factors[i]))});
        out["uncertainty_budget"] = json!({"trials": u.trials, "contributions": contributions});
    }
    out
}

/// One row per detector and lamp.
#[must_use]
pub fn csv(all: &[Detector], lamps: &[String]) -> String {
    let mut out = csv::Writer::from_writer(Vec::new());
    let cell = |v: Option<f64>| v.filter(|v| v.is_finite()).map_or(String::new(), |v| v.to_string());
    let header = ["path", "name", "f1_prime", "lamp", "mismatch_factor", "standard", "low_95", "high_95"];
    // A vector takes every byte.
    let _ = out.write_record(header);
    for d in all {
        for (i, lamp) in lamps.iter().enumerate() {
            let u = d.uncertainty.as_ref().and_then(|u| u.mismatch_factors[i]);
            let _ = out.write_record([
                d.path.clone(),
                d.name.clone(),
                cell(Some(d.figures.f1_prime)),
                lamp.clone(),
                cell(Some(d.figures.mismatch_factors[i])),
                cell(u.map(|u| u.standard)),
                cell(u.map(|u| u.expanded_95[0])),
                cell(u.map(|u| u.expanded_95[1])),
            ]);
        }
    }
    String::from_utf8(out.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// For people: each detector with its lamps, then the ranking.
#[must_use]
pub fn text(all: &[Detector], lamps: &[String], calibration: &str, ranks: &[usize]) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    for d in all {
        let worth = d.uncertainty.as_ref().and_then(|u| u.f1_prime);
        let interval = worth.map_or(String::new(), |s| {
            let [low, high] = s.expanded_95.map(|v| 100.0 * v);
            format!(" (95 %: {low:.3} to {high:.3} %)")
        });
        let _ = writeln!(out, "{} [{}]: f1′ {:.3} %{interval}", d.path, d.name, 100.0 * d.figures.f1_prime);
        let _ = writeln!(out, "\n  {:<28} {:>10} {:>10}", "lamp", "factor", "standard");
        for (i, lamp) in lamps.iter().enumerate() {
            let factor = d.figures.mismatch_factors[i];
            let shown = if factor.is_finite() { format!("{factor:.5}") } else { "–".to_owned() };
            let u = d.uncertainty.as_ref().and_then(|u| u.mismatch_factors[i]);
            let u = u.map_or(String::new(), |s| significant(s.standard, 2));
            let _ = writeln!(out, "{}", format!("  {lamp:<28} {shown:>10} {u:>10}").trim_end());
        }
        out.push('\n');
    }
    let _ = writeln!(out, "  calibrated with {calibration}; a reading times the factor is right for the lamp");
    if all.len() > 1 {
        let mut order: Vec<(&usize, &Detector)> = ranks.iter().zip(all).collect();
        order.sort_by_key(|(rank, _)| **rank);
        let _ = writeln!(out, "\n  ranking by the largest mismatch");
        for (rank, d) in order {
            let worst = d.worst().map_or("–".to_owned(), |(i, v)| format!("{:.2} % ({})", 100.0 * v, lamps[i]));
            let _ = writeln!(out, "  {rank:>3}  {} [{}]  {worst}", d.path, d.name);
        }
    }
    out
}

//! `lamp compare`: two luminaires side by side.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::luminaire::compare::{Comparison, Pair};
use crate::luminaire::shape::ShapeDifference;
use crate::luminaire::{Kind, Luminaire, System};
use crate::units::significant;

const CORRELATION: &str = "∫ a b dω / √(∫ a² dω ∫ b² dω)";
const MEAN_DIFFERENCE: &str = "∫ |a − b| dω / ∫ ½(a + b) dω, each divided by its flux";

fn pair(p: &Pair) -> Value {
    json!({"a": p.a, "b": p.b, "difference": p.difference(), "difference_relative": p.relative()})
}

fn shape(s: &ShapeDifference) -> Map<String, Value> {
    let (c, gamma) = s.max_direction_deg;
    let value = json!({
        "correlation": s.correlation,
        "correlation_definition": CORRELATION,
        "mean_absolute_difference": s.mean_absolute_difference,
        "mean_absolute_difference_definition": MEAN_DIFFERENCE,
        "max_local_difference_percent_of_peak": 100.0 * s.max_local_difference,
        "max_local_difference_direction_deg": {"c": c, "gamma": gamma},
        "quadrature": if s.exact { "exact per cell" } else { "by direction, 1° grid" },
        "quadrature_error": s.quadrature_error,
    });
    value.as_object().cloned().unwrap_or_default()
}

/// The object of `lamp compare` in `results[]`; `tolerance` is a fraction.
#[must_use]
pub fn compare(paths: [&str; 2], lamps: [&Luminaire; 2], c: &Comparison, tolerance: Option<f64>) -> Map<String, Value> {
    let mut out = Map::new();
    let mut set = |key: &str, value: Value| {
        out.insert(key.to_owned(), value);
    };
    set("path_a", paths[0].into());
    set("path_b", paths[1].into());
    let (flux, peak) = keys(lamps[0].kind);
    if let Some(p) = &c.flux {
        set(flux, pair(p));
    }
    if let Some(p) = &c.peak {
        set(peak, pair(p));
    }
    for (key, lamp) in ["peak_direction_a_deg", "peak_direction_b_deg"].into_iter().zip(lamps) {
        let (_, h, v) = lamp.distribution.peak();
        set(key, json!({"c": h, "gamma": v}));
    }
    set("peak_separation_deg", c.peak_separation_deg.into());
    let beams = c.beam.iter().map(|b| {
        json!({"definition": b.definition.name(), "c0_c180": b.c0_c180.as_ref().map(pair), "c90_c270": b.c90_c270.as_ref().map(pair)})
    });
    set("beam_angle_deg", beams.collect::<Vec<_>>().into());
    if let Some(p) = &c.input_power_w {
        set("input_power_w", pair(p));
    }
    if let Some([length, width, height]) = &c.opening_m {
        set("luminous_opening_m", json!({"length": pair(length), "width": pair(width), "height": pair(height)}));
    }
    set("shape", shape(&c.shape).into());
    if let Some(turn) = &c.turn {
        let mut object = Map::from_iter([("turn_b_deg".to_owned(), turn.turn_deg.into())]);
        object.extend(shape(&turn.shape));
        set("best_turn", object.into());
    }
    if let Some(tolerance) = tolerance {
        set("tolerance", tolerance.into());
        set("passes", c.within(tolerance).into());
    }
    out
}

fn keys(kind: Kind) -> (&'static str, &'static str) {
    match kind {
        Kind::Luminous => ("total_flux_lm", "peak_intensity_cd"),
        Kind::Radiant => ("total_flux_w", "peak_intensity_w_per_sr"),
        Kind::Photon => ("total_flux_umol_per_s", "peak_intensity_umol_per_s_sr"),
    }
}

/// The comparison for people.
#[must_use]
pub fn compare_text(paths: [&str; 2], lamps: [&Luminaire; 2], c: &Comparison, tolerance: Option<f64>) -> String {
    let mut out = format!("A {}\nB {}\n\n", paths[0], paths[1]);
    let mut line = |label: &str, value: String| {
        let _ = writeln!(out, "  {label:<26} {value}");
    };
    let (flux_unit, peak_unit) = match lamps[0].kind {
        Kind::Luminous => ("lm", "cd"),
        Kind::Radiant => ("W", "W/sr"),
        Kind::Photon => ("µmol/s", "µmol/(s·sr)"),
    };
    match (&c.flux, &c.peak) {
        (Some(flux), Some(peak)) => {
            line("flux", shown(flux, flux_unit));
            line("peak", shown(peak, peak_unit));
        }
        _ => line("flux, peak", "not of one kind: only the shapes are compared".to_owned()),
    }
    let at = |lamp: &Luminaire| {
        let (_, h, v) = lamp.distribution.peak();
        let (first, second) = axes(lamp.distribution.system());
        format!("{first} {h}°, {second} {v}°")
    };
    let apart = significant(c.peak_separation_deg, 3);
    line("direction of peak", format!("{} → {}, {apart}° apart", at(lamps[0]), at(lamps[1])));
    for b in &c.beam {
        for (plane, pair) in [("C0–C180", &b.c0_c180), ("C90–C270", &b.c90_c270)] {
            if let Some(p) = pair {
                line(&format!("beam {plane}"), format!("{} ({})", shown(p, "°"), b.definition.name()));
            }
        }
    }
    if let Some(p) = &c.input_power_w {
        line("input power", shown(p, "W"));
    }
    if let Some(extents) = &c.opening_m {
        for (name, p) in ["opening length", "opening width", "opening height"].into_iter().zip(extents) {
            line(name, shown(p, "m"));
        }
    }
    let mut shape_lines = |s: &ShapeDifference| {
        line("shape: correlation", format!("{:.6}   {CORRELATION}", s.correlation));
        let error = if s.exact { "at most" } else { "about" };
        line(
            "shape: mean difference",
            format!(
                "{} %   {MEAN_DIFFERENCE}; quadrature off by {error} {} %",
                significant(100.0 * s.mean_absolute_difference, 4),
                significant(100.0 * s.quadrature_error, 2)
            ),
        );
        let (h, v) = s.max_direction_deg;
        let (first, second) = axes(if s.exact { lamps[0].distribution.system() } else { System::TypeC });
        let worst = significant(100.0 * s.max_local_difference, 4);
        line("shape: largest difference", format!("{worst} % of A's peak at {first} {h}°, {second} {v}°"));
    };
    shape_lines(&c.shape);
    if let Some(turn) = &c.turn {
        let _ = writeln!(
            out,
            "\n  B turned by {}° about the vertical (towards increasing C) is much more like A:",
            significant(turn.turn_deg, 5)
        );
        let _ = writeln!(
            out,
            "  correlation {:.6}, mean difference {} %",
            turn.shape.correlation,
            significant(100.0 * turn.shape.mean_absolute_difference, 4)
        );
    }
    if let Some(tolerance) = tolerance {
        let verdict = if c.within(tolerance) { "within" } else { "NOT within" };
        let percent = significant(100.0 * tolerance, 3);
        let _ = writeln!(out, "\n  {verdict} {percent} % (flux, peak, mean difference of the shapes)");
    }
    out
}

fn axes(system: System) -> (&'static str, &'static str) {
    if system == System::TypeC { ("C", "γ") } else { ("H", "V") }
}

fn shown(p: &Pair, unit: &str) -> String {
    let gap = if unit == "°" { "" } else { " " };
    let relative = match p.relative() {
        Some(r) => format!(", {}{} %", if r > 0.0 { "+" } else { "" }, significant(100.0 * r, 3)),
        None => String::new(),
    };
    let sign = if p.difference() > 0.0 { "+" } else { "" };
    let difference = significant(p.difference(), 3);
    format!("{}{gap}{unit} → {}{gap}{unit}   ({sign}{difference}{relative})", significant(p.a, 6), significant(p.b, 6))
}

//! `capture`: the camera, its response and merged stacks.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::capture::camera::{Calibration, PARAMETERS, View};
use crate::capture::response::{Consistency, Curve};
use crate::units::significant;

/// Name of a channel of a photograph: `Y` where there is one.
#[must_use]
pub fn channel_name(channels: usize, channel: usize) -> &'static str {
    if channels == 1 { "Y" } else { ["R", "G", "B"][channel.min(2)] }
}

/// `response` and `consistency_rms_ln`.
#[must_use]
pub fn response(curves: &[Curve], agreement: &Consistency) -> Value {
    let table = |(c, curve): (usize, &Curve)| {
        let errors: Option<Vec<f64>> =
            curve.covariance.as_ref().map(|m| m.diagonal().iter().map(|v| v.max(0.0).sqrt()).collect());
        let mut out = json!({
            "channel": channel_name(curves.len(), c),
            "ln_g": curve.ln_g,
            "decreasing_steps": curve.decreasing_steps(),
        });
        if let Some(errors) = errors {
            out["standard_errors"] = errors.into();
        }
        out
    };
    let exposures = agreement.exposures.iter().map(|s| {
        json!({
            "stack": s.stack, "photo": s.name, "time_s": s.time_s, "offset_ln": s.offset_ln, "rms_ln": s.rms_ln,
            "samples": s.samples,
        })
    });
    json!({
        "response": curves.iter().enumerate().map(table).collect::<Vec<_>>(),
        "consistency_rms_ln": agreement.rms_ln,
        "exposures": exposures.collect::<Vec<_>>(),
    })
}

/// The curves as one table, a row per code.
#[must_use]
pub fn response_csv(curves: &[Curve]) -> String {
    let mut out = String::from("code");
    for c in 0..curves.len() {
        let name = channel_name(curves.len(), c);
        let _ = write!(out, ",ln_g_{name},standard_error_{name}");
    }
    out.push('\n');
    for z in 0..curves.first().map_or(0, |c| c.ln_g.len()) {
        let _ = write!(out, "{z}");
        for curve in curves {
            let error =
                curve.covariance.as_ref().map_or_else(String::new, |_| curve.standard_error(z as f64).to_string());
            let _ = write!(out, ",{},{error}", curve.ln_g[z]);
        }
        out.push('\n');
    }
    out
}

/// The response for people: a few codes, and how the exposures agree.
#[must_use]
pub fn response_text(curves: &[Curve], agreement: &Consistency) -> String {
    let mut out = String::from("code");
    // Writing to a string cannot fail.
    for c in 0..curves.len() {
        let _ = write!(out, "{:>19}", format!("ln g {}", channel_name(curves.len(), c)));
    }
    out.push('\n');
    for z in [1_u8, 4, 16, 32, 64, 96, 128, 160, 192, 224, 240, 250, 254] {
        let _ = write!(out, "{z:>4}");
        for curve in curves {
            let error = match curve.covariance {
                Some(_) => format!(" ± {:.4}", curve.standard_error(f64::from(z))),
                None => String::new(),
            };
            let _ = write!(out, "{:>19}", format!("{:.4}{error}", curve.ln_g[usize::from(z)]));
        }
        out.push('\n');
    }
    let _ = writeln!(out, "\nexposures agree to an rms of {:.4} in ln(g/t)", agreement.rms_ln);
    let width = agreement.exposures.iter().map(|s| s.name.chars().count()).max().unwrap_or(0);
    for s in &agreement.exposures {
        let _ = writeln!(
            out,
            "{:width$}  {:>10} s  offset {:>8.4}  rms {:.4}  {} samples",
            s.name,
            significant(s.time_s, 4),
            s.offset_ln,
            s.rms_ln,
            s.samples
        );
    }
    out
}

/// `intrinsics`, `distortion`, `rms_px` and the views.
#[must_use]
pub fn calibration(views: &[View], found: &Calibration) -> Value {
    let part = |range: std::ops::Range<usize>, values: &[f64; 9]| -> Map<String, Value> {
        range.map(|i| (PARAMETERS[i].to_owned(), values[i].into())).collect()
    };
    let (values, errors) = (found.parameters(), found.standard_errors);
    let stated = found.stated();
    let ends = |range: std::ops::Range<usize>| -> Map<String, Value> {
        range.map(|i| (PARAMETERS[i].to_owned(), json!(stated[i].expanded_95))).collect()
    };
    let outliers = found.outliers();
    let each = views.iter().zip(&found.views).enumerate().map(|(n, (view, (pose, rms)))| {
        json!({
            "name": view.name,
            "corners": view.seen.len(),
            "rms_px": rms,
            "rotation_rad": pose.rotation.to_array(),
            "translation": pose.translation.to_array(),
            "outlier": outliers.contains(&n),
        })
    });
    json!({
        "intrinsics": part(0..4, &values),
        "distortion": part(4..9, &values),
        "standard_errors": {"intrinsics": part(0..4, &errors), "distortion": part(4..9, &errors)},
        "expanded_95": {"intrinsics": ends(0..4), "distortion": ends(4..9)},
        "rms_px": found.rms_px,
        "views": each.collect::<Vec<_>>(),
    })
}

/// The camera for people.
#[must_use]
pub fn calibration_text(views: &[View], found: &Calibration) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    for ((name, value), error) in PARAMETERS.iter().zip(found.parameters()).zip(found.standard_errors) {
        let unit = if matches!(*name, "fx" | "fy" | "cx" | "cy") { " px" } else { "" };
        let _ = writeln!(out, "{name}  {value:>11.5} ± {}{unit}", significant(error, 2));
    }
    let _ = writeln!(out, "\n{:.5} px rms over {} views", found.rms_px, views.len());
    let width = views.iter().map(|v| v.name.chars().count()).max().unwrap_or(0);
    for (view, (_, rms)) in views.iter().zip(&found.views) {
        let _ = writeln!(out, "{:width$}  {rms:.4} px, {} corners", view.name, view.seen.len());
    }
    out
}

/// A merged stack.
#[must_use]
pub fn merged(name: &str, used: &[String], counts: [usize; 4], written: &str) -> Value {
    json!({
        "stack": name,
        "exposures": used,
        "samples": {"valid": counts[0], "saturated": counts[1], "dark": counts[2], "gap": counts[3]},
        "written": written,
    })
}

/// A merged stack for people, from [`merged`].
#[must_use]
pub fn merged_text(result: &Value) -> String {
    let count = |key: &str| result["samples"][key].as_u64().unwrap_or(0);
    format!(
        "{}: {} exposures, {} samples valid, {} saturated, {} dark, {} between\nwritten: {}\n",
        result["stack"].as_str().unwrap_or_default(),
        result["exposures"].as_array().map_or(0, Vec::len),
        count("valid"),
        count("saturated"),
        count("dark"),
        count("gap"),
        result["written"].as_str().unwrap_or_default(),
    )
}

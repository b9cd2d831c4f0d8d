//! `lamp grid`: illuminance on a plane.

use std::fmt::Write;

use glam::DVec3;
use serde_json::{Map, Value, json};

use crate::luminaire::Kind;
use crate::luminaire::grid::{Illuminance, PointsAt, Receiver};
use crate::units::significant;

/// Key of the values of a kind.
#[must_use]
pub fn grid_key(kind: Kind) -> &'static str {
    match kind {
        Kind::Luminous => "illuminance_lx",
        Kind::Radiant => "irradiance_w_per_m2",
        Kind::Photon => "photon_irradiance_umol_per_m2_s",
    }
}

fn unit(kind: Kind) -> &'static str {
    match kind {
        Kind::Luminous => "lx",
        Kind::Radiant => "W/m²",
        Kind::Photon => "µmol/(m²·s)",
    }
}

/// The object of `lamp grid` in `results[]`.
#[must_use]
pub fn grid(e: &Illuminance, maintenance_factor: f64) -> Map<String, Value> {
    let plane = &e.plane;
    let list = |v: DVec3| json!(v.to_array());
    let [u, v] = plane.axes();
    let key = grid_key(e.kind);
    let mut out = Map::new();
    let mut set = |key: &str, value: Value| {
        out.insert(key.to_owned(), value);
    };
    set("light", "direct, unobstructed".into());
    let (receiver, facing) = match e.receiver {
        Receiver::Planar(n) => ("planar", Some(n.normalize())),
        Receiver::Cylindrical => ("cylindrical", None),
        Receiver::Semicylindrical(f) => ("semicylindrical", Some(f.normalize())),
    };
    set("receiver", receiver.into());
    if let Some(facing) = facing {
        set("facing", list(facing));
    }
    set("origin_m", list(plane.origin_m()));
    set("axis_u", list(u));
    set("axis_v", list(v));
    set("size_m", json!(plane.size_m()));
    set("points", json!(plane.counts()));
    set("spacing_m", json!(plane.spacing_m()));
    set("points_at", if plane.points_at() == PointsAt::Nodes { "nodes" } else { "centres" }.into());
    set("maintenance_factor", maintenance_factor.into());
    if let Some(f) = &e.figures {
        set(&format!("minimum_{key}"), f.minimum.into());
        set(&format!("mean_{key}"), f.mean.into());
        set(&format!("maximum_{key}"), f.maximum.into());
        set("minimum_at_m", list(plane.point_m(f.minimum_at)));
        set("maximum_at_m", list(plane.point_m(f.maximum_at)));
        set("uniformity_u0", json!(f.u0));
        set("uniformity_ud", json!(f.ud));
    }
    if let Some(p) = &e.point_error {
        set(
            "point_source_error",
            json!({"maximum_relative": p.relative, "at_m": plane.point_m(p.at).to_array(), key: p.value, format!("as_point_{key}"): p.as_point, "points_near": p.points_near}),
        );
    }
    set("u_m", json!(plane.u_m()));
    set("v_m", json!(plane.v_m()));
    // NaN becomes null.
    set(key, e.values.chunks(plane.counts()[0]).map(|row| json!(row)).collect::<Vec<_>>().into());
    out
}

/// Most columns and rows of the table for people.
const SHOWN: usize = 12;

/// `lamp grid` for people.
#[must_use]
pub fn grid_text(e: &Illuminance, maintenance_factor: f64) -> String {
    let (plane, unit) = (&e.plane, unit(e.kind));
    let place = |i: usize| {
        let p = plane.point_m(i).to_array().map(|v| ((v * 1e4).round() / 1e4 + 0.0).to_string());
        format!("({})", p.join(", "))
    };
    let show = |v: f64| significant(v, 4);
    let [m, n] = plane.counts();
    let [du, dv] = plane.spacing_m();
    let mut out = String::new();
    // Writing to a string cannot fail.
    let mut line = |label: &str, value: String| {
        let _ = writeln!(out, "  {label:<22} {value}");
    };
    line("light", format!("direct, unobstructed; maintenance factor {maintenance_factor}"));
    line("points", format!("{m} × {n}, {} × {} m apart", significant(du, 3), significant(dv, 3)));
    if let Some(f) = &e.figures {
        line("minimum", format!("{} {unit} at {}", show(f.minimum), place(f.minimum_at)));
        line("mean", format!("{} {unit}", show(f.mean)));
        line("maximum", format!("{} {unit} at {}", show(f.maximum), place(f.maximum_at)));
        let ratio = |v: Option<f64>| v.map_or_else(|| "–".to_owned(), |v| format!("{v:.3}"));
        line("uniformity", format!("U0 {} (min/mean), Ud {} (min/max)", ratio(f.u0), ratio(f.ud)));
    }
    match &e.point_error {
        Some(p) => line(
            "as points",
            format!(
                "luminaires subdivided at {} points; as points up to {} % off, at {}: {} instead of {} {unit}",
                p.points_near,
                significant(100.0 * p.relative, 2),
                place(p.at),
                show(p.as_point),
                show(p.value)
            ),
        ),
        None => {
            line("as points", "all luminaires taken as points: none is near, or its opening is not known".to_owned())
        }
    }
    let pick = |count: usize| -> Vec<usize> {
        let shown = count.min(SHOWN);
        (0..shown).map(|i| if shown > 1 { i * (count - 1) / (shown - 1) } else { 0 }).collect()
    };
    let (columns, rows) = (pick(m), pick(n));
    let _ = writeln!(
        out,
        "\n  {unit}, distance from the first corner along the first side to the right, along the second upwards [m]{}\n",
        if m > SHOWN || n > SHOWN { ", a selection" } else { "" }
    );
    let (u, v) = (plane.u_m(), plane.v_m());
    for j in rows.into_iter().rev() {
        let cells: String = columns
            .iter()
            .map(|i| e.values[j * m + i])
            .map(|v| if v.is_nan() { format!("{:>9}", "–") } else { format!("{:>9}", significant(v, 3)) })
            .collect();
        let _ = writeln!(out, "  {:>8.2} |{cells}", v[j]);
    }
    let _ = writeln!(out, "  {:>8} |{}", "", columns.iter().map(|i| format!("{:>9.2}", u[*i])).collect::<String>());
    out
}

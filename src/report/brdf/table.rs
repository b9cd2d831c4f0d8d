//! What a measured table is, as JSON and text.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::object;
use crate::brdf::format::File;
use crate::brdf::table::Table;
use crate::brdf::table::specular::Rim;
use crate::units::significant;

/// The table's own facts, beside what every material has.
pub(super) fn facts(file: &File) -> Map<String, Value> {
    let table = &file.table;
    let (nodes, missing) = table.coverage();
    let axes = table
        .axes()
        .into_iter()
        .map(|a| json!({"name": a.name, "nodes": a.nodes, "low_deg": a.low_deg, "high_deg": a.high_deg}));
    let mut out = object(json!({
        "table": table.kind(),
        "parameterisation": table.parameterisation().name(),
        "axes": axes.collect::<Vec<_>>(),
        "nodes": nodes,
        "missing": missing,
        "missing_fraction": missing as f64 / nodes.max(1) as f64,
        "range_per_sr": table.range(),
    }));
    let scatter = scatter(file);
    if !scatter.is_empty() {
        let rows = scatter.iter().map(|[angle, tis, cut, extrapolated, filled]| {
            json!({"theta_i_deg": angle, "printed": tis, "cut": cut, "extrapolated": extrapolated, "filled": filled})
        });
        out.insert("tis".to_owned(), rows.collect::<Vec<_>>().into());
    }
    out
}

/// Angle, TIS as printed, and our integrals: cut at the last radial angle, extrapolated, and filled to the horizon.
fn scatter(file: &File) -> Vec<[f64; 5]> {
    let Table::Specular(table) = &file.table else { return Vec::new() };
    let row = |(angle, tis): (&f64, &f64)| {
        let [cut, extrapolated, filled] =
            [Rim::Cut, Rim::Extrapolated, Rim::Filled].map(|rim| table.scatter(*angle, rim)[0]);
        [*angle, *tis, cut, extrapolated, filled]
    };
    table.incidences_deg().iter().zip(&file.printed_tis).map(row).collect()
}

/// The same for people.
pub(super) fn facts_text(file: &File) -> String {
    let table = &file.table;
    let (nodes, missing) = table.coverage();
    let mut out = format!("  format      {}: {}\n", file.format, table.kind());
    // Writing to a string cannot fail.
    let _ = writeln!(out, "  coordinates {}", table.parameterisation().name());
    for a in table.axes() {
        let (low, high) = (significant(a.low_deg, 5), significant(a.high_deg, 5));
        let span = if a.nodes == 1 { format!("at {low}°") } else { format!("{low}° to {high}°") };
        let _ = writeln!(out, "    {:<16} {:>4}, {span}", a.name, a.nodes);
    }
    let share = 100.0 * missing as f64 / nodes.max(1) as f64;
    let _ = writeln!(out, "  places      {nodes}, {missing} of them missing ({} %)", significant(share, 3));
    let channels = table.channels();
    let names: Vec<String> = channels.iter().take(8).map(ToString::to_string).collect();
    let more = if channels.len() > 8 { format!(", … {}", channels[channels.len() - 1]) } else { String::new() };
    let _ = writeln!(out, "  channels    {}: {}{more}", channels.len(), names.join(", "));
    if let Some([low, high]) = table.range() {
        let _ = writeln!(out, "  values      {} to {} /sr", significant(low, 5), significant(high, 5));
    }
    let scatter = scatter(file);
    if !scatter.is_empty() {
        let _ = writeln!(out, "  TIS at θi   printed    our integral: cut, extrapolated, filled to the horizon");
        for [angle, values @ ..] in scatter {
            let shown = values.map(|v| format!("{v:.5}"));
            let _ = writeln!(out, "    {angle:>5}°    {}", shown.join("    "));
        }
    }
    out
}

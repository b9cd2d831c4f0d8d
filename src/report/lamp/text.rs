//! `lamp info` for people, from the JSON object: figures with their units and how they are defined.

use std::fmt::Write;

use serde_json::{Map, Value};

use crate::units::significant;

/// Width of the labels' column.
const LABEL: usize = 26;

struct Lines(String);

impl Lines {
    /// A line, unless there is nothing to say.
    fn line(&mut self, label: &str, value: impl AsRef<str>) {
        let value = value.as_ref();
        if !value.is_empty() {
            // Writing to a string cannot fail.
            let _ = writeln!(self.0, "  {label:<LABEL$} {value}");
        }
    }

    fn gap(&mut self) {
        if !self.0.ends_with("\n\n") {
            self.0.push('\n');
        }
    }
}

/// The report of one file.
#[must_use]
pub fn info_text(path: &str, o: &Map<String, Value>) -> String {
    let name = Some(text(o, "name")).filter(|n| !n.is_empty()).map_or_else(String::new, |n| format!("{n} "));
    let mut out = Lines(format!("{path}: {name}({})\n\n", text(o, "format_version")));
    facts(&mut out, o);
    out.gap();
    fluxes(&mut out, o);
    out.gap();
    beams(&mut out, o);
    out.gap();
    zones(&mut out, o);
    luminances(&mut out, o);
    cone(&mut out, o);
    out.0.truncate(out.0.trim_end().len());
    out.0.push('\n');
    out.0
}

fn facts(out: &mut Lines, o: &Map<String, Value>) {
    out.line("manufacturer", text(o, "manufacturer"));
    out.line("catalogue number", text(o, "catalogue_number"));
    let absolute = if o.get("absolute") == Some(&Value::Bool(true)) { "absolute" } else { "relative to its lamps" };
    let angles = format!("{} × {} angles", number(o, "horizontal_angles", 6), number(o, "vertical_angles", 6));
    let (kind, symmetry) = (text(o, "photometry_type"), text(o, "symmetry").replace('_', " "));
    let symmetry = if symmetry == "none" { "no symmetry".to_owned() } else { format!("{symmetry} symmetry") };
    out.line("photometry", format!("Type {kind}, {symmetry}, {angles}, {absolute}"));
    if let Some(b) = o.get("luminous_opening_m") {
        let size = ["length_m", "width_m", "height_m"]
            .map(|k| trimmed(&significant(b[k].as_f64().unwrap_or_default(), 4)).to_owned());
        let shape = b["shape"].as_str().unwrap_or_default().replace('_', " ");
        let size = if shape == "point" {
            String::new()
        } else {
            format!(", {} m (along C90 × along C0 × height)", size.join(" × "))
        };
        out.line("luminous opening", shape + &size);
    }
}

fn fluxes(out: &mut Lines, o: &Map<String, Value>) {
    let units = [
        ("lm", "lm", "cd", "cd"),
        ("W", "w", "W/sr", "w_per_sr"),
        ("µmol/s", "umol_per_s", "µmol/(s·sr)", "umol_per_s_sr"),
    ];
    for (unit, key, peak_unit, peak_key) in units {
        let flux = |name: &str| with_unit(o, &format!("{name}_{key}"), 6, unit);
        out.line("flux", noted(flux("total_flux"), "exact integral, linear in both angles"));
        out.line("flux, zonal rule", noted(flux("total_flux_zonal"), "native intervals, end-point means"));
        out.line("flux declared", flux("declared_flux"));
        let peak = with_unit(o, &format!("peak_intensity_{peak_key}"), 6, peak_unit);
        if !peak.is_empty() {
            let at =
                |axis: &str| o["peak_direction_deg"][axis].as_f64().map_or_else(String::new, |v| significant(v, 4));
            let (c, gamma) = if text(o, "photometry_type") == "C" { ("C", "γ") } else { ("H", "V") };
            out.line("peak", format!("{peak} at {c} {}°, {gamma} {}°", trimmed(&at("c")), trimmed(&at("gamma"))));
        }
    }
    out.line("downward fraction", noted(number(o, "downward_flux_fraction", 4), "of the flux, below the horizontal"));
    out.line("light output ratio", noted(number(o, "light_output_ratio", 4), "luminaire over its lamps"));
    out.line("input power", with_unit(o, "input_power_w", 4, "W"));
    out.line("luminous efficacy", with_unit(o, "luminous_efficacy_lm_per_w", 4, "lm/W"));
}

fn beams(out: &mut Lines, o: &Map<String, Value>) {
    let planes = if text(o, "photometry_type") == "C" { "C0–C180 × C90–C270" } else { "horizontal × vertical" };
    for (label, key) in [("beam angle (50 %)", "beam_angle_deg"), ("field angle (10 %)", "field_angle_deg")] {
        for (i, a) in o.get(key).and_then(Value::as_array).into_iter().flatten().enumerate() {
            let definition = match a["definition"].as_str() {
                Some("fwhm") => format!("about the plane's maximum; {planes}"),
                Some("outermost") => "outermost, of the maximum of all planes".to_owned(),
                _ => "about nadir, of the value there".to_owned(),
            };
            let [first, second] = ["c0_c180", "c90_c270"].map(|k| angle(&a[k]));
            out.line(if i == 0 { label } else { "" }, noted(format!("{first} × {second}"), &definition));
        }
    }
    let pair = o.get("nema_type").and_then(Value::as_array).map(|n| format!("{} × {}", n[0], n[1]));
    out.line("NEMA type", noted(pair.unwrap_or_default(), "horizontal × vertical, by the outermost 10 %"));
    if let Some(s) = o.get("spacing_criterion") {
        let [c0, c90, diagonal] = ["c0_c180", "c90_c270", "diagonal"].map(|k| s[k].as_f64().unwrap_or(f64::NAN));
        let value = format!("{c0:.2} along C0–C180, {c90:.2} along C90–C270, {diagonal:.2} diagonally");
        out.line("spacing criterion", noted(value, "spacing over mounting height"));
    }
}

fn zones(out: &mut Lines, o: &Map<String, Value>) {
    if let Some(code) = o.get("cie_flux_code").and_then(Value::as_array) {
        let parts: Vec<String> = code.iter().filter_map(Value::as_f64).map(|v| format!("{v:.0}")).collect();
        out.line("CIE flux code", parts.join(" "));
    }
    out.line("BUG rating", noted(text(o, "bug_rating"), "IES TM-15-11"));
    if let Some(lcs) = o.get("lcs_lm") {
        let zone = |keys: &[&str]| {
            keys.iter()
                .map(|k| lcs[*k].as_f64().map_or_else(String::new, |v| format!("{v:.1}")))
                .collect::<Vec<_>>()
                .join(", ")
        };
        out.line("LCS forward (lm)", noted(zone(&["fl", "fm", "fh", "fvh"]), "γ 0–30–60–80–90°"));
        out.line("LCS back (lm)", zone(&["bl", "bm", "bh", "bvh"]));
        out.line("LCS uplight (lm)", noted(zone(&["ul", "uh"]), "γ 90–100–180°"));
    }
    let Some(zones) = o.get("zonal_flux_lm").and_then(Value::as_array) else { return };
    let value = |zone: &Value, key: &str| zone[key].as_f64().unwrap_or_default();
    for (i, part) in zones.chunks(6).enumerate() {
        let cell = |z: &Value| {
            let range = format!("{}–{}°", value(z, "from_deg"), value(z, "to_deg"));
            format!("{range:<9}{:<9.1}", value(z, "flux_lm"))
        };
        let cells: String = part.iter().map(cell).collect();
        if i == 0 || part.iter().any(|z| value(z, "flux_lm") != 0.0) {
            out.line(if i == 0 { "flux by zones of γ (lm)" } else { "" }, cells.trim_end());
        }
    }
}

/// Every third row of the table, and only as far as the symmetry goes.
fn luminances(out: &mut Lines, o: &Map<String, Value>) {
    let Some(rows) = o.get("luminance_cd_per_m2").and_then(Value::as_array) else { return };
    let last = if matches!(text(o, "symmetry").as_str(), "rotational" | "quadrant") { 90.0 } else { 360.0 };
    out.gap();
    out.line("luminance (cd/m²)", "γ 65°      75°        85°");
    for row in rows.iter().step_by(3).filter(|r| r["c_deg"].as_f64().is_some_and(|c| c <= last)) {
        let cell = |v: &Value| v.as_f64().map_or_else(|| "–".to_owned(), |v| significant(v, 4));
        let cells: String =
            row["cd_per_m2"].as_array().into_iter().flatten().map(|v| format!("{:<11}", cell(v))).collect();
        out.line(&format!("  C{}", row["c_deg"].as_f64().unwrap_or_default()), cells.trim_end());
    }
}

fn cone(out: &mut Lines, o: &Map<String, Value>) {
    out.gap();
    if let Some(e) = o.get("equivalent_cone") {
        let value = |key: &str, digits| e[key].as_f64().map_or_else(String::new, |v| significant(v, digits));
        let flux = [("flux_lm", "lm"), ("flux_w", "W"), ("flux_umol_per_s", "µmol/s")];
        let flux =
            flux.into_iter().find(|(k, _)| e.get(*k).is_some()).map(|(k, unit)| format!("{} {unit}", value(k, 5)));
        let cone = format!(
            "{:.1}°, {} sr, {}",
            e["angle_deg"].as_f64().unwrap_or_default(),
            value("solid_angle_sr", 4),
            flux.unwrap_or_default()
        );
        out.line("equivalent cone", noted(cone, "where half of the maximum is reached"));
    }
    for (i, row) in o.get("cone").and_then(Value::as_array).into_iter().flatten().enumerate() {
        let number = |key: &str| row[key].as_f64();
        let axis = [
            ("axis_illuminance_lx", "lx"),
            ("axis_irradiance_w_per_m2", "W/m²"),
            ("axis_photon_irradiance_umol_per_m2_s", "µmol/(m²·s)"),
        ];
        let axis = axis.into_iter().find_map(|(k, unit)| number(k).map(|v| format!("{} {unit}", significant(v, 4))));
        let width = |key: &str| number(key).map(|v| format!("{} m", significant(v, 3)));
        let beam = match (width("width_c0_c180_m"), width("width_c90_c270_m")) {
            (None, None) => String::new(),
            (a, b) => {
                let [a, b] = [a, b].map(|w| w.unwrap_or_else(|| "–".to_owned()));
                format!("beam {a} × {b}")
            }
        };
        let line = format!("{:<16} {beam}", axis.unwrap_or_default());
        out.line(&format!("at {} m on the axis", number("distance_m").unwrap_or_default()), line.trim_end());
        if i == 2 {
            break;
        }
    }
}

fn text(o: &Map<String, Value>, key: &str) -> String {
    o.get(key).and_then(Value::as_str).unwrap_or_default().to_owned()
}

fn number(o: &Map<String, Value>, key: &str, digits: usize) -> String {
    match o.get(key) {
        Some(Value::Number(n)) if n.is_u64() => n.to_string(),
        Some(v) => v.as_f64().map_or_else(String::new, |v| significant(v, digits)),
        None => String::new(),
    }
}

fn with_unit(o: &Map<String, Value>, key: &str, digits: usize, unit: &str) -> String {
    let value = number(o, key, digits);
    if value.is_empty() { value } else { format!("{value} {unit}") }
}

/// A value with its definition behind it.
fn noted(value: String, note: &str) -> String {
    if value.is_empty() { value } else { format!("{value:<16} ({note})") }
}

/// Without zeros behind the point.
fn trimmed(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

fn angle(value: &Value) -> String {
    value.as_f64().map_or_else(|| "–".to_owned(), |v| format!("{v:.1}°"))
}

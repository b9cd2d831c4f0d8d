//! `lamp info`: the facts and figures of one luminaire.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::luminaire::format::{File, Format};
use crate::luminaire::{Body, Kind, Symmetry, System, beam, bug, lcs, luminance, nema, spacing, zonal};
use crate::units::significant;

/// C-plane of the street side: C0 in LM-63, C90 in EULUMDAT and TM-33.
fn street_side(file: &File) -> f64 {
    match file.format {
        Format::Ies => lcs::STREET_C_DEG_IES,
        _ => lcs::STREET_C_DEG_EULUMDAT,
    }
}

/// The object of `lamp info` in `results[]`; figures that do not apply are absent.
#[must_use]
pub fn info(file: &File) -> Map<String, Value> {
    let lamp = &file.luminaire;
    let d = &lamp.distribution;
    let luminous = lamp.kind == Kind::Luminous;
    let mut out = Map::new();
    let mut set = |key: &str, value: Value| {
        out.insert(key.to_owned(), value);
    };
    for (key, text) in
        [("name", &lamp.name), ("manufacturer", &lamp.manufacturer), ("catalogue_number", &lamp.catalogue_number)]
    {
        if !text.is_empty() {
            set(key, text.clone().into());
        }
    }
    set("format", file.format.to_string().into());
    set("format_version", file.version.clone().into());
    set("photometry_type", system(d.system()).into());
    set("symmetry", symmetry(d.symmetry()).into());
    set("vertical_angles", d.vertical_deg().len().into());
    set("horizontal_angles", d.horizontal_deg().len().into());
    set("absolute", lamp.absolute.into());
    let (flux, zonal_flux, peak_key, declared) = match lamp.kind {
        Kind::Luminous => ("total_flux_lm", "total_flux_zonal_lm", "peak_intensity_cd", "declared_flux_lm"),
        Kind::Radiant => ("total_flux_w", "total_flux_zonal_w", "peak_intensity_w_per_sr", "declared_flux_w"),
        Kind::Photon => (
            "total_flux_umol_per_s",
            "total_flux_zonal_umol_per_s",
            "peak_intensity_umol_per_s_sr",
            "declared_flux_umol_per_s",
        ),
    };
    if let Some(value) = lamp.declared_flux.or_else(|| zonal::lamp_flux_lm(lamp)) {
        set(declared, value.into());
    }
    set(flux, d.total_flux().into());
    set(zonal_flux, d.total_flux_zonal().into());
    let (peak, h, v) = d.peak();
    set(peak_key, peak.into());
    set("peak_direction_deg", json!({"c": h, "gamma": v}));
    let angles = |list: [beam::PlaneAngles; 3]| -> Value {
        list.iter()
            .map(|a| json!({"definition": a.definition.name(), "c0_c180": a.c0_c180, "c90_c270": a.c90_c270}))
            .collect::<Vec<_>>()
            .into()
    };
    set("beam_angle_deg", angles(beam::beam_angles(d)));
    set("field_angle_deg", angles(beam::field_angles(d)));
    if let Some((horizontal, vertical)) = nema::nema_types(d) {
        set("nema_type", json!([horizontal, vertical]));
    }
    if let (true, Ok(zones)) = (luminous, lcs::lcs(d, street_side(file))) {
        let named: Map<String, Value> = zones.named().iter().map(|(k, v)| ((*k).to_owned(), (*v).into())).collect();
        set("lcs_lm", named.into());
        set("bug_rating", bug::bug_rating(&zones, bug::lateral(d)).to_string().into());
    }
    if let (true, Ok(rows)) = (luminous, luminance::luminance_table(lamp, &luminance::TABLE_GAMMA_DEG)) {
        let rows: Vec<Value> = rows
            .iter()
            .map(|r| json!({"c_deg": r.c_deg, "gamma_deg": luminance::TABLE_GAMMA_DEG, "cd_per_m2": r.cd_per_m2}))
            .collect();
        set("luminance_cd_per_m2", rows.into());
    }
    if let Ok(fraction) = zonal::downward_flux_fraction(d) {
        set("downward_flux_fraction", fraction.into());
    }
    if let Ok(code) = zonal::cie_flux_code(lamp) {
        let all: Vec<f64> = code.n1_to_n4.into_iter().chain(code.n5).collect();
        set("cie_flux_code", json!(all));
    }
    if let (true, Ok(zones)) = (luminous, zonal::zones(d, 10.0)) {
        let zones: Vec<Value> =
            zones.iter().map(|z| json!({"from_deg": z.from_deg, "to_deg": z.to_deg, "flux_lm": z.flux})).collect();
        set("zonal_flux_lm", zones.into());
    }
    if let Some(watts) = lamp.input_power_w {
        set("input_power_w", watts.into());
    }
    if let (true, Some(efficacy)) = (luminous, zonal::efficacy(lamp)) {
        set("luminous_efficacy_lm_per_w", efficacy.into());
    }
    if let Some(ratio) = zonal::light_output_ratio(lamp) {
        set("light_output_ratio", ratio.into());
    }
    if let Ok(s) = spacing::spacing_criterion(d) {
        set("spacing_criterion", json!({"c0_c180": s.c0_c180, "c90_c270": s.c90_c270, "diagonal": s.diagonal}));
    }
    if let Some(opening) = &lamp.opening {
        set("luminous_opening_m", body(opening));
    }
    set("interpolation", d.interpolation().name().into());
    out
}

fn body(b: &Body) -> Value {
    json!({"shape": format!("{:?}", b.shape).to_lowercase(), "length_m": b.length_m, "width_m": b.width_m, "height_m": b.height_m})
}

fn system(system: System) -> &'static str {
    match system {
        System::TypeA => "A",
        System::TypeB => "B",
        System::TypeC => "C",
    }
}

fn symmetry(symmetry: Symmetry) -> &'static str {
    match symmetry {
        Symmetry::Rotational => "rotational",
        Symmetry::Quadrant => "quadrant",
        Symmetry::BilateralC0 => "bilateral_c0_c180",
        Symmetry::BilateralC90 => "bilateral_c90_c270",
        Symmetry::None => "none",
    }
}

/// `lamp info` for people, from the JSON object.
#[must_use]
pub fn info_text(path: &str, o: &Map<String, Value>) -> String {
    let mut out = format!("{path}: {} ({})\n\n", text(o, "name"), text(o, "format_version"));
    // Writing to a string cannot fail.
    let mut line = |label: &str, value: String| {
        if !value.is_empty() {
            let _ = writeln!(out, "  {label:<26} {value}");
        }
    };
    line("manufacturer", text(o, "manufacturer"));
    line(
        "photometry",
        format!(
            "Type {}, {} symmetry, {} × {} angles",
            text(o, "photometry_type"),
            text(o, "symmetry").replace('_', " "),
            number(o, "horizontal_angles", 6),
            number(o, "vertical_angles", 6)
        ),
    );
    line("interpolation", text(o, "interpolation"));
    for (unit, flux, zonal, peak, declared) in [
        ("lm", "total_flux_lm", "total_flux_zonal_lm", "peak_intensity_cd", "declared_flux_lm"),
        ("W", "total_flux_w", "total_flux_zonal_w", "peak_intensity_w_per_sr", "declared_flux_w"),
        (
            "µmol/s",
            "total_flux_umol_per_s",
            "total_flux_zonal_umol_per_s",
            "peak_intensity_umol_per_s_sr",
            "declared_flux_umol_per_s",
        ),
    ] {
        if !o.contains_key(flux) {
            continue;
        }
        line("flux (exact integral)", format!("{} {unit}", number(o, flux, 6)));
        line("flux (zonal rule)", format!("{} {unit}", number(o, zonal, 6)));
        if o.contains_key(declared) {
            line("flux declared", format!("{} {unit}", number(o, declared, 6)));
        }
        let peak_unit = match unit {
            "lm" => "cd",
            "W" => "W/sr",
            _ => "µmol/(s·sr)",
        };
        let (c, gamma) = (&o["peak_direction_deg"]["c"], &o["peak_direction_deg"]["gamma"]);
        line("peak", format!("{} {peak_unit} at {c}°, {gamma}°", number(o, peak, 6)));
    }
    for (label, key) in [("beam angle (50 %)", "beam_angle_deg"), ("field angle (10 %)", "field_angle_deg")] {
        let shown: Vec<String> = (o[key].as_array().into_iter().flatten())
            .map(|a| {
                format!(
                    "{} × {}° ({})",
                    angle(&a["c0_c180"]),
                    angle(&a["c90_c270"]),
                    a["definition"].as_str().unwrap_or_default()
                )
            })
            .collect();
        line(label, shown.join(", "));
    }
    if let Some(code) = o.get("cie_flux_code").and_then(Value::as_array) {
        line(
            "CIE flux code",
            code.iter().filter_map(Value::as_f64).map(|v| format!("{v:.0}")).collect::<Vec<_>>().join(" "),
        );
    }
    line("downward fraction", number(o, "downward_flux_fraction", 4));
    line("input power", number(o, "input_power_w", 4) + if o.contains_key("input_power_w") { " W" } else { "" });
    line(
        "luminous efficacy",
        number(o, "luminous_efficacy_lm_per_w", 4)
            + if o.contains_key("luminous_efficacy_lm_per_w") { " lm/W" } else { "" },
    );
    line("BUG rating", text(o, "bug_rating"));
    if let Some(s) = o.get("spacing_criterion") {
        line(
            "spacing criterion",
            format!("{} (C0–180), {} (C90–270), {} (diagonal)", s["c0_c180"], s["c90_c270"], s["diagonal"]),
        );
    }
    out
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

fn angle(value: &Value) -> String {
    value.as_f64().map_or_else(|| "–".to_owned(), |v| format!("{v:.1}"))
}

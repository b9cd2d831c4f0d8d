//! BRDFs as JSON and text: facts, audits, values.

mod table;

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::brdf::Brdf;
use crate::brdf::audit::{ALBEDO_DEG, Audit, Geometry, Limits, Worst};
use crate::brdf::description::Material;
use crate::brdf::format::File;
use crate::brdf::reflectance::{Beam, Cone, between};
use crate::brdf::table::Channel;
use crate::finding::Finding;
use crate::geometry::direction::from_degrees;
use crate::units::significant;

/// Digits shown for people; JSON has all.
const DIGITS: usize = 6;

/// What a material comes from.
#[derive(Debug, Clone, Copy)]
pub enum Source<'a> {
    /// Words.
    Described(&'a Material),
    /// A measured table, as its file has it.
    Measured(&'a File),
}

/// A material on its bands, to report on.
#[derive(Debug, Clone, Copy)]
pub struct Prepared<'a> {
    /// What was described or measured.
    pub source: Source<'a>,
    /// What it was prepared for.
    pub bands: &'a [Channel],
    /// The result.
    pub brdf: &'a dyn Brdf,
}

impl Prepared<'_> {
    /// Description and bands, which head every result.
    fn head(&self) -> Map<String, Value> {
        let mut out = Map::new();
        match self.source {
            Source::Described(material) => out.insert("material".to_owned(), material.to_string().into()),
            Source::Measured(file) => out.insert("format".to_owned(), file.format.to_string().into()),
        };
        let wavelength = |c: &Channel| if let Channel::Wavelength(nm) = c { Some(*nm) } else { None };
        if let Some(nm) = self.bands.iter().map(wavelength).collect::<Option<Vec<f64>>>() {
            out.insert("wavelengths_nm".to_owned(), nm.into());
        } else {
            out.insert("channels".to_owned(), self.bands.len().into());
            if matches!(self.source, Source::Measured(_)) {
                let names: Vec<String> = self.bands.iter().map(ToString::to_string).collect();
                out.insert("channel_names".to_owned(), names.into());
            }
        }
        out
    }

    /// `555 nm`, `R` or `channel 2`.
    fn band(&self, i: usize) -> String {
        self.bands[i].to_string()
    }

    fn band_names(&self) -> String {
        self.bands.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
    }

    /// The band as it is marked in JSON and CSV: a wavelength, or a channel from 1.
    fn band_value(&self, i: usize) -> Value {
        match self.bands[i] {
            Channel::Wavelength(nm) => nm.into(),
            Channel::Named(_) => (i + 1).into(),
        }
    }
}

fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}

// ---------------------------------------------------------------------------------------------------------- check

fn directions(g: &Geometry) -> Value {
    json!({"theta_i": g.theta_i_deg, "phi_i": g.phi_i_deg, "theta_o": g.theta_o_deg, "phi": g.phi_deg})
}

/// `θi 42.5°, θo 87.5°, φ 180°`.
fn in_words(g: &Geometry) -> String {
    let turned = if g.phi_i_deg == 0.0 { String::new() } else { format!(", φi {}°", g.phi_i_deg) };
    format!("θi {}°, θo {}°, φ {}°{turned}", g.theta_i_deg, g.theta_o_deg, g.phi_deg)
}

/// `brdf check`, one object.
#[must_use]
pub fn check(p: &Prepared<'_>, audit: &Audit) -> Map<String, Value> {
    let mut out = p.head();
    let mut worst = |name: &str, at: &str, w: Option<Worst>| {
        out.insert(name.to_owned(), w.map(|w| w.value).into());
        if let Some(w) = w {
            let mut place = object(directions(&w.at));
            place.insert("band".to_owned(), p.band_value(w.band));
            out.insert(at.to_owned(), place.into());
        }
    };
    worst("reciprocity_max_relative", "reciprocity_max_at_deg", audit.reciprocity);
    worst("symmetry_max_relative", "symmetry_max_at_deg", audit.symmetry);
    if let Some((albedo, band, value)) = audit.largest_albedo() {
        out.insert("albedo_max".to_owned(), value.into());
        out.insert("albedo_max_at_deg".to_owned(), albedo.theta_i_deg.into());
        out.insert("albedo_max_phi_deg".to_owned(), albedo.phi_i_deg.into());
        out.insert("albedo_max_band".to_owned(), p.band_value(band));
        out.insert("albedo_max_error".to_owned(), albedo.error.into());
    }
    out.insert("negative_fraction".to_owned(), audit.negative_fraction.into());
    if let Some(w) = audit.most_negative {
        out.insert("most_negative_per_sr".to_owned(), w.value.into());
        out.insert("most_negative_at_deg".to_owned(), directions(&w.at));
    }
    out.insert("measured_fraction".to_owned(), audit.measured_fraction.into());
    if let Some(incidences) = audit.incidences {
        out.insert("incidences".to_owned(), incidences.into());
    }
    out.insert("passes".to_owned(), audit.passes.into());
    let albedo = audit.albedo.iter().map(|a| {
        json!({"theta_i_deg": a.theta_i_deg, "phi_i_deg": a.phi_i_deg, "albedo": a.reflectance, "albedo_measured": a.measured, "error": a.error})
    });
    out.insert("albedo".to_owned(), albedo.collect::<Vec<_>>().into());
    out
}

/// What an audit has to say, as findings.
#[must_use]
pub fn check_findings(p: &Prepared<'_>, audit: &Audit, limits: &Limits) -> Vec<Finding> {
    let mut out = Vec::new();
    if let Some(w) = audit.reciprocity.filter(|w| w.value > limits.reciprocity) {
        let amount = significant(w.value, 3);
        let (at, band) = (in_words(&w.at), p.band(w.band));
        out.push(Finding::error("B001", format!("not reciprocal: exchanging the directions changes the value by {amount} of the larger one at {at} ({band})")));
    }
    if let Some((a, band, value)) = audit.largest_albedo().filter(|(a, _, v)| v - a.error > limits.albedo + 1e-12) {
        let (value, band) = (significant(value, 4), p.band(band));
        let first = audit.albedo.iter().find(|a| a.measured.iter().any(|v| *v - a.error > limits.albedo + 1e-12));
        let from = first.map_or(0.0, |a| a.theta_i_deg);
        let message = format!(
            "more light leaves than arrives: albedo {value} at θi {}° ({band}), above {} from {from}°",
            a.theta_i_deg, limits.albedo
        );
        out.push(Finding::error("B002", message));
    }
    if let Some(w) = audit.most_negative.filter(|_| audit.negative_fraction > limits.negative) {
        let (part, value) = (significant(100.0 * audit.negative_fraction, 3), significant(w.value, 3));
        let (at, band) = (in_words(&w.at), p.band(w.band));
        out.push(Finding::error(
            "B003",
            format!("negative in {part} % of the directions, down to {value} /sr at {at} ({band})"),
        ));
    }
    if let Some(w) = audit.symmetry.filter(|w| w.value > limits.reciprocity) {
        let amount = significant(w.value, 3);
        out.push(Finding::warning(
            "B004",
            format!("not symmetric to the plane of incidence: by {amount} of the larger value at {}", in_words(&w.at)),
        ));
    }
    if audit.measured_fraction < 1.0 {
        let part = significant(100.0 * audit.measured_fraction, 4);
        out.push(Finding::warning(
            "B005",
            format!(
                "{part} % of the projected hemisphere was measured{}; the rest is the table's guess",
                at_own_angles(audit)
            ),
        ));
    }
    out
}

/// Where the figures of a table hold that was lit at few angles.
fn at_own_angles(audit: &Audit) -> String {
    audit.incidences.map_or(String::new(), |n| match n {
        1 => " at the one direction of incidence of the table".to_owned(),
        n => format!(" at the {n} directions of incidence of the table"),
    })
}

/// An audit for people.
#[must_use]
pub fn check_text(heading: &str, p: &Prepared<'_>, audit: &Audit, findings: &[Finding]) -> String {
    let mut out = format!("{heading}: {}\n", if audit.passes { "passes" } else { "fails" });
    for f in findings {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "  {f}");
    }
    let show = |w: Option<Worst>| match w {
        None => "–".to_owned(),
        Some(w) if w.value == 0.0 => "0".to_owned(),
        Some(w) => format!("{} at {}", significant(w.value, 3), in_words(&w.at)),
    };
    let _ = writeln!(out, "  reciprocity, worst relative   {}", show(audit.reciprocity));
    let _ = writeln!(out, "  symmetry in φ, worst relative {}", show(audit.symmetry));
    if let Some((a, band, value)) = audit.largest_albedo() {
        let _ = writeln!(
            out,
            "  largest albedo                {} at θi {}° ({}), error below {}",
            significant(value, DIGITS),
            a.theta_i_deg,
            p.band(band),
            significant(a.error, 1)
        );
        if audit.measured_fraction < 1.0 {
            let guessed = significant(a.reflectance[band], DIGITS);
            let _ = writeln!(out, "    over what was measured; with the table's guess elsewhere {guessed}");
        }
    }
    let _ =
        writeln!(out, "  negative                      {} of the directions", significant(audit.negative_fraction, 3));
    let _ = writeln!(
        out,
        "  measured                      {} of the projected hemisphere{}",
        significant(audit.measured_fraction, 4),
        at_own_angles(audit)
    );
    out
}

// ----------------------------------------------------------------------------------------------------------- info

/// The beams of the nine reflectances: a direction, a cone about it, all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nine {
    /// Angle of the incident direction and cone.
    pub theta_i_deg: f64,
    /// Angle of the outgoing direction and cone, opposite in azimuth.
    pub theta_o_deg: f64,
    /// Half of the opening angle of the cones.
    pub half_angle_deg: f64,
}

/// `brdf info`, one object: parameters, kind, albedo, the nine reflectances.
#[must_use]
pub fn info(p: &Prepared<'_>, audit: &Audit, nine: &Nine) -> Map<String, Value> {
    let mut out = p.head();
    match p.source {
        Source::Described(material) => {
            let models = material.models().map(|m| {
                let parameters = m.parameters.iter().map(|q| json!({"name": q.name, "expected": q.expected(), "unit": q.unit, "meaning": q.meaning, "default": q.default}));
                json!({"model": m.name, "summary": m.summary, "parameters": parameters.collect::<Vec<_>>()})
            });
            out.insert("models".to_owned(), models.collect::<Vec<_>>().into());
        }
        Source::Measured(file) => out.append(&mut table::facts(file)),
    }
    out.insert("isotropic".to_owned(), p.brdf.is_isotropic().into());
    let kind = match (p.brdf.is_delta(), p.brdf.has_delta()) {
        (true, _) => "delta",
        (_, true) => "smooth and delta",
        _ => "smooth",
    };
    out.insert("kind".to_owned(), kind.into());
    out.insert("reciprocity_max_relative".to_owned(), audit.reciprocity.map(|w| w.value).into());
    let limits = Limits::of(p.brdf);
    out.insert("reciprocal".to_owned(), audit.reciprocity.is_none_or(|w| w.value <= limits.reciprocity).into());
    out.insert("negative_fraction".to_owned(), audit.negative_fraction.into());
    out.insert("measured_fraction".to_owned(), audit.measured_fraction.into());
    out.insert("passes".to_owned(), audit.passes.into());
    let albedo = audit.albedo.iter().filter(|a| a.phi_i_deg == 0.0);
    let albedo = albedo.map(|a| json!({"theta_i_deg": a.theta_i_deg, "albedo": a.reflectance, "error": a.error}));
    out.insert("albedo".to_owned(), albedo.collect::<Vec<_>>().into());
    out.insert("reflectances".to_owned(), nicodemus(p.brdf, nine).into());
    out
}

/// The nine reflectances of Nicodemus.
fn nicodemus(brdf: &dyn Brdf, nine: &Nine) -> Vec<Value> {
    let beams = |theta_deg: f64, phi_deg: f64| {
        let axis = from_degrees(theta_deg, phi_deg);
        let cone = Cone { axis, half_angle_rad: nine.half_angle_deg.to_radians() };
        [
            ("directional", Beam::Directional(axis)),
            ("conical", Beam::Conical(cone)),
            ("hemispherical", Beam::HEMISPHERICAL),
        ]
    };
    let mut out = Vec::new();
    for (from, incident) in beams(nine.theta_i_deg, 0.0) {
        for (to, outgoing) in beams(nine.theta_o_deg, 180.0) {
            let r = between(brdf, incident, outgoing);
            let key = if to == "directional" { "reflectance_per_sr" } else { "reflectance" };
            out.push(json!({
                "incident": from, "outgoing": to,
                key: r.as_ref().map(|r| &r.reflectance),
                "reflectance_factor": r.as_ref().map(|r| &r.factor),
                "error": r.as_ref().map(|r| r.error),
            }));
        }
    }
    out
}

/// Facts for people.
#[must_use]
pub fn info_text(heading: &str, p: &Prepared<'_>, object: &Map<String, Value>) -> String {
    let mut out = format!("{heading}\n");
    let text =
        |key: &str| object.get(key).map_or(String::new(), |v| v.as_str().map_or_else(|| v.to_string(), str::to_owned));
    match p.source {
        Source::Described(_) => {
            let _ = writeln!(out, "  material    {}", text("material"));
        }
        Source::Measured(file) => out.push_str(&table::facts_text(file)),
    }
    let _ = writeln!(
        out,
        "  kind        {}{}",
        text("kind"),
        if p.brdf.is_isotropic() { ", isotropic" } else { ", anisotropic" }
    );
    let _ = writeln!(out, "  reciprocal  {}", text("reciprocal"));
    if let Source::Described(material) = p.source {
        for model in material.models() {
            let _ = writeln!(out, "  {}: {}", model.name, model.summary);
            for parameter in model.parameters {
                let _ = writeln!(out, "    {parameter}");
            }
        }
    }
    let numbers = |v: Option<&Value>| -> String {
        let items = v.and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        let shown = items.iter().map(|v| v.as_f64().map_or("–".to_owned(), |v| significant(v, 5)));
        let shown: Vec<String> = shown.collect();
        if shown.is_empty() { "–".to_owned() } else { shown.join("  ") }
    };
    let _ = writeln!(out, "  albedo at θi: {}", p.band_names());
    let rows = object.get("albedo").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    for row in rows {
        let theta = row.get("theta_i_deg").and_then(Value::as_f64).unwrap_or_default();
        // Every fifteen degrees, and the steep end; of a table's own angles all.
        if theta % 15.0 == 0.0 || theta > 84.0 || rows.len() != ALBEDO_DEG.len() {
            let _ = writeln!(out, "    {theta:>4}°  {}", numbers(row.get("albedo")));
        }
    }
    let _ = writeln!(out, "  reflectance factors (incident – outgoing)");
    for row in object.get("reflectances").and_then(Value::as_array).into_iter().flatten() {
        let name = |key: &str| row.get(key).and_then(Value::as_str).unwrap_or_default();
        let pair = format!("{} – {}", name("incident"), name("outgoing"));
        let _ = writeln!(out, "    {pair:<31} {}", numbers(row.get("reflectance_factor")));
    }
    out
}

// ----------------------------------------------------------------------------------------------------------- eval

/// Headers of the table of values.
pub const EVAL_COLUMNS: [&str; 9] = [
    "path",
    "theta_i_deg",
    "phi_i_deg",
    "theta_o_deg",
    "phi_deg",
    "wavelength_nm",
    "channel",
    "brdf_per_sr",
    "measured",
];

/// That values do not contain what they cannot, as a finding.
#[must_use]
pub fn eval_findings(p: &Prepared<'_>) -> Vec<Finding> {
    if !p.brdf.has_delta() {
        return Vec::new();
    }
    let message = "light leaves in a Dirac lobe, which has a reflectance and no value: it is not in these values";
    vec![Finding::warning("B006", message).hint("`brdf info` has the reflectances")]
}

/// `brdf eval`, one object: rows of directions with a value per band.
#[must_use]
pub fn eval(p: &Prepared<'_>, geometries: &[Geometry]) -> Map<String, Value> {
    let mut out = p.head();
    let mut values = vec![0.0; p.brdf.bands()];
    let rows: Vec<Value> = (geometries.iter())
        .map(|g| {
            let (i, o) = g.directions();
            p.brdf.evaluate(i, o, &mut values);
            json!({"theta_i_deg": g.theta_i_deg, "phi_i_deg": g.phi_i_deg, "theta_o_deg": g.theta_o_deg, "phi_deg": g.phi_deg, "brdf_per_sr": values, "measured": p.brdf.is_measured(i, o)})
        })
        .collect();
    out.insert("rows".to_owned(), rows.into());
    out
}

/// The values as rows of cells, one per direction and band.
#[must_use]
pub fn eval_rows(path: &str, p: &Prepared<'_>, geometries: &[Geometry]) -> Vec<[String; 9]> {
    let mut values = vec![0.0; p.brdf.bands()];
    let mut out = Vec::new();
    for g in geometries {
        let (i, o) = g.directions();
        p.brdf.evaluate(i, o, &mut values);
        let measured = p.brdf.is_measured(i, o).to_string();
        for (band, value) in values.iter().enumerate() {
            let (nm, channel) = match (&p.bands[band], p.source) {
                (Channel::Wavelength(nm), _) => (nm.to_string(), String::new()),
                (Channel::Named(name), Source::Measured(_)) => (String::new(), name.clone()),
                (Channel::Named(_), Source::Described(_)) => (String::new(), (band + 1).to_string()),
            };
            let angles = [g.theta_i_deg, g.phi_i_deg, g.theta_o_deg, g.phi_deg].map(|v| v.to_string());
            let [ti, pi, to, phi] = angles;
            out.push([path.to_owned(), ti, pi, to, phi, nm, channel, value.to_string(), measured.clone()]);
        }
    }
    out
}

/// The values for people.
#[must_use]
pub fn eval_text(heading: &str, p: &Prepared<'_>, geometries: &[Geometry]) -> String {
    let mut out = format!("{heading}\n  θi [°]   θo [°]    φ [°]   f [1/sr] at {}\n", p.band_names());
    let mut values = vec![0.0; p.brdf.bands()];
    for g in geometries {
        let (i, o) = g.directions();
        p.brdf.evaluate(i, o, &mut values);
        let shown: Vec<String> = values.iter().map(|v| significant(*v, DIGITS)).collect();
        let guess = if p.brdf.is_measured(i, o) { "" } else { "  (not measured)" };
        let angles = format!("{:>8} {:>8} {:>8}", g.theta_i_deg, g.theta_o_deg, g.phi_deg);
        let _ = writeln!(out, "{angles}   {}{guess}", shown.join("  "));
    }
    out
}

//! `lamp spectral`: a lamp with its spectrum, in every quantity.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::conversion::{Conversion, Settings};
use crate::luminaire::colour::{ColourOverAngle, DEFINITION, DirectionColour};
use crate::luminaire::spectral::{Direction, Intensities, SpectralLamp};
use crate::luminaire::{Kind, Luminaire};
use crate::report::conversion;
use crate::spectrum::Quantity;
use crate::units::significant;

/// Which spectrum was combined with the lamp.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// One that the user gave.
    Given,
    /// The file's spectrum of the whole lamp.
    Own,
    /// The file's angular spectra.
    Angular,
}

impl Source {
    fn word(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Own => "own",
            Self::Angular => "angular",
        }
    }
}

/// Key of an intensity, and the figure.
type Figure = (&'static str, fn(&Intensities) -> Option<f64>);

/// The intensities in the order of the reports.
const FIGURES: [Figure; 8] = [
    ("luminous_intensity_cd", |i| Some(i.luminous_cd)),
    ("intensity_w_per_sr", |i| Some(i.radiant_w_per_sr)),
    ("total_umol_per_s_sr", |i| Some(i.photon_umol_per_s_sr)),
    ("par_umol_per_s_sr", |i| Some(i.par_umol_per_s_sr)),
    ("melanopic_intensity_w_per_sr", |i| Some(i.melanopic_w_per_sr)),
    ("melanopic_equivalent_daylight_intensity_cd", |i| Some(i.melanopic_daylight_cd)),
    ("blue_light_intensity_w_per_sr", |i| i.blue_light_w_per_sr),
    ("actinic_uv_intensity_w_per_sr", |i| i.actinic_uv_w_per_sr),
];

/// What belongs to a report besides the figures.
#[derive(Debug, Clone, Copy)]
pub struct Context<'a> {
    /// The lamp file.
    pub path: &'a str,
    /// Its luminaire.
    pub lamp: &'a Luminaire,
    /// Name of the spectrum.
    pub spectrum: &'a str,
    /// Where it is from.
    pub source: Source,
    /// Settings of the conversions.
    pub settings: &'a Settings,
}

impl Context<'_> {
    /// PPF over input power, µmol/J; luminous efficacy, lm/W; radiant efficiency. `None` without input power.
    fn efficiencies(&self, lamp: &SpectralLamp) -> Option<[(&'static str, f64); 3]> {
        let watts = self.lamp.input_power_w.filter(|w| *w > 0.0)?;
        let whole = lamp.flux.absolute.first()?;
        Some([
            ("luminous_efficacy_lm_per_w", whole.photopic / watts),
            ("radiant_efficiency", whole.radiometric / watts),
            ("ppe_umol_per_j", lamp.flux.photons?.par_umol / watts),
        ])
    }
}

/// The object of `lamp spectral` in `results[]`.
#[must_use]
pub fn spectral(context: &Context<'_>, lamp: &SpectralLamp) -> Map<String, Value> {
    let mut out = Map::new();
    let mut set = |key: &str, value: Value| {
        out.insert(key.to_owned(), value);
    };
    set("path", context.path.into());
    set("kind", kind_word(context.lamp.kind).into());
    set("spectrum", json!({"name": context.spectrum, "source": context.source.word()}));
    if let Some(watts) = context.lamp.input_power_w {
        set("input_power_w", watts.into());
    }
    for (key, value) in context.efficiencies(lamp).into_iter().flatten() {
        set(key, value.into());
    }
    set("flux", conversion::json(&lamp.flux, context.settings).into());
    let at = lamp.directions.get(lamp.peak_direction).map(direction_deg);
    let mut peak = Map::from_iter([("direction_deg".to_owned(), json!(at))]);
    peak.extend(conversion::json(&lamp.peak, context.settings));
    set("peak", peak.into());
    let peaks = FIGURES.iter().filter_map(|(key, figure)| {
        let (direction, value) = lamp.peak_of(figure)?;
        Some(json!({*key: value, "direction_deg": direction_deg(direction)}))
    });
    set("peaks", peaks.collect::<Vec<_>>().into());
    if let Some(colour) = &lamp.colour {
        set("colour_over_angle", colour_over_angle(colour, lamp));
        let rows = lamp.directions.iter().zip(&colour.directions).map(|(d, c)| direction(d, c.as_ref()));
        set("directions", rows.collect::<Vec<_>>().into());
    }
    out
}

fn kind_word(kind: Kind) -> &'static str {
    match kind {
        Kind::Luminous => "luminous",
        Kind::Radiant => "radiant",
        Kind::Photon => "photon",
    }
}

fn direction_deg(d: &Direction) -> Value {
    json!({"c": d.horizontal_deg, "gamma": d.vertical_deg})
}

fn colour_over_angle(colour: &ColourOverAngle, lamp: &SpectralLamp) -> Value {
    json!({
        "definition": DEFINITION,
        "mean_uv_prime": colour.mean_uv_prime,
        "max_delta_uv_prime": colour.max_delta_uv_prime,
        "max_direction_deg": lamp.directions.get(colour.max_direction).map(direction_deg),
        "rms_delta_uv_prime": colour.rms_delta_uv_prime,
        "cct_range_k": colour.cct_range_k.map(|(low, high)| [low, high]),
        "directions_counted": colour.directions.iter().flatten().filter(|d| d.counted).count(),
    })
}

fn direction(d: &Direction, colour: Option<&DirectionColour>) -> Value {
    let mut out = Map::from_iter([("direction_deg".to_owned(), direction_deg(d))]);
    for (key, figure) in &FIGURES {
        if let Some(value) = figure(&d.intensities) {
            out.insert((*key).to_owned(), value.into());
        }
    }
    out.insert("cct_k".into(), json!(colour.and_then(|c| c.cct).map(|c| c.kelvin)));
    out.insert("duv".into(), json!(colour.and_then(|c| c.cct).map(|c| c.duv)));
    out.insert("chromaticity_uv_prime".into(), json!(colour.map(|c| c.uv_prime)));
    out.insert("delta_uv_prime".into(), json!(colour.map(|c| c.delta_uv_prime)));
    out.into()
}

/// The header of the table over directions.
#[must_use]
pub fn spectral_header() -> Vec<String> {
    let angles = ["c_deg", "gamma_deg"].into_iter();
    let colours = ["cct_k", "duv", "u_prime", "v_prime", "delta_uv_prime"];
    angles.chain(FIGURES.iter().map(|(key, _)| *key)).chain(colours).map(str::to_owned).collect()
}

/// The rows of the table over directions; what does not apply is an empty cell.
#[must_use]
pub fn spectral_rows(lamp: &SpectralLamp) -> Vec<Vec<String>> {
    let cell = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
    // One spectrum for all directions has one colour.
    let whole = lamp.flux.uv_prime.filter(|_| lamp.colour.is_none());
    let row = |(i, d): (usize, &Direction)| {
        let colour = lamp.colour.as_ref().and_then(|c| c.directions.get(i).copied().flatten());
        let cct = if lamp.colour.is_some() { colour.and_then(|c| c.cct) } else { lamp.flux.cct };
        let uv = colour.map(|c| c.uv_prime).or(whole);
        let mut cells = vec![d.horizontal_deg.to_string(), d.vertical_deg.to_string()];
        cells.extend(FIGURES.iter().map(|(_, figure)| cell(figure(&d.intensities))));
        cells.extend([cct.map(|c| c.kelvin), cct.map(|c| c.duv), uv.map(|v| v[0]), uv.map(|v| v[1])].map(cell));
        cells.push(cell(colour.map(|c| c.delta_uv_prime)));
        cells
    };
    lamp.directions.iter().enumerate().map(row).collect()
}

struct Lines(String);

impl Lines {
    fn line(&mut self, label: &str, value: impl AsRef<str>) {
        let _ = writeln!(self.0, "  {label:<30} {}", value.as_ref());
    }
}

fn show(value: f64) -> String {
    significant(value, 6)
}

/// The report for people.
#[must_use]
pub fn spectral_text(context: &Context<'_>, lamp: &SpectralLamp) -> String {
    let spectrum = match context.source {
        Source::Given => context.spectrum.to_owned(),
        Source::Own => "its own spectrum".to_owned(),
        Source::Angular => format!("its spectra in {} directions", lamp.directions.len()),
    };
    let mut out = Lines(format!("{}: {} intensities, {spectrum}\n\n", context.path, kind_word(context.lamp.kind)));
    flux(&mut out, context, lamp);
    out.0.push('\n');
    for (key, figure) in &FIGURES {
        let (name, unit) = named(key);
        if let Some((d, value)) = lamp.peak_of(figure) {
            let at =
                if value > 0.0 { format!(" at {}°, {}°", d.horizontal_deg, d.vertical_deg) } else { String::new() };
            out.line(&format!("peak {name}"), format!("{} {unit}{at}", show(value)));
        }
    }
    at_distance(&mut out, &lamp.peak);
    if let Some(colour) = &lamp.colour {
        out.0.push('\n');
        let [u, v] = colour.mean_uv_prime;
        out.line("u′, v′ of the flux", format!("{u:.5}, {v:.5}"));
        if let Some(d) = lamp.directions.get(colour.max_direction) {
            let largest = colour.max_delta_uv_prime;
            out.line("largest Δu′v′", format!("{largest:.5} at {}°, {}°", d.horizontal_deg, d.vertical_deg));
        }
        out.line("rms Δu′v′", format!("{:.5}", colour.rms_delta_uv_prime));
        if let Some((low, high)) = colour.cct_range_k {
            out.line("CCT over angle", format!("{low:.1} K to {high:.1} K"));
        }
        let _ = writeln!(out.0, "\n  Δu′v′: {DEFINITION}\n");
        angles(&mut out.0, colour, lamp);
    }
    out.0
}

fn flux(out: &mut Lines, context: &Context<'_>, lamp: &SpectralLamp) {
    let c = &lamp.flux;
    if let Some(whole) = c.absolute.first() {
        out.line("radiant flux", format!("{} W", show(whole.radiometric)));
        out.line("luminous flux", format!("{} lm", show(whole.photopic)));
    }
    out.line("efficacy of radiation", c.efficacy_lm_per_w.map_or("–".into(), |v| format!("{} lm/W", show(v))));
    out.line("S/P ratio", c.scotopic_photopic_ratio.map_or("–".into(), show));
    if let Some(p) = &c.photons {
        out.line("PPF (400–700 nm)", format!("{} µmol/s", show(p.par_umol)));
        out.line("photons, all wavelengths", format!("{} µmol/s", show(p.total_umol)));
    }
    if let Some(a) = c.alpha_opic.iter().find(|a| a.receptor == "melanopic") {
        let der = a.der.map_or("–".into(), show);
        out.line(
            "melanopic flux",
            format!("{} W, as {} lm of D65, DER {der}", show(a.radiometric), show(a.equivalent_daylight)),
        );
    }
    if let Some(cct) = c.cct {
        out.line("CCT, Duv", format!("{:.1} K, {:+.5}", cct.kelvin, if cct.duv.abs() < 5e-6 { 0.0 } else { cct.duv }));
    }
    if let Some([lm_per_w, efficiency, ppe]) = context.efficiencies(lamp) {
        let watts = context.lamp.input_power_w.map_or_else(String::new, show);
        let percent = show(100.0 * efficiency.1);
        out.line(
            "per input power",
            format!("{} lm/W, {percent} % radiant, PPE {} µmol/J (of {watts} W)", show(lm_per_w.1), show(ppe.1)),
        );
    }
}

fn named(key: &str) -> (&'static str, &'static str) {
    match key {
        "luminous_intensity_cd" => ("luminous intensity", "cd"),
        "intensity_w_per_sr" => ("radiant intensity", "W/sr"),
        "total_umol_per_s_sr" => ("photon intensity", "µmol/(s·sr)"),
        "par_umol_per_s_sr" => ("PAR photon intensity", "µmol/(s·sr)"),
        "melanopic_intensity_w_per_sr" => ("melanopic intensity", "W/sr"),
        "melanopic_equivalent_daylight_intensity_cd" => ("melanopic, as of D65", "cd"),
        "blue_light_intensity_w_per_sr" => ("blue-light weighted", "W/sr"),
        _ => ("actinic-UV weighted", "W/sr"),
    }
}

/// What the peak makes at the distance given.
fn at_distance(out: &mut Lines, peak: &Conversion) {
    let Some(f) = peak.absolute.iter().find(|f| f.quantity == Quantity::Irradiance) else { return };
    let _ = writeln!(out.0, "\n  at the distance, on the peak's axis   [{}]", f.relations.join("; "));
    out.line("illuminance", format!("{} lx", show(f.photopic)));
    out.line("irradiance", format!("{} W/m²", show(f.radiometric)));
    if let Some(p) = &peak.photons {
        out.line("PPFD", format!("{} µmol/(m²·s)", show(f.factor * p.par_umol)));
    }
    if let Some(a) = peak.alpha_opic.iter().find(|a| a.receptor == "melanopic") {
        out.line("melanopic EDI", format!("{} lx", show(f.factor * a.equivalent_daylight)));
    }
    for h in &peak.hazard {
        let label = if h.key == "blue_light" { "blue-light weighted" } else { "actinic-UV weighted" };
        out.line(label, format!("{} W/m²", show(f.factor * h.weighted)));
    }
}

/// CCT and Δu′v′ by direction.
fn angles(out: &mut String, colour: &ColourOverAngle, lamp: &SpectralLamp) {
    let _ = writeln!(out, "  {:>8} {:>8} {:>12} {:>9} {:>9} {:>9}", "C", "γ", "cd", "CCT [K]", "Duv", "Δu′v′");
    for (d, c) in lamp.directions.iter().zip(&colour.directions) {
        let cct = c.and_then(|c| c.cct);
        let _ = writeln!(
            out,
            "  {:>8} {:>8} {:>12} {:>9} {:>9} {:>9}{}",
            d.horizontal_deg,
            d.vertical_deg,
            show(d.intensities.luminous_cd),
            cct.map_or("–".into(), |c| format!("{:.1}", c.kelvin)),
            cct.map_or("–".into(), |c| format!("{:+.5}", c.duv)),
            c.map_or("–".into(), |c| format!("{:.5}", c.delta_uv_prime)),
            if c.is_some_and(|c| !c.counted) { "  (below 10 % of the peak)" } else { "" }
        );
    }
}

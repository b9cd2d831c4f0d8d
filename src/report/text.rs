//! A conversion for people: aligned lines, what it stands on beneath.

use std::fmt::Write;

use super::conversion::standard_colour;
use crate::colorimetry::tolerance::{Tolerance, UV_PRIME_STEP};
use crate::conversion::{AbsoluteFigures, Conversion, Settings, XyzScale};
use crate::photometry::alpha_opic::RECOMMENDATIONS;
use crate::spectrum::Quantity;
use crate::spectrum::integrate::Rule;
use crate::units::significant;

/// Width of the labels' column.
const LABEL: usize = 28;
/// Significant digits shown; the JSON output has all.
const DIGITS: usize = 6;

struct Lines(String);

impl Lines {
    fn line(&mut self, label: &str, value: impl AsRef<str>) {
        // Padding by characters, not bytes: labels have primes and dots in them. Writing to a string cannot fail.
        let _ = writeln!(self.0, "  {label:<LABEL$} {}", value.as_ref());
    }

    fn gap(&mut self) {
        self.0.push('\n');
    }
}

fn show(value: f64) -> String {
    significant(value, DIGITS)
}

/// Name of the luminous quantity.
pub(super) fn luminous_name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Flux => "luminous flux",
        Quantity::Intensity => "luminous intensity",
        Quantity::Irradiance => "illuminance",
        Quantity::Radiance => "luminance",
        Quantity::Exitance => "luminous exitance",
        Quantity::Energy => "luminous energy",
        Quantity::Exposure => "luminous exposure",
        Quantity::Relative => "",
    }
}

/// Name of the radiometric quantity.
pub(super) fn radiometric_name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Flux => "radiant flux",
        Quantity::Intensity => "radiant intensity",
        Quantity::Irradiance => "irradiance",
        Quantity::Radiance => "radiance",
        Quantity::Exitance => "radiant exitance",
        Quantity::Energy => "radiant energy",
        Quantity::Exposure => "radiant exposure",
        Quantity::Relative => "relative",
    }
}

/// The report of one conversion; `heading` names the spectrum.
#[must_use]
pub fn conversion(heading: &str, c: &Conversion, settings: &Settings) -> String {
    let mut out = Lines(String::new());
    let kind = match c.quantity {
        _ if c.xyz_scale == XyzScale::PerfectDiffuser => "reflectance".to_owned(),
        Quantity::Relative => "relative spectrum".to_owned(),
        q => format!("spectral {}", radiometric_name(q)),
    };
    let _ = writeln!(out.0, "{heading}: {kind}, {}\n", grid(c));
    for (i, figures) in c.absolute.iter().enumerate() {
        absolute(&mut out, figures, i == 0);
    }
    if c.absolute.len() > 1 {
        out.gap();
    }
    let efficacy = c.efficacy_lm_per_w.map_or("–".into(), |v| format!("{} lm/W", show(v)));
    out.line("efficacy of radiation", efficacy);
    out.line("S/P ratio", c.scotopic_photopic_ratio.map_or("–".into(), show));
    if let Some(m) = &c.mesopic {
        let state = format!("m = {}, adapted to {} cd/m² photopic", show(m.adaptation.m), show(m.adaptation_luminance));
        out.line("mesopic (MES2)", state);
    }
    out.gap();
    colour(&mut out, c, settings);
    rendition(&mut out, c);
    biology(&mut out, c);
    risk(&mut out, c);
    shape(&mut out, c);
    basis(&mut out, c, settings);
    out.0
}

fn grid(c: &Conversion) -> String {
    let i = &c.integration;
    let (low, high) = i.range_nm;
    let samples = if i.samples == 1 { "1 sample".to_owned() } else { format!("{} samples", i.samples) };
    match (i.rule, i.step_nm) {
        (Rule::Lines, _) if i.samples == 1 => format!("one line at {low} nm"),
        (Rule::Lines, _) => format!("{samples} taken as lines, {low}–{high} nm"),
        (_, Some(step)) => format!("{low}–{high} nm by {} nm ({samples})", (step * 1e6).round() / 1e6),
        (_, None) => format!("{low}–{high} nm, unequal steps ({samples})"),
    }
}

fn absolute(out: &mut Lines, f: &AbsoluteFigures, measured: bool) {
    let unit = f.quantity.luminous_unit();
    let how = if measured { String::new() } else { format!("   [{}]", f.relations.join("; ")) };
    out.line(luminous_name(f.quantity), format!("{} {unit}{how}", show(f.photopic)));
    if let Some(mesopic) = f.mesopic {
        out.line(&format!("  mesopic {}", luminous_name(f.quantity)), format!("{} {unit}", show(mesopic)));
    }
    if measured {
        out.line(&format!("  scotopic {}", luminous_name(f.quantity)), format!("{} {unit}", show(f.scotopic)));
    }
    out.line(radiometric_name(f.quantity), format!("{} {}", show(f.radiometric), f.quantity.unit()));
}

fn colour(out: &mut Lines, c: &Conversion, settings: &Settings) {
    if let Some(xyz) = c.xyz {
        out.line("X, Y, Z", xyz.map(show).join(", "));
    }
    if let Some([x, y]) = c.xy {
        out.line("chromaticity x, y", format!("{x:.5}, {y:.5}"));
    }
    if let Some([u, v]) = c.uv_prime {
        out.line("chromaticity u′, v′", format!("{u:.5}, {v:.5}"));
    }
    if let Some(w) = &c.whiteness {
        out.line("whiteness W, tint T", format!("{:.2}, {:+.2}", w.whiteness, w.tint));
        out.line("yellowness YI (E313)", format!("{:.2}", w.yellowness));
    }
    if let Some(cct) = c.cct {
        // A blackbody's distance from its own locus is rounding; −0.00000 would look like a statement.
        let duv = if cct.duv.abs() < 5e-6 { 0.0 } else { cct.duv };
        out.line("CCT, Duv", format!("{:.1} K, {duv:+.5}", cct.kelvin));
    } else if settings.groups.colour {
        out.line("CCT, Duv", "–");
    }
    if let Some(t) = &c.tolerance {
        out.line("nominal white", nominal_white(t));
    }
    if let Some(s) = &c.standard_colour {
        out.line("IEC 60081", format!("{}: {:.1} SDCM", standard_colour(s), s.sdcm));
    }
    if let Some(d) = c.dominant {
        let (label, wavelength) = if d.wavelength_nm < 0.0 {
            ("complementary wavelength", -d.wavelength_nm)
        } else {
            ("dominant wavelength", d.wavelength_nm)
        };
        out.line(label, format!("{wavelength:.2} nm, purity {:.2} %", 100.0 * d.excitation_purity));
    }
    if let Some(srgb) = c.rgb.first() {
        let [r, g, b] = srgb.colour.encoded.map(|v| (255.0 * v).round());
        let note = if srgb.colour.out_of_gamut { " (outside the gamut, cut)" } else { "" };
        out.line("sRGB of the light", format!("#{:02x}{:02x}{:02x}{note}", r as u8, g as u8, b as u8));
    }
}

/// Where the light stands to the nearest nominal white.
pub(super) fn nominal_white(t: &Tolerance) -> String {
    let side = if t.inside { "inside" } else { "outside" };
    let steps = t.sdcm.map_or(String::new(), |s| format!(", {s:.1} SDCM"));
    let circle = t.delta_uv_prime / UV_PRIME_STEP;
    format!(
        "{:.0} K: {side} of the quadrangle{steps}, Δu′v′ {:.5} ({circle:.1} steps)",
        t.nominal.cct_k, t.delta_uv_prime
    )
}

fn rendition(out: &mut Lines, c: &Conversion) {
    if c.cri.is_some() || c.tm30.is_some() {
        out.gap();
    }
    if let Some(cri) = c.cri {
        out.line("CRI Ra, R9", format!("{:.2}, {:.2}", cri.ra, cri.r[8]));
        out.line("R1 … R14", cri.r.map(|r| format!("{r:.0}")).join(" "));
    }
    if let Some(tm30) = &c.tm30 {
        let rg = tm30.rg.map_or("–".into(), |v| format!("{v:.2}"));
        out.line("TM-30 Rf, Rg", format!("{:.2}, {rg}", tm30.rf));
    }
}

fn biology(out: &mut Lines, c: &Conversion) {
    let melanopic = c.alpha_opic.iter().find(|a| a.receptor == "melanopic");
    if melanopic.is_some() || c.photons.is_some() {
        out.gap();
    }
    if let Some(a) = melanopic {
        let irradiance = c.absolute.iter().find(|f| f.quantity == Quantity::Irradiance);
        if let Some(f) = irradiance {
            let edi_lx = f.factor * a.equivalent_daylight;
            out.line("melanopic EDI", format!("{} lx", show(edi_lx)));
            // What would be enough by day is too much at night: each bound with its answer.
            let kept = RECOMMENDATIONS.map(|r| {
                let sign = if r.at_least { '≥' } else { '≤' };
                format!("{} {sign} {} lx {}", r.when, r.bound_lx, if r.is_met(edi_lx) { "yes" } else { "no" })
            });
            out.line("  at the eye recommended", kept.join(", "));
        }
        out.line("melanopic DER", a.der.map_or("–".into(), show));
    }
    if let Some(p) = &c.photons {
        for f in &c.absolute {
            match f.quantity {
                Quantity::Irradiance => out.line("PPFD", format!("{} µmol/(m²·s)", show(f.factor * p.par_umol))),
                Quantity::Flux => {
                    out.line("PPF", format!("{} µmol/s", show(f.factor * p.par_umol)));
                    out.line("photons", format!("{} per second", show(f.factor * p.total_count)));
                }
                _ => {}
            }
        }
        out.line("PAR photons per joule", p.umol_per_j.map_or("–".into(), |v| format!("{} µmol/J", show(v))));
    }
    for h in &c.hazard {
        let label = match h.key {
            "blue_light" => "blue-light weighted B(λ)",
            "retinal_thermal" => "retinal thermal R(λ)",
            _ => "UV-hazard weighted S(λ)",
        };
        if let Some(f) = c.absolute.first() {
            out.line(label, format!("{} {}", show(h.weighted), f.quantity.unit()));
        }
    }
}

/// A limit of a risk group, without zeros at its end.
pub(super) fn limit(value: f64) -> String {
    if value.fract() == 0.0 || value < 1.0 { value.to_string() } else { significant(value, 3) }
}

fn risk(out: &mut Lines, c: &Conversion) {
    let Some(risk) = &c.risk else { return };
    let Some(group) = risk.group() else { return };
    out.gap();
    let bound = if risk.complete() { "" } else { ", a lower bound" };
    out.line("risk group (IEC 62471)", format!("{}{bound}", group.word()));
    for a in &risk.assessments {
        let [exempt, one, two] = a.limits.map(limit);
        let time =
            a.longest_s.map_or_else(|| "no limit of time".to_owned(), |t| format!("at most {} s", significant(t, 3)));
        out.line(
            &format!("  {} {}", a.hazard.symbol(), a.hazard.word()),
            format!(
                "{} {}: {}, {time} (exempt to {exempt}, group 1 to {one}, group 2 to {two})",
                significant(a.value, 4),
                a.hazard.quantity().unit(),
                a.group.word()
            ),
        );
    }
    for (hazard, why) in &risk.missing {
        out.line(&format!("  {} {}", hazard.symbol(), hazard.word()), format!("not assessed: {}", why.word()));
    }
}

fn shape(out: &mut Lines, c: &Conversion) {
    let Some(peak) = c.peak_wavelength_nm else { return };
    let mut text = format!("peak {peak} nm");
    if let Some(v) = c.centroid_wavelength_nm {
        let _ = write!(text, ", centroid {v:.2} nm");
    }
    if let Some(v) = c.fwhm_nm {
        let _ = write!(text, ", FWHM {v:.2} nm");
    }
    out.line("spectrum", text);
}

fn basis(out: &mut Lines, c: &Conversion, settings: &Settings) {
    out.gap();
    let i = &c.integration;
    let rule = match i.rule {
        Rule::Summation => "summation (CIE 15)",
        Rule::Trapezoid => "trapezoid",
        Rule::Exact => "exact integral of straight lines",
        Rule::Lines => "sum over lines",
    };
    let resampling = settings.resampling.map_or_else(
        || {
            let thinned = |t: f64| format!("an adaptive step to {} %", significant(100.0 * t, 2));
            settings.thinning.map_or_else(|| "not resampled".to_owned(), thinned)
        },
        |r| format!("resampled to {} nm, {:?}", r.step_nm, r.interpolation).to_lowercase(),
    );
    let observer = settings.observer;
    out.line(
        "obtained by",
        format!("{rule}, {resampling}, K_m {} lm/W, {}, {observer}", settings.efficacy.k_m, settings.efficiency),
    );
    let part = |v: Option<f64>| match v {
        None => "–".to_owned(),
        Some(v) if v >= 1.0 => "100 % or more".to_owned(),
        Some(v) => format!("{} %", significant(100.0 * v, 2)),
    };
    let bound = &i.error_bound;
    out.line(
        "photopic integral off by",
        format!(
            "at most {} from the step, {} from the range",
            part(bound.step_relative),
            part(bound.truncation_relative)
        ),
    );
}

/// What the instrument printed beside ours, as lines; empty without any.
#[must_use]
pub fn instrument(compared: &[serde_json::Value]) -> String {
    let mut out = Lines(String::new());
    if compared.is_empty() {
        return out.0;
    }
    out.gap();
    let _ = writeln!(out.0, "  {:<LABEL$} {:>14} {:>14}   difference", "the instrument printed", "printed", "ours");
    for c in compared {
        let text = |key: &str| c[key].as_str().unwrap_or_default().to_owned();
        let number = |key: &str| c[key].as_f64().unwrap_or(f64::NAN);
        let difference = if c["within_printed_digits"] == true {
            "rounding".to_owned()
        } else {
            format!("{}{}", if number("difference") > 0.0 { "+" } else { "" }, significant(number("difference"), 3))
        };
        let (printed, ours) = (show(number("printed")), show(number("ours")));
        let _ = writeln!(out.0, "  {:<LABEL$} {printed:>14} {ours:>14}   {difference}", text("label"));
    }
    out.0
}

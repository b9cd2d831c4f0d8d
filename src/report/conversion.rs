//! A conversion as a JSON object, and the settings that stand in its envelope.

use serde_json::{Map, Value, json};

use crate::colorimetry::iec_60081::Steps;
use crate::colorimetry::rgb::SPACES;
use crate::colorimetry::tm30::Bin;
use crate::colorimetry::tolerance::{Tolerance, UV_PRIME_STEP};
use crate::conversion::{AbsoluteFigures, Conversion, Settings, XyzScale};
use crate::photometry::alpha_opic::{RECOMMENDATIONS, Recommendation};
use crate::photometry::photon::Photons;
use crate::photometry::risk::{Assessment, Risk};
use crate::spectrum::Quantity;
use crate::spectrum::format::Printed;
use crate::spectrum::integrate::ErrorBound;

/// Keys of the radiometric, the luminous and the photon figures of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Keys {
    /// `irradiance_w_per_m2` ….
    pub radiometric: &'static str,
    /// `illuminance_lx` ….
    pub luminous: &'static str,
    /// `total_umol_per_m2_s` ….
    pub photons_total: &'static str,
    /// `total_photons_per_m2_s` ….
    pub photons_count: &'static str,
    /// `ppfd_umol_per_m2_s` ….
    pub photons_par: &'static str,
}

/// The keys of an absolute quantity; `None` for relative spectra.
#[must_use]
pub fn keys(quantity: Quantity) -> Option<Keys> {
    let of = |radiometric, luminous, photons_total, photons_count, photons_par| {
        Some(Keys { radiometric, luminous, photons_total, photons_count, photons_par })
    };
    match quantity {
        Quantity::Flux => of("flux_w", "luminous_flux_lm", "total_umol_per_s", "total_photons_per_s", "ppf_umol_per_s"),
        Quantity::Intensity => of(
            "intensity_w_per_sr",
            "luminous_intensity_cd",
            "total_umol_per_s_sr",
            "total_photons_per_s_sr",
            "par_umol_per_s_sr",
        ),
        Quantity::Irradiance => of(
            "irradiance_w_per_m2",
            "illuminance_lx",
            "total_umol_per_m2_s",
            "total_photons_per_m2_s",
            "ppfd_umol_per_m2_s",
        ),
        Quantity::Radiance => of(
            "radiance_w_per_m2_sr",
            "luminance_cd_per_m2",
            "total_umol_per_m2_s_sr",
            "total_photons_per_m2_s_sr",
            "par_umol_per_m2_s_sr",
        ),
        Quantity::Exitance => of(
            "exitance_w_per_m2",
            "luminous_exitance_lm_per_m2",
            "exitance_total_umol_per_m2_s",
            "exitance_total_photons_per_m2_s",
            "exitance_par_umol_per_m2_s",
        ),
        Quantity::Energy => of("energy_j", "luminous_energy_lm_s", "total_umol", "total_photons", "par_umol"),
        Quantity::Exposure => of(
            "exposure_j_per_m2",
            "luminous_exposure_lx_s",
            "total_umol_per_m2",
            "total_photons_per_m2",
            "par_umol_per_m2",
        ),
        Quantity::Relative => None,
    }
}

/// A number, or null where there is none.
fn number(value: Option<f64>) -> Value {
    value.map_or(Value::Null, Value::from)
}

fn pair(value: Option<[f64; 2]>) -> Value {
    value.map_or(Value::Null, |v| json!(v))
}

/// The settings of a run as the envelope shows them.
#[must_use]
pub fn settings(settings: &Settings) -> Value {
    let contract = &settings.contract;
    let mut out = Map::new();
    out.insert("rule".into(), contract.rule.map_or_else(|| json!("by grid"), |r| json!(r.word())));
    if let Some((low, high)) = contract.range_nm {
        out.insert("range_nm".into(), json!([low, high]));
    }
    out.insert("resampling".into(), resampling(settings));
    out.insert("k_m_lm_per_w".into(), settings.efficacy.k_m.into());
    out.insert("k_m_scotopic_lm_per_w".into(), settings.efficacy.k_m_scotopic.into());
    out.insert("luminous_efficiency".into(), json!(settings.efficiency));
    out.insert("observer".into(), json!(settings.observer));
    out.insert("second_radiation_constant_m_k".into(), settings.c2.metre_kelvin().into());
    out.insert("cct_method".into(), json!(settings.cct_method));
    out.insert(
        "dominant_wavelength_white_xy".into(),
        settings.illuminant.as_ref().map_or_else(|| json!(settings.dominant_white_xy), |_| json!("of the illuminant")),
    );
    out.insert("chromatic_adaptation".into(), json!(settings.adaptation));
    out.insert("rgb_white_xyz".into(), settings.rgb_white.map_or_else(|| json!("of each space"), |w| json!(w)));
    if let Some(luminance) = settings.mesopic_adaptation {
        out.insert("mesopic_adaptation_cd_per_m2".into(), luminance.into());
    }
    if settings.risk_group {
        out.insert("risk_group".into(), true.into());
    }
    if let Some((name, _)) = &settings.illuminant {
        out.insert("illuminant".into(), json!(name));
    }
    if !settings.geometry.is_empty() {
        out.insert("geometry".into(), json!(settings.geometry));
    }
    if let Some(level) = &settings.level {
        out.insert("scale_to".into(), json!(level.to_string()));
    }
    out.into()
}

fn resampling(settings: &Settings) -> Value {
    settings.resampling.map_or_else(
        || settings.thinning.map_or_else(|| json!("none"), |t| json!({"tolerance": t, "interpolation": "linear"})),
        |r| {
            let range = r.range_nm.map_or_else(|| json!("own"), |(a, b)| json!([a, b]));
            json!({"step_nm": r.step_nm, "range_nm": range, "interpolation": r.interpolation})
        },
    )
}

/// The object of one conversion in `results[]`.
#[must_use]
pub fn json(c: &Conversion, settings: &Settings) -> Map<String, Value> {
    let groups = settings.groups;
    let mut out = Map::new();
    let mut set = |key: &str, value: Value| out.insert(key.to_owned(), value);
    set("name", c.name.clone().into());
    set("quantity", json!(c.quantity));
    if !c.absolute.is_empty() {
        set("radiometric", figures(c, |k| k.radiometric, |f| Some(f.radiometric)));
        set("photopic", figures(c, |k| k.luminous, |f| Some(f.photopic)));
        set("scotopic", figures(c, |k| k.luminous, |f| Some(f.scotopic)));
        let relations: Map<String, Value> = (c.absolute.iter())
            .filter(|f| !f.relations.is_empty())
            .map(|f| (f.quantity.word().to_owned(), json!(f.relations)))
            .collect();
        if !relations.is_empty() {
            set("derived_by", relations.into());
        }
    }
    if settings.mesopic_adaptation.is_some() {
        set("mesopic", mesopic(c));
    }
    set("luminous_efficacy_of_radiation_lm_per_w", number(c.efficacy_lm_per_w));
    set("scotopic_photopic_ratio", number(c.scotopic_photopic_ratio));
    set("xyz", c.xyz.map_or(Value::Null, |v| json!(v)));
    set(
        "xyz_scale",
        match c.xyz_scale {
            XyzScale::Absolute => "K_m times the integrals",
            XyzScale::Hundred => "Y = 100",
            XyzScale::PerfectDiffuser => "Y = 100 of the perfect diffuser",
        }
        .into(),
    );
    set("chromaticity_xy", pair(c.xy));
    set("chromaticity_uv_prime", pair(c.uv_prime));
    if let Some(w) = &c.whiteness {
        set("whiteness", w.whiteness.into());
        set("tint", w.tint.into());
        set("yellowness_e313", w.yellowness.into());
    }
    if groups.colour {
        set("cct_k", number(c.cct.map(|v| v.kelvin)));
        set("duv", number(c.cct.map(|v| v.duv)));
        if let Some(t) = &c.tolerance {
            set("nominal_white", nominal_white(t));
        }
        if let Some(s) = &c.standard_colour {
            set("standard_colour", json!({"name": standard_colour(s), "sdcm": s.sdcm}));
        }
        set("dominant_wavelength_nm", number(c.dominant.map(|v| v.wavelength_nm)));
        set("excitation_purity", number(c.dominant.map(|v| v.excitation_purity)));
    }
    if groups.shape {
        set("peak_wavelength_nm", number(c.peak_wavelength_nm));
        set("centroid_wavelength_nm", number(c.centroid_wavelength_nm));
        if c.integration.rule != crate::spectrum::integrate::Rule::Lines {
            set("fwhm_nm", number(c.fwhm_nm));
        }
    }
    if groups.cri {
        set("cri_ra", number(c.cri.map(|v| v.ra)));
        set("cri_r", c.cri.map_or(Value::Null, |v| json!(v.r)));
    }
    if groups.tm30 {
        set("tm30_rf", number(c.tm30.as_ref().map(|v| v.rf)));
        set("tm30_rg", number(c.tm30.as_ref().and_then(|v| v.rg)));
        set(
            "tm30_bins",
            c.tm30
                .as_ref()
                .map_or(Value::Null, |v| v.bins.iter().map(|b| b.as_ref().map(bin)).collect::<Vec<_>>().into()),
        );
    }
    if groups.alpha_opic {
        set("alpha_opic", alpha_opic(c));
    }
    if !c.hazard.is_empty() || c.risk.is_some() {
        set("hazard", hazard(c));
    }
    if let Some(photons) = &c.photons {
        set("photon", photon(c, photons));
    }
    if groups.rgb {
        set("rgb", rgb(c, settings));
    }
    set("integration", integration(c, settings));
    out
}

/// The name of a standard colour of IEC 60081.
pub(super) fn standard_colour(s: &Steps) -> String {
    format!("F {:.0}", s.colour.nominal_k)
}

fn nominal_white(t: &Tolerance) -> Value {
    let mut out = Map::new();
    out.insert("nominal_cct_k".into(), t.nominal.cct_k.into());
    out.insert("inside_quadrangle".into(), t.inside.into());
    out.insert("delta_uv_prime".into(), t.delta_uv_prime.into());
    out.insert("uv_prime_steps".into(), (t.delta_uv_prime / UV_PRIME_STEP).into());
    if let Some(sdcm) = t.sdcm {
        out.insert("sdcm".into(), sdcm.into());
    }
    out.into()
}

fn figures(
    c: &Conversion,
    key: impl Fn(&Keys) -> &'static str,
    value: impl Fn(&AbsoluteFigures) -> Option<f64>,
) -> Value {
    let all = c.absolute.iter().filter_map(|f| Some((key(&keys(f.quantity)?).to_owned(), number(value(f)))));
    all.collect::<Map<String, Value>>().into()
}

fn mesopic(c: &Conversion) -> Value {
    let Some(state) = &c.mesopic else { return Value::Null };
    let mut out = Map::new();
    out.insert("adaptation_luminance_cd_per_m2".into(), state.adaptation_luminance.into());
    out.insert("adaptation_mesopic_luminance_cd_per_m2".into(), state.adaptation.luminance_mesopic.into());
    out.insert("m".into(), state.adaptation.m.into());
    if let Value::Object(figures) = figures(c, |k| k.luminous, |f| f.mesopic) {
        out.extend(figures);
    }
    out.into()
}

fn bin(b: &Bin) -> Value {
    json!({
        "reference": b.reference,
        "test": b.test,
        "chroma_shift": b.chroma_shift,
        "hue_shift_rad": b.hue_shift,
        "fidelity": b.fidelity,
    })
}

/// Keys of the α-opic quantity and of the equivalent daylight quantity, which has a short name where the standard gives it one: EDI
/// for irradiance, EDL for radiance.
pub(super) fn alpha_opic_keys(quantity: Quantity) -> Option<(&'static str, &'static str)> {
    match quantity {
        Quantity::Irradiance => Some(("irradiance_w_per_m2", "edi_lx")),
        Quantity::Radiance => Some(("radiance_w_per_m2_sr", "edl_cd_per_m2")),
        Quantity::Flux => Some(("flux_w", "equivalent_daylight_flux_lm")),
        Quantity::Intensity => Some(("intensity_w_per_sr", "equivalent_daylight_intensity_cd")),
        _ => None,
    }
}

fn alpha_opic(c: &Conversion) -> Value {
    let mut out = Map::new();
    for a in &c.alpha_opic {
        let mut one = Map::new();
        one.insert("der".into(), number(a.der));
        one.insert("efficacy_w_per_lm".into(), number(a.efficacy_w_per_lm));
        for f in &c.absolute {
            let Some((radiometric, equivalent)) = alpha_opic_keys(f.quantity) else { continue };
            one.insert(equivalent.into(), (f.factor * a.equivalent_daylight).into());
            one.insert(radiometric.into(), (f.factor * a.radiometric).into());
            if a.receptor == "melanopic" && f.quantity == Quantity::Irradiance {
                one.insert("recommended".into(), recommended(f.factor * a.equivalent_daylight));
            }
        }
        out.insert(a.receptor.into(), one.into());
    }
    out.into()
}

/// The recommendations for the eye, and whether an illuminance keeps them.
fn recommended(edi_lx: f64) -> Value {
    let one = |r: &Recommendation| {
        let bound = if r.at_least { "at_least_lx" } else { "at_most_lx" };
        (r.when.to_owned(), json!({bound: r.bound_lx, "met": r.is_met(edi_lx)}))
    };
    Value::Object(RECOMMENDATIONS.iter().map(one).collect())
}

fn hazard(c: &Conversion) -> Value {
    let mut out = Map::new();
    for h in &c.hazard {
        let mut one = Map::new();
        for f in &c.absolute {
            if let Some(keys) = keys(f.quantity) {
                one.insert(keys.radiometric.into(), (f.factor * h.weighted).into());
            }
        }
        let luminous = c.absolute.first().map(|f| f.photopic).filter(|p| *p > 0.0);
        if let Some(luminous) = luminous {
            one.insert("efficacy_w_per_lm".into(), number(Some(h.weighted / luminous).filter(|v| v.is_finite())));
        }
        if let Some((low, high)) = h.covered_nm {
            one.insert("covered_nm".into(), json!([low, high]));
        }
        out.insert(h.key.into(), one.into());
    }
    if let Some(risk) = &c.risk {
        out.insert("risk_group".into(), risk_group(risk));
    }
    out.into()
}

fn risk_group(risk: &Risk) -> Value {
    let mut out = Map::new();
    out.insert("standard".into(), "IEC 62471:2006".into());
    out.insert("group".into(), risk.group().map_or(Value::Null, |g| g.key().into()));
    out.insert("complete".into(), risk.complete().into());
    out.extend(risk.subtense_rad.map(|a| ("subtense_rad".into(), a.into())));
    let one = |a: &Assessment| {
        let unit = if a.hazard.quantity() == Quantity::Radiance { "w_per_m2_sr" } else { "w_per_m2" };
        let mut one = Map::new();
        one.insert("symbol".into(), a.hazard.symbol().into());
        one.insert(format!("value_{unit}"), a.value.into());
        one.insert(format!("limits_{unit}"), json!(a.limits));
        one.insert("group".into(), a.group.key().into());
        one.extend(a.longest_s.map(|t| ("longest_exposure_s".into(), t.into())));
        one.insert("covered_nm".into(), json!([a.covered_nm.0, a.covered_nm.1]));
        (a.hazard.key().to_owned(), Value::from(one))
    };
    out.insert("hazards".into(), Value::Object(risk.assessments.iter().map(one).collect()));
    let missing = risk.missing.iter().map(|(hazard, why)| (hazard.key().to_owned(), Value::from(why.word())));
    out.insert("not_assessed".into(), Value::Object(missing.collect()));
    out.into()
}

fn photon(c: &Conversion, p: &Photons) -> Value {
    let mut out = Map::new();
    for f in &c.absolute {
        let Some(keys) = keys(f.quantity) else { continue };
        out.insert(keys.photons_total.into(), (f.factor * p.total_umol).into());
        out.insert(keys.photons_count.into(), (f.factor * p.total_count).into());
        out.insert(keys.photons_par.into(), (f.factor * p.par_umol).into());
    }
    out.insert("umol_per_j".into(), number(p.umol_per_j));
    out.insert("par_umol_per_par_j".into(), number(p.par_umol_per_par_j));
    out.into()
}

fn rgb(c: &Conversion, settings: &Settings) -> Value {
    if c.rgb.is_empty() {
        return Value::Null;
    }
    let mut out = Map::new();
    for f in &c.rgb {
        out.insert(f.key.into(), json!(f.colour.encoded));
    }
    for f in &c.rgb {
        out.insert(format!("{}_linear", f.key), json!(f.colour.linear));
    }
    let clipped: Map<String, Value> =
        (c.rgb.iter()).filter(|f| f.colour.out_of_gamut).map(|f| (f.key.to_owned(), f.colour.clipped.into())).collect();
    let whites: Map<String, Value> = SPACES.iter().map(|s| (s.key.to_owned(), s.white_name.into())).collect();
    out.insert("clipped".into(), clipped.into());
    out.insert("white".into(), whites.into());
    let adaptation = if settings.rgb_white.is_some() { json!(settings.adaptation) } else { json!("none") };
    out.insert("adaptation".into(), adaptation);
    out.into()
}

fn integration(c: &Conversion, settings: &Settings) -> Value {
    let i = &c.integration;
    let ErrorBound { truncation_relative, step_relative } = i.error_bound;
    let total = truncation_relative.zip(step_relative).map(|(a, b)| a + b);
    let extrapolation = settings.resampling.map_or_else(|| json!("none"), |r| json!(r.extrapolation));
    let mut out = json!({
        "rule": i.rule.word(),
        "photon_rule": i.photon_rule.word(),
        "range_nm": [i.range_nm.0, i.range_nm.1],
        "samples": i.samples,
        "resampling": resampling(settings),
        "extrapolation": extrapolation,
        "k_m_lm_per_w": settings.efficacy.k_m,
        "k_m_scotopic_lm_per_w": settings.efficacy.k_m_scotopic,
        "luminous_efficiency": settings.efficiency,
        "observer": settings.observer,
        "second_radiation_constant_m_k": settings.c2.metre_kelvin(),
        "cct_method": settings.cct_method,
        "error_bound": {
            "photopic_relative": total,
            "truncation_relative": truncation_relative,
            "step_relative": step_relative,
        },
    });
    if let Some(step) = i.step_nm {
        out["step_nm"] = step.into();
    }
    out
}

/// What the instrument printed beside our own figures: an object for each one that we have, too.
///
/// `difference` is ours less theirs; `within_printed_digits` says whether rounding to the instrument's digits explains it.
#[must_use]
pub fn instrument(result: &Map<String, Value>, printed: &[Printed]) -> Vec<Value> {
    let compare = |p: &Printed| {
        let ours = super::csv::at(result, p.key)?.as_f64()?;
        let difference = ours - p.value;
        let half = half_digit(p);
        let within = difference.abs() <= half * (1.0 + 1e-9);
        Some(json!({
            "key": p.key,
            "label": p.label,
            "printed": p.value,
            "printed_text": p.text,
            "ours": ours,
            "difference": difference,
            "within_printed_digits": within,
        }))
    };
    printed.iter().filter(|p| !p.key.is_empty()).filter_map(compare).collect()
}

/// Half a unit of the last digit printed, in the unit of the key (a percentage printed as 41.5 is 0.415 there).
fn half_digit(p: &Printed) -> f64 {
    let decimals = p.text.split_once('.').map_or(0, |(_, d)| d.chars().take_while(char::is_ascii_digit).count());
    let scale = match p.text.trim().parse::<f64>() {
        Ok(text) if text != 0.0 => (p.value / text).abs(),
        _ => 1.0,
    };
    0.5 * scale * 10f64.powi(-i32::try_from(decimals).unwrap_or(0))
}

//! Uncertainties beside the figures of a conversion: JSON of the same shape as the figures, and a table for people.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::conversion::{alpha_opic_keys, keys};
use crate::constants::AVOGADRO;
use crate::conversion::Conversion;
use crate::photometry::alpha_opic::RECEPTORS;
use crate::spectrum::Quantity;
use crate::uncertainty::{FigureUncertainty, Measurand, Method, Uncertainty};
use crate::units::{significant, to_uncertainty};

/// The dotted paths at which a conversion's JSON has a figure, and its value there over the measured one's.
fn paths(measurand: Measurand, c: &Conversion) -> Vec<(String, f64)> {
    let quantities: Vec<(Quantity, f64)> = c.absolute.iter().map(|f| (f.quantity, f.factor)).collect();
    paths_of(measurand, &quantities)
}

/// The dotted path of a figure of the quantity measured; `None` where JSON does not have it.
pub(super) fn measured_path(measurand: Measurand, quantity: Quantity) -> Option<String> {
    paths_of(measurand, &[(quantity, 1.0)]).into_iter().next().map(|(path, _)| path)
}

/// The same for quantities with their factors.
fn paths_of(measurand: Measurand, quantities: &[(Quantity, f64)]) -> Vec<(String, f64)> {
    use Measurand as M;
    let one = |path: &str| vec![(path.to_owned(), 1.0)];
    let each = |path: &dyn Fn(Quantity) -> Option<String>, factor: f64| {
        quantities.iter().filter_map(|(q, f)| Some((path(*q)?, factor * f))).collect::<Vec<_>>()
    };
    match measurand {
        M::Radiometric => each(&|q| Some(format!("radiometric.{}", keys(q)?.radiometric)), 1.0),
        M::Photopic => each(&|q| Some(format!("photopic.{}", keys(q)?.luminous)), 1.0),
        M::Scotopic => each(&|q| Some(format!("scotopic.{}", keys(q)?.luminous)), 1.0),
        M::Mesopic => each(&|q| Some(format!("mesopic.{}", keys(q)?.luminous)), 1.0),
        M::Efficacy => one("luminous_efficacy_of_radiation_lm_per_w"),
        M::ScotopicPhotopicRatio => one("scotopic_photopic_ratio"),
        M::Tristimulus(k) => one(&format!("xyz.{k}")),
        M::Chromaticity(k) => one(&format!("chromaticity_xy.{k}")),
        M::UniformChromaticity(k) => one(&format!("chromaticity_uv_prime.{k}")),
        M::Cct => one("cct_k"),
        M::Duv => one("duv"),
        M::DominantWavelength => one("dominant_wavelength_nm"),
        M::Whiteness => one("whiteness"),
        M::Tint => one("tint"),
        M::Yellowness => one("yellowness_e313"),
        M::ExcitationPurity => one("excitation_purity"),
        M::PeakWavelength => one("peak_wavelength_nm"),
        M::CentroidWavelength => one("centroid_wavelength_nm"),
        M::Fwhm => one("fwhm_nm"),
        M::Ra => one("cri_ra"),
        M::SpecialIndex(k) => one(&format!("cri_r.{k}")),
        M::Rf => one("tm30_rf"),
        M::Rg => one("tm30_rg"),
        M::DaylightEfficacyRatio(k) => one(&format!("alpha_opic.{}.der", RECEPTORS[k])),
        M::AlphaOpicEfficacy(k) => one(&format!("alpha_opic.{}.efficacy_w_per_lm", RECEPTORS[k])),
        M::EquivalentDaylight(k) => {
            each(&|q| Some(format!("alpha_opic.{}.{}", RECEPTORS[k], alpha_opic_keys(q)?.1)), 1.0)
        }
        M::AlphaOpic(k) => each(&|q| Some(format!("alpha_opic.{}.{}", RECEPTORS[k], alpha_opic_keys(q)?.0)), 1.0),
        M::Hazard(key) => each(&|q| Some(format!("hazard.{key}.{}", keys(q)?.radiometric)), 1.0),
        M::Photons => {
            let mut all = each(&|q| Some(format!("photon.{}", keys(q)?.photons_total)), 1.0);
            all.extend(each(&|q| Some(format!("photon.{}", keys(q)?.photons_count)), 1e-6 * AVOGADRO));
            all
        }
        M::PhotonsPar => each(&|q| Some(format!("photon.{}", keys(q)?.photons_par)), 1.0),
        M::PhotonsPerJoule => one("photon.umol_per_j"),
        M::PhotonsPerParJoule => one("photon.par_umol_per_par_j"),
    }
}

/// Puts a value at a dotted path; numbers in it are places in a list.
fn put(root: &mut Map<String, Value>, path: &str, value: Value) {
    let (first, rest) = path.split_once('.').map_or((path, None), |(a, b)| (a, Some(b)));
    let Some(rest) = rest else {
        root.insert(first.to_owned(), value);
        return;
    };
    if let Ok(index) = rest.parse::<usize>() {
        let list = root.entry(first).or_insert_with(|| json!([]));
        if let Value::Array(items) = list {
            items.resize(items.len().max(index + 1), Value::Null);
            items[index] = value;
        }
        return;
    }
    if let Value::Object(inner) = root.entry(first).or_insert_with(|| json!({})) {
        put(inner, rest, value);
    }
}

fn stated(f: &FigureUncertainty, factor: f64) -> Value {
    let Some(s) = f.stated else { return Value::Null };
    let method = match f.method {
        Method::Analytic => "analytic",
        Method::MonteCarlo => "monte-carlo",
    };
    json!({
        "standard": factor * s.standard,
        "expanded_95": s.expanded_95.map(|v| factor * v),
        "method": method,
        "analytic_standard": f.analytic.map(|u| factor * u),
        "monte_carlo_standard": Some(factor * f.sampled.standard).filter(|v| v.is_finite()),
        "monte_carlo_mean": Some(factor * f.sampled.mean).filter(|v| v.is_finite()),
    })
}

/// The keys `uncertainty` and `uncertainty_budget` of a result.
#[must_use]
pub fn json(u: &Uncertainty, c: &Conversion) -> Map<String, Value> {
    let mut figures = Map::new();
    for f in u.figures.iter().filter(|f| f.value.is_finite()) {
        for (path, factor) in paths(f.measurand, c) {
            put(&mut figures, &path, stated(f, factor));
        }
    }
    let row = |name: &str| {
        let found = u.contributions.iter().find(|c| c.name == name);
        let mut standard = Map::new();
        for (f, s) in u.figures.iter().zip(found.map_or(&[][..], |c| &c.standard)).filter(|(f, _)| f.value.is_finite())
        {
            for (path, factor) in paths(f.measurand, c) {
                put(&mut standard, &path, Some(factor * s).filter(|v| v.is_finite()).map_or(Value::Null, Value::from));
            }
        }
        json!({"name": name, "standard": standard})
    };
    let contributions: Vec<Value> = u.ranking(leading(u)).iter().map(|(name, _)| row(name)).collect();
    let mut out = Map::new();
    out.insert("uncertainty".into(), figures.into());
    out.insert(
        "uncertainty_budget".into(),
        json!({
            "trials": u.trials,
            "adaptive": u.adaptive,
            "seed": u.seed,
            "ranked_by": paths(leading(u), c).first().map(|(p, _)| p.clone()),
            "contributions": contributions,
        }),
    );
    out
}

/// The figure by which a budget is ranked: the luminous quantity, or of a relative spectrum the chromaticity.
#[must_use]
pub fn leading(u: &Uncertainty) -> Measurand {
    let has = |m| u.figure(m).is_some();
    if has(Measurand::Photopic) { Measurand::Photopic } else { Measurand::Chromaticity(0) }
}

/// Figures of the table for people, with label and unit.
pub(super) fn shown(quantity: Quantity) -> Vec<(Measurand, String, &'static str)> {
    use Measurand as M;
    let plain = |m: Measurand, unit| (m, m.to_string(), unit);
    let melanopic = RECEPTORS.iter().position(|r| *r == "melanopic").unwrap_or(0);
    let unit = quantity.luminous_unit();
    vec![
        (M::Photopic, super::text::luminous_name(quantity).to_owned(), unit),
        (M::Radiometric, super::text::radiometric_name(quantity).to_owned(), quantity.unit()),
        plain(M::Efficacy, "lm/W"),
        plain(M::ScotopicPhotopicRatio, ""),
        plain(M::Chromaticity(0), ""),
        plain(M::Chromaticity(1), ""),
        plain(M::UniformChromaticity(0), ""),
        plain(M::UniformChromaticity(1), ""),
        plain(M::Cct, "K"),
        plain(M::Duv, ""),
        plain(M::Whiteness, ""),
        plain(M::Tint, ""),
        plain(M::Yellowness, ""),
        plain(M::DominantWavelength, "nm"),
        plain(M::ExcitationPurity, ""),
        plain(M::PeakWavelength, "nm"),
        plain(M::CentroidWavelength, "nm"),
        plain(M::Fwhm, "nm"),
        plain(M::Ra, ""),
        plain(M::SpecialIndex(8), ""),
        plain(M::Rf, ""),
        plain(M::Rg, ""),
        (M::EquivalentDaylight(melanopic), "melanopic equivalent".to_owned(), unit),
        plain(M::DaylightEfficacyRatio(melanopic), ""),
    ]
}

/// Figures whose budget people are shown, as far as there are.
const BUDGETED: [Measurand; 6] =
    [Measurand::Photopic, Measurand::Chromaticity(0), Measurand::Cct, Measurand::Duv, Measurand::Ra, Measurand::Rf];

/// Those with name and unit, for a picture.
#[must_use]
pub fn budgeted(quantity: Quantity) -> Vec<(Measurand, String, &'static str)> {
    shown(quantity).into_iter().filter(|(m, ..)| BUDGETED.contains(m)).collect()
}

/// Figures with their uncertainties, and the budget, for people.
#[must_use]
pub fn text(u: &Uncertainty, c: &Conversion) -> String {
    let mut out = String::new();
    let how = if u.adaptive { ", settled" } else { "" };
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "\n  {:<28} {:>14} {:>12}   95 % interval ({} trials{how}, seed {})",
        "uncertainty", "value", "standard", u.trials, u.seed
    );
    for (measurand, label, unit) in shown(c.quantity) {
        let Some(f) = u.figure(measurand).filter(|f| f.value.is_finite()) else { continue };
        let Some(s) = f.stated else {
            let _ = writeln!(out, "  {label:<28} {:>14} {:>12}", significant(f.value, 6), "–");
            continue;
        };
        let standard = if s.standard > 1e-12 * f.value.abs() { significant(s.standard, 2) } else { "0".to_owned() };
        let [low, high] = s.expanded_95.map(|v| to_uncertainty(v, s.standard));
        let value = to_uncertainty(f.value, s.standard);
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let _ = writeln!(out, "  {label:<28} {value:>14} {standard:>12}   {low} to {high}{unit}");
    }
    let columns: Vec<Measurand> =
        BUDGETED.into_iter().filter(|m| u.figure(*m).is_some_and(|f| f.value.is_finite())).collect();
    let wide = u.contributions.iter().map(|c| c.name.chars().count()).fold(28, usize::max);
    let _ = write!(out, "\n  {:<wide$}", "share of the variance, %");
    for m in &columns {
        let name = if *m == Measurand::Photopic { c.quantity.luminous_unit().to_owned() } else { m.to_string() };
        let _ = write!(out, " {name:>8}");
    }
    out.push('\n');
    let ranked: Vec<Vec<(&str, f64)>> = columns.iter().map(|m| u.ranking(*m)).collect();
    for (name, _) in u.ranking(leading(u)) {
        let _ = write!(out, "  {name:<wide$}");
        for ranking in &ranked {
            let share = ranking.iter().find(|(n, _)| *n == name).map_or(f64::NAN, |(_, s)| *s);
            let _ = write!(out, " {:>8.1}", 100.0 * share);
        }
        out.push('\n');
    }
    out
}

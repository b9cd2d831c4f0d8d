//! Fits of BRDF models as JSON, text, table and material file.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::brdf::fit::{
    Comparison, Estimate, Fit, Metric, Options, Samples, Selection, TOO_CLOSE, Uncertainty, Weighting,
};
use crate::brdf::table::Channel;
use crate::finding::Finding;
use crate::geometry::direction::{phi, theta};
use crate::units::significant;

/// Digits shown for people; JSON has all.
const DIGITS: usize = 6;
/// Correlation from which on a pair of parameters is named.
const STRONG: f64 = 0.99;

/// Fits to one table.
#[derive(Debug, Clone, Copy)]
pub struct Answer<'a> {
    /// The table's file.
    pub path: &'a str,
    /// What took part.
    pub samples: &'a Samples,
    /// At least one.
    pub fits: &'a [Fit],
    /// Where there are several with criteria.
    pub comparison: Option<&'a Comparison>,
    /// How they were made.
    pub options: &'a Options,
}

fn metric(m: Metric) -> &'static str {
    match m {
        Metric::Cosine => "cosine",
        Metric::Log => "log",
        Metric::Relative => "relative",
        Metric::Largest => "largest",
    }
}

/// How the fits were made.
#[must_use]
pub fn settings(options: &Options, selection: &Selection) -> Value {
    json!({
        "metric": metric(options.metric), "epsilon_per_sr": options.epsilon,
        "weights": if selection.weighting == Weighting::Equal { "equal" } else { "solid-angle" },
        "max_theta_deg": selection.max_theta_deg,
        "bands": selection.bands.as_ref().map(|b| b.iter().map(|b| b + 1).collect::<Vec<_>>()),
        "shared": options.scope.shared, "per_band": options.scope.per_band,
        "starts": options.starts, "subsample": options.places,
        "standard_error": "s^2 (J'WJ)^-1, s^2 = sum w r^2/(N - k): independent residuals of variance proportional to 1/w",
        "robust_standard_error": "White's HC1: independent residuals of any variance",
    })
}

/// Number of the best fit: by AICc where that is known, else by the measure that was minimised.
#[must_use]
pub fn best(answer: &Answer<'_>) -> usize {
    let measure = |f: &Fit| match answer.options.metric {
        Metric::Cosine => f.measures.cosine_rms,
        Metric::Log => f.measures.log_rms,
        Metric::Relative => f.measures.relative_rms,
        Metric::Largest => f.measures.largest,
    };
    let least = || {
        (0..answer.fits.len())
            .min_by(|a, b| measure(&answer.fits[*a]).total_cmp(&measure(&answer.fits[*b])))
            .unwrap_or(0)
    };
    answer.comparison.map_or_else(least, |c| c.ranked[0].fit)
}

fn band(samples: &Samples, e: &Estimate) -> Option<Value> {
    e.band.map(|b| match &samples.channels()[b] {
        Channel::Wavelength(nm) => json!({"wavelength_nm": nm}),
        Channel::Named(n) => json!({"channel": n}),
    })
}

pub(super) fn label(samples: &Samples, fit: &Fit, e: &Estimate) -> String {
    e.band.map_or_else(|| fit.name_of(e), |b| format!("{} [{}]", fit.name_of(e), samples.channels()[b]))
}

fn parameter(samples: &Samples, fit: &Fit, e: &Estimate) -> Value {
    let open = &fit.template.open()[e.open].parameter;
    let (standard, robust, state) = match e.uncertainty {
        Uncertainty::Known { standard, robust } => (Some(standard), Some(robust), "free"),
        Uncertainty::AtLow => (None, None, "at lower bound"),
        Uncertainty::AtHigh => (None, None, "at upper bound"),
        Uncertainty::Inseparable => (None, None, "inseparable"),
        Uncertainty::Undefined => (None, None, "undefined"),
    };
    let mut out = Map::new();
    out.insert("name".to_owned(), fit.name_of(e).into());
    if let Some(Value::Object(of)) = band(samples, e) {
        out.extend(of);
    }
    if !open.unit.is_empty() {
        out.insert("unit".to_owned(), open.unit.into());
    }
    out.insert("value".to_owned(), e.value.into());
    out.insert("standard_error".to_owned(), standard.into());
    out.insert("robust_standard_error".to_owned(), robust.into());
    out.insert("state".to_owned(), state.into());
    out.into()
}

fn measures(fit: &Fit, samples: &Samples) -> Value {
    let m = &fit.measures;
    let (i, o) = m.largest_at;
    let turned = (phi(o) - phi(i)).to_degrees().rem_euclid(360.0);
    json!({
        "cosine_rms_per_sr": m.cosine_rms, "log_rms": m.log_rms, "relative_rms": m.relative_rms,
        "largest_per_sr": m.largest,
        "largest_at_deg": {
            "theta_i": theta(i).to_degrees(), "theta_o": theta(o).to_degrees(), "phi": turned,
            "band": samples.channels()[m.largest_band].to_string(),
        },
    })
}

/// One result: a table, its fits and their comparison.
#[must_use]
pub fn object(answer: &Answer<'_>) -> Map<String, Value> {
    let samples = answer.samples;
    let fits = answer.fits.iter().map(|f| {
        json!({
            "model": f.template.to_string(), "material": f.material.to_string(),
            "parameters": f.estimates.iter().map(|e| parameter(samples, f, e)).collect::<Vec<_>>(),
            "correlations": f.correlations, "condition": f.condition,
            "measures": measures(f, samples),
            "aic": f.criteria.map(|c| c.aic), "aicc": f.criteria.and_then(|c| c.aicc), "bic": f.criteria.map(|c| c.bic),
            "values": f.values, "places": f.places,
            "starts": {"tried": f.starts.0, "reached_best": f.starts.1}, "converged": f.converged,
        })
    });
    let mut out = Map::new();
    out.insert("path".to_owned(), answer.path.into());
    out.insert("places".to_owned(), samples.places().into());
    out.insert("places_used".to_owned(), samples.len().into());
    let channels: Vec<String> = samples.channels().iter().map(Channel::to_string).collect();
    out.insert("bands".to_owned(), channels.into());
    out.insert("fits".to_owned(), fits.collect::<Vec<_>>().into());
    out.insert("best".to_owned(), answer.fits[best(answer)].template.to_string().into());
    if let Some(c) = answer.comparison {
        let ranked = c.ranked.iter().map(|r| {
            json!({"model": answer.fits[r.fit].template.to_string(), "delta_aicc": r.delta_aicc, "delta_bic": r.delta_bic, "akaike_weight": r.weight})
        });
        out.insert("comparison".to_owned(), ranked.collect::<Vec<_>>().into());
    }
    out
}

/// Headers of the table of fits.
pub const COLUMNS: [&str; 14] = [
    "path",
    "model",
    "material",
    "free_parameters",
    "values",
    "cosine_rms_per_sr",
    "log_rms",
    "relative_rms",
    "largest_per_sr",
    "aic",
    "aicc",
    "bic",
    "delta_aicc",
    "converged",
];

/// The fits as rows of cells.
#[must_use]
pub fn rows(answer: &Answer<'_>) -> Vec<[String; 14]> {
    let cell = |v: Option<f64>| v.map_or(String::new(), |v| v.to_string());
    let row = |(i, f): (usize, &Fit)| {
        let delta = answer.comparison.and_then(|c| c.ranked.iter().find(|r| r.fit == i)).map(|r| r.delta_aicc);
        let m = &f.measures;
        [
            answer.path.to_owned(),
            f.template.to_string(),
            f.material.to_string(),
            f.estimates.len().to_string(),
            f.values.to_string(),
            m.cosine_rms.to_string(),
            m.log_rms.to_string(),
            m.relative_rms.to_string(),
            m.largest.to_string(),
            cell(f.criteria.map(|c| c.aic)),
            cell(f.criteria.and_then(|c| c.aicc)),
            cell(f.criteria.map(|c| c.bic)),
            cell(delta),
            f.converged.to_string(),
        ]
    };
    answer.fits.iter().enumerate().map(row).collect()
}

/// What is to be known of the fits.
#[must_use]
pub fn findings(samples: &Samples, fits: &[Fit], comparison: Option<&Comparison>, options: &Options) -> Vec<Finding> {
    let mut out = Vec::new();
    for f in fits {
        let model = &f.template;
        let list = |wanted: &dyn Fn(&Estimate) -> bool| {
            let labels: Vec<String> = f.estimates.iter().filter(|e| wanted(e)).map(|e| label(samples, f, e)).collect();
            labels.join(", ")
        };
        let bound = list(&|e| matches!(e.uncertainty, Uncertainty::AtLow | Uncertainty::AtHigh));
        if !bound.is_empty() {
            let message = format!("{model}: {bound} at the end of the range, without a standard error");
            out.push(
                Finding::warning("B201", message)
                    .hint("the data ask for a value beyond it, or do not need the parameter"),
            );
        }
        if !f.inseparable.is_empty() {
            let names = list(&|e| e.uncertainty == Uncertainty::Inseparable);
            let message = format!("{model}: the data do not tell {names} apart; their values are one choice of many");
            out.push(Finding::warning("B202", message).hint("give one of them a value"));
        }
        for (r, row) in f.correlations.iter().enumerate() {
            for (c, correlation) in row.iter().enumerate().take(r) {
                if let Some(rho) = correlation.filter(|rho| rho.abs() > STRONG) {
                    let pair = [c, r].map(|i| label(samples, f, &f.estimates[i])).join(" and ");
                    out.push(Finding::info(
                        "B203",
                        format!("{model}: {pair} are correlated by {}", significant(rho, 4)),
                    ));
                }
            }
        }
        if !f.converged {
            let message = format!("{model}: the minimisation had not come to rest at its last step");
            out.push(Finding::warning("B204", message).hint("start values such as `alpha=?0.1` may help"));
        }
        if f.starts.1 < f.starts.0 {
            let message = format!("{model}: {} of {} starts came to the least sum of squares", f.starts.1, f.starts.0);
            let alone = f.starts.1 == 1 && f.starts.0 > 2;
            let finding = if alone { Finding::warning("B205", message) } else { Finding::info("B205", message) };
            out.push(if alone { finding.hint("more --starts may find a lower one") } else { finding });
        }
    }
    if let Some(c) = comparison.filter(|c| !c.as_good.is_empty()) {
        let best = &fits[c.ranked[0].fit].template;
        let others: Vec<String> = c.as_good.iter().map(|i| fits[*i].template.to_string()).collect();
        let message = format!("{best} cannot be told from {}: AICc within {TOO_CLOSE}", others.join(", "));
        out.push(Finding::warning("B206", message));
    }
    let negative = samples.negative();
    if negative > 0 && options.metric == Metric::Log {
        let message = format!("{negative} negative values count as 0 in the logarithm");
        out.push(Finding::info("B207", message));
    }
    out
}

/// The fits for people.
#[must_use]
pub fn text(answer: &Answer<'_>) -> String {
    let (samples, options) = (answer.samples, answer.options);
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "{}: {} of {} places, {}, minimised: {}",
        answer.path,
        samples.len(),
        samples.places(),
        match samples.channels().len() {
            1 => "1 band".to_owned(),
            n => format!("{n} bands"),
        },
        metric(options.metric)
    );
    for f in answer.fits {
        let _ = writeln!(out, "  {}", f.template);
        let width = f.estimates.iter().map(|e| label(samples, f, e).chars().count()).max().unwrap_or(0).max(9);
        let _ = writeln!(out, "    {:width$}  {:>13}  {:>12}  {:>12}", "parameter", "value", "std. error", "robust");
        for e in &f.estimates {
            let (standard, robust) = match e.uncertainty {
                Uncertainty::Known { standard, robust } => (significant(standard, 3), significant(robust, 3)),
                Uncertainty::AtLow => ("lower bound".to_owned(), String::new()),
                Uncertainty::AtHigh => ("upper bound".to_owned(), String::new()),
                Uncertainty::Inseparable => ("inseparable".to_owned(), String::new()),
                Uncertainty::Undefined => ("–".to_owned(), String::new()),
            };
            let (label, value) = (label(samples, f, e), significant(e.value, DIGITS));
            let line = format!("    {label:width$}  {value:>13}  {standard:>12}  {robust:>12}");
            let _ = writeln!(out, "{}", line.trim_end());
        }
        let m = &f.measures;
        let [cosine, log, relative, largest] =
            [m.cosine_rms, m.log_rms, m.relative_rms, m.largest].map(|v| significant(v, 4));
        let (i, o) = m.largest_at;
        let [ti, to] = [i, o].map(|d| significant(theta(d).to_degrees(), 3));
        let _ = writeln!(out, "    cosine RMS {cosine} /sr, log RMS {log}, relative RMS {relative}");
        let _ = writeln!(out, "    largest difference times cosine {largest} /sr at θi {ti}°, θo {to}°");
        let _ = writeln!(out, "    fitted to {} values; {} of {} starts came to it", f.values, f.starts.1, f.starts.0);
    }
    if let Some(c) = answer.comparison {
        let _ = writeln!(out, "  comparison       ΔAICc          ΔBIC    weight  model");
        for r in &c.ranked {
            let (aicc, bic) = (significant(r.delta_aicc, 4), significant(r.delta_bic, 4));
            let weight = significant(r.weight, 3);
            let _ = writeln!(out, "  {aicc:>20}  {bic:>12}  {weight:>8}  {}", answer.fits[r.fit].template);
        }
    }
    out
}

/// A fit as a material file.
#[must_use]
pub fn material_file(path: &str, fit: &Fit, options: &Options) -> String {
    // A path with a line break must not leave its comment.
    let path = path.replace(char::is_control, " ");
    format!(
        "# {} fitted to {path} ({}), cosine RMS {} /sr\nmaterial = \"{}\"\n",
        fit.template,
        metric(options.metric),
        significant(fit.measures.cosine_rms, 4),
        fit.material
    )
}

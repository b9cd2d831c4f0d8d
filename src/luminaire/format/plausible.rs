//! What every reader asks of a luminaire once it is read: does it shine, and as much as the file declares?
//!
//! | code | severity | meaning |
//! |---|---|---|
//! | L101 | info | the text is not UTF-8 and was read as Windows-1252 |
//! | L110 | warning, error | negative intensities were kept; error where the flux itself is negative |
//! | L111 | error | all intensities are zero, or the table spans no solid angle: there is no flux |
//! | L112 | info, warning | the integrated flux is not the declared one (1 %, 5 %) |
//! | L113 | warning | more flux leaves the luminaire than its lamps give |
//! | L114 | info, warning | planes disagree at the pole, where they meet in one direction (1 %, 5 % of the peak) |
//! | L115 | info, warning | the light output ratio is not the declared one (1 %, 5 %) |
//! | L116 | info, warning | the downward fraction is not the declared one (1 %, 5 %) |

use crate::finding::{Finding, Severity};
use crate::luminaire::{Kind, Luminaire, System, zonal};

/// Findings about a luminaire of any format.
#[must_use]
pub fn check(luminaire: &Luminaire) -> Vec<Finding> {
    let mut findings = Vec::new();
    let distribution = &luminaire.distribution;
    let (unit, flux_unit) = units(luminaire.kind);
    let values = distribution.values();
    let (low, high) = values.iter().fold((0.0_f64, 0.0_f64), |(l, h), v| (l.min(*v), h.max(*v)));
    if low == 0.0 && high == 0.0 {
        findings.push(Finding::error("L111", "all intensities are zero: there is nothing to calculate with"));
        return findings;
    }
    let flux = distribution.total_flux();
    if flux == 0.0 && low == 0.0 {
        let message =
            "the table spans no solid angle, so that its intensities make no flux: there is nothing to calculate with";
        findings.push(Finding::error("L111", message).hint("a table needs two angles or more between the poles"));
        return findings;
    }
    if low < 0.0 {
        let count = values.iter().filter(|v| **v < 0.0).count();
        let severity = if flux <= 0.0 { Severity::Error } else { Severity::Warning };
        let message = format!("{count} of {} intensities are negative, the lowest {low} {unit}; kept", values.len());
        findings.push(Finding::new("L110", severity, message));
    }
    if let Some(declared) = luminaire.declared_flux.filter(|f| *f > 0.0) {
        let message = |percent: f64| {
            format!(
                "the intensities integrate to {} {flux_unit}, {percent:+.1} % from the {} {flux_unit} declared",
                rounded(flux),
                rounded(declared)
            )
        };
        findings.extend(graded("L112", flux / declared - 1.0, message));
    }
    if let Some(lamps) = zonal::lamp_flux_lm(luminaire).filter(|_| luminaire.kind == Kind::Luminous) {
        let ratio = flux / lamps;
        if ratio > 1.005 {
            let message = format!(
                "the luminaire gives {} lm and its lamps {} lm: a light output ratio of {:.1} %",
                rounded(flux),
                rounded(lamps),
                ratio * 100.0
            );
            findings.push(Finding::warning("L113", message));
        }
        if let (Some(declared), None) = (luminaire.declared_output_ratio, luminaire.declared_flux) {
            let message = |_| {
                format!(
                    "the intensities make a light output ratio of {:.1} %; {:.1} % declared",
                    ratio * 100.0,
                    declared * 100.0
                )
            };
            findings.extend(graded("L115", ratio - declared, message));
        }
    }
    if distribution.system() == System::TypeC {
        if let Some(declared) = luminaire.declared_downward_fraction.filter(|_| flux > 0.0) {
            let down = distribution.flux_between(0.0, 90.0) / flux;
            let message =
                |_| format!("{:.1} % of the flux goes downwards; {:.1} % declared", down * 100.0, declared * 100.0);
            findings.extend(graded("L116", down - declared, message));
        }
        findings.extend(pole(luminaire, 0.0, 0, high));
        findings.extend(pole(luminaire, 180.0, distribution.vertical_deg().len() - 1, high));
    }
    findings
}

fn units(kind: Kind) -> (&'static str, &'static str) {
    match kind {
        Kind::Luminous => ("cd", "lm"),
        Kind::Radiant => ("W/sr", "W"),
        Kind::Photon => ("µmol/(s·sr)", "µmol/s"),
    }
}

/// Nothing below 1 %, a finding of severity info to 5 %, a warning above.
fn graded(code: &'static str, deviation: f64, message: impl Fn(f64) -> String) -> Option<Finding> {
    let severity = if deviation.abs() > 0.05 { Severity::Warning } else { Severity::Info };
    (deviation.abs() > 0.01).then(|| Finding::new(code, severity, message(deviation * 100.0)))
}

/// Four significant digits and all before the point.
fn rounded(value: f64) -> f64 {
    let digits = if value == 0.0 { 0 } else { (4 - value.abs().log10().floor() as i32).clamp(0, 300) };
    let scale = 10_f64.powi(digits);
    (value * scale).round() / scale
}

/// All planes of a Type C table meet at nadir and zenith: their values there are one and the same intensity.
fn pole(luminaire: &Luminaire, at_deg: f64, row: usize, peak: f64) -> Option<Finding> {
    let distribution = &luminaire.distribution;
    let planes = distribution.horizontal_deg().len();
    if planes < 2 || (distribution.vertical_deg()[row] - at_deg).abs() > 1e-6 || peak <= 0.0 {
        return None;
    }
    let values = (0..planes).map(|p| distribution.plane(p)[row]);
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let (unit, _) = units(luminaire.kind);
    graded("L114", (high - low) / peak, |_| {
        format!("the planes meet at γ {at_deg}° in one direction, but give {low} to {high} {unit} there")
    })
}

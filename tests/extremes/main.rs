//! The ends of what each module can meet: the smallest, the largest, the emptiest, the steepest, the most degenerate; a file per module. Every
//! expectation is derived: from the SI, from a standard's printed digits, from a closed form beside the assertion, or from one that was
//! evaluated with 50 digits (mpmath).

mod brdfs;
mod capture;
mod colorimetry;
mod images;
mod luminaires;
mod photometry;
mod renderer;
mod spectra;

use std::sync::Arc;

use photopic::conversion::{Conversion, Converter, Settings};
use photopic::finding::{Checked, Finding};
use photopic::report::conversion;
use photopic::spectrum::integrate::{Contract, Rule};
use photopic::spectrum::{Grid, Quantity, Spectrum};
use photopic::tables;
use serde_json::{Map, Value};

/// CIE 018:2019.
pub const K_M: f64 = 683.002;

/// Converts under the default settings.
pub fn convert(quantity: Quantity, spectrum: &Spectrum) -> Checked<Conversion> {
    convert_with(Settings::default(), quantity, spectrum)
}

pub fn convert_with(settings: Settings, quantity: Quantity, spectrum: &Spectrum) -> Checked<Conversion> {
    Converter::new(settings).convert("test", quantity, spectrum).expect("converts")
}

pub fn rule(rule: Rule) -> Settings {
    Settings { contract: Contract { rule: Some(rule), range_nm: None }, ..Settings::default() }
}

pub fn density(wavelengths: Vec<f64>, values: Vec<f64>) -> Spectrum {
    Spectrum::density(Arc::new(Grid::new(wavelengths).expect("ascending")), values).expect("finite")
}

/// A density sampled from a function, from `first` to `last` by `step`.
pub fn sampled(first: f64, last: f64, step: f64, f: impl Fn(f64) -> f64) -> Spectrum {
    let count = ((last - first) / step).round() as usize + 1;
    let grid = Grid::uniform(first, step, count).expect("ascending");
    let values = grid.wavelengths_nm().iter().map(|&w| f(w)).collect();
    Spectrum::density(grid, values).expect("finite")
}

/// V(λ) as the CIE tabulates it: 0 where it does not, a straight line between its entries.
pub fn v(wavelength: f64) -> f64 {
    let table = tables::get("cie-1924-v").expect("embedded");
    let (x, y) = (table.wavelengths_nm(), table.column("V").expect("its column"));
    if wavelength < x[0] || wavelength > x[x.len() - 1] {
        return 0.0;
    }
    let i = x.partition_point(|w| *w <= wavelength).clamp(1, x.len() - 1);
    y[i - 1] + (y[i] - y[i - 1]) * (wavelength - x[i - 1]) / (x[i] - x[i - 1])
}

/// ∫ f V dλ over 360–830 nm, f smooth: Gauss-Legendre with three points on each tenth of a nanometre, V straight on each.
pub fn luminous_integral(f: impl Fn(f64) -> f64) -> f64 {
    let node = 0.6_f64.sqrt();
    (0..4700)
        .map(|i| {
            let middle = 360.0 + 0.1 * f64::from(i) + 0.05;
            let g = |w: f64| f(w) * v(w);
            0.05 / 9.0 * (5.0 * g(middle - 0.05 * node) + 8.0 * g(middle) + 5.0 * g(middle + 0.05 * node))
        })
        .sum()
}

#[track_caller]
pub fn close(got: f64, want: f64, relative: f64, what: &str) {
    assert!((got - want).abs() <= relative * want.abs(), "{what}: {got:e} for {want:e} within {relative:e}");
}

/// The luminous value of the quantity measured, lm, lx ….
pub fn photopic(c: &Conversion) -> f64 {
    c.absolute.first().expect("an absolute quantity").photopic
}

pub fn has(findings: &[Finding], code: &str) -> bool {
    findings.iter().any(|f| f.code == code)
}

/// Nulls that one test each asks about, so that it fails alone: `unsaid` in `spectra/degenerate.rs` and `spectra/scale.rs`, and the step of an
/// irregular grid in `tests/cli.rs`.
const ASKED_ELSEWHERE: [&str; 6] =
    [".der", ".efficacy_w_per_lm", "umol_per_j", "par_umol_per_par_j", "integration.step_nm", "photon.total_photons"];

/// The result as the user sees it. Asserts that nothing in it went out of range behind the user's back (JSON has null for NaN
/// and infinity): each null has a finding of a code that speaks of it.
#[track_caller]
pub fn sound_json(converted: &Checked<Conversion>, what: &str) -> Map<String, Value> {
    let result = conversion::json(&converted.value, &Settings::default());
    for (key, value) in &result {
        check(value, key, &converted.findings, what);
    }
    result
}

#[track_caller]
fn check(value: &Value, path: &str, findings: &[Finding], what: &str) {
    match value {
        Value::Null if ASKED_ELSEWHERE.iter().any(|p| path.contains(p)) => {}
        Value::Null => {
            let codes = codes_for(path);
            let codes_met: Vec<&str> = findings.iter().map(|f| f.code).collect();
            assert!(
                codes.iter().any(|c| has(findings, c)),
                "{what}: {path} is null without {codes:?}, only {codes_met:?}"
            );
        }
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, v)| check(v, &format!("{path}.{i}"), findings, what));
        }
        Value::Object(map) => map.iter().for_each(|(k, v)| check(v, &format!("{path}.{k}"), findings, what)),
        _ => {}
    }
}

/// The findings that explain a null at a path. P005: no luminous content; P011: beyond the range of a double.
fn codes_for(path: &str) -> &'static [&'static str] {
    match path.split('.').next().unwrap_or(path) {
        "cct_k" | "duv" => &["C001", "P005", "P011"],
        "dominant_wavelength_nm" | "excitation_purity" => &["C005", "P005", "P011"],
        "cri_ra" | "cri_r" => &["C002", "P005", "P011"],
        "tm30_rf" | "tm30_rg" | "tm30_bins" => &["C004", "P005", "P011"],
        "fwhm_nm" | "peak_wavelength_nm" | "centroid_wavelength_nm" => &["P009", "P005", "P011"],
        _ => &["P005", "P011"],
    }
}

//! Values from 1e-300 to 1e300: what is a ratio does not move, what is an amount moves with the values.

use std::path::Path;

use photopic::spectrum::format::{self, ReadOptions};
use photopic::spectrum::integrate::Rule;
use photopic::spectrum::{Grid, Quantity, Spectrum};
use serde_json::Value;

use crate::{convert, convert_with, density, has, photopic, rule, sampled, sound_json};

fn office_led() -> Spectrum {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/spectra/office-led.csv");
    let bytes = std::fs::read(path).expect("the example");
    let file = format::read(&bytes, &ReadOptions::default()).expect("readable").value;
    file.entries[0].resolve(None, None).expect("absolute").value.spectrum
}

/// Keys whose values are ratios.
const RATIOS: [&str; 16] = [
    "luminous_efficacy_of_radiation_lm_per_w",
    "scotopic_photopic_ratio",
    "chromaticity_xy",
    "chromaticity_uv_prime",
    "cct_k",
    "duv",
    "dominant_wavelength_nm",
    "excitation_purity",
    "peak_wavelength_nm",
    "centroid_wavelength_nm",
    "fwhm_nm",
    "cri_ra",
    "cri_r",
    "tm30_rf",
    "tm30_rg",
    "tm30_bins",
];

/// Compares all numbers below two values.
fn same(a: &Value, b: &Value, path: &str, compared: &mut usize) {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().expect("finite"), b.as_f64().expect("finite"));
            // Duv is a difference of numbers near 0.3, hue shifts of numbers near 1: to 1e-12 of those.
            assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{path}: {a} {b}");
            *compared += 1;
        }
        (Value::Array(x), Value::Array(y)) => {
            assert_eq!(x.len(), y.len(), "{path}");
            x.iter().zip(y).enumerate().for_each(|(i, (a, b))| same(a, b, &format!("{path}.{i}"), compared));
        }
        (Value::Object(x), Value::Object(y)) => {
            assert_eq!(x.len(), y.len(), "{path}");
            x.iter().for_each(|(k, a)| same(a, &y[k], &format!("{path}.{k}"), compared));
        }
        _ => assert_eq!(a, b, "{path}"),
    }
}

#[test]
fn ratios_do_not_depend_on_the_scale_of_the_values() {
    let spectrum = office_led();
    let one = convert(Quantity::Irradiance, &spectrum);
    let want = sound_json(&one, "unscaled");
    let exponents = (-30..=30).step_by(3).chain([-300, -290, -200, -100, 100, 200, 290, 300]);
    for exponent in exponents {
        let factor = 10f64.powi(exponent);
        let scaled = spectrum.map(|_, v| v * factor).expect("finite");
        let got = convert(Quantity::Irradiance, &scaled);
        let what = format!("1e{exponent}");
        let result = sound_json(&got, &what);
        let mut compared = 0;
        for key in RATIOS {
            same(&result[key], &want[key], &format!("{what}: {key}"), &mut compared);
        }
        for receptor in ["s_cone_opic", "m_cone_opic", "l_cone_opic", "rhodopic", "melanopic"] {
            for key in ["der", "efficacy_w_per_lm"] {
                same(&result["alpha_opic"][receptor][key], &want["alpha_opic"][receptor][key], &what, &mut compared);
            }
        }
        for key in ["umol_per_j", "par_umol_per_par_j"] {
            same(&result["photon"][key], &want["photon"][key], &what, &mut compared);
        }
        same(&result["rgb"], &want["rgb"], &format!("{what}: rgb"), &mut compared);
        same(&result["integration"], &want["integration"], &format!("{what}: integration"), &mut compared);
        assert!(compared > 150, "{what}: {compared} numbers compared");
        // Photons are counted in the 1e18 per joule: their number alone leaves the range of a double, which is said.
        let codes = |findings: &[photopic::finding::Finding]| {
            findings.iter().map(|f| f.code).filter(|c| *c != "P011").collect::<Vec<_>>()
        };
        assert!(exponent > 280 || !has(&got.findings, "P011"), "{what}: {:?}", got.findings);
        assert_eq!(codes(&got.findings), codes(&one.findings), "{what}");
        // Amounts move with the values; factors of ten are rounded by half a unit in the last place, sums by a few.
        let amounts = |c: &photopic::conversion::Conversion| {
            let f = &c.absolute[0];
            let photons = c.photons.expect("asked for");
            vec![
                f.photopic,
                f.scotopic,
                f.radiometric,
                c.xyz.expect("light")[0],
                photons.par_umol,
                c.alpha_opic[4].radiometric,
                c.hazard[0].weighted,
            ]
        };
        for (a, b) in amounts(&got.value).into_iter().zip(amounts(&one.value)) {
            assert!((a / factor / b - 1.0).abs() < 1e-12, "{what}: {a:e} {b:e}");
        }
    }
}

#[test]
fn in_a_relative_spectrum_the_scale_means_nothing() {
    let spectrum = office_led();
    let want = sound_json(&convert(Quantity::Relative, &spectrum), "unscaled");
    for exponent in [-300, -30, 30, 300] {
        let scaled = spectrum.map(|_, v| v * 10f64.powi(exponent)).expect("finite");
        let got = sound_json(&convert(Quantity::Relative, &scaled), "scaled");
        let mut compared = 0;
        for key in RATIOS.iter().chain(&["xyz", "rgb"]) {
            same(&got[*key], &want[*key], &format!("1e{exponent}: {key}"), &mut compared);
        }
    }
}

#[test]
fn sums_beyond_the_largest_double_are_an_error_and_not_a_number() {
    for value in [1e306, f64::MAX] {
        let got = convert(Quantity::Irradiance, &sampled(380.0, 780.0, 1.0, |_| value));
        sound_json(&got, &format!("{value:e}"));
        assert!(has(&got.findings, "P011"), "{value:e}: {:?}", got.findings);
    }
}

#[test]
fn values_below_the_smallest_normal_double_give_no_nonsense() {
    for value in [1e-310, 5e-324] {
        let got = convert(Quantity::Irradiance, &sampled(380.0, 780.0, 1.0, |_| value));
        sound_json(&got, &format!("{value:e}"));
        if let Some(xy) = got.value.xy {
            // Equal energy: one third each, as far as the digits that are left go.
            assert!(xy.iter().all(|v| v.is_finite() && (0.2..0.5).contains(v)), "{value:e}: {xy:?}");
        }
    }
}

#[test]
fn one_huge_sample_among_small_ones_is_its_line() {
    // 1e30 at 600 nm beside ones, summed: V(600) = 0.631 (CIE 018:2019) up to 1e-28.
    let spectrum = density(
        (0..=40).map(|i| 400.0 + 10.0 * f64::from(i)).collect(),
        (0..=40).map(|i| if i == 20 { 1e30 } else { 1.0 }).collect(),
    );
    let got = convert_with(rule(Rule::Summation), Quantity::Flux, &spectrum);
    sound_json(&got, "a spike");
    assert!((photopic(&got.value) / (683.002 * 10.0 * 0.631 * 1e30) - 1.0).abs() < 1e-14);
}

#[test]
fn a_line_of_any_size_keeps_its_efficacy() {
    for exponent in [-307, -300, -30, 0, 30, 300, 305] {
        let line =
            Spectrum::lines(Grid::new(vec![555.0]).expect("positive"), vec![10f64.powi(exponent)]).expect("finite");
        let got = convert(Quantity::Flux, &line);
        sound_json(&got, &format!("1e{exponent}"));
        assert!((got.value.efficacy_lm_per_w.expect("light") / 683.002 - 1.0).abs() < 1e-14, "1e{exponent}");
    }
}

#[test]
fn unsaid_photon_numbers_beyond_the_largest_double_are_an_error() {
    // 1e300 W at 555 nm are 2.8e318 photons per second.
    let line = Spectrum::lines(Grid::new(vec![555.0]).expect("positive"), vec![1e300]).expect("finite");
    let got = convert(Quantity::Flux, &line);
    assert!(sound_json(&got, "1e300 W")["photon"]["total_photons_per_s"].is_null());
    assert!(has(&got.findings, "P011"), "null without a word: {:?}", got.findings);
}

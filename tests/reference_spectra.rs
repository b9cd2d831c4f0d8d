//! Agreement with `../shared/spectra/reference.csv`: an independent numpy program on the native grid (`np_*` columns, twelve
//! printed digits), colour-science 0.4.7 (`co_*`) and luxpy 1.12.5 (`lx_*`). Skipped where the folder is absent.

mod common;

use std::collections::HashMap;

use photopic::conversion::{Conversion, Converter, Resampling, Settings};
use photopic::spectrum::Quantity;
use photopic::spectrum::integrate::{Contract, Rule};
use photopic::spectrum::resample::{Extrapolation, Interpolation};

type Row = HashMap<String, String>;

/// Twelve printed digits: half a unit of the last is 5e-12 relative at worst.
const PRINTED: f64 = 5e-12;

fn cases(settings: Settings) -> Option<Vec<(Row, Conversion)>> {
    let spectra = common::reference_spectra()?;
    let rows = common::rows(&common::shared("spectra/reference.csv")?);
    let converter = Converter::new(settings);
    Some(
        rows.into_iter()
            .map(|row| {
                let (name, spectrum) =
                    spectra.iter().find(|(n, _)| *n == row["name"]).expect("every row has a spectrum");
                let got = converter.convert(name, Quantity::Relative, spectrum).expect("converts");
                (row, got.value)
            })
            .collect(),
    )
}

fn cell(row: &Row, key: &str) -> Option<f64> {
    row[key].parse::<f64>().ok().filter(|v| v.is_finite())
}

/// Largest relative difference of a figure over all rows that have it; at least one must.
fn worst(cases: &[(Row, Conversion)], key: &str, ours: impl Fn(&Conversion) -> Option<f64>) -> f64 {
    let mut worst = (0.0_f64, String::new());
    let mut compared = 0;
    for (row, got) in cases {
        let (Some(want), Some(got)) = (cell(row, key), ours(got)) else { continue };
        compared += 1;
        let difference = if want == 0.0 { got.abs() } else { (got / want - 1.0).abs() };
        if difference.is_nan() || difference > worst.0 {
            worst = (difference, row["name"].clone());
        }
    }
    assert!(compared > 5, "{key}: only {compared} rows compared");
    println!("{key}: {:.2e} at {} ({compared} rows)", worst.0, worst.1);
    worst.0
}

fn der(receptor: &'static str) -> impl Fn(&Conversion) -> Option<f64> {
    move |c| c.alpha_opic.iter().find(|a| a.receptor == receptor).and_then(|a| a.der)
}

#[test]
fn native_grid_figures_agree_to_the_printed_digits() {
    let Some(cases) = cases(Settings::default()) else { return };
    assert!(cases.len() >= 25, "the table has 25 rows");
    type Figure = Box<dyn Fn(&Conversion) -> Option<f64>>;
    let figures: [(&str, Figure); 16] = [
        ("np_LER_sum", Box::new(|c| c.efficacy_lm_per_w)),
        ("np_SP", Box::new(|c| c.scotopic_photopic_ratio)),
        ("np_X", Box::new(|c| c.xyz.map(|v| v[0]))),
        ("np_Z", Box::new(|c| c.xyz.map(|v| v[2]))),
        ("np_x", Box::new(|c| c.xy.map(|v| v[0]))),
        ("np_y", Box::new(|c| c.xy.map(|v| v[1]))),
        ("np_DER_L", Box::new(der("l_cone_opic"))),
        ("np_DER_M", Box::new(der("m_cone_opic"))),
        ("np_DER_S", Box::new(der("s_cone_opic"))),
        ("np_DER_rod", Box::new(der("rhodopic"))),
        ("np_DER_mel", Box::new(der("melanopic"))),
        ("np_PPF_umol_per_J", Box::new(|c| c.photons.and_then(|p| p.umol_per_j))),
        ("np_PPF_umol_per_J_PAR", Box::new(|c| c.photons.and_then(|p| p.par_umol_per_par_j))),
        ("np_Ra", Box::new(|c| c.cri.map(|r| r.ra))),
        ("np_R9", Box::new(|c| c.cri.map(|r| r.r[8]))),
        ("np_u", Box::new(|c| c.uv_prime.map(|v| v[0]))),
    ];
    for (key, ours) in figures {
        let tolerance = match key {
            // These hang on the CCT, which the numpy program finds to about 3e-5 K; see the next test.
            "np_Ra" | "np_R9" => 3e-8,
            _ => PRINTED,
        };
        let got = worst(&cases, key, ours);
        assert!(got <= tolerance, "{key}: {got}");
    }
}

#[test]
fn colour_rendering_agrees_to_the_printed_digits_at_the_same_temperature() {
    use photopic::colorimetry::cri;
    use photopic::constants::SecondRadiation;
    let (Some(spectra), Some(path)) = (common::reference_spectra(), common::shared("spectra/reference.csv")) else {
        return;
    };
    let mut compared = 0;
    for row in common::rows(&path) {
        let (Some(kelvin), Some(ra), Some(r9)) = (cell(&row, "np_CCT"), cell(&row, "np_Ra"), cell(&row, "np_R9"))
        else {
            continue;
        };
        let (name, spectrum) = spectra.iter().find(|(n, _)| *n == row["name"]).expect("every row has a spectrum");
        let contract = Contract::default();
        let plan =
            cri::Plan::new(spectrum.grid(), spectrum.sampling(), &contract, SecondRadiation::Its90).expect("fits");
        let got = plan.evaluate(spectrum.values(), kelvin).expect("there is light");
        // Indices are 100 less a difference: the twelve digits of their inputs are worth 5e-12 of the 100.
        assert!((got.ra - ra).abs() < 100.0 * PRINTED, "{name}: {} {ra}", got.ra);
        assert!((got.r[8] - r9).abs() < 100.0 * PRINTED, "{name}: {} {r9}", got.r[8]);
        compared += 1;
    }
    assert!(compared > 20);
}

#[test]
fn the_ten_degree_observer_agrees() {
    let settings = Settings { observer: photopic::colorimetry::Observer::Cie1964, ..Settings::default() };
    let Some(cases) = cases(settings) else { return };
    for (key, axis) in [("np_x10", 0), ("np_y10", 1)] {
        assert!(worst(&cases, key, |c| c.xy.map(|v| v[axis])) <= PRINTED, "{key}");
    }
    for (key, axis) in [("np_X10", 0), ("np_Z10", 2)] {
        assert!(worst(&cases, key, |c| c.xyz.map(|v| v[axis])) <= PRINTED, "{key}");
    }
}

#[test]
fn other_rules_ranges_and_resampling_agree() {
    let rule = |rule, range_nm| Settings { contract: Contract { rule, range_nm }, ..Settings::default() };
    let resample = |interpolation| Settings {
        resampling: Some(Resampling {
            step_nm: 1.0,
            range_nm: None,
            interpolation,
            extrapolation: Extrapolation::Refuse,
        }),
        ..Settings::default()
    };
    let clip = Some((380.0, 780.0));
    for (key, settings) in [
        ("np_LER_trapz", rule(Some(Rule::Trapezoid), None)),
        ("np_LER_sum_380_780", rule(None, clip)),
        ("np_LER_trapz_380_780", rule(Some(Rule::Trapezoid), clip)),
        ("np_LER_sum_clip360_830", rule(None, Some((360.0, 830.0)))),
        ("np_LER_lin1", resample(Interpolation::Linear)),
        ("np_LER_spr1", resample(Interpolation::Sprague)),
    ] {
        let Some(cases) = cases(settings) else { return };
        assert!(worst(&cases, key, |c| c.efficacy_lm_per_w) <= PRINTED, "{key}");
    }
}

#[test]
fn correlated_colour_temperature_agrees() {
    let Some(cases) = cases(Settings::default()) else { return };
    for (row, got) in &cases {
        let name = &row["name"];
        let (Some(kelvin), Some(duv)) = (cell(row, "np_CCT"), cell(row, "np_Duv")) else {
            assert!(
                got.cct.is_none_or(|c| c.duv.abs() > 0.04),
                "{name}: the reference gives none, we give {:?}",
                got.cct
            );
            continue;
        };
        let Some(cct) = got.cct else {
            assert!(duv.abs() > 0.05, "{name}: the reference gives {kelvin} K, Duv {duv}");
            continue;
        };
        assert!((cct.kelvin - kelvin).abs() < 1e-3, "{name}: {} {kelvin}", cct.kelvin);
        // Absolute, for a blackbody's Duv is zero to rounding.
        assert!((cct.duv - duv).abs() < 1e-9, "{name}: {} {duv}", cct.duv);
    }
}

#[test]
fn other_packages_agree_within_the_stated_differences() {
    let Some(cases) = cases(Settings::default()) else { return };
    for (row, got) in &cases {
        let name = &row["name"];
        let near = |key: &str, ours: Option<f64>, tolerance: f64| {
            if let (Some(want), Some(ours)) = (cell(row, key), ours) {
                assert!((ours - want).abs() <= tolerance, "{name}, {key}: {ours} {want}");
            }
        };
        near("co_x_E308", got.xy.map(|v| v[0]), 3e-5);
        near("co_y_E308", got.xy.map(|v| v[1]), 3e-5);
        near("lx_x", got.xy.map(|v| v[0]), 3e-5);
        near("lx_y", got.xy.map(|v| v[1]), 3e-5);
        if name.starts_with("MONO") {
            continue;
        }
        near("co_CCT_ohno2013", got.cct.map(|c| c.kelvin), 0.25);
        near("co_Ra", got.cri.map(|r| r.ra), 0.2);
        near("co_R9", got.cri.map(|r| r.r[8]), 0.35);
        near("lx_Ra", got.cri.map(|r| r.ra), 0.2);
        near("lx_R9", got.cri.map(|r| r.r[8]), 0.35);
        near("co_Rf", got.tm30.as_ref().map(|t| t.rf), 0.02);
        near("co_Rg", got.tm30.as_ref().and_then(|t| t.rg), 0.11);
        near("lx_Rf", got.tm30.as_ref().map(|t| t.rf), 0.02);
        near("lx_Rg", got.tm30.as_ref().and_then(|t| t.rg), 0.11);
    }
}

#[test]
fn mesopic_luminance_agrees_with_cie_191() {
    use photopic::photometry::mesopic::adaptation;
    let Some(path) = common::shared("spectra/reference_mesopic.csv") else { return };
    let rows = common::rows(&path);
    assert!(rows.len() > 20);
    for row in rows {
        let number = |key: &str| row[key].parse::<f64>().expect("a number");
        let got = adaptation(number("Lp"), number("SP")).expect("a luminance and a ratio");
        // Twelve printed digits; m is a fixed point that both programs iterate to rounding.
        assert!((got.luminance_mesopic / number("Lmes") - 1.0).abs() < 1e-11, "{row:?}: {got:?}");
        assert!((got.m - number("m")).abs() < 1e-11, "{row:?}: {got:?}");
    }
}

#[test]
fn the_whole_blackbody_has_its_efficacy() {
    use photopic::constants::SecondRadiation;
    use photopic::illuminant::{named, planck};
    let Some(path) = common::shared("spectra/reference.csv") else { return };
    let converter = Converter::new(Settings::default());
    for row in common::rows(&path) {
        let (Some(kelvin), Some(want)) = (row["name"].strip_prefix("BB"), cell(&row, "np_LER_total_bb")) else {
            continue;
        };
        let kelvin: f64 = kelvin.parse().expect("BB and a temperature");
        let source = named::source(&format!("blackbody:{kelvin}K"), SecondRadiation::Its90).expect("a blackbody");
        let got = converter.convert("", source.quantity, &source.spectrum).expect("converts").value;
        let efficacy = got.absolute[0].photopic / planck::total_radiance(kelvin, SecondRadiation::Its90);
        assert!((efficacy / want - 1.0).abs() < PRINTED, "{kelvin} K: {efficacy} {want}");
    }
}

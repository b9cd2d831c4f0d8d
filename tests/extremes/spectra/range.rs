//! Spectra that begin above or end below the tables: the bound printed with the number really bounds what is missing.

use photopic::finding::Severity;
use photopic::spectrum::integrate::Rule;
use photopic::spectrum::{Quantity, Spectrum};
use photopic::tables;

use crate::{convert, convert_with, has, photopic, rule, sampled, sound_json};

fn planck(kelvin: f64) -> impl Fn(f64) -> f64 {
    // Relative; c₂ of the ITS-90.
    move |w: f64| (560.0 / w).powi(5) / ((1.4388e7 / (w * kelvin)).exp_m1())
}

type Shape = (&'static str, Box<dyn Fn(f64) -> f64>);

fn shapes() -> Vec<Shape> {
    let d65 = tables::get("cie-illuminant-d65").expect("embedded");
    let (x, y) = (d65.wavelengths_nm(), d65.column("D65").expect("its column"));
    let bell = |centre: f64, sigma: f64| move |w: f64| (-0.5 * ((w - centre) / sigma).powi(2)).exp();
    let (blue, yellow) = (bell(450.0, 10.0), bell(570.0, 60.0));
    vec![
        ("equal energy", Box::new(|_| 1.0)),
        ("D65", Box::new(move |w| y[x.iter().position(|v| *v == w).expect("1 nm")])),
        ("2856 K", Box::new(planck(2856.0))),
        ("6500 K", Box::new(planck(6500.0))),
        ("20 000 K", Box::new(planck(20_000.0))),
        ("LED", Box::new(move |w| blue(w) + 0.6 * yellow(w))),
        ("green", Box::new(bell(530.0, 30.0))),
        ("comb", Box::new(|w| 1.0 + (w / 3.0).sin())),
    ]
}

const CUTS: [(f64, f64); 9] = [
    (380.0, 780.0),
    (400.0, 700.0),
    (361.0, 830.0),
    (360.0, 829.0),
    (450.0, 830.0),
    (360.0, 600.0),
    (500.0, 600.0),
    (550.0, 830.0),
    (360.0, 560.0),
];

#[test]
fn the_bound_covers_what_lies_beyond_for_every_shape_that_keeps_its_premise() {
    let mut held = 0;
    for (name, f) in shapes() {
        for used in [Rule::Summation, Rule::Trapezoid, Rule::Exact] {
            let full = photopic(&convert_with(rule(used), Quantity::Irradiance, &sampled(360.0, 830.0, 1.0, &f)).value);
            for (first, last) in CUTS {
                let cut = sampled(first, last, 1.0, &f);
                // The premise that the finding states: nowhere beyond is the spectrum larger than its largest sample.
                let largest = cut.peak().1;
                if (360..=830).map(f64::from).any(|w| f(w) > largest) {
                    continue;
                }
                held += 1;
                let got = convert_with(rule(used), Quantity::Irradiance, &cut);
                let what = format!("{name}, {first}–{last} nm, {used:?}");
                sound_json(&got, &what);
                let value = photopic(&got.value);
                let bound = got.value.integration.error_bound.truncation_relative.expect("light");
                assert!(
                    (full - value).abs() <= (bound + 1e-14) * value,
                    "{what}: {} > {bound}",
                    (full - value).abs() / value
                );
                assert!(bound > 0.0 && has(&got.findings, "P002"), "{what}: {:?}", got.findings);
            }
        }
    }
    assert!(held > 80, "only {held} cases keep the premise");
}

#[test]
fn for_a_constant_the_bound_is_what_is_missing_and_no_more() {
    for (first, last) in CUTS {
        let settings = || rule(Rule::Exact);
        let full =
            photopic(&convert_with(settings(), Quantity::Irradiance, &sampled(360.0, 830.0, 1.0, |_| 1.0)).value);
        let got = convert_with(settings(), Quantity::Irradiance, &sampled(first, last, 1.0, |_| 1.0)).value;
        let bound = got.integration.error_bound.truncation_relative.expect("light");
        let missing = (full - photopic(&got)) / photopic(&got);
        // `missing` is a difference of two sums of 107: 1e-15 of them.
        assert!((bound - missing).abs() <= 1e-9 * missing + 1e-14, "{first}–{last}: {bound} {missing}");
    }
}

#[test]
fn a_spectrum_over_the_whole_table_has_nothing_missing() {
    for (first, last) in [(360.0, 830.0), (350.0, 840.0), (200.0, 2500.0)] {
        let got = convert(Quantity::Irradiance, &sampled(first, last, 1.0, |_| 1.0));
        assert_eq!(got.value.integration.error_bound.truncation_relative, Some(0.0));
        assert!(!has(&got.findings, "P002"), "{:?}", got.findings);
    }
}

#[test]
fn a_bound_that_matters_is_a_warning_and_one_that_does_not_is_worth_knowing() {
    let severity = |first: f64, last: f64| {
        let got = convert(Quantity::Irradiance, &sampled(first, last, 1.0, |_| 1.0));
        got.findings.iter().find(|f| f.code == "P002").map(|f| f.severity)
    };
    // Σ V beyond 380–780 nm is some 6e-6 of the whole, beyond 450–650 nm some 6 %.
    assert_eq!(severity(380.0, 780.0), Some(Severity::Info));
    assert_eq!(severity(450.0, 650.0), Some(Severity::Warning));
    assert_eq!(severity(360.0, 830.0), None);
}

#[test]
fn a_spectrum_wholly_beyond_the_table_has_no_luminous_content() {
    for (first, last) in [(100.0, 300.0), (200.0, 359.0), (831.0, 1100.0), (900.0, 2500.0)] {
        let spectrum: Spectrum = sampled(first, last, 1.0, |_| 1.0);
        let got = convert(Quantity::Irradiance, &spectrum);
        sound_json(&got, &format!("{first}–{last}"));
        assert!(has(&got.findings, "P005"), "{first}–{last}: {:?}", got.findings);
        assert_eq!(photopic(&got.value), 0.0);
        // Δλ Σ of ones.
        assert!((got.value.absolute[0].radiometric - (last - first + 1.0)).abs() < 1e-9);
    }
}

#[test]
fn a_spectrum_that_only_touches_the_table_is_bounded_as_widely_as_it_has_to_be() {
    // One nanometre inside: what is missing is the whole of V, and the bound must say so.
    for (first, last) in [(200.0, 361.0), (829.0, 1100.0)] {
        let got = convert_with(rule(Rule::Exact), Quantity::Irradiance, &sampled(first, last, 1.0, |_| 1.0));
        sound_json(&got, &format!("{first}–{last}"));
        let value = photopic(&got.value);
        let bound = got.value.integration.error_bound.truncation_relative.expect("some light");
        assert!(value * (1.0 + bound) >= 683.002 * 106.8569, "{value} {bound}");
    }
}

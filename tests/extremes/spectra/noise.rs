//! Negative samples: noise about zero. They are kept, counted, and their effect is told.

use photopic::finding::Finding;
use photopic::spectrum::Quantity;

use photopic::spectrum::integrate::Rule;

use crate::{K_M, close, convert, convert_with, has, photopic, rule, sampled, sound_json};

/// V(λ), CIE 018:2019, Table 1.
const V_450: f64 = 0.038;
const V_500: f64 = 0.323;
const V_550: f64 = 0.9949501;
const V_600: f64 = 0.631;
const V_650: f64 = 0.107;

fn p006(findings: &[Finding]) -> &Finding {
    findings.iter().find(|f| f.code == "P006").unwrap_or_else(|| panic!("no P006: {findings:?}"))
}

/// The share told in a P006.
fn share(finding: &Finding) -> f64 {
    let words: Vec<&str> = finding.message.split_whitespace().collect();
    let at = words.iter().position(|w| *w == "by").expect("`by` before the share");
    words[at + 1].parse().expect("a number")
}

#[test]
fn negative_samples_are_kept_counted_and_their_effect_is_told() {
    // 450 … 650 by 50 nm with the summation: K_m · 50 · (V₄₅₀ + V₅₀₀ + V₅₅₀ + V₆₀₀ − ½V₆₅₀).
    let spectrum = sampled(450.0, 650.0, 50.0, |w| if w == 650.0 { -0.5 } else { 1.0 });
    let got = convert_with(rule(Rule::Summation), Quantity::Irradiance, &spectrum);
    sound_json(&got, "noise");
    let positive = V_450 + V_500 + V_550 + V_600;
    let want = positive - 0.5 * V_650;
    close(photopic(&got.value), K_M * 50.0 * want, 1e-14, "lx");
    let finding = p006(&got.findings);
    assert!(finding.message.contains("1 of 5"), "{}", finding.message);
    // Told to three digits: half a unit of the third.
    close(share(finding), 0.5 * V_650 / want, 5e-3, "the effect");
}

#[test]
fn a_spectrum_without_negative_samples_has_no_such_finding() {
    for spectrum in [
        sampled(400.0, 700.0, 10.0, |_| 1.0),
        sampled(400.0, 700.0, 10.0, |_| 0.0),
        sampled(400.0, 700.0, 10.0, |_| -0.0),
    ] {
        assert!(!has(&convert(Quantity::Irradiance, &spectrum).findings, "P006"));
    }
}

#[test]
fn noise_about_zero_cancels_where_clipping_would_not() {
    // A constant 1 with ±1.5 in turn on top: with the mean kept the total is that of the constant, up to the odd sample.
    let spectrum = sampled(400.0, 700.0, 1.0, |w| 1.0 + if (w as i32) % 2 == 0 { 1.5 } else { -1.5 });
    let got = convert(Quantity::Irradiance, &spectrum);
    sound_json(&got, "noise");
    // 151 even and 150 odd wavelengths: Σ = 301 + 1.5.
    close(got.value.absolute[0].radiometric, 302.5, 1e-14, "W/m²");
    assert!(p006(&got.findings).message.contains("150 of 301"), "{:?}", p006(&got.findings));
}

#[test]
fn noise_that_outweighs_the_light_is_no_light() {
    for spectrum in
        [sampled(400.0, 700.0, 5.0, |_| -1.0), sampled(400.0, 700.0, 5.0, |w| if w < 500.0 { 1.0 } else { -1.0 })]
    {
        let got = convert(Quantity::Irradiance, &spectrum);
        sound_json(&got, "noise");
        assert!(has(&got.findings, "P005") && has(&got.findings, "P006"), "{:?}", got.findings);
        let c = got.value;
        assert!(photopic(&c) < 0.0, "kept as it came out");
        assert_eq!((c.efficacy_lm_per_w, c.scotopic_photopic_ratio, c.xy, c.cct), (None, None, None, None));
        assert!(c.cri.is_none() && c.tm30.is_none() && c.rgb.is_empty());
    }
}

#[test]
fn a_negative_total_beside_a_positive_luminous_content_gives_no_efficacy() {
    // Light at 555 nm, and more negative noise in the infrared than there is light.
    let spectrum = sampled(400.0, 1000.0, 5.0, |w| if w < 700.0 { 1.0 } else { -2.0 });
    let got = convert(Quantity::Irradiance, &spectrum);
    let c = &got.value;
    assert!(c.absolute[0].radiometric < 0.0 && photopic(c) > 0.0);
    assert_eq!(c.efficacy_lm_per_w, None, "a negative denominator means nothing");
    // interface.md: what could not be determined is null *with a finding that says why*.
    assert!(got.findings.iter().any(|f| f.message.contains("efficacy")), "null without a reason: {:?}", got.findings);
}

//! Nothing at all, one sample, two samples.

use photopic::spectrum::format::{self, ReadOptions};
use photopic::spectrum::integrate::Rule;
use photopic::spectrum::{Grid, Quantity, Sampling, Spectrum};

use crate::{K_M, close, convert, convert_with, density, has, photopic, rule, sampled, sound_json, v};

#[test]
fn all_zero_is_dark_and_every_ratio_is_undefined() {
    for spectrum in [
        sampled(380.0, 780.0, 5.0, |_| 0.0),
        sampled(380.0, 780.0, 5.0, |_| -0.0),
        density(vec![400.0, 410.0, 470.0], vec![0.0; 3]),
    ] {
        for quantity in [Quantity::Irradiance, Quantity::Radiance, Quantity::Relative] {
            let got = convert(quantity, &spectrum);
            let result = sound_json(&got, "darkness");
            assert!(has(&got.findings, "P005"), "{:?}", got.findings);
            let c = got.value;
            for f in &c.absolute {
                assert_eq!((f.radiometric, f.photopic, f.scotopic), (0.0, 0.0, 0.0));
            }
            assert_eq!((c.efficacy_lm_per_w, c.scotopic_photopic_ratio, c.xy, c.cct), (None, None, None, None));
            assert!(c.cri.is_none() && c.tm30.is_none() && c.peak_wavelength_nm.is_none() && c.rgb.is_empty());
            let bound = &result["integration"]["error_bound"];
            assert!(bound["photopic_relative"].is_null(), "{bound}");
        }
    }
}

#[test]
fn one_sample_in_a_file_is_a_line_and_that_is_said() {
    // V(600 nm) = 0.631 (CIE 018:2019, Table 1).
    let file = format::read(b"wavelength [nm],irradiance [W/m2/nm]\n600,3\n", &ReadOptions::default())
        .expect("readable")
        .value;
    let resolved = file.entries[0].resolve(None, None).expect("absolute");
    assert!(has(&resolved.findings, "S012"), "{:?}", resolved.findings);
    assert_eq!(resolved.value.spectrum.sampling(), Sampling::Lines);
    let got = convert(resolved.value.quantity, &resolved.value.spectrum);
    sound_json(&got, "one sample");
    close(photopic(&got.value), 3.0 * K_M * 0.631, 1e-15, "lx");
}

#[test]
fn one_sample_of_a_density_has_no_width_and_no_content() {
    let got = convert(Quantity::Irradiance, &density(vec![555.0], vec![1.0]));
    sound_json(&got, "one sample");
    assert_eq!((photopic(&got.value), got.value.absolute[0].radiometric), (0.0, 0.0));
    assert!(has(&got.findings, "P005"), "{:?}", got.findings);
}

#[test]
fn two_samples_are_a_straight_line_to_the_exact_rule() {
    // A constant over the whole table: Σ V at 1 nm is 106.856 917 101 171 9 (the CIE's data set, DOI 10.25039/CIE.DS.dktna2s3);
    // the integral of the straight lines between is that less half of both ends.
    let sum = 106.856_917_101_171_9;
    let want = sum - 0.5 * (0.000003917 + 0.00000045181);
    let got = convert_with(rule(Rule::Exact), Quantity::Flux, &density(vec![360.0, 830.0], vec![1.0, 1.0]));
    sound_json(&got, "two samples");
    close(photopic(&got.value), K_M * want, 1e-13, "lm");
    close(got.value.absolute[0].radiometric, 470.0, 1e-14, "W");
    // A ramp from 0 to 1: ∫ t V dλ by Simpson's rule on each nanometre, exact for the product of two straight lines.
    let ramp = |w: f64| (w - 360.0) / 470.0;
    let want: f64 = (360..830)
        .map(f64::from)
        .map(|a| (ramp(a) * v(a) + 4.0 * ramp(a + 0.5) * v(a + 0.5) + ramp(a + 1.0) * v(a + 1.0)) / 6.0)
        .sum();
    let got = convert_with(rule(Rule::Exact), Quantity::Flux, &density(vec![360.0, 830.0], vec![0.0, 1.0]));
    close(photopic(&got.value), K_M * want, 1e-13, "lm");
    close(got.value.absolute[0].radiometric, 235.0, 1e-14, "W");
    close(
        got.value.centroid_wavelength_nm.expect("light"),
        360.0 + 470.0 * 2.0 / 3.0,
        1e-13,
        "the centroid of a ramp is at two thirds",
    );
}

#[test]
fn two_samples_under_any_rule_are_within_the_bound_that_is_printed_with_them() {
    let truth = K_M * 106.856_914_9;
    for settings in [Default::default(), rule(Rule::Summation), rule(Rule::Trapezoid), rule(Rule::Exact)] {
        let got = convert_with(settings, Quantity::Flux, &density(vec![360.0, 830.0], vec![1.0, 1.0]));
        sound_json(&got, "two samples");
        let (value, bound) = (photopic(&got.value), got.value.integration.error_bound.step_relative.expect("light"));
        assert!((truth - value).abs() <= bound * value + 1e-6 * truth, "{value}, bound {bound}");
        // And who sees a bound of that size is told.
        assert_eq!(has(&got.findings, "P003"), bound > 0.01, "{bound}: {:?}", got.findings);
    }
}

#[test]
fn two_neighbouring_samples_in_the_last_place_are_two_samples() {
    let next = 555.0_f64.next_up();
    for spectrum in
        [density(vec![555.0, next], vec![1.0, 1.0]), density(vec![555.0, next, 600.0], vec![1.0, -1.0, 1.0])]
    {
        sound_json(&convert(Quantity::Flux, &spectrum), "neighbours");
    }
    // The width times one: (next − 555) W, nothing else.
    let got = convert_with(rule(Rule::Exact), Quantity::Flux, &density(vec![555.0, next], vec![1.0, 1.0]));
    close(got.value.absolute[0].radiometric, next - 555.0, 1e-14, "W");
    close(got.value.efficacy_lm_per_w.expect("light"), K_M, 1e-12, "K");
}

#[test]
fn unsaid_ratios_over_nothing_are_null_with_a_finding_that_says_why() {
    // Light at 830 nm only: lit, but with none in the 380–780 nm of the α-opic quantities, and none in PAR.
    let line = Spectrum::lines(Grid::new(vec![830.0]).expect("positive"), vec![1.0]).expect("finite");
    let got = convert(Quantity::Irradiance, &line);
    let result = sound_json(&got, "830 nm");
    assert!(result["alpha_opic"]["melanopic"]["der"].is_null() && result["photon"]["par_umol_per_par_j"].is_null());
    let said = |word: &str| got.findings.iter().any(|f| f.message.contains(word));
    assert!(said("α-opic"), "α-opic ratios are null without a word: {:?}", got.findings);
    assert!(said("PAR"), "PAR photons per joule of PAR are null without a word: {:?}", got.findings);
}

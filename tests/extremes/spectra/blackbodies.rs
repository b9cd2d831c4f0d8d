//! Blackbodies from 1 K to 10⁹ K: Wien's and Rayleigh and Jeans's limits in closed form, and no number out of range on the way.

use photopic::constants::SecondRadiation;
use photopic::illuminant::named;
use photopic::spectrum::Quantity;

use crate::{K_M, close, convert, has, photopic, sound_json, v};

/// c₂ of the ITS-90, m·K; c₁L = 2hc², W·m²/sr, exact SI.
const C2: f64 = 1.4388e-2;
const C1L: f64 = 2.0 * 6.626_070_15e-34 * 299_792_458.0 * 299_792_458.0;

fn source(kelvin: f64) -> named::Source {
    named::source(&format!("blackbody:{kelvin}K"), SecondRadiation::Its90).expect("a temperature")
}

/// ln of Σ exp(x).
fn ln_sum(terms: &[f64]) -> f64 {
    let largest = terms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    largest + terms.iter().map(|t| (t - largest).exp()).sum::<f64>().ln()
}

/// ln of K_m Σ V L Δλ over 360–830 nm by 1 nm, from ln L.
fn ln_luminance(ln_radiance: impl Fn(f64) -> f64) -> f64 {
    let terms: Vec<f64> = (360..=830).map(|w| v(f64::from(w)).ln() + ln_radiance(f64::from(w) * 1e-9)).collect();
    K_M.ln() + ln_sum(&terms)
}

#[test]
fn no_number_is_out_of_range_from_1_k_to_1e9_k() {
    for tenth in 0..=90 {
        let kelvin = 10f64.powf(f64::from(tenth) / 10.0);
        let source = source(kelvin);
        let got = convert(source.quantity, &source.spectrum);
        let what = format!("{kelvin} K");
        sound_json(&got, &what);
        let c = got.value;
        for f in &c.absolute {
            assert!(f.radiometric.is_finite() && f.radiometric > 0.0, "{what}: {f:?}");
            assert!(
                f.photopic.is_finite() && f.photopic > 0.0 && f.scotopic.is_finite() && f.scotopic >= 0.0,
                "{what}: {f:?}"
            );
        }
        let [x, y] = c.xy.unwrap_or_else(|| panic!("{what}: a blackbody of any temperature has a chromaticity"));
        assert!(x > 0.2 && x < 0.74 && y > 0.2 && y < 0.45, "{what}: {x} {y}");
        let [u, v] = c.uv_prime.expect("as x, y");
        assert!(u.is_finite() && v.is_finite());
        assert!(c.efficacy_lm_per_w.is_some_and(|k| k > 0.0 && k < K_M), "{what}: {:?}", c.efficacy_lm_per_w);
    }
}

#[test]
fn at_low_temperatures_luminance_is_wiens() {
    // At 400 K the smallest x = c₂/(λT) is 43: the −1 beside eˣ is below 1e-18 of it.
    for kelvin in [50.0, 77.0, 100.0, 200.0, 273.15, 400.0] {
        let source = source(kelvin);
        assert_eq!(source.quantity, Quantity::Radiance, "{kelvin} K");
        let got = photopic(&convert(source.quantity, &source.spectrum).value);
        let want = ln_luminance(|m| (C1L * 1e-9).ln() - 5.0 * m.ln() - C2 / (m * kelvin));
        // An exponent of −350 carries 350 units in the last place, here and there.
        assert!((got.ln() - want).abs() < 1e-12, "{kelvin} K: ln {} {want}", got.ln());
    }
}

#[test]
fn too_cold_for_a_double_only_the_shape_is_given_and_it_is_wiens() {
    for kelvin in [1.0, 2.0, 5.0, 10.0, 20.0] {
        let source = source(kelvin);
        assert_eq!(source.quantity, Quantity::Relative, "{kelvin} K");
        let values = source.spectrum.values();
        // Relative to 830 nm: 5 ln(830/λ) − c₂/T (1/λ − 1/830 nm), as long as a double holds it.
        for (w, got) in source.spectrum.wavelengths_nm().iter().zip(values) {
            let ln = 5.0 * (830.0 / w).ln() - C2 / kelvin * 1e9 * (1.0 / w - 1.0 / 830.0);
            if ln > -700.0 {
                // c₂/(λT) is 17 335 at 1 K: its rounding alone is 4e-12 of the exponential.
                close(*got, ln.exp(), 1e-11, &format!("{kelvin} K, {w} nm"));
            } else {
                assert!(*got >= 0.0 && *got < 1e-300);
            }
        }
    }
}

#[test]
fn at_high_temperatures_luminance_is_rayleighs_and_jeanss() {
    for kelvin in [1e7, 1e8, 1e9] {
        let source = source(kelvin);
        let got = photopic(&convert(source.quantity, &source.spectrum).value);
        // 1/(eˣ − 1) = (1 − x/2 + x²/12 − x⁴/720)/x; at 10⁷ K x is at most 4e-3.
        let want = ln_luminance(|m| {
            let x = C2 / (m * kelvin);
            (C1L * 1e-9).ln() - 5.0 * m.ln() - x.ln() + (-x / 2.0 + x * x / 12.0 - x.powi(4) / 720.0).ln_1p()
        });
        close(got, want.exp(), 1e-13, &format!("{kelvin} K"));
    }
}

#[test]
fn luminance_grows_in_proportion_to_a_high_temperature() {
    let luminance = |kelvin| photopic(&convert(Quantity::Radiance, &source(kelvin).spectrum).value);
    // L ∝ T (1 − x/2), x = c₂/(λT) about 2.6e-5 at 10⁹ K and ten times that at 10⁸ K.
    close(luminance(1e9) / luminance(1e8), 10.0, 2e-4, "a decade");
}

#[test]
fn the_candela_of_1948_is_met() {
    // From 1948 to 1979 the candela was a sixtieth of 1 cm² of blackbody at the freezing point of platinum, 6e5 cd/m²;
    // K_m = 683 lm/W was chosen in 1979 to keep it, its measured values lying between 673 and 688 lm/W (BIPM, Metrologia 13
    // (1977)): within 2 %. T(Pt) = 2041.4 K on the ITS-90.
    let luminance = photopic(&convert(Quantity::Radiance, &source(2041.4).spectrum).value);
    assert!((luminance / 6e5 - 1.0).abs() < 0.02, "{luminance}");
}

#[test]
fn a_blackbody_has_its_own_temperature_from_500_k_to_1e6_k() {
    let mut temperatures: Vec<f64> = (0..=33).map(|k| 500.0 * 10f64.powf(f64::from(k) / 10.0)).collect();
    temperatures.extend([500.0, 1000.0, 2856.0, 6504.0, 25_000.0, 1e5, 999_000.0, 1e6]);
    for kelvin in temperatures.into_iter().filter(|k| *k <= 1e6) {
        let source = source(kelvin);
        let got = convert(source.quantity, &source.spectrum);
        let cct = got.value.cct.unwrap_or_else(|| panic!("{kelvin} K: {:?}", got.findings));
        // (u, v) carries some 1e-16·√471 from the sums; the locus moves by 1e-4 per mired at the blue end, 2e-6 at 2000 mired.
        let (mired, want) = (1e6 / cct.kelvin, 1e6 / kelvin);
        assert!((mired - want).abs() < 1e-9 * want.max(100.0), "{kelvin} K: {cct:?}, {} mired", mired - want);
        assert!(cct.duv.abs() < 3e-12, "{kelvin} K: {cct:?}");
    }
}

#[test]
fn beyond_its_range_a_colour_temperature_is_null_with_the_reason() {
    for kelvin in [1.0, 10.0, 100.0, 300.0, 450.0, 2e6, 1e7, 1e9] {
        let source = source(kelvin);
        let got = convert(source.quantity, &source.spectrum);
        assert!(got.value.cct.is_none() && has(&got.findings, "C001"), "{kelvin} K: {:?}", got.value.cct);
        assert!(got.value.cri.is_none() && has(&got.findings, "C002"), "{kelvin} K");
        assert!(got.value.tm30.is_none() && has(&got.findings, "C004"), "{kelvin} K");
    }
}

#[test]
fn chromaticity_tends_to_that_of_infinite_temperature() {
    // The locus ends at x = 0.2399, y = 0.2341 (Wyszecki & Stiles, Color Science, 2nd ed., Table 1(3.11), T = ∞: 0.23988,
    // 0.23413 with their five digits).
    let xy = convert(Quantity::Radiance, &source(1e9).spectrum).value.xy.expect("light");
    assert!((xy[0] - 0.2399).abs() < 1e-4 && (xy[1] - 0.2341).abs() < 1e-4, "{xy:?}");
}

#[test]
fn the_limit_of_the_cold_end_is_a_line_at_the_end_of_the_table() {
    // At 1 K all that is left in 360–830 nm is the last sample: x̄, ȳ, z̄ at 830 nm are 1.251141e-6, 4.5181e-7, 0.
    let c = convert(Quantity::Relative, &source(1.0).spectrum).value;
    let xy = c.xy.expect("light");
    close(xy[0], 1.251141 / (1.251141 + 0.45181), 1e-8, "x");
    close(c.efficacy_lm_per_w.expect("light"), K_M * 4.5181e-7, 1e-8, "K");
}

//! Closed forms of sinusoids and rectangles, and the flickermeter's transfer functions.

use std::f64::consts::PI;

use super::tones::stroboscopic_threshold;
use super::waveform::Waveform;
use super::*;

fn wave(rate_hz: f64, seconds: f64, f: impl Fn(f64) -> f64) -> Waveform {
    let count = (rate_hz * seconds).round() as usize;
    Waveform { rate_hz, values: (0..count).map(|i| f(i as f64 / rate_hz)).collect() }
}

fn sine(t: f64, hz: f64) -> f64 {
    (2.0 * PI * hz * t).sin()
}

#[test]
fn a_sinusoid_has_its_depth_and_its_depth_over_pi() {
    // 37.3 % at 117.7 Hz, which fits no whole number of times into the record.
    let light = wave(20e3, 1.3, |t| 250.0 * (1.0 + 0.373 * sine(t, 117.7)));
    let f = evaluate(&light).expect("light").value;
    // Of some 153 peaks of 170 samples each, the highest sample is within (π/170)²/2 of the crest.
    assert!((f.percent_flicker - 37.3).abs() < 37.3 * 2e-4, "{}", f.percent_flicker);
    assert!((f.flicker_index - 0.373 / PI).abs() < 1e-4, "{}", f.flicker_index);
    let tone = f.fundamental.expect("a tone");
    assert!((tone.frequency_hz - 117.7).abs() < 1e-3 && (tone.amplitude - 0.373).abs() < 1e-4, "{tone:?}");
    assert_eq!(f.tones.len(), 1);
    // One tone: SVM is its contrast over the threshold, printed at 100 Hz as 0.26.
    let svm = f.svm.expect("a second at 20 kHz");
    assert!((svm - 0.373 / stroboscopic_threshold(117.7)).abs() < 1e-3, "{svm}");
    assert!((stroboscopic_threshold(100.0) - 0.26).abs() < 1e-3);
}

#[test]
fn a_rectangle_has_half_an_index_and_the_tones_of_its_fourier_series() {
    // Off half of the time: C = 4/π, 4/3π, 4/5π … at odd multiples, here of 200 Hz, up to 2 kHz.
    let light = wave(100e3, 1.5, |t| if (200.0 * t).fract() < 0.5 { 2.0 } else { 0.0 });
    let f = evaluate(&light).expect("light").value;
    assert!((f.percent_flicker - 100.0).abs() < 1e-12 && (f.flicker_index - 0.5).abs() < 1e-3, "{f:?}");
    let odd = [1.0, 3.0, 5.0, 7.0, 9.0].map(|k| (4.0 / PI / k / stroboscopic_threshold(200.0 * k)).powf(3.7));
    let want = odd.iter().sum::<f64>().powf(1.0 / 3.7);
    let svm = f.svm.expect("fast enough");
    // The edges fall on samples, 500 to a period: a sampled edge differs from a steep one by (π k/500)²/6 in the k-th tone.
    assert!((svm - want).abs() < 1e-3 * want, "{svm} {want}");
}

/// |H| of the flickermeter's filters as they are printed, at a frequency.
fn printed_gain(hz: f64) -> f64 {
    let complex = |c: &[f64]| {
        // Polynomials of s = iω, the highest power first.
        c.iter().fold([0.0, 0.0], |[re, im], c| [c - im * 2.0 * PI * hz, re * 2.0 * PI * hz])
    };
    let size = |[re, im]: [f64; 2]| f64::hypot(re, im);
    let eye = size(complex(&[0.041_661, 44.758, 2715.6, 29839.0, 0.0]))
        / size(complex(&[1.0, 196.32, 11781.0, 534_820.0, 3_505_380.0]));
    let high = (hz / 0.05) / f64::hypot(1.0, hz / 0.05);
    eye * high / (1.0 + (hz / 35.0).powi(12)).sqrt()
}

#[test]
fn a_steady_flicker_has_the_severity_of_the_printed_filters_at_any_sampling_rate() {
    // P swings about K m² |H|²/2 by 1/√(1 + (4π f · 0.3 s)²) of it; of a steady P, P_st is √(0.5096 P).
    for (hz, rate, depth) in [(8.8, 2000.0, 0.0045), (8.8, 20e3, 0.0045), (20.0, 50e3, 0.007), (2.0, 5000.0, 0.024)] {
        let light = wave(rate, 60.0, |t| 100.0 * (1.0 + depth * sine(t, hz)));
        let found = evaluate(&light).expect("light");
        let pst = found.value.pst_lm.expect("a minute");
        let level = 1.101_603_155_420_234e6 * (depth * printed_gain(hz)).powi(2) / 2.0;
        let swing = 1.0 / (1.0 + (4.0 * PI * hz * 0.3).powi(2)).sqrt();
        let [low, high] = [1.0 - swing, 1.0 + swing].map(|s| (0.5096 * level * s).sqrt());
        // The trapezoidal rule bends frequencies by (πf/rate)²/3.
        let bent = 2.0 * (PI * hz / rate).powi(2);
        assert!((low * (1.0 - bent)..=high * (1.0 + bent)).contains(&pst), "{hz} Hz at {rate}: {pst}, {low} to {high}");
        assert!(found.findings.iter().any(|f| f.code == "F004"), "a minute is less than three");
    }
}

#[test]
fn severity_goes_with_depth_and_steady_light_has_none() {
    let pst = |depth: f64| {
        let light = wave(2000.0, 45.0, |t| 1.0 + depth * sine(t, 10.0));
        evaluate(&light).expect("light").value.pst_lm.expect("long enough")
    };
    assert!((pst(0.02) / pst(0.01) - 2.0).abs() < 1e-9);
    assert!(pst(0.0) < 1e-9);
    let steady = evaluate(&wave(20e3, 2.0, |_| 3.0)).expect("light").value;
    assert_eq!((steady.percent_flicker, steady.flicker_index, steady.svm), (0.0, 0.0, Some(0.0)));
    assert!(steady.tones.is_empty() && steady.fundamental.is_none());
}

#[test]
fn what_is_too_short_or_dark_is_said() {
    let codes =
        |light: &Waveform| -> Vec<&str> { evaluate(light).expect("light").findings.iter().map(|f| f.code).collect() };
    assert_eq!(codes(&wave(1000.0, 0.5, |t| 1.0 + 0.1 * sine(t, 100.0))), ["F002", "F003"]);
    assert_eq!(codes(&wave(20e3, 1.0, |t| 1.0 + 1.5 * sine(t, 100.0))), ["F001", "F003"]);
    assert!(matches!(evaluate(&wave(100.0, 0.1, |_| 1.0)), Err(Error::TooFew { found: 10 })));
    assert!(matches!(evaluate(&wave(100.0, 1.0, |_| 0.0)), Err(Error::Dark { .. })));
}

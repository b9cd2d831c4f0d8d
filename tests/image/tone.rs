//! Tone mapping: the closed forms of the papers, and that it is a last step.

use photopic::colorimetry::rgb::{Encoding, SRGB};
use photopic::image::tone::{Operator, Settings};
use photopic::image::{Channel, Description, Meaning, Memory, RgbSpace, Source, Toned};

fn grey(values: &[f32]) -> Memory {
    let channels = (0..).zip(["R", "G", "B"]).map(|(k, n)| Channel::new(n, "", Meaning::Primary(k))).collect();
    let mut d = Description::planes(values.len(), 1, channels);
    d.rgb = Some(RgbSpace { space: SRGB, encoded: false, white_luminance: Some(1.0) });
    Memory::new(d, values.repeat(3))
}

/// Light shown of greys.
fn shown(values: &[f32], operator: Operator, exposure_ev: f64, key: Option<f64>) -> Vec<f64> {
    let mut toned = Toned::new(grey(values), Settings { operator, exposure_ev, key }).expect("RGB");
    let out = Memory::load(&mut toned).expect("memory does not fail");
    let rgb = out.description().rgb.as_ref().expect("RGB");
    assert!(rgb.encoded && rgb.white_luminance.is_none());
    assert!(out.description().attribute("photopic:tone").is_some());
    (0..values.len()).map(|x| Encoding::Srgb.decode(f64::from(out.at(x, 0, 1)))).collect()
}

fn close(got: &[f64], want: &[f64]) {
    // Encoded values are f32, and the two knees of IEC 61966-2-1 differ by 5e-8.
    got.iter().zip(want).for_each(|(got, want)| assert!((got - want).abs() < 5e-7, "{got} {want}"));
}

#[test]
fn linear_is_exposure() {
    close(&shown(&[0.1, 0.5], Operator::Linear, 0.0, None), &[0.1, 0.5]);
    close(&shown(&[0.1, 0.4], Operator::Linear, 1.0, None), &[0.2, 0.8]);
    // The log-average of 1, 4, 16 is 4, which becomes the key.
    close(&shown(&[1.0, 4.0, 16.0], Operator::Linear, 0.0, Some(0.2)), &[0.05, 0.2, 0.8]);
}

#[test]
fn reinhard_is_the_paper() {
    // Reinhard et al. 2002, eq. 4, L = a/L̄ · L_w with a = 1 and L̄ = 4, L_white = 4: L (1 + L/16)/(1 + L). Black does not count in
    // the average.
    let of = |l: f64| l * (1.0 + l / 16.0) / (1.0 + l);
    close(&shown(&[0.0, 1.0, 4.0, 16.0], Operator::Reinhard, 0.0, Some(1.0)), &[0.0, of(0.25), of(1.0), 1.0]);
    // Two stops more, the white with it.
    let of = |l: f64| l * (1.0 + l / 256.0) / (1.0 + l);
    close(&shown(&[1.0, 4.0, 16.0], Operator::Reinhard, 2.0, Some(1.0)), &[of(1.0), of(4.0), 1.0]);
}

#[test]
fn filmic_is_hables_curve() {
    // Hable 2010 with A .15, B .5, C .1, D .2, E .02, F .3, exposure bias 2, white 11.2, as fractions: h(11.2) is
    // (11.2 · 1.73 + .004)/(11.2 · 2.18 + .06) − 1/15 = 19.38/24.476 − 1/15, h(2) is (2 · .35 + .004)/(2 · .8 + .06) − 1/15.
    let white = 19.38 / 24.476 - 1.0 / 15.0;
    let one = 0.704 / 1.66 - 1.0 / 15.0;
    close(&shown(&[0.0, 1.0, 5.6], Operator::Filmic, 0.0, None), &[0.0, one / white, 1.0]);
}

#[test]
fn a_measurement_is_not_toned() {
    let settings = Settings { operator: Operator::Linear, exposure_ev: 0.0, key: None };
    let luminance =
        Memory::new(Description::planes(1, 1, vec![Channel::new("Y", "cd/m²", Meaning::Photopic)]), vec![1.0]);
    let error = Toned::new(luminance, settings).map(|_| ()).expect_err("a measurement");
    assert!(error.to_string().contains("no measurement"), "{error}");
    let dark = Settings { operator: Operator::Reinhard, exposure_ev: 0.0, key: Some(0.18) };
    assert!(
        Toned::new(grey(&[0.0, 0.0]), dark).map(|_| ()).expect_err("dark").to_string().contains("no pixel above black")
    );
}

//! Pixels from denormal numbers to the sun's disc, in single, half and shared-exponent precision; of one pixel; without any light.

use std::io::Cursor;

use photopic::colorimetry::rgb::RADIANCE;
use photopic::image::compare::differences;
use photopic::image::format::exr::{self, Depth};
use photopic::image::format::radiance;
use photopic::image::{
    Channel, Content, Converted, Description, Meaning, Memory, Plan, RgbSpace, Settings, Source, Target,
};
use photopic::photometry::luminous::Efficiency;

/// One row of pixels of a plane of luminance.
fn plane(values: &[f32]) -> Memory {
    let channels = vec![Channel::new("Y", "cd/m²", Meaning::Photopic)];
    Memory::new(Description::planes(values.len(), 1, channels), values.to_vec())
}

/// A flat spectrum over 360–830 nm by 1 nm: K_m Σ V = 72 983.5 (CIE 018) times the radiance, to single precision, as far as that reaches.
#[test]
fn luminance_is_in_proportion_as_far_as_single_precision_reaches() {
    let bands = (360..=830).map(|nm| Channel::band(format!("{nm} nm"), "", f64::from(nm))).collect();
    let values = [1e-38_f32, 1e-30, 1e-10, 1.0, 2.8e4, 1e33];
    let mut description = Description::planes(values.len(), 1, bands);
    description.content = Content::Light { quantity: None, unit: Some("W/m2/sr/nm".parse().expect("a unit")) };
    let image = Memory::new(description, values.repeat(471));
    let plan = Plan::new(image.description(), &Target::Luminance(Efficiency::default()), &Settings::default());
    let found = Memory::load(&mut Converted::new(image, plan.expect("a plan").value)).expect("memory");
    for (radiance, luminance) in values.iter().zip(found.samples()) {
        let expected = 72_983.5 * f64::from(*radiance);
        // The sum is printed to a tenth.
        let digits = 0.05 / 72_983.5 + f64::from(f32::EPSILON);
        assert!((f64::from(*luminance) / expected - 1.0).abs() < digits, "{radiance}: {luminance}, {expected}");
    }
}

fn read(bytes: &[u8]) -> Memory {
    Memory::load(&mut exr::open(Cursor::new(bytes)).expect("a picture").value).expect("loaded")
}

/// IEEE 754 binary16 ends at 65504 and 2⁻²⁴; beyond, values rest at the end or vanish, with a word, and never become infinite.
#[test]
fn half_precision_rests_at_its_ends() {
    let (sun, starlight) = (2e9, 1e-9);
    let image = plane(&[sun, 65504.0, 65519.9, 1.0 + 1.0 / 1024.0, 2.0_f32.powi(-24), starlight, 0.0, -sun]);
    let mut out = Cursor::new(Vec::new());
    let findings = exr::write(&mut out, &mut image.clone(), Depth::Half).expect("written");
    assert_eq!(findings.iter().map(|f| f.code).collect::<Vec<_>>(), ["I020", "I021"]);
    let again = read(out.get_ref());
    let expected = [65504.0, 65504.0, 65504.0, 1.0 + 1.0 / 1024.0, 2.0_f32.powi(-24), 0.0, 0.0, -65504.0];
    assert_eq!(again.samples(), expected);
    // Single precision holds all of them.
    let mut out = Cursor::new(Vec::new());
    assert!(exr::write(&mut out, &mut image.clone(), Depth::Float).expect("written").is_empty());
    let again = read(out.get_ref());
    assert_eq!(again.samples(), image.samples());
}

/// Radiance's pictures: a mantissa of eight bits, exponents from −128 to 127. A number is off by a unit of 128 at most.
#[test]
fn shared_exponents_hold_starlight_beside_the_sun() {
    let values = [0.0_f32, 1e-30, 1e-6, 0.5, 2e9, 1e37];
    let channels = (0..).zip(["R", "G", "B"]).map(|(k, n)| Channel::new(n, "", Meaning::Primary(k))).collect();
    let mut description = Description::planes(values.len(), 1, channels);
    description.rgb = Some(RgbSpace { space: RADIANCE, encoded: false, white_luminance: Some(179.0) });
    let mut out = Vec::new();
    radiance::write(&mut out, &mut Memory::new(description, values.repeat(3))).expect("written");
    let again = Memory::load(&mut radiance::open(Cursor::new(out)).expect("read").value).expect("loaded");
    for (x, value) in values.iter().enumerate() {
        for channel in 0..3 {
            let found = again.at(x, 0, channel);
            assert!((found - value).abs() <= value / 128.0 * (1.0 + 1e-6), "{value}: {found}");
        }
    }
}

/// Of nothing but zeros, of one pixel, of no number: differences are what they are, and no mean is taken of nothing.
#[test]
fn differences_of_nothing_are_nothing() {
    let of = |a: &[f32], b: &[f32]| differences(&mut plane(a), &mut plane(b), &[(0, 0)]).expect("alike")[0];
    let dark = of(&[0.0; 4], &[0.0; 4]);
    assert_eq!((dark.mean(), dark.rmse()), (0.0, 0.0));
    let one = of(&[1e-30], &[2e-30]);
    assert!((one.rmse() / 1e-30 - 1.0).abs() < 1e-6, "{}", one.rmse());
    // Squares of 1e30 are beyond single precision, not beyond the sums.
    let vast = of(&[1e30, 1e30], &[2e30, 0.0]);
    assert!((vast.rmse() / 1e30 - 1.0).abs() < 1e-6 && vast.mean().abs() < 1e24, "{} {}", vast.rmse(), vast.mean());
}

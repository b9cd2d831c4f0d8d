//! Images of colours: RGB, XYZ and luminance converted by their primaries, and what cannot be had from them.

use photopic::colorimetry::Observer;
use photopic::colorimetry::adaptation::Transform;
use photopic::colorimetry::rgb::{ACESCG, Encoding, RADIANCE, REC2020, SRGB, Space};
use photopic::image::{
    Channel, Converted, Description, Meaning, Memory, Plan, PlanError, RgbSpace, Settings, Source, Target,
};
use photopic::photometry::luminous::Efficiency;
use photopic::spectrum::integrate::{Contract, Rule};
use proptest::prelude::*;

const LUMINANCE: Target = Target::Luminance(Efficiency::Cie1924);
const XYZ: Target = Target::Xyz(Observer::Cie1931);

/// One pixel of RGB.
fn rgb(space: Space, encoded: bool, white_luminance: Option<f64>, pixel: [f32; 3]) -> Memory {
    let channels = ["R", "G", "B"].iter().zip(0..).map(|(n, k)| Channel::new(*n, "", Meaning::Primary(k))).collect();
    let mut description = Description::planes(1, 1, channels);
    description.rgb = Some(RgbSpace { space, encoded, white_luminance });
    Memory::new(description, pixel.to_vec())
}

fn xyz(unit: &str, pixel: [f32; 3]) -> Memory {
    let names = ["X", "Y", "Z"].iter().zip(0..);
    let channels = names.map(|(n, k)| Channel::new(*n, unit, Meaning::Tristimulus(k))).collect();
    Memory::new(Description::planes(1, 1, channels), pixel.to_vec())
}

fn linear(space: Space) -> Target {
    Target::Rgb { space, encoded: false }
}

fn convert(image: &Memory, target: &Target, settings: &Settings) -> Memory {
    let plan = Plan::new(image.description(), target, settings).expect("a plan").value;
    Memory::load(&mut Converted::new(image.clone(), plan)).expect("memory does not fail")
}

fn refused(image: &Memory, target: &Target, settings: &Settings) -> PlanError {
    Plan::new(image.description(), target, settings).expect_err("refused")
}

fn close(got: &[f32], want: &[f64], bound: f64) {
    assert_eq!(got.len(), want.len());
    for (got, want) in got.iter().zip(want) {
        assert!((f64::from(*got) - want).abs() <= bound, "{got} {want}");
    }
}

#[test]
fn rgb_becomes_xyz_by_the_published_matrices() {
    // IEC 61966-2-1, linear sRGB to XYZ, four decimals; luminance of (1, 1, 1) is 80 cd/m² in its reference conditions.
    let columns = [[0.4124, 0.2126, 0.0193], [0.3576, 0.7152, 0.1192], [0.1805, 0.0722, 0.9505]];
    for (k, column) in columns.into_iter().enumerate() {
        let mut pixel = [0.0; 3];
        pixel[k] = 1.0;
        let image = rgb(SRGB, false, Some(80.0), pixel);
        close(convert(&image, &XYZ, &Settings::default()).samples(), &column.map(|v| 80.0 * v), 80.0 * 6e-5);
        close(convert(&image, &LUMINANCE, &Settings::default()).samples(), &[80.0 * column[1]], 80.0 * 6e-5);
    }
    // ITU-R BT.2087-0, BT.709 to BT.2020, four decimals.
    let rows = [[0.6274, 0.3293, 0.0433], [0.0691, 0.9195, 0.0114], [0.0164, 0.0880, 0.8956]];
    // colour-science 0.4.7, matrix_RGB_to_RGB(sRGB, ACEScg, "Bradford") with derived matrices, nine decimals.
    let aces = [
        [0.613_097_402, 0.339_523_146, 0.047_379_451],
        [0.070_193_722, 0.916_353_879, 0.013_452_398],
        [0.020_615_593, 0.109_569_773, 0.869_814_634],
    ];
    for k in 0..3 {
        let mut pixel = [0.0; 3];
        pixel[k] = 1.0;
        let image = rgb(SRGB, false, None, pixel);
        let got = convert(&image, &linear(REC2020), &Settings::default());
        close(got.samples(), &rows.map(|row| row[k]), 6e-5);
        let got = convert(&image, &linear(ACESCG), &Settings::default());
        // Floats have 6e-8 of 1.
        close(got.samples(), &aces.map(|row| row[k]), 6.1e-8);
    }
}

#[test]
fn encoded_rgb_is_decoded_first() {
    // IEC 61966-2-1: code 128 of 255 is 0.215861 (((128/255 + 0.055)/1.055)^2.4).
    let image = rgb(SRGB, true, Some(100.0), [128.0 / 255.0; 3]);
    close(convert(&image, &LUMINANCE, &Settings::default()).samples(), &[21.5861], 5e-5);
}

#[test]
fn units_are_those_that_somebody_states() {
    let unit = |image: &Memory| image.description().channels[0].unit.clone();
    let white = |w| Settings { white_luminance: Some(w), ..Settings::default() };
    let image = rgb(SRGB, false, None, [0.5; 3]);
    let relative = convert(&image, &LUMINANCE, &Settings::default());
    assert_eq!((unit(&relative).as_str(), relative.samples()), ("", &[0.5][..]));
    let plan = Plan::new(image.description(), &LUMINANCE, &Settings::default()).expect("a plan");
    assert!(plan.findings.iter().any(|f| f.code == "I100"), "{:?}", plan.findings);
    let absolute = convert(&image, &LUMINANCE, &white(300.0));
    assert_eq!((unit(&absolute).as_str(), absolute.samples()), ("cd/m²", &[150.0][..]));
    // Radiance's 179 lm/W: (1, 1, 1) is 179 cd/m², which another white of the output divides.
    let image = rgb(RADIANCE, false, Some(179.0), [1.0; 3]);
    close(convert(&image, &LUMINANCE, &Settings::default()).samples(), &[179.0], 2e-5);
    let out = convert(&image, &linear(SRGB), &white(358.0));
    close(out.samples(), &[0.5; 3], 1e-7);
    assert_eq!(out.description().rgb.as_ref().and_then(|r| r.white_luminance), Some(358.0));
    let kept = convert(&image, &linear(SRGB), &Settings::default());
    assert_eq!(kept.description().rgb.as_ref().and_then(|r| r.white_luminance), Some(179.0));
    assert!(matches!(refused(&image, &LUMINANCE, &white(100.0)), PlanError::WhiteStated { .. }));
    let lux = convert(&xyz("lx", [1.0, 2.0, 3.0]), &LUMINANCE, &Settings::default());
    assert_eq!((unit(&lux).as_str(), lux.samples()), ("lx", &[2.0][..]));
    let encoded = Target::Rgb { space: SRGB, encoded: true };
    assert_eq!(refused(&xyz("cd/m²", [1.0; 3]), &encoded, &Settings::default()), PlanError::NoWhite);
}

#[test]
fn what_needs_a_spectrum_is_refused() {
    let image = rgb(SRGB, false, Some(80.0), [0.5; 3]);
    for target in [
        Target::Scotopic,
        Target::AlphaOpic { receptor: 4, equivalent_daylight: true },
        Target::Xyz(Observer::Cie1964),
        Target::Luminance(Efficiency::Cie2008Two),
    ] {
        let error = refused(&image, &target, &Settings::default());
        assert!(matches!(error, PlanError::NoSpectrum { .. }), "{error}");
        assert!(error.to_string().contains("expected a spectral image"), "{error}");
    }
    let rule = Settings { contract: Contract { rule: Some(Rule::Exact), range_nm: None }, ..Settings::default() };
    assert!(matches!(refused(&image, &LUMINANCE, &rule), PlanError::AboutSpectra { .. }));
    let mut luminance = Description::planes(1, 1, vec![Channel::new("Y", "cd/m²", Meaning::Photopic)]);
    let y = Memory::new(luminance.clone(), vec![7.0]);
    assert_eq!(convert(&y, &LUMINANCE, &Settings::default()).samples(), [7.0]);
    assert!(matches!(refused(&y, &XYZ, &Settings::default()), PlanError::NoSpectrum { .. }));
    luminance.set_attribute("photopic:target", "luminance (cie-1964-v10)");
    let tenth = Memory::new(luminance.clone(), vec![7.0]);
    assert!(matches!(refused(&tenth, &LUMINANCE, &Settings::default()), PlanError::NoSpectrum { .. }));
    let other = Memory::new(Description::planes(1, 1, vec![Channel::new("depth", "", Meaning::Other)]), vec![7.0]);
    assert!(matches!(refused(&other, &LUMINANCE, &Settings::default()), PlanError::NoBands { .. }));
}

#[test]
fn attributes_say_what_was_done() {
    let mut image = xyz("cd/m²", [1.0; 3]);
    let mut description = image.description().clone();
    description.set_attribute("photopic:target", "XYZ (cie-1931-2deg)");
    description.set_attribute("photopic:rule", "summation");
    description.set_attribute("photopic:unit", "cd/m²");
    image = Memory::new(description, image.samples().to_vec());
    let out = convert(&image, &linear(SRGB), &Settings::default());
    let attribute = |name: &str| out.description().attribute(name).map(str::to_owned);
    assert_eq!(attribute("photopic:rule").as_deref(), Some("summation"), "the contract goes along");
    assert_eq!(attribute("photopic:from").as_deref(), Some("XYZ (cie-1931-2deg)"));
    assert_eq!(attribute("photopic:unit"), None, "RGB is not in cd/m²");
}

proptest! {
    /// There and back through any two spaces, with and without adaptation: within the rounding of two `f32` results, which the
    /// inverse matrix magnifies by less than 10.
    #[test]
    fn spaces_come_back(pixel in prop::array::uniform3(0.0_f32..1000.0), a in 0_usize..4, b in 0_usize..4, plain: bool) {
            let spaces = [SRGB, REC2020, ACESCG, RADIANCE].map(|s| Space { encoding: Encoding::Linear, ..s });
        let adaptation = if plain { Transform::None } else { Transform::Cat16 };
        let settings = Settings { adaptation, ..Settings::default() };
        let image = rgb(spaces[a], false, Some(179.0), pixel);
        let there = convert(&image, &linear(spaces[b]), &settings);
        let back = convert(&there, &linear(spaces[a]), &settings);
        let size = f64::from(pixel.iter().copied().fold(1e-30, f32::max));
        for (got, want) in back.samples().iter().zip(pixel) {
            prop_assert!((f64::from(*got) - f64::from(want)).abs() <= 10.0 * 6e-8 * size, "{got} {want}");
        }
        // Without adaptation, luminance is what it was.
        if plain {
            let y = |image: &Memory| f64::from(convert(image, &LUMINANCE, &Settings::default()).samples()[0]);
            prop_assert!((y(&image) - y(&there)).abs() <= 10.0 * 6e-8 * size * 179.0);
        }
        prop_assert_eq!(there.description().rgb.as_ref().and_then(|r| r.white_luminance), Some(179.0));
    }
}

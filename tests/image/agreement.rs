//! Every pixel of a converted image is what `convert` gives for its spectrum, to 1e-6 relative.
//!
//! The truth is the library's path for single spectra, which `tests/reference_spectra.rs` and `scripts/cross_check.py` hold to
//! outside numbers. The samples are the same `f32` on both sides, so only sums and the rounding of the result may differ.

use photopic::colorimetry::rgb::{DISPLAY_P3, SRGB};
use photopic::colorimetry::{Observer, rgb};
use photopic::conversion::{Converter, Groups, Settings as SpectrumSettings};
use photopic::illuminant::named;
use photopic::image::{
    Channel, Content, Converted, Description, Memory, Plan, PlanError, Region, Settings, Source, Target,
};
use photopic::photometry::luminous::Efficiency;
use photopic::spectrum::integrate::{Contract, Rule};
use photopic::spectrum::{Grid, Quantity, Spectrum};

const WIDTH: usize = 29;
const HEIGHT: usize = 3;

/// A number in [0, 1) from a counter (splitmix64).
fn random(seed: u64) -> f64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

fn cube(wavelengths: &[f64], content: Content, scale: f64) -> Memory {
    let channels = wavelengths.iter().map(|w| Channel::band(format!("{w} nm"), "", *w)).collect();
    let mut description = Description::planes(WIDTH, HEIGHT, channels);
    description.content = content;
    let count = description.pixels() * wavelengths.len();
    Memory::new(description, (0..count).map(|i| (scale * random(i as u64)) as f32).collect())
}

fn light(unit: &str) -> Content {
    Content::Light { quantity: None, unit: Some(unit.parse().expect("a unit")) }
}

fn pixel(image: &Memory, x: usize, y: usize) -> Vec<f64> {
    (0..image.description().channels.len()).map(|c| f64::from(image.at(x, y, c))).collect()
}

fn converted(image: &Memory, target: &Target, settings: &Settings) -> Memory {
    let plan = Plan::new(image.description(), target, settings).expect("a plan").value;
    Memory::load(&mut Converted::new(image.clone(), plan)).expect("memory does not fail")
}

fn close(got: f32, want: f64, what: &str) {
    assert!((f64::from(got) - want).abs() <= 1e-6 * want.abs(), "{what}: {got} {want}");
}

fn grids() -> Vec<Vec<f64>> {
    vec![
        (0..81).map(|i| 380.0 + 5.0 * f64::from(i)).collect(),
        (0..31).map(|i| 400.0 + 10.0 * f64::from(i)).collect(),
        (0..471).map(|i| 360.0 + f64::from(i)).collect(),
        vec![402.3, 433.0, 441.5, 470.0, 500.0, 525.0, 551.0, 560.0, 589.3, 610.0, 655.0, 701.0, 940.0],
    ]
}

#[test]
fn luminance_scotopic_xyz_and_melanopic_are_those_of_convert() {
    for wavelengths in grids() {
        for rule in [None, Some(Rule::Exact), Some(Rule::Trapezoid)] {
            let contract = Contract { rule, range_nm: None };
            let image = cube(&wavelengths, light("W/m2/sr/nm"), 0.1);
            let settings = Settings { contract, ..Settings::default() };
            let observer = Observer::Cie1964;
            let (y, scotopic, xyz, melanopic) = (
                converted(&image, &Target::Luminance(Efficiency::Cie1924), &settings),
                converted(&image, &Target::Scotopic, &settings),
                converted(&image, &Target::Xyz(observer), &settings),
                converted(&image, &Target::AlphaOpic { receptor: 4, equivalent_daylight: true }, &settings),
            );
            let groups = Groups { alpha_opic: true, ..Groups::NONE };
            let converter =
                Converter::new(SpectrumSettings { contract, observer, groups, ..SpectrumSettings::default() });
            let grid = std::sync::Arc::new(Grid::new(wavelengths.clone()).expect("ascending"));
            for (px, py) in [(0, 0), (7, 1), (8, 1), (23, 0), (24, 2), (WIDTH - 1, HEIGHT - 1)] {
                let spectrum = Spectrum::density(grid.clone(), pixel(&image, px, py)).expect("finite");
                let want = converter.convert("pixel", Quantity::Radiance, &spectrum).expect("converts").value;
                close(y.at(px, py, 0), want.absolute[0].photopic, "luminance");
                close(scotopic.at(px, py, 0), want.absolute[0].scotopic, "scotopic");
                for (k, want) in want.xyz.expect("lit").into_iter().enumerate() {
                    close(xyz.at(px, py, k), want, "XYZ");
                }
                close(melanopic.at(px, py, 0), want.alpha_opic[4].equivalent_daylight, "melanopic");
            }
        }
    }
}

#[test]
fn linear_rgb_is_that_of_convert_times_the_luminance() {
    let wavelengths = &grids()[0];
    let image = cube(wavelengths, light("mW/m2/sr/nm"), 3.0);
    let converter = Converter::new(SpectrumSettings {
        groups: Groups { rgb: true, ..Groups::NONE },
        ..SpectrumSettings::default()
    });
    let grid = Grid::new(wavelengths.clone()).expect("ascending");
    let values = pixel(&image, 11, 2).into_iter().map(|v| 1e-3 * v).collect();
    let spectrum = Spectrum::density(grid, values).expect("finite");
    let want = converter.convert("pixel", Quantity::Radiance, &spectrum).expect("converts").value;
    for (k, space) in rgb::SPACES.into_iter().enumerate() {
        let linear = converted(&image, &Target::Rgb { space, encoded: false }, &Settings::default());
        for (c, component) in want.rgb[k].colour.linear.into_iter().enumerate() {
            close(linear.at(11, 2, c), component * want.absolute[0].photopic, space.name);
        }
    }
    let settings = Settings { white_luminance: Some(500.0), ..Settings::default() };
    let encoded = converted(&image, &Target::Rgb { space: DISPLAY_P3, encoded: true }, &settings);
    let linear = converted(&image, &Target::Rgb { space: DISPLAY_P3, encoded: false }, &settings);
    let want = DISPLAY_P3.encoding.encode(f64::from(linear.at(11, 2, 1)));
    close(encoded.at(11, 2, 1), want, "encoded");
    let nobody_says = Plan::new(image.description(), &Target::Rgb { space: SRGB, encoded: true }, &Settings::default());
    assert_eq!(nobody_says, Err(PlanError::NoWhite));
}

#[test]
fn reflectance_under_an_illuminant_is_the_ratio_of_two_lights() {
    // A reflectance times D65, and D65 alone, as spectra: the quotient of their XYZ and Y is the CIE's luminance factor.
    let wavelengths: Vec<f64> = (0..81).map(|i| 380.0 + 5.0 * f64::from(i)).collect();
    let image = cube(&wavelengths, Content::Reflectance, 1.0);
    let d65 = named::source("D65", photopic::constants::SecondRadiation::Its90).expect("a name").spectrum;
    let settings = Settings { illuminant: Some(("D65".to_owned(), d65.clone())), ..Settings::default() };
    let xyz = converted(&image, &Target::Xyz(Observer::Cie1931), &settings);
    let at = |w: f64| d65.values()[d65.wavelengths_nm().iter().position(|v| *v == w).expect("a 5 nm table")];
    let converter = Converter::new(SpectrumSettings { groups: Groups::NONE, ..SpectrumSettings::default() });
    let grid = Grid::new(wavelengths.clone()).expect("ascending");
    let of = |values: Vec<f64>| {
        let spectrum = Spectrum::density(grid.clone(), values).expect("finite");
        converter.convert("", Quantity::Radiance, &spectrum).expect("converts").value.xyz.expect("lit")
    };
    let white = of(wavelengths.iter().map(|w| at(*w)).collect());
    let lit = of(wavelengths.iter().zip(pixel(&image, 4, 1)).map(|(w, r)| at(*w) * r).collect());
    for (k, lit) in lit.into_iter().enumerate() {
        close(xyz.at(4, 1, k), lit / white[1], "luminance factor");
    }
    // The perfect diffuser is white in RGB, whatever light falls on it.
    let a = named::source("A", photopic::constants::SecondRadiation::Its90).expect("a name").spectrum;
    let settings = Settings { illuminant: Some(("A".to_owned(), a)), ..Settings::default() };
    let ones = vec![1.0; image.samples().len()];
    let perfect = Memory::new(image.description().clone(), ones);
    let rgb = converted(&perfect, &Target::Rgb { space: SRGB, encoded: true }, &settings);
    (0..3).for_each(|k| close(rgb.at(0, 0, k), 1.0, "white"));
    assert!(matches!(
        Plan::new(image.description(), &Target::Scotopic, &Settings::default()),
        Err(PlanError::NoIlluminant { .. })
    ));
}

#[test]
fn any_region_and_any_order_of_channels_give_the_same_pixels() {
    let image = cube(&grids()[1], light("W/m2/sr/nm"), 1.0);
    let target = Target::Xyz(Observer::Cie1931);
    let whole = converted(&image, &target, &Settings::default());
    let plan = Plan::new(image.description(), &target, &Settings::default()).expect("a plan").value;
    let mut source = Converted::new(image, plan);
    let region = Region { x: 3, y: 1, width: 10, height: 2 };
    let mut out = vec![0.0; region.pixels() * 2];
    source.read(region, &[2, 0], &mut out).expect("memory does not fail");
    for y in 0..region.height {
        for (c, channel) in [2, 0].into_iter().enumerate() {
            for x in 0..region.width {
                assert_eq!(out[(y * 2 + c) * region.width + x], whole.at(region.x + x, region.y + y, channel));
            }
        }
    }
}

#[test]
fn denormals_and_tiny_radiances_survive() {
    // 1e-30 and the smallest float through a sum whose only other terms are zero: K_m V(555) Δλ times them, by hand.
    let wavelengths = [550.0, 555.0, 560.0];
    for tiny in [1e-30_f32, f32::MIN_POSITIVE / 8.0] {
        let mut description = cube(&wavelengths, light("W/m2/sr/nm"), 0.0).description().clone();
        (description.width, description.height) = (1, 1);
        let image = Memory::new(description, vec![0.0, tiny, 0.0]);
        let y = converted(&image, &Target::Luminance(Efficiency::Cie1924), &Settings::default());
        // V(555 nm) = 1 (CIE 018:2019, table 1).
        close(y.at(0, 0, 0), 683.002 * 5.0 * f64::from(tiny), "tiny");
    }
}

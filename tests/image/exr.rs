//! Spectral EXRs: files of other programs, round trips, tiles, several parts, damaged files.

use std::fs;
use std::io::Cursor;

use exr::prelude::*;
use photopic::colorimetry::{Observer, chromaticity};
use photopic::image::format::exr::{self as ours, Depth};
use photopic::image::{
    Channel, Content, Converted, Description, Meaning, Memory, Photometric, Plan, Region, Settings, Source, Target,
};
use photopic::photometry::luminous::Efficiency;
use photopic::spectrum::Quantity;

use crate::common::shared;

fn load(bytes: &[u8]) -> (Memory, Vec<photopic::finding::Finding>) {
    let mut opened = ours::open(Cursor::new(bytes)).expect("a valid file");
    (Memory::load(&mut opened.value).expect("reads"), opened.findings)
}

fn converted(image: &Memory, target: &Target, settings: &Settings) -> Memory {
    let plan = Plan::new(image.description(), target, settings).expect("a plan").value;
    Memory::load(&mut Converted::new(image.clone(), plan)).expect("memory does not fail")
}

#[test]
fn d65_has_the_chromaticity_of_d65() {
    // Written by colour-science 0.4.4 (tests of its Fichet 2021 reader). x = 0.31272, y = 0.32903: CIE 15:2018, table for D65
    // and the 2° observer, five digits; samples are half-floats, 5e-4 relative at most.
    let Some(path) = shared("image/D65.exr") else { return };
    let (image, findings) = load(&fs::read(path).expect("readable"));
    assert_eq!(image.description().bands().len(), 97);
    assert!(findings.iter().any(|f| f.code == "I003"), "{findings:?}");
    assert!(matches!(image.description().content, Content::Light { quantity: Some(Quantity::Radiance), .. }));
    let xyz = converted(&image, &Target::Xyz(Observer::Cie1931), &Settings::default());
    let xyz = [0, 1, 2].map(|k| f64::from(xyz.at(0, 0, k)));
    let [x, y] = chromaticity::xy(xyz).expect("lit");
    assert!((x - 0.31272).abs() < 5e-5 && (y - 0.32903).abs() < 5e-5, "{x} {y}");
}

#[test]
fn ohta_is_reflectance_with_the_values_of_its_rgb() {
    // The file holds RGB beside the spectra, computed by colour-science under D65: half-floats, and 20 nm bands that it
    // interpolates to 1 nm where we integrate straight lines; 2 % of white covers both.
    let Some(path) = shared("image/Ohta1997.exr") else { return };
    let (image, _) = load(&fs::read(path).expect("readable"));
    assert_eq!((image.description().width, image.description().height), (6, 4));
    assert_eq!((image.description().content.clone(), image.description().bands().len()), (Content::Reflectance, 16));
    let d65 = photopic::illuminant::named::source("D65", photopic::constants::SecondRadiation::Its90).expect("a name");
    let settings = Settings { illuminant: Some(("D65".to_owned(), d65.spectrum)), ..Settings::default() };
    let target = Target::Rgb { space: photopic::colorimetry::rgb::SRGB, encoded: false };
    let rgb = converted(&image, &target, &settings);
    for y in 0..4 {
        for x in 0..6 {
            for k in 0..3 {
                let channel = image.description().find(Meaning::Primary(k)).expect("RGB beside");
                let (got, want) = (rgb.at(x, y, usize::from(k)), image.at(x, y, channel));
                assert!((got - want).abs() < 0.02, "({x}, {y}) {k}: {got} {want}");
            }
        }
    }
}

#[test]
fn polarised_light_is_told_and_carried() {
    let Some(path) = shared("image/Polarised.exr") else { return };
    let (image, findings) = load(&fs::read(path).expect("readable"));
    let stokes = |n| {
        let of = |c: &&Channel| matches!(c.meaning, Meaning::Stokes { component, .. } if component == n);
        image.description().channels.iter().filter(of).count()
    };
    assert_eq!(([stokes(1), stokes(2), stokes(3)], image.description().bands().len()), ([8; 3], 8));
    assert!(findings.iter().any(|f| f.code == "I004"), "{findings:?}");
    assert_eq!(image.description().attribute("polarisationHandedness"), Some("right"));
    // Written and read again nothing has changed, S1–S3 and attributes included.
    let mut out = Cursor::new(Vec::new());
    ours::write(&mut out, &mut image.clone(), Depth::Float).expect("writes");
    let (again, _) = load(out.get_ref());
    for (c, channel) in image.description().channels.iter().enumerate() {
        let same = again.description().channels.iter().position(|a| a.meaning == channel.meaning).expect("is there");
        for y in 0..32 {
            assert!((0..32).all(|x| image.at(x, y, c).to_bits() == again.at(x, y, same).to_bits()), "{}", channel.name);
        }
    }
    assert_eq!(again.description().attribute("polarisationHandedness"), Some("right"));
}

fn cube(width: usize, height: usize, unit: &str) -> Memory {
    let bands = [400.0, 450.5, 555.016, 700.0];
    let channels = bands.iter().map(|w| Channel::band(format!("{w}"), unit, *w)).collect();
    let mut description = Description::planes(width, height, channels);
    description.content = Content::Light { quantity: None, unit: Some(unit.parse().expect("a unit")) };
    description.set_attribute("note", "ein Maß");
    let samples = (0..width * height * bands.len()).map(|i| ((i * 7919) % 10007) as f32 * 1e-3).collect();
    Memory::new(description, samples)
}

#[test]
fn a_written_cube_comes_back_in_si() {
    // Blocks of 16 lines do not divide 37 rows.
    let image = cube(50, 37, "uW/cm2/sr/nm");
    let mut out = Cursor::new(Vec::new());
    ours::write(&mut out, &mut image.clone(), Depth::Float).expect("writes");
    let (again, findings) = load(out.get_ref());
    assert!(findings.is_empty(), "{findings:?}");
    assert_eq!(again.description().attribute("note"), Some("ein Maß"));
    let Content::Light { unit: Some(unit), .. } = &again.description().content else { panic!("light") };
    assert_eq!((unit.factor, unit.quantity), (1.0, Quantity::Radiance));
    for (c, wavelength) in again.description().bands() {
        let from = image.description().bands().iter().find(|b| b.1 == wavelength).expect("the wavelength to the bit").0;
        for y in 0..37 {
            for x in 0..50 {
                // 1 µW/cm² is 1e-2 W/m², rounded to the nearest float.
                assert_eq!(again.at(x, y, c), (f64::from(image.at(x, y, from)) * 1e-2) as f32);
            }
        }
    }
    // Both have the same luminance.
    let target = Target::Luminance(Default::default());
    let (a, b) = (converted(&image, &target, &Settings::default()), converted(&again, &target, &Settings::default()));
    a.samples().iter().zip(b.samples()).for_each(|(a, b)| assert!((a - b).abs() <= 2e-7 * a, "{a} {b}"));
}

#[test]
fn half_floats_never_become_infinite() {
    let description = Description::planes(3, 1, vec![Channel::new("Y", "cd/m²", Meaning::Photopic)]);
    // The sun's disc, 2e9 cd/m² (physics of the field), a common value, one too small.
    let mut image = Memory::new(description, vec![2e9, 1.5, 1e-9]);
    let mut out = Cursor::new(Vec::new());
    let findings = ours::write(&mut out, &mut image, Depth::Half).expect("writes");
    assert_eq!(findings.iter().map(|f| f.code).collect::<Vec<_>>(), ["I020", "I021"]);
    let (again, _) = load(out.get_ref());
    assert_eq!(again.samples(), [65504.0, 1.5, 0.0]);
    assert_eq!(again.description().channels[0].unit, "cd/m²");
    let mut out = Cursor::new(Vec::new());
    assert!(ours::write(&mut out, &mut image, Depth::Float).expect("writes").is_empty());
    assert_eq!(load(out.get_ref()).0.samples(), [2e9, 1.5, 1e-9]);
}

/// A file by the crate `exr` itself: two parts or one, tiles or scan lines, half or float, any compression.
fn foreign(encoding: Encoding, half: bool, parts: bool) -> (Vec<u8>, impl Fn(usize, usize, usize) -> f32) {
    let (width, height) = (83, 41);
    let value = |x: usize, y: usize, band: usize| ((x * 31 + y * 17 + band * 7) % 512) as f32 / 16.0;
    let channel = |band: usize| {
        let name = ["S0.400,000000nm", "S0.500,000000nm", "S0.600,000000nm"][band];
        let samples = (0..width * height).map(|i| value(i % width, i / width, band));
        let samples = if half {
            FlatSamples::F16(samples.map(f16::from_f32).collect())
        } else {
            FlatSamples::F32(samples.collect())
        };
        AnyChannel::new(name, samples)
    };
    let layer = |name: &str, bands: &[usize]| {
        let channels = AnyChannels::sort(bands.iter().map(|b| channel(*b)).collect());
        Layer::new((width, height), LayerAttributes::named(name), encoding, channels)
    };
    let layers: Vec<_> =
        if parts { vec![layer("one", &[0, 2]), layer("two", &[1])] } else { vec![layer("all", &[0, 1, 2])] };
    let size = Vec2(width, height);
    let image = Image::from_layers(ImageAttributes::with_size(size), layers);
    let mut out = Cursor::new(Vec::new());
    image.write().to_buffered(&mut out).expect("the crate writes");
    (out.into_inner(), value)
}

#[test]
fn a_y_beside_red_green_and_blue_is_not_their_luminance() {
    let channel = |name: &str, value: f32| AnyChannel::new(name, FlatSamples::F32(vec![value]));
    let channels = AnyChannels::sort(
        [channel("R", 1.0), channel("G", 1.0), channel("B", 1.0), channel("Y", 7.0)].into_iter().collect(),
    );
    let layer = Layer::new((1, 1), LayerAttributes::named("all"), encodings()[0], channels);
    let image = Image::from_layers(ImageAttributes::with_size(Vec2(1, 1)), vec![layer]);
    let mut out = Cursor::new(Vec::new());
    image.write().to_buffered(&mut out).expect("the crate writes");
    let (image, _) = load(out.get_ref());
    let settings = Settings { white_luminance: Some(100.0), ..Settings::default() };
    let way = Photometric::luminance(image.description(), Efficiency::Cie1924, &settings).expect("a plan").value;
    let luminance = Memory::load(&mut way.of(image)).expect("memory");
    // White by definition of --white-luminance; the weights of R, G, B sum to one but for rounding to f32.
    assert!((luminance.samples()[0] - 100.0).abs() < 1e-5, "{:?}", luminance.samples());
}

fn encodings() -> Vec<Encoding> {
    let tiles = |x, y| Blocks::Tiles(Vec2(x, y));
    let of = |compression, blocks, line_order| Encoding { compression, blocks, line_order };
    vec![
        of(Compression::Uncompressed, Blocks::ScanLines, LineOrder::Increasing),
        of(Compression::ZIP1, Blocks::ScanLines, LineOrder::Increasing),
        of(Compression::ZIP16, Blocks::ScanLines, LineOrder::Decreasing),
        of(Compression::PIZ, Blocks::ScanLines, LineOrder::Increasing),
        of(Compression::RLE, tiles(32, 16), LineOrder::Increasing),
        of(Compression::ZIP16, tiles(64, 64), LineOrder::Unspecified),
        of(Compression::PIZ, tiles(100, 7), LineOrder::Increasing),
    ]
}

#[test]
fn tiles_lines_parts_and_half_floats_are_read() {
    for encoding in encodings() {
        for (half, parts) in [(false, false), (true, false), (false, true), (true, true)] {
            let what = format!("{encoding:?} half {half} parts {parts}");
            let (bytes, value) = foreign(encoding, half, parts);
            let mut source = ours::open(Cursor::new(&bytes[..])).expect("a valid file").value;
            let bands = source.description().bands();
            assert_eq!(bands.iter().map(|b| b.1).collect::<Vec<_>>(), [400.0, 500.0, 600.0], "{what}");
            let channels: Vec<usize> = bands.iter().map(|b| b.0).collect();
            for region in [
                Region { x: 0, y: 0, width: 83, height: 41 },
                Region { x: 30, y: 14, width: 40, height: 20 },
                Region { x: 82, y: 40, width: 1, height: 1 },
            ] {
                let mut out = vec![f32::NAN; region.pixels() * 3];
                source.read(region, &channels, &mut out).expect("reads");
                for (i, got) in out.into_iter().enumerate() {
                    let (x, band, y) = (i % region.width, i / region.width % 3, i / region.width / 3);
                    assert_eq!(got, value(region.x + x, region.y + y, band), "{what} {region:?}");
                }
            }
        }
    }
}

#[test]
fn files_cut_off_anywhere_are_refused_before_work_begins() {
    for encoding in encodings() {
        let (bytes, _) = foreign(encoding, false, false);
        for length in [0, 3, 8, 100, bytes.len() / 2, bytes.len() - 1] {
            let error = ours::open(Cursor::new(&bytes[..length])).err();
            assert!(error.is_some(), "{encoding:?} cut to {length} of {}", bytes.len());
        }
    }
}

#[test]
fn two_channels_of_one_wavelength_are_refused() {
    let channels = vec![Channel::band("a", "", 500.0), Channel::band("b", "", 500.0)];
    let mut description = Description::planes(1, 1, channels);
    description.content = Content::Reflectance;
    let error = ours::write(Cursor::new(Vec::new()), &mut Memory::new(description, vec![0.0; 2]), Depth::Float);
    assert!(error.expect_err("one name twice").to_string().contains("T.500,0nm"));
}

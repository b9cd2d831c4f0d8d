//! Radiance pictures: files of Radiance's own programs, every orientation, and damaged ones.
//!
//! `tests/data/images/*.hdr` are of 9 × 4 pixels, made by Radiance 6 (`pvalue -r`, `pfilt -1 -e`, `ra_rgbe`, `ra_xyze`); beside
//! them what its `pvalue -o -h -H -d` prints of them, four digits, which is what the pixels are without exposure.

use std::io::Cursor;

use photopic::colorimetry::rgb::{RADIANCE, SRGB};
use photopic::image::format::radiance::{open, write};
use photopic::image::{Channel, Description, Error, Meaning, Memory, RgbSpace, Source};
use proptest::prelude::*;

fn load(bytes: &[u8]) -> Result<Memory, Error> {
    Memory::load(&mut open(Cursor::new(bytes))?.value)
}

fn printed(text: &str) -> Vec<f64> {
    text.split_whitespace().map(|v| v.parse().expect("a number")).collect()
}

#[test]
fn pixels_are_those_that_radiance_prints() {
    for (name, bytes, text) in [
        ("flat", &include_bytes!("../data/images/flat.hdr")[..], include_str!("../data/images/rgb.txt")),
        ("rle", include_bytes!("../data/images/rle.hdr"), include_str!("../data/images/rgb.txt")),
        ("exposed", include_bytes!("../data/images/exposed.hdr"), include_str!("../data/images/exposed.txt")),
        ("xyze", include_bytes!("../data/images/xyze.hdr"), include_str!("../data/images/xyze.txt")),
    ] {
        let image = load(bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        let want = printed(text);
        assert_eq!(want.len(), 9 * 4 * 3, "{name}");
        for (i, want) in want.into_iter().enumerate() {
            let got = f64::from(image.at(i / 3 % 9, i / 27, i % 3));
            // Four digits: half a unit of the last is up to 5e-4 of the number.
            assert!((got - want).abs() <= 5.1e-4 * want, "{name} {i}: {got} {want}");
        }
        let d = image.description();
        assert_eq!(d.find(Meaning::Tristimulus(1)).is_some(), name == "xyze");
        if name == "xyze" {
            assert_eq!(d.channels[1].unit, "cd/m²");
        } else {
            assert_eq!(d.rgb.as_ref().and_then(|r| r.white_luminance), Some(179.0));
        }
    }
}

/// A picture of 3 × 2 pixels whose red is 1 to 6 by rows, stored in an orientation.
fn oriented(size: &str, order: [u8; 6]) -> Vec<u8> {
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n").into_bytes();
    // 2^(136 − 136) · (m + ½): m + ½ exactly.
    order.iter().for_each(|m| bytes.extend([*m, 0, 0, 136]));
    bytes
}

#[test]
fn all_eight_orientations_are_read() {
    // The picture is 1 2 3 / 4 5 6; the first axis of the line changes slowest (Radiance File Formats).
    for (size, order) in [
        ("-Y 2 +X 3", [1, 2, 3, 4, 5, 6]),
        ("-Y 2 -X 3", [3, 2, 1, 6, 5, 4]),
        ("+Y 2 +X 3", [4, 5, 6, 1, 2, 3]),
        ("+Y 2 -X 3", [6, 5, 4, 3, 2, 1]),
        ("+X 3 -Y 2", [1, 4, 2, 5, 3, 6]),
        ("+X 3 +Y 2", [4, 1, 5, 2, 6, 3]),
        ("-X 3 -Y 2", [3, 6, 2, 5, 1, 4]),
        ("-X 3 +Y 2", [6, 3, 5, 2, 4, 1]),
    ] {
        let image = load(&oriented(size, order)).expect("whole");
        assert_eq!((image.description().width, image.description().height), (3, 2), "{size}");
        let red: Vec<f32> = (0..6).map(|i| image.at(i % 3, i / 3, 0)).collect();
        assert_eq!(red, [1.5, 2.5, 3.5, 4.5, 5.5, 6.5], "{size}");
        let mut source = open(Cursor::new(oriented(size, order))).expect("whole").value;
        let mut out = [0.0; 2];
        let region = photopic::image::Region { x: 1, y: 1, width: 2, height: 1 };
        source.read(region, &[0], &mut out).expect("whole");
        assert_eq!(out, [5.5, 6.5], "{size}: a part");
    }
}

#[test]
fn the_header_is_applied_as_radiance_documents_it() {
    let bytes = |lines: &str| {
        let mut bytes = format!("#?RGBE\n{lines}\n-Y 1 +X 1\n").into_bytes();
        bytes.extend([100, 100, 100, 136]);
        bytes
    };
    // Exposures and corrections multiply, and are divided out; lines of the parts of a composite picture do not count.
    let lines = "pfilt\nEXPOSURE=4\n\tEXPOSURE=7\nEXPOSURE= .5\nCOLORCORR= 1 2 4\nVIEW= -vtv\nPIXASPECT=2\n";
    let opened = open(Cursor::new(bytes(lines))).expect("whole");
    assert_eq!(opened.findings.iter().map(|f| f.code).collect::<Vec<_>>(), ["I111", "I112"]);
    let image = load(&bytes(lines)).expect("whole");
    assert_eq!(image.samples(), [100.5 / 2.0, 100.5 / 4.0, 100.5 / 8.0]);
    assert_eq!(image.description().attribute("VIEW"), Some("-vtv"));
    assert_eq!(image.description().attribute("history"), Some("pfilt"));
    assert_eq!(image.description().attribute("radiance:exposure"), Some("2"));
    let space = |lines: &str| load(&bytes(lines)).expect("whole").description().rgb.clone().expect("RGB").space;
    assert_eq!(space("").key, "radiance");
    assert_eq!(space("PRIMARIES= .64 .33 .3 .6 .15 .06 .3127 .329\n").key, "srgb");
    assert_eq!(space("PRIMARIES= 0 0 0 0 0 0 0 0\n").key, "radiance", "as some programs write");
}

#[test]
fn damaged_files_say_where() {
    let whole = include_bytes!("../data/images/rle.hdr");
    for cut in [1, 7, 20] {
        let error = load(&whole[..whole.len() - cut]).expect_err("cut off").to_string();
        assert!(error.contains("cut off") || error.contains("the end of the file"), "{error}");
    }
    for (text, want) in [
        ("", "found an empty input"),
        ("P6\n1 1\n", "1:1: found `P6`; expected a line beginning with #?RADIANCE"),
        ("#?RADIANCE\nFORMAT=32-bit\n\n-Y 1 +X 1\n", "2:8: found `32-bit` for FORMAT; expected 32-bit_rle_rgbe or"),
        ("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n", "2:10: found `0` for EXPOSURE; expected a positive number"),
        ("#?RADIANCE\nCOLORCORR=1 1\n\n-Y 1 +X 1\n", "expected three positive numbers"),
        ("#?RADIANCE\nPRIMARIES=1 1\n\n-Y 1 +X 1\n", "expected eight numbers"),
        ("#?RADIANCE\n\n-Y 1 +Y 1\n", "3: found `-Y 1 +Y 1` for the size; expected a line such as"),
        ("#?RADIANCE\n\n-Y 0 +X 1\n", "expected edges of 1 to"),
        ("#?RADIANCE\n\n-Y 99999999999 +X 1\n", "expected edges of 1 to"),
        ("#?RADIANCE\n", "found the end of the file; expected header lines"),
        ("#?RADIANCE\n\n-Y 1000000 +X 1\n", "the file is cut off"),
    ] {
        let error = load(text.as_bytes()).expect_err("refused").to_string();
        assert!(error.contains(want), "{text:?}: {error}");
    }
}

fn image(meaning: fn(u8) -> Meaning, names: [&str; 3], unit: &str, width: usize, samples: Vec<f32>) -> Memory {
    let channels = (0..).zip(names).map(|(k, n)| Channel::new(n, unit, meaning(k))).collect();
    let mut d = Description::planes(width, samples.len() / 3 / width, channels);
    if unit.is_empty() {
        d.rgb = Some(RgbSpace { space: SRGB, encoded: false, white_luminance: Some(500.0) });
    }
    Memory::new(d, samples)
}

proptest! {
    /// What is written comes back in units, within a unit of the mantissa: 1/256 of twice the largest component, and half a unit
    /// more of rounding. RGB of sRGB with its white of 500 cd/m² comes back with 179, XYZ in cd/m².
    #[test]
    fn pictures_come_back(width in 1_usize..40, rows in 1_usize..4, seed in any::<u32>(), xyz: bool) {
        let value = |i: usize| ((seed as usize).wrapping_add(i).wrapping_mul(2_654_435_761) % 1000) as f32 / 7.0;
        let samples: Vec<f32> = (0..3 * width * rows).map(|i| if i % 5 == 0 { 2.0 } else { value(i) }).collect();
        let mut source = match xyz {
            true => image(Meaning::Tristimulus, ["X", "Y", "Z"], "cd/m²", width, samples),
            false => image(Meaning::Primary, ["R", "G", "B"], "", width, samples),
        };
        let mut bytes = Vec::new();
        prop_assert_eq!(write(&mut bytes, &mut source).expect("written"), vec![]);
        let back = load(&bytes).expect("whole");
        if let Some(rgb) = &back.description().rgb {
            prop_assert_eq!(rgb.space.key, "srgb");
        }
        let factor = if xyz { 1.0 } else { 500.0 / 179.0 };
        for y in 0..rows {
            for x in 0..width {
                let largest = (0..3).map(|c| source.at(x, y, c)).fold(0.0, f32::max);
                for c in 0..3 {
                    let (got, want) = (f64::from(back.at(x, y, c)), f64::from(source.at(x, y, c)) * factor);
                    prop_assert!((got - want).abs() <= f64::from(largest) * factor / 127.0, "{x} {y} {c}: {got} {want}");
                }
            }
        }
    }
}

#[test]
fn what_a_picture_cannot_hold_is_told() {
    let samples = vec![-1.0, f32::NAN, 1.0, 3e38, 1.0, 1.0];
    let source = image(Meaning::Primary, ["R", "G", "B"], "", 2, samples.clone());
    let mut d = source.description().clone();
    d.rgb = Some(RgbSpace { space: SRGB, encoded: false, white_luminance: Some(179.0) });
    let mut source = Memory::new(d.clone(), samples);
    let mut bytes = Vec::new();
    let codes: Vec<_> = write(&mut bytes, &mut source).expect("written").iter().map(|f| f.code).collect();
    assert_eq!(codes, ["I120", "I020", "I020"]);
    assert!(load(&bytes).expect("whole").samples().iter().all(|v| v.is_finite()));
    d.rgb = Some(RgbSpace { space: RADIANCE, encoded: false, white_luminance: None });
    let mut relative = Memory::new(d.clone(), vec![1.0; 6]);
    let codes: Vec<_> = write(Vec::new(), &mut relative).expect("written").iter().map(|f| f.code).collect();
    assert_eq!(codes, ["I113"]);
    d.rgb = Some(RgbSpace { space: SRGB, encoded: true, white_luminance: None });
    let error = write(Vec::new(), &mut Memory::new(d, vec![1.0; 6])).expect_err("encoded");
    assert!(error.to_string().contains("expected linear RGB for a Radiance picture"), "{error}");
}

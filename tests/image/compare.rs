//! `image compare`: figures of closed forms and of published pairs of colours, and exit codes.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use photopic::colorimetry::chromaticity::xyz_of_xy;
use photopic::colorimetry::rgb::SRGB;
use photopic::image::compare::{Map, Show, differences, matched, summary};
use photopic::image::{Channel, Description, Meaning, Memory};
use serde_json::Value;

fn plane(values: &[f32]) -> Memory {
    let description = Description::planes(values.len(), 1, vec![Channel::new("Y", "cd/m²", Meaning::Photopic)]);
    Memory::new(description, values.to_vec())
}

#[test]
fn figures_of_planes_are_their_definitions() {
    let nan = f32::NAN;
    let difference = |a: &[f32], b: &[f32]| differences(&mut plane(a), &mut plane(b), &[(0, 0)]).expect("memory")[0];
    let d = difference(&[2.0; 4], &[3.0; 4]);
    assert_eq!((d.mean(), d.rmse(), d.relative_rmse(), d.mean_relative()), (1.0, 1.0, 0.5, 0.5));
    // A peak of twice the error: 20 lg 2 dB.
    assert!((d.psnr_db() - 20.0 * 2.0_f64.log10()).abs() < 1e-12);
    // 3-4-5: errors 3 and 4 beside values 5 and 0, the latter in no relative figure.
    let d = difference(&[5.0, 0.0, 1.0, nan], &[2.0, 4.0, nan, 1.0]);
    assert_eq!((d.pixels, d.left_out, d.peak), (2, 2, 5.0));
    assert!((d.rmse() - 12.5_f64.sqrt()).abs() < 1e-15 && d.relative_rmse() == 1.0 && d.mean_relative() == 0.6);
    assert_eq!((d.largest, d.largest_relative), (Some((4.0, [1, 0])), Some((0.6, [0, 0]))));
    let d = difference(&[1.0, 0.0], &[1.0, 0.0]);
    assert!(d.relative_rmse() == 0.0 && d.psnr_db() == f64::INFINITY && d.largest == Some((0.0, [0, 0])));
    let black = difference(&[0.0], &[0.0]);
    assert!(black.relative_rmse() == 0.0 && black.mean_relative().is_nan());
    assert!(difference(&[0.0], &[1.0]).relative_rmse() == f64::INFINITY);
    assert!(difference(&[nan], &[1.0]).rmse().is_nan());
}

/// X, Y, Z of CIELAB (CIE 15:2018, 8.2.1.1 solved for X, Y, Z).
fn xyz([l, a, b]: [f64; 3], white: [f64; 3]) -> [f32; 3] {
    let y = (l + 16.0) / 116.0;
    let of = |t: f64| if t > 24.0 / 116.0 { t.powi(3) } else { (t - 16.0 / 116.0) * 108.0 / 841.0 };
    let f = [y + a / 500.0, y, y - b / 200.0];
    [0, 1, 2].map(|k| (white[k] * of(f[k])) as f32)
}

#[test]
fn colour_differences_are_those_of_sharma_wu_and_dalal() {
    let table = include_str!("../data/colour/ciede2000.csv");
    let rows: Vec<Vec<f64>> = table
        .lines()
        .filter(|l| l.starts_with(|c: char| c.is_ascii_digit()))
        .map(|l| l.split(',').map(|c| c.parse().expect("a number")).collect())
        .collect();
    let white = xyz_of_xy(SRGB.white).expect("D65").map(|v| 100.0 * v);
    let image = |first: usize| {
        let channels = (0..3_u8)
            .map(|k| Channel::new(["X", "Y", "Z"][usize::from(k)], "cd/m²", Meaning::Tristimulus(k)))
            .collect();
        let pixels: Vec<[f32; 3]> = rows.iter().map(|r| xyz([r[first], r[first + 1], r[first + 2]], white)).collect();
        let samples = (0..3).flat_map(|k| pixels.iter().map(move |p| p[k])).collect();
        Memory::new(Description::planes(rows.len(), 1, channels), samples)
    };
    let mut map = Map::new(Box::new(image(0)), Box::new(image(3)), Show::DeltaE { white });
    let mut got = vec![0.0; rows.len()];
    let region = photopic::image::Region { x: 0, y: 0, width: rows.len(), height: 1 };
    photopic::image::Source::read(&mut map, region, &[0], &mut got).expect("memory");
    // Hues exactly opposite: rounding decides which way round their mean is.
    let opposite = |r: &[f64]| r[1] * r[5] == r[2] * r[4] && r[1] * r[4] < 0.0;
    assert_eq!(rows.iter().filter(|r| opposite(r)).count(), 2);
    for (row, got) in rows.iter().zip(&got).filter(|(r, _)| !opposite(r)) {
        // Four decimals printed; X, Y, Z in `f32` move a* by up to 1.5 · 500/3 · 2⁻²³ in either colour.
        assert!((f64::from(*got) - row[6]).abs() < 0.5e-4 + 1e-4, "{row:?}: {got}");
    }
    let figures = summary(&mut map, &[0.0, 0.5, 1.0]).expect("memory");
    let mut sorted: Vec<f64> = got.iter().map(|v| f64::from(*v)).collect();
    sorted.sort_by(f64::total_cmp);
    assert!((figures.mean - sorted.iter().sum::<f64>() / 34.0).abs() < 1e-12 && figures.pixels == 34);
    for (got, want) in figures.quantiles.iter().zip([sorted[0], 0.5 * (sorted[16] + sorted[17]), sorted[33]]) {
        assert!((got - want).abs() < 1e-12, "{got} {want}");
    }
}

#[test]
fn bands_are_matched_by_wavelength() {
    let image = |bands: &[f64]| {
        let channels = bands.iter().enumerate().map(|(i, w)| Channel::band(format!("{i}"), "", *w)).collect();
        Description::planes(1, 1, channels)
    };
    let (pairs, alone) = matched(&image(&[400.0, 500.0, 600.0]), &image(&[600.0004, 450.0, 400.0]));
    assert_eq!((pairs, alone), (vec![(0, 2), (2, 0)], vec!["1".to_owned(), "1".to_owned()]));
}

fn photopic(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::cargo_bin("photopic")
        .expect("the binary")
        .current_dir(folder)
        .args([&["image", "compare"], arguments].concat())
        .output()
        .expect("it runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code(), text(output.stdout), text(output.stderr))
}

/// Three bands of 2 × 2 pixels, all samples `value`.
fn cube(folder: &Path, name: &str, (width, value, first): (usize, f32, u32)) {
    let bands: Vec<String> = (0..3).map(|i| (first + 5 * i).to_string()).collect();
    let header = format!(
        "ENVI\nsamples = {width}\nlines = 2\nbands = 3\ndata type = 4\nbyte order = 0\ninterleave = bsq\n\
         wavelength units = Nanometers\nwavelength = {{{}}}\ndata units = W/m2/sr/nm\n",
        bands.join(", ")
    );
    fs::write(folder.join(format!("{name}.hdr")), header).expect("written");
    fs::write(folder.join(format!("{name}.img")), value.to_le_bytes().repeat(width * 2 * 3)).expect("written");
}

#[test]
fn the_exit_code_tells_whether_images_agree() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for (name, made) in
        [("a", (2, 1.0, 550)), ("b", (2, 1.25, 550)), ("c", (3, 1.0, 550)), ("d", (2, 1.0, 545)), ("uv", (2, 1.0, 200))]
    {
        cube(folder, name, made);
    }
    let (code, document, stderr) = photopic(folder, &["a.hdr", "a.hdr", "--json", "--tolerance", "0"]);
    assert_eq!(code, Some(0), "{stderr}");
    let document: Value = serde_json::from_str(&document).expect("JSON");
    let result = &document["results"][0];
    assert_eq!(result["photopic"]["rmse"], 0.0);
    assert_eq!(result["photopic"]["psnr_db"], Value::Null);
    assert_eq!((&result["delta_e_2000"]["max"], &result["passes"]), (&0.0.into(), &true.into()));
    // A quarter more everywhere: 0.25 in every relative figure.
    let (code, document, _) = photopic(folder, &["a.hdr", "b.hdr", "--json", "--tolerance", "0.24"]);
    let document: Value = serde_json::from_str(&document).expect("JSON");
    let result = &document["results"][0];
    assert_eq!((code, &result["passes"], &result["metric"]), (Some(1), &false.into(), &"relative-rmse".into()));
    for plane in [&result["photopic"], &result["planes"][0], &result["planes"][2]] {
        for key in ["relative_rmse", "mean_relative", "max_relative"] {
            // Luminance is rounded to f32 in either image.
            assert!((plane[key].as_f64().expect("a number") - 0.25).abs() < 2e-7, "{plane}");
        }
    }
    assert_eq!(photopic(folder, &["a.hdr", "b.hdr", "--tolerance", "0.26"]).0, Some(0));
    // 20 lg 4 = 12.04 dB.
    assert_eq!(photopic(folder, &["a.hdr", "b.hdr", "--metric", "psnr", "--tolerance", "12.05"]).0, Some(1));
    assert_eq!(photopic(folder, &["a.hdr", "b.hdr", "--metric", "psnr", "--tolerance", "12.03"]).0, Some(0));
    let (code, _, stderr) = photopic(folder, &["a.hdr", "c.hdr"]);
    assert!(code == Some(2) && stderr.contains("c.hdr: found 3 × 2 pixels; expected 2 × 2 as in a.hdr"), "{stderr}");
    let (code, text, stderr) = photopic(folder, &["a.hdr", "d.hdr"]);
    assert!(code == Some(0) && stderr.contains("I051") && text.contains("luminance"), "{text} {stderr}");
    let (code, table, stderr) = photopic(folder, &["uv.hdr", "uv.hdr", "--csv"]);
    assert!(code == Some(0) && table.lines().count() == 4 && stderr.contains("I053"), "{table} {stderr}");
    let (code, _, stderr) = photopic(folder, &["uv.hdr", "uv.hdr", "--metric", "delta-e-mean"]);
    assert!(code == Some(2) && stderr.contains("--metric delta-e-mean"), "{stderr}");
}

#[test]
fn maps_are_images() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    cube(folder, "a", (2, 1.0, 550));
    cube(folder, "b", (2, 0.5, 550));
    let map = ["a.hdr", "b.hdr", "--map", "map.npy", "--map-of", "relative"];
    let (code, _, stderr) = photopic(folder, &map);
    assert_eq!(code, Some(0), "{stderr}");
    let bytes = fs::read(folder.join("map.npy")).expect("a map");
    let samples: Vec<f32> =
        bytes[bytes.len() - 16..].chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().expect("four"))).collect();
    assert_eq!(samples, [-0.5; 4]);
    let (code, _, stderr) = photopic(folder, &["a.hdr", "b.hdr", "--map", "map.jpg"]);
    assert!(code == Some(2) && stderr.contains("map.jpg: expected a name ending in"), "{stderr}");
    let (code, _, stderr) = photopic(folder, &["a.hdr", "b.hdr", "--map", "a.hdr"]);
    assert!(code == Some(2) && stderr.contains("input"), "{stderr}");
}

//! `photopic capture` as a user meets it: photographs made here, answers, what is wrong with a set, exit codes.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use assert_cmd::Command;
use exif::experimental::Writer;
use exif::{Field, In, Rational, Tag, Value as Exif};
use image::{DynamicImage, ExtendedColorType, ImageEncoder, ImageFormat};
use serde_json::Value;
use tempfile::TempDir;

use crate::common::shared;

/// Runs a verb in a folder; exit code, standard output and standard error.
pub(crate) fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("photopic").expect("the program");
    let output = command.current_dir(folder).arg("capture").args(arguments).output().expect("it runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("an exit code"), text(output.stdout), text(output.stderr))
}

pub(crate) fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("one JSON document")
}

pub(crate) fn has_finding(document: &Value, code: &str) -> bool {
    document["findings"].as_array().expect("findings").iter().any(|f| f["code"] == code)
}

const SIDE: u32 = 48;

/// Of a scene of radiances from 10⁻³ to 1 by a camera of γ = 2: codes from 0 to `top`.
fn ramp(time_s: f64, top: f64) -> impl Iterator<Item = f64> {
    (0..SIDE * SIDE).map(move |i| {
        let radiance = 10.0_f64.powf(-3.0 * f64::from(i) / f64::from(SIDE * SIDE));
        (top * (radiance * time_s).sqrt()).clamp(0.0, top).round()
    })
}

fn eight(time_s: f64) -> DynamicImage {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let codes = ramp(time_s, 255.0).map(|z| z as u8).collect();
    image::GrayImage::from_raw(SIDE, SIDE, codes).expect("a picture").into()
}

fn sixteen(time_s: f64) -> DynamicImage {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 65535")]
    let codes = ramp(time_s, 65535.0).map(|z| z as u16).collect();
    DynamicImage::ImageLuma16(image::ImageBuffer::from_raw(SIDE, SIDE, codes).expect("a picture"))
}

/// A JPEG, with an exposure time in its EXIF data or without; either way there are EXIF data.
fn jpeg(picture: &DynamicImage, time: Option<Rational>) -> Vec<u8> {
    let maker = Field { tag: Tag::Make, ifd_num: In::PRIMARY, value: Exif::Ascii(vec![b"none".to_vec()]) };
    let time = time.map(|t| Field { tag: Tag::ExposureTime, ifd_num: In::PRIMARY, value: Exif::Rational(vec![t]) });
    let mut writer = Writer::new();
    writer.push_field(&maker);
    time.iter().for_each(|t| writer.push_field(t));
    let mut block = Cursor::new(Vec::new());
    writer.write(&mut block, false).expect("EXIF");
    let mut plain = Vec::new();
    let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut plain, 100);
    encoder.write_image(picture.as_bytes(), SIDE, SIDE, ExtendedColorType::L8).expect("a JPEG");
    let payload = [b"Exif\0\0", block.into_inner().as_slice()].concat();
    let length = u16::try_from(payload.len() + 2).expect("a short segment").to_be_bytes();
    [&plain[..2], &[0xff, 0xe1], &length, &payload, &plain[2..]].concat()
}

/// Three photographs of the ramp as `a.png`, `b.png`, `c.png` and their times in `times.csv`.
fn stack(picture: impl Fn(f64) -> DynamicImage) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, time_s) in TIMES {
        picture(time_s).save_with_format(folder.path().join(name), ImageFormat::Png).expect("a PNG");
    }
    fs::write(folder.path().join("times.csv"), "a.png,1/16\nb.png,0.25\nc.png,1\n").expect("times");
    folder
}

const TIMES: [(&str, f64); 3] = [("a.png", 1.0 / 16.0), ("b.png", 0.25), ("c.png", 1.0)];
const RESPONSE: [&str; 6] = ["response", "a.png", "b.png", "c.png", "--times", "times.csv"];

/// ln g at code 64 of a camera of γ = 2, whose ln g is 2 ln(z/128).
fn is_square(result: &Value) {
    let curve = &result["response"][0];
    let (value, error) =
        (curve["ln_g"][64].as_f64().expect("ln g"), curve["standard_errors"][64].as_f64().expect("its error"));
    let truth = 2.0 * 0.5_f64.ln();
    assert!((value - truth).abs() < 4.0 * error && error < 0.02, "{value} ± {error}, expected {truth}");
}

#[test]
fn times_come_from_a_list_from_exif_or_not_at_all() {
    for folder in [stack(eight), stack(sixteen)] {
        let (code, out, _) = run(folder.path(), &[&RESPONSE[..], &["--json"]].concat());
        assert_eq!(code, 0);
        is_square(&json(&out)["results"][0]);
    }
    let folder = stack(eight);
    let exif = [("a.jpg", (1, 16)), ("b.jpg", (1, 4)), ("c.jpg", (1, 1))];
    for (name, (num, denom)) in exif {
        let picture = eight(f64::from(num) / f64::from(denom));
        fs::write(folder.path().join(name), jpeg(&picture, Some(Rational { num, denom }))).expect("written");
    }
    let (code, out, _) = run(folder.path(), &["response", "a.jpg", "b.jpg", "c.jpg", "--json"]);
    assert_eq!(code, 0);
    is_square(&json(&out)["results"][0]);
    // One without a time is left out, and said; with one left nothing can be done.
    fs::write(folder.path().join("b.jpg"), jpeg(&eight(0.25), None)).expect("written");
    let (code, out, error) = run(folder.path(), &["response", "a.jpg", "b.jpg", "c.jpg", "--json"]);
    assert_eq!(code, 2);
    assert!(
        has_finding(&json(&out), "K001") && json(&out)["results"][0]["exposures"].as_array().map(Vec::len) == Some(2)
    );
    assert!(error.contains("found no exposure time for b.jpg; expected"), "{error}");
    let (code, out, error) = run(folder.path(), &["response", "a.png", "b.png"]);
    assert!(code == 2 && out.is_empty() && error.contains("found no stack of two or more exposures"), "{error}");
}

#[test]
fn a_missing_exposure_leaves_the_others() {
    let folder = stack(eight);
    let (code, out, error) =
        run(folder.path(), &["response", "a.png", "b.png", "c.png", "d.png", "--times", "times.csv", "--json"]);
    let document = json(&out);
    assert!(code == 2 && has_finding(&document, "K001") && error.contains("d.png: cannot be read"), "{error}");
    is_square(&document["results"][0]);
    let small = image::GrayImage::new(7, 7);
    small.save(folder.path().join("d.png")).expect("written");
    fs::write(folder.path().join("times.csv"), "0.0625\n0.25\n1\n2\n").expect("times");
    let (code, out, error) =
        run(folder.path(), &["response", "a.png", "b.png", "c.png", "d.png", "--times", "times.csv", "--json"]);
    assert!(code == 2 && error.contains("found 7 × 7 pixels in 1 channel(s) of d.png; expected 48 × 48"), "{error}");
    is_square(&json(&out)["results"][0]);
}

#[test]
fn stacks_that_cannot_be_are_refused_in_one_message() {
    let folder = stack(eight);
    let refused = |arguments: &[&str], words: &str| {
        let (code, out, error) = run(folder.path(), arguments);
        assert!(code == 2 && out.is_empty() && error.contains(words), "{arguments:?}: {error}");
        assert_eq!(error.trim_end().lines().count(), 1, "{error}");
    };
    // Swapped photographs.
    let swapped = ["response", "c.png", "b.png", "a.png", "--times", "swapped.csv"];
    fs::write(folder.path().join("swapped.csv"), "1/16\n1/4\n1\n").expect("times");
    refused(&swapped, "found a.png (1 s) darker than c.png (0.0625 s)");
    refused(
        &["merge", "c.png", "b.png", "a.png", "--times", "swapped.csv", "-o", "x.exr"],
        "were two photographs or their times swapped?",
    );
    for (code, words) in [(0, "(all are black)"), (255, "(all are white)")] {
        let flat = image::GrayImage::from_pixel(SIDE, SIDE, image::Luma([code]));
        TIMES.iter().for_each(|(name, _)| flat.save(folder.path().join(name)).expect("written"));
        refused(&RESPONSE, words);
        refused(&["merge", "a.png", "b.png", "c.png", "--times", "times.csv", "-o", "x.exr"], words);
        let linear = ["merge", "a.png", "b.png", "c.png", "--times", "times.csv", "--linear", "-o", "x.exr"];
        refused(&linear, "found no sample within the range in photographs");
    }
    assert!(!folder.path().join("x.exr").exists());
    // A board that is never found: each photograph is named, and what that leaves.
    let (code, out, error) = run(folder.path(), &["calibrate", "--board", "9x6", "a.png", "b.png", "c.png"]);
    assert!(code == 2 && out.is_empty() && error.contains("found the board in 0 view(s)"), "{error}");
    assert!(TIMES.iter().all(|(name, _)| error.contains(&format!("found no board in {name}; expected"))), "{error}");
    refused(&["response", "nothing.toml"], "nothing.toml: cannot be read");
}

#[test]
fn a_wrong_time_is_named() {
    let folder = stack(eight);
    eight(0.5).save(folder.path().join("d.png")).expect("written");
    fs::write(folder.path().join("times.csv"), "1/16\n1/4\n1\n0.8\n").expect("times");
    let (code, out, _) =
        run(folder.path(), &["response", "a.png", "b.png", "c.png", "d.png", "--times", "times.csv", "--json"]);
    let document = json(&out);
    let named = |f: &&Value| f["code"] == "K002" && f["location"]["item"] == "d.png";
    assert!(code == 0 && document["findings"].as_array().expect("findings").iter().any(|f| named(&f)), "{document}");
}

#[test]
fn boards_calibrate_and_what_shows_none_is_left_out() {
    let Some(folder) = shared("capture/chessboard_left") else { return };
    let own = stack(eight);
    let views: Vec<String> = (1..=10).map(|n| folder.join(format!("left{n:02}.jpg")).display().to_string()).collect();
    let mut arguments = vec!["calibrate", "--board", "9x6", "--json", "a.png"];
    arguments.extend(views.iter().map(String::as_str));
    let (code, out, error) = run(own.path(), &arguments);
    let document = json(&out);
    assert!(code == 2 && has_finding(&document, "K001"), "{error}");
    let fx = document["results"][0]["intrinsics"]["fx"].as_f64().expect("fx");
    let sigma = document["results"][0]["standard_errors"]["intrinsics"]["fx"].as_f64().expect("its error");
    // OpenCV's of all 25 views; that its own error is no larger is seen to by the views being among them.
    assert!((fx - 518.621).abs() < 4.0 * sigma, "{fx} ± {sigma}");
}

//! `image` as a user calls it: files by content, exit codes, and nothing half-written.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn photopic() -> Command {
    Command::cargo_bin("photopic").expect("the binary")
}

/// A cube of 3 × 2 pixels with bands at 550, 555, 560 nm; of each pixel only 555 nm has light: 1 to 6 W/(m²·sr·nm).
fn cube(folder: &Path) {
    let header = "ENVI\nsamples = 3\nlines = 2\nbands = 3\ndata type = 4\nbyte order = 0\ninterleave = bip\n\
        wavelength units = Nanometers\nwavelength = {550, 555, 560}\ndata units = W/m2/sr/nm\n";
    fs::write(folder.join("cube.hdr"), header).expect("written");
    let samples = (1_u8..7).flat_map(|v| [0.0, f32::from(v), 0.0]);
    fs::write(folder.join("cube.img"), samples.flat_map(f32::to_le_bytes).collect::<Vec<_>>()).expect("written");
}

/// Range and mean of the first channel, by `image info --json`.
fn info(folder: &Path, image: &str) -> Value {
    let out = photopic().current_dir(folder).args(["image", "info", image, "--json"]).assert().success();
    serde_json::from_slice(&out.get_output().stdout).expect("JSON")
}

#[test]
fn luminance_in_every_format_is_that_of_the_pixels() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path());
    for out in ["y.exr", "y.hdr", "y.npy"] {
        // The header and the data are the same image.
        for input in ["cube.hdr", "cube.img"] {
            photopic().current_dir(&folder).args(["image", "convert", input, "-o", out]).assert().success();
            let result = &info(folder.path(), out)["results"][0];
            // K_m V(555) Δλ = 683.002 · 1 · 5 cd/m² per W/(m²·sr·nm): CIE 018:2019.
            for (key, want) in [("min", 1.0), ("mean", 3.5), ("max", 6.0)] {
                let got = result["channels"][0][key].as_f64().expect("a number");
                assert!((got - want * 683.002 * 5.0).abs() < 1e-7 * got, "{out} of {input}: {key} {got}");
            }
        }
    }
    let exr = info(folder.path(), "y.exr");
    assert_eq!(exr["results"][0]["attributes"]["photopic:rule"], "summation");
    assert_eq!(exr["results"][0]["attributes"]["photopic:k_m_lm_per_w"], "683.002");
    assert_eq!(exr["inputs"][0]["sha256"].as_str().map(str::len), Some(64));
    let cube = info(folder.path(), "cube.hdr");
    assert_eq!(cube["results"][0]["quantity"], "radiance");
    assert_eq!(cube["inputs"].as_array().map(Vec::len), Some(2), "header and data");
}

#[test]
fn info_shows_the_image_where_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path());
    let run = |look: &str, no_color: &str| {
        let args = ["image", "info", "cube.hdr", look];
        let out = photopic().current_dir(&folder).args(args).env("NO_COLOR", no_color).assert().success();
        String::from_utf8(out.get_output().stdout.clone()).expect("text")
    };
    let plain = {
        let out = photopic().current_dir(&folder).args(["image", "info", "cube.hdr"]).assert().success();
        String::from_utf8(out.get_output().stdout.clone()).expect("text")
    };
    // In a pipe it is shown only where that is said; the figures stand before it.
    assert_eq!(run("--look", ""), plain);
    let shown = run("--look=always", "");
    assert!(shown.starts_with(&plain) && shown.contains('▀') && shown.contains("cd/m²"), "{shown}");
    let without = run("--look=always", "1");
    assert!(without.starts_with(&plain) && without.len() > plain.len() && !without.contains('\x1b'), "{without}");
    // An image without luminance is described all the same.
    fs::write(
        folder.path().join("bare.hdr"),
        "ENVI\nsamples = 3\nlines = 2\nbands = 3\ndata type = 4\nbyte order = 0\ninterleave = bip\n",
    )
    .expect("written");
    fs::copy(folder.path().join("cube.img"), folder.path().join("bare.img")).expect("copied");
    photopic().current_dir(&folder).args(["image", "info", "bare.hdr", "--look=always"]).assert().success();
}

#[test]
fn standard_streams_carry_images() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path());
    let args = ["image", "convert", "cube.hdr", "-o", "-", "--format", "exr", "--to", "cube"];
    let exr = photopic().current_dir(&folder).args(args).assert().success().get_output().stdout.clone();
    assert!(exr.starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    let args = ["image", "convert", "-", "-o", "-", "--format", "npy", "--to", "luminance"];
    let npy = photopic().args(args).write_stdin(exr).assert().success().get_output().stdout.clone();
    let first = npy[npy.len() - 24..][..4].try_into().expect("four bytes");
    assert!((f32::from_le_bytes(first) - 683.002 * 5.0).abs() < 1e-3);
}

#[test]
fn what_cannot_run_says_why_and_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path());
    let whole = fs::read(folder.path().join("cube.img")).expect("readable");
    fs::write(folder.path().join("short.img"), &whole[..71]).expect("written");
    fs::copy(folder.path().join("cube.hdr"), folder.path().join("short.hdr")).expect("copied");
    fs::write(folder.path().join("text.txt"), "no image").expect("written");
    fs::write(folder.path().join("empty.exr"), "").expect("written");
    fs::copy(folder.path().join("cube.hdr"), folder.path().join("alone.hdr")).expect("copied");
    for (args, want) in [
        (vec!["short.hdr", "-o", "y.exr"], "short.img: found 71 bytes; expected 72"),
        (vec!["text.txt", "-o", "y.exr"], "text.txt: found neither an OpenEXR"),
        (vec!["empty.exr", "-o", "y.exr"], "empty.exr: found an empty input"),
        (vec!["alone.hdr", "-o", "y.exr"], "alone.hdr: found no data beside it"),
        (vec!["none.hdr", "-o", "y.exr"], "none.hdr: cannot be read"),
        (vec!["cube.hdr", "-o", "y.jpg"], "y.jpg: expected a name ending in .exr"),
        (vec!["cube.hdr", "-o", "cube.hdr"], "would overwrite an input"),
        (vec!["cube.hdr", "-o", "none/y.exr"], "none/y.exr: cannot be written"),
        (vec!["cube.hdr", "-o", "y.exr", "--to", "srgb-encoded"], "expected --white-luminance"),
        (vec!["cube.hdr", "-o", "y.exr", "--illuminant", "D65"], "takes no illuminant"),
        (vec!["cube.hdr", "-o", "y.exr", "--unit", "W/m2/nm", "--quantity", "radiance"], "expected a unit of radiance"),
        (vec!["cube.hdr", "-o", "y.exr", "--rule", "lines"], "expected summation, trapezoid or exact"),
    ] {
        let out = photopic().current_dir(&folder).args(["image", "convert"]).args(&args).assert().code(2);
        let stderr = String::from_utf8_lossy(&out.get_output().stderr).into_owned();
        assert!(stderr.contains(want), "{args:?}: {stderr}");
        assert!(!folder.path().join("y.exr").exists(), "{args:?}");
    }
    let left = fs::read_dir(&folder)
        .expect("the folder")
        .filter(|e| e.as_ref().expect("an entry").file_name().to_string_lossy().starts_with(".photopic-"));
    assert_eq!(left.count(), 0, "no temporary file is left");
    assert_eq!(fs::read(folder.path().join("cube.img")).expect("readable"), whole);
    // One bad file of several: the rest is done.
    let args = ["image", "info", "short.hdr", "cube.hdr", "--json"];
    let out = photopic().current_dir(&folder).args(args).assert().code(2);
    let document: Value = serde_json::from_slice(&out.get_output().stdout).expect("JSON");
    assert_eq!(document["results"].as_array().map(Vec::len), Some(1));
    assert_eq!(document["findings"][0]["code"], "I000");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path());
    for format in ["exr", "npy"] {
        let args = ["image", "convert", "cube.hdr", "-o", "/dev/full", "--format", format];
        let out = photopic().current_dir(&folder).args(args).assert().code(2);
        let stderr = String::from_utf8_lossy(&out.get_output().stderr).into_owned();
        assert!(stderr.contains("/dev/full: cannot be written: No space left on device"), "{stderr}");
    }
}

#[test]
fn a_folder_of_pictures_is_a_cube() {
    let folder = tempfile::tempdir().expect("a folder");
    let stack = folder.path().join("stack");
    fs::create_dir(&stack).expect("made");
    for (name, value) in [("w550nm.png", 64_u8), ("w555nm.png", 164), ("w560nm.png", 64)] {
        image::GrayImage::from_pixel(2, 2, image::Luma([value])).save(stack.join(name)).expect("saved");
    }
    let args = ["image", "convert", "stack", "-o", "y.npy", "--dark", "64", "--gain", "0.01", "--unit", "W/m2/sr/nm"];
    photopic().current_dir(&folder).args(args).assert().success();
    // (164 − 64) · 0.01 = 1 W/(m²·sr·nm) at 555 nm.
    let max = info(folder.path(), "y.npy")["results"][0]["channels"][0]["max"].as_f64().expect("a number");
    assert!((max - 683.002 * 5.0).abs() < 1e-3, "{max}");
    fs::write(folder.path().join("list.csv"), "file,wavelength_nm\nw555nm.png,550\nw550nm.png,555\n").expect("written");
    let args = ["image", "info", "stack", "--wavelengths", "list.csv"];
    let out = photopic().current_dir(&folder).args(args).assert().code(2);
    let stderr = String::from_utf8_lossy(&out.get_output().stderr).into_owned();
    assert!(stderr.contains("w560nm.png: found no wavelength for it"), "{stderr}");
}

#[test]
fn a_weighting_of_ones_over_its_range_is_the_radiance() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path());
    fs::write(folder.path().join("flat.csv"), "nm,w\n500,1\n600,1\n").expect("written");
    let args = ["image", "convert", "cube.hdr", "-o", "w.npy", "--weighting", "flat.csv"];
    photopic().current_dir(&folder).args(args).assert().success();
    // 6 W/(m²·sr·nm) in one sample of 5 nm.
    assert_eq!(info(folder.path(), "w.npy")["results"][0]["channels"][0]["max"], 30.0);
}

#[test]
fn pictures_in_colours_go_in_and_out() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path());
    let run = |args: &[&str]| photopic().current_dir(&folder).args(["image", "convert"]).args(args).assert();
    let number = |image: &str, channel: usize, key: &str| {
        info(folder.path(), image)["results"][0]["channels"][channel][key].as_f64().expect("a number")
    };
    // Light to Radiance and back is its luminance: 6 · 683.002 · 5 cd/m², within the half unit of an 8-bit mantissa.
    run(&["cube.hdr", "-o", "cube.pic", "--to", "luminance"]).success();
    run(&["cube.pic", "-o", "back.exr"]).success();
    let want = 6.0 * 683.002 * 5.0;
    assert!((number("back.exr", 0, "max") / want - 1.0).abs() < 1.0 / 256.0);
    assert_eq!(info(folder.path(), "back.exr")["results"][0]["channels"][0]["unit"], "cd/m²");
    // XYZ through its own format.
    run(&["cube.hdr", "-o", "xyz.hdr", "--format", "radiance", "--to", "xyz"]).success();
    assert!((number("xyz.hdr", 1, "max") / want - 1.0).abs() < 1.0 / 128.0);
    // A picture needs a white, and then is one.
    image::RgbImage::from_pixel(2, 2, image::Rgb([128, 128, 128])).save(folder.path().join("grey.png")).expect("saved");
    run(&["grey.png", "-o", "y.npy", "--white-luminance", "100"]).success();
    assert!((number("y.npy", 0, "mean") - 21.5861).abs() < 5e-5, "IEC 61966-2-1");
    run(&["grey.png", "-o", "again.png"]).success();
    let picture = image::open(folder.path().join("again.png")).expect("a PNG").into_rgb8();
    assert!(picture.pixels().all(|p| p.0 == [128; 3]));
    run(&["cube.hdr", "-o", "view.png", "--tone", "reinhard"]).success();
    let out = run(&["cube.hdr", "-o", "cut.png", "--white-luminance", "100"]).success();
    assert!(String::from_utf8_lossy(&out.get_output().stderr).contains("I121"));
    for (args, want) in [
        (vec!["grey.png", "-o", "y.exr", "--to", "melanopic"], "from which melanopic does not follow"),
        (vec!["grey.png", "-o", "y.exr", "--illuminant", "D65"], "takes no illuminant"),
        (vec!["grey.png", "-o", "y.png", "--to", "luminance"], "expected encoded RGB for a PNG picture"),
        (vec!["cube.hdr", "-o", "y.exr", "--tone", "filmic"], "--tone: found luminance (cie-1924-v), a measurement"),
        (vec!["cube.hdr", "-o", "y.png", "--tone", "linear"], "expected --white-luminance"),
        (vec!["cube.hdr", "-o", "y.png", "--exposure-ev", "2"], "--tone"),
        (vec!["cube.pic", "-o", "y.exr", "--white-luminance", "9"], "is in cd/m² already"),
    ] {
        let out = run(&args).code(2);
        let stderr = String::from_utf8_lossy(&out.get_output().stderr).into_owned();
        assert!(stderr.contains(want), "{args:?}: {stderr}");
        assert!(!folder.path().join(args[2]).exists(), "{args:?}");
    }
}

#[test]
fn a_trade_says_what_fewer_pixels_and_bands_cost_and_convert_makes_them() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path());
    let run = |arguments: &[&str]| photopic().current_dir(&folder).args(arguments).assert();
    let trade = ["trade", "image", "cube.hdr", "--repeats", "1", "--error", "50%", "--settings", "s.toml", "--json"];
    let out = run(&trade).success().get_output().stdout.clone();
    let result = serde_json::from_slice::<Value>(&out).expect("JSON")["results"][0].clone();
    let trials = result["trials"].as_array().expect("trials").clone();
    let is = |t: &&Value| {
        t["settings"]["block"] == "2" && t["settings"]["bands"] == "own" && t["settings"]["precision"] == "f32"
    };
    let error =
        trials.iter().find(is).expect("it was tried")["errors"]["luminance"]["error"].as_f64().expect("a number");
    // 1 2 3 over 4 5 6: the means 3 of 1, 2, 4, 5 and 4.5 of 3 and 6, against a mean of 3.5.
    let expected = (14.5_f64 / 6.0).sqrt() / 3.5;
    assert!((error - expected).abs() < 1e-6, "{error}, expected {expected}");
    assert!(fs::read_to_string(folder.path().join("s.toml")).expect("written").contains("[image]\nblock = "));
    fs::write(folder.path().join("two.toml"), "[image]\nblock = 2\nhalf = true\n").expect("written");
    for option in [["--block", "2"], ["--settings", "two.toml"]] {
        run(&[&["image", "convert", "cube.hdr", "-o", "y.exr"][..], &option].concat()).success();
        let y = info(folder.path(), "y.exr")["results"][0].clone();
        for (key, want) in [("min", 3.0), ("max", 4.5)] {
            let got = y["channels"][0][key].as_f64().expect("a number");
            // Half precision has 11 bits.
            assert!((got / (want * 683.002 * 5.0) - 1.0).abs() < 5e-4, "{option:?} {key} {got}");
        }
    }
    // Light at 555 nm alone is half as much in the mean over 550–555 nm.
    let few = ["image", "convert", "cube.hdr", "-o", "few.npy", "--to", "cube", "--bands", "2", "--filter", "averaged"];
    run(&few).success();
    assert_eq!(info(folder.path(), "few.npy")["results"][0]["channels"][0]["max"], 3.0);
    let refused = [
        (
            vec!["image", "convert", "cube.hdr", "-o", "x.exr", "--bands", "9"],
            "found 9 bands asked for of an image of 3",
        ),
        (vec!["image", "convert", "cube.hdr", "-o", "x.exr", "--block", "0"], "expected 1 or more"),
        (vec!["trade", "image", "y.exr"], "the image has 0 bands; expected a spectral image of 3 or more"),
        (vec!["trade", "image", "few.npy", "--wavelengths", "500:10"], "the image has 2 bands"),
    ];
    for (arguments, expected) in refused {
        run(&arguments).code(2).stderr(predicates::str::contains(expected));
    }
}

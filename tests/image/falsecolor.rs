//! `image falsecolor` as a user calls it: pictures whose colours are those of the legend, and refusals.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use photopic::plot::{ColourMap, ColourRange};
use serde_json::{Value, json};

fn photopic() -> Command {
    Command::cargo_bin("photopic").expect("the binary")
}

/// One band at 555 nm between two dark ones: 1 to 6 W/(m²·sr·nm) in 6 × 1 pixels, or in as many rows.
fn cube(folder: &Path, rows: usize) {
    let header = format!(
        "ENVI\nsamples = 6\nlines = {rows}\nbands = 3\ndata type = 4\nbyte order = 0\ninterleave = bip\n\
        wavelength units = Nanometers\nwavelength = {{550, 555, 560}}\ndata units = W/m2/sr/nm\n"
    );
    fs::write(folder.join("cube.hdr"), header).expect("written");
    let samples = (0..rows).flat_map(|_| 1_u8..7).flat_map(|v| [0.0, f32::from(v), 0.0]);
    fs::write(folder.join("cube.img"), samples.flat_map(f32::to_le_bytes).collect::<Vec<_>>()).expect("written");
}

#[test]
fn every_pixel_has_the_colour_of_its_value() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path(), 1);
    let args = ["image", "falsecolor", "cube.hdr", "-o", "y.png", "--limits", "0:25000", "--scale", "linear"];
    photopic().current_dir(&folder).args(args).assert().success();
    let picture = image::open(folder.path().join("y.png")).expect("a picture").to_rgb8();
    let range = ColourRange { low: 0.0, high: 25000.0, logarithmic: false };
    for i in 0..6_u32 {
        // Each pixel is 80 wide; the picture begins at 14, 58. K_m V(555) 5 nm per sample (CIE 018:2019).
        let value = f64::from((f64::from(i + 1) * 683.002 * 5.0) as f32);
        for at in [0, 40, 79] {
            let got = picture.get_pixel(14 + 80 * i + at, 58 + at);
            assert_eq!(got.0, range.colour(ColourMap::Viridis, value), "pixel {i} at {at}");
        }
    }
}

#[test]
fn contours_and_legend_are_told_and_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path(), 2);
    let run = |more: &[&str]| {
        let args = ["image", "falsecolor", "cube.hdr", "--scale", "linear", "--limits", "0:25000", "--map", "inferno"];
        photopic().current_dir(&folder).args(args).args(more).assert().success().get_output().stdout.clone()
    };
    let told: Value =
        serde_json::from_slice(&run(&["-o", "y.svg", "--json", "--contours=5000,12000"])).expect("a document");
    let result = &told["results"][0];
    for (key, want) in [
        ("range", json!([0.0, 25000.0])),
        ("contours", json!([5000.0, 12000.0])),
        ("scale", json!("linear")),
        ("map", json!("inferno")),
        ("unit", json!("cd/m²")),
        ("output", json!("y.svg")),
        ("width_px", json!(6)),
        ("height_px", json!(2)),
        ("nan", json!(0)),
    ] {
        assert_eq!(result[key], want, "{key}");
    }
    // K_m V(555) 5 nm = 3415.01 cd/m² per sample, 1 to 6 of them, stored as floats.
    for (key, want) in [("min", 1.0), ("mean", 3.5), ("max", 6.0)] {
        let got = result["luminance_cd_per_m2"][key].as_f64().expect("a number");
        assert!((got / (want * 683.002 * 5.0) - 1.0).abs() < 1e-7, "{key}: {got}");
    }
    assert_eq!(told["inputs"].as_array().map(Vec::len), Some(2), "header and data");
    let svg = fs::read_to_string(folder.path().join("y.svg")).expect("text");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for text in ["cube.hdr: luminance", "cd/m²", "25000"] {
        assert!(svg.contains(text), "{text}");
    }
    // A line runs from the middle of the first row to that of the second, where the luminance between two middles is that of
    // the level; a pixel is 800 tenths wide, and the picture begins at 140, 580.
    for level in [5000.0, 12000.0] {
        let x = 140.0 + 800.0 * (level / (683.002 * 5.0) - 0.5);
        assert!(svg.contains(&format!("points=\"{x:.0},980 {x:.0},1780 \"")), "{level}");
    }
    // Without levels they are at round values; the lines are in the picture, too.
    run(&["-o", "plain.png"]);
    let told: Value = serde_json::from_slice(&run(&["-o", "lines.png", "--json", "--contours"])).expect("a document");
    let levels = told["results"][0]["contours"].as_array().expect("a list").clone();
    let at = |v: &Value| v.as_f64().expect("a number");
    assert!(!levels.is_empty() && levels.iter().all(|v| (0.0..=25000.0).contains(&at(v))), "{levels:?}");
    let pixels = |name: &str| image::open(folder.path().join(name)).expect("a picture").to_rgb8();
    assert_ne!(pixels("plain.png"), pixels("lines.png"));
}

#[test]
fn without_a_terminal_or_a_name_it_says_what_is_missing() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path(), 1);
    for (args, want) in [
        (vec![], "expected -o FILE.png"),
        (vec!["-o", "y.jpg"], "expected a name ending in .png or .svg"),
        (vec!["-o", "y.png", "--limits", "5:1"], "expected the lower value first"),
        (vec!["-o", "y.png", "--limits", "nan:1"], "expected LOW:HIGH"),
        (vec!["-o", "y.png", "--reflectance"], "expected an illuminant"),
    ] {
        let out =
            photopic().current_dir(&folder).args(["image", "falsecolor", "cube.hdr"]).args(&args).assert().code(2);
        let stderr = String::from_utf8_lossy(&out.get_output().stderr).into_owned();
        assert!(stderr.contains(want), "{args:?}: {stderr}");
        assert!(!folder.path().join("y.png").exists(), "{args:?}");
    }
    let args = ["image", "falsecolor", "cube.hdr", "--look=always"];
    let out = photopic().current_dir(&folder).args(args).env_remove("NO_COLOR").assert().success();
    assert!(String::from_utf8_lossy(&out.get_output().stdout).contains('▀'));
    let out = photopic().current_dir(&folder).args(args).env("NO_COLOR", "1").assert().success();
    assert!(!out.get_output().stdout.contains(&0x1b));
}

//! `image falsecolor` as a user calls it: pictures whose colours are those of the legend, and refusals.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use photopic::plot::{ColourMap, ColourRange};

fn photopic() -> Command {
    Command::cargo_bin("photopic").expect("the binary")
}

/// One band at 555 nm between two dark ones: 1 to 6 W/(m²·sr·nm) in 6 × 1 pixels.
fn cube(folder: &Path) {
    let header = "ENVI\nsamples = 6\nlines = 1\nbands = 3\ndata type = 4\nbyte order = 0\ninterleave = bip\n\
        wavelength units = Nanometers\nwavelength = {550, 555, 560}\ndata units = W/m2/sr/nm\n";
    fs::write(folder.join("cube.hdr"), header).expect("written");
    let samples = (1_u8..7).flat_map(|v| [0.0, f32::from(v), 0.0]);
    fs::write(folder.join("cube.img"), samples.flat_map(f32::to_le_bytes).collect::<Vec<_>>()).expect("written");
}

#[test]
fn every_pixel_has_the_colour_of_its_value() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path());
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
fn without_a_terminal_or_a_name_it_says_what_is_missing() {
    let folder = tempfile::tempdir().expect("a folder");
    cube(folder.path());
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

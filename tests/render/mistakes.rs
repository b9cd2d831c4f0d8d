//! Wrong scenes: each is told once, at the place of what is wrong, in the words and the units that were written.

use predicates::str::contains;

use crate::cli::{json, photopic, scene};

const SENSOR: &str = "[[sensor]]\nname = \"p\"\nilluminance = { at = [0, 0, 0] }\n";
const LAMP: &str = "[[light]]\nname = \"l\"\npoint = { at = [0, 0, 2], flux = \"800 lm\" }\n";

/// Checks a scene that begins with `text`, on line 1; the whole message after the file's name is `message`, or begins with it.
fn refused(text: &str, message: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = scene(&folder, &format!("{text}\n{SENSOR}"));
    let out = photopic().arg("render").arg("--check").arg(&path).output().expect("it runs");
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(2), "{text}: {said}");
    assert!(said.contains(&format!("scene.toml:{message}")), "{text}: {said}, not {message}");
}

/// What the scene begins with, and where and how it is told.
fn all_refused(cases: &[(&str, &str)]) {
    cases.iter().for_each(|(text, message)| refused(text, message));
}

#[test]
fn a_number_without_a_unit_is_told_what_it_lacks() {
    all_refused(&[
        (
            "[[light]]\npoint = { at = [0, 0, 1], flux = 800 }",
            "2:34: found `800` without a unit; expected a flux as a text such as \"800 lm\"",
        ),
        (
            "[[shape]]\nsphere = { centre = [0, 0, 5], radius = 0.5 }",
            "2:41: found `0.5` without a unit; expected a length as a text such as \"0.5 m\"",
        ),
        (
            "[[sensor]]\nname = \"q\"\ntarget = 0.01\nilluminance = { at = [0, 0, 0] }",
            "3:10: found `0.01` without a unit; expected a share as a text such as \"1 %\"",
        ),
        (
            "[[light]]\nsun = { date = 2026-06-21T12:00:00Z, latitude = 45, longitude = \"0 deg\", irradiance = \"1 lx\" }",
            "2:49: found `45` without a unit; expected an angle as a text such as \"30 deg\"",
        ),
        ("[render]\nsamples = 1.5", "2:11: found `1.5`; expected a whole number, 0 or more"),
    ]);
}

#[test]
fn a_spectrum_is_told_at_its_own_place() {
    all_refused(&[
        (
            "[[light]]\nname = \"l\"\n\nspectrum = \"nope\"\n[light.point]\nat = [0, 0, 1]\nflux = \"1 lm\"",
            "4:12: no spectrum is called `nope`",
        ),
        ("[[light]]\npoint = { at = [0, 0, 1], flux = \"1 lm\" }\nspectrum = { file = \"no.csv\" }", "3:12: "),
        // A spectrum of the scene is told where it stands, what it does not suit where it is used.
        (
            "[spectra]\nx = { file = \"no.csv\" }\n[[light]]\npoint = { at = [0, 0, 1], flux = \"1 lm\" }\nspectrum = \"x\"",
            "2:5: ",
        ),
        (
            "[spectra]\nx = [[400, 0.5], [700, 2]]\n[[material]]\nname = \"m\"\nreflectance = \"x\"",
            "5:15: `reflectance` is 2 at 700 nm",
        ),
        (
            "[[light]]\npoint = { at = [0, 0, 1], flux = \"1 lm\" }\nspectrum = [[400, -1], [700, 1]]",
            "3:12: `spectrum` is -1 at 400 nm; expected a number or spectrum of 0 or more",
        ),
        (
            "[[shape]]\nsphere = { centre = [0, 0, 5], radius = \"1 m\" }\nemission = { flux = \"1 lm\", spectrum = -1 }",
            "3:40: `spectrum` is -1; expected a number or spectrum of 0 or more",
        ),
        // Negative where it enters the wavelengths that are carried, between points that are not carried.
        (
            "[[material]]\nname = \"m\"\nreflectance = [[260, -1], [460, 0], [830, 1]]",
            "3:15: `reflectance` is -0.5 at 360 nm; expected a number or spectrum from 0 to 1",
        ),
        (
            "[[material]]\nname = \"m\"\nreflectance = [[400, 0.5], [700, 1.5]]",
            "3:15: `reflectance` is 1.5 at 700 nm; expected a number or spectrum from 0 to 1",
        ),
        (
            "[[material]]\nname = \"m\"\ndielectric = { index = 0.5 }",
            "3:24: `index` is 0.5; expected a number or spectrum from 1 to 1000",
        ),
        (
            "[[material]]\nname = \"m\"\ndielectric = { index = 1.5, outside = [[400, 1], [700, 0.9]] }",
            "3:39: `outside` is 0.9 at 700 nm",
        ),
        (
            "[[material]]\nname = \"m\"\npane = { index = 1.5, transmittance = 1.1 }",
            "3:39: `transmittance` is 1.1; expected a number or spectrum from 0 to 1",
        ),
        (
            "[[material]]\nname = \"m\"\ndye = { reflectance = 0.1, absorption = -0.1, emission = 1, quantum_yield = 1 }",
            "3:41: `absorption` is -0.1; expected a number or spectrum from 0 to 1",
        ),
    ]);
    let parts = "[[material]]\nname = \"a\"\nreflectance = 0.5\n[[material]]\nname = \"m\"\n";
    for (shares, message) in [
        (["0.7", "0.5"], "6:11: the shares sum to 1.2; expected at most 1"),
        (["0.7", "-0.5"], "6:72: `share` is -0.5; expected a number or spectrum from 0 to 1"),
    ] {
        let [a, b] = shares;
        let mixture = format!("mixture = [{{ material = \"a\", share = {a} }}, {{ material = \"a\", share =  {b} }}]");
        refused(&format!("{parts}{mixture}"), message);
    }
}

#[test]
fn a_value_is_told_at_its_own_place_and_in_its_own_unit() {
    all_refused(&[
        (
            "[[light]]\n[light.spot]\nat = [0, 0, 1]\naim = [0, 0, 0]\nflux = \"1 lm\"\nhalf_angle = \"200 deg\"",
            "6:14: `half_angle` is 200 deg; expected above 0 to 180 deg",
        ),
        (
            "[[light]]\nsun = { date = 2026-06-21T12:00:00Z, latitude = \"95 deg\", longitude = \"0 deg\", irradiance = \"1 lx\" }",
            "2:49: `latitude` is 95 deg; expected -90 to 90 deg",
        ),
        ("[[light]]\n[light.sky]\nzenith = \"1 cd/m2\"\ntype = 17", "4:8: a type of sky of 17; expected 1 to 15"),
        (
            "[render]\nwavelength_tolerance = -1",
            "2:24: a `wavelength_tolerance` of -1; expected a relative error above 0",
        ),
        ("[render]\nwavelength_step_nm = 0.5", "2:22: a `wavelength_step_nm` of 0.5; expected 1 to 100"),
        ("[render]\nsamples = 0", "2:11: found 0 samples; expected 1 or more"),
        ("[render]\nmeter_samples = 0", "2:17: found 0 samples; expected 1 or more"),
        (
            "[[sensor]]\nname = \"q\"\nilluminance = { grid = { corner = [0, 0, 0], edges = [[1, 0, 0], [0, 1, 0]], points = [0, 3] } }",
            "3:87: a grid of 0 × 3 points; expected 1 to 100000 of them",
        ),
        (
            "[[sensor]]\nname = \"q\"\ntarget = \"0 %\"\nilluminance = { at = [0, 0, 0] }",
            "3:10: `target` is 0 %; expected above 0 %",
        ),
        (
            "[[sensor]]\nname = \"q\"\nluminance = { at = [0, 0, 1], look_at = [0, 0, 0], acceptance = \"200 deg\" }",
            "3:65: `acceptance` is 200 deg; expected above 0 to 180 deg",
        ),
        (
            "[[sensor]]\nname = \"q\"\ncamera = { at = [0, 0, 1], look_at = [0, 0, 0], up = [0, 1, 0], resolution = [4, 2], projection = \"equirectangular\", field_of_view = \"60 deg\" }",
            "3:134: `field_of_view` of a camera that sees all directions",
        ),
        (
            "[[light]]\npoint = { at = [0, 0, 1], flux = \"1 lm\", intensity = \"1 cd\" }",
            "2:9: both `flux` and `intensity`; expected one of them",
        ),
        ("[[light]]\npoint = { at = [0, 0, 1] }", "2:9: neither `flux` nor `intensity`; expected one of them"),
        (&format!("{LAMP}{LAMP}"), "5:8: a second light called `l`; expected a name of its own"),
    ]);
}

/// A point light is infinite where it stands, and beyond all numbers nearer than 1e-154 m to it; a nanometre off it, it is not.
#[test]
fn a_meter_on_a_point_light_is_refused() {
    for (place, is_refused) in [("0", true), ("1e-160", true), ("1e-9", false)] {
        for light in ["point = { flux = \"1 lm\"", "spot = { aim = [0, 0, -1], flux = \"1 lm\""] {
            let text = format!("[[light]]\n{light}, at = [0, 0, {place}] }}\n");
            if is_refused {
                refused(&text, "5:8: sensor `p` stands on light `light 1`, whose light is infinite there");
            } else {
                let folder = tempfile::tempdir().expect("a folder");
                let path = scene(&folder, &format!("{text}{SENSOR}"));
                photopic().arg("render").arg("--check").arg(&path).assert().success();
            }
        }
    }
    // A lamp that is off has no light there.
    let folder = tempfile::tempdir().expect("a folder");
    let path = scene(&folder, &format!("[[light]]\npoint = {{ flux = \"0 lm\", at = [0, 0, 0] }}\n{SENSOR}"));
    photopic().arg("render").arg("--check").arg(&path).assert().success();
}

#[test]
fn a_pattern_needs_texture_coordinates() {
    let folder = tempfile::tempdir().expect("a folder");
    let corners = "v 0 0 1\nv 1 0 1\nv 0 1 1\n";
    std::fs::write(folder.path().join("bare.obj"), format!("{corners}f 1 2 3\n")).expect("written");
    let with = format!("{corners}vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    std::fs::write(folder.path().join("mapped.obj"), with).expect("written");
    let check = |file: &str| {
        let text = format!(
            "[[material]]\nname = \"m\"\nreflectance = 1\ncheckerboard = {{ even = 1, odd = 0, fields = [2, 2] }}\n\
             [[shape]]\nmaterial = \"m\"\nmesh = {{ file = \"{file}\" }}\n{SENSOR}"
        );
        let mut command = photopic();
        command.arg("render").arg("--check").arg(scene(&folder, &text));
        command.assert()
    };
    let message = "scene.toml:6:12: material `m` has a checkerboard, and bare.obj no texture coordinates";
    check("bare.obj").code(2).stderr(contains(message));
    check("mapped.obj").success();
}

#[test]
fn a_gonioreflectometer_without_a_sample_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let codes = |sample: &str| {
        let text = format!(
            "{sample}[[sensor]]\nname = \"brdf\"\ngonioreflectometer = {{ at = [0, 0, 0], radius = \"1 cm\", theta_i = [\"5 deg\", \"80 deg\"] }}\n"
        );
        let out = json(photopic().arg("render").arg(scene(&folder, &text)).args(["--check", "--json"]));
        let codes = out["findings"].as_array().expect("findings").iter();
        codes.map(|f| f["code"].as_str().expect("a code").to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(codes(""), ["R011"]);
    let sample = "[[shape]]\nrectangle = { corner = [-1, -1, 0], edges = [[2, 0, 0], [0, 2, 0]] }\n";
    assert!(codes(sample).is_empty());
}

#[test]
fn a_dark_grid_has_no_uniformity() {
    let folder = tempfile::tempdir().expect("a folder");
    let grid = "illuminance = { grid = { corner = [0, 0, 0], edges = [[1, 0, 0], [0, 1, 0]], points = [2, 2] } }";
    let text = SENSOR.replace("illuminance = { at = [0, 0, 0] }", grid);
    let path = scene(&folder, &text);
    let run = || {
        let mut command = photopic();
        command.arg("render").arg(&path).args(["--meter-samples", "64"]);
        command
    };
    run().assert().success().stdout(contains("no uniformity: all is dark"));
    let out = json(run().arg("--json"));
    // JSON writes a NaN as null.
    assert!(!out["results"][0]["sensors"].to_string().contains("null"), "{out}");
}

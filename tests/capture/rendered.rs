//! There and back: spheres of known BRDFs, rendered by this renderer under known lamps, measured from the pictures.

use std::fmt::Write;
use std::fs;

use assert_cmd::Command;
use serde_json::Value;

use crate::cli::{json, run};

/// Pixels along an edge, and half the field of view, degrees.
const SIDE: u32 = 192;
const HALF_DEG: f64 = 8.0;
/// Lamps before the sphere, beside it, and nearly behind it, m.
const LAMPS: [[f64; 3]; 4] = [[0.6, 0.5, 7.0], [4.5, 1.0, 4.5], [-2.0, -6.0, 1.5], [-6.0, 2.0, -2.0]];
const INTENSITY_CD: f64 = 250.0;

/// A lamp whose beam falls to a third at 12° from its axis: LM-63.
fn beam_file() -> String {
    let angles: Vec<String> = (0..=90).map(|gamma| gamma.to_string()).collect();
    let intensity = |gamma: i32| format!("{:.6}", INTENSITY_CD * (-(f64::from(gamma) / 12.0).powi(2)).exp());
    let values: Vec<String> = (0..=90).map(intensity).collect();
    let (angles, values) = (angles.join(" "), values.join("\n"));
    format!(
        "IESNA:LM-63-2002\n[TEST] t\n[MANUFAC] m\nTILT=NONE\n1 -1 1 91 1 1 2 0 0 0\n1 1 10\n{angles}\n0\n{values}\n"
    )
}

/// Renders a sphere of a material under each lamp (a point, or a beam that is aimed beside the middle) and measures it; the parameters of the fit of `model` with their standard errors.
fn there_and_back(material: &str, model: &str, beam: bool) -> Vec<(String, f64, f64)> {
    let folder = tempfile::tempdir().expect("a folder");
    let focal = 0.5 * f64::from(SIDE) / HALF_DEG.to_radians().tan();
    let middle = 0.5 * f64::from(SIDE - 1);
    let mut manifest = format!(
        "[camera]\nfx = {focal}\nfy = {focal}\ncx = {middle}\ncy = {middle}\nposition_m = [0, 0, 8]\nforward = [0, 0, -1]\nup = [0, 1, 0]\n\
         [sphere]\ncentre_m = [0, 0, 0]\nradius_m = 1\n[radiance]\nunit_w_per_m2_sr = 1\n"
    );
    fs::write(folder.path().join("beam.ies"), beam_file()).expect("written");
    for (k, lamp) in LAMPS.iter().enumerate() {
        let (shines, stated) = if beam {
            let aim = [lamp[1] * 0.1, 0.3, -0.2];
            (
                format!("lamp = {{ file = \"beam.ies\", at = {lamp:?}, aim = {aim:?} }}"),
                format!("lamp = {{ file = \"beam.ies\", aim_m = {aim:?} }}"),
            )
        } else {
            (
                format!("point = {{ at = {lamp:?}, intensity = \"{INTENSITY_CD} cd\" }}"),
                format!("intensity_w_per_sr = {INTENSITY_CD}"),
            )
        };
        // At one wavelength the luminance over the luminous intensity is the radiance over the radiant one.
        let scene = format!(
            "[render]\nsolver = \"direct\"\nsamples = 64\nadaptive = false\n[[material]]\nname = \"m\"\nbrdf = \"{material}\"\n\
             [[shape]]\nname = \"ball\"\nmaterial = \"m\"\nsphere = {{ centre = [0, 0, 0], radius = \"1 m\" }}\n\
             [[light]]\nspectrum = \"line:555nm\"\n{shines}\n\
             [[sensor]]\nname = \"camera\"\ncamera = {{ at = [0, 0, 8], look_at = [0, 0, 0], up = [0, 1, 0], resolution = [{SIDE}, {SIDE}], \
             projection = \"perspective\", field_of_view = \"{} deg\", exr = \"{k}.exr\" }}\n",
            2.0 * HALF_DEG
        );
        fs::write(folder.path().join("scene.toml"), scene).expect("written");
        let mut render = Command::cargo_bin("photopic").expect("the program");
        render.current_dir(folder.path()).args(["-q", "render", "scene.toml"]).assert().success();
        let _ = write!(
            manifest,
            "[[light]]\nname = \"{k}\"\nposition_m = {lamp:?}\n{stated}\n\
             [[stack]]\nname = \"{k}\"\nexposures = [{{ photo = \"{k}.exr\" }}]\n"
        );
    }
    fs::write(folder.path().join("capture.toml"), manifest).expect("written");
    let (code, out, error) = run(folder.path(), &["brdf", "capture.toml", "-m", model, "--json"]);
    assert_eq!(code, 0, "{error}");
    let document = json(&out);
    let result = &document["results"][0];
    assert_eq!(result["scale"]["absolute"], true);
    let parameter = |p: &Value| {
        let number = |key: &str| p[key].as_f64().unwrap_or_else(|| panic!("{key} in {p}"));
        (p["name"].as_str().expect("a name").to_owned(), number("value"), number("standard_error"))
    };
    result["fits"][0]["parameters"].as_array().expect("parameters").iter().map(parameter).collect()
}

/// Within three standard errors, which are themselves a small part of the value.
fn agrees(found: &[(String, f64, f64)], truth: &[f64]) {
    assert_eq!(found.len(), truth.len(), "{found:?}");
    for ((name, value, error), truth) in found.iter().zip(truth) {
        assert!(*error < 2e-3 * truth, "{name}: {value} ± {error}");
        assert!((value - truth).abs() < 3.0 * error, "{name}: {value} ± {error}; rendered with {truth}");
    }
}

#[test]
fn rough_plastic_comes_back_from_rendered_pictures() {
    let found = there_and_back("lambert(reflectance=0.4) + ggx(alpha=0.25, f0=0.06)", "lambert + ggx", false);
    agrees(&found, &[0.4, 0.25, 0.06]);
}

#[test]
fn phong_comes_back_from_rendered_pictures() {
    let found = there_and_back("phong(kd=0.3, ks=0.2, n=40)", "phong", false);
    agrees(&found, &[0.3, 0.2, 40.0]);
}

#[test]
fn lamps_of_a_photometric_file_are_accounted_for() {
    let found = there_and_back("lambert(reflectance=0.4) + ggx(alpha=0.25, f0=0.06)", "lambert + ggx", true);
    agrees(&found, &[0.4, 0.25, 0.06]);
}

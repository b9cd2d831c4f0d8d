//! Narrow bands: grey photographs behind filters become a spectral BRDF.

use std::f64::consts::PI;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use glam::DVec3;
use photopic::brdf::description::{Bands, Material};
use tempfile::TempDir;

use crate::cli::{has_finding, json, run};
use crate::shapes::{CAMERA, photograph};

/// Wavelength in nm, reflectance, exposure time in s, intensity of the lights in W/sr.
const BANDS: [(f64, f64, f64, f64); 4] =
    [(450.0, 0.2, 2.0, 0.5), (500.0, 0.5, 0.5, 1.0), (600.0, 0.3, 1.0, 1.5), (700.0, 0.8, 0.25, 2.0)];
const LIGHTS: [[f64; 3]; 2] = [[0.5, -0.4, 0.5], [-1.2, 0.3, 1.4]];

/// A diffuse ball of the reflectances of [`BANDS`] at (0, 0, 2) with radius 0.4 m, its stacks in an order that is none.
fn filters() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let mut manifest = CAMERA.replace("relative_error = 0.01\n", "absolute_error = 4.4e-6\nunit_w_per_m2_sr = 1.0\n");
    manifest.push_str("[sphere]\ncentre_m = [0.0, 0.0, 2.0]\nradius_m = 0.4\n");
    for (n, light) in LIGHTS.iter().enumerate() {
        let strengths = BANDS.map(|b| b.3);
        writeln!(manifest, "[[light]]\nname = \"{n}\"\nposition_m = {light:?}\nintensity_w_per_sr = {strengths:?}")
            .expect("a string");
    }
    for (nm, reflectance, time_s, intensity) in [BANDS[2], BANDS[0], BANDS[3], BANDS[1]] {
        for (n, light) in LIGHTS.iter().enumerate() {
            let name = format!("{n}_{nm}.tif");
            photograph(&folder.path().join(&name), |ray| {
                let centre = DVec3::new(0.0, 0.0, 2.0);
                let (b, c) = (ray.dot(centre), centre.length_squared() - 0.16);
                if b * b <= c {
                    return 0.0;
                }
                let point = (b - (b * b - c).sqrt()) * ray;
                let to_light = DVec3::from_array(*light) - point;
                let cos = ((point - centre) / 0.4).dot(to_light.normalize()).max(0.0);
                reflectance / PI * intensity * cos / to_light.length_squared() * time_s
            });
            writeln!(
                manifest,
                "[[stack]]\nname = \"{name}\"\nlight = \"{n}\"\nwavelength_nm = {nm}\nexposures = [{{ photo = \"{name}\", time_s = {time_s} }}]"
            )
            .expect("a string");
        }
    }
    fs::write(folder.path().join("capture.toml"), manifest).expect("a manifest");
    folder
}

const FIT: [&str; 6] = ["brdf", "capture.toml", "-m", "lambert", "--resolution", "12x10x8"];

fn change(folder: &Path, from: &str, to: &str) {
    let manifest = fs::read_to_string(folder.join("capture.toml")).expect("a manifest");
    assert!(manifest.contains(from), "{from}");
    fs::write(folder.join("x.toml"), manifest.replacen(from, to, 1)).expect("written");
}

#[test]
fn filters_make_a_spectral_table_and_material() {
    let folder = filters();
    let outputs = ["-o", "ball.csv", "-o", "ball.alta", "-o", "ball.toml", "--report", "ball.html", "--json"];
    let (code, out, error) = run(folder.path(), &[&FIT[..], &outputs].concat());
    assert_eq!(code, 0, "{error}");
    let document = json(&out);
    let result = &document["results"][0];
    assert_eq!(result["bands"], serde_json::json!(["450 nm", "500 nm", "600 nm", "700 nm"]));
    assert_eq!(result["stacks"].as_array().map(Vec::len), Some(LIGHTS.len()));
    let parameters = result["fits"][0]["parameters"].as_array().expect("parameters");
    assert_eq!(parameters.len(), BANDS.len());
    for (parameter, (_, reflectance, ..)) in parameters.iter().zip(BANDS) {
        let [value, sigma] = ["value", "standard_error"].map(|k| parameter[k].as_f64().expect("a number"));
        assert!((value - reflectance).abs() < 3.0 * sigma && sigma < 1e-4 * reflectance, "{parameter}");
    }
    // The table, by wavelength.
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
    let table = read("ball.csv");
    assert!(table.starts_with("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,wavelength_nm,value\n"));
    for line in table.lines().skip(1) {
        let [nm, value] =
            [4, 5].map(|i: usize| line.split(',').nth(i).and_then(|c| c.parse::<f64>().ok()).expect("a number"));
        let reflectance = BANDS.iter().find(|b| b.0 == nm).expect("a band").1;
        // Samples are rounded to 1/65535 where they are a hundredth or more.
        assert!((value * PI / reflectance - 1.0).abs() < 1e-3, "{line}");
    }
    assert!(
        read("ball.alta").lines().any(|l| l.split_whitespace().eq(["#DIM", "3", "4"])),
        "{}",
        &read("ball.alta")[..400]
    );
    // The material, between its bands too.
    let text = read("ball.toml");
    let words = text.lines().find_map(|l| l.strip_prefix("material = \"")?.strip_suffix('"')).expect("a material");
    let material: Material = words.parse().expect("a description");
    let brdf = material.prepare(Bands::Wavelengths(&[475.0, 500.0])).expect("wavelengths");
    let mut f = [0.0; 2];
    brdf.evaluate(DVec3::Z, DVec3::Z, &mut f);
    assert!((f[0] * PI - 0.35).abs() < 1e-4 && (f[1] * PI - 0.5).abs() < 1e-4, "{words}");
    assert!(read("ball.html").contains("450 nm"));
}

#[test]
fn narrow_bands_are_no_merl_table() {
    let folder = filters();
    let (code, out, error) = run(folder.path(), &[&FIT[..], &["-o", "ball.binary"]].concat());
    let words = "ball.binary: a MERL file has red, green and blue; found 450 nm, 500 nm, 600 nm, 700 nm; expected .csv or .alta";
    assert!(code == 2 && out.is_empty() && error.contains(words), "{error}");
}

#[test]
fn sets_of_filters_that_are_not_whole_say_so() {
    let folder = filters();
    photograph(&folder.path().join("flat.tif"), |_| 0.5);
    // A band that one of the lights lacks: the other one stands.
    change(
        folder.path(),
        "light = \"0\"\nwavelength_nm = 450",
        "shows = \"reference\"\nlight = \"0\"\nwavelength_nm = 450",
    );
    let (code, out, error) = run(folder.path(), &["brdf", "x.toml", "-m", "lambert", "--json"]);
    let document = json(&out);
    assert!(code == 2 && has_finding(&document, "K001") && has_finding(&document, "K010"), "{error}");
    assert!(
        error.contains("found stacks of light 0 at [500.0, 600.0, 700.0] nm; expected one at each of [450.0,"),
        "{error}"
    );
    assert_eq!(document["results"][0]["stacks"].as_array().map(Vec::len), Some(1));
    for (from, to, words) in [
        ("wavelength_nm = 600\n", "", "found no wavelength_nm beside stacks of the object that have some"),
        ("wavelength_nm = 600\n", "wavelength_nm = -600\n", "found -600; expected a number above 0"),
        (
            "[sphere]",
            "[flat]\nradiance_w_per_m2_sr = 1.0\n[sphere]",
            "found a [flat] of known radiance beside stacks of narrow bands",
        ),
    ] {
        change(folder.path(), from, to);
        if to.contains("[flat]") {
            let manifest = fs::read_to_string(folder.path().join("x.toml")).expect("a manifest");
            let flat =
                "[[stack]]\nname = \"flat\"\nshows = \"flat\"\nexposures = [{ photo = \"flat.tif\", time_s = 1.0 }]\n";
            fs::write(folder.path().join("x.toml"), manifest + flat).expect("written");
        }
        let (code, out, error) = run(folder.path(), &["brdf", "x.toml", "-m", "lambert"]);
        assert!(code == 2 && out.is_empty() && error.contains(words), "{words}: {error}");
    }
}

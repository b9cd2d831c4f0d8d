//! `convert --report`: one page that holds all that it shows, and where a light stands to nominal whites.

use std::fs;

use crate::{Folder, at, json, number, office_led};

#[test]
fn a_report_holds_inputs_method_figures_pictures_and_budget() {
    let folder = Folder::new()
        .with("b.toml", "[[scale]]\nname = \"lamp & <mirror>\"\nrelative = 0.02\n[monte_carlo]\ntrials = 500\n");
    let mut command = folder.run();
    command.args(["convert", "--uncertainty", "b.toml", "--report", "r.html", "--json"]).arg(office_led());
    let document: serde_json::Value =
        serde_json::from_slice(&command.assert().success().get_output().stdout.clone()).expect("one JSON document");
    let page = fs::read_to_string(folder.path("r.html")).expect("a report");
    let sha256 = document["inputs"][0]["sha256"].as_str().expect("a checksum");
    assert!(page.contains(sha256) && page.contains("b.toml"), "inputs with checksums");
    for heading in ["Figures", "Pictures", "Uncertainty", "Inputs and method", "Findings"] {
        assert!(page.contains(&format!("<h2>{heading}</h2>")), "{heading}");
    }
    assert!(page.contains("<td>illuminance</td>") && page.contains("95 % interval"));
    assert!(page.contains("lamp &amp; &lt;mirror&gt;"), "names are text");
    // Spectrum, chromaticity, colour vectors, melanopic illuminance, budget; nothing is fetched from elsewhere.
    assert_eq!(page.matches("data:image/svg+xml;base64,").count(), 5);
    assert!(!page.contains("src=\"http") && !page.contains("<script"));
}

#[test]
fn a_report_is_on_one_spectrum_and_never_in_place_of_an_input() {
    let folder = Folder::new().with("two.csv", "wavelength_nm,a,b\n400,1,2\n500,1,2\n600,1,1\n");
    let said = |arguments: &[&str]| {
        let mut command = folder.run();
        let out = command.arg("convert").args(arguments).assert().code(2).get_output().stderr.clone();
        String::from_utf8(out).expect("text")
    };
    assert!(said(&["two.csv", "--report", "r.html"]).contains("--report: 2 spectra in memory; expected one"));
    assert!(said(&["two.csv", "--select", "a", "--report", "two.csv"]).contains("would overwrite an input"));
    assert_eq!(folder.names(), ["two.csv"]);
}

#[test]
fn a_white_light_is_held_against_the_nearest_nominal_white() {
    // A blackbody of 2725 K is the centre of 2700 K (ANSI C78.377, Table 1), to the printed digits of x, y.
    let folder = Folder::new();
    let document = json(folder.run().args(["convert", "blackbody:2725K"]));
    assert_eq!(number(&document, "nominal_white.nominal_cct_k"), 2700.0);
    assert_eq!(at(&document["results"][0], "nominal_white.inside_quadrangle"), &serde_json::json!(true));
    assert!(number(&document, "nominal_white.delta_uv_prime") < 1e-4 && number(&document, "nominal_white.sdcm") < 0.1);
    // The centre of F 4000 (IEC 60081) is x = y = 0.380; a blackbody of 4000 K has 0.3805, 0.3768.
    let document = json(folder.run().args(["convert", "blackbody:4000K"]));
    assert_eq!(at(&document["results"][0], "standard_colour.name"), &serde_json::json!("F 4000"));
    let (dx, dy) = (0.3805 - 0.380, 0.3768 - 0.380);
    let steps = (39.5e4f64 * dx * dx - 2.0 * 21.5e4 * dx * dy + 26e4 * dy * dy).sqrt();
    assert!((number(&document, "standard_colour.sdcm") - steps).abs() < 0.05, "{document}");
    // Illuminant A, 2856 K, is 131 K away: inside of 2580 K to 2870 K. A candle is no such light.
    let document = json(folder.run().args(["convert", "A"]));
    assert_eq!(at(&document["results"][0], "nominal_white.inside_quadrangle"), &serde_json::json!(true));
    let document = json(folder.run().args(["convert", "blackbody:1800K"]));
    assert!(document["results"][0].get("nominal_white").is_none());
}

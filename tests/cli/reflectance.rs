//! Reflectances under an illuminant. Expected figures of the sloping white are colour-science 0.4.7's for the same samples:
//! `sd_to_XYZ_integration`, `whiteness_CIE2004` and `yellowness_ASTME313`, all digits printed.

use predicates::str::contains;
use serde_json::Value;

use crate::{Folder, at, close, json, number, photopic};

/// ρ from 380 to 780 nm by 5 nm.
fn sample(reflectance: impl Fn(f64) -> f64) -> String {
    (0..=80).fold("wavelength_nm,paper\n".to_owned(), |text, i| {
        let w = 380.0 + 5.0 * f64::from(i);
        text + &format!("{w},{:.4}\n", reflectance(w))
    })
}

fn sloping(w: f64) -> f64 {
    0.8 + 0.0002 * (w - 380.0)
}

fn is_no_white(document: &Value) -> bool {
    document["findings"].as_array().into_iter().flatten().any(|f| f["code"] == "C008")
}

#[test]
fn a_sloping_white_is_as_white_as_elsewhere() {
    let folder = Folder::new().with("paper.csv", sample(sloping));
    for (light, observer, y, [w, t, yi]) in [
        ("D65", "cie-1931-2deg", 83.5355675, [76.46169726, -1.54362803, 3.2821964724921173]),
        ("D65", "cie-1964-10deg", 83.42216987, [76.546751, -1.3438827, 3.2589346822000183]),
        ("C", "cie-1931-2deg", 83.5469916, [76.27667254, -1.5015579, 3.313713188907614]),
        ("C", "cie-1964-10deg", 83.42606886, [76.38598829, -1.30882624, 3.3045948063824166]),
    ] {
        let run = ["convert", "paper.csv", "--illuminant", light, "--observer", observer, "--figures", "luminous"];
        let document = json(folder.run().args(run));
        for (key, want) in [("xyz.1", y), ("whiteness", w), ("tint", t), ("yellowness_e313", yi)] {
            close(number(&document, key), want, 1e-8);
        }
        assert_eq!(document["settings"]["illuminant"], light);
        assert!(!is_no_white(&document), "{document}");
    }
}

/// The light may be a spectrum of the user's own: D65 from its table, in any unit, is D65, but for the figures that are defined for it.
#[test]
fn an_illuminant_may_come_from_a_file() {
    let table = crate::photopic()
        .args(["tables", "cie-illuminant-d65", "--csv"])
        .assert()
        .success()
        .get_output()
        .stdout
        .clone();
    let folder =
        Folder::new().with("paper.csv", sample(sloping)).with("light.csv", String::from_utf8(table).expect("text"));
    let run =
        |light: &str| json(folder.run().args(["convert", "paper.csv", "--illuminant", light, "--figures", "luminous"]));
    let (file, name) = (run("light.csv"), run("D65"));
    for key in ["xyz.0", "xyz.1", "xyz.2"] {
        close(number(&file, key), number(&name, key), 1e-9);
    }
    assert_eq!(file["settings"]["illuminant"], "light.csv");
    assert!(file["results"][0].get("whiteness").is_none());
}

#[test]
fn the_perfect_diffuser_is_the_white_itself() {
    // On any grid: by 7 nm, not to the ends of the observer.
    let text = (0..=40).fold("nm,r\n".to_owned(), |text, i| text + &format!("{},1\n", 410 + 7 * i));
    let folder = Folder::new().with("one.csv", text);
    let document = json(folder.run().args(["convert", "one.csv", "--illuminant", "D65", "-q"]));
    close(number(&document, "xyz.1"), 100.0, 1e-13);
    close(number(&document, "whiteness"), 100.0, 1e-12);
    assert!(number(&document, "tint").abs() < 1e-10);
    // Against the white that it is there is no dominant wavelength.
    assert!(document["results"][0]["dominant_wavelength_nm"].is_null(), "{document}");
}

#[test]
fn a_grey_is_no_white() {
    let folder = Folder::new().with("grey.csv", sample(|_| 0.5));
    // W = Y = 50, above 5 · 50 − 280 = −30.
    let document = json(folder.run().args(["convert", "grey.csv", "--illuminant", "D65", "--figures", "luminous"]));
    close(number(&document, "whiteness"), 50.0, 1e-12);
    assert!(is_no_white(&document), "{document}");
}

#[test]
fn other_lights_and_observers_have_no_whiteness() {
    let folder = Folder::new().with("paper.csv", sample(sloping));
    for more in [["--illuminant", "A", "--rule", "summation"], ["--illuminant", "D65", "--observer", "cie-2015-2deg"]] {
        let document = json(folder.run().args(["convert", "paper.csv", "-q"]).args(more));
        assert!(document["results"][0].get("whiteness").is_none(), "{document}");
        assert_eq!(document["results"][0]["xyz_scale"], "Y = 100 of the perfect diffuser");
    }
}

/// A common scale error of u leaves x and y alone: Y and so W err by u·Y, T and YI not at all. To first order and exactly.
#[test]
fn a_scale_error_moves_whiteness_by_that_of_y() {
    let folder = Folder::new()
        .with("paper.csv", sample(sloping))
        .with("budget.toml", "scale = [{ relative = 0.01 }]\nmonte_carlo = { trials = 1000 }\n");
    let run = ["convert", "paper.csv", "--illuminant", "D65", "--figures", "luminous", "--uncertainty", "budget.toml"];
    let document = json(folder.run().args(run));
    let y = number(&document, "xyz.1");
    close(number(&document, "uncertainty.xyz.1.standard"), 0.01 * y, 1e-9);
    assert_eq!(at(&document["results"][0], "uncertainty.xyz.1.method"), "analytic");
    close(number(&document, "uncertainty.whiteness.analytic_standard"), 0.01 * y, 1e-9);
    assert!(number(&document, "uncertainty.tint.analytic_standard") < 1e-9);
    assert!(number(&document, "uncertainty.yellowness_e313.analytic_standard") < 1e-9);
}

#[test]
fn what_is_no_reflectance_is_refused() {
    let folder = Folder::new().with("percent.csv", sample(|w| 100.0 * sloping(w)));
    let refused = |arguments: &[&str], says: &str| {
        let run = folder.run().arg("convert").args(arguments).assert().code(2);
        run.stderr(contains(says.to_owned()));
    };
    refused(&["percent.csv", "--illuminant", "D65"], "84 % is 0.84");
    refused(&["percent.csv", "--illuminant", "D65", "--quantity", "irradiance"], "irradiance under an illuminant");
    refused(&["percent.csv", "--illuminant", "D66"], "D66");
    refused(&["percent.csv", "--illuminant", "line:555nm"], "continuous");
    photopic().args(["convert", "D65", "--illuminant", "D65", "--scale-to", "1 lx"]).assert().code(2);
}

//! The command line of `lamp`: formats told by content, exit codes, conversions. The lamp is one that shines alike in all
//! directions, so that its flux is 4π I in closed form.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

/// An LM-63 lamp of `candela` in all directions, declaring `lumens` (absolute photometry has −1).
fn even(candela: f64, lumens: &str) -> String {
    let row = vec![candela.to_string(); 7].join(" ");
    format!(
        "IESNA:LM-63-2002\n[TEST] 1\n[TESTLAB] none\n[ISSUEDATE] 2026\n[MANUFAC] ours\nTILT=NONE\n\
         1 {lumens} 1 7 1 1 2 0 0 0\n1 1 10\n0 30 60 90 120 150 180\n0\n{row}\n"
    )
}

fn lamp(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::new(env!("CARGO_BIN_EXE_photopic")).current_dir(folder).arg("lamp").args(arguments).assert()
}

fn results(assert: &assert_cmd::assert::Assert) -> Value {
    serde_json::from_slice(&assert.get_output().stdout).expect("one JSON document")
}

fn flux(folder: &Path, file: &str) -> f64 {
    let assert = lamp(folder, &["info", "--json", file]).success();
    results(&assert)["results"][0]["total_flux_lm"].as_f64().expect("a flux")
}

#[test]
fn the_flux_of_an_even_lamp_survives_every_format() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("even.ies"), even(100.0, "-1")).expect("written");
    let close = |file: &str| {
        let got = flux(folder.path(), file);
        assert!((got / (400.0 * PI) - 1.0).abs() < 1e-4, "{file}: {got}");
    };
    close("even.ies");
    for (from, to) in [("even.ies", "a.ldt"), ("a.ldt", "b.xml"), ("b.xml", "c.ies")] {
        lamp(folder.path(), &["convert", from, "-o", to]).success();
        close(to);
    }
    let info = results(&lamp(folder.path(), &["info", "--json", "a.ldt", "b.xml", "c.ies"]).success());
    let formats: Vec<&str> = (0..3).filter_map(|i| info["results"][i]["format"].as_str()).collect();
    assert_eq!(formats, ["EULUMDAT", "TM-33", "LM-63"]);
    assert!(info["inputs"].as_array().is_some_and(|i| i.len() == 3 && i[0]["sha256"].is_string()));
}

#[test]
fn an_eulumdat_file_without_a_maker_is_still_one() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("even.ies"), even(100.0, "-1")).expect("written");
    lamp(folder.path(), &["convert", "even.ies", "-o", "a.ldt"]).success();
    let text = fs::read_to_string(folder.path().join("a.ldt")).expect("written");
    let (_, rest) = text.split_once("\r\n").expect("a first line");
    fs::write(folder.path().join("b.ldt"), format!("\r\n{rest}")).expect("written");
    assert!((flux(folder.path(), "b.ldt") / (400.0 * PI) - 1.0).abs() < 1e-4);
}

#[test]
fn check_says_no_with_exit_code_1_and_what_cannot_be_read_is_2() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write("good.ies", &even(100.0, "-1"));
    write("dark.ies", &even(0.0, "-1"));
    write("broken.ies", &even(100.0, "-1").replace("0 30 60 90 120 150 180", "0 30 NaN 90 120 150 180"));
    lamp(folder.path(), &["check", "good.ies"]).code(0);
    // L111: no light at all.
    let dark = results(&lamp(folder.path(), &["check", "--json", "dark.ies"]).code(1));
    assert_eq!(dark["results"][0]["passes"], false);
    let broken = lamp(folder.path(), &["info", "--json", "broken.ies", "good.ies"]).code(2);
    let error = String::from_utf8_lossy(&broken.get_output().stderr).into_owned();
    assert!(error.starts_with("broken.ies:9:6: "), "{error}");
    // The good one is still done.
    assert_eq!(results(&broken)["results"].as_array().map(Vec::len), Some(1));
    lamp(folder.path(), &["info", "no-such.ies"]).code(2);
    lamp(folder.path(), &["convert", "good.ies", "-o", "x.pdf"]).code(2);
    lamp(folder.path(), &["convert", "good.ies", "-o", "good.ies"]).code(2);
}

//! `trade`: the numbers follow from `convert` itself, the recommended settings do what they promise.

use serde_json::Value;

use crate::{Folder, office_led, photopic};

fn run(arguments: &[&str]) -> (i32, String, String) {
    let output = photopic().args(arguments).output().expect("it runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("an exit code"), text(output.stdout), text(output.stderr))
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("one JSON document")
}

/// A path in a folder, as an argument.
fn inside(folder: &Folder, name: &str) -> String {
    folder.path(name).to_str().expect("a plain path").to_owned()
}

/// The illuminance that `convert` gives.
fn illuminance(arguments: &[&str]) -> f64 {
    let file = office_led();
    let all =
        [&["convert", file.to_str().expect("a plain path"), "--json", "--figures", "luminous"], arguments].concat();
    let (code, document, stderr) = run(&all);
    assert_eq!(code, 0, "{stderr}");
    json(&document)["results"][0]["photopic"]["illuminance_lx"].as_f64().expect("a number")
}

#[test]
fn errors_are_those_between_two_conversions_and_the_recommended_one_keeps_its_word() {
    let folder = Folder::new();
    let (settings, picture) = (inside(&folder, "best.toml"), inside(&folder, "trade.svg"));
    let file = office_led();
    let file = file.to_str().expect("a plain path");
    let arguments = ["trade", "spectrum", file, "--error", "0.1%", "--repeats", "1", "--json"];
    let outputs = ["--settings", settings.as_str(), "--plot", picture.as_str()];
    let (code, document, stderr) = run(&[&arguments[..], &outputs[..]].concat());
    assert_eq!(code, 0, "{stderr}");
    let result = json(&document)["results"][0].clone();
    let reference = illuminance(&["--rule", "exact"]);
    let trials = result["trials"].as_array().expect("trials");
    for trial in trials.iter().filter(|t| t["settings"]["precision"] == "f64") {
        let of = |knob: &str| trial["settings"][knob].as_str().expect("a word").trim_end_matches(" nm").to_owned();
        let (step, rule, range, interpolation) = (of("step"), of("rule"), of("range"), of("interpolation"));
        let mut options = vec!["--rule", rule.as_str()];
        if step != "own" {
            options.extend(["--resample", step.as_str(), "--interpolation", interpolation.as_str()]);
        }
        if range != "all" {
            options.extend(["--range", range.as_str()]);
        }
        let expected = (illuminance(&options) / reference - 1.0).abs();
        let error = trial["errors"]["photopic"]["error"].as_f64().expect("a number");
        assert!((error - expected).abs() < 1e-14, "{trial}: {error}, expected {expected}");
    }
    // What is recommended is within what was asked for, by the file as by the figure.
    let bound = result["recommended"]["error_bound"].as_f64().expect("a number");
    let got = (illuminance(&["--settings", settings.as_str()]) / reference - 1.0).abs();
    assert!(got <= bound && bound <= 1e-3, "{got} {bound}");
    assert!(std::fs::read_to_string(&picture).expect("written").starts_with("<svg"));
    // An option of the command line goes before the file.
    let fine = illuminance(&["--settings", settings.as_str(), "--resample", "1", "--rule", "exact"]);
    assert!((fine / reference - 1.0).abs() < 1e-4 && fine != illuminance(&["--settings", settings.as_str()]));
}

#[test]
fn what_cannot_be_had_is_said() {
    let folder = Folder::new();
    let settings = inside(&folder, "wrong.toml");
    std::fs::write(&settings, "[convert]\nrule = \"exact\"\nstep = 5\n").expect("written");
    let file = office_led();
    let file = file.to_str().expect("a plain path");
    let trade = ["trade", "spectrum", file, "--repeats", "1"];
    for (arguments, code, expected) in [
        (vec!["--error", "1e-9"], 1, "T001"),
        (vec!["--error", "5K"], 2, "expected per cent, such as 0.5%, or a fraction"),
        (vec!["--error", "much"], 2, "expected an error such as 0.5%, 0.005 or 20K"),
        (vec!["--figure", "taste"], 2, "`taste`: no such figure; expected one of radiometric, photopic"),
        (vec!["--settings", "x.toml"], 2, "--error"),
        (vec!["--plot", "x.gif"], 2, "x.gif"),
        (vec!["-o", "x.svg", "--plot", "x.svg"], 2, "named for two outputs"),
    ] {
        let (found, _, stderr) = run(&[&trade[..], &arguments].concat());
        assert!(found == code && stderr.contains(expected), "{arguments:?}: {found} {stderr}");
    }
    let (code, _, stderr) = run(&["trade", "spectrum", "line:555nm", "--figure", "cct_k"]);
    assert!(
        code == 2 && stderr.contains("line:555nm: has no cct_k; expected --figure with one of: radiometric"),
        "{stderr}"
    );
    let (code, _, stderr) = run(&["convert", file, "--settings", settings.as_str()]);
    assert!(code == 2 && stderr.contains("wrong.toml:3:1: ") && stderr.contains("step"), "{stderr}");
}

#[test]
fn the_table_has_a_row_per_setting() {
    let (code, table, stderr) = run(&["trade", "spectrum", "LED-B3", "--csv", "--repeats", "2"]);
    assert_eq!(code, 0, "{stderr}");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let header = reader.headers().expect("headers").clone();
    let column = |name: &str| header.iter().position(|h| h == name).expect(name);
    let rows: Vec<csv::StringRecord> = reader.records().map(|r| r.expect("a row")).collect();
    assert!(rows.len() > 20 && rows.iter().all(|r| &r[column("repeats")] == "2"));
    // The reference is among them and has no error; on the front nothing is slower and worse than another.
    assert!(rows.iter().any(|r| &r[column("photopic_error")] == "0" && &r[column("precision")] == "f64"));
    let number = |r: &csv::StringRecord, name: &str| r[column(name)].parse::<f64>().expect("a number");
    let front: Vec<&csv::StringRecord> = rows.iter().filter(|r| &r[column("pareto")] == "true").collect();
    for a in &front {
        let beaten = |b: &&csv::StringRecord| {
            number(b, "time_s") < number(a, "time_s") && number(b, "photopic_error") < number(a, "photopic_error")
        };
        assert!(!rows.iter().any(|b| beaten(&b)), "{a:?}");
    }
}

#[test]
fn the_self_check_passes_and_has_a_row_per_case() {
    let (code, document, stderr) = run(&["selfcheck", "--json"]);
    assert_eq!(code, 0, "{stderr}");
    let document = json(&document);
    let cases = document["results"].as_array().expect("cases");
    let areas: std::collections::BTreeSet<&str> = cases.iter().filter_map(|c| c["area"].as_str()).collect();
    assert_eq!(areas.into_iter().collect::<Vec<_>>(), ["lamps", "materials", "pictures", "scenes", "spectra"]);
    assert!(cases.iter().all(|c| c["passes"] == true && c["error"].as_f64() <= c["allowed"].as_f64()), "{document}");
    let (code, table, _) = run(&["selfcheck", "--csv"]);
    assert_eq!((code, table.lines().count()), (0, cases.len() + 1));
    let (code, text, _) = run(&["selfcheck"]);
    assert!(code == 0 && text.contains("all as expected"), "{text}");
}

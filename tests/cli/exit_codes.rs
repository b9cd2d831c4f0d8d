//! Exit codes, streams and errors as a script sees them.

use std::fs;
use std::io::Read;
use std::process::{Command as Process, Stdio};

use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use serde_json::Value;

use crate::{BINARY, Folder, office_led, photopic};

#[test]
fn what_was_asked_and_done_is_0() {
    for arguments in [
        &["--version"][..],
        &["--help"],
        &["convert", "--help"],
        &["tables"],
        &["tables", "cie-1924-v"],
        &["completions", "bash"],
        &["completions", "zsh"],
        &["completions", "fish"],
        &["man"],
        &["man", "convert"],
        &["convert", "D65"],
    ] {
        photopic().args(arguments).assert().code(0).stdout(is_empty().not());
    }
}

#[test]
fn what_could_not_run_is_2_with_a_word_on_standard_error_and_none_on_standard_output() {
    let folder = Folder::new().with("empty.csv", "").with("blank.csv", "\n\n# nothing\n");
    fs::create_dir(folder.path("folder")).expect("made");
    for arguments in [
        &[][..],
        &["convert"],
        &["shine"],
        &["convert", "--no-such-option", "A"],
        &["convert", "empty.csv"],
        &["convert", "blank.csv"],
        &["convert", "folder"],
        &["convert", "missing.csv"],
        &["convert", "no-such-lamp"],
        &["convert", "A", "--plot", "x.gif"],
        &["convert", "A", "--plot", "x"],
        &["convert", "A", "--json", "--csv"],
        &["convert", "A", "--to", "intensity"],
        &["convert", "A", "--distance", "2"],
        &["convert", "A", "--distance", "-2m"],
        &["convert", "A", "--range", "780-380"],
        &["convert", "A", "--scale-to", "500"],
        &["convert", "A", "--scale-to", "NaN lx"],
        &["convert", "A", "--figures", "nonsense"],
        &["convert", "A", "--unit", "lux"],
        &["convert", "A", "--k-m", "0"],
        &["convert", "A", "--mesopic-adaptation", "-1"],
        &["convert", "blackbody:0K"],
        &["convert", "blackbody:NaN"],
        &["convert", "daylight:3000K"],
        &["convert", "line:-5nm"],
        &["convert", "-", "-"],
        &["tables", "no-such-table"],
        &["man", "no-such-verb"],
        &["completions", "no-such-shell"],
    ] {
        let run = folder.run().args(arguments).write_stdin("").assert().code(2);
        run.stderr(is_empty().not()).stdout(is_empty());
    }
}

#[test]
fn the_version_is_that_of_the_package() {
    photopic().arg("--version").assert().stdout(format!("photopic {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let lamp = office_led();
    let lamp = lamp.to_str().expect("plain path");
    for arguments in [
        &["convert", lamp, "D65", "--json"][..],
        &["convert", lamp],
        &["convert", lamp, "--csv"],
        &["tables", "ies-ces99", "--csv"],
        &["tables", "--json"],
        &["completions", "bash"],
        &["man", "convert"],
        &["--help"],
    ] {
        let mut child =
            Process::new(BINARY).args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("runs");
        drop(child.stdout.take());
        let mut said = String::new();
        child.stderr.take().expect("piped").read_to_string(&mut said).expect("UTF-8");
        let status = child.wait().expect("ends");
        assert_eq!(status.code(), Some(0), "{arguments:?}: {said}");
        assert!(!said.contains("panic") && !said.to_lowercase().contains("pipe"), "{arguments:?}: {said}");
    }
}

#[test]
fn a_fault_is_told_with_file_line_column_what_was_found_expected_and_a_hint() {
    for (text, place, found, expected) in [
        ("wavelength,value\n400,1\n410,2\n410,3\n", "x.csv:4:1: ", "found 410 again (first on line 3)", "; expected "),
        ("wavelength,value\n400,1\n420,2\n410,3\n", "x.csv:4:1: ", "found wavelength 410 after 420", "; expected "),
        ("wavelength,value\n400,1\n420,NaN\n430,3\n", "x.csv:3:5: ", "found `NaN`", "; expected a finite number"),
        ("wavelength,value\n400,1\n420,1\n430,-inf\n", "x.csv:4:5: ", "found `-inf`", "; expected a finite number"),
        ("wavelength,value\n400,1\n420,1e999\n430,3\n", "x.csv:3:5: ", "found `1e999`", "; expected a finite number"),
        ("wavelength,value\n400,1\n420,abc\n430,3\n", "x.csv:3:5: ", "found `abc`", "; expected a number"),
        ("wavelength,value\n400,1\nNaN,2\n430,3\n", "x.csv:3:1: ", "found `NaN`", "; expected "),
        ("wavelength,value\n400,1\n-410,2\n430,3\n", "x.csv:3:1: ", "found wavelength -410", "; expected "),
        ("wavelength,a,b\n400,1,2\n410,1\n420,1,2\n", "x.csv:3:", "found ", "; expected "),
        ("", "x.csv:1:1: ", "found an empty input", "; expected a spectrum"),
    ] {
        let folder = Folder::new().with("x.csv", text);
        let run = folder.run().args(["convert", "x.csv", "--json"]).assert().code(2);
        let said = String::from_utf8(run.get_output().stderr.clone()).expect("UTF-8");
        assert!(said.starts_with(place) && said.contains(found) && said.contains(expected), "{text:?}: {said}");
        // The document says the same, with the place in fields.
        let document: Value = serde_json::from_slice(&run.get_output().stdout).expect("JSON");
        let finding = &document["findings"][0];
        assert_eq!((&finding["severity"], &finding["location"]["path"]), (&"error".into(), &"x.csv".into()));
        assert!(finding["location"]["line"].is_u64() && finding["location"]["column"].is_u64(), "{finding}");
        assert_eq!(document["results"], Value::Array(Vec::new()));
    }
}

#[test]
fn one_bad_file_of_many_is_told_and_the_rest_is_done_in_the_order_given() {
    let spectrum = |peak: u32| format!("wavelength,value [W/m2/nm]\n{},0\n{peak},1\n{},0\n", peak - 10, peak + 10);
    let mut folder = Folder::new().with("bad.csv", "wavelength,value\n400,1\n410,oops\n420,1\n");
    let mut names = Vec::new();
    for k in 0..80 {
        let name = format!("f{k}.csv");
        folder = folder.with(&name, spectrum(400 + 3 * k));
        names.push(name);
        if k == 40 {
            names.push("bad.csv".to_owned());
            names.push("missing.csv".to_owned());
        }
    }
    let run = folder.run().arg("convert").args(&names).arg("--json").assert().code(2);
    let document: Value = serde_json::from_slice(&run.get_output().stdout).expect("JSON");
    let good: Vec<&String> = names.iter().filter(|n| n.starts_with('f')).collect();
    let results = document["results"].as_array().expect("results");
    assert_eq!(results.len(), good.len());
    for (k, (result, name)) in results.iter().zip(&good).enumerate() {
        assert_eq!(result["path"].as_str(), Some(name.as_str()));
        assert_eq!(result["peak_wavelength_nm"].as_f64(), Some(400.0 + 3.0 * k as f64));
    }
    let said = String::from_utf8(run.get_output().stderr.clone()).expect("UTF-8");
    let (bad, missing) = (said.find("bad.csv:3:5: found `oops`"), said.find("missing.csv: "));
    assert!(bad.is_some() && bad < missing, "{said}");
    let errors: Vec<&Value> =
        document["findings"].as_array().expect("findings").iter().filter(|f| f["code"] == "S000").collect();
    assert_eq!(errors.len(), 2, "{errors:?}");
    folder.run().arg("convert").args(&names).args(["--csv", "-q"]).assert().code(2).stdout(contains("f79.csv"));
}

#[test]
fn a_name_that_is_no_source_is_answered_with_those_there_are() {
    let said = contains("LED-B3").and(contains("D65")).and(contains("FL11")).and(contains("blackbody:"));
    photopic().args(["convert", "LED-B9"]).assert().code(2).stderr(said);
    // A mistyped file is told that there is none, not which lamps there are.
    photopic().args(["convert", "lamp.csv"]).assert().code(2).stderr(contains("FL11").not().and(contains("lamp.csv")));
    photopic().args(["tables", "cie-1932-2deg"]).assert().code(2).stderr(contains("cie-1931-2deg"));
}

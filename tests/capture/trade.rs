//! `trade capture`: its errors are those between two runs of `capture brdf`, and what it recommends is what that takes.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use photopic::capture::Manifest;
use serde_json::Value;

use crate::cli::{json, run};
use crate::spheres::{LIGHTS, spheres};

fn trade(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("photopic").expect("the program");
    let output = command.current_dir(folder).args(["trade", "capture"]).args(arguments).output().expect("it runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("an exit code"), text(output.stdout), text(output.stderr))
}

const BINS: &str = "12x10x8";

/// Values of the bins that `capture brdf` measures, by the middle of the bin.
fn bins(folder: &Path, more: &[&str]) -> BTreeMap<String, Vec<f64>> {
    let all = [&["brdf", "capture.toml", "-m", "lambert", "--resolution", BINS, "--csv"], more].concat();
    let (code, out, error) = run(folder, &all);
    assert_eq!(code, 0, "{error}");
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let values = [5, 7, 9].map(|c| cells[c].parse().expect("f_r"));
        (cells[..3].join(","), values.to_vec())
    };
    out.lines().skip(1).map(row).collect()
}

/// Value by nearest rank.
fn percentile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[(share * values.len() as f64).ceil() as usize - 1]
}

#[test]
fn errors_are_those_between_two_runs_and_the_recommended_setting_is_taken() {
    let folder = spheres(&[LIGHTS[0], LIGHTS[1], LIGHTS[2], [0.9, -0.6, -0.2]]);
    let folder = folder.path();
    let asked = ["capture.toml", "--resolution", BINS, "--repeats", "1", "--error", "2%", "--json"];
    let (code, out, error) = trade(folder, &[&asked[..], &["--settings", "less.toml", "--plot", "x.svg"]].concat());
    assert_eq!(code, 0, "{error}");
    let result = json(&out)["results"][0].clone();
    let trials = result["trials"].as_array().expect("trials");
    // 4, 2, 1 lights, one exposure, every 1st, 2nd, 4th, 8th pixel.
    assert_eq!(trials.len(), 12);
    let finest = bins(folder, &[]);
    let number = |v: &Value| v.as_f64().expect("a number");
    for trial in trials {
        let of = |knob: &str| trial["settings"][knob].as_str().expect("a word").to_owned();
        let found = bins(folder, &["--lights", &of("lights"), "--every", &of("every"), "--exposures", "1"]);
        let both = finest.iter().filter_map(|(at, a)| Some((a, found.get(at)?)));
        let mut apart: Vec<f64> = both.flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (b / a - 1.0).abs())).collect();
        let mut all = apart.clone();
        all.resize(3 * finest.len(), f64::INFINITY);
        let lost = 1.0 - found.len() as f64 / finest.len() as f64;
        for (figure, expected) in
            [("f_r_median", percentile(&mut all, 0.5)), ("f_r_p90", percentile(&mut all, 0.9)), ("coverage_lost", lost)]
        {
            // What is lost is off by more than any number.
            let error = trial["errors"][figure]["error"].as_f64().unwrap_or(f64::INFINITY);
            assert!(
                error == expected || (error - expected).abs() < 1e-14,
                "{trial}: {figure} {error}, expected {expected}"
            );
        }
        // The sphere is white, 0.5, to half a unit of 65535 where radiance is 0.08 of it: either run is off by 1e-4 at most.
        assert!(percentile(&mut apart, 1.0) < 2e-4, "{trial}");
        assert!(number(&trial["errors"]["lambert.reflectance.R"]["error"]) < 2e-4, "{trial}");
        // Never less than the finest's own standard error.
        let own = number(&result["reference_errors"]["f_r_median"]);
        let bound = trial["error_bound"].as_f64().unwrap_or(f64::INFINITY);
        assert!(own > 0.0 && bound >= own && (lost < 0.5 || bound == f64::INFINITY), "{trial}");
    }
    assert!(trials.iter().any(|t| number(&t["errors"]["coverage_lost"]["error"]) > 0.1));
    assert!(fs::read_to_string(folder.join("x.svg")).expect("written").starts_with("<svg"));
    // What is recommended is taken by the file as by its options, which go before it.
    let of = |knob: &str| result["recommended"]["settings"][knob].as_str().expect("a word").to_owned();
    let by_options = bins(folder, &["--lights", &of("lights"), "--every", &of("every")]);
    assert_eq!(bins(folder, &["--settings", "less.toml"]), by_options);
    let all = ["--settings", "less.toml", "--lights", "4", "--every", "1"];
    assert_eq!(bins(folder, &all), finest);
    // Nothing but coverage is lost of a white sphere; that only the finest keeps.
    let (code, out, _) =
        trade(folder, &[&asked[..5], &["--figure", "coverage_lost", "--error", "1e-9", "--json"]].concat());
    let recommended = &json(&out)["results"][0]["recommended"]["settings"];
    assert!(code == 0 && recommended["lights"] == "4" && recommended["every"] == "1", "{recommended}");
}

/// A white sphere of reflectance 0.5 is carried by a Lambertian model, one band, few photographs; what is told is what `trade` measures.
#[test]
fn photographs_require_what_the_trade_confirms() {
    let folder = spheres(&[LIGHTS[0], LIGHTS[1], LIGHTS[2], [0.9, -0.6, -0.2]]);
    let folder = folder.path();
    let run = |arguments: &[&str]| {
        let mut command = Command::cargo_bin("photopic").expect("the program");
        let output = command.current_dir(folder).args(arguments).output().expect("it runs");
        let code = output.status.code().expect("an exit code");
        assert!(code < 2, "{}", String::from_utf8_lossy(&output.stderr));
        (code, json(&String::from_utf8(output.stdout).expect("UTF-8"))["results"][0].clone())
    };
    let (code, result) = run(&["require", "capture.toml", "--error", "1%", "--json"]);
    assert!(code == 0 && result["kind"] == "capture", "{result}");
    let question = |name: &str| {
        let all = result["requirements"].as_array().expect("requirements");
        all.iter().find(|r| r["question"] == name).unwrap_or_else(|| panic!("{name} in {result}")).clone()
    };
    for (name, model) in
        [("bands", "one band for all"), ("form", "the model lambert"), ("azimuth", "isotropic (three angles)")]
    {
        let found = question(name);
        assert!(found["needed"]["model"] == model && found["simpler"].is_null(), "{found}");
    }
    // The same numbers by `trade`, for every rung.
    let (_, trade) = run(&["trade", "capture", "capture.toml", "--repeats", "1", "--json"]);
    let bound = |lights: &str, every: &str| {
        let trials = trade["trials"].as_array().expect("trials");
        let is = |t: &&Value| t["settings"]["lights"] == lights && t["settings"]["every"] == every;
        trials.iter().find(is).expect("it was tried")["error_bound"].clone()
    };
    for (name, settings) in
        [("photographs", [("1", "1"), ("2", "1"), ("4", "1")]), ("pixels", [("4", "8"), ("4", "4"), ("4", "2")])]
    {
        let found = question(name);
        for (rung, (lights, every)) in found["rungs"].as_array().expect("rungs").iter().zip(settings) {
            assert_eq!(rung["error"], bound(lights, every), "{name}: {rung}");
        }
        // One light of four loses more than half of the bins, every 8th pixel as well; all of them carry it.
        assert!(found["needed"]["error"].as_f64().is_some_and(|e| e <= 0.01), "{found}");
        assert!(found["simpler"]["error"].as_f64().is_none_or(|e| e > 0.01), "{found}");
    }
}

#[test]
fn what_cannot_be_had_is_said() {
    let folder = spheres(&LIGHTS[..1]);
    let folder = folder.path();
    fs::write(folder.join("wrong.toml"), "[capture]\nevery = 2\nphotos = 3\n").expect("written");
    fs::write(folder.join("none.toml"), "").expect("written");
    for (arguments, code, expected) in [
        (&["capture.toml", "--error", "1e-12"][..], 1, "T001"),
        (&["capture.toml", "--figure", "taste"], 2, "`taste`: no such figure; expected one of f_r_median, f_r_p90"),
        (&["capture.toml", "--error", "5K"], 2, "expected per cent, such as 0.5%, or a fraction"),
        (&["0.tif"], 2, "0.tif: expected a manifest"),
        (&["none.toml"], 2, "found no [[stack]] of the object"),
        (&["gone.toml"], 2, "gone.toml: cannot be read"),
    ] {
        let (found, _, error) = trade(folder, &[arguments, &["--repeats", "1", "--resolution", BINS]].concat());
        assert!(found == code && error.contains(expected), "{arguments:?}: {found} {error}");
    }
    for (arguments, expected) in [
        (["--lights", "0"], "found 0 for --every, --lights or --exposures"),
        (["--settings", "wrong.toml"], "wrong.toml:3:1: "),
    ] {
        let (code, _, error) = run(folder, &[&["brdf", "capture.toml", "-m", "lambert"], &arguments[..]].concat());
        assert!(code == 2 && error.contains(expected), "{arguments:?}: {error}");
    }
}

#[test]
fn the_middles_of_equal_parts_are_kept() {
    let mut text = String::new();
    for (light, shows) in [("a", "object"), ("b", "object"), ("c", "object"), ("d", "object"), ("b", "reference")] {
        text += &format!(
            "[[stack]]\nname = \"{light}-{shows}\"\nlight = \"{light}\"\nshows = \"{shows}\"\nexposures = [\
             {{ photo = \"long\", time_s = 4 }}, {{ photo = \"short\", time_s = 0.25 }}, {{ photo = \"middle\", time_s = 1 }}]\n"
        );
    }
    let left = |lights: usize, exposures: usize| {
        let mut manifest = Manifest::parse(&text).expect("a manifest");
        manifest.keep(lights, exposures);
        let photos =
            |s: &photopic::capture::manifest::Stack| s.exposures.iter().map(|e| e.photo.clone()).collect::<Vec<_>>();
        (manifest.stack.iter().map(|s| s.name.clone()).collect::<Vec<_>>(), photos(&manifest.stack[0]))
    };
    // Of four lights the second and the fourth, with what they light beside the object; of three times the middle one.
    assert_eq!(
        left(2, 1),
        (["b-object", "d-object", "b-reference"].map(str::to_owned).to_vec(), vec!["middle".to_owned()])
    );
    // Of three times two: those in the first and the last part, 3/4 and 9/4 rounded down.
    assert_eq!(left(1, 2), (vec!["c-object".to_owned()], vec!["short".to_owned(), "long".to_owned()]));
    assert_eq!(left(9, 9).0.len(), 5);
    assert_eq!(left(9, 9).1, ["long", "short", "middle"]);
}

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
        let thin = step.strip_prefix("adaptive to ");
        if let Some(tolerance) = thin {
            options.extend(["--thin", tolerance]);
        } else if step != "own" {
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
    assert_eq!(
        areas.into_iter().collect::<Vec<_>>(),
        ["captures", "colour", "lamps", "materials", "photometry", "pictures", "scenes", "spectra"]
    );
    assert!(cases.iter().all(|c| c["passes"] == true && c["error"].as_f64() <= c["allowed"].as_f64()), "{document}");
    let (code, table, _) = run(&["selfcheck", "--csv"]);
    assert_eq!((code, table.lines().count()), (0, cases.len() + 1));
    let (code, text, _) = run(&["selfcheck"]);
    assert!(code == 0 && text.contains("all as expected"), "{text}");
}

/// A lamp that ships with the tool.
fn street() -> String {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("data/lamps/street.ies").display().to_string()
}

/// A number of the answer of a verb about lamps.
fn of_lamp(arguments: &[&str], key: &str) -> f64 {
    let (code, document, stderr) = run(&[arguments, &["--json"]].concat());
    assert_eq!(code, 0, "{stderr}");
    json(&document)["results"][0][key].as_f64().unwrap_or_else(|| panic!("{key} of {arguments:?}"))
}

#[test]
fn a_lamp_with_fewer_angles_is_as_far_off_as_the_trade_says() {
    let folder = Folder::new();
    let (settings, best, picture) =
        (inside(&folder, "few.toml"), inside(&folder, "best.toml"), inside(&folder, "trade.png"));
    let street = street();
    let trade = ["trade", "lamp", &street, "--repeats", "1", "--json", "--figure", "flux", "--error", "6%"];
    let (code, document, stderr) = run(&[&trade[..], &["--settings", &best, "--plot", &picture]].concat());
    assert_eq!(code, 0, "{stderr}");
    let result = json(&document)["results"][0].clone();
    // The reference is what `lamp info` says, its own error the other interpolation's.
    let whole = of_lamp(&["lamp", "info", &street], "total_flux_lm");
    let cubic = of_lamp(&["lamp", "info", &street, "--interpolation", "monotone-cubic"], "total_flux_lm");
    let own = result["reference_errors"]["flux"].as_f64().expect("a number");
    assert!((own - (cubic / whole - 1.0).abs()).abs() < 1e-12, "{own}, {cubic} of {whole}");
    // `lamp convert` leaves out what settings say, and loses as much flux as the trade found.
    let text =
        "[lamp]\nevery_horizontal = 4\nevery_vertical = 4\ninterpolation = \"monotone-cubic\"\nnear_ratio = 0.0\n";
    std::fs::write(&settings, text).expect("written");
    let few = inside(&folder, "few.ies");
    let (code, _, stderr) = run(&["lamp", "convert", &street, "-o", &few, "--settings", &settings]);
    assert_eq!(code, 0, "{stderr}");
    let trials = result["trials"].as_array().expect("trials");
    let is = |t: &&Value, expected: [&str; 5]| {
        let knobs = ["every_horizontal", "every_vertical", "interpolation", "near_ratio", "precision"];
        knobs.iter().zip(expected).all(|(k, v)| t["settings"][*k] == v)
    };
    let trial = trials.iter().find(|t| is(t, ["4", "4", "monotone-cubic", "0", "f64"])).expect("it was tried");
    let error = trial["errors"]["flux"]["error"].as_f64().expect("a number");
    let found = of_lamp(&["lamp", "info", &few, "--interpolation", "monotone-cubic"], "total_flux_lm");
    // Candelas are written as read, so that nothing but the angles differs.
    assert!(((found / whole - 1.0).abs() - error).abs() < 1e-9 && error > 0.0, "{found} of {whole}, {error}");
    // `lamp grid` takes the file, and the command line goes before it.
    let mean = |options: &[&str]| {
        let grid = ["lamp", "grid", &street, "--height", "3", "--plane", "-6,-6 6,6"];
        of_lamp(&[&grid[..], options].concat(), "mean_illuminance_lx")
    };
    let coarse = mean(&["--settings", &settings]);
    let same = mean(&["--settings", &settings, "--near", "0", "--interpolation", "monotone-cubic"]);
    assert!(coarse == same && coarse != mean(&[]), "{coarse} {same}");
    assert!(mean(&["--settings", &settings, "--near", "20"]) != coarse);
    assert!(mean(&["--settings", &settings, "--interpolation", "bilinear"]) != coarse);
    // What is recommended is what is written.
    let written = std::fs::read_to_string(&best).expect("written");
    let recommended = &result["recommended"];
    assert!(recommended["error_bound"].as_f64().is_some_and(|e| e <= 0.06), "{recommended}");
    for knob in ["every_horizontal", "every_vertical", "near_ratio"] {
        let value = recommended["settings"][knob].as_str().expect("a word");
        assert!(written.contains(&format!("{knob} = {value}")), "{knob} {value}: {written}");
    }
    assert!(std::fs::read(&picture).expect("written").starts_with(b"\x89PNG"));
}

#[test]
fn lamps_and_settings_that_do_not_fit_are_told() {
    let folder = Folder::new();
    let wrong = inside(&folder, "wrong.toml");
    std::fs::write(&wrong, "[lamp]\nevery_vertical = 0\n").expect("written");
    let street = street();
    for (arguments, expected) in [
        (vec!["trade", "lamp", &street, "--height", "0"], "a mounting height of 0; expected a length above 0 m"),
        (vec!["trade", "lamp", &street, "--figure", "taste"], "expected one of flux, peak_intensity"),
        (vec!["trade", "lamp", &street, "--error", "3K"], "expected per cent"),
        (vec!["trade", "lamp", "no.ies"], "no.ies: cannot be read"),
        (vec!["lamp", "grid", &street, "--height", "3", "--settings", &wrong], "every 0th angle; expected 1"),
    ] {
        let (code, _, stderr) = run(&arguments);
        assert!(code == 2 && stderr.contains(expected), "{arguments:?}: {code} {stderr}");
    }
}

/// The answers of `require`, by question.
fn required(arguments: &[&str]) -> (i32, Vec<Value>) {
    let (code, document, stderr) = run(&[&["require", "--json"], arguments].concat());
    assert!(code < 2, "{stderr}");
    (code, json(&document)["results"].as_array().expect("results").clone())
}

fn question<'a>(result: &'a Value, name: &str) -> &'a Value {
    let all = result["requirements"].as_array().expect("requirements");
    all.iter().find(|r| r["question"] == name).unwrap_or_else(|| panic!("{name} in {result}"))
}

#[test]
fn the_samples_that_a_spectrum_requires_are_those_that_convert_confirms() {
    let file = office_led();
    let file = file.to_str().expect("a plain path");
    let (code, results) = required(&[file, "--error", "0.1%"]);
    assert_eq!((code, results[0]["kind"].as_str()), (0, Some("spectrum")));
    let samples = question(&results[0], "wavelengths");
    let trade = ["trade", "spectrum", file, "--json", "--repeats", "1"];
    let own = json(&run(&trade).1)["results"][0]["reference_errors"]["photopic"].as_f64().expect("a number");
    let reference = illuminance(&["--rule", "exact"]);
    for rung in ["needed", "simpler"] {
        let model = samples[rung]["model"].as_str().expect("a model");
        let step = model.split_whitespace().nth(1).expect("samples N nm apart");
        // Both ways: with and without those between.
        let errors = ["summation", "trapezoid", "exact"].into_iter().flat_map(|rule| {
            let kinds = ["linear", "sprague", "cubic", "pchip"];
            kinds.map(|kind| {
                (illuminance(&["--rule", rule, "--resample", step, "--interpolation", kind]) / reference - 1.0).abs()
            })
        });
        let best = errors.fold(f64::INFINITY, f64::min) + own;
        let error = samples[rung]["error"].as_f64().expect("a number");
        assert!((error - best).abs() < 1e-12, "{rung} {model}: {error}, {best}");
        assert_eq!(error <= 1e-3, rung == "needed", "{rung} {model}: {error}");
    }
}

#[test]
fn lamps_and_materials_are_told_by_content_and_answered() {
    let lambert = "lambert(reflectance=0.5)";
    let (_, results) = required(&[&street(), lambert, "--error", "5%"]);
    let kinds: Vec<&str> = results.iter().filter_map(|r| r["kind"].as_str()).collect();
    assert_eq!(kinds, ["lamp", "material"]);
    // The file's planes are those of one half, and its road is lit along it.
    let symmetry = question(&results[0], "symmetry");
    assert_eq!(symmetry["needed"]["model"], "planes of one half (about C0-C180)");
    assert!(symmetry["simpler"]["error"].as_f64().is_some_and(|e| e > 0.05), "{symmetry}");
    assert_eq!(question(&results[1], "azimuth")["needed"]["model"], "isotropic (three angles)");
    let form = question(&results[1], "form");
    assert!(form["needed"]["model"] == "the model lambert" && form["simpler"].is_null(), "{form}");
    let brushed = "ward(ks=0.5, alpha_x=0.05, alpha_y=0.3)";
    let (_, results) = required(&[brushed]);
    let azimuth = question(&results[0], "azimuth");
    assert_eq!(azimuth["needed"]["model"], "anisotropic (four angles)", "{azimuth}");
    // What no model carries is an answer; what cannot be read is none, and the others are answered all the same.
    let (code, table, stderr) = run(&["require", "LED-B3", "none.ies", "--error", "1e-12", "--csv"]);
    assert!(code == 2 && stderr.contains("none.ies") && table.starts_with("path,question,figure,model,error,needed\n"));
    assert!(table.lines().filter(|l| l.starts_with("LED-B3,")).count() > 4, "{table}");
    let (code, text, stderr) = run(&["require", &street(), "--error", "1e-9"]);
    assert!(code == 1 && stderr.contains("T003") && text.contains("none of those tried"), "{text} {stderr}");
    let (code, _, stderr) = run(&["require", "-"]);
    assert!(code == 2 && stderr.contains("expected --as KIND"), "{stderr}");
}

#[test]
fn a_material_is_traded_and_its_settings_are_taken() {
    let folder = Folder::new();
    let (settings, table) = (inside(&folder, "form.toml"), inside(&folder, "small.binary"));
    let gloss = "lambert(reflectance=0.2) + ggx(alpha=0.3, eta=1.5)";
    let trade = ["trade", "brdf", gloss, "-w", "650,550,450", "--repeats", "1", "--json", "--settings", &settings];
    let (code, document, stderr) = run(&[&trade[..], &["--error", "0.2"]].concat());
    assert_eq!(code, 0, "{stderr}");
    let result = json(&document)["results"][0].clone();
    assert!(result["recommended"]["error_bound"].as_f64().is_some_and(|e| e <= 0.2), "{}", result["recommended"]);
    let written = std::fs::read_to_string(&settings).expect("written");
    assert!(written.contains("resolution = \"") != written.contains("model = \""), "{written}");
    std::fs::write(&settings, "[brdf]\nresolution = \"16x16x8\"\n").expect("written");
    let (code, _, stderr) = run(&["brdf", "convert", gloss, "-o", &table, "--settings", &settings]);
    assert_eq!(code, 0, "{stderr}");
    // MERL: three counts of 4 bytes, then 8 for each value.
    assert_eq!(std::fs::metadata(&table).expect("written").len(), 12 + 8 * 3 * 16 * 16 * 8);
    std::fs::write(&settings, "[brdf]\nmodel = \"lambert\"\n").expect("written");
    let (code, fits, stderr) = run(&["brdf", "fit", &table, "--settings", &settings, "--csv"]);
    assert!(code == 0 && fits.contains("lambert"), "{fits} {stderr}");
    let (code, _, stderr) = run(&["brdf", "convert", gloss, "-o", &table, "--settings", &settings]);
    assert!(code == 2 && stderr.contains("form.toml:1:1: found no `resolution`"), "{stderr}");
    let (code, _, stderr) = run(&["trade", "brdf", "mirror(reflectance=0.9)"]);
    assert!(code == 2 && stderr.contains("nothing but a Dirac lobe"), "{stderr}");
}

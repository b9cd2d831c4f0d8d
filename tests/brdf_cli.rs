//! `photopic brdf` as a user meets it: descriptions, files, answers, errors, exit codes.

mod common;

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use photopic::brdf::description::{Bands, Material};
use photopic::brdf::format::open;
use photopic::brdf::table::Resolution;
use serde_json::Value;

/// Runs the program; exit code, standard output and standard error.
fn run(arguments: &[&str], input: &str) -> (i32, String, String) {
    let mut command = Command::cargo_bin("photopic").expect("the program");
    let output = command.arg("brdf").args(arguments).write_stdin(input).output().expect("it runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("an exit code"), text(output.stdout), text(output.stderr))
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("one JSON document")
}

#[test]
fn values_come_as_text_table_and_json() {
    // f = ρ/π.
    let expected = 0.5 / std::f64::consts::PI;
    let arguments = ["eval", "lambert(reflectance=0.5)", "--theta-i", "0:60:30", "--theta-o", "10,20", "-w", "450,550"];
    let (code, table, _) = run(&[&arguments[..], &["--csv"]].concat(), "");
    assert_eq!(code, 0);
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    assert_eq!(reader.headers().expect("headers").iter().skip(7).collect::<Vec<_>>(), ["brdf_per_sr", "measured"]);
    let rows: Vec<csv::StringRecord> = reader.records().map(|r| r.expect("a row")).collect();
    // Three angles, two angles, two azimuths, two wavelengths.
    assert_eq!(rows.len(), 3 * 2 * 2 * 2);
    assert!(rows.iter().all(|r| (r[7].parse::<f64>().expect("a value") - expected).abs() < 1e-15));
    assert_eq!((&rows[1][1], &rows[1][3], &rows[1][4], &rows[1][5]), ("0", "10", "0", "550"));
    let (code, document, _) = run(&[&arguments[..], &["--json"]].concat(), "");
    let result = &json(&document)["results"][0];
    assert_eq!((code, result["rows"].as_array().map(Vec::len)), (0, Some(12)));
    assert_eq!(result["wavelengths_nm"], serde_json::json!([450.0, 550.0]));
    assert_eq!(result["rows"][11]["theta_i_deg"], 60.0);
    let (code, text, _) = run(&arguments, "");
    assert!(code == 0 && text.contains("0.159155"), "{text}");
}

#[test]
fn a_check_answers_by_exit_code_and_says_where() {
    let (code, document, _) = run(&["check", "ggx(alpha=0.2, medium=Au)", "--json"], "");
    let result = &json(&document)["results"][0];
    assert_eq!((code, &result["passes"]), (0, &Value::Bool(true)));
    for key in ["reciprocity_max_relative", "albedo_max", "albedo_max_at_deg", "negative_fraction", "measured_fraction"]
    {
        assert!(result[key].is_number(), "{key}: {result}");
    }
    let (code, document, _) = run(&["check", "phong(kd=0.1, ks=1, n=20, form=classic)", "--json"], "");
    let document = json(&document);
    assert_eq!((code, &document["results"][0]["passes"]), (1, &Value::Bool(false)));
    let codes: Vec<&str> =
        document["findings"].as_array().expect("findings").iter().filter_map(|f| f["code"].as_str()).collect();
    assert_eq!(codes, ["B001", "B002"]);
    let (code, text, _) = run(&["check", "phong(kd=0.1, ks=1, n=20, form=classic)"], "");
    assert!(
        code == 1 && text.contains("not reciprocal") && text.contains("at θi") && text.contains("albedo 1."),
        "{text}"
    );
    // Looser limits let it pass.
    let (code, _, _) =
        run(&["check", "phong(kd=0.1, ks=1, n=20, form=classic)", "--reciprocity", "1", "--albedo", "3"], "");
    assert_eq!(code, 0);
    // A lobe with negative values: f0 − c f1 with f1 above f0.
    let negative = "sgd(rho_s=1, alpha=0.1, p=0.5, kappa=10, f0=0.1, f1=0.5, lambda=0, gamma=0, k=1, theta0=0)";
    let (code, text, _) = run(&["check", negative], "");
    assert!(code == 1 && text.contains("B003: negative in"), "{text}");
}

#[test]
fn files_hold_materials_and_standard_input_is_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("gold.toml");
    let text = "name = \"gold paint\"\nsum = [\"0.5*lambert(reflectance=0.3)\", { weight = 0.5, model = \"ggx\", alpha = 0.1, medium = \"Au\" }]\n";
    fs::write(&path, text).expect("written");
    let path = path.to_str().expect("a plain path");
    let spelt = "0.5*lambert(reflectance=0.3) + 0.5*ggx(alpha=0.1, medium=Au)";
    let rows = |argument: &str, input: &str| {
        let (code, document, stderr) = run(&["eval", argument, "--json"], input);
        assert_eq!(code, 0, "{stderr}");
        let document = json(&document);
        (document["results"][0]["rows"].clone(), document["inputs"][0]["sha256"].is_string())
    };
    assert_eq!(rows(path, ""), (rows(spelt, "").0, true));
    assert_eq!(rows("-", text).0, rows(spelt, "").0);
    assert!(!rows(spelt, "").1);
    let (_, text, _) = run(&["info", path], "");
    assert!(text.contains("[gold paint]") && text.contains("hemispherical – hemispherical"), "{text}");
}

#[test]
fn errors_have_a_place_and_exit_with_2() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).expect("written");
        path.to_str().expect("a plain path").to_owned()
    };
    let (empty, bad) = (file("empty.toml", ""), file("bad.toml", "model = \"ggx\"\nalpha = 0.1\nmedium = \"Xx\"\n"));
    let binary = folder.path().join("binary.toml");
    fs::write(&binary, [0xff, 0xfe, 0x00]).expect("written");
    for (argument, expected) in [
        ("nowhere.toml", "nowhere.toml: there is no such file; expected a file, or a description"),
        ("ggx(alpha=3, eta=1.5)", "1:11: `alpha` is 3; expected a number from 1e-6 to 1"),
        ("ggx(alhpa=3)", "1:5: `ggx` has no parameter `alhpa`; expected alpha: a number from 1e-6 to 1 (roughness)"),
        (empty.as_str(), "empty.toml:1:1: found a table without material"),
        (bad.as_str(), "bad.toml:3:10: no substance is called `Xx`"),
        (binary.to_str().expect("a plain path"), "not UTF-8"),
    ] {
        for verb in ["info", "check", "eval"] {
            let (code, _, stderr) = run(&[verb, argument], "");
            assert!(code == 2 && stderr.contains(expected), "{verb} {argument}: {code} {stderr}");
        }
        let picture = folder.path().join("x.svg");
        let (code, _, stderr) = run(&["plot", argument, "-o", picture.to_str().expect("a plain path")], "");
        assert!(code == 2 && stderr.contains(expected) && !picture.exists(), "plot {argument}: {stderr}");
    }
    // The rest is still done.
    let (code, text, _) = run(&["eval", "nowhere.toml", "lambert(reflectance=1)"], "");
    assert!(code == 2 && text.contains("0.318310"), "{text}");
    for (arguments, expected) in [
        (vec!["eval", "mirror()", "--theta-i", "100"], "expected 0 to 90 degrees"),
        (vec!["eval", "mirror()", "--theta-i", "0:80"], "expected a range"),
        (vec!["eval", "mirror()", "--theta-i", "0:80:-1"], "by a step above 0"),
        (vec!["eval", "ggx(alpha=0.1, medium=Au)", "-w", "1500"], "`Au` is known from 354.2 to 892 nm"),
        (vec!["plot", "mirror()", "-o", "x.jpg"], "ending in .svg or .png"),
    ] {
        let (code, _, stderr) = run(&arguments, "");
        assert!(code == 2 && stderr.contains(expected), "{arguments:?}: {stderr}");
    }
}

#[test]
fn dirac_lobes_are_said_to_be_missing_from_values() {
    let (code, _, stderr) = run(&["eval", "mirror()"], "");
    assert!(code == 0 && stderr.contains("B006") && stderr.contains("brdf info"), "{stderr}");
    let (_, document, _) = run(&["info", "mirror(reflectance=0.9)", "--json"], "");
    let result = &json(&document)["results"][0];
    assert_eq!((&result["kind"], &result["albedo"][3]["albedo"][0]), (&"delta".into(), &0.9.into()));
    // Both directional on the mirror direction: there is no value.
    assert_eq!(result["reflectances"][0]["reflectance_factor"], Value::Null);
    assert_eq!(result["reflectances"].as_array().map(Vec::len), Some(9));
}

#[test]
fn pictures_are_drawn_in_both_formats() {
    let folder = tempfile::tempdir().expect("a folder");
    for (kind, name) in [
        ("all", "a.svg"),
        ("polar", "b.png"),
        ("log", "c.svg"),
        ("albedo", "d.svg"),
        ("sphere", "e.png"),
        ("lobe", "f.svg"),
    ] {
        let path = folder.path().join(name);
        let text = path.to_str().expect("a plain path");
        let (code, _, stderr) = run(&["plot", "ggx(alpha=0.2, medium=Cu)", "-k", kind, "-o", text], "");
        assert_eq!(code, 0, "{kind}: {stderr}");
        let bytes = fs::read(Path::new(text)).expect("a picture");
        assert!(
            if name.ends_with("png") {
                bytes.starts_with(b"\x89PNG")
            } else {
                bytes.starts_with(b"<svg") || bytes.starts_with(b"<?xml")
            },
            "{kind}"
        );
        if kind == "all" {
            let svg = String::from_utf8(bytes).expect("text");
            // The lobe at 45°, the axis of the logarithm, the level of an albedo of 1, the sphere.
            for word in ["light at 45°", "BRDF [1/sr]", "directional-hemispherical reflectance", "lit sphere"] {
                assert!(svg.contains(word), "{word}");
            }
        }
    }
}

#[test]
fn a_table_is_compressed_measured_and_inferred() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("a plain path").to_owned();
    let basis = path("set.basis");
    let materials = ["lambert(reflectance=0.1)", "ggx(alpha=0.3, medium=Au)", "ggx(alpha=0.2, medium=Cu)"];
    let compress = |arguments: &[&str]| run(&[&["compress"], arguments].concat(), "");
    let bins = ["--resolution", "8x8x6", "-o", basis.as_str()];
    let (code, _, stderr) = compress(&[&["train"], &materials[..], &bins[..]].concat());
    assert_eq!(code, 0, "{stderr}");
    let (csv, table, mask) = (path("c.csv"), path("t.binary"), path("t.mask"));
    let (code, _, stderr) = compress(&["encode", materials[1], "-b", &basis, "--csv", "-o", &csv]);
    assert_eq!(code, 0, "{stderr}");
    let (code, _, stderr) = compress(&["decode", &csv, "-b", &basis, "-o", &table, "--mask", &mask]);
    assert_eq!(code, 0, "{stderr}");
    // Three numbers of bins; three planes of doubles, and a byte per bin.
    let bins = 8 * 8 * 6;
    assert_eq!(fs::read(&table).expect("a table").len(), 12 + 24 * bins);
    let known = fs::read(&mask).expect("a mask");
    assert!(known.len() == 12 + bins && !known[12..].contains(&2));
    // Measured where it says: those bins, and no others.
    let (_, chosen, _) = compress(&["directions", "-b", &basis, "-n", "3", "--csv"]);
    let rows: Vec<&str> = chosen.lines().skip(1).collect();
    let points: String = rows.iter().map(|r| ["R", "G", "B"].map(|c| format!("{r},{c},0.2\n")).concat()).collect();
    let measured = path("m.csv");
    let head = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,number,bin,channel,value\n";
    fs::write(&measured, format!("{head}{points}")).expect("written");
    let (code, _, stderr) = compress(&["infer", &measured, "-b", &basis, "-o", &table, "--mask", &mask]);
    assert_eq!(code, 0, "{stderr}");
    let known = fs::read(&mask).expect("a mask");
    let mut expected: Vec<usize> =
        rows.iter().map(|r| r.rsplit(',').next().and_then(|b| b.parse().ok()).expect("a bin")).collect();
    expected.sort_unstable();
    let found: Vec<usize> = (0..bins).filter(|b| known[12 + b] == 2).collect();
    assert_eq!(found, expected);
    // A damaged basis is refused.
    let mut bytes = fs::read(&basis).expect("a basis");
    let middle = bytes.len() - 40;
    bytes[middle] ^= 1;
    fs::write(&basis, bytes).expect("written");
    let (code, _, stderr) = compress(&["directions", "-b", &basis]);
    assert!(code == 2 && stderr.contains("set.basis: found"), "{stderr}");
}

#[test]
fn wrong_points_and_wrong_bases_are_one_error_each() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("a plain path").to_owned();
    let compress = |arguments: &[&str]| run(&[&["compress"], arguments].concat(), "");
    let (basis, other, csv, points, out) = (path("a.basis"), path("b.basis"), path("c.csv"), path("m.csv"), path("o"));
    let gold = "ggx(alpha=0.3, medium=Au)";
    let train = |materials: &[&str], basis: &str| {
        let rest = ["--resolution", "8x8x6", "-o", basis];
        let (code, _, stderr) = compress(&[&["train"], materials, &rest[..]].concat());
        assert_eq!(code, 0, "{stderr}");
    };
    train(&["lambert(reflectance=0.1)", gold, "ggx(alpha=0.2, medium=Cu)"], &basis);
    train(&["lambert(reflectance=0.2)", gold, "beckmann(alpha=0.2, medium=Cu)"], &other);
    let (code, _, stderr) = compress(&["encode", gold, "-b", &basis, "--csv", "-o", &csv]);
    assert_eq!(code, 0, "{stderr}");
    let refused = |arguments: &[&str], words: &str| {
        let (code, _, stderr) = compress(&[arguments, &["-o", &out]].concat());
        let errors = stderr.lines().filter(|l| l.starts_with("error")).count();
        assert!(code == 2 && errors == 1 && stderr.contains(words), "{words}: {stderr}");
        assert!(!Path::new(&out).exists(), "{words}");
    };
    refused(&["decode", &csv, "-b", &other], "c.csv:2:1: found `");
    refused(&["decode", &csv, "-b", &csv], "c.csv: found no basis; expected a file that `brdf compress train` wrote");
    refused(&["decode", &basis, "-b", &basis], "a.basis:");
    refused(&["infer", gold, "-b", &basis], "found a model; expected a list of measured points");
    let head = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value";
    for (rows, words) in [
        ("30,0,30,180,0.1\n30.1,0,30.1,180,0.2\n", "in the same bin as point 1; expected one value per bin"),
        ("30,0,30,180,much\n", "m.csv:2:"),
        ("30,0,30\n", "m.csv:2:"),
        ("", "m.csv:"),
    ] {
        fs::write(&points, format!("{head}\n{rows}")).expect("written");
        refused(&["infer", &points, "-b", &basis], words);
    }
}

#[test]
fn what_was_not_measured_is_marked_in_every_drawing() {
    let folder = tempfile::tempdir().expect("a folder");
    // A diffuser, lit at 30° and 45° and seen up to 40°.
    let mut table = String::from("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value\n");
    for (lit, theta) in [30, 45].into_iter().flat_map(|lit| (0..=40).step_by(5).map(move |theta| (lit, theta))) {
        for phi in (0..if theta > 0 { 360 } else { 1 }).step_by(15) {
            table += &format!("{lit},0,{theta},{phi},0.1\n");
        }
    }
    let (file, picture) = (folder.path().join("paint.csv"), folder.path().join("p.svg"));
    fs::write(&file, table).expect("written");
    let (file, picture) = (file.to_str().expect("a plain path"), picture.to_str().expect("a plain path"));
    let model = "lambert(reflectance=0.5)";
    for (kind, words) in [
        ("polar", "curves not measured"),
        ("log", "not measured: the table"),
        ("albedo", "where nothing was measured"),
        ("sphere", "lilac: not measured"),
        ("lobe", "pale: not measured"),
    ] {
        for (material, expected) in [(file, true), (model, false)] {
            let arguments = ["plot", material, "--kind", kind, "--theta-i", "30", "-o", picture];
            let (code, _, stderr) = run(&arguments, "");
            assert_eq!(code, 0, "{stderr}");
            let svg = fs::read_to_string(picture).expect("an SVG");
            assert_eq!(svg.contains(words), expected, "{kind} of {material}");
            // The file's name, without its folders.
            assert!(kind != "polar" || material == model || svg.contains(">paint.csv, "), "{kind}");
        }
    }
}

#[test]
fn matrices_of_transmission_are_named_and_left_out() {
    let Some(shared) = common::shared("brdf/test_blinds_kf.xml") else { return };
    let (code, document, _) = run(&["info", shared.to_str().expect("a plain path"), "--json"], "");
    let findings = json(&document)["findings"].as_array().expect("findings").clone();
    let found = findings.iter().find(|f| f["code"] == "B106").expect("what else the file holds");
    let message = found["message"].as_str().expect("words");
    assert!(code == 0 && message.starts_with("Visible Reflection Front was taken"), "{message}");
    assert!(["Transmission Front", "Transmission Back"].iter().all(|half| message.contains(half)), "{message}");
}

#[test]
fn a_table_lit_at_one_angle_is_judged_by_what_was_measured() {
    let folder = tempfile::tempdir().expect("a folder");
    // ρ/π with ρ = 1.5, lit at 30°, seen to `last`; every 5° and 15°.
    let table = |last: u32| {
        let mut out = String::from("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value\n");
        for theta in (0..=last).step_by(5) {
            for phi in (0..if theta > 0 { 360 } else { 1 }).step_by(15) {
                out += &format!("30,0,{theta},{phi},{}\n", 1.5 / std::f64::consts::PI);
            }
        }
        let path = folder.path().join(format!("{last}.csv"));
        fs::write(&path, out).expect("written");
        path.to_str().expect("a plain path").to_owned()
    };
    let check = |path: &str| {
        let (code, document, _) = run(&["check", path, "--json"], "");
        (code, json(&document)["results"][0].clone())
    };
    let (code, all) = check(&table(85));
    assert_eq!((code, &all["incidences"], &all["albedo_max_at_deg"]), (1, &1.into(), &30.0.into()));
    assert_eq!(all["albedo"].as_array().map(Vec::len), Some(1));
    let number = |v: &Value| v.as_f64().expect("a number");
    // All but the rim beyond 85° is measured: sin²85° = 0.9924 of ρ, and what lies within reach beyond it.
    assert!((1.5 * 0.9924..1.5 + 1e-3).contains(&number(&all["albedo_max"])), "{all}");
    let (code, part) = check(&table(30));
    // sin²30° = 1/4 of ρ at least; the neighbourhood of the last ring adds to it, but not up to 1 = 1.5 sin²54.7°.
    assert!(code == 0 && (0.375..1.0).contains(&number(&part["albedo_max"])), "{part}");
    assert!((number(&part["albedo"][0]["albedo"][0]) - 1.5).abs() < 1e-3);
    assert!((0.25..0.67).contains(&number(&part["measured_fraction"])), "{part}");
    // Lit at one angle, nothing but retro-reflection was measured both ways.
    assert_eq!(part["reciprocity_max_relative"], 0.0);
}

#[test]
fn a_model_becomes_a_merl_file_a_list_of_points_and_the_same_file_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("a plain path").to_owned();
    let convert = |arguments: &[&str]| {
        let (code, _, stderr) = run(&[&["convert"], arguments].concat(), "");
        assert_eq!(code, 0, "{arguments:?}: {stderr}");
    };
    let resolution = ["--resolution", "9x10x12"];
    let (grey, merl) = (path("grey.binary"), path("gold.binary"));
    convert(&[&["lambert(reflectance=0.5)", "-o", &grey], &resolution[..]].concat());
    let bytes = fs::read(&grey).expect("a table");
    let bins = 9 * 10 * 12;
    assert_eq!((bytes.len(), &bytes[..12]), (12 + 24 * bins, &[9, 0, 0, 0, 10, 0, 0, 0, 12, 0, 0, 0][..]));
    // By the format: f_r = ρ/π is raw · (1, 1.15, 1.66)/1500; kept in single precision on the way.
    for (plane, scale) in [1.0, 1.15, 1.66].into_iter().enumerate() {
        let raw = f64::from_le_bytes(bytes[12 + 8 * bins * plane..][..8].try_into().expect("eight bytes"));
        let expected = 0.5 / std::f64::consts::PI * 1500.0 / scale;
        assert!((raw / expected - 1.0).abs() < 6e-8, "{raw} {expected}");
    }
    let model = "0.5*lambert(reflectance=0.4) + 0.5*ggx(alpha=0.3, medium=Au)";
    convert(&[&[model, "-o", &merl], &resolution[..]].concat());
    let read = |path: &str| open(&fs::read(path).expect("a file"), None).expect("a table").value.table;
    let material: Material = model.parse().expect("a material");
    let truth = material.prepare(Bands::Wavelengths(&[650.0, 550.0, 450.0])).expect("a material");
    let table = read(&merl);
    let (mut places, mut expected) = (0, [0.0; 3]);
    table.entries(&mut |entry| {
        places += 1;
        truth.evaluate(entry.incident, entry.outgoing, &mut expected);
        // Half a unit in the last place of single precision, and the rounding of directions.
        assert!(entry.values.iter().zip(&expected).all(|(v, e)| (v - e).abs() <= 6.0e-8 * e + 1e-12));
    });
    assert!(places > bins / 2 && places < bins, "{places} of {bins} above the horizon");
    // All of the ways round.
    for (name, options) in
        [("points.csv", &[][..]), ("points.alta", &[][..]), ("binary.alta", &["--to", "alta-binary"][..])]
    {
        let (points, again) = (path(name), path("again.binary"));
        convert(&[&[&merl, "-o", &points], options].concat());
        assert_eq!(read(&points).coverage(), (places, 0), "{name}");
        convert(&[&[points.as_str(), "-o", &again], &resolution[..]].concat());
        assert_eq!(fs::read(&again).expect("a table"), fs::read(&merl).expect("a table"), "{name}");
    }
}

#[test]
fn what_a_file_cannot_carry_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("a plain path").to_owned();
    let points = path("points.csv");
    // Measured at few places, once below zero.
    let head = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel,value\n";
    let rows = "30,0,30,180,X,-0.1\n30,0,40,180,X,0.2\n30,0,50,180,X,0.3\n";
    fs::write(&points, format!("{head}{rows}")).expect("written");
    let merl = path("t.binary");
    let convert = |arguments: &[&str]| run(&[&["--verbose", "convert"], arguments].concat(), "");
    let small = ["--resolution", "30x30x36"];
    let negatives = || {
        let bytes = fs::read(&merl).expect("a table");
        bytes[12..].chunks_exact(8).filter(|b| f64::from_le_bytes((*b).try_into().expect("eight")) < 0.0).count()
    };
    let (code, _, stderr) = convert(&[&[points.as_str(), "-o", &merl], &small[..]].concat());
    assert!(code == 0 && ["B402", "B403", "B404"].iter().all(|c| stderr.contains(c)), "{stderr}");
    let (missing, all) = (negatives(), 3 * 30 * 30 * 36);
    assert!(missing > all / 2 && missing < all);
    let (code, _, stderr) = convert(&[&[points.as_str(), "-o", &merl, "--fill"], &small[..]].concat());
    assert!(code == 0 && stderr.contains("best guess") && stderr.contains("became 0"), "{stderr}");
    // What is left has no meaning: below the horizon.
    let below = (0..30 * 30 * 36).filter(|bin| {
        let (i, o) = Resolution { theta_h: 30, theta_d: 30, phi_d: 36 }.centre(*bin).directions();
        i.z <= 0.0 || o.z <= 0.0
    });
    assert_eq!(negatives(), 3 * below.count());
    let (code, _, stderr) = convert(&["ward(ks=0.8, alpha_x=0.1, alpha_y=0.4)", "-o", &merl, small[0], small[1]]);
    assert!(code == 0 && stderr.contains("B401"), "{stderr}");
    let alta = path("t.alta");
    let (code, _, stderr) = convert(&["ggx(alpha=0.1, medium=Au)", "-o", &alta, "-w", "500"]);
    assert!(code == 0 && stderr.contains("B404") && stderr.contains("500 nm"), "{stderr}");
    let (code, table, _) = convert(&["lambert(reflectance=0.5)", "--theta-i", "0,30", "--to", "csv", "-o", "-"]);
    // At θ_o = 0 every azimuth is the same place.
    assert_eq!((code, table.lines().count()), (0, 1 + 2 * (17 * 24 + 1) * 3));
    for (arguments, expected) in [
        (vec![points.as_str(), "-o", &points], "overwrite an input"),
        (vec![points.as_str(), "-o", "x.exr"], "x.exr: expected a name ending in .binary, .alta or .csv"),
        (vec!["lambert(reflectance=0.5)", "-w", "400,500", "-o", &merl], "found 2 channels; expected 3; --channels"),
        (vec![points.as_str(), "--channels", "Y", "-o", &merl], "expected channels of the table: X"),
        (vec!["mirror()", "-o", &merl], "nothing but a Dirac lobe"),
        (vec!["nowhere.bsdf", "-o", &merl], "nowhere.bsdf: there is no such file"),
        (vec![points.as_str(), "--theta-i", "0", "-o", &merl], "a MERL file has its own bins"),
        (vec![points.as_str(), "--theta-i", "90", "-o", &alta], "expected 0 to below 90 degrees"),
        (vec![points.as_str(), "--theta-i", "5,5", "-o", &alta], "has 5 twice"),
        (vec!["-", "-o", &merl], "-:1:1: found an empty input"),
    ] {
        let (code, _, stderr) = convert(&arguments);
        assert!(code == 2 && stderr.contains(expected), "{arguments:?}: {code} {stderr}");
    }
}

#[test]
fn many_materials_are_converted_into_a_folder_and_a_bad_one_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = |name: &str| folder.path().join(name).to_str().expect("a plain path").to_owned();
    let data = points(folder.path(), "lambert(reflectance=0.5)");
    let (broken, out) = (inside("broken.bsdf"), format!("{}/", inside("tables")));
    fs::write(&broken, "no table").expect("written");
    let materials = [data.as_str(), &broken, "ggx(alpha=0.1, eta=1.5)"];
    let arguments = [&["convert"], &materials[..], &["--to", "alta", "--json", "-o", &out]].concat();
    let (code, document, stderr) = run(&arguments, "");
    assert!(code == 2 && stderr.contains(&broken), "{code} {stderr}");
    let document = json(&document);
    let results = document["results"].as_array().expect("results");
    let outputs: Vec<&str> = results.iter().filter_map(|r| r["output"].as_str()).collect();
    assert_eq!(outputs, [inside("tables/points.alta"), inside("tables/ggx_alpha_0.1_eta_1.5.alta")]);
    for output in outputs {
        open(&fs::read(output).expect("written"), None).expect("an ALTA file");
    }
    assert_eq!(
        (results[0]["path"].as_str(), document["inputs"].as_array().map(Vec::len)),
        (Some(data.as_str()), Some(3))
    );
    assert!(document["findings"].as_array().expect("findings").iter().any(|f| f["code"] == "B000"), "{document}");
    // One name for two, two of one name, and a document where the table would go.
    let alta = inside("one.alta");
    for (arguments, expected) in [
        (vec!["convert", &data, "mirror()", "-o", &alta], "one output for 2 inputs; expected a folder"),
        (vec!["convert", &data, &data, "--to", "csv", "-o", &out], "would be written to the same file as"),
        (vec!["convert", &data, "--to", "csv", "--json", "-o", "-"], "standard output holds the JSON document"),
    ] {
        let (code, _, stderr) = run(&arguments, "");
        assert!(code == 2 && stderr.contains(expected), "{arguments:?}: {code} {stderr}");
    }
}

#[test]
fn spectra_of_descriptions_come_from_files_beside_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = |name: &str| folder.path().join(name).to_str().expect("a plain path").to_owned();
    fs::write(inside("wood.csv"), "wavelength_nm,reflectance\n400,0.1\n700,0.7\n").expect("written");
    fs::write(inside("two.csv"), "wavelength_nm,a,b\n400,0.1,0.2\n700,0.7,0.2\n").expect("written");
    fs::write(inside("wood.toml"), "model = \"lambert\"\nreflectance = \"wood.csv\"\n").expect("written");
    // f = ρ/π on the line between the two points, and as at its end beyond them.
    let expected = [0.1, 0.3, 0.7].map(|rho| rho / std::f64::consts::PI);
    for material in [inside("wood.toml"), format!("lambert(reflectance=\"{}\")", inside("wood.csv"))] {
        let (code, document, stderr) = run(&["eval", &material, "-w", "380,500,720", "--json"], "");
        assert_eq!(code, 0, "{stderr}");
        let document = json(&document);
        let values = document["results"][0]["rows"][0]["brdf_per_sr"].as_array().expect("values");
        for (value, expected) in values.iter().zip(expected) {
            assert!((value.as_f64().expect("a number") - expected).abs() < 1e-15, "{material}: {value}");
        }
        let inputs = document["inputs"].as_array().expect("inputs");
        assert!(inputs.len() == 2 && inputs[1]["path"] == inside("wood.csv") && inputs[1]["sha256"].is_string());
    }
    for (reflectance, expected) in [
        ("nowhere.csv", "nowhere.csv: there is no such file; expected a spectrum"),
        ("two.csv", "2 spectra; expected the name of one"),
        ("red", "3:15: found `red` for `reflectance`; expected a number or spectrum from 0 to 1"),
    ] {
        let text = format!("name = \"x\"\nmodel = \"lambert\"\nreflectance = \"{reflectance}\"\n");
        fs::write(inside("bad.toml"), text).expect("written");
        let (code, _, stderr) = run(&["eval", &inside("bad.toml")], "");
        assert!(code == 2 && stderr.contains(expected) && stderr.contains("bad.toml:3:15"), "{reflectance}: {stderr}");
    }
}

/// A table of points of a material, as CSV.
fn points(folder: &Path, material: &str) -> String {
    let angles = ["--theta-i", "5:75:14", "--theta-o", "2:80:6", "--phi", "0,60,120,180", "-w", "450,550,650", "--csv"];
    let (code, table, stderr) = run(&[&["eval", material][..], &angles].concat(), "");
    assert_eq!(code, 0, "{stderr}");
    let mut out = String::from("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,wavelength_nm,value\n");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    for row in reader.records() {
        let row = row.expect("a row");
        out.push_str(&[&row[1], &row[2], &row[3], &row[4], &row[5], &row[7]].join(","));
        out.push('\n');
    }
    let path = folder.join("points.csv");
    fs::write(&path, out).expect("written");
    path.to_str().expect("a plain path").to_owned()
}

#[test]
fn a_table_is_fitted_and_the_material_reads_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let truth = "lambert(reflectance=[[450, 0.1], [650, 0.5]]) + ggx(alpha=0.3, f0=0.06)";
    let data = points(folder.path(), truth);
    let inside = |name: &str| folder.path().join(name).to_str().expect("a plain path").to_owned();
    let (material, picture) = (inside("fitted.toml"), inside("fit.svg"));
    let models = ["-m", "lambert", "-m", "lambert + ggx", "--shared", "f0"];
    let (code, _, stderr) = run(&[&["fit", &data][..], &models].concat(), "");
    // The first model has no f0 to share; the second one has.
    assert_eq!(code, 0, "{stderr}");
    let (code, _, stderr) = run(&["fit", &data, "-m", "lambert", "--shared", "f0"], "");
    assert!(code == 2 && stderr.contains("no open parameter is called `f0`"), "{stderr}");
    let arguments =
        ["fit", &data, "-m", "oren-nayar", "-m", "lambert + ggx", "--json", "-o", &material, "--plot", &picture];
    let (code, document, stderr) = run(&arguments, "");
    assert_eq!(code, 0, "{stderr}");
    let document = json(&document);
    let result = &document["results"][0];
    let fit = &result["fits"][1];
    assert_eq!((&result["best"], fit["parameters"].as_array().map(Vec::len)), (&fit["model"], Some(7)));
    // Linear from 450 to 650 nm.
    for (i, expected) in [0.1, 0.3, 0.5, 0.3, 0.06, 0.06, 0.06].into_iter().enumerate() {
        let value = fit["parameters"][i]["value"].as_f64().expect("a number");
        assert!((value - expected).abs() < 1e-6 * expected, "{fit}");
    }
    assert_eq!(fit["parameters"][1]["wavelength_nm"], 550.0);
    assert!(result["comparison"][0]["akaike_weight"].as_f64() > Some(0.99), "{result}");
    assert_eq!(result["places_used"], result["places"]);
    let values = |argument: &str| {
        let (code, table, stderr) = run(&["eval", argument, "-w", "450,550,650", "--csv"], "");
        assert_eq!(code, 0, "{stderr}");
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        reader.records().map(|r| r.expect("a row")[7].parse::<f64>().expect("a value")).collect::<Vec<_>>()
    };
    assert!(values(&material).iter().zip(values(truth)).all(|(a, b)| (a - b).abs() < 1e-6 * b));
    let svg = fs::read_to_string(&picture).expect("a picture");
    assert!(svg.contains("light at 45°") && svg.contains("model against table"), "{svg}");
    let (code, table, _) = run(&["fit", &data, "-m", "lambert", "-m", "oren-nayar", "--csv"], "");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    assert_eq!(reader.headers().expect("headers").len(), 14);
    assert_eq!((code, reader.records().count()), (0, 2));
    let (_, text, stderr) = run(&["fit", &data, "-m", "lambert + lambert", "--metric", "log", "--band", "2"], "");
    assert!(text.contains("1.lambert.reflectance") && stderr.contains("B202"), "{text} {stderr}");
}

#[test]
fn what_cannot_be_fitted_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let data = points(folder.path(), "lambert(reflectance=0.5)");
    for (arguments, expected) in [
        (vec!["fit", "nowhere.binary", "-m", "ggx"], "nowhere.binary: cannot be read"),
        (vec!["fit", &data, "-m", "lambert(reflectance=0.5)"], "no parameter is open"),
        (vec!["fit", &data, "-m", "ggx(rho=?)"], "`ggx` has no parameter `rho`"),
        (vec!["fit", &data, "-m", "mirror"], "nothing but a Dirac lobe"),
        (vec!["fit", &data, "-m", "lambert", "--max-theta", "1"], "expected more places than free parameters"),
        (vec!["fit", &data, "-m", "lambert", "--max-theta", "95"], "--max-theta is 95; expected above 0 to 90"),
        (vec!["fit", &data, "-m", "lambert", "--band", "4"], "band 4 of a table of 3; expected 1 to 3"),
        (vec!["fit", &data, "-m", "ggx", "--per-band", "alpha"], "`alpha` is one number for all bands"),
        (vec!["fit", &data, "-m", "lambert", "--starts", "0"], "expected 1 or more"),
        (vec!["fit", &data, "-m", "lambert", "-o", &data], "overwrite an input"),
        (vec!["fit", "-", "-m", "lambert"], "-:1:1: "),
    ] {
        let (code, _, stderr) = run(&arguments, "");
        assert!(code == 2 && stderr.contains(expected), "{arguments:?}: {code} {stderr}");
    }
}

//! Every scene that is shipped, as the folder has them: none can be forgotten.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::cli::{json, photopic, scene};

pub(crate) fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    let entries = std::fs::read_dir(folder).expect("the scenes").map(|e| e.expect("an entry").path());
    let mut scenes: Vec<PathBuf> = entries.filter(|p| p.extension().is_some_and(|e| e == "toml")).collect();
    scenes.sort();
    assert!(scenes.len() >= 6, "{scenes:?}");
    scenes
}

fn names(list: &Value) -> Vec<&str> {
    list.as_array().expect("a list").iter().map(|x| x["name"].as_str().expect("a name")).collect()
}

/// No number that any document holds is missing: JSON has no NaN, and writes `null` for it.
fn nulls(value: &Value, path: &str, found: &mut Vec<String>) {
    match value {
        Value::Null => found.push(path.to_owned()),
        Value::Array(items) => items.iter().enumerate().for_each(|(n, v)| nulls(v, &format!("{path}[{n}]"), found)),
        Value::Object(entries) => entries.iter().for_each(|(k, v)| nulls(v, &format!("{path}.{k}"), found)),
        _ => {}
    }
}

/// With few samples: it renders, `--check` told what it holds, no sample was faulty, nothing was found that is wrong.
#[test]
fn every_scene_is_rendered() {
    for path in shipped() {
        let folder = tempfile::tempdir().expect("a folder");
        let name = path.display();
        let checked = json(photopic().arg("render").arg(&path).args(["--check", "--json"]));
        let mut command = photopic();
        command.arg("render").arg(&path).args([
            "--json",
            "--samples",
            "2",
            "--meter-samples",
            "256",
            "--packets",
            "512",
        ]);
        let out = json(command.arg("--folder").arg(folder.path()));
        let (checked, result) = (&checked["results"][0], &out["results"][0]);
        let sensors = &result["sensors"];
        assert_eq!(names(sensors), names(&checked["sensors"]), "{name}");
        assert_eq!(checked["model"], result["model"], "{name}");
        let lights = result["energy"]["lights"].as_array().expect("lights");
        for (light, told) in lights.iter().zip(checked["lights"].as_array().expect("lights")) {
            assert_eq!(light["name"], told["name"], "{name}");
            assert_eq!(light["stated_w"], told["flux_w"], "{name}");
        }
        for sensor in sensors.as_array().expect("sensors") {
            assert!(sensor["value"].as_f64().is_some_and(|v| v > 0.0), "{name}: {sensor}");
            assert!(sensor.get("faulty_samples").is_none(), "{name}: {sensor}");
        }
        for finding in out["findings"].as_array().expect("findings") {
            // A production light that falls off by other laves than light's is worth saying; nothing else is.
            assert!(finding["severity"] == "info", "{name}: {finding}");
        }
        for file in result["written"].as_array().expect("files") {
            assert!(Path::new(file.as_str().expect("a path")).is_file(), "{name}: {file}");
        }
        let mut found = Vec::new();
        nulls(sensors, "sensors", &mut found);
        nulls(&result["energy"], "energy", &mut found);
        // A colour so far from white has no colour temperature.
        found.retain(|f| !f.ends_with(".cct_k") && !f.ends_with(".duv"));
        assert!(found.is_empty(), "{name}: {found:?}");
    }
}

/// What a scene does not require changes no reading by more than its error bar and the error of the wavelengths that is printed.
#[test]
fn the_full_model_reads_the_same() {
    let lamps = concat!(env!("CARGO_MANIFEST_DIR"), "/data/lamps/");
    for path in shipped() {
        let name = path.display();
        let text = std::fs::read_to_string(&path).expect("a scene").replace("../lamps/", lamps);
        // Small pictures do: the mean luminance is compared.
        let small = |line: &str| match line.split_once("resolution = [") {
            None => line.to_owned(),
            Some((before, after)) => {
                format!("{before}resolution = [16, 12{}", &after[after.find(']').expect("a pair")..])
            }
        };
        let text: Vec<String> = text.lines().map(small).collect();
        let folder = tempfile::tempdir().expect("a folder");
        let path = scene(&folder, &text.join("\n"));
        let run = |extent: &str, seed: &str| {
            let mut command = photopic();
            command.arg("render").arg(&path).args([
                "--json",
                "--packets",
                "0",
                "--samples",
                "4",
                "--meter-samples",
                "512",
            ]);
            json(command.args(["--model", extent, "--seed", seed, "--folder"]).arg(folder.path()))["results"][0].clone()
        };
        let (minimal, full) = (run("minimal", "1"), run("full", "2"));
        assert_eq!((&minimal["model"]["extent"], &full["model"]["extent"]), (&"minimal".into(), &"full".into()));
        assert_eq!(
            full["model"]["wavelengths"]["count"].as_u64() > Some(400),
            full["model"]["wavelengths"]["relative_error"] == 0.0
        );
        let allowed = minimal["model"]["wavelengths"]["relative_error"].as_f64().expect("a bound");
        let number = |v: &Value| v.as_f64().expect("a number");
        for (a, b) in
            minimal["sensors"].as_array().expect("sensors").iter().zip(full["sensors"].as_array().expect("sensors"))
        {
            let (x, y) = (number(&a["value"]), number(&b["value"]));
            let error = number(&a["standard_error"]).hypot(number(&b["standard_error"]));
            // Student's t of 31 degrees of freedom: beyond 4.5 once in 10 000 readings.
            assert!((x - y).abs() < 4.5 * error + allowed * x.abs(), "{name}, {}: {x} and {y} ± {error}", a["name"]);
        }
    }
}

/// From one flat pane no light comes to another, from two it does; a scene may ask for either. Black things reflect nothing, and a lamp of
/// no flux is left out.
#[test]
fn the_model_is_what_the_scene_requires() {
    let folder = tempfile::tempdir().expect("a folder");
    let pane = |z: u32| {
        format!(
            "[[shape]]\nmaterial = \"glass\"\nrectangle = {{ corner = [-1, -1, {z}], edges = [[2, 0, 0], [0, 2, 0]] }}\n"
        )
    };
    let rest = "[[material]]\nname = \"glass\"\npane = { medium = \"BK7\" }\n[[material]]\nname = \"prism\"\ndielectric = { medium = \"BK7\" }\n\
        [[material]]\nname = \"brushed\"\nbrdf = \"ward(ks=0.2, alpha_x=0.1, alpha_y=0.3)\"\n\
        [[light]]\nname = \"lamp\"\npoint = { at = [0, 0, 9], flux = \"1 lm\" }\n[[light]]\nname = \"off\"\npoint = { at = [0, 0, 9], flux = \"0 lm\" }\n\
        [[light]]\nname = \"sky\"\nenvironment = { radiance = \"1 nit\" }\n[[sensor]]\nname = \"s\"\nilluminance = { at = [0, 0, 0] }\n";
    let model = |head: &str, shapes: &str, more: &[&str]| {
        let path = scene(&folder, &format!("{head}{shapes}{rest}"));
        json(photopic().arg("render").arg(&path).args(["--check", "--json"]).args(more))["results"][0]["model"].clone()
    };
    let of = |m: &Value| m["polarisation"]["followed"].as_bool().expect("a word");
    let (one, two) = (pane(1), pane(1) + &pane(2));
    assert!(!of(&model("", "", &[])) && !of(&model("", &one, &[])) && of(&model("", &two, &[])));
    assert!(
        of(&model("[render]\npolarisation = true\n", &one, &[]))
            && !of(&model("[render]\npolarisation = false\n", &two, &[]))
    );
    assert!(of(&model("", "", &["--model", "full"])) && of(&model("[render]\nmodel = \"full\"\n", "", &[])));
    let ball = |material: &str| {
        format!("[[shape]]\nmaterial = \"{material}\"\nsphere = {{ centre = [0, 5, 0], radius = \"1 m\" }}\n")
    };
    let glass = model("", &ball("prism"), &[]);
    // Light goes around in a ball.
    assert!(of(&glass) && glass["materials"]["dispersive"][0] == "prism");
    let brushed = model("", &ball("brushed"), &[]);
    assert_eq!(brushed["materials"]["anisotropic"][0], "brushed");
    assert!(brushed["reflected_light"] == "global" && brushed["materials"]["dispersive"] == serde_json::json!([]));
    let black = model("", "[[shape]]\nsphere = { centre = [0, 5, 0], radius = \"1 m\" }\n", &[]);
    assert_eq!(black["reflected_light"], "none: nothing scatters");
    let lights = serde_json::json!({"in_closed_form": ["lamp"], "without_flux": ["off"], "out_of_reach": []});
    assert_eq!(black["lights"], lights);
    photopic().args(["render", "x.toml", "--model", "half"]).assert().code(2);
}

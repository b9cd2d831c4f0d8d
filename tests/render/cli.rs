//! `photopic render` as a user runs it.

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use predicates::str::contains;
use serde_json::Value;

pub(crate) fn photopic() -> Command {
    Command::cargo_bin("photopic").expect("the binary")
}

fn office() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes/office.toml")
}

/// A small scene whose reading is known: 1000 cd, 2 m above, straight below.
const LAMP: &str = r#"
[[light]]
name = "lamp"
point = { at = [0, 0, 2], intensity = "1000 cd" }
spectrum = "A"
[[sensor]]
name = "below"
spectrum = true
illuminance = { at = [0, 0, 0] }
"#;

pub(crate) fn scene(folder: &tempfile::TempDir, text: &str) -> PathBuf {
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).expect("a scene is written");
    path
}

pub(crate) fn json(command: &mut Command) -> Value {
    let output = command.output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// E = I/d² = 250 lx exactly; illuminant A is at 2856 K by definition, to the error of the wavelengths carried.
#[test]
fn a_lamp_is_read_with_its_colour() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = scene(&folder, LAMP);
    let out = json(photopic().arg("render").arg(&path).args(["--json", "--meter-samples", "64"]));
    let result = &out["results"][0];
    let seconds = |value: &Value| value.as_f64().expect("seconds");
    let parts = ["scene", "rendering", "writing", "audits"].map(|part| seconds(&result["seconds_of"][part]));
    assert!(parts.iter().all(|part| *part >= 0.0) && parts[2] == 0.0, "{parts:?}");
    assert!((parts.iter().sum::<f64>() - seconds(&result["seconds"])).abs() < 1e-6, "{parts:?}");
    let sensor = &out["results"][0]["sensors"][0];
    assert_eq!((sensor["name"].as_str(), sensor["unit"].as_str()), (Some("below"), Some("lx")));
    let value = sensor["value"].as_f64().expect("a number");
    assert!((value - 250.0).abs() < 1e-9, "{value}");
    assert!(sensor["standard_error"].as_f64().expect("a number") < 1e-9);
    let cct = sensor["spectrum"]["cct_k"].as_f64().expect("a number");
    assert!((cct - 2856.0).abs() < 15.0, "{cct}");
    assert_eq!(
        sensor["spectrum"]["values"].as_array().map(Vec::len),
        out["results"][0]["model"]["wavelengths"]["count"].as_u64().map(|n| n as usize)
    );
    assert_eq!(out["command"], "render");
    assert_eq!(out["inputs"][0]["sha256"].as_str().map(str::len), Some(64));
}

/// In a uniform surround nothing that conserves energy can be told from it, whatever stands beside it: every spot is 1000 cd/m².
#[test]
fn a_furnace_hides_whatever_conserves_energy() {
    // Ground glass conserves energy to 5e-4, the accuracy of its table, at each of the some four crossings of a path through a ball.
    let materials = [
        ("white", "reflectance = 1.0", 0.0),
        ("glass", "dielectric = { index = 1.5 }", 0.0),
        ("ground", "dielectric = { index = 1.5, alpha = 0.3 }", 2e-3),
        ("coarse", "dielectric = { index = 1.5, alpha = 1.0 }", 2e-3),
        ("pane", "pane = { index = 1.5, transmittance = 1.0 }", 0.0),
        ("fields", "mixture = [{ material = \"white\", share = 0.4 }, { material = \"ground\", share = 0.6 }]", 2e-3),
    ];
    let mut text = String::from(
        "[render]\nmeter_samples = 2097152\n[[light]]\nenvironment = { radiance = \"1000 cd/m2\" }\nspectrum = \"line:555nm\"\n",
    );
    for (number, (name, kind, _)) in materials.iter().enumerate() {
        let x = 3 * number;
        text += &format!(
            "[[material]]\nname = \"{name}\"\n{kind}\n[[shape]]\nmaterial = \"{name}\"\nsphere = {{ centre = [{x}, 0, 0], radius = \"1 m\" }}\n\
             [[sensor]]\nname = \"{name}\"\ntarget = \"0.1 %\"\n\
             luminance = {{ at = [{x}, -4, 0.3], look_at = [{x}, 0, 0.3], acceptance = \"20 deg\" }}\n"
        );
    }
    let folder = tempfile::tempdir().expect("a folder");
    let out = json(photopic().arg("render").arg(scene(&folder, &text)).arg("--json"));
    let sensors = out["results"][0]["sensors"].as_array().expect("readings");
    assert_eq!(sensors.len(), materials.len());
    for (sensor, (_, _, accuracy)) in sensors.iter().zip(materials) {
        let number = |key: &str| sensor[key].as_f64().expect("a number");
        let (value, error) = (number("value"), number("standard_error"));
        assert!(error <= 1.0 && (value - 1000.0).abs() <= 3.0 * error + 1000.0 * accuracy + 1e-9, "{sensor}");
    }
}

/// A preview says of itself that it measures nothing, and does not see the board over the meter.
#[test]
fn a_preview_says_that_it_is_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let board = "[[shape]]\nrectangle = { corner = [-1, -1, 1], edges = [[2, 0, 0], [0, 2, 0]] }\n";
    let path = scene(&folder, &format!("{board}{LAMP}"));
    let out = json(photopic().arg("render").arg(&path).args(["--json", "--preview"]));
    let result = &out["results"][0];
    assert_eq!(result["model"]["solver"], "preview");
    assert!((result["sensors"][0]["value"].as_f64().expect("a number") - 250.0).abs() < 1e-9);
    assert!(out["findings"].as_array().expect("findings").iter().any(|f| f["code"] == "R007"), "{out}");
    let out = json(photopic().arg("render").arg(&path).args(["--json", "--meter-samples", "64"]));
    assert_eq!(out["results"][0]["sensors"][0]["value"].as_f64(), Some(0.0));
    photopic().arg("render").arg(&path).args(["--preview", "--samples", "9"]).assert().code(2);
}

/// The flux stated is the flux that `--check` prints.
#[test]
fn a_check_says_what_the_scene_holds() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = LAMP.replace("intensity = \"1000 cd\"", "flux = \"800 lm\"");
    let path = scene(&folder, &text);
    let out = json(photopic().arg("render").arg(&path).args(["--check", "--json"]));
    let light = &out["results"][0]["lights"][0];
    assert_eq!(light["name"], "lamp");
    assert!((light["flux_lm"].as_f64().expect("a number") - 800.0).abs() < 1e-9, "{light}");
    assert!(out["results"][0]["sensors"][0]["kind"] == "illuminance");
}

#[test]
fn the_shipped_office_is_rendered_the_same_by_any_number_of_threads() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |threads: &str, name: &str| {
        let to = folder.path().join(name);
        std::fs::create_dir(&to).expect("a folder");
        let mut command = photopic();
        command.arg("render").arg(office()).args(["--json", "--samples", "1", "--meter-samples", "64", "--folder"]);
        let out = json(command.arg(&to).env("RAYON_NUM_THREADS", threads));
        for file in ["office.exr", "office-luminance.png", "office.png"] {
            assert!(to.join(file).is_file(), "{file}");
        }
        (out["results"][0]["sensors"].clone(), std::fs::read(to.join("office.exr")).expect("the picture"))
    };
    let (one, three) = (run("1", "one"), run("3", "three"));
    assert_eq!(one.0, three.0);
    assert!(one.1 == three.1, "the pictures differ");
    let names: Vec<&str> = one.0.as_array().expect("sensors").iter().filter_map(|s| s["name"].as_str()).collect();
    assert_eq!(names, ["desk", "wall spot", "eye", "view"]);
    assert_eq!(one.0[0]["grid"]["values"].as_array().map(Vec::len), Some(4));
}

#[test]
fn a_target_out_of_reach_is_exit_code_1() {
    let mut command = photopic();
    command.arg("render").arg(office()).args(["--samples", "1", "--meter-samples", "64", "--target", "0.001 % lux"]);
    let folder = tempfile::tempdir().expect("a folder");
    command.arg("--folder").arg(folder.path()).assert().code(1).stdout(contains("was not reached"));
}

/// By its name, and in a scene of nothing else without: the standard error of the mean luminance is the share asked for, with as many samples as that takes;
/// or it says so. One sample of a pixel does not tell its error.
#[test]
fn pictures_have_targets() {
    let folder = tempfile::tempdir().expect("a folder");
    let view = "[[sensor]]\nname = \"view\"\ncamera = { at = [0, -3, 1], look_at = [0, 0, 0], resolution = [8, 6] }\n";
    let floor = "[[material]]\nname = \"white\"\nreflectance = 0.5\n[[shape]]\nmaterial = \"white\"\nrectangle = { corner = [-1, -1, 0], edges = [[2, 0, 0], [0, 2, 0]] }\n";
    let run = |text: &str, options: &[&str], code: i32| -> Value {
        let mut command = photopic();
        command.arg("render").arg(scene(&folder, text)).args(["--json", "--packets", "0"]).args(options);
        let output = command.output().expect("it runs");
        assert_eq!(output.status.code(), Some(code), "{}", String::from_utf8_lossy(&output.stderr));
        let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        found["results"][0]["sensors"].as_array().expect("sensors").last().expect("a picture").clone()
    };
    let both = format!("{LAMP}{floor}{view}");
    let only = format!("{}{floor}{view}", &LAMP[..LAMP.find("[[sensor]]").expect("a sensor")]);
    for (text, target) in [(&both, "0.2 % view"), (&both, "0.2 % picture"), (&only, "0.2 %")] {
        let found = run(text, &["--samples", "65536", "--target", target], 0);
        let [value, error] = ["value", "standard_error"].map(|key| found[key].as_f64().expect("a number"));
        assert!(value > 0.0 && error <= 0.002 * value, "{found}");
        assert_eq!(found["target"]["reached"], true, "{found}");
        let samples = found["samples"].as_u64().expect("a number");
        // No fewer than it begins with, and not many times as many as the target takes.
        assert!((16 * 48..65_536 * 48).contains(&samples) && error > 0.001 * value, "{found}");
    }
    let missed = run(&both, &["--samples", "20", "--target", "0.0001 % view"], 1);
    assert_eq!(
        (&missed["target"]["reached"], &missed["samples"]),
        (&serde_json::json!(false), &serde_json::json!(20 * 48))
    );
    // Meters alone are meant where there are some.
    let free = run(&both, &["--samples", "4", "--target", "10 %"], 0);
    assert_eq!((&free["target"], &free["samples"]), (&Value::Null, &serde_json::json!(4 * 48)));
    let one = run(&both, &["--samples", "1"], 0);
    assert!(one["standard_error"].is_null() && one.get("expanded_95").is_none(), "{one}");
}

/// A meter behind a pane, which alone is polished: what the lamp throws through it no path meets, and that is said of those that miss it.
#[test]
fn light_that_no_path_meets_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let pane = "[[material]]\nname = \"glass\"\npane = { index = 1.5 }\n[[shape]]\nmaterial = \"glass\"\nrectangle = { corner = [-1, -1, 1], edges = [[2, 0, 0], [0, 2, 0]] }\n";
    let grid = "[[sensor]]\nname = \"desk\"\nilluminance = { grid = { corner = [-0.1, -0.1, 0], edges = [[0.2, 0, 0], [0, 0.2, 0]], points = [2, 2] } }\n";
    let told = |solver: &str, shapes: &str| -> Vec<String> {
        let text = format!("{solver}{shapes}{LAMP}{grid}");
        let out = json(photopic().arg("render").arg(scene(&folder, &text)).args(["--json", "--meter-samples", "64"]));
        let findings = out["findings"].as_array().expect("findings").iter().filter(|f| f["code"] == "R012");
        findings.map(|f| f["message"].as_str().expect("a message").to_owned()).collect()
    };
    let path = told("", pane);
    assert!(path.len() == 1 && path[0].contains("(lamp)") && path[0].contains("`below`, `desk`"), "{path:?}");
    let both = told("[render]\nsolver = \"bidirectional\"\n", pane);
    assert!(both.len() == 1 && both[0].contains("`below`") && !both[0].contains("desk"), "{both:?}");
    assert_eq!(told("", &pane.replace("pane = { index = 1.5 }", "reflectance = 0.5")), Vec::<String>::new());
}

#[test]
fn mistakes_are_told_with_file_line_and_column() {
    let folder = tempfile::tempdir().expect("a folder");
    for (from, to, message) in [
        ("intensity", "intensty", ":4:27: unknown field `intensty`, expected one of"),
        ("\"1000 cd\"", "\"1000 lx\"", ":4:39: found `1000 lx`; expected an intensity"),
        ("spectrum = \"A\"", "spectrum = \"Q\"", "no spectrum is called `Q`"),
        ("at = [0, 0, 0] }", "on = \"floor\" }", "no shape of one surface is called `floor`"),
        ("illuminance = { at = [0, 0, 0] }", "", "sensor `below` has not one kind"),
        (", intensity = \"1000 cd\"", "", "expected one of them"),
    ] {
        assert!(LAMP.contains(from), "{from}");
        let path = scene(&folder, &LAMP.replacen(from, to, 1));
        photopic().arg("render").arg(&path).assert().code(2).stderr(contains(message)).stdout("");
    }
    let path = scene(&folder, &LAMP.replace("at = [0, 0, 0] }", "at = [0, 0, nan] }"));
    photopic().arg("render").arg(&path).assert().code(2).stderr(contains("found `nan`; expected a finite number"));
    let dark = &LAMP[LAMP.find("[[sensor]]").expect("a sensor")..];
    let out = json(photopic().arg("render").arg(scene(&folder, dark)).args(["--json", "--meter-samples", "32"]));
    assert_eq!(out["findings"][0]["code"], "R002");
    let path = scene(&folder, "");
    photopic().arg("render").arg(&path).assert().code(2).stderr(contains("missing field `sensor`"));
    photopic().args(["render", "nowhere.toml"]).assert().code(2).stderr(contains("cannot be read"));
    let path = scene(&folder, LAMP);
    photopic()
        .arg("render")
        .arg(&path)
        .args(["--target", "1 % nits"])
        .assert()
        .code(2)
        .stderr(contains("no sensor is meant"));
    photopic().arg("render").arg(&path).args(["--target", "1"]).assert().code(2);
}

#[test]
fn the_schema_is_json() {
    let output = photopic().args(["render", "--schema"]).output().expect("it runs");
    let schema: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
}

/// A bright wall seen through a pane at 60° to its normal: the pane lets (1 − R)/(1 + R) through, s and p apart
/// (`../shared/render/analytic.json`, slab_n1.52_60deg; 0.843 470 671 821 488 by the same formula).
#[test]
fn a_pane_in_a_scene_lets_through_what_fresnel_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = r#"
[[material]]
name = "glass"
pane = { index = 1.52 }
[[shape]]
name = "pane"
material = "glass"
rectangle = { corner = [-2, -2, 0], edges = [[4, 0, 0], [0, 4, 0]] }
[[shape]]
name = "wall"
emission = { radiance = "1000 cd/m2" }
rectangle = { corner = [-90, -90, -1], edges = [[180, 0, 0], [0, 180, 0]] }
[[sensor]]
name = "through"
luminance = { at = [1.7320508075688772, 0, 1], look_at = [0, 0, 0], acceptance = "0.01 deg" }
"#;
    let path = scene(&folder, text);
    let out = json(photopic().arg("render").arg(&path).args(["--json", "--meter-samples", "100000"]));
    let sensor = &out["results"][0]["sensors"][0];
    let (value, error) =
        (sensor["value"].as_f64().expect("a number"), sensor["standard_error"].as_f64().expect("a number"));
    assert!(error < 2.0, "{error}");
    assert!((value - 843.470_671_821_488).abs() < 3.0 * error, "{value} ± {error}");
}

/// Every kind of material goes into a scene, and a mixture of those before it.
#[test]
fn all_kinds_of_material_are_built() {
    let folder = tempfile::tempdir().expect("a folder");
    let kinds = [
        "reflectance = [[400, 0.2], [700, 0.8]]",
        "brdf = \"phong(ks=0.3, n=20)\"",
        "metal = { medium = \"Au\" }",
        "metal = { medium = \"Cu\", alpha = 0.3 }",
        "dielectric = { medium = \"BK7\" }",
        "dielectric = { sellmeier = { b = [1.62153902, 0.256287842, 1.64447552], c_um2 = [0.0122241457, 0.0595736775, 147.468793] } }",
        "dielectric = { cauchy = [1.458, 0.00354, 0] }",
        "dielectric = { index = 1.5, alpha = 0.2, outside = 1.33 }",
        "pane = { medium = \"BK7\", transmittance = 0.9 }",
        "mixture = [{ material = \"0\", share = 0.5 }, { material = \"3\", share = [[400, 0.1], [700, 0.4]] }]",
        "dye = { reflectance = 0.1, absorption = [[400, 0.8], [480, 0.1]], emission = [[500, 0], [530, 1], [600, 0]], quantum_yield = 0.9 }",
        "reflectance = 0.9\ncheckerboard = { even = 1, odd = 0.2, fields = [4, 4] }",
    ];
    let mut text = LAMP.to_owned();
    for (n, kind) in kinds.iter().enumerate() {
        text.push_str(&format!("[[material]]\nname = \"{n}\"\n{kind}\n[[shape]]\nmaterial = \"{n}\"\nsphere = {{ centre = [{n}, 5, 1], radius = \"0.4 m\" }}\n"));
    }
    let path = scene(&folder, &text);
    let out = json(photopic().arg("render").arg(&path).args(["--json", "--meter-samples", "2048"]));
    let sensor = &out["results"][0]["sensors"][0];
    // The lamp itself gives 250 lx; the balls reflect a little more.
    let value = sensor["value"].as_f64().expect("a number");
    assert!(value > 250.0 && value < 300.0, "{value}");
    assert!(sensor.get("faulty_samples").is_none());
    for (from, to, message) in [
        ("medium = \"Au\"", "medium = \"Fe\"", "no substance is called `Fe`"),
        ("{ medium = \"BK7\" }", "{ medium = \"Au\" }", "no transparent substance"),
        ("{ cauchy = [1.458, 0.00354, 0] }", "{ medium = \"SF10\" }", "is known from 380 to 2500 nm"),
        ("material = \"0\", share", "material = \"8x\", share", "no material is called `8x`"),
        ("dye = {", "reflectance = 0.1\ndye = {", "has not one kind"),
        ("ks=0.3", "ks=-0.3", "expected"),
    ] {
        assert!(text.contains(from), "{from}");
        let path = scene(&folder, &text.replacen(from, to, 1));
        photopic().arg("render").arg(&path).assert().code(2).stderr(contains(message));
    }
}

/// One run, a run that goes on from a torn state, and three shares that are joined: the same readings and the same picture, bit for bit.
#[test]
fn breaks_and_shares_change_no_bit() {
    for solver in ["path", "bidirectional"] {
        breaks_and_shares(solver);
    }
}

fn breaks_and_shares(solver: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let text = format!(
        "[render]\nsolver = \"{solver}\"\n{LAMP}{}",
        r#"
[[material]]
name = "white"
reflectance = 0.8
[[shape]]
material = "white"
box = { from = [-2, -2, 0], to = [2, 2, 3], inwards = true }
[[sensor]]
name = "view"
camera = { at = [-1, -1, 1], look_at = [1, 1, 1], resolution = [9, 7], exr = "view.exr" }
"#
    );
    let path = scene(&folder, &text);
    let command = |more: &[&str]| {
        let mut command = photopic();
        command
            .current_dir(folder.path())
            .args(["render", "scene.toml", "--samples", "3", "--meter-samples", "640", "--packets", "2000"])
            .args(more);
        command
    };
    let told = |mut command: Command| {
        let out = json(&mut command);
        let parts = ["sensors", "energy", "bias"].map(|part| out["results"][0][part].clone());
        (parts, std::fs::read(folder.path().join("view.exr")).expect("the picture"))
    };
    let whole = told(command(&["--json"]));
    // Whole packets for each of 32 replicates.
    assert_eq!(whole.0[1]["packets"], 2016);
    let kept = told(command(&["--json", "--checkpoint", "a.state"]));
    assert!(whole == kept, "a state changes the result");
    // A break tears the state: a tenth of its bytes are lost.
    let state = folder.path().join("a.state");
    let mut bytes = std::fs::read(&state).expect("the state");
    let begin = bytes.len() / 2;
    let end = begin + bytes.len() / 10;
    bytes[begin..end].fill(0);
    std::fs::write(&state, bytes).expect("written");
    assert!(whole == told(command(&["--json", "--resume", "a.state"])), "going on changes the result");
    for n in ["1", "2", "3"] {
        command(&["--shard", &format!("{n}/3"), "-o", &format!("{n}.shard")]).assert().success().stdout("");
    }
    let merge = |shards: &[&str]| {
        let mut command = photopic();
        command.current_dir(folder.path()).args(["merge", "--json"]).args(shards);
        command
    };
    assert!(whole == told(merge(&["3.shard", "1.shard", "2.shard"])), "joining changes the result");
    merge(&["1.shard", "2.shard"]).assert().code(2).stderr(contains("the shares 3/3 are missing"));
    merge(&["1.shard", "1.shard"]).assert().code(2).stderr(contains("twice"));
    merge(&["scene.toml"]).assert().code(2).stderr(contains("found no state of a render"));
    let full = told(command(&["--json", "--model", "full"]));
    for n in ["1", "2"] {
        let shard = format!("{n}/2");
        let file = format!("full.{n}.shard");
        command(&["--model", "full", "--shard", &shard, "-o", &file]).assert().success();
    }
    assert!(full == told(merge(&["full.1.shard", "full.2.shard"])), "shares forget what is modelled");
    command(&["--seed", "5", "--resume", "a.state"]).assert().code(2).stderr(contains("the state of another render"));
    command(&["--resume", "none.state"]).assert().code(2).stderr(contains("cannot be opened"));
    command(&["--shard", "4/3", "-o", "x"]).assert().code(2);
    command(&["--checkpoint", "scene.toml"]).assert().code(2).stderr(contains("would overwrite"));
    std::fs::write(&path, text.replace("0.8", "0.7")).expect("written");
    merge(&["3.shard", "1.shard", "2.shard"]).assert().code(2).stderr(contains("have changed"));
}

/// A unit tetrahedron as a mesh, scaled by 2, hides the lamp where it stands; its instances hide it there, too. (0.1, 0.1, 0.1) and its
/// double lie inside, (0.9, 0.9, 0.9) outside.
#[test]
fn meshes_and_their_instances_cast_shadows() {
    let folder = tempfile::tempdir().expect("a folder");
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::fs::write(folder.path().join("tetra.obj"), obj).expect("written");
    let text = r#"
[[shape]]
mesh = { file = "tetra.obj", transform = [{ scale = 2.0 }], instances = [[], [{ rotate = { axis = [0, 0, 1], angle = "180 deg" } }, { translate = [10, 0, 0] }]] }
[[light]]
distant = { from = [0, 0, 1], irradiance = "500 lx" }
[[sensor]]
name = "inside"
illuminance = { at = [0.2, 0.2, 0.2] }
[[sensor]]
name = "inside the copy"
illuminance = { at = [9.8, -0.2, 0.2] }
[[sensor]]
name = "outside"
illuminance = { at = [1.8, 1.8, 1.8] }
"#;
    let path = scene(&folder, text);
    let out = json(photopic().arg("render").arg(&path).args(["--json", "--meter-samples", "32"]));
    let value = |n: usize| out["results"][0]["sensors"][n]["value"].as_f64().expect("a number");
    assert_eq!((value(0), value(1)), (0.0, 0.0));
    assert!((value(2) - 500.0).abs() < 1e-9, "{}", value(2));
    assert_eq!(out["inputs"].as_array().map(Vec::len), Some(2));
    for (from, to, message) in [
        ("tetra.obj", "none.obj", "cannot be read"),
        ("tetra.obj", "scene.toml", "ends in .ply, .obj"),
        ("scale = 2.0", "scale = 0.0", "cannot be undone"),
        ("{ scale = 2.0 }", "{ scale = 2.0, translate = [0, 0, 1] }", "not one of translate, rotate, scale"),
    ] {
        let path = scene(&folder, &text.replacen(from, to, 1));
        photopic().arg("render").arg(&path).assert().code(2).stderr(contains(message));
    }
}

/// An open meter under an overcast sky of 10 000 lx, under constant surroundings (π L), and towards the sun at noon of the equinox on the
/// equator, which stands within half a degree of the zenith.
#[test]
fn skies_and_the_sun_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    for (light, expected, allowed) in [
        ("sky = { type = 16, horizontal = \"10000 lx\" }", 10_000.0, 0.01),
        ("environment = { radiance = \"100 cd/m2\" }", 314.159_265, 0.01),
        (
            "sun = { date = 2024-03-20T12:07:30Z, latitude = \"0 deg\", longitude = \"0 deg\", irradiance = \"80 klx\" }",
            80_000.0,
            1e-4,
        ),
    ] {
        let text = format!("[[light]]\n{light}\n[[sensor]]\nname = \"up\"\nilluminance = {{ at = [0, 0, 0] }}\n");
        let path = scene(&folder, &text);
        let out = json(photopic().arg("render").arg(&path).args(["--json", "--meter-samples", "65536"]));
        let value = out["results"][0]["sensors"][0]["value"].as_f64().expect("a number");
        assert!((value / expected - 1.0).abs() < allowed, "{light}: {value}");
    }
    for (light, message) in [
        (
            "sun = { date = 2024-03-20T00:00:00Z, latitude = \"0 deg\", longitude = \"0 deg\", irradiance = \"1 lx\" }",
            "below the horizon",
        ),
        (
            "sun = { date = 2024-03-20, latitude = \"0 deg\", longitude = \"0 deg\", irradiance = \"1 lx\" }",
            "its offset",
        ),
        ("sky = { type = 17, zenith = \"1 cd/m2\" }", ":2:16: a type of sky of 17"),
        ("sky = { type = 3 }", "neither `zenith` nor `horizontal`; expected one of them"),
    ] {
        let text = format!("[[light]]\n{light}\n[[sensor]]\nname = \"up\"\nilluminance = {{ at = [0, 0, 0] }}\n");
        let path = scene(&folder, &text);
        photopic().arg("render").arg(&path).assert().code(2).stderr(contains(message));
    }
}

#[test]
fn a_missing_folder_is_told_before_anything_is_rendered() {
    let mut command = photopic();
    command.arg("render").arg(office()).args(["--samples", "1000000", "--folder", "no-such-folder"]);
    command.assert().code(2).stderr(contains("no-such-folder: no such folder"));
}

/// Where the samples go changes what a picture is sure of, not what is expected of it.
#[test]
fn an_adaptive_picture_has_the_mean_of_an_even_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = std::fs::read_to_string(office().with_file_name("cornell.toml")).expect("the scene");
    let small = scene.replace("[256, 256]", "[40, 40]");
    let run = |adaptive: bool| {
        let path = folder.path().join(format!("{adaptive}.toml"));
        std::fs::write(&path, small.replace("[render]", &format!("[render]\nadaptive = {adaptive}"))).expect("a file");
        let mut command = photopic();
        command.arg("render").arg(&path).args(["--json", "--samples", "64", "--meter-samples", "64", "--packets", "0"]);
        let out = json(command.arg("--folder").arg(folder.path()));
        let sensors = out["results"][0]["sensors"].as_array().expect("sensors").clone();
        let picture = sensors.iter().find(|s| s["name"] == "view").expect("a picture");
        ["value", "standard_error"].map(|key| picture[key].as_f64().expect("a number"))
    };
    let ([even, a], [adaptive, b]) = (run(false), run(true));
    assert!(even != adaptive);
    assert!((even - adaptive).abs() < 4.5 * a.hypot(b), "{even} ± {a}, {adaptive} ± {b}");
}

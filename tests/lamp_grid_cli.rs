//! The command line of `lamp grid`, of the transformations in `lamp convert` and of the isolux diagram. The lamp shines alike in
//! all directions, so that E = I cosθ/r² and Φ = 4π I are closed forms.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

/// 100 cd in all directions, no opening.
fn even() -> String {
    let row = ["100"; 7].join(" ");
    format!(
        "IESNA:LM-63-2002\n[TEST] 1\n[TESTLAB] none\n[ISSUEDATE] 2026\n[MANUFAC] ours\nTILT=NONE\n\
         1 -1 1 7 1 1 2 0 0 0\n1 1 10\n0 30 60 90 120 150 180\n0\n{row}\n"
    )
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("even.ies"), even()).expect("written");
    folder
}

fn lamp(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::new(env!("CARGO_BIN_EXE_photopic")).current_dir(folder).arg("lamp").args(arguments).assert()
}

fn stdout(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).expect("text")
}

fn stderr(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).expect("text")
}

#[test]
fn every_point_of_the_table_follows_inverse_square_and_cosine() {
    let folder = folder();
    let plane = ["--plane", "-2,-1 2,1 at 0.5", "--step", "1"];
    let mut arguments = vec!["grid", "even.ies", "--at", "0.3,0.1,2.5", "--csv"];
    arguments.extend(plane);
    let text = stdout(&lamp(folder.path(), &arguments).success());
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("x_m,y_m,z_m,illuminance_lx"));
    let mut points = 0;
    for line in lines {
        let v: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let (dx, dy) = (v[0] - 0.3, v[1] - 0.1);
        let r2 = dx * dx + dy * dy + 4.0;
        assert!((v[3] / (100.0 * 2.0 / r2.powf(1.5)) - 1.0).abs() < 1e-12, "{line}");
        points += 1;
    }
    assert_eq!(points, 8);
    let json = lamp(folder.path(), &["grid", "even.ies", "--height", "2", "--json"]).success();
    let json: Value = serde_json::from_str(&stdout(&json)).expect("one document");
    let result = &json["results"][0];
    let mean = result["mean_illuminance_lx"].as_f64().expect("a mean");
    let (low, high) = (&result["minimum_illuminance_lx"], &result["maximum_illuminance_lx"]);
    assert!(low.as_f64() < Some(mean) && Some(mean) < high.as_f64());
    assert_eq!(result["uniformity_u0"].as_f64(), low.as_f64().map(|v| v / mean));
}

#[test]
fn a_layout_dims_and_places_and_its_faults_are_told_by_line() {
    let folder = folder();
    let write = |text: &str| fs::write(folder.path().join("room.toml"), text).expect("written");
    write(
        "[[luminaire]]\nfile = \"even.ies\"\nat_m = [[0, 0, 2], [0, 0, 4]]\ndim = 0.5\n\n\
         [[luminaire]]\nfile = \"even.ies\"\nat_m = [[3, 0, 4]]\n",
    );
    let one_point = ["--plane", "-0.1,-0.1 0.1,0.1", "--step", "1", "--csv"];
    let mut arguments = vec!["grid", "--layout", "room.toml"];
    arguments.extend(one_point);
    let text = stdout(&lamp(folder.path(), &arguments).success());
    let value: f64 = text.lines().nth(1).and_then(|l| l.rsplit(',').next()).expect("a row").parse().expect("lx");
    // 50 cd from 2 m and 4 m, and 100 cd from 5 m at cosθ = 4/5.
    assert!((value / (50.0 / 4.0 + 50.0 / 16.0 + 100.0 * 0.8 / 25.0) - 1.0).abs() < 1e-12, "{value}");
    write("[[luminaire]]\nfile = \"even.ies\"\nplace = [[0, 0, 2]]\n");
    let error = stderr(&lamp(folder.path(), &arguments).code(2));
    assert!(error.contains("room.toml:3:1: "), "{error}");
    lamp(folder.path(), &["grid", "even.ies", "--layout", "room.toml"]).code(2);
    lamp(folder.path(), &["grid", "--height", "2"]).code(2);
    lamp(folder.path(), &["grid", "even.ies"]).code(2);
    lamp(folder.path(), &["grid", "even.ies", "--height", "2", "--step", "1e-6"]).code(2);
    lamp(folder.path(), &["grid", "even.ies", "--height", "2", "--plot", "x.pdf"]).code(2);
}

#[test]
fn a_point_in_the_lamp_has_no_value_and_says_so() {
    let folder = folder();
    let json = ["grid", "even.ies", "--at", "0,0,0", "--plane", "-1.5,-1.5 1.5,1.5", "--step", "1", "--json"];
    let assert = lamp(folder.path(), &json).success();
    let document: Value = serde_json::from_str(&stdout(&assert)).expect("one document");
    assert!(document["results"][0]["illuminance_lx"][1][1].is_null());
    assert!(document["findings"].as_array().is_some_and(|f| f.iter().any(|f| f["code"] == "L602")), "{document}");
}

#[test]
fn isolux_diagrams_are_drawn_and_dark_floors_refused() {
    let folder = folder();
    lamp(folder.path(), &["grid", "even.ies", "--height", "2", "--plot", "a.svg", "--picture", "b.png"]).success();
    lamp(folder.path(), &["plot", "even.ies", "--kind", "isolux", "--height", "2", "-o", "c.svg"]).success();
    for svg in ["a.svg", "c.svg"] {
        let text = fs::read_to_string(folder.path().join(svg)).expect("drawn");
        assert!(roxmltree::Document::parse(&text).is_ok() && text.contains("lx"), "{svg}");
    }
    assert!(fs::read(folder.path().join("b.png")).expect("drawn").starts_with(b"\x89PNG"));
    let up = even().replace("100 100 100 100 100 100 100", "0 0 0 0 100 100 100");
    fs::write(folder.path().join("up.ies"), up).expect("written");
    let error = stderr(&lamp(folder.path(), &["plot", "up.ies", "--kind", "isolux", "-o", "d.svg"]).code(2));
    assert!(error.contains("up.ies: ") && error.contains("no light falls"), "{error}");
    assert!(!folder.path().join("d.svg").exists());
}

#[test]
fn transformations_are_done_on_the_way_and_wrong_ones_refused() {
    let folder = folder();
    let flux = |file: &str| {
        let json = stdout(&lamp(folder.path(), &["info", "--json", file]).success());
        let document: Value = serde_json::from_str(&json).expect("one document");
        document["results"][0]["total_flux_lm"].as_f64().expect("a flux")
    };
    let whole = 400.0 * PI;
    for (arguments, expected) in [
        (vec!["--rotate", "30"], whole),
        (vec!["--tilt", "20", "--tilt-towards", "90"], whole),
        (vec!["--scale", "0.5"], 0.5 * whole),
        (vec!["--scale-to", "800 lm"], 800.0),
        (vec!["--resample", "45,15"], whole),
        (vec!["--merge", "even.ies,dim=0.25"], 1.25 * whole),
    ] {
        let mut all = vec!["convert", "even.ies", "-o", "out.xml"];
        all.extend(&arguments);
        lamp(folder.path(), &all).success();
        assert!((flux("out.xml") / expected - 1.0).abs() < 1e-6, "{arguments:?}: {}", flux("out.xml"));
    }
    // Half of the light is behind a Type B table.
    let error = stderr(&lamp(folder.path(), &["convert", "even.ies", "--type", "B", "-o", "b.ies"]).code(2));
    assert!(error.contains("50.00 % of the flux falls behind"), "{error}");
    assert!(!folder.path().join("b.ies").exists());
    for wrong in [["--scale", "0"], ["--scale-to", "3 W"], ["--resample", "5"], ["--symmetrise", "round"]] {
        lamp(folder.path(), &["convert", "even.ies", wrong[0], wrong[1], "-o", "w.ies"]).code(2);
    }
    fs::copy(folder.path().join("even.ies"), folder.path().join("other.ies")).expect("copied");
    let over = ["convert", "even.ies", "--merge", "other.ies", "-o", "other.ies"];
    lamp(folder.path(), &over).code(2);
}

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

/// The output of a table as header and rows.
fn table(assert: &assert_cmd::assert::Assert) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_reader(assert.get_output().stdout.as_slice());
    let header = reader.headers().expect("a header").iter().map(str::to_owned).collect();
    let rows = reader.records().map(|row| row.expect("a whole row").iter().map(str::to_owned).collect());
    (header, rows.collect())
}

#[test]
fn tables_have_the_same_columns_whatever_the_lamp() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write("even.ies", &even(100.0, "-1"));
    // Type B: no zones, no rating, but NEMA types.
    write(
        "flood.ies",
        &even(100.0, "-1")
            .replace(" 1 7 1 1 2", " 1 7 2 2 2")
            .replace("0 30 60 90 120 150 180\n0\n", "-90 -60 -30 0 30 60 90\n0 90\n100 100 100 100 100 100 100\n"),
    );
    let (header, rows) = table(&lamp(folder.path(), &["info", "--csv", "even.ies", "flood.ies"]).success());
    assert_eq!(header, table(&lamp(folder.path(), &["info", "--csv", "even.ies"]).success()).0);
    let cell = |row: usize, name: &str| rows[row][header.iter().position(|h| h == name).expect(name)].as_str();
    assert!((cell(0, "total_flux_lm").parse::<f64>().expect("a flux") / (400.0 * PI) - 1.0).abs() < 1e-12);
    // A sphere of light: half of it goes down, 2π (1 − cos 10°) of 4π in the first zone, and half of the maximum is everywhere.
    let downward = cell(0, "downward_flux_fraction").parse::<f64>().expect("a fraction");
    assert!((downward - 0.5).abs() < 1e-15 && cell(0, "nema_type.horizontal").is_empty(), "{downward}");
    let first = cell(0, "zonal_flux_lm.0_10").parse::<f64>().expect("a flux");
    assert!((first / (200.0 * PI * (1.0 - 10f64.to_radians().cos())) - 1.0).abs() < 1e-3, "{first}");
    assert!(
        (cell(0, "equivalent_cone.solid_angle_sr").parse::<f64>().expect("an angle") / (4.0 * PI) - 1.0).abs() < 1e-9
    );
    // The half space in front: 180° between the outermost directions, NEMA Type 7.
    assert_eq!((cell(1, "photometry_type"), cell(1, "bug_rating"), cell(1, "nema_type.vertical")), ("B", "", "7"));
    let (header, rows) = table(&lamp(folder.path(), &["cu", "--csv", "even.ies"]).success());
    assert_eq!((header.len(), rows.len(), header[2].as_str()), (20, 11, "rc80_rw70"));
    write("panel.ies", &even(100.0, "-1").replace("2 0 0 0", "2 .6 .6 0"));
    let (header, rows) = table(&lamp(folder.path(), &["ugr", "--csv", "panel.ies"]).success());
    assert_eq!((header.len(), rows.len(), header[3].as_str()), (13, 19, "crosswise_70_50_20"));
    let (header, rows) = table(&lamp(folder.path(), &["check", "--csv", "even.ies"]).success());
    assert_eq!((header.len(), rows[0][3].as_str()), (8, "true"));
    lamp(folder.path(), &["info", "--csv", "--json", "even.ies"]).code(2);
}

#[test]
fn a_folder_stands_for_its_lamp_files_in_order() {
    let folder = tempfile::tempdir().expect("a folder");
    let lamps = folder.path().join("lamps");
    fs::create_dir(&lamps).expect("a folder");
    for name in ["b.ies", "a.IES", "notes.txt"] {
        fs::write(lamps.join(name), even(100.0, "-1")).expect("written");
    }
    let (_, rows) = table(&lamp(folder.path(), &["check", "--csv", "lamps"]).success());
    let names: Vec<&str> = rows.iter().map(|row| row[0].rsplit(['/', '\\']).next().expect("a name")).collect();
    assert_eq!(names, ["a.IES", "b.ies"]);
    fs::create_dir(folder.path().join("empty")).expect("a folder");
    lamp(folder.path(), &["check", "empty"]).code(2);
}

#[test]
fn text_has_units_and_definitions_and_no_null() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("even.ies"), even(100.0, "-1")).expect("written");
    let text = String::from_utf8(lamp(folder.path(), &["info", "even.ies"]).success().get_output().stdout.clone());
    let text = text.expect("UTF-8");
    assert!(!text.contains("null") && !text.contains("NaN"), "{text}");
    for part in
        ["1256.64 lm", "exact integral", "100.000 cd at C 0°, γ 0°", "125.7 lm/W", "at 2 m on the axis", "25.00 lx"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    let json = results(&lamp(folder.path(), &["info", "--json", "even.ies"]).success());
    let definitions = &json["settings"]["definitions"];
    assert!(definitions["total_flux"].as_str().is_some_and(|d| d.contains("exact")));
    // Illuminance on the axis by inverse square.
    assert_eq!(json["results"][0]["cone"][1]["axis_illuminance_lx"], 25.0);
}

#[test]
fn a_cie_102_file_is_refused_by_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("old.cie"), "CIEF=CIE File Format\nIDNM=1\n").expect("written");
    let error = lamp(folder.path(), &["info", "old.cie"]).code(2);
    let error = String::from_utf8_lossy(&error.get_output().stderr).into_owned();
    assert!(error.starts_with("old.cie:1:1: found a CIE 102 file"), "{error}");
}

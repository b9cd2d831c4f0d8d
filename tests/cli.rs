//! The command line as a script sees it: exit codes, streams, the JSON envelope and its keys, inputs of every shape, and
//! numbers that follow from the SI or from a standard's printed digits.

use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command as Process, Stdio};

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use serde_json::Value;
use sha2::{Digest, Sha256};
use tempfile::TempDir;

const BINARY: &str = env!("CARGO_BIN_EXE_photopic");
/// Exact SI.
const PLANCK: f64 = 6.626_070_15e-34;
const SPEED_OF_LIGHT: f64 = 299_792_458.0;
const AVOGADRO: f64 = 6.022_140_76e23;
/// CIE 018:2019.
const K_M: f64 = 683.002;
/// V(500 nm), CIE 018:2019, Table 1, as printed.
const V_500: f64 = 0.323;

fn photopic() -> Command {
    let mut command = Command::new(BINARY);
    command.env_remove("CLICOLOR_FORCE").env_remove("NO_COLOR");
    command
}

fn office_led() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/spectra/office-led.csv")
}

/// A folder with files in it.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn with(self, name: &str, bytes: impl AsRef<[u8]>) -> Self {
        fs::write(self.path(name), bytes).expect("written");
        self
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn run(&self) -> Command {
        let mut command = photopic();
        command.current_dir(self.0.path());
        command
    }

    /// The names in the folder, sorted.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("the folder");
        let mut names: Vec<String> =
            entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// The JSON of a run that has to succeed.
fn json(command: &mut Command) -> Value {
    let out = command.arg("--json").assert().success().get_output().stdout.clone();
    serde_json::from_slice(&out).expect("one JSON document")
}

/// The number at a dotted path of the first result.
fn number(document: &Value, path: &str) -> f64 {
    at(&document["results"][0], path).as_f64().unwrap_or_else(|| panic!("no number at {path}: {document}"))
}

fn at<'a>(value: &'a Value, path: &str) -> &'a Value {
    path.split('.').fold(value, |v, key| key.parse::<usize>().map_or_else(|_| &v[key], |i| &v[i]))
}

#[track_caller]
fn close(got: f64, want: f64, relative: f64) {
    assert!((got - want).abs() <= relative * want.abs(), "{got} for {want} within {relative}");
}

/// A constant density of 1 from 400 to 700 nm by 10 nm.
fn constant() -> String {
    (0..=30).fold("wavelength,value\n".to_owned(), |text, i| text + &format!("{},1\n", 400 + 10 * i))
}

// ------------------------------------------------------------------------------------------------- exit codes

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

// -------------------------------------------------------------------------------------------------- the errors

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

// ------------------------------------------------------------------------------------------------ the envelope

#[test]
fn the_envelope_names_tool_version_command_inputs_with_checksum_settings_results_and_findings() {
    // The SHA-256 of "abc" is in FIPS 180-4's examples; so the helper itself is held.
    let hex = |bytes: &[u8]| Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect::<String>();
    assert_eq!(hex(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    let lamp = fs::read(office_led()).expect("the example");
    let rows = "name,400 nm,410 nm,420 nm\na,1,2,3\nb,1,1,1\n";
    let folder = Folder::new().with("lamp.csv", &lamp).with("rows.csv", rows);
    let document =
        json(folder.run().args(["convert", "lamp.csv", "rows.csv", "D65", "-", "-q"]).write_stdin(constant()));
    assert_eq!(document["tool"], "photopic");
    assert_eq!(document["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(document["command"], "convert");
    let inputs = document["inputs"].as_array().expect("inputs");
    let paths: Vec<&str> = inputs.iter().filter_map(|i| i["path"].as_str()).collect();
    assert_eq!(paths, ["lamp.csv", "rows.csv", "D65", "-"]);
    assert_eq!(inputs[0]["sha256"].as_str(), Some(hex(&lamp).as_str()));
    assert_eq!(inputs[1]["sha256"].as_str(), Some(hex(rows.as_bytes()).as_str()), "of a stream, too");
    assert_eq!(inputs[2].get("sha256"), None, "a source by name has no bytes");
    assert_eq!(inputs[3]["sha256"].as_str(), Some(hex(constant().as_bytes()).as_str()));
    close(document["settings"]["k_m_lm_per_w"].as_f64().expect("a number"), K_M, 0.0);
    assert_eq!(document["results"].as_array().map(Vec::len), Some(5));
    for finding in document["findings"].as_array().expect("findings") {
        for key in ["code", "severity", "message"] {
            assert!(finding[key].is_string(), "{finding}");
        }
        assert!(finding["location"].is_object(), "{finding}");
    }
}

#[test]
fn tables_speak_the_same_envelope() {
    let document = json(photopic().args(["tables", "cie-1924-v"]));
    assert_eq!((&document["tool"], &document["command"]), (&"photopic".into(), &"tables".into()));
    let table = &document["results"][0];
    let at_555 = table["wavelengths_nm"].as_array().expect("numbers").iter().position(|w| w.as_f64() == Some(555.0));
    let (_, values) = table["values"].as_object().expect("columns").iter().next().expect("one");
    // V(555 nm) = 1 by definition.
    assert_eq!(values[at_555.expect("tabulated")].as_f64(), Some(1.0));
}

#[test]
fn every_key_of_the_contract_is_there_for_a_measured_lamp_and_what_does_not_apply_is_not() {
    let document = json(photopic().arg("convert").arg(office_led()));
    let result = &document["results"][0];
    for path in [
        "radiometric.irradiance_w_per_m2",
        "photopic.illuminance_lx",
        "scotopic.illuminance_lx",
        "luminous_efficacy_of_radiation_lm_per_w",
        "scotopic_photopic_ratio",
        "xyz.0",
        "xyz.2",
        "chromaticity_xy.1",
        "chromaticity_uv_prime.1",
        "cct_k",
        "duv",
        "dominant_wavelength_nm",
        "excitation_purity",
        "peak_wavelength_nm",
        "centroid_wavelength_nm",
        "fwhm_nm",
        "cri_ra",
        "cri_r.0",
        "cri_r.13",
        "tm30_rf",
        "tm30_rg",
        "hazard.blue_light.irradiance_w_per_m2",
        "hazard.actinic_uv.irradiance_w_per_m2",
        "alpha_opic.s_cone_opic.der",
        "alpha_opic.m_cone_opic.edi_lx",
        "alpha_opic.l_cone_opic.efficacy_w_per_lm",
        "alpha_opic.rhodopic.der",
        "alpha_opic.melanopic.edi_lx",
        "photon.ppfd_umol_per_m2_s",
        "photon.umol_per_j",
        "rgb.srgb.0",
        "rgb.rec2020.2",
        "integration.range_nm.1",
        "integration.step_nm",
        "integration.k_m_lm_per_w",
        "integration.error_bound.photopic_relative",
    ] {
        assert!(at(result, path).as_f64().is_some_and(f64::is_finite), "{path}: {}", at(result, path));
    }
    for path in [
        "name",
        "quantity",
        "integration.rule",
        "integration.resampling",
        "integration.extrapolation",
        "integration.observer",
    ] {
        assert!(at(result, path).is_string(), "{path}: {}", at(result, path));
    }
    assert_eq!(result["quantity"], "irradiance");
    assert_eq!(result["tm30_bins"].as_array().map(Vec::len), Some(16));
    assert_eq!(result["cri_r"].as_array().map(Vec::len), Some(14));
    for (group, key) in [
        ("", "mesopic"),
        ("", "uncertainty"),
        ("photopic", "luminous_flux_lm"),
        ("photopic", "luminous_intensity_cd"),
        ("photopic", "luminance_cd_per_m2"),
        ("radiometric", "flux_w"),
        ("photon", "total_umol_per_s"),
    ] {
        let object = if group.is_empty() { result } else { &result[group] };
        assert_eq!(object.get(key), None, "{group}.{key} does not apply");
    }
    // ȳ of 1931 is V(λ): Y on the scale of K_m is the illuminance.
    close(number(&document, "xyz.1"), number(&document, "photopic.illuminance_lx"), 1e-14);
}

#[test]
fn what_could_not_be_determined_is_null_with_a_finding() {
    let document = json(photopic().args(["convert", "line:500nm"]));
    let (result, findings) = (&document["results"][0], document["findings"].as_array().expect("findings"));
    for (key, code) in [("cct_k", "C001"), ("duv", "C001"), ("cri_ra", "C002"), ("cri_r", "C002"), ("tm30_rf", "C004")]
    {
        assert_eq!(result.get(key), Some(&Value::Null), "{key}");
        assert!(findings.iter().any(|f| f["code"] == code), "{key}: {findings:?}");
    }
    // A line has no width: the key is absent, not null.
    assert_eq!(result.get("fwhm_nm"), None);
    // A relative spectrum has no absolute quantity.
    assert_eq!((result.get("photopic"), result.get("radiometric")), (None, None));
}

/// The paths of all nulls below a value.
fn nulls(value: &Value, path: &str, out: &mut Vec<String>) {
    match value {
        Value::Null => out.push(path.to_owned()),
        Value::Array(items) => items.iter().enumerate().for_each(|(i, v)| nulls(v, &format!("{path}.{i}"), out)),
        Value::Object(map) => map.iter().for_each(|(k, v)| nulls(v, &format!("{path}.{k}"), out)),
        _ => {}
    }
}

#[test]
fn an_ordinary_measurement_has_no_null_at_all() {
    let irregular = "wavelength,spectral irradiance [W/m2/nm]\n380,0\n450,3\n500,4\n510,5\n600,4\n700,1\n780,0\n";
    let folder =
        Folder::new().with("irregular.csv", irregular).with("led.csv", fs::read(office_led()).expect("example"));
    for name in ["led.csv", "irregular.csv"] {
        let document = json(folder.run().args(["convert", name, "-q"]));
        let mut found = Vec::new();
        nulls(&document["results"][0], "", &mut found);
        assert!(found.is_empty(), "{name}: {found:?}");
    }
}

#[test]
fn csv_has_the_same_columns_for_any_input() {
    let folder = Folder::new().with("flux.csv", "wavelength,flux [W/nm]\n400,1\n500,1\n600,1\n");
    let lamp = office_led();
    let header = |inputs: &[&str]| {
        let run = folder.run().arg("convert").args(inputs).args(["--csv", "-q"]).assert().success();
        let text = String::from_utf8(run.get_output().stdout.clone()).expect("UTF-8");
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
        let rows: Vec<csv::StringRecord> = reader.records().map(|r| r.expect("as long as the header")).collect();
        assert_eq!(rows.len(), 1 + inputs.len());
        rows[0].clone()
    };
    let first = header(&[lamp.to_str().expect("plain")]);
    for inputs in
        [&["line:500nm"][..], &["line:200nm"], &["blackbody:2856K"], &["flux.csv"], &["flux.csv", "A", "line:555nm"]]
    {
        assert_eq!(header(inputs), first, "{inputs:?}");
    }
    for column in ["path", "photopic.illuminance_lx", "cct_k", "cri_ra", "tm30_rf"] {
        assert!(first.iter().any(|c| c == column), "{column}: {first:?}");
    }
}

#[test]
fn csv_and_json_give_the_same_numbers_to_the_last_digit() {
    let run = photopic().arg("convert").arg(office_led()).args(["--csv", "-q"]).assert().success();
    let text = String::from_utf8(run.get_output().stdout.clone()).expect("UTF-8");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().expect("a header").clone();
    let row = reader.records().next().expect("one row").expect("a row");
    let document = json(photopic().arg("convert").arg(office_led()));
    let mut compared = 0;
    for (key, cell) in header.iter().zip(&row) {
        if let (Ok(cell), Some(value)) = (cell.parse::<f64>(), at(&document["results"][0], key).as_f64()) {
            // The JSON reader of this test may be off by a unit in the last place; the text is not.
            assert!((cell - value).abs() <= 2.0 * f64::EPSILON * value.abs(), "{key}: {cell} {value}");
            compared += 1;
        }
    }
    assert!(compared > 50, "{compared}");
}

// ------------------------------------------------------------------------------------------ quantities and levels

#[test]
fn a_hundred_watts_at_500_nm() {
    let document = json(photopic().args(["convert", "line:500nm", "--scale-to", "100 W"]));
    assert_eq!(document["results"][0]["quantity"], "flux");
    close(number(&document, "radiometric.flux_w"), 100.0, 1e-15);
    // N = Φλ/(hc) = 2.517·10²⁰/s.
    let photons = number(&document, "photon.total_photons_per_s");
    close(photons, 100.0 * 500e-9 / (PLANCK * SPEED_OF_LIGHT), 1e-13);
    close(photons, 2.517e20, 0.5e-3 / 2.517);
    // All of it is PAR: 100 W · 500e-9 m / (N_A h c) = 417.97 µmol/s.
    close(
        number(&document, "photon.ppf_umol_per_s"),
        100.0 * 500e-9 / (AVOGADRO * PLANCK * SPEED_OF_LIGHT) * 1e6,
        1e-13,
    );
    close(number(&document, "photopic.luminous_flux_lm"), 100.0 * K_M * V_500, 1e-13);
    close(number(&document, "luminous_efficacy_of_radiation_lm_per_w"), K_M * V_500, 1e-13);
    // V′(500 nm) = 0.982 (CIE 018:2019, Table 2), V(500 nm) = 0.323.
    close(number(&document, "scotopic_photopic_ratio"), 1700.06 * 0.982 / (K_M * V_500), 1e-13);
}

#[test]
fn irradiance_becomes_intensity_only_with_a_distance() {
    let lamp = office_led();
    let lamp = lamp.to_str().expect("plain");
    photopic()
        .args(["convert", lamp, "--to", "intensity"])
        .assert()
        .code(2)
        .stderr(contains("--distance"))
        .stdout(is_empty());
    let document = json(photopic().args(["convert", lamp, "--to", "intensity", "--distance", "2m"]));
    // I = E r².
    let lux = number(&document, "photopic.illuminance_lx");
    close(number(&document, "photopic.luminous_intensity_cd"), 4.0 * lux, 1e-14);
    close(
        number(&document, "radiometric.intensity_w_per_sr"),
        4.0 * number(&document, "radiometric.irradiance_w_per_m2"),
        1e-14,
    );
    let document = json(photopic().args(["convert", lamp, "--distance", "200 cm", "--incidence", "60deg"]));
    close(number(&document, "photopic.luminous_intensity_cd"), 8.0 * lux, 1e-14);
}

#[test]
fn watts_lux_and_candela_follow_from_one_another_both_ways() {
    let folder =
        Folder::new().with("line.csv", "wavelength,value\n555,2\n").with("line500.csv", "wavelength,value\n500,1\n");
    // 2 W/m² of 555 nm: 2·683.002 lx; at 3 m that took 9 times as many candela.
    let run = |arguments: &[&str]| json(folder.run().arg("convert").args(arguments).arg("-q"));
    let d = run(&["line.csv", "--unit", "W/m2", "--distance", "3m"]);
    close(number(&d, "photopic.illuminance_lx"), 2.0 * K_M, 1e-15);
    close(number(&d, "photopic.luminous_intensity_cd"), 18.0 * K_M, 1e-14);
    // And back: 18 W/sr at 3 m is 2 W/m².
    let d = run(&["line.csv", "--unit", "W/sr", "--distance", "3m"]);
    close(number(&d, "photopic.luminous_intensity_cd"), 2.0 * K_M, 1e-15);
    close(number(&d, "radiometric.irradiance_w_per_m2"), 2.0 / 9.0, 1e-14);
    close(number(&d, "photopic.illuminance_lx"), 2.0 * K_M / 9.0, 1e-14);
    // Radiance of a Lambertian emitter of 100 cm²: Φ = πAL, M = πL, I = AL.
    let d = run(&["line.csv", "--unit", "W/(m2 sr)", "--lambertian", "--area", "100cm2"]);
    close(number(&d, "photopic.luminance_cd_per_m2"), 2.0 * K_M, 1e-15);
    close(number(&d, "photopic.luminous_flux_lm"), std::f64::consts::PI * 0.02 * K_M, 1e-14);
    close(number(&d, "photopic.luminous_exitance_lm_per_m2"), std::f64::consts::PI * 2.0 * K_M, 1e-14);
    close(number(&d, "photopic.luminous_intensity_cd"), 0.02 * K_M, 1e-14);
    // An isotropic watt: I = Φ/4π; energy over an hour.
    let d = run(&["line.csv", "--unit", "W", "--isotropic", "--distance", "1m", "--time", "1h"]);
    close(number(&d, "photopic.illuminance_lx"), 2.0 * K_M / (4.0 * std::f64::consts::PI), 1e-14);
    close(number(&d, "radiometric.energy_j"), 7200.0, 1e-14);
    close(number(&d, "photopic.luminous_energy_lm_s"), 7200.0 * K_M, 1e-14);
    // A cone of 60°: 2π(1 − cos 60°) = π sr.
    let d = run(&["line500.csv", "--unit", "W", "--cone", "60deg"]);
    close(number(&d, "photopic.luminous_intensity_cd"), K_M * V_500 / std::f64::consts::PI, 1e-14);
    // Each derived figure says which relation gave it.
    assert!(d["results"][0]["derived_by"]["intensity"].is_array(), "{d}");
}

#[test]
fn geometry_that_contradicts_itself_is_refused_by_the_names_of_its_options() {
    for (arguments, word) in [
        (&["--isotropic", "--lambertian"][..], "--lambertian"),
        (&["--cone", "30deg", "--solid-angle", "1sr"], "--solid-angle"),
        (&["--source", "disk:1m"], "--distance"),
        (&["--source", "sphere:2m", "--distance", "1m"], "distance"),
        (&["--incidence", "90deg"], "incidence"),
        (&["--solid-angle", "13sr"], "4π"),
    ] {
        photopic().args(["convert", "A"]).args(arguments).assert().code(2).stderr(contains(word)).stdout(is_empty());
    }
}

#[test]
fn a_level_is_reached_in_any_of_its_units() {
    for (level, path, want) in [
        ("500 lx", "photopic.illuminance_lx", 500.0),
        ("800lm", "photopic.luminous_flux_lm", 800.0),
        ("1 klx", "photopic.illuminance_lx", 1000.0),
        ("3e2 cd/m²", "photopic.luminance_cd_per_m2", 300.0),
        ("100 nit", "photopic.luminance_cd_per_m2", 100.0),
        ("12 cd", "photopic.luminous_intensity_cd", 12.0),
        ("1 W/m2", "radiometric.irradiance_w_per_m2", 1.0),
        ("5 mW", "radiometric.flux_w", 5e-3),
        // 1 fc = 1 lm/ft², the foot 0.3048 m.
        ("1 fc", "photopic.illuminance_lx", 1.0 / (0.3048 * 0.3048)),
    ] {
        let document = json(photopic().args(["convert", "LED-B3", "--scale-to", level]));
        close(number(&document, path), want, 1e-13);
    }
    // An absolute spectrum is not turned into another quantity by a level.
    photopic()
        .args(["convert", "blackbody:3000K", "--scale-to", "500 lx"])
        .assert()
        .code(2)
        .stderr(contains("radiance"));
}

#[test]
fn units_are_what_they_say() {
    let folder = Folder::new().with("one.csv", constant());
    // A constant 1 from 400 to 700 nm: 300 in its unit under the trapezoid, which is exact here.
    for (unit, key, want) in [
        ("W/m2/nm", "radiometric.irradiance_w_per_m2", 300.0),
        ("mW/m2/nm", "radiometric.irradiance_w_per_m2", 0.3),
        ("mW m-2 nm-1", "radiometric.irradiance_w_per_m2", 0.3),
        ("µW/cm²/nm", "radiometric.irradiance_w_per_m2", 3.0),
        ("W/m2/um", "radiometric.irradiance_w_per_m2", 0.3),
        ("W/m3", "radiometric.irradiance_w_per_m2", 3e-7),
        ("W/cm2/nm", "radiometric.irradiance_w_per_m2", 3e6),
        ("W/nm", "radiometric.flux_w", 300.0),
        ("mW/sr/nm", "radiometric.intensity_w_per_sr", 0.3),
        ("W/(m2 sr nm)", "radiometric.radiance_w_per_m2_sr", 300.0),
        ("W/m2/sr/um", "radiometric.radiance_w_per_m2_sr", 0.3),
        ("J/m2/nm", "radiometric.exposure_j_per_m2", 300.0),
        ("J/nm", "radiometric.energy_j", 300.0),
        // Photons: 1 µmol/(m²·s·nm) at all of 400–700 nm is a PPFD of 300 µmol/(m²·s).
        ("umol/m2/s/nm", "photon.ppfd_umol_per_m2_s", 300.0),
        ("µmol·m⁻²·s⁻¹·nm⁻¹", "photon.ppfd_umol_per_m2_s", 300.0),
        // Per band: each of the 31 samples is the whole amount in its band.
        ("W/m2/band", "radiometric.irradiance_w_per_m2", 31.0),
        ("mW", "radiometric.flux_w", 0.031),
    ] {
        let rule: &[&str] = if want == 31.0 || want == 0.031 { &[] } else { &["--rule", "trapezoid"] };
        let document = json(folder.run().args(["convert", "one.csv", "-q", "--unit", unit]).args(rule));
        close(number(&document, key), want, 1e-13);
    }
    // Exitance has the dimensions of irradiance and has to be asked for by name.
    let document = json(folder.run().args([
        "convert",
        "one.csv",
        "-q",
        "--unit",
        "W/m2/nm",
        "--quantity",
        "exitance",
        "--rule",
        "trapezoid",
    ]));
    close(number(&document, "radiometric.exitance_w_per_m2"), 300.0, 1e-13);
    // A quantity alone means SI per nm, and says so; a quantity against its unit is refused.
    let document =
        json(folder.run().args(["convert", "one.csv", "-q", "--quantity", "radiance", "--rule", "trapezoid"]));
    close(number(&document, "radiometric.radiance_w_per_m2_sr"), 300.0, 1e-13);
    assert!(document["findings"].as_array().expect("findings").iter().any(|f| f["code"] == "S014"));
    folder
        .run()
        .args(["convert", "one.csv", "--quantity", "radiance", "--unit", "W/nm"])
        .assert()
        .code(2)
        .stderr(contains("radiance"));
}

#[test]
fn without_quantity_and_unit_only_ratios_are_told_and_that_it_is_so() {
    let folder = Folder::new().with("one.csv", constant());
    let document = json(folder.run().args(["convert", "one.csv"]));
    assert_eq!(document["results"][0]["quantity"], "relative");
    assert_eq!(document["results"][0].get("photopic"), None);
    close(number(&document, "xyz.1"), 100.0, 1e-14);
    folder.run().args(["convert", "one.csv"]).assert().stderr(contains("S010").and(contains("--quantity")));
}

// ------------------------------------------------------------------------------------------------ the contract

#[test]
fn rules_and_ranges_are_those_asked_for() {
    let folder = Folder::new().with("one.csv", constant());
    let run =
        |arguments: &[&str]| json(folder.run().args(["convert", "one.csv", "-q", "--unit", "W/m2/nm"]).args(arguments));
    let irradiance = |arguments: &[&str]| number(&run(arguments), "radiometric.irradiance_w_per_m2");
    // Δλ Σ counts both ends in full; the others do not.
    close(irradiance(&["--rule", "summation"]), 310.0, 1e-15);
    close(irradiance(&["--rule", "trapezoid"]), 300.0, 1e-15);
    close(irradiance(&["--rule", "exact"]), 300.0, 1e-14);
    close(irradiance(&["--rule", "exact", "--range", "453-518.5"]), 65.5, 1e-13);
    close(irradiance(&["--rule", "trapezoid", "--range", "450..600"]), 150.0, 1e-14);
    let d = run(&["--rule", "exact", "--range", "453-518.5"]);
    assert_eq!(d["settings"]["range_nm"], serde_json::json!([453.0, 518.5]));
    assert_eq!(d["results"][0]["integration"]["range_nm"], serde_json::json!([453.0, 518.5]));
    assert_eq!(d["results"][0]["integration"]["rule"], "exact");
    // A rule that does not fit is refused with what would.
    folder.run().args(["convert", "one.csv", "--rule", "lines"]).assert().code(2).stderr(contains("trapezoid"));
    let uneven = Folder::new().with("u.csv", "wavelength,value\n400,1\n410,1\n430,1\n");
    uneven.run().args(["convert", "u.csv", "--rule", "summation"]).assert().code(2).stderr(contains("--resample"));
}

#[test]
fn a_range_without_samples_is_not_told_as_one_that_runs_backwards() {
    for range in ["100-200", "900-1000"] {
        let d = json(photopic().args(["convert", "A", "--range", range, "-q"]));
        let told = &d["results"][0]["integration"]["range_nm"];
        let ascending = told[0].as_f64().zip(told[1].as_f64()).is_none_or(|(low, high)| low <= high);
        assert!(ascending, "{range}: {told}");
    }
}

#[test]
fn a_line_spectrum_is_not_resampled_because_it_is_one() {
    photopic().args(["convert", "line:500nm", "--resample", "1"]).assert().code(2).stderr(contains("line spectrum"));
}

#[test]
fn the_constants_are_those_asked_for_and_printed() {
    let run =
        |arguments: &[&str]| json(photopic().args(["convert", "line:555nm", "--scale-to", "1 W"]).args(arguments));
    close(number(&run(&[]), "photopic.luminous_flux_lm"), 683.002, 1e-15);
    close(number(&run(&["--k-m", "683"]), "photopic.luminous_flux_lm"), 683.0, 1e-15);
    close(number(&run(&["--k-m", "683"]), "integration.k_m_lm_per_w"), 683.0, 0.0);
    // V′(555 nm) = 0.402 (CIE 018:2019, Table 2).
    close(number(&run(&[]), "scotopic.luminous_flux_lm"), 1700.06 * 0.402, 1e-14);
    close(number(&run(&["--k-m-scotopic", "1700"]), "scotopic.luminous_flux_lm"), 1700.0 * 0.402, 1e-14);
    // The exact c₂ moves the CCT of 6500 K by 0.1 K: CCT = T·c₂/c₂′.
    let cct = |c2: &str| number(&json(photopic().args(["convert", "blackbody:6500K", "--c2", c2])), "cct_k");
    close(cct("its90"), 6500.0, 1e-9);
    close(cct("si"), 6500.0, 1e-9);
    let d65 = |c2: &str| number(&json(photopic().args(["convert", "D65", "--c2", c2])), "cct_k");
    close(d65("si") / d65("its90"), 1.438_776_877_5e-2 / 1.4388e-2, 1e-9);
    // CIE 15:2018, Table 4.1: 6503.6 K with c₂ of the ITS-90 (printed 6504).
    close(d65("its90"), 6504.0, 0.5 / 6504.0);
}

#[test]
fn resampling_is_asked_for_and_printed() {
    let folder = Folder::new().with("one.csv", constant());
    let run =
        |arguments: &[&str]| json(folder.run().args(["convert", "one.csv", "-q", "--unit", "W/m2/nm"]).args(arguments));
    for interpolation in ["linear", "sprague", "cubic", "pchip"] {
        let d = run(&["--resample", "1", "--interpolation", interpolation, "--rule", "trapezoid"]);
        assert_eq!(d["results"][0]["integration"]["samples"], 301);
        close(number(&d, "integration.step_nm"), 1.0, 1e-12);
        assert_eq!(d["results"][0]["integration"]["resampling"]["interpolation"], interpolation);
        // A constant stays one under any interpolation.
        close(number(&d, "radiometric.irradiance_w_per_m2"), 300.0, 1e-13);
    }
    let beyond = ["--resample", "1", "--resample-range", "380-780", "--rule", "trapezoid"];
    folder.run().args(["convert", "one.csv"]).args(beyond).assert().code(2).stderr(contains("extrapolation"));
    let d = run(&[&beyond[..], &["--extrapolation", "constant"]].concat());
    close(number(&d, "radiometric.irradiance_w_per_m2"), 400.0, 1e-13);
    assert_eq!(d["results"][0]["integration"]["extrapolation"], "constant");
    // Zero beyond: trapezoids of one nanometre lean to zero at both ends.
    let d = run(&[&beyond[..], &["--extrapolation", "zero"]].concat());
    close(number(&d, "radiometric.irradiance_w_per_m2"), 301.0, 1e-13);
    let d = run(&[]);
    assert_eq!(d["results"][0]["integration"]["resampling"], "none");
}

#[test]
fn mesopic_figures_keep_the_equations_of_cie_191() {
    let run = |luminance: &str| {
        json(photopic().args(["convert", "LED-B3", "--scale-to", "10 lx", "--mesopic-adaptation", luminance]))
    };
    // At 5 cd/m² and above vision is photopic, far below 0.005 cd/m² scotopic.
    let d = run("10");
    close(number(&d, "mesopic.illuminance_lx"), 10.0, 1e-14);
    let d = run("0.0001");
    close(number(&d, "mesopic.illuminance_lx"), number(&d, "scotopic.illuminance_lx"), 1e-14);
    for luminance in [0.03, 0.1, 0.3, 1.0, 3.0] {
        let d = run(&luminance.to_string());
        let (m, ratio) = (number(&d, "mesopic.m"), number(&d, "scotopic_photopic_ratio"));
        let v = 683.0 / 1699.0;
        let mesopic = |p: f64| p * (m + (1.0 - m) * ratio * v) / (m + (1.0 - m) * v);
        // m = 0.7670 + 0.3334 lg L_mes (CIE 191:2010, eq. (3), (4)).
        close(m, 0.7670 + 0.3334 * mesopic(luminance).log10(), 1e-9);
        close(number(&d, "mesopic.illuminance_lx"), mesopic(10.0), 1e-13);
    }
    photopic()
        .args(["convert", "LED-B3", "--csv", "--mesopic-adaptation", "0.1", "--figures", "luminous"])
        .assert()
        .success()
        .stdout(contains("mesopic.illuminance_lx"));
}

#[test]
fn figures_are_those_asked_for() {
    let run = |groups: &str| json(photopic().arg("convert").arg(office_led()).args(["--figures", groups]));
    let groups = [
        ("colour", "cct_k"),
        ("cri", "cri_ra"),
        ("tm30", "tm30_rf"),
        ("alpha-opic", "alpha_opic"),
        ("photon", "photon"),
        ("hazard", "hazard"),
        ("rgb", "rgb"),
        ("shape", "peak_wavelength_nm"),
    ];
    let all = run("all");
    for (group, key) in groups {
        let d = run(group);
        for (_, other) in groups {
            assert_eq!(d["results"][0].get(other).is_some(), other == key, "{group}: {other}");
        }
        assert_eq!(d["results"][0][key], all["results"][0][key], "the same number alone and among others");
    }
    let d = run("luminous");
    assert!(groups.iter().all(|(_, key)| d["results"][0].get(*key).is_none()));
    assert!(number(&d, "photopic.illuminance_lx") > 0.0 && number(&d, "chromaticity_xy.0") > 0.0);
    let d = run("cri,photon");
    assert!(
        d["results"][0].get("cri_ra").is_some()
            && d["results"][0].get("photon").is_some()
            && d["results"][0].get("rgb").is_none()
    );
}

// ---------------------------------------------------------------------------------------------- shapes of input

#[test]
fn the_same_spectrum_in_any_dress_gives_the_same_numbers() {
    let samples: Vec<(f64, f64)> =
        (0..=80).map(|i| (380.0 + 5.0 * f64::from(i), 0.5 + f64::from(i * i % 97) / 8.0)).collect();
    let lines = |separator: &str, comma: bool, descending: bool| {
        let mut rows: Vec<String> = samples.iter().map(|(w, v)| format!("{w:.1}{separator}{v}")).collect();
        if descending {
            rows.reverse();
        }
        let text = rows.join("\n") + "\n";
        if comma { text.replace('.', ",") } else { text }
    };
    let header = "wavelength [nm],spectral irradiance [W/m2/nm]\n";
    let plain = format!("{header}{}", lines(",", false, false));
    let utf16 = |text: &str, big: bool| -> Vec<u8> {
        let order = |unit: u16| if big { unit.to_be_bytes() } else { unit.to_le_bytes() };
        "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(order).collect()
    };
    let dresses: Vec<(&str, Vec<u8>)> = vec![
        ("plain", plain.clone().into_bytes()),
        ("crlf", plain.replace('\n', "\r\n").into_bytes()),
        ("cr", plain.replace('\n', "\r").into_bytes()),
        ("utf8 mark", format!("\u{feff}{plain}").into_bytes()),
        ("utf16 le", utf16(&plain, false)),
        ("utf16 be", utf16(&plain, true)),
        ("semicolon, decimal comma", format!("{}{}", header.replace(',', ";"), lines(";", true, false)).into_bytes()),
        ("sep line", format!("sep=;\n{}{}", header.replace(',', ";"), lines(";", true, false)).into_bytes()),
        ("tab", format!("{}{}", header.replace(',', "\t"), lines("\t", false, false)).into_bytes()),
        ("tab, decimal comma", format!("{}{}", header.replace(',', "\t"), lines("\t", true, false)).into_bytes()),
        ("unit row", format!("wavelength,spectral irradiance\nnm,W/m2/nm\n{}", lines(",", false, false)).into_bytes()),
        ("long to short", format!("{header}{}", lines(",", false, true)).into_bytes()),
        ("comments", format!("# made for a test\n{header}{}# the end\n", lines(",", false, false)).into_bytes()),
        (
            "latin-1 unit",
            [&b"wavelength [nm];irradiance [W/m\xb2/nm]\n"[..], lines(";", false, false).as_bytes()].concat(),
        ),
        (
            "micrometres",
            samples
                .iter()
                .fold("wavelength [um],spectral irradiance [W/m2/nm]\n".to_owned(), |text, (w, v)| {
                    text + &format!("{:.4},{v}\n", w / 1e3)
                })
                .into_bytes(),
        ),
    ];
    let convert = |bytes: &[u8]| {
        let folder = Folder::new().with("x.csv", bytes);
        json(folder.run().args(["convert", "x.csv", "-q"]))
    };
    let want = convert(plain.as_bytes());
    for (dress, bytes) in &dresses {
        let got = convert(bytes);
        for path in
            ["photopic.illuminance_lx", "radiometric.irradiance_w_per_m2", "cct_k", "cri_ra", "peak_wavelength_nm"]
        {
            // A wavelength of 0.3850 µm is 385 nm up to rounding.
            let tolerance = if *dress == "micrometres" { 1e-9 } else { 1e-15 };
            let (got, want) = (number(&got, path), number(&want, path));
            assert!((got - want).abs() <= tolerance * want.abs(), "{dress}, {path}: {got} {want}");
        }
    }
}

#[test]
fn standard_input_is_a_file_named_dash() {
    let lamp = fs::read(office_led()).expect("the example");
    let piped = json(photopic().args(["convert", "-"]).write_stdin(lamp));
    let named = json(photopic().arg("convert").arg(office_led()));
    assert_eq!(piped["results"][0]["path"], "-");
    assert_eq!(piped["results"][0]["photopic"], named["results"][0]["photopic"]);
    assert_eq!(piped["inputs"][0]["sha256"], named["inputs"][0]["sha256"]);
    photopic()
        .args(["convert", "-"])
        .write_stdin("wavelength,value\n400,x\n410,1\n")
        .assert()
        .code(2)
        .stderr(predicates::str::starts_with("-:2:5: found `x`"));
}

#[test]
fn several_columns_are_several_results_and_select_takes_some() {
    let table = "wavelength,Lamp A,Lamp B,Lamp C\n400,1,0,0\n500,0,1,0\n600,0,0,1\n";
    let folder = Folder::new().with("lamps.csv", table);
    let names = |arguments: &[&str]| -> Vec<String> {
        let d = json(folder.run().args(["convert", "lamps.csv", "-q", "--figures", "luminous"]).args(arguments));
        d["results"]
            .as_array()
            .expect("results")
            .iter()
            .map(|r| r["name"].as_str().expect("named").to_owned())
            .collect()
    };
    assert_eq!(names(&[]), ["Lamp A", "Lamp B", "Lamp C"]);
    assert_eq!(names(&["--select", "lamp b"]), ["Lamp B"]);
    assert_eq!(names(&["--select", "Lamp C", "--select", "Lamp A"]), ["Lamp A", "Lamp C"]);
    let refused = folder.run().args(["convert", "lamps.csv", "--select", "Lamp D"]).assert().code(2);
    refused.stderr(contains("Lamp D").and(contains("Lamp A")));
}

#[test]
fn a_name_that_select_does_not_find_is_told_even_beside_one_that_it_finds() {
    let columns = "wavelength,Lamp A,Lamp B\n400,1,0\n500,0,1\n600,0,0\n";
    let rows = "name,400 nm,500 nm,600 nm\nLamp A,1,0,0\nLamp B,0,1,0\n";
    let folder = Folder::new().with("columns.csv", columns).with("rows.csv", rows);
    for name in ["columns.csv", "rows.csv"] {
        let arguments =
            ["convert", name, "-q", "--csv", "--figures", "luminous", "--select", "Lamp A", "--select", "Lamp Z"];
        let run = folder.run().args(arguments).assert().code(2);
        run.stderr(contains("Lamp Z")).stdout(contains("Lamp A").and(contains("Lamp B").not()));
    }
}

#[test]
fn a_table_of_rows_is_streamed_to_the_same_numbers_as_columns_and_one_bad_row_is_told_by_its_line() {
    const ROWS: usize = 5000;
    const BAD: usize = 3210;
    let wavelengths: Vec<u32> = (0..=20).map(|k| 400 + 15 * k).collect();
    let value = |row: usize, k: usize| ((row * 7919 + k * 104_729) % 9973) as f64 / 1000.0 + 0.001;
    let mut rows = String::from("name");
    wavelengths.iter().for_each(|w| rows.push_str(&format!(",{w}")));
    rows.push('\n');
    for row in 0..ROWS {
        rows.push_str(&format!("s{row}"));
        for k in 0..wavelengths.len() {
            if row == BAD && k == 4 {
                rows.push_str(",oops");
            } else {
                rows.push_str(&format!(",{}", value(row, k)));
            }
        }
        rows.push('\n');
    }
    // Every 250th as a column beside.
    let taken: Vec<usize> = (0..ROWS).step_by(250).collect();
    let mut columns = String::from("wavelength");
    taken.iter().for_each(|row| columns.push_str(&format!(",s{row}")));
    columns.push('\n');
    for (k, w) in wavelengths.iter().enumerate() {
        columns.push_str(&w.to_string());
        taken.iter().for_each(|row| columns.push_str(&format!(",{}", value(*row, k))));
        columns.push('\n');
    }
    let folder = Folder::new().with("rows.csv", rows).with("columns.csv", columns);
    let convert = |name: &str, code: i32| -> (Vec<Value>, String) {
        let run = folder
            .run()
            .args(["convert", name, "--json", "-q", "--unit", "W/m2/nm", "--figures", "colour,cri"])
            .assert()
            .code(code);
        let document: Value = serde_json::from_slice(&run.get_output().stdout).expect("JSON");
        let said = String::from_utf8(run.get_output().stderr.clone()).expect("UTF-8");
        (document["results"].as_array().expect("results").clone(), said)
    };
    let (streamed, said) = convert("rows.csv", 2);
    // The heading is line 1; `s3210,` and four cells of five characters, more or less, stand before the fault.
    let line = BAD + 2;
    assert!(said.starts_with(&format!("rows.csv:{line}:")) && said.contains("found `oops`; expected"), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert_eq!(streamed.len(), ROWS - 1);
    let order: Vec<&str> = streamed.iter().filter_map(|r| r["name"].as_str()).collect();
    let expected: Vec<String> = (0..ROWS).filter(|r| *r != BAD).map(|r| format!("s{r}")).collect();
    assert_eq!(order, expected, "in the order of the file");
    let (beside, _) = convert("columns.csv", 0);
    assert_eq!(beside.len(), taken.len());
    for column in &beside {
        let row = streamed.iter().find(|r| r["name"] == column["name"]).expect("streamed, too");
        for key in
            ["photopic", "scotopic", "radiometric", "xyz", "chromaticity_xy", "cct_k", "duv", "cri_ra", "integration"]
        {
            assert_eq!(row[key], column[key], "{} {key}", column["name"]);
        }
    }
}

#[test]
fn of_a_stream_with_many_bad_rows_a_few_are_told_and_the_rest_counted() {
    let mut rows = String::from("name,400 nm,410 nm,420 nm\n");
    (0..100).for_each(|k| rows.push_str(&format!("s{k},1,{},3\n", if k % 2 == 0 { "2" } else { "?" })));
    let folder = Folder::new().with("rows.csv", rows);
    let run = folder.run().args(["convert", "rows.csv", "--csv", "-q", "--figures", "luminous"]).assert().code(2);
    let (out, said) =
        (run.get_output().stdout.clone(), String::from_utf8(run.get_output().stderr.clone()).expect("UTF-8"));
    assert_eq!(String::from_utf8(out).expect("UTF-8").lines().count(), 51);
    assert!(said.lines().count() <= 25 && said.contains("rows.csv:3:") && said.contains("30 more"), "{said}");
}

// ------------------------------------------------------------------------------------------------------- output

#[test]
fn an_output_file_holds_what_standard_output_would_and_nothing_else_is_left() {
    let folder = Folder::new().with("lamp.csv", fs::read(office_led()).expect("example"));
    for form in [&["--json"][..], &["--csv"], &[]] {
        let want =
            folder.run().args(["convert", "lamp.csv", "D65"]).args(form).assert().success().get_output().stdout.clone();
        folder.run().args(["convert", "lamp.csv", "D65", "-o", "out"]).args(form).assert().success().stdout(is_empty());
        assert_eq!(fs::read(folder.path("out")).expect("written"), want, "{form:?}");
        assert_eq!(folder.names(), ["lamp.csv", "out"]);
    }
    // `-o -` is standard output.
    folder.run().args(["convert", "D65", "-o", "-"]).assert().success().stdout(is_empty().not());
    assert_eq!(folder.names(), ["lamp.csv", "out"]);
}

#[test]
fn an_output_never_overwrites_an_input() {
    let lamp = fs::read(office_led()).expect("the example");
    let folder = Folder::new().with("lamp.csv", &lamp).with("other.svg", &lamp);
    for arguments in [
        &["convert", "lamp.csv", "-o", "lamp.csv"][..],
        &["convert", "D65", "lamp.csv", "-o", "./lamp.csv", "--json"],
        &["convert", "other.svg", "--plot", "other.svg"],
    ] {
        folder.run().args(arguments).assert().code(2).stderr(contains("overwrite"));
        assert_eq!(fs::read(folder.path("lamp.csv")).expect("there"), lamp, "{arguments:?}");
        assert_eq!(fs::read(folder.path("other.svg")).expect("there"), lamp, "{arguments:?}");
        assert_eq!(folder.names(), ["lamp.csv", "other.svg"]);
    }
}

#[cfg(unix)]
#[test]
fn an_output_never_overwrites_an_input_by_another_name() {
    let lamp = fs::read(office_led()).expect("the example");
    let folder = Folder::new().with("lamp.csv", &lamp);
    std::os::unix::fs::symlink("lamp.csv", folder.path("link.csv")).expect("linked");
    for arguments in [["convert", "lamp.csv", "-o", "link.csv"], ["convert", "link.csv", "-o", "lamp.csv"]] {
        folder.run().args(arguments).assert().code(2).stderr(contains("overwrite"));
        assert_eq!(fs::read(folder.path("lamp.csv")).expect("there"), lamp);
    }
}

#[test]
fn a_failure_leaves_no_half_written_file() {
    let folder = Folder::new().with("bad.csv", "wavelength,value\n400,x\n410,1\n");
    for arguments in [
        &["convert", "A", "-o", "out", "--to", "intensity"][..],
        &["convert", "A", "-o", "out", "--distance", "-1m"],
        &["convert", "A", "-o", "no-such-folder/out"],
        &["convert", "A", "--plot", "no-such-folder/x.svg"],
        &["convert", "bad.csv", "--plot", "x.svg"],
    ] {
        folder.run().args(arguments).assert().code(2);
        let left: Vec<String> = folder.names().into_iter().filter(|n| n.ends_with(".part") || n == "x.svg").collect();
        assert!(left.is_empty(), "{arguments:?}: {left:?}");
    }
}

#[test]
fn an_earlier_result_is_not_replaced_by_nothing() {
    let folder =
        Folder::new().with("bad.csv", "wavelength,value\n400,x\n410,1\n").with("out.txt", "an earlier result\n");
    folder.run().args(["convert", "bad.csv", "-o", "out.txt"]).assert().code(2);
    assert_eq!(fs::read_to_string(folder.path("out.txt")).expect("there"), "an earlier result\n");
}

#[cfg(unix)]
#[test]
fn an_output_that_is_no_regular_file_is_written_to_and_not_replaced() {
    use std::os::unix::fs::FileTypeExt;
    let folder = Folder::new();
    let pipe = folder.path("pipe");
    assert!(Process::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    // Open at both ends, so that neither side can wait for ever.
    let mut held = fs::OpenOptions::new().read(true).write(true).open(&pipe).expect("opened");
    folder.run().args(["convert", "D65", "--csv", "--figures", "luminous", "-o", "pipe"]).assert().success();
    assert!(
        fs::metadata(&pipe).expect("there").file_type().is_fifo(),
        "the pipe was replaced by a file, as /dev/null would be"
    );
    held.write_all(b"end").expect("written");
    let mut start = [0_u8; 5];
    held.read_exact(&mut start).expect("read");
    assert_eq!(&start, b"path,");
}

#[test]
fn a_picture_and_the_results_do_not_share_a_file() {
    let folder = Folder::new();
    folder.run().args(["convert", "D65", "-o", "x.svg", "--plot", "x.svg"]).assert().code(2).stderr(contains("x.svg"));
}

#[test]
fn pictures_are_written_in_the_format_of_their_name() {
    let folder = Folder::new();
    let lamp = office_led();
    folder.run().arg("convert").arg(&lamp).args(["--plot", "x.svg", "--plot", "x.svg"]).assert().code(2);
    folder.run().arg("convert").arg(&lamp).args(["--plot", "x.svg"]).assert().success();
    let svg = fs::read_to_string(folder.path("x.svg")).expect("written");
    assert!(svg.contains("<svg") && svg.trim_end().ends_with("</svg>") && svg.len() > 10_000, "{}", svg.len());
    folder.run().arg("convert").arg(&lamp).args(["--plot", "X.PNG"]).assert().success();
    let png = fs::read(folder.path("X.PNG")).expect("written");
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n") && png.len() > 10_000, "{}", png.len());
    for kind in ["spectrum", "chromaticity", "chromaticity-xy", "tm30", "all"] {
        folder.run().arg("convert").arg(&lamp).args(["--plot", "k.svg", "--plot-kind", kind]).assert().success();
        assert!(fs::read_to_string(folder.path("k.svg")).expect("written").contains("<svg"), "{kind}");
    }
    let before = folder.names();
    folder
        .run()
        .arg("convert")
        .arg(&lamp)
        .args(["--plot", "x.gif"])
        .assert()
        .code(2)
        .stderr(contains(".svg").and(contains(".png")));
    assert_eq!(folder.names(), before);
}

#[test]
fn tables_print_their_provenance_and_their_numbers() {
    let list =
        String::from_utf8(photopic().arg("tables").assert().success().get_output().stdout.clone()).expect("UTF-8");
    for name in [
        "cie-1924-v",
        "cie-1951-v-prime",
        "cie-1931-2deg",
        "cie-1964-10deg",
        "cie-illuminants",
        "ies-ces99",
        "cie-s026",
    ] {
        assert!(list.contains(name), "{name}");
    }
    photopic().args(["tables", "cie-1924-v"]).assert().success().stdout(contains("10.25039").and(contains("sha256")));
    let csv = photopic().args(["tables", "cie-1924-v", "--csv"]).assert().success().get_output().stdout.clone();
    let text = String::from_utf8(csv).expect("UTF-8");
    assert!(text.lines().any(|l| l.starts_with("# licence: ")) && text.lines().any(|l| l.starts_with("# sha256: ")));
    assert!(text.lines().any(|l| l == "555,1" || l == "555,1.0"), "V(555 nm) = 1");
    // 471 wavelengths, 360 to 830 nm (CIE 018:2019).
    assert_eq!(text.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit())).count(), 471);
    // What is printed is read again as a spectrum.
    let document = json(photopic().args(["convert", "-", "-q", "--figures", "luminous"]).write_stdin(text));
    assert_eq!(document["results"][0]["integration"]["samples"], 471);
}

#[test]
fn help_manual_and_completions_know_the_verbs() {
    photopic()
        .arg("--help")
        .assert()
        .success()
        .stdout(contains("convert").and(contains("tables")).and(contains("Exit codes")));
    let help = contains("--distance").and(contains("--scale-to")).and(contains("--mesopic-adaptation"));
    photopic().args(["convert", "--help"]).assert().success().stdout(help);
    photopic().arg("man").assert().success().stdout(contains(".TH").and(contains("convert")));
    photopic().args(["man", "convert"]).assert().success().stdout(contains(".TH").and(contains("\\-\\-distance")));
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        photopic()
            .args(["completions", shell])
            .assert()
            .success()
            .stdout(contains("photopic").and(contains("scale-to")));
    }
}

#[test]
fn what_goes_into_a_pipe_has_no_escape_sequences() {
    let folder = Folder::new().with("bad.csv", "wavelength,value\n400,x\n410,1\n");
    for arguments in [
        &["--help"][..],
        &["convert", "--help"],
        &["convert"],
        &["convert", "D65", "bad.csv"],
        &["convert", "A", "--nonsense"],
        &["tables"],
    ] {
        for no_color in [false, true] {
            let mut command = folder.run();
            command.args(arguments);
            if no_color {
                command.env("NO_COLOR", "1");
            }
            let out = command.output().expect("runs");
            assert!(!out.stdout.contains(&0x1b) && !out.stderr.contains(&0x1b), "{arguments:?}, NO_COLOR {no_color}");
        }
    }
}

#[test]
fn quiet_says_errors_only_and_verbose_says_more() {
    let folder = Folder::new().with("one.csv", constant());
    let said = |arguments: &[&str]| {
        let out = folder.run().args(["convert", "one.csv"]).args(arguments).output().expect("runs");
        String::from_utf8(out.stderr).expect("UTF-8")
    };
    assert_eq!(said(&["-q"]), "");
    let (usual, verbose) = (said(&[]), said(&["-v"]));
    assert!(usual.contains("warning ") && !usual.contains("info "), "{usual}");
    assert!(verbose.contains("info "), "{verbose}");
    folder.run().args(["convert", "one.csv", "-q", "-v"]).assert().code(2);
}

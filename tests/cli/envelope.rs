//! The JSON envelope and its keys; CSV columns.

use std::fs;

use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::{Folder, K_M, at, close, constant, json, number, office_led, photopic};

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

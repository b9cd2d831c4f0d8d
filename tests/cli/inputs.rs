//! Inputs of every shape: files, standard input, columns, rows, streams.

use std::fs;

use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;

use crate::{Folder, json, number, office_led, photopic};

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

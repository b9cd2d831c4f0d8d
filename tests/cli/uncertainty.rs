//! `convert --uncertainty`, `compare` and `detector`: numbers of closed forms, exit codes, places of mistakes.

use crate::{Folder, json, number, office_led, photopic};

const SCALE: &str = "[[scale]]\nname = \"lamp\"\nrelative = 0.02\n[monte_carlo]\ntrials = 500\n";

#[test]
fn a_scale_of_two_per_cent_is_two_per_cent_of_lux_and_nothing_of_colour() {
    let folder = Folder::new().with("b.toml", SCALE);
    let document = json(folder.run().args(["convert", "--uncertainty", "b.toml"]).arg(office_led()));
    let lux = number(&document, "photopic.illuminance_lx");
    assert!((number(&document, "uncertainty.photopic.illuminance_lx.standard") / lux - 0.02).abs() < 1e-10);
    // 1.959964 · 2 % above and below.
    let high = number(&document, "uncertainty.photopic.illuminance_lx.expanded_95.1");
    assert!((high / lux - 1.039_199_279_690_801).abs() < 1e-10, "{high}");
    assert!(number(&document, "uncertainty.chromaticity_xy.0.standard") < 1e-10);
    assert_eq!(document["results"][0]["uncertainty_budget"]["contributions"][0]["name"], "lamp");
}

#[test]
fn csv_has_three_columns_more_for_each_figure_and_text_a_table() {
    let folder = Folder::new().with("b.toml", SCALE);
    let run = |form: &[&str]| {
        let mut command = folder.run();
        command.args(["convert", "--uncertainty", "b.toml"]).args(form).arg(office_led());
        String::from_utf8(command.assert().success().get_output().stdout.clone()).expect("text")
    };
    let csv = run(&["--csv"]);
    assert!(csv.lines().next().is_some_and(|h| h.contains(",uncertainty.cct_k.expanded_95.1")), "{csv}");
    let text = run(&[]);
    assert!(text.contains("share of the variance, %") && text.contains("95 % interval"), "{text}");
}

#[test]
fn mistakes_in_a_budget_are_told_with_file_line_and_column() {
    let folder = Folder::new()
        .with("b.toml", "[[scale]]\nrelativ = 0.02\n")
        .with("t.toml", "[[noise]]\nrelative_table = \"u.csv\"\n");
    let folder = folder.with("u.csv", "400,0.1\n500,x\n");
    let run = |budget: &str| {
        let mut command = folder.run();
        command.args(["convert", "--uncertainty", budget]).arg(office_led());
        String::from_utf8(command.assert().code(2).get_output().stderr.clone()).expect("text")
    };
    assert!(run("b.toml").contains("b.toml:2:1: unknown field `relativ`"));
    assert!(run("t.toml").contains("u.csv:2:5: found `x`; expected a finite number"));
    assert!(run("none.toml").contains("none.toml"));
    let out = photopic().args(["convert", "--budget-schema"]).assert().success().get_output().stdout.clone();
    assert!(String::from_utf8(out).is_ok_and(|s| s.contains("correlation_length_nm")));
}

#[test]
fn two_measurements_differ_or_not_and_the_exit_code_says_so() {
    let level = |v: f64| {
        let rows: String = (380..=780).step_by(5).map(|w| format!("{w},{v}\n")).collect();
        format!("wavelength_nm,irradiance_w_per_m2_nm\n{rows}")
    };
    let folder = Folder::new()
        .with("a.csv", level(1.0))
        .with("b.csv", level(1.05))
        .with("c.csv", level(1.1))
        .with("u.toml", SCALE);
    let compare = |with: &str| {
        let mut command = folder.run();
        command.args(["compare", "a.csv", with, "--uncertainty", "u.toml", "--quantity", "irradiance", "--json"]);
        command.args(["--figure", "photopic.illuminance_lx"]);
        command.assert()
    };
    // −0.05/(1.959964 · 0.02 √(1 + 1.05²)) = −0.879678; 10 %: −1.716034.
    for (with, code, e_n) in [("b.csv", 0, -0.879_678), ("c.csv", 1, -1.716_034)] {
        let out = compare(with).code(code).get_output().stdout.clone();
        let document: serde_json::Value = serde_json::from_slice(&out).expect("one JSON document");
        let got = number(&document, "figures.0.e_n");
        assert!((got - e_n).abs() < 2e-6, "{with}: {got}");
    }
}

/// One lamp calibrated both: 2 % of either cancel in the ratio, and 2 % of the difference are left: E_n = 1/(1.959964 · 0.02).
#[test]
fn a_shared_scale_is_named_and_cancels() {
    let level = |v: f64| {
        let rows: String = (380..=780).step_by(5).map(|w| format!("{w},{v}\n")).collect();
        format!("wavelength_nm,irradiance_w_per_m2_nm\n{rows}")
    };
    let folder = Folder::new().with("a.csv", level(1.05)).with("b.csv", level(1.0)).with("u.toml", SCALE);
    let run = |shared: &str| {
        let mut command = folder.run();
        command.args(["compare", "a.csv", "b.csv", "--uncertainty", "u.toml", "--quantity", "irradiance", "--json"]);
        command.args(["--figure", "photopic.illuminance_lx", "--shared", shared]);
        command.assert()
    };
    let out = run("lamp").code(1).get_output().stdout.clone();
    let document: serde_json::Value = serde_json::from_slice(&out).expect("one JSON document");
    let e_n = number(&document, "figures.0.e_n");
    assert!((e_n - 25.510_674).abs() < 1e-4, "{e_n}");
    assert!((number(&document, "figures.0.ratio") - 1.05).abs() < 1e-12);
    assert!(number(&document, "figures.0.expanded_ratio") < 1e-6);
    let out = run("slit").code(2).get_output().stderr.clone();
    let said = String::from_utf8(out).expect("text");
    assert!(said.contains("no contribution named `slit` in the budget of A; expected one of lamp"), "{said}");
}

#[test]
fn a_shifted_photometer_has_its_known_figures_and_they_are_ranked() {
    // V(λ) as CIE prints it, from the tool's own table; shifted by 1 and 5 nm.
    let table = photopic().args(["tables", "cie-1924-v", "--csv"]).assert().success().get_output().stdout.clone();
    let table = String::from_utf8(table).expect("text");
    let rows: Vec<(f64, f64)> = (table.lines())
        .filter_map(|l| l.split_once(',').and_then(|(w, v)| Some((w.trim().parse().ok()?, v.trim().parse().ok()?))))
        .collect();
    assert!(rows.len() > 400, "{table}");
    let shifted = |by: f64| {
        let lines: String = rows.iter().map(|(w, v)| format!("{},{v}\n", w + by)).collect();
        format!("wavelength_nm,responsivity\n{lines}")
    };
    let folder = Folder::new().with("one.csv", shifted(1.0)).with("five.csv", shifted(5.0));
    let document = json(folder.run().args(["detector", "five.csv", "one.csv", "--lamp", "A", "--lamp", "LED-B3"]));
    let results = document["results"].as_array().expect("results");
    // Computed apart from this project: 380–780 nm by 1 nm, illuminant A.
    for (result, want, rank) in [(&results[0], 0.094_127, 2), (&results[1], 0.019_103, 1)] {
        let got = result["f1_prime"].as_f64().expect("a number");
        assert!((got - want).abs() < 1e-6, "{got} {want}");
        assert_eq!(result["rank"], rank);
        assert_eq!(result["calibration_source"], "illuminant A");
        assert!((result["mismatch_factor"]["A"].as_f64().expect("a number") - 1.0).abs() < 1e-3);
    }
}

//! `flicker`: figures of closed forms, limits and exit codes, places of mistakes.

use crate::{Folder, json, number};

/// Light modulated by `depth` at 100 Hz, a second at 10 kHz.
fn wave(depth: f64) -> String {
    let light = |t: f64| 1.0 + depth * (2.0 * std::f64::consts::PI * 100.0 * t).sin();
    let rows: String =
        (0..10_000).map(|i| f64::from(i) * 1e-4).map(|t| format!("{},{}\n", 1e3 * t, light(t))).collect();
    format!("time [ms],lamp\n{rows}")
}

#[test]
fn a_sinusoid_has_its_closed_forms_and_limits_decide_the_exit_code() {
    let folder = Folder::new().with("w.csv", wave(0.2));
    let document = json(folder.run().args(["flicker", "w.csv"]));
    assert!((number(&document, "percent_flicker") - 20.0).abs() < 1e-9);
    // Of a hundred samples to a period the half wave sums to (π/100)²/3 less than its area.
    let index = 0.2 / std::f64::consts::PI;
    assert!((number(&document, "flicker_index") - index).abs() < 3.4e-4 * index);
    // 0.2 over 2.865e-5 · 100^1.543 + 0.225 = 0.259924.
    assert!((number(&document, "svm") - 0.769_456).abs() < 2e-4);
    assert!((number(&document, "fundamental_hz") - 100.0).abs() < 1e-3);
    assert!(document["results"][0]["pst_lm"].is_null());
    assert_eq!(document["findings"][0]["code"], "F003");
    for (limit, code) in [("0.9", 0), ("0.4", 1)] {
        let out = folder
            .run()
            .args(["flicker", "w.csv", "--svm-limit", limit])
            .assert()
            .code(code)
            .get_output()
            .stdout
            .clone();
        let text = String::from_utf8(out).expect("text");
        assert!(
            text.contains("percent flicker            20.00 %") && text.contains(&format!("within {limit}")),
            "{text}"
        );
    }
    // What cannot be determined is not kept.
    folder.run().args(["flicker", "w.csv", "--pst-lm-limit", "1"]).assert().code(1);
}

#[test]
fn files_that_are_no_waveform_are_told_with_their_place() {
    let folder = Folder::new().with("w.csv", "t,y\n0,1\n1,x\n").with("one.csv", "1\n2\n").with("empty.csv", "");
    let said = |arguments: &[&str]| {
        let mut command = folder.run();
        let out = command.arg("flicker").args(arguments).assert().code(2).get_output().stderr.clone();
        String::from_utf8(out).expect("text")
    };
    assert!(said(&["w.csv"]).contains("w.csv:3:3: found `x`"));
    assert!(said(&["one.csv"]).contains("or the sampling rate (--rate)"));
    assert!(said(&["one.csv", "--rate", "100"]).contains("2 samples; expected at least 16"));
    assert!(said(&["empty.csv"]).contains("empty.csv:1:1: found no row of numbers"));
    assert!(said(&["none.csv"]).contains("none.csv: cannot be read"));
    assert!(said(&["w.csv", "-", "-"]).contains("`-` given twice"));
}

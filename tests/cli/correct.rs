//! `correct`: the record above the table, a column of uncertainties that goes on into `convert`, exit codes and places of mistakes.

use crate::{Folder, json, number};

fn table(unit: &str, f: impl Fn(f64) -> String) -> String {
    let rows: String = (0..81).map(|i| 380.0 + 5.0 * f64::from(i)).map(|w| format!("{w},{}\n", f(w))).collect();
    format!("wavelength_nm,spectral irradiance [{unit}]\n{rows}")
}

fn text(command: &mut assert_cmd::Command) -> String {
    String::from_utf8(command.assert().success().get_output().stdout.clone()).expect("text")
}

#[test]
fn what_was_done_stands_above_the_table_and_in_the_document() {
    let folder = Folder::new()
        .with("raw.csv", table("W/m2/nm", |w| (1.0 + (w - 580.0) / 1000.0).to_string()))
        .with("dark.csv", table("mW/m2/nm", |_| "250".into()));
    let run = |form: &[&str]| {
        let mut command = folder.run();
        command.args(["correct", "raw.csv", "--dark", "dark.csv", "--fwhm", "5", "--smooth", "5,2"]).args(form);
        command
    };
    let out = text(&mut run(&[]));
    let lines: Vec<&str> = out.lines().collect();
    assert!(lines[0].starts_with("# photopic ") && lines[1].starts_with("# input raw.csv sha256 "), "{out}");
    assert!(lines[2].starts_with("# input dark.csv sha256 "), "{out}");
    assert_eq!(lines[3], "# 1. dark signal subtracted, 0.250000 on average");
    assert!(lines[4].contains("Stearns") && lines[5].contains("Savitzky-Golay, 5 samples, degree 2"), "{out}");
    assert_eq!(lines[6], "wavelength [nm],spectral irradiance [W/m2/nm]");
    let document = json(&mut run(&[]));
    let steps: Vec<&str> = document["results"][0]["steps"]
        .as_array()
        .map(|all| all.iter().filter_map(|s| s["step"].as_str()).collect())
        .unwrap_or_default();
    assert_eq!(steps, ["dark", "bandpass", "smoothing"]);
    // A straight line has no curvature and is a polynomial: 1 − 0.25 in the middle.
    assert!((number(&document, "value.40") - 0.75).abs() < 1e-12);
    assert!((number(&document, "steps.1.coefficient") - 1.0 / 12.0).abs() < 1e-15, "w = h");
}

#[test]
fn uncertainties_go_on_into_convert_with_their_covariance() {
    // 1 ± 0.1 mW in every sample, read as SI.
    let rows: String = (0..81).map(|i| format!("{},1,0.1\n", 380 + 5 * i)).collect();
    let folder = Folder::new()
        .with("raw.csv", format!("wavelength [nm],spectral irradiance [mW/m2/nm],u(E) [mW/m2/nm]\n{rows}"))
        .with("u.toml", "[[noise]]\ncolumn = true\n[monte_carlo]\ntrials = 500\n")
        .with("c.toml", "[[noise]]\ncovariance = \"cov.csv\"\n[monte_carlo]\ntrials = 500\n");
    let lux = |file: &str, budget: &str| {
        let document = json(folder.run().args(["convert", file, "--uncertainty", budget]));
        assert_eq!(document["results"].as_array().map(Vec::len), Some(1), "uncertainties are no spectrum");
        number(&document, "uncertainty.photopic.illuminance_lx.standard")
    };
    let raw = lux("raw.csv", "u.toml");
    // u(E_v) = K_m Δλ u √ΣV²; ΣV² over 380–780 nm by 5 nm from the CIE's table (numpy).
    let v2 = 15.440_640;
    assert!((raw / (683.002 * 5.0 * 1e-4 * f64::sqrt(v2)) - 1.0).abs() < 1e-4, "{raw}");
    let mut command = folder.run();
    command.args(["correct", "raw.csv", "--smooth", "5,2", "-o", "smooth.csv", "--covariance", "cov.csv"]);
    let said = String::from_utf8(command.assert().success().get_output().stderr.clone()).expect("text");
    // V(λ) is nearly a parabola over five samples: smoothing takes next to nothing from its integral, so that u stays. The column
    // alone, √(17/35) of the noise as if independent, says less.
    assert!((lux("smooth.csv", "c.toml") / raw - 1.0).abs() < 0.01);
    assert!((lux("smooth.csv", "u.toml") / raw - f64::sqrt(17.0 / 35.0)).abs() < 0.01);
    assert!(said.contains("X006"), "{said}");
    let none =
        folder.run().args(["convert", "D65", "--uncertainty", "u.toml"]).assert().code(2).get_output().stderr.clone();
    assert!(String::from_utf8_lossy(&none).contains("expected one beside the samples, headed u(…)"));
}

#[test]
fn a_lamp_of_lines_moves_the_axis_and_its_residuals_are_printed() {
    let lines = [404.6565, 435.8335, 546.075, 576.961, 579.067];
    let peak = |w: f64, l: f64| (-((w - l - 0.5) / 0.6).powi(2)).exp();
    let rows: String = (0..2001)
        .map(|i| 390.0 + 0.1 * f64::from(i))
        .map(|w| format!("{w},{:.9}\n", 1e-6 + lines.iter().map(|l| peak(w, *l)).sum::<f64>()))
        .collect();
    let folder = Folder::new().with("hg.csv", format!("wavelength_nm,counts\n{rows}"));
    let mut command = folder.run();
    command.args(["correct", "hg.csv", "--line-lamp", "hg.csv", "--element", "hg", "--degree", "1"]);
    let out = text(&mut command);
    assert!(out.contains("#    Hg 546.075 nm at 546.5750: ") && out.contains("wavelengths from 5 lines"), "{out}");
    let first = out.lines().find(|l| !l.starts_with('#') && !l.starts_with("wavelength")).expect("a row");
    let at: f64 = first.split(',').next().and_then(|c| c.parse().ok()).expect("a wavelength");
    assert!((at - 389.5).abs() < 1e-3, "{first}");
    let mut few = folder.run();
    few.args(["correct", "hg.csv", "--line-lamp", "hg.csv", "--element", "Kr"]);
    let said = String::from_utf8(few.assert().code(2).get_output().stderr.clone()).expect("text");
    assert!(said.contains("expected at least 5 for a polynomial of degree 3"), "{said}");
}

#[test]
fn a_description_is_read_and_mistakes_have_their_place() {
    let folder = Folder::new()
        .with("raw.csv", table("W/m2/nm", |_| "1".into()))
        .with("c.toml", "[noise]\nread = 0.01\n[resampling]\nstep_nm = 10\nrange_nm = [400, 700]\n")
        .with("bad.toml", "[dark]\nfil = \"x\"\n")
        .with("flux.csv", "wavelength_nm,spectral flux [W/nm]\n400,1\n410,2\n")
        .with("short.csv", "wavelength_nm,spectral irradiance [W/m2/nm]\n400,1\n410,2\n");
    let document = json(folder.run().args(["correct", "raw.csv", "--corrections", "c.toml"]));
    assert_eq!(document["results"][0]["wavelength_nm"].as_array().map(Vec::len), Some(31));
    assert!((number(&document, "standard_uncertainty.3") - 0.01).abs() < 1e-15);
    let failing = |arguments: &[&str]| {
        let mut command = folder.run();
        let out = command.arg("correct").args(arguments).assert().code(2).get_output().stderr.clone();
        String::from_utf8(out).expect("text")
    };
    assert!(failing(&["raw.csv", "--corrections", "bad.toml"]).contains("bad.toml:2:1: unknown field `fil`"));
    assert!(failing(&["raw.csv", "--dark", "short.csv"]).contains("a dark spectrum on 2 samples of 400–410 nm"));
    assert!(failing(&["raw.csv"]).contains("no correction asked for"));
    assert!(failing(&["raw.csv", "--dark", "flux.csv"]).contains("irradiance, and the dark spectrum flux"));
    assert!(failing(&["raw.csv", "--smooth", "4,2"]).contains("expected an odd window"));
    assert!(failing(&["raw.csv", "--smooth", "4"]).contains("such as 7,2"));
    assert!(failing(&["raw.csv", "--smooth", "5,2", "-o", "raw.csv"]).contains("would overwrite an input"));
    assert!(text(folder.run().args(["correct", "--schema"])).contains("line_spreads"));
}

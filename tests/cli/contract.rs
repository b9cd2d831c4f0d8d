//! The contract of integration: rules, ranges, constants, resampling, figures asked for.

use predicates::str::contains;

use crate::{Folder, close, constant, json, number, office_led, photopic};

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

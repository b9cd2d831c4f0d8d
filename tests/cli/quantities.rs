//! Quantities, geometry and levels: numbers that follow from the SI or from a standard's printed digits.

use predicates::prelude::*;
use predicates::str::{contains, is_empty};

use crate::{
    AVOGADRO, Folder, K_M, PLANCK, SPEED_OF_LIGHT, V_500, close, constant, json, number, office_led, photopic,
};

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

//! `convert --risk-group` and the recommendations for the eye: numbers of single lines, which need no integral.

use crate::{Folder, at, json, number, office_led, photopic};

const GROUP: &str = "hazard.risk_group";

/// S(270 nm) = 1 and 30 J/m² in 8 h: 0.02 W/m² for 1500 s, risk group 2 (0.003 to 0.03 W/m²). Of one line nothing is missing.
#[test]
fn an_ultraviolet_line_has_its_group_and_its_time() {
    let run = ["convert", "line:270nm", "--scale-to", "0.02 W/m2", "--risk-group", "-q"];
    let document = json(photopic().args(run));
    let of = |key: &str| at(&document["results"][0], &format!("{GROUP}.{key}")).clone();
    assert_eq!((of("group"), of("complete")), ("rg2".into(), true.into()), "{document}");
    let value = number(&document, &format!("{GROUP}.hazards.actinic_uv.value_w_per_m2"));
    assert!((value - 0.02).abs() < 1e-15);
    let seconds = number(&document, &format!("{GROUP}.hazards.actinic_uv.longest_exposure_s"));
    assert!((seconds - 1500.0).abs() < 1e-9, "{seconds}");
    assert_eq!(of("hazards.infrared.group"), "exempt");
}

/// B(440 nm) = 1, R(440 nm) = 10. 10 W/m² from a disk of 0.05 rad: L = E/(π sin²τ), τ = 0.025 rad.
#[test]
fn a_radiance_follows_from_the_angle_of_the_source() {
    let run = ["convert", "line:440nm", "--scale-to", "10 W/m2", "--cone", "25mrad", "--risk-group"];
    let document = json(photopic().args(run));
    let radiance = 10.0 / (std::f64::consts::PI * 0.025f64.sin().powi(2));
    let hazard = |key: &str| number(&document, &format!("{GROUP}.hazards.{key}"));
    assert!((hazard("blue_light.value_w_per_m2_sr") / radiance - 1.0).abs() < 1e-12);
    assert!((hazard("retinal_thermal.value_w_per_m2_sr") / (10.0 * radiance) - 1.0).abs() < 1e-12);
    // 28 000/α and 71 000/α.
    assert!((hazard("retinal_thermal.limits_w_per_m2_sr.0") / (28e3 / 0.05) - 1.0).abs() < 1e-12);
    assert!((hazard("retinal_thermal.limits_w_per_m2_sr.2") / (71e3 / 0.05) - 1.0).abs() < 1e-12);
    assert_eq!(number(&document, &format!("{GROUP}.subtense_rad")), 0.05);
    // 5094 W/(m²·sr): beyond 100 and below 10⁴, for 196 s.
    assert_eq!(at(&document["results"][0], &format!("{GROUP}.group")), &serde_json::json!("rg1"));
    assert!((hazard("blue_light.longest_exposure_s") * radiance / 1e6 - 1.0).abs() < 1e-12);
}

#[test]
fn what_a_group_does_not_rest_on_is_told() {
    let folder = Folder::new();
    let document = json(folder.run().args(["convert", "--risk-group"]).arg(office_led()));
    let missing = at(&document["results"][0], &format!("{GROUP}.not_assessed"));
    assert_eq!(missing["blue_light"], "no radiance is known");
    assert!(document["findings"].as_array().expect("findings").iter().any(|f| f["code"] == "P014"), "{document}");
    // A relative spectrum has no group.
    let document = json(photopic().args(["convert", "D65", "--risk-group"]));
    assert!(document["results"][0]["hazard"].get("risk_group").is_none());
    assert!(document["findings"].as_array().expect("findings").iter().any(|f| f["code"] == "P013"), "{document}");
}

/// Brown et al. 2022: at least 250 lx by day, at most 10 lx in the evening, at most 1 lx at night; D65 is its own equivalent.
#[test]
fn melanopic_illuminance_is_held_against_the_recommendations() {
    for (lux, day, evening, night) in [
        ("251 lx", true, false, false),
        ("100 lx", false, false, false),
        ("9.9 lx", false, true, false),
        ("0.9 lx", false, true, true),
    ] {
        let document = json(photopic().args(["convert", "D65", "--scale-to", lux, "-q"]));
        let met =
            |when: &str| at(&document["results"][0], &format!("alpha_opic.melanopic.recommended.{when}.met")).clone();
        assert_eq!(
            [met("day"), met("evening"), met("night")],
            [day, evening, night].map(serde_json::Value::from),
            "{lux}"
        );
    }
    let folder = Folder::new();
    folder
        .run()
        .args(["convert", "D65", "--scale-to", "300 lx", "--plot", "e.svg", "--plot-kind", "melanopic", "-q"])
        .assert()
        .success();
    let picture = std::fs::read_to_string(folder.path("e.svg")).expect("a picture");
    assert!(picture.contains("250 lx") && picture.contains("10 lx") && picture.contains("1 lx"));
    let refused = folder.run().args(["convert", "D65", "--plot", "n.svg", "--plot-kind", "melanopic"]).assert().code(2);
    let said = String::from_utf8(refused.get_output().stderr.clone()).expect("text");
    assert!(said.contains("no melanopic illuminance"), "{said}");
}

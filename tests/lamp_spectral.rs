//! `lamp spectral`: closed forms, the reference figures of the spectra times the lamp's flux, angular spectra made of blackbodies
//! of known temperature, and their way through TM-33.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use assert_cmd::Command;
use photopic::constants::SecondRadiation;
use photopic::conversion::{Converter, Settings};
use photopic::illuminant::named;
use photopic::luminaire::format::{eulumdat, ies, tm33};
use photopic::luminaire::spectral::{Error, SpectralLamp, by_direction, combine};
use photopic::luminaire::{AngularSpectra, Distribution, Kind, Luminaire, Symmetry, System};
use photopic::photometry::transfer::Geometry;
use photopic::spectrum::{Grid, Quantity, Spectrum};
use predicates::boolean::PredicateBooleanExt;
use serde_json::Value;

mod common;

/// A lamp of cos γ × `peak` downwards: its flux is π × peak up to the straight lines between rows of 1°.
fn lamp(kind: Kind, peak: f64) -> Luminaire {
    let vertical: Vec<f64> = (0..=90).map(f64::from).collect();
    let values = vertical.iter().map(|v| peak * v.to_radians().cos()).collect();
    Luminaire {
        name: "a cosine".into(),
        manufacturer: "ours".into(),
        catalogue_number: "1".into(),
        kind,
        distribution: Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vertical, values)
            .expect("a table"),
        absolute: true,
        lamps: Vec::new(),
        input_power_w: Some(10.0),
        declared_flux: None,
        declared_output_ratio: None,
        declared_downward_fraction: None,
        opening: None,
        housing: None,
        spectrum: None,
        angular_spectra: None,
        keywords: Vec::new(),
    }
}

fn spectrum(name: &str) -> Spectrum {
    named::source(name, SecondRadiation::default()).expect("a source").spectrum
}

fn combined(lamp: &Luminaire, shape: &Spectrum) -> Result<SpectralLamp, Error> {
    let converter = Converter::new(Settings::default());
    combine(lamp, "test", shape, &converter, &Geometry::default()).map(|c| c.value)
}

#[test]
fn a_line_has_its_efficacy_in_both_directions() {
    // V(555 nm) = 1: W = lm/683.002, and cd = 683.002 × W/sr.
    let shape = spectrum("line:555nm");
    let luminous = lamp(Kind::Luminous, 100.0);
    let flux_lm = luminous.distribution.total_flux();
    let got = combined(&luminous, &shape).expect("combined");
    assert!((got.total_flux(Kind::Radiant) / (flux_lm / 683.002) - 1.0).abs() < 1e-14);
    assert!((got.total_flux(Kind::Luminous) / flux_lm - 1.0).abs() < 1e-14);
    // λ/(N_A h c) at 555 nm: 555 × 8.359 35e-3 µmol/J.
    assert!((got.total_flux(Kind::Photon) / (flux_lm / 683.002 * 555.0 * 8.359_35e-3) - 1.0).abs() < 1e-6);
    assert!((got.directions[60].intensities.radiant_w_per_sr / (50.0 / 683.002) - 1.0).abs() < 1e-12);
    let radiant = lamp(Kind::Radiant, 2.0);
    let got = combined(&radiant, &shape).expect("combined");
    assert!((got.directions[0].intensities.luminous_cd / (2.0 * 683.002) - 1.0).abs() < 1e-12);
    assert!((got.peak.absolute[0].photopic / (2.0 * 683.002) - 1.0).abs() < 1e-12);
    let photon = lamp(Kind::Photon, 3.0);
    let got = combined(&photon, &shape).expect("combined");
    assert!((got.total_flux(Kind::Photon) / photon.distribution.total_flux() - 1.0).abs() < 1e-14);
}

#[test]
fn far_ultraviolet_is_weighted_with_its_own_hazard_and_has_no_candela() {
    // S(λ) at 270 nm is 1 (ICNIRP 2004, table 1): the weighted intensity is the intensity.
    let radiant = lamp(Kind::Radiant, 0.5);
    let got = combined(&radiant, &spectrum("line:270nm")).expect("combined");
    let peak = got.peak_of(|i| i.actinic_uv_w_per_sr).expect("weighted");
    assert!((peak.1 - 0.5).abs() < 1e-12 && peak.0.vertical_deg == 0.0);
    // At 222 nm between 0.12 (220 nm) and 0.15 (225 nm) of the same table.
    let far = combined(&radiant, &spectrum("line:222nm")).expect("combined");
    let weighted = far.peak_of(|i| i.actinic_uv_w_per_sr).expect("weighted").1;
    assert!((0.06..0.075).contains(&weighted), "{weighted}");
    assert_eq!(far.total_flux(Kind::Luminous), 0.0);
    // The other direction cannot be: candela from a spectrum that is not seen.
    let refused = combined(&lamp(Kind::Luminous, 100.0), &spectrum("line:222nm"));
    assert!(matches!(refused, Err(Error::NoContent { what: "luminous", .. })), "{refused:?}");
    assert!(matches!(combined(&lamp(Kind::Luminous, 0.0), &spectrum("D65")), Err(Error::Dark { .. })));
}

#[test]
fn reference_spectra_give_their_figures_times_the_flux() {
    let (Some(path), Some(spectra)) = (common::shared("spectra/reference.csv"), common::reference_spectra()) else {
        return;
    };
    let luminous = lamp(Kind::Luminous, 1000.0);
    let flux_lm = luminous.distribution.total_flux();
    for row in common::rows(&path) {
        let Some((name, shape)) = spectra.iter().find(|(name, _)| *name == row["name"]) else { continue };
        let got = combined(&luminous, shape).expect(name);
        let near = |what: &str, got: f64| {
            let Ok(want) = row[what].parse::<f64>() else { return };
            assert!((got / want - 1.0).abs() < 1e-11, "{name} {what}: {got} {want}");
        };
        // Summed like numpy where the grid is one to be summed (steps up to 5 nm).
        let step = shape.grid().step_nm().unwrap_or(f64::INFINITY);
        if step <= 5.0 {
            near("np_LER_sum", flux_lm / got.total_flux(Kind::Radiant));
            let melanopic = got.flux.alpha_opic.iter().find(|a| a.receptor == "melanopic").expect("melanopic");
            near("np_DER_mel", melanopic.der.expect("lit"));
            let photons = got.flux.photons.expect("photons");
            near("np_PPF_umol_per_J", photons.umol_per_j.expect("lit"));
        }
        // The rest is what `convert --scale-to` gives for the same lumens.
        let level = Some(format!("{flux_lm} lm").parse().expect("a level"));
        let scaled = Converter::new(Settings { level, ..Settings::default() });
        let want = scaled.convert(name, Quantity::Relative, shape).expect(name).value;
        let same = |what: &str, a: f64, b: f64| {
            assert!((a - b).abs() <= 1e-12 * b.abs(), "{name} {what}: {a} {b}");
        };
        let (ours, theirs) = (got.flux.photons.expect("photons"), want.photons.expect("photons"));
        same("PPF", ours.par_umol, theirs.par_umol);
        same("W", got.flux.absolute[0].radiometric, want.absolute[0].radiometric);
        same("scotopic", got.flux.absolute[0].scotopic, want.absolute[0].scotopic);
        for (a, b) in got.flux.hazard.iter().zip(&want.hazard) {
            same(a.key, a.weighted, b.weighted);
        }
    }
}

/// A grid of 5 nm over the visible range.
fn visible() -> Arc<Grid> {
    Arc::new(Grid::uniform(360.0, 5.0, 95).expect("a grid"))
}

/// Planck's law at 560 nm = 1, c₂ = 1.4388e-2 m·K.
fn blackbody(kelvin: f64, nm: f64) -> f64 {
    let x = |nm: f64| (1.4388e7 / (nm * kelvin)).exp_m1();
    (560.0 / nm).powi(5) * x(560.0) / x(nm)
}

/// Temperature of the synthetic lamp by direction.
fn kelvin(c: f64, gamma: f64) -> f64 {
    2700.0 + 10.0 * gamma + 2.0 * gamma * c.to_radians().cos()
}

/// Blackbodies of known temperature per direction, dimmer to the side.
fn angular() -> AngularSpectra {
    let planes = vec![0.0, 45.0, 90.0, 135.0, 180.0];
    let gamma: Vec<f64> = (0..=8).map(|i| f64::from(i) * 10.0).collect();
    let table = |nm: f64| {
        let value = |c: &f64, g: &f64| 0.01 * g.to_radians().cos().powi(2) * blackbody(kelvin(*c, *g), nm);
        let values = planes.iter().flat_map(|c| gamma.iter().map(|g| value(c, g)).collect::<Vec<_>>()).collect();
        Distribution::new(System::TypeC, Symmetry::BilateralC0, planes.clone(), gamma.clone(), values).expect("a table")
    };
    let grid = visible();
    let tables: Vec<Distribution> = grid.wavelengths_nm().iter().map(|nm| table(*nm)).collect();
    AngularSpectra::new(grid, &tables).expect("one table per wavelength")
}

#[test]
fn blackbodies_by_direction_keep_their_temperatures() {
    let spectra = angular();
    let converter = Converter::new(Settings::default());
    let got = by_direction(&spectra, "test", &converter, &Geometry::default()).expect("figures").value;
    let colour = got.colour.as_ref().expect("colour");
    for (d, c) in got.directions.iter().zip(&colour.directions) {
        let c = c.expect("lit");
        let want = kelvin(d.horizontal_deg, d.vertical_deg);
        let cct = c.cct.expect("near the locus");
        assert!((cct.kelvin - want).abs() < 0.1, "{d:?}: {} {want}", cct.kelvin);
        assert!(cct.duv.abs() < 1e-5, "{d:?}");
        // Intensity falls as cos² and the candela at 560 nm nearly so: 10 % of the peak is at about 72°.
        assert_eq!(c.counted, d.vertical_deg < 75.0, "{d:?}");
    }
    let (low, high) = colour.cct_range_k.expect("temperatures");
    assert!((low - 2700.0).abs() < 0.1 && (high - kelvin(0.0, 70.0)).abs() < 0.1, "{low} {high}");
    // The farthest from the mean, which lies between 2700 K and 3300 K, is the bluest direction that counts.
    let farthest = &got.directions[colour.max_direction];
    assert_eq!((farthest.horizontal_deg, farthest.vertical_deg), (0.0, 70.0));
    assert!(colour.rms_delta_uv_prime < colour.max_delta_uv_prime);
    // The flux is the integral of the intensities.
    let candela = spectra.frame().with_values(got.directions.iter().map(|d| d.intensities.luminous_cd).collect());
    let flux = candela.expect("a table").total_flux();
    assert!((got.total_flux(Kind::Luminous) / flux - 1.0).abs() < 1e-12);
}

#[test]
fn one_colour_in_all_directions_has_no_nonuniformity() {
    let table = |nm: f64| {
        let values = vec![blackbody(4000.0, nm), 0.5 * blackbody(4000.0, nm)];
        Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vec![0.0, 180.0], values).expect("a table")
    };
    let grid = visible();
    let tables: Vec<Distribution> = grid.wavelengths_nm().iter().map(|nm| table(*nm)).collect();
    let spectra = AngularSpectra::new(grid, &tables).expect("tables");
    let converter = Converter::new(Settings::default());
    let got = by_direction(&spectra, "test", &converter, &Geometry::default()).expect("figures").value;
    let colour = got.colour.expect("colour");
    assert!(colour.max_delta_uv_prime < 1e-14 && colour.rms_delta_uv_prime < 1e-14, "{colour:?}");
    // 1 at nadir, ½ at zenith: the mean over the sphere is ¾, 3π sr of the nadir's.
    let ratio = got.flux.absolute[0].photopic / got.peak.absolute[0].photopic;
    assert!((ratio / (3.0 * PI) - 1.0).abs() < 1e-12, "{ratio}");
}

#[test]
fn tm33_keeps_every_angular_value() {
    let mut luminaire = lamp(Kind::Luminous, 1.0);
    let spectra = angular();
    luminaire.distribution = spectra.frame().clone();
    luminaire.angular_spectra = Some(spectra.clone());
    let written = tm33::write(&luminaire).expect("written").value;
    let again = tm33::read(written.as_bytes()).expect("read").value.angular_spectra.expect("carried");
    assert_eq!(again.frame().symmetry(), Symmetry::BilateralC0);
    assert_eq!(again.grid(), spectra.grid());
    for direction in 0..spectra.directions() {
        assert_eq!(again.angles_deg(direction), spectra.angles_deg(direction));
        for (a, b) in again.values(direction).iter().zip(spectra.values(direction)) {
            assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
        }
    }
    // The other formats say what they lose.
    let lost = |findings: &[photopic::finding::Finding], code: &str| {
        findings.iter().any(|f| f.code == code && f.message.contains("angular spectra"))
    };
    let written = ies::write(&luminaire, ies::Version::Lm63_2019).expect("written");
    assert!(lost(&written.findings, "L040"), "{:?}", written.findings);
    let written = eulumdat::write(&luminaire).expect("written");
    assert!(lost(&written.findings, "L290"), "{:?}", written.findings);
    // A spectrum of lines has no W/nm to be written.
    luminaire.angular_spectra = None;
    luminaire.spectrum = Some(spectrum("line:555nm"));
    let written = tm33::write(&luminaire).expect("written");
    assert!(written.findings.iter().any(|f| f.code == "L390" && f.message.contains("lines")));
    assert!(!written.value.contains("<SpectralData>"));
}

fn run(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::new(env!("CARGO_BIN_EXE_photopic")).current_dir(folder).args(["lamp", "spectral"]).args(arguments).assert()
}

fn result(assert: &assert_cmd::assert::Assert) -> Value {
    let mut document: Value = serde_json::from_slice(&assert.get_output().stdout).expect("one JSON document");
    document["results"][0].take()
}

fn number(v: &Value) -> f64 {
    v.as_f64().expect("a number")
}

#[test]
fn the_command_combines_and_converts() {
    let folder = tempfile::tempdir().expect("a folder");
    let even = "IESNA:LM-63-2002\n[TEST] 1\n[TESTLAB] none\n[ISSUEDATE] 2026\n[MANUFAC] ours\nTILT=NONE\n1 -1 100 3 1 1 2 0 0 0\n1 1 10\n0 90 180\n0\n1 1 1\n";
    fs::write(folder.path().join("even.ies"), even).expect("written");
    // 100 cd in all directions are 400π lm.
    let got = result(&run(folder.path(), &["even.ies", "line:555nm", "--json", "--distance", "2m"]).code(0));
    let watts = 400.0 * PI / 683.002;
    assert!((number(&got["flux"]["radiometric"]["flux_w"]) / watts - 1.0).abs() < 1e-12);
    assert!((number(&got["radiant_efficiency"]) / (watts / 10.0) - 1.0).abs() < 1e-12);
    assert!((number(&got["ppe_umol_per_j"]) / (watts / 10.0 * 555.0 * 8.359_35e-3) - 1.0).abs() < 1e-6);
    assert!((number(&got["peak"]["photopic"]["illuminance_lx"]) / 25.0 - 1.0).abs() < 1e-12);
    assert_eq!(got["spectrum"]["source"], "given");
    // Into W/sr, as LM-63 and as TM-33 with the spectrum, and back with the file's own.
    let arguments = ["even.ies", "LED-B3", "-o", "even.xml", "--quantity", "radiant", "--json"];
    let first = result(&run(folder.path(), &arguments).code(0));
    let second = result(&run(folder.path(), &["even.xml", "--json"]).code(0));
    assert_eq!((&second["kind"], &second["spectrum"]["source"]), (&Value::from("radiant"), &Value::from("own")));
    let lumens = number(&second["flux"]["photopic"]["luminous_flux_lm"]);
    assert!((lumens / (400.0 * PI) - 1.0).abs() < 1e-8, "{lumens}");
    let der = |v: &Value| number(&v["flux"]["alpha_opic"]["melanopic"]["der"]);
    assert!((der(&first) / der(&second) - 1.0).abs() < 1e-8);
    run(folder.path(), &["even.ies", "LED-B3", "-o", "watts.ies", "--quantity", "radiant"]).code(0);
    let third = result(&run(folder.path(), &["watts.ies", "LED-B3", "--json"]).code(0));
    assert!((number(&third["flux"]["photopic"]["luminous_flux_lm"]) / (400.0 * PI) - 1.0).abs() < 1e-7);
    // One table.
    let csv = run(folder.path(), &["even.ies", "LED-B3", "--csv"]).code(0);
    let mut rows = csv::Reader::from_reader(&csv.get_output().stdout[..]);
    assert_eq!(rows.headers().expect("a header").get(2), Some("luminous_intensity_cd"));
    let candela: Vec<f64> = rows.records().map(|r| r.expect("a row")[2].parse().expect("a number")).collect();
    assert!(candela.len() == 3 && candela.iter().all(|cd| (cd / 100.0 - 1.0).abs() < 1e-12), "{candela:?}");
    // What cannot be.
    for bad in [
        &["even.ies"][..],
        &["even.ies", "line:222nm"],
        &["even.ies", "no-such-source"],
        &["no-such.ies", "D65"],
        &["even.ies", "D65", "--plot", "x.pdf"],
        &["even.ies", "D65", "--plot", "x.svg"],
        &["even.ies", "D65", "-o", "x.pdf"],
        &["even.ies", "D65", "-o", "even.ies"],
        &["-", "-"],
    ] {
        run(folder.path(), bad).code(2);
    }
}

#[test]
fn the_command_draws_colour_over_angle() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut luminaire = lamp(Kind::Luminous, 1.0);
    let spectra = angular();
    let weights = vec![1.0; spectra.grid().len()];
    luminaire.distribution = spectra.weighted(&weights).expect("a sum");
    luminaire.angular_spectra = Some(spectra);
    fs::write(folder.path().join("a.xml"), tm33::write(&luminaire).expect("written").value).expect("written");
    let got = result(&run(folder.path(), &["a.xml", "--json", "--plot", "a.svg", "-o", "b.xml"]).code(0));
    assert_eq!(got["spectrum"]["source"], "angular");
    assert_eq!(got["directions"].as_array().map(Vec::len), Some(45));
    assert!((number(&got["directions"][1]["cct_k"]) - kelvin(0.0, 10.0)).abs() < 0.1);
    assert!(number(&got["colour_over_angle"]["max_delta_uv_prime"]) > 0.01);
    let svg = fs::read_to_string(folder.path().join("a.svg")).expect("drawn");
    for text in ["CCT [K]", "Δu′v′", "C135", "colour over angle"] {
        assert!(svg.contains(text), "{text}");
    }
    // Written again it is the same lamp, now with the luminous sum of its own spectra.
    let again = result(&run(folder.path(), &["b.xml", "--json"]).code(0));
    let flux = |v: &Value| number(&v["flux"]["photopic"]["luminous_flux_lm"]);
    assert!((flux(&again) / flux(&got) - 1.0).abs() < 1e-8);
    // With fewer angles in its table the spectra of the others have no place, and it is told.
    fs::write(folder.path().join("few.toml"), "[lamp]\nevery_vertical = 2\n").expect("written");
    let mut convert = Command::cargo_bin("photopic").expect("the program");
    convert.current_dir(folder.path()).args(["lamp", "convert", "a.xml", "-o", "c.xml", "--settings", "few.toml"]);
    convert.assert().success().stderr(predicates::str::contains("L404").and(predicates::str::contains("by direction")));
    let file = tm33::read(&fs::read(folder.path().join("c.xml")).expect("written")).expect("read").value;
    assert!(
        file.angular_spectra.is_none()
            && file.distribution.vertical_deg().len() < luminaire.distribution.vertical_deg().len()
    );
    // A spectrum given goes before the file's own.
    let given = result(&run(folder.path(), &["a.xml", "D65", "--json"]).code(0));
    assert!(given["spectrum"]["source"] == "given" && given.get("directions").is_none());
}

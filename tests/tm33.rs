//! TM-33-18, TM-33-23, ATLA S001: the reference folder's files against the values in their XML, angular spectra against closed
//! forms, round trips, own invalid documents, and random changes.

mod common;

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use photopic::finding::{Checked, Finding, Severity};
use photopic::luminaire::format::eulumdat;
use photopic::luminaire::format::tm33;
use photopic::luminaire::{Body, Distribution, Kind, LampSet, Luminaire, Shape, Symmetry, System};
use photopic::spectrum::{Grid, Spectrum};
use proptest::prelude::*;

fn files() -> Option<Vec<PathBuf>> {
    let folder = common::shared("luminaires")?;
    let rows = common::rows(&folder.join("index.csv"));
    let names = rows.iter().map(|row| row["file"].clone()).filter(|name| name.ends_with(".xml"));
    Some(names.map(|name| folder.join("files").join(name)).collect())
}

fn read(text: &str) -> Checked<Luminaire> {
    tm33::read(text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

fn codes(findings: &[Finding]) -> Vec<&'static str> {
    findings.iter().map(|f| f.code).collect()
}

/// (h, v, value) of each intensity by a plain search in the text.
fn triples(text: &str) -> Vec<(f64, f64, f64)> {
    let mut out = Vec::new();
    for part in text.split("<Int").skip(1).filter(|p| p.starts_with("Data") || p.starts_with("ensityData")) {
        let (tag, rest) = part.split_once('>').expect("a tag");
        let quoted: Vec<f64> = tag.split('"').skip(1).step_by(2).map(|t| t.parse().expect("a number")).collect();
        let value = rest.split('<').next().expect("a text").trim().parse().expect("a number");
        out.push((quoted[0], quoted[1], value));
    }
    out
}

#[test]
fn every_file_has_the_values_of_its_xml() {
    let Some(files) = files() else { return };
    assert!(files.len() >= 15);
    for path in files {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let text = fs::read_to_string(&path).expect("the file opens");
        let got = tm33::read(text.as_bytes()).unwrap_or_else(|error| panic!("{name}: {error}"));
        let table = &got.value.distribution;
        let values = triples(&text);
        assert!(!values.is_empty());
        for (h, v, value) in &values {
            assert_eq!(table.at(*h, *v), *value, "{name} at {h} {v}");
        }
        let peak = values.iter().map(|v| v.2).fold(0.0, f64::max);
        assert_eq!(table.peak().0, peak, "{name}");
        // The flux of planes by Simpson's rule in steps of a hundredth of a degree, planes by their mean over C.
        let zone = |v: f64| -> f64 {
            let n = 360;
            (0..n).map(|c| table.at(f64::from(c) + 0.5, v)).sum::<f64>() / f64::from(n) * v.to_radians().sin()
        };
        let steps = 3600;
        let width = 180.0 / f64::from(steps);
        let flux: f64 = (0..steps).map(|i| zone((f64::from(i) + 0.5) * width)).sum::<f64>() * width.to_radians() * TAU;
        assert!((table.total_flux() / flux - 1.0).abs() < 1e-4, "{name}: {} {flux}", table.total_flux());
        println!("{name}: {:.3} lm, {:?} {:?}", table.total_flux(), table.symmetry(), codes(&got.findings));
        for finding in &got.findings {
            if finding.severity != Severity::Info {
                println!("    {finding}");
            }
        }
    }
}

#[test]
fn facts_of_the_standards_own_example() {
    let Some(files) = files() else { return };
    let path = files.iter().find(|p| p.ends_with("sample-luminaire.xml")).expect("the example");
    let file = tm33::parse(&fs::read(path).expect("the file opens")).expect("read").value;
    assert_eq!((file.schema, file.version.as_str()), (tm33::Schema::AtlaS001, "1.0"));
    assert_eq!((file.goniometer, file.emitters.len()), (Some(tm33::Goniometer::C), 1));
    assert_eq!((file.emitters[0].cct_k, file.emitters[0].ra), (Some(4000.0), Some(92.0)));
    assert_eq!(file.emitters[0].areas.len(), 2);
    let luminaire = Checked::<Luminaire>::try_from(&file).expect("read").value;
    assert_eq!((luminaire.name.as_str(), luminaire.catalogue_number.as_str()), ("LED 2' x 4' Troffer", "XET 55529"));
    assert!(luminaire.absolute);
    assert_eq!(luminaire.input_power_w, Some(35.4));
    let box_of = |l: f64, w: f64, h: f64| Body { shape: Shape::Rectangle, length_m: l, width_m: w, height_m: h };
    assert_eq!(luminaire.housing, Some(box_of(1.2, 0.6, 0.1)));
    // Two areas of 0.5 m, their centres 0.2 m apart.
    let opening = luminaire.opening.expect("areas");
    assert!((opening.length_m - 0.7).abs() < 1e-12 && (opening.width_m - 0.6).abs() < 1e-12, "{opening:?}");
    let keyword = |label: &str| luminaire.keywords.iter().find(|k| k.0 == label).map(|k| k.1.as_str());
    assert_eq!((keyword("TEST"), keyword("ISSUEDATE")), (Some("APEX-091101-004"), Some("2009-11-01")));
}

/// A document with the emitters given.
fn document(root: &str, emitters: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<{root}>\n<Version>1.1</Version>\n<Header><Description>d</Description><Laboratory>l</Laboratory>\
         <ReportNumber>1</ReportNumber><ReportDate>2024-01-01</ReportDate></Header>\n{emitters}\n</{root}>\n"
    )
}

fn emitter(content: &str) -> String {
    format!(
        "<Emitter><Quantity>1</Quantity><Description>e</Description><InputWattage>10</InputWattage>{content}</Emitter>"
    )
}

/// A table of f on the angles given.
fn int_data(planes: &[f64], gamma: &[f64], f: impl Fn(f64, f64) -> f64) -> String {
    let mut out = String::new();
    for h in planes {
        for v in gamma {
            let _ = writeln!(out, "<IntData h=\"{h}\" v=\"{v}\">{}</IntData>", f(*h, *v));
        }
    }
    out
}

fn luminous(symmetry: &str, data: &str) -> String {
    emitter(&format!(
        "<LuminousData><LuminousIntensity><AbsolutePhotometry>true</AbsolutePhotometry>{symmetry}{data}</LuminousIntensity></LuminousData>"
    ))
}

const GAMMA: [f64; 4] = [0.0, 30.0, 60.0, 90.0];

#[test]
fn each_symmetry_means_its_planes() {
    let f = |h: f64, v: f64| 100.0 + v * (2.0 + h.to_radians().cos().powi(2));
    let whole: Vec<f64> = (0..24).map(|i| f64::from(i) * 15.0).collect();
    let part = |from: f64, to: f64| whole.iter().copied().filter(|h| *h >= from && *h <= to).collect::<Vec<_>>();
    let front: Vec<f64> = part(0.0, 90.0).into_iter().chain(part(270.0, 345.0)).collect();
    let reference =
        read(&document("IESTM33-22", &luminous("<Symm>Symm_None</Symm>", &int_data(&whole, &GAMMA, f)))).value;
    let flux = reference.distribution.total_flux();
    for (symm, planes, expected) in [
        ("<Symm>Symm_Quad</Symm>", part(0.0, 90.0), Symmetry::Quadrant),
        ("<Symm>Symm _ Bi _ 0</Symm>", part(0.0, 180.0), Symmetry::BilateralC0),
        ("<Symm>Symm _ Bi _90</Symm>", part(90.0, 270.0), Symmetry::BilateralC90),
        ("<Symm>Symm_Bi_90</Symm>", front, Symmetry::BilateralC90),
        ("", part(0.0, 90.0), Symmetry::Quadrant),
        ("", part(0.0, 180.0), Symmetry::BilateralC0),
        ("", whole.clone(), Symmetry::None),
        ("<Symm>Symm_Quad</Symm>", whole.clone(), Symmetry::None),
    ] {
        let got = read(&document("IESTM33-22", &luminous(symm, &int_data(&planes, &GAMMA, f))));
        assert_eq!(got.value.distribution.symmetry(), expected, "{symm}");
        assert!((got.value.distribution.total_flux() / flux - 1.0).abs() < 1e-13, "{symm}");
        for (c, v) in [(0.0, 10.0), (100.0, 45.0), (190.0, 80.0), (355.0, 60.0)] {
            assert!(
                (got.value.distribution.at(c, v) / reference.distribution.at(c, v) - 1.0).abs() < 1e-12,
                "{symm} {c}"
            );
        }
        assert_eq!(codes(&got.findings).contains(&"L302"), symm.is_empty());
        assert_eq!(codes(&got.findings).contains(&"L303"), symm.contains("Quad") && planes.len() == 24);
    }
    let one =
        read(&document("IESTM33", &luminous("<Symm>Symm_Full</Symm>", &int_data(&[0.0], &GAMMA, |_, v| 90.0 - v))))
            .value;
    assert_eq!(one.distribution.symmetry(), Symmetry::Rotational);
}

#[test]
fn radiant_photon_and_type_b_are_kept_as_what_they_are() {
    let table = int_data(&[0.0], &[0.0, 180.0], |_, _| 2.0);
    for (data, intensity, kind) in
        [("RadiantData", "RadiantIntensity", Kind::Radiant), ("PhotonData", "PhotonIntensity", Kind::Photon)]
    {
        let text = emitter(&format!(
            "<{data}><MinWavelength>200</MinWavelength><MaxWavelength>300</MaxWavelength><{intensity}><Absolute>true</Absolute><Symm>Symm_Full</Symm><Multiplier>3</Multiplier>{table}</{intensity}></{data}>"
        ));
        let got = read(&document("IESTM33-22", &text));
        assert_eq!(got.value.kind, kind);
        // 6 per steradian over the whole sphere.
        assert!((got.value.distribution.total_flux() / (24.0 * PI) - 1.0).abs() < 1e-14);
        assert!(codes(&got.findings).contains(&"L311"));
    }
    let angles: Vec<f64> = (-9..=9).map(|i| f64::from(i) * 10.0).collect();
    let flat = luminous("<Symm>Symm_None</Symm>", &int_data(&angles, &angles, |_, _| 5.0));
    let equipment = "<Equipment><Gonioradiometer><Type>IES_B</Type></Gonioradiometer></Equipment>";
    let got = read(&document("IESTM33-22", &format!("{equipment}{flat}"))).value.distribution;
    assert_eq!(got.system(), System::TypeB);
    assert!((got.total_flux() / (10.0 * PI) - 1.0).abs() < 1e-13);
    // The type of the gonioradiometer does not make Type C angles into others.
    let c = luminous("<Symm>Symm_Full</Symm>", &int_data(&[0.0], &[0.0, 180.0], |_, _| 5.0));
    let got = read(&document("IESTM33-22", &format!("{equipment}{c}")));
    assert_eq!(got.value.distribution.system(), System::TypeC);
    assert!(codes(&got.findings).contains(&"L310"));
}

/// Spectral intensity s(λ) × (1 + cos γ)/2 in W/(sr·nm).
fn angular(nm: &[f64], gamma: &[f64], f: impl Fn(f64, f64) -> f64) -> String {
    let mut out = String::from("<SpectralData><AngularSpectral><Absolute>true</Absolute><Symm>Symm_Full</Symm>");
    let _ = write!(
        out,
        "<NumberMeasured>{}</NumberMeasured><NumberHorz>1</NumberHorz><NumberVert>{}</NumberVert><NumberWavelength>{}</NumberWavelength>",
        gamma.len(),
        gamma.len(),
        nm.len()
    );
    for v in gamma {
        for w in nm {
            let _ = writeln!(out, "<IntData h=\"0\" v=\"{v}\" w=\"{w}\">{}</IntData>", f(*v, *w));
        }
    }
    out.push_str("</AngularSpectral></SpectralData>");
    emitter(&out)
}

#[test]
fn angular_spectra_give_their_sums() {
    let nm: Vec<f64> = (380..=780).step_by(5).map(f64::from).collect();
    let gamma: Vec<f64> = (0..=18).map(|i| f64::from(i) * 10.0).collect();
    // Redder to the side: 0.01 W/(sr·nm) × (1 ± …), all directions.
    let f = |v: f64, w: f64| 0.01 * (1.0 + (w - 580.0) / 400.0 * v / 180.0);
    let text = document("IESTM33-22", &angular(&nm, &gamma, f));
    let file = tm33::parse(text.as_bytes()).expect("read").value;
    let spectral = file.emitters[0].angular_spectral.as_ref().expect("spectra");
    let side = spectral.spectrum(0, 9).expect("a direction").expect("a spectrum");
    assert_eq!((side.wavelengths_nm().len(), side.values()[80]), (81, f(90.0, 780.0)));
    // 400 nm × 0.01 W/(sr·nm) in every direction, as the tilt of the spectrum has no mean.
    let radiant = file.luminaire(Kind::Radiant).expect("summed").value;
    for v in &gamma {
        assert!((radiant.distribution.at(0.0, *v) / 4.0 - 1.0).abs() < 1e-12);
    }
    // At γ 0 the spectrum is equal energy: 0.01 × 683.002 × ∫V dλ; ∫V over 380–780 is 106.8567 nm (CIE 018:2019, 1 nm
    // sum 106.8566).
    let got = read(&text);
    assert_eq!(got.value.kind, Kind::Luminous);
    let nadir = got.value.distribution.at(0.0, 0.0);
    assert!((nadir / (0.01 * 683.002 * 106.8566) - 1.0).abs() < 1e-4, "{nadir}");
    let photon = file.luminaire(Kind::Photon).expect("summed").value;
    // λ/(N_A h c): 8.359 35e-3 µmol/(J·nm); equal energy from 380 to 780 has its mean at 580 nm.
    assert!((photon.distribution.at(0.0, 0.0) / (4.0 * 580.0 * 8.359_35e-3) - 1.0).abs() < 1e-5);
    // The whole: 4π × the mean over the sphere, where the tilt at γ is γ/180 of its largest; its mean over the sphere is ½.
    let spectrum = got.value.spectrum.expect("integrated");
    let at = |index: usize| spectrum.values()[index] / (4.0 * PI * 0.01);
    assert!((at(40) - 1.0).abs() < 1e-12 && (at(80) - 1.25).abs() < 1e-12 && (at(0) - 0.75).abs() < 1e-12);
    // Ultraviolet alone has no luminous sum: radiant then.
    let dark: Vec<f64> = (200..=300).step_by(10).map(f64::from).collect();
    let got = read(&document("IESTM33-22", &angular(&dark, &gamma, |_, _| 0.02)));
    assert_eq!(got.value.kind, Kind::Radiant);
    assert!((got.value.distribution.total_flux() / (4.0 * PI * 2.0) - 1.0).abs() < 1e-12);
}

#[test]
fn emitters_are_added_up_exactly() {
    let narrow = int_data(&[0.0], &[0.0, 10.0, 20.0], |_, v| 200.0 - 5.0 * v);
    let wide = int_data(&[0.0, 45.0, 90.0], &GAMMA, |h, v| 100.0 + h - v / 2.0);
    let parts = [
        luminous("<Symm>Symm_Full</Symm>", &narrow),
        luminous("<Symm>Symm_Quad</Symm>", &wide),
        luminous("<Symm>Symm_Quad</Symm>", &wide),
    ];
    let each: f64 = parts.iter().map(|p| read(&document("IESTM33-22", p)).value.distribution.total_flux()).sum();
    let all = read(&document("IESTM33-22", &parts.concat()));
    // The step at 20° is put into 1e-4°.
    assert!((all.value.distribution.total_flux() / each - 1.0).abs() < 1e-6);
    assert_eq!(all.value.distribution.at(45.0, 15.0), 125.0 + 2.0 * (145.0 - 7.5));
    assert_eq!(all.value.distribution.at(135.0, 60.0), 2.0 * (145.0 - 30.0));
    assert_eq!(all.value.input_power_w, Some(30.0));
    assert!(codes(&all.findings).contains(&"L306"));
    let same = read(&document("IESTM33-22", &[parts[1].clone(), parts[2].clone()].concat())).value.distribution;
    assert_eq!((same.symmetry(), same.at(90.0, 30.0)), (Symmetry::Quadrant, 2.0 * 175.0));
}

#[test]
fn every_kind_of_table_survives_the_writer() {
    let gamma: Vec<f64> = (0..=36).map(|i| f64::from(i) * 2.5).collect();
    let steps = |from: f64, to: f64| (0..=8).map(|i| from + (to - from) * f64::from(i) / 8.0).collect::<Vec<_>>();
    let mut luminaire = sample();
    for (system, symmetry, planes, vertical) in [
        (System::TypeC, Symmetry::Rotational, vec![0.0], gamma.clone()),
        (System::TypeC, Symmetry::Quadrant, steps(0.0, 90.0), gamma.clone()),
        (System::TypeC, Symmetry::BilateralC0, steps(0.0, 180.0), gamma.clone()),
        (System::TypeC, Symmetry::BilateralC90, steps(90.0, 270.0), gamma.clone()),
        (System::TypeC, Symmetry::None, steps(0.0, 360.0), gamma.clone()),
        (System::TypeB, Symmetry::None, steps(-90.0, 90.0), steps(-90.0, 90.0)),
        (System::TypeA, Symmetry::None, steps(-80.0, 80.0), steps(-90.0, 90.0)),
        (System::TypeB, Symmetry::Quadrant, steps(0.0, 90.0), steps(-90.0, 90.0)),
    ] {
        let values = planes
            .iter()
            .flat_map(|h| vertical.iter().map(|v| 1_234.567_8 + h.to_radians().sin() * v).collect::<Vec<_>>());
        luminaire.distribution =
            Distribution::new(system, symmetry, planes.clone(), vertical.clone(), values.collect()).expect("a table");
        for kind in [Kind::Luminous, Kind::Radiant, Kind::Photon] {
            luminaire.kind = kind;
            let text = tm33::write(&luminaire).expect("written").value;
            let again = read(&text);
            assert!(again.findings.iter().all(|f| f.code == "L111"), "{:?}", again.findings);
            let (a, b) = (&again.value.distribution, &luminaire.distribution);
            assert_eq!((a.system(), a.symmetry(), again.value.kind), (system, symmetry, kind));
            assert!(
                (a.total_flux() / b.total_flux() - 1.0).abs() < 1e-9 && (a.peak().0 / b.peak().0 - 1.0).abs() < 1e-9
            );
            let (opening, housing) = (again.value.opening, again.value.housing);
            assert_eq!((opening, housing), (luminaire.opening, luminaire.housing));
            assert_eq!(again.value.spectrum, luminaire.spectrum);
            assert_eq!(again.value.keywords, luminaire.keywords);
            assert_eq!(again.value.lamps, luminaire.lamps);
        }
    }
}

fn sample() -> Luminaire {
    let spectrum = Spectrum::density(Grid::new(vec![400.0, 500.0, 600.0]).expect("a grid"), vec![0.5, 1.0, 0.25]);
    let round = |d: f64, h: f64| Body { shape: Shape::Round, length_m: d, width_m: d, height_m: h };
    Luminaire {
        name: "A & B <c>".into(),
        manufacturer: "M".into(),
        catalogue_number: "7".into(),
        kind: Kind::Luminous,
        distribution: Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vec![0.0, 90.0], vec![1.0; 2])
            .expect("a table"),
        absolute: false,
        lamps: vec![LampSet {
            count: Some(2.0),
            name: "LED".into(),
            flux_lm: Some(20_000.0),
            colour: "3000".into(),
            rendering: "85".into(),
            power_w: Some(12.5),
        }],
        input_power_w: Some(12.5),
        declared_flux: None,
        declared_output_ratio: None,
        declared_downward_fraction: None,
        opening: Some(round(0.3, 0.0)),
        housing: Some(round(0.4, 0.1)),
        spectrum: Some(spectrum.expect("a spectrum")),
        angular_spectra: None,
        keywords: vec![
            ("TESTLAB".into(), "lab".into()),
            ("TEST".into(), "R 1".into()),
            ("ISSUEDATE".into(), "2024-02-29".into()),
            ("_TILT_DEG".into(), "5".into()),
            ("OTHER".into(), "a remark".into()),
        ],
    }
}

#[test]
fn eulumdat_files_survive_tm33_and_the_way_back() {
    let Some(folder) = common::shared("luminaires") else { return };
    let rows = common::rows(&folder.join("reference.csv"));
    let (mut worst, mut count) = (0.0_f64, 0);
    for row in rows.iter().filter(|row| row["file"].ends_with(".ldt") && row["ref_status"] == "ok") {
        let bytes = fs::read(folder.join("files").join(&row["file"])).expect("the file opens");
        let first = eulumdat::read(&bytes).expect("read").value;
        let document = tm33::write(&first).expect("written").value;
        let second = read(&document).value;
        let third = eulumdat::read(eulumdat::write(&second).expect("written").value.as_bytes()).expect("read").value;
        for other in [&second, &third] {
            let relative = |a: f64, b: f64| (a / b - 1.0).abs();
            let flux = relative(other.distribution.total_flux(), first.distribution.total_flux());
            let peak = relative(other.distribution.peak().0, first.distribution.peak().0);
            assert!(flux < 1e-5 && peak < 1e-5, "{}: {flux} {peak}", row["file"]);
            worst = worst.max(flux).max(peak);
        }
        count += 1;
    }
    println!("{count} files, worst {worst:.1e}");
    assert!(count >= 60);
}

#[test]
fn what_could_be_wrong_is_refused_with_its_place() {
    let good = int_data(&[0.0, 90.0], &GAMMA, |_, v| 90.0 - v);
    let with = |symm: &str, data: &str| document("IESTM33-22", &luminous(symm, data));
    let cases: Vec<(String, &str)> = vec![
        (
            with("", &good.replacen("<IntData h=\"90\" v=\"60\">30</IntData>", "", 1)),
            "7 values beside 2 × 4 different h, v",
        ),
        (with("", &good.replacen("v=\"60\"", "v=\"30\"", 1)), "a second value at (0, 30)"),
        (with("", &good.replacen(">60<", ">NaN<", 1)), "found NaN; expected a finite number for <IntData>"),
        (with("", &good.replacen(">60<", ">INF<", 1)), "expected a finite number"),
        (with("", &good.replacen(">60<", "><", 1)), "expected a number for <IntData>"),
        (with("", &good.replacen("v=\"60\"", "", 1)), "without attribute `v`"),
        (with("<NumberVert>5</NumberVert>", &good), "<NumberVert> of 5 beside 4"),
        (with("<NumberHorz>1000000000</NumberHorz>", &good), "<NumberHorz> of 1000000000 beside 2"),
        (with("<Symm>Symm_Some</Symm>", &good), "found `Symm_Some` for <Symm>"),
        (with("<Symm>Symm_None</Symm>", &good), "2 planes from 0° to 90°"),
        (with("<Symm>Symm_Bi_0</Symm>", &good), "2 planes from 0° to 90°"),
        (with("<Multiplier>0</Multiplier>", &good), "a number above 0"),
        (with("", &int_data(&[0.0, 120.0], &GAMMA, |_, _| 1.0)), "2 planes from 0° to 120°"),
        (with("", &int_data(&[0.0], &[-90.0, 0.0], |_, _| 1.0)), "vertical angles"),
        (with("", &int_data(&[0.0], &[0.0, 200.0], |_, _| 1.0)), "vertical angles"),
        (with("", ""), "expected <IntData> elements"),
        (document("IESTM33-22", ""), "without <Emitter>"),
        (document("IESTM33-22", &emitter("")), "expected luminous intensity"),
        (document("gpx", &emitter("")), "the element <gpx>"),
        (with("", &good).replace("</IESTM33-22>", ""), "broken XML"),
        (with("", &good)[..200].to_owned(), "broken XML"),
        ("<a".to_owned(), "broken XML"),
        (String::new(), "empty"),
    ];
    for (text, words) in cases {
        let error = match tm33::read(text.as_bytes()) {
            Err(error) => error,
            Ok(got) => panic!("{words}: read as {:?}", got.findings),
        };
        assert!(error.to_string().contains(words), "{error}: {words}");
    }
    let error =
        tm33::read(format!("\n\n{}", with("", &good.replacen(">60<", ">NaN<", 1))).as_bytes()).expect_err("NaN");
    // Two blank lines, four of head, the emitter's with the first value, and the second.
    assert_eq!(error.location().line, Some(8), "{error}");
    let mut twice = good.clone();
    twice.push_str("</LuminousIntensity></LuminousData><LuminousData><LuminousIntensity>");
    twice.push_str(&good);
    assert!(tm33::read(with("", &twice).as_bytes()).is_err());
}

/// `tests/data/lamps/invalid`: every document there is refused, with a place.
#[test]
fn the_invalid_corpus_is_refused() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/lamps/invalid");
    let mut seen = 0;
    for entry in fs::read_dir(folder).expect("the corpus") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "xml") {
            let error = tm33::read(&fs::read(&path).expect("opens")).map(|got| got.value).expect_err("refused");
            assert!(error.location().line.is_some(), "{}: {error}", path.display());
            println!("{}: {error}", path.display());
            seen += 1;
        }
    }
    assert!(seen >= 6);
}

#[test]
fn hostile_documents_are_refused_before_they_cost_anything() {
    // Tables without common angles, whose sum would have 10⁸ values.
    let many: Vec<f64> = (0..10_000).map(|i| f64::from(i) * 0.009).collect();
    let row = luminous("<Symm>Symm_Full</Symm>", &int_data(&[0.0], &many, |_, _| 1.0));
    let planes: Vec<f64> = (0..10_000).map(|i| f64::from(i) * 0.036).collect();
    let plane = luminous("<Symm>Symm_None</Symm>", &int_data(&planes, &[0.0], |_, _| 1.0));
    let error = tm33::read(document("IESTM33-22", &[row, plane].concat()).as_bytes()).expect_err("too large");
    assert!(error.to_string().contains("expected at most 10000000"), "{error}");
    // Nesting.
    for depth in [10_000, 300_000] {
        let deep = format!("<IESTM33>{}{}</IESTM33>", "<a>".repeat(depth), "</a>".repeat(depth));
        assert!(tm33::read(deep.as_bytes()).is_err());
        let deep = format!("<IESTM33><Header>{}{}</Header></IESTM33>", "<a>".repeat(depth), "</a>".repeat(depth));
        assert!(tm33::read(deep.as_bytes()).is_err());
    }
    // Entities that multiply.
    let laughs = "<!DOCTYPE l [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;\">]><IESTM33>&b;</IESTM33>";
    assert!(tm33::read(laughs.as_bytes()).is_err());
}

#[test]
fn contradictions_within_a_file_are_found() {
    let table = |content: &str| {
        format!(
            "<LuminousData><LuminousIntensity>{content}{}</LuminousIntensity></LuminousData>",
            int_data(&[0.0], &[0.0, 180.0], |_, _| 1000.0 / (4.0 * PI))
        )
    };
    let has = |text: &str, code: &str| {
        let found = read(&document("IESTM33-22", text)).findings;
        assert!(codes(&found).contains(&code), "{code}: {found:?}");
    };
    has(&emitter(&format!("<RatedLumens>350</RatedLumens>{}", table(""))), "L307");
    has(&emitter(&table("<NumberMeasured>9</NumberMeasured>")), "L304");
    has(&emitter(&table("")).replace("<Quantity>1<", "<Quantity>4294967295<"), "L308");
    has(&emitter(&table("")).replace("<Quantity>1</Quantity>", ""), "L315");
    has(
        &format!(
            "<Luminaire><Dimensions><Length>600</Length><Width>600</Width><Height>50</Height></Dimensions></Luminaire>{}",
            emitter(&table(""))
        ),
        "L305",
    );
    has(&emitter(&format!("{}<IllumData><NumberPlanes>1</NumberPlanes></IllumData>", table(""))), "L309");
    has(&format!("{}{}", emitter(&table("")), emitter("")), "L306");
    let spectrum = "<SpectralData><EmitterSpectral><NumberWavelength>2</NumberWavelength><PwrData w=\"500\">1</PwrData><PwrData w=\"600\">1</PwrData></EmitterSpectral></SpectralData>";
    let lit = emitter(&format!("{}{spectrum}", table("")));
    has(&format!("{lit}{lit}"), "L313");
    let radiant = table("").replace("Luminous", "Radiant");
    has(&emitter(&format!("{}{radiant}", table(""))), "L312");
    let gamma = [0.0, 180.0];
    let dim = angular(&[500.0, 600.0], &gamma, |_, _| 1e-6).replace("<InputWattage>10</InputWattage>", &table(""));
    has(&dim, "L314");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = tm33::read(&bytes);
    }

    #[test]
    fn no_change_of_a_document_makes_reader_or_writer_panic(
        at in 0usize..4000,
        length in 0usize..30,
        instead in prop_oneof!["[0-9.eE+-]{0,8}", "\\PC{0,4}", "<Symm>Symm_(Quad|Full|None|Bi_90)</Symm>", "-?(1e308|NaN|INF|0)"],
    ) {
        let nm = [400.0, 500.0, 600.0];
        let mut text = document("IESTM33-22", &[
            luminous("<Symm>Symm_Quad</Symm>", &int_data(&[0.0, 45.0, 90.0], &GAMMA, |h, v| h + v)),
            angular(&nm, &GAMMA, |_, w| w),
        ].concat());
        let from = at.min(text.len());
        text.replace_range(from..(from + length).min(text.len()), &instead);
        if let Ok(got) = tm33::read(text.as_bytes()) {
            let written = tm33::write(&got.value).expect("written");
            let flux = got.value.distribution.total_flux();
            if let Ok(again) = tm33::read(written.value.as_bytes()) {
                let there = again.value.distribution.total_flux();
                prop_assert!(!(1e-9..1e300).contains(&flux.abs()) || (there / flux - 1.0).abs() < 1e-5, "{flux} {there}");
            }
        }
    }
}

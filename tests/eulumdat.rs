//! EULUMDAT: the reference folder's files against `reference.csv` (an independent reader and integrators, eight printed digits),
//! mutants, round trips, own invalid files, and random bytes.

mod common;

use std::collections::HashMap;
use std::fs;
use std::path::PathBuf;

use photopic::finding::{Checked, Finding, Severity};
use photopic::luminaire::format::eulumdat::{self, Isym, ReadOptions, Stored};
use photopic::luminaire::{Body, Distribution, Kind, LampSet, Luminaire, Shape, Symmetry, System};
use proptest::prelude::*;

/// Rows of `reference.csv` on EULUMDAT files, and where the files are.
fn reference() -> Option<(PathBuf, Vec<HashMap<String, String>>)> {
    let folder = common::shared("luminaires")?;
    let mut rows = common::rows(&folder.join("reference.csv"));
    rows.retain(|row| row["file"].ends_with(".ldt"));
    Some((folder.join("files"), rows))
}

fn read(bytes: &[u8]) -> Checked<Luminaire> {
    eulumdat::read(bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn codes(findings: &[Finding]) -> Vec<&'static str> {
    findings.iter().map(|f| f.code).collect()
}

/// Half a unit of the eighth significant digit, as the table prints.
fn printed(value: f64) -> f64 {
    if value == 0.0 { 1e-9 } else { 0.5001 * 10f64.powi(value.abs().log10().floor() as i32 - 7) }
}

#[test]
fn every_whole_file_has_the_flux_and_peak_of_the_reference() {
    let Some((files, rows)) = reference() else { return };
    let mut worst = (0.0_f64, String::new());
    let mut read_files = 0;
    for row in rows.iter().filter(|row| row["ref_status"] == "ok") {
        let got = eulumdat::read(&fs::read(files.join(&row["file"])).expect("the file opens"));
        let got = got.unwrap_or_else(|error| panic!("{}: {error}", row["file"]));
        let table = &got.value.distribution;
        let number = |key: &str| row[key].parse::<f64>().expect("a number");
        let exact = table.total_flux();
        let difference = (exact / number("flux_exact") - 1.0).abs();
        assert!(difference < 1e-4, "{}: {exact} for {}", row["file"], row["flux_exact"]);
        assert!(
            (exact - number("flux_exact")).abs() <= printed(exact) * 1.1,
            "{}: {exact} for {}",
            row["file"],
            row["flux_exact"]
        );
        if difference > worst.0 {
            worst = (difference, row["file"].clone());
        }
        let zonal = table.total_flux_zonal();
        let within = printed(zonal) * 1.1;
        assert!((zonal - number("flux_zonal")).abs() <= within, "{}: {zonal} for {}", row["file"], row["flux_zonal"]);
        let (peak, h, v) = table.peak();
        assert!((peak / number("peak_cd") - 1.0).abs() < 1e-7, "{}: {peak}", row["file"]);
        assert!((v - number("peak_v")).abs() < 1e-9, "{}: {v}", row["file"]);
        // The reference keeps the planes of Isym 3 as C270 … C90, the model their mirror images.
        let there = number("peak_h").rem_euclid(360.0);
        let same = [there, (180.0 - there).rem_euclid(360.0)].iter().any(|a| (a - h).abs() < 1e-9);
        assert!(same || (table.at(there, v) - peak).abs() < 1e-9 * peak, "{}: {h} for {there}", row["file"]);
        let down = table.flux_between(0.0, 90.0) / exact;
        assert!((down - number("down_frac")).abs() < 1e-7, "{}: {down}", row["file"]);
        assert_eq!(codes(&got.findings).iter().filter(|c| **c == "L110" || **c == "L111").count(), 0);
        println!("{}: {exact:.8} lm, {:?}", row["file"], codes(&got.findings));
        read_files += 1;
    }
    println!("{read_files} files, worst exact flux {:.1e} at {}", worst.0, worst.1);
    assert!(read_files >= 60);
}

#[test]
fn mutants_give_their_flux_or_are_refused() {
    let Some(folder) = common::shared("luminaires") else { return };
    let mut seen = (0, 0);
    for row in common::rows(&folder.join("mutants.csv")).iter().filter(|row| row["file"].ends_with(".ldt")) {
        let bytes = fs::read(folder.join("files").join(&row["file"])).expect("the file opens");
        match (row["expect"].parse::<f64>(), eulumdat::read(&bytes)) {
            (Ok(expected), Ok(got)) => {
                let flux = got.value.distribution.total_flux();
                assert!((flux / expected - 1.0).abs() < 1e-12, "{}: {flux}", row["file"]);
                seen.0 += 1;
            }
            (Err(_), Err(error)) => {
                println!("{}: {error}", row["file"]);
                assert!(error.location().line.is_some() && error.hint().is_some() || row["file"].contains("isym7"));
                seen.1 += 1;
            }
            (expected, got) => panic!("{}: {expected:?}, {:?}", row["file"], got.map(|g| g.findings)),
        }
    }
    assert_eq!(seen, (10, 2));
    let malformed = folder.join("files/Manav02012002+luxera/tests/fixtures/photometry/synthetic_basic.ldt");
    println!("{}", eulumdat::read(&fs::read(malformed).expect("the file opens")).expect_err("three numbers on a line"));
}

#[test]
fn symmetric_and_unfolded_mutants_agree_everywhere() {
    let Some((files, _)) = reference() else { return };
    let read = |name: &str| read(&fs::read(files.join("_mutants").join(name)).expect("the file opens")).value;
    let (folded, whole) = (read("o3_lf.ldt").distribution, read("o3_unfold.ldt").distribution);
    assert_eq!((folded.symmetry(), whole.symmetry()), (Symmetry::BilateralC90, Symmetry::None));
    for c in 0..720 {
        for v in 0..180 {
            let (c, v) = (f64::from(c) / 2.0, f64::from(v) / 2.0);
            assert!((folded.at(c, v) - whole.at(c, v)).abs() < 1e-9, "C{c} γ{v}");
        }
    }
}

/// Findings that say something of the table itself, which no writer may change.
const OF_THE_TABLE: [&str; 4] = ["L110", "L111", "L114", "L219"];

#[test]
fn written_files_keep_flux_and_peak_and_have_no_findings() {
    let Some((files, rows)) = reference() else { return };
    let mut worst = (0.0_f64, 0.0_f64);
    for row in rows.iter().filter(|row| row["ref_status"] == "ok") {
        let first = read(&fs::read(files.join(&row["file"])).expect("the file opens")).value;
        let text = eulumdat::write(&first).unwrap_or_else(|error| panic!("{}: {error}", row["file"]));
        let again = read(text.value.as_bytes());
        let inherent = |f: &Finding| OF_THE_TABLE.contains(&f.code) || f.code == "L216" || f.code == "L212";
        let findings: Vec<&Finding> = again.findings.iter().filter(|f| !inherent(f)).collect();
        assert!(findings.is_empty(), "{}: {findings:?}\n{:?}", row["file"], text.findings);
        let second = again.value;
        let relative = |a: f64, b: f64| (a / b - 1.0).abs();
        let flux = relative(second.distribution.total_flux(), first.distribution.total_flux());
        let peak = relative(second.distribution.peak().0, first.distribution.peak().0);
        assert!(flux < 1e-5 && peak < 1e-5, "{}: {flux} {peak}", row["file"]);
        worst = (worst.0.max(flux), worst.1.max(peak));
        assert_eq!(second.distribution.symmetry(), first.distribution.symmetry());
        assert_eq!((&second.name, &second.manufacturer), (&first.name, &first.manufacturer));
        assert_eq!(second.keywords.iter().find(|k| k.0 == "TEST"), first.keywords.iter().find(|k| k.0 == "TEST"));
        assert_eq!(second.opening, first.opening);
        plane_set_is_valid(text.value.as_bytes(), &row["file"]);
    }
    println!("worst flux {:.1e}, peak {:.1e}", worst.0, worst.1);
}

/// What a reader that knows only the format's rules needs: Mc planes listed, ascending from C0 within a turn, Dc·Mc = 360° or
/// Dc = 0, the stored planes by Isym and Mc where they have to be, as many numbers.
fn plane_set_is_valid(bytes: &[u8], name: &str) {
    let lines: Vec<&str> = std::str::from_utf8(bytes).expect("text").split("\r\n").collect();
    let number = |i: usize| lines[i - 1].parse::<f64>().unwrap_or_else(|_| panic!("{name}: line {i}"));
    let (isym, mc, dc, ng, dg) = (number(3), number(4) as usize, number(5), number(6) as usize, number(7));
    let start = 26 + 6 * number(26) as usize + 10;
    let planes: Vec<f64> = (1..=mc).map(|i| number(start + i)).collect();
    let gamma: Vec<f64> = (1..=ng).map(|i| number(start + mc + i)).collect();
    assert!(planes[0] == 0.0 && planes.windows(2).all(|w| w[1] > w[0]) && planes[mc - 1] < 360.0, "{name}");
    assert!(gamma.windows(2).all(|w| w[1] > w[0]), "{name}");
    for (step, angles) in [(dc, &planes), (dg, &gamma)] {
        assert!(step == 0.0 || angles.windows(2).all(|w| (w[1] - w[0] - step).abs() < 1e-5), "{name}");
    }
    assert!(dc == 0.0 || (dc * mc as f64 - 360.0).abs() < 1e-3, "{name}");
    let (first, stored) = match isym {
        0.0 => (1, mc),
        1.0 => (1, 1),
        2.0 => (1, mc / 2 + 1),
        3.0 => (3 * mc / 4 + 1, mc / 2 + 1),
        _ => (1, mc / 4 + 1),
    };
    let last = planes[(first + stored - 2) % mc];
    match isym {
        2.0 => assert_eq!(last, 180.0, "{name}"),
        3.0 => assert_eq!((planes[first - 1], last), (270.0, 90.0), "{name}"),
        4.0 => assert_eq!(last, 90.0, "{name}"),
        _ => {}
    }
    assert_eq!(lines.len(), start + mc + ng + stored * ng + 1, "{name}");
}

/// A file of 24 planes with Isym 4 by hand: (line, text) pairs replace lines.
fn sample(changes: &[(usize, &str)]) -> String {
    let mut lines: Vec<String> = [
        "Maker",
        "2",
        "4",
        "4",
        "90",
        "3",
        "45",
        "R 1",
        "Name",
        "Number",
        "file.ldt",
        "2024-01-01/me",
        "1200",
        "300",
        "80",
        "1000",
        "200",
        "10",
        "10",
        "10",
        "10",
        "100",
        "50",
        "1",
        "0",
        "1",
        "2",
        "LED",
        "1000",
        "4000",
        "80",
        "25.5",
    ]
    .map(str::to_owned)
    .into();
    lines.extend((1..=10).map(|i| (f64::from(i) / 10.0).to_string()));
    lines.extend(["0", "90", "180", "270", "0", "45", "90"].map(str::to_owned));
    lines.extend(["200", "150", "0", "200", "100", "0"].map(str::to_owned));
    for (line, text) in changes {
        lines[line - 1] = (*text).to_owned();
    }
    lines.join("\r\n")
}

#[test]
fn every_line_arrives_where_it_belongs() {
    let file = eulumdat::parse(sample(&[]).as_bytes()).expect("a sound file").value;
    assert_eq!((file.symmetry, file.plane_count, file.gamma_count), (Isym::Both, 4, 3));
    assert_eq!(
        (file.company.as_str(), file.report_number.as_str(), file.file_name.as_str()),
        ("Maker", "R 1", "file.ldt")
    );
    assert_eq!(file.stored, Stored::Some(vec![0, 1]));
    let luminaire = read(sample(&[]).as_bytes()).value;
    assert_eq!((luminaire.name.as_str(), luminaire.catalogue_number.as_str()), ("Name", "Number"));
    assert_eq!((luminaire.kind, luminaire.absolute, luminaire.input_power_w), (Kind::Luminous, false, Some(25.5)));
    assert_eq!((luminaire.declared_flux, luminaire.declared_output_ratio), (Some(500.0), Some(0.5)));
    assert_eq!(luminaire.declared_downward_fraction, Some(1.0));
    let rectangle = |l: f64, w: f64, h: f64| Body { shape: Shape::Rectangle, length_m: l, width_m: w, height_m: h };
    assert_eq!(
        (luminaire.housing, luminaire.opening),
        (Some(rectangle(1.2, 0.3, 0.08)), Some(rectangle(1.0, 0.2, 0.01)))
    );
    assert_eq!(
        luminaire.lamps,
        [LampSet {
            count: Some(2.0),
            name: "LED".into(),
            flux_lm: Some(1000.0),
            colour: "4000".into(),
            rendering: "80".into(),
            power_w: Some(25.5),
        }]
    );
    // cd/klm × 1000 lm / 1000; C0 150, C90 100 at 45°.
    for (c, expected) in [(0.0, 150.0), (90.0, 100.0), (180.0, 150.0), (270.0, 100.0), (45.0, 125.0)] {
        assert_eq!(luminaire.distribution.at(c, 45.0), expected);
    }
}

#[test]
fn the_conversion_factor_and_the_chosen_lamps_scale_once() {
    let text = sample(&[(24, "2.5"), (29, "3000")]);
    let got = read(text.as_bytes());
    assert_eq!(got.value.distribution.peak().0, 200.0 * 3.0 * 2.5);
    assert!(codes(&got.findings).contains(&"L213"));
    // Two sets: the lines of the second one follow those of the first.
    let two = sample(&[(26, "2"), (32, "25.5\r\n1\r\nother\r\n2000\r\n3000\r\n90\r\n40")]);
    let file = eulumdat::parse(two.as_bytes()).expect("a sound file").value;
    assert_eq!(file.luminaire(0).expect("the first").value.distribution.peak().0, 200.0);
    let second = file.luminaire(1).expect("the second");
    assert_eq!((second.value.distribution.peak().0, second.value.lamps[0].name.as_str()), (400.0, "other"));
    assert!(codes(&second.findings).contains(&"L212"));
    assert!(file.luminaire(2).is_err());
}

#[test]
fn absolute_photometry_declares_the_luminaires_flux() {
    let got = read(sample(&[(27, "-1")]).as_bytes());
    assert!(got.value.absolute);
    assert_eq!(
        (got.value.declared_flux, got.value.lamps[0].flux_lm, got.value.lamps[0].count),
        (Some(1000.0), None, Some(1.0))
    );
    // 1000 lm against some 480 lm integrated.
    assert!(got.findings.iter().any(|f| f.code == "L112" && f.severity == Severity::Warning));
}

#[test]
fn planes_of_isym_3_run_from_c270_over_c0_to_c90() {
    // Mc 4: C270, C0, C90 with 1, 2, 3 cd/klm at nadir; C180 mirrors C0.
    let text = sample(&[(3, "3"), (50, "1"), (51, "1"), (52, "1"), (53, "2"), (54, "2"), (55, "2\r\n3\r\n3\r\n3")]);
    let table = read(text.as_bytes()).value.distribution;
    assert_eq!(table.symmetry(), Symmetry::BilateralC90);
    for (c, expected) in [(270.0, 1.0), (0.0, 2.0), (180.0, 2.0), (90.0, 3.0), (45.0, 2.5), (135.0, 2.5)] {
        assert_eq!(table.at(c, 45.0), expected, "C{c}");
    }
}

#[test]
fn planes_that_are_listed_or_given_otherwise_are_told_apart_by_their_number() {
    // Isym 4 with a list of its own planes only: Mc 2, 0° and 90°.
    let half =
        sample(&[]).replace("\r\n4\r\n4\r\n90\r\n", "\r\n4\r\n2\r\n90\r\n").replace("\r\n180\r\n270\r\n", "\r\n");
    let whole = read(sample(&[]).as_bytes());
    let got = read(half.as_bytes());
    assert_eq!(got.value.distribution, whole.value.distribution);
    assert!(codes(&got.findings).contains(&"L209"));
    // Isym 4 with all four planes.
    let all = format!("{}\r\n200\r\n150\r\n0\r\n200\r\n100\r\n0\r\n", sample(&[]));
    let got = read(all.as_bytes());
    assert_eq!(got.value.distribution.symmetry(), Symmetry::None);
    assert!(codes(&got.findings).contains(&"L209"));
    let flux = whole.value.distribution.total_flux();
    assert!((got.value.distribution.total_flux() / flux - 1.0).abs() < 1e-14);
    // γ from above to below.
    let down = sample(&[(47, "90"), (49, "0"), (50, "0"), (52, "200"), (53, "0"), (55, "200")]);
    let got = read(down.as_bytes());
    assert_eq!(got.value.distribution, whole.value.distribution);
    assert!(codes(&got.findings).contains(&"L207"));
}

#[test]
fn what_could_be_wrong_is_refused_with_its_line() {
    let whole = sample(&[]);
    let cut = |lines: usize| whole.split("\r\n").take(lines).collect::<Vec<_>>().join("\r\n");
    let cases: Vec<(String, u64, &str)> = vec![
        (cut(54), 54, "found 5 numbers before the file ends; expected 6"),
        (cut(48), 48, "found 2 numbers before the file ends; expected 3"),
        (cut(30), 30, "the end of the file after 30 lines"),
        (sample(&[(3, "7")]), 3, "found 7 for Isym"),
        (sample(&[(3, "")]), 3, "expected a number for Isym"),
        (sample(&[(3, "four")]), 3, "found `four`"),
        (sample(&[(4, "4.5")]), 4, "whole number"),
        (sample(&[(4, "0")]), 4, "whole number of 1 or more"),
        (sample(&[(4, "1000000000")]), 4, "expected at most 3601"),
        (sample(&[(6, "1e9")]), 6, "expected at most 3601"),
        (sample(&[(6, "nan")]), 6, "finite"),
        (sample(&[(13, "Maker again")]), 13, "number for length"),
        (sample(&[(23, "NaN")]), 23, "finite"),
        (sample(&[(24, "0")]), 24, "above 0"),
        (sample(&[(26, "0")]), 26, "1 or more"),
        (sample(&[(26, "3")]), 55, "4 for the C-angles"),
        (sample(&[(29, "0")]), 29, "flux above 0"),
        (sample(&[(29, "-1")]), 29, "flux above 0"),
        (sample(&[(48, "0")]), 47, "ascend strictly"),
        (sample(&[(49, "200")]), 47, "0° to 180°"),
        (sample(&[(45, "90")]), 43, "different angles"),
        (sample(&[(44, "80")]), 43, "planes run from C0 to C90"),
        (sample(&[(52, "inf")]), 52, "finite"),
        (sample(&[(52, "1,5.2")]), 52, "number for the intensities"),
        (sample(&[(52, "200 150 100")]), 52, "3 numbers on one line"),
        (format!("{whole}\r\n17"), 56, "found 7 intensities"),
        (String::new(), 0, "empty"),
        ("PK\u{3}\u{4}".to_owned(), 0, "ZIP"),
    ];
    for (text, line, words) in cases {
        let error = match eulumdat::read(text.as_bytes()) {
            Err(error) => error,
            Ok(got) => panic!("{words}: read as {:?}", got.findings),
        };
        assert!(error.to_string().contains(words), "{error}: {words}");
        assert_eq!(error.location().line.unwrap_or(0), line, "{error}");
    }
}

#[test]
fn repairs_are_made_on_request_and_listed() {
    let repair = |text: &str| eulumdat::read_with(text.as_bytes(), ReadOptions { repair: true }).expect("repaired");
    let whole = read(sample(&[]).as_bytes());
    let wrapped = sample(&[]).replace("200\r\n150\r\n0\r\n200\r\n100\r\n0", "200 150 0\r\n200 100 0");
    for (text, code) in
        [(sample(&[(24, "0")]), "L230"), (format!("{}\r\n17\r\n18", sample(&[])), "L231"), (wrapped, "L232")]
    {
        assert!(eulumdat::parse(text.as_bytes()).is_err(), "{code}");
        let got = repair(&text);
        assert_eq!(got.value, whole.value, "{code}");
        assert!(codes(&got.findings).contains(&code), "{code}: {:?}", got.findings);
    }
    assert!(eulumdat::read_with(sample(&[(52, "nan")]).as_bytes(), ReadOptions { repair: true }).is_err());
    assert!(eulumdat::read_with(b"x\r\n1\r\n", ReadOptions { repair: true }).is_err());
}

/// `tests/data/lamps/invalid`: every file there is refused, with a place.
#[test]
fn the_invalid_corpus_is_refused() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/lamps/invalid");
    let mut seen = 0;
    for entry in fs::read_dir(folder).expect("the corpus") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "ldt") {
            let error = eulumdat::parse(&fs::read(&path).expect("opens")).map(|got| got.value).expect_err("refused");
            assert!(error.location().line.is_some(), "{}: {error}", path.display());
            println!("{}: {error}", path.display());
            seen += 1;
        }
    }
    assert!(seen >= 10);
}

#[test]
fn contradictions_within_a_file_are_found() {
    let has = |changes: &[(usize, &str)], code: &str| {
        let found = read(sample(changes).as_bytes()).findings;
        assert!(codes(&found).contains(&code), "{code}: {found:?}");
    };
    has(&[(7, "30")], "L208");
    has(&[(23, "90")], "L112");
    has(&[(23, "120")], "L214");
    has(&[(22, "50")], "L116");
    has(&[(35, "0.9")], "L215");
    has(&[(33, "-0.1")], "L215");
    has(&[(50, "300")], "L114");
    has(&[(51, "-20")], "L110");
    has(&[(50, "0"), (51, "0"), (53, "0"), (54, "0")], "L111");
    has(&[(16, "2000")], "L217");
    has(&[(13, "-5")], "L217");
    has(&[(27, "0")], "L218");
    has(&[(2, "1")], "L211");
    has(&[(49, "80")], "L219");
    has(&[(5, "90,0")], "L202");
    has(&[(13, "1200 mm")], "L203");
    has(&[(13, "")], "L201");
    has(&[(32, "2 x 12")], "L204");
    let trailing = format!("{}\r\n\r\nend of file", sample(&[]));
    assert!(codes(&read(trailing.as_bytes()).findings).contains(&"L206"));
    let doubled = sample(&[]).replace("\r\n", "\r\n\r\n");
    let got = read(doubled.as_bytes());
    assert!(codes(&got.findings).contains(&"L205"));
    assert_eq!(got.value, read(sample(&[]).as_bytes()).value);
}

fn table(symmetry: Symmetry, planes: Vec<f64>, gamma: Vec<f64>, f: impl Fn(f64, f64) -> f64) -> Distribution {
    let values = planes.iter().flat_map(|c| gamma.iter().map(|g| f(*c, *g)).collect::<Vec<_>>()).collect();
    Distribution::new(System::TypeC, symmetry, planes, gamma, values).expect("a sound table")
}

#[test]
fn uneven_planes_are_written_as_each_isym_asks_for() {
    let template = read(sample(&[]).as_bytes()).value;
    let gamma = vec![0.0, 20.0, 50.0, 90.0];
    let f = |c: f64, g: f64| 100.0 + g * (c.to_radians().cos() + 2.0) + 0.3 * c.to_radians().sin() * g;
    for (symmetry, planes) in [
        (Symmetry::Rotational, vec![0.0]),
        (Symmetry::Quadrant, vec![0.0, 10.0, 70.0, 90.0]),
        (Symmetry::BilateralC0, vec![0.0, 10.0, 70.0, 180.0]),
        (Symmetry::BilateralC90, vec![90.0, 100.0, 160.0, 165.0, 270.0]),
        (Symmetry::BilateralC90, vec![90.0, 270.0]),
        (Symmetry::None, vec![0.0, 10.0, 200.0, 300.0, 360.0]),
    ] {
        let mut luminaire = template.clone();
        luminaire.distribution = table(symmetry, planes.clone(), gamma.clone(), f);
        let text = eulumdat::write(&luminaire).expect("written");
        plane_set_is_valid(text.value.as_bytes(), &format!("{symmetry:?} {planes:?}"));
        let again = read(text.value.as_bytes());
        let relevant: Vec<&Finding> = again.findings.iter().filter(|f| f.code != "L216" && f.code != "L114").collect();
        assert!(relevant.is_empty(), "{relevant:?}");
        for c in (0..=360).step_by(7).map(f64::from) {
            for g in (0..=90).step_by(3).map(f64::from) {
                let (a, b) = (again.value.distribution.at(c, g), luminaire.distribution.at(c, g));
                assert!((a / b - 1.0).abs() < 1e-5, "{symmetry:?} C{c} γ{g}: {a} {b}");
            }
        }
    }
}

#[test]
fn what_the_format_cannot_carry_is_said_or_refused() {
    let mut luminaire = read(sample(&[]).as_bytes()).value;
    luminaire.keywords.push(("_COATING".into(), "x".into()));
    luminaire.name = "n".repeat(100);
    // Lamps of 100 lm cannot feed 480 lm: absolute photometry then.
    luminaire.lamps[0].flux_lm = Some(100.0);
    let text = eulumdat::write(&luminaire).expect("written");
    let said: Vec<&str> = text.findings.iter().map(|f| f.message.as_str()).collect();
    for words in ["_COATING", "78 characters", "absolute"] {
        assert!(said.iter().any(|m| m.contains(words)), "{words}: {said:?}");
    }
    let again = read(text.value.as_bytes());
    assert!(again.value.absolute && again.findings.is_empty(), "{:?}", again.findings);
    luminaire.kind = Kind::Radiant;
    assert!(eulumdat::write(&luminaire).is_err());
    luminaire.kind = Kind::Luminous;
    luminaire.distribution =
        Distribution::new(System::TypeB, Symmetry::Quadrant, vec![0.0, 90.0], vec![-90.0, 90.0], vec![1.0; 4])
            .expect("a table");
    // Types A and B become Type C: an even half space of 1 cd has 2π lm.
    let text = eulumdat::write(&luminaire).expect("written");
    assert!(text.findings.iter().any(|f| f.code == "L401"), "{:?}", text.findings);
    let again = read(text.value.as_bytes()).value.distribution;
    assert_eq!((again.system(), again.symmetry()), (System::TypeC, Symmetry::Rotational));
    assert!((again.total_flux() / (2.0 * std::f64::consts::PI) - 1.0).abs() < 1e-6);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..600)) {
        let _ = eulumdat::read(&bytes);
    }

    #[test]
    fn no_change_of_lines_makes_reader_or_writer_panic(
        changes in proptest::collection::vec((1usize..=55, prop_oneof!["[0-9.,eE+-]{0,6}", "-?[0-9]{1,4}(\\.[0-9])?", "nan|inf|1e308|-0|\\PC{0,4}"]), 0..4),
        cut in 0usize..60,
    ) {
        let changes: Vec<(usize, &str)> = changes.iter().map(|(line, text)| (*line, text.as_str())).collect();
        let text = sample(&changes);
        let kept: Vec<&str> = text.split("\r\n").take(60 - cut.min(10)).collect();
        if let Ok(got) = eulumdat::read(kept.join("\r\n").as_bytes()) {
            let flux = got.value.distribution.total_flux();
            if let Ok(written) = eulumdat::write(&got.value)
                && let Ok(again) = eulumdat::read(written.value.as_bytes())
            {
                let there = again.value.distribution.total_flux();
                prop_assert!(!(1e-3..1e12).contains(&flux.abs()) || (there / flux - 1.0).abs() < 1e-5, "{flux} {there}");
            }
        }
    }

    #[test]
    fn tables_survive_the_format(
        kind in 0usize..5,
        planes in 2usize..8,
        gammas in 2usize..12,
        values in proptest::collection::vec(0.0f64..5000.0, 96),
        flux in 10.0f64..50_000.0,
        absolute in any::<bool>(),
    ) {
        let spread = |n: usize, from: f64, to: f64| (0..n).map(|i| from + (to - from) * i as f64 / (n - 1) as f64).collect::<Vec<_>>();
        let (symmetry, horizontal) = match kind {
            0 => (Symmetry::None, spread(planes + 1, 0.0, 360.0)),
            1 => (Symmetry::Rotational, vec![0.0]),
            2 => (Symmetry::BilateralC0, spread(planes, 0.0, 180.0)),
            3 => (Symmetry::BilateralC90, spread(planes, 90.0, 270.0)),
            _ => (Symmetry::Quadrant, spread(planes, 0.0, 90.0)),
        };
        let gamma = spread(gammas, 0.0, 180.0);
        let mut values: Vec<f64> = values[..horizontal.len() * gamma.len()].to_vec();
        if symmetry == Symmetry::None {
            let last = values.len() - gamma.len();
            values.copy_within(..gamma.len(), last);
        }
        let mut luminaire = read(sample(&[]).as_bytes()).value;
        luminaire.distribution = Distribution::new(System::TypeC, symmetry, horizontal, gamma, values).expect("a table");
        luminaire.lamps[0].flux_lm = Some(flux);
        luminaire.absolute = absolute;
        let text = eulumdat::write(&luminaire).expect("written").value;
        plane_set_is_valid(text.as_bytes(), "random");
        let again = read(text.as_bytes()).value.distribution;
        prop_assert!((again.total_flux() / luminaire.distribution.total_flux() - 1.0).abs() < 1e-5);
        prop_assert!((again.peak().0 / luminaire.distribution.peak().0 - 1.0).abs() < 1e-5);
    }
}

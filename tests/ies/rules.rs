//! What the standard says, one small file per rule.

use std::fs;
use std::path::PathBuf;

use photopic::luminaire::format::ErrorKind;
use photopic::luminaire::format::ies::{self, ReadOptions, TiltTable, Version};
use photopic::luminaire::{Kind, Luminaire, System};

use super::{SMALL, SMALL_FLUX, codes, read};

fn flux(text: &str) -> f64 {
    read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{text}")).value.distribution.total_flux()
}

#[test]
fn factors_follow_the_edition() {
    for (version, factor) in
        [("IESNA91", 0.5), ("IESNA:LM-63-1995", 0.5), ("IESNA:LM-63-2002", 0.5), ("IES:LM-63-2019", 1.0)]
    {
        let text = SMALL
            .replace("IESNA:LM-63-1995", version)
            .replace("\n1 1 10", "\n.9 .5 10")
            .replace("1000 1 3", "1000 2 3");
        let expected = SMALL_FLUX * 2.0 * 0.9 * factor;
        assert!((flux(&text) / expected - 1.0).abs() < 1e-14, "{version}");
        let raw = ies::parse(text.as_bytes()).expect("a file").value;
        assert_eq!((raw.photometric_factor, raw.ballast_factor, raw.multiplier), (0.5, 0.9, 2.0));
    }
}

#[test]
fn values_are_the_same_however_they_are_written() {
    for text in [
        SMALL.replace('\n', "\r\n"),
        SMALL.replace('\n', "\r"),
        SMALL.replace("0 45 90\n0\n100 100 100", "90 45 0\n0\n100 100 100"),
        SMALL.replace("0 45 90", "0.\t45.0,9.0D1"),
        SMALL.replace("TILT=NONE", " tilt = none "),
        SMALL.replace("TILT=NONE", "TILT=INCLUDE\n1\n2\n0 90\n1 .8"),
        SMALL.replace("TILT=NONE", "TILT=lamp.tlt"),
        SMALL
            .replace("\n0\n100", "\n0 90 180 270\n100 100 100 100 100 100 100 100 100 100")
            .replace("1 3 1 1 2", "1 3 4 1 2"),
        SMALL.replace("\n0\n100", "\n270 180 90\n100 100 100 100 100 100 100").replace("1 3 1 1 2", "1 3 3 1 2"),
        SMALL.replace("100 100 100", "100 100 100\nEND OF FILE 1 2 3"),
        SMALL.replace("100 100 100", "100 100 100\n\u{1a}"),
        SMALL.replace("0.1 0.2 0\n1 1 10", "0,1 0,2 0\n1,00 1 10"),
    ] {
        assert!((flux(&text) / SMALL_FLUX - 1.0).abs() < 1e-14, "{text}");
    }
}

#[test]
fn what_leaves_a_value_in_doubt_is_refused_with_its_place() {
    for (from, to, line, message) in [
        ("TILT=NONE\n", "", 9, "TILT=NONE"),
        ("TILT=NONE", "TILT=", 5, "file name"),
        ("\n1 1 10", "", 7, "ballast"),
        ("1 1 2 0.1", "9 1 2 0.1", 11, "horizontal"),
        ("3 1 1 2 0.1", "3 1 4 2 0.1", 6, "photometric type"),
        ("3 1 1 2 0.1", "3 1 1 3 0.1", 6, "units type"),
        ("1000 1 3", "1000 0 3", 6, "candela multiplier"),
        ("1000 1 3", "-2 1 3", 6, "absolute photometry"),
        ("1 1 10", "0 1 10", 7, "ballast factor"),
        ("1 1 10", "1 0 10", 7, "photometric factor"),
        ("1 3 1 1 2", "1 4 1 1 2", 11, "found 2 numbers before the file ends; expected 4"),
        ("1 3 1 1 2", "1 1000000000 1 1 2", 6, "at most 100000"),
        ("1 3 1 1 2", "1 99999 99999 1 2", 11, "99999"),
        ("1 3 1 1 2", "1 3.5 1 1 2", 6, "whole number"),
        ("0 45 90", "0 45 45", 8, "ascend"),
        ("0 45 90", "0 45 200", 8, "180"),
        ("100 100 100", "100 nan 100", 10, "finite"),
        ("100 100 100", "100 1e400 100", 10, "finite"),
        ("100 100 100", "100 -inf 100", 10, "finite"),
        ("100 100 100", "100 12x 100", 10, "12x"),
        ("100 100 100", "100 100", 11, "candela values"),
        ("100 100 100", "100 100 100 7", 10, "more numbers"),
        ("100 100 100", "100,,100", 10, "between two commas"),
    ] {
        let text = SMALL.replacen(from, to, 1);
        assert_ne!(text, SMALL, "{from}");
        let error = read(text.as_bytes()).expect_err(&text);
        assert!(error.to_string().contains(message), "{to:?}: {error}");
        assert_eq!(error.location().line, Some(line), "{to:?}: {error}");
    }
    let two = SMALL.replace("[TEST] 1", "[TEST] candela -> mW/sr\n[_INTENSITYUNITS] W/sr");
    assert!(matches!(read(two.as_bytes()).expect_err("two units").kind(), ErrorKind::Contradiction { .. }));
    for bytes in [&b""[..], b"\n\n", b"TILT=NONE", b"\x00\x01", b"%PDF-1.4", b"IESNA:LM-63-2002\n"] {
        assert!(read(bytes).is_err());
    }
}

#[test]
fn the_corpus_of_invalid_files_is_refused() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/lamps/invalid");
    let mut count = 0;
    for entry in fs::read_dir(folder).expect("the corpus") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "ies") {
            let error = read(&fs::read(&path).expect("a file")).expect_err(&path.display().to_string());
            println!("{}: {error}", path.display());
            count += 1;
        }
    }
    assert!(count >= 10);
}

#[test]
fn repairs_happen_on_request_and_are_listed() {
    let repair = |text: &str| ies::read(text.as_bytes(), ReadOptions { repair: true });
    for (from, to, code, factor) in [
        ("100 100 100", "100 100 100 7", "L030", 1.0),
        ("1 1 10", "0 1 10", "L032", 1.0),
        ("1000 1 3", "1000 0 3", "L032", 1.0),
        ("0 45 90", "30 60 90", "L031", 1.0),
    ] {
        let text = SMALL.replacen(from, to, 1);
        let checked = repair(&text).unwrap_or_else(|e| panic!("{e}"));
        assert!(codes(&checked.findings).contains(&code), "{to}: {:?}", checked.findings);
        assert!((checked.value.distribution.total_flux() / (SMALL_FLUX * factor) - 1.0).abs() < 1e-14, "{to}");
    }
    for to in ["100 100", "100 NaN 100"] {
        assert!(repair(&SMALL.replace("100 100 100", to)).is_err(), "{to}");
    }
}

#[test]
fn findings_say_what_was_noticed() {
    for (from, to, code) in [
        ("IESNA:LM-63-1995\n", "", "L001"),
        ("1995", "2001", "L002"),
        ("IESNA:LM-63-1995", "iesna: lm-63-1995", "L003"),
        ("TILT=NONE", "Tilt=None", "L004"),
        ("TILT=NONE", "TILT=a.tlt", "L005"),
        ("TILT=NONE", "TILT=INCLUDE\n1 2\n0 90\n.9 1", "L006"),
        ("100 100 100\n", "100 100 100\nEND", "L007"),
        ("1995\n[TEST] 1", "2002\n[TEST] 1", "L008"),
        ("[TEST] 1", "[NOSUCH] 1", "L009"),
        ("[TEST] 1", "free text", "L010"),
        ("0.1 0.2 0\n1 1 10", "0,1 0,2 0\n1,00 1 10", "L012"),
        ("1000", "0", "L015"),
        ("1 1 10", "1 1 0", "L016"),
        ("0.1 0.2 0", "-0.1 -0.2 0", "L017"),
        ("0.1 0.2 0", "0 -0.2 0", "L017"),
        ("0.1 0.2 0", "100 200 0", "L018"),
        ("0 45 90\n0\n", "90 45 0\n0\n", "L020"),
        ("0 45 90", "5 45 90", "L021"),
        ("90\n0\n", "90\n30\n", "L024"),
        ("[TEST] 1", "[TEST] candela -> mW/sr", "L025"),
        ("[TEST] 1", "[_RADIATIONTYPE] UVC", "L026"),
        ("100 100 100", "-1 -100 -100", "L110"),
        ("100 100 100", "0 0 0", "L111"),
        ("[TEST] 1", "[_ABSOLUTELUMENS] 700 lm", "L112"),
        ("1000", "100", "L113"),
    ] {
        let text = SMALL.replacen(from, to, 1);
        assert_ne!(text, SMALL, "{from}");
        let findings = read(text.as_bytes()).unwrap_or_else(|e| panic!("{code} {e}")).findings;
        assert!(codes(&findings).contains(&code), "{code}: {findings:?}");
    }
    assert_eq!(read(SMALL.as_bytes()).expect("a file").findings, []);
    let planes =
        SMALL.replace("1 3 1 1 2", "1 3 3 1 2").replace("\n0\n100 100 100", "\n0 180 360\n100 1 1 90 2 2 80 3 3");
    let findings = codes(&read(planes.as_bytes()).expect("a file").findings);
    assert_eq!(findings, ["L023", "L114"]);
    let raw = ies::parse(SMALL.as_bytes()).expect("a file").value;
    assert_eq!(raw.keyword("MANUFAC"), Some("Maker\n& Sons"));
}

#[test]
fn a_tilt_table_is_kept_and_not_applied() {
    let text = SMALL.replace("TILT=NONE", "TILT=INCLUDE\n1\n3\n0 45 90\n1 .9 .8");
    let lamp = read(text.as_bytes()).expect("a file").value;
    let again = ies::write(&lamp, Version::Lm63_2019).expect("text").value;
    let raw = ies::parse(again.as_bytes()).expect("a file").value;
    let expected = TiltTable { geometry: 1, angles_deg: vec![0.0, 45.0, 90.0], factors: vec![1.0, 0.9, 0.8] };
    assert_eq!(raw.tilt, ies::Tilt::Include(expected.clone()));
    assert_eq!(TiltTable::parse(b"1\r\n3\r\n0 45 90\r\n1 .9 .8\r\n").expect("a table"), expected);
    assert!(TiltTable::parse(b"4 1 0 1").is_err() && TiltTable::parse(b"1 1000000 0 1").is_err());
}

#[test]
fn types_a_and_b_have_their_own_axes() {
    // An even lamp of 100 cd over the half space before it: 2π · 100 lm in both types, mirrored or not.
    for (system, code) in [(System::TypeA, "3"), (System::TypeB, "2")] {
        for (horizontal, count) in [("0 45 90", 3), ("-90 0 90", 3), ("-90 -45 0 45 90", 5)] {
            let values = "100 ".repeat(3 * count);
            let text = SMALL
                .replace("1 3 1 1 2", &format!("1 3 {count} {code} 2"))
                .replace("0 45 90\n0\n100 100 100", &format!("-90 0 90\n{horizontal}\n{values}"));
            let lamp = read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{text}")).value;
            assert_eq!(lamp.distribution.system(), system);
            assert!((lamp.distribution.total_flux() / SMALL_FLUX - 1.0).abs() < 1e-14, "{code} {horizontal}");
        }
    }
}

#[test]
fn photon_intensities_cannot_be_written() {
    let mut lamp = read(SMALL.as_bytes()).expect("a file").value;
    lamp.kind = Kind::Photon;
    let error = ies::write(&lamp, Version::Lm63_2019).expect_err("no words for it");
    assert!(matches!(error.kind(), ErrorKind::Unexpected { .. }));
    lamp.kind = Kind::Radiant;
    lamp.name = "Größe 5 µm\nzweite Zeile ".repeat(20);
    lamp.keywords.push(("Farbe".into(), "größer".into()));
    let checked = ies::write(&lamp, Version::Lm63_2002).expect("text");
    assert_eq!(codes(&checked.findings), ["L042", "L041", "L043"]);
    let back = read(checked.value.as_bytes()).expect("a file").value;
    assert_eq!(back.kind, Kind::Radiant);
    assert!((back.distribution.total_flux() / SMALL_FLUX - 1.0).abs() < 1e-9);
}

#[test]
fn radiant_intensities_keep_the_unit_that_their_keywords_name() {
    for (unit, watts) in [("W/sr", 1.0), ("mW/sr", 1e-3), ("uW/sr", 1e-6)] {
        let text = SMALL.replace("[TEST] 1", &format!("[TEST] candela -> {unit}"));
        let lamp = read(text.as_bytes()).expect("a file").value;
        assert!((lamp.distribution.total_flux() / (SMALL_FLUX * watts) - 1.0).abs() < 1e-14, "{unit}");
        let again = ies::write(&lamp, Version::Lm63_2002).expect("text").value;
        let back = read(again.as_bytes()).expect("a file").value;
        assert!((back.distribution.total_flux() / lamp.distribution.total_flux() - 1.0).abs() < 1e-8, "{unit}");
        // The same lamp in candela does not keep words that say otherwise.
        let luminous = Luminaire { kind: Kind::Luminous, ..lamp };
        let written = ies::write(&luminous, Version::Lm63_2002).expect("text");
        assert!(codes(&written.findings).contains(&"L040"));
        assert_eq!(read(written.value.as_bytes()).expect("a file").value.kind, Kind::Luminous);
    }
}

//! Every file of the shared folder.

use std::collections::HashMap;
use std::fs;

use photopic::luminaire::format::ies::{self, Version};
use photopic::luminaire::{Kind, Luminaire};

use super::common::{rows, shared};
use super::{codes, read};

type Row = HashMap<String, String>;

/// `reference.csv`: the rows of LM-63 files with their bytes.
fn reference() -> Option<Vec<(Row, Vec<u8>)>> {
    let shared = shared("luminaires")?;
    let rows = rows(&shared.join("reference.csv")).into_iter().filter_map(|row| {
        let name = &row["file"];
        let bytes = name.to_ascii_lowercase().ends_with(".ies").then(|| fs::read(shared.join("files").join(name)))?;
        Some((row, bytes.ok()?))
    });
    Some(rows.collect())
}

fn number(row: &Row, key: &str) -> f64 {
    row[key].parse().unwrap_or_else(|_| panic!("{} of {}: {}", key, row["file"], row[key]))
}

/// Radiometric files are in W and W/sr here, in mW and mW/sr in the reference.
fn scale(luminaire: &Luminaire) -> f64 {
    if luminaire.kind == Kind::Radiant { 1000.0 } else { 1.0 }
}

#[test]
fn every_whole_file_has_the_flux_and_peak_of_the_reference() {
    let Some(rows) = reference() else { return };
    let (mut read_in, mut refused, mut worst) = (0, 0, (0.0_f64, 0.0_f64, 0.0_f64));
    for (row, bytes) in rows {
        let name = &row["file"];
        if name.contains("dec_comma") {
            continue;
        }
        let result = read(&bytes);
        if row["ref_status"] != "ok" {
            let error = result.expect_err(name);
            assert!(error.location().line.is_some(), "{name}: {error}");
            println!("refused {name}: {error}");
            refused += 1;
            continue;
        }
        let checked = result.unwrap_or_else(|e| panic!("{name}: {e}"));
        let lamp = checked.value;
        let unit = scale(&lamp);
        let (peak, h, v) = lamp.distribution.peak();
        let exact = lamp.distribution.total_flux() * unit / number(&row, "flux_exact") - 1.0;
        let zonal = lamp.distribution.total_flux_zonal() * unit - number(&row, "flux_zonal");
        let high = peak * unit / number(&row, "peak_cd") - 1.0;
        println!(
            "read {name}: exact {exact:+.1e}, zonal {zonal:+.1e} lm, peak {high:+.1e}, {:?}",
            codes(&checked.findings)
        );
        // The reference prints eight digits.
        assert!(exact.abs() < 1e-7, "{name}: flux off by {exact:e}");
        assert!(
            zonal.abs() < 0.01_f64.min(5e-4 + 1e-7 * number(&row, "flux_zonal")),
            "{name}: zonal off by {zonal:e} lm"
        );
        assert!(high.abs() < 1e-7, "{name}: peak off by {high:e}");
        assert_eq!((h, v), (number(&row, "peak_h"), number(&row, "peak_v")), "{name}: direction of the peak");
        worst = (worst.0.max(exact.abs()), worst.1.max(zonal.abs()), worst.2.max(high.abs()));
        read_in += 1;
    }
    println!("read {read_in}, refused {refused}; worst {worst:?}");
    assert!(read_in > 80 && refused > 20, "read {read_in}, refused {refused}");
}

#[test]
fn mutants_give_their_flux_or_are_refused() {
    let Some(shared) = shared("luminaires") else { return };
    for row in rows(&shared.join("mutants.csv")).into_iter().filter(|r| r["file"].ends_with(".ies")) {
        let name = &row["file"];
        let bytes = fs::read(shared.join("files").join(name)).expect("a file");
        let result = read(&bytes);
        if row["expect"].is_empty() {
            let error = result.expect_err(name);
            assert!(error.location().line.is_some(), "{name}: {error}");
            continue;
        }
        let lamp = result.unwrap_or_else(|e| panic!("{name}: {e}")).value;
        let deviation = lamp.distribution.total_flux() * scale(&lamp) / number(&row, "expect") - 1.0;
        assert!(deviation.abs() < 1e-8, "{name}: {deviation:e}");
    }
}

#[test]
fn far_ultraviolet_lamps_are_in_watts() {
    let Some(rows) = reference() else { return };
    let rows = rows.into_iter().filter(|(row, _)| row["file"].starts_with("pypi+guv-calcs"));
    let mut count = 0;
    for (row, bytes) in rows {
        let checked = read(&bytes).expect("a file");
        assert_eq!(checked.value.kind, Kind::Radiant, "{}", row["file"]);
        let finding = checked.findings.iter().find(|f| f.code == "L025").expect("the words");
        assert!(finding.message.contains("mW/sr") && finding.location.line.is_some(), "{finding}");
        count += 1;
    }
    assert!(count >= 7);
}

#[test]
fn all_files_survive_every_edition() {
    let Some(rows) = reference() else { return };
    for (row, bytes) in rows {
        let Ok(checked) = read(&bytes) else { continue };
        for version in Version::ALL {
            let text = ies::write(&checked.value, version).unwrap_or_else(|e| panic!("{}: {e}", row["file"])).value;
            survives(&checked.value, &text, version, &row["file"]);
        }
    }
}

/// What was written is read back as the same luminaire.
fn survives(lamp: &Luminaire, text: &str, version: Version, name: &str) {
    assert!(text.is_ascii(), "{name} {version}");
    let longest = text.split("\r\n").map(str::len).max().unwrap_or(0);
    assert!(longest <= version.line_length(), "{name} {version}: a line of {longest}");
    let checked = ies::parse(text.as_bytes()).unwrap_or_else(|e| panic!("{name} {version}: {e}\n{text}"));
    assert_eq!(checked.value.version, version, "{name}");
    let findings = codes(&checked.findings);
    let allowed: &[&str] = if version == Version::Lm63_1986 { &["L001", "L021", "L005"] } else { &["L021", "L005"] };
    let input_watts = lamp.input_power_w.is_none();
    for code in findings {
        assert!(allowed.contains(&code) || (code == "L016" && input_watts), "{name} {version}: {code}\n{text}");
    }
    let back = checked.value.into_luminaire().expect("a luminaire").value;
    let ratio = back.distribution.total_flux() / lamp.distribution.total_flux() - 1.0;
    assert!(ratio.abs() < 1e-7, "{name} {version}: flux changed by {ratio:e}");
    let (a, b) = (back.distribution.peak(), lamp.distribution.peak());
    assert!((a.0 / b.0 - 1.0).abs() < 1e-7 && (a.1, a.2) == (b.1, b.2), "{name} {version}: peak {a:?}, was {b:?}");
    assert_eq!(
        (back.kind, back.absolute, back.distribution.system(), back.distribution.symmetry()),
        (lamp.kind, lamp.absolute, lamp.distribution.system(), lamp.distribution.symmetry()),
        "{name} {version}"
    );
    assert_eq!(back.input_power_w, lamp.input_power_w, "{name} {version}");
    if let (Some(a), Some(b)) = (back.opening, lamp.opening) {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
        assert!(near(a.width_m, b.width_m) && near(a.length_m, b.length_m) && near(a.height_m, b.height_m), "{name}");
    }
}

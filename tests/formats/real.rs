//! Real files of instruments and of the TM-30 library, beside the checkout; skipped, saying so, where they are absent.

use std::path::Path;

use photopic::constants::K_M;
use photopic::spectrum::format::{Entry, Format, SpectrumFile};
use photopic::spectrum::{Quantity, Spectrum};
use photopic::tables;

use super::{codes, read_default};

fn shared(name: &str) -> Option<Vec<u8>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/spectra/files").join(name);
    let bytes = std::fs::read(&path).ok();
    if bytes.is_none() {
        eprintln!("skipped: {} is not there", path.display());
    }
    bytes
}

fn valid(name: &str, format: Format, findings: &[&str]) -> Option<SpectrumFile> {
    let checked = read_default(&shared(name)?).unwrap_or_else(|e| panic!("{name}:{e}"));
    assert_eq!(checked.value.format, format, "{name}");
    assert_eq!(codes(&checked.findings), findings, "{name}");
    Some(checked.value)
}

fn figure<'a>(entry: &'a Entry, key: &str) -> (f64, &'a str) {
    let printed = entry.printed.iter().find(|p| p.key == key).unwrap_or_else(|| panic!("{key}"));
    (printed.value, &printed.text)
}

/// K_m·Σ E·V·Δλ of a 1 nm spectrum in SI: independent of the check inside of the reader.
fn illuminance(spectrum: &Spectrum) -> f64 {
    let table = tables::get("photopic").expect("embedded");
    let v = table.column("V").expect("V");
    let first = table.wavelengths_nm()[0];
    let samples = spectrum.wavelengths_nm().iter().zip(spectrum.values());
    K_M * samples.map(|(nm, e)| e * v[(nm - first) as usize]).sum::<f64>()
}

#[test]
fn uprtek() {
    let Some(file) = valid("uprtek_ESPD2021_0104_231446.xls", Format::Uprtek, &["S007"]) else { return };
    let [entry] = &file.entries[..] else { panic!("one spectrum") };
    let spectrum = &entry.spectrum;
    assert_eq!((spectrum.grid().range_nm(), spectrum.grid().step_nm()), ((380.0, 780.0), Some(1.0)));
    assert_eq!((spectrum.values()[0], spectrum.values()[76], spectrum.values()[400]), (0.030267, 18.404581, 0.411766));
    assert_eq!(figure(entry, "photopic.illuminance_lx"), (695.154907, "695.154907"));
    assert_eq!(figure(entry, "cct_k").0, 5198.0);
    assert_eq!(figure(entry, "duv").0, -0.00062);
    assert_eq!(figure(entry, "chromaticity_uv_prime.1").0, 0.481087);
    assert_eq!(figure(entry, "cri_r.8").0, 77.613075);
    assert_eq!(figure(entry, "cri_r.13").0, 97.064323);
    assert_eq!(figure(entry, "tm30_rg").0, 98.510712);
    assert_eq!(figure(entry, "xyz.2").0, 631.635071);
    assert_eq!(entry.printed.iter().find(|p| p.label == "R15").map(|p| (p.key, p.value)), Some(("", 88.615669)));
    assert!(entry.metadata.contains(&("Model Name".to_owned(), "CV600".to_owned())));
    let measured = entry.resolve(None, None).expect("stated").value;
    assert_eq!(measured.quantity, Quantity::Irradiance);
    // The unit: the instrument's own lux (single precision, its own K_m and V) and W/m² come out to 4 in a million.
    let lux = illuminance(&measured.spectrum);
    assert!((lux / 695.154907 - 1.0).abs() < 4e-6, "{lux}");
    let values = measured.spectrum.values();
    let watt: f64 = values.windows(2).map(|w| (w[0] + w[1]) / 2.0).sum();
    assert!((watt - figure(entry, "radiometric.irradiance_w_per_m2").0).abs() < 2e-6, "{watt}");
}

#[test]
fn sekonic() {
    let Some(file) = valid("sekonic_3262K.csv", Format::Sekonic, &["S016", "S007"]) else { return };
    let [entry] = &file.entries[..] else { panic!("one spectrum") };
    assert_eq!(entry.name, "RANDOM_001_02°_3262K");
    assert_eq!((entry.spectrum.grid().range_nm(), entry.spectrum.grid().step_nm()), ((380.0, 780.0), Some(1.0)));
    assert_eq!(entry.spectrum.values()[12], 0.000002927853);
    assert_eq!(entry.spectrum.values()[400], 0.000035575547);
    assert_eq!(figure(entry, "cct_k"), (3262.0, "3262"));
    assert_eq!(figure(entry, "duv").0, -0.0029);
    assert_eq!(figure(entry, "excitation_purity"), (0.415, "41.5"));
    assert_eq!(figure(entry, "photon.ppfd_umol_per_m2_s").0, 0.4);
    assert_eq!(figure(entry, "dominant_wavelength_nm").0, 583.0);
    assert_eq!(figure(entry, "cri_ra").0, 87.5);
    assert_eq!(figure(entry, "tm30_rf").0, 87.0);
    // Foot-candles are no lux.
    assert_eq!(entry.printed.iter().filter(|p| p.key == "photopic.illuminance_lx").count(), 1);
    let measured = entry.resolve(None, None).expect("stated").value;
    let lux = illuminance(&measured.spectrum);
    assert_eq!(format!("{lux:.1}"), figure(entry, "photopic.illuminance_lx").1);
}

#[test]
fn tm27() {
    let Some(file) = valid("Fluorescent.spdx", Format::Tm27, &[]) else { return };
    let [entry] = &file.entries[..] else { panic!("one spectrum") };
    assert_eq!((entry.name.as_str(), entry.quantity), ("Rare earth fluorescent lamp", Some(Quantity::Relative)));
    assert_eq!((entry.spectrum.grid().len(), entry.spectrum.grid().range_nm()), (85, (400.0, 850.1)));
    assert_eq!(entry.spectrum.peak().0, 547.2);
    if let Some(bytes) = shared("Invalid.spdx") {
        let error = read_default(&bytes).expect_err("no TM-27");
        assert_eq!((error.location().line, error.location().column), (Some(2), Some(1)), "{error}");
    }
}

#[test]
fn xrite() {
    let Some(file) = valid("X-Rite_Digital_Colour_Checker.txt", Format::Cgats, &["S007"]) else { return };
    assert_eq!(file.entries.len(), 10);
    let last = &file.entries[9];
    assert_eq!((last.name.as_str(), last.quantity), ("X10", Some(Quantity::Relative)));
    assert_eq!((last.spectrum.grid().range_nm(), last.spectrum.grid().step_nm()), ((380.0, 730.0), Some(10.0)));
    assert_eq!(last.spectrum.values()[..3], [0.9035, 0.9050, 0.9070]);
    assert_eq!(last.metadata[1], ("RGB_R".to_owned(), "27.21".to_owned()));
    assert_eq!(file.metadata[0], ("LGOROWLENGTH".to_owned(), "10".to_owned()));
}

#[test]
fn sixty_four_lamps() {
    let Some(file) = valid("real_lamps.csv", Format::Delimited, &[]) else { return };
    assert_eq!(file.entries.len(), 64);
    let grid = file.entries[0].spectrum.grid();
    assert_eq!((grid.range_nm(), grid.step_nm()), ((380.0, 780.0), Some(1.0)));
    for entry in &file.entries {
        assert!(std::sync::Arc::ptr_eq(entry.spectrum.grid(), grid), "{}", entry.name);
        assert!(entry.name.contains(" | "), "{}", entry.name);
    }
    let lamp = |name: &str| file.entries.iter().find(|e| e.name == name).unwrap_or_else(|| panic!("{name}"));
    assert_eq!(lamp("CIE F3 | Fluorescent Broadband").spectrum.values()[..2], [0.025746, 0.027002]);
    assert_eq!(lamp("F40T12/C50 (1) | Fluorescent Broadband").spectrum.values()[0], 0.027952);
    let names: std::collections::HashSet<_> = file.entries.iter().map(|e| &e.name).collect();
    assert_eq!(names.len(), 64);
}

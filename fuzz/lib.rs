//! What all targets hold a reader to: no panic, and what it reads is a spectrum that stands every further step.

use photopic::brdf::format as tables;
use photopic::brdf::table::Known;
use photopic::geometry::direction::from_degrees;
use photopic::luminaire::format as lamps;
use photopic::report::lamp as figures;
use photopic::spectrum::format::{Format, ReadOptions, read};

/// Reads as one format and resolves whatever comes out.
pub fn format(bytes: &[u8], format: Format) {
    with(bytes, &ReadOptions { format: Some(format), ..ReadOptions::default() });
}

/// Reads as the content tells.
pub fn detected(bytes: &[u8]) {
    with(bytes, &ReadOptions::default());
}

fn with(bytes: &[u8], options: &ReadOptions) {
    match read(bytes, options) {
        Ok(file) => {
            assert!(!file.value.entries.is_empty());
            for entry in &file.value.entries {
                assert!(entry.spectrum.values().iter().all(|v| v.is_finite()));
                let _ = entry.resolve(None, None);
            }
        }
        Err(error) => assert!(error.location().line.is_some() && error.to_string().contains("; expected "), "{error}"),
    }
}

/// Reads a lamp as one format, or as the content tells, as it stands and repaired: whatever comes out has finite intensities, says
/// so where it does not shine, and all its figures can be made.
pub fn lamp(bytes: &[u8], format: Option<lamps::Format>) {
    for repair in [false, true] {
        match lamps::open(bytes, &lamps::ReadOptions { format, repair }) {
            Ok(file) => {
                let table = &file.value.luminaire.distribution;
                assert!(table.values().iter().all(|v| v.is_finite()));
                let dark = table.total_flux() <= 0.0;
                assert!(!dark || file.findings.iter().any(|f| matches!(f.code, "L110" | "L111")), "silently dark");
                let object = figures::info(&file.value);
                let _ = (figures::info_text("-", &object), figures::ugr(&file.value), figures::cu(&file.value));
            }
            Err(error) => assert!(error.to_string().contains("expected"), "{error}"),
        }
    }
}

/// Reads a BRDF table as one format, or as the content tells: every place of whatever comes out is a finite value, or missing.
pub fn brdf(bytes: &[u8], format: Option<tables::Format>) {
    match tables::open(bytes, format) {
        Ok(file) => {
            let table = &file.value.table;
            let mut values = vec![0.0; table.channels().len()];
            for (theta_i, theta_o, phi_o) in [(0.0, 0.0, 0.0), (30.0, 30.0, 180.0), (80.0, 10.0, 77.0), (45.0, 89.0, 300.0)] {
                let known = table.value(from_degrees(theta_i, 20.0), from_degrees(theta_o, phi_o), &mut values);
                assert!(values.iter().all(|v| !v.is_nan()) || known == Known::Missing);
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

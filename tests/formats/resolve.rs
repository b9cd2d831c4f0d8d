//! From an entry to SI per nm, with and without the user's word.

use std::sync::Arc;

use photopic::spectrum::format::{Entry, ErrorKind, Measured};
use photopic::spectrum::{Quantity, Sampling, SpectralUnit};

use super::{bytes, codes, read_default};

fn entry(text: &str) -> Entry {
    read_default(text.as_bytes()).unwrap_or_else(|e| panic!("{text}: {e}")).value.entries.remove(0)
}

fn table(heading: &str) -> Entry {
    entry(&format!("wavelength_nm,{heading}\n500,1\n510,2\n"))
}

fn unit(text: &str) -> SpectralUnit {
    text.parse().unwrap_or_else(|e| panic!("{e}"))
}

fn resolve(entry: &Entry, quantity: Option<Quantity>, unit: Option<&str>) -> (Measured, Vec<&'static str>) {
    let unit = unit.map(self::unit);
    let checked = entry.resolve(quantity, unit.as_ref()).unwrap_or_else(|e| panic!("{}: {e}", entry.name));
    let codes = codes(&checked.findings);
    (checked.value, codes)
}

#[test]
fn the_file_states_its_unit() {
    let entry = table("E [mW/m2/nm]");
    let (measured, codes) = resolve(&entry, None, None);
    assert_eq!(
        (measured.quantity, measured.spectrum.values(), &codes[..]),
        (Quantity::Irradiance, &[1e-3, 2e-3][..], &[][..])
    );
    assert_eq!(measured.spectrum.sampling(), Sampling::Density);
    assert!(Arc::ptr_eq(measured.spectrum.grid(), entry.spectrum.grid()));
    // Exitance has the same dimensions.
    let (measured, codes) = resolve(&entry, Some(Quantity::Exitance), None);
    assert_eq!((measured.quantity, &codes[..]), (Quantity::Exitance, &[][..]));
    let error = entry.resolve(Some(Quantity::Radiance), None).expect_err("another dimension");
    assert!(matches!(error.kind(), ErrorKind::UnitMismatch { .. }), "{error}");
    assert!(error.hint().is_some_and(|h| h.contains("--unit")));
    let (measured, codes) = resolve(&entry, Some(Quantity::Radiance), Some("W/m2/sr/nm"));
    assert_eq!(
        (measured.quantity, measured.spectrum.values(), &codes[..]),
        (Quantity::Radiance, &[1.0, 2.0][..], &["S013"][..])
    );
    let (measured, codes) = resolve(&entry, Some(Quantity::Relative), None);
    assert_eq!(
        (measured.quantity, measured.spectrum.values(), &codes[..]),
        (Quantity::Relative, &[1.0, 2.0][..], &[][..])
    );
}

#[test]
fn the_file_is_silent() {
    let entry = table("a");
    let (measured, codes) = resolve(&entry, None, None);
    assert_eq!((measured.quantity, &codes[..]), (Quantity::Relative, &["S010"][..]));
    let (measured, codes) = resolve(&entry, None, Some("uW/cm2/nm"));
    assert_eq!((measured.quantity, &codes[..]), (Quantity::Irradiance, &[][..]));
    assert!((measured.spectrum.values()[1] - 0.02).abs() < 1e-17);
    let (measured, codes) = resolve(&entry, Some(Quantity::Radiance), None);
    assert_eq!(
        (measured.quantity, measured.spectrum.values(), &codes[..]),
        (Quantity::Radiance, &[1.0, 2.0][..], &["S014"][..])
    );
    let radiance = unit("W/m2/sr/nm");
    assert!(entry.resolve(Some(Quantity::Flux), Some(&radiance)).is_err());
}

#[test]
fn the_file_states_a_quantity_alone_or_against_its_unit() {
    let (measured, codes) = resolve(&table("irradiance"), None, None);
    assert_eq!((measured.quantity, &codes[..]), (Quantity::Relative, &["S010"][..]));
    let (measured, codes) = resolve(&table("irradiance"), None, Some("W/m2/nm"));
    assert_eq!((measured.quantity, &codes[..]), (Quantity::Irradiance, &[][..]));
    let (measured, codes) = resolve(&table("exitance"), None, Some("W/m2/nm"));
    assert_eq!((measured.quantity, &codes[..]), (Quantity::Exitance, &[][..]));
    let (measured, codes) = resolve(&table("radiance"), None, Some("W/m2/nm"));
    assert_eq!((measured.quantity, &codes[..]), (Quantity::Irradiance, &["S013"][..]));
    let contradiction = table("radiance [W/m2/nm]");
    assert!(contradiction.resolve(None, None).is_err());
    let (measured, codes) = resolve(&contradiction, Some(Quantity::Irradiance), None);
    assert_eq!((measured.quantity, &codes[..]), (Quantity::Irradiance, &["S013"][..]));
    let (measured, codes) = resolve(&table("SPD [a.u.]"), None, Some("W/nm"));
    assert_eq!((measured.quantity, &codes[..]), (Quantity::Flux, &["S013"][..]));
}

#[test]
fn bands_lines_and_photons() {
    let (measured, codes) = resolve(&table("E [W/m2]"), None, None);
    assert_eq!((measured.spectrum.sampling(), &codes[..]), (Sampling::Lines, &["S011"][..]));
    let (measured, codes) = resolve(&table("E [W/m2/line]"), None, None);
    assert_eq!((measured.spectrum.sampling(), &codes[..]), (Sampling::Lines, &[][..]));
    let (measured, codes) = resolve(&entry("wavelength_nm,E [W/m2/nm]\n555,1\n"), None, None);
    assert_eq!((measured.spectrum.sampling(), &codes[..]), (Sampling::Lines, &["S012"][..]));
    // N_A·h·c of the exact SI constants, multiplied out by hand, over 500 nm: joules in a micromole.
    let (measured, _) = resolve(&table("E [umol/m2/s/nm]"), None, None);
    assert!((measured.spectrum.values()[0] / 0.239_253_131_277_394 - 1.0).abs() < 1e-13);
}

#[test]
fn beyond_the_range_of_a_double() {
    let entry = entry("wavelength_nm,E [W/cm2/nm]\n500,1e308\n510,1\n");
    assert!(matches!(entry.resolve(None, None).expect_err("1e312").kind(), ErrorKind::Spectrum(_)));
}

#[test]
fn every_valid_file_resolves() {
    for file in super::names("valid") {
        for entry in read_default(&bytes("valid", &file)).expect("valid").value.entries {
            entry.resolve(None, None).unwrap_or_else(|e| panic!("{file}: {e}"));
        }
    }
}

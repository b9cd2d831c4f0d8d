//! Duplicate, unsorted, NaN and infinite: refused, with line and column in a file and with the sample in memory.

use photopic::spectrum::format::{self, ErrorKind, ReadOptions};
use photopic::spectrum::{Error, Grid, Spectrum};

/// The place and the kind of the fault in a text.
fn fault(text: &str) -> (Option<u64>, Option<u64>, ErrorKind) {
    let error = format::read(text.as_bytes(), &ReadOptions::default()).expect_err(text);
    (error.location().line, error.location().column, error.kind().clone())
}

#[test]
fn in_a_file_the_place_is_that_of_the_offending_cell() {
    for (text, line, column) in [
        ("wavelength,value\n400,1\n410,2\n410,3\n", 4, 1),
        ("wavelength,value\n400,1\n420,2\n410,3\n430,1\n", 4, 1),
        ("wavelength,value\n430,1\n420,2\n425,3\n410,1\n", 4, 1),
        ("wavelength,value\n400,1\n420,NaN\n430,3\n", 3, 5),
        ("wavelength,value\n400,1\n420,2\n430,inf\n", 4, 5),
        ("wavelength,value\n400,1\n420,2\n430,-Infinity\n", 4, 5),
        ("wavelength,value\n400,1\n420,1e999\n430,1\n", 3, 5),
        ("wavelength,value\n400,1\nNaN,2\n430,1\n", 3, 1),
        ("wavelength,a,b\n400,1,2\n420,1,nan\n430,1,2\n", 3, 7),
        ("# a comment\n\nwavelength,value\n400,1\n 420 , nan\n430,1\n", 5, 8),
        ("wavelength\tvalue\n400\t1\n420\tNaN\n430\t1\n", 3, 5),
        ("Wellenlänge;Wert\n400,0;1,5\n420,0;NaN\n430,0;1,5\n", 3, 7),
    ] {
        let (at_line, at_column, kind) = fault(text);
        assert_eq!((at_line, at_column), (Some(line), Some(column)), "{text:?}: {kind}");
    }
}

#[test]
fn in_a_file_the_kind_says_what_is_wrong() {
    let kind = |text: &str| fault(text).2;
    assert!(matches!(
        kind("w,v\n400,1\n410,2\n410,3\n"),
        ErrorKind::DuplicateWavelength { wavelength: 410.0, first_line: 3 }
    ));
    assert!(matches!(kind("w,v\n400,1\n420,2\n410,3\n"), ErrorKind::Unsorted { found: 410.0, previous: 420.0 }));
    assert!(matches!(kind("w,v\n400,1\n420,NaN\n430,3\n"), ErrorKind::NotFinite { .. }));
    assert!(matches!(kind("w,v\n400,1\n420,inf\n430,3\n"), ErrorKind::NotFinite { .. }));
    // A descending file may turn round as little as an ascending one, and a duplicate far away is one, too.
    assert!(matches!(kind("w,v\n430,1\n420,2\n425,3\n"), ErrorKind::Unsorted { found: 425.0, previous: 420.0 }));
    let far = fault("w,v\n400,1\n410,2\n420,3\n400,4\n");
    assert_eq!(far.0, Some(5), "{}", far.2);
}

#[test]
fn in_memory_the_sample_is_named() {
    let grid = |w: &[f64]| Grid::new(w.to_vec());
    assert_eq!(grid(&[]), Err(Error::Empty));
    assert_eq!(grid(&[400.0, 400.0]), Err(Error::Order { index: 1, found: 400.0, previous: 400.0 }));
    assert_eq!(grid(&[400.0, 410.0, 405.0]), Err(Error::Order { index: 2, found: 405.0, previous: 410.0 }));
    assert!(matches!(grid(&[400.0, f64::NAN]), Err(Error::Wavelength { index: 1, .. })));
    assert!(matches!(grid(&[400.0, f64::INFINITY]), Err(Error::Wavelength { index: 1, .. })));
    assert!(matches!(grid(&[-1.0, 400.0]), Err(Error::Wavelength { index: 0, .. })));
    assert!(matches!(grid(&[0.0, 400.0]), Err(Error::Wavelength { index: 0, .. })));
    let values = |v: &[f64]| Spectrum::density(grid(&[400.0, 410.0]).expect("ascending"), v.to_vec());
    assert!(matches!(values(&[1.0, f64::NAN]), Err(Error::Value { wavelength_nm: 410.0, .. })));
    assert!(matches!(values(&[f64::NEG_INFINITY, 1.0]), Err(Error::Value { wavelength_nm: 400.0, .. })));
    assert_eq!(values(&[1.0]), Err(Error::Length { wavelengths: 2, values: 1 }));
}

#[test]
fn a_value_that_only_its_unit_makes_infinite_is_refused_and_not_passed_on() {
    let text = "wavelength [nm],irradiance [W/cm2/nm]\n400,1e308\n410,1\n420,1\n";
    let file = format::read(text.as_bytes(), &ReadOptions::default()).expect("finite as it stands").value;
    let error = file.entries[0].resolve(None, None).expect_err("1e312 W/m² is no double");
    assert!(error.to_string().contains("400 nm"), "{error}");
}

//! What must be refused, with its place, and before anything large is allocated.

use photopic::brdf::format::{Error, ErrorKind, Format, open};
use proptest::prelude::*;

use super::rgl::file as rgl_file;

fn refused(bytes: &[u8], format: Option<Format>) -> Error {
    open(bytes, format).expect_err("no table")
}

/// Files of `tests/data/brdf/invalid` with the text of their error.
const FILES: [(&str, &str); 9] = [
    ("alta_few_numbers.alta", "3:1: found 3 numbers; expected 1 coordinates and 3 values"),
    ("alta_huge_binary.alta", "7:1: found 0 bytes; expected 32000000000 for 1000000000 points after the header"),
    ("alta_parameters.alta", "2:11: found the parameterisation `STEREOGRAPHIC`"),
    ("astm_word.txt", "2:7: found `much`; expected a finite number for an angle or a value"),
    ("csv_missing.csv", "4:1: found 1 values for these directions; expected one for each of the 2 channels"),
    ("csv_nan.csv", "2:13: found `NaN`; expected a finite number for the value"),
    ("klems_short.xml", "found 3 numbers in <ScatteringData>; expected 2 × 2"),
    ("zemax_cut_off.bsdf", "10:6: found the end; expected a value"),
    ("zemax_huge.bsdf", "1:18: found 1000000000 for AngleOfIncidence; expected 1 to 100000"),
];

#[test]
fn files_are_refused_where_they_are_wrong() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/brdf/invalid");
    for (name, expected) in FILES {
        let bytes = std::fs::read(folder.join(name)).expect("the file of the corpus");
        let error = refused(&bytes, None).to_string();
        assert!(error.contains(expected), "{name}: {error}");
    }
    let there = std::fs::read_dir(folder).expect("the corpus").count();
    assert_eq!(there, FILES.len(), "a file without its error");
}

#[test]
fn claims_beyond_the_file_fail_before_they_are_allocated() {
    let mut merl: Vec<u8> = [1000_u32, 1000, 1000].iter().flat_map(|n| n.to_le_bytes()).collect();
    merl.extend_from_slice(&[0; 64]);
    let error = refused(&merl, Some(Format::Merl));
    assert!(matches!(error.kind(), ErrorKind::Length { found: 76, expected: 24_000_000_012, .. }), "{error}");
    let most: Vec<u8> = [u32::MAX >> 1; 3].iter().flat_map(|n| n.to_le_bytes()).collect();
    assert!(matches!(refused(&most, Some(Format::Merl)).kind(), ErrorKind::Length { .. }));
    // A tensor file whose `ndf` claims 2⁴⁰ rows: its first size stands after the name, dimensions, type and offset.
    let mut rgl = rgl_file(4);
    let at = rgl.windows(3).position(|w| w == b"ndf").expect("a field") + 3 + 2 + 1 + 8;
    rgl[at..at + 8].copy_from_slice(&(1_u64 << 40).to_le_bytes());
    assert!(matches!(refused(&rgl, None).kind(), ErrorKind::Length { .. }));
    rgl[at..at + 8].copy_from_slice(&u64::MAX.to_le_bytes());
    assert!(matches!(refused(&rgl, None).kind(), ErrorKind::Length { .. }));
}

#[test]
fn what_is_no_table_is_named() {
    assert!(matches!(refused(b"", None).kind(), ErrorKind::Empty));
    assert!(matches!(refused(b" \n ", None).kind(), ErrorKind::Empty));
    assert!(refused(b"PK\x03\x04 and more", None).to_string().contains("a ZIP archive"));
    assert!(refused(b"Dear Sir", None).to_string().contains("text that begins with `Dear Sir`"));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_answered(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        for format in Format::ALL {
            let _ = open(&bytes, Some(format));
        }
    }

    #[test]
    fn a_changed_tensor_file_is_answered(at in 0_usize..500, byte in any::<u8>(), cut in 0_usize..3000) {
        let mut bytes = rgl_file(4);
        let at = at % bytes.len();
        bytes[at] = byte;
        bytes.truncate(bytes.len().saturating_sub(cut % bytes.len() / 2));
        let _ = open(&bytes, Some(Format::Rgl));
    }
}

//! NPY arrays by the published description of the format, and back.

use std::io::Cursor;

use photopic::image::format::envi::Options;
use photopic::image::format::npy;
use photopic::image::{Channel, Content, Description, Meaning, Memory, Region, Source};

/// A file as NumPy writes it (NEP 1): magic, version, length of the header, a dictionary padded with blanks to 64 bytes.
fn file(descr: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let mut text = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}");
    while (10 + text.len() + 1) % 64 != 0 {
        text.push(' ');
    }
    text.push('\n');
    let mut out = b"\x93NUMPY\x01\x00".to_vec();
    out.extend(u16::try_from(text.len()).expect("short").to_le_bytes());
    out.extend(text.as_bytes());
    out.extend(data);
    out
}

fn open(bytes: Vec<u8>, wavelengths: Vec<f64>) -> Result<Memory, String> {
    let mut opened = npy::open(Cursor::new(bytes), wavelengths, Options::default()).map_err(|e| e.to_string())?;
    Memory::load(&mut opened.value).map_err(|e| e.to_string())
}

#[test]
fn arrays_are_rows_columns_channels() {
    // arange(12) as big-endian 16-bit integers in the shape (2, 3, 2).
    let data: Vec<u8> = (0_u16..12).flat_map(u16::to_be_bytes).collect();
    let image = open(file(">u2", "False", "(2, 3, 2)", &data), vec![500.0, 600.0]).expect("valid");
    assert_eq!((image.description().width, image.description().height), (3, 2));
    assert!(matches!(image.description().content, Content::Light { quantity: None, unit: None }));
    for (y, x, c) in [(0, 0, 0), (0, 0, 1), (0, 2, 0), (1, 0, 0), (1, 2, 1)] {
        assert_eq!(image.at(x, y, c), (y * 6 + x * 2 + c) as f32);
    }
    let flat: Vec<u8> = [1.5_f64, -2.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let image = open(file("<f8", "False", "(1, 2)", &flat), Vec::new()).expect("valid");
    assert_eq!(image.samples(), [1.5, -2.0]);
}

/// The bits of numbers in IEEE 754 binary16: 1, −2, the largest (65504), the smallest normal (2⁻¹⁴) and denormal (2⁻²⁴), ∞.
#[test]
fn halves_are_read() {
    let bits = [0x3c00_u16, 0xc000, 0x7bff, 0x0400, 0x0001, 0x7c00];
    let numbers = [1.0, -2.0, 65504.0, 2.0_f32.powi(-14), 2.0_f32.powi(-24), f32::INFINITY];
    let little: Vec<u8> = bits.iter().flat_map(|v| v.to_le_bytes()).collect();
    let image = open(file("<f2", "False", "(2, 3)", &little), Vec::new()).expect("valid");
    assert_eq!(image.samples(), numbers);
    let big: Vec<u8> = bits.iter().flat_map(|v| v.to_be_bytes()).collect();
    let image = open(file(">f2", "True", "(3, 2)", &big), Vec::new()).expect("valid");
    assert_eq!(image.samples(), [0, 3, 1, 4, 2, 5].map(|i: usize| numbers[i]));
}

#[test]
fn arrays_in_fortran_order_have_the_same_indices() {
    // The first index runs fastest: numbers 0 to 23 in the shape (3, 4, 2) are y + 3 (x + 4 c) at [y, x, c].
    let data: Vec<u8> = (0_u16..24).flat_map(u16::to_le_bytes).collect();
    let bytes = file("<u2", "True", "(3, 4, 2)", &data);
    let image = open(bytes.clone(), vec![500.0, 600.0]).expect("valid");
    assert_eq!((image.description().width, image.description().height), (4, 3));
    for (y, x, c) in [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (2, 3, 1), (1, 2, 1)] {
        assert_eq!(image.at(x, y, c), (y + 3 * (x + 4 * c)) as f32, "{y} {x} {c}");
    }
    // A part of it, channels the other way round.
    let mut source = npy::open(Cursor::new(bytes), Vec::new(), Options::default()).expect("valid").value;
    let mut out = [f32::NAN; 8];
    source.read(Region { x: 1, y: 1, width: 2, height: 2 }, &[1, 0], &mut out).expect("memory");
    assert_eq!(out, [16.0, 19.0, 4.0, 7.0, 17.0, 20.0, 5.0, 8.0]);
    // One channel, as `numpy.asfortranarray` of two dimensions or a transposed array is saved.
    let data: Vec<u8> = (0_u8..6).collect();
    assert_eq!(
        open(file("|u1", "True", "(2, 3)", &data), Vec::new()).expect("valid").samples(),
        [0.0, 2.0, 4.0, 1.0, 3.0, 5.0]
    );
}

#[test]
fn what_is_written_is_read_again() {
    let channels = (0..3).map(|k| Channel::new(["X", "Y", "Z"][usize::from(k)], "", Meaning::Tristimulus(k))).collect();
    let image = Memory::new(Description::planes(2, 2, channels), (0_u8..12).map(f32::from).collect());
    let mut out = Cursor::new(Vec::new());
    npy::write(&mut out, &mut image.clone()).expect("writes");
    let bytes = out.into_inner();
    assert_eq!((bytes.len() - 48) % 64, 0, "the numbers begin at a multiple of 64");
    assert_eq!(open(bytes, Vec::new()).expect("valid").samples(), image.samples());
}

#[test]
fn other_arrays_are_refused_with_a_word() {
    let bytes = [0_u8; 96];
    for (file, want) in [
        (file("<c8", "False", "(2, 3, 2)", &bytes), "found `<c8` for `descr`; expected one of"),
        (file("<f4", "maybe", "(2, 3, 2)", &bytes), "found maybe for `fortran_order`; expected True or False"),
        (file("<f4", "False", "(2,)", &bytes), "found (2,) for `shape`; expected (rows, columns, channels)"),
        (file("<f4", "False", "(2, 0, 2)", &bytes), "found (2, 0, 2) for `shape`"),
        (file("<f4", "False", "(2, 3, 5)", &bytes), "found 3 values for the wavelengths; expected 5"),
        (file("<f4", "False", "(20, 30, 3)", &bytes), "found 224 bytes; expected 7328"),
        (b"\x93NUMPY\x01\x00\xff\xff{".to_vec(), "found the end of the file in its header; expected a whole NPY file"),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(), "found 4294967295 for the length of the header"),
        (b"P6 2 2 255 ....".to_vec(), "found other first bytes; expected an NPY file"),
    ] {
        let error = open(file, vec![400.0, 500.0, 600.0]).expect_err(want);
        assert!(error.starts_with(want), "{error}\n{want}");
    }
}

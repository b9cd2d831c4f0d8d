//! ENVI images: every type, order and interleave, headers in all shapes, damaged ones.
//!
//! The bytes are made here from the published description of the format, not by the library's writer.

use std::fs;
use std::io::Cursor;

use photopic::image::format::envi::{self, ByteOrder, DataType, Interleave, Options, WriteOptions};
use photopic::image::{Content, ErrorKind, Meaning, Memory, Region, Source};
use photopic::spectrum::Quantity;

const WIDTH: usize = 70;
const HEIGHT: usize = 4;
const BANDS: usize = 3;

/// The stored number of a sample: 0 to 220, so that every type holds it.
fn number(x: usize, y: usize, band: usize) -> u8 {
    u8::try_from((x * 3 + y * 5 + band * 7) % 221).expect("below 221")
}

fn bytes(kind: DataType, order: ByteOrder, value: u8) -> Vec<u8> {
    let mut bytes = match kind {
        DataType::U8 => vec![value],
        DataType::I16 => i16::from(value).to_le_bytes().to_vec(),
        DataType::I32 => i32::from(value).to_le_bytes().to_vec(),
        DataType::F32 => f32::from(value).to_le_bytes().to_vec(),
        DataType::F64 => f64::from(value).to_le_bytes().to_vec(),
        DataType::U16 => u16::from(value).to_le_bytes().to_vec(),
        DataType::U32 => u32::from(value).to_le_bytes().to_vec(),
        DataType::I64 => i64::from(value).to_le_bytes().to_vec(),
        DataType::U64 => u64::from(value).to_le_bytes().to_vec(),
    };
    if order == ByteOrder::Big {
        bytes.reverse();
    }
    bytes
}

fn data(kind: DataType, order: ByteOrder, interleave: Interleave) -> Vec<u8> {
    let mut out = vec![0xaa; 5];
    let mut push = |x, y, b| out.extend(bytes(kind, order, number(x, y, b)));
    match interleave {
        Interleave::Bsq => {
            (0..BANDS).for_each(|b| (0..HEIGHT).for_each(|y| (0..WIDTH).for_each(|x| push(x, y, b))));
        }
        Interleave::Bil => {
            (0..HEIGHT).for_each(|y| (0..BANDS).for_each(|b| (0..WIDTH).for_each(|x| push(x, y, b))));
        }
        Interleave::Bip => {
            (0..HEIGHT).for_each(|y| (0..WIDTH).for_each(|x| (0..BANDS).for_each(|b| push(x, y, b))));
        }
    }
    out
}

fn header(kind: DataType, order: ByteOrder, interleave: Interleave, more: &str) -> String {
    format!(
        "ENVI\nsamples = {WIDTH}\nlines = {HEIGHT}\nbands = {BANDS}\nheader offset = 5\ndata type = {}\n\
         interleave = {}\nbyte order = {}\nwavelength units = Nanometers\nwavelength = {{ 450, 550, 650 }}\n{more}",
        kind.code(),
        interleave.word(),
        u8::from(order == ByteOrder::Big),
    )
}

fn all() -> impl Iterator<Item = (DataType, ByteOrder, Interleave)> {
    DataType::ALL.into_iter().flat_map(|kind| {
        [ByteOrder::Little, ByteOrder::Big].into_iter().flat_map(move |order| {
            [Interleave::Bsq, Interleave::Bil, Interleave::Bip].into_iter().map(move |i| (kind, order, i))
        })
    })
}

#[test]
fn every_type_order_and_interleave_is_read_and_written() {
    for (kind, order, interleave) in all() {
        let data = data(kind, order, interleave);
        let header = header(kind, order, interleave, "");
        let mut source =
            envi::open(header.as_bytes(), Cursor::new(&data), Options::default()).expect("a valid file").value;
        let image = Memory::load(&mut source).expect("reads");
        for y in 0..HEIGHT {
            for x in 0..WIDTH {
                for b in 0..BANDS {
                    let what = format!("{kind} {order:?} {interleave:?} at ({x}, {y}) of {b}");
                    assert_eq!(image.at(x, y, b), f32::from(number(x, y, b)), "{what}");
                }
            }
        }
        // A region that begins and ends inside, with bands out of order.
        let region = Region { x: 3, y: 1, width: 66, height: 2 };
        let mut out = vec![0.0; region.pixels() * 2];
        source.read(region, &[2, 0], &mut out).expect("reads");
        for (i, value) in out.into_iter().enumerate() {
            let (x, k, y) = (i % 66 + 3, i / 66 % 2, i / 132 + 1);
            assert_eq!(value, f32::from(number(x, y, [2, 0][k])), "{kind} {order:?} {interleave:?}");
        }
        // What is written is the same bytes again.
        let (mut text, mut written) = (Vec::new(), Cursor::new(Vec::new()));
        let options = WriteOptions { interleave, data_type: kind, byte_order: order };
        envi::write(&mut text, &mut written, &mut source, options).expect("writes");
        assert!(written.into_inner() == data[5..], "{kind} {order:?} {interleave:?}");
        let again = envi::parse_header(&text).expect("our own header").value;
        assert_eq!((again.data_type, again.byte_order, again.interleave), (kind, order, interleave));
        assert_eq!(again.wavelengths, [450.0, 550.0, 650.0]);
    }
}

#[test]
fn scales_ignored_values_bad_bands_and_units() {
    let (kind, order, interleave) = (DataType::U16, ByteOrder::Big, Interleave::Bip);
    let more = "reflectance scale factor = 200\ndata ignore value = 7\nbbl = { 1, 0, 1 }\nfwhm = {10, 11, 12}\n";
    let text = header(kind, order, interleave, more);
    let data = data(kind, order, interleave);
    let opened = envi::open(text.as_bytes(), Cursor::new(&data), Options::default()).expect("a valid file");
    assert!(opened.findings.iter().any(|f| f.code == "I009"), "{:?}", opened.findings);
    let mut source = opened.value;
    assert_eq!(source.description().content, Content::Reflectance);
    assert_eq!(source.description().bands(), [(0, 450.0), (2, 650.0)]);
    let meaning = Meaning::Band { wavelength_nm: 550.0, fwhm_nm: Some(11.0), good: false };
    assert_eq!(source.description().channels[1].meaning, meaning);
    let image = Memory::load(&mut source).expect("reads");
    // number(0, 0, 1) = 7, the value to ignore; number(1, 0, 0) = 3; 3/200 to the nearest float.
    assert!(image.at(0, 0, 1).is_nan());
    assert_eq!(image.at(1, 0, 0), (3.0_f64 / 200.0) as f32);
    assert!(source.findings().iter().any(|f| f.code == "I008"), "{:?}", source.findings());

    let more = "data gain values = {2, 3, 4}\ndata offset values = {-1, 0, 0.5}\ndata units = uW/cm2/sr/nm\n";
    let text = header(kind, order, interleave, more).replace("450, 550, 650", "0.45, 0.55, 0.65");
    let text = text.replace("Nanometers", "Micrometers");
    let mut source = envi::open(text.as_bytes(), Cursor::new(&data), Options::default()).expect("a valid file").value;
    let image = Memory::load(&mut source).expect("reads");
    assert_eq!(image.at(1, 0, 2), 17.0 * 4.0 + 0.5);
    assert_eq!(image.at(1, 0, 0), 3.0 * 2.0 - 1.0);
    let Content::Light { quantity: Some(Quantity::Radiance), unit: Some(unit) } = &image.description().content else {
        panic!("{:?}", image.description().content)
    };
    // 1 µW/cm² is 1e-2 W/m².
    assert!((unit.factor - 1e-2).abs() < 1e-17);
    assert!((image.description().bands()[0].1 - 450.0).abs() < 1e-10);
}

#[test]
fn a_file_cut_off_is_refused_before_work_begins() {
    for (kind, order, interleave) in all() {
        let mut data = data(kind, order, interleave);
        data.pop();
        let (found, expected) = (data.len() as u64, data.len() as u64 + 1);
        let text = header(kind, order, interleave, "");
        let error = envi::open(text.as_bytes(), Cursor::new(data), Options::default()).err().expect("cut off");
        assert_eq!(*error.kind(), ErrorKind::CutOff { found, expected });
    }
}

#[test]
fn doubles_beyond_a_float_are_told() {
    let text = "ENVI\nsamples = 1\nlines = 1\nbands = 1\ndata type = 5\nbyte order = 0\n";
    let mut source =
        envi::open(text.as_bytes(), Cursor::new(1e300_f64.to_le_bytes()), Options::default()).expect("valid").value;
    Memory::load(&mut source).expect("reads");
    assert_eq!(source.findings()[0].code, "I022");
}

#[test]
fn malformed_headers_give_the_line_what_was_found_and_what_was_expected() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/images/invalid");
    let mut names: Vec<_> = fs::read_dir(folder).expect("the folder").map(|e| e.expect("an entry").path()).collect();
    names.retain(|p| p.extension().is_some_and(|e| e == "hdr"));
    names.sort();
    assert!(names.len() > 15, "{names:?}");
    for path in names {
        let bytes = fs::read(&path).expect("readable");
        // The first comment says how the message begins, from the line on.
        let text = String::from_utf8_lossy(&bytes);
        let want = text.lines().find_map(|l| l.strip_prefix("; ")).expect("a comment with the message");
        let error = match envi::open(&bytes, Cursor::new([0_u8; 24]), Options::default()) {
            Ok(_) => panic!("{}: was read", path.display()),
            Err(error) => error,
        };
        let message = error.to_string();
        assert!(message.starts_with(want), "{}:\n  {message}\n  {want}", path.display());
        assert!(message.contains("expected "), "{message}");
    }
}

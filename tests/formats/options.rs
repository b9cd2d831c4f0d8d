//! What the user says beats what the content tells.

use photopic::spectrum::WavelengthUnit;
use photopic::spectrum::format::{ErrorKind, Format, Layout, ReadOptions, detect, read};

use super::{bytes, codes, names};

#[test]
fn formats_have_words() {
    for format in Format::ALL {
        assert_eq!(format.to_string().parse(), Ok(format));
    }
    assert_eq!("SPDX".parse(), Ok(Format::Tm27));
    let error = "xls97".parse::<Format>().expect_err("no format");
    assert!(matches!(error.kind(), ErrorKind::UnknownFormat { .. }), "{error}");
    assert_eq!("rows".parse(), Ok(Layout::Rows));
    assert!("diagonal".parse::<Layout>().is_err());
}

#[test]
fn content_tells_the_format_whatever_the_encoding() {
    let text = "##TITLE=x\n##XYPOINTS=(XY..XY)\n";
    let utf16: Vec<u8> = [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    assert_eq!(detect(text.as_bytes()), Format::Jcamp);
    assert_eq!(detect(&utf16), Format::Jcamp);
    assert_eq!(detect(format!("\u{feff}{text}").as_bytes()), Format::Jcamp);
    assert_eq!(detect(b""), Format::Delimited);
    assert_eq!(detect(b"  <?xml version='1.0'?><x/>"), Format::Tm27);
}

#[test]
fn a_format_asked_for_is_tried_and_no_other() {
    for file in names("valid") {
        let bytes = bytes("valid", &file);
        let told = detect(&bytes);
        for format in Format::ALL.into_iter().filter(|f| *f != told && *f != Format::Delimited) {
            let options = ReadOptions { format: Some(format), ..ReadOptions::default() };
            let error = read(&bytes, &options).err().unwrap_or_else(|| panic!("{file} as {format}"));
            assert!(error.location().line.is_some(), "{file} as {format}: {error}");
        }
    }
}

#[test]
fn separator_and_decimal_mark() {
    let with = |separator, decimal| ReadOptions { separator, decimal, ..ReadOptions::default() };
    let values = |text: &str, options: &ReadOptions| {
        let file = read(text.as_bytes(), options).unwrap_or_else(|e| panic!("{text}: {e}")).value;
        let entry = |e: &photopic::spectrum::format::Entry| {
            (e.spectrum.wavelengths_nm().to_vec(), e.spectrum.values().to_vec())
        };
        file.entries.iter().map(entry).collect::<Vec<_>>()
    };
    let commas = "380,1,5\n381,2,5\n";
    assert_eq!(
        values(commas, &with(Some(','), None)),
        [(vec![380.0, 381.0], vec![1.0, 2.0]), (vec![380.0, 381.0], vec![5.0, 5.0])]
    );
    assert_eq!(values("380;1,234\n", &with(None, None)), [(vec![380.0], vec![1.234])]);
    assert_eq!(values("380:1.5\n381:2.5\n", &with(Some(':'), None)), [(vec![380.0, 381.0], vec![1.5, 2.5])]);
    let mixed = "380.5;0,1\n381.5;0,2\n";
    assert!(read(mixed.as_bytes(), &with(None, None)).is_err());
    assert!(read(b"380;1\n", &with(Some('x'), None)).is_err());
    assert!(read(b"380;1\n", &with(None, Some(';'))).is_err());
}

#[test]
fn wavelength_unit() {
    let read =
        |text: &str, unit| read(text.as_bytes(), &ReadOptions { wavelength_unit: unit, ..ReadOptions::default() });
    let file = read("wavelength,a\n0.38,1\n0.39,2\n", Some(WavelengthUnit::Micrometre)).expect("µm");
    assert_eq!(file.value.entries[0].spectrum.wavelengths_nm(), [380.0, 390.0]);
    assert_eq!(codes(&file.findings), [""; 0]);
    let file = read("wavelength [nm],a\n3800,1\n3900,2\n", Some(WavelengthUnit::Angstrom)).expect("Å");
    assert_eq!(file.value.entries[0].spectrum.wavelengths_nm(), [380.0, 390.0]);
    assert_eq!(codes(&file.findings), ["S018"]);
    let error = read("wavelength,a\n0.38,1\n0.39,2\n", None).expect_err("0.38 nm");
    assert!(error.hint().is_some_and(|hint| hint.contains("--wavelength-unit")), "{error}");
    // In micrometres these would be in the far infrared.
    assert!(read("wavelength [um],a\n380,1\n390,2\n", None).is_err());
}

#[test]
fn layout() {
    let with = |layout| ReadOptions { layout: Some(layout), ..ReadOptions::default() };
    let table = b"380.0,385.0,390.0\n400,1,2\n";
    let rows = read(table, &with(Layout::Rows)).expect("rows").value;
    assert_eq!(rows.entries[0].spectrum.wavelengths_nm(), [380.0, 385.0, 390.0]);
    assert_eq!(rows.entries[0].spectrum.values(), [400.0, 1.0, 2.0]);
    let columns = read(table, &with(Layout::Columns)).expect("columns").value;
    assert_eq!(columns.entries[1].spectrum.values(), [390.0, 2.0]);
    // Unevenly spaced wavelengths without labels are rows only on request.
    let uneven = b"380,385,400\n0.1,0.2,0.3\n0.3,0.1,0.2\n0.2,0.2,0.2\n";
    assert!(read(uneven, &ReadOptions::default()).is_err());
    assert_eq!(read(uneven, &with(Layout::Rows)).expect("rows").value.entries.len(), 3);
    assert!(read(b"a,b\nc,d\n", &with(Layout::Rows)).is_err());
}

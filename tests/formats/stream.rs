//! Tables of rows as a stream.

use std::io::{self, Read};
use std::sync::Arc;

use photopic::spectrum::format::{ErrorKind, Opened, ReadOptions, Row, RowStream, open};
use photopic::spectrum::{Quantity, Sampling};

use super::{bytes, codes, names, read_default};

/// Hands out its bytes in pieces of awkward sizes.
struct Pieces<'a>(&'a [u8], usize);

impl Read for Pieces<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        self.1 = self.1 * 7 % 31 + 1;
        let count = self.1.min(self.0.len()).min(out.len());
        out[..count].copy_from_slice(&self.0[..count]);
        self.0 = &self.0[count..];
        Ok(count)
    }
}

fn stream<R: Read>(reader: R) -> Box<RowStream<R>> {
    match open(reader, &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}")) {
        Opened::Stream(stream) => stream,
        Opened::Whole(file) => panic!("read whole: {:?}", file.value),
    }
}

fn all<R: Read>(stream: &mut RowStream<R>, batch: usize) -> Vec<Result<Row, String>> {
    let mut rows = Vec::new();
    while let Some(batch) = stream.next_batch(batch).expect("readable") {
        rows.extend(batch.into_iter().map(|row| row.map_err(|e| e.to_string())));
    }
    rows
}

#[test]
fn a_stream_gives_what_reading_whole_gives() {
    for file in names("valid") {
        let bytes = bytes("valid", &file);
        let whole = read_default(&bytes).expect("valid");
        match open(Pieces(&bytes, 1), &ReadOptions::default()).unwrap_or_else(|e| panic!("{file}: {e}")) {
            Opened::Whole(opened) => assert_eq!(opened, whole, "{file}"),
            Opened::Stream(mut stream) => {
                assert!(file.starts_with("rows"), "{file}");
                assert_eq!(stream.unit(), whole.value.entries[0].unit.as_ref());
                assert_eq!(stream.metadata(), whole.value.metadata);
                let rows = all(&mut stream, 1);
                assert_eq!(rows.len(), whole.value.entries.len(), "{file}");
                assert_eq!(codes(&stream.findings()), codes(&whole.findings), "{file}");
                for (row, entry) in rows.into_iter().zip(&whole.value.entries) {
                    let row = row.expect("valid");
                    assert_eq!((&row.name, &row.values[..]), (&entry.name, entry.spectrum.values()), "{file}");
                    assert_eq!(Some(row.line), entry.location.line, "{file}");
                    assert_eq!(stream.grid(), entry.spectrum.grid());
                }
            }
        }
    }
}

#[test]
fn invalid_files_are_refused_at_the_same_place() {
    for file in names("invalid") {
        let bytes = bytes("invalid", &file);
        let whole = read_default(&bytes).expect_err("invalid").to_string();
        match open(Pieces(&bytes, 3), &ReadOptions::default()) {
            Err(error) => assert_eq!(error.to_string(), whole, "{file}"),
            Ok(Opened::Stream(mut stream)) => {
                let rows = all(&mut stream, 100);
                assert_eq!(rows.into_iter().find_map(Result::err), Some(whole), "{file}");
            }
            Ok(Opened::Whole(file)) => panic!("{:?}", file.value),
        }
    }
}

#[test]
fn one_bad_row_costs_one_row() {
    let text =
        "# made by hand\nname,380,385,390\na,1,2,3\nb,1,x,3\n\nc,1,2\n# between\n\"d,1,2,3\ne,-1,2,NaN\nf,-2,2,3\n";
    let mut stream = stream(text.as_bytes());
    let rows = all(&mut stream, 2);
    let told: Vec<String> = rows
        .into_iter()
        .map(|row| match row {
            Ok(row) => format!("{} {} {:?}", row.line, row.name, row.values),
            Err(error) => error.split(';').next().unwrap_or_default().to_owned(),
        })
        .collect();
    assert_eq!(
        told,
        [
            "3 a [1.0, 2.0, 3.0]",
            "4:5: found `x`",
            "6:6: found 3 cells",
            "8:1: found an opening quotation mark without a closing one",
            "9:8: found `NaN`",
            "10 f [-2.0, 2.0, 3.0]",
        ]
    );
    assert_eq!(stream.rows(), 6);
    assert_eq!(codes(&stream.findings()), ["S003", "S005"]);
    assert_eq!(stream.next_batch(5).expect("ended"), None);
}

#[test]
fn long_streams_keep_their_lines() {
    let mut text = String::from("name;380nm;385nm\n");
    for i in 0..200_000 {
        text.push_str(&format!("row {i};{};0,5\n", i % 1000));
    }
    let mut stream = stream(Pieces(text.as_bytes(), 1));
    let rows = all(&mut stream, 777);
    assert_eq!(rows.len(), 200_000);
    for (i, row) in rows.into_iter().enumerate() {
        let row = row.expect("valid");
        assert_eq!((row.line, row.values), (i as u64 + 2, vec![(i % 1000) as f64, 0.5]));
        assert_eq!(row.name, format!("row {i}"));
    }
}

#[test]
fn utf16_and_latin1_streams() {
    let text = "name;380nm;385nm\nGlühlampe;1;2\n";
    let utf16: Vec<u8> = [0xfe, 0xff].into_iter().chain(text.encode_utf16().flat_map(u16::to_be_bytes)).collect();
    let latin1: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).expect("Latin-1")).collect();
    for (bytes, findings) in [(utf16, &[][..]), (latin1, &["S001"][..])] {
        let mut stream = stream(Pieces(&bytes, 2));
        let rows = all(&mut stream, 10);
        assert_eq!(rows.len(), 1);
        assert_eq!(rows[0].as_ref().map(|r| r.name.as_str()), Ok("Glühlampe"));
        assert_eq!(codes(&stream.findings()), findings);
    }
}

#[test]
fn rows_become_si_on_their_shared_grid() {
    let mut stream = stream(&b"E [mW/m2/nm],380nm,385nm\na,1,2\nb,3,4\n"[..]);
    let scale = stream.scale(None, None).expect("stated");
    assert_eq!((scale.value.quantity, scale.value.sampling), (Quantity::Irradiance, Sampling::Density));
    assert!(scale.findings.is_empty());
    let rows = all(&mut stream, 10);
    let grid = Arc::clone(stream.grid());
    for row in rows {
        let row = row.expect("valid");
        let first = row.values[0];
        let spectrum = scale.value.apply(&grid, row.values).expect("finite");
        assert_eq!(spectrum.values()[0], first * 1e-3);
        assert!(Arc::ptr_eq(spectrum.grid(), &grid));
    }
    assert_eq!(codes(&stream.scale(Some(Quantity::Radiance), None).err().map_or(vec![], |_| vec![])), [""; 0]);
    assert!(stream.scale(Some(Quantity::Radiance), None).is_err());
}

#[test]
fn a_failing_reader_is_an_error() {
    struct Failing(usize);
    impl Read for Failing {
        fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
            if self.0 == 0 {
                return Err(io::Error::other("unplugged"));
            }
            self.0 -= 1;
            out[..2].copy_from_slice(b"na");
            Ok(2)
        }
    }
    let error = open(Failing(1), &ReadOptions::default()).err().expect("fails");
    assert!(matches!(error.kind(), ErrorKind::Io { .. }), "{error}");
}

//! Whatever bytes come in, nothing panics; whatever shape a table has, its numbers come out.

use photopic::spectrum::format::{Format, Opened, ReadOptions, open, read};
use proptest::prelude::*;
use proptest::sample::{Index, select};

use super::{bytes, names, read_default};

/// Reads by every way there is.
fn try_everything(bytes: &[u8]) {
    let formats = Format::ALL.into_iter().map(Some).chain([None]);
    for format in formats {
        let options = ReadOptions { format, ..ReadOptions::default() };
        if let Err(error) = read(bytes, &options) {
            assert!(!error.to_string().is_empty());
        }
        if let Ok(Opened::Stream(mut stream)) = open(bytes, &options) {
            while let Ok(Some(_)) = stream.next_batch(3) {}
            let _ = stream.findings();
        }
    }
}

/// A file of the corpus, valid or not.
fn corpus() -> impl Strategy<Value = Vec<u8>> {
    let all: Vec<(&str, String)> =
        ["valid", "invalid"].into_iter().flat_map(|d| names(d).into_iter().map(move |n| (d, n))).collect();
    select(all).prop_map(|(directory, name)| bytes(directory, &name))
}

/// What a mutation writes: characters that mean something to one of the readers.
const MEANINGFUL: &[&str] = &[
    ",",
    ";",
    "\t",
    " ",
    "\n",
    "\r",
    "\"",
    "#",
    ".",
    "-",
    "+",
    "e",
    "E",
    "0",
    "9",
    "NaN",
    "inf",
    "<",
    ">",
    "&",
    "/",
    "=",
    "##",
    "$$",
    "@",
    "J",
    "Z",
    "s",
    "?",
    "nm",
    "[nm]",
    "\0",
    "é",
    "\u{feff}",
    "1e999",
    "BEGIN_DATA\n",
    ">>>>>Begin",
    "380",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        try_everything(&bytes);
    }

    #[test]
    fn random_tables_never_panic(text in "[0-9a-zA-Z,;\t \n\"#.=<>/\\[\\]()%_+-]{0,300}") {
        try_everything(text.as_bytes());
    }

    #[test]
    fn mutated_files_never_panic(
        mut bytes in corpus(),
        cuts in proptest::collection::vec((any::<Index>(), 0usize..20, select(MEANINGFUL)), 1..6),
    ) {
        for (at, length, with) in cuts {
            let at = at.index(bytes.len() + 1);
            let end = (at + length).min(bytes.len());
            bytes.splice(at..end, with.bytes());
        }
        try_everything(&bytes);
    }

    #[test]
    fn columns_come_back_in_every_dialect(
        values in proptest::collection::vec((-1e6f64..1e6, -1e-6f64..1e-6), 2..20),
        start in 200u32..1000,
        step in 1u32..40,
        (separator, decimal) in select(&[(',', '.'), (';', '.'), (';', ','), ('\t', '.'), ('\t', ','), (' ', '.'), (' ', ',')][..]),
        descending in any::<bool>(),
        heading in any::<bool>(),
        line_end in select(&["\n", "\r\n", "\r"][..]),
        encoding in 0..4,
    ) {
        let number = |value: f64| value.to_string().replace('.', &decimal.to_string());
        let nm: Vec<f64> = (0..values.len()).map(|i| f64::from(start) + f64::from(step) * i as f64 / 4.0).collect();
        let mut lines: Vec<String> = nm
            .iter()
            .zip(&values)
            .map(|(nm, (a, b))| format!("{}{separator}{}{separator}{}", number(*nm), number(*a), number(*b)))
            .collect();
        if descending {
            lines.reverse();
        }
        if heading {
            lines.insert(0, format!("nm{separator}Lämp{separator}b"));
        }
        let text = lines.join(line_end);
        let utf16 = |bytes: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(bytes).collect::<Vec<u8>>();
        let bytes = match encoding {
            0 => text.clone().into_bytes(),
            1 => [b"\xef\xbb\xbf", text.as_bytes()].concat(),
            2 => [&b"\xff\xfe"[..], &utf16(u16::to_le_bytes)].concat(),
            _ => [&b"\xfe\xff"[..], &utf16(u16::to_be_bytes)].concat(),
        };
        // Three bare numbers in a row, evenly spaced: told apart from a heading by nobody.
        let read = match read_default(&bytes) {
            Ok(read) => read.value,
            Err(error) => return Err(TestCaseError::fail(format!("{text}\n{error}"))),
        };
        prop_assert_eq!(read.entries.len(), 2);
        prop_assert_eq!(read.entries[0].spectrum.wavelengths_nm(), &nm[..]);
        prop_assert_eq!(read.entries[0].spectrum.values(), values.iter().map(|v| v.0).collect::<Vec<_>>());
        prop_assert_eq!(read.entries[1].spectrum.values(), values.iter().map(|v| v.1).collect::<Vec<_>>());
        if heading {
            prop_assert_eq!(&read.entries[0].name, "Lämp");
        }
    }

    #[test]
    fn rows_come_back(
        rows in proptest::collection::vec(proptest::collection::vec(-1e3f64..1e3, 5), 1..8),
        prefix in select(&["", "nm", "R_", "SPECTRAL_NM", "x"][..]),
        suffix in select(&["", "nm", " [nm]"][..]),
        separator in select(&[",", ";", "\t"][..]),
        descending in any::<bool>(),
    ) {
        let mut nm: Vec<u32> = (0..5).map(|i| 380 + 10 * i).collect();
        if descending {
            nm.reverse();
        }
        let heading: Vec<String> = nm.iter().map(|nm| format!("{prefix}{nm}{suffix}")).collect();
        let mut text = format!("name{separator}{}\n", heading.join(separator));
        for (i, row) in rows.iter().enumerate() {
            let row: Vec<String> = row.iter().map(f64::to_string).collect();
            text.push_str(&format!("lamp {i}{separator}{}\n", row.join(separator)));
        }
        let read = read_default(text.as_bytes()).map_err(|e| TestCaseError::fail(format!("{text}\n{e}")))?.value;
        prop_assert_eq!(read.entries.len(), rows.len());
        for (entry, mut row) in read.entries.into_iter().zip(rows) {
            if descending {
                row.reverse();
            }
            prop_assert_eq!(entry.spectrum.wavelengths_nm(), &[380.0, 390.0, 400.0, 410.0, 420.0]);
            prop_assert_eq!(entry.spectrum.values(), &row[..]);
        }
    }
}

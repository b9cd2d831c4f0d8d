//! Every file in `invalid/` gives an error with its place, what was found and what was expected; none makes the reader panic.

use photopic::spectrum::format::ErrorKind;

use super::{bytes, names, read_default};

/// File, line, column, and the name of the error's kind.
const EXPECTED: &[(&str, u64, u64, &str)] = &[
    ("ambiguous_commas.csv", 1, 1, "Ambiguous"),
    ("ambiguous_layout.csv", 1, 1, "Ambiguous"),
    ("bad_number.spdx", 11, 36, "NotANumber"),
    ("binary.csv", 2, 6, "NotText"),
    ("blank_lines.csv", 1, 1, "Empty"),
    ("check_x.jdx", 14, 1, "CheckMismatch"),
    ("check_y.jdx", 14, 4, "CheckMismatch"),
    ("comma_under_point.csv", 3, 5, "NotANumber"),
    ("cut.oceanview.txt", 11, 1, "CountMismatch"),
    ("duplicate.csv", 4, 1, "DuplicateWavelength"),
    ("duplicate.spdx", 11, 5, "DuplicateWavelength"),
    ("duplicate.uprtek.xls", 4, 1, "DuplicateWavelength"),
    ("duplicate_far.csv", 5, 1, "DuplicateWavelength"),
    ("empty.csv", 1, 1, "Empty"),
    ("empty.oceanview.txt", 9, 1, "NoSpectrum"),
    ("empty_value.spdx", 11, 5, "NotANumber"),
    ("extra.sekonic.csv", 2, 27, "TooManyColumns"),
    ("fields.cgats.txt", 5, 1, "CountMismatch"),
    ("first_value.csv", 2, 5, "NotANumber"),
    ("first_wavelength.csv", 2, 1, "NotANumber"),
    ("first_wavelength_headless.csv", 1, 1, "NotANumber"),
    ("footer.csv", 4, 1, "NotANumber"),
    ("form.jdx", 3, 10, "Unsupported"),
    ("gap.csv", 3, 9, "MissingValue"),
    ("header_only.csv", 1, 1, "NoSpectrum"),
    ("inf.csv", 3, 6, "NotFinite"),
    ("letters.csv", 3, 5, "NotANumber"),
    ("long_row.csv", 3, 9, "TooManyColumns"),
    ("long_set.cgats.txt", 8, 11, "TooManyColumns"),
    ("metres.csv", 1, 1, "ImplausibleWavelengths"),
    ("micrometres_unsaid.csv", 1, 1, "ImplausibleWavelengths"),
    ("missing.sekonic.csv", 2, 22, "MissingColumn"),
    ("missing_wavelength.csv", 3, 1, "NotANumber"),
    ("missing_y.jdx", 13, 7, "MissingValue"),
    ("nan.csv", 3, 5, "NotFinite"),
    ("nan_wavelength.csv", 3, 1, "NotFinite"),
    ("no_data.jdx", 3, 1, "NoSpectrum"),
    ("no_data.spdx", 7, 3, "NoSpectrum"),
    ("no_end.cgats.txt", 5, 1, "Unexpected"),
    ("no_format.cgats.txt", 2, 1, "Unexpected"),
    ("no_spectrum.cgats.txt", 5, 1, "NoSpectrum"),
    ("no_wavelength.spdx", 10, 5, "Unexpected"),
    ("not_xml.spdx", 3, 1, "Xml"),
    ("npoints.jdx", 13, 1, "CountMismatch"),
    ("npoints_huge.jdx", 10, 11, "Unexpected"),
    ("odd_pairs.jdx", 4, 12, "MissingColumn"),
    ("odd_utf16.csv", 1, 1, "NotText"),
    ("one_column.csv", 3, 1, "NoSpectrum"),
    ("other_root.spdx", 2, 1, "Unexpected"),
    ("overflow.csv", 3, 5, "NotFinite"),
    ("peaks.jdx", 3, 14, "Unsupported"),
    ("prose.txt", 2, 1, "NoSpectrum"),
    ("raman.oceanview.txt", 7, 1, "UnknownUnit"),
    ("rows_duplicate.csv", 1, 14, "DuplicateWavelength"),
    ("rows_gap.csv", 3, 7, "MissingValue"),
    ("rows_long.csv", 3, 15, "TooManyColumns"),
    ("rows_short.csv", 3, 10, "MissingColumn"),
    ("rows_text.csv", 3, 7, "NotANumber"),
    ("seconds.jdx", 4, 10, "UnknownUnit"),
    ("sets.cgats.txt", 9, 1, "CountMismatch"),
    ("sets_huge.cgats.txt", 9, 1, "CountMismatch"),
    ("short_row.csv", 3, 8, "MissingColumn"),
    ("short_set.cgats.txt", 8, 6, "MissingColumn"),
    ("text.oceanview.txt", 11, 9, "NotANumber"),
    ("text.sekonic.csv", 3, 23, "NotANumber"),
    ("text.uprtek.xls", 4, 7, "NotANumber"),
    ("text_value.cgats.txt", 8, 7, "NotANumber"),
    ("thousands.csv", 2, 5, "NotANumber"),
    ("three.oceanview.txt", 10, 16, "TooManyColumns"),
    ("unclosed_quote.csv", 1, 15, "UnclosedQuote"),
    ("unit_conflict.csv", 2, 1, "Ambiguous"),
    ("unsorted.csv", 4, 1, "Unsorted"),
    ("wavenumber_counts.jdx", 4, 10, "Unsupported"),
    ("wavenumbers.csv", 1, 1, "UnknownUnit"),
    ("workbook.xlsx", 1, 1, "NotText"),
    ("zero.csv", 2, 1, "NotPositive"),
];

fn name(kind: &ErrorKind) -> String {
    let debug = format!("{kind:?}");
    debug.split([' ', '(']).next().unwrap_or_default().to_owned()
}

#[test]
fn every_file_is_refused_at_its_place() {
    for &(file, line, column, kind) in EXPECTED {
        let error = match read_default(&bytes("invalid", file)) {
            Ok(read) => panic!("{file} was read: {:?}", read.value),
            Err(error) => error,
        };
        assert_eq!(name(error.kind()), kind, "{file}: {error}");
        assert_eq!((error.location().line, error.location().column), (Some(line), Some(column)), "{file}: {error}");
        let text = error.to_string();
        assert!(
            text.starts_with(&format!("{line}:{column}: found ")) && text.contains("; expected "),
            "{file}: {text}"
        );
    }
}

#[test]
fn no_file_is_forgotten() {
    let mut listed: Vec<_> = EXPECTED.iter().map(|(file, ..)| *file).collect();
    listed.sort_unstable();
    assert_eq!(names("invalid"), listed);
}

#[test]
fn the_path_goes_in_front() {
    let error = read_default(&bytes("invalid", "letters.csv")).expect_err("invalid").in_file("dir/letters.csv");
    assert_eq!(error.to_string(), "dir/letters.csv:3:5: found `O.25`; expected a number for the value");
}

#[test]
fn files_cut_anywhere_never_panic() {
    for directory in ["valid", "invalid"] {
        for file in names(directory) {
            let whole = bytes(directory, &file);
            for end in 0..whole.len() {
                let _ = read_default(&whole[..end]);
            }
        }
    }
}

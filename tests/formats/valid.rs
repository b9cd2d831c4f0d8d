//! Every file in `valid/`: names, quantities, units, wavelengths and values as a person reads them in the file.

use photopic::spectrum::Quantity::{self, Exitance, Flux, Irradiance, Radiance, Relative};
use photopic::spectrum::format::Format;

use super::{bytes, codes, names, read_default};

/// Name, quantity, unit, wavelengths (nm), values.
type Entry = (&'static str, Option<Quantity>, &'static str, &'static [f64], &'static [f64]);

struct Expected {
    file: &'static str,
    format: Format,
    entries: &'static [Entry],
    findings: &'static [&'static str],
}

const fn csv(file: &'static str, entries: &'static [Entry], findings: &'static [&'static str]) -> Expected {
    Expected { file, format: Format::Delimited, entries, findings }
}

const fn other(
    file: &'static str,
    format: Format,
    entries: &'static [Entry],
    findings: &'static [&'static str],
) -> Expected {
    Expected { file, format, entries, findings }
}

const TWO: &[f64] = &[380.0, 385.0];
const THREE: &[f64] = &[380.0, 385.0, 390.0];

const EXPECTED: &[Expected] = &[
    csv("comma.csv", &[("irradiance", Some(Irradiance), "W/m2/nm", THREE, &[0.1, 0.25, 0.5])], &[]),
    csv("headless.csv", &[("", None, "", THREE, &[0.1, 0.25, 0.5])], &["S003"]),
    csv("headless_three.csv", &[("", None, "", TWO, &[0.3, 0.4]), ("", None, "", TWO, &[0.2, 0.1])], &["S003"]),
    csv("crlf.csv", &[("a", None, "", TWO, &[0.1, 0.25])], &[]),
    csv("old_mac.csv", &[("a", None, "", TWO, &[0.1, 0.25])], &[]),
    csv(
        "semicolon_comma.csv",
        &[("Bestrahlungsstärke", None, "mW/(m²·nm)", &[380.0, 380.5, 381.0], &[0.1, 12.5, 3.0])],
        &[],
    ),
    csv("tab_comma.tsv", &[("lamp", None, "", &[380.5, 381.5], &[0.1, 0.2])], &[]),
    csv("blanks.txt", &[("", None, "", &[380.0, 385.5, 391.0], &[0.1, 0.25, -1.0])], &["S003", "S005"]),
    csv("blanks_comma.txt", &[("", None, "", &[380.5, 381.5], &[0.1, 0.2])], &["S003"]),
    csv("numpy.txt", &[("value", None, "", TWO, &[0.1, 0.25])], &[]),
    csv("utf8_bom.csv", &[("a", None, "", TWO, &[0.1, 0.25])], &[]),
    csv("utf16le.csv", &[("E", None, "µW/cm²/nm", TWO, &[0.1, 0.25])], &[]),
    csv("utf16be.csv", &[("E", None, "µW/cm²/nm", TWO, &[0.1, 0.25])], &[]),
    csv("latin1.csv", &[("E", None, "µW/cm²/nm", TWO, &[0.1, 0.25])], &["S001"]),
    csv("excel_sep.csv", &[("a", None, "", TWO, &[1.0, 2.0])], &[]),
    csv("excel_sep_pipe.csv", &[("a", None, "", TWO, &[1.0, 2.0])], &[]),
    csv(
        "unit_row.csv",
        &[("Lamp A", None, "W/m²/nm", TWO, &[0.1, 0.3]), ("Lamp B", None, "W/m²/nm", TWO, &[0.2, 0.4])],
        &[],
    ),
    csv("unit_row_brackets.csv", &[("SPD", Some(Relative), "", TWO, &[0.1, 0.3])], &[]),
    csv("comments.csv", &[("a", None, "", TWO, &[0.1, 0.25])], &[]),
    csv("preamble.csv", &[("a", None, "W/m2/nm", TWO, &[0.1, 0.25])], &[]),
    csv("preamble_colon.txt", &[("v", None, "", THREE, &[0.1, 0.2, 0.3])], &["S003"]),
    csv(
        "descending.csv",
        &[("a", None, "", THREE, &[0.1, 0.25, 0.5]), ("b", None, "", &[390.0], &[5.0])],
        &["S002", "S004"],
    ),
    csv(
        "ragged.csv",
        &[
            ("a", None, "", THREE, &[0.1, 0.2, 0.3]),
            ("b", None, "", &[385.0, 390.0, 395.0], &[2.0, 4.0, 5.0]),
            ("c", None, "", &[385.0], &[3.0]),
        ],
        &["S004", "S004", "S004"],
    ),
    csv("trailing_separators.csv", &[("a", None, "", TWO, &[0.1, 0.25])], &[]),
    csv(
        "pairs.csv",
        &[("a", None, "", TWO, &[0.1, 0.2]), ("b", None, "", &[400.0, 410.0, 420.0], &[1.0, 2.0, 3.0])],
        &[],
    ),
    csv("wavelength_last.csv", &[("a", None, "", TWO, &[0.1, 0.25])], &[]),
    csv("pixel_column.csv", &[("a", None, "", TWO, &[0.1, 0.25])], &["S009"]),
    csv(
        "numbered_columns.csv",
        &[
            ("2700", None, "", THREE, &[1.0, 4.0, 7.0]),
            ("3000", None, "", THREE, &[2.0, 5.0, 8.0]),
            ("4000", None, "", THREE, &[3.0, 6.0, 9.0]),
        ],
        &["S003"],
    ),
    csv(
        "facts_per_column.csv",
        &[("a", None, "", TWO, &[1.0, 4.0]), ("b", None, "", TWO, &[2.0, 5.0]), ("c", None, "", TWO, &[3.0, 6.0])],
        &[],
    ),
    csv("micrometres.csv", &[("radiance", Some(Radiance), "W/(m2 sr um)", &[380.0, 390.0], &[1.0, 2.0])], &[]),
    csv("angstrom.csv", &[("flux", Some(Flux), "", &[380.0, 390.0], &[1.0, 2.0])], &[]),
    csv("photons.csv", &[("photon irradiance", Some(Irradiance), "µmol/m²/s/nm", &[500.0, 510.0], &[1.0, 1.0])], &[]),
    csv("band.csv", &[("line power", None, "W/m2", &[404.7, 435.8], &[1.0, 2.0])], &[]),
    csv("single.csv", &[("E", None, "W/m2/nm", &[555.0], &[1.0])], &[]),
    csv("quoted.csv", &[("Lamp \"A\", 3000 K", None, "", TWO, &[0.1, 0.25])], &[]),
    csv("quoted_comma.csv", &[("a", None, "", &[380.5, 381.5], &[0.1, 0.2])], &[]),
    csv("no_last_newline.csv", &[("a", None, "", TWO, &[0.1, 0.25])], &[]),
    csv("relative.csv", &[("SPD", Some(Relative), "", TWO, &[1.0, 2.0])], &[]),
    csv("unknown_unit.csv", &[("E", None, "", TWO, &[1.0, 2.0])], &["S006"]),
    csv(
        "rows.csv",
        &[("lamp A", None, "", THREE, &[0.1, 0.2, 0.3]), ("lamp B", None, "", THREE, &[1.0, 2.0, 3.0])],
        &["S003"],
    ),
    csv("rows_nm.csv", &[("lamp A", None, "", TWO, &[0.1, 0.2]), ("lamp; B", None, "", TWO, &[1.0, 2.0])], &[]),
    csv(
        "rows_prefix.csv",
        &[
            ("s1", None, "", &[400.0, 410.0, 420.0], &[0.1, 0.2, 0.3]),
            ("s2", None, "", &[400.0, 410.0, 420.0], &[0.4, 0.5, 0.6]),
        ],
        &["S003"],
    ),
    csv("rows_descending.csv", &[("a", None, "", THREE, &[1.0, 2.0, 3.0])], &["S003", "S002"]),
    csv(
        "rows_numbers.csv",
        &[
            ("", None, "", THREE, &[0.1, 0.2, 0.3]),
            ("", None, "", THREE, &[0.4, 0.5, 0.6]),
            ("", None, "", THREE, &[0.2, 0.1, 0.0]),
        ],
        &["S003"],
    ),
    csv(
        "rows_pandas.csv",
        &[("0", None, "", THREE, &[0.1, 0.2, 0.3]), ("1", None, "", THREE, &[0.4, 0.5, 0.6])],
        &["S003"],
    ),
    csv("rows_unit.csv", &[("lamp A", None, "mW/m2/nm", THREE, &[0.1, 0.2, 0.3])], &[]),
    csv("rows_um.csv", &[("a", None, "", &[380.0, 390.0], &[1.0, 2.0])], &[]),
    other(
        "irradiance.spdx",
        Format::Tm27,
        &[("Lamp & filter", Some(Irradiance), "W/m2/nm", &[380.0, 385.5], &[0.1, 0.25])],
        &["S007"],
    ),
    other(
        "exitance.spdx",
        Format::Tm27,
        &[("Lamp & filter", Some(Exitance), "W/m2/nm", &[380.0, 390.0], &[1.0, 2.0])],
        &["S007"],
    ),
    other("other.spdx", Format::Tm27, &[("Lamp & filter", None, "", &[380.0, 390.0], &[1.0, 2.0])], &["S002"]),
    other(
        "cgats.txt",
        Format::Cgats,
        &[
            ("patch A1", Some(Relative), "", &[380.0, 390.0, 400.0], &[0.11, 0.12, 0.13]),
            ("A2", Some(Relative), "", &[380.0, 390.0, 400.0], &[0.21, 0.22, 0.23]),
        ],
        &["S007"],
    ),
    other("xrite.txt", Format::Cgats, &[("red patch", Some(Relative), "", &[400.0, 410.0], &[0.5, 0.25])], &["S007"]),
    other("cgats_emission.txt", Format::Cgats, &[("", None, "", &[380.0, 400.0], &[3.0, 4.0])], &["S002"]),
    other(
        "cgats_two_tables.txt",
        Format::Cgats,
        &[("x", Some(Relative), "", &[400.0, 410.0], &[0.1, 0.2])],
        &["S009", "S007"],
    ),
    other(
        "affn.jdx",
        Format::Jcamp,
        &[(
            "sample",
            Some(Relative),
            "",
            &[380.0, 381.0, 382.0, 383.0, 384.0, 385.0, 386.0],
            &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7],
        )],
        &[],
    ),
    other(
        "difdup.jdx",
        Format::Jcamp,
        &[(
            "sample",
            None,
            "",
            &[400.0, 402.0, 404.0, 406.0, 408.0, 410.0, 412.0, 414.0, 416.0, 418.0],
            &[0.5, 1.0, 1.5, 1.5, 1.0, 0.5, 0.0, -0.5, -1.0, -1.5],
        )],
        &["S005"],
    ),
    other(
        "sqz_descending.jdx",
        Format::Jcamp,
        &[("sample", Some(Relative), "", &[380.0, 381.0, 382.0, 383.0, 384.0], &[1.0, 2.0, 3.0, 2.0, 1.0])],
        &["S002"],
    ),
    other("points.jdx", Format::Jcamp, &[("points", None, "W/m2/um", &[380.0, 390.0, 400.0], &[1.0, 2.0, 3.0])], &[]),
    // 10⁷/ν: 20000, 22500, 25000 cm⁻¹ are 500, 444.4…, 400 nm; a transmittance stays what it is.
    other(
        "wavenumber_ratio.jdx",
        Format::Jcamp,
        &[("sample", Some(Relative), "", &[400.0, 1e7 / 22500.0, 500.0], &[0.3, 0.2, 0.1])],
        &["S015", "S002"],
    ),
    // E per cm⁻¹ times ν²/10⁷: 1·10⁸/10⁷ = 10, 2·2.25·10⁸/10⁷ = 45, 4·4·10⁸/10⁷ = 160 per nm.
    other(
        "wavenumber_density.jdx",
        Format::Jcamp,
        &[("sample", Some(Irradiance), "W/m2/nm", &[500.0, 1e7 / 15000.0, 1000.0], &[160.0, 45.0, 10.0])],
        &["S015", "S002"],
    ),
    other(
        "two_blocks.jdx",
        Format::Jcamp,
        &[
            ("part 1", None, "W/m2/nm", &[380.0, 390.0], &[1.0, 2.0]),
            ("part 2", None, "W/m2/nm", &[380.0, 390.0], &[2.0, 3.0]),
        ],
        &[],
    ),
    other(
        "oceanview.txt",
        Format::OceanView,
        &[("lamp_01.txt", None, "", &[338.028, 338.482, 338.936], &[279.71, -1.5, 291.33])],
        &["S005"],
    ),
    other(
        "oceanview_comma.txt",
        Format::OceanView,
        &[("lamp_01.txt", None, "", &[338.028, 338.482, 338.936], &[279.71, 285.43, 291.33])],
        &[],
    ),
    other("spectrasuite.txt", Format::OceanView, &[("", None, "uW/cm^2/nm", &[380.1, 381.2], &[0.5, 0.6])], &[]),
    other(
        "uprtek.xls",
        Format::Uprtek,
        &[("my lamp", Some(Irradiance), "mW/m2/nm", &[554.0, 555.0, 556.0], &[1000.0, 1000.0, 1000.0])],
        &["S007"],
    ),
    other(
        "uprtek_contradiction.xls",
        Format::Uprtek,
        &[("", None, "", &[554.0, 555.0, 556.0], &[1000.0, 1000.0, 1000.0])],
        &["S008"],
    ),
    other(
        "sekonic.csv",
        Format::Sekonic,
        &[("my lamp", Some(Irradiance), "W/m2/nm", &[554.0, 555.0, 556.0], &[1.0, 1.0, 1.0])],
        &["S016", "S007"],
    ),
];

#[test]
fn every_file_is_read_as_it_is_written() {
    for expected in EXPECTED {
        let file = expected.file;
        let checked = read_default(&bytes("valid", file)).unwrap_or_else(|e| panic!("{file}: {e}"));
        assert_eq!(checked.value.format, expected.format, "{file}");
        assert_eq!(codes(&checked.findings), expected.findings, "{file}: {:?}", checked.findings);
        assert_eq!(checked.value.entries.len(), expected.entries.len(), "{file}");
        for (entry, &(name, quantity, unit, nm, values)) in checked.value.entries.iter().zip(expected.entries) {
            assert_eq!(entry.name, name, "{file}");
            assert_eq!(entry.quantity, quantity, "{file} {name}");
            assert_eq!(entry.unit.as_ref().map_or("", |u| &u.text), unit, "{file} {name}");
            // Factors of a file may round; decimal numbers as they stand may not.
            let close = |found: &[f64], wanted: &[f64]| {
                found.len() == wanted.len()
                    && found.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= 4.0 * f64::EPSILON * b.abs())
            };
            assert!(close(entry.spectrum.wavelengths_nm(), nm), "{file} {name}: {:?}", entry.spectrum.wavelengths_nm());
            assert!(close(entry.spectrum.values(), values), "{file} {name}: {:?}", entry.spectrum.values());
        }
    }
}

#[test]
fn no_file_is_forgotten() {
    let mut listed: Vec<_> = EXPECTED.iter().map(|e| e.file).collect();
    listed.sort_unstable();
    assert_eq!(names("valid"), listed);
}

#[test]
fn spectra_of_one_table_share_one_grid() {
    for file in ["unit_row.csv", "rows.csv", "cgats.txt"] {
        let file = read_default(&bytes("valid", file)).expect("valid").value;
        let [a, b] = &file.entries[..] else { panic!("two spectra") };
        assert!(std::sync::Arc::ptr_eq(a.spectrum.grid(), b.spectrum.grid()));
    }
}

#[test]
fn facts_and_figures_are_kept() {
    let file = read_default(&bytes("valid", "preamble.csv")).expect("valid").value;
    let facts: Vec<_> = file.metadata.iter().map(|(k, v)| (k.as_str(), v.as_str())).collect();
    assert_eq!(
        facts,
        [("Instrument", "Spectro 3000"), ("Illuminance [lx]", "123.4"), ("CCT", "3000"), ("unit", "W/m2/nm")]
    );
    let printed: Vec<_> = file.entries[0].printed.iter().map(|p| (p.key, p.value, p.text.as_str())).collect();
    assert_eq!(printed, [("photopic.illuminance_lx", 123.4, "123.4"), ("cct_k", 3000.0, "3000")]);

    let file = read_default(&bytes("valid", "preamble_colon.txt")).expect("valid").value;
    assert_eq!(file.metadata[0], ("Instrument".to_owned(), "Spectro 3000".to_owned()));
    assert_eq!(file.metadata[1], ("Gain".to_owned(), "5".to_owned()));

    // Ra of three columns is no figure of any one of them.
    let file = read_default(&bytes("valid", "facts_per_column.csv")).expect("valid").value;
    assert!(file.entries.iter().all(|e| e.printed.is_empty()));
    assert_eq!(file.metadata, [("Ra".to_owned(), "95 96 97".to_owned())]);

    let file = read_default(&bytes("valid", "comments.csv")).expect("valid").value;
    assert_eq!(file.metadata[0], ("maker".to_owned(), "ACME".to_owned()));

    let file = read_default(&bytes("valid", "rows_nm.csv")).expect("valid").value;
    assert_eq!(file.entries[1].metadata, [("id".to_owned(), "2".to_owned())]);

    let file = read_default(&bytes("valid", "oceanview.txt")).expect("valid").value;
    let time = file.entries[0].metadata.iter().find(|(k, _)| k == "Integration Time (sec)");
    assert_eq!(time.map(|(_, v)| v.as_str()), Some("5.000000E0"));

    let file = read_default(&bytes("valid", "sekonic.csv")).expect("valid").value;
    let printed: Vec<_> = file.entries[0].printed.iter().map(|p| (p.key, p.value, p.text.as_str())).collect();
    assert_eq!(
        printed,
        [("photopic.illuminance_lx", 1366.0, "1366"), ("", 127.0, "127"), ("excitation_purity", 0.415, "41.5")]
    );
}

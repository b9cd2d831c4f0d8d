//! What several test files need: the shared reference folder and its tables.

#![allow(dead_code, reason = "each test file uses its own part")]

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use photopic::spectrum::{Grid, Spectrum};

/// The folder of reference files beside the checkout, or `None` with a word on the skipped test.
pub fn shared(what: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared").join(what);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: ../shared/{what} is not here");
    None
}

/// A CSV file as rows of header → cell.
pub fn rows(path: &Path) -> Vec<HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).expect("the reference table opens");
    reader.deserialize().map(|row| row.expect("a row of the reference table")).collect()
}

/// The reference spectra in file order: name and spectrum on its native grid.
pub fn reference_spectra() -> Option<Vec<(String, Spectrum)>> {
    let path = shared("spectra/reference_spds.csv")?;
    let mut out: Vec<(String, Vec<f64>, Vec<f64>)> = Vec::new();
    for row in rows(&path) {
        let number = |key: &str| row[key].parse::<f64>().expect("a number");
        if out.last().is_none_or(|(name, ..)| *name != row["name"]) {
            out.push((row["name"].clone(), Vec::new(), Vec::new()));
        }
        let last = out.last_mut().expect("just pushed");
        last.1.push(number("wavelength_nm"));
        last.2.push(number("value"));
    }
    let spectrum = |(name, wavelengths, values)| {
        let grid = Arc::new(Grid::new(wavelengths).expect("ascending"));
        (name, Spectrum::density(grid, values).expect("finite"))
    };
    Some(out.into_iter().map(spectrum).collect())
}

//! Reading spectra: every file of `tests/data/formats` and of `../shared/spectra/files`, options, streams, and properties.

mod invalid;
mod options;
mod properties;
mod real;
mod resolve;
mod stream;
mod valid;

use std::path::{Path, PathBuf};

use photopic::finding::{Checked, Finding};
use photopic::spectrum::format::{Error, ReadOptions, SpectrumFile, read};

/// `tests/data/formats/DIRECTORY`.
fn folder(directory: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/formats").join(directory)
}

/// The names in a folder of the corpus, sorted.
fn names(directory: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder(directory)).expect("the corpus is there");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("readable").file_name().into_string().expect("ASCII name")).collect();
    names.sort();
    names
}

fn bytes(directory: &str, name: &str) -> Vec<u8> {
    std::fs::read(folder(directory).join(name)).unwrap_or_else(|e| panic!("{directory}/{name}: {e}"))
}

fn read_default(bytes: &[u8]) -> Result<Checked<SpectrumFile>, Error> {
    read(bytes, &ReadOptions::default())
}

fn codes(findings: &[Finding]) -> Vec<&'static str> {
    findings.iter().map(|f| f.code).collect()
}

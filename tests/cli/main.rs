//! The command line as a script sees it: exit codes, streams, the JSON envelope and its keys, inputs of every shape, and
//! numbers that follow from the SI or from a standard's printed digits.

mod contract;
mod correct;
mod envelope;
mod exit_codes;
mod flicker;
mod inputs;
mod outputs;
mod quantities;
mod reflectance;
mod report;
mod safety;
mod trade;
mod uncertainty;

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

pub(crate) const BINARY: &str = env!("CARGO_BIN_EXE_photopic");
/// Exact SI.
pub(crate) const PLANCK: f64 = 6.626_070_15e-34;
pub(crate) const SPEED_OF_LIGHT: f64 = 299_792_458.0;
pub(crate) const AVOGADRO: f64 = 6.022_140_76e23;
/// CIE 018:2019.
pub(crate) const K_M: f64 = 683.002;
/// V(500 nm), CIE 018:2019, Table 1, as printed.
pub(crate) const V_500: f64 = 0.323;

pub(crate) fn photopic() -> Command {
    let mut command = Command::new(BINARY);
    command.env_remove("CLICOLOR_FORCE").env_remove("NO_COLOR");
    command
}

pub(crate) fn office_led() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/spectra/office-led.csv")
}

/// A folder with files in it.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub(crate) fn with(self, name: &str, bytes: impl AsRef<[u8]>) -> Self {
        fs::write(self.path(name), bytes).expect("written");
        self
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn run(&self) -> Command {
        let mut command = photopic();
        command.current_dir(self.0.path());
        command
    }

    /// The names in the folder, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("the folder");
        let mut names: Vec<String> =
            entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// The JSON of a run that has to succeed.
pub(crate) fn json(command: &mut Command) -> Value {
    let out = command.arg("--json").assert().success().get_output().stdout.clone();
    serde_json::from_slice(&out).expect("one JSON document")
}

/// The number at a dotted path of the first result.
pub(crate) fn number(document: &Value, path: &str) -> f64 {
    at(&document["results"][0], path).as_f64().unwrap_or_else(|| panic!("no number at {path}: {document}"))
}

pub(crate) fn at<'a>(value: &'a Value, path: &str) -> &'a Value {
    path.split('.').fold(value, |v, key| key.parse::<usize>().map_or_else(|_| &v[key], |i| &v[i]))
}

#[track_caller]
pub(crate) fn close(got: f64, want: f64, relative: f64) {
    assert!((got - want).abs() <= relative * want.abs(), "{got} for {want} within {relative}");
}

/// A constant density of 1 from 400 to 700 nm by 10 nm.
pub(crate) fn constant() -> String {
    (0..=30).fold("wavelength,value\n".to_owned(), |text, i| text + &format!("{},1\n", 400 + 10 * i))
}

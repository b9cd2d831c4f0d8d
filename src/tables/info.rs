//! What the manifest says about a table.

use serde::{Deserialize, Serialize};

/// Everything `data/MANIFEST.toml` says about one table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct TableInfo {
    /// Stable name on the command line and in the library, such as `cie-1931-2deg`.
    pub name: String,
    /// Other names that [`get`](super::get) understands.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub aliases: Vec<String>,
    /// File below `data/`.
    pub file: String,
    /// What the table is.
    pub title: String,
    /// Standard and number of the table in it.
    pub standard: String,
    /// DOI of the publisher's data set, or of the publication.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doi: Option<String>,
    /// The publication, where the standard alone does not name it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<String>,
    /// Where these digits were taken from: package, version and object, or the formula they were computed with.
    pub origin: String,
    /// What they were held against.
    pub checked: String,
    /// Terms of the numbers: `CC BY-SA 4.0`, or a phrase where the publisher states none.
    pub licence: String,
    /// Whom to name, where the terms ask for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attribution: Option<String>,
    /// Date of the export, year-month-day.
    pub date: String,
    /// SHA-256 of the embedded file, lower-case hexadecimal.
    pub sha256: String,
    /// SHA-256 that the publisher gives for its own file, where these digits were shown to be that file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub publisher_sha256: Option<String>,
    /// Number of wavelengths.
    pub rows: usize,
    /// First wavelength, nm.
    pub first_nm: f64,
    /// Last wavelength, nm.
    pub last_nm: f64,
    /// Distance of neighbouring wavelengths, nm; absent where it varies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_nm: Option<f64>,
    /// How the publisher reads values between the wavelengths: `linear` or `log-linear`.
    pub interpolation: String,
    /// How the publisher reads values outside: `zero`.
    pub extrapolation: String,
    /// Whether the columns are smooth functions, so that a wrong digit stands out from its neighbours.
    pub smooth: bool,
    /// Wavelengths, nm, where the published numbers of a smooth table break off or stand out; the note says why.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub breaks_nm: Vec<f64>,
    /// What a user of the numbers should know: blanks, known misprints elsewhere, differences between editions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// The columns in the order of the file, the wavelengths not among them.
    pub columns: Vec<Column>,
    /// Values that a publication prints, to test the table with.
    pub spots: Vec<Spot>,
}

impl TableInfo {
    /// The name, then the aliases.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        std::iter::once(self.name.as_str()).chain(self.aliases.iter().map(String::as_str))
    }
}

/// One column of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Column {
    /// Name in the header row.
    pub name: String,
    /// Unit; `1` for a relative or dimensionless quantity.
    pub unit: String,
    /// What the values are.
    pub meaning: String,
    /// Wavelength of the largest value, nm; the middle one where neighbours are printed alike.
    pub peak_nm: f64,
    /// The largest value.
    pub peak: f64,
    /// Sum of the column that the publisher gives with its data set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub published_sum: Option<f64>,
}

/// A value of the table that a publication prints.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Spot {
    /// Wavelength, nm.
    pub nm: f64,
    /// Name of the column.
    pub column: String,
    /// The value.
    pub value: f64,
    /// The publication.
    pub source: String,
}

/// What the manifest says about a table over two arguments other than the wavelength.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct LookupInfo {
    /// Stable name.
    pub name: String,
    /// File below `data/`.
    pub file: String,
    /// What the table is.
    pub title: String,
    /// Standard and number of the table in it.
    pub standard: String,
    /// Where these digits were taken from.
    pub origin: String,
    /// What they were held against.
    pub checked: String,
    /// Terms of the numbers.
    pub licence: String,
    /// Date of the transcription, year-month-day.
    pub date: String,
    /// SHA-256 of the embedded file, lower-case hexadecimal.
    pub sha256: String,
    /// The argument that the rows stand for, in the first column.
    pub rows: String,
    /// The argument that the columns stand for, in the header.
    pub columns: String,
    /// What a user of the numbers should know.
    pub note: String,
}

/// The whole manifest.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Manifest {
    pub(super) table: Vec<TableInfo>,
    pub(super) lookup: Vec<LookupInfo>,
}

/// Reads the manifest.
pub(super) fn read(toml: &str) -> Result<Manifest, toml::de::Error> {
    toml::from_str(toml)
}

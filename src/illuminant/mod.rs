//! Light sources as spectra: blackbodies, CIE daylight and the tabulated illuminants, by formula or by name.
//!
//! Nothing here knows an observer; which blackbody is *nearest* in colour is asked in [`crate::colorimetry`].

pub mod daylight;
pub mod named;
pub mod planck;

/// Why a source could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The daylight locus is not defined there.
    #[error("daylight of {kelvin} K; expected 4000 K to 25000 K, where the CIE daylight locus is defined")]
    DaylightRange {
        /// The temperature asked for.
        kelvin: f64,
    },
    /// Not a temperature.
    #[error("a temperature of `{found}`; expected a positive number of kelvin such as 2856K")]
    Temperature {
        /// The text met.
        found: String,
    },
    /// Not a wavelength.
    #[error("a line at `{found}`; expected a wavelength in nm such as 555nm")]
    Line {
        /// The text met.
        found: String,
    },
    /// No source of this name.
    #[error(
        "no source is named `{name}`; expected a file, blackbody:2856K, daylight:6500K, line:555nm, or one of {known}"
    )]
    Unknown {
        /// The name met.
        name: String,
        /// The names there are.
        known: String,
    },
    /// An embedded table lacks a column.
    #[error("the embedded table {table} has no column {column}")]
    Column {
        /// The table.
        table: &'static str,
        /// The column.
        column: &'static str,
    },
    /// An embedded table is missing.
    #[error(transparent)]
    Table(#[from] crate::tables::Error),
    /// The samples do not make a spectrum.
    #[error(transparent)]
    Spectrum(#[from] crate::spectrum::Error),
}

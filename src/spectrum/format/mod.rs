//! Reading spectra from files: one file per format, one error type with line and column, formats told by content.
//!
//! A reader returns what the file states and nothing more: [`Entry`] keeps the quantity and unit as found (or absent), the
//! figures that the instrument printed, and the samples in nm, ascending, finite and without duplicates.
//! [`Entry::resolve`] brings an entry to SI per nanometre, with the user's word where the file is silent.
//!
//! [`read`] takes a whole input, [`open`] also streams tables with one spectrum per row.
//!
//! # Delimited text
//!
//! What the user does not say ([`ReadOptions`]) is told by these rules; where they do not settle it, the input is refused.
//!
//! - **Lines.** Blank lines and those that begin with `#`, `%`, `//` or `!` are skipped. `key,value` and `key: value` lines above
//!   the table are metadata; a key `unit` or `quantity` among them holds for all spectra. After the table nothing may follow.
//! - **Separator.** A leading `sep=` line says it. Else, of TAB, `;`, `,` and runs of blanks, the one under which the longest run
//!   of neighbouring lines has the same number (two or more) of cells, numbers among them; of equal ones the first in this order.
//! - **Decimal mark.** Where commas do not separate, a comma in a number is the decimal mark if no number has a point. It is
//!   never a thousands mark. Rows of three or more integers between commas, without a heading, are ambiguous.
//! - **Layout.** One spectrum per column under a wavelength column; or one per row, where a line has three or more cells (two, if
//!   they state nm) that are wavelengths alike but for the number (`380`, `380nm`, `nm380`, `R_380`), in order, numbers below. A
//!   cell such as `wavelength` heads the column below it. Bare numbers without labels lie in rows only if the first row is
//!   evenly spaced and the first column is out of order; where both are in order the table is ambiguous.
//! - **Wavelengths** have the unit of their heading or unit row, else nm by convention ([S003](#findings)). They may descend. Several
//!   wavelength columns each govern the columns up to the next one.
//! - **Values** have the quantity and unit of their heading, unit row, or metadata; nothing is guessed. Empty cells (`NA`, `-`)
//!   make a spectrum shorter at its ends, and are refused between its values and in rows.
//!
//! # Findings
//!
//! | code | severity | meaning |
//! |---|---|---|
//! | S001 | info | the text is not UTF-8 and was read as Windows-1252 |
//! | S002 | info | wavelengths ran from long to short and were reversed |
//! | S003 | info | no unit of wavelength stated; nm taken by convention |
//! | S004 | warning | a spectrum is shorter than its table: cells at its ends are empty |
//! | S005 | warning | negative samples were kept (how many, the lowest) |
//! | S006 | warning | what stands in the place of a unit is none that is understood; no unit taken |
//! | S007 | info | the unit follows from the definition of the format, and how it was checked |
//! | S008 | warning | figures in the file contradict the unit of its format; no unit taken |
//! | S009 | info, warning | a column, block or table without a spectrum, or outside of the wavelengths, was not read |
//! | S010 | warning | neither file nor user state a unit: only ratios are reported |
//! | S011 | warning | the unit has no wavelength in it: samples are taken per band |
//! | S012 | warning | a single sample is taken as the amount in one line |
//! | S013 | warning | the user's quantity or unit replaces another one in the file |
//! | S014 | warning | the user gave a quantity without unit: SI per nm taken |
//! | S015 | info | an axis in wavenumbers was converted to wavelengths, and what that did to the values |
//! | S016 | info | the same spectrum stands in the file more than once; which one was taken |
//! | S017 | warning | a check figure in the file (first, largest, smallest value) does not agree with its data |
//! | S018 | warning | the user's unit of wavelength replaces another one in the file |
//! | S019 | info | a column of standard uncertainties (`u(…)`, `standard_uncertainty`) was read as those of the one before it |

use std::fmt;
use std::str::FromStr;

use super::{Quantity, SpectralUnit, Spectrum, WavelengthUnit};
use crate::finding::{Checked, Location};

mod asdf;
mod axis;
mod cgats;
mod columns;
mod delimited;
mod dialect;
mod error;
mod field;
mod header;
mod instrument;
mod jcamp;
mod layout;
mod number;
mod oceanview;
mod printed;
mod resolve;
mod rows;
mod sekonic;
mod stream;
mod text;
mod tm27;
mod uprtek;

pub use error::{Error, ErrorKind};
pub use resolve::Scale;
pub use rows::Row;
pub use stream::{LARGEST_WHOLE, LONGEST_ROW, Opened, RowStream, open};

/// One spectrum as its file states it.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Name in the file: column header, row label, title; empty where there is none.
    pub name: String,
    /// The samples in the file's own unit, wavelengths in nm.
    pub spectrum: Spectrum,
    /// Standard uncertainty of each sample, in the same unit, where a column beside holds it.
    pub standard: Option<Vec<f64>>,
    /// Quantity, where the file states one.
    pub quantity: Option<Quantity>,
    /// Unit of the samples, where the file states one.
    pub unit: Option<SpectralUnit>,
    /// Figures that the instrument printed beside the spectrum.
    pub printed: Vec<Printed>,
    /// Other facts of this spectrum (maker, date, integration time), label and text, in file order.
    pub metadata: Vec<(String, String)>,
    /// Where it stands in the input.
    pub location: Location,
}

/// A figure that an instrument printed beside its spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct Printed {
    /// The key under which our own figure of the same meaning stands in the results, such as `photopic.illuminance_lx`,
    /// `cct_k`, `cri_ra`, `cri_r.9`, `tm30_rf`, `chromaticity_xy.0`; empty where we have none.
    pub key: &'static str,
    /// The label in the file.
    pub label: String,
    /// The figure, in the unit of the key.
    pub value: f64,
    /// The figure as printed, which tells its digits.
    pub text: String,
}

/// What a file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectrumFile {
    /// The format it was read as.
    pub format: Format,
    /// The spectra, in file order, at least one. Those on the same wavelengths share one grid.
    pub entries: Vec<Entry>,
    /// Facts of the file as a whole, label (or nothing) and text, in file order.
    pub metadata: Vec<(String, String)>,
}

/// A spectrum in SI: W or J, per m², sr, per nm (or per line), as its quantity asks.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Name in the file.
    pub name: String,
    /// What it is of.
    pub quantity: Quantity,
    /// The samples; relative ones as the file gives them.
    pub spectrum: Spectrum,
    /// Standard uncertainty of each sample, where the file has a column of it.
    pub standard: Option<Vec<f64>>,
}

/// The formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// CSV, TSV and other delimited text.
    Delimited,
    /// ANSI/IES TM-27-14 `.spdx`.
    Tm27,
    /// CGATS.17 / ISO 28178, X-Rite and Gretag tables.
    Cgats,
    /// JCAMP-DX 4.24 / 5.
    Jcamp,
    /// Ocean Optics OceanView and SpectraSuite text.
    OceanView,
    /// UPRtek `.xls` (text in truth).
    Uprtek,
    /// Sekonic CSV.
    Sekonic,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Delimited, Self::Tm27, Self::Cgats, Self::Jcamp, Self::OceanView, Self::Uprtek, Self::Sekonic];

    /// The word for it on the command line.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Delimited => "csv",
            Self::Tm27 => "tm27",
            Self::Cgats => "cgats",
            Self::Jcamp => "jcamp",
            Self::OceanView => "oceanview",
            Self::Uprtek => "uprtek",
            Self::Sekonic => "sekonic",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

impl FromStr for Format {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        Ok(match text.trim().to_lowercase().as_str() {
            "csv" | "tsv" | "delimited" | "text" | "txt" => Self::Delimited,
            "tm27" | "tm-27" | "tm-27-14" | "tm2714" | "spdx" => Self::Tm27,
            "cgats" | "cgats.17" | "it8" | "xrite" | "x-rite" => Self::Cgats,
            "jcamp" | "jcamp-dx" | "jdx" | "dx" => Self::Jcamp,
            "oceanview" | "spectrasuite" | "oceanoptics" => Self::OceanView,
            "uprtek" => Self::Uprtek,
            "sekonic" => Self::Sekonic,
            _ => {
                let kind = ErrorKind::UnknownFormat { found: text.to_owned() };
                return Err(Error::new(Location::default(), kind));
            }
        })
    }
}

/// Which way a delimited table lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Layout {
    /// One spectrum per column.
    Columns,
    /// One spectrum per row.
    Rows,
}

impl FromStr for Layout {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text.trim().to_lowercase().as_str() {
            "columns" | "column" => Ok(Self::Columns),
            "rows" | "row" => Ok(Self::Rows),
            _ => {
                let kind = ErrorKind::Unexpected { found: format!("`{text}`"), expected: "columns or rows".to_owned() };
                Err(Error::new(Location::default(), kind))
            }
        }
    }
}

/// What the user says about an input; whatever is `None` is told by content.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// The format.
    pub format: Option<Format>,
    /// The unit of the wavelengths.
    pub wavelength_unit: Option<WavelengthUnit>,
    /// What separates cells of delimited text; a blank means any number of blanks.
    pub separator: Option<char>,
    /// `.` or `,`.
    pub decimal: Option<char>,
    /// Which way delimited text lies.
    pub layout: Option<Layout>,
}

/// A place, with the name of the spectrum where it has one.
fn item(place: Location, name: &str) -> Location {
    if name.is_empty() { place } else { place.of_item(name) }
}

/// Bytes in which the format is looked for.
const DETECTION: usize = 64 * 1024;

/// Tells the format of an input from its first bytes; what is no other format is [`Format::Delimited`].
#[must_use]
pub fn detect(bytes: &[u8]) -> Format {
    let head = &bytes[..bytes.len().min(DETECTION)];
    let head = match text::utf16(head) {
        Some(encoding) => encoding.decode_with_bom_removal(head).0,
        None => String::from_utf8_lossy(head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head)),
    };
    let head = head.replace("\r\n", "\n").replace('\r', "\n");
    let told = [
        (Format::Tm27, tm27::matches(&head)),
        (Format::Jcamp, jcamp::matches(&head)),
        (Format::Cgats, cgats::matches(&head)),
        (Format::OceanView, oceanview::matches(&head)),
        (Format::Sekonic, sekonic::matches(&head)),
        (Format::Uprtek, uprtek::matches(&head)),
    ];
    told.iter().find(|(_, matches)| *matches).map_or(Format::Delimited, |(format, _)| *format)
}

/// Reads an input of any format.
///
/// # Errors
/// The first thing that is wrong, with its place.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<Checked<SpectrumFile>, Error> {
    if bytes.len() as u64 > LARGEST_WHOLE {
        return Err(Error::whole(ErrorKind::TooLarge { what: "an input", limit: LARGEST_WHOLE }));
    }
    let text::Text { text, finding } = text::decode(bytes)?;
    if text.trim().is_empty() {
        return Err(Error::whole(ErrorKind::Empty));
    }
    let mut file = match options.format.unwrap_or_else(|| detect(bytes)) {
        Format::Delimited => delimited::read(&text, options),
        Format::Tm27 => tm27::read(&text, options),
        Format::Cgats => cgats::read(&text, options),
        Format::Jcamp => jcamp::read(&text, options),
        Format::OceanView => oceanview::read(&text, options),
        Format::Uprtek => uprtek::read(&text, options),
        Format::Sekonic => sekonic::read(&text, options),
    }?;
    file.findings.splice(0..0, finding);
    Ok(file)
}

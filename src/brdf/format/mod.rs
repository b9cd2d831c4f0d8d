//! Reading and writing measured BRDFs: one file per format, formats told by content.

pub mod alta;
pub mod astm;
pub mod convert;
pub mod csv;
mod error;
pub mod klems;
pub mod merl;
pub mod rgl;
mod text;
pub mod utia;
pub mod zemax;

use std::fmt;

pub use error::{Error, ErrorKind};

use crate::brdf::table::Table;
use crate::finding::{Checked, Finding, Location};

/// The formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// MERL `.binary`.
    Merl,
    /// RGL `.bsdf` tensor file.
    Rgl,
    /// UTIA `.bin`.
    Utia,
    /// ASTM E1392, E2387.
    Astm,
    /// Zemax `.bsdf`.
    Zemax,
    /// WINDOW and Radiance XML.
    Klems,
    /// ALTA, text or binary.
    Alta,
    /// CSV of points.
    Csv,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 8] =
        [Self::Merl, Self::Rgl, Self::Utia, Self::Astm, Self::Zemax, Self::Klems, Self::Alta, Self::Csv];

    /// What a user calls it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Merl => "merl",
            Self::Rgl => "rgl",
            Self::Utia => "utia",
            Self::Astm => "astm",
            Self::Zemax => "zemax",
            Self::Klems => "klems",
            Self::Alta => "alta",
            Self::Csv => "csv",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Merl => "MERL",
            Self::Rgl => "RGL tensor file",
            Self::Utia => "UTIA",
            Self::Astm => "ASTM E1392",
            Self::Zemax => "Zemax",
            Self::Klems => "Klems XML",
            Self::Alta => "ALTA",
            Self::Csv => "CSV",
        })
    }
}

/// A table and what its file was.
#[derive(Debug, Clone, PartialEq)]
pub struct File {
    /// Format.
    pub format: Format,
    /// The table.
    pub table: Table,
    /// TIS that a Zemax file prints, per angle of incidence (first channel, first rotation); none in other formats.
    pub printed_tis: Vec<f64>,
}

/// Tells the format of an input; `None` where it is none of them.
///
/// RGL has a mark, MERL the numbers of bins that its length follows from, UTIA nothing but its length. Text is told by the words
/// that only one format has in its first 64 KiB. Zemax and RGL files share their ending, and are told apart so.
#[must_use]
pub fn detect(bytes: &[u8]) -> Option<Format> {
    if bytes.starts_with(rgl::MAGIC) {
        return Some(Format::Rgl);
    }
    if merl::is_merl(bytes) {
        return Some(Format::Merl);
    }
    if bytes.len() == utia::LENGTH && bytes.contains(&0) {
        return Some(Format::Utia);
    }
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 16)]);
    let line_with = |word: &str| start.lines().any(|l| l.trim_start().starts_with(word));
    if start.contains("<?xml") || start.contains("<WindowElement") {
        return Some(Format::Klems);
    }
    if line_with("#ALTA_BEGIN_HEADER") || line_with("#PARAM_IN") || line_with("#DIM") {
        return Some(Format::Alta);
    }
    if line_with("ScatterRadial") || line_with("AngleOfIncidence") || line_with("DataBegin") {
        return Some(Format::Zemax);
    }
    if line_with("VARS") {
        return Some(Format::Astm);
    }
    let csv = start.lines().find(|l| !l.trim().is_empty() && !l.starts_with('#'));
    csv.is_some_and(|l| l.to_ascii_lowercase().contains("theta_i")).then_some(Format::Csv)
}

/// Reads a file of any format; `format` where the user tells it.
///
/// Of an XML file the reflection from the front is taken, else that from the back; its other matrices are counted in a finding and
/// are had from [`klems::parse`].
///
/// # Errors
/// [`Error`] with its place, what was found and what was expected.
pub fn open(bytes: &[u8], format: Option<Format>) -> Result<Checked<File>, Error> {
    if bytes.is_empty() || bytes.len() < 1 << 16 && bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(Error::whole(ErrorKind::Empty));
    }
    let Some(format) = format.or_else(|| detect(bytes)) else { return Err(unknown(bytes)) };
    let mut printed_tis = Vec::new();
    let read = match format {
        Format::Merl => merl::parse(bytes)?.map(Table::HalfAngle),
        Format::Rgl => rgl::parse(bytes)?.map(Table::Adaptive),
        Format::Utia => utia::parse(bytes)?.map(Table::Angular),
        Format::Astm => astm::parse(bytes)?.map(Table::Points),
        Format::Zemax => zemax::parse(bytes)?.map(|z| {
            printed_tis.extend(z.printed.iter().take(z.table.incidences_deg().len()));
            Table::Specular(z.table)
        }),
        Format::Klems => reflection(klems::parse(bytes)?)?,
        Format::Alta => alta::parse(bytes)?.map(Table::Points),
        Format::Csv => csv::parse(bytes)?.map(Table::Points),
    };
    Ok(read.map(|table| File { format, table, printed_tis }))
}

/// The reflection matrix of an XML file.
fn reflection(read: Checked<Vec<klems::Block>>) -> Result<Checked<Table>, Error> {
    let Checked { value: blocks, mut findings } = read;
    let order = ["Reflection Front", "Reflection Back"];
    let at = order.iter().find_map(|name| blocks.iter().position(|b| b.direction == *name));
    let Some(at) = at else {
        let found = format!("{} matrices, none of them of reflection", blocks.len());
        return Err(Error::whole(ErrorKind::unexpected(found, "`Reflection Front` or `Reflection Back`")));
    };
    let others: Vec<String> = blocks
        .iter()
        .enumerate()
        .filter(|(i, _)| *i != at)
        .map(|(_, b)| format!("{} {}", b.wavelength, b.direction))
        .collect();
    if !others.is_empty() {
        let taken = format!("{} {}", blocks[at].wavelength, blocks[at].direction);
        findings.push(Finding::info("B106", format!("{taken} was taken; the file also holds {}", others.join(", "))));
    }
    let block = blocks.into_iter().nth(at).expect("just found");
    Ok(Checked { value: Table::Patches(block.patches), findings })
}

fn unknown(bytes: &[u8]) -> Error {
    let found = match bytes.get(..4) {
        Some(b"PK\x03\x04") => "a ZIP archive".to_owned(),
        Some([0x1f, 0x8b, ..]) => "a gzip archive".to_owned(),
        _ if bytes.iter().take(1000).any(|b| *b == 0) => format!("{} bytes of another binary format", bytes.len()),
        _ => {
            let line = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
            format!(
                "text that begins with `{}`",
                line.trim_start().lines().next().unwrap_or("").chars().take(60).collect::<String>()
            )
        }
    };
    let hint = "a MERL file that was cut off is no longer as long as its header says: name the format to see how much is missing";
    Error::new(Location::default(), ErrorKind::Unknown { found }).with_hint(hint)
}

//! Reading and writing luminaire files: one file per format, formats told by content.

mod error;
pub mod eulumdat;
pub mod ies;
pub mod plausible;
mod text;
pub mod tm33;

pub use error::{Error, ErrorKind};

use std::fmt;

use crate::finding::Checked;
use crate::luminaire::Luminaire;

/// The formats that are read and written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// IES LM-63.
    Ies,
    /// EULUMDAT.
    Eulumdat,
    /// TM-33, ATLA S001, UNI 11733.
    Tm33,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ies => "LM-63",
            Self::Eulumdat => "EULUMDAT",
            Self::Tm33 => "TM-33",
        })
    }
}

/// What the user says about an input; whatever is `None` is told by content.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// The format.
    pub format: Option<Format>,
    /// Repair what can be repaired safely; each repair is listed among the findings.
    pub repair: bool,
}

/// A luminaire and what its file was.
#[derive(Debug, Clone, PartialEq)]
pub struct File {
    /// Format.
    pub format: Format,
    /// Edition of the format, as the standard names it.
    pub version: String,
    /// The luminaire.
    pub luminaire: Luminaire,
}

/// Tells the format of an input; `None` where it is none of them.
///
/// XML is TM-33; a line that begins with `TILT=` or `IESNA` is LM-63's and no other format's; a table of lines that begin like
/// EULUMDAT's (maker, a type of 0 to 3, a symmetry of 0 to 4) is EULUMDAT's.
#[must_use]
pub fn detect(bytes: &[u8]) -> Option<Format> {
    let text = text::decode(bytes).ok()?.text;
    let start = text.trim_start();
    if start.starts_with('<') {
        return Some(Format::Tm33);
    }
    // Old files end their lines with CR alone.
    let plain = text.replace("\r\n", "\n").replace('\r', "\n");
    let mut lines = plain.lines().map(str::trim);
    let ies = |line: &str| {
        let upper: String = line.chars().filter(|c| !c.is_whitespace()).take(12).collect::<String>().to_uppercase();
        upper.starts_with("TILT=") || upper.starts_with("IESNA") || upper.starts_with("IES:LM-63")
    };
    if lines.clone().any(ies) {
        return Some(Format::Ies);
    }
    let number = |line: Option<&str>| line.and_then(|l| l.replace(',', ".").parse::<f64>().ok());
    // The first line is the maker, and may be empty.
    lines.next()?;
    let (kind, symmetry) = (number(lines.next()), number(lines.next()));
    let whole = |v: Option<f64>, most: f64| v.is_some_and(|v| (0.0..=most).contains(&v) && v.fract() == 0.0);
    // A symmetry out of range is EULUMDAT's own error to tell.
    (whole(kind, 9.0) && whole(symmetry, 99.0)).then_some(Format::Eulumdat)
}

/// Reads a file of any format, with what it was.
///
/// # Errors
/// [`Error`] with its place, what was found and what was expected.
pub fn open(bytes: &[u8], options: &ReadOptions) -> Result<Checked<File>, Error> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(Error::whole(ErrorKind::Empty));
    }
    text::decode(bytes)?;
    // A file without any mark of a format is most likely an LM-63 file that has lost its TILT line, which its reader explains.
    match options.format.or_else(|| detect(bytes)).unwrap_or(Format::Ies) {
        Format::Ies => {
            let Checked { value, mut findings } = ies::parse_with(bytes, ies::ReadOptions { repair: options.repair })?;
            let version = value.version.to_string();
            let bridged = value.into_luminaire()?;
            findings.extend(bridged.findings);
            Ok(Checked { value: File { format: Format::Ies, version, luminaire: bridged.value }, findings })
        }
        Format::Eulumdat => Ok(eulumdat::read_with(bytes, eulumdat::ReadOptions { repair: options.repair })?
            .map(|luminaire| File { format: Format::Eulumdat, version: "EULUMDAT".to_owned(), luminaire })),
        Format::Tm33 => {
            let Checked { value, mut findings } = tm33::parse(bytes)?;
            let version = edition(value.schema).to_owned();
            let bridged = Checked::<Luminaire>::try_from(&value)?;
            findings.extend(bridged.findings);
            Ok(Checked { value: File { format: Format::Tm33, version, luminaire: bridged.value }, findings })
        }
    }
}

/// The name of a TM-33 edition.
fn edition(schema: tm33::Schema) -> &'static str {
    match schema {
        tm33::Schema::Tm33Of2018 => "TM-33-18",
        tm33::Schema::Tm33Of2023 => "TM-33-23",
        tm33::Schema::AtlaS001 => "ATLA S001",
        tm33::Schema::Uni11733 => "UNI 11733",
        tm33::Schema::OpticalData => "LuminaireOpticalData",
    }
}

/// Reads a file of any format.
///
/// # Errors
/// As [`open`].
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<Checked<Luminaire>, Error> {
    Ok(open(bytes, options)?.map(|file| file.luminaire))
}

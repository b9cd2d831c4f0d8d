//! Reading and writing luminaire files: one file per format, formats told by content.

mod error;
pub mod eulumdat;
pub mod ies;
pub mod plausible;
mod text;
pub mod tm33;

pub use error::{Error, ErrorKind};

use std::fmt;

use self::text::{Line, Text};
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
    told_by(&text::decode(bytes).ok()?)
}

fn told_by(text: &Text<'_>) -> Option<Format> {
    if text.text.trim_start().starts_with('<') {
        return Some(Format::Tm33);
    }
    let ies = |line: Line<'_>| {
        let bare = line.text.chars().filter(|c| !c.is_whitespace()).take(12);
        let upper: String = bare.map(|c| c.to_ascii_uppercase()).collect();
        upper.starts_with("TILT=") || upper.starts_with("IESNA") || upper.starts_with("IES:LM-63")
    };
    if text.lines().any(ies) {
        return Some(Format::Ies);
    }
    let number = |line: &Line<'_>| line.text.trim().replace(',', ".").parse::<f64>().ok();
    let first: Vec<Line<'_>> = text.lines().take(5).collect();
    // The first line is the maker, and may be empty. A transfer may have doubled the line ends.
    let doubled = [1, 3].iter().all(|&i| first.get(i).is_some_and(|line: &Line<'_>| line.text.trim().is_empty()));
    let step = if doubled { 2 } else { 1 };
    let [kind, symmetry] = [1, 2].map(|i| first.get(i * step).and_then(number));
    let whole = |v: Option<f64>, most: f64| v.is_some_and(|v| (0.0..=most).contains(&v) && v.fract() == 0.0);
    // A symmetry out of range is EULUMDAT's own error to tell.
    (whole(kind, 9.0) && whole(symmetry, 99.0)).then_some(Format::Eulumdat)
}

/// Refuses by its name a format that is told by its first line and not read.
fn unsupported(text: &Text<'_>) -> Result<(), Error> {
    let first = text.lines().find(|line| !line.text.trim().is_empty());
    match first {
        Some(line) if line.text.trim_start().get(..4).is_some_and(|word| word.eq_ignore_ascii_case("CIEF")) => {
            let kind = ErrorKind::Unexpected {
                found: "a CIE 102 file (`CIEF`), which is not supported".to_owned(),
                expected: "an LM-63, EULUMDAT or TM-33 file".to_owned(),
            };
            Err(Error::at(line.number, 1, kind)
                .with_hint("makers who give CIE 102 files give the same lamp as .ies or .ldt too"))
        }
        _ => Ok(()),
    }
}

/// Reads a file of any format, with what it was.
///
/// CIE 102 (`CIEF=`), of which no definition is public, is refused by its name.
///
/// # Errors
/// [`Error`] with its place, what was found and what was expected.
pub fn open(bytes: &[u8], options: &ReadOptions) -> Result<Checked<File>, Error> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(Error::whole(ErrorKind::Empty));
    }
    let text = text::decode(bytes)?;
    let repair = options.repair;
    // A file without any mark of a format is most likely an LM-63 file that has lost its TILT line, which its reader explains.
    let format = match options.format.or_else(|| told_by(&text)) {
        Some(format) => format,
        None => {
            unsupported(&text)?;
            Format::Ies
        }
    };
    let (version, mut findings, bridged) = match format {
        Format::Ies => {
            let Checked { value, findings } = ies::parse_text(&text, ies::ReadOptions { repair })?;
            (value.version.to_string(), findings, value.into_luminaire()?)
        }
        Format::Eulumdat => {
            let Checked { value, findings } = eulumdat::parse_text(&text, eulumdat::ReadOptions { repair })?;
            ("EULUMDAT".to_owned(), findings, Checked::<Luminaire>::try_from(&value)?)
        }
        Format::Tm33 => {
            let Checked { value, findings } = tm33::parse_text(&text)?;
            (edition(value.schema).to_owned(), findings, Checked::<Luminaire>::try_from(&value)?)
        }
    };
    findings.extend(bridged.findings);
    Ok(Checked { value: File { format, version, luminaire: bridged.value }, findings })
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

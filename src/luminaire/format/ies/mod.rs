//! IES LM-63: the file format of North American luminaire photometry, editions of 1986, 1991, 1995, 2002 and 2019.
//!
//! [`RawIes`] is faithful to the file: what it says, in its own units and signs. [`parse`] makes it from bytes,
//! [`RawIes::into_luminaire`] is the bridge to [`Luminaire`], [`write`](fn@write) goes the other way, [`read`] does the first two.
//!
//! # Layout
//! ```text
//! version line                          none in 1986
//! [KEYWORD] text, [MORE] text           free lines in 1986
//! TILT=NONE | INCLUDE | file name       INCLUDE: lamp geometry, n, n angles, n factors
//! lamps  lumens  multiplier  n_v  n_h  type  units  width  length  height
//! ballast-factor  photometric-factor  input-watts
//! n_v vertical angles   n_h horizontal angles   n_h × n_v candela
//! ```
//! The intensity is candela × multiplier × ballast factor × ballast-lamp photometric factor. In 2002 the last one is "reserved"
//! (and still applied where it is not 1, with a finding); in 2019 it is the file-generation code and no factor.
//!
//! Delimiters are commas and blanks, lines may be broken anywhere. Numbers with decimal commas are read where the file makes
//! sense in no other way. NaN, a missing line, too few or too many numbers, contradictory counts and unknown types are refused.
//!
//! # Findings
//! | code | severity | meaning |
//! |---|---|---|
//! | L001 | info | no version line; read as LM-63-1986 |
//! | L002 | warning | a version line of no known edition; read as LM-63-2002 |
//! | L003 | info | the version line is not written as the standard has it |
//! | L004 | info | the TILT line is not written as the standard has it |
//! | L005 | info | the tilt factors are in another file; the intensities hold for the position tested |
//! | L006 | warning | tilt factors that are not 1 at 0°, or angles out of order; kept, not applied |
//! | L007 | info | text after the table was not read |
//! | L008 | info | keywords that the edition requires are missing or empty |
//! | L009 | info | keywords that are not LM-63's and lack the leading `_` |
//! | L010 | info | a line without keyword, or `[MORE]` that continues nothing |
//! | L011 | info | lines longer than the edition allows |
//! | L012 | warning | numbers have decimal commas |
//! | L013 | warning | a ballast-lamp photometric factor where LM-63-2002 reserves the field: applied, or ignored where 0 |
//! | L014 | info | a file-generation code that LM-63-2019 does not list |
//! | L015 | warning | lumens per lamp of 0, or a number of lamps of 0: lamp flux not known |
//! | L016 | info, warning | input watts of 0 (not known) or below 0 (not used) |
//! | L017 | info, warning | signs of the opening that belong to another edition, or mean nothing |
//! | L018 | warning | a luminous opening of more than 20 m: wrong unit? |
//! | L020 | info | descending angles were reversed |
//! | L021 | warning | vertical angles do not begin and end where the standard asks |
//! | L022 | warning | the plane of 360° is missing; the first one closes the turn |
//! | L023 | warning | the planes of 0° and 360° differ |
//! | L024 | info | the only plane is not at 0° |
//! | L025 | info | radiometric file: intensities in W/sr, and by which words |
//! | L026 | warning | words of ultraviolet or radiometry, but no unit: intensities taken as candela |
//! | L030 | warning | repaired: numbers after the table were left out |
//! | L031 | warning | repaired: the nadir row was added |
//! | L032 | warning | repaired: a factor of 0 was taken as 1 |
//! | L040 | info, warning | writing: what LM-63 or its edition cannot carry |
//! | L041 | info | writing: characters outside ASCII were replaced |
//! | L042 | info | writing: required keywords that the luminaire does not have were filled with `unknown` |
//! | L043 | info | writing: keywords that are not LM-63's were given the leading `_` |
//!
//! Findings of every format (L101 and L110 to L116): see [`plausible`](super::plausible).

mod angles;
mod bridge;
mod header;
mod label;
mod number;
mod opening;
mod parse;
mod radiometric;
mod scan;
mod table;
mod tilt;
mod version;
mod write;

pub(super) use parse::parse_text;
pub use parse::{ReadOptions, parse, parse_with};
pub use tilt::TiltTable;
pub use version::{Version, file_generation};
pub use write::write;

use super::error::Error;
use crate::finding::Checked;
use crate::luminaire::{Luminaire, System};

/// A keyword with its text, or a line without keyword.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Keyword {
    /// In capitals, without brackets; empty for a line without keyword.
    pub name: String,
    /// Its text; lines of `[MORE]` joined with `\n`.
    pub text: String,
    /// Line of the file, from 1.
    pub line: u64,
}

/// How a lamp's output depends on the luminaire's tilt.
#[derive(Debug, Clone, PartialEq)]
pub enum Tilt {
    /// It does not.
    None,
    /// The table is in the file.
    Include(TiltTable),
    /// The table is in the file named: see [`TiltTable::parse`].
    File(String),
}

/// The unit of the luminous opening.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Units {
    /// 1: feet of 0.3048 m.
    Feet,
    /// 2.
    Metres,
}

impl Units {
    /// Metres in one unit.
    #[must_use]
    pub fn metres(self) -> f64 {
        match self {
            Self::Feet => 0.3048,
            Self::Metres => 1.0,
        }
    }
}

/// An LM-63 file as it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct RawIes {
    /// Edition whose rules hold.
    pub version: Version,
    /// The version line as written; `None` where the file has none.
    pub version_line: Option<String>,
    /// Keywords and lines without keyword, in order.
    pub keywords: Vec<Keyword>,
    /// Tilt.
    pub tilt: Tilt,
    /// Number of lamps.
    pub lamps: f64,
    /// Rated lumens of one lamp; `None` for absolute photometry (−1).
    pub lumens_per_lamp: Option<f64>,
    /// Candela multiplier.
    pub multiplier: f64,
    /// Photometric type: C is 1, B is 2, A is 3.
    pub system: System,
    /// Unit of the luminous opening.
    pub units: Units,
    /// Width, length and height of the luminous opening with their signs, in `units`.
    pub opening: [f64; 3],
    /// Ballast factor.
    pub ballast_factor: f64,
    /// Ballast-lamp photometric factor (to 1995), reserved (2002) or file-generation code (2019).
    pub photometric_factor: f64,
    /// Input watts.
    pub input_watts: f64,
    /// Vertical angles in degrees, as they stand (ascending or descending).
    pub vertical_deg: Vec<f64>,
    /// Horizontal angles in degrees, as they stand (ascending or descending).
    pub horizontal_deg: Vec<f64>,
    /// Candela values before any factor, plane by plane: `candela[plane * vertical_deg.len() + row]`.
    pub candela: Vec<f64>,
}

impl RawIes {
    /// The factor from the file's values to intensities: multiplier × ballast factor × photometric factor as the edition has it.
    #[must_use]
    pub fn factor(&self) -> f64 {
        self.multiplier * self.ballast_factor * self.applied_photometric_factor()
    }

    /// The ballast-lamp photometric factor, where the edition has one: 1 in LM-63-2019, whose file-generation code is no factor.
    #[must_use]
    pub fn applied_photometric_factor(&self) -> f64 {
        match self.version {
            Version::Lm63_2019 => 1.0,
            Version::Lm63_2002 if self.photometric_factor == 0.0 => 1.0,
            _ => self.photometric_factor,
        }
    }

    /// The text of a keyword, the first of several.
    #[must_use]
    pub fn keyword(&self, name: &str) -> Option<&str> {
        self.keywords.iter().find(|k| k.name == name).map(|k| k.text.as_str())
    }
}

/// Reads a file into a [`Luminaire`], with everything noticed on the way.
///
/// # Errors
/// As [`parse_with`] and [`RawIes::into_luminaire`].
pub fn read(bytes: &[u8], options: ReadOptions) -> Result<Checked<Luminaire>, Error> {
    let Checked { value, mut findings } = parse_with(bytes, options)?;
    let luminaire = value.into_luminaire()?;
    findings.extend(luminaire.findings);
    Ok(Checked { value: luminaire.value, findings })
}

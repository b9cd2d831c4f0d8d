//! EULUMDAT (`.ldt`): A. Stockmar, "EULUMDAT – ein Leuchtendatenformat für den europäischen Beleuchtungsplaner", Licht '90,
//! and "EULUMDAT/2", CIBSE National Lighting Conference 1998. One value per line:
//!
//! | lines | field |
//! |---|---|
//! | 1 | company, data bank, version |
//! | 2, 3 | Ityp, Isym |
//! | 4, 5 | Mc, Dc: number of C-planes in the full turn, their distance (0 where uneven) |
//! | 6, 7 | Ng, Dg: number of γ in each plane, their distance (0 where uneven) |
//! | 8–12 | report number, luminaire name, luminaire number, file name, date and user |
//! | 13–15 | luminaire: length or diameter, width (0: round), height, mm |
//! | 16–21 | luminous area: length or diameter, width (0: round), heights at C0, C90, C180, C270, mm |
//! | 22, 23 | DFF (downward flux fraction), LORL (light output ratio of the luminaire), % |
//! | 24, 25 | conversion factor of the intensities, tilt during the measurement, ° |
//! | 26 | number n of standard sets of lamps |
//! | next 6 n | per set: number of lamps (negative: absolute photometry), type, flux of all its lamps in lm, colour, rendering, power with ballast in W |
//! | next 10 | direct ratios for the room indices 0.6, 0.8, 1, 1.25, 1.5, 2, 2.5, 3, 4, 5 |
//! | next Mc, Ng | C-angles of the full turn, γ angles, ° |
//! | rest | intensities in cd/klm, plane by plane |
//!
//! The planes whose intensities follow are Mc (Isym 0), 1 (Isym 1), Mc/2 + 1 from C0 (Isym 2), Mc/2 + 1 from C270 over C0 to
//! C90 (Isym 3), Mc/4 + 1 from C0 (Isym 4). An intensity in candela is the value × flux of the lamps / 1000 × conversion
//! factor; the sets of lamps are alternatives, of which the first scales unless another is asked for
//! ([`Eulumdat::luminaire`]).
//!
//! # Findings
//!
//! | code | severity | meaning |
//! |---|---|---|
//! | L201 | info | a number is missing (an empty line) where it does not scale the light; 0 taken |
//! | L202 | info | numbers with decimal commas were read |
//! | L203 | info | a number of the header has its unit behind it |
//! | L204 | warning | the power of a set of lamps is no number; none taken |
//! | L205 | info | every second line is blank and was left out |
//! | L206 | info | text behind the last intensity was not read |
//! | L207 | info | angles do not ascend from 0°; planes were put in order |
//! | L208 | warning | Dc or Dg contradicts the list of angles; the list was taken |
//! | L209 | warning | the planes given are not those that Isym and Mc ask for, but certain from the list and the numbers present |
//! | L210 | warning | Isym 0 with a single plane; taken as symmetric about the vertical axis |
//! | L211 | info | Ityp is none of those defined, or contradicts Isym; it changes no figure |
//! | L212 | info | several sets of lamps; which one scales |
//! | L213 | info | a conversion factor other than 1 was applied |
//! | L214 | warning | LORL above 100 % |
//! | L215 | warning | direct ratios outside of 0–1 or falling with the room index |
//! | L216 | warning | a gap between C-planes three times as wide as the next widest: the file may have a part of the planes only |
//! | L217 | warning | a negative dimension (taken as 0), or a luminous area larger than its luminaire |
//! | L218 | warning | the number of lamps is 0 |
//! | L219 | info | γ ends below 90°, or starts between 0° and 90°: zero intensity is assumed beyond |
//! | L230 | warning | repaired: a conversion factor of 0 was taken as 1 |
//! | L231 | warning | repaired: numbers behind the table were left out |
//! | L232 | warning | repaired: several numbers on a line were read from left to right |
//! | L290 | info, warning | writing: something that the format cannot carry, or had to be changed |
//!
//! Findings of every format (L101 and L110 to L116: encoding, flux against LORL, DFF, poles, negative or no light): see
//! [`plausible`](super::plausible).

mod bridge;
mod checks;
mod fields;
mod layout;
mod parse;
mod planes;
mod write;

pub(super) use parse::parse_text;
pub use parse::{ReadOptions, parse, parse_with};
pub use write::write;

use super::error::Error;
use crate::finding::Checked;
use crate::luminaire::Luminaire;

/// Room indices k of the ten direct ratios.
pub const ROOM_INDICES: [f64; 10] = [0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0];

/// Isym (line 3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Isym {
    /// 0: no symmetry.
    None,
    /// 1: symmetry about the vertical axis.
    Vertical,
    /// 2: symmetry to the plane C0–C180.
    C0C180,
    /// 3: symmetry to the plane C90–C270.
    C90C270,
    /// 4: symmetry to the planes C0–C180 and C90–C270.
    Both,
}

impl Isym {
    /// The number that stands for it.
    #[must_use]
    pub fn number(self) -> u8 {
        match self {
            Self::None => 0,
            Self::Vertical => 1,
            Self::C0C180 => 2,
            Self::C90C270 => 3,
            Self::Both => 4,
        }
    }

    /// Number of planes with intensities for `plane_count` (Mc) planes in the full turn.
    #[must_use]
    pub fn stored_planes(self, plane_count: usize) -> usize {
        match self {
            Self::None => plane_count,
            Self::Vertical => 1,
            Self::C0C180 | Self::C90C270 => plane_count / 2 + 1,
            Self::Both => plane_count / 4 + 1,
        }
    }
}

/// Six lines on one set of lamps.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LampSetLines {
    /// Number of lamps; negative for absolute photometry.
    pub number: f64,
    /// Type of lamps.
    pub lamp_type: String,
    /// Total luminous flux of the lamps, lm (for absolute photometry: of the luminaire).
    pub flux_lm: f64,
    /// Colour appearance or temperature.
    pub colour: String,
    /// Colour rendering group or index.
    pub rendering: String,
    /// Power including ballast, W; `None` where the line is empty or no number.
    pub power_w: Option<f64>,
}

/// Which planes the intensities belong to.
#[derive(Debug, Clone, PartialEq)]
pub enum Stored {
    /// One plane for all (Isym 1).
    One,
    /// All of the planes listed, in their order (Isym 0, or against Isym: finding L209).
    All,
    /// The planes of these indices of the list, in this order (Isym 2, 3, 4).
    Some(Vec<usize>),
}

/// An EULUMDAT file, line by line; texts without their enclosing blanks.
#[derive(Debug, Clone, PartialEq)]
pub struct Eulumdat {
    /// Line 1: company, data bank, version, format.
    pub company: String,
    /// Line 2, Ityp: 1 point source with symmetry about the vertical axis, 2 linear luminaire, 3 point source with any other
    /// symmetry (0 in EULUMDAT/2: point source without symmetry).
    pub type_indicator: i64,
    /// Line 3, Isym.
    pub symmetry: Isym,
    /// Line 4, Mc: number of C-planes in the full turn.
    pub plane_count: usize,
    /// Line 5, Dc: distance of C-planes, °; 0 where uneven.
    pub plane_step_deg: f64,
    /// Line 6, Ng: number of intensities in a plane.
    pub gamma_count: usize,
    /// Line 7, Dg: distance of γ, °; 0 where uneven.
    pub gamma_step_deg: f64,
    /// Line 8.
    pub report_number: String,
    /// Line 9.
    pub luminaire_name: String,
    /// Line 10.
    pub luminaire_number: String,
    /// Line 11.
    pub file_name: String,
    /// Line 12.
    pub date_user: String,
    /// Line 13: length or diameter of the luminaire, mm.
    pub length_mm: f64,
    /// Line 14: width of the luminaire, mm; 0 where round.
    pub width_mm: f64,
    /// Line 15: height of the luminaire, mm.
    pub height_mm: f64,
    /// Line 16: length or diameter of the luminous area, mm.
    pub opening_length_mm: f64,
    /// Line 17: width of the luminous area, mm; 0 where round.
    pub opening_width_mm: f64,
    /// Lines 18–21: height of the luminous area towards C0, C90, C180, C270, mm.
    pub opening_heights_mm: [f64; 4],
    /// Line 22, DFF: downward flux fraction, %.
    pub downward_flux_percent: f64,
    /// Line 23, LORL: light output ratio of the luminaire, %.
    pub light_output_ratio_percent: f64,
    /// Line 24: conversion factor of the intensities.
    pub conversion_factor: f64,
    /// Line 25: tilt of the luminaire during measurement, °.
    pub tilt_deg: f64,
    /// Line 26 and the six lines of each set: at least one.
    pub lamp_sets: Vec<LampSetLines>,
    /// Direct ratios at [`ROOM_INDICES`].
    pub direct_ratios: [f64; 10],
    /// Angles of the C-planes as listed, °.
    pub plane_angles_deg: Vec<f64>,
    /// γ as listed, °.
    pub gamma_angles_deg: Vec<f64>,
    /// The planes that the intensities belong to.
    pub stored: Stored,
    /// Intensities, cd per 1000 lm of lamp flux, before the conversion factor: plane by plane of `stored`.
    pub intensities_cd_per_klm: Vec<f64>,
}

/// Reads a file into the model; the first set of lamps scales. Findings of reading and of the bridge together.
///
/// # Errors
/// [`Error`] with line, found, expected.
pub fn read(bytes: &[u8]) -> Result<Checked<Luminaire>, Error> {
    read_with(bytes, ReadOptions::default())
}

/// The same with options.
///
/// # Errors
/// As [`read`].
pub fn read_with(bytes: &[u8], options: ReadOptions) -> Result<Checked<Luminaire>, Error> {
    let Checked { value, mut findings } = parse_with(bytes, options)?;
    let luminaire = Checked::<Luminaire>::try_from(&value)?;
    findings.extend(luminaire.findings);
    Ok(Checked { value: luminaire.value, findings })
}

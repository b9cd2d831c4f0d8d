//! TM-33 XML: ANSI/IES TM-33-18 and TM-33-23, ATLA S001 and UNI 11733 (one schema under four names), and the
//! `LuminaireOpticalData` variant that the `eulumdat` crates write.
//!
//! [`Tm33`] holds what a file says about its emitters: luminous, radiant, photon and angular-spectral intensity, spectra, emission
//! areas. [`parse`] makes it from bytes, [`Tm33::luminaire`] is the bridge to [`Luminaire`], [`read`] does both, [`write`](fn@write)
//! makes a TM-33-23 document.
//!
//! - Intensities are cd, W/sr, µmol/(s·sr) and W/(sr·nm), times `Multiplier`; no other factor is applied, neither `Quantity`
//!   nor `RatedLumens` nor `BallastFactor` nor `ChannelMult`. The model's distribution is the sum of all emitters.
//! - Dimensions are metres. Length lies along C90–C270 (it is the extent of the faces towards C0 and C180), width along C0–C180.
//! - Planes: `Symm_Full` one, `Symm_Quad` 0–90°, `Symm_Bi_0` 0–180°, `Symm_Bi_90` 90–270°, `Symm_None` the full turn. TM-33-18
//!   has no `Symm`: the range of the planes tells, as in LM-63.
//! - The angular-spectral table, one spectrum per direction, comes into the model as it is (the emitters' added up). Where the
//!   file has no other intensity, the model's is its luminous sum (683.002 lm/W, V(λ) of CIE 018:2019, straight lines
//!   between the samples); where it has no other spectrum, the model's is the sum over the sphere.
//!
//! # Findings
//!
//! | code | severity | meaning |
//! |---|---|---|
//! | L301 | info | elements of the `LuminaireOpticalData` variant, which none of the published schemas has |
//! | L302 | info | no `Symm` (or `Symm_Arbitrary`): symmetry taken from the range of the planes |
//! | L303 | warning | `Symm` says another symmetry than the planes given, which were taken |
//! | L304 | warning | `NumberMeasured` or `NumberWavelength` is not the number of values given |
//! | L305 | info | dimensions too large for metres were taken as millimetres |
//! | L306 | info, warning | several emitters were added up; or one has no intensity of the kind and is not in the sum |
//! | L307 | warning | the intensities integrate to 1000 lm where the emitters are rated otherwise: cd per 1000 lm, left unscaled by whoever converted the file? |
//! | L308 | warning | a quantity of emitters that cannot be |
//! | L309 | info | parts of the file that the model has no place for |
//! | L310 | info | the gonioradiometer is of Type A or B, the angles are those of Type C |
//! | L311 | info | a multiplier other than 1 was applied |
//! | L312 | info | several kinds of intensity; which one was taken |
//! | L313 | warning | spectra that cannot be added up (relative, or of different wavelengths); none taken |
//! | L314 | warning | the flux of the angular spectra is not that of the other intensities (5 %) |
//! | L315 | info | elements that the schema requires are missing |
//! | L316 | warning | angular spectra of some emitters only, or of different wavelengths; none taken |
//! | L390 | info, warning | writing: something that TM-33-23 cannot carry, or that had to be filled in |
//!
//! Findings of every format (L101 and L110 to L116): see [`plausible`](super::plausible).

mod angular;
mod bodies;
mod bridge;
mod emitter;
mod lexical;
mod parse;
mod planes;
mod spectral;
mod table;
mod write;
mod xml;

pub use parse::parse;
pub(super) use parse::parse_text;
pub use write::write;

use std::fmt;

use super::error::Error;
use crate::finding::{Checked, Location};
use crate::luminaire::{Kind, Luminaire};
use crate::spectrum::Spectrum;

/// By which name the document calls itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Schema {
    /// `<IESTM33>`: ANSI/IES TM-33-18.
    Tm33Of2018,
    /// `<IESTM33-22>`: ANSI/IES TM-33-23.
    Tm33Of2023,
    /// `<ATLA_S001_A>`: ATLA S001.
    AtlaS001,
    /// `<UNI11733>`: UNI 11733:2019.
    Uni11733,
    /// `<LuminaireOpticalData>`: as the `eulumdat` crates write it.
    OpticalData,
}

impl fmt::Display for Schema {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Tm33Of2018 => "TM-33-18",
            Self::Tm33Of2023 => "TM-33-23",
            Self::AtlaS001 => "ATLA S001",
            Self::Uni11733 => "UNI 11733",
            Self::OpticalData => "LuminaireOpticalData",
        })
    }
}

/// `Symm`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Symm {
    /// All planes.
    None,
    /// Mirrored about C0–C180.
    Bi0,
    /// Mirrored about C90–C270.
    Bi90,
    /// Mirrored about both.
    Quad,
    /// One plane for all.
    Full,
    /// None of these.
    Arbitrary,
}

/// The gonioradiometer's type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Goniometer {
    /// CIE or IES Type A.
    A,
    /// CIE or IES Type B.
    B,
    /// CIE or IES Type C.
    C,
    /// Any other.
    Custom,
}

/// A table of intensities of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct IntensityTable {
    /// What the values are: cd, W/sr, µmol/(s·sr).
    pub kind: Kind,
    /// `AbsolutePhotometry` or `Absolute`, where stated.
    pub absolute: Option<bool>,
    /// Symmetry, where stated.
    pub symmetry: Option<Symm>,
    /// Factor of the values; 1 where not stated.
    pub multiplier: f64,
    /// Horizontal angles, °, ascending.
    pub horizontal_deg: Vec<f64>,
    /// Vertical angles, °, ascending.
    pub vertical_deg: Vec<f64>,
    /// Values before the multiplier, plane by plane: `values[plane * vertical_deg.len() + row]`.
    pub values: Vec<f64>,
    /// `LuminousFlux`, `RadiantFlux`, `PhotonFlux`: lm, W, µmol/s.
    pub flux: Option<f64>,
    /// `MinWavelength` and `MaxWavelength` of radiant and photon data, nm.
    pub wavelength_range_nm: Option<(f64, f64)>,
    /// Where the table stands.
    pub location: Location,
}

/// Spectral intensity over direction: W/(sr·nm).
#[derive(Debug, Clone, PartialEq)]
pub struct AngularSpectral {
    /// `Absolute`, where stated.
    pub absolute: Option<bool>,
    /// Symmetry, where stated.
    pub symmetry: Option<Symm>,
    /// Factor of the values; 1 where not stated.
    pub multiplier: f64,
    /// Horizontal angles, °, ascending.
    pub horizontal_deg: Vec<f64>,
    /// Vertical angles, °, ascending.
    pub vertical_deg: Vec<f64>,
    /// Wavelengths, nm, ascending.
    pub wavelengths_nm: Vec<f64>,
    /// Values before the multiplier: `values[(plane * vertical_deg.len() + row) * wavelengths_nm.len() + wavelength]`.
    pub values: Vec<f64>,
    /// Where the table stands.
    pub location: Location,
}

/// The spectrum of an emitter as a whole.
#[derive(Debug, Clone, PartialEq)]
pub struct EmitterSpectral {
    /// `EmitterName`.
    pub name: String,
    /// Whether the values are relative; `None` where not stated.
    pub normalized: Option<bool>,
    /// Spectral power, multiplier applied: W/nm, or relative.
    pub spectrum: Spectrum,
}

/// The side of the luminaire that an emission area is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Face {
    /// Upwards.
    Top,
    /// Downwards.
    Bottom,
    /// Towards a C-angle, °.
    Side(u16),
}

/// One `…Area`: metres as written (see finding L305).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EmissionArea {
    /// Side.
    pub face: Face,
    /// Extent along the first of its directions: length (top, bottom, C0, C180) or width (C90, C270).
    pub along: f64,
    /// Extent along the second: width (top, bottom) or height.
    pub across: f64,
    /// Offsets of its centre in the same directions.
    pub offsets: (f64, f64),
    /// Circle or ellipse.
    pub circular: bool,
}

/// One `Emitter`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Emitter {
    /// Number of emitters.
    pub quantity: Option<f64>,
    /// Description.
    pub description: String,
    /// Catalogue number.
    pub catalogue_number: String,
    /// Rated flux, lm; 0 in files of absolute photometry.
    pub rated_lumens: Option<f64>,
    /// Flux measured, lm (`LuminaireOpticalData` variant).
    pub measured_lumens: Option<f64>,
    /// Input power, W.
    pub input_power_w: Option<f64>,
    /// `FixedCCT`, K.
    pub cct_k: Option<f64>,
    /// CIE R_a.
    pub ra: Option<f64>,
    /// Tables of intensity, at most one of each kind.
    pub intensities: Vec<IntensityTable>,
    /// Spectra of the whole.
    pub spectra: Vec<EmitterSpectral>,
    /// Spectra by direction.
    pub angular_spectral: Option<AngularSpectral>,
    /// Emission areas.
    pub areas: Vec<EmissionArea>,
    /// All other elements that have a text: path from the emitter, text.
    pub others: Vec<(String, String)>,
}

/// A document.
#[derive(Debug, Clone, PartialEq)]
pub struct Tm33 {
    /// By which name.
    pub schema: Schema,
    /// `Version`.
    pub version: String,
    /// Elements of the header in their order: name, text.
    pub header: Vec<(String, String)>,
    /// Length, width, height of the luminaire as written.
    pub dimensions: Option<[f64; 3]>,
    /// `Shape`: `Align_X`, `Align_Y`, `Align_Z` (a cylinder along x, y, z), where stated.
    pub shape: Option<String>,
    /// Openings of the `LuminaireOpticalData` variant: whether round, length, width as written.
    pub openings: Vec<(bool, f64, f64)>,
    /// The gonioradiometer's type, where stated.
    pub goniometer: Option<Goniometer>,
    /// Texts of the equipment: path, text.
    pub equipment: Vec<(String, String)>,
    /// The emitters, at least one.
    pub emitters: Vec<Emitter>,
    /// Name and identifier of each `CustomData`.
    pub custom: Vec<(String, String)>,
}

impl Tm33 {
    /// The text of an element of the header; `None` where it is empty or what [`write`](fn@write) puts there for want of one.
    #[must_use]
    pub fn header(&self, name: &str) -> Option<&str> {
        self.header.iter().find(|(key, _)| key == name).map(|(_, text)| text.as_str()).filter(|text| is_known(text))
    }
}

/// What stands for a text that is required and not known.
const UNKNOWN: &str = "unknown";
/// What stands for a date that is required and not known.
const NO_DATE: &str = "0001-01-01";

fn is_known(text: &str) -> bool {
    !(text.is_empty() || text == UNKNOWN || text == NO_DATE)
}

/// Reads a document into the model: luminous intensity where there is one, else radiant, photon, angular-spectral. Findings of
/// reading and of the bridge together.
///
/// # Errors
/// [`Error`] with line and column, found, expected.
pub fn read(bytes: &[u8]) -> Result<Checked<Luminaire>, Error> {
    let Checked { value, mut findings } = parse(bytes)?;
    let luminaire = Checked::<Luminaire>::try_from(&value)?;
    findings.extend(luminaire.findings);
    Ok(Checked { value: luminaire.value, findings })
}

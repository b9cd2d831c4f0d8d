//! The result of a conversion: plain numbers, SI units in the names.

use crate::colorimetry::cct::Cct;
use crate::colorimetry::cri::Cri;
use crate::colorimetry::dominant::Dominant;
use crate::colorimetry::iec_60081::Steps;
use crate::colorimetry::rgb::Colour;
use crate::colorimetry::tm30::Tm30;
use crate::colorimetry::tolerance::Tolerance;
use crate::colorimetry::whiteness::Whiteness;
use crate::photometry::alpha_opic::AlphaOpic;
use crate::photometry::hazard::Hazard;
use crate::photometry::mesopic::Adaptation;
use crate::photometry::photon::Photons;
use crate::photometry::risk::Risk;
use crate::spectrum::Quantity;
use crate::spectrum::integrate::{ErrorBound, Rule};

/// What the numbers of one spectrum stand on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integration {
    /// Rule of the luminous and colour integrals.
    pub rule: Rule,
    /// Rule of the photon integrals (see [`crate::photometry::photon::Plan::new`]).
    pub photon_rule: Rule,
    /// Range of the samples that count, nm.
    pub range_nm: (f64, f64),
    /// Step, where it is even, nm.
    pub step_nm: Option<f64>,
    /// Number of samples.
    pub samples: usize,
    /// Bound on the error of the photopic integral.
    pub error_bound: ErrorBound,
}

/// One absolute quantity: the measured one, or one that the geometry connects with it.
#[derive(Debug, Clone, PartialEq)]
pub struct AbsoluteFigures {
    /// The quantity.
    pub quantity: Quantity,
    /// Its value over the measured one's.
    pub factor: f64,
    /// Radiometric value in SI units.
    pub radiometric: f64,
    /// Photopic value in lm, cd, lx, cd/m² ….
    pub photopic: f64,
    /// Scotopic value in the same unit.
    pub scotopic: f64,
    /// Mesopic value in the same unit, where asked for.
    pub mesopic: Option<f64>,
    /// How it follows from the measured quantity; empty for that itself.
    pub relations: Vec<String>,
}

/// Adaptation of the mesopic figures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mesopic {
    /// Photopic luminance of the adapting field, cd/m², as given.
    pub adaptation_luminance: f64,
    /// The state that MES2 finds.
    pub adaptation: Adaptation,
}

/// The scale of the tristimulus values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum XyzScale {
    /// K_m times the integrals: with the CIE 1931 observer Y is the photopic quantity (lx, cd/m² …).
    Absolute,
    /// Y = 100.
    Hundred,
    /// Y = 100 of the perfect reflecting diffuser.
    PerfectDiffuser,
}

/// A colour in one RGB space.
#[derive(Debug, Clone, PartialEq)]
pub struct RgbFigure {
    /// Key of the space.
    pub key: &'static str,
    /// Its components.
    pub colour: Colour,
}

/// All figures of one spectrum. `None` where a figure does not apply, was not asked for, or could not be determined (then a
/// finding says why).
#[derive(Debug, Clone, PartialEq)]
pub struct Conversion {
    /// Name of the spectrum.
    pub name: String,
    /// Quantity of the spectrum.
    pub quantity: Quantity,
    /// The measured quantity and those derived from it; empty for relative spectra.
    pub absolute: Vec<AbsoluteFigures>,
    /// Mesopic adaptation, on request.
    pub mesopic: Option<Mesopic>,
    /// Luminous efficacy of radiation, lm/W, over the whole tabulated range.
    pub efficacy_lm_per_w: Option<f64>,
    /// S/P ratio.
    pub scotopic_photopic_ratio: Option<f64>,
    /// Tristimulus values.
    pub xyz: Option<[f64; 3]>,
    /// Their scale.
    pub xyz_scale: XyzScale,
    /// Chromaticity x, y of the observer chosen.
    pub xy: Option<[f64; 2]>,
    /// Chromaticity u′, v′ of the observer chosen.
    pub uv_prime: Option<[f64; 2]>,
    /// Colour temperature and Duv (CIE 1931 observer).
    pub cct: Option<Cct>,
    /// Where the light stands to the nearest nominal white (CIE 1931 observer); `None` without a colour temperature.
    pub tolerance: Option<Tolerance>,
    /// Steps to the nearest standard colour of IEC 60081, likewise.
    pub standard_colour: Option<Steps>,
    /// Whiteness, tint and yellowness of a reflectance under C or D65.
    pub whiteness: Option<Whiteness>,
    /// Dominant wavelength and purity.
    pub dominant: Option<Dominant>,
    /// Wavelength of the largest sample, nm.
    pub peak_wavelength_nm: Option<f64>,
    /// ∫λS/∫S, nm.
    pub centroid_wavelength_nm: Option<f64>,
    /// Full width at half maximum of the largest peak, nm.
    pub fwhm_nm: Option<f64>,
    /// Colour rendering index.
    pub cri: Option<Cri>,
    /// TM-30.
    pub tm30: Option<Tm30>,
    /// α-opic actions; empty where not asked for.
    pub alpha_opic: Vec<AlphaOpic>,
    /// Hazard weightings; empty where not asked for.
    pub hazard: Vec<Hazard>,
    /// Risk group, on request.
    pub risk: Option<Risk>,
    /// Photons.
    pub photons: Option<Photons>,
    /// RGB colours; empty where not asked for or without light.
    pub rgb: Vec<RgbFigure>,
    /// What the numbers stand on.
    pub integration: Integration,
}

//! Corrections in words: TOML in, typed and checked out. No file is opened here; paths are relative to the description.

use schemars::JsonSchema;
use serde::Deserialize;

use super::lines::Element;
use crate::mistake::{self, Mistake};
use crate::uncertainty::budget::{NotNegative, Positive};

/// The corrections of a spectrum, made in this order.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Description {
    /// A name for the record.
    pub title: Option<String>,
    /// Noise of the samples as read.
    pub noise: Option<Noise>,
    /// The dark signal.
    pub dark: Option<Dark>,
    /// The integration time.
    pub integration_time: Option<IntegrationTime>,
    /// Stray light.
    pub stray_light: Option<StrayLight>,
    /// The wavelength axis.
    pub wavelength: Option<Wavelength>,
    /// The bandwidth.
    pub bandpass: Option<Bandpass>,
    /// Smoothing.
    pub smoothing: Option<Smoothing>,
    /// Another step.
    pub resampling: Option<Resampling>,
    /// Second orders of the grating.
    pub second_order: Option<SecondOrder>,
}

/// u² = read² + per_unit · S + (relative · S)², in the unit of the samples; in quadrature with a column of uncertainties.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Noise {
    /// Standard uncertainty of a sample without light.
    pub read: NotNegative,
    /// Variance per unit of signal (of photons counted, the samples' unit per electron).
    pub per_unit: NotNegative,
    /// Relative standard uncertainty.
    pub relative: NotNegative,
}

/// A spectrum read without light, subtracted.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dark {
    /// The file, on the same wavelengths.
    pub file: String,
    /// Its integration time, s.
    pub time_s: Option<Positive>,
}

/// The time by which samples are divided.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IntegrationTime {
    /// The time, s.
    pub time_s: Positive,
    /// Its standard uncertainty, s.
    #[serde(default)]
    pub standard_s: NotNegative,
}

/// A stray-light matrix (Zong et al. 2006), given or made of line-spread functions. One of `matrix` and `line_spreads` is expected.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrayLight {
    /// A CSV file of D: wavelengths (nm) of the light in the first row, of the samples in the first column.
    pub matrix: Option<String>,
    /// A CSV file of line-spread functions: wavelengths (nm) of the lines in the first row, of the samples in the first column.
    pub line_spreads: Option<String>,
    /// Full width about a line that is the line itself, nm; goes with `line_spreads`.
    pub in_band_nm: Option<Positive>,
    /// Relative standard uncertainty of what is taken out.
    #[serde(default)]
    pub relative: NotNegative,
}

/// The wavelength axis, fitted to a lamp of known lines.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wavelength {
    /// The lamp's file, on the axis of the spectrum: nominal nm, or pixels from 1.
    pub lamp: String,
    /// Elements in the lamp.
    #[serde(default)]
    pub elements: Vec<Element>,
    /// Wavelengths (nm, air) of other lines, or of all where no element is given.
    #[serde(default)]
    pub lines_nm: Vec<Positive>,
    /// Degree of the polynomial.
    #[serde(default = "cubic")]
    pub degree: usize,
    /// How far from its expected place a line is looked for, nm.
    #[serde(default = "search")]
    pub search_nm: Positive,
    /// Least height of a peak, relative to the highest.
    #[serde(default = "threshold")]
    pub threshold: NotNegative,
    /// First guess of the wavelengths as a polynomial of the axis, constant term first; by default the axis itself.
    #[serde(default)]
    pub start: Vec<f64>,
}

impl Wavelength {
    /// That of a lamp's file and elements, all else as where nobody says.
    pub(crate) fn of(lamp: String, elements: Vec<Element>) -> Self {
        let (lines_nm, start) = (Vec::new(), Vec::new());
        Self { lamp, elements, lines_nm, degree: cubic(), search_nm: search(), threshold: threshold(), start }
    }
}

fn cubic() -> usize {
    3
}

fn search() -> Positive {
    Positive(2.0)
}

fn threshold() -> NotNegative {
    NotNegative(0.01)
}

/// How a bandwidth is corrected.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// By differences, for a triangular slit (Stearns and Stearns 1988).
    #[default]
    Stearns,
    /// By iterations, for any line-spread function.
    RichardsonLucy,
}

/// The bandwidth. One of `fwhm_nm` (a triangle) and `line_spread` is expected; `line_spread` goes with `richardson-lucy`.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bandpass {
    /// How.
    #[serde(default)]
    pub method: Method,
    /// Full width at half maximum, nm.
    pub fwhm_nm: Option<Positive>,
    /// Its standard uncertainty, nm (`stearns`).
    #[serde(default)]
    pub standard_nm: NotNegative,
    /// α of the differences (`stearns`); by default (width/step)²/12, of which Stearns and Stearns print 0.083 for width = step.
    pub coefficient: Option<Positive>,
    /// A CSV file of offset λ_read − λ_line (nm) and relative response.
    pub line_spread: Option<String>,
    /// Most iterations (`richardson-lucy`).
    #[serde(default = "iterations")]
    pub iterations: usize,
}

/// Most Richardson-Lucy iterations where nobody says.
pub(crate) const ITERATIONS: usize = 50;

fn iterations() -> usize {
    ITERATIONS
}

/// Savitzky-Golay smoothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Smoothing {
    /// Samples in the window, odd.
    pub window: usize,
    /// Degree of the polynomial.
    #[serde(default = "parabola")]
    pub degree: usize,
}

fn parabola() -> usize {
    2
}

/// Interpolations that carry errors exactly.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Interpolation {
    /// Straight lines.
    #[default]
    Linear,
    /// Sprague's polynomials (CIE 167), for equal steps.
    Sprague,
    /// Natural cubic spline.
    Cubic,
}

/// Another step.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Resampling {
    /// Step, nm.
    pub step_nm: Positive,
    /// First and last wavelength, nm.
    pub range_nm: Option<[Positive; 2]>,
    /// How.
    #[serde(default)]
    pub interpolation: Interpolation,
}

/// Second orders of the grating.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SecondOrder {
    /// An order-sorting filter holds them back from this wavelength (nm) on.
    pub filter_from_nm: Positive,
}

impl Description {
    /// Reads a description.
    ///
    /// # Errors
    /// The first mistake in TOML, in keys, in types and in what does not go together.
    pub fn parse(text: &str) -> Result<Self, Mistake> {
        let read: Self = mistake::parse(text)?;
        let refuse = |header: &str, message: &str| {
            let at = text.find(header).unwrap_or(0);
            Err(Mistake::at(text, &(at..at), message))
        };
        if let Some(s) = &read.stray_light {
            let right = match (&s.matrix, &s.line_spreads) {
                (Some(_), None) => s.in_band_nm.is_none(),
                (None, Some(_)) => s.in_band_nm.is_some(),
                _ => false,
            };
            if !right {
                return refuse("[stray_light]", "expected either matrix, or line_spreads with in_band_nm");
            }
        }
        if let Some(w) = &read.wavelength
            && w.elements.is_empty()
            && w.lines_nm.is_empty()
        {
            return refuse("[wavelength]", "found no lines; expected elements or lines_nm");
        }
        if let Some(b) = &read.bandpass {
            if b.fwhm_nm.is_some() == b.line_spread.is_some() {
                return refuse("[bandpass]", "expected either fwhm_nm or line_spread");
            }
            if b.line_spread.is_some() && b.method == Method::Stearns {
                let message =
                    "found line_spread for a triangular slit; expected fwhm_nm, or method = \"richardson-lucy\"";
                return refuse("[bandpass]", message);
            }
        }
        if let Some([low, high]) = read.resampling.and_then(|r| r.range_nm)
            && low >= high
        {
            return refuse("range_nm", "found no range; expected two wavelengths, the shorter first");
        }
        Ok(read)
    }
}

/// The JSON schema of corrections (draft 2020-12).
#[must_use]
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Description).to_value()
}

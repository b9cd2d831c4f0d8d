//! From luminaires to panels: which curves, surfaces and figures stand for an intensity distribution.
//!
//! Curves keep the distribution's declared interpolation: they go through its own angles, straight in angle and intensity.

mod curves;
mod directions;
mod facts;

pub use curves::{cartesian_panel, polar_panel};
pub use directions::{isocandela_panel, web_panel};
pub use facts::{cone_panel, figures_panel};

use crate::luminaire::{Kind, Luminaire, zonal};

/// A luminaire to draw.
#[derive(Debug, Clone, Copy)]
pub struct Drawn<'a> {
    /// What to call it.
    pub name: &'a str,
    /// The luminaire.
    pub luminaire: &'a Luminaire,
}

/// How luminaires are to be drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct View {
    /// Planes through the axis, degrees: C and C + 180 for Type C; about the axis from H (0) to V (90) for Types A and B. None
    /// means the principal planes, 0 and 90 (0 alone for rotational symmetry, or for more than three luminaires).
    pub planes_deg: Vec<f64>,
    /// Intensities per 1000 lm: of the rated lamps, or of the luminaire where its photometry is absolute.
    pub per_klm: bool,
    /// Cartesian diagrams with a logarithmic axis.
    pub logarithmic: bool,
    /// Distances of the cone diagram, m, ascending; none means five round ones.
    pub distances_m: Vec<f64>,
    /// Panels are headed by the luminaire's name and not by what they are.
    pub named: bool,
}

/// Why a luminaire cannot be drawn as asked.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No positive intensity.
    #[error("no intensity is above zero{}", if *in_planes { " in the planes asked for; expected planes with light" } else { ": there is nothing to draw" })]
    Dark {
        /// There is light elsewhere.
        in_planes: bool,
    },
    /// Each plane has one angle only.
    #[error("the table has one angle in each plane asked for; expected two or more, to draw a curve between")]
    OneAngle,
    /// More curves than can be told apart.
    #[error("{found} curves; expected at most {most}, which can be told apart in print; name fewer planes or files", most = super::MOST_ANGULAR_CURVES)]
    TooMany {
        /// Luminaires times planes.
        found: usize,
    },
    /// Luminaires of different quantities.
    #[error("luminous, radiant and photon intensities do not share an axis; draw them one by one")]
    Kinds,
    /// Per 1000 lm was asked for and there are no lumens.
    #[error("the intensities cannot be given per 1000 lm: {}", if *luminous { "neither the lamps nor the luminaire have a positive flux" } else { "they are radiometric" })]
    PerKlm {
        /// The intensities are luminous.
        luminous: bool,
    },
    /// There is no cone of light about the axis.
    #[error("there is no cone of light about the axis: {0}")]
    NoCone(&'static str),
}

/// Unit of intensities.
fn unit(kind: Kind, per_klm: bool) -> &'static str {
    match (kind, per_klm) {
        (Kind::Luminous, true) => "cd/klm",
        (Kind::Luminous, false) => "cd",
        (Kind::Radiant, _) => "W/sr",
        (Kind::Photon, _) => "µmol/(s·sr)",
    }
}

/// What intensities are multiplied by before they are drawn.
fn factor(luminaire: &Luminaire, view: &View) -> Result<f64, Error> {
    if !view.per_klm {
        return Ok(1.0);
    }
    let luminous = luminaire.kind == Kind::Luminous;
    let flux = zonal::lamp_flux_lm(luminaire).unwrap_or_else(|| luminaire.distribution.total_flux());
    if luminous && flux > 0.0 { Ok(1000.0 / flux) } else { Err(Error::PerKlm { luminous }) }
}

/// A real minus sign, as figures in a drawing have it.
fn signed(text: &str) -> String {
    text.replace('-', "−")
}

/// An angle without superfluous zeros.
fn angle(degrees: f64) -> String {
    signed(&format!("{}", (10.0 * degrees).round() / 10.0))
}

/// Angles at which diagrams end.
const REACHES_DEG: [f64; 9] = [5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 180.0];

/// The least of the usual ends of a scale that takes in `angle_deg`.
fn reach(angle_deg: f64) -> f64 {
    REACHES_DEG.into_iter().find(|r| *r >= angle_deg - 1e-6).unwrap_or(180.0)
}

/// The largest angle either way up to which samples, joined by straight lines, exceed a threshold.
fn last_above(samples: impl Iterator<Item = (f64, f64)>, threshold: f64) -> f64 {
    let mut last = 0.0f64;
    let mut before: Option<(f64, f64)> = None;
    for (angle, value) in samples {
        if value > threshold {
            last = last.max(angle.abs());
        }
        if let Some((a, v)) = before.filter(|b| (b.1 > threshold) != (value > threshold)) {
            last = last.max((a + (threshold - v) / (value - v) * (angle - a)).abs());
        }
        before = Some((angle, value));
    }
    last
}

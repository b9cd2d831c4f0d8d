//! Measured tables: values at places where somebody measured, and an honest word about all the others.
//!
//! Every table answers [`Table::value`] with the value in 1/sr per channel, without cosine, **and** how it is known
//! ([`Known`]). A place without data is never zero: its values are NaN and it is [`Known::Missing`].
//!
//! | table | from | between its nodes |
//! |---|---|---|
//! | [`HalfAngle`] | MERL | the nearest bin; a missing bin by the nearest measured one in θ_d (inferred) |
//! | [`Angular`] | UTIA | linear in θ_i, φ_i, θ_o, φ_o; beyond the last θ its value (inferred) |
//! | [`Specular`] | Zemax | linear in θ_i, and in angle and azimuth about the mirror direction; nodes below the horizon do not take part |
//! | [`Patches`] | WINDOW and Radiance (Klems) | constant on pairs of patches |
//! | [`Points`] | ALTA, ASTM, CSV | inverse distances to the nearest four points; far from all of them inferred |
//! | [`Adaptive`] | RGL | linear in the adaptive parameterisation |

mod adaptive;
mod angular;
mod axis;
mod borders;
mod brdf;
mod channels;
mod half_angle;
mod kd_tree;
mod marginal;
mod nodes;
mod patches;
mod points;
mod resample;
mod sampled;
pub mod specular;

use std::fmt;

use glam::DVec3;

pub use adaptive::{Adaptive, Fields as AdaptiveFields};
pub use angular::Angular;
pub use half_angle::{HalfAngle, Resolution};
pub use nodes::Axis;
pub use patches::{Patches, Ring, Side};
pub use points::Points;
pub use resample::resample;
pub use sampled::SampledTable;
pub use specular::Specular;

/// How the value of a place is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Known {
    /// It was measured there, or between neighbours that all were.
    Measured,
    /// It follows from measurements elsewhere.
    Inferred,
    /// Nothing is known: the values are NaN.
    Missing,
}

impl fmt::Display for Known {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Measured => "measured",
            Self::Inferred => "inferred",
            Self::Missing => "missing",
        })
    }
}

/// A place of a table at which there is a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry<'a> {
    /// ω_i.
    pub incident: DVec3,
    /// ω_o.
    pub outgoing: DVec3,
    /// How much of both hemispheres the place stands for, in sr² up to a factor that all places of a table share; 1 for each of
    /// scattered points, whose shares nobody knows.
    pub measure: f64,
    /// In 1/sr, one per channel, none missing.
    pub values: &'a [f64],
}

/// What one value of a place belongs to.
#[derive(Debug, Clone, PartialEq)]
pub enum Channel {
    /// A wavelength in nm.
    Wavelength(f64),
    /// A colour channel, a broad band: `R`, `X`, `Visible`.
    Named(String),
}

impl Channel {
    /// Red, green, blue.
    #[must_use]
    pub fn rgb() -> Vec<Self> {
        ["R", "G", "B"].map(|n| Self::Named(n.to_owned())).to_vec()
    }
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Wavelength(nm) => write!(f, "{nm} nm"),
            Self::Named(name) => f.write_str(name),
        }
    }
}

/// Why a table could not be made of its numbers.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Numbers of values and of places do not fit.
    #[error("found {found} {what}; expected {expected}")]
    Count {
        /// Of what.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// An axis that does not rise.
    #[error("the values of {axis} do not rise at number {at}; expected each to be larger than the one before")]
    Axis {
        /// Which axis.
        axis: &'static str,
        /// The first that is not larger, from 1.
        at: usize,
    },
    /// A channel that is not there.
    #[error("found {found} asked for; expected channels of the table: {expected}")]
    Channel {
        /// What was asked for.
        found: String,
        /// The channels that there are.
        expected: String,
    },
    /// A wavelength outside of those of the table.
    #[error("found {found} nm asked for; expected {low} to {high} nm, the wavelengths of the table")]
    Wavelength {
        /// What was asked for.
        found: f64,
        /// The shortest.
        low: f64,
        /// The longest.
        high: f64,
    },
    /// A number that is not finite, or out of its range.
    #[error("found {value} for {what}; expected {expected}")]
    Range {
        /// Which number.
        what: &'static str,
        /// The number.
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
}

/// A measured table of any kind.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Table {
    /// Bins in half and difference angles.
    HalfAngle(HalfAngle),
    /// A grid in the angles of both directions.
    Angular(Angular),
    /// A grid about the mirror direction.
    Specular(Specular),
    /// Pairs of patches of the hemisphere.
    Patches(Patches),
    /// Scattered points.
    Points(Points),
    /// A parameterisation adapted to the material.
    Adaptive(Adaptive),
}

impl From<HalfAngle> for Table {
    fn from(table: HalfAngle) -> Self {
        Self::HalfAngle(table)
    }
}

impl From<Angular> for Table {
    fn from(table: Angular) -> Self {
        Self::Angular(table)
    }
}

impl From<Specular> for Table {
    fn from(table: Specular) -> Self {
        Self::Specular(table)
    }
}

impl From<Patches> for Table {
    fn from(table: Patches) -> Self {
        Self::Patches(table)
    }
}

impl From<Points> for Table {
    fn from(table: Points) -> Self {
        Self::Points(table)
    }
}

impl From<Adaptive> for Table {
    fn from(table: Adaptive) -> Self {
        Self::Adaptive(table)
    }
}

impl Table {
    /// What the values of a place belong to.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        match self {
            Self::HalfAngle(t) => t.channels(),
            Self::Angular(t) => t.channels(),
            Self::Specular(t) => t.channels(),
            Self::Patches(t) => t.channels(),
            Self::Points(t) => t.channels(),
            Self::Adaptive(t) => t.channels(),
        }
    }

    /// Whether the table has no place for an angle of rotation of the sample.
    #[must_use]
    pub fn is_isotropic(&self) -> bool {
        match self {
            Self::HalfAngle(_) => true,
            Self::Angular(_) | Self::Patches(_) => false,
            Self::Specular(t) => t.is_isotropic(),
            Self::Points(t) => t.is_isotropic(),
            Self::Adaptive(t) => t.is_isotropic(),
        }
    }

    /// Writes f_r(ω_i, ω_o) in 1/sr, without cosine, one value per channel, and tells how it is known. NaN where it is missing;
    /// 0 and [`Known::Measured`] where either direction is not above the horizon (a reflecting surface is opaque).
    ///
    /// # Panics
    /// Where `values` has another length than [`Table::channels`].
    pub fn value(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) -> Known {
        assert_eq!(values.len(), self.channels().len(), "one value per channel");
        if !(incident.z > 0.0 && outgoing.z > 0.0) {
            values.fill(0.0);
            return Known::Measured;
        }
        match self {
            Self::HalfAngle(t) => t.value(incident, outgoing, values),
            Self::Angular(t) => t.value(incident, outgoing, values),
            Self::Specular(t) => t.value(incident, outgoing, values),
            Self::Patches(t) => t.value(incident, outgoing, values),
            Self::Points(t) => t.value(incident, outgoing, values),
            Self::Adaptive(t) => t.value(incident, outgoing, values),
        }
    }

    /// Visits the places at which there is a value and both directions are above the horizon, in the table's order: the middles of
    /// bins and patches, nodes, points. A table in the adaptive parameterisation has its places where its file's interpolation
    /// puts them; it is read at its own angles of incidence on a net of normals as fine as its spectra.
    pub fn entries(&self, visit: &mut dyn FnMut(&Entry<'_>)) {
        match self {
            Self::HalfAngle(t) => t.entries(visit),
            Self::Angular(t) => t.entries(visit),
            Self::Specular(t) => t.entries(visit),
            Self::Patches(t) => t.entries(visit),
            Self::Points(t) => t.entries(visit),
            Self::Adaptive(t) => t.entries(visit),
        }
    }

    /// Number of places of the table, and how many of them are missing.
    #[must_use]
    pub fn coverage(&self) -> (usize, usize) {
        match self {
            Self::HalfAngle(t) => t.coverage(),
            Self::Angular(t) => t.coverage(),
            Self::Specular(t) => t.coverage(),
            Self::Patches(t) => t.coverage(),
            Self::Points(t) => (t.len(), 0),
            Self::Adaptive(t) => (t.places(), 0),
        }
    }
}

/// Adds weighted values, of which some are missing (NaN), and tells how the sum is known: nodes without data lend their weight
/// to the others.
fn blend<'a>(nodes: impl Iterator<Item = (f64, &'a [f64])>, values: &mut [f64]) -> Known {
    values.fill(0.0);
    let (mut held, mut lost) = (0.0, 0.0);
    for (weight, node) in nodes.filter(|(weight, _)| *weight > 0.0) {
        if node.iter().any(|v| v.is_nan()) {
            lost += weight;
            continue;
        }
        held += weight;
        values.iter_mut().zip(node).for_each(|(v, n)| *v += weight * n);
    }
    if held <= 0.0 {
        values.fill(f64::NAN);
        return Known::Missing;
    }
    values.iter_mut().for_each(|v| *v /= held);
    if lost > 0.0 { Known::Inferred } else { Known::Measured }
}

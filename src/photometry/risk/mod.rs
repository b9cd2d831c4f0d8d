//! Risk group of lamps and lamp systems that shine continuously (IEC 62471:2006 / CIE S 009:2002).
//!
//! | hazard | quantity | weighting | exposure limit (clause 4.3) | exempt, group 1, group 2 (Table 6.1) |
//! |---|---|---|---|---|
//! | actinic ultraviolet | E_S, W/m² | S(λ) | 30 J/m² in 8 h | 0.001, 0.003, 0.03 |
//! | near ultraviolet, eye | E_UVA, W/m² | 1 from 315 to 400 nm | 10⁴ J/m² to 1000 s, then 10 W/m² | 10, 33, 100 |
//! | blue light | L_B, W/(m²·sr) | B(λ) | 10⁶ J/(m²·sr) to 10⁴ s, then 100 | 100, 10⁴, 4·10⁶ |
//! | blue light, small source | E_B, W/m² | B(λ) | 100 J/m² to 100 s, then 1 W/m² | 1, 1, 400 |
//! | retinal thermal | L_R, W/(m²·sr) | R(λ) | 50 000/(α t^¼) to 10 s | 28 000/α, 28 000/α, 71 000/α |
//! | the same, weak visual stimulus | L_IR, W/(m²·sr) | R(λ) from 780 to 1400 nm | 6000/α beyond 10 s | 6000/α |
//! | infrared, eye | E_IR, W/m² | 1 from 780 to 3000 nm | 18 000 t^−¾ to 1000 s, then 100 | 100, 570, 3200 |
//!
//! α is the angle that the source subtends, in rad, never less than 0.011 (0.0017 for group 2) and never more than 0.1. A source
//! below 0.011 rad is small. A weak visual stimulus is a luminance below 10 cd/m². Distances, fields of view and apertures of the
//! measurement are the caller's: see docs/methods.md.

use crate::spectrum::integrate::{Contract, RuleError, Weighting};
use crate::spectrum::{Grid, Quantity, Sampling};

use super::hazard::Weighted;
use super::luminous::single;
use super::transfer::{Geometry, Shape};

/// A risk group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// No hazard.
    Exempt,
    /// Low risk.
    One,
    /// Moderate risk.
    Two,
    /// High risk.
    Three,
}

impl Group {
    /// Key in the results.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Exempt => "exempt",
            Self::One => "rg1",
            Self::Two => "rg2",
            Self::Three => "rg3",
        }
    }

    /// The group in words.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Exempt => "exempt",
            Self::One => "risk group 1",
            Self::Two => "risk group 2",
            Self::Three => "risk group 3",
        }
    }
}

/// A hazard of IEC 62471 that counts for the group.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hazard {
    /// Skin and eye, S(λ).
    ActinicUv,
    /// The lens of the eye, 315–400 nm.
    NearUv,
    /// The retina, B(λ), extended sources.
    BlueLight,
    /// The retina, B(λ), sources below 0.011 rad.
    BlueLightSmallSource,
    /// The retina, R(λ).
    RetinalThermal,
    /// The retina, R(λ) of infrared that hardly anything visible goes with.
    RetinalThermalWeak,
    /// Cornea and lens, 780–3000 nm.
    Infrared,
}

/// Angle below which a source is small, and least angle of the limits for 10 s and more, rad.
const SMALL_RAD: f64 = 0.011;
/// Least angle of the limits for 0.25 s, rad.
const LEAST_RAD: f64 = 0.0017;
/// Largest angle of the limits, rad.
const LARGEST_RAD: f64 = 0.1;
/// Luminance below which a visual stimulus is weak, cd/m².
const WEAK_CD_PER_M2: f64 = 10.0;

impl Hazard {
    /// All hazards.
    pub const ALL: [Self; 7] = [
        Self::ActinicUv,
        Self::NearUv,
        Self::BlueLight,
        Self::BlueLightSmallSource,
        Self::RetinalThermal,
        Self::RetinalThermalWeak,
        Self::Infrared,
    ];

    /// Key in the results.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::ActinicUv => "actinic_uv",
            Self::NearUv => "near_uv",
            Self::BlueLight => "blue_light",
            Self::BlueLightSmallSource => "blue_light_small_source",
            Self::RetinalThermal => "retinal_thermal",
            Self::RetinalThermalWeak => "retinal_thermal_weak_stimulus",
            Self::Infrared => "infrared",
        }
    }

    /// The standard's symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::ActinicUv => "E_S",
            Self::NearUv => "E_UVA",
            Self::BlueLight => "L_B",
            Self::BlueLightSmallSource => "E_B",
            Self::RetinalThermal => "L_R",
            Self::RetinalThermalWeak => "L_IR",
            Self::Infrared => "E_IR",
        }
    }

    /// The hazard in words.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::ActinicUv => "actinic UV",
            Self::NearUv => "near UV",
            Self::BlueLight => "blue light",
            Self::BlueLightSmallSource => "blue light, small source",
            Self::RetinalThermal => "retinal thermal",
            Self::RetinalThermalWeak => "retinal thermal, weak stimulus",
            Self::Infrared => "infrared",
        }
    }

    /// Irradiance or radiance: what is weighted.
    #[must_use]
    pub fn quantity(self) -> Quantity {
        match self {
            Self::BlueLight | Self::RetinalThermal | Self::RetinalThermalWeak => Quantity::Radiance,
            Self::ActinicUv | Self::NearUv | Self::BlueLightSmallSource | Self::Infrared => Quantity::Irradiance,
        }
    }

    fn weighting(self) -> Weighting {
        match self {
            Self::ActinicUv => single("icnirp-actinic-uv-hazard"),
            Self::NearUv => Weighting::band(315.0, 400.0),
            Self::BlueLight | Self::BlueLightSmallSource => single("icnirp-blue-light-hazard"),
            Self::RetinalThermal => single("icnirp-retinal-thermal-hazard"),
            Self::RetinalThermalWeak => single("icnirp-retinal-thermal-hazard").from(780.0),
            Self::Infrared => Weighting::band(780.0, 3000.0),
        }
    }

    /// Most of the exempt group, of group 1 and of group 2, in the quantity's SI unit, for a source that subtends `subtense_rad`.
    #[must_use]
    pub fn limits(self, subtense_rad: f64) -> [f64; 3] {
        let long = subtense_rad.clamp(SMALL_RAD, LARGEST_RAD);
        match self {
            Self::ActinicUv => [0.001, 0.003, 0.03],
            Self::NearUv => [10.0, 33.0, 100.0],
            Self::BlueLight => [100.0, 1e4, 4e6],
            Self::BlueLightSmallSource => [1.0, 1.0, 400.0],
            Self::RetinalThermal => [28e3 / long, 28e3 / long, 71e3 / subtense_rad.clamp(LEAST_RAD, LARGEST_RAD)],
            Self::RetinalThermalWeak => [6e3 / long; 3],
            Self::Infrared => [100.0, 570.0, 3200.0],
        }
    }

    /// How long an exposure to `value` may last within the exposure limit, s; `None` where this limit does not end it (within 8 h for
    /// actinic ultraviolet).
    #[must_use]
    pub fn longest_s(self, value: f64, subtense_rad: f64) -> Option<f64> {
        let dose = |most: f64, harmless: f64| (value > harmless).then(|| most / value);
        let long = subtense_rad.clamp(SMALL_RAD, LARGEST_RAD);
        let heat = (50e3 / (long * value)).powi(4);
        match self {
            Self::ActinicUv => dose(30.0, 0.001),
            Self::NearUv => dose(1e4, 10.0),
            Self::BlueLight => dose(1e6, 100.0),
            Self::BlueLightSmallSource => dose(100.0, 1.0),
            // The least angle grows from 0.0017 rad at 0.25 s to 0.011 rad at 10 s; the larger one is strict.
            Self::RetinalThermal => (value > 28e3 / long).then(|| heat.min(10.0)),
            Self::RetinalThermalWeak => (value > 6e3 / long).then(|| heat.min(10.0)),
            Self::Infrared => (value > 100.0).then(|| (18e3 / value).powf(4.0 / 3.0)),
        }
    }
}

/// One hazard of one source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assessment {
    /// The hazard.
    pub hazard: Hazard,
    /// Its weighted irradiance in W/m² or radiance in W/(m²·sr).
    pub value: f64,
    /// Most of the exempt group, group 1 and group 2.
    pub limits: [f64; 3],
    /// The group by this hazard.
    pub group: Group,
    /// Longest exposure, s; `None` where this hazard sets no end.
    pub longest_s: Option<f64>,
    /// The part of the weighting's range that the spectrum covers, nm.
    pub covered_nm: (f64, f64),
    /// Whether that is the whole range.
    pub complete: bool,
}

/// Why a hazard was not assessed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Missing {
    /// No irradiance is known.
    Irradiance,
    /// No radiance is known.
    Radiance,
    /// The spectrum has nothing where the hazard lies.
    Range,
}

impl Missing {
    /// The reason in words.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Irradiance => "no irradiance is known",
            Self::Radiance => "no radiance is known",
            Self::Range => "the spectrum does not reach it",
        }
    }
}

/// The risk group of a source, as far as the spectrum and the geometry tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Risk {
    /// Angle that the source subtends, rad; where it is not known, the limits are those of 0.1 rad, the strictest.
    pub subtense_rad: Option<f64>,
    /// The hazards that were assessed.
    pub assessments: Vec<Assessment>,
    /// Those that count and were not.
    pub missing: Vec<(Hazard, Missing)>,
}

impl Risk {
    /// The highest group of the hazards assessed; `None` without any.
    #[must_use]
    pub fn group(&self) -> Option<Group> {
        self.assessments.iter().map(|a| a.group).max()
    }

    /// Whether every hazard that counts was assessed over its whole range. If not, the group is a lower bound.
    #[must_use]
    pub fn complete(&self) -> bool {
        self.missing.is_empty() && self.assessments.iter().all(|a| a.complete)
    }
}

/// What is known of a source beside its spectrum: the factors from the spectrum's own quantity to these, and its luminance.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Source {
    /// From the spectrum's quantity to irradiance.
    pub to_irradiance: Option<f64>,
    /// From the spectrum's quantity to radiance.
    pub to_radiance: Option<f64>,
    /// Luminance, cd/m².
    pub luminance_cd_per_m2: Option<f64>,
    /// Angle that the source subtends, rad.
    pub subtense_rad: Option<f64>,
}

/// The hazards' weightings compiled for one grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    hazards: Vec<Weighted>,
}

impl Plan {
    /// Compiles the weightings.
    ///
    /// # Errors
    /// [`RuleError`] where the contract's rule does not fit the grid.
    pub fn new(grid: &Grid, sampling: Sampling, contract: &Contract) -> Result<Self, RuleError> {
        let compile = |h: Hazard| Weighted::new(h.key(), &h.weighting(), grid, sampling, contract);
        Ok(Self { hazards: Hazard::ALL.into_iter().map(compile).collect::<Result<_, _>>()? })
    }

    /// The risk group of a source of which `values` are the samples in SI per nm.
    #[must_use]
    pub fn evaluate(&self, values: &[f64], source: &Source) -> Risk {
        let small = source.subtense_rad.is_some_and(|a| a < SMALL_RAD);
        let weak = source.luminance_cd_per_m2.is_some_and(|l| l < WEAK_CD_PER_M2);
        let subtense = source.subtense_rad.unwrap_or(LARGEST_RAD);
        let mut out = Risk { subtense_rad: source.subtense_rad, assessments: Vec::new(), missing: Vec::new() };
        for (hazard, weighted) in Hazard::ALL.into_iter().zip(&self.hazards) {
            let counts = match hazard {
                Hazard::BlueLight => !small,
                Hazard::BlueLightSmallSource => small,
                Hazard::RetinalThermalWeak => weak,
                _ => true,
            };
            if !counts {
                continue;
            }
            let (factor, absent) = match hazard.quantity() {
                Quantity::Radiance => (source.to_radiance, Missing::Radiance),
                _ => (source.to_irradiance, Missing::Irradiance),
            };
            let found = weighted.evaluate(values);
            let covered = if found.complete { Some(weighted.range_nm) } else { found.covered_nm };
            let Some(covered_nm) = covered.filter(|(low, high)| low < high) else {
                out.missing.push((hazard, Missing::Range));
                continue;
            };
            // Nothing stays nothing, whatever the geometry.
            let nothing = found.complete && found.weighted == 0.0;
            let Some(factor) = factor.or(nothing.then_some(0.0)) else {
                out.missing.push((hazard, absent));
                continue;
            };
            let value = factor * found.weighted;
            let limits = hazard.limits(subtense);
            let group = match limits.iter().position(|most| value <= *most) {
                Some(0) => Group::Exempt,
                Some(1) => Group::One,
                Some(_) => Group::Two,
                None => Group::Three,
            };
            let longest_s = hazard.longest_s(value, subtense);
            out.assessments.push(Assessment {
                hazard,
                value,
                limits,
                group,
                longest_s,
                covered_nm,
                complete: found.complete,
            });
        }
        out
    }
}

/// The angle, in rad, that a source subtends at the receiver: of a shape at a distance, or of the cone or solid angle in which the
/// receiver sees it (where a measured irradiance or radiance comes without a distance). The angle of an oblong source is the mean
/// of its angles (IEC 62471:2006, 4.2.2).
#[must_use]
pub fn subtense_rad(measured: Quantity, geometry: &Geometry) -> Option<f64> {
    if let (Some(shape), Some(distance_m)) = (geometry.shape, geometry.distance_m) {
        let across = |length_m: f64| 2.0 * (0.5 * length_m).atan2(distance_m);
        return Some(match shape {
            Shape::Sphere { .. } | Shape::Disk { .. } => 2.0 * shape.half_extent_rad(distance_m),
            Shape::Rectangle { width_m, height_m } => 0.5 * (across(width_m) + across(height_m)),
            Shape::Triangle { base_m, height_m } => 0.5 * (across(base_m) + across(height_m)),
        });
    }
    if geometry.distance_m.is_some() || !matches!(measured, Quantity::Irradiance | Quantity::Radiance) {
        return None;
    }
    let cone = geometry.cone_half_angle_rad.map(|half| 2.0 * half);
    cone.or_else(|| geometry.solid_angle_sr.map(|omega| 2.0 * (1.0 - omega / std::f64::consts::TAU).acos()))
}

#[cfg(test)]
mod tests;

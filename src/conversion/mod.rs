//! The main job: every photometric, colorimetric and photon figure of a spectrum, under one declared contract.
//!
//! A [`Converter`] holds the [`Settings`] and, per wavelength grid, the compiled plans of all the figures asked for; spectra
//! on a grid it has met cost dot products. It is shared between threads.

use std::sync::{Arc, Mutex, PoisonError};

use crate::colorimetry::adaptation::Transform;
use crate::colorimetry::{Observer, cct, cri, observer, tm30};
use crate::constants::SecondRadiation;
use crate::finding::{Checked, Finding};
use crate::photometry::luminous::{Efficacy, Efficiency};
use crate::photometry::transfer::{self, Geometry};
use crate::photometry::{alpha_opic, hazard, luminous, mesopic, photon, risk};
use crate::spectrum::integrate::{Contract, Rule, RuleError};
use crate::spectrum::resample::{Extrapolation, Interpolation, ResampleError, resample, thinned};
use crate::spectrum::{Grid, Quantity, Sampling, Spectrum};
use crate::{illuminant, tables};

mod evaluate;
mod figures;
mod reflectance;
mod scale;
pub(crate) mod shape;

pub use figures::{AbsoluteFigures, Conversion, Integration, Mesopic, RgbFigure, XyzScale};
pub use scale::{Level, LevelError};

/// Which groups of figures to calculate. Luminous figures, XYZ and chromaticity always are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]

pub struct Groups {
    /// CCT, Duv, dominant wavelength, purity.
    pub colour: bool,
    /// Ra and R1–R14.
    pub cri: bool,
    /// Rf, Rg and hue bins.
    pub tm30: bool,
    /// α-opic quantities.
    pub alpha_opic: bool,
    /// Photon numbers.
    pub photon: bool,
    /// Hazard weightings.
    pub hazard: bool,
    /// RGB spaces.
    pub rgb: bool,
    /// Peak, centroid and width of the spectrum.
    pub shape: bool,
}

impl Groups {
    /// Every group.
    pub const ALL: Self = Self {
        colour: true,
        cri: true,
        tm30: true,
        alpha_opic: true,
        photon: true,
        hazard: true,
        rgb: true,
        shape: true,
    };
    /// Luminous figures, XYZ and chromaticity alone.
    pub const NONE: Self = Self {
        colour: false,
        cri: false,
        tm30: false,
        alpha_opic: false,
        photon: false,
        hazard: false,
        rgb: false,
        shape: false,
    };
}

/// Resampling before anything else; absent by default: nothing resamples behind the user's back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resampling {
    /// Step of the new grid, nm.
    pub step_nm: f64,
    /// First and last wavelength, nm; `None` takes the spectrum's own range, from the first multiple of the step inside it to
    /// the last.
    pub range_nm: Option<(f64, f64)>,
    /// Interpolation.
    pub interpolation: Interpolation,
    /// Extrapolation.
    pub extrapolation: Extrapolation,
}

/// Everything that decides a figure, printed with it.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Rule and range of integration.
    pub contract: Contract,
    /// Resampling, if any.
    pub resampling: Option<Resampling>,
    /// Samples that straight lines between the others need not to be off by more than this share of the largest value are left out
    /// ([`thinned`]); not where there is a resampling.
    pub thinning: Option<f64>,
    /// Photopic efficiency function.
    pub efficiency: Efficiency,
    /// K_m and K′_m.
    pub efficacy: Efficacy,
    /// Observer of XYZ and chromaticity; CCT and colour rendition have the observers their standards prescribe.
    pub observer: Observer,
    /// Second radiation constant of blackbodies.
    pub c2: SecondRadiation,
    /// Method of CCT and Duv.
    pub cct_method: cct::Method,
    /// White point of dominant wavelength and purity, x and y; equal energy by default, as usual for light sources.
    pub dominant_white_xy: [f64; 2],
    /// XYZ of the white to which the eye is adapted for RGB; `None` is the space's own.
    pub rgb_white: Option<[f64; 3]>,
    /// Chromatic adaptation from that white to the space's own.
    pub adaptation: Transform,
    /// Photopic luminance of the adapting field, cd/m², for mesopic figures.
    pub mesopic_adaptation: Option<f64>,
    /// The light, by name and spectrum, under which relative spectra are reflectance factors (1 of the perfect diffuser): every
    /// figure is then one of the light reflected.
    pub illuminant: Option<(String, Spectrum)>,
    /// Geometry that connects quantities.
    pub geometry: Geometry,
    /// Whether to find the risk group of the source (IEC 62471).
    pub risk_group: bool,
    /// Groups of figures.
    pub groups: Groups,
    /// Absolute level to scale the spectrum to.
    pub level: Option<Level>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            contract: Contract::default(),
            resampling: None,
            thinning: None,
            efficiency: Efficiency::default(),
            efficacy: Efficacy::default(),
            observer: Observer::default(),
            c2: SecondRadiation::default(),
            cct_method: cct::Method::default(),
            dominant_white_xy: [1.0 / 3.0, 1.0 / 3.0],
            rgb_white: None,
            adaptation: Transform::default(),
            mesopic_adaptation: None,
            illuminant: None,
            geometry: Geometry::default(),
            risk_group: false,
            groups: Groups::ALL,
            level: None,
        }
    }
}

/// Why a spectrum was not converted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The rule does not fit the spectrum.
    #[error(transparent)]
    Rule(#[from] RuleError),
    /// The spectrum could not be resampled.
    #[error(transparent)]
    Resample(#[from] ResampleError),
    /// A step or range of resampling makes no grid.
    #[error(
        "resampling by {step_nm} nm from {low_nm} to {high_nm} nm; expected a positive step and at least two and at most 10 million samples"
    )]
    ResampleGrid {
        /// Step.
        step_nm: f64,
        /// First wavelength.
        low_nm: f64,
        /// Last wavelength.
        high_nm: f64,
    },
    /// The geometry makes no sense.
    #[error(transparent)]
    Geometry(#[from] transfer::Error),
    /// Mesopic adaptation is impossible.
    #[error(transparent)]
    Mesopic(#[from] mesopic::Error),
    /// A reflectance is a ratio.
    #[error("{quantity} under an illuminant; expected a reflectance, which is relative")]
    ReflectanceQuantity {
        /// The quantity met.
        quantity: Quantity,
    },
    /// A reflectance in per cent.
    #[error(
        "a reflectance factor of {largest} at {nanometres} nm; expected fractions, 1 being the perfect diffuser (84 % is 0.84)"
    )]
    ReflectanceFactor {
        /// The largest sample.
        largest: f64,
        /// Where it is.
        nanometres: f64,
    },
    /// Lines reflect nothing of a continuous light, and a single sample is no more than one.
    #[error("a line spectrum as reflectance or as illuminant; expected continuous spectra")]
    ReflectanceLines,
    /// A reflected light of a given level says nothing about the sample.
    #[error("a level for a reflectance; expected one or the other, a level or an illuminant")]
    ReflectanceLevel,
    /// The illuminant has no light where the sample is known.
    #[error("the illuminant {name} has no luminous content at the sample's wavelengths; expected one that has")]
    DarkIlluminant {
        /// The illuminant.
        name: String,
    },
    /// The spectrum could not be scaled.
    #[error(transparent)]
    Level(#[from] LevelError),
    /// Colour rendition could not be compiled.
    #[error(transparent)]
    Rendition(#[from] cri::Error),
    /// An embedded table is missing.
    #[error(transparent)]
    Table(#[from] tables::Error),
    /// A spectrum in between is not one.
    #[error(transparent)]
    Spectrum(#[from] crate::spectrum::Error),
    /// A reference illuminant could not be made.
    #[error(transparent)]
    Illuminant(#[from] illuminant::Error),
}

/// All plans for one grid and sampling.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(crate) grid: Arc<Grid>,
    pub(crate) sampling: Sampling,
    pub(crate) rule: Rule,
    pub(crate) luminous: luminous::Plan,
    pub(crate) colour: observer::Plan,
    /// The illuminant of reflectances.
    pub(crate) light: Option<reflectance::Light>,
    /// CIE 1931 observer, in which CCT is defined, where the user chose another for XYZ.
    pub(crate) colour_1931: Option<observer::Plan>,
    pub(crate) cri: Option<cri::Plan>,
    /// TM-30 and the CIE 1931 observer over its range, 380–780 nm, from which it takes the colour temperature.
    pub(crate) tm30: Option<(tm30::Plan, observer::Plan)>,
    pub(crate) alpha_opic: Option<alpha_opic::Plan>,
    pub(crate) photon: Option<photon::Plan>,
    pub(crate) hazard: Option<hazard::Plan>,
    pub(crate) risk: Option<risk::Plan>,
    /// ∫ λ S dλ for the centroid.
    pub(crate) centroid: Vec<f64>,
}

impl Plan {
    fn new(settings: &Settings, grid: &Arc<Grid>, sampling: Sampling) -> Result<Self, Error> {
        let contract = &settings.contract;
        let groups = settings.groups;
        let observer_plan = |o| observer::Plan::new(o, grid, sampling, contract);
        let weights = |w| crate::spectrum::integrate::weights(grid, sampling, &w, contract);
        let colour = observer_plan(settings.observer)?;
        Ok(Self {
            light: reflectance::Light::new(settings, grid, sampling, &colour)?,
            rule: contract.rule_on(grid, sampling)?,
            luminous: luminous::Plan::new(settings.efficiency, settings.efficacy, grid, sampling, contract)?,
            colour,
            colour_1931: match settings.observer {
                Observer::Cie1931 => None,
                _ => Some(observer_plan(Observer::Cie1931)?),
            },
            cri: groups.cri.then(|| cri::Plan::new(grid, sampling, contract, settings.c2)).transpose()?,
            tm30: groups.tm30.then(|| Self::tm30(settings, grid, sampling)).transpose()?,
            alpha_opic: groups
                .alpha_opic
                .then(|| alpha_opic::Plan::new(settings.efficacy.k_m, grid, sampling, contract))
                .transpose()?,
            photon: groups.photon.then(|| photon::Plan::new(grid, sampling, contract)).transpose()?,
            hazard: groups.hazard.then(|| hazard::Plan::new(grid, sampling, contract)).transpose()?,
            risk: settings.risk_group.then(|| risk::Plan::new(grid, sampling, contract)).transpose()?,
            centroid: weights(crate::spectrum::integrate::Weighting::wavelength())?,
            grid: Arc::clone(grid),
            sampling,
        })
    }
}

impl Plan {
    fn tm30(settings: &Settings, grid: &Grid, sampling: Sampling) -> Result<(tm30::Plan, observer::Plan), Error> {
        let contract = &settings.contract;
        let (first, last) = tm30::RANGE_NM;
        let (low, high) = contract.range_nm.unwrap_or(tm30::RANGE_NM);
        let narrowed = Contract { rule: contract.rule, range_nm: Some((low.max(first), high.min(last))) };
        Ok((
            tm30::Plan::new(grid, sampling, contract, settings.c2)?,
            observer::Plan::new(Observer::Cie1931, grid, sampling, &narrowed)?,
        ))
    }
}

/// Grids kept at most: a folder of files from many instruments must not grow without bound.
const PLANS_KEPT: usize = 64;

/// Converts spectra under one set of settings; shared between threads.
#[derive(Debug)]
pub struct Converter {
    settings: Settings,
    plans: Mutex<Vec<Arc<Plan>>>,
}

impl Converter {
    /// A converter with nothing compiled yet.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self { settings, plans: Mutex::new(Vec::new()) }
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    pub(crate) fn plan(&self, grid: &Arc<Grid>, sampling: Sampling) -> Result<Arc<Plan>, Error> {
        let find = |plans: &[Arc<Plan>]| {
            let same = |p: &&Arc<Plan>| p.sampling == sampling && (Arc::ptr_eq(&p.grid, grid) || p.grid == *grid);
            plans.iter().find(same).cloned()
        };
        let lock = || self.plans.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(plan) = find(&lock()) {
            return Ok(plan);
        }
        // Compiled outside the lock: threads on other grids go on; two on the same new grid compile it twice at worst.
        let plan = Arc::new(Plan::new(&self.settings, grid, sampling)?);
        let mut plans = lock();
        if plans.len() == PLANS_KEPT {
            plans.remove(0);
        }
        plans.push(Arc::clone(&plan));
        Ok(plan)
    }

    /// All figures of a spectrum whose values are SI per nm of `quantity` (or anything, where it is relative).
    ///
    /// Figures that do not apply are absent; figures that could not be determined are absent with a finding that says why.
    ///
    /// # Errors
    /// [`Error`] where the settings do not fit the spectrum.
    pub fn convert(&self, name: &str, quantity: Quantity, spectrum: &Spectrum) -> Result<Checked<Conversion>, Error> {
        let settings = &self.settings;
        settings.geometry.check()?;
        let resampled = settings.regridded(spectrum)?;
        let spectrum = resampled.as_ref().unwrap_or(spectrum);
        let plan = self.plan(spectrum.grid(), spectrum.sampling())?;
        if let Some(light) = &plan.light {
            if settings.level.is_some() {
                return Err(Error::ReflectanceLevel);
            }
            return evaluate::evaluate(settings, &plan, name, quantity, &light.reflected(quantity, spectrum)?);
        }
        let Some(level) = &settings.level else {
            return evaluate::evaluate(settings, &plan, name, quantity, spectrum);
        };
        let factor = level.factor(quantity, &plan.luminous.evaluate(spectrum.values()))?;
        let scaled = spectrum.map(|_, v| v * factor)?;
        let mut out = evaluate::evaluate(settings, &plan, name, level.quantity, &scaled)?;
        out.findings.push(Finding::info("P004", format!("scaled by {factor:.6e} to {level}")));
        Ok(out)
    }
}

impl Settings {
    /// The spectrum on the grid on which it is integrated; `None` where that is its own.
    pub(crate) fn regridded(&self, spectrum: &Spectrum) -> Result<Option<Spectrum>, Error> {
        match (&self.resampling, self.thinning) {
            (Some(resampling), _) => resampling.apply(spectrum).map(Some),
            (None, Some(tolerance)) => Ok(Some(thinned(spectrum, tolerance)?)),
            (None, None) => Ok(None),
        }
    }

    /// The same on the grid that another spectrum of the same wavelengths was brought to.
    pub(crate) fn regridded_like(&self, spectrum: &Spectrum, grid: &Arc<Grid>) -> Result<Spectrum, Error> {
        match &self.resampling {
            Some(resampling) => resampling.apply(spectrum),
            None => Ok(resample(spectrum, Arc::clone(grid), Interpolation::Linear, Extrapolation::Refuse)?),
        }
    }
}

impl Resampling {
    /// The largest grid made.
    const MOST_SAMPLES: f64 = 1e7;

    pub(crate) fn apply(&self, spectrum: &Spectrum) -> Result<Spectrum, Error> {
        if spectrum.sampling() == Sampling::Lines {
            return Err(ResampleError::Lines.into());
        }
        let step_nm = self.step_nm;
        let own = spectrum.grid().range_nm();
        let (low_nm, high_nm) = self.range_nm.unwrap_or_else(|| {
            // Up to rounding in the division, a multiple of the step that is a sample stays inside.
            ((own.0 / step_nm - 1e-9).ceil() * step_nm, (own.1 / step_nm + 1e-9).floor() * step_nm)
        });
        let count = ((high_nm - low_nm) / step_nm + 1e-9).floor() + 1.0;
        if !(step_nm > 0.0 && (2.0..=Self::MOST_SAMPLES).contains(&count)) {
            let (low_nm, high_nm) = self.range_nm.unwrap_or(own);
            return Err(Error::ResampleGrid { step_nm, low_nm, high_nm });
        }
        let grid = Arc::new(Grid::uniform(low_nm, step_nm, count as usize)?);
        Ok(resample(spectrum, grid, self.interpolation, self.extrapolation)?)
    }
}

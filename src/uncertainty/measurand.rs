//! The figures that have an uncertainty, and their values for one erring spectrum after another.

use std::fmt;
use std::sync::Arc;

use super::{Error, Outputs};
use crate::colorimetry::reference::ReferenceScratch;
use crate::colorimetry::{cct, chromaticity, cri, dominant};
use crate::conversion::{Converter, Plan, Settings, shape};
use crate::photometry::luminous::Luminous;
use crate::photometry::{alpha_opic, mesopic};
use crate::spectrum::integrate::dot;
use crate::spectrum::{Quantity, Sampling, Spectrum, largest};

/// A figure of a conversion, of the quantity measured. Derived quantities are a factor times it and have its relative uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Measurand {
    /// ∫ X_λ dλ, W/m² ….
    Radiometric,
    /// Photopic quantity, lx ….
    Photopic,
    /// Scotopic quantity, lx ….
    Scotopic,
    /// Mesopic quantity, lx ….
    Mesopic,
    /// Luminous efficacy of radiation, lm/W.
    Efficacy,
    /// S/P ratio.
    ScotopicPhotopicRatio,
    /// Tristimulus value X, Y or Z, by index.
    Tristimulus(usize),
    /// Chromaticity x or y.
    Chromaticity(usize),
    /// Chromaticity u′ or v′.
    UniformChromaticity(usize),
    /// Correlated colour temperature, K.
    Cct,
    /// Distance from the Planckian locus in (u, v) 1960.
    Duv,
    /// Whiteness W of a reflectance.
    Whiteness,
    /// Tint T of a reflectance.
    Tint,
    /// Yellowness YI of a reflectance.
    Yellowness,
    /// Dominant wavelength, nm, of the same sign as the measured one.
    DominantWavelength,
    /// Excitation purity.
    ExcitationPurity,
    /// Wavelength of the largest sample, nm.
    PeakWavelength,
    /// ∫λS/∫S, nm.
    CentroidWavelength,
    /// Full width at half maximum, nm.
    Fwhm,
    /// General colour rendering index.
    Ra,
    /// Special colour rendering index, R1 at 0.
    SpecialIndex(usize),
    /// TM-30 fidelity index.
    Rf,
    /// TM-30 gamut index.
    Rg,
    /// α-opic daylight efficacy ratio of a receptor of [`crate::photometry::alpha_opic::RECEPTORS`].
    DaylightEfficacyRatio(usize),
    /// α-opic efficacy of luminous radiation, W/lm.
    AlphaOpicEfficacy(usize),
    /// α-opic equivalent daylight quantity, lx ….
    EquivalentDaylight(usize),
    /// α-opic radiometric quantity, W/m² ….
    AlphaOpic(usize),
    /// Weighted with a function of [`crate::photometry::hazard::WEIGHTINGS`], by its key.
    Hazard(&'static str),
    /// All photons, µmol ….
    Photons,
    /// Photons of 400–700 nm, µmol ….
    PhotonsPar,
    /// Those per joule of the whole spectrum, µmol/J.
    PhotonsPerJoule,
    /// Those per joule of 400–700 nm, µmol/J.
    PhotonsPerParJoule,
}

impl Measurand {
    /// Whether the figure of an absolute spectrum is proportional to its samples: first-order propagation is exact.
    #[must_use]
    pub fn is_linear(self) -> bool {
        matches!(
            self,
            Self::Radiometric
                | Self::Photopic
                | Self::Scotopic
                | Self::Tristimulus(_)
                | Self::EquivalentDaylight(_)
                | Self::AlphaOpic(_)
                | Self::Hazard(_)
                | Self::Photons
                | Self::PhotonsPar
        )
    }
}

impl fmt::Display for Measurand {
    /// The figure's usual name.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let receptor = |k: &usize| alpha_opic::RECEPTORS[*k].replace('_', "-");
        match self {
            Self::Radiometric => f.write_str("radiometric quantity"),
            Self::Photopic => f.write_str("photopic quantity"),
            Self::Scotopic => f.write_str("scotopic quantity"),
            Self::Mesopic => f.write_str("mesopic quantity"),
            Self::Efficacy => f.write_str("efficacy of radiation"),
            Self::ScotopicPhotopicRatio => f.write_str("S/P ratio"),
            Self::Tristimulus(k) => f.write_str(["X", "Y", "Z"][*k]),
            Self::Chromaticity(k) => f.write_str(["x", "y"][*k]),
            Self::UniformChromaticity(k) => f.write_str(["u′", "v′"][*k]),
            Self::Cct => f.write_str("CCT"),
            Self::Duv => f.write_str("Duv"),
            Self::Whiteness => f.write_str("whiteness"),
            Self::Tint => f.write_str("tint"),
            Self::Yellowness => f.write_str("yellowness"),
            Self::DominantWavelength => f.write_str("dominant wavelength"),
            Self::ExcitationPurity => f.write_str("excitation purity"),
            Self::PeakWavelength => f.write_str("peak wavelength"),
            Self::CentroidWavelength => f.write_str("centroid wavelength"),
            Self::Fwhm => f.write_str("FWHM"),
            Self::Ra => f.write_str("Ra"),
            Self::SpecialIndex(k) => write!(f, "R{}", k + 1),
            Self::Rf => f.write_str("Rf"),
            Self::Rg => f.write_str("Rg"),
            Self::DaylightEfficacyRatio(k) => write!(f, "{} DER", receptor(k)),
            Self::AlphaOpicEfficacy(k) => write!(f, "{} efficacy", receptor(k)),
            Self::EquivalentDaylight(k) => write!(f, "{} equivalent daylight quantity", receptor(k)),
            Self::AlphaOpic(k) => write!(f, "{} quantity", receptor(k)),
            Self::Hazard(key) => write!(f, "{} weighted quantity", key.replace('_', "-")),
            Self::Photons => f.write_str("photons"),
            Self::PhotonsPar => f.write_str("PAR photons"),
            Self::PhotonsPerJoule => f.write_str("PAR photons per joule"),
            Self::PhotonsPerParJoule => f.write_str("PAR photons per joule of PAR"),
        }
    }
}

/// Room for evaluations, kept from one to the next.
#[derive(Debug, Clone, Default)]
pub(super) struct Scratch {
    scaled: Vec<f64>,
    reflected: Vec<f64>,
    reference: ReferenceScratch,
}

/// All figures of spectra on one grid.
#[derive(Debug)]
pub(super) struct Figures<'a> {
    settings: &'a Settings,
    plan: Arc<Plan>,
    quantity: Quantity,
    /// The spectrum as measured, where it is resampled.
    measured: Option<Spectrum>,
    /// Whether the dominant wavelength is a complementary one.
    complementary: bool,
    pub list: Vec<Measurand>,
    /// Values of the spectrum as measured, NaN where undefined.
    pub values: Vec<f64>,
}

impl<'a> Figures<'a> {
    pub(super) fn new(converter: &'a Converter, quantity: Quantity, spectrum: &Spectrum) -> Result<Self, Error> {
        let settings = converter.settings();
        let resampled = settings.regridded(spectrum)?;
        let used = resampled.as_ref().unwrap_or(spectrum);
        let mut out = Self {
            settings,
            plan: converter.plan(used.grid(), used.sampling())?,
            quantity,
            measured: resampled.is_some().then(|| spectrum.clone()),
            complementary: false,
            list: Vec::new(),
            values: Vec::new(),
        };
        let (mut list, mut values) = (Vec::new(), Vec::new());
        out.each(spectrum.values(), &mut Scratch::default(), |m, v| {
            list.push(m);
            values.push(v);
        });
        let wavelength = list.iter().position(|m| *m == Measurand::DominantWavelength).map(|i| values[i]);
        out.complementary = wavelength.is_some_and(|w| w < 0.0);
        (out.list, out.values) = (list, values);
        Ok(out)
    }

    /// Calls `put` with every figure of `list`, in its order, and its value, NaN where it is not defined.
    pub(super) fn each(&self, measured: &[f64], scratch: &mut Scratch, mut put: impl FnMut(Measurand, f64)) {
        let Scratch { scaled, reflected, reference } = scratch;
        let values = match &self.measured {
            Some(spectrum) => {
                let mut values = measured.iter();
                let resampled = (spectrum.map(|_, _| values.next().copied().unwrap_or(f64::NAN)).ok())
                    .and_then(|s| self.settings.regridded_like(&s, &self.plan.grid).ok());
                scaled.clear();
                match resampled {
                    Some(s) => scaled.extend_from_slice(s.values()),
                    None => scaled.resize(self.plan.grid.len(), f64::NAN),
                }
                &*scaled
            }
            None => measured,
        };
        let values = match &self.plan.light {
            Some(light) => {
                reflected.clear();
                reflected.extend_from_slice(values);
                light.shine(reflected);
                &*reflected
            }
            None => values,
        };
        let mut luminous = self.plan.luminous.evaluate(values);
        // A level holds one integral; every other goes with the factor.
        let factor = match &self.settings.level {
            Some(level) => level.factor(self.quantity, &luminous).unwrap_or(f64::NAN),
            None => 1.0,
        };
        luminous.radiometric *= factor;
        luminous.photopic *= factor;
        luminous.scotopic *= factor;
        let relative = self.quantity == Quantity::Relative && self.settings.level.is_none();
        self.luminous(&luminous, relative, &mut put);
        let xyz = self.plan.colour.xyz(values);
        let colour_scale = match &self.plan.light {
            Some(light) => light.scale(),
            None if relative => 100.0 / xyz[1],
            None => factor * self.settings.efficacy.k_m,
        };
        for (k, v) in xyz.iter().enumerate() {
            put(Measurand::Tristimulus(k), v * colour_scale);
        }
        self.chromaticity(values, xyz, &mut put);
        if let Some(light) = self.plan.light.as_ref().filter(|l| l.has_whiteness()) {
            let found = light.whiteness(xyz.map(|v| v * colour_scale));
            put(Measurand::Whiteness, found.map_or(f64::NAN, |w| w.whiteness));
            put(Measurand::Tint, found.map_or(f64::NAN, |w| w.tint));
            put(Measurand::Yellowness, found.map_or(f64::NAN, |w| w.yellowness));
        }
        self.shape(values, &mut put);
        self.rendition(values, reference, &mut put);
        if let Some(plan) = &self.plan.alpha_opic {
            for (k, a) in plan.evaluate(values).iter().enumerate() {
                put(Measurand::DaylightEfficacyRatio(k), a.der.unwrap_or(f64::NAN));
                put(Measurand::AlphaOpicEfficacy(k), a.efficacy_w_per_lm.unwrap_or(f64::NAN));
                if !relative {
                    put(Measurand::EquivalentDaylight(k), factor * a.equivalent_daylight);
                    put(Measurand::AlphaOpic(k), factor * a.radiometric);
                }
            }
        }
        if let Some(plan) = self.plan.hazard.as_ref().filter(|_| !relative) {
            for h in plan.evaluate(values).filter(|h| h.covered_nm.is_some()) {
                put(Measurand::Hazard(h.key), factor * h.weighted);
            }
        }
        if let Some(plan) = &self.plan.photon {
            let p = plan.evaluate(values);
            if !relative {
                put(Measurand::Photons, factor * p.total_umol);
                put(Measurand::PhotonsPar, factor * p.par_umol);
            }
            put(Measurand::PhotonsPerJoule, p.umol_per_j.unwrap_or(f64::NAN));
            put(Measurand::PhotonsPerParJoule, p.par_umol_per_par_j.unwrap_or(f64::NAN));
        }
    }

    fn luminous(&self, luminous: &Luminous, relative: bool, put: &mut impl FnMut(Measurand, f64)) {
        let ratio = luminous.scotopic_photopic_ratio().unwrap_or(f64::NAN);
        if !relative {
            put(Measurand::Radiometric, luminous.radiometric);
            put(Measurand::Photopic, luminous.photopic);
            put(Measurand::Scotopic, luminous.scotopic);
            if let Some(luminance) = self.settings.mesopic_adaptation {
                let state = Some(ratio).filter(|r| *r >= 0.0).and_then(|r| mesopic::adaptation(luminance, r).ok());
                let value = state.map(|s| mesopic::mesopic(luminous.photopic, luminous.scotopic, s.m));
                put(Measurand::Mesopic, value.unwrap_or(f64::NAN));
            }
        }
        put(Measurand::Efficacy, luminous.efficacy_lm_per_w().unwrap_or(f64::NAN));
        put(Measurand::ScotopicPhotopicRatio, ratio);
    }

    fn chromaticity(&self, values: &[f64], xyz: [f64; 3], put: &mut impl FnMut(Measurand, f64)) {
        const UNDEFINED: [f64; 2] = [f64::NAN; 2];
        let xy = chromaticity::xy(xyz).filter(|_| xyz[1] > 0.0);
        for (k, value) in xy.unwrap_or(UNDEFINED).into_iter().enumerate() {
            put(Measurand::Chromaticity(k), value);
        }
        for (k, value) in chromaticity::uv_prime(xyz).unwrap_or(UNDEFINED).into_iter().enumerate() {
            put(Measurand::UniformChromaticity(k), value);
        }
        if !self.settings.groups.colour {
            return;
        }
        let xyz_1931 = self.plan.colour_1931.as_ref().map_or(xyz, |p| p.xyz(values));
        let found = chromaticity::uv_1960(xyz_1931)
            .and_then(|uv| cct::correlated(uv, self.settings.cct_method, self.settings.c2).ok());
        put(Measurand::Cct, found.map_or(f64::NAN, |c| c.kelvin));
        put(Measurand::Duv, found.map_or(f64::NAN, |c| c.duv));
        let white = self.plan.light.as_ref().map_or(self.settings.dominant_white_xy, |l| l.white_xy);
        let found = xy
            .and_then(|xy| dominant::dominant(xy, white, self.settings.observer))
            // While the sign of the measured one is not known, any counts: see `new`.
            .filter(|d| self.list.is_empty() || (d.wavelength_nm < 0.0) == self.complementary);
        put(Measurand::DominantWavelength, found.map_or(f64::NAN, |d| d.wavelength_nm));
        put(Measurand::ExcitationPurity, found.map_or(f64::NAN, |d| d.excitation_purity));
    }

    fn shape(&self, values: &[f64], put: &mut impl FnMut(Measurand, f64)) {
        if !self.settings.groups.shape {
            return;
        }
        let x = self.plan.grid.wavelengths_nm();
        let at = largest(values);
        let peak = values[at];
        put(Measurand::PeakWavelength, if peak > 0.0 { x[at] } else { f64::NAN });
        put(
            Measurand::CentroidWavelength,
            dot(&self.plan.centroid, values) / self.plan.luminous.evaluate(values).radiometric,
        );
        if self.plan.sampling == Sampling::Density {
            put(Measurand::Fwhm, shape::full_width(x, values, at, 0.5 * peak).unwrap_or(f64::NAN));
        }
    }

    fn rendition(&self, values: &[f64], reference: &mut ReferenceScratch, put: &mut impl FnMut(Measurand, f64)) {
        let kelvin = |xyz: [f64; 3]| {
            chromaticity::uv_1960(xyz).and_then(|uv| cct::nearest(uv, self.settings.c2).ok()).map(|c| c.kelvin)
        };
        if let Some(plan) = &self.plan.cri {
            let observer = self.plan.colour_1931.as_ref().unwrap_or(&self.plan.colour);
            let found = kelvin(observer.xyz(values)).and_then(|k| plan.evaluate_in(reference, values, k).ok());
            put(Measurand::Ra, found.map_or(f64::NAN, |c| c.ra));
            for i in 0..cri::SAMPLES {
                put(Measurand::SpecialIndex(i), found.map_or(f64::NAN, |c| c.r[i]));
            }
        }
        if let Some((plan, observer)) = &self.plan.tm30 {
            let found = kelvin(observer.xyz(values)).and_then(|k| plan.evaluate_in(reference, values, k).ok());
            put(Measurand::Rf, found.as_ref().map_or(f64::NAN, |t| t.rf));
            put(Measurand::Rg, found.and_then(|t| t.rg).unwrap_or(f64::NAN));
        }
    }

    /// Whether amounts go with the samples, and are not held by a level or by Y = 100; those of a reflectance do.
    pub(super) fn is_proportional(&self) -> bool {
        self.plan.light.is_some() || (self.quantity != Quantity::Relative && self.settings.level.is_none())
    }
}

impl Outputs for Figures<'_> {
    type Scratch = Scratch;

    fn count(&self) -> usize {
        self.list.len()
    }

    fn evaluate(&self, measured: &[f64], scratch: &mut Scratch, out: &mut [f64]) {
        let mut out = out.iter_mut();
        self.each(measured, scratch, |_, value| {
            if let Some(place) = out.next() {
                *place = value;
            }
        });
    }
}

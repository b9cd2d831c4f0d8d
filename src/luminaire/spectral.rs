//! A lamp's intensities with its spectrum: every quantity from one that the file has.
//!
//! A file in candela and the shape of a spectrum S(λ) make the spectral flux Φ_λ = s S with K_m ∫ Φ_λ V dλ = Φ_v; a file in W/sr has
//! ∫ Φ_λ dλ = Φ_e, one in µmol/(s·sr) ∫ Φ_λ λ/(N_A h c) dλ = Φ_p, all wavelengths of the spectrum counted. The factors between
//! quantities are those of this spectrum, the same in every direction. A file with [angular spectra](AngularSpectra) has them in
//! absolute measure, one spectrum per direction. All integrals are those of a [`Converter`].

use super::colour::{self, ColourOverAngle};
use super::{AngularSpectra, Kind, Luminaire};
use crate::conversion::{self, Conversion, Converter};
use crate::finding::{Checked, Finding};
use crate::photometry::transfer::Geometry;
use crate::spectrum::{self, Quantity, Spectrum};

/// Why a lamp and a spectrum do not combine.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The lamp's flux or its peak is not positive.
    #[error("the intensities integrate to {flux}, their peak is {peak}; expected a lamp that shines")]
    Dark {
        /// Flux, in the file's unit.
        flux: f64,
        /// Largest intensity.
        peak: f64,
    },
    /// The spectrum has nothing of the kind that the intensities are.
    #[error(
        "the spectrum has no {what} content (its integral is {found}), to which intensities in {unit} could be scaled"
    )]
    NoContent {
        /// `luminous`, `radiant`, `photon`.
        what: &'static str,
        /// Unit of the intensities.
        unit: &'static str,
        /// What spectrum or lamp would do.
        expected: &'static str,
        /// The integral.
        found: f64,
    },
    /// The spectrum cannot be converted.
    #[error(transparent)]
    Conversion(#[from] conversion::Error),
    /// A scaled spectrum is not one: values beyond the largest double.
    #[error(transparent)]
    Spectrum(#[from] spectrum::Error),
    /// A table of intensities is not one: values beyond the largest double.
    #[error(transparent)]
    Table(#[from] super::Error),
}

/// Intensities in one direction, in all quantities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intensities {
    /// cd.
    pub luminous_cd: f64,
    /// W/sr.
    pub radiant_w_per_sr: f64,
    /// All photons, µmol/(s·sr).
    pub photon_umol_per_s_sr: f64,
    /// Photons of 400–700 nm, µmol/(s·sr).
    pub par_umol_per_s_sr: f64,
    /// Melanopic, W/sr (CIE S 026).
    pub melanopic_w_per_sr: f64,
    /// Melanopic equivalent daylight (D65) intensity, cd.
    pub melanopic_daylight_cd: f64,
    /// Weighted by B(λ), W/sr; `None` where the spectrum covers nothing of it.
    pub blue_light_w_per_sr: Option<f64>,
    /// Weighted by S(λ), W/sr; `None` where the spectrum covers nothing of it.
    pub actinic_uv_w_per_sr: Option<f64>,
}

impl Intensities {
    /// Of a conversion with all groups of figures.
    fn of(c: &Conversion) -> Self {
        let whole = c.absolute.first();
        let melanopic = c.alpha_opic.iter().find(|a| a.receptor == "melanopic");
        let hazard = |key: &str| c.hazard.iter().find(|h| h.key == key).map(|h| h.weighted);
        Self {
            luminous_cd: whole.map_or(0.0, |f| f.photopic),
            radiant_w_per_sr: whole.map_or(0.0, |f| f.radiometric),
            photon_umol_per_s_sr: c.photons.map_or(0.0, |p| p.total_umol),
            par_umol_per_s_sr: c.photons.map_or(0.0, |p| p.par_umol),
            melanopic_w_per_sr: melanopic.map_or(0.0, |a| a.radiometric),
            melanopic_daylight_cd: melanopic.map_or(0.0, |a| a.equivalent_daylight),
            blue_light_w_per_sr: hazard("blue_light"),
            actinic_uv_w_per_sr: hazard("actinic_uv"),
        }
    }

    fn scaled(&self, factor: f64) -> Self {
        Self {
            luminous_cd: self.luminous_cd * factor,
            radiant_w_per_sr: self.radiant_w_per_sr * factor,
            photon_umol_per_s_sr: self.photon_umol_per_s_sr * factor,
            par_umol_per_s_sr: self.par_umol_per_s_sr * factor,
            melanopic_w_per_sr: self.melanopic_w_per_sr * factor,
            melanopic_daylight_cd: self.melanopic_daylight_cd * factor,
            blue_light_w_per_sr: self.blue_light_w_per_sr.map(|v| v * factor),
            actinic_uv_w_per_sr: self.actinic_uv_w_per_sr.map(|v| v * factor),
        }
    }

    /// The intensity of a kind: cd, W/sr, µmol/(s·sr).
    #[must_use]
    pub fn of_kind(&self, kind: Kind) -> f64 {
        match kind {
            Kind::Luminous => self.luminous_cd,
            Kind::Radiant => self.radiant_w_per_sr,
            Kind::Photon => self.photon_umol_per_s_sr,
        }
    }
}

/// A tabulated direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// C-plane or horizontal angle, degrees.
    pub horizontal_deg: f64,
    /// γ or vertical angle, degrees.
    pub vertical_deg: f64,
    /// Its intensities.
    pub intensities: Intensities,
}

/// A lamp and its spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectralLamp {
    /// Spectral flux, W/nm.
    pub spectrum: Spectrum,
    /// Figures of the flux.
    pub flux: Conversion,
    /// Figures of the peak intensity, and of what it makes at the distance, where one is given.
    pub peak: Conversion,
    /// Index of the peak's direction.
    pub peak_direction: usize,
    /// All tabulated directions, plane by plane, in the order of the lamp's table (or of the angular spectra's).
    pub directions: Vec<Direction>,
    /// Colour by direction; `None` where one spectrum holds for all.
    pub colour: Option<ColourOverAngle>,
}

/// Combines a lamp with a spectrum of which only the shape counts. `geometry` leads from the peak intensity to irradiance; the
/// converter's settings need all groups of figures and no geometry or level of their own.
///
/// # Errors
/// [`Error`].
pub fn combine(
    lamp: &Luminaire,
    name: &str,
    shape: &Spectrum,
    converter: &Converter,
    geometry: &Geometry,
) -> Result<Checked<SpectralLamp>, Error> {
    let (own_flux, own_peak) = (lamp.distribution.total_flux(), lamp.distribution.peak().0);
    if !(own_flux > 0.0 && own_peak > 0.0) {
        return Err(Error::Dark { flux: own_flux, peak: own_peak });
    }
    let unscaled = Intensities::of(&converter.convert(name, Quantity::Flux, shape)?.value);
    let content = unscaled.of_kind(lamp.kind);
    let factor = own_flux / content;
    if !(content > 0.0 && factor.is_finite()) {
        let (what, unit, expected) = match lamp.kind {
            Kind::Luminous => ("luminous", "cd", "light between 360 nm and 830 nm, or a lamp in W/sr"),
            Kind::Radiant => ("radiant", "W/sr", "a positive spectrum"),
            Kind::Photon => ("photon", "µmol/(s·sr)", "a positive spectrum"),
        };
        return Err(Error::NoContent { what, unit, expected, found: content });
    }
    let spectrum = shape.map(|_, v| v * factor)?;
    let flux = converter.convert(name, Quantity::Flux, &spectrum)?;
    let unit = Intensities::of(&flux.value).scaled(1.0 / own_flux);
    let (horizontal, vertical) = (lamp.distribution.horizontal_deg(), lamp.distribution.vertical_deg());
    let directions: Vec<Direction> = (lamp.distribution.values().iter().enumerate())
        .map(|(i, value)| Direction {
            horizontal_deg: horizontal[i / vertical.len()],
            vertical_deg: vertical[i % vertical.len()],
            intensities: unit.scaled(*value),
        })
        .collect();
    let peak_direction = largest(lamp.distribution.values().iter().copied());
    let at_peak = spectrum.map(|_, v| v * (own_peak / own_flux))?;
    let peak = with_geometry(converter, geometry).convert(name, Quantity::Intensity, &at_peak)?;
    let findings = merged(flux.findings, peak.findings);
    let value = SpectralLamp { spectrum, flux: flux.value, peak: peak.value, peak_direction, directions, colour: None };
    Ok(Checked { value, findings })
}

/// The figures of angular spectra. The peak is that of the luminous intensity, or of the radiant where there is no light.
///
/// # Errors
/// [`Error`].
pub fn by_direction(
    spectra: &AngularSpectra,
    name: &str,
    converter: &Converter,
    geometry: &Geometry,
) -> Result<Checked<SpectralLamp>, Error> {
    let spectrum = spectra.power()?;
    let flux = converter.convert(name, Quantity::Flux, &spectrum)?;
    let mut conversions = Vec::with_capacity(spectra.directions());
    for direction in 0..spectra.directions() {
        conversions.push(converter.convert(name, Quantity::Intensity, &spectra.spectrum(direction)?)?.value);
    }
    let directions: Vec<Direction> = (conversions.iter().enumerate())
        .map(|(i, c)| {
            let (horizontal_deg, vertical_deg) = spectra.angles_deg(i);
            Direction { horizontal_deg, vertical_deg, intensities: Intensities::of(c) }
        })
        .collect();
    let total = Intensities::of(&flux.value);
    let kind = if total.luminous_cd > 0.0 { Kind::Luminous } else { Kind::Radiant };
    let peak_direction = largest(directions.iter().map(|d| d.intensities.of_kind(kind)));
    let own_peak = directions[peak_direction].intensities.of_kind(kind);
    if !(total.of_kind(kind) > 0.0 && own_peak > 0.0) {
        return Err(Error::Dark { flux: total.of_kind(kind), peak: own_peak });
    }
    let at_peak = spectra.spectrum(peak_direction)?;
    let peak = with_geometry(converter, geometry).convert(name, Quantity::Intensity, &at_peak)?;
    let mut findings = merged(flux.findings, peak.findings);
    let solid_angles_sr = spectra.frame().solid_angles_sr();
    let colour = colour::over_angle(&conversions, &flux.value, &solid_angles_sr);
    if let Some(none) = colour.as_ref().map(|c| c.without_temperature()).filter(|n| *n > 0) {
        let message = format!("no colour temperature in {none} of {} directions that have light", directions.len());
        findings.push(Finding::info("L530", message));
    }
    let value = SpectralLamp { spectrum, flux: flux.value, peak: peak.value, peak_direction, directions, colour };
    Ok(Checked { value, findings })
}

impl SpectralLamp {
    /// The total flux of a kind: lm, W, µmol/s.
    #[must_use]
    pub fn total_flux(&self, kind: Kind) -> f64 {
        Intensities::of(&self.flux).of_kind(kind)
    }

    /// The direction where a figure is largest, and its value; `None` where no direction has the figure.
    #[must_use]
    pub fn peak_of(&self, figure: impl Fn(&Intensities) -> Option<f64>) -> Option<(&Direction, f64)> {
        let all = self.directions.iter().filter_map(|d| Some((d, figure(&d.intensities)?)));
        all.fold(None, |best: Option<(&Direction, f64)>, next| match best {
            Some(best) if best.1 >= next.1 => Some(best),
            _ => Some(next),
        })
    }

    /// The luminaire with its spectrum (W/nm) and its intensities in the quantity of a kind. Angular spectra stay where the
    /// figures are theirs; declared values of another quantity are left out.
    ///
    /// # Errors
    /// [`Error::Table`] where an intensity is beyond the largest double.
    pub fn luminaire(&self, lamp: &Luminaire, kind: Kind) -> Result<Luminaire, Error> {
        let angular_spectra = lamp.angular_spectra.clone().filter(|_| self.colour.is_some());
        let frame = angular_spectra.as_ref().map_or(&lamp.distribution, AngularSpectra::frame);
        let values = self.directions.iter().map(|d| d.intensities.of_kind(kind)).collect();
        let same = kind == lamp.kind;
        Ok(Luminaire {
            kind,
            distribution: frame.with_values(values)?,
            absolute: lamp.absolute || !same,
            declared_flux: lamp.declared_flux.filter(|_| same),
            declared_output_ratio: lamp.declared_output_ratio.filter(|_| same),
            spectrum: Some(self.spectrum.clone()),
            angular_spectra,
            ..lamp.clone()
        })
    }
}

fn with_geometry(converter: &Converter, geometry: &Geometry) -> Converter {
    Converter::new(conversion::Settings { geometry: *geometry, ..converter.settings().clone() })
}

/// Index of the largest value, the first of several equal ones.
fn largest(values: impl Iterator<Item = f64>) -> usize {
    values.enumerate().fold((0, f64::NEG_INFINITY), |best, v| if v.1 > best.1 { v } else { best }).0
}

/// The same findings of flux and peak are told once.
fn merged(mut findings: Vec<Finding>, more: Vec<Finding>) -> Vec<Finding> {
    findings.retain(|f| !more.contains(f));
    findings.extend(more);
    findings
}

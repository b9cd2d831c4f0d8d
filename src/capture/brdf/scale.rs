//! The strength of a light from a diffuse sphere of known reflectance in the object's place.

use std::f64::consts::PI;

use super::Observations;
use super::bins::robust_mean;
use crate::capture::setup::Reference;

/// A light's strength by a reference.
#[derive(Debug, Clone, PartialEq)]
pub struct Strength {
    /// Per band, in the unit of the pictures.
    pub values: Vec<f64>,
    /// Its relative standard error per band from the noise of the reference's measurements: those of one light have it in common.
    pub relative_errors: Vec<f64>,
    /// Standard deviation of the measurements from their mean, relative, of the worst band: what the reference lacks in being diffuse, besides noise.
    pub deviation_rms: f64,
}

/// Strength of a light from measurements of the reference that were made as though its strength were 1.
///
/// A diffuse surface of reflectance ρ has f_r = ρ/π everywhere: the strength is the robust mean of the measurements times π/ρ. One reflectance
/// stands for all bands. `None` without measurements, or for another number of reflectances.
#[must_use]
pub fn strength_from(measured: &Observations, reference: &Reference) -> Option<Strength> {
    let (bands, reflectance) = (measured.channels.len(), &reference.reflectance);
    if measured.is_empty() || !(reflectance.len() == 1 || reflectance.len() == bands) {
        return None;
    }
    let mut out = Strength { values: Vec::new(), relative_errors: Vec::new(), deviation_rms: 0.0 };
    for band in 0..bands {
        let of = |all: &[f64]| all.iter().skip(band).step_by(bands).copied().collect::<Vec<f64>>();
        let (values, errors) = (of(&measured.values), of(&measured.errors));
        let (mean, error, _) = robust_mean(&values, &errors);
        let variance = values.iter().map(|v| (v / mean - 1.0).powi(2)).sum::<f64>() / values.len() as f64;
        out.deviation_rms = out.deviation_rms.max(variance.sqrt());
        out.values.push(mean * PI / reflectance[band.min(reflectance.len() - 1)]);
        // Of a single measurement without σ the error is unknown.
        out.relative_errors.push(error / mean);
    }
    Some(out)
}

/// Relative standard uncertainty of the scale per band, or one for all: that of the reflectance, which all measurements have in common.
#[must_use]
pub fn reference_factor_sd(reference: &Reference) -> Vec<f64> {
    reference.reflectance.iter().zip(&reference.reflectance_sd).map(|(rho, u)| u / rho).collect()
}

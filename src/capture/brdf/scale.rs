//! The strength of a light from a diffuse sphere of known reflectance in the object's place.

use super::Observations;
use super::bins::robust_mean;

/// Strength of a light per band, in the unit of the pictures, from measurements of the reference that were made as though its strength were
/// 1; and the standard deviation of those measurements from their mean, relative: what the reference lacks in being diffuse, besides noise.
///
/// A diffuse surface of reflectance ρ has f_r = ρ/π everywhere: the strength is the robust mean of the measurements times π/ρ. One reflectance
/// stands for all bands. `None` without measurements, or for another number of reflectances.
#[must_use]
pub fn strength_from(reference: &Observations, reflectance: &[f64]) -> Option<(Vec<f64>, f64)> {
    let bands = reference.channels.len();
    if reference.is_empty() || !(reflectance.len() == 1 || reflectance.len() == bands) {
        return None;
    }
    let mut worst: f64 = 0.0;
    let one = |band: usize| {
        let of = |all: &[f64]| all.iter().skip(band).step_by(bands).copied().collect::<Vec<f64>>();
        let (values, errors) = (of(&reference.values), of(&reference.errors));
        let (mean, _, _) = robust_mean(&values, &errors);
        let variance = values.iter().map(|v| (v / mean - 1.0).powi(2)).sum::<f64>() / values.len() as f64;
        worst = worst.max(variance.sqrt());
        mean * std::f64::consts::PI / reflectance[band.min(reflectance.len() - 1)]
    };
    let strength = (0..bands).map(one).collect();
    Some((strength, worst))
}

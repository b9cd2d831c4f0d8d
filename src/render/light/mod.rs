//! Lights that are no surface of the scene: points, spots, luminaires, distant lights, skies, pictures of surroundings.
//!
//! (A surface that emits is a shape with an emission; the scene makes a light of it.)

use glam::DVec3;

pub mod area;

use super::ray::{Ray, Towards};

/// A light without a surface. All slices have one element per band.
pub trait Light: std::fmt::Debug + Send + Sync {
    /// Draws a direction from the point `from` towards the light from three uniform numbers, and writes what arrives from there if
    /// nothing is in between: radiance for a light of some extent; for a Dirac light the irradiance on a surface that faces it
    /// (I/r² of a point, E of a distant light), in W/(m²·nm) or, in a line band, W/m². `None` where the light does not shine.
    fn sample_towards(&self, from: DVec3, u: [f64; 3], arriving: &mut [f64]) -> Option<Towards>;

    /// The density per solid angle with which [`Light::sample_towards`] draws `direction` from `from`; 0 for Dirac lights.
    fn pdf_towards(&self, from: DVec3, direction: DVec3) -> f64 {
        let _ = (from, direction);
        0.0
    }

    /// Adds the radiance that a ray which leaves the scene in `direction` (unit, away from the scene) meets; Dirac lights add none.
    fn add_radiance(&self, direction: DVec3, radiance: &mut [f64]) {
        let _ = (direction, radiance);
    }

    /// Draws a ray of the light that it sends out, from five uniform numbers, and writes flux / pdf per band, W/nm or W: the mean over
    /// draws is the light's whole flux (for a light at infinity: the flux through the scene's bounding sphere). `None`: a draw of zero flux.
    fn emit(&self, u: [f64; 5], flux: &mut [f64]) -> Option<Ray>;

    /// Writes the whole radiant flux per band, W/nm or W; for a light at infinity that through the scene's bounding sphere.
    fn flux(&self, flux: &mut [f64]);

    /// A bound on the irradiance that it can make on a surface near `from`, summed over the bands, to choose between lights; any
    /// positive figure is right, a close one makes less noise.
    fn importance(&self, from: DVec3) -> f64;
}

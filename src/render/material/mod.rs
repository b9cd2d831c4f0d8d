//! Scattering at a surface, reflection and transmission, for the bands of a render.

use glam::DVec3;

pub mod opaque;

/// A direction drawn by [`Material::sample`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scattered {
    /// The drawn direction in the local frame, away from the surface; z < 0 on the inside.
    pub direction: DVec3,
    /// Its density per solid angle; the probability of the choice for a Dirac lobe.
    pub pdf: f64,
    /// The direction belongs to a Dirac lobe, which [`Material::evaluate`] and [`Material::pdf`] know nothing of.
    pub delta: bool,
    /// The draw holds for one band only (its direction depends on the wavelength): the weights of the others are 0.
    pub split: bool,
}

/// Which quantity a path carries: radiance scales with n² when it is refracted, flux does not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Transport {
    /// A path from a sensor.
    Radiance,
    /// A path from a light.
    Flux,
}

/// A bidirectional scattering distribution function f_s on the bands of a render, in the local frame of a surface: +z is the outside.
///
/// Slices have one element per band. f_s is in 1/sr and has no cosine in it.
pub trait Material: std::fmt::Debug + Send + Sync {
    /// Writes f_s(ω_i, ω_o), no Dirac lobes.
    fn evaluate(&self, incident: DVec3, outgoing: DVec3, transport: Transport, values: &mut [f64]);

    /// Draws ω_i for a given ω_o from three uniform numbers and writes f_s |cosθ_i| / pdf per band (Dirac lobe: share / probability).
    ///
    /// Where the direction depends on the wavelength, it is that of the band `hero`, the other bands get weight 0, and the draw is
    /// marked `split`; the caller, who chose the hero, divides by the probability of that choice.
    fn sample(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        transport: Transport,
        hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered>;

    /// Density per solid angle with which [`Material::sample`] draws `incident`, outside of Dirac lobes.
    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64;

    /// Whether all that it scatters is in Dirac lobes (mirrors, polished glass, black): no light is sought for it.
    fn is_delta(&self) -> bool {
        false
    }

    /// Whether light can pass to the other side.
    fn is_transmissive(&self) -> bool {
        false
    }
}

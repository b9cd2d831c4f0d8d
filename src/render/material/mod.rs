//! Scattering at a surface, reflection and transmission, for the bands of a render.
//!
//! | file | what it is |
//! |---|---|
//! | [`opaque`] | any [`Brdf`](crate::brdf::Brdf), on one side or on both |
//! | [`measured`] | a measured table |
//! | [`compensated`], [`albedo`] | rough metal that loses nothing; the table that tells what one scattering loses |
//! | [`dielectric`], [`rough_dielectric`] | polished and ground glass, water: reflect and refract |
//! | [`thin_slab`] | a pane without thickness, all reflections inside |
//! | [`mixture`], [`textured`] | shares of a surface; factors that vary from place to place |
//! | [`fluorescent`] | a diffuser that changes wavelengths |

use glam::{DVec2, DVec3};

use crate::brdf::fresnel::Components;

pub mod albedo;
pub mod compensated;
pub mod dielectric;
pub mod fluorescent;
pub mod measured;
pub mod mixture;
pub mod opaque;
pub mod rough_dielectric;
#[cfg(test)]
mod tests;
pub mod textured;
pub mod thin_slab;

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
    /// n of the medium that the direction leads into over n of the one that ω_o is in: 1 where both are on the same side.
    pub eta: f64,
}

/// What a material asks of the model of light beyond a colour for every pair of directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Nature {
    /// It refracts wavelengths in different directions.
    pub disperses: bool,
    /// It changes wavelengths.
    pub fluoresces: bool,
    /// Turning it about its normal changes what it scatters.
    pub anisotropic: bool,
}

impl Nature {
    /// That of both together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            disperses: self.disperses || other.disperses,
            fluoresces: self.fluoresces || other.fluoresces,
            anisotropic: self.anisotropic || other.anisotropic,
        }
    }
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

    /// The same for a path that carries the band `hero` alone: no other weight has to be written, and the choice among lobes may be the better
    /// one for that band.
    fn sample_band(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        transport: Transport,
        hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        self.sample(outgoing, u, transport, hero, weights)
    }

    /// Density per solid angle with which [`Material::sample`] draws `incident`, outside of Dirac lobes, for the same `hero`.
    fn pdf(&self, outgoing: DVec3, incident: DVec3, hero: usize) -> f64;

    /// What befalls all light at a vertex, whatever its directions, before they are drawn: a texture's factors at `uv`, fluorescence.
    /// Changes the throughput of the path, with a slice to work in; `true` where bands took over from one another, so that a split path
    /// carries all of them again.
    fn convert(&self, uv: DVec2, transport: Transport, throughput: &mut [f64], scratch: &mut [f64]) -> bool {
        let _ = (uv, transport, throughput, scratch);
        false
    }

    /// Whether [`Material::convert`] does anything.
    fn converts(&self) -> bool {
        false
    }

    /// Writes per band, up to a factor, what polarised light keeps in the Dirac lobe between two directions; `false` where that is
    /// not known, and the lobe depolarises.
    fn polarise(&self, outgoing: DVec3, incident: DVec3, components: &mut [Components]) -> bool {
        let _ = (outgoing, incident, components);
        false
    }

    /// The same of the band `hero`: no other component has to be written.
    fn polarise_band(&self, outgoing: DVec3, incident: DVec3, hero: usize, components: &mut [Components]) -> bool {
        let _ = hero;
        self.polarise(outgoing, incident, components)
    }

    /// What it asks of the model of light.
    fn nature(&self) -> Nature {
        Nature { disperses: self.splits(), ..Nature::default() }
    }

    /// Writes the share that is scattered, per band, of what arrives from a direction, after [`Material::convert`], Dirac lobes included;
    /// gives a bound on its error, `None` where the share is not known.
    fn albedo(&self, arriving: DVec3, share: &mut [f64]) -> Option<f64> {
        let _ = (arriving, share);
        None
    }

    /// Whether wavelengths go different ways outside of Dirac lobes: a path carries its hero alone from there on.
    fn splits(&self) -> bool {
        false
    }

    /// Whether some of what it scatters is in Dirac lobes.
    fn has_delta(&self) -> bool {
        self.is_delta()
    }

    /// Whether all that it scatters is in Dirac lobes (mirrors, polished glass, black): no light is sought for it.
    fn is_delta(&self) -> bool {
        false
    }

    /// Whether it scatters into all directions of the side that is lit about alike, the same for all wavelengths.
    fn is_diffuse(&self) -> bool {
        false
    }

    /// Whether light can pass to the other side.
    fn is_transmissive(&self) -> bool {
        false
    }
}

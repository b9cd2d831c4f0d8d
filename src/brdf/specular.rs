//! Polished surfaces: the ideal mirror, smooth glass and smooth metal. All light leaves in the mirror direction.
//!
//! ```text
//! L_o(R) = F(θ) L_i,   R = 2 (n·ω_i) n − ω_i        f_r is a Dirac lobe: it has a reflectance and no value
//! ```
//!
//! | model | parameters |
//! |---|---|
//! | `mirror` | `reflectance` (0 to 1, spectral, default 1) at every angle |
//! | `dielectric` | `eta` or `medium`: Fresnel's reflectance of a dielectric; what is refracted is not part of a BRDF |
//! | `conductor` | `eta` and `k`, or `medium` |
//!
//! The parameters of an interface are those of [`fresnel`](super::fresnel). [`Brdf::evaluate`] is zero, [`Brdf::sample`] gives
//! the mirror direction with its flag.
//!
#![doc = include_str!("../../docs/brdf/specular.svg")]

use glam::DVec3;

use super::fresnel::{Components, ETA, Fresnel, K, MEDIUM, REFLECTANCE};
use super::parameter::Model;
use super::{Brdf, Sampled};
use crate::geometry::direction::mirror;

/// The ideal mirror.
pub const MIRROR: Model = Model {
    name: "mirror",
    summary: "ideal mirror (Dirac lobe)",
    parameters: &[REFLECTANCE.or(1.0)],
    build: |a| Ok(Box::new(Specular::new(Fresnel::constant(a.spectral(&REFLECTANCE.or(1.0))?)?))),
};

/// Smooth glass, from outside.
pub const DIELECTRIC: Model = Model {
    name: "dielectric",
    summary: "smooth dielectric (Dirac lobe), the reflected part",
    parameters: &[ETA, MEDIUM],
    build: |a| Ok(Box::new(Specular::new(Fresnel::from_arguments(a)?))),
};

/// Smooth metal.
pub const CONDUCTOR: Model = Model {
    name: "conductor",
    summary: "smooth metal (Dirac lobe)",
    parameters: &[ETA, K, MEDIUM],
    build: |a| Ok(Box::new(Specular::new(Fresnel::from_arguments(a)?))),
};

/// A polished surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Specular {
    fresnel: Fresnel,
}

impl Specular {
    /// A polished interface.
    #[must_use]
    pub fn new(fresnel: Fresnel) -> Self {
        Self { fresnel }
    }
}

impl Brdf for Specular {
    fn bands(&self) -> usize {
        self.fresnel.bands()
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn has_delta(&self) -> bool {
        true
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn evaluate(&self, _: DVec3, _: DVec3, values: &mut [f64]) {
        values.fill(0.0);
    }

    fn specular(&self, incident: DVec3, reflectance: &mut [f64]) {
        self.fresnel.write(incident.z, if incident.z > 0.0 { 1.0 } else { 0.0 }, reflectance);
    }

    fn polarise(&self, incident: DVec3, components: &mut [Components]) -> bool {
        self.fresnel.write_components(incident.z, components);
        true
    }

    fn sample(&self, outgoing: DVec3, _: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        let incident = mirror(outgoing);
        self.specular(incident, weights);
        (outgoing.z > 0.0).then_some(Sampled { incident, pdf: 1.0, delta: true })
    }

    fn pdf(&self, _: DVec3, _: DVec3) -> f64 {
        0.0
    }

    fn albedo(&self, incident: DVec3, reflectance: &mut [f64]) -> f64 {
        self.specular(incident, reflectance);
        0.0
    }
}

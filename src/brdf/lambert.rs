//! Lambert's ideal diffuse reflector: equally bright from everywhere.
//!
//! ```text
//! f_r = ρ/π        albedo ρ at every angle
//! ```
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `reflectance` | 0 to 1, spectral | ρ, the fraction of the light that is reflected |
//!
//! Pressed halon and matt paint come near it up to about 60°; no real surface keeps it towards grazing angles.
//!
//! Reference: J. H. Lambert, *Photometria* (1760).
//!
#![doc = include_str!("../../docs/brdf/lambert.svg")]

use std::f64::consts::{FRAC_1_PI, PI};

use glam::DVec3;

use super::parameter::{Error, Model, Parameter};
use super::{Brdf, Sampled};
use crate::math::sampling;

/// How the model is named and what it takes.
pub const MODEL: Model = Model {
    name: "lambert",
    summary: "ideal diffuse reflector, f = ρ/π",
    parameters: &[REFLECTANCE],
    build: |a| Ok(Box::new(Lambert::new(a.spectral(&REFLECTANCE)?)?)),
};

/// Fraction of the light that is reflected.
const REFLECTANCE: Parameter = Parameter::spectral("reflectance", 0.0, 1.0, "fraction of the light that is reflected");

/// Lambert's reflector.
#[derive(Debug, Clone, PartialEq)]
pub struct Lambert {
    reflectance: Vec<f64>,
}

impl Lambert {
    /// A reflector of `reflectance` (0 to 1) per band.
    ///
    /// # Errors
    /// [`Error::Range`] outside 0 to 1.
    pub fn new(reflectance: Vec<f64>) -> Result<Self, Error> {
        REFLECTANCE.check_all(&reflectance)?;
        Ok(Self { reflectance })
    }
}

impl Brdf for Lambert {
    fn bands(&self) -> usize {
        self.reflectance.len()
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn is_diffuse(&self) -> bool {
        true
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return values.fill(0.0);
        }
        values.iter_mut().zip(&self.reflectance).for_each(|(v, rho)| *v = rho * FRAC_1_PI);
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        let incident = sampling::cosine_hemisphere([u[1], u[2]]);
        // The cosine cancels: the weight is ρ itself, and stays so towards the horizon.
        weights.copy_from_slice(&self.reflectance);
        (outgoing.z > 0.0 && incident.z > 0.0).then_some(Sampled { incident, pdf: incident.z / PI, delta: false })
    }

    fn albedo(&self, incident: DVec3, reflectance: &mut [f64]) -> f64 {
        if incident.z > 0.0 {
            reflectance.copy_from_slice(&self.reflectance);
        } else {
            reflectance.fill(0.0);
        }
        0.0
    }
}

//! Löw's ABC microfacet model: a distribution from the scattering of optically smooth surfaces, with two free tails.
//!
//! ```text
//! f = k_d/π + F D G/(π cosθ_i cosθ_o),   D = A/(1 + B(1 − cosθ_h))^C
//! ```
//!
//! F is Fresnel's of a dielectric, G that of V-shaped grooves.
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `kd` | 0 up, spectral | diffuse part |
//! | `a` | 0 up, spectral | A, height of the peak; the scale is free |
//! | `b` | 0 up | B, inverse width |
//! | `c` | 0 up | C, steepness of the tail |
//! | `eta` | 1 to 1e3, spectral | refractive index |
//!
//! Reciprocal. Energy is not conserved by construction: A is fitted, and fits of bright metals pass 1 towards grazing angles.
//!
//! Reference: J. Löw, J. Kronander, A. Ynnerman & J. Unger, *BRDF Models for Accurate and Efficient Rendering of Glossy Surfaces*,
//! ACM TOG 31 (2012).
//!
#![doc = include_str!("../../docs/brdf/abc.svg")]

use std::f64::consts::{FRAC_1_PI, TAU};

use glam::DVec3;

use super::fresnel::{ETA, dielectric};
use super::parameter::{Error, Model, Parameter, same_bands};
use super::{Brdf, Sampled, reflected, sample_by};
use crate::math::sampling::{cosine_hemisphere, cosine_hemisphere_pdf, split};

const KD: Parameter = Parameter::spectral("kd", 0.0, f64::INFINITY, "diffuse part").or(0.0);
const A: Parameter = Parameter::spectral("a", 0.0, f64::INFINITY, "height of the peak");
const B: Parameter = Parameter::number("b", 0.0, f64::INFINITY, "inverse width");
const C: Parameter = Parameter::number("c", 0.0, f64::INFINITY, "steepness of the tail");

/// How the model is named and what it takes.
pub const MODEL: Model = Model {
    name: "abc",
    summary: "Löw's ABC microfacets",
    parameters: &[KD, A, B, C, ETA],
    build: |a| {
        let (b, c) = (a.number(&B)?, a.number(&C)?);
        Ok(Box::new(Abc::new(a.spectral(&KD)?, a.spectral(&A)?, b, c, a.spectral(&ETA)?)?))
    },
};

/// Probability of drawing from the diffuse part, where there is one.
const DIFFUSE: f64 = 0.5;

/// An ABC material.
#[derive(Debug, Clone, PartialEq)]
pub struct Abc {
    kd: Vec<f64>,
    a: Vec<f64>,
    b: f64,
    c: f64,
    eta: Vec<f64>,
    /// 2π ∫₀¹ (1 + Bx)^(−C) dx: the solid angle of the normals as they are drawn.
    norm: f64,
    diffuse: f64,
}

impl Abc {
    /// A material with `kd`, `a`, `eta` per band.
    ///
    /// # Errors
    /// [`Error::Range`], [`Error::Bands`].
    pub fn new(kd: Vec<f64>, a: Vec<f64>, b: f64, c: f64, eta: Vec<f64>) -> Result<Self, Error> {
        KD.check_all(&kd)?;
        A.check_all(&a)?;
        B.check(b)?;
        C.check(c)?;
        ETA.check_all(&eta)?;
        same_bands(kd.len(), &[("a", a.len()), ("eta", eta.len())])?;
        let diffuse = if kd.iter().any(|k| *k > 0.0) { DIFFUSE } else { 0.0 };
        let norm = TAU * if b > 0.0 { growth(b.ln_1p(), 1.0 - c) / b } else { 1.0 };
        Ok(Self { kd, a, b, c, eta, norm, diffuse })
    }

    /// (1 + B(1 − cosθ_h))^(−C) for a half vector of any length.
    fn tail(&self, h: DVec3) -> f64 {
        let length = h.length();
        let versine = (h.x * h.x + h.y * h.y) / (length * (length + h.z));
        (-self.c * (self.b * versine).ln_1p()).exp()
    }
}

/// ∫₀^y e^(st) dt, also where s is near 0.
fn growth(y: f64, s: f64) -> f64 {
    if (s * y).abs() < 1e-12 { y } else { (s * y).exp_m1() / s }
}

impl Brdf for Abc {
    fn bands(&self) -> usize {
        self.kd.len()
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return values.fill(0.0);
        }
        let h = incident + outgoing;
        let (low, high) = (incident.z.min(outgoing.z), incident.z.max(outgoing.z));
        // G/(cosθ_i cosθ_o) with ω·h = |H|/2.
        let visibility = (1.0 / (low * high)).min(4.0 * h.z / (h.length_squared() * high));
        let (lobe, cos) = (FRAC_1_PI * self.tail(h) * visibility, (0.5 * h.length()).min(1.0));
        for (((v, kd), a), eta) in values.iter_mut().zip(&self.kd).zip(&self.a).zip(&self.eta) {
            *v = FRAC_1_PI * kd + lobe * a * dielectric(cos, *eta);
        }
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        let (diffuse, _) = split(u[0], self.diffuse);
        let incident = if diffuse {
            cosine_hemisphere([u[1], u[2]])
        } else {
            // 1 + Bx = e^y, with y where the share u of ∫ e^((1 − C)y) dy is reached.
            let (whole, s) = (self.b.ln_1p(), 1.0 - self.c);
            let y = if (s * whole).abs() < 1e-12 { u[1] * whole } else { (u[1] * (s * whole).exp_m1()).ln_1p() / s };
            let versine = if self.b > 0.0 { (y.exp_m1() / self.b).clamp(0.0, 1.0) } else { u[1] };
            let sin = (versine * (2.0 - versine)).sqrt();
            let (sin_phi, cos_phi) = (TAU * u[2]).sin_cos();
            reflected(outgoing, DVec3::new(sin * cos_phi, sin * sin_phi, 1.0 - versine))?
        };
        sample_by(self, outgoing, incident, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return 0.0;
        }
        let h = incident + outgoing;
        let lobe = self.tail(h) / self.norm / (2.0 * h.length());
        self.diffuse * cosine_hemisphere_pdf(incident.z) + (1.0 - self.diffuse) * lobe
    }
}

//! Ashikhmin and Shirley's anisotropic Phong lobe with Fresnel, over a diffuse part that gives way to it.
//!
//! ```text
//! f = 28 R_d/(23π) (1 − R_s)(1 − (1 − cosθ_i/2)⁵)(1 − (1 − cosθ_o/2)⁵)
//!   + √((n_u + 1)(n_v + 1))/(8π) · (n·h)^e F(h·ω) / ((h·ω) max(cosθ_i, cosθ_o))
//! e = (n_u h_x² + n_v h_y²)/(1 − h_z²),   F = R_s + (1 − R_s)(1 − h·ω)⁵
//! ```
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `rd` | 0 to 1, spectral | diffuse reflectance of the substrate |
//! | `rs` | 0 to 1, spectral | reflectance at normal incidence of the coat |
//! | `nu`, `nv` | 0 to 1e6 | exponents along x and y; `nv` is `nu` where it is not given |
//!
//! Reciprocal, and the diffuse part conserves energy with the lobe; for small exponents the lobe by itself loses light.
//!
//! Reference: M. Ashikhmin & P. Shirley, *An Anisotropic Phong BRDF Model*, J. Graphics Tools 5 (2000).
//!
#![doc = include_str!("../../docs/brdf/ashikhmin-shirley.svg")]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::fresnel::schlick;
use super::parameter::{Error, Model, Parameter, same_bands};
use super::{Brdf, Sampled, reflected, sample_by};
use crate::math::sampling::{cosine_hemisphere, cosine_hemisphere_pdf, split};

const RD: Parameter = Parameter::spectral("rd", 0.0, 1.0, "diffuse reflectance of the substrate").or(0.0);
const RS: Parameter = Parameter::spectral("rs", 0.0, 1.0, "reflectance of the coat at normal incidence");
const NU: Parameter = Parameter::number("nu", 0.0, 1e6, "exponent along x");
const NV: Parameter = Parameter::number("nv", 0.0, 1e6, "exponent along y; as nu where not given");

/// How the model is named and what it takes.
pub const MODEL: Model = Model {
    name: "ashikhmin-shirley",
    summary: "anisotropic Phong lobe with Fresnel over a diffuse substrate",
    parameters: &[RD, RS, NU, NV],
    build: |a| {
        let nu = a.number(&NU)?;
        let nv = if a.has(&NV) { a.number(&NV)? } else { nu };
        Ok(Box::new(AshikhminShirley::new(a.spectral(&RD)?, a.spectral(&RS)?, [nu, nv])?))
    },
};

/// Probability of drawing from the diffuse part, where there is one.
const DIFFUSE: f64 = 0.5;

/// An Ashikhmin-Shirley material.
#[derive(Debug, Clone, PartialEq)]
pub struct AshikhminShirley {
    rd: Vec<f64>,
    rs: Vec<f64>,
    n: [f64; 2],
    /// √((n_u + 1)(n_v + 1)).
    norm: f64,
    diffuse: f64,
}

impl AshikhminShirley {
    /// A material with `rd`, `rs` per band and exponents along x and y.
    ///
    /// # Errors
    /// [`Error::Range`], [`Error::Bands`].
    pub fn new(rd: Vec<f64>, rs: Vec<f64>, n: [f64; 2]) -> Result<Self, Error> {
        RD.check_all(&rd)?;
        RS.check_all(&rs)?;
        NU.check(n[0])?;
        NV.check(n[1])?;
        same_bands(rd.len(), &[("rs", rs.len())])?;
        let diffuse = if rd.iter().any(|r| *r > 0.0) { DIFFUSE } else { 0.0 };
        let norm = ((n[0] + 1.0) * (n[1] + 1.0)).sqrt();
        Ok(Self { rd, rs, n, norm, diffuse })
    }

    /// (n·h)^e for a half vector of any length.
    fn power(&self, h: DVec3) -> f64 {
        let (x2, y2) = (h.x * h.x, h.y * h.y);
        let sin2 = x2 + y2;
        if sin2 == 0.0 {
            return 1.0;
        }
        let e = (self.n[0] * x2 + self.n[1] * y2) / sin2;
        (0.5 * e * (-sin2 / h.length_squared()).ln_1p()).exp()
    }
}

impl Brdf for AshikhminShirley {
    fn bands(&self) -> usize {
        self.rd.len()
    }

    fn is_isotropic(&self) -> bool {
        self.n[0] == self.n[1]
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return values.fill(0.0);
        }
        let h = incident + outgoing;
        let cos = 0.5 * h.length();
        let lobe = self.norm / (8.0 * PI) * self.power(h) / (cos * incident.z.max(outgoing.z));
        let substrate = 28.0 / (23.0 * PI) * rim(incident.z) * rim(outgoing.z);
        for ((v, rd), rs) in values.iter_mut().zip(&self.rd).zip(&self.rs) {
            *v = rd * (1.0 - rs) * substrate + lobe * schlick(cos, *rs);
        }
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        let (diffuse, _) = split(u[0], self.diffuse);
        let incident = if diffuse {
            cosine_hemisphere([u[1], u[2]])
        } else {
            // The azimuth within a quarter turn; every other quarter is mirrored, which keeps the map continuous.
            let quarter = (4.0 * u[1]).floor();
            let odd = quarter == 1.0 || quarter == 3.0;
            let part = 4.0 * u[1] - quarter;
            let part = if odd { 1.0 - part } else { part };
            let within = (((self.n[0] + 1.0) / (self.n[1] + 1.0)).sqrt() * (FRAC_PI_2 * part).tan()).atan();
            let phi = if odd { FRAC_PI_2 * (quarter + 1.0) - within } else { FRAC_PI_2 * quarter + within };
            let (sin_phi, cos_phi) = phi.sin_cos();
            let e = self.n[0] * cos_phi * cos_phi + self.n[1] * sin_phi * sin_phi;
            let log_cos = (-u[2]).ln_1p() / (e + 1.0);
            let sin = (-(2.0 * log_cos).exp_m1()).sqrt();
            reflected(outgoing, DVec3::new(sin * cos_phi, sin * sin_phi, log_cos.exp()))?
        };
        sample_by(self, outgoing, incident, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return 0.0;
        }
        let h = incident + outgoing;
        let lobe = self.norm / TAU * self.power(h) / (2.0 * h.length());
        self.diffuse * cosine_hemisphere_pdf(incident.z) + (1.0 - self.diffuse) * lobe
    }
}

/// 1 − (1 − cosθ/2)⁵.
fn rim(cos: f64) -> f64 {
    1.0 - (1.0 - 0.5 * cos).powi(5)
}

//! Oren and Nayar's rough diffuse surface: V-shaped grooves with Lambertian walls. A clay vase is flatter than Lambert: its rim
//! does not go dark.
//!
//! ```text
//! qualitative   f = ρ/π (A + B max(0, cosφ) sinα tanβ)
//!               A = 1 − σ²/(2(σ² + 0.33)),  B = 0.45 σ²/(σ² + 0.09),  α, β the larger and the smaller of θ_i, θ_o
//! full          f = ρ/π (C₁ + cosφ C₂ tanβ + (1 − |cosφ|) C₃ tan((α + β)/2)) + 0.17 ρ²/π σ²/(σ² + 0.13) (1 − cosφ (2β/π)²)
//!               C₁ = A,  C₃ = 0.125 σ²/(σ² + 0.09) (4αβ/π²)²
//!               C₂ = 0.45 σ²/(σ² + 0.09) · sinα  for cosφ ≥ 0,  sinα − (2β/π)³  otherwise
//! ```
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `reflectance` | 0 to 1, spectral | ρ of the walls; the surface's albedo is lower |
//! | `sigma_deg` | 0 to 90 deg | σ, standard deviation of the walls' slope angle |
//! | `form` | `qualitative`, `full` | without or with interreflection and the third term |
//!
//! Both are fits to a simulation. The full form turns negative near grazing forward directions for σ above about 38°; it is cut
//! at 0 there. σ = 0 is Lambert in both.
//!
//! Reference: M. Oren & S. K. Nayar, *Generalization of Lambert's Reflectance Model*, SIGGRAPH 1994, eqs. 27–30.
//!
#![doc = include_str!("../../docs/brdf/oren-nayar.svg")]

use std::f64::consts::{FRAC_1_PI, FRAC_2_PI};

use glam::DVec3;

use super::Brdf;
use super::parameter::{Error, Model, Parameter};
use crate::geometry::direction::theta;

const REFLECTANCE: Parameter = Parameter::spectral("reflectance", 0.0, 1.0, "reflectance of the walls");
const SIGMA: Parameter = Parameter::number("sigma_deg", 0.0, 90.0, "spread of the slope angle").in_unit("deg");
const FORM: Parameter = Parameter::choice("form", &["qualitative", "full"], "which of the paper's two formulas");

/// How the model is named and what it takes.
pub const MODEL: Model = Model {
    name: "oren-nayar",
    summary: "rough diffuse surface of Lambertian grooves",
    parameters: &[REFLECTANCE, SIGMA, FORM],
    build: |a| {
        let form = if a.choice(&FORM) == "full" { Form::Full } else { Form::Qualitative };
        Ok(Box::new(OrenNayar::new(form, a.spectral(&REFLECTANCE)?, a.number(&SIGMA)?)?))
    },
};

/// Which of the paper's formulas.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Eq. 30.
    Qualitative,
    /// Eqs. 27–29, with interreflection.
    Full,
}

/// A rough diffuse surface.
#[derive(Debug, Clone, PartialEq)]
pub struct OrenNayar {
    form: Form,
    reflectance: Vec<f64>,
    /// A = C₁.
    constant: f64,
    /// σ²/(σ² + 0.09).
    slope: f64,
    /// 0.17 σ²/(σ² + 0.13).
    between: f64,
}

impl OrenNayar {
    /// A surface of `reflectance` (0 to 1) per band and spread `sigma_deg` (0 to 90).
    ///
    /// # Errors
    /// [`Error::Range`].
    pub fn new(form: Form, reflectance: Vec<f64>, sigma_deg: f64) -> Result<Self, Error> {
        REFLECTANCE.check_all(&reflectance)?;
        SIGMA.check(sigma_deg)?;
        let s2 = sigma_deg.to_radians().powi(2);
        let (constant, slope, between) = (1.0 - 0.5 * s2 / (s2 + 0.33), s2 / (s2 + 0.09), 0.17 * s2 / (s2 + 0.13));
        Ok(Self { form, reflectance, constant, slope, between })
    }
}

impl Brdf for OrenNayar {
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
        let across = incident.x * outgoing.x + incident.y * outgoing.y;
        // sinα tanβ cosφ without angles: the product of the sines over the larger cosine.
        let tilt = across / incident.z.max(outgoing.z);
        let (single, double) = match self.form {
            Form::Qualitative => (self.constant + 0.45 * self.slope * tilt.max(0.0), 0.0),
            Form::Full => {
                let (a, b) = (theta(incident), theta(outgoing));
                let (alpha, beta) = (a.max(b), a.min(b));
                let sines = alpha.sin() * beta.sin();
                let cos = if sines > 0.0 { (across / sines).clamp(-1.0, 1.0) } else { 0.0 };
                let c2 = 0.45 * self.slope * (alpha.sin() - if cos < 0.0 { (FRAC_2_PI * beta).powi(3) } else { 0.0 });
                let c3 = 0.125 * self.slope * (FRAC_2_PI * alpha * FRAC_2_PI * beta).powi(2);
                let single =
                    self.constant + cos * c2 * beta.tan() + (1.0 - cos.abs()) * c3 * (0.5 * (alpha + beta)).tan();
                (single, self.between * (1.0 - cos * (FRAC_2_PI * beta).powi(2)))
            }
        };
        for (v, rho) in values.iter_mut().zip(&self.reflectance) {
            *v = (FRAC_1_PI * rho * (single + rho * double)).max(0.0);
        }
    }
}

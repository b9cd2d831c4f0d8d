//! Phong's and Blinn's lobes, as they were and as they must be.
//!
//! ```text
//! classic      f = k_d + k_s x^n / cosθ_i
//! normalised   f = k_d/π + k_s N x^n          x = r·ω_o (Phong, r the mirror direction of ω_i) or n·h (Blinn)
//!              N = (n + 2)/(2π) (Phong),  (n + 2)(n + 4)/(8π (2^(−n/2) + n)) (Blinn)
//! ```
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `kd` | 0 up (classic, 1/sr), 0 to 1 (normalised), spectral | diffuse part |
//! | `ks` | 0 up (classic, 1/sr), 0 to 1 (normalised), spectral | lobe |
//! | `n` | 0 to 1e6 | exponent; the lobe is about 1/√n wide |
//! | `form` | `normalised`, `classic` | which |
//!
//! The classic form is the lighting formula k_d (n·l) + k_s xⁿ divided by the cosine that a BRDF must not have. It is not
//! reciprocal and its albedo grows without bound towards grazing incidence: it is here to be found out by the audit. The normalised
//! forms are reciprocal, and k_d + k_s ≤ 1 (checked) keeps their albedo below 1: N makes the lobe's albedo 1 at normal incidence,
//! where it is largest. Their lobes do not brighten towards grazing angles as real surfaces do.
//!
//! References: B. T. Phong, CACM 18 (1975); J. F. Blinn, SIGGRAPH 1977; R. R. Lewis, Comput. Graph. Forum 13 (1994);
//! F. Giesen, *Phong and Blinn-Phong Normalization Factors* (2009).
//!
#![doc = include_str!("../../docs/brdf/phong.svg")]
#![doc = include_str!("../../docs/brdf/blinn-phong.svg")]

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use glam::DVec3;

use super::parameter::{Arguments, Error, Model, Parameter, at_most_one, same_bands};
use super::{Brdf, Sampled, diffuse_probability, reflected, sample_by};
use crate::geometry::direction::{mirror, tangents};
use crate::math::sampling::{cosine_hemisphere, cosine_hemisphere_pdf, cosine_power, cosine_power_pdf, split};

const KD: Parameter = Parameter::spectral("kd", 0.0, f64::INFINITY, "diffuse part; at most 1 unless classic").or(0.0);
const KS: Parameter = Parameter::spectral("ks", 0.0, f64::INFINITY, "lobe; at most 1 unless classic");
const N: Parameter = Parameter::number("n", 0.0, 1e6, "exponent");
const FORM: Parameter = Parameter::choice("form", &["normalised", "classic"], "energy-normalised or as in the papers");
const PARAMETERS: &[Parameter] = &[KD, KS, N, FORM];

/// Phong's lobe about the mirror direction.
pub const PHONG: Model = Model {
    name: "phong",
    summary: "Phong's lobe about the mirror direction",
    parameters: PARAMETERS,
    build: |a| build(a, Lobe::Mirror),
};

/// Blinn's lobe about the half vector.
pub const BLINN_PHONG: Model = Model {
    name: "blinn-phong",
    summary: "Blinn's lobe about the half vector",
    parameters: PARAMETERS,
    build: |a| build(a, Lobe::Half),
};

fn build(a: &Arguments, lobe: Lobe) -> Result<Box<dyn Brdf>, Error> {
    let form = if a.choice(&FORM) == "classic" { Form::Classic } else { Form::Normalised };
    Ok(Box::new(Phong::new(lobe, form, a.spectral(&KD)?, a.spectral(&KS)?, a.number(&N)?)?))
}

/// What the cosine of the lobe is taken of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lobe {
    /// r·ω_o (Phong).
    Mirror,
    /// n·h (Blinn).
    Half,
}

/// As it was, or normalised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Neither reciprocal nor bounded.
    Classic,
    /// Reciprocal, albedo at most 1.
    Normalised,
}

/// A Phong or Blinn-Phong material.
#[derive(Debug, Clone, PartialEq)]
pub struct Phong {
    lobe: Lobe,
    form: Form,
    kd: Vec<f64>,
    ks: Vec<f64>,
    n: f64,
    /// Factor of the lobe.
    norm: f64,
    /// Probability of drawing from the diffuse part.
    diffuse: f64,
}

impl Phong {
    /// A material with `kd`, `ks` per band and exponent `n`.
    ///
    /// # Errors
    /// [`Error::Range`] outside the ranges above, [`Error::Bands`] for unequal lengths.
    pub fn new(lobe: Lobe, form: Form, kd: Vec<f64>, ks: Vec<f64>, n: f64) -> Result<Self, Error> {
        KD.check_all(&kd)?;
        KS.check_all(&ks)?;
        N.check(n)?;
        same_bands(kd.len(), &[("ks", ks.len())])?;
        if form == Form::Normalised {
            at_most_one("kd + ks", &kd, &ks)?;
        }
        let norm = match (form, lobe) {
            (Form::Classic, _) => 1.0,
            (_, Lobe::Mirror) => (n + 2.0) / TAU,
            (_, Lobe::Half) => (n + 2.0) * (n + 4.0) / (8.0 * PI * ((-0.5 * n).exp2() + n)),
        };
        // The lobe of the classic form carries about 2π/(n + 1) ks, its diffuse part π kd.
        let scale = if form == Form::Classic { 2.0 / (n + 1.0) } else { 1.0 };
        let diffuse = diffuse_probability(&kd, &ks.iter().map(|k| scale * k).collect::<Vec<_>>());
        Ok(Self { lobe, form, kd, ks, n, norm, diffuse })
    }

    /// The cosine of the lobe.
    fn cosine(&self, incident: DVec3, outgoing: DVec3) -> f64 {
        match self.lobe {
            Lobe::Mirror => mirror(incident).dot(outgoing).clamp(0.0, 1.0),
            Lobe::Half => (incident + outgoing).normalize().z,
        }
    }
}

impl Brdf for Phong {
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
        let (diffuse, divisor) = if self.form == Form::Classic { (1.0, incident.z) } else { (FRAC_1_PI, 1.0) };
        let lobe = self.norm * self.cosine(incident, outgoing).powf(self.n) / divisor;
        values.iter_mut().zip(&self.kd).zip(&self.ks).for_each(|((v, kd), ks)| *v = kd * diffuse + ks * lobe);
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        let (diffuse, _) = split(u[0], self.diffuse);
        let u = [u[1], u[2]];
        let incident = match self.lobe {
            _ if diffuse => cosine_hemisphere(u),
            Lobe::Mirror => {
                let (pole, d) = (mirror(outgoing), cosine_power(u, self.n));
                let (t, b) = tangents(pole);
                t * d.x + b * d.y + pole * d.z
            }
            Lobe::Half => reflected(outgoing, cosine_power(u, self.n))?,
        };
        sample_by(self, outgoing, incident, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return 0.0;
        }
        let cos = self.cosine(incident, outgoing);
        let lobe = match self.lobe {
            Lobe::Mirror => cosine_power_pdf(cos, self.n),
            Lobe::Half => cosine_power_pdf(cos, self.n) / (2.0 * (incident + outgoing).length()),
        };
        self.diffuse * cosine_hemisphere_pdf(incident.z) + (1.0 - self.diffuse) * lobe
    }
}

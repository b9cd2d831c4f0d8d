//! The shifted gamma distribution of Bagher, Soler and Holzschuch: a microfacet model with a free tail, fitted to measured
//! isotropic materials band by band.
//!
//! ```text
//! f = (ρ_d + ρ_s F D G₁(θ_i) G₁(θ_o)/(cosθ_i cosθ_o))/π
//! F = f0 − c f1 + (1 − c)⁵ (1 − f0),  c = ω·h
//! D = κ e^(−a)/(π a^p cos⁴θ_h),  a = α + tan²θ_h/α
//! G₁ = 1 + λ(1 − e^(γ max(0, θ − θ₀)^k)), cut to 0 … 1
//! ```
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `rho_d`, `rho_s` | 0 up, spectral | diffuse part and lobe |
//! | `alpha`, `p` | 1e-9 up; any; spectral | width, and power of the distribution |
//! | `kappa` | 0 up, spectral | κ, which the fit chose to make ∫ D cosθ dω = 1 |
//! | `f0`, `f1` | any, spectral | Fresnel's reflectance at normal incidence, and its slope |
//! | `lambda`, `gamma`, `k`, `theta0` | any, spectral | masking (γ is called c in the paper; θ₀ in radians) |
//!
//! Reciprocal. F and with it f may be negative, and albedos of published fits pass 1 towards grazing angles: nothing in the
//! formula forbids it, and the audit says where.
//!
//! Reference: M. M. Bagher, C. Soler & N. Holzschuch, *Accurate Fitting of Measured Reflectances using a Shifted Gamma
//! Micro-facet Distribution*, Comput. Graph. Forum 31 (2012).
//!
#![doc = include_str!("../../docs/brdf/sgd.svg")]

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use glam::DVec3;

use super::parameter::{Arguments, Error, Model, Parameter};
use super::{Brdf, Sampled, reflected, sample_by};
use crate::geometry::direction::theta;
use crate::math::sampling::{cosine_hemisphere, cosine_hemisphere_pdf, split};

const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
const RHO_D: Parameter = Parameter::spectral("rho_d", 0.0, ANY.1, "diffuse part").or(0.0);
const RHO_S: Parameter = Parameter::spectral("rho_s", 0.0, ANY.1, "lobe");
const ALPHA: Parameter = Parameter::spectral("alpha", 1e-9, ANY.1, "width");
const P: Parameter = Parameter::spectral("p", ANY.0, ANY.1, "power of the distribution");
const KAPPA: Parameter = Parameter::spectral("kappa", 0.0, ANY.1, "norm of the distribution");
const F0: Parameter = Parameter::spectral("f0", ANY.0, ANY.1, "reflectance at normal incidence");
const F1: Parameter = Parameter::spectral("f1", ANY.0, ANY.1, "slope of the reflectance");
const LAMBDA: Parameter = Parameter::spectral("lambda", ANY.0, ANY.1, "depth of the masking");
const GAMMA: Parameter = Parameter::spectral("gamma", ANY.0, ANY.1, "rate of the masking, c in the paper");
const K: Parameter = Parameter::spectral("k", ANY.0, ANY.1, "power of the masking");
const THETA0: Parameter = Parameter::spectral("theta0", ANY.0, ANY.1, "angle where masking begins").in_unit("rad");
const PARAMETERS: &[Parameter] = &[RHO_D, RHO_S, ALPHA, P, KAPPA, F0, F1, LAMBDA, GAMMA, K, THETA0];

/// How the model is named and what it takes.
pub const MODEL: Model = Model {
    name: "sgd",
    summary: "Bagher's shifted gamma distribution",
    parameters: PARAMETERS,
    build: |a| Ok(Box::new(Sgd::from_arguments(a)?)),
};

/// The parameters of one band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Diffuse part.
    pub rho_d: f64,
    /// Lobe.
    pub rho_s: f64,
    /// Width.
    pub alpha: f64,
    /// Power of the distribution.
    pub p: f64,
    /// Norm of the distribution.
    pub kappa: f64,
    /// Reflectance at normal incidence.
    pub f0: f64,
    /// Slope of the reflectance.
    pub f1: f64,
    /// Depth of the masking.
    pub lambda: f64,
    /// Rate of the masking.
    pub gamma: f64,
    /// Power of the masking.
    pub k: f64,
    /// Angle where masking begins, rad.
    pub theta0: f64,
}

impl Band {
    fn check(&self) -> Result<(), Error> {
        let values = [
            self.rho_d,
            self.rho_s,
            self.alpha,
            self.p,
            self.kappa,
            self.f0,
            self.f1,
            self.lambda,
            self.gamma,
            self.k,
            self.theta0,
        ];
        PARAMETERS.iter().zip(values).try_for_each(|(p, v)| p.check(v))
    }

    /// D for the squared tangent of the half vector's angle.
    fn distribution(&self, tan2: f64) -> f64 {
        let a = self.alpha + tan2 / self.alpha;
        let secant2 = 1.0 + tan2;
        // In logarithms: the power alone may leave the range of doubles.
        self.kappa * FRAC_1_PI * secant2 * secant2 * (-a - self.p * a.ln()).exp()
    }

    fn masking(&self, theta: f64) -> f64 {
        let beyond = (theta - self.theta0).max(0.0);
        // A large exponent is full masking (or none, by the sign of λ), not an undefined product with λ = 0.
        let rise = (self.gamma * beyond.powf(self.k)).min(700.0).exp_m1();
        (1.0 - self.lambda * rise).clamp(0.0, 1.0)
    }

    fn fresnel(&self, c: f64) -> f64 {
        self.f0 - c * self.f1 + (1.0 - c).powi(5) * (1.0 - self.f0)
    }
}

/// An SGD material.
#[derive(Debug, Clone, PartialEq)]
pub struct Sgd {
    bands: Vec<Band>,
    normals: Normals,
    diffuse: f64,
}

/// Probability of drawing from the diffuse part: never none, for the table of normals ends.
const DIFFUSE: (f64, f64) = (0.1, 0.5);

impl Sgd {
    /// A material of bands.
    ///
    /// # Errors
    /// [`Error::Range`].
    pub fn new(bands: Vec<Band>) -> Result<Self, Error> {
        bands.iter().try_for_each(Band::check)?;
        let normals = Normals::new(&bands);
        let diffuse = if bands.iter().any(|b| b.rho_d > 0.0) { DIFFUSE.1 } else { DIFFUSE.0 };
        Ok(Self { bands, normals, diffuse })
    }

    fn from_arguments(a: &Arguments) -> Result<Self, Error> {
        let columns = PARAMETERS.iter().map(|p| a.spectral(p)).collect::<Result<Vec<_>, _>>()?;
        let band = |i: usize| {
            let v: Vec<f64> = columns.iter().map(|c| c[i]).collect();
            Band {
                rho_d: v[0],
                rho_s: v[1],
                alpha: v[2],
                p: v[3],
                kappa: v[4],
                f0: v[5],
                f1: v[6],
                lambda: v[7],
                gamma: v[8],
                k: v[9],
                theta0: v[10],
            }
        };
        Self::new((0..a.bands).map(band).collect())
    }
}

impl Brdf for Sgd {
    fn bands(&self) -> usize {
        self.bands.len()
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return values.fill(0.0);
        }
        let h = incident + outgoing;
        let tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
        let c = (0.5 * h.length()).min(1.0);
        let (ti, to) = (theta(incident), theta(outgoing));
        let cosines = incident.z * outgoing.z;
        for (v, b) in values.iter_mut().zip(&self.bands) {
            let lobe = b.rho_s * b.fresnel(c) * b.distribution(tan2) * b.masking(ti) * b.masking(to) / cosines;
            *v = FRAC_1_PI * (b.rho_d + lobe);
        }
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        let (diffuse, _) = split(u[0], self.diffuse);
        let incident = if diffuse {
            cosine_hemisphere([u[1], u[2]])
        } else {
            let tan = self.normals.sample(u[1]).sqrt();
            let (sin, cos) = (TAU * u[2]).sin_cos();
            reflected(outgoing, DVec3::new(tan * cos, tan * sin, 1.0).normalize())?
        };
        sample_by(self, outgoing, incident, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return 0.0;
        }
        let h = incident + outgoing;
        let tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
        let lobe = self.normals.pdf(tan2) / (2.0 * h.length());
        self.diffuse * cosine_hemisphere_pdf(incident.z) + (1.0 - self.diffuse) * lobe
    }
}

/// Normals drawn from a histogram over ln tan²θ_h of D cosθ, the mean of the bands: the distribution has no inverse in closed
/// form.
#[derive(Debug, Clone, PartialEq)]
struct Normals {
    /// Share of the cells up to and with each.
    cumulative: Vec<f64>,
}

/// Range of ln tan²θ_h: θ_h from 3e-6 to 89.9°.
const RANGE: (f64, f64) = (-25.0, 13.0);
const CELLS: usize = 256;
const WIDTH: f64 = (RANGE.1 - RANGE.0) / CELLS as f64;

impl Normals {
    fn new(bands: &[Band]) -> Self {
        // Each band counts alike, whatever its norm.
        let share = |b: &Band| -> Vec<f64> {
            let cells: Vec<f64> = (0..CELLS)
                .map(|i| {
                    let t = (RANGE.0 + (i as f64 + 0.5) * WIDTH).exp();
                    // D cosθ dω = D π t/(1 + t)² d ln t.
                    b.distribution(t) * t / ((1.0 + t) * (1.0 + t))
                })
                .collect();
            let sum: f64 = cells.iter().sum();
            cells.into_iter().map(|c| if sum > 0.0 { c / sum } else { 1.0 / CELLS as f64 }).collect()
        };
        let mut sums = vec![0.0; CELLS];
        for band in bands {
            sums.iter_mut().zip(share(band)).for_each(|(s, c)| *s += c / bands.len() as f64);
        }
        let mut total = 0.0;
        let cumulative = sums.into_iter().map(|s| {
            total += s;
            total
        });
        Self { cumulative: cumulative.collect() }
    }

    fn cell(&self, i: usize) -> (f64, f64) {
        let before = if i == 0 { 0.0 } else { self.cumulative[i - 1] };
        (before, self.cumulative[i] - before)
    }

    /// tan²θ_h of a drawn normal.
    fn sample(&self, u: f64) -> f64 {
        let u = u * self.cumulative[CELLS - 1];
        let i = self.cumulative.partition_point(|c| *c <= u).min(CELLS - 1);
        let (before, share) = self.cell(i);
        let within = if share > 0.0 { (u - before) / share } else { 0.5 };
        (RANGE.0 + (i as f64 + within) * WIDTH).exp()
    }

    /// Density of the normal in 1/sr.
    fn pdf(&self, tan2: f64) -> f64 {
        let place = (tan2.ln() - RANGE.0) / WIDTH;
        if !(0.0..CELLS as f64).contains(&place) {
            return 0.0;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the table")]
        let (_, share) = self.cell(place as usize);
        // dω = π t (1 + t)^(−3/2) d ln t.
        share / (WIDTH * self.cumulative[CELLS - 1]) * (1.0 + tan2).powf(1.5) / (PI * tan2)
    }
}

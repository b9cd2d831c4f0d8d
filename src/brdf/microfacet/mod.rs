//! Torrance and Sparrow's rough surface of tiny mirrors (microfacets).
//!
//! ```text
//! f = F(ω·h) D(h) G(ω_i, ω_o) / (4 cosθ_i cosθ_o),   h = (ω_i + ω_o)/|ω_i + ω_o|
//! ```
//!
//! | model | D, distribution of the facets' normals |
//! |---|---|
//! | `ggx` | Trowbridge-Reitz: long tails ([`ggx`]) |
//! | `beckmann` | Gaussian slopes ([`beckmann`]) |
//! | `blinn` | cosine power ([`blinn`]) |
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `alpha`, or `alpha_x` and `alpha_y` | 1e-6 to 1 | roughness along x and y (`ggx`, `beckmann`) |
//! | `n` | 0 to 1e12 | exponent (`blinn`); as rough as α = √(2/(n + 2)) |
//! | `medium`, `eta` (with `k`), `f0`, `reflectance` | see [`fresnel`](super::fresnel) | F; one of them |
//! | `masking` | `smith`, `smith-separable`, `v-cavity` (for `blinn` the default) | G |
//!
//! Masking G is Smith's, of both directions together (1/(1 + Λ_i + Λ_o), which knows that both see the same heights) or apart
//! (G₁G₁), or that of symmetric V-shaped grooves, min(1, 2 h_z cosθ_i/(ω_i·h), 2 h_z cosθ_o/(ω_o·h)). Light that meets a second
//! facet is lost: rough white surfaces come out too dark (GGX with α = 1 and F = 1 returns 1 − ln 2 = 31 % at normal incidence).
//!
//! G/(4 cosθ_i cosθ_o) is computed as one, without dividing by the cosines, so that grazing directions keep their digits; D takes
//! the squared tangent from ω_i + ω_o and never from 1 − cos². `ggx` and `beckmann` draw normals as ω_o sees them: with Smith's
//! masking the weight is F G/G₁ ≤ 1. (With V-cavities the same normals are drawn.) As α → 0 all three become the mirror F.
//!
//! References: K. E. Torrance & E. M. Sparrow, JOSA 57 (1967); R. L. Cook & K. E. Torrance, SIGGRAPH 1981 (V-cavity); B. Walter et
//! al., EGSR 2007; E. Heitz, JCGT 3 (2014) (Smith); E. Heitz & E. d'Eon, EGSR 2014 (visible normals).

pub mod beckmann;
pub mod blinn;
pub mod ggx;

use glam::DVec3;

use super::fresnel::{ETA, F0, Fresnel, K, MEDIUM, REFLECTANCE};
use super::parameter::{Arguments, Error, Model, Parameter};
use super::{Brdf, Sampled, reflected, sample_by};

/// Roughness along both axes.
pub const ALPHA: Parameter = Parameter::number("alpha", 1e-6, 1.0, "roughness");
/// Roughness along x.
pub const ALPHA_X: Parameter = Parameter::number("alpha_x", 1e-6, 1.0, "roughness along x, instead of alpha");
/// Roughness along y.
pub const ALPHA_Y: Parameter = Parameter::number("alpha_y", 1e-6, 1.0, "roughness along y, instead of alpha");
const N: Parameter = Parameter::number("n", 0.0, 1e12, "exponent");
const MASKING: Parameter =
    Parameter::choice("masking", &["smith", "smith-separable", "v-cavity"], "shadowing and masking");

const BLINN_MASKING: Parameter =
    Parameter::choice("masking", &["v-cavity", "smith", "smith-separable"], "shadowing and masking");

/// Trowbridge-Reitz facets.
pub const GGX: Model = Model {
    name: "ggx",
    summary: "microfacets, Trowbridge-Reitz (GGX)",
    parameters: &[ALPHA, ALPHA_X, ALPHA_Y, MEDIUM, ETA, K, F0, REFLECTANCE, MASKING],
    build: |a| build(a, &MASKING, Distribution::Ggx(roughness(a)?)),
};

/// Beckmann facets.
pub const BECKMANN: Model = Model {
    name: "beckmann",
    summary: "microfacets, Gaussian slopes",
    parameters: &[ALPHA, ALPHA_X, ALPHA_Y, MEDIUM, ETA, K, F0, REFLECTANCE, MASKING],
    build: |a| build(a, &MASKING, Distribution::Beckmann(roughness(a)?)),
};

/// Blinn facets.
pub const BLINN: Model = Model {
    name: "blinn",
    summary: "microfacets, cosine power",
    parameters: &[N, MEDIUM, ETA, K, F0, REFLECTANCE, BLINN_MASKING],
    build: |a| build(a, &BLINN_MASKING, Distribution::Blinn(a.number(&N)?)),
};

fn build(a: &Arguments, masking: &Parameter, distribution: Distribution) -> Result<Box<dyn Brdf>, Error> {
    let masking = match a.choice(masking) {
        "smith-separable" => Masking::SmithSeparable,
        "v-cavity" => Masking::VCavity,
        _ => Masking::Smith,
    };
    Ok(Box::new(Microfacet::new(distribution, masking, Fresnel::from_arguments(a)?)?))
}

/// `alpha`, or `alpha_x` and `alpha_y`.
pub(super) fn roughness(a: &Arguments) -> Result<[f64; 2], Error> {
    match (a.has(&ALPHA), a.has(&ALPHA_X), a.has(&ALPHA_Y)) {
        (true, false, false) => {
            let alpha = a.number(&ALPHA)?;
            ALPHA.check(alpha)?;
            Ok([alpha; 2])
        }
        (true, true, _) => Err(Error::Conflict { first: "alpha", second: "alpha_x" }),
        (true, _, true) => Err(Error::Conflict { first: "alpha", second: "alpha_y" }),
        (false, true, _) | (false, _, true) => Ok([a.number(&ALPHA_X)?, a.number(&ALPHA_Y)?]),
        (false, false, false) => a.number(&ALPHA).map(|v| [v; 2]),
    }
}

/// How the facets' normals are distributed; the roughness is along x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// Trowbridge-Reitz (GGX).
    Ggx([f64; 2]),
    /// Beckmann.
    Beckmann([f64; 2]),
    /// Cosine power.
    Blinn(f64),
}

/// How facets hide one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Masking {
    /// Smith's, height-correlated.
    Smith,
    /// Smith's, separable.
    SmithSeparable,
    /// V-shaped grooves.
    VCavity,
}

impl Distribution {
    /// D at a half vector of any length above the horizon, 1/sr: ∫ D cosθ_h dω_h = 1.
    #[must_use]
    pub fn density(&self, h: DVec3) -> f64 {
        match self {
            Self::Ggx(alpha) => ggx::distribution(*alpha, h),
            Self::Beckmann(alpha) => beckmann::distribution(*alpha, h),
            Self::Blinn(n) => blinn::distribution(*n, h),
        }
    }

    /// cosθ (1 + Λ(ω)): finite down to the horizon, where Λ is not.
    #[must_use]
    pub fn shadow(&self, direction: DVec3) -> f64 {
        match self {
            Self::Ggx(alpha) => ggx::shadow(*alpha, direction),
            Self::Beckmann(alpha) => beckmann::shadow(*alpha, direction),
            Self::Blinn(n) => blinn::shadow(*n, direction),
        }
    }

    /// G/(4 cosθ_i cosθ_o) for ω_i + ω_o = h.
    fn visibility(&self, masking: Masking, incident: DVec3, outgoing: DVec3, h: DVec3) -> f64 {
        match masking {
            // 1 + Λ_i + Λ_o over the common denominator cosθ_i cosθ_o.
            Masking::Smith => {
                let (i, o) = (self.shadow(incident), self.shadow(outgoing));
                0.25 / (i * outgoing.z + o * incident.z - incident.z * outgoing.z)
            }
            Masking::SmithSeparable => 0.25 / (self.shadow(incident) * self.shadow(outgoing)),
            Masking::VCavity => {
                let (low, high) = (incident.z.min(outgoing.z), incident.z.max(outgoing.z));
                (0.25 / (low * high)).min(h.z / (h.length_squared() * high))
            }
        }
    }

    /// A normal as seen from `outgoing`; for [`Distribution::Blinn`] as the surface has them.
    fn sample(&self, outgoing: DVec3, u: [f64; 2]) -> DVec3 {
        match self {
            Self::Ggx(alpha) => ggx::sample_visible(*alpha, outgoing, u),
            Self::Beckmann(alpha) => beckmann::sample_visible(*alpha, outgoing, u),
            Self::Blinn(n) => blinn::sample(*n, u),
        }
    }

    /// Density of the reflection of `outgoing` at such a normal, for ω_i + ω_o = h.
    fn pdf(&self, outgoing: DVec3, h: DVec3) -> f64 {
        let length = h.length();
        match self {
            Self::Ggx(_) | Self::Beckmann(_) => 0.25 * self.density(h) / self.shadow(outgoing),
            Self::Blinn(_) => 0.5 * self.density(h) * h.z / (length * length),
        }
    }
}

/// A rough surface of microfacets.
#[derive(Debug, Clone, PartialEq)]
pub struct Microfacet {
    distribution: Distribution,
    masking: Masking,
    fresnel: Fresnel,
}

impl Microfacet {
    /// A surface of facets with an interface.
    ///
    /// # Errors
    /// [`Error::Range`] for roughness or exponent outside the ranges above.
    pub fn new(distribution: Distribution, masking: Masking, fresnel: Fresnel) -> Result<Self, Error> {
        match distribution {
            Distribution::Ggx([x, y]) | Distribution::Beckmann([x, y]) => {
                ALPHA_X.check(x)?;
                ALPHA_Y.check(y)?;
            }
            Distribution::Blinn(n) => N.check(n)?,
        }
        Ok(Self { distribution, masking, fresnel })
    }

    /// The same facets with the same reflectance at every angle, in one band.
    ///
    /// # Errors
    /// [`Error::Range`] for a reflectance that is not from 0 to 1.
    pub fn with_reflectance(&self, reflectance: f64) -> Result<Self, Error> {
        Ok(Self { fresnel: Fresnel::constant(vec![reflectance])?, ..self.clone() })
    }

    /// The interface of the facets.
    #[must_use]
    pub fn fresnel(&self) -> &Fresnel {
        &self.fresnel
    }

    /// α, the larger one of two, or the α that an exponent is as rough as.
    #[must_use]
    pub fn roughness(&self) -> f64 {
        match self.distribution {
            Distribution::Ggx([x, y]) | Distribution::Beckmann([x, y]) => x.max(y),
            Distribution::Blinn(n) => (2.0 / (n + 2.0)).sqrt(),
        }
    }
}

impl Brdf for Microfacet {
    fn bands(&self) -> usize {
        self.fresnel.bands()
    }

    fn is_isotropic(&self) -> bool {
        match self.distribution {
            Distribution::Ggx([x, y]) | Distribution::Beckmann([x, y]) => x == y,
            Distribution::Blinn(_) => true,
        }
    }

    fn microfacets(&self) -> Vec<(Vec<f64>, &Microfacet)> {
        vec![(vec![1.0; self.bands()], self)]
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return values.fill(0.0);
        }
        let h = incident + outgoing;
        let geometry = self.distribution.density(h) * self.distribution.visibility(self.masking, incident, outgoing, h);
        // ω·h is half the length of ω_i + ω_o.
        self.fresnel.write(0.5 * h.length(), geometry, values);
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        if outgoing.z <= 0.0 {
            return None;
        }
        let normal = self.distribution.sample(outgoing, [u[1], u[2]]);
        sample_by(self, outgoing, reflected(outgoing, normal)?, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return 0.0;
        }
        self.distribution.pdf(outgoing, incident + outgoing)
    }
}

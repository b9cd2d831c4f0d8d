//! Blinn's cosine-power distribution.
//!
//! ```text
//! D(h) = (n + 2)/(2π) cosⁿθ_h
//! G₁ = (3.535 a + 2.181 a²)/(1 + 2.276 a + 2.577 a²) for a < 1.6, else 1;   a = √(n/2 + 1)/tanθ
//! ```
//!
//! Smith's masking has no closed form for it: this is Walter's rational function, made for Beckmann's distribution of the same
//! roughness and good to 0.35 % there. With it the facets return up to 1 % more light than they get at grazing incidence (n = 30,
//! F = 1, 89°); with V-cavities, which suit any distribution and are the default, they do not.
//!
//! References: J. F. Blinn, SIGGRAPH 1977; B. Walter et al., EGSR 2007, eqs. 27, 30.
//!
#![doc = include_str!("../../../docs/brdf/blinn.svg")]

use std::f64::consts::TAU;

use glam::DVec3;

use crate::math::sampling;

/// D at a half vector of any length, 1/sr.
#[must_use]
pub fn distribution(n: f64, h: DVec3) -> f64 {
    let sin2 = (h.x * h.x + h.y * h.y) / h.length_squared();
    (n + 2.0) / TAU * (0.5 * n * (-sin2).ln_1p()).exp()
}

/// cosθ (1 + Λ(ω)) = cosθ/G₁.
#[must_use]
pub fn shadow(n: f64, w: DVec3) -> f64 {
    let root = (0.5 * n + 1.0).sqrt();
    let sin = (w.x * w.x + w.y * w.y).sqrt();
    if root * w.z >= 1.6 * sin {
        return w.z;
    }
    let a = root * w.z / sin;
    // cosθ/a = sinθ/root.
    (sin / root) * (1.0 + a * (2.276 + 2.577 * a)) / (3.535 + 2.181 * a)
}

/// A unit normal with density D(h) cosθ_h.
#[must_use]
pub fn sample(n: f64, u: [f64; 2]) -> DVec3 {
    sampling::cosine_power(u, n + 1.0)
}

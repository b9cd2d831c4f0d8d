//! Beckmann's distribution: slopes with a normal distribution of variance α²/2.
//!
//! ```text
//! D(h) = e^(−(h_x²/α_x² + h_y²/α_y²)/h_z²) / (π α_x α_y h_z⁴)
//! Λ = (e^(−a²)/(a√π) − erfc a)/2,   a = cosθ/√(α_x²ω_x² + α_y²ω_y²)
//! ```
//!
//! Λ is exact here; the rational function that renderers use in its place is up to 0.35 % off. The two terms of Λ cancel for
//! large a, where Λ itself is far below 1: the absolute error of 1 + Λ stays below 1e-15.
//!
//! References: P. Beckmann & A. Spizzichino, *The Scattering of Electromagnetic Waves from Rough Surfaces* (1963); B. Walter et
//! al., EGSR 2007; E. Heitz & E. d'Eon, *Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals*,
//! EGSR 2014.
//!
#![doc = include_str!("../../../docs/brdf/beckmann.svg")]

use std::f64::consts::{FRAC_2_SQRT_PI, PI};

use glam::DVec3;
use libm::erfc;

/// D at a half vector of any length, 1/sr.
#[must_use]
pub fn distribution([ax, ay]: [f64; 2], h: DVec3) -> f64 {
    let (x, y, z2) = (h.x / ax, h.y / ay, h.z * h.z);
    let exponent = (x * x + y * y) / z2;
    // Beyond this the exponential is zero, and its factor may be infinite.
    if exponent > 700.0 || z2 == 0.0 {
        return 0.0;
    }
    let secant2 = h.length_squared() / z2;
    (-exponent).exp() * secant2 * secant2 / (PI * ax * ay)
}

/// cosθ (1 + Λ(ω)).
#[must_use]
pub fn shadow([ax, ay]: [f64; 2], w: DVec3) -> f64 {
    let (x, y) = (ax * w.x, ay * w.y);
    let spread = (x * x + y * y).sqrt();
    // From here on Λ is below 1e-17.
    if w.z >= 6.0 * spread {
        return w.z;
    }
    let a = w.z / spread;
    // cosθ/a is the spread: nothing is divided by a.
    w.z * (1.0 - 0.5 * erfc(a)) + 0.25 * FRAC_2_SQRT_PI * spread * (-a * a).exp()
}

/// A unit normal with density G₁(ω_o) max(0, ω_o·h) D(h)/cosθ_o.
#[must_use]
pub fn sample_visible([ax, ay]: [f64; 2], outgoing: DVec3, [u, v]: [f64; 2]) -> DVec3 {
    // The surface stretched to α = 1, turned so that the view is in the plane of x and z.
    let view = DVec3::new(ax * outgoing.x, ay * outgoing.y, outgoing.z).normalize();
    let sin = view.x.hypot(view.y);
    let (cos_phi, sin_phi) = if sin > 0.0 { (view.x / sin, view.y / sin) } else { (1.0, 0.0) };
    let (along, across) = (visible_slope(u, sin, view.z), visible_slope(v, 0.0, 1.0));
    let (x, y) = (cos_phi * along - sin_phi * across, sin_phi * along + cos_phi * across);
    DVec3::new(-ax * x, -ay * y, 1.0).normalize()
}

/// The slope x at which the share `u` is reached of the density (cosθ − x sinθ) e^(−x²)/√π, x ≤ cotθ: the projected area of
/// the slopes that a view at θ sees. Newton's steps within a bracket.
fn visible_slope(u: f64, sin: f64, cos: f64) -> f64 {
    let primitive = |x: f64| 0.5 * cos * erfc(-x) + 0.25 * FRAC_2_SQRT_PI * sin * (-x * x).exp();
    // Slopes beyond 6 have a share of 1e-17.
    let (mut low, mut high) = (-6.0, if cos < 6.0 * sin { cos / sin } else { 6.0 });
    let wanted = u * primitive(high);
    let mut x = 0.5 * (low + high);
    for _ in 0..60 {
        let excess = primitive(x) - wanted;
        if excess > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let slope = 0.5 * FRAC_2_SQRT_PI * (cos - x * sin) * (-x * x).exp();
        let next = x - excess / slope;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - x).abs() < 1e-14 {
            break;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use libm::erf;

    use super::*;

    #[test]
    fn slopes_without_tilt_are_normal_quantiles() {
        // ½(1 + erf x) = u: the quantiles of a normal distribution of variance ½.
        for x in [-2.5, -0.3, 0.0, 0.7, 3.0] {
            let u = 0.5 * (1.0 + erf(x));
            assert!((visible_slope(u, 0.0, 1.0) - x).abs() < 1e-12, "{x}");
        }
    }
}

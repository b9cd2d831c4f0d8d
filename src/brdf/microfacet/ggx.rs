//! The distribution of Trowbridge and Reitz, called GGX: an ellipsoid's normals, with long tails.
//!
//! ```text
//! D(h) = 1/(π α_x α_y (h_x²/α_x² + h_y²/α_y² + h_z²)²)
//! cosθ (1 + Λ) = (cosθ + √(cos²θ + α_x²ω_x² + α_y²ω_y²))/2
//! ```
//!
//! References: T. S. Trowbridge & K. P. Reitz, JOSA 65 (1975); B. Walter et al., EGSR 2007; E. Heitz, *Sampling the GGX
//! Distribution of Visible Normals*, JCGT 7 (2018).
//!
#![doc = include_str!("../../../docs/brdf/ggx.svg")]

use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// D at a half vector of any length, 1/sr.
#[must_use]
pub fn distribution([ax, ay]: [f64; 2], h: DVec3) -> f64 {
    let (x, y) = (h.x / ax, h.y / ay);
    let ratio = h.length_squared() / (x * x + y * y + h.z * h.z);
    ratio * ratio / (PI * ax * ay)
}

/// cosθ (1 + Λ(ω)).
#[must_use]
pub fn shadow([ax, ay]: [f64; 2], w: DVec3) -> f64 {
    let (x, y) = (ax * w.x, ay * w.y);
    0.5 * (w.z + (w.z * w.z + x * x + y * y).sqrt())
}

/// A unit normal with density G₁(ω_o) max(0, ω_o·h) D(h)/cosθ_o.
#[must_use]
pub fn sample_visible([ax, ay]: [f64; 2], outgoing: DVec3, [u, v]: [f64; 2]) -> DVec3 {
    // Seen by the stretched surface, which is a hemisphere: its projection is half a disc and half an ellipse.
    let view = DVec3::new(ax * outgoing.x, ay * outgoing.y, outgoing.z).normalize();
    let across = view.x.hypot(view.y);
    let first = if across > 0.0 { DVec3::new(-view.y, view.x, 0.0) / across } else { DVec3::X };
    let second = view.cross(first);
    let (radius, (sin, cos)) = (u.sqrt(), (TAU * v).sin_cos());
    let a = radius * cos;
    let share = 0.5 * (1.0 + view.z);
    let b = (1.0 - share) * (1.0 - a * a).max(0.0).sqrt() + share * radius * sin;
    let normal = first * a + second * b + view * (1.0 - a * a - b * b).max(0.0).sqrt();
    DVec3::new(ax * normal.x, ay * normal.y, normal.z.max(0.0)).normalize()
}

//! Triangles as seen from a point: directions uniform over their solid angle.
//!
//! With unit vectors A, B, C to the corners and D the unit tangent at A towards C, the part of the triangle up to the point
//! C′ = A cos s + D sin s has the solid angle Ω′ with (Van Oosterom & Strackee 1983, divided by 1 + cos s)
//!
//! ```text
//! tan(Ω′/2) = v q / ((1 + A·B) + (B·D) q),   q = tan(s/2),   v = |A · (B × D)|
//! ```
//!
//! which is solved for q: the first of the two steps of J. Arvo, *Stratified Sampling of Spherical Triangles*, SIGGRAPH 1995, without
//! the angles of the triangle, whose excess over π has no digits where the triangle looks small. The second step, along the arc from
//! B to C′, is uniform in the cosine.

use glam::DVec3;

use super::rounding::cross;

/// Solid angles between these are drawn from; of smaller ones the area is as good, and of half of all directions there
/// is nothing left to see.
pub(super) const RANGE_SR: std::ops::Range<f64> = 1e-12..std::f64::consts::TAU - 1e-6;

/// The direction, from the origin, that two uniform numbers choose in the triangle whose solid angle is `omega`; `None` where
/// the corners give none.
pub(super) fn sample(a: DVec3, b: DVec3, c: DVec3, omega: f64, [u, v]: [f64; 2]) -> Option<DVec3> {
    let (unit_a, unit_b) = (a.normalize(), b.normalize());
    // Tangents and products from the edges: corners seen close together differ by little.
    let (ab, ac) = (b - a, c - a);
    let tangent = (ac - ac.dot(unit_a) * unit_a).try_normalize()?;
    let length = b.length();
    let (bd, volume) = (ab.dot(tangent) / length, (ab.dot(cross(tangent, unit_a)) / length).abs());
    let sum = 0.5 * (unit_a + unit_b).length_squared();
    let (sin, cos) = (0.5 * u * omega).sin_cos();
    let half = (sin * sum).atan2(volume * cos - bd * sin);
    let (sin, cos) = half.sin_cos();
    // C′ − A and C′ − B.
    let moved = 2.0 * sin * (cos * tangent - sin * unit_a);
    let across = (unit_a - unit_b) + moved;
    let z = 0.5 * v * across.length_squared();
    let towards = (across - across.dot(unit_b) * unit_b).normalize_or_zero();
    let direction = (1.0 - z) * unit_b + (z * (2.0 - z)).max(0.0).sqrt() * towards;
    direction.try_normalize()
}

//! Bounds of rounding errors, and arithmetic with less of them.

use glam::DVec3;

/// γₙ = n u/(1 − n u), u = 2⁻⁵³: the relative error of n roundings in a row is at most this.
///
/// Reference: N. J. Higham, *Accuracy and Stability of Numerical Algorithms* (2002), 3.1; Pharr et al. 2023, 6.8.1.
#[must_use]
pub const fn gamma(n: f64) -> f64 {
    const UNIT: f64 = 0.5 * f64::EPSILON;
    n * UNIT / (1.0 - n * UNIT)
}

/// ab − cd within 1.5 ulp: zero only where it is zero, and never of the wrong sign.
///
/// Reference: C.-P. Jeannerod, N. Louvet, J.-M. Muller, Math. Comp. 82 (2013), on W. Kahan's algorithm.
#[must_use]
pub fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let cd = c * d;
    a.mul_add(b, -cd) + (-c).mul_add(d, cd)
}

/// a × b with each component within 1.5 ulp.
#[must_use]
pub fn cross(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(
        difference_of_products(a.y, b.z, a.z, b.y),
        difference_of_products(a.z, b.x, a.x, b.z),
        difference_of_products(a.x, b.y, a.y, b.x),
    )
}

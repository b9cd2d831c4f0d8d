//! Warps: from uniform numbers in [0, 1) to points and directions of a stated density, continuous, so that well-spread numbers
//! stay well spread.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use glam::{DVec2, DVec3};

/// A point of the unit disk, uniform, by concentric squares.
///
/// Reference: P. Shirley & K. Chiu, *A Low Distortion Map Between Disk and Square*, Journal of Graphics Tools 2 (1997).
#[must_use]
pub fn disk([u, v]: [f64; 2]) -> DVec2 {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return DVec2::ZERO;
    }
    let (radius, angle) =
        if a.abs() > b.abs() { (a, FRAC_PI_4 * (b / a)) } else { (b, 2.0 * FRAC_PI_4 - FRAC_PI_4 * (a / b)) };
    let (sin, cos) = angle.sin_cos();
    DVec2::new(radius * cos, radius * sin)
}

/// A direction of the upper hemisphere with density cosθ/π per steradian (N. Malley: the disk, lifted).
#[must_use]
pub fn cosine_hemisphere(u: [f64; 2]) -> DVec3 {
    let p = disk(u);
    p.extend((1.0 - p.length_squared()).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`] at the cosine of the angle to the normal: cosθ/π, 1/sr.
#[must_use]
pub fn cosine_hemisphere_pdf(cos: f64) -> f64 {
    cos.max(0.0) / PI
}

/// A direction of the upper hemisphere with density (n + 1)/(2π) cosⁿθ per steradian, n ≥ 0 (0: uniform).
#[must_use]
pub fn cosine_power([u, v]: [f64; 2], n: f64) -> DVec3 {
    // 1 − cos²θ by expm1: for large n the lobe is as narrow as 1/√n and the difference would lose its digits.
    let log_cos = (-u).ln_1p() / (n + 1.0);
    let sin = (-(2.0 * log_cos).exp_m1()).sqrt();
    let (y, x) = (TAU * v).sin_cos();
    DVec3::new(sin * x, sin * y, log_cos.exp())
}

/// Density of [`cosine_power`], 1/sr: zero below the horizon.
#[must_use]
pub fn cosine_power_pdf(cos: f64, n: f64) -> f64 {
    if cos > 0.0 { (n + 1.0) / TAU * cos.powf(n) } else { 0.0 }
}

/// A direction within a cone about +z, uniform over its solid angle, from concentric squares by the equal-area projection of the
/// sphere (J. H. Lambert 1772). The cone is given by h = 1 − cos τ of its half-angle τ, in (0, 2], which keeps its digits for
/// needles: 2 sin²(τ/2). The hemisphere is h = 1, the sphere h = 2; the density is 1/(2π h).
#[must_use]
pub fn cone(u: [f64; 2], h: f64) -> DVec3 {
    let p = disk(u);
    let depth = p.length_squared() * h;
    (p * (h * (2.0 - depth).max(0.0)).sqrt()).extend(1.0 - depth)
}

/// Splits a uniform number by a probability: whether it fell below, and the number stretched back to [0, 1).
#[must_use]
pub fn split(u: f64, probability: f64) -> (bool, f64) {
    let below = u < probability;
    let stretched = if below { u / probability } else { (u - probability) / (1.0 - probability) };
    (below, stretched.clamp(0.0, 1.0 - f64::EPSILON / 2.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_over_a_fine_net_are_those_of_the_densities() {
        let n = 400;
        let net = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
        let mean = |f: &dyn Fn([f64; 2]) -> f64| {
            (0..n * n).map(|i| f([net(i / n), net(i % n)])).sum::<f64>() / f64::from(n * n)
        };
        // ∫ r² dA/π over the disk is 1/2, ∫ cosθ·cosθ/π dω = 2/3, ∫ cosθ (n + 1)/(2π) cosⁿθ dω = (n + 1)/(n + 2); the midpoint
        // net errs by less than its cell.
        assert!((mean(&|u| disk(u).length_squared()) - 0.5).abs() < 1e-4);
        assert!((mean(&|u| cosine_hemisphere(u).z) - 2.0 / 3.0).abs() < 1e-4);
        for power in [0.0, 1.0, 50.0] {
            let expected = (power + 1.0) / (power + 2.0);
            assert!((mean(&|u| cosine_power(u, power).z) - expected).abs() < 1e-4, "{power}");
        }
        // The mean cosine of a cone is 1 − h/2.
        for h in [2.0, 1.0, 0.1] {
            assert!((mean(&|u| cone(u, h).z) - (1.0 - 0.5 * h)).abs() < 1e-4, "{h}");
        }
        assert!(mean(&|u| disk(u).x).abs() < 1e-12 && mean(&|u| disk(u).y).abs() < 1e-12);
    }

    #[test]
    fn directions_are_unit_vectors_even_for_needles() {
        for n in [0.0, 1.0, 1e3, 1e12] {
            let d = cosine_power([0.3, 0.8], n);
            assert!((d.length() - 1.0).abs() < 1e-14, "{n}: {d}");
        }
        assert!(cosine_power([0.5, 0.0], 1e12).x > 1e-7);
        // The rim of a cone of 1e-6 rad: sin τ, to all digits.
        let rim = cone([1.0, 0.5], 2.0 * 0.5e-6_f64.sin().powi(2));
        assert!((rim.x / 1e-6_f64.sin() - 1.0).abs() < 1e-14 && (rim.length() - 1.0).abs() < 1e-14, "{rim}");
        assert!((cone([1.0, 0.3], 2.0).length() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_split_number_is_uniform_again() {
        assert_eq!(split(0.25, 0.5), (true, 0.5));
        assert_eq!(split(0.75, 0.5), (false, 0.5));
        assert_eq!(split(0.3, 1.0), (true, 0.3));
        assert_eq!(split(0.3, 0.0), (false, 0.3));
    }
}

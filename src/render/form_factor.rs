//! Form factors between surfaces that have one in closed form: F₁₂ is the part of the flux leaving a Lambertian surface 1 that reaches
//! surface 2, with nothing in between; A₁ F₁₂ = A₂ F₂₁.
//!
//! ```text
//! F₁₂ = 1/(π A₁) ∫∫ cosθ₁ cosθ₂ / r² dA₂ dA₁
//! ```
//!
//! Lengths in metres (only their ratios matter), all positive. Written so that surfaces far from or close to one another keep their digits.
//!
//! Reference: J. R. Howell, *A Catalog of Radiation Heat Transfer Configuration Factors* (the numbers C-… below).

use std::f64::consts::PI;

/// Two equal rectangles `width` × `height`, directly opposite each other, `distance` apart (C-11; H. C. Hottel 1931). With
/// X = width/distance, Y = height/distance:
///
/// ```text
/// F₁₂ = 2/(πXY) (½ ln((1 + X²)(1 + Y²)/(1 + X² + Y²)) + X d(X, Y) + Y d(Y, X))
/// d(X, Y) = √(1 + Y²) atan(X/√(1 + Y²)) − atan X
/// ```
#[must_use]
pub fn parallel_rectangles(width: f64, height: f64, distance: f64) -> f64 {
    let (x, y) = (width / distance, height / distance);
    let d = |x: f64, y: f64| {
        let root = 1.0_f64.hypot(y);
        let more = y * y / (1.0 + root);
        more * (x / root).atan() - (x * more / (root + x * x)).atan()
    };
    let log = 0.5 * (x * x * y * y / (1.0 + x * x + y * y)).ln_1p();
    2.0 / (PI * x * y) * (log + x * d(x, y) + y * d(y, x))
}

/// From a rectangle `edge` × `own` to a rectangle `edge` × `other` at right angles to it, with the side `edge` in common (C-14). With
/// W = own/edge, H = other/edge:
///
/// ```text
/// F₁₂ = 1/(πW) (W atan(1/W) + H atan(1/H) − √(H² + W²) atan(1/√(H² + W²))
///     + ¼ ln((1 + W²)(1 + H²)/(1 + W² + H²) · (W²(1 + W² + H²)/((1 + W²)(W² + H²)))^W² · (H²(1 + H² + W²)/((1 + H²)(H² + W²)))^H²))
/// ```
///
/// The absolute error is some 1e-16 (1 + 1/W).
#[must_use]
pub fn adjacent_rectangles(own: f64, other: f64, edge: f64) -> f64 {
    let (w, h) = (own / edge, other / edge);
    let (w2, h2) = (w * w, h * h);
    let (square, root) = (w2 + h2, w.hypot(h));
    // x²(1 + x² + y²)/((1 + x²)(x² + y²)) = 1 − y²/((1 + x²)(x² + y²)).
    let power = |x2: f64, y2: f64| {
        let less = y2 / ((1.0 + x2) * square);
        let log = if less < 0.5 { (-less).ln_1p() } else { (x2 / square * (1.0 + square) / (1.0 + x2)).ln() };
        x2 * log
    };
    let log = 0.25 * ((w2 * h2 / (1.0 + square)).ln_1p() + power(w2, h2) + power(h2, w2));
    (w * w.recip().atan() + h * h.recip().atan() - root * root.recip().atan() + log) / (PI * w)
}

/// From a disk of radius `own` to a parallel one of radius `other` on the same axis, `distance` away (C-41). With R = radius/distance:
///
/// ```text
/// F₁₂ = ½ (S − √(S² − 4 (R₂/R₁)²)),   S = 1 + (1 + R₂²)/R₁²
/// ```
#[must_use]
pub fn coaxial_disks(own: f64, other: f64, distance: f64) -> f64 {
    // The difference of the roots as their product over their sum, all of it times R₁².
    let sum = distance * distance + own * own + other * other;
    let root = distance.hypot(own - other) * distance.hypot(own + other);
    2.0 * other * (other / (sum + root))
}

/// Between a sphere of radius `inner` and one of radius `outer` about it: `[F₁₂, F₂₁, F₂₂]`, 1 the inner one, which sees nothing else,
/// 2 the inside of the outer one, which sees the rest of itself.
///
/// ```text
/// F₁₂ = 1,   F₂₁ = (r₁/r₂)²,   F₂₂ = 1 − F₂₁
/// ```
#[must_use]
pub fn concentric_spheres(inner: f64, outer: f64) -> [f64; 3] {
    let ratio = inner / outer;
    [1.0, ratio * ratio, (1.0 - ratio) * (1.0 + ratio)]
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::math::cubature::{Tolerance, rectangle};
    use crate::render::shape::Shape;
    use crate::render::shape::disk::Disk;
    use crate::render::shape::rectangle::Rectangle;

    /// The same formulas at 60 digits (mpmath), where nothing cancels.
    #[test]
    fn near_and_far_keep_their_digits() {
        let close = |got: f64, expected: f64, error: f64| assert!((got - expected).abs() <= error, "{got} {expected}");
        for ([width, height, distance], expected) in [
            ([1.0, 1.0, 1.0], 0.199_824_895_698_387_38),
            ([1e-3, 2e-3, 1.0], 6.366_187_113_372_163e-7),
            ([0.01, 0.5, 1.0], 1.475_788_673_027_473_5e-3),
            ([1.0, 2.0, 1e-4], 0.999_850_037_630_051_1),
            ([3.0, 0.001, 2.0], 1.564_164_677_881_361_7e-4),
            ([1e6, 3e6, 1.0], 0.999_998_666_670_314_5),
        ] {
            close(parallel_rectangles(width, height, distance), expected, 1e-14 * expected);
        }
        for ([own, other, edge], expected) in [
            ([1.0, 1.0, 1.0], 0.200_043_776_075_403_15),
            ([1.0, 1e-4, 1.0], 4.998_225_555_287_822e-5),
            ([1e-4, 1.0, 1.0], 0.499_822_555_528_782_13),
            ([1.0, 1e4, 2.0], 0.323_893_280_127_906_8),
            ([3.0, 0.5, 4.0], 0.069_082_802_753_063_34),
            ([1e-3, 1e-3, 1.0], 0.292_782_901_039_901_96),
            ([1e3, 1e-3, 1.0], 4.986_618_640_942_027e-7),
        ] {
            close(adjacent_rectangles(own, other, edge), expected, 2e-16 * (1.0 + edge / own));
        }
        for ([own, other, distance], expected) in [
            ([1.0, 1.0, 1.0], 0.381_966_011_250_105_15),
            ([1e-6, 1.0, 1.0], 0.499_999_999_999_875),
            ([1.0, 1e-6, 1.0], 4.999_999_999_998_75e-13),
            ([1e-5, 2e-5, 1.0], 3.999_999_998e-10),
            ([1.0, 2.0, 1e-6], 0.999_999_999_999_666_7),
        ] {
            close(coaxial_disks(own, other, distance), expected, 1e-15 * expected);
        }
    }
    /// The mean over surface 1 of the projected solid angle of surface 2, over π, by adaptive cubature to its own error.
    #[test]
    fn means_of_projected_solid_angles_agree() {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        let mean = |shape: &dyn Shape, point: &dyn Fn([f64; 2]) -> (DVec3, DVec3, f64), high: [f64; 2]| {
            let mut out = [0.0];
            let f = |p: [f64; 2], v: &mut [f64]| {
                let (from, normal, weight) = point(p);
                v[0] = weight * shape.projected_solid_angle(from, normal).unwrap() / PI;
            };
            let tolerance = Tolerance { absolute: 1e-9, relative: 1e-9, evaluations: 200_000 };
            let estimate = rectangle(f, [0.0; 2], high, tolerance, &mut out);
            (out[0] / (high[0] * high[1]), estimate.error / (high[0] * high[1]) + 1e-12)
        };
        let agree = |(got, error): (f64, f64), expected: f64| {
            assert!((got - expected).abs() <= error, "{got} {expected} {error}")
        };

        let lid = Rectangle::new(1.5 * z, 2.0 * x, 0.7 * y).unwrap();
        agree(mean(&lid, &|[a, b]| (a * x + b * y, z, 1.0), [2.0, 0.7]), parallel_rectangles(2.0, 0.7, 1.5));
        let wall = Rectangle::new(DVec3::ZERO, 0.7 * y, 1.2 * z).unwrap();
        agree(mean(&wall, &|[a, b]| (a * x + b * y, z, 1.0), [2.0, 0.7]), adjacent_rectangles(2.0, 1.2, 0.7));
        // Over a disk of radius 0.8: r dr dφ / (π R²), times the area of (r, φ) that the mean divides by.
        let disk = Disk::new(0.6 * z, z, 1.1).unwrap();
        agree(mean(&disk, &|[r, _]| (r * x, z, 2.0 * r / 0.8), [0.8, 1.0]), coaxial_disks(0.8, 1.1, 0.6));
    }

    #[test]
    fn factors_of_enclosures_add_up_to_one() {
        // A box's floor sees its lid and four walls.
        for [a, b, h] in [[1.0, 1.0, 1.0], [3.0, 0.5, 2.0], [10.0, 4.0, 2.7]] {
            let walls = adjacent_rectangles(a, h, b) + adjacent_rectangles(b, h, a);
            assert!((parallel_rectangles(a, b, h) + 2.0 * walls - 1.0).abs() < 1e-14, "{a} {b} {h}");
        }
        // The inside of a sphere around another: its own part and the inner sphere's; areas times factors are equal both ways.
        let [f12, f21, f22] = concentric_spheres(0.5, 1.0);
        assert_eq!((f12, f21 + f22, 0.25 * f12), (1.0, 1.0, f21));
    }
}

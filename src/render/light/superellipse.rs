//! Soft regions between two superellipses, the shapes of production lights.
//!
//! ```text
//! |x/a|^(2/d) + |y/b|^(2/d) = 1
//! ```
//!
//! with the roundness d: 0 a rectangle, 1 an ellipse, in between a rounded rectangle, 2 a rhombus. Inside the inner one (a, b) the
//! region is whole, outside the outer one (A, B) it is nothing; on each ray from the middle it falls between the two crossings p < q
//! by the smooth step 3t² − 2t³, t = (1 − p)/(q − p), the point itself being at 1.
//!
//! Source: R. Barzel, *Lighting Controls for Computer Cinematography*, Journal of Graphics Tools 2 (1997), appendix.

use glam::DVec2;

use super::{Error, within};

/// A soft region about the origin of a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Superellipse {
    inner: DVec2,
    outer: DVec2,
    roundness: f64,
}

impl Superellipse {
    /// Semi-axes of the inner (0 or more) and the outer (above 0, not below the inner) superellipse, and the roundness, 0 to 4.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn new(inner: DVec2, outer: DVec2, roundness: f64) -> Result<Self, Error> {
        for (inner, outer) in [(inner.x, outer.x), (inner.y, outer.y)] {
            within("a semi-axis of an outer superellipse", outer, outer > 0.0 && outer < 1e100, "above 0")?;
            let sound = inner >= 0.0 && inner <= outer;
            within("a semi-axis of an inner superellipse", inner, sound, "0 to that of the outer one")?;
        }
        let roundness = within("a roundness", roundness, (0.0..=4.0).contains(&roundness), "0 to 4")?;
        Ok(Self { inner, outer, roundness })
    }

    /// Semi-axes of the outer superellipse.
    #[must_use]
    pub fn outer(&self) -> DVec2 {
        self.outer
    }

    /// 1 inside, 0 outside, smooth between.
    #[must_use]
    pub fn coverage(&self, place: DVec2) -> f64 {
        let inner = radius(place, self.inner, self.roundness);
        if inner <= 1.0 {
            return 1.0;
        }
        let outer = radius(place, self.outer, self.roundness);
        if outer >= 1.0 {
            return 0.0;
        }
        let (p, q) = (1.0 / inner, 1.0 / outer);
        1.0 - smooth_step((1.0 - p) / (q - p))
    }
}

/// Distance from the middle in units of that of the superellipse on the same ray.
fn radius(place: DVec2, semi: DVec2, roundness: f64) -> f64 {
    let ratio = |x: f64, a: f64| if x == 0.0 { 0.0 } else { x.abs() / a };
    let (u, v) = (ratio(place.x, semi.x), ratio(place.y, semi.y));
    let (small, large) = (u.min(v), u.max(v));
    // The larger taken out: powers of 2/d, which is infinite for the rectangle, stay in range.
    if roundness == 0.0 || small == 0.0 || large.is_infinite() {
        return large;
    }
    large * (1.0 + (small / large).powf(2.0 / roundness)).powf(0.5 * roundness)
}

/// 3t² − 2t³ between 0 and 1, constant beyond.
pub(super) fn smooth_step(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region(inner: (f64, f64), outer: (f64, f64), roundness: f64) -> Superellipse {
        Superellipse::new(DVec2::from(inner), DVec2::from(outer), roundness).expect("a region")
    }

    #[test]
    fn roundness_makes_rectangles_ellipses_and_rhombi() {
        let hard = |roundness, x, y| region((2.0, 1.0), (2.0, 1.0), roundness).coverage(DVec2::new(x, y));
        // The corner of the rectangle; the point at 45° of the ellipse, 2/√2 and 1/√2; the middle of the rhombus' side, 1 and ½.
        for (roundness, x, y) in [(0.0, 2.0, 1.0), (1.0, 2.0 * 0.5_f64.sqrt(), 0.5_f64.sqrt()), (2.0, 1.0, 0.5)] {
            assert_eq!(hard(roundness, 0.999 * x, 0.999 * y), 1.0, "{roundness}");
            assert_eq!(hard(roundness, 1.001 * x, 1.001 * y), 0.0, "{roundness}");
        }
        assert_eq!((hard(1.0, 0.0, 0.0), hard(0.0, 1.999, 0.999), hard(1e-3, 1.99, 0.99)), (1.0, 1.0, 1.0));
    }

    #[test]
    fn edges_are_smooth_steps_along_the_ray() {
        let soft = region((1.0, 1.0), (3.0, 3.0), 1.0);
        // On a circle's ray at r: t = (1 − 1/r)/(3/r − 1/r) = (r − 1)/2.
        for r in [1.0, 1.5, 2.0, 2.9, 3.0] {
            let t: f64 = 0.5 * (r - 1.0);
            let expected = 1.0 - t * t * (3.0 - 2.0 * t);
            assert!((soft.coverage(DVec2::new(0.6 * r, -0.8 * r)) - expected).abs() < 1e-14, "{r}");
        }
        // An inner superellipse of no size fades from the middle.
        let fade = region((0.0, 0.0), (1.0, 2.0), 1.0);
        assert_eq!((fade.coverage(DVec2::ZERO), fade.coverage(DVec2::new(0.5, 0.0))), (1.0, 0.5));
        assert_eq!(fade.coverage(DVec2::new(0.0, 2.0)), 0.0);
    }

    #[test]
    fn bad_axes_are_refused() {
        assert!(Superellipse::new(DVec2::splat(2.0), DVec2::ONE, 1.0).is_err());
        assert!(Superellipse::new(DVec2::ZERO, DVec2::ZERO, 1.0).is_err());
        assert!(Superellipse::new(DVec2::ZERO, DVec2::ONE, f64::NAN).is_err());
    }
}

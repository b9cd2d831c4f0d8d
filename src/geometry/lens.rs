//! The distortion of a lens, as photogrammetry and OpenCV model it.
//!
//! ```text
//! r² = x² + y²
//! x_d = x (1 + k₁ r² + k₂ r⁴ + k₃ r⁶) + 2 p₁ x y + p₂ (r² + 2 x²)
//! y_d = y (1 + k₁ r² + k₂ r⁴ + k₃ r⁶) + p₁ (r² + 2 y²) + 2 p₂ x y
//! ```
//!
//! (x, y) are the tangents of the ideal picture, x to the right and y downwards, at focal length 1; (x_d, y_d) those of the picture that
//! the lens makes.
//!
//! References: D. C. Brown, *Decentering Distortion of Lenses*, Photogrammetric Engineering 32 (1966); A. E. Conrady, MNRAS 79 (1919).

use glam::{DMat2, DVec2};

/// Radial (k) and tangential (p) coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Distortion {
    /// Of r².
    pub k1: f64,
    /// Of r⁴.
    pub k2: f64,
    /// Tangential, about the vertical.
    pub p1: f64,
    /// Tangential, about the horizontal.
    pub p2: f64,
    /// Of r⁶.
    pub k3: f64,
}

impl Distortion {
    /// Where the lens puts an ideal point.
    #[must_use]
    pub fn distort(&self, ideal: DVec2) -> DVec2 {
        let DVec2 { x, y } = ideal;
        let r2 = ideal.length_squared();
        let radial = 1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3));
        DVec2::new(
            x * radial + 2.0 * self.p1 * x * y + self.p2 * (r2 + 2.0 * x * x),
            y * radial + self.p1 * (r2 + 2.0 * y * y) + 2.0 * self.p2 * x * y,
        )
    }

    /// The derivatives of [`Distortion::distort`]: columns are those by x and by y.
    #[must_use]
    pub fn jacobian(&self, ideal: DVec2) -> DMat2 {
        let DVec2 { x, y } = ideal;
        let r2 = ideal.length_squared();
        let radial = 1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3));
        // d(radial)/d(r²).
        let slope = self.k1 + r2 * (2.0 * self.k2 + r2 * 3.0 * self.k3);
        let mixed = 2.0 * x * y * slope + 2.0 * (self.p1 * x + self.p2 * y);
        DMat2::from_cols(
            DVec2::new(radial + 2.0 * x * x * slope + 2.0 * self.p1 * y + 6.0 * self.p2 * x, mixed),
            DVec2::new(mixed, radial + 2.0 * y * y * slope + 6.0 * self.p1 * y + 2.0 * self.p2 * x),
        )
    }

    /// The ideal point that the lens puts at `distorted`, by Newton's method from the point itself to rounding; `None` where there is
    /// none within the circle in which the model is one-to-one, or the search does not settle.
    #[must_use]
    pub fn undistort(&self, distorted: DVec2) -> Option<DVec2> {
        if *self == Self::default() {
            return Some(distorted);
        }
        let mut ideal = distorted;
        for _ in 0..30 {
            let jacobian = self.jacobian(ideal);
            // Beyond a fold of the model the picture is mirrored: no lens does that.
            if jacobian.determinant() <= 0.0 {
                return None;
            }
            let step = jacobian.inverse() * (distorted - self.distort(ideal));
            ideal += step;
            if step.length() <= 4.0 * f64::EPSILON * ideal.length() {
                break;
            }
        }
        let left = (self.distort(ideal) - distorted).length();
        (left <= 1e-13 * (1.0 + distorted.length())).then_some(ideal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// That of the left chessboard set in `../shared/capture`, as its issue quotes it.
    const LENS: Distortion = Distortion { k1: -0.05716, k2: 0.09202, p1: -0.00025, p2: 0.00228, k3: -0.01908 };

    #[test]
    fn undistorting_undoes_distorting() {
        for i in -10..=10 {
            for j in -10..=10 {
                let ideal = DVec2::new(f64::from(i), f64::from(j)) * 0.08;
                let back = LENS.undistort(LENS.distort(ideal)).unwrap();
                assert!((back - ideal).length() < 1e-13, "{ideal}: {back}");
            }
        }
        assert_eq!(Distortion::default().undistort(DVec2::new(3.0, -4.0)), Some(DVec2::new(3.0, -4.0)));
    }

    #[test]
    fn derivatives_are_those_of_the_formula() {
        let (at, h) = (DVec2::new(0.31, -0.22), 1e-6);
        let jacobian = LENS.jacobian(at);
        for (column, axis) in [(jacobian.x_axis, DVec2::X), (jacobian.y_axis, DVec2::Y)] {
            // Central differences: error h² times a third derivative of order one.
            let difference = (LENS.distort(at + h * axis) - LENS.distort(at - h * axis)) / (2.0 * h);
            assert!((column - difference).length() < 1e-9, "{column} {difference}");
        }
    }

    #[test]
    fn what_no_ray_reaches_has_no_direction() {
        let barrel = Distortion { k1: -0.3, ..Distortion::default() };
        // r (1 − 0.3 r²) is greatest at r = 1/√0.9, where it is 0.7027.
        assert!(barrel.undistort(DVec2::new(0.69, 0.0)).is_some());
        assert!(barrel.undistort(DVec2::new(0.72, 0.0)).is_none());
    }
}

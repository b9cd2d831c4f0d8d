//! Pictures of surroundings: which way each pixel looks, and the solid angle that it covers.
//!
//! In the picture's own frame the camera looks along +x with +z up, so that the right of the picture lies towards −y, as in a
//! photograph. Rows run from the top, columns from the left.
//!
//! | projection | picture | place of a direction at the angle α to +x |
//! |---|---|---|
//! | equirectangular | the sphere; the middle looks along +x | column in proportion to the azimuth, row to the angle to +z |
//! | mirror ball | the sphere, in the disc inscribed in a square | r = cos(α/2): the camera looks along +x at a ball, whose middle shows −x |
//! | equidistant fisheye | to the half-angle h, in such a disc | r = α/h |
//! | equisolid fisheye | to the half-angle h, in such a disc | r = sin(α/2)/sin(h/2) |
//!
//! The normal of a ball that is seen from afar is inclined by β with sin β = r, and turns a ray by twice that: equal areas of its disc
//! are equal solid angles, as in the equisolid fisheye.
//!
//! Limits: a ball photographed from close by shows less than the sphere; its edge, where all directions around +x are crowded, is
//! only as good as the photograph. Real fisheye lenses deviate from both formulas by some per cent.
//!
//! Source: G. S. Miller & C. R. Hoffman, *Illumination and Reflection Maps*, SIGGRAPH 84 course notes (mirror ball); P. Debevec,
//! *Rendering Synthetic Objects into Real Scenes*, SIGGRAPH 98.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};

/// How a picture shows the directions around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Azimuth and angle to the vertical along the sides; width and height of any ratio.
    Equirectangular,
    /// A mirroring ball photographed from afar; square.
    MirrorBall,
    /// Radius in proportion to the angle; square.
    Equidistant {
        /// Angle to the axis at the rim, rad, above 0 to π.
        half_field_rad: f64,
    },
    /// Area in proportion to the solid angle; square.
    Equisolid {
        /// Angle to the axis at the rim, rad, above 0 to π.
        half_field_rad: f64,
    },
}

impl Projection {
    /// A fisheye picture of the hemisphere before the camera, radius in proportion to the angle.
    pub const HEMISPHERE: Self = Self::Equidistant { half_field_rad: FRAC_PI_2 };

    /// The angle at the rim of a disc, rad; `None` for the equirectangular picture, which has no rim.
    #[must_use]
    pub fn half_field_rad(self) -> Option<f64> {
        match self {
            Self::Equirectangular => None,
            Self::MirrorBall => Some(PI),
            Self::Equidistant { half_field_rad } | Self::Equisolid { half_field_rad } => Some(half_field_rad),
        }
    }

    /// The place in the picture, each side from 0 (left, top) to 1, of a direction (unit); `None` where the picture does not reach.
    #[must_use]
    pub fn place(self, direction: DVec3) -> Option<DVec2> {
        let (right, up) = (-direction.y, direction.z);
        let Some(h) = self.half_field_rad() else {
            let theta = direction.x.hypot(direction.y).atan2(up);
            return Some(DVec2::new(0.5 + right.atan2(direction.x) / TAU, theta / PI));
        };
        let axis = if self == Self::MirrorBall { DVec3::NEG_X } else { DVec3::X };
        // sin(α/2) by the chord, exact to the last digits for small and large angles.
        let half_sine = (0.5 * direction.distance(axis)).min(1.0);
        let r = match self {
            Self::Equidistant { .. } => 2.0 * half_sine.asin() / h,
            _ => half_sine / (0.5 * h).sin(),
        };
        let across = DVec2::new(right, up);
        let p = across.try_normalize().unwrap_or(if r > 0.5 { DVec2::X } else { DVec2::ZERO }) * r;
        (r <= 1.0).then(|| DVec2::new(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.y))
    }

    /// The direction (unit) of a place in the picture; `None` beyond the rim.
    #[must_use]
    pub fn direction(self, place: DVec2) -> Option<DVec3> {
        let Some(h) = self.half_field_rad() else {
            let ((sin, cos), (s, c)) = ((PI * place.y).sin_cos(), (TAU * (place.x - 0.5)).sin_cos());
            return Some(DVec3::new(sin * c, -sin * s, cos));
        };
        let p = DVec2::new(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y);
        let r = p.length();
        if r > 1.0 {
            return None;
        }
        let (cos, sin_by_r) = match self {
            Self::Equidistant { .. } => {
                let (sin, cos) = (h * r).sin_cos();
                (cos, if r > 0.0 { sin / r } else { h })
            }
            _ => {
                let rim = (0.5 * h).sin();
                let half = rim * r;
                (1.0 - 2.0 * half * half, 2.0 * rim * (1.0 - half * half).max(0.0).sqrt())
            }
        };
        let along = if self == Self::MirrorBall { -cos } else { cos };
        Some(DVec3::new(along, -sin_by_r * p.x, sin_by_r * p.y))
    }

    /// Share of the picture's area per solid angle about a direction, 1/sr.
    #[must_use]
    pub fn area_per_solid_angle(self, direction: DVec3) -> f64 {
        match self {
            Self::Equirectangular => 1.0 / (TAU * PI * direction.x.hypot(direction.y)),
            Self::Equidistant { half_field_rad: h } => {
                let sin = direction.y.hypot(direction.z);
                let alpha = sin.atan2(direction.x);
                let stretch = if sin > 0.0 { alpha / sin } else { 1.0 };
                stretch / (4.0 * h * h)
            }
            Self::MirrorBall => 1.0 / 16.0,
            Self::Equisolid { half_field_rad: h } => 1.0 / (16.0 * (0.5 * h).sin().powi(2)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;
    use crate::math::sampling::cone;

    const ALL: [Projection; 6] = [
        Projection::Equirectangular,
        Projection::MirrorBall,
        Projection::HEMISPHERE,
        Projection::Equidistant { half_field_rad: 1.9 },
        Projection::Equisolid { half_field_rad: FRAC_PI_2 },
        Projection::Equisolid { half_field_rad: 2.5 },
    ];

    #[test]
    fn places_and_directions_are_inverse() {
        let mut stream = Stream::new(1, 0);
        for projection in ALL {
            for _ in 0..2000 {
                let direction = cone(stream.uniforms(), 2.0);
                let Some(place) = projection.place(direction) else {
                    let h = projection.half_field_rad().expect("a rim");
                    assert!(direction.x < h.cos(), "{projection:?} does not show {direction}");
                    continue;
                };
                let back = projection.direction(place).expect("within the rim");
                assert!(
                    back.distance(direction) < 1e-7 && (back.length() - 1.0).abs() < 1e-14,
                    "{projection:?} {direction}"
                );
            }
        }
    }

    /// The four sides and the middle, as a photograph shows them.
    #[test]
    fn pictures_are_the_right_way_round() {
        let at = |projection: Projection, x, y| projection.direction(DVec2::new(x, y)).expect("a direction");
        let same = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-15, "{a} {b}");
        let e = Projection::Equirectangular;
        same(at(e, 0.5, 0.5), DVec3::X);
        same(at(e, 0.75, 0.5), DVec3::NEG_Y);
        same(at(e, 0.25, 0.5), DVec3::Y);
        same(at(e, 0.5, 0.0), DVec3::Z);
        let f = Projection::HEMISPHERE;
        same(at(f, 0.5, 0.5), DVec3::X);
        same(at(f, 1.0, 0.5), DVec3::NEG_Y);
        same(at(f, 0.5, 0.0), DVec3::Z);
        // Half way to the rim of the hemisphere are 45° (equidistant), 2 asin(sin 45°/2) = 41.4096° (equisolid).
        same(at(f, 0.75, 0.5), DVec3::new(0.5_f64.sqrt(), -(0.5_f64.sqrt()), 0.0));
        let half = 41.409_622_109_270_856_f64.to_radians();
        same(at(ALL[4], 0.75, 0.5), DVec3::new(half.cos(), -half.sin(), 0.0));
    }

    /// The reflection law R = d − 2 (d·n) n on the ball's normal, for a camera that looks along d = +x.
    #[test]
    fn the_ball_mirrors() {
        let d = DVec3::X;
        for (right, up) in [(0.0_f64, 0.0_f64), (0.5, 0.0), (0.0, -0.7), (0.3, 0.4), (0.6, -0.79)] {
            let n = DVec3::new(-(1.0 - right * right - up * up).sqrt(), -right, up);
            let mirrored = d - 2.0 * d.dot(n) * n;
            let seen =
                Projection::MirrorBall.direction(DVec2::new(0.5 + 0.5 * right, 0.5 - 0.5 * up)).expect("on the ball");
            assert!(seen.distance(mirrored) < 1e-15, "{seen} {mirrored}");
        }
        assert_eq!(Projection::MirrorBall.direction(DVec2::new(0.01, 0.01)), None);
        assert!(Projection::MirrorBall.place(DVec3::X).is_some());
    }

    /// The area of a small triangle of directions in the picture, over its solid angle.
    #[test]
    fn areas_are_those_of_the_map() {
        let mut stream = Stream::new(2, 0);
        for projection in ALL {
            for _ in 0..200 {
                let direction = cone(stream.uniforms(), 2.0);
                let (a, b) = crate::geometry::direction::tangents(direction);
                let e = 1e-5;
                let place = |u: f64, v: f64| projection.place((direction + e * (u * a + v * b)).normalize());
                let (Some(x0), Some(x1), Some(y0), Some(y1)) =
                    (place(-1.0, 0.0), place(1.0, 0.0), place(0.0, -1.0), place(0.0, 1.0))
                else {
                    continue;
                };
                let near_a_seam =
                    direction.z.abs() > 0.95 || direction.x < -0.95 || direction.x > 0.95 || direction.y.abs() < 1e-2;
                let area = (x1 - x0).perp_dot(y1 - y0).abs() / (4.0 * e * e);
                let density = projection.area_per_solid_angle(direction);
                // Central differences err by e² times third derivatives of order one away from poles, cuts and rims.
                assert!(
                    near_a_seam || (area / density - 1.0).abs() < 1e-4,
                    "{projection:?} {direction}: {area} {density}"
                );
            }
        }
    }
}

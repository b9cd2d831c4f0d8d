//! Sphere; its outside is away from the centre.
//!
//! | | |
//! |---|---|
//! | crossing | stable quadratic: discriminant from the ray's distance to the centre, no difference of nearly equal roots (E. Haines et al., *Precision Improvements for Ray/Sphere Intersection*, Ray Tracing Gems, 2019) |
//! | uv | (φ/2π, θ/π): φ from the meridian (+x unless turned) anticlockwise about the pole (+z), θ from the pole |
//! | tangent | along the parallel, towards greater φ; the meridian's +90° at the poles |
//! | directions | from outside uniform over the visible cone; from inside, points uniform over the area |
//! | solid angle | 2π(1 − cos σ), sin σ = R/d |

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::error::{ShapeError, finite, positive};
use super::rounding::gamma;
use super::{Bounds, Shape, pdf_of_point, towards_point};
use crate::geometry::direction::{phi, tangents, theta};
use crate::render::ray::{Crossing, Ray, SurfacePoint, Towards};

/// A sphere in world coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Sphere {
    centre: DVec3,
    radius: f64,
    /// From local coordinates (pole +z, meridian +x) to the world's.
    turn: DMat3,
}

/// What is seen of a sphere from outside: axis and half-angle σ of the cone about it.
struct Cone {
    axis: DVec3,
    /// Distance of the centre, m.
    distance: f64,
    /// 1 − cos σ, without cancellation.
    one_minus_cos: f64,
    /// Product of the distances to both crossings of a ray, d² − R², m².
    power: f64,
}

impl Sphere {
    /// The sphere of `radius` (m, positive) about `centre` (m).
    ///
    /// # Errors
    ///
    /// What is not finite or not positive.
    pub fn new(centre: DVec3, radius: f64) -> Result<Self, ShapeError> {
        let (centre, radius) = (finite("centre", centre)?, positive("radius", radius)?);
        Ok(Self { centre, radius, turn: DMat3::IDENTITY })
    }

    /// The same sphere with pole and meridian (which `uv` and the tangent follow) turned by a unit quaternion.
    #[must_use]
    pub fn turned(self, rotation: DQuat) -> Self {
        Self { turn: DMat3::from_quat(rotation) * self.turn, ..self }
    }

    /// The point in the direction `outwards` (unit) from the centre.
    fn point(&self, outwards: DVec3) -> SurfacePoint {
        let position = self.centre + self.radius * outwards;
        let local = self.turn.transpose() * outwards;
        let (y, x) = if local.x == 0.0 && local.y == 0.0 { (0.0, 1.0) } else { (local.y, local.x) };
        let tangent = self.turn * (DVec3::new(-y, x, 0.0) / x.hypot(y));
        SurfacePoint {
            position,
            // Roundings of the unit vector, of the radius times it and of the sum, and those of the next crossing's d² − R² and
            // distance to the axis, with some reserve.
            error: gamma(16.0) * self.radius + gamma(4.0) * position.length(),
            normal: outwards,
            shading: outwards,
            tangent,
            uv: DVec2::new(phi(local) / TAU, theta(local) / PI),
        }
    }

    /// The visible cone; `None` from inside and from the sphere itself.
    fn cone(&self, from: DVec3) -> Option<Cone> {
        let to = self.centre - from;
        let distance = to.length();
        if distance <= self.radius {
            return None;
        }
        let power = (distance - self.radius) * (distance + self.radius);
        let sin = self.radius / distance;
        let one_minus_cos = sin * sin / (1.0 + power.sqrt() / distance);
        Some(Cone { axis: to / distance, distance, one_minus_cos, power })
    }
}

impl Shape for Sphere {
    fn bounds(&self) -> Bounds {
        Bounds { min: self.centre - self.radius, max: self.centre + self.radius }
    }

    fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        let f = ray.origin - self.centre;
        let b = -f.dot(ray.direction);
        let discriminant = self.radius * self.radius - (f + b * ray.direction).length_squared();
        if discriminant < 0.0 {
            return None;
        }
        let length = f.length();
        let q = b + discriminant.sqrt().copysign(b);
        let other = (length - self.radius) * (length + self.radius) / q;
        let inside = |t: f64| near < t && t < far;
        let t = [other.min(q), other.max(q)].into_iter().find(|&t| inside(t))?;
        Some(Crossing { t, uv: DVec2::ZERO, face: 0 })
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.point((ray.origin - self.centre + crossing.t * ray.direction).normalize())
    }

    fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }

    fn sample_area(&self, [_, u, v]: [f64; 3]) -> SurfacePoint {
        // sin θ = √((1 − z)(1 + z)) with z = 1 − 2u.
        let sin = 2.0 * (u * (1.0 - u)).sqrt();
        let (y, x) = (TAU * v).sin_cos();
        self.point(self.turn * DVec3::new(sin * x, sin * y, 1.0 - 2.0 * u))
    }

    fn sample_towards(&self, from: DVec3, u: [f64; 3]) -> Option<Towards> {
        let Some(cone) = self.cone(from) else {
            return towards_point(self.area(), from, &self.sample_area(u));
        };
        let z = u[1] * cone.one_minus_cos;
        let sin = (z * (2.0 - z)).sqrt();
        let (first, second) = tangents(cone.axis);
        let (y, x) = (TAU * u[2]).sin_cos();
        let direction = ((1.0 - z) * cone.axis + sin * (x * first + y * second)).normalize();
        let half_chord = (self.radius * self.radius - (cone.distance * sin).powi(2)).max(0.0).sqrt();
        let distance = cone.power / ((1.0 - z) * cone.distance + half_chord);
        let pdf = 1.0 / (TAU * cone.one_minus_cos);
        (distance > 0.0 && pdf.is_finite()).then_some(Towards { direction, distance, pdf, delta: false })
    }

    fn pdf_towards(&self, from: DVec3, point: &SurfacePoint) -> f64 {
        match self.cone(from) {
            Some(cone) => 1.0 / (TAU * cone.one_minus_cos),
            None => pdf_of_point(self.area(), from, point),
        }
    }

    /// The cap of half-angle σ at the angle ω to the normal. Projected onto the receiver's plane (W. Nusselt 1928) its rim is an
    /// ellipse that touches the unit circle where the cap meets the horizon, at the angle α from the azimuth of the centre:
    ///
    /// ```text
    /// above:    Ω⊥ = π sin²σ cos ω
    /// cut:      Ω⊥ = seg(α) + sin²σ cos ω seg(π − β),   tan α = √(sin²σ − cos²ω)/cos σ,   cos β = cot σ cot ω
    ///           seg(x) = x − sin x cos x
    /// ```
    ///
    /// (J. M. Snyder, *Area Light Sources for Real-Time Graphics*, MSR-TR-96-11, has the same area in other words.) From inside all
    /// directions meet the sphere: π.
    fn projected_solid_angle(&self, from: DVec3, normal: DVec3) -> Option<f64> {
        let Some(cone) = self.cone(from) else { return Some(PI) };
        let sin = self.radius / cone.distance;
        let cos = cone.power.sqrt() / cone.distance;
        let cos_omega = cone.axis.dot(normal);
        if cos_omega >= sin {
            return Some(PI * sin * sin * cos_omega);
        }
        if cos_omega <= -sin {
            return Some(0.0);
        }
        let rise = ((sin - cos_omega) * (sin + cos_omega)).sqrt();
        let alpha = rise.atan2(cos);
        // Sine and cosine of β, both times sin σ sin ω.
        let pi_minus_beta = rise.atan2(-cos * cos_omega);
        Some((segment(alpha) + sin * sin * cos_omega * segment(pi_minus_beta)).max(0.0))
    }
}

/// x − sin x cos x: the area of the segment of a unit circle of the half-angle x, without cancellation where it is small.
fn segment(x: f64) -> f64 {
    let y = 2.0 * x;
    if y > 0.5 {
        return 0.5 * (y - y.sin());
    }
    // The series of y − sin y from the smallest term: y³/3! (1 − y²/(4·5) (1 − y²/(6·7) …)).
    let square = y * y;
    let series = [14.0, 12.0, 10.0, 8.0, 6.0, 4.0].into_iter().fold(1.0, |sum, n| 1.0 - square / (n * (n + 1.0)) * sum);
    y * square / 12.0 * series
}

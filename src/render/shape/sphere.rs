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

use super::chart::Chart;
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

    /// From the centre to a crossing, as a unit vector. A sphere so small for its distance that the crossing is its centre to the last digit faces
    /// the ray.
    fn outwards(&self, ray: &Ray, crossing: &Crossing) -> DVec3 {
        let outwards = ray.origin - self.centre + crossing.t * ray.direction;
        outwards.try_normalize().unwrap_or(-ray.direction)
    }

    /// The point in the direction `outwards` (unit) from the centre.
    fn point(&self, outwards: DVec3) -> SurfacePoint {
        let local = self.turn.transpose() * outwards;
        SurfacePoint { uv: DVec2::new(phi(local) / TAU, theta(local) / PI), ..self.plain(outwards) }
    }

    /// The same without texture coordinates.
    fn plain(&self, outwards: DVec3) -> SurfacePoint {
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
            uv: DVec2::ZERO,
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
        self.point(self.outwards(ray, crossing))
    }

    fn plain_surface(&self, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.plain(self.outwards(ray, crossing))
    }

    fn charts(&self) -> Vec<(u32, Chart)> {
        vec![(0, Chart::Sphere { centre: self.centre, radius: self.radius })]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::shape::disk::Disk;

    /// ∫ 2φ(θ) cosθ sinθ dθ by tanh-sinh quadrature at 50 digits (mpmath), φ the half-width of the cap at the angle θ to the normal.
    #[test]
    fn caps_cut_by_the_horizon() {
        let cases: [([f64; 3], f64, [f64; 3], f64); 8] = [
            ([3.0, 0.0, 0.25], 0.5, [0.0, 0.0, 1.0], 7.786_611_384_461_041e-3),
            ([3.0, 1.0, -0.25], 0.5, [0.1, 0.0, 1.0], 3.280_782_631_866_537e-3),
            ([1.0, 0.0, 3e-7], 1e-6, [0.0, 0.0, 1.0], 1.227_224_337_896_885_9e-18),
            ([1.0, 0.0, -5e-7], 1e-6, [0.0, 0.0, 1.0], 1.259_202_772_400_803e-19),
            ([1.0, 0.5, -0.9], 1.4, [0.0, 0.0, 1.0], 0.291_340_447_602_282_85),
            ([0.2, 0.1, 0.1], 0.24, [0.0, 0.0, 1.0], 1.823_227_975_627_132_3),
            ([2.0, 0.0, 0.0], 1.0, [0.0, 0.0, 1.0], 0.090_586_073_706_079_55),
            ([1e8, 0.0, 3e7], 5e7, [0.0, 0.0, 1.0], 0.217_078_917_944_888_74),
        ];
        for (centre, radius, normal, expected) in cases {
            let sphere = Sphere::new(centre.into(), radius).unwrap();
            let got = sphere.projected_solid_angle(DVec3::ZERO, DVec3::from(normal).normalize()).unwrap();
            assert!((got / expected - 1.0).abs() < 1e-12, "{centre:?} {radius}: {got} {expected}");
        }
    }

    #[test]
    fn inside_on_and_beyond() {
        let sphere = Sphere::new(DVec3::new(0.0, 0.0, 2.0), 1.0).unwrap();
        let at = |from: DVec3, normal: DVec3| sphere.projected_solid_angle(from, normal).unwrap();
        assert_eq!(at(DVec3::new(0.2, 0.1, 1.9), DVec3::X), PI);
        assert_eq!(at(DVec3::ZERO, DVec3::NEG_Z), 0.0);
        // π (R/d)².
        assert!((at(DVec3::ZERO, DVec3::Z) - PI / 4.0).abs() < 1e-15);
        // Touching it, half of all directions: π (1 + cos ω)/2.
        let touching = at(DVec3::new(0.0, 0.0, 1.0 - 1e-15), DVec3::new(0.6, 0.0, 0.8));
        assert!((touching - 0.9 * PI).abs() < 1e-6, "{touching}");
    }

    /// The rim of the visible cap, filled by a disk, is seen in the same directions: another closed form of the same number.
    #[test]
    fn a_sphere_looks_like_the_disk_in_its_cone() {
        for distance in [1.000_001, 1.5, 40.0, 1e5] {
            let centre = distance * DVec3::new(0.48, -0.6, 0.64);
            let sphere = Sphere::new(centre, 1.0).unwrap();
            let along = 1.0 - 1.0 / (distance * distance);
            let disk = Disk::new(along * centre, centre, along.sqrt()).unwrap();
            for i in 0..40 {
                let normal = (DVec3::new(0.48, -0.6, 0.64) + f64::from(i - 20) * 0.1 / distance.sqrt() * DVec3::Z)
                    .cross(DVec3::new(0.3, 0.1 * f64::from(i), 0.2))
                    .normalize();
                let [a, b] =
                    [&sphere as &dyn Shape, &disk].map(|s| s.projected_solid_angle(DVec3::ZERO, normal).unwrap());
                assert!((a - b).abs() <= 2e-12 * a.max(1.0 / (distance * distance)), "{distance} {i}: {a} {b}");
            }
        }
    }

    #[test]
    fn rays_through_far_and_near_spheres() {
        let sphere = Sphere::new(DVec3::new(0.0, 0.0, 5.0), 2.0).unwrap();
        let cross = |origin: DVec3, direction: DVec3, near, far| {
            sphere.cross(&Ray { origin, direction }, near, far).map(|c| c.t)
        };
        assert_eq!(cross(DVec3::ZERO, DVec3::Z, 0.0, 10.0), Some(3.0));
        assert_eq!(cross(DVec3::ZERO, DVec3::Z, 3.0, 10.0), Some(7.0));
        assert_eq!(cross(DVec3::ZERO, DVec3::Z, 3.0, 7.0), None);
        assert_eq!(cross(DVec3::ZERO, DVec3::NEG_Z, 0.0, 10.0), None);
        assert_eq!(cross(DVec3::new(0.0, 0.0, 5.0), DVec3::X, 0.0, 10.0), Some(2.0));
        // A sphere of a millimetre from a thousand kilometres: t to the last digits, where textbook roots lose them all.
        let far = Sphere::new(DVec3::new(0.0, 1e6, 0.0), 1e-3).unwrap();
        let t = far.cross(&Ray { origin: DVec3::ZERO, direction: DVec3::Y }, 0.0, f64::INFINITY).unwrap().t;
        assert!((t - (1e6 - 1e-3)).abs() < 1e-9, "{t}");
    }

    #[test]
    fn texture_follows_the_turn() {
        let turned = Sphere::new(DVec3::ZERO, 1.0).unwrap().turned(DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2));
        let ray = Ray { origin: DVec3::X * 3.0, direction: DVec3::NEG_X };
        let pole = turned.surface(&ray, &turned.cross(&ray, 0.0, 9.0).unwrap());
        assert!(pole.uv.y < 1e-15 && (pole.tangent.length() - 1.0).abs() < 1e-15, "{pole:?}");
        // Who has nothing to do with the texture sees the same but for its coordinates.
        let ray = Ray { origin: DVec3::new(3.0, 1.0, 0.5), direction: DVec3::new(-3.0, -0.8, -0.1).normalize() };
        let crossing = turned.cross(&ray, 0.0, 9.0).unwrap();
        let (whole, plain) = (turned.surface(&ray, &crossing), turned.plain_surface(&ray, &crossing));
        assert_ne!(whole.uv, DVec2::ZERO);
        assert_eq!(SurfacePoint { uv: DVec2::ZERO, ..whole }, plain);
        assert!(Sphere::new(DVec3::ZERO, 0.0).is_err() && Sphere::new(DVec3::NAN, 1.0).is_err());
    }
}

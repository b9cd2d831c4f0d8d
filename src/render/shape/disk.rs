//! Disk, or annulus where it has an inner radius; its outside is where its normal points.
//!
//! `uv` are (φ/2π, (r − r_inner)/(R − r_inner)), φ from the first tangent of the normal
//! ([`tangents`]); the tangent runs around, towards greater φ. Directions are drawn to points
//! uniform over the area.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::chart::Chart;
use super::error::{ShapeError, direction, finite, positive};
use super::facet::Facet;
use super::outline::{GAUSS5, SMALL, edge_angle};
use super::{Bounds, Shape};
use crate::geometry::direction::{phi, tangents};
use crate::math::sampling;
use crate::render::ray::{Crossing, Ray, SurfacePoint};

/// A disk or annulus in world coordinates.
#[derive(Debug, Clone)]
pub struct Disk {
    /// The anchor is the centre.
    facet: Facet,
    /// Two directions across the normal; φ counts from the first to the second.
    x: DVec3,
    y: DVec3,
    radius: f64,
    inner: f64,
}

impl Disk {
    /// The disk of `radius` (m, positive) about `centre` (m), facing along `normal` (any length).
    ///
    /// # Errors
    ///
    /// What is not finite or positive, or has no direction.
    pub fn new(centre: DVec3, normal: DVec3, radius: f64) -> Result<Self, ShapeError> {
        Self::annulus(centre, normal, radius, 0.0)
    }

    /// The same with a hole of the radius `inner` (m, 0 ≤ inner < radius).
    ///
    /// # Errors
    ///
    /// As [`Disk::new`], and an inner radius out of its range.
    pub fn annulus(centre: DVec3, normal: DVec3, radius: f64, inner: f64) -> Result<Self, ShapeError> {
        let facet = Facet { anchor: finite("centre", centre)?, normal: direction("normal", normal)? };
        let radius = positive("radius", radius)?;
        if !(0.0..radius).contains(&inner) {
            return Err(ShapeError::InnerRadius { inner, outer: radius });
        }
        let (x, y) = tangents(facet.normal);
        Ok(Self { facet, x, y, radius, inner })
    }

    fn point(&self, near: DVec3) -> SurfacePoint {
        let (position, error) = self.facet.settle(near);
        let from = position - self.facet.anchor;
        let local = DVec2::new(from.dot(self.x), from.dot(self.y));
        let length = local.length();
        let (cos, sin) = if length > 0.0 { (local.x / length, local.y / length) } else { (1.0, 0.0) };
        SurfacePoint {
            position,
            error,
            normal: self.facet.normal,
            shading: self.facet.normal,
            tangent: cos * self.y - sin * self.x,
            uv: DVec2::new(phi(local.extend(0.0)) / TAU, (length - self.inner) / (self.radius - self.inner)),
        }
    }
}

impl Shape for Disk {
    fn bounds(&self) -> Bounds {
        let n = self.facet.normal;
        let half = self.radius * DVec3::new(n.y.hypot(n.z), n.z.hypot(n.x), n.x.hypot(n.y));
        Bounds { min: self.facet.anchor - half, max: self.facet.anchor + half }
    }

    fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        let t = self.facet.cross(ray, near, far)?;
        let p = ray.origin - self.facet.anchor + t * ray.direction;
        let square = p.length_squared();
        let inside = square <= self.radius * self.radius && square >= self.inner * self.inner;
        inside.then_some(Crossing { t, uv: DVec2::ZERO, face: 0 })
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.point(ray.at(crossing.t))
    }

    fn charts(&self) -> Vec<(u32, Chart)> {
        let (centre, radii) = (self.facet.anchor, [self.inner, self.radius]);
        vec![(0, Chart::Ring { centre, axes: [self.x, self.y], radii })]
    }

    fn area(&self) -> f64 {
        PI * (self.radius - self.inner) * (self.radius + self.inner)
    }

    fn facing(&self) -> Option<DVec3> {
        Some(self.facet.normal)
    }

    fn sample_area(&self, [_, u, v]: [f64; 3]) -> SurfacePoint {
        let p = if self.inner == 0.0 {
            self.radius * sampling::disk([u, v])
        } else {
            let (outer, inner) = (self.radius * self.radius, self.inner * self.inner);
            let (sin, cos) = (TAU * v).sin_cos();
            (inner + u * (outer - inner)).sqrt() * DVec2::new(cos, sin)
        };
        self.point(self.facet.anchor + p.x * self.x + p.y * self.y)
    }

    /// The contour integral ½ n·∮ r × dr/r² (Lambert 1760), of an annulus that of its outer less that of its inner rim: a narrow ring
    /// loses the digits that both have in common.
    fn projected_solid_angle(&self, from: DVec3, normal: DVec3) -> Option<f64> {
        let to = self.facet.anchor - from;
        let local = |v: DVec3| DVec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.facet.normal));
        let (centre, normal) = (local(to), local(normal));
        let hole = if self.inner > 0.0 { projected(centre, self.inner, normal) } else { 0.0 };
        Some((projected(centre, self.radius, normal) - hole).max(0.0))
    }
}

/// ∫ cosθ⁺ dω of the disk about `centre` across z, seen from the origin.
///
/// Wholly above the horizon, with h and d the centre's distances along and across the axis:
///
/// ```text
/// Ω⊥ = 2πR²h/S · n·(ẑ h/(S + h² + d² − R²) + x̂ d/(S + h² + d² + R²)),   S² = (h² + (d − R)²)(h² + (d + R)²)
/// ```
///
/// where the ẑ part is (π/2)(1 − (h² + d² − R²)/S) and the x̂ part (πh/2d)((h² + d² + R²)/S − 1) (J. R. Howell, *A Catalog of Radiation
/// Heat Transfer Configuration Factors*, B-12 and B-13 of elements parallel and perpendicular to the disk) without their cancellation.
/// A disk cut by the horizon is [`segment`].
fn projected(centre: DVec3, radius: f64, normal: DVec3) -> f64 {
    let height = centre.z.abs();
    if height == 0.0 {
        return 0.0;
    }
    let (middle, swing) = (normal.dot(centre), radius * normal.x.hypot(normal.y));
    if middle <= -swing {
        return 0.0;
    }
    if middle < swing {
        return segment(centre, radius, normal, (-middle / swing).acos());
    }
    let d = centre.x.hypot(centre.y);
    let s = height.hypot(d - radius) * height.hypot(d + radius);
    let (inner, outer) = (height * height + (d - radius) * (d + radius), height * height + d * d + radius * radius);
    let along =
        if inner > 0.0 { 2.0 * radius * radius * height * (height / s) / (s + inner) } else { 0.5 * (1.0 - inner / s) };
    let across = 2.0 * radius * radius * (height / s) / (s + outer);
    let vector = DVec3::new(across * centre.x, across * centre.y, along * centre.z.signum());
    PI * normal.dot(vector)
}

/// The part of the disk above the horizon: the arc of the half-angle `half` about the direction in which the normal leans, and its chord.
///
/// With r² = Y + 2Rd cos τ on the rim, τ from the direction of the centre, all integrals along the arc are elementary:
///
/// ```text
/// r × dr = R (−h cos τ, −h sin τ, d cos τ + R) dτ
/// ∫ dτ/r² = (2/S) atan(√((Y − 2Rd)/(Y + 2Rd)) tan(τ/2)),   ∫ sin τ dτ/r² = −ln(r²)/(2Rd),   ∫ cos τ dτ/r² = (τ − Y ∫ dτ/r²)/(2Rd)
/// ```
///
/// Near the axis, where Rd/Y leaves them no digits, they are integrated by a rule of degree nine in sixteen pieces; a small disk (of
/// [`SMALL`] size) over its area, strip by strip along the chord: both to rounding.
fn segment(centre: DVec3, radius: f64, normal: DVec3, half: f64) -> f64 {
    let lean = normal.y.atan2(normal.x);
    let on_rim = |t: f64| centre + radius * DVec3::new(t.cos(), t.sin(), 0.0);
    if 2.0 * radius < SMALL * centre.length() {
        let (x, y) = (DVec3::new(lean.cos(), lean.sin(), 0.0), DVec3::new(-lean.sin(), lean.cos(), 0.0));
        let integral = pieces(0.0, half, 8, |t| {
            let (sin, cos) = t.sin_cos();
            let mut strip = 0.0;
            for (s, weight) in GAUSS5 {
                let p = centre + radius * (cos * x + (2.0 * s - 1.0) * sin * y);
                let square = p.length_squared();
                strip += weight * normal.dot(p) / square / square;
            }
            2.0 * sin * sin * strip
        });
        return radius * radius * centre.z.abs() * integral;
    }
    let (start, end) = (lean - half, lean + half);
    let (d, h) = (centre.x.hypot(centre.y), centre.z);
    let azimuth = centre.y.atan2(centre.x);
    // τ within ±2π, where the arctangent below is continuous.
    let shift = if lean - azimuth > PI {
        TAU
    } else if lean - azimuth < -PI {
        -TAU
    } else {
        0.0
    };
    let (from, to) = (start - azimuth - shift, end - azimuth - shift);
    let (least, most) = (h * h + (d - radius).powi(2), h * h + (d + radius).powi(2));
    let doubled = 2.0 * radius * d;
    let square = |tau: f64| least + 2.0 * doubled * (0.5 * tau).cos().powi(2);
    let [one, cos, sin] = if doubled < 0.02 * most {
        let of = |f: &dyn Fn(f64) -> f64| pieces(from, to, 16, |tau| f(tau) / square(tau));
        [of(&|_| 1.0), of(&f64::cos), of(&f64::sin)]
    } else {
        let ratio = (least / most).sqrt();
        let angle = |tau: f64| (ratio * (0.5 * tau).sin()).atan2((0.5 * tau).cos());
        let one = 2.0 * (angle(to) - angle(from)) / (least * most).sqrt();
        let y = h * h + d * d + radius * radius;
        [one, (to - from - y * one) / doubled, (square(from) / square(to)).ln() / doubled]
    };
    let (sin_azimuth, cos_azimuth) = azimuth.sin_cos();
    let arc = radius
        * DVec3::new(
            -h * (cos * cos_azimuth - sin * sin_azimuth),
            -h * (cos * sin_azimuth + sin * cos_azimuth),
            d * cos + radius * one,
        );
    (0.5 * normal.dot(arc + edge_angle(on_rim(end), on_rim(start)))).abs()
}

/// ∫ f over an interval in equal pieces, five Gauss points each.
fn pieces(from: f64, to: f64, count: u32, f: impl Fn(f64) -> f64) -> f64 {
    let width = (to - from) / f64::from(count);
    let piece = |i: u32| GAUSS5.map(|(s, weight)| weight * f(from + (f64::from(i) + s) * width)).iter().sum::<f64>();
    width * (0..count).map(piece).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::shape::polygon::Polygon;

    /// ½ |∮ n·(r × dr)/r²| along arc and chord by tanh-sinh quadrature at 50 digits (mpmath).
    #[test]
    fn disks_cut_by_the_horizon() {
        type Case = ([f64; 3], [f64; 3], f64, [f64; 3], f64);
        let cases: [Case; 11] = [
            ([1.0, 0.5, 2.0], [0.2, 0.3, 1.0], 0.8, [0.1, -0.4, 1.0], 0.257_469_014_768_419_3),
            ([1.0, 0.5, 0.3], [1.0, 0.2, 0.1], 0.8, [0.0, 0.0, 1.0], 0.264_279_124_594_295_14),
            ([0.1, 0.05, 0.4], [0.0, 0.0, 1.0], 1.5, [1.0, 0.2, -0.1], 0.944_050_950_825_045_4),
            ([2.0, 1.0, 0.001], [1.0, 1.0, 0.5], 0.01, [0.0, 0.0, 1.0], 6.390_456_940_636_765e-8),
            ([2.0, 1.0, -0.004], [1.0, 1.0, 0.5], 0.01, [0.0, 0.0, 1.0], 1.343_514_888_685_707_8e-8),
            ([0.0, 0.0, 2.0], [0.0, 0.0, 1.0], 1.0, [1.0, 0.0, -0.2], 0.017_362_844_440_139_23),
            ([1e-3, 0.0, 2.0], [0.0, 0.0, 1.0], 1.0, [1.0, 0.0, -0.2], 0.017_425_076_475_393_752),
            ([1e8, 1e7, 0.0], [1.0, 0.1, 0.3], 3e7, [0.0, 0.2, 1.0], 0.020_721_323_290_958_607),
            ([1.0, 0.5, 2.0], [0.2, 0.3, 1.0], 1e-8, [0.1, -0.4, 1.0], 4.426_093_423_086_484e-17),
            ([0.5, 0.1, 1e-7], [0.0, 0.0, 1.0], 0.6, [0.0, 0.0, 1.0], 3.141_592_653_588_662_3),
            ([0.9, 0.0, -0.01], [0.1, 0.2, 1.0], 0.6, [1.0, 0.0, 0.5], 0.196_285_745_074_499_78),
        ];
        for (centre, axis, radius, normal, expected) in cases {
            let disk = Disk::new(centre.into(), axis.into(), radius).unwrap();
            let got = disk.projected_solid_angle(DVec3::ZERO, DVec3::from(normal).normalize()).unwrap();
            assert!((got / expected - 1.0).abs() < 1e-12, "{centre:?} {radius}: {got} {expected}");
        }
    }

    /// Polygons of equal area approach the disk with the square of their number of corners; two of them give its limit.
    #[test]
    fn a_disk_is_the_limit_of_polygons() {
        let disk = Disk::new(DVec3::new(0.4, 0.1, 0.5), DVec3::new(0.3, 0.2, 1.0), 0.7).unwrap();
        let polygon = |count: u32| {
            let step = TAU / f64::from(count);
            let radius = disk.radius * (step / step.sin()).sqrt();
            let corner = |i: u32| {
                let (sin, cos) = (f64::from(i) * step).sin_cos();
                disk.facet.anchor + radius * (cos * disk.x + sin * disk.y)
            };
            Polygon::new((0..count).map(corner).collect()).unwrap()
        };
        let (coarse, fine) = (polygon(128), polygon(256));
        for normal in [DVec3::Z, DVec3::X, DVec3::NEG_Y, DVec3::new(-0.6, 0.0, -0.8)] {
            let [a, b, c] =
                [&disk as &dyn Shape, &coarse, &fine].map(|s| s.projected_solid_angle(DVec3::ZERO, normal).unwrap());
            // Corners that pass the horizon leave an error of the order of the polygon's own distance to the rim.
            assert!((a - (4.0 * c - b) / 3.0).abs() <= 1e-5 * a, "{normal}: {a} {b} {c}");
        }
    }

    #[test]
    fn holes_and_rims() {
        let ring = Disk::annulus(DVec3::ZERO, DVec3::Z, 2.0, 1.0).unwrap();
        let cross = |x: f64| ring.cross(&Ray { origin: DVec3::new(x, 0.0, 1.0), direction: DVec3::NEG_Z }, 0.0, 9.0);
        assert!(cross(0.9).is_none() && cross(2.1).is_none());
        let ray = Ray { origin: DVec3::new(0.0, 1.5, 1.0), direction: DVec3::NEG_Z };
        let point = ring.surface(&ray, &ring.cross(&ray, 0.0, 9.0).unwrap());
        assert!((point.uv - DVec2::new(0.25, 0.5)).length() < 1e-15, "{point:?}");
        assert!(point.tangent.dot(point.position).abs() < 1e-15);
        assert!((ring.area() - 3.0 * PI).abs() < 1e-14);
        for (inner, outer) in [(1.0, 1.0), (-0.1, 1.0), (f64::NAN, 1.0)] {
            assert!(Disk::annulus(DVec3::ZERO, DVec3::Z, outer, inner).is_err());
        }
        assert!(Disk::new(DVec3::ZERO, DVec3::ZERO, 1.0).is_err());
    }
}

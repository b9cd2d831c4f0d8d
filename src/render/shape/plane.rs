//! Plane without bounds; its outside is where its normal points.
//!
//! `uv` are metres from the given point along the tangent and across it (both as
//! [`tangents`] gives them). Its area is infinite: no point can be drawn from it, but
//! directions towards it can, with density cosθ/π about the perpendicular. Everything on its side of the horizon meets it:
//!
//! ```text
//! Ω⊥ = π (1 + n·m)/2,   m from the eye straight to the plane
//! ```

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::error::{ShapeError, direction, finite};
use super::facet::Facet;
use super::{Bounds, Shape};
use crate::geometry::direction::tangents;
use crate::math::sampling::{cosine_hemisphere, cosine_hemisphere_pdf};
use crate::render::ray::{Crossing, Ray, SurfacePoint, Towards};

/// A plane in world coordinates.
#[derive(Debug, Clone)]
pub struct Plane {
    facet: Facet,
    tangents: (DVec3, DVec3),
}

impl Plane {
    /// The plane through `point` (m) with `normal` (any length).
    ///
    /// # Errors
    ///
    /// What is not finite or has no direction.
    pub fn new(point: DVec3, normal: DVec3) -> Result<Self, ShapeError> {
        let facet = Facet { anchor: finite("point", point)?, normal: direction("normal", normal)? };
        Ok(Self { facet, tangents: tangents(facet.normal) })
    }

    fn point(&self, near: DVec3) -> SurfacePoint {
        let (position, error) = self.facet.settle(near);
        let from = position - self.facet.anchor;
        SurfacePoint {
            position,
            error,
            normal: self.facet.normal,
            shading: self.facet.normal,
            tangent: self.tangents.0,
            uv: DVec2::new(from.dot(self.tangents.0), from.dot(self.tangents.1)),
        }
    }

    /// The normal on the side away from `from`; `None` for a point of the plane.
    fn towards(&self, from: DVec3) -> Option<DVec3> {
        let height = self.facet.height(from);
        (height != 0.0).then(|| self.facet.normal * -height.signum())
    }
}

impl Shape for Plane {
    fn bounds(&self) -> Bounds {
        Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY }
    }

    fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        self.facet.cross(ray, near, far).map(|t| Crossing { t, uv: DVec2::ZERO, face: 0 })
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.point(ray.at(crossing.t))
    }

    fn area(&self) -> f64 {
        f64::INFINITY
    }

    fn facing(&self) -> Option<DVec3> {
        Some(self.facet.normal)
    }

    /// The point that the plane was made of: there is no uniform density over an infinite area.
    fn sample_area(&self, _: [f64; 3]) -> SurfacePoint {
        self.point(self.facet.anchor)
    }

    fn sample_towards(&self, from: DVec3, u: [f64; 3]) -> Option<Towards> {
        let axis = self.towards(from)?;
        let (first, second) = tangents(axis);
        let local = cosine_hemisphere([u[1], u[2]]);
        let direction = (local.x * first + local.y * second + local.z * axis).normalize();
        let distance = self.facet.distance(from, direction);
        let pdf = cosine_hemisphere_pdf(axis.dot(direction));
        (distance.is_finite() && distance > 0.0).then_some(Towards { direction, distance, pdf, delta: false })
    }

    fn pdf_towards(&self, from: DVec3, point: &SurfacePoint) -> f64 {
        let to = point.position - from;
        self.towards(from).map_or(0.0, |axis| cosine_hemisphere_pdf(axis.dot(to) / to.length()))
    }

    fn projected_solid_angle(&self, from: DVec3, normal: DVec3) -> Option<f64> {
        Some(self.towards(from).map_or(0.0, |axis| 0.5 * PI * (1.0 + axis.dot(normal)).max(0.0)))
    }
}

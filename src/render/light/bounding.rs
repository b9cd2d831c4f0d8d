//! The sphere around a scene, which lights at infinity shine through.
//!
//! A light at infinity has no flux of its own, only radiance L(ω). What it sends through the scene's bounding sphere of radius R is
//!
//! ```text
//! Φ = π R² ∫ L dω
//! ```
//!
//! since the sphere shows every direction the same disk. Rays start in the plane that touches the sphere on the light's side, uniform
//! over that disk.

use std::f64::consts::PI;

use glam::DVec3;

use super::{Error, placed, within};
use crate::geometry::direction::tangents;
use crate::math::sampling::disk;
use crate::render::ray::Ray;

/// A sphere that holds the whole scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundingSphere {
    centre: DVec3,
    radius: f64,
}

impl BoundingSphere {
    /// Of a centre and a radius above 0, m.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn new(centre: DVec3, radius: f64) -> Result<Self, Error> {
        let radius = within("a radius of the scene (m)", radius, radius > 0.0, "a length above 0")?;
        Ok(Self { centre: placed("a coordinate of the scene's centre (m)", centre)?, radius })
    }

    /// The area that it shows to a direction, πR², m².
    #[must_use]
    pub fn cross_section(&self) -> f64 {
        PI * self.radius * self.radius
    }

    /// A ray into the sphere from a light in the direction `towards_light` (unit), from two uniform numbers; density 1/(πR²).
    #[must_use]
    pub fn ray_from(&self, towards_light: DVec3, u: [f64; 2]) -> Ray {
        let (x, y) = tangents(towards_light);
        let p = disk(u);
        let origin = self.centre + self.radius * (towards_light + p.x * x + p.y * y);
        Ray { origin, direction: -towards_light }
    }

    /// The density, per area across the ray, 1/m², with which [`BoundingSphere::ray_from`] draws the ray that passes `point`: 0 where
    /// none does.
    #[must_use]
    pub fn density_at(&self, point: DVec3, towards_light: DVec3) -> f64 {
        let from_centre = point - self.centre;
        let along = from_centre.dot(towards_light);
        let across = (from_centre - along * towards_light).length_squared();
        if across <= self.radius * self.radius && along <= self.radius { 1.0 / self.cross_section() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_start_on_the_tangent_plane_and_cross_the_sphere() {
        let sphere = BoundingSphere::new(DVec3::new(1.0, -2.0, 3.0), 2.5).expect("a sphere");
        let towards = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        for u in [[0.0, 0.0], [0.5, 0.5], [0.9, 0.2]] {
            let ray = sphere.ray_from(towards, u);
            assert!(((ray.origin - sphere.centre).dot(towards) - 2.5).abs() < 1e-14);
            assert!(ray.at(2.5).distance(sphere.centre) <= 2.5 * (1.0 + 1e-15));
        }
        assert!(BoundingSphere::new(DVec3::ZERO, 0.0).is_err() && BoundingSphere::new(DVec3::NAN, 1.0).is_err());
    }
}

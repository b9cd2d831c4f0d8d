//! The plane of a flat shape: where rays cross it, and points brought back to it with a bound of what remains.

use glam::DVec3;

use super::rounding::gamma;
use crate::render::ray::Ray;

/// A plane through a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facet {
    /// A point of it, best near the shape, m.
    pub anchor: DVec3,
    /// Unit normal.
    pub normal: DVec3,
}

impl Facet {
    /// Signed height of a point over the plane, m.
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.anchor)
    }

    /// Distance to the plane along a ray with `near < t < far`, m. Its sign is right for every origin further from the plane than
    /// [`Facet::settle`]'s error, even where the ray is all but parallel: the numerator decides it.
    pub fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<f64> {
        let t = self.normal.dot(self.anchor - ray.origin) / self.normal.dot(ray.direction);
        (near < t && t < far).then_some(t)
    }

    /// Distance to the plane along `direction` from `from`, m, whatever its sign.
    pub fn distance(&self, from: DVec3, direction: DVec3) -> f64 {
        self.normal.dot(self.anchor - from) / self.normal.dot(direction)
    }

    /// A point near the plane moved onto it, with a bound of its distance to the plane, m, that also covers the rounding of
    /// [`Facet::height`] there.
    ///
    /// Four roundings in the height on both occasions, and one of each coordinate of the result; the rest is reserve.
    pub fn settle(&self, point: DVec3) -> (DVec3, f64) {
        let position = point - self.height(point) * self.normal;
        let size = self.normal.abs();
        let error = gamma(10.0) * size.dot((position - self.anchor).abs()) + gamma(3.0) * size.dot(position.abs());
        (position, error)
    }
}

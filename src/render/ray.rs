//! Rays, where they meet surfaces, and the points of surfaces.

use glam::{DVec2, DVec3};

use crate::geometry::direction;

/// A half-line: the points `origin + t · direction`, t > 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts, m.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
}

impl Ray {
    /// The point at distance `t`, m.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

/// Where a ray meets a shape: enough to find the [`SurfacePoint`] without searching again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Distance along the ray, m.
    pub t: f64,
    /// Coordinates on the shape or face, as the shape defines them (barycentric on a triangle).
    pub uv: DVec2,
    /// The face of a polyhedron or the triangle of a mesh; 0 for a shape of one piece.
    pub face: u32,
}

/// A point of a surface and the surface's frame there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// The point, m.
    pub position: DVec3,
    /// A bound on the distance between `position` and the surface that it stands for, m, from the rounding of the computation.
    pub error: f64,
    /// Geometric unit normal, to the shape's outside.
    pub normal: DVec3,
    /// Shading normal, unit: interpolated on meshes that have vertex normals, else `normal`.
    pub shading: DVec3,
    /// Unit vector across `shading`: the direction that an anisotropic material is turned by (+x of the local frame).
    pub tangent: DVec3,
    /// Texture coordinates.
    pub uv: DVec2,
}

impl SurfacePoint {
    /// A point that a meter stands at, its axis along the unit vector `axis`; `error` as in [`SurfacePoint::error`].
    #[must_use]
    pub fn meter(position: DVec3, axis: DVec3, error: f64) -> Self {
        let (tangent, _) = direction::tangents(axis);
        Self { position, error, normal: axis, shading: axis, tangent, uv: DVec2::ZERO }
    }

    /// The origin of a ray that leaves the surface in `direction`: moved off the surface, along the geometric normal, by more than
    /// the rounding of the point itself, so that the ray starts on the side that it leaves to.
    ///
    /// Reference: M. Pharr, W. Jakob, G. Humphreys, *Physically Based Rendering*, 4th ed. (2023), 6.8.6.
    #[must_use]
    pub fn origin_towards(&self, direction: DVec3) -> DVec3 {
        let offset = self.normal * self.error;
        let moved = if direction.dot(self.normal) < 0.0 { self.position - offset } else { self.position + offset };
        // The addition rounds as well: a step outwards in every coordinate that was moved.
        let step = |moved: f64, from: f64| match moved.partial_cmp(&from) {
            Some(std::cmp::Ordering::Greater) => moved.next_up(),
            Some(std::cmp::Ordering::Less) => moved.next_down(),
            _ => moved,
        };
        DVec3::new(step(moved.x, self.position.x), step(moved.y, self.position.y), step(moved.z, self.position.z))
    }
}

/// A direction drawn towards a shape or a light, as seen from a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Towards {
    /// Unit vector from the point.
    pub direction: DVec3,
    /// Distance to what was aimed at, m; infinite for what is infinitely far.
    pub distance: f64,
    /// Density of the direction, 1/sr; for a Dirac light the probability of the choice, 1 where there is none.
    pub pdf: f64,
    /// What was aimed at has no extent as seen from the point (a point light, a distant light): no other strategy can find it.
    pub delta: bool,
}

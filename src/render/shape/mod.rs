//! Shapes: where rays cross them, their area, and points and directions drawn on them.
//!
//! | file | what it is |
//! |---|---|
//! | [`sphere`], [`cylinder`] | round shapes; a tube, open or capped |
//! | [`plane`] | without bounds |
//! | [`disk`] | disk and annulus |
//! | [`rectangle`], [`triangle`], [`polygon`] | flat shapes with straight edges; rectangle also means parallelogram |
//! | [`polyhedron`] | solid with flat faces |
//! | [`chart`] | surfaces cut into cells |
//! | [`shear`], [`rounding`] | a ray's own coordinates, in which tests are watertight; bounds of rounding errors |
//! | [`error`] | what is wrong with the measures of a shape |
//!
//! Constructors take world coordinates and prepare frames, normals and areas. The rounding of a crossing is bounded in
//! [`SurfacePoint::error`] so that a ray from [`SurfacePoint::origin_towards`] never meets the flat or outwardly round surface
//! that it leaves. Projected solid angles in closed form are accurate relative to themselves, for sources of any size.

pub mod chart;
pub mod cylinder;
pub mod disk;
pub mod error;
mod facet;
mod outline;
mod patches;
pub mod plane;
pub mod polygon;
pub mod polyhedron;
pub mod rectangle;
pub mod rounding;
pub mod shear;
pub mod sphere;
mod spherical;
#[cfg(test)]
mod tests;
pub mod triangle;

use glam::DVec3;

use super::ray::{Crossing, Ray, SurfacePoint, Towards};
use chart::Chart;

/// An axis-aligned box, m. Empty where `min > max` in a coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub min: DVec3,
    /// Greatest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// Holds no point.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The smallest box that holds the points.
    #[must_use]
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.union(Self { min: p, max: p }))
    }

    /// Whether a point of it lies before the plane through `anchor` that faces along `normal` (unit), by more than rounding.
    #[must_use]
    pub fn reach_before(&self, anchor: DVec3, normal: DVec3) -> bool {
        let furthest = DVec3::select(normal.cmpgt(DVec3::ZERO), self.max, self.min);
        let rounding = 8.0 * f64::EPSILON * anchor.abs().max(furthest.abs()).max_element();
        (furthest - anchor).dot(normal) > rounding
    }

    /// Whether all coordinates are finite and it holds a point.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite() && self.min.cmple(self.max).all()
    }
}

/// A surface in world coordinates. Its outside is where its normals point.
///
/// An implementation computes in `f64`, holds at every scale from 1e-8 m to 1e8 m (no absolute epsilon anywhere), and never
/// returns a crossing outside of the open interval it was asked for.
pub trait Shape: std::fmt::Debug + Send + Sync {
    /// The box that holds it; infinite for an unbounded plane.
    fn bounds(&self) -> Bounds;

    /// The first crossing with `near < t < far`.
    fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing>;

    /// Whether there is any crossing with `near < t < far`.
    fn is_crossed(&self, ray: &Ray, near: f64, far: f64) -> bool {
        self.cross(ray, near, far).is_some()
    }

    /// The surface at a crossing of this shape.
    fn surface(&self, ray: &Ray, crossing: &Crossing) -> SurfacePoint;

    /// The same for those who have nothing to do with texture coordinates: these are 0 where they take time.
    fn plain_surface(&self, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.surface(ray, crossing)
    }

    /// Area, m²; infinite for an unbounded plane.
    fn area(&self) -> f64;

    /// The unit normal of a flat shape, which is the same everywhere.
    fn facing(&self) -> Option<DVec3> {
        None
    }

    /// A point, uniform over the area, from three uniform numbers (`u[0]` chooses the face).
    fn sample_area(&self, u: [f64; 3]) -> SurfacePoint;

    /// A direction from `from` towards the shape, with its density per solid angle; `None` where none can be given. The surface may be
    /// seen from either side, and may hide itself.
    ///
    /// The default draws a point of the area: pdf = r² / (A |cosθ|).
    fn sample_towards(&self, from: DVec3, u: [f64; 3]) -> Option<Towards> {
        towards_point(self.area(), from, &self.sample_area(u))
    }

    /// The density per solid angle with which [`Shape::sample_towards`] draws, from `from`, the direction in which `point` (a crossing
    /// of this shape) lies.
    fn pdf_towards(&self, from: DVec3, point: &SurfacePoint) -> f64 {
        pdf_of_point(self.area(), from, point)
    }

    /// ∫ cosθ⁺ dω over the directions from `from` in which the shape is seen, cosθ to `normal` and clipped at the horizon (projected
    /// solid angle, sr), in closed form, for a shape that does not hide itself; `None` where no closed form is implemented.
    fn projected_solid_angle(&self, from: DVec3, normal: DVec3) -> Option<f64> {
        let _ = (from, normal);
        None
    }

    /// The pieces that it can be cut up in, each with the number that [`Crossing::face`] gives it; in ascending order, and
    /// none for a surface without bounds.
    fn charts(&self) -> Vec<(u32, Chart)> {
        Vec::new()
    }
}

/// The direction towards a point drawn uniformly from an area: pdf = r² / (A |cosθ|).
fn towards_point(area: f64, from: DVec3, point: &SurfacePoint) -> Option<Towards> {
    let to = point.position - from;
    let distance = to.length();
    let direction = to / distance;
    let pdf = pdf_of_point(area, from, point);
    (pdf > 0.0 && pdf.is_finite()).then_some(Towards { direction, distance, pdf, delta: false })
}

/// The density of that direction, 1/sr; 0 for a point seen edge-on.
fn pdf_of_point(area: f64, from: DVec3, point: &SurfacePoint) -> f64 {
    let to = point.position - from;
    let distance = to.length();
    let cos = (point.normal.dot(to) / distance).abs();
    if cos > 0.0 { distance * (distance / (area * cos)) } else { 0.0 }
}

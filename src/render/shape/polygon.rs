//! Polygon: flat, any number of corners, convex or not, without holes; its outside is where the corners stand anticlockwise.
//!
//! | | |
//! |---|---|
//! | crossing | even-odd, watertight against other flat shapes with the same corners ([`shear`](super::shear)) |
//! | uv | metres from the first corner, along the first edge and across it |
//! | tangent | along the first edge |
//! | directions | uniform over the solid angle, by triangles (ears cut off) |
//! | projected solid angle | Lambert's sum over the edges, cut at the horizon |

use glam::{DVec2, DVec3};

use super::chart::Chart;
use super::error::{ShapeError, finite};
use super::facet::Facet;
use super::patches::{Patch, Patches};
use super::shear::{Shear, passes_through};
use super::{Bounds, Shape, outline, pdf_of_point, spherical, towards_point};
use crate::render::ray::{Crossing, Ray, SurfacePoint, Towards};

/// A flat polygon in world coordinates.
#[derive(Debug, Clone)]
pub struct Polygon {
    corners: Vec<DVec3>,
    face: Face,
    patches: Patches,
}

/// A flat face: its plane, and how texture coordinates lie on it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    pub facet: Facet,
    tangent: DVec3,
}

impl Face {
    /// Of an outline that has been found flat and simple, with its triangles.
    pub fn new(corners: &[DVec3], index: u32) -> Result<(Self, Vec<Patch>), ShapeError> {
        if corners.len() < 3 {
            return Err(ShapeError::TooFew { what: "corners", count: corners.len(), least: 3 });
        }
        for (i, &corner) in corners.iter().enumerate() {
            finite("corner", corner)?;
            if corner == corners[(i + corners.len() - 1) % corners.len()] {
                return Err(ShapeError::CornerTwice { corner: i });
            }
        }
        let facet = outline::plane("polygon", corners)?;
        outline::check_flat(corners, &facet)?;
        outline::check_simple(corners, &facet)?;
        let along = corners[1] - corners[0];
        let tangent = (along - along.dot(facet.normal) * facet.normal).normalize();
        let triangles = outline::triangulate(corners, &facet);
        if triangles.is_empty() {
            return Err(ShapeError::NoArea { what: "polygon" });
        }
        let patch = |t: [usize; 3]| Patch { corners: t.map(|i| corners[i]), face: index };
        Ok((Self { facet, tangent }, triangles.into_iter().map(patch).collect()))
    }

    /// The point of the face at or below a point.
    pub fn point(&self, near: DVec3) -> SurfacePoint {
        let (position, error) = self.facet.settle(near);
        let normal = self.facet.normal;
        let from = position - self.facet.anchor;
        let uv = DVec2::new(from.dot(self.tangent), from.dot(normal.cross(self.tangent)));
        SurfacePoint { position, error, normal, shading: normal, tangent: self.tangent, uv }
    }
}

impl Polygon {
    /// The polygon with these corners (m, at least three, in one plane within 1e-6 of its extent).
    ///
    /// # Errors
    ///
    /// What is not finite, flat or simple, or spans no area.
    pub fn new(corners: Vec<DVec3>) -> Result<Self, ShapeError> {
        let (face, patches) = Face::new(&corners, 0)?;
        Ok(Self { corners, face, patches: Patches::new(patches) })
    }

    fn solid_angle(&self, from: DVec3) -> f64 {
        self.patches.solid_angle(from, |_| true)
    }
}

impl Shape for Polygon {
    fn bounds(&self) -> Bounds {
        Bounds::of(self.corners.iter().copied())
    }

    fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        let t = self.face.facet.cross(ray, near, far)?;
        passes_through(&Shear::new(ray), self.corners.iter().copied()).then_some(Crossing {
            t,
            uv: DVec2::ZERO,
            face: 0,
        })
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.face.point(ray.at(crossing.t))
    }

    fn charts(&self) -> Vec<(u32, Chart)> {
        self.patches.charts()
    }

    fn area(&self) -> f64 {
        self.patches.area()
    }

    fn sample_area(&self, u: [f64; 3]) -> SurfacePoint {
        self.face.point(self.patches.sample_area(u).0)
    }

    fn sample_towards(&self, from: DVec3, u: [f64; 3]) -> Option<Towards> {
        let omega = self.solid_angle(from);
        if !spherical::RANGE_SR.contains(&omega) {
            return towards_point(self.area(), from, &self.sample_area(u));
        }
        let (direction, _) = self.patches.sample(from, omega, |_| true, u)?;
        let distance = self.face.facet.distance(from, direction);
        (distance > 0.0).then_some(Towards { direction, distance, pdf: 1.0 / omega, delta: false })
    }

    fn pdf_towards(&self, from: DVec3, point: &SurfacePoint) -> f64 {
        let omega = self.solid_angle(from);
        if spherical::RANGE_SR.contains(&omega) { 1.0 / omega } else { pdf_of_point(self.area(), from, point) }
    }

    fn projected_solid_angle(&self, from: DVec3, normal: DVec3) -> Option<f64> {
        Some(outline::projected(self.corners.iter().copied(), &self.face.facet, from, normal))
    }
}

//! Meshes of triangles: their own coordinates, a tree to search them, the surface at a crossing.
//!
//! Corners are kept in `f64` (24 bytes for two triangles), normals and texture coordinates in `f32`. Ten million triangles with
//! their tree take about half a gibibyte.

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::ray::{Crossing, Ray};
use super::shape::Bounds;
use super::shape::rounding::cross;
use super::shape::shear::Shear;
use super::shape::triangle::cross_sheared;
use super::tree::Tree;

/// What a mesh is made of.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MeshData {
    /// Corners, m.
    pub positions: Vec<DVec3>,
    /// Which three corners each triangle has; anticlockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// A shading normal for each corner, of any length; empty for flat faces.
    pub normals: Vec<Vec3>,
    /// Texture coordinates for each corner, or empty.
    pub uvs: Vec<Vec2>,
}

/// What is wrong with a mesh.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// A triangle names a corner that is not there.
    #[error("triangle {triangle} names corner {corner}; expected one of 0..{corners}")]
    Corner {
        /// The triangle, from 0.
        triangle: usize,
        /// The corner it names.
        corner: u32,
        /// How many there are.
        corners: usize,
    },
    /// The number of normals or texture coordinates is not that of corners.
    #[error("{found} {what} for {corners} corners; expected as many as corners, or none")]
    Count {
        /// What there are too many or too few of.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        corners: usize,
    },
    /// More triangles than a tree can number.
    #[error("{found} triangles; expected at most {}", u32::MAX)]
    TooLarge {
        /// How many there are.
        found: usize,
    },
}

/// A mesh in its own coordinates, ready to be searched; placed in the world any number of times.
#[derive(Debug)]
pub struct Mesh {
    /// Triangles are in the order of the tree.
    data: MeshData,
    skipped: usize,
    bounds: Bounds,
    tree: Tree,
}

impl Mesh {
    /// Builds the tree. Triangles without area and those with a corner that is not finite are left out ([`Mesh::skipped`]). Triangles are
    /// renumbered.
    ///
    /// # Errors
    ///
    /// A triangle names a missing corner, or there are not as many normals or texture coordinates as corners.
    pub fn new(mut data: MeshData) -> Result<Self, MeshError> {
        let corners = data.positions.len();
        for (what, found) in [("normals", data.normals.len()), ("texture coordinates", data.uvs.len())] {
            if found != 0 && found != corners {
                return Err(MeshError::Count { what, found, corners });
            }
        }
        let given = data.triangles.len();
        if u32::try_from(given).is_err() {
            return Err(MeshError::TooLarge { found: given });
        }
        for (triangle, names) in data.triangles.iter().enumerate() {
            if let Some(&corner) = names.iter().find(|&&corner| corner as usize >= corners) {
                return Err(MeshError::Corner { triangle, corner, corners });
            }
        }
        let positions = &data.positions;
        data.triangles.retain(|names| {
            let [a, b, c] = names.map(|i| positions[i as usize]);
            let across = cross(b - a, c - a);
            across.is_finite() && across != DVec3::ZERO
        });
        let skipped = given - data.triangles.len();
        let of = |names: &[u32; 3]| Bounds::of(names.map(|corner| data.positions[corner as usize]));
        let boxes: Vec<Bounds> = data.triangles.iter().map(of).collect();
        let bounds = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union);
        let mut tree = Tree::new(&boxes);
        data.triangles = tree.renumber().into_iter().map(|i| data.triangles[i as usize]).collect();
        Ok(Self { data, skipped, bounds, tree })
    }

    /// What it is made of; triangles in the mesh's own order.
    #[must_use]
    pub fn data(&self) -> &MeshData {
        &self.data
    }

    /// How many triangles were left out for want of area or of finite corners.
    #[must_use]
    pub fn skipped(&self) -> usize {
        self.skipped
    }

    /// The box that holds it, m; empty for a mesh without triangles.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The corners of a triangle, m.
    #[must_use]
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.data.triangles[triangle as usize].map(|i| self.data.positions[i as usize])
    }

    /// The first crossing with `near < t < far` of a ray in the mesh's coordinates, whose direction need not be a unit vector: `t`
    /// counts multiples of it.
    #[must_use]
    pub fn closest(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        let shear = Shear::new(ray);
        let mut found = None;
        self.tree.closest(ray.origin, ray.direction, far, |triangle, far| {
            let [a, b, c] = self.corners(triangle as u32);
            let crossing = cross_sheared(&shear, a, b, c, near, far)?;
            found = Some(Crossing { face: triangle as u32, ..crossing });
            Some(crossing.t)
        });
        found
    }

    /// Whether there is any crossing with `near < t < far`; as [`Mesh::closest`].
    #[must_use]
    pub fn is_crossed(&self, ray: &Ray, near: f64, far: f64) -> bool {
        let shear = Shear::new(ray);
        self.tree.any(ray.origin, ray.direction, far, |triangle| {
            let [a, b, c] = self.corners(triangle as u32);
            cross_sheared(&shear, a, b, c, near, far).is_some()
        })
    }

    /// Texture coordinates at the weights `uv` of a triangle's second and third corner; those weights where the mesh has none.
    #[must_use]
    pub fn uv(&self, triangle: u32, uv: DVec2) -> DVec2 {
        if self.data.uvs.is_empty() {
            return uv;
        }
        let [a, b, c] = self.data.triangles[triangle as usize].map(|i| self.data.uvs[i as usize].as_dvec2());
        (1.0 - uv.x - uv.y) * a + uv.x * b + uv.y * c
    }

    /// The interpolated normal, of any length; `None` where the mesh has none.
    #[must_use]
    pub fn shading(&self, triangle: u32, uv: DVec2) -> Option<DVec3> {
        if self.data.normals.is_empty() {
            return None;
        }
        let [a, b, c] = self.data.triangles[triangle as usize].map(|i| self.data.normals[i as usize].as_dvec3());
        Some((1.0 - uv.x - uv.y) * a + uv.x * b + uv.y * c)
    }

    /// The direction on the face in which the first texture coordinate grows (∂p/∂u, of any length); the first edge where the mesh
    /// has none or they do not span the face.
    #[must_use]
    pub fn across(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        if self.data.uvs.is_empty() {
            return b - a;
        }
        let [p, q, r] = self.data.triangles[triangle as usize].map(|i| self.data.uvs[i as usize].as_dvec2());
        let (q, r) = (q - p, r - p);
        let determinant = q.x * r.y - q.y * r.x;
        let along = ((b - a) * r.y - (c - a) * q.y) / determinant;
        if along.is_finite() && along != DVec3::ZERO { along } else { b - a }
    }
}

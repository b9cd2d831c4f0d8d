//! Meshes of triangles: their own coordinates, a tree to search them, the surface at a crossing.
//!
//! Every triangle has its `corners` beside those of its neighbours; normals and texture coordinates are kept in `f32`. A tree takes several times its
//! final size while it is built, so large meshes are first cut into blocks that have trees of their own.

use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::corners::Corners;
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

/// Triangles of a block at most.
const BLOCK: usize = 1 << 20;

/// A mesh in its own coordinates, ready to be searched; placed in the world any number of times.
#[derive(Debug)]
pub struct Mesh {
    /// Of the triangles in the order of the tree.
    corners: Corners,
    /// Which normals and texture coordinates each triangle has; empty where there are none.
    names: Vec<[u32; 3]>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    skipped: usize,
    first_skipped: Option<usize>,
    bounds: Bounds,
    blocks: Vec<Block>,
    /// Over the blocks.
    tree: Tree,
}

/// Some of a mesh's triangles, one after the other.
#[derive(Debug)]
struct Block {
    /// The number of the first triangle.
    first: usize,
    tree: Tree,
}

impl Mesh {
    /// Builds the tree. Triangles without area and those with a corner that is not finite are left out ([`Mesh::skipped`]). Triangles are
    /// renumbered.
    ///
    /// # Errors
    ///
    /// A triangle names a missing corner, or there are not as many normals or texture coordinates as corners.
    pub fn new(data: MeshData) -> Result<Self, MeshError> {
        Self::in_blocks(data, BLOCK)
    }

    fn in_blocks(mut data: MeshData, most: usize) -> Result<Self, MeshError> {
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
        let spans_area = |names: &[u32; 3]| {
            let [a, b, c] = names.map(|i| positions[i as usize]);
            let across = cross(b - a, c - a);
            across.is_finite() && across != DVec3::ZERO
        };
        let first_skipped = data.triangles.par_iter().position_first(|names| !spans_area(names));
        if first_skipped.is_some() {
            data.triangles.retain(spans_area);
        }
        let skipped = given - data.triangles.len();
        let of = |names: &[u32; 3]| Bounds::of(names.map(|corner| positions[corner as usize]));
        let mut blocks = Vec::new();
        let mut boxes = Vec::new();
        let mut open = Vec::new();
        open.push(0..data.triangles.len());
        while let Some(range) = open.pop() {
            let triangles = &mut data.triangles[range.clone()];
            if triangles.len() > most {
                // Halved across its longest side.
                let bounds = triangles.par_iter().map(of).reduce(|| Bounds::EMPTY, Bounds::union);
                let axis = (bounds.max - bounds.min).max_position();
                let place = |t: &[u32; 3]| t.iter().map(|&corner| positions[corner as usize][axis]).sum::<f64>();
                let half = triangles.len() / 2;
                triangles.select_nth_unstable_by(half, |a, b| place(a).total_cmp(&place(b)));
                open.extend([range.start + half..range.end, range.start..range.start + half]);
            } else if !triangles.is_empty() {
                let own: Vec<Bounds> = triangles.par_iter().map(of).collect();
                let mut tree = Tree::new(&own);
                let renumbered: Vec<_> = tree.renumber().into_par_iter().map(|i| triangles[i as usize]).collect();
                triangles.copy_from_slice(&renumbered);
                blocks.push(Block { first: range.start, tree });
                boxes.push(own.into_par_iter().reduce(|| Bounds::EMPTY, Bounds::union));
            }
        }
        let corners = Corners::new(&data.positions, &data.triangles);
        let names = if data.normals.is_empty() && data.uvs.is_empty() { Vec::new() } else { data.triangles };
        let bounds = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union);
        let (normals, uvs, tree) = (data.normals, data.uvs, Tree::new(&boxes));
        Ok(Self { corners, names, normals, uvs, skipped, first_skipped, bounds, blocks, tree })
    }

    /// The number of its triangles.
    #[must_use]
    pub fn triangles(&self) -> u32 {
        self.corners.len() as u32
    }

    /// How many triangles were left out for want of area or of finite corners.
    #[must_use]
    pub fn skipped(&self) -> usize {
        self.skipped
    }

    /// The first triangle that was left out, from 0 in the order given.
    #[must_use]
    pub fn first_skipped(&self) -> Option<usize> {
        self.first_skipped
    }

    /// The box that holds it, m; empty for a mesh without triangles.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The corners of a triangle, m.
    #[must_use]
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.corners.of(triangle)
    }

    /// The first crossing with `near < t < far` of a ray in the mesh's coordinates, whose direction need not be a unit vector: `t`
    /// counts multiples of it.
    #[must_use]
    pub fn closest(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        let shear = Shear::new(ray);
        let mut found = None;
        let mut search = |block: &Block, far| {
            block.tree.closest(ray.origin, ray.direction, far, |place, far| {
                let face = (block.first + place) as u32;
                let [a, b, c] = self.corners(face);
                let crossing = cross_sheared(&shear, a, b, c, near, far)?;
                found = Some(Crossing { face, ..crossing });
                Some(crossing.t)
            })
        };
        match self.blocks.as_slice() {
            [only] => search(only, far),
            blocks => self.tree.closest(ray.origin, ray.direction, far, |i, far| Some(search(&blocks[i], far))),
        };
        found
    }

    /// Whether there is any crossing with `near < t < far`; as [`Mesh::closest`].
    #[must_use]
    pub fn is_crossed(&self, ray: &Ray, near: f64, far: f64) -> bool {
        let shear = Shear::new(ray);
        let search = |block: &Block| {
            block.tree.any(ray.origin, ray.direction, far, |place| {
                let [a, b, c] = self.corners((block.first + place) as u32);
                cross_sheared(&shear, a, b, c, near, far).is_some()
            })
        };
        match self.blocks.as_slice() {
            [only] => search(only),
            blocks => self.tree.any(ray.origin, ray.direction, far, |i| search(&blocks[i])),
        }
    }

    /// Whether it has texture coordinates.
    #[must_use]
    pub fn has_uvs(&self) -> bool {
        !self.uvs.is_empty()
    }

    /// Texture coordinates at the weights `uv` of a triangle's second and third corner; those weights where the mesh has none.
    #[must_use]
    pub fn uv(&self, triangle: u32, uv: DVec2) -> DVec2 {
        if self.uvs.is_empty() {
            return uv;
        }
        let [a, b, c] = self.names[triangle as usize].map(|i| self.uvs[i as usize].as_dvec2());
        (1.0 - uv.x - uv.y) * a + uv.x * b + uv.y * c
    }

    /// The interpolated normal, of any length; `None` where the mesh has none.
    #[must_use]
    pub fn shading(&self, triangle: u32, uv: DVec2) -> Option<DVec3> {
        if self.normals.is_empty() {
            return None;
        }
        let [a, b, c] = self.names[triangle as usize].map(|i| self.normals[i as usize].as_dvec3());
        Some((1.0 - uv.x - uv.y) * a + uv.x * b + uv.y * c)
    }

    /// The direction on the face in which the first texture coordinate grows (∂p/∂u, of any length); the first edge where the mesh
    /// has none or they do not span the face.
    #[must_use]
    pub fn across(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        if self.uvs.is_empty() {
            return b - a;
        }
        let [p, q, r] = self.names[triangle as usize].map(|i| self.uvs[i as usize].as_dvec2());
        let (q, r) = (q - p, r - p);
        let determinant = q.x * r.y - q.y * r.x;
        let along = ((b - a) * r.y - (c - a) * q.y) / determinant;
        if along.is_finite() && along != DVec3::ZERO { along } else { b - a }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;

    #[test]
    fn blocks_change_nothing_but_the_order() {
        let mut stream = Stream::new(66, 1);
        let mut data = MeshData::default();
        for i in 0..500 {
            let centre = DVec3::from_array(stream.uniforms());
            data.positions.extend((0..3).map(|_| centre + 0.1 * DVec3::from_array(stream.uniforms())));
            data.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        let whole = Mesh::new(data.clone()).expect("sound");
        let cut = Mesh::in_blocks(data, 10).expect("sound");
        assert_eq!((whole.blocks.len(), cut.blocks.len()), (1, 64));
        assert_eq!(whole.bounds(), cut.bounds());
        let mut hits = 0;
        for _ in 0..1000 {
            let [origin, aim] = [3.0, 1.0].map(|size| size * DVec3::from_array(stream.uniforms()) - 0.5 * (size - 1.0));
            let ray = Ray { origin, direction: aim - origin };
            for far in [f64::INFINITY, 0.7] {
                let [a, b] = [&whole, &cut].map(|mesh| mesh.closest(&ray, 0.0, far));
                assert_eq!(a.map(|c| (c.t, whole.corners(c.face))), b.map(|c| (c.t, cut.corners(c.face))));
                assert_eq!(cut.is_crossed(&ray, 0.0, far), a.is_some());
                hits += usize::from(a.is_some());
            }
        }
        // Rays enough that the comparison means something: about a sixth meet a triangle.
        assert!(hits > 200, "{hits}");
    }
}

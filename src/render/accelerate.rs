//! All surfaces of a scene, and the search for the one that a ray meets first.
//!
//! A [`Tree`] over the boxes of the bounded surfaces; meshes have trees of their own in their own coordinates, so that a mesh that is
//! placed a million times is kept once. Planes without bounds are tried one by one.

use std::sync::Arc;

use glam::DAffine3;

use super::mesh::Mesh;
use super::placed::{PlacedMesh, Placement};
use super::ray::{Crossing, Ray, SurfacePoint};
use super::shape::{Bounds, Shape};
use super::tree::Tree;

/// One surface.
#[derive(Debug, Clone)]
pub enum Surface {
    /// A shape in world coordinates.
    Shape(Arc<dyn Shape>),
    /// A mesh and where it stands.
    Mesh {
        /// The mesh, in its own coordinates.
        mesh: Arc<Mesh>,
        /// From its coordinates to the world's; see [`Placement::new`].
        placement: Placement,
    },
}

impl Surface {
    /// A mesh under a transform.
    ///
    /// # Errors
    ///
    /// The transform cannot be undone.
    pub fn mesh(mesh: Arc<Mesh>, to_world: DAffine3) -> Result<Self, Error> {
        let placement = Placement::new(to_world).ok_or(Error::Singular)?;
        Ok(Self::Mesh { mesh, placement })
    }

    /// The surface as a shape in world coordinates, with what it takes to draw points of it.
    #[must_use]
    pub fn as_shape(&self) -> Arc<dyn Shape> {
        match self {
            Self::Shape(shape) => Arc::clone(shape),
            Self::Mesh { mesh, placement } => Arc::new(PlacedMesh::new(Arc::clone(mesh), *placement)),
        }
    }

    fn bounds(&self) -> Bounds {
        match self {
            Self::Shape(shape) => shape.bounds(),
            Self::Mesh { mesh, placement } => placement.bounds(mesh.bounds()),
        }
    }

    fn cross(&self, ray: &Ray, far: f64) -> Option<Crossing> {
        match self {
            Self::Shape(shape) => shape.cross(ray, 0.0, far),
            Self::Mesh { mesh, placement } => mesh.closest(&placement.ray(ray), 0.0, far),
        }
    }

    fn is_crossed(&self, ray: &Ray, far: f64) -> bool {
        match self {
            Self::Shape(shape) => shape.cross(ray, 0.0, far).is_some(),
            Self::Mesh { mesh, placement } => mesh.is_crossed(&placement.ray(ray), 0.0, far),
        }
    }
}

/// What is wrong with a surface.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// A transform that cannot be undone.
    #[error("a transform that flattens space or is not finite; expected one that can be undone")]
    Singular,
    /// More surfaces than a tree can number.
    #[error("{found} surfaces; expected at most {}", u32::MAX)]
    TooMany {
        /// How many there are.
        found: usize,
    },
}

/// The surfaces of a scene.
#[derive(Debug)]
pub struct Surfaces {
    surfaces: Vec<Surface>,
    /// Over the bounded ones.
    tree: Tree,
    /// The bounded surfaces in the order of the tree.
    bounded: Vec<u32>,
    /// Those without bounds.
    unbounded: Vec<u32>,
}

impl Surfaces {
    /// Builds the tree. Surfaces keep their numbers. Meshes without triangles are never met.
    ///
    /// # Errors
    ///
    /// More surfaces than 2³² − 1.
    pub fn new(surfaces: Vec<Surface>) -> Result<Self, Error> {
        let found = surfaces.len();
        let count = u32::try_from(found).map_err(|_| Error::TooMany { found })?;
        let (mut bounded, mut boxes, mut unbounded) = (Vec::new(), Vec::new(), Vec::new());
        for (i, surface) in (0..count).zip(&surfaces) {
            let bounds = surface.bounds();
            if bounds.is_finite() {
                bounded.push(i);
                boxes.push(bounds);
            } else if bounds != Bounds::EMPTY {
                unbounded.push(i);
            }
        }
        let mut tree = Tree::new(boxes.len(), |i| boxes[i]);
        let bounded = tree.take_order().into_iter().map(|i| bounded[i as usize]).collect();
        Ok(Self { surfaces, tree, bounded, unbounded })
    }

    /// The first surface that the ray meets with 0 < t < `far`, and where.
    #[must_use]
    pub fn closest(&self, ray: &Ray, far: f64) -> Option<(usize, Crossing)> {
        let mut found = None;
        let mut far = far;
        let mut try_surface = |i: u32, far: f64| match self.surfaces[i as usize].cross(ray, far) {
            Some(crossing) => {
                found = Some((i as usize, crossing));
                crossing.t
            }
            None => far,
        };
        for &i in &self.unbounded {
            far = try_surface(i, far);
        }
        self.tree.search(ray, far, |slot, far| try_surface(self.bounded[slot], far));
        found
    }

    /// Whether the ray meets any surface but `ignore` with 0 < t < `far`.
    #[must_use]
    pub fn is_occluded(&self, ray: &Ray, far: f64, ignore: Option<usize>) -> bool {
        let meets = |i: u32| Some(i as usize) != ignore && self.surfaces[i as usize].is_crossed(ray, far);
        if self.unbounded.iter().any(|&i| meets(i)) {
            return true;
        }
        let mut found = false;
        self.tree.search(ray, far, |slot, far| {
            found = meets(self.bounded[slot]);
            if found { 0.0 } else { far }
        });
        found
    }

    /// The surface at a crossing that [`Surfaces::closest`] found.
    #[must_use]
    pub fn surface_point(&self, index: usize, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        match &self.surfaces[index] {
            Surface::Shape(shape) => shape.surface(ray, crossing),
            Surface::Mesh { mesh, placement } => placement.surface(mesh, crossing.face, crossing.uv),
        }
    }

    /// The box of the bounded surfaces, m.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.tree.bounds()
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.surfaces.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.surfaces.is_empty()
    }

    /// A surface.
    #[must_use]
    pub fn surface(&self, index: usize) -> &Surface {
        &self.surfaces[index]
    }
}

//! All surfaces of a scene, and the search for the first one that a ray meets.

use std::sync::Arc;

use super::ray::{Crossing, Ray, SurfacePoint};
use super::shape::{Bounds, Shape};
use super::tree::Tree;

/// So few shapes are tested one by one: meshes have hierarchies of their own, and one above them gains nothing.
const FEW: usize = 2;

/// The surfaces of a scene, by number.
#[derive(Debug)]
pub struct Surfaces {
    shapes: Vec<Arc<dyn Shape>>,
    /// Numbers of the shapes in the hierarchy, in its order.
    bounded: Vec<u32>,
    /// Numbers of the shapes that every ray is tested against: those without bounds, and all where they are [`FEW`].
    always: Vec<u32>,
    tree: Tree,
    bounds: Bounds,
}

impl Surfaces {
    /// The shapes given; at most 2³² of them.
    #[must_use]
    pub fn new(shapes: Vec<Arc<dyn Shape>>) -> Self {
        let (mut bounded, mut always, mut boxes) = (Vec::new(), Vec::new(), Vec::new());
        for (number, shape) in (0..).zip(&shapes) {
            let bounds = shape.bounds();
            if bounds.is_finite() {
                bounded.push(number);
                boxes.push(bounds);
            } else if bounds != Bounds::EMPTY {
                always.push(number);
            }
        }
        let bounds = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union);
        if bounded.len() <= FEW {
            boxes.clear();
            always.append(&mut bounded);
        }
        Self { shapes, bounded, always, tree: Tree::new(&boxes), bounds }
    }

    /// The first crossing at a distance in (0, `far`), and the surface crossed.
    #[must_use]
    pub fn closest(&self, ray: &Ray, far: f64) -> Option<(usize, Crossing)> {
        let mut found = None;
        let mut best = far;
        for &number in &self.always {
            if let Some(crossing) = self.shapes[number as usize].cross(ray, 0.0, best) {
                best = crossing.t;
                found = Some((number as usize, crossing));
            }
        }
        self.tree.closest(ray.origin, ray.direction, best, |place, best| {
            let number = self.bounded[place] as usize;
            let crossing = self.shapes[number].cross(ray, 0.0, best)?;
            found = Some((number, crossing));
            Some(crossing.t)
        });
        found
    }

    /// Whether anything but the surface `ignore` is crossed at a distance in (0, `far`).
    #[must_use]
    pub fn is_occluded(&self, ray: &Ray, far: f64, ignore: Option<usize>) -> bool {
        let hides =
            |number: u32| Some(number as usize) != ignore && self.shapes[number as usize].is_crossed(ray, 0.0, far);
        self.always.iter().any(|&number| hides(number))
            || self.tree.any(ray.origin, ray.direction, far, |place| hides(self.bounded[place]))
    }

    /// The point of a surface at a crossing.
    #[must_use]
    pub fn surface_point(&self, surface: usize, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.shapes[surface].surface(ray, crossing)
    }

    /// Whether the box of bounded surfaces holds all there are.
    #[must_use]
    pub fn are_bounded(&self) -> bool {
        self.shapes.iter().map(|shape| shape.bounds()).all(|bounds| bounds.is_finite() || bounds == Bounds::EMPTY)
    }

    /// The box of all bounded surfaces.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The shapes by number.
    #[must_use]
    pub fn shapes(&self) -> &[Arc<dyn Shape>] {
        &self.shapes
    }
}

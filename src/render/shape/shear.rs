//! A ray seen along itself: points are sheared so that the ray becomes an axis, and whether it passes an edge on the left or on the
//! right becomes the sign of one number in the plane across.
//!
//! ```text
//! k = the axis with the greatest |d|;   (x, y, z) = (p_i − p_k d_i/d_k, p_j − p_k d_j/d_k, p_k/d_k),   p = point − origin
//! edge(a, b) = x_a y_b − y_a x_b
//! ```
//!
//! A point is projected to the same place whichever face it belongs to, and the sign of `edge` is exact for the places as rounded
//! (rounded products keep the order of exact ones; where they are equal, the difference is computed with its rounding errors). So all
//! faces around an edge or a vertex agree on which side the ray passes: no ray slips through between them.
//!
//! Reference: S. Woop, C. Benthin, I. Wald, *Watertight Ray/Triangle Intersection*, JCGT 2(1) (2013).

use glam::DVec3;

use super::rounding::difference_of_products;
use crate::render::ray::Ray;

/// The transform that makes a ray the z axis, distances along it unchanged.
#[derive(Debug, Clone, Copy)]
pub struct Shear {
    origin: DVec3,
    /// Which coordinate becomes z.
    axis: usize,
    /// d_i/d_k, d_j/d_k, 1/d_k.
    by: [f64; 3],
}

impl Shear {
    /// The transform of a ray. Computed once per ray, it serves all faces.
    #[must_use]
    pub fn new(ray: &Ray) -> Self {
        let size = ray.direction.abs();
        let axes = if size.x > size.y && size.x > size.z {
            [1, 2, 0]
        } else if size.y > size.z {
            [2, 0, 1]
        } else {
            [0, 1, 2]
        };
        let [i, j, k] = axes.map(|axis| ray.direction[axis]);
        let scale = 1.0 / k;
        Self { origin: ray.origin, axis: axes[2], by: [i * scale, j * scale, scale] }
    }

    /// A point in the ray's coordinates: x and y across, z the distance along it, m.
    #[must_use]
    pub fn point(&self, point: DVec3) -> DVec3 {
        let p = point - self.origin;
        // One branch that is the same for all points of a ray is cheaper than three looked-up indices.
        let [x, y, z] = match self.axis {
            0 => [p.y, p.z, p.x],
            1 => [p.z, p.x, p.y],
            _ => [p.x, p.y, p.z],
        };
        DVec3::new(x - self.by[0] * z, y - self.by[1] * z, self.by[2] * z)
    }
}

/// On which side of the edge from `a` to `b` the ray (the z axis) passes: positive on the left, zero exactly on it; m².
#[must_use]
pub fn edge(a: DVec3, b: DVec3) -> f64 {
    let rounded = a.x * b.y - a.y * b.x;
    if rounded == 0.0 { difference_of_products(a.x, b.y, a.y, b.x) } else { rounded }
}

/// Whether the ray passes through the closed outline with these corners, by counting the edges that it has on one side. What lies
/// exactly on an edge belongs to one of the two faces that share it, whatever their number of corners.
pub fn passes_through(shear: &Shear, corners: impl ExactSizeIterator<Item = DVec3> + Clone) -> bool {
    let Some(last) = corners.clone().last() else { return false };
    let mut inside = false;
    let mut a = shear.point(last);
    for corner in corners {
        let b = shear.point(corner);
        if (a.y >= 0.0) != (b.y >= 0.0) {
            // The edge crosses the line y = 0: on the side x > 0?
            let side = edge(a, b);
            inside ^= if b.y >= 0.0 { side > 0.0 } else { side < 0.0 };
        }
        a = b;
    }
    inside
}

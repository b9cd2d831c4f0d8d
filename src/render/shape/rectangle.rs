//! Rectangle or parallelogram: a corner and two edges; its outside is along first edge × second edge.
//!
//! | | |
//! |---|---|
//! | crossing | watertight against other flat shapes with the same corners ([`shear`](super::shear)) |
//! | uv | fractions of the first and of the second edge |
//! | tangent | along the first edge |
//! | directions | from more than two diagonals away uniform over the area, which comes to nearly the same and costs less; else uniform over the solid angle: of a rectangle by the map of C. Ureña, M. Fajardo, A. King, *An Area-Preserving Parametrization for Spherical Rectangles*, EGSR 2013, where it keeps its digits, else by its two triangles |
//! | projected solid angle | Lambert's sum over the edges, cut at the horizon |

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::chart::Chart;
use super::error::{ShapeError, finite};
use super::facet::Facet;
use super::patches::{Patch, Patches};
use super::rounding::{cross, gamma};
use super::shear::{Shear, passes_through};
use super::{Bounds, Shape, outline, pdf_of_point, spherical, towards_point};
use crate::render::ray::{Crossing, Ray, SurfacePoint, Towards};

/// A parallelogram in world coordinates.
#[derive(Debug, Clone)]
pub struct Rectangle {
    /// The anchor is the corner.
    facet: Facet,
    edges: [DVec3; 2],
    /// Vectors in the plane whose products with the edges are 1 and 0.
    dual: [DVec3; 2],
    /// In order around it.
    corners: [DVec3; 4],
    tangent: DVec3,
    area: f64,
    centre: DVec3,
    /// Square of the distance beyond which it is sampled by area, m².
    far: f64,
    /// The steepest gradient of the fractions of the edges, 1/m.
    gradient: f64,
    /// Lengths of the edges where they stand at right angles.
    sides: Option<[f64; 2]>,
    halves: Patches,
}

impl Rectangle {
    /// The parallelogram with the corners `corner`, `corner + first`, `corner + first + second`, `corner + second` (m).
    ///
    /// # Errors
    ///
    /// What is not finite or spans no area.
    pub fn new(corner: DVec3, first: DVec3, second: DVec3) -> Result<Self, ShapeError> {
        finite("corner", corner)?;
        let edges = [finite("first edge", first)?, finite("second edge", second)?];
        let corners = [corner, corner + first, corner + first + second, corner + second];
        let normal = outline::plane("rectangle", &[DVec3::ZERO, first, second])?.normal;
        let area = cross(first, second).length();
        let dual = [cross(second, normal) / area, cross(normal, first) / area];
        let [a, b, c, d] = corners;
        let halves = Patches::new([[a, b, c], [a, c, d]].map(|corners| Patch { corners, face: 0 }).to_vec());
        let lengths = edges.map(DVec3::length);
        let is_right = first.dot(second).abs() <= 1e-14 * lengths[0] * lengths[1];
        Ok(Self {
            facet: Facet { anchor: corner, normal },
            edges,
            dual,
            corners,
            tangent: first / lengths[0],
            area,
            centre: corner + 0.5 * (first + second),
            far: 4.0 * (first + second).length_squared().max((first - second).length_squared()),
            gradient: dual[0].length().max(dual[1].length()),
            sides: is_right.then_some(lengths),
            halves,
        })
    }

    fn point(&self, uv: DVec2) -> SurfacePoint {
        let (position, error) = self.facet.settle(self.facet.anchor + uv.x * self.edges[0] + uv.y * self.edges[1]);
        let normal = self.facet.normal;
        SurfacePoint { position, error, normal, shading: normal, tangent: self.tangent, uv }
    }

    fn solid_angle(&self, from: DVec3) -> f64 {
        self.halves.solid_angle(from, |_| true)
    }

    /// The map of Ureña et al.: a column of the spherical rectangle by its solid angle, then a point of it by its height. `None` where
    /// the eye is so near the plane, or the rectangle looks so small, that its differences lose their digits.
    fn sample_rectangle(&self, from: DVec3, omega: f64, [u, v]: [f64; 2]) -> Option<DVec3> {
        let sides = self.sides?;
        let to = self.facet.anchor - from;
        let axes = [self.edges[0] / sides[0], self.edges[1] / sides[1]];
        let [x0, y0] = axes.map(|axis| to.dot(axis));
        let (x1, y1) = (x0 + sides[0], y0 + sides[1]);
        let height = to.dot(self.facet.normal);
        let z = height.abs();
        let reach = x0.abs().max(x1.abs()).max(y0.abs()).max(y1.abs());
        if omega < 1e-4 || z < 1e-4 * reach {
            return None;
        }
        // The planes through the eye and the edges: neighbours' normals share only their third coordinate.
        let length = |a: f64, b: f64| (a * a + b * b).sqrt();
        let third = |x: f64| x / length(z, x);
        let (b0, b1, left) = (third(y0), third(y1), third(x0));
        // 2π less the angles at the two corners on the left.
        let k = TAU - (b1 * left).acos() - (-b0 * left).acos();
        let (sin, cos) = (u * omega + k).sin_cos();
        let f = (-cos * b0 - b1) / sin;
        let c = length(f, b0).recip().copysign(f).clamp(-1.0, 1.0);
        let x = (c * z / (1.0 - c * c).sqrt()).clamp(x0, x1);
        let d = length(x, z);
        let (h0, h1) = (y0 / length(d, y0), y1 / length(d, y1));
        let h = h0 + v * (h1 - h0);
        let y = (h * d / (1.0 - h * h).sqrt()).clamp(y0, y1);
        (x * axes[0] + y * axes[1] + height * self.facet.normal).try_normalize()
    }
}

impl Shape for Rectangle {
    fn bounds(&self) -> Bounds {
        Bounds::of(self.corners)
    }

    fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        let t = self.facet.cross(ray, near, far)?;
        let from = ray.origin - self.facet.anchor;
        let p = from + t * ray.direction;
        let uv = DVec2::new(p.dot(self.dual[0]), p.dot(self.dual[1]));
        // How far inside of the nearest edge, as a fraction of the edges, and what rounding can make of that: of t, which grows as the ray
        // grazes, and of the sums. Only so near to an edge must the decision be that of the face on the other side.
        let inside = uv.min(1.0 - uv).min_element();
        let grazing = self.facet.normal.dot(ray.direction).abs().recip();
        let size = self.gradient * (from.abs().element_sum() + t) * (1.0 + grazing);
        let clear = inside.abs() > gamma(32.0) * size;
        if if clear { inside < 0.0 } else { !passes_through(&Shear::new(ray), self.corners.into_iter()) } {
            return None;
        }
        Some(Crossing { t, uv: uv.clamp(DVec2::ZERO, DVec2::ONE), face: 0 })
    }

    fn surface(&self, _: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.point(crossing.uv)
    }

    fn charts(&self) -> Vec<(u32, Chart)> {
        vec![(0, Chart::Parallelogram { corner: self.facet.anchor, edges: self.edges })]
    }

    fn area(&self) -> f64 {
        self.area
    }

    fn sample_area(&self, [_, u, v]: [f64; 3]) -> SurfacePoint {
        self.point(DVec2::new(u, v))
    }

    fn facing(&self) -> Option<DVec3> {
        Some(self.facet.normal)
    }

    fn sample_towards(&self, from: DVec3, u: [f64; 3]) -> Option<Towards> {
        if from.distance_squared(self.centre) > self.far {
            return towards_point(self.area, from, &self.sample_area(u));
        }
        let omega = self.solid_angle(from);
        if !spherical::RANGE_SR.contains(&omega) {
            return towards_point(self.area, from, &self.sample_area(u));
        }
        let direction = self
            .sample_rectangle(from, omega, [u[1], u[2]])
            .or_else(|| Some(self.halves.sample(from, omega, |_| true, u)?.0))?;
        let distance = self.facet.distance(from, direction);
        (distance > 0.0).then_some(Towards { direction, distance, pdf: 1.0 / omega, delta: false })
    }

    fn pdf_towards(&self, from: DVec3, point: &SurfacePoint) -> f64 {
        if from.distance_squared(self.centre) > self.far {
            return pdf_of_point(self.area, from, point);
        }
        let omega = self.solid_angle(from);
        if spherical::RANGE_SR.contains(&omega) { 1.0 / omega } else { pdf_of_point(self.area, from, point) }
    }

    fn projected_solid_angle(&self, from: DVec3, normal: DVec3) -> Option<f64> {
        Some(outline::projected(self.corners.into_iter(), &self.facet, from, normal))
    }
}

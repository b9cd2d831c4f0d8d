//! Triangle with corners a, b, c; its outside is where they stand anticlockwise.
//!
//! | | |
//! |---|---|
//! | crossing | watertight ([`cross_triangle`]) |
//! | uv | weights of b and c (barycentric) |
//! | tangent | from a to b |
//! | directions | uniform over the solid angle (J. Arvo, *Stratified Sampling of Spherical Triangles*, SIGGRAPH 1995, in the products of Van Oosterom & Strackee 1983) |
//! | projected solid angle | Lambert's sum over the edges, cut at the horizon |

use glam::{DVec2, DVec3};

use super::chart::Chart;
use super::error::{ShapeError, finite};
use super::facet::Facet;
use super::rounding::{cross, gamma};
use super::shear::{Shear, edge};
use super::{Bounds, Shape, outline, pdf_of_point, spherical, towards_point};
use crate::geometry::solid_angle;
use crate::render::ray::{Crossing, Ray, SurfacePoint, Towards};

/// A triangle in world coordinates.
#[derive(Debug, Clone)]
pub struct Triangle {
    corners: [DVec3; 3],
    /// The anchor is the first corner.
    facet: Facet,
    tangent: DVec3,
    area: f64,
}

impl Triangle {
    /// The triangle with these corners (m).
    ///
    /// # Errors
    ///
    /// What is not finite or spans no area.
    pub fn new(a: DVec3, b: DVec3, c: DVec3) -> Result<Self, ShapeError> {
        let corners = [finite("first corner", a)?, finite("second corner", b)?, finite("third corner", c)?];
        let facet = outline::plane("triangle", &corners)?;
        Ok(Self { corners, facet, tangent: (b - a).normalize(), area: 0.5 * cross(b - a, c - a).length() })
    }

    fn solid_angle(&self, from: DVec3) -> f64 {
        let [a, b, c] = self.corners.map(|p| p - from);
        solid_angle::triangle(a, b, c)
    }

    fn point(&self, uv: DVec2) -> SurfacePoint {
        let [a, b, c] = self.corners;
        let (position, error) = self.facet.settle(a + uv.x * (b - a) + uv.y * (c - a));
        let normal = self.facet.normal;
        SurfacePoint { position, error, normal, shading: normal, tangent: self.tangent, uv }
    }
}

impl Shape for Triangle {
    fn bounds(&self) -> Bounds {
        Bounds::of(self.corners)
    }

    fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        let [a, b, c] = self.corners;
        cross_triangle(ray, a, b, c, near, far)
    }

    fn surface(&self, _: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.point(crossing.uv)
    }

    fn charts(&self) -> Vec<(u32, Chart)> {
        vec![(0, Chart::Triangle(self.corners))]
    }

    fn area(&self) -> f64 {
        self.area
    }

    fn facing(&self) -> Option<DVec3> {
        Some(self.facet.normal)
    }

    fn sample_area(&self, [_, u, v]: [f64; 3]) -> SurfacePoint {
        self.point(uniform_weights([u, v]))
    }

    fn sample_towards(&self, from: DVec3, u: [f64; 3]) -> Option<Towards> {
        let omega = self.solid_angle(from);
        if !spherical::RANGE_SR.contains(&omega) {
            return towards_point(self.area, from, &self.sample_area(u));
        }
        let [a, b, c] = self.corners.map(|p| p - from);
        let direction = spherical::sample(a, b, c, omega, [u[1], u[2]])?;
        let distance = self.facet.distance(from, direction);
        (distance > 0.0).then_some(Towards { direction, distance, pdf: 1.0 / omega, delta: false })
    }

    fn pdf_towards(&self, from: DVec3, point: &SurfacePoint) -> f64 {
        let omega = self.solid_angle(from);
        if spherical::RANGE_SR.contains(&omega) { 1.0 / omega } else { pdf_of_point(self.area, from, point) }
    }

    fn projected_solid_angle(&self, from: DVec3, normal: DVec3) -> Option<f64> {
        Some(outline::projected(self.corners.into_iter(), &self.facet, from, normal))
    }
}

/// Weights of the second and third corner, uniform over a triangle's area: the square folded along the edges at the first
/// (G. Turk, *Generating Random Points in Triangles*, Graphics Gems, 1990).
#[must_use]
pub fn uniform_weights([u, v]: [f64; 2]) -> DVec2 {
    let root = u.sqrt();
    DVec2::new(root * (1.0 - v), root * v)
}

/// Where a ray crosses a triangle with `near < t < far`, from either side; `uv` are the weights of `b` and `c`, `face` is 0.
///
/// Watertight: triangles that share an edge or a vertex leave no gap between them, whatever the ray; one that passes exactly through
/// an edge crosses all the triangles there. A crossing nearer than the rounding of its own distance is none, so that a ray that
/// starts on the triangle does not meet it again (Pharr et al. 2023, 6.8.7). Triangles without area are never crossed.
///
/// To test many triangles with one ray, make its [`Shear`] once and call [`cross_sheared`].
#[must_use]
pub fn cross_triangle(ray: &Ray, a: DVec3, b: DVec3, c: DVec3, near: f64, far: f64) -> Option<Crossing> {
    cross_sheared(&Shear::new(ray), a, b, c, near, far)
}

/// [`cross_triangle`] for a ray whose [`Shear`] is there already.
#[must_use]
pub fn cross_sheared(shear: &Shear, a: DVec3, b: DVec3, c: DVec3, near: f64, far: f64) -> Option<Crossing> {
    let [a, b, c] = [a, b, c].map(|p| shear.point(p));
    let (u, v, w) = (edge(b, c), edge(c, a), edge(a, b));
    if u.min(v).min(w) < 0.0 && u.max(v).max(w) > 0.0 {
        return None;
    }
    let determinant = u + v + w;
    let t = (u * a.z + v * b.z + w * c.z) / determinant;
    // Also false where the determinant is 0 and t is no number.
    if !(near < t && t < far) {
        return None;
    }
    let [x, y, z] = [0, 1, 2].map(|i| a[i].abs().max(b[i].abs()).max(c[i].abs()));
    let e = u.abs().max(v.abs()).max(w.abs());
    let edge_error = 2.0 * (gamma(2.0) * x * y + gamma(5.0) * ((y + z) * x + (x + z) * y));
    let error = 3.0 * z * (edge_error + (gamma(3.0) + gamma(3.0)) * e) / determinant.abs();
    (t > error).then(|| Crossing { t, uv: DVec2::new(v / determinant, w / determinant), face: 0 })
}

/// The point of a triangle with the weights `uv` of `b` and `c`, and the bounds of its rounding error per coordinate, m.
#[must_use]
pub fn point(a: DVec3, b: DVec3, c: DVec3, uv: DVec2) -> (DVec3, DVec3) {
    let [a, b, c] = [(1.0 - uv.x - uv.y) * a, uv.x * b, uv.y * c];
    (a + b + c, gamma(7.0) * (a.abs() + b.abs() + c.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::direction::from_angles;
    use crate::math::random::Stream;

    /// A ball of 8 · 4ⁿ triangles about the origin (an octahedron, refined), corners shared exactly.
    fn ball(refinements: u32) -> Vec<[DVec3; 3]> {
        let mut triangles = Vec::new();
        for x in [1.0, -1.0] {
            for y in [1.0, -1.0] {
                for z in [1.0, -1.0] {
                    triangles.push([DVec3::X * x, DVec3::Y * y, DVec3::Z * z]);
                }
            }
        }
        for _ in 0..refinements {
            triangles = triangles
                .into_iter()
                .flat_map(|[a, b, c]| {
                    let [p, q, r] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
                    [[a, p, r], [p, b, q], [r, q, c], [p, q, r]]
                })
                .collect();
        }
        triangles
    }

    fn crossings(triangles: &[[DVec3; 3]], ray: &Ray, scale: f64, shift: DVec3) -> usize {
        let at = |p: DVec3| shift + scale * p;
        let shear = Shear::new(ray);
        let hit = |t: &&[DVec3; 3]| cross_sheared(&shear, at(t[0]), at(t[1]), at(t[2]), 0.0, f64::INFINITY).is_some();
        triangles.iter().filter(hit).count()
    }

    #[test]
    fn no_ray_leaves_a_closed_ball() {
        let triangles = ball(2);
        let mut stream = Stream::new(6, 1);
        for scale in [1e-8, 1.0, 1e8] {
            for shift in [DVec3::ZERO, 1e6 * scale * DVec3::new(1.0, -0.3, 0.2)] {
                for i in 0..4_000 {
                    let [u, v, r] = stream.uniforms();
                    let inside = 0.5 * r * from_angles(3.0 * v, 6.0 * u);
                    // Every other ray is aimed exactly at a corner or at the middle of an edge.
                    let [a, b, _] = triangles[i % triangles.len()];
                    let aim = [from_angles(3.1 * u, 6.2 * v), a, from_angles(3.1 * u, 6.2 * r), 0.5 * (a + b)][i % 4];
                    let origin = shift + scale * inside;
                    let ray = Ray { origin, direction: (shift + scale * aim - origin).normalize() };
                    let count = crossings(&triangles, &ray, scale, shift);
                    assert!(count >= 1, "{scale} {shift} {ray:?}");
                    assert!(count == 1 || i % 2 == 1, "{count} {scale} {shift} {ray:?}");
                }
            }
        }
    }

    #[test]
    fn the_interval_is_open_and_both_sides_count() {
        let [a, b, c] = [DVec3::ZERO, DVec3::X, DVec3::Y];
        for side in [1.0, -1.0] {
            let ray = Ray { origin: DVec3::new(0.25, 0.5, side * 2.0), direction: DVec3::Z * -side };
            let cross = |near, far| cross_triangle(&ray, a, b, c, near, far);
            let found = cross(0.0, 3.0).expect("in the middle");
            assert_eq!((found.t, found.uv), (2.0, DVec2::new(0.25, 0.5)));
            assert!(cross(0.0, 2.0).is_none() && cross(2.0, 3.0).is_none());
            assert!(cross_triangle(&ray, a, b, 0.5 * b, 0.0, 3.0).is_none());
        }
    }
}

//! A mesh placed in the world: a shape, which can be a light.

use std::sync::{Arc, OnceLock};

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::mesh::Mesh;
use super::ray::{Crossing, Ray, SurfacePoint};
use super::shape::chart::Chart;
use super::shape::rounding::{cross, gamma};
use super::shape::{Bounds, Shape, triangle};
use crate::geometry::direction::tangents;

/// A transform with its inverse.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Placement {
    to_world: DAffine3,
    to_local: DAffine3,
    /// Nothing moves, as with most meshes: the same numbers are had without the arithmetic.
    is_identity: bool,
}

impl Placement {
    /// `None` for a transform that cannot be undone in `f64`.
    fn new(to_world: DAffine3) -> Option<Self> {
        let to_local = to_world.inverse();
        let is_identity = to_world == DAffine3::IDENTITY;
        (to_world.is_finite() && to_local.is_finite()).then_some(Self { to_world, to_local, is_identity })
    }

    /// A ray of the world in the mesh's coordinates; distances along it stay what they are.
    fn ray(&self, ray: &Ray) -> Ray {
        if self.is_identity {
            return *ray;
        }
        Ray {
            origin: self.to_local.transform_point3(ray.origin),
            direction: self.to_local.transform_vector3(ray.direction),
        }
    }

    /// The box in the world of a box in the mesh's coordinates.
    fn bounds(&self, local: Bounds) -> Bounds {
        if !local.is_finite() {
            return local;
        }
        let middle = 0.5 * local.min + 0.5 * local.max;
        let half = 0.5 * local.max - 0.5 * local.min;
        let size = absolute(self.to_world.matrix3);
        let centre = self.to_world.transform_point3(middle);
        // The rounding of the transform belongs to the box.
        let half = size * half + gamma(8.0) * (size * (middle.abs() + half) + self.to_world.translation.abs());
        Bounds { min: centre - half, max: centre + half }
    }

    /// The surface of a mesh at weights `uv` of a triangle's second and third corner.
    fn surface(&self, mesh: &Mesh, face: u32, uv: DVec2) -> SurfacePoint {
        let [a, b, c] = mesh.corners(face);
        let (local, local_error) = triangle::point(a, b, c, uv);
        let across = cross(b - a, c - a);
        let (smooth, along) = (mesh.shading(face, uv), mesh.across(face));
        let (position, error, normal, smooth, along) = if self.is_identity {
            let rounding = gamma(5.0) * local.abs();
            (local, local_error + rounding + rounding, across.normalize(), smooth, along)
        } else {
            let position = self.to_world.transform_point3(local);
            // Normals turn with the inverse transposed, so that they stay across and on the same side of a mirrored mesh.
            let turn = self.to_local.matrix3.transpose();
            // The point's own rounding, that of its way to the world, and that of the way back which the next ray takes.
            let out = absolute(self.to_world.matrix3);
            let back = absolute(self.to_local.matrix3);
            let error = out * local_error
                + gamma(5.0) * (out * local.abs() + self.to_world.translation.abs())
                + out * (gamma(5.0) * (back * position.abs() + self.to_local.translation.abs()));
            let along = self.to_world.transform_vector3(along);
            (position, error, (turn * across).normalize(), smooth.map(|n| turn * n), along)
        };
        let shading =
            (smooth.and_then(DVec3::try_normalize)).map_or(normal, |n| if n.dot(normal) < 0.0 { -n } else { n });
        let tangent = along.reject_from_normalized(shading).try_normalize().unwrap_or_else(|| tangents(shading).0);
        SurfacePoint { position, error: normal.abs().dot(error), normal, shading, tangent, uv: mesh.uv(face, uv) }
    }
}

fn absolute(m: DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

/// A mesh as a shape in the world.
#[derive(Debug)]
pub struct PlacedMesh {
    mesh: Arc<Mesh>,
    placement: Placement,
    /// Area of the triangles up to and with each, m²; added up when first asked for, because most meshes are no lights.
    areas: OnceLock<Vec<f64>>,
}

impl PlacedMesh {
    /// Places a mesh by the transform from its coordinates to the world's; `None` for one that cannot be undone in `f64`.
    #[must_use]
    pub fn new(mesh: Arc<Mesh>, to_world: DAffine3) -> Option<Self> {
        Some(Self { mesh, placement: Placement::new(to_world)?, areas: OnceLock::new() })
    }

    fn areas(&self) -> &[f64] {
        self.areas.get_or_init(|| {
            let mut sum = 0.0;
            let mut add = |face| {
                let [a, b, c] = self.mesh.corners(face);
                let [p, q] = [b - a, c - a].map(|edge| self.placement.to_world.transform_vector3(edge));
                sum += 0.5 * cross(p, q).length();
                sum
            };
            (0..self.mesh.triangles()).map(&mut add).collect()
        })
    }
}

impl Shape for PlacedMesh {
    fn bounds(&self) -> Bounds {
        self.placement.bounds(self.mesh.bounds())
    }

    fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        self.mesh.closest(&self.placement.ray(ray), near, far)
    }

    fn is_crossed(&self, ray: &Ray, near: f64, far: f64) -> bool {
        self.mesh.is_crossed(&self.placement.ray(ray), near, far)
    }

    fn surface(&self, _ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.placement.surface(&self.mesh, crossing.face, crossing.uv)
    }

    fn charts(&self) -> Vec<(u32, Chart)> {
        let of = |face| {
            let [a, b, c] = self.mesh.corners(face).map(|p| self.placement.to_world.transform_point3(p));
            // A mirrored mesh has its corners the other way round.
            let mirrored = self.placement.to_world.matrix3.determinant() < 0.0;
            (face, Chart::Triangle(if mirrored { [a, c, b] } else { [a, b, c] }))
        };
        (0..self.mesh.triangles()).map(of).collect()
    }

    fn area(&self) -> f64 {
        self.areas().last().copied().unwrap_or(0.0)
    }

    /// A mesh without triangles has no point: its is the origin, with a density of no number.
    fn sample_area(&self, u: [f64; 3]) -> SurfacePoint {
        let Some(last) = self.areas().len().checked_sub(1) else {
            return SurfacePoint {
                position: DVec3::ZERO,
                error: 0.0,
                normal: DVec3::Z,
                shading: DVec3::Z,
                tangent: DVec3::X,
                uv: DVec2::ZERO,
            };
        };
        let chosen = u[0] * self.area();
        let face = self.areas().partition_point(|&sum| sum <= chosen).min(last);
        let (fold, v) = (u[1].sqrt(), u[2]);
        self.placement.surface(&self.mesh, face as u32, DVec2::new(fold * (1.0 - v), fold * v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;
    use crate::render::mesh::MeshData;

    /// To the bit.
    #[test]
    fn what_is_not_moved_is_what_moving_by_nothing_gives() {
        let mut stream = Stream::new(31, 1);
        let mut point = || DVec3::from_array(stream.uniforms()) - 0.5;
        let positions = vec![point(), point(), point()];
        let normals = [point(), point(), point()].map(|n| n.as_vec3()).to_vec();
        let data = MeshData { positions, triangles: vec![[0, 1, 2]], normals, uvs: Vec::new() };
        let own = Placement::new(DAffine3::IDENTITY).expect("can be undone");
        assert!(own.is_identity);
        let general = Placement { is_identity: false, ..own };
        for data in [MeshData { normals: Vec::new(), ..data.clone() }, data] {
            let mesh = Mesh::new(data).expect("sound");
            for u in 0..100 {
                let uv = DVec2::new(0.009 * f64::from(u), 0.003);
                assert_eq!(own.surface(&mesh, 0, uv), general.surface(&mesh, 0, uv));
                let ray = Ray { origin: point(), direction: point() };
                assert_eq!(own.ray(&ray), general.ray(&ray));
            }
        }
    }
}

//! The object as a mesh of a file in its pose, for `capture brdf`: the renderer's readers and its search for crossings.

use std::collections::HashMap;
use std::path::Path;

use glam::{DQuat, DVec3, Vec3};

use crate::capture::brdf::{Hit, Surface};
use crate::capture::setup;
use crate::cli::Failure;
use crate::cli::capture::photos::Photos;
use crate::render::format::{self, obj, ply};
use crate::render::mesh::{Mesh, MeshData};
use crate::render::ray::Ray;

/// How far shadow rays start off the surface, of the size of the mesh: more than the rounding of a crossing, less than a pixel.
const OFF: f64 = 1e-7;

/// A mesh in the frame of camera and lights.
#[derive(Debug)]
pub(super) struct Posed {
    mesh: Mesh,
    off: f64,
}

impl Posed {
    /// Reads the file of a manifest's mesh and poses it.
    pub(super) fn open(photos: &mut Photos, stated: &setup::Mesh) -> Result<Self, Failure> {
        let path = photos.path(&stated.file);
        let bytes = photos.bytes(&path)?;
        let wrong = |e: format::Error| Failure::Message(format!("{path}:{e}"));
        let objects = match Path::new(&path).extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
            Some("obj") => obj::read(&bytes).map_err(wrong)?,
            Some("ply") => vec![ply::read(&bytes).map_err(wrong)?],
            _ => return Err(Failure::Message(format!("{path}: expected a mesh whose name ends in .obj or .ply"))),
        };
        let failed = |e: &dyn std::fmt::Display| Failure::Message(format!("{path}: {e}"));
        let data = posed(whole(objects.into_iter().map(|o| o.mesh), stated.flat), stated);
        let mesh = Mesh::new(data).map_err(|e| failed(&e))?;
        if mesh.triangles() == 0 {
            return Err(failed(&"found no triangle with an area; expected a mesh of triangles"));
        }
        let bounds = mesh.bounds();
        Ok(Self { off: OFF * (bounds.max - bounds.min).length(), mesh })
    }
}

/// All objects of a file in one, with a normal at every corner unless faces are flat.
fn whole(objects: impl Iterator<Item = MeshData>, flat: bool) -> MeshData {
    let mut out = MeshData::default();
    let mut has_normals = !flat;
    for object in objects {
        let first = u32::try_from(out.positions.len()).unwrap_or(u32::MAX);
        has_normals &= object.normals.len() == object.positions.len();
        out.positions.extend(object.positions);
        out.normals.extend(object.normals);
        // A corner that is not there is told when the mesh is built.
        out.triangles.extend(object.triangles.iter().map(|t| t.map(|i| i.saturating_add(first))));
    }
    if !has_normals {
        out.normals = if flat { Vec::new() } else { mean_normals(&out) };
    }
    out
}

/// At every corner the mean of the normals of the faces about its place, by area.
fn mean_normals(data: &MeshData) -> Vec<Vec3> {
    let place = |p: &DVec3| p.to_array().map(f64::to_bits);
    let mut sums: HashMap<[u64; 3], DVec3> = HashMap::with_capacity(data.positions.len());
    for triangle in &data.triangles {
        let Some([a, b, c]) = corners(data, triangle) else { continue };
        let normal = (b - a).cross(c - a);
        [a, b, c].iter().for_each(|p| *sums.entry(place(p)).or_default() += normal);
    }
    let of = |p: &DVec3| sums.get(&place(p)).map_or(DVec3::ZERO, |n| n.normalize_or_zero());
    data.positions.iter().map(|p| of(p).as_vec3()).collect()
}

fn corners(data: &MeshData, triangle: &[u32; 3]) -> Option<[DVec3; 3]> {
    let [a, b, c] = triangle.map(|i| data.positions.get(i as usize).copied());
    Some([a?, b?, c?])
}

fn posed(mut data: MeshData, stated: &setup::Mesh) -> MeshData {
    let turn = DQuat::from_scaled_axis(DVec3::from_array(stated.rotation_rad));
    let origin = DVec3::from_array(stated.position_m);
    data.positions.iter_mut().for_each(|p| *p = turn * (stated.unit_m * *p) + origin);
    data.normals.iter_mut().for_each(|n| *n = (turn * n.as_dvec3()).as_vec3());
    data
}

impl Surface for Posed {
    fn kind(&self) -> &'static str {
        "mesh"
    }

    fn hit(&self, origin: DVec3, ray: DVec3) -> Option<Hit> {
        let ray = Ray { origin, direction: ray };
        let crossing = self.mesh.closest(&ray, 0.0, f64::INFINITY)?;
        let [a, b, c] = self.mesh.corners(crossing.face);
        let face = (b - a).cross(c - a).normalize();
        let smooth = self.mesh.shading(crossing.face, crossing.uv).and_then(DVec3::try_normalize).unwrap_or(face);
        // The side that the camera sees is the outside, however the corners run.
        let face = if face.dot(ray.direction) > 0.0 { -face } else { face };
        let normal = if smooth.dot(face) < 0.0 { -smooth } else { smooth };
        Some(Hit { point: ray.at(crossing.t), normal, face })
    }

    fn middle(&self) -> DVec3 {
        let bounds = self.mesh.bounds();
        0.5 * (bounds.min + bounds.max)
    }

    fn is_convex(&self) -> bool {
        false
    }

    fn hides(&self, from: &Hit, towards: DVec3, distance: f64) -> bool {
        // What is behind the face itself is hidden by it.
        let ray = Ray { origin: from.point + self.off * from.face, direction: towards };
        from.face.dot(towards) <= 0.0 || self.mesh.is_crossed(&ray, 0.0, distance)
    }
}

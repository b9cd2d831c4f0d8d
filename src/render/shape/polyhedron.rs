//! Polyhedron: a closed solid with flat faces, each anticlockwise from outside.
//!
//! | | |
//! |---|---|
//! | crossing | even-odd in every face, watertight: a line enters and leaves through exactly as many faces, also where it meets edges and vertices |
//! | uv | on each face metres from its first corner, along its first edge and across it |
//! | tangent | along the first edge of the face |
//! | directions | of a convex one seen from outside, uniform over the solid angle; else points uniform over the area |
//! | projected solid angle | of a convex one, the sum over the faces that are seen; π from inside |
//!
//! Every ray is tested against every face: for more than some dozens of faces a mesh is faster.

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::chart::Chart;
use super::error::{ShapeError, finite};
use super::patches::{Patch, Patches};
use super::polygon::Face;
use super::rounding::cross;
use super::shear::{Shear, passes_through};
use super::{Bounds, Shape, outline, pdf_of_point, spherical, towards_point};
use crate::render::ray::{Crossing, Ray, SurfacePoint, Towards};

/// A polyhedron in world coordinates.
#[derive(Debug, Clone)]
pub struct Polyhedron {
    faces: Vec<(Face, Vec<DVec3>)>,
    patches: Patches,
    bounds: Bounds,
    is_convex: bool,
}

impl Polyhedron {
    /// The solid with these vertices (m) and faces (indices of vertices, anticlockwise from outside; at least three each, flat within
    /// 1e-6 of its extent).
    ///
    /// # Errors
    ///
    /// A face that is no flat simple polygon, an edge that is not shared by two faces, faces clockwise from outside.
    pub fn new(vertices: &[DVec3], faces: &[Vec<usize>]) -> Result<Self, ShapeError> {
        if faces.len() < 4 {
            return Err(ShapeError::TooFew { what: "faces", count: faces.len(), least: 4 });
        }
        for &vertex in vertices {
            finite("vertex", vertex)?;
        }
        let mut made = Vec::with_capacity(faces.len());
        let mut patches = Vec::new();
        for (index, face) in faces.iter().enumerate() {
            let place = |&vertex: &usize| {
                let last = vertices.len().saturating_sub(1);
                vertices.get(vertex).copied().ok_or(ShapeError::NoVertex { face: index, vertex, last })
            };
            let corners = face.iter().map(place).collect::<Result<Vec<_>, _>>()?;
            let number = u32::try_from(index).unwrap_or(u32::MAX);
            let wrong = |error| ShapeError::Face { face: index, error: Box::new(error) };
            let (face, triangles) = Face::new(&corners, number).map_err(wrong)?;
            made.push((face, corners));
            patches.extend(triangles);
        }
        check_closed(faces)?;
        let origin = vertices[0];
        let volume = patches.iter().map(|p| {
            let [a, b, c] = p.corners.map(|p| p - origin);
            a.dot(cross(b, c)) / 6.0
        });
        let volume: f64 = volume.sum();
        if volume <= 0.0 {
            return Err(ShapeError::InsideOut { volume });
        }
        let bounds = Bounds::of(made.iter().flat_map(|(_, corners)| corners.iter().copied()));
        let reach = 1e-6 * (bounds.max - bounds.min).length();
        let is_convex = made.iter().all(|(face, _)| {
            let all = made.iter().flat_map(|(_, corners)| corners);
            all.into_iter().all(|&p| face.facet.height(p) <= reach)
        });
        Ok(Self { faces: made, patches: Patches::new(patches), bounds, is_convex })
    }

    /// The rectangular box between two opposite corners (m).
    ///
    /// # Errors
    ///
    /// What is not finite, or no extent along an axis.
    pub fn cuboid(min: DVec3, max: DVec3) -> Result<Self, ShapeError> {
        let (min, max) = (min.min(max), min.max(max));
        let vertices: Vec<DVec3> = (0..8)
            .map(|i| {
                let pick = |bit: u32, low: f64, high: f64| if i >> bit & 1 == 1 { high } else { low };
                DVec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z))
            })
            .collect();
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        Self::new(&vertices, &faces.map(|f| f.to_vec()))
    }

    /// Whether no face can hide another from outside.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        self.is_convex
    }

    fn face(&self, index: u32) -> &Face {
        &self.faces[index as usize].0
    }

    fn faces_towards(&self, from: DVec3) -> impl Fn(&Patch) -> bool {
        move |patch| self.face(patch.face).facet.height(from) > 0.0
    }

    /// Solid angle of the faces turned to a point outside of a convex one; `None` where directions are not drawn from it.
    fn solid_angle(&self, from: DVec3) -> Option<f64> {
        let omega = self.is_convex.then(|| self.patches.solid_angle(from, self.faces_towards(from)))?;
        spherical::RANGE_SR.contains(&omega).then_some(omega)
    }
}

/// Every edge of every face must stand once in another face, the other way round.
fn check_closed(faces: &[Vec<usize>]) -> Result<(), ShapeError> {
    let edges =
        || faces.iter().flat_map(|face| face.iter().zip(face.iter().cycle().skip(1)).map(|(&from, &to)| (from, to)));
    let mut counts: HashMap<(usize, usize), usize> = HashMap::new();
    edges().for_each(|edge| *counts.entry(edge).or_default() += 1);
    for (from, to) in edges() {
        let back = counts.get(&(to, from)).copied().unwrap_or(0);
        if back != 1 || counts[&(from, to)] != 1 {
            return Err(ShapeError::Open { from, to, back });
        }
    }
    Ok(())
}

impl Shape for Polyhedron {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        let shear = Shear::new(ray);
        let mut nearest: Option<Crossing> = None;
        for (index, (face, corners)) in (0..).zip(&self.faces) {
            let limit = nearest.map_or(far, |c| c.t);
            let Some(t) = face.facet.cross(ray, near, limit) else { continue };
            if passes_through(&shear, corners.iter().copied()) {
                nearest = Some(Crossing { t, uv: DVec2::ZERO, face: index });
            }
        }
        nearest
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.face(crossing.face).point(ray.at(crossing.t))
    }

    fn charts(&self) -> Vec<(u32, Chart)> {
        self.patches.charts()
    }

    fn area(&self) -> f64 {
        self.patches.area()
    }

    fn sample_area(&self, u: [f64; 3]) -> SurfacePoint {
        let (position, face) = self.patches.sample_area(u);
        self.face(face).point(position)
    }

    fn sample_towards(&self, from: DVec3, u: [f64; 3]) -> Option<Towards> {
        let Some(omega) = self.solid_angle(from) else {
            return towards_point(self.area(), from, &self.sample_area(u));
        };
        let (direction, patch) = self.patches.sample(from, omega, self.faces_towards(from), u)?;
        let distance = self.face(patch.face).facet.distance(from, direction);
        (distance > 0.0).then_some(Towards { direction, distance, pdf: 1.0 / omega, delta: false })
    }

    fn pdf_towards(&self, from: DVec3, point: &SurfacePoint) -> f64 {
        self.solid_angle(from).map_or_else(|| pdf_of_point(self.area(), from, point), |omega| 1.0 / omega)
    }

    fn projected_solid_angle(&self, from: DVec3, normal: DVec3) -> Option<f64> {
        if !self.is_convex {
            return None;
        }
        let seen = || self.faces.iter().filter(|(face, _)| face.facet.height(from) > 0.0);
        if seen().next().is_none() {
            return Some(PI);
        }
        let of = |(face, corners): &(Face, Vec<DVec3>)| {
            outline::projected(corners.iter().copied(), &face.facet, from, normal)
        };
        Some(seen().map(of).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron(faces: [[usize; 3]; 4]) -> Result<Polyhedron, ShapeError> {
        let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        Polyhedron::new(&vertices, &faces.map(|f| f.to_vec()))
    }

    #[test]
    fn bad_solids_are_named() {
        let good = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        assert!(tetrahedron(good).is_ok_and(|t| t.is_convex()));
        let turned = good.map(|[a, b, c]| [a, c, b]);
        assert!(
            matches!(tetrahedron(turned), Err(ShapeError::InsideOut { volume }) if (volume + 1.0 / 6.0).abs() < 1e-15)
        );
        let one_turned = [[0, 1, 2], good[1], good[2], good[3]];
        assert!(matches!(tetrahedron(one_turned), Err(ShapeError::Open { .. })));
        let beyond = [good[0], good[1], good[2], [1, 2, 4]];
        assert_eq!(tetrahedron(beyond).unwrap_err(), ShapeError::NoVertex { face: 3, vertex: 4, last: 3 });
        let flat = [good[0], good[1], good[2], [1, 2, 2]];
        assert!(matches!(tetrahedron(flat), Err(ShapeError::Face { face: 3, .. })));
        assert!(matches!(Polyhedron::new(&[], &[]), Err(ShapeError::TooFew { what: "faces", .. })));
        assert!(Polyhedron::cuboid(DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0)).is_err());
    }

    #[test]
    fn a_box_seen_face_on_is_its_face() {
        let solid = Polyhedron::cuboid(DVec3::new(-1.0, -1.0, 1.0), DVec3::new(1.0, 1.0, 2.0)).unwrap();
        // 4·s·atan(s), s = 1/√2: a square of side 2 at the distance 1.
        let s = 1.0 / 2.0_f64.sqrt();
        let got = solid.projected_solid_angle(DVec3::ZERO, DVec3::Z).unwrap();
        assert!((got - 4.0 * s * s.atan()).abs() < 1e-14, "{got}");
        assert_eq!(solid.projected_solid_angle(DVec3::new(0.1, 0.2, 1.5), DVec3::X), Some(PI));
        assert!((solid.area() - 16.0).abs() < 1e-14);
    }
}

//! Cylinder: a tube of circular section, open or closed by caps at both ends; its outside is away from the axis.
//!
//! | | |
//! |---|---|
//! | crossing | stable quadratic across the axis; the capped one is the common part of an infinite cylinder and a slab, which no ray inside can miss |
//! | uv | on the tube (φ/2π, height/length), on the caps (φ/2π, r/R); φ from the first tangent of the axis ([`tangents`]) |
//! | tangent | around the axis, towards greater φ |
//! | face | 0 the tube, 1 the cap at the base, 2 the one at the other end |
//! | directions | to points uniform over the area: the tube may hide itself |

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::chart::Chart;
use super::error::{ShapeError, direction, finite, positive};
use super::rounding::gamma;
use super::{Bounds, Shape};
use crate::geometry::direction::{phi, tangents};
use crate::math::sampling;
use crate::render::ray::{Crossing, Ray, SurfacePoint};

/// A cylinder in world coordinates.
#[derive(Debug, Clone)]
pub struct Cylinder {
    base: DVec3,
    /// Its own axes; the third is the cylinder's, towards the other end.
    axes: [DVec3; 3],
    length: f64,
    radius: f64,
    capped: bool,
}

impl Cylinder {
    /// The tube of `radius` (m, positive) about the line between the points `base` and `end` (m), with a disk at each if `capped`.
    ///
    /// # Errors
    ///
    /// What is not finite or positive, or ends that coincide.
    pub fn new(base: DVec3, end: DVec3, radius: f64, capped: bool) -> Result<Self, ShapeError> {
        let along = finite("end", end)? - finite("base", base)?;
        let axis = direction("axis", along)?;
        let (x, y) = tangents(axis);
        Ok(Self {
            base,
            axes: [x, y, axis],
            length: positive("length", along.dot(axis))?,
            radius: positive("radius", radius)?,
            capped,
        })
    }

    fn local(&self, v: DVec3) -> DVec3 {
        let [x, y, z] = self.axes;
        DVec3::new(x.dot(v), y.dot(v), z.dot(v))
    }

    fn area_of_tube(&self) -> f64 {
        TAU * self.radius * self.length
    }

    fn area_of_cap(&self) -> f64 {
        PI * self.radius * self.radius
    }

    /// The point of a face next to a local point.
    fn point(&self, local: DVec3, face: u32) -> SurfacePoint {
        let [x, y, z] = self.axes;
        let length = local.x.hypot(local.y);
        let (cos, sin) = if length > 0.0 { (local.x / length, local.y / length) } else { (1.0, 0.0) };
        let outwards = cos * x + sin * y;
        let turn = phi(DVec3::new(cos, sin, 0.0)) / TAU;
        let (position, normal, v) = match face {
            0 => (self.base + self.radius * outwards + local.z * z, outwards, local.z / self.length),
            1 => (self.base + length * outwards, -z, length / self.radius),
            _ => (self.base + length * outwards + self.length * z, z, length / self.radius),
        };
        SurfacePoint {
            position,
            // Roundings of the local coordinates, here and where the next ray is brought into them, and of the sum.
            error: gamma(16.0) * (self.radius + self.length) + gamma(4.0) * position.length(),
            normal,
            shading: normal,
            tangent: cos * y - sin * x,
            uv: DVec2::new(turn, v),
        }
    }
}

/// Where a local ray is within the infinite cylinder of `radius` about z.
fn within_tube(origin: DVec3, direction: DVec3, radius: f64) -> Option<[f64; 2]> {
    let a = direction.x * direction.x + direction.y * direction.y;
    let distance = origin.x.hypot(origin.y);
    if a == 0.0 {
        return (distance <= radius).then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let b = -(origin.x * direction.x + origin.y * direction.y);
    // √a times the distance between ray and axis.
    let across = origin.x * direction.y - origin.y * direction.x;
    let discriminant = a * radius * radius - across * across;
    if discriminant < 0.0 {
        return None;
    }
    let q = b + discriminant.sqrt().copysign(b);
    let (s, t) = (q / a, (distance - radius) * (distance + radius) / q);
    Some([s.min(t), s.max(t)])
}

impl Shape for Cylinder {
    fn bounds(&self) -> Bounds {
        let n = self.axes[2];
        let half = self.radius * DVec3::new(n.y.hypot(n.z), n.z.hypot(n.x), n.x.hypot(n.y));
        let end = self.base + self.length * n;
        Bounds { min: self.base.min(end) - half, max: self.base.max(end) + half }
    }

    fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
        let (origin, direction) = (self.local(ray.origin - self.base), self.local(ray.direction));
        let tube = within_tube(origin, direction, self.radius)?;
        let asked = |t: f64| near < t && t < far;
        if !self.capped {
            let on_it = |t: f64| (0.0..=self.length).contains(&(origin.z + t * direction.z));
            let t = tube.into_iter().find(|&t| asked(t) && on_it(t))?;
            return Some(Crossing { t, uv: DVec2::ZERO, face: 0 });
        }
        let slab = if direction.z == 0.0 {
            if !(0.0..=self.length).contains(&origin.z) {
                return None;
            }
            [f64::NEG_INFINITY, f64::INFINITY]
        } else {
            let [s, t] = [-origin.z / direction.z, (self.length - origin.z) / direction.z];
            [s.min(t), s.max(t)]
        };
        let (first, second) = if direction.z > 0.0 { (1, 2) } else { (2, 1) };
        let entry = if tube[0] >= slab[0] { (tube[0], 0) } else { (slab[0], first) };
        let exit = if tube[1] <= slab[1] { (tube[1], 0) } else { (slab[1], second) };
        if entry.0 > exit.0 {
            return None;
        }
        let (t, face) = [entry, exit].into_iter().find(|&(t, _)| asked(t))?;
        Some(Crossing { t, uv: DVec2::ZERO, face })
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        self.point(self.local(ray.origin - self.base + crossing.t * ray.direction), crossing.face)
    }

    fn charts(&self) -> Vec<(u32, Chart)> {
        let ([x, y, z], base) = (self.axes, self.base);
        let (length, radius) = (self.length, self.radius);
        let side = Chart::Tube { base, axes: self.axes, length, radius };
        let end = |centre, axes| Chart::Ring { centre, axes, radii: [0.0, radius] };
        let ends = [(1, end(base, [y, x])), (2, end(base + length * z, [x, y]))];
        std::iter::once((0, side)).chain(ends.into_iter().filter(|_| self.capped)).collect()
    }

    fn area(&self) -> f64 {
        self.area_of_tube() + if self.capped { 2.0 * self.area_of_cap() } else { 0.0 }
    }

    fn sample_area(&self, [choice, u, v]: [f64; 3]) -> SurfacePoint {
        let chosen = choice * self.area();
        if chosen < self.area_of_tube() {
            let (y, x) = (TAU * u).sin_cos();
            return self.point(DVec3::new(x, y, v * self.length), 0);
        }
        let p = self.radius * sampling::disk([u, v]);
        self.point(p.extend(0.0), if chosen < self.area_of_tube() + self.area_of_cap() { 1 } else { 2 })
    }
}

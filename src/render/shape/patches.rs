//! A flat or closed surface cut into triangles: points uniform over its area, directions uniform over its solid angle.

use glam::DVec3;

use super::chart::Chart;
use super::rounding::cross;
use super::spherical;
use super::triangle::uniform_weights;
use crate::geometry::solid_angle;

/// A triangle of a surface and the face that it is part of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch {
    pub corners: [DVec3; 3],
    pub face: u32,
}

impl Patch {
    /// Solid angle seen from a point, sr.
    fn solid_angle(&self, from: DVec3) -> f64 {
        let [a, b, c] = self.corners.map(|p| p - from);
        solid_angle::triangle(a, b, c)
    }
}

/// The triangles of a surface.
#[derive(Debug, Clone)]
pub(super) struct Patches {
    patches: Vec<Patch>,
    /// Area up to and with each, m².
    areas: Vec<f64>,
}

impl Patches {
    /// Of at least one triangle.
    pub fn new(patches: Vec<Patch>) -> Self {
        let mut total = 0.0;
        let areas = patches.iter().map(|p| {
            let [a, b, c] = p.corners;
            total += 0.5 * cross(b - a, c - a).length();
            total
        });
        Self { areas: areas.collect(), patches }
    }

    /// The triangles, each with the number of its face.
    pub fn charts(&self) -> Vec<(u32, Chart)> {
        self.patches.iter().map(|p| (p.face, Chart::Triangle(p.corners))).collect()
    }

    /// Area of all, m².
    pub fn area(&self) -> f64 {
        self.areas.last().copied().unwrap_or(0.0)
    }

    /// A point uniform over the area, and the face that it is on.
    pub fn sample_area(&self, u: [f64; 3]) -> (DVec3, u32) {
        let chosen = u[0] * self.area();
        let index = self.areas.partition_point(|&area| area <= chosen).min(self.patches.len() - 1);
        let Patch { corners: [a, b, c], face } = self.patches[index];
        let weights = uniform_weights([u[1], u[2]]);
        (a + weights.x * (b - a) + weights.y * (c - a), face)
    }

    /// Solid angle of those that `seen` admits, from a point, sr.
    pub fn solid_angle(&self, from: DVec3, seen: impl Fn(&Patch) -> bool) -> f64 {
        self.patches.iter().filter(|&p| seen(p)).map(|p| p.solid_angle(from)).sum()
    }

    /// A direction uniform over the solid angle `omega` of those that `seen` admits, and the patch that it is in.
    pub fn sample(
        &self,
        from: DVec3,
        omega: f64,
        seen: impl Fn(&Patch) -> bool,
        u: [f64; 3],
    ) -> Option<(DVec3, &Patch)> {
        let mut left = u[0] * omega;
        let mut chosen = None;
        for patch in self.patches.iter().filter(|&p| seen(p)) {
            let own = patch.solid_angle(from);
            if own > 0.0 {
                chosen = Some((patch, own));
                if left < own {
                    break;
                }
            }
            left -= own;
        }
        let (patch, own) = chosen?;
        let [a, b, c] = patch.corners.map(|p| p - from);
        Some((spherical::sample(a, b, c, own, [u[1], u[2]])?, patch))
    }
}

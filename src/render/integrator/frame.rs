//! The frame of a surface point.

use glam::DVec3;

/// Orthonormal: +z the normal, +x the tangent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    x: DVec3,
    y: DVec3,
    z: DVec3,
}

impl Frame {
    /// From a unit normal and a unit vector across it.
    #[must_use]
    pub fn of(normal: DVec3, tangent: DVec3) -> Self {
        Self { x: tangent, y: normal.cross(tangent), z: normal }
    }

    /// A world direction in this frame.
    #[must_use]
    pub fn local(&self, d: DVec3) -> DVec3 {
        DVec3::new(d.dot(self.x), d.dot(self.y), d.dot(self.z))
    }

    /// A direction of this frame in the world.
    #[must_use]
    pub fn world(&self, d: DVec3) -> DVec3 {
        d.x * self.x + d.y * self.y + d.z * self.z
    }
}

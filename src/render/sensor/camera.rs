//! Cameras: from a place on the picture to a ray.

use glam::{DVec2, DVec3};

use crate::render::ray::Ray;

/// A camera without lens faults: radiance along the ray through a point of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    position: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Half the picture's extent at distance 1, horizontally and vertically.
    half: DVec2,
    width: u32,
    height: u32,
}

/// Why a camera was refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// It looks at its own place, or along its upward direction, or a number is not finite.
    #[error("a camera at {position} that looks at {target} with {up} upwards; expected three different directions")]
    Frame {
        /// Where it stands.
        position: DVec3,
        /// What it looks at.
        target: DVec3,
        /// Its upward direction.
        up: DVec3,
    },
    /// The field of view.
    #[error("a field of view of {degrees}°; expected more than 0° and less than 180°")]
    FieldOfView {
        /// What was found.
        degrees: f64,
    },
    /// No pixels.
    #[error("a picture of {width} × {height} pixels; expected at least one")]
    Resolution {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
}

impl Camera {
    /// A pinhole camera at `position` that looks at `target`; `field_of_view_deg` is the angle across its width.
    ///
    /// # Errors
    /// [`Error`].
    pub fn perspective(
        position: DVec3,
        target: DVec3,
        up: DVec3,
        field_of_view_deg: f64,
        [width, height]: [u32; 2],
    ) -> Result<Self, Error> {
        let forward = (target - position).normalize_or_zero();
        let right = forward.cross(up).normalize_or_zero();
        if !(position.is_finite() && forward.length() > 0.0 && right.length() > 0.0) {
            return Err(Error::Frame { position, target, up });
        }
        if !(field_of_view_deg > 0.0 && field_of_view_deg < 180.0) {
            return Err(Error::FieldOfView { degrees: field_of_view_deg });
        }
        if width == 0 || height == 0 {
            return Err(Error::Resolution { width, height });
        }
        let (w, h) = (f64::from(width), f64::from(height));
        let half = (0.5 * field_of_view_deg).to_radians().tan() * DVec2::new(w, h) / w;
        Ok(Self { position, right, up: right.cross(forward), forward, half, width, height })
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The ray through a point of the picture, in pixels from the upper left corner.
    #[must_use]
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let u = (2.0 * x / f64::from(self.width) - 1.0) * self.half.x;
        let v = (1.0 - 2.0 * y / f64::from(self.height)) * self.half.y;
        let direction = (self.forward + u * self.right + v * self.up).normalize();
        Ray { origin: self.position, direction }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_looks_at_the_target_and_the_edges_at_the_field_of_view() {
        let (from, to) = (DVec3::new(1.0, -2.0, 3.0), DVec3::new(1.0, 5.0, 3.0));
        let camera = Camera::perspective(from, to, DVec3::Z, 60.0, [400, 200]).unwrap();
        assert!((camera.ray(200.0, 100.0).direction - DVec3::Y).length() < 1e-15);
        // Right edge: 30° towards +x; the upper edge is half as far in tangent.
        let right = camera.ray(400.0, 100.0).direction;
        assert!((right.x / right.y - 30_f64.to_radians().tan()).abs() < 1e-15 && right.z.abs() < 1e-15, "{right}");
        let top = camera.ray(200.0, 0.0).direction;
        assert!((top.z / top.y - 0.5 * 30_f64.to_radians().tan()).abs() < 1e-15, "{top}");
    }

    #[test]
    fn a_camera_without_a_frame_is_refused() {
        let at = DVec3::ZERO;
        assert!(matches!(Camera::perspective(at, at, DVec3::Z, 60.0, [1, 1]), Err(Error::Frame { .. })));
        assert!(matches!(Camera::perspective(at, DVec3::Z, DVec3::Z, 60.0, [1, 1]), Err(Error::Frame { .. })));
        assert!(matches!(Camera::perspective(at, DVec3::X, DVec3::Z, 180.0, [1, 1]), Err(Error::FieldOfView { .. })));
        assert!(matches!(Camera::perspective(at, DVec3::X, DVec3::Z, 60.0, [0, 1]), Err(Error::Resolution { .. })));
    }
}

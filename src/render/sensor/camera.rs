//! Cameras: from a place on the picture, and on the lens, to a ray.
//!
//! | camera | from the axis angle θ to the radius on the picture | source |
//! |---|---|---|
//! | perspective | tanθ, then the lens's distortion | [`crate::geometry::lens`] |
//! | thin lens | tanθ; everything at the focal distance is sharp | Kolb, Mitchell & Hanrahan, SIGGRAPH 1995 |
//! | fisheye | θ (equidistant) | K. Miyamoto, JOSA 54 (1964) |
//! | equirectangular | azimuth and elevation are the coordinates | |
//!
//! Pictures are looked at from behind: x grows to the right, y downwards, (0, 0) is the upper left corner of the upper left pixel.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};

use crate::geometry::lens::Distortion;
use crate::math::sampling;
use crate::render::ray::Ray;

/// How directions are laid out on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Straight lines stay straight but for the lens's distortion.
    Perspective {
        /// The angle across the picture's width, degrees, below 180; measured without distortion.
        field_of_view_deg: f64,
        /// Of the lens.
        distortion: Distortion,
    },
    /// Perspective through a lens of some extent.
    ThinLens {
        /// The angle across the picture's width, degrees, below 180.
        field_of_view_deg: f64,
        /// Radius of the aperture, m.
        aperture_radius_m: f64,
        /// Distance, along the axis, of the plane that is sharp, m.
        focus_m: f64,
    },
    /// The radius on the picture is proportional to the angle to the axis; dark beyond the circle.
    Fisheye {
        /// The angle across the circle, whose diameter is the picture's shorter side, degrees, up to 360.
        field_of_view_deg: f64,
    },
    /// All directions: the azimuth from left (−180°) to right, the elevation from top (90°) to bottom; the axis is the middle.
    Equirectangular,
}

/// Where a point of the scene is shown on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shown {
    /// From the left edge, pixels.
    pub x: f64,
    /// From the upper edge, pixels.
    pub y: f64,
    /// The place on the lens that its light passes.
    pub lens: DVec3,
    /// From the lens to the point, unit vector.
    pub direction: DVec3,
    /// From the lens to the point, m.
    pub distance: f64,
}

/// A camera that records radiance.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    position: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    projection: Projection,
    /// Tangent of half the field of view, of pictures that lie in a plane; else 0.
    tangent: f64,
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
    #[error("a field of view of {degrees}°; expected more than 0° and {below}")]
    FieldOfView {
        /// What was found.
        degrees: f64,
        /// The upper limit, in words.
        below: &'static str,
    },
    /// The lens of a thin-lens camera.
    #[error(
        "an aperture of radius {aperture_m} m focused at {focus_m} m; expected a radius of 0 or more and a distance above 0"
    )]
    Lens {
        /// Radius of the aperture, m.
        aperture_m: f64,
        /// Focal distance, m.
        focus_m: f64,
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
    /// A camera at `position` that looks at `target`.
    ///
    /// # Errors
    /// [`Error`].
    pub fn new(
        position: DVec3,
        target: DVec3,
        up: DVec3,
        projection: Projection,
        [width, height]: [u32; 2],
    ) -> Result<Self, Error> {
        let forward = (target - position).normalize_or_zero();
        let right = forward.cross(up).normalize_or_zero();
        if !(position.is_finite() && forward.length() > 0.0 && right.length() > 0.0) {
            return Err(Error::Frame { position, target, up });
        }
        let within = |degrees: f64, most: f64, below| {
            // Written so that a NaN is refused.
            if degrees > 0.0 && degrees <= most { Ok(()) } else { Err(Error::FieldOfView { degrees, below }) }
        };
        match projection {
            Projection::Perspective { field_of_view_deg, .. } => {
                within(field_of_view_deg, 180_f64.next_down(), "less than 180°")?;
            }
            Projection::ThinLens { field_of_view_deg, aperture_radius_m, focus_m } => {
                within(field_of_view_deg, 180_f64.next_down(), "less than 180°")?;
                if !(aperture_radius_m >= 0.0 && focus_m > 0.0 && aperture_radius_m.is_finite() && focus_m.is_finite())
                {
                    return Err(Error::Lens { aperture_m: aperture_radius_m, focus_m });
                }
            }
            Projection::Fisheye { field_of_view_deg } => within(field_of_view_deg, 360.0, "at most 360°")?,
            Projection::Equirectangular => {}
        }
        if width == 0 || height == 0 {
            return Err(Error::Resolution { width, height });
        }
        let tangent = match projection {
            Projection::Perspective { field_of_view_deg, .. } | Projection::ThinLens { field_of_view_deg, .. } => {
                (0.5 * field_of_view_deg).to_radians().tan()
            }
            Projection::Fisheye { .. } | Projection::Equirectangular => 0.0,
        };
        Ok(Self { position, right, up: right.cross(forward), forward, projection, tangent, width, height })
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

    /// Where it stands, m.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// The ray through a point of the picture, in pixels, and a point of the lens, two uniform numbers; `None` where the picture is
    /// dark whatever the scene.
    #[must_use]
    pub fn ray(&self, x: f64, y: f64, lens: [f64; 2]) -> Option<Ray> {
        // From −1 to 1 across the width; the same scale downwards.
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        let p = DVec2::new(2.0 * x - w, 2.0 * y - h) / w;
        let ray = |origin: DVec3, d: DVec3| {
            let direction = (d.x * self.right - d.y * self.up + d.z * self.forward).normalize();
            Some(Ray { origin, direction })
        };
        match self.projection {
            Projection::Perspective { distortion, .. } => {
                ray(self.position, distortion.undistort(p * self.tangent)?.extend(1.0))
            }
            Projection::ThinLens { focus_m, .. } => {
                let sharp = (p * self.tangent).extend(1.0) * focus_m;
                let through = self.through(lens);
                let origin = self.position + through.x * self.right - through.y * self.up;
                ray(origin, sharp - through.extend(0.0))
            }
            Projection::Fisheye { field_of_view_deg } => {
                let radius = DVec2::new(2.0 * x - w, 2.0 * y - h) / w.min(h);
                let r = radius.length();
                if r > 1.0 {
                    return None;
                }
                let (sin, cos) = (r * (0.5 * field_of_view_deg).to_radians()).sin_cos();
                let across = if r > 0.0 { radius * (sin / r) } else { DVec2::ZERO };
                ray(self.position, across.extend(cos))
            }
            Projection::Equirectangular => {
                let (sin, cos) = ((x / w - 0.5) * TAU).sin_cos();
                let (high, level) = (FRAC_PI_2 - y / h * PI).sin_cos();
                ray(self.position, DVec3::new(level * sin, -high, level * cos))
            }
        }
    }

    /// Where the picture shows a point, seen from a point of the lens, two uniform numbers as for [`Camera::ray`]; `None` where it does
    /// not. Whether something stands in between is not asked.
    #[must_use]
    pub fn show(&self, point: DVec3, lens: [f64; 2]) -> Option<Shown> {
        let lens = self.through(lens);
        let way = point - self.position - lens.x * self.right + lens.y * self.up;
        let distance = way.length();
        let direction = way / distance;
        let d = self.local(direction);
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        let place = |p: DVec2| DVec2::new(p.x * w + w, p.y * w + h) / 2.0;
        let shown = match self.projection {
            Projection::Perspective { distortion, .. } => {
                let ideal = ahead(d)?;
                let tangents = distortion.distort(ideal);
                // What the lens folds over is not what the pixel's ray meets.
                let back = distortion.undistort(tangents)?;
                if back.distance(ideal) > 1e-9 * (1.0 + ideal.length()) {
                    return None;
                }
                place(tangents / self.tangent)
            }
            Projection::ThinLens { focus_m, .. } => {
                let sharp = ahead(d)? + lens / focus_m;
                place(sharp / self.tangent)
            }
            Projection::Fisheye { field_of_view_deg } => {
                let across = d.truncate();
                let r = across.length().atan2(d.z) / (0.5 * field_of_view_deg).to_radians();
                if r > 1.0 {
                    return None;
                }
                let radius = across.normalize_or_zero() * r * w.min(h);
                DVec2::new(radius.x + w, radius.y + h) / 2.0
            }
            Projection::Equirectangular => {
                DVec2::new((d.x.atan2(d.z) / TAU + 0.5) * w, (FRAC_PI_2 + d.y.clamp(-1.0, 1.0).asin()) / PI * h)
            }
        };
        let within = shown.x >= 0.0 && shown.x < w && shown.y >= 0.0 && shown.y < h;
        let lens = self.position + lens.x * self.right - lens.y * self.up;
        (distance > 0.0 && within).then_some(Shown { x: shown.x, y: shown.y, lens, direction, distance })
    }

    /// Pixels per solid angle, 1/sr, about the rays in a direction (unit, world) that the picture shows: what a pixel's mean of the
    /// radiance weighs it with.
    #[must_use]
    pub fn pixels_per_solid_angle(&self, direction: DVec3) -> f64 {
        let d = self.local(direction);
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        let flat = || {
            let scale = 0.5 * w / self.tangent;
            scale * scale / (d.z * d.z * d.z)
        };
        match self.projection {
            Projection::Perspective { distortion, .. } => {
                let bent = ahead(d).map_or(0.0, |tangents| distortion.jacobian(tangents).determinant());
                flat() * bent
            }
            Projection::ThinLens { .. } => flat(),
            Projection::Fisheye { field_of_view_deg } => {
                let (sin, half) = (d.truncate().length(), (0.5 * field_of_view_deg).to_radians());
                // θ/sinθ
                let stretch = if sin > 0.0 { sin.atan2(d.z) / sin } else { 1.0 };
                (0.5 * w.min(h) / half).powi(2) * stretch
            }
            Projection::Equirectangular => w * h / (TAU * PI * d.x.hypot(d.z)),
        }
    }

    /// Whether its rays start from all over a lens, not from one point.
    #[must_use]
    pub fn has_lens(&self) -> bool {
        matches!(self.projection, Projection::ThinLens { .. })
    }

    /// Pixels of the picture.
    #[must_use]
    pub fn pixels(&self) -> f64 {
        f64::from(self.width) * f64::from(self.height)
    }

    /// A point of the lens, m from its middle, to the right and downwards.
    fn through(&self, lens: [f64; 2]) -> DVec2 {
        match self.projection {
            Projection::ThinLens { aperture_radius_m, .. } => sampling::disk(lens) * aperture_radius_m,
            _ => DVec2::ZERO,
        }
    }

    /// A direction of the world, to the right, downwards and forward.
    fn local(&self, direction: DVec3) -> DVec3 {
        DVec3::new(direction.dot(self.right), -direction.dot(self.up), direction.dot(self.forward))
    }
}

/// The tangents of a direction before the camera.
fn ahead(d: DVec3) -> Option<DVec2> {
    (d.z > 0.0).then(|| d.truncate() / d.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(projection: Projection) -> Result<Camera, Error> {
        let (from, to) = (DVec3::new(1.0, -2.0, 3.0), DVec3::new(1.0, 5.0, 3.0));
        Camera::new(from, to, DVec3::Z, projection, [400, 200])
    }

    fn perspective(field_of_view_deg: f64) -> Projection {
        Projection::Perspective { field_of_view_deg, distortion: Distortion::default() }
    }

    fn direction(camera: &Camera, x: f64, y: f64) -> DVec3 {
        camera.ray(x, y, [0.5; 2]).unwrap().direction
    }

    #[test]
    fn the_middle_looks_at_the_target_and_the_edges_at_the_field_of_view() {
        let camera = camera(perspective(60.0)).unwrap();
        assert!((direction(&camera, 200.0, 100.0) - DVec3::Y).length() < 1e-15);
        // Right edge: 30° towards +x; the upper edge is half as far in tangent.
        let right = direction(&camera, 400.0, 100.0);
        assert!((right.x / right.y - 30_f64.to_radians().tan()).abs() < 1e-15 && right.z.abs() < 1e-15, "{right}");
        let top = direction(&camera, 200.0, 0.0);
        assert!((top.z / top.y - 0.5 * 30_f64.to_radians().tan()).abs() < 1e-15, "{top}");
    }

    #[test]
    fn distortion_bends_rays_the_way_the_lens_does() {
        let distortion = Distortion { k1: -0.1, ..Distortion::default() };
        let camera = camera(Projection::Perspective { field_of_view_deg: 60.0, distortion }).unwrap();
        let d = direction(&camera, 400.0, 100.0);
        let seen = distortion.distort(DVec2::new(d.x / d.y, 0.0));
        assert!((seen.x - 30_f64.to_radians().tan()).abs() < 1e-13, "{seen}");
    }

    /// All rays through one pixel meet at the focal distance, wherever they pass the lens.
    #[test]
    fn a_thin_lens_is_sharp_at_its_focus() {
        let lens = Projection::ThinLens { field_of_view_deg: 60.0, aperture_radius_m: 0.05, focus_m: 2.0 };
        let (lens, pinhole) = (camera(lens).unwrap(), camera(perspective(60.0)).unwrap());
        let expected = pinhole.position + direction(&pinhole, 310.0, 20.0) * (2.0 / direction(&pinhole, 310.0, 20.0).y);
        for u in [[0.1, 0.2], [0.9, 0.4], [0.5, 0.99]] {
            let ray = lens.ray(310.0, 20.0, u).unwrap();
            assert!((ray.origin - pinhole.position).length() <= 0.05 && ray.origin != pinhole.position);
            assert!((ray.at((expected.y - ray.origin.y) / ray.direction.y) - expected).length() < 1e-14);
        }
    }

    #[test]
    fn fisheye_and_equirectangular_angles_are_proportional() {
        let fisheye = camera(Projection::Fisheye { field_of_view_deg: 180.0 }).unwrap();
        // Half the radius to the right: 45°.
        let d = direction(&fisheye, 250.0, 100.0);
        assert!((d - DVec3::new(1.0, 1.0, 0.0).normalize()).length() < 1e-15, "{d}");
        assert!(fisheye.ray(0.0, 0.0, [0.5; 2]).is_none());
        let all = camera(Projection::Equirectangular).unwrap();
        assert!((direction(&all, 300.0, 100.0) - DVec3::X).length() < 1e-15);
        assert!((direction(&all, 200.0, 0.0) - DVec3::Z).length() < 1e-15);
        assert!((direction(&all, 0.0, 100.0) - DVec3::NEG_Y).length() < 1e-15);
    }

    /// Every projection: the point that a pixel's ray meets is shown where the ray came from, through the same point of the lens; and
    /// the solid angle of a small square of the picture, from its rays, is its area over the pixels per solid angle.
    #[test]
    fn points_are_shown_where_their_rays_come_from() {
        let distortion = Distortion { k1: -0.05716, k2: 0.09202, p1: -0.00025, p2: 0.00228, k3: -0.01908 };
        for projection in [
            perspective(60.0),
            Projection::Perspective { field_of_view_deg: 70.0, distortion },
            Projection::ThinLens { field_of_view_deg: 50.0, aperture_radius_m: 0.1, focus_m: 1.5 },
            Projection::Fisheye { field_of_view_deg: 200.0 },
            Projection::Equirectangular,
        ] {
            let camera = camera(projection).unwrap();
            for (x, y) in [(200.0, 100.0), (201.5, 99.0), (150.2, 30.7), (270.9, 160.1)] {
                let lens = [0.3, 0.8];
                let ray = camera.ray(x, y, lens).unwrap();
                let shown = camera.show(ray.at(2.7), lens).unwrap();
                assert!((shown.x - x).abs() < 1e-9 && (shown.y - y).abs() < 1e-9, "{projection:?} {x} {y}: {shown:?}");
                assert!((shown.lens - ray.origin).length() < 1e-14 && (shown.distance - 2.7).abs() < 1e-13);
                assert!((shown.direction - ray.direction).length() < 1e-13);
                let h = 1e-3;
                let [left, right] = [x - h, x + h].map(|x| camera.ray(x, y, lens).unwrap().direction);
                let [up, down] = [y - h, y + h].map(|y| camera.ray(x, y, lens).unwrap().direction);
                // Central differences: an error of h² times third derivatives of some 1e-2 per pixel².
                let solid_angle = (right - left).cross(down - up).length();
                let pixels = camera.pixels_per_solid_angle(ray.direction) * solid_angle;
                assert!((pixels / (4.0 * h * h) - 1.0).abs() < 1e-6, "{projection:?} {x} {y}: {pixels}");
            }
        }
        // Behind the camera, beside the picture, beyond the circle, at the lens itself.
        let from = DVec3::new(1.0, -2.0, 3.0);
        let flat = camera(perspective(60.0)).unwrap();
        assert!(flat.show(from - DVec3::Y, [0.5; 2]).is_none() && flat.show(from, [0.5; 2]).is_none());
        assert!(flat.show(from + DVec3::new(2.0, 1.0, 0.0), [0.5; 2]).is_none());
        let fisheye = camera(Projection::Fisheye { field_of_view_deg: 180.0 }).unwrap();
        assert!(fisheye.show(from - 0.1 * DVec3::Y + DVec3::X, [0.5; 2]).is_none());
    }

    #[test]
    fn a_camera_that_cannot_be_is_refused() {
        let new = |from, to, projection, size| Camera::new(from, to, DVec3::Z, projection, size);
        let (at, to, size) = (DVec3::ZERO, DVec3::X, [1, 1]);
        assert!(matches!(new(at, at, perspective(60.0), size), Err(Error::Frame { .. })));
        assert!(matches!(new(at, DVec3::Z, perspective(60.0), size), Err(Error::Frame { .. })));
        assert!(matches!(new(at, to, perspective(180.0), size), Err(Error::FieldOfView { .. })));
        assert!(matches!(new(at, to, perspective(f64::NAN), size), Err(Error::FieldOfView { .. })));
        assert!(matches!(new(at, to, perspective(60.0), [0, 1]), Err(Error::Resolution { .. })));
        let lens = Projection::ThinLens { field_of_view_deg: 60.0, aperture_radius_m: 0.1, focus_m: 0.0 };
        assert!(matches!(new(at, to, lens, size), Err(Error::Lens { .. })));
    }
}

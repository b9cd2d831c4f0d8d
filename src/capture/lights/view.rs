//! Rays of pixels, and balls that they meet.

use glam::{DMat3, DVec2, DVec3};

use super::outline::Outline;
use crate::capture::Error;
use crate::capture::camera::Camera;
use crate::capture::setup;
use crate::geometry::direction::tangents;

/// How pixels look at balls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The camera; without it rays are parallel and lengths are pixels.
    pub camera: Option<Camera>,
    /// Right, down and forward as columns.
    axes: DMat3,
    position: DVec3,
}

/// A ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it begins.
    pub origin: DVec3,
    /// Where it goes, of length 1.
    pub towards: DVec3,
}

impl Ray {
    /// The point at a distance along it.
    #[must_use]
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + distance * self.towards
    }
}

/// A ball, in m; of parallel rays in pixels, its middle at z = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its centre.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
}

impl View {
    /// That of a stated camera, or parallel rays along −z with y upwards.
    ///
    /// # Errors
    /// [`Error::Setup`] for an `up` along `forward`, or without intrinsics.
    pub fn new(camera: Option<&setup::Camera>) -> Result<Self, Error> {
        let Some(camera) = camera else {
            let axes = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z);
            return Ok(Self { camera: None, axes, position: DVec3::ZERO });
        };
        let axes = camera.axes().ok_or_else(|| Error::Setup {
            found: format!("`up` {:?} along `forward` {:?}", camera.up, camera.forward),
            expected: "two directions across one another",
        })?;
        Ok(Self { camera: Some(camera.lens()?), axes, position: DVec3::from_array(camera.position_m) })
    }

    /// The same with focal lengths multiplied, the camera turned about its own axes by a rotation vector (rad) and shifted along them (m). Parallel
    /// rays stay as they are.
    #[must_use]
    pub fn moved(mut self, zoom: f64, turn: DVec3, shift: DVec3) -> Self {
        if let Some(camera) = &mut self.camera {
            camera.intrinsics.fx *= zoom;
            camera.intrinsics.fy *= zoom;
            self.position += self.axes * shift;
            let angle = turn.length();
            if angle > 0.0 {
                self.axes *= DMat3::from_axis_angle(turn / angle, angle);
            }
        }
        self
    }

    /// From the camera to a point, m; of parallel rays from the plane of the picture.
    #[must_use]
    pub fn distance(&self, point: DVec3) -> f64 {
        (point - self.position).length()
    }

    /// Right, down and forward of the picture as columns.
    #[must_use]
    pub fn axes(&self) -> DMat3 {
        self.axes
    }

    /// The ray of a place in the picture; `None` where the lens model has none.
    #[must_use]
    pub fn ray(&self, pixel: DVec2) -> Option<Ray> {
        match &self.camera {
            None => Some(Ray { origin: self.axes * pixel.extend(0.0), towards: self.axes.z_axis }),
            Some(camera) => {
                let towards = (self.axes * camera.direction(pixel)?).normalize();
                Some(Ray { origin: self.position, towards })
            }
        }
    }

    /// The place in the picture of a point.
    #[must_use]
    pub fn pixel(&self, point: DVec3) -> DVec2 {
        let local = self.axes.transpose() * (point - self.position);
        self.camera.map_or(local.truncate(), |c| c.project(local))
    }

    /// Towards the camera from a point, of length 1.
    #[must_use]
    pub fn back(&self, point: DVec3) -> DVec3 {
        if self.camera.is_some() { (self.position - point).normalize() } else { -self.axes.z_axis }
    }

    /// The outline of a ball: where rays touch it, at (1 − r²/d²) of the way d to its centre and r √(1 − r²/d²) beside it.
    #[must_use]
    pub fn outline(&self, ball: &Ball) -> Option<Outline> {
        let back = self.back(ball.centre);
        let (t, b) = tangents(back);
        let part2 = match self.camera {
            Some(_) => ball.radius * ball.radius / (self.position - ball.centre).length_squared(),
            None => 0.0,
        };
        let forward = if self.camera.is_some() { self.position - ball.centre } else { DVec3::ZERO };
        let touch = |k: u32| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 90.0).sin_cos();
            self.pixel(ball.centre + forward * part2 + ball.radius * (1.0 - part2).sqrt() * (cos * t + sin * b))
        };
        (part2 < 1.0).then(|| Outline::through((0..90).map(touch).collect())).flatten()
    }

    /// The ball with an outline: of parallel rays in pixels; of a camera by its radius.
    ///
    /// The rays d that touch a ball with its centre along c (|c| = 1) obey d·c = cos α: the least squares of d·(c/cos α) = 1 give c and α
    /// whatever the lens does to the outline; its distance is radius/sin α.
    ///
    /// # Errors
    /// [`Error::Setup`] without a radius for a camera, or an outline that is none of a ball.
    pub fn ball(&self, outline: &Outline, radius: Option<f64>) -> Result<Ball, Error> {
        if self.camera.is_none() {
            return Ok(Ball { centre: self.axes * outline.centre.extend(0.0), radius: outline.radius });
        }
        let radius = radius.ok_or_else(|| Error::Setup {
            found: "a ball of unknown size before a camera".to_owned(),
            expected: "`radius_m` of the [[ball]], or no [camera]: rays are parallel then",
        })?;
        let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
        for ray in outline.points.iter().filter_map(|p| self.ray(*p)) {
            let d = ray.towards;
            normal += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
            right += d;
        }
        let v = normal.inverse() * right;
        let sin2 = 1.0 - v.length_squared().recip();
        if !(v.is_finite() && sin2 > 0.0) {
            return Err(Error::Setup {
                found: "an outline that no ball before the camera has".to_owned(),
                expected: "the outline of a ball",
            });
        }
        Ok(Ball { centre: self.position + v.normalize() * radius / sin2.sqrt(), radius })
    }
}

impl Ball {
    /// The normal where a ray meets the ball.
    #[must_use]
    pub fn normal(&self, ray: Ray) -> Option<DVec3> {
        let to_origin = ray.origin - self.centre;
        let nearest = to_origin - to_origin.dot(ray.towards) * ray.towards;
        let half_chord2 = self.radius * self.radius - nearest.length_squared();
        (half_chord2 > 0.0).then(|| (nearest - half_chord2.sqrt() * ray.towards).normalize())
    }

    /// The ray that a mirror ball sends on.
    #[must_use]
    pub fn reflected(&self, ray: Ray) -> Option<Ray> {
        let n = self.normal(ray)?;
        let towards = ray.towards - 2.0 * ray.towards.dot(n) * n;
        Some(Ray { origin: self.centre + self.radius * n, towards })
    }

    /// Angle by which a reflected ray turns per pixel, rad: the larger of both ways, from differences of half a pixel.
    #[must_use]
    pub fn turn_per_pixel(&self, view: &View, pixel: DVec2) -> Option<f64> {
        let towards = |d: DVec2| Some(self.reflected(view.ray(pixel + d)?)?.towards);
        let along = |d: DVec2| Some(super::angle_deg(towards(d)?, towards(-d)?).to_radians());
        Some(f64::max(along(DVec2::new(0.5, 0.0))?, along(DVec2::new(0.0, 0.5))?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::Manifest;

    #[test]
    fn a_parallel_view_mirrors_as_photometric_stereo_has_it() {
        let view = View::new(None).unwrap();
        let ball = Ball { centre: DVec3::new(50.0, -40.0, 0.0), radius: 20.0 };
        // The middle faces the camera; at sin 45° to the right, the ray is turned by a right angle.
        let seen = |x: f64, y: f64| ball.reflected(view.ray(DVec2::new(x, y)).unwrap()).unwrap().towards;
        assert!(seen(50.0, 40.0).abs_diff_eq(DVec3::Z, 1e-15));
        assert!(seen(50.0 + 20.0 * 0.5_f64.sqrt(), 40.0).abs_diff_eq(DVec3::X, 1e-14));
        assert!(seen(50.0, 40.0 - 20.0 * 0.5_f64.sqrt()).abs_diff_eq(DVec3::Y, 1e-14));
        // Equal areas of the disc are equal solid angles: at the middle a pixel turns by 2/r.
        assert!((ball.turn_per_pixel(&view, DVec2::new(50.0, 40.0)).unwrap() - 2.0 / 20.0).abs() < 1e-4);
    }

    #[test]
    fn a_ball_is_found_from_its_outline_through_a_lens() {
        let text = "[camera]\nfx = 900\nfy = 880\ncx = 320\ncy = 240\ndistortion = [-0.1, 0.05, 0.001, -0.002, 0.0]\n";
        let view = View::new(Manifest::parse(text).unwrap().camera.as_ref()).unwrap();
        let ball = Ball { centre: DVec3::new(0.3, -0.2, 2.0), radius: 0.15 };
        // Points where rays from the origin touch: the circle at distance² = |c|² − r².
        let (c, d2) = (ball.centre, ball.centre.length_squared());
        let (across, along) = (ball.radius * (1.0 - ball.radius.powi(2) / d2).sqrt(), 1.0 - ball.radius.powi(2) / d2);
        let a = c.cross(DVec3::X).normalize();
        let b = c.normalize().cross(a);
        let touch = |k: i32| {
            let (sin, cos) = (0.1 * f64::from(k)).sin_cos();
            view.pixel(c * along + across * (cos * a + sin * b))
        };
        let outline = Outline::through((0..63).map(touch).collect()).unwrap();
        let found = view.ball(&outline, Some(ball.radius)).unwrap();
        assert!(found.centre.abs_diff_eq(ball.centre, 1e-9), "{found:?}");
        assert!(view.ball(&outline, None).is_err());
    }
}

//! Where the pixels of a camera look.

use glam::DVec3;

/// How a lens maps the angle θ from its axis to a distance r from the middle of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Projection {
    /// r = f tan θ: a pinhole, and lenses without distortion.
    Pinhole,
    /// r = f θ: equidistant fisheyes, `-vta` of Radiance.
    Equidistant,
}

/// A camera with square pixels whose axis passes through the middle of the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    projection: Projection,
    /// The middle of the picture, pixels from its upper left corner.
    middle: (f64, f64),
    /// Focal length, pixels.
    focal_px: f64,
}

impl View {
    /// The camera of a picture of `width` × `height` pixels that sees `fov_deg` from its left edge to its right one: more than
    /// 0°, and below 180° for a pinhole, up to 360° else. `None` outside of that.
    #[must_use]
    pub fn new(projection: Projection, fov_deg: f64, (width, height): (usize, usize)) -> Option<Self> {
        let (half, half_fov) = (0.5 * width as f64, 0.5 * fov_deg.to_radians());
        let (valid, focal_px) = match projection {
            Projection::Pinhole => (fov_deg < 180.0, half / half_fov.tan()),
            Projection::Equidistant => (fov_deg <= 360.0, half / half_fov),
        };
        let middle = (half, 0.5 * height as f64);
        (valid && fov_deg > 0.0 && width > 0).then_some(Self { projection, middle, focal_px })
    }

    /// The direction of a place in the picture, of length 1: x to the right, y downwards, z along the axis.
    #[must_use]
    pub fn direction(&self, x: f64, y: f64) -> DVec3 {
        let (x, y) = ((x - self.middle.0) / self.focal_px, (y - self.middle.1) / self.focal_px);
        match self.projection {
            Projection::Pinhole => DVec3::new(x, y, 1.0).normalize(),
            Projection::Equidistant => {
                let theta = x.hypot(y);
                let share = sinc(theta);
                DVec3::new(share * x, share * y, theta.cos())
            }
        }
    }

    /// Solid angle of the pixel around a place, sr: dω/dA at its middle times its area. For a pinhole cos³θ/f², for an
    /// equidistant lens (sin θ/θ)/f².
    #[must_use]
    pub fn solid_angle(&self, x: f64, y: f64) -> f64 {
        let r = (x - self.middle.0).hypot(y - self.middle.1) / self.focal_px;
        let share = match self.projection {
            Projection::Pinhole => (1.0 + r * r).powf(-1.5),
            // Beyond 180° there are no directions.
            Projection::Equidistant => sinc(r).max(0.0),
        };
        share / (self.focal_px * self.focal_px)
    }

    /// Whether a place looks anywhere: an equidistant lens ends at 180° from its axis.
    #[must_use]
    pub fn sees(&self, x: f64, y: f64) -> bool {
        let r = (x - self.middle.0).hypot(y - self.middle.1) / self.focal_px;
        self.projection == Projection::Pinhole || r <= std::f64::consts::PI
    }
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

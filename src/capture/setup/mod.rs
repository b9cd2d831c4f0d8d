//! Where camera, sphere and lights were: the part of a manifest that `capture brdf` reads. Lengths in metres, in any frame that all share.

mod light;
mod number;
mod object;

pub use light::{Flat, Lamp, Light, Place, Reference};
pub(super) use number::maybe_positive;
pub use object::{Ball, Cylinder, Mesh, Plane, Sphere};

use number::direction;

use std::num::NonZeroU32;

use glam::{DMat3, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::Error;
use super::camera::{self, Intrinsics};
use super::merge::State;
use crate::geometry::lens::Distortion;

/// A camera and where it stood. Without place and directions it stands at the origin of its own frame: x to the right, y downwards, z
/// forward.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Focal length along x, pixels. This and the next four: without them the views of the board tell them.
    #[serde(default, deserialize_with = "maybe_positive")]
    pub fx: Option<f64>,
    /// Focal length along y, pixels.
    #[serde(default, deserialize_with = "maybe_positive")]
    pub fy: Option<f64>,
    /// Column of the principal point; the centre of the first pixel is 0.
    #[serde(default)]
    pub cx: Option<f64>,
    /// Row of the principal point.
    #[serde(default)]
    pub cy: Option<f64>,
    /// k1, k2, p1, p2, k3 of the lens, as `capture calibrate` gives them.
    #[serde(default)]
    pub distortion: [f64; 5],
    /// Where it stood, m.
    #[serde(default)]
    pub position_m: [f64; 3],
    /// Where it looked.
    #[serde(default = "forward", deserialize_with = "direction")]
    pub forward: [f64; 3],
    /// What was up in the picture.
    #[serde(default = "up", deserialize_with = "direction")]
    pub up: [f64; 3],
    /// Of a computed picture whose samples are means over N × N evenly spaced places of a pixel: N, 1 for values at the centres. Without it
    /// samples are averages over the areas of pixels, as sensors make them.
    #[serde(default)]
    pub places_per_side: Option<NonZeroU32>,
}

fn forward() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

fn up() -> [f64; 3] {
    [0.0, -1.0, 0.0]
}

impl Camera {
    /// Intrinsics and lens.
    ///
    /// # Errors
    /// [`Error::Setup`] where one of the intrinsics is not stated.
    pub fn lens(&self) -> Result<camera::Camera, Error> {
        let (Some(fx), Some(fy), Some(cx), Some(cy)) = (self.fx, self.fy, self.cx, self.cy) else {
            return Err(Error::Setup {
                found: "a [camera] without fx, fy, cx and cy".to_owned(),
                expected: "all four, or a [board] whose views tell them",
            });
        };
        let [k1, k2, p1, p2, k3] = self.distortion;
        let intrinsics = Intrinsics { fx, fy, cx, cy };
        Ok(camera::Camera { intrinsics, distortion: Distortion { k1, k2, p1, p2, k3 } })
    }

    /// States intrinsics and lens.
    pub fn set_lens(&mut self, camera: &camera::Camera) {
        let (i, d) = (&camera.intrinsics, &camera.distortion);
        (self.fx, self.fy, self.cx, self.cy) = (Some(i.fx), Some(i.fy), Some(i.cx), Some(i.cy));
        self.distortion = [d.k1, d.k2, d.p1, d.p2, d.k3];
    }

    /// Variance of the places that a sample is a mean over, along x or y, px²: 1/12 for the area of a pixel.
    #[must_use]
    pub fn pixel_variance(&self) -> f64 {
        (1.0 - self.places_per_side.map_or(0.0, |n| f64::from(n.get()).powi(-2))) / 12.0
    }

    /// The axes of the camera (right, down, forward) as columns; `None` where `up` is along `forward`.
    #[must_use]
    pub fn axes(&self) -> Option<DMat3> {
        let forward = DVec3::from_array(self.forward).try_normalize()?;
        let right = forward.cross(DVec3::from_array(self.up)).try_normalize()?;
        Some(DMat3::from_cols(right, forward.cross(right), forward))
    }
}

/// What the samples of linear photographs mean, and which of them are used.
#[derive(Debug, Clone, Copy, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Radiance {
    /// Radiance of a sample of 1 at 1 s, W/(m² sr); without it only ratios are known, unless there is a reference.
    #[serde(deserialize_with = "maybe_positive")]
    pub unit_w_per_m2_sr: Option<f64>,
    /// Standard error of a sample in proportion to it; of pictures that have none of their own.
    #[serde(deserialize_with = "maybe_positive")]
    pub relative_error: Option<f64>,
    /// Standard error of a sample, in samples, which is there in the dark too.
    #[serde(deserialize_with = "maybe_positive")]
    pub absolute_error: Option<f64>,
    /// Samples up to this one are dark.
    pub dark: f64,
    /// Samples from this one on are saturated.
    #[serde(deserialize_with = "maybe_positive")]
    pub saturated: Option<f64>,
}

impl Radiance {
    /// What a sample is.
    #[must_use]
    pub fn state(&self, value: f64) -> State {
        match value {
            v if self.saturated.is_some_and(|s| v >= s) => State::Saturated,
            v if v > self.dark && v.is_finite() => State::Valid,
            _ => State::Dark,
        }
    }

    /// Whether standard errors of samples are stated.
    #[must_use]
    pub fn states_errors(&self) -> bool {
        self.relative_error.is_some() || self.absolute_error.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Manifest;
    use super::*;

    const TEXT: &str =
        "[camera]\nfx = 100\nfy = 100.0\ncx = 1.5\ncy = 2.5\nforward = [0.0, 0.0, -1.0]\nup = [0.0, 1.0, 0.0]\n
[sphere]\ncentre_m = [0.0, 0.0, 0.0]\nradius_m = 1.0\n
[[light]]\nname = \"a\"\nposition_m = [1.0, 2.0, 3.0]\nintensity_w_per_sr = [3.0, 2.0, 1.0]\n
[[light]]\nname = \"b\"\ndirection = [0.0, 0.0, 1.0]\nirradiance_w_per_m2 = 5.0\n";

    #[test]
    fn a_setup_is_read() {
        let m = Manifest::parse(TEXT).unwrap();
        assert_eq!(m.light[0].place, Place::Near([1.0, 2.0, 3.0]));
        assert_eq!(m.light[1].strength, Some(vec![5.0]));
        // Looking along −z with y up: x is to the right, y of the picture runs downwards.
        let axes = m.camera.unwrap().axes().unwrap();
        assert_eq!(axes, DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z));
        assert!(crate::capture::manifest::schema().to_string().contains("intensity_w_per_sr"));
    }

    #[test]
    fn mistakes_are_told_with_their_place() {
        let message = |from: &str, to: &str| Manifest::parse(&TEXT.replacen(from, to, 1)).unwrap_err().to_string();
        assert_eq!(message("fx = 100", "fx = -1"), "2:6: found -1; expected a number above 0");
        assert_eq!(message("radius_m = 1.0", "radius_m = 0.0"), "11:12: found 0; expected a number above 0");
        assert!(message("up = [0.0, 1.0", "up = [0.0, 0.0").starts_with("7:6: found [0.0, 0.0, 0.0]"));
        assert!(message("position_m = [1.0, 2.0, 3.0]\n", "").starts_with("13:1: light `a`; expected `position_m`"));
        assert!(
            message("irradiance_w_per_m2 = 5.0", "irradiance_w_per_m2 = \"5\"")
                .contains("expected a number, or a list")
        );
    }
}

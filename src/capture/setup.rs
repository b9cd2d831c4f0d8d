//! Where camera, sphere and lights were: the part of a manifest that `capture brdf` reads. Lengths in metres, in any frame that all share.

use std::num::NonZeroU32;

use glam::{DMat3, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{Deserializer, Error as _};

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

/// A sphere.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Its centre, m.
    pub centre_m: [f64; 3],
    /// Its radius, m.
    #[serde(deserialize_with = "positive")]
    pub radius_m: f64,
    /// A picture of the size of the photographs, brighter than half where its material is to be measured.
    #[serde(default)]
    pub mask: Option<String>,
}

/// A cylinder: its curved side.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// The middle of its axis, m.
    pub centre_m: [f64; 3],
    /// Along its axis.
    #[serde(deserialize_with = "direction")]
    pub axis: [f64; 3],
    /// Its radius, m.
    #[serde(deserialize_with = "positive")]
    pub radius_m: f64,
    /// Its length along the axis, m.
    #[serde(deserialize_with = "positive")]
    pub length_m: f64,
    /// A picture of the size of the photographs, brighter than half where its material is to be measured.
    #[serde(default)]
    pub mask: Option<String>,
}

/// A plane: one side of it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// A point of it, m: the middle of the rectangle.
    pub centre_m: [f64; 3],
    /// Its normal, towards the side of the camera.
    #[serde(deserialize_with = "direction")]
    pub normal: [f64; 3],
    /// Sides of the rectangle that is measured, across and along `up`, m; without it the plane has no end.
    #[serde(default, deserialize_with = "maybe_size")]
    pub size_m: Option<[f64; 2]>,
    /// What is up on it: tells how the rectangle lies.
    #[serde(default = "y_axis", deserialize_with = "direction")]
    pub up: [f64; 3],
    /// A picture of the size of the photographs, brighter than half where its material is to be measured.
    #[serde(default)]
    pub mask: Option<String>,
}

fn y_axis() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

/// A mesh of triangles in a file, and its pose: a point x of the file is at R · `unit_m` · x + `position_m`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// An OBJ or PLY file. The side of a face that the camera sees is its outside.
    pub file: String,
    /// Length of one unit of the file, m.
    #[serde(default = "one", deserialize_with = "positive")]
    pub unit_m: f64,
    /// Rotation vector of R: its axis times the angle, radians, as `capture calibrate` gives those of its views.
    #[serde(default)]
    pub rotation_rad: [f64; 3],
    /// Where the origin of the file is, m.
    #[serde(default)]
    pub position_m: [f64; 3],
    /// Faces are flat. Without it normals run smoothly from corner to corner: those of the file, or the means of the faces at a corner.
    #[serde(default)]
    pub flat: bool,
    /// A picture of the size of the photographs, brighter than half where its material is to be measured.
    #[serde(default)]
    pub mask: Option<String>,
}

fn one() -> f64 {
    1.0
}

/// A ball in the pictures that tell the lights: a mirror, or diffuse.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ball {
    /// The name that stacks use.
    pub name: String,
    /// A picture of the size of the photographs, brighter than half where the ball is.
    #[serde(default)]
    pub mask: Option<String>,
    /// Its outline, pixels: column and row of the middle, and radius.
    #[serde(default)]
    pub circle_px: Option<[f64; 3]>,
    /// Its centre, m: with a stated camera.
    #[serde(default)]
    pub centre_m: Option<[f64; 3]>,
    /// Its radius, m: with a stated camera.
    #[serde(default, deserialize_with = "maybe_positive")]
    pub radius_m: Option<f64>,
}

/// A light: near with `position_m`, or distant with `direction`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(try_from = "Stated")]
pub struct Light {
    /// The name that stacks use.
    pub name: String,
    /// Where it is.
    pub place: Place,
    /// Radiant intensity (near), W/sr, or irradiance of a surface that faces it (distant), W/m²; per band or one for all.
    pub strength: Option<Vec<f64>>,
}

/// Where a light is.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub enum Place {
    /// A point, m.
    Near([f64; 3]),
    /// Towards it.
    Distant([f64; 3]),
}

/// A light in words.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Stated {
    /// The name that stacks use.
    name: String,
    /// Where a near light is, m.
    #[serde(default)]
    position_m: Option<[f64; 3]>,
    /// Towards a distant light.
    #[serde(default)]
    direction: Option<[f64; 3]>,
    /// Radiant intensity of a near light, W/sr, per band (rising wavelengths) or one for all.
    #[serde(default)]
    intensity_w_per_sr: Option<PerBand>,
    /// Irradiance of a surface that faces a distant light, W/m², per band or one for all.
    #[serde(default)]
    irradiance_w_per_m2: Option<PerBand>,
}

/// One number, or one per band.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a number, or a list of numbers, one per band")]
enum PerBand {
    One(f64),
    Each(Vec<f64>),
}

impl From<PerBand> for Vec<f64> {
    fn from(value: PerBand) -> Self {
        match value {
            PerBand::One(v) => vec![v],
            PerBand::Each(all) => all,
        }
    }
}

impl TryFrom<Stated> for Light {
    type Error = String;

    fn try_from(s: Stated) -> Result<Self, String> {
        let (place, strength) = match (s.position_m, s.direction) {
            (Some(p), None) if s.irradiance_w_per_m2.is_none() => (Place::Near(p), s.intensity_w_per_sr),
            (None, Some(d)) if s.intensity_w_per_sr.is_none() => (Place::Distant(d), s.irradiance_w_per_m2),
            _ => {
                return Err(format!(
                    "light `{}`; expected `position_m` with `intensity_w_per_sr`, or `direction` with `irradiance_w_per_m2`",
                    s.name
                ));
            }
        };
        let (Place::Near(v) | Place::Distant(v)) = place;
        if !v.iter().all(|v| v.is_finite()) || place == Place::Distant([0.0; 3]) {
            return Err(format!(
                "light `{}` at {v:?}; expected finite numbers, and a direction of some length",
                s.name
            ));
        }
        let strength = strength.map(Vec::from);
        if strength.as_ref().is_some_and(|s| s.is_empty() || s.iter().any(|v| !(*v > 0.0 && v.is_finite()))) {
            return Err(format!("light `{}` with a strength of {strength:?}; expected numbers above 0", s.name));
        }
        Ok(Self { name: s.name, place, strength })
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

/// The evenly lit field that stacks with shows = "flat" show.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(try_from = "StatedFlat")]
pub struct Flat {
    /// Its radiance at the middle of the picture, W/(m² sr), per band or one for all.
    pub radiance: Vec<f64>,
}

/// The same in words.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct StatedFlat {
    /// Its radiance at the middle of the picture, W/(m² sr), per band or one for all.
    radiance_w_per_m2_sr: PerBand,
}

impl TryFrom<StatedFlat> for Flat {
    type Error = String;

    fn try_from(s: StatedFlat) -> Result<Self, String> {
        let radiance = Vec::from(s.radiance_w_per_m2_sr);
        if radiance.is_empty() || radiance.iter().any(|r| !(*r > 0.0 && r.is_finite())) {
            return Err(format!("a radiance of {radiance:?}; expected numbers above 0"));
        }
        Ok(Self { radiance })
    }
}

/// A diffuse sphere in the place of the object.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(try_from = "StatedReference")]
pub struct Reference {
    /// Its reflectance, per band or one for all.
    pub reflectance: Vec<f64>,
    /// Standard uncertainty of the reflectance, as many numbers; 0 where none was stated.
    pub reflectance_sd: Vec<f64>,
}

/// The same in words.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct StatedReference {
    /// Its reflectance, above 0 to 1, per band or one for all.
    reflectance: PerBand,
    /// Standard uncertainty (k = 1) of the reflectance, as its certificate states it, per band or one for all.
    #[serde(default)]
    reflectance_sd: Option<PerBand>,
}

impl TryFrom<StatedReference> for Reference {
    type Error = String;

    fn try_from(s: StatedReference) -> Result<Self, String> {
        let reflectance = Vec::from(s.reflectance);
        if reflectance.is_empty() || reflectance.iter().any(|r| !(*r > 0.0 && *r <= 1.0)) {
            return Err(format!("a reflectance of {reflectance:?}; expected numbers above 0 to 1"));
        }
        let mut reflectance_sd = s.reflectance_sd.map_or_else(|| vec![0.0], Vec::from);
        if reflectance_sd.len() == 1 {
            reflectance_sd = vec![reflectance_sd[0]; reflectance.len()];
        }
        let sound = reflectance_sd.len() == reflectance.len() && reflectance_sd.iter().all(|u| (0.0..1.0).contains(u));
        if !sound {
            return Err(format!(
                "a `reflectance_sd` of {reflectance_sd:?}; expected numbers from 0 to below 1, one or as many as reflectances"
            ));
        }
        Ok(Self { reflectance, reflectance_sd })
    }
}

fn checked<'de, D: Deserializer<'de>>(value: f64, sound: bool, expected: &str) -> Result<f64, D::Error> {
    if sound { Ok(value) } else { Err(D::Error::custom(format!("found {value}; expected {expected}"))) }
}

fn positive<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    let value = f64::deserialize(from)?;
    checked::<D>(value, value > 0.0 && value.is_finite(), "a number above 0")
}

pub(super) fn maybe_positive<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    positive(from).map(Some)
}

fn maybe_size<'de, D: Deserializer<'de>>(from: D) -> Result<Option<[f64; 2]>, D::Error> {
    let size = <[f64; 2]>::deserialize(from)?;
    if !size.iter().all(|s| *s > 0.0 && s.is_finite()) {
        return Err(D::Error::custom(format!("found {size:?}; expected two numbers above 0")));
    }
    Ok(Some(size))
}

fn direction<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 3], D::Error> {
    let value = <[f64; 3]>::deserialize(from)?;
    if DVec3::from_array(value).try_normalize().is_none() {
        return Err(D::Error::custom(format!("found {value:?}; expected a direction of some length")));
    }
    Ok(value)
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

//! Instruments of a scene.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::Vector;
use super::quantity::{Angle, Length, Share};

/// An instrument; one of the kinds.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// Its name; not two of one name.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// Report the spectrum with its colour figures.
    #[serde(default)]
    pub spectrum: bool,
    /// Sample until the standard error is this share of the reading.
    #[serde(default)]
    pub target: Option<Share>,
    /// Illuminance on a plane: at a point, on a grid, or on average over a shape.
    #[serde(default)]
    #[schemars(with = "Option<Illuminance>")]
    pub illuminance: Option<Spanned<Illuminance>>,
    /// Luminance as a spot meter sees it.
    #[serde(default)]
    #[schemars(with = "Option<Luminance>")]
    pub luminance: Option<Spanned<Luminance>>,
    /// Mean illuminance of a small upright cylinder's side.
    #[serde(default)]
    #[schemars(with = "Option<Upright>")]
    pub cylindrical: Option<Spanned<Upright>>,
    /// Mean illuminance of a small hemisphere.
    #[serde(default)]
    #[schemars(with = "Option<Upright>")]
    pub hemispherical: Option<Spanned<Upright>>,
    /// Mean illuminance of a small sphere.
    #[serde(default)]
    #[schemars(with = "Option<Upright>")]
    pub spherical: Option<Spanned<Upright>>,
    /// All flux that leaves the scene, as in an integrating sphere around it.
    #[serde(default)]
    #[schemars(with = "Option<IntegratingSphere>")]
    pub integrating_sphere: Option<Spanned<IntegratingSphere>>,
    /// The intensities of all that shines, as a lamp file.
    #[serde(default)]
    #[schemars(with = "Option<Goniophotometer>")]
    pub goniophotometer: Option<Spanned<Goniophotometer>>,
    /// The BRDF of a sample.
    #[serde(default)]
    #[schemars(with = "Option<Gonioreflectometer>")]
    pub gonioreflectometer: Option<Spanned<Gonioreflectometer>>,
    /// A picture.
    #[serde(default)]
    #[schemars(with = "Option<Camera>")]
    pub camera: Option<Spanned<Camera>>,
}

/// Where an illuminance meter reads: one of `at`, `grid`, `on`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Illuminance {
    /// A point, m.
    #[serde(default)]
    pub at: Option<Vector>,
    /// The way the meter at a point faces; upwards without it.
    #[serde(default)]
    pub normal: Option<Vector>,
    /// Points in the middles of the cells of a rectangle, which face as it does.
    #[serde(default)]
    pub grid: Option<Grid>,
    /// The mean over the outside of the shape of this name.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub on: Option<Spanned<String>>,
}

/// A grid of points on a rectangle, or around a sphere or a cylinder: `corner` and `edges`, or `on`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// A corner, m.
    #[serde(default)]
    pub corner: Option<Vector>,
    /// The two edges from it, m; the meters face the side from which the turn from the first to the second is anticlockwise.
    #[serde(default)]
    pub edges: Option<[Vector; 2]>,
    /// The outside of the rectangle, the sphere or the cylinder's side of this name.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub on: Option<Spanned<String>>,
    /// Points along each edge; around and along a cylinder, in longitude and height on a sphere.
    pub points: [u32; 2],
    /// Light map with isolux contours to write (PNG or SVG).
    #[serde(default)]
    pub isolux: Option<String>,
    /// Table of the points to write (CSV).
    #[serde(default)]
    pub csv: Option<String>,
}

/// A flux meter.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IntegratingSphere {}

/// A goniophotometer around everything, in C-planes.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Goniophotometer {
    /// The way of γ = 0; down (−z) without it.
    #[serde(default)]
    pub down: Option<Vector>,
    /// The way of C = 0 at γ = 90°; +x without it.
    #[serde(default)]
    pub c0: Option<Vector>,
    /// Between C-planes; 15° without it.
    #[serde(default)]
    pub c_step: Option<Angle>,
    /// Between angles γ; 5° without it.
    #[serde(default)]
    pub gamma_step: Option<Angle>,
    /// Lamp file to write: LM-63 (.ies) or EULUMDAT (.ldt).
    #[serde(default)]
    pub file: Option<String>,
}

/// A gonioreflectometer: a beam on a round spot of a sample, and detectors over it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gonioreflectometer {
    /// The middle of the spot, m.
    pub at: Vector,
    /// The way that the sample faces; upwards without it.
    #[serde(default)]
    pub normal: Option<Vector>,
    /// The way of φ = 0; +x without it.
    #[serde(default)]
    pub tangent: Option<Vector>,
    /// Radius of the spot.
    pub radius: Length,
    /// Angles of incidence.
    pub theta_i: Vec<Angle>,
    /// Azimuths of incidence, each with every angle; 0 without them.
    #[serde(default)]
    pub phi_i: Option<Vec<Angle>>,
    /// Between angles of reflection; 5° without it.
    #[serde(default)]
    pub theta_step: Option<Angle>,
    /// Between azimuths of reflection; 10° without it.
    #[serde(default)]
    pub phi_step: Option<Angle>,
    /// BRDF table to write: `.csv`, or `.binary` (MERL).
    #[serde(default)]
    pub file: Option<String>,
}

/// A spot meter.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Luminance {
    /// Where it stands, m.
    pub at: Vector,
    /// A point on its axis, m.
    pub look_at: Vector,
    /// The angle across its cone of acceptance; 1° without it.
    #[serde(default)]
    pub acceptance: Option<Angle>,
}

/// A meter for light from all sides.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Upright {
    /// Where, m.
    pub at: Vector,
    /// Its axis; upwards without it.
    #[serde(default)]
    pub axis: Option<Vector>,
}

/// A camera. Its pictures are written where a file is named.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Where it stands, m.
    pub at: Vector,
    /// What it looks at, m.
    pub look_at: Vector,
    /// The upward direction of the picture; z without it.
    #[serde(default)]
    pub up: Option<Vector>,
    /// Columns and rows.
    pub resolution: [u32; 2],
    /// How directions are laid out.
    #[serde(default)]
    pub projection: Projection,
    /// Angle across the width (perspective) or across the circle (fisheye).
    #[serde(default)]
    pub field_of_view: Option<Angle>,
    /// Of the lens (perspective): k1, k2, p1, p2, k3 as OpenCV has them.
    #[serde(default)]
    pub distortion: Option<[f64; 5]>,
    /// Radius of the aperture, for depth of field (perspective, with `focus`).
    #[serde(default)]
    pub aperture_radius: Option<Length>,
    /// Distance that is sharp.
    #[serde(default)]
    pub focus: Option<Length>,
    /// Spectral OpenEXR to write.
    #[serde(default)]
    pub exr: Option<String>,
    /// Luminance in false colours to write (PNG or SVG).
    #[serde(default)]
    pub falsecolor: Option<String>,
    /// Picture for the screen to write (PNG).
    #[serde(default)]
    pub picture: Option<String>,
}

/// How a camera lays out directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Projection {
    /// Straight lines stay straight.
    #[default]
    Perspective,
    /// Equidistant.
    Fisheye,
    /// All directions.
    Equirectangular,
}

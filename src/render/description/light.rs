//! Lights of a scene that are no surfaces.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::Vector;
use super::quantity::{Angle, Flux, Intensity, Irradiance, Length, Radiance};
use super::spectrum::SpectrumSource;

/// A light without a surface; one of the kinds.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Its name, for reports.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub name: Option<Spanned<String>>,
    /// Its colour; without one the same at every wavelength.
    #[serde(default)]
    #[schemars(with = "Option<SpectrumSource>")]
    pub spectrum: Option<Spanned<SpectrumSource>>,
    /// An isotropic point.
    #[serde(default)]
    #[schemars(with = "Option<Point>")]
    pub point: Option<Spanned<Point>>,
    /// A spot: cosine, or a hard cone.
    #[serde(default)]
    #[schemars(with = "Option<Spot>")]
    pub spot: Option<Spanned<Spot>>,
    /// A luminaire of a photometric file.
    #[serde(default)]
    #[schemars(with = "Option<Lamp>")]
    pub lamp: Option<Spanned<Lamp>>,
    /// Parallel light, or a disc in the sky such as the sun.
    #[serde(default)]
    #[schemars(with = "Option<Distant>")]
    pub distant: Option<Spanned<Distant>>,
    /// Surroundings: the same everywhere, or a picture of them.
    #[serde(default)]
    #[schemars(with = "Option<Environment>")]
    pub environment: Option<Spanned<Environment>>,
    /// A point under the controls of a production light.
    #[serde(default)]
    #[schemars(with = "Option<Barzel>")]
    pub barzel: Option<Spanned<Barzel>>,
    /// A CIE standard general sky, z upwards.
    #[serde(default)]
    #[schemars(with = "Option<Sky>")]
    pub sky: Option<Spanned<Sky>>,
    /// The sun by date and place: +x is east, +y north, +z up.
    #[serde(default)]
    #[schemars(with = "Option<Sun>")]
    pub sun: Option<Spanned<Sun>>,
}

/// An isotropic point: its flux or its intensity.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Where, m.
    pub at: Vector,
    /// Flux.
    #[serde(default)]
    pub flux: Option<Flux>,
    /// Intensity.
    #[serde(default)]
    pub intensity: Option<Intensity>,
}

/// A spot: its flux, or its intensity along the axis.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spot {
    /// Where, m.
    pub at: Vector,
    /// A point on its axis, m.
    pub aim: Vector,
    /// Half the angle of a cone of constant intensity; without it the intensity falls off as the cosine.
    #[serde(default)]
    pub half_angle: Option<Angle>,
    /// Flux.
    #[serde(default)]
    pub flux: Option<Flux>,
    /// Intensity along the axis.
    #[serde(default)]
    pub intensity: Option<Intensity>,
}

/// A luminaire.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lamp {
    /// LM-63, EULUMDAT or TM-33, beside the scene.
    pub file: String,
    /// Photometric centre, m.
    pub at: Vector,
    /// A point on its axis, m; without it it shines straight down.
    #[serde(default)]
    pub aim: Option<Vector>,
    /// Turn about the vertical, anticlockwise from above.
    #[serde(default)]
    pub rotation: Option<Angle>,
    /// Lift of the axis from straight down, towards C0.
    #[serde(default)]
    pub tilt: Option<Angle>,
    /// Turn about its own axis.
    #[serde(default)]
    pub spin: Option<Angle>,
    /// Flux, instead of the file's.
    #[serde(default)]
    pub flux: Option<Flux>,
    /// Factor on the output.
    #[serde(default = "one")]
    pub dimming: f64,
    /// It shines from all over the flat luminous opening that the file states, and not from a point.
    #[serde(default)]
    pub opening: bool,
}

/// Parallel light.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Distant {
    /// From where it comes.
    pub from: Vector,
    /// On a surface that faces it.
    pub irradiance: Irradiance,
    /// Angle across the disc that it comes from; without it parallel.
    #[serde(default)]
    pub diameter: Option<Angle>,
}

/// Surroundings.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Radiance from everywhere, or what white, R = G = B = 1, of a picture in colours stands for.
    #[serde(default)]
    pub radiance: Option<Radiance>,
    /// A picture, beside the scene: a spectral one in W/(m² sr nm), or one in colours.
    #[serde(default)]
    pub file: Option<String>,
    /// How it shows the directions.
    #[serde(default)]
    pub projection: Projection,
    /// Angle across the circle of a fisheye picture; 180 deg without it.
    #[serde(default)]
    pub field_of_view: Option<Angle>,
    /// Where the camera looked: the middle of the picture (of a mirror ball: the way to the ball); +x without it.
    #[serde(default)]
    pub look: Option<Vector>,
    /// The upward direction of the picture; +z without it.
    #[serde(default)]
    pub up: Option<Vector>,
}

/// How a picture shows the directions around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Projection {
    /// Azimuth and angle to the vertical along the sides.
    #[default]
    Equirectangular,
    /// A mirroring ball photographed from afar; square.
    MirrorBall,
    /// A circle whose radius grows with the angle (equidistant); square.
    Fisheye,
    /// A circle whose area grows with the solid angle; square.
    EquisolidFisheye,
}

/// A production light (R. Barzel 1997): an isotropic point to the side of its axis, and factors on it. The window is the plane one
/// metre before it, with +x to the right and +y up as one looks along the axis.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Barzel {
    /// Where, m.
    pub at: Vector,
    /// A point on its axis, m.
    pub aim: Vector,
    /// The upward direction of its window; +z without it.
    #[serde(default)]
    pub up: Option<Vector>,
    /// Flux that leaves it.
    #[serde(default)]
    pub flux: Option<Flux>,
    /// Intensity before all factors.
    #[serde(default)]
    pub intensity: Option<Intensity>,
    /// How it falls off with distance; the square law without it.
    #[serde(default)]
    pub falloff: Option<Falloff>,
    /// The intensity falls off as this power of the cosine to the axis.
    #[serde(default)]
    pub beam_exponent: f64,
    /// A soft shape on the window.
    #[serde(default)]
    pub shape: Option<SoftShape>,
    /// Moves the window (barn doors).
    #[serde(default)]
    pub shear: [f64; 2],
    /// Cut-on and cut-off along the axis.
    #[serde(default)]
    pub clip: Option<Clip>,
    /// Cards across the axis.
    #[serde(default)]
    pub blockers: Vec<Blocker>,
    /// A picture in the window.
    #[serde(default)]
    pub slide: Option<Slide>,
    /// Noise over the window.
    #[serde(default)]
    pub noise: Option<Noise>,
    /// Whether surfaces cast shadows in it.
    #[serde(default = "yes")]
    pub shadows: bool,
}

/// A falloff: a power of the distance that is the square law's value at the reference.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Falloff {
    /// The power, 0 to 10; 2 is physics.
    pub exponent: f64,
    /// Where it is the square law's value; 1 m without it.
    #[serde(default)]
    pub reference: Option<Length>,
    /// Within the reference it rises to so many times the value there, and no further.
    #[serde(default)]
    pub most: Option<f64>,
}

/// A region between two superellipses, full within the inner one.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SoftShape {
    /// Semi-axes of the inner one: tangents on the window, m on a card.
    pub inner: [f64; 2],
    /// Semi-axes of the outer one; without it the edge is hard.
    #[serde(default)]
    pub outer: Option<[f64; 2]>,
    /// 0 a rectangle, 1 an ellipse, up to 4.
    #[serde(default)]
    pub roundness: f64,
}

/// Where along the axis the light is.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clip {
    /// Full from here on; from the light on without it.
    #[serde(default)]
    pub near: Option<Length>,
    /// Length of the rise before it.
    #[serde(default)]
    pub near_edge: Option<Length>,
    /// Full to here; without an end without it.
    #[serde(default)]
    pub far: Option<Length>,
    /// Length of the fall behind it.
    #[serde(default)]
    pub far_edge: Option<Length>,
}

/// A card across the axis.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Blocker {
    /// Its distance from the light along the axis.
    pub depth: Length,
    /// Its middle across the axis, m.
    #[serde(default)]
    pub middle: [f64; 2],
    /// Its outline, m.
    pub outline: SoftShape,
    /// What it takes away, 0 to 1; all of it without.
    #[serde(default = "one")]
    pub opacity: f64,
}

/// A picture in the window: factors on the light.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Slide {
    /// A picture, beside the scene.
    pub file: String,
    /// Half of its extents on the window (tangents).
    pub half: [f64; 2],
}

/// Noise over the window.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// Cells per unit of the window.
    pub frequency: f64,
    /// What it takes away at most, 0 to 1.
    pub amplitude: f64,
    /// Which noise.
    #[serde(default)]
    pub seed: u32,
}

/// A sky: its radiance at the zenith, or what it makes on the horizontal.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sky {
    /// 1 to 15 as ISO 15469 numbers them, 16 for the traditional overcast sky.
    #[schemars(range(min = 1, max = 16))]
    pub r#type: u8,
    /// Radiance at the zenith.
    #[serde(default)]
    pub zenith: Option<Radiance>,
    /// Irradiance of the sky without the sun on the horizontal.
    #[serde(default)]
    pub horizontal: Option<Irradiance>,
    /// The direction to the sun, which shapes the sky and is not in it; the zenith without it.
    #[serde(default)]
    pub sun: Option<Vector>,
}

/// The sun.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sun {
    /// A date-time of TOML with its offset: `2026-06-21T12:00:00+02:00`.
    #[schemars(with = "String")]
    pub date: Spanned<toml::value::Datetime>,
    /// Geographic latitude, north positive.
    pub latitude: Angle,
    /// Geographic longitude, east positive.
    pub longitude: Angle,
    /// On a surface that faces it.
    pub irradiance: Irradiance,
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}

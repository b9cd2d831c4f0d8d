//! Lights of a scene that are no surfaces.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::Vector;
use super::quantity::{Angle, Flux, Intensity, Irradiance, Radiance};
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
    pub spectrum: Option<SpectrumSource>,
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
    /// Surroundings that are the same everywhere.
    #[serde(default)]
    #[schemars(with = "Option<Environment>")]
    pub environment: Option<Spanned<Environment>>,
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

/// Constant surroundings.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Radiance from everywhere.
    pub radiance: Radiance,
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

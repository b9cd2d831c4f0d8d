//! Scenes in words: TOML in, a typed and checked description out. No file is opened here.
//!
//! The structures below are the format: what they do not name is an error with its line and column, and
//! [`schema`] prints them as a JSON schema. `docs/scenes.md` explains them with examples.
//!
//! - Positions and directions are `[x, y, z]`, metres, z upwards unless the scene is turned otherwise; every other quantity carries its
//!   unit in a text ([`quantity`]).
//! - A shape, light or sensor is a table with the key of its kind: `sphere = { … }`, `point = { … }`, `illuminance = { … }`.

pub mod light;
pub mod material;
pub mod quantity;
pub mod sensor;
pub mod spectrum;
pub mod surface;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

use light::Light;
use material::Material;
use quantity::Length;
use sensor::Sensor;
use spectrum::SpectrumSource;
use surface::Shape;
use toml::Spanned;

use super::sampler::Points;
use crate::mistake;
pub use crate::mistake::Mistake as Error;

/// A point or a vector, m.
type Vector = [f64; 3];

/// A scene.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// A name for reports.
    #[serde(default)]
    pub title: Option<String>,
    /// How to render.
    #[serde(default)]
    pub render: Render,
    /// Spectra that the scene names.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, SpectrumSource>")]
    pub spectra: BTreeMap<String, Spanned<SpectrumSource>>,
    /// Materials.
    #[serde(default)]
    pub material: Vec<Material>,
    /// Surfaces.
    #[serde(default)]
    pub shape: Vec<Shape>,
    /// Lights that are no surfaces.
    #[serde(default)]
    pub light: Vec<Light>,
    /// Instruments; at least one.
    pub sensor: Vec<Sensor>,
}

/// How to render.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Render {
    /// Which light is followed.
    pub solver: Solver,
    /// Samples of a pixel.
    #[schemars(with = "u64", range(min = 1))]
    #[serde(deserialize_with = "samples")]
    pub samples: u64,
    /// Whether the samples of a picture go where it is noisy, so many a pixel on average; else every pixel gets as many.
    pub adaptive: bool,
    /// Whether places that packets from the lights came to light diffuse surfaces in pictures; without it where that makes less noise.
    pub virtual_lights: Option<bool>,
    /// Whether packets from the lights tell paths of pictures where glass and mirrors send light from; without it where that pays.
    pub guiding: Option<bool>,
    /// Samples of a picture that share a ray of the camera: ways by which its path leaves the first surface that is no mirror and no polished
    /// glass; without it as many as make least noise.
    #[schemars(with = "Option<u32>", range(min = 1, max = 64))]
    #[serde(deserialize_with = "branches")]
    pub branches: Option<u32>,
    /// Whether pictures are filtered: less noise for a bias that is measured and told. Readings are not.
    #[schemars(with = "bool")]
    pub denoise: Option<Spanned<bool>>,
    /// Samples of a meter, at most where a target is given.
    #[schemars(with = "u64", range(min = 1))]
    #[serde(deserialize_with = "samples")]
    pub meter_samples: u64,
    /// Names all random numbers.
    pub seed: u64,
    /// The longest path, edges from the instrument to the light; without it none is cut.
    pub max_edges: Option<u32>,
    /// The edge from which on chance may end a path of little light (Russian roulette).
    #[schemars(with = "u32", range(min = 1))]
    #[serde(deserialize_with = "roulette_from")]
    pub roulette_from: u32,
    /// How the random numbers lie.
    pub sampler: Points,
    /// Whether a path carries all wavelengths or one.
    pub wavelengths_per_path: Carried,
    /// Step between wavelengths, nm; without it the coarsest that keeps to `wavelength_tolerance`.
    #[schemars(with = "Option<f64>", range(min = 1, max = 100))]
    #[serde(deserialize_with = "wavelength_step")]
    pub wavelength_step_nm: Option<f64>,
    /// The greatest error of the sum over wavelengths, relative.
    #[schemars(with = "f64")]
    #[serde(deserialize_with = "wavelength_tolerance")]
    pub wavelength_tolerance: f64,
    /// The longest edge of a patch, of radiosity; without it as long as makes some thousand patches.
    #[schemars(with = "Option<Length>")]
    pub patch_edge: Option<Spanned<Length>>,
    /// How far the solution of radiosity may be from that of its equations, relative to all light.
    pub radiosity_tolerance: f64,
    /// Whether only what the scene requires is modelled.
    pub model: Model,
    /// Whether what mirrors and glass polarise is followed to the next of them; where it matters without it.
    pub polarisation: Option<bool>,
}

/// The number of an edge, from 1.
///
/// # Errors
/// Another number.
pub(crate) fn roulette_from<'de, D: Deserializer<'de>, N: From<u32>>(deserializer: D) -> Result<N, D::Error> {
    let found = u32::deserialize(deserializer)?;
    let wrong = || D::Error::custom("a `roulette_from` of 0; expected the number of an edge, from 1");
    if found == 0 { Err(wrong()) } else { Ok(found.into()) }
}

/// A number of samples, from 1.
///
/// # Errors
/// Another number.
pub(crate) fn samples<'de, D: Deserializer<'de>, N: From<u64>>(deserializer: D) -> Result<N, D::Error> {
    let found = u64::deserialize(deserializer)?;
    if found == 0 { Err(D::Error::custom("found 0 samples; expected 1 or more")) } else { Ok(found.into()) }
}

/// A step between wavelengths, nm.
///
/// # Errors
/// Another number.
pub(crate) fn wavelength_step<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    let found = f64::deserialize(deserializer)?;
    let wrong = || D::Error::custom(format!("a `wavelength_step_nm` of {found}; expected 1 to 100"));
    if (1.0..=100.0).contains(&found) { Ok(Some(found)) } else { Err(wrong()) }
}

/// A relative error.
///
/// # Errors
/// Another number.
pub(crate) fn wavelength_tolerance<'de, D: Deserializer<'de>, N: From<f64>>(deserializer: D) -> Result<N, D::Error> {
    let found = f64::deserialize(deserializer)?;
    let message = || format!("a `wavelength_tolerance` of {found}; expected a relative error above 0, such as 1e-3");
    if found > 0.0 { Ok(found.into()) } else { Err(D::Error::custom(message())) }
}

/// A number of branches, 1 to 64.
///
/// # Errors
/// Another number.
pub(crate) fn branches<'de, D: Deserializer<'de>, N: From<u32>>(deserializer: D) -> Result<N, D::Error> {
    let found = u32::deserialize(deserializer)?;
    let wrong = || D::Error::custom(format!("`branches` of {found}; expected 1 to 64"));
    if (1..=64).contains(&found) { Ok(found.into()) } else { Err(wrong()) }
}

impl Render {
    /// Whether pictures are filtered: not those of a first look, which are no measurement, and not where everything is modelled.
    ///
    /// # Errors
    /// Why they cannot be, in words.
    pub fn denoises(&self) -> Result<bool, &'static str> {
        let asked = self.denoise.as_ref().is_some_and(|asked| *asked.get_ref());
        if !asked || self.solver == Solver::Preview || self.model == Model::Full {
            return Ok(false);
        }
        match self.solver {
            Solver::Bidirectional => Err(
                "`denoise` with the solver \"bidirectional\", whose packets lend noise to many pixels at once; expected another solver",
            ),
            Solver::Radiosity => {
                Err("`denoise` with the solver \"radiosity\", whose pictures have no noise; expected another solver")
            }
            _ if self.samples < 4 => Err("`denoise` of fewer than 4 samples a pixel; expected four or more"),
            _ => Ok(true),
        }
    }
}

impl Default for Render {
    fn default() -> Self {
        Self {
            solver: Solver::Path,
            samples: 64,
            adaptive: true,
            virtual_lights: None,
            branches: None,
            guiding: None,
            denoise: None,
            meter_samples: 1 << 18,
            seed: 0,
            max_edges: None,
            roulette_from: 4,
            sampler: Points::Sobol,
            wavelengths_per_path: Carried::All,
            wavelength_step_nm: None,
            wavelength_tolerance: 1e-3,
            patch_edge: None,
            radiosity_tolerance: 1e-6,
            model: Model::Minimal,
            polarisation: None,
        }
    }
}

/// Which light is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Solver {
    /// All of it.
    Path,
    /// All of it, and pictures from the lights' side as well: for what glass and mirrors throw on a wall.
    Bidirectional,
    /// Direct light and its reflections in mirrors and glass.
    Whitted,
    /// All of it, between diffuse surfaces, without random numbers.
    Radiosity,
    /// Direct light.
    Direct,
    /// Direct light without shadows: a first look, and no measurement.
    Preview,
}

impl Solver {
    /// Its name in a scene.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Path => "path",
            Self::Bidirectional => "bidirectional",
            Self::Whitted => "whitted",
            Self::Direct => "direct",
            Self::Radiosity => "radiosity",
            Self::Preview => "preview",
        }
    }
}

/// How many wavelengths a path from an instrument, or a packet that helps it, carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Carried {
    /// All of them, as far as they go the same way.
    All,
    /// One, drawn for each path (hero wavelength): as right, and noisier.
    One,
}

impl Carried {
    /// Its name in a scene.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::One => "one",
        }
    }
}

/// How much is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// What the scene requires, to the tolerances asked for.
    Minimal,
    /// Everything: wavelengths 1 nm apart, polarisation, lights of no flux. The readings are the same within their error bars.
    Full,
}

impl Description {
    /// Reads a scene.
    ///
    /// # Errors
    /// The first mistake in TOML, in keys, in types and in units.
    pub fn parse(text: &str) -> Result<Self, Error> {
        mistake::parse(text)
    }
}

/// The JSON schema of scenes (draft 2020-12).
#[must_use]
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Description).to_value()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"
title = "a lamp over a table"
[render]
samples = 16
[spectra]
wood = [[400, 0.1], [700, 0.5]]
[[material]]
name = "table"
reflectance = "wood"
[[shape]]
name = "top"
material = "table"
rectangle = { corner = [0, 0, 0], edges = [[2, 0, 0], [0, 1, 0]] }
[[light]]
point = { at = [1, 0.5, 2], flux = "800 lm" }
spectrum = "LED-B3"
[[sensor]]
name = "middle"
illuminance = { at = [1, 0.5, 0] }
"#;

    fn refused(from: &str, to: &str) -> String {
        assert!(SCENE.contains(from), "{from}");
        Description::parse(&SCENE.replacen(from, to, 1)).unwrap_err().to_string()
    }

    #[test]
    fn a_scene_is_read() {
        let scene = Description::parse(SCENE).unwrap();
        assert_eq!((scene.shape.len(), scene.light.len(), scene.sensor.len()), (1, 1, 1));
        assert_eq!(*scene.spectra["wood"].get_ref(), SpectrumSource::Table(vec![[400.0, 0.1], [700.0, 0.5]]));
        assert_eq!((scene.render.samples, scene.render.seed), (16, 0));
        let point = scene.light[0].point.as_ref().unwrap().get_ref();
        assert_eq!(point.flux, Some(quantity::Flux { value: 800.0, kind: quantity::Kind::Luminous }));
    }

    /// The place is that of the key or the value to blame, the message names both what was found and what was expected.
    #[test]
    fn mistakes_are_told_with_their_place() {
        let message = refused("samples", "sample");
        assert!(message.starts_with("4:1: unknown field `sample`, expected one of"), "{message}");
        let message = refused("\"800 lm\"", "\"800 cd\"");
        assert!(message.starts_with("15:36: found `800 cd`; expected a flux"), "{message}");
        let message = refused("\"800 lm\"", "800");
        assert_eq!(message, "15:36: found `800` without a unit; expected a flux as a text such as \"800 lm\"");
        let message = refused("\"800 lm\"", "{ lm = 800 }");
        assert_eq!(message, "15:36: found a table; expected a flux as a text such as \"800 lm\"");
        let message = refused("[0, 1, 0]", "[0, 1]");
        assert!(message.starts_with("13:"), "{message}");
        let message = refused("[[400, 0.1], [700, 0.5]]", "[[700, 0.1], [400, 0.5]]");
        assert!(message.starts_with("6:8: found 400 nm"), "{message}");
        let message = refused("name = \"middle\"\n", "");
        assert!(message.contains("missing field `name`"), "{message}");
        assert!(refused("[render]", "[render").starts_with("3:"));
        for number in ["nan", "-inf", "1e999"] {
            let message = refused("[0, 1, 0]", &format!("[0, {number}, 0]"));
            assert_eq!(message, format!("13:59: found `{number}`; expected a finite number"));
        }
    }

    #[test]
    fn the_schema_names_every_kind() {
        let text = schema().to_string();
        for key in ["sphere", "rectangle", "illuminance", "LED-B3", "additionalProperties"] {
            assert!(text.contains(key), "{key}");
        }
    }
}

//! What was photographed, in words: TOML in, a typed and checked manifest out. No file is opened here.
//!
//! `docs/capture.md` explains the manifest with examples; [`schema`] prints it as a JSON schema. Paths are relative to the manifest.

use schemars::JsonSchema;
use serde::Deserialize;

use super::setup::{Ball, Camera, Cylinder, Flat, Light, Mesh, Plane, Radiance, Reference, Sphere};
use crate::mistake;
pub use crate::mistake::Mistake as Error;

/// A set of photographs.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// A name for reports.
    #[serde(default)]
    pub title: Option<String>,
    /// The views of a chessboard that tell the camera.
    #[serde(default)]
    pub board: Option<Board>,
    /// How the codes of the photographs follow from exposure.
    #[serde(default)]
    pub response: Response,
    /// Photographs of one unchanged scene under one light, at one or several exposure times.
    #[serde(default)]
    pub stack: Vec<Stack>,
    /// The camera that photographed the stacks, and where it stood.
    #[serde(default)]
    pub camera: Option<Camera>,
    /// The sphere in front of it. This and the next three: one of them is the object.
    #[serde(default)]
    pub sphere: Option<Sphere>,
    /// A cylinder.
    #[serde(default)]
    pub cylinder: Option<Cylinder>,
    /// A plane.
    #[serde(default)]
    pub plane: Option<Plane>,
    /// A mesh of triangles.
    #[serde(default)]
    pub mesh: Option<Mesh>,
    /// Balls that tell the lights.
    #[serde(default)]
    pub ball: Vec<Ball>,
    /// The lights that stacks name.
    #[serde(default)]
    pub light: Vec<Light>,
    /// What the samples of linear photographs mean.
    #[serde(default)]
    pub radiance: Radiance,
    /// The evenly lit field of the flat stacks: of known radiance, it makes the result absolute.
    #[serde(default)]
    pub flat: Option<Flat>,
    /// A diffuse sphere of known reflectance, photographed in the place of the object.
    #[serde(default)]
    pub reference: Option<Reference>,
}

/// A chessboard and its views.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Board {
    /// Inner corners along a row, and rows of them.
    pub corners: [usize; 2],
    /// Side of a square, m; without it lengths are in squares.
    #[serde(default)]
    pub square_m: Option<f64>,
    /// Photographs of the board.
    #[serde(default)]
    pub views: Vec<String>,
    /// A CSV of corners found already, columns view, idx, X, Y, u, v: used instead of `views`.
    #[serde(default)]
    pub corners_file: Option<String>,
}

/// Where the response comes from.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Response {
    /// A table that `photopic capture response --csv` wrote; without it the response is found from the stacks.
    pub file: Option<String>,
    /// Codes are proportional to exposure.
    pub linear: bool,
}

/// Photographs of one scene.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stack {
    /// A name for reports and outputs.
    pub name: String,
    /// What it shows.
    #[serde(default)]
    pub shows: Shows,
    /// The light that was on, by name.
    #[serde(default)]
    pub light: Option<String>,
    /// The ball in it, by name; without it the only `[[ball]]`, else the sphere.
    #[serde(default)]
    pub ball: Option<String>,
    /// The middle of the narrow band that it shows, nm: of filters before the camera, or of a lamp of one colour. The stacks of a light, one
    /// per band, are one picture; their photographs are grey.
    #[serde(default, deserialize_with = "super::setup::maybe_positive")]
    pub wavelength_nm: Option<f64>,
    /// The photographs.
    pub exposures: Vec<Exposure>,
}

impl Stack {
    /// A stack of an object.
    #[must_use]
    pub fn new(name: impl Into<String>, exposures: Vec<Exposure>) -> Self {
        Self { name: name.into(), shows: Shows::Object, light: None, ball: None, wavelength_nm: None, exposures }
    }

    /// Name of its light: its own where it names none.
    #[must_use]
    pub fn lit_by(&self) -> &str {
        self.light.as_deref().unwrap_or(&self.name)
    }
}

/// What a stack shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shows {
    /// The object to be measured.
    #[default]
    Object,
    /// An evenly lit field: tells vignetting.
    Flat,
    /// A mirror ball: tells where the light is.
    MirrorBall,
    /// The diffuse sphere of `[reference]`: tells how strong the light is.
    Reference,
}

/// One photograph.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Exposure {
    /// The file.
    pub photo: String,
    /// Exposure time, s; without it that of the EXIF data.
    #[serde(default)]
    pub time_s: Option<f64>,
}

impl Manifest {
    /// The narrow bands in which the object was photographed, rising; none where its stacks show grey or colours.
    #[must_use]
    pub fn wavelengths_nm(&self) -> Vec<f64> {
        let of_object = self.stack.iter().filter(|s| s.shows == Shows::Object);
        let mut out: Vec<f64> = of_object.filter_map(|s| s.wavelength_nm).collect();
        out.sort_by(f64::total_cmp);
        out.dedup();
        out
    }

    /// The lights by name under which the object was photographed, in the order of their stacks.
    #[must_use]
    pub fn lights_used(&self) -> Vec<String> {
        let mut out: Vec<String> = Vec::new();
        for stack in self.stack.iter().filter(|s| s.shows == Shows::Object) {
            if !out.iter().any(|l| l == stack.lit_by()) {
                out.push(stack.lit_by().to_owned());
            }
        }
        out
    }

    /// The largest number of exposures of a stack of the object.
    #[must_use]
    pub fn most_exposures(&self) -> usize {
        let of_object = self.stack.iter().filter(|s| s.shows == Shows::Object);
        of_object.map(|s| s.exposures.len()).max().unwrap_or(0)
    }

    /// Keeps so many of the lights under which the object was photographed, and of the exposures of each stack of object and reference, as if
    /// no others had been taken: those in the middles of equal parts of the lights in their order, and of the exposures by rising time.
    pub fn keep(&mut self, lights: usize, exposures: usize) {
        let used = self.lights_used();
        let kept: Vec<&String> = middles(used.len(), lights).map(|n| &used[n]).collect();
        let is_photo = |s: &Stack| matches!(s.shows, Shows::Object | Shows::Reference);
        self.stack.retain(|s| !is_photo(s) || lights >= used.len() || kept.iter().any(|l| *l == s.lit_by()));
        for stack in self.stack.iter_mut().filter(|s| is_photo(s) && s.exposures.len() > exposures) {
            let time = |e: &Exposure| e.time_s.unwrap_or(0.0);
            stack.exposures.sort_by(|a, b| time(a).total_cmp(&time(b)));
            let all = std::mem::take(&mut stack.exposures);
            stack.exposures = middles(all.len(), exposures).map(|n| all[n].clone()).collect();
        }
    }

    /// How many objects are stated: one is expected.
    #[must_use]
    pub fn objects(&self) -> usize {
        [self.sphere.is_some(), self.cylinder.is_some(), self.plane.is_some(), self.mesh.is_some()]
            .into_iter()
            .filter(|stated| *stated)
            .count()
    }

    /// The picture that masks the object, where one is stated.
    #[must_use]
    pub fn mask(&self) -> Option<&str> {
        let of = [
            self.sphere.as_ref().map(|o| &o.mask),
            self.cylinder.as_ref().map(|o| &o.mask),
            self.plane.as_ref().map(|o| &o.mask),
            self.mesh.as_ref().map(|o| &o.mask),
        ];
        of.into_iter().flatten().find_map(|mask| mask.as_deref())
    }

    /// Reads a manifest.
    ///
    /// # Errors
    /// The first mistake in TOML, in keys and in types.
    pub fn parse(text: &str) -> Result<Self, Error> {
        mistake::parse(text)
    }
}

/// Numbers below `count` in the middles of so many equal parts; all where there are no more.
fn middles(count: usize, parts: usize) -> impl Iterator<Item = usize> {
    let parts = parts.min(count);
    (0..parts).map(move |i| (2 * i + 1) * count / (2 * parts))
}

/// The JSON schema of manifests (draft 2020-12).
#[must_use]
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Manifest).to_value()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"
title = "a ball"
[board]
corners = [9, 6]
views = ["a.png"]
[[stack]]
name = "left"
light = "L1"
exposures = [{ photo = "l1.png", time_s = 0.5 }, { photo = "l2.png" }]
"#;

    #[test]
    fn a_manifest_is_read() {
        let m = Manifest::parse(TEXT).unwrap();
        assert_eq!((m.stack[0].shows, m.stack[0].exposures[1].time_s), (Shows::Object, None));
        assert_eq!(m.board.unwrap().corners, [9, 6]);
        assert!(schema().to_string().contains("mirror-ball"));
    }

    #[test]
    fn mistakes_are_told_with_their_place() {
        let message = |from: &str, to: &str| Manifest::parse(&TEXT.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(message("light =", "lamp =").starts_with("8:1: unknown field `lamp`"));
        assert!(message("0.5", "\"0.5\"").starts_with("9:43: "));
        assert!(message("0.5", "inf").starts_with("9:43: found `inf`; expected a finite number"));
        assert!(message("[9, 6]", "[9]").starts_with("4:"));
    }
}

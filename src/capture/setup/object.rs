//! What is photographed: a sphere, a cylinder, a plane, a mesh; and balls that tell the lights.

use schemars::JsonSchema;
use serde::Deserialize;

use super::number::{direction, maybe_positive, maybe_size, positive};

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

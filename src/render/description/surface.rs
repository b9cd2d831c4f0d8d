//! Surfaces of a scene and what they emit.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::Vector;
use super::quantity::{Angle, Flux, Irradiance, Length, Radiance};
use super::spectrum::SpectrumSource;

/// A surface; one of the kinds.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// Its name, for reports; not two of one name.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub name: Option<Spanned<String>>,
    /// The name of its material; without one it is black.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub material: Option<Spanned<String>>,
    /// What it emits.
    #[serde(default)]
    #[schemars(with = "Option<Emission>")]
    pub emission: Option<Spanned<Emission>>,
    /// A sphere, its outside outside.
    #[serde(default)]
    #[schemars(with = "Option<Sphere>")]
    pub sphere: Option<Spanned<Sphere>>,
    /// A plane without bounds.
    #[serde(default)]
    #[schemars(with = "Option<Plane>")]
    pub plane: Option<Spanned<Plane>>,
    /// A disk or a ring.
    #[serde(default)]
    #[schemars(with = "Option<Disk>")]
    pub disk: Option<Spanned<Disk>>,
    /// A rectangle or parallelogram.
    #[serde(default)]
    #[schemars(with = "Option<Rectangle>")]
    pub rectangle: Option<Spanned<Rectangle>>,
    /// A triangle; its outside is where the corners stand anticlockwise.
    #[serde(default)]
    #[schemars(with = "Option<Triangle>")]
    pub triangle: Option<Spanned<Triangle>>,
    /// A flat polygon, corners in order; its outside is where they stand anticlockwise.
    #[serde(default)]
    #[schemars(with = "Option<Polygon>")]
    pub polygon: Option<Spanned<Polygon>>,
    /// A closed solid with flat faces.
    #[serde(default)]
    #[schemars(with = "Option<Polyhedron>")]
    pub polyhedron: Option<Spanned<Polyhedron>>,
    /// A box with its edges along the axes: its outside outside, or inside for a room.
    #[serde(default, rename = "box")]
    #[schemars(with = "Option<Cuboid>")]
    pub cuboid: Option<Spanned<Cuboid>>,
    /// A tube, with or without its ends.
    #[serde(default)]
    #[schemars(with = "Option<Cylinder>")]
    pub cylinder: Option<Spanned<Cylinder>>,
    /// A mesh of triangles in a file (PLY, OBJ, glTF).
    #[serde(default)]
    #[schemars(with = "Option<Mesh>")]
    pub mesh: Option<Spanned<Mesh>>,
}

/// What a surface emits: one amount, or the radiance as a file gives it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Emission {
    /// Its colour; without one the same at every wavelength.
    #[serde(default)]
    #[schemars(with = "Option<SpectrumSource>")]
    pub spectrum: Option<Spanned<SpectrumSource>>,
    /// Radiance along the normal.
    #[serde(default)]
    pub radiance: Option<Radiance>,
    /// Exitance.
    #[serde(default)]
    pub exitance: Option<Irradiance>,
    /// Flux of the whole surface.
    #[serde(default)]
    pub flux: Option<Flux>,
    /// The radiance falls off as this power of the cosine to the normal.
    #[serde(default)]
    pub cosine_power: f64,
    /// Both sides shine.
    #[serde(default)]
    pub two_sided: bool,
    /// It shines as a photometric file says, every part of it alike (flat shapes); its own flux replaces the file's.
    #[serde(default)]
    pub lamp: Option<LampFile>,
}

/// The distribution of a photometric file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LampFile {
    /// LM-63, EULUMDAT or TM-33, beside the scene; its axis is the shape's normal.
    pub file: String,
    /// Turn about the axis, as of a lamp that is aimed.
    #[serde(default)]
    pub spin: Option<Angle>,
}

/// A sphere.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Centre, m.
    pub centre: Vector,
    /// Radius.
    pub radius: Length,
}

/// A plane.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// A point of it, m.
    pub point: Vector,
    /// Its outside.
    pub normal: Vector,
}

/// A disk.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disk {
    /// Centre, m.
    pub centre: Vector,
    /// Its outside.
    pub normal: Vector,
    /// Radius.
    pub radius: Length,
    /// Radius of the hole.
    #[serde(default)]
    pub inner_radius: Option<Length>,
}

/// A rectangle or parallelogram; its outside is the side from which the turn from the first edge to the second is anticlockwise.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rectangle {
    /// A corner, m.
    pub corner: Vector,
    /// The two edges from it, m.
    pub edges: [Vector; 2],
}

/// A polygon.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Polygon {
    /// At least three corners, m.
    pub corners: Vec<Vector>,
}

/// A triangle.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Triangle {
    /// Its corners, m.
    pub corners: [Vector; 3],
}

/// A closed solid.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Polyhedron {
    /// Its corners, m.
    pub vertices: Vec<Vector>,
    /// The corners of each face by their numbers from 0, anticlockwise from outside; every edge belongs to two faces.
    pub faces: Vec<Vec<usize>>,
}

/// A box.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cuboid {
    /// One corner, m.
    pub from: Vector,
    /// The opposite corner, m.
    pub to: Vector,
    /// A room: the outside of its walls is inside the box.
    #[serde(default)]
    pub inwards: bool,
}

/// A tube.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Middle of one end, m.
    pub from: Vector,
    /// Middle of the other end, m.
    pub to: Vector,
    /// Radius.
    pub radius: Length,
    /// With both ends closed.
    #[serde(default)]
    pub closed: bool,
}

/// A mesh.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// PLY, OBJ or glTF, beside the scene; its coordinates are metres before the transform.
    pub file: String,
    /// Flat triangles, although the file has normals at the corners.
    #[serde(default)]
    pub flat: bool,
    /// Steps from the file's coordinates to the scene's, one after the other.
    #[serde(default)]
    pub transform: Vec<Step>,
    /// Copies, each with steps behind those of `transform`; one copy without it. They share the mesh's memory.
    #[serde(default)]
    pub instances: Option<Vec<Vec<Step>>>,
}

/// A step of a transform; one of the kinds.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// By a vector, m.
    #[serde(default)]
    pub translate: Option<Vector>,
    /// About an axis through the origin, anticlockwise seen from its end.
    #[serde(default)]
    pub rotate: Option<Rotation>,
    /// By a factor about the origin.
    #[serde(default)]
    pub scale: Option<f64>,
}

/// A turn.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// The axis.
    pub axis: Vector,
    /// The angle.
    pub angle: Angle,
}

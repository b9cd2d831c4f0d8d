//! Files of meshes: bytes in, meshes out. Nothing is opened here.
//!
//! | file | what is read |
//! |---|---|
//! | [`ply`] | Stanford PLY, text and binary of both byte orders: one mesh |
//! | [`obj`] | Wavefront OBJ: one mesh per object and material |
//! | [`gltf`] | glTF 2.0, text and binary: one mesh per primitive of each node |
//!
//! Faces with more than three corners are cut into triangles (fans from a corner that sees all the others). Memory is bounded by a multiple of the file's size,
//! whatever the file announces.

pub mod gltf;
pub mod obj;
pub mod ply;

use glam::DVec3;

use super::mesh::MeshData;

/// A mesh of a file, with the names it has there.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Object {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// The name of its material, if it has one.
    pub material: Option<String>,
    /// The mesh, in the file's coordinates.
    pub mesh: MeshData,
}

/// Where in a file something stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Line and column (bytes), from 1.
    Line(usize, usize),
    /// Byte, from 0.
    Byte(usize),
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Line(line, column) => write!(f, "{line}:{column}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// Why a file was refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: found {found}; expected {expected}")]
pub struct Error {
    /// Where.
    pub place: Place,
    /// What stands there.
    pub found: String,
    /// What should.
    pub expected: String,
}

/// Cuts a polygon into triangles, all from one corner: from the first one that sees all the others, which every convex polygon and
/// every quadrilateral has; from the first where none does.
fn triangulate(polygon: &[u32], positions: &[DVec3], triangles: &mut Vec<[u32; 3]>) {
    let n = polygon.len();
    let at = |i: usize| positions[polygon[i % n] as usize];
    let fan = |start: usize| (1..n.saturating_sub(1)).map(move |i| [start, start + i, start + i + 1]);
    let start = if n == 3 {
        0
    } else {
        // Twice the polygon's vector area does not depend on the corner it is seen from.
        let area = |[a, b, c]: [usize; 3]| (at(b) - at(a)).cross(at(c) - at(a));
        let whole: DVec3 = fan(0).map(area).sum();
        // A polygon of many corners is taken as convex rather than tried from all of them.
        (0..n.min(16)).find(|&start| fan(start).all(|t| area(t).dot(whole) >= 0.0)).unwrap_or(0)
    };
    triangles.extend(fan(start).map(|t| t.map(|i| polygon[i % n])));
}

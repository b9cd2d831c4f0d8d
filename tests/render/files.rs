//! The meshes of the shared folder through the readers of files.

use std::collections::HashMap;

use glam::DVec3;
use photopic::render::format::ply;
use photopic::render::mesh::{Mesh, MeshData};
use photopic::render::shape::Bounds;

use crate::common::shared;

fn load(name: &str) -> Option<MeshData> {
    let path = shared(&format!("render/meshes/{name}.ply"))?;
    let bytes = std::fs::read(path).expect("readable");
    Some(ply::read(&bytes).expect("a mesh").mesh)
}

/// How many edges are not passed once in each direction.
fn open_edges(mesh: &MeshData) -> usize {
    let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
        }
    }
    edges.values().filter(|&&balance| balance != 0).count()
}

/// The volume enclosed, by the divergence theorem: positive if the outside is outside.
fn volume(mesh: &MeshData) -> f64 {
    let corners = |t: &[u32; 3]| t.map(|i| mesh.positions[i as usize]);
    mesh.triangles.iter().map(corners).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

#[test]
fn the_benchmark_meshes_are_whole_and_closed() {
    // Counts from the headers of the files; boxes by Python's `array` on the bytes behind them, single precision as printed.
    for (name, corners, triangles, min, max) in [
        ("blob", 163_842, 327_680, [-1.017_875_4, -1.054_196_1, -1.029_851_6], [1.096_298_3, 1.004_281_2, 1.010_525_3]),
        (
            "spheres",
            328_704,
            655_360,
            [-2.046_131_4, -2.053_408_6, -2.055_372_7],
            [2.050_281, 2.031_521_8, 2.051_442_9],
        ),
        ("prism", 6, 8, [0.263_745, 0.02, -0.410_439_5], [1.236_255, 0.626_217_8, 0.610_439_5]),
    ] {
        let Some(data) = load(name) else { return };
        assert_eq!((data.positions.len(), data.triangles.len()), (corners, triangles), "{name}");
        assert_eq!(open_edges(&data), 0, "{name}");
        assert!(volume(&data) > 0.0, "{name}");
        let mesh = Mesh::new(data).expect("sound");
        assert_eq!(mesh.skipped(), 0, "{name}");
        let Bounds { min: low, max: high } = mesh.bounds();
        for (found, expected) in [(low, min), (high, max)] {
            assert!((found - DVec3::from_array(expected)).abs().max_element() < 1e-6, "{name} {found}");
        }
    }
}

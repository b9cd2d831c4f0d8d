//! The search for surfaces, in rays per second: camera rays of the shared benchmark scenes and cosine-distributed rays from what they
//! meet, through the meshes alone, on one and on two threads. Skipped where the folder of reference files is absent.

use std::path::Path;
use std::sync::Arc;

use divan::Bencher;
use divan::counter::ItemsCount;
use glam::{DAffine3, DMat3, DVec3};
use photopic::geometry::direction::tangents;
use photopic::math::random::Stream;
use photopic::render::accelerate::Surfaces;
use photopic::render::format::ply;
use photopic::render::mesh::{Mesh, MeshData};
use photopic::render::placed::PlacedMesh;
use photopic::render::ray::Ray;
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

fn main() {
    match std::env::var_os("PHOTOPIC_RAYS") {
        Some(folder) => beside_embree(Path::new(&folder)),
        None => divan::main(),
    }
}

/// For `scripts/bench_rays.sh`: writes the rays into a folder, six `f32` each, and prints what is printed there for Embree.
fn beside_embree(folder: &Path) {
    let threads = std::env::var("PHOTOPIC_THREADS").ok().and_then(|n| n.parse().ok()).unwrap_or(1);
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    for case in CASES {
        let Some(surfaces) = surfaces(case) else { continue };
        for (kind, rays) in [("coherent", camera_rays(case)), ("incoherent", bounced_rays(&surfaces, case))] {
            let single = |ray: &Ray| [ray.origin, ray.direction].map(|v| v.as_vec3());
            // The same rays for both: those that single precision can hold.
            let rays: Vec<Ray> = (rays.iter().map(single))
                .map(|[origin, direction]| Ray { origin: origin.as_dvec3(), direction: direction.as_dvec3() })
                .collect();
            let bytes: Vec<u8> =
                rays.iter().flat_map(single).flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes).collect();
            std::fs::write(folder.join(format!("{}.{kind}", case.name)), bytes).expect("a folder to write to");
            let closest = |ray: &Ray| surfaces.closest(ray, f64::INFINITY).map_or((0, 0.0), |(_, c)| (1, c.t));
            let add = |a: (usize, f64), b: (usize, f64)| (a.0 + b.0, a.1 + b.1);
            let mut best = f64::INFINITY;
            let mut sum = (0, 0.0);
            for _ in 0..10 {
                let start = std::time::Instant::now();
                let chunk = |rays: &[Ray]| rays.iter().map(closest).fold((0, 0.0), add);
                sum = pool.install(|| rays.par_chunks(1024).map(chunk).reduce(|| (0, 0.0), add));
                best = best.min(start.elapsed().as_secs_f64());
            }
            let rate = rays.len() as f64 / best / 1e6;
            println!("{} {kind} photopic: {} hits, distances {:.6}, {rate:.3} Mrays/s", case.name, sum.0, sum.1);
        }
    }
}

/// A mesh of `../shared/render/meshes` and its camera in `../shared/render/scenes`.
#[derive(Debug, Clone, Copy)]
struct Case {
    name: &'static str,
    eye: DVec3,
    field_of_view_deg: f64,
}

const CASES: [Case; 2] = [
    Case { name: "blob", eye: DVec3::new(0.0, 1.2, 4.2), field_of_view_deg: 40.0 },
    Case { name: "spheres", eye: DVec3::new(4.2, 2.6, 6.0), field_of_view_deg: 36.0 },
];

/// Rays in the picture's rows and columns.
const SIZE: usize = 512;

fn data(case: Case) -> Option<MeshData> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/render/meshes");
    let bytes = std::fs::read(root.join(format!("{}.ply", case.name))).ok()?;
    Some(ply::read(&bytes).expect("a mesh").mesh)
}

fn surfaces(case: Case) -> Option<Surfaces> {
    let mesh = Mesh::new(data(case)?).expect("sound");
    let placed = PlacedMesh::new(Arc::new(mesh), DAffine3::IDENTITY).expect("regular");
    Some(Surfaces::new(vec![Arc::new(placed)]))
}

fn camera_rays(case: Case) -> Vec<Ray> {
    let forward = (DVec3::new(0.0, -0.1, 0.0) - case.eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let frame = DMat3::from_cols(right, right.cross(forward), forward);
    let half = (0.5 * case.field_of_view_deg.to_radians()).tan();
    let at = |i: usize| half * (2.0 * (i as f64 + 0.5) / SIZE as f64 - 1.0);
    let ray =
        |i| Ray { origin: case.eye, direction: (frame * DVec3::new(at(i % SIZE), at(i / SIZE), 1.0)).normalize() };
    (0..SIZE * SIZE).map(ray).collect()
}

/// Cosine-distributed rays from where the camera's rays meet the surface, in an order that has nothing in common.
fn bounced_rays(surfaces: &Surfaces, case: Case) -> Vec<Ray> {
    let mut stream = Stream::new(6, 5);
    let points: Vec<_> = (camera_rays(case).iter())
        .filter_map(|ray| {
            let (surface, crossing) = surfaces.closest(ray, f64::INFINITY)?;
            Some(surfaces.surface_point(surface, ray, &crossing))
        })
        .collect();
    (0..SIZE * SIZE)
        .map(|_| {
            let [which, u, v] = stream.uniforms();
            let point = &points[(which * points.len() as f64) as usize];
            let (t, b) = tangents(point.normal);
            let (sin, cos) = (std::f64::consts::TAU * v).sin_cos();
            let direction = u.sqrt() * (cos * t + sin * b) + (1.0 - u).sqrt() * point.normal;
            Ray { origin: point.origin_towards(direction), direction: direction.normalize() }
        })
        .collect()
}

fn trace(bencher: Bencher, surfaces: &Surfaces, rays: &[Ray], threads: usize) {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let closest = |ray: &Ray| surfaces.closest(ray, f64::INFINITY).map_or(0.0, |(_, crossing)| crossing.t);
    bencher.counter(ItemsCount::new(rays.len())).bench_local(|| {
        pool.install(|| rays.par_chunks(1024).map(|rays| rays.iter().map(closest).sum::<f64>()).sum::<f64>())
    });
}

#[divan::bench(args = CASES, consts = [1, 2], sample_count = 10)]
fn coherent<const THREADS: usize>(bencher: Bencher, case: Case) {
    if let Some(surfaces) = surfaces(case) {
        trace(bencher, &surfaces, &camera_rays(case), THREADS);
    }
}

#[divan::bench(args = CASES, consts = [1, 2], sample_count = 10)]
fn incoherent<const THREADS: usize>(bencher: Bencher, case: Case) {
    if let Some(surfaces) = surfaces(case) {
        trace(bencher, &surfaces, &bounced_rays(&surfaces, case), THREADS);
    }
}

/// The tree of a mesh, with two threads.
#[divan::bench(args = CASES, sample_count = 5)]
fn build(bencher: Bencher, case: Case) {
    if let Some(data) = data(case) {
        bencher.bench_local(|| Mesh::new(data.clone()));
    }
}

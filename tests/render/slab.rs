//! A solid pane of glass between two parallel interfaces, traced reflection by reflection, against the closed form of
//! `../shared/render/analytic.json`: with polarisation the exact transmittance, without it the naive one.

use std::sync::Arc;

use glam::DVec3;
use photopic::brdf::lambert::Lambert;
use photopic::render::bands::Bands;
use photopic::render::emission::Emission;
use photopic::render::estimate::{Estimate, Figure, REPLICATES, Replicate};
use photopic::render::integrator::limits::Limits;
use photopic::render::integrator::path::PathTracer;
use photopic::render::light::bounding::BoundingSphere;
use photopic::render::light::environment::Environment;
use photopic::render::material::Material;
use photopic::render::material::dielectric::Dielectric;
use photopic::render::material::opaque::Opaque;
use photopic::render::material::thin_slab::ThinSlab;
use photopic::render::ray::Ray;
use photopic::render::sampler::Sampler;
use photopic::render::scene::{Part, Scene};
use photopic::render::shape::Shape;
use photopic::render::shape::plane::Plane;
use photopic::render::shape::sphere::Sphere;

use crate::common::shared;

/// Everything below shines with a radiance of 1; above it is dark.
fn scene(faces: Vec<(f64, Arc<dyn Material>)>) -> Scene {
    let black: Arc<dyn Material> = Arc::new(Opaque::new(Box::new(Lambert::new(vec![0.0]).unwrap()), true));
    let plane = |z: f64| -> Arc<dyn Shape> { Arc::new(Plane::new(DVec3::new(0.0, 0.0, z), DVec3::Z).unwrap()) };
    let mut parts =
        vec![Part { shape: plane(-1.0), material: black, emission: Some(Arc::new(Emission::diffuse(vec![1.0]))) }];
    parts.extend(faces.into_iter().map(|(z, material)| Part { shape: plane(z), material, emission: None }));
    Scene::new(Bands::lines(vec![555.0]), parts, Vec::new())
}

/// The radiance seen through the pane from above, at the angle given.
fn seen(scene: &Scene, theta_deg: f64, polarisation: bool, samples: u64) -> Figure {
    let limits = Limits { polarisation, ..Limits::default() };
    let (sin, cos) = theta_deg.to_radians().sin_cos();
    let ray = Ray { origin: DVec3::new(0.3, 0.0, 2.0), direction: DVec3::new(0.6 * sin, 0.8 * sin, -cos) };
    let mut tracer = PathTracer::new(scene, limits, &[1.0]);
    let replicates = (0..REPLICATES as u64).map(|stream| {
        let mut sampler = Sampler::new(11, stream, 0);
        let mut replicate = Replicate::new(1);
        while replicate.samples() < samples {
            sampler.start(replicate.samples());
            replicate.add(stream, tracer.radiance(ray, &mut sampler));
        }
        replicate
    });
    let estimate = Estimate::new(replicates.collect());
    assert_eq!(estimate.faults().count(), 0);
    estimate.figure(&[1.0])
}

#[test]
fn a_solid_pane_transmits_as_its_closed_form_says() {
    let Some(path) = shared("render/analytic.json") else { return };
    let cases: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    for (name, eta, theta_deg) in [
        ("slab_n1.5_0deg", 1.5, 0.0),
        ("slab_n1.5168_0deg", 1.5168, 0.0),
        ("slab_n1.5_60deg", 1.5, 60.0),
        ("slab_n1.52_60deg", 1.52, 60.0),
        ("slab_n1.52_75deg", 1.52, 75.0),
    ] {
        let top: Arc<dyn Material> = Arc::new(Dielectric::new(&[1.0], &[eta]).unwrap());
        let bottom: Arc<dyn Material> = Arc::new(Dielectric::new(&[eta], &[1.0]).unwrap());
        let pane = scene(vec![(0.1, top), (0.0, bottom)]);
        for (index, polarisation) in [(0, true), (1, false)] {
            let expected = cases[name]["value"][index].as_f64().unwrap();
            let figure = seen(&pane, theta_deg, polarisation, 1 << 15);
            let off = (figure.value - expected).abs();
            println!(
                "| {name}, polarisation {polarisation} | {expected:.8} | {:.8} | {:.1e} |",
                figure.value, figure.standard_error
            );
            assert!(figure.standard_error < 1e-3 * expected, "{name}: {figure:?}");
            assert!(off <= 3.0 * figure.standard_error, "{name} {polarisation}: {figure:?}, expected {expected}");
        }
    }
}

/// Panes behind one another: each passes (1 − R)/(1 + R), the pile of m of them (1 − R)/(1 + (2m − 1)R), for s and p apart
/// (G. G. Stokes, Proc. R. Soc. 11 (1862)): what one pane polarises, the others know.
#[test]
fn a_pile_of_thin_panes_is_stokes_pile_of_plates() {
    let (eta, theta_deg) = (1.5, 56.31_f64);
    let cos = theta_deg.to_radians().cos();
    let face = photopic::brdf::fresnel::dielectric_components(cos, eta);
    let thin: Arc<dyn Material> = Arc::new(ThinSlab::new(&[eta], &[1.0]).unwrap());
    let pile = scene((0..4).map(|i| (0.1 * f64::from(i), Arc::clone(&thin))).collect());
    let expected = 0.5 * [face.s, face.p].map(|r| (1.0 - r) / (1.0 + 7.0 * r)).iter().sum::<f64>();
    let figure = seen(&pile, theta_deg, true, 1 << 16);
    assert!((figure.value - expected).abs() <= 3.0 * figure.standard_error, "{figure:?} {expected}");
    assert!(figure.standard_error < 1e-3 * expected);
}

/// In surroundings of radiance 1 every path through a ball that absorbs nothing sees just that (L/n² is the same along a ray). However
/// early chance may end paths, it ends none of these: within the glass they are worth as much as before it, though they carry 1/n².
#[test]
fn chance_spares_paths_in_glass() {
    let around = BoundingSphere::new(DVec3::ZERO, 3.0).expect("a sphere");
    let sky = Environment::constant(&[1.0], around).expect("a sky");
    let ball: Arc<dyn Shape> = Arc::new(Sphere::new(DVec3::ZERO, 1.0).expect("a ball"));
    for index in [1.2, 1.5, 2.4] {
        let part = Part {
            shape: Arc::clone(&ball),
            material: Arc::new(Dielectric::new(&[1.0], &[index]).expect("glass")),
            emission: None,
        };
        let scene = Scene::new(Bands::lines(vec![555.0]), vec![part], vec![Arc::new(sky.clone())]);
        let limits = Limits { polarisation: false, roulette_from: 0, ..Limits::default() };
        let mut tracer = PathTracer::new(&scene, limits, &[1.0]);
        for index in 0..2000 {
            let mut sampler = Sampler::new(4, 1, index);
            let [u, v, ..] = sampler.four();
            let ray = Ray { origin: DVec3::new(1.4 * (u - 0.5), 1.4 * (v - 0.5), 2.0), direction: DVec3::NEG_Z };
            let seen = tracer.radiance(ray, &mut sampler)[0];
            // A dozen factors of rounding each way.
            assert!((seen - 1.0).abs() < 1e-13, "{seen}");
        }
    }
}

//! The cases of `../shared/render/analytic.json`: each within three standard errors at a relative standard error of 0.1 %. With `--nocapture` the
//! tests print what was expected, what they got and its standard error.

use std::sync::Arc;

use glam::DVec3;
use photopic::brdf::lambert::Lambert;
use photopic::render::bands::Bands;
use photopic::render::emission::Emission;
use photopic::render::estimate::Figure;
use photopic::render::integrator::limits::{Follow, Limits};
use photopic::render::light::Light;
use photopic::render::light::bounding::BoundingSphere;
use photopic::render::light::environment::Environment;
use photopic::render::light::point::Point;
use photopic::render::light::sky::{Sky, SkyType};
use photopic::render::material::Material;
use photopic::render::material::opaque::Opaque;
use photopic::render::measure::{Board, Meter, Place, Settings, Target};
use photopic::render::ray::SurfacePoint;
use photopic::render::scene::{Part, Scene};
use photopic::render::sensor::response::Response;
use photopic::render::shape::Shape;
use photopic::render::shape::disk::Disk;
use photopic::render::shape::rectangle::Rectangle;
use photopic::render::shape::sphere::Sphere;
use photopic::render::spool::Share;
use serde_json::Value;

use crate::common::shared;

/// The relative standard error that the cases are run to.
const PRECISION: f64 = 1e-3;

fn cases() -> Option<Value> {
    let text = std::fs::read_to_string(shared("render/analytic.json")?).expect("the cases can be read");
    Some(serde_json::from_str(&text).expect("the cases are JSON"))
}

fn value(cases: &Value, name: &str) -> f64 {
    cases[name]["value"].as_f64().unwrap_or_else(|| panic!("{name} is a number"))
}

/// One band whose unit is that of the case (cd/m², lx).
fn band() -> Bands {
    Bands::lines(vec![555.0])
}

fn lambert(reflectance: f64) -> Arc<dyn Material> {
    Arc::new(Opaque::new(Box::new(Lambert::new(vec![reflectance]).expect("a reflectance")), true))
}

pub(crate) fn part(shape: impl Shape + 'static, reflectance: f64, radiance: Option<f64>) -> Part {
    Part {
        shape: Arc::new(shape),
        material: lambert(reflectance),
        emission: radiance.map(|l| Arc::new(Emission::diffuse(vec![l]))),
    }
}

pub(crate) fn scene(parts: Vec<Part>, lights: Vec<Arc<dyn Light>>) -> Scene {
    Scene::new(band(), parts, lights)
}

pub(crate) fn at(position: DVec3, axis: DVec3) -> Place {
    Place::Point(SurfacePoint::meter(position, axis, 0.0))
}

/// What a meter reads, run until its standard error is small enough.
pub(crate) fn read(scene: &Scene, place: Place, seed: u64) -> Figure {
    read_to(scene, place, seed, PRECISION)
}

fn read_to(scene: &Scene, place: Place, seed: u64, relative: f64) -> Figure {
    let settings = Settings::new(seed, Limits::default(), 1);
    let meter = Meter { place, response: Response::Planar };
    let mut board = Board::new(scene, &settings, Share::WHOLE, vec![(0, meter)]);
    let target = Target { relative, meters: vec![0], weights: vec![1.0] };
    assert!(board.sample_to(&target, 1 << 20, |_, _| ()), "{:?}", board.estimate(0).figure(&[1.0]));
    assert_eq!(board.estimate(0).faults().count(), 0, "no faulty samples");
    board.estimate(0).figure(&[1.0])
}

/// Three standard errors; a figure without scatter is right to rounding.
pub(crate) fn agrees(figure: Figure, expected: f64, name: &str) {
    println!("| {name} | {expected:.8} | {:.8} | {:.1e} |", figure.value, figure.standard_error);
    let allowed = (3.0 * figure.standard_error).max(1e-12 * expected.abs());
    assert!((figure.value - expected).abs() <= allowed, "{name}: {figure:?}, expected {expected}");
}

#[test]
fn a_point_source() {
    let Some(cases) = cases() else { return };
    let lamp = Point::new(DVec3::new(0.0, 0.0, 2.0), &[1000.0]).expect("a lamp");
    let scene = scene(Vec::new(), vec![Arc::new(lamp)]);
    for r in [0.0, 1.0, 3.0] {
        let figure = read(&scene, at(DVec3::new(r, 0.0, 0.0), DVec3::Z), 1);
        let name = format!("point_I1000_h2_r{r}");
        agrees(figure, value(&cases, &name), &name);
    }
}

#[test]
fn a_disk_a_rectangle_and_a_sphere() {
    let Some(cases) = cases() else { return };
    let disk = Disk::new(DVec3::new(0.0, 0.0, 1.0), DVec3::NEG_Z, 0.5).expect("a disk");
    let disk = scene(vec![part(disk, 0.0, Some(1000.0))], Vec::new());
    for d in [0.0, 0.5, 1.0, 3.0] {
        let figure = read(&disk, at(DVec3::new(d, 0.0, 0.0), DVec3::Z), 2);
        let name = format!("disk_L1000_R0.5_h1_d{d}");
        agrees(figure, value(&cases, &name), &name);
    }
    let square = Rectangle::new(DVec3::new(0.0, 0.0, 1.0), DVec3::Y, DVec3::X).expect("a square");
    let square = scene(vec![part(square, 0.0, Some(1.0))], Vec::new());
    let corner = read(&square, at(DVec3::ZERO, DVec3::Z), 3);
    agrees(corner, value(&cases, "rect_corner_1x1_h1_E_over_L"), "rectangle, corner");
    let centre = read(&square, at(DVec3::new(0.5, 0.5, 0.0), DVec3::Z), 3);
    agrees(centre, value(&cases, "rect_centre_1x1_h1_E_over_L"), "rectangle, centre");
    let ball = Sphere::new(DVec3::new(0.0, 0.0, 2.0), 0.5).expect("a ball");
    let ball = scene(vec![part(ball, 0.0, Some(1000.0))], Vec::new());
    agrees(read(&ball, at(DVec3::ZERO, DVec3::Z), 4), value(&cases, "sphere_R0.5_D2_L1000"), "ball");
}

/// A lamp in the middle of a white sphere: the wall receives Φ/(A (1 − ρ)). No path is cut, whatever ρ.
#[test]
fn an_integrating_sphere() {
    let Some(cases) = cases() else { return };
    for (rho, name) in [(0.5, "0.5"), (0.9, "0.9"), (0.98, "0.98")] {
        let wall = Sphere::new(DVec3::ZERO, 0.5).expect("a sphere");
        let lamp = Point::new(DVec3::ZERO, &[1000.0 / (4.0 * std::f64::consts::PI)]).expect("a lamp");
        let scene = scene(vec![part(wall, rho, None)], vec![Arc::new(lamp)]);
        let place = Place::Point(SurfacePoint::meter(DVec3::new(0.5, 0.0, 0.0), DVec3::NEG_X, 1e-12));
        let figure = read(&scene, place, 5);
        let expected = cases[format!("int_sphere_r0.5_1000lm_rho{name}")]["value"][1].as_f64().expect("a number");
        agrees(figure, expected, &format!("integrating sphere, reflectance {name}"));
    }
}

/// As white as no paint is: a thousand reflections of a path. 0.3 % instead of 0.1 %, since the latter takes 10⁹ of them.
#[test]
fn an_integrating_sphere_of_999_thousandths() {
    let wall = Sphere::new(DVec3::ZERO, 0.5).expect("a sphere");
    let lamp = Point::new(DVec3::ZERO, &[1000.0 / (4.0 * std::f64::consts::PI)]).expect("a lamp");
    let scene = scene(vec![part(wall, 0.999, None)], vec![Arc::new(lamp)]);
    let place = Place::Point(SurfacePoint::meter(DVec3::new(0.5, 0.0, 0.0), DVec3::NEG_X, 1e-12));
    // Φ/(A (1 − ρ)), A = π m².
    agrees(read_to(&scene, place, 5, 3e-3), 1e6 / std::f64::consts::PI, "integrating sphere, reflectance 0.999");
}

/// Form factors as illuminances, E/(π L): from a floor to a wall of a cube, between squares opposite each other and coaxial disks, and
/// between concentric spheres; and a point beside an upright square.
#[test]
fn form_factors() {
    let Some(cases) = cases() else { return };
    let factor = |lamp: Part, receiver: Arc<dyn Shape>, seed| {
        let figure = read(&scene(vec![lamp], Vec::new()), Place::Area(receiver), seed);
        Figure {
            value: figure.value / std::f64::consts::PI,
            standard_error: figure.standard_error / std::f64::consts::PI,
        }
    };
    let square = |corner, a, b| Rectangle::new(corner, a, b).expect("a square");
    let floor: Arc<dyn Shape> = Arc::new(square(DVec3::ZERO, DVec3::X, DVec3::Y));
    let wall = || part(square(DVec3::ZERO, DVec3::Y, DVec3::Z), 0.0, Some(1.0));
    agrees(factor(wall(), Arc::clone(&floor), 20), value(&cases, "F12_cube_adjacent"), "adjacent squares");
    let lid = part(square(DVec3::Z, DVec3::Y, DVec3::X), 0.0, Some(1.0));
    agrees(factor(lid, floor, 21), value(&cases, "F12_unit_squares_parallel_d1"), "opposite squares");
    let disk = |z: f64, normal| Disk::new(DVec3::new(0.0, 0.0, z), normal, 1.0).expect("a disk");
    let lid = part(disk(1.0, DVec3::NEG_Z), 0.0, Some(1.0));
    let below: Arc<dyn Shape> = Arc::new(disk(0.0, DVec3::Z));
    agrees(factor(lid, below, 22), value(&cases, "F12_coaxial_disks_r1_d1"), "coaxial disks");
    let upright = scene(vec![wall()], Vec::new());
    let beside = read(&upright, at(DVec3::X, DVec3::Z), 23);
    agrees(beside, value(&cases, "rect_perp_b1_a1_c1_E_over_L"), "a point beside a square");

    // The wall of the outer sphere sees the inner one, and the rest of itself.
    let ball = |radius, radiance: Option<f64>| {
        let mut ball = part(Sphere::new(DVec3::ZERO, radius).expect("a sphere"), 0.0, None);
        ball.emission = radiance.map(|l| Arc::new(Emission::new(vec![l / std::f64::consts::PI], 0.0, true)));
        ball
    };
    let factors = cases["concentric_spheres_F21_F22_r1_0.5_r2_1"]["value"].as_array().expect("numbers");
    for (inner, outer, expected) in [(Some(1.0), None, &factors[0]), (None, Some(1.0), &factors[1])] {
        let spheres = scene(vec![ball(0.5, inner), ball(1.0, outer)], Vec::new());
        let on_the_wall = Place::Point(SurfacePoint::meter(DVec3::X, DVec3::NEG_X, 1e-12));
        agrees(read(&spheres, on_the_wall, 24), expected.as_f64().expect("a number"), "concentric spheres");
    }
}

/// The mean over the walls of a closed cube of edge 4 m with a lamp of 10 000 lm in its middle.
#[test]
fn a_closed_cube() {
    let Some(cases) = cases() else { return };
    let expected = cases["int_cube_4m_10000lm"]["value"].as_array().expect("numbers");
    for (rho, expected) in [0.0, 0.2, 0.5, 0.8].into_iter().zip(expected) {
        let face = |n: usize| {
            let axis = DVec3::AXES[n % 3] * if n < 3 { 1.0 } else { -1.0 };
            let (s, t) = (DVec3::AXES[(n + 1) % 3] * 4.0, DVec3::AXES[(n + 2) % 3] * 4.0);
            let corner = 2.0 * axis - 0.5 * (s + t);
            // Normals look inwards.
            if n < 3 { Rectangle::new(corner, t, s) } else { Rectangle::new(corner, s, t) }.expect("a face")
        };
        let lamp = Point::new(DVec3::ZERO, &[10_000.0 / (4.0 * std::f64::consts::PI)]).expect("a lamp");
        let scene = scene((0..6).map(|n| part(face(n), rho, None)).collect(), vec![Arc::new(lamp)]);
        let figure = read(&scene, Place::Area(Arc::new(face(4))), 6);
        agrees(figure, expected.as_f64().expect("a number"), &format!("cube, reflectance {rho}"));
    }
}

/// L = L_e/(1 − ρ) inside a closed surface that emits L_e and reflects ρ everywhere.
#[test]
fn a_glowing_enclosure() {
    let Some(cases) = cases() else { return };
    let expected = cases["enclosure_L_over_Le"]["value"].as_array().expect("numbers");
    for (rho, expected) in [0.5, 0.9, 0.99].into_iter().zip(expected) {
        let wall = Sphere::new(DVec3::ZERO, 2.0).expect("a sphere");
        let mut part = part(wall, rho, None);
        part.emission = Some(Arc::new(Emission::new(vec![1.0], 0.0, true)));
        let scene = scene(vec![part], Vec::new());
        let figure = read(&scene, at(DVec3::new(0.3, -0.5, 0.7), DVec3::Z), 8);
        let expected = expected.as_f64().expect("a number") * std::f64::consts::PI;
        agrees(figure, expected, &format!("enclosure, reflectance {rho}"));
    }
}

/// A black ball hides part of a uniform sky.
#[test]
fn an_occluded_sky() {
    let Some(cases) = cases() else { return };
    let ball = Sphere::new(DVec3::new(0.0, 0.0, 2.0), 1.0).expect("a ball");
    let around = BoundingSphere::new(DVec3::ZERO, 10.0).expect("a sphere");
    let sky = Environment::constant(&[1000.0], around).expect("a sky");
    let scene = scene(vec![part(ball, 0.0, None)], vec![Arc::new(sky)]);
    let figure = read(&scene, at(DVec3::ZERO, DVec3::Z), 7);
    agrees(figure, value(&cases, "sphere_occluder_R1_h2_uniform_sky"), "occluded sky");
}

/// The traditional overcast sky on horizontal and vertical surfaces.
#[test]
fn an_overcast_sky() {
    let Some(cases) = cases() else { return };
    let around = BoundingSphere::new(DVec3::ZERO, 10.0).expect("a sphere");
    let kind = SkyType::new(16).expect("the overcast sky");
    let sky = Sky::from_zenith(kind, DVec3::Z, DVec3::Z, &[1.0], around).expect("a sky");
    let scene = scene(Vec::new(), vec![Arc::new(sky)]);
    agrees(read(&scene, at(DVec3::ZERO, DVec3::Z), 9), value(&cases, "CIE_overcast_Eh_over_Lz"), "horizontal");
    agrees(read(&scene, at(DVec3::ZERO, DVec3::X), 9), value(&cases, "CIE_overcast_Ev_over_Lz"), "vertical");
}

/// A flat spectral radiance of 1 W/(m²·sr·nm) from everywhere: a spot meter reads the observer's own sum, 683.002 applied once.
#[test]
fn a_flat_spectral_radiance() {
    let Some(cases) = cases() else { return };
    let bands = Bands::uniform(360.0, 1.0);
    let v = photopic::photometry::luminous::Efficiency::default().weighting();
    let weights: Vec<f64> = bands.weights(&v).into_iter().map(|w| w * photopic::constants::K_M).collect();
    let around = BoundingSphere::new(DVec3::ZERO, 10.0).expect("a sphere");
    let sky = Environment::constant(&vec![1.0; bands.len()], around).expect("a sky");
    let scene = Scene::new(bands, Vec::new(), vec![Arc::new(sky)]);
    let settings = Settings::new(1, Limits::default(), scene.bands().len());
    let meter = Meter { place: at(DVec3::ZERO, DVec3::X), response: Response::Cone { sin: 0.01 } };
    let mut board = Board::new(&scene, &settings, Share::WHOLE, vec![(0, meter)]);
    board.sample_until(2);
    let figure = board.estimate(0).figure(&weights);
    // The case prints 72 983.5 cd/m²; every sample is the same.
    assert!((figure.value - value(&cases, "flat_1_W_m2_nm_lx")).abs() < 0.05, "{figure:?}");
    assert!(figure.standard_error < 1e-9 * figure.value, "{figure:?}");
}

/// Direct light alone, and the same without shadows: L = ρ/π · E below a square of 1 cd/m², with a black ball before the meter's own
/// light that hides all of it.
#[test]
fn direct_light_with_and_without_shadows() {
    let Some(cases) = cases() else { return };
    let square = || Rectangle::new(DVec3::new(0.0, 0.0, 1.0), DVec3::Y, DVec3::X).expect("a square");
    let floor = || Rectangle::new(DVec3::new(-2.0, -2.0, 0.0), DVec3::X * 5.0, DVec3::Y * 5.0).expect("a floor");
    let lid = || Rectangle::new(DVec3::new(-3.0, -3.0, 0.9), DVec3::X * 7.0, DVec3::Y * 7.0).expect("a lid");
    let expected = 0.6 / std::f64::consts::PI * value(&cases, "rect_centre_1x1_h1_E_over_L");
    let look = |parts, limits| {
        let scene = scene(parts, Vec::new());
        let settings = Settings::new(12, limits, 1);
        let above = DVec3::new(0.5, 0.5, 0.5);
        let meter = Meter { place: at(above, DVec3::NEG_Z), response: Response::Cone { sin: 1e-4 } };
        let mut board = Board::new(&scene, &settings, Share::WHOLE, vec![(0, meter)]);
        board.sample_until(1 << 13);
        board.estimate(0).figure(&[1.0])
    };
    let bare = || vec![part(square(), 0.0, Some(1.0)), part(floor(), 0.6, None)];
    let hidden = || bare().into_iter().chain([part(lid(), 0.0, None)]).collect::<Vec<_>>();
    for follow in [Follow::Nothing, Follow::Specular] {
        let direct = Limits { follow, ..Limits::default() };
        agrees(look(bare(), direct), expected, "direct");
        assert_eq!(look(hidden(), direct).value, 0.0);
        agrees(look(hidden(), Limits { shadows: false, ..direct }), expected, "without shadows");
    }
}

/// A point, and a small diffuse disk of the same intensity, light a meter alike, and the disk as a luminaire would.
#[test]
fn a_point_and_a_small_disk_agree() {
    let expected = 100.0 / 4.0;
    let above = DVec3::new(0.0, 0.0, 2.0);
    let point = scene(Vec::new(), vec![Arc::new(Point::new(above, &[100.0]).expect("a lamp"))]);
    agrees(read(&point, at(DVec3::ZERO, DVec3::Z), 10), expected, "point");
    // I = L A: a disk of 1 mm differs from a point by (r/d)² = 2.5e-7.
    let radius = 1e-3;
    let radiance = 100.0 / (std::f64::consts::PI * radius * radius);
    let disk = Disk::new(above, DVec3::NEG_Z, radius).expect("a disk");
    let disk = scene(vec![part(disk, 0.0, Some(radiance))], Vec::new());
    let figure = read(&disk, at(DVec3::ZERO, DVec3::Z), 10);
    assert!((figure.value / expected - 1.0).abs() < 3.0 * figure.standard_error / expected + 2.5e-7, "{figure:?}");
}

/// The rectangle and the point hold at every size about the origin, and a case of 1 m a thousand kilometres away.
#[test]
fn sizes_and_places() {
    let Some(cases) = cases() else { return };
    let over_l = value(&cases, "rect_centre_1x1_h1_E_over_L");
    let place = |size: f64, origin: DVec3| {
        let square = Rectangle::new(origin + DVec3::Z * size, DVec3::Y * size, DVec3::X * size).expect("a square");
        let below = Rectangle::new(origin - (DVec3::X + DVec3::Y) * size, DVec3::X * 3.0 * size, DVec3::Y * 3.0 * size);
        // The meter lies on a black floor.
        let scene = scene(vec![part(square, 0.0, Some(1.0)), part(below.expect("a floor"), 0.0, None)], Vec::new());
        let middle = origin + DVec3::new(0.5, 0.5, 0.0) * size;
        let point = SurfacePoint::meter(middle, DVec3::Z, scene.rounding_at(middle));
        read_to(&scene, Place::Point(point), 11, 2e-5)
    };
    for size in [1e-8, 1e-5, 1e-2, 1.0, 1e2, 1e5, 1e8] {
        let figure = place(size, DVec3::ZERO);
        assert!((figure.value / over_l - 1.0).abs() < 1e-4, "size {size}: {figure:?}, expected {over_l}");
        let lamp = Point::new(DVec3::Z * 2.0 * size, &[1000.0 * size * size]).expect("a lamp");
        let lamp = scene(Vec::new(), vec![Arc::new(lamp)]);
        let expected = value(&cases, "point_I1000_h2_r1");
        let figure = read(&lamp, at(DVec3::X * size, DVec3::Z), 11);
        assert!((figure.value / expected - 1.0).abs() < 1e-12, "size {size}: {figure:?}");
    }
    let figure = place(1.0, DVec3::new(1e6, -1e6, 1e6));
    assert!((figure.value / over_l - 1.0).abs() < 1e-4, "far away: {figure:?}");
}

//! Radiosity against closed forms and against path tracing.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use photopic::render::emission::Emission;
use photopic::render::form_factor::{adjacent_rectangles, coaxial_disks, parallel_rectangles};
use photopic::render::light::Light;
use photopic::render::light::point::Point;
use photopic::render::measure::{Meter, Place};
use photopic::render::radiosity::gather::Gatherer;
use photopic::render::radiosity::{Settings, Solution, Summary, solve};
use photopic::render::ray::SurfacePoint;
use photopic::render::scene::{Part, Scene};
use photopic::render::sensor::response::Response;
use photopic::render::shape::Shape;
use photopic::render::shape::disk::Disk;
use photopic::render::shape::polyhedron::Polyhedron;
use photopic::render::shape::rectangle::Rectangle;
use photopic::render::shape::sphere::Sphere;
use predicates::str::contains;
use serde_json::Value;

use crate::analytic::{part, scene as of_parts};
use crate::cli::{json, photopic, scene};

fn settings(edge_m: f64) -> Settings {
    Settings { edge_m: Some(edge_m), tolerance: 1e-9 }
}

fn solved(scene: &Scene, edge_m: f64) -> Solution<'_> {
    solve(scene, &settings(edge_m), &[1.0]).expect("a solution")
}

fn on(scene: &Scene, solution: &Solution<'_>, surface: usize) -> f64 {
    let place = Place::Area(Arc::clone(&scene.surfaces().shapes()[surface]));
    Gatherer::new(solution).reading(&Meter { place, response: Response::Planar }).expect("a meter")[0]
}

fn at(solution: &Solution<'_>, position: DVec3, axis: DVec3) -> f64 {
    let place = Place::Point(SurfacePoint::meter(position, axis, 1e-12));
    Gatherer::new(solution).reading(&Meter { place, response: Response::Planar }).expect("a meter")[0]
}

/// A face of the cube from −half to half, looking inwards.
fn face(n: usize, half: f64) -> Rectangle {
    let axis = DVec3::AXES[n % 3] * if n < 3 { 1.0 } else { -1.0 };
    let (s, t) = (DVec3::AXES[(n + 1) % 3] * 2.0 * half, DVec3::AXES[(n + 2) % 3] * 2.0 * half);
    let corner = half * axis - 0.5 * (s + t);
    if n < 3 { Rectangle::new(corner, t, s) } else { Rectangle::new(corner, s, t) }.expect("a face")
}

fn lamp(lm: f64) -> Vec<Arc<dyn Light>> {
    vec![Arc::new(Point::new(DVec3::ZERO, &[lm / (4.0 * PI)]).expect("a lamp"))]
}

fn closes(s: &Summary) {
    assert!(s.balance_w().abs() <= 1e-6 * s.emitted_w, "{s:?}");
}

/// The mean over the walls of a closed cube with a lamp in its middle is Φ/(S(1 − ρ)) whatever the patches, and nothing escapes.
#[test]
fn a_closed_cube() {
    for rho in [0.0, 0.2, 0.5, 0.8] {
        let scene = of_parts((0..6).map(|n| part(face(n, 2.0), rho, None)).collect(), lamp(10_000.0));
        let solution = solved(&scene, 1.0);
        // 10 000 lm / (96 m² (1 − ρ)): `int_cube_4m_10000lm` of the shared cases.
        let expected = 10_000.0 / 96.0 / (1.0 - rho);
        for surface in 0..6 {
            let mean = on(&scene, &solution, surface);
            assert!((mean / expected - 1.0).abs() < 1e-6, "{rho} {surface}: {mean} {expected}");
        }
        let s = solution.summary;
        closes(&s);
        assert!(
            s.escaped_w.abs() < 1e-6 * s.emitted_w * expected / 100.0 && (s.greatest_sum - 1.0).abs() < 1e-6,
            "{s:?}"
        );
    }
}

/// Within a sphere all is exact: the wall receives Φ/(A(1 − ρ)).
#[test]
fn an_integrating_sphere() {
    for rho in [0.5, 0.9, 0.98] {
        let wall = Sphere::new(DVec3::ZERO, 0.5).expect("a sphere");
        let scene = of_parts(vec![part(wall, rho, None)], lamp(1000.0));
        let solution = solved(&scene, 0.3);
        let expected = 1000.0 / PI / (1.0 - rho);
        let got = at(&solution, DVec3::new(0.0, 0.0, -0.5), DVec3::Z);
        assert!((got / expected - 1.0).abs() < 1e-6, "{rho}: {got} {expected}");
        closes(&solution.summary);
    }
}

/// Irradiances of black receivers are form factors: of squares and disks in the catalogue's closed forms, whatever the patches.
#[test]
fn form_factors() {
    let square = |corner, a, b| Rectangle::new(corner, a, b).expect("a square");
    let floor = || part(square(DVec3::ZERO, DVec3::X, DVec3::Y), 0.0, None);
    let shining = |shape| part(shape, 0.0, Some(1.0 / PI));
    let wall = of_parts(vec![floor(), shining(square(DVec3::ZERO, DVec3::Y, DVec3::Z))], Vec::new());
    let lid = of_parts(vec![floor(), shining(square(DVec3::Z, DVec3::Y, DVec3::X))], Vec::new());
    for edge in [1.0, 0.35] {
        let got = on(&wall, &solved(&wall, edge), 0);
        let expected = adjacent_rectangles(1.0, 1.0, 1.0);
        assert!((got - expected).abs() < 1e-6, "adjacent, {edge}: {got} {expected}");
        let got = on(&lid, &solved(&lid, edge), 0);
        let expected = parallel_rectangles(1.0, 1.0, 1.0);
        assert!((got - expected).abs() < 1e-6, "opposite, {edge}: {got} {expected}");
    }
    let disk = |z: f64, normal| Disk::new(DVec3::new(0.0, 0.0, z), normal, 1.0).expect("a disk");
    let above = Part {
        emission: Some(Arc::new(Emission::diffuse(vec![1.0 / PI]))),
        ..part(disk(1.0, DVec3::NEG_Z), 0.0, None)
    };
    let disks = of_parts(vec![part(disk(0.0, DVec3::Z), 0.0, None), above], Vec::new());
    // Round edges are chords of 3.75° of the same area: 2e-5 (see the cells of a disk).
    let (got, expected) = (on(&disks, &solved(&disks, 0.5), 0), coaxial_disks(1.0, 1.0, 1.0));
    assert!((got - expected).abs() < 2e-5, "disks: {got} {expected}");
}

/// A cube of grey walls with a lamp out of its middle, at a point of the floor: halving the patches takes at least half of the difference away.
#[test]
fn smaller_patches_converge() {
    let lamp = Point::new(DVec3::new(0.4, -0.3, 0.9), &[100.0]).expect("a lamp");
    let scene = of_parts((0..6).map(|n| part(face(n, 1.0), 0.7, None)).collect(), vec![Arc::new(lamp)]);
    let read = |edge| at(&solved(&scene, edge), DVec3::new(0.2, 0.1, -1.0), DVec3::Z);
    let [a, b, c] = [1.0, 0.5, 0.25].map(read);
    assert!((c - b).abs() < 0.5 * (b - a).abs(), "{a} {b} {c}");
}

/// In a closed room whose walls and blocks all have the exitance M and the reflectance ρ the irradiance is M/(1 − ρ) at every place, whatever stands
/// there (the equations' own solution, as form factors sum to 1): beside a turned block, under one that leans, and in a corner. Off it is what
/// four rays to each patch do not see of its edges.
#[test]
fn a_glowing_room_is_evenly_lit_about_its_blocks() {
    let rho = 0.5;
    let glowing = |shape: Arc<dyn Shape>| Part { shape, ..part(face(0, 1.0), rho, Some(1.0 / PI)) };
    let block = |turn: DMat3, size: DVec3, middle: DVec3| {
        let corner = |i: u32| {
            let sign = |bit: u32| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
            middle + turn * (size * DVec3::new(sign(0), sign(1), sign(2)))
        };
        let corners: Vec<DVec3> = (0..8).map(corner).collect();
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        Polyhedron::new(&corners, &faces.map(|f| f.to_vec())).expect("a block")
    };
    let standing = block(DMat3::from_rotation_z(0.4), DVec3::new(0.6, 0.5, 0.8), DVec3::new(-0.3, 0.2, -0.6));
    let leaning = block(DMat3::from_rotation_y(0.5), DVec3::new(0.3, 0.4, 0.3), DVec3::new(0.5, -0.4, 0.0));
    let mut parts: Vec<Part> = (0..6).map(|n| glowing(Arc::new(face(n, 1.0)))).collect();
    parts.extend([glowing(Arc::new(standing)), glowing(Arc::new(leaning))]);
    let scene = of_parts(parts, Vec::new());
    let solution = solved(&scene, 0.25);
    let expected = 1.0 / (1.0 - rho);
    for (x, y, z, axis) in [
        // 5 mm before the block's side, and on the floor between two of its edges.
        (-0.3 + 0.306 * 0.4_f64.cos(), 0.2 + 0.306 * 0.4_f64.sin(), -1.0, DVec3::Z),
        (0.3, -0.3, -1.0, DVec3::Z),
        (0.5, -0.4, -1.0, DVec3::Z),
        (-0.99, 0.99, -1.0, DVec3::Z),
        (-0.3, 0.2, -0.2 + 1e-9, DVec3::Z),
        (1.0, 0.2, 0.3, DVec3::NEG_X),
    ] {
        let got = at(&solution, DVec3::new(x, y, z), axis);
        assert!((got / expected - 1.0).abs() < 0.01, "{x} {y} {z}: {got} {expected}");
    }
    assert!(solution.summary.greatest_sum < 1.05, "{:?}", solution.summary);
}

/// A box of coloured walls with a block and a square lamp, and a room under a luminaire of a file.
const BOX: &str = r#"
[spectra]
white = [[360, 0.60], [500, 0.75], [780, 0.75]]
red = [[360, 0.05], [560, 0.05], [640, 0.60], [780, 0.65]]
[[material]]
name = "white"
reflectance = "white"
[[material]]
name = "red"
reflectance = "red"
[[shape]]
name = "floor"
material = "white"
rectangle = { corner = [-1, -1, 0], edges = [[2, 0, 0], [0, 2, 0]] }
[[shape]]
material = "white"
rectangle = { corner = [-1, -1, 2], edges = [[0, 2, 0], [2, 0, 0]] }
[[shape]]
material = "white"
rectangle = { corner = [-1, 1, 0], edges = [[2, 0, 0], [0, 0, 2]] }
[[shape]]
material = "red"
rectangle = { corner = [-1, -1, 0], edges = [[0, 2, 0], [0, 0, 2]] }
[[shape]]
material = "white"
box = { from = [-0.2, -0.1, 0.0], to = [0.4, 0.5, 0.8] }
"#;

const SQUARE: &str = r#"
[[shape]]
emission = { flux = "2000 lm", spectrum = "LED-B3" }
rectangle = { corner = [-0.25, -0.2, 1.95], edges = [[0, 0.4, 0], [0.5, 0, 0]] }
"#;

const SENSORS: &str = r#"
[[sensor]]
name = "wall"
illuminance = { at = [-0.99, 0, 1], normal = [1, 0, 0] }
[[sensor]]
name = "above the block"
illuminance = { at = [0.1, 0.2, 0.9] }
[[sensor]]
name = "about"
spherical = { at = [-0.5, -0.4, 1.2] }
[[sensor]]
name = "back wall"
luminance = { at = [0, -3, 1], look_at = [0.3, 1, 1.3], acceptance = "2 deg" }
"#;

fn sensors(command: &mut assert_cmd::Command) -> Vec<Value> {
    json(command)["results"][0]["sensors"].as_array().expect("sensors").clone()
}

/// The readings of both solvers are the same within three standard errors of the one and three times the other's discretisation (an error that
/// halves or better leaves at most the change from patches twice as long; visibility makes it uneven).
#[test]
fn radiosity_and_path_tracing_agree() {
    let lamps = concat!(env!("CARGO_MANIFEST_DIR"), "/data/lamps/panel.ldt");
    let luminaire = format!("[[light]]\nspectrum = \"LED-B3\"\nlamp = {{ file = \"{lamps}\", at = [0, 0, 1.95] }}\n");
    for light in [SQUARE, &luminaire] {
        let folder = tempfile::tempdir().expect("a folder");
        let text = format!("{BOX}{light}{SENSORS}");
        let path = scene(&folder, &text);
        let traced = sensors(photopic().arg("render").arg(&path).args([
            "--json",
            "--packets",
            "0",
            "--meter-samples",
            "131072",
        ]));
        let solver = "[render]\nsolver = \"radiosity\"\npatch_edge = \"0.2 m\"\n";
        let path = scene(&folder, &format!("{solver}{text}"));
        let run = || sensors(photopic().arg("render").arg(&path).args(["--json", "--packets", "0"]));
        let solved = run();
        let number = |v: &Value, key: &str| v[key].as_f64().unwrap_or_else(|| panic!("{key}: {v}"));
        for (a, b) in traced.iter().zip(&solved) {
            let (mean, other) = (number(a, "value"), number(b, "value"));
            let allowed = 3.0 * (number(a, "standard_error") + number(b, "discretisation"));
            assert!((mean - other).abs() <= allowed && allowed < 0.1 * mean, "{}: {mean} {other} {allowed}", a["name"]);
        }
        // The same to the last bit, with any number of threads.
        let mut one = photopic();
        one.env("RAYON_NUM_THREADS", "1").arg("render").arg(&path).args(["--json", "--packets", "0"]);
        assert_eq!(solved, sensors(&mut one));
    }
}

/// Blocks that stand on the floor, as they please, close to a lamp that hangs a finger's breadth below the ceiling: the mean over the floor is
/// the path tracer's within three standard errors and what is printed of the discretisation, and no patch passes light on to a block's
/// inside (form factors sum to 1 in a closed room, but for visibility by rays).
#[test]
fn light_under_blocks_agrees_with_path_tracing() {
    let turned = |angle_deg: f64, [x, y, h]: [f64; 3]| {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let at = |a: f64, b: f64, z: f64| format!("[{}, {}, {z}]", x + a * cos - b * sin, y + a * sin + b * cos);
        let corners: Vec<String> = [0.0, h]
            .iter()
            .flat_map(|z| [(-0.3, -0.25), (0.3, -0.25), (0.3, 0.25), (-0.3, 0.25)].map(|(a, b)| at(a, b, *z)))
            .collect();
        format!(
            "[[shape]]\nmaterial = \"white\"\npolyhedron = {{ vertices = [{}], faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]] }}\n",
            corners.join(", ")
        )
    };
    let room = "[[material]]\nname = \"white\"\nreflectance = 0.75\n[[shape]]\nname = \"floor\"\nmaterial = \"white\"\nrectangle = { corner = [-1, -1, 0], edges = [[2, 0, 0], [0, 2, 0]] }\n[[shape]]\nmaterial = \"white\"\nrectangle = { corner = [-1, -1, 2], edges = [[0, 2, 0], [2, 0, 0]] }\n[[shape]]\nmaterial = \"white\"\nrectangle = { corner = [-1, 1, 0], edges = [[2, 0, 0], [0, 0, 2]] }\n[[shape]]\nmaterial = \"white\"\nrectangle = { corner = [-1, -1, 0], edges = [[0, 2, 0], [0, 0, 2]] }\n[[shape]]\nmaterial = \"white\"\nrectangle = { corner = [1, -1, 0], edges = [[0, 0, 2], [0, 2, 0]] }\n";
    let lamp = "[[shape]]\nemission = { flux = \"2000 lm\", spectrum = \"line:555nm\" }\nrectangle = { corner = [-0.25, -0.2, 1.99], edges = [[0, 0.4, 0], [0.5, 0, 0]] }\n";
    let meter = "[[sensor]]\nname = \"floor\"\nilluminance = { on = \"floor\" }\n[[sensor]]\nname = \"wall\"\nilluminance = { at = [-0.99, 0, 1], normal = [1, 0, 0] }\n";
    for angles in [[0.0, 0.0], [17.0, -35.0]] {
        let folder = tempfile::tempdir().expect("a folder");
        let blocks = turned(angles[0], [-0.4, 0.35, 1.2]) + &turned(angles[1], [0.45, -0.3, 0.55]);
        let text = format!("{room}{blocks}{lamp}{meter}");
        let run = |head: &str| {
            let path = scene(&folder, &format!("{head}{text}"));
            json(photopic().arg("render").arg(path).args(["--json", "--packets", "0", "--meter-samples", "262144"]))
        };
        let (traced, solved) = (run(""), run("[render]\nsolver = \"radiosity\"\npatch_edge = \"0.17 m\"\n"));
        let number = |v: &Value, key: &str| v[key].as_f64().unwrap_or_else(|| panic!("{key}: {v}"));
        for index in [0, 1] {
            let [a, b] = [&traced, &solved].map(|out| &out["results"][0]["sensors"][index]);
            let (mean, other) = (number(a, "value"), number(b, "value"));
            let allowed = 3.0 * number(a, "standard_error") + number(b, "discretisation");
            assert!((mean - other).abs() <= allowed, "{angles:?}: {mean} {other} {allowed}");
            assert!(allowed < 0.02 * mean, "{angles:?}: {allowed} of {mean}");
        }
        let sum = number(&solved["results"][0]["radiosity"], "greatest_sum_of_form_factors");
        assert!(sum < 1.05, "{angles:?}: {sum}");
    }
}

/// What is not diffuse is refused by name and place, with the solver that takes it.
#[test]
fn what_radiosity_cannot_do_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let refuses = |more: &str, message: &str| {
        let text = format!("[render]\nsolver = \"radiosity\"\n{BOX}{SQUARE}{SENSORS}{more}");
        let path = scene(&folder, &text);
        photopic().arg("render").arg(path).arg("--check").assert().code(2).stderr(contains(message.to_owned()));
    };
    refuses(
        "[[material]]\nname = \"gold\"\nmetal = { medium = \"Au\" }\n[[shape]]\nname = \"ball\"\nmaterial = \"gold\"\nsphere = { centre = [0, 0, 1], radius = \"0.1 m\" }\n",
        "material `gold` of `ball` is not diffuse",
    );
    refuses(
        "[[shape]]\nname = \"ground\"\nplane = { point = [0, 0, -1], normal = [0, 0, 1] }\n",
        "`ground` is a plane without bounds",
    );
    refuses("[[sensor]]\nname = \"all\"\nintegrating_sphere = {}\n", "sensor `all` counts packets");
}

/// A fluorescent wall takes blue and gives green: what a closed cube of it reflects is more than without its dye.
#[test]
fn fluorescence_is_exchanged_between_bands() {
    let cube = |dye: &str, solver: &str| {
        format!(
            "[render]\nsolver = \"{solver}\"\nmeter_samples = 65536\n[spectra]\nblue = [[400, 0.0], [440, 0.6], [480, 0.6], [500, 0.0]]\ngreen = [[500, 0.0], [530, 1.0], [580, 0.0]]\n\
             [[material]]\nname = \"w\"\ndye = {{ reflectance = 0.3, absorption = \"blue\", emission = \"green\", quantum_yield = {dye} }}\n\
             [[shape]]\nmaterial = \"w\"\nbox = {{ from = [-1, -1, -1], to = [1, 1, 1], inwards = true }}\n\
             [[light]]\nspectrum = \"LED-B3\"\npoint = {{ at = [0, 0, 0], flux = \"1000 lm\" }}\n\
             [[sensor]]\nname = \"wall\"\nilluminance = {{ at = [0, 0, -0.999] }}\n"
        )
    };
    let folder = tempfile::tempdir().expect("a folder");
    let read = |dye: &str, solver: &str| {
        let path = scene(&folder, &cube(dye, solver));
        sensors(photopic().arg("render").arg(path).args(["--json", "--packets", "0"]))[0].clone()
    };
    let (solved, traced) = (read("0.9", "radiosity"), read("0.9", "path"));
    let number = |v: &Value, key: &str| v[key].as_f64().expect("a number");
    let allowed = 3.0 * (number(&traced, "standard_error") + number(&solved, "discretisation"));
    assert!((number(&solved, "value") - number(&traced, "value")).abs() <= allowed, "{solved} {traced}");
    assert!(number(&solved, "value") > 1.01 * number(&read("0.0", "radiosity"), "value"));
}

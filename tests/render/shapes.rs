//! Projected solid angles in closed form against the cases of `../shared/render/analytic.json`: to 1e-12 at every scale, and far from
//! the origin to what the coordinates there can tell apart.

use std::f64::consts::PI;

use glam::DVec3;
use photopic::render::form_factor;
use photopic::render::shape::Shape;
use photopic::render::shape::disk::Disk;
use photopic::render::shape::polygon::Polygon;
use photopic::render::shape::rectangle::Rectangle;
use photopic::render::shape::sphere::Sphere;
use photopic::render::shape::triangle::Triangle;
use serde_json::Value;

use crate::common::shared;

fn disk(scale: f64, at: DVec3) -> Vec<Box<dyn Shape>> {
    vec![Box::new(Disk::new(at, DVec3::NEG_Z, 0.5 * scale).expect("a disk"))]
}

/// A rectangle as itself, as a polygon and as two triangles.
fn rectangle(corner: DVec3, first: DVec3, second: DVec3) -> [Vec<Box<dyn Shape>>; 3] {
    let [a, b, c, d] = [corner, corner + first, corner + first + second, corner + second];
    [
        vec![Box::new(Rectangle::new(corner, first, second).expect("a rectangle"))],
        vec![Box::new(Polygon::new(vec![a, b, c, d]).expect("a polygon"))],
        vec![
            Box::new(Triangle::new(a, b, c).expect("a triangle")),
            Box::new(Triangle::new(a, c, d).expect("a triangle")),
        ],
    ]
}

/// Name, sources, normal, the case's factor on E/L.
type Case = (&'static str, Vec<Box<dyn Shape>>, DVec3, f64);

/// All cases at a scale, the receiver standing at `eye`.
fn sources(scale: f64, eye: DVec3) -> Vec<Case> {
    let at = |x: f64, y: f64, z: f64| eye + scale * DVec3::new(x, y, z);
    let mut all = Vec::new();
    for (name, d) in [
        ("disk_L1000_R0.5_h1_d0", 0.0),
        ("disk_L1000_R0.5_h1_d0.5", 0.5),
        ("disk_L1000_R0.5_h1_d1", 1.0),
        ("disk_L1000_R0.5_h1_d3", 3.0),
    ] {
        all.push((name, disk(scale, at(d, 0.0, 1.0)), DVec3::Z, 1000.0));
    }
    for made in rectangle(at(0.0, 0.0, 1.0), DVec3::X * scale, DVec3::Y * scale) {
        all.push(("rect_corner_1x1_h1_E_over_L", made, DVec3::Z, 1.0));
    }
    for made in rectangle(at(-0.5, -0.5, 1.0), DVec3::X * scale, DVec3::Y * scale) {
        all.push(("rect_centre_1x1_h1_E_over_L", made, DVec3::Z, 1.0));
    }
    // A wall at the distance c = 1, as wide as b = 1 from the foot and as high as a = 1, seen from the floor.
    for made in rectangle(at(1.0, 0.0, 0.0), DVec3::Y * scale, DVec3::Z * scale) {
        all.push(("rect_perp_b1_a1_c1_E_over_L", made, DVec3::Z, 1.0));
    }
    let ball = Sphere::new(at(0.0, 0.0, 2.0), 0.5 * scale).expect("a sphere");
    all.push(("sphere_R0.5_D2_L1000", vec![Box::new(ball)], DVec3::Z, 1000.0));
    all
}

fn check(cases: &Value, scale: f64, eye: DVec3, allowed: f64) {
    for (name, shapes, normal, factor) in sources(scale, eye) {
        let expected = cases[name]["value"].as_f64().expect("a number");
        let angles = shapes.iter().map(|s| s.projected_solid_angle(eye, normal).expect("a closed form"));
        let got = factor * angles.sum::<f64>();
        assert!((got / expected - 1.0).abs() <= allowed, "{name} at {scale}, {eye}: {got}, expected {expected}");
    }
}

#[test]
fn closed_forms_hold_at_every_scale() {
    let Some(path) = shared("render/analytic.json") else { return };
    let cases: Value = serde_json::from_str(&std::fs::read_to_string(path).expect("readable")).expect("JSON");
    for exponent in -8..=8 {
        check(&cases, 10.0_f64.powi(exponent), DVec3::ZERO, 1e-12);
    }
    // A metre, a million metres away: coordinates are multiples of 2⁻³³ m there, and the figures change by at most 3 per metre.
    for eye in [DVec3::new(1e6, 0.0, 0.0), DVec3::new(-7e5, 1e6, 3e5)] {
        check(&cases, 1.0, eye, 1e-9);
    }
}

/// A polygon seen all around: the hemisphere.
#[test]
fn what_covers_everything_is_pi() {
    let wall = |s: f64, t: DVec3, u: DVec3, at: DVec3| {
        Rectangle::new(at - s * (t + u), 2.0 * s * t, 2.0 * s * u).expect("a wall")
    };
    // The five faces of a cube about a point of its floor that the floor's normal sees.
    let eye = DVec3::new(0.3, -0.2, -1.0);
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let faces = [wall(1.0, x, y, z), wall(1.0, y, z, x), wall(1.0, y, z, -x), wall(1.0, x, z, y), wall(1.0, x, z, -y)];
    let sum: f64 = faces.iter().map(|f| f.projected_solid_angle(eye, z).expect("a closed form")).sum();
    assert!((sum - PI).abs() < 1e-14, "{sum}");
}

#[test]
fn form_factors_of_the_catalogue() {
    let Some(path) = shared("render/analytic.json") else { return };
    let cases: Value = serde_json::from_str(&std::fs::read_to_string(path).expect("readable")).expect("JSON");
    let number = |name: &str| cases[name]["value"].as_f64().expect("a number");
    for (got, name) in [
        (form_factor::parallel_rectangles(1.0, 1.0, 1.0), "F12_unit_squares_parallel_d1"),
        (form_factor::adjacent_rectangles(1.0, 1.0, 1.0), "F12_cube_adjacent"),
        (form_factor::coaxial_disks(1.0, 1.0, 1.0), "F12_coaxial_disks_r1_d1"),
    ] {
        assert!((got / number(name) - 1.0).abs() < 1e-14, "{name}: {got}");
    }
    let expected: Vec<f64> =
        serde_json::from_value(cases["concentric_spheres_r1=.5_r2=1"]["value"].clone()).expect("numbers");
    assert_eq!(form_factor::concentric_spheres(0.5, 1.0).as_slice(), expected);
}

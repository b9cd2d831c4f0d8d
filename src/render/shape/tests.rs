//! What holds for every shape: densities and draws agree, closed forms and counts of rays agree, nothing depends on the scale, closed
//! shapes do not leak, and no ray meets the surface that it leaves.

use std::f64::consts::TAU;

use glam::DVec3;

use super::cylinder::Cylinder;
use super::disk::Disk;
use super::polygon::Polygon;
use super::polyhedron::Polyhedron;
use super::rectangle::Rectangle;
use super::sphere::Sphere;
use super::triangle::Triangle;
use super::{Crossing, Ray, Shape, SurfacePoint, Towards};
use crate::geometry::direction::{phi, tangents};
use crate::math::random::Stream;

/// Which crossings along a direction a shape's draws aim at.
#[derive(Clone, Copy, PartialEq)]
enum Aim {
    /// The first: what hides behind it is never drawn.
    First,
    /// All.
    All,
}

/// One of each kind, about a metre large, scaled and moved.
fn shapes(scale: f64, shift: DVec3) -> Vec<(&'static str, Box<dyn Shape>, Aim)> {
    let at = |x: f64, y: f64, z: f64| shift + scale * DVec3::new(x, y, z);
    let by = |x: f64, y: f64, z: f64| scale * DVec3::new(x, y, z);
    let star = [(0.0, 0.0), (0.5, 0.25), (1.0, 0.0), (0.8, 0.5), (1.0, 1.0), (0.5, 0.7), (0.0, 1.0), (0.2, 0.5)];
    vec![
        ("sphere", Box::new(Sphere::new(at(0.1, 0.2, 0.0), 0.5 * scale).unwrap()), Aim::First),
        ("disk", Box::new(Disk::new(at(0.0, 0.1, 0.0), DVec3::new(0.3, -0.2, 1.0), 0.6 * scale).unwrap()), Aim::All),
        (
            "annulus",
            Box::new(Disk::annulus(at(0.0, 0.0, 0.1), DVec3::new(-0.1, 0.2, 1.0), 0.6 * scale, 0.3 * scale).unwrap()),
            Aim::All,
        ),
        (
            "rectangle",
            Box::new(Rectangle::new(at(-0.5, -0.4, 0.0), by(1.0, 0.0, 0.25), by(0.0, 0.7, 0.0)).unwrap()),
            Aim::All,
        ),
        (
            "parallelogram",
            Box::new(Rectangle::new(at(-0.5, -0.4, 0.0), by(1.0, 0.1, 0.2), by(0.3, 0.7, 0.0)).unwrap()),
            Aim::All,
        ),
        (
            "triangle",
            Box::new(Triangle::new(at(-0.6, -0.4, 0.0), at(0.7, -0.3, 0.1), at(0.1, 0.6, -0.1)).unwrap()),
            Aim::All,
        ),
        (
            "polygon",
            Box::new(Polygon::new(star.map(|(x, y)| at(x - 0.5, y - 0.5, 0.25 * x + 0.1 * y)).to_vec()).unwrap()),
            Aim::All,
        ),
        ("cuboid", Box::new(Polyhedron::cuboid(at(-0.4, -0.3, -0.2), at(0.4, 0.5, 0.3)).unwrap()), Aim::First),
        ("step", Box::new(step(scale, shift)), Aim::All),
        ("tube", Box::new(Cylinder::new(at(-0.4, 0.0, 0.1), at(0.4, 0.2, 0.0), 0.3 * scale, false).unwrap()), Aim::All),
        (
            "cylinder",
            Box::new(Cylinder::new(at(-0.4, 0.0, 0.1), at(0.4, 0.2, 0.0), 0.3 * scale, true).unwrap()),
            Aim::All,
        ),
    ]
}

/// A solid with a notch: two concave faces of six corners.
fn step(scale: f64, shift: DVec3) -> Polyhedron {
    let outline = [(-0.4, -0.3), (0.4, -0.3), (0.4, 0.1), (0.0, 0.1), (0.0, 0.3), (-0.4, 0.3)];
    let point = |(x, z): (f64, f64), y: f64| shift + scale * DVec3::new(x, y, z);
    let vertices: Vec<DVec3> =
        outline.iter().map(|&p| point(p, -0.3)).chain(outline.iter().map(|&p| point(p, 0.3))).collect();
    let next = |i: usize| (i + 1) % 6;
    let mut faces: Vec<Vec<usize>> = (0..6).map(|i| vec![next(i), i, i + 6, next(i) + 6]).collect();
    faces.push((0..6).collect());
    faces.push((6..12).rev().collect());
    Polyhedron::new(&vertices, &faces).unwrap()
}

/// All crossings of a ray, nearest first.
fn all_crossings(shape: &dyn Shape, ray: &Ray) -> Vec<(Crossing, SurfacePoint)> {
    let (mut found, mut near) = (Vec::new(), 0.0);
    while let Some(crossing) = shape.cross(ray, near, f64::INFINITY) {
        assert!(crossing.t > near, "{shape:?} {ray:?}");
        near = crossing.t;
        found.push((crossing, shape.surface(ray, &crossing)));
    }
    found
}

/// Eyes about a shape of a metre: near, far, above, at the side, in the midst of it.
fn eyes() -> [DVec3; 6] {
    [
        DVec3::new(0.2, 0.1, 1.5),
        DVec3::new(-3.0, 2.0, 1.0),
        DVec3::new(0.15, 0.05, 0.4),
        DVec3::new(0.05, 0.15, 0.02),
        DVec3::new(60.0, -20.0, 30.0),
        DVec3::new(0.3, -1.2, -0.4),
    ]
}

const CELLS: [usize; 2] = [8, 12];

/// The standard normal deviate of a χ² of so many degrees of freedom (Wilson & Hilferty 1931).
fn deviate(chi2: f64, freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom);
    ((chi2 / freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
}

/// Draws of `sample_towards` against directions drawn evenly in a cone that holds the shape and weighed with `pdf_towards`.
fn check_draws(name: &str, shape: &dyn Shape, aim: Aim, from: DVec3, seed: u64) {
    let draws = 40_000;
    let bounds = shape.bounds();
    let (centre, radius) = (0.5 * (bounds.min + bounds.max), 0.5 * (bounds.max - bounds.min).length());
    let distance = (centre - from).length();
    let axis = (centre - from) / distance;
    // 1 − cos of the cone's half-angle.
    let opening = if distance > radius { 1.0 - (1.0 - (radius / distance).powi(2)).sqrt() } else { 2.0 };
    let (x, y) = tangents(axis);
    let cell = |direction: DVec3| {
        let local = DVec3::new(x.dot(direction), y.dot(direction), axis.dot(direction));
        let place = [(1.0 - local.z) / opening, phi(local) / TAU];
        let [i, j] = [0, 1].map(|k| ((place[k] * CELLS[k] as f64) as usize).min(CELLS[k] - 1));
        i * CELLS[1] + j
    };
    let mut stream = Stream::new(6, seed);
    let mut counts = vec![0.0; CELLS[0] * CELLS[1]];
    for _ in 0..draws {
        let Some(drawn) = shape.sample_towards(from, stream.uniforms()) else { continue };
        assert!((drawn.direction.length() - 1.0).abs() < 1e-14, "{name} {drawn:?}");
        let ray = Ray { origin: from, direction: drawn.direction };
        let all = all_crossings(shape, &ray);
        let same = all.iter().min_by(|a, b| (a.0.t - drawn.distance).abs().total_cmp(&(b.0.t - drawn.distance).abs()));
        let (crossing, point) = same.unwrap_or_else(|| panic!("{name} from {from}: {drawn:?} misses"));
        // Where the surface is seen at a slant the distance is as uncertain as the direction's last digit over the slant.
        let slant = point.normal.dot(drawn.direction).abs();
        assert!(
            (crossing.t - drawn.distance).abs() <= 1e-13 * (1.0 + distance) / slant,
            "{name} {drawn:?} {crossing:?}"
        );
        let pdf = shape.pdf_towards(from, point);
        assert!((pdf / drawn.pdf - 1.0).abs() < 1e-12 / (slant * slant), "{name} from {from}: {pdf} {drawn:?}");
        counts[cell(drawn.direction)] += 1.0;
    }
    let mut expected = vec![[0.0; 2]; counts.len()];
    let mut total = [0.0; 2];
    let tries = 200_000;
    for _ in 0..tries {
        let [u, v] = stream.uniforms();
        let cos = 1.0 - opening * u;
        let sin = (opening * u * (2.0 - opening * u)).sqrt();
        let direction = cos * axis + sin * ((TAU * v).cos() * x + (TAU * v).sin() * y);
        let all = all_crossings(shape, &Ray { origin: from, direction: direction.normalize() });
        let counted = if aim == Aim::First { all.len().min(1) } else { all.len() };
        let weight: f64 = all[..counted].iter().map(|(_, point)| shape.pdf_towards(from, point)).sum();
        let share = weight * TAU * opening / f64::from(tries);
        let cell = &mut expected[cell(direction)];
        *cell = [cell[0] + share, cell[1] + share * share];
        total = [total[0] + share, total[1] + share * share];
    }
    let spread = (total[1] - total[0] * total[0] / f64::from(tries)).max(0.0).sqrt();
    assert!((total[0] - 1.0).abs() < 5.0 * spread + 1e-12, "{name} from {from}: ∫ pdf = {} ± {spread}", total[0]);
    let (mut chi2, mut freedom) = (0.0, -1.0);
    for ([share, square], count) in expected.into_iter().zip(counts) {
        let n = f64::from(draws);
        // Cells with few draws or few tries are not normal.
        if share * n >= 10.0 && square < 0.05 * share * share {
            let variance = share * n + n * n * square;
            chi2 += (count - share * n).powi(2) / variance;
            freedom += 1.0;
        } else {
            assert!(count < 5.0 * (share * n + 10.0), "{name} from {from}: {count} draws, {share} expected");
        }
    }
    assert!(freedom > 5.0, "{name} from {from}: {freedom}");
    let z = deviate(chi2, freedom);
    assert!(z < 4.5, "{name} from {from}: χ² {chi2} of {freedom}, {z} standard deviations");
}

#[test]
fn draws_are_distributed_as_their_density_says() {
    use rayon::prelude::*;
    let shapes = shapes(1.0, DVec3::ZERO);
    shapes.par_iter().enumerate().for_each(|(i, (name, shape, aim))| {
        for (j, eye) in eyes().into_iter().enumerate() {
            check_draws(name, shape.as_ref(), *aim, eye, (10 * i + j) as u64);
        }
    });
}

#[test]
fn a_wrong_density_would_be_found() {
    /// Says the density of a triangle that is a little larger.
    #[derive(Debug)]
    struct Liar(Triangle, Triangle);
    impl Shape for Liar {
        fn bounds(&self) -> super::Bounds {
            self.0.bounds()
        }
        fn cross(&self, ray: &Ray, near: f64, far: f64) -> Option<Crossing> {
            self.0.cross(ray, near, far)
        }
        fn surface(&self, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
            self.0.surface(ray, crossing)
        }
        fn area(&self) -> f64 {
            self.0.area()
        }
        fn sample_area(&self, u: [f64; 3]) -> SurfacePoint {
            self.0.sample_area(u)
        }
        fn sample_towards(&self, from: DVec3, u: [f64; 3]) -> Option<Towards> {
            // Crowded towards the second corner.
            let drawn = self.0.sample_towards(from, [u[0], u[1], u[2].powf(1.15)])?;
            Some(Towards { pdf: self.pdf_towards(from, &self.0.sample_area(u)), ..drawn })
        }
        fn pdf_towards(&self, from: DVec3, point: &SurfacePoint) -> f64 {
            self.1.pdf_towards(from, point)
        }
    }
    let [a, b, c] = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let exact = || Triangle::new(a, b, c).unwrap();
    let larger = Triangle::new(a, 1.02 * b, c).unwrap();
    for liar in [Liar(exact(), exact()), Liar(exact(), larger)] {
        let check = || check_draws("liar", &liar, Aim::All, DVec3::new(0.3, 0.2, 0.8), 1);
        assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(check)).is_err());
    }
}

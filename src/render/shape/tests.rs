//! What holds for every shape: densities and draws agree, closed forms and counts of rays agree, nothing depends on the scale, closed
//! shapes do not leak, and no ray meets the surface that it leaves.

use std::f64::consts::TAU;

use glam::DVec3;
use proptest::prelude::*;

use super::cylinder::Cylinder;
use super::disk::Disk;
use super::plane::Plane;
use super::polygon::Polygon;
use super::polyhedron::Polyhedron;
use super::rectangle::Rectangle;
use super::sphere::Sphere;
use super::triangle::Triangle;
use super::{Crossing, Ray, Shape, SurfacePoint, Towards};
use crate::geometry::direction::{from_angles, phi, tangents};
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

/// A direction of the whole sphere, uniform.
fn anywhere([u, v]: [f64; 2]) -> DVec3 {
    from_angles((1.0 - 2.0 * u).acos(), TAU * v)
}

/// Rays even over all directions count what is seen: the solid angle that draws are uniform over, and the projected one.
#[test]
fn counted_rays_agree_with_closed_forms() {
    let rays = 100_000;
    for (i, (name, shape, _)) in (0..).zip(shapes(1.0, DVec3::ZERO)) {
        for (j, eye) in (0..).zip(eyes()) {
            let normals = [DVec3::Z, -eye.normalize(), DVec3::new(0.36, -0.48, 0.8)];
            let bounds = shape.bounds();
            let (centre, radius) = (0.5 * (bounds.min + bounds.max), 0.5 * (bounds.max - bounds.min).length());
            let distance = (centre - eye).length();
            if distance > 20.0 * radius && name == "tube" {
                continue;
            }
            let axis = (centre - eye) / distance;
            let opening = if distance > radius { 1.0 - (1.0 - (radius / distance).powi(2)).sqrt() } else { 2.0 };
            let (x, y) = tangents(axis);
            let mut stream = Stream::new(66, 10 * i + j);
            let mut sums = [[0.0; 2]; 3];
            for _ in 0..rays {
                let [u, v] = stream.uniforms();
                let sin = (opening * u * (2.0 - opening * u)).sqrt();
                let (s, c) = (TAU * v).sin_cos();
                let direction = ((1.0 - opening * u) * axis + sin * (c * x + s * y)).normalize();
                if shape.cross(&Ray { origin: eye, direction }, 0.0, f64::INFINITY).is_some() {
                    for (sum, normal) in sums.iter_mut().zip(normals) {
                        let cos = normal.dot(direction).max(0.0);
                        *sum = [sum[0] + cos, sum[1] + cos * cos];
                    }
                }
            }
            for (sum, normal) in sums.into_iter().zip(normals) {
                let Some(expected) = shape.projected_solid_angle(eye, normal) else { continue };
                let [mean, square] = sum.map(|s| s / f64::from(rays));
                let (whole, deviation) = (TAU * opening, ((square - mean * mean) / f64::from(rays)).sqrt());
                assert!(
                    (whole * mean - expected).abs() <= 4.5 * whole * deviation + 1e-12,
                    "{name} from {eye} to {normal}: {} ± {}, {expected}",
                    whole * mean,
                    whole * deviation
                );
            }
        }
    }
}

/// The same configuration at another size, or elsewhere, is the same to rounding: figures without a length, draws and crossings.
#[test]
fn nothing_depends_on_the_scale_or_the_place() {
    let reference = shapes(1.0, DVec3::ZERO);
    let mut stream = Stream::new(66, 1000);
    for (scale, shift, allowed) in [
        (1e-8, DVec3::ZERO, 1e-12),
        (1e-3, DVec3::ZERO, 1e-12),
        (1e4, DVec3::ZERO, 1e-12),
        (1e8, DVec3::ZERO, 1e-12),
        // Coordinates near 1e6 m are multiples of 1.2e-10 m: corners, and eyes, stand that much elsewhere.
        (1.0, DVec3::new(1e6, -1e6, 1e6), 1e-8),
    ] {
        for ((name, one, _), (_, other, _)) in reference.iter().zip(shapes(scale, shift)) {
            assert!((other.area() / scale / scale / one.area() - 1.0).abs() < allowed, "{name}");
            for eye in eyes() {
                let far = shift + scale * eye;
                for normal in [DVec3::Z, -eye.normalize(), DVec3::new(0.36, -0.48, 0.8)] {
                    let [a, b] = [one.projected_solid_angle(eye, normal), other.projected_solid_angle(far, normal)];
                    let (a, b) = (a.unwrap_or(0.0), b.unwrap_or(0.0));
                    assert!((a - b).abs() <= allowed * a.max(1e-3), "{name} {scale} {shift} {eye}: {a} {b}");
                }
                for _ in 0..200 {
                    let u = stream.uniforms();
                    let [Some(a), Some(b)] = [one.sample_towards(eye, u), other.sample_towards(far, u)] else {
                        panic!("{name} from {eye}: no draw");
                    };
                    let ray = Ray { origin: eye, direction: a.direction };
                    let slant = all_crossings(one.as_ref(), &ray)
                        .iter()
                        .map(|(_, p)| p.normal.dot(a.direction).abs())
                        .fold(1.0, f64::min);
                    let bound = allowed / (slant * slant);
                    assert!((a.direction - b.direction).length() < bound, "{name} {scale} {shift}: {a:?} {b:?}");
                    assert!(
                        (b.distance / scale / a.distance - 1.0).abs() < bound,
                        "{name} {scale} {shift}: {a:?} {b:?}"
                    );
                    assert!((b.pdf / a.pdf - 1.0).abs() < bound, "{name} {scale} {shift}: {a:?} {b:?}");
                }
            }
        }
    }
}

/// Rays from within a closed solid leave it through an odd number of crossings, one where it is convex, also where they are aimed at edges
/// and corners.
#[test]
fn closed_shapes_do_not_leak() {
    let rays = if cfg!(debug_assertions) { 20_000 } else { 300_000 };
    for (scale, shift) in
        [(1e-8, DVec3::ZERO), (1.0, DVec3::ZERO), (1e8, DVec3::ZERO), (1.0, DVec3::new(1e6, 3e5, -2e5))]
    {
        let at = |p: DVec3| shift + scale * p;
        let (low, high) = (DVec3::new(-0.4, -0.3, -0.2), DVec3::new(0.4, 0.5, 0.3));
        let cuboid = Polyhedron::cuboid(at(low), at(high)).unwrap();
        let (notched, ball) = (step(scale, shift), Sphere::new(at(DVec3::ZERO), 0.3 * scale).unwrap());
        let can =
            Cylinder::new(at(DVec3::new(-0.3, 0.0, 0.1)), at(DVec3::new(0.4, 0.2, 0.0)), 0.3 * scale, true).unwrap();
        let mut stream = Stream::new(67, 1);
        for i in 0..rays {
            let [u, v, r, p, q, side] = stream.uniforms();
            // Within all four solids.
            let origin = at(0.1 * r * anywhere([p, q]) + DVec3::new(-0.05, 0.0, 0.0));
            // Corners of the cuboid and of the step, and points of edges, as exactly as they can be aimed at.
            let corner = DVec3::select(glam::BVec3::new(u < 0.5, v < 0.5, side < 0.5), at(low), at(high));
            let notch =
                at(DVec3::new([-0.4, 0.0, 0.4][i % 3], if side < 0.5 { -0.3 } else { 0.3 }, [-0.3, 0.1, 0.3][i % 3]));
            let aim = match i % 4 {
                0 => corner,
                1 => DVec3::new(corner.x, corner.y, at(low.lerp(high, r)).z),
                2 => notch,
                _ => origin + scale * anywhere([u, v]),
            };
            let ray = Ray { origin, direction: (aim - origin).normalize() };
            for (shape, is_convex) in [(&cuboid as &dyn Shape, true), (&ball, true), (&can, true), (&notched, false)] {
                // Faces that are crossed at an edge have the same t to rounding: they are told apart by counting upwards.
                let count = all_crossings(shape, &ray).len();
                assert!(if is_convex { count == 1 } else { count >= 1 }, "{count} {shape:?} {ray:?}");
                assert!(i % 4 != 3 || count % 2 == 1, "{count} {shape:?} {ray:?}");
            }
        }
    }
}

/// Every shape, and a plane, with the sides from which it is flat or round outwards.
fn leavable(scale: f64, shift: DVec3) -> Vec<(&'static str, Box<dyn Shape>, bool)> {
    let plane = Plane::new(shift + scale * DVec3::new(0.2, 0.1, 0.0), DVec3::new(0.3, 0.1, 1.0)).unwrap();
    let mut out: Vec<(&'static str, Box<dyn Shape>, bool)> = vec![("plane", Box::new(plane), true)];
    let kinds = shapes(scale, shift).into_iter().filter(|(name, ..)| !["step", "tube"].contains(name));
    out.extend(kinds.map(|(name, shape, _)| {
        let is_flat = !["sphere", "cuboid", "cylinder"].contains(&name);
        (name, shape, is_flat)
    }));
    out
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 400 } else { 4000 }))]

    /// A ray from `origin_towards` does not meet the flat surface that it leaves, nor from outside the convex one, however it got there:
    /// by a crossing or a draw, at any scale, at any slant.
    #[test]
    fn no_ray_meets_the_surface_that_it_leaves(
        exponent in -8.0..8.0_f64,
        away in 0.0..1e6_f64,
        place in prop::array::uniform2(0.0..1.0_f64),
        u in prop::array::uniform3(0.0..1.0_f64),
        leave in prop::array::uniform2(0.0..1.0_f64),
        slant in 0.0..17.0_f64,
        from in prop::array::uniform2(0.0..1.0_f64),
        back in any::<bool>(),
    ) {
        let scale = 10.0_f64.powf(exponent);
        let shift = scale * away * anywhere(place);
        for (name, shape, is_flat) in leavable(scale, shift) {
            let drawn = shape.sample_area(u);
            let eye = drawn.position + 3.0 * scale * anywhere(from);
            let ray = Ray { origin: eye, direction: (drawn.position - eye).normalize() };
            let crossed = shape.cross(&ray, 0.0, f64::INFINITY).map(|c| shape.surface(&ray, &c));
            for point in [Some(drawn), crossed].into_iter().flatten() {
                prop_assert!((point.normal.length() - 1.0).abs() < 1e-14 && point.normal.dot(point.tangent).abs() < 1e-14);
                let side = if is_flat && back { -point.normal } else { point.normal };
                let (x, y) = tangents(side);
                let (sin, cos) = (TAU * leave[0]).sin_cos();
                let direction = (cos * x + sin * y + 10.0_f64.powf(-slant) * leave[1] * side).normalize();
                // What rounding has turned to the other side leaves there.
                if direction.dot(side) < 0.0 && !is_flat {
                    continue;
                }
                let leaving = Ray { origin: point.origin_towards(direction), direction };
                let met = shape.cross(&leaving, 0.0, f64::INFINITY);
                prop_assert!(met.is_none(), "{} at {}: {:?} meets {:?}", name, scale, leaving, met);
                prop_assert!(point.error < 1e-13 * (scale + shift.length()), "{} {:?}", name, point);
            }
        }
    }

    /// Both points of a surface that a ray and a draw find lie on it within the error they state.
    #[test]
    fn points_lie_on_their_surface_within_their_error(
        exponent in -8.0..8.0_f64,
        place in prop::array::uniform2(0.0..1.0_f64),
        u in prop::array::uniform3(0.0..1.0_f64),
        from in prop::array::uniform2(0.0..1.0_f64),
    ) {
        let scale = 10.0_f64.powf(exponent);
        let centre = scale * 100.0 * anywhere(place);
        let sphere = Sphere::new(centre, scale).unwrap();
        let point = sphere.sample_area(u);
        let off = ((point.position - centre).length() - scale).abs();
        prop_assert!(off <= point.error, "{off} {}", point.error);
        // Oblique planes: from outside of the plane's own arithmetic by exact halves, corners with few digits.
        let [a, b, c] = [DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.0, 0.0, 1.0)].map(|p| scale * p);
        let triangle = Triangle::new(a, b, c).unwrap();
        let eye = scale * (DVec3::splat(1.0 / 3.0) + 5.0 * anywhere(from));
        let ray = Ray { origin: eye, direction: (triangle.sample_area(u).position - eye).normalize() };
        if let Some(crossing) = triangle.cross(&ray, 0.0, f64::INFINITY) {
            let point = triangle.surface(&ray, &crossing);
            // x + y + z = scale on the plane; the sum of three rounds twice.
            let off = (point.position.element_sum() - scale).abs() / 3.0_f64.sqrt();
            prop_assert!(off <= point.error + 2.0 * f64::EPSILON * scale, "{off} {}", point.error);
        }
    }
}

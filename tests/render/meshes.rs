//! The search for surfaces against trying them all, and meshes that let nothing through.

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3};
use photopic::geometry::direction::from_angles;
use photopic::math::random::Stream;
use photopic::render::accelerate::Surfaces;
use photopic::render::mesh::{Mesh, MeshData};
use photopic::render::placed::PlacedMesh;
use photopic::render::ray::{Crossing, Ray};
use photopic::render::shape::Shape;
use photopic::render::shape::rectangle::Rectangle;
use photopic::render::shape::triangle::cross_triangle;
use proptest::prelude::*;

/// Rays of a test: many where the build is fast.
const RAYS: usize = if cfg!(debug_assertions) { 20_000 } else { 1_000_000 };

/// A ball of 8 · 4ⁿ triangles (an octahedron, refined), moved and scaled; neighbours share their corners.
fn ball(refinements: u32, scale: f64, centre: DVec3) -> MeshData {
    let mut positions = vec![DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let mut triangles: Vec<[u32; 3]> =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..refinements {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: u32, b: u32, positions: &mut Vec<DVec3>| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [p, q, r] = [(a, b), (b, c), (c, a)].map(|(a, b)| middle(a, b, &mut positions));
                [[a, p, r], [p, b, q], [r, q, c], [p, q, r]]
            })
            .collect();
    }
    let positions = positions.into_iter().map(|p| centre + scale * p).collect();
    MeshData { positions, triangles, ..MeshData::default() }
}

fn placed(mesh: &Arc<Mesh>, to_world: DAffine3) -> Arc<dyn Shape> {
    Arc::new(PlacedMesh::new(Arc::clone(mesh), to_world).expect("regular"))
}

fn direction(stream: &mut Stream) -> DVec3 {
    let [u, v, _] = stream.uniforms();
    from_angles((1.0 - 2.0 * u).acos(), std::f64::consts::TAU * v)
}

/// What trying every triangle finds.
fn brute(data: &MeshData, ray: &Ray, far: f64) -> Option<Crossing> {
    let mut found: Option<Crossing> = None;
    for names in &data.triangles {
        let [a, b, c] = names.map(|i| data.positions[i as usize]);
        found = cross_triangle(ray, a, b, c, 0.0, found.map_or(far, |f| f.t)).or(found);
    }
    found
}

#[test]
fn nothing_leaves_a_closed_ball_at_any_scale_and_place() {
    let mut stream = Stream::new(61, 1);
    for (scale, centre) in [
        (1.0, DVec3::ZERO),
        (1e-8, DVec3::ZERO),
        (1e8, DVec3::ZERO),
        (1.0, DVec3::new(1e6, -3e5, 2e5)),
        (1e-3, DVec3::new(-1e3, 10.0, 1e3)),
    ] {
        let data = ball(5, scale, centre);
        let mesh = Mesh::new(data.clone()).expect("sound");
        for i in 0..RAYS / 5 {
            let origin = centre + scale * (0.95 * stream.uniforms::<1>()[0]) * direction(&mut stream);
            // One of three is aimed at a corner, one at the middle of an edge.
            let [a, b, _] = data.triangles[i % data.triangles.len()].map(|c| data.positions[c as usize]);
            let direction = match i % 3 {
                0 => direction(&mut stream),
                1 => (a - origin).normalize(),
                _ => (0.5 * (a + b) - origin).normalize(),
            };
            let ray = Ray { origin, direction };
            assert!(mesh.closest(&ray, 0.0, f64::INFINITY).is_some(), "{scale} {centre} {ray:?}");
            assert!(mesh.is_crossed(&ray, 0.0, f64::INFINITY), "{scale} {centre} {ray:?}");
        }
    }
}

#[test]
fn rays_from_far_off_meet_what_trying_all_triangles_finds() {
    let data = ball(3, 1.0, DVec3::ZERO);
    let mesh = Mesh::new(data.clone()).expect("sound");
    let mut stream = Stream::new(62, 1);
    let mut hits = 0;
    for distance in [1.5, 1e3, 1e6, 1e9] {
        for i in 0..500 {
            let origin = distance * direction(&mut stream);
            let aim = 1.01 * direction(&mut stream);
            // Axis-parallel rays have components of the direction that are zero.
            let axis = [DVec3::X, DVec3::Y, DVec3::Z][i % 3];
            let ray = if i % 4 == 0 {
                Ray { origin: aim - distance * axis, direction: axis }
            } else {
                Ray { origin, direction: (aim - origin).normalize() }
            };
            let found = mesh.closest(&ray, 0.0, f64::INFINITY).map(|c| c.t);
            assert_eq!(found, brute(&data, &ray, f64::INFINITY).map(|c| c.t), "{distance} {ray:?}");
            hits += usize::from(found.is_some());
        }
    }
    assert!(hits > 500, "{hits}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 64 } else { 512 }))]

    /// Soups of triangles of very different sizes: the tree finds what trying all finds, bit for bit.
    #[test]
    fn a_soup_is_searched_as_if_every_triangle_were_tried(
        seed in any::<u32>(), count in 0_usize..80, decades in 0.0..7.0_f64, scale in -8.0..8.0_f64, shift in -6.0..6.0_f64, exact in any::<bool>(),
    ) {
        let mut stream = Stream::new(seed.into(), 63);
        let scale = 10_f64.powf(scale);
        let shift = if exact { DVec3::ZERO } else { scale * 10_f64.powf(shift) * direction(&mut stream) };
        let mut data = MeshData::default();
        for i in 0..count as u32 {
            let centre = stream.uniforms::<1>()[0] * direction(&mut stream);
            let size = 10_f64.powf(-decades * stream.uniforms::<1>()[0]);
            for _ in 0..3 {
                data.positions.push(shift + scale * (centre + size * direction(&mut stream)));
            }
            data.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        let mesh = Mesh::new(data.clone()).expect("sound");
        let surfaces = Surfaces::new(vec![placed(&Arc::new(Mesh::new(data.clone()).expect("sound")), DAffine3::IDENTITY)]);
        for i in 0..60 {
            let origin = shift + scale * 2.0 * stream.uniforms::<1>()[0] * direction(&mut stream);
            let aim = match data.positions.get(3 * i) {
                Some(&p) if i % 2 == 0 => p,
                _ => shift + scale * direction(&mut stream),
            };
            let ray = Ray { origin, direction: (aim - origin).normalize() };
            for far in [f64::INFINITY, scale * stream.uniforms::<1>()[0]] {
                let expected = brute(&data, &ray, far);
                let found = mesh.closest(&ray, 0.0, far);
                prop_assert_eq!(found.map(|c| c.t), expected.map(|c| c.t));
                prop_assert_eq!(mesh.is_crossed(&ray, 0.0, far), expected.is_some());
                prop_assert_eq!(surfaces.closest(&ray, far).map(|(_, c)| c.t), expected.map(|c| c.t));
                prop_assert_eq!(surfaces.is_occluded(&ray, far, None), expected.is_some());
                prop_assert!(!surfaces.is_occluded(&ray, far, Some(0)));
            }
        }
    }
}

#[test]
fn instances_are_met_where_their_copies_would_be() {
    let data = ball(2, 1.0, DVec3::new(0.2, -0.1, 0.0));
    let mesh = Arc::new(Mesh::new(data.clone()).expect("sound"));
    let mut stream = Stream::new(64, 1);
    let transforms: Vec<DAffine3> = (0..60)
        .map(|i| {
            let [a, b, c] = stream.uniforms();
            // Every third one is mirrored.
            let scale = DVec3::new(0.2 + a, 0.2 + b, (0.2 + c) * if i % 3 == 0 { -1.0 } else { 1.0 });
            let turn = DQuat::from_axis_angle(direction(&mut stream), 6.0 * a);
            DAffine3::from_scale_rotation_translation(scale, turn, 6.0 * b * direction(&mut stream))
        })
        .collect();
    let instances = Surfaces::new(transforms.iter().map(|&t| placed(&mesh, t)).collect());
    let copies: Vec<MeshData> = transforms
        .iter()
        .map(|t| MeshData {
            positions: data.positions.iter().map(|&p| t.transform_point3(p)).collect(),
            ..data.clone()
        })
        .collect();
    let mut hits = 0;
    for _ in 0..500 {
        let (origin, aim) = (8.0 * direction(&mut stream), 3.0 * direction(&mut stream));
        let ray = Ray { origin, direction: (aim - origin).normalize() };
        let found = instances.closest(&ray, f64::INFINITY);
        let expected = copies
            .iter()
            .enumerate()
            .filter_map(|(i, copy)| brute(copy, &ray, f64::INFINITY).map(|c| (i, c.t)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(found.map(|f| f.0), expected.map(|e| e.0), "{ray:?}");
        if let (Some((index, crossing)), Some((_, t))) = (found, expected) {
            hits += 1;
            assert!((crossing.t - t).abs() < 1e-13 * t, "{} {t}", crossing.t);
            let point = instances.surface_point(index, &ray, &crossing);
            assert!((point.position - ray.at(t)).length() < 1e-13, "{point:?}");
            // Balls are seen from outside, mirrored or not, and their faces are left to the side that one aims at.
            assert!(point.normal.dot(ray.direction) < 0.0);
            assert!((point.normal.length() - 1.0).abs() < 1e-14 && point.tangent.dot(point.shading).abs() < 1e-14);
            let out = direction(&mut stream);
            let out = if out.dot(point.normal) < 0.0 { -out } else { out };
            let leaving = Ray { origin: point.origin_towards(out), direction: out };
            assert!(instances.closest(&leaving, f64::INFINITY).is_none_or(|(i, _)| i != index), "{leaving:?}");
        }
    }
    assert!(hits > 50, "{hits}");
}

#[test]
fn a_mesh_that_shines_draws_its_points_by_area() {
    // A box of 1 × 2 × 4 has faces of 2, 4 and 8 m², twice each: drawn in these shares, within five standard deviations.
    let corner = |i: u32| DVec3::new((i & 1).into(), ((i >> 1) & 1).into(), ((i >> 2) & 1).into());
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mesh = MeshData {
        positions: (0..8).map(corner).collect(),
        triangles: faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..MeshData::default()
    };
    let to_world = DAffine3::from_scale_rotation_translation(
        DVec3::new(1.0, 2.0, 4.0),
        DQuat::from_rotation_y(0.3),
        DVec3::new(5.0, 6.0, 7.0),
    );
    let shape = PlacedMesh::new(Arc::new(Mesh::new(mesh).expect("sound")), to_world).expect("regular");
    assert!((shape.area() - 28.0).abs() < 1e-13);
    let mut stream = Stream::new(65, 1);
    let draws = 20_000;
    let mut counts = [0_u32; 3];
    let mut mean = DVec3::ZERO;
    for _ in 0..draws {
        let point = shape.sample_area(stream.uniforms());
        let local = to_world.inverse().transform_point3(point.position);
        let normal = DQuat::from_rotation_y(-0.3) * point.normal;
        let axis = normal.abs().max_position();
        counts[axis] += 1;
        mean += local / f64::from(draws);
        // On the face, whose outside is away from the middle.
        assert!((local[axis] - 0.5 * (1.0 + normal[axis].signum())).abs() < 1e-14, "{local} {normal}");
    }
    for (count, area) in counts.into_iter().zip([16.0, 8.0, 4.0]) {
        let share: f64 = area / 28.0;
        let deviation = (share * (1.0 - share) * f64::from(draws)).sqrt();
        assert!((f64::from(count) - share * f64::from(draws)).abs() < 5.0 * deviation, "{count} of {draws}, {share}");
    }
    assert!((mean - 0.5).abs().max_element() < 5.0 * 0.5 / f64::from(draws).sqrt(), "{mean}");
}

#[test]
fn what_is_no_triangle_is_left_out_and_counted() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::NAN, 2.0 * DVec3::X];
    let triangles = vec![[0, 1, 2], [0, 1, 3], [0, 1, 4], [2, 2, 1]];
    let data = MeshData { positions, triangles, ..MeshData::default() };
    let mesh = Mesh::new(data.clone()).expect("sound");
    assert_eq!((mesh.skipped(), mesh.first_skipped(), mesh.triangles()), (3, Some(1), 1));
    let none = Mesh::new(MeshData { triangles: data.triangles[1..].to_vec(), ..data.clone() }).expect("sound");
    let ray = Ray { origin: DVec3::new(0.2, 0.2, 1.0), direction: DVec3::NEG_Z };
    assert!(mesh.is_crossed(&ray, 0.0, 2.0) && !none.is_crossed(&ray, 0.0, 2.0));
    let surfaces = Surfaces::new(vec![placed(&Arc::new(none), DAffine3::IDENTITY)]);
    assert!(surfaces.closest(&ray, f64::INFINITY).is_none());
    let wrong = MeshData { triangles: vec![[0, 1, 5]], ..data.clone() };
    assert!(
        Mesh::new(wrong)
            .expect_err("missing")
            .to_string()
            .starts_with("triangle 0 names corner 5; expected one of 0..5")
    );
    let wrong = MeshData { uvs: vec![glam::Vec2::ZERO], ..data };
    assert!(Mesh::new(wrong).expect_err("too few").to_string().starts_with("1 texture coordinates for 5 corners"));
}

/// A direction with −0 in it is the same as one with 0: nothing leaks for the sign of nothing.
#[test]
fn a_direction_of_minus_zero_misses_nothing() {
    let square = Rectangle::new(DVec3::new(3.0, -1.0, -1.0), DVec3::Y * 2.0, DVec3::Z * 2.0).expect("a square");
    let surfaces = Surfaces::new(vec![Arc::new(square) as Arc<dyn Shape>]);
    for [y, z] in [[0.0, 0.0], [-0.0, 0.0], [0.0, -0.0], [-0.0, -0.0]] {
        for [from_y, from_z] in [[0.01, 0.02], [-0.3, 0.2], [0.5, -0.7], [0.0, 0.0]] {
            let ray = Ray { origin: DVec3::new(6.0, from_y, from_z), direction: DVec3::new(-1.0, y, z) };
            let (_, crossing) = surfaces.closest(&ray, f64::INFINITY).expect("it is in the way");
            assert_eq!(crossing.t, 3.0);
            assert!(surfaces.is_occluded(&ray, f64::INFINITY, None));
        }
    }
}

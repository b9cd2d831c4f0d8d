//! Illuminance on planes against closed forms, brute force over rays, and what symmetry and conservation ask for.

mod common;

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};
use photopic::geometry::solid_angle::polygon_projected;
use photopic::luminaire::format::{self, ReadOptions};
use photopic::luminaire::grid::{
    Error, Illuminance, Placed, Plane, PointsAt, Receiver, Settings, beneath, illuminance,
};
use photopic::luminaire::luminance::projected_area_m2;
use photopic::luminaire::placement::{Orientation, Placement};
use photopic::luminaire::{Body, Distribution, Kind, Luminaire, Shape, Symmetry, System};
use photopic::math::random::Stream;
use photopic::render::light::Light;
use photopic::render::light::goniometric::Goniometric;
use proptest::prelude::*;

fn lamp(distribution: Distribution, opening: Option<Body>) -> Luminaire {
    Luminaire { opening, ..Luminaire::of(distribution) }
}

fn body(shape: Shape, length_m: f64, width_m: f64, height_m: f64) -> Body {
    Body { shape, length_m, width_m, height_m }
}

/// One plane over γ in tenths of a degree: straight lines between them are within (0.1°)²/8 = 3.8e-7 of a cosine's amplitude.
fn rotational(to_deg: u32, f: impl Fn(f64) -> f64) -> Distribution {
    let angles: Vec<f64> = (0..=10 * to_deg).map(|i| f64::from(i) / 10.0).collect();
    let values = angles.iter().map(|g| f(g.to_radians())).collect();
    Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], angles, values).expect("a sound table")
}
const TABLE_ERROR: f64 = 3.9e-7;

/// Planes by `step`°, γ likewise, no symmetry.
fn whole(step: usize, f: impl Fn(f64, f64) -> f64) -> Distribution {
    let planes: Vec<f64> = (0..=360).step_by(step).map(f64::from).collect();
    let angles: Vec<f64> = (0..=180).step_by(step).map(f64::from).collect();
    let values = planes.iter().flat_map(|c| angles.iter().map(|g| f(*c, *g)).collect::<Vec<_>>()).collect();
    Distribution::new(System::TypeC, Symmetry::None, planes, angles, values).expect("a sound table")
}

/// A flat opening of luminance 1 cd/m² in all directions below.
fn lambertian(opening: Body) -> Luminaire {
    let area = projected_area_m2(&opening, 0.0, 0.0);
    lamp(rotational(90, |g| area * g.cos()), Some(opening))
}

/// A lamp with a different intensity in every direction.
fn lopsided(opening: Option<Body>) -> Luminaire {
    lamp(whole(15, |c, g| 100.0 + c + 0.5 * g + 40.0 * (3.0 * c.to_radians()).sin() * (c / 360.0)), opening)
}

fn at(position: DVec3, orientation: Orientation) -> Placement {
    Placement::new(position, orientation, 1.0).expect("a placement")
}

fn tight() -> Settings {
    Settings { tolerance: 1e-7, ..Settings::default() }
}

/// One point as a grid of one.
fn one_point(point: DVec3) -> Plane {
    let sides = [0.02 * DVec3::X, 0.02 * DVec3::Y];
    Plane::new(point - 0.01 * (DVec3::X + DVec3::Y), sides, [1, 1], PointsAt::Centres).expect("a plane")
}

fn at_point(
    luminaire: &Luminaire,
    placement: Placement,
    point: DVec3,
    receiver: Receiver,
    settings: &Settings,
) -> Illuminance {
    illuminance(&[Placed { luminaire, placement }], &one_point(point), &receiver, settings).expect("a grid")
}

const UP: Receiver = Receiver::Planar(DVec3::Z);

#[track_caller]
fn close(got: f64, expected: f64, relative: f64) {
    assert!((got / expected - 1.0).abs() <= relative, "{got} instead of {expected}: {:e}", got / expected - 1.0);
}

// ---------------------------------------------------------------------------------------------------- closed forms

/// `render/analytic.json`: cases with their formulas.
fn analytic() -> Option<impl Fn(&str) -> f64> {
    let text = std::fs::read_to_string(common::shared("render/analytic.json")?).expect("the reference opens");
    let cases: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    Some(move |name: &str| cases[name]["value"].as_f64().expect("a value"))
}

#[test]
fn a_point_follows_inverse_square_and_cosine() {
    let Some(case) = analytic() else { return };
    let even = lamp(rotational(180, |_| 1000.0), None);
    for (name, r) in [("point_I1000_h2_r0", 0.0), ("point_I1000_h2_r1", 1.0), ("point_I1000_h2_r3", 3.0)] {
        let e =
            at_point(&even, at(DVec3::new(0.0, 0.0, 2.0), Orientation::DOWN), DVec3::new(r, 0.0, 0.0), UP, &tight());
        close(e.values[0], case(name), 1e-13);
        assert!(e.point_error.is_none());
    }
}

#[test]
fn discs_and_rectangles_nearby_meet_their_closed_forms() {
    let Some(case) = analytic() else { return };
    let hung = at(DVec3::new(0.0, 0.0, 1.0), Orientation::DOWN);
    let bound = TABLE_ERROR + 1e-7;
    let disc = lambertian(body(Shape::Round, 1.0, 1.0, 0.0));
    for d in ["0", "0.5", "1", "3"] {
        let x: f64 = d.parse().expect("a number");
        let e = at_point(&disc, hung, DVec3::new(x, 0.0, 0.0), UP, &tight());
        // Towards the rim of the table the chord of the cosine is off by more than of its value: 3.8e-7/cos γ.
        close(1000.0 * e.values[0], case(&format!("disk_L1000_R0.5_h1_d{d}")), bound * (1.0 + x * x).sqrt());
    }
    let square = lambertian(body(Shape::Rectangle, 1.0, 1.0, 0.0));
    for (name, point, normal) in [
        ("rect_centre_1x1_h1_E_over_L", DVec3::ZERO, DVec3::Z),
        ("rect_corner_1x1_h1_E_over_L", DVec3::new(0.5, 0.5, 0.0), DVec3::Z),
        ("rect_perp_b1_a1_c1_E_over_L", DVec3::new(-0.5, -0.5, 0.0), DVec3::X),
    ] {
        let e = at_point(&square, hung, point, Receiver::Planar(normal), &tight());
        close(e.values[0], case(name), 2.0 * bound);
        assert_eq!(e.unresolved, 0);
    }
    let sphere = lamp(rotational(180, |_| 1000.0 * PI * 0.25), Some(body(Shape::Sphere, 1.0, 1.0, 1.0)));
    let e = at_point(&sphere, at(DVec3::new(0.0, 0.0, 2.0), Orientation::DOWN), DVec3::ZERO, UP, &tight());
    close(e.values[0], case("sphere_R0.5_D2_L1000"), 2e-7);
}

#[test]
fn very_near_a_disc_its_luminance_fills_the_half_space() {
    // E = π L r²/(r² + d²).
    let disc = lambertian(body(Shape::Round, 1.0, 1.0, 0.0));
    for d in [0.3, 0.1, 0.02] {
        let settings = Settings { tolerance: 1e-4, ..Settings::default() };
        let e = at_point(&disc, at(DVec3::new(0.0, 0.0, d), Orientation::DOWN), DVec3::ZERO, UP, &settings);
        close(e.values[0], PI * 0.25 / (0.25 + d * d), 1e-4 + 2.0 * TABLE_ERROR);
        assert_eq!(e.unresolved, 0);
    }
}

#[test]
fn the_error_of_a_point_is_the_square_of_radius_over_distance() {
    // On the axis of a Lambertian disc: E_point/E − 1 = (π r² L/d²)/(π L r²/(r² + d²)) − 1 = (r/d)², at five diameters 1 %.
    let disc = lambertian(body(Shape::Round, 1.0, 1.0, 0.0));
    let error = |d: f64, near_ratio: f64| {
        let settings = Settings { near_ratio, ..tight() };
        at_point(&disc, at(DVec3::new(0.0, 0.0, d), Orientation::DOWN), DVec3::ZERO, UP, &settings).point_error
    };
    for d in [1.0, 2.0, 4.999_999, 10.0, 20.0, 40.0] {
        let stated = error(d, 100.0).expect("near");
        let ratio = 0.25 / (d * d);
        assert!((stated.relative - ratio).abs() < (1.0 + ratio) * (TABLE_ERROR + 1e-7), "{d}: {stated:?}");
        assert_eq!((stated.at, stated.points_near), (0, 1));
    }
    assert!((error(4.999_999, 5.0).expect("near").relative - 0.01).abs() < 1e-6);
    assert!(error(5.000_001, 5.0).is_none());
}

#[test]
fn the_stated_error_is_that_of_the_worst_point() {
    let tube = lambertian(body(Shape::Rectangle, 1.5, 0.1, 0.0));
    let placed = [Placed { luminaire: &tube, placement: at(DVec3::new(0.0, 0.0, 1.2), Orientation::DOWN) }];
    let plane = Plane::new(DVec3::new(-2.0, -2.0, 0.0), [4.0 * DVec3::X, 4.0 * DVec3::Y], [21, 21], PointsAt::Nodes);
    let plane = plane.expect("a plane");
    let near = illuminance(&placed, &plane, &UP, &Settings::default()).expect("a grid");
    let points =
        illuminance(&placed, &plane, &UP, &Settings { near_ratio: 0.0, ..Settings::default() }).expect("a grid");
    let stated = near.point_error.expect("near");
    let errors: Vec<f64> = near.values.iter().zip(&points.values).map(|(e, p)| (p / e - 1.0).abs()).collect();
    let worst = errors.iter().copied().fold(0.0, f64::max);
    assert_eq!(stated.relative, worst);
    assert_eq!(errors[stated.at], worst);
    assert_eq!((stated.value, stated.as_point), (near.values[stated.at], points.values[stated.at]));
}

#[test]
fn cylindrical_illuminance_is_the_mean_of_all_vertical_planes() {
    // EN 12464-1, 4.6; and I sin ε/(π d²) of a single source.
    let source = lopsided(None);
    let placement = at(DVec3::new(1.0, 2.0, 3.0), Orientation::DOWN);
    let value = |receiver| at_point(&source, placement, DVec3::ZERO, receiver, &tight()).values[0];
    let facing = |i: u32| {
        let (s, c) = (TAU * f64::from(i) / 3600.0).sin_cos();
        DVec3::new(c, s, 0.0)
    };
    let mean = (0..3600).map(|i| value(Receiver::Planar(facing(i)))).sum::<f64>() / 3600.0;
    // The periodic rule errs by the kink of max(0, cos): at most h²/12 times its slopes, h = 1.7e-3.
    close(value(Receiver::Cylindrical), mean, 1e-6);
    // Semicylindrical, E_sc = I (1 + cos α) sin ε/(π d²): opposite ones add up to two cylinders, across it is one.
    let (towards, away) = (facing(700), -facing(700));
    close(
        value(Receiver::Semicylindrical(towards)) + value(Receiver::Semicylindrical(away)),
        2.0 * value(Receiver::Cylindrical),
        1e-13,
    );
    let across = DVec3::new(-2.0, 1.0, 0.0);
    close(value(Receiver::Semicylindrical(across)), value(Receiver::Cylindrical), 1e-13);
}

// ---------------------------------------------------------------------------------- bodies: brute force over rays

/// Whether the ray from `q` along `r` meets the body (centred on the origin).
fn hit(b: &Body, q: DVec3, r: DVec3) -> bool {
    let half = 0.5 * DVec3::new(b.width_m, b.length_m, b.height_m);
    // A quadric of the axes kept, and slabs across the others.
    let quadric = |keep: DVec3| {
        let (o, d) = (q * keep / half, r * keep / half);
        let (a, h, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
        let root = h * h - a * c;
        (root >= 0.0).then(|| ((-h - root.sqrt()) / a, (-h + root.sqrt()) / a))
    };
    let slab = |axis: usize| {
        let (a, b) = ((-half[axis] - q[axis]) / r[axis], (half[axis] - q[axis]) / r[axis]);
        Some((a.min(b), a.max(b)))
    };
    let parts = match b.shape {
        Shape::Rectangle => vec![slab(0), slab(1), slab(2)],
        Shape::Round => vec![quadric(DVec3::new(1.0, 1.0, 0.0)), slab(2)],
        Shape::Sphere => vec![quadric(DVec3::ONE)],
        Shape::CylinderAlongC90 => vec![quadric(DVec3::new(1.0, 0.0, 1.0)), slab(1)],
        Shape::CylinderAlongC0 => vec![quadric(DVec3::new(0.0, 1.0, 1.0)), slab(0)],
        Shape::Point => vec![None],
    };
    let meet = parts.into_iter().try_fold((0.0f64, f64::INFINITY), |(low, high), p| {
        let (a, b) = p?;
        let (low, high) = (low.max(a), high.min(b));
        (low <= high).then_some((low, high))
    });
    meet.is_some()
}

/// Projected solid angle of the body on a normal, by rays through a square window before it.
fn projected_solid_angle(b: &Body, q: DVec3, normal: DVec3) -> f64 {
    const RAYS: u32 = 700;
    let (towards, distance) = (-q.normalize(), q.length());
    let (e1, e2) = towards.any_orthonormal_pair();
    let radius = 0.5 * DVec3::new(b.width_m, b.length_m, b.height_m).length();
    // Tangent of the bounding sphere's half-angle.
    let window = radius / (distance * distance - radius * radius).sqrt();
    let step = 2.0 * window / f64::from(RAYS);
    let offset = |i: u32| (f64::from(i) + 0.5) * step - window;
    let mut sum = 0.0;
    for i in 0..RAYS {
        for j in 0..RAYS {
            let r = towards + offset(i) * e1 + offset(j) * e2;
            if hit(b, q, r) {
                // dω = step² cos³, and the receiver's cosine.
                let length = r.length();
                sum += (normal.dot(r) / length).max(0.0) / length.powi(3);
            }
        }
    }
    sum * step * step
}

#[test]
fn bodies_of_even_luminance_are_seen_as_their_solid_angle() {
    for b in [
        body(Shape::Rectangle, 0.6, 0.4, 0.2),
        body(Shape::Round, 0.6, 0.6, 0.3),
        body(Shape::Round, 0.6, 0.3, 0.3),
        body(Shape::Sphere, 0.6, 0.4, 0.3),
        body(Shape::CylinderAlongC90, 0.8, 0.3, 0.3),
        body(Shape::CylinderAlongC0, 0.3, 0.8, 0.3),
    ] {
        // L = 1 cd/m² everywhere: I = A_p. Planes and γ by 2°: bilinear within 2 (2°)²/8 of the larger face.
        let even = lamp(whole(2, |c, g| projected_area_m2(&b, c, g)), Some(b));
        for point in [DVec3::new(0.7, 0.4, -0.5), DVec3::new(-0.1, 0.05, -0.6), DVec3::new(0.3, -0.9, 0.25)] {
            let normal = (-point + DVec3::new(0.2, 0.1, 0.15)).normalize();
            let placement = at(DVec3::ZERO, Orientation::DOWN);
            let e = at_point(&even, placement, point, Receiver::Planar(normal), &Settings::default());
            // 700² rays: the outline crosses some 2500 of some 2e5 cells within it, each wrong by less than half its area and either way.
            close(e.values[0], projected_solid_angle(&b, point, normal), 1.5e-3);
            assert_eq!(e.unresolved, 0, "{b:?}");
        }
    }
}

#[test]
fn a_box_is_seen_as_the_faces_towards_the_point() {
    let b = body(Shape::Rectangle, 0.6, 0.4, 0.2);
    let even = lamp(whole(1, |c, g| projected_area_m2(&b, c, g)), Some(b));
    // From below and beside: the bottom and the side of +x, each by Lambert's formula, seen from the origin with z the normal.
    let point = DVec3::new(0.9, 0.1, -0.7);
    let face = |corners: [[f64; 3]; 4]| polygon_projected(&corners.map(|c| DVec3::from(c) - point));
    let bottom = face([[-0.2, -0.3, -0.1], [0.2, -0.3, -0.1], [0.2, 0.3, -0.1], [-0.2, 0.3, -0.1]]);
    let side = face([[0.2, -0.3, -0.1], [0.2, 0.3, -0.1], [0.2, 0.3, 0.1], [0.2, -0.3, 0.1]]);
    let e = at_point(
        &even,
        at(DVec3::ZERO, Orientation::DOWN),
        point,
        UP,
        &Settings { tolerance: 1e-6, ..Settings::default() },
    );
    // Bilinear within (1°)²/8 = 3.8e-5 of each amplitude in either angle.
    close(e.values[0], bottom + side, 1e-4);
}

#[test]
fn flat_lines_and_uprights_shine_from_where_they_are() {
    // A line of length l at height h seen from beneath its middle, I even: E = ∫ I/l · h/(h² + y²)^1.5 dy = I/(h² √(1 + (l/2h)²)).
    let line = lamp(rotational(180, |_| 100.0), Some(body(Shape::Rectangle, 2.0, 0.0, 0.0)));
    let e = at_point(&line, at(DVec3::new(0.0, 0.0, 1.0), Orientation::DOWN), DVec3::ZERO, UP, &tight());
    close(e.values[0], 100.0 / 2f64.sqrt(), 2e-7);
    // Upright ones are the same line turned.
    let turn = Orientation::Angles { rotation_deg: 0.0, tilt_deg: 90.0, towards_c_deg: 90.0, spin_deg: 0.0 };
    for b in [body(Shape::Rectangle, 0.0, 0.0, 2.0), body(Shape::Round, 0.0, 0.0, 2.0)] {
        let upright = lamp(rotational(180, |_| 100.0), Some(b));
        let e = at_point(&upright, at(DVec3::new(0.0, 0.0, 1.0), turn), DVec3::ZERO, UP, &tight());
        close(e.values[0], 100.0 / 2f64.sqrt(), 2e-7);
    }
    // An upright ellipse lies in the plane of its two extents: a disc seen along its own axis, of even intensity:
    // E = ∫ I/(π r²) d/(d² + ρ²)^1.5 2πρ dρ = (2I/r²)(1 − d/√(d² + r²)).
    let disc = lamp(rotational(180, |_| 100.0), Some(body(Shape::Round, 1.0, 0.0, 1.0)));
    let towards = Receiver::Planar(DVec3::NEG_X);
    let e = at_point(&disc, at(DVec3::ZERO, Orientation::DOWN), DVec3::X, towards, &tight());
    close(e.values[0], 800.0 * (1.0 - 1.0 / 1.25f64.sqrt()), 2e-7);
}

// -------------------------------------------------------------------------------------- symmetry and conservation

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn turning_luminaire_and_plane_together_changes_nothing(
        rotation_deg in -360.0..360.0f64, tilt_deg in 0.0..180.0f64, towards_c_deg in 0.0..360.0f64, spin_deg in -360.0..360.0f64,
        x in -5.0..5.0f64, y in -5.0..5.0f64,
    ) {
        let source = lopsided(Some(body(Shape::Rectangle, 1.2, 0.3, 0.1)));
        let turned = at(DVec3::new(x, y, 1.0), Orientation::Angles { rotation_deg, tilt_deg, towards_c_deg, spin_deg });
        let still = at(DVec3::ZERO, Orientation::DOWN);
        let m: DMat3 = turned.to_room();
        let corner = DVec3::new(-2.0, -1.5, -1.4);
        let plane = |m: DMat3, by: DVec3| {
            Plane::new(m * corner + by, [m * DVec3::new(4.0, 0.0, 0.3), m * DVec3::new(0.0, 3.0, 0.0)], [5, 4], PointsAt::Nodes)
                .expect("a plane")
        };
        let grid = |placement, plane: Plane| {
            let receiver = Receiver::Planar(plane.normal());
            illuminance(&[Placed { luminaire: &source, placement }], &plane, &receiver, &Settings::default()).expect("a grid")
        };
        let (a, b) = (grid(still, plane(DMat3::IDENTITY, DVec3::ZERO)), grid(turned, plane(m, turned.position_m())));
        for (a, b) in a.values.iter().zip(&b.values) {
            // The refinement may stop one step earlier on one side.
            prop_assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
        }
        let far = Settings { near_ratio: 0.0, ..Settings::default() };
        let point = |placement, plane: Plane| {
            let receiver = Receiver::Planar(plane.normal());
            illuminance(&[Placed { luminaire: &source, placement }], &plane, &receiver, &far).expect("a grid").values
        };
        for (a, b) in point(still, plane(DMat3::IDENTITY, DVec3::ZERO)).iter().zip(point(turned, plane(m, turned.position_m()))) {
            prop_assert!((a / b - 1.0).abs() < 1e-10, "{a} {b}");
        }
    }

    #[test]
    fn luminaires_add_up_and_factors_scale(
        x in -3.0..3.0f64, y in -3.0..3.0f64, tilt_deg in 0.0..80.0f64, dim in 0.0..2.0f64, maintenance_factor in 0.1..1.0f64,
    ) {
        let (first, second) = (lopsided(None), lambertian(body(Shape::Round, 0.5, 0.5, 0.0)));
        let o = Orientation::Angles { rotation_deg: 10.0, tilt_deg, towards_c_deg: 0.0, spin_deg: 0.0 };
        let a = Placed { luminaire: &first, placement: at(DVec3::new(x, y, 2.5), o) };
        let b = Placed { luminaire: &second, placement: at(DVec3::new(-x, 1.0, 2.0), o) };
        let dimmed = Placed { placement: Placement::new(b.placement.position_m(), o, dim).expect("a placement"), ..b };
        let plane = Plane::with_step(DVec3::new(-3.0, -3.0, 0.0), [6.0 * DVec3::X, 6.0 * DVec3::Y], 1.0, PointsAt::Nodes).expect("a plane");
        let grid = |placed: &[Placed<'_>], maintenance_factor| {
            let settings = Settings { maintenance_factor, ..Settings::default() };
            illuminance(placed, &plane, &UP, &settings).expect("a grid").values
        };
        let (both, one, other) = (grid(&[a, dimmed], maintenance_factor), grid(&[a], 1.0), grid(&[b], 1.0));
        for i in 0..both.len() {
            let sum = maintenance_factor * (one[i] + dim * other[i]);
            prop_assert!((both[i] - sum).abs() <= 1e-12 * sum);
        }
    }
}

#[test]
fn a_symmetric_layout_gives_a_symmetric_grid() {
    let tube = lambertian(body(Shape::Rectangle, 1.2, 0.2, 0.0));
    let placed: Vec<Placed<'_>> = [(-1.5, -1.0), (1.5, -1.0), (-1.5, 1.0), (1.5, 1.0)]
        .map(|(x, y)| Placed { luminaire: &tube, placement: at(DVec3::new(x, y, 2.0), Orientation::DOWN) })
        .to_vec();
    let plane = Plane::new(DVec3::new(-3.0, -2.0, 0.0), [6.0 * DVec3::X, 4.0 * DVec3::Y], [12, 8], PointsAt::Centres)
        .expect("a plane");
    let e = illuminance(&placed, &plane, &UP, &Settings::default()).expect("a grid");
    for row in 0..8 {
        for column in 0..12 {
            let here = e.values[row * 12 + column];
            for mirrored in [row * 12 + 11 - column, (7 - row) * 12 + column] {
                close(e.values[mirrored], here, 1e-12);
            }
        }
    }
    let f = e.figures.expect("figures");
    let mean = e.values.iter().sum::<f64>() / 96.0;
    close(f.mean, mean, 1e-14);
    assert_eq!((f.u0, f.ud), (Some(f.minimum / f.mean), Some(f.minimum / f.maximum)));
    assert_eq!((e.values[f.minimum_at], e.values[f.maximum_at]), (f.minimum, f.maximum));
}

/// Flux through the six sides of a cube of edge 2 m about the origin, seen from within, `cells`² points on each.
fn flux_through_cube(luminaire: &Luminaire, placement: Placement, cells: usize, settings: &Settings) -> f64 {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut sum = 0.0;
    for i in 0..3 {
        for sign in [-1.0, 1.0] {
            let (n, u, v) = (sign * axes[i], axes[(i + 1) % 3], axes[(i + 2) % 3]);
            let plane = Plane::new(n - u - v, [2.0 * u, 2.0 * v], [cells, cells], PointsAt::Centres).expect("a plane");
            let placed = [Placed { luminaire, placement }];
            let e = illuminance(&placed, &plane, &Receiver::Planar(-n), settings).expect("a grid");
            sum += 4.0 * e.figures.expect("figures").mean;
        }
    }
    sum
}

#[test]
fn all_light_of_an_even_lamp_leaves_a_closed_box() {
    // f = I/(1 + r²)^1.5 on each side: the midpoint rule errs by at most A h²/24 (|f_uu| + |f_vv|) ≤ 4 h²/24 · 6 I a side.
    let even = lamp(rotational(180, |_| 1.0), None);
    let h = 2.0 / 200.0;
    let bound = 6.0 * 4.0 * h * h / 24.0 * 6.0;
    let flux = flux_through_cube(&even, at(DVec3::ZERO, Orientation::DOWN), 200, &Settings::default());
    assert!((flux - 4.0 * PI).abs() <= bound, "{flux} ± {bound}");
}

#[test]
fn all_light_of_a_tilted_box_leaves_a_closed_box() {
    // As a body: what its faces emit is the flux of the distribution, wherever the parts of it stand.
    let b = body(Shape::Rectangle, 0.5, 0.3, 0.1);
    let source = lopsided(Some(b));
    let o = Orientation::Angles { rotation_deg: 20.0, tilt_deg: 35.0, towards_c_deg: 90.0, spin_deg: 5.0 };
    let flux = |cells| {
        flux_through_cube(
            &source,
            at(DVec3::new(0.1, -0.2, 0.1), o),
            cells,
            &Settings { tolerance: 1e-5, ..Settings::default() },
        )
    };
    // The midpoint rule's error falls with the step: what doubling the points changed bounds what is left.
    let (coarse, fine) = (flux(40), flux(80));
    let left = (fine - coarse).abs() + 1e-5 * fine;
    assert!((fine - source.distribution.total_flux()).abs() <= left, "{fine} {}", source.distribution.total_flux());
    assert!(left < 2e-3 * fine, "{left}");
}

#[test]
fn all_light_of_real_lamps_leaves_a_closed_box() {
    let Some(folder) = common::shared("luminaires/files") else { return };
    for file in [
        "holg+eulumdat-rs/EulumdatAndroid/app/src/main/assets/templates/road_luminaire.ldt",
        "echowuzangye+CU-calculations-based-on-IES-file/ies/flood/2.1.IES",
        "ksmet1977+luxpy/testcode/iolid_data/Testlamp_Isym2_theta180+_erco_33499000_1xqt32_230w.IES",
    ] {
        let bytes = std::fs::read(folder.join(file)).expect("the file opens");
        let source = format::open(&bytes, &ReadOptions::default()).expect("a lamp").value.luminaire;
        let o = Orientation::Angles { rotation_deg: 30.0, tilt_deg: 15.0, towards_c_deg: 90.0, spin_deg: 0.0 };
        let as_points = Settings { near_ratio: 0.0, ..Settings::default() };
        let flux = |cells| flux_through_cube(&source, at(DVec3::ZERO, o), cells, &as_points);
        let (coarse, fine) = (flux(150), flux(300));
        let left = (fine - coarse).abs() + 1e-4 * fine;
        assert!(
            (fine - source.distribution.total_flux()).abs() <= left,
            "{file}: {fine} {}",
            source.distribution.total_flux()
        );
    }
}

/// The luminaires of the renderer: a real file turned about all axes lights points as the grid says, and sends out its flux.
#[test]
fn real_lamps_light_a_rendered_scene_as_they_light_a_grid() {
    let (Some(folder), Some(index)) = (common::shared("luminaires/files"), common::shared("luminaires/index.csv"))
    else {
        return;
    };
    let o = Orientation::Angles { rotation_deg: 40.0, tilt_deg: 35.0, towards_c_deg: 60.0, spin_deg: -20.0 };
    let placement = at(DVec3::new(0.2, 0.1, 2.0), o);
    let sides = [DVec3::new(6.0, 0.0, 0.0), DVec3::new(0.0, 5.0, 0.0)];
    let plane = Plane::new(DVec3::new(-3.0, -2.5, 0.0), sides, [6, 5], PointsAt::Centres).expect("a plane");
    let as_points = Settings { near_ratio: 0.0, ..Settings::default() };
    let mut compared = 0;
    for row in &common::rows(&index) {
        let bytes = std::fs::read(folder.join(&row["file"])).expect("the file opens");
        let Ok(read) = format::open(&bytes, &ReadOptions::default()) else { continue };
        let source = read.value.luminaire;
        // Negative intensities are refused by the light.
        let Ok(light) = Goniometric::new(source.distribution.clone(), &placement, &[1.0]) else { continue };
        let placed = [Placed { luminaire: &source, placement }];
        let grid = illuminance(&placed, &plane, &UP, &as_points).expect("a grid");
        for (i, expected) in grid.values.iter().enumerate() {
            let mut arriving = [0.0];
            let towards = light.sample_towards(plane.point_m(i), [0.5; 3], &mut arriving);
            let got = towards.map_or(0.0, |t| arriving[0] * t.direction.z);
            assert!((got - expected).abs() <= 1e-12 * expected, "{}: {got} instead of {expected}", row["file"]);
        }
        let (mut stream, mut flux, n) = (Stream::new(6, compared), [0.0], 3000);
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..n {
            let drawn = light.emit(stream.uniforms(), &mut flux).map_or(0.0, |_| flux[0]);
            (sum, squares) = (sum + drawn, squares + drawn * drawn);
        }
        let (mean, whole) = (sum / f64::from(n), source.distribution.total_flux());
        // 4.5 standard errors: 7e-6 for one lamp, 1e-3 for all.
        let error = ((squares / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt();
        assert!((mean - whole).abs() <= 4.5 * error + 1e-9 * whole, "{}: {mean} ± {error}, {whole}", row["file"]);
        compared += 1;
    }
    assert!(compared > 100, "{compared}");
}

// ------------------------------------------------------------------------------------------------ odd places

#[test]
fn in_a_luminaire_there_is_no_illuminance() {
    let point = lamp(rotational(180, |_| 1.0), None);
    let tube = lambertian(body(Shape::Rectangle, 1.2, 0.2, 0.0));
    for source in [&point, &tube] {
        let e = at_point(source, at(DVec3::ZERO, Orientation::DOWN), DVec3::ZERO, UP, &Settings::default());
        assert!(e.values[0].is_nan() && e.undefined == 1 && e.figures.is_none());
    }
    // Beside it there is, in its own plane too.
    let e = at_point(&tube, at(DVec3::ZERO, Orientation::DOWN), DVec3::new(0.3, 0.0, 0.0), UP, &Settings::default());
    assert!(e.values[0] == 0.0 && e.undefined == 0);
}

#[test]
fn what_cannot_be_calculated_is_refused() {
    let source = lamp(rotational(180, |_| 1.0), None);
    let watts = Luminaire { kind: Kind::Radiant, ..source.clone() };
    let place = at(DVec3::Z, Orientation::DOWN);
    let (a, b) = (Placed { luminaire: &source, placement: place }, Placed { luminaire: &watts, placement: place });
    let try_it = |placed: &[Placed<'_>], receiver, settings: &Settings| {
        illuminance(placed, &one_point(DVec3::ZERO), &receiver, settings).map(|_| ())
    };
    let usual = Settings::default();
    assert_eq!(try_it(&[a, b], UP, &usual), Err(Error::Kinds));
    assert_eq!(try_it(&[], UP, &usual), Err(Error::Empty));
    assert_eq!(try_it(&[a], Receiver::Planar(DVec3::ZERO), &usual), Err(Error::Facing));
    assert_eq!(try_it(&[a], Receiver::Semicylindrical(DVec3::Z), &usual), Err(Error::Facing));
    for bad in [
        Settings { maintenance_factor: 0.0, ..usual },
        Settings { tolerance: 0.0, ..usual },
        Settings { near_ratio: f64::NAN, ..usual },
    ] {
        assert!(matches!(try_it(&[a], UP, &bad), Err(Error::Setting { .. })));
    }
}

#[test]
fn the_floor_beneath_a_luminaire_reaches_to_where_it_is_dark() {
    // cos⁴ of a Lambertian: 5 % at tan γ = √(0.05^(−1/2) − 1) = 1.86 heights, so the square reaches ± 2.
    let e = beneath(&lambertian(body(Shape::Round, 0.2, 0.2, 0.0)), 3.0, 100, &Settings::default()).expect("a grid");
    assert_eq!(e.plane.size_m(), [12.0, 12.0]);
    assert_eq!(e.plane.counts(), [101, 101]);
    let f = e.figures.expect("figures");
    assert_eq!(e.plane.point_m(f.maximum_at), DVec3::ZERO);
    // Fifteen diameters away: a point, I/h².
    close(f.maximum, PI * 0.01 / 9.0, 1e-12);
    assert!(matches!(beneath(&lopsided(None), 0.0, 100, &Settings::default()), Err(Error::Setting { .. })));
}

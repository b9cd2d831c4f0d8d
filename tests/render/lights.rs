//! A meter sees every kind of light, through the path tracer, as its closed form says.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};
use photopic::luminaire::placement::{Orientation, Placement};
use photopic::luminaire::{Distribution, Symmetry, System};
use photopic::render::estimate::Figure;
use photopic::render::integrator::limits::Limits;
use photopic::render::light::Light;
use photopic::render::light::barzel::{Barzel, Controls};
use photopic::render::light::bounding::BoundingSphere;
use photopic::render::light::distant::Distant;
use photopic::render::light::environment::{Environment, Picture};
use photopic::render::light::goniometric::{Goniometric, Opening};
use photopic::render::light::point::Point;
use photopic::render::light::projection::Projection;
use photopic::render::light::sky::{Sky, SkyType};
use photopic::render::light::spot::{Profile, Spot};
use photopic::render::measure::{Board, Meter, Settings, Target};
use photopic::render::sensor::response::Response;
use photopic::render::shape::disk::Disk;
use photopic::render::spool::Share;

use crate::analytic::{agrees, at, part, read, scene};

fn sphere() -> BoundingSphere {
    BoundingSphere::new(DVec3::ZERO, 2.0).expect("a sphere")
}

/// 100 cd in every direction, as a file would say it.
fn lamp() -> Goniometric {
    let rows: Vec<f64> = (0..=6).map(|i| f64::from(30 * i)).collect();
    let table = Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], rows, vec![100.0; 7]);
    let placement = Placement::new(2.0 * DVec3::Z, Orientation::DOWN, 1.0).expect("a placement");
    Goniometric::new(table.expect("a table"), &placement, &[1.0]).expect("a lamp")
}

fn picture(projection: Projection) -> Environment {
    let picture =
        Picture { width: 64, height: 64, projection, coefficients: vec![3.0; 64 * 64], spectra: vec![vec![1.0]] };
    // The camera looks up.
    Environment::new(picture, DMat3::from_rotation_y(-FRAC_PI_2), sphere()).expect("surroundings")
}

/// Every light, the irradiance on the floor at (1, 0, 0), facing up, and why.
fn lights() -> Vec<(&'static str, Arc<dyn Light>, f64)> {
    // I cosθ/r² of 100 cd two metres above and one beside: r² = 5, cosθ = 2/√5.
    let of_a_point = 100.0 * 2.0 / 5.0_f64.powf(1.5);
    let place = 2.0 * DVec3::Z;
    let axis = DVec3::new(1.0, 0.0, -2.0);
    let spot = |profile| Spot::new(place, axis, profile, &[100.0]).expect("a spot");
    let slanted = DVec3::new(3.0, 0.0, 4.0);
    let distant = |radius| Distant::new(slanted, radius, &[50.0], sphere()).expect("a light");
    let sky = |number| Sky::from_zenith(SkyType::new(number).expect("a type"), DVec3::Z, slanted, &[1000.0], sphere());
    let clear = Sky::from_horizontal(SkyType::new(12).expect("a type"), DVec3::Z, slanted, &[9000.0], sphere());
    let barzel = Barzel::new(place, axis, DVec3::Y, &[100.0], Controls::default()).expect("a light");
    vec![
        ("point", Arc::new(Point::new(place, &[100.0]).expect("a point")), of_a_point),
        ("cosine spot", Arc::new(spot(Profile::Cosine)), of_a_point),
        ("cone", Arc::new(spot(Profile::Cone { half_angle_rad: 1e-3 })), of_a_point),
        ("luminaire", Arc::new(lamp()), of_a_point),
        ("small opening", Arc::new(lamp().with_opening(Opening::Ellipse(DVec2::splat(1e-6)))), of_a_point),
        ("production light", Arc::new(barzel), of_a_point),
        ("distant", Arc::new(distant(0.0)), 40.0),
        // A uniform disc wholly above the horizon has the cosine of its middle.
        ("sun", Arc::new(distant(0.00465)), 40.0),
        ("broad disc", Arc::new(distant(0.5)), 40.0),
        ("constant", Arc::new(Environment::constant(&[3.0], sphere()).expect("surroundings")), 3.0 * PI),
        ("mirror ball", Arc::new(picture(Projection::MirrorBall)), 3.0 * PI),
        ("fisheye", Arc::new(picture(Projection::HEMISPHERE)), 3.0 * PI),
        ("uniform sky", Arc::new(sky(5).expect("a sky")), 1000.0 * PI),
        ("overcast sky", Arc::new(sky(16).expect("a sky")), 1000.0 * 7.0 * PI / 9.0),
        ("clear sky", Arc::new(clear.expect("a sky")), 9000.0),
    ]
}

#[test]
fn a_meter_on_the_floor() {
    for (name, light, expected) in lights() {
        let scene = scene(Vec::new(), vec![light]);
        agrees_but_for_the_point(read(&scene, at(DVec3::X, DVec3::Z), 21), expected, name);
    }
}

/// The small opening is a point to within 3 r/h, its radius over the distance, in each of its draws.
fn agrees_but_for_the_point(figure: Figure, expected: f64, name: &str) {
    if name == "small opening" {
        assert!((figure.value / expected - 1.0).abs() < 3e-6, "{figure:?} {expected}");
    } else {
        agrees(figure, expected, name);
    }
}

#[test]
fn all_of_them_together_add_up() {
    let (lights, expected): (Vec<Arc<dyn Light>>, Vec<f64>) = lights().into_iter().map(|(_, l, e)| (l, e)).unzip();
    // Five times as many are chosen among by the fixed table.
    for times in [1_u8, 5] {
        let many = (0..times).flat_map(|_| lights.iter().cloned()).collect();
        let figure = read(&scene(Vec::new(), many), at(DVec3::X, DVec3::Z), 22);
        agrees(figure, f64::from(times) * expected.iter().sum::<f64>(), "all");
    }
}

/// A disk of radius 1 m at a height of 1 m hides the sky above the meter to 45°: of a uniform sky sin²45° = ½ is lost.
#[test]
fn a_shade_hides_half_of_the_sky() {
    for (name, light, _) in
        lights().into_iter().filter(|(name, ..)| ["constant", "mirror ball", "fisheye"].contains(name))
    {
        let shade = Disk::new(DVec3::Z, DVec3::NEG_Z, 1.0).expect("a disk");
        let shade = scene(vec![part(shade, 0.0, None)], vec![light]);
        agrees(read(&shade, at(DVec3::ZERO, DVec3::Z), 23), 1.5 * PI, name);
    }
}

/// The same disk stands between a point and the meter; a production light may be told to shine through.
#[test]
fn a_light_without_shadows_shines_through() {
    for (shadows, expected) in [(true, 0.0), (false, 100.0 * 2.0 / 5.0_f64.powf(1.5))] {
        let controls = Controls { shadows, ..Controls::default() };
        let light = Barzel::new(2.0 * DVec3::Z, DVec3::NEG_Z, DVec3::Y, &[100.0], controls).expect("a light");
        let shade = Disk::new(DVec3::Z, DVec3::NEG_Z, 1.0).expect("a disk");
        let scene = scene(vec![part(shade, 0.0, None)], vec![Arc::new(light)]);
        // Without scatter a few samples are enough, and an error relative to nothing is never small enough.
        let settings = Settings::new(24, Limits::default(), 1);
        let meter = Meter { place: at(DVec3::X, DVec3::Z), response: Response::Planar };
        let mut board = Board::new(&scene, &settings, Share::WHOLE, vec![(0, meter)]);
        board.sample_to(&Target { relative: 1e-3, meters: vec![0], weights: vec![1.0] }, 64, |_, _| ());
        agrees(board.estimate(0).figure(&[1.0]), expected, "shadow");
    }
}

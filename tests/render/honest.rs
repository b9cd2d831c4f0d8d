//! What a render promises of its figures: the same bits however it is run, and error bars that hold.

use std::sync::Arc;

use glam::DVec3;
use photopic::brdf::lambert::Lambert;
use photopic::render::bands::Bands;
use photopic::render::emission::Emission;
use photopic::render::integrator::limits::Limits;
use photopic::render::material::opaque::Opaque;
use photopic::render::measure::{Board, Meter, Place, Settings, Target};
use photopic::render::ray::SurfacePoint;
use photopic::render::scene::{Part, Scene};
use photopic::render::sensor::response::Response;
use photopic::render::shape::rectangle::Rectangle;
use photopic::render::shape::sphere::Sphere;
use photopic::render::spool::Share;

/// A white hollow sphere with a small square lamp in it: light from many bounces. L = Φ/(π A (1 − ρ)) but for what the lamp hides,
/// which the reference below knows as well.
fn scene() -> Scene {
    let lambert = |rho: f64| Arc::new(Opaque::new(Box::new(Lambert::new(vec![rho]).expect("a reflectance")), true));
    let wall = Sphere::new(DVec3::ZERO, 1.0).expect("a sphere");
    let lamp = Rectangle::new(DVec3::new(-0.1, -0.1, 0.5), DVec3::Y * 0.2, DVec3::X * 0.2).expect("a square");
    let part = |shape: Arc<dyn photopic::render::shape::Shape>, rho, radiance: Option<f64>| Part {
        shape,
        material: lambert(rho),
        emission: radiance.map(|l| Arc::new(Emission::diffuse(vec![l]))),
    };
    let parts = vec![part(Arc::new(wall), 0.6, None), part(Arc::new(lamp), 0.2, Some(1000.0))];
    Scene::new(Bands::lines(vec![555.0]), parts, Vec::new())
}

fn meters() -> Vec<(u64, Meter)> {
    let at = |p: DVec3, axis| Place::Point(SurfacePoint::meter(p, axis, 1e-12));
    vec![
        (7, Meter { place: at(DVec3::new(0.0, 0.0, -0.5), DVec3::Z), response: Response::Planar }),
        (8, Meter { place: at(DVec3::new(0.3, 0.1, 0.0), DVec3::X), response: Response::Spherical }),
    ]
}

#[test]
fn shares_rounds_and_threads_give_the_same_bits() {
    let scene = scene();
    let settings = Settings::new(3, Limits::default(), 1);
    let run = |share, threads: usize, rounds: &[u64]| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut board = Board::new(&scene, &settings, share, meters());
            rounds.iter().for_each(|n| board.sample_until(*n));
            (0..2).map(|m| board.replicates(m).to_vec()).collect::<Vec<_>>()
        })
    };
    let whole = run(Share::WHOLE, 1, &[100]);
    assert_eq!(whole, run(Share::WHOLE, 3, &[100]));
    assert_eq!(whole, run(Share::WHOLE, 2, &[1, 17, 100]));
    let parts: Vec<_> = (0..3).map(|index| run(Share { index, count: 3 }, 2, &[100])).collect();
    for (meter, replicates) in whole.iter().enumerate() {
        for (number, replicate) in replicates.iter().enumerate() {
            assert_eq!(replicate, &parts[number % 3][meter][number]);
        }
    }
    assert_ne!(whole[0][0], whole[0][1]);
}

/// Of 200 seeds, run until the standard error is 1 %, as many readings lie within two standard errors of the truth as Student's t of 31
/// degrees of freedom says, 94.6 % (t = 2.04 covers 95 %): fewer than 95 % by no more than four binomial deviations.
#[test]
fn a_target_is_met_and_its_error_bars_hold() {
    let scene = scene();
    let read = |seed, relative, most| {
        let settings = Settings::new(seed, Limits::default(), 1);
        let mut board = Board::new(&scene, &settings, Share::WHOLE, meters());
        let target = Target { relative, meters: vec![0, 1], weights: vec![1.0] };
        let met = board.sample_to(&target, most, |_, _| ());
        (met, [board.estimate(0).figure(&[1.0]), board.estimate(1).figure(&[1.0])])
    };
    let (_, truth) = read(1 << 40, 1e-9, 1 << 13);
    let mut inside = [0_u32; 2];
    for seed in 0..200 {
        let (met, figures) = read(seed, 0.01, 1 << 16);
        assert!(met, "seed {seed}");
        for ((count, figure), truth) in inside.iter_mut().zip(figures).zip(truth) {
            assert!(figure.standard_error <= 0.01 * figure.value);
            let error = figure.standard_error.hypot(truth.standard_error);
            *count += u32::from((figure.value - truth.value).abs() <= 2.04 * error);
        }
    }
    for count in inside {
        // 190 expected, standard deviation √(200 · 0.95 · 0.05) = 3.08.
        assert!(count >= 190 - 13, "{count} of 200");
    }
    assert!(!read(1, 1e-9, 4).0, "a target out of reach is said not to be met");
}

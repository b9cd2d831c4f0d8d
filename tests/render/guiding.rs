//! Guided paths, and both ways at polished surfaces, beside what they stand for: the path tracer's pictures in every band, a meter's reading of
//! the same cone, the same bits however a picture is asked for.

use glam::DVec3;
use photopic::image::source::{Region, Source};
use photopic::math::random::Stream;
use photopic::render::build::Built;
use photopic::render::estimate::{Estimate, REPLICATES, Replicate};
use photopic::render::film::Film;
use photopic::render::guiding;
use photopic::render::integrator::path::PathTracer;
use photopic::render::measure::Settings;
use photopic::render::ray::{Ray, SurfacePoint};
use photopic::render::sampler::Sampler;
use photopic::render::sensor::response::Response;

use crate::pictures::{ROOM, VIEW, blocks, built, camera, figure, picture};

const LAMP: &str = r#"
[[shape]]
material = "white"
emission = { radiance = "1000 cd/m2", spectrum = "D65" }
rectangle = { corner = [-0.6, -0.6, 2.5], edges = [[0, 1.2, 0], [1.2, 0, 0]] }
"#;
/// Flint on the floor, beneath the lamp.
const BALL: &str = r#"
[[material]]
name = "flint"
dielectric = { medium = "SF10" }
[[shape]]
material = "flint"
sphere = { centre = [0, 0.3, 0.52], radius = "0.5 m" }
"#;
const PANE: &str = r#"
[[material]]
name = "crown"
dielectric = { medium = "BK7" }
[[shape]]
material = "crown"
box = { from = [-1.5, -1.5, 1.2], to = [1.5, 1.5, 1.25] }
"#;

fn settings(built: &Built, seed: u64, guiding: Option<bool>) -> Settings {
    Settings { seed, guiding, virtual_lights: Some(false), ..built.settings.clone() }
}

/// In every quarter of the picture and every band, by the scatter over seeds: through dispersing glass, a pane, off a mirror, among virtual
/// lights, beside packets, by paths of a few edges, of one wavelength, and with a dye that exchanges them.
#[test]
fn pictures_are_those_of_the_path_tracer() {
    let mirror = "[[material]]\nname = \"silver\"\nmetal = { medium = \"Ag\" }\n[[shape]]\nmaterial = \"silver\"\nrectangle = { corner = [-1, 1.2, 0.2], edges = [[2, 0, 0], [0, 0.5, 1]] }\n";
    let dye = "[[material]]\nname = \"dye\"\ndye = { reflectance = 0.3, absorption = [[400, 0.6], [480, 0.6], [520, 0], [830, 0]], emission = [[500, 0], [540, 1], [620, 0]], quantum_yield = 0.9 }\n[[shape]]\nmaterial = \"dye\"\nbox = { from = [0.7, 0, 0], to = [1.2, 0.5, 0.3] }\n";
    let sky = "[[light]]\nsky = { type = 12, horizontal = \"10000 lx\" }\n";
    let scenes = [
        ("ball", format!("{BALL}{LAMP}"), ""),
        ("edges", format!("{BALL}{LAMP}"), "max_edges = 5\n"),
        ("one", format!("{BALL}{LAMP}"), "wavelengths_per_path = \"one\"\n"),
        ("packets", format!("{BALL}{LAMP}"), "solver = \"bidirectional\"\n"),
        ("dye", format!("{BALL}{LAMP}{dye}"), ""),
        ("mirror", format!("{mirror}{LAMP}"), ""),
        ("pane", format!("{PANE}{sky}"), ""),
    ];
    for (name, shapes, keys) in scenes {
        let built = built(&format!("[render]\nwavelength_step_nm = 60\n{keys}{ROOM}{shapes}{VIEW}"));
        let parts = |guiding, virtual_lights, first: u64| -> Vec<Vec<f64>> {
            (first..first + 24)
                .map(|seed| {
                    let virtual_lights = Some(virtual_lights);
                    let settings = Settings { virtual_lights, ..settings(&built, seed, Some(guiding)) };
                    blocks(&picture(&built, &settings, 256).0, camera(&built), 2)
                })
                .collect()
        };
        let without = parts(false, false, 100);
        // Beside packets there are no virtual lights.
        for (with, among) in [(parts(true, false, 0), false), (parts(true, true, 200), true)] {
            for part in 0..with[0].len() {
                let of = |all: &[Vec<f64>]| figure(&all.iter().map(|p| p[part]).collect::<Vec<_>>());
                let ((a, da), (b, db)) = (of(&with), of(&without));
                // Of 23 to 46 degrees of freedom: beyond 5 once in 20 000 or less, and there are 600.
                let close = (a - b).abs() <= 5.0 * da.hypot(db);
                assert!(close, "{name}, virtual lights {among}, {part}: {a} ± {da}, {b} ± {db}");
            }
        }
    }
}

/// The mean of the radiance along rays that are drawn in a cone, which go both ways at glass as long as either is above 0.2 %, is what a meter of that
/// cone reads, whose paths go on one way much sooner: in every band, with polarisation, dispersion, and lamps seen by reflections inside.
#[test]
fn both_ways_are_the_mean_of_either() {
    let built = built(&format!("[render]\nwavelength_step_nm = 60\n{ROOM}{BALL}{PANE}{LAMP}{VIEW}spectrum = true\n"));
    let bands = built.scene.bands().len();
    let limits = built.settings.limits;
    assert!(limits.polarisation);
    let response = Response::Cone { sin: 0.3 };
    let axis = DVec3::new(0.0, 0.9, -0.25).normalize();
    for above in [0.9, 1.6] {
        let point = SurfacePoint::meter(DVec3::new(0.1, -1.4, above), axis, 0.0);
        let figures = |both: bool| {
            let mut tracer = PathTracer::new(&built.scene, limits, &built.settings.heroes);
            let replicates = (0..REPLICATES as u64).map(|stream| {
                let mut sampler = Sampler::new(u64::from(both), stream, 0);
                let mut numbers = Stream::new(7, stream);
                let mut replicate = Replicate::new(bands);
                while replicate.samples() < 20_000 {
                    sampler.start(replicate.samples());
                    let sample = if both {
                        let (local, _) = response.sample([numbers.uniform(), numbers.uniform()]);
                        let across = point.normal.cross(point.tangent);
                        let direction = local.x * point.tangent + local.y * across + local.z * point.normal;
                        tracer.radiance(Ray { origin: point.position, direction }, &mut sampler)
                    } else {
                        tracer.reading(&point, &response, 0.0, &mut sampler)
                    };
                    replicate.add(stream, sample);
                }
                replicate
            });
            let estimate = Estimate::new(replicates.collect());
            assert_eq!(estimate.faults().count(), 0);
            estimate.bands()
        };
        for (band, (a, b)) in figures(true).iter().zip(figures(false)).enumerate() {
            let error = a.standard_error.hypot(b.standard_error);
            // Student's t of 31 degrees of freedom or more: beyond 5 once in 50 000.
            assert!((a.value - b.value).abs() <= 5.0 * error, "{above}, band {band}: {a:?} {b:?}");
            assert!(error <= 0.05 * b.value, "{above}, band {band}: {a:?} {b:?}");
        }
    }
}

#[test]
fn a_part_of_a_picture_is_that_of_the_whole() {
    let built = built(&format!("[render]\nwavelength_step_nm = 100\n{ROOM}{BALL}{LAMP}{VIEW}"));
    let settings = settings(&built, 3, Some(true));
    let film = || {
        let tristimulus = &built.quantities.tristimulus;
        let mut film = Film::new(&built.scene, camera(&built), &settings, 0, 20, tristimulus, |_| ());
        film.survey(true);
        film
    };
    let (mut first, mut second) = (film(), film());
    let read = |film: &mut Film<_>, x, y, width, height| {
        let mut out = vec![0.0; width * height];
        film.read(Region { x, y, width, height }, &[0], &mut out).expect("rows");
        out
    };
    let (whole, part) = (read(&mut first, 0, 0, 12, 10), read(&mut second, 5, 3, 4, 2));
    for y in 0..2 {
        assert_eq!(part[y * 4..][..4], whole[(y + 3) * 12 + 5..][..4]);
    }
}

/// Where nothing is polished, or nothing else, there is nothing to guide.
#[test]
fn paths_are_guided_where_there_is_glass() {
    let with = |text: &str, guiding| {
        let built = built(text);
        picture(&built, &settings(&built, 3, guiding), 16).0
    };
    let ball = format!("[render]\nwavelength_step_nm = 100\n{ROOM}{BALL}{LAMP}{VIEW}");
    assert!(with(&ball, Some(true)) != with(&ball, Some(false)));
    let block = "[[shape]]\nmaterial = \"red\"\nbox = { from = [-0.5, 0, 0], to = [0.5, 0.6, 0.9] }\n";
    let block = format!("[render]\nwavelength_step_nm = 100\n{ROOM}{block}{LAMP}{VIEW}");
    assert!(with(&block, Some(true)) == with(&block, Some(false)));
    let suits = |text: &str| {
        let built = built(text);
        guiding::suits(&built.scene, &built.settings.limits)
    };
    // The lamp and all that is white are diffuse.
    assert!(suits(&ball) && !suits(&block));
    assert!(!suits(&ball.replace("[render]", "[render]\nsolver = \"whitted\"")));
}

/// In a closed space a packet comes to 1/(1 − ρ) diffuse surfaces, with glass that takes nothing in it as well: of all but those that are straight
/// from the lamp it is told. Polarised flux, that grew where the more seldom way is drawn as often, would go on without end.
#[test]
fn packets_end_in_a_closed_space() {
    let text = r#"
[render]
wavelength_step_nm = 100
[[material]]
name = "white"
reflectance = 0.9
[[material]]
name = "glass"
dielectric = { index = 1.73 }
[[shape]]
material = "white"
sphere = { centre = [0, 0, 0], radius = "1 m" }
[[shape]]
material = "glass"
sphere = { centre = [0.3, 0, 0], radius = "0.6 m" }
[[shape]]
material = "white"
emission = { radiance = "1000 cd/m2", spectrum = "D65" }
sphere = { centre = [0, 0.8, 0], radius = "0.05 m" }
"#;
    let built = built(&format!("{text}{VIEW}"));
    assert!(built.settings.limits.polarisation);
    // The fewest that are sent.
    let packets = 65_536.0_f64;
    let landings = guiding::landings(&built.scene, &built.settings, 1, 1);
    let each: f64 = landings.polished.iter().chain(&landings.plain).map(|landing| landing.weight).sum();
    // The number is geometric: of second moment (1 + ρ)/(1 − ρ)². Of straight ones every 16th packet tells, 28 of 32 rounds count, a packet counts for
    // 1/0.3 at most. Five standard errors.
    let error = 5.0 * (1.9_f64 / 0.01 / 0.3 / (packets / 16.0 * 28.0 / 32.0)).sqrt();
    assert!(each > 9.0 - error && each < 10.0 + error, "{each}");
    assert!(landings.polished.len() > landings.plain.len());
}

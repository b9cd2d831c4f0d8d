//! Meters read by paths from both ends: closed forms and light tracing where no path from the meter finds the light, the path tracer's
//! readings where both find all of it.

use glam::DVec3;
use photopic::render::build::{Built, Kind};
use photopic::render::estimate::Estimate;
use photopic::render::integrator::light::{LightTracer, Visitor};
use photopic::render::measure::{Board, Meter, Settings};
use photopic::render::ray::Ray;
use photopic::render::sampler::Sampler;
use photopic::render::spool::Share;

use crate::bidirectional::scenes;
use crate::pictures::{built, figure};

/// All meters of a scene, one behind the other, with numbers of their own.
fn meters(built: &Built) -> Vec<(u64, Meter)> {
    let own = built.instruments.iter().flat_map(|i| match &i.kind {
        Kind::Meter(meter) => vec![meter.clone()],
        Kind::Grid { meters, .. } => meters.clone(),
        _ => Vec::new(),
    });
    (0..).zip(own).collect()
}

fn readings(built: &Built, settings: &Settings, samples: u64) -> Vec<Estimate> {
    let meters = meters(built);
    let count = meters.len();
    let mut board = Board::new(&built.scene, settings, Share::WHOLE, meters);
    board.sample_until(samples);
    (0..count).map(|meter| board.estimate(meter)).collect()
}

/// Parallel light through a pane of flint, straight down, in three edges: E behind it is (1 − R)² E₀ for each wavelength,
/// R = ((n − 1)/(n + 1))² (Fresnel), on the floor and on a grid in the air. No path from a meter meets parallel light through glass.
#[test]
fn parallel_light_comes_through_a_pane_onto_meters() {
    let (b, c) = ([1.621_539_02, 0.256_287_842, 1.644_475_52], [0.012_224_145_7, 0.059_573_677_5, 147.468_793]);
    let text = format!(
        r#"
[render]
solver = "bidirectional"
max_edges = 3
wavelength_step_nm = 60
[[material]]
name = "flint"
dielectric = {{ sellmeier = {{ b = {b:?}, c_um2 = {c:?} }} }}
[[shape]]
name = "floor"
rectangle = {{ corner = [-0.4, -0.4, 0], edges = [[0.8, 0, 0], [0, 0.8, 0]] }}
[[shape]]
material = "flint"
box = {{ from = [-0.4, -0.4, 0.3], to = [0.4, 0.4, 0.4] }}
[[light]]
spectrum = [[360, 1], [830, 1]]
distant = {{ from = [0, 0, 1], irradiance = "1000 lx" }}
[[sensor]]
name = "floor"
spectrum = true
illuminance = {{ on = "floor" }}
[[sensor]]
name = "air"
illuminance = {{ grid = {{ corner = [-0.3, -0.3, 0.1], edges = [[0.6, 0, 0], [0, 0.6, 0]], points = [2, 1] }} }}
[[sensor]]
name = "point"
illuminance = {{ at = [0, 0, 0.1] }}
"#
    );
    let built = built(&text);
    let mut flux = vec![0.0; built.scene.bands().len()];
    built.scene.lights()[0].sample_towards(DVec3::ZERO, [0.5; 3], &mut flux).expect("it shines");
    let mut settings = built.settings.clone();
    let estimates = readings(&built, &settings, 2048);
    for estimate in &estimates[..3] {
        for ((nm, figure), flux) in built.scene.bands().wavelengths_nm().iter().zip(estimate.bands()).zip(&flux) {
            let squared = (nm / 1000.0).powi(2);
            let n = (1.0 + (0..3).map(|i| b[i] * squared / (squared - c[i])).sum::<f64>()).sqrt();
            let reflected = ((n - 1.0) / (n + 1.0)).powi(2);
            let expected = (1.0 - reflected).powi(2) * flux;
            assert!(figure.standard_error < 0.05 * expected, "{nm}: {figure:?}");
            // Student's t of 31 degrees of freedom: 1e-4 for each of some 24.
            assert!((figure.value - expected).abs() < 4.5 * figure.standard_error, "{nm}: {figure:?}, {expected}");
        }
    }
    // What has no area is not reached, which the model says; nor is anything by paths alone.
    assert_eq!(estimates[3].figure(&built.quantities.luminous).value, 0.0);
    settings.packets = false;
    assert!(readings(&built, &settings, 64).iter().all(|e| e.figure(&built.quantities.luminous).value == 0.0));
}

/// Flux that packets bring to one surface.
struct Landed {
    surface: usize,
    flux: f64,
}

impl Visitor for Landed {
    fn emitted(&mut self, _: &[f64]) {}
    fn flight(&mut self, _: &Ray, _: f64, _: &[f64]) {}
    fn met(&mut self, surface: usize, before: &[f64], _: &[f64]) {
        if surface == self.surface {
            self.flux += before[0];
        }
    }
}

/// A point light through a ball of glass: the mean irradiance of the floor is what packets of flux bring there, counted.
#[test]
fn a_point_light_through_a_ball_is_what_lands() {
    let text = r#"
[render]
solver = "bidirectional"
[[material]]
name = "glass"
dielectric = { index = 1.5 }
[[shape]]
name = "floor"
rectangle = { corner = [-0.5, -0.5, 0], edges = [[1, 0, 0], [0, 1, 0]] }
[[shape]]
material = "glass"
sphere = { centre = [0.1, 0, 1], radius = "0.3 m" }
[[light]]
spectrum = "line:555nm"
point = { at = [0, 0, 2], flux = "1000 lm" }
[[sensor]]
name = "floor"
illuminance = { on = "floor" }
"#;
    let built = built(text);
    let got = readings(&built, &built.settings, 4096)[0].bands()[0];
    let counted: Vec<f64> = (0..32)
        .map(|stream| {
            let mut tracer = LightTracer::new(&built.scene, &built.settings.heroes);
            let mut landed = Landed { surface: 0, flux: 0.0 };
            for index in 0..4096 {
                tracer.packet(&mut Sampler::new(77, stream, index), &mut landed);
            }
            landed.flux / 4096.0
        })
        .collect();
    let (mean, error) = figure(&counted);
    assert!(got.standard_error < 0.02 * mean, "{got:?}");
    let allowed = 4.5 * error.hypot(got.standard_error);
    assert!((got.value - mean).abs() < allowed, "{got:?}, {mean} ± {error}");
    // Paths alone find what passes beside the ball: a point is not met through glass.
    let alone = readings(&built, &Settings { packets: false, ..built.settings.clone() }, 512)[0].bands()[0];
    assert!(alone.value < 0.5 * mean, "{alone:?}");
}

/// Meters of every kind, in every kind of light, beside every kind of surface.
#[test]
fn meters_read_what_paths_alone_read() {
    let sensors = r#"
[[sensor]]
name = "floor"
illuminance = { on = "floor" }
[[sensor]]
name = "grid"
illuminance = { grid = { corner = [-1, -1, 0.02], edges = [[2, 0, 0], [0, 2, 0]], points = [2, 1] } }
[[sensor]]
name = "point"
illuminance = { at = [0.7, 0.4, 0.01] }
[[sensor]]
name = "spot"
luminance = { at = [0.1, -2, 1.3], look_at = [0.3, 0.2, 0.2], acceptance = "30 deg" }
[[sensor]]
name = "upright"
cylindrical = { at = [0.8, -0.7, 0.8] }
[[sensor]]
name = "half"
hemispherical = { at = [-0.8, -0.7, 0.8] }
[[sensor]]
name = "all"
spherical = { at = [-0.8, 0.9, 1.2] }
"#;
    let (mut squares, mut count) = (0.0, 0.0);
    for (name, scene) in scenes() {
        let text = format!("[render]\nsolver = \"bidirectional\"\nwavelength_step_nm = 40\n{scene}\n{sensors}");
        let built = built(&text);
        let mut settings = built.settings.clone();
        let both = readings(&built, &settings, 256);
        settings.packets = false;
        settings.seed += 1;
        let paths = readings(&built, &settings, 256);
        for (meter, (a, b)) in both.iter().zip(&paths).enumerate() {
            let [a, b] = [a, b].map(|e| e.figure(&built.quantities.luminous));
            let z = (a.value - b.value) / a.standard_error.hypot(b.standard_error);
            assert!(z.abs() < 4.5, "{name}, meter {meter}: {a:?} {b:?}");
            squares += z * z;
            count += 1.0;
        }
    }
    // Student's t of about 60 degrees of freedom: a mean square of 1.03, of which n scatter by √(2.1/n).
    let mean: f64 = squares / count;
    assert!(mean < 1.03 + 4.0 * (2.1_f64 / count).sqrt(), "{mean} is the mean of z² of {count} readings");
}

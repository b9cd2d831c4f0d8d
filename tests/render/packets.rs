//! Light tracing against closed forms: where packets go, and how much flux they carry.

use std::f64::consts::PI;

use glam::DVec3;
use photopic::render::integrator::light::{LightTracer, Visitor};
use photopic::render::ray::Ray;
use photopic::render::sampler::Sampler;
use photopic::render::scene::Scene;
use photopic::render::shape::disk::Disk;
use photopic::render::shape::rectangle::Rectangle;
use photopic::render::shape::sphere::Sphere;

use crate::analytic::{part, scene};

/// Sums per packet of what a visitor saw.
#[derive(Debug, Default, Clone, Copy)]
struct Seen {
    emitted: f64,
    arrived: f64,
    kept: f64,
    escaped: f64,
    /// Of what escaped: within 30° of −z.
    downwards: f64,
}

impl Visitor for Seen {
    fn emitted(&mut self, flux: &[f64]) {
        self.emitted += flux[0];
    }

    fn flight(&mut self, ray: &Ray, length: f64, flux: &[f64]) {
        if length.is_infinite() {
            self.escaped += flux[0];
            if -ray.direction.z > 30_f64.to_radians().cos() {
                self.downwards += flux[0];
            }
        }
    }

    fn met(&mut self, _surface: usize, before: &[f64], after: &[f64]) {
        self.arrived += before[0];
        self.kept += after[0];
    }
}

/// Mean and standard error over packets of a figure.
fn trace(scene: &Scene, seed: u64, figure: impl Fn(&Seen) -> f64) -> (f64, f64) {
    let heroes = [1.0];
    let mut tracer = LightTracer::new(scene, &heroes);
    let (mut sum, mut squares, count) = (0.0, 0.0, 40_000);
    for stream in 0..count {
        // A stream of its own for each: independent packets, whose scatter gives the error of the mean.
        let mut seen = Seen::default();
        tracer.packet(&mut Sampler::new(seed, stream, 0), &mut seen);
        let value = figure(&seen);
        sum += value;
        squares += value * value;
    }
    #[expect(clippy::cast_precision_loss, reason = "40 000")]
    let n = count as f64;
    let mean = sum / n;
    // Of a constant the difference is rounding, of either sign.
    (mean, ((squares / n - mean * mean).max(0.0) / n).sqrt())
}

fn agrees((mean, error): (f64, f64), expected: f64, name: &str) {
    assert!((mean - expected).abs() <= 4.0 * error + 1e-12 * expected, "{name}: {mean} ± {error}, expected {expected}");
}

/// A diffuse square of 1 m² and 100 cd/m² emits π A L (`../shared/render/analytic.json`, lambert_flux_1m2_100nit: 314.159 265 358 979 3),
/// and sin²30° = 1/4 of it within 30° of its normal.
#[test]
fn a_bare_square_emits_its_flux_by_the_cosine() {
    let square = Rectangle::new(DVec3::ZERO, DVec3::Y, DVec3::X).expect("a square");
    let scene = scene(vec![part(square, 0.3, Some(100.0))], Vec::new());
    agrees(trace(&scene, 1, |s| s.emitted), 314.159_265_358_979_3, "emitted");
    agrees(trace(&scene, 1, |s| s.escaped), 314.159_265_358_979_3, "escaped");
    agrees(trace(&scene, 1, |s| s.downwards), 314.159_265_358_979_3 / 4.0, "within 30°");
}

/// In a hollow sphere of reflectance ρ with a small disk of flux Φ in it, Φ/(1 − ρ) arrives at the wall, ρ of it goes on, and nothing
/// escapes; the disk, black and small, takes a share of its area, 2 π r² of the 4 π R² + 2 π r² that diffuse light meets.
#[test]
fn a_hollow_sphere_multiplies_the_flux() {
    let (rho, radius) = (0.8, 0.01);
    let wall = Sphere::new(DVec3::ZERO, 1.0).expect("a sphere");
    let disk = Disk::new(DVec3::new(0.0, 0.0, 0.2), DVec3::Z, radius).expect("a disk");
    let flux = PI * PI * radius * radius * 1e4;
    let scene = scene(vec![part(wall, rho, None), part(disk, 0.0, Some(1e4))], Vec::new());
    // The share taken by the disk at each bounce, r²/2, changes the sum by ρ r²/2/(1 − ρ), below 3e-4.
    let (mean, error) = trace(&scene, 2, |s| s.arrived);
    let expected = flux / (1.0 - rho);
    assert!((mean - expected).abs() <= 4.0 * error + 3e-4 * expected, "{mean} ± {error}, expected {expected}");
    agrees(trace(&scene, 2, |s| s.escaped), 0.0, "escaped");
    let (kept, error) = trace(&scene, 2, |s| s.kept);
    assert!((kept - rho * expected).abs() <= 4.0 * error + 3e-4 * expected, "{kept} ± {error}");
}

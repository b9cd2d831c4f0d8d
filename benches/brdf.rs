//! BRDF evaluations, samples and albedos on one core: `cargo bench --bench brdf`. Every benchmark asserts its result.

use std::hint::black_box;

use divan::counter::ItemsCount;
use divan::{Bencher, main as run};
use glam::DVec3;
use photopic::brdf::Brdf;
use photopic::brdf::description::{Bands, Material};
use photopic::geometry::direction::from_degrees;
use photopic::math::random::Stream;
use photopic::math::sampling::cosine_power;

fn main() {
    run();
}

/// Pairs of random directions per pass.
const PAIRS: usize = 1 << 14;

const MODELS: [&str; 8] = [
    "lambert(reflectance=0.5)",
    "ggx(alpha=0.2, reflectance=1)",
    "ggx(alpha=0.2, eta=1.5)",
    "ggx(alpha=0.2, medium=Au)",
    "beckmann(alpha=0.2, eta=1.5)",
    "ward(ks=1, alpha=0.2)",
    "oren-nayar(reflectance=0.5, sigma_deg=20)",
    "abc(kd=0.02, a=50, b=10000, c=0.8, eta=2.2)",
];

fn material(text: &str, wavelengths_nm: &[f64]) -> Box<dyn Brdf> {
    let material: Material = text.parse().expect("a description");
    material.prepare(Bands::Wavelengths(wavelengths_nm)).expect("a material")
}

/// Pairs of directions, uniform over the hemisphere.
fn pairs() -> Vec<(DVec3, DVec3)> {
    let mut stream = Stream::new(1, 0);
    (0..PAIRS).map(|_| (cosine_power(stream.uniforms(), 0.0), cosine_power(stream.uniforms(), 0.0))).collect()
}

#[divan::bench(args = MODELS)]
fn evaluate_one_wavelength(bencher: Bencher<'_, '_>, text: &str) {
    let (brdf, pairs) = (material(text, &[555.0]), pairs());
    bencher.counter(ItemsCount::new(PAIRS)).bench_local(|| {
        let (mut sum, mut value) = (0.0, [0.0]);
        for (i, o) in black_box(&pairs) {
            brdf.evaluate(*i, *o, &mut value);
            sum += value[0];
        }
        assert!(sum > 0.0, "light is reflected");
        sum
    });
}

#[divan::bench(args = ["ggx(alpha=0.2, eta=1.5)", "ggx(alpha=0.2, medium=Au)"])]
fn evaluate_31_wavelengths(bencher: Bencher<'_, '_>, text: &str) {
    let nm: Vec<f64> = (0..31).map(|i| 400.0 + 10.0 * f64::from(i)).collect();
    let (brdf, pairs) = (material(text, &nm), pairs());
    bencher.counter(ItemsCount::new(PAIRS)).bench_local(|| {
        let (mut sum, mut values) = (0.0, [0.0; 31]);
        for (i, o) in black_box(&pairs) {
            brdf.evaluate(*i, *o, &mut values);
            sum += values[15];
        }
        assert!(sum > 0.0, "light is reflected");
        sum
    });
}

#[divan::bench(args = MODELS)]
fn sample(bencher: Bencher<'_, '_>, text: &str) {
    let (brdf, pairs) = (material(text, &[555.0]), pairs());
    let mut stream = Stream::new(2, 0);
    let numbers: Vec<[f64; 3]> = (0..PAIRS).map(|_| stream.uniforms()).collect();
    bencher.counter(ItemsCount::new(PAIRS)).bench_local(|| {
        let (mut sum, mut weight) = (0.0, [0.0]);
        for ((_, o), u) in black_box(&pairs).iter().zip(&numbers) {
            if brdf.sample(*o, *u, &mut weight).is_some() {
                sum += weight[0];
            }
        }
        assert!(sum > 0.0, "light is reflected");
        sum
    });
}

#[divan::bench(args = ["ggx(alpha=1e-6, reflectance=1)", "ggx(alpha=0.2, reflectance=1)", "beckmann(alpha=0.2, eta=1.5)"])]
fn albedo_at_60_degrees(bencher: Bencher<'_, '_>, text: &str) {
    let brdf = material(text, &[555.0]);
    bencher.bench_local(|| {
        let mut rho = [0.0];
        let error = brdf.albedo(black_box(from_degrees(60.0, 0.0)), &mut rho);
        assert!(rho[0] <= 1.0 && error < 1e-5, "{} ± {error}", rho[0]);
        rho
    });
}

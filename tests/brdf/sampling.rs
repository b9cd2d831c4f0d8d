//! One harness for all samplers: directions are distributed as their density says (χ²), the density and the misses sum to one,
//! and the mean weight is the reflectance.

use std::f64::consts::TAU;

use photopic::brdf::Brdf;
use photopic::brdf::reflectance::{Beam, between};
use photopic::geometry::direction::{from_degrees, phi};
use photopic::math::cubature::{Tolerance, rectangle};
use photopic::math::random::Stream;

use crate::{SOUND, material};

const SAMPLES: usize = 1_000_000;
/// Cells in cosθ and in φ.
const CELLS: [usize; 2] = [16, 24];

/// The standard normal deviate of a χ² of so many degrees of freedom (Wilson & Hilferty 1931).
fn deviate(chi2: f64, freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom);
    ((chi2 / freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
}

/// Checks the sampler for one outgoing direction by so many draws.
pub(crate) fn check(text: &str, brdf: &dyn Brdf, theta_o_deg: f64, samples: usize, seed: u64) {
    let outgoing = from_degrees(theta_o_deg, 33.0);
    let mut counts = vec![0_usize; CELLS[0] * CELLS[1]];
    let (mut missed, mut sum, mut squares) = (0_usize, 0.0, 0.0);
    let mut weights = vec![0.0; brdf.bands()];
    let mut stream = Stream::new(2026, seed);
    for _ in 0..samples {
        match brdf.sample(outgoing, stream.uniforms(), &mut weights) {
            None => missed += 1,
            Some(drawn) => {
                assert!(drawn.incident.z > 0.0 && (drawn.incident.length() - 1.0).abs() < 1e-9, "{text}: {drawn:?}");
                let cell = |x: f64, n: usize| ((x * n as f64) as usize).min(n - 1);
                counts[cell(drawn.incident.z, CELLS[0]) * CELLS[1] + cell(phi(drawn.incident) / TAU, CELLS[1])] += 1;
                sum += weights[0];
                squares += weights[0] * weights[0];
            }
        }
    }
    // Expected counts: the density over each cell, dω = dcosθ dφ.
    let tolerance = Tolerance { absolute: 1e-7, relative: 1e-4, evaluations: 100_000 };
    let mut expected: Vec<(f64, f64)> = Vec::new();
    let mut total = 0.0;
    for (i, count) in counts.iter().enumerate() {
        let place = [i / CELLS[1], i % CELLS[1]];
        let low = [place[0] as f64 / CELLS[0] as f64, place[1] as f64 * TAU / CELLS[1] as f64];
        let high = [low[0] + 1.0 / CELLS[0] as f64, low[1] + TAU / CELLS[1] as f64];
        let mut out = [0.0];
        let density = |[z, angle]: [f64; 2], v: &mut [f64]| {
            let sin = (1.0 - z * z).max(0.0).sqrt();
            v[0] = brdf.pdf(outgoing, glam::DVec3::new(sin * angle.cos(), sin * angle.sin(), z));
        };
        rectangle(density, low, high, tolerance, &mut out);
        total += out[0];
        expected.push((out[0] * samples as f64, *count as f64));
    }
    assert!(total <= 1.0 + 1e-4, "{text} at {theta_o_deg}°: the density integrates to {total}");
    expected.push(((1.0 - total).max(0.0) * samples as f64, missed as f64));
    // Cells of few counts are taken together, as the χ² distribution asks for.
    expected.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut pool, mut chi2, mut freedom) = ((0.0, 0.0), 0.0, -1.0);
    for (wanted, found) in expected {
        pool = (pool.0 + wanted, pool.1 + found);
        if pool.0 >= 10.0 {
            chi2 += (pool.1 - pool.0) * (pool.1 - pool.0) / pool.0;
            freedom += 1.0;
            pool = (0.0, 0.0);
        }
    }
    // 4.5 standard deviations: 3e-6 for one, 3e-4 for all the ninety tests of a run.
    let z = if freedom > 0.0 { deviate(chi2, freedom) } else { 0.0 };
    assert!(z < 4.5, "{text} at {theta_o_deg}°: χ² {chi2} of {freedom}: {z} standard deviations");
    // Mean weight: ∫ f cosθ_i dω_i, the reflectance factor of light from everywhere.
    let all = between(brdf, Beam::HEMISPHERICAL, Beam::Directional(outgoing)).expect("no Dirac lobe");
    let (factor, error) = (all.factor[0], all.error * std::f64::consts::PI / outgoing.z);
    let n = samples as f64;
    let mean = sum / n;
    let standard = ((squares / n - mean * mean).max(0.0) / n).sqrt();
    assert!(
        (mean - factor).abs() <= 4.5 * standard + error + 1e-9,
        "{text} at {theta_o_deg}°: {mean} ± {standard}, {factor} ± {error}"
    );
}

#[test]
fn every_sampler_draws_what_its_density_says() {
    use rayon::prelude::*;
    // alum-bronze as Bagher et al. fitted it, in three channels that differ.
    let sgd = "sgd(rho_d=[0.0478786, 0.0313514, 0.0200638], rho_s=[0.0364976, 0.664975, 0.268836], alpha=[0.014832, 0.0300126, 0.0490339], \
        p=[0.459076, 0.450056, 0.529272], kappa=[46.3841, 24.5961, 14.8261], f0=[6.05524, 0.235756, 0.580647], f1=[5.05524, 0.182842, 0.476088], \
        lambda=[2.60672, 2.97371, 2.7827], gamma=[1.12717e-07, 1.06401e-07, 5.27952e-08], k=[47.783, 36.2767, 31.6066], \
        theta0=[0.205635, 0.066289, -0.0661091])";
    let jobs: Vec<(&str, f64)> =
        SOUND.iter().chain([&sgd]).flat_map(|text| [0.0, 40.0, 80.0].map(|theta| (*text, theta))).collect();
    jobs.par_iter()
        .enumerate()
        .for_each(|(i, (text, theta))| check(text, material(text).as_ref(), *theta, SAMPLES, i as u64));
}

#[test]
fn a_wrong_density_would_be_found() {
    /// Draws like one roughness and says another.
    #[derive(Debug)]
    struct Liar(Box<dyn Brdf>, Box<dyn Brdf>);
    impl Brdf for Liar {
        fn bands(&self) -> usize {
            1
        }
        fn is_isotropic(&self) -> bool {
            true
        }
        fn evaluate(&self, i: glam::DVec3, o: glam::DVec3, v: &mut [f64]) {
            self.0.evaluate(i, o, v);
        }
        fn sample(&self, o: glam::DVec3, u: [f64; 3], w: &mut [f64]) -> Option<photopic::brdf::Sampled> {
            self.0.sample(o, u, w)
        }
        fn pdf(&self, o: glam::DVec3, i: glam::DVec3) -> f64 {
            self.1.pdf(o, i)
        }
    }
    let liar = Liar(material("ggx(alpha=0.3, reflectance=1)"), material("ggx(alpha=0.305, reflectance=1)"));
    let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| check("liar", &liar, 40.0, SAMPLES, 0)));
    assert!(found.is_err());
}

#[test]
fn dirac_lobes_are_drawn_with_their_share() {
    let brdf = material("0.25*mirror(reflectance=0.8) + 0.75*lambert(reflectance=0.4)");
    let outgoing = from_degrees(30.0, 0.0);
    let (mut stream, mut weights) = (Stream::new(1, 1), [0.0]);
    let (mut mirrored, mut sum) = (0, 0.0);
    let n = 200_000;
    for _ in 0..n {
        let drawn = brdf.sample(outgoing, stream.uniforms(), &mut weights).expect("above the horizon");
        if drawn.delta {
            mirrored += 1;
            assert!((drawn.incident - from_degrees(30.0, 180.0)).length() < 1e-12);
            // w ρ / probability.
            assert!((weights[0] - 0.8).abs() < 1e-12 && drawn.pdf == 0.25);
        }
        sum += weights[0];
    }
    // Binomial and mean within five standard deviations.
    let share = f64::from(mirrored) / f64::from(n);
    assert!((share - 0.25).abs() < 5.0 * (0.25 * 0.75 / f64::from(n)).sqrt());
    let mean = sum / f64::from(n);
    assert!((mean - (0.25 * 0.8 + 0.75 * 0.4)).abs() < 5.0 * (0.03 / f64::from(n)).sqrt(), "{mean}");
}

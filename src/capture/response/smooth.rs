//! A response from many noisy photographs whose noise is known: least squares in ln g, as smooth as the photographs allow.
//!
//! ```text
//! minimise Σ w ρ(ln g(z_ij) − ln E_i − ln t_j) + λ ∫ (d² ln g/du²)² du     u = ln((z + 1)/(256 − z))     1/w = (d ln g/dz σ_z)²
//! ```
//!
//! Exposure times in one ratio leave a response open to a ripple of that period in ln E, which costs the residuals hardly anything. Toe and
//! shoulder of a camera are nearly straight in u, so that a large λ does no harm there: of half-decades, the largest λ is taken whose robust χ
//! is within 1 % of the least. ρ is Cauchy's. The covariance is χ² A⁻¹, A the normal equations with the penalty, which is what a prior of that
//! strength leaves.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::debevec::eliminate;
use super::samples::nothing_shared;
use super::{Curve, Exposures, GAUGE, LEVELS};
use crate::capture::Error;
use crate::capture::noise::Noise;

/// λ: from the least, in half-decades.
const LEAST_LAMBDA: f64 = 100.0;
/// How many.
const LAMBDAS: i32 = 9;
/// χ over the least up to which a larger λ is taken.
const AS_GOOD: f64 = 1.01;
/// Rounds of reweighting.
const ROUNDS: usize = 8;
/// Cauchy's scale in standard deviations.
const CAUCHY: f64 = 2.385;
/// The highest code that is used: beyond, codes are clipped.
const HIGHEST: usize = 252;
/// Weight that holds the gauge.
const HOLD: f64 = 1e8;

/// ln g of each channel with its covariance, from codes not below `dark`; never decreasing.
///
/// # Errors
/// [`Error::TooFew`] without two exposure times, [`Error::NothingShared`] where no pixel has two exposures within the range,
/// [`Error::Singular`].
pub fn smooth(stacks: &[Exposures], noise: &Noise, dark: f64) -> Result<Vec<Curve>, Error> {
    stacks.iter().try_for_each(Exposures::check)?;
    let channels = stacks.first().map_or(0, |s| s.channels);
    (0..channels).map(|c| solve(stacks, noise, dark, c)).collect()
}

/// A pixel's codes within the range, with their times.
struct Pixel {
    codes: Vec<usize>,
    ln_t: Vec<f64>,
}

/// A curve under one λ.
struct Fitted {
    ln_g: Vec<f64>,
    chi: f64,
    normal: DMatrix<f64>,
}

fn solve(stacks: &[Exposures], noise: &Noise, dark: f64, channel: usize) -> Result<Curve, Error> {
    let mut pixels = Vec::new();
    for stack in stacks {
        for n in 0..stack.pixels() {
            let all = stack.times_s.iter().enumerate().map(|(j, t)| (stack.code(j, n, channel), t.ln()));
            let (codes, ln_t): (Vec<usize>, Vec<f64>) = all.filter(|(z, _)| *z as f64 >= dark && *z <= HIGHEST).unzip();
            if codes.len() > 1 {
                pixels.push(Pixel { codes, ln_t });
            }
        }
    }
    if pixels.is_empty() {
        return Err(nothing_shared(stacks, channel));
    }
    let sigma: Vec<f64> = (0..LEVELS).map(|z| noise.at(channel, z as f64)).collect();
    let penalty = roughness();
    let singular = Error::Singular { what: "response" };
    let lambda = |k: i32| LEAST_LAMBDA * 10_f64.powf(0.5 * f64::from(k));
    let fitted: Option<Vec<Fitted>> = (0..LAMBDAS).map(|k| fit(&pixels, &sigma, &(&penalty * lambda(k)))).collect();
    let fitted = fitted.ok_or_else(|| singular.clone())?;
    let least = fitted.iter().map(|f| f.chi).fold(f64::INFINITY, f64::min);
    let best = fitted.into_iter().rev().find(|f| f.chi <= AS_GOOD * least).ok_or_else(|| singular.clone())?;
    let inverse = Cholesky::new(best.normal).ok_or(singular)?.inverse();
    let mut covariance = inverse * best.chi.max(1.0).powi(2);
    covariance.row_mut(GAUGE).fill(0.0);
    covariance.column_mut(GAUGE).fill(0.0);
    let mut ln_g = best.ln_g;
    for z in 1..LEVELS {
        ln_g[z] = ln_g[z].max(ln_g[z - 1]);
    }
    Ok(Curve { ln_g, covariance: Some(covariance) })
}

fn fit(pixels: &[Pixel], sigma: &[f64], penalty: &DMatrix<f64>) -> Option<Fitted> {
    let mut ln_g: Vec<f64> = (0..LEVELS).map(|z| ((z as f64 + 0.5) / (GAUGE as f64 + 0.5)).ln()).collect();
    let (mut chi, mut last) = (0.0, None);
    for round in 0..ROUNDS {
        let weight: Vec<f64> = (0..LEVELS)
            .map(|z| {
                let (below, above) = (z.saturating_sub(1), (z + 1).min(LEVELS - 1));
                let slope = (ln_g[above] - ln_g[below]) / (above - below) as f64;
                (slope.max(1e-3) * sigma[z]).max(1e-3).powi(-2)
            })
            .collect();
        let (mut normal, mut right) = (penalty.clone(), DVector::zeros(LEVELS));
        let (mut square, mut freedom) = (0.0, 0.0);
        let mut weights = Vec::new();
        for p in pixels {
            weights.clear();
            weights.extend(p.codes.iter().map(|z| weight[*z]));
            let each = || p.codes.iter().zip(&p.ln_t).map(|(z, t)| ln_g[*z] - t);
            let total: f64 = weights.iter().sum();
            let mean = each().zip(&weights).map(|(e, w)| w * e).sum::<f64>() / total;
            for (e, w) in each().zip(&mut weights) {
                let r2 = (e - mean).powi(2) * *w;
                if round > 0 {
                    *w /= 1.0 + r2 / CAUCHY.powi(2);
                }
                square += CAUCHY.powi(2) * (r2 / CAUCHY.powi(2)).ln_1p();
            }
            freedom += p.codes.len() as f64 - 1.0;
            eliminate(&mut normal, &mut right, &p.codes, &weights, &p.ln_t);
        }
        chi = (square / freedom).sqrt();
        normal[(GAUGE, GAUGE)] += HOLD;
        let solved = Cholesky::new(normal.clone())?.solve(&right);
        ln_g = solved.iter().map(|g| g - solved[GAUGE]).collect();
        last = Some(normal);
    }
    last.map(|normal| Fitted { ln_g, chi, normal })
}

/// ∫ (d² ln g/du²)² du by second differences over the uneven places of codes.
fn roughness() -> DMatrix<f64> {
    let u: Vec<f64> = (0..LEVELS).map(|z| ((z as f64 + 1.0) / (LEVELS - z) as f64).ln()).collect();
    let mut out = DMatrix::zeros(LEVELS, LEVELS);
    for k in 1..LEVELS - 1 {
        let (before, after) = (u[k] - u[k - 1], u[k + 1] - u[k]);
        let w = 2.0 / (before + after);
        let row = [1.0 / before, -1.0 / before - 1.0 / after, 1.0 / after];
        for (a, i) in row.iter().zip(k - 1..) {
            for (b, j) in row.iter().zip(k - 1..) {
                out[(i, j)] += w * a * b;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::Photo;
    use crate::capture::photo::Codes;
    use crate::capture::response::Sampling;
    use crate::math::random::Stream;

    #[test]
    fn times_in_one_ratio_leave_no_ripple() {
        // A shoulder: E t = (z/256)^2.2/(1 − z/256)^0.5, times a factor of 4 apart, noise of two codes.
        let exposure = |z: f64| 2.2 * (z / 256.0).ln() - 0.5 * (1.0 - z / 256.0).ln();
        let code = |ln: f64| {
            let (mut low, mut high) = (1e-6, 255.999);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                *(if exposure(middle) < ln { &mut low } else { &mut high }) = middle;
            }
            low
        };
        let mut stack = Exposures::new("ramp");
        for (j, time_s) in [0.0625, 0.25, 1.0, 4.0].into_iter().enumerate() {
            let sample = |i: usize| {
                let mut random = Stream::new(3, (10_000 * j + i) as u64);
                let normal = (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0;
                let z = code(-6.0 + 7.0 * i as f64 / 4096.0 + f64::ln(time_s)) + 2.0 * normal;
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
                let z = z.round().clamp(0.0, 255.0) as u8;
                z
            };
            let photo =
                Photo { width: 64, height: 64, channels: 1, codes: Codes::Eight((0..4096).map(sample).collect()) };
            stack.add(&format!("{time_s}"), time_s, &photo, Sampling { pixels: 4096 }).unwrap();
        }
        let found = &smooth(&[stack], &Noise::constant(1, 2.0), 10.0).unwrap()[0];
        assert_eq!(found.decreasing_steps(), 0);
        for z in (30..=230).step_by(10) {
            let off = found.ln_g[z] - (exposure(z as f64) - exposure(128.0));
            // Noise of 2 codes is 3 % at the middle; the curve is better than a third of it everywhere.
            assert!(off.abs() < 0.01 + 0.3 * 4.4 / z as f64, "{z}: {off} ± {}", found.standard_error(z as f64));
        }
    }
}

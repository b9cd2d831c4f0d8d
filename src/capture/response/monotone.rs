//! Our own response: robust least squares under the one thing that is known of every camera, that more light gives no lower code.
//!
//! ```text
//! minimise Σ w(z) ρ(ln g(z_ij) − ln E_i − ln t_j) + σ²/τ² ∫ (ds/dx)² dx      s = d ln g / dx,  x = ln(z + 1),  s ≥ 0
//! ```
//!
//! s is the slope in logarithms, 1 for a linear camera and constant for a power law: the penalty pulls towards these, not towards a
//! straight line in z. Its weight is the ratio of the noise σ, found from the residuals, to the change τ of s over a factor of e that
//! cameras show. ρ is Cauchy's: a pixel that moved counts less the further off it is. w vanishes at both ends of the range.

use nalgebra::{DMatrix, DVector};

use super::debevec::eliminate;
use super::samples::nothing_shared;
use super::{Curve, Exposures, GAUGE, LEVELS, weight};
use crate::capture::Error;
use crate::math::least_squares::{Limits, Linearised, Problem, invert, minimise};

/// Change of the slope in logarithms over a factor of e in code: toe and shoulder of a camera.
const TAU: f64 = 3.0;
/// Cauchy's scale in standard deviations: 95 % efficient for Gaussian noise.
const CAUCHY: f64 = 2.385;
/// Rounds of reweighting.
const ROUNDS: usize = 10;
/// Least σ: a residual of ln g below this is rounding of codes.
const LEAST_SIGMA: f64 = 1e-4;
/// Steps between codes.
const STEPS: usize = LEVELS - 1;

/// ln g of each channel with its covariance; never decreasing.
///
/// # Errors
/// [`Error::TooFew`] without two exposure times, [`Error::NothingShared`] where no pixel has two exposures within the range,
/// [`Error::Singular`].
pub fn monotone(stacks: &[Exposures]) -> Result<Vec<Curve>, Error> {
    stacks.iter().try_for_each(Exposures::check)?;
    let channels = stacks.first().map_or(0, |s| s.channels);
    (0..channels).map(|c| solve(stacks, c)).collect()
}

/// A pixel with two exposures or more within the range.
struct Pixel {
    codes: Vec<usize>,
    ln_t: Vec<f64>,
    weights: Vec<f64>,
}

impl Pixel {
    /// Residuals under a curve, about the radiance that `weights` give.
    fn residuals<'a>(&'a self, ln_g: &'a [f64], weights: &[f64]) -> impl Iterator<Item = f64> + 'a {
        let each = || self.codes.iter().zip(&self.ln_t).map(|(z, t)| ln_g[*z] - t);
        let total: f64 = weights.iter().sum();
        let mean = each().zip(weights).map(|(e, w)| w * e).sum::<f64>() / total;
        each().map(move |e| e - mean)
    }
}

fn pixels(stacks: &[Exposures], channel: usize) -> Vec<Pixel> {
    let mut out = Vec::new();
    for stack in stacks {
        for n in 0..stack.pixels() {
            let mut pixel = Pixel { codes: Vec::new(), ln_t: Vec::new(), weights: Vec::new() };
            for (j, t) in stack.times_s.iter().enumerate() {
                let z = stack.code(j, n, channel);
                let w = weight(z as f64);
                if w > 0.0 {
                    pixel.codes.push(z);
                    pixel.ln_t.push(t.ln());
                    pixel.weights.push(w);
                }
            }
            if pixel.codes.len() > 1 {
                out.push(pixel);
            }
        }
    }
    out
}

/// Σ over steps d of a quadratic form: dᵀ A d − 2 bᵀ d + c.
struct Quadratic {
    a: DMatrix<f64>,
    b: DVector<f64>,
    c: f64,
}

impl Problem for Quadratic {
    fn cost(&self, x: &[f64]) -> Option<f64> {
        let x = DVector::from_column_slice(x);
        Some(x.dot(&(&self.a * &x)) - 2.0 * self.b.dot(&x) + self.c)
    }

    fn linearise(&self, x: &[f64]) -> Option<Linearised> {
        let cost = self.cost(x)?;
        let gradient = &self.a * DVector::from_column_slice(x) - &self.b;
        Some(Linearised { cost, normal: self.a.clone(), gradient })
    }
}

fn solve(stacks: &[Exposures], channel: usize) -> Result<Curve, Error> {
    let pixels = pixels(stacks, channel);
    if pixels.is_empty() {
        return Err(nothing_shared(stacks, channel));
    }
    let x: Vec<f64> = (0..LEVELS).map(|z| (z as f64 + 1.0).ln()).collect();
    let h: Vec<f64> = x.windows(2).map(|x| x[1] - x[0]).collect();
    let mut steps = h.clone();
    let mut ln_g = curve(&steps);
    let mut weights: Vec<Vec<f64>> = pixels.iter().map(|p| p.weights.clone()).collect();
    let mut sigma = scale(&pixels, &ln_g, &weights);
    let mut quadratic = None;
    for round in 0..ROUNDS {
        let (mut normal, mut right) = (DMatrix::zeros(LEVELS, LEVELS), DVector::zeros(LEVELS));
        let mut square = 0.0;
        for (pixel, w) in pixels.iter().zip(&weights) {
            eliminate(&mut normal, &mut right, &pixel.codes, w, &pixel.ln_t);
            let total: f64 = w.iter().sum();
            let mean = w.iter().zip(&pixel.ln_t).map(|(w, t)| w * t).sum::<f64>() / total;
            square += w.iter().zip(&pixel.ln_t).map(|(w, t)| w * (t - mean).powi(2)).sum::<f64>();
        }
        let problem = Quadratic { a: in_steps(&normal) + penalty(&h, sigma), b: sums(&right), c: square };
        let limits = Limits { iterations: 100, step: 1e-9, gain: 1e-12 };
        let found = minimise(&problem, &steps, &[0.0; STEPS], &[f64::INFINITY; STEPS], &limits);
        steps = found.ok_or(Error::Singular { what: "response" })?.x;
        ln_g = curve(&steps);
        quadratic = Some(problem.a);
        if round + 1 == ROUNDS {
            break;
        }
        sigma = scale(&pixels, &ln_g, &weights);
        for (pixel, w) in pixels.iter().zip(&mut weights) {
            let residuals: Vec<f64> = pixel.residuals(&ln_g, w).collect();
            for (w, (r, base)) in w.iter_mut().zip(residuals.iter().zip(&pixel.weights)) {
                // Of a residual of its own weight: σ is that of a code in the middle of the range.
                *w = base / (1.0 + base * (r / (CAUCHY * sigma)).powi(2));
            }
        }
    }
    let covariance = quadratic.map(|a| covariance(&a, &steps, sigma));
    Ok(Curve { ln_g, covariance })
}

/// ln g from its steps, 0 at the gauge.
fn curve(steps: &[f64]) -> Vec<f64> {
    let mut ln_g = vec![0.0; LEVELS];
    for k in 0..STEPS {
        ln_g[k + 1] = ln_g[k] + steps[k];
    }
    let gauge = ln_g[GAUGE];
    ln_g.iter().map(|l| l - gauge).collect()
}

/// Lᵀ v, where g = L d: what the steps get of what the codes get.
fn sums(v: &DVector<f64>) -> DVector<f64> {
    let mut out = DVector::zeros(STEPS);
    let mut above = 0.0;
    for k in (GAUGE..STEPS).rev() {
        above += v[k + 1];
        out[k] = above;
    }
    let mut below = 0.0;
    for k in 0..GAUGE {
        below += v[k];
        out[k] = -below;
    }
    out
}

/// Lᵀ N L.
fn in_steps(normal: &DMatrix<f64>) -> DMatrix<f64> {
    let mut half = DMatrix::zeros(STEPS, LEVELS);
    for c in 0..LEVELS {
        half.set_column(c, &sums(&normal.column(c).into_owned()));
    }
    let mut out = DMatrix::zeros(STEPS, STEPS);
    for r in 0..STEPS {
        out.set_column(r, &sums(&half.row(r).transpose()));
    }
    out
}

/// σ²/τ² ∫ (ds/dx)² dx in the steps.
fn penalty(h: &[f64], sigma: f64) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(STEPS, STEPS);
    for k in 1..STEPS {
        let between = 0.5 * (h[k - 1] + h[k]);
        let w = (sigma / TAU).powi(2) / between;
        let (a, b) = (1.0 / h[k - 1], 1.0 / h[k]);
        out[(k - 1, k - 1)] += w * a * a;
        out[(k, k)] += w * b * b;
        out[(k - 1, k)] -= w * a * b;
        out[(k, k - 1)] -= w * a * b;
    }
    out
}

/// Standard deviation of a code in the middle of the range, in ln g: 1.4826 times the median of √w |r|, raised for the radiance that
/// each pixel spends.
fn scale(pixels: &[Pixel], ln_g: &[f64], weights: &[Vec<f64>]) -> f64 {
    let mut all = Vec::new();
    for (pixel, w) in pixels.iter().zip(weights) {
        let n = pixel.codes.len() as f64;
        let spent = (n / (n - 1.0)).sqrt();
        all.extend(pixel.residuals(ln_g, w).zip(&pixel.weights).map(|(r, base)| spent * base.sqrt() * r.abs()));
    }
    let middle = all.len() / 2;
    let median = *all.select_nth_unstable_by(middle, f64::total_cmp).1;
    (1.4826 * median).max(LEAST_SIGMA)
}

/// σ² L A⁻¹ Lᵀ over the steps that are not at 0.
fn covariance(a: &DMatrix<f64>, steps: &[f64], sigma: f64) -> DMatrix<f64> {
    let free: Vec<usize> = (0..STEPS).filter(|k| steps[*k] > 0.0).collect();
    let inverse = invert(a, &free).matrix;
    let ladder = DMatrix::from_fn(LEVELS, free.len(), |z, f| match free[f] {
        k if k >= GAUGE && z > k => 1.0,
        k if k < GAUGE && z <= k => -1.0,
        _ => 0.0,
    });
    &ladder * inverse * ladder.transpose() * sigma.powi(2)
}

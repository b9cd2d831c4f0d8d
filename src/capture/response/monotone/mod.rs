//! Our own response: robust least squares in codes under the one thing that is known of every camera, that more light gives a higher
//! code.
//!
//! ```text
//! minimise Σ ρ((z_ij − f(ln E_i + ln t_j))/σ) + 1/τ² ∫ (d² ln s/dx²)² dx
//! f the inverse of ln g     s = d ln g / d ln z > 0     x = ln((z + 1)/(256 − z))
//! ```
//!
//! Errors are those of codes, and the curve is asked where a code should be, not where noise has put it: averages of ln g over
//! noisy codes would make it flatter. s is the slope in logarithms, 1 for a linear camera and constant for a power law: the penalty pulls
//! towards these. σ, the noise of a code in eight bins of codes, and τ, how much the slope of this camera varies, are found from the photographs, τ as the
//! evidence has it (D. J. C. MacKay, *Neural Computation* 4 (1992) 415). ρ is Cauchy's: a pixel that moved counts less the further off it
//! is. The lowest and the highest code that occur are
//! the ends of the range; a code there says only that the exposure is there or beyond: its term is −2 ln of the probability of that
//! (J. Tobin, *Econometrica* 26 (1958) 24), so that its weight vanishes with saturation, and no code is chosen by its own noise.
//!
//! The covariance is A⁻¹ (S + P) A⁻¹: A the curvature of what is minimised, P that of the penalty, S the sum over pixels of the outer
//! squares of their gradients. S asks nothing of how the noise depends on the code (P. J. Huber, *Robust Statistics*, 1981, section 6.6);
//! P is what the penalty may have bent, as large as the prior that it is takes it to be (G. Wahba, *J. R. Stat. Soc. B* 45 (1983) 133): such
//! intervals hold on the average over codes, less well at the one where a curve is most unlike a power law.

mod pixels;
mod shape;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use self::pixels::{Inverse, Noise, Pixel};
use self::shape::Shape;
use super::samples::nothing_shared;
use super::{Curve, Exposures, LEVELS, debevec};
use crate::capture::Error;
use crate::math::least_squares::{Limits, Linearised, Problem, invert, minimise};

/// λ of Debevec's curve, the first one.
const SMOOTH: f64 = 10.0;
/// Least, first and largest τ: standard deviation of the change of d ln s/dx over a unit of x, which is a factor of e in code. A camera is no
/// power law better than the least has it.
const TAU: (f64, f64, f64) = (0.1, 1.0, 5.0);
/// Bounds of ln s.
const STEEPEST: f64 = 7.0;
/// Most rounds in which σ and τ are found.
const ROUNDS: usize = 10;
/// Change of σ and τ, relative, below which they are.
const SETTLED: f64 = 0.05;
/// ln g of each channel with its covariance; always rising.
///
/// # Errors
/// [`Error::TooFew`] without two exposure times, [`Error::NothingShared`] where no pixel has two exposures within the range,
/// [`Error::Singular`].
pub fn monotone(stacks: &[Exposures]) -> Result<Vec<Curve>, Error> {
    stacks.iter().try_for_each(Exposures::check)?;
    let channels = stacks.first().map_or(0, |s| s.channels);
    (0..channels).into_par_iter().map(|c| solve(stacks, c)).collect()
}

/// The sum that is minimised, for given weights, σ and τ; radiances are eliminated.
struct Fit<'a> {
    shape: &'a Shape,
    pixels: &'a [Pixel],
    /// 1/τ² times the roughness.
    penalty: DMatrix<f64>,
}

/// The linearised sum and what its covariance takes.
struct Sums {
    cost: f64,
    /// Σ over pixels, in ln g at the codes.
    normal: DMatrix<f64>,
    gradient: DVector<f64>,
    /// Outer squares of the gradients of pixels.
    squares: DMatrix<f64>,
    /// Weights by ρ'/r over weights by ρ''.
    excess: f64,
}

impl Fit<'_> {
    fn sums(&self, ln_g: &[f64]) -> Sums {
        let zero = || DMatrix::zeros(LEVELS, LEVELS);
        let mut sums =
            Sums { cost: 0.0, normal: zero(), gradient: DVector::zeros(LEVELS), squares: zero(), excess: 1.0 };
        let inverse = Inverse(ln_g);
        let (mut secant, mut tangent) = (0.0, 0.0);
        // Of one pixel: a code beside a sample, weight of the sample, share of the code in it, its pull.
        let mut rows: Vec<(usize, f64, f64, f64)> = Vec::new();
        for pixel in self.pixels {
            rows.clear();
            let (ln_e, mut total) = (pixel.radiance(&inverse), 0.0);
            for term in pixel.terms(&inverse, ln_e) {
                sums.cost += term.loss;
                secant += term.weight;
                tangent += term.curvature;
                let weight = term.weight * (term.slope / term.sigma).powi(2);
                let pull = weight * term.residual * term.sigma / term.slope;
                let (k, share) = term.code;
                rows.extend([(k, weight, 1.0 - share, pull), (k + 1, weight, share, pull)]);
                total += weight;
            }
            for pair in rows.chunks_exact(2) {
                for (a, w, share, pull) in pair {
                    sums.gradient[*a] += share * pull;
                    pair.iter().for_each(|(b, _, other, _)| sums.normal[(*a, *b)] += w * share * other);
                }
            }
            for (a, w, share, pull) in &rows {
                for (b, v, other, drag) in &rows {
                    sums.normal[(*a, *b)] -= w * share * v * other / total;
                    sums.squares[(*a, *b)] += share * pull * other * drag;
                }
            }
        }
        if tangent > 0.0 {
            sums.excess = secant / tangent;
        }
        sums
    }

    /// Covariance of ln s; see the head of the module.
    fn covariance(&self, ln_s: &[f64]) -> DMatrix<f64> {
        let sums = self.sums(&self.shape.ln_g(ln_s));
        let derivative = self.shape.derivative(ln_s);
        let a = derivative.tr_mul(&(sums.normal / sums.excess)) * &derivative + &self.penalty;
        let s = derivative.tr_mul(&sums.squares) * &derivative + &self.penalty;
        let inverse = invert(&a, &(0..ln_s.len()).collect::<Vec<_>>()).matrix;
        &inverse * s * &inverse
    }
}

impl Problem for Fit<'_> {
    fn cost(&self, ln_s: &[f64]) -> Option<f64> {
        let ln_g = self.shape.ln_g(ln_s);
        let inverse = Inverse(&ln_g);
        let of = |pixel: &Pixel| {
            let ln_e = pixel.radiance(&inverse);
            pixel.terms(&inverse, ln_e).map(|t| t.loss).sum::<f64>()
        };
        let s = DVector::from_column_slice(ln_s);
        Some(self.pixels.iter().map(of).sum::<f64>() + s.dot(&(&self.penalty * &s)))
    }

    fn linearise(&self, ln_s: &[f64]) -> Option<Linearised> {
        let sums = self.sums(&self.shape.ln_g(ln_s));
        let derivative = self.shape.derivative(ln_s);
        let s = DVector::from_column_slice(ln_s);
        let bent = &self.penalty * &s;
        Some(Linearised {
            cost: sums.cost + s.dot(&bent),
            normal: derivative.tr_mul(&sums.normal) * &derivative + &self.penalty,
            gradient: derivative.tr_mul(&sums.gradient) + bent,
        })
    }
}

fn solve(stacks: &[Exposures], channel: usize) -> Result<Curve, Error> {
    let mut pixels = Pixel::all(stacks, channel);
    if pixels.is_empty() {
        return Err(nothing_shared(stacks, channel));
    }
    let shape = Shape::new();
    let roughness = shape.roughness();
    let limits = Limits { iterations: 40, step: 1e-4, gain: 1e-7 };
    let (low, high) = (vec![-STEEPEST; shape.len()], vec![STEEPEST; shape.len()]);
    let mut ln_s = shape.of(&debevec::solve(stacks, channel, SMOOTH)?.ln_g);
    let mut ln_g = shape.ln_g(&ln_s);
    pixels.iter_mut().for_each(|p| p.start(&ln_g));
    let mut noise = Noise::of(&pixels, &Inverse(&ln_g));
    noise.give(&mut pixels, &Inverse(&ln_g));
    let mut tau = TAU.1;
    for _ in 0..ROUNDS {
        let fit = Fit { shape: &shape, pixels: &pixels, penalty: &roughness / (tau * tau) };
        let found = minimise(&fit, &ln_s, &low, &high, &limits).ok_or(Error::Singular { what: "response" })?;
        ln_s = found.x;
        ln_g = shape.ln_g(&ln_s);
        let inverse = Inverse(&ln_g);
        let radiances: Vec<f64> = pixels.iter().map(|p| p.radiance(&inverse)).collect();
        pixels.iter_mut().zip(radiances).for_each(|(p, ln_e)| p.ln_e = ln_e);
        let next = (Noise::of(&pixels, &inverse), variation(&found.at.normal, &roughness, &ln_s, tau));
        let moved = next.0.differs(&noise).max((next.1 / tau).ln().abs());
        (noise, tau) = next;
        noise.give(&mut pixels, &inverse);
        if moved < SETTLED {
            break;
        }
    }
    let fit = Fit { shape: &shape, pixels: &pixels, penalty: &roughness / (tau * tau) };
    let derivative = shape.derivative(&ln_s);
    let covariance = &derivative * fit.covariance(&ln_s) * derivative.transpose();
    Ok(Curve { ln_g, covariance: Some(covariance) })
}

/// τ by the evidence: τ² = roughness over the number of changes of slope that the photographs determine.
fn variation(normal: &DMatrix<f64>, roughness: &DMatrix<f64>, ln_s: &[f64], tau: f64) -> f64 {
    let s = DVector::from_column_slice(ln_s);
    let inverse = invert(normal, &(0..ln_s.len()).collect::<Vec<_>>()).matrix;
    let undetermined = (inverse * roughness).trace() / (tau * tau);
    let determined = (ln_s.len() as f64 - 2.0 - undetermined).max(1.0);
    (s.dot(&(roughness * &s)) / determined).sqrt().clamp(TAU.0, TAU.2)
}

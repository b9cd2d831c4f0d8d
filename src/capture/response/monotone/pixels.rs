//! Pixels whose radiances are unknown: what a curve leaves of their codes.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use libm::erfc;

use crate::capture::response::{Exposures, LEVELS, weight};

/// Cauchy's scale in standard deviations: 95 % efficient for Gaussian noise.
const CAUCHY: f64 = 2.385;
/// Pixels of a channel at most: with a noise of one code, standard errors are then about 0.002 in ln g.
const MOST: usize = 2000;
/// Bins in which the noise of codes is found.
const BINS: usize = 8;
/// Samples of a bin from which on it has a noise of its own, known to a tenth.
const FEWEST: usize = 100;
/// Noise of a code that is rounded: 1/√12.
const ROUNDING: f64 = 0.288_675_134_594_812_9;
/// Normal: standard deviations per median of the absolute value.
const PER_MEDIAN: f64 = 1.482_602_218_505_602;
/// Most steps towards the radiance of a pixel.
const STEPS: usize = 30;
/// Step, in ln E, below which it is found: errors of the sum are of its square.
const CLOSE: f64 = 1e-7;
/// Longest of these steps, in ln E.
const LONGEST: f64 = 1.0;

/// A pixel in several exposures.
pub(super) struct Pixel {
    codes: Vec<usize>,
    ln_t: Vec<f64>,
    /// The lowest and the highest code of the channel: black and white, wherever the camera puts them.
    ends: (usize, usize),
    /// Noise of each of its codes.
    sigma: Vec<f64>,
    /// Its radiance, as far as it is known.
    pub ln_e: f64,
}

/// What a sample adds to the sum: its loss near a curve is that of Gaussian noise with this residual and weight.
#[derive(Clone, Copy)]
pub(super) struct Term {
    /// Its code according to the curve: the whole one below, and what is left; beyond the ends of the range less than 0 or more than 1.
    pub code: (usize, f64),
    /// Codes per ln exposure there.
    pub slope: f64,
    /// Noise of its code.
    pub sigma: f64,
    /// ρ.
    pub loss: f64,
    /// Code less that of the curve, σ.
    pub residual: f64,
    /// 1 without clipping for a residual of 0.
    pub weight: f64,
    /// ρ''/2 without clipping; the weight otherwise.
    pub curvature: f64,
}

/// A curve the other way round: from ln exposure to code.
pub(super) struct Inverse<'a>(pub &'a [f64]);

impl Inverse<'_> {
    /// The code, beyond the ends as the outermost steps go on, and codes per ln exposure.
    fn at(&self, ln_exposure: f64) -> ((usize, f64), f64) {
        let k = self.0.partition_point(|g| *g <= ln_exposure).clamp(1, LEVELS - 1) - 1;
        let slope = 1.0 / (self.0[k + 1] - self.0[k]);
        ((k, (ln_exposure - self.0[k]) * slope), slope)
    }
}

impl Pixel {
    /// The pixels of a channel that two exposures show within the range, evenly thinned where they are many; nothing is known of their radiances yet.
    pub(super) fn all(stacks: &[Exposures], channel: usize) -> Vec<Self> {
        let places = |s: &Exposures| s.times_s.len() * s.pixels();
        let code = |s: &Exposures, i: usize| s.code(i % s.times_s.len(), i / s.times_s.len(), channel);
        let codes = || stacks.iter().flat_map(|s| (0..places(s)).map(move |i| code(s, i)));
        let ends = codes().fold((LEVELS - 1, 0), |(low, high), z| (low.min(z), high.max(z)));
        let mut out = Vec::new();
        for stack in stacks {
            let ln_t: Vec<f64> = stack.times_s.iter().map(|t| t.ln()).collect();
            for n in 0..stack.pixels() {
                let codes = (0..ln_t.len()).map(|j| stack.code(j, n, channel)).collect();
                let pixel = Self { codes, ln_t: ln_t.clone(), ends, sigma: vec![1.0; ln_t.len()], ln_e: 0.0 };
                if pixel.inside().count() > 1 {
                    out.push(pixel);
                }
            }
        }
        let every = out.len().div_ceil(MOST).max(1);
        out.into_iter().step_by(every).collect()
    }

    /// Its samples that are those of an exposure, not an end of the range: numbers of exposures.
    pub(super) fn inside(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.codes.len()).filter(|j| self.ends.0 < self.codes[*j] && self.codes[*j] < self.ends.1)
    }

    /// A first radiance, from a curve.
    pub(super) fn start(&mut self, ln_g: &[f64]) {
        let each = self.inside().map(|j| (weight(self.codes[j] as f64), ln_g[self.codes[j]] - self.ln_t[j]));
        let sum = each.fold((0.0, 0.0), |sum, (w, e)| (sum.0 + w * e, sum.1 + w));
        self.ln_e = sum.0 / sum.1;
    }

    /// Each sample at a radiance.
    pub(super) fn terms<'a>(&'a self, inverse: &'a Inverse<'_>, ln_e: f64) -> impl Iterator<Item = Term> + 'a {
        self.codes.iter().zip(&self.ln_t).zip(&self.sigma).map(move |((z, t), sigma)| {
            let (code, slope) = inverse.at(ln_e + t);
            term(*z, self.ends, code, slope, *sigma)
        })
    }

    /// The radiance that a curve gives: Gauss's and Newton's steps, halved until they gain.
    pub(super) fn radiance(&self, inverse: &Inverse<'_>) -> f64 {
        let at = |ln_e: f64| {
            let (mut loss, mut above, mut below) = (0.0, 0.0, 0.0);
            for t in self.terms(inverse, ln_e) {
                loss += t.loss;
                let slope = t.slope / t.sigma;
                above += t.weight * slope * t.residual;
                below += t.weight * slope * slope;
            }
            (loss, if below > 0.0 { (above / below).clamp(-LONGEST, LONGEST) } else { 0.0 })
        };
        let mut ln_e = self.ln_e;
        let (mut loss, mut step) = at(ln_e);
        for _ in 0..STEPS {
            if step.abs() < CLOSE {
                break;
            }
            let (trial, next) = at(ln_e + step);
            if trial <= loss {
                ln_e += step;
                (loss, step) = (trial, next);
            } else {
                step *= 0.5;
            }
        }
        ln_e
    }
}

/// Noise of a code over codes: at the middles of bins of equal width, between them linear. It is not the same everywhere: light has its own, and
/// a small movement of the camera is one that grows with the picture.
pub(super) struct Noise([f64; BINS]);

impl Noise {
    /// From the medians of the residuals in each bin, raised for the radiance that each pixel spends; a bin with few has what all have.
    pub(super) fn of(pixels: &[Pixel], inverse: &Inverse<'_>) -> Self {
        let mut bins: [Vec<f64>; BINS] = std::array::from_fn(|_| Vec::new());
        for pixel in pixels {
            let n = pixel.inside().count() as f64;
            let spent = (n / (n - 1.0)).sqrt();
            let terms: Vec<Term> = pixel.terms(inverse, pixel.ln_e).collect();
            for j in pixel.inside() {
                let t = &terms[j];
                let bin = (t.code.0 * BINS / LEVELS).min(BINS - 1);
                bins[bin].push(spent * (t.residual * t.sigma).abs());
            }
        }
        let median = |all: &mut [f64]| {
            let middle = all.len() / 2;
            (PER_MEDIAN * *all.select_nth_unstable_by(middle, f64::total_cmp).1).max(ROUNDING)
        };
        let mut all: Vec<f64> = bins.iter().flatten().copied().collect();
        let typical = if all.is_empty() { ROUNDING } else { median(&mut all) };
        Self(bins.map(|mut bin| if bin.len() < FEWEST { typical } else { median(&mut bin) }))
    }

    /// At a code.
    fn at(&self, code: f64) -> f64 {
        let x = (code * BINS as f64 / LEVELS as f64 - 0.5).clamp(0.0, (BINS - 1) as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to bins")]
        let k = (x as usize).min(BINS - 2);
        self.0[k] + (x - k as f64) * (self.0[k + 1] - self.0[k])
    }

    /// Largest relative difference to another one.
    pub(super) fn differs(&self, other: &Self) -> f64 {
        self.0.iter().zip(&other.0).map(|(a, b)| (a / b).ln().abs()).fold(0.0, f64::max)
    }

    /// Gives each pixel the noise of the codes that it should have.
    pub(super) fn give(&self, pixels: &mut [Pixel], inverse: &Inverse<'_>) {
        for pixel in pixels {
            let codes: Vec<(usize, f64)> = pixel.terms(inverse, pixel.ln_e).map(|t| t.code).collect();
            pixel.sigma = codes.into_iter().map(|(k, share)| self.at(k as f64 + share)).collect();
        }
    }
}

/// A code at an end says that the exposure is there or beyond: −2 ln of the probability of that, instead of r². Either is tamed as Cauchy
/// has it.
fn term(z: usize, ends: (usize, usize), place: (usize, f64), slope: f64, sigma: f64) -> Term {
    let code = place.0 as f64 + place.1;
    let to_end = match z {
        z if z == ends.1 => Some(code - (z as f64 - 0.5)),
        z if z == ends.0 => Some(z as f64 + 0.5 - code),
        _ => None,
    };
    let (plain, residual, weight) = match to_end {
        None => {
            let r = (z as f64 - code) / sigma;
            (r * r, r, 1.0)
        }
        Some(to_end) => {
            let t = to_end / sigma;
            let (loss, mills) = tail(t);
            let residual = 1.0 / (mills + t);
            (loss, if z == ends.1 { residual } else { -residual }, mills * (mills + t))
        }
    };
    let u = plain / (CAUCHY * CAUCHY);
    let tamed = weight / (1.0 + u);
    let curvature = if to_end.is_none() { (1.0 - u) / (1.0 + u).powi(2) } else { tamed };
    Term { code: place, slope, sigma, loss: CAUCHY * CAUCHY * u.ln_1p(), residual, weight: tamed, curvature }
}

/// −2 ln Φ(t) and φ(t)/Φ(t), of the normal distribution.
fn tail(t: f64) -> (f64, f64) {
    if t < -20.0 {
        // The first terms of the asymptotic series; the next ones are below 1e-5 of the second.
        return (t * t + (2.0 * PI * t * t).ln(), -t - 1.0 / t);
    }
    let below = 0.5 * erfc(-t * FRAC_1_SQRT_2);
    (-2.0 * below.ln(), (-0.5 * t * t).exp() / ((2.0 * PI).sqrt() * below))
}

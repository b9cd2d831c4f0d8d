//! A rising curve from its slopes in logarithms.

use std::iter;

use nalgebra::{DMatrix, DVector};

use crate::capture::response::{GAUGE, LEVELS};

/// Steps between codes.
const STEPS: usize = LEVELS - 1;
/// Greatest distance of knots along [`place`].
const SPACING: f64 = 0.2;

/// Where a code lies between the ends of the range: ln((z + 1)/(256 − z)). Toes change over factors of the code, shoulders over factors
/// of what is left to saturation.
fn place(code: f64) -> f64 {
    ((code + 1.0) / (LEVELS as f64 - code)).ln()
}

/// ln z; code 0 stands for half a code.
fn ln(code: usize) -> f64 {
    (code as f64).max(0.5).ln()
}

/// ln s = ln(d ln g / d ln z) is linear between knots.
pub(super) struct Shape {
    /// Codes of the knots.
    codes: Vec<usize>,
    /// Their places.
    knots: Vec<f64>,
    /// Of each step: the knot before it and how far it is to the next.
    between: Vec<(usize, f64)>,
    /// Lengths of the steps in ln z.
    lengths: Vec<f64>,
}

impl Shape {
    pub(super) fn new() -> Self {
        let next = |z: &usize| {
            let rate = place(*z as f64 + 0.5) - place(*z as f64 - 0.5);
            let after = (1..).find(|n| (*n + 1) as f64 * rate.abs() > SPACING).unwrap_or(1);
            (*z < STEPS).then_some((z + after).min(STEPS))
        };
        let codes: Vec<usize> = iter::once(0).chain(iter::successors(Some(1), next)).collect();
        let knots: Vec<f64> = codes.iter().map(|z| place(*z as f64)).collect();
        let interval = |k: usize| {
            let x = place(k as f64 + 0.5);
            let before = knots.partition_point(|knot| *knot <= x).clamp(1, knots.len() - 1) - 1;
            (before, (x - knots[before]) / (knots[before + 1] - knots[before]))
        };
        let between = (0..STEPS).map(interval).collect();
        let lengths = (0..STEPS).map(|k| ln(k + 1) - ln(k)).collect();
        Self { codes, knots, between, lengths }
    }

    /// Knots.
    pub(super) fn len(&self) -> usize {
        self.knots.len()
    }

    /// ln s at the knots of a curve that may also fall: its mean slopes from knot to knot, at least a tenth of a linear camera's.
    pub(super) fn of(&self, ln_g: &[f64]) -> Vec<f64> {
        let around = |m: usize| (self.codes[m.saturating_sub(1)], self.codes[(m + 1).min(self.len() - 1)]);
        let slope = |(below, above): (usize, usize)| (ln_g[above] - ln_g[below]) / (ln(above) - ln(below));
        (0..self.len()).map(|m| slope(around(m)).max(0.1).ln()).collect()
    }

    fn steps(&self, ln_s: &[f64]) -> Vec<f64> {
        let of =
            |((k, share), length): (&(usize, f64), &f64)| length * (ln_s[*k] + share * (ln_s[k + 1] - ln_s[*k])).exp();
        self.between.iter().zip(&self.lengths).map(of).collect()
    }

    /// ln g at the codes, 0 at the gauge.
    pub(super) fn ln_g(&self, ln_s: &[f64]) -> Vec<f64> {
        let sum = |sum: &mut f64, step: f64| {
            *sum += step;
            Some(*sum)
        };
        let mut ln_g: Vec<f64> = iter::once(0.0).chain(self.steps(ln_s).into_iter().scan(0.0, sum)).collect();
        let gauge = ln_g[GAUGE];
        ln_g.iter_mut().for_each(|g| *g -= gauge);
        ln_g
    }

    /// ∂ ln g / ∂ ln s: a row per code, a column per knot.
    pub(super) fn derivative(&self, ln_s: &[f64]) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(LEVELS, self.len());
        for (z, (step, (k, share))) in self.steps(ln_s).into_iter().zip(&self.between).enumerate() {
            for m in 0..self.len() {
                out[(z + 1, m)] = out[(z, m)];
            }
            out[(z + 1, *k)] += step * (1.0 - share);
            out[(z + 1, k + 1)] += step * share;
        }
        let gauge = out.row(GAUGE).into_owned();
        out.row_iter_mut().for_each(|mut row| row -= &gauge);
        out
    }

    /// ∫ (d² ln s / dx²)² dx over the places x, as a quadratic form of ln s.
    pub(super) fn roughness(&self) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(self.len(), self.len());
        for (k, x) in self.knots.windows(3).enumerate() {
            let (before, after) = (x[1] - x[0], x[2] - x[1]);
            let mut turn = DVector::zeros(self.len());
            turn[k] = 1.0 / before;
            turn[k + 1] = -1.0 / before - 1.0 / after;
            turn[k + 2] = 1.0 / after;
            out += &turn * turn.transpose() / (0.5 * (before + after));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_has_one_slope() {
        let shape = Shape::new();
        let ln_g = shape.ln_g(&vec![2.2_f64.ln(); shape.len()]);
        for (z, g) in ln_g.iter().enumerate() {
            assert!((g - 2.2 * (ln(z) - ln(GAUGE))).abs() < 1e-12, "{z}");
        }
    }

    #[test]
    fn the_derivative_is_that_of_the_curve() {
        let shape = Shape::new();
        let ln_s: Vec<f64> = (0..shape.len()).map(|m| (0.3 * m as f64).sin()).collect();
        let derivative = shape.derivative(&ln_s);
        for m in 0..shape.len() {
            let moved = |by: f64| {
                shape.ln_g(&ln_s.iter().enumerate().map(|(n, s)| s + if n == m { by } else { 0.0 }).collect::<Vec<_>>())
            };
            for (z, (up, down)) in moved(1e-5).iter().zip(moved(-1e-5)).enumerate() {
                // Rounding of ln g, at most 40, over the difference; the third derivative adds 1e-10 of the first.
                assert!((derivative[(z, m)] - (up - down) / 2e-5).abs() < 40.0 * f64::EPSILON / 1e-5 + 1e-8, "{z} {m}");
            }
        }
    }
}

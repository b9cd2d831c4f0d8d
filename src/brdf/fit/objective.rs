//! Sum of squares of a model over the places of a table, and its normal equations.
//!
//! Derivatives are differences: the model is made once for each column of variables, moved a little in all of its bands at once (a
//! band depends only on its own variables), and evaluated beside the others at every place. Nothing is allocated per place.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::coordinates::Coordinates;
use super::metric::{PIECE, Residual};
use super::samples::Samples;
use crate::brdf::Brdf;
use crate::brdf::description::Bands;
use crate::brdf::description::template::Template;
use crate::math::least_squares::{Linearised, Problem};

/// What is minimised over which places.
#[derive(Debug, Clone, Copy)]
pub(super) struct Objective<'a> {
    pub(super) template: &'a Template,
    pub(super) coordinates: &'a Coordinates,
    pub(super) samples: &'a Samples,
    pub(super) bands: Bands<'a>,
    pub(super) residual: Residual,
}

/// Steps of forward differences, relative to the span of a variable: √ε, a little more for models with rounding of their own.
const FORWARD: f64 = 1e-7;
/// Of central ones: ∛ε.
const CENTRAL: f64 = 6e-6;

/// A model moved in one column: by how much in each band.
struct Moved {
    brdf: Box<dyn Brdf>,
    by: Vec<f64>,
}

/// What is summed over the places.
pub(super) struct Sums {
    /// Σ w r², Jᵀwr and JᵀWJ.
    pub(super) at: Linearised,
    /// Σ w² r² JᵀJ.
    pub(super) meat: DMatrix<f64>,
    /// Jᵀwd, d what the common error of the samples changes r by.
    pub(super) common: DVector<f64>,
}

/// The sums of one band: Σ r², Jᵀr and the upper triangle of JᵀJ over the columns; the meat Σ w² r² JᵀJ and Jᵀwd where they are asked for.
struct Layout {
    columns: usize,
    meat: bool,
}

impl Layout {
    fn triangle(&self) -> usize {
        self.columns * (self.columns + 1) / 2
    }

    fn length(&self) -> usize {
        1 + self.columns + self.triangle() + if self.meat { self.triangle() + self.columns } else { 0 }
    }
}

impl Objective<'_> {
    /// The model at a place; `None` where it has none.
    pub(super) fn model(&self, x: &[f64]) -> Option<Box<dyn Brdf>> {
        self.template.fill(&self.coordinates.values(x), self.bands).prepare(self.bands).ok()
    }

    /// The model moved in a column by `step` of its span, or to the other side where there is none.
    fn moved(&self, x: &[f64], column: usize, step: f64) -> Option<Moved> {
        let (low, high) = self.coordinates.bounds();
        [1.0, -1.0].into_iter().find_map(|side| {
            let mut place = x.to_vec();
            let by = (0..self.coordinates.bands).map(|band| {
                let v = self.coordinates.variable(column, band);
                let to = x[v] + side * step * self.coordinates.span(x[v]);
                // Within the range; the difference as it is held.
                place[v] = if (low[v]..=high[v]).contains(&to) { to } else { 2.0 * x[v] - to };
                place[v] - x[v]
            });
            let by = by.collect();
            Some(Moved { brdf: self.model(&place)?, by })
        })
    }

    /// Normal equations by forward differences.
    fn forward(&self, x: &[f64]) -> Option<Sums> {
        let base = self.model(x)?;
        let columns = self.coordinates.columns.len();
        let moved: Vec<Moved> = (0..columns).map(|c| self.moved(x, c, FORWARD)).collect::<Option<_>>()?;
        let pairs: Vec<(usize, usize)> = (0..columns).map(|c| (c + 1, 0)).collect();
        let steps: Vec<Vec<f64>> = moved.iter().map(|m| m.by.iter().map(|b| 1.0 / b).collect()).collect();
        let models: Vec<&dyn Brdf> =
            std::iter::once(base.as_ref()).chain(moved.iter().map(|m| m.brdf.as_ref())).collect();
        self.sums(&models, &pairs, &steps, false)
    }

    /// Normal equations by central differences where both sides are within the ranges, and the other sums.
    pub(super) fn central(&self, x: &[f64]) -> Option<Sums> {
        let base = self.model(x)?;
        let columns = self.coordinates.columns.len();
        let (mut moved, mut pairs, mut steps) = (Vec::new(), Vec::new(), Vec::new());
        for c in 0..columns {
            let (up, down) = (self.moved(x, c, CENTRAL)?, self.moved(x, c, -CENTRAL)?);
            let apart: Vec<f64> = up.by.iter().zip(&down.by).map(|(a, b)| a - b).collect();
            if apart.iter().all(|d| *d != 0.0) {
                pairs.push((moved.len() + 1, moved.len() + 2));
                steps.push(apart.iter().map(|d| 1.0 / d).collect());
                moved.extend([up, down]);
            } else {
                // At a bound both went to the same side.
                pairs.push((moved.len() + 1, 0));
                steps.push(up.by.iter().map(|d| 1.0 / d).collect());
                moved.push(up);
            }
        }
        let models: Vec<&dyn Brdf> =
            std::iter::once(base.as_ref()).chain(moved.iter().map(|m| m.brdf.as_ref())).collect();
        self.sums(&models, &pairs, &steps, true)
    }

    /// Normal equations from models at differences `pairs` (column by column) and their inverse steps per band.
    fn sums(&self, models: &[&dyn Brdf], pairs: &[(usize, usize)], steps: &[Vec<f64>], meat: bool) -> Option<Sums> {
        let layout = Layout { columns: pairs.len(), meat };
        let (bands, length) = (self.coordinates.bands, layout.length());
        let piece = |first: usize| {
            let mut out = vec![0.0; bands * length];
            let mut values = vec![0.0; models.len() * bands];
            let mut row = vec![0.0; layout.columns];
            for i in first..(first + PIECE).min(self.samples.len()) {
                let (incident, outgoing) = self.samples.directions[i];
                for (model, values) in models.iter().zip(values.chunks_exact_mut(bands)) {
                    model.evaluate(incident, outgoing, values);
                }
                let weight = if self.residual.is_weighted() { self.samples.weights[i] } else { 1.0 };
                for (band, out) in out.chunks_exact_mut(length).enumerate() {
                    let (y, f) = (self.samples.values[i * bands + band], values[band]);
                    let (r, slope) = self.residual.at(self.samples.cosines[i], y, f);
                    for (row, (step, (a, b))) in row.iter_mut().zip(steps.iter().zip(pairs)) {
                        *row = slope * (values[a * bands + band] - values[b * bands + band]) * step[band];
                    }
                    add(out, &row, weight, r, meat);
                    if let Some(off) = self.samples.common.get(i * bands + band).filter(|_| meat) {
                        let change = self.residual.at(self.samples.cosines[i], y + off, f).0 - r;
                        let sums = &mut out[length - layout.columns..];
                        sums.iter_mut().zip(&row).for_each(|(s, row)| *s += weight * row * change);
                    }
                }
            }
            out
        };
        let firsts: Vec<usize> = (0..self.samples.len()).step_by(PIECE).collect();
        let pieces: Vec<Vec<f64>> = firsts.into_par_iter().map(piece).collect();
        let mut total = vec![0.0; bands * length];
        for piece in &pieces {
            total.iter_mut().zip(piece).for_each(|(t, p)| *t += p);
        }
        total.iter().all(|t| t.is_finite()).then(|| self.assemble(&total, &layout))
    }

    /// The sums of the bands put where their variables are.
    fn assemble(&self, total: &[f64], layout: &Layout) -> Sums {
        let n = self.coordinates.count;
        let (mut cost, mut gradient, mut common) = (0.0, DVector::zeros(n), DVector::zeros(n));
        let (mut normal, mut meat) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        for (band, sums) in total.chunks_exact(layout.length()).enumerate() {
            cost += sums[0];
            let mut at = 1 + layout.columns;
            for c in 0..layout.columns {
                let v = self.coordinates.variable(c, band);
                gradient[v] += sums[1 + c];
                if layout.meat {
                    common[v] += sums[layout.length() - layout.columns + c];
                }
                for d in c..layout.columns {
                    let w = self.coordinates.variable(d, band);
                    let put = |matrix: &mut DMatrix<f64>, value: f64| {
                        matrix[(v, w)] += value;
                        if v != w {
                            matrix[(w, v)] += value;
                        }
                    };
                    put(&mut normal, sums[at]);
                    if layout.meat {
                        put(&mut meat, sums[at + layout.triangle()]);
                    }
                    at += 1;
                }
            }
        }
        Sums { at: Linearised { cost, normal, gradient }, meat, common }
    }
}

/// Adds the residual of one place and band.
#[inline]
fn add(out: &mut [f64], row: &[f64], weight: f64, r: f64, meat: bool) {
    let columns = row.len();
    out[0] += weight * r * r;
    let (gradient, triangle) = out[1..].split_at_mut(columns);
    let mut at = 0;
    let half = columns * (columns + 1) / 2;
    for c in 0..columns {
        let left = weight * row[c];
        gradient[c] += left * r;
        for right in &row[c..] {
            triangle[at] += left * right;
            if meat {
                triangle[half + at] += weight * r * r * left * right;
            }
            at += 1;
        }
    }
}

impl Problem for Objective<'_> {
    fn cost(&self, x: &[f64]) -> Option<f64> {
        let model = self.model(x)?;
        let bands = self.coordinates.bands;
        let piece = |first: usize| {
            let (mut sum, mut values) = (0.0, vec![0.0; bands]);
            for i in first..(first + PIECE).min(self.samples.len()) {
                let (incident, outgoing) = self.samples.directions[i];
                model.evaluate(incident, outgoing, &mut values);
                let weight = if self.residual.is_weighted() { self.samples.weights[i] } else { 1.0 };
                for (f, y) in values.iter().zip(&self.samples.values[i * bands..]) {
                    sum += weight * self.residual.at(self.samples.cosines[i], *y, *f).0.powi(2);
                }
            }
            sum
        };
        let firsts: Vec<usize> = (0..self.samples.len()).step_by(PIECE).collect();
        let pieces: Vec<f64> = firsts.into_par_iter().map(piece).collect();
        Some(pieces.iter().sum())
    }

    fn linearise(&self, x: &[f64]) -> Option<Linearised> {
        self.forward(x).map(|sums| sums.at)
    }
}

//! The law of propagation of uncertainty (JCGM 100, 5.2; JCGM 102 for several figures at once): first order, with the full
//! covariance of the samples.
//!
//! Sensitivities are central differences. Figures proportional to the samples have exact ones, up to rounding; for the others the
//! step is 1e-4 of the largest sample, whose square is the relative error of the difference.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::Outputs;
use super::model::{Direction, Model};

/// Step of the differences, as a fraction of the largest sample.
const STEP: f64 = 1e-4;

/// Standard uncertainties by contribution and figure, and the covariance of the figures.
pub(super) struct Propagated {
    /// By contribution, then by figure.
    pub standard: Vec<Vec<f64>>,
    pub covariance: DMatrix<f64>,
}

/// Propagates all contributions of the model.
pub(super) fn propagate(model: &Model, figures: &impl Outputs) -> Propagated {
    let count = figures.count();
    let directions: Vec<Direction> = (0..model.inputs.len()).map(|i| model.direction(i)).collect();
    let gradient = directions.iter().any(|d| !matches!(d, Direction::One(_))).then(|| gradient(model, figures));
    let mut standard = Vec::with_capacity(directions.len());
    let mut covariance = DMatrix::zeros(count, count);
    for direction in &directions {
        let part = match (direction, &gradient) {
            (Direction::One(d), _) => {
                let column = DMatrix::from_vec(count, 1, along(model, figures, d));
                &column * column.transpose()
            }
            (Direction::Independent(u), Some(g)) => {
                let scaled = DMatrix::from_fn(g.nrows(), count, |r, c| g[(r, c)] * u[r]);
                scaled.tr_mul(&scaled)
            }
            (Direction::Many(modes), Some(g)) => {
                let seen = g.tr_mul(modes);
                &seen * seen.transpose()
            }
            (Direction::Chain { standard, correlation }, Some(g)) => chain(g, standard, correlation),
            // A gradient was made for whatever needs one.
            (_, None) => DMatrix::zeros(count, count),
        };
        standard.push(part.diagonal().iter().map(|v| super::variance(*v).sqrt()).collect());
        covariance += part;
    }
    Propagated { standard, covariance }
}

/// Change of every figure (column) per unit of each independent mode (row) of the contributions `chosen`, with its sign.
pub(super) fn effects(model: &Model, figures: &impl Outputs, chosen: &[usize]) -> Vec<DMatrix<f64>> {
    let count = figures.count();
    let directions: Vec<Direction> = chosen.iter().map(|i| model.direction(*i)).collect();
    let gradient = directions.iter().any(|d| !matches!(d, Direction::One(_))).then(|| gradient(model, figures));
    let of = |direction: &Direction| match (direction, &gradient) {
        (Direction::One(d), _) => DMatrix::from_row_slice(1, count, &along(model, figures, d)),
        (Direction::Independent(u), Some(g)) => DMatrix::from_fn(g.nrows(), count, |r, c| g[(r, c)] * u[r]),
        (Direction::Many(modes), Some(g)) => modes.tr_mul(g),
        (Direction::Chain { standard, correlation }, Some(g)) => {
            // eᵢ = rᵢ eᵢ₋₁ + √(1 − rᵢ²) zᵢ: a mode acts on its own sample and, ever less, on those after it.
            let mut out = DMatrix::zeros(g.nrows(), count);
            for k in 0..count {
                let mut after = 0.0;
                for i in (0..g.nrows()).rev() {
                    after = g[(i, k)] * standard[i] + correlation.get(i + 1).map_or(0.0, |r| r * after);
                    out[(i, k)] = (1.0 - correlation[i].powi(2)).sqrt() * after;
                }
            }
            out
        }
        // A gradient was made for whatever needs one.
        (_, None) => DMatrix::zeros(0, count),
    };
    directions.iter().map(of).collect()
}

/// Gᵀ C G for samples of which each is correlated with the one before it: C_ij = uᵢ uⱼ Π r. With t_i = a_i + r_i t_{i−1} the
/// sum over all j < i is r_i t_{i−1}, so that one pass over the samples is enough.
fn chain(g: &DMatrix<f64>, standard: &[f64], correlation: &[f64]) -> DMatrix<f64> {
    let count = g.ncols();
    let mut out = DMatrix::zeros(count, count);
    let mut before = vec![0.0; count];
    let mut here = vec![0.0; count];
    for (i, (u, r)) in standard.iter().zip(correlation).enumerate() {
        for (k, (a, t)) in here.iter_mut().zip(&mut before).enumerate() {
            *a = g[(i, k)] * u;
            *t *= r;
        }
        for q in 0..count {
            for p in 0..count {
                out[(p, q)] += here[p] * here[q] + here[p] * before[q] + here[q] * before[p];
            }
        }
        before.iter_mut().zip(&here).for_each(|(t, a)| *t += a);
    }
    out
}

/// Change of every figure along a change of the samples.
fn along(model: &Model, figures: &impl Outputs, direction: &[f64]) -> Vec<f64> {
    let largest = direction.iter().map(|d| d.abs()).fold(0.0, f64::max);
    if largest == 0.0 {
        return vec![0.0; figures.count()];
    }
    let step = STEP * model.peak() / largest;
    let at = |h: f64| {
        let values: Vec<f64> = model.values().iter().zip(direction).map(|(v, d)| v + h * d).collect();
        let mut out = vec![0.0; figures.count()];
        figures.evaluate(&values, &mut Default::default(), &mut out);
        out
    };
    at(step).iter().zip(at(-step)).map(|(a, b)| (a - b) / (2.0 * step)).collect()
}

/// Derivative of every figure (column) by every sample (row).
fn gradient(model: &Model, figures: &impl Outputs) -> DMatrix<f64> {
    let (samples, count) = (model.values().len(), figures.count());
    let step = STEP * model.peak();
    let mut rows = vec![0.0; samples * count];
    let room = || (model.values().to_vec(), vec![0.0; count], Default::default());
    rows.par_chunks_mut(count).enumerate().for_each_init(room, |(values, below, scratch), (i, out)| {
        let kept = values[i];
        values[i] = kept + step;
        figures.evaluate(values, scratch, out);
        values[i] = kept - step;
        figures.evaluate(values, scratch, below);
        values[i] = kept;
        out.iter_mut().zip(below).for_each(|(a, b)| *a = (*a - *b) / (2.0 * step));
    });
    DMatrix::from_row_slice(samples, count, &rows)
}

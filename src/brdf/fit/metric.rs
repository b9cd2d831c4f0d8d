//! Measures of how far a model is from a table, and the residuals whose squares they sum.
//!
//! ```text
//! cosine     √(Σ w (c (f − y))² / Σ w)                        1/sr; Ngan, Durand & Matusik 2005
//! log        √(Σ w (ln(c f⁺ + ε) − ln(c y⁺ + ε))² / Σ w)      x⁺ = max(x, 0)
//! relative   √(Σ w ((f − y)/max(|y|, ε))² / Σ w)
//! largest    max |c (f − y)|                                  1/sr
//! ```
//!
//! f is the model, y the measured value, c the cosine and w the weight of its place; sums run over places and bands. The largest
//! difference has no squares to sum: it is approached by Σ |c (f − y)|^p with p up to 64, for which the residual is the
//! power p/2. With n values the largest of the result is at most n^(1/p) times the least possible one.

use glam::DVec3;
use rayon::prelude::*;

use super::samples::Samples;
use crate::brdf::Brdf;

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Metric {
    /// Cosine-weighted RMS difference.
    #[default]
    Cosine,
    /// RMS difference of logarithms.
    Log,
    /// RMS relative difference.
    Relative,
    /// Largest cosine-weighted difference.
    Largest,
}

/// A residual as a function of the model's value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Residual {
    Cosine,
    Log {
        epsilon: f64,
    },
    Relative {
        epsilon: f64,
    },
    /// |c (f − y)/scale|^half.
    Power {
        half: f64,
        scale: f64,
    },
}

impl Residual {
    pub(super) fn of(metric: Metric, epsilon: f64) -> Self {
        match metric {
            Metric::Cosine | Metric::Largest => Self::Cosine,
            Metric::Log => Self::Log { epsilon },
            Metric::Relative => Self::Relative { epsilon },
        }
    }

    /// The residual and its derivative by f.
    #[inline]
    pub(super) fn at(self, cos: f64, y: f64, f: f64) -> (f64, f64) {
        match self {
            Self::Cosine => (cos * (f - y), cos),
            Self::Log { epsilon } => {
                let (model, value) = (cos * f.max(0.0) + epsilon, cos * y.max(0.0) + epsilon);
                ((model / value).ln(), if f > 0.0 { cos / model } else { 0.0 })
            }
            Self::Relative { epsilon } => {
                let scale = 1.0 / y.abs().max(epsilon);
                ((f - y) * scale, scale)
            }
            Self::Power { half, scale } => {
                let u = cos * (f - y) / scale;
                let steep = u.abs().powf(half - 1.0);
                (steep * u.abs(), half * steep * u.signum() * cos / scale)
            }
        }
    }

    /// Whether places count by their weights; the largest difference does not ask how many there are.
    pub(super) fn is_weighted(self) -> bool {
        !matches!(self, Self::Power { .. })
    }
}

/// All measures of a model against a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Cosine-weighted RMS difference, 1/sr.
    pub cosine_rms: f64,
    /// RMS difference of logarithms.
    pub log_rms: f64,
    /// RMS relative difference.
    pub relative_rms: f64,
    /// Largest cosine-weighted difference, 1/sr.
    pub largest: f64,
    /// Where that is: ω_i, ω_o.
    pub largest_at: (DVec3, DVec3),
    /// In which band, from 0.
    pub largest_band: usize,
}

/// Places that are summed as one piece: the sum does not depend on how many threads there are.
pub(super) const PIECE: usize = 4096;

/// Measures a model on its bands.
pub(super) fn measure(samples: &Samples, brdf: &dyn Brdf, epsilon: f64) -> Measures {
    let bands = samples.channels.len();
    let residuals = [Residual::Cosine, Residual::Log { epsilon }, Residual::Relative { epsilon }];
    let piece = |first: usize| {
        let (mut sums, mut worst, mut f) = ([0.0; 3], (0.0, first, 0), vec![0.0; bands]);
        for i in first..(first + PIECE).min(samples.len()) {
            let (incident, outgoing) = samples.directions[i];
            brdf.evaluate(incident, outgoing, &mut f);
            let (cos, weight) = (samples.cosines[i], samples.weights[i]);
            for (band, (f, y)) in f.iter().zip(&samples.values[i * bands..]).enumerate() {
                let r = residuals.map(|r| r.at(cos, *y, *f).0);
                sums.iter_mut().zip(r).for_each(|(s, r)| *s += weight * r * r);
                if r[0].abs() > worst.0 {
                    worst = (r[0].abs(), i, band);
                }
            }
        }
        (sums, worst)
    };
    let firsts: Vec<usize> = (0..samples.len()).step_by(PIECE).collect();
    let pieces: Vec<_> = firsts.into_par_iter().map(piece).collect();
    let (mut sums, mut worst) = ([0.0; 3], (0.0, 0, 0));
    for (piece, largest) in pieces {
        sums.iter_mut().zip(piece).for_each(|(s, p)| *s += p);
        if largest.0 > worst.0 {
            worst = largest;
        }
    }
    // The weights have a mean of 1.
    let [cosine_rms, log_rms, relative_rms] = sums.map(|s| (s / (samples.len() * bands) as f64).sqrt());
    let largest_at = samples.directions[worst.1];
    Measures { cosine_rms, log_rms, relative_rms, largest: worst.0, largest_at, largest_band: worst.2 }
}

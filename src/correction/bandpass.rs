//! The bandwidth of an instrument, undone: by differences for a triangular slit (Stearns and Stearns 1988), by iteration for any
//! line-spread function (Richardson 1972, Lucy 1974).
//!
//! An instrument reads M(λ) = ∫ b(λ − x) S(x) dx with b of area 1. For a triangle of full width w at half maximum M = S + w²/12 · S″ up
//! to fourth derivatives, because its second moment is w²/6; so S ≈ M − w²/12 · M″, exact for cubics. With second differences at the
//! step h that is −α M₋₁ + (1 + 2α) M₀ − α M₊₁ with α = (w/h)²/12: for w = h the 0.083 of Stearns and Stearns, whose ends
//! (1 + α) M₀ − α M₁ are taken, too.

use super::signal::{Operator, Signal};
use super::{Error as Refused, Step};
use crate::finding::Finding;
use crate::math::interpolate;
use crate::mistake::Mistake;
use crate::uncertainty::table;

/// Steps of the fine grid in the width of the line-spread function: a sampled triangle then has its second moment within 0.4 %.
const FINE: f64 = 16.0;

/// Why a bandwidth was not corrected.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No second difference.
    #[error("a bandwidth of {samples} samples; expected at least three")]
    TooFew {
        /// Samples.
        samples: usize,
    },
    /// Nothing between the samples to be told.
    #[error("a line-spread function {width_nm} nm wide on steps of {step_nm} nm; expected steps of at most half of it")]
    TooCoarse {
        /// Full width at half maximum.
        width_nm: f64,
        /// The widest step.
        step_nm: f64,
    },
}

/// What the slit does to a line: relative response over the offset from the line, straight lines between the points.
#[derive(Debug, Clone, PartialEq)]
pub struct LineSpread {
    offsets_nm: Vec<f64>,
    response: Vec<f64>,
}

impl LineSpread {
    /// A triangle by its full width at half maximum, nm.
    #[must_use]
    pub fn triangle(fwhm_nm: f64) -> Self {
        Self { offsets_nm: vec![-fwhm_nm, 0.0, fwhm_nm], response: vec![0.0, 1.0, 0.0] }
    }

    /// Reads a CSV text of two columns: offset λ_read − λ_line in nm, ascending, and relative response, not negative; a header row and
    /// lines with `#` may stand above.
    ///
    /// # Errors
    /// A mistake with its line and column.
    pub fn parse(text: &str) -> Result<Self, Mistake> {
        let (offsets_nm, response) = table::pairs(text, "offset in nm, response")?;
        if response.iter().all(|r| *r == 0.0) {
            return Err(Mistake { line: 1, column: 1, message: "found no response; expected a positive one".into() });
        }
        Ok(Self { offsets_nm, response })
    }

    /// First and last offset, nm.
    fn range_nm(&self) -> (f64, f64) {
        (self.offsets_nm[0], self.offsets_nm[self.offsets_nm.len() - 1])
    }

    /// Response at an offset; 0 beyond the points.
    fn at(&self, offset_nm: f64) -> f64 {
        let (first, last) = self.range_nm();
        if (first..=last).contains(&offset_nm) {
            interpolate::linear(&self.offsets_nm, &self.response, offset_nm)
        } else {
            0.0
        }
    }

    /// Full width at half maximum, nm: between the outermost crossings of half of the largest response.
    #[must_use]
    pub fn fwhm_nm(&self) -> f64 {
        let (x, y) = (&self.offsets_nm, &self.response);
        let half = 0.5 * y.iter().copied().fold(0.0, f64::max);
        let crossing = |i: usize| x[i] + (half - y[i]) / (y[i + 1] - y[i]) * (x[i + 1] - x[i]);
        let first = (0..x.len() - 1).find(|i| y[*i] < half && y[i + 1] >= half).map_or(x[0], crossing);
        let last = (0..x.len() - 1).rfind(|i| y[*i] >= half && y[i + 1] < half).map_or(x[x.len() - 1], crossing);
        last - first
    }
}

/// A correction for bandwidth.
#[derive(Debug, Clone, PartialEq)]
pub enum Bandpass {
    /// By differences (Stearns and Stearns 1988), for a triangular slit.
    Differences {
        /// Full width at half maximum, nm.
        fwhm_nm: f64,
        /// Its standard uncertainty, nm.
        standard_nm: f64,
        /// α; by default (w/h)²/12 with the steps that there are.
        coefficient: Option<f64>,
    },
    /// By Richardson-Lucy iterations.
    RichardsonLucy {
        /// The line-spread function.
        spread: LineSpread,
        /// Most iterations. Where the noise is known they end when what is left of the reading is as small.
        iterations: usize,
    },
}

/// How iterations ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deconvolved {
    /// Full width at half maximum of the line-spread function, nm.
    pub fwhm_nm: f64,
    /// Iterations made.
    pub iterations: usize,
    /// Root mean square of the reading less the reading of what was found, over the largest sample.
    pub residual: f64,
    /// Whether it is as small as the noise.
    pub within_noise: Option<bool>,
}

impl Bandpass {
    /// Stearns and Stearns for a triangle of a width, nm.
    #[must_use]
    pub fn stearns(fwhm_nm: f64) -> Self {
        Self::Differences { fwhm_nm, standard_nm: 0.0, coefficient: None }
    }

    pub(super) fn correct(&self, signal: &mut Signal, findings: &mut Vec<Finding>) -> Result<Step, Refused> {
        let samples = signal.values().len();
        if samples < 3 {
            return Err(Error::TooFew { samples }.into());
        }
        match self {
            Self::Differences { fwhm_nm, standard_nm, coefficient } => {
                let x = signal.wavelengths_nm();
                let mut steps: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
                let weight = |h: f64| coefficient.unwrap_or((fwhm_nm / h).powi(2) / 12.0);
                let operator = differences(&steps, &weight);
                let before = signal.values().to_vec();
                signal.transform(&operator);
                // What is taken off goes with w².
                let relative = 2.0 * standard_nm / fwhm_nm;
                signal.common(signal.values().iter().zip(&before).map(|(s, m)| relative * (s - m)).collect());
                steps.sort_by(f64::total_cmp);
                Ok(Step::Differences { fwhm_nm: *fwhm_nm, coefficient: weight(steps[steps.len() / 2]) })
            }
            Self::RichardsonLucy { spread, iterations } => {
                Ok(Step::RichardsonLucy(iterate(signal, spread, *iterations, findings)?))
            }
        }
    }
}

/// S = M − α(h) h² M″ with the second difference of three neighbours; at the ends that of a neighbour beyond equal to the last sample.
fn differences(steps: &[f64], coefficient: &dyn Fn(f64) -> f64) -> Operator {
    let last = steps.len();
    let row = |i: usize| {
        if i == 0 {
            let a = coefficient(steps[0]);
            return (0, vec![1.0 + a, -a]);
        }
        if i == last {
            let a = coefficient(steps[last - 1]);
            return (last - 1, vec![-a, 1.0 + a]);
        }
        let (h, k) = (steps[i - 1], steps[i]);
        // 2/(h(h+k)), −2/(hk), 2/(k(h+k)) are the weights of the second derivative.
        let mean = 0.5 * (h + k);
        let scale = coefficient(mean) * mean * mean;
        let (before, after) = (-scale * 2.0 / (h * (h + k)), -scale * 2.0 / (k * (h + k)));
        (i - 1, vec![before, 1.0 - before - after, after])
    };
    Operator::new((0..=last).map(row).collect())
}

/// What a fine grid and a line-spread function make of each other.
struct Reading {
    /// The wavelengths of the samples, and the fine grid, nm.
    samples_nm: Vec<f64>,
    fine_nm: Vec<f64>,
    /// Places of the samples in the fine grid.
    nodes: Vec<usize>,
    /// The instrument on the fine grid; each row sums to 1.
    read: Operator,
    /// Its transpose, over the sum of each of its rows.
    back: Operator,
}

/// One iteration S · Rᵀ(M/(R S))/(Rᵀ 1), from the guess S.
struct Pass {
    guess: Vec<f64>,
    /// R S.
    read: Vec<f64>,
    /// M/(R S).
    ratio: Vec<f64>,
    /// What S is multiplied by.
    gain: Vec<f64>,
}

fn iterate(
    signal: &mut Signal,
    spread: &LineSpread,
    most: usize,
    findings: &mut Vec<Finding>,
) -> Result<Deconvolved, Refused> {
    let width_nm = spread.fwhm_nm();
    let x = signal.wavelengths_nm();
    let step_nm = x.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    if 2.0 * step_nm > width_nm * (1.0 + 1e-9) {
        return Err(Error::TooCoarse { width_nm, step_nm }.into());
    }
    let reading = Reading::new(x, spread, width_nm);
    let negative = signal.values().iter().filter(|v| **v < 0.0).count();
    if negative > 0 {
        let message = format!(
            "{negative} negative samples are taken as 0 by the Richardson-Lucy iterations, which know no negative light"
        );
        findings.push(Finding::warning("X003", message));
    }
    let measured: Vec<f64> = signal.values().to_vec();
    let noise = signal.standard().filter(|u| u.iter().all(|u| *u > 0.0));
    let peak = measured.iter().copied().fold(0.0, f64::max);
    let fine: Vec<f64> = reading.up(&measured).into_iter().map(|v| v.max(0.0)).collect();
    // What is left of the reading when what was found is read again, at the samples.
    let left = |read: &[f64]| -> Vec<f64> {
        reading.nodes.iter().zip(&measured).map(|(n, m)| read[*n] - m.max(0.0)).collect()
    };
    let within = |left: &[f64]| {
        noise.as_ref().map(|u| {
            let chi: f64 = left.iter().zip(u).map(|(o, u)| (o / u).powi(2)).sum();
            chi <= left.len() as f64
        })
    };
    let mut found = fine.clone();
    let mut passes: Vec<Pass> = Vec::new();
    let residual = loop {
        let pass = reading.pass(found, &fine);
        let residual = left(&pass.read);
        if passes.len() == most || within(&residual) == Some(true) {
            found = pass.guess;
            break residual;
        }
        found = pass.guess.iter().zip(&pass.gain).map(|(s, g)| s * g).collect();
        passes.push(pass);
    };
    let pick = |all: &[f64]| reading.nodes.iter().map(|n| all[*n]).collect::<Vec<f64>>();
    signal.replace(pick(&found));
    signal.each_mode(|mode| {
        let mut of_fine = reading.up(mode);
        of_fine.iter_mut().zip(&fine).for_each(|(d, f)| *d = if *f > 0.0 { *d } else { 0.0 });
        pick(&passes.iter().fold(of_fine.clone(), |change, pass| reading.derivative(pass, &change, &of_fine)))
    });
    let rms = (residual.iter().map(|r| r * r).sum::<f64>() / residual.len() as f64).sqrt();
    Ok(Deconvolved {
        fwhm_nm: width_nm,
        iterations: passes.len(),
        residual: if peak > 0.0 { rms / peak } else { 0.0 },
        within_noise: within(&residual),
    })
}

impl Reading {
    fn new(x: &[f64], spread: &LineSpread, width_nm: f64) -> Self {
        let mut fine = vec![x[0]];
        let mut nodes = vec![0];
        for w in x.windows(2) {
            let parts = (FINE * (w[1] - w[0]) / width_nm - 1e-9).ceil().max(1.0) as usize;
            fine.extend((1..=parts).map(|k| w[0] + (w[1] - w[0]) * k as f64 / parts as f64));
            nodes.push(fine.len() - 1);
        }
        // Trapezoids over the fine grid; at the ends, where light from beyond is not known, the part that is counts as all.
        let n = fine.len();
        let cell = |j: usize| 0.5 * (fine[(j + 1).min(n - 1)] - fine[j.saturating_sub(1)]);
        let (low, high) = spread.range_nm();
        let row = |i: usize| {
            // Light of λ is read at λ + offset: what is read here is from here less the offsets.
            let first = fine.partition_point(|w| *w < fine[i] - high);
            let last = fine.partition_point(|w| *w <= fine[i] - low);
            let weights: Vec<f64> = (first..last).map(|j| spread.at(fine[i] - fine[j]) * cell(j)).collect();
            let sum: f64 = weights.iter().sum();
            // A spread that does not reach the range from here reads nothing but the place itself.
            if sum > 0.0 { (first, weights.iter().map(|v| v / sum).collect()) } else { (i, vec![1.0]) }
        };
        let rows: Vec<(usize, Vec<f64>)> = (0..n).map(row).collect();
        let mut columns: Vec<(usize, Vec<f64>)> = vec![(0, Vec::new()); n];
        for (i, (first, weights)) in rows.iter().enumerate() {
            for (j, weight) in (*first..).zip(weights) {
                let (start, column) = &mut columns[j];
                if column.is_empty() {
                    *start = i;
                }
                // Rows that leave this place out between others that do not.
                column.resize(i - *start, 0.0);
                column.push(*weight);
            }
        }
        for (_, column) in &mut columns {
            let sum: f64 = column.iter().sum();
            column.iter_mut().for_each(|v| *v /= sum);
        }
        Self { samples_nm: x.to_vec(), fine_nm: fine, nodes, read: Operator::new(rows), back: Operator::new(columns) }
    }

    /// From samples to the fine grid: a natural cubic spline.
    fn up(&self, samples: &[f64]) -> Vec<f64> {
        let slopes = interpolate::spline_slopes(&self.samples_nm, samples);
        self.fine_nm.iter().map(|at| interpolate::hermite(&self.samples_nm, samples, &slopes, *at)).collect()
    }

    fn pass(&self, guess: Vec<f64>, measured: &[f64]) -> Pass {
        let read = self.read.apply(&guess);
        let ratio: Vec<f64> = read.iter().zip(measured).map(|(q, m)| if *q > 0.0 { m / q } else { 0.0 }).collect();
        let gain = self.back.apply(&ratio);
        Pass { guess, read, ratio, gain }
    }

    /// The change of what a pass gives for changes of its guess and of the reading.
    fn derivative(&self, pass: &Pass, change: &[f64], of_measured: &[f64]) -> Vec<f64> {
        let of_read = self.read.apply(change);
        let of_ratio: Vec<f64> = (0..of_read.len())
            .map(|i| {
                let q = pass.read[i];
                if q > 0.0 { (of_measured[i] - pass.ratio[i] * of_read[i]) / q } else { 0.0 }
            })
            .collect();
        let of_gain = self.back.apply(&of_ratio);
        (0..change.len()).map(|i| change[i] * pass.gain[i] + pass.guess[i] * of_gain[i]).collect()
    }
}

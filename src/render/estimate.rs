//! From samples to a reading with its standard error.
//!
//! Samples of one stream are spread evenly (Sobol'), so they are not independent and their scatter says little about the error of
//! their mean. An estimate is therefore made of [`REPLICATES`] streams that are randomised independently; the scatter of their
//! means gives the standard error, with Student's t of 31 degrees of freedom.
//!
//! Reference: A. B. Owen, *Monte Carlo Theory, Methods and Examples*, 2013, ch. 17.

use crate::math::random::philox;
use crate::uncertainty::Stated;

/// Independent streams of every estimate.
pub const REPLICATES: usize = 32;

/// Standard errors to each side that hold 95 %: Student's t of 31 degrees of freedom.
pub const T_975: f64 = 2.039_513_446_396_409;

/// Samples that were no finite number or negative: counted, and never averaged in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Faults {
    /// Samples with a NaN.
    pub nan: u64,
    /// Samples with an infinity.
    pub infinite: u64,
    /// Samples with a negative band.
    pub negative: u64,
    /// Stream and index of the first one.
    pub first: Option<(u64, u64)>,
}

impl Faults {
    /// Judges one sample; `false`: it is not to be used.
    pub fn accept(&mut self, sample: &[f64], stream: u64, index: u64) -> bool {
        // In the common case all are looked at, several at once.
        if sample.iter().fold(true, |fine, v| fine & (*v >= 0.0) & (*v < f64::INFINITY)) {
            return true;
        }
        if sample.iter().any(|v| v.is_nan()) {
            self.nan += 1;
        } else if sample.iter().any(|v| v.is_infinite()) {
            self.infinite += 1;
        } else {
            self.negative += 1;
        }
        self.first.get_or_insert((stream, index));
        false
    }

    /// All of them.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.nan + self.infinite + self.negative
    }

    /// Adds those of another part of the same render, which came after this one.
    pub fn append(&mut self, later: &Self) {
        self.nan += later.nan;
        self.infinite += later.infinite;
        self.negative += later.negative;
        self.first = self.first.or(later.first);
    }
}

/// One of the independent parts of an estimate: sums over its samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Replicate {
    /// Σ over the samples, per band.
    sums: Vec<f64>,
    /// Samples taken, faulty ones included.
    samples: u64,
    faults: Faults,
}

/// A reading per band, as it stands after some samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    replicates: Vec<Replicate>,
}

/// A figure with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The mean.
    pub value: f64,
    /// Its standard error (one standard deviation of the mean); no number where nothing tells it.
    pub standard_error: f64,
}

impl Figure {
    /// The standard error and the interval of 95 %, with Student's t of 31 degrees of freedom: [`REPLICATES`] less one.
    #[must_use]
    pub fn stated(&self) -> Stated {
        Stated::of_mean(self.value, self.standard_error, T_975)
    }
}

impl Replicate {
    /// Nothing sampled yet.
    #[must_use]
    pub fn new(bands: usize) -> Self {
        Self { sums: vec![0.0; bands], samples: 0, faults: Faults::default() }
    }

    /// One as it was stored: sums per band, samples taken, faults.
    #[must_use]
    pub fn from_parts(sums: Vec<f64>, samples: u64, faults: Faults) -> Self {
        Self { sums, samples, faults }
    }

    /// Takes one more sample of the stream `stream`.
    pub fn add(&mut self, stream: u64, sample: &[f64]) {
        if self.faults.accept(sample, stream, self.samples) {
            self.sums.iter_mut().zip(sample).for_each(|(s, v)| *s += v);
        }
        self.samples += 1;
    }

    /// Samples taken: the index of the next one.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Σ over the samples, per band.
    #[must_use]
    pub fn sums(&self) -> &[f64] {
        &self.sums
    }

    /// Samples that were left out.
    #[must_use]
    pub fn faults(&self) -> &Faults {
        &self.faults
    }

    pub(super) fn mean(&self, weights: &[f64]) -> f64 {
        self.sums.iter().zip(weights).map(|(s, w)| s * w).sum::<f64>() / self.good()
    }

    /// Samples that count, at least 1.
    fn good(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a number of samples")]
        let good = (self.samples - self.faults.count()).max(1) as f64;
        good
    }
}

impl Estimate {
    /// Of [`REPLICATES`] replicates, as [`Replicate::add`] left them.
    #[must_use]
    pub fn new(replicates: Vec<Replicate>) -> Self {
        Self { replicates }
    }

    /// Σ_b w_b · reading_b with its standard error.
    #[must_use]
    pub fn figure(&self, weights: &[f64]) -> Figure {
        spread(self.replicates.iter().map(|r| r.mean(weights)))
    }

    /// The reading per band, each with its standard error.
    #[must_use]
    pub fn bands(&self) -> Vec<Figure> {
        let bands = self.replicates[0].sums.len();
        (0..bands).map(|band| spread(self.replicates.iter().map(|r| r.sums[band] / r.good()))).collect()
    }

    /// Samples of all replicates.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.replicates.iter().map(|r| r.samples).sum()
    }

    /// What was left out of the mean.
    #[must_use]
    pub fn faults(&self) -> Faults {
        let mut all = Faults::default();
        self.replicates.iter().for_each(|r| all.append(&r.faults));
        all
    }
}

/// The mean of independent means, with its standard error.
fn spread(means: impl Iterator<Item = f64> + Clone) -> Figure {
    #[expect(clippy::cast_precision_loss, reason = "a number of replicates")]
    let n = means.clone().count() as f64;
    let value = means.clone().sum::<f64>() / n;
    let scatter = means.map(|m| (m - value) * (m - value)).sum::<f64>();
    Figure { value, standard_error: (scatter / (n * (n - 1.0))).sqrt() }
}

/// The stream of a replicate of the instrument `instrument`: distinct for distinct pairs.
#[must_use]
pub fn stream(instrument: u64, replicate: usize) -> u64 {
    #[expect(clippy::cast_possible_truncation, reason = "the two halves of the instrument's number are wanted")]
    let [a, b, ..] = philox([instrument as u32, (instrument >> 32) as u32], [replicate as u32, 0, 0, 0x0E57]);
    u64::from(a) | (u64::from(b) << 32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;

    /// Independent uniform numbers: mean 1/2, standard error √(1/12/n).
    #[test]
    fn figures_of_independent_numbers() {
        let replicates = (0..REPLICATES)
            .map(|r| {
                let mut numbers = Stream::new(5, r as u64);
                let mut replicate = Replicate::new(2);
                (0..1000).for_each(|_| replicate.add(r as u64, &[numbers.uniform(), 3.0]));
                replicate
            })
            .collect();
        let estimate = Estimate::new(replicates);
        let figure = estimate.figure(&[2.0, 0.0]);
        let expected = 2.0 * (1.0_f64 / 12.0 / 32_000.0).sqrt();
        assert_eq!(estimate.samples(), 32_000);
        assert!((figure.value - 1.0).abs() < 4.0 * expected, "{figure:?}");
        // χ² of 31 degrees of freedom: the ratio squared lies in 31 ± 4·√62 out of 31 in all but 1e-4 of cases.
        assert!((0.5..1.45).contains(&(figure.standard_error / expected)), "{figure:?} {expected}");
        assert_eq!(estimate.bands()[1], Figure { value: 3.0, standard_error: 0.0 });
    }

    #[test]
    fn faults_are_counted_and_left_out() {
        let mut replicate = Replicate::new(1);
        for sample in [1.0, f64::NAN, -1.0, f64::INFINITY, 3.0] {
            replicate.add(9, &[sample]);
        }
        let estimate = Estimate::new(vec![replicate.clone(), replicate]);
        assert_eq!(estimate.figure(&[1.0]).value, 2.0);
        let faults = estimate.faults();
        assert_eq!((faults.nan, faults.infinite, faults.negative, faults.count()), (2, 2, 2, 6));
        assert_eq!(faults.first, Some((9, 1)));
    }
}

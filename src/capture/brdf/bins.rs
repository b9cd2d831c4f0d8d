//! Measurements in bins of half and difference angles, with a robust value and its standard error in each.
//!
//! Of each band of a bin the median is found, and the median of the absolute deviations from it. The value is the mean of the measurements
//! within 4 robust standard deviations (1.4826 times the latter, at least the median σ) of the median. Its standard error is the larger of
//! two: √Σσ²/n, what the σ of the measurements say, and s/√n, what their scatter says — which includes how f_r changes within the bin. It is
//! unknown (NaN) for a single measurement without σ. A bin without measurements has no value; none is made up.

use crate::brdf::coordinates::HalfDiff;
use crate::brdf::table::{self, HalfAngle, Resolution};

use super::Observations;

/// Robust standard deviations beyond which a measurement does not take part.
pub(super) const FAR: f64 = 4.0;
/// Standard deviation of a normal distribution over the median of its absolute deviations.
pub(super) const MAD: f64 = 1.4826;

/// A bin with measurements.
#[derive(Debug, Clone, PartialEq)]
pub struct Bin {
    /// Its number in [`Resolution`].
    pub bin: usize,
    /// Measurements in it.
    pub count: usize,
    /// How many of them were too far off in a band.
    pub rejected: usize,
    /// f_r per band, 1/sr.
    pub values: Vec<f64>,
    /// Standard errors; NaN where unknown.
    pub errors: Vec<f64>,
}

/// All bins with measurements, by number.
#[derive(Debug, Clone, PartialEq)]
pub struct Binned {
    /// Bins per angle.
    pub resolution: Resolution,
    /// Those with measurements.
    pub bins: Vec<Bin>,
    /// Number of bins whose middle is above the horizon: those that could be measured.
    pub above_horizon: usize,
    /// Bins with measurements among those.
    pub covered: usize,
}

impl Binned {
    /// Of bins by rising numbers.
    pub(super) fn new(resolution: Resolution, bins: Vec<Bin>) -> Self {
        let above = |bin: usize| {
            let (i, o) = resolution.centre(bin).directions();
            i.z > 0.0 && o.z > 0.0
        };
        let above_horizon = (0..resolution.bins()).filter(|b| above(*b)).count();
        let covered = bins.iter().filter(|b| above(b.bin)).count();
        Self { resolution, bins, above_horizon, covered }
    }

    /// Multiplies values and standard errors.
    pub fn scale(&mut self, factor: f64) {
        let all = self.bins.iter_mut().flat_map(|b| b.values.iter_mut().chain(&mut b.errors));
        all.for_each(|v| *v *= factor);
    }

    /// Part of the bins above the horizon that was measured, 0 to 1.
    #[must_use]
    pub fn coverage_fraction(&self) -> f64 {
        self.covered as f64 / self.above_horizon as f64
    }

    /// The bins as a table; those without measurements are missing.
    ///
    /// # Errors
    /// [`table::Error::Range`] for a resolution out of range.
    pub fn table(&self, of: &Observations) -> Result<HalfAngle, table::Error> {
        let bands = of.channels.len();
        let mut values = vec![f32::NAN; self.resolution.bins() * bands];
        #[expect(clippy::cast_possible_truncation, reason = "tables keep single precision")]
        for bin in &self.bins {
            for (to, from) in values[bin.bin * bands..][..bands].iter_mut().zip(&bin.values) {
                *to = *from as f32;
            }
        }
        HalfAngle::new(self.resolution, of.channels.clone(), values)
    }
}

/// Sorts measurements into bins.
#[must_use]
pub fn bin(of: &Observations, resolution: Resolution) -> Binned {
    let bands = of.channels.len();
    let place = |n: usize| {
        let (i, o) = of.directions[n];
        (resolution.bin(&HalfDiff::new(i, o)), n)
    };
    let mut order: Vec<(usize, usize)> = (0..of.len()).map(place).collect();
    order.sort_unstable();
    let mut bins = Vec::new();
    let (mut values, mut errors) = (Vec::new(), Vec::new());
    for group in order.chunk_by(|a, b| a.0 == b.0) {
        let mut out = Bin { bin: group[0].0, count: group.len(), rejected: 0, values: vec![], errors: vec![] };
        for band in 0..bands {
            values.clear();
            errors.clear();
            values.extend(group.iter().map(|(_, n)| of.values[n * bands + band]));
            errors.extend(group.iter().map(|(_, n)| of.errors[n * bands + band]));
            let (value, error, rejected) = robust_mean(&values, &errors);
            out.values.push(value);
            out.errors.push(error);
            out.rejected = out.rejected.max(rejected);
        }
        bins.push(out);
    }
    Binned::new(resolution, bins)
}

/// Mean of the values near their median, its standard error, and how many took no part.
pub(super) fn robust_mean(values: &[f64], errors: &[f64]) -> (f64, f64, usize) {
    let middle = median(values.to_vec());
    let deviation = MAD * median(values.iter().map(|v| (v - middle).abs()).collect());
    let reach = FAR * deviation.max(median(errors.to_vec()));
    let (mut n, mut sum, mut variance) = (0.0, 0.0, 0.0);
    let near = |v: f64| (v - middle).abs() <= reach;
    for (value, error) in values.iter().zip(errors).filter(|(v, _)| near(**v)) {
        n += 1.0;
        sum += value;
        variance += error * error;
    }
    let mean = sum / n;
    let squares: f64 = values.iter().filter(|v| near(**v)).map(|v| (v - mean).powi(2)).sum();
    let scatter = if n > 1.0 { (squares / (n - 1.0) / n).sqrt() } else { 0.0 };
    let error = (variance.sqrt() / n).max(scatter);
    let unknown = n <= 1.0 && variance <= 0.0;
    (mean, if unknown { f64::NAN } else { error }, values.iter().filter(|v| !near(**v)).count())
}

/// The median; of an even number the mean of the middle two.
fn median(mut values: Vec<f64>) -> f64 {
    let (n, half) = (values.len(), values.len() / 2);
    let (below, &mut middle, _) = values.select_nth_unstable_by(half, f64::total_cmp);
    let other = below.iter().copied().max_by(f64::total_cmp).filter(|_| n.is_multiple_of(2));
    other.map_or(middle, |other| 0.5 * (other + middle))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_wild_value_does_not_move_the_mean() {
        let (mean, error, rejected) = robust_mean(&[1.0, 1.1, 0.9, 50.0, 1.0], &[0.0; 5]);
        // Of 1, 1.1, 0.9, 1: s² = 0.02/3, over 4 values.
        assert!((mean - 1.0).abs() < 1e-15 && rejected == 1);
        assert!((error - (0.02 / 3.0 / 4.0_f64).sqrt()).abs() < 1e-15, "{error}");
    }

    #[test]
    fn the_larger_of_both_errors_is_given() {
        let (mean, error, _) = robust_mean(&[2.0, 2.0], &[0.3, 0.4]);
        assert_eq!((mean, error), (2.0, 0.25));
        assert_eq!(robust_mean(&[2.0], &[0.3]), (2.0, 0.3, 0));
        assert!(robust_mean(&[2.0], &[0.0]).1.is_nan());
    }
}

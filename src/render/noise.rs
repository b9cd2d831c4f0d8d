//! How noisy a picture is: from the scatter of the samples of its pixels, and of the strips that have something in common.

use super::estimate::Faults;

/// The luminance of a picture and how sure it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Noise {
    /// Pixels rendered.
    pub pixels: u64,
    /// Σ of the luminances.
    pub luminance: f64,
    /// Σ of the variances of the pixels' means, estimated from the scatter of their samples. Samples of a pixel are spread
    /// evenly, which this estimate does not know: it errs to the safe side. The first pixel's has the covariances of all pixels that
    /// packets are seen in, and the first row of a strip whose pixels have virtual lights in common that of their sum, the others 0: the sum over a
    /// whole picture is n² times the variance of its mean.
    pub variance: f64,
    /// Samples left out of the means.
    pub faults: Faults,
}

impl Noise {
    /// Adds that of the rows below.
    pub fn append(&mut self, later: &Self) {
        self.pixels += later.pixels;
        self.luminance += later.luminance;
        self.variance += later.variance;
        self.faults.append(&later.faults);
    }

    /// Root of the mean variance of the pixels over their mean luminance: the relative noise of the picture.
    #[must_use]
    pub fn relative(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
        let n = self.pixels.max(1) as f64;
        if self.luminance > 0.0 { (self.variance / n).sqrt() / (self.luminance / n) } else { 0.0 }
    }
}

/// The luminances of a pixel's samples: Welford's running mean and sum of squared deviations.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Gathered {
    pub(super) count: f64,
    pub(super) mean: f64,
    pub(super) squares: f64,
    /// The last one.
    last: f64,
    pub(super) faults: Faults,
}

impl Gathered {
    pub(super) fn add(&mut self, luminance: f64) {
        self.count += 1.0;
        let deviation = luminance - self.mean;
        self.mean += deviation / self.count;
        self.squares += deviation * (luminance - self.mean);
        self.last = luminance;
    }

    /// Of the mean.
    pub(super) fn variance(&self) -> f64 {
        if self.count > 1.0 { self.squares / (self.count - 1.0) / self.count } else { 0.0 }
    }
}

/// The noise of the sum of a strip's pixels, which samples of the same number have in common: half the squares of the differences between
/// each number's samples and those before.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Together {
    index: u64,
    difference: f64,
    variance: f64,
}

impl Together {
    /// A sample of a pixel that has `samples` of them, which make up a share of what is summed; those of a number come one behind the other.
    pub(super) fn add(&mut self, index: u64, before: &Gathered, luminance: f64, (samples, share): (u64, f64)) {
        if index != self.index {
            self.variance += 0.5 * self.difference * self.difference;
            (self.index, self.difference) = (index, 0.0);
        }
        if before.count > 0.0 {
            // One difference less than there are samples.
            let n = samples as f64;
            self.difference += share * (luminance - before.last) / (n * (n - 1.0)).sqrt();
        }
    }

    pub(super) fn variance(&self) -> f64 {
        self.variance + 0.5 * self.difference * self.difference
    }
}

/// Says of the rows of a strip that the variance of their sum is this one.
pub(super) fn in_common(rows: &mut [Noise], variance: f64) {
    rows.iter_mut().for_each(|row| row.variance = 0.0);
    rows[0].variance = variance;
}

//! What is read without light, how long was read, and what reading scatters.

use super::signal::Signal;
use super::{Error, Plan, Step};
use crate::finding::Finding;
use crate::spectrum::Spectrum;

/// Noise of the samples as read: u² = read² + per_unit · S + (relative · S)², in the unit of the samples.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Noise {
    /// Of a sample without light.
    pub read: f64,
    /// Variance per unit of signal: of photons counted, the samples' unit per electron. Negative samples have none.
    pub per_unit: f64,
    /// Of each sample, relative to it.
    pub relative: f64,
}

impl Noise {
    /// Standard uncertainty of each sample.
    #[must_use]
    pub fn standard(&self, samples: &[f64]) -> Vec<f64> {
        let one = |s: &f64| (self.read.powi(2) + self.per_unit * s.max(0.0) + (self.relative * s).powi(2)).sqrt();
        samples.iter().map(one).collect()
    }
}

/// A spectrum read without light, on the wavelengths of the one to be corrected.
#[derive(Debug, Clone, PartialEq)]
pub struct Dark {
    /// The samples.
    pub spectrum: Spectrum,
    /// Their standard uncertainty, where it is known.
    pub standard: Option<Vec<f64>>,
    /// Its integration time, s, where it is known.
    pub time_s: Option<f64>,
}

impl Dark {
    pub(super) fn subtract(
        &self,
        signal: &mut Signal,
        plan: &Plan,
        findings: &mut Vec<Finding>,
    ) -> Result<Step, Error> {
        let dark = self.spectrum.values();
        if self.spectrum.wavelengths_nm() != signal.wavelengths_nm() {
            let (low, high) = self.spectrum.grid().range_nm();
            return Err(Error::OtherGrid { what: "a dark spectrum", found: dark.len(), low, high });
        }
        if let (Some(of_dark), Some(time)) = (self.time_s, &plan.integration_time)
            && of_dark != time.time_s
        {
            let message = format!(
                "the dark signal was read for {of_dark} s and the light for {} s: it is subtracted as it is, which is right only for an offset that does not grow with time",
                time.time_s
            );
            findings.push(Finding::warning("X001", message).hint("read the dark signal for as long as the light"));
        }
        signal.replace(signal.values().iter().zip(dark).map(|(s, d)| s - d).collect());
        match (&self.standard, &plan.noise) {
            (Some(u), _) => signal.independent(u),
            (None, Some(noise)) => signal.independent(&noise.standard(dark)),
            (None, None) => {}
        }
        let negative = signal.values().iter().filter(|v| **v < 0.0).count();
        if negative > 0 {
            let message = format!("{negative} samples are below the dark signal; they are kept as negative samples");
            findings.push(Finding::info("X002", message));
        }
        Ok(Step::Dark { mean: dark.iter().sum::<f64>() / dark.len() as f64 })
    }
}

/// How long the detector gathered light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegrationTime {
    /// The time, s.
    pub time_s: f64,
    /// Its standard uncertainty, s.
    pub standard_s: f64,
}

impl IntegrationTime {
    /// Divides by the time; its error is common to all samples.
    pub(super) fn divide(&self, signal: &mut Signal) {
        let per_second = |s: &[f64]| s.iter().map(|v| v / self.time_s).collect::<Vec<f64>>();
        signal.replace(per_second(signal.values()));
        signal.each_mode(per_second);
        let relative = self.standard_s / self.time_s;
        signal.common(signal.values().iter().map(|v| v * relative).collect());
    }
}

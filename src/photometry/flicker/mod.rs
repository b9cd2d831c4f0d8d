//! Temporal light modulation: percent flicker and flicker index (IES), stroboscopic visibility (SVM, CIE TN 006, IEC TR 63158), and
//! short-term flicker (P_st^LM, IEC TR 61547-1, IEC 61000-4-15).
//!
//! - [`waveform`]: samples of light over time and their file.
//! - [`tones`]: sinusoids in a waveform, and the SVM that they make.
//! - [`meter`]: the light flickermeter.
//!
//! ```
//! use photopic::photometry::flicker::{evaluate, waveform::Waveform};
//!
//! // Fully modulated at 100 Hz, a second at 20 kHz: 100 %, 1/π, and 1/T(100 Hz) of the stroboscopic threshold.
//! let light = |i: u32| 1.0 + (2.0 * std::f64::consts::PI * 100.0 * f64::from(i) / 20e3).sin();
//! let figures = evaluate(&Waveform { rate_hz: 20e3, values: (0..20_000).map(light).collect() })?.value;
//! assert!((figures.percent_flicker - 100.0).abs() < 1e-6);
//! assert!((figures.flicker_index - 0.3183).abs() < 1e-4);
//! assert!((figures.svm.expect("fast enough") - 3.848).abs() < 5e-3);
//! # Ok::<(), photopic::photometry::flicker::Error>(())
//! ```

use crate::finding::{Checked, Finding};

pub mod meter;
pub mod tones;
pub mod waveform;

use tones::Tone;
use waveform::Waveform;

/// Least sampling rate of SVM, whose range ends at 2 kHz.
const SVM_RATE_HZ: f64 = 4000.0;
/// Least time of SVM, s: IEC TR 63158 wants a second; shorter ones do not part tones that are a few hertz from each other.
const SVM_TIME_S: f64 = 1.0;
/// Least sampling rate of the flickermeter.
const PST_RATE_HZ: f64 = 2000.0;
/// Time for which IEC TR 61547-1 looks at the light, s.
const PST_TIME_S: f64 = 180.0;
/// Time without which nothing is stated, s: twenty are the filters' own, and slow changes need as many again.
const PST_LEAST_TIME_S: f64 = 40.0;

/// Why a waveform has no figures.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Nothing to look at.
    #[error("{found} samples; expected at least {LEAST_SAMPLES}")]
    TooFew {
        /// Samples.
        found: usize,
    },
    /// No light on average.
    #[error("a mean of {mean}; expected positive light")]
    Dark {
        /// The mean.
        mean: f64,
    },
}

/// Least number of samples.
const LEAST_SAMPLES: usize = 16;

/// What a waveform is like.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// Mean, in the unit of the samples.
    pub mean: f64,
    /// 100 (max − min)/(max + min), %.
    pub percent_flicker: f64,
    /// Area above the mean over the whole area, 0 to 1, of whole periods where there is one.
    pub flicker_index: f64,
    /// The strongest tone from 1 Hz on.
    pub fundamental: Option<Tone>,
    /// Tones by rising frequency, those of at least a hundredth of the strongest.
    pub tones: Vec<Tone>,
    /// Stroboscopic visibility measure; 1 is seen by half of the observers.
    pub svm: Option<f64>,
    /// Short-term flicker indicator; 1 is where half of the observers are irritated.
    pub pst_lm: Option<f64>,
}

/// The figures of a waveform.
///
/// # Errors
/// [`Error`].
pub fn evaluate(light: &Waveform) -> Result<Checked<Figures>, Error> {
    let (values, rate) = (&light.values, light.rate_hz);
    if values.len() < LEAST_SAMPLES {
        return Err(Error::TooFew { found: values.len() });
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    if mean.is_nan() || mean <= 0.0 {
        return Err(Error::Dark { mean });
    }
    let mut findings = Vec::new();
    let seconds = values.len() as f64 / rate;
    let all = tones::find(light, mean);
    let strongest =
        all.iter().copied().filter(|t| t.frequency_hz >= 1.0).max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    // Of a fraction of a period the mean, and with it the index, would depend on where it was cut.
    let period = strongest.map(|t| rate / t.frequency_hz).filter(|p| *p >= 2.0);
    let whole = period.map_or(values.len(), |p| ((values.len() as f64 / p).floor() * p).round() as usize);
    let cut = &values[..whole.clamp(1, values.len())];
    let level = cut.iter().sum::<f64>() / cut.len() as f64;
    let above: f64 = cut.iter().map(|v| (v - level).max(0.0)).sum();
    let (low, high) = values.iter().fold((f64::INFINITY, 0f64), |(l, h), v| (l.min(*v), h.max(*v)));
    if low < 0.0 {
        let message =
            format!("samples down to {low}: light is not negative, an offset raises percent flicker above 100 %");
        findings.push(Finding::warning("F001", message).hint("subtract the dark signal of the receiver"));
    }
    let svm = (rate >= SVM_RATE_HZ && seconds >= SVM_TIME_S).then(|| tones::svm(&all));
    if svm.is_none() {
        let message =
            format!("no SVM of {seconds:.3} s at {rate:.0} Hz; expected at least {SVM_TIME_S} s at {SVM_RATE_HZ} Hz");
        findings.push(Finding::info("F002", message));
    }
    let pst_lm = (rate >= PST_RATE_HZ && seconds >= PST_LEAST_TIME_S).then(|| meter::pst_lm(light, mean));
    if pst_lm.is_none() {
        let message = format!(
            "no Pst LM of {seconds:.1} s at {rate:.0} Hz; expected {PST_TIME_S} s (at least {PST_LEAST_TIME_S} s) at {PST_RATE_HZ} Hz"
        );
        findings.push(Finding::info("F003", message));
    } else if seconds < PST_TIME_S {
        let message = format!("Pst LM rests on {seconds:.0} s; IEC TR 61547-1 wants {PST_TIME_S} s");
        findings.push(Finding::warning("F004", message));
    }
    let least = strongest.map_or(0.0, |t| 0.01 * t.amplitude);
    let value = Figures {
        mean,
        percent_flicker: 100.0 * (high - low) / (high + low),
        flicker_index: above / cut.iter().sum::<f64>(),
        fundamental: strongest,
        tones: all.into_iter().filter(|t| t.amplitude >= least && least > 0.0).collect(),
        svm,
        pst_lm,
    };
    Ok(Checked { value, findings })
}

#[cfg(test)]
mod tests;

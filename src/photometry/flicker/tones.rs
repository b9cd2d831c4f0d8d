//! Sinusoids in a waveform and how visible they are.

use super::waveform::Waveform;
use crate::math::fft;

/// Longest record that is transformed at once: tones are then told apart to a hundredth of a hertz at 20 kHz.
const LONGEST: usize = 1 << 21;
/// Amplitudes below this are the rounding of the transform.
const ROUNDING: f64 = 1e-9;
/// Range of SVM, Hz (CIE TN 006).
const SVM_HZ: (f64, f64) = (80.0, 2000.0);
/// Exponent of Minkowski's sum in SVM.
const MINKOWSKI: f64 = 3.7;

/// A sinusoid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tone {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude over the mean: 1 is full modulation.
    pub amplitude: f64,
}

/// The tones of a waveform by rising frequency.
///
/// Peaks of the spectrum under a Hann window; with |X_k| the highest and r the ratio of its larger neighbour to it, a sinusoid stands
/// δ = (2r − 1)/(r + 1) bins beside k, and its amplitude is |X_k| · 2πδ(1 − δ²)/sin πδ over half of the window's sum. Exact for tones more than a
/// few bins from others and from zero. The longest power of two of samples from the beginning counts.
#[must_use]
pub fn find(light: &Waveform, mean: f64) -> Vec<Tone> {
    let n = 1 << light.values.len().min(LONGEST).ilog2();
    let window = |i: usize| 0.5 - 0.5 * (2.0 * std::f64::consts::PI * i as f64 / n as f64).cos();
    let mut samples: Vec<[f64; 2]> =
        light.values[..n].iter().enumerate().map(|(i, v)| [window(i) * (v / mean - 1.0), 0.0]).collect();
    fft::transform(&mut samples);
    // The window sums to n/2; a sinusoid of amplitude 1 shows half of that.
    let size: Vec<f64> = samples[..=n / 2].iter().map(|[re, im]| re.hypot(*im) * 4.0 / n as f64).collect();
    let mut out = Vec::new();
    for k in 2..n / 2 {
        let (before, here, after) = (size[k - 1], size[k], size[k + 1]);
        if here < ROUNDING || here < before || here <= after {
            continue;
        }
        let (side, larger) = if after > before { (1.0, after) } else { (-1.0, before) };
        let ratio = larger / here;
        let delta = ((2.0 * ratio - 1.0) / (ratio + 1.0)).clamp(0.0, 0.5);
        let angle = std::f64::consts::PI * delta;
        let lobe = if delta < 1e-9 { 1.0 } else { angle.sin() / (angle * (1.0 - delta * delta)) };
        out.push(Tone { frequency_hz: (k as f64 + side * delta) * light.rate_hz / n as f64, amplitude: here / lobe });
    }
    out
}

/// Contrast at which a sinusoid of a frequency (Hz) is just seen to be stroboscopic: 2.865e-5 f^1.543 + 0.225 (Perz et al. 2018, IEC TR 63158).
#[must_use]
pub fn stroboscopic_threshold(frequency_hz: f64) -> f64 {
    2.865e-5 * frequency_hz.powf(1.543) + 0.225
}

/// The stroboscopic visibility measure of tones: (Σ (C/T)^3.7)^(1/3.7) from 80 to 2000 Hz (CIE TN 006:2016).
#[must_use]
pub fn svm(tones: &[Tone]) -> f64 {
    let seen = tones.iter().filter(|t| (SVM_HZ.0..=SVM_HZ.1).contains(&t.frequency_hz));
    let sum: f64 = seen.map(|t| (t.amplitude / stroboscopic_threshold(t.frequency_hz)).powf(MINKOWSKI)).sum();
    sum.powf(1.0 / MINKOWSKI)
}

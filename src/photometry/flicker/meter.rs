//! The light flickermeter of IEC TR 61547-1: blocks 3 to 5 of IEC 61000-4-15 behind light instead of a voltage and a lamp.
//!
//! The light over its mean passes a high-pass of 0.05 Hz and a Butterworth low-pass of sixth order at 35 Hz, the response of eye and brain
//!
//! ```text
//! H(s) = (0.041661 s⁴ + 44.758 s³ + 2715.6 s² + 29839 s)/(s⁴ + 196.32 s³ + 11781 s² + 534820 s + 3505380),
//! ```
//!
//! is squared, smoothed with 0.3 s and scaled by 1.101603e6. P_st = √(0.0314 P₀.₁ + 0.0525 P₁ₛ + 0.0657 P₃ₛ + 0.28 P₁₀ₛ + 0.08 P₅₀ₛ) of the levels exceeded
//! for so many per cent of the time.

use std::f64::consts::PI;

use nalgebra::DMatrix;

use super::waveform::Waveform;

const EYE_NUMERATOR: [f64; 5] = [0.041_661, 44.758, 2715.6, 29839.0, 0.0];
const EYE_DENOMINATOR: [f64; 5] = [1.0, 196.32, 11781.0, 534_820.0, 3_505_380.0];
/// From the square of the filtered light to perceptibility.
const SCALE: f64 = 1.101_603_155_420_234e6;
const SMOOTHING_S: f64 = 0.3;
const HIGH_PASS_HZ: f64 = 0.05;
const LOW_PASS_HZ: f64 = 35.0;
/// What the filters need to forget the beginning, s.
const SETTLING_S: f64 = 20.0;

/// A linear system of N states on sampled input, by the trapezoidal rule: unlike polynomials in z its states keep their digits at any
/// sampling rate.
struct Filter<const N: usize> {
    step: [[f64; N]; N],
    drive: [f64; N],
    output: [f64; N],
    through: f64,
    state: [f64; N],
    before: f64,
}

impl<const N: usize> Filter<N> {
    /// Of (b₀ s^N + … + b_N)/(s^N + a₁ s^(N−1) + … + a_N), time in s, at a sampling rate.
    fn new(numerator: &[f64], denominator: &[f64], rate_hz: f64) -> Self {
        // In units of time in which the states are of one size.
        let unit = denominator[N].abs().powf(1.0 / N as f64);
        let scaled = |c: &[f64], k: usize| c[k] / unit.powi(k as i32);
        let half = 0.5 * unit / rate_hz;
        // States x, x′, x″, …; the last one's derivative is driven.
        let system = DMatrix::from_fn(N, N, |r, c| match r {
            _ if r + 1 == N => -scaled(denominator, N - c),
            _ => f64::from(u8::from(c == r + 1)),
        });
        let identity = DMatrix::identity(N, N);
        // The poles are left of the imaginary axis: 1 is no eigenvalue of half a step.
        let inverse = (&identity - &system * half).try_inverse().unwrap_or(identity.clone());
        let step = &inverse * (&identity + &system * half);
        Self {
            step: std::array::from_fn(|r| std::array::from_fn(|c| step[(r, c)])),
            drive: std::array::from_fn(|r| inverse[(r, N - 1)] * half),
            output: std::array::from_fn(|c| scaled(numerator, N - c) - numerator[0] * scaled(denominator, N - c)),
            through: numerator[0],
            state: [0.0; N],
            before: 0.0,
        }
    }

    fn next(&mut self, input: f64) -> f64 {
        let driven = input + self.before;
        self.before = input;
        self.state = std::array::from_fn(|r| {
            let kept: f64 = self.step[r].iter().zip(&self.state).map(|(a, x)| a * x).sum();
            kept + self.drive[r] * driven
        });
        self.through * input + self.output.iter().zip(&self.state).map(|(c, x)| c * x).sum::<f64>()
    }
}

/// The frequency whose image under the trapezoidal rule is the one wanted, rad/s.
fn warped(frequency_hz: f64, rate_hz: f64) -> f64 {
    2.0 * rate_hz * (PI * frequency_hz / rate_hz).tan()
}

/// Instantaneous flicker sensation, one value per sample.
fn sensation(light: &Waveform, mean: f64) -> Vec<f64> {
    let rate = light.rate_hz;
    let high = warped(HIGH_PASS_HZ, rate);
    let mut high_pass = Filter::<1>::new(&[1.0, 0.0], &[1.0, high], rate);
    let low = warped(LOW_PASS_HZ, rate);
    // Butterworth's poles, in pairs: s² + 2 sin((2k − 1)π/12) ω s + ω².
    let mut low_pass = [1.0, 3.0, 5.0].map(|k| {
        let damping = 2.0 * (k * PI / 12.0).sin();
        Filter::<2>::new(&[0.0, 0.0, low * low], &[1.0, damping * low, low * low], rate)
    });
    let mut eye = Filter::<4>::new(&EYE_NUMERATOR, &EYE_DENOMINATOR, rate);
    let mut smooth = Filter::<1>::new(&[0.0, 1.0 / SMOOTHING_S], &[1.0, 1.0 / SMOOTHING_S], rate);
    let one = |v: &f64| {
        let mut signal = high_pass.next(v / mean - 1.0);
        for filter in &mut low_pass {
            signal = filter.next(signal);
        }
        SCALE * smooth.next(eye.next(signal).powi(2))
    };
    light.values.iter().map(one).collect()
}

/// The short-term flicker indicator of light; the first 20 s are left to the filters. Without more than that it is NaN.
#[must_use]
pub fn pst_lm(light: &Waveform, mean: f64) -> f64 {
    let mut levels = sensation(light, mean);
    levels.drain(..((SETTLING_S * light.rate_hz) as usize).min(levels.len()));
    if levels.is_empty() {
        return f64::NAN;
    }
    levels.sort_by(f64::total_cmp);
    // Straight lines between neighbours in order: there are thousands of them in each of the steps asked for.
    let exceeded = |percent: f64| {
        let place = (levels.len() - 1) as f64 * (1.0 - percent / 100.0);
        let below = place as usize;
        let above = levels[(below + 1).min(levels.len() - 1)];
        levels[below] + (place - below as f64) * (above - levels[below])
    };
    let smoothed = |all: &[f64]| all.iter().map(|p| exceeded(*p)).sum::<f64>() / all.len() as f64;
    let sum = 0.0314 * exceeded(0.1)
        + 0.0525 * smoothed(&[0.7, 1.0, 1.5])
        + 0.0657 * smoothed(&[2.2, 3.0, 4.0])
        + 0.28 * smoothed(&[6.0, 8.0, 10.0, 13.0, 17.0])
        + 0.08 * smoothed(&[30.0, 50.0, 80.0]);
    sum.max(0.0).sqrt()
}

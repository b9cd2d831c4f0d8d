//! The spectra that every benchmark here and in `peers/` converts: white LEDs, each different, and what independent
//! programs make of them.
//!
//! Spectrum i is a blue peak and a phosphor, on 380–780 nm by 5 nm:
//!
//! ```text
//! S(λ) = (0.1 + 1.6 {0.61803398875 i}) exp(−½((λ − 450)/10)²) + exp(−½((λ − 560 − 40 {0.7548776662 i})/55)²)
//! ```
//!
//! `{x}` being the part of x after the point. `scripts/bench_peers.py` makes the same ones and prints the means below.

#![allow(dead_code, reason = "each benchmark uses its own part")]

use std::sync::Arc;

use photopic::spectrum::Grid;

/// Samples of one spectrum.
pub const SAMPLES: usize = 81;
/// Means of X, Y, Z (CIE 1931, summation by 5 nm, no factor) over the first 100 000 spectra: numpy on the tables of
/// colour-science 0.4.7.
pub const MEAN_XYZ: [f64; 3] = [81.219_679_95, 81.343_643_96, 49.665_132_85];
/// X, Y, Z of the last of them.
pub const LAST_XYZ: [f64; 3] = [78.478_552_595_221_09, 86.443_743_324_246_4, 77.286_597_762_949_04];
/// Mean correlated colour temperature of the first 10 000, K: the same, by the secant method on its own sums over the locus.
pub const MEAN_CCT: f64 = 4_050.843_64;
/// Mean Ra of the first 1000: colour-science 0.4.7, which resamples and so agrees to 0.2.
pub const MEAN_RA: f64 = 73.416_2;
/// Mean Rf of the first 100: colour-science 0.4.7, to 0.02.
pub const MEAN_RF: f64 = 75.669_7;

/// Side of the square image, in pixels; pixel i from the left and then the top has spectrum i.
pub const IMAGE_SIZE: usize = 1024;
/// Its bands, 400 to 700 nm by 10 nm.
pub const IMAGE_BANDS: usize = 31;
/// Mean of its Y (CIE 1931, summation by 10 nm, no factor): numpy on the tables of colour-science 0.4.7.
pub const MEAN_IMAGE_Y: f64 = 81.344_021_78;

/// 380 to 780 nm by 5 nm.
pub fn grid() -> Arc<Grid> {
    Arc::new(Grid::uniform(380.0, 5.0, SAMPLES).expect("ascending"))
}

/// The first `count` spectra, one after the other.
pub fn rows(count: usize) -> Vec<f64> {
    spectra_at(380.0, 5.0, SAMPLES).take(count).flatten().collect()
}

/// The spectra on `samples` wavelengths from `start_nm` by `step_nm`, without end.
pub fn spectra_at(start_nm: f64, step_nm: f64, samples: usize) -> impl Iterator<Item = impl Iterator<Item = f64>> {
    let bell = |x: f64| (-0.5 * x * x).exp();
    (0_usize..).map(move |i| {
        let part = |step: f64| (step * i as f64).fract();
        let (blue, peak) = (0.1 + 1.6 * part(0.618_033_988_75), 560.0 + 40.0 * part(0.754_877_666_2));
        (0..samples).map(move |k| {
            let wavelength = start_nm + step_nm * k as f64;
            blue * bell((wavelength - 450.0) / 10.0) + bell((wavelength - peak) / 55.0)
        })
    })
}

/// Asserts that the mean of `values` is `want` to within `tolerance`.
pub fn assert_mean(values: &[f64], want: f64, tolerance: f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    assert!((mean - want).abs() <= tolerance, "a mean of {mean:.10}, expected {want} ± {tolerance:e}");
}

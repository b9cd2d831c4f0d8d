//! The inner loop: rounded once, and what sums in `f32` would cost.

use photopic::image::kernel::Weights;
use photopic::photometry::luminous::Efficiency;
use photopic::spectrum::integrate::{Contract, weights};
use photopic::spectrum::{Grid, Sampling};
use proptest::prelude::*;

/// Σ wᵢvᵢ in `f64` from the last term to the first, an order that the kernel does not use, and Σ |wᵢvᵢ|.
fn exact(weights: &[f64], values: impl DoubleEndedIterator<Item = f32>) -> (f64, f64) {
    let terms = weights.iter().rev().zip(values.rev()).map(|(w, v)| w * f64::from(v));
    terms.fold((0.0, 0.0), |(sum, size), t| (sum + t, size + t.abs()))
}

proptest! {
    /// Any number of channels, outputs and pixels: the result is the exact sum rounded to the nearest float, but for the
    /// rounding of the weights to 29 bits, 2⁻²⁹ of the sum of magnitudes, and of the f64 sum itself, channels · 2⁻⁵³ of it.
    #[test]
    fn sums_are_exact_to_the_float(
        channels in 1_usize..40,
        outputs in 1_usize..10,
        width in 1_usize..100,
        seed in any::<u64>(),
    ) {
        let random = |i: u64| {
            let mixed = (seed ^ i).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            ((mixed ^ (mixed >> 31)).wrapping_mul(0x94d0_49bb_1331_11eb) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let columns: Vec<Vec<f64>> =
            (0..outputs).map(|k| (0..channels).map(|c| random((k * 64 + c) as u64)).collect()).collect();
        let row: Vec<f32> = (0..channels * width).map(|i| random(10_000 + i as u64) as f32).collect();
        let stride = width + 3;
        let mut out = vec![f32::NAN; outputs * stride];
        Weights::new(&columns).apply(&row, width, &mut out, stride);
        for (k, column) in columns.iter().enumerate() {
            for x in 0..width {
                let (want, size) = exact(column, row[x..].iter().step_by(width).copied().collect::<Vec<_>>().into_iter());
                let got = f64::from(out[k * stride + x]);
                let bound = f64::from(f32::EPSILON) / 2.0 * want.abs()
                    + (2.0_f64.powi(-29) + channels as f64 * f64::EPSILON) * size;
                prop_assert!((got - want).abs() <= bound, "{k} {x}: {got} {want}");
            }
            prop_assert!(out[k * stride + width..(k + 1) * stride].iter().all(|v| v.is_nan()), "the gap is left alone");
        }
    }
}

/// Weights of 29 bits times samples of 24 are exact, so the bits are those of a plain loop in `f64`, whatever instructions the
/// processor has; denormals and the smallest and largest numbers too.
#[test]
#[expect(clippy::cast_possible_truncation, reason = "sums are rounded to pixels")]
fn results_are_the_bits_of_a_plain_loop() {
    let mixed = |i: usize| (i as u32).wrapping_mul(2_654_435_761).rotate_left(11).wrapping_mul(2_246_822_519);
    let (channels, width) = (31, 77);
    let column = |k: usize| (0..channels).map(move |c| f64::from(mixed(k * 64 + c) >> 3) - 2.5e8).collect::<Vec<f64>>();
    let columns: Vec<Vec<f64>> = (0..3).map(column).collect();
    let finite = |bits: u32| Some(f32::from_bits(bits)).filter(|v| v.abs() < 1e28).unwrap_or(1e-42);
    let row: Vec<f32> = (0..channels * width).map(|i| finite(mixed(1000 + i))).collect();
    let mut out = vec![0.0; 3 * width];
    Weights::new(&columns).apply(&row, width, &mut out, width);
    for (k, column) in columns.iter().enumerate() {
        for x in 0..width {
            let terms = column.iter().enumerate().map(|(c, w)| w * f64::from(row[c * width + x]));
            let want = terms.fold(0.0, |sum, term| sum + term) as f32;
            assert_eq!(out[k * width + x].to_bits(), want.to_bits(), "{k} {x}");
        }
    }
}

/// Y of 20 000 spectra of 471 bands (1 nm) with weights and sums in `f32` instead: the largest relative error exceeds the 1e-6
/// that the agreement with `convert` allows (1.6e-6 with numpy's `float32` in the same order; 4e-7 for 48 bands of 10 nm, 6e-7
/// for 95 of 5 nm). This is why the kernel sums in `f64`.
#[test]
#[expect(clippy::cast_possible_truncation, reason = "that is what is tried")]
fn sums_in_f32_would_not_do() {
    let grid = Grid::uniform(360.0, 1.0, 471).expect("ascending");
    let y = Efficiency::Cie1924.weighting();
    let column = weights(&grid, Sampling::Density, &y, &Contract::default()).expect("a rule");
    let mut worst = 0.0_f64;
    for n in 0..20_000_u32 {
        let value = |i: u32| {
            let mixed = n.wrapping_mul(2_654_435_761).wrapping_add(i.wrapping_mul(40_503)).wrapping_mul(2_246_822_519);
            (mixed >> 8) as f32 / (1 << 24) as f32
        };
        let (want, _) = exact(&column, (0..471).map(value).collect::<Vec<_>>().into_iter());
        let single: f32 = column.iter().zip(0..471).map(|(w, i)| *w as f32 * value(i)).sum();
        worst = worst.max((f64::from(single) / want - 1.0).abs());
    }
    assert!(worst > 1e-6, "{worst}");
}

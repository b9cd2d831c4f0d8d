//! The inner loop of every conversion: weighted sums of channels, pixel by pixel.
//!
//! For each output k and pixel x of a row, `out[k][x] = Σ_c weight[k][c] · row[c][x]`. Weights and sums are `f64`: sums in `f32`
//! are off by up to 4e-7 for 48 bands and 1.6e-6 for 471 (`tests/image/kernel.rs`), more than the whole agreement asked for; in
//! `f64` nothing is left but the rounding of the samples and of the result to `f32`, 6e-8 each. Products and sums are rounded
//! one after the other on every processor, so that results are the same bits everywhere.
//!
//! Pixels go through in blocks whose sums stay in vector registers. The instruction set is chosen at run time (crate `pulp`).

use pulp::{Arch, Simd, WithSimd};

/// Pixels whose sums are kept in registers at a time.
const LANES: usize = 8;
/// Outputs summed in one pass over a row; more take further passes, over samples that the cache then holds.
const OUTPUTS: usize = 4;

/// The weight of each channel in each output.
#[derive(Debug, Clone, PartialEq)]
pub struct Weights {
    channels: usize,
    outputs: usize,
    /// The outputs in groups of up to [`OUTPUTS`]; of each group by channel, then output.
    groups: Vec<Vec<f64>>,
}

impl Weights {
    /// The weights of each output, one per channel.
    ///
    /// # Panics
    /// Where outputs differ in their number of channels.
    #[must_use]
    pub fn new(columns: &[Vec<f64>]) -> Self {
        let channels = columns.first().map_or(0, Vec::len);
        assert!(columns.iter().all(|c| c.len() == channels), "all outputs are of the same channels");
        let group = |columns: &[Vec<f64>]| (0..channels).flat_map(|i| columns.iter().map(move |c| c[i])).collect();
        Self { channels, outputs: columns.len(), groups: columns.chunks(OUTPUTS).map(group).collect() }
    }

    /// Number of outputs.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Sums one row: `row` holds its channels one after the other, each `width` long; output k goes to `width` samples of `out`
    /// from `k · stride`.
    ///
    /// # Panics
    /// Where `row` or `out` is too short.
    pub fn apply(&self, row: &[f32], width: usize, out: &mut [f32], stride: usize) {
        assert!(row.len() >= self.channels * width && stride >= width, "a row of all channels");
        Arch::new().dispatch(Sums { weights: self, row, width, out, stride });
    }
}

/// One call of [`Weights::apply`], compiled once per instruction set.
struct Sums<'a> {
    weights: &'a Weights,
    row: &'a [f32],
    width: usize,
    out: &'a mut [f32],
    stride: usize,
}

impl WithSimd for Sums<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut first = 0;
        for group in &self.weights.groups {
            let out = &mut self.out[first * self.stride..];
            let outputs = (self.weights.outputs - first).min(OUTPUTS);
            match outputs {
                1 => sums::<1>(group, self.row, self.width, out, self.stride),
                2 => sums::<2>(group, self.row, self.width, out, self.stride),
                3 => sums::<3>(group, self.row, self.width, out, self.stride),
                _ => sums::<OUTPUTS>(group, self.row, self.width, out, self.stride),
            }
            first += outputs;
        }
    }
}

/// `N` outputs of one row.
#[inline(always)]
fn sums<const N: usize>(weights: &[f64], row: &[f32], width: usize, out: &mut [f32], stride: usize) {
    let (weights, _) = weights.as_chunks::<N>();
    let whole = width / LANES * LANES;
    for x in (0..whole).step_by(LANES) {
        let mut sums = [[0.0_f64; LANES]; N];
        for (weight, channel) in weights.iter().zip(row.chunks_exact(width)) {
            let samples = channel[x..].first_chunk::<LANES>().unwrap_or(&[0.0; LANES]);
            let samples = samples.map(f64::from);
            for (sum, weight) in sums.iter_mut().zip(weight) {
                for (sum, sample) in sum.iter_mut().zip(samples) {
                    *sum += weight * sample;
                }
            }
        }
        for (k, sums) in sums.iter().enumerate() {
            store(sums, &mut out[k * stride + x..]);
        }
    }
    for x in whole..width {
        let mut sums = [0.0_f64; N];
        for (weight, channel) in weights.iter().zip(row.chunks_exact(width)) {
            for (sum, weight) in sums.iter_mut().zip(weight) {
                *sum += weight * f64::from(channel[x]);
            }
        }
        for (k, sum) in sums.iter().enumerate() {
            store(&[*sum], &mut out[k * stride + x..]);
        }
    }
}

#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "pixels are f32; sums are rounded once, here")]
fn store(sums: &[f64], out: &mut [f32]) {
    for (out, sum) in out.iter_mut().zip(sums) {
        *out = *sum as f32;
    }
}

//! The inner loop of every conversion: weighted sums of channels, pixel by pixel.
//!
//! For each output k and pixel x of a row, `out[k][x] = Σ_c weight[k][c] · row[c][x]`. Weights and sums are `f64`: sums in `f32`
//! are off by up to 4e-7 for 48 bands and 1.6e-6 for 471 (`tests/image/kernel.rs`), more than the whole agreement asked for; in
//! `f64` nothing is left but the rounding of the samples and of the result to `f32`, 6e-8 each. Products and sums are rounded
//! one after the other on every processor, so that results are the same bits everywhere.
//!
//! One output reads its channels one after the other, in one stream from memory: as fast as reading can be. Several outputs are
//! summed in one pass over short runs of six channels at a time, which loads and stores their sums less often: the sums of three
//! outputs and the runs just fit the first cache. Three outputs of 31 bands take 12 ms where reading alone takes 6 (`benches/image.rs`,
//! one core with AVX-512), and what is left is waiting for memory. Tried beside it: fused multiplication, longer runs, four or eight
//! channels at a time, partial sums of eight channels in `f32`, the sums in registers over all channels (which lie a power of two
//! apart), explicit vectors, reading and prefetching ahead. In safe code none saved more than a sixth; AVX-512 by hand took 9 ms.
//! The instruction set is chosen at run time (crate `pulp`).

use pulp::{Arch, Simd, WithSimd};

/// Pixels of which the sums of one output are kept at a time, in the first cache.
const BLOCK: usize = 1024;
/// The same of several outputs.
const SHORT_BLOCK: usize = 512;
/// Channels added to the sums of several outputs in one go.
const AT_ONCE: usize = 6;
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
                1 => one(group, self.row, self.width, out),
                2 => several::<2>(group, self.row, self.width, out, self.stride),
                3 => several::<3>(group, self.row, self.width, out, self.stride),
                _ => several::<OUTPUTS>(group, self.row, self.width, out, self.stride),
            }
            first += outputs;
        }
    }
}

/// One output of a row.
#[inline(always)]
fn one(weights: &[f64], row: &[f32], width: usize, out: &mut [f32]) {
    for x in (0..width).step_by(BLOCK) {
        let count = BLOCK.min(width - x);
        let mut sums = [0.0_f64; BLOCK];
        for (channel, weight) in row.chunks_exact(width).zip(weights) {
            for (sum, sample) in sums.iter_mut().zip(&channel[x..x + count]) {
                *sum += weight * f64::from(*sample);
            }
        }
        store(&sums[..count], &mut out[x..]);
    }
}

/// `N` outputs of a row.
#[inline(always)]
fn several<const N: usize>(weights: &[f64], row: &[f32], width: usize, out: &mut [f32], stride: usize) {
    let (weights, _) = weights.as_chunks::<N>();
    let (full, rest) = weights.as_chunks::<AT_ONCE>();
    for x in (0..width).step_by(SHORT_BLOCK) {
        let count = SHORT_BLOCK.min(width - x);
        let channel = |c: usize| &row[c * width + x..][..count];
        let mut sums = [[0.0_f64; SHORT_BLOCK]; N];
        for (i, weights) in full.iter().enumerate() {
            add(&mut sums, std::array::from_fn(|j| channel(AT_ONCE * i + j)), weights);
        }
        for (i, weights) in rest.iter().enumerate() {
            add(&mut sums, [channel(AT_ONCE * full.len() + i)], std::array::from_ref(weights));
        }
        for (k, sums) in sums.iter().enumerate() {
            store(&sums[..count], &mut out[k * stride + x..]);
        }
    }
}

/// Adds `C` channels of a block, one after the other. The loop over pixels is the one that becomes vector code.
#[inline(always)]
fn add<const N: usize, const C: usize>(
    sums: &mut [[f64; SHORT_BLOCK]; N],
    channels: [&[f32]; C],
    weights: &[[f64; N]; C],
) {
    for x in 0..channels[0].len().min(SHORT_BLOCK) {
        for k in 0..N {
            let mut sum = sums[k][x];
            for c in 0..C {
                sum += weights[c][k] * f64::from(channels[c][x]);
            }
            sums[k][x] = sum;
        }
    }
}

#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "pixels are f32; sums are rounded once, here")]
fn store(sums: &[f64], out: &mut [f32]) {
    out[..sums.len()].iter_mut().zip(sums).for_each(|(out, sum)| *out = *sum as f32);
}

//! The inner loop of every conversion: weighted sums of channels, pixel by pixel.
//!
//! For each output k and pixel x of a row, `out[k][x] = Σ_c weight[k][c] · row[c][x]`, summed in `f64` in the order of the
//! channels: sums in `f32` are off by up to 4e-7 for 48 bands and 1.6e-6 for 471 (`tests/image/kernel.rs`), more than the whole
//! agreement asked for.
//!
//! Weights are kept to 29 significant bits, 1.9e-9 of each, so that their products with samples of 24 bits are exact in `f64`.
//! Then a fused multiplication and addition gives what a product and a sum give one after the other, and results are the same
//! bits on every processor, whatever its instructions.
//!
//! The sums of some pixels stay in registers while their samples of all channels pass by. Those lie a row apart, in more places
//! than a processor foresees by itself, so it is told of what comes next (`AHEAD`). Three outputs of 31 bands then take
//! little longer than reading alone (`benches/image.rs`, docs/speed.md); without being told they take three times as long.
//! The instruction set is chosen at run time (crate `pulp`).

#[cfg(target_arch = "x86_64")]
use pulp::x86::{V3, V4};
use pulp::{Arch, NullaryFnOnce};

/// Outputs summed in one pass over a row; more take further passes, over samples that the cache then holds.
const OUTPUTS: usize = 4;
/// Vectors of pixels summed at a time: 12 registers for three outputs.
const VECTORS: usize = 4;
/// Samples of all channels between what is summed and what is called for, 64 KiB: longer than memory takes to answer, and a small
/// part of the second cache, where it is put. The first would lose it again: places a power of two apart share its lines.
const AHEAD: usize = 16_384;
/// Samples in a line of the cache.
const LINE: usize = 16;
/// The hint `prefetcht1`.
#[cfg(target_arch = "x86_64")]
const SECOND_CACHE: i32 = std::arch::x86_64::_MM_HINT_T1;

/// The weight of each channel in each output.
#[derive(Debug, Clone, PartialEq)]
pub struct Weights {
    channels: usize,
    outputs: usize,
    /// The outputs in groups of up to [`OUTPUTS`]; of each group by channel, then output.
    groups: Vec<Vec<f64>>,
}

impl Weights {
    /// The weights of each output, one per channel, rounded to 29 bits.
    ///
    /// # Panics
    /// Where outputs differ in their number of channels.
    #[must_use]
    pub fn new(columns: &[Vec<f64>]) -> Self {
        let channels = columns.first().map_or(0, Vec::len);
        assert!(columns.iter().all(|c| c.len() == channels), "all outputs are of the same channels");
        let group =
            |columns: &[Vec<f64>]| (0..channels).flat_map(|i| columns.iter().map(move |c| short(c[i]))).collect();
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
        let sums = Sums { weights: self, row, width, out, stride };
        #[cfg(target_arch = "x86_64")]
        {
            if let Some(v4) = V4::try_new() {
                return v4.vectorize(Compiled::<_, 8> { sums, processor: v4 });
            }
            if let Some(v3) = V3::try_new() {
                return v3.vectorize(Compiled::<_, 4> { sums, processor: v3 });
            }
        }
        Arch::new().dispatch(Compiled::<_, 4> { sums, processor: Any });
    }
}

/// The weight to 29 significant bits, to the nearest.
///
/// Source: T. J. Dekker, *A Floating-Point Technique for Extending the Available Precision*, Numer. Math. 18 (1971): the high
/// part of 53 − 24 bits.
fn short(weight: f64) -> f64 {
    let shifted = weight * 16_777_217.0; // 2²⁴ + 1
    shifted - (shifted - weight)
}

/// Arithmetic with `LANES` pixels at a time.
trait Processor<const LANES: usize>: Copy {
    /// As many numbers in `f64`.
    type Vector: Copy;

    /// The same number in all lanes.
    fn splat(self, value: f64) -> Self::Vector;
    /// Samples in `f64`.
    fn widen(self, samples: &[f32; LANES]) -> Self::Vector;
    /// `weight · sample + sum`. The product is exact, so that it does not matter whether it is rounded.
    fn add_product(self, weight: Self::Vector, sample: Self::Vector, sum: Self::Vector) -> Self::Vector;
    /// To the nearest `f32`.
    fn narrow(self, sums: Self::Vector) -> [f32; LANES];
    /// Says that an address will be read. It need not be one that may be.
    fn call_for(self, address: *const i8);
}

#[cfg(target_arch = "x86_64")]
impl Processor<8> for V4 {
    type Vector = pulp::f64x8;

    #[inline(always)]
    fn splat(self, value: f64) -> Self::Vector {
        self.splat_f64x8(value)
    }

    #[inline(always)]
    fn widen(self, samples: &[f32; 8]) -> Self::Vector {
        self.convert_f32x8_to_f64x8(pulp::cast(*samples))
    }

    #[inline(always)]
    fn add_product(self, weight: Self::Vector, sample: Self::Vector, sum: Self::Vector) -> Self::Vector {
        self.mul_add_f64x8(weight, sample, sum)
    }

    #[inline(always)]
    fn narrow(self, sums: Self::Vector) -> [f32; 8] {
        pulp::cast(self.convert_f64x8_to_f32x8(sums))
    }

    #[inline(always)]
    fn call_for(self, address: *const i8) {
        self.sse._mm_prefetch::<SECOND_CACHE>(address);
    }
}

#[cfg(target_arch = "x86_64")]
impl Processor<4> for V3 {
    type Vector = pulp::f64x4;

    #[inline(always)]
    fn splat(self, value: f64) -> Self::Vector {
        self.splat_f64x4(value)
    }

    #[inline(always)]
    fn widen(self, samples: &[f32; 4]) -> Self::Vector {
        self.convert_f32x4_to_f64x4(pulp::cast(*samples))
    }

    #[inline(always)]
    fn add_product(self, weight: Self::Vector, sample: Self::Vector, sum: Self::Vector) -> Self::Vector {
        self.mul_add_f64x4(weight, sample, sum)
    }

    #[inline(always)]
    fn narrow(self, sums: Self::Vector) -> [f32; 4] {
        pulp::cast(self.convert_f64x4_to_f32x4(sums))
    }

    #[inline(always)]
    fn call_for(self, address: *const i8) {
        self.sse._mm_prefetch::<SECOND_CACHE>(address);
    }
}

/// A processor of which nothing is known.
#[derive(Clone, Copy)]
struct Any;

impl<const LANES: usize> Processor<LANES> for Any {
    type Vector = [f64; LANES];

    #[inline(always)]
    fn splat(self, value: f64) -> Self::Vector {
        [value; LANES]
    }

    #[inline(always)]
    fn widen(self, samples: &[f32; LANES]) -> Self::Vector {
        samples.map(f64::from)
    }

    #[inline(always)]
    fn add_product(self, weight: Self::Vector, sample: Self::Vector, sum: Self::Vector) -> Self::Vector {
        std::array::from_fn(|i| sum[i] + weight[i] * sample[i])
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "pixels are f32; sums are rounded once, here")]
    fn narrow(self, sums: Self::Vector) -> [f32; LANES] {
        sums.map(|sum| sum as f32)
    }

    #[inline(always)]
    fn call_for(self, _: *const i8) {}
}

/// One call of [`Weights::apply`].
struct Sums<'a> {
    weights: &'a Weights,
    row: &'a [f32],
    width: usize,
    out: &'a mut [f32],
    stride: usize,
}

/// The same, compiled for a processor whose registers hold `LANES` sums each.
struct Compiled<'a, P, const LANES: usize> {
    sums: Sums<'a>,
    processor: P,
}

impl<P: Processor<LANES>, const LANES: usize> NullaryFnOnce for Compiled<'_, P, LANES> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { sums: Sums { weights, row, width, out, stride }, processor } = self;
        let mut first = 0;
        for group in &weights.groups {
            let out = &mut out[first * stride..];
            let outputs = (weights.outputs - first).min(OUTPUTS);
            match outputs {
                1 => sum::<P, 1, LANES>(processor, group, row, width, out, stride),
                2 => sum::<P, 2, LANES>(processor, group, row, width, out, stride),
                3 => sum::<P, 3, LANES>(processor, group, row, width, out, stride),
                _ => sum::<P, OUTPUTS, LANES>(processor, group, row, width, out, stride),
            }
            first += outputs;
        }
    }
}

/// `N` outputs of a row, as many pixels at a time as there are registers for.
#[inline(always)]
fn sum<P: Processor<LANES>, const N: usize, const LANES: usize>(
    processor: P,
    weights: &[f64],
    row: &[f32],
    width: usize,
    out: &mut [f32],
    stride: usize,
) {
    let (weights, _) = weights.as_chunks::<N>();
    let at_once = LANES * VECTORS;
    if width < at_once {
        for x in 0..width {
            tile::<Any, N, 1, 1>(Any, weights, row, width, (x, 0), out, stride);
        }
        return;
    }
    let channels = weights.len().max(1);
    let ahead = (AHEAD / channels / at_once * at_once).clamp(at_once, width);
    for x in (0..width).step_by(at_once) {
        // The last tile covers some pixels once more.
        let x = x.min(width - at_once);
        // Past the end of this row lies the next.
        let ahead = if x + ahead < width { ahead } else { ahead + (channels - 1) * width };
        tile::<P, N, LANES, VECTORS>(processor, weights, row, width, (x, ahead), out, stride);
    }
}

/// The sums of `LANES · VECTORS` pixels from `x`, while the samples `ahead` of theirs are called for.
#[inline(always)]
fn tile<P: Processor<LANES>, const N: usize, const LANES: usize, const VECTORS: usize>(
    processor: P,
    weights: &[[f64; N]],
    row: &[f32],
    width: usize,
    (x, ahead): (usize, usize),
    out: &mut [f32],
    stride: usize,
) {
    let mut sums = [[processor.splat(0.0); VECTORS]; N];
    for (channel, weights) in row.chunks_exact(width).zip(weights) {
        let samples: &[[f32; LANES]; VECTORS] =
            channel[x..].as_chunks().0.first_chunk().expect("a tile inside the row");
        for line in samples.as_flattened().chunks(LINE) {
            processor.call_for(line.as_ptr().wrapping_add(ahead).cast());
        }
        let weights = weights.map(|weight| processor.splat(weight));
        for v in 0..VECTORS {
            let sample = processor.widen(&samples[v]);
            for k in 0..N {
                sums[k][v] = processor.add_product(weights[k], sample, sums[k][v]);
            }
        }
    }
    for (k, sums) in sums.iter().enumerate() {
        let (out, _) = out[k * stride + x..].as_chunks_mut();
        let out: &mut [[f32; LANES]; VECTORS] = out.first_chunk_mut().expect("room for the row");
        for (out, sums) in out.iter_mut().zip(sums) {
            *out = processor.narrow(*sums);
        }
    }
}

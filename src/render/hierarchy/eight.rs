//! Eight boxes tested together, by the instructions that the processor has; the same operations on the same numbers with all of them.

use pulp::{Arch, NullaryFnOnce};
use wide::{CmpLe, f32x8, i32x8, u8x16, u16x8};

use super::{Line, Node};

/// How eight boxes are tested.
pub(super) trait Eight: Copy {
    /// Where the line enters each box of a node, and a bit for each box that it meets at a parameter in [0, `limit`].
    fn cross(self, node: &Node, line: &Line, limit: f32) -> ([f32; 8], u32);
}

/// A search through a hierarchy. (No closure: only what is inlined is compiled for the instruction set at hand.)
pub(super) trait Search {
    type Output;

    fn run(self, eight: impl Eight) -> Self::Output;
}

/// Runs a search with what the processor has.
#[inline]
pub(super) fn dispatch<S: Search>(search: S) -> S::Output {
    match Arch::new() {
        #[cfg(target_arch = "x86_64")]
        Arch::V3(simd) => simd.vectorize(With { search, eight: simd }),
        #[cfg(target_arch = "x86_64")]
        Arch::V4(simd) => (*simd).vectorize(With { search, eight: *simd }),
        _ => search.run(Portable),
    }
}

struct With<S, E> {
    search: S,
    eight: E,
}

impl<S: Search, E: Eight> NullaryFnOnce for With<S, E> {
    type Output = S::Output;

    #[inline(always)]
    fn call(self) -> S::Output {
        self.search.run(self.eight)
    }
}

/// Where a line meets the planes of an axis: steps times the first, and the second.
#[inline(always)]
fn line_of(node: &Node, line: &Line, axis: usize) -> [f32; 2] {
    [node.step[axis] * line.inverse[axis], (node.origin[axis] - line.origin[axis]) * line.inverse[axis]]
}

/// What every processor has.
#[derive(Debug, Clone, Copy)]
struct Portable;

impl Eight for Portable {
    #[inline(always)]
    fn cross(self, node: &Node, line: &Line, limit: f32) -> ([f32; 8], u32) {
        let (mut near, mut far) = (f32x8::ZERO, f32x8::splat(limit));
        for axis in 0..3 {
            let [scale, shift] = line_of(node, line, axis).map(f32x8::splat);
            let at = |steps: u16x8| f32x8::from_i32x8(i32x8::from_u16x8(steps)) * scale + shift;
            let planes = u8x16::new(node.planes[axis]);
            let (least, greatest) = (at(u16x8::from_u8x16_low(planes)), at(u16x8::from_u8x16_high(planes)));
            near = least.fast_min(greatest).fast_max(near);
            far = least.fast_max(greatest).fast_min(far);
        }
        #[expect(clippy::cast_sign_loss, reason = "eight bits")]
        let hits = near.cmp_le(far).move_mask() as u32;
        (near.to_array(), hits & node.there)
    }
}

/// AVX2.
#[cfg(target_arch = "x86_64")]
impl Eight for pulp::x86::V3 {
    #[inline(always)]
    fn cross(self, node: &Node, line: &Line, limit: f32) -> ([f32; 8], u32) {
        use std::arch::x86_64::{__m128i, _CMP_LE_OQ};
        let (mut near, mut far) = (self.splat_f32x8(0.0), self.splat_f32x8(limit));
        for axis in 0..3 {
            let [scale, shift] = line_of(node, line, axis).map(|by| self.splat_f32x8(by));
            let at = |steps: __m128i| {
                let steps = self.avx._mm256_cvtepi32_ps(self.avx2._mm256_cvtepu8_epi32(steps));
                self.add_f32x8(self.mul_f32x8(pulp::cast(steps), scale), shift)
            };
            let planes = pulp::cast(node.planes[axis]);
            let (least, greatest) = (at(planes), at(self.sse2._mm_bsrli_si128::<8>(planes)));
            near = self.max_f32x8(self.min_f32x8(least, greatest), near);
            far = self.min_f32x8(self.max_f32x8(least, greatest), far);
        }
        let met = self.avx._mm256_cmp_ps::<_CMP_LE_OQ>(pulp::cast(near), pulp::cast(far));
        #[expect(clippy::cast_sign_loss, reason = "eight bits")]
        let hits = self.avx._mm256_movemask_ps(met) as u32;
        (pulp::cast(near), hits & node.there)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;

    /// To the bit: which boxes a search comes to, and in which order, does not depend on the processor.
    #[test]
    #[cfg(target_arch = "x86_64")]
    fn instruction_sets_agree() {
        let Some(simd) = pulp::x86::V3::try_new() else {
            eprintln!("skipped: no AVX2 here");
            return;
        };
        let mut stream = Stream::new(8, 1);
        let mut uniform = || stream.uniforms::<1>()[0] as f32;
        let mut met = 0;
        for n in 0..2000 {
            let [origin, from] = [0; 2].map(|_| [0; 3].map(|_| 2.0 * uniform() - 1.0));
            let mut node = Node { origin, step: [0; 3].map(|_| uniform() / 254.0), ..Node::EMPTY };
            for planes in &mut node.planes {
                for i in 0..8 {
                    let ends = [0; 2].map(|_| (255.0 * uniform()) as u8);
                    (planes[i], planes[i + 8]) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                }
            }
            node.there = 0x7f;
            // Towards the node; some along an axis.
            let inverse = std::array::from_fn(|axis| {
                let along = origin[axis] + uniform() - from[axis];
                if n % 7 == 0 && axis != n % 3 { 1e30 } else { 1.0 / along }
            });
            let line = Line { origin: from, inverse };
            let limit = if n % 3 == 0 { f32::INFINITY } else { 1.0 };
            let (portable, own) = (Portable.cross(&node, &line, limit), simd.cross(&node, &line, limit));
            assert_eq!((portable.0.map(f32::to_bits), portable.1), (own.0.map(f32::to_bits), own.1));
            met += own.1.count_ones();
        }
        assert!(met > 100, "{met}");
    }
}

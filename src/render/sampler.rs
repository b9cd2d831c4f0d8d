//! Well-spread random numbers for paths: a function of a key and a counter, the same on any machine in any order.
//!
//! Sobol' points in four dimensions at a time, Owen-scrambled by hashing and shuffled differently for every key and every group of
//! four ("padding"): a group is stratified in itself, groups are independent of one another. Late groups, which long paths alone ask
//! for, are plain random numbers: strata gain nothing there. So are all of them where nothing but their independence is wanted
//! ([`Points::Independent`]), to see what the strata gain.
//!
//! Reference: B. Burley, *Practical Hash-based Owen Scrambling*, JCGT 9(4) (2020).

use schemars::JsonSchema;
use serde::Deserialize;

use crate::math::random::philox;

/// Sobol' points are tabulated up to this index; later samples start again with another key.
const EPOCH: u32 = 1 << 16;

/// Tells the numbers of a sample's parts from those of the sample.
const BRANCH: u64 = 0x6272_616E_6368_6573;

/// Groups that are stratified.
const STRATIFIED: u32 = 12;

/// How the numbers of a stream lie to one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Points {
    /// Sobol' points, Owen-scrambled: evenly.
    #[default]
    Sobol,
    /// At random: the error falls with the root of their number and no faster.
    Independent,
}

impl Points {
    /// Its name in a scene.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Sobol => "sobol",
            Self::Independent => "independent",
        }
    }
}

/// The numbers of one sample of one pixel or instrument.
#[derive(Debug, Clone)]
pub struct Sampler {
    key: u64,
    index: u64,
    group: u32,
    /// Groups that are stratified.
    stratified: u32,
}

impl Sampler {
    /// The numbers of sample `index` of the estimate `stream` (a pixel, an instrument's replicate) of the run `seed`.
    #[must_use]
    pub fn new(seed: u64, stream: u64, index: u64) -> Self {
        let ([s0, s1], [a, b]) = (words(seed), words(stream));
        let [k0, k1, ..] = philox([s0, s1], [a, b, 0x5A3D_71E5, 0]);
        Self { key: u64::from(k0) | (u64::from(k1) << 32), index, group: 0, stratified: STRATIFIED }
    }

    /// The same stream with points that lie as said.
    #[must_use]
    pub fn with(self, points: Points) -> Self {
        Self { stratified: if points == Points::Sobol { STRATIFIED } else { 0 }, ..self }
    }

    /// Starts the sample `index` of the same stream.
    pub fn start(&mut self, index: u64) {
        self.index = index;
        self.group = 0;
    }

    /// The numbers of one of so many parts of this sample from here on: those of all parts of all samples are stratified together. The parts
    /// of all samples of a stream are as many.
    #[must_use]
    pub fn branch(&self, part: u32, parts: u32) -> Self {
        let index = self.index * u64::from(parts) + u64::from(part);
        Self { key: mixed(self.key ^ BRANCH), index, ..*self }
    }

    /// The next number, uniform in [0, 1), by which alone the samples of a stream are stratified; in place of a group.
    pub fn one(&mut self) -> f64 {
        if self.stratified == 0 {
            return self.four()[0];
        }
        let epoch = self.index / u64::from(EPOCH);
        let group = mixed(self.key ^ mixed((u64::from(self.group) << 32) | epoch));
        let within = words(self.index % u64::from(EPOCH))[0];
        let point = sobol_burley::sample(within, 0, words(group)[0]);
        self.group += 1;
        let low = words(mixed(group ^ self.index))[0];
        f64::from(point) + f64::from(low) * (1.0 / (16_777_216.0 * 4_294_967_296.0))
    }

    /// The next group of four numbers, each uniform in [0, 1), in which the samples of a stream are stratified together.
    pub fn four(&mut self) -> [f64; 4] {
        let epoch = self.index / u64::from(EPOCH);
        if self.group >= self.stratified {
            let first = mixed(self.key ^ mixed((u64::from(self.group) << 48) ^ self.index));
            let ([a, b], [c, d]) = (words(first), words(mixed(first)));
            self.group += 1;
            // In the middle of their steps, so that the mean is exact.
            return [a, b, c, d].map(|word| (f64::from(word) + 0.5) * (1.0 / 4_294_967_296.0));
        }
        // What scrambles the group does not depend on the sample.
        let group = mixed(self.key ^ mixed((u64::from(self.group) << 32) | epoch));
        // The index within the epoch is below 2¹⁶ by construction.
        let within = words(self.index % u64::from(EPOCH))[0];
        let point = sobol_burley::sample_4d(within, 0, words(group)[0]);
        // Points are multiples of 2⁻²⁴: the bits below are filled at random, which keeps the strata and makes the mean exact.
        let first = mixed(group ^ self.index);
        let ([a, b], [c, d]) = (words(first), words(mixed(first)));
        self.group += 1;
        let low = [a, b, c, d];
        std::array::from_fn(|i| f64::from(point[i]) + f64::from(low[i]) * (1.0 / (16_777_216.0 * 4_294_967_296.0)))
    }
}

/// A bijection of 64 bits in which every bit of the argument turns half of the result's.
///
/// Reference: S. Vigna's SplitMix64, after G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014; mixing constants of D. Stafford.
fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

/// Low and high word.
fn words(x: u64) -> [u32; 2] {
    #[expect(clippy::cast_possible_truncation, reason = "the two halves are wanted")]
    let halves = [x as u32, (x >> 32) as u32];
    halves
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means of 4096 points: (0, m, s)-nets integrate products of linear functions far better than N^-1/2, and without bias over keys.
    #[test]
    fn every_dimension_and_product_is_unbiased_over_keys() {
        let (keys, samples) = (256, 64);
        let mut mean = [0.0; 4];
        let mut product = 0.0;
        for key in 0..keys {
            for index in 0..samples {
                let u = Sampler::new(1, key, index).four();
                assert!(u.iter().all(|u| (0.0..1.0).contains(u)), "{u:?}");
                for (m, u) in mean.iter_mut().zip(u) {
                    *m += u;
                }
                product += u[0] * u[3];
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "16 384")]
        let n = (keys * samples) as f64;
        // Five standard errors of as many independent numbers, σ² = 1/12 and 7/144: stratified ones stay well inside.
        for m in mean {
            assert!((m / n - 0.5).abs() < 5.0 * (1.0 / 12.0 / n).sqrt(), "{m}");
        }
        assert!((product / n - 0.25).abs() < 5.0 * (7.0 / 144.0 / n).sqrt(), "{product}");
    }

    /// 2^k samples of a stream put one number into each of 2^k equal intervals, in every dimension of every group.
    #[test]
    fn samples_of_a_stream_are_stratified() {
        for group in 0..5 {
            let mut seen = [[0_u32; 256]; 4];
            for index in 0..256 {
                let mut sampler = Sampler::new(3, 77, index);
                for _ in 0..group {
                    sampler.four();
                }
                for (seen, u) in seen.iter_mut().zip(sampler.four()) {
                    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 256")]
                    let cell = (u * 256.0) as usize;
                    seen[cell] += 1;
                }
            }
            assert!(seen.iter().flatten().all(|&n| n == 1), "group {group}");
        }
    }

    /// 16 samples of 4 parts each: 64 points, one in every 64th of every axis, and none of those of the samples themselves.
    #[test]
    fn the_parts_of_all_samples_are_stratified_together() {
        let mut whole = Sampler::new(7, 9, 0);
        let mut filled = [[0; 64]; 4];
        let mut own = Vec::new();
        for index in 0..16 {
            whole.start(index);
            let mut part = whole.clone();
            own.push(part.four());
            for number in 0..4 {
                let point = whole.branch(number, 4).four();
                assert!(!own.contains(&point));
                for (axis, x) in point.into_iter().enumerate() {
                    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 64")]
                    let place = (64.0 * x) as usize;
                    filled[axis][place] += 1;
                }
            }
        }
        assert_eq!(filled, [[1; 64]; 4]);
    }

    /// Late groups are random, single numbers stratified: 2¹⁶ of them have a mean of 1/2 within five standard errors, or far less.
    #[test]
    fn late_groups_are_random_and_single_numbers_stratified() {
        let (mut late, mut single) = ([0.0; 4], 0.0);
        for index in 0..1 << 16 {
            let mut sampler = Sampler::new(5, 9, index);
            single += sampler.one();
            for _ in 0..STRATIFIED {
                sampler.four();
            }
            late.iter_mut().zip(sampler.four()).for_each(|(sum, u)| *sum += u);
        }
        let n = f64::from(1 << 16);
        assert!(late.iter().all(|sum| (sum / n - 0.5).abs() < 5.0 * (1.0 / 12.0 / n).sqrt()), "{late:?}");
        // One number in each of n intervals: the mean is within half an interval of 1/2.
        assert!((single / n - 0.5).abs() < 0.5 / n, "{single}");
    }

    #[test]
    fn later_epochs_groups_streams_and_seeds_differ() {
        let first = Sampler::new(1, 1, 0).four();
        assert_eq!(first, Sampler::new(1, 1, 0).four());
        assert_ne!(first, Sampler::new(1, 1, u64::from(EPOCH)).four());
        assert_ne!(first, Sampler::new(2, 1, 0).four());
        assert_ne!(first, Sampler::new(1, 2, 0).four());
        let mut sampler = Sampler::new(1, 1, 7);
        sampler.start(0);
        assert_eq!(first, sampler.four());
        assert_ne!(first, sampler.four());
    }
}

//! Random numbers that are a function of a key and a counter, so that any sample of any pixel can be drawn on any machine in any
//! order and is always the same.
//!
//! Philox4x32-10 of J. K. Salmon et al., *Parallel Random Numbers: As Easy as 1, 2, 3*, SC11: ten rounds of multiplying and
//! exchanging four 32-bit words. It passes BigCrush, needs no state but the counter, and its known answers are in the tests.

/// The four words of block `counter` of the stream `key`.
#[must_use]
pub fn philox(key: [u32; 2], counter: [u32; 4]) -> [u32; 4] {
    /// The high and the low word of a product.
    fn product(a: u32, b: u32) -> (u32, u32) {
        let wide = u64::from(a) * u64::from(b);
        #[expect(clippy::cast_possible_truncation, reason = "the two halves are wanted")]
        let halves = ((wide >> 32) as u32, wide as u32);
        halves
    }
    let [mut k0, mut k1] = key;
    let [mut a, mut b, mut c, mut d] = counter;
    for _ in 0..10 {
        let (high0, low0) = product(0xD251_1F53, a);
        let (high1, low1) = product(0xCD9E_8D57, c);
        (a, b, c, d) = (high1 ^ b ^ k0, low1, high0 ^ d ^ k1, low0);
        k0 = k0.wrapping_add(0x9E37_79B9);
        k1 = k1.wrapping_add(0xBB67_AE85);
    }
    [a, b, c, d]
}

/// The numbers of one stream, one after the other.
///
/// A stream is named by a seed (of the run) and an index (of the pixel, the sample, the test); two different pairs never share
/// a number's origin. 2⁶⁴ blocks of two numbers each are in one.
#[derive(Debug, Clone)]
pub struct Stream {
    key: [u32; 2],
    index: u64,
    block: u64,
    /// Kept from the last block, where one number of it is unused.
    spare: Option<f64>,
}

impl Stream {
    /// The stream `index` of the run `seed`.
    #[must_use]
    pub fn new(seed: u64, index: u64) -> Self {
        Self { key: words(seed), index, block: 0, spare: None }
    }

    /// The next number, uniform in [0, 1), a multiple of 2⁻⁵³.
    pub fn uniform(&mut self) -> f64 {
        if let Some(number) = self.spare.take() {
            return number;
        }
        let ([a, b], [c, d]) = (words(self.block), words(self.index));
        let [w, x, y, z] = philox(self.key, [a, b, c, d]);
        self.block += 1;
        self.spare = Some(unit(y, z));
        unit(w, x)
    }

    /// Two independent numbers of the standard normal distribution (G. E. P. Box & M. E. Muller, 1958).
    pub fn normals(&mut self) -> [f64; 2] {
        // 1 − u is never 0.
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * self.uniform()).sin_cos();
        [radius * cos, radius * sin]
    }

    /// The next `N` numbers.
    pub fn uniforms<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.uniform())
    }
}

/// Low and high word.
fn words(x: u64) -> [u32; 2] {
    #[expect(clippy::cast_possible_truncation, reason = "the two halves are wanted")]
    let halves = [x as u32, (x >> 32) as u32];
    halves
}

/// 53 bits of two words as a fraction.
fn unit(high: u32, low: u32) -> f64 {
    let bits = (u64::from(high) << 21) | u64::from(low >> 11);
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
    let fraction = bits as f64 / 9_007_199_254_740_992.0;
    fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The known answers that the authors ship with their implementation (Random123, `kat_vectors`, philox4x32 10).
    #[test]
    fn known_answers() {
        assert_eq!(philox([0; 2], [0; 4]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(philox([u32::MAX; 2], [u32::MAX; 4]), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
        // Key and counter are the digits of π.
        let counter = [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344];
        assert_eq!(philox([0xa409_3822, 0x299f_31d0], counter), [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]);
    }

    #[test]
    fn numbers_fill_the_unit_interval_evenly() {
        let mut stream = Stream::new(7, 3);
        let count = 100_000;
        let numbers: Vec<f64> = (0..count).map(|_| stream.uniform()).collect();
        assert!(numbers.iter().all(|u| (0.0..1.0).contains(u)));
        let mean = numbers.iter().sum::<f64>() / f64::from(count);
        // Five standard errors of the mean: 5 √(1/12/n).
        assert!((mean - 0.5).abs() < 5.0 * (1.0 / 12.0 / f64::from(count)).sqrt(), "{mean}");
        let again: [f64; 3] = Stream::new(7, 3).uniforms();
        assert_eq!(again.as_slice(), &numbers[..3]);
        assert_ne!(Stream::new(7, 4).uniform(), again[0]);
        let sums = (0..count / 2)
            .flat_map(|_| stream.normals())
            .fold([0.0; 4], |s, z| [s[0] + z, s[1] + z * z, s[2] + z.powi(4), s[3] + f64::from(z > 1.959_964)]);
        // Moments 0, 1 and 3 and the upper 2.5 %, each within five standard errors: √1, √2, √96 and √(.025·.975) over √n.
        let n = f64::from(count);
        let errors = [1.0, 2f64.sqrt(), 96f64.sqrt(), (0.025_f64 * 0.975).sqrt()];
        for ((sum, want), error) in sums.iter().zip([0.0, 1.0, 3.0, 0.025]).zip(errors) {
            assert!((sum / n - want).abs() < 5.0 * error / n.sqrt(), "{} for {want}", sum / n);
        }
        assert_eq!((unit(u32::MAX, u32::MAX), unit(0, 0)), (1.0 - f64::EPSILON / 2.0, 0.0));
    }
}

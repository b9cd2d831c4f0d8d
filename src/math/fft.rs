//! The fast Fourier transform of a power of two of samples.

use std::f64::consts::PI;

/// Transforms complex numbers in place, X_k = Σ x_n exp(−2πi nk/N), as pairs of real and imaginary part.
///
/// # Panics
/// Where the number of samples is no power of two.
pub fn transform(samples: &mut [[f64; 2]]) {
    let n = samples.len();
    assert!(n.is_power_of_two(), "{n} samples are no power of two");
    let bits = n.trailing_zeros();
    if bits == 0 {
        return;
    }
    for i in 0..n {
        let j = i.reverse_bits() >> (usize::BITS - bits);
        if i < j {
            samples.swap(i, j);
        }
    }
    // Each factor by itself: products of factors would lose digits over a long transform.
    let factors: Vec<[f64; 2]> =
        (0..n / 2).map(|k| (-2.0 * PI * k as f64 / n as f64).sin_cos()).map(|(s, c)| [c, s]).collect();
    let mut half = 1;
    while half < n {
        let stride = n / (2 * half);
        for block in samples.chunks_exact_mut(2 * half) {
            let (a, b) = block.split_at_mut(half);
            for (k, (a, b)) in a.iter_mut().zip(b).enumerate() {
                let [c, s] = factors[k * stride];
                let turned = [b[0] * c - b[1] * s, b[0] * s + b[1] * c];
                *b = [a[0] - turned[0], a[1] - turned[1]];
                *a = [a[0] + turned[0], a[1] + turned[1]];
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_sum_of_its_definition() {
        let x: Vec<[f64; 2]> = (0..16).map(|n| [f64::from(n * n % 7), f64::from(n % 3)]).collect();
        let mut fast = x.clone();
        transform(&mut fast);
        for (k, got) in fast.iter().enumerate() {
            let mut want = [0.0; 2];
            for (n, [re, im]) in x.iter().enumerate() {
                let (s, c) = (-2.0 * PI * (n * k) as f64 / 16.0).sin_cos();
                want[0] += re * c - im * s;
                want[1] += re * s + im * c;
            }
            assert!((got[0] - want[0]).abs() < 1e-12 && (got[1] - want[1]).abs() < 1e-12, "{k}: {got:?} {want:?}");
        }
        let mut one = [[3.0, 4.0]];
        transform(&mut one);
        assert_eq!(one, [[3.0, 4.0]]);
    }
}

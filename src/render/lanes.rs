//! Sums and maxima over bands, in lanes that a processor has side by side: one number after the other, each would wait for the last.

/// Numbers that are dealt with together.
const LANES: usize = 8;

/// The largest of the numbers and 0; what is no number does not count.
#[must_use]
pub fn largest(values: &[f64]) -> f64 {
    let (chunks, rest) = values.as_chunks::<LANES>();
    let mut lanes = [0.0; LANES];
    for chunk in chunks {
        lanes.iter_mut().zip(chunk).for_each(|(lane, v)| *lane = if *v > *lane { *v } else { *lane });
    }
    lanes.iter().chain(rest).copied().fold(0.0, f64::max)
}

/// Σ v w of as many values as weights, summed lane by lane: not to the bits of a sum from first to last.
#[must_use]
pub fn weighted(values: &[f64], weights: &[f64]) -> f64 {
    let ((chunks, rest), (by, rest_by)) = (values.as_chunks::<LANES>(), weights.as_chunks::<LANES>());
    let mut lanes = [0.0; LANES];
    for (chunk, by) in chunks.iter().zip(by) {
        lanes.iter_mut().zip(chunk.iter().zip(by)).for_each(|(lane, (v, w))| *lane += v * w);
    }
    let rest: f64 = rest.iter().zip(rest_by).map(|(v, w)| v * w).sum();
    lanes.iter().sum::<f64>() + rest
}

/// Their mean, summed lane by lane as in [`weighted`].
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    let (chunks, rest) = values.as_chunks::<LANES>();
    let mut lanes = [0.0; LANES];
    for chunk in chunks {
        lanes.iter_mut().zip(chunk).for_each(|(lane, v)| *lane += v);
    }
    lanes.iter().chain(rest).sum::<f64>() / values.len() as f64
}

/// Adds a row to another, which is no longer. As the next one a loop over places: chains of iterators are not always inlined, and only what is inlined is
/// compiled for the instruction set that a dispatch finds.
#[inline(always)]
pub fn add(sums: &mut [f32], a: &[f32]) {
    let a = &a[..sums.len()];
    for (i, sum) in sums.iter_mut().enumerate() {
        *sum += a[i];
    }
}

/// Multiplies a row by another, which is no shorter.
#[inline(always)]
pub fn multiply(row: &mut [f32], by: &[f32]) {
    let by = &by[..row.len()];
    for (i, value) in row.iter_mut().enumerate() {
        *value *= by[i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_as_long_as_the_one_that_changes() {
        let (a, b) = ([1.0, 2.0, 3.0], [10.0, 20.0, 30.0]);
        let mut row = [1.0, 1.0];
        add(&mut row, &a);
        assert_eq!(row, [2.0, 3.0]);
        multiply(&mut row, &b);
        assert_eq!(row, [20.0, 60.0]);
    }

    #[test]
    fn all_lanes_and_the_rest_count() {
        for n in 0..20 {
            let values: Vec<f64> = (0..n).map(f64::from).collect();
            let (last, sum) = (f64::from((n - 1).max(0)), f64::from(n * (n - 1) / 2));
            assert_eq!(largest(&values), last);
            let turned: Vec<f64> = values.iter().rev().copied().collect();
            assert_eq!(largest(&turned), last);
            // Whole numbers: no sum is rounded.
            assert_eq!(weighted(&values, &vec![2.0; values.len()]), 2.0 * sum);
            assert!(n == 0 || mean(&values) == sum / f64::from(n));
        }
        assert_eq!(largest(&[-1.0, f64::NAN]), 0.0);
        assert_eq!(largest(&[3.0, f64::NAN, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0, 9.0]), 9.0);
    }
}

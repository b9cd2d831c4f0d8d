//! How wide a spectrum is where it is largest.

/// Distance in nm between the places on both sides of sample `at` where straight lines between samples first reach `level`.
#[must_use]
pub(crate) fn full_width(x: &[f64], y: &[f64], at: usize, level: f64) -> Option<f64> {
    let cross =
        |inner: usize, outer: usize| x[inner] + (x[outer] - x[inner]) * (y[inner] - level) / (y[inner] - y[outer]);
    let left = (1..=at).rev().find(|&i| y[i - 1] <= level).map(|i| cross(i, i - 1))?;
    let right = (at..x.len() - 1).find(|&i| y[i + 1] <= level).map(|i| cross(i, i + 1))?;
    Some(right - left)
}

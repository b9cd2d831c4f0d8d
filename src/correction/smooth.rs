//! Savitzky-Golay smoothing: a polynomial fitted to a window, its value taken in the middle.

use nalgebra::{DMatrix, DVector};

use super::Error;
use super::signal::Operator;

/// A polynomial through a window of samples, by least squares (Savitzky and Golay 1964).
///
/// On equal steps these are their weights; on others the polynomial is fitted over the wavelengths that there are. Near the ends the
/// polynomial of the outermost window is taken at the samples that have no window of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Smoothing {
    /// Samples in the window, odd.
    pub window: usize,
    /// Degree of the polynomial.
    pub degree: usize,
}

impl Smoothing {
    /// The map from samples to smoothed samples.
    pub(super) fn operator(&self, x: &[f64]) -> Result<Operator, Error> {
        let Self { window, degree } = *self;
        let fits = window % 2 == 1 && degree < window && window <= x.len();
        let bad = Error::Window { window, degree, samples: x.len() };
        if !fits {
            return Err(bad);
        }
        let half = window / 2;
        let row = |i: usize| {
            let first = i.saturating_sub(half).min(x.len() - window);
            weights(&x[first..first + window], x[i], degree).map(|w| (first, w))
        };
        (0..x.len()).map(row).collect::<Option<Vec<_>>>().map(Operator::new).ok_or(bad)
    }
}

/// The weights of the samples at `x` in the value at `at` of the polynomial fitted to them.
fn weights(x: &[f64], at: f64, degree: usize) -> Option<Vec<f64>> {
    // About the point asked for and in windows, so that powers stay near 1; the value there is the constant term.
    let size = x[x.len() - 1] - x[0];
    let powers = DMatrix::from_fn(x.len(), degree + 1, |r, c| ((x[r] - at) / size).powi(c as i32));
    let (q, r) = powers.qr().unpack();
    let mut constant = DVector::zeros(degree + 1);
    constant[0] = 1.0;
    let solved = r.transpose().solve_lower_triangular(&constant)?;
    Some((q * solved).iter().copied().collect())
}

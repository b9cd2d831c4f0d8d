//! Second orders of a grating: light of λ that falls where 2 λ is read.

use crate::finding::Finding;
use crate::math::interpolate;

/// A second order as strong as so much of the first is common without a filter.
const STRENGTH: f64 = 0.01;
/// From this share of a sample on such an order is told.
const TOLD: f64 = 0.1;

/// What keeps second orders out.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SecondOrder {
    /// Wavelength, nm, from which on an order-sorting filter holds back half of it.
    pub filter_from_nm: Option<f64>,
}

impl SecondOrder {
    /// Says so where a second order of 1 % of the light measured at λ/2 would be more than a tenth of the sample at λ.
    pub(super) fn look(&self, x: &[f64], y: &[f64]) -> Option<Finding> {
        let open = |w: f64| self.filter_from_nm.is_none_or(|from| w < from);
        let doubtful = |(w, v): &(&f64, &f64)| {
            let (w, v) = (**w, **v);
            let half = 0.5 * w;
            half >= x[0] && open(w) && STRENGTH * interpolate::linear(x, y, half) > TOLD * v.abs()
        };
        let found: Vec<f64> = x.iter().zip(y).filter(doubtful).map(|(w, _)| *w).collect();
        let (first, last) = (found.first()?, found.last()?);
        let message = format!(
            "{} samples between {first:.1} and {last:.1} nm are so low that a second order of 1 % of the light at half of the wavelength would be more than a tenth of them",
            found.len()
        );
        let hint =
            "use an order-sorting filter, and say where it begins ([second_order] filter_from_nm, --order-filter)";
        Some(Finding::warning("X005", message).hint(hint))
    }
}

//! Errors that two measurements share, such as one calibration or one wavelength axis: what of both figures errs together.
//!
//! To first order (JCGM 100, 5.2; JCGM 102): with independent modes z_j of unit variance of the shared contributions the figures a and
//! b err by Σ_j α_j z_j and Σ_j β_j z_j, and cov(a, b) = Σ_j α_j β_j.

use crate::conversion::Converter;
use crate::finding::Finding;
use crate::spectrum::{Quantity, Spectrum};

use super::analytic;
use super::budget::Budget;
use super::measurand::Figures;
use super::model::Model;
use super::{Error, Measurand, Uncertainty};

/// One of the two measurements.
#[derive(Debug, Clone, Copy)]
pub struct Side<'a> {
    /// Its budget.
    pub budget: &'a Budget,
    /// Its quantity.
    pub quantity: Quantity,
    /// Its spectrum.
    pub spectrum: &'a Spectrum,
    /// What came of them.
    pub uncertainty: &'a Uncertainty,
}

/// Why nothing is shared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SharedError {
    /// A measurement without an evaluation.
    #[error(transparent)]
    Evaluation(#[from] Error),
    /// No contribution of this name.
    #[error("no contribution named `{name}` in the budget of {of}; expected one of {}", known.join(", "))]
    Unknown {
        /// The name asked for.
        name: String,
        /// A or B.
        of: &'static str,
        /// The names there are.
        known: Vec<String>,
    },
    /// Errors that differ from sample to sample are the same only at the same samples.
    #[error(
        "`{name}` errs differently from sample to sample in A and B; expected the same wavelengths and the same contribution in both"
    )]
    Modes {
        /// The contribution.
        name: String,
    },
}

/// Correlation, to first order, of the errors of every figure that both measurements have, where the contributions `names` are the
/// same errors in both: cov(a, b)/(u(a) u(b)), from −1 to 1; 0 where a figure has no uncertainty or no derivative.
///
/// # Errors
/// [`SharedError`].
pub fn correlations(
    converter: &Converter,
    a: Side<'_>,
    b: Side<'_>,
    names: &[String],
) -> Result<Vec<(Measurand, f64)>, SharedError> {
    let evaluated = |side: Side<'_>, of: &'static str| -> Result<_, SharedError> {
        // What there is to say about the budget was said when the measurement was evaluated.
        let model = Model::new(side.budget, side.spectrum, &mut Vec::<Finding>::new())?;
        let figures = Figures::new(converter, side.quantity, side.spectrum)?;
        let index = |name: &String| {
            model.inputs.iter().position(|i| i.name == *name).ok_or_else(|| SharedError::Unknown {
                name: name.clone(),
                of,
                known: model.inputs.iter().map(|i| i.name.clone()).collect(),
            })
        };
        let chosen = names.iter().map(index).collect::<Result<Vec<_>, _>>()?;
        Ok((analytic::effects(&model, &figures, &chosen), figures.list.clone()))
    };
    let ((of_a, list_a), (of_b, list_b)) = (evaluated(a, "A")?, evaluated(b, "B")?);
    for ((name, a_modes), b_modes) in names.iter().zip(&of_a).zip(&of_b) {
        let (m, n) = (a_modes.nrows(), b_modes.nrows());
        if m != n || (m > 1 && a.spectrum.wavelengths_nm() != b.spectrum.wavelengths_nm()) {
            return Err(SharedError::Modes { name: name.clone() });
        }
    }
    let one = |(i, measurand): (usize, &Measurand)| {
        let k = list_b.iter().position(|m| m == measurand)?;
        let covariance: f64 = of_a.iter().zip(&of_b).map(|(x, y)| x.column(i).dot(&y.column(k))).sum();
        let u = |side: Side<'_>| side.uncertainty.figure(*measurand)?.analytic;
        let found = covariance / (u(a)? * u(b)?);
        Some((*measurand, if found.is_finite() { found.clamp(-1.0, 1.0) } else { 0.0 }))
    };
    Ok(list_a.iter().enumerate().filter_map(one).collect())
}

//! Errors that two measurements share, such as one calibration or one wavelength axis: what of both figures errs together.
//!
//! To first order (JCGM 100, 5.2; JCGM 102): with independent modes z_j of unit variance of the shared contributions the figures a and
//! b err by Σ_j α_j z_j and Σ_j β_j z_j, and cov(a, b) = Σ_j α_j β_j.

use std::collections::BTreeSet;

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
    /// Several contributions of this name.
    #[error(
        "{count} contributions named `{name}` in the budget of {of}; expected a name of its own for the shared one"
    )]
    Ambiguous {
        /// The name asked for.
        name: String,
        /// A or B.
        of: &'static str,
        /// How many there are.
        count: usize,
    },
    /// Independent noise.
    #[error("`{name}` is noise in {of}, which no two measurements have in common; expected another contribution")]
    Noise {
        /// The contribution.
        name: String,
        /// A or B.
        of: &'static str,
    },
    /// Errors that differ from sample to sample are the same only at the same samples, with the same correlation between them.
    #[error(
        "`{name}` errs differently from sample to sample in A and B; expected the same wavelengths and the same contribution in both"
    )]
    Modes {
        /// The contribution.
        name: String,
    },
}

/// A measurement compiled, and where the shared contributions are in it.
struct Evaluated<'a> {
    model: Model,
    figures: Figures<'a>,
    shared: Vec<usize>,
}

impl<'a> Evaluated<'a> {
    fn new(
        converter: &'a Converter,
        side: Side<'_>,
        of: &'static str,
        names: &BTreeSet<&String>,
    ) -> Result<Self, SharedError> {
        // What there is to say about the budget was said when the measurement was evaluated.
        let model = Model::new(side.budget, side.spectrum, &mut Vec::<Finding>::new())?;
        let figures = Figures::new(converter, side.quantity, side.spectrum)?;
        let index = |name: &&String| {
            let all: Vec<usize> = (0..model.inputs.len()).filter(|i| model.inputs[*i].name == **name).collect();
            match all[..] {
                [one] if model.is_noise(one) => Err(SharedError::Noise { name: (*name).clone(), of }),
                [one] => Ok(one),
                [] => Err(SharedError::Unknown {
                    name: (*name).clone(),
                    of,
                    known: model.inputs.iter().map(|i| i.name.clone()).collect(),
                }),
                _ => Err(SharedError::Ambiguous { name: (*name).clone(), of, count: all.len() }),
            }
        };
        let shared = names.iter().map(index).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { model, figures, shared })
    }
}

/// Correlation, to first order, of the errors of every figure that both measurements have, where the contributions `names` are the
/// same errors in both: cov(a, b)/(u(a) u(b)), from −1 to 1; 0 where a figure has no uncertainty or no derivative. A name that is given
/// twice counts once.
///
/// # Errors
/// [`SharedError`].
pub fn correlations(
    converter: &Converter,
    a: Side<'_>,
    b: Side<'_>,
    names: &[String],
) -> Result<Vec<(Measurand, f64)>, SharedError> {
    let names: BTreeSet<&String> = names.iter().collect();
    let (of_a, of_b) = (Evaluated::new(converter, a, "A", &names)?, Evaluated::new(converter, b, "B", &names)?);
    for (name, (one, other)) in names.iter().zip(of_a.shared.iter().zip(&of_b.shared)) {
        if !of_a.model.has_modes_of(*one, &of_b.model, *other) {
            return Err(SharedError::Modes { name: (*name).clone() });
        }
    }
    let effects = |e: &Evaluated<'_>| analytic::effects(&e.model, &e.figures, &e.shared);
    let (a_modes, b_modes) = (effects(&of_a), effects(&of_b));
    let one = |(i, measurand): (usize, &Measurand)| {
        let k = of_b.figures.list.iter().position(|m| m == measurand)?;
        let covariance: f64 = a_modes.iter().zip(&b_modes).map(|(x, y)| x.column(i).dot(&y.column(k))).sum();
        let u = |side: Side<'_>| side.uncertainty.figure(*measurand)?.analytic;
        let found = covariance / (u(a)? * u(b)?);
        Some((*measurand, if found.is_finite() { found.clamp(-1.0, 1.0) } else { 0.0 }))
    };
    Ok(of_a.figures.list.iter().enumerate().filter_map(one).collect())
}

//! The angles of an instrument's grid.

/// The finest and the widest step, degrees.
const STEPS_DEG: (f64, f64) = (0.1, 90.0);

/// A step that does not divide its range, or is too fine or too wide.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("a {which} of {found} deg; expected one from {} to {} deg that divides {whole} deg", STEPS_DEG.0, STEPS_DEG.1)]
pub struct StepError {
    /// The key of the step.
    pub which: &'static str,
    /// The step, degrees.
    pub found: f64,
    /// What it divides, degrees.
    pub whole: f64,
}

/// The angles from 0 to `whole`, both included, a step apart; degrees.
pub(super) fn angles(which: &'static str, step_deg: f64, whole: f64) -> Result<Vec<f64>, StepError> {
    let count = (whole / step_deg).round();
    let divides = (count * step_deg - whole).abs() < 1e-6;
    if !((STEPS_DEG.0..=STEPS_DEG.1).contains(&step_deg) && divides) {
        return Err(StepError { which, found: step_deg, whole });
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 3600")]
    let count = count as u32;
    Ok((0..=count).map(|i| whole * f64::from(i) / f64::from(count)).collect())
}

//! The error that a user asks for.

use std::str::FromStr;

use crate::cli::Failure;
use crate::trade::{Figure, Measure, Sweep};

/// An error as it is written: `0.5%`, `0.005`, `20K`.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::cli) struct Target {
    value: f64,
    /// What stands behind the number.
    unit: String,
}

impl FromStr for Target {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let end = text.rfind(|c: char| c.is_ascii_digit() || c == '.').map_or(0, |i| i + 1);
        let (number, unit) = text.split_at(end);
        let value = number.parse::<f64>().ok().filter(|v| *v > 0.0 && v.is_finite());
        let value = value.ok_or_else(|| format!("found `{text}`; expected an error such as 0.5%, 0.005 or 20K"))?;
        Ok(Self { value, unit: unit.trim().to_owned() })
    }
}

impl Target {
    /// The error in the figure's unit; relative ones as a fraction.
    pub(in crate::cli) fn of(&self, figure: &Figure) -> Result<f64, Failure> {
        match (figure.measure, self.unit.as_str()) {
            (Measure::Relative, "%") => Ok(self.value / 100.0),
            (_, "") => Ok(self.value),
            (Measure::Absolute, unit) if unit.eq_ignore_ascii_case(figure.unit) => Ok(self.value),
            (measure, unit) => {
                let expected = match (measure, figure.unit) {
                    (Measure::Relative, _) => "per cent, such as 0.5%, or a fraction".to_owned(),
                    (Measure::Absolute, "") => "a number without unit".to_owned(),
                    (Measure::Absolute, own) => format!("a number in {own}"),
                };
                let found = format!("--error {}{unit} for {}", self.value, figure.key);
                Err(Failure::Message(format!("{found}; expected {expected}")))
            }
        }
    }
}

/// The place of a figure by its key.
pub(super) fn place(figures: &[Figure], key: &str) -> Result<usize, Failure> {
    figures.iter().position(|f| f.key == key).ok_or_else(|| {
        let known: Vec<&str> = figures.iter().map(|f| f.key.as_ref()).collect();
        Failure::Message(format!("`{key}`: no such figure; expected one of {}", known.join(", ")))
    })
}

/// Refuses a figure that the input does not have.
pub(super) fn must_be_defined(path: &str, sweep: &Sweep, figure: usize) -> Result<(), Failure> {
    if sweep.reference_errors[figure].is_some() {
        return Ok(());
    }
    let defined = sweep.figures.iter().zip(&sweep.reference_errors).filter(|(_, e)| e.is_some());
    let others: Vec<&str> = defined.map(|(f, _)| f.key.as_ref()).collect();
    let message =
        format!("{path}: has no {}; expected --figure with one of: {}", sweep.figures[figure].key, others.join(", "));
    Err(Failure::Message(message))
}

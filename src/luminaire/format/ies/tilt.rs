//! TILT: how the output of a lamp depends on its position.

use super::super::error::{Error, ErrorKind};
use super::super::text::{decode, place};
use super::scan::Numbers;
use crate::finding::{Finding, Location};

/// A table of lamp output over luminaire tilt. It describes the lamp at other positions than the tested one: the
/// intensities of the file hold for a tilt of 0° and are not changed by it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TiltTable {
    /// Lamp to luminaire geometry: 1 vertical, 2 horizontal and stays so, 3 horizontal and tilts with the luminaire.
    pub geometry: u8,
    /// Tilt of the luminaire, degrees.
    pub angles_deg: Vec<f64>,
    /// Multiplying factor at each angle.
    pub factors: Vec<f64>,
}

/// The most pairs of angle and factor.
const MOST: u64 = 10_000;

impl TiltTable {
    /// Reads the file that `TILT=<file name>` names.
    ///
    /// # Errors
    /// What is no number, missing or out of range.
    pub fn parse(bytes: &[u8]) -> Result<Self, Error> {
        let text = decode(bytes)?;
        Self::take(&text.text, &mut Numbers::new(&text.text, 0))
    }

    pub(super) fn take(text: &str, numbers: &mut Numbers<'_>) -> Result<Self, Error> {
        let out_of_range = |at: usize, found: f64, field: &str, expected: &str| {
            let kind =
                ErrorKind::OutOfRange { found: found.to_string(), field: field.into(), expected: expected.into() };
            Err(Error::new(place(text, at), kind))
        };
        let at = numbers.peek();
        let geometry = numbers.next("lamp-to-luminaire geometry", 0, 1)?;
        if ![1.0, 2.0, 3.0].contains(&geometry) {
            return out_of_range(at, geometry, "lamp-to-luminaire geometry", "1, 2 or 3");
        }
        let at = numbers.peek();
        let count = numbers.next("number of tilt angles", 0, 1)?;
        if count.fract() != 0.0 || count < 1.0 {
            return out_of_range(at, count, "number of tilt angles", "a whole number of 1 or more");
        }
        if count > MOST as f64 {
            let kind =
                ErrorKind::TooLarge { found: count.to_string(), field: "number of tilt angles".into(), limit: MOST };
            return Err(Error::new(place(text, at), kind));
        }
        let angles_deg = numbers.take("tilt angles", count as usize)?;
        let at = numbers.peek();
        let factors = numbers.take("tilt factors", count as usize)?;
        if let Some(found) = factors.iter().find(|f| **f < 0.0) {
            return out_of_range(at, *found, "tilt factor", "0 or more");
        }
        Ok(Self { geometry: geometry as u8, angles_deg, factors })
    }

    /// What is odd about it.
    pub(super) fn findings(&self, location: Location) -> Option<Finding> {
        let ordered = self.angles_deg.windows(2).all(|w| w[0] < w[1]);
        let at_zero = self.angles_deg.iter().position(|a| *a == 0.0).map(|i| self.factors[i]);
        let message = match at_zero {
            _ if !ordered => "the tilt angles do not ascend".to_owned(),
            Some(factor) if factor != 1.0 => format!("the tilt factor at 0° is {factor}; expected 1"),
            _ => return None,
        };
        Some(Finding::warning("L006", format!("{message}; the table is kept and not applied")).at(location))
    }

    /// One line, as kept among a luminaire's keywords.
    pub(super) fn to_keyword(&self) -> String {
        let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let count = self.angles_deg.len();
        format!("INCLUDE {} {count} {} {}", self.geometry, list(&self.angles_deg), list(&self.factors))
    }

    /// The reverse of [`Self::to_keyword`].
    pub(super) fn from_keyword(text: &str) -> Option<Self> {
        let rest = text.strip_prefix("INCLUDE ")?;
        Self::take(rest, &mut Numbers::new(rest, 0)).ok()
    }
}

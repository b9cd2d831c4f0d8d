//! Absolute levels: `800 lm`, `500 lx`, `100 W` give a relative spectrum its scale, and so turn light as people see it back
//! into light as physics measures it.

use std::fmt;
use std::str::FromStr;

use crate::photometry::luminous::Luminous;
use crate::spectrum::{Quantity, SpectralUnit, UnitError};

/// A level to which a spectrum is scaled.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// The quantity that the unit is of.
    pub quantity: Quantity,
    /// The amount, in the SI unit of the radiometric or luminous quantity.
    pub amount: f64,
    /// True for lm, cd, lx, cd/m² …; false for W, W/sr, W/m² ….
    pub luminous: bool,
    text: String,
}

/// Why a level was not understood or could not be reached.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LevelError {
    /// Not a positive number with a unit.
    #[error(
        "a level of `{found}`; expected a positive number with its unit, such as `500 lx`, `800 lm`, `300 cd/m2`, `100 W` or `1 W/m2`"
    )]
    Text {
        /// The text met.
        found: String,
    },
    /// The unit is not understood.
    #[error(transparent)]
    Unit(#[from] UnitError),
    /// The spectrum is already absolute, of another quantity.
    #[error(
        "the spectrum is one of {from} and cannot be scaled to `{to}`; expected a level of {from}, or --quantity relative"
    )]
    Quantity {
        /// What the spectrum is of.
        from: Quantity,
        /// The level.
        to: String,
    },
    /// No factor reaches the level.
    #[error("the spectrum's {what} is {found}; expected a positive amount to scale to `{to}`")]
    Dark {
        /// Which integral.
        what: &'static str,
        /// Its value.
        found: f64,
        /// The level.
        to: String,
    },
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl FromStr for Level {
    type Err = LevelError;

    fn from_str(text: &str) -> Result<Self, LevelError> {
        let bad = || LevelError::Text { found: text.to_owned() };
        let trimmed = text.trim();
        // The longest prefix that is a number: `1e-3 W` and `1e3lm` alike.
        let split = (1..=trimmed.len())
            .rev()
            .find(|&i| trimmed.is_char_boundary(i) && trimmed[..i].trim_end().parse::<f64>().is_ok())
            .ok_or_else(bad)?;
        let amount: f64 = trimmed[..split].trim_end().parse().map_err(|_| bad())?;
        if !(amount > 0.0 && amount.is_finite()) {
            return Err(bad());
        }
        let unit = trimmed[split..].trim();
        let plain = unit.replace('²', "2").replace('^', "").replace(['·', '⋅', '*'], " ");
        let luminous = match plain.to_lowercase().as_str() {
            "" => return Err(bad()),
            "lm" | "lumen" | "lumens" => Some((Quantity::Flux, 1.0)),
            "cd" | "candela" => Some((Quantity::Intensity, 1.0)),
            "lx" | "lux" => Some((Quantity::Irradiance, 1.0)),
            "klx" => Some((Quantity::Irradiance, 1e3)),
            // The foot-candle is one lumen per square foot: 1/0.3048² lx, exactly.
            "fc" => Some((Quantity::Irradiance, 1.0 / (0.3048 * 0.3048))),
            "cd/m2" | "cd m-2" | "nit" | "nits" => Some((Quantity::Radiance, 1.0)),
            "lm/m2" | "lm m-2" => Some((Quantity::Exitance, 1.0)),
            "lm s" | "lms" => Some((Quantity::Energy, 1.0)),
            "lx s" | "lxs" => Some((Quantity::Exposure, 1.0)),
            _ => None,
        };
        let text = trimmed.to_owned();
        if let Some((quantity, factor)) = luminous {
            return Ok(Self { quantity, amount: amount * factor, luminous: true, text });
        }
        let parsed: SpectralUnit = unit.parse()?;
        if parsed.photons || parsed.per == crate::spectrum::Per::Wavelength {
            return Err(bad());
        }
        Ok(Self { quantity: parsed.quantity, amount: amount * parsed.factor, luminous: false, text })
    }
}

impl Level {
    /// The factor by which a spectrum with the integrals given has to be multiplied.
    ///
    /// # Errors
    /// [`LevelError::Quantity`] where the spectrum is absolute and of another quantity, [`LevelError::Dark`] where its integral
    /// is not positive.
    pub fn factor(&self, quantity: Quantity, integrals: &Luminous) -> Result<f64, LevelError> {
        if quantity != Quantity::Relative && quantity != self.quantity {
            return Err(LevelError::Quantity { from: quantity, to: self.text.clone() });
        }
        let (what, found) = if self.luminous {
            ("luminous content", integrals.photopic)
        } else {
            ("radiant content", integrals.radiometric)
        };
        let factor = self.amount / found;
        if found > 0.0 && factor.is_finite() {
            Ok(factor)
        } else {
            Err(LevelError::Dark { what, found, to: self.text.clone() })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_read_with_their_units() {
        for (text, quantity, amount, luminous) in [
            ("500 lx", Quantity::Irradiance, 500.0, true),
            ("800lm", Quantity::Flux, 800.0, true),
            ("3e2 cd/m²", Quantity::Radiance, 300.0, true),
            ("100 W", Quantity::Flux, 100.0, false),
            ("1 mW/m2", Quantity::Irradiance, 1e-3, false),
            ("2 W/m2/sr", Quantity::Radiance, 2.0, false),
        ] {
            let level: Level = text.parse().expect(text);
            assert_eq!((level.quantity, level.amount, level.luminous), (quantity, amount, luminous), "{text}");
        }
        // 1 fc = 10.763 910 4 lx (exact 1/0.3048²).
        let fc: Level = "1 fc".parse().expect("fc");
        assert!((fc.amount - 10.763_910_416_709_722).abs() < 1e-12);
        for text in ["", "lx", "-3 lx", "NaN lx", "inf W", "5", "5 parsec", "1 W/m2/nm", "0 lx"] {
            assert!(text.parse::<Level>().is_err(), "{text}");
        }
    }
}

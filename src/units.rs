//! Quantity newtypes for the public boundary: one per quantity, no conversion between them but by physics with a name.
//!
//! Lux and nit have the same dimension and are different things; so are lumen and candela. Hence there is no `From` from one
//! to another: functions such as [`crate::photometry::transfer::lambertian_luminance`] carry the assumption in their name.

use std::fmt;

macro_rules! quantity {
    ($($(#[$doc:meta])* $name:ident, $symbol:literal;)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
        pub struct $name(pub f64);

        impl $name {
            /// Symbol of the unit.
            pub const SYMBOL: &'static str = $symbol;
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{} {}", significant(self.0, f.precision().unwrap_or(5)), Self::SYMBOL)
            }
        }
    )*};
}

quantity! {
    /// Illuminance, lx.
    Lux, "lx";
    /// Luminance, cd/m².
    CandelaPerSquareMetre, "cd/m²";
    /// Luminous flux, lm.
    Lumen, "lm";
    /// Luminous intensity, cd.
    Candela, "cd";
    /// Luminous exitance, lm/m².
    LumenPerSquareMetre, "lm/m²";
    /// Length, m.
    Metre, "m";
    /// Area, m².
    SquareMetre, "m²";
    /// Plane angle, rad.
    Radian, "rad";
    /// Solid angle, sr.
    Steradian, "sr";
}

/// Luminance's other name.
pub type Nit = CandelaPerSquareMetre;

/// A number with `digits` significant digits; plain between 1e-4 and 1e7, else with a power of ten.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let digits = digits.max(1);
    // Let the formatter round first: 9.9999 with three digits is 10.0, of another magnitude.
    let scientific = format!("{value:.*e}", digits - 1);
    let exponent: i32 = scientific.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    if (-4..7).contains(&exponent) {
        let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        scientific
    }
}

/// A number to the place where its standard uncertainty has its second digit; with six significant digits where that is none, or
/// below 1e-12 of the number.
#[must_use]
pub fn to_uncertainty(value: f64, standard: f64) -> String {
    if !(standard > 1e-12 * value.abs() && standard.is_finite()) {
        return significant(value, 6);
    }
    #[expect(clippy::cast_possible_truncation, reason = "exponents of doubles are small")]
    let place = 1 - standard.log10().floor() as i32;
    match usize::try_from(place) {
        Ok(decimals) => format!("{value:.decimals$}"),
        Err(_) => {
            let unit = 10f64.powi(-place);
            format!("{:.0}", (value / unit).round() * unit)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_end_with_the_uncertainty() {
        for (value, standard, text) in [
            (3999.83, 21.3, "4000"),
            (0.000_502_21, 0.000_374, "0.00050"),
            (123_456.0, 780.0, "123460"),
            (82.779, 0.0, "82.7790"),
            (1.5, f64::NAN, "1.50000"),
        ] {
            assert_eq!(to_uncertainty(value, standard), text);
        }
    }

    #[test]
    fn significant_digits() {
        for (value, digits, text) in [
            (0.0, 4, "0"),
            (500.04, 4, "500.0"),
            (9.9999, 3, "10.0"),
            (0.001_234_56, 3, "0.00123"),
            (1.0e-5, 3, "1.00e-5"),
            (123_456.7, 3, "123457"),
            (2.5e9, 3, "2.50e9"),
            (-0.0012, 2, "-0.0012"),
        ] {
            assert_eq!(significant(value, digits), text);
        }
        assert_eq!(Lux(500.0).to_string(), "500.00 lx");
    }
}

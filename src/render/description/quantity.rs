//! Quantities with their units, as texts of a scene: `"800 lm"`, `"4000 K"`, `"1 W/m2/sr/nm"`.

use std::fmt;
use std::marker::PhantomData;
use std::str::FromStr;

use schemars::JsonSchema;
use serde::de::{Deserialize, Deserializer, Visitor};

/// A unit: its spellings, the factor to SI, and what it measures.
struct Unit<T: 'static> {
    spellings: &'static [&'static str],
    factor: f64,
    kind: T,
}

/// Why a text is no quantity.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("found `{found}`; expected {expected}")]
pub struct Error {
    found: String,
    expected: String,
}

/// A number and one of the units given; spaces, `·`, superscripts and `^` in the unit do not matter.
fn parse<T: Copy>(text: &str, what: &str, units: &[Unit<T>]) -> Result<(f64, T), Error> {
    let refused = || {
        let names: Vec<&str> = units.iter().map(|u| u.spellings[0]).collect();
        Error { found: text.to_owned(), expected: format!("{what}: a number and one of {}", names.join(", ")) }
    };
    let trimmed = text.trim();
    // The number is the longest beginning that is one: `1e3 lm`, but also `1e3lm`.
    let ends = trimmed.char_indices().map(|(i, c)| i + c.len_utf8()).rev();
    let (number, unit) = ends
        .filter_map(|end| Some((trimmed[..end].parse::<f64>().ok()?, &trimmed[end..])))
        .next()
        .ok_or_else(refused)?;
    let plain = |s: &str| -> String {
        s.chars()
            .filter(|c| !c.is_whitespace() && !matches!(c, '^' | '·' | '(' | ')'))
            .map(|c| match c {
                '²' => '2',
                'μ' => 'µ',
                c => c,
            })
            .collect()
    };
    let unit = plain(unit);
    let found = units.iter().find(|u| u.spellings.iter().any(|s| plain(s) == unit)).ok_or_else(refused)?;
    let value = number * found.factor;
    if value.is_finite() { Ok((value, found.kind)) } else { Err(refused()) }
}

/// Reads a quantity from its text. A number alone is the commonest mistake, and is told what it lacks.
struct Text<T> {
    what: &'static str,
    example: &'static str,
    of: PhantomData<T>,
}

impl<T> Text<T> {
    fn without_unit<E: serde::de::Error>(&self, found: impl fmt::Display) -> Result<T, E> {
        let Self { what, example, .. } = self;
        Err(E::custom(format!("found `{found}` without a unit; expected {what} as a text such as \"{example}\"")))
    }
}

impl<T: FromStr<Err = Error>> Visitor<'_> for Text<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} as a text such as \"{}\"", self.what, self.example)
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<T, E> {
        text.parse().map_err(E::custom)
    }

    fn visit_i64<E: serde::de::Error>(self, found: i64) -> Result<T, E> {
        self.without_unit(found)
    }

    fn visit_u64<E: serde::de::Error>(self, found: u64) -> Result<T, E> {
        self.without_unit(found)
    }

    fn visit_f64<E: serde::de::Error>(self, found: f64) -> Result<T, E> {
        self.without_unit(found)
    }
}

/// How a quantity is read: as [`Text`].
macro_rules! read {
    ($name:ident, $what:literal, $example:literal) => {
        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(Text { what: $what, example: $example, of: PhantomData })
            }
        }
    };
}

/// A quantity of one dimension in its SI unit.
macro_rules! simple {
    ($(#[$doc:meta])* $name:ident, $what:literal, $example:literal, [$($spellings:expr => $factor:expr),+ $(,)?]) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, PartialOrd, JsonSchema)]
        #[schemars(with = "String", extend("examples" = [$example]))]
        pub struct $name(pub f64);

        impl FromStr for $name {
            type Err = Error;

            fn from_str(text: &str) -> Result<Self, Error> {
                parse(text, $what, &[$(Unit { spellings: &$spellings, factor: $factor, kind: () }),+]).map(|(v, ())| Self(v))
            }
        }

        read!($name, $what, $example);
    };
}

simple!(
    /// A length, m.
    Length, "a length", "0.5 m", [["m"] => 1.0, ["mm"] => 1e-3, ["cm"] => 1e-2, ["km"] => 1e3, ["µm", "um"] => 1e-6]
);
simple!(
    /// An angle, radians.
    Angle, "an angle", "30 deg", [["deg", "°"] => std::f64::consts::PI / 180.0, ["rad"] => 1.0]
);
simple!(
    /// A wavelength, nm.
    Wavelength, "a wavelength", "555 nm", [["nm"] => 1.0, ["µm", "um"] => 1e3]
);
simple!(
    /// A share of a whole.
    Share, "a share", "1 %", [["%"] => 0.01]
);

/// Light as an eye weighs it or as a detector counts it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Weighted with V(λ): lm, cd, lx, cd/m².
    Luminous,
    /// Unweighted, over all wavelengths: W, W/sr, W/m², W/(m²·sr).
    Radiant,
    /// Per nanometre, wherever the spectrum that goes with it is 1.
    Spectral,
}

/// A quantity of light in the SI unit of its kind.
macro_rules! light {
    ($(#[$doc:meta])* $name:ident, $what:literal, $example:literal, [$($spellings:expr => ($factor:expr, $kind:ident)),+ $(,)?]) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, JsonSchema)]
        #[schemars(with = "String", extend("examples" = [$example]))]
        pub struct $name {
            /// The amount.
            pub value: f64,
            /// What is counted.
            pub kind: Kind,
        }

        impl FromStr for $name {
            type Err = Error;

            fn from_str(text: &str) -> Result<Self, Error> {
                let units = [$(Unit { spellings: &$spellings, factor: $factor, kind: Kind::$kind }),+];
                let (value, kind) = parse(text, $what, &units)?;
                if value < 0.0 {
                    return Err(Error { found: text.to_owned(), expected: format!("{} of 0 or more", $what) });
                }
                Ok(Self { value, kind })
            }
        }

        read!($name, $what, $example);
    };
}

light!(
    /// A flux.
    Flux, "a flux", "800 lm", [["lm"] => (1.0, Luminous), ["klm"] => (1e3, Luminous), ["W"] => (1.0, Radiant), ["mW"] => (1e-3, Radiant), ["W/nm"] => (1.0, Spectral)]
);
light!(
    /// An intensity.
    Intensity, "an intensity", "1500 cd", [["cd"] => (1.0, Luminous), ["kcd"] => (1e3, Luminous), ["W/sr"] => (1.0, Radiant), ["mW/sr"] => (1e-3, Radiant), ["W/sr/nm"] => (1.0, Spectral)]
);
light!(
    /// A radiance or luminance.
    Radiance, "a radiance", "1 W/m2/sr/nm", [["cd/m2", "nit", "nt"] => (1.0, Luminous), ["kcd/m2"] => (1e3, Luminous), ["W/m2/sr", "W/sr/m2"] => (1.0, Radiant), ["W/m2/sr/nm", "W/m2srnm", "W/sr/m2/nm"] => (1.0, Spectral)]
);
light!(
    /// An irradiance, illuminance or exitance.
    Irradiance, "an irradiance", "500 lx", [["lx", "lm/m2"] => (1.0, Luminous), ["klx"] => (1e3, Luminous), ["W/m2"] => (1.0, Radiant), ["W/m2/nm", "W/m2nm"] => (1.0, Spectral)]
);

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} m", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_in_the_spellings_people_use() {
        assert_eq!("800 lm".parse(), Ok(Flux { value: 800.0, kind: Kind::Luminous }));
        assert_eq!("1e3lm".parse(), Ok(Flux { value: 1000.0, kind: Kind::Luminous }));
        assert_eq!("2.5 W".parse(), Ok(Flux { value: 2.5, kind: Kind::Radiant }));
        for text in ["1 W/m2/sr/nm", "1 W/(m²·sr·nm)", "1 W / m^2 / sr / nm"] {
            assert_eq!(text.parse(), Ok(Radiance { value: 1.0, kind: Kind::Spectral }), "{text}");
        }
        assert_eq!("100 nit".parse(), Ok(Radiance { value: 100.0, kind: Kind::Luminous }));
        assert_eq!("50 cm".parse(), Ok(Length(0.5)));
        assert_eq!("180°".parse(), Ok(Angle(std::f64::consts::PI)));
        assert_eq!("1 %".parse(), Ok(Share(0.01)));
    }

    #[test]
    fn other_units_none_and_nonsense_are_refused_with_what_was_expected() {
        let message = |text: &str| text.parse::<Flux>().unwrap_err().to_string();
        assert_eq!(message("800"), "found `800`; expected a flux: a number and one of lm, klm, W, mW, W/nm");
        assert!(message("800 cd").starts_with("found `800 cd`"));
        for text in ["", "lm", "-1 lm", "nan lm", "inf lm", "1e308 klm", "1 2 lm"] {
            assert!(text.parse::<Flux>().is_err(), "{text}");
        }
    }
}

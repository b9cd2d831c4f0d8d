//! What the models take: names, ranges and meanings of parameters, in one place for the constructors' checks, the command
//! line's help and the messages about wrong values.

use std::fmt;

use super::Brdf;

/// Why a material could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value outside its range, or not a number.
    #[error("`{name}` is {value}; expected {expected}")]
    Range {
        /// The parameter, or the sum of parameters.
        name: &'static str,
        /// What was given.
        value: f64,
        /// The range in words.
        expected: String,
    },
    /// A parameter without default is not there.
    #[error("`{name}` is missing; expected {expected}")]
    Missing {
        /// The parameter, or the choice of parameters.
        name: &'static str,
        /// What it should be.
        expected: String,
    },
    /// Two parameters say the same thing.
    #[error("both `{first}` and `{second}` are given; expected one of them")]
    Conflict {
        /// One of them.
        first: &'static str,
        /// The other.
        second: &'static str,
    },
    /// Per-band values of different lengths.
    #[error("`{name}` has {found} bands; expected {expected} as for the other parameters")]
    Bands {
        /// The parameter.
        name: &'static str,
        /// Its number of values.
        found: usize,
        /// The number of the others.
        expected: usize,
    },
}

/// What kind of value a parameter has.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Kind {
    /// One number.
    Number,
    /// A number for every band: constant, per channel, or a spectrum.
    Spectral,
    /// One of these words; the first is the default.
    Choice(&'static [&'static str]),
    /// The name of a substance whose optical constants are known.
    Medium,
}

/// A parameter of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// What it takes.
    pub kind: Kind,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Its unit, empty for a plain number.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// What it is where it is not given.
    pub default: Option<f64>,
}

impl Parameter {
    /// A number for every band, `low` to `high`.
    #[must_use]
    pub const fn spectral(name: &'static str, low: f64, high: f64, meaning: &'static str) -> Self {
        Self { name, kind: Kind::Spectral, low, high, unit: "", meaning, default: None }
    }

    /// One number, `low` to `high`.
    #[must_use]
    pub const fn number(name: &'static str, low: f64, high: f64, meaning: &'static str) -> Self {
        Self { name, kind: Kind::Number, low, high, unit: "", meaning, default: None }
    }

    /// One of several words.
    #[must_use]
    pub const fn choice(name: &'static str, words: &'static [&'static str], meaning: &'static str) -> Self {
        Self { name, kind: Kind::Choice(words), low: 0.0, high: 0.0, unit: "", meaning, default: None }
    }

    /// The name of a substance.
    #[must_use]
    pub const fn medium(name: &'static str, meaning: &'static str) -> Self {
        Self { name, kind: Kind::Medium, low: 0.0, high: 0.0, unit: "", meaning, default: None }
    }

    /// The same parameter with a default.
    #[must_use]
    pub const fn or(mut self, default: f64) -> Self {
        self.default = Some(default);
        self
    }

    /// The same parameter with a unit.
    #[must_use]
    pub const fn in_unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// The range in words: `a number from 1e-6 to 1`.
    #[must_use]
    pub fn expected(&self) -> String {
        let what = match self.kind {
            Kind::Choice(words) => return format!("one of {}", words.join(", ")),
            Kind::Medium => return "the name of a substance".to_owned(),
            Kind::Number => "a number",
            Kind::Spectral => "a number or spectrum",
        };
        let (low, high) = (plain(self.low), plain(self.high));
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        match (self.low > f64::NEG_INFINITY, self.high < f64::INFINITY) {
            (true, true) => format!("{what} from {low} to {high}{unit}"),
            (true, false) => format!("{what} from {low} up{unit}"),
            (false, true) => format!("{what} up to {high}{unit}"),
            (false, false) => format!("{what}{unit}"),
        }
    }

    /// Checks one value.
    ///
    /// # Errors
    /// [`Error::Range`] outside the range or where it is not finite.
    pub fn check(&self, value: f64) -> Result<(), Error> {
        if value.is_finite() && (self.low..=self.high).contains(&value) {
            return Ok(());
        }
        Err(Error::Range { name: self.name, value, expected: self.expected() })
    }

    /// Checks the values of all bands.
    ///
    /// # Errors
    /// As [`Parameter::check`].
    pub fn check_all(&self, values: &[f64]) -> Result<(), Error> {
        values.iter().try_for_each(|v| self.check(*v))
    }
}

/// A number without exponent where it is short without: `1e-6`, `0.04`, `1000`.
fn plain(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e5).contains(&size) { format!("{value:e}") } else { format!("{value}") }
}

impl fmt::Display for Parameter {
    /// `alpha: a number from 1e-6 to 1 (roughness)`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} ({}", self.name, self.expected(), self.meaning)?;
        match (self.kind, self.default) {
            (Kind::Choice(words), _) => write!(f, "; default {})", words[0]),
            (_, Some(default)) => write!(f, "; default {})", plain(default)),
            _ => f.write_str(")"),
        }
    }
}

/// That all of a model's spectral parameters have the same number of bands.
pub(crate) fn same_bands(expected: usize, others: &[(&'static str, usize)]) -> Result<(), Error> {
    match others.iter().find(|(_, found)| *found != expected) {
        Some((name, found)) => Err(Error::Bands { name, found: *found, expected }),
        None => Ok(()),
    }
}

/// That the sum of two parameters stays below one in every band: more would be more light than there is.
pub(crate) fn at_most_one(name: &'static str, first: &[f64], second: &[f64]) -> Result<(), Error> {
    // A rounding of the sum is no excess.
    match first.iter().zip(second).map(|(a, b)| a + b).find(|sum| *sum > 1.0 + 4.0 * f64::EPSILON) {
        Some(value) => Err(Error::Range {
            name,
            value,
            expected: "at most 1, as more would be made of light than there is".into(),
        }),
        None => Ok(()),
    }
}

/// A parameter's value on the bands.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Value {
    /// One number.
    Number(f64),
    /// A number per band.
    Spectral(Vec<f64>),
    /// One of the words of the parameter.
    Choice(&'static str),
    /// Real and imaginary part of the refractive index n − ik, per band.
    Medium(Vec<f64>, Vec<f64>),
}

/// The parameters that were given for a model, on the bands.
#[derive(Debug, Clone, PartialEq)]
pub struct Arguments {
    /// The number of bands.
    pub bands: usize,
    /// Names and values.
    pub values: Vec<(&'static str, Value)>,
}

impl Arguments {
    fn get(&self, parameter: &Parameter) -> Option<&Value> {
        self.values.iter().find(|(name, _)| *name == parameter.name).map(|(_, value)| value)
    }

    /// Whether the parameter was given.
    #[must_use]
    pub fn has(&self, parameter: &Parameter) -> bool {
        self.get(parameter).is_some()
    }

    /// One number, or the default.
    ///
    /// # Errors
    /// [`Error::Missing`] where there is neither.
    pub fn number(&self, parameter: &Parameter) -> Result<f64, Error> {
        match self.get(parameter) {
            Some(Value::Number(v)) => Ok(*v),
            _ => parameter.default.ok_or_else(|| missing(parameter)),
        }
    }

    /// A number per band, or the default in all of them.
    ///
    /// # Errors
    /// [`Error::Missing`] where there is neither.
    pub fn spectral(&self, parameter: &Parameter) -> Result<Vec<f64>, Error> {
        match self.get(parameter) {
            Some(Value::Spectral(v)) => Ok(v.clone()),
            _ => Ok(vec![parameter.default.ok_or_else(|| missing(parameter))?; self.bands]),
        }
    }

    /// One of the parameter's words; the first where none was given.
    #[must_use]
    pub fn choice(&self, parameter: &Parameter) -> &'static str {
        match (self.get(parameter), parameter.kind) {
            (Some(Value::Choice(word)), _) => word,
            (_, Kind::Choice(words)) => words[0],
            _ => "",
        }
    }

    /// Refractive index of a substance, n and k per band, where one was named.
    #[must_use]
    pub fn medium(&self, parameter: &Parameter) -> Option<(Vec<f64>, Vec<f64>)> {
        match self.get(parameter) {
            Some(Value::Medium(n, k)) => Some((n.clone(), k.clone())),
            _ => None,
        }
    }
}

fn missing(parameter: &Parameter) -> Error {
    Error::Missing { name: parameter.name, expected: parameter.expected() }
}

/// A model by name: what it takes and how it is made.
#[derive(Debug, Clone, Copy)]
pub struct Model {
    /// Name in material descriptions.
    pub name: &'static str,
    /// One line: what it is.
    pub summary: &'static str,
    /// What it takes.
    pub parameters: &'static [Parameter],
    /// Makes it from its parameters.
    pub build: fn(&Arguments) -> Result<Box<dyn Brdf>, Error>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_read_as_people_say_them() {
        let alpha = Parameter::number("alpha", 1e-6, 1.0, "roughness").or(0.1);
        assert_eq!(alpha.to_string(), "alpha: a number from 1e-6 to 1 (roughness; default 0.1)");
        assert_eq!(
            alpha.check(2.0).expect_err("too large").to_string(),
            "`alpha` is 2; expected a number from 1e-6 to 1"
        );
        assert!(alpha.check(f64::NAN).is_err() && alpha.check(1e-6).is_ok());
        let sigma = Parameter::number("sigma", 0.0, f64::INFINITY, "spread").in_unit("deg");
        assert_eq!(sigma.expected(), "a number from 0 up deg");
        assert_eq!(Parameter::choice("form", &["classic", "new"], "which").expected(), "one of classic, new");
    }

    #[test]
    fn sums_and_lengths_are_held() {
        assert!(at_most_one("kd + ks", &[0.1, 0.4], &[0.9, 0.6]).is_ok());
        let error = at_most_one("kd + ks", &[0.1, 0.5], &[0.9, 0.6]).expect_err("1.1");
        assert!(error.to_string().starts_with("`kd + ks` is 1.1; expected at most 1"), "{error}");
        assert_eq!(same_bands(3, &[("k", 2)]), Err(Error::Bands { name: "k", found: 2, expected: 3 }));
    }
}

//! What is known of a measurement's errors, in words: TOML in, a typed and checked budget out. No file is opened here.
//!
//! `docs/uncertainty.md` explains the budget with examples; [`schema`] prints it as a JSON schema. Every number is a standard
//! uncertainty (k = 1) or says what else it is; paths of tables are relative to the budget.

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::Deserialize;

use super::table::{Covariance, Error as TableError, Table};
use crate::mistake::{self, Mistake};
use crate::spectrum::Grid;

/// The contributions to the uncertainty of one measured spectrum.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Budget {
    /// A name for reports.
    pub title: Option<String>,
    /// Errors that differ from sample to sample: noise, readout.
    pub noise: Vec<Noise>,
    /// Errors of the calibration, which neighbouring wavelengths share.
    pub calibration: Vec<Calibration>,
    /// The wavelength axis.
    pub wavelength: Option<Wavelength>,
    /// The bandwidth of the instrument.
    pub bandwidth: Option<Bandwidth>,
    /// Stray light.
    pub stray_light: Option<StrayLight>,
    /// Departure from proportionality.
    pub linearity: Option<Linearity>,
    /// Distance between source and receiver.
    pub distance: Option<Distance>,
    /// Aperture that limits the receiving or emitting area.
    pub aperture: Option<Aperture>,
    /// Factors that all samples share.
    pub scale: Vec<Scale>,
    /// The simulation.
    pub monte_carlo: MonteCarlo,
}

/// A number that is not negative.
#[derive(Debug, Clone, Copy, Default, PartialEq, PartialOrd, Deserialize, JsonSchema)]
#[serde(try_from = "f64")]
#[schemars(with = "f64", extend("minimum" = 0))]
pub struct NotNegative(pub f64);

impl TryFrom<f64> for NotNegative {
    type Error = String;

    fn try_from(found: f64) -> Result<Self, String> {
        if found >= 0.0 {
            Ok(Self(found))
        } else {
            Err(format!("found `{found}`; expected a number that is not negative"))
        }
    }
}

/// A positive number.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Deserialize, JsonSchema)]
#[serde(try_from = "f64")]
#[schemars(with = "f64", extend("exclusiveMinimum" = 0))]
pub struct Positive(pub f64);

impl TryFrom<f64> for Positive {
    type Error = String;

    fn try_from(found: f64) -> Result<Self, String> {
        if found > 0.0 { Ok(Self(found)) } else { Err(format!("found `{found}`; expected a positive number")) }
    }
}

/// The distribution of an error whose standard uncertainty is stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Distribution {
    /// Gaussian.
    #[default]
    Normal,
    /// Even between two limits, √3 standard uncertainties from the middle.
    Rectangular,
    /// Falling to both limits, √6 standard uncertainties from the middle.
    Triangular,
}

/// Independent errors of the samples, normally distributed. The parts that are given add up in quadrature.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Noise {
    /// A name for the budget table.
    pub name: Option<String>,
    /// Of each sample, as a fraction of it.
    pub relative: NotNegative,
    /// Of each sample, as a fraction of the largest.
    pub of_peak: NotNegative,
    /// Of each sample, in its SI unit per nm (of a relative spectrum, in its own).
    pub absolute: NotNegative,
    /// A CSV file of wavelength (nm) and relative uncertainty.
    pub relative_table: Option<String>,
    /// A CSV file of wavelength (nm) and uncertainty in the samples' SI unit per nm.
    pub absolute_table: Option<String>,
    /// As the column of standard uncertainties `u(…)` says that stands beside the samples in their file.
    pub column: bool,
    /// A CSV file of the covariance of the samples in their SI unit per nm squared: wavelengths (nm) in the first row and in the first
    /// column. It stands alone in its table.
    pub covariance: Option<String>,
    /// The relative table, once read.
    #[serde(skip)]
    pub relative_read: Option<Table>,
    /// The absolute table, once read, or the column.
    #[serde(skip)]
    pub absolute_read: Option<Table>,
    /// The covariance, once read.
    #[serde(skip)]
    pub covariance_read: Option<Covariance>,
}

/// A relative error that wavelengths share. One of `relative`, `table` and `covariance` is expected.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Calibration {
    /// A name for the budget table.
    pub name: Option<String>,
    /// At every wavelength.
    pub relative: Option<NotNegative>,
    /// A CSV file of wavelength (nm) and relative uncertainty.
    pub table: Option<String>,
    /// A CSV file of the relative covariance: wavelengths (nm) in the first row and in the first column.
    pub covariance: Option<String>,
    /// Correlation of two wavelengths: exp(−|Δλ|/length), nm. Without it all wavelengths err alike.
    pub correlation_length_nm: Option<Positive>,
    /// Distribution, where all wavelengths err alike.
    pub distribution: Distribution,
    /// The table, once read.
    #[serde(skip)]
    pub table_read: Option<Table>,
    /// The covariance, once read.
    #[serde(skip)]
    pub covariance_read: Option<Covariance>,
}

/// Errors of the wavelength axis: a sample said to be of λ is of λ + offset + scale · (λ − about).
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wavelength {
    /// Offset, nm.
    #[serde(default)]
    pub offset_nm: NotNegative,
    /// Scale, a pure number.
    #[serde(default)]
    pub scale: NotNegative,
    /// Where the scale is right, nm.
    #[serde(default = "middle")]
    pub about_nm: Positive,
    /// Distribution of both.
    #[serde(default)]
    pub distribution: Distribution,
}

fn middle() -> Positive {
    Positive(555.0)
}

/// A triangular slit function whose width is known so well.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bandwidth {
    /// Full width at half maximum, nm.
    pub fwhm_nm: Positive,
    /// Its standard uncertainty, nm.
    pub standard_nm: NotNegative,
    /// Distribution.
    #[serde(default)]
    pub distribution: Distribution,
}

/// Light of other wavelengths that a sample holds, alike at all of them.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrayLight {
    /// Standard uncertainty of the level, as a fraction of the mean over the measured range.
    pub fraction: NotNegative,
    /// Distribution.
    #[serde(default)]
    pub distribution: Distribution,
}

/// A reading that is not quite proportional: right at the largest sample, off by up to `relative` towards the smallest.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Linearity {
    /// Standard uncertainty of the smallest readings, relative to them.
    pub relative: NotNegative,
    /// Distribution.
    #[serde(default)]
    pub distribution: Distribution,
}

/// The distance from source to receiver; the reading goes with its inverse square.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Distance {
    /// Distance, m.
    pub distance_m: Positive,
    /// Its standard uncertainty, m.
    pub standard_m: NotNegative,
    /// Distribution.
    #[serde(default)]
    pub distribution: Distribution,
}

/// A round aperture, by whose area the reading is divided.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Aperture {
    /// Diameter, m.
    pub diameter_m: Positive,
    /// Its standard uncertainty, m.
    pub standard_m: NotNegative,
    /// Distribution.
    #[serde(default)]
    pub distribution: Distribution,
}

/// A factor that all samples share.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scale {
    /// A name for the budget table.
    #[serde(default)]
    pub name: Option<String>,
    /// Relative standard uncertainty.
    pub relative: NotNegative,
    /// Distribution.
    #[serde(default)]
    pub distribution: Distribution,
}

/// The simulation of JCGM 101.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MonteCarlo {
    /// Number of trials; without it as many as it takes for every figure to settle (JCGM 101, 7.9).
    pub trials: Option<u64>,
    /// Significant digits of the standard uncertainties that have to settle: 1 or 2.
    pub digits: Digits,
    /// Most trials while settling.
    pub most_trials: u64,
    /// Names all random numbers.
    pub seed: u64,
}

/// One or two significant digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(try_from = "u32")]
#[schemars(with = "u32", extend("enum" = [1, 2]))]
pub struct Digits(pub(super) i32);

impl TryFrom<u32> for Digits {
    type Error = String;

    fn try_from(found: u32) -> Result<Self, String> {
        match found {
            1 => Ok(Self(1)),
            2 => Ok(Self(2)),
            _ => Err(format!("found `{found}`; expected 1 or 2 significant digits")),
        }
    }
}

impl Default for MonteCarlo {
    fn default() -> Self {
        Self { trials: None, digits: Digits(1), most_trials: 200_000, seed: 1 }
    }
}

/// Why a budget was not read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// In the budget itself.
    #[error("{0}")]
    Budget(#[from] Mistake),
    /// In a table that it names.
    #[error("{path}:{error}")]
    Table {
        /// The table as the budget names it.
        path: String,
        /// What is wrong with it.
        error: TableError,
    },
    /// A table that it names could not be read.
    #[error("{path}: {why}; expected the table that the budget names, relative to it")]
    Unreadable {
        /// The table as the budget names it.
        path: String,
        /// What the reader said.
        why: String,
    },
}

impl Budget {
    /// Reads a budget; `read` gives the text of a table that it names.
    ///
    /// # Errors
    /// [`Error`]: the first mistake in TOML, in keys, in types and in tables.
    pub fn parse(text: &str, read: impl Fn(&str) -> Result<String, String>) -> Result<Self, Error> {
        let mut budget: Self = mistake::parse(text)?;
        budget.check(text)?;
        let text_of = |path: &String| read(path).map_err(|why| Error::Unreadable { path: path.clone(), why });
        let table = |path: &Option<String>| -> Result<Option<Table>, Error> {
            let Some(path) = path else { return Ok(None) };
            Table::parse(&text_of(path)?).map(Some).map_err(|error| Error::Table { path: path.clone(), error })
        };
        let covariance = |path: &Option<String>| -> Result<Option<Covariance>, Error> {
            let Some(path) = path else { return Ok(None) };
            let read = Covariance::parse(&text_of(path)?);
            read.map(Some).map_err(|error| Error::Table { path: path.clone(), error })
        };
        for noise in &mut budget.noise {
            noise.relative_read = table(&noise.relative_table)?;
            noise.absolute_read = table(&noise.absolute_table)?;
            noise.covariance_read = covariance(&noise.covariance)?;
        }
        for calibration in &mut budget.calibration {
            calibration.table_read = table(&calibration.table)?;
            calibration.covariance_read = covariance(&calibration.covariance)?;
        }
        Ok(budget)
    }

    /// The budget of one spectrum: where noise is as a column beside the samples says, with that column, if there is one.
    #[must_use]
    pub fn with_column(&self, grid: &Grid, standard: Option<&[f64]>) -> Cow<'_, Self> {
        match standard.filter(|_| self.noise.iter().any(|n| n.column)) {
            None => Cow::Borrowed(self),
            Some(standard) => {
                let table = Table::of(grid, standard);
                let mut own = self.clone();
                own.noise.iter_mut().filter(|n| n.column).for_each(|n| n.absolute_read = Some(table.clone()));
                Cow::Owned(own)
            }
        }
    }

    /// What types cannot say.
    fn check(&self, text: &str) -> Result<(), Mistake> {
        let refuse = |header: &str, index: usize, message: &str| {
            let start = text.match_indices(header).nth(index).map_or(0, |(at, _)| at);
            Err(Mistake::at(text, &(start..start), message))
        };
        for (i, n) in self.noise.iter().enumerate() {
            let alone = Noise { name: n.name.clone(), covariance: n.covariance.clone(), ..Noise::default() };
            if n.covariance.is_some() && *n != alone {
                return refuse("[[noise]]", i, "found covariance beside other noise; expected a [[noise]] of its own");
            }
            if n.column && n.absolute_table.is_some() {
                return refuse("[[noise]]", i, "found column beside absolute_table; expected one of them");
            }
        }
        for (i, c) in self.calibration.iter().enumerate() {
            let given = usize::from(c.relative.is_some())
                + usize::from(c.table.is_some())
                + usize::from(c.covariance.is_some());
            if given != 1 {
                let message = format!("found {given} of relative, table and covariance; expected one of them");
                return refuse("[[calibration]]", i, &message);
            }
            if c.covariance.is_some() && c.correlation_length_nm.is_some() {
                let message =
                    "found correlation_length_nm beside covariance, which holds the correlation; expected one of them";
                return refuse("[[calibration]]", i, message);
            }
        }
        let m = &self.monte_carlo;
        if m.trials.is_some_and(|t| t < 100) || m.most_trials < 20_000 {
            let message = "found too few trials; expected at least 100 trials, and 20000 most_trials, from which a 95 % interval can be told";
            return refuse("[monte_carlo]", 0, message);
        }
        Ok(())
    }
}

/// The JSON schema of budgets (draft 2020-12).
#[must_use]
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Budget).to_value()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
[[noise]]
relative = 0.01
[[calibration]]
table = \"cal.csv\"
correlation_length_nm = 40
[wavelength]
offset_nm = 0.2
";

    fn parse(text: &str) -> Result<Budget, Error> {
        Budget::parse(text, |path| match path {
            "cal.csv" => Ok("wavelength_nm,u\n400,0.02\n700,0.01\n".into()),
            _ => Err("no such file".into()),
        })
    }

    #[test]
    fn a_budget_is_read_with_its_tables() {
        let budget = parse(TEXT).expect("a budget");
        assert_eq!(budget.calibration[0].table_read.as_ref().map(|t| t.at(550.0)), Some(0.015));
        assert_eq!(budget.wavelength.map(|w| w.about_nm), Some(Positive(555.0)));
        assert!(schema().to_string().contains("correlation_length_nm"));
    }

    #[test]
    fn mistakes_are_told_with_their_place() {
        let message = |from: &str, to: &str| parse(&TEXT.replacen(from, to, 1)).expect_err(to).to_string();
        assert!(message("relative", "relativ").starts_with("2:1: unknown field `relativ`"));
        assert!(message("0.01", "-0.01").starts_with("2:12: found `-0.01`; expected a number that is not negative"));
        assert!(message("= 40", "= 0").starts_with("5:25: found `0`; expected a positive number"));
        assert!(message("table = \"cal.csv\"", "").starts_with("3:1: found 0 of relative, table and covariance"));
        assert!(message("cal.csv", "no.csv").starts_with("no.csv: no such file; expected"));
    }
}

//! Uncertainty of every figure of a measured spectrum (JCGM 100 and 101, CIE 198): a budget of contributions, propagated both to
//! first order with the full covariance and by simulation.
//!
//! - [`budget`]: what is known of the errors, read from TOML; [`table`]: the tables that it names.
//! - [`evaluate`]: the uncertainty of every figure of a conversion, the share of each contribution, and what both ways of
//!   propagation disagree in.
//! - [`compare`]: differences of two measurements; [`shared`]: what of them errs together.
//! - [`Stated`]: a standard uncertainty and an interval of 95 %, which need not lie evenly about the figure.
//!
//! ```
//! use photopic::conversion::{Converter, Settings};
//! use photopic::spectrum::{Grid, Quantity, Spectrum};
//! use photopic::uncertainty::{Measurand, budget::Budget, evaluate};
//!
//! let budget = Budget::parse("scale = [{ relative = 0.02 }]", |_| unreachable!("no table is named"))?;
//! let grid = Grid::uniform(380.0, 5.0, 81)?;
//! let spectrum = Spectrum::density(grid, vec![1e-3; 81])?;
//! let found = evaluate(&Converter::new(Settings::default()), &budget, Quantity::Irradiance, &spectrum)?.value;
//! let lux = found.figure(Measurand::Photopic).expect("an irradiance has an illuminance");
//! let stated = lux.stated.expect("defined");
//! assert!((stated.standard / lux.value - 0.02).abs() < 1e-10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use nalgebra::DMatrix;

use crate::conversion::{self, Converter};
use crate::finding::{Checked, Finding};
use crate::spectrum::{Quantity, Spectrum};
use crate::units::significant;

mod analytic;
pub mod budget;
pub mod compare;
pub mod detector;
mod measurand;
mod model;
mod monte_carlo;
pub mod shared;
pub mod table;

pub use measurand::Measurand;
pub use monte_carlo::Sampled;

use budget::Budget;
use measurand::Figures;
use model::Model;

/// Numbers that follow from the samples of a spectrum.
trait Outputs: Sync {
    /// Room that is kept from one evaluation to the next.
    type Scratch: Default + Send;

    /// How many numbers.
    fn count(&self) -> usize;

    /// Writes them for the samples given, NaN where undefined.
    fn evaluate(&self, values: &[f64], scratch: &mut Self::Scratch, out: &mut [f64]);
}

/// Half-width of the interval of 95 % of a normal distribution, in standard deviations.
pub const COVERAGE_FACTOR_95: f64 = 1.959_963_984_540_054;
/// From this share of undefined trials on no interval of 95 % is stated: either of its ends may be among them.
const MOST_UNDEFINED: f64 = 0.025;
/// A mean of the trials so many standard uncertainties from the figure tells that errors do not cancel in it.
const BIASED: f64 = 0.5;
/// Figures named in a finding.
const NAMED: usize = 6;

/// Why no uncertainty was evaluated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The conversion itself.
    #[error(transparent)]
    Conversion(#[from] conversion::Error),
    /// Nothing in the budget.
    #[error("an empty budget; expected a contribution, such as [[noise]], [[calibration]] or [[scale]]")]
    Empty,
    /// Noise as a column says that is not there.
    #[error(
        "the budget takes noise from a column of standard uncertainties ([[noise]] column); expected one beside the samples, headed u(…)"
    )]
    NoColumn,
    /// Nothing to err about.
    #[error("no sample of the spectrum is positive; expected a spectrum with light in it")]
    Dark,
    /// Wavelength and bandwidth need a slope.
    #[error("an uncertainty of wavelength or bandwidth of {} {}; expected a continuous spectrum of at least three samples", .samples, if *.lines { "lines" } else { "samples" })]
    NoSlope {
        /// Samples.
        samples: usize,
        /// A line spectrum.
        lines: bool,
    },
}

/// A standard uncertainty and an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stated {
    /// Standard uncertainty, in the unit of the figure.
    pub standard: f64,
    /// Ends of the interval that holds 95 %, 2.5 % being outside on either side.
    pub expanded_95: [f64; 2],
}

impl Stated {
    /// Of a mean with its standard error: the interval reaches `t` standard errors to either side, Student's t of 0.975 for the
    /// degrees of freedom of the error (JCGM 100, G.3).
    #[must_use]
    pub fn of_mean(value: f64, standard_error: f64, t: f64) -> Self {
        Self { standard: standard_error, expanded_95: [value - t * standard_error, value + t * standard_error] }
    }
}

/// How a figure's stated uncertainty was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// First-order propagation, exact for this figure.
    Analytic,
    /// Simulation.
    MonteCarlo,
}

/// The uncertainty of one figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FigureUncertainty {
    /// Which figure.
    pub measurand: Measurand,
    /// Its value; NaN where it is not defined.
    pub value: f64,
    /// What is stated; `None` where the figure is not defined, or not in 2.5 % of the trials.
    pub stated: Option<Stated>,
    /// How.
    pub method: Method,
    /// Standard uncertainty to first order; `None` where the figure has no derivative.
    pub analytic: Option<f64>,
    /// What the trials say.
    pub sampled: Sampled,
}

/// One row of the budget.
#[derive(Debug, Clone, PartialEq)]
pub struct Contribution {
    /// Its name.
    pub name: String,
    /// Standard uncertainty that it alone causes to first order, by figure, in the order of [`Uncertainty::figures`].
    pub standard: Vec<f64>,
}

/// The uncertainty of all figures of one spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// By figure.
    pub figures: Vec<FigureUncertainty>,
    /// By contribution, in the order of the budget.
    pub contributions: Vec<Contribution>,
    /// Covariance of the figures to first order, in the order of `figures`.
    pub covariance: DMatrix<f64>,
    /// Trials made.
    pub trials: u64,
    /// Whether their number was chosen by the adaptive procedure.
    pub adaptive: bool,
    /// The seed of the trials.
    pub seed: u64,
}

impl Uncertainty {
    /// The uncertainty of a figure.
    #[must_use]
    pub fn figure(&self, measurand: Measurand) -> Option<&FigureUncertainty> {
        self.figures.iter().find(|f| f.measurand == measurand)
    }

    /// The contributions to a figure as shares of its first-order variance, the largest first.
    #[must_use]
    pub fn ranking(&self, measurand: Measurand) -> Vec<(&str, f64)> {
        let Some(at) = self.figures.iter().position(|f| f.measurand == measurand) else { return Vec::new() };
        let total: f64 = self.contributions.iter().map(|c| c.standard[at].powi(2)).sum();
        let mut out: Vec<(&str, f64)> = self
            .contributions
            .iter()
            .map(|c| (c.name.as_str(), if total > 0.0 { c.standard[at].powi(2) / total } else { 0.0 }))
            .collect();
        out.sort_by(|a, b| b.1.total_cmp(&a.1));
        out
    }
}

/// The uncertainty of every figure that `converter` gives for a spectrum.
///
/// Figures proportional to the samples have their first-order uncertainty, which is exact, and a normal interval where every error
/// is normally distributed; all others are stated as the trials say.
///
/// # Errors
/// [`Error`]: a budget that does not fit the spectrum, settings that do not.
pub fn evaluate(
    converter: &Converter,
    budget: &Budget,
    quantity: Quantity,
    spectrum: &Spectrum,
) -> Result<Checked<Uncertainty>, Error> {
    let mut findings = Vec::new();
    let model = Model::new(budget, spectrum, &mut findings)?;
    let figures = Figures::new(converter, quantity, spectrum)?;
    let propagated = analytic::propagate(&model, &figures);
    let simulation = monte_carlo::simulate(&model, &figures, &budget.monte_carlo);
    let normal = model.is_normal();
    let one = |(k, (&measurand, sampled)): (usize, (&Measurand, &Sampled))| {
        let value = figures.values[k];
        let analytic = Some(variance(propagated.covariance[(k, k)]).sqrt()).filter(|u| u.is_finite());
        let exact = analytic.filter(|_| figures.is_proportional() && measurand.is_linear());
        let half = exact.filter(|_| normal).map(|u| COVERAGE_FACTOR_95 * u);
        let stated = Stated {
            standard: exact.unwrap_or(sampled.standard),
            expanded_95: half.map_or(sampled.expanded_95, |h| [value - h, value + h]),
        };
        let told = value.is_finite() && sampled.undefined < MOST_UNDEFINED && stated.standard.is_finite();
        FigureUncertainty {
            measurand,
            value,
            stated: told.then_some(stated),
            method: if exact.is_some() { Method::Analytic } else { Method::MonteCarlo },
            analytic,
            sampled: *sampled,
        }
    };
    let all: Vec<FigureUncertainty> = figures.list.iter().zip(&simulation.figures).enumerate().map(one).collect();
    tell(&all, &simulation, budget, &mut findings);
    let contributions = model
        .inputs
        .iter()
        .zip(propagated.standard)
        .map(|(input, standard)| Contribution { name: input.name.clone(), standard })
        .collect();
    let value = Uncertainty {
        figures: all,
        contributions,
        covariance: propagated.covariance,
        trials: simulation.trials,
        adaptive: budget.monte_carlo.trials.is_none(),
        seed: budget.monte_carlo.seed,
    };
    Ok(Checked { value, findings })
}

/// A variance that rounding may have left below zero; NaN where there is none.
fn variance(found: f64) -> f64 {
    if found < 0.0 { 0.0 } else { found }
}

/// What there is to say about the figures.
fn tell(all: &[FigureUncertainty], simulation: &monte_carlo::Simulation, budget: &Budget, findings: &mut Vec<Finding>) {
    let some = |chosen: Vec<String>| {
        let more = chosen.len().saturating_sub(NAMED);
        let named: Vec<String> = chosen.into_iter().take(NAMED).collect();
        if more > 0 { format!("{} and {more} more", named.join("; ")) } else { named.join("; ") }
    };
    let defined = || all.iter().filter(|f| f.value.is_finite());
    let differing: Vec<&FigureUncertainty> = defined().filter(|f| disagrees(f)).collect();
    if !differing.is_empty() {
        let of = |f: &&FigureUncertainty| {
            let [low, high] = f.sampled.expanded_95;
            format!(
                "{} ± {} to first order, {} to {} simulated",
                f.measurand,
                significant(COVERAGE_FACTOR_95 * f.analytic.unwrap_or(f64::NAN), 2),
                significant(low, 5),
                significant(high, 5)
            )
        };
        let message = format!(
            "first-order propagation and simulation disagree (JCGM 101, 8): {}; the simulated ones are stated",
            some(differing.iter().map(of).collect())
        );
        findings.push(Finding::info("U001", message));
    }
    if !simulation.unsettled.is_empty() {
        let names = simulation.unsettled.iter().map(|k| all[*k].measurand.to_string()).collect();
        let message = format!(
            "after {} trials not settled to {} significant digit(s) of the standard uncertainty: {}",
            simulation.trials,
            budget.monte_carlo.digits.0,
            some(names)
        );
        findings.push(Finding::warning("U002", message).hint("raise most_trials in [monte_carlo]"));
    }
    let undefined: Vec<String> = defined()
        .filter(|f| f.sampled.undefined > 0.0)
        .map(|f| format!("{} in {} % of the trials", f.measurand, significant(100.0 * f.sampled.undefined, 2)))
        .collect();
    if !undefined.is_empty() {
        let message = format!(
            "not defined within the uncertainty: {}; from 2.5 % on no interval is stated, below it is that of the rest",
            some(undefined)
        );
        findings.push(Finding::warning("U003", message));
    }
    let biased: Vec<String> = defined()
        .filter(|f| {
            (f.sampled.mean - f.value).abs() > BIASED * f.sampled.standard && f.sampled.standard > 1e-9 * f.value.abs()
        })
        .map(|f| format!("{} by {}", f.measurand, significant(f.sampled.mean - f.value, 2)))
        .collect();
    if !biased.is_empty() {
        let message = format!(
            "errors do not cancel but shift the figure by more than half its standard uncertainty: {}",
            some(biased)
        );
        findings.push(Finding::info("U005", message).hint("a measurement with such errors is off by as much already"));
    }
}

/// JCGM 101, 8.1: either end of the interval differs by more than half a unit of the first digit of u, the trials' own scatter aside.
fn disagrees(f: &FigureUncertainty) -> bool {
    let Some(u) = f.analytic else { return true };
    let [low, high] = f.sampled.expanded_95;
    // A peak jumps from sample to sample and has no derivative to propagate.
    if f.measurand == Measurand::PeakWavelength || f.sampled.standard <= 1e-9 * f.value.abs() {
        return false;
    }
    let tolerance = monte_carlo::tolerance(f.sampled.standard, 1);
    let off = |end: f64, sign: f64, error: f64| {
        let scatter = if error.is_finite() { 3.0 * error } else { 0.2 * f.sampled.standard };
        (f.value + sign * COVERAGE_FACTOR_95 * u - end).abs() > tolerance + scatter
    };
    off(low, -1.0, f.sampled.errors[2]) || off(high, 1.0, f.sampled.errors[3])
}

#[cfg(test)]
mod tests;

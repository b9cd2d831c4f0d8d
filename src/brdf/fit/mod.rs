//! Fitting: the parameters of a model, or of a sum of models, that bring it nearest to a measured table.
//!
//! ```text
//! minimise Σ_places Σ_bands w r(f(ω_i, ω_o; θ), y)²        r by the chosen measure (metric)
//! ```
//!
//! Bounded Levenberg-Marquardt ([`crate::math::least_squares`]) from several starts on a subset of the places; the lowest valleys
//! are followed on a larger one, and the lowest of them on all. Parameters that enter linearly need no treatment of their own: one step of the method solves them. Only measured places
//! take part, none that a table would interpolate.
//!
//! **Standard errors** are those of the linearised model, over the variables that rest at no bound:
//!
//! ```text
//! standard          s² (JᵀWJ)⁻¹,  s² = Σ w r²/(N − k)          residuals independent, their variance ∝ 1/w
//! robust            (JᵀWJ)⁻¹ Jᵀ(w² r²)J (JᵀWJ)⁻¹ · N/(N − k)    independent, of any variance (White 1980, HC1)
//! ```
//!
//! An error that all values have in common ([`Samples::with_common`]), d in r with one standard uncertainty, moves the parameters by
//! m = (JᵀWJ)⁻¹ JᵀW d and adds m mᵀ to both. N is the number of values (places times bands), k that of the variables. Neither knows that a model may be wrong: where it misses the
//! table by more than the noise, residuals of neighbours are alike, and both are too small. Derivatives by the parameters are carried
//! over from those by the coordinates of the fit to first order. A parameter at a bound has no standard error, nor have those that the data
//! cannot tell apart (JᵀWJ scaled to a unit diagonal with a condition beyond 1e10).
//!
//! **Criteria** for comparing models on the same values under the same measure, with a Gaussian likelihood of unknown variance:
//!
//! ```text
//! AIC = N ln(Σ w r²/N) + 2K      AICc = AIC + 2K(K + 1)/(N − K − 1)      BIC = N ln(Σ w r²/N) + K ln N      K = k + 1
//! ```
//!
//! References: A. Ngan, F. Durand & W. Matusik, *Experimental Analysis of BRDF Models*, EGSR 2005; H. White, Econometrica 48 (1980);
//! K. P. Burnham & D. R. Anderson, *Model Selection and Multimodel Inference*, 2nd ed. (2002), §2.4, §2.6 (differences below 2).

mod compare;
mod coordinates;
mod metric;
mod objective;
mod samples;
mod statistics;

use rayon::prelude::*;

pub use compare::{Comparison, Ranked, TOO_CLOSE, compare};
pub use metric::{Measures, Metric};
pub use samples::{Samples, Selection, Weighting};
pub use statistics::{Criteria, Estimate, Uncertainty};

use self::coordinates::Coordinates;
use self::metric::{Residual, measure};
use self::objective::Objective;
use super::Brdf;
use super::description::template::Template;
use super::description::{self, Bands, Material};
use super::table::Channel;
use crate::math::least_squares::{Limits, Minimum, minimise};

/// Why there is no fit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A band that the table does not have.
    #[error("band {band} of a table of {bands}; expected 1 to {bands}")]
    Band {
        /// The band, from 1.
        band: usize,
        /// How many there are.
        bands: usize,
    },
    /// No place takes part.
    #[error(
        "none of the {places} places of the table has a value with both directions within {max_theta_deg}° of the normal; expected more places than free parameters"
    )]
    NoPlaces {
        /// Places of the table.
        places: usize,
        /// The limit.
        max_theta_deg: f64,
    },
    /// Too few values for the parameters.
    #[error("{values} values for {parameters} free parameters; expected more values than parameters")]
    TooFew {
        /// Values that take part.
        values: usize,
        /// Free parameters.
        parameters: usize,
    },
    /// No parameter is left open.
    #[error("no parameter is open; expected `?` in the place of a value, or a model without parentheses")]
    NothingOpen,
    /// No open parameter has this name.
    #[error("no open parameter is called `{name}`; expected one of {known}, or `all`")]
    Name {
        /// The name.
        name: String,
        /// Those that are open.
        known: String,
    },
    /// A parameter that the model has once for all bands.
    #[error(
        "`{name}` is one number for all bands of the model; expected a fit of one band at a time for a value per band"
    )]
    OneNumber {
        /// The parameter.
        name: &'static str,
    },
    /// The model cannot be made.
    #[error("{0}")]
    Model(#[from] description::Error),
    /// All light leaves in a Dirac lobe.
    #[error("the model has nothing but a Dirac lobe, which has no values; expected one with a smooth part")]
    Dirac,
    /// The sums are not finite at any start.
    #[error(
        "the model has no finite sum of squares at any of {starts} starts; expected starts in reach, such as `alpha=?0.1`"
    )]
    NoStart {
        /// How many there were.
        starts: usize,
    },
}

/// Which open parameters have one value for all bands, by name: `f0`, `ggx.f0`, `2.f0` for the second model of a sum, or `all`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scope {
    /// One value for all bands.
    pub shared: Vec<String>,
    /// One value per band: the default for parameters that may have one.
    pub per_band: Vec<String>,
}

impl Scope {
    const ALL: &'static str = "all";

    /// What of it concerns one of several models: a name that another of them has is none of this one's business; a name that none has
    /// stays, to be refused.
    #[must_use]
    pub fn of(&self, template: &Template, among: &[Template]) -> Self {
        let has = |name: &str, t: &Template| t.open().iter().any(|o| coordinates::names(name, o));
        let kept = |names: &[String]| {
            let concerns = |n: &&String| has(n, template) || !among.iter().any(|t| has(n, t));
            names.iter().filter(concerns).cloned().collect()
        };
        Self { shared: kept(&self.shared), per_band: kept(&self.per_band) }
    }
}

/// How to fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// What is minimised.
    pub metric: Metric,
    /// ε of the logarithmic and the relative measure, 1/sr.
    pub epsilon: f64,
    /// Shared and per-band parameters.
    pub scope: Scope,
    /// Number of starts, at least 1.
    pub starts: usize,
    /// Places of the subset on which the starts run.
    pub first_places: usize,
    /// Places of the final fit; all where not given.
    pub places: Option<usize>,
}

impl Default for Options {
    fn default() -> Self {
        let scope = Scope::default();
        Self { metric: Metric::Cosine, epsilon: 1e-3, scope, starts: 12, first_places: 2000, places: None }
    }
}

/// A fitted model.
#[derive(Debug)]
pub struct Fit {
    /// The model with its open places.
    pub template: Template,
    /// The model with its values.
    pub material: Material,
    /// The same, prepared for the bands of the table.
    pub brdf: Box<dyn Brdf>,
    /// The estimates, in the order of the open parameters, band by band.
    pub estimates: Vec<Estimate>,
    /// Their correlations, in the same order; `None` for those without a standard error.
    pub correlations: Vec<Vec<Option<f64>>>,
    /// Smallest over largest eigenvalue of JᵀWJ scaled to a unit diagonal.
    pub condition: f64,
    /// Estimates that the data cannot tell apart, by their numbers.
    pub inseparable: Vec<usize>,
    /// All measures, over all places.
    pub measures: Measures,
    /// For comparing models; absent where the largest difference was minimised, or nothing is left over.
    pub criteria: Option<Criteria>,
    /// Number of values that the parameters come from.
    pub values: usize,
    /// Number of places that they come from.
    pub places: usize,
    /// How many starts there were, and how many of them came to within 0.1 % of the least sum of squares.
    pub starts: (usize, usize),
    /// Whether the last minimisation came to rest.
    pub converged: bool,
}

impl Fit {
    /// Takes the larger of both standard errors of an estimate for the one under equal variances: where weights are not the reciprocals of the
    /// variances, or the model is not quite the samples', it is the robust one that holds; of few samples it is itself uncertain.
    pub fn widen_errors(&mut self) {
        for estimate in &mut self.estimates {
            if let Uncertainty::Known { standard, robust } = &mut estimate.uncertainty {
                *standard = standard.max(*robust);
            }
        }
    }

    /// `ggx.alpha`, or with the number of the model in the sum where two are alike: `2.ggx.alpha`.
    #[must_use]
    pub fn name_of(&self, estimate: &Estimate) -> String {
        let open = &self.template.open()[estimate.open];
        let twins = self.template.open().iter().any(|o| o.model == open.model && o.part != open.part);
        let number = if twins { format!("{}.", open.part + 1) } else { String::new() };
        format!("{number}{}.{}", open.model, open.parameter.name)
    }
}

/// Limits of the minimisation on the subset.
const FIRST: Limits = Limits { iterations: 60, step: 1e-6, gain: 1e-9 };
/// Valleys that are followed beyond the first subset.
const VALLEYS: usize = 3;
/// Places of a second, larger subset, on which they are.
const MIDDLE_PLACES: usize = 40_000;
/// And on all places.
const LAST: Limits = Limits { iterations: 100, step: 1e-9, gain: 1e-12 };
/// Powers by which the largest difference is approached.
const POWERS: [f64; 5] = [4.0, 8.0, 16.0, 32.0, 64.0];

/// The bands of a table for its models: wavelengths where all channels are such.
#[must_use]
pub fn wavelengths(channels: &[Channel]) -> Option<Vec<f64>> {
    channels.iter().map(|c| if let Channel::Wavelength(nm) = c { Some(*nm) } else { None }).collect()
}

/// Fits a model to the measured places of a table.
///
/// # Errors
/// [`Error`].
pub fn fit(template: &Template, samples: &Samples, options: &Options) -> Result<Fit, Error> {
    let nm = wavelengths(samples.channels());
    let bands = nm.as_ref().map_or(Bands::Channels(samples.channels().len()), |nm| Bands::Wavelengths(nm));
    let coordinates = Coordinates::new(template, &options.scope, bands.count())?;
    let reduced = options.places.and_then(|n| samples.subset(n));
    let fitted = reduced.as_ref().unwrap_or(samples);
    let values = fitted.len() * bands.count();
    if values <= coordinates.count {
        return Err(Error::TooFew { values, parameters: coordinates.count });
    }
    let residual = Residual::of(options.metric, options.epsilon);
    let objective = Objective { template, coordinates: &coordinates, samples: fitted, bands, residual };
    let middle = coordinates.start(0);
    if template.fill(&coordinates.values(&middle), bands).prepare(bands)?.is_delta() {
        return Err(Error::Dirac);
    }
    let first = fitted.subset(options.first_places.max(4 * coordinates.count));
    let on_first = Objective { samples: first.as_ref().unwrap_or(fitted), ..objective };
    let (best, starts) = best_starts(&on_first, options)?;
    // Which valley is the lowest a larger part of the table tells better; it also leads most of the way.
    let (low, high) = coordinates.bounds();
    let middle = fitted.subset(MIDDLE_PLACES).filter(|_| fitted.len() > 4 * MIDDLE_PLACES);
    let on_middle = Objective { samples: middle.as_ref().unwrap_or(fitted), ..objective };
    let nearer = best.iter().filter_map(|m| minimise(&on_middle, &m.x, &low, &high, &FIRST));
    let nearer =
        nearer.min_by(|a, b| a.at.cost.total_cmp(&b.at.cost)).ok_or(Error::NoStart { starts: options.starts })?;
    let mut found =
        minimise(&objective, &nearer.x, &low, &high, &LAST).ok_or(Error::NoStart { starts: options.starts })?;
    if options.metric == Metric::Largest {
        found = level(&objective, found, options.epsilon);
    }
    let material = template.fill(&coordinates.values(&found.x), bands);
    let brdf = material.prepare(bands)?;
    let spread = statistics::spread(&objective, &found, options.metric);
    Ok(Fit {
        template: template.clone(),
        estimates: spread.estimates,
        correlations: spread.correlations,
        condition: spread.condition,
        inseparable: spread.inseparable,
        measures: measure(samples, brdf.as_ref(), options.epsilon),
        criteria: spread.criteria,
        values,
        places: fitted.len(),
        starts,
        converged: found.converged,
        material,
        brdf,
    })
}

/// The lowest of the valleys that the starts lead to, lowest first, and how many starts came to that one.
fn best_starts(objective: &Objective<'_>, options: &Options) -> Result<(Vec<Minimum>, (usize, usize)), Error> {
    let (low, high) = objective.coordinates.bounds();
    let count = options.starts.max(1);
    let run = |i: usize| minimise(objective, &objective.coordinates.start(i as u64), &low, &high, &FIRST);
    let found: Vec<Option<Minimum>> = (0..count).into_par_iter().map(run).collect();
    let mut found: Vec<Minimum> = found.into_iter().flatten().collect();
    found.sort_by(|a, b| a.at.cost.total_cmp(&b.at.cost));
    let least = found.first().ok_or(Error::NoStart { starts: count })?.at.cost;
    // Of data without noise nothing is left, but not exactly.
    let nothing = 1e-12 * objective.samples.values.iter().map(|v| v * v).sum::<f64>();
    let same = |a: f64, b: f64| b <= 1.001 * a + nothing;
    let reached = found.iter().filter(|m| same(least, m.at.cost)).count();
    found.dedup_by(|b, a| same(a.at.cost, b.at.cost));
    found.truncate(VALLEYS);
    Ok((found, (count, reached)))
}

/// Goes on from the least squares to the least largest difference.
fn level(objective: &Objective<'_>, mut found: Minimum, epsilon: f64) -> Minimum {
    let (low, high) = objective.coordinates.bounds();
    for power in POWERS {
        let scale = objective.model(&found.x).map_or(0.0, |m| measure(objective.samples, m.as_ref(), epsilon).largest);
        if scale <= 0.0 {
            break;
        }
        let raised = Objective { residual: Residual::Power { half: 0.5 * power, scale }, ..*objective };
        let Some(next) = minimise(&raised, &found.x, &low, &high, &LAST) else { break };
        found = next;
    }
    found
}

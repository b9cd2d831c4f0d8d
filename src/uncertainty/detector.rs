//! Uncertainty of a photometer's figures: the budget is one of its measured responsivity.

use super::budget::Budget;
use super::model::Model;
use super::{Error, MOST_UNDEFINED, Outputs, Stated, analytic, monte_carlo};
use crate::finding::{Checked, Finding};
use crate::photometry::detector::Plan;
use crate::spectrum::Spectrum;

impl Outputs for Plan {
    type Scratch = ();

    fn count(&self) -> usize {
        1 + self.lamps()
    }

    fn evaluate(&self, values: &[f64], (): &mut (), out: &mut [f64]) {
        Plan::evaluate(self, values, out);
    }
}

/// What the figures of a photometer are worth.
#[derive(Debug, Clone, PartialEq)]
pub struct DetectorUncertainty {
    /// Of f₁′.
    pub f1_prime: Option<Stated>,
    /// Of the mismatch factors, by lamp; `None` where the detector or V(λ) does not see the lamp.
    pub mismatch_factors: Vec<Option<Stated>>,
    /// Names of the contributions, and what each alone causes to first order: of f₁′, then of every factor.
    pub contributions: Vec<(String, Vec<f64>)>,
    /// Trials made.
    pub trials: u64,
}

/// The uncertainty of f₁′ and of the mismatch factors of `plan` for a responsivity with the errors of a budget; as the trials say.
///
/// f₁′ is a sum of absolute values and has no derivative where a responsivity crosses V(λ): noise raises it, which the interval
/// shows by lying above the figure.
///
/// # Errors
/// [`Error`]: a budget that does not fit the responsivity.
pub fn evaluate(plan: &Plan, budget: &Budget, responsivity: &Spectrum) -> Result<Checked<DetectorUncertainty>, Error> {
    let mut findings = Vec::new();
    let model = Model::new(budget, responsivity, &mut findings)?;
    let propagated = analytic::propagate(&model, plan);
    let simulation = monte_carlo::simulate(&model, plan, &budget.monte_carlo);
    if !simulation.unsettled.is_empty() {
        let message = format!("after {} trials not settled: {} figures", simulation.trials, simulation.unsettled.len());
        findings.push(Finding::warning("U002", message).hint("raise most_trials in [monte_carlo]"));
    }
    let stated = |s: &monte_carlo::Sampled| {
        let told = s.undefined < MOST_UNDEFINED && s.standard.is_finite();
        told.then_some(Stated { standard: s.standard, expanded_95: s.expanded_95 })
    };
    let mut all: Vec<Option<Stated>> = simulation.figures.iter().map(stated).collect();
    let mismatch_factors = all.split_off(1);
    let names = model.inputs.iter().map(|i| i.name.clone());
    let value = DetectorUncertainty {
        f1_prime: all[0],
        mismatch_factors,
        contributions: names.zip(propagated.standard).collect(),
        trials: simulation.trials,
    };
    Ok(Checked { value, findings })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::SecondRadiation;
    use crate::illuminant::named;
    use crate::photometry::luminous::Efficiency;
    use crate::spectrum::Grid;

    #[test]
    fn a_scale_leaves_the_mismatch_alone_and_an_offset_does_not() {
        let v = Efficiency::Cie1924.weighting();
        let grid = Grid::uniform(380.0, 5.0, 81).expect("ascending");
        let values = grid.wavelengths_nm().iter().map(|w| v.at(w - 1.0)).collect();
        let responsivity = Spectrum::density(grid, values).expect("finite");
        let source = |name| named::source(name, SecondRadiation::default()).expect("a source").spectrum;
        let (a, led) = (source("A"), source("LED-B3"));
        let plan = Plan::new(responsivity.grid(), &a, &[&a, &led]).expect("sums");
        let of = |text: &str| {
            let budget = Budget::parse(text, |_| Err("none".into())).expect("a budget");
            evaluate(&plan, &budget, &responsivity).expect("evaluates").value
        };
        let scaled = of("scale = [{ relative = 0.05 }]\nmonte_carlo = { trials = 1000 }");
        let factors: Vec<f64> = scaled.mismatch_factors.iter().map(|s| s.expect("seen").standard).collect();
        assert!(factors.iter().all(|u| *u < 1e-12) && scaled.f1_prime.expect("seen").standard < 1e-12, "{scaled:?}");
        let shifted = of("wavelength = { offset_nm = 0.5 }\nmonte_carlo = { trials = 20000 }");
        // The calibration source's own factor is 1 whatever the responsivity; for a small error dF = F′ dλ, by the difference of
        // photometers shifted by half a nanometre more and less.
        assert!(shifted.mismatch_factors[0].expect("seen").standard < 1e-12);
        let factor = |by: f64| {
            let s: Vec<f64> = responsivity.wavelengths_nm().iter().map(|w| v.at(w - by)).collect();
            plan.figures(&s).mismatch_factors[1]
        };
        let want = (factor(1.5) - factor(0.5)).abs() / 2.0;
        let got = shifted.mismatch_factors[1].expect("seen").standard;
        assert!((got / want - 1.0).abs() < 0.05, "{got} {want}");
    }
}

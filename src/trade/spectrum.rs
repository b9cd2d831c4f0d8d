//! The trade of a spectrum: step, interpolation, rule and range of its integration, and single precision.
//!
//! | knob | values |
//! |---|---|
//! | `step` | the spectrum's own samples, or resampled to 1, 2, 5, 10 and 20 nm; adaptive: those that straight lines need to stay within 1, 0.1 and 0.01 % of the peak |
//! | `interpolation` | of the resampling: linear, Sprague, cubic, monotone cubic; values that come out alike are tried once |
//! | `rule` | CIE summation, trapezoid, exact integral of straight lines |
//! | `range` | all, 360–830, 380–780, 380–770 nm, where that cuts something off |
//! | `precision` | samples as `f64`, or rounded to `f32` (tried with the own samples) |
//!
//! **Reference**: the exact integral of the straight lines through the samples (for Σ over lines there is no other way to read
//! them). What lies between samples is not known; how far it could matter is estimated by the cubic spline through them, resampled
//! to a quarter of the step: the difference counts as the reference's own error. A spectrum that is defined by its samples, such as a
//! tabulated illuminant, has none.

use super::timing::interleaved;
use super::{Estimate, Figure, Sweep, Trial};
use crate::conversion::{Conversion, Converter, Error, Groups, Resampling, Settings};
use crate::spectrum::integrate::{Contract, Rule};
use crate::spectrum::resample::{Extrapolation, Interpolation, thinned};
use crate::spectrum::{Quantity, Sampling, Spectrum};

/// Steps that are tried, nm.
const STEPS_NM: [f64; 5] = [1.0, 2.0, 5.0, 10.0, 20.0];
/// Tolerances of adaptive steps that are tried.
const THINNINGS: [f64; 3] = [0.01, 1e-3, 1e-4];
/// Ranges that are tried, nm.
const RANGES_NM: [(f64, f64); 3] = [(360.0, 830.0), (380.0, 780.0), (380.0, 770.0)];
/// The resampling of the spline goes to this part of the step.
const REFINEMENT: f64 = 4.0;

/// How many figures are watched.
const COUNT: usize = 10;
/// The figures watched, in the order of the errors.
pub static FIGURES: [Figure; COUNT] = [
    Figure::relative("radiometric"),
    Figure::relative("photopic"),
    Figure::relative("scotopic"),
    Figure::absolute("chromaticity_uv_prime", ""),
    Figure::absolute("cct_k", "K"),
    Figure::absolute("duv", ""),
    Figure::absolute("cri_ra", ""),
    Figure::absolute("tm30_rf", ""),
    Figure::relative("melanopic"),
    Figure::relative("photons"),
];

/// How a spectrum was integrated in a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Resampling, if any.
    pub resampling: Option<Resampling>,
    /// Tolerance of an adaptive step, if any.
    pub thinning: Option<f64>,
    /// Rule and range.
    pub contract: Contract,
    /// Samples rounded to single precision.
    pub single: bool,
}

impl Choice {
    fn converter(&self, base: &Settings) -> Converter {
        let groups = Groups { hazard: false, rgb: false, shape: false, ..Groups::ALL };
        let Self { resampling, thinning, contract, .. } = *self;
        Converter::new(Settings { resampling, thinning, contract, groups, level: None, ..base.clone() })
    }

    fn words(&self) -> Vec<String> {
        let number = |v: f64| format!("{v} nm");
        let word = |r: Rule| r.word().to_owned();
        vec![
            match (self.resampling, self.thinning) {
                (Some(r), _) => number(r.step_nm),
                (_, Some(tolerance)) => format!("adaptive to {tolerance}"),
                _ => "own".to_owned(),
            },
            self.resampling.map_or_else(|| "none".to_owned(), |r| r.interpolation.word().to_owned()),
            self.contract.rule.map_or_else(|| "lines".to_owned(), word),
            self.contract.range_nm.map_or_else(|| "all".to_owned(), |(low, high)| format!("{low}-{high} nm")),
            if self.single { "f32" } else { "f64" }.to_owned(),
        ]
    }
}

/// A sweep, and what was chosen in each of its trials.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectrumSweep {
    /// The trials.
    pub sweep: Sweep,
    /// Their choices.
    pub choices: Vec<Choice>,
}

/// Tries a spectrum, each choice timed `repeats` times. `base` gives all settings that are no knobs. `defined` says that the
/// spectrum is what its samples say.
///
/// # Errors
/// [`Error`] where the spectrum cannot be converted under the base settings.
pub fn sweep(spectrum: &Spectrum, base: &Settings, defined: bool, repeats: usize) -> Result<SpectrumSweep, Error> {
    let is_lines = spectrum.sampling() == Sampling::Lines;
    let rule = if is_lines { Rule::Lines } else { Rule::Exact };
    let whole = Contract { rule: Some(rule), range_nm: None };
    let best = Choice { resampling: None, thinning: None, contract: whole, single: false };
    let reference = figures(&best.converter(base), spectrum)?;
    let reference_errors = if is_lines || defined {
        reference.map(|f| f.map(|_| 0.0)).to_vec()
    } else {
        let (first, last) = spectrum.grid().range_nm();
        let parts = (REFINEMENT * (last - first) / spectrum.grid().widest_step_nm()).ceil().max(1.0);
        let resampling =
            Resampling { range_nm: Some((first, last)), ..resampling((last - first) / parts, Interpolation::Cubic) };
        let smooth = figures(&Choice { resampling: Some(resampling), ..best }.converter(base), spectrum)?;
        errors(&reference, &smooth)
    };
    let choices = choices(spectrum);
    let mut tried = Vec::with_capacity(choices.len());
    for choice in choices {
        let converter = choice.converter(base);
        // A rule may refuse a grid, and a grid may be too small for an interpolation: such a choice is none.
        let own = if choice.single { Some(spectrum.map(|_, v| f64::from(v as f32))?) } else { None };
        if let Ok(found) = figures(&converter, own.as_ref().unwrap_or(spectrum)) {
            tried.push((choice, converter, own, errors(&reference, &found)));
        }
    }
    let timings = interleaved(tried.len(), repeats, |i| {
        let (_, converter, own, _) = &tried[i];
        converter.convert("", Quantity::Irradiance, own.as_ref().unwrap_or(spectrum))
    })?;
    let choices = tried.iter().map(|(choice, ..)| *choice).collect();
    let trials = tried.into_iter().zip(timings).map(|((choice, _, _, errors), timing)| Trial {
        settings: choice.words(),
        offered: !choice.single,
        timing,
        errors: errors.into_iter().map(|e| e.map(Estimate::exact)).collect(),
    });
    let words = match (is_lines, defined) {
        (true, _) => "the sum over the lines",
        (_, true) => "the exact integral of the straight lines through the samples, which define the spectrum",
        _ => "the exact integral of the straight lines through the samples, give or take the difference to a spline",
    };
    let sweep = Sweep {
        reference: words.to_owned(),
        knobs: vec!["step", "interpolation", "rule", "range", "precision"],
        figures: FIGURES.to_vec(),
        reference_errors,
        trials: trials.collect(),
    };
    Ok(SpectrumSweep { sweep, choices })
}

/// A resampling to multiples of a step inside the spectrum's own range.
fn resampling(step_nm: f64, interpolation: Interpolation) -> Resampling {
    Resampling { step_nm, range_nm: None, interpolation, extrapolation: Extrapolation::Refuse }
}

/// Everything that is tried, the spectrum's own samples first.
fn choices(spectrum: &Spectrum) -> Vec<Choice> {
    let (first, last) = spectrum.grid().range_nm();
    let cuts = |(low, high): &(f64, f64)| (*low > first && *low < last) || (*high < last && *high > first);
    let ranges: Vec<Option<(f64, f64)>> =
        std::iter::once(None).chain(RANGES_NM.into_iter().filter(cuts).map(Some)).collect();
    let mut out = Vec::new();
    if spectrum.sampling() == Sampling::Lines {
        let line = |range_nm| Contract { rule: Some(Rule::Lines), range_nm };
        let of = |r| Choice { resampling: None, thinning: None, contract: line(r), single: false };
        return ranges.into_iter().map(of).collect();
    }
    let own_step = spectrum.grid().step_nm();
    let mut grids: Vec<(Option<Resampling>, Option<f64>)> = vec![(None, None)];
    for step_nm in STEPS_NM.into_iter().filter(|s| Some(*s) != own_step && 2.0 * s < last - first) {
        let mut seen: Vec<Spectrum> = Vec::new();
        for interpolation in Interpolation::ALL {
            let wanted = resampling(step_nm, interpolation);
            let Ok(resampled) = wanted.apply(spectrum) else { continue };
            if !seen.contains(&resampled) {
                seen.push(resampled);
                grids.push((Some(wanted), None));
            }
        }
    }
    let mut samples = spectrum.values().len();
    for tolerance in THINNINGS.into_iter().rev() {
        let kept = thinned(spectrum, tolerance).map_or(samples, |s| s.values().len());
        if kept < samples {
            samples = kept;
            grids.push((None, Some(tolerance)));
        }
    }
    for (resampling, thinning) in grids {
        for rule in [Rule::Summation, Rule::Trapezoid, Rule::Exact] {
            for range_nm in ranges.iter().copied() {
                let contract = Contract { rule: Some(rule), range_nm };
                let choice = Choice { resampling, thinning, contract, single: false };
                out.push(choice);
                if resampling.is_none() && thinning.is_none() {
                    out.push(Choice { single: true, ..choice });
                }
            }
        }
    }
    out
}

/// The values of [`FIGURES`], chromaticity as u′ and v′.
type Values = [Option<[f64; 2]>; COUNT];

fn figures(converter: &Converter, spectrum: &Spectrum) -> Result<Values, Error> {
    // The unit is of no concern: relative errors do not know it. An irradiance has all figures.
    let c: Conversion = converter.convert("", Quantity::Irradiance, spectrum)?.value;
    let one = |v: f64| [v, 0.0];
    let absolute = c.absolute.first();
    let melanopic = c.alpha_opic.iter().find(|a| a.receptor == "melanopic");
    Ok([
        absolute.map(|a| one(a.radiometric)),
        absolute.map(|a| one(a.photopic)),
        absolute.map(|a| one(a.scotopic)),
        c.uv_prime,
        c.cct.map(|c| one(c.kelvin)),
        c.cct.map(|c| one(c.duv)),
        c.cri.map(|c| one(c.ra)),
        c.tm30.map(|t| one(t.rf)),
        melanopic.map(|m| one(m.radiometric)),
        c.photons.map(|p| one(p.total_count)),
    ])
}

/// The distances of [`FIGURES`] from the reference.
fn errors(reference: &Values, found: &Values) -> Vec<Option<f64>> {
    let distance = |([r, s], [a, b]): ([f64; 2], [f64; 2])| f64::hypot(a - r, b - s);
    let pairs = FIGURES.iter().zip(reference.iter().zip(found));
    pairs
        .map(|(figure, (r, f))| {
            let apart = distance(((*r)?, (*f)?));
            let error = match figure.measure {
                super::Measure::Relative => apart / r.map_or(0.0, |r| r[0].abs()),
                super::Measure::Absolute => apart,
            };
            error.is_finite().then_some(error)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::Grid;

    /// The photopic errors of a rule over all ranges, by step.
    fn by_step(s: &SpectrumSweep, rule: Rule, figure: usize) -> Vec<(f64, f64)> {
        let all = s.choices.iter().zip(&s.sweep.trials).filter(|(c, _)| {
            c.contract == Contract { rule: Some(rule), range_nm: None }
                && c.resampling.is_some_and(|r| r.interpolation == Interpolation::Linear)
        });
        all.filter_map(|(c, t)| Some((c.resampling?.step_nm, t.errors[figure]?.error))).collect()
    }

    /// The slope of a straight line through ln y over ln x.
    fn slope(points: &[(f64, f64)]) -> f64 {
        let n = points.len() as f64;
        let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
        let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
        let (xy, xx) =
            logs.iter().fold((0.0, 0.0), |(xy, xx), (x, y)| (xy + (x - mx) * (y - my), xx + (x - mx) * (x - mx)));
        xy / xx
    }

    #[test]
    fn trapezoids_of_a_parabola_lose_with_the_square_of_the_step() {
        // Trapezoids of 1 + a (λ − λ₀)² over b nm are off by h² a b/6, exactly (Euler-Maclaurin). The reference, straight lines
        // between samples 0.25 nm apart, is off by as much for h = 0.25 nm.
        let grid = Grid::uniform(400.0, 0.25, 1601).expect("a grid");
        let values = grid.wavelengths_nm().iter().map(|nm| 1.0 + ((nm - 600.0) / 100.0).powi(2)).collect();
        let spectrum = Spectrum::density(grid, values).expect("a spectrum");
        let s = sweep(&spectrum, &Settings::default(), false, 1).expect("a sweep");
        let points = by_step(&s, Rule::Trapezoid, 0);
        assert_eq!(points.iter().map(|p| p.0).collect::<Vec<_>>(), STEPS_NM);
        // The closed form against the exact parabola: relative to ∫ = 400 + 2·(200³/3)/100² nm.
        let integral = 400.0 + 2.0 * 200f64.powi(3) / 3.0 / 1e4;
        for (step, error) in &points {
            let expected = (step * step - 0.0625) * 400.0 / 6.0 / 1e4 / integral;
            assert!((error / expected - 1.0).abs() < 1e-3, "{step} nm: {error}, expected {expected}");
        }
        let fitted = slope(&points[1..]);
        assert!((fitted - 2.0).abs() < 0.01, "{fitted}");
        // The spline knows the parabola, straight lines at 0.25 nm lose h²(b − a)/6.
        let own = s.sweep.reference_errors[0].expect("radiometric");
        let expected = 0.0625 * (1.0 - 1.0 / 16.0) * 400.0 / 6.0 / 1e4 / integral;
        assert!((own / expected - 1.0).abs() < 0.01, "{own}, expected {expected}");
    }

    #[test]
    fn own_samples_under_the_exact_rule_are_the_reference() {
        let grid = Grid::uniform(380.0, 5.0, 81).expect("a grid");
        let values = grid.wavelengths_nm().iter().map(|nm| (nm / 700.0).powi(3)).collect();
        let spectrum = Spectrum::density(grid, values).expect("a spectrum");
        let s = sweep(&spectrum, &Settings::default(), true, 1).expect("a sweep");
        let best = s.choices.iter().position(|c| {
            *c == Choice {
                resampling: None,
                thinning: None,
                contract: Contract { rule: Some(Rule::Exact), range_nm: None },
                single: false,
            }
        });
        let trial = &s.sweep.trials[best.expect("the reference is a trial")];
        assert!(trial.errors.iter().all(|e| *e == Some(Estimate::exact(0.0))), "{trial:?}");
        // A range that cuts something off is tried, one that does not is not: 380–780 is the spectrum's own.
        let ranges: Vec<_> = s.choices.iter().filter_map(|c| c.contract.range_nm).collect();
        assert!(ranges.contains(&(380.0, 770.0)) && !ranges.contains(&(380.0, 780.0)), "{ranges:?}");
        // Rounding to single precision is felt below 2⁻²⁴ alone.
        let single = s.choices.iter().zip(&s.sweep.trials).filter(|(c, _)| c.single && c.contract.range_nm.is_none());
        for (choice, trial) in single.filter(|(c, _)| c.contract.rule == Some(Rule::Exact)) {
            let error = trial.errors[1].expect("photopic").error;
            assert!(error <= f64::from(f32::EPSILON) / 2.0 && !trial.offered, "{choice:?}: {error}");
        }
    }

    #[test]
    fn an_adaptive_step_errs_by_less_than_its_share_of_the_peak() {
        let grid = Grid::uniform(380.0, 1.0, 401).expect("a grid");
        let bump = |nm: f64, at: f64, width: f64| (-((nm - at) / width).powi(2)).exp();
        let values =
            grid.wavelengths_nm().iter().map(|nm| bump(*nm, 450.0, 12.0) + 0.6 * bump(*nm, 580.0, 60.0)).collect();
        let spectrum = Spectrum::density(grid, values).expect("a spectrum");
        let s = sweep(&spectrum, &Settings::default(), true, 1).expect("a sweep");
        // |Δ∫| ≤ tolerance · peak · 400 nm, over ∫ = √π (12 + 0.6 · 60) nm; the peak is at most 1 + 0.6 exp(−(130/60)²).
        let integral = std::f64::consts::PI.sqrt() * (12.0 + 36.0);
        let tried: Vec<(f64, f64)> = (s.choices.iter().zip(&s.sweep.trials))
            .filter(|(c, _)| c.contract == Contract { rule: Some(Rule::Exact), range_nm: None })
            .filter_map(|(c, t)| Some((c.thinning?, t.errors[0]?.error)))
            .collect();
        assert_eq!(tried.iter().map(|t| t.0).collect::<Vec<_>>(), [1e-4, 1e-3, 0.01]);
        for (tolerance, error) in tried {
            assert!(
                error <= tolerance * (1.0 + 0.6 * (-4.69_f64).exp()) * 400.0 / integral && error > 0.0,
                "{tolerance}: {error}"
            );
        }
    }

    #[test]
    fn lines_have_ranges_alone() {
        let grid = Grid::new(vec![404.7, 435.8, 546.1, 578.0, 775.0]).expect("a grid");
        let spectrum = Spectrum::lines(grid, vec![1.0, 2.0, 3.0, 1.0, 4.0]).expect("lines");
        let s = sweep(&spectrum, &Settings::default(), false, 1).expect("a sweep");
        assert!(s.choices.iter().all(|c| c.contract.rule == Some(Rule::Lines)));
        // 4 of 11 W lie beyond 770 nm.
        let cut = s.choices.iter().position(|c| c.contract.range_nm == Some((380.0, 770.0))).expect("a range");
        assert!((s.sweep.trials[cut].errors[0].expect("radiometric").error - 4.0 / 11.0).abs() < 1e-15);
    }
}

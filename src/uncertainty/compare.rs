//! Two measurements of one thing: whether they differ by more than their uncertainties allow.
//!
//! ```text
//! E_n = (a − b) / √(U_a² + U_b²)
//! ```
//!
//! ISO/IEC 17043:2010, B.4.1.1. U are the expanded uncertainties of 95 %, and where an interval is lopsided its side that faces the
//! other value. |E_n| > 1 is significant. Both measurements are taken as independent: a calibration that they share makes the
//! denominator too large.

use super::{FigureUncertainty, Measurand, Uncertainty};

/// One figure of both measurements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Which figure.
    pub measurand: Measurand,
    /// Of the first measurement, and how far its interval reaches towards the second.
    pub a: (f64, f64),
    /// Of the second, and how far its interval reaches towards the first.
    pub b: (f64, f64),
    /// E_n of a less b; infinite where the values differ and neither has an uncertainty.
    pub e_n: f64,
}

impl Difference {
    /// Whether the difference is more than both uncertainties allow.
    #[must_use]
    pub fn is_significant(&self) -> bool {
        self.e_n.abs() > 1.0
    }
}

/// Values that differ by less than this share of them are alike: rounding.
const ROUNDING: f64 = 1e-9;

/// The figures that both measurements have with an uncertainty, in the order of the first.
#[must_use]
pub fn differences(a: &Uncertainty, b: &Uncertainty) -> Vec<Difference> {
    let pair = |f: &FigureUncertainty| {
        let g = b.figure(f.measurand)?;
        let reach = |from: &FigureUncertainty, to: f64| {
            let [low, high] = from.stated?.expanded_95;
            // An interval that errors have shifted past the value reaches nowhere on that side.
            Some(if to >= from.value { (high - from.value).max(0.0) } else { (from.value - low).max(0.0) })
        };
        let (u_a, u_b) = (reach(f, g.value)?, reach(g, f.value)?);
        let difference = f.value - g.value;
        let alike = difference.abs() <= ROUNDING * f.value.abs().max(g.value.abs());
        let e_n = if alike { 0.0 } else { difference / u_a.hypot(u_b) };
        Some(Difference { measurand: f.measurand, a: (f.value, u_a), b: (g.value, u_b), e_n })
    };
    a.figures.iter().filter_map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conversion::{Converter, Groups, Settings};
    use crate::spectrum::{Grid, Quantity, Spectrum};
    use crate::uncertainty::budget::Budget;
    use crate::uncertainty::evaluate;

    fn measured(level: f64, relative: f64) -> Uncertainty {
        let grid = Grid::uniform(380.0, 5.0, 81).expect("ascending");
        let spectrum = Spectrum::density(grid, vec![level; 81]).expect("finite");
        let converter = Converter::new(Settings { groups: Groups::NONE, ..Settings::default() });
        let text = format!("scale = [{{ relative = {relative} }}]\nmonte_carlo = {{ trials = 1000 }}");
        let budget = Budget::parse(&text, |_| Err("none".into())).expect("a budget");
        evaluate(&converter, &budget, Quantity::Irradiance, &spectrum).expect("evaluates").value
    }

    #[test]
    fn e_n_is_the_difference_over_both_uncertainties() {
        let of = |b: &Uncertainty, m| {
            differences(&measured(1.0, 0.01), b).into_iter().find(|d| d.measurand == m).expect("in both")
        };
        // 1 against 1.05 with 1 % and 2 %: −0.05/(1.959964 √(0.01² + 0.021²)).
        let d = of(&measured(1.05, 0.02), Measurand::Photopic);
        let want = -0.05 / (1.959_963_984_540_054 * (0.01_f64.powi(2) + 0.021_f64.powi(2)).sqrt());
        assert!((d.e_n / want - 1.0).abs() < 1e-9 && d.is_significant(), "{d:?} {want}");
        assert!(!of(&measured(1.03, 0.02), Measurand::Photopic).is_significant());
        // Alike in colour, without any uncertainty of it.
        assert_eq!(of(&measured(1.05, 0.02), Measurand::Chromaticity(0)).e_n, 0.0);
    }
}

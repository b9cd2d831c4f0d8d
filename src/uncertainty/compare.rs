//! Two measurements of one thing: whether they differ by more than their uncertainties allow.
//!
//! ```text
//! E_n = (a − b) / √(U_a² + U_b² − 2 ρ U_a U_b)
//! ```
//!
//! ISO/IEC 17043:2010, B.4.1.1, and ISO 13528:2015, have ρ = 0: independent measurements. U are the expanded uncertainties of
//! 95 %, and where an interval is lopsided its side that faces the other value. ρ is the correlation of errors that both share (see
//! [`super::shared`]): the uncertainty of a difference without them, by JCGM 100, 5.2. |E_n| > 1 is significant.

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
    /// Correlation of both errors; 0 for independent measurements.
    pub correlation: f64,
    /// Expanded uncertainty of a less b.
    pub expanded: f64,
    /// E_n of a less b; infinite where the values differ and the difference has no uncertainty.
    pub e_n: f64,
}

impl Difference {
    /// Whether the difference is more than both uncertainties allow.
    #[must_use]
    pub fn is_significant(&self) -> bool {
        self.e_n.abs() > 1.0
    }

    /// a/b and its expanded uncertainty to first order, of figures proportional to the samples.
    #[must_use]
    pub fn ratio(&self) -> Option<(f64, f64)> {
        let ((a, u_a), (b, u_b)) = (self.a, self.b);
        let (p, q) = (u_a / a, u_b / b);
        let ratio = a / b;
        let known = self.measurand.is_linear() && ratio.is_finite() && p.is_finite() && q.is_finite();
        known.then(|| (ratio, ratio.abs() * spread(p, q, self.correlation)))
    }
}

/// √(p² + q² − 2ρpq), never below zero by rounding.
fn spread(p: f64, q: f64, correlation: f64) -> f64 {
    ((p - q).powi(2) + 2.0 * (1.0 - correlation) * p * q).max(0.0).sqrt()
}

/// Values that differ by less than this share of them are alike: rounding.
const ROUNDING: f64 = 1e-9;

/// The figures that both measurements have with an uncertainty, in the order of the first, and the correlations of those of them
/// whose errors are shared.
#[must_use]
pub fn differences(a: &Uncertainty, b: &Uncertainty, correlations: &[(Measurand, f64)]) -> Vec<Difference> {
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
        let correlation = correlations.iter().find(|(m, _)| *m == f.measurand).map_or(0.0, |(_, r)| *r);
        let expanded = spread(u_a, u_b, correlation);
        let e_n = if alike { 0.0 } else { difference / expanded };
        Some(Difference { measurand: f.measurand, a: (f.value, u_a), b: (g.value, u_b), correlation, expanded, e_n })
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
    use crate::uncertainty::shared::{SharedError, Side, correlations};

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
            differences(&measured(1.0, 0.01), b, &[]).into_iter().find(|d| d.measurand == m).expect("in both")
        };
        // 1 against 1.05 with 1 % and 2 %: −0.05/(1.959964 √(0.01² + 0.021²)).
        let d = of(&measured(1.05, 0.02), Measurand::Photopic);
        let want = -0.05 / (1.959_963_984_540_054 * (0.01_f64.powi(2) + 0.021_f64.powi(2)).sqrt());
        assert!((d.e_n / want - 1.0).abs() < 1e-9 && d.is_significant(), "{d:?} {want}");
        assert!(!of(&measured(1.03, 0.02), Measurand::Photopic).is_significant());
        // Alike in colour, without any uncertainty of it.
        assert_eq!(of(&measured(1.05, 0.02), Measurand::Chromaticity(0)).e_n, 0.0);
    }

    /// A measured irradiance, its budget and what comes of them.
    struct Measured {
        budget: Budget,
        spectrum: Spectrum,
        uncertainty: Uncertainty,
    }

    impl Measured {
        fn new(values: Vec<f64>, text: &str) -> Self {
            let text = format!("{text}\nmonte_carlo = {{ trials = 1000 }}");
            Self::of(values, &Budget::parse(&text, |_| Err("none".into())).expect("a budget"))
        }

        /// Flat, with a table that the budget names.
        fn with_table(text: &str, table: &str) -> Self {
            let text = format!("{text}\nmonte_carlo = {{ trials = 1000 }}");
            Self::of(vec![1.0; 81], &Budget::parse(&text, |_| Ok(table.to_owned())).expect("a budget"))
        }

        fn of(values: Vec<f64>, budget: &Budget) -> Self {
            let grid = Grid::uniform(380.0, 5.0, 81).expect("ascending");
            let spectrum = Spectrum::density(grid, values).expect("finite");
            let budget = budget.clone();
            let found = evaluate(&luminous(), &budget, Quantity::Irradiance, &spectrum).expect("evaluates");
            Self { budget, spectrum, uncertainty: found.value }
        }

        fn side(&self) -> Side<'_> {
            let Self { budget, spectrum, uncertainty } = self;
            Side { budget, quantity: Quantity::Irradiance, spectrum, uncertainty }
        }
    }

    fn luminous() -> Converter {
        Converter::new(Settings { groups: Groups::NONE, ..Settings::default() })
    }

    /// The illuminances, with the error named common to both.
    fn lux(a: &Measured, b: &Measured, shared: &[&str]) -> Difference {
        let names: Vec<String> = shared.iter().map(|n| (*n).to_owned()).collect();
        let found = correlations(&luminous(), a.side(), b.side(), &names).expect("shared");
        let all = differences(&a.uncertainty, &b.uncertainty, &found);
        *all.iter().find(|d| d.measurand == Measurand::Photopic).expect("an illuminance")
    }

    /// A common scale of 2 % leaves 2 % of a difference, and nothing of a ratio.
    #[test]
    fn a_shared_scale_cancels_in_a_ratio() {
        let text = "scale = [{ name = \"lamp\", relative = 0.02 }]";
        let (a, b) = (Measured::new(vec![1.0; 81], text), Measured::new(vec![1.1; 81], text));
        let together = lux(&a, &b, &["lamp"]);
        let (ratio, expanded) = together.ratio().expect("proportional");
        // Rounding of the correlation, 1e-16 below one, is all that is left.
        assert!((ratio - 1.0 / 1.1).abs() < 1e-14 && expanded < 1e-7, "{ratio} ± {expanded}");
        let left = 1.959_963_984_540_054 * 0.02 * (together.a.0 - together.b.0).abs();
        assert!((together.expanded / left - 1.0).abs() < 1e-7, "{} {left}", together.expanded);
        // Independent of each other: 2 % each way.
        let apart = lux(&a, &b, &[]).ratio().expect("proportional");
        let want = 1.959_963_984_540_054 * 0.02 * 2f64.sqrt() / 1.1;
        assert!((apart.1 / want - 1.0).abs() < 1e-9, "{} {want}", apart.1);
    }

    /// Illuminance is linear: that of A less that of B is the illuminance of the spectrum A − B, with the same relative errors. So
    /// is its uncertainty, for errors of one piece and for errors that go from sample to sample.
    #[test]
    fn the_difference_errs_like_the_spectrum_of_differences() {
        let bell = |i: i32, centre: f64| 2.0 + (-((380.0 + 5.0 * f64::from(i) - centre) / 60.0).powi(2)).exp();
        let a: Vec<f64> = (0..81).map(|i| bell(i, 550.0)).collect();
        let b: Vec<f64> = (0..81).map(|i| 0.4 * bell(i, 610.0)).collect();
        let rest: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a - b).collect();
        let chain = "calibration = [{ name = \"lamp\", relative = 0.02, correlation_length_nm = 40 }]";
        let whole = "calibration = [{ name = \"lamp\", relative = 0.02 }]";
        for text in [chain, whole] {
            let together = lux(&Measured::new(a.clone(), text), &Measured::new(b.clone(), text), &["lamp"]);
            let of_rest = Measured::new(rest.clone(), text).uncertainty;
            let stated = of_rest.figure(Measurand::Photopic).and_then(|f| f.stated).expect("stated");
            let want = 1.959_963_984_540_054 * stated.standard;
            assert!((together.expanded / want - 1.0).abs() < 1e-7, "{text}: {} {want}", together.expanded);
        }
    }

    /// Of a scale of 2 % that both share and one of 1 % of their own the difference keeps 2 % of itself and 1 % of each, however often the shared one
    /// is named.
    #[test]
    fn what_is_named_twice_is_shared_once() {
        let text = "scale = [{ name = \"lamp\", relative = 0.02 }, { name = \"own\", relative = 0.01 }]";
        let (a, b) = (Measured::new(vec![1.0; 81], text), Measured::new(vec![1.5; 81], text));
        for shared in [&["lamp"][..], &["lamp", "lamp"]] {
            let d = lux(&a, &b, shared);
            let (a, b) = (d.a.0, d.b.0);
            let standard = ((0.02 * (a - b)).powi(2) + 0.01_f64.powi(2) * (a * a + b * b)).sqrt();
            let want = 1.959_963_984_540_054 * standard;
            assert!((d.expanded / want - 1.0).abs() < 1e-9, "{shared:?}: {} {want}", d.expanded);
        }
    }

    #[test]
    fn what_is_not_shared_is_refused() {
        let with = |calibration: &str| format!("calibration = [{{ name = \"lamp\", {calibration} }}]");
        let chain = |length: f64| with(&format!("relative = 0.02, correlation_length_nm = {length}"));
        let measured = |text: &str| Measured::new(vec![1.0; 81], text);
        let a = measured("scale = [{ name = \"lamp\", relative = 0.02 }]");
        let b = measured(&chain(40.0));
        let found = |a: &Measured, b: &Measured, name: &str| {
            correlations(&luminous(), a.side(), b.side(), &[name.to_owned()]).map(|_| ())
        };
        let modes = Err(SharedError::Modes { name: "lamp".to_owned() });
        assert_eq!(found(&a, &b, "lamp"), modes);
        assert!(matches!(found(&a, &b, "slit"), Err(SharedError::Unknown { .. })));
        // Neighbours that err alike over 40 nm in one are not those of 80 nm; how much they err may differ.
        assert_eq!(found(&measured(&chain(80.0)), &b, "lamp"), modes);
        let less = with("relative = 0.01, correlation_length_nm = 40");
        assert_eq!(found(&measured(&less), &b, "lamp"), Ok(()));
        let noise = measured("noise = [{ name = \"lamp\", relative = 0.02 }]");
        assert!(matches!(found(&a, &noise, "lamp"), Err(SharedError::Noise { of: "B", .. })));
        // Which of two is meant is not known.
        let two = "scale = [{ name = \"lamp\", relative = 0.02 }, { name = \"lamp\", relative = 0.01 }]";
        let count = SharedError::Ambiguous { name: "lamp".to_owned(), of: "A", count: 2 };
        assert_eq!(found(&measured(two), &a, "lamp"), Err(count));
        // Covariances of as many modes, but of other ones.
        let covariance = |off: f64| {
            let table = format!("nm,400,700\n400,4e-4,{off}\n700,{off},4e-4\n");
            Measured::with_table(&with("covariance = \"c.csv\""), &table)
        };
        assert_eq!(found(&covariance(2e-4), &covariance(2e-4), "lamp"), Ok(()));
        assert_eq!(found(&covariance(2e-4), &covariance(-2e-4), "lamp"), modes);
    }
}

//! Which of several fitted models the data speak for.

use super::Fit;

/// Difference of a criterion below which two models cannot be told apart (Burnham & Anderson 2002, §2.6: those within 2 of the best
/// have substantial support).
pub const TOO_CLOSE: f64 = 2.0;

/// A model among others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranked {
    /// Its number among the fits.
    pub fit: usize,
    /// AICc less that of the best.
    pub delta_aicc: f64,
    /// BIC less that of the best by BIC.
    pub delta_bic: f64,
    /// Akaike weight e^(−Δ/2)/Σ e^(−Δ/2).
    pub weight: f64,
}

/// Several models on the same values.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The models, best first.
    pub ranked: Vec<Ranked>,
    /// Numbers of the fits that cannot be told from the best.
    pub as_good: Vec<usize>,
}

/// Compares fits to the same values under the same measure; `None` for fewer than two, or where one has no criteria.
#[must_use]
pub fn compare(fits: &[&Fit]) -> Option<Comparison> {
    let scores: Option<Vec<(f64, f64)>> =
        fits.iter().map(|f| f.criteria.and_then(|c| c.aicc.map(|a| (a, c.bic)))).collect();
    let scores = scores.filter(|s| s.len() >= 2)?;
    let least = |of: fn(&(f64, f64)) -> f64| scores.iter().map(of).fold(f64::INFINITY, f64::min);
    let (aicc, bic) = (least(|s| s.0), least(|s| s.1));
    let sum: f64 = scores.iter().map(|s| (-0.5 * (s.0 - aicc)).exp()).sum();
    let mut ranked: Vec<Ranked> = (scores.iter().enumerate())
        .map(|(fit, s)| Ranked {
            fit,
            delta_aicc: s.0 - aicc,
            delta_bic: s.1 - bic,
            weight: (-0.5 * (s.0 - aicc)).exp() / sum,
        })
        .collect();
    ranked.sort_by(|a, b| a.delta_aicc.total_cmp(&b.delta_aicc));
    let as_good = ranked.iter().skip(1).filter(|r| r.delta_aicc < TOO_CLOSE).map(|r| r.fit).collect();
    Some(Comparison { ranked, as_good })
}

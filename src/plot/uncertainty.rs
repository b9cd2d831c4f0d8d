//! What the budget of a spectrum's uncertainty is drawn from.

use super::{BudgetBar, BudgetPanel};
use crate::uncertainty::{Measurand, Uncertainty};
use crate::units::{significant, to_uncertainty};

/// The budget of the figures named by `figures` (measurand, name, unit), contributions ranked by the largest share that they have in
/// any of them; those beyond the sixth are joined.
#[must_use]
pub fn budget_panel(title: &str, u: &Uncertainty, figures: &[(Measurand, String, &str)]) -> BudgetPanel {
    const TOLD_APART: usize = 6;
    let shown: Vec<_> = (figures.iter())
        .filter_map(|(m, name, unit)| Some((m, name, *unit, u.figure(*m)?, u.figure(*m)?.stated?)))
        .collect();
    let share = |ranking: &[(&str, f64)], name: &str| ranking.iter().find(|(n, _)| *n == name).map_or(0.0, |(_, s)| *s);
    let rankings: Vec<Vec<(&str, f64)>> = shown.iter().map(|(m, ..)| u.ranking(**m)).collect();
    let largest = |name: &str| rankings.iter().map(|r| share(r, name)).fold(0.0, f64::max);
    let mut names: Vec<&str> = u.contributions.iter().map(|c| c.name.as_str()).collect();
    names.sort_by(|a, b| largest(b).total_cmp(&largest(a)));
    let bars = shown.iter().zip(&rankings).map(|((_, name, unit, figure, stated), ranking)| {
        let all: Vec<f64> = names.iter().map(|n| share(ranking, n)).collect();
        let (told, rest) = all.split_at(all.len().min(TOLD_APART));
        let others = (!rest.is_empty()).then(|| rest.iter().sum());
        let text =
            format!("{} ± {} {unit}", to_uncertainty(figure.value, stated.standard), significant(stated.standard, 2));
        BudgetBar { name: (*name).clone(), stated: text, shares: told.iter().copied().chain(others).collect() }
    });
    BudgetPanel {
        title: title.to_owned(),
        bars: bars.collect(),
        contributions: names.iter().map(|n| (*n).to_owned()).collect(),
    }
}

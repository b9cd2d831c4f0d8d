//! What a user should know of the lights.

use super::compare::wrong_list;
use super::run::Run;
use crate::capture::lights::angle_deg;
use crate::capture::lights::highlight::Highlight;
use crate::cli::capture::photos::Photos;
use crate::finding::{Finding, Location};
use crate::report::capture_lights::{self as report, What};

/// Disagreement in standard errors from which on it is told.
const DISAGREES: f64 = 4.0;
/// Correlation from which on two numbers are told to be inseparable.
const INSEPARABLE: f64 = 0.9;

/// What a user should know.
pub(super) fn notice(photos: &mut Photos, run: &Run, a: &report::Answer<'_>) {
    let mut found = Vec::new();
    if run.names.len() == 1 {
        let hint = "a BRDF wants eight lights from near the camera to behind the object";
        found.push(Finding::warning("K010", "one light only: nothing confirms it").hint(hint));
    }
    for s in &run.seen {
        if let What::Highlight(Highlight { others, .. }) = s.what
            && others > 0
        {
            let words =
                format!("{others} more highlight(s) of a fifth of the lamp's flux or more; the brightest was taken");
            found.push(
                Finding::warning("K021", words).hint("was another light on?").at(Location::default().of_item(&s.photo)),
            );
        }
    }
    for (k, name) in run.names.iter().enumerate() {
        let from = angle_deg(a.direction(k), run.view.back(a.adjusted.balls[0].centre));
        if from > 90.0 {
            let words = format!("light {name} is behind the ball, {from:.1} degrees from the camera's direction");
            found.push(Finding::warning("K022", words).hint("it lights less than half of what the camera sees"));
        }
    }
    for (s, off) in run.seen.iter().zip(&a.adjusted.off_sigma).filter(|(_, off)| **off > DISAGREES) {
        let words = format!("what it tells of light {} is {off:.1} standard errors off the whole", run.names[s.light]);
        let hint = "was the lamp or a ball moved between photographs, or are two of them swapped?";
        found.push(Finding::warning("K023", words).hint(hint).at(Location::default().of_item(&s.photo)));
    }
    for c in a.compared {
        found.extend(wrong_list(run, a, c));
    }
    if let Some(e) = a.entanglement {
        let names = ["offset and gamma", "offset and roughness", "gamma and roughness"];
        for (names, r) in names.iter().zip(e.correlations).filter(|(_, r)| r.abs() > INSEPARABLE) {
            let words =
                format!("{names} of the diffuse ball are not told apart by these photographs (correlation {r:.3})");
            found.push(
                Finding::warning("K025", words).hint("`capture response` from several exposure times settles gamma"),
            );
        }
    }
    photos.findings.extend(found);
}

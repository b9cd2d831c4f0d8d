//! What a user should know of the lights.

use super::compare::wrong_list;
use super::run::Run;
use crate::capture::lights::adjust::CameraFound;
use crate::capture::lights::angle_deg;
use crate::capture::lights::highlight::Highlight;
use crate::capture::lights::shading::INSEPARABLE;
use crate::cli::capture::photos::Photos;
use crate::finding::{Finding, Location};
use crate::report::capture_lights::{self as report, What};

/// Disagreement in standard errors from which on it is told.
const DISAGREES: f64 = 4.0;

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
    for s in &run.seen {
        let What::Highlight(Highlight { lamp, crossing, .. }) = s.what else { continue };
        let place = Location::default().of_item(&s.photo);
        if let Some(lamp) = lamp {
            let words = format!(
                "the brightest spot, at {:.0}, {:.0}, is the lamp itself before the ball; its image in the ball was taken",
                lamp.x, lamp.y
            );
            found.push(Finding::warning("K031", words).hint("better hide the lamp from the camera").at(place));
        } else if crossing > 0 {
            let words = format!(
                "{crossing} bright spot(s) go on beyond the edge of the ball: no image in it; the brightest that ends there was taken"
            );
            found.push(Finding::warning("K031", words).hint("does a lamp stand in the picture?").at(place));
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
    if let Some(c) = &a.adjusted.camera {
        found.extend(camera(c));
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

/// Names of the camera's numbers.
const NUMBERS: [&str; 7] = [
    "its focal length",
    "its turn about the axis to the right",
    "its turn about the axis downwards",
    "its turn about the line of sight",
    "its place to the right",
    "its place downwards",
    "its place forward",
];

/// What the balls tell of the camera.
fn camera(c: &CameraFound) -> Vec<Finding> {
    let mut found = Vec::new();
    let sigma = |k: usize| c.moved[k] / c.stated[k];
    let worst = (0..7).max_by(|i, j| sigma(*i).abs().total_cmp(&sigma(*j).abs())).unwrap_or(0);
    if sigma(worst).abs() > DISAGREES {
        let words = format!(
            "{} is {:.1} times what it may be off from where the balls say that it is",
            NUMBERS[worst],
            sigma(worst).abs()
        );
        let hint = "are camera and balls stated in one frame?";
        found.push(Finding::warning("K032", format!("the camera: {words}")).hint(hint));
    }
    if c.told < 7 {
        let pairs = (0..7).flat_map(|i| (i + 1..7).map(move |j| (i, j)));
        let alike = pairs.max_by(|p, q| c.correlations[p.0][p.1].abs().total_cmp(&c.correlations[q.0][q.1].abs()));
        let (i, j) = alike.unwrap_or((0, 6));
        let words = format!(
            "the balls tell {} of the camera's seven numbers, the others are as stated; least of all {} from {} (correlation {:.3})",
            c.told, NUMBERS[i], NUMBERS[j], c.correlations[i][j]
        );
        found.push(Finding::info("K032", words).hint("three balls in stated places, apart in depth, tell all of them"));
    }
    found
}

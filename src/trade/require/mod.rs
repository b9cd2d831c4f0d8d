//! What an input requires of a model: the lowest rung of a ladder that carries it within an error, and the measured error of the rung
//! below.
//!
//! The errors are those of the sweeps of [`crate::trade`] and of the renderer's own analysis ([`Analysis`](crate::render::build::Analysis)): what
//! recommends settings and what leaves things out of a scene also answers here. Rungs are in the order of the ladder of models, from spectra
//! and bidirectional scattering of everything down to three colours and a table of one angle.

mod capture;
mod scene;

pub use capture::capture;
pub use scene::scene;

use super::{Measure, Sweep, brdf, image, lamp, spectrum};
use crate::brdf::Brdf;
use crate::brdf::table::Channel;
use crate::conversion;
use crate::image::{Memory, Settings};
use crate::luminaire::transform::symmetrise;
use crate::luminaire::{Luminaire, Symmetry};
use crate::spectrum::Spectrum;

/// A model that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Rung {
    /// In words.
    pub model: String,
    /// Its error, upper end; `None` where it cannot be told.
    pub error: Option<f64>,
}

/// The answer to one question.
#[derive(Debug, Clone, PartialEq)]
pub struct Requirement {
    /// What the question is about: `wavelengths`, `extent` …
    pub question: &'static str,
    /// What the errors are of, in words.
    pub figure: String,
    /// The models from the simplest on, up to one that carries everything.
    pub rungs: Vec<Rung>,
    /// Number of the simplest that is within the error asked for; `None` where none is.
    pub needed: Option<usize>,
    /// Why, beyond the numbers; empty where they say all.
    pub because: String,
}

impl Requirement {
    fn new(question: &'static str, figure: impl Into<String>, rungs: Vec<Rung>, most: f64) -> Self {
        let needed = rungs.iter().position(|r| r.error.is_some_and(|e| e <= most));
        Self { question, figure: figure.into(), rungs, needed, because: String::new() }
    }

    /// The rung below the one that is needed (below the last, where none will do).
    #[must_use]
    pub fn simpler(&self) -> Option<&Rung> {
        self.needed.unwrap_or(self.rungs.len()).checked_sub(1).and_then(|i| self.rungs.get(i))
    }
}

/// A rung of the trials of a sweep: the smallest guaranteed error among them.
fn rung(sweep: &Sweep, figure: usize, model: impl Into<String>, trials: impl Iterator<Item = usize>) -> Option<Rung> {
    let bounds = trials.map(|i| sweep.bound(i, figure));
    let best = bounds.reduce(|a, b| match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    })?;
    Some(Rung { model: model.into(), error: best })
}

/// Which of so many is taken, of 2, 4 and 8.
fn nth(n: usize) -> String {
    format!("{n}{}", if n == 2 { "nd" } else { "th" })
}

/// The numbers of the choices that are as said.
fn those<'a, C>(choices: &'a [C], is: impl Fn(&C) -> bool + 'a) -> impl Iterator<Item = usize> + 'a {
    choices.iter().enumerate().filter(move |(_, c)| is(c)).map(|(i, _)| i)
}

/// What a spectrum requires for its photopic figure: how many samples, and which range.
///
/// # Errors
/// [`conversion::Error`] where it has no figures.
pub fn spectrum(spectrum: &Spectrum, defined: bool, most: f64) -> Result<Vec<Requirement>, conversion::Error> {
    let found = spectrum::sweep(spectrum, &conversion::Settings::default(), defined, 1)?;
    let (sweep, choices) = (&found.sweep, &found.choices);
    let Some(photopic) = spectrum::FIGURES.iter().position(|f| f.key == "photopic") else { return Ok(Vec::new()) };
    let mut steps: Vec<f64> = choices.iter().filter_map(|c| c.resampling.map(|r| r.step_nm)).collect();
    steps.sort_by(f64::total_cmp);
    steps.dedup();
    let whole = |c: &spectrum::Choice| c.contract.range_nm.is_none() && !c.single;
    let of_step = |step: f64| {
        let is = move |c: &spectrum::Choice| whole(c) && c.resampling.is_some_and(|r| r.step_nm == step);
        rung(sweep, photopic, format!("samples {step} nm apart"), those(choices, is))
    };
    // A finer grid than its own is no simplification.
    let own = spectrum.grid().widest_step_nm();
    let mut rungs: Vec<Rung> = steps.iter().rev().filter(|s| **s > own).filter_map(|s| of_step(*s)).collect();
    let as_it_is = move |c: &spectrum::Choice| whole(c) && c.resampling.is_none() && c.thinning.is_none();
    rungs.extend(rung(sweep, photopic, "its own samples", those(choices, as_it_is)));
    let figure = "photopic quantity, by the best rule and interpolation";
    let samples = Requirement::new("wavelengths", figure, rungs, most);
    let mut ranges: Vec<(f64, f64)> = choices.iter().filter_map(|c| c.contract.range_nm).collect();
    ranges.sort_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)));
    ranges.dedup();
    let mut rungs: Vec<Rung> = (ranges.iter())
        .filter_map(|range| {
            let own = |c: &spectrum::Choice| c.resampling.is_none() && c.thinning.is_none() && !c.single;
            let is = move |c: &spectrum::Choice| own(c) && c.contract.range_nm == Some(*range);
            rung(sweep, photopic, format!("{}-{} nm", range.0, range.1), those(choices, is))
        })
        .collect();
    rungs.extend(rung(sweep, photopic, "all of its range", those(choices, as_it_is)));
    Ok(vec![samples, Requirement::new("range", "photopic quantity, own samples", rungs, most)])
}

/// What a lamp requires that hangs `height_m` above a floor: a point or an area, which symmetry, how fine a table.
///
/// # Errors
/// [`lamp::LampError`].
pub fn lamp(luminaire: &Luminaire, height_m: f64, most: f64) -> Result<Vec<Requirement>, lamp::LampError> {
    let found = lamp::sweep(luminaire, height_m, 1)?;
    let (sweep, choices) = (&found.sweep, &found.choices);
    let Some(floor) = lamp::FIGURES.iter().position(|f| f.key == "illuminance") else { return Ok(Vec::new()) };
    let figure = format!("the floor's worst point {height_m} m below, of the mean");
    let plain = |c: &lamp::Choice| {
        c.interpolation == crate::luminaire::Interpolation::Bilinear && c.precision == lamp::Precision::Double
    };
    let own = |i: usize| sweep.trials[i].errors[floor].map(|e| e.high);
    let whole = those(choices, |c| plain(c) && c.every == [1; 2]);
    // Of the same table: what lies between its entries does not count.
    let extents = whole.map(|i| Rung {
        model: match choices[i].near_ratio {
            0.0 => "a point".to_owned(),
            n => format!("an area nearer than {n} times its size"),
        },
        error: own(i),
    });
    let mut extent = Requirement::new("extent", &figure, extents.collect(), most);
    if extent.rungs.len() == 1 {
        "the file states no luminous opening".clone_into(&mut extent.because);
    }
    let mut rungs = Vec::new();
    let held = luminaire.distribution.symmetry();
    for (symmetry, model) in [
        (Symmetry::Rotational, "one plane for all (rotational)"),
        (Symmetry::Quadrant, "planes of one quadrant"),
        (Symmetry::BilateralC0, "planes of one half (about C0-C180)"),
        (Symmetry::BilateralC90, "planes of one half (about C90-C270)"),
    ] {
        // Types A and B do not have all of them.
        let Ok(symmetric) = symmetrise(luminaire, symmetry) else { continue };
        let error =
            if symmetry == held { Some(0.0) } else { lamp::difference(luminaire, &symmetric.value, height_m)?[floor] };
        rungs.push(Rung { model: model.to_owned(), error });
    }
    rungs.push(Rung { model: "all planes".to_owned(), error: Some(0.0) });
    let symmetry = Requirement::new("symmetry", &figure, rungs, most);
    let nearest = choices.iter().map(|c| c.near_ratio).fold(0.0, f64::max);
    let mut parts: Vec<[usize; 2]> = choices.iter().filter(|c| plain(c)).map(|c| c.every).collect();
    parts.sort_by_key(|[h, v]| std::cmp::Reverse(h * v));
    parts.dedup();
    let angles = parts.iter().filter_map(|every| {
        let is = move |c: &lamp::Choice| plain(c) && c.near_ratio == nearest && c.every == *every;
        let [h, v] = every.map(|n| if n == 1 { "all".to_owned() } else { format!("every {}", nth(n)) });
        rung(sweep, floor, format!("{h} of the planes, {v} of the angles in them"), those(choices, is))
    });
    let mut angles = Requirement::new("angles", &figure, angles.collect(), most);
    "what lies between the entries is not known, and counts".clone_into(&mut angles.because);
    Ok(vec![extent, symmetry, angles])
}

/// What a material requires: whether its turn matters, and which form carries it. Errors are those of logarithms: 0.1 is about 10 %.
///
/// `own_bins` are those of a material that is a table of half angles, which no finer one is needed for.
///
/// # Errors
/// [`brdf::BrdfError`].
pub fn material(
    material: &dyn Brdf,
    channels: &[Channel],
    own_bins: Option<usize>,
    most: f64,
) -> Result<Vec<Requirement>, brdf::BrdfError> {
    let found = brdf::sweep(material, channels, own_bins, None, 1)?;
    let turned = if material.is_isotropic() { 0.0 } else { brdf::turned(material) };
    let rungs = vec![
        Rung { model: "isotropic (three angles)".to_owned(), error: Some(turned) },
        Rung { model: "anisotropic (four angles)".to_owned(), error: Some(0.0) },
    ];
    let azimuth = Requirement::new("azimuth", "logarithm of the values, turned by 90°", rungs, most);
    let (sweep, choices) = (&found.sweep, &found.choices);
    let one = |i: usize| {
        let [form, detail] = [0, 1].map(|k| sweep.trials[i].settings[k].clone());
        let model = match &choices[i] {
            brdf::Choice::Own => "as it is".to_owned(),
            brdf::Choice::Model(words) => format!("the model {words}"),
            brdf::Choice::Bins(_) | brdf::Choice::Components(_) => format!("{detail} {form}"),
        };
        Rung { model, error: sweep.bound(i, 0) }
    };
    // Models in the order of their parameters, then tables from the coarsest on.
    let models = those(choices, |c| matches!(c, brdf::Choice::Model(_)));
    let bins = those(choices, |c| matches!(c, brdf::Choice::Bins(_)));
    let mut tables: Vec<usize> = bins.filter(|i| sweep.trials[*i].offered).collect();
    tables.reverse();
    let own = those(choices, |c| *c == brdf::Choice::Own);
    let rungs = models.chain(tables).chain(own).map(one).collect();
    Ok(vec![azimuth, Requirement::new("form", "logarithm of the values", rungs, most)])
}

/// What a spectral image requires for its colours: RGB, or how many bands.
///
/// # Errors
/// [`image::ImageError`].
pub fn image(image: &Memory, settings: &Settings, most: f64) -> Result<Vec<Requirement>, image::ImageError> {
    let found = image::sweep(image, settings, 1)?;
    let (sweep, choices) = (&found.sweep, &found.choices);
    let watched: Vec<usize> = (image::FIGURES.iter().enumerate())
        .filter(|(_, f)| f.measure == Measure::Relative && f.key == "luminance" || f.key == "chromaticity_xy")
        .map(|(i, _)| i)
        .collect();
    let of = |spectral: image::Spectral| {
        let trial = choices.iter().position(|c| c.spectral == spectral && c.block == 1 && !c.half)?;
        watched.iter().map(|f| sweep.bound(trial, *f)).try_fold(0.0_f64, |worst, e| Some(worst.max(e?)))
    };
    let mut counts: Vec<usize> = choices
        .iter()
        .filter_map(|c| if let image::Spectral::Fewer(n, _) = c.spectral { Some(n) } else { None })
        .collect();
    counts.sort_unstable();
    counts.dedup();
    let sampled = |n: usize| image::Spectral::Fewer(n, crate::image::reduced::Bands::Sampled);
    let rungs = std::iter::once(("RGB".to_owned(), image::Spectral::Rgb))
        .chain(counts.into_iter().map(|n| (format!("{n} wavelengths"), sampled(n))))
        .chain([("all bands".to_owned(), image::Spectral::Own)])
        .map(|(model, spectral)| Rung { model, error: of(spectral) });
    let figure = "the larger of the errors of luminance (rms, of the mean) and of x, y (rms)";
    Ok(vec![Requirement::new("wavelengths", figure, rungs.collect(), most)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_rung_within_the_error_is_needed_and_the_one_below_is_told() {
        let rung = |model: &str, error: f64| Rung { model: model.to_owned(), error: Some(error) };
        let rungs = vec![rung("a", 0.2), rung("b", 0.05), rung("c", 0.01), rung("d", 0.0)];
        let of = |most: f64| Requirement::new("q", "f", rungs.clone(), most);
        assert_eq!((of(0.1).needed, of(0.1).simpler()), (Some(1), Some(&rungs[0])));
        assert_eq!((of(0.5).needed, of(0.5).simpler()), (Some(0), None));
        let none = Requirement::new("q", "f", rungs[..2].to_vec(), 0.01);
        assert_eq!((none.needed, none.simpler()), (None, Some(&rungs[1])));
    }
}

//! What a set of photographs requires: how many of them, which pixels, how many bands, a turn about the normal, a model or a table.
//!
//! All errors are the median of |f/f₀ − 1| over the bins and bands of the finest setting, f₀ its robust means, with their own median standard
//! error on top, as in [`crate::trade::capture`]. A model, a coarser table or a single band takes the place of every measurement, which are
//! then sorted into the same bins: so that what a bin's width does to a lobe is in both.

use super::{Requirement, Rung, nth};
use crate::brdf::Brdf;
use crate::brdf::coordinates::HalfDiff;
use crate::brdf::description::template::Template;
use crate::brdf::fit::{Options, fit};
use crate::brdf::table::Resolution;
use crate::capture::brdf::{Binned, Observations, bin};
use crate::trade::capture::{CaptureError, Choice, Outcome, apart, choices, compare};

/// Models that are tried, from the fewest parameters on; the first is fitted to every choice of photographs.
const MODELS: [&str; 3] = ["lambert", "oren-nayar", "lambert + ggx"];
/// Bins of coarser tables that are tried: these parts of the finest in every angle.
const COARSER: [usize; 2] = [4, 2];
/// The place of the median among the errors of [`apart`].
const MEDIAN: usize = 0;

/// The requirements of photographs of an object under `lights` lights with `exposures` exposures at most, in the bins of a resolution.
/// `measure` as in [`crate::trade::capture::sweep`]; `options` are those of the fits.
///
/// # Errors
/// [`CaptureError`] of all photographs.
pub fn capture(
    (lights, exposures): (usize, usize),
    options: &Options,
    resolution: Resolution,
    most: f64,
    mut measure: impl FnMut(&Choice) -> Result<(Observations, f64), String>,
) -> Result<Vec<Requirement>, CaptureError> {
    let simplest: Template = MODELS[0].parse().map_err(|e| CaptureError::Measure(format!("{}: {e}", MODELS[0])))?;
    // Fewer photographs with all of their pixels, fewer pixels of all photographs.
    let all = |c: &Choice| (c.lights, c.exposures) == (lights, exposures);
    let tried: Vec<Choice> = choices(lights, exposures).into_iter().filter(|c| c.every == 1 || all(c)).collect();
    let mut pixel_variance_sd = None;
    let found = compare(tried.clone(), |choice| {
        let measured = measure(choice);
        if let Ok((_, sd)) = &measured {
            pixel_variance_sd.get_or_insert(*sd);
        }
        Outcome::new(measured, (&simplest, options), resolution)
    })?;
    let own = found.reference_errors[MEDIAN];
    let finest = &found.outcomes[0];
    // None of a choice that gave nothing: its rung stands, and is not enough.
    let bound = |choice: &Choice| {
        let place = found.choices.iter().position(|c| c == choice)?;
        Some(found.errors[place][MEDIAN]?.high + own?)
    };
    let figure = "f_r in bins of half and difference angles, the median";
    let mut out = Vec::new();
    // The first is the finest, so that from the last on they become more.
    let mut photographs: Vec<&Choice> = tried.iter().filter(|c| c.every == 1).collect();
    photographs.sort_by_key(|c| c.lights * c.exposures);
    let photographs = photographs.into_iter().map(|choice| {
        let Choice { lights, exposures, .. } = choice;
        Rung { model: format!("{lights} lights, {exposures} exposures of each"), error: bound(choice) }
    });
    out.push(Requirement::new("photographs", figure, photographs.collect(), most));
    let pixels = tried.iter().filter(|c| all(c)).rev().map(|choice| {
        let model = match choice.every {
            1 => "every pixel".to_owned(),
            n => format!("every {0} pixel of every {0} row", nth(n)),
        };
        Rung { model, error: bound(choice) }
    });
    out.push(Requirement::new("pixels", figure, pixels.collect(), most));
    let bands = finest.all.channels.len();
    let instead = |values: Vec<f64>| {
        let other = bin(&Observations { values, ..finest.all.clone() }, resolution);
        Some(apart(&finest.binned, &other)[MEDIAN]? + own?)
    };
    let whole = format!("{bands} bands");
    let mut rungs = Vec::new();
    if bands > 1 {
        let grey = finest.all.values.chunks_exact(bands).flat_map(|v| {
            let mean = v.iter().sum::<f64>() / bands as f64;
            std::iter::repeat_n(mean, bands)
        });
        rungs.push(Rung { model: "one band for all".to_owned(), error: instead(grey.collect()) });
    }
    rungs.push(Rung { model: if bands > 1 { whole } else { "one band".to_owned() }, error: own });
    out.push(Requirement::new("bands", figure, rungs, most));
    let isotropic = Rung { model: "isotropic (three angles)".to_owned(), error: own };
    let mut azimuth = Requirement::new("azimuth", figure, vec![isotropic], most);
    "how the surface is turned about its normal is not known of an object of given shape"
        .clone_into(&mut azimuth.because);
    out.push(azimuth);
    let mut rungs = Vec::new();
    let samples = finest.all.samples(pixel_variance_sd.unwrap_or(0.0))?;
    for words in MODELS {
        let Ok(template) = words.parse::<Template>() else { continue };
        let Ok(fitted) = fit(&template, &samples, options) else { continue };
        rungs.push(Rung {
            model: format!("the model {words}"),
            error: instead(values_of(fitted.brdf.as_ref(), finest)),
        });
    }
    for part in COARSER {
        let coarse = Resolution {
            theta_h: resolution.theta_h.div_ceil(part),
            theta_d: resolution.theta_d.div_ceil(part),
            phi_d: resolution.phi_d.div_ceil(part),
        };
        let table = bin(&finest.all, coarse);
        rungs.push(Rung { model: words_of(coarse), error: instead(values_in(&table, &finest.all)) });
    }
    rungs.push(Rung { model: words_of(resolution), error: own });
    out.push(Requirement::new("form", figure, rungs, most));
    Ok(out)
}

fn words_of(r: Resolution) -> String {
    format!("{}x{}x{} bins", r.theta_h, r.theta_d, r.phi_d)
}

/// What a model says instead of the measurements.
fn values_of(model: &dyn Brdf, of: &Outcome) -> Vec<f64> {
    let bands = of.all.channels.len();
    let mut values = vec![0.0; of.all.values.len()];
    for ((incident, outgoing), values) in of.all.directions.iter().zip(values.chunks_exact_mut(bands)) {
        model.evaluate(*incident, *outgoing, values);
    }
    values
}

/// What a table says instead of the measurements that it was made of.
fn values_in(table: &Binned, of: &Observations) -> Vec<f64> {
    let value = |(incident, outgoing): &(glam::DVec3, glam::DVec3)| {
        let wanted = table.resolution.bin(&HalfDiff::new(*incident, *outgoing));
        let place = table.bins.binary_search_by_key(&wanted, |b| b.bin);
        place.map_or_else(|_| vec![f64::NAN; of.channels.len()], |i| table.bins[i].values.clone())
    };
    of.directions.iter().flat_map(value).collect()
}

//! The average of the symmetric images of a luminaire.

use super::super::distribution::{Distribution, Symmetry, System};
use super::super::model::Luminaire;
use super::planes::{all_planes, ascending, images, symmetric_planes, tabulated};
use super::{Change, Error, facts, percent};
use crate::finding::{Checked, Finding, Severity};
use crate::units::significant;

/// Images that differ by more than this share of the peak make the finding a warning: the luminaire was not symmetric.
const SYMMETRIC: f64 = 0.05;

/// The luminaire made symmetric: each intensity is the mean of its images in the mirrors, or of all planes. For the bilinear
/// intensity the flux stays exactly; the peak becomes that of the mean. [`Symmetry::None`] changes nothing.
///
/// # Errors
/// [`Error::NotTypeC`] for a Type A or B table and a symmetry other than [`Symmetry::Quadrant`].
pub fn symmetrise(luminaire: &Luminaire, symmetry: Symmetry) -> Result<Checked<Luminaire>, Error> {
    let before = &luminaire.distribution;
    if symmetry == Symmetry::None {
        return Ok(Checked::clean(luminaire.clone()));
    }
    let v = before.vertical_deg();
    let kind = (before.system(), symmetry);
    let after = match kind {
        (System::TypeC, Symmetry::Rotational) => {
            let means = before.zonal_means();
            Distribution::new(System::TypeC, symmetry, vec![0.0], v.to_vec(), means)?
        }
        (System::TypeC, _) => {
            let mean = |c: f64, g: f64| {
                let images = images(symmetry, c);
                images.iter().map(|i| before.at(*i, g)).sum::<f64>() / images.len() as f64
            };
            tabulated(kind, symmetric_planes(before, symmetry), v, mean)?
        }
        (_, Symmetry::Quadrant) => {
            let half: Vec<f64> = all_planes(before).iter().map(|h| h.abs()).chain([0.0]).collect();
            tabulated(kind, ascending(half), v, |h, v| 0.5 * (before.at(h, v) + before.at(-h, v)))?
        }
        _ => return Err(Error::NotTypeC),
    }
    .with_interpolation(before.interpolation());
    let difference = largest_difference(before, &after);
    let share = if before.peak().0 > 0.0 { difference / before.peak().0 } else { 0.0 };
    let change = Change::between(before, &after);
    let message = format!(
        "made symmetric ({}): the intensities moved by up to {} % of the peak; flux {}, peak {}",
        words(symmetry),
        significant(100.0 * share, 2),
        percent(change.flux),
        percent(change.peak)
    );
    let severity = if share > SYMMETRIC { Severity::Warning } else { Severity::Info };
    let mut findings = vec![Finding::new("L406", severity, message)];
    let mut value = Luminaire { distribution: after, ..luminaire.clone() };
    facts::drop_angular_spectra(&mut value, &mut findings);
    facts::generated(&mut value, true, false);
    Ok(Checked { value, findings })
}

/// Largest distance at the entries of a table from another of the same angles.
fn largest_difference(before: &Distribution, after: &Distribution) -> f64 {
    let v = before.vertical_deg();
    let at = |h: f64| v.iter().map(|v| (before.at(h, *v) - after.at(h, *v)).abs()).fold(0.0, f64::max);
    all_planes(before).into_iter().map(at).fold(0.0, f64::max)
}

fn words(symmetry: Symmetry) -> &'static str {
    match symmetry {
        Symmetry::Rotational => "about the axis",
        Symmetry::Quadrant => "in quadrants",
        Symmetry::BilateralC0 => "about C0–C180",
        Symmetry::BilateralC90 => "about C90–C270",
        Symmetry::None => "not at all",
    }
}

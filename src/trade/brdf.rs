//! The trade of a material: a table of how many bins, a model of how many parameters, or how many principal components carry it.
//!
//! | knob | values |
//! |---|---|
//! | `form` | the material itself; bins of half and difference angles (read at the nearest); a fitted model; components of a basis |
//! | `detail` | 90 × 90 × 180 bins (MERL's) and fewer; seven models; 1, 2, 3, 5, 10, 20, … components |
//!
//! **Figures**: `ln_rms`, the root of the mean square of ln((f̂ w + ε)/(f w + ε)) over 4096 pairs of directions and all bands, w the larger of
//! cosθ_i cosθ_o and ε = 0.001, the scale of [`crate::brdf::compress`]; the pairs lie evenly in √θ_h, θ_d, φ_d (and φ_h of anisotropic
//! materials), as MERL's bins do. `albedo`: the largest absolute error of the directional albedo at 0°, 45° and 75°.
//!
//! **Reference**: the material as it is given, a table between its places as it is read there. It defines itself: only the quadrature of
//! the albedo has an error. What a measurement is off from the surface is not known here.
//!
//! The time is that of the values of all pairs.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use rayon::prelude::*;

use super::timing::interleaved;
use super::{Estimate, Figure, Sweep, Trial};
use crate::brdf::Brdf;
use crate::brdf::compress::file::BasisFile;
use crate::brdf::coordinates::HalfDiff;
use crate::brdf::description::template::Template;
use crate::brdf::fit::{Options, Samples, Selection, fit};
use crate::brdf::reflectance::{Cone, directional};
use crate::brdf::table::{Channel, Resolution, Table, resample};
use crate::geometry::direction::from_degrees;

/// Bins that are tried, in θ_h, θ_d, φ_d.
const BINS: [[usize; 3]; 5] = [[90, 90, 180], [64, 64, 90], [45, 45, 36], [32, 32, 18], [16, 16, 8]];
/// Models that are tried.
const MODELS: [&str; 7] =
    ["lambert", "oren-nayar", "lambert + blinn-phong", "lambert + ward", "lambert + beckmann", "lambert + ggx", "abc"];
/// Numbers of components that are tried.
const COMPONENTS: [usize; 8] = [1, 2, 3, 5, 10, 20, 50, 100];
/// What a model is fitted to: these bins of the material, and of them so many places.
const FITTED: Resolution = Resolution { theta_h: 45, theta_d: 45, phi_d: 36 };
const PLACES: usize = 8000;
/// Pairs of directions.
const PAIRS: usize = 4096;
/// ε of the logarithms, and the least weight.
const EPSILON: f64 = 1e-3;
/// Both cosines of a pair are above this.
const LEAST_COSINE: f64 = 0.02;
/// Angles of incidence of the albedo, degrees.
const ALBEDO_DEG: [f64; 3] = [0.0, 45.0, 75.0];

/// The figures watched, in the order of the errors.
pub static FIGURES: [Figure; 2] = [Figure::absolute("ln_rms", ""), Figure::absolute("albedo", "")];

/// In which form a material was kept in a trial.
#[derive(Debug, Clone, PartialEq)]
pub enum Choice {
    /// As it is.
    Own,
    /// In bins.
    Bins(Resolution),
    /// As a model, in words.
    Model(&'static str),
    /// As so many components of a basis.
    Components(usize),
}

impl Choice {
    fn words(&self) -> Vec<String> {
        let (form, detail) = match self {
            Self::Own => ("own", "all".to_owned()),
            Self::Bins(r) => ("bins", format!("{}x{}x{}", r.theta_h, r.theta_d, r.phi_d)),
            Self::Model(words) => ("model", (*words).to_owned()),
            Self::Components(n) => ("components", n.to_string()),
        };
        vec![form.to_owned(), detail]
    }
}

/// Why a material could not be traded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BrdfError {
    /// Nothing but mirror lobes.
    #[error("the material has nothing but a Dirac lobe, which no table holds; expected one with a smooth part")]
    Dirac,
    /// A basis that does not fit.
    #[error("the basis does not take the material: {0}")]
    Basis(#[from] crate::brdf::compress::Error),
}

/// A sweep, and what was chosen in each of its trials.
#[derive(Debug)]
pub struct BrdfSweep {
    /// The trials; the figures are [`FIGURES`].
    pub sweep: Sweep,
    /// Their choices.
    pub choices: Vec<Choice>,
}

/// Tries a material on its bands, each choice timed `repeats` times; with a basis (of components that are not weighted for their number)
/// its components too. `own_bins` are those of a material that is such a table: more of them know nothing more, and are not offered.
///
/// # Errors
/// [`BrdfError`].
pub fn sweep(
    material: &dyn Brdf,
    channels: &[Channel],
    own_bins: Option<usize>,
    basis: Option<&BasisFile>,
    repeats: usize,
) -> Result<BrdfSweep, BrdfError> {
    if material.is_delta() {
        return Err(BrdfError::Dirac);
    }
    let in_bins = |resolution: Resolution| -> Table {
        let value = |i: DVec3, o: DVec3, v: &mut [f64]| {
            material.evaluate(i, o, v);
            true
        };
        resample(resolution, channels.to_vec(), value).into()
    };
    let mut forms: Vec<Form> = vec![(Choice::Own, None)];
    for [theta_h, theta_d, phi_d] in BINS {
        let resolution = Resolution { theta_h, theta_d, phi_d };
        forms.push((Choice::Bins(resolution), Some(Box::new(in_bins(resolution)))));
    }
    forms.extend(models(&in_bins(FITTED)));
    if let Some(basis) = basis {
        forms.extend(components(&in_bins(basis.grid.resolution()), channels, basis)?);
    }
    let pairs = pairs(material.is_isotropic());
    let reference = values(material, &pairs);
    let (albedo, quadrature) = albedo(material);
    let errors: Vec<[f64; 2]> = (forms.par_iter())
        .map(|(_, form)| {
            let Some(form) = form else { return [0.0; 2] };
            let found = self::albedo(form.as_ref()).0;
            let apart = albedo.iter().zip(&found).map(|(a, b)| (a - b).abs());
            [ln_rms(&pairs, &reference, &values(form.as_ref(), &pairs)), apart.fold(0.0, f64::max)]
        })
        .collect();
    let timings = interleaved(forms.len(), repeats, |i| {
        let form: &dyn Brdf = match &forms[i].1 {
            Some(form) => form.as_ref(),
            None => material,
        };
        Ok::<_, BrdfError>(values(form, &pairs))
    })?;
    let choices: Vec<Choice> = forms.into_iter().map(|(choice, _)| choice).collect();
    let trials = choices.iter().zip(timings).zip(errors).map(|((choice, timing), errors)| Trial {
        settings: choice.words(),
        offered: match choice {
            Choice::Bins(resolution) => own_bins.is_none_or(|own| resolution.bins() <= own),
            Choice::Model(_) => true,
            Choice::Own | Choice::Components(_) => false,
        },
        timing,
        errors: errors.map(|e| Some(e).filter(|e| e.is_finite()).map(Estimate::exact)).to_vec(),
    });
    let sweep = Sweep {
        reference: "the material as it is given".to_owned(),
        knobs: vec!["form", "detail"],
        figures: FIGURES.to_vec(),
        reference_errors: vec![Some(0.0), Some(quadrature)],
        trials: trials.collect(),
    };
    Ok(BrdfSweep { sweep, choices })
}

/// A choice, and what came of it; `None` for the material itself.
type Form = (Choice, Option<Box<dyn Brdf>>);

/// The models that can be fitted to a table.
fn models(table: &Table) -> Vec<Form> {
    let Ok(samples) = Samples::new(table, &Selection::default()) else { return Vec::new() };
    // As `brdf fit` does it where nothing else is said.
    let options = Options { places: Some(PLACES), ..Options::default() };
    let one = |words: &'static str| {
        let template: Template = words.parse().ok()?;
        let fit = fit(&template, &samples, &options).ok()?;
        Some((Choice::Model(words), Some(fit.brdf)))
    };
    MODELS.into_iter().filter_map(one).collect()
}

/// The first components of a basis.
fn components(table: &Table, channels: &[Channel], basis: &BasisFile) -> Result<Vec<Form>, BrdfError> {
    let Table::HalfAngle(table) = table else { return Ok(Vec::new()) };
    let most = basis.basis.components();
    let column = |channel: usize| basis.basis.project(&basis.grid.column(table, channel)?);
    let coefficients = (0..channels.len()).map(column).collect::<Result<Vec<_>, _>>()?;
    // Weighted components serve all together or not at all.
    let counts = COMPONENTS.into_iter().filter(|n| *n < most && !basis.weighted).chain([most]);
    counts
        .map(|n| {
            let columns = coefficients.iter().map(|c| basis.basis.reconstruct(&c[..n]));
            let columns = columns.collect::<Result<Vec<_>, _>>()?;
            let table: Table = basis.grid.table(channels.to_vec(), &columns)?.into();
            Ok((Choice::Components(n), Some(Box::new(table) as Box<dyn Brdf>)))
        })
        .collect()
}

/// Pairs of directions, evenly in √θ_h, θ_d, φ_d, and φ_h where the material is anisotropic.
fn pairs(isotropic: bool) -> Vec<(DVec3, DVec3)> {
    // Steps by the powers of the root of x⁵ = x + 1 fill four dimensions evenly (Roberts 2018).
    const ROOT: f64 = 1.167_303_978_261_418_7;
    let mut out = Vec::with_capacity(PAIRS);
    let mut n = 0;
    while out.len() < PAIRS {
        n += 1;
        let at = |k: i32| (0.5 + f64::from(n) * ROOT.powi(-k)).fract();
        let angles = HalfDiff {
            theta_h: at(1).powi(2) * FRAC_PI_2,
            phi_h: if isotropic { 0.0 } else { at(4) * TAU },
            theta_d: at(2) * FRAC_PI_2,
            phi_d: at(3) * PI,
        };
        let (incident, outgoing) = angles.directions();
        if incident.z > LEAST_COSINE && outgoing.z > LEAST_COSINE {
            out.push((incident, outgoing));
        }
    }
    out
}

/// The values of all pairs, the bands of a pair side by side.
fn values(brdf: &dyn Brdf, pairs: &[(DVec3, DVec3)]) -> Vec<f64> {
    let mut out = vec![0.0; brdf.bands() * pairs.len()];
    let places = out.chunks_exact_mut(brdf.bands()).zip(pairs);
    places.for_each(|(values, (incident, outgoing))| brdf.evaluate(*incident, *outgoing, values));
    out
}

fn ln_rms(pairs: &[(DVec3, DVec3)], reference: &[f64], found: &[f64]) -> f64 {
    let bands = reference.len() / pairs.len();
    let squares = reference.iter().zip(found).enumerate().map(|(i, (a, b))| {
        let (incident, outgoing) = pairs[i / bands];
        let w = (incident.z * outgoing.z).max(EPSILON);
        // Noise of measurements may be negative.
        let x = |f: f64| (f.max(0.0) * w + EPSILON).ln();
        (x(*b) - x(*a)).powi(2)
    });
    (squares.sum::<f64>() / reference.len() as f64).sqrt()
}

/// The error of [`FIGURES`]' first that a quarter turn of the sample makes.
pub(super) fn turned(material: &dyn Brdf) -> f64 {
    let pairs = pairs(false);
    let quarter = |d: DVec3| DVec3::new(-d.y, d.x, d.z);
    let turned: Vec<(DVec3, DVec3)> = pairs.iter().map(|(i, o)| (quarter(*i), quarter(*o))).collect();
    ln_rms(&pairs, &values(material, &pairs), &values(material, &turned))
}

/// Directional albedo at [`ALBEDO_DEG`], band by band, and the largest error of its quadrature.
fn albedo(brdf: &dyn Brdf) -> (Vec<f64>, f64) {
    let one = |theta: f64| {
        let mut out = vec![0.0; brdf.bands()];
        let error = directional(brdf, from_degrees(theta, 0.0), &Cone::HEMISPHERE, &mut out);
        (out, error)
    };
    let all = ALBEDO_DEG.map(one);
    let error = all.iter().map(|(_, e)| *e).fold(0.0, f64::max);
    (all.into_iter().flat_map(|(values, _)| values).collect(), error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brdf::description::{Bands, Material};

    fn of(words: &str) -> BrdfSweep {
        let material = words.parse::<Material>().expect("a material").prepare(Bands::Wavelengths(&[550.0]));
        sweep(material.expect("prepared").as_ref(), &[Channel::Wavelength(550.0)], None, None, 1).expect("a sweep")
    }

    fn error(s: &BrdfSweep, figure: usize, is: impl Fn(&Choice) -> bool) -> f64 {
        let trial = s.choices.iter().position(is).expect("it was tried");
        s.sweep.trials[trial].errors[figure].expect("a number").error
    }

    #[test]
    fn a_lambertian_surface_is_carried_by_its_albedo_and_by_any_bins() {
        let s = of("lambert(reflectance=0.5)");
        let lambert = |c: &Choice| *c == Choice::Model("lambert");
        for (choice, trial) in
            s.choices.iter().zip(&s.sweep.trials).filter(|(c, _)| matches!(c, Choice::Bins(_)) || lambert(c))
        {
            let [ln, albedo] = [0, 1].map(|f| trial.errors[f].expect("a number").error);
            // Bins keep 0.5/π to f32, and the model is fitted to them. Quadratures of tables stop at 1e-4.
            assert!(ln <= 1e-6 && albedo <= 1.1e-4, "{choice:?}: {ln} {albedo}");
        }
        assert!(s.choices.iter().any(lambert));
    }

    #[test]
    fn a_gloss_is_carried_by_its_own_model_and_by_bins_the_better_the_finer() {
        let s = of("lambert(reflectance=0.2) + ggx(alpha=0.15, f0=0.04)");
        let models = |words: &'static str| error(&s, 0, move |c| *c == Choice::Model(words));
        // The model itself comes back, to the single precision of the bins that it is fitted to.
        assert!(models("lambert + ggx") < 1e-5, "{}", models("lambert + ggx"));
        assert!(models("lambert") > 0.5 && models("lambert + beckmann") > 0.01);
        // The value in the middle of a bin is off by its width.
        let bins: Vec<(f64, f64)> = [[90, 90, 180], [45, 45, 36], [16, 16, 8]]
            .map(|[theta_h, theta_d, phi_d]| {
                let wanted = Choice::Bins(Resolution { theta_h, theta_d, phi_d });
                (1.0 / theta_h as f64, error(&s, 0, |c| *c == wanted))
            })
            .to_vec();
        let slope = (bins[2].1 / bins[0].1).ln() / (bins[2].0 / bins[0].0).ln();
        assert!((slope - 1.0).abs() < 0.25, "{slope}: {bins:?}");
    }

    #[test]
    fn no_more_bins_are_offered_than_a_table_has() {
        let material = "ggx(alpha=0.3, f0=0.5)".parse::<Material>().expect("a material");
        let material = material.prepare(Bands::Wavelengths(&[550.0])).expect("prepared");
        let [theta_h, theta_d, phi_d] = BINS[3];
        let own = Resolution { theta_h, theta_d, phi_d }.bins();
        let s = sweep(material.as_ref(), &[Channel::Wavelength(550.0)], Some(own), None, 1).expect("a sweep");
        for (choice, trial) in s.choices.iter().zip(&s.sweep.trials) {
            if let Choice::Bins(r) = choice {
                assert_eq!(trial.offered, [BINS[3], BINS[4]].contains(&[r.theta_h, r.theta_d, r.phi_d]), "{choice:?}");
            }
        }
    }

    #[test]
    fn mirrors_are_refused() {
        let mirror = "mirror(reflectance=0.9)".parse::<Material>().expect("a material");
        let mirror = mirror.prepare(Bands::Wavelengths(&[550.0])).expect("prepared");
        let refused = sweep(mirror.as_ref(), &[Channel::Wavelength(550.0)], None, None, 1);
        assert_eq!(refused.err(), Some(BrdfError::Dirac));
    }
}

//! What an instrument does to a spectrum, undone: dark signal, integration time, stray light, wavelength axis, bandwidth; smoothing
//! and resampling. Every step is recorded, and the uncertainty of the samples goes through each of them with its covariance.
//!
//! - [`Plan`]: the corrections wanted, in the order in which [`apply`] makes them; [`description`]: the same as TOML.
//! - [`Corrected`]: the spectrum, the standard uncertainty of its samples and their covariance, and the [`Step`]s made.
//!
//! ```
//! use photopic::correction::{Plan, apply, bandpass::Bandpass};
//! use photopic::spectrum::{Grid, Spectrum};
//!
//! // A triangular slit of 5 nm adds w²/12 · S″ to a parabola: 25/12 · 2.
//! let grid = Grid::uniform(500.0, 5.0, 9)?;
//! let truth = |w: f64| (w - 520.0).powi(2);
//! let seen: Vec<f64> = grid.wavelengths_nm().iter().map(|w| truth(*w) + 50.0 / 12.0).collect();
//! let plan = Plan { bandpass: Some(Bandpass::stearns(5.0)), ..Plan::default() };
//! let done = apply(&Spectrum::density(grid, seen)?, None, &plan)?.value;
//! assert!((done.spectrum.values()[4] - truth(520.0)).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::finding::{Checked, Finding};
use crate::spectrum::resample::{self, Extrapolation, Interpolation, ResampleError};
use crate::spectrum::{self, Grid, Sampling, Spectrum};

pub mod bandpass;
mod dark;
pub mod description;
pub mod lines;
mod order;
mod signal;
mod smooth;
pub mod stray_light;
pub mod wavelength;

pub use dark::{Dark, IntegrationTime, Noise};
pub use order::SecondOrder;
pub use smooth::Smoothing;

use bandpass::{Bandpass, Deconvolved};
use signal::{Operator, Signal};
use stray_light::StrayLight;
use wavelength::{Calibration, LineLamp};

/// Most samples whose covariance is kept: its square is the room that it takes.
const MOST_CORRELATED: usize = 5000;

/// Why a spectrum was not corrected.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Nothing lies between lines.
    #[error("a line spectrum; expected the samples of an instrument")]
    Lines,
    /// Nothing to do.
    #[error("no correction asked for; expected one, such as a dark spectrum, a bandwidth or a smoothing")]
    Nothing,
    /// Another spectrum is on other wavelengths.
    #[error("{what} on {found} samples of {low}–{high} nm; expected the wavelengths of the spectrum")]
    OtherGrid {
        /// Which.
        what: &'static str,
        /// Its samples.
        found: usize,
        /// Its shortest wavelength.
        low: f64,
        /// Its longest wavelength.
        high: f64,
    },
    /// Too many samples for a covariance.
    #[error(
        "{found} samples with an uncertainty; expected at most {MOST_CORRELATED}, between which a covariance is kept"
    )]
    TooMany {
        /// Samples.
        found: usize,
    },
    /// The window does not fit.
    #[error(
        "a smoothing over {window} samples by degree {degree} of {samples} samples; expected an odd window, longer than the degree and not longer than the spectrum"
    )]
    Window {
        /// Samples in the window.
        window: usize,
        /// Degree of the polynomial.
        degree: usize,
        /// Samples there are.
        samples: usize,
    },
    /// The stray-light matrix cannot be inverted.
    #[error("the stray-light matrix plus one has no inverse; expected fractions far below 1")]
    Singular,
    /// What the bandwidth is corrected with.
    #[error(transparent)]
    Bandpass(#[from] bandpass::Error),
    /// What the lamp of known lines gave.
    #[error(transparent)]
    Wavelength(#[from] wavelength::Error),
    /// Resampling.
    #[error(transparent)]
    Resample(#[from] ResampleError),
    /// What came out is no spectrum.
    #[error(transparent)]
    Spectrum(#[from] spectrum::Error),
}

/// Samples at another step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resampling {
    /// Step, nm.
    pub step_nm: f64,
    /// First and last wavelength, nm; by default the multiples of the step inside the spectrum.
    pub range_nm: Option<(f64, f64)>,
    /// How.
    pub interpolation: Interpolation,
}

/// The corrections of a spectrum. Those that are given are made in the order of the fields.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plan {
    /// Noise of the samples as read, in quadrature with an uncertainty that comes with them.
    pub noise: Option<Noise>,
    /// The dark signal, subtracted.
    pub dark: Option<Dark>,
    /// The integration time, divided by.
    pub integration_time: Option<IntegrationTime>,
    /// Stray light (Zong et al. 2006).
    pub stray_light: Option<StrayLight>,
    /// The wavelength axis, from a lamp of known lines.
    pub wavelength: Option<LineLamp>,
    /// The bandwidth.
    pub bandpass: Option<Bandpass>,
    /// Savitzky-Golay smoothing.
    pub smoothing: Option<Smoothing>,
    /// Another step.
    pub resampling: Option<Resampling>,
    /// Where second orders of a grating are kept out.
    pub second_order: SecondOrder,
}

/// A correction made.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Noise assumed of the samples.
    Noise(Noise),
    /// The dark signal subtracted: its mean.
    Dark {
        /// Mean of the dark spectrum.
        mean: f64,
    },
    /// Divided by the integration time.
    IntegrationTime(IntegrationTime),
    /// Stray light taken out.
    StrayLight {
        /// The most that was taken out of a sample, as a fraction of the largest sample.
        largest: f64,
        /// Relative standard uncertainty of the correction.
        relative: f64,
    },
    /// The axis replaced.
    Wavelength(Calibration),
    /// Bandwidth corrected by differences.
    Differences {
        /// Width of the triangular slit at half maximum, nm.
        fwhm_nm: f64,
        /// The coefficient of the second difference at the median step.
        coefficient: f64,
    },
    /// Bandwidth corrected by iteration.
    RichardsonLucy(Deconvolved),
    /// Smoothed.
    Smoothing(Smoothing),
    /// Resampled.
    Resampling {
        /// Step, nm.
        step_nm: f64,
        /// First and last wavelength, nm.
        range_nm: (f64, f64),
        /// How.
        interpolation: Interpolation,
    },
}

/// A corrected spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct Corrected {
    /// The spectrum.
    pub spectrum: Spectrum,
    /// Standard uncertainty of each sample; `None` where nothing is known of any error.
    pub standard: Option<Vec<f64>>,
    /// Samples × independent errors of one standard uncertainty: the covariance is the product with its transpose.
    pub modes: Option<DMatrix<f64>>,
    /// What was done, in order.
    pub steps: Vec<Step>,
}

impl Corrected {
    /// Covariance of the samples.
    #[must_use]
    pub fn covariance(&self) -> Option<DMatrix<f64>> {
        self.modes.as_ref().map(|m| m * m.transpose())
    }

    /// The standard uncertainty of the sum of all samples over what it would be if they erred independently; 1 without errors.
    #[must_use]
    pub fn correlation_factor(&self) -> f64 {
        let Some(modes) = &self.modes else { return 1.0 };
        let together: f64 = modes.row_sum().norm();
        let apart = modes.norm();
        if apart > 0.0 { together / apart } else { 1.0 }
    }
}

/// Corrects a spectrum; `standard` is the standard uncertainty of its samples, errors being independent, where it is known.
///
/// Errors go through to first order. Steps that are linear in the samples carry them exactly; of Richardson-Lucy iterations the
/// derivative is taken.
///
/// # Errors
/// [`Error`]: lines, no correction asked for, corrections that do not fit the spectrum.
pub fn apply(spectrum: &Spectrum, standard: Option<&[f64]>, plan: &Plan) -> Result<Checked<Corrected>, Error> {
    if spectrum.sampling() == Sampling::Lines {
        return Err(Error::Lines);
    }
    let mut findings = Vec::new();
    let mut steps = Vec::new();
    let mut signal = Signal::new(spectrum, standard);
    if let Some(noise) = &plan.noise {
        signal.independent(&noise.standard(signal.values()));
        steps.push(Step::Noise(*noise));
    }
    if let Some(dark) = &plan.dark {
        steps.push(dark.subtract(&mut signal, plan, &mut findings)?);
    }
    signal.correlate()?;
    if let Some(time) = &plan.integration_time {
        time.divide(&mut signal);
        steps.push(Step::IntegrationTime(*time));
    }
    if let Some(stray) = &plan.stray_light {
        steps.push(stray.correct(&mut signal)?);
    }
    if let Some(lamp) = &plan.wavelength {
        let found = wavelength::calibrate(lamp)?;
        findings.extend(found.findings);
        found.value.apply(&mut signal)?;
        steps.push(Step::Wavelength(found.value));
    }
    if let Some(bandpass) = &plan.bandpass {
        steps.push(bandpass.correct(&mut signal, &mut findings)?);
    }
    if let Some(smoothing) = &plan.smoothing {
        signal.transform(&smoothing.operator(signal.wavelengths_nm())?);
        steps.push(Step::Smoothing(*smoothing));
    }
    if let Some(resampling) = &plan.resampling {
        steps.push(resample(&mut signal, resampling)?);
    }
    if steps.iter().all(|s| matches!(s, Step::Noise(_))) {
        return Err(Error::Nothing);
    }
    findings.extend(plan.second_order.look(signal.wavelengths_nm(), signal.values()));
    let (spectrum, modes) = signal.into_parts()?;
    let standard = modes.as_ref().map(|m| m.row_iter().map(|r| r.norm()).collect());
    let corrected = Corrected { spectrum, standard, modes, steps };
    let factor = corrected.correlation_factor();
    if !(1.0 / CORRELATED..=CORRELATED).contains(&factor) {
        let message = format!(
            "the errors of the samples are correlated: that of their sum is {factor:.2} times what independent ones make"
        );
        let hint = "give convert the covariance (correct --covariance FILE) instead of the column of uncertainties";
        findings.push(Finding::warning("X006", message).hint(hint));
    }
    Ok(Checked { value: corrected, findings })
}

/// From this factor on, an uncertainty that leaves the correlation out is wrong in its first digit.
const CORRELATED: f64 = 1.1;

/// Brings the signal to another step.
fn resample(signal: &mut Signal, wanted: &Resampling) -> Result<Step, Error> {
    let x = signal.wavelengths_nm();
    let step = wanted.step_nm;
    // A multiple of the step that rounding puts a hair outside of the samples is meant to be inside.
    let slack = 1e-9 * step;
    let (low, high) = wanted
        .range_nm
        .unwrap_or((step * ((x[0] - slack) / step).ceil(), step * ((x[x.len() - 1] + slack) / step).floor()));
    let count = ((high - low) / step + 1e-9).floor().max(0.0) as usize + 1;
    let target = Arc::new(Grid::uniform(low, step, count)?);
    let source = Arc::new(Grid::new(x.to_vec())?);
    // Column by column: what a sample of 1 among zeros becomes.
    let mut rows = vec![vec![0.0; x.len()]; count];
    let mut unit = vec![0.0; x.len()];
    for k in 0..unit.len() {
        unit[k] = 1.0;
        let one = Spectrum::density(Arc::clone(&source), unit.clone())?;
        let column = resample::resample(&one, Arc::clone(&target), wanted.interpolation, Extrapolation::Refuse)?;
        rows.iter_mut().zip(column.values()).for_each(|(row, v)| row[k] = *v);
        unit[k] = 0.0;
    }
    signal.transform(&Operator::of_rows(rows));
    signal.move_to(target.wavelengths_nm().to_vec());
    let range_nm = target.range_nm();
    Ok(Step::Resampling { step_nm: step, range_nm, interpolation: wanted.interpolation })
}

#[cfg(test)]
mod tests;

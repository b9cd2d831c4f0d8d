//! Spectra that own their wavelength grid, and what can be done to one without an observer.
//!
//! - [`Grid`] and [`Spectrum`]: wavelengths in nm, strictly ascending, of any range and spacing, with one value each.
//! - [`quantity`]: what the values are of, and their unit.
//! - [`resample`](mod@resample): explicit interpolation and extrapolation; nothing else in the crate changes a grid.
//! - [`integrate`]: the contract under which a spectrum is integrated against a weighting function.
//! - [`format`](mod@format): one file per file format.

use std::sync::Arc;

pub mod format;
pub mod integrate;
pub mod quantity;
pub mod resample;

pub use quantity::{Per, Quantity, SpectralUnit, UnitError, WavelengthUnit};

/// Relative departure from equal spacing up to which a grid counts as uniform: files print wavelengths to a few digits.
const UNIFORM_TOLERANCE: f64 = 1e-6;

/// Why wavelengths and values do not make a spectrum.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No sample at all.
    #[error("a spectrum without samples; expected at least one wavelength and value")]
    Empty,
    /// As many values as wavelengths are needed.
    #[error("{values} values for {wavelengths} wavelengths; expected as many")]
    Length {
        /// Wavelengths given.
        wavelengths: usize,
        /// Values given.
        values: usize,
    },
    /// A wavelength is not a positive finite number.
    #[error("wavelength {found} nm at sample {index}; expected a positive finite number")]
    Wavelength {
        /// Sample, from 0.
        index: usize,
        /// The wavelength.
        found: f64,
    },
    /// Wavelengths do not ascend strictly.
    #[error("wavelength {found} nm at sample {index} after {previous} nm; expected strictly ascending wavelengths")]
    Order {
        /// Sample, from 0.
        index: usize,
        /// The wavelength.
        found: f64,
        /// The one before it.
        previous: f64,
    },
    /// A value is NaN or infinite.
    #[error("value {found} at {wavelength_nm} nm; expected a finite number")]
    Value {
        /// The wavelength of the sample.
        wavelength_nm: f64,
        /// The value.
        found: f64,
    },
}

/// Wavelengths in nm: at least one, positive, finite, strictly ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    wavelengths_nm: Vec<f64>,
    step_nm: Option<f64>,
}

impl Grid {
    /// A grid of the wavelengths given (nm).
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::Wavelength`], [`Error::Order`].
    pub fn new(wavelengths_nm: Vec<f64>) -> Result<Self, Error> {
        if wavelengths_nm.is_empty() {
            return Err(Error::Empty);
        }
        for (index, &found) in wavelengths_nm.iter().enumerate() {
            if !(found.is_finite() && found > 0.0) {
                return Err(Error::Wavelength { index, found });
            }
            if index > 0 && found <= wavelengths_nm[index - 1] {
                return Err(Error::Order { index, found, previous: wavelengths_nm[index - 1] });
            }
        }
        let step_nm = uniform_step(&wavelengths_nm);
        Ok(Self { wavelengths_nm, step_nm })
    }

    /// `count` wavelengths from `start_nm` by `step_nm`.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn uniform(start_nm: f64, step_nm: f64, count: usize) -> Result<Self, Error> {
        Self::new((0..count).map(|i| start_nm + step_nm * i as f64).collect())
    }

    /// The wavelengths, nm, ascending.
    #[must_use]
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// The step where all intervals are equal (to 1e-6 of it); `None` for one sample or irregular spacing.
    #[must_use]
    pub fn step_nm(&self) -> Option<f64> {
        self.step_nm
    }

    /// Number of samples, at least 1.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a grid is never empty")]
    pub fn len(&self) -> usize {
        self.wavelengths_nm.len()
    }

    /// Shortest and longest wavelength, nm.
    #[must_use]
    pub fn range_nm(&self) -> (f64, f64) {
        (self.wavelengths_nm[0], self.wavelengths_nm[self.len() - 1])
    }

    /// The widest interval between neighbours, nm; 0 for one sample.
    #[must_use]
    pub fn widest_step_nm(&self) -> f64 {
        self.wavelengths_nm.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max)
    }
}

fn uniform_step(wavelengths: &[f64]) -> Option<f64> {
    let (first, last) = (*wavelengths.first()?, *wavelengths.last()?);
    if wavelengths.len() < 2 {
        return None;
    }
    let step = (last - first) / (wavelengths.len() - 1) as f64;
    // Measured from the first sample, so that rounding in a file's printed wavelengths does not accumulate.
    let even =
        wavelengths.iter().enumerate().all(|(i, w)| (w - first - step * i as f64).abs() <= UNIFORM_TOLERANCE * step);
    even.then_some(step)
}

/// What lies between the samples of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sampling {
    /// Values are a density over wavelength (per nm) sampled from a continuous function.
    Density,
    /// Each value is the whole amount in a line of no width at its wavelength; nothing lies between.
    Lines,
}

/// A spectrum: a grid (shared, where many spectra have the same), one finite value per wavelength, and what lies between.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    grid: Arc<Grid>,
    values: Vec<f64>,
    sampling: Sampling,
}

impl Spectrum {
    /// A density over wavelength.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::Value`].
    pub fn density(grid: impl Into<Arc<Grid>>, values: Vec<f64>) -> Result<Self, Error> {
        Self::new(grid.into(), values, Sampling::Density)
    }

    /// Lines of no width, each carrying its value.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::Value`].
    pub fn lines(grid: impl Into<Arc<Grid>>, values: Vec<f64>) -> Result<Self, Error> {
        Self::new(grid.into(), values, Sampling::Lines)
    }

    /// A spectrum with the sampling given.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::Value`].
    pub fn new(grid: Arc<Grid>, values: Vec<f64>, sampling: Sampling) -> Result<Self, Error> {
        if grid.len() != values.len() {
            return Err(Error::Length { wavelengths: grid.len(), values: values.len() });
        }
        if let Some(i) = values.iter().position(|v| !v.is_finite()) {
            return Err(Error::Value { wavelength_nm: grid.wavelengths_nm[i], found: values[i] });
        }
        Ok(Self { grid, values, sampling })
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> &Arc<Grid> {
        &self.grid
    }

    /// The wavelengths, nm, ascending.
    #[must_use]
    pub fn wavelengths_nm(&self) -> &[f64] {
        self.grid.wavelengths_nm()
    }

    /// The values, one per wavelength.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Density or lines.
    #[must_use]
    pub fn sampling(&self) -> Sampling {
        self.sampling
    }

    /// The same spectrum with each value replaced by `f(wavelength_nm, value)`.
    ///
    /// # Errors
    /// [`Error::Value`] where `f` gives NaN or infinity.
    pub fn map(&self, mut f: impl FnMut(f64, f64) -> f64) -> Result<Self, Error> {
        let values = self.wavelengths_nm().iter().zip(&self.values).map(|(&w, &v)| f(w, v)).collect();
        Self::new(Arc::clone(&self.grid), values, self.sampling)
    }

    /// The wavelength and value of the largest sample; the shortest wavelength of several equal ones.
    #[must_use]
    pub fn peak(&self) -> (f64, f64) {
        let best = largest(&self.values);
        (self.wavelengths_nm()[best], self.values[best])
    }
}

/// Index of the largest value; the first of several equal ones.
pub(crate) fn largest(values: &[f64]) -> usize {
    let mut best = 0;
    for (i, v) in values.iter().enumerate() {
        if *v > values[best] {
            best = i;
        }
    }
    best
}

//! The model of the measurement: from errors of the inputs to an erring spectrum.
//!
//! ```text
//! S′ᵢ = F · Πₖ(1 + cₖᵢ) · [B(S)(λᵢ − a − b(λᵢ − λ₀)) · (1 + l(1 − Sᵢ/S_peak)) + f·S_mean] + Σₖ nₖᵢ
//! B(S) = S + ((w + e)² − w²)/12 · S″
//! F = (r/(r + d))² · (D/(D + q))² · Πₖ(1 + gₖ)
//! ```
//!
//! a, b: wavelength offset and scale; e: bandwidth w of a triangular slit (its second moment is w²/6); l: linearity; f: stray
//! light; c: calibrations; d: distance r; q: diameter D; g: scales; n: noise. Between samples S is a natural cubic spline, beyond
//! them its outermost sample. Correlated noise and calibrations are normally distributed; the others have the distribution that the
//! budget states.

use nalgebra::DMatrix;

use super::Error;
use super::budget::{Budget, Calibration, Distribution, Noise};
use crate::finding::Finding;
use crate::math::interpolate;
use crate::spectrum::{Sampling, Spectrum};

mod trial;

/// One contribution of the budget for one spectrum.
#[derive(Debug, Clone)]
pub(super) struct Input {
    /// Its name in the budget table.
    pub name: String,
    kind: Kind,
}

#[derive(Debug, Clone)]
enum Kind {
    /// Standard uncertainty of each sample; independent.
    Noise(Vec<f64>),
    /// Relative standard uncertainty of each sample, all erring alike.
    Together(Vec<f64>, Distribution),
    /// The same, neighbours correlated: uncertainties, and the correlation of each sample with the one before it.
    Chain { relative: Vec<f64>, correlation: Vec<f64> },
    /// Relative modes, samples × modes.
    Modes(DMatrix<f64>),
    /// Modes in the unit of the samples, samples × modes.
    AbsoluteModes(DMatrix<f64>),
    /// One number with its standard uncertainty.
    Number(Number, f64, Distribution),
}

/// What a single number errs in.
#[derive(Debug, Clone, Copy)]
enum Number {
    Offset,
    WavelengthScale {
        about_nm: f64,
    },
    Bandwidth {
        fwhm_nm: f64,
    },
    Linearity,
    StrayLight,
    /// (v/(v + error))².
    InverseSquare {
        value: f64,
    },
    Factor,
}

/// How a contribution enters the linear propagation.
pub(super) enum Direction {
    /// Change of the samples per standard uncertainty.
    One(Vec<f64>),
    /// Standard uncertainty of each sample, independent.
    Independent(Vec<f64>),
    /// Samples × independent modes.
    Many(DMatrix<f64>),
    /// Uncertainty of each sample, and correlation of each with the one before it.
    Chain { standard: Vec<f64>, correlation: Vec<f64> },
}

/// The model compiled for one spectrum.
#[derive(Debug, Clone)]
pub(super) struct Model {
    wavelengths_nm: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
    curvatures: Vec<f64>,
    peak: f64,
    mean: f64,
    pub inputs: Vec<Input>,
}

impl Model {
    /// Compiles a budget for a spectrum; what there is to say goes to `findings`.
    pub(super) fn new(budget: &Budget, spectrum: &Spectrum, findings: &mut Vec<Finding>) -> Result<Self, Error> {
        let (x, y) = (spectrum.wavelengths_nm(), spectrum.values());
        let lines = spectrum.sampling() == Sampling::Lines;
        if (lines || x.len() < 3) && (budget.wavelength.is_some() || budget.bandwidth.is_some()) {
            return Err(Error::NoSlope { samples: x.len(), lines });
        }
        let slopes = if x.len() > 2 && !lines { interpolate::spline_slopes(x, y) } else { vec![0.0; x.len()] };
        let model = Self {
            curvatures: curvatures(x, y),
            slopes,
            peak: spectrum.peak().1,
            mean: mean(x, y),
            wavelengths_nm: x.to_vec(),
            values: y.to_vec(),
            inputs: Vec::new(),
        };
        if model.peak <= 0.0 {
            return Err(Error::Dark);
        }
        if budget.noise.iter().any(|n| n.column && n.absolute_read.is_none()) {
            return Err(Error::NoColumn);
        }
        let inputs = model.inputs(budget, findings);
        if inputs.is_empty() {
            return Err(Error::Empty);
        }
        Ok(Self { inputs, ..model })
    }

    fn inputs(&self, budget: &Budget, findings: &mut Vec<Finding>) -> Vec<Input> {
        let mut out = Vec::new();
        let mut add = |name: String, kind| out.push(Input { name, kind });
        let named = |name: &Option<String>, otherwise: &str, index: usize, count: usize| match name {
            Some(name) => name.clone(),
            None if count > 1 => format!("{otherwise} {}", index + 1),
            None => otherwise.to_owned(),
        };
        for (i, noise) in budget.noise.iter().enumerate() {
            let name = named(&noise.name, "noise", i, budget.noise.len());
            self.told_beyond(noise.relative_read.as_ref().map(super::table::Table::range_nm), &name, findings);
            self.told_beyond(noise.absolute_read.as_ref().map(super::table::Table::range_nm), &name, findings);
            match &noise.covariance_read {
                None => add(name, Kind::Noise(self.noise(noise))),
                Some(covariance) => {
                    self.told_beyond(Some(covariance.range_nm()), &name, findings);
                    add(name, Kind::AbsoluteModes(covariance.modes_at(&self.wavelengths_nm)));
                }
            }
        }
        for (i, calibration) in budget.calibration.iter().enumerate() {
            let name = named(&calibration.name, "calibration", i, budget.calibration.len());
            let range = (calibration.table_read.as_ref().map(super::table::Table::range_nm))
                .or(calibration.covariance_read.as_ref().map(super::table::Covariance::range_nm));
            self.told_beyond(range, &name, findings);
            add(name, self.calibration(calibration));
        }
        let mut number = |name: &str, what, standard: f64, distribution| {
            if standard > 0.0 {
                add(name.to_owned(), Kind::Number(what, standard, distribution));
            }
        };
        if let Some(w) = &budget.wavelength {
            number("wavelength offset", Number::Offset, w.offset_nm.0, w.distribution);
            let what = Number::WavelengthScale { about_nm: w.about_nm.0 };
            number("wavelength scale", what, w.scale.0, w.distribution);
        }
        if let Some(b) = &budget.bandwidth {
            number("bandwidth", Number::Bandwidth { fwhm_nm: b.fwhm_nm.0 }, b.standard_nm.0, b.distribution);
        }
        if let Some(s) = &budget.stray_light {
            number("stray light", Number::StrayLight, s.fraction.0, s.distribution);
        }
        if let Some(l) = &budget.linearity {
            number("linearity", Number::Linearity, l.relative.0, l.distribution);
        }
        if let Some(d) = &budget.distance {
            number("distance", Number::InverseSquare { value: d.distance_m.0 }, d.standard_m.0, d.distribution);
        }
        if let Some(a) = &budget.aperture {
            number("aperture", Number::InverseSquare { value: a.diameter_m.0 }, a.standard_m.0, a.distribution);
        }
        for (i, s) in budget.scale.iter().enumerate() {
            number(&named(&s.name, "scale", i, budget.scale.len()), Number::Factor, s.relative.0, s.distribution);
        }
        out
    }

    /// Says so where a table of the budget ends inside the spectrum.
    fn told_beyond(&self, range: Option<(f64, f64)>, name: &str, findings: &mut Vec<Finding>) {
        let (first, last) = (self.wavelengths_nm[0], self.wavelengths_nm[self.wavelengths_nm.len() - 1]);
        if let Some((low, high)) = range.filter(|(low, high)| *low > first || *high < last) {
            findings.push(Finding::warning(
                "U004",
                format!(
                    "{name}: stated for {low}–{high} nm, taken as constant beyond for a spectrum of {first}–{last} nm"
                ),
            ));
        }
    }

    fn noise(&self, noise: &Noise) -> Vec<f64> {
        let sample = |(&w, &v): (&f64, &f64)| {
            let table = noise.relative_read.as_ref().map_or(0.0, |t| t.at(w));
            let parts = [
                noise.relative.0 * v,
                table * v,
                noise.of_peak.0 * self.peak,
                noise.absolute.0,
                noise.absolute_read.as_ref().map_or(0.0, |t| t.at(w)),
            ];
            parts.iter().map(|p| p * p).sum::<f64>().sqrt()
        };
        self.wavelengths_nm.iter().zip(&self.values).map(sample).collect()
    }

    fn calibration(&self, c: &Calibration) -> Kind {
        let x = &self.wavelengths_nm;
        if let Some(covariance) = &c.covariance_read {
            return Kind::Modes(covariance.modes_at(x));
        }
        let at = |w: f64| c.table_read.as_ref().map_or_else(|| c.relative.unwrap_or_default().0, |t| t.at(w));
        let relative: Vec<f64> = x.iter().map(|w| at(*w)).collect();
        match c.correlation_length_nm {
            None => Kind::Together(relative, c.distribution),
            Some(length) => {
                let steps = x.windows(2).map(|w| (-(w[1] - w[0]) / length.0).exp());
                Kind::Chain { relative, correlation: std::iter::once(0.0).chain(steps).collect() }
            }
        }
    }

    /// The samples as measured.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The largest sample.
    pub(super) fn peak(&self) -> f64 {
        self.peak
    }

    /// How the contribution `index` enters the linear propagation.
    pub(super) fn direction(&self, index: usize) -> Direction {
        let along = |f: &dyn Fn(usize) -> f64| Direction::One((0..self.values.len()).map(f).collect());
        let y = &self.values;
        match &self.inputs[index].kind {
            Kind::Noise(standard) => Direction::Independent(standard.clone()),
            Kind::Together(relative, _) => along(&|i| relative[i] * y[i]),
            Kind::Chain { relative, correlation } => Direction::Chain {
                standard: relative.iter().zip(y).map(|(r, v)| r * v).collect(),
                correlation: correlation.clone(),
            },
            Kind::Modes(modes) => {
                Direction::Many(DMatrix::from_fn(y.len(), modes.ncols(), |r, c| modes[(r, c)] * y[r]))
            }
            Kind::AbsoluteModes(modes) => Direction::Many(modes.clone()),
            Kind::Number(what, u, _) => match *what {
                Number::Offset => along(&|i| -self.slope(i) * u),
                Number::WavelengthScale { about_nm } => {
                    along(&|i| -self.slope(i) * (self.wavelengths_nm[i] - about_nm) * u)
                }
                Number::Bandwidth { fwhm_nm } => along(&|i| fwhm_nm / 6.0 * self.curvatures[i] * u),
                Number::Linearity => along(&|i| y[i] * (1.0 - y[i] / self.peak) * u),
                Number::StrayLight => along(&|_| self.mean * u),
                Number::InverseSquare { value } => along(&|i| -2.0 * u / value * y[i]),
                Number::Factor => along(&|i| y[i] * u),
            },
        }
    }

    /// Whether a contribution is noise, drawn anew for every sample of every measurement.
    pub(super) fn is_noise(&self, index: usize) -> bool {
        matches!(self.inputs[index].kind, Kind::Noise(_))
    }

    /// Whether a contribution can be one and the same error as one of another model: a single error always can; errors that differ from sample to
    /// sample only where their modes are the same, each the cause of the same in both.
    pub(super) fn has_modes_of(&self, index: usize, other: &Self, its: usize) -> bool {
        let same_samples = self.wavelengths_nm == other.wavelengths_nm;
        match (&self.inputs[index].kind, &other.inputs[its].kind) {
            (Kind::Together(..) | Kind::Number(..), Kind::Together(..) | Kind::Number(..)) => true,
            (Kind::Chain { correlation, .. }, Kind::Chain { correlation: its, .. }) => {
                same_samples && correlation == its
            }
            (Kind::Modes(modes), Kind::Modes(its)) | (Kind::AbsoluteModes(modes), Kind::AbsoluteModes(its)) => {
                same_samples && modes == its
            }
            _ => false,
        }
    }

    /// The slope at a sample. At the ends, beyond which the spectrum is held, it is that of the middle between both sides.
    fn slope(&self, i: usize) -> f64 {
        if i == 0 || i + 1 == self.values.len() { 0.5 * self.slopes[i] } else { self.slopes[i] }
    }

    /// Whether every error is normally distributed, so that figures linear in the spectrum are, too.
    pub(super) fn is_normal(&self) -> bool {
        self.inputs.iter().all(|i| match &i.kind {
            Kind::Together(_, d) | Kind::Number(_, _, d) => *d == Distribution::Normal,
            Kind::Noise(_) | Kind::Chain { .. } | Kind::Modes(_) | Kind::AbsoluteModes(_) => true,
        })
    }
}

/// Second derivative of the parabola through each sample and its neighbours; 0 at the ends.
fn curvatures(x: &[f64], y: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    for i in 1..x.len().saturating_sub(1) {
        let (a, b) = (x[i] - x[i - 1], x[i + 1] - x[i]);
        out[i] = 2.0 * ((y[i + 1] - y[i]) / b - (y[i] - y[i - 1]) / a) / (a + b);
    }
    out
}

/// Mean over wavelength, by trapezoids; of one sample itself.
fn mean(x: &[f64], y: &[f64]) -> f64 {
    let range = x[x.len() - 1] - x[0];
    if range == 0.0 {
        return y[0];
    }
    let area: f64 = x.windows(2).zip(y.windows(2)).map(|(x, y)| 0.5 * (x[1] - x[0]) * (y[0] + y[1])).sum();
    area / range
}

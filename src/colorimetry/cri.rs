//! The CIE colour rendering index: Rᵢ of the fourteen test colours and their general index Ra (CIE 13.3-1995).

use super::chromaticity::uv_1960;
use super::observer::Observer;
use super::reference::{ReferencePlan, ReferenceScratch};
use super::samples::SamplePlan;
use crate::constants::SecondRadiation;
use crate::illuminant;
use crate::spectrum::integrate::{Contract, RuleError, Weighting};
use crate::spectrum::{Grid, Sampling};
use crate::tables;

/// From this colour temperature on the reference is daylight, K (CIE 13.3, 5.2).
pub const DAYLIGHT_FROM_K: f64 = 5000.0;
/// CIE 13.3, 5.3: beyond this distance in (u, v) between test source and reference, the indices are less accurate.
pub const CHROMATICITY_TOLERANCE: f64 = 5.4e-3;
/// Number of test colours.
pub const SAMPLES: usize = 14;

/// Why an index could not be compiled or calculated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The contract's rule does not fit the grid.
    #[error(transparent)]
    Rule(#[from] RuleError),
    /// A reference illuminant could not be made.
    #[error(transparent)]
    Illuminant(#[from] illuminant::Error),
    /// An embedded table is missing.
    #[error(transparent)]
    Table(#[from] tables::Error),
    /// The spectrum has no luminous content to scale to.
    #[error("the spectrum has no positive luminous content; colour rendition is not defined")]
    Dark,
}

/// The indices of one source. Not rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cri {
    /// General colour rendering index Ra: the mean of R1 to R8.
    pub ra: f64,
    /// Special indices R1 to R14, in order.
    pub r: [f64; SAMPLES],
    /// Whether the reference was daylight (else a blackbody).
    pub daylight: bool,
    /// Distance of test source and reference in (u, v) 1960.
    pub distance_uv: f64,
}

/// Test colours and references compiled for one grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    test: SamplePlan,
    /// For line spectra the reference needs a grid of its own.
    own: Option<SamplePlan>,
    reference: ReferencePlan,
}

/// The reflectances of a table's sample columns.
pub(super) fn reflectances(table: &'static tables::Table) -> Vec<Weighting> {
    (table.columns().iter())
        .filter(|c| c.name != "wavelength_nm")
        .filter_map(|c| table.column(&c.name))
        .map(|values| Weighting::table(table.wavelengths_nm(), values))
        .collect()
}

impl Plan {
    /// Compiles the calculation for spectra on `grid`.
    ///
    /// # Errors
    /// [`Error::Rule`] where the contract's rule does not fit the grid; the others only for a broken build.
    pub fn new(grid: &Grid, sampling: Sampling, contract: &Contract, c2: SecondRadiation) -> Result<Self, Error> {
        let samples = reflectances(tables::get("cie-tcs")?);
        let plan = |grid: &Grid, sampling, contract: &Contract| {
            SamplePlan::new(Observer::Cie1931, &samples, grid, sampling, contract)
        };
        let test = plan(grid, sampling, contract)?;
        if sampling == Sampling::Density {
            return Ok(Self { test, own: None, reference: ReferencePlan::new(grid, c2)? });
        }
        let fine = Grid::uniform(360.0, 1.0, 471).map_err(illuminant::Error::from)?;
        let own = Some(plan(&fine, Sampling::Density, &Contract { rule: None, range_nm: contract.range_nm })?);
        Ok(Self { test, own, reference: ReferencePlan::new(&fine, c2)? })
    }

    /// The indices of a spectrum (values on the plan's grid, any scale) of correlated colour temperature `kelvin`.
    ///
    /// # Errors
    /// [`Error::Dark`] without luminous content; [`Error::Illuminant`] above 25 000 K, where daylight is not defined.
    pub fn evaluate(&self, values: &[f64], kelvin: f64) -> Result<Cri, Error> {
        self.evaluate_in(&mut ReferenceScratch::default(), values, kelvin)
    }

    /// As [`Plan::evaluate`], without allocation where `scratch` has been used before.
    ///
    /// # Errors
    /// Those of [`Plan::evaluate`].
    pub fn evaluate_in(&self, scratch: &mut ReferenceScratch, values: &[f64], kelvin: f64) -> Result<Cri, Error> {
        let daylight = kelvin >= DAYLIGHT_FROM_K;
        let reference = &mut scratch.spectrum;
        if daylight {
            self.reference.daylight(kelvin, reference)?;
        } else {
            self.reference.planck(kelvin, reference);
        }
        let reference_plan = self.own.as_ref().unwrap_or(&self.test);
        let (light_k, light_r) = (self.test.white(values), reference_plan.white(reference));
        let (uv_k, uv_r) = (uv_1960(light_k).ok_or(Error::Dark)?, uv_1960(light_r).ok_or(Error::Dark)?);
        if !(light_k[1] > 0.0 && light_r[1] > 0.0) {
            return Err(Error::Dark);
        }
        // CIE 13.3, eq. (6): the c and d of von Kries' transformation in (u, v).
        let cd = |[u, v]: [f64; 2]| [(4.0 - u - 10.0 * v) / v, (1.708 * v + 0.404 - 1.481 * u) / v];
        let ([c_k, d_k], [c_r, d_r]) = (cd(uv_k), cd(uv_r));
        // W*, U*, V* of eq. (7), about the reference's white.
        let wuv = |y: f64, [u, v]: [f64; 2]| {
            let w = 25.0 * y.cbrt() - 17.0;
            [w, 13.0 * w * (u - uv_r[0]), 13.0 * w * (v - uv_r[1])]
        };
        let mut r = [0.0; SAMPLES];
        let pairs = self.test.samples(values).zip(reference_plan.samples(reference));
        for (index, (test, reference)) in r.iter_mut().zip(pairs) {
            let [c, d] = cd(uv_1960(test).ok_or(Error::Dark)?);
            let (c, d) = (c_r / c_k * c, d_r / d_k * d);
            let scale = 16.518 + 1.481 * c - d;
            let adapted = [(10.872 + 0.404 * c - 4.0 * d) / scale, 5.520 / scale];
            let a = wuv(100.0 * test[1] / light_k[1], adapted);
            let b = wuv(100.0 * reference[1] / light_r[1], uv_1960(reference).ok_or(Error::Dark)?);
            let difference = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
            *index = 100.0 - 4.6 * difference;
        }
        let distance_uv = (uv_k[0] - uv_r[0]).hypot(uv_k[1] - uv_r[1]);
        Ok(Cri { ra: r[..8].iter().sum::<f64>() / 8.0, r, daylight, distance_uv })
    }
}

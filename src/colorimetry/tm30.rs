//! Colour fidelity and gamut of ANSI/IES TM-30-20 (fidelity as in CIE 224:2017): Rf, Rg and sixteen hue bins.

use super::cam02::Cam02;
use super::cri::{Error, reflectances};
use super::observer::Observer;
use super::reference::{ReferencePlan, ReferenceScratch};
use super::samples::SamplePlan;
use crate::constants::SecondRadiation;
use crate::illuminant;
use crate::spectrum::integrate::Contract;
use crate::spectrum::{Grid, Sampling};
use crate::tables;

/// Number of hue bins.
pub const BINS: usize = 16;
/// Number of colour evaluation samples.
pub const SAMPLES: usize = 99;
/// Scale of ΔE′ in the fidelity index (TM-30-18; 7.54 in TM-30-15).
const FIDELITY_SCALE: f64 = 6.73;
/// Range of the method, nm.
pub const RANGE_NM: (f64, f64) = (380.0, 780.0);
/// Below the first temperature the reference is a blackbody, above the second daylight, between them a mixture, K.
const BLEND_K: (f64, f64) = (4000.0, 5000.0);

/// One hue bin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bin {
    /// The reference's mean (a′, b′) divided by its own length: a point of the unit circle.
    pub reference: [f64; 2],
    /// The test source's mean (a′, b′) divided by the reference's length, as the colour vector graphic shows it.
    pub test: [f64; 2],
    /// Local chroma shift Rcs (0.1 is 10 % more chroma).
    pub chroma_shift: f64,
    /// Local hue shift Rhs, rad.
    pub hue_shift: f64,
    /// Local colour fidelity Rf,h.
    pub fidelity: f64,
    /// Number of samples whose reference hue falls into the bin.
    pub samples: usize,
}

/// The indices of one source. Not rounded.
#[derive(Debug, Clone, PartialEq)]
pub struct Tm30 {
    /// Fidelity index Rf, from 0 to 100 (the formula's own maximum is 100.0005).
    pub rf: f64,
    /// Gamut index Rg, 100 for the reference; `None` where a bin is empty.
    pub rg: Option<f64>,
    /// The bins in order of hue, from 0° in steps of 22.5°; `None` where no sample's reference hue falls into one.
    pub bins: [Option<Bin>; BINS],
    /// Fidelity of each of the 99 samples.
    pub sample_fidelity: [f64; SAMPLES],
    /// Colour temperature on which the reference was built, K.
    pub cct_k: f64,
}

/// Samples and references compiled for one grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    test: SamplePlan,
    own: Option<SamplePlan>,
    reference: ReferencePlan,
}

/// Why a plan gave no indices.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Undefined {
    /// CIECAM02 has no white so saturated.
    #[error("the light is too saturated for CIECAM02: a sharpened cone signal of its white is not positive")]
    Saturated,
    /// Any other reason.
    #[error(transparent)]
    Other(#[from] Error),
}

/// 10 ln(e^{x/10} + 1) of x = 100 − 6.73 ΔE′: the index on its scale that ends at 0.
fn fidelity(difference: f64) -> f64 {
    10.0 * ((100.0 - FIDELITY_SCALE * difference) / 10.0).exp().ln_1p()
}

impl Plan {
    /// Compiles the calculation for spectra on `grid`.
    ///
    /// # Errors
    /// [`Error::Rule`] where the contract's rule does not fit the grid; the others only for a broken build.
    pub fn new(grid: &Grid, sampling: Sampling, contract: &Contract, c2: SecondRadiation) -> Result<Self, Error> {
        let (low, high) = contract.range_nm.unwrap_or(RANGE_NM);
        let contract = Contract { rule: contract.rule, range_nm: Some((low.max(RANGE_NM.0), high.min(RANGE_NM.1))) };
        let samples = reflectances(tables::get("ies-ces99")?);
        let plan = |grid: &Grid, sampling, contract: &Contract| {
            SamplePlan::new(Observer::Cie1964, &samples, grid, sampling, contract)
        };
        let test = plan(grid, sampling, &contract)?;
        if sampling == Sampling::Density {
            return Ok(Self { test, own: None, reference: ReferencePlan::new(grid, c2)? });
        }
        let fine = Grid::uniform(380.0, 1.0, 401).map_err(illuminant::Error::from)?;
        let own = Some(plan(&fine, Sampling::Density, &Contract { rule: None, range_nm: contract.range_nm })?);
        Ok(Self { test, own, reference: ReferencePlan::new(&fine, c2)? })
    }

    /// The reference spectrum for a colour temperature: blackbody to 4000 K, daylight from 5000 K, and between them the two
    /// mixed in proportion, each scaled to the same luminous content (CIE 224:2017, 4.2).
    fn reference(&self, kelvin: f64, plan: &SamplePlan, scratch: &mut ReferenceScratch) -> Result<(), Error> {
        let (low, high) = BLEND_K;
        let ReferenceScratch { spectrum, other } = scratch;
        if kelvin <= low {
            self.reference.planck(kelvin, spectrum);
            return Ok(());
        }
        self.reference.daylight(kelvin, spectrum)?;
        if kelvin < high {
            self.reference.planck(kelvin, other);
            let share = (high - kelvin) / (high - low);
            let (p, d) = (share / plan.white(other)[1], (1.0 - share) / plan.white(spectrum)[1]);
            spectrum.iter_mut().zip(other).for_each(|(b, a)| *b = p * *a + d * *b);
        }
        Ok(())
    }

    /// The indices of a spectrum (values on the plan's grid, any scale) of correlated colour temperature `cct_k`,
    /// which the method takes from the spectrum between the ends of [`RANGE_NM`], too.
    ///
    /// # Errors
    /// [`Error::Dark`] without luminous content, [`Error::Illuminant`] above 25 000 K, where daylight is not defined,
    /// [`Undefined::Saturated`].
    pub fn evaluate(&self, values: &[f64], cct_k: f64) -> Result<Tm30, Undefined> {
        self.evaluate_in(&mut ReferenceScratch::default(), values, cct_k)
    }

    /// As [`Plan::evaluate`], without allocation where `scratch` has been used before.
    ///
    /// # Errors
    /// Those of [`Plan::evaluate`].
    pub fn evaluate_in(&self, scratch: &mut ReferenceScratch, values: &[f64], cct_k: f64) -> Result<Tm30, Undefined> {
        let reference_plan = self.own.as_ref().unwrap_or(&self.test);
        self.reference(cct_k, reference_plan, scratch)?;
        let reference = &scratch.spectrum;
        let (white_t, white_r) = (self.test.white(values), reference_plan.white(reference));
        if !(white_t[1] > 0.0 && white_r[1] > 0.0) {
            return Err(Error::Dark.into());
        }
        let model = |white| Cam02::new(white).ok_or(Undefined::Saturated);
        let (cam_t, cam_r) = (model(white_t)?, model(white_r)?);
        let mut sums = [[0.0_f64; 5]; BINS];
        let mut counts = [0_usize; BINS];
        let mut sample_fidelity = [0.0; SAMPLES];
        let mut total = 0.0;
        let pairs = self.test.samples(values).zip(reference_plan.samples(reference));
        for (index, (test, reference)) in sample_fidelity.iter_mut().zip(pairs) {
            let t = cam_t.ucs(test.map(|v| v * 100.0 / white_t[1]));
            let r = cam_r.ucs(reference.map(|v| v * 100.0 / white_r[1]));
            let difference = (0..3).map(|i| (t[i] - r[i]).powi(2)).sum::<f64>().sqrt();
            total += difference;
            *index = fidelity(difference);
            let turn = r[2].atan2(r[1]).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
            let bin = ((turn * BINS as f64) as usize).min(BINS - 1);
            counts[bin] += 1;
            for (sum, v) in sums[bin].iter_mut().zip([r[1], r[2], t[1], t[2], difference]) {
                *sum += v;
            }
        }
        let means: [Option<[f64; 5]>; BINS] =
            std::array::from_fn(|j| (counts[j] > 0).then(|| sums[j].map(|s| s / counts[j] as f64)));
        let area = |at: usize| -> Option<f64> {
            (0..BINS).try_fold(0.0, |sum, j| {
                let (p, q) = (means[j]?, means[(j + 1) % BINS]?);
                Some(sum + 0.5 * (p[at] * q[at + 1] - p[at + 1] * q[at]))
            })
        };
        let rg = area(2).zip(area(0)).map(|(t, r)| 100.0 * t / r);
        let bins = std::array::from_fn(|j| means[j].map(|m| bin(j, m, counts[j])));
        Ok(Tm30 { rf: fidelity(total / SAMPLES as f64), rg, bins, sample_fidelity, cct_k })
    }
}

/// A bin of its means [a′ᵣ, b′ᵣ, a′ₜ, b′ₜ, ΔE′] (TM-30-20, 4.5–4.8).
fn bin(index: usize, [ar, br, at, bt, difference]: [f64; 5], samples: usize) -> Bin {
    let length = ar.hypot(br);
    // Shifts are referred to the centre of the bin, not to its mean colour.
    let (sin, cos) = ((index as f64 + 0.5) * std::f64::consts::TAU / BINS as f64).sin_cos();
    let reference = [ar / length, br / length];
    let shift = [(at - ar) / length, (bt - br) / length];
    Bin {
        reference,
        test: [reference[0] + shift[0], reference[1] + shift[1]],
        chroma_shift: shift[0] * cos + shift[1] * sin,
        hue_shift: shift[1] * cos - shift[0] * sin,
        fidelity: fidelity(difference),
        samples,
    }
}

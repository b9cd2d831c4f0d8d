//! Reflectances under an illuminant: the sample's values become the light that it sends back.
//!
//! Both the sample and the perfect reflecting diffuser are integrated on the sample's own grid by the same rule (CIE 15:2018, 7.1), so
//! that a sample of ones has Y = 100 and the chromaticity of the white whatever its grid.

use super::{Error, Settings};
use crate::colorimetry::chromaticity;
use crate::colorimetry::observer;
use crate::colorimetry::whiteness::{Daylight, Formula, Whiteness};
use crate::spectrum::integrate::Weighting;
use crate::spectrum::{Grid, Quantity, Sampling, Spectrum};

/// Above this no reflectance factor is one: a spectrum in per cent was meant.
const LARGEST_FACTOR: f64 = 5.0;

/// An illuminant on the grid of a sample.
#[derive(Debug)]
pub(crate) struct Light {
    samples: Vec<f64>,
    /// Tristimulus value Y of the perfect diffuser, without K_m.
    white_y: f64,
    pub(crate) white_xy: [f64; 2],
    formula: Option<Formula>,
}

impl Light {
    pub(super) fn new(
        settings: &Settings,
        grid: &Grid,
        sampling: Sampling,
        observer: &observer::Plan,
    ) -> Result<Option<Self>, Error> {
        let Some((name, light)) = &settings.illuminant else { return Ok(None) };
        let few = light.values().len() < 2;
        if few || sampling == Sampling::Lines || light.sampling() == Sampling::Lines {
            return Err(Error::ReflectanceLines);
        }
        let table = Weighting::table(light.wavelengths_nm().to_vec(), light.values().to_vec());
        let samples: Vec<f64> = grid.wavelengths_nm().iter().map(|w| table.at(*w)).collect();
        let white = observer.xyz(&samples);
        let white_xy = chromaticity::xy(white).filter(|_| white[1] > 0.0);
        let white_xy = white_xy.ok_or_else(|| Error::DarkIlluminant { name: name.clone() })?;
        let formula = Daylight::named(name).and_then(|d| Formula::new(d, settings.observer));
        Ok(Some(Self { samples, white_y: white[1], white_xy, formula }))
    }

    /// Replaces reflectances by the light that they send back.
    pub(crate) fn shine(&self, values: &mut [f64]) {
        values.iter_mut().zip(&self.samples).for_each(|(v, s)| *v *= s);
    }

    /// The light that a sample sends back.
    pub(super) fn reflected(&self, quantity: Quantity, sample: &Spectrum) -> Result<Spectrum, Error> {
        if quantity != Quantity::Relative {
            return Err(Error::ReflectanceQuantity { quantity });
        }
        let (nanometres, largest) = sample.peak();
        if largest > LARGEST_FACTOR {
            return Err(Error::ReflectanceFactor { largest, nanometres });
        }
        let mut values = sample.values().to_vec();
        self.shine(&mut values);
        Ok(Spectrum::density(sample.grid().clone(), values)?)
    }

    /// The factor that takes integrals without K_m to Y = 100 of the perfect diffuser.
    pub(crate) fn scale(&self) -> f64 {
        100.0 / self.white_y
    }

    /// Whiteness, tint and yellowness of tristimulus values on that scale; `None` under other illuminants and observers than those of
    /// the formulas.
    pub(crate) fn whiteness(&self, xyz: [f64; 3]) -> Option<Whiteness> {
        self.formula.and_then(|f| f.evaluate(xyz, self.white_xy))
    }

    /// Whether there are formulas of whiteness for the illuminant and the observer.
    pub(crate) fn has_whiteness(&self) -> bool {
        self.formula.is_some()
    }
}

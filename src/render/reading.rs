//! What the instruments of a render read: figures with their standard errors, spectra, and the colour of the light.

use glam::DVec3;

use super::bands::Bands;
use super::build::{Instrument, Kind, Quantities};
use super::denoise::Price;
use super::estimate::{Estimate, Faults, Figure};
use super::goniophotometer::Measured;
use super::gonioreflectometer;
use super::light_map::LightMap;
use super::measure::{Board, Meter};
use super::noise::Noise;
use super::sensor::response::Response;
use crate::colorimetry::{cct, chromaticity};
use crate::constants::SecondRadiation;

/// What a meter's reading is called, and its luminous unit.
#[must_use]
pub fn quantity(response: &Response) -> (&'static str, &'static str) {
    match response {
        Response::Planar => ("illuminance", "lx"),
        Response::Hemispherical => ("hemispherical illuminance", "lx"),
        Response::Cylindrical => ("cylindrical illuminance", "lx"),
        Response::Spherical => ("spherical illuminance", "lx"),
        Response::Flux => ("luminous flux", "lm"),
        Response::Cone { .. } => ("luminance", "cd/m2"),
    }
}

/// The colour of a reading.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectral {
    /// Wavelengths of the bands, nm.
    pub wavelengths_nm: Vec<f64>,
    /// The reading per band, with its standard error, per nm (a line: its whole amount).
    pub bands: Vec<Figure>,
    /// Tristimulus values, in the unit of the reading.
    pub xyz: [f64; 3],
    /// Chromaticity x, y; `None` without light.
    pub chromaticity_xy: Option<[f64; 2]>,
    /// Correlated colour temperature, K, where there is one.
    pub cct_k: Option<f64>,
    /// Distance to the Planckian locus in the CIE 1960 diagram.
    pub duv: Option<f64>,
}

/// The points of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// Across and up the map.
    pub counts: [usize; 2],
    /// Where they are.
    pub map: LightMap,
    /// Row by row across the map.
    pub figures: Vec<Figure>,
}

/// What one instrument read.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Its name.
    pub name: String,
    /// What was read: `illuminance`, `luminance` ….
    pub quantity: &'static str,
    /// The luminous unit.
    pub unit: &'static str,
    /// The reading; of a grid and of a picture the mean.
    pub figure: Figure,
    /// The same unweighted, over the wavelengths carried.
    pub radiant: Option<Figure>,
    /// Samples taken.
    pub samples: u64,
    /// Samples that were left out.
    pub faults: Faults,
    /// The relative standard error that was asked for, and whether it was reached.
    pub target: Option<(f64, bool)>,
    /// Of a reading without random numbers: what it is taken to be off by, in its own unit, from the same with patches twice as long.
    pub discretisation: Option<f64>,
    /// The spectrum, where it was asked for.
    pub spectral: Option<Spectral>,
    /// The points of a grid.
    pub points: Option<Points>,
    /// What a goniophotometer measured.
    pub intensities: Option<Measured>,
    /// What a gonioreflectometer measured.
    pub brdf: Option<gonioreflectometer::Measured>,
    /// How far the pixels of a filtered picture are off.
    pub denoised: Option<Price>,
}

impl Points {
    /// The middle of the cell `index`, m.
    #[must_use]
    pub fn position(&self, index: usize) -> DVec3 {
        self.map.middle(self.counts, index).position
    }
}

/// The spectrum and the colour of a reading.
fn spectral(estimate: &Estimate, bands: &Bands, quantities: &Quantities) -> Spectral {
    let of = |component: usize| {
        let weights: Vec<f64> = quantities.tristimulus.iter().map(|t| t[component]).collect();
        estimate.figure(&weights).value
    };
    let xyz = [of(0), of(1), of(2)];
    let found = chromaticity::uv_1960(xyz).and_then(|uv| cct::nearest(uv, SecondRadiation::default()).ok());
    Spectral {
        wavelengths_nm: bands.wavelengths_nm().to_vec(),
        bands: estimate.bands(),
        xyz,
        chromaticity_xy: chromaticity::xy(xyz),
        cct_k: found.as_ref().map(|c| c.kelvin),
        duv: found.as_ref().map(|c| c.duv),
    }
}

/// The mean of independent figures.
fn mean(figures: &[Figure]) -> Figure {
    #[expect(clippy::cast_precision_loss, reason = "a number of points")]
    let n = figures.len() as f64;
    let value = figures.iter().map(|f| f.value).sum::<f64>() / n;
    let variance = figures.iter().map(|f| f.standard_error * f.standard_error).sum::<f64>();
    Figure { value, standard_error: variance.sqrt() / n }
}

/// The reading of a meter or of a grid, whose meters stand on the board from `first` on; `None` for what is no meter.
#[must_use]
pub fn of_board(
    instrument: &Instrument,
    board: &Board<'_>,
    first: usize,
    bands: &Bands,
    quantities: &Quantities,
    target: Option<(f64, bool)>,
) -> Option<Reading> {
    let estimates: Vec<Estimate> = (first..first + meters(instrument)?.len()).map(|m| board.estimate(m)).collect();
    of_meters(instrument, &estimates, bands, quantities, target)
}

/// The meters of an instrument; `None` for what is no meter.
fn meters(instrument: &Instrument) -> Option<&[Meter]> {
    match &instrument.kind {
        Kind::Meter(meter) => Some(std::slice::from_ref(meter)),
        Kind::Grid { meters, .. } => Some(meters),
        Kind::Camera(_) | Kind::Goniophotometer(_) | Kind::Gonioreflectometer(_) => None,
    }
}

/// The reading of a meter or of a grid by the estimates of its meters; `None` for what is no meter.
#[must_use]
pub fn of_meters(
    instrument: &Instrument,
    estimates: &[Estimate],
    bands: &Bands,
    quantities: &Quantities,
    target: Option<(f64, bool)>,
) -> Option<Reading> {
    let meters = meters(instrument)?;
    let figures: Vec<Figure> = estimates.iter().map(|e| e.figure(&quantities.luminous)).collect();
    let radiant: Vec<Figure> = estimates.iter().map(|e| e.figure(&quantities.radiant)).collect();
    let mut faults = Faults::default();
    estimates.iter().for_each(|e| faults.append(&e.faults()));
    let (quantity, unit) = quantity(&meters[0].response);
    let points = match &instrument.kind {
        Kind::Grid { counts, map, .. } => Some(Points { counts: *counts, map: *map, figures: figures.clone() }),
        _ => None,
    };
    Some(Reading {
        name: instrument.name.clone(),
        quantity,
        unit,
        figure: mean(&figures),
        radiant: Some(mean(&radiant)),
        samples: estimates.iter().map(Estimate::samples).sum(),
        faults,
        target,
        discretisation: None,
        spectral: instrument.spectrum.then(|| spectral(&estimates[0], bands, quantities)),
        points,
        intensities: None,
        brdf: None,
        denoised: None,
    })
}

/// The flux that a goniophotometer measured, with its intensities.
#[must_use]
pub fn of_goniophotometer(
    instrument: &Instrument,
    measured: Measured,
    bands: &Bands,
    quantities: &Quantities,
) -> Reading {
    let (quantity, unit) = quantity(&Response::Flux);
    let flux = &measured.flux;
    Reading {
        name: instrument.name.clone(),
        quantity,
        unit,
        figure: flux.figure(&quantities.luminous),
        radiant: Some(flux.figure(&quantities.radiant)),
        samples: flux.samples(),
        faults: flux.faults(),
        target: None,
        discretisation: None,
        spectral: instrument.spectrum.then(|| spectral(flux, bands, quantities)),
        points: None,
        intensities: Some(measured),
        brdf: None,
        denoised: None,
    }
}

/// The luminous reflectance of a sample in equal-energy light from the first direction, with all of its BRDF.
#[must_use]
pub fn of_gonioreflectometer(
    instrument: &Instrument,
    measured: gonioreflectometer::Measured,
    quantities: &Quantities,
) -> Reading {
    let whole: f64 = quantities.luminous.iter().sum();
    let weights: Vec<f64> = quantities.luminous.iter().map(|w| w / whole).collect();
    let mut faults = Faults::default();
    measured.lobes.iter().for_each(|lobe| faults.append(&lobe.reflectance.faults()));
    Reading {
        name: instrument.name.clone(),
        quantity: "reflectance",
        unit: "1",
        figure: measured.lobes[0].reflectance.figure(&weights),
        radiant: None,
        samples: measured.lobes.iter().map(|lobe| lobe.reflectance.samples()).sum(),
        faults,
        target: None,
        discretisation: None,
        spectral: None,
        points: None,
        intensities: None,
        brdf: Some(measured),
        denoised: None,
    }
}

/// The mean luminance of a picture; one sample of a pixel does not tell its standard error.
#[must_use]
pub fn of_picture(instrument: &Instrument, noise: &Noise, denoised: Option<Price>, samples_per_pixel: u64) -> Reading {
    #[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
    let n = noise.pixels.max(1) as f64;
    let standard_error = if samples_per_pixel > 1 { noise.variance.sqrt() / n } else { f64::NAN };
    Reading {
        name: instrument.name.clone(),
        quantity: "mean luminance of the picture",
        unit: "cd/m2",
        figure: Figure { value: noise.luminance / n, standard_error },
        radiant: None,
        samples: noise.pixels * samples_per_pixel,
        faults: noise.faults,
        target: None,
        discretisation: None,
        spectral: None,
        points: None,
        intensities: None,
        brdf: None,
        denoised,
    }
}

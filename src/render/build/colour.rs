//! The scene's spectra as functions of wavelength, and the products of them that light can become.

use std::ops::RangeInclusive;

use glam::DVec3;
use toml::Spanned;

use super::Builder;
use super::reach::LeftOut;
use crate::colorimetry::Observer;
use crate::colorimetry::rgb::SRGB;
use crate::constants::SecondRadiation;
use crate::illuminant::named;
use crate::render::bands::{Bands, RANGE_NM, Width, as_function};
use crate::render::description::Error;
use crate::render::description::spectrum::SpectrumSource;
use crate::spectrum::integrate::Weighting;
use crate::spectrum::{Sampling, Spectrum};

/// What a spectrum is beyond its table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Edge {
    /// Zero: of an emission.
    Dark,
    /// As at its end: of a reflectance.
    Constant,
}

/// What a spectrum is for.
#[derive(Debug, Clone)]
pub(super) struct Role {
    /// Its key.
    key: &'static str,
    /// What it is beyond its table.
    edge: Edge,
    /// The values that it may have.
    range: RangeInclusive<f64>,
}

impl Role {
    /// Of light.
    pub(super) const LIGHT: Self = Self::emission("spectrum");

    /// Of light, under a key of its own.
    pub(super) const fn emission(key: &'static str) -> Self {
        Self { key, edge: Edge::Dark, range: 0.0..=f64::INFINITY }
    }

    /// A factor on light, such as a reflectance.
    pub(super) const fn factor(key: &'static str) -> Self {
        Self { key, edge: Edge::Constant, range: 0.0..=1.0 }
    }

    /// A share of light that is absorbed, none beyond its table.
    pub(super) const fn absorption(key: &'static str) -> Self {
        Self { key, edge: Edge::Dark, range: 0.0..=1.0 }
    }

    /// A refractive index.
    pub(super) const fn index(key: &'static str) -> Self {
        Self { key, edge: Edge::Constant, range: 1.0..=1e3 }
    }

    /// The same with its last values beyond its table.
    pub(super) fn going_on(self) -> Self {
        Self { edge: Edge::Constant, ..self }
    }

    /// What is wrong with a spectrum for this, in the numbers that were written: of a table its points within the wavelengths that are carried,
    /// and where it enters and leaves them.
    fn fault(&self, colour: &Colour) -> Option<String> {
        let (low, high) = RANGE_NM;
        let wrong = |(nm, value): &(f64, f64)| (low..=high).contains(nm) && !self.range.contains(value);
        let points = |nm: &[f64], values: &[f64]| {
            let ends = [(low, colour.at(low)), (high, colour.at(high))];
            nm.iter().copied().zip(values.iter().copied()).chain(ends).find(wrong)
        };
        let found = match colour {
            Colour::Constant(value) if self.range.contains(value) => return None,
            Colour::Constant(value) => format!("{value}"),
            Colour::Table(table, _) => {
                let (nm, value) = points(table.wavelengths_nm(), table.values())?;
                format!("{value} at {nm} nm")
            }
            Colour::Lines(lines) => {
                let (nm, value) = points(lines.wavelengths_nm(), lines.values())?;
                format!("{value} at {nm} nm")
            }
        };
        let (low, high) = (self.range.start(), self.range.end());
        let expected = if high.is_finite() { format!("from {low} to {high}") } else { format!("of {low} or more") };
        Some(format!("`{}` is {found}; expected a number or spectrum {expected}", self.key))
    }
}

/// A spectrum of the scene.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Colour {
    Constant(f64),
    Table(Weighting, Edge),
    Lines(Spectrum),
}

impl Colour {
    /// Looks a spectrum up: by value, by name in the scene or among the known sources, or in a file.
    pub(super) fn of(b: &Builder<'_>, source: &Spanned<SpectrumSource>, role: &Role) -> Result<Self, Error> {
        let colour = Self::found(b, source, role.edge)?;
        role.fault(&colour).map_or(Ok(colour), |message| Err(b.wrong(&source.span(), message)))
    }

    /// Of light that may have no spectrum of its own: then the same at every wavelength.
    pub(super) fn of_light(b: &Builder<'_>, source: Option<&Spanned<SpectrumSource>>) -> Result<Self, Error> {
        source.map_or(Ok(Self::Constant(1.0)), |s| Self::of(b, s, &Role::LIGHT))
    }

    fn found(b: &Builder<'_>, source: &Spanned<SpectrumSource>, edge: Edge) -> Result<Self, Error> {
        let at = &source.span();
        let spectrum = match source.get_ref() {
            SpectrumSource::Constant(value) => return Ok(Self::Constant(*value)),
            SpectrumSource::Table(table) => {
                let (nm, values): (Vec<f64>, Vec<f64>) = table.iter().map(|[nm, v]| (*nm, *v)).unzip();
                return Ok(Self::Table(Weighting::table(nm, values), edge));
            }
            SpectrumSource::Named(name) => match b.description.spectra.get(name) {
                Some(found) => match found.get_ref() {
                    SpectrumSource::Named(other) if b.description.spectra.contains_key(other) => {
                        let message = format!("`{name}` is another name for `{other}`; expected the spectrum itself");
                        return Err(b.wrong(&found.span(), message));
                    }
                    _ => return Self::found(b, found, edge),
                },
                None => named::source(name, SecondRadiation::default()).map(|s| s.spectrum).map_err(|e| {
                    let own: Vec<&str> = b.description.spectra.keys().map(String::as_str).collect();
                    let own = if own.is_empty() { "none".to_owned() } else { own.join(", ") };
                    b.wrong(at, format!("no spectrum is called `{name}` (the scene has: {own}); {e}"))
                })?,
            },
            SpectrumSource::File(file) => b.files.spectrum(file).map_err(|e| b.wrong(at, e))?,
        };
        Ok(match spectrum.sampling() {
            Sampling::Density => Self::Table(as_function(&spectrum), edge),
            Sampling::Lines => Self::Lines(spectrum),
        })
    }

    /// The value at a wavelength; lines have none.
    pub(super) fn at(&self, nm: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(table, Edge::Dark) => table.at(nm),
            Self::Table(table, Edge::Constant) => {
                let (low, high) = table.range_nm();
                table.at(nm.clamp(low, high))
            }
            Self::Lines(_) => 0.0,
        }
    }

    /// The values of an emission in the bands; `Err` with the wavelength of a line that no band has.
    pub(super) fn values(&self, bands: &Bands) -> Result<Vec<f64>, f64> {
        let mut values = self.factors(bands)?;
        if !matches!(self, Self::Lines(_)) {
            // A density has no power in a line.
            let lines = values.iter_mut().zip(bands.widths()).filter(|(_, width)| **width == Width::Line);
            lines.for_each(|(value, _)| *value = 0.0);
        }
        Ok(values)
    }

    /// The values in the bands of what light is multiplied by, which a line meets like any other wavelength; `Err` as of an emission.
    pub(super) fn factors(&self, bands: &Bands) -> Result<Vec<f64>, f64> {
        match self {
            Self::Lines(spectrum) => bands.emission(spectrum),
            _ => Ok(bands.wavelengths_nm().iter().map(|&nm| self.at(nm)).collect()),
        }
    }

    /// Whether some of the light of this emission is left by a factor, of a density at the entries of the CIE's tables.
    fn meets(&self, factor: &Self) -> bool {
        match self {
            Self::Lines(s) => (s.wavelengths_nm().iter().zip(s.values())).any(|(&nm, v)| v * factor.at(nm) > 0.0),
            _ => entries_nm().any(|nm| self.at(nm) * factor.at(nm) > 0.0),
        }
    }

    /// Whether this emits a density that the render carries.
    pub(super) fn is_density(&self) -> bool {
        entries_nm().any(|nm| self.at(nm) > 0.0)
    }

    /// ∫ over the whole spectrum: over its own table, over the range that is carried for a constant, the sum for lines.
    pub(super) fn total(&self) -> f64 {
        match self {
            Self::Constant(value) => value * (RANGE_NM.1 - RANGE_NM.0),
            Self::Table(table, _) => (table.wavelengths_nm().windows(2).zip(table.values().windows(2)))
                .map(|(nm, v)| 0.5 * (nm[1] - nm[0]) * (v[0] + v[1]))
                .sum(),
            Self::Lines(spectrum) => spectrum.values().iter().sum(),
        }
    }
}

/// The wavelengths of the CIE's tables, nm.
fn entries_nm() -> impl Iterator<Item = f64> {
    (0_u32..).map(|i| RANGE_NM.0 + f64::from(i)).take_while(|nm| *nm <= RANGE_NM.1)
}

/// What makes a dye of a surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dye {
    pub absorption: Colour,
    pub emission: Colour,
}

/// All spectra of a scene that decide which wavelengths it needs.
#[derive(Debug)]
pub(super) struct Colours {
    emissions: Vec<Colour>,
    reflectances: Vec<Colour>,
    /// Those that some light excites, be it that of another.
    dyes: Vec<Dye>,
}

/// More different reflectances than this are taken one at a time.
const PAIRED: usize = 12;

/// The dyes that some emission excites, or what another of them emits.
fn excited(emissions: &[Colour], mut dark: Vec<Dye>) -> Vec<Dye> {
    let mut lit: Vec<Dye> = Vec::new();
    loop {
        let (more, rest): (Vec<Dye>, Vec<Dye>) = dark
            .into_iter()
            .partition(|dye| emissions.iter().chain(lit.iter().map(|d| &d.emission)).any(|e| e.meets(&dye.absorption)));
        if more.is_empty() {
            return lit;
        }
        lit.extend(more);
        dark = rest;
    }
}

impl Colours {
    /// The spectra of all that is not left out.
    pub(super) fn new(b: &Builder<'_>, left_out: &LeftOut) -> Result<Self, Error> {
        let d = b.description;
        let mut emissions = Vec::new();
        let lights = || d.light.iter().enumerate().filter(|(number, _)| !left_out.lights.contains(number));
        for (_, light) in lights() {
            let at = super::light::span(light);
            let environment = light.environment.as_ref().map(toml::Spanned::get_ref);
            if let Some(file) = environment.and_then(|e| e.file.as_ref()) {
                emissions.extend(super::picture::emissions(b, file, light.spectrum.as_ref(), &at)?);
                continue;
            }
            emissions.push(Colour::of_light(b, light.spectrum.as_ref())?);
        }
        let shapes = d.shape.iter().enumerate().filter(|(number, _)| !left_out.shapes.contains(number));
        for emission in shapes.filter_map(|(_, s)| s.emission.as_ref()) {
            emissions.push(Colour::of_light(b, emission.get_ref().spectrum.as_ref())?);
        }
        let mut reflectances = super::material::colours(b)?;
        let slides =
            lights().filter_map(|(_, l)| l.barzel.as_ref()).filter_map(|b| Some((b.get_ref().slide.as_ref()?, b)));
        for (slide, barzel) in slides {
            let picture = b.picture(&slide.file, super::picture::Of::Factors, &barzel.span())?;
            reflectances.extend(picture.typical());
        }
        let unique = |mut list: Vec<Colour>| {
            let mut out: Vec<Colour> = Vec::new();
            list.retain(|c| {
                !out.contains(c) && {
                    out.push(c.clone());
                    true
                }
            });
            out
        };
        let emissions = unique(emissions);
        let dyes = excited(&emissions, super::material::dyes(b)?);
        Ok(Self { emissions, reflectances: unique(reflectances), dyes })
    }

    /// Whether anything emits a density.
    pub(super) fn has_densities(&self) -> bool {
        self.emissions.is_empty() || self.densities().next().is_some()
    }

    /// What lamps and dyes emit per nanometre.
    fn densities(&self) -> impl Iterator<Item = &Colour> {
        let lamps = self.emissions.iter().filter(|c| !matches!(c, Colour::Lines(_)));
        lamps.chain(self.dyes.iter().map(|d| &d.emission))
    }

    /// The wavelengths of all lines, ascending, nm.
    pub(super) fn lines(&self) -> Vec<f64> {
        let mut all: Vec<f64> = (self.emissions.iter())
            .filter_map(|c| if let Colour::Lines(s) = c { Some(s.wavelengths_nm().to_vec()) } else { None })
            .flatten()
            .collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// Every emission of a density by itself, with every reflectance, and with every pair of them.
    fn chains(&self) -> Vec<Vec<&Colour>> {
        let mut out = Vec::new();
        for e in self.densities() {
            out.push(vec![e]);
            for (i, r) in self.reflectances.iter().enumerate() {
                out.push(vec![e, r]);
                let others =
                    if self.reflectances.len() <= PAIRED { &self.reflectances[i..] } else { &self.reflectances[i..=i] };
                out.extend(others.iter().map(|s| vec![e, r, s]));
            }
        }
        out
    }

    /// Every emission by itself, reflected once by every material, and twice by every pair of them.
    pub(super) fn products(&self) -> Vec<Box<dyn Fn(f64) -> f64 + '_>> {
        let mut out: Vec<Box<dyn Fn(f64) -> f64 + '_>> = Vec::new();
        for chain in self.chains() {
            out.push(Box::new(move |nm| chain.iter().map(|c| c.at(nm)).product()));
        }
        out
    }

    /// The greatest error in the bands of numbers of photons, relative to the integral by straight lines at 1 nm: of what a dye absorbs of an
    /// emission, by itself and reflected once, and of what it emits.
    pub(super) fn error_of_photons(&self, bands: &Bands) -> f64 {
        let per_energy = Weighting::table(vec![RANGE_NM.0, RANGE_NM.1], vec![RANGE_NM.0, RANGE_NM.1]);
        let entries = Bands::uniform(RANGE_NM.0, 1.0);
        let mut fine = entries.weights(&per_energy);
        fine[0] *= 0.5;
        *fine.last_mut().expect("more than one band") *= 0.5;
        let coarse = bands.weights(&per_energy);
        let off = |product: &[&Colour]| {
            let sum = |nm: &[f64], weights: &[f64]| -> f64 {
                (nm.iter().zip(weights)).map(|(&nm, w)| w * product.iter().map(|c| c.at(nm)).product::<f64>()).sum()
            };
            let exact = sum(entries.wavelengths_nm(), &fine);
            let found = sum(bands.wavelengths_nm(), &coarse);
            if exact > 0.0 { (found - exact).abs() / exact } else { 0.0 }
        };
        let mut worst = 0.0_f64;
        for dye in &self.dyes {
            worst = worst.max(off(&[&dye.emission]));
            for e in self.densities() {
                worst = worst.max(off(&[e, &dye.absorption]));
                worst = self.reflectances.iter().map(|r| off(&[e, r, &dye.absorption])).fold(worst, f64::max);
            }
        }
        worst
    }

    /// The greatest error of X, Y and Z of the same products, relative to the largest of the three, where light is its linear sRGB and a
    /// surface that of it under D65, over that of D65, negative parts cut, and colours are multiplied channel by channel; `None` where there are
    /// lines, or nothing shines.
    pub(super) fn error_in_rgb(&self) -> Option<f64> {
        if !self.lines().is_empty() {
            return None;
        }
        let to_xyz = SRGB.to_xyz()?;
        let from_xyz = to_xyz.inverse();
        let bars = Observer::Cie1931.colour_matching_functions();
        let nodes = Bands::uniform(RANGE_NM.0, 1.0);
        let xyz = |f: &dyn Fn(f64) -> f64| {
            let sum = |bar: &Weighting| nodes.wavelengths_nm().iter().map(|&nm| bar.at(nm) * f(nm)).sum::<f64>();
            DVec3::from_array(bars.each_ref().map(sum))
        };
        let d65 = as_function(&named::source("D65", SecondRadiation::default()).ok()?.spectrum);
        let white = from_xyz * xyz(&|nm| d65.at(nm));
        let light = |c: &Colour| (from_xyz * xyz(&|nm| c.at(nm))).max(DVec3::ZERO);
        let surface = |c: &Colour| (from_xyz * xyz(&|nm| d65.at(nm) * c.at(nm)) / white).max(DVec3::ZERO);
        let off = |chain: Vec<&Colour>| {
            let (first, rest) = chain.split_first()?;
            let rgb = rest.iter().fold(light(first), |rgb, c| rgb * surface(c));
            let exact = xyz(&|nm| chain.iter().map(|c| c.at(nm)).product());
            let scale = exact.max_element();
            (scale > 0.0).then(|| (to_xyz * rgb - exact).abs().max_element() / scale)
        };
        self.chains().into_iter().filter_map(off).reduce(f64::max)
    }
}

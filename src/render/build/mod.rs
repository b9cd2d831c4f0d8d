//! From a scene's description to a scene: files asked for, wavelengths chosen, everything prepared for the bands.

mod colour;
mod instrument;
mod light;
mod material;
mod surface;

use std::ops::Range;
use std::sync::Arc;

use super::bands::Bands;
use super::description::spectrum::SpectrumSource;
use super::description::{Description, Error, Solver};
use super::integrator::path::{Follow, Limits};
use super::light::Light;
use super::light::bounding::BoundingSphere;
use super::measure::Settings;
use super::mesh::MeshData;
use super::scene::{Part, Scene};
use crate::colorimetry::observer::Observer;
use crate::constants::K_M;
use crate::luminaire::Luminaire;
use crate::photometry::luminous::Efficiency;
use crate::spectrum::Spectrum;

pub use instrument::{Instrument, Kind, Quantities};

/// Where a scene's files come from; names are as the scene gives them.
pub trait Files {
    /// The spectrum in a file, in SI where it has a unit.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    fn spectrum(&self, file: &str) -> Result<Spectrum, String>;

    /// The luminaire in a file.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    fn luminaire(&self, file: &str) -> Result<Luminaire, String>;

    /// The meshes in a file.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    fn meshes(&self, file: &str) -> Result<Vec<MeshData>, String>;
}

/// A scene that is ready to be rendered.
#[derive(Debug)]
pub struct Built {
    /// The scene.
    pub scene: Scene,
    /// Its instruments, in the order of the description.
    pub instruments: Vec<Instrument>,
    /// How the solver runs.
    pub settings: Settings,
    /// What the bands add to the quantities that are read.
    pub quantities: Quantities,
    /// The error that is left in sums over wavelength, relative: measured on the products of the scene's own spectra, against 1 nm;
    /// `None` where the step was asked for.
    pub wavelength_error: Option<f64>,
    /// Names of the lights, in the order of the scene's.
    pub light_names: Vec<String>,
}

/// What the parts of the builder share.
struct Builder<'a> {
    text: &'a str,
    description: &'a Description,
    files: &'a dyn Files,
}

impl Builder<'_> {
    fn wrong(&self, span: &Range<usize>, message: impl ToString) -> Error {
        Error::at(self.text, span, message.to_string())
    }
}

/// Builds a scene from its text and what was read from it.
///
/// # Errors
/// The first mistake, with its place in the text.
pub fn build(text: &str, description: &Description, files: &dyn Files) -> Result<Built, Error> {
    let builder = Builder { text, description, files };
    builder.check_names()?;
    let colours = colour::Colours::new(&builder)?;
    let (bands, wavelength_error) = builder.bands(&colours)?;
    let quantities = Quantities::new(&bands);
    let materials = builder.materials(&bands)?;
    let (parts, surfaces) = builder.parts(&materials, &bands, &quantities)?;
    let sphere = around(&parts);
    let mut light_names = Vec::new();
    let mut lights: Vec<Arc<dyn Light>> = Vec::new();
    for (number, light) in description.light.iter().enumerate() {
        lights.push(builder.light(light, number, &bands, &quantities, sphere)?);
        light_names.push(light.name.as_ref().map_or_else(|| format!("light {}", number + 1), |n| n.get_ref().clone()));
    }
    for (number, (shape, surfaces)) in description.shape.iter().zip(&surfaces).enumerate() {
        if shape.emission.is_some() {
            light_names.extend(surfaces.clone().map(|_| surface::name(shape, number)));
        }
    }
    let scene = Scene::new(bands, parts, lights);
    let instruments = builder.instruments(&scene, &surfaces)?;
    let render = &description.render;
    let follow = match render.solver {
        Solver::Path => Follow::All,
        Solver::Whitted => Follow::Specular,
        Solver::Direct | Solver::Preview => Follow::Nothing,
    };
    let shadows = render.solver != Solver::Preview;
    let limits = Limits { follow, max_edges: render.max_edges, shadows, ..Limits::default() };
    let settings = Settings::new(render.seed, limits, scene.bands().len());
    Ok(Built { scene, instruments, settings, quantities, wavelength_error, light_names })
}

/// The sphere around all bounded surfaces, and around the origin where there are none.
fn around(parts: &[Part]) -> BoundingSphere {
    let bounds: Vec<_> = parts.iter().map(|p| p.shape.bounds()).filter(super::shape::Bounds::is_finite).collect();
    let all = bounds.iter().copied().fold(super::shape::Bounds::EMPTY, super::shape::Bounds::union);
    let (centre, radius) = if all.is_finite() {
        (0.5 * (all.min + all.max), 0.5 * (all.max - all.min).length())
    } else {
        (glam::DVec3::ZERO, 1.0)
    };
    let radius = if radius > 0.0 { radius } else { 1.0 };
    BoundingSphere::new(centre, radius).expect("a finite centre and a radius above 0")
}

impl Builder<'_> {
    /// Names are unique within their kind.
    fn check_names(&self) -> Result<(), Error> {
        let d = self.description;
        let unique = |names: Vec<&toml::Spanned<String>>, what: &str| {
            for (i, name) in names.iter().enumerate() {
                if names[..i].iter().any(|other| other.get_ref() == name.get_ref()) {
                    let message = format!("a second {what} called `{}`; expected a name of its own", name.get_ref());
                    return Err(self.wrong(&name.span(), message));
                }
            }
            Ok(())
        };
        unique(d.material.iter().map(|m| &m.name).collect(), "material")?;
        unique(d.shape.iter().filter_map(|s| s.name.as_ref()).collect(), "shape")?;
        unique(d.sensor.iter().map(|s| &s.name).collect(), "sensor")
    }

    /// The wavelengths to carry: as asked for, or as few as the scene's spectra allow, and the lines of its line sources.
    fn bands(&self, colours: &colour::Colours) -> Result<(Bands, Option<f64>), Error> {
        let render = &self.description.render;
        if render.wavelength_tolerance.is_nan() || render.wavelength_tolerance <= 0.0 {
            return Err(self.wrong(
                &(0..0),
                "a `wavelength_tolerance` that is not above 0; expected a relative error such as 1e-3",
            ));
        }
        let weightings: Vec<_> = [Efficiency::default().weighting()]
            .into_iter()
            .chain(Observer::Cie1931.colour_matching_functions())
            .collect();
        let lines = colours.lines();
        let (bands, error) = match render.wavelength_step_nm {
            Some(step) if (1.0..=100.0).contains(&step) => {
                let first = super::bands::RANGE_NM.0 + if step > 1.0 { (0.5 * step).floor() } else { 0.0 };
                (Bands::uniform(first, step), None)
            }
            Some(step) => {
                let message = format!("a `wavelength_step_nm` of {step}; expected 1 to 100");
                return Err(self.wrong(&(0..0), message));
            }
            None if !colours.has_densities() && !lines.is_empty() => return Ok((Bands::lines(lines), Some(0.0))),
            None => {
                let products = colours.products();
                let functions: Vec<&dyn Fn(f64) -> f64> = products.iter().map(|p| p.as_ref() as _).collect();
                let (bands, error) = Bands::choose(&functions, &weightings, render.wavelength_tolerance);
                (bands, Some(error))
            }
        };
        Ok((bands.and_lines(&lines), error))
    }

    /// The values of a spectrum in the bands. Beyond its table a reflectance (`edge`) goes on as it ends, an emission is 0.
    fn values(
        &self,
        source: &SpectrumSource,
        bands: &Bands,
        edge: colour::Edge,
        at: &Range<usize>,
    ) -> Result<Vec<f64>, Error> {
        colour::Colour::of(self, source, edge, at)?.values(bands).map_err(|nm| {
            self.wrong(
                at,
                format!("a line at {nm} nm for which there is no band; expected the lines of the scene's sources"),
            )
        })
    }
}

/// K_m times the weights of V(λ).
fn luminous_weights(bands: &Bands) -> Vec<f64> {
    bands.weights(&Efficiency::default().weighting()).into_iter().map(|w| K_M * w).collect()
}

//! From a scene's description to a scene: files asked for, wavelengths chosen, everything prepared for the bands.

mod analysis;
mod barzel;
mod colour;
mod endless;
mod heroes;
mod instrument;
mod light;
mod material;
mod measured;
mod picture;
mod radiosity;
mod reach;
mod surface;
#[cfg(test)]
mod tests;

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;

use super::audit::bias::SingleScattering;
use super::bands::{Bands, Chosen};
use super::description::spectrum::SpectrumSource;
use super::description::{Carried, Description, Error, Model, Solver};
use super::format::Object;
use super::integrator::limits::{Follow, Limits};
use super::light::Light;
use super::light::bounding::BoundingSphere;
use super::measure::Settings;
use super::scene::{Part, Scene};
use crate::brdf::table::Table;
use crate::colorimetry::observer::Observer;
use crate::constants::K_M;
use crate::luminaire::Luminaire;
use crate::mistake;
use crate::photometry::luminous::Efficiency;
use crate::spectrum::Spectrum;

pub use analysis::Analysis;
pub use instrument::{Instrument, Kind, Quantities};
pub use measured::Gain;
pub use picture::PictureFile;
pub use surface::Meshes;

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

    /// The meshes in a file, with the names they have there.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    fn meshes(&self, file: &str) -> Result<Vec<Object>, String>;

    /// The picture in a file.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    fn picture(&self, file: &str) -> Result<PictureFile, String>;

    /// The measured BRDF in a file.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    fn table(&self, file: &str) -> Result<Table, String>;
}

/// Of a scene without files: each that it names is refused by its name.
#[derive(Debug, Clone, Copy)]
pub struct NoFiles;

impl Files for NoFiles {
    fn spectrum(&self, file: &str) -> Result<Spectrum, String> {
        Err(no_file(file))
    }

    fn luminaire(&self, file: &str) -> Result<Luminaire, String> {
        Err(no_file(file))
    }

    fn meshes(&self, file: &str) -> Result<Vec<Object>, String> {
        Err(no_file(file))
    }

    fn picture(&self, file: &str) -> Result<PictureFile, String> {
        Err(no_file(file))
    }

    fn table(&self, file: &str) -> Result<Table, String> {
        Err(no_file(file))
    }
}

fn no_file(file: &str) -> String {
    format!("{file}: found a file; expected a scene without files")
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
    /// How it is solved by radiosity, where that is the solver.
    pub radiosity: Option<super::radiosity::Settings>,
    /// What the bands add to the quantities that are read.
    pub quantities: Quantities,
    /// The error that is left in sums over wavelength, relative: measured on the products of the scene's own spectra, against 1 nm;
    /// `None` where the step was asked for.
    pub wavelength_error: Option<f64>,
    /// The same of their watts.
    pub radiant_error: Option<f64>,
    /// What of the model of light the scene needs.
    pub analysis: Analysis,
    /// Names of the lights, in the order of the scene's.
    pub light_names: Vec<String>,
    /// Names of the materials; the last is that of shapes without one.
    pub material_names: Vec<String>,
    /// The material of each surface, by its place in the names.
    pub material_of_surface: Vec<usize>,
    /// What materials lose to a single scattering, by name.
    pub single_scattering: Vec<(String, SingleScattering)>,
    /// Measured tables that give back more than they get.
    pub gains: Vec<Gain>,
    /// Meshes that lost triangles.
    pub incomplete: Vec<Incomplete>,
    /// Light or instruments are in a closed space that absorbs nothing, where paths end by the solver's limits alone: what those leave out has no
    /// bound, and packets that know no limits would never end.
    pub endless: bool,
    /// Pictures are filtered ([`denoise`](super::denoise)).
    pub denoises: bool,
}

/// A mesh of a file some of whose triangles were left out, because they span no area or have a corner that is not finite.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Incomplete {
    /// The file, as the scene names it.
    pub file: String,
    /// The mesh's name there, if it has one.
    pub mesh: Option<String>,
    /// How many triangles were left out.
    pub triangles: usize,
    /// How many there were.
    pub of: usize,
    /// The first that was left out, from 1, as the faces of the mesh are cut into triangles one after the other.
    pub first: usize,
    /// Line of the scene where the file is first asked for, from 1.
    pub line: u64,
    /// Column there, from 1.
    pub column: u64,
}

/// How often the tolerance of bands is halved before all are carried.
const HALVINGS: i32 = 12;

/// What the parts of the builder share.
struct Builder<'a> {
    text: &'a str,
    description: &'a Description,
    files: &'a dyn Files,
    meshes: &'a Meshes,
    /// By file, and whether as light.
    pictures: RefCell<HashMap<(String, bool), Rc<picture::Channels>>>,
    tables: measured::Tables,
}

impl Builder<'_> {
    fn wrong(&self, span: &Range<usize>, message: impl ToString) -> Error {
        Error::at(self.text, span, message.to_string())
    }

    /// The same of the value of a key in the table that begins at `table`, or that holds a value there.
    fn wrong_key(&self, table: &Range<usize>, keys: &[&str], message: impl ToString) -> Error {
        self.wrong(&mistake::place(self.text, table, keys), message)
    }

    /// Both or none of two keys in the table at `at`, where one is needed.
    fn not_one(&self, at: &Range<usize>, both: bool, [a, b]: [&str; 2]) -> Error {
        let found = if both { format!("both `{a}` and `{b}`") } else { format!("neither `{a}` nor `{b}`") };
        self.wrong(at, format!("{found}; expected one of them"))
    }
}

/// The text of a scene and its files. Scenes that are built from it one after the other share the meshes that were read.
#[derive(Clone, Copy)]
pub struct Origin<'a> {
    text: &'a str,
    files: &'a dyn Files,
    meshes: &'a Meshes,
}

impl<'a> Origin<'a> {
    /// A text and its files; `meshes` keeps those that are read, and is of no other files.
    #[must_use]
    pub fn new(text: &'a str, files: &'a dyn Files, meshes: &'a Meshes) -> Self {
        Self { text, files, meshes }
    }

    /// Builds a scene from what was read from the text.
    ///
    /// # Errors
    /// The first mistake, with its place in the text.
    pub fn build(self, description: &Description) -> Result<Built, Error> {
        let Self { text, files, meshes } = self;
        built(&Builder {
            text,
            description,
            files,
            meshes,
            pictures: RefCell::default(),
            tables: measured::Tables::default(),
        })
    }
}

/// Surfaces and lights in the bands that they decided.
struct Prepared {
    bands: Bands,
    /// What is left of weighted sums over wavelength, and of watts, relative.
    errors: Option<[f64; 2]>,
    quantities: Quantities,
    materials: Vec<material::Named>,
    parts: Vec<Part>,
    surfaces: Vec<Range<usize>>,
    lights: Vec<reach::Numbered>,
    left_out: reach::LeftOut,
}

/// Builds a scene from its text and what was read from it.
///
/// # Errors
/// The first mistake, with its place in the text.
pub fn build(text: &str, description: &Description, files: &dyn Files) -> Result<Built, Error> {
    Origin::new(text, files, &Meshes::default()).build(description)
}

fn built(builder: &Builder<'_>) -> Result<Built, Error> {
    let (text, description) = (builder.text, builder.description);
    builder.check_names()?;
    let Prepared { bands, errors, quantities, materials, parts, surfaces, lights, left_out } = builder.prepared()?;
    let lights: Vec<(String, Arc<dyn Light>)> = lights.into_iter().map(|(_, name, light)| (name, light)).collect();
    let left_out = [left_out.without_flux, left_out.out_of_reach];
    let gains = builder.gains(&materials, bands.len());
    let analysis = builder.analysis(&parts, &surfaces, &materials, &lights, left_out, bands.len());
    let (mut light_names, lights): (Vec<_>, Vec<_>) = lights.into_iter().unzip();
    let materials_of = description.shape.iter().zip(&surfaces).flat_map(|(shape, surfaces)| {
        let wanted = shape.material.as_ref().map(toml::Spanned::get_ref);
        let found = wanted.and_then(|wanted| materials.iter().position(|(name, _)| name == wanted));
        std::iter::repeat_n(found.unwrap_or(materials.len()), surfaces.len())
    });
    let material_of_surface = materials_of.collect();
    for (number, (shape, surfaces)) in description.shape.iter().zip(&surfaces).enumerate() {
        let shining = surfaces.clone().filter(|surface| parts[*surface].emission.is_some());
        light_names.extend(shining.map(|_| surface::name(shape, number)));
    }
    let scene = Scene::new(bands, parts, lights);
    let instruments = builder.instruments(&scene, &surfaces)?;
    builder.off_lights(&instruments, &analysis.dark_lights)?;
    let radiosity = builder.radiosity(&scene, &surfaces, &instruments)?;
    let render = &description.render;
    let follow = match render.solver {
        // Of radiosity the audits follow all light as well.
        Solver::Path | Solver::Bidirectional | Solver::Radiosity => Follow::All,
        Solver::Whitted => Follow::Specular,
        Solver::Direct | Solver::Preview => Follow::Nothing,
    };
    let shadows = render.solver != Solver::Preview;
    let polarisation = analysis.polarisation;
    let limits = Limits {
        follow,
        max_edges: render.max_edges,
        roulette_from: render.roulette_from,
        polarisation,
        shadows,
        single_band: render.wavelengths_per_path == Carried::One,
    };
    let endless = builder.endless(&scene, &surfaces, &instruments, &limits)?;
    let material_names = materials.into_iter().map(|(name, _)| name).chain(["no material".to_owned()]).collect();
    let single_scattering = builder.single_scattering(scene.bands(), &quantities)?;
    let incomplete = builder.meshes.incomplete();
    let denoises = render.denoises().map_err(|reason| {
        let place = render.denoise.as_ref().map_or(0..0, toml::Spanned::span);
        Error::at(text, &place, reason.to_owned())
    })?;
    let packets = render.solver == Solver::Bidirectional;
    let fluoresces = !analysis.fluorescent.is_empty();
    let heroes = heroes::probabilities(&quantities, scene.lights(), fluoresces, &instruments);
    let settings = Settings::new(render.seed, limits, scene.bands().len()).keeping(&heroes);
    let full = render.model == Model::Full;
    let virtual_lights = if full { Some(false) } else { render.virtual_lights };
    let branches = if full { Some(1) } else { render.branches };
    let guiding = if full { Some(false) } else { render.guiding };
    let settings = Settings { packets, virtual_lights, branches, guiding, points: render.sampler, ..settings };
    Ok(Built {
        scene,
        instruments,
        settings,
        radiosity,
        quantities,
        wavelength_error: errors.map(|e| e[0]),
        radiant_error: errors.map(|e| e[1]),
        analysis,
        light_names,
        material_names,
        material_of_surface,
        single_scattering,
        gains,
        incomplete,
        endless,
        denoises,
    })
}

/// What three colours instead of wavelengths would leave of the light that the scene's spectra become: the greatest error of X, Y and Z of an
/// emission, reflected up to twice, relative to the largest of the three, by multiplication in linear sRGB; `None` of spectral lines.
///
/// # Errors
/// The first mistake in the scene's spectra, with its place in the text.
pub fn error_in_rgb(text: &str, description: &Description, files: &dyn Files) -> Result<Option<f64>, Error> {
    let meshes = &Meshes::default();
    let builder =
        Builder { text, description, files, meshes, pictures: RefCell::default(), tables: measured::Tables::default() };
    Ok(colour::Colours::new(&builder, &reach::LeftOut::default())?.error_in_rgb())
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
        unique(d.light.iter().filter_map(|l| l.name.as_ref()).collect(), "light")?;
        unique(d.sensor.iter().map(|s| &s.name).collect(), "sensor")
    }

    /// Surfaces and lights. Which lights are left out is known when they are built, and they are built in bands: where some are, and the rest
    /// needs other bands, all is built once more.
    fn prepared(&self) -> Result<Prepared, Error> {
        let bands = |left_out: &_| self.bands(&colour::Colours::new(self, left_out)?);
        let mut first = self.prepared_in(bands(&reach::LeftOut::default())?, None)?;
        if self.description.render.model != Model::Minimal {
            return Ok(first);
        }
        let Prepared { bands: carried, parts, surfaces, lights, .. } = &mut first;
        first.left_out = self.leave_out(parts, surfaces, lights, carried.len());
        if first.left_out.lights.is_empty() && first.left_out.shapes.is_empty() {
            return Ok(first);
        }
        let (bands, errors) = bands(&first.left_out)?;
        if bands == first.bands {
            return Ok(Prepared { errors, ..first });
        }
        self.prepared_in((bands, errors), Some(first))
    }

    /// Surfaces and lights in the bands given, but for what was left out `before`.
    fn prepared_in(
        &self,
        (bands, errors): (Bands, Option<[f64; 2]>),
        before: Option<Prepared>,
    ) -> Result<Prepared, Error> {
        let nothing = reach::LeftOut::default();
        let left_out = before.as_ref().map_or(&nothing, |b| &b.left_out);
        let quantities = Quantities::new(&bands);
        let materials = self.materials(&bands)?;
        let built = before.as_ref().map(|b| (&*b.parts, &*b.surfaces));
        let (parts, surfaces) = self.parts(&materials, &bands, &quantities, left_out, built)?;
        let sphere = around(&parts);
        let mut lights = Vec::new();
        let all = self.description.light.iter().enumerate();
        for (number, light) in all.filter(|(number, _)| !left_out.lights.contains(number)) {
            let name = light::name(light, number);
            lights.push((number, name, self.light(light, number, &bands, &quantities, sphere)?));
        }
        let left_out = before.map_or(nothing, |b| b.left_out);
        Ok(Prepared { bands, errors, quantities, materials, parts, surfaces, lights, left_out })
    }

    /// The wavelengths to carry: as asked for, or as few as the scene's spectra allow, and the lines of its line sources; with the errors that are left, of
    /// weighted sums and of watts.
    fn bands(&self, colours: &colour::Colours) -> Result<(Bands, Option<[f64; 2]>), Error> {
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
        let (bands, errors) = match render.wavelength_step_nm {
            Some(step) if (1.0..=100.0).contains(&step) => {
                let first = super::bands::RANGE_NM.0 + if step > 1.0 { (0.5 * step).floor() } else { 0.0 };
                (Bands::uniform(first, step), None)
            }
            Some(step) => {
                let message = format!("a `wavelength_step_nm` of {step}; expected 1 to 100");
                return Err(self.wrong(&(0..0), message));
            }
            None if render.model == Model::Full => (Bands::uniform(super::bands::RANGE_NM.0, 1.0), Some([0.0; 2])),
            None if !colours.has_densities() && !lines.is_empty() => return Ok((Bands::lines(lines), Some([0.0; 2]))),
            None => {
                let products = colours.products();
                let functions: Vec<&dyn Fn(f64) -> f64> = products.iter().map(|p| p.as_ref() as _).collect();
                // What a reading is to be known to its wavelengths must be able to tell.
                let targets = self.description.sensor.iter().filter_map(|s| s.target.as_ref().map(|t| t.0));
                let wanted = targets.fold(render.wavelength_tolerance, f64::min);
                let chosen = |tolerance: f64| {
                    let chosen = Bands::choose(&functions, &weightings, tolerance);
                    let error = chosen.error.max(colours.error_of_photons(&chosen.bands));
                    Chosen { error, ..chosen }
                };
                // What dyes absorb is not seen through V(λ): bands chosen more strictly are tried until they sum it up as well.
                let tried = (0..HALVINGS).map(|n| chosen(wanted * 0.5_f64.powi(n))).find(|c| c.error <= wanted);
                let finest =
                    || Chosen { bands: Bands::uniform(super::bands::RANGE_NM.0, 1.0), error: 0.0, radiant_error: 0.0 };
                let Chosen { bands, error, radiant_error } = tried.unwrap_or_else(finest);
                (bands, Some([error, radiant_error]))
            }
        };
        Ok((bands.and_lines(&lines), errors))
    }

    /// The values in the bands of a spectrum that light is multiplied by. Beyond its table a reflectance goes on as it ends, what a dye
    /// absorbs and emits is 0.
    fn values(
        &self,
        source: &toml::Spanned<SpectrumSource>,
        bands: &Bands,
        role: &colour::Role,
    ) -> Result<Vec<f64>, Error> {
        colour::Colour::of(self, source, role)?.factors(bands).map_err(|nm| {
            self.wrong(
                &source.span(),
                format!("a line at {nm} nm for which there is no band; expected the lines of the scene's sources"),
            )
        })
    }
}

/// K_m times the weights of V(λ).
fn luminous_weights(bands: &Bands) -> Vec<f64> {
    bands.weights(&Efficiency::default().weighting()).into_iter().map(|w| K_M * w).collect()
}

//! A virtual goniophotometer: the luminous intensity of a whole scene (lamps, lenses, shades) as seen from far away.
//!
//! ```text
//! I(ω) = ∫ L(x, ω) cosθ dA
//! ```
//!
//! Two kinds of light are measured apart, because only one of them is known at a direction:
//!
//! - **Straight light**, which meets no surface on its way out, is evaluated at the very directions of the grid: the intensity of a
//!   point light or luminaire, the mean over points of an emitting surface, each with a ray that finds out whether the way is free. A bare lamp
//!   therefore gives back its file to rounding.
//! - **Scattered light** (reflected, refracted, also by glass so clear that no direction can be aimed at) is collected from packets of
//!   flux in cells about the directions of the grid: half way to the next angle on each side, and one round cell at either pole. It
//!   is a mean over the cell, as that of a detector of its size.
//!
//! The flux is that of all packets that leave, which no grid rounds.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::estimate::{Estimate, Faults, Figure, REPLICATES, Replicate, stream};
use super::integrator::light::{LightTracer, Visitor};
use super::measure::Settings;
use super::ray::Ray;
use super::scene::Scene;
use super::steps::{StepError, angles};
use crate::luminaire::{self, Distribution, LampSet, Luminaire, Symmetry, System};

/// Most directions of a grid.
const MOST_DIRECTIONS: usize = 100_000;
/// Draws of an emitting surface's points per direction and replicate, at least.
const LEAST_DRAWS: u64 = 4;

/// The grid and how it is turned.
#[derive(Debug, Clone, PartialEq)]
pub struct Goniophotometer {
    /// From the instrument's frame (−z: γ = 0, +x: C = 0, +y: C = 90°) to the world's.
    to_world: DMat3,
    c_deg: Vec<f64>,
    gamma_deg: Vec<f64>,
}

/// What a goniophotometer cannot be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A step that does not divide its range.
    #[error(transparent)]
    Step(#[from] StepError),
    /// More directions than a grid may have.
    #[error("a grid of {found} directions; expected at most {MOST_DIRECTIONS}, by wider steps")]
    Directions {
        /// Directions asked for.
        found: usize,
    },
    /// Axes that span no plane.
    #[error("`down` and `c0` along one line, or without length; expected two directions")]
    Axes,
}

/// One measurement.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    /// What is measured.
    pub scene: &'a Scene,
    /// Seed, and how paths are split.
    pub settings: &'a Settings,
    /// The instrument's number in the render; the next one is taken as well.
    pub instrument: u64,
    /// Packets in all.
    pub samples: u64,
    /// What each band adds to the intensity (K_m V(λ) Δλ for cd).
    pub weights: &'a [f64],
}

impl Run<'_> {
    fn per_replicate(&self) -> u64 {
        self.samples.div_ceil(REPLICATES as u64)
    }

    fn weighted(&self, values: &[f64]) -> f64 {
        values.iter().zip(self.weights).map(|(v, w)| v * w).sum()
    }
}

/// What it measured: all arrays plane by plane (row = C, column = γ).
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// C-planes, degrees, from 0 up to below 360.
    pub c_deg: Vec<f64>,
    /// γ, degrees, 0 to 180.
    pub gamma_deg: Vec<f64>,
    /// Intensity, in the unit of the weights (cd).
    pub intensity: Vec<Figure>,
    /// The part of each intensity's value that was scattered, and so is a mean over a cell.
    pub scattered: Vec<f64>,
    /// The flux that leaves, per band.
    pub flux: Estimate,
}

impl Goniophotometer {
    /// One whose γ = 0 is along `down`, whose C = 0 is towards `c0` (or as far as it is across `down`), with steps in degrees.
    ///
    /// # Errors
    /// [`Error`].
    pub fn new(down: DVec3, c0: DVec3, c_step_deg: f64, gamma_step_deg: f64) -> Result<Self, Error> {
        let z = -down.try_normalize().ok_or(Error::Axes)?;
        let across = c0.try_normalize().ok_or(Error::Axes)?.reject_from_normalized(z);
        // Less than a millionth of a turn between the axes leaves too few digits of the plane that they span.
        let x = if across.length() > 1e-6 { across.normalize() } else { return Err(Error::Axes) };
        let mut c_deg = angles("c_step", c_step_deg, 360.0)?;
        // C = 360° is C = 0 again.
        c_deg.pop();
        let gamma_deg = angles("gamma_step", gamma_step_deg, 180.0)?;
        let found = c_deg.len() * gamma_deg.len();
        if found > MOST_DIRECTIONS {
            return Err(Error::Directions { found });
        }
        Ok(Self { to_world: DMat3::from_cols(x, z.cross(x), z), c_deg, gamma_deg })
    }

    /// Directions of the grid.
    #[must_use]
    pub fn directions(&self) -> usize {
        self.c_deg.len() * self.gamma_deg.len()
    }

    /// The direction of angles in degrees, in the world.
    fn direction(&self, c_deg: f64, gamma_deg: f64) -> DVec3 {
        let ((sin_c, cos_c), (sin, cos)) = (c_deg.to_radians().sin_cos(), gamma_deg.to_radians().sin_cos());
        self.to_world * DVec3::new(sin * cos_c, sin * sin_c, -cos)
    }

    /// Half the distance to the next angles: where the cell of row `row` begins and ends, degrees.
    fn band_deg(&self, row: usize) -> (f64, f64) {
        let half = 0.5 * self.gamma_deg[1];
        ((self.gamma_deg[row] - half).max(0.0), (self.gamma_deg[row] + half).min(180.0))
    }

    /// Solid angle of the cell of row `row`, sr; the cells at the poles are round and stand for all planes.
    fn solid_angle(&self, row: usize) -> f64 {
        let (from, to) = self.band_deg(row);
        // cos a − cos b without the digits that cancel in narrow cells.
        let (mean, half) = (0.5 * (from + to).to_radians(), 0.5 * (to - from).to_radians());
        let height = 2.0 * mean.sin() * half.sin();
        let pole = row == 0 || row + 1 == self.gamma_deg.len();
        #[expect(clippy::cast_precision_loss, reason = "a number of planes")]
        let share = if pole { 1.0 } else { 1.0 / self.c_deg.len() as f64 };
        std::f64::consts::TAU * height * share
    }

    /// Row and plane of the cell that a direction is in; at a pole the plane is 0.
    fn cell(&self, direction: DVec3) -> (usize, usize) {
        let local = self.to_world.transpose() * direction;
        let gamma = local.x.hypot(local.y).atan2(-local.z).to_degrees();
        let c = local.y.atan2(local.x).to_degrees().rem_euclid(360.0);
        let nearest = |angle: f64, step: f64| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number from 0 up")]
            let index = (angle / step).round() as usize;
            index
        };
        let last = self.gamma_deg.len() - 1;
        let row = nearest(gamma, self.gamma_deg[1]).min(last);
        #[expect(clippy::cast_precision_loss, reason = "a number of planes")]
        let step = 360.0 / self.c_deg.len() as f64;
        (row, if row == 0 || row == last { 0 } else { nearest(c, step) % self.c_deg.len() })
    }

    /// Measures a scene whose lights are all in bounds.
    #[must_use]
    pub fn measure(&self, run: &Run<'_>) -> Measured {
        let parts: Vec<Part> = (0..REPLICATES)
            .into_par_iter()
            .map(|replicate| {
                let straight = self.straight(run, replicate);
                let (scattered, flux) = self.packets(run, replicate);
                Part { straight, scattered, flux }
            })
            .collect();
        let of = |values: fn(&Part) -> Vec<f64>| {
            let replicates = parts.iter().map(|p| Replicate::from_parts(values(p), 1, Faults::default()));
            Estimate::new(replicates.collect()).bands()
        };
        let sum = |p: &Part| p.straight.iter().zip(&p.scattered).map(|(a, b)| a + b).collect();
        Measured {
            c_deg: self.c_deg.clone(),
            gamma_deg: self.gamma_deg.clone(),
            intensity: of(sum),
            scattered: of(|p| p.scattered.clone()).iter().map(|f| f.value).collect(),
            flux: Estimate::new(parts.into_iter().map(|p| p.flux).collect()),
        }
    }

    /// Straight light in the directions of the grid.
    fn straight(&self, run: &Run<'_>, replicate: usize) -> Vec<f64> {
        let scene = run.scene;
        let mut sum = vec![0.0; self.directions()];
        let draws = (run.per_replicate() / self.directions() as u64).max(LEAST_DRAWS);
        let mut sampler = run.settings.sampler(stream(run.instrument + 1, replicate));
        let mut arriving = vec![0.0; scene.bands().len()];
        for draw in 0..draws {
            sampler.start(draw);
            let planes = self.c_deg.iter().flat_map(|c| self.gamma_deg.iter().map(move |gamma| (*c, *gamma)));
            for (sum, (c, gamma)) in sum.iter_mut().zip(planes) {
                let direction = self.direction(c, gamma);
                for light in 0..scene.lights().len() {
                    let [u, v, w, _] = sampler.four();
                    if intensity(scene, light, direction, [u, v, w], &mut arriving) {
                        *sum += run.weighted(&arriving);
                    }
                }
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of draws")]
        sum.iter_mut().for_each(|s| *s /= draws as f64);
        sum
    }

    /// Scattered light in the cells, and all flux that leaves.
    fn packets(&self, run: &Run<'_>, replicate: usize) -> (Vec<f64>, Replicate) {
        let stream = stream(run.instrument, replicate);
        let bands = run.scene.bands().len();
        let mut sampler = run.settings.sampler(stream);
        let mut tracer = LightTracer::new(run.scene, &run.settings.heroes);
        let (mut leaving, mut flux) = (Leaving::new(bands), Replicate::new(bands));
        let mut cells = vec![0.0; self.directions()];
        let rows = self.gamma_deg.len();
        for index in 0..run.per_replicate() {
            sampler.start(index);
            leaving.clear();
            tracer.packet(&mut sampler, &mut leaving);
            let faulty = flux.faults().count();
            flux.add(stream, leaving.flux());
            if let Some(direction) = leaving.scattered.filter(|_| flux.faults().count() == faulty) {
                let (row, plane) = self.cell(direction);
                cells[plane * rows + row] += run.weighted(leaving.flux());
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of packets")]
        let packets = run.per_replicate() as f64;
        let scattered = (0..cells.len())
            .map(|index| {
                let row = index % rows;
                let pole = row == 0 || row == rows - 1;
                cells[if pole { row } else { index }] / (packets * self.solid_angle(row))
            })
            .collect();
        (scattered, flux)
    }
}

/// What one replicate measured.
struct Part {
    straight: Vec<f64>,
    scattered: Vec<f64>,
    flux: Replicate,
}

/// The packet that leaves the scene.
#[derive(Debug)]
pub(super) struct Leaving {
    flux: Vec<f64>,
    flights: u32,
    /// Its direction, where it had met a surface before.
    scattered: Option<DVec3>,
}

impl Leaving {
    /// For so many bands.
    pub(super) fn new(bands: usize) -> Self {
        Self { flux: vec![0.0; bands], flights: 0, scattered: None }
    }

    /// Nothing has left yet.
    pub(super) fn clear(&mut self) {
        self.flux.fill(0.0);
        self.flights = 0;
        self.scattered = None;
    }

    /// What left, per band; 0 where the packet was absorbed.
    pub(super) fn flux(&self) -> &[f64] {
        &self.flux
    }
}

impl Visitor for Leaving {
    fn emitted(&mut self, _flux: &[f64]) {}

    fn flight(&mut self, ray: &Ray, length: f64, flux: &[f64]) {
        if length.is_infinite() {
            self.flux.copy_from_slice(flux);
            self.scattered = (self.flights > 0).then_some(ray.direction);
        }
        self.flights += 1;
    }

    fn met(&mut self, _surface: usize, _before: &[f64], _after: &[f64]) {}
}

/// One draw of the intensity of a light's straight light in a direction, per band; `false`: none.
fn intensity(scene: &Scene, index: usize, direction: DVec3, u: [f64; 3], out: &mut [f64]) -> bool {
    let light = &scene.lights()[index];
    if let Some((shape, emission)) =
        scene.surface_of_light(index).and_then(|s| Some((&scene.surfaces().shapes()[s], scene.emission(s)?)))
    {
        let point = shape.sample_area(u);
        let cos = point.normal.dot(direction);
        let weight = emission.profile_towards(direction, cos) * cos.abs() * shape.area();
        let ray = Ray { origin: point.origin_towards(direction), direction };
        if weight == 0.0 || scene.surfaces().is_occluded(&ray, f64::INFINITY, None) {
            return false;
        }
        for (out, radiance) in out.iter_mut().zip(emission.radiance()) {
            *out = weight * radiance;
        }
        return true;
    }
    // A light without a surface tells what arrives at a point. From as far as this it is seen in the direction asked for to 1e-9, which
    // finds where it is to 1e-7; from near by, then, to the last digit, unless the direction is on the very edge of its light. Seen
    // again in the very direction from there, it is I/d².
    let bounds = scene.bounds();
    let (middle, size) = if bounds.is_finite() {
        (0.5 * (bounds.min + bounds.max), (bounds.max - bounds.min).length().max(1.0))
    } else {
        (DVec3::ZERO, 1.0)
    };
    let mut look =
        |from: DVec3| light.sample_towards(from, u, out).map(|seen| (seen, from + seen.distance * seen.direction));
    let reach = 1e9 * size;
    let Some((_, about)) = look(middle + reach * direction) else { return false };
    let (position, from) = match look(about + size * direction) {
        Some((_, position)) => (position, position + size * direction),
        None => (about, about + reach * direction),
    };
    let Some((seen, _)) = look(from) else { return false };
    if light.casts_shadows() && scene.surfaces().is_occluded(&Ray { origin: position, direction }, f64::INFINITY, None)
    {
        return false;
    }
    out.iter_mut().for_each(|e| *e *= seen.distance * seen.distance);
    true
}

impl Measured {
    /// As a luminaire in absolute photometry, for the writers of lamp files.
    ///
    /// # Errors
    /// [`luminaire::Error`] for an intensity that is no number.
    pub fn luminaire(&self, name: &str) -> Result<Luminaire, luminaire::Error> {
        let values = self.intensity.iter().map(|f| f.value).collect();
        let distribution =
            Distribution::new(System::TypeC, Symmetry::None, self.c_deg.clone(), self.gamma_deg.clone(), values)?;
        Ok(Luminaire {
            name: name.to_owned(),
            lamps: vec![LampSet { count: Some(1.0), ..LampSet::default() }],
            ..Luminaire::of(distribution)
        })
    }
}

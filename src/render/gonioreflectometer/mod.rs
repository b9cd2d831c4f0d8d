//! A virtual gonioreflectometer: the BRDF of a sample, be it a material on a flat shape or a patch of some structure.
//!
//! A beam of parallel light falls on a round spot of the reference plane from each direction of incidence; what leaves the scene is
//! collected in cells about the directions of a grid:
//!
//! ```text
//! f_r(ω_i, cell) = Φ_cell / (Φ_i ∫_cell cosθ dω)        ∫_cell cosθ dω = ½ Δφ (sin²θ₂ − sin²θ₁)
//! ```
//!
//! Φ_i is the flux through the spot. A cell reaches half way to the next angle on each side; the one about the normal is round. The value
//! is thus the mean over the cell, weighted with cosθ, as that of a detector of its size: lobes narrower than the cells are
//! flattened, and a mirror's is spread over one cell. Light that a deep structure moves sideways out of the spot is counted; so
//! the sample has to be wider than the spot. Lights of the scene are not used.
//!
//! [`bins`] makes a MERL table of what was measured.

pub mod bins;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::estimate::{Estimate, Figure, REPLICATES, Replicate, stream};
use super::integrator::light::{LightTracer, Visitor};
use super::measure::Settings;
use super::ray::Ray;
use super::scene::Scene;
use super::steps::{StepError, angles};
use crate::geometry::direction::from_degrees;
use crate::math::sampling;

/// Most cells for one direction of incidence, and most of those.
const MOST_CELLS: usize = 20_000;
const MOST_INCIDENT: usize = 1000;
/// Rays across the spot, along both of its sides, that look for the sample.
const PROBES: u32 = 12;

/// The spot and the directions.
#[derive(Debug, Clone, PartialEq)]
pub struct Gonioreflectometer {
    centre: DVec3,
    /// From the sample's frame (z: normal, x: φ = 0) to the world's.
    to_world: DMat3,
    radius: f64,
    /// θ_i and φ_i, degrees.
    incident_deg: Vec<[f64; 2]>,
    theta_deg: Vec<f64>,
    phi_deg: Vec<f64>,
}

/// What a gonioreflectometer cannot be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A step that does not divide its range.
    #[error(transparent)]
    Step(#[from] StepError),
    /// Too many directions.
    #[error(
        "{cells} cells for each of {incident} directions of incidence; expected at most {MOST_CELLS} and {MOST_INCIDENT}, and at least one direction"
    )]
    Size {
        /// Cells.
        cells: usize,
        /// Directions of incidence.
        incident: usize,
    },
    /// An angle of incidence at which no light falls on the sample.
    #[error("an angle of incidence of {found} deg; expected 0 deg up to, but not, 90 deg")]
    Incidence {
        /// θ_i, degrees.
        found: f64,
    },
    /// A spot without area.
    #[error("a radius of {found} m; expected a length above 0")]
    Radius {
        /// The radius, m.
        found: f64,
    },
    /// Axes that span no plane.
    #[error("`normal` and `tangent` along one line, or without length; expected two directions")]
    Axes,
}

/// What it measured for one direction of incidence.
#[derive(Debug, Clone, PartialEq)]
pub struct Lobe {
    /// θ_i and φ_i, degrees.
    pub incident_deg: [f64; 2],
    /// f_r per cell and band, 1/sr: `values[(row θ_o · columns φ_o + column) · bands + band]`; at θ_o = 0 all columns are the same.
    pub values: Vec<Figure>,
    /// The share of the beam that leaves on the side of the normal, per band (directional-hemispherical reflectance).
    pub reflectance: Estimate,
}

/// All that it measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// θ_o, degrees.
    pub theta_deg: Vec<f64>,
    /// φ_o, degrees.
    pub phi_deg: Vec<f64>,
    /// One per direction of incidence.
    pub lobes: Vec<Lobe>,
}

/// A sample's place: `normal` is z of its frame, `tangent` is x, or as far as it is across the normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// The middle, m.
    pub centre: DVec3,
    /// The way that the sample faces.
    pub normal: DVec3,
    /// The way of φ = 0.
    pub tangent: DVec3,
    /// Radius, m.
    pub radius: f64,
}

impl Gonioreflectometer {
    /// One for a spot, directions of incidence (θ_i, φ_i) and steps of θ_o and φ_o, degrees.
    ///
    /// # Errors
    /// [`Error`].
    pub fn new(
        spot: &Spot,
        incident_deg: Vec<[f64; 2]>,
        theta_step_deg: f64,
        phi_step_deg: f64,
    ) -> Result<Self, Error> {
        let z = spot.normal.try_normalize().ok_or(Error::Axes)?;
        let across = spot.tangent.try_normalize().ok_or(Error::Axes)?.reject_from_normalized(z);
        let x = if across.length() > 1e-6 { across.normalize() } else { return Err(Error::Axes) };
        if !(spot.radius > 0.0 && spot.radius.is_finite()) {
            return Err(Error::Radius { found: spot.radius });
        }
        if let Some([found, _]) = incident_deg.iter().find(|[theta, _]| !(0.0..90.0).contains(theta)) {
            return Err(Error::Incidence { found: *found });
        }
        let mut theta_deg = angles("theta_step", theta_step_deg, 90.0)?;
        // The cell about 90° would be cut by the horizon.
        theta_deg.pop();
        let mut phi_deg = angles("phi_step", phi_step_deg, 360.0)?;
        phi_deg.pop();
        let (cells, incident) = (theta_deg.len() * phi_deg.len(), incident_deg.len());
        if cells > MOST_CELLS || !(1..=MOST_INCIDENT).contains(&incident) {
            return Err(Error::Size { cells, incident });
        }
        let to_world = DMat3::from_cols(x, z.cross(x), z);
        Ok(Self { centre: spot.centre, to_world, radius: spot.radius, incident_deg, theta_deg, phi_deg })
    }

    /// Pairs of directions.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.incident_deg.len() * self.theta_deg.len() * self.phi_deg.len()
    }

    /// Directions of incidence.
    #[must_use]
    pub fn incident(&self) -> usize {
        self.incident_deg.len()
    }

    /// Whether any surface is met by the beam, for any direction of incidence: of some hundred rays over the spot.
    #[must_use]
    pub fn has_sample(&self, scene: &Scene) -> bool {
        self.incident_deg.iter().any(|&incident| {
            let (towards_light, reach) = self.beam(scene, incident);
            (0..PROBES * PROBES).any(|n| {
                let [u, v] = [n / PROBES, n % PROBES].map(|i| (f64::from(i) + 0.5) / f64::from(PROBES));
                let ray = self.ray([u, v], towards_light, reach);
                scene.surfaces().closest(&ray, f64::INFINITY).is_some()
            })
        })
    }

    /// The way to the light of a direction of incidence, and from how far along it the beam starts: outside of everything.
    fn beam(&self, scene: &Scene, incident_deg: [f64; 2]) -> (DVec3, f64) {
        let towards_light = self.to_world * from_degrees(incident_deg[0], incident_deg[1]);
        let bounds = scene.bounds();
        let size = if bounds.is_finite() {
            (bounds.max - self.centre).abs().max((bounds.min - self.centre).abs()).length()
        } else {
            0.0
        };
        (towards_light, 2.0 * (size + self.radius) / towards_light.dot(self.to_world.z_axis))
    }

    /// A ray of the beam, onto a place of the spot that two uniform numbers draw.
    fn ray(&self, u: [f64; 2], towards_light: DVec3, reach: f64) -> Ray {
        let spot = self.centre + self.to_world * (self.radius * sampling::disk(u)).extend(0.0);
        Ray { origin: spot + reach * towards_light, direction: -towards_light }
    }

    /// Step of θ_o, degrees.
    fn step(&self) -> f64 {
        90.0 / self.theta_deg.len() as f64
    }

    /// ∫ cosθ dω over a cell of row `row`, sr.
    fn projected(&self, row: usize) -> f64 {
        let square = |deg: f64| deg.to_radians().sin().powi(2);
        let half = 0.5 * self.step();
        let (low, high) = ((self.theta_deg[row] - half).max(0.0), self.theta_deg[row] + half);
        let share = if row == 0 { 1.0 } else { 1.0 / self.phi_deg.len() as f64 };
        std::f64::consts::PI * (square(high) - square(low)) * share
    }

    /// Row and column of the cell of a direction in the sample's frame; `None` near the horizon and below.
    fn cell(&self, local: DVec3) -> Option<(usize, usize)> {
        let theta = local.x.hypot(local.y).atan2(local.z).to_degrees();
        let phi = local.y.atan2(local.x).to_degrees().rem_euclid(360.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small numbers from 0 up")]
        let nearest = |share: f64| share.round() as usize;
        let row = nearest(theta / self.step());
        let column = nearest(phi / 360.0 * self.phi_deg.len() as f64) % self.phi_deg.len();
        (row < self.theta_deg.len()).then_some((row, if row == 0 { 0 } else { column }))
    }

    /// Measures the sample, with `samples` packets in all for each direction of incidence. The instrument takes as many numbers as it
    /// has directions of incidence.
    #[must_use]
    pub fn measure(&self, scene: &Scene, settings: &Settings, instrument: u64, samples: u64) -> Measured {
        let lobes = (instrument..)
            .zip(&self.incident_deg)
            .map(|(number, incident)| self.lobe(scene, settings, number, samples, *incident))
            .collect();
        Measured { theta_deg: self.theta_deg.clone(), phi_deg: self.phi_deg.clone(), lobes }
    }

    fn lobe(&self, scene: &Scene, settings: &Settings, number: u64, samples: u64, incident_deg: [f64; 2]) -> Lobe {
        let per_replicate = samples.div_ceil(REPLICATES as u64);
        let bands = scene.bands().len();
        let (towards_light, reach) = self.beam(scene, incident_deg);
        let parts: Vec<(Replicate, Replicate)> = (0..REPLICATES)
            .into_par_iter()
            .map(|replicate| {
                let stream = stream(number, replicate);
                let mut sampler = settings.sampler(stream);
                let mut tracer = LightTracer::new(scene, &settings.heroes);
                let mut leaving = Leaving { flux: vec![0.0; bands], direction: None };
                let mut reflectance = Replicate::new(bands);
                let mut cells = vec![0.0; self.theta_deg.len() * self.phi_deg.len() * bands];
                for index in 0..per_replicate {
                    sampler.start(index);
                    let [u, v, ..] = sampler.four();
                    let ray = self.ray([u, v], towards_light, reach);
                    leaving.flux.fill(0.0);
                    leaving.direction = None;
                    tracer.beam(ray, &mut sampler, &mut leaving);
                    let local = leaving.direction.map(|d| self.to_world.transpose() * d).filter(|d| d.z > 0.0);
                    if local.is_none() {
                        leaving.flux.fill(0.0);
                    }
                    let faulty = reflectance.faults().count();
                    reflectance.add(stream, &leaving.flux);
                    let sound = reflectance.faults().count() == faulty;
                    if let Some((row, column)) = local.filter(|_| sound).and_then(|d| self.cell(d)) {
                        let at = (row * self.phi_deg.len() + column) * bands;
                        cells[at..][..bands].iter_mut().zip(&leaving.flux).for_each(|(c, f)| *c += f);
                    }
                }
                for (index, cell) in cells.iter_mut().enumerate() {
                    *cell /= self.projected(index / (self.phi_deg.len() * bands));
                }
                // The cell about the normal stands for all azimuths.
                for column in 1..self.phi_deg.len() {
                    cells.copy_within(..bands, column * bands);
                }
                (Replicate::from_parts(cells, per_replicate, *reflectance.faults()), reflectance)
            })
            .collect();
        let (cells, reflectance) = parts.into_iter().unzip();
        Lobe { incident_deg, values: Estimate::new(cells).bands(), reflectance: Estimate::new(reflectance) }
    }
}

/// The packet that leaves the scene after it met a surface.
struct Leaving {
    flux: Vec<f64>,
    direction: Option<DVec3>,
}

impl Visitor for Leaving {
    fn emitted(&mut self, _flux: &[f64]) {}

    fn flight(&mut self, ray: &Ray, length: f64, flux: &[f64]) {
        if length.is_infinite() {
            self.flux.copy_from_slice(flux);
            self.direction = Some(ray.direction);
        }
    }

    fn met(&mut self, _surface: usize, _before: &[f64], _after: &[f64]) {}
}

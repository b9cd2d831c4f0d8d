//! Pairs of patches of the hemisphere on which the value is constant: the Klems bases of WINDOW and Radiance.
//!
//! A basis is a stack of rings in θ, each cut into equal sectors of φ of which the first is centred on φ = 0; sectors run
//! counter-clockwise as the file counts them. In the files of WINDOW the **front** is the outside of a window; directions here are
//! in the frame of the side on which light falls.
//!
//! Incident directions of a file point along the light's way, so that its φ is ours + 180° for the incident side.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::axis::zone;
use super::channels::Mix;
use super::nodes::Axis;
use super::{Channel, Entry, Error, Known};
use crate::geometry::direction::{from_angles, phi, theta};

/// A ring of equal patches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Lower bound in θ, degrees.
    pub lower_deg: f64,
    /// Upper bound in θ, degrees.
    pub upper_deg: f64,
    /// Number of patches.
    pub sectors: usize,
}

impl Ring {
    /// Projected solid angle of one of its patches in sr.
    #[must_use]
    pub fn projected_solid_angle(&self) -> f64 {
        let squared_sine = |deg: f64| deg.to_radians().sin().powi(2);
        PI * (squared_sine(self.upper_deg) - squared_sine(self.lower_deg)) / self.sectors as f64
    }
}

/// On which side of a system light falls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The outside of a window.
    Front,
    /// The room.
    Back,
}

/// A matrix over patches, reflection from one side.
#[derive(Debug, Clone, PartialEq)]
pub struct Patches {
    rings: Vec<Ring>,
    /// Index of the first patch of each ring, and one more with the number of patches.
    starts: Vec<usize>,
    channels: Vec<Channel>,
    /// Row by row: one row per outgoing patch, one column per incident patch, the channels side by side.
    values: Vec<f64>,
}

impl Patches {
    /// A matrix in 1/sr: one row per outgoing patch, one column per incident patch, the channels of an element side by side.
    ///
    /// # Errors
    /// [`Error`] for rings that do not follow one another and other numbers of values.
    pub fn new(rings: Vec<Ring>, channels: Vec<Channel>, values: Vec<f64>) -> Result<Self, Error> {
        for (i, ring) in rings.iter().enumerate() {
            let below = if i == 0 { 0.0 } else { rings[i - 1].upper_deg };
            if (ring.lower_deg - below).abs() > 1e-6 || ring.upper_deg <= ring.lower_deg || ring.sectors == 0 {
                return Err(Error::Axis { axis: "θ of the rings", at: i + 1 });
            }
        }
        let mut starts = vec![0];
        for ring in &rings {
            starts.push(starts[starts.len() - 1] + ring.sectors);
        }
        let patches = starts[rings.len()];
        let expected = patches * patches * channels.len();
        if values.len() != expected || expected == 0 {
            return Err(Error::Count { what: "values", found: values.len(), expected });
        }
        Ok(Self { rings, starts, channels, values })
    }

    /// What the values belong to.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The rings, from the normal outwards.
    #[must_use]
    pub fn rings(&self) -> &[Ring] {
        &self.rings
    }

    /// Number of elements, and how many are missing.
    #[must_use]
    pub fn coverage(&self) -> (usize, usize) {
        let elements = self.values.chunks_exact(self.channels.len());
        (elements.len(), elements.filter(|e| e.iter().any(|v| v.is_nan())).count())
    }

    /// The values for an outgoing and an incident patch, counted from 0 as in the file.
    #[must_use]
    pub fn element(&self, outgoing: usize, incident: usize) -> &[f64] {
        let n = self.channels.len();
        &self.values[(outgoing * self.starts[self.rings.len()] + incident) * n..][..n]
    }

    /// Writes the value at two directions.
    pub fn value(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) -> Known {
        let element = self.patch(outgoing, 0.0).zip(self.patch(incident, PI)).map(|(o, i)| self.element(o, i));
        match element {
            Some(element) if element.iter().all(|v| !v.is_nan()) => {
                values.copy_from_slice(element);
                Known::Measured
            }
            _ => {
                values.fill(f64::NAN);
                Known::Missing
            }
        }
    }

    /// Visits the pairs of patches that have values, at the patches' middles.
    pub fn entries(&self, visit: &mut dyn FnMut(&Entry<'_>)) {
        // Angles and solid angle of each patch, azimuths as the file counts them.
        let middles: Vec<(f64, f64, f64)> = (self.rings.iter())
            .flat_map(|ring| {
                let bounds = [ring.lower_deg, ring.upper_deg].map(f64::to_radians);
                // A cap is about the normal.
                let theta =
                    if ring.lower_deg <= 0.0 && ring.sectors == 1 { 0.0 } else { 0.5 * (bounds[0] + bounds[1]) };
                let turn = TAU / ring.sectors as f64;
                (0..ring.sectors).map(move |k| (theta, k as f64 * turn, zone(bounds) * turn))
            })
            .collect();
        for (index, values) in self.values.chunks_exact(self.channels.len()).enumerate() {
            let (o, i) = (middles[index / middles.len()], middles[index % middles.len()]);
            let (incident, outgoing) = (from_angles(i.0, i.1 - PI), from_angles(o.0, o.1));
            if values.iter().all(|v| !v.is_nan()) {
                visit(&Entry { incident, outgoing, measure: i.2 * o.2, values });
            }
        }
    }

    /// The patch of a direction whose azimuth counts from `zero`.
    fn patch(&self, direction: DVec3, zero: f64) -> Option<usize> {
        let theta_deg = theta(direction).to_degrees();
        let ring = self.rings.iter().position(|r| theta_deg < r.upper_deg)?;
        let sectors = self.rings[ring].sectors;
        let turns = ((phi(direction) + zero) / TAU + 0.5 / sectors as f64).rem_euclid(1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the number of sectors")]
        let sector = ((turns * sectors as f64) as usize).min(sectors - 1);
        Some(self.starts[ring] + sector)
    }

    /// Directional-hemispherical reflectance of an incident patch per channel: Σ f Ω⊥ over the outgoing patches.
    #[must_use]
    pub fn reflectance(&self, incident: usize) -> Vec<f64> {
        let mut sums = vec![0.0; self.channels.len()];
        for (ring, start) in self.rings.iter().zip(&self.starts) {
            for patch in *start..start + ring.sectors {
                let element = self.element(patch, incident);
                sums.iter_mut().zip(element).for_each(|(s, v)| *s += v * ring.projected_solid_angle());
            }
        }
        sums
    }

    /// Writes the same for a direction; false, and nothing written, where none of the patches holds it or values are missing.
    pub(super) fn directional(&self, incident: DVec3, reflectance: &mut [f64]) -> bool {
        let Some(patch) = self.patch(incident, PI).filter(|_| incident.z > 0.0) else { return false };
        let sums = self.reflectance(patch);
        if sums.iter().any(|s| s.is_nan()) {
            return false;
        }
        reflectance.copy_from_slice(&sums);
        true
    }

    /// The same places with other channels.
    pub(super) fn mixed(&self, mix: &Mix) -> Self {
        Self { channels: mix.channels.clone(), values: mix.interleaved(&self.values), ..self.clone() }
    }

    pub(super) fn axes(&self) -> Vec<Axis> {
        let patches = self.starts[self.rings.len()];
        let last = self.rings.last().map_or(0.0, |r| r.upper_deg);
        ["incident patch", "outgoing patch"].map(|name| Axis::new(name, patches, 0.0, last)).to_vec()
    }
}

//! A grid in the angles of both directions, azimuths on closed circles: anisotropic materials as UTIA measured them.
//!
//! Linear in θ_i, φ_i, θ_o and φ_o. Beyond the last θ the value of the last is taken, and is inferred.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::axis::{self, Place, cell, check, locate_on_circle, zone};
use super::channels::Mix;
use super::nodes::Axis;
use super::{Channel, Entry, Error, Known, blend};
use crate::geometry::direction::{from_angles, phi, theta};

/// A table over (θ_i, φ_i, θ_o, φ_o).
#[derive(Debug, Clone, PartialEq)]
pub struct Angular {
    thetas_rad: Vec<f64>,
    azimuths: usize,
    channels: Vec<Channel>,
    /// φ_o fastest, then θ_o, φ_i, θ_i; the channels of a node side by side. NaN where missing.
    values: Vec<f64>,
}

impl Angular {
    /// A table over the same angles on both sides: θ as given (in radians, rising), `azimuths` of them at equal steps from 0.
    /// Values in 1/sr, NaN where missing, φ_o fastest, then θ_o, φ_i, θ_i; the channels of a node side by side.
    ///
    /// # Errors
    /// [`Error`] for angles that do not rise and other numbers of values.
    pub fn new(thetas_rad: Vec<f64>, azimuths: usize, channels: Vec<Channel>, values: Vec<f64>) -> Result<Self, Error> {
        check("θ", &thetas_rad)?;
        let expected = (thetas_rad.len() * azimuths).pow(2) * channels.len();
        if values.len() != expected || expected == 0 {
            return Err(Error::Count { what: "values", found: values.len(), expected });
        }
        Ok(Self { thetas_rad, azimuths, channels, values })
    }

    /// What the values of a node belong to.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Number of nodes, and how many are missing.
    #[must_use]
    pub fn coverage(&self) -> (usize, usize) {
        let nodes = self.values.chunks_exact(self.channels.len());
        (nodes.len(), nodes.filter(|n| n.iter().any(|v| v.is_nan())).count())
    }

    /// Writes the value at two directions.
    pub fn value(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) -> Known {
        let polar = |d: DVec3| axis::locate(&self.thetas_rad, theta(d));
        let azimuth = |d: DVec3| locate_on_circle(self.azimuths, TAU, phi(d));
        let places = [polar(incident), azimuth(incident), polar(outgoing), azimuth(outgoing)];
        let known = blend((0..16).map(|corner| self.node(&places, corner)), values);
        if places.iter().any(|p| p.outside) { known.max(Known::Inferred) } else { known }
    }

    /// Visits the nodes above the horizon that have values.
    pub fn entries(&self, visit: &mut dyn FnMut(&Entry<'_>)) {
        let zones: Vec<f64> =
            (0..self.thetas_rad.len()).map(|i| zone(cell(&self.thetas_rad, i, 0.0, FRAC_PI_2))).collect();
        let (polar, around) = (self.thetas_rad.len(), self.azimuths);
        let direction = |t: usize, p: usize| from_angles(self.thetas_rad[t], p as f64 / around as f64 * TAU);
        for (index, values) in self.values.chunks_exact(self.channels.len()).enumerate() {
            let (o, i) = (index % (polar * around), index / (polar * around));
            let [incident, outgoing] = [i, o].map(|n| direction(n / around, n % around));
            if incident.z > 0.0 && outgoing.z > 0.0 && values.iter().all(|v| !v.is_nan()) {
                visit(&Entry { incident, outgoing, measure: zones[i / around] * zones[o / around], values });
            }
        }
    }

    /// Weight and values of one of the sixteen nodes around a place.
    fn node(&self, places: &[Place; 4], corner: usize) -> (f64, &[f64]) {
        let counts = [self.thetas_rad.len(), self.azimuths, self.thetas_rad.len(), self.azimuths];
        let (mut index, mut weight) = (0, 1.0);
        for (k, (place, count)) in places.iter().zip(counts).enumerate() {
            let side = corner >> k & 1;
            index = index * count + place.nodes[side];
            weight *= place.weights[side];
        }
        let n = self.channels.len();
        (weight, &self.values[index * n..][..n])
    }

    /// The same places with other channels.
    pub(super) fn mixed(&self, mix: &Mix) -> Self {
        Self { channels: mix.channels.clone(), values: mix.interleaved(&self.values), ..self.clone() }
    }

    pub(super) fn axes(&self) -> Vec<Axis> {
        let thetas_deg: Vec<f64> = self.thetas_rad.iter().map(|t| t.to_degrees()).collect();
        let last = 360.0 * (self.azimuths - 1) as f64 / self.azimuths as f64;
        let polar = |name| Axis::of(name, &thetas_deg);
        let azimuth = |name| Axis::new(name, self.azimuths, 0.0, last);
        vec![polar("θ_i"), azimuth("φ_i"), polar("θ_o"), azimuth("φ_o")]
    }
}

//! A grid about the mirror direction: what Zemax and ASAP take of instruments that see the whole hemisphere at once.
//!
//! Nodes: rotation of the sample, θ_i, azimuth α and angle β about the mirror direction of the light. α = 0 points from the mirror
//! direction towards the normal (and over it), α = 180° away from it, to the horizon.
//!
//! ```text
//! ω_o = sinβ cosα t + sinβ sinα b + cosβ r      r mirror direction, t = towards the normal, b = r × t
//! ```
//!
//! Linear in θ_i, α and β. The tables hold zeros where (α, β) lies below the horizon; those nodes are missing, not black, and do
//! not take part: a place near the rim takes what its measured neighbours have, and is inferred. So is a place beyond the last β.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::axis::{Place, cell, check, locate, zone};
use super::channels::Mix;
use super::nodes::Axis;
use super::{Channel, Entry, Error, Known, blend};
use crate::geometry::direction::{phi, theta};

/// A table over (rotation, θ_i, α, β).
#[derive(Debug, Clone, PartialEq)]
pub struct Specular {
    rotations_deg: Vec<f64>,
    incidences_deg: Vec<f64>,
    azimuths_deg: Vec<f64>,
    radials_deg: Vec<f64>,
    channels: Vec<Channel>,
    /// β fastest, then α, θ_i, rotation; the channels of a node side by side. NaN where missing.
    values: Vec<f64>,
}

/// How an integral treats the rim of a table: what lies near the horizon, which no instrument sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rim {
    /// The numbers of the file as they stand, zeros included; nothing comes from beyond the last β. The least there can be.
    Cut,
    /// The numbers of the file as they stand, zeros included; beyond the last β its values go on.
    Extrapolated,
    /// What [`Specular::value`] gives: measured neighbours go on to the horizon, in the place of zeros and beyond the last β.
    Filled,
}

impl Specular {
    /// A table with angles in degrees, all rising. Values in 1/sr, NaN where missing, β fastest, then α, θ_i, rotation; the channels
    /// of a node side by side. Azimuths that end at 180° stand for both sides of the plane of incidence.
    ///
    /// # Errors
    /// [`Error`] for angles that do not rise or are out of range, and other numbers of values.
    pub fn new(angles_deg: [Vec<f64>; 4], channels: Vec<Channel>, values: Vec<f64>) -> Result<Self, Error> {
        let [rotations_deg, incidences_deg, azimuths_deg, radials_deg] = angles_deg;
        check("the rotations", &rotations_deg)?;
        check("the angles of incidence", &incidences_deg)?;
        check("the azimuths", &azimuths_deg)?;
        check("the radial angles", &radials_deg)?;
        let within = |what, nodes: &[f64], most: f64, expected| {
            nodes
                .iter()
                .find(|v| !(0.0..=most).contains(*v))
                .map_or(Ok(()), |&value| Err(Error::Range { what, value, expected }))
        };
        within("an angle of incidence", &incidences_deg, 90.0, "0 to 90°")?;
        within("an azimuth", &azimuths_deg, 360.0, "0 to 360°")?;
        within("a radial angle", &radials_deg, 180.0, "0 to 180°")?;
        let nodes = rotations_deg.len() * incidences_deg.len() * azimuths_deg.len() * radials_deg.len();
        let expected = nodes * channels.len();
        if values.len() != expected || expected == 0 {
            return Err(Error::Count { what: "values", found: values.len(), expected });
        }
        let mut table = Self { rotations_deg, incidences_deg, azimuths_deg, radials_deg, channels, values };
        table.mark_below_horizon();
        Ok(table)
    }

    /// Zeros below the horizon are no measurements.
    fn mark_below_horizon(&mut self) {
        let n = self.channels.len();
        let [incidences, azimuths, radials] =
            [self.incidences_deg.len(), self.azimuths_deg.len(), self.radials_deg.len()];
        for (index, node) in self.values.chunks_exact_mut(n).enumerate() {
            let radial = self.radials_deg[index % radials].to_radians();
            let azimuth = self.azimuths_deg[index / radials % azimuths].to_radians();
            let incidence = self.incidences_deg[index / (radials * azimuths) % incidences].to_radians();
            let height = incidence.cos() * radial.cos() + incidence.sin() * radial.sin() * azimuth.cos();
            // Instruments see nothing within some degrees of the horizon either: a zero there is no data.
            if height < NEAR_HORIZON && node.iter().all(|v| *v == 0.0) {
                node.fill(f64::NAN);
            }
        }
    }

    /// What the values of a node belong to.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The angles of incidence in degrees.
    #[must_use]
    pub fn incidences_deg(&self) -> &[f64] {
        &self.incidences_deg
    }

    /// The rotations of the sample in degrees.
    #[must_use]
    pub fn rotations_deg(&self) -> &[f64] {
        &self.rotations_deg
    }

    /// Whether the sample was never turned.
    #[must_use]
    pub fn is_isotropic(&self) -> bool {
        self.rotations_deg.len() == 1
    }

    /// Number of nodes, and how many are missing.
    #[must_use]
    pub fn coverage(&self) -> (usize, usize) {
        let nodes = self.values.chunks_exact(self.channels.len());
        (nodes.len(), nodes.filter(|n| n.iter().any(|v| v.is_nan())).count())
    }

    /// Writes the value at two directions.
    pub fn value(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) -> Known {
        let mut places = self.places(incident, outgoing);
        let mut known = blend((0..16).map(|corner| self.node(&places, corner)), values);
        // All around it without data: the next node towards the mirror direction that has some.
        while let (Known::Missing, inner @ 1..) = (known, places[3].nodes[0]) {
            places[3] = Place { nodes: [inner - 1; 2], weights: [1.0, 0.0], outside: true };
            known = blend((0..16).map(|corner| self.node(&places, corner)), values);
        }
        if places.iter().any(|p| p.outside) { known.max(Known::Inferred) } else { known }
    }

    /// Visits the nodes above the horizon that have values.
    pub fn entries(&self, visit: &mut dyn FnMut(&Entry<'_>)) {
        let [incidences, azimuths, radials] =
            [self.incidences_deg.len(), self.azimuths_deg.len(), self.radials_deg.len()];
        let around = if self.azimuths_deg[azimuths - 1] <= 180.0 { 180.0 } else { 360.0 };
        let zone_of = |nodes: &[f64], i: usize, high: f64| zone(cell(nodes, i, 0.0, high).map(f64::to_radians));
        for (index, values) in self.values.chunks_exact(self.channels.len()).enumerate() {
            let (radial, azimuth) = (index % radials, index / radials % azimuths);
            let (incidence, rotation) =
                (index / (radials * azimuths) % incidences, index / (radials * azimuths * incidences));
            let (sin_i, cos_i) = self.incidences_deg[incidence].to_radians().sin_cos();
            let (sin_r, cos_r) = self.rotations_deg[rotation].to_radians().sin_cos();
            let incident = DVec3::new(sin_i * cos_r, sin_i * sin_r, cos_i);
            let mirror = DVec3::new(-incident.x, -incident.y, incident.z);
            let towards = DVec3::new(cos_i * cos_r, cos_i * sin_r, sin_i);
            let (sin_a, cos_a) = self.azimuths_deg[azimuth].to_radians().sin_cos();
            let (sin_b, cos_b) = self.radials_deg[radial].to_radians().sin_cos();
            let outgoing = sin_b * (cos_a * towards + sin_a * mirror.cross(towards)) + cos_b * mirror;
            if incident.z > 0.0 && outgoing.z > 0.0 && values.iter().all(|v| !v.is_nan()) {
                let [first, last] = cell(&self.azimuths_deg, azimuth, 0.0, around);
                let measure = zone_of(&self.incidences_deg, incidence, 90.0)
                    * zone_of(&self.radials_deg, radial, 180.0)
                    * (last - first);
                visit(&Entry { incident, outgoing, measure, values });
            }
        }
    }

    /// Share of the weight around a place that nodes with data have.
    fn held(&self, incident: DVec3, outgoing: DVec3) -> f64 {
        let places = self.places(incident, outgoing);
        let nodes = (0..16).map(|corner| self.node(&places, corner));
        nodes.filter(|(_, node)| node.iter().all(|v| !v.is_nan())).map(|(weight, _)| weight).sum()
    }

    /// Where two directions lie on the four axes.
    fn places(&self, incident: DVec3, outgoing: DVec3) -> [Place; 4] {
        // The frame of the mirror direction; along the normal the incident azimuth decides what α = 0 is.
        let azimuth = phi(incident);
        let [mirror, towards, across] = mirror_frame(incident, azimuth);
        let (x, y, z) = (outgoing.dot(towards), outgoing.dot(across), outgoing.dot(mirror));
        let (radial, mut alpha) = (x.hypot(y).atan2(z).to_degrees(), y.atan2(x).to_degrees());
        if self.azimuths_deg[self.azimuths_deg.len() - 1] <= 180.0 {
            alpha = alpha.abs();
        } else if alpha < 0.0 {
            alpha += 360.0;
        }
        let on = |nodes: &[f64], angle: f64| if nodes.len() == 1 { Place::ONLY } else { locate(nodes, angle) };
        [
            on(&self.rotations_deg, azimuth.to_degrees()),
            locate(&self.incidences_deg, theta(incident).to_degrees()),
            on(&self.azimuths_deg, alpha),
            locate(&self.radials_deg, radial),
        ]
    }

    /// Weight and values of one of the sixteen nodes around a place.
    fn node(&self, places: &[Place; 4], corner: usize) -> (f64, &[f64]) {
        let counts =
            [self.rotations_deg.len(), self.incidences_deg.len(), self.azimuths_deg.len(), self.radials_deg.len()];
        let (mut index, mut weight) = (0, 1.0);
        for (k, (place, count)) in places.iter().zip(counts).enumerate() {
            let side = corner >> k & 1;
            index = index * count + place.nodes[side];
            weight *= place.weights[side];
        }
        let n = self.channels.len();
        (weight, &self.values[index * n..][..n])
    }

    /// Total integrated scatter at an angle of incidence: ∫ f cosθ_o dω_o per channel, in the plane of sample rotation 0.
    ///
    /// A midpoint rule over (α, β) in cells of 0.5° × 0.5°: the interpolated table is piecewise linear, and the rule's own error stays
    /// below 3e-4 of the result.
    #[must_use]
    pub fn scatter(&self, incidence_deg: f64, rim: Rim) -> Vec<f64> {
        const STEP: f64 = PI / 360.0;
        let (sin_i, cos_i) = incidence_deg.to_radians().sin_cos();
        let rotation = self.rotations_deg[0].to_radians();
        let incident = DVec3::new(sin_i * rotation.cos(), sin_i * rotation.sin(), cos_i);
        let [mirror, towards, across] = mirror_frame(incident, rotation);
        let last = match rim {
            Rim::Cut => self.radials_deg[self.radials_deg.len() - 1].to_radians(),
            Rim::Extrapolated | Rim::Filled => FRAC_PI_2 + incidence_deg.to_radians(),
        };
        // One side stands for both where the table has no other.
        let (turn, sides) =
            if self.azimuths_deg[self.azimuths_deg.len() - 1] <= 180.0 { (PI, 2.0) } else { (TAU, 1.0) };
        let mut sums = vec![0.0; self.channels.len()];
        let mut values = sums.clone();
        for i in 0..(last / STEP).round().max(0.0) as usize {
            let (sin, cos) = ((i as f64 + 0.5) * STEP).sin_cos();
            for j in 0..(turn / STEP).round() as usize {
                let (sin_a, cos_a) = ((j as f64 + 0.5) * STEP).sin_cos();
                let outgoing = sin * (cos_a * towards + sin_a * across) + cos * mirror;
                if outgoing.z <= 0.0 || self.value(incident, outgoing, &mut values) == Known::Missing {
                    continue;
                }
                // A node without data is a zero of the file: it has the rest of the weight.
                let share = if rim == Rim::Filled { 1.0 } else { self.held(incident, outgoing) };
                let weight = sides * share * outgoing.z * sin * STEP * STEP;
                sums.iter_mut().zip(&values).for_each(|(s, v)| *s += v * weight);
            }
        }
        sums
    }

    /// The same places with other channels.
    pub(super) fn mixed(&self, mix: &Mix) -> Self {
        Self { channels: mix.channels.clone(), values: mix.interleaved(&self.values), ..self.clone() }
    }

    pub(super) fn axes(&self) -> Vec<Axis> {
        vec![
            Axis::of("rotation", &self.rotations_deg),
            Axis::of("θ_i", &self.incidences_deg),
            Axis::of("α", &self.azimuths_deg),
            Axis::of("β", &self.radials_deg),
        ]
    }
}

/// The mirror direction, the direction from it towards the normal, and the one across.
fn mirror_frame(incident: DVec3, azimuth: f64) -> [DVec3; 3] {
    let (sin, cos) = azimuth.sin_cos();
    let mirror = DVec3::new(-incident.x, -incident.y, incident.z);
    let towards = DVec3::new(incident.z * cos, incident.z * sin, incident.x.hypot(incident.y));
    [mirror, towards, mirror.cross(towards)]
}

/// Cosine of the angle to the normal (80°) beyond which a zero is taken for a place that the instrument could not see.
const NEAR_HORIZON: f64 = 0.173_648_177_666_930_33;

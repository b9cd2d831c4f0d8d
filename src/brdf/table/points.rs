//! Scattered points: values at pairs of directions in no order.
//!
//! Distances between pairs are taken between their unit vectors (turned to φ_i = 0 where the table is isotropic), so that nothing
//! happens at poles or at 0/360°; in one- and two-dimensional tables between θ_h and θ_d. Between points the value is the mean
//! of the nearest four with weights 1/distance²; at a point (nearer than 1e-9) its own. Places further from every point than
//! twice the usual distance between neighbours (the median) are inferred.
//!
//! An isotropic table that was measured on one side of the plane of incidence alone is mirrored at it.

use glam::DVec3;

use super::channels::Mix;
use super::kd_tree::{KdTree, Key};
use super::{Channel, Entry, Error, Known};
use crate::brdf::coordinates::{HalfDiff, Parameterisation};
use crate::geometry::direction::{phi, theta};

/// What is nearer is the same place: rounding of angles that were written with ten digits.
const SAME: f64 = 1e-9;
/// More directions of incidence than an instrument is set to by hand or motor, one by one.
const FEW: usize = 64;

/// A table of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    parameterisation: Parameterisation,
    channels: Vec<Channel>,
    directions: Vec<(DVec3, DVec3)>,
    /// Point by point.
    values: Vec<f64>,
    tree: KdTree,
    mirrored: bool,
    reach: f64,
}

impl Points {
    /// A table of points: pairs of unit vectors, ω_i first, and the values of each in 1/sr, the channels of a point side by side.
    ///
    /// # Errors
    /// [`Error::Count`] for no points or another number of values, [`Error::Range`] for a value that is not finite.
    pub fn new(
        parameterisation: Parameterisation,
        channels: Vec<Channel>,
        directions: Vec<(DVec3, DVec3)>,
        values: Vec<f64>,
    ) -> Result<Self, Error> {
        let expected = directions.len() * channels.len();
        if values.len() != expected || expected == 0 {
            return Err(Error::Count { what: "values", found: values.len(), expected: expected.max(1) });
        }
        if let Some(&value) = values.iter().find(|v| !v.is_finite()) {
            return Err(Error::Range { what: "a value", value, expected: "a finite number" });
        }
        let finite = |(i, o): &(DVec3, DVec3)| i.is_finite() && o.is_finite();
        if !directions.iter().all(finite) {
            return Err(Error::Range { what: "a direction", value: f64::NAN, expected: "finite angles" });
        }
        let sides = |sign: f64| directions.iter().any(|&(i, o)| sign * side(i, o) > SAME);
        let mirrored = parameterisation.is_isotropic() && !(sides(1.0) && sides(-1.0));
        let keys: Vec<Key> = directions.iter().map(|&(i, o)| key(parameterisation, mirrored, i, o)).collect();
        let tree = KdTree::new(keys);
        let mut table = Self { parameterisation, channels, directions, values, tree, mirrored, reach: 0.0 };
        table.reach = 2.0 * table.usual_distance();
        Ok(table)
    }

    /// Median distance of a point to the nearest other one, from at most a thousand points.
    fn usual_distance(&self) -> f64 {
        let step = self.len().div_ceil(1000);
        let to_next = |&(i, o): &(DVec3, DVec3)| {
            let near = self.tree.nearest::<8>(&self.key(i, o));
            near.entries().iter().map(|e| e.0.sqrt()).find(|d| *d > SAME)
        };
        let mut distances: Vec<f64> = self.directions.iter().step_by(step).filter_map(to_next).collect();
        distances.sort_by(f64::total_cmp);
        distances.get(distances.len() / 2).copied().unwrap_or(0.0)
    }

    /// What the values of a point belong to.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The coordinates in which the points were given.
    #[must_use]
    pub fn parameterisation(&self) -> Parameterisation {
        self.parameterisation
    }

    /// Whether the sample was never turned.
    #[must_use]
    pub fn is_isotropic(&self) -> bool {
        self.parameterisation.is_isotropic()
    }

    /// Number of points, at least 1.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub fn len(&self) -> usize {
        self.directions.len()
    }

    /// The points in the order they were given: ω_i, ω_o, values.
    pub fn iter(&self) -> impl Iterator<Item = (DVec3, DVec3, &[f64])> {
        let values = self.values.chunks_exact(self.channels.len());
        self.directions.iter().zip(values).map(|(&(i, o), v)| (i, o, v))
    }

    /// Visits the points above the horizon.
    pub fn entries(&self, visit: &mut dyn FnMut(&Entry<'_>)) {
        for (incident, outgoing, values) in self.iter().filter(|(i, o, _)| i.z > 0.0 && o.z > 0.0) {
            visit(&Entry { incident, outgoing, measure: 1.0, values });
        }
    }

    /// `[θ_i, φ_i]` in degrees of the points, φ_i being 0 in an isotropic table; `None` where they are many, as in coordinates of the half
    /// vector.
    pub(super) fn incidences_deg(&self) -> Option<Vec<[f64; 2]>> {
        use Parameterisation::{Cartesian, LightViewProjected, Spherical, ViewLightAzimuth};
        if !matches!(self.parameterisation, ViewLightAzimuth | LightViewProjected | Spherical | Cartesian) {
            return None;
        }
        let rounded = |rad: f64| (rad.to_degrees() * 1e6).round() / 1e6;
        let mut found: Vec<[f64; 2]> = Vec::new();
        for (incident, _) in self.directions.iter().filter(|(i, o)| i.z > 0.0 && o.z > 0.0) {
            let lit = [rounded(theta(*incident)), if self.is_isotropic() { 0.0 } else { rounded(phi(*incident)) }];
            if !found.contains(&lit) {
                if found.len() == FEW {
                    return None;
                }
                found.push(lit);
            }
        }
        found.sort_by(|a, b| a[1].total_cmp(&b[1]).then(a[0].total_cmp(&b[0])));
        (!found.is_empty()).then_some(found)
    }

    /// Writes the value at two directions.
    pub fn value(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) -> Known {
        let n = self.channels.len();
        let near = self.tree.nearest::<4>(&self.key(incident, outgoing));
        let at = |index: u32| &self.values[index as usize * n..][..n];
        let nearest = near.entries().first().map_or(f64::INFINITY, |e| e.0.sqrt());
        let known = if nearest <= self.reach.max(SAME) { Known::Measured } else { Known::Inferred };
        if nearest <= SAME {
            values.copy_from_slice(at(near.entries()[0].1));
            return known;
        }
        values.fill(0.0);
        let mut sum = 0.0;
        for &(squared, index) in near.entries() {
            sum += 1.0 / squared;
            values.iter_mut().zip(at(index)).for_each(|(v, p)| *v += p / squared);
        }
        values.iter_mut().for_each(|v| *v /= sum);
        known
    }

    fn key(&self, incident: DVec3, outgoing: DVec3) -> Key {
        key(self.parameterisation, self.mirrored, incident, outgoing)
    }

    /// The same places with other channels.
    pub(super) fn mixed(&self, mix: &Mix) -> Self {
        Self { channels: mix.channels.clone(), values: mix.interleaved(&self.values), ..self.clone() }
    }
}

/// On which side of the plane of incidence ω_o lies: sinθ_i sinθ_o sin(φ_o − φ_i).
fn side(incident: DVec3, outgoing: DVec3) -> f64 {
    incident.x * outgoing.y - incident.y * outgoing.x
}

fn key(parameterisation: Parameterisation, mirrored: bool, incident: DVec3, outgoing: DVec3) -> Key {
    match parameterisation {
        Parameterisation::CosHalf | Parameterisation::Half => {
            [HalfDiff::new(incident, outgoing).theta_h, 0.0, 0.0, 0.0, 0.0, 0.0]
        }
        Parameterisation::HalfDifference => {
            let a = HalfDiff::new(incident, outgoing);
            [a.theta_h, a.theta_d, 0.0, 0.0, 0.0, 0.0]
        }
        p if p.is_isotropic() => {
            let across = incident.x.hypot(incident.y);
            // Along the normal every azimuth is as good: the outgoing one is 0 then, as the incident one.
            let (x, y) = if across > 0.0 {
                let along = (incident.x * outgoing.x + incident.y * outgoing.y) / across;
                (along, side(incident, outgoing) / across)
            } else {
                (outgoing.x.hypot(outgoing.y), 0.0)
            };
            [x, if mirrored { y.abs() } else { y }, outgoing.z, across, incident.z, 0.0]
        }
        _ => [outgoing.x, outgoing.y, outgoing.z, incident.x, incident.y, incident.z],
    }
}

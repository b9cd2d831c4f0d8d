//! A table with a sampler made for it.
//!
//! Directions are drawn from three densities, chosen with probabilities that follow the light in each:
//!
//! ```text
//! cosθ_i / π                                 the diffuse floor: the quarter of all values below which the table seldom is
//! p_m(θ_h) / (4 ω_o·h)                       about the mirror direction, by the angle of the half vector to the normal
//! p_r(γ)                                     back to where the light came from, by the angle γ between ω_i and ω_o
//! ```
//!
//! p_m and p_r are constant on 90 rings of angle ((k … k+1)/90)² · 90° and follow what the table reflects above the floor, averaged
//! over angles and bands. The cosine keeps at least 15 %, so that f cosθ_i / pdf is at most f π/0.15 wherever the table is.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use glam::DVec3;

use super::Table;
use crate::brdf::{Brdf, Sampled, mean, reflected, sample_by};
use crate::geometry::direction::{from_degrees, mirror, tangents};
use crate::math::sampling::{self, split};

/// Rings of a density.
const RINGS: usize = 90;
/// Directions on a ring at which the table is asked.
const AROUND: u32 = 16;
/// Angles of ω_o at which it is.
const OUTGOING_DEG: [f64; 5] = [5.0, 25.0, 45.0, 60.0, 75.0];
/// Least probability of the cosine.
const LEAST_COSINE: f64 = 0.15;

/// A measured table that draws directions as it reflects them.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledTable {
    table: Arc<Table>,
    mirrored: Rings,
    back: Rings,
    /// Probability of the cosine, and of the mirror lobe among the rest.
    cosine: f64,
    mirror: f64,
}

impl SampledTable {
    /// Asks the table at some ten thousand pairs of directions.
    #[must_use]
    pub fn new(table: impl Into<Arc<Table>>) -> Self {
        let table: Arc<Table> = table.into();
        let azimuths: &[f64] = if table.is_isotropic() { &[0.0] } else { &[0.0, 45.0, 90.0, 135.0] };
        let (mut mirrored, mut back) = ([0.0; RINGS], [0.0; RINGS]);
        let (rings, mut diffuse) = (Rings::empty(), 0.0);
        let mut values = vec![0.0; table.channels().len()];
        let mut value = |i: DVec3, o: DVec3| {
            table.evaluate(i, o, &mut values);
            mean(&values).max(0.0)
        };
        for (theta, phi) in OUTGOING_DEG.iter().flat_map(|t| azimuths.iter().map(move |p| (*t, *p))) {
            let outgoing = from_degrees(theta, phi);
            let floor = floor(outgoing, &mut value);
            diffuse += PI * floor;
            for ring in 0..RINGS {
                for around in 0..AROUND {
                    let azimuth = (f64::from(around) + 0.5) / f64::from(AROUND);
                    let share = rings.solid_angle(ring) / f64::from(AROUND);
                    let direction = rings.direction(ring, 0.5, azimuth);
                    if let Some(i) = reflected(outgoing, direction).filter(|i| i.z > 0.0 && is_mirrored(*i, outgoing)) {
                        let jacobian = 4.0 * outgoing.dot(direction);
                        mirrored[ring] += (value(i, outgoing) - floor).max(0.0) * i.z * jacobian * share;
                    }
                    let i = about(outgoing, direction);
                    if i.z > 0.0 && !is_mirrored(i, outgoing) {
                        back[ring] += (value(i, outgoing) - floor).max(0.0) * i.z * share;
                    }
                }
            }
        }
        let [m, b] = [mirrored, back].map(|lobe| lobe.iter().sum::<f64>());
        let cosine = if diffuse + m + b > 0.0 { diffuse / (diffuse + m + b) } else { 1.0 };
        Self {
            table,
            mirrored: rings.clone().filled(mirrored),
            back: rings.filled(back),
            cosine: LEAST_COSINE + (1.0 - LEAST_COSINE) * cosine,
            mirror: if m + b > 0.0 { m / (m + b) } else { 1.0 },
        }
    }

    /// The table.
    #[must_use]
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// Draws ω_i for a given ω_o above the horizon from three uniform numbers as [`Brdf::sample`] does, and asks the table nothing; it may be
    /// below the horizon, where [`Brdf::pdf`] is 0.
    pub(crate) fn draw(&self, outgoing: DVec3, u: [f64; 3]) -> Option<DVec3> {
        let (cosine, rest) = split(u[0], self.cosine);
        if cosine {
            Some(sampling::cosine_hemisphere([u[1], u[2]]))
        } else if split(rest, self.mirror).0 {
            reflected(outgoing, self.mirrored.draw([u[1], u[2]]))
        } else {
            Some(about(outgoing, self.back.draw([u[1], u[2]])))
        }
    }
}

/// The first quartile of the values at directions spread by the cosine.
fn floor(outgoing: DVec3, value: &mut impl FnMut(DVec3, DVec3) -> f64) -> f64 {
    let place = |n: u32| (f64::from(n) + 0.5) / 12.0;
    let mut values: Vec<f64> =
        (0..144).map(|n| value(sampling::cosine_hemisphere([place(n % 12), place(n / 12)]), outgoing)).collect();
    values.sort_by(f64::total_cmp);
    values[36]
}

/// Whether a direction is nearer to the mirror direction than to ω_o itself.
fn is_mirrored(incident: DVec3, outgoing: DVec3) -> bool {
    incident.dot(mirror(outgoing)) >= incident.dot(outgoing)
}

/// A direction given about +z, turned about an axis.
fn about(axis: DVec3, direction: DVec3) -> DVec3 {
    let (t, b) = tangents(axis);
    t * direction.x + b * direction.y + axis * direction.z
}

/// A density of directions about an axis, constant on rings.
#[derive(Debug, Clone, PartialEq)]
struct Rings {
    /// 1 − cos of the borders, which keeps its digits at the axis.
    borders: [f64; RINGS + 1],
    /// Probability cumulated to the upper border of each ring.
    upto: [f64; RINGS],
}

impl Rings {
    /// Rings of nothing yet.
    fn empty() -> Self {
        let border = |k: usize| 2.0 * (0.5 * (k as f64 / RINGS as f64).powi(2) * FRAC_PI_2).sin().powi(2);
        Self { borders: std::array::from_fn(border), upto: [1.0; RINGS] }
    }

    /// The same rings with amounts; those of nothing are never drawn.
    fn filled(mut self, amounts: [f64; RINGS]) -> Self {
        let total: f64 = amounts.iter().sum();
        let mut sum = 0.0;
        self.upto = amounts.map(|a| {
            sum += a;
            if total > 0.0 { sum / total } else { 1.0 }
        });
        self
    }

    fn solid_angle(&self, ring: usize) -> f64 {
        TAU * (self.borders[ring + 1] - self.borders[ring])
    }

    /// A direction of a ring, about +z.
    fn direction(&self, ring: usize, across: f64, around: f64) -> DVec3 {
        let versine = self.borders[ring] + across * (self.borders[ring + 1] - self.borders[ring]);
        let sin = (versine * (2.0 - versine)).sqrt();
        let (y, x) = (TAU * around).sin_cos();
        DVec3::new(sin * x, sin * y, 1.0 - versine)
    }

    /// Probability of a ring, and of those below it.
    fn share(&self, ring: usize) -> (f64, f64) {
        let below = if ring == 0 { 0.0 } else { self.upto[ring - 1] };
        (self.upto[ring] - below, below)
    }

    fn draw(&self, [u, v]: [f64; 2]) -> DVec3 {
        let ring = self.upto.partition_point(|p| *p <= u).min(RINGS - 1);
        let (share, below) = self.share(ring);
        let across = if share > 0.0 { ((u - below) / share).clamp(0.0, 1.0) } else { 0.5 };
        self.direction(ring, across, v)
    }

    /// Density in 1/sr of a unit vector about an axis.
    fn density(&self, direction: DVec3, axis: DVec3) -> f64 {
        let versine = 0.5 * (direction - axis).length_squared();
        match self.borders.partition_point(|b| *b <= versine) {
            0 => 0.0,
            above if above > RINGS => 0.0,
            above => self.share(above - 1).0 / self.solid_angle(above - 1),
        }
    }
}

impl Brdf for SampledTable {
    fn bands(&self) -> usize {
        self.table.bands()
    }

    fn is_isotropic(&self) -> bool {
        self.table.is_isotropic()
    }

    fn is_tabulated(&self) -> bool {
        true
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        self.table.evaluate(incident, outgoing, values);
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        let incident = self.draw(outgoing, u)?;
        sample_by(self, outgoing, incident, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        if outgoing.z <= 0.0 || incident.z <= 0.0 {
            return 0.0;
        }
        let half = (incident + outgoing).normalize();
        let mirrored = self.mirrored.density(half, DVec3::Z) / (4.0 * outgoing.dot(half));
        let back = self.back.density(incident, outgoing);
        let lobes = self.mirror * mirrored + (1.0 - self.mirror) * back;
        self.cosine * sampling::cosine_hemisphere_pdf(incident.z) + (1.0 - self.cosine) * lobes
    }

    fn albedo(&self, incident: DVec3, reflectance: &mut [f64]) -> f64 {
        self.table.albedo(incident, reflectance)
    }

    fn is_measured(&self, incident: DVec3, outgoing: DVec3) -> bool {
        self.table.is_measured(incident, outgoing)
    }
}

//! How much of the light from a direction a rough surface returns after one scattering, in a table.
//!
//! ```text
//! E(ω) = ∫ f |cosθ'| dω'       Ē = (1/π) ∫ E cosθ dω
//! ```
//!
//! The table holds 1 − E, which for smooth surfaces is small and must be right relative to itself. A node is the mean of the sampler's
//! own weights by adaptive cubature, between nodes cubic: within 5e-4 of E for roughness from 1e-4 to 1 (tests of
//! [`compensated`](super::compensated)). Nodes are even in √ln(1 + cosθ/α), as E changes where cosθ is about the roughness α, and steeply at grazing incidence. What is lost, 1 − E, is a density as well, from which directions are drawn: constant in cos²θ within an eighth of a step.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use crate::geometry::direction::from_angles;
use crate::math::cubature::{Tolerance, rectangle};

/// Steps of the table over cosθ, and over a quarter turn where the surface has a grain.
const STEPS: usize = 48;
const QUARTER: usize = 8;

/// Cells of the density per step.
const FINE: usize = 8;

/// What the cubature aims at; at grazing incidence the weights have an edge, which it would follow for long.
const TOLERANCE: Tolerance = Tolerance { absolute: 1e-7, relative: 1e-3, evaluations: 20_000 };

/// E over the hemisphere.
#[derive(Debug, Clone, PartialEq)]
pub struct Albedo {
    /// 1 − E by azimuth, then by the coordinate of cosθ.
    values: Vec<f64>,
    roughness: f64,
    quarter: usize,
    /// Running sums of 1 − E over the cells, (1/π) ∫ (1 − E) cosθ dω up to each.
    sums: Vec<f64>,
}

impl Albedo {
    /// Tabulates the mean over `u` of `weight(ω, u)`, f |cosθ'| / pdf of a direction drawn for ω by two uniform numbers.
    ///
    /// `roughness` is the cosine at which E changes; a surface with a grain is symmetrical about x and y.
    #[must_use]
    pub fn tabulate(roughness: f64, isotropic: bool, weight: impl Fn(DVec3, [f64; 2]) -> f64) -> Self {
        let quarter = if isotropic { 0 } else { QUARTER };
        let mut table = Self { values: Vec::new(), roughness, quarter, sums: Vec::new() };
        for azimuth in 0..=quarter {
            let phi = if isotropic { 0.0 } else { FRAC_PI_2 * azimuth as f64 / QUARTER as f64 };
            for step in 0..=STEPS {
                // Not the horizon itself, which some samplers know nothing of.
                let cos = table.cosine(step as f64 / STEPS as f64).clamp(1e-7, 1.0);
                let direction = from_angles(cos.acos(), phi);
                let mut mean = [0.0];
                rectangle(|u, v| v[0] = 1.0 - weight(direction, u), [0.0; 2], [1.0; 2], TOLERANCE, &mut mean);
                table.values.push(mean[0].clamp(0.0, 1.0));
            }
        }
        let mut sum = 0.0;
        for cell in 0..STEPS * FINE {
            let [low, high] = table.cell(cell);
            sum += (high - low) * table.mean_over_azimuths((cell as f64 + 0.5) / FINE as f64);
            table.sums.push(sum);
        }
        table
    }

    /// The cosine at a coordinate from 0 to 1.
    fn cosine(&self, x: f64) -> f64 {
        self.roughness * (x * x * (1.0 / self.roughness).ln_1p()).exp_m1()
    }

    /// The place of a cosine in the table, in steps.
    fn coordinate(&self, cos: f64) -> f64 {
        let cos = cos.min(1.0);
        STEPS as f64 * ((cos / self.roughness).ln_1p() / (1.0 / self.roughness).ln_1p()).sqrt()
    }

    /// 1 − E of a direction, on either side of the surface.
    #[must_use]
    pub fn lost(&self, direction: DVec3) -> f64 {
        let x = self.coordinate(direction.z.abs());
        if self.quarter == 0 {
            return self.along(0, x);
        }
        let y = QUARTER as f64 * direction.y.abs().atan2(direction.x.abs()) / FRAC_PI_2;
        // Symmetrical about both axes.
        let row = |i: isize| {
            let i = i.unsigned_abs();
            self.along(if i > QUARTER { 2 * QUARTER - i } else { i }, x)
        };
        #[expect(clippy::cast_possible_truncation, reason = "a place in the table")]
        let before = (y.floor() as isize).min(QUARTER as isize - 1);
        cubic([row(before - 1), row(before), row(before + 1), row(before + 2)], y - before as f64).clamp(0.0, 1.0)
    }

    /// Along one azimuth.
    fn along(&self, row: usize, x: f64) -> f64 {
        let row = &self.values[row * (STEPS + 1)..][..=STEPS];
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in the table")]
        let before = (x.max(0.0) as usize).min(STEPS - 1);
        let (a, b) = (row[before], row[before + 1]);
        // Straight on beyond the ends.
        let first = if before == 0 { 2.0 * a - b } else { row[before - 1] };
        let last = if before + 2 > STEPS { 2.0 * b - a } else { row[before + 2] };
        cubic([first, a, b, last], x - before as f64).clamp(0.0, 1.0)
    }

    /// 1 − Ē.
    #[must_use]
    pub fn average_lost(&self) -> f64 {
        self.sums[STEPS * FINE - 1]
    }

    /// A direction above the horizon with density [`Albedo::lost_pdf`], about (1 − E) cosθ / (π (1 − Ē)).
    #[must_use]
    pub fn sample_lost(&self, [u, v]: [f64; 2]) -> DVec3 {
        let target = u * self.average_lost();
        let cell = self.sums.partition_point(|s| *s <= target).min(STEPS * FINE - 1);
        let ([low, high], [below, above]) = (self.cell(cell), self.share(cell));
        let cos2 = low + (high - low) * ((target - below) / (above - below)).clamp(0.0, 1.0);
        let (sin, cos) = (TAU * v).sin_cos();
        let across = (1.0 - cos2).max(0.0).sqrt();
        DVec3::new(across * cos, across * sin, cos2.sqrt())
    }

    /// The density of [`Albedo::sample_lost`], 1/sr, for a direction on either side.
    #[must_use]
    pub fn lost_pdf(&self, direction: DVec3) -> f64 {
        let cos = direction.z.abs();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cell")]
        let cell = ((self.coordinate(cos) * FINE as f64) as usize).min(STEPS * FINE - 1);
        let ([low, high], [below, above]) = (self.cell(cell), self.share(cell));
        let average = self.average_lost();
        if average > 0.0 { (above - below) / (high - low) / average * cos / PI } else { 0.0 }
    }

    /// cos²θ at both ends of a cell.
    fn cell(&self, cell: usize) -> [f64; 2] {
        [cell, cell + 1].map(|c| self.cosine(c as f64 / (STEPS * FINE) as f64).powi(2))
    }

    /// The running sums at both ends of a cell.
    fn share(&self, cell: usize) -> [f64; 2] {
        [if cell == 0 { 0.0 } else { self.sums[cell - 1] }, self.sums[cell]]
    }

    /// The first and the last azimuth stand for half a step each.
    fn mean_over_azimuths(&self, x: f64) -> f64 {
        if self.quarter == 0 {
            return self.along(0, x);
        }
        let ends = 0.5 * (self.along(0, x) + self.along(self.quarter, x));
        (ends + (1..self.quarter).map(|row| self.along(row, x)).sum::<f64>()) / self.quarter as f64
    }
}

/// Catmull and Rom's cubic between the middle two of four values.
fn cubic([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    b + 0.5 * t * ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) + t * (3.0 * (b - c) + d - a)))
}

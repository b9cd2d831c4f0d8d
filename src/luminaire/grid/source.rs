//! One placed luminaire as a point calculates with it: as a point, or subdivided over its luminous opening.

use glam::{DMat3, DVec3};

use super::super::distribution::Distribution;
use super::super::luminance::projected_area_towards_m2;
use super::super::model::Body;
use super::opening::{Patch, View, largest_dimension_m, patches, touches};
use super::receiver::{Local, Receiver};
use super::{Placed, Settings};

/// How often a cell may be quartered.
const DEEPEST: u32 = 10;
/// Place of the two Gauss points in [−1, 1].
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// What one luminaire gives at one point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    pub value: f64,
    pub as_point: f64,
    /// It was subdivided.
    pub near: bool,
    /// The tolerance was met.
    pub resolved: bool,
}

/// A luminaire ready for a receiver.
#[derive(Debug)]
pub(super) struct Source<'a> {
    distribution: &'a Distribution,
    position: DVec3,
    to_local: DMat3,
    receiver: Local,
    factor: f64,
    body: Option<&'a Body>,
    patches: Vec<Patch>,
    /// Points nearer than this see an opening, others a point, m.
    near_m: f64,
    tolerance: f64,
}

impl<'a> Source<'a> {
    /// `None` where the receiver has no direction.
    pub(super) fn new(placed: &Placed<'a>, receiver: &Receiver, settings: &Settings) -> Option<Self> {
        let to_local = placed.placement.to_room().transpose();
        let body = placed.luminaire.opening.as_ref();
        let patches = body.map(patches).unwrap_or_default();
        Some(Self {
            distribution: &placed.luminaire.distribution,
            position: placed.placement.position_m(),
            to_local,
            receiver: receiver.local(to_local)?,
            factor: placed.placement.dimming() * settings.maintenance_factor,
            near_m: if patches.is_empty() { 0.0 } else { settings.near_ratio * body.map_or(0.0, largest_dimension_m) },
            body,
            patches,
            tolerance: settings.tolerance,
        })
    }

    /// The share of this luminaire at a point; `None` in its opening or on it.
    pub(super) fn at(&self, point_m: DVec3) -> Option<Share> {
        let q = self.to_local * (point_m - self.position);
        let d2 = q.length_squared();
        let near = d2 < self.near_m * self.near_m;
        if (near || d2 < 1e-9) && touches(self.body, q) {
            return None;
        }
        let as_point = self.factor * self.from(q, d2);
        if !near || self.factor == 0.0 {
            return Some(Share { value: as_point, as_point, near, resolved: true });
        }
        let (value, resolved) = self.subdivided(q, as_point / self.factor);
        Some(Share { value: self.factor * value, as_point, near, resolved })
    }

    /// I(ω) times the receiver's response over the square of the distance, ω along `v`.
    fn from(&self, v: DVec3, d2: f64) -> f64 {
        let towards = v / d2.sqrt();
        let response = self.receiver.response(-towards);
        if response == 0.0 { 0.0 } else { self.distribution.towards(towards) * response / d2 }
    }

    /// The integral over all that is seen of the opening: each element carries the share of I(ω) that its projected area has in
    /// that of the whole opening (for a flat one: its share of the area).
    fn subdivided(&self, q: DVec3, as_point: f64) -> (f64, bool) {
        let first = self.whole_patches(q, None).0;
        // The tolerance is one of the result, of which the first guess may be far too much right before a large opening.
        let mut scale = if first == 0.0 { as_point.abs() } else { first.abs() };
        loop {
            let (sum, resolved) = self.whole_patches(q, Some(self.tolerance * scale));
            if sum.abs() >= 0.5 * scale || sum == 0.0 {
                return (sum, resolved);
            }
            scale = sum.abs();
        }
    }

    /// The sum over the patches that a point sees, each in a few cells: as they are, or refined to an absolute tolerance.
    fn whole_patches(&self, q: DVec3, tolerance: Option<f64>) -> (f64, bool) {
        let (mut sum, mut resolved) = (0.0, true);
        for patch in &self.patches {
            let Some(view) = patch.seen_from(q) else { continue };
            let part = Part { source: self, q, patch, view };
            let (m, n) = view.cells;
            let step = |(a, b): (f64, f64), n: u32| 0.5 * (b - a) / f64::from(n);
            let half = (step(view.s, m), step(view.t, n));
            let middle = |(a, _): (f64, f64), i: u32, half: f64| a + f64::from(2 * i + 1) * half;
            for (i, j) in (0..m).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let cell = Cell { at: (middle(view.s, i, half.0), middle(view.t, j, half.1)), half };
                let whole = part.gauss(cell);
                let (value, met) = match tolerance {
                    Some(tolerance) => part.refined(cell, whole, tolerance / f64::from(m * n), DEEPEST),
                    None => (whole, true),
                };
                sum += value;
                resolved &= met;
            }
        }
        (sum, resolved)
    }
}

/// A patch of a luminaire with the point that sees it.
struct Part<'a> {
    source: &'a Source<'a>,
    q: DVec3,
    patch: &'a Patch,
    view: View,
}

impl Part<'_> {
    /// The cell's integral, quartered until the quarters differ from the whole by no more than allowed, and are no larger than
    /// they are far: larger ones may agree by chance.
    ///
    /// What is allowed halves with each division while areas fall to a quarter, which lets edges (a beam cut off, a horizon)
    /// converge too.
    fn refined(&self, cell: Cell, whole: f64, allowed: f64, left: u32) -> (f64, bool) {
        let quarters = cell.quarters();
        let parts = quarters.map(|quarter| self.gauss(quarter));
        let sum: f64 = parts.iter().sum();
        let agreed = (sum - whole).abs() <= allowed;
        if left == 0 || (agreed && self.is_small(cell)) {
            return (sum, agreed);
        }
        quarters.into_iter().zip(parts).fold((0.0, true), |(sum, met), (quarter, part)| {
            let (value, here) = self.refined(quarter, part, 0.5 * allowed, left - 1);
            (sum + value, met && here)
        })
    }

    /// Whether a cell's diagonal is no longer than its distance.
    fn is_small(&self, Cell { at: (s, t), half: (ds, dt) }: Cell) -> bool {
        let place = |s, t| self.patch.element(&self.view, s, t).place;
        let diagonal = place(s + ds, t + dt) - place(s - ds, t - dt);
        diagonal.length_squared() <= (self.q - place(s, t)).length_squared()
    }

    /// The cell's integral by 2 × 2 Gauss points.
    fn gauss(&self, cell: Cell) -> f64 {
        let (ds, dt) = (GAUSS * cell.half.0, GAUSS * cell.half.1);
        let mut sum = 0.0;
        for (a, b) in [(-ds, -dt), (ds, -dt), (-ds, dt), (ds, dt)] {
            let element = self.patch.element(&self.view, cell.at.0 + a, cell.at.1 + b);
            let v = self.q - element.place;
            let d2 = v.length_squared();
            if d2 == 0.0 {
                continue;
            }
            let share = element.share.unwrap_or_else(|| {
                let towards = v / d2.sqrt();
                let whole = self.source.body.map_or(0.0, |body| projected_area_towards_m2(body, towards));
                element.area.dot(towards).max(0.0) / whole
            });
            sum += share * self.source.from(v, d2);
        }
        sum * cell.half.0 * cell.half.1
    }
}

/// A cell of a patch's parameters: middle and half widths.
#[derive(Debug, Clone, Copy)]
struct Cell {
    at: (f64, f64),
    half: (f64, f64),
}

impl Cell {
    fn quarters(self) -> [Self; 4] {
        let half = (0.5 * self.half.0, 0.5 * self.half.1);
        [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)]
            .map(|(a, b)| Self { at: (self.at.0 + a * half.0, self.at.1 + b * half.1), half })
    }
}

//! One axis of a grid: the nodes on both sides of a place and their weights.

use super::Error;

/// Where a place lies on an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// The nodes around it.
    pub(super) nodes: [usize; 2],
    /// Their weights; they sum to 1.
    pub(super) weights: [f64; 2],
    /// It lies beyond the first or last node, which has all the weight.
    pub(super) outside: bool,
}

impl Place {
    /// The only node of an axis of one.
    pub(super) const ONLY: Self = Self { nodes: [0, 0], weights: [1.0, 0.0], outside: false };
}

/// Nodes rise strictly and are finite.
pub(super) fn check(axis: &'static str, nodes: &[f64]) -> Result<(), Error> {
    if nodes.is_empty() {
        return Err(Error::Count { what: axis, found: 0, expected: 1 });
    }
    if let Some(&value) = nodes.iter().find(|v| !v.is_finite()) {
        return Err(Error::Range { what: axis, value, expected: "finite angles" });
    }
    match nodes.windows(2).position(|w| w[1] <= w[0]) {
        Some(at) => Err(Error::Axis { axis, at: at + 2 }),
        None => Ok(()),
    }
}

/// The part of `low` … `high` that is nearer to node `i` than to its neighbours; beyond the ends of the axis as far as towards
/// the inside.
pub(super) fn cell(nodes: &[f64], i: usize, low: f64, high: f64) -> [f64; 2] {
    let last = nodes.len() - 1;
    let half = |a: usize| 0.5 * (nodes[a + 1] - nodes[a]);
    if last == 0 {
        return [low, high];
    }
    let below = if i == 0 { half(0) } else { half(i - 1) };
    let above = if i == last { half(last - 1) } else { half(i) };
    [(nodes[i] - below).max(low), (nodes[i] + above).min(high)]
}

/// Share of the hemisphere between two angles to the normal, per radian of azimuth: cos a − cos b, without cancellation.
pub(super) fn zone([a, b]: [f64; 2]) -> f64 {
    2.0 * (0.5 * (a + b)).sin() * (0.5 * (b - a)).sin()
}

/// How far beyond the ends of an axis an angle may lie and still be at them: rounding, in radians or degrees.
const SLACK: f64 = 1e-9;

/// The nodes around `x` on an axis that rises.
pub(super) fn locate(nodes: &[f64], x: f64) -> Place {
    let last = nodes.len() - 1;
    let i = nodes.partition_point(|n| *n <= x);
    if i == 0 {
        return Place { nodes: [0, 0], weights: [1.0, 0.0], outside: x < nodes[0] - SLACK };
    }
    if i > last {
        return Place { nodes: [last, last], weights: [1.0, 0.0], outside: x > nodes[last] + SLACK };
    }
    let t = (x - nodes[i - 1]) / (nodes[i] - nodes[i - 1]);
    Place { nodes: [i - 1, i], weights: [1.0 - t, t], outside: false }
}

/// The nodes around an angle on a closed circle of `count` nodes at multiples of `period`/`count`.
pub(super) fn locate_on_circle(count: usize, period: f64, x: f64) -> Place {
    let place = (x / period).rem_euclid(1.0) * count as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the count of nodes")]
    let i = (place as usize).min(count - 1);
    let t = (place - i as f64).clamp(0.0, 1.0);
    Place { nodes: [i, (i + 1) % count], weights: [1.0 - t, t], outside: false }
}

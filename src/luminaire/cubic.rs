//! The monotone cubic between the entries of a table: along the vertical angle first, then across the planes.

use super::distribution::{Distribution, SAME_DEG, Symmetry, System};
use crate::math::interpolate::{hermite_cell, pchip_end_slope, pchip_slope};

impl Distribution {
    /// The value at a place between planes and one between rows, each an index and the fraction of the interval behind it.
    pub(super) fn cubic(&self, (plane, s): (usize, f64), (row, t): (usize, f64)) -> f64 {
        let along = |plane: usize| self.along(plane, row, t);
        if s == 0.0 {
            return along(plane);
        }
        let h = self.horizontal_deg();
        let slopes = [plane, plane + 1].map(|p| self.slope_across(p, &along));
        hermite_cell(h[plane + 1] - h[plane], s, [along(plane), along(plane + 1)], slopes)
    }

    /// The value in one plane.
    pub(super) fn along(&self, plane: usize, row: usize, t: f64) -> f64 {
        let (values, vertical) = (self.plane(plane), self.vertical_deg());
        if t == 0.0 {
            return values[row];
        }
        let slopes = self.slopes_along(plane);
        let width = vertical[row + 1] - vertical[row];
        hermite_cell(width, t, [values[row], values[row + 1]], [slopes[row], slopes[row + 1]])
    }

    /// Slope across the planes at one of them, per degree, of the values that `along` gives for each plane.
    pub(super) fn slope_across(&self, plane: usize, along: &impl Fn(usize) -> f64) -> f64 {
        let h = self.horizontal_deg();
        let here = (h[plane], along(plane));
        let secant = |other: (f64, f64)| ((other.0 - here.0).abs(), (other.1 - here.1) / (other.0 - here.0));
        let neighbour = |(angle, index): (f64, usize)| secant((angle, along(index)));
        match (self.before(plane).map(neighbour), self.behind(plane).map(neighbour)) {
            (Some((h0, d0)), Some((h1, d1))) => pchip_slope([h0, h1], [d0, d1]),
            (Some((h0, d0)), None) => self.end_slope((h0, d0), [plane - 1, plane.saturating_sub(2)], along),
            (None, Some((h0, d0))) => self.end_slope((h0, d0), [plane + 1, (plane + 2).min(h.len() - 1)], along),
            (None, None) => 0.0,
        }
    }

    /// The slope at the edge of a table from its outermost interval and, where there is one, the next (between two planes).
    fn end_slope(&self, (h0, d0): (f64, f64), [a, b]: [usize; 2], along: &impl Fn(usize) -> f64) -> f64 {
        if a == b {
            return d0;
        }
        let h = self.horizontal_deg();
        pchip_end_slope([h0, (h[b] - h[a]).abs()], [d0, (along(b) - along(a)) / (h[b] - h[a])])
    }

    /// Angle and index of the plane before one: beyond the first, what the turn or the symmetry has there.
    fn before(&self, plane: usize) -> Option<(f64, usize)> {
        let h = self.horizontal_deg();
        let last = h.len() - 1;
        match (self.system(), self.symmetry()) {
            _ if plane > 0 => Some((h[plane - 1], plane - 1)),
            _ if last == 0 => None,
            (System::TypeC, Symmetry::None) => Some((h[last - 1] - 360.0, last - 1)),
            (System::TypeC, _) => Some((2.0 * h[0] - h[1], 1)),
            (_, Symmetry::Quadrant) if h[0].abs() <= SAME_DEG => Some((-h[1], 1)),
            _ => None,
        }
    }

    /// Angle and index of the plane behind one, likewise.
    fn behind(&self, plane: usize) -> Option<(f64, usize)> {
        let h = self.horizontal_deg();
        let last = h.len() - 1;
        match (self.system(), self.symmetry()) {
            _ if plane < last => Some((h[plane + 1], plane + 1)),
            _ if last == 0 => None,
            (System::TypeC, Symmetry::None) => Some((h[1] + 360.0, 1)),
            (System::TypeC, _) => Some((2.0 * h[last] - h[last - 1], last - 1)),
            _ => None,
        }
    }
}

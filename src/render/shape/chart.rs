//! Surfaces as patches: where the points of a shape are, by two coordinates from 0 to 1, and how it is cut into cells of equal kind.
//!
//! | chart | first coordinate | second coordinate |
//! |---|---|---|
//! | parallelogram | along the first edge | along the second edge |
//! | triangle | from the first corner to the opposite edge | along that edge |
//! | ring | square of the radius, from the inner to the outer one | angle |
//! | sphere | height, from the pole −z to +z | longitude |
//! | tube | along the axis | angle |
//!
//! Equal parts of the square are equal parts of the area, but for the triangle, where the area grows as twice the first coordinate.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::facet::Facet;
use super::outline;
use super::rounding::cross;

/// A piece of a surface; its outside is where [`Chart::at`] says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Chart {
    /// A corner and two edges; outside along first × second.
    Parallelogram {
        /// The corner, m.
        corner: DVec3,
        /// The edges, m.
        edges: [DVec3; 2],
    },
    /// Corners anticlockwise from outside, m.
    Triangle([DVec3; 3]),
    /// A disk or a ring.
    Ring {
        /// Its centre, m.
        centre: DVec3,
        /// Orthonormal, in its plane; outside along first × second.
        axes: [DVec3; 2],
        /// Inner and outer radius, m.
        radii: [f64; 2],
    },
    /// A whole sphere.
    Sphere {
        /// Its centre, m.
        centre: DVec3,
        /// Its radius, m.
        radius: f64,
    },
    /// The side of a cylinder.
    Tube {
        /// The middle of one end, m.
        base: DVec3,
        /// Orthonormal; the third is the axis.
        axes: [DVec3; 3],
        /// Its length, m.
        length: f64,
        /// Its radius, m.
        radius: f64,
    },
}

/// A point of a chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Where, m.
    pub position: DVec3,
    /// Unit, outwards.
    pub normal: DVec3,
}

/// A part of a chart, from low to high coordinates.
#[derive(Debug, Clone)]
pub struct Cell {
    chart: Chart,
    low: [f64; 2],
    high: [f64; 2],
    area: f64,
    /// Of a flat cell: its corners in order, curved sides as chords of the same area, and its plane.
    outline: Option<(Vec<DVec3>, Facet)>,
}

/// Chords of a whole circle, at least, where a curved side is made of them.
const CHORDS: f64 = 96.0;

impl Chart {
    /// The point at the coordinates `p`.
    #[must_use]
    pub fn at(&self, p: [f64; 2]) -> Spot {
        match *self {
            Self::Parallelogram { corner, edges: [a, b] } => {
                Spot { position: corner + p[0] * a + p[1] * b, normal: cross(a, b).normalize() }
            }
            Self::Triangle([a, b, c]) => Spot {
                position: a + p[0] * ((1.0 - p[1]) * (b - a) + p[1] * (c - a)),
                normal: cross(b - a, c - a).normalize(),
            },
            Self::Ring { centre, axes: [x, y], radii: [inner, outer] } => {
                let r = (inner * inner + p[0] * (outer - inner) * (outer + inner)).sqrt();
                let (sin, cos) = (TAU * p[1]).sin_cos();
                Spot { position: centre + r * (cos * x + sin * y), normal: x.cross(y) }
            }
            Self::Sphere { centre, radius } => {
                let z = 2.0 * p[0] - 1.0;
                let r = 2.0 * (p[0] * (1.0 - p[0])).sqrt();
                let (sin, cos) = (TAU * p[1]).sin_cos();
                let normal = DVec3::new(r * cos, r * sin, z);
                Spot { position: centre + radius * normal, normal }
            }
            Self::Tube { base, axes: [x, y, z], length, radius } => {
                let (sin, cos) = (TAU * p[1]).sin_cos();
                let normal = cos * x + sin * y;
                Spot { position: base + radius * normal + p[0] * length * z, normal }
            }
        }
    }

    /// The coordinates of the point of the chart nearest to `position`, as far as they are determined.
    #[must_use]
    pub fn locate(&self, position: DVec3) -> [f64; 2] {
        let angle = |x: f64, y: f64| (y.atan2(x) / TAU).rem_euclid(1.0);
        match *self {
            Self::Parallelogram { corner, edges: [a, b] } => oblique(position - corner, a, b),
            Self::Triangle([a, b, c]) => {
                let [s, t] = oblique(position - a, b - a, c - a);
                let u = s + t;
                [u, if u > 0.0 { t / u } else { 0.5 }]
            }
            Self::Ring { centre, axes: [x, y], radii: [inner, outer] } => {
                let d = position - centre;
                let (x, y) = (d.dot(x), d.dot(y));
                let u = (x * x + y * y - inner * inner) / ((outer - inner) * (outer + inner));
                [u, angle(x, y)]
            }
            Self::Sphere { centre, radius } => {
                let d = (position - centre) / radius;
                [0.5 * (1.0 + d.z), angle(d.x, d.y)]
            }
            Self::Tube { base, axes: [x, y, z], length, .. } => {
                let d = position - base;
                [d.dot(z) / length, angle(d.dot(x), d.dot(y))]
            }
        }
        .map(|x| x.clamp(0.0, 1.0))
    }

    /// How far outside of a parallelogram or a triangle a point of its plane is, in parts of its edges; 0 or less inside, and for all other charts.
    #[must_use]
    pub fn outside(&self, position: DVec3) -> f64 {
        match *self {
            Self::Parallelogram { corner, edges: [a, b] } => {
                let [s, t] = oblique(position - corner, a, b);
                (-s).max(-t).max(s - 1.0).max(t - 1.0)
            }
            Self::Triangle([a, b, c]) => {
                let [s, t] = oblique(position - a, b - a, c - a);
                (-s).max(-t).max(s + t - 1.0)
            }
            _ => 0.0,
        }
    }

    /// The corners, anticlockwise from outside, of what is flat and has straight edges.
    #[must_use]
    pub fn corners(&self) -> Option<Vec<DVec3>> {
        match *self {
            Self::Parallelogram { corner, edges: [a, b] } => Some(vec![corner, corner + a, corner + a + b, corner + b]),
            Self::Triangle(corners) => Some(corners.to_vec()),
            Self::Ring { .. } | Self::Sphere { .. } | Self::Tube { .. } => None,
        }
    }

    /// Area, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        match *self {
            Self::Parallelogram { edges: [a, b], .. } => cross(a, b).length(),
            Self::Triangle([a, b, c]) => 0.5 * cross(b - a, c - a).length(),
            Self::Ring { radii: [inner, outer], .. } => PI * (outer - inner) * (outer + inner),
            Self::Sphere { radius, .. } => 2.0 * TAU * radius * radius,
            Self::Tube { length, radius, .. } => TAU * radius * length,
        }
    }

    /// How many cells along each coordinate have edges of about `edge` (m) at most; a triangle has the square of the first number.
    #[must_use]
    pub fn counts(&self, edge: f64) -> [usize; 2] {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        // A hair less, so that an edge that divides a side is not undercut by rounding.
        let parts = |length: f64, least: usize| ((length / edge - 1e-9).ceil().clamp(0.0, 1e6) as usize).max(least);
        match *self {
            Self::Parallelogram { edges, .. } => edges.map(|e| parts(e.length(), 1)),
            Self::Triangle([a, b, c]) => {
                let longest = (b - a).length().max((c - a).length()).max((c - b).length());
                [parts(longest, 1); 2]
            }
            Self::Ring { radii: [inner, outer], .. } => [parts(outer - inner, 1), parts(TAU * outer, 6)],
            Self::Sphere { radius, .. } => [parts(PI * radius, 3), parts(TAU * radius, 6)],
            Self::Tube { length, radius, .. } => [parts(length, 1), parts(TAU * radius, 6)],
        }
    }

    /// The cells of `counts` along each coordinate, in the order of [`Chart::index`].
    #[must_use]
    pub fn cells(&self, counts: [usize; 2]) -> Vec<Cell> {
        let [m, n] = counts;
        #[expect(clippy::cast_precision_loss, reason = "numbers of cells")]
        let part = |i: usize, of: usize| i as f64 / of as f64;
        if let Self::Triangle([a, b, c]) = *self {
            let at = |i: usize, j: usize| a + part(i, m) * (b - a) + part(j, m) * (c - a);
            let mut cells = Vec::with_capacity(m * m);
            for i in 0..m {
                for j in 0..m - i {
                    cells.push(Cell::whole(Self::Triangle([at(i, j), at(i + 1, j), at(i, j + 1)])));
                    if i + j + 1 < m {
                        let corners = [at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)];
                        cells.push(Cell::whole(Self::Triangle(corners)));
                    }
                }
            }
            return cells;
        }
        let cell = |i, j| Cell::new(*self, [part(i, m), part(j, n)], [part(i + 1, m), part(j + 1, n)]);
        (0..m).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| cell(i, j)).collect()
    }

    /// The number of the cell, of `counts`, that a point of the chart is in.
    #[must_use]
    pub fn index(&self, counts: [usize; 2], position: DVec3) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "a cell's number"
        )]
        let cut = |x: f64, of: usize| ((x * of as f64) as usize).min(of - 1);
        let [m, n] = counts;
        if let Self::Triangle([a, b, c]) = *self {
            let [s, t] = oblique(position - a, b - a, c - a).map(|x| x.clamp(0.0, 1.0));
            let i = cut(s, m);
            let j = cut(t, m).min(m - 1 - i);
            #[expect(clippy::cast_precision_loss, reason = "a cell's number")]
            let rest = (s + t) * m as f64 - (i + j) as f64;
            // Before row i there are Σ (2 (m − k) − 1) cells, k < i.
            let before = i * (2 * m - i);
            return before + 2 * j + usize::from(rest > 1.0 && i + j + 1 < m);
        }
        let [u, v] = self.locate(position);
        cut(u, m) * n + cut(v, n)
    }
}

/// The coordinates of a vector of a plane in the oblique frame of two others.
fn oblique(d: DVec3, a: DVec3, b: DVec3) -> [f64; 2] {
    let normal = cross(a, b);
    let square = normal.length_squared();
    [cross(d, b).dot(normal) / square, cross(a, d).dot(normal) / square]
}

impl Cell {
    /// All of a chart.
    #[must_use]
    pub fn whole(chart: Chart) -> Self {
        Self::new(chart, [0.0; 2], [1.0; 2])
    }

    fn new(chart: Chart, low: [f64; 2], high: [f64; 2]) -> Self {
        let mut cell = Self { chart, low, high, area: 0.0, outline: None };
        cell.area = chart.area() * (high[0] - low[0]) * (high[1] - low[1]);
        let corner = |u: f64, v: f64| cell.chart.at([u, v]).position;
        let corners = match chart {
            Chart::Parallelogram { .. } => Some(vec![
                corner(low[0], low[1]),
                corner(high[0], low[1]),
                corner(high[0], high[1]),
                corner(low[0], high[1]),
            ]),
            Chart::Triangle(corners) => Some(corners.to_vec()),
            Chart::Ring { centre, .. } => {
                let angle = TAU * (high[1] - low[1]);
                let chords = (CHORDS * (high[1] - low[1])).ceil().max(1.0);
                // ½ ρ² sinα of a triangle is ½ r² α of its sector.
                let stretch = ((angle / chords) / (angle / chords).sin()).sqrt();
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 96")]
                let arc = |u: f64| {
                    (0..=chords as u32).map(move |k| {
                        let v = low[1] + (high[1] - low[1]) * f64::from(k) / chords;
                        centre + stretch * (chart.at([u, v]).position - centre)
                    })
                };
                let mut corners: Vec<DVec3> = arc(high[0]).collect();
                let inner: Vec<DVec3> = arc(low[0]).collect();
                if inner[0] == centre {
                    corners.push(centre);
                } else {
                    corners.extend(inner.into_iter().rev());
                }
                Some(corners)
            }
            Chart::Sphere { .. } | Chart::Tube { .. } => None,
        };
        let normal = chart.at([0.5; 2]).normal;
        cell.outline = corners.map(|corners| {
            let facet = Facet { anchor: corners[0], normal };
            (corners, facet)
        });
        cell
    }

    /// The point at coordinates of the cell's own, from 0 to 1, and the density of the area there, whose mean is 1.
    #[must_use]
    pub fn at(&self, p: [f64; 2]) -> (Spot, f64) {
        let density = if matches!(self.chart, Chart::Triangle(_)) { 2.0 * p[0] } else { 1.0 };
        let within = std::array::from_fn(|k| self.low[k] + p[k] * (self.high[k] - self.low[k]));
        (self.chart.at(within), density)
    }

    /// As [`Chart::outside`], of the chart that the cell is a part of.
    #[must_use]
    pub fn outside(&self, position: DVec3) -> f64 {
        self.chart.outside(position)
    }

    /// The coordinates of the cell's own of a point on it.
    #[must_use]
    pub fn locate(&self, position: DVec3) -> [f64; 2] {
        let p = self.chart.locate(position);
        std::array::from_fn(|k| ((p[k] - self.low[k]) / (self.high[k] - self.low[k])).clamp(0.0, 1.0))
    }

    /// Area, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Whether it is part of a triangle.
    #[must_use]
    pub fn is_triangle(&self) -> bool {
        matches!(self.chart, Chart::Triangle(_))
    }

    /// Whether it is flat.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        self.outline.is_some()
    }

    /// Points that the cell lies between: its corners, or of a curved cell points all over it.
    #[must_use]
    pub fn extremes(&self) -> Vec<DVec3> {
        match &self.outline {
            Some((corners, _)) => corners.clone(),
            None => (0..9).map(|k| self.at([0.5 * f64::from(k % 3), 0.5 * f64::from(k / 3)]).0.position).collect(),
        }
    }

    /// The height of a point over a flat cell's plane, m.
    #[must_use]
    pub fn height(&self, point: DVec3) -> Option<f64> {
        self.outline.as_ref().map(|(_, facet)| facet.height(point))
    }

    /// ∫ cosθ⁺ dω of a flat cell seen from a point, as [`super::Shape::projected_solid_angle`].
    #[must_use]
    pub fn projected_solid_angle(&self, from: DVec3, normal: DVec3) -> Option<f64> {
        self.outline.as_ref().map(|(corners, facet)| outline::projected(corners.iter().copied(), facet, from, normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn charts() -> [Chart; 5] {
        let corner = DVec3::new(1.0, 2.0, 3.0);
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        [
            Chart::Parallelogram { corner, edges: [2.0 * x, y + 0.3 * x] },
            Chart::Triangle([corner, corner + 2.0 * x, corner + y + z]),
            Chart::Ring { centre: corner, axes: [x, y], radii: [0.5, 2.0] },
            Chart::Sphere { centre: corner, radius: 1.5 },
            Chart::Tube { base: corner, axes: [x, y, z], length: 2.0, radius: 0.7 },
        ]
    }

    /// Every point of every cell is found in that cell again, and the cells make up the whole.
    #[test]
    fn cells_are_a_partition() {
        for chart in charts() {
            let counts = chart.counts(0.4);
            let cells = chart.cells(counts);
            let area: f64 = cells.iter().map(Cell::area).sum();
            assert!((area / chart.area() - 1.0).abs() < 1e-13, "{chart:?}");
            for (index, cell) in cells.iter().enumerate() {
                for p in [[0.1, 0.1], [0.9, 0.2], [0.5, 0.5], [0.7, 0.9]] {
                    let position = cell.at(p).0.position;
                    assert_eq!(chart.index(counts, position), index, "{chart:?} {p:?}");
                    let back = cell.locate(position);
                    assert!((0..2).all(|k| (back[k] - p[k]).abs() < 1e-9), "{chart:?} {back:?} {p:?}");
                }
            }
        }
    }

    /// The solid angles of the cells of a disk add up to that of the disk (closed form on its axis), to the chords' error.
    #[test]
    fn a_disk_of_cells_is_seen_as_the_disk() {
        let disk = Chart::Ring { centre: DVec3::ZERO, axes: [DVec3::X, DVec3::Y], radii: [0.0, 1.0] };
        let from = DVec3::new(0.0, 0.0, 0.8);
        let seen: f64 = (disk.cells(disk.counts(0.3)).iter())
            .map(|cell| cell.projected_solid_angle(from, DVec3::NEG_Z).expect("flat"))
            .sum();
        // π sin²α; the chords, of 3.75° each, are off by the fourth power of their angle.
        let expected = PI / (1.0 + 0.64);
        assert!((seen / expected - 1.0).abs() < 2e-5, "{seen} {expected}");
    }
}

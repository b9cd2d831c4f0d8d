//! Where the points of a light map are: on a flat rectangle, or around the outside of a sphere or a cylinder, unrolled.
//!
//! | surface | across the map | up the map |
//! |---|---|---|
//! | rectangle | along its first edge | along its second edge |
//! | side of a cylinder | around it, anticlockwise as seen from its end `to` | from `from` to `to` |
//! | sphere | longitude from +x over +y | height from its lowest point: equal parts of the map are equal parts of the sphere |

use std::f64::consts::TAU;

use glam::DVec3;

use super::shape::Shape;
use super::shape::chart::{Chart, Spot};

/// A surface that is mapped, coordinates from 0 to 1 each way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightMap {
    /// A corner and two edges; points face along first × second.
    Flat {
        /// The corner, m.
        corner: DVec3,
        /// The edges, m.
        edges: [DVec3; 2],
    },
    /// A sphere or the side of a cylinder.
    Round(Chart),
}

impl LightMap {
    /// Of the outside of a sphere or of a cylinder's side; `None` of another shape.
    #[must_use]
    pub fn round(shape: &dyn Shape) -> Option<Self> {
        let charts = shape.charts().into_iter().map(|(_, chart)| chart);
        // Nothing but a cylinder has a tube; its ends are left out.
        charts.into_iter().find(|c| matches!(c, Chart::Sphere { .. } | Chart::Tube { .. })).map(Self::Round)
    }

    /// The point at coordinates of the map, across and up.
    #[must_use]
    pub fn at(&self, [across, up]: [f64; 2]) -> Spot {
        match self {
            Self::Flat { corner, edges: [u, v] } => {
                Spot { position: *corner + across * *u + up * *v, normal: u.cross(*v).normalize() }
            }
            Self::Round(chart) => chart.at([up, across]),
        }
    }

    /// Width and height, m.
    #[must_use]
    pub fn size_m(&self) -> [f64; 2] {
        match *self {
            Self::Flat { edges, .. } => edges.map(DVec3::length),
            Self::Round(Chart::Tube { length, radius, .. }) => [TAU * radius, length],
            Self::Round(Chart::Sphere { radius, .. }) => [TAU * radius, 2.0 * radius],
            Self::Round(chart) => [chart.area().sqrt(); 2],
        }
    }

    /// The point in the middle of a cell, row by row across.
    #[must_use]
    pub fn middle(&self, [m, n]: [usize; 2], index: usize) -> Spot {
        #[expect(clippy::cast_precision_loss, reason = "numbers of points")]
        let part = |index: usize, count: usize| (index as f64 + 0.5) / count as f64;
        self.at([part(index % m, m), part(index / m, n)])
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::render::shape::cylinder::Cylinder;
    use crate::render::shape::rectangle::Rectangle;
    use crate::render::shape::sphere::Sphere;

    /// Points lie on the surface and face outwards; the map has the surface's area.
    #[test]
    fn round_surfaces_are_unrolled() {
        let ball = Sphere::new(DVec3::new(1.0, 2.0, 3.0), 0.5).expect("a ball");
        let map = LightMap::round(&ball).expect("a map");
        assert!((map.size_m()[0] * map.size_m()[1] - 4.0 * PI * 0.25).abs() < 1e-12);
        for index in 0..24 {
            let spot = map.middle([6, 4], index);
            let out = (spot.position - DVec3::new(1.0, 2.0, 3.0)) / 0.5;
            assert!((out - spot.normal).length() < 1e-12);
            // Equal parts of the height, from the lowest point upwards.
            let height = 2.0 * ((index / 6) as f64 + 0.5) / 4.0 - 1.0;
            assert!((out.z - height).abs() < 1e-12);
        }
        let tube = Cylinder::new(DVec3::ZERO, DVec3::new(0.0, 0.0, 2.0), 0.25, true).expect("a cylinder");
        let map = LightMap::round(&tube).expect("a map");
        assert_eq!(map.size_m(), [TAU * 0.25, 2.0]);
        let spot = map.at([0.3, 0.75]);
        assert!((spot.position.z - 1.5).abs() < 1e-12 && (spot.position.truncate().length() - 0.25).abs() < 1e-12);
        assert!((spot.normal.truncate() * 0.25 - spot.position.truncate()).length() < 1e-12);
        let flat = Rectangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).expect("a rectangle");
        assert_eq!(LightMap::round(&flat), None);
    }
}

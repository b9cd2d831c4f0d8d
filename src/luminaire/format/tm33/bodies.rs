//! Housing and luminous opening out of dimensions, shapes and emission areas.

use super::{EmissionArea, Face, Tm33};
use crate::finding::Finding;
use crate::luminaire::{Body, Shape};

/// A luminaire of more metres than this was written in millimetres.
const LARGEST_M: f64 = 20.0;

impl Tm33 {
    /// Metres per unit of the dimensions.
    pub(super) fn unit(&self, findings: &mut Vec<Finding>) -> f64 {
        let sizes = self.dimensions.into_iter().flatten();
        let openings = self.openings.iter().flat_map(|(_, l, w)| [*l, *w]);
        let areas = self.emitters.iter().flat_map(|e| &e.areas).flat_map(|a| [a.along, a.across]);
        let largest = sizes.chain(openings).chain(areas).fold(0.0, f64::max);
        if largest <= LARGEST_M {
            return 1.0;
        }
        let message = format!("dimensions of up to {largest} were taken as millimetres; the standard has metres");
        findings.push(Finding::info("L305", message));
        1e-3
    }

    pub(super) fn housing(&self, scale: f64) -> Option<Body> {
        let [length_m, width_m, height_m] = self.dimensions?.map(|v| v.max(0.0) * scale);
        let shape = match self.shape.as_deref().map(str::to_lowercase).as_deref() {
            Some("align_z") => Shape::Round,
            Some("align_x") => Shape::CylinderAlongC0,
            Some("align_y") => Shape::CylinderAlongC90,
            _ => Shape::Rectangle,
        };
        (length_m > 0.0 || width_m > 0.0).then_some(Body { shape, length_m, width_m, height_m })
    }

    /// The rectangle around all areas of the side that shines, with the height of the sides.
    pub(super) fn opening(&self, scale: f64) -> Option<Body> {
        if let Some((round, length, width)) = self.openings.first().copied() {
            let (length_m, width_m) = (length * scale, if width > 0.0 { width } else { length } * scale);
            let shape = if round { Shape::Round } else { Shape::Rectangle };
            return (length > 0.0).then_some(Body { shape, length_m, width_m, height_m: 0.0 });
        }
        let areas: Vec<_> = self.emitters.iter().flat_map(|e| &e.areas).collect();
        let flat = [Face::Bottom, Face::Top].into_iter().find(|f| areas.iter().any(|a| a.face == *f));
        let on = |face: Face| areas.iter().filter(move |a| a.face == face);
        let extent = |face: Face, size: fn(&EmissionArea) -> (f64, f64)| {
            let (low, high) = on(face).fold((f64::MAX, f64::MIN), |(low, high), area| {
                let (extent, offset) = size(area);
                (low.min(offset - extent / 2.0), high.max(offset + extent / 2.0))
            });
            ((high - low) * scale).max(0.0)
        };
        let along = |face| extent(face, |a| (a.along, a.offsets.0));
        let across = |face| extent(face, |a| (a.across, a.offsets.1));
        let sides = [0, 90, 180, 270].map(Face::Side);
        let height_m = sides.into_iter().map(across).fold(0.0, f64::max);
        let (length_m, width_m) = match flat {
            Some(face) => (along(face), across(face)),
            None => (along(sides[0]).max(along(sides[2])), along(sides[1]).max(along(sides[3]))),
        };
        let round = flat.is_some_and(|face| on(face).count() == 1 && on(face).all(|a| a.circular));
        let width_m = if round && width_m == 0.0 { length_m } else { width_m };
        let shape = if round { Shape::Round } else { Shape::Rectangle };
        (length_m > 0.0 || width_m > 0.0).then_some(Body { shape, length_m, width_m, height_m })
    }
}

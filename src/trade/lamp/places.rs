//! What a lamp of a trade is asked for: its figures, and its illuminance where it is wanted.

use glam::DVec3;

use super::FIGURES;
use crate::luminaire::beam::{BEAM_FRACTION, Definition, angles};
use crate::luminaire::grid::{self, Placed, Plane, PointsAt, Receiver, Settings, illuminance};
use crate::luminaire::placement::{Orientation, Placement};
use crate::luminaire::{Distribution, Luminaire};
use crate::trade::{Figure, Measure};

/// Distances in the direction of the peak, in largest dimensions.
const TIMES: [f64; 4] = [1.0, 2.0, 5.0, 10.0];

/// Where the illuminance is wanted.
pub(super) struct Places {
    above: Placement,
    floor: Plane,
    /// Of a lamp at the origin: a point for each of [`TIMES`], and what faces the lamp there.
    facing: Option<([Plane; 4], Receiver)>,
    at_origin: Placement,
}

impl Places {
    pub(super) fn new(luminaire: &Luminaire, height_m: f64, floor: Plane) -> Result<Self, grid::Error> {
        let at = |z: f64| {
            let expected = "a length above 0 m";
            Placement::new(DVec3::new(0.0, 0.0, z), Orientation::DOWN, 1.0).map_err(|_| grid::Error::Setting {
                name: "a mounting height",
                found: z,
                expected,
            })
        };
        let (above, at_origin) = (at(height_m)?, at(0.0)?);
        let d = &luminaire.distribution;
        let (_, horizontal, vertical) = d.peak();
        let towards = at_origin.to_room() * d.direction(horizontal, vertical);
        let facing = grid::largest_dimension_m(luminaire).map(|size| -> Result<_, grid::Error> {
            let (u, v) = towards.any_orthonormal_pair();
            let point = |times: f64| {
                // Not nearer than: rounding does not decide.
                let side = size * times * (1.0 + 1e-9);
                let corner = side * towards - 0.5 * side * (u + v);
                Plane::new(corner, [side * u, side * v], [1, 1], PointsAt::Centres)
            };
            let [a, b, c, d] = TIMES.map(point);
            Ok(([a?, b?, c?, d?], Receiver::Planar(-towards)))
        });
        Ok(Self { above, floor, facing: facing.transpose()?, at_origin })
    }

    pub(super) fn values(&self, luminaire: &Luminaire, settings: &Settings) -> Result<Values, grid::Error> {
        let d: &Distribution = &luminaire.distribution;
        let beam = angles(d, BEAM_FRACTION, Definition::Fwhm);
        let on = |plane: &Plane, placement: Placement, receiver: &Receiver| {
            illuminance(&[Placed { luminaire, placement }], plane, receiver, settings)
        };
        let floor = on(&self.floor, self.above, &Receiver::Planar(DVec3::Z))?;
        let mut facing = [f64::NAN; TIMES.len()];
        if let Some((planes, receiver)) = &self.facing {
            for (value, plane) in facing.iter_mut().zip(planes) {
                *value = on(plane, self.at_origin, receiver)?.values[0];
            }
        }
        Ok(Values {
            flux: d.total_flux(),
            peak: d.peak().0,
            beam: [beam.c0_c180, beam.c90_c270].map(|angle| angle.unwrap_or(f64::NAN)),
            mean: floor.figures.map_or(f64::NAN, |f| f.mean),
            floor: floor.values,
            facing,
        })
    }
}

/// What the figures are made of; NaN where there is none.
pub(super) struct Values {
    pub(super) flux: f64,
    peak: f64,
    beam: [f64; 2],
    mean: f64,
    floor: Vec<f64>,
    facing: [f64; TIMES.len()],
}

impl Values {
    /// The distances of [`FIGURES`] of others from these.
    pub(super) fn errors(&self, other: &Self) -> Vec<Option<f64>> {
        let apart = self.floor.iter().zip(&other.floor).map(|(a, b)| (a - b).abs());
        let largest = apart.filter(|a| !a.is_nan()).fold(0.0, f64::max);
        let [c0, c90] = self.beam;
        let scalars = [
            (self.flux, other.flux),
            (self.peak, other.peak),
            (c0, other.beam[0]),
            (c90, other.beam[1]),
            (self.mean, other.mean),
            (self.mean, self.mean + largest),
        ];
        let pairs = scalars.into_iter().chain(self.facing.into_iter().zip(other.facing));
        let error = |(figure, (a, b)): (&Figure, (f64, f64))| match figure.measure {
            Measure::Relative => (b - a).abs() / a.abs(),
            Measure::Absolute => (b - a).abs(),
        };
        FIGURES.iter().zip(pairs).map(error).map(|e| Some(e).filter(|e| e.is_finite())).collect()
    }
}

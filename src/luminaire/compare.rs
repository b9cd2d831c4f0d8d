//! Two luminaires side by side: what differs, by how much, and whether one is the other turned.

use super::shape::{self, ShapeDifference};
use super::{Luminaire, beam};

/// One figure of both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Of the first.
    pub a: f64,
    /// Of the second.
    pub b: f64,
}

impl Pair {
    /// b − a.
    #[must_use]
    pub fn difference(&self) -> f64 {
        self.b - self.a
    }

    /// (b − a)/a; `None` where a is 0.
    #[must_use]
    pub fn relative(&self) -> Option<f64> {
        Some(self.difference() / self.a).filter(|r| r.is_finite())
    }
}

/// A beam or field angle of both in one plane, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamPair {
    /// How it is defined.
    pub definition: beam::Definition,
    /// In the plane C0–C180; `None` where one has none.
    pub c0_c180: Option<Pair>,
    /// In the plane C90–C270; `None` where one has none.
    pub c90_c270: Option<Pair>,
}

/// A turn about the vertical with which the shapes agree better.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// By how much the second is turned, towards increasing C, degrees.
    pub turn_deg: f64,
    /// The shapes after that.
    pub shape: ShapeDifference,
}

/// Two luminaires compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Flux, lm, W or µmol/s; `None` where the kinds of intensity differ.
    pub flux: Option<Pair>,
    /// Peak intensity; `None` where the kinds of intensity differ.
    pub peak: Option<Pair>,
    /// Angle between the directions of the peaks, degrees (of several equal peaks, the first in the table).
    pub peak_separation_deg: f64,
    /// Beam angles (½ of the maximum).
    pub beam: [BeamPair; 3],
    /// Input power, W.
    pub input_power_w: Option<Pair>,
    /// Luminous opening: length (C90–C270), width (C0–C180), height, m.
    pub opening_m: Option<[Pair; 3]>,
    /// Shapes as they are.
    pub shape: ShapeDifference,
    /// The turn that makes them much more alike, if there is one.
    pub turn: Option<Turn>,
}

/// Why two luminaires cannot be compared.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the {which} lamp's intensities integrate to {flux}; expected a lamp that shines")]
pub struct Dark {
    /// `first` or `second`.
    pub which: &'static str,
    /// Its flux.
    pub flux: f64,
}

/// A turn is worth telling where it raises the correlation by this much …
const RAISED_BY: f64 = 1e-3;
/// … and leaves less than this part of what was missing from 1.
const LEFT: f64 = 0.5;

/// Compares two luminaires.
///
/// # Errors
/// [`Dark`] where one has no positive flux.
pub fn compare(a: &Luminaire, b: &Luminaire) -> Result<Comparison, Dark> {
    let (first, second) = (&a.distribution, &b.distribution);
    let flux = Pair { a: first.total_flux(), b: second.total_flux() };
    for (which, flux) in [("first", flux.a), ("second", flux.b)] {
        if !(flux > 0.0 && flux.is_finite()) {
            return Err(Dark { which, flux });
        }
    }
    let (peak_a, peak_b) = (first.peak(), second.peak());
    let (to_a, to_b) = (first.direction(peak_a.1, peak_a.2), second.direction(peak_b.1, peak_b.2));
    let pair = |a: Option<f64>, b: Option<f64>| Some(Pair { a: a?, b: b? });
    let (beams_a, beams_b) = (beam::beam_angles(first), beam::beam_angles(second));
    let beam = std::array::from_fn(|i| BeamPair {
        definition: beams_a[i].definition,
        c0_c180: pair(beams_a[i].c0_c180, beams_b[i].c0_c180),
        c90_c270: pair(beams_a[i].c90_c270, beams_b[i].c90_c270),
    });
    let same = a.kind == b.kind;
    let shape = shape::compare(first, second, 0.0);
    Ok(Comparison {
        flux: same.then_some(flux),
        peak: same.then_some(Pair { a: peak_a.0, b: peak_b.0 }),
        peak_separation_deg: to_a.cross(to_b).length().atan2(to_a.dot(to_b)).to_degrees(),
        beam,
        input_power_w: pair(a.input_power_w, b.input_power_w),
        opening_m: a.opening.zip(b.opening).map(|(a, b)| {
            let extents = [(a.length_m, b.length_m), (a.width_m, b.width_m), (a.height_m, b.height_m)];
            extents.map(|(a, b)| Pair { a, b })
        }),
        shape,
        turn: turn(a, b, &shape),
    })
}

fn turn(a: &Luminaire, b: &Luminaire, unturned: &ShapeDifference) -> Option<Turn> {
    let missing = 1.0 - unturned.correlation;
    if missing < RAISED_BY {
        return None;
    }
    let turn_deg = shape::best_turn_deg(&a.distribution, &b.distribution);
    if turn_deg == 0.0 {
        return None;
    }
    let shape = shape::compare(&a.distribution, &b.distribution, turn_deg);
    let left = 1.0 - shape.correlation;
    (left < LEFT * missing && missing - left >= RAISED_BY).then_some(Turn { turn_deg, shape })
}

impl Comparison {
    /// Whether flux and peak differ by no more than a tolerance of the first's, and the mean absolute difference of the shapes is no
    /// more than it. Intensities of different kinds are never within.
    #[must_use]
    pub fn within(&self, tolerance: f64) -> bool {
        let near = |pair: Option<Pair>| pair.and_then(|p| p.relative()).is_some_and(|r| r.abs() <= tolerance);
        near(self.flux) && near(self.peak) && self.shape.mean_absolute_difference <= tolerance
    }
}

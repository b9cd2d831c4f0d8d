//! Illuminance of placed luminaires on grids of points: direct light, unobstructed.
//!
//! ```text
//! E = MF · Σ δ I(ω) w / d²
//! ```
//!
//! with the maintenance factor MF, the dimming δ, the intensity I towards the point, the receiver's response w (the cosine of
//! the angle of incidence for a plane) and the distance d from the photometric centre. Nothing occludes and nothing reflects.
//!
//! A luminaire nearer than [`Settings::near_ratio`] times the largest dimension of its luminous opening is no point (the
//! five-times rule of photometry, EN 13032-1: beyond it a Lambertian disc differs from a point by less than 1 %). It is
//! subdivided over the opening: each element carries the share of I(ω) that its projected area has in that of the opening. That is
//! the usual far-field assumption, that all parts of the opening shine alike in a direction; a file does not say more. What
//! calculating with points would have cost is stated beside the result ([`PointError`]).
//!
//! Values are lx for cd, W/m² for W/sr, µmol/(m²·s) for µmol/(s·sr).

mod opening;
mod plane;
mod receiver;
mod source;

use glam::DVec3;
use rayon::prelude::*;

pub use plane::{MOST_POINTS, Plane, PointsAt, standard_step_m};
pub use receiver::Receiver;

use self::source::Source;
use super::model::{Kind, Luminaire};
use super::placement::{Orientation, Placement};

/// Why there is no illuminance.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Sides that do not span a rectangle.
    #[error("the sides do not span a rectangle; expected two sides of some length at right angles")]
    Sides,
    /// Too few points.
    #[error("{} × {} points; expected at least {least} along each side", found[0], found[1])]
    Count {
        /// Points along u and v.
        found: [usize; 2],
        /// Fewest.
        least: usize,
    },
    /// More than [`MOST_POINTS`].
    #[error("a grid of {columns} × {rows} points; expected at most {MOST_POINTS} in all, choose a larger step")]
    TooManyPoints {
        /// Points along u.
        columns: f64,
        /// Points along v.
        rows: f64,
    },
    /// A step that is not positive.
    #[error("a step of {found} m; expected a length above 0")]
    Step {
        /// The step, m.
        found: f64,
    },
    /// A receiver without direction.
    #[error("the receiver faces nowhere; expected a direction, and not straight up for a half cylinder")]
    Facing,
    /// A setting out of its range.
    #[error("{name} of {found}; expected {expected}")]
    Setting {
        /// Which.
        name: &'static str,
        /// Its value.
        found: f64,
        /// Its range.
        expected: &'static str,
    },
    /// No luminaire.
    #[error("no luminaire; expected at least one")]
    Empty,
    /// Candela and W/sr do not add up.
    #[error("luminaires of different quantities (luminous, radiant, photon) do not add up; expected one kind")]
    Kinds,
}

/// A luminaire in its place.
#[derive(Debug, Clone, Copy)]
pub struct Placed<'a> {
    /// The luminaire.
    pub luminaire: &'a Luminaire,
    /// Where and how.
    pub placement: Placement,
}

/// How to calculate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Maintenance factor on all values, above 0 to 1.
    pub maintenance_factor: f64,
    /// A luminaire nearer than so many times its largest dimension is subdivided; 0 takes all as points.
    pub near_ratio: f64,
    /// Relative tolerance of the subdivision, 1e-9 to 0.1: per luminaire and point, of its own share.
    pub tolerance: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { maintenance_factor: 1.0, near_ratio: 5.0, tolerance: 1e-4 }
    }
}

impl Settings {
    fn check(&self) -> Result<(), Error> {
        let all = [
            (
                "a maintenance factor",
                self.maintenance_factor,
                self.maintenance_factor > 0.0 && self.maintenance_factor <= 1.0,
                "above 0 to 1",
            ),
            ("a near ratio", self.near_ratio, (0.0..=1000.0).contains(&self.near_ratio), "0 to 1000"),
            ("a tolerance", self.tolerance, (1e-9..=0.1).contains(&self.tolerance), "1e-9 to 0.1"),
        ];
        match all.into_iter().find(|(.., sound, _)| !sound) {
            Some((name, found, _, expected)) => Err(Error::Setting { name, found, expected }),
            None => Ok(()),
        }
    }
}

/// Values on a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Illuminance {
    /// The plane.
    pub plane: Plane,
    /// What received the light at each point.
    pub receiver: Receiver,
    /// What the values are: lx, W/m² or µmol/(m²·s).
    pub kind: Kind,
    /// Point by point in the plane's order; NaN in an opening or on it.
    pub values: Vec<f64>,
    /// Their figures; `None` where no point has a value.
    pub figures: Option<Figures>,
    /// What taking all luminaires as points would have cost; `None` where none is near.
    pub point_error: Option<PointError>,
    /// Points in an opening or on it.
    pub undefined: usize,
    /// Points at which the subdivision did not meet its tolerance.
    pub unresolved: usize,
}

/// Figures over the points that have a value; the others are left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// Smallest value.
    pub minimum: f64,
    /// Arithmetic mean.
    pub mean: f64,
    /// Largest value.
    pub maximum: f64,
    /// Index of the first point with the smallest value.
    pub minimum_at: usize,
    /// Index of the first point with the largest value.
    pub maximum_at: usize,
    /// Overall uniformity U0, minimum over mean (EN 12464-1); `None` where the mean is 0.
    pub u0: Option<f64>,
    /// Diversity Ud, minimum over maximum (U2 in some standards); `None` where the maximum is 0.
    pub ud: Option<f64>,
}

/// The error of treating luminaires as points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointError {
    /// Points of the grid with a luminaire nearer than the ratio.
    pub points_near: usize,
    /// Largest relative deviation |E_point/E − 1| over the points that have light.
    pub relative: f64,
    /// Index of the point with it.
    pub at: usize,
    /// E at that point.
    pub value: f64,
    /// E there with all luminaires as points.
    pub as_point: f64,
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    value: f64,
    as_point: f64,
    near: bool,
    resolved: bool,
}

/// Illuminance of luminaires at the points of a plane, in parallel.
///
/// # Errors
/// [`Error::Empty`], [`Error::Kinds`], [`Error::Facing`], [`Error::Setting`].
pub fn illuminance(
    placed: &[Placed<'_>],
    plane: &Plane,
    receiver: &Receiver,
    settings: &Settings,
) -> Result<Illuminance, Error> {
    settings.check()?;
    let kind = placed.first().ok_or(Error::Empty)?.luminaire.kind;
    if placed.iter().any(|p| p.luminaire.kind != kind) {
        return Err(Error::Kinds);
    }
    let sources: Vec<Source<'_>> =
        placed.iter().map(|p| Source::new(p, receiver, settings)).collect::<Option<_>>().ok_or(Error::Facing)?;
    let samples: Vec<Sample> = (0..plane.len()).into_par_iter().map(|i| sample(&sources, plane.point_m(i))).collect();
    Ok(Illuminance {
        plane: *plane,
        receiver: *receiver,
        kind,
        figures: figures(&samples),
        point_error: point_error(&samples),
        undefined: samples.iter().filter(|s| s.value.is_nan()).count(),
        unresolved: samples.iter().filter(|s| !s.resolved).count(),
        values: samples.into_iter().map(|s| s.value).collect(),
    })
}

fn sample(sources: &[Source<'_>], point_m: DVec3) -> Sample {
    let mut sum = Sample { value: 0.0, as_point: 0.0, near: false, resolved: true };
    for source in sources {
        match source.at(point_m) {
            Some(share) => {
                sum.value += share.value;
                sum.as_point += share.as_point;
                sum.near |= share.near;
                sum.resolved &= share.resolved;
            }
            None => return Sample { value: f64::NAN, as_point: f64::NAN, near: true, resolved: true },
        }
    }
    sum
}

fn figures(samples: &[Sample]) -> Option<Figures> {
    let defined = || samples.iter().map(|s| s.value).enumerate().filter(|(_, v)| !v.is_nan());
    let (mut minimum_at, mut minimum) = defined().next()?;
    let (mut maximum_at, mut maximum) = (minimum_at, minimum);
    let (mut sum, mut count) = (0.0, 0usize);
    for (i, v) in defined() {
        sum += v;
        count += 1;
        if v < minimum {
            (minimum_at, minimum) = (i, v);
        }
        if v > maximum {
            (maximum_at, maximum) = (i, v);
        }
    }
    let mean = sum / count as f64;
    let over = |whole: f64| (whole > 0.0).then(|| minimum / whole);
    Some(Figures { minimum, mean, maximum, minimum_at, maximum_at, u0: over(mean), ud: over(maximum) })
}

fn point_error(samples: &[Sample]) -> Option<PointError> {
    let near = || samples.iter().enumerate().filter(|(_, s)| s.near && !s.value.is_nan());
    let error = |s: &Sample| (s.as_point / s.value - 1.0).abs();
    let lit = near().filter(|(_, s)| s.value > 0.0);
    let (at, worst) = lit.reduce(|a, b| if error(b.1) > error(a.1) { b } else { a })?;
    Some(PointError {
        points_near: near().count(),
        relative: error(worst),
        at,
        value: worst.value,
        as_point: worst.as_point,
    })
}

/// Half-widths of the square beneath a single luminaire, in mounting heights.
const HALF_WIDTHS: [f64; 6] = [1.0, 1.5, 2.0, 3.0, 4.0, 6.0];
/// Beyond the square no value is above this share of the largest.
const OUTSIDE: f64 = 0.05;

/// The floor beneath one luminaire that hangs at a height, for its isolux diagram: a square about it of ±1 to ±6 mounting
/// heights, the smallest at whose edge no more than 5 % of the largest value is left, with points on the edges and an
/// odd number of them, so that one lies beneath the luminaire. `cells` is the number of cells along each side.
///
/// # Errors
/// [`Error::Setting`] where the height is not above 0; [`Error::Count`], [`Error::TooManyPoints`].
pub fn beneath(luminaire: &Luminaire, height_m: f64, cells: usize, settings: &Settings) -> Result<Illuminance, Error> {
    let height = Error::Setting { name: "a mounting height", found: height_m, expected: "a length above 0 m" };
    if !(height_m.is_finite() && height_m > 0.0) {
        return Err(height);
    }
    let placement = Placement::new(DVec3::new(0.0, 0.0, height_m), Orientation::DOWN, 1.0).map_err(|_| height)?;
    let placed = [Placed { luminaire, placement }];
    let up = Receiver::Planar(DVec3::Z);
    let square = |half: f64, cells: usize| {
        let origin = DVec3::new(-half, -half, 0.0);
        let counts = [cells + 1; 2];
        Plane::new(origin, [2.0 * half * DVec3::X, 2.0 * half * DVec3::Y], counts, PointsAt::Nodes)
    };
    let mut half = height_m;
    for times in HALF_WIDTHS {
        half = times * height_m;
        // Coarse, and as points: this only chooses the size.
        let plain = Settings { near_ratio: 0.0, ..*settings };
        let tried = illuminance(&placed, &square(half, EDGE_CELLS)?, &up, &plain)?;
        let largest = tried.figures.map_or(0.0, |f| f.maximum);
        let n = EDGE_CELLS + 1;
        let edge = |i: usize| i.is_multiple_of(n) || i % n == n - 1 || i / n == 0 || i / n == n - 1;
        let on_edge = (0..n * n).filter(|i| edge(*i)).map(|i| tried.values[i]).fold(0.0, f64::max);
        if on_edge <= OUTSIDE * largest {
            break;
        }
    }
    illuminance(&placed, &square(half, cells + cells % 2)?, &up, settings)
}

/// Cells along a side while the size of the square is sought.
const EDGE_CELLS: usize = 48;

/// Whether the opening of a luminaire is known, so that the error of taking it as a point can be.
#[must_use]
pub fn has_opening(luminaire: &Luminaire) -> bool {
    largest_dimension_m(luminaire).is_some()
}

/// The largest dimension of a luminaire's opening, m: its longest side, diameter or height. `None` where it is not known, or none.
#[must_use]
pub fn largest_dimension_m(luminaire: &Luminaire) -> Option<f64> {
    luminaire.opening.as_ref().map(opening::largest_dimension_m).filter(|size| *size > 0.0)
}

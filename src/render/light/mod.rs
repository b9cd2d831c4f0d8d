//! Lights that are no surface of the scene: points, spots, luminaires, distant lights, skies, pictures of surroundings.
//!
//! (A surface that emits is a shape with an emission; the scene makes a light of it.)
//!
//! | file | light | seen from a point |
//! |---|---|---|
//! | [`point`] | isotropic point | one direction |
//! | [`spot`] | cosine spot, hard cone | one direction |
//! | [`goniometric`] | luminaire of a photometric file, a point or from its opening | one direction |
//! | [`barzel`] | Pixar's production light | one direction |
//! | [`environment`] | constant surroundings, or a picture ([`projection`]) | all around |
//! | [`sky`] | CIE standard general skies | the hemisphere |
//! | [`sun`] | the sun by date, time and place | a disc |
//! | [`distant`] | parallel light, or a disc in the sky | one direction, or a disc |
//!
//! [`choice`] chooses among them, and [`shares`] where a packet of flux begins; lights at infinity shine through the scene's [`bounding`] sphere.

pub mod barzel;
pub mod bounding;
mod cells;
#[cfg(test)]
mod check;
pub mod choice;
pub mod distant;
pub mod environment;
pub mod goniometric;
pub mod point;
pub mod projection;
pub mod shares;
pub mod sky;
pub mod spot;
pub mod sun;
pub mod superellipse;

use glam::DVec3;

pub mod area;

use super::ray::{Ray, Towards};
use super::shape::Bounds;

/// A light without a surface. All slices have one element per band.
pub trait Light: std::fmt::Debug + Send + Sync {
    /// Draws a direction from the point `from` towards the light from three uniform numbers, and writes what arrives from there if
    /// nothing is in between: radiance for a light of some extent; for a Dirac light the irradiance on a surface that faces it
    /// (I/r² of a point, E of a distant light), in W/(m²·nm) or, in a line band, W/m². `None` where the light does not shine.
    fn sample_towards(&self, from: DVec3, u: [f64; 3], arriving: &mut [f64]) -> Option<Towards>;

    /// The density per solid angle with which [`Light::sample_towards`] draws `direction` from `from`; 0 for Dirac lights.
    fn pdf_towards(&self, from: DVec3, direction: DVec3) -> f64 {
        let _ = (from, direction);
        0.0
    }

    /// Adds the radiance that a ray which leaves the scene in `direction` (unit, away from the scene) meets; Dirac lights add none.
    fn add_radiance(&self, direction: DVec3, radiance: &mut [f64]) {
        let _ = (direction, radiance);
    }

    /// Draws a ray of the light that it sends out, from five uniform numbers, and writes flux / pdf per band, W/nm or W: the mean over
    /// draws is the light's whole flux (for a light at infinity: the flux through the scene's bounding sphere). `None`: a draw of zero flux.
    fn emit(&self, u: [f64; 5], flux: &mut [f64]) -> Option<Ray>;

    /// The density with which [`Light::emit`] draws the ray that comes to the point `from` from `direction` (unit, towards the light) and
    /// `distance` metres away: per area across the ray, 1/m², and for a light of some extent per solid angle as well, 1/(m² sr). It weighs
    /// the ways of finding a path against each other, so that a close figure will do; 0 is always right, and says that rays of
    /// [`Light::emit`] are not to be relied on.
    fn emission_density(&self, from: DVec3, direction: DVec3, distance: f64) -> f64 {
        let _ = (from, direction, distance);
        0.0
    }

    /// Writes the whole radiant flux per band, W/nm or W; for a light at infinity that through the scene's bounding sphere.
    fn flux(&self, flux: &mut [f64]);

    /// A bound on the irradiance that it can make on a surface near `from`, summed over the bands, to choose between lights; any
    /// positive figure is right (infinite at a point light itself), a close one makes less noise.
    fn importance(&self, from: DVec3) -> f64;

    /// Whether any of its light may come to a point of a box, whatever stands between; `true` where that is not known.
    fn can_reach(&self, bounds: &Bounds) -> bool {
        let _ = bounds;
        true
    }

    /// Whether it reaches every point from one direction, so that what arrives is known in closed form and none has to be drawn.
    fn is_one_direction(&self) -> bool {
        false
    }

    /// Whether the same radiance comes from it from all directions, to every point.
    fn is_uniform(&self) -> bool {
        false
    }

    /// Whether anything may stand between it and what it lights; a production light may shine through.
    fn casts_shadows(&self) -> bool {
        true
    }

    /// Whether it travels as light does, so that the rays of [`Light::emit`] stand for it; a production light may not.
    fn emits_what_arrives(&self) -> bool {
        true
    }
}

/// Why a light was refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number out of its range.
    #[error("{what} of {found}; expected {expected}")]
    Value {
        /// Which, with its article and unit.
        what: &'static str,
        /// Its value.
        found: f64,
        /// Its range.
        expected: &'static str,
    },
    /// A vector without direction.
    #[error("{what} without a direction; expected a vector of some length")]
    Direction {
        /// Which.
        what: &'static str,
    },
    /// A Type B table of one plane.
    #[error("a Type B table of one plane, which does not say how far it reaches; expected two planes or more")]
    OnePlane,
    /// Slices that do not belong together.
    #[error("{found} {what}; expected {expected}")]
    Count {
        /// What was counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many are needed.
        expected: usize,
    },
}

/// A spectral value of a light as it keeps it: finite, not negative.
fn sound(what: &'static str, values: &[f64]) -> Result<Box<[f64]>, Error> {
    match values.iter().find(|v| !(v.is_finite() && **v >= 0.0)) {
        Some(found) => Err(Error::Value { what, found: *found, expected: "0 or more, finite" }),
        None => Ok(values.into()),
    }
}

/// A number of a light, where it is in its range.
fn within(what: &'static str, found: f64, sound: bool, expected: &'static str) -> Result<f64, Error> {
    if sound && found.is_finite() { Ok(found) } else { Err(Error::Value { what, found, expected }) }
}

/// A position, where it is finite.
fn placed(what: &'static str, position: DVec3) -> Result<DVec3, Error> {
    match position.to_array().into_iter().find(|x| !x.is_finite()) {
        Some(found) => Err(Error::Value { what, found, expected: "finite coordinates" }),
        None => Ok(position),
    }
}

/// The unit vector of a direction.
fn unit(what: &'static str, direction: DVec3) -> Result<DVec3, Error> {
    // Scaled first: the square of a very short or long vector is no number.
    let scale = direction.abs().max_element();
    if scale > 0.0 && direction.is_finite() {
        Ok((direction / scale).normalize())
    } else {
        Err(Error::Direction { what })
    }
}

/// Writes `factor` times the values.
fn write(out: &mut [f64], values: &[f64], factor: f64) {
    for (out, value) in out.iter_mut().zip(values) {
        *out = factor * value;
    }
}

/// Adds `factor` times the values.
fn add(out: &mut [f64], values: &[f64], factor: f64) {
    for (out, value) in out.iter_mut().zip(values) {
        *out += factor * value;
    }
}

/// The way from a point to a point light: unit direction, distance, 1/r²; `None` where they coincide, or so nearly that 1/r² is
/// beyond the largest number.
fn way(from: DVec3, to: DVec3) -> Option<(DVec3, f64, f64)> {
    let way = to - from;
    let distance = way.length();
    let inverse_square = 1.0 / distance / distance;
    (distance > 0.0 && inverse_square.is_finite()).then(|| (way / distance, distance, inverse_square))
}

/// [`Light::importance`] of a point light of so many times the intensities: infinite at the light itself, never NaN.
fn near_bound(intensity: &[f64], relative: f64, from: DVec3, position: DVec3) -> f64 {
    relative * intensity.iter().sum::<f64>() / from.distance_squared(position).max(f64::MIN_POSITIVE)
}

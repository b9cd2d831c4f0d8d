//! Spots: point lights with an axis.
//!
//! | profile | intensity at the angle α to the axis | flux |
//! |---|---|---|
//! | cosine | I₀ cos α before it, 0 behind | π I₀ |
//! | cone | I₀ for α < τ, 0 beyond | 2π I₀ (1 − cos τ) = 4π I₀ sin²(τ/2) |
//!
//! Parameters: position (m); axis; I₀ per band, W/(sr·nm) or W/sr; the cone's half-angle τ, 0 < τ ≤ π rad.
//!
//! Limits: those of a point; the cone's edge is hard. A cone as narrow as 1e-6 rad keeps its flux and its edge: angles are compared
//! by chords, not by cosines, which are all 1 there.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::{Error, Light, near_bound, placed, sound, unit, way, within, write};
use crate::geometry::direction::tangents;
use crate::math::sampling::{cone, cosine_hemisphere};
use crate::render::ray::{Ray, Towards};
use crate::render::shape::Bounds;

/// How the intensity falls off the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Profile {
    /// With the cosine, like a small Lambertian surface.
    Cosine,
    /// Constant within a half-angle.
    Cone {
        /// τ, rad, above 0 to π.
        half_angle_rad: f64,
    },
}

/// A spot.
#[derive(Debug, Clone, PartialEq)]
pub struct Spot {
    position: DVec3,
    axis: DVec3,
    /// 1 − cos τ of the cone; 0 for the cosine.
    depth: f64,
    intensity: Box<[f64]>,
}

impl Spot {
    /// Of an intensity I₀ per band on the axis, W/(sr·nm) or W/sr, 0 or more; `axis` is where it shines, of any length.
    ///
    /// # Errors
    /// [`Error::Value`], [`Error::Direction`].
    pub fn new(position: DVec3, axis: DVec3, profile: Profile, intensity: &[f64]) -> Result<Self, Error> {
        let depth = match profile {
            Profile::Cosine => 0.0,
            Profile::Cone { half_angle_rad: tau } => {
                // Below 1e-150 the square of the angle is no number.
                let sound = tau > 1e-150 && tau <= PI;
                let tau = within("a half-angle (rad)", tau, sound, "above 0 to π")?;
                2.0 * (0.5 * tau).sin().powi(2)
            }
        };
        let position = placed("a coordinate of a spot (m)", position)?;
        let axis = unit("an axis of a spot", axis)?;
        Ok(Self { position, axis, depth, intensity: sound("an intensity (W/(sr nm))", intensity)? })
    }

    /// The same with a flux per band, W/nm or W, in place of the intensity.
    ///
    /// # Errors
    /// [`Error::Value`], [`Error::Direction`].
    pub fn from_flux(position: DVec3, axis: DVec3, profile: Profile, flux: &[f64]) -> Result<Self, Error> {
        let mut spot = Self::new(position, axis, profile, flux)?;
        let solid_angle = spot.solid_angle();
        let intensity: Vec<f64> = flux.iter().map(|f| f / solid_angle).collect();
        spot.intensity = sound("an intensity (W/(sr nm))", &intensity)?;
        Ok(spot)
    }

    /// Intensity over I₀ in a direction (unit).
    fn relative(&self, direction: DVec3) -> f64 {
        if self.depth == 0.0 {
            direction.dot(self.axis).max(0.0)
        } else {
            // The square of the chord is 2 (1 − cos α).
            f64::from(u8::from(0.5 * direction.distance_squared(self.axis) < self.depth || self.depth >= 2.0))
        }
    }

    /// Flux over I₀, sr.
    fn solid_angle(&self) -> f64 {
        if self.depth == 0.0 { PI } else { TAU * self.depth }
    }
}

impl Light for Spot {
    fn can_reach(&self, bounds: &Bounds) -> bool {
        // A cone of more than a half space reaches behind.
        self.depth > 1.0 || bounds.reach_before(self.position, self.axis)
    }

    fn sample_towards(&self, from: DVec3, _: [f64; 3], arriving: &mut [f64]) -> Option<Towards> {
        let (direction, distance, inverse_square) = way(from, self.position)?;
        let relative = self.relative(-direction);
        write(arriving, &self.intensity, relative * inverse_square);
        (relative > 0.0).then_some(Towards { direction, distance, pdf: 1.0, delta: true })
    }

    fn emit(&self, [u, v, ..]: [f64; 5], flux: &mut [f64]) -> Option<Ray> {
        // Both are drawn in proportion to the intensity, so that every ray carries the whole flux.
        let local = if self.depth == 0.0 { cosine_hemisphere([u, v]) } else { cone([u, v], self.depth) };
        let (x, y) = tangents(self.axis);
        self.flux(flux);
        Some(Ray { origin: self.position, direction: local.x * x + local.y * y + local.z * self.axis })
    }

    fn emission_density(&self, _: DVec3, direction: DVec3, distance: f64) -> f64 {
        self.relative(-direction) / self.solid_angle() / distance / distance
    }

    fn is_one_direction(&self) -> bool {
        true
    }

    fn flux(&self, flux: &mut [f64]) {
        write(flux, &self.intensity, self.solid_angle());
    }

    fn importance(&self, from: DVec3) -> f64 {
        let relative = way(from, self.position).map_or(1.0, |(direction, ..)| self.relative(-direction));
        near_bound(&self.intensity, relative, from, self.position)
    }
}

#[cfg(test)]
mod tests {
    use super::super::check;
    use super::*;

    const HERE: DVec3 = DVec3::new(0.5, -1.0, 2.0);
    const AXIS: DVec3 = DVec3::new(1.0, 2.0, -2.0);

    /// πI₀ and 2πI₀(1 − cos τ).
    #[test]
    fn fluxes_are_the_closed_forms() {
        let flux = |profile| {
            let mut flux = [0.0];
            Spot::new(HERE, AXIS, profile, &[7.0]).expect("a spot").flux(&mut flux);
            flux[0]
        };
        assert!((flux(Profile::Cosine) - 7.0 * PI).abs() < 1e-14);
        for tau in [0.1, 1.0, PI] {
            let expected = TAU * 7.0 * (1.0 - f64::cos(tau));
            assert!((flux(Profile::Cone { half_angle_rad: tau }) / expected - 1.0).abs() < 1e-13, "{tau}");
        }
        // π I₀ τ² (1 − τ²/12): for a needle the series is exact.
        let needle = flux(Profile::Cone { half_angle_rad: 1e-6 });
        assert!((needle / (7.0 * PI * 1e-12) - 1.0).abs() < 1e-12, "{needle}");
    }

    #[test]
    fn emission_is_the_flux_and_the_intensity() {
        for profile in [Profile::Cosine, Profile::Cone { half_angle_rad: 0.4 }, Profile::Cone { half_angle_rad: 2.5 }] {
            let light = Spot::from_flux(HERE, AXIS, profile, &[2.0, 3.0]).expect("a spot");
            check::emission(&light, 2);
            let axis = AXIS.normalize();
            check::emitted_intensity(&light, HERE, |d| match profile {
                Profile::Cosine => 2.0 / PI * d.dot(axis).max(0.0),
                Profile::Cone { half_angle_rad: tau } => {
                    if d.dot(axis).acos() < tau {
                        2.0 / (TAU * (1.0 - tau.cos()))
                    } else {
                        0.0
                    }
                }
            });
        }
    }

    /// I₀ cos α cosθ / r² with all three in the plane: at (3, 4, 0) below a spot at 12 m that looks down, α = θ = acos(12/13).
    #[test]
    fn irradiance_has_both_cosines() {
        let light = Spot::new(DVec3::new(0.0, 0.0, 12.0), DVec3::NEG_Z, Profile::Cosine, &[169.0]).expect("a spot");
        let e = check::irradiance_at(&light, DVec3::new(3.0, 4.0, 0.0), DVec3::Z)[0];
        assert!((e - (12.0_f64 / 13.0).powi(2)).abs() < 1e-14, "{e}");
        assert_eq!(light.sample_towards(DVec3::new(0.0, 0.0, 13.0), [0.5; 3], &mut [0.0]), None);
    }

    #[test]
    fn the_edge_of_a_needle_is_where_it_belongs() {
        for (tau, far) in [(1e-6, 1e8), (1e-6, 1.0), (1e-3, 1e-8), (0.5, 1.0)] {
            let light =
                Spot::new(DVec3::ZERO, DVec3::X, Profile::Cone { half_angle_rad: tau }, &[1.0]).expect("a spot");
            let at = |alpha: f64| far * DVec3::new(alpha.cos(), 0.6 * alpha.sin(), 0.8 * alpha.sin());
            let sees = |alpha| light.sample_towards(at(alpha), [0.5; 3], &mut [0.0]).is_some();
            assert!(sees(tau * (1.0 - 1e-9)) && !sees(tau * (1.0 + 1e-9)), "{tau} {far}");
            let ray = light.emit([1.0, 0.5, 0.0, 0.0, 0.0], &mut [0.0]).expect("a ray");
            let sin = ray.direction.cross(DVec3::X).length();
            assert!((sin / tau.sin() - 1.0).abs() < 1e-9, "{tau}: {sin}");
        }
    }

    #[test]
    fn bad_values_are_refused() {
        let cone = |tau| Spot::new(HERE, AXIS, Profile::Cone { half_angle_rad: tau }, &[1.0]);
        assert!(cone(0.0).is_err() && cone(3.2).is_err() && cone(f64::NAN).is_err());
        assert_eq!(
            Spot::new(HERE, DVec3::ZERO, Profile::Cosine, &[1.0]),
            Err(Error::Direction { what: "an axis of a spot" })
        );
    }
}

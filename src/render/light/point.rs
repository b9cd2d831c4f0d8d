//! An isotropic point light: the same intensity in every direction.
//!
//! ```text
//! I = Φ/(4π)      E = I cosθ / r² = Φ cosθ / (4π r²)
//! ```
//!
//! Parameters: position (m); intensity per band, W/(sr·nm) (W/sr in a line band), or flux per band, W/nm (W).
//!
//! Limits: no extent, so its shadows are sharp and no camera or mirror shows it; E grows beyond bounds towards the point, and at the
//! point itself nothing arrives.
//!
//! Source: CIE S 017:2020, 17-21-045 (radiant intensity), 17-21-085 (the photometric distance law).

use std::f64::consts::PI;

use glam::DVec3;

use super::{Error, Light, near_bound, placed, sound, way, write};
use crate::math::sampling::cone;
use crate::render::ray::{Ray, Towards};

/// An isotropic point light.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    position: DVec3,
    intensity: Box<[f64]>,
}

impl Point {
    /// Of an intensity per band, W/(sr·nm) or W/sr, 0 or more.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn new(position: DVec3, intensity: &[f64]) -> Result<Self, Error> {
        let position = placed("a coordinate of a point light (m)", position)?;
        Ok(Self { position, intensity: sound("an intensity (W/(sr nm))", intensity)? })
    }

    /// Of a flux per band, W/nm or W, 0 or more.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn from_flux(position: DVec3, flux: &[f64]) -> Result<Self, Error> {
        let intensity: Vec<f64> = flux.iter().map(|f| f / (4.0 * PI)).collect();
        Self::new(position, &intensity)
    }
}

impl Light for Point {
    fn sample_towards(&self, from: DVec3, _: [f64; 3], arriving: &mut [f64]) -> Option<Towards> {
        let (direction, distance, inverse_square) = way(from, self.position)?;
        write(arriving, &self.intensity, inverse_square);
        Some(Towards { direction, distance, pdf: 1.0, delta: true })
    }

    fn emit(&self, [u, v, ..]: [f64; 5], flux: &mut [f64]) -> Option<Ray> {
        self.flux(flux);
        Some(Ray { origin: self.position, direction: cone([u, v], 2.0) })
    }

    fn emission_density(&self, _: DVec3, _: DVec3, distance: f64) -> f64 {
        1.0 / (4.0 * PI) / distance / distance
    }

    fn is_one_direction(&self) -> bool {
        true
    }

    fn flux(&self, flux: &mut [f64]) {
        write(flux, &self.intensity, 4.0 * PI);
    }

    fn importance(&self, from: DVec3) -> f64 {
        near_bound(&self.intensity, 1.0, from, self.position)
    }
}

#[cfg(test)]
mod tests {
    use super::super::check;
    use super::*;

    /// `point_I1000_h2_*` and `isotropic_10000lm_I`: E = I h/(h² + r²)^1.5, I = Φ/4π; the values are the closed forms, printed to all
    /// digits.
    #[test]
    fn irradiance_is_that_of_the_closed_forms() {
        let light = Point::new(DVec3::new(0.0, 0.0, 2.0), &[1000.0, 0.0]).expect("a light");
        for (r, expected) in [(0.0, 250.0), (1.0, 178.885_438_199_983_16), (3.0, 42.669_245_863_479_16)] {
            let e = check::irradiance_at(&light, DVec3::new(r, 0.0, 0.0), DVec3::Z);
            assert!((e[0] / expected - 1.0).abs() < 1e-14 && e[1] == 0.0, "{r}: {e:?}");
        }
        let light = Point::from_flux(DVec3::ZERO, &[10_000.0]).expect("a light");
        let e = check::irradiance_at(&light, DVec3::X, DVec3::NEG_X);
        assert!((e[0] / 795.774_715_459_476_7 - 1.0).abs() < 1e-14, "{e:?}");
    }

    #[test]
    fn emission_is_the_flux_in_every_direction_alike() {
        let light = Point::from_flux(DVec3::new(1.0, 2.0, 3.0), &[3.0, 5.0]).expect("a light");
        check::emission(&light, 2);
        check::emitted_intensity(&light, DVec3::new(1.0, 2.0, 3.0), |_| 3.0 / (4.0 * PI));
    }

    #[test]
    fn the_square_law_holds_from_1e_8_to_1e8_metres() {
        for exponent in -8..=8 {
            let r = 10.0_f64.powi(exponent);
            let light = Point::new(DVec3::new(0.0, 0.6 * r, 0.8 * r), &[2.0]).expect("a light");
            let e = check::irradiance_at(&light, DVec3::ZERO, DVec3::Z)[0];
            assert!((e * r * r / 1.6 - 1.0).abs() < 1e-14, "{r}: {e}");
            assert!(light.importance(DVec3::ZERO).is_finite());
        }
    }

    #[test]
    fn nothing_arrives_at_the_point_itself_and_bad_values_are_refused() {
        let light = Point::new(DVec3::ZERO, &[1.0]).expect("a light");
        assert_eq!(light.sample_towards(DVec3::ZERO, [0.5; 3], &mut [0.0]), None);
        assert_eq!(light.sample_towards(DVec3::splat(1e-200), [0.5; 3], &mut [0.0]), None);
        assert!(Point::new(DVec3::NAN, &[1.0]).is_err());
        assert!(Point::new(DVec3::ZERO, &[-1.0]).is_err() && Point::new(DVec3::ZERO, &[f64::INFINITY]).is_err());
    }
}

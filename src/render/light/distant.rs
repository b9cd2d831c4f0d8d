//! A distant light: parallel light from one direction, or from a disc in the sky such as the sun's.
//!
//! With E the irradiance on a surface that faces the light and τ the disc's angular radius,
//!
//! ```text
//! L = E / (π sin²τ)      Ω = 2π (1 − cos τ)      Φ = π R² L Ω  (through the scene's bounding sphere; π R² E without extent)
//! ```
//!
//! Parameters: direction towards the light; E per band, W/(m²·nm) or W/m²; τ, 0 (parallel) to π/2 rad; the scene's bounding sphere.
//!
//! Limits: the disc is uniform, the sun's limb is not darker than its middle. Nothing changes over the scene.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::bounding::BoundingSphere;
use super::{Error, Light, add, sound, unit, within, write};
use crate::geometry::direction::tangents;
use crate::math::sampling::cone;
use crate::render::ray::{Ray, Towards};

/// A distant light.
#[derive(Debug, Clone, PartialEq)]
pub struct Distant {
    direction: DVec3,
    /// 1 − cos τ; 0 for parallel light.
    depth: f64,
    /// Irradiance on a facing surface.
    irradiance: Box<[f64]>,
    /// Radiance of the disc over that irradiance, 1/sr; 0 for parallel light.
    radiance_per_irradiance: f64,
    scene: BoundingSphere,
}

impl Distant {
    /// From `towards_light` (of any length), with an angular radius in rad, 0 to π/2, that makes the irradiance per band, W/(m²·nm)
    /// or W/m², on a surface that faces it.
    ///
    /// # Errors
    /// [`Error::Value`], [`Error::Direction`].
    pub fn new(
        towards_light: DVec3,
        angular_radius_rad: f64,
        irradiance: &[f64],
        scene: BoundingSphere,
    ) -> Result<Self, Error> {
        let tau = angular_radius_rad;
        // Smaller than 1e-150 the square of the angle is no number.
        let sound_radius = tau == 0.0 || (tau > 1e-150 && tau <= FRAC_PI_2);
        let tau = within("an angular radius (rad)", tau, sound_radius, "0 to π/2")?;
        Ok(Self {
            direction: unit("a distant light", towards_light)?,
            depth: 2.0 * (0.5 * tau).sin().powi(2),
            irradiance: sound("an irradiance (W/(m2 nm))", irradiance)?,
            radiance_per_irradiance: if tau == 0.0 { 0.0 } else { 1.0 / (PI * tau.sin().powi(2)) },
            scene,
        })
    }

    /// Whether a direction (unit) lies in the disc.
    fn sees(&self, direction: DVec3) -> bool {
        0.5 * direction.distance_squared(self.direction) < self.depth
    }

    /// A direction towards the light, and its density, 1/sr: 1 for parallel light.
    fn draw(&self, u: [f64; 2]) -> (DVec3, f64) {
        if self.depth == 0.0 {
            return (self.direction, 1.0);
        }
        let (x, y) = tangents(self.direction);
        let local = cone(u, self.depth);
        (local.x * x + local.y * y + local.z * self.direction, 1.0 / (TAU * self.depth))
    }
}

impl Light for Distant {
    fn sample_towards(&self, _: DVec3, [u, v, _]: [f64; 3], arriving: &mut [f64]) -> Option<Towards> {
        let delta = self.depth == 0.0;
        write(arriving, &self.irradiance, if delta { 1.0 } else { self.radiance_per_irradiance });
        let (direction, pdf) = self.draw([u, v]);
        Some(Towards { direction, distance: f64::INFINITY, pdf, delta })
    }

    fn pdf_towards(&self, _: DVec3, direction: DVec3) -> f64 {
        if self.sees(direction) { 1.0 / (TAU * self.depth) } else { 0.0 }
    }

    fn add_radiance(&self, direction: DVec3, radiance: &mut [f64]) {
        if self.sees(direction) {
            add(radiance, &self.irradiance, self.radiance_per_irradiance);
        }
    }

    fn emit(&self, [u, v, s, t, _]: [f64; 5], flux: &mut [f64]) -> Option<Ray> {
        self.flux(flux);
        Some(self.scene.ray_from(self.draw([u, v]).0, [s, t]))
    }

    fn emission_density(&self, from: DVec3, direction: DVec3, _: f64) -> f64 {
        let per_solid_angle = if self.depth == 0.0 { 1.0 } else { self.pdf_towards(from, direction) };
        per_solid_angle * self.scene.density_at(from, direction)
    }

    fn is_one_direction(&self) -> bool {
        self.depth == 0.0
    }

    fn flux(&self, flux: &mut [f64]) {
        let over_irradiance = if self.depth == 0.0 { 1.0 } else { self.radiance_per_irradiance * TAU * self.depth };
        write(flux, &self.irradiance, over_irradiance * self.scene.cross_section());
    }

    fn importance(&self, _: DVec3) -> f64 {
        self.irradiance.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::check;
    use super::*;

    const TOWARDS: DVec3 = DVec3::new(2.0, -1.0, 2.0);
    /// Half of 0.533°.
    const SUN_RAD: f64 = 0.5 * 0.533 * PI / 180.0;

    fn scene() -> BoundingSphere {
        BoundingSphere::new(DVec3::new(3.0, 0.0, 1.0), 2.0).expect("a sphere")
    }

    #[test]
    fn parallel_light_follows_the_cosine_law() {
        let light = Distant::new(TOWARDS, 0.0, &[900.0], scene()).expect("a light");
        let e = check::irradiance_at(&light, DVec3::ZERO, DVec3::Z)[0];
        assert!((e - 600.0).abs() < 1e-12, "{e}");
        let mut flux = [0.0];
        light.flux(&mut flux);
        assert!((flux[0] / (900.0 * PI * 4.0) - 1.0).abs() < 1e-15);
        check::emission(&light, 1);
        let mut none = [0.0];
        light.add_radiance(TOWARDS / 3.0, &mut none);
        assert_eq!((none, light.pdf_towards(DVec3::ZERO, TOWARDS / 3.0)), ([0.0], 0.0));
    }

    #[test]
    fn discs_make_the_irradiance_they_are_given() {
        for tau in [1e-6, SUN_RAD, 0.3, FRAC_PI_2] {
            let light = Distant::new(TOWARDS, tau, &[5.0, 8.0], scene()).expect("a light");
            check::density(&light, DVec3::ZERO, TOWARDS / 3.0, 2.0 * (0.5 * tau).sin().powi(2), 4);
            check::emission(&light, 2);
            check::irradiance(&light, DVec3::ZERO, TOWARDS / 3.0, 5.0);
        }
    }

    /// A uniform disc of 2·10⁹ cd/m² and 0.533° is the sun of the tables: L π sin²τ = 1.36·10⁵ lx.
    #[test]
    fn the_sun_is_two_thousand_million_nit() {
        let lux = 2e9 * PI * SUN_RAD.sin().powi(2);
        let light = Distant::new(DVec3::Z, SUN_RAD, &[lux], scene()).expect("a light");
        let mut radiance = [0.0];
        light.add_radiance(DVec3::Z, &mut radiance);
        assert!((radiance[0] / 2e9 - 1.0).abs() < 1e-14, "{radiance:?}");
        light.add_radiance(DVec3::new(0.99 * SUN_RAD.sin(), 0.0, (0.99 * SUN_RAD).cos()).normalize(), &mut radiance);
        light.add_radiance(DVec3::new(1.01 * SUN_RAD.sin(), 0.0, (1.01 * SUN_RAD).cos()).normalize(), &mut radiance);
        assert!((radiance[0] / 4e9 - 1.0).abs() < 1e-14, "{radiance:?}");
    }

    #[test]
    fn bad_values_are_refused() {
        assert!(Distant::new(DVec3::ZERO, 0.0, &[1.0], scene()).is_err());
        assert!(Distant::new(DVec3::Z, 1.6, &[1.0], scene()).is_err());
        assert!(Distant::new(DVec3::Z, -0.1, &[1.0], scene()).is_err());
        assert!(Distant::new(DVec3::new(0.0, 0.0, 1e-300), 0.1, &[f64::NAN], scene()).is_err());
    }
}

//! An emitting surface as a light: directions drawn towards its shape.

use std::sync::Arc;

use glam::DVec3;

use super::Light;
use crate::geometry::direction;
use crate::math::sampling;
use crate::render::emission::Emission;
use crate::render::ray::{Ray, Towards};
use crate::render::shape::Shape;

/// A shape that emits.
#[derive(Debug, Clone)]
pub struct AreaLight {
    shape: Arc<dyn Shape>,
    emission: Arc<Emission>,
    /// Σ over the bands of the radiance along the normal.
    brightness: f64,
}

impl AreaLight {
    /// The light of a shape of finite area.
    #[must_use]
    pub fn new(shape: Arc<dyn Shape>, emission: Arc<Emission>) -> Self {
        let brightness = emission.radiance().iter().sum();
        Self { shape, emission, brightness }
    }

    /// The shape.
    #[must_use]
    pub fn shape(&self) -> &dyn Shape {
        self.shape.as_ref()
    }
}

impl Light for AreaLight {
    fn sample_towards(&self, from: DVec3, u: [f64; 3], arriving: &mut [f64]) -> Option<Towards> {
        let towards = self.shape.sample_towards(from, u)?;
        let ray = Ray { origin: from, direction: towards.direction };
        // The point that was drawn lies within rounding of the crossing found here, which gives the normal it is seen under.
        let crossing = self.shape.cross(&ray, 0.0, f64::INFINITY)?;
        let point = self.shape.surface(&ray, &crossing);
        let profile = self.emission.profile(-point.normal.dot(towards.direction));
        if profile == 0.0 {
            return None;
        }
        for (a, l) in arriving.iter_mut().zip(self.emission.radiance()) {
            *a = l * profile;
        }
        Some(Towards { distance: crossing.t, ..towards })
    }

    fn pdf_towards(&self, from: DVec3, direction: DVec3) -> f64 {
        let ray = Ray { origin: from, direction };
        let point = self.shape.cross(&ray, 0.0, f64::INFINITY).map(|crossing| self.shape.surface(&ray, &crossing));
        point.map_or(0.0, |point| self.shape.pdf_towards(from, &point))
    }

    fn emit(&self, u: [f64; 5], flux: &mut [f64]) -> Option<Ray> {
        let (back, turned) = if self.emission.is_two_sided() { sampling::split(u[3], 0.5) } else { (false, u[3]) };
        let point = self.shape.sample_area([u[0], u[1], u[2]]);
        let local = sampling::cosine_power([turned, u[4]], self.emission.power() + 1.0);
        let normal = if back { -point.normal } else { point.normal };
        let (t, b) = direction::tangents(normal);
        let direction = local.x * t + local.y * b + local.z * normal;
        // Density: 1/A over the area, (p + 2)/(2π) cosᵖ⁺¹θ over a side, so that L cosθ / pdf is the flux itself.
        let weight = self.shape.area() * self.emission.exitance_per_radiance();
        for (f, l) in flux.iter_mut().zip(self.emission.radiance()) {
            *f = l * weight;
        }
        Some(Ray { origin: point.origin_towards(direction), direction })
    }

    fn flux(&self, flux: &mut [f64]) {
        let weight = self.shape.area() * self.emission.exitance_per_radiance();
        for (f, l) in flux.iter_mut().zip(self.emission.radiance()) {
            *f = l * weight;
        }
    }

    fn importance(&self, from: DVec3) -> f64 {
        let bounds = self.shape.bounds();
        let nearest = from.clamp(bounds.min, bounds.max);
        let reach = (bounds.max - bounds.min).length_squared() / 4.0;
        // Solid angle of a shape of area A, bounded by the hemisphere that it can fill.
        let squared = from.distance_squared(nearest).max(reach).max(f64::MIN_POSITIVE);
        self.brightness * (self.shape.area() / squared).min(std::f64::consts::TAU)
    }
}

//! An emitting surface as a light: directions drawn towards its shape.

use std::sync::Arc;

use glam::DVec3;

use super::Light;
use crate::geometry::direction;
use crate::math::sampling;
use crate::render::emission::Emission;
use crate::render::ray::{Ray, Towards};
use crate::render::shape::{Bounds, Shape};

/// A shape that emits.
#[derive(Debug, Clone)]
pub struct AreaLight {
    shape: Arc<dyn Shape>,
    emission: Arc<Emission>,
    /// Σ over the bands of the radiance along the normal.
    brightness: f64,
    /// Of the shape.
    bounds: Bounds,
    /// Of the shape, m².
    area: f64,
}

impl AreaLight {
    /// The light of a shape of finite area.
    #[must_use]
    pub fn new(shape: Arc<dyn Shape>, emission: Arc<Emission>) -> Self {
        let brightness = emission.radiance().iter().sum();
        let (bounds, area) = (shape.bounds(), shape.area());
        Self { shape, emission, brightness, bounds, area }
    }

    /// The shape.
    #[must_use]
    pub fn shape(&self) -> &dyn Shape {
        self.shape.as_ref()
    }
}

impl Light for AreaLight {
    fn can_reach(&self, bounds: &Bounds) -> bool {
        let both = self.emission.is_two_sided() || self.emission.lamp().is_some();
        self.brightness > 0.0
            && self.shape.facing().filter(|_| !both).is_none_or(|normal| {
                let anchor = self.shape.sample_area([0.5; 3]).position;
                bounds.reach_before(anchor, normal)
            })
    }

    fn sample_towards(&self, from: DVec3, u: [f64; 3], arriving: &mut [f64]) -> Option<Towards> {
        let mut towards = self.shape.sample_towards(from, u)?;
        let normal = if let Some(normal) = self.shape.facing() {
            normal
        } else {
            let ray = Ray { origin: from, direction: towards.direction };
            // The point that was drawn lies within rounding of the crossing found here, which gives the normal it is seen under.
            let crossing = self.shape.cross(&ray, 0.0, f64::INFINITY)?;
            // A shape may hide the point that was drawn behind another part of itself.
            if crossing.t < towards.distance * (1.0 - 1e-6) {
                return None;
            }
            towards.distance = crossing.t;
            self.shape.surface(&ray, &crossing).normal
        };
        let away = -towards.direction;
        let profile = self.emission.profile_towards(away, normal.dot(away));
        if profile == 0.0 {
            return None;
        }
        for (a, l) in arriving.iter_mut().zip(self.emission.radiance()) {
            *a = l * profile;
        }
        Some(towards)
    }

    fn pdf_towards(&self, from: DVec3, direction: DVec3) -> f64 {
        let ray = Ray { origin: from, direction };
        let point = self.shape.cross(&ray, 0.0, f64::INFINITY).map(|crossing| self.shape.surface(&ray, &crossing));
        point.map_or(0.0, |point| self.shape.pdf_towards(from, &point))
    }

    fn emit(&self, u: [f64; 5], flux: &mut [f64]) -> Option<Ray> {
        if let Some(lamp) = self.emission.lamp() {
            let direction = lamp.emit([u[3], u[4], 0.0, 0.0, 0.0], flux)?.direction;
            let point = self.shape.sample_area([u[0], u[1], u[2]]);
            return Some(Ray { origin: point.origin_towards(direction), direction });
        }
        let (back, turned) = if self.emission.is_two_sided() { sampling::split(u[3], 0.5) } else { (false, u[3]) };
        let point = self.shape.sample_area([u[0], u[1], u[2]]);
        let local = sampling::cosine_power([turned, u[4]], self.emission.power() + 1.0);
        let normal = if back { -point.normal } else { point.normal };
        let (t, b) = direction::tangents(normal);
        let direction = local.x * t + local.y * b + local.z * normal;
        // Density: 1/A over the area, (p + 2)/(2π) cosᵖ⁺¹θ over a side, so that L cosθ / pdf is the flux itself.
        let weight = self.area * self.emission.exitance_per_radiance();
        for (f, l) in flux.iter_mut().zip(self.emission.radiance()) {
            *f = l * weight;
        }
        Some(Ray { origin: point.origin_towards(direction), direction })
    }

    fn emission_density(&self, from: DVec3, direction: DVec3, _: f64) -> f64 {
        let normal = self.shape.facing().or_else(|| {
            let ray = Ray { origin: from, direction };
            let crossing = self.shape.cross(&ray, 0.0, f64::INFINITY)?;
            Some(self.shape.surface(&ray, &crossing).normal)
        });
        let profile = normal.map_or(0.0, |n| self.emission.profile_towards(-direction, n.dot(-direction)));
        let exitance = self.emission.exitance_per_radiance();
        // L/Φ: rays are drawn as the light shines.
        if exitance > 0.0 { profile / (exitance * self.area) } else { 0.0 }
    }

    fn flux(&self, flux: &mut [f64]) {
        let weight = self.area * self.emission.exitance_per_radiance();
        for (f, l) in flux.iter_mut().zip(self.emission.radiance()) {
            *f = l * weight;
        }
    }

    fn importance(&self, from: DVec3) -> f64 {
        let nearest = from.clamp(self.bounds.min, self.bounds.max);
        let reach = (self.bounds.max - self.bounds.min).length_squared() / 4.0;
        // Solid angle of a shape of area A, bounded by the hemisphere that it can fill.
        let squared = from.distance_squared(nearest).max(reach).max(f64::MIN_POSITIVE);
        self.brightness * (self.area / squared).min(std::f64::consts::TAU)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;
    use crate::render::shape::cylinder::Cylinder;

    /// The irradiance by draws is that by rays counted over the sphere, also where the near side of a tube hides the far one.
    #[test]
    fn a_shape_that_hides_itself_is_not_counted_twice() {
        let tube = Cylinder::new(DVec3::ZERO, DVec3::new(0.5, 0.2, 0.8), 0.4, false).expect("a tube");
        let light = AreaLight::new(Arc::new(tube), Arc::new(Emission::new(vec![1.0], 0.0, true)));
        let (from, normal) = (DVec3::new(-2.0, 0.3, 0.9), DVec3::X);
        let (mut stream, draws) = (Stream::new(1, 1), 200_000);
        let mut sums = [[0.0; 2]; 2];
        for _ in 0..draws {
            let mut arriving = [0.0];
            let drawn = light.sample_towards(from, stream.uniforms(), &mut arriving);
            let aimed = drawn.map_or(0.0, |t| arriving[0] * normal.dot(t.direction).max(0.0) / t.pdf);
            let direction = sampling::cosine_hemisphere(stream.uniforms());
            let (t, b) = direction::tangents(normal);
            let ray = Ray { origin: from, direction: direction.x * t + direction.y * b + direction.z * normal };
            let counted = light.shape().cross(&ray, 0.0, f64::INFINITY).map_or(0.0, |_| std::f64::consts::PI);
            for (sum, x) in sums.iter_mut().zip([aimed, counted]) {
                *sum = [sum[0] + x, sum[1] + x * x];
            }
        }
        let n = f64::from(draws);
        let [(aimed, a), (counted, c)] = sums.map(|[s, q]| (s / n, (q / n - (s / n).powi(2)) / n));
        // 4.5 standard errors of the difference.
        assert!((aimed - counted).abs() < 4.5 * (a + c).sqrt(), "{aimed} {counted} {}", (a + c).sqrt());
    }
}

//! What the camera sees along a ray: the first surface that is no mirror and no clear glass.

use std::f64::consts::PI;

use glam::DVec3;

use super::{Edge, PathTracer};
use crate::render::integrator::frame::Frame;
use crate::render::lanes::mean;
use crate::render::material::Transport;
use crate::render::ray::{Ray, SurfacePoint};

/// What is seen along a ray of the camera, without the light that falls on it. Where mirrors or glass show two things, the mean of both by their
/// shares.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sight {
    /// The point, m; 0 of what is beyond the scene.
    pub position: DVec3,
    /// The shading normal on the side that is seen; 0 beyond the scene.
    pub normal: DVec3,
    /// The reflectance where it is diffuse, mean over the bands, else 1; times the factors of textures.
    pub reflectance: f64,
    /// The radiance that it emits, mean over the bands, W/(m²·sr·nm).
    pub emission: f64,
}

impl PathTracer<'_> {
    /// The same, which tells what is seen along the rays of a camera ([`PathTracer::sight`]).
    #[must_use]
    pub fn seeing(self) -> Self {
        Self { sees: true, ..self }
    }

    /// What was seen along the ray of the last sample; the light of the surroundings where there is no surface.
    #[must_use]
    pub fn sight(&self) -> &Sight {
        &self.sight
    }

    /// What is seen along a ray of the camera, without following light; `None` in mirrors and glass.
    pub fn look(&mut self, ray: Ray) -> Option<&Sight> {
        self.sight = Sight::default();
        let edge = Edge { straight: true, ..Edge::first(ray, None, ray.origin) };
        match self.scene.surfaces().closest(&ray, f64::INFINITY) {
            Some((surface, _)) if self.scene.material(surface).is_delta() => return None,
            Some((surface, crossing)) => {
                let point = self.scene.surface_point(surface, &ray, &crossing);
                self.see(&edge, surface, &point);
            }
            None => self.see_beyond(&edge),
        }
        Some(&self.sight)
    }

    /// Notes a surface at the end of an edge. Uses `value` and `arriving`.
    pub(super) fn see(&mut self, edge: &Edge, surface: usize, point: &SurfacePoint) {
        if !edge.straight {
            return;
        }
        let away = -edge.ray.direction;
        if let Some(emission) = self.scene.emission(surface) {
            let profile = emission.profile_towards(away, point.normal.dot(away));
            self.sight.emission += edge.chance * profile * mean(emission.radiance());
        }
        let material = self.scene.material(surface);
        if material.is_delta() {
            return;
        }
        let outgoing = Frame::of(point.shading, point.tangent).local(away);
        self.value.fill(1.0);
        if material.converts() {
            material.convert(point.uv, Transport::Radiance, &mut self.value, &mut self.arriving);
        }
        if material.is_diffuse() {
            let normal = DVec3::new(0.0, 0.0, outgoing.z.signum());
            material.evaluate(normal, outgoing, Transport::Radiance, &mut self.arriving);
            self.value.iter_mut().zip(&self.arriving).for_each(|(v, f)| *v *= PI * f);
        }
        let normal = if outgoing.z < 0.0 { -point.shading } else { point.shading };
        self.sight.position += edge.chance * point.position;
        self.sight.normal += edge.chance * normal;
        self.sight.reflectance += edge.chance * mean(&self.value);
    }

    /// Notes the light that comes from beyond the scene.
    pub(super) fn see_beyond(&mut self, edge: &Edge) {
        if !edge.straight {
            return;
        }
        self.value.fill(0.0);
        self.scene.lights().iter().for_each(|light| light.add_radiance(edge.ray.direction, &mut self.value));
        self.sight.emission += edge.chance * mean(&self.value);
    }
}

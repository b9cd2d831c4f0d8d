//! What a path finds: lights that it meets, lights that are sought from its vertices, virtual lights.

use glam::DVec3;

use super::{Edge, PathTracer, Vertex, multiply};
use crate::render::integrator::frame::Frame;
use crate::render::integrator::virtual_lights::DRAWS;
use crate::render::material::Transport;
use crate::render::ray::{Ray, SurfacePoint};
use crate::render::sampler::Sampler;

impl PathTracer<'_> {
    /// Adds what a ray meets that leaves the scene.
    pub(super) fn escape(&mut self, edge: &Edge) {
        for (index, light) in self.scene.lights().iter().enumerate() {
            self.value.fill(0.0);
            light.add_radiance(edge.ray.direction, &mut self.value);
            let rival = self.rival(edge.rival, index, edge.from, edge.ray.direction, f64::INFINITY);
            let other = self.other(edge, index);
            self.add(power_heuristic(other, rival));
        }
    }

    /// The density with which a light is drawn in the direction of an edge, over that of the path's own way.
    fn other(&self, edge: &Edge, light: usize) -> f64 {
        match (edge.pdf, self.choice.probability(light)) {
            (Some(pdf), probability) if probability > 0.0 => {
                let light = &self.scene.lights()[light];
                ratio(probability * light.pdf_towards(edge.from, edge.ray.direction), pdf)
            }
            _ => 0.0,
        }
    }

    /// Adds what the surface at the end of an edge emits towards it.
    pub(super) fn emission(&mut self, edge: &Edge, surface: usize, point: &SurfacePoint) {
        let Some(emission) = self.scene.emission(surface) else { return };
        let away = -edge.ray.direction;
        let profile = emission.profile_towards(away, point.normal.dot(away));
        if profile == 0.0 {
            return;
        }
        let weight = self.scene.light_of_surface(surface).map_or(1.0, |light| {
            let (from, direction) = (edge.from, edge.ray.direction);
            let rival = self.rival(edge.rival, light, from, direction, from.distance(point.position));
            power_heuristic(self.other(edge, light), rival)
        });
        let carried = self.carried();
        self.value[carried.clone()].copy_from_slice(&emission.radiance()[carried]);
        self.add(weight * profile);
    }

    /// The density with which packets find a path whose last edge leads from `from` to a light, over that of the path's own way, given
    /// that ratio for all but the light's end.
    pub(super) fn rival(&self, before: f64, light: usize, from: DVec3, direction: DVec3, distance: f64) -> f64 {
        match self.packets {
            Some(shares) if before > 0.0 => {
                let density = self.scene.lights()[light].emission_density(from, direction, distance);
                before * shares.probability(light) * density
            }
            _ => 0.0,
        }
    }

    /// Adds the light that one light, drawn at random, sends to a vertex straight away. `function` writes f |cosθ| per band for a local
    /// direction and gives the density with which the vertex's own sampling draws it, and [`Edge::rival`] of the path with that edge,
    /// without the density of the edge.
    pub(super) fn light(
        &mut self,
        point: &SurfacePoint,
        [u0, u1, u2, _]: [f64; 4],
        function: impl Fn(DVec3, &mut [f64]) -> [f64; 2],
        frame: &Frame,
    ) {
        let Some((index, probability, stretched)) = self.choice.draw(u0) else { return };
        let light = &self.scene.lights()[index];
        let Some(towards) = light.sample_towards(point.position, [stretched, u1, u2], &mut self.arriving) else {
            return;
        };
        let local = frame.local(towards.direction);
        if towards.direction.dot(point.normal) * local.z <= 0.0 {
            return;
        }
        let [own, before] = function(local, &mut self.value);
        let carried = self.carried();
        if self.value[carried.clone()].iter().all(|&v| v == 0.0) {
            return;
        }
        let ray = Ray { origin: point.origin_towards(towards.direction), direction: towards.direction };
        let ignored = self.scene.surface_of_light(index);
        let casts_shadows = self.limits.shadows && light.casts_shadows();
        self.searches += u64::from(casts_shadows);
        if casts_shadows && self.scene.surfaces().is_occluded(&ray, towards.distance, ignored) {
            return;
        }
        let pdf = probability * towards.pdf;
        let own = if towards.delta { 0.0 } else { own };
        let rival = self.rival(before, index, point.position, towards.direction, towards.distance);
        let weight = power_heuristic(own / pdf, rival / pdf) / pdf;
        multiply(&mut self.value[carried.clone()], &self.arriving[carried]);
        self.add(weight);
    }

    /// Whether what the path would find from here on is left to virtual lights that were drawn where its last edge starts.
    pub(super) fn is_found(&self, edge: &Edge, point: &SurfacePoint, sampler: &mut Sampler) -> bool {
        let Some(lights) = self.virtual_lights.as_ref().filter(|_| edge.shared > 0.0) else { return false };
        let cosines = edge.shared * edge.ray.direction.dot(point.normal).abs();
        let share = lights.share(cosines / edge.from.distance_squared(point.position));
        share == 1.0 || share > 0.0 && sampler.one() < share
    }

    /// Adds the light of some virtual lights of the set in use, drawn at random by one number.
    pub(super) fn virtual_light(&mut self, vertex: &Vertex<'_>) {
        let Vertex { material, point, frame, outgoing, u, .. } = vertex;
        let from = point.position;
        let normal = if outgoing.z < 0.0 { -point.shading } else { point.shading };
        let edges = self.limits.max_edges.map_or(u32::MAX, |max| max.saturating_sub(vertex.edge.count + 1));
        if !self.virtual_lights.as_mut().is_some_and(|lights| lights.weigh(from, normal, edges)) {
            return;
        }
        for draw in 0..DRAWS {
            let Some(lights) = &self.virtual_lights else { return };
            let place = (f64::from(draw) + u) / f64::from(DRAWS);
            let Some(drawn) = lights.draw(from, normal, place) else { continue };
            let local = frame.local(drawn.direction);
            if drawn.direction.dot(point.normal) * local.z <= 0.0 {
                continue;
            }
            self.searches += 1;
            if !lights.arriving(point, &drawn, &mut self.arriving) {
                continue;
            }
            material.evaluate(local, *outgoing, Transport::Radiance, &mut self.value);
            multiply(&mut self.value, &self.arriving);
            self.add(drawn.weight * local.z.abs() / f64::from(DRAWS));
        }
    }

    /// Adds throughput · value · weight: band by band, or of all bands of the light to the one that the instrument sees.
    pub(super) fn add(&mut self, weight: f64) {
        let (weight, carried) = (weight * self.share, self.carried());
        let products =
            self.throughput[carried.clone()].iter().zip(&self.value[carried.clone()]).map(|(t, v)| t * v * weight);
        match self.seen {
            Some(band) => self.radiance[band] += products.sum::<f64>(),
            None => self.radiance[carried].iter_mut().zip(products).for_each(|(r, p)| *r += p),
        }
    }
}

/// How much larger a density is than a path's own; infinite where that has none.
fn ratio(other: f64, own: f64) -> f64 {
    if own > 0.0 { other / own } else { f64::INFINITY }
}

/// p² / (p² + o² + r²) of the densities o/p and r/p of two other ways; 0 where p is, and they are infinite.
fn power_heuristic(other: f64, rival: f64) -> f64 {
    1.0 / (1.0 + other * other + rival * rival)
}

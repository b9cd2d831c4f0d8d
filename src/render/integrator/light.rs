//! Light tracing: packets of flux from the lights through the scene, until they are absorbed or leave it.
//!
//! Every packet carries the flux of all bands. Where it meets a surface, a direction is drawn and the flux multiplied by
//! f_s |cosθ| / pdf, so that the mean over packets is the flux itself. What is done with packets (counted through a sphere, sorted by
//! the direction in which they leave) is the visitor's business.

use glam::DVec3;

use super::frame::Frame;
use super::polarisation::Polarisation;
use crate::math::sampling;
use crate::render::light::shares::Shares;
use crate::render::material::Transport;
use crate::render::ray::Ray;
use crate::render::sampler::Sampler;
use crate::render::scene::Scene;

/// Who looks at packets on their way. Slices are flux per band, W/nm or W, of one packet.
pub trait Visitor {
    /// The packet that is emitted next comes from this light.
    fn starts(&mut self, light: usize) {
        let _ = light;
    }

    /// A packet leaves a light.
    fn emitted(&mut self, flux: &[f64]);

    /// A packet flies along a ray for `length` metres (infinite: it leaves the scene).
    fn flight(&mut self, ray: &Ray, length: f64, flux: &[f64]);

    /// A packet with `flux`, after fluorescence and textures, is about to be scattered; it came from the direction `arriving` of the
    /// surface's own frame.
    fn scatters(&mut self, surface: usize, arriving: DVec3, flux: &[f64]) {
        let _ = (surface, arriving, flux);
    }

    /// A packet arrives at a surface with `before` and goes on with `after` (zero where it ends).
    fn met(&mut self, surface: usize, before: &[f64], after: &[f64]);
}

/// The light tracer of one thread.
#[derive(Debug)]
pub struct LightTracer<'a> {
    scene: &'a Scene,
    heroes: &'a [f64],
    lights: Shares,
    flux: Vec<f64>,
    before: Vec<f64>,
    weights: Vec<f64>,
    polarisation: Polarisation,
}

impl<'a> LightTracer<'a> {
    /// A tracer for a scene; `heroes` as for [`super::path::PathTracer::new`].
    #[must_use]
    pub fn new(scene: &'a Scene, heroes: &'a [f64]) -> Self {
        let n = scene.bands().len();
        Self {
            scene,
            heroes,
            lights: Shares::new(scene.lights(), n),
            flux: vec![0.0; n],
            before: vec![0.0; n],
            weights: vec![0.0; n],
            polarisation: Polarisation::new(n),
        }
    }

    /// Sends one packet through the scene.
    pub fn packet(&mut self, sampler: &mut Sampler, visitor: &mut impl Visitor) {
        let [choice, u0, u1, hero] = sampler.four();
        let [u2, u3, u4, _] = sampler.four();
        let Some(drawn) = self.lights.draw(choice) else { return };
        self.start(drawn, [u0, u1, u2, u3, u4], hero, sampler, visitor);
    }

    /// Sends one packet of a light, which the caller chose, through the scene; `share` is that of the packets that are sent from it.
    pub fn packet_of(&mut self, light: usize, share: f64, sampler: &mut Sampler, visitor: &mut impl Visitor) {
        let [_, u0, u1, hero] = sampler.four();
        let [u2, u3, u4, _] = sampler.four();
        self.start((light, share), [u0, u1, u2, u3, u4], hero, sampler, visitor);
    }

    /// Sends a packet of a light that is drawn with a probability.
    fn start(
        &mut self,
        (light, probability): (usize, f64),
        u: [f64; 5],
        hero: f64,
        sampler: &mut Sampler,
        visitor: &mut impl Visitor,
    ) {
        let Some(ray) = self.scene.lights()[light].emit(u, &mut self.flux) else { return };
        self.flux.iter_mut().for_each(|f| *f /= probability);
        visitor.starts(light);
        self.fly(ray, hero, sampler, visitor);
    }

    /// Sends one packet of 1 W (per nm) in every band along a ray.
    pub fn beam(&mut self, ray: Ray, sampler: &mut Sampler, visitor: &mut impl Visitor) {
        let [hero, ..] = sampler.four();
        self.flux.fill(1.0);
        self.fly(ray, hero, sampler, visitor);
    }

    /// Follows the packet; `hero` is the uniform number that draws the band which it keeps where it must be split.
    fn fly(&mut self, mut ray: Ray, hero: f64, sampler: &mut Sampler, visitor: &mut impl Visitor) {
        visitor.emitted(&self.flux);
        let start: f64 = self.flux.iter().sum();
        let mut hero = self.heroes.partition_point(|&s| s <= hero).min(self.heroes.len() - 1);
        let mut split = false;
        self.polarisation.clear();
        loop {
            let Some((surface, crossing)) = self.scene.surfaces().closest(&ray, f64::INFINITY) else {
                visitor.flight(&ray, f64::INFINITY, &self.flux);
                return;
            };
            visitor.flight(&ray, crossing.t, &self.flux);
            let point = self.scene.surfaces().surface_point(surface, &ray, &crossing);
            let frame = Frame::of(point.shading, point.tangent);
            let arriving = frame.local(-ray.direction);
            self.before.copy_from_slice(&self.flux);
            let [u0, u1, u2, chance] = sampler.four();
            let material = self.scene.material(surface);
            if material.convert(point.uv, Transport::Flux, &mut self.flux, &mut self.weights) {
                let [u, ..] = sampler.four();
                hero = self.heroes.partition_point(|&s| s <= u).min(self.heroes.len() - 1);
                split = false;
            }
            visitor.scatters(surface, arriving, &self.flux);
            let drawn = material.sample(arriving, [u0, u1, u2], Transport::Flux, hero, &mut self.weights);
            let next = drawn.and_then(|drawn| {
                let direction = frame.world(drawn.direction);
                (direction.dot(point.normal) * drawn.direction.z > 0.0).then_some((drawn, direction))
            });
            let Some((drawn, direction)) = next else {
                self.flux.fill(0.0);
                visitor.met(surface, &self.before, &self.flux);
                return;
            };
            self.flux.iter_mut().zip(&self.weights).for_each(|(f, w)| *f *= w);
            if drawn.delta {
                let components = |c: &mut [_]| material.polarise(arriving, drawn.direction, c);
                self.polarisation.turn(components, [ray.direction, direction], point.shading, &mut self.flux);
            } else {
                self.polarisation.clear();
            }
            if drawn.split && !split {
                split = true;
                let below = if hero == 0 { 0.0 } else { self.heroes[hero - 1] };
                self.flux[hero] /= self.heroes[hero] - below;
            }
            visitor.met(surface, &self.before, &self.flux);
            // Packets keep about the flux that they started with; the weak ones end by chance.
            let strength = self.flux.iter().sum::<f64>() / start;
            if strength < 1.0 {
                let (goes_on, _) = sampling::split(chance, strength);
                if !goes_on {
                    return;
                }
                self.flux.iter_mut().for_each(|f| *f /= strength);
            }
            ray = Ray { origin: point.origin_towards(direction), direction };
        }
    }
}

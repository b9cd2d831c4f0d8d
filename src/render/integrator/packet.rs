//! A packet of flux on its way from a light: what it carries, and what becomes of that where it meets surfaces.
//!
//! It carries all bands until it is refracted for one of them, its hero, as a path from a sensor does, and the hero is drawn by the same
//! probabilities. Shading normals: flux is scattered with the factor |ω_i·n_s| |ω_o·n_g| / (|ω_i·n_g| |ω_o·n_s|), which makes it
//! agree with radiance.
//!
//! Reference: E. Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, thesis, Stanford 1997, §5.3.

use glam::DVec3;

use super::frame::Frame;
use super::limits::Limits;
use super::polarisation::Polarisation;
use crate::math::sampling;
use crate::render::light::shares::Shares;
use crate::render::material::{Material, Scattered, Transport};
use crate::render::ray::{Crossing, Ray, SurfacePoint};
use crate::render::sampler::Sampler;
use crate::render::scene::Scene;

/// What makes a packet leave a light: uniform numbers in [0, 1), of which the first chooses the light and the others are those of
/// [`Light::emit`](crate::render::light::Light::emit).
pub type Start = [f64; 6];

/// A packet.
#[derive(Debug)]
pub struct Packet<'a> {
    scene: &'a Scene,
    heroes: &'a [f64],
    shares: &'a Shares,
    limits: Limits,
    flux: Vec<f64>,
    value: Vec<f64>,
    polarisation: Polarisation,
    hero: usize,
    /// It carries its hero alone.
    split: bool,
    /// It was converted by a fluorescent surface.
    fluoresced: bool,
    /// Flux of all bands when it left the light.
    start: f64,
}

/// Where a packet comes from.
#[derive(Debug, Clone, Copy)]
pub struct Origin {
    /// The light, by its place in the scene.
    pub light: usize,
    /// The probability with which it was drawn.
    pub probability: f64,
}

/// Where a packet came to.
#[derive(Debug, Clone, Copy)]
pub struct Vertex<'a> {
    /// The surface.
    pub surface: usize,
    /// Its place.
    pub point: SurfacePoint,
    /// The frame there.
    pub frame: Frame,
    /// What it is made of.
    pub material: &'a dyn Material,
    /// The direction back to where the packet came from, in the world.
    pub back: DVec3,
    /// The same in the frame.
    pub arriving: DVec3,
    /// The band by which the lobes on the light's side of it were drawn.
    pub hero: usize,
}

impl<'a> Packet<'a> {
    /// One that carries nothing; `heroes` as for [`super::path::PathTracer::new`], `shares` of the scene's lights.
    #[must_use]
    pub fn new(scene: &'a Scene, limits: Limits, heroes: &'a [f64], shares: &'a Shares) -> Self {
        let n = scene.bands().len();
        Self {
            scene,
            heroes,
            shares,
            limits,
            flux: vec![0.0; n],
            value: vec![0.0; n],
            polarisation: Polarisation::new(n),
            hero: 0,
            split: false,
            fluoresced: false,
            start: 0.0,
        }
    }

    /// What it carries, per band, W/nm or W.
    #[must_use]
    pub fn flux(&self) -> &[f64] {
        &self.flux
    }

    /// The band that it keeps where it has to be split, and the probability with which that was drawn.
    #[must_use]
    pub fn hero(&self) -> (usize, f64) {
        let below = if self.hero == 0 { 0.0 } else { self.heroes[self.hero - 1] };
        (self.hero, self.heroes[self.hero] - below)
    }

    /// Whether it was converted by a fluorescent surface and carries more than its hero: a path from a sensor would have carried that alone.
    #[must_use]
    pub fn is_seen_by_hero(&self) -> bool {
        self.fluoresced && !self.split
    }

    /// A new one from a light, with its first ray: the mean of its flux over draws is that of all lights. `None`: a draw of no flux.
    pub fn emit(&mut self, sampler: &mut Sampler) -> Option<(Ray, Origin)> {
        let [choice, u0, u1, hero] = sampler.four();
        let [u2, u3, u4, _] = sampler.four();
        self.emit_from([choice, u0, u1, u2, u3, u4], hero)
    }

    /// The same from numbers that are given; `hero` is uniform in [0, 1) and draws the band that it keeps where it has to be split.
    pub fn emit_from(&mut self, [choice, u0, u1, u2, u3, u4]: Start, hero: f64) -> Option<(Ray, Origin)> {
        let (light, probability) = self.shares.draw(choice)?;
        let ray = self.scene.lights()[light].emit([u0, u1, u2, u3, u4], &mut self.flux)?;
        self.flux.iter_mut().for_each(|f| *f /= probability);
        self.start = self.flux.iter().sum();
        self.choose_hero(hero);
        self.fluoresced = false;
        self.polarisation.clear();
        Some((ray, Origin { light, probability }))
    }

    /// Where it comes to along a ray that meets a surface; `None` on a side that the shading normal does not have: no light comes from there.
    #[must_use]
    pub fn vertex(&self, ray: &Ray, surface: usize, crossing: &Crossing) -> Option<Vertex<'a>> {
        let point = self.scene.surface_point(surface, ray, crossing);
        let frame = Frame::of(point.shading, point.tangent);
        let back = -ray.direction;
        let arriving = frame.local(back);
        let material = self.scene.material(surface);
        let vertex = Vertex { surface, point, frame, material, back, arriving, hero: self.hero };
        (back.dot(point.normal) * arriving.z > 0.0).then_some(vertex)
    }

    /// Makes of the flux what textures, fluorescence and the shading normal make of what arrives at a vertex.
    pub fn arrive(&mut self, vertex: &Vertex<'_>, sampler: &mut Sampler) {
        let Vertex { point, material, back, arriving, .. } = vertex;
        if material.convert(point.uv, Transport::Flux, &mut self.flux, &mut self.value) {
            let [u, ..] = sampler.four();
            self.choose_hero(u);
            self.fluoresced = true;
        }
        if material.splits() {
            self.split();
        }
        let shading = arriving.z.abs() / back.dot(point.normal).abs();
        self.flux.iter_mut().for_each(|f| *f *= shading);
    }

    /// Draws how it goes on, with the ray and what was drawn in the frame; `None` where it ends. Packets keep about the flux that they started with; the weak ones end by chance.
    pub fn scatter(&mut self, vertex: &Vertex<'_>, [u0, u1, u2, chance]: [f64; 4]) -> Option<(Ray, Scattered)> {
        let Vertex { point, frame, material, back, arriving, .. } = vertex;
        let drawn = material.sample(*arriving, [u0, u1, u2], Transport::Flux, self.hero, &mut self.value)?;
        let direction = frame.world(drawn.direction);
        let onwards = direction.dot(point.normal);
        if onwards * drawn.direction.z <= 0.0 {
            return None;
        }
        if drawn.delta {
            let scale = onwards / drawn.direction.z;
            self.flux.iter_mut().zip(&self.value).for_each(|(f, v)| *f *= v * scale);
        } else {
            // The function from light to sensor itself: not all measured ones are the same both ways.
            material.evaluate(*arriving, drawn.direction, Transport::Radiance, &mut self.value);
            let scale = onwards.abs() / drawn.pdf;
            self.flux.iter_mut().zip(&self.value).for_each(|(f, v)| *f *= v * scale);
        }
        if drawn.delta && self.limits.polarisation {
            let components = |c: &mut [_]| material.polarise(*arriving, drawn.direction, c);
            self.polarisation.turn(components, [-*back, direction], point.shading, &mut self.flux);
        } else {
            self.polarisation.clear();
        }
        if drawn.split {
            self.split();
        }
        let strength = self.flux.iter().sum::<f64>() / self.start;
        if strength < 1.0 {
            let (goes_on, _) = sampling::split(chance, strength);
            if !goes_on {
                return None;
            }
            self.flux.iter_mut().for_each(|f| *f /= strength);
        }
        Some((Ray { origin: point.origin_towards(direction), direction }, drawn))
    }

    fn choose_hero(&mut self, u: f64) {
        self.split = false;
        self.hero = self.heroes.partition_point(|&s| s <= u).min(self.heroes.len() - 1);
        if self.limits.single_band {
            self.split();
        }
    }

    /// The hero stands for all bands from here on.
    fn split(&mut self) {
        if self.split {
            return;
        }
        self.split = true;
        let (hero, probability) = self.hero();
        let kept = self.flux[hero] / probability;
        self.flux.fill(0.0);
        self.flux[hero] = kept;
    }
}

//! Path tracing: paths from the instrument into the scene, lights sought at every vertex, both ways of finding a light weighed
//! against each other, long paths ended by chance.
//!
//! ```text
//! L ≈ Σ_k T_k [ Σ_s w_s f_s L_s |cosθ| / p_s ],    T_k = Π f_s |cosθ| / (p q)
//! w_s = p_s² / Σ p²        power heuristic of multiple importance sampling
//! q = min(1, n² max_b T_b)    probability of going on (Russian roulette); of a single band, T_b without the draw of the band
//! ```
//!
//! n is the index where the path is over that where it began: within glass T holds the factor 1/n² of radiance, which is given back where
//! the path leaves the glass and says nothing about what the path is worth. Where paths are guided T counts by so much more as its place is
//! bright and its direction is likely by what is known of them.
//!
//! Of two ways at a polished surface both are followed unless one is faint ([`super::waiting`]); from diffuse surfaces paths may be guided
//! ([`super::guide`]).
//!
//! A path from a camera may leave the first surface that scatters by n ways, each with 1/n of the weight ([`PathTracer::branching`]); the light
//! sought there is weighed as one draw beside n. A light that is the same from everywhere is not sought where paths go on: directions drawn
//! for the surface find it best.
//!
//! With [`Follow::Specular`] it is the ray tracing of T. Whitted, *An Improved Illumination Model for Shaded Display*, CACM 23 (1980).
//!
//! References: E. Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, thesis, Stanford 1997, ch. 9 and 10; J. Arvo &
//! D. Kirk, *Particle Transport and Image Synthesis*, SIGGRAPH 1990.

mod found;
mod onwards;
mod sight;

use std::ops::Range;

use glam::DVec3;

use super::frame::Frame;
use super::guide::{self, Guide, Guided};
use super::limits::{Follow, Limits};
use super::polarisation::Polarisation;
use super::virtual_lights::VirtualLights;
use super::waiting::Waiting;
use crate::render::light::choice::Choice;
use crate::render::light::shares::Shares;
use crate::render::material::{Material, Transport};
use crate::render::ray::{Ray, SurfacePoint};
use crate::render::sampler::Sampler;
use crate::render::scene::Scene;
use crate::render::sensor::response::Response;

pub use sight::Sight;

/// Fainter ways than this are mostly not followed beyond the first surface that is not polished.
const SEEN: f64 = 0.05;

/// The path tracer of one thread: it owns what a path needs, so that no sample allocates.
#[derive(Debug)]
pub struct PathTracer<'a> {
    scene: &'a Scene,
    limits: Limits,
    /// Probability with which each band is the hero of a path, cumulative.
    heroes: &'a [f64],
    throughput: Vec<f64>,
    value: Vec<f64>,
    arriving: Vec<f64>,
    choice: Choice,
    /// What the sample carries, per band.
    radiance: Vec<f64>,
    /// Bands that the path carries no more (it was refracted for one wavelength).
    split: bool,
    hero: usize,
    /// The one band in which the instrument sees what the path finds, once a fluorescent surface mixed the bands behind it: the
    /// throughput is that of the light's bands into this one.
    seen: Option<usize>,
    polarisation: Polarisation,
    /// Where packets of flux compete ([`super::bidirectional`]): the probabilities with which they start from the lights.
    packets: Option<&'a Shares>,
    /// Where paths go on from diffuse surfaces.
    guide: Option<&'a Guide>,
    /// Directions that were weighed by it.
    guided: u64,
    /// The other ways at polished surfaces.
    waiting: Waiting<Edge>,
    /// What lights diffuse surfaces in place of paths from one to another.
    virtual_lights: Option<VirtualLights<'a>>,
    /// Searches along a ray so far.
    searches: u64,
    /// The solid angle that the picture would have if all of its pixels were as large as the one that the path starts from, sr; 0 where no
    /// packet competes. Of a meter at a point: the inverse of the density of the path's first direction.
    picture_sr: f64,
    /// Packets land on the meter that the path starts from, so that they compete from its first edge on.
    lands: bool,
    /// Ways by which a path from the camera leaves the first surface that is no mirror and no polished glass.
    branches: u32,
    /// The share of a way in the sample.
    share: f64,
    /// What the path carried to where they part.
    kept: Vec<f64>,
    /// What the camera sees is noted.
    sees: bool,
    sight: Sight,
}

/// Where the path stands before its next edge.
#[derive(Debug, Clone, Copy)]
struct Edge {
    ray: Ray,
    /// The density per solid angle of the ray's direction; `None` for an edge that no light sampling competes with.
    pdf: Option<f64>,
    /// Where it starts, for the lights' densities.
    from: DVec3,
    /// The density with which packets find the path up to here, over that of the path's own way: without what draws them at the light.
    rival: f64,
    /// |cosθ| at its start where that is a diffuse surface that virtual lights were drawn for, else 0.
    shared: f64,
    /// n² of the medium that it is in, over that where the path began.
    index_squared: f64,
    /// Which edge of the path it is, from 1.
    count: u32,
    /// It leads from the camera over nothing but polished surfaces.
    straight: bool,
    /// The share of the light on the way that the path went at polished surfaces where it went both ways.
    chance: f64,
    /// The same since the last surface that is not polished; 1 where the path is straight.
    lately: f64,
    /// How much more the path is worth than it carries: how much likelier its direction is by guiding than by the material, and how bright the
    /// place is that it leaves, each at least 1.
    guided: f64,
}

/// Where a path goes on from.
#[derive(Clone, Copy)]
struct Vertex<'a> {
    material: &'a dyn Material,
    point: SurfacePoint,
    frame: Frame,
    outgoing: DVec3,
    /// The edge that leads there, with what the next has of it.
    edge: Edge,
    /// Light is sought from here.
    seek: bool,
    /// Virtual lights are drawn for it, by this number.
    shares: bool,
    u: f64,
    /// A packet is connected with the lens from here.
    connected: bool,
    rival: f64,
    guided: Option<Guided<'a>>,
}

impl Vertex<'_> {
    /// The density with which a packet that comes from `incident` is sent on the way that the path came, where one competes.
    fn sent(&self, incident: DVec3, hero: usize) -> f64 {
        if !self.connected && self.rival > 0.0 { self.material.pdf(incident, self.outgoing, hero) } else { 1.0 }
    }
}

impl Edge {
    /// The first of a path.
    fn first(ray: Ray, pdf: Option<f64>, from: DVec3) -> Self {
        Self {
            ray,
            pdf,
            from,
            rival: 0.0,
            shared: 0.0,
            index_squared: 1.0,
            count: 1,
            straight: false,
            chance: 1.0,
            lately: 1.0,
            guided: 1.0,
        }
    }
}

impl<'a> PathTracer<'a> {
    /// A tracer for a scene; `heroes` are the running sums, up to 1, of the probabilities with which a band is chosen where a path
    /// must be split.
    #[must_use]
    pub fn new(scene: &'a Scene, limits: Limits, heroes: &'a [f64]) -> Self {
        let n = scene.bands().len();
        let bounds = scene.bounds();
        let middle = if bounds.is_finite() { 0.5 * (bounds.min + bounds.max) } else { DVec3::ZERO };
        Self {
            scene,
            limits,
            heroes,
            throughput: vec![1.0; n],
            value: vec![0.0; n],
            arriving: vec![0.0; n],
            choice: Choice::new(scene.lights(), middle, limits.follow == Follow::All),
            radiance: vec![0.0; n],
            split: false,
            hero: 0,
            seen: None,
            polarisation: Polarisation::new(n),
            packets: None,
            guide: None,
            guided: 0,
            waiting: Waiting::default(),
            virtual_lights: None,
            searches: 0,
            picture_sr: 0.0,
            lands: false,
            branches: 1,
            share: 1.0,
            kept: vec![1.0; n],
            sees: false,
            sight: Sight::default(),
        }
    }

    /// The same, whose paths from a camera leave the first surface that is no mirror and no polished glass by so many ways, 1 or more; not
    /// beside packets, which count on one.
    #[must_use]
    pub fn branching(self, branches: u32) -> Self {
        Self { branches, ..self }
    }

    /// The same, for pictures and readings to which packets of flux add what they find: see [`super::bidirectional`].
    #[must_use]
    pub fn beside(self, packets: &'a Shares) -> Self {
        Self { packets: Some(packets), ..self }
    }

    /// The same, with virtual lights, whose sets the caller renews: see [`super::virtual_lights`].
    #[must_use]
    pub fn with(self, virtual_lights: VirtualLights<'a>) -> Self {
        Self { virtual_lights: Some(virtual_lights), ..self }
    }

    /// The same, guided from diffuse surfaces: see [`super::guide`].
    #[must_use]
    pub fn guided(self, guide: Option<&'a Guide>) -> Self {
        Self { guide, ..self }
    }

    /// The virtual lights that it was given.
    pub fn virtual_lights(&mut self) -> Option<&mut VirtualLights<'a>> {
        self.virtual_lights.as_mut()
    }

    /// The work done so far, in searches along a ray.
    #[must_use]
    pub fn effort(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a measure of work")]
        let searches = self.searches as f64 + guide::EFFORT * self.guided as f64;
        searches + self.virtual_lights.as_ref().map_or(0.0, VirtualLights::effort)
    }

    /// One sample of the radiance along a ray, per band.
    pub fn radiance(&mut self, ray: Ray, sampler: &mut Sampler) -> &[f64] {
        self.picture_radiance(ray, 0.0, sampler)
    }

    /// The same along the ray of a pixel: the part of it that packets leave to it, where there are as many of them as samples of all
    /// pixels. `picture_sr` is the solid angle that the picture would have if all of its pixels were as large as this one.
    pub fn picture_radiance(&mut self, ray: Ray, picture_sr: f64, sampler: &mut Sampler) -> &[f64] {
        self.start(sampler);
        self.picture_sr = if self.packets.is_some() { picture_sr } else { 0.0 };
        self.follow(Edge { straight: true, ..Edge::first(ray, None, ray.origin) }, self.branches, sampler);
        &self.radiance
    }

    /// The sample that was taken last, per band.
    #[must_use]
    pub fn found(&self) -> &[f64] {
        &self.radiance
    }

    /// One sample of ∫ R(ω) L(ω) dω at a point whose frame is turned to the instrument's axis, per band. Beside packets: the part that
    /// they leave to it, where they land all over an area of `area_m2` that the point is drawn from, or, of 0, are connected with the point.
    pub fn reading(
        &mut self,
        point: &SurfacePoint,
        response: &Response,
        area_m2: f64,
        sampler: &mut Sampler,
    ) -> &[f64] {
        self.start(sampler);
        self.lands = self.packets.is_some() && area_m2 > 0.0;
        let landing = if self.lands { area_m2 } else { 0.0 };
        let landing = |local: DVec3| landing * local.z.max(0.0);
        let frame = Frame::of(point.normal, point.tangent);
        let [u0, u1, u2, u3] = sampler.four();
        if response.seeks_lights() {
            self.choice.prepare(self.scene.lights(), point.position);
            self.light(
                point,
                [u0, u1, u2, u3],
                |local, value| {
                    value.fill(response.weight(local));
                    [response.pdf(local), landing(local)]
                },
                &frame,
            );
        }
        let [u0, u1, ..] = sampler.four();
        let (local, weight) = response.sample([u0, u1]);
        self.scale(weight);
        let direction = frame.world(local);
        let ray = Ray { origin: point.origin_towards(direction), direction };
        let own = response.pdf(local);
        self.picture_sr = if self.packets.is_some() && !self.lands { 1.0 / own } else { 0.0 };
        let first = Edge::first(ray, response.seeks_lights().then_some(own), point.position);
        self.follow(Edge { rival: landing(local) / own, ..first }, 1, sampler);
        &self.radiance
    }

    fn start(&mut self, sampler: &mut Sampler) {
        self.throughput.fill(1.0);
        self.radiance.fill(0.0);
        self.polarisation.clear();
        self.seen = None;
        self.lands = false;
        self.share = 1.0;
        self.sight = Sight::default();
        // What a sample takes beside them.
        self.searches += 1;
        self.choose_hero(sampler);
    }

    /// The path carries all bands, and a band is drawn that it will keep where it must be split, or from here on.
    fn choose_hero(&mut self, sampler: &mut Sampler) {
        self.split = false;
        if !self.limits.single_band && !self.scene.chooses_bands() {
            return;
        }
        let u = sampler.one();
        self.hero = self.heroes.partition_point(|&s| s <= u).min(self.heroes.len() - 1);
        if self.limits.single_band {
            self.split();
        }
    }

    fn probability_of_hero(&self) -> f64 {
        let below = if self.hero == 0 { 0.0 } else { self.heroes[self.hero - 1] };
        self.heroes[self.hero] - below
    }

    /// The hero stands for all bands from here on.
    fn split(&mut self) {
        if self.split {
            return;
        }
        self.split = true;
        let kept = self.throughput[self.hero] / self.probability_of_hero();
        self.throughput.fill(0.0);
        self.throughput[self.hero] = kept;
    }

    /// The bands that the path carries.
    fn carried(&self) -> Range<usize> {
        if self.split { self.hero..self.hero + 1 } else { 0..self.throughput.len() }
    }

    fn scale(&mut self, by: f64) {
        let carried = self.carried();
        self.throughput[carried].iter_mut().for_each(|t| *t *= by);
    }

    /// Follows a path, which leaves the first surface that scatters by so many ways.
    fn follow(&mut self, start: Edge, branches: u32, sampler: &mut Sampler) {
        let others = self.waiting.count();
        self.follow_one(start, branches, sampler);
        while self.waiting.count() > others
            && let Some((mut carried, edge)) = self.waiting.pop()
        {
            self.exchange(&mut carried);
            self.waiting.give_back(carried);
            self.follow_one(edge, branches, sampler);
        }
    }

    fn follow_one(&mut self, start: Edge, branches: u32, sampler: &mut Sampler) {
        let mut edge = start;
        loop {
            self.searches += 1;
            let Some((surface, crossing)) = self.scene.surfaces().closest(&edge.ray, f64::INFINITY) else {
                self.escape(&edge);
                if self.sees {
                    self.see_beyond(&edge);
                }
                return;
            };
            let point = self.scene.surface_point(surface, &edge.ray, &crossing);
            if self.sees {
                self.see(&edge, surface, &point);
            }
            self.emission(&edge, surface, &point);
            if self.limits.max_edges.is_some_and(|max| edge.count >= max) {
                return;
            }
            // Of a faint way at glass fewer.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "no more than there were")]
            let branches = (f64::from(branches) * edge.chance).round().max(1.0) as u32;
            let Some(vertex) = self.arrive(&edge, surface, point, branches, sampler) else { return };
            if branches > 1 && vertex.seek {
                self.branch(&vertex, branches, sampler);
                return;
            }
            match self.leave(&vertex, 1, sampler) {
                Some(next) => edge = next,
                None => return,
            }
        }
    }

    /// Follows all ways from a vertex, each from what the path carried there, with random numbers of its own that are spread evenly over all of
    /// them.
    fn branch(&mut self, vertex: &Vertex<'a>, branches: u32, sampler: &Sampler) {
        self.kept.copy_from_slice(&self.throughput);
        let (hero, split, seen) = (self.hero, self.split, self.seen);
        self.share = 1.0 / f64::from(branches);
        for branch in 0..branches {
            let mut sampler = sampler.branch(branch, branches);
            self.throughput.copy_from_slice(&self.kept);
            (self.hero, self.split, self.seen) = (hero, split, seen);
            if !split {
                self.choose_hero(&mut sampler);
            }
            if let Some(lights) = &mut self.virtual_lights {
                lights.take(branch as usize);
            }
            self.choice.prepare(self.scene.lights(), vertex.point.position);
            if let Some(edge) = self.leave(vertex, branches, &mut sampler) {
                self.follow(edge, 1, &mut sampler);
            }
        }
        self.share = 1.0;
    }

    /// Seeks a light from a vertex, which the path may leave by so many ways; `None` where it ends.
    fn arrive(
        &mut self,
        edge: &Edge,
        surface: usize,
        point: SurfacePoint,
        branches: u32,
        sampler: &mut Sampler,
    ) -> Option<Vertex<'a>> {
        let material = self.scene.material(surface);
        let frame = Frame::of(point.shading, point.tangent);
        let outgoing = frame.local(-edge.ray.direction);
        let seek = !material.is_delta();
        // On polished surfaces nothing is sought, nor where the surroundings alone shine.
        let sought = seek && self.choice.seeks();
        let u = if sought || seek && self.virtual_lights.is_some() { sampler.four() } else { [0.0; 4] };
        if material.converts() {
            if self.seen.is_none() && material.nature().fluoresces {
                // One band of the instrument goes on; all bands of the light may come into it.
                self.split();
                self.seen = Some(self.hero);
            }
            if material.convert(point.uv, Transport::Radiance, &mut self.throughput, &mut self.value) {
                self.choose_hero(sampler);
            }
        }
        if material.splits() {
            self.split();
        }
        let mut chance = edge.chance;
        if seek && chance < 1.0 {
            // On faint ways nothing but lamps is bright enough to be looked for every time.
            let followed = if edge.straight { (chance / SEEN).min(1.0) } else { edge.lately.sqrt() };
            chance /= followed;
            if followed < 1.0 {
                if sampler.one() >= followed {
                    return None;
                }
                self.scale(1.0 / followed);
            }
        }
        let shares = !self.split && material.is_diffuse() && self.virtual_lights.is_some();
        if shares && self.is_found(edge, &point, sampler) {
            return None;
        }
        let hero = self.hero;
        // From the first vertex a packet is connected with the lens, unless it lands on a meter as on any surface.
        let connected = edge.count == 1 && !self.lands;
        let rival = match connected {
            // Packets do not come to the lens straight from a mirror or from glass.
            true if seek => self.picture_sr * edge.from.distance_squared(point.position),
            true => 0.0,
            false => edge.rival,
        };
        let guided = self.guide.filter(|_| guide::suits(material)).map(|guide| guide.at(point.position));
        let onwards = Edge {
            straight: edge.straight && !seek,
            chance,
            lately: if seek { 1.0 } else { edge.lately },
            // Either way of a Dirac lobe is as probable as the other; no packet comes to the lens from it.
            rival: if connected { 0.0 } else { rival },
            ..*edge
        };
        let vertex =
            Vertex { material, point, frame, outgoing, edge: onwards, seek, shares, u: u[3], connected, rival, guided };
        if sought {
            self.choice.prepare(self.scene.lights(), point.position);
            // Where the path ends here, no other strategy competes with the light's own.
            let competing = if self.limits.follow == Follow::All { f64::from(branches) } else { 0.0 };
            let carried = self.carried();
            let function = |incident, value: &mut [f64]| {
                let pdf = evaluate(material, incident, outgoing, (hero, carried.clone()), value);
                let pdf = guided.map_or(pdf, |g| g.density(frame.world(incident), pdf));
                [competing * pdf, rival * vertex.sent(incident, hero)]
            };
            self.light(&point, u, function, &frame);
        }
        (self.limits.follow != Follow::Nothing).then_some(vertex)
    }
}

/// Writes f_s |cosθ_i| of the bands that are carried and gives the density of the material's own sampling.
fn evaluate(
    material: &dyn Material,
    incident: DVec3,
    outgoing: DVec3,
    (hero, carried): (usize, Range<usize>),
    value: &mut [f64],
) -> f64 {
    material.evaluate(incident, outgoing, Transport::Radiance, value);
    value[carried].iter_mut().for_each(|v| *v *= incident.z.abs());
    material.pdf(outgoing, incident, hero)
}

fn multiply(values: &mut [f64], by: &[f64]) {
    values.iter_mut().zip(by).for_each(|(v, b)| *v *= b);
}

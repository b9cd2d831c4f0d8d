//! Virtual lights: places that packets of flux came to, which light the diffuse surfaces that paths from the camera come to.
//!
//! A path that leaves a diffuse surface into any direction seldom finds what lights it where that is one bright patch across a dark room.
//! Packets from the lights know where it is bright. A few are sent for every set of samples; every diffuse place that one comes to is a
//! virtual light of that set, and a path draws [`DRAWS`] of them, in proportion to what they would bring if nothing were in between:
//!
//! ```text
//! L = Σ f_x f_y Φ_y min(G, b) V / (p_y N)        G = |cosθ_x| |cosθ_y| / d²,   p_y ∝ S_y min(G, b)
//! ```
//!
//! N packets; Φ: the flux per band that comes to y; S: what goes on of it, in one figure; V: 1 where nothing is in between. What is left
//! out, G − min(G, b), is that of places nearby, which paths find well: a path that went from x to y goes on with the probability
//! 1 − min(1, b/G), and everywhere else ends there. Together they are the whole for any b, without bias: the sum is linear in the packets.
//!
//! Only edges between two diffuse surfaces ([`Material::is_diffuse`](crate::render::material::Material::is_diffuse)) of which a path
//! carries all bands are shared out that way. Light that comes straight from a lamp is left to the path.
//!
//! Every way by which a sample of a pixel goes on has a set of its own, which it shares with the other pixels of a [strip](crate::render::film::strip)
//! of the picture: the scatter of a pixel's samples tells its error, but the errors of the pixels of a strip are not independent.
//!
//! References: A. Keller, *Instant Radiosity*, SIGGRAPH 1997; T. Kollig & A. Keller, *Illumination in the Presence of Weak Singularities*,
//! Monte Carlo and Quasi-Monte Carlo Methods 2004 (the bound, and what is beyond it).

mod set;

use glam::{DVec3, Vec3};

use self::set::{Drawn, Set, Weights, single};
use super::limits::{Follow, Limits};
use super::packet::{Packet, Vertex};
use crate::render::light::shares::Shares;
use crate::render::material::Transport;
use crate::render::ray::{Ray, SurfacePoint};
use crate::render::sampler::Sampler;
use crate::render::scene::Scene;

/// Virtual lights that are drawn for a vertex.
pub const DRAWS: u32 = 3;
/// Pixels for which one packet is sent.
const PIXELS: f64 = 4.0;
/// Most packets of a set: every sample weighs all that they bring.
const MOST: f64 = 256.0;
/// So many of them are weighed in the time of a search along a ray, about.
const WEIGHED: f64 = 800.0;
/// b N⁻¹ in terms of the area of what is lit: so near an edge is as likely to be found by a path as by one of the packets, about.
const NEARNESS: f64 = 1.0;

/// Where packets start, and how near virtual lights may be, for a scene that they suit.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    shares: Shares,
    /// Area of the diffuse surfaces, m².
    area: f64,
    /// The middle of the scene: places are weighed in single precision from here, in units of √area.
    middle: DVec3,
    /// Half the width of the scene in these units.
    reach: f32,
    /// By more than this distances from a plane are not rounded where they are weighed.
    rounded: f32,
}

impl Source {
    /// Of a scene; `None` where virtual lights cannot stand for all light between its diffuse surfaces, or there are no two.
    #[must_use]
    pub fn of(scene: &Scene, limits: &Limits) -> Option<Self> {
        // Packets of a light at infinity come through the sphere of what is bounded.
        let suits = limits.follow == Follow::All
            && limits.shadows
            && !limits.single_band
            && limits.max_edges.is_none_or(|max| max > 2)
            && scene.surfaces().are_bounded()
            && scene.lights().iter().all(|light| light.emits_what_arrives());
        let shapes = scene.surfaces().shapes().iter().enumerate();
        let area: f64 = shapes.filter(|(i, _)| scene.material(*i).is_diffuse()).map(|(_, s)| s.area()).sum();
        let bounds = scene.bounds();
        let middle = 0.5 * bounds.min + 0.5 * bounds.max;
        let reach = (0.5 * bounds.max - 0.5 * bounds.min).max_element() / area.sqrt();
        let (rounded, reach) = (rounded(reach), single(reach));
        let source = Self { shares: Shares::new(scene.lights(), scene.bands().len()), area, middle, reach, rounded };
        (suits && area > 0.0 && area.is_finite()).then_some(source)
    }

    /// A place in the units in which it is weighed.
    fn local(&self, place: DVec3) -> Vec3 {
        ((place - self.middle) / self.area.sqrt()).as_vec3()
    }
}

/// More than a distance from a plane is rounded in single precision where no coordinate is greater than `reach`: three coordinates of two places, their
/// differences and a normal, each by half an epsilon, and twice that.
fn rounded(reach: f64) -> f32 {
    single(16.0 * reach) * f32::EPSILON
}

/// The virtual lights of some sets, one of which is in use, and what makes them.
#[derive(Debug)]
pub struct VirtualLights<'a> {
    scene: &'a Scene,
    source: &'a Source,
    heroes: &'a [f64],
    /// The longest path of a packet, edges.
    most_edges: Option<u32>,
    packet: Packet<'a>,
    sets: Vec<Set<'a>>,
    used: usize,
    value: Vec<f64>,
    /// Of the set in use, for a point.
    weights: Weights,
    /// Work done for them, in searches along a ray.
    effort: f64,
}

/// The sets of one strip of pixels, one for each number of a sample and each way by which it goes on.
#[derive(Debug)]
pub struct Sets {
    sampler: Sampler,
    /// Packets sent so far: those of all sets are spread evenly together.
    packets: u64,
}

impl Sets {
    /// None yet; from the random numbers of a stream.
    #[must_use]
    pub fn new(sampler: Sampler) -> Self {
        Self { sampler, packets: 0 }
    }

    /// Makes the sets of the next number, for so many of a strip of `all` pixels: a packet for four of them where all have a sample of that number, more
    /// for each of the few that have many samples, which are the noisy ones; at most 256.
    pub fn next(&mut self, lights: &mut VirtualLights<'_>, pixels: usize, all: usize) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let packets = ((pixels * all) as f64).sqrt().div_euclid(PIXELS).clamp(1.0, MOST) as u64;
        for set in 0..lights.sets.len() {
            lights.renew(set, packets, self.packets, &mut self.sampler);
            self.packets += packets;
        }
    }
}

impl<'a> VirtualLights<'a> {
    /// So many sets of none yet; `heroes` as for [`super::path::PathTracer::new`].
    #[must_use]
    pub fn new(scene: &'a Scene, limits: &Limits, heroes: &'a [f64], source: &'a Source, sets: u32) -> Self {
        Self {
            scene,
            source,
            heroes,
            most_edges: limits.max_edges.map(|max| max.saturating_sub(2)),
            packet: Packet::new(scene, *limits, heroes, &source.shares),
            sets: (0..sets).map(|_| Set::default()).collect(),
            used: 0,
            value: vec![0.0; scene.bands().len()],
            weights: Weights::default(),
            effort: 0.0,
        }
    }

    /// The work done for them so far, in searches along a ray.
    #[must_use]
    pub fn effort(&self) -> f64 {
        self.effort
    }

    /// Takes a set, by its number, into use.
    pub fn take(&mut self, set: usize) {
        self.used = set;
    }

    /// min(1, b/G): the share that virtual lights have in an edge between two diffuse surfaces.
    #[must_use]
    pub fn share(&self, g: f64) -> f64 {
        self.sets[self.used].share(g)
    }

    /// Puts others in the place of those of a set, of so many packets, the first of which is sample `first` of the sampler.
    fn renew(&mut self, set: usize, packets: u64, first: u64, sampler: &mut Sampler) {
        #[expect(clippy::cast_precision_loss, reason = "a number of packets")]
        let number = packets as f64;
        self.used = set;
        self.sets[set].clear(NEARNESS * number / self.source.area);
        for index in first..first + packets {
            sampler.start(index);
            let Some((mut ray, _)) = self.packet.emit(sampler) else { continue };
            for edges in 1.. {
                if self.most_edges.is_some_and(|most| edges > most) {
                    break;
                }
                self.effort += 1.0;
                let Some((surface, crossing)) = self.scene.surfaces().closest(&ray, f64::INFINITY) else { break };
                let Some(vertex) = self.packet.vertex(&ray, surface, &crossing) else { break };
                self.packet.arrive(&vertex, sampler);
                if vertex.material.is_diffuse() {
                    self.add(vertex, edges, number);
                }
                let u = sampler.four();
                match self.packet.scatter(&vertex, u) {
                    Some((next, _)) => ray = next,
                    None => break,
                }
            }
        }
        self.sets[set].finish(self.source);
    }

    /// Adds the vertex that one of so many packets came to, along so many edges.
    fn add(&mut self, vertex: Vertex<'a>, edges: u32, packets: f64) {
        let up = DVec3::new(0.0, 0.0, vertex.arriving.z.signum());
        vertex.material.evaluate(vertex.arriving, up, Transport::Radiance, &mut self.value);
        let strength = strength(self.packet.flux(), &self.value, self.heroes);
        if strength == 0.0 {
            return;
        }
        let flux = self.packet.flux().iter().map(|flux| flux / packets);
        self.sets[self.used].add(vertex, edges, strength, flux);
    }

    /// Weighs those of the set in use for a point, `normal` on the side that is seen: those at the end of paths of no more than `edges`
    /// edges. Whether there is one.
    pub fn weigh(&mut self, from: DVec3, normal: DVec3, edges: u32) -> bool {
        let set = &self.sets[self.used];
        self.effort += set.count() as f64 / WEIGHED;
        let most = self.most_edges.is_some_and(|most| edges < most).then_some(edges);
        set.weigh(&mut self.weights, self.source, (from, normal), most)
    }

    /// One of those that were weighed for a point and a normal, by a uniform number.
    #[must_use]
    pub fn draw(&self, from: DVec3, normal: DVec3, u: f64) -> Option<Drawn> {
        self.sets[self.used].draw(&self.weights, (from, normal), u)
    }

    /// Writes f_y Φ_y, W/(m² sr nm) times m²; `false` where it is not seen from the point.
    pub fn arriving(&self, point: &SurfacePoint, drawn: &Drawn, value: &mut [f64]) -> bool {
        let (vertex, fluxes) = self.sets[self.used].light(drawn.number, value.len());
        let Vertex { point: place, frame, material, arriving, .. } = vertex;
        let back = -drawn.direction;
        let outgoing = frame.local(back);
        // A shading normal can send light through the surface: no light goes there.
        if outgoing.z * back.dot(place.normal) <= 0.0 {
            return false;
        }
        let origin = point.origin_towards(drawn.direction);
        let way = place.origin_towards(back) - origin;
        let distance = way.length();
        let direction = way / distance;
        // So near that the two origins have passed each other: nothing is in between.
        let touches = way.dot(drawn.direction) <= 0.0;
        if !touches && self.scene.surfaces().is_occluded(&Ray { origin, direction }, distance, None) {
            return false;
        }
        material.evaluate(*arriving, outgoing, Transport::Radiance, value);
        value.iter_mut().zip(fluxes).for_each(|(v, f)| *v *= f);
        true
    }
}

/// Σ p |Φ f| over the bands: p is the probability of a band, given by running sums, which no band is without.
fn strength(flux: &[f64], function: &[f64], heroes: &[f64]) -> f64 {
    let mut below = 0.0;
    let bands = flux.iter().zip(function).zip(heroes);
    bands
        .map(|((flux, function), hero)| {
            let p = hero - below;
            below = *hero;
            p * (flux * function).abs()
        })
        .sum()
}

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
//! Every way by which a sample of a pixel goes on has a set of its own, which it shares with the other pixels of a row: the scatter of a pixel's
//! samples tells its error, but the errors of the pixels of a row are not independent.
//!
//! References: A. Keller, *Instant Radiosity*, SIGGRAPH 1997; T. Kollig & A. Keller, *Illumination in the Presence of Weak Singularities*,
//! Monte Carlo and Quasi-Monte Carlo Methods 2004 (the bound, and what is beyond it).

use glam::DVec3;
use pulp::{Arch, NullaryFnOnce};

use super::limits::{Follow, Limits};
use super::packet::{Packet, Vertex};
use crate::render::light::shares::Shares;
use crate::render::material::Transport;
use crate::render::ray::{Ray, SurfacePoint};
use crate::render::sampler::Sampler;
use crate::render::scene::Scene;

/// Virtual lights that are drawn for a vertex.
pub const DRAWS: u32 = 2;
/// Pixels for which one packet is sent.
const PIXELS: f64 = 4.0;
/// Most packets of a set: every sample weighs all that they bring.
const MOST: f64 = 64.0;
/// So many of them are weighed in the time of a search along a ray, about.
const WEIGHED: f64 = 400.0;
/// Weights that are summed one by one; their sums are then summed again.
const BLOCK: usize = 16;
/// b N⁻¹ in terms of the area of what is lit: so near an edge is as likely to be found by a path as by one of the packets, about.
const NEARNESS: f64 = 2.0;

/// Where packets start, and how near virtual lights may be, for a scene that they suit.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    shares: Shares,
    /// Area of the diffuse surfaces, m².
    area: f64,
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
        let source = Self { shares: Shares::new(scene.lights(), scene.bands().len()), area };
        (suits && area > 0.0 && area.is_finite()).then_some(source)
    }
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
    /// Of the set in use, for a point: their weights, and the running sums of [`BLOCK`]s of them.
    weights: Vec<f64>,
    sums: Vec<f64>,
    /// Work done for them, in searches along a ray.
    effort: f64,
}

/// Virtual lights.
#[derive(Debug, Default)]
struct Set<'a> {
    /// The greatest G that they are answerable for, 1/m².
    bound: f64,
    /// x, y, z of their places, then of the normals on the sides that are lit.
    coordinates: [Vec<f64>; 6],
    /// What goes on from each, in one figure.
    strengths: Vec<f64>,
    /// Edges of the path from the lamp to each.
    edges: Vec<u32>,
    vertices: Vec<Vertex<'a>>,
    /// The flux that comes to each, per band, over the number of packets.
    fluxes: Vec<f64>,
}

/// The sets of one row of pixels, one for each number of a sample and each way by which it goes on.
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

    /// Makes the sets of the next number, for so many pixels of a row of `columns`: a packet for four of them where all have a sample of that number, more for
    /// each of the few that have many samples, which are the noisy ones; at most 64.
    pub fn next(&mut self, lights: &mut VirtualLights<'_>, pixels: usize, columns: usize) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let packets = ((pixels * columns) as f64).sqrt().div_euclid(PIXELS).clamp(1.0, MOST) as u64;
        for set in 0..lights.sets.len() {
            lights.renew(set, packets, self.packets, &mut self.sampler);
            self.packets += packets;
        }
    }
}

/// A virtual light that was drawn for a point.
#[derive(Debug, Clone, Copy)]
pub struct Drawn {
    index: usize,
    /// Unit vector from the point.
    pub direction: DVec3,
    /// |cosθ_y|/d² · min(1, b/G) over the probability of its draw.
    pub weight: f64,
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
            weights: Vec::new(),
            sums: Vec::new(),
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
        let bound = self.sets[self.used].bound;
        if g > bound { bound / g } else { 1.0 }
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
    }

    /// Adds the vertex that one of so many packets came to, along so many edges.
    fn add(&mut self, vertex: Vertex<'a>, edges: u32, packets: f64) {
        let up = DVec3::new(0.0, 0.0, vertex.arriving.z.signum());
        vertex.material.evaluate(vertex.arriving, up, Transport::Radiance, &mut self.value);
        let strength = strength(self.packet.flux(), &self.value, self.heroes);
        if strength == 0.0 {
            return;
        }
        let (place, normal) = (vertex.point.position, vertex.point.normal);
        let normal = if vertex.back.dot(normal) < 0.0 { -normal } else { normal };
        let own = [place.x, place.y, place.z, normal.x, normal.y, normal.z];
        let set = &mut self.sets[self.used];
        set.coordinates.iter_mut().zip(own).for_each(|(all, x)| all.push(x));
        set.strengths.push(strength);
        set.edges.push(edges);
        set.vertices.push(vertex);
        set.fluxes.extend(self.packet.flux().iter().map(|flux| flux / packets));
    }

    /// Weighs those of the set in use for a point, `normal` on the side that is seen: those at the end of paths of no more than `edges`
    /// edges. Whether there is one.
    pub fn weigh(&mut self, from: DVec3, normal: DVec3, edges: u32) -> bool {
        let set = &self.sets[self.used];
        self.effort += set.strengths.len() as f64 / WEIGHED;
        self.weights.clear();
        self.weights.resize(set.strengths.len(), 0.0);
        // The same operations in the same order with any instruction set.
        Arch::new().dispatch(Weigh { set, from, normal, weights: &mut self.weights });
        if self.most_edges.is_some_and(|most| edges < most) {
            let far = self.weights.iter_mut().zip(&set.edges).filter(|(_, own)| **own > edges);
            far.for_each(|(weight, _)| *weight = 0.0);
        }
        let mut sum = 0.0;
        self.sums.clear();
        self.sums.extend(self.weights.chunks(BLOCK).map(|block| {
            sum += block.iter().sum::<f64>();
            sum
        }));
        sum > 0.0 && sum < f64::INFINITY
    }

    /// One of those that were weighed for a point and a normal, by a uniform number.
    #[must_use]
    pub fn draw(&self, from: DVec3, normal: DVec3, u: f64) -> Option<Drawn> {
        let total = *self.sums.last()?;
        // Blocks of no weight are never found: their end is not above their start. At u = 1 the last of some weight is.
        let block =
            self.sums.partition_point(|end| *end <= u * total).min(self.sums.partition_point(|end| *end < total));
        let below = if block == 0 { 0.0 } else { self.sums[block - 1] };
        let first = block * BLOCK;
        let weights = &self.weights[first..self.weights.len().min(first + BLOCK)];
        let (mut end, mut place) = (below, 0);
        for weight in weights {
            end += weight;
            place += usize::from(end <= u * total);
        }
        if place == weights.len() {
            // Rounding left something over: it is the last one of some weight.
            place = weights.iter().rposition(|weight| *weight > 0.0)?;
        }
        let (index, chosen) = (first + place, weights[place]);
        let set = &self.sets[self.used];
        let way = set.vertices[index].point.position - from;
        let distance = way.length();
        let direction = way / distance;
        let [_, _, _, x, y, z] = &set.coordinates;
        let per_area = -direction.dot(DVec3::new(x[index], y[index], z[index])) / (distance * distance);
        let weight = per_area * self.share(direction.dot(normal) * per_area) * total / chosen;
        // Nothing comes from a place at the point itself.
        (weight > 0.0 && weight.is_finite()).then_some(Drawn { index, direction, weight })
    }

    /// Writes f_y Φ_y, W/(m² sr nm) times m²; `false` where it is not seen from the point.
    pub fn arriving(&self, point: &SurfacePoint, drawn: &Drawn, value: &mut [f64]) -> bool {
        let set = &self.sets[self.used];
        let Vertex { point: place, frame, material, arriving, .. } = &set.vertices[drawn.index];
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
        let fluxes = &set.fluxes[drawn.index * value.len()..];
        value.iter_mut().zip(fluxes).for_each(|(v, f)| *v *= f);
        true
    }
}

impl Set<'_> {
    /// Forgets all; those to come are answerable for no G above `bound`, 1/m².
    fn clear(&mut self, bound: f64) {
        self.bound = bound;
        self.coordinates.iter_mut().for_each(Vec::clear);
        self.strengths.clear();
        self.edges.clear();
        self.vertices.clear();
        self.fluxes.clear();
    }
}

/// S min(G, b) of each of a set, for a point. (No closure: only what is inlined is compiled for the instruction set at hand.)
struct Weigh<'a> {
    set: &'a Set<'a>,
    from: DVec3,
    normal: DVec3,
    weights: &'a mut [f64],
}

impl NullaryFnOnce for Weigh<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { set, from, normal, weights } = self;
        let n = weights.len();
        let [x, y, z, nx, ny, nz] = &set.coordinates;
        let (x, y, z, nx, ny, nz) = (&x[..n], &y[..n], &z[..n], &nx[..n], &ny[..n], &nz[..n]);
        let (strengths, bound) = (&set.strengths[..n], set.bound);
        for (i, weight) in weights.iter_mut().enumerate() {
            let (dx, dy, dz) = (x[i] - from.x, y[i] - from.y, z[i] - from.z);
            let squared = dx * dx + dy * dy + dz * dz;
            let here = (dx * normal.x + dy * normal.y + dz * normal.z).max(0.0);
            let there = (-dx * nx[i] - dy * ny[i] - dz * nz[i]).max(0.0);
            // At the point itself: 0/0, which min makes the bound; it is drawn and brings nothing.
            *weight = strengths[i] * (here * there / (squared * squared)).min(bound);
        }
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

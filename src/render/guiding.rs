//! What guides the paths of a picture, learnt from packets that are sent before it is taken: [`Guide`].
//!
//! Packets go out in rounds of a fixed number of streams, each by itself, until enough of them landed over polished surfaces; what the streams
//! found is put together in their order, so that the same guide comes out for any number of threads. The first ones tell where those
//! start that land so ([`Starts`]): they are sent at random, the next from there more often, and all others from where the first two
//! lots together tell. Only these count, so that no few of the first weigh as much as many of the last.

pub mod starts;

use glam::DVec3;
use rayon::prelude::*;

use self::starts::Starts;
use super::estimate::stream;
use super::integrator::guide::{self, Guide, Landing, Landings};
use super::integrator::limits::{Follow, Limits};
use super::integrator::packet::{Packet, Start, Vertex};
use super::light::shares::Shares;
use super::material::Transport;
use super::measure::Settings;
use super::sampler::Sampler;
use super::scene::Scene;

/// Independent streams of packets.
const STREAMS: usize = 64;
/// Rounds, at most: what one finds is kept whole, however much it is.
const ROUNDS: u64 = 32;
/// After so many rounds it is learnt where packets are to start.
const LEARNT: [u64; 2] = [1, 4];
/// Packets of all rounds, at least and at most.
const PACKETS: [u64; 2] = [1 << 16, 1 << 23];
/// So many landings are enough.
const ENOUGH: usize = 1 << 20;
/// One landing of so many packets is too few, after twice as many: others do not look for more.
const RARE: u64 = 4096;
/// Of so many packets one tells of what comes straight from diffuse surfaces: of that only the flux counts, and in bright rooms it is much.
const PLAIN: u64 = 16;

/// Whether there is anything to be guided: a surface that is not polished, and one that is.
#[must_use]
pub fn suits(scene: &Scene, limits: &Limits) -> bool {
    let materials = || (0..scene.surfaces().shapes().len()).map(|surface| scene.material(surface));
    limits.follow == Follow::All && materials().any(guide::suits) && materials().any(|m| m.has_delta())
}

/// Learns from about `wanted` packets, the random numbers of which are those of the instrument `instrument`. `None` where none is of help.
#[must_use]
pub fn learn(scene: &Scene, settings: &Settings, instrument: u64, wanted: u64) -> Option<Guide> {
    if suits(scene, &settings.limits) { Guide::new(landings(scene, settings, instrument, wanted)) } else { None }
}

/// Where about `wanted` packets come to surfaces that may be guided ([`learn`]); their weights are per packet, so that all together weigh as many as
/// such surfaces are met by one on the average.
#[must_use]
pub fn landings(scene: &Scene, settings: &Settings, instrument: u64, wanted: u64) -> Landings {
    let shares = Shares::new(scene.lights(), scene.bands().len());
    let per_stream = wanted.clamp(PACKETS[0], PACKETS[1]).div_ceil(ROUNDS * STREAMS as u64);
    // The first of each round: points of nets that follow one another are spread evenly, every sixteenth are not.
    let whole = per_stream.div_ceil(PLAIN);
    let counts = per_stream as f64 / whole as f64;
    let (mut starts, mut known) = (Starts::default(), Vec::new());
    let (mut found, mut dropped, mut counted) = (Landings::default(), 0, 0);
    for round in 0..ROUNDS {
        let parts: Vec<(Landings, Vec<(Start, f64)>)> = (0..STREAMS)
            .into_par_iter()
            .map(|number| {
                let mut learner = Learner::new(scene, settings, &shares, &starts);
                let mut sampler = settings.sampler(stream(instrument, number));
                for index in round * per_stream..(round + 1) * per_stream {
                    sampler.start(index);
                    learner.packet(&mut sampler, (index % per_stream < whole).then_some(counts));
                }
                (learner.landings, learner.known)
            })
            .collect();
        for (mut part, mut learnt) in parts {
            found.polished.append(&mut part.polished);
            found.plain.append(&mut part.plain);
            if round < LEARNT[1] {
                known.append(&mut learnt);
            }
        }
        counted += per_stream * STREAMS as u64;
        let sent = (round + 1) * per_stream * STREAMS as u64;
        let rare = sent >= 2 * RARE && ((dropped + found.polished.len()) as u64) < sent / RARE;
        if rare || found.polished.len() >= ENOUGH {
            break;
        }
        if LEARNT.contains(&(round + 1)) {
            starts = Starts::of(known.clone());
            dropped += found.polished.len();
            (found, counted) = (Landings::default(), 0);
        }
    }
    for landing in found.polished.iter_mut().chain(&mut found.plain) {
        landing.weight /= counted as f64;
    }
    found
}

/// Follows packets, of one stream.
struct Learner<'a> {
    scene: &'a Scene,
    packet: Packet<'a>,
    starts: &'a Starts,
    /// The longest path of a packet, edges.
    most_edges: Option<u32>,
    value: Vec<f64>,
    landings: Landings,
    /// Where those started that landed over polished surfaces, and 1/p of that.
    known: Vec<(Start, f64)>,
}

impl<'a> Learner<'a> {
    fn new(scene: &'a Scene, settings: &'a Settings, shares: &'a Shares, starts: &'a Starts) -> Self {
        // Where either of two ways is drawn as often, the flux of polarised light would grow with every reflection.
        let limits = Limits { polarisation: false, ..settings.limits };
        Self {
            scene,
            packet: Packet::new(scene, limits, &settings.heroes, shares),
            starts,
            most_edges: settings.limits.max_edges.map(|max| max.saturating_sub(1)),
            value: vec![0.0; scene.bands().len()],
            landings: Landings::default(),
            known: Vec::new(),
        }
    }

    /// Makes of the numbers that draw one of two Dirac lobes some that draw either as often, so that what is lit by the fainter alone is known as
    /// well; gives the weight of what they draw.
    fn even(&mut self, vertex: &Vertex<'_>, [u0, u1, u2, _]: &mut [f64; 4]) -> f64 {
        let (material, arriving) = (vertex.material, vertex.arriving);
        let mut draw = |end: f64| {
            let drawn = material.sample(arriving, [end, *u1, *u2], Transport::Flux, vertex.hero, &mut self.value);
            drawn.filter(|drawn| drawn.delta && drawn.pdf < 1.0).map(|drawn| drawn.pdf)
        };
        let end = if *u0 < 0.5 { 0.0 } else { 1.0 - f64::EPSILON / 2.0 };
        let Some((pdf, other)) = draw(end).zip(draw(1.0 - f64::EPSILON / 2.0 - end)) else { return 1.0 };
        if (pdf + other - 1.0).abs() > 1e-9 {
            return 1.0;
        }
        *u0 = end;
        2.0 * pdf
    }

    /// Follows a packet; `counts`, where it tells of what comes straight from diffuse surfaces as well: for how many packets.
    fn packet(&mut self, sampler: &mut Sampler, counts: Option<f64>) {
        let [choice, u0, u1, hero] = sampler.four();
        let [u2, u3, u4, among] = sampler.four();
        let (start, density) = self.starts.draw([choice, u0, u1, u2, u3, u4], among);
        let Some((mut ray, origin)) = self.packet.emit_from(start, hero) else { return };
        let before = self.landings.polished.len();
        let success = (start, 1.0 / density);
        // Whether the last surfaces were polished, and whether a path may meet what is before them.
        let (mut polished, mut met, mut weight) = (false, false, success.1);
        for edges in 1.. {
            if self.most_edges.is_some_and(|most| edges > most) {
                return;
            }
            let Some((surface, crossing)) = self.scene.surfaces().closest(&ray, f64::INFINITY) else { return };
            let Some(vertex) = self.packet.vertex(&ray, surface, &crossing) else { return };
            if edges == 1 {
                met = self.scene.lights()[origin.light].pdf_towards(vertex.point.position, vertex.back) > 0.0;
            }
            self.packet.arrive(&vertex, sampler);
            if edges > 1 && met && guide::suits(vertex.material) {
                let up = DVec3::new(0.0, 0.0, vertex.arriving.z.signum());
                vertex.material.evaluate(vertex.arriving, up, Transport::Radiance, &mut self.value);
                let seen = self.value.iter().any(|v| *v > 0.0);
                let landing = Landing { position: vertex.point.position, back: vertex.back, weight };
                match (seen, polished, counts) {
                    (true, true, _) => {
                        if self.landings.polished.len() == before {
                            self.known.push(success);
                        }
                        self.landings.polished.push(landing);
                    }
                    (true, false, Some(counts)) => {
                        self.landings.plain.push(Landing { weight: counts * weight, ..landing });
                    }
                    _ => {}
                }
            }
            let mut u = sampler.four();
            weight *= self.even(&vertex, &mut u);
            let Some((next, drawn)) = self.packet.scatter(&vertex, u) else { return };
            polished = drawn.delta;
            met |= !drawn.delta;
            ray = next;
        }
    }
}

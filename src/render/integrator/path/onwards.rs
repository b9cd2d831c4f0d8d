//! How a path goes on from a vertex: what draws the next edge, and both ways at polished surfaces.

use super::{Edge, PathTracer, Vertex, evaluate, multiply};
use crate::render::integrator::limits::Follow;
use crate::render::integrator::waiting::Carried;
use crate::render::lanes::largest;
use crate::render::material::{Scattered, Transport};
use crate::render::ray::Ray;
use crate::render::sampler::Sampler;

/// Of two ways at a polished surface both are followed if the fainter of them has no less than this share of the path.
const FAINTEST: f64 = 0.002;
/// And behind a surface that is not polished.
const FAINTEST_BEHIND: f64 = 0.02;
/// Edges of a path up to there: later ones matter little, and in a closed bright room there are many.
const EARLY: u32 = 8;
/// The last number below 1.
const LAST: f64 = 1.0 - f64::EPSILON / 2.0;

impl Edge {
    /// Where the path goes both ways: the one that has so much of it.
    fn sharing(self, share: f64) -> Self {
        let lately = if self.straight { 1.0 } else { self.lately * share };
        Self { chance: self.chance * share, lately, ..self }
    }
}

impl<'a> PathTracer<'a> {
    /// Draws virtual lights for a vertex and the next edge, one of so many that leave it.
    pub(super) fn leave(&mut self, vertex: &Vertex<'a>, branches: u32, sampler: &mut Sampler) -> Option<Edge> {
        if vertex.shares {
            self.virtual_light(vertex);
        }
        let Vertex { material, frame, outgoing, guided, .. } = *vertex;
        let hero = self.hero;
        let [u0, u1, u2, u3] = sampler.four();
        let mut here = vertex.edge;
        let drawn = match guided.and_then(|g| g.draw(sampler.four())) {
            Some(direction) => {
                let incident = frame.local(direction);
                let pdf = evaluate(material, incident, outgoing, (hero, self.carried()), &mut self.value);
                // On the other side of the surface.
                if pdf == 0.0 {
                    return None;
                }
                self.weigh(1.0 / pdf);
                Scattered { direction: incident, pdf, delta: false, split: false, eta: 1.0 }
            }
            None => self.draw(vertex, [u0, u1, u2])?,
        };
        if self.limits.follow == Follow::Specular && !drawn.delta {
            return None;
        }
        if drawn.delta {
            if self.set_aside(&here, vertex, &drawn, [u1, u2, u3]) {
                here = here.sharing(drawn.pdf);
                self.weigh(drawn.pdf);
            }
            return self.onwards(&here, vertex, &drawn, u3);
        }
        // By all ways of drawing the direction; the material's own may not know it.
        let pdf = guided.map_or(drawn.pdf, |g| g.density(frame.world(drawn.direction), drawn.pdf));
        here.guided = 1.0;
        if let Some(guided) = guided {
            self.guided += 2;
            self.weigh(drawn.pdf / pdf);
            here.guided = (pdf / drawn.pdf).max(1.0) * guided.brightness();
        }
        here.rival = vertex.rival * vertex.sent(drawn.direction, hero) / pdf;
        let next = self.onwards(&here, vertex, &drawn, u3)?;
        let shared = if vertex.shares { drawn.direction.z.abs() } else { 0.0 };
        Some(Edge { pdf: vertex.seek.then(|| f64::from(branches) * pdf), shared, ..next })
    }

    /// Weighs what was drawn.
    fn weigh(&mut self, by: f64) {
        let carried = self.carried();
        self.value[carried].iter_mut().for_each(|v| *v *= by);
    }

    /// Draws a direction at a vertex.
    fn draw(&mut self, at: &Vertex<'_>, u: [f64; 3]) -> Option<Scattered> {
        let (material, hero) = (at.material, self.hero);
        // Beside packets each way must be as probable for them as for the path, and they may still carry all bands.
        if self.split && self.packets.is_none() {
            material.sample_band(at.outgoing, u, Transport::Radiance, hero, &mut self.value)
        } else {
            material.sample(at.outgoing, u, Transport::Radiance, hero, &mut self.value)
        }
    }

    /// Sets the other of two Dirac lobes aside, to be followed later; not where they are not two, or one of them is too faint. What was drawn
    /// of the one stays.
    fn set_aside(&mut self, edge: &Edge, at: &Vertex<'_>, drawn: &Scattered, [u1, u2, u]: [f64; 3]) -> bool {
        let (chance, faintest) = if edge.straight { (edge.chance, FAINTEST) } else { (edge.lately, FAINTEST_BEHIND) };
        if chance * drawn.pdf.min(1.0 - drawn.pdf) < faintest || !edge.straight && edge.count > EARLY {
            return false;
        }
        std::mem::swap(&mut self.value, &mut self.arriving);
        // One of them is drawn by the smallest number, the other by the largest: which is which nobody says.
        let ends = if drawn.direction.z * at.outgoing.z > 0.0 { [LAST, 0.0] } else { [0.0, LAST] };
        let other = ends.into_iter().find_map(|end| {
            self.draw(at, [end, u1, u2]).filter(|other| {
                // They are all that there is.
                other.delta && other.direction != drawn.direction && (other.pdf + drawn.pdf - 1.0).abs() < 1e-9
            })
        });
        if let Some(other) = other {
            let mut aside = self.waiting.take(self.throughput.len());
            aside.throughput.copy_from_slice(&self.throughput);
            aside.polarisation.copy(&self.polarisation);
            (aside.split, aside.hero, aside.seen) = (self.split, self.hero, self.seen);
            self.weigh(other.pdf);
            let next = self.onwards(&edge.sharing(other.pdf), at, &other, u);
            self.exchange(&mut aside);
            match next {
                Some(next) => self.waiting.push(aside, next),
                None => self.waiting.give_back(aside),
            }
        }
        std::mem::swap(&mut self.value, &mut self.arriving);
        other.is_some()
    }

    /// Goes on in a direction that was drawn, with what [`Material::sample`] wrote; `edge` is the one that leads there, with what the next has of it.
    fn onwards(&mut self, edge: &Edge, at: &Vertex<'_>, drawn: &Scattered, u: f64) -> Option<Edge> {
        let Vertex { material, point, frame, outgoing, .. } = *at;
        let direction = frame.world(drawn.direction);
        // A shading normal can send light through the surface: no light goes there.
        if direction.dot(point.normal) * drawn.direction.z <= 0.0 {
            return None;
        }
        let carried = self.carried();
        multiply(&mut self.throughput[carried.clone()], &self.value[carried.clone()]);
        if self.limits.polarisation && drawn.delta {
            let (hero, directions) = (self.hero, [edge.ray.direction, direction]);
            let components = |c: &mut [_]| match carried.len() {
                1 => material.polarise_band(outgoing, drawn.direction, hero, c),
                _ => material.polarise(outgoing, drawn.direction, c),
            };
            let throughput = &mut self.throughput;
            self.polarisation.turn_bands(components, directions, point.shading, carried.clone(), throughput);
        } else {
            self.polarisation.clear();
        }
        if drawn.split {
            self.split();
        }
        let index_squared = edge.index_squared * drawn.eta * drawn.eta;
        let drawn_for = if self.limits.single_band { self.probability_of_hero() } else { 1.0 };
        let worth = index_squared * drawn_for * edge.guided / edge.chance;
        let strength = worth * largest(&self.throughput[self.carried()]);
        if edge.count >= self.limits.roulette_from && strength < 1.0 {
            if u >= strength {
                return None;
            }
            self.scale(1.0 / strength);
        }
        if strength == 0.0 {
            return None;
        }
        let ray = Ray { origin: point.origin_towards(direction), direction };
        let count = edge.count + 1;
        Some(Edge { ray, pdf: None, from: point.position, shared: 0.0, index_squared, count, ..*edge })
    }

    /// Carries what waited, which takes what was carried.
    pub(super) fn exchange(&mut self, other: &mut Carried) {
        std::mem::swap(&mut self.throughput, &mut other.throughput);
        std::mem::swap(&mut self.polarisation, &mut other.polarisation);
        std::mem::swap(&mut self.split, &mut other.split);
        std::mem::swap(&mut self.hero, &mut other.hero);
        std::mem::swap(&mut self.seen, &mut other.seen);
    }
}

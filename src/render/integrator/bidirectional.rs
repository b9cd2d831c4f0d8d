//! Paths from both ends: packets of flux from the lights to the surfaces that the camera sees, beside the paths from the camera.
//!
//! A path tracer finds a light's caustic, what glass gathers on a wall, only where a path happens to run through the glass into the
//! lamp; of a lamp without extent it finds nothing. A packet from the lamp finds it at once: at every vertex that is no mirror and no
//! polished glass it is connected with the lens and adds to the pixel there
//!
//! ```text
//! Δ = w Φ f_s |cosθ_c| J/d²        J = dx dy/dω: pixels per solid angle; d: distance from the lens
//! ```
//!
//! What packets do not find is what mirrors and glass show the camera directly, and lamps themselves; those are left to the path tracer
//! whole. Everything else both find, and every path x₀ (lens) … x_k (lamp) is weighed by the power heuristic of all ways to find it:
//!
//! ```text
//! s₀: the camera's path meets the lamp     s₁: the lamp is sought from x_{k−1}     t₁: a packet is connected with the lens
//! p_t₁/p_s₀ = g d₀₁² Ω / p→(x₁) · Π_{i=2}^{k−1} p←(x_i)/p→(x_i),     p_s₁/p_s₀ = p_light / p→(x_{k−1})
//! ```
//!
//! p→ and p← are the materials' densities per solid angle from the camera's and from the lamp's side, g that of the packet's emission
//! ([`Light::emission_density`]) times the light's probability, Ω = W H/J: there are as many packets as samples in all W × H pixels. The
//! cosines of the edges cancel. Both sides compute one and the same function of the path, so that the weights of the three
//! ways sum to 1 whatever is left out of them (the ends by chance; for a Dirac lobe, whose choice is as probable either way, and n²).
//!
//! A packet carries all bands until it is refracted for one of them, as a path does, and is split by the same probabilities. Behind a
//! fluorescent surface it is seen in its hero's band alone, because the path from the camera would have carried only that one.
//!
//! Shading normals: flux is scattered with the factor |ω_i·n_s| |ω_o·n_g| / (|ω_i·n_g| |ω_o·n_s|) that makes it agree with radiance.
//!
//! A meter is an instrument like the lens. At a point, of response R(ω), packets are connected with it: R in the place of J, and its own
//! density p_R(ω) in that of 1/Ω. One that reads the mean over an area A has packets land on it, Δ = w Φ/A: then x₀ is a vertex
//! like all others, at which the path's own density is p_R = cosθ/π and the packet's A cosθ, and light straight from the lamp and through
//! glass or off mirrors is found by all three ways. So a caustic that falls on a meter is found where the meter has some area.
//!
//! Limits: lights that do not behave as light does ([`Light::emission_density`] is 0) are left to the path tracer; a caustic that is seen
//! in a mirror or through glass is found by neither (but from the camera: by chance, or guided, see [`super::guide`]).
//!
//! [`Light::emission_density`]: crate::render::light::Light::emission_density
//!
//! References: E. Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, thesis, Stanford 1997, §5.3 (shading normals),
//! ch. 8 to 10; E. Lafortune & Y. Willems, *Bi-directional Path Tracing*, Compugraphics 1993.

use glam::DVec3;

use super::frame::Frame;
use super::guide::Guide;
use super::limits::{Follow, Limits};
use super::packet::{Origin, Packet, Vertex};
use crate::render::light::choice::Choice;
use crate::render::light::shares::Shares;
use crate::render::material::Transport;
use crate::render::ray::{Ray, SurfacePoint};
use crate::render::sampler::Sampler;
use crate::render::scene::Scene;
use crate::render::sensor::camera::Camera;
use crate::render::sensor::response::Response;
use crate::render::shape::Shape;

/// How much further than its crossing with a surface a packet looks for a meter that lies on it, and how much short of a meter at a point
/// what hides it ends.
const NEAR: f64 = 1e-9;

/// Who looks at what packets bring.
#[derive(Debug, Clone, Copy)]
pub enum Target<'a> {
    /// A camera: packets are connected with its lens.
    Camera(&'a Camera),
    /// A meter at a point: packets are connected with it. All that they add is in one pixel, 0.
    Point(&'a SurfacePoint, Response),
    /// A meter of the mean irradiance of a shape's outside: packets land on it. All that they add is in one pixel, 0.
    Area(&'a dyn Shape),
}

/// How a target sees a point.
struct View {
    /// From the target, unit.
    direction: DVec3,
    distance: f64,
    pixel: usize,
    /// What radiance of an area there counts for: J/d² or R/d², 1/m².
    response: f64,
    /// The density per area with which the target's own paths come there, 1/m².
    density: f64,
}

impl Target<'_> {
    /// How it sees a point, from a place of its lens that two uniform numbers draw; `None` where it does not.
    fn view(&self, position: DVec3, lens: [f64; 2]) -> Option<View> {
        match *self {
            Self::Camera(camera) => {
                let shown = camera.show(position, lens)?;
                let response = camera.pixels_per_solid_angle(shown.direction) / shown.distance / shown.distance;
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the picture")]
                let pixel = shown.y as usize * camera.width() as usize + shown.x as usize;
                let density = response / camera.pixels();
                Some(View { direction: shown.direction, distance: shown.distance, pixel, response, density })
            }
            Self::Point(point, response) => {
                let way = position - point.position;
                let distance = way.length();
                let direction = way / distance;
                let local = Frame::of(point.normal, point.tangent).local(direction);
                let weight = response.weight(local);
                (distance > 0.0 && weight > 0.0).then(|| View {
                    direction,
                    distance: distance * (1.0 - NEAR),
                    pixel: 0,
                    response: weight / distance / distance,
                    density: response.pdf(local) / distance / distance,
                })
            }
            Self::Area(_) => None,
        }
    }

    fn has_lens(&self) -> bool {
        matches!(self, Self::Camera(camera) if camera.has_lens())
    }
}

/// What packets add to a picture.
#[derive(Debug, Default)]
pub struct Splats {
    /// Rows from the top, pixels from the left.
    pixels: Vec<usize>,
    /// The bands of each.
    values: Vec<f64>,
    /// Where those of the last packet begin.
    packet: usize,
}

impl Splats {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.pixels.clear();
        self.values.clear();
        self.packet = 0;
    }

    /// What the last packet added, all pixels one behind the other.
    #[must_use]
    pub fn last(&self, bands: usize) -> &[f64] {
        &self.values[self.packet * bands..]
    }

    /// Forgets what the last packet added.
    pub fn drop_last(&mut self, bands: usize) {
        self.pixels.truncate(self.packet);
        self.values.truncate(self.packet * bands);
    }

    /// The pixel, by its place row by row, and the bands of each; a packet adds to a pixel at most once.
    pub fn iter(&self, bands: usize) -> impl Iterator<Item = (usize, &[f64])> {
        self.pixels.iter().copied().zip(self.values.chunks_exact(bands))
    }

    fn next_packet(&mut self) {
        self.packet = self.pixels.len();
    }

    /// The bands of a pixel, for the last packet to add to.
    fn of(&mut self, pixel: usize, bands: usize) -> &mut [f64] {
        let at = (self.pixels[self.packet..].iter().position(|p| *p == pixel))
            .map_or(self.pixels.len(), |i| self.packet + i);
        if at == self.pixels.len() {
            self.pixels.push(pixel);
            self.values.resize(self.values.len() + bands, 0.0);
        }
        &mut self.values[at * bands..][..bands]
    }
}

/// The tracer of packets towards an instrument, of one thread.
#[derive(Debug)]
pub struct PacketTracer<'a> {
    scene: &'a Scene,
    limits: Limits,
    target: Target<'a>,
    choice: Choice,
    packet: Packet<'a>,
    /// What guides the paths beside it.
    guide: Option<&'a Guide>,
    value: Vec<f64>,
}

/// How other ways find what the packet is about to find: (p/p_t₁)², without what draws the first edge from the camera.
#[derive(Debug, Clone, Copy)]
struct Rivals {
    /// The camera's path meets the lamp, or, behind the packet's first vertex, either of both; without the density of its last direction.
    meets: f64,
    /// The lamp is sought, from the first vertex of the packet; 0 from there on.
    seeks: f64,
}

impl Rivals {
    /// After a vertex from which the camera's path would have gone on with the density `onwards`, and the packet with `sent`.
    fn after(self, onwards: f64, sent: f64) -> Self {
        let squared = |x: f64| x * x;
        Self { meets: (self.meets * squared(onwards) + self.seeks) / squared(sent), seeks: 0.0 }
    }
}

impl<'a> PacketTracer<'a> {
    /// A tracer for a scene and an instrument; `heroes` as for [`super::path::PathTracer::new`], `shares` of the scene's lights.
    #[must_use]
    pub fn new(scene: &'a Scene, limits: Limits, heroes: &'a [f64], shares: &'a Shares, target: Target<'a>) -> Self {
        let n = scene.bands().len();
        let bounds = scene.bounds();
        let middle = if bounds.is_finite() { 0.5 * (bounds.min + bounds.max) } else { DVec3::ZERO };
        Self {
            scene,
            limits,
            target,
            choice: Choice::new(scene.lights(), middle, limits.follow == Follow::All),
            packet: Packet::new(scene, limits, heroes, shares),
            guide: None,
            value: vec![0.0; n],
        }
    }

    /// The same beside paths that are guided.
    #[must_use]
    pub fn beside(self, guide: Option<&'a Guide>) -> Self {
        Self { guide, ..self }
    }

    /// The density with which a path that comes to a vertex from `from` goes on to where the packet came from.
    fn onwards(&self, vertex: &Vertex<'_>, from: DVec3) -> f64 {
        let own = vertex.material.pdf(from, vertex.arriving, vertex.hero);
        self.guide.map_or(own, |guide| guide.density(vertex.material, vertex.point.position, vertex.back, own))
    }

    /// Sends one packet through the scene; the mean of what packets add is what they add to the picture's radiance or the meter's reading.
    pub fn packet(&mut self, sampler: &mut Sampler, splats: &mut Splats) {
        splats.next_packet();
        let Some((mut ray, origin)) = self.packet.emit(sampler) else { return };
        let mut rivals: Option<Rivals> = None;
        let most = self.limits.max_edges;
        let too_long = |edges: u32| most.is_some_and(|max| edges > max);
        // Edges of the path from the lamp to where the packet comes next.
        for edges in 1.. {
            if too_long(edges) {
                return;
            }
            let closest = self.scene.surfaces().closest(&ray, f64::INFINITY);
            if let Target::Area(shape) = self.target {
                let reach = closest.as_ref().map_or(f64::INFINITY, |(_, crossing)| crossing.t * (1.0 + NEAR));
                self.land(shape, &ray, reach, rivals, origin, splats);
            }
            let Some((surface, crossing)) = closest else { return };
            if too_long(edges + 1) {
                return;
            }
            let Some(vertex) = self.packet.vertex(&ray, surface, &crossing) else { return };
            let seen = !vertex.material.is_delta();
            let Some(here) = rivals.or_else(|| self.rivals(origin, &vertex.point, vertex.back, crossing.t, seen))
            else {
                return;
            };
            self.packet.arrive(&vertex, sampler);
            let u = sampler.four();
            if seen {
                self.connect(&vertex, here, sampler, splats);
            }
            let Some((next, drawn)) = self.packet.scatter(&vertex, u) else { return };
            ray = next;
            rivals = Some(if drawn.delta {
                // A lamp is not sought for a lobe of Dirac's.
                Rivals { seeks: 0.0, ..here }
            } else {
                here.after(self.onwards(&vertex, drawn.direction), drawn.pdf)
            });
        }
    }

    /// The rivals at the first vertex of a packet from a light of that probability, from which the light may be sought; `None` where what
    /// packets find is left to others.
    fn rivals(
        &mut self,
        Origin { light, probability }: Origin,
        point: &SurfacePoint,
        back: DVec3,
        distance: f64,
        sought: bool,
    ) -> Option<Rivals> {
        let source = &self.scene.lights()[light];
        let density = probability * source.emission_density(point.position, back, distance);
        // An infinite one is that of a surface at a point light itself.
        if !(density > 0.0 && density.is_finite()) {
            return None;
        }
        let towards = source.pdf_towards(point.position, back);
        // Nothing but being sought finds a light of no extent, whose directions have no density.
        let (meets, per_solid_angle) = if towards > 0.0 { (1.0, towards) } else { (0.0, 1.0) };
        let seeks = if sought {
            self.choice.prepare(self.scene.lights(), point.position);
            self.choice.probability(light) * per_solid_angle
        } else {
            0.0
        };
        let squared = |p: f64| (p / density) * (p / density);
        Some(Rivals { meets: squared(meets), seeks: squared(seeks) })
    }

    /// Adds what the target sees of the packet at a vertex.
    fn connect(&mut self, vertex: &Vertex<'_>, rivals: Rivals, sampler: &mut Sampler, splats: &mut Splats) {
        let point = &vertex.point;
        let lens = if self.target.has_lens() { sampler.four() } else { [0.5; 4] };
        let Some(view) = self.target.view(point.position, [lens[0], lens[1]]) else { return };
        let direction = -view.direction;
        let outgoing = vertex.frame.local(direction);
        vertex.material.evaluate(vertex.arriving, outgoing, Transport::Radiance, &mut self.value);
        if self.value.iter().zip(self.packet.flux()).all(|(v, f)| v * f == 0.0) {
            return;
        }
        let ray = Ray { origin: point.origin_towards(direction), direction };
        if self.scene.surfaces().is_occluded(&ray, view.distance, None) {
            return;
        }
        let met = rivals.after(self.onwards(vertex, outgoing), 1.0).meets;
        let weight = 1.0 / (1.0 + view.density * view.density * met);
        let factor = weight * direction.dot(point.normal).abs() * view.response;
        self.bring(factor, splats.of(view.pixel, self.value.len()));
    }

    /// Adds the packet where it lands on the outside of a meter's shape, which its next edge reaches within `reach` metres.
    fn land(
        &mut self,
        shape: &dyn Shape,
        ray: &Ray,
        reach: f64,
        rivals: Option<Rivals>,
        origin: Origin,
        splats: &mut Splats,
    ) {
        let Some(crossing) = shape.cross(ray, 0.0, reach) else { return };
        let (point, back) = (shape.surface(ray, &crossing), -ray.direction);
        let cos = back.dot(point.normal);
        if cos <= 0.0 {
            return;
        }
        let Some(rivals) = rivals.or_else(|| self.rivals(origin, &point, back, crossing.t, true)) else { return };
        let own = Response::Planar.pdf(DVec3::new(0.0, 0.0, cos));
        let weight = 1.0 / (1.0 + rivals.after(own, shape.area() * cos).meets);
        self.value.fill(1.0);
        self.bring(weight / shape.area(), splats.of(0, self.value.len()));
    }

    /// Adds `factor` times flux and value to the bands in which they are seen.
    fn bring(&self, factor: f64, splat: &mut [f64]) {
        let (flux, (hero, probability)) = (self.packet.flux(), self.packet.hero());
        if self.packet.is_seen_by_hero() {
            splat[hero] += factor * flux[hero] * self.value[hero] / probability;
        } else {
            splat.iter_mut().zip(flux).zip(&self.value).for_each(|((s, f), v)| *s += factor * f * v);
        }
    }
}

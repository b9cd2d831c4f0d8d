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
//! the path leaves the glass and says nothing about what the path is worth.
//!
//! Of two ways at a polished surface that the camera sees both are followed ([`super::branches`]); from diffuse surfaces paths may be guided
//! ([`super::guide`]).
//!
//! With [`Follow::Specular`] it is the ray tracing of T. Whitted, *An Improved Illumination Model for Shaded Display*, CACM 23 (1980).
//!
//! References: E. Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, thesis, Stanford 1997, ch. 9 and 10; J. Arvo &
//! D. Kirk, *Particle Transport and Image Synthesis*, SIGGRAPH 1990.

use glam::DVec3;

use super::branches::{Branches, Carried};
use super::frame::Frame;
use super::guide::{self, Guide};
use super::limits::{Follow, Limits};
use super::polarisation::Polarisation;
use super::virtual_lights::{DRAWS, VirtualLights};
use crate::render::light::choice::Choice;
use crate::render::light::shares::Shares;
use crate::render::material::{Material, Scattered, Transport};
use crate::render::ray::{Ray, SurfacePoint};
use crate::render::sampler::Sampler;
use crate::render::scene::Scene;
use crate::render::sensor::response::Response;

/// Of two ways at a polished surface both are followed if the fainter of them has no less than this share of the path.
const FAINTEST: f64 = 0.002;
/// Fainter ways than this are mostly not followed beyond the first surface that is not polished.
const SEEN: f64 = 0.05;
/// The last number below 1.
const LAST: f64 = 1.0 - f64::EPSILON / 2.0;

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
    branches: Branches<Edge>,
    /// What lights diffuse surfaces in place of paths from one to another.
    virtual_lights: Option<VirtualLights<'a>>,
    /// Searches along a ray so far.
    searches: u64,
    /// The solid angle that the picture would have if all of its pixels were as large as the one that the path starts from, sr; 0 where no
    /// packet competes. Of a meter at a point: the inverse of the density of the path's first direction.
    picture_sr: f64,
    /// Packets land on the meter that the path starts from, so that they compete from its first edge on.
    lands: bool,
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
    /// How much likelier its direction is by guiding than by the material, at least 1: so much more the path is worth than it carries.
    guided: f64,
}

/// A vertex.
#[derive(Clone, Copy)]
struct Place<'a> {
    material: &'a dyn Material,
    point: &'a SurfacePoint,
    frame: &'a Frame,
    outgoing: DVec3,
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
            choice: Choice::new(scene.lights(), middle),
            radiance: vec![0.0; n],
            split: false,
            hero: 0,
            seen: None,
            polarisation: Polarisation::new(n),
            packets: None,
            guide: None,
            guided: 0,
            branches: Branches::default(),
            virtual_lights: None,
            searches: 0,
            picture_sr: 0.0,
            lands: false,
        }
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
        self.follow(Edge { straight: true, ..Edge::first(ray, None, ray.origin) }, sampler);
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
        self.throughput.iter_mut().for_each(|t| *t *= weight);
        let direction = frame.world(local);
        let ray = Ray { origin: point.origin_towards(direction), direction };
        let own = response.pdf(local);
        self.picture_sr = if self.packets.is_some() && !self.lands { 1.0 / own } else { 0.0 };
        let first = Edge::first(ray, response.seeks_lights().then_some(own), point.position);
        self.follow(Edge { rival: landing(local) / own, ..first }, sampler);
        &self.radiance
    }

    fn start(&mut self, sampler: &mut Sampler) {
        self.throughput.fill(1.0);
        self.radiance.fill(0.0);
        self.polarisation.clear();
        self.seen = None;
        self.lands = false;
        self.choose_hero(sampler);
    }

    /// The path carries all bands, and a band is drawn that it will keep where it must be split, or from here on.
    fn choose_hero(&mut self, sampler: &mut Sampler) {
        self.split = false;
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

    fn follow(&mut self, start: Edge, sampler: &mut Sampler) {
        self.follow_one(start, sampler);
        while let Some((mut carried, edge)) = self.branches.pop() {
            self.exchange(&mut carried);
            self.branches.give_back(carried);
            self.follow_one(edge, sampler);
        }
    }

    fn follow_one(&mut self, start: Edge, sampler: &mut Sampler) {
        let mut edge = start;
        loop {
            self.searches += 1;
            let Some((surface, crossing)) = self.scene.surfaces().closest(&edge.ray, f64::INFINITY) else {
                self.escape(&edge);
                return;
            };
            let point = self.scene.surfaces().surface_point(surface, &edge.ray, &crossing);
            self.emission(&edge, surface, &point);
            if self.limits.max_edges.is_some_and(|max| edge.count >= max) {
                return;
            }
            match self.scatter(&edge, surface, &point, sampler) {
                Some(next) => edge = next,
                None => return,
            }
        }
    }

    /// Carries what waited, which takes what was carried.
    fn exchange(&mut self, other: &mut Carried) {
        std::mem::swap(&mut self.throughput, &mut other.throughput);
        std::mem::swap(&mut self.polarisation, &mut other.polarisation);
        std::mem::swap(&mut self.split, &mut other.split);
        std::mem::swap(&mut self.hero, &mut other.hero);
        std::mem::swap(&mut self.seen, &mut other.seen);
    }

    /// Adds what a ray meets that leaves the scene.
    fn escape(&mut self, edge: &Edge) {
        for (index, light) in self.scene.lights().iter().enumerate() {
            self.value.fill(0.0);
            light.add_radiance(edge.ray.direction, &mut self.value);
            let rival = self.rival(edge.rival, index, edge.from, edge.ray.direction, f64::INFINITY);
            let other = edge.pdf.map_or(0.0, |pdf| {
                ratio(self.choice.probability(index) * light.pdf_towards(edge.from, edge.ray.direction), pdf)
            });
            self.add(power_heuristic(other, rival));
        }
    }

    /// Adds what the surface at the end of an edge emits towards it.
    fn emission(&mut self, edge: &Edge, surface: usize, point: &SurfacePoint) {
        let Some(emission) = self.scene.emission(surface) else { return };
        let away = -edge.ray.direction;
        let profile = emission.profile_towards(away, point.normal.dot(away));
        if profile == 0.0 {
            return;
        }
        let weight = self.scene.light_of_surface(surface).map_or(1.0, |light| {
            let (from, direction) = (edge.from, edge.ray.direction);
            let rival = self.rival(edge.rival, light, from, direction, from.distance(point.position));
            let other = edge.pdf.map_or(0.0, |pdf| {
                ratio(self.choice.probability(light) * self.scene.lights()[light].pdf_towards(from, direction), pdf)
            });
            power_heuristic(other, rival)
        });
        self.value.copy_from_slice(emission.radiance());
        self.add(weight * profile);
    }

    /// Seeks a light from a vertex and draws the next edge.
    fn scatter(&mut self, edge: &Edge, surface: usize, point: &SurfacePoint, sampler: &mut Sampler) -> Option<Edge> {
        let count = edge.count;
        let material = self.scene.material(surface);
        let frame = Frame::of(point.shading, point.tangent);
        let outgoing = frame.local(-edge.ray.direction);
        let u = sampler.four();
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
        let seek = !material.is_delta();
        let mut chance = edge.chance;
        if seek && edge.straight && chance < SEEN {
            // On the faintest ways nothing but lamps is bright enough to be looked for every time.
            if sampler.one() * SEEN >= chance {
                return None;
            }
            self.throughput.iter_mut().for_each(|t| *t *= SEEN / chance);
            chance = SEEN;
        }
        let shares = !self.split && material.is_diffuse() && self.virtual_lights.is_some();
        if shares && self.is_found(edge, point, sampler) {
            return None;
        }
        let hero = self.hero;
        // From the first vertex a packet is connected with the lens, unless it lands on a meter as on any surface.
        let connected = count == 1 && !self.lands;
        let rival = match connected {
            // Packets do not come to the lens straight from a mirror or from glass.
            true if seek => self.picture_sr * edge.from.distance_squared(point.position),
            true => 0.0,
            false => edge.rival,
        };
        let guided = self.guide.filter(|_| guide::suits(material)).map(|guide| guide.at(point.position));
        // How a packet that comes from `incident` is sent on the way that the path came.
        let sent = |incident| if !connected && rival > 0.0 { material.pdf(incident, outgoing, hero) } else { 1.0 };
        if seek {
            self.choice.prepare(self.scene.lights(), point.position);
            // Where the path ends here, no other strategy competes with the light's own.
            let competes = self.limits.follow == Follow::All;
            let function = |incident, value: &mut [f64]| {
                let pdf = evaluate(material, incident, outgoing, hero, value);
                let pdf = guided.map_or(pdf, |g| g.density(frame.world(incident), pdf));
                [if competes { pdf } else { 0.0 }, rival * sent(incident)]
            };
            self.light(point, u, function, &frame);
        }
        if shares {
            self.virtual_light(material, point, outgoing, &frame, count, u[3]);
        }
        if self.limits.follow == Follow::Nothing {
            return None;
        }
        let [u0, u1, u2, u3] = sampler.four();
        let at = Place { material, point, frame: &frame, outgoing };
        let mut here = Edge { straight: edge.straight && !seek, chance, ..*edge };
        // Either way of a Dirac lobe is as probable as the other; no packet comes to the lens from it.
        here.rival = if connected { 0.0 } else { rival };
        let drawn = match guided.and_then(|g| g.draw(sampler.four())) {
            Some(direction) => {
                let incident = frame.local(direction);
                let pdf = evaluate(material, incident, outgoing, hero, &mut self.value);
                // On the other side of the surface.
                if pdf == 0.0 {
                    return None;
                }
                self.value.iter_mut().for_each(|v| *v /= pdf);
                Scattered { direction: incident, pdf, delta: false, split: false, eta: 1.0 }
            }
            None => self.draw(&at, [u0, u1, u2])?,
        };
        if self.limits.follow == Follow::Specular && !drawn.delta {
            return None;
        }
        if drawn.delta {
            if here.straight && self.branch(&here, &at, &drawn, [u1, u2, u3]) {
                here.chance *= drawn.pdf;
                self.value.iter_mut().for_each(|v| *v *= drawn.pdf);
            }
            return self.onwards(&here, &at, &drawn, u3);
        }
        // By all ways of drawing the direction; the material's own may not know it.
        let pdf = guided.map_or(drawn.pdf, |g| g.density(frame.world(drawn.direction), drawn.pdf));
        if guided.is_some() {
            let scale = drawn.pdf / pdf;
            self.guided += 2;
            self.value.iter_mut().for_each(|v| *v *= scale);
            here.guided = (pdf / drawn.pdf).max(1.0);
        } else {
            here.guided = 1.0;
        }
        here.rival = rival * sent(drawn.direction) / pdf;
        let next = self.onwards(&here, &at, &drawn, u3)?;
        let shared = if shares { drawn.direction.z.abs() } else { 0.0 };
        Some(Edge { pdf: seek.then_some(pdf), shared, ..next })
    }

    /// Draws a direction at a vertex.
    fn draw(&mut self, at: &Place<'_>, u: [f64; 3]) -> Option<Scattered> {
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
    fn branch(&mut self, edge: &Edge, at: &Place<'_>, drawn: &Scattered, [u1, u2, u]: [f64; 3]) -> bool {
        if edge.chance * drawn.pdf.min(1.0 - drawn.pdf) < FAINTEST {
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
            let mut aside = self.branches.take(self.throughput.len());
            aside.throughput.copy_from_slice(&self.throughput);
            aside.polarisation.copy(&self.polarisation);
            (aside.split, aside.hero, aside.seen) = (self.split, self.hero, self.seen);
            self.value.iter_mut().for_each(|v| *v *= other.pdf);
            let next = self.onwards(&Edge { chance: edge.chance * other.pdf, ..*edge }, at, &other, u);
            self.exchange(&mut aside);
            match next {
                Some(next) => self.branches.push(aside, next),
                None => self.branches.give_back(aside),
            }
        }
        std::mem::swap(&mut self.value, &mut self.arriving);
        other.is_some()
    }

    /// Goes on in a direction that was drawn, with what [`Material::sample`] wrote; `edge` is the one that leads there, with what the next has of it.
    fn onwards(&mut self, edge: &Edge, at: &Place<'_>, drawn: &Scattered, u: f64) -> Option<Edge> {
        let Place { material, point, frame, outgoing } = *at;
        let direction = frame.world(drawn.direction);
        // A shading normal can send light through the surface: no light goes there.
        if direction.dot(point.normal) * drawn.direction.z <= 0.0 {
            return None;
        }
        multiply(&mut self.throughput, &self.value);
        if self.limits.polarisation && drawn.delta {
            let (hero, directions) = (self.hero, [edge.ray.direction, direction]);
            let bands = if self.split { hero..hero + 1 } else { 0..self.throughput.len() };
            let components = |c: &mut [_]| match bands.len() {
                1 => material.polarise_band(outgoing, drawn.direction, hero, c),
                _ => material.polarise(outgoing, drawn.direction, c),
            };
            let throughput = &mut self.throughput;
            self.polarisation.turn_bands(components, directions, point.shading, bands.clone(), throughput);
        } else {
            self.polarisation.clear();
        }
        if drawn.split {
            self.split();
        }
        let index_squared = edge.index_squared * drawn.eta * drawn.eta;
        let drawn_for = if self.limits.single_band { self.probability_of_hero() } else { 1.0 };
        let worth = index_squared * drawn_for * edge.guided / edge.chance;
        let strength = worth * self.throughput.iter().copied().fold(0.0, f64::max);
        if edge.count >= self.limits.roulette_from && strength < 1.0 {
            if u >= strength {
                return None;
            }
            self.throughput.iter_mut().for_each(|t| *t /= strength);
        }
        if strength == 0.0 {
            return None;
        }
        let ray = Ray { origin: point.origin_towards(direction), direction };
        let count = edge.count + 1;
        Some(Edge { ray, pdf: None, from: point.position, shared: 0.0, index_squared, count, ..*edge })
    }

    /// The density with which packets find a path whose last edge leads from `from` to a light, over that of the path's own way, given
    /// that ratio for all but the light's end.
    fn rival(&self, before: f64, light: usize, from: DVec3, direction: DVec3, distance: f64) -> f64 {
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
    fn light(
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
        if self.value.iter().all(|&v| v == 0.0) {
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
        multiply(&mut self.value, &self.arriving);
        self.add(weight);
    }

    /// Whether what the path would find from here on is left to virtual lights that were drawn where its last edge starts.
    fn is_found(&self, edge: &Edge, point: &SurfacePoint, sampler: &mut Sampler) -> bool {
        let Some(lights) = self.virtual_lights.as_ref().filter(|_| edge.shared > 0.0) else { return false };
        let cosines = edge.shared * edge.ray.direction.dot(point.normal).abs();
        let share = lights.share(cosines / edge.from.distance_squared(point.position));
        share == 1.0 || share > 0.0 && sampler.one() < share
    }

    /// Adds the light of some virtual lights, drawn at random by one number.
    fn virtual_light(
        &mut self,
        material: &dyn Material,
        point: &SurfacePoint,
        outgoing: DVec3,
        frame: &Frame,
        count: u32,
        u: f64,
    ) {
        let from = point.position;
        let normal = if outgoing.z < 0.0 { -point.shading } else { point.shading };
        let edges = self.limits.max_edges.map_or(u32::MAX, |max| max.saturating_sub(count + 1));
        if !self.virtual_lights.as_mut().is_some_and(|lights| lights.weigh(from, normal, edges)) {
            return;
        }
        for draw in 0..DRAWS {
            let Some(lights) = &self.virtual_lights else { return };
            let Some(drawn) = lights.draw(from, normal, (draw, u)) else { continue };
            let local = frame.local(drawn.direction);
            if drawn.direction.dot(point.normal) * local.z <= 0.0 {
                continue;
            }
            self.searches += 1;
            if !lights.arriving(point, &drawn, &mut self.arriving) {
                continue;
            }
            material.evaluate(local, outgoing, Transport::Radiance, &mut self.value);
            multiply(&mut self.value, &self.arriving);
            self.add(drawn.weight * local.z.abs());
        }
    }

    /// Adds throughput · value · weight: band by band, or of all bands of the light to the one that the instrument sees.
    fn add(&mut self, weight: f64) {
        let products = self.throughput.iter().zip(&self.value).map(|(t, v)| t * v * weight);
        match self.seen {
            Some(band) => self.radiance[band] += products.sum::<f64>(),
            None => self.radiance.iter_mut().zip(products).for_each(|(r, p)| *r += p),
        }
    }
}

/// Writes f_s |cosθ_i| and gives the density of the material's own sampling.
fn evaluate(material: &dyn Material, incident: DVec3, outgoing: DVec3, hero: usize, value: &mut [f64]) -> f64 {
    material.evaluate(incident, outgoing, Transport::Radiance, value);
    value.iter_mut().for_each(|v| *v *= incident.z.abs());
    material.pdf(outgoing, incident, hero)
}

fn multiply(values: &mut [f64], by: &[f64]) {
    values.iter_mut().zip(by).for_each(|(v, b)| *v *= b);
}

/// How much larger a density is than a path's own; infinite where that has none.
fn ratio(other: f64, own: f64) -> f64 {
    if own > 0.0 { other / own } else { f64::INFINITY }
}

/// p² / (p² + o² + r²) of the densities o/p and r/p of two other ways; 0 where p is, and they are infinite.
fn power_heuristic(other: f64, rival: f64) -> f64 {
    1.0 / (1.0 + other * other + rival * rival)
}

//! Where the energy of a scene goes: packets of flux are sent from every light and followed until they are absorbed or leave.
//!
//! ```text
//! Σ_lights emitted = Σ_materials absorbed + escaped
//! absorbed = arrived − scattered,   E[scattered] = a(ω) arrived
//! ```
//!
//! It shares lights, materials and surfaces with the path tracer, but walks the other way. Three things are checked:
//!
//! - the **balance**, whose only scatter is that of weak packets ending by chance. Where that is so unlikely that no packet ends, the
//!   replicates do not scatter, yet what goes on is a little too strong; so the standard error is at least that of the chances taken;
//! - every **light**: what its packets carry is the flux that it states. Every light gets some packets of its own, however faint it
//!   is beside the others, and the rest are shared out by flux. Where the lights are too many for that, all are drawn by flux, and a light
//!   that none was drawn for is not checked;
//! - every **material**: what it scatters, as drawn, is its directional-hemispherical reflectance a(ω) by quadrature or closed form
//!   times what arrived, at the packets' own directions. That is asked of a few vertices of each replicate (it costs a quadrature), and
//!   not of materials with mirrors and glass in them, whose share depends on the polarisation that a packet brings. Light that
//!   shading normals of a mesh send through the surface, and which is dropped, is found here, too.
//!
//! Fluorescence absorbs the energy between the photons that it takes and those that it gives.

use glam::DVec3;
use rayon::prelude::*;

use super::{figure, is_off};
use crate::render::estimate::{Figure, REPLICATES, stream};
use crate::render::integrator::light::{LightTracer, Visitor};
use crate::render::measure::Settings;
use crate::render::ray::Ray;
use crate::render::scene::Scene;

/// The number in the render whose random numbers the packets take: no instrument's.
const INSTRUMENT: u64 = u64::MAX;
/// Vertices of each material, in each replicate, that are asked for their reflectance.
const ASKED: u32 = 4;
/// Packets that every light gets in each replicate, where half of all are enough for that.
const OWN: u64 = 16;

/// What became of the flux of the lights, W (over the wavelengths carried).
#[derive(Debug, Clone, PartialEq)]
pub struct Energy {
    /// Packets sent.
    pub packets: u64,
    /// Packets left out, because a number of theirs was none.
    pub faulty: u64,
    /// Every light, in the order of the scene.
    pub lights: Vec<LightAccount>,
    /// Every material, as numbered by the caller.
    pub materials: Vec<MaterialAccount>,
    /// What left the scene.
    pub escaped_w: Figure,
    /// Emitted less absorbed less escaped.
    pub balance_w: Figure,
}

/// A light's part.
#[derive(Debug, Clone, PartialEq)]
pub struct LightAccount {
    /// The flux that it states.
    pub stated_w: f64,
    /// Packets sent from it.
    pub packets: u64,
    /// What its packets carried.
    pub emitted_w: Figure,
    /// Whether packets stand for what it does: not so for a production light that falls off as no light does.
    pub travels: bool,
}

/// A material's part.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialAccount {
    /// What arrived at its surfaces.
    pub arrived_w: Figure,
    /// What did not go on from there.
    pub absorbed_w: Figure,
    /// Scattered less reflectance times arrived, as a share of what arrived at the vertices that were asked; `None` where none was.
    pub excess: Option<Figure>,
}

impl Energy {
    /// What all lights emitted, W.
    #[must_use]
    pub fn emitted_w(&self) -> f64 {
        self.lights.iter().map(|l| l.emitted_w.value).sum()
    }

    /// Whether emitted and absorbed and escaped differ by more than chance.
    #[must_use]
    pub fn is_unbalanced(&self) -> bool {
        is_off(self.balance_w, self.emitted_w())
    }
}

impl LightAccount {
    /// Whether its packets carry another flux than it states.
    #[must_use]
    pub fn is_off(&self) -> bool {
        /// Quadratures of fluxes are this good (pictures' rims, production lights with hard edges).
        const QUADRATURE: f64 = 2e-3;
        /// ln 10 000: what makes up this share of N, over N, is in none of N packets once in 10 000 times, and their scatter does not
        /// know of it.
        const UNSEEN: f64 = 9.21;
        if self.packets == 0 {
            return false;
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of packets")]
        let unseen = UNSEEN / self.packets as f64;
        let error = (self.emitted_w.value - self.stated_w).abs() - (QUADRATURE + unseen) * self.stated_w;
        error > 0.0 && is_off(Figure { value: error, ..self.emitted_w }, self.stated_w)
    }
}

impl MaterialAccount {
    /// Whether it scatters another share than its reflectance.
    #[must_use]
    pub fn is_off(&self) -> bool {
        // Tables of what rough facets lose are good to 5e-4.
        self.excess.is_some_and(|e| {
            let beyond = Figure { value: e.value.abs() - 1e-3, ..e };
            beyond.value > 0.0 && is_off(beyond, 0.0)
        })
    }
}

/// One replicate's sums.
struct Ledger<'a> {
    scene: &'a Scene,
    /// The material of each surface.
    material_of: &'a [usize],
    /// What each band adds, nm.
    weights: &'a [f64],
    light: usize,
    sent: Vec<u64>,
    emitted: Vec<f64>,
    arrived: Vec<f64>,
    absorbed: Vec<f64>,
    escaped: f64,
    /// What the packet left the last surface with.
    left: Option<f64>,
    /// Variance that ending packets by chance gives to the sum of them, W².
    chance: f64,
    asked: Vec<u32>,
    /// Of the vertices asked: scattered less expected, and arrived.
    excess: Vec<f64>,
    checked: Vec<f64>,
    /// What the vertex at hand is to scatter, and what arrived there.
    expected: Option<(f64, f64)>,
    albedo: Vec<f64>,
    sound: bool,
}

impl Ledger<'_> {
    fn watts(&self, flux: &[f64]) -> f64 {
        flux.iter().zip(self.weights).map(|(f, w)| f * w).sum()
    }
}

impl Visitor for Ledger<'_> {
    fn starts(&mut self, light: usize) {
        self.light = light;
        self.sent[light] += 1;
    }

    fn emitted(&mut self, flux: &[f64]) {
        let watts = self.watts(flux);
        self.sound &= watts.is_finite();
        self.emitted[self.light] += watts;
        self.left = None;
    }

    fn flight(&mut self, _: &Ray, length: f64, flux: &[f64]) {
        let watts = self.watts(flux);
        if let Some(left) = self.left.take() {
            // f goes on as f/s with the probability s, of variance f² (1 − s)/s; taken where it does go on, that is over s.
            self.chance += (watts * (watts - left)).max(0.0);
        }
        if length.is_infinite() {
            self.escaped += watts;
        }
    }

    fn scatters(&mut self, surface: usize, arriving: DVec3, flux: &[f64]) {
        let (number, material) = (self.material_of[surface], self.scene.material(surface));
        self.expected = None;
        if self.asked[number] == ASKED || material.has_delta() {
            return;
        }
        self.asked[number] += 1;
        if material.albedo(arriving, &mut self.albedo).is_some() {
            let each = flux.iter().zip(&self.albedo).zip(self.weights);
            self.expected = Some((each.map(|((f, a), w)| f * a * w).sum(), self.watts(flux)));
        }
    }

    fn met(&mut self, surface: usize, before: &[f64], after: &[f64]) {
        let number = self.material_of[surface];
        let (before, after) = (self.watts(before), self.watts(after));
        self.sound &= before.is_finite() && after.is_finite();
        self.arrived[number] += before;
        self.absorbed[number] += before - after;
        self.left = Some(after);
        if let Some((expected, arrived)) = self.expected.take() {
            self.excess[number] += after - expected;
            self.checked[number] += arrived;
        }
    }
}

/// How many of the `each` packets of a replicate every light gets; `None` where that is not two for every light that shines (triangles
/// of a mesh are a light each).
fn allot(stated: &[f64], each: u64) -> Option<Vec<u64>> {
    let shines = |w: &f64| *w > 0.0;
    let lights = stated.iter().filter(|w| shines(w)).count() as u64;
    let own = OWN.min(each / (2 * lights));
    if own == 0 {
        return None;
    }
    #[expect(clippy::cast_precision_loss, reason = "a number of packets")]
    let rest = (each - own * lights) as f64;
    let total: f64 = stated.iter().copied().filter(shines).sum();
    let (mut sum, mut given) = (0.0, 0);
    let allotted = (stated.iter())
        .map(|w| {
            if !shines(w) {
                return 0;
            }
            sum += w;
            // Rounded running sums: no packet is lost.
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "between 0 and a number of packets"
            )]
            let until = (rest * (sum / total)).round() as u64;
            let more = until - given;
            given = until;
            own + more
        })
        .collect();
    Some(allotted)
}

/// A step that goes through all of 0..n, a golden section of them at a time, so that any few in a row are spread over it.
fn step(n: u64) -> u64 {
    let gcd = |mut a: u64, mut b: u64| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    (n * 5 / 8..n).find(|s| gcd(*s, n) == 1).unwrap_or(1)
}

/// Sends `packets` packets, a number of them for each of 32 replicates, and counts what becomes of them; `None` where nothing
/// shines. `material_of` is the number of the material of each surface, below `materials`; `weights` what each band adds to a flux (nm).
#[must_use]
pub fn audit(
    scene: &Scene,
    settings: &Settings,
    weights: &[f64],
    material_of: &[usize],
    materials: usize,
    packets: u64,
) -> Option<Energy> {
    let mut flux = vec![0.0; scene.bands().len()];
    let stated: Vec<f64> = (scene.lights().iter())
        .map(|light| {
            light.flux(&mut flux);
            flux.iter().zip(weights).map(|(f, w)| f * w).sum()
        })
        .collect();
    let each = packets.div_ceil(REPLICATES as u64);
    let total: f64 = stated.iter().sum();
    if each == 0 || total.is_nan() || total <= 0.0 {
        return None;
    }
    let allotted = allot(&stated, each);
    let mut until = allotted.clone().unwrap_or_default();
    (1..until.len()).for_each(|n| until[n] += until[n - 1]);
    #[expect(clippy::cast_precision_loss, reason = "numbers of packets")]
    let share = |light: usize| (until[light] - if light == 0 { 0 } else { until[light - 1] }) as f64 / each as f64;
    let step = step(each);
    let run = |replicate: usize| {
        let stream = stream(INSTRUMENT, replicate);
        let mut sampler = settings.sampler(stream);
        let mut tracer = LightTracer::new(scene, &settings.heroes);
        let mut ledger = Ledger {
            scene,
            material_of,
            weights,
            light: 0,
            sent: vec![0; stated.len()],
            emitted: vec![0.0; stated.len()],
            arrived: vec![0.0; materials],
            absorbed: vec![0.0; materials],
            escaped: 0.0,
            left: None,
            chance: 0.0,
            asked: vec![0; materials],
            excess: vec![0.0; materials],
            checked: vec![0.0; materials],
            expected: None,
            albedo: vec![0.0; scene.bands().len()],
            sound: true,
        };
        for index in 0..each {
            // Not light by light: the first vertices of a material are those that are asked.
            let index = index * step % each;
            sampler.start(index);
            if allotted.is_some() {
                let light = until.partition_point(|u| *u <= index);
                tracer.packet_of(light, share(light), &mut sampler, &mut ledger);
            } else {
                tracer.packet(&mut sampler, &mut ledger);
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of packets")]
        let n = each as f64;
        let sums = [&mut ledger.emitted, &mut ledger.arrived, &mut ledger.absorbed];
        sums.into_iter().flatten().chain([&mut ledger.escaped]).for_each(|sum| *sum /= n);
        ledger.chance /= n * n;
        ledger
    };
    let all: Vec<Ledger<'_>> = (0..REPLICATES).into_par_iter().map(run).collect();
    // A replicate with a number that is none says nothing.
    let sound: Vec<&Ledger<'_>> = all.iter().filter(|l| l.sound).collect();
    if sound.len() < 2 {
        return None;
    }
    let of = |value: &dyn Fn(&Ledger<'_>) -> f64| figure(&sound.iter().map(|l| value(l)).collect::<Vec<_>>());
    let lights = (0..stated.len())
        .map(|n| LightAccount {
            stated_w: stated[n],
            packets: (allotted.as_ref())
                .map_or_else(|| sound.iter().map(|l| l.sent[n]).sum(), |allotted| allotted[n] * sound.len() as u64),
            emitted_w: of(&|l| l.emitted[n]),
            travels: scene.lights()[n].emits_what_arrives(),
        })
        .collect();
    let accounts = (0..materials)
        .map(|n| {
            let checked = of(&|l| l.checked[n]).value;
            // A ratio of sums: to first order the error of the numerator over the mean of the denominator.
            let excess = (checked > 0.0).then(|| {
                let ratio = of(&|l| l.excess[n]).value / checked;
                let error = of(&|l| (l.excess[n] - ratio * l.checked[n]) / checked).standard_error;
                Figure { value: ratio, standard_error: error }
            });
            MaterialAccount { arrived_w: of(&|l| l.arrived[n]), absorbed_w: of(&|l| l.absorbed[n]), excess }
        })
        .collect();
    let mut balance = of(&|l| l.emitted.iter().sum::<f64>() - l.absorbed.iter().sum::<f64>() - l.escaped);
    #[expect(clippy::cast_precision_loss, reason = "a number of replicates")]
    let chance = sound.iter().map(|l| l.chance).sum::<f64>().sqrt() / sound.len() as f64;
    balance.standard_error = balance.standard_error.max(chance);
    Some(Energy {
        packets: each * sound.len() as u64,
        faulty: each * (all.len() - sound.len()) as u64,
        lights,
        materials: accounts,
        escaped_w: of(&|l| l.escaped),
        balance_w: balance,
    })
}

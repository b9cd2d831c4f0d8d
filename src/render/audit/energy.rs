//! Where the energy of a scene goes: packets of flux are sent from every light and followed until they are absorbed or leave.
//!
//! ```text
//! Σ_lights emitted = Σ_materials absorbed + escaped
//! absorbed = arrived − scattered,   E[scattered] = a(ω) arrived
//! ```
//!
//! It shares lights, materials and surfaces with the path tracer, but walks the other way. Three things are checked:
//!
//! - the **balance**, whose only scatter is that of weak packets ending by chance;
//! - every **light**: what its packets carry is the flux that it states;
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
        let error = (self.emitted_w.value - self.stated_w).abs() - QUADRATURE * self.stated_w;
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
    emitted: Vec<f64>,
    arrived: Vec<f64>,
    absorbed: Vec<f64>,
    escaped: f64,
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
    }

    fn emitted(&mut self, flux: &[f64]) {
        let watts = self.watts(flux);
        self.sound &= watts.is_finite();
        self.emitted[self.light] += watts;
    }

    fn flight(&mut self, _: &Ray, length: f64, flux: &[f64]) {
        if length.is_infinite() {
            self.escaped += self.watts(flux);
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
        if let Some((expected, arrived)) = self.expected.take() {
            self.excess[number] += after - expected;
            self.checked[number] += arrived;
        }
    }
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
    let run = |replicate: usize| {
        let stream = stream(INSTRUMENT, replicate);
        let mut sampler = settings.sampler(stream);
        let mut tracer = LightTracer::new(scene, &settings.heroes);
        let mut ledger = Ledger {
            scene,
            material_of,
            weights,
            light: 0,
            emitted: vec![0.0; stated.len()],
            arrived: vec![0.0; materials],
            absorbed: vec![0.0; materials],
            escaped: 0.0,
            asked: vec![0; materials],
            excess: vec![0.0; materials],
            checked: vec![0.0; materials],
            expected: None,
            albedo: vec![0.0; scene.bands().len()],
            sound: true,
        };
        for index in 0..each {
            sampler.start(index);
            tracer.packet(&mut sampler, &mut ledger);
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of packets")]
        let n = each as f64;
        let sums = [&mut ledger.emitted, &mut ledger.arrived, &mut ledger.absorbed];
        sums.into_iter().flatten().chain([&mut ledger.escaped]).for_each(|sum| *sum /= n);
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
    let balance = |l: &Ledger<'_>| l.emitted.iter().sum::<f64>() - l.absorbed.iter().sum::<f64>() - l.escaped;
    Some(Energy {
        packets: each * sound.len() as u64,
        faulty: each * (all.len() - sound.len()) as u64,
        lights,
        materials: accounts,
        escaped_w: of(&|l| l.escaped),
        balance_w: of(&balance),
    })
}

//! Radiosity: the light of a scene of diffuse surfaces, without random numbers.
//!
//! ```text
//! E_i = E⁰_i + Σ_j F_ij M_j        M_i = M⁰_i + ρ_i E_i
//! A_i F_ij = A_j F_ji
//! ```
//!
//! E⁰ is the irradiance of a patch by lights that are no diffuse surfaces, M⁰ what it emits itself, ρ its reflectance; of a fluorescent
//! surface a matrix between wavelengths (its bispectral reflectance). All bands at once. Each side of a patch is an element of its own.
//!
//! | file | what it does |
//! |---|---|
//! | `patches`, `cut` | surfaces cut into patches, and those where others meet them |
//! | `factor`, `links` | what two patches exchange, and all of them |
//! | `reflection` | what elements make of the light that they receive |
//! | `lights` | light that was not reflected yet |
//! | [`gather`] | what meters and cameras see of the solution |
//! | [`picture`] | a camera's picture |
//!
//! The equations are solved by gathering, element after element, each with what was found before it (Gauss and Seidel). Links are made
//! once, A_i F_ij = A_j F_ji by construction. What is done in parallel does not depend on the number of threads.
//!
//! What limits it: within a patch radiosity is the same everywhere, and visibility is found by four rays from each of sixteen points. Both errors fall
//! with the patches' edge; the same scene with edges twice as long tells how large they are.
//!
//! References: C. M. Goral, K. E. Torrance, D. P. Greenberg, B. Battaile, *Modeling the Interaction of Light Between Diffuse Surfaces*,
//! SIGGRAPH 1984; D. R. Baum, H. E. Rushmeier, J. M. Winget, *Improving Radiosity Solutions Through the Use of Analytically Determined
//! Form-Factors*, SIGGRAPH 1989.

mod cut;
mod factor;
pub mod gather;
mod lights;
mod links;
mod patches;
pub mod picture;
mod reflection;

use std::f64::consts::PI;

use rayon::prelude::*;

use super::scene::Scene;
use lights::Lights;
pub use patches::MOST as MOST_PATCHES;
use patches::Patches;
pub use reflection::diffuse;
use reflection::{Operator, Reflection};

/// How a scene is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The longest edge of a patch, m, about; without one as many patches as make a quick solution.
    pub edge_m: Option<f64>,
    /// How far the solution may be from that of its equations, relative to all light.
    pub tolerance: f64,
}

/// Why a scene could not be solved.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// More patches than there is room for.
    #[error(
        "{found} patches with edges of {edge_m} m; expected at most {MOST_PATCHES}: a longer `patch_edge`, or the solver \"path\""
    )]
    TooMany {
        /// How many there would be.
        found: usize,
        /// Their edge, m.
        edge_m: f64,
    },
    /// The light grows from sweep to sweep, or hardly falls.
    #[error(
        "after {sweeps} sweeps the solution still changes by {residual}; expected {tolerance}: a closed scene whose surfaces absorb nothing has none"
    )]
    NoSolution {
        /// How often all elements were visited.
        sweeps: usize,
        /// The last change, relative.
        residual: f64,
        /// What was to be reached.
        tolerance: f64,
    },
}

/// What came out beside the light itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Patches.
    pub patches: usize,
    /// Pairs of elements, ordered, that see each other.
    pub links: usize,
    /// The longest edge of a patch, m, about.
    pub edge_m: f64,
    /// How often all elements were visited.
    pub sweeps: usize,
    /// Bound on what is missing for the equations to hold, relative to all light.
    pub residual: f64,
    /// The greatest sum of form factors of an element: 1 inside of a closed scene, but for the discretisation.
    pub greatest_sum: f64,
    /// Flux that was emitted, W.
    pub emitted_w: f64,
    /// Flux that surfaces absorbed, W; the loss in a change of wavelength is in it.
    pub absorbed_w: f64,
    /// Flux that met nothing, W; negative by what form factors exceed 1.
    pub escaped_w: f64,
}

impl Summary {
    /// What was emitted and neither absorbed nor let out, W.
    #[must_use]
    pub fn balance_w(&self) -> f64 {
        self.emitted_w - self.absorbed_w - self.escaped_w
    }
}

/// The light of a scene: irradiance and exitance of every element.
#[derive(Debug)]
pub struct Solution<'a> {
    scene: &'a Scene,
    patches: Patches,
    lights: Lights,
    /// Of each element (twice its patch, and 1 for the inside), band by band, W/m²/nm or W/m².
    irradiance: Vec<f64>,
    /// What leaves it of what arrived.
    reflected: Vec<f64>,
    /// Elements that emit.
    emitters: Vec<usize>,
    /// What came out beside the light.
    pub summary: Summary,
}

/// Irradiances of both sides of the patches by what is no diffuse surface.
fn direct(scene: &Scene, patches: &Patches, lights: &Lights) -> Vec<f64> {
    /// Directions to a light of some extent from each of the sixteen nodes of a patch.
    const DIRECTIONS: u32 = 64;
    let n = scene.bands().len();
    let mut out = vec![0.0; 2 * n * patches.all.len()];
    out.par_chunks_mut(2 * n).zip(&patches.all).for_each(|(sides, patch)| {
        let mut arriving = vec![0.0; n];
        for (shift, node) in (0_u32..).zip(&patch.fine) {
            let point = patch.point(&node.spot, false);
            lights.visit(scene, &point, (DIRECTIONS, shift), &mut arriving, |towards, irradiance| {
                let cos = towards.dot(node.spot.normal);
                let side = if cos > 0.0 { &mut sides[..n] } else { &mut sides[n..] };
                side.iter_mut().zip(irradiance).for_each(|(s, e)| *s += node.weight * cos.abs() * e);
            });
        }
    });
    out
}

/// The exitances of the elements that emit diffusely, and which those are.
fn emitted(scene: &Scene, patches: &Patches) -> (Vec<f64>, Vec<usize>) {
    let n = scene.bands().len();
    let mut out = vec![0.0; 2 * n * patches.all.len()];
    let mut emitters = Vec::new();
    for (element, values) in out.chunks_exact_mut(n).enumerate() {
        let surface = patches.all[element / 2].surface;
        if !lights::is_diffuse_emitter(scene, surface) || patches.all[element / 2].hidden {
            continue;
        }
        let emission = scene.emission(surface).filter(|e| element % 2 == 0 || e.is_two_sided());
        if let Some(emission) = emission {
            values.iter_mut().zip(emission.radiance()).for_each(|(v, l)| *v = PI * l);
            emitters.push(element);
        }
    }
    (out, emitters)
}

/// Solves a scene, all of whose materials are [`diffuse`] and whose surfaces are bounded; `radiant` weighs the bands for fluxes (nm).
///
/// # Errors
/// [`Error`].
pub fn solve<'a>(scene: &'a Scene, settings: &Settings, radiant: &[f64]) -> Result<Solution<'a>, Error> {
    /// Sweeps at most.
    const MOST_SWEEPS: usize = 20_000;
    let n = scene.bands().len();
    let (patches, edge_m) = Patches::new(scene, settings.edge_m)?;
    let lights = Lights::new(scene);
    let links = links::links(scene, &patches);
    let direct = direct(scene, &patches, &lights);
    let (own, emitters) = emitted(scene, &patches);
    let reflection = Reflection::new(scene);
    let operators: Vec<Operator> = (0..links.len())
        .into_par_iter()
        .map(|element| Operator::new(&reflection, &patches.all[element / 2], element % 2 == 1))
        .collect();
    // What is received in the place of a hidden patch is the other's.
    let area = |element: usize| match &patches.all[element / 2] {
        patch if patch.hidden => 0.0,
        patch => patch.area,
    };
    let sums: Vec<f64> = links.iter().map(|l| l.factors.iter().sum()).collect();
    let flux = |element: usize, values: &[f64]| -> f64 {
        area(element) * values.iter().zip(radiant).map(|(v, w)| v * w).sum::<f64>()
    };
    let total = |values: &[f64]| -> f64 { values.chunks_exact(n).enumerate().map(|(e, v)| flux(e, v)).sum() };
    let (mut irradiance, mut reflected) = (direct.clone(), vec![0.0; direct.len()]);
    let mut exitance = own.clone();
    let mut gathered = vec![0.0; n];
    let (mut sweeps, mut last) = (0, f64::INFINITY);
    let residual = loop {
        sweeps += 1;
        let mut change = 0.0;
        for (element, links) in links.iter().enumerate() {
            let range = element * n..(element + 1) * n;
            gathered.copy_from_slice(&direct[range.clone()]);
            for (other, factor) in links.elements.iter().zip(&links.factors) {
                let from = *other as usize * n;
                gathered.iter_mut().zip(&exitance[from..from + n]).for_each(|(g, m)| *g += factor * m);
            }
            let weighed = |(new, old): (&f64, &f64)| (new - old).abs();
            let moved = gathered.iter().zip(&irradiance[range.clone()]).map(weighed).zip(radiant);
            change += area(element) * moved.map(|(d, w)| d * w).sum::<f64>();
            irradiance[range.clone()].copy_from_slice(&gathered);
            if !patches.all[element / 2].hidden {
                operators[element].apply(&gathered, &mut reflected[range.clone()]);
            }
            let leaving = &mut exitance[range.clone()];
            leaving.iter_mut().zip(&reflected[range.clone()]).zip(&own[range]).for_each(|((m, r), o)| *m = r + o);
        }
        let whole = total(&irradiance);
        let relative = if whole > 0.0 { change / whole } else { 0.0 };
        // The changes fall like a geometric series: what is still to come is the last one times q/(1 − q).
        let ratio = if last > 0.0 && last.is_finite() { (relative / last).min(1.0) } else { 0.5 };
        let to_come = if ratio < 1.0 { relative * ratio / (1.0 - ratio) } else { f64::INFINITY };
        let residual = if relative == 0.0 { 0.0 } else { to_come.max(relative) };
        if residual <= settings.tolerance {
            break residual;
        }
        if sweeps == MOST_SWEEPS || !relative.is_finite() {
            return Err(Error::NoSolution { sweeps, residual: relative, tolerance: settings.tolerance });
        }
        last = relative;
    };
    let mut stated = vec![0.0; n];
    let mut of_lights = 0.0;
    for &number in &lights.numbers {
        scene.lights()[number].flux(&mut stated);
        of_lights += stated.iter().zip(radiant).map(|(f, w)| f * w).sum::<f64>();
    }
    let missed: f64 = (exitance.chunks_exact(n).enumerate()).map(|(e, m)| (1.0 - sums[e]) * flux(e, m)).sum();
    let summary = Summary {
        patches: patches.all.len(),
        links: links.iter().map(|l| l.elements.len()).sum(),
        edge_m,
        sweeps,
        residual,
        greatest_sum: sums.iter().copied().fold(0.0, f64::max),
        emitted_w: total(&own) + of_lights,
        absorbed_w: total(&irradiance) - total(&reflected),
        escaped_w: missed + of_lights - total(&direct),
    };
    Ok(Solution { scene, patches, lights, irradiance, reflected, emitters, summary })
}

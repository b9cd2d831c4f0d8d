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
//! | `patches` | surfaces cut into patches |
//! | `factor` | what two patches exchange |
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

mod factor;
pub mod gather;
mod lights;
mod patches;
pub mod picture;

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use super::material::{Material, Transport};
use super::scene::Scene;
use crate::geometry::direction;
use lights::Lights;
pub use patches::MOST as MOST_PATCHES;
use patches::Patches;

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

/// Directions in which a material is asked whether it is diffuse: polar angle and azimuth, degrees.
const ASKED: [(f64, f64); 6] = [(3.0, 0.0), (30.0, 20.0), (30.0, 200.0), (55.0, 95.0), (75.0, 180.0), (86.0, 310.0)];

/// The reflectance of a diffuse material, per band, of its outside and its inside (of what [`Material::convert`] leaves); `None` where it
/// is not the same in all directions.
#[must_use]
pub fn diffuse(material: &dyn Material, bands: usize) -> Option<[Vec<f64>; 2]> {
    if material.has_delta() || material.is_transmissive() || material.splits() {
        return None;
    }
    let mut found: [Option<Vec<f64>>; 2] = [None, None];
    let mut value = vec![0.0; bands];
    for (side, reflectance) in found.iter_mut().enumerate() {
        let flip = |(theta, phi): (f64, f64)| {
            let d = direction::from_degrees(theta, phi);
            if side == 0 { d } else { DVec3::new(d.x, d.y, -d.z) }
        };
        for incident in ASKED {
            for outgoing in ASKED {
                material.evaluate(flip(incident), flip(outgoing), Transport::Flux, &mut value);
                value.iter_mut().for_each(|v| *v *= PI);
                match reflectance {
                    None => *reflectance = Some(value.clone()),
                    Some(first) if first.iter().zip(&value).any(|(a, b)| (a - b).abs() > 1e-9) => return None,
                    Some(_) => {}
                }
            }
        }
    }
    let [Some(outside), Some(inside)] = found else { return None };
    Some([outside, inside])
}

/// How the elements reflect.
#[derive(Debug)]
struct Reflection<'a> {
    scene: &'a Scene,
    /// By surface and side.
    plain: Vec<[Vec<f64>; 2]>,
}

impl<'a> Reflection<'a> {
    /// Of a scene whose materials are all [`diffuse`]; one that is not counts as black.
    fn new(scene: &'a Scene) -> Self {
        let n = scene.bands().len();
        let of = |surface| diffuse(scene.material(surface), n).unwrap_or_else(|| [vec![0.0; n], vec![0.0; n]]);
        Self { scene, plain: (0..scene.surfaces().shapes().len()).map(of).collect() }
    }

    /// Turns an irradiance into what leaves the surface of it, at texture coordinates `uv`.
    fn apply(&self, surface: usize, back: bool, uv: glam::DVec2, values: &mut [f64], scratch: &mut [f64]) {
        self.scene.material(surface).convert(uv, Transport::Flux, values, scratch);
        multiply(values, &self.plain[surface][usize::from(back)]);
    }
}

/// What an element makes of its irradiance, the mean over the patch.
enum Operator {
    /// Each band by itself.
    Factors(Vec<f64>),
    /// Rows of outgoing bands, columns of incident ones.
    Matrix(Vec<f64>),
}

impl Operator {
    /// Of a side of a patch.
    fn new(reflection: &Reflection<'_>, patch: &patches::Patch, back: bool) -> Self {
        let scene = reflection.scene;
        let (n, material) = (scene.bands().len(), scene.material(patch.surface));
        if !material.converts() {
            return Self::Factors(reflection.plain[patch.surface][usize::from(back)].clone());
        }
        // A matrix takes the square of the bands for each of them: one point of the patch stands for all.
        let nodes: &[patches::Node] = if material.nature().fluoresces { &patch.coarse[..1] } else { &patch.fine };
        let places: Vec<_> =
            (nodes.iter()).filter_map(|node| Some((patch.surface_point(scene, &node.spot)?.uv, node.weight))).collect();
        let whole: f64 = places.iter().map(|p| p.1).sum();
        let (mut value, mut scratch) = (vec![0.0; n], vec![0.0; n]);
        // The mean of what becomes of an irradiance.
        let mut of = |start: &dyn Fn(&mut [f64])| {
            let mut mean = vec![0.0; n];
            for (uv, weight) in &places {
                start(&mut value);
                reflection.apply(patch.surface, back, *uv, &mut value, &mut scratch);
                mean.iter_mut().zip(&value).for_each(|(m, v)| *m += v * weight / whole);
            }
            mean
        };
        if !material.nature().fluoresces {
            return Self::Factors(of(&|value| value.fill(1.0)));
        }
        let mut matrix = vec![0.0; n * n];
        for incident in 0..n {
            let column = of(&|value| {
                value.fill(0.0);
                value[incident] = 1.0;
            });
            column.into_iter().enumerate().for_each(|(outgoing, v)| matrix[outgoing * n + incident] = v);
        }
        Self::Matrix(matrix)
    }

    fn apply(&self, irradiance: &[f64], out: &mut [f64]) {
        match self {
            Self::Factors(factors) => {
                out.iter_mut().zip(irradiance).zip(factors).for_each(|((o, e), f)| *o = e * f);
            }
            Self::Matrix(matrix) => {
                let rows = matrix.chunks_exact(irradiance.len());
                out.iter_mut().zip(rows).for_each(|(o, row)| *o = row.iter().zip(irradiance).map(|(m, e)| m * e).sum());
            }
        }
    }
}

fn multiply(values: &mut [f64], by: &[f64]) {
    values.iter_mut().zip(by).for_each(|(v, b)| *v *= b);
}

/// The form factors of an element to those that it sees.
#[derive(Debug, Clone, Default)]
struct Links {
    elements: Vec<u32>,
    factors: Vec<f64>,
}

/// The form factors of all elements: A_i F_ij is computed once for a pair.
fn links(scene: &Scene, patches: &Patches) -> Vec<Links> {
    let all = &patches.all;
    let of = |i: usize| -> Vec<(usize, factor::Exchange)> {
        (0..=i).filter_map(|j| Some((j, factor::exchange(scene, &all[i], &all[j])?))).collect()
    };
    // The later have more partners: handed out one by one.
    let pairs: Vec<_> = (0..all.len()).into_par_iter().with_max_len(1).map(of).collect();
    let mut links = vec![Links::default(); 2 * all.len()];
    for (i, partners) in pairs.into_iter().enumerate() {
        for (j, exchange) in partners {
            for (side_i, row) in exchange.iter().enumerate() {
                for (side_j, g) in row.iter().enumerate().filter(|(_, g)| **g > 0.0) {
                    let mut link = |a: usize, area: f64, b: usize| {
                        #[expect(clippy::cast_possible_truncation, reason = "twice the most patches")]
                        links[a].elements.push(b as u32);
                        links[a].factors.push(g / area);
                    };
                    link(2 * i + side_i, all[i].area, 2 * j + side_j);
                    if i != j {
                        link(2 * j + side_j, all[j].area, 2 * i + side_i);
                    }
                }
            }
        }
    }
    links
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
        if !lights::is_diffuse_emitter(scene, surface) {
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
    let links = links(scene, &patches);
    let direct = direct(scene, &patches, &lights);
    let (own, emitters) = emitted(scene, &patches);
    let reflection = Reflection::new(scene);
    let operators: Vec<Operator> = (0..links.len())
        .into_par_iter()
        .map(|element| Operator::new(&reflection, &patches.all[element / 2], element % 2 == 1))
        .collect();
    let area = |element: usize| patches.all[element / 2].area;
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
            operators[element].apply(&gathered, &mut reflected[range.clone()]);
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

//! What to photograph next: the lights that would cover most of what has not been measured.
//!
//! A sphere shows all normals at once, so that a light is told by one number, its angle α to the camera as seen from the sphere: α is twice
//! the difference angle θ_d of all that it gives, and on which side of the camera it stands makes no difference to an isotropic material.
//! Other shapes are looked at from eight sides besides. Lights at α from 0° to 175° are tried; each is counted by the bins that it would be the first to cover, and the best is taken before the next one
//! is looked for.

use std::collections::HashSet;
use std::f64::consts::TAU;

use glam::DVec2;
use rayon::prelude::*;

use super::{Binned, Hit, Scene};
use crate::brdf::coordinates::HalfDiff;
use crate::brdf::table::Resolution;
use crate::capture::setup::Place;

/// Bins that are counted: 3° wide, so that a light covers a row of θ_d and not a thread in it.
const COARSE: Resolution = Resolution { theta_h: 30, theta_d: 30, phi_d: 60 };
/// Steps of α, degrees.
const STEP_DEG: f64 = 5.0;
/// Steps of α.
const STEPS: u32 = 36;
/// Sides of the camera on which lights are tried where that makes a difference.
const SIDES: u32 = 8;
/// Pixels that are looked at for one side, about.
const PIXELS: usize = 40_000;

/// A light to be added.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Next {
    /// Its angle to the camera as seen from the middle of the object, degrees.
    pub to_camera_deg: f64,
    /// Its direction from the middle of the object; of a sphere, one to the right of the camera.
    pub direction: [f64; 3],
    /// Bins that it would be the first to cover, of those that any light can cover from this camera.
    pub new_bins: usize,
    /// Part of those bins that is covered with it and the ones before it.
    pub covered_fraction: f64,
}

/// The next `count` lights for pictures of `size` (columns, rows), best first; fewer where nothing is left to be covered. Also the part of the bins
/// within reach of this camera and any light that is covered now, 0 to 1.
#[must_use]
pub fn next_lights(scene: &Scene, size: (usize, usize), binned: &Binned, count: usize) -> (f64, Vec<Next>) {
    let sides = if scene.is_sphere() { 1 } else { SIDES };
    let every = ((size.0 * size.1 * sides as usize / PIXELS) as f64).sqrt().floor().max(1.0);
    let hits = hits(scene, size, every);
    let candidates: Vec<(f64, [f64; 3], HashSet<usize>)> = (0..STEPS)
        .into_par_iter()
        .flat_map_iter(|n| (0..sides).map(move |side| (n, side)))
        // Before the camera and behind the object all sides are one.
        .filter(|(n, side)| *n > 0 || *side == 0)
        .map(|(n, side)| {
            let to_camera_deg = STEP_DEG * f64::from(n);
            let azimuth = f64::from(side) / f64::from(sides) * TAU;
            let direction = scene.beside_camera(to_camera_deg.to_radians(), azimuth).to_array();
            (to_camera_deg, direction, covered_by(scene, &hits, Place::Distant(direction)))
        })
        .collect();
    let reach: HashSet<usize> = candidates.iter().flat_map(|c| c.2.iter().copied()).collect();
    let mut have: HashSet<usize> = binned.bins.iter().map(|b| COARSE.bin(&binned.resolution.centre(b.bin))).collect();
    have.retain(|b| reach.contains(b));
    let part = |have: &HashSet<usize>| have.len() as f64 / reach.len().max(1) as f64;
    let now = part(&have);
    let mut out = Vec::new();
    while out.len() < count {
        let gain = |bins: &HashSet<usize>| bins.difference(&have).count();
        // Of equals the one nearest to the camera.
        let best = candidates.iter().map(|c| (gain(&c.2), c)).fold(None, |best, c| match best {
            Some((most, _)) if most >= c.0 => best,
            _ => Some(c),
        });
        let Some((new_bins, (to_camera_deg, direction, bins))) = best.filter(|b| b.0 > 0) else { break };
        have.extend(bins);
        out.push(Next {
            to_camera_deg: *to_camera_deg,
            direction: *direction,
            new_bins,
            covered_fraction: part(&have),
        });
    }
    (now, out)
}

/// What pixels see of the object.
fn hits(scene: &Scene, size: (usize, usize), every: f64) -> Vec<Hit> {
    let (columns, rows) = ((size.0 as f64 / every) as u32, (size.1 as f64 / every) as u32);
    let pixels = (0..rows).flat_map(|y| (0..columns).map(move |x| DVec2::new(f64::from(x), f64::from(y)) * every));
    pixels.filter_map(|p| scene.hit(p)).collect()
}

/// Bins that a light would cover.
fn covered_by(scene: &Scene, hits: &[Hit], place: Place) -> HashSet<usize> {
    let seen = hits.iter().map(|hit| scene.view_of(hit, place)).filter(|v| scene.is_within_limits(v));
    seen.map(|v| COARSE.bin(&HalfDiff::new(v.incident, v.outgoing))).collect()
}

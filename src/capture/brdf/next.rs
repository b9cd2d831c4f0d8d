//! What to photograph next: the lights that would cover most of what has not been measured.
//!
//! A sphere shows all normals at once, so that a light is told by one number, its angle α to the camera as seen from the sphere: α is twice
//! the difference angle θ_d of all that it gives, and on which side of the camera it stands makes no difference to an isotropic material.
//! Lights at α from 0° to 175° are tried; each is counted by the bins that it would be the first to cover, and the best is taken before the next one
//! is looked for.

use std::collections::HashSet;

use glam::DVec2;

use super::{Binned, Scene};
use crate::brdf::coordinates::HalfDiff;
use crate::brdf::table::Resolution;
use crate::capture::setup::Place;

/// Bins that are counted: 3° wide, so that a light covers a row of θ_d and not a thread in it.
const COARSE: Resolution = Resolution { theta_h: 30, theta_d: 30, phi_d: 60 };
/// Steps of α, degrees.
const STEP_DEG: f64 = 5.0;
/// Steps of α.
const STEPS: u32 = 36;
/// Pixels that are looked at, about.
const PIXELS: usize = 40_000;

/// A light to be added.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Next {
    /// Its angle to the camera as seen from the middle of the sphere, degrees.
    pub to_camera_deg: f64,
    /// One such direction from the middle of the sphere, to the right of the camera.
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
    let every = ((size.0 * size.1 / PIXELS) as f64).sqrt().floor().max(1.0);
    let candidates: Vec<(f64, [f64; 3], HashSet<usize>)> = (0..STEPS)
        .map(|n| {
            let to_camera_deg = STEP_DEG * f64::from(n);
            let direction = scene.beside_camera(to_camera_deg.to_radians());
            (to_camera_deg, direction.to_array(), covered_by(scene, size, every, Place::Distant(direction.to_array())))
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

/// Bins that a light would cover.
fn covered_by(scene: &Scene, size: (usize, usize), every: f64, place: Place) -> HashSet<usize> {
    let (columns, rows) = ((size.0 as f64 / every) as u32, (size.1 as f64 / every) as u32);
    let pixels = (0..rows).flat_map(|y| (0..columns).map(move |x| DVec2::new(f64::from(x), f64::from(y)) * every));
    let seen = pixels.filter_map(|p| scene.view(p, place)).filter(|v| scene.is_within_limits(v));
    seen.map(|v| COARSE.bin(&HalfDiff::new(v.incident, v.outgoing))).collect()
}

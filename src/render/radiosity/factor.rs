//! What two patches exchange: A₁F₁₂ in closed form over one of them and by quadrature over the other, times the part of the rays
//! between them that nothing hides.
//!
//! ```text
//! A₁ F₁₂ = ∫ Ω⊥₂(x)/π dA₁         Ω⊥₂: projected solid angle, in closed form, of a flat patch 2
//! A₁ F₁₂ = ∫∫ cosθ₁ cosθ₂/(π r²) dA₂ dA₁          of two curved ones
//! ```
//!
//! Far apart a rule of two or four points in each coordinate is enough; close together the integral is adaptive, to 1e-7 of itself.

use std::f64::consts::PI;

use super::patches::{Node, Patch};
use crate::math::cubature::{Tolerance, rectangle};
use crate::render::ray::Ray;
use crate::render::scene::Scene;
use crate::render::shape::chart::Spot;

/// Radius over distance up to which the coarse and the fine rule do.
const FAR: f64 = 0.07;
const MIDDLE: f64 = 0.25;
/// Of the adaptive rule: of the mean of Ω⊥/π over a patch.
const TOLERANCE: Tolerance = Tolerance { absolute: 1e-9, relative: 1e-7, evaluations: 6000 };
/// Rays stop so short of what they are to reach, relative to the distance.
pub(super) const SHORT: f64 = 1e-6;

/// A₁F₁₂ between the sides of two patches: by the side of the first, then of the second; 0 the outside, 1 the inside.
pub(super) type Exchange = [[f64; 2]; 2];

/// Which sides of `a` look at points of `b`, by the plane of a flat `a`.
fn sides(a: &Patch, b: &Patch) -> [bool; 2] {
    if !a.cell.is_flat() {
        return [true; 2];
    }
    // In the plane within rounding is on neither side.
    let least = 1e-12 * (a.radius + b.radius + a.centre.distance(b.centre));
    b.cell.extremes().iter().fold([false; 2], |[above, below], p| {
        let height = a.cell.height(*p).unwrap_or(0.0);
        [above || height > least, below || height < -least]
    })
}

/// What the patches exchange; `None` where neither sees the other.
pub(super) fn exchange(scene: &Scene, a: &Patch, b: &Patch) -> Option<Exchange> {
    if a.hidden && b.hidden {
        return None;
    }
    let (ahead, behind) = (sides(a, b), sides(b, a));
    if ahead == [false; 2] || behind == [false; 2] {
        return None;
    }
    let mut all = [[0.0; 2]; 2];
    for side_a in [0, 1] {
        for side_b in [0, 1] {
            if !(ahead[side_a] && behind[side_b]) {
                continue;
            }
            let visible = visible(scene, a, side_a == 1, b, side_b == 1);
            if visible > 0.0 {
                all[side_a][side_b] = exchanged(scene, (a, side_a == 1), (b, side_b == 1), visible);
            }
        }
    }
    all.iter().flatten().any(|g| *g > 0.0).then_some(all)
}

fn flip(normal: glam::DVec3, back: bool) -> glam::DVec3 {
    if back { -normal } else { normal }
}

/// cosθ₁ cosθ₂/r², 0 where either looks away.
fn kernel(a: &Node, back_a: bool, b: &Node, back_b: bool) -> f64 {
    let way = b.spot.position - a.spot.position;
    let square = way.length_squared();
    let (own, other) = (flip(a.spot.normal, back_a).dot(way), -flip(b.spot.normal, back_b).dot(way));
    if own > 0.0 && other > 0.0 { own / square * (other / square) } else { 0.0 }
}

/// A₁F₁₂ of the sides of two patches of which the part `visible` is not hidden.
fn exchanged(scene: &Scene, (a, back_a): (&Patch, bool), (b, back_b): (&Patch, bool), visible: f64) -> f64 {
    // The closed form is that of a flat one; of two flat ones the smaller is summed over.
    let swap = if a.cell.is_flat() == b.cell.is_flat() { a.area > b.area } else { a.cell.is_flat() };
    let (from, back_from, to, back_to) = if swap { (b, back_b, a, back_a) } else { (a, back_a, b, back_b) };
    if !to.cell.is_flat() {
        let sum: f64 = (from.coarse.iter())
            .flat_map(|x| to.fine.iter().map(move |y| x.weight * y.weight * kernel(x, back_from, y, back_to)))
            .sum();
        return visible * from.area * to.area * sum / PI;
    }
    let seen = |spot: &Spot| {
        let height = to.cell.height(spot.position).unwrap_or(0.0);
        if (height < 0.0) == back_to {
            to.cell.projected_solid_angle(spot.position, flip(spot.normal, back_from)).unwrap_or(0.0) / PI
        } else {
            0.0
        }
    };
    if visible < 1.0 {
        // Every point has a view of its own: one may be covered by what stands beside the other.
        let view = |x: &Node| {
            let seen = seen(&x.spot);
            if seen == 0.0 { 0.0 } else { x.weight * seen * view(scene, (from, back_from, x), (to, back_to)) }
        };
        return from.area * from.fine.iter().map(view).sum::<f64>();
    }
    let gap = from.centre.distance(to.centre) - to.radius;
    let ratio = if gap > 0.0 { from.radius / gap } else { f64::INFINITY };
    let mean = if ratio < MIDDLE {
        let nodes = if ratio < FAR { &from.coarse } else { &from.fine };
        nodes.iter().map(|n| n.weight * seen(&n.spot)).sum()
    } else {
        let mut mean = [0.0];
        let f = |p: [f64; 2], value: &mut [f64]| {
            let (spot, density) = from.cell.at(p);
            value[0] = density * seen(&spot);
        };
        rectangle(f, [0.0; 2], [1.0; 2], TOLERANCE, &mut mean);
        mean[0]
    };
    from.area * mean
}

/// Whether nothing stands between a point of a patch and another point.
pub(super) fn is_clear(scene: &Scene, a: &Patch, back_a: bool, from: &Node, to: &Node) -> bool {
    let way = to.spot.position - from.spot.position;
    let distance = way.length();
    let direction = way / distance;
    let origin = a.point(&from.spot, back_a).origin_towards(direction);
    !scene.surfaces().is_occluded(&Ray { origin, direction }, distance * (1.0 - SHORT), None)
}

/// The part of a patch, as a point of another sees it, that nothing hides: by four rays.
fn view(scene: &Scene, (a, back_a, x): (&Patch, bool, &Node), (b, back_b): (&Patch, bool)) -> f64 {
    part(b.coarse.iter().map(|y| (x, y)), scene, a, back_a, back_b).unwrap_or(0.0)
}

/// The part of what some pairs of points exchange that nothing hides; `None` where they exchange nothing.
fn part<'a>(
    pairs: impl Iterator<Item = (&'a Node, &'a Node)>,
    scene: &Scene,
    a: &Patch,
    back_a: bool,
    back_b: bool,
) -> Option<f64> {
    let (mut all, mut clear) = (0.0, 0.0);
    for (x, y) in pairs {
        let weight = x.weight * y.weight * kernel(x, back_a, y, back_b);
        all += weight;
        if weight > 0.0 && is_clear(scene, a, back_a, x, y) {
            clear += weight;
        }
    }
    (all > 0.0).then(|| clear / all)
}

/// The part of what two patches would exchange that nothing hides: of four rays where they are far apart and those agree, else of all
/// sixteen between their nodes.
fn visible(scene: &Scene, a: &Patch, back_a: bool, b: &Patch, back_b: bool) -> f64 {
    let pairs = |of: &mut dyn Iterator<Item = (usize, usize)>| {
        part(of.map(|(i, j)| (&a.coarse[i], &b.coarse[j])), scene, a, back_a, back_b)
    };
    if a.radius.max(b.radius) < FAR * a.centre.distance(b.centre) {
        let few = pairs(&mut (0..4).map(|i| (i, (i + 1) % 4)));
        if let Some(whole) = few.filter(|part| *part == 0.0 || *part == 1.0) {
            return whole;
        }
    }
    // Where no pair of nodes faces, both look at each other's edges alone, and nothing is known to hide them.
    pairs(&mut (0..16).map(|k| (k / 4, k % 4))).unwrap_or(1.0)
}

//! The search among many boxes: a `hierarchy` in single precision, made safe for tests in double precision at its
//! leaves.
//!
//! - The boxes are moved and scaled so that all of them lie in [−1, 1]³, whatever their size and place, and widened by `PAD`, which
//!   is more than everything that is rounded on the way: the boxes, the planes that nodes
//!   keep of them, the ray's origin and direction, the slab test. A ray that the
//!   leaf's own test would find is therefore never turned away before.
//! - A ray from far away starts where it enters the outermost box.
//! - The ray starts a little before its origin, so that boxes about the origin lie ahead.

use glam::DVec3;
use rayon::prelude::*;

use super::hierarchy::{Hierarchy, Line};
use super::shape::Bounds;

/// How far boxes are widened, and how far before its origin a ray starts; the outermost box has a half-width of 1.
const PAD: f64 = 4e-6;
/// The greatest inverse of a direction's component; larger ones overflow in the slab test.
const STEEPEST: f32 = 1e30;

/// Boxes, each with the number that it was given.
#[derive(Debug)]
pub struct Tree {
    hierarchy: Hierarchy,
    /// The number of the box at each place of the hierarchy; empty where every number is its place.
    numbers: Vec<u32>,
    centre: DVec3,
    /// From metres to the frame in which the outermost box is [−1, 1]³ or smaller.
    scale: f64,
    /// The outermost box, in that frame, widened.
    reach: DVec3,
}

impl Tree {
    /// The hierarchy of the boxes given, all finite; their numbers are their places in the list.
    #[must_use]
    pub fn new(boxes: &[Bounds]) -> Self {
        let all = boxes.par_iter().copied().reduce(|| Bounds::EMPTY, Bounds::union);
        if boxes.is_empty() {
            return Self {
                hierarchy: Hierarchy::default(),
                numbers: Vec::new(),
                centre: DVec3::ZERO,
                scale: 1.0,
                reach: DVec3::ZERO,
            };
        }
        // Halved before they are added: the sum of the largest numbers would overflow.
        let centre = 0.5 * all.min + 0.5 * all.max;
        let half = (0.5 * all.max - 0.5 * all.min).max_element();
        let scale = if half > 0.0 { 1.0 / half } else { 1.0 };
        let (hierarchy, numbers) = Hierarchy::new(boxes.par_iter().map(|b| {
            let (min, max) = ((b.min - centre) * scale, (b.max - centre) * scale);
            ((min - PAD).as_vec3a(), (max + PAD).as_vec3a())
        }));
        let reach = (0.5 * all.max - 0.5 * all.min) * scale + 2.0 * PAD;
        Self { hierarchy, numbers, centre, scale, reach }
    }

    /// Calls `test` with the numbers of boxes that the ray (a direction of any length) may meet at parameters in (0, `far`), roughly from
    /// near to far. `test` gets the parameter beyond which nothing matters any more and returns a smaller one where it found something.
    /// Returns the last one.
    pub fn closest(
        &self,
        origin: DVec3,
        direction: DVec3,
        far: f64,
        mut test: impl FnMut(usize, f64) -> Option<f64>,
    ) -> f64 {
        let Some(local) = self.local(origin, direction, far) else { return far };
        let mut best = far;
        self.hierarchy.closest(local.line, local.parameter(far), |place| {
            best = test(self.number(place), best)?;
            Some(local.parameter(best))
        });
        best
    }

    /// Whether `test` is true for any of the boxes that the ray may meet at parameters in (0, `far`).
    pub fn any(&self, origin: DVec3, direction: DVec3, far: f64, mut test: impl FnMut(usize) -> bool) -> bool {
        let Some(local) = self.local(origin, direction, far) else { return false };
        self.hierarchy.any(local.line, local.parameter(far), |place| test(self.number(place)))
    }

    fn number(&self, place: usize) -> usize {
        self.numbers.get(place).map_or(place, |&number| number as usize)
    }

    /// The ray in the hierarchy's frame, begun at the outermost box; `None` where it passes by.
    fn local(&self, origin: DVec3, direction: DVec3, far: f64) -> Option<Local> {
        let o = (origin - self.centre) * self.scale;
        // Parameters are kept, so the direction is scaled as lengths are; its length is divided out below.
        let d = direction * self.scale;
        let inverse = d.recip();
        let (a, b) = ((-self.reach - o) * inverse, (self.reach - o) * inverse);
        // A component of 0 inside its slab gives −∞ and ∞; on its very face 0 · ∞, which min and max pass over.
        let enter = a.min(b).max_element().max(0.0);
        let leave = a.max(b).min_element().min(far);
        if enter.is_nan() || leave.is_nan() || enter > leave {
            return None;
        }
        let length = d.length();
        // Back by PAD, so that boxes about the origin lie ahead.
        let start = o + d * (enter - PAD / length);
        let unit = (d / length).as_vec3();
        let invert = |x: f32| if x.abs() < 1.0 / STEEPEST { STEEPEST.copysign(x) } else { 1.0 / x };
        let line = Line { origin: start.as_vec3().to_array(), inverse: unit.to_array().map(invert) };
        Some(Local { line, enter, length })
    }

    /// Numbers the boxes anew, in the order of the leaves, so that boxes close together have close numbers; the old number of each.
    pub fn renumber(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.numbers)
    }

    /// Bytes of the hierarchy.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.hierarchy.bytes() + size_of_val(self.numbers.as_slice())
    }
}

/// A ray in the hierarchy's frame.
struct Local {
    line: Line,
    /// The parameter of the caller's ray at which it begins, but for [`PAD`].
    enter: f64,
    /// Length of the caller's direction in the frame.
    length: f64,
}

impl Local {
    /// The distance in the frame of the caller's parameter, rounded away from the origin.
    fn parameter(&self, t: f64) -> f32 {
        let exact = (t - self.enter) * self.length + 2.0 * PAD;
        #[expect(clippy::cast_possible_truncation, reason = "and widened by more than the rounding")]
        let rounded = (exact * (1.0 + 2.0 * f64::from(f32::EPSILON))) as f32;
        rounded
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;

    fn boxes(random: &mut Stream, count: usize, size: f64) -> Vec<Bounds> {
        (0..count)
            .map(|_| {
                let [x, y, z, s] = random.uniforms();
                let (centre, half) = (DVec3::new(x, y, z) - 0.5, DVec3::splat(s * size));
                Bounds { min: centre - half, max: centre + half }
            })
            .collect()
    }

    /// Parameters at which a ray enters and leaves a box.
    fn slabs(b: &Bounds, o: DVec3, d: DVec3) -> Option<(f64, f64)> {
        let (p, q) = ((b.min - o) / d, (b.max - o) / d);
        let (enter, leave) = (p.min(q).max_element(), p.max(q).min_element());
        (enter <= leave && leave > 0.0).then_some((enter.max(0.0), leave))
    }

    /// Whatever the scale and the place, a ray is told of every box that it passes through in double precision.
    #[test]
    fn no_box_is_missed() {
        for (scale, shift) in [(1.0, 0.0), (1e-8, 0.0), (1e8, 0.0), (1.0, 1e6), (1e-3, -4e5)] {
            let mut random = Stream::new(3, 1);
            let at = |p: DVec3| p * scale + shift;
            let boxes: Vec<Bounds> =
                boxes(&mut random, 500, 0.02).into_iter().map(|b| Bounds { min: at(b.min), max: at(b.max) }).collect();
            let tree = Tree::new(&boxes);
            for n in 0..300 {
                let [x, y, z, a, b, c] = random.uniforms();
                // From outside and far away, from inside, along an axis.
                let from = at((DVec3::new(x, y, z) - 0.5) * if n % 3 == 0 { 50.0 } else { 1.0 });
                let to = at(DVec3::new(a, b, c) - 0.5);
                // Along an axis, forwards and backwards: with components of 0 and of −0.
                let sign = if n % 2 == 0 { 0.7 } else { -0.7 };
                let direction = if n % 5 == 0 { DVec3::AXES[n % 3] * sign * scale } else { to - from };
                let mut told = vec![false; boxes.len()];
                tree.closest(from, direction, f64::INFINITY, |i, _| {
                    told[i] = true;
                    None
                });
                for (i, b) in boxes.iter().enumerate() {
                    if slabs(b, from, direction).is_some() {
                        assert!(told[i], "box {i} of scale {scale}, shift {shift}, ray {n}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_first_box_is_found_and_what_lies_beyond_is_left_out() {
        let mut random = Stream::new(4, 1);
        let boxes = boxes(&mut random, 2000, 0.01);
        let tree = Tree::new(&boxes);
        let mut tested = 0;
        for _ in 0..500 {
            let [x, y, z, a, b, c] = random.uniforms();
            let (from, to) = (DVec3::new(x, y, z) * 4.0 - 2.0, DVec3::new(a, b, c) - 0.5);
            let direction = (to - from) * 3.0;
            let expected = boxes.iter().filter_map(|b| Some(slabs(b, from, direction)?.0)).fold(9.0, f64::min);
            let found = tree.closest(from, direction, 9.0, |i, best| {
                tested += 1;
                slabs(&boxes[i], from, direction).map(|s| s.0).filter(|t| *t < best)
            });
            assert_eq!(found, expected);
            let hit = |far: f64| {
                tree.any(from, direction, far, |i| slabs(&boxes[i], from, direction).is_some_and(|s| s.0 < far))
            };
            assert_eq!(hit(9.0), expected < 9.0);
            assert!(!hit(expected * (1.0 - 1e-12)));
        }
        assert!(tested < 500 * 200, "{tested} of {} boxes were tested", 500 * boxes.len());
    }

    /// Boxes one inside the other, each a third of the next, make a hierarchy that is a chain.
    #[test]
    fn a_deep_hierarchy_is_searched() {
        let boxes: Vec<Bounds> = (0..600)
            .map(|i| {
                let half = DVec3::splat(1.05_f64.powi(i) * 1e-6);
                let corner = DVec3::splat(1.05_f64.powi(i) * 3e-6);
                Bounds { min: corner - half, max: corner + half }
            })
            .collect();
        let tree = Tree::new(&boxes);
        for (i, b) in boxes.iter().enumerate() {
            let middle = 0.5 * (b.min + b.max);
            let mut told = false;
            tree.closest(middle + DVec3::Z * 1e9, DVec3::NEG_Z, f64::INFINITY, |n, _| {
                told |= n == i;
                None
            });
            assert!(told, "box {i}");
        }
    }

    #[test]
    fn none_one_and_flat_boxes() {
        assert_eq!(Tree::new(&[]).closest(DVec3::ZERO, DVec3::X, 7.0, |_, _| Some(1.0)), 7.0);
        let point = Tree::new(&[Bounds { min: DVec3::ONE, max: DVec3::ONE }]);
        assert!(point.any(DVec3::ZERO, DVec3::ONE, 2.0, |_| true));
        let flat = Tree::new(&[Bounds { min: DVec3::new(-1.0, -1.0, 2.0), max: DVec3::new(1.0, 1.0, 2.0) }]);
        assert!(flat.any(DVec3::ZERO, DVec3::Z, 3.0, |_| true));
        // A ray within the plane of a flat box meets it.
        assert!(flat.any(DVec3::new(-3.0, 0.0, 2.0), DVec3::X, 5.0, |_| true));
        assert!(!flat.any(DVec3::ZERO, DVec3::NEG_Z, 3.0, |_| true));
    }
}

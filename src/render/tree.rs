//! The search among many boxes: an eight-wide bounding-volume hierarchy of the crate `obvhs`, in single precision, made safe for tests
//! in double precision at its leaves.
//!
//! - The boxes are moved and scaled so that all of them lie in [−1, 1]³, whatever their size and place, and widened by `PAD`, which
//!   is more than everything that is rounded on the way: the boxes, the ray's origin and direction, the slab test. A ray that the
//!   leaf's own test would find is therefore never turned away before.
//! - A ray from far away starts where it enters the outermost box.
//! - The crate takes no notice of boxes that end nearer than 1e-4 along the ray's parameter, and replaces the inverse of small
//!   components of the direction. So the direction handed to it is short (`STEP`), its inverse is ours, and the ray starts a little
//!   before its origin.
//!
//! Reference: H. Ylitie, T. Karras, S. Laine, *Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs*, HPG 2017.

use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::ploc::PlocBuilder;
use obvhs::ray::{Ray as Traversed, RayHit};
use obvhs::{Boundable, BvhBuildParams};

use super::shape::Bounds;

/// How far boxes are widened, and how far before its origin a ray starts; the outermost box has a half-width of 1.
const PAD: f64 = 4e-6;
/// Length of the direction that is handed to the crate.
const STEP: f64 = 1.0 / 1024.0;
/// Groups of nodes that the crate's stack can hold; a hierarchy as deep as this is divided.
const DEEPEST: usize = 30;
/// Boxes in a leaf at most.
const LEAF: u32 = 3;
/// The greatest inverse of a direction's component; larger ones overflow in the slab test.
const STEEPEST: f32 = 1e30;

/// Boxes, each with the number that it was given.
#[derive(Debug)]
pub struct Tree {
    /// One hierarchy, or several where one would be too deep.
    parts: Vec<Part>,
    centre: DVec3,
    /// From metres to the frame in which the outermost box is [−1, 1]³ or smaller.
    scale: f64,
    /// The outermost box, in that frame, widened.
    reach: DVec3,
}

#[derive(Debug)]
struct Part {
    bvh: CwBvh,
    /// The number of the box behind each leaf.
    numbers: Vec<u32>,
}

/// A box of the hierarchy, which the crate asks for.
struct Leaf(Aabb);

impl Boundable for Leaf {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Tree {
    /// The hierarchy of the boxes given, all finite; their numbers are their places in the list.
    #[must_use]
    pub fn new(boxes: &[Bounds]) -> Self {
        let all = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union);
        if boxes.is_empty() {
            return Self { parts: Vec::new(), centre: DVec3::ZERO, scale: 1.0, reach: DVec3::ZERO };
        }
        // Halved before they are added: the sum of the largest numbers would overflow.
        let centre = 0.5 * all.min + 0.5 * all.max;
        let half = (0.5 * all.max - 0.5 * all.min).max_element();
        let scale = if half > 0.0 { 1.0 / half } else { 1.0 };
        let leaves: Vec<Leaf> = boxes
            .iter()
            .map(|b| {
                let (min, max) = ((b.min - centre) * scale, (b.max - centre) * scale);
                Leaf(Aabb::new((min - PAD).as_vec3a(), (max + PAD).as_vec3a()))
            })
            .collect();
        #[expect(clippy::cast_possible_truncation, reason = "the crate numbers boxes by u32")]
        let numbers = (0..leaves.len() as u32).collect();
        let mut parts = Vec::new();
        build(&leaves, numbers, &mut parts);
        let reach = (0.5 * all.max - 0.5 * all.min) * scale + 2.0 * PAD;
        Self { parts, centre, scale, reach }
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
        for part in &self.parts {
            let mut ray = local.ray;
            ray.tmax = local.parameter(best);
            part.bvh.ray_traverse(ray, &mut RayHit::none(), |_, leaf| match test(part.number(leaf), best) {
                Some(t) => {
                    best = t;
                    local.parameter(t)
                }
                None => f32::INFINITY,
            });
        }
        best
    }

    /// Whether `test` is true for any of the boxes that the ray may meet at parameters in (0, `far`).
    pub fn any(&self, origin: DVec3, direction: DVec3, far: f64, mut test: impl FnMut(usize) -> bool) -> bool {
        let Some(local) = self.local(origin, direction, far) else { return false };
        self.parts.iter().any(|part| {
            !part.bvh.ray_traverse_miss(local.ray, |_, leaf| {
                if test(part.number(leaf)) { f32::NEG_INFINITY } else { f32::INFINITY }
            })
        })
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
        let per_parameter = length / STEP;
        // Back by PAD, so that boxes about the origin lie ahead.
        let start = o + d * (enter - PAD / length);
        // The crate goes by the sign of the direction in some places and of its inverse in others: no −0, which is both.
        let unit = (d * (STEP / length)).as_vec3a() + Vec3A::ZERO;
        let invert = |x: f32| if x.abs() < 1.0 / STEEPEST { STEEPEST.copysign(x) } else { 1.0 / x };
        let ray = Traversed {
            origin: start.as_vec3a(),
            direction: unit,
            inv_direction: Vec3A::new(invert(unit.x), invert(unit.y), invert(unit.z)),
            tmin: 0.0,
            tmax: f32::INFINITY,
        };
        let mut local = Local { ray, enter, per_parameter };
        local.ray.tmax = local.parameter(far);
        Some(local)
    }

    /// Numbers the boxes anew, in the order of the leaves, so that boxes close together have close numbers; the old number of each.
    pub fn renumber(&mut self) -> Vec<u32> {
        let old: Vec<u32> = self.parts.iter().flat_map(|part| part.numbers.iter().copied()).collect();
        for (number, new) in (0..).zip(self.parts.iter_mut().flat_map(|part| &mut part.numbers)) {
            *new = number;
        }
        old
    }

    /// Bytes of the hierarchy.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let of = |p: &Part| size_of_val(p.bvh.nodes.as_slice()) + 4 * p.numbers.len();
        self.parts.iter().map(of).sum()
    }
}

impl Part {
    fn number(&self, leaf: usize) -> usize {
        self.numbers[leaf] as usize
    }
}

/// A ray in the frame of a hierarchy.
struct Local {
    ray: Traversed,
    /// The parameter of the caller's ray at which it begins, but for [`PAD`].
    enter: f64,
    /// From the caller's parameter to the crate's.
    per_parameter: f64,
}

impl Local {
    /// The crate's parameter for the caller's, rounded away from the origin.
    fn parameter(&self, t: f64) -> f32 {
        let exact = (t - self.enter) * self.per_parameter + 2.0 * PAD / STEP;
        #[expect(clippy::cast_possible_truncation, reason = "and widened by more than the rounding")]
        let rounded = (exact * (1.0 + 2.0 * f64::from(f32::EPSILON))) as f32;
        rounded
    }
}

/// Builds a hierarchy, and two of half the boxes each where it would be too deep for the crate's stack.
fn build(leaves: &[Leaf], numbers: Vec<u32>, parts: &mut Vec<Part>) {
    // As the crate's own `build_cwbvh` does, but for a check in debug builds that panics where a hierarchy is too deep.
    let params = BvhBuildParams::medium_build();
    #[expect(clippy::cast_possible_truncation, reason = "the crate numbers boxes by u32")]
    let order = (0..leaves.len() as u32).collect();
    let mut binary = PlocBuilder::with_capacity(leaves.len()).build(
        params.ploc_search_distance,
        leaves,
        order,
        params.sort_precision,
        params.search_depth_threshold,
    );
    ReinsertionOptimizer::default().run(&mut binary, params.reinsertion_batch_ratio, None);
    let bvh = bvh2_to_cwbvh(&binary, LEAF, true, false);
    if depth(&bvh) > DEEPEST && leaves.len() > 1 {
        let (near, far) = leaves.split_at(leaves.len() / 2);
        let (first, second) = numbers.split_at(near.len());
        build(near, first.to_vec(), parts);
        build(far, second.to_vec(), parts);
        return;
    }
    let numbers = bvh.primitive_indices.iter().map(|i| numbers[*i as usize]).collect();
    parts.push(Part { bvh: CwBvh { primitive_indices: Vec::new(), exact_node_aabbs: None, ..bvh }, numbers });
}

/// Levels of nodes.
fn depth(bvh: &CwBvh) -> usize {
    let mut deepest = 0;
    let mut stack = vec![(0_usize, 1_usize)];
    while let Some((node, level)) = stack.pop() {
        let Some(found) = bvh.nodes.get(node) else { continue };
        deepest = deepest.max(level);
        let children = found.imask.count_ones() as usize;
        let base = found.child_base_idx as usize;
        stack.extend((0..children).map(|child| (base + child, level + 1)));
    }
    deepest
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
                let direction = if n % 5 == 0 { DVec3::AXES[n % 3] * 0.7 * scale } else { to - from };
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
    fn a_deep_hierarchy_is_divided() {
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
        assert!(tree.parts.iter().all(|p| depth(&p.bvh) <= DEEPEST));
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

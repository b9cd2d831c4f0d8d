//! A tree of boxes: which of many things may a ray meet, nearest first.
//!
//! The boxes are kept in `f32` and quantised (eight children of a node share 80 bytes; H. Ylitie, T. Karras, S. Laine, *Efficient
//! Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs*, HPG 2017, as built by the crate `obvhs`). What decides is the
//! caller's test in `f64`; the tree must only never pass over a thing that this test would hit:
//!
//! - The tree has a frame of its own, in which the boxes fill the cube from −1 to 1, whatever their size and place in the world.
//! - A ray is clipped to that cube in `f64` and starts there, so that `f32` never sees a coordinate much beyond 1.
//! - In the frame, `f32` then displaces a plane of a box by at most 2.4·10⁻⁶: the origin (2 u), the rounded direction and its inverse
//!   (6 u), the difference and the products of the slab test (17 u), u = 2⁻²⁴, and the quantisation (8·10⁻⁷). Boxes are grown by
//!   [`PAD`] = 3.8·10⁻⁶.
//! - The crate's box test ignores what lies nearer than 10⁻⁴. Its unit is made [`UNITS`] to a frame's, and the start is moved back by
//!   [`PAD`], so that nothing ahead of the ray is that near.
//!
//! This holds for rays that start up to 10⁹ half-extents away; from farther off, a direction in `f64` does not resolve the boxes.

use std::cmp::Ordering;

use glam::{DVec3, UVec2, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;

use super::ray::Ray;
use super::shape::Bounds;

/// How much boxes are grown, and the start of a ray moved back, in units of the frame: 2⁻¹⁸.
const PAD: f64 = 1.0 / 262_144.0;

/// Units of the crate's distances to one of the frame.
const UNITS: f64 = 1024.0;

/// The least component of a direction, so that its inverse stays finite: over the cube's diagonal it displaces a ray by 4·10⁻⁸.
const LEAST: f64 = 1e-8;

/// The stack of the crate's traversal holds this many levels and would overwrite its last one beyond.
const STACK: usize = 32;

/// A binary tree deeper than this is built anew, balanced: the crate's conversion recurses.
const DEEPEST: usize = obvhs::bvh2::DEFAULT_MAX_STACK_DEPTH;

/// A tree over boxes. The boxes are renumbered: those close together have close numbers ([`Tree::take_order`]).
#[derive(Debug)]
pub struct Tree {
    bvh: CwBvh,
    /// The box of all boxes, m.
    bounds: Bounds,
    /// Its middle, m.
    centre: DVec3,
    /// Units of the frame per metre.
    scale: f64,
    /// Half the extent of `bounds` in the frame.
    half: DVec3,
}

impl Tree {
    /// The tree over `count` boxes, which must be finite.
    pub fn new(count: usize, bounds_of: impl Fn(usize) -> Bounds + Sync) -> Self {
        let bounds = (0..count)
            .into_par_iter()
            .fold(|| Bounds::EMPTY, |all, i| all.union(bounds_of(i)))
            .reduce(|| Bounds::EMPTY, Bounds::union);
        if count == 0 {
            return Self { bvh: CwBvh::default(), bounds, centre: DVec3::ZERO, scale: 1.0, half: DVec3::ZERO };
        }
        let centre = 0.5 * bounds.min + 0.5 * bounds.max;
        let half = 0.5 * bounds.max - 0.5 * bounds.min;
        let scale = 1.0 / half.max_element().max(f64::MIN_POSITIVE);
        let boxes: Vec<Aabb> = (0..count)
            .into_par_iter()
            .map(|i| {
                let b = bounds_of(i);
                let corner = |p: DVec3, grown: f64| ((p - centre) * scale + grown).as_vec3a();
                Aabb::new(corner(b.min, -PAD), corner(b.max, PAD))
            })
            .collect();
        Self { bvh: build(&boxes), bounds, centre, scale, half: half * scale }
    }

    /// The box of all boxes, m; empty for a tree without any.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// For each box of the tree's numbering the number it was given with. The tree forgets it.
    pub fn take_order(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.bvh.primitive_indices)
    }

    /// Shows `visit` the numbers of all boxes that the ray may meet before `far`, roughly from the nearest on. It gets the present
    /// `far` and returns the one from then on: the distance of a hit, or what it got; 0 ends the search. Distances are multiples of
    /// the ray's direction, which need not be a unit vector.
    #[inline]
    pub fn search(&self, ray: &Ray, far: f64, mut visit: impl FnMut(usize, f64) -> f64) {
        if self.bvh.nodes.is_empty() {
            return;
        }
        let origin = (ray.origin - self.centre) * self.scale;
        let direction = ray.direction * self.scale;
        let length = direction.length();
        let direction = direction / length;
        // Clip to the cube. Components of the direction that are zero give infinite distances of the right sign, except from a
        // plane of the cube itself, which `max` and `min` of numbers drop.
        let pad = PAD + 4.0 * f64::EPSILON * origin.abs().max_element();
        let (mut enter, mut leave) = (0.0_f64, far * length);
        for axis in 0..3 {
            let inverse = 1.0 / direction[axis];
            let half = (self.half[axis] + pad).copysign(inverse);
            enter = enter.max((-half - origin[axis]) * inverse);
            leave = leave.min((half - origin[axis]) * inverse);
        }
        if enter > leave || !length.is_normal() {
            return;
        }
        let start = origin + (enter - PAD) * direction;
        let limit = |far: f64| (((far * length).min(leave) - enter + PAD) * UNITS) as f32;
        let along = direction.abs().max(DVec3::splat(LEAST)).copysign(direction);
        let mut clipped = obvhs::ray::Ray {
            origin: start.as_vec3a(),
            direction: along.as_vec3a(),
            inv_direction: (UNITS / along).as_vec3a(),
            tmin: 0.0,
            tmax: limit(far).next_up(),
        };
        let mut far = far;
        let mut state = self.bvh.new_traversal(clipped.direction);
        let mut node;
        obvhs::traverse!(self.bvh, node, state, node.intersect_ray(&clipped, state.oct_inv4), {
            let now = visit(state.primitive_id as usize, far);
            if now < far {
                if now <= 0.0 {
                    return;
                }
                far = now;
                clipped.tmax = limit(far).next_up();
            }
        });
    }
}

/// The crate's best value for its time, or a balanced tree where boxes are placed so that it would become too deep to be searched.
fn build(boxes: &[Aabb]) -> CwBvh {
    let indices = (0..boxes.len() as u32).collect();
    let mut binary = PlocBuilder::with_capacity(boxes.len()).build(
        PlocSearchDistance::Medium,
        boxes,
        indices,
        SortPrecision::U64,
        3,
    );
    if binary.max_depth <= DEEPEST {
        ReinsertionOptimizer::default().run(&mut binary, 0.05, None);
        let wide = bvh2_to_cwbvh(&binary, 3, true, false);
        if depth(&wide) < STACK {
            return wide;
        }
    }
    bvh2_to_cwbvh(&balanced(boxes), 3, true, false)
}

/// The number of levels of a tree.
fn depth(bvh: &CwBvh) -> usize {
    let mut deepest = 0;
    let mut stack = vec![(0, 1)];
    while let Some((index, level)) = stack.pop() {
        deepest = deepest.max(level);
        let node = &bvh.nodes[index as usize];
        stack.extend((0..node.imask.count_ones()).map(|i| (node.child_base_idx + i, level + 1)));
    }
    deepest
}

/// A binary tree that halves the number of boxes at each level, across the longest axis of their centres.
fn balanced(boxes: &[Aabb]) -> Bvh2 {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut nodes = vec![Bvh2Node::default()];
    let mut open = vec![(0, 0..boxes.len())];
    while let Some((index, range)) = open.pop() {
        let part = &mut order[range.clone()];
        let all = part.iter().map(|&i| boxes[i as usize]).reduce(|a, b| a.union(&b)).unwrap_or_default();
        if part.len() == 1 {
            nodes[index] = Bvh2Node::new(all, 1, range.start as u32);
            continue;
        }
        let centre = |i: u32| boxes[i as usize].center();
        let (low, high) =
            part.iter().fold((Vec3A::MAX, Vec3A::MIN), |(low, high), &i| (low.min(centre(i)), high.max(centre(i))));
        let axis = (high - low).max_position();
        let middle = part.len() / 2;
        part.select_nth_unstable_by(middle, |&a, &b| {
            centre(a)[axis].partial_cmp(&centre(b)[axis]).unwrap_or(Ordering::Equal)
        });
        let first = nodes.len();
        nodes[index] = Bvh2Node::new(all, 0, first as u32);
        nodes.resize(first + 2, Bvh2Node::default());
        open.push((first, range.start..range.start + middle));
        open.push((first + 1, range.start + middle..range.end));
    }
    Bvh2 { nodes, primitive_indices: order, ..Bvh2::default() }
}

//! A bounding-volume hierarchy with eight boxes to a node, tested together in single precision.
//!
//! The crate `obvhs` sorts the boxes into a binary hierarchy (PLOC with reinsertion); its nodes are then drawn together until each has up
//! to eight children, the largest first. Boxes are kept as steps of a 254th of their node, rounded outwards, so that a node is two cache
//! lines: rays without order spend their time waiting for nodes. Searches are compiled for the instruction set at hand (`eight`).
//!
//! References: D. Meister & J. Bittner, *Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction*, TVCG 24(3)
//! (2018); H. Ylitie, T. Karras, S. Laine, *Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs*, HPG 2017; I. Wald, C. Benthin, S. Boulos, *Getting Rid of Packets: Efficient SIMD Single-Ray Traversal using Multi-branching BVHs*,
//! RT 2008.

use std::collections::VecDeque;
use std::ops::Range;

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::PlocBuilder;
use obvhs::{Boundable, BvhBuildParams};
use rayon::prelude::*;
use smallvec::SmallVec;

mod eight;

use eight::{Eight, Search};

/// Boxes in a leaf at most.
const LEAF: usize = 3;
/// Marks a leaf among children; below it are the place of its first box (28 bits) and its number of boxes (3 bits).
const IS_LEAF: u32 = 1 << 31;
/// Steps across a node: one less than can be counted, for the rounding of the last.
const STEPS: f32 = 254.0;
/// Open children that a search holds without allocating; only chains of boxes one inside the other need more.
const OPEN: usize = 96;
/// Parts that are drawn together at the same time.
const PARTS: usize = 64;

/// Boxes in an order of its own: each has a place.
#[derive(Debug, Default)]
pub(super) struct Hierarchy {
    nodes: Vec<Node>,
}

/// Eight boxes, and what is in them.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
struct Node {
    /// The least corner of all.
    origin: [f32; 3],
    /// What the boxes' planes are counted in, from the origin.
    step: [f32; 3],
    /// For x, y and z: the least of each box, then the greatest of each.
    planes: [[u8; 16]; 3],
    children: [u32; 8],
    /// A bit for each box that is there.
    there: u32,
}

/// A ray in the frame of the hierarchy, from its origin on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub origin: [f32; 3],
    /// Reciprocals of the direction's components, all finite.
    pub inverse: [f32; 3],
}

/// A box of the hierarchy, which the crate asks for.
struct Leaf(Aabb);

impl Boundable for Leaf {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Hierarchy {
    /// The hierarchy of some boxes (least and greatest corners), at most 2²⁸, and the number of the box at each place.
    pub(super) fn new(boxes: impl IndexedParallelIterator<Item = (Vec3A, Vec3A)>) -> (Self, Vec<u32>) {
        let leaves: Vec<Leaf> = boxes.map(|(min, max)| Leaf(Aabb::new(min, max))).collect();
        if leaves.is_empty() {
            return (Self::default(), Vec::new());
        }
        assert!(leaves.len() < 1 << 28, "a hierarchy has places of 28 bits");
        let params = BvhBuildParams::medium_build();
        #[expect(clippy::cast_possible_truncation, reason = "below 2²⁸")]
        let order = (0..leaves.len() as u32).collect();
        let mut binary = PlocBuilder::with_capacity(leaves.len()).build(
            params.ploc_search_distance,
            &leaves,
            order,
            params.sort_precision,
            params.search_depth_threshold,
        );
        ReinsertionOptimizer::default().run(&mut binary, params.reinsertion_batch_ratio, None);
        Self::of(&binary)
    }

    /// Draws the nodes of a binary hierarchy together.
    fn of(binary: &Bvh2) -> (Self, Vec<u32>) {
        let (mut whole, mut open) = (Part::new(), VecDeque::from([(0, 0)]));
        while open.len() < PARTS
            && let Some((node, of)) = open.pop_front()
        {
            whole.fill(binary, node, of, |child| open.push_back(child));
        }
        let parts: Vec<_> = open.par_iter().map(|&(_, of)| Part::below(binary, of)).collect();
        open.into_iter().zip(parts).for_each(|((node, _), part)| whole.graft(node, part));
        (Self { nodes: whole.nodes }, whole.numbers)
    }

    /// Calls `test` with the places of boxes that the line may meet before `limit`, roughly from near to far; `test` returns a nearer
    /// limit where it found something.
    pub(super) fn closest(&self, line: Line, limit: f32, test: impl FnMut(usize) -> Option<f32>) {
        eight::dispatch(Closest { hierarchy: self, line, limit, test });
    }

    /// Whether `test` is true for any of the boxes that the line may meet before `limit`.
    pub(super) fn any(&self, line: Line, limit: f32, test: impl FnMut(usize) -> bool) -> bool {
        eight::dispatch(Any { hierarchy: self, line, limit, test })
    }

    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
    }
}

/// A search for the nearest box.
struct Closest<'a, T> {
    hierarchy: &'a Hierarchy,
    line: Line,
    limit: f32,
    test: T,
}

impl<T: FnMut(usize) -> Option<f32>> Search for Closest<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self, eight: impl Eight) {
        let Self { hierarchy, line, mut limit, mut test } = self;
        let mut open: SmallVec<[(u32, f32); OPEN]> = SmallVec::new();
        if !hierarchy.nodes.is_empty() {
            open.push((0, 0.0));
        }
        while let Some((mut child, near)) = open.pop() {
            if near > limit {
                continue;
            }
            loop {
                if child & IS_LEAF != 0 {
                    for place in leaf(child) {
                        if let Some(nearer) = test(place) {
                            limit = nearer;
                        }
                    }
                    break;
                }
                let node = &hierarchy.nodes[child as usize];
                let (near, mut hits) = eight.cross(node, &line, limit);
                if hits == 0 {
                    break;
                }
                let slot = hits.trailing_zeros() as usize;
                hits &= hits - 1;
                child = node.children[slot & 7];
                if hits == 0 {
                    continue;
                }
                // Several: the nearest is next, the others wait in the order of their distances.
                let mut first = (child, near[slot & 7]);
                let bottom = open.len();
                while hits != 0 {
                    let slot = hits.trailing_zeros() as usize & 7;
                    hits &= hits - 1;
                    let mut other = (node.children[slot], near[slot]);
                    if other.1 < first.1 {
                        std::mem::swap(&mut other, &mut first);
                    }
                    open.push(other);
                    let mut place = open.len() - 1;
                    while place > bottom && open[place - 1].1 < open[place].1 {
                        open.swap(place - 1, place);
                        place -= 1;
                    }
                }
                child = first.0;
            }
        }
    }
}

/// A search for any box.
struct Any<'a, T> {
    hierarchy: &'a Hierarchy,
    line: Line,
    limit: f32,
    test: T,
}

impl<T: FnMut(usize) -> bool> Search for Any<'_, T> {
    type Output = bool;

    #[inline(always)]
    fn run(self, eight: impl Eight) -> bool {
        let Self { hierarchy, line, limit, mut test } = self;
        let mut open: SmallVec<[u32; OPEN]> = SmallVec::new();
        if !hierarchy.nodes.is_empty() {
            open.push(0);
        }
        while let Some(child) = open.pop() {
            if child & IS_LEAF != 0 {
                if leaf(child).any(&mut test) {
                    return true;
                }
                continue;
            }
            let node = &hierarchy.nodes[child as usize];
            let (_, mut hits) = eight.cross(node, &line, limit);
            while hits != 0 {
                open.push(node.children[hits.trailing_zeros() as usize & 7]);
                hits &= hits - 1;
            }
        }
        false
    }
}

/// The places of a leaf's boxes.
fn leaf(child: u32) -> Range<usize> {
    let first = ((child & !IS_LEAF) >> 3) as usize;
    first..first + (child & 7) as usize
}

impl Node {
    const EMPTY: Self = Self { origin: [0.0; 3], step: [0.0; 3], planes: [[0; 16]; 3], children: [0; 8], there: 0 };

    /// The node of a binary node, with the boxes of some of its descendants and nothing in them.
    fn around(binary: &Bvh2, of: usize, children: &[Descendant]) -> Self {
        let bounds = |node: usize| {
            let b = binary.nodes[node].aabb();
            [b.min.to_array(), b.max.to_array()]
        };
        let [origin, end] = bounds(of);
        let mut node = Self { origin, there: (1 << children.len()) - 1, ..Self::EMPTY };
        for axis in 0..3 {
            let step = (end[axis] - origin[axis]) / STEPS;
            node.step[axis] = step;
            for (slot, child) in children.iter().enumerate() {
                let [min, max] = bounds(child.node).map(|corner| (corner[axis] - origin[axis]) / step);
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast that saturates")]
                let (min, max) = (min.floor() as u8, max.ceil() as u8);
                node.planes[axis][slot] = min;
                node.planes[axis][slot + 8] = max;
            }
        }
        node
    }
}

/// A part of a hierarchy: its nodes, of which the first holds all others, and the numbers of the boxes at its places, both counted from 0.
struct Part {
    nodes: Vec<Node>,
    numbers: Vec<u32>,
}

impl Part {
    fn new() -> Self {
        Self { nodes: vec![Node::EMPTY], numbers: Vec::new() }
    }

    /// All that a binary node holds.
    fn below(binary: &Bvh2, of: usize) -> Self {
        let (mut part, mut open) = (Self::new(), vec![(0, of)]);
        while let Some((node, of)) = open.pop() {
            part.fill(binary, node, of, |child| open.push(child));
        }
        part
    }

    /// Fills a node with what a binary node holds; `open` gets the nodes that are to be filled next and the binary ones that they are of.
    fn fill(&mut self, binary: &Bvh2, node: usize, of: usize, mut open: impl FnMut((usize, usize))) {
        let children = descendants(binary, of);
        let mut filled = Node::around(binary, of, &children);
        for (content, child) in filled.children.iter_mut().zip(&children) {
            #[expect(clippy::cast_possible_truncation, reason = "fewer than 2²⁸ boxes and so nodes")]
            if let Some(held) = &child.few {
                *content = IS_LEAF | ((self.numbers.len() as u32) << 3) | held.len() as u32;
                self.numbers.extend_from_slice(held);
            } else {
                *content = self.nodes.len() as u32;
                open((self.nodes.len(), child.node));
                self.nodes.push(Node::EMPTY);
            }
        }
        self.nodes[node] = filled;
    }

    /// Puts a part in the place of a node.
    fn graft(&mut self, node: usize, part: Self) {
        #[expect(clippy::cast_possible_truncation, reason = "fewer than 2²⁸ boxes and so nodes")]
        let (nodes, places) = (self.nodes.len() as u32 - 1, (self.numbers.len() as u32) << 3);
        let mut moved = part.nodes.into_iter().map(|mut node| {
            let there = node.there.count_ones() as usize;
            node.children[..there].iter_mut().for_each(|c| *c += if *c & IS_LEAF == 0 { nodes } else { places });
            node
        });
        self.nodes[node] = moved.next().expect("a part has a first node");
        self.nodes.extend(moved);
        self.numbers.extend(part.numbers);
    }
}

/// A node of the binary hierarchy that is to be a child.
struct Descendant {
    node: usize,
    /// What it holds, where that is a leaf's.
    few: Option<SmallVec<[u32; LEAF]>>,
    /// Half its surface.
    area: f32,
}

impl Descendant {
    fn new(binary: &Bvh2, node: usize) -> Self {
        Self { node, few: few(binary, node), area: binary.nodes[node].aabb().half_area() }
    }
}

/// Up to eight nodes below a binary node that together hold all that it holds. Opened are those that hold too much for a leaf, then,
/// while there is room, any; the largest first.
fn descendants(binary: &Bvh2, of: usize) -> SmallVec<[Descendant; 8]> {
    let mut children = SmallVec::<[Descendant; 8]>::new();
    children.push(Descendant::new(binary, of));
    while children.len() < 8 {
        let largest = (children.iter().enumerate())
            .filter(|(_, child)| !binary.nodes[child.node].is_leaf())
            .max_by(|(_, a), (_, b)| a.few.is_none().cmp(&b.few.is_none()).then(a.area.total_cmp(&b.area)));
        let Some((place, child)) = largest else { break };
        let first = binary.nodes[child.node].first_index as usize;
        children[place] = Descendant::new(binary, first);
        children.push(Descendant::new(binary, first + 1));
    }
    children
}

/// The boxes below a node where they are few enough for a leaf.
fn few(binary: &Bvh2, node: usize) -> Option<SmallVec<[u32; LEAF]>> {
    let (mut held, mut open) = (SmallVec::new(), SmallVec::<[usize; 8]>::new());
    open.push(node);
    while let Some(next) = open.pop() {
        let node = &binary.nodes[next];
        let first = node.first_index as usize;
        if node.is_leaf() {
            held.extend_from_slice(&binary.primitive_indices[first..][..node.prim_count as usize]);
        } else {
            open.extend([first + 1, first]);
        }
        if held.len() + open.len() > LEAF {
            return None;
        }
    }
    Some(held)
}

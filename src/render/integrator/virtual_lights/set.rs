//! A set of virtual lights: how they are weighed and drawn for a point.
//!
//! They are weighed in single precision, all lengths from the middle of the scene in units of √area, where what is rounded is far below what
//! they differ by; what one that was drawn brings is in double precision, over the weight that it was drawn by, rounded or not.
//!
//! They stand in the order of a Morton curve through the scene, so that numbers that are spread evenly draw places that are.
//!
//! Reference: G. M. Morton, *A Computer Oriented Geodetic Data Base and a New Technique in File Sequencing*, IBM 1966.

use glam::{DVec3, Vec3};
use pulp::{Arch, NullaryFnOnce};

use super::Source;
use crate::render::integrator::packet::Vertex;

/// Weights that are summed in one go; their sums are then summed again.
const BLOCK: usize = 16;
/// Cells of the curve in each dimension.
const CELLS: f32 = 1024.0;

/// Virtual lights.
#[derive(Debug, Default)]
pub(super) struct Set<'a> {
    /// The greatest G that they are answerable for, 1/m².
    bound: f64,
    /// In the order in which they were found: what goes on from each, in one figure; edges of the path from the lamp; the places.
    strengths: Vec<f64>,
    edges: Vec<u32>,
    vertices: Vec<Vertex<'a>>,
    /// The flux that comes to each, per band, over the number of packets.
    fluxes: Vec<f64>,
    /// Their numbers along the curve, and in that order: x, y, z of their places, then of the normals on the sides that are lit, and the strengths as
    /// shares of the largest.
    order: Vec<u32>,
    coordinates: [Vec<f32>; 6],
    shares: Vec<f32>,
}

/// A virtual light that was drawn for a point.
#[derive(Debug, Clone, Copy)]
pub struct Drawn {
    pub(super) number: usize,
    /// Unit vector from the point.
    pub direction: DVec3,
    /// |cosθ_y|/d² · min(1, b/G) over the probability of its draw.
    pub weight: f64,
}

/// The weights of a set for a point.
#[derive(Debug, Default)]
pub(super) struct Weights {
    each: Vec<f32>,
    /// Running sums of [`BLOCK`]s of them.
    sums: Vec<f64>,
}

impl<'a> Set<'a> {
    /// Forgets all; those to come are answerable for no G above `bound`, 1/m².
    pub(super) fn clear(&mut self, bound: f64) {
        self.bound = bound;
        self.strengths.clear();
        self.edges.clear();
        self.vertices.clear();
        self.fluxes.clear();
    }

    /// Adds one at the end of so many edges.
    pub(super) fn add(&mut self, vertex: Vertex<'a>, edges: u32, strength: f64, flux: impl Iterator<Item = f64>) {
        self.strengths.push(strength);
        self.edges.push(edges);
        self.vertices.push(vertex);
        self.fluxes.extend(flux);
    }

    /// Makes ready, once all were added, for [`Set::weigh`].
    pub(super) fn finish(&mut self, source: &Source) {
        let places: Vec<Vec3> = self.vertices.iter().map(|vertex| source.local(vertex.point.position)).collect();
        let mut keys: Vec<(u32, u32)> =
            places.iter().map(|place| along_curve(*place / source.reach)).zip(0..).collect();
        keys.sort_unstable();
        self.order.clear();
        self.order.extend(keys.iter().map(|(_, number)| *number));
        self.coordinates.iter_mut().for_each(Vec::clear);
        self.shares.clear();
        let most = self.strengths.iter().copied().fold(0.0, f64::max);
        for number in &self.order {
            let number = *number as usize;
            let (place, normal) = (places[number], lit(&self.vertices[number]).as_vec3());
            let own = [place.x, place.y, place.z, normal.x, normal.y, normal.z];
            self.coordinates.iter_mut().zip(own).for_each(|(all, x)| all.push(x));
            // None is so faint that it is 0.
            self.shares.push(single(self.strengths[number] / most).max(f32::MIN_POSITIVE));
        }
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.order.len()
    }

    /// min(1, b/G).
    pub(super) fn share(&self, g: f64) -> f64 {
        if g > self.bound { self.bound / g } else { 1.0 }
    }

    /// Weighs them for a point, `normal` on the side that is seen; with `most_edges` those alone that have no more. Whether there is one.
    pub(super) fn weigh(
        &self,
        weights: &mut Weights,
        source: &Source,
        (from, normal): (DVec3, DVec3),
        most_edges: Option<u32>,
    ) -> bool {
        let Weights { each, sums } = weights;
        each.clear();
        each.resize(self.count(), 0.0);
        let (from, normal) = (source.local(from), normal.as_vec3());
        let (bound, rounded) = (single(self.bound * source.area), source.rounded);
        // The same operations in the same order with any instruction set.
        Arch::new().dispatch(Weigh { set: self, from, normal, bound, rounded, weights: each });
        if let Some(most) = most_edges {
            let far = each.iter_mut().zip(&self.order).filter(|(_, number)| self.edges[**number as usize] > most);
            far.for_each(|(weight, _)| *weight = 0.0);
        }
        sums.clear();
        sums.resize(each.len().div_ceil(BLOCK), 0.0);
        Arch::new().dispatch(Sum { weights: each, sums });
        let mut sum = 0.0;
        for block in sums {
            sum += *block;
            *block = sum;
        }
        sum > 0.0 && sum < f64::INFINITY
    }

    /// One of those that were weighed for a point and a normal, by a uniform number.
    pub(super) fn draw(&self, weights: &Weights, (from, normal): (DVec3, DVec3), u: f64) -> Option<Drawn> {
        let (place, probability) = weights.draw(u)?;
        let number = self.order[place] as usize;
        let vertex = &self.vertices[number];
        let way = vertex.point.position - from;
        let distance = way.length();
        let direction = way / distance;
        let per_area = -direction.dot(lit(vertex)) / (distance * distance);
        let weight = per_area * self.share(direction.dot(normal) * per_area) / probability;
        // Nothing comes from a place at the point itself.
        (weight > 0.0 && weight.is_finite()).then_some(Drawn { number, direction, weight })
    }

    /// A place, and the flux per band that comes to it.
    pub(super) fn light(&self, number: usize, bands: usize) -> (&Vertex<'a>, &[f64]) {
        (&self.vertices[number], &self.fluxes[number * bands..][..bands])
    }
}

impl Weights {
    /// A place in the order and the probability with which it is drawn.
    fn draw(&self, u: f64) -> Option<(usize, f64)> {
        let total = *self.sums.last()?;
        // Blocks of no weight are never found: their end is not above their start. At u = 1 the last of some weight is.
        let block =
            self.sums.partition_point(|end| *end <= u * total).min(self.sums.partition_point(|end| *end < total));
        let below = if block == 0 { 0.0 } else { self.sums[block - 1] };
        let first = block * BLOCK;
        let weights = &self.each[first..self.each.len().min(first + BLOCK)];
        let (mut end, mut place) = (below, 0);
        for weight in weights {
            end += f64::from(*weight);
            place += usize::from(end <= u * total);
        }
        if place == weights.len() {
            // Rounding left something over: it is the last one of some weight.
            place = weights.iter().rposition(|weight| *weight > 0.0)?;
        }
        Some((first + place, f64::from(weights[place]) / total))
    }
}

/// S min(G, b) of each of a set, for a point. (No closure: only what is inlined is compiled for the instruction set at hand.)
struct Weigh<'a> {
    set: &'a Set<'a>,
    from: Vec3,
    normal: Vec3,
    bound: f32,
    /// Distances from the planes count for so much more, so that nothing that brings something is left out.
    rounded: f32,
    weights: &'a mut [f32],
}

impl NullaryFnOnce for Weigh<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { set, from, normal, bound, rounded, weights } = self;
        let n = weights.len();
        let [x, y, z, nx, ny, nz] = &set.coordinates;
        let (x, y, z, nx, ny, nz) = (&x[..n], &y[..n], &z[..n], &nx[..n], &ny[..n], &nz[..n]);
        let shares = &set.shares[..n];
        for (i, weight) in weights.iter_mut().enumerate() {
            let (dx, dy, dz) = (x[i] - from.x, y[i] - from.y, z[i] - from.z);
            let per_square = 1.0 / (dx * dx + dy * dy + dz * dz);
            let here = (dx * normal.x + dy * normal.y + dz * normal.z + rounded).max(0.0);
            let there = (-dx * nx[i] - dy * ny[i] - dz * nz[i] + rounded).max(0.0);
            // At the point itself no number or infinite, which min makes the bound; it is drawn and brings nothing.
            *weight = shares[i] * ((here * per_square) * (there * per_square)).min(bound);
        }
    }
}

/// Sums of blocks of weights.
struct Sum<'a> {
    weights: &'a [f32],
    sums: &'a mut [f64],
}

impl NullaryFnOnce for Sum<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (blocks, rest) = self.weights.as_chunks::<BLOCK>();
        for (i, block) in blocks.iter().enumerate() {
            // Pairs of pairs: one after the other each would wait for the last.
            let mut pairs = [0.0; BLOCK / 2];
            for k in 0..BLOCK / 2 {
                pairs[k] = f64::from(block[k]) + f64::from(block[k + BLOCK / 2]);
            }
            let fours = [pairs[0] + pairs[4], pairs[1] + pairs[5], pairs[2] + pairs[6], pairs[3] + pairs[7]];
            self.sums[i] = (fours[0] + fours[2]) + (fours[1] + fours[3]);
        }
        if let Some(last) = self.sums.get_mut(blocks.len()) {
            *last = rest.iter().map(|weight| f64::from(*weight)).sum();
        }
    }
}

/// The normal on the side that the packet came to.
fn lit(vertex: &Vertex<'_>) -> DVec3 {
    let normal = vertex.point.normal;
    if vertex.back.dot(normal) < 0.0 { -normal } else { normal }
}

/// How far along the curve through [−1, 1]³ a place lies.
fn along_curve(place: Vec3) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "cells, and what is outside is in the outermost"
    )]
    let cell = ((place + 1.0) * (0.5 * CELLS)).clamp(Vec3::ZERO, Vec3::splat(CELLS - 1.0)).to_array().map(|x| x as u32);
    // Ten bits, each with two others behind it.
    let spread = |x: u32| {
        let x = (x | x << 16) & 0x0300_00FF;
        let x = (x | x << 8) & 0x0300_F00F;
        let x = (x | x << 4) & 0x030C_30C3;
        (x | x << 2) & 0x0924_9249
    };
    let [x, y, z] = cell.map(spread);
    x | y << 1 | z << 2
}

#[expect(clippy::cast_possible_truncation, reason = "what is drawn by is known as it is, rounded or not")]
pub(super) fn single(x: f64) -> f32 {
    x as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;

    /// Every number of a block, of whole blocks and of what is left over is drawn as often as its weight says.
    #[test]
    fn numbers_are_drawn_by_their_weights() {
        for n in [1, 15, 16, 17, 40, 64] {
            // 0, 1, 2, 0, 1, 2, …, the last of some weight.
            let each: Vec<f32> = (0..n).map(|i| [0.0, 1.0, 2.0][(i + 3 - n % 3) % 3]).collect();
            let mut sums = vec![0.0; n.div_ceil(BLOCK)];
            Arch::new().dispatch(Sum { weights: &each, sums: &mut sums });
            let mut sum = 0.0;
            sums.iter_mut().for_each(|block| {
                sum += *block;
                *block = sum;
            });
            let total: f64 = each.iter().map(|w| f64::from(*w)).sum();
            assert_eq!(sum, total, "{n}");
            let weights = Weights { each, sums };
            if total == 0.0 {
                continue;
            }
            // In the middle of every unit of weight: whole numbers, of which no sum is rounded.
            let mut below = 0.0;
            for (place, weight) in weights.each.iter().enumerate() {
                for unit in 0..*weight as usize {
                    let u = (below + unit as f64 + 0.5) / total;
                    assert_eq!(weights.draw(u), Some((place, f64::from(*weight) / total)), "{n}, {u}");
                }
                below += f64::from(*weight);
            }
            let last = weights.each.iter().rposition(|w| *w > 0.0);
            assert_eq!(weights.draw(1.0).map(|drawn| drawn.0), last);
        }
        assert_eq!(Weights::default().draw(0.5), None);
    }

    /// Single precision beside double: what brings something has a weight, however grazing, and far from the planes that of the formula.
    #[test]
    fn none_that_brings_something_is_left_out() {
        let mut random = Stream::new(2, 7);
        let reach = 20.0;
        let (rounded, bound) = (super::super::rounded(reach), 256.0);
        let mut grazing = 0;
        for n in 0..2000 {
            let mut place = || DVec3::from([(); 3].map(|()| reach * (2.0 * random.uniform() - 1.0)));
            let (from, to) = (place(), place());
            let way = to - from;
            // Every other one within 1e-6 of the plane of one of the two.
            let across = |v: DVec3| (v - way * v.dot(way) / way.length_squared()).normalize();
            let slope = if n % 2 == 0 { 1e-6 * random.uniform() } else { 0.1 + random.uniform() };
            let [here, there] = [DVec3::X + DVec3::Y, DVec3::Z - DVec3::Y].map(across);
            let normal = (here + slope * way.normalize()).normalize();
            let lit = (there - way.normalize()).normalize();
            let mut set = Set { shares: vec![1.0], ..Set::default() };
            let own = [to.x, to.y, to.z, lit.x, lit.y, lit.z].map(single);
            set.coordinates.iter_mut().zip(own).for_each(|(all, x)| all.push(x));
            let mut weights = [0.0];
            let (near, normal32) = (from.as_vec3(), normal.as_vec3());
            let task = Weigh { set: &set, from: near, normal: normal32, bound, rounded, weights: &mut weights };
            Arch::new().dispatch(task);
            let g = way.dot(normal) * -way.dot(lit) / way.length_squared().powi(2);
            assert!(g > 0.0 && weights[0] > 0.0, "{n}: {g} {}", weights[0]);
            grazing += u32::from(g < 1e-6 * 4.0 * reach * reach);
            if n % 2 == 1 {
                // Both distances are wrong by twice what is added at most, and the places by an epsilon of the scene.
                let far = way.dot(normal).min(-way.dot(lit));
                let most = 4.0 * f64::from(rounded) / far + 16.0 * f64::from(f32::EPSILON) * reach / way.length();
                let expected = g.min(f64::from(bound));
                assert!((f64::from(weights[0]) / expected - 1.0).abs() < most, "{n}: {g} {} {most}", weights[0]);
            }
        }
        assert!(grazing > 900, "{grazing}");
    }

    /// The first cells in the order that Morton gave, the last one, and what is outside.
    #[test]
    fn the_curve_takes_x_then_y_then_z() {
        let cell = |x: f32, y: f32, z: f32| along_curve((Vec3::new(x, y, z) + 0.5) * (2.0 / CELLS) - 1.0);
        let first: Vec<u32> = (0..8_u8).map(|i| cell((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into())).collect();
        assert_eq!(first, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(cell(2.0, 0.0, 0.0), 8);
        assert_eq!(cell(1023.0, 1023.0, 1023.0), (1 << 30) - 1);
        assert_eq!(along_curve(Vec3::splat(7.0)), (1 << 30) - 1);
        assert_eq!(along_curve(Vec3::splat(-7.0)), 0);
    }
}

//! Guiding: where a path goes on from a diffuse surface, by what packets from the lights came there through glass and off mirrors.
//!
//! What glass gathers on a floor is light that comes from a few directions, and a path that leaves the floor in any direction seldom runs
//! through the glass into the lamp: a few samples are very bright, all others see none of it. Packets of flux that are sent before the picture is
//! taken land there, and tell the directions. They are sorted into the leaves of a tree, up to 512 in each, and a direction is drawn by
//!
//! ```text
//! p(ω) = a g(ω) + (1 − a) p_f(ω)
//! g(ω) = Σ_j w_j [ (1 − t) C(|ω − ω_j|; r_j) + t C(|ω − ω_j|; 3 r_j) ] / Σ_j w_j,    C(d; r) = 1/(π r²) for d < r, else 0
//! ```
//!
//! ω_j, w_j: directions that the packets of the leaf came from, and their flux to the power of 3/4, so that faint ones, which are very bright where they
//! are found by chance, are found more often (they go either way at glass alike, so that places that the fainter of both alone lights are known as
//! well); r_j: 6/5 of the distance from ω_j to the eighth nearest other of them; C is uniform on a cap of the sphere, whose area is π r² for the chord r; p_f: the material's own density. The share a is the larger the more of the packets
//! that come to the leaf in a roundabout way came over polished surfaces, and never is 1, so that no direction is left out. The density is known
//! for every direction, so that nothing is biased, whatever the packets found; it takes the place of the material's wherever ways of finding
//! a light are weighed against each other.
//!
//! Where more flux lands on an area than does on the average, a path that comes there is worth more than it carries, by so much and by p/p_f of
//! where it goes: roulette ends it the later. Else few would find what a focus lights, each of them with much light.
//!
//! The packets have random numbers of their own and are sent once: nothing depends on the samples that count.
//!
//! What cannot be guided are lights without extent behind glass, which no path meets.
//!
//! References: H. W. Jensen, *Importance Driven Path Tracing using the Photon Map*, EGWR 1995; J. Vorba et al., *On-line Learning of Parametric
//! Mixture Models for Light Transport Simulation*, SIGGRAPH 2014; T. Müller, M. Gross, J. Novák, *Practical Path Guiding for Efficient
//! Light-Transport Simulation*, EGSR 2017 (the tree); E. Veach, thesis, Stanford 1997, ch. 9 (one sample of several densities); J. Vorba,
//! J. Křivánek, *Adjoint-Driven Russian Roulette and Splitting in Light Transport Simulation*, ACM TOG 35(4), 2016 (what a path is worth).

use std::f64::consts::PI;

use glam::DVec3;
use pulp::{Arch, NullaryFnOnce};

use crate::geometry::direction::tangents;
use crate::math::sampling::{cone, split};
use crate::render::material::Material;

/// Most packets of a leaf.
const LEAF: usize = 512;
/// Caps that are looked at together.
const LANES: usize = 8;
/// Fewer landings than this say nothing.
const LEAST: usize = 256;
/// Which of the nearest other directions tells how wide a cap is, and how much wider it is than that.
const NEAREST: usize = 8;
const WIDER: f64 = 1.2;
/// w_j is this power of the packet's flux.
const FLATTER: f64 = 0.75;
/// The share of the wide caps, and how much wider they are.
const TAIL: f64 = 0.2;
const WIDE: f64 = 3.0;
/// r_j² is within these bounds: a needle of 0.1 mrad, and wide caps of no more than the sphere.
const SQUARES: [f64; 2] = [1e-8, 4.0 / (WIDE * WIDE)];
/// The share of guided directions is within these bounds.
const SHARES: [f64; 2] = [0.1, 0.8];
/// The brightness of a place is at most this.
const BRIGHTEST: f64 = 1e4;
/// The time in which a direction's density is found, in searches along a ray, about.
pub const EFFORT: f64 = 0.3;

/// Where a packet came to a diffuse surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landing {
    /// The place, m.
    pub position: DVec3,
    /// Unit vector to where the packet came from.
    pub back: DVec3,
    /// Its flux, in terms of that of others.
    pub weight: f64,
}

/// Where packets came to diffuse surfaces.
#[derive(Debug, Clone, Default)]
pub struct Landings {
    /// Over polished surfaces, from a diffuse surface or from a light that a path can meet.
    pub polished: Vec<Landing>,
    /// Straight from another surface that is not polished: of some packets, each of which counts for more.
    pub plain: Vec<Landing>,
}

/// The directions of all places.
#[derive(Debug, Clone)]
pub struct Guide {
    nodes: Vec<Node>,
    caps: Vec<Caps>,
    /// The instructions of this machine.
    arch: Arch,
}

#[derive(Debug, Clone, Copy)]
enum Node {
    /// Below a coordinate the next node, else another.
    Split { axis: usize, at: f64, above: usize },
    /// Its caps, the share a, and the brightness there ([`Guided::brightness`]).
    Leaf { first: usize, end: usize, share: f64, brightness: f64 },
}

/// Caps of a leaf, one in each lane; those that fill its last lanes are nowhere and weigh nothing.
#[derive(Debug, Clone, Copy)]
struct Caps {
    /// Their middles.
    axes: [[f64; LANES]; 3],
    /// Squares of their chords r.
    squares: [f64; LANES],
    /// w (1 − t)/(π r²) over Σ w of the leaf.
    densities: [f64; LANES],
    /// Running sums, up to 1, of w over Σ w.
    ends: [f64; LANES],
}

impl Caps {
    const NONE: Self =
        Self { axes: [[0.0; LANES]; 3], squares: [0.0; LANES], densities: [0.0; LANES], ends: [1.0; LANES] };
}

/// The directions of one place.
#[derive(Debug, Clone, Copy)]
pub struct Guided<'a> {
    caps: &'a [Caps],
    share: f64,
    brightness: f64,
    arch: Arch,
}

/// Whether paths that come to a material may be guided.
#[must_use]
pub fn suits(material: &dyn Material) -> bool {
    material.is_diffuse() && !material.has_delta()
}

impl Guide {
    /// Of some landings; `None` where they are too few.
    #[must_use]
    pub fn new(mut landings: Landings) -> Option<Self> {
        let mut guide = Self { nodes: Vec::new(), caps: Vec::new(), arch: Arch::new() };
        if landings.polished.len() < LEAST {
            return None;
        }
        guide.grow(&mut landings.polished);
        let mut plain = vec![0.0; guide.nodes.len()];
        landings.plain.iter().for_each(|landing| plain[guide.leaf(landing.position)] += landing.weight);
        // Until here the one is the weight of the leaf's landings, the other their area.
        let [mut flux, mut area] = [0.0; 2];
        for (node, plain) in guide.nodes.iter().zip(&plain) {
            if let Node::Leaf { share, brightness, .. } = node {
                flux += share + plain;
                area += brightness;
            }
        }
        for (node, plain) in guide.nodes.iter_mut().zip(plain) {
            if let Node::Leaf { share, brightness, .. } = node {
                let times = (*share + plain) / *brightness * (area / flux);
                // What has no area is as bright as any can be; where nothing has, nothing is known.
                *brightness = if times.is_nan() { 1.0 } else { times.clamp(1.0, BRIGHTEST) };
                *share = (SHARES[1] * *share / (*share + plain)).max(SHARES[0]);
            }
        }
        Some(guide)
    }

    /// Adds the node of some landings and all below it.
    fn grow(&mut self, landings: &mut [Landing]) {
        let positions = || landings.iter().map(|landing| landing.position);
        let extent = positions().fold(DVec3::NEG_INFINITY, DVec3::max) - positions().fold(DVec3::INFINITY, DVec3::min);
        if landings.len() <= LEAF {
            let first = self.caps.len();
            self.caps.append(&mut caps(landings));
            let weight = landings.iter().map(|landing| landing.weight).sum();
            // Of a surface that lies as it will: the two longer sides of its box.
            let [x, y, z] = extent.to_array();
            let area = (x * y).max(y * z).max(z * x);
            self.nodes.push(Node::Leaf { first, end: self.caps.len(), share: weight, brightness: area });
            return;
        }
        let axis = (1..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
        if extent[axis] == 0.0 {
            // All at one place, where so many are enough.
            self.grow(&mut landings[..LEAF]);
            return;
        }
        // Stable, so that the order of equals is that of the packets.
        landings.sort_by(|a, b| a.position[axis].total_cmp(&b.position[axis]));
        // As near to the middle as a place parts them: those of a floor have one height.
        let middle = landings[landings.len() / 2].position[axis];
        let first = landings.partition_point(|landing| landing.position[axis] < middle);
        let second = landings.partition_point(|landing| landing.position[axis] <= middle);
        let off = |end: usize| end.abs_diff(landings.len() / 2);
        // Either may be an end of all, but not both.
        let part = if second == landings.len() || first > 0 && off(first) <= off(second) { first } else { second };
        let (below, above) = landings.split_at_mut(part);
        let (node, at) = (self.nodes.len(), above[0].position[axis]);
        self.nodes.push(Node::Split { axis, at, above: 0 });
        self.grow(below);
        let next = self.nodes.len();
        self.nodes[node] = Node::Split { axis, at, above: next };
        self.grow(above);
    }

    /// The leaf of a place.
    fn leaf(&self, position: DVec3) -> usize {
        let mut node = 0;
        while let Node::Split { axis, at, above } = self.nodes[node] {
            node = if position[axis] < at { node + 1 } else { above };
        }
        node
    }

    /// The directions of a place.
    #[must_use]
    pub fn at(&self, position: DVec3) -> Guided<'_> {
        let (caps, share, brightness) = match self.nodes[self.leaf(position)] {
            Node::Leaf { first, end, share, brightness } => (&self.caps[first..end], share, brightness),
            Node::Split { .. } => (&[] as &[Caps], 0.0, 1.0),
        };
        Guided { caps, share, brightness, arch: self.arch }
    }

    /// The density with which a path goes on from a place of a material into a direction, given that of the material's own sampling, 1/sr.
    #[must_use]
    pub fn density(&self, material: &dyn Material, position: DVec3, direction: DVec3, own: f64) -> f64 {
        if suits(material) { self.at(position).density(direction, own) } else { own }
    }
}

/// The caps of a leaf.
fn caps(landings: &[Landing]) -> Vec<Caps> {
    let mut caps = vec![Caps::NONE; landings.len().div_ceil(LANES)];
    let mut squares = Vec::with_capacity(landings.len());
    let count = |landing: &Landing| landing.weight.powf(FLATTER);
    let (mut sum, total) = (0.0, landings.iter().map(count).sum::<f64>());
    for (number, landing) in landings.iter().enumerate() {
        squares.clear();
        squares.extend(landings.iter().map(|other| landing.back.distance_squared(other.back)));
        // The direction itself is the nearest of all; a few of a leaf tell nothing of one another.
        let square = if squares.len() > NEAREST {
            let (_, nearest, _) = squares.select_nth_unstable_by(NEAREST, f64::total_cmp);
            (*nearest * WIDER * WIDER).clamp(SQUARES[0], SQUARES[1])
        } else {
            SQUARES[1]
        };
        let w = count(landing);
        sum += w;
        let (caps, lane) = (&mut caps[number / LANES], number % LANES);
        (0..3).for_each(|axis| caps.axes[axis][lane] = landing.back[axis]);
        caps.squares[lane] = square;
        caps.densities[lane] = w / total * (1.0 - TAIL) / (PI * square);
        // The last one ends where all do.
        caps.ends[lane] = if number + 1 < landings.len() { sum / total } else { 1.0 };
    }
    caps
}

/// g(ω) of a unit vector, with the instructions of the machine: the same operations in the same order with any.
struct Density<'a> {
    caps: &'a [Caps],
    direction: DVec3,
}

impl NullaryFnOnce for Density<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        const FAINTER: f64 = TAIL / (1.0 - TAIL) / (WIDE * WIDE);
        let mut sums = [0.0; LANES];
        for caps in self.caps {
            let [x, y, z] = &caps.axes;
            for i in 0..LANES {
                // Of unit vectors, the squared distance.
                let square = 2.0 - 2.0 * (x[i] * self.direction.x + y[i] * self.direction.y + z[i] * self.direction.z);
                let inner = if square < caps.squares[i] { 1.0 } else { 0.0 };
                let outer = if square < WIDE * WIDE * caps.squares[i] { FAINTER } else { 0.0 };
                sums[i] += (inner + outer) * caps.densities[i];
            }
        }
        sums.iter().sum()
    }
}

impl Guided<'_> {
    /// How much more flux of packets lands on an area there than does on the average over all places where any lands: from 1, where it is less or not known, to
    /// 10⁴.
    #[must_use]
    pub fn brightness(&self) -> f64 {
        self.brightness
    }

    /// p(ω) of a unit vector in the world, given p_f, 1/sr.
    #[must_use]
    pub fn density(&self, direction: DVec3, own: f64) -> f64 {
        let guided = self.arch.dispatch(Density { caps: self.caps, direction });
        self.share * guided + (1.0 - self.share) * own
    }

    /// Draws a direction of g; `None`, with the probability 1 − a, where the material's own sampling is to draw one.
    #[must_use]
    pub fn draw(&self, [choice, tail, u, v]: [f64; 4]) -> Option<DVec3> {
        let (guided, choice) = split(choice, self.share);
        if !guided {
            return None;
        }
        let among = self.caps.partition_point(|caps| caps.ends[LANES - 1] <= choice);
        let caps = self.caps.get(among)?;
        let lane = caps.ends.partition_point(|end| *end <= choice);
        let axis = DVec3::from(caps.axes.map(|along| along[lane]));
        let square = if tail < TAIL { WIDE * WIDE * caps.squares[lane] } else { caps.squares[lane] };
        // A chord r spans the angle τ with r² = 2 (1 − cos τ).
        let local = cone([u, v], 0.5 * square);
        let (x, y) = tangents(axis);
        Some(local.x * x + local.y * y + local.z * axis)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;
    use crate::math::sampling::cosine_hemisphere;

    /// Landings all over a square, from a few directions and from one patch of the hemisphere.
    fn landings(count: usize) -> Landings {
        let mut numbers = Stream::new(3, 4);
        let mut polished = Vec::new();
        for i in 0..count {
            let position = DVec3::new(numbers.uniform(), numbers.uniform(), 0.0);
            let [u, v] = [numbers.uniform(), numbers.uniform()];
            let back = match i % 3 {
                0 => DVec3::new(0.6, 0.0, 0.8),
                1 => cosine_hemisphere([u, v]),
                _ => cone([u, v], 0.01),
            };
            polished.push(Landing { position, back, weight: 0.5 + numbers.uniform() });
        }
        let plain = Landing { position: DVec3::new(0.1, 0.1, 0.0), back: DVec3::Z, weight: 1.0 };
        Landings { polished, plain: vec![plain; 500] }
    }

    #[test]
    fn too_few_landings_guide_nothing() {
        assert!(Guide::new(landings(LEAST - 1)).is_none());
        assert!(Guide::new(landings(LEAST)).is_some());
    }

    /// The density is that of the draws: the mean of h(ω)/p(ω) over them is ∫ h dω, which of h = 1 is 4π and of h = max(0, z) is π; here p_f is
    /// uniform over the sphere, so that no direction is left out. And every leaf has its share of own draws.
    #[test]
    fn directions_are_drawn_by_their_density() {
        let guide = Guide::new(landings(5000)).expect("a guide");
        let mut numbers = Stream::new(5, 6);
        let n = 200_000;
        for position in [DVec3::new(0.1, 0.1, 0.0), DVec3::new(0.7, 0.2, 0.0), DVec3::new(5.0, -3.0, 1.0)] {
            let guided = guide.at(position);
            assert!(!guided.caps.is_empty() && guided.caps.len() <= LEAF.div_ceil(LANES));
            let (mut whole, mut upper, mut squares, mut own) = (0.0, 0.0, [0.0; 2], 0.0);
            for _ in 0..n {
                let u = std::array::from_fn(|_| numbers.uniform());
                let direction = guided.draw(u).unwrap_or_else(|| {
                    own += 1.0;
                    cone([numbers.uniform(), numbers.uniform()], 2.0)
                });
                assert!((direction.length() - 1.0).abs() < 1e-12);
                let p = guided.density(direction, 0.25 / PI);
                let (a, b) = (1.0 / p, direction.z.max(0.0) / p);
                (whole, upper) = (whole + a, upper + b);
                squares = [squares[0] + a * a, squares[1] + b * b];
            }
            let n = f64::from(n);
            for (sum, square, expected) in [(whole, squares[0], 4.0 * PI), (upper, squares[1], PI)] {
                let error = ((square / n - (sum / n).powi(2)) / n).sqrt();
                // Five standard errors.
                assert!((sum / n - expected).abs() < 5.0 * error, "{} ± {error}, {expected}", sum / n);
            }
            let expected = 1.0 - guided.share;
            assert!((own / n - expected).abs() < 5.0 * (expected * guided.share / n).sqrt(), "{own} {expected}");
        }
        // Where much comes in other ways, the share is less.
        assert!(guide.at(DVec3::new(0.1, 0.1, 0.0)).share < guide.at(DVec3::new(0.9, 0.9, 0.0)).share);
    }

    /// Where most landings have one height, some one place, and a few are far above: each is among those that its place is asked for, and no leaf is large.
    #[test]
    fn landings_are_found_where_they_are() {
        let mut numbers = Stream::new(8, 9);
        let polished: Vec<Landing> = (0..20_000)
            .map(|i| {
                let [x, y] = [numbers.uniform(), numbers.uniform()].map(|u| if i % 5 == 0 { 0.25 } else { u });
                let back = cosine_hemisphere([numbers.uniform(), numbers.uniform()]);
                Landing { position: DVec3::new(x, y, if i % 50 == 1 { 2.5 } else { 0.0 }), back, weight: 1.0 }
            })
            .collect();
        let guide = Guide::new(Landings { polished: polished.clone(), plain: Vec::new() }).expect("a guide");
        let mut lost = 0;
        for landing in &polished {
            let caps = guide.at(landing.position).caps;
            assert!(caps.len() <= LEAF.div_ceil(LANES));
            let axes = |caps: &Caps| (0..LANES).any(|lane| DVec3::from(caps.axes.map(|a| a[lane])) == landing.back);
            lost += usize::from(!caps.iter().any(axes));
        }
        // A fifth are at one place, of which one leaf is kept.
        assert_eq!(lost, polished.len() / 5 - LEAF);
    }

    /// A lamp's few landings on a shelf above a floor are a leaf of their own.
    #[test]
    fn a_few_landings_are_a_leaf() {
        let mut landings = landings(600);
        landings.polished.iter_mut().take(3).for_each(|landing| landing.position.z = 7.0);
        let there = landings.polished[1];
        let guide = Guide::new(landings).expect("a guide");
        let guided = guide.at(there.position);
        assert_eq!(guided.caps.len(), 1);
        assert!(guided.density(there.back, 0.0) > 0.0);
    }

    /// Half of all land on 0.01 m², half on 1 m²: the one is 0.5/0.01 times 1.01 as bright as the average. The area on which 512 land by chance has a
    /// relative standard deviation of 1/√512 = 4.4 %.
    #[test]
    fn a_focus_is_bright() {
        let mut numbers = Stream::new(10, 11);
        let polished: Vec<Landing> = (0..8192)
            .map(|i| {
                let [x, y] = [numbers.uniform(), numbers.uniform()];
                let position = if i % 2 == 0 { DVec3::new(x, 0.0, y) } else { DVec3::new(2.0 + 0.1 * x, 0.0, 0.1 * y) };
                Landing { position, back: DVec3::Y, weight: 0.25 }
            })
            .collect();
        let guide = Guide::new(Landings { polished, plain: Vec::new() }).expect("a guide");
        assert_eq!(guide.at(DVec3::new(0.4, 0.0, 0.4)).brightness(), 1.0);
        let bright = guide.at(DVec3::new(2.04, 0.0, 0.04)).brightness();
        assert!((bright / 50.5 - 1.0).abs() < 0.1, "{bright}");
    }

    /// Where all landings are at one place nothing is known of their area.
    #[test]
    fn one_place_is_no_brighter() {
        let landing = Landing { position: DVec3::ONE, back: DVec3::Y, weight: 1.0 };
        let guide = Guide::new(Landings { polished: vec![landing; 1000], plain: Vec::new() }).expect("a guide");
        assert_eq!(guide.at(DVec3::ONE).brightness(), 1.0);
    }

    /// A direction that a third of the packets came from is found by a third of the guided draws, into caps of 0.1 mrad.
    #[test]
    fn one_direction_is_found_again() {
        let guide = Guide::new(landings(5000)).expect("a guide");
        let guided = guide.at(DVec3::new(0.7, 0.7, 0.0));
        let there = DVec3::new(0.6, 0.0, 0.8);
        let axes = guided.caps.iter().flat_map(|caps| (0..LANES).map(|lane| DVec3::from(caps.axes.map(|a| a[lane]))));
        let (caps, count) = axes
            .filter(|a| *a != DVec3::ZERO)
            .fold((0, 0), |(all, those), axis| (all + 1, those + usize::from(axis == there)));
        assert!(count > 3, "{count}");
        let own = 1.0 / PI;
        // The least weight is a third of the greatest.
        let share = count as f64 / 3.0 / f64::from(caps);
        let expected = guided.share * share * (1.0 - TAIL) / (PI * SQUARES[0]);
        assert!(guided.density(there, own) > expected, "{expected}");
    }
}

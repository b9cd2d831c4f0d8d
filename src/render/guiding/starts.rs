//! Where packets start that come over polished surfaces: learnt from those that did.
//!
//! Which light a packet leaves, where on it and in which direction, are functions of six uniform numbers, its [`Start`]. In a room few
//! lead to the glass on a table, and most of these lie together. They are sorted into boxes of the unit cube of six
//! dimensions, which are halved where many are, across the axis along which the halves differ most, and a start is drawn by
//!
//! ```text
//! p(u) = a + (1 − a) √q_k / Σ_j V_j √q_j,    q_k = W_k / V_k
//! ```
//!
//! in the box k of the volume V_k that holds starts of the weight W_k: with the root of the probability of success, by which the number of
//! landings of a few kinds has the least variance for so many packets. None is left out, as a is not 0. A packet counts 1/p(u).
//!
//! Reference: T. Müller, M. Gross, J. Novák, *Practical Path Guiding for Efficient Light-Transport Simulation*, EGSR 2017 (halving by counts);
//! R. Y. Rubinstein, D. P. Kroese, *Simulation and the Monte Carlo Method*, 3rd ed., 2016, §5.7 (the density of least variance).

use crate::math::sampling::split;
use crate::render::integrator::packet::Start;

/// The share a of starts that are drawn from all alike.
const ALL: f64 = 0.3;
/// Most starts of a box that is not halved.
const MOST: usize = 48;
/// Halves differ where their difference is more than so many standard deviations of chance.
const APART: f64 = 3.0;
/// Halvings of one box, at most.
const DEEPEST: u32 = 30;

/// The boxes; none, where all starts are alike.
#[derive(Debug, Clone, Default)]
pub struct Starts {
    nodes: Vec<Node>,
    boxes: Vec<Cell>,
}

#[derive(Debug, Clone, Copy)]
enum Node {
    /// Below a number the next node, else another.
    Split { axis: usize, at: f64, above: usize },
    /// A box, by its place in the list.
    Leaf(usize),
}

#[derive(Debug, Clone, Copy)]
struct Cell {
    low: Start,
    high: Start,
    /// W_k; once all are known, p(u).
    density: f64,
    /// Running sum, up to 1, of V_k √q_k.
    end: f64,
}

impl Cell {
    fn volume(&self) -> f64 {
        self.low.iter().zip(&self.high).map(|(low, high)| high - low).product()
    }
}

impl Starts {
    /// Learnt from starts of packets that came over polished surfaces, each with its weight, 1/p(u) where it was drawn.
    #[must_use]
    pub fn of(mut known: Vec<(Start, f64)>) -> Self {
        let mut starts = Self::default();
        if known.is_empty() {
            return starts;
        }
        starts.grow(&mut known, ([0.0; 6], [1.0; 6]), 0);
        let mut sum = 0.0;
        for cell in &mut starts.boxes {
            let volume = cell.volume();
            cell.density = (cell.density / volume).sqrt();
            sum += volume * cell.density;
            cell.end = sum;
        }
        for cell in &mut starts.boxes {
            cell.density = ALL + (1.0 - ALL) * cell.density / sum;
            cell.end /= sum;
        }
        starts
    }

    /// Adds the node of a box and all below it.
    fn grow(&mut self, known: &mut [(Start, f64)], (low, high): (Start, Start), depth: u32) {
        let half = |axis: usize| 0.5 * (low[axis] + high[axis]);
        let below = |axis: usize| known.iter().filter(|(start, _)| start[axis] < half(axis)).count();
        let apart = |axis: usize| (2 * below(axis)).abs_diff(known.len());
        // The first of those that are most.
        let axis = (1..6).fold(0, |best, axis| if apart(axis) > apart(best) { axis } else { best });
        let differ = apart(axis) as f64 > APART * (known.len() as f64).sqrt();
        if known.len() <= MOST || depth == DEEPEST || !differ {
            let density = known.iter().map(|(_, weight)| weight).sum();
            self.nodes.push(Node::Leaf(self.boxes.len()));
            self.boxes.push(Cell { low, high, density, end: 0.0 });
            return;
        }
        let at = half(axis);
        // Stable, so that the order is that of the packets.
        known.sort_by_key(|(start, _)| start[axis] >= at);
        let part = known.partition_point(|(start, _)| start[axis] < at);
        let (first, second) = known.split_at_mut(part);
        let (mut to, mut from) = (high, low);
        (to[axis], from[axis]) = (at, at);
        let node = self.nodes.len();
        self.nodes.push(Node::Split { axis, at, above: 0 });
        self.grow(first, (low, to), depth + 1);
        self.nodes[node] = Node::Split { axis, at, above: self.nodes.len() };
        self.grow(second, (from, high), depth + 1);
    }

    /// Makes of uniform numbers, one of which chooses among boxes, a start and p(u).
    #[must_use]
    pub fn draw(&self, uniform: Start, choice: f64) -> (Start, f64) {
        if self.boxes.is_empty() {
            return (uniform, 1.0);
        }
        let (all, choice) = split(choice, ALL);
        if all {
            return (uniform, self.boxes[self.leaf(uniform)].density);
        }
        // What is left of rounding is the last one's.
        let among = self.boxes.partition_point(|cell| cell.end <= choice).min(self.boxes.len() - 1);
        let Cell { low, high, density, .. } = self.boxes[among];
        (std::array::from_fn(|axis| low[axis] + uniform[axis] * (high[axis] - low[axis])), density)
    }

    /// The box of a start.
    fn leaf(&self, start: Start) -> usize {
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Split { axis, at, above } => node = if start[axis] < at { node + 1 } else { above },
                Node::Leaf(number) => return number,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Stream;

    /// Some in a corner of 1/32 of the cube, of which those on one side weigh more, the others all over it.
    fn known(count: usize) -> Vec<(Start, f64)> {
        let mut numbers = Stream::new(1, 2);
        let mut start = |i: usize| {
            let mut start: Start = numbers.uniforms();
            if !i.is_multiple_of(4) {
                (start[1], start[3]) = (start[1] / 8.0, 0.75 + start[3] / 4.0);
            }
            (start, if start[1] < 1.0 / 16.0 { 9.0 } else { 1.0 })
        };
        (0..count).map(&mut start).collect()
    }

    /// The mean of h(u)/p(u) over draws is ∫ h du: 1 of h = 1, 1/2 of h = u_i, 1/4 of h = u_1 u_3.
    #[test]
    fn starts_are_drawn_by_their_density() {
        let starts = Starts::of(known(5000));
        // Three halvings of one number and two of the other: the rest is chance.
        assert_eq!(starts.boxes.len(), 6);
        let whole: f64 = starts.boxes.iter().map(|cell| cell.volume() * cell.density).sum();
        assert!((whole - 1.0).abs() < 1e-12, "{whole}");
        let mut numbers = Stream::new(3, 4);
        let n = 200_000;
        let mut sums = [[0.0; 2]; 8];
        for _ in 0..n {
            let [choice] = numbers.uniforms();
            let (start, density) = starts.draw(numbers.uniforms(), choice);
            assert_eq!(density.to_bits(), starts.boxes[starts.leaf(start)].density.to_bits());
            let of = |h: f64| h / density;
            let all = [1.0, start[1] * start[3]].into_iter().chain(start).map(of);
            for (sum, h) in sums.iter_mut().zip(all) {
                *sum = [sum[0] + h, sum[1] + h * h];
            }
        }
        let n = f64::from(n);
        let expected = [1.0, 0.25].into_iter().chain([0.5; 6]);
        for ([sum, squares], expected) in sums.into_iter().zip(expected) {
            let mean = sum / n;
            let error = ((squares / n - mean * mean) / n).sqrt();
            // Five standard errors.
            assert!((mean - expected).abs() < 5.0 * error, "{mean} ± {error}, {expected}");
        }
    }

    /// Of two halves, nine times as much succeeds in one: it has three times the density.
    #[test]
    fn density_goes_with_the_root_of_success() {
        let mut numbers = Stream::new(5, 6);
        let known: Vec<(Start, f64)> = (0..4000)
            .map(|i| {
                let mut start: Start = numbers.uniforms();
                start[2] = 0.5 * start[2] + if i % 10 == 0 { 0.5 } else { 0.0 };
                (start, 1.0)
            })
            .collect();
        let starts = Starts::of(known);
        assert_eq!(starts.boxes.len(), 2);
        let own = |cell: &Cell| (cell.density - ALL) / (1.0 - ALL);
        assert!((own(&starts.boxes[0]) - 1.5).abs() < 1e-12 && (own(&starts.boxes[1]) - 0.5).abs() < 1e-12);
    }

    /// Where none is known all are alike, and many at one place end in one box.
    #[test]
    fn nothing_known_and_one_place() {
        let start = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
        assert_eq!(Starts::of(Vec::new()).draw(start, 0.9), (start, 1.0));
        let starts = Starts::of(vec![(start, 1.0); 1000]);
        assert_eq!(starts.nodes.len(), 2 * DEEPEST as usize + 1);
        let (drawn, density) = starts.draw(start, 0.9);
        assert!(drawn.iter().zip(start).all(|(a, b)| (a - b).abs() <= 1.0 / 32.0) && density > 1e8);
    }
}

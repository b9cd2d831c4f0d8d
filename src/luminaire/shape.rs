//! How alike the shapes of two intensity distributions are, whatever their flux.
//!
//! Both are divided by their flux: a and b integrate to 1 over the sphere. Then
//!
//! ```text
//! correlation                ∫ a b dω / √(∫ a² dω ∫ b² dω)             1 for equal shapes, 0 for disjoint ones
//! mean absolute difference   ∫ |a − b| dω / ∫ ½(a + b) dω             0 for equal shapes, 2 for disjoint ones
//! ```
//!
//! Tables of one system are compared on the union of their angles: in each cell both are bilinear, so that the products are
//! integrated exactly (Gauss with three points, on cells of at most 5° along the axis with the solid angle's weight: 1e-13). |a − b| is
//! integrated exactly where it keeps its sign; a cell in which it does not is halved again and again, and what may be
//! missing is bounded. Tables of different systems, or of Types A and B turned about the vertical, are looked up by
//! direction on a grid of C and γ of 1°, and again of 2°: the difference of the two estimates the error.

use glam::DVec3;

use super::distribution::{Distribution, Symmetry, System};

/// How the shapes of two distributions differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeDifference {
    /// Normalised correlation weighted by solid angle.
    pub correlation: f64,
    /// Mean absolute difference weighted by flux.
    pub mean_absolute_difference: f64,
    /// What that may be off by: a bound where the cells are exact, else an estimate.
    pub quadrature_error: f64,
    /// Whether both were bilinear in every cell.
    pub exact: bool,
    /// Largest local difference b − a of the shapes, over the peak of a.
    pub max_local_difference: f64,
    /// Where it is: native angles of the first distribution where both have the same system, else C and γ; degrees.
    pub max_direction_deg: (f64, f64),
}

/// Halvings of a cell in which the difference changes its sign.
const HALVINGS: u32 = 5;
/// Widest cell along the axis whose angle weights the solid angle, degrees.
const WIDEST_DEG: f64 = 5.0;
/// Below this part of the whole (in proportion to its solid angle) a cell's difference is not looked at more closely.
const NEGLIGIBLE: f64 = 1e-7;
/// Gauss-Legendre with three points on (−1, 1).
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// Compares the shapes of two distributions with positive flux; the second is turned by `turn_deg` towards increasing C.
#[must_use]
pub fn compare(a: &Distribution, b: &Distribution, turn_deg: f64) -> ShapeDifference {
    let system = a.system();
    let one_plane = |d: &Distribution| d.symmetry() == Symmetry::Rotational;
    let native =
        system == b.system() && (system == System::TypeC || (turn_deg == 0.0 && !one_plane(a) && !one_plane(b)));
    let (first, second) = (Seen::new(a, 0.0, native), Seen::new(b, turn_deg, native));
    if native {
        let horizontal = united(all_planes(a, 0.0), all_planes(b, turn_deg));
        let vertical = united(a.vertical_deg().to_vec(), b.vertical_deg().to_vec());
        let (horizontal, vertical) = match system {
            System::TypeB => (split(&horizontal), vertical),
            _ => (horizontal, split(&vertical)),
        };
        return over_cells(system, &horizontal, &vertical, &first, &second);
    }
    let by_direction = |step: usize| {
        let angles = |to: u32| (0..=to).step_by(step).map(f64::from).collect::<Vec<f64>>();
        over_cells(System::TypeC, &angles(360), &angles(180), &first, &second)
    };
    let (coarse, mut fine) = (by_direction(2), by_direction(1));
    fine.quadrature_error += (fine.mean_absolute_difference - coarse.mean_absolute_difference).abs();
    fine
}

/// The turn of `b` about the vertical, towards increasing C, at which its shape is most like that of `a`, degrees in (−180, 180];
/// the smallest of several equal ones.
///
/// All whole degrees are tried on a grid of 1°, then the neighbourhood of the best.
#[must_use]
pub fn best_turn_deg(a: &Distribution, b: &Distribution) -> f64 {
    const PLANES: usize = 360;
    let sample = |d: &Distribution, turn_deg: f64| -> Vec<f64> {
        let seen = Seen::new(d, turn_deg, false);
        let rows = (0..180).map(|i| f64::from(i) + 0.5);
        let seen = &seen;
        rows.flat_map(|v| (0..PLANES).map(move |c| seen.at(c as f64, v) * v.to_radians().sin().sqrt())).collect()
    };
    let (first, second) = (sample(a, 0.0), sample(b, 0.0));
    let overlap = |turn: usize| -> f64 {
        let rows = first.chunks_exact(PLANES).zip(second.chunks_exact(PLANES));
        rows.map(|(x, y)| dot(&x[turn..], &y[..PLANES - turn]) + dot(&x[..turn], &y[PLANES - turn..])).sum()
    };
    let signed = |turn: usize| if turn > 180 { turn as f64 - 360.0 } else { turn as f64 };
    let all: Vec<(f64, f64)> = (0..PLANES).map(|turn| (signed(turn), overlap(turn))).collect();
    let most = all.iter().map(|t| t.1).fold(f64::NEG_INFINITY, f64::max);
    let nearest = (all.iter().filter(|t| t.1 >= most * (1.0 - 1e-9)))
        .min_by(|x, y| x.0.abs().total_cmp(&y.0.abs()).then(y.0.total_cmp(&x.0)))
        .map_or(0.0, |t| t.0);
    // Between whole degrees the grids do not fall on each other: the norm of the turned samples counts as well.
    let likeness = |turn: f64| {
        let turned = sample(b, turn);
        dot(&first, &turned) / dot(&turned, &turned).sqrt()
    };
    let (mut low, mut high) = (nearest - 1.0, nearest + 1.0);
    while high - low > 0.01 {
        let third = (high - low) / 3.0;
        if likeness(low + third) < likeness(high - third) { low += third } else { high -= third }
    }
    let found = 0.5 * (low + high);
    if likeness(nearest) >= likeness(found) * (1.0 - 1e-9) { nearest } else { found }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// A distribution as the comparison looks at it.
struct Seen<'a> {
    distribution: &'a Distribution,
    turn_deg: f64,
    /// By its own angles; else by C and γ.
    native: bool,
    /// First and last horizontal and vertical angle, degrees, beyond which there is nothing.
    ends_deg: [(f64, f64); 2],
}

impl<'a> Seen<'a> {
    fn new(distribution: &'a Distribution, turn_deg: f64, native: bool) -> Self {
        let ends = |angles: &[f64]| (angles[0], angles[angles.len() - 1]);
        let whole = (f64::NEG_INFINITY, f64::INFINITY);
        let ends_deg = match (native, distribution.system()) {
            (false, _) => [whole; 2],
            (true, System::TypeC) => [whole, ends(distribution.vertical_deg())],
            (true, _) => [ends(&all_planes(distribution, 0.0)), ends(distribution.vertical_deg())],
        };
        Self { distribution, turn_deg, native, ends_deg }
    }

    fn at(&self, horizontal_deg: f64, vertical_deg: f64) -> f64 {
        let (d, h) = (self.distribution, horizontal_deg - self.turn_deg);
        if self.native || d.system() == System::TypeC {
            return d.at(h, vertical_deg);
        }
        let ((sc, cc), (sv, cv)) = (h.to_radians().sin_cos(), vertical_deg.to_radians().sin_cos());
        d.towards(DVec3::new(sv * cc, sv * sc, -cv))
    }

    /// Values at the corners of a cell, by horizontal, then vertical angle; none beyond the table, which ends with a step.
    fn corners(&self, cell: &Cell) -> [f64; 4] {
        let Cell { h, v } = cell;
        let beyond = |(low, high): (f64, f64), at: &(f64, f64)| {
            let middle = 0.5 * (at.0 + at.1);
            middle < low || middle > high
        };
        if beyond(self.ends_deg[0], h) || beyond(self.ends_deg[1], v) {
            return [0.0; 4];
        }
        [self.at(h.0, v.0), self.at(h.0, v.1), self.at(h.1, v.0), self.at(h.1, v.1)]
    }
}

/// A cell between two horizontal and two vertical angles, degrees.
#[derive(Clone, Copy)]
struct Cell {
    h: (f64, f64),
    v: (f64, f64),
}

impl Cell {
    /// ∫ f dω with f of the two values, which are bilinear between their corners.
    fn integral(&self, system: System, a: &[f64; 4], b: &[f64; 4], f: impl Fn(f64, f64) -> f64) -> f64 {
        let (dh, dv) = (0.5 * (self.h.1 - self.h.0).to_radians(), 0.5 * (self.v.1 - self.v.0).to_radians());
        let mut sum = 0.0;
        for (x, wx) in GAUSS {
            for (y, wy) in GAUSS {
                let (s, t) = (0.5 * (1.0 + x), 0.5 * (1.0 + y));
                let weight = match system {
                    System::TypeC => (self.v.0 + t * (self.v.1 - self.v.0)).to_radians().sin(),
                    System::TypeA => (self.v.0 + t * (self.v.1 - self.v.0)).to_radians().cos(),
                    System::TypeB => (self.h.0 + s * (self.h.1 - self.h.0)).to_radians().cos(),
                };
                sum += wx * wy * weight * f(bilinear(a, s, t), bilinear(b, s, t));
            }
        }
        sum * dh * dv
    }

    /// ∫ |d| dω of a bilinear d, and what that may be off by.
    fn absolute(&self, system: System, d: &[f64; 4], halvings: u32) -> (f64, f64) {
        if d.iter().all(|v| *v >= 0.0) || d.iter().all(|v| *v <= 0.0) {
            return (self.integral(system, d, d, |v, _| v.abs()), 0.0);
        }
        let solid_angle = self.integral(system, d, d, |_, _| 1.0);
        // A bilinear function is largest at a corner.
        let most = d.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let negligible = most < NEGLIGIBLE / (4.0 * std::f64::consts::PI);
        if halvings == 0 || negligible {
            return (self.integral(system, d, d, |v, _| v.abs()), most * solid_angle);
        }
        let (h, v) = (0.5 * (self.h.0 + self.h.1), 0.5 * (self.v.0 + self.v.1));
        let mut sum = (0.0, 0.0);
        for (i, hs) in [(self.h.0, h), (h, self.h.1)].into_iter().enumerate() {
            for (j, vs) in [(self.v.0, v), (v, self.v.1)].into_iter().enumerate() {
                let (s, t) = (0.5 * i as f64, 0.5 * j as f64);
                let corner = |x: f64, y: f64| bilinear(d, s + 0.5 * x, t + 0.5 * y);
                let part = [corner(0.0, 0.0), corner(0.0, 1.0), corner(1.0, 0.0), corner(1.0, 1.0)];
                let (value, error) = Self { h: hs, v: vs }.absolute(system, &part, halvings - 1);
                sum = (sum.0 + value, sum.1 + error);
            }
        }
        sum
    }
}

fn bilinear(c: &[f64; 4], s: f64, t: f64) -> f64 {
    (1.0 - s) * ((1.0 - t) * c[0] + t * c[1]) + s * ((1.0 - t) * c[2] + t * c[3])
}

fn over_cells(
    system: System,
    horizontal: &[f64],
    vertical: &[f64],
    first: &Seen<'_>,
    second: &Seen<'_>,
) -> ShapeDifference {
    let (flux_a, flux_b) = (first.distribution.total_flux(), second.distribution.total_flux());
    let peak = first.distribution.peak().0 / flux_a;
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    let (mut difference, mut error) = (0.0, 0.0);
    let mut largest = (0.0_f64, (horizontal[0], vertical[0]));
    for h in horizontal.windows(2).map(|w| (w[0], w[1])) {
        for v in vertical.windows(2).map(|w| (w[0], w[1])) {
            let cell = Cell { h, v };
            let a = first.corners(&cell).map(|x| x / flux_a);
            let b = second.corners(&cell).map(|x| x / flux_b);
            aa += cell.integral(system, &a, &b, |x, _| x * x);
            bb += cell.integral(system, &a, &b, |_, y| y * y);
            ab += cell.integral(system, &a, &b, |x, y| x * y);
            let d: [f64; 4] = std::array::from_fn(|i| b[i] - a[i]);
            let (value, bound) = cell.absolute(system, &d, HALVINGS);
            difference += value;
            error += bound;
            for (value, at) in d.into_iter().zip([(h.0, v.0), (h.0, v.1), (h.1, v.0), (h.1, v.1)]) {
                if value.abs() > largest.0.abs() {
                    largest = (value, at);
                }
            }
        }
    }
    ShapeDifference {
        // Rounding may lift equal shapes above 1.
        correlation: (ab / (aa * bb).sqrt()).min(1.0),
        mean_absolute_difference: difference,
        quadrature_error: error,
        exact: first.native,
        max_local_difference: largest.0 / peak,
        max_direction_deg: largest.1,
    }
}

/// All horizontal angles of a table without its symmetry, turned; for Type C those of the whole turn.
fn all_planes(d: &Distribution, turn_deg: f64) -> Vec<f64> {
    let own = d.horizontal_deg().to_vec();
    let mirror =
        |angles: Vec<f64>, axis: f64| -> Vec<f64> { angles.iter().flat_map(|a| [*a, 2.0 * axis - a]).collect() };
    if d.system() != System::TypeC {
        let mut all = match d.symmetry() {
            Symmetry::Quadrant => mirror(own, 0.0),
            _ => own,
        };
        all.sort_by(f64::total_cmp);
        return all;
    }
    let planes = match d.symmetry() {
        Symmetry::Quadrant => mirror(mirror(own, 90.0), 0.0),
        Symmetry::BilateralC0 => mirror(own, 0.0),
        Symmetry::BilateralC90 => mirror(own, 90.0),
        Symmetry::Rotational => Vec::new(),
        Symmetry::None => own,
    };
    let mut all: Vec<f64> = planes.into_iter().map(|c| (c + turn_deg).rem_euclid(360.0)).collect();
    all.extend([0.0, 360.0]);
    all
}

/// All angles of both, ascending, each once.
fn united(mut a: Vec<f64>, b: Vec<f64>) -> Vec<f64> {
    a.extend(b);
    a.sort_by(f64::total_cmp);
    a.dedup_by(|x, y| (*x - *y).abs() <= 1e-9);
    a
}

/// The same angles with others between them, so that no interval is wider than [`WIDEST_DEG`].
fn split(angles: &[f64]) -> Vec<f64> {
    let mut out = vec![angles[0]];
    for w in angles.windows(2) {
        let parts = ((w[1] - w[0]) / WIDEST_DEG).ceil().max(1.0);
        out.extend((1..=parts as usize).map(|i| w[0] + (w[1] - w[0]) * i as f64 / parts));
    }
    out
}

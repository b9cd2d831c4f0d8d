//! Adaptive integration of several functions at once over a rectangle.

/// What [`rectangle`] found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Bound on the absolute error of every integral, from the difference of two rules; it overstates smooth integrands.
    pub error: f64,
    /// Points at which the functions were taken.
    pub evaluations: usize,
    /// Whether the tolerance was reached before the limit.
    pub converged: bool,
}

/// When [`rectangle`] stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Absolute error.
    pub absolute: f64,
    /// Error relative to the largest of the integrals; the larger of the two counts.
    pub relative: f64,
    /// Most points.
    pub evaluations: usize,
}

/// A part of the rectangle with its integrals, in half widths about its middle.
#[derive(Debug)]
struct Cell {
    middle: [f64; 2],
    half: [f64; 2],
    integrals: Vec<f64>,
    error: f64,
    /// The axis along which the functions bend most: the next cut goes across it.
    axis: usize,
}

// Abscissae and weights of the rule of degree 7 and the one of degree 5 inside it, in two dimensions.
const L2: f64 = 0.358_568_582_800_318_1; // √(9/70)
const L4: f64 = 0.948_683_298_050_513_8; // √(9/10)
const L5: f64 = 0.688_247_201_611_685_3; // √(9/19)
const SEVENTH: [f64; 5] = [
    (12_824.0 - 9_120.0 * 2.0 + 400.0 * 4.0) / 19_683.0,
    980.0 / 6_561.0,
    (1_820.0 - 400.0 * 2.0) / 19_683.0,
    200.0 / 19_683.0,
    6_859.0 / 19_683.0 / 4.0,
];
const FIFTH: [f64; 4] =
    [(729.0 - 950.0 * 2.0 + 50.0 * 4.0) / 729.0, 245.0 / 486.0, (265.0 - 100.0 * 2.0) / 1_458.0, 25.0 / 729.0];

/// ∫∫ f(x, y) dx dy over `low[0]..high[0]` × `low[1]..high[1]` for `integrals.len()` functions at once: `f` writes their values
/// at a point. The cell with the largest error is halved until the errors sum to the tolerance.
///
/// The functions may have kinks and steep places; narrow peaks are found only where points come near them, so the caller chooses
/// coordinates in which there are none.
///
/// Reference: A. C. Genz & A. A. Malik, *An adaptive algorithm for numerical integration over an N-dimensional rectangular
/// region*, J. Comput. Appl. Math. 6 (1980): 17 points, degree 7 with 5 embedded.
pub fn rectangle(
    mut f: impl FnMut([f64; 2], &mut [f64]),
    low: [f64; 2],
    high: [f64; 2],
    tolerance: Tolerance,
    integrals: &mut [f64],
) -> Estimate {
    const POINTS: usize = 17;
    /// Cells to begin with along each axis: a first look everywhere.
    const START: usize = 4;
    let mut scratch = Scratch::new(integrals.len());
    let half: [f64; 2] = std::array::from_fn(|i| 0.5 * (high[i] - low[i]) / START as f64);
    let mut cells: Vec<Cell> = (0..START * START)
        .map(|n| {
            let place = [n % START, n / START];
            let middle = std::array::from_fn(|i| low[i] + (2 * place[i] + 1) as f64 * half[i]);
            cell(&mut f, middle, half, &mut scratch)
        })
        .collect();
    let mut evaluations = cells.len() * POINTS;
    loop {
        // Sums made anew: differences of large sums would keep the rounding of what was there before.
        integrals.fill(0.0);
        let mut error = 0.0;
        for c in &cells {
            integrals.iter_mut().zip(&c.integrals).for_each(|(sum, v)| *sum += v);
            error += c.error;
        }
        let largest = integrals.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let wanted = tolerance.absolute.max(tolerance.relative * largest);
        let converged = error <= wanted;
        if converged || evaluations >= tolerance.evaluations {
            return Estimate { error, evaluations, converged };
        }
        // Everything above its fair share is cut in this round: sorting once per cut would cost more than the cuts.
        let share = wanted / cells.len() as f64;
        let worst = cells.iter().fold(0.0_f64, |m, c| m.max(c.error));
        let (cut, keep): (Vec<Cell>, Vec<Cell>) =
            std::mem::take(&mut cells).into_iter().partition(|c| c.error > share && c.error >= 0.02 * worst);
        cells = keep;
        for parent in cut {
            let mut half = parent.half;
            half[parent.axis] *= 0.5;
            for side in [-1.0, 1.0] {
                let mut middle = parent.middle;
                middle[parent.axis] += side * half[parent.axis];
                cells.push(cell(&mut f, middle, half, &mut scratch));
            }
            evaluations += 2 * POINTS;
        }
    }
}

/// Room for the values at the points of one cell.
struct Scratch {
    values: Vec<f64>,
    sums: [Vec<f64>; 5],
    bends: [f64; 2],
}

impl Scratch {
    fn new(functions: usize) -> Self {
        Self { values: vec![0.0; functions], sums: std::array::from_fn(|_| vec![0.0; functions]), bends: [0.0; 2] }
    }
}

fn cell(f: &mut impl FnMut([f64; 2], &mut [f64]), middle: [f64; 2], half: [f64; 2], s: &mut Scratch) -> Cell {
    s.sums.iter_mut().for_each(|sum| sum.fill(0.0));
    let at = |x: f64, y: f64| [middle[0] + x * half[0], middle[1] + y * half[1]];
    let mut take = |point: [f64; 2], into: usize, values: &mut Vec<f64>, sums: &mut [Vec<f64>; 5]| {
        f(point, values);
        sums[into].iter_mut().zip(values.iter()).for_each(|(sum, v)| *sum += v);
    };
    take(at(0.0, 0.0), 0, &mut s.values, &mut s.sums);
    let middle_values = s.sums[0].clone();
    for axis in 0..2 {
        let mut bend = vec![0.0; middle_values.len()];
        // Fourth difference along the axis: what a parabola cannot follow.
        for (l, into, weight) in [(L2, 1, 1.0), (L4, 2, -(L2 * L2) / (L4 * L4))] {
            for sign in [-1.0, 1.0] {
                let point = if axis == 0 { at(sign * l, 0.0) } else { at(0.0, sign * l) };
                take(point, into, &mut s.values, &mut s.sums);
                bend.iter_mut().zip(&s.values).zip(&middle_values).for_each(|((b, v), m)| *b += weight * (v - m));
            }
        }
        s.bends[axis] = bend.iter().fold(0.0_f64, |m, b| m.max(b.abs()));
    }
    for (l, into) in [(L4, 3), (L5, 4)] {
        for (x, y) in [(-l, -l), (-l, l), (l, -l), (l, l)] {
            take(at(x, y), into, &mut s.values, &mut s.sums);
        }
    }
    let area = 4.0 * half[0] * half[1];
    let mut error = 0.0_f64;
    let integrals = (0..middle_values.len())
        .map(|i| {
            let rule = |weights: &[f64]| area * weights.iter().zip(&s.sums).map(|(w, sum)| w * sum[i]).sum::<f64>();
            let seventh = rule(&SEVENTH);
            error = error.max((seventh - rule(&FIFTH)).abs());
            seventh
        })
        .collect();
    // Where both axes bend alike, the longer one is cut.
    let [x, y] = s.bends;
    let axis = if (x - y).abs() <= 1e-3 * x.max(y) { usize::from(half[1] > half[0]) } else { usize::from(y > x) };
    Cell { middle, half, integrals, error, axis }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FINE: Tolerance = Tolerance { absolute: 1e-13, relative: 1e-11, evaluations: 1_000_000 };

    #[test]
    fn polynomials_of_degree_seven_are_exact() {
        let mut out = [0.0; 3];
        let f = |[x, y]: [f64; 2], v: &mut [f64]| {
            v.copy_from_slice(&[1.0, x.powi(4) * y.powi(3), x.powi(6) + y]);
        };
        rectangle(f, [0.0, -1.0], [2.0, 3.0], Tolerance { evaluations: 0, ..FINE }, &mut out);
        for (got, expected) in out.iter().zip([8.0, 32.0 / 5.0 * 20.0, 128.0 / 7.0 * 4.0 + 2.0 * 4.0]) {
            assert!((got / expected - 1.0).abs() < 1e-13, "{got} {expected}");
        }
    }

    #[test]
    fn closed_forms_are_met_within_the_stated_error() {
        // A peak of width 0.01: a product of two integrals of 1/(x² + w²).
        let w = 0.01_f64;
        let lorentz = |x: f64, at: f64| 1.0 / ((x - at).powi(2) + w * w);
        let area = |at: f64| ((1.0 - at) / w).atan() / w + (at / w).atan() / w;
        type Case<'a> = (&'a dyn Fn(f64, f64) -> f64, f64);
        let cases: [Case<'_>; 3] = [
            (&|x, y| (x + y).exp(), (1.0_f64.exp() - 1.0).powi(2)),
            // A kink along the diagonal.
            (&|x, y| (x - y).abs(), 1.0 / 3.0),
            (&|x, y| lorentz(x, 0.3) * lorentz(y, 0.6), area(0.3) * area(0.6)),
        ];
        for (f, expected) in cases {
            let mut out = [0.0];
            let tolerance = Tolerance { absolute: 1e-8, relative: 1e-9, evaluations: 2_000_000 };
            let e = rectangle(|[x, y], v| v[0] = f(x, y), [0.0; 2], [1.0; 2], tolerance, &mut out);
            assert!(e.converged, "{e:?}");
            assert!((out[0] - expected).abs() <= e.error, "{} {expected} {e:?}", out[0]);
        }
    }
}

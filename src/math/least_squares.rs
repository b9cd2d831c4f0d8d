//! Non-linear least squares within bounds, from normal equations.
//!
//! ```text
//! minimise S(x) = Σ r_k(x)²     low ≤ x ≤ high
//! step: (JᵀJ + λ D) δ = −Jᵀr     D the largest diagonal of JᵀJ met so far
//! ```
//!
//! Levenberg's and Marquardt's method with Nielsen's rule for λ. A variable at a bound whose gradient points outwards rests there; a
//! step that would leave the box is solved again with the variable put on the bound. The problem hands over JᵀJ and Jᵀr, not J: a
//! table of four million residuals is summed piece by piece, in parallel, without ever being kept. That is why no library is used
//! here: those there are want J or all residuals in memory, one at a time.
//!
//! JᵀJ has the square of J's condition. It is scaled to a unit diagonal before it is factored, and the minimum itself is where
//! Jᵀr = 0, which does not suffer from it; the certified problems in `tests/brdf/strd.rs` say how many digits are left.
//!
//! References: D. W. Marquardt, J. SIAM 11 (1963); J. J. Moré, Lecture Notes in Mathematics 630 (1978) (the scaling D);
//! H. B. Nielsen, IMM-REP-1999-05 (λ).

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

/// Sum of squares and its normal equations at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Linearised {
    /// Σ r².
    pub cost: f64,
    /// JᵀJ.
    pub normal: DMatrix<f64>,
    /// Jᵀr.
    pub gradient: DVector<f64>,
}

/// What is minimised.
pub trait Problem {
    /// Σ r² at `x`; `None` where there is no value.
    fn cost(&self, x: &[f64]) -> Option<f64>;

    /// Σ r², JᵀJ and Jᵀr at `x`.
    fn linearise(&self, x: &[f64]) -> Option<Linearised>;
}

/// When [`minimise`] stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most steps, tried ones included.
    pub iterations: usize,
    /// Step of every variable, relative to it.
    pub step: f64,
    /// Expected gain of a step, relative to Σ r².
    pub gain: f64,
}

/// An end of a variable's range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The lower one.
    Low,
    /// The upper one.
    High,
}

/// Where [`minimise`] arrived.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimum {
    /// The place.
    pub x: Vec<f64>,
    /// The sums there.
    pub at: Linearised,
    /// Variables that rest at an end of their range, the gradient pointing outwards.
    pub resting: Vec<Option<End>>,
    /// Steps, tried ones included.
    pub iterations: usize,
    /// Whether a limit of step or gain was reached, not that of the steps.
    pub converged: bool,
}

/// Largest λ: a step of this length gains nothing but rounding.
const STIFFEST: f64 = 1e16;

/// Expected gain, relative to Σ r², of steps that are taken for what they promise.
const TRUSTED: f64 = 1e-12;
/// Rounding of Σ r², relative to it.
const ROUNDING: f64 = 1e-13;

/// The minimum that is reached from `start` (moved into the box); `None` where the problem has no value there.
pub fn minimise(problem: &impl Problem, start: &[f64], low: &[f64], high: &[f64], limits: &Limits) -> Option<Minimum> {
    let mut x: Vec<f64> = start.iter().zip(low.iter().zip(high)).map(|(x, (l, h))| x.clamp(*l, *h)).collect();
    let mut at = problem.linearise(&x)?;
    let mut scale = at.normal.diagonal();
    let (mut damping, mut growth) = (1e-3, 2.0);
    let (mut iterations, mut converged) = (0, false);
    while iterations < limits.iterations {
        iterations += 1;
        let resting = resting(&x, &at.gradient, low, high);
        let Some(step) = step(&at, &x, &scale, damping, &resting, low, high) else {
            converged = resting.iter().all(Option::is_some);
            if converged || damping > STIFFEST {
                break;
            }
            damping *= growth;
            growth *= 2.0;
            continue;
        };
        let expected = -(2.0 * at.gradient.dot(&step) + step.dot(&(&at.normal * &step)));
        let small = x.iter().zip(step.iter()).all(|(x, d)| d.abs() <= limits.step * (x.abs() + limits.step));
        let trial: Vec<f64> =
            x.iter().zip(step.iter()).zip(low.iter().zip(high)).map(|((x, d), (l, h))| (x + d).clamp(*l, *h)).collect();
        let gain = problem.cost(&trial).filter(|c| c.is_finite()).map_or(f64::NEG_INFINITY, |c| at.cost - c);
        // Near the minimum the gain drowns in the rounding of Σ r², while Jᵀr still points to it: such steps are trusted.
        let drowned = expected <= TRUSTED * at.cost && gain >= -ROUNDING * at.cost;
        if gain > 0.0 || drowned {
            let Some(next) = problem.linearise(&trial) else { break };
            (x, at) = (trial, next);
            scale.iter_mut().zip(at.normal.diagonal().iter()).for_each(|(s, d)| *s = s.max(*d));
            let quality = if drowned { 1.0 } else { gain / expected.max(f64::MIN_POSITIVE) };
            damping *= (1.0 - (2.0 * quality - 1.0).powi(3)).clamp(1.0 / 3.0, 2.0);
            growth = 2.0;
        } else {
            damping *= growth;
            growth *= 2.0;
        }
        if small || expected <= limits.gain * at.cost || at.cost == 0.0 || damping > STIFFEST {
            converged = true;
            break;
        }
    }
    let resting = resting(&x, &at.gradient, low, high);
    Some(Minimum { x, at, resting, iterations, converged })
}

fn resting(x: &[f64], gradient: &DVector<f64>, low: &[f64], high: &[f64]) -> Vec<Option<End>> {
    let end = |i: usize| match gradient[i] {
        g if x[i] <= low[i] && g >= 0.0 => Some(End::Low),
        g if x[i] >= high[i] && g <= 0.0 => Some(End::High),
        _ => None,
    };
    (0..x.len()).map(end).collect()
}

/// The damped step within the box; `None` where nothing can move or the matrix is not positive.
fn step(
    at: &Linearised,
    x: &[f64],
    scale: &DVector<f64>,
    damping: f64,
    resting: &[Option<End>],
    low: &[f64],
    high: &[f64],
) -> Option<DVector<f64>> {
    let mut free: Vec<usize> = (0..x.len()).filter(|i| resting[*i].is_none()).collect();
    let mut step = DVector::zeros(x.len());
    while !free.is_empty() {
        // A variable without effect (a zero on the diagonal) has a scale of 1 and does not move.
        let unit: Vec<f64> = free.iter().map(|&i| if scale[i] > 0.0 { scale[i].sqrt() } else { 1.0 }).collect();
        let matrix = DMatrix::from_fn(free.len(), free.len(), |r, c| {
            let damped = if r == c { damping.max(f64::EPSILON) } else { 0.0 };
            at.normal[(free[r], free[c])] / (unit[r] * unit[c]) + damped
        });
        // What those on the bounds move already pulls at the others.
        let pulled = &at.gradient + &at.normal * &step;
        let right = DVector::from_fn(free.len(), |r, _| -pulled[free[r]] / unit[r]);
        let solved = Cholesky::new(matrix)?.solve(&right);
        let outside = |r: usize| {
            let (i, to) = (free[r], x[free[r]] + solved[r] / unit[r]);
            (to < low[i]).then_some(low[i]).or((to > high[i]).then_some(high[i]))
        };
        let stopped: Vec<(usize, f64)> = (0..free.len()).filter_map(|r| Some((free[r], outside(r)?))).collect();
        if stopped.is_empty() {
            free.iter().zip(&unit).zip(solved.iter()).for_each(|((i, u), s)| step[*i] = s / u);
            return Some(step);
        }
        for (i, bound) in stopped {
            step[i] = bound - x[i];
            free.retain(|f| *f != i);
        }
    }
    (step.iter().any(|d| *d != 0.0)).then_some(step)
}

/// The inverse of JᵀJ over the variables `free`, and how well it is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Inverse {
    /// (JᵀJ)⁻¹, in the order of `free`.
    pub matrix: DMatrix<f64>,
    /// Smallest over largest eigenvalue of JᵀJ scaled to a unit diagonal: 1 where the variables do not disturb one another, 0
    /// where some cannot be told apart.
    pub condition: f64,
    /// Eigenvectors of those below [`SINGULAR`] of the largest: which variables, scaled alike, can be moved against one another.
    pub loose: Vec<Vec<f64>>,
}

/// Eigenvalue over the largest below which variables count as inseparable: derivatives by differences are good to 1e-9, so that a
/// true zero comes out below 1e-16.
pub const SINGULAR: f64 = 1e-10;

/// Inverts JᵀJ over the variables `free`. Eigenvalues below 1e-14 of the largest are raised to that: the result is finite, and huge
/// along what the data do not tell.
#[must_use]
pub fn invert(normal: &DMatrix<f64>, free: &[usize]) -> Inverse {
    const FLOOR: f64 = 1e-14;
    if free.is_empty() {
        // All rest on their bounds: there is nothing to tell apart.
        return Inverse { matrix: DMatrix::zeros(0, 0), condition: 1.0, loose: Vec::new() };
    }
    let unit: Vec<f64> = free.iter().map(|&i| normal[(i, i)].max(f64::MIN_POSITIVE).sqrt()).collect();
    let scaled = DMatrix::from_fn(free.len(), free.len(), |r, c| normal[(free[r], free[c])] / (unit[r] * unit[c]));
    let eigen = SymmetricEigen::new(scaled);
    let largest = eigen.eigenvalues.iter().copied().fold(0.0, f64::max);
    let smallest = eigen.eigenvalues.iter().copied().fold(largest, f64::min);
    let condition = if largest > 0.0 { (smallest / largest).max(0.0) } else { 0.0 };
    let below = (0..free.len()).filter(|i| eigen.eigenvalues[*i] < SINGULAR * largest);
    let loose = below.map(|i| eigen.eigenvectors.column(i).iter().copied().collect()).collect();
    let matrix = DMatrix::from_fn(free.len(), free.len(), |r, c| {
        let vectors = &eigen.eigenvectors;
        let sum: f64 = (0..free.len())
            .map(|k| vectors[(r, k)] * vectors[(c, k)] / eigen.eigenvalues[k].max(FLOOR * largest))
            .sum();
        sum / (unit[r] * unit[c])
    });
    Inverse { matrix, condition, loose }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Residuals x − a, weighted: a quadratic bowl.
    struct Bowl {
        centre: Vec<f64>,
        normal: DMatrix<f64>,
    }

    impl Problem for Bowl {
        fn cost(&self, x: &[f64]) -> Option<f64> {
            self.linearise(x).map(|l| l.cost)
        }

        fn linearise(&self, x: &[f64]) -> Option<Linearised> {
            let d = DVector::from_fn(x.len(), |i, _| x[i] - self.centre[i]);
            let gradient = &self.normal * &d;
            Some(Linearised { cost: d.dot(&gradient), normal: self.normal.clone(), gradient })
        }
    }

    const LIMITS: Limits = Limits { iterations: 100, step: 1e-12, gain: 1e-30 };

    #[test]
    fn a_bound_holds_and_the_others_give_way() {
        // min over x ≤ 1 of a bowl about (2, 2) with A = [[2, 1], [1, 2]]: then 1·(x − 2) + 2·(y − 2) = 0, y = 2.5.
        let bowl = Bowl { centre: vec![2.0, 2.0], normal: DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0]) };
        let found = minimise(&bowl, &[0.0, 0.0], &[0.0; 2], &[1.0, 10.0], &LIMITS).expect("a value");
        assert!(found.converged && found.resting == [Some(End::High), None], "{found:?}");
        assert!((found.x[0] - 1.0).abs() < 1e-14 && (found.x[1] - 2.5).abs() < 1e-9, "{:?}", found.x);
        // A corner: nothing can move.
        let found = minimise(&bowl, &[0.5, 0.5], &[0.0; 2], &[1.0, 1.0], &LIMITS).expect("a value");
        assert!(found.converged && found.x == [1.0, 1.0], "{found:?}");
    }

    #[test]
    fn where_nothing_can_move_there_is_nothing_to_invert() {
        let inverse = invert(&DMatrix::from_row_slice(1, 1, &[4.0]), &[]);
        assert!(inverse.matrix.is_empty() && inverse.condition == 1.0 && inverse.loose.is_empty(), "{inverse:?}");
    }

    #[test]
    fn what_cannot_be_told_apart_is_found() {
        // Only the sum of the first two matters.
        let normal = DMatrix::from_row_slice(3, 3, &[1.0, 10.0, 0.0, 10.0, 100.0, 0.0, 0.0, 0.0, 4.0]);
        let inverse = invert(&normal, &[0, 1, 2]);
        assert!(inverse.condition < 1e-14, "{inverse:?}");
        let d = &inverse.loose[0];
        assert_eq!(inverse.loose.len(), 1);
        assert!((d[0] + d[1]).abs() < 1e-12 && d[0].abs() > 0.7 && d[2].abs() < 1e-12, "{d:?}");
        let apart = invert(&normal, &[1, 2]);
        assert!((apart.condition - 1.0).abs() < 1e-15 && (apart.matrix[(0, 0)] - 0.01).abs() < 1e-15, "{apart:?}");
    }
}

//! Minimising a smooth function of one variable.

/// The golden ratio's complement, (3 − √5)/2.
const GOLDEN: f64 = 0.381_966_011_250_105_1;
/// More steps than parabolic and golden steps ever need from any bracket of doubles.
const MAX_STEPS: usize = 200;

/// The minimum of `f` between `low` and `high` by Brent's method: parabolic steps, golden sections where they fail
/// (R. P. Brent, *Algorithms for Minimization without Derivatives*, 1973, ch. 5).
///
/// Returns `(x, f(x))`; x is within about `tolerance` of a local minimum, which is the only one where `f` is unimodal. A
/// minimum of f cannot be located better than to √ε of its scale by values alone: choose `tolerance` accordingly.
pub fn brent(low: f64, high: f64, tolerance: f64, mut f: impl FnMut(f64) -> f64) -> (f64, f64) {
    let (mut a, mut b) = (low.min(high), low.max(high));
    let mut x = a + GOLDEN * (b - a);
    let (mut w, mut v) = (x, x);
    let mut fx = f(x);
    let (mut fw, mut fv) = (fx, fx);
    let (mut step, mut previous) = (0.0_f64, 0.0_f64);
    for _ in 0..MAX_STEPS {
        let middle = 0.5 * (a + b);
        let tol = tolerance + f64::EPSILON * x.abs();
        if (x - middle).abs() <= 2.0 * tol - 0.5 * (b - a) {
            break;
        }
        let mut golden = true;
        if previous.abs() > tol {
            // Parabola through x, w and v.
            let r = (x - w) * (fx - fv);
            let mut q = (x - v) * (fx - fw);
            let mut p = (x - v) * q - (x - w) * r;
            q = 2.0 * (q - r);
            if q > 0.0 {
                p = -p;
            }
            q = q.abs();
            let before = previous;
            previous = step;
            if p.abs() < (0.5 * q * before).abs() && p > q * (a - x) && p < q * (b - x) {
                step = p / q;
                let u = x + step;
                if u - a < 2.0 * tol || b - u < 2.0 * tol {
                    step = if x < middle { tol } else { -tol };
                }
                golden = false;
            }
        }
        if golden {
            previous = if x < middle { b - x } else { a - x };
            step = GOLDEN * previous;
        }
        let u = if step.abs() >= tol { x + step } else { x + tol.copysign(step) };
        let fu = f(u);
        if fu <= fx {
            if u < x {
                b = x
            } else {
                a = x
            }
            (v, fv, w, fw, x, fx) = (w, fw, x, fx, u, fu);
        } else {
            if u < x {
                a = u
            } else {
                b = u
            }
            if fu <= fw || w == x {
                (v, fv, w, fw) = (w, fw, u, fu);
            } else if fu <= fv || v == x || v == w {
                (v, fv) = (u, fu);
            }
        }
    }
    (x, fx)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_and_a_quartic_are_found() {
        let (x, _) = brent(-3.0, 10.0, 1e-9, |x| (x - 2.5) * (x - 2.5));
        assert!((x - 2.5).abs() < 1e-7, "{x}");
        // x⁴ − x has its minimum at 4^(−1/3).
        let (x, _) = brent(0.0, 2.0, 1e-9, |x| x.powi(4) - x);
        assert!((x - 0.25_f64.cbrt()).abs() < 1e-7, "{x}");
    }

    #[test]
    fn a_minimum_at_the_edge_is_the_edge() {
        let (x, _) = brent(1.0, 2.0, 1e-9, |x| x);
        assert!((x - 1.0).abs() < 1e-7, "{x}");
    }
}

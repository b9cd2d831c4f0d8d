//! Interpolation kernels on ascending abscissae.
//!
//! Each takes `x` (strictly ascending), `y` (as long) and a target inside `[x[0], x[n−1]]`; none extrapolates.

/// Index `i` of the interval `[x[i], x[i+1]]` that holds `at`; the last interval for the right end. Needs two abscissae.
#[must_use]
pub fn interval(x: &[f64], at: f64) -> usize {
    x.partition_point(|&v| v <= at).saturating_sub(1).min(x.len().saturating_sub(2))
}

/// Linear interpolation; exact at the abscissae.
#[must_use]
pub fn linear(x: &[f64], y: &[f64], at: f64) -> f64 {
    if x.len() == 1 {
        return y[0];
    }
    let i = interval(x, at);
    let t = (at - x[i]) / (x[i + 1] - x[i]);
    // Written so that both ends come out exactly.
    if t == 1.0 { y[i + 1] } else { y[i] + t * (y[i + 1] - y[i]) }
}

/// Coefficients by which CIE 167:2005 (Sprague 1880) extends a table by two points at each end, over 209.
const SPRAGUE_ENDS: [[f64; 6]; 2] =
    [[884.0, -1960.0, 3033.0, -2648.0, 1080.0, -180.0], [508.0, -540.0, 488.0, -367.0, 144.0, -24.0]];

/// The fifth-order Sprague interpolation of CIE 167:2005 on equally spaced abscissae, at least six of them.
///
/// `y` is extended at both ends by the two points that the method prescribes; `i` and `t` give the place as
/// `x[i] + t·(x[i+1] − x[i])` with `0 ≤ t ≤ 1`.
#[must_use]
pub fn sprague(y: &[f64], i: usize, t: f64) -> f64 {
    let n = y.len();
    let at = |k: isize| -> f64 {
        if k < 0 {
            let row = &SPRAGUE_ENDS[(k + 2) as usize];
            row.iter().zip(y).map(|(c, v)| c * v).sum::<f64>() / 209.0
        } else if k as usize >= n {
            let row = &SPRAGUE_ENDS[1 - (k as usize - n)];
            row.iter().zip(y.iter().rev()).map(|(c, v)| c * v).sum::<f64>() / 209.0
        } else {
            y[k as usize]
        }
    };
    let i = i as isize;
    let [a, b, c, d, e, f] = [at(i - 2), at(i - 1), at(i), at(i + 1), at(i + 2), at(i + 3)];
    let a1 = (2.0 * a - 16.0 * b + 16.0 * d - 2.0 * e) / 24.0;
    let a2 = (-a + 16.0 * b - 30.0 * c + 16.0 * d - e) / 24.0;
    let a3 = (-9.0 * a + 39.0 * b - 70.0 * c + 66.0 * d - 33.0 * e + 7.0 * f) / 24.0;
    let a4 = (13.0 * a - 64.0 * b + 126.0 * c - 124.0 * d + 61.0 * e - 12.0 * f) / 24.0;
    let a5 = (-5.0 * a + 25.0 * b - 50.0 * c + 50.0 * d - 25.0 * e + 5.0 * f) / 24.0;
    c + t * (a1 + t * (a2 + t * (a3 + t * (a4 + t * a5))))
}

/// Cubic Hermite interpolation with the slopes given, one per abscissa.
#[must_use]
pub fn hermite(x: &[f64], y: &[f64], slopes: &[f64], at: f64) -> f64 {
    if x.len() == 1 {
        return y[0];
    }
    let i = interval(x, at);
    let h = x[i + 1] - x[i];
    hermite_cell(h, (at - x[i]) / h, [y[i], y[i + 1]], [slopes[i], slopes[i + 1]])
}

/// The cubic on one interval of width `h` with the values and slopes at its two ends, at the fraction `t` of it, 0 to 1; exact
/// at both ends.
#[must_use]
pub fn hermite_cell(h: f64, t: f64, [y0, y1]: [f64; 2], [s0, s1]: [f64; 2]) -> f64 {
    let u = 1.0 - t;
    y0 * u * u * (1.0 + 2.0 * t) + y1 * t * t * (3.0 - 2.0 * t) + h * t * u * (s0 * u - s1 * t)
}

/// Slope of the monotone cubic at an abscissa between two intervals of widths `h` with secants `d`: their weighted harmonic
/// mean, or 0 where they differ in sign (Fritsch & Butland 1984). Its error is of second order in `h`, so that the cubic's is
/// of third; at an extremum of the data, where the slope is set to 0, of second.
#[must_use]
pub fn pchip_slope([h0, h1]: [f64; 2], [d0, d1]: [f64; 2]) -> f64 {
    if d0 * d1 <= 0.0 {
        return 0.0;
    }
    let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
    (w0 + w1) / (w0 / d0 + w1 / d1)
}

/// Slope of the monotone cubic at an end, from the first two intervals inwards: the parabola's, limited so that the first
/// interval stays monotone (Moler 2004, 3.4).
#[must_use]
pub fn pchip_end_slope([h0, h1]: [f64; 2], [d0, d1]: [f64; 2]) -> f64 {
    let slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if slope * d0 <= 0.0 {
        0.0
    } else if d0 * d1 <= 0.0 && slope.abs() > 3.0 * d0.abs() {
        3.0 * d0
    } else {
        slope
    }
}

/// Slopes of the piecewise cubic Hermite interpolant that keeps monotone data monotone (PCHIP): [`pchip_slope`] inside,
/// [`pchip_end_slope`] at the ends.
#[must_use]
pub fn pchip_slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    if n < 2 {
        return vec![0.0; n];
    }
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let d: Vec<f64> = y.windows(2).zip(&h).map(|(w, h)| (w[1] - w[0]) / h).collect();
    if n == 2 {
        return vec![d[0]; 2];
    }
    let mut slopes = vec![0.0; n];
    for i in 1..n - 1 {
        slopes[i] = pchip_slope([h[i - 1], h[i]], [d[i - 1], d[i]]);
    }
    slopes[0] = pchip_end_slope([h[0], h[1]], [d[0], d[1]]);
    slopes[n - 1] = pchip_end_slope([h[n - 2], h[n - 3]], [d[n - 2], d[n - 3]]);
    slopes
}

/// Slopes of the natural cubic spline (second derivative zero at both ends), as [`hermite`] wants them.
#[must_use]
pub fn spline_slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    if n < 2 {
        return vec![0.0; n];
    }
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let d: Vec<f64> = y.windows(2).zip(&h).map(|(w, h)| (w[1] - w[0]) / h).collect();
    // Tridiagonal system for the slopes: natural ends 2m₀ + m₁ = 3d₀; inside, continuity of the second derivative.
    let (mut diagonal, mut right) = (vec![0.0; n], vec![0.0; n]);
    diagonal[0] = 2.0;
    right[0] = 3.0 * d[0];
    let upper = |i: usize| if i == 0 { 1.0 } else { h[i - 1] };
    for i in 1..n {
        let (lower, main, rhs) = if i == n - 1 {
            (1.0, 2.0, 3.0 * d[i - 1])
        } else {
            (h[i], 2.0 * (h[i - 1] + h[i]), 3.0 * (h[i] * d[i - 1] + h[i - 1] * d[i]))
        };
        let factor = lower / diagonal[i - 1];
        diagonal[i] = main - factor * upper(i - 1);
        right[i] = rhs - factor * right[i - 1];
    }
    let mut slopes = vec![0.0; n];
    slopes[n - 1] = right[n - 1] / diagonal[n - 1];
    for i in (0..n - 1).rev() {
        slopes[i] = (right[i] - upper(i) * slopes[i + 1]) / diagonal[i];
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: [f64; 7] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];

    #[test]
    fn linear_is_exact_at_the_knots() {
        let y = [0.1, 0.7, 0.3, 1e-30, 5.0, 2.0, 0.9];
        for (x, y_at) in X.iter().zip(&y) {
            assert_eq!(linear(&X, &y, *x), *y_at);
        }
        assert_eq!(linear(&X, &y, 0.5), 0.4);
    }

    #[test]
    fn sprague_is_exact_for_a_line_everywhere_and_a_quartic_inside() {
        // The prescribed end points continue straight lines only; inside, the five-point derivatives are exact to x⁴.
        let x: Vec<f64> = (0..12).map(f64::from).collect();
        let line: Vec<f64> = x.iter().map(|x| 3.0 + 2.0 * x).collect();
        let quartic = |x: f64| 1.0 - 2.0 * x + 0.3 * x.powi(3) - 0.02 * x.powi(4);
        let inside: Vec<f64> = x.iter().map(|&x| quartic(x)).collect();
        for k in 0..=110 {
            let at = f64::from(k) / 10.0;
            let i = interval(&x, at);
            assert!((sprague(&line, i, at - x[i]) - (3.0 + 2.0 * at)).abs() < 1e-12, "{at}");
            if (2..=8).contains(&i) {
                assert!((sprague(&inside, i, at - x[i]) - quartic(at)).abs() < 1e-11, "{at}");
            }
        }
    }

    #[test]
    fn pchip_never_overshoots_and_spline_is_smooth() {
        let y = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        let slopes = pchip_slopes(&X, &y);
        for k in 0..=600 {
            let v = hermite(&X, &y, &slopes, f64::from(k) / 100.0);
            assert!((0.0..=1.0).contains(&v), "{v}");
        }
        // A natural spline through a straight line is that line.
        let line: Vec<f64> = X.iter().map(|x| 4.0 - 3.0 * x).collect();
        let slopes = spline_slopes(&X, &line);
        assert!(slopes.iter().all(|s| (s + 3.0).abs() < 1e-12), "{slopes:?}");
    }

    #[test]
    fn pchip_converges_with_the_orders_of_its_slopes() {
        // Largest error on exp over [0, 1] (monotone: third order) and on cos over [−1, 1] with its extremum off the nodes (second).
        let error = |f: fn(f64) -> f64, from: f64, n: usize| {
            let x: Vec<f64> = (0..=n).map(|i| from + (1.0 - from) * i as f64 / n as f64).collect();
            let y: Vec<f64> = x.iter().map(|x| f(*x)).collect();
            let slopes = pchip_slopes(&x, &y);
            let at = |k: usize| from + (1.0 - from) * k as f64 / 5000.0;
            (0..=5000).map(|k| (hermite(&x, &y, &slopes, at(k)) - f(at(k))).abs()).fold(0.0, f64::max)
        };
        let order = |f, from| (error(f, from, 25) / error(f, from, 75)).log(3.0);
        assert!((order(f64::exp, 0.0) - 3.0).abs() < 0.1, "{}", order(f64::exp, 0.0));
        assert!((order(f64::cos, -1.0) - 2.0).abs() < 0.1, "{}", order(f64::cos, -1.0));
    }

    #[test]
    fn the_natural_spline_of_a_bump_has_its_known_value() {
        // Through (0,0), (1,1), (2,0): the natural spline is 1.5x − 0.5x³ on the first half.
        let (x, y) = ([0.0, 1.0, 2.0], [0.0, 1.0, 0.0]);
        let slopes = spline_slopes(&x, &y);
        assert!((hermite(&x, &y, &slopes, 0.5) - 0.6875).abs() < 1e-14);
    }
}

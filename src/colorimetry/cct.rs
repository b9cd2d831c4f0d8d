//! Correlated colour temperature and Duv: the nearest point of the Planckian locus in the CIE 1960 (u, v) diagram.
//!
//! Two methods: [`nearest`] minimises the distance to the locus itself; [`ohno2013`] is the table method of Y. Ohno, "Practical
//! Use and Calculation of CCT and Duv", LEUKOS 10 (2014). The locus is that of the CIE 1931 observer, summed over
//! 360–830 nm by 1 nm.
//!
//! Temperature enters Planck's law only as c₂/T, so one table serves every second radiation constant: a CCT on
//! another scale is this one times the ratio of the constants.

use std::sync::OnceLock;

use serde::Serialize;

use super::observer::Observer;
use crate::constants::{SECOND_RADIATION_ITS90, SecondRadiation};
use crate::tables;

/// Largest |Duv| for which CIE 15:2018, 9.4 lets a correlated colour temperature be stated.
pub const LARGEST_DUV: f64 = 0.05;
/// Lowest temperature reported, K: below, the locus has run into the red end of the spectrum and a CCT says nothing.
pub const LOWEST_K: f64 = 500.0;
/// Highest temperature reported, K: beyond, 1e-7 in u is more than the rest of the locus.
pub const HIGHEST_K: f64 = 1e6;

/// Both ends belong to the range, up to what rounding of (u, v) makes of them.
const END_TOLERANCE: f64 = 1e-6;

/// Spacing of the locus's knots, in mired on the ITS-90 scale.
const STEP_MIRED: f64 = 5.0;
/// Number of knots: 0 to 2500 mired (infinite temperature to 400 K, beyond the lowest reported on any scale).
const KNOTS: usize = 501;
/// Newton steps at most; quadratic convergence from a bracket of one knot needs three or four.
const NEWTON_STEPS: usize = 30;

/// A correlated colour temperature and its distance from the locus.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Cct {
    /// Temperature of the nearest blackbody, K.
    pub kelvin: f64,
    /// Signed distance in (u, v) 1960; positive above the locus (towards green).
    pub duv: f64,
}

/// Why there is no meaningful correlated colour temperature.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Undefined {
    /// The chromaticity itself is not defined.
    #[error("there is no light, or not a finite amount, and so no chromaticity")]
    Black,
    /// Too far from the locus.
    #[error(
        "the chromaticity is {duv:+.4} from the Planckian locus in (u, v); a CCT is defined within ±0.05 (CIE 15:2018, 9.4)"
    )]
    TooFar {
        /// Signed distance.
        duv: f64,
    },
    /// Beyond the end of infinite temperature.
    #[error("the chromaticity is bluer than a blackbody of {HIGHEST_K:e} K")]
    TooBlue,
    /// Beyond the cold end.
    #[error("the chromaticity is redder than a blackbody of {LOWEST_K} K")]
    TooRed,
}

/// The method of finding a correlated colour temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Default)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Direct minimisation of the distance to the locus.
    #[default]
    Exact,
    /// Ohno's table with triangular and parabolic solutions.
    Ohno2013,
}

/// One knot of the locus: (u, v) with first and second derivatives by mired.
#[derive(Debug, Clone, Copy, Default)]
struct Knot {
    p: [f64; 2],
    d: [f64; 2],
    dd: [f64; 2],
}

/// Exact (u, v) of the locus and derivatives at a reciprocal temperature in mired (ITS-90 scale), zero included.
fn evaluate(mired: f64) -> Knot {
    static FUNCTIONS: OnceLock<[Vec<f64>; 4]> = OnceLock::new();
    let [wavelengths, x_bar, y_bar, z_bar] = FUNCTIONS.get_or_init(|| {
        let table = tables::get(Observer::Cie1931.table_name()).expect("observer tables are embedded");
        let column = |name| table.column(name).expect("an observer has three functions").to_vec();
        [table.wavelengths_nm().to_vec(), column("x_bar"), column("y_bar"), column("z_bar")]
    });
    // L ∝ λ⁻⁵ / (eˢ − 1), s = a·m. Times m it stays finite as m → 0; the factor cancels in (u, v). With g = m/(eˢ − 1):
    // the sums and their derivatives by m.
    let mut sums = [[0.0_f64; 3]; 3];
    for i in 0..wavelengths.len() {
        // In units of 560 nm, so that the fifth power stays near one.
        let a = SECOND_RADIATION_ITS90 / (wavelengths[i] * 1e-9) * 1e-6;
        let power = (560.0 / wavelengths[i]).powi(5);
        let [g, dg, ddg] = bose(a, mired).map(|v| v * power);
        for (k, bar) in [x_bar[i], y_bar[i], z_bar[i]].into_iter().enumerate() {
            sums[0][k] += g * bar;
            sums[1][k] += dg * bar;
            sums[2][k] += ddg * bar;
        }
    }
    // u = 4X/N, v = 6Y/N with N = X + 15Y + 3Z; quotient rule twice.
    let n = sums.map(|[x, y, z]| x + 15.0 * y + 3.0 * z);
    let mut knot = Knot::default();
    for (axis, (index, factor)) in [(0, 4.0), (1, 6.0)].into_iter().enumerate() {
        let f = sums.map(|s| factor * s[index]);
        let p = f[0] / n[0];
        let d = (f[1] - p * n[1]) / n[0];
        knot.p[axis] = p;
        knot.d[axis] = d;
        knot.dd[axis] = (f[2] - 2.0 * d * n[1] - p * n[2]) / n[0];
    }
    knot
}

/// g(m) = m/(e^{am} − 1) and its first two derivatives, also at m = 0 and for a·m beyond the exponent's range.
fn bose(a: f64, m: f64) -> [f64; 3] {
    let s = a * m;
    if s < 0.05 {
        // B(s) = s/(eˢ − 1) = 1 − s/2 + s²/12 − s⁴/720 + s⁶/30240 − …; g = B/a.
        let s2 = s * s;
        let b = 1.0 - s / 2.0 + s2 / 12.0 - s2 * s2 / 720.0 + s2 * s2 * s2 / 30240.0;
        let db = -0.5 + s / 6.0 - s * s2 / 180.0 + s * s2 * s2 / 5040.0;
        let ddb = 1.0 / 6.0 - s2 / 60.0 + s2 * s2 / 1008.0;
        return [b / a, db, ddb * a];
    }
    // e⁻ˢ form: f = 1/(eˢ − 1) = e⁻ˢ/(1 − e⁻ˢ), f′ = −f(1 + f), f″ = f(1 + f)(1 + 2f).
    // 1 − e⁻ˢ loses a factor of 1/s at most, twenty units in the last place.
    let e = (-s).exp();
    let f = e / (1.0 - e);
    let df = -a * f * (1.0 + f);
    let ddf = a * a * f * (1.0 + f) * (1.0 + 2.0 * f);
    [m * f, f + m * df, 2.0 * df + m * ddf]
}

/// A knot of the locus, calculated when it is first asked for: one CCT needs about eighty of them.
fn knot(index: usize) -> &'static Knot {
    static LOCUS: [OnceLock<Knot>; KNOTS] = [const { OnceLock::new() }; KNOTS];
    LOCUS[index].get_or_init(|| evaluate(STEP_MIRED * index as f64))
}

/// Quintic Hermite interpolation of the locus between two knots; the error is below 1e-12 in (u, v), held by a test.
fn interpolate(mired: f64) -> Knot {
    let i = ((mired / STEP_MIRED) as usize).min(KNOTS - 2);
    let (a, b) = (knot(i), knot(i + 1));
    let t = mired / STEP_MIRED - i as f64;
    let h = STEP_MIRED;
    let mut out = Knot::default();
    for k in 0..2 {
        // Power form of the quintic with the six end conditions.
        let (c0, c1, c2) = (a.p[k], a.d[k] * h, 0.5 * a.dd[k] * h * h);
        let p = b.p[k] - c0 - c1 - c2;
        let d = b.d[k] * h - c1 - 2.0 * c2;
        let dd = b.dd[k] * h * h - 2.0 * c2;
        let c3 = 10.0 * p - 4.0 * d + 0.5 * dd;
        let c4 = -15.0 * p + 7.0 * d - dd;
        let c5 = 6.0 * p - 3.0 * d + 0.5 * dd;
        out.p[k] = c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5))));
        out.d[k] = (c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * (4.0 * c4 + t * 5.0 * c5)))) / h;
        out.dd[k] = (2.0 * c2 + t * (6.0 * c3 + t * (12.0 * c4 + t * 20.0 * c5))) / (h * h);
    }
    out
}

/// (u, v) 1960 of a blackbody on the Planckian locus (CIE 1931 observer); `kelvin` from 400 K to infinity.
#[must_use]
pub fn planckian_uv(kelvin: f64, c2: SecondRadiation) -> [f64; 2] {
    let mired = 1e6 / kelvin * (c2.metre_kelvin() / SECOND_RADIATION_ITS90);
    interpolate(mired).p
}

/// The nearest blackbody to a chromaticity (u, v) 1960, by minimisation of the distance.
///
/// Finds the global minimum over the knots of the locus, then the zero of (P − p)·P′ by Newton's method inside a bracket; the
/// temperature is exact to the rounding of (u, v).
///
/// # Errors
/// [`Undefined`] outside the range in which a CCT means something.
pub fn nearest(uv: [f64; 2], c2: SecondRadiation) -> Result<Cct, Undefined> {
    if !uv.iter().all(|v| v.is_finite()) {
        return Err(Undefined::Black);
    }
    let best = closest(KNOTS, 8, |i| square_distance(knot(i).p, uv));
    let (mut low, mut high) =
        (STEP_MIRED * best.saturating_sub(1) as f64, STEP_MIRED * (best + 1).min(KNOTS - 1) as f64);
    // g(m) = (P − p)·P′ is half the derivative of the squared distance: negative before the minimum, positive after it.
    let mut mired = STEP_MIRED * best as f64;
    let mut here = interpolate(mired);
    for _ in 0..NEWTON_STEPS {
        let off = [here.p[0] - uv[0], here.p[1] - uv[1]];
        let g = off[0] * here.d[0] + off[1] * here.d[1];
        let slope = here.d[0].powi(2) + here.d[1].powi(2) + off[0] * here.dd[0] + off[1] * here.dd[1];
        if g > 0.0 {
            high = mired
        } else {
            low = mired
        }
        let newton = mired - g / slope;
        let next = if slope > 0.0 && newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        let moved = (next - mired).abs();
        mired = next;
        here = interpolate(mired);
        if moved <= 1e-13 * mired {
            break;
        }
    }
    let off = [uv[0] - here.p[0], uv[1] - here.p[1]];
    finish(mired, off, here.d, c2)
}

fn square_distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}

/// The index below `count` of the smallest distance. Every `stride`-th is looked at first: the locus is smooth on that scale,
/// the distance has no second minimum in between.
fn closest(count: usize, stride: usize, distance: impl Fn(usize) -> f64) -> usize {
    let smallest = |among: &mut dyn Iterator<Item = usize>| {
        let mut best = (0, f64::INFINITY);
        for i in among {
            let d = distance(i);
            if d < best.1 {
                best = (i, d);
            }
        }
        best.0
    };
    let coarse = smallest(&mut (0..count).step_by(stride));
    smallest(&mut (coarse.saturating_sub(stride)..(coarse + stride + 1).min(count)))
}

/// Checks the range and signs the distance: with m growing the locus runs towards red, and green is on its left.
fn finish(mired: f64, off: [f64; 2], tangent: [f64; 2], c2: SecondRadiation) -> Result<Cct, Undefined> {
    let side = tangent[0] * off[1] - tangent[1] * off[0];
    let duv = off[0].hypot(off[1]).copysign(side);
    let kelvin = 1e6 / mired * (c2.metre_kelvin() / SECOND_RADIATION_ITS90);
    if duv.abs() > LARGEST_DUV {
        Err(Undefined::TooFar { duv })
    } else if kelvin > HIGHEST_K * (1.0 + END_TOLERANCE) {
        Err(Undefined::TooBlue)
    } else if kelvin < LOWEST_K * (1.0 - END_TOLERANCE) {
        Err(Undefined::TooRed)
    } else {
        Ok(Cct { kelvin, duv })
    }
}

/// Ratio of successive temperatures in Ohno's table: 0.25 %, with which he states an error below 0.1 K from 1000 K to
/// 20 000 K for the combined solution.
const OHNO_RATIO: f64 = 1.0025;
/// First temperature of the table, K on the ITS-90 scale.
const OHNO_FIRST_K: f64 = 450.0;
/// Entries, up to about 1.2e6 K.
const OHNO_ENTRIES: usize = 3160;
/// |Duv| below which Ohno takes the triangular solution.
const OHNO_TRIANGLE: f64 = 0.002;

/// The nearest blackbody by Ohno's method (LEUKOS 10:47–55, 2014): the closest entry of a table of the locus, then a
/// triangular solution near the locus and a parabolic one away from it.
///
/// # Errors
/// [`Undefined`] as [`nearest`].
pub fn ohno2013(uv: [f64; 2], c2: SecondRadiation) -> Result<Cct, Undefined> {
    if !uv.iter().all(|v| v.is_finite()) {
        return Err(Undefined::Black);
    }
    static TABLE: OnceLock<Vec<[f64; 3]>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        (0..OHNO_ENTRIES)
            .map(|i| {
                let kelvin = OHNO_FIRST_K * OHNO_RATIO.powi(i as i32);
                let [u, v] = planckian_uv(kelvin, SecondRadiation::Its90);
                [kelvin, u, v]
            })
            .collect()
    });
    let square = |i: usize| square_distance([table[i][1], table[i][2]], uv);
    let distance = |i: usize| square(i).sqrt();
    let best = closest(OHNO_ENTRIES, 32, square).clamp(1, OHNO_ENTRIES - 2);
    let ([t0, u0, v0], [t1, ..], [t2, u2, v2]) = (table[best - 1], table[best], table[best + 1]);
    let (d0, d1, d2) = (distance(best - 1), distance(best), distance(best + 1));
    // Triangle between the neighbours.
    let base = (u2 - u0).hypot(v2 - v0);
    let x = (d0 * d0 - d2 * d2 + base * base) / (2.0 * base);
    let triangle = t0 + (t2 - t0) * x / base;
    let foot = [u0 + (u2 - u0) * x / base, v0 + (v2 - v0) * x / base];
    let side = v0 + (v2 - v0) * x / base;
    let sign = if uv[1] >= side { 1.0 } else { -1.0 };
    let mut kelvin = triangle;
    let mut duv = (uv[0] - foot[0]).hypot(uv[1] - foot[1]) * sign;
    if duv.abs() >= OHNO_TRIANGLE {
        // Parabola through the three distances.
        let x = (t2 - t1) * (t0 - t2) * (t1 - t0);
        let a = (t0 * (d2 - d1) + t1 * (d0 - d2) + t2 * (d1 - d0)) / x;
        let b = -(t0 * t0 * (d2 - d1) + t1 * t1 * (d0 - d2) + t2 * t2 * (d1 - d0)) / x;
        let c = -(d0 * (t2 - t1) * t1 * t2 + d1 * (t0 - t2) * t0 * t2 + d2 * (t1 - t0) * t0 * t1) / x;
        kelvin = -b / (2.0 * a);
        duv = sign * (a * kelvin * kelvin + b * kelvin + c);
    }
    let mired = 1e6 / kelvin;
    // Reuse of the range check; the sign is already settled.
    finish(mired, [0.0, duv], [1.0, 0.0], c2)
}

/// The correlated colour temperature by the method named.
///
/// # Errors
/// [`Undefined`] as [`nearest`].
pub fn correlated(uv: [f64; 2], method: Method, c2: SecondRadiation) -> Result<Cct, Undefined> {
    match method {
        Method::Exact => nearest(uv, c2),
        Method::Ohno2013 => ohno2013(uv, c2),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interpolated_locus_is_the_exact_one() {
        let mut worst = 0.0_f64;
        for k in 0..2490 {
            let mired = 0.5 + f64::from(k);
            let (exact, got) = (evaluate(mired), interpolate(mired));
            worst = worst.max((exact.p[0] - got.p[0]).abs()).max((exact.p[1] - got.p[1]).abs());
        }
        assert!(worst < 1e-12, "{worst}");
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for mired in [0.5, 20.0, 153.0, 350.0, 1000.0] {
            let h = 1e-3;
            let (a, b, c) = (evaluate(mired - h), evaluate(mired), evaluate(mired + h));
            for k in 0..2 {
                let d = (c.p[k] - a.p[k]) / (2.0 * h);
                assert!((d / b.d[k] - 1.0).abs() < 1e-6, "{mired}: {d} {}", b.d[k]);
                let dd = (c.d[k] - a.d[k]) / (2.0 * h);
                assert!((dd / b.dd[k] - 1.0).abs() < 1e-6, "{mired}: {dd} {}", b.dd[k]);
            }
        }
    }

    #[test]
    fn blackbodies_are_themselves_from_500_k_to_1e6_k() {
        for k in 0..=330 {
            let kelvin = 500.5 * 10f64.powf(f64::from(k) / 100.0);
            let mired = 1e6 / kelvin;
            let uv = evaluate(mired).p;
            let got = nearest(uv, SecondRadiation::Its90).expect("on the locus");
            // (u, v) carries 1e-12 at best and moves 1e-4 per mired near infinity: 1e-8 mired. At 500 K it moves ten times less.
            assert!((1e6 / got.kelvin - mired).abs() < 2e-7 && got.duv.abs() < 2e-12, "{kelvin}: {got:?}");
            let ohno = ohno2013(uv, SecondRadiation::Its90).expect("on the locus");
            if (1000.0..=20000.0).contains(&kelvin) {
                // Ohno's stated accuracy.
                assert!((ohno.kelvin - kelvin).abs() < 1.0 && ohno.duv.abs() < 1e-5, "{kelvin}: {ohno:?}");
            }
        }
    }

    #[test]
    fn duv_comes_back_on_both_sides() {
        for kelvin in [1500.0, 2700.0, 4000.0, 6500.0, 15000.0] {
            let knot = evaluate(1e6 / kelvin);
            let length = knot.d[0].hypot(knot.d[1]);
            for duv in [-0.04, -0.01, -1e-6, 1e-6, 0.01, 0.04] {
                let uv = [knot.p[0] - knot.d[1] / length * duv, knot.p[1] + knot.d[0] / length * duv];
                let got = nearest(uv, SecondRadiation::Its90).expect("near the locus");
                assert!((got.duv - duv).abs() < 1e-11, "{kelvin} {duv}: {got:?}");
                assert!((got.kelvin / kelvin - 1.0).abs() < 1e-7, "{kelvin} {duv}: {got:?}");
            }
        }
    }

    #[test]
    fn the_strided_search_finds_what_a_full_one_does() {
        for kelvin in [600.0, 1500.0, 2700.0, 4000.0, 6500.0, 15000.0, 200_000.0] {
            let foot = evaluate(1e6 / kelvin);
            let length = foot.d[0].hypot(foot.d[1]);
            for step in -10..=10 {
                let duv = 0.005 * f64::from(step);
                let uv = [foot.p[0] - foot.d[1] / length * duv, foot.p[1] + foot.d[0] / length * duv];
                let distance = |i: usize| square_distance(knot(i).p, uv);
                assert_eq!(closest(KNOTS, 8, distance), closest(KNOTS, 1, distance), "{kelvin} K, Duv {duv}");
            }
        }
    }

    #[test]
    fn what_means_nothing_is_refused() {
        let at = |uv| nearest(uv, SecondRadiation::Its90);
        assert_eq!(at([f64::NAN, 0.3]), Err(Undefined::Black));
        assert!(matches!(at([0.1, 0.35]), Err(Undefined::TooFar { .. })));
        assert_eq!(at([0.175, 0.255]), Err(Undefined::TooBlue));
        let red = evaluate(2300.0).p;
        assert_eq!(at(red), Err(Undefined::TooRed));
    }

    #[test]
    fn the_scale_of_c2_moves_a_cct_in_proportion() {
        let uv = evaluate(1e6 / 6500.0).p;
        let si = nearest(uv, SecondRadiation::Si).expect("on the locus");
        // 1.438776877e-2 / 1.4388e-2 · 6500 K = 6499.8955 K: the 0.1 K of the ITS-90 value.
        assert!((si.kelvin - 6500.0 * 1.438_776_877e-2 / 1.4388e-2).abs() < 1e-4, "{si:?}");
    }
}

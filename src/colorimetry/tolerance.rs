//! Tolerances of white light: the quadrangles of ANSI C78.377, MacAdam steps (SDCM) and circles in u′v′ about its nominal colours.

use std::sync::LazyLock;

use super::chromaticity::uv_prime_of_xy;
use crate::tables;

/// Radius of one step in u′v′ (CIE TN 001:2014: n steps are a circle of 0.0011 n).
pub const UV_PRIME_STEP: f64 = 0.0011;

/// A nominal colour of white light and what counts as it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nominal {
    /// Nominal correlated colour temperature, K.
    pub cct_k: f64,
    /// Centre in CIE 1931 x, y.
    pub centre_xy: [f64; 2],
    /// Corners of the quadrangle in x, y, in order round it.
    pub corners_xy: [[f64; 2]; 4],
    /// The ellipse of one MacAdam step; `None` where none could be had (3500, 4500, 5700 K).
    pub ellipse: Option<Ellipse>,
}

/// An ellipse about a nominal colour in x, y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// Half of the long axis.
    pub a: f64,
    /// Half of the short axis.
    pub b: f64,
    /// Angle of the long axis to x, degrees.
    pub theta_deg: f64,
}

/// Where a chromaticity stands to a nominal colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// The nominal colour.
    pub nominal: &'static Nominal,
    /// Whether it is inside of the quadrangle.
    pub inside: bool,
    /// Distance to the centre in u′v′.
    pub delta_uv_prime: f64,
    /// MacAdam steps (standard deviations of colour matching) from the centre.
    pub sdcm: Option<f64>,
}

static NOMINALS: LazyLock<Vec<Nominal>> = LazyLock::new(|| {
    let table = tables::lookups().iter().find(|t| t.info().name == "ansi-c78-377").expect("the table is embedded");
    let row = |line: &str| {
        let v: Vec<f64> = line.split(',').map(|c| c.parse().unwrap_or(f64::NAN)).collect();
        let ellipse = Ellipse { a: v[11], b: v[12], theta_deg: v[13] };
        Nominal {
            cct_k: v[0],
            centre_xy: [v[1], v[2]],
            corners_xy: [[v[3], v[4]], [v[5], v[6]], [v[7], v[8]], [v[9], v[10]]],
            ellipse: Some(ellipse).filter(|e| e.a > 0.0),
        }
    };
    table.csv().lines().skip(1).map(row).collect()
});

/// The nominal colours, by rising colour temperature (ANSI C78.377-2008).
#[must_use]
pub fn nominals() -> &'static [Nominal] {
    &NOMINALS
}

impl Nominal {
    /// Where x, y of the CIE 1931 observer stand to this colour; `None` where u′v′ is not defined.
    #[must_use]
    pub fn of(&'static self, xy: [f64; 2]) -> Option<Tolerance> {
        let ([u, v], [u0, v0]) = (uv_prime_of_xy(xy)?, uv_prime_of_xy(self.centre_xy)?);
        Some(Tolerance {
            nominal: self,
            inside: self.contains(xy),
            delta_uv_prime: (u - u0).hypot(v - v0),
            sdcm: self.ellipse.map(|e| e.steps([xy[0] - self.centre_xy[0], xy[1] - self.centre_xy[1]])),
        })
    }

    /// Whether x, y are inside of the quadrangle or on its edge.
    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let c = &self.corners_xy;
        // On the same side of all edges, whichever way round they go.
        let sides: Vec<f64> = (0..4)
            .map(|i| {
                let ([x0, y0], [x1, y1]) = (c[i], c[(i + 1) % 4]);
                (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
            })
            .collect();
        sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0)
    }
}

impl Ellipse {
    /// Steps of an offset in x, y.
    #[must_use]
    pub fn steps(&self, [dx, dy]: [f64; 2]) -> f64 {
        let (s, c) = self.theta_deg.to_radians().sin_cos();
        ((dx * c + dy * s) / self.a).hypot((dy * c - dx * s) / self.b)
    }

    /// Points of the ellipse of some steps about a centre, once round.
    #[must_use]
    pub fn outline(&self, [x, y]: [f64; 2], steps: f64) -> Vec<[f64; 2]> {
        const POINTS: u32 = 64;
        let (s, c) = self.theta_deg.to_radians().sin_cos();
        (0..=POINTS)
            .map(|i| (2.0 * std::f64::consts::PI * f64::from(i) / f64::from(POINTS)).sin_cos())
            .map(|(v, u)| {
                [x + steps * (self.a * u * c - self.b * v * s), y + steps * (self.a * u * s + self.b * v * c)]
            })
            .collect()
    }
}

/// The tolerance of the nominal colour that x, y of the CIE 1931 observer are nearest to in u′v′; `None` where u′v′ is not defined.
///
/// ```
/// use photopic::colorimetry::tolerance::nearest;
/// // IEC 60081's F 4000, near the centre of 4000 K.
/// let t = nearest([0.380, 0.380]).expect("a chromaticity");
/// assert!(t.nominal.cct_k == 4000.0 && t.inside && t.sdcm.is_some_and(|s| s < 2.0));
/// ```
#[must_use]
pub fn nearest(xy: [f64; 2]) -> Option<Tolerance> {
    let all = nominals().iter().filter_map(|n| n.of(xy));
    all.min_by(|a, b| a.delta_uv_prime.total_cmp(&b.delta_uv_prime))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colorimetry::cct;
    use crate::constants::SecondRadiation;

    #[test]
    fn corners_have_the_temperatures_and_duv_of_the_standards_definition() {
        // ANSI C78.377-2008, Table 1: target and tolerance of the colour temperature, target of Duv, whose tolerance is 0.006.
        let defined = [
            (2725.0, 145.0, 0.0),
            (3045.0, 175.0, 0.0),
            (3465.0, 245.0, 0.0),
            (3985.0, 275.0, 0.001),
            (4503.0, 243.0, 0.001),
            (5028.0, 283.0, 0.002),
            (5665.0, 355.0, 0.002),
            (6530.0, 510.0, 0.003),
        ];
        for (n, (target, tolerance, duv)) in nominals().iter().zip(defined) {
            let at = |[x, y]: [f64; 2]| {
                let d = -2.0 * x + 12.0 * y + 3.0;
                cct::nearest([4.0 * x / d, 6.0 * y / d], SecondRadiation::default()).expect("near the locus")
            };
            let centre = at(n.centre_xy);
            // Half of the last printed digit of x, y in kelvins and in Duv, along and across the locus.
            let digit_k = 1e-4 * target * target / 1600.0;
            assert!((centre.kelvin - target).abs() < digit_k && (centre.duv - duv).abs() < 1e-4, "{centre:?}");
            for (corner, (side, end)) in n.corners_xy.iter().zip([(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)]) {
                let found = at(*corner);
                assert!((found.kelvin - target - end * tolerance).abs() < 2.0 * digit_k, "{found:?} of {target}");
                assert!((found.duv - duv - side * 0.006).abs() < 1e-4, "{found:?} of {duv}");
            }
        }
        assert_eq!(nominals().len(), 8);
    }

    #[test]
    fn an_ellipse_is_so_many_steps_away_all_round() {
        for n in nominals() {
            let Some(e) = n.ellipse else { continue };
            for p in e.outline(n.centre_xy, 3.0) {
                let t = n.of(p).expect("a chromaticity");
                assert!((t.sdcm.expect("an ellipse") - 3.0).abs() < 1e-9);
                assert!(t.inside, "three steps are inside of the quadrangle of seven");
            }
        }
        // The end of the long axis at 4000 K, 0.00313 at 53.72°.
        let n = nearest([0.3818, 0.3797]).expect("a chromaticity").nominal;
        let (s, c) = 53.72f64.to_radians().sin_cos();
        let t = n.of([0.3818 + 0.00313 * c, 0.3797 + 0.00313 * s]).expect("a chromaticity");
        assert!((t.sdcm.expect("an ellipse") - 1.0).abs() < 1e-9);
        assert_eq!(n.of([0.45, 0.41]).map(|t| t.inside), Some(false));
        assert!(nearest([f64::NAN, 0.3]).is_none_or(|t| t.delta_uv_prime.is_nan()));
    }
}

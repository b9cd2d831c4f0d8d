//! Whiteness, tint and yellowness of reflecting samples.
//!
//! ```text
//! W  = Y + 800 (xₙ − x) + 1700 (yₙ − y)
//! T  = t (xₙ − x) − 650 (yₙ − y)              t = 1000 (2° observer), 900 (10° observer)
//! YI = 100 (C_X X − C_Z Z) / Y
//! ```
//!
//! W and T are those of CIE 15:2004 under illuminant D65, and of ASTM E313-20 under C and D65; YI with its C_X and C_Z is of
//! ASTM E313-20 alone. Y = 100 and (xₙ, yₙ) belong to the perfect reflecting diffuser.

use super::{Observer, chromaticity};

/// An illuminant for which the formulas are defined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Daylight {
    /// Illuminant C.
    C,
    /// Standard illuminant D65.
    D65,
}

impl Daylight {
    /// The illuminant of a name, without regard to case; `None` of any other.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        [("C", Self::C), ("D65", Self::D65)].into_iter().find(|(n, _)| n.eq_ignore_ascii_case(name)).map(|(_, d)| d)
    }
}

/// The constants of the formulas for one illuminant and observer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Formula {
    /// t of T.
    tint_x: f64,
    /// C_X and C_Z of YI (ASTM E313-20).
    yellowness: [f64; 2],
}

/// Whiteness, tint and yellowness of one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whiteness {
    /// W; 100 of the perfect diffuser, more of bluish whites.
    pub whiteness: f64,
    /// T; positive is greenish, negative reddish.
    pub tint: f64,
    /// YI of ASTM E313.
    pub yellowness: f64,
    /// Y, on which the upper limit of W depends.
    y: f64,
}

impl Formula {
    /// The formulas for an illuminant and an observer; `None` for observers other than the CIE's of 1931 and 1964.
    #[must_use]
    pub fn new(light: Daylight, observer: Observer) -> Option<Self> {
        let (tint_x, yellowness) = match (observer, light) {
            (Observer::Cie1931, Daylight::C) => (1000.0, [1.2769, 1.0592]),
            (Observer::Cie1931, Daylight::D65) => (1000.0, [1.2985, 1.1335]),
            (Observer::Cie1964, Daylight::C) => (900.0, [1.2871, 1.0781]),
            (Observer::Cie1964, Daylight::D65) => (900.0, [1.3013, 1.1498]),
            _ => return None,
        };
        Some(Self { tint_x, yellowness })
    }

    /// The figures of a sample of tristimulus values `xyz` (Y = 100 of the perfect diffuser) beside a perfect diffuser of
    /// chromaticity `white_xy`; `None` where Y is not positive.
    #[must_use]
    pub fn evaluate(&self, xyz: [f64; 3], white_xy: [f64; 2]) -> Option<Whiteness> {
        let [x, y] = chromaticity::xy(xyz).filter(|_| xyz[1] > 0.0)?;
        let (dx, dy) = (white_xy[0] - x, white_xy[1] - y);
        let [c_x, c_z] = self.yellowness;
        Some(Whiteness {
            whiteness: xyz[1] + 800.0 * dx + 1700.0 * dy,
            tint: self.tint_x * dx - 650.0 * dy,
            yellowness: 100.0 * (c_x * xyz[0] - c_z * xyz[2]) / xyz[1],
            y: xyz[1],
        })
    }
}

impl Whiteness {
    /// Why the sample is none that CIE 15:2004 calls white, to which W and T are confined: 40 < W < 5Y − 280, −4 < T < 2.
    #[must_use]
    pub fn outside(&self) -> Option<String> {
        let Self { whiteness: w, tint: t, y, .. } = self;
        let highest = 5.0 * y - 280.0;
        let mut why = Vec::new();
        if !(*w > 40.0 && *w < highest) {
            why.push(format!("W = {w:.1}, not between 40 and 5Y − 280 = {highest:.1}"));
        }
        if !(*t > -4.0 && *t < 2.0) {
            why.push(format!("T = {t:.2}, not between −4 and 2"));
        }
        (!why.is_empty()).then(|| why.join("; "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn xyz([x, y]: [f64; 2], luminance: f64) -> [f64; 3] {
        [x / y * luminance, luminance, (1.0 - x - y) / y * luminance]
    }

    /// The example in the documentation of colour-science's `whiteness_CIE2004`: 93.85…, −1.305….
    #[test]
    fn whiteness_of_a_documented_example() {
        let formula = Formula::new(Daylight::D65, Observer::Cie1931).expect("defined");
        let found = formula.evaluate(xyz([0.3167, 0.3334], 100.0), [0.3139, 0.3311]).expect("light");
        // The printed digits are all there are: 100 − 2.24 − 3.91 and −2.8 + 1.495.
        assert!((found.whiteness - 93.85).abs() < 1e-10 && (found.tint - -1.305).abs() < 1e-10, "{found:?}");
        // t = 900 for 10°, by hand: 900·(−0.0028) + 650·0.0023.
        let formula = Formula::new(Daylight::D65, Observer::Cie1964).expect("defined");
        let found = formula.evaluate(xyz([0.3167, 0.3334], 100.0), [0.3139, 0.3311]).expect("light");
        assert!((found.tint - -1.025).abs() < 1e-10, "{found:?}");
    }

    /// The example in the documentation of colour-science's `yellowness_ASTME313`: XYZ 95, 100, 105 gives 4.34; the others by hand
    /// from the coefficients of E313.
    #[test]
    fn yellowness_of_a_documented_example() {
        for (light, observer, want) in [
            (Daylight::D65, Observer::Cie1931, 4.34),
            (Daylight::D65, Observer::Cie1964, 2.8945),
            (Daylight::C, Observer::Cie1931, 10.0895),
            (Daylight::C, Observer::Cie1964, 9.074),
        ] {
            let formula = Formula::new(light, observer).expect("defined");
            let found = formula.evaluate([95.0, 100.0, 105.0], [0.3127, 0.3290]).expect("light").yellowness;
            assert!((found - want).abs() < 1e-10, "{light:?} {observer}: {found} for {want}");
        }
    }

    #[test]
    fn what_is_not_white_is_told() {
        let formula = Formula::new(Daylight::D65, Observer::Cie1931).expect("defined");
        let of = |xy, luminance| formula.evaluate(xyz(xy, luminance), [0.3127, 0.3290]).expect("light").outside();
        assert_eq!(of([0.3127, 0.3290], 100.0), None);
        // W = Y = 50, above 5Y − 280 = −30: a grey.
        assert!(of([0.3127, 0.3290], 50.0).expect("grey").contains("-30.0"));
        // T = 1000 · 0.003 at the y of the white.
        assert!(of([0.3097, 0.3290], 100.0).expect("green").contains("T = 3.00"));
        assert_eq!(formula.evaluate([0.0; 3], [0.3127, 0.3290]), None);
    }
}

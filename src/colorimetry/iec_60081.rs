//! The standard colours of fluorescent lamps of IEC 60081 and steps (SDCM) about them, by which LED products are judged as well.
//!
//! ```text
//! n² = g₁₁ Δx² + 2 g₁₂ Δx Δy + g₂₂ Δy²
//! ```

use std::sync::LazyLock;

use super::chromaticity::uv_prime_of_xy;
use crate::tables;

/// A standard colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandardColour {
    /// What it is called by: 4000 of F 4000.
    pub nominal_k: f64,
    /// Its correlated colour temperature as stated, K.
    pub cct_k: f64,
    /// Centre in CIE 1931 x, y.
    pub centre_xy: [f64; 2],
    /// g₁₁, g₁₂, g₂₂ of one step.
    pub metric: [f64; 3],
}

/// Where a chromaticity stands to a standard colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// The colour.
    pub colour: &'static StandardColour,
    /// Steps (standard deviations of colour matching) from it.
    pub sdcm: f64,
}

static COLOURS: LazyLock<Vec<StandardColour>> = LazyLock::new(|| {
    let table = tables::lookups().iter().find(|t| t.info().name == "iec-60081").expect("the table is embedded");
    let row = |line: &str| {
        let v: Vec<f64> = line.split(',').map(|c| c.parse().unwrap_or(f64::NAN)).collect();
        StandardColour { cct_k: v[0], nominal_k: v[1], centre_xy: [v[2], v[3]], metric: [v[4], v[5], v[6]] }
    };
    table.csv().lines().skip(1).map(row).collect()
});

/// The standard colours, by rising colour temperature: F 2700, F 3000, F 3500, F 4000, F 5000 and F 6500.
#[must_use]
pub fn colours() -> &'static [StandardColour] {
    &COLOURS
}

impl StandardColour {
    /// Steps of x, y of the CIE 1931 observer from this colour.
    #[must_use]
    pub fn sdcm(&self, [x, y]: [f64; 2]) -> f64 {
        let (dx, dy) = (x - self.centre_xy[0], y - self.centre_xy[1]);
        let [g11, g12, g22] = self.metric;
        (g11 * dx * dx + 2.0 * g12 * dx * dy + g22 * dy * dy).sqrt()
    }
}

/// Steps from the standard colour that x, y of the CIE 1931 observer are nearest to in u′v′; `None` where u′v′ is not defined.
///
/// ```
/// use photopic::colorimetry::iec_60081::nearest;
/// let found = nearest([0.380, 0.380]).expect("a chromaticity");
/// assert!(found.colour.nominal_k == 4000.0 && found.sdcm == 0.0);
/// ```
#[must_use]
pub fn nearest(xy: [f64; 2]) -> Option<Steps> {
    let [u, v] = uv_prime_of_xy(xy)?;
    let distance = |c: &StandardColour| uv_prime_of_xy(c.centre_xy).map_or(f64::MAX, |[a, b]| (u - a).hypot(v - b));
    let colour = colours().iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    Some(Steps { colour, sdcm: colour.sdcm(xy) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colorimetry::cct;
    use crate::colorimetry::tolerance;
    use crate::constants::SecondRadiation;

    /// The stated temperatures are those of the centres, which have three digits.
    #[test]
    fn centres_have_the_temperatures_stated() {
        for c in colours() {
            let [x, y] = c.centre_xy;
            let at = |dx: f64, dy: f64| {
                let (x, y) = (x + dx, y + dy);
                let d = -2.0 * x + 12.0 * y + 3.0;
                cct::nearest([4.0 * x / d, 6.0 * y / d], SecondRadiation::default()).expect("near the locus").kelvin
            };
            // What half of the last digit of x and of y makes, and half of the ten kelvins of the temperature.
            let digit = (at(5e-4, 0.0) - at(0.0, 0.0)).abs() + (at(0.0, 5e-4) - at(0.0, 0.0)).abs() + 5.0;
            let found = at(0.0, 0.0);
            assert!((found - c.cct_k).abs() <= digit, "F {}: {found} K, stated {} K", c.nominal_k, c.cct_k);
        }
        assert_eq!(colours().len(), 6);
    }

    /// ANSI C78.377 has ellipses of the same colours from another source: steps in all directions agree within 1 %, what the digits of
    /// both leave open, and at 6500 K, of which two digits are printed, within 5 %. Those of 2700 K are known to differ.
    #[test]
    fn steps_are_those_of_the_ellipses_of_ansi() {
        for (nominal_k, digits) in [(3000.0, 0.01), (4000.0, 0.01), (5000.0, 0.01), (6500.0, 0.05)] {
            let iec = colours().iter().find(|c| c.nominal_k == nominal_k).expect("both have it");
            let ansi =
                tolerance::nominals().iter().find(|n| n.cct_k == nominal_k).and_then(|n| n.ellipse).expect("known");
            for p in ansi.outline(iec.centre_xy, 1.0) {
                assert!((iec.sdcm(p) - 1.0).abs() < digits, "{nominal_k} K: {}", iec.sdcm(p));
            }
        }
    }

    #[test]
    fn a_step_along_x_is_one_over_the_root_of_g11() {
        let f3500 = colours().iter().find(|c| c.nominal_k == 3500.0).expect("listed");
        let found = nearest([0.409 + 3.0 / 380_000f64.sqrt(), 0.394]).expect("a chromaticity");
        assert_eq!(found.colour, f3500);
        assert!((found.sdcm - 3.0).abs() < 1e-9, "{}", found.sdcm);
        assert!(nearest([f64::NAN, 0.3]).is_none_or(|s| s.sdcm.is_nan()));
    }
}

//! CIE daylight: the spectrum for a correlated colour temperature (CIE 15:2018, 4.1.2; Judd, MacAdam & Wyszecki 1964).

use std::sync::Arc;

use super::Error;
use crate::spectrum::integrate::Weighting;
use crate::spectrum::{Grid, Spectrum};
use crate::tables;

/// Lowest correlated colour temperature for which the daylight locus is defined, K.
pub const LOWEST_K: f64 = 4000.0;
/// Highest, K.
pub const HIGHEST_K: f64 = 25000.0;

/// Whether M₁ and M₂ are rounded to three decimals, as CIE 15 prescribes for published illuminants, or left as they are,
/// so that the spectrum is a smooth function of temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coefficients {
    /// Rounded to three decimals.
    Rounded,
    /// As calculated.
    Exact,
}

/// CIE 1931 (x, y) of daylight of a correlated colour temperature.
///
/// ```text
/// x_D = −4.6070e9/T³ + 2.9678e6/T² + 0.09911e3/T + 0.244063    4000 K ≤ T ≤ 7000 K
/// x_D = −2.0064e9/T³ + 1.9018e6/T² + 0.24748e3/T + 0.237040    7000 K < T ≤ 25000 K
/// y_D = −3.000 x_D² + 2.870 x_D − 0.275
/// ```
///
/// The temperature is on the scale with c₂ = 1.4388e-2 m·K: D65 is 6504 K, not 6500 K.
///
/// # Errors
/// [`Error::DaylightRange`] outside 4000 K … 25000 K.
pub fn chromaticity(kelvin: f64) -> Result<[f64; 2], Error> {
    if !(LOWEST_K..=HIGHEST_K).contains(&kelvin) {
        return Err(Error::DaylightRange { kelvin });
    }
    let t = 1e3 / kelvin;
    let x = if kelvin <= 7000.0 {
        ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
    } else {
        ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040
    };
    Ok([x, (-3.0 * x + 2.870) * x - 0.275])
}

/// The multipliers M₁, M₂ of S₁(λ), S₂(λ) for a chromaticity on the daylight locus (CIE 15:2018, eq. 4.7).
#[must_use]
pub fn multipliers([x, y]: [f64; 2]) -> [f64; 2] {
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    [(-1.3515 - 1.7703 * x + 5.9114 * y) / m, (0.0300 - 31.4424 * x + 30.0717 * y) / m]
}

/// S₀(λ), S₁(λ), S₂(λ), straight lines between the 5 nm entries (300–830 nm).
///
/// # Errors
/// [`Error::Table`] where the embedded table is missing a column.
pub fn components() -> Result<[Weighting; 3], Error> {
    let table = tables::get("cie-daylight-components")?;
    let column = |name: &'static str| {
        let values = table.column(name).ok_or(Error::Column { table: "cie-daylight-components", column: name })?;
        Ok::<_, Error>(Weighting::table(table.wavelengths_nm(), values))
    };
    Ok([column("S0")?, column("S1")?, column("S2")?])
}

/// Relative spectrum of CIE daylight on a grid (100 at 560 nm); zero outside 300–830 nm.
///
/// # Errors
/// [`Error::DaylightRange`] outside 4000 K … 25000 K.
pub fn spectrum(grid: impl Into<Arc<Grid>>, kelvin: f64, coefficients: Coefficients) -> Result<Spectrum, Error> {
    let grid = grid.into();
    let [mut m1, mut m2] = multipliers(chromaticity(kelvin)?);
    if coefficients == Coefficients::Rounded {
        (m1, m2) = ((m1 * 1e3).round() / 1e3, (m2 * 1e3).round() / 1e3);
    }
    let [s0, s1, s2] = components()?;
    let values = grid.wavelengths_nm().iter().map(|&w| s0.at(w) + m1 * s1.at(w) + m2 * s2.at(w)).collect();
    Ok(Spectrum::density(grid, values)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_d_illuminants_follow_from_their_temperatures() {
        // CIE 15:2018, 4.1.2: D50, D55, D65 and D75 belong to the nominal temperature times 1.4388/1.4380. Their tables have
        // three decimals from 100 on; the D65 of 1964 departs by up to 8.5e-4 from its own formula (a third-decimal slip).
        let table = tables::get("cie-illuminants").expect("embedded");
        for (name, nominal, tolerance) in
            [("D50", 5000.0, 5.1e-4), ("D55", 5500.0, 5.1e-4), ("D65", 6500.0, 9e-4), ("D75", 7500.0, 5.1e-4)]
        {
            let grid = Grid::uniform(300.0, 5.0, 97).expect("ascending");
            let s = spectrum(grid, nominal * 1.4388 / 1.4380, Coefficients::Rounded).expect("in range");
            let published = table.column(name).expect("column");
            for ((w, got), want) in s.wavelengths_nm().iter().zip(s.values()).zip(published) {
                assert!((got - want).abs() <= tolerance, "{name}, {w} nm: {got} {want}");
            }
        }
        // The nominal chromaticity of D65 is (0.3127, 0.3291) from the formula, to four digits.
        let xy = chromaticity(6500.0 * 1.4388 / 1.4380).expect("in range");
        assert!((xy[0] - 0.3127).abs() < 5e-5 && (xy[1] - 0.3291).abs() < 5e-5, "{xy:?}");
    }

    #[test]
    fn outside_its_range_daylight_is_refused() {
        for kelvin in [f64::NAN, 0.0, 3999.9, 25000.1, f64::INFINITY] {
            assert!(matches!(chromaticity(kelvin), Err(Error::DaylightRange { .. })), "{kelvin}");
        }
    }
}

//! The Planckian radiator (blackbody), from 1 K to 10⁹ K.
//!
//! Radiance is formed from its logarithm, so that no intermediate overflows; where the radiance itself is too small for a
//! double (below about 35 K in the visible) it is zero, and [`relative`] still gives the shape.

use std::sync::Arc;

use crate::constants::{FIRST_RADIATION_RADIANCE, SecondRadiation};
use crate::spectrum::{Error, Grid, Spectrum};

/// ln of the spectral radiance in W/(m²·sr·nm).
///
/// ```text
/// L_λ = c₁L λ⁻⁵ / (exp(c₂/(λT)) − 1),   c₁L = 2hc²
/// ```
///
/// `wavelength_nm` and `kelvin` positive and finite; the result is finite for all of them.
///
/// Reference: CIE 15:2018, 4.1 (the formula); Planck 1901.
#[must_use]
pub fn ln_radiance(wavelength_nm: f64, kelvin: f64, c2: SecondRadiation) -> f64 {
    let metre = wavelength_nm * 1e-9;
    let x = c2.metre_kelvin() / metre / kelvin;
    // ln(eˣ − 1) without overflow for large x and without cancellation for small.
    let ln_expm1 = if x > 30.0 { x + (-(-x).exp()).ln_1p() } else { x.exp_m1().ln() };
    (FIRST_RADIATION_RADIANCE * 1e-9).ln() - 5.0 * metre.ln() - ln_expm1
}

/// Spectral radiance in W/(m²·sr·nm); zero where it is below the smallest double.
#[must_use]
pub fn radiance(wavelength_nm: f64, kelvin: f64, c2: SecondRadiation) -> f64 {
    let metre = wavelength_nm * 1e-9;
    let x = c2.metre_kelvin() / metre / kelvin;
    if x > 500.0 {
        return ln_radiance(wavelength_nm, kelvin, c2).exp();
    }
    FIRST_RADIATION_RADIANCE * 1e-9 / (metre.powi(5) * x.exp_m1())
}

/// The spectral radiance of a blackbody on a grid, W/(m²·sr·nm).
///
/// # Errors
/// [`Error::Value`] cannot occur for temperatures up to 10³⁰⁰ K on grids of optical wavelengths.
pub fn spectrum(grid: impl Into<Arc<Grid>>, kelvin: f64, c2: SecondRadiation) -> Result<Spectrum, Error> {
    let grid = grid.into();
    let values = grid.wavelengths_nm().iter().map(|&w| radiance(w, kelvin, c2)).collect();
    Spectrum::density(grid, values)
}

/// The shape of a blackbody on a grid, its largest sample 1: also where the radiance is below the smallest double.
///
/// # Errors
/// As [`spectrum`].
pub fn relative(grid: impl Into<Arc<Grid>>, kelvin: f64, c2: SecondRadiation) -> Result<Spectrum, Error> {
    let grid = grid.into();
    let logs: Vec<f64> = grid.wavelengths_nm().iter().map(|&w| ln_radiance(w, kelvin, c2)).collect();
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Spectrum::density(grid, logs.iter().map(|l| (l - largest).exp()).collect())
}

/// Radiance over all wavelengths, W/(m²·sr): σT⁴/π with σ = π⁵·c₁L/(15·c₂⁴), the Stefan-Boltzmann constant that belongs
/// to the c₂ chosen.
#[must_use]
pub fn total_radiance(kelvin: f64, c2: SecondRadiation) -> f64 {
    let ratio = std::f64::consts::PI * kelvin / c2.metre_kelvin();
    FIRST_RADIATION_RADIANCE / 15.0 * ratio.powi(4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radiance_is_finite_and_ascends_with_temperature_from_1_k_to_1e9_k() {
        for w in [1.0, 100.0, 360.0, 555.0, 830.0, 1e5, 1e9] {
            let mut before = f64::NEG_INFINITY;
            for k in 0..=90 {
                let kelvin = 10f64.powf(f64::from(k) / 10.0);
                let ln = ln_radiance(w, kelvin, SecondRadiation::Its90);
                assert!(ln.is_finite() && ln > before, "{w} nm, {kelvin} K: {ln}");
                before = ln;
                let direct = radiance(w, kelvin, SecondRadiation::Its90);
                assert!(direct.is_finite(), "{w} nm, {kelvin} K");
                if ln > -690.0 {
                    // e^x of an exponent near 700 carries 700 ulp: 2e-13.
                    assert!((direct / ln.exp() - 1.0).abs() < 1e-12, "{w} nm, {kelvin} K: {direct} {}", ln.exp());
                }
            }
        }
    }

    #[test]
    fn wien_and_rayleigh_jeans_limits() {
        // At 1 K and 555 nm the −1 is beyond any double: ln L = ln c₁L − 5 ln λ − c₂/(λT).
        let metre = 555e-9_f64;
        let wien = (FIRST_RADIATION_RADIANCE * 1e-9).ln() - 5.0 * metre.ln() - 1.4388e-2 / metre;
        let got = ln_radiance(555.0, 1.0, SecondRadiation::Its90);
        assert!((got / wien - 1.0).abs() < 1e-15, "{got} {wien}");
        // At 10⁹ K x = 2.6e-5: L = c₁L λ⁻⁴ T/c₂ · (1 − x/2 + x²/12 − …).
        let x = 1.4388e-2 / metre / 1e9;
        let jeans = FIRST_RADIATION_RADIANCE * 1e-9 / metre.powi(5) / x * (1.0 - x / 2.0 + x * x / 12.0);
        let got = radiance(555.0, 1e9, SecondRadiation::Its90);
        assert!((got / jeans - 1.0).abs() < 1e-14, "{got} {jeans}");
    }

    #[test]
    fn the_integral_is_the_stefan_boltzmann_law() {
        // σ = 5.670 374 419e-8 W/(m²·K⁴) (CODATA 2018, exact SI).
        let sigma = std::f64::consts::PI * total_radiance(1.0, SecondRadiation::Si);
        assert!((sigma / 5.670_374_419e-8 - 1.0).abs() < 1e-10, "{sigma}");
        // The sum in ln λ over 12 decades against the closed form: the trapezoid converges geometrically there.
        let kelvin = 2856.0;
        let step = 0.01;
        let sum: f64 = (0..2800)
            .map(|i| (20.0_f64).ln() + step * f64::from(i))
            .map(|ln| radiance(ln.exp(), kelvin, SecondRadiation::Si) * ln.exp() * step)
            .sum();
        assert!((sum / total_radiance(kelvin, SecondRadiation::Si) - 1.0).abs() < 1e-9, "{sum}");
    }

    #[test]
    fn wien_displacement_brackets_the_peak() {
        // λ_max·T = 2 897.771 955 µm·K (CODATA 2018).
        for kelvin in [300.0, 2856.0, 6500.0, 1e6] {
            let peak = 2_897_771.955 / kelvin;
            let at = |f: f64| ln_radiance(peak * f, kelvin, SecondRadiation::Si);
            assert!(at(1.0) > at(0.9999) && at(1.0) > at(1.0001), "{kelvin} K");
        }
    }

    #[test]
    fn the_shape_of_1_k_is_defined() {
        let grid = Grid::uniform(360.0, 1.0, 471).expect("ascending");
        let s = relative(grid, 1.0, SecondRadiation::Its90).expect("finite");
        assert_eq!(s.values()[470], 1.0);
        // One nanometre below: Δ(c₂/λT) = c₂/T·(1/829e-9 − 1/830e-9) and the fifth power.
        let expected = (-1.4388e-2 * (1.0 / 829e-9 - 1.0 / 830e-9) + 5.0 * (830.0_f64 / 829.0).ln()).exp();
        assert!((s.values()[469] / expected - 1.0).abs() < 1e-10, "{}", s.values()[469]);
    }
}

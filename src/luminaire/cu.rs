//! Coefficients of utilisation by the zonal-cavity method.

use super::distribution::Distribution;
use super::model::Luminaire;
use super::unavailable::Unavailable;
use super::zonal::{lamp_flux_lm, zones};

/// Zonal multipliers of the direct ratio, `K = exp(−A RCRᴮ)`, for the zones 0–10° … 80–90°.
///
/// IES LM-57 (in the Lighting Handbook, 8th ed., chapter 9, "zonal multipliers"): fitted there to the share of each zone that
/// falls on the floor of rooms of all proportions, luminaires distributed evenly.
const ZONAL_MULTIPLIER: [(f64, f64); 9] = [
    (0.000, 0.00),
    (0.041, 0.98),
    (0.070, 1.05),
    (0.100, 1.12),
    (0.136, 1.16),
    (0.190, 1.25),
    (0.315, 1.25),
    (0.640, 1.25),
    (2.100, 0.80),
];

/// Effective reflectances (ceiling cavity, walls) of the 18 columns: RC 80, 70 with RW 70, 50, 30, 10; RC 50, 30, 10 with
/// RW 50, 30, 10; RC 0 with RW 0.
pub const REFLECTANCES: [(f64, f64); 18] = [
    (0.8, 0.7),
    (0.8, 0.5),
    (0.8, 0.3),
    (0.8, 0.1),
    (0.7, 0.7),
    (0.7, 0.5),
    (0.7, 0.3),
    (0.7, 0.1),
    (0.5, 0.5),
    (0.5, 0.3),
    (0.5, 0.1),
    (0.3, 0.5),
    (0.3, 0.3),
    (0.3, 0.1),
    (0.1, 0.5),
    (0.1, 0.3),
    (0.1, 0.1),
    (0.0, 0.0),
];

/// Effective reflectance of the floor cavity of the table.
pub const FLOOR_REFLECTANCE: f64 = 0.2;

/// One row of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CuRow {
    /// Room cavity ratio: `5 h (l + w)/(l w)`.
    pub rcr: u32,
    /// Coefficients in per cent, not rounded, in the order of [`REFLECTANCES`].
    pub cu_percent: [f64; 18],
}

/// A luminaire as the zonal-cavity method sees it: fluxes relative to the flux that the coefficient is relative to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZonalCavity {
    /// Relative flux in the zones 0–10° … 80–90°.
    pub down: [f64; 9],
    /// Relative flux above 90°.
    pub up: f64,
}

impl ZonalCavity {
    /// Zone fluxes of a distribution over a reference flux (rated lamp flux, or the luminaire's own).
    ///
    /// # Errors
    /// [`Unavailable::NotTypeC`]; [`Unavailable::Dark`] where the reference is not positive.
    pub fn new(distribution: &Distribution, reference_flux: f64) -> Result<Self, Unavailable> {
        if reference_flux <= 0.0 {
            return Err(Unavailable::Dark);
        }
        let zones = zones(distribution, 10.0)?;
        let down = std::array::from_fn(|i| zones[i].flux / reference_flux);
        Ok(Self { down, up: zones[9..].iter().map(|z| z.flux).sum::<f64>() / reference_flux })
    }

    /// The coefficient of utilisation, 0 to about 1.2: flux on the work plane over the reference flux.
    ///
    /// With walls 1, ceiling cavity 2, floor cavity 3, G the room cavity ratio, `D = Σ K φ` the flux that falls on the floor directly, and
    /// f the ceiling–floor form factor of a square room, `f ≈ 0.026 + 0.503 exp(−0.270 G) + 0.470 exp(−0.119 G)`:
    ///
    /// ```text
    /// C1 = (1−ρ1)(1−f²)G / (2.5ρ1(1−f²) + G f (1−ρ1)),  C2 = (1−ρ2)(1+f)/(1+ρ2 f),  C3 likewise,  C0 = C1+C2+C3
    /// CU = 2.5ρ1C1C3(φ_down − D) / (G(1−ρ1)(1−ρ3)C0) + ρ2C2C3 φ_up / ((1−ρ2)(1−ρ3)C0)
    ///    + (1 − ρ3C3(C1+C2)/((1−ρ3)C0)) D/(1−ρ3);      CU = (φ_down + ρ2 φ_up)/(1 − ρ2ρ3) at G = 0
    /// ```
    ///
    /// # Reference
    /// IES LM-57; Lighting Handbook, 8th ed., chapter 9.
    #[must_use]
    pub fn coefficient(&self, rcr: f64, ceiling: f64, walls: f64, floor: f64) -> f64 {
        let down: f64 = self.down.iter().sum();
        if rcr <= 0.0 {
            return (down + ceiling * self.up) / (1.0 - ceiling * floor);
        }
        let multipliers = ZONAL_MULTIPLIER.map(|(a, b)| (-a * rcr.powf(b)).exp());
        let direct: f64 = multipliers.iter().zip(self.down).map(|(k, flux)| k * flux).sum();
        let f = 0.026 + 0.503 * (-0.270 * rcr).exp() + 0.470 * (-0.119 * rcr).exp();
        let sides = 1.0 - f * f;
        let c1 = (1.0 - walls) * sides * rcr / (2.5 * walls * sides + rcr * f * (1.0 - walls));
        let [c2, c3] = [ceiling, floor].map(|rho| (1.0 - rho) * (1.0 + f) / (1.0 + rho * f));
        let c0 = c1 + c2 + c3;
        let by_walls = 2.5 * walls * c1 * c3 * (down - direct) / (rcr * (1.0 - walls) * (1.0 - floor) * c0);
        let by_ceiling = ceiling * c2 * c3 * self.up / ((1.0 - ceiling) * (1.0 - floor) * c0);
        let by_floor = (1.0 - floor * c3 * (c1 + c2) / ((1.0 - floor) * c0)) * direct / (1.0 - floor);
        by_walls + by_ceiling + by_floor
    }
}

/// The table of coefficients of utilisation: room cavity ratios 0 to 10, floor cavity 20 %.
///
/// Relative to the rated flux of the lamps; for absolute photometry, to the flux of the luminaire.
///
/// # Errors
/// [`Unavailable::NotTypeC`]; [`Unavailable::Dark`] where there is no flux.
pub fn cu_table(luminaire: &Luminaire) -> Result<Vec<CuRow>, Unavailable> {
    let reference = lamp_flux_lm(luminaire).unwrap_or_else(|| luminaire.distribution.total_flux());
    let cavity = ZonalCavity::new(&luminaire.distribution, reference)?;
    let row = |rcr: u32| {
        let cell = |(ceiling, walls)| 100.0 * cavity.coefficient(f64::from(rcr), ceiling, walls, FLOOR_REFLECTANCE);
        CuRow { rcr, cu_percent: REFLECTANCES.map(cell) }
    };
    Ok((0..=10).map(row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_rooms_give_the_direct_ratio_and_bright_ones_more() {
        let spot = ZonalCavity { down: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], up: 0.0 };
        // All of a narrow beam reaches the floor of any room.
        for rcr in [1.0, 5.0, 10.0] {
            assert!((spot.coefficient(rcr, 0.0, 0.0, 0.0) - 1.0).abs() < 1e-12);
            assert!(spot.coefficient(rcr, 0.8, 0.7, 0.2) > 1.0);
        }
        let uplight = ZonalCavity { down: [0.0; 9], up: 1.0 };
        assert_eq!(uplight.coefficient(3.0, 0.0, 0.5, 0.2), 0.0);
        assert!((uplight.coefficient(0.0, 0.8, 0.5, 0.2) - 0.8 / 0.84).abs() < 1e-12);
    }
}

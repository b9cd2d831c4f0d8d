//! Flux by zones, and the plain figures made of it: shares, efficacy, CIE flux code.
//!
//! All fluxes are exact integrals of the interpolated intensity (lm for cd, W for W/sr). Zones lie about the vertical axis, so
//! these figures are those of Type C tables.

use std::borrow::Cow;

use super::distribution::{Distribution, Interpolation, Symmetry, System};
use super::model::Luminaire;
use super::unavailable::Unavailable;

/// Flux in a zone of γ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zone {
    /// Lower γ, degrees.
    pub from_deg: f64,
    /// Upper γ, degrees.
    pub to_deg: f64,
    /// Flux, lm (W for radiometric tables).
    pub flux: f64,
}

/// Flux in zones of equal width from 0° to 180°; 10° and 30° are the trade's (IES LM-79, CIE 121).
///
/// # Errors
/// [`Unavailable::NotTypeC`].
///
/// # Panics
/// Where the width is not positive.
pub fn zones(distribution: &Distribution, width_deg: f64) -> Result<Vec<Zone>, Unavailable> {
    assert!(width_deg > 0.0, "zones have a width");
    let count = (180.0 / width_deg).ceil() as usize;
    let edges: Vec<f64> = (0..=count).map(|i| (width_deg * i as f64).min(180.0)).collect();
    between(distribution, &edges)
}

/// Flux between neighbouring vertical angles of the table itself.
///
/// # Errors
/// [`Unavailable::NotTypeC`].
pub fn native_zones(distribution: &Distribution) -> Result<Vec<Zone>, Unavailable> {
    between(distribution, distribution.vertical_deg())
}

fn between(distribution: &Distribution, edges_deg: &[f64]) -> Result<Vec<Zone>, Unavailable> {
    let mean = mean_table(distribution)?;
    let zone = |w: &[f64]| Zone { from_deg: w[0], to_deg: w[1], flux: mean.flux_between(w[0], w[1]) };
    Ok(edges_deg.windows(2).map(zone).collect())
}

/// A table whose zones have the fluxes of the whole: the rotationally averaged one, a single plane with the mean over C at each γ,
/// or the table itself where the cubic of the means is not the mean of the cubics.
pub(super) fn mean_table(distribution: &Distribution) -> Result<Cow<'_, Distribution>, Unavailable> {
    if distribution.system() != System::TypeC {
        return Err(Unavailable::NotTypeC);
    }
    match distribution.interpolation() {
        Interpolation::Bilinear => rotational(distribution, distribution.zonal_means()).map(Cow::Owned),
        Interpolation::MonotoneCubic => Ok(Cow::Borrowed(distribution)),
    }
}

/// One plane of given values at the vertical angles of a Type C table.
pub(super) fn rotational(like: &Distribution, values: Vec<f64>) -> Result<Distribution, Unavailable> {
    let vertical = like.vertical_deg().to_vec();
    Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vertical, values)
        .map_err(|_| Unavailable::NotTypeC)
}

/// Share of the flux below the horizontal, 0 to 1 (the *downward flux fraction*, DFF, of EULUMDAT and CIE 121).
///
/// # Errors
/// [`Unavailable::NotTypeC`]; [`Unavailable::Dark`] where the flux is not positive.
pub fn downward_flux_fraction(distribution: &Distribution) -> Result<f64, Unavailable> {
    let mean = mean_table(distribution)?;
    let total = mean.total_flux();
    if total > 0.0 { Ok(mean.flux_between(0.0, 90.0) / total) } else { Err(Unavailable::Dark) }
}

/// Rated flux of the lamps, lm: of the first set, by which the intensities are scaled and to which any other is an alternative;
/// `None` for absolute photometry or where the set has no flux.
#[must_use]
pub fn lamp_flux_lm(luminaire: &Luminaire) -> Option<f64> {
    let flux = luminaire.lamps.first().and_then(|set| set.flux_lm);
    flux.filter(|flux| *flux > 0.0 && !luminaire.absolute)
}

/// Light output ratio: luminaire flux over the rated flux of its lamps, 0 to 1; `None` for absolute photometry.
#[must_use]
pub fn light_output_ratio(luminaire: &Luminaire) -> Option<f64> {
    lamp_flux_lm(luminaire).map(|lamps| luminaire.distribution.total_flux() / lamps)
}

/// Luminous efficacy (radiant efficiency, photon efficacy): flux of the luminaire over its electrical input power, lm/W, W/W or
/// µmol/J; `None` where the power is not known.
#[must_use]
pub fn efficacy(luminaire: &Luminaire) -> Option<f64> {
    luminaire.input_power_w.filter(|w| *w > 0.0).map(|w| luminaire.distribution.total_flux() / w)
}

/// CIE flux code, per cent: N1…N4, and N5 where the lamps are rated.
///
/// With F(γ) the flux from nadir to γ: `N1 = F(41.41°)/F(90°)`, `N2 = F(60°)/F(90°)`, `N3 = F(75.52°)/F(90°)`,
/// `N4 = F(90°)/F(180°)`, `N5` the light output ratio. The angles bound ¼, ½ and ¾ of the lower hemisphere's solid angle.
///
/// # Reference
/// CIE 52:1982; EN 13032-2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CieFluxCode {
    /// N1 to N4, per cent.
    pub n1_to_n4: [f64; 4],
    /// N5, per cent; `None` for absolute photometry.
    pub n5: Option<f64>,
}

/// The CIE flux code of a luminaire.
///
/// # Errors
/// [`Unavailable::NotTypeC`]; [`Unavailable::Dark`] where nothing goes downwards.
pub fn cie_flux_code(luminaire: &Luminaire) -> Result<CieFluxCode, Unavailable> {
    let mean = mean_table(&luminaire.distribution)?;
    let down = mean.flux_between(0.0, 90.0);
    if down <= 0.0 {
        return Err(Unavailable::Dark);
    }
    let within = |cosine: f64| 100.0 * mean.flux_between(0.0, cosine.acos().to_degrees()) / down;
    let n4 = 100.0 * down / mean.total_flux();
    let n5 = light_output_ratio(luminaire).map(|r| 100.0 * r);
    Ok(CieFluxCode { n1_to_n4: [within(0.75), within(0.5), within(0.25), n4], n5 })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// I = cos γ, at 1° steps: the flux within γ is π sin²γ.
    fn lambertian() -> Distribution {
        let angles: Vec<f64> = (0..=90).map(f64::from).collect();
        let values = angles.iter().map(|g| g.to_radians().cos()).collect();
        Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], angles, values).expect("a sound table")
    }

    #[test]
    fn a_cosine_source_has_known_zones() {
        let zones = zones(&lambertian(), 30.0).expect("Type C");
        let pi = std::f64::consts::PI;
        for (zone, share) in zones.iter().zip([0.25, 0.5, 0.25, 0.0, 0.0, 0.0]) {
            // Chords lie below the cosine: 1° steps lose h²/12 of it.
            assert!((zone.flux - pi * share).abs() < 1e-4, "{zone:?}");
        }
        let native: f64 = native_zones(&lambertian()).expect("Type C").iter().map(|z| z.flux).sum();
        assert!((native - lambertian().total_flux()).abs() < 1e-12);
        assert!((downward_flux_fraction(&lambertian()).expect("Type C") - 1.0).abs() < 1e-14);
    }

    #[test]
    fn zones_are_of_type_c() {
        let d = Distribution::new(System::TypeB, Symmetry::None, vec![-90.0, 90.0], vec![-90.0, 90.0], vec![1.0; 4]);
        assert_eq!(zones(&d.expect("a sound table"), 10.0), Err(Unavailable::NotTypeC));
    }
}

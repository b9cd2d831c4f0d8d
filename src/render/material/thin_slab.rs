//! A pane without thickness: window glass, seen from afar. All reflections between its two faces are in it.
//!
//! ```text
//! R' = R + R (T a)²/(1 − (R a)²),   T' = T² a/(1 − (R a)²)        for s and p apart
//! a = τ^(1/cosθ_t),   sinθ_t = sinθ/n
//! ```
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `eta` | 1 to 1e3, per band | index of the pane, the same medium on both sides being 1 |
//! | `transmittance` | 0 to 1, per band | τ, internal transmittance along the normal; 1: nothing is absorbed |
//!
//! Without absorption T' = (1 − R)/(1 + R). Intensities are added, not amplitudes: the pane is thicker than the light is coherent.
//! Nothing is displaced: what passes goes straight on, for all bands alike, so that no path is split. Both lobes are Dirac's, and
//! polarise ([`Material::polarise`]).
//!
//! Reference: M. Born & E. Wolf, *Principles of Optics*, 7th ed., §7.6.1, with intensities; M. Pharr et al., *Physically Based
//! Rendering*, 4th ed., §9.5.1.

use glam::DVec3;

use super::{Material, Scattered, Transport};
use crate::brdf::fresnel::{Components, ETA, dielectric_components};
use crate::brdf::parameter::{Error, Parameter, same_bands};
use crate::math::sampling::split;

/// Internal transmittance along the normal.
pub const TRANSMITTANCE: Parameter =
    Parameter::spectral("transmittance", 0.0, 1.0, "internal transmittance along the normal").or(1.0);

/// A pane.
#[derive(Debug, Clone, PartialEq)]
pub struct ThinSlab {
    /// Index and internal transmittance per band.
    bands: Vec<(f64, f64)>,
}

impl ThinSlab {
    /// A pane of an index and an internal transmittance along the normal.
    ///
    /// # Errors
    /// [`Error::Range`], [`Error::Bands`].
    pub fn new(eta: &[f64], transmittance: &[f64]) -> Result<Self, Error> {
        ETA.check_all(eta)?;
        TRANSMITTANCE.check_all(transmittance)?;
        same_bands(eta.len(), &[("transmittance", transmittance.len())])?;
        Ok(Self { bands: eta.iter().copied().zip(transmittance.iter().copied()).collect() })
    }

    /// What the pane reflects and lets through, at the cosine of incidence.
    fn both((eta, transmittance): (f64, f64), cos: f64) -> [Components; 2] {
        let face = dielectric_components(cos, eta);
        let passed = face.transmitted();
        let cos_inside = (1.0 - (1.0 - cos * cos) / (eta * eta)).sqrt();
        let a = if transmittance < 1.0 { transmittance.powf(1.0 / cos_inside) } else { 1.0 };
        // For each: one face, then the sum of the passages with an odd, an even number of reflections inside. At grazing incidence
        // nothing enters, and the sum is 0/0.
        let sum = |r: f64, t: f64| {
            let t2 = t * t;
            if t2 == 0.0 {
                [r, 0.0]
            } else {
                [r + r * t2 * a * a / (1.0 - r * r * a * a), t2 * a / (1.0 - r * r * a * a)]
            }
        };
        // Where nothing is absorbed below the critical angle, amplitudes are real: the common part behaves as a power r_s r_p.
        let (s, p, re) = (sum(face.s, passed.s), sum(face.p, passed.p), sum(face.re, passed.re));
        [0, 1].map(|i| Components { s: s[i], p: p[i], re: re[i], im: 0.0 })
    }
}

impl Material for ThinSlab {
    fn evaluate(&self, _: DVec3, _: DVec3, _: Transport, values: &mut [f64]) {
        values.fill(0.0);
    }

    fn sample(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        _transport: Transport,
        hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        let cos = outgoing.z.abs();
        if cos == 0.0 {
            return None;
        }
        let [reflected, transmitted] = Self::both(self.bands[hero], cos).map(|c| c.mean());
        // As often as the hero, but never so rarely that another band's weight is large.
        let whole = reflected + transmitted;
        let share = if whole > 0.0 { (reflected / whole).clamp(0.125, 0.875) } else { 0.5 };
        let (reflects, _) = split(u[0], share);
        let (lobe, pdf) = if reflects { (0, share) } else { (1, 1.0 - share) };
        weights.iter_mut().zip(&self.bands).for_each(|(w, band)| *w = Self::both(*band, cos)[lobe].mean() / pdf);
        let direction = if reflects { DVec3::new(-outgoing.x, -outgoing.y, outgoing.z) } else { -outgoing };
        Some(Scattered { direction, pdf, delta: true, split: false, eta: 1.0 })
    }

    fn pdf(&self, _: DVec3, _: DVec3, _: usize) -> f64 {
        0.0
    }

    fn polarise(&self, outgoing: DVec3, incident: DVec3, components: &mut [Components]) -> bool {
        let lobe = usize::from(incident.z * outgoing.z < 0.0);
        components.iter_mut().zip(&self.bands).for_each(|(c, band)| *c = Self::both(*band, outgoing.z.abs())[lobe]);
        true
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn is_transmissive(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::direction::from_degrees;

    /// Reflectance and transmittance: the mean over draws.
    fn figures(slab: &ThinSlab, theta_deg: f64) -> [f64; 2] {
        [0.0, 1.0 - 1e-16].map(|u| {
            let mut weights = [0.0];
            let outgoing = from_degrees(theta_deg, 10.0);
            let drawn = slab.sample(outgoing, [u, 0.0, 0.0], Transport::Radiance, 0, &mut weights).unwrap();
            assert_eq!(drawn.direction.z * outgoing.z > 0.0, u == 0.0);
            drawn.pdf * weights[0]
        })
    }

    /// T of `../shared/render/analytic.json`, `slab_*`: the mean over s and p of (1 − R)/(1 + R).
    #[test]
    fn transmittance_of_panes() {
        for (eta, theta, expected) in [
            (1.5, 0.0, 0.923_076_923_076_923),
            (1.5168, 0.0, 0.919_082_716_668_903_1),
            (1.5, 60.0, 0.848_128_409_728_800_3),
            (1.52, 60.0, 0.843_470_671_821_488),
            (1.52, 75.0, 0.614_805_238_000_239_8),
        ] {
            let slab = ThinSlab::new(&[eta], &[1.0]).unwrap();
            for theta in [theta, 180.0 - theta] {
                let [r, t] = figures(&slab, theta);
                assert!((t - expected).abs() < 1e-14 && (r + t - 1.0).abs() < 1e-14, "{eta} {theta}: {r} {t}");
            }
        }
        // Two panes behind one another: s and p again apart; (1 − R)/(1 + 3R) for each.
        let slab = ThinSlab::new(&[1.5], &[1.0]).unwrap();
        let face = dielectric_components(0.5, 1.5);
        let mut c = [Components::default()];
        let o = from_degrees(60.0, 0.0);
        assert!(slab.polarise(o, -o, &mut c));
        assert!((c[0].s - (1.0 - face.s) / (1.0 + face.s)).abs() < 1e-15, "{c:?}");
        assert!((c[0].p - (1.0 - face.p) / (1.0 + face.p)).abs() < 1e-15, "{c:?}");
    }

    /// With absorption, the sum of the passages counted one by one.
    #[test]
    fn absorption_inside() {
        let (eta, tau, theta): (f64, f64, f64) = (1.6, 0.7, 50.0);
        let slab = ThinSlab::new(&[eta], &[tau]).unwrap();
        let (sin, cos) = theta.to_radians().sin_cos();
        let face = dielectric_components(cos, eta);
        let a = tau.powf(1.0 / (1.0 - sin * sin / eta / eta).sqrt());
        let mut expected = [face.mean(), 0.0];
        for r in [face.s, face.p] {
            let mut inside = (1.0 - r) * a;
            for face in 0..200 {
                expected[1 - face % 2] += 0.5 * inside * (1.0 - r);
                inside *= r * a;
            }
        }
        let got = figures(&slab, theta);
        assert!((got[0] - expected[0]).abs() < 1e-14 && (got[1] - expected[1]).abs() < 1e-14, "{got:?} {expected:?}");
        // Black glass reflects as one face.
        let black = figures(&ThinSlab::new(&[eta], &[0.0]).unwrap(), theta);
        assert!((black[0] - face.mean()).abs() < 1e-15 && black[1] == 0.0);
    }

    #[test]
    fn extremes_stay_finite() {
        for eta in [1.0, 1.5, 1e3] {
            for tau in [0.0, 0.5, 1.0] {
                for theta in [0.0, 89.9999, 90.0001, 180.0] {
                    let [r, t] = figures(&ThinSlab::new(&[eta], &[tau]).unwrap(), theta);
                    assert!(r >= 0.0 && t >= 0.0 && r + t <= 1.0 + 1e-12, "{eta} {tau} {theta}: {r} {t}");
                }
            }
        }
        assert!(ThinSlab::new(&[1.5], &[1.1]).is_err());
    }
}

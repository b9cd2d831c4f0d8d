//! Rough metal that loses nothing: the light that meets a second facet, which [`Microfacet`] drops, is put back as a broad lobe.
//!
//! ```text
//! f = f_single + C (1 − E(ω_i)) (1 − E(ω_o)) / (π (1 − Ē))
//! C = F̄² Ē / (1 − F̄ (1 − Ē)),   F̄ = 2 ∫ F(µ) µ dµ
//! ```
//!
//! E is the albedo of the same facets with F = 1 ([`Albedo`]). With F = 1, C is 1 and all of the light returns: the white furnace
//! holds to the table's 5e-4, where a single scattering of GGX at α = 1 keeps 31 % at normal incidence. With a coloured F the lobe is
//! more saturated than F, as every further facet colours it once more. f is reciprocal, and for F ≤ 1 returns no more than it gets.
//! The lobe's shape is a model, its amount is not.
//!
//! | parameter | meaning |
//! |---|---|
//! | the microfacets | any distribution and masking of [`microfacet`](crate::brdf::microfacet) with any [`Fresnel`](crate::brdf::fresnel::Fresnel) |
//!
//! References: C. Kulla & A. Conty, *Revisiting Physically Based Shading at Imageworks*, SIGGRAPH 2017 course; S. Hill, *A Multi-Faceted
//! Exploration*, 2018 (F̄², the first facet counted apart); C. Kelemen & L. Szirmay-Kalos, Eurographics 2001 short papers (the lobe).

use std::f64::consts::PI;

use glam::DVec3;

use super::albedo::Albedo;
use crate::brdf::microfacet::Microfacet;
use crate::brdf::parameter::Error;
use crate::brdf::reflectance::hemispherical_as_table;
use crate::brdf::{Brdf, Sampled, sample_by};
use crate::math::sampling;

/// Microfacets with all orders of scattering.
#[derive(Debug)]
pub struct Compensated {
    single: Microfacet,
    albedo: Albedo,
    /// C/(π (1 − Ē)) per band.
    scale: Vec<f64>,
}

impl Compensated {
    /// Completes microfacets; tabulates their albedo (some milliseconds, some tens of them with a grain).
    ///
    /// # Errors
    /// None for a sound [`Microfacet`].
    pub fn new(single: Microfacet) -> Result<Self, Error> {
        let white = single.with_reflectance(1.0)?;
        let albedo = Albedo::tabulate(white.roughness(), white.is_isotropic(), |outgoing, [u, v]| {
            let mut weight = [0.0];
            white.sample(outgoing, [0.0, u, v], &mut weight).map_or(0.0, |_| weight[0])
        });
        let (average, lost) = (1.0 - albedo.average_lost(), albedo.average_lost());
        let mut scale = average_reflectance(&single);
        for f in &mut scale {
            let c = *f * *f * average / (1.0 - *f * lost);
            // Facets of no roughness lose nothing.
            *f = if lost > 1e-12 { c / (PI * lost) } else { 0.0 };
        }
        Ok(Self { single, albedo, scale })
    }

    /// Writes what the compensation adds to the albedo of one scattering, per band, for light from a direction above the horizon, and
    /// what it adds to the mean over the hemisphere (light from everywhere).
    pub fn regained(&self, incident: DVec3, here: &mut [f64], mean: &mut [f64]) {
        let lost = self.albedo.average_lost();
        let share = PI * self.lost(incident) * lost;
        for ((h, m), s) in here.iter_mut().zip(mean).zip(&self.scale) {
            (*h, *m) = (s * share, s * PI * lost * lost);
        }
    }

    fn lost(&self, direction: DVec3) -> f64 {
        self.albedo.lost(direction)
    }
}

/// F̄ per band: midpoints in µ = x², which are dense where F rises.
fn average_reflectance(single: &Microfacet) -> Vec<f64> {
    const POINTS: u32 = 256;
    let (mut sum, mut values) = (vec![0.0; single.bands()], vec![0.0; single.bands()]);
    for i in 0..POINTS {
        let x = (f64::from(i) + 0.5) / f64::from(POINTS);
        // 2 µ dµ = 4 x³ dx.
        single.fresnel().write(x * x, 4.0 * x * x * x / f64::from(POINTS), &mut values);
        sum.iter_mut().zip(&values).for_each(|(s, v)| *s += v);
    }
    sum.iter_mut().for_each(|s| *s = s.min(1.0));
    sum
}

impl Brdf for Compensated {
    fn bands(&self) -> usize {
        self.single.bands()
    }

    fn is_isotropic(&self) -> bool {
        self.single.is_isotropic()
    }

    fn is_tabulated(&self) -> bool {
        true
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        self.single.evaluate(incident, outgoing, values);
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return;
        }
        let lost = self.lost(incident) * self.lost(outgoing);
        values.iter_mut().zip(&self.scale).for_each(|(v, s)| *v += s * lost);
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        if outgoing.z <= 0.0 {
            return None;
        }
        let (again, first) = sampling::split(u[0], self.lost(outgoing));
        let incident = if again {
            self.albedo.sample_lost([u[1], u[2]])
        } else {
            self.single.sample(outgoing, [first, u[1], u[2]], weights)?.incident
        };
        sample_by(self, outgoing, incident, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        if incident.z <= 0.0 || outgoing.z <= 0.0 {
            return 0.0;
        }
        let lost = self.lost(outgoing);
        (1.0 - lost) * self.single.pdf(outgoing, incident) + lost * self.albedo.lost_pdf(incident)
    }

    fn albedo(&self, incident: DVec3, reflectance: &mut [f64]) -> f64 {
        // The table of what is lost is good to 5e-4: more digits of one scattering would be lost on the sum.
        let error = hemispherical_as_table(&self.single, incident, reflectance);
        if incident.z <= 0.0 {
            return error;
        }
        let share = PI * self.lost(incident) * self.albedo.average_lost();
        reflectance.iter_mut().zip(&self.scale).for_each(|(r, s)| *r += s * share);
        error + 5e-4
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::brdf::fresnel::Fresnel;
    use crate::brdf::microfacet::{Distribution, Masking};
    use crate::geometry::direction::from_degrees;

    fn metal(distribution: Distribution, fresnel: Fresnel) -> Microfacet {
        Microfacet::new(distribution, Masking::Smith, fresnel).expect("microfacets")
    }

    fn white() -> Fresnel {
        Fresnel::constant(vec![1.0]).expect("a reflectance")
    }

    /// The white furnace, by quadratures that share nothing with the table; 1 − ln 2 of GGX at α = 1 and normal incidence is what one
    /// scattering leaves.
    #[test]
    fn white_facets_return_everything() {
        let single = metal(Distribution::Ggx([1.0; 2]), white());
        let once = 1.0 - Compensated::new(single).unwrap().albedo.lost(DVec3::Z);
        assert!((once - (1.0 - 2.0_f64.ln())).abs() < 1e-4, "{once}");
        for distribution in [
            Distribution::Ggx([1.0; 2]),
            Distribution::Ggx([0.3; 2]),
            Distribution::Ggx([0.01; 2]),
            Distribution::Ggx([1e-4; 2]),
            Distribution::Ggx([0.1, 0.8]),
            Distribution::Beckmann([0.6; 2]),
        ] {
            let whole = Compensated::new(metal(distribution, white())).unwrap();
            for (theta, phi) in [(0.0, 0.0), (40.0, 10.0), (70.0, 33.0), (85.0, 80.0), (89.5, 0.0)] {
                let mut albedo = [0.0];
                let error = whole.albedo(from_degrees(theta, phi), &mut albedo);
                assert!((albedo[0] - 1.0).abs() < error, "{distribution:?} {theta}: {} ± {error}", albedo[0]);
            }
            // What is lost in all, on a net that is dense at grazing incidence, where it may be all there is: the lobe's own integral.
            let (n, m) = (4000, 16);
            let mut sum = 0.0;
            for i in 0..n {
                let x = (f64::from(i) + 0.5) / f64::from(n);
                for j in 0..m {
                    let (sin, cos) = (FRAC_PI_2 * (f64::from(j) + 0.5) / f64::from(m)).sin_cos();
                    let r = (1.0 - x.powi(6)).sqrt();
                    // 2 µ dµ with µ = x³.
                    let weight = 6.0 * x.powi(5) / f64::from(n * m);
                    sum += weight * whole.lost(DVec3::new(r * cos, r * sin, x.powi(3)));
                }
            }
            let lost = whole.albedo.average_lost();
            assert!((sum / lost - 1.0).abs() < 1e-3, "{distribution:?}: {sum} {lost}");
        }
        // One number by an independent program: 600² and 900² midpoints over visible normals give 0.894707 and 0.894704.
        let narrow = Compensated::new(metal(Distribution::Ggx([0.01; 2]), white())).unwrap();
        assert!((1.0 - narrow.albedo.lost(from_degrees(89.5, 0.0)) - 0.8947).abs() < 1e-4);
    }

    /// F̄ of Schlick's polynomial is f0 + (1 − f0)/21.
    #[test]
    fn average_reflectance_of_schlick() {
        let f0 = 0.3;
        let single = metal(Distribution::Ggx([0.5; 2]), Fresnel::schlick(vec![f0]).unwrap());
        assert!((average_reflectance(&single)[0] - (f0 + (1.0 - f0) / 21.0)).abs() < 1e-5);
    }

    #[test]
    fn a_dark_metal_gains_no_more_than_its_facets_return() {
        let gold = Fresnel::conductor(&[0.2, 1.5], &[3.0, 1.9]).unwrap();
        let whole = Compensated::new(metal(Distribution::Ggx([0.8; 2]), gold.clone())).unwrap();
        for theta in [0.0, 60.0, 85.0] {
            let o = from_degrees(theta, 0.0);
            let (mut once, mut all) = ([0.0; 2], [0.0; 2]);
            whole.single.albedo(o, &mut once);
            whole.albedo(o, &mut all);
            for band in 0..2 {
                assert!(all[band] > once[band] && all[band] < 1.0, "{theta}: {once:?} {all:?}");
            }
        }
    }
}

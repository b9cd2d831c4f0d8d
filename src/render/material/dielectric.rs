//! A polished interface between two transparent media: glass, water, diamond.
//!
//! ```text
//! sinθ_t = sinθ / η,   η = n_beyond / n_here        Snell
//! R = (R_s + R_p)/2,   T = 1 − R                    Fresnel; R = 1 beyond the critical angle
//! L_o = R L_i(mirrored) + T (n_o/n_i)² L_i(refracted)
//! ```
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `outside` | 1 to 1e3, per band | index of the medium at z > 0 |
//! | `inside` | 1 to 1e3, per band | index of the medium at z < 0 |
//!
//! Both lobes are Dirac's. One is drawn, the reflected one with the hero's R, so that all bands go on together where they are
//! mirrored, each with its own R; where bands are refracted in different directions (dispersion) only the hero's goes on. The factor
//! n² is that of radiance, which is denser in a denser medium; a flux has none ([`Transport`]). Reflected and refracted light is
//! polarised, and under total reflection its components are delayed against each other ([`Material::polarise`]).
//!
//! The media absorb nothing. Surfaces of one body must close it, and media that touch share one surface with both indices.
//!
//! References: M. Born & E. Wolf, *Principles of Optics*, 7th ed., §1.5; E. Veach, thesis, Stanford 1997, §5.2 (n²).

use glam::DVec3;

use super::{Material, Nature, Scattered, Transport};
use crate::brdf::fresnel::{Components, dielectric, dielectric_components};
use crate::brdf::parameter::{Error, Parameter, same_bands};
use crate::math::sampling::split;

/// Index of the medium on the outside.
pub const OUTSIDE: Parameter = Parameter::spectral("outside", 1.0, 1e3, "refractive index at z > 0");
/// Index of the medium on the inside.
pub const INSIDE: Parameter = Parameter::spectral("inside", 1.0, 1e3, "refractive index at z < 0");

/// The indices on both sides of an interface, per band.
#[derive(Debug, Clone, PartialEq)]
pub struct Interface {
    /// n_inside / n_outside.
    eta: Vec<f64>,
    disperses: bool,
    /// Bands of the least and the greatest of them: one of both reflects most, or hardly less than that.
    extremes: [usize; 2],
}

impl Interface {
    /// # Errors
    /// [`Error::Range`] for an index that is not from 1 to 1e3, [`Error::Bands`] for unequal bands.
    pub fn new(outside: &[f64], inside: &[f64]) -> Result<Self, Error> {
        OUTSIDE.check_all(outside)?;
        INSIDE.check_all(inside)?;
        same_bands(outside.len(), &[("inside", inside.len())])?;
        let eta: Vec<f64> = inside.iter().zip(outside).map(|(i, o)| i / o).collect();
        #[expect(clippy::float_cmp, reason = "bands part where their directions are not the same number")]
        let disperses = eta.iter().any(|e| *e != eta[0]);
        let bands = || eta.iter().enumerate();
        let [least, greatest] = [bands().min_by(|a, b| a.1.total_cmp(b.1)), bands().max_by(|a, b| a.1.total_cmp(b.1))];
        let extremes = [least, greatest].map(|band| band.map_or(0, |(band, _)| band));
        Ok(Self { eta, disperses, extremes })
    }

    /// n_beyond / n_here of a band, as seen from a direction's side.
    #[must_use]
    pub fn relative(&self, band: usize, from: DVec3) -> f64 {
        if from.z > 0.0 { self.eta[band] } else { 1.0 / self.eta[band] }
    }

    /// The same for all bands.
    pub fn all(&self, from: DVec3) -> impl Iterator<Item = f64> + '_ {
        let above = from.z > 0.0;
        self.eta.iter().map(move |e| if above { *e } else { 1.0 / e })
    }

    /// Whether bands are refracted in different directions.
    #[must_use]
    pub fn disperses(&self) -> bool {
        self.disperses
    }
}

/// The direction beyond an interface of relative index `eta` = n_beyond / n_here, away from it, of light that leaves towards
/// `outgoing`; `None` under total reflection.
#[must_use]
pub fn refracted(outgoing: DVec3, eta: f64) -> Option<DVec3> {
    let (x, y) = (-outgoing.x / eta, -outgoing.y / eta);
    // As in Fresnel's formulas, so that both agree on what is total: cos²θ_t = (η² − 1 + cos²θ)/η².
    let cos2 = ((eta - 1.0) * (eta + 1.0) + outgoing.z * outgoing.z) / (eta * eta);
    (cos2 > 0.0).then(|| DVec3::new(x, y, if outgoing.z > 0.0 { -cos2.sqrt() } else { cos2.sqrt() }).normalize())
}

/// A polished interface.
#[derive(Debug, Clone, PartialEq)]
pub struct Dielectric {
    interface: Interface,
}

impl Dielectric {
    /// Between two media.
    ///
    /// # Errors
    /// As [`Interface::new`].
    pub fn new(outside: &[f64], inside: &[f64]) -> Result<Self, Error> {
        Ok(Self { interface: Interface::new(outside, inside)? })
    }

    /// What polarised light of a band keeps.
    fn components(&self, outgoing: DVec3, incident: DVec3, band: usize) -> Components {
        let reflected = dielectric_components(outgoing.z.abs(), self.interface.relative(band, outgoing));
        if incident.z * outgoing.z > 0.0 { reflected } else { reflected.transmitted() }
    }
}

impl Material for Dielectric {
    fn evaluate(&self, _: DVec3, _: DVec3, _: Transport, values: &mut [f64]) {
        values.fill(0.0);
    }

    fn sample(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        transport: Transport,
        hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        let cos = outgoing.z.abs();
        if cos == 0.0 {
            return None;
        }
        let reflectance = |band: usize| dielectric(cos, self.interface.relative(band, outgoing));
        let own = reflectance(hero);
        // A band of little reflectance does not stand alone for one that reflects much: no weight is far above 4.
        let share = own.max(0.25 * self.interface.extremes.map(reflectance).into_iter().fold(0.0, f64::max));
        let (reflects, _) = split(u[0], share);
        if reflects {
            if self.interface.disperses {
                let all = weights.iter_mut().zip(self.interface.all(outgoing));
                all.for_each(|(w, eta)| *w = dielectric(cos, eta) / share);
            } else {
                weights.fill(own / share);
            }
            let direction = DVec3::new(-outgoing.x, -outgoing.y, outgoing.z);
            return Some(Scattered { direction, pdf: share, delta: true, split: false, eta: 1.0 });
        }
        let eta = self.interface.relative(hero, outgoing);
        let direction = refracted(outgoing, eta)?;
        let weight = (1.0 - own) / (1.0 - share) * scaling(eta, transport);
        if self.interface.disperses {
            weights.fill(0.0);
            weights[hero] = weight;
        } else {
            weights.fill(weight);
        }
        Some(Scattered { direction, pdf: 1.0 - share, delta: true, split: self.interface.disperses, eta })
    }

    fn sample_band(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        transport: Transport,
        hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        let cos = outgoing.z.abs();
        if cos == 0.0 {
            return None;
        }
        let eta = self.interface.relative(hero, outgoing);
        let share = dielectric(cos, eta);
        let split = self.interface.disperses;
        if u[0] < share {
            weights[hero] = 1.0;
            let direction = DVec3::new(-outgoing.x, -outgoing.y, outgoing.z);
            return Some(Scattered { direction, pdf: share, delta: true, split: false, eta: 1.0 });
        }
        let direction = refracted(outgoing, eta)?;
        weights[hero] = scaling(eta, transport);
        Some(Scattered { direction, pdf: 1.0 - share, delta: true, split, eta })
    }

    fn pdf(&self, _: DVec3, _: DVec3, _: usize) -> f64 {
        0.0
    }

    fn polarise(&self, outgoing: DVec3, incident: DVec3, components: &mut [Components]) -> bool {
        if !self.interface.disperses {
            components.fill(self.components(outgoing, incident, 0));
            return true;
        }
        for (band, component) in components.iter_mut().enumerate() {
            *component = self.components(outgoing, incident, band);
        }
        true
    }

    fn polarise_band(&self, outgoing: DVec3, incident: DVec3, hero: usize, components: &mut [Components]) -> bool {
        components[hero] = self.components(outgoing, incident, hero);
        true
    }

    /// What is not reflected goes through.
    fn albedo(&self, _: DVec3, share: &mut [f64]) -> Option<f64> {
        share.fill(1.0);
        Some(0.0)
    }

    fn nature(&self) -> Nature {
        Nature { disperses: self.interface.disperses, ..Nature::default() }
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn is_transmissive(&self) -> bool {
        true
    }
}

/// (n_o/n_i)² of refracted radiance, 1 of flux; `eta` = n_i/n_o.
#[must_use]
pub fn scaling(eta: f64, transport: Transport) -> f64 {
    match transport {
        Transport::Radiance => 1.0 / (eta * eta),
        Transport::Flux => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brdf::medium::refractive_index;
    use crate::geometry::direction::from_degrees;

    fn glass() -> Dielectric {
        Dielectric::new(&[1.0, 1.0, 1.33], &[1.5, 1.6, 1.5]).expect("indices")
    }

    /// The mean of a band over the choices of lobe and hero is R + T = 1 for flux, from either side and at every angle.
    #[test]
    fn flux_is_conserved_per_band() {
        let glass = glass();
        for theta in [0.0, 30.0, 41.0, 43.0, 60.0, 89.0, 89.9999, 91.0, 130.0, 138.0, 180.0, 90.0001] {
            let outgoing = from_degrees(theta, 25.0);
            let mut total = [0.0; 3];
            for hero in 0..3 {
                let mut weights = [0.0; 3];
                let mut add = |u: f64| {
                    let drawn = glass.sample(outgoing, [u, 0.0, 0.0], Transport::Flux, hero, &mut weights)?;
                    assert!(weights.iter().all(|w| (0.0..=4.0).contains(w)), "{theta} {weights:?}");
                    assert!((drawn.direction.length() - 1.0).abs() < 1e-15);
                    for band in 0..3 {
                        // Split weights hold for the third of paths that have this hero.
                        let heroes = if drawn.split { 1.0 } else { 1.0 / 3.0 };
                        total[band] += heroes * drawn.pdf * weights[band];
                    }
                    Some(())
                };
                add(0.0).expect("something is always reflected");
                add(1.0 - 1e-16);
                // Under total reflection both numbers draw the reflected lobe.
                if glass.sample(outgoing, [1.0 - 1e-16, 0.0, 0.0], Transport::Flux, hero, &mut [0.0; 3]).unwrap().pdf
                    == 1.0
                {
                    total.iter_mut().zip(weights).for_each(|(t, w)| *t -= w / 3.0);
                }
            }
            assert!(total.iter().all(|t| (t - 1.0).abs() < 1e-13), "{theta}: {total:?}");
        }
    }

    /// Of a path of one band the lobes are drawn by that band's reflectance alone, which straight ahead is ((n − 1)/(n + 1))² (Fresnel): 0.04 for
    /// n = 1.5. Nothing is lost at either lobe, and no other band is written.
    #[test]
    fn one_band_draws_by_its_own_reflectance() {
        for (indices, disperses) in [([1.5, 1.5], false), ([1.5, 1.8], true)] {
            let glass = Dielectric::new(&[1.0, 1.0], &indices).expect("indices");
            for (u, pdf, weight) in [(0.0399, 0.04, 1.0), (0.0401, 0.96, 1.0 / 2.25)] {
                let mut weights = [7.0; 2];
                let numbers = [u, 0.0, 0.0];
                let drawn = glass.sample_band(DVec3::Z, numbers, Transport::Radiance, 0, &mut weights).expect("a lobe");
                assert!(
                    (drawn.pdf - pdf).abs() < 1e-15 && (weights[0] - weight).abs() < 1e-15,
                    "{drawn:?} {weights:?}"
                );
                assert_eq!((weights[1], drawn.split), (7.0, disperses && u > 0.04));
                assert_eq!(drawn.direction.z, if u < 0.04 { 1.0 } else { -1.0 });
            }
        }
    }

    /// Light that is sent back the same way: directions exchange, and f_s(i→o)/n_o² = f_s(o→i)/n_i², so that the radiance's weight
    /// one way is the flux' weight the other way.
    #[test]
    fn refraction_is_reversible() {
        for eta in [1.0, 1.0001, 1.5, 2.4, 1e3] {
            let glass = Dielectric::new(&[1.0], &[eta]).unwrap();
            for theta in [0.0, 20.0, 56.0, 89.0, 89.9999] {
                let outside = from_degrees(theta, 200.0);
                let mut there = [0.0];
                let through =
                    glass.sample(outside, [1.0 - 1e-16, 0.0, 0.0], Transport::Radiance, 0, &mut there).unwrap();
                assert!(through.direction.z < 0.0 && (there[0] * eta * eta - 1.0).abs() < 1e-12, "{eta} {theta}");
                let mut back = [0.0];
                let u = [1.0 - 1e-16, 0.0, 0.0];
                let returned = glass.sample(through.direction, u, Transport::Flux, 0, &mut back).unwrap();
                // Near grazing incidence the cosine outside is the difference of two numbers near 1: digits go as 1e-16 η²/cosθ.
                let allowed = 1e-15 * (1.0 + eta * eta) / outside.z.max(1e-8);
                assert!((returned.direction - outside).length() < allowed.max(1e-14), "{eta} {theta}: {returned:?}");
                // T rises from grazing incidence by 4η²/√(η² − 1 + cos²θ) per cosine at most.
                let slope = 4.0 * eta * eta / (eta * eta - 1.0 + outside.z * outside.z).sqrt();
                assert!((through.pdf - returned.pdf).abs() < slope * allowed.max(1e-14), "{eta} {theta}");
                assert!((back[0] - 1.0).abs() < 1e-12);
            }
        }
    }

    /// Minimum deviation 2 asin(n sin(A/2)) − A of a prism of 60° (`../shared/render/analytic.json`, N-BK7 at F, d, C).
    #[test]
    fn a_prism_deviates_by_its_index() {
        let (names, expected_deg) =
            ([486.1327, 587.5618, 656.2725], [39.138_108_735_657_51, 38.646_698_505_286_39, 38.429_136_703_621_445]);
        let (n, _) = refractive_index("BK7", &names).unwrap();
        let prism = Dielectric::new(&[1.0; 3], &n).unwrap();
        for (band, expected_deg) in expected_deg.into_iter().enumerate() {
            let incidence_deg = 0.5 * (expected_deg + 60.0);
            let first = from_degrees(incidence_deg, 180.0);
            let through = |outgoing: DVec3| {
                let mut weights = [0.0; 3];
                let drawn = prism.sample(outgoing, [1.0 - 1e-16, 0.0, 0.0], Transport::Radiance, band, &mut weights)?;
                assert!(drawn.split && weights.iter().enumerate().all(|(b, w)| (b == band) == (*w > 0.0)));
                Some(drawn.direction)
            };
            let inside = through(first).unwrap();
            // The second face is turned about y by the prism's angle, its inside towards the first.
            let turn = glam::DMat3::from_rotation_y(60.0_f64.to_radians() - std::f64::consts::PI);
            let turn = if (turn * -inside).z < 0.0 { turn } else { turn.transpose() };
            let left = turn.transpose() * through(turn * -inside).unwrap();
            let deviation_deg = (-first).angle_between(left).to_degrees();
            // At the minimum an error of the index of the table's last digit matters in first order: 1e-9 of it is asked for.
            assert!((deviation_deg - expected_deg).abs() < 1e-9, "{band}: {deviation_deg}");
        }
    }

    #[test]
    fn bad_indices_are_refused() {
        assert!(Dielectric::new(&[1.0], &[0.5]).is_err());
        assert!(Dielectric::new(&[1.0], &[f64::NAN]).is_err());
        assert!(Dielectric::new(&[1.0, 1.0], &[1.5]).is_err());
    }
}

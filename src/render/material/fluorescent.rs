//! A diffuse surface that shines in other wavelengths than those that it was lit by: a highlighter, white paper, a safety vest.
//!
//! ```text
//! L_o(λ_o) = (1/π) [ρ(λ_o) E(λ_o) + ∫ D(λ_o, λ_i) E(λ_i) dλ_i]
//! D(λ_o, λ_i) = Q a(λ_i) λ_i e(λ_o) / ∫ e(λ) λ dλ          one dye
//! ```
//!
//! ρ and D are the diagonal and the rest of Donaldson's bispectral matrix. Of a dye, a(λ_i) is the share of the light that it absorbs,
//! e its emission spectrum in power per nanometre, and Q the photons that leave it per photon absorbed: energy is lost in the change
//! of wavelength, photons only by Q.
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `reflectance` | 0 to 1, per band | ρ |
//! | `absorption` | 0 to 1, per band; with ρ at most 1 | a |
//! | `emission` | 0 or more, per band, relative | e; lines are given 0, as a density has none |
//! | `quantum_yield` | 0 to 1 | Q |
//!
//! Every direction alike: the matrix is applied once at a vertex ([`Material::convert`]), behind it the surface is a white diffuser.
//! A path from the sensor goes on for one band that the sensor sees, and is multiplied by the transposed matrix: what the light's bands
//! put into that one. Light does not dally (no phosphorescence), and dyes do not pass
//! light on to one another.
//!
//! References: R. Donaldson, *Spectrophotometry of Fluorescent Pigments*, Br. J. Appl. Phys. 5 (1954) 210; A. Glassner, *A Model for
//! Fluorescence and Phosphorescence*, 5th Eurographics Workshop on Rendering (1994); CIE 182:2007.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::{Material, Nature, Scattered, Transport};
use crate::brdf::fresnel::REFLECTANCE;
use crate::brdf::parameter::{Error, Parameter, at_most_one, same_bands};
use crate::math::sampling;
use crate::render::bands::{Bands, Width};

/// The share of light that a dye absorbs.
pub const ABSORPTION: Parameter =
    Parameter::spectral("absorption", 0.0, 1.0, "share of the light that the dye absorbs");
/// Photons emitted per photon absorbed.
pub const QUANTUM_YIELD: Parameter =
    Parameter::number("quantum_yield", 0.0, 1.0, "photons emitted per photon absorbed");
const EMISSION: Parameter =
    Parameter::spectral("emission", 0.0, f64::MAX, "emission spectrum of the dye, relative, in power per nm");

/// A fluorescent diffuser.
#[derive(Debug, Clone, PartialEq)]
pub struct Fluorescent {
    /// Rows are outgoing bands, columns incident ones: band values out per band value in.
    matrix: Vec<f64>,
    two_sided: bool,
}

impl Fluorescent {
    /// One dye. Where it emits in no band, nothing is seen of what it absorbs.
    ///
    /// # Errors
    /// [`Error::Range`] for values out of range or ρ + a above 1, [`Error::Bands`].
    pub fn dye(
        bands: &Bands,
        reflectance: &[f64],
        absorption: &[f64],
        emission: &[f64],
        quantum_yield: f64,
        two_sided: bool,
    ) -> Result<Self, Error> {
        let n = bands.len();
        let lengths =
            [("reflectance", reflectance.len()), ("absorption", absorption.len()), ("emission", emission.len())];
        same_bands(n, &lengths)?;
        REFLECTANCE.check_all(reflectance)?;
        ABSORPTION.check_all(absorption)?;
        EMISSION.check_all(emission)?;
        QUANTUM_YIELD.check(quantum_yield)?;
        at_most_one("reflectance + absorption", reflectance, absorption)?;
        let nm = bands.wavelengths_nm();
        // Of what stands for a stretch of a density, its width; a line is emitted by no dye.
        let width = |band: usize| match bands.widths()[band] {
            Width::Density { nm } => nm,
            Width::Line => 0.0,
        };
        let photons: f64 = (0..n).map(|o| emission[o] * width(o) * nm[o]).sum();
        let mut matrix = vec![0.0; n * n];
        for i in 0..n {
            let weight = if bands.widths()[i] == Width::Line { 1.0 } else { width(i) };
            for o in (0..n).filter(|o| photons > 0.0 && width(*o) > 0.0) {
                matrix[o * n + i] = quantum_yield * absorption[i] * nm[i] * weight * (emission[o] / photons);
            }
            matrix[i * n + i] += reflectance[i];
        }
        Ok(Self { matrix, two_sided })
    }

    fn shines(&self, incident: DVec3, outgoing: DVec3) -> bool {
        (outgoing.z > 0.0 || self.two_sided) && incident.z * outgoing.z > 0.0
    }
}

impl Material for Fluorescent {
    fn evaluate(&self, incident: DVec3, outgoing: DVec3, _transport: Transport, values: &mut [f64]) {
        values.fill(if self.shines(incident, outgoing) { 1.0 / PI } else { 0.0 });
    }

    fn sample(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        _transport: Transport,
        _hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        let up = sampling::cosine_hemisphere([u[1], u[2]]);
        let direction = DVec3::new(up.x, up.y, up.z.copysign(outgoing.z));
        if !self.shines(direction, outgoing) {
            return None;
        }
        weights.fill(1.0);
        let pdf = sampling::cosine_hemisphere_pdf(up.z);
        Some(Scattered { direction, pdf, delta: false, split: false, eta: 1.0 })
    }

    fn nature(&self) -> Nature {
        Nature { fluoresces: true, ..Nature::default() }
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3, _hero: usize) -> f64 {
        if self.shines(incident, outgoing) { sampling::cosine_hemisphere_pdf(incident.z.abs()) } else { 0.0 }
    }

    fn convert(&self, _uv: DVec2, transport: Transport, throughput: &mut [f64], scratch: &mut [f64]) -> bool {
        let n = throughput.len();
        scratch.fill(0.0);
        for (o, row) in self.matrix.chunks_exact(n).enumerate() {
            match transport {
                Transport::Radiance => scratch.iter_mut().zip(row).for_each(|(s, d)| *s += throughput[o] * d),
                Transport::Flux => scratch[o] = row.iter().zip(throughput.iter()).map(|(d, t)| d * t).sum(),
            }
        }
        throughput.copy_from_slice(scratch);
        true
    }

    fn converts(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vest() -> (Bands, Fluorescent) {
        let bands = Bands::uniform(400.0, 10.0).and_lines(&[436.0]);
        let of = |f: &dyn Fn(f64) -> f64| bands.wavelengths_nm().iter().map(|nm| f(*nm)).collect::<Vec<f64>>();
        let reflectance = of(&|nm| if nm < 500.0 { 0.05 } else { 0.8 });
        let absorption = of(&|nm| if nm < 500.0 { 0.9 } else { 0.0 });
        let emission = of(&|nm| (-((nm - 540.0) / 20.0_f64).powi(2)).exp());
        let vest = Fluorescent::dye(&bands, &reflectance, &absorption, &emission, 0.75, false).unwrap();
        (bands, vest)
    }

    /// Photons out per photon in: ρ + Q a, whatever the wavelength, lines included; energy is less.
    #[test]
    fn photons_are_counted_energy_is_lost() {
        let (bands, vest) = vest();
        let (n, nm) = (bands.len(), bands.wavelengths_nm());
        let width = |b: usize| if b + 1 == n { 1.0 } else { 10.0 };
        for lit in [0, 5, n - 1] {
            let (mut flux, mut scratch) = (vec![0.0; n], vec![0.0; n]);
            flux[lit] = 2.0;
            assert!(vest.convert(DVec2::ZERO, Transport::Flux, &mut flux, &mut scratch));
            let photons: f64 = (0..n).map(|b| flux[b] * width(b) * nm[b]).sum();
            let expected = (0.05 + 0.75 * 0.9) * 2.0 * width(lit) * nm[lit];
            assert!((photons / expected - 1.0).abs() < 1e-14, "{lit}: {photons} {expected}");
            let power: f64 = (0..n).map(|b| flux[b] * width(b)).sum();
            assert!(power < (0.05 + 0.75 * 0.9) * 2.0 * width(lit));
            // A line lights the dye, which answers with a density.
            assert!(flux[14] > 0.0 && (flux[n - 1] > 0.0) == (lit == n - 1));
        }
    }

    /// Paths from the sensor and from the light carry the same: t·(D x) = (Dᵀ t)·x.
    #[test]
    fn both_transports_are_transposed() {
        let (bands, vest) = vest();
        let n = bands.len();
        let x: Vec<f64> = (0..n).map(|b| 1.0 + (b as f64).sin()).collect();
        let t: Vec<f64> = (0..n).map(|b| 1.0 + (b as f64).cos()).collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (mut dx, mut dt, mut scratch) = (x.clone(), t.clone(), vec![0.0; n]);
        vest.convert(DVec2::ZERO, Transport::Flux, &mut dx, &mut scratch);
        vest.convert(DVec2::ZERO, Transport::Radiance, &mut dt, &mut scratch);
        assert!((dot(&t, &dx) / dot(&dt, &x) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn more_light_than_there_is_is_refused() {
        let bands = Bands::uniform(400.0, 100.0);
        let n = bands.len();
        let dye = |rho: f64, a: f64, e: f64, q: f64| {
            Fluorescent::dye(&bands, &vec![rho; n], &vec![a; n], &vec![e; n], q, false)
        };
        assert!(dye(0.5, 0.5, 1.0, 1.0).is_ok());
        assert!(dye(0.5, 0.6, 1.0, 1.0).is_err() && dye(0.5, 0.5, 1.0, 1.1).is_err());
    }
}

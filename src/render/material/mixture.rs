//! A mixture of materials, each with its share of the surface: a mesh before glass, dust on a mirror.
//!
//! ```text
//! f = Σ_j w_j f_j        w_j ≥ 0, Σ_j w_j ≤ 1 per band
//! ```
//!
//! One part is drawn, in proportion to the mean of its weights. Where shares add up to less than 1 the rest is black.
//!
//! A part whose scattering starts with a conversion of its own ([`Material::convert`]: textures, fluorescence) cannot be mixed; mix
//! first, and put the texture on the mixture. A Dirac lobe of a mixture keeps its polarisation if only one part has Dirac lobes.

use std::sync::Arc;

use glam::DVec3;

use super::{Material, Nature, Scattered, Transport};
use crate::brdf::fresnel::Components;
use crate::brdf::parameter::{Error, Parameter, same_bands};
use crate::math::sampling::split;

/// The share of a part.
pub const WEIGHT: Parameter = Parameter::spectral("weight", 0.0, 1.0, "share of the surface");

/// The bands that a mixture can carry without allocating; more are taken from the heap.
const FEW: usize = 64;

/// A mixture.
#[derive(Debug)]
pub struct Mixture {
    parts: Vec<Part>,
    bands: usize,
}

#[derive(Debug)]
struct Part {
    weights: Vec<f64>,
    material: Arc<dyn Material>,
    probability: f64,
}

impl Mixture {
    /// Materials with their shares per band.
    ///
    /// # Errors
    /// [`Error::Missing`] without parts, [`Error::Range`] for a share that is not from 0 to 1, for shares that sum to more than 1, and
    /// for a part that converts; [`Error::Bands`].
    pub fn new(parts: Vec<(Vec<f64>, Arc<dyn Material>)>) -> Result<Self, Error> {
        let Some((first, _)) = parts.first() else {
            return Err(Error::Missing { name: "mixture", expected: "at least one material".to_owned() });
        };
        let bands = first.len();
        let mut sums = vec![0.0; bands];
        for (weights, material) in &parts {
            same_bands(bands, &[("weight", weights.len())])?;
            WEIGHT.check_all(weights)?;
            if material.converts() {
                return Err(Error::Missing {
                    name: "mixture",
                    expected: "parts without textures or fluorescence, which go on the whole mixture".to_owned(),
                });
            }
            sums.iter_mut().zip(weights).for_each(|(s, w)| *s += w);
        }
        if let Some(sum) = sums.iter().find(|s| **s > 1.0 + 8.0 * f64::EPSILON) {
            return Err(Error::Range { name: "weight", value: *sum, expected: "shares that sum to at most 1".into() });
        }
        let mean = |weights: &[f64]| weights.iter().sum::<f64>() / bands as f64;
        let total: f64 = parts.iter().map(|(w, _)| mean(w)).sum();
        let equal = 1.0 / parts.len() as f64;
        let parts = parts.into_iter().map(|(weights, material)| {
            let probability = if total > 0.0 { mean(&weights) / total } else { equal };
            Part { weights, material, probability }
        });
        Ok(Self { parts: parts.collect(), bands })
    }

    /// f without Dirac lobes, the sum over the parts.
    fn sum(&self, values: &mut [f64], mut write: impl FnMut(&dyn Material, &mut [f64])) {
        let (mut few, mut many) = ([0.0; FEW], Vec::new());
        let scratch = if self.bands <= FEW {
            &mut few[..self.bands]
        } else {
            many.resize(self.bands, 0.0);
            &mut many[..]
        };
        values.fill(0.0);
        for part in &self.parts {
            write(part.material.as_ref(), scratch);
            values.iter_mut().zip(scratch.iter()).zip(&part.weights).for_each(|((v, s), w)| *v += w * s);
        }
    }
}

impl Material for Mixture {
    fn evaluate(&self, incident: DVec3, outgoing: DVec3, transport: Transport, values: &mut [f64]) {
        self.sum(values, |material, v| material.evaluate(incident, outgoing, transport, v));
    }

    fn sample(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        transport: Transport,
        hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        let (mut first, mut left) = (u[0], 1.0);
        let mut chosen = self.parts.last()?;
        for part in &self.parts {
            let (here, stretched) = split(first, (part.probability / left).min(1.0));
            first = stretched;
            if here {
                chosen = part;
                break;
            }
            left -= part.probability;
        }
        let drawn = chosen.material.sample(outgoing, [first, u[1], u[2]], transport, hero, weights)?;
        if drawn.delta {
            weights.iter_mut().zip(&chosen.weights).for_each(|(v, w)| *v *= w / chosen.probability);
            return Some(Scattered { pdf: drawn.pdf * chosen.probability, ..drawn });
        }
        let pdf = self.pdf(outgoing, drawn.direction, hero);
        if !(pdf > 0.0 && pdf.is_finite()) {
            return None;
        }
        self.evaluate(drawn.direction, outgoing, transport, weights);
        let splits = self.splits();
        for (band, weight) in weights.iter_mut().enumerate() {
            *weight = if splits && band != hero { 0.0 } else { *weight * drawn.direction.z.abs() / pdf };
        }
        Some(Scattered { pdf, split: splits, ..drawn })
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3, hero: usize) -> f64 {
        self.parts.iter().map(|p| p.probability * p.material.pdf(outgoing, incident, hero)).sum()
    }

    fn nature(&self) -> Nature {
        self.parts.iter().fold(Nature::default(), |all, part| all.and(part.material.nature()))
    }

    fn albedo(&self, arriving: DVec3, share: &mut [f64]) -> Option<f64> {
        let mut bound = Some(0.0);
        self.sum(share, |material, values| {
            bound = bound.and_then(|b: f64| Some(b + material.albedo(arriving, values)?));
        });
        bound
    }

    fn polarise(&self, outgoing: DVec3, incident: DVec3, components: &mut [Components]) -> bool {
        let mut known = self.parts.iter().filter(|p| p.material.has_delta());
        match (known.next(), known.next()) {
            (Some(one), None) => one.material.polarise(outgoing, incident, components),
            _ => false,
        }
    }

    fn splits(&self) -> bool {
        self.parts.iter().any(|p| p.material.splits())
    }

    fn has_delta(&self) -> bool {
        self.parts.iter().any(|p| p.material.has_delta())
    }

    fn is_delta(&self) -> bool {
        self.parts.iter().all(|p| p.material.is_delta())
    }

    fn is_transmissive(&self) -> bool {
        self.parts.iter().any(|p| p.material.is_transmissive())
    }
}

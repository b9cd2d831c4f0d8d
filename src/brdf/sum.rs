//! Sums and mixtures: reflection is linear, so the sum of BRDFs is one.
//!
//! ```text
//! f = Σ w_j f_j        w_j ≥ 0, per band
//! ```
//!
//! Written `lambert(reflectance=0.2) + 0.5*ggx(alpha=0.1, eta=1.5)`. Weights that sum to at most 1 keep the albedo of a mixture
//! below 1; a sum in layers (a coat over paint) does not know that the coat takes light from the paint, and may pass it.

use glam::DVec3;

use super::microfacet::Microfacet;
use super::parameter::{Error, same_bands};
use super::{Brdf, Sampled, mean};
use crate::math::sampling::split;

/// A weighted sum of materials.
#[derive(Debug)]
pub struct Sum {
    parts: Vec<Part>,
    bands: usize,
}

#[derive(Debug)]
struct Part {
    weights: Vec<f64>,
    brdf: Box<dyn Brdf>,
    /// With which this part is drawn.
    probability: f64,
}

/// The bands that a sum can carry without allocating; more are taken from the heap.
const FEW: usize = 64;

impl Sum {
    /// The sum of materials, each with its weight per band.
    ///
    /// # Errors
    /// [`Error::Missing`] without parts, [`Error::Bands`] for unequal bands, [`Error::Range`] for a negative weight.
    pub fn new(parts: Vec<(Vec<f64>, Box<dyn Brdf>)>) -> Result<Self, Error> {
        let Some((first, _)) = parts.first() else {
            return Err(Error::Missing { name: "sum", expected: "at least one material".to_owned() });
        };
        let bands = first.len();
        for (weights, brdf) in &parts {
            same_bands(bands, &[("weight", weights.len()), ("sum", brdf.bands())])?;
            if let Some(value) = weights.iter().find(|w| !(w.is_finite() && **w >= 0.0)) {
                return Err(Error::Range {
                    name: "weight",
                    value: *value,
                    expected: "a number or spectrum from 0 up".into(),
                });
            }
        }
        let total: f64 = parts.iter().map(|(w, _)| mean(w)).sum();
        let count = parts.len() as f64;
        let parts = parts.into_iter().map(|(weights, brdf)| {
            let probability = if total > 0.0 { mean(&weights) / total } else { 1.0 / count };
            Part { weights, brdf, probability }
        });
        Ok(Self { parts: parts.collect(), bands })
    }

    /// Adds up what `f` writes for each part, weighted.
    fn add(&self, values: &mut [f64], mut f: impl FnMut(&dyn Brdf, &mut [f64])) {
        let mut few = [0.0; FEW];
        let mut many = Vec::new();
        let scratch = if self.bands <= FEW {
            &mut few[..self.bands]
        } else {
            many.resize(self.bands, 0.0);
            &mut many[..]
        };
        values.fill(0.0);
        for part in &self.parts {
            f(part.brdf.as_ref(), scratch);
            values.iter_mut().zip(scratch.iter()).zip(&part.weights).for_each(|((v, s), w)| *v += w * s);
        }
    }
}

impl Brdf for Sum {
    fn bands(&self) -> usize {
        self.bands
    }

    fn is_isotropic(&self) -> bool {
        self.parts.iter().all(|p| p.brdf.is_isotropic())
    }

    fn has_delta(&self) -> bool {
        self.parts.iter().any(|p| p.brdf.has_delta())
    }

    fn is_delta(&self) -> bool {
        self.parts.iter().all(|p| p.brdf.is_delta())
    }

    fn is_tabulated(&self) -> bool {
        self.parts.iter().any(|p| p.brdf.is_tabulated())
    }

    fn microfacets(&self) -> Vec<(Vec<f64>, &Microfacet)> {
        let of = |part: &'_ Part, weights: Vec<f64>| weights.iter().zip(&part.weights).map(|(a, b)| a * b).collect();
        let parts = self.parts.iter().flat_map(|p| p.brdf.microfacets().into_iter().map(move |(w, m)| (of(p, w), m)));
        parts.collect()
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        self.add(values, |brdf, v| brdf.evaluate(incident, outgoing, v));
    }

    fn specular(&self, incident: DVec3, reflectance: &mut [f64]) {
        self.add(reflectance, |brdf, v| brdf.specular(incident, v));
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
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
        let drawn = chosen.brdf.sample(outgoing, [first, u[1], u[2]], weights)?;
        if drawn.delta {
            weights.iter_mut().zip(&chosen.weights).for_each(|(v, w)| *v *= w / chosen.probability);
            return Some(Sampled { pdf: drawn.pdf * chosen.probability, ..drawn });
        }
        super::sample_by(self, outgoing, drawn.incident, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        self.parts.iter().map(|p| p.probability * p.brdf.pdf(outgoing, incident)).sum()
    }

    fn albedo(&self, incident: DVec3, reflectance: &mut [f64]) -> f64 {
        let (mut error, mut parts) = (0.0, self.parts.iter());
        self.add(reflectance, |brdf, v| {
            let largest = parts.next().map_or(0.0, |p| p.weights.iter().copied().fold(0.0, f64::max));
            error += largest * brdf.albedo(incident, v);
        });
        error
    }

    fn is_measured(&self, incident: DVec3, outgoing: DVec3) -> bool {
        self.parts.iter().all(|p| p.brdf.is_measured(incident, outgoing))
    }
}

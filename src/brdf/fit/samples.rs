//! What a model is fitted to: the measured places of a table, prepared once.

use glam::DVec3;

use super::Error;
use crate::brdf::table::{Channel, Table};
use crate::math::random::Stream;

/// How much each place counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Weighting {
    /// By the part of both hemispheres that it stands for ([`crate::brdf::table::Entry::measure`]): a sum over places is then an integral
    /// over directions, whatever the layout of the table. Scattered points count alike.
    #[default]
    SolidAngle,
    /// All alike.
    Equal,
}

/// Which places and bands of a table take part.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// Largest angle to the normal of either direction, degrees.
    pub max_theta_deg: f64,
    /// Bands, from 0; all of them where none are named.
    pub bands: Option<Vec<usize>>,
    /// How much each place counts.
    pub weighting: Weighting,
}

impl Default for Selection {
    fn default() -> Self {
        Self { max_theta_deg: 90.0, bands: None, weighting: Weighting::SolidAngle }
    }
}

/// Measured places: directions, weights with a mean of 1, cosines, values.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    pub(super) channels: Vec<Channel>,
    pub(super) directions: Vec<(DVec3, DVec3)>,
    /// The factor of the value in the cosine-weighted measures.
    pub(super) cosines: Vec<f64>,
    pub(super) weights: Vec<f64>,
    /// In 1/sr, the bands of a place side by side.
    pub(super) values: Vec<f64>,
    /// By how much each value would be off if what all of them rest on were off by one standard uncertainty; none where that is not stated.
    pub(super) common: Vec<f64>,
    places: usize,
}

impl Samples {
    /// The measured places of a table.
    ///
    /// The cosine is cosθ_i. In tables over half and difference angles every bin stands for both orders of its directions: there it is
    /// the root of (cos²θ_i + cos²θ_o)/2, which gives what a sum over both orders would.
    ///
    /// # Errors
    /// [`Error::Band`] for a band that is not there, [`Error::NoPlaces`] where no place takes part.
    pub fn new(table: &Table, selection: &Selection) -> Result<Self, Error> {
        let all = table.channels();
        let bands: Vec<usize> = selection.bands.clone().unwrap_or_else(|| (0..all.len()).collect());
        if let Some(&band) = bands.iter().find(|b| **b >= all.len()) {
            return Err(Error::Band { band: band + 1, bands: all.len() });
        }
        let mut out = Self {
            channels: bands.iter().map(|b| all[*b].clone()).collect(),
            directions: Vec::new(),
            cosines: Vec::new(),
            weights: Vec::new(),
            values: Vec::new(),
            common: Vec::new(),
            places: table.coverage().0,
        };
        let both = matches!(table, Table::HalfAngle(_));
        let least = if selection.max_theta_deg >= 90.0 { 0.0 } else { selection.max_theta_deg.to_radians().cos() };
        table.entries(&mut |entry| {
            let (i, o) = (entry.incident.z, entry.outgoing.z);
            if i < least || o < least {
                return;
            }
            out.directions.push((entry.incident, entry.outgoing));
            out.cosines.push(if both { (0.5 * (i * i + o * o)).sqrt() } else { i });
            out.weights.push(if selection.weighting == Weighting::Equal { 1.0 } else { entry.measure });
            out.values.extend(bands.iter().map(|b| entry.values[*b]));
        });
        if out.directions.is_empty() || out.weights.iter().sum::<f64>() <= 0.0 {
            return Err(Error::NoPlaces { places: out.places, max_theta_deg: selection.max_theta_deg });
        }
        out.normalise();
        Ok(out)
    }

    /// Scattered measurements: pairs of directions above the horizon, ω_i first, and the values of each in 1/sr, the bands side by side.
    ///
    /// With standard errors of the values the weight of a place is the mean over its bands of 1/(c σ)², c = cosθ_i: the cosine-weighted
    /// measure is then a sum of squares in units of σ. Without, all count alike.
    ///
    /// # Errors
    /// [`Error::NoPlaces`] for none, or where there are not as many values and errors as places times bands.
    pub fn scattered(
        channels: Vec<Channel>,
        directions: Vec<(DVec3, DVec3)>,
        values: Vec<f64>,
        errors: Option<&[f64]>,
    ) -> Result<Self, Error> {
        let (places, bands) = (directions.len(), channels.len());
        if places == 0
            || bands == 0
            || [Some(values.len()), errors.map(<[f64]>::len)].iter().flatten().any(|n| *n != places * bands)
        {
            return Err(Error::NoPlaces { places, max_theta_deg: 90.0 });
        }
        let cosines: Vec<f64> = directions.iter().map(|(i, _)| i.z).collect();
        let weights = match errors {
            None => vec![1.0; places],
            Some(errors) => {
                let of = |(errors, cos): (&[f64], &f64)| {
                    errors.iter().map(|e| (cos * e).powi(-2)).sum::<f64>() / bands as f64
                };
                errors.chunks_exact(bands).zip(&cosines).map(of).collect()
            }
        };
        let mut out = Self { channels, directions, cosines, weights, values, common: Vec::new(), places };
        out.normalise();
        Ok(out)
    }

    /// The same with an error that all values have in common: by how much each of them, in 1/sr and in the order of the values, would be off if one
    /// quantity that they rest on were off by its standard uncertainty. It does not move a fit; its standard errors have it in them.
    ///
    /// # Errors
    /// [`Error::NoPlaces`] where there are not as many as values.
    pub fn with_common(mut self, common: Vec<f64>) -> Result<Self, Error> {
        if common.len() != self.values.len() {
            return Err(Error::NoPlaces { places: self.places, max_theta_deg: 90.0 });
        }
        self.common = common;
        Ok(self)
    }

    fn normalise(&mut self) {
        let mean = self.weights.iter().sum::<f64>() / self.weights.len() as f64;
        self.weights.iter_mut().for_each(|w| *w /= mean);
    }

    /// What the values of a place belong to.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Number of places that take part.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub fn len(&self) -> usize {
        self.directions.len()
    }

    /// Number of places of the table, missing ones included.
    #[must_use]
    pub fn places(&self) -> usize {
        self.places
    }

    /// The places: ω_i, ω_o, values.
    pub fn iter(&self) -> impl Iterator<Item = (DVec3, DVec3, &[f64])> {
        let values = self.values.chunks_exact(self.channels.len());
        self.directions.iter().zip(values).map(|(&(i, o), v)| (i, o, v))
    }

    /// Number of negative values, which noise makes: they stay in all measures but the logarithmic one, where they count as 0.
    #[must_use]
    pub fn negative(&self) -> usize {
        self.values.iter().filter(|v| **v < 0.0).count()
    }

    /// About `count` of the places, one drawn from each of as many equal stretches of the table's order; all where there are no more.
    #[must_use]
    pub fn subset(&self, count: usize) -> Option<Self> {
        let (n, bands) = (self.len(), self.channels.len());
        if count == 0 || count >= n {
            return None;
        }
        let mut random = Stream::new(SEED, n as u64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the places")]
        let chosen: Vec<usize> = (0..count)
            .map(|i| (((i as f64 + random.uniform()) / count as f64 * n as f64) as usize).min(n - 1))
            .collect();
        let of = |all: &[f64]| -> Vec<f64> {
            if all.is_empty() {
                return Vec::new();
            }
            chosen.iter().flat_map(|i| &all[i * bands..][..bands]).copied().collect()
        };
        let mut out = Self {
            channels: self.channels.clone(),
            directions: chosen.iter().map(|i| self.directions[*i]).collect(),
            cosines: chosen.iter().map(|i| self.cosines[*i]).collect(),
            weights: chosen.iter().map(|i| self.weights[*i]).collect(),
            values: of(&self.values),
            common: of(&self.common),
            places: self.places,
        };
        out.normalise();
        Some(out)
    }
}

/// Of the draw of a subset: the same table gives the same subset.
const SEED: u64 = 2005;

//! A converted image beside the one it comes from: RGB channels next to spectral ones, read once.

use super::description::{Description, Meaning};
use super::error::Error;
use super::plan::Plan;
use super::source::{self, Region, Source};
use crate::finding::Finding;

/// A source with the channels of another, and those that a [`Plan`] makes of it behind them. Channels of the other that mean
/// or are called the same give way.
pub struct Beside<S> {
    source: S,
    plan: Plan,
    description: Description,
    /// Channels of the source that stay.
    kept: Vec<usize>,
    samples: Vec<f32>,
    sums: Vec<f32>,
}

impl<S: Source> Beside<S> {
    /// The image `source`, for which `plan` was made, with the outputs of the plan.
    pub fn new(source: S, plan: Plan) -> Self {
        let made = &plan.description;
        let replaced = |m: Meaning, name: &str| made.channels.iter().any(|c| c.meaning == m || c.name == name);
        let mut description = source.description().clone();
        let kept: Vec<usize> = (0..description.channels.len())
            .filter(|i| !replaced(description.channels[*i].meaning, &description.channels[*i].name))
            .collect();
        description.channels = kept.iter().map(|i| description.channels[*i].clone()).collect();
        description.channels.extend(made.channels.iter().cloned());
        description.rgb = made.rgb.clone().or(description.rgb);
        for (name, value) in made.attributes.iter().filter(|(name, _)| name.starts_with("photopic:")) {
            description.set_attribute(name, value.clone());
        }
        Self { source, plan, description, kept, samples: Vec::new(), sums: Vec::new() }
    }
}

impl<S: Source> Source for Beside<S> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn block(&self) -> (usize, usize) {
        self.source.block()
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        let width = region.width;
        let (own, needed) = (self.kept.len(), self.plan.channels.len());
        // Own channels asked for, and behind them those that the plan needs; one that serves both is read twice from a block
        // that is decoded once.
        let mut wanted: Vec<usize> = channels.iter().filter(|c| **c < own).map(|c| self.kept[*c]).collect();
        let copied = wanted.len();
        if copied < channels.len() {
            wanted.extend(&self.plan.channels);
        }
        self.samples.resize(region.pixels() * wanted.len(), 0.0);
        self.source.read(region, &wanted, &mut self.samples)?;
        self.sums.resize(self.plan.weights.outputs() * width, 0.0);
        for y in 0..region.height {
            let row = &self.samples[y * wanted.len() * width..(y + 1) * wanted.len() * width];
            if copied < channels.len() {
                self.plan.row(&row[copied * width..(copied + needed) * width], width, &mut self.sums);
            }
            let mut next = 0;
            for (k, channel) in channels.iter().enumerate() {
                let from = if *channel < own {
                    next += 1;
                    &row[(next - 1) * width..next * width]
                } else {
                    &self.sums[(channel - own) * width..(channel - own + 1) * width]
                };
                let start = (y * channels.len() + k) * width;
                out[start..start + width].copy_from_slice(from);
            }
        }
        Ok(())
    }

    fn findings(&self) -> Vec<Finding> {
        self.source.findings()
    }
}

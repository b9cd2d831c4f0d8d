//! An image converted as it is read.

use rayon::prelude::*;

use super::description::Description;
use super::error::Error;
use super::plan::Plan;
use super::source::{self, Region, SAMPLES_AT_ONCE, Source, pieces};
use crate::finding::Finding;

/// A source whose pixels are those of another, converted by a [`Plan`].
pub struct Converted<S> {
    source: S,
    plan: Plan,
    /// Samples of one piece of the source; kept between reads.
    samples: Vec<f32>,
    /// Its outputs.
    sums: Vec<f32>,
}

impl<S: Source> Converted<S> {
    /// The image `source`, for which `plan` was made, converted.
    pub fn new(source: S, plan: Plan) -> Self {
        Self { source, plan, samples: Vec::new(), sums: Vec::new() }
    }
}

impl<S: Source> Source for Converted<S> {
    fn description(&self) -> &Description {
        &self.plan.description
    }

    fn block(&self) -> (usize, usize) {
        self.source.block()
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.plan.description, region, channels, out);
        let (inputs, outputs) = (self.plan.channels.len(), self.plan.weights.outputs());
        for piece in pieces(region, self.source.block(), SAMPLES_AT_ONCE / inputs.max(1)) {
            self.samples.resize(piece.pixels() * inputs, 0.0);
            self.source.read(piece, &self.plan.channels, &mut self.samples)?;
            self.sums.resize(piece.pixels() * outputs, 0.0);
            let (plan, width) = (&self.plan, piece.width);
            let rows =
                self.samples.par_chunks_exact(inputs * width).zip(self.sums.par_chunks_exact_mut(outputs * width));
            rows.for_each(|(row, sums)| plan.row(row, width, sums));
            for (y, sums) in self.sums.chunks_exact(outputs * width).enumerate() {
                for (k, channel) in channels.iter().enumerate() {
                    let start = ((piece.y - region.y + y) * channels.len() + k) * region.width + piece.x - region.x;
                    out[start..start + width].copy_from_slice(&sums[channel * width..(channel + 1) * width]);
                }
            }
        }
        Ok(())
    }

    fn findings(&self) -> Vec<Finding> {
        self.source.findings()
    }
}

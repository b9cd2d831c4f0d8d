//! Tables, one after another, as columns over the bins that all of them measured.

use glam::DVec3;

use super::mapping::LEAST_WEIGHT;
use super::{Error, Training};
use crate::brdf::table::{HalfAngle, Resolution};

/// Both cosines of a bin's centre are above this: below, a bin is cut by the horizon.
const LEAST_COSINE: f64 = 0.02;

/// The bins of a resolution that take part.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    resolution: Resolution,
    bins: Vec<usize>,
}

impl Grid {
    /// The bins whose centres have both directions above the horizon (cosines above 0.02).
    #[must_use]
    pub fn new(resolution: Resolution) -> Self {
        let above = |bin: &usize| {
            let (i, o) = resolution.centre(*bin).directions();
            i.z > LEAST_COSINE && o.z > LEAST_COSINE
        };
        Self { resolution, bins: (0..resolution.bins()).filter(above).collect() }
    }

    /// The bins by their index in a table.
    #[must_use]
    pub fn bins(&self) -> &[usize] {
        &self.bins
    }

    /// The directions ω_i, ω_o in the middle of a bin, counted among those that take part.
    #[must_use]
    pub fn directions(&self, bin: usize) -> (DVec3, DVec3) {
        self.resolution.centre(self.bins[bin]).directions()
    }

    #[expect(clippy::cast_possible_truncation, reason = "weights are kept in single precision")]
    fn weights(&self) -> Vec<f32> {
        let weight = |bin| {
            let (i, o) = self.directions(bin);
            (i.z * o.z).max(LEAST_WEIGHT) as f32
        };
        (0..self.bins.len()).map(weight).collect()
    }
}

/// Columns of tables of one resolution.
#[derive(Debug, Clone, PartialEq)]
pub struct Collection {
    grid: Grid,
    columns: Vec<Vec<f32>>,
}

impl Collection {
    /// An empty collection.
    #[must_use]
    pub fn new(resolution: Resolution) -> Self {
        Self { grid: Grid::new(resolution), columns: Vec::new() }
    }

    /// The bins that take part so far.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Takes the channels of a table as columns. Bins that it did not measure are dropped from all.
    ///
    /// # Errors
    /// [`Error::Resolution`].
    pub fn add(&mut self, table: &HalfAngle) -> Result<(), Error> {
        let sizes = |r: Resolution| [r.theta_h, r.theta_d, r.phi_d];
        let (found, expected) = (sizes(table.resolution()), sizes(self.grid.resolution));
        if found != expected {
            return Err(Error::Resolution { found, expected });
        }
        let kept: Vec<bool> = self.grid.bins.iter().map(|b| !table.bin(*b)[0].is_nan()).collect();
        if kept.contains(&false) {
            let mut keep = kept.iter();
            self.grid.bins.retain(|_| *keep.next().unwrap_or(&false));
            for column in &mut self.columns {
                let mut keep = kept.iter();
                column.retain(|_| *keep.next().unwrap_or(&false));
            }
        }
        for channel in 0..table.channels().len() {
            self.columns.push(self.grid.bins.iter().map(|b| table.bin(*b)[channel]).collect());
        }
        Ok(())
    }

    /// Maps the columns for training.
    ///
    /// # Errors
    /// [`Error::TooFew`], [`Error::NothingInCommon`].
    pub fn train(self) -> Result<(Grid, Training), Error> {
        let weights = self.grid.weights();
        Ok((self.grid, Training::new(self.columns, weights)?))
    }
}

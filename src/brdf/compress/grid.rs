//! The bins of a resolution that take part in a compression.

use glam::DVec3;
use rayon::prelude::*;

use super::Error;
use super::mapping::LEAST_WEIGHT;
use crate::brdf::coordinates::HalfDiff;
use crate::brdf::table::{Channel, HalfAngle, Resolution};

/// Both cosines of a bin's centre are above this: below, a bin is cut by the horizon.
const LEAST_COSINE: f64 = 0.02;

/// The bins of a resolution that take part: those whose centres have both directions above the horizon, and that were measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    resolution: Resolution,
    bins: Vec<usize>,
}

fn takes_part(resolution: Resolution, bin: usize) -> bool {
    let (i, o) = resolution.centre(bin).directions();
    i.z > LEAST_COSINE && o.z > LEAST_COSINE
}

impl Grid {
    /// The bins whose centres have both directions above the horizon (cosines above 0.02).
    #[must_use]
    pub fn new(resolution: Resolution) -> Self {
        let bins = (0..resolution.bins()).into_par_iter().filter(|b| takes_part(resolution, *b)).collect();
        Self { resolution, bins }
    }

    /// The given bins; `None` where they do not rise, or one of them does not exist or is not above the horizon.
    pub(super) fn of(resolution: Resolution, bins: Vec<usize>) -> Option<Self> {
        let rise = bins.windows(2).all(|b| b[0] < b[1]) && bins.last().is_none_or(|b| *b < resolution.bins());
        let sound = rise && bins.par_iter().all(|b| takes_part(resolution, *b));
        sound.then_some(Self { resolution, bins })
    }

    /// Number of bins per angle.
    #[must_use]
    pub fn resolution(&self) -> Resolution {
        self.resolution
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

    /// The bin of two directions, counted among those that take part; `None` where it does not.
    #[must_use]
    pub fn bin_of(&self, incident: DVec3, outgoing: DVec3) -> Option<usize> {
        self.bins.binary_search(&self.resolution.bin(&HalfDiff::new(incident, outgoing))).ok()
    }

    /// The values of a channel of a table in the bins that take part; NaN where the table lacks one.
    ///
    /// # Errors
    /// [`Error::Resolution`] for a table of other bins.
    ///
    /// # Panics
    /// Where the table has no such channel.
    pub fn column(&self, table: &HalfAngle, channel: usize) -> Result<Vec<f32>, Error> {
        self.check(table.resolution())?;
        Ok(self.bins.iter().map(|b| table.bin(*b)[channel]).collect())
    }

    /// A table of columns, one per channel; bins that do not take part are missing.
    ///
    /// # Errors
    /// [`Error::Count`] for another number of columns than channels (at least one), or a column of another length.
    pub fn table(&self, channels: Vec<Channel>, columns: &[Vec<f32>]) -> Result<HalfAngle, Error> {
        let check = |what, found, expected| {
            if found == expected { Ok(()) } else { Err(Error::Count { what, found, expected }) }
        };
        check("columns", columns.len(), channels.len().max(1))?;
        columns.iter().try_for_each(|c| check("values in a column", c.len(), self.bins.len()))?;
        let n = channels.len();
        let mut values = vec![f32::NAN; n * self.resolution.bins()];
        for (i, bin) in self.bins.iter().enumerate() {
            values[n * bin..][..n].iter_mut().zip(columns).for_each(|(v, c)| *v = c[i]);
        }
        Ok(HalfAngle::of_bins(self.resolution, channels, values))
    }

    pub(super) fn check(&self, resolution: Resolution) -> Result<(), Error> {
        let sizes = |r: Resolution| [r.theta_h, r.theta_d, r.phi_d];
        let (found, expected) = (sizes(resolution), sizes(self.resolution));
        if found == expected { Ok(()) } else { Err(Error::Resolution { found, expected }) }
    }

    /// Keeps the bins that are marked.
    pub(super) fn retain(&mut self, marked: &[bool]) {
        let mut keep = marked.iter();
        self.bins.retain(|_| *keep.next().unwrap_or(&false));
    }

    #[expect(clippy::cast_possible_truncation, reason = "weights are kept in single precision")]
    pub(super) fn weights(&self) -> Vec<f32> {
        let weight = |bin| {
            let (i, o) = self.directions(bin);
            (i.z * o.z).max(LEAST_WEIGHT) as f32
        };
        (0..self.bins.len()).into_par_iter().map(weight).collect()
    }
}

//! Measurements of any number in bounded memory: an even draw of them, and their bins.
//!
//! As long as there are no more than [`Gathered::new`] allows, all are kept and the bins are those of [`super::bin`]. From then on every second
//! (fourth, …) is kept, and bins are kept as digests of all of them ([`super::digest`]): fits, medians and comparisons rest on the draw,
//! values and standard errors of bins on every measurement.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::bins::{Bin, Binned};
use super::digest::Digest;
use super::{Observations, Seen, bin};
use crate::brdf::coordinates::HalfDiff;
use crate::brdf::table::Resolution;

/// Samples that are put into bins at once.
const AT_ONCE: usize = 3 << 20;

/// Measurements as they come.
#[derive(Debug, Clone)]
pub struct Gathered {
    /// The first and every [`Gathered::stride`]-th after it.
    pub kept: Observations,
    /// 1 as long as all are kept.
    pub stride: usize,
    /// Measurements so far.
    pub count: usize,
    most: usize,
    resolution: Resolution,
    digests: BTreeMap<usize, Digests>,
    /// Those that wait to be put into bins, from the first on of which not all are kept.
    waiting: Observations,
}

/// A bin with a digest for each band, and the number of its measurements.
#[derive(Debug, Clone, PartialEq)]
struct Digests {
    count: usize,
    bands: Vec<Digest>,
}

impl Gathered {
    /// None yet, of the bands of `of`, for bins of `resolution`; from more than `most` samples (measurements times bands) on not all are kept.
    #[must_use]
    pub fn new(of: Observations, resolution: Resolution, most: usize) -> Self {
        let most = (most / of.channels.len().max(1)).max(2);
        let waiting = of.clone();
        Self { kept: of, stride: 1, count: 0, most, resolution, digests: BTreeMap::new(), waiting }
    }

    /// Adds one.
    pub fn push(&mut self, seen: &Seen<'_>) {
        if self.count.is_multiple_of(self.stride) {
            if self.kept.len() == self.most {
                self.thin();
            }
            // The number of measurements may not be a multiple of the new stride.
            if self.count.is_multiple_of(self.stride) {
                self.kept.push(seen);
            }
        }
        if self.stride > 1 {
            self.waiting.push(seen);
            if self.waiting.values.len() >= AT_ONCE {
                self.fold();
            }
        }
        self.count += 1;
    }

    /// How many are kept of `count` measurements from number `first` on.
    #[must_use]
    pub fn kept_of(&self, first: usize, count: usize) -> usize {
        (first + count).div_ceil(self.stride) - first.div_ceil(self.stride)
    }

    /// Keeps every second of those that are kept.
    fn thin(&mut self) {
        if self.stride == 1 {
            // All so far are kept: their bins are made of them.
            fold(&mut self.digests, self.resolution, &self.kept);
        }
        self.stride *= 2;
        self.kept.halve();
    }

    /// Puts those that wait into bins.
    fn fold(&mut self) {
        fold(&mut self.digests, self.resolution, &self.waiting);
        self.waiting.clear();
    }

    /// The bins of all measurements; those that are kept remain.
    #[must_use]
    pub fn bin(&mut self) -> Binned {
        if self.stride == 1 {
            return bin(&self.kept, self.resolution);
        }
        self.fold();
        let one = |(number, of): (&usize, &Digests)| {
            let mut out = Bin { bin: *number, count: of.count, rejected: 0, values: vec![], errors: vec![] };
            for digest in &of.bands {
                let (value, error, rejected) = digest.robust_mean();
                out.values.push(value);
                out.errors.push(error);
                out.rejected = out.rejected.max(rejected);
            }
            out
        };
        Binned::new(self.resolution, self.digests.iter().map(one).collect())
    }
}

/// Adds measurements to the digests of their bins.
fn fold(digests: &mut BTreeMap<usize, Digests>, resolution: Resolution, of: &Observations) {
    let bands = of.channels.len();
    let mut order: Vec<(usize, usize)> =
        (of.directions.par_iter().enumerate()).map(|(n, (i, o))| (resolution.bin(&HalfDiff::new(*i, *o)), n)).collect();
    order.par_sort_unstable();
    let groups: Vec<&[(usize, usize)]> = order.chunk_by(|a, b| a.0 == b.0).collect();
    let digest = |group: &&[(usize, usize)]| {
        let band = |band: usize| {
            let of_band = |all: &[f64]| group.iter().map(|(_, n)| all[n * bands + band]).collect::<Vec<f64>>();
            Digest::of(&of_band(&of.values), &of_band(&of.errors))
        };
        (group[0].0, Digests { count: group.len(), bands: (0..bands).map(band).collect() })
    };
    let found: Vec<(usize, Digests)> = groups.par_iter().map(digest).collect();
    for (number, new) in found {
        match digests.get_mut(&number) {
            Some(all) => {
                all.count += new.count;
                all.bands.iter_mut().zip(&new.bands).for_each(|(mine, theirs)| mine.merge(theirs));
            }
            None => {
                digests.insert(number, new);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::math::random::Stream;

    /// Measurements in a few bins, with noise of 5 % and stated errors.
    fn seen(n: usize, visit: &mut dyn FnMut(&Seen<'_>)) {
        let mut random = Stream::new(3, n as u64);
        let tilt = 0.05 * random.uniform();
        let normal = (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0;
        let (values, errors) = ([1.0 + 0.05 * normal, 2.0 + 0.1 * normal], [0.05, 0.1]);
        visit(&Seen {
            pixel: (0, 0),
            incident: DVec3::new(tilt.sin(), 0.0, tilt.cos()),
            outgoing: DVec3::Z,
            values: &values,
            errors: &errors,
            corrections: &[0.0; 2],
        });
    }

    #[test]
    fn bins_of_a_draw_rest_on_all_measurements() {
        let resolution = Resolution { theta_h: 20, theta_d: 20, phi_d: 4 };
        let gather = |count: usize, most: usize| {
            let mut out = Gathered::new(Observations::new(2), resolution, most);
            (0..count).for_each(|n| seen(n, &mut |s| out.push(s)));
            out
        };
        let (mut whole, mut drawn) = (gather(20_000, 1 << 20), gather(20_000, 2 * 3000));
        assert_eq!((whole.stride, whole.kept.len(), drawn.stride, drawn.count), (1, 20_000, 8, 20_000));
        assert_eq!(drawn.kept.len(), 2500);
        assert_eq!(drawn.kept.values[2], whole.kept.values[16]);
        assert_eq!((drawn.kept_of(0, 20_000), drawn.kept_of(1, 7), drawn.kept_of(1, 8)), (2500, 0, 1));
        let (exact, ours) = (whole.bin(), drawn.bin());
        assert_eq!((exact.bins.len(), exact.covered), (ours.bins.len(), ours.covered));
        for (e, o) in exact.bins.iter().zip(&ours.bins) {
            assert_eq!((e.bin, e.count), (o.bin, o.count));
            for band in 0..2 {
                let off = (e.values[band] - o.values[band]).abs();
                assert!(off < 0.1 * e.errors[band], "{e:?} {o:?}");
                assert!((o.errors[band] / e.errors[band] - 1.0).abs() < 0.02, "{e:?} {o:?}");
            }
        }
    }
}

//! A row of a picture, filtered.

use std::ops::Range;

use super::fit::Fits;
use super::record::{FEATURES, narrow};
use super::rows::Rows;
use super::weights::{Guide, overlap};

/// Pixels to each side that a pixel borrows from.
const REACH: isize = 5;

/// What filtering a row needs.
pub(super) struct Filter {
    fits: Fits,
    scratch: Vec<f32>,
    /// Of each neighbour, for all pixels of the row.
    weights: Vec<Vec<f32>>,
    differences: [Vec<f32>; FEATURES],
    /// What the camera saw, by all samples.
    seen: [Vec<f32>; FEATURES],
}

impl Filter {
    pub(super) fn new(width: usize) -> Self {
        let row = || vec![0.0; width];
        let neighbours = (2 * REACH + 1).unsigned_abs().pow(2);
        Self {
            fits: Fits::new(width),
            scratch: row(),
            weights: (0..neighbours).map(|_| row()).collect(),
            differences: std::array::from_fn(|_| row()),
            seen: std::array::from_fn(|_| row()),
        }
    }

    /// The bands of a half of row y, one behind the other.
    pub(super) fn row(&mut self, records: &Rows<'_>, guide: &Guide, half: usize, y: usize) -> Vec<f32> {
        let (width, layout) = (records.width, records.layout);
        for (feature, seen) in self.seen.iter_mut().enumerate() {
            for (x, seen) in seen.iter_mut().enumerate() {
                *seen = narrow(records.seen(x, y, feature));
            }
        }
        self.fits.clear();
        for (neighbour, place) in neighbours().enumerate() {
            guide.weigh(y, place, &mut self.scratch, &mut self.weights[neighbour]);
            let Some(shift) = Shift::of(records, y, place) else { continue };
            let counts = &records.channel(shift.row, layout.count(half))[shift.there.clone()];
            let weights = self.weights[neighbour][shift.columns.clone()].iter_mut();
            weights.zip(counts).for_each(|(w, count)| *w *= count);
            self.differ(records, half, &shift);
            let weights = &self.weights[neighbour][shift.columns.clone()];
            self.fits.add(shift.columns.start, weights, &self.differences);
        }
        self.fits.solve();
        let mut bands = vec![0.0; layout.bands * width];
        for (neighbour, place) in neighbours().enumerate() {
            let Some(shift) = Shift::of(records, y, place) else { continue };
            self.differ(records, half, &shift);
            let weights = &self.weights[neighbour][shift.columns.clone()];
            self.fits.apply(shift.columns.start, weights, &self.differences, &mut self.scratch);
            for (band, sums) in bands.chunks_exact_mut(width).enumerate() {
                let samples = &records.channel(shift.row, layout.band(half) + band)[shift.there.clone()];
                let sums = sums[shift.columns.clone()].iter_mut();
                sums.zip(self.scratch.iter().zip(samples)).for_each(|(sum, (k, sample))| *sum += k * sample);
            }
        }
        for (band, values) in bands.chunks_exact_mut(width).enumerate() {
            for (x, value) in values.iter_mut().enumerate().filter(|(_, value)| **value < 0.0) {
                *value = self.average(records, layout.band(half) + band, x, y);
            }
        }
        bands
    }

    /// The weighted mean of a pixel's neighbours, for a fit that went below 0.
    fn average(&self, records: &Rows<'_>, channel: usize, x: usize, y: usize) -> f32 {
        let own = neighbours().zip(&self.weights).filter_map(|([dx, dy], weights)| {
            Some((x.checked_add_signed(dx)?, y.checked_add_signed(dy)?, f64::from(weights[x]))).filter(|n| n.2 > 0.0)
        });
        let (sum, total) = own.fold((0.0, 0.0), |(sum, total), (x, y, weight)| {
            (sum + weight * records.at(x, y, channel), total + weight)
        });
        narrow(sum / total)
    }

    /// Writes by how much the features of a half differ from those of the pixels of the row.
    fn differ(&mut self, records: &Rows<'_>, half: usize, shift: &Shift) {
        for (feature, (differences, seen)) in self.differences.iter_mut().zip(&self.seen).enumerate() {
            let there = &records.channel(shift.row, records.layout.feature(half) + feature)[shift.there.clone()];
            differences.clear();
            differences.extend(there.iter().zip(&seen[shift.columns.clone()]).map(|(there, here)| there - here));
        }
    }
}

/// All neighbours of a pixel and itself: columns and rows away.
fn neighbours() -> impl Iterator<Item = [isize; 2]> + Clone {
    (-REACH..=REACH).flat_map(|dy| (-REACH..=REACH).map(move |dx| [dx, dy]))
}

/// The pixels of a row that have a certain neighbour, and these.
struct Shift {
    columns: Range<usize>,
    there: Range<usize>,
    row: usize,
}

impl Shift {
    fn of(records: &Rows<'_>, y: usize, [dx, dy]: [isize; 2]) -> Option<Self> {
        let row = y.checked_add_signed(dy).filter(|row| *row < records.rows.len())?;
        let columns = overlap(records.width, dx)?;
        let there = columns.start.strict_add_signed(dx)..columns.end.strict_add_signed(dx);
        Some(Self { columns, there, row })
    }
}

//! A row of a picture, filtered.

use pulp::{Arch, NullaryFnOnce};

use super::fit::Fits;
use super::record::{FEATURES, narrow};
use super::rows::Rows;
use super::tile::{NEIGHBOURS, TILE, Tile, Window, neighbour};
use super::weights::{Guide, overlap, scratch};
use crate::render::lanes::multiply;

/// Bands that are added up together.
const TOGETHER: usize = 4;

/// What filtering needs.
pub(super) struct Filter {
    /// Of each neighbour, for all pixels of a row and on to the end of its last tile; 0 where there is none.
    weights: Vec<Vec<f32>>,
    scratch: Vec<f32>,
    /// What the camera saw at the pixels of a tile, by all samples.
    seen: [Tile; FEATURES],
    /// And about it, by those of a half.
    features: [Window; FEATURES],
    fits: Fits,
    /// What each neighbour counts.
    kernels: Vec<Tile>,
    samples: [Window; TOGETHER],
}

impl Filter {
    pub(super) fn new(width: usize) -> Self {
        Self {
            weights: vec![vec![0.0; width.next_multiple_of(TILE)]; NEIGHBOURS],
            scratch: vec![0.0; scratch(width)],
            seen: [[0.0; TILE]; FEATURES],
            features: std::array::from_fn(|_| Window::default()),
            fits: Fits::default(),
            kernels: vec![[0.0; TILE]; NEIGHBOURS],
            samples: std::array::from_fn(|_| Window::default()),
        }
    }

    /// The bands of a half of row y, one behind the other.
    pub(super) fn row(&mut self, records: &Rows<'_>, guide: &Guide, half: usize, y: usize) -> Vec<f32> {
        let (width, layout) = (records.width, records.layout);
        let mut bands = vec![0.0; layout.bands * width];
        // The same operations in the same order with any instruction set.
        Arch::new().dispatch(Filtering { filter: self, records, guide, half, y, bands: &mut bands });
        for (band, values) in bands.chunks_exact_mut(width).enumerate() {
            for (x, value) in values.iter_mut().enumerate().filter(|(_, value)| **value < 0.0) {
                *value = self.average(records, layout.band(half) + band, x, y);
            }
        }
        bands
    }

    /// The weighted mean of a pixel's neighbours, for a fit that went below 0.
    fn average(&self, records: &Rows<'_>, channel: usize, x: usize, y: usize) -> f32 {
        let own = self.weights.iter().enumerate().filter_map(|(number, weights)| {
            let [dx, dy] = neighbour(number);
            Some((x.checked_add_signed(dx)?, y.checked_add_signed(dy)?, f64::from(weights[x]))).filter(|n| n.2 > 0.0)
        });
        let (sum, total) = own.fold((0.0, 0.0), |(sum, total), (x, y, weight)| {
            (sum + weight * records.at(x, y, channel), total + weight)
        });
        narrow(sum / total)
    }
}

/// A row that is being filtered. (No closures: only what is inlined is compiled for the instruction set at hand.)
struct Filtering<'a> {
    filter: &'a mut Filter,
    records: &'a Rows<'a>,
    guide: &'a Guide,
    half: usize,
    y: usize,
    /// One behind the other.
    bands: &'a mut [f32],
}

impl NullaryFnOnce for Filtering<'_> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        self.weigh();
        let mut first = 0;
        while first < self.records.width {
            self.fit(first);
            self.apply(first);
            first += TILE;
        }
    }
}

impl Filtering<'_> {
    /// Weighs each neighbour of all pixels of the row.
    #[inline(always)]
    fn weigh(&mut self) {
        let (filter, records) = (&mut *self.filter, self.records);
        for (number, weights) in filter.weights.iter_mut().enumerate() {
            let [dx, dy] = neighbour(number);
            let weights = &mut weights[..records.width];
            self.guide.weigh(self.y, [dx, dy], &mut filter.scratch, weights);
            let beside = self.y.checked_add_signed(dy).filter(|row| *row < records.rows.len());
            if let Some((row, columns)) = beside.zip(overlap(records.width, dx)) {
                let counts = records.channel(row, records.layout.count(self.half));
                let counts = &counts[columns.start.strict_add_signed(dx)..];
                multiply(&mut weights[columns], counts);
            }
        }
    }

    /// Finds what each neighbour counts, for the tile that begins at column `first`.
    #[inline(always)]
    fn fit(&mut self, first: usize) {
        let (filter, records) = (&mut *self.filter, self.records);
        let own = (records.width - first).min(TILE);
        for (feature, seen) in filter.seen.iter_mut().enumerate() {
            for (i, seen) in seen[..own].iter_mut().enumerate() {
                *seen = narrow(records.seen(first + i, self.y, feature));
            }
            filter.features[feature].load(records, records.layout.feature(self.half) + feature, first, self.y);
        }
        filter.fits.clear();
        for number in 0..NEIGHBOURS {
            let differences = differences(&filter.features, &filter.seen, number);
            filter.fits.add(tile(&filter.weights[number], first), &differences);
        }
        filter.fits.solve();
        for (number, kernel) in filter.kernels.iter_mut().enumerate() {
            let differences = differences(&filter.features, &filter.seen, number);
            *kernel = filter.fits.kernel(tile(&filter.weights[number], first), &differences);
        }
    }

    /// Adds up the bands of the tile that begins at column `first`, some at a time: what each neighbour counts is read once for them.
    #[inline(always)]
    fn apply(&mut self, first: usize) {
        let (filter, records) = (&mut *self.filter, self.records);
        let own = (records.width - first).min(TILE);
        let channel = records.layout.band(self.half);
        for (number, bands) in self.bands.chunks_mut(TOGETHER * records.width).enumerate() {
            let count = bands.len() / records.width;
            for (band, samples) in filter.samples[..count].iter_mut().enumerate() {
                samples.load(records, channel + number * TOGETHER + band, first, self.y);
            }
            let mut sums = [[0.0; TILE]; TOGETHER];
            for (number, kernel) in filter.kernels.iter().enumerate() {
                let samples = filter.samples.each_ref().map(|samples| samples.of(number));
                for i in 0..TILE {
                    for band in 0..TOGETHER {
                        sums[band][i] += kernel[i] * samples[band][i];
                    }
                }
            }
            for (out, sums) in bands.chunks_exact_mut(records.width).zip(&sums) {
                out[first..][..own].copy_from_slice(&sums[..own]);
            }
        }
    }
}

/// By how much the features of a neighbour differ from those of the pixels.
#[inline(always)]
fn differences(features: &[Window; FEATURES], seen: &[Tile; FEATURES], number: usize) -> [Tile; FEATURES] {
    let mut differences = [[0.0; TILE]; FEATURES];
    for feature in 0..FEATURES {
        let there = features[feature].of(number);
        for i in 0..TILE {
            differences[feature][i] = there[i] - seen[feature][i];
        }
    }
    differences
}

/// The numbers of a row from a column on.
#[inline(always)]
fn tile(row: &[f32], first: usize) -> &Tile {
    row[first..].first_chunk().expect("rows end where tiles end")
}

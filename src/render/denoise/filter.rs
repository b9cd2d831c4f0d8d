//! A row of a picture, filtered.

use pulp::{Arch, NullaryFnOnce};

use super::fit::Fits;
use super::record::{FEATURES, narrow};
use super::rows::Rows;
use super::tile::{MARGIN, Margin, NEIGHBOURS, TILE, Tile, Window, differs, neighbour};
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
    /// What lies about a tile at the picture's sides.
    margins: [Margin; FEATURES],
    fits: Fits,
    /// What each neighbour counts.
    kernels: Vec<Tile>,
}

impl Filter {
    pub(super) fn new(width: usize) -> Self {
        Self {
            weights: vec![vec![0.0; width.next_multiple_of(TILE)]; NEIGHBOURS],
            scratch: vec![0.0; scratch(width)],
            seen: [[0.0; TILE]; FEATURES],
            margins: [MARGIN; FEATURES],
            fits: Fits::default(),
            kernels: vec![[0.0; TILE]; NEIGHBOURS],
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
        let mut windows = [Window::EMPTY; FEATURES];
        let mut vary = 0;
        for (feature, margin) in filter.margins.iter_mut().enumerate() {
            let seen = &mut filter.seen[vary];
            for (i, seen) in seen[..own].iter_mut().enumerate() {
                *seen = narrow(records.seen(first + i, self.y, feature));
            }
            // What is the same everywhere, as most is on a floor, is no part of the fit.
            let (channel, all) = (records.layout.feature(self.half) + feature, seen[0]);
            if seen[..own].iter().any(|s| *s != all) || differs(records, channel, first, self.y, all) {
                windows[vary] = Window::of(records, channel, first, self.y, margin);
                vary += 1;
            }
        }
        let (windows, seen) = (&windows[..vary], &filter.seen[..vary]);
        filter.fits.start(vary);
        for number in 0..NEIGHBOURS {
            filter.fits.add(tile(&filter.weights[number], first), &differences(windows, seen, number));
        }
        filter.fits.solve();
        for (number, kernel) in filter.kernels.iter_mut().enumerate() {
            let differences = differences(windows, seen, number);
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
            let mut windows = [Window::EMPTY; TOGETHER];
            for (band, (window, margin)) in windows[..count].iter_mut().zip(&mut filter.margins).enumerate() {
                *window = Window::of(records, channel + number * TOGETHER + band, first, self.y, margin);
            }
            let mut sums = [[0.0; TILE]; TOGETHER];
            for (number, kernel) in filter.kernels.iter().enumerate() {
                let samples = windows.each_ref().map(|window| window.neighbour(number));
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

/// By how much the features of a neighbour, as many as there are, differ from those of the pixels.
#[inline(always)]
fn differences(features: &[Window<'_>], seen: &[Tile], number: usize) -> [Tile; FEATURES] {
    let mut differences = [[0.0; TILE]; FEATURES];
    for (feature, window) in features.iter().enumerate() {
        let there = window.neighbour(number);
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

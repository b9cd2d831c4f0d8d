//! In which of many bins a number lies, by one step into a table and one comparison.

/// Lower borders of bins, rising from 0, and the bin that each of many cells begins in.
///
/// A cell is a run of doubles that agree in their leading bits, so that cells are as fine beside small borders as beside large
/// ones; no cell holds two borders.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Borders {
    /// Lower border of each bin, and a last one that nothing reaches.
    lower: Vec<f64>,
    /// The bin at the beginning of each cell.
    first: Vec<u8>,
    /// The leading bits of the first cell.
    base: u64,
    /// How many bits are not leading.
    shift: u32,
}

impl Borders {
    /// Bins by their lower borders: at most 256, from 0 upwards.
    pub(super) fn new(borders: impl Iterator<Item = f64>) -> Self {
        let mut lower: Vec<f64> = borders.collect();
        let keys: Vec<u64> = lower.iter().skip(1).map(|b| b.to_bits()).collect();
        let apart = |shift: &u32| keys.windows(2).all(|k| k[0] >> shift < k[1] >> shift);
        let shift = (0..=52).rev().find(apart).unwrap_or(0);
        let base = keys.first().map_or(0, |k| k >> shift);
        let last = keys.last().map_or(0, |k| k >> shift);
        #[expect(clippy::cast_possible_truncation, reason = "at most 256 bins")]
        let first = (base..=last).map(|cell| keys.partition_point(|k| k >> shift < cell) as u8).collect();
        // No number is at or above it, infinity included.
        lower.push(f64::NAN);
        Self { lower, first, base, shift }
    }

    /// The bin of a number that is not negative.
    #[inline]
    pub(super) fn find(&self, value: f64) -> usize {
        #[expect(clippy::cast_possible_truncation, reason = "cut to the cells")]
        let cell = (value.to_bits() >> self.shift).saturating_sub(self.base).min(self.first.len() as u64 - 1) as usize;
        let bin = usize::from(self.first[cell]);
        bin + usize::from(value >= self.lower[bin + 1])
    }

    /// Number of cells.
    #[cfg(test)]
    pub(super) fn cells(&self) -> usize {
        self.first.len()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn every_number_is_in_its_bin(mut borders in prop::collection::vec(1e-9..1e9_f64, 0..200), value in 0.0..1e9_f64) {
            borders.push(0.0);
            borders.sort_by(f64::total_cmp);
            borders.dedup();
            let found = Borders::new(borders.iter().copied());
            for value in borders.iter().copied().chain([value, f64::INFINITY, f64::MIN_POSITIVE]) {
                prop_assert_eq!(found.find(value), borders.partition_point(|b| *b <= value) - 1);
            }
        }
    }

    #[test]
    fn one_bin_takes_all() {
        let one = Borders::new([0.0].into_iter());
        assert!([0.0, 1.0, f64::INFINITY].iter().all(|v| one.find(*v) == 0));
    }
}

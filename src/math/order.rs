//! Exact order statistics of a stream of `f32`, in two passes and one megabyte.
//!
//! The bits of an `f32`, turned so that they ascend with the value, are counted by their upper half in a first pass; that tells in
//! which of the 65 536 bins a rank lies. A second pass counts by the lower half what falls into these bins, and the value is
//! known to the bit. So no sample is ever kept, and counts of parts of a stream add up.

/// Bins of one half of the bits.
const BINS: usize = 1 << 16;

/// The bits of a value, ascending with it; −0 below +0.
fn key(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

fn value_of(key: u32) -> f32 {
    f32::from_bits(if key >> 31 == 1 { key & !(1 << 31) } else { !key })
}

/// The first pass: numbers of values by the upper half of their bits.
#[derive(Debug, Clone, PartialEq)]
pub struct Coarse {
    counts: Vec<u64>,
    total: u64,
}

impl Default for Coarse {
    fn default() -> Self {
        Self { counts: vec![0; BINS], total: 0 }
    }
}

impl Coarse {
    /// Counts a value, which must be finite.
    pub fn add(&mut self, value: f32) {
        self.counts[(key(value) >> 16) as usize] += 1;
        self.total += 1;
    }

    /// Values counted.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.total
    }

    /// The second pass for quantiles of the `fractions` given, each from 0 to 1.
    #[must_use]
    pub fn refine(&self, fractions: &[f64]) -> Fine {
        let last = self.total.saturating_sub(1);
        let mut fine = Fine { counts: Vec::new(), places: Vec::with_capacity(fractions.len()) };
        for fraction in fractions {
            let at = last as f64 * fraction.clamp(0.0, 1.0);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and a count")]
            let low = (at.floor() as u64).min(last);
            let ends = [low, (low + 1).min(last)].map(|rank| self.locate(rank));
            for (bin, _) in ends {
                if !fine.counts.iter().any(|(b, _)| *b == bin) {
                    fine.counts.push((bin, vec![0; BINS]));
                }
            }
            fine.places.push(Place { ends, share: at - low as f64 });
        }
        fine.counts.sort_by_key(|(bin, _)| *bin);
        fine
    }

    /// The bin of a rank, and the rank within it.
    fn locate(&self, rank: u64) -> (u32, u64) {
        let mut below = 0;
        for (bin, count) in (0_u32..).zip(&self.counts) {
            if rank < below + count {
                return (bin, rank - below);
            }
            below += count;
        }
        (0, 0)
    }
}

/// A quantile between two order statistics.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    ends: [(u32, u64); 2],
    share: f64,
}

/// The second pass: what falls into the bins of the ranks wanted, by the lower half of the bits.
#[derive(Debug, Clone, PartialEq)]
pub struct Fine {
    /// By bin, ascending.
    counts: Vec<(u32, Vec<u64>)>,
    places: Vec<Place>,
}

impl Fine {
    /// Counts a value: the same ones as in the first pass, in any order.
    pub fn add(&mut self, value: f32) {
        let key = key(value);
        if let Ok(i) = self.counts.binary_search_by_key(&(key >> 16), |(bin, _)| *bin) {
            self.counts[i].1[(key & 0xffff) as usize] += 1;
        }
    }

    /// The quantiles, in the order asked for: of n values in order, the one at place (n − 1) p counted from 0, between two values
    /// in proportion (type 7 of Hyndman & Fan, The American Statistician 50, 1996; the default of numpy and R).
    ///
    /// NaN where nothing was counted.
    #[must_use]
    pub fn quantiles(&self) -> Vec<f64> {
        let value = |(bin, rank): (u32, u64)| {
            let counts = self.counts.iter().find(|(b, _)| *b == bin).map_or(&[][..], |(_, c)| c);
            let mut below = 0;
            for (low, count) in (0_u32..).zip(counts) {
                below += count;
                if rank < below {
                    return f64::from(value_of(bin << 16 | low));
                }
            }
            f64::NAN
        };
        let between = |p: &Place| {
            let (a, b) = (value(p.ends[0]), value(p.ends[1]));
            a + p.share * (b - a)
        };
        self.places.iter().map(between).collect()
    }
}

/// The quantiles of values that are at hand; see [`Fine::quantiles`].
#[must_use]
pub fn quantiles(values: impl Iterator<Item = f32> + Clone, fractions: &[f64]) -> Vec<f64> {
    let mut coarse = Coarse::default();
    values.clone().for_each(|v| coarse.add(v));
    let mut fine = coarse.refine(fractions);
    values.for_each(|v| fine.add(v));
    fine.quantiles()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_numpy() {
        // numpy 2.3: numpy.quantile([3, 1, 2, 10], [0, .25, .5, .9, 1]).
        let got = quantiles([3.0, 1.0, 2.0, 10.0].into_iter(), &[0.0, 0.25, 0.5, 0.9, 1.0]);
        for (got, want) in got.iter().zip([1.0, 1.75, 2.5, 7.9, 10.0]) {
            assert!((got - want).abs() < 1e-14, "{got} {want}");
        }
        assert!(quantiles(std::iter::empty(), &[0.5])[0].is_nan());
    }

    #[test]
    fn every_rank_is_exact_over_the_whole_range() {
        // A permutation of values from −1e30 to 1e30, among them denormals and zeros.
        let mut sorted: Vec<f32> = (-4000..4000).map(|i| (i as f32 / 4000.0).powi(9) * 1e30).collect();
        sorted.extend([-0.0, 0.0, 1e-42, -1e-42, 7.0, 7.0, 7.0]);
        let shuffled: Vec<f32> = (0..sorted.len()).map(|i| sorted[i * 5003 % 8007]).collect();
        sorted.sort_by(f32::total_cmp);
        let last = sorted.len() - 1;
        for step in [1, 7, 100, 4004, last] {
            let fractions: Vec<f64> = (0..=last).step_by(step).take(9).map(|i| i as f64 / last as f64).collect();
            let got = quantiles(shuffled.iter().copied(), &fractions);
            for (i, got) in (0..=last).step_by(step).zip(got) {
                // i/last · last may miss i by an ulp, and then lies within an ulp of the neighbour's way.
                let (want, next) = (f64::from(sorted[i]), f64::from(sorted[(i + 1).min(last)]));
                let before = f64::from(sorted[i.saturating_sub(1)]);
                let slack = 1e-12 * (next - before);
                assert!((got - want).abs() <= slack, "{i}: {got} {want}");
            }
        }
    }
}

//! Whether the measurements themselves are reciprocal.
//!
//! Exchanging light and camera turns φ_d by half a turn. Points of the sphere on both sides of the half vector see one light and one camera
//! exchanged, so that a single picture tells: in each bin, the measurements with φ_d below π are held against those above. A material has
//! Helmholtz's reciprocity; what differs is noise, and errors of the geometry: a light that is not where it is said to be shows here.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::Observations;
use crate::brdf::coordinates::HalfDiff;
use crate::brdf::table::Resolution;

/// Measurements against those with light and camera exchanged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reciprocity {
    /// Bins with measurements of both kinds.
    pub bins: usize,
    /// Median over those bins and bands of 2|a − b|/(a + b), of the means a and b.
    pub median_relative: f64,
    /// Root of the mean of its square.
    pub rms_relative: f64,
}

/// Compares the halves of bins; `None` where no bin has both.
#[must_use]
pub fn reciprocity(of: &Observations, resolution: Resolution) -> Option<Reciprocity> {
    let bands = of.channels.len();
    // Number and sums per band of either half.
    let mut halves: BTreeMap<usize, [(f64, Vec<f64>); 2]> = BTreeMap::new();
    for ((i, o), values) in of.directions.iter().zip(of.values.chunks_exact(bands)) {
        let angles = HalfDiff::new(*i, *o);
        let empty = || [(0.0, vec![0.0; bands]), (0.0, vec![0.0; bands])];
        let pair = halves.entry(resolution.bin(&angles)).or_insert_with(empty);
        let half = &mut pair[usize::from(angles.phi_d >= PI)];
        half.0 += 1.0;
        half.1.iter_mut().zip(values).for_each(|(sum, v)| *sum += v);
    }
    halves.retain(|_, [a, b]| a.0 > 0.0 && b.0 > 0.0);
    let differences = halves.values().flat_map(|[a, b]| {
        a.1.iter().zip(&b.1).map(move |(x, y)| {
            let (x, y) = (x / a.0, y / b.0);
            2.0 * (x - y).abs() / (x + y).abs().max(f64::MIN_POSITIVE)
        })
    });
    let mut all: Vec<f64> = differences.collect();
    if all.is_empty() {
        return None;
    }
    let rms_relative = (all.iter().map(|d| d * d).sum::<f64>() / all.len() as f64).sqrt();
    let middle = all.len() / 2;
    let median_relative = *all.select_nth_unstable_by(middle, f64::total_cmp).1;
    Some(Reciprocity { bins: halves.len(), median_relative, rms_relative })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brdf::table::Channel;

    #[test]
    fn exchanged_directions_are_compared() {
        let at = |phi_d: f64| HalfDiff { theta_h: 0.3, phi_h: 0.0, theta_d: 0.5, phi_d }.directions();
        let mut all = Observations {
            channels: vec![Channel::Named("Y".to_owned())],
            directions: vec![at(1.0), at(1.0 + PI), at(2.0)],
            values: vec![0.9, 1.1, 5.0],
            errors: vec![0.0; 3],
            corrections: vec![0.0; 3],
        };
        let found = reciprocity(&all, Resolution::MERL).expect("one pair");
        // 2 · 0.2/2; the third has no partner.
        assert!(found.bins == 1 && (found.median_relative - 0.2).abs() < 1e-14, "{found:?}");
        all.directions.truncate(1);
        all.values.truncate(1);
        assert!(reciprocity(&all, Resolution::MERL).is_none());
    }
}

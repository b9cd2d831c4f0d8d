//! Which pictures a model does not describe as it does the others: swapped photographs, a lamp that was moved.

use super::Observations;
use crate::brdf::Brdf;

/// Measurements of a picture that are looked at, about.
const LOOKED_AT: usize = 20_000;
/// A picture is apart from the others where its median deviation is so many times that of the median picture
const TIMES: f64 = 4.0;
/// and not below this.
const LEAST: f64 = 0.05;

/// Of each picture, the median over its measurements of |measured/modelled − 1|, the mean over bands; `None` without measurements.
/// `counts` says how many measurements each picture gave, in the order of `of`.
#[must_use]
pub fn deviations(of: &Observations, counts: &[usize], brdf: &dyn Brdf) -> Vec<Option<f64>> {
    let bands = of.channels.len();
    let mut modelled = vec![0.0; bands];
    let mut first = 0;
    let mut one = |count: &usize| {
        let places = first..first + count;
        first += count;
        let mut all: Vec<f64> = places
            .step_by(count.div_ceil(LOOKED_AT).max(1))
            .map(|n| {
                let (i, o) = of.directions[n];
                brdf.evaluate(i, o, &mut modelled);
                let values = &of.values[n * bands..][..bands];
                values.iter().zip(&modelled).map(|(v, m)| (v / m - 1.0).abs()).sum::<f64>() / bands as f64
            })
            .collect();
        let middle = all.len() / 2;
        (!all.is_empty()).then(|| *all.select_nth_unstable_by(middle, f64::total_cmp).1)
    };
    counts.iter().map(&mut one).collect()
}

/// The pictures, by number, that deviate far more than the median picture does; none of fewer than three.
#[must_use]
pub fn apart(deviations: &[Option<f64>]) -> Vec<usize> {
    let mut known: Vec<f64> = deviations.iter().copied().flatten().collect();
    if known.len() < 3 {
        return Vec::new();
    }
    known.sort_by(f64::total_cmp);
    let limit = LEAST.max(TIMES * known[(known.len() - 1) / 2]);
    (0..deviations.len()).filter(|n| deviations[*n].is_some_and(|d| d > limit)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brdf::lambert::Lambert;
    use crate::brdf::table::Channel;
    use glam::DVec3;

    #[test]
    fn a_picture_apart_is_named_and_scatter_is_not() {
        let white = Lambert::new(vec![1.0]).expect("a reflectance");
        let value = |relative: f64| (1.0 + relative) / std::f64::consts::PI;
        let of = Observations {
            channels: vec![Channel::Named("Y".to_owned())],
            directions: vec![(DVec3::Z, DVec3::Z); 7],
            values: [0.01, -0.02, 0.03, 0.02, -0.5, 0.4, 0.01].map(value).to_vec(),
            errors: vec![0.0; 7],
            corrections: vec![0.0; 7],
        };
        let found = deviations(&of, &[3, 0, 1, 2, 1], &white);
        let expected = [Some(0.02), None, Some(0.02), Some(0.5), Some(0.01)];
        for (f, e) in found.iter().zip(expected) {
            assert!(f.is_some() == e.is_some() && (f.unwrap_or(0.0) - e.unwrap_or(0.0)).abs() < 1e-12, "{found:?}");
        }
        assert_eq!(apart(&found), [3]);
        assert_eq!(apart(&[Some(0.01), Some(0.5)]), [0; 0]);
        assert_eq!(apart(&[Some(0.2), Some(0.3), Some(0.7)]), [0; 0]);
    }
}

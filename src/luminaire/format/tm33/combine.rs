//! The sum of several distributions.

use super::super::error::{Error, ErrorKind};
use crate::finding::Location;
use crate::luminaire::{Distribution, Symmetry, System};

/// Beyond its last row a table is zero: the step is put into this many degrees.
const STEP_DEG: f64 = 1e-4;
/// More values than this in a sum are refused: tables without common angles multiply.
const MOST_VALUES: usize = 10_000_000;

/// The sum: on the common table where all have the same, else on all angles of all, where each is linear between them.
pub(super) fn sum(parts: &[Distribution]) -> Result<Option<Distribution>, Error> {
    let Some((first, rest)) = parts.split_first() else { return Ok(None) };
    if rest.is_empty() {
        return Ok(Some(first.clone()));
    }
    let (system, symmetry) = (first.system(), first.symmetry());
    let made = if rest.iter().all(|d| first.same_angles(d)) {
        let mut values = first.values().to_vec();
        for part in rest {
            values.iter_mut().zip(part.values()).for_each(|(a, b)| *a += b);
        }
        Distribution::new(system, symmetry, first.horizontal_deg().to_vec(), first.vertical_deg().to_vec(), values)
    } else {
        let symmetry = if parts.iter().all(|d| d.symmetry() == symmetry) { symmetry } else { Symmetry::None };
        let horizontal = united(parts.iter().map(|d| planes(d, symmetry)));
        let ends = |d: &Distribution| {
            let v = d.vertical_deg();
            let (low, high) = (v[0], v[v.len() - 1]);
            let mut angles = v.to_vec();
            angles.extend([low - STEP_DEG, high + STEP_DEG]);
            angles
        };
        let bounds = parts.iter().fold((f64::MAX, f64::MIN), |(low, high), d| {
            let v = d.vertical_deg();
            (low.min(v[0]), high.max(v[v.len() - 1]))
        });
        let mut vertical = united(parts.iter().map(ends));
        vertical.retain(|v| *v >= bounds.0 && *v <= bounds.1);
        let found = horizontal.len().saturating_mul(vertical.len());
        if found > MOST_VALUES {
            let field = "the directions of all emitters together".to_owned();
            let kind = ErrorKind::TooLarge { found: found.to_string(), field, limit: MOST_VALUES as u64 };
            return Err(Error::new(Location::default(), kind));
        }
        let value = |h: f64, v: f64| parts.iter().map(|d| d.at(h, v)).sum::<f64>();
        let values =
            horizontal.iter().flat_map(|h| vertical.iter().map(|v| value(*h, *v)).collect::<Vec<_>>()).collect();
        Distribution::new(system, symmetry, horizontal, vertical, values)
    };
    made.map(Some).map_err(|error| Error::new(Location::default(), error))
}

/// All planes of a table in the symmetry asked for.
fn planes(d: &Distribution, symmetry: Symmetry) -> Vec<f64> {
    let own = d.horizontal_deg().to_vec();
    if d.symmetry() == symmetry || d.system() != System::TypeC {
        return own;
    }
    let mirror = |angles: &[f64], axis: f64| -> Vec<f64> {
        angles.iter().flat_map(|a| [*a, (2.0 * axis - a).rem_euclid(360.0)]).collect()
    };
    let mut all = match d.symmetry() {
        Symmetry::Quadrant => mirror(&mirror(&own, 90.0), 0.0),
        Symmetry::BilateralC0 => mirror(&own, 0.0),
        Symmetry::BilateralC90 => mirror(&own, 90.0),
        Symmetry::Rotational => vec![0.0, 90.0, 180.0, 270.0],
        Symmetry::None => own,
    };
    all.extend([0.0, 360.0]);
    all
}

/// All angles, ascending, each once.
fn united(lists: impl Iterator<Item = Vec<f64>>) -> Vec<f64> {
    let mut all: Vec<f64> = lists.flatten().collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() <= 1e-6);
    all
}

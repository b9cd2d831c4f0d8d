//! The sum of several distributions.

use super::super::distribution::{Distribution, Symmetry, System};
use super::Error;
use super::grid::affordable;
use super::planes::{all_planes, ascending, tabulated};

/// Beyond its last angle a table is zero: the step is put into this many degrees.
const STEP_DEG: f64 = 1e-4;

/// The sum of tables of one system: on the common table where all have the same, else on all angles of all, where each is
/// linear between them. `None` for no tables. The interpolation is the first one's.
///
/// # Errors
/// [`Error::TooLarge`], [`Error::Table`].
pub(in crate::luminaire) fn sum(parts: &[Distribution]) -> Result<Option<Distribution>, Error> {
    let Some((first, rest)) = parts.split_first() else { return Ok(None) };
    if rest.is_empty() {
        return Ok(Some(first.clone()));
    }
    let alike = |d: &Distribution| {
        (d.system(), d.symmetry()) == (first.system(), first.symmetry())
            && d.horizontal_deg() == first.horizontal_deg()
            && d.vertical_deg() == first.vertical_deg()
    };
    let (system, symmetry) = (first.system(), first.symmetry());
    let made = if rest.iter().all(alike) {
        let mut values = first.values().to_vec();
        for part in rest {
            values.iter_mut().zip(part.values()).for_each(|(a, b)| *a += b);
        }
        Distribution::new(system, symmetry, first.horizontal_deg().to_vec(), first.vertical_deg().to_vec(), values)?
    } else {
        let symmetry = if parts.iter().all(|d| d.symmetry() == symmetry) { symmetry } else { Symmetry::None };
        let planes = |d: &Distribution| {
            if d.symmetry() == symmetry { d.horizontal_deg().to_vec() } else { all_planes(d) }
        };
        let horizontal: Vec<Vec<f64>> = parts.iter().map(planes).collect();
        // The turn of Type C has no ends.
        let horizontal =
            if system == System::TypeC { ascending(horizontal.concat()) } else { with_steps(&horizontal, symmetry) };
        let vertical: Vec<Vec<f64>> = parts.iter().map(|d| d.vertical_deg().to_vec()).collect();
        let vertical = with_steps(&vertical, Symmetry::None);
        affordable(horizontal.len(), vertical.len())?;
        let value = |h: f64, v: f64| parts.iter().map(|d| d.at(h, v)).sum::<f64>();
        tabulated((system, symmetry), horizontal, &vertical, value)?
    };
    Ok(Some(made.with_interpolation(first.interpolation())))
}

/// All angles of all lists, and one beyond the ends of each where others go on; mirrored lists begin at 0 together.
fn with_steps(lists: &[Vec<f64>], symmetry: Symmetry) -> Vec<f64> {
    let ends = |list: &Vec<f64>| (list[0], list[list.len() - 1]);
    let (low, high) =
        lists.iter().map(ends).fold((f64::MAX, f64::MIN), |(low, high), (a, b)| (low.min(a), high.max(b)));
    let mut all = lists.concat();
    for (first, last) in lists.iter().map(ends) {
        if symmetry != Symmetry::Quadrant {
            all.push(first - STEP_DEG);
        }
        all.push(last + STEP_DEG);
    }
    all.retain(|a| *a >= low && *a <= high);
    ascending(all)
}

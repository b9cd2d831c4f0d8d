//! A table with fewer angles.

use super::super::Luminaire;
use super::super::distribution::Distribution;
use super::{Error, facts};
use crate::finding::Checked;

/// The table with every n-th of its horizontal and of its vertical angles, the first and the last always among them: what a coarser
/// measurement of the same luminaire would have given.
///
/// # Errors
/// [`Error::Argument`] for 0.
pub fn thinned(d: &Distribution, [every_horizontal, every_vertical]: [usize; 2]) -> Result<Distribution, Error> {
    let kept = |what: &'static str, count: usize, every: usize| -> Result<Vec<usize>, Error> {
        if every == 0 {
            return Err(Error::Argument { what, found: 0.0, expected: "every 1st angle or fewer" });
        }
        Ok((0..count).filter(|i| i.is_multiple_of(every) || i + 1 == count).collect())
    };
    let planes = kept("every horizontal angle", d.horizontal_deg().len(), every_horizontal)?;
    let rows = kept("every vertical angle", d.vertical_deg().len(), every_vertical)?;
    let of = |angles: &[f64], kept: &[usize]| kept.iter().map(|i| angles[*i]).collect();
    let values = planes.iter().flat_map(|p| rows.iter().map(|r| d.plane(*p)[*r])).collect();
    let angles = (of(d.horizontal_deg(), &planes), of(d.vertical_deg(), &rows));
    let table = Distribution::new(d.system(), d.symmetry(), angles.0, angles.1, values)?;
    Ok(table.with_interpolation(d.interpolation()))
}

/// The luminaire with fewer angles in its table ([`thinned`]); spectra by direction, which would keep all of them, are left out with a word.
///
/// # Errors
/// [`Error::Argument`] for 0.
pub fn fewer_angles(luminaire: &Luminaire, every: [usize; 2]) -> Result<Checked<Luminaire>, Error> {
    let mut out = Luminaire { distribution: thinned(&luminaire.distribution, every)?, ..luminaire.clone() };
    let mut findings = Vec::new();
    if every != [1; 2] {
        facts::drop_angular_spectra(&mut out, &mut findings);
    }
    Ok(Checked { value: out, findings })
}

#[cfg(test)]
mod tests {
    use super::super::super::distribution::{Symmetry, System};
    use super::*;

    #[test]
    fn the_ends_stay_and_what_stays_is_unchanged() {
        let (c, g): (Vec<f64>, Vec<f64>) =
            ((0..=6).map(|i| 15.0 * f64::from(i)).collect(), (0..=9).map(|i| 10.0 * f64::from(i)).collect());
        let values = (0..70).map(f64::from).collect();
        let d = Distribution::new(System::TypeC, Symmetry::Quadrant, c, g, values).expect("a sound table");
        let t = thinned(&d, [4, 2]).expect("fewer angles");
        assert_eq!(t.horizontal_deg(), [0.0, 60.0, 90.0]);
        assert_eq!(t.vertical_deg(), [0.0, 20.0, 40.0, 60.0, 80.0, 90.0]);
        for c in t.horizontal_deg() {
            assert!(t.vertical_deg().iter().all(|g| t.at(*c, *g) == d.at(*c, *g)));
        }
        assert_eq!(thinned(&d, [1, 1]).expect("all angles"), d);
        assert!(matches!(thinned(&d, [0, 1]), Err(Error::Argument { .. })));
    }
}

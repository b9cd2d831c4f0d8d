//! Which planes the intensities belong to: Isym and Mc, checked against the list of angles and the numbers present.

use super::super::error::{Error, ErrorKind};
use super::parse::SAME_DEG;
use super::{Isym, Stored};
use crate::finding::{Checked, Finding, Location};

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_DEG
}

/// The planes stored, and their number. `ahead` counts the numbers that follow the lists.
pub(super) fn layout(
    symmetry: Isym,
    angles: &[f64],
    gamma_count: usize,
    ahead: impl Fn(&[usize]) -> usize,
    at: &Location,
) -> Result<Checked<(Stored, usize)>, Error> {
    let count = angles.len();
    let nominal = symmetry.stored_planes(count);
    let present = ahead(&[nominal * gamma_count, count * gamma_count]);
    distinct(angles, at)?;
    let other = |message: String| vec![Finding::warning("L209", message).at(Location::line(3))];
    let all_listed = present == count * gamma_count;
    if symmetry == Isym::None {
        return Ok(Checked::clean((Stored::All, count)));
    }
    if symmetry == Isym::Vertical {
        if count > 1 && all_listed {
            let message = format!("Isym 1 asks for one plane, but all {count} are given; all were taken");
            return Ok(Checked { value: (Stored::All, count), findings: other(message) });
        }
        return Ok(Checked::clean((Stored::One, 1)));
    }
    let (own, whole) = indices(symmetry, angles);
    let ends = match symmetry {
        Isym::C0C180 => (0.0, 180.0),
        Isym::Both => (0.0, 90.0),
        _ => (270.0, 90.0),
    };
    let reaches = |end: f64| own.iter().any(|&i| same(angles[i].rem_euclid(360.0), end));
    let ascends = own.windows(2).all(|w| angles[w[1]] > angles[w[0]] || symmetry == Isym::C90C270);
    if !(reaches(ends.0) && reaches(ends.1) && ascends) {
        let (first, last) = (angles[0], angles[count - 1]);
        return Err(Error::new(
            at.clone(),
            ErrorKind::Contradiction {
                first: format!("{count} C-angles from {first}° to {last}°"),
                second: format!("Isym {}, whose planes run from C{} to C{}", symmetry.number(), ends.0, ends.1),
            },
        )
        .with_hint("correct Isym (line 3) or the list of C-angles"));
    }
    let nearly = own.len() == nominal;
    if !whole || nearly {
        let mut findings = Vec::new();
        if !whole && !nearly {
            findings = other(format!(
                "the list of C-angles has the {count} planes that are given only, not the full turn; they were taken for those of Isym {}",
                symmetry.number()
            ));
        } else if all_listed && count != nominal {
            let message = format!(
                "Isym {} asks for {nominal} planes, but all {count} are given; all were taken, without symmetry",
                symmetry.number()
            );
            return Ok(Checked { value: (Stored::All, count), findings: other(message) });
        }
        let planes = own.len();
        return Ok(Checked { value: (Stored::Some(own), planes), findings });
    }
    let planes = own.len();
    if present == planes * gamma_count {
        let message = format!(
            "Isym {} and Mc {count} ask for {nominal} planes; the list has {planes} from C{} to C{}, and as many are given",
            symmetry.number(),
            ends.0,
            ends.1
        );
        return Ok(Checked { value: (Stored::Some(own), planes), findings: other(message) });
    }
    if all_listed {
        let message =
            format!("Isym {} is given with all {count} planes; all were taken, without symmetry", symmetry.number());
        return Ok(Checked { value: (Stored::All, count), findings: other(message) });
    }
    Err(Error::new(
        at.clone(),
        ErrorKind::Contradiction {
            first: format!("{present} intensities, {gamma_count} in each plane"),
            second: format!(
                "{planes} C-angles from C{} to C{} and Isym {} with Mc {count}, which make {nominal} planes",
                ends.0,
                ends.1,
                symmetry.number()
            ),
        },
    )
    .with_hint("correct Isym (line 3), Mc (line 4) or the list of C-angles"))
}

/// The listed planes that a symmetry stores, in its order, and whether the list goes beyond them.
fn indices(symmetry: Isym, angles: &[f64]) -> (Vec<usize>, bool) {
    let all = 0..angles.len();
    if symmetry != Isym::C90C270 {
        let end = if symmetry == Isym::Both { 90.0 } else { 180.0 };
        let own: Vec<usize> = all.filter(|&i| angles[i] <= end + SAME_DEG).collect();
        let whole = own.len() < angles.len();
        return (own, whole);
    }
    let turn = |i: usize| angles[i].rem_euclid(360.0);
    let has_zero = angles.iter().any(|a| same(*a, 0.0));
    // A list that closes with 360° has C0 twice.
    let listed: Vec<usize> = all.filter(|&i| !(has_zero && same(angles[i], 360.0))).collect();
    let inside = |i: usize| turn(i) > 90.0 + SAME_DEG && turn(i) < 270.0 - SAME_DEG;
    let outside = |i: usize| turn(i) < 90.0 - SAME_DEG || turn(i) > 270.0 + SAME_DEG;
    if listed.iter().all(|&i| !outside(i)) || listed.iter().all(|&i| !inside(i)) {
        return (listed, false);
    }
    let (mut own, rest): (Vec<usize>, Vec<usize>) = listed.into_iter().partition(|&i| turn(i) >= 270.0 - SAME_DEG);
    own.extend(rest.into_iter().filter(|&i| turn(i) <= 90.0 + SAME_DEG));
    (own, true)
}

/// No plane may be listed twice, except that 360° closes a list from 0°.
fn distinct(angles: &[f64], at: &Location) -> Result<(), Error> {
    let mut sorted: Vec<f64> = angles.iter().map(|a| if *a < 0.0 { a + 360.0 } else { *a }).collect();
    sorted.sort_by(f64::total_cmp);
    match sorted.windows(2).find(|w| w[1] - w[0] <= SAME_DEG) {
        Some(w) => Err(Error::new(
            at.clone(),
            ErrorKind::OutOfRange {
                found: format!("{}° twice", w[1]),
                field: "the C-angles".to_owned(),
                expected: "different angles".to_owned(),
            },
        )
        .with_hint("Mc (line 4) may not fit the list")),
        None => Ok(()),
    }
}

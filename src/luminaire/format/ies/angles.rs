//! The angles of a table: their order, their ranges, and what they say about symmetry.

use super::super::error::{Error, ErrorKind};
use super::super::text::place;
use super::scan::Numbers;
use crate::finding::{Finding, Location};
use crate::luminaire::{Symmetry, System};

/// Angles nearer than this are the same: some files print 89.9999 or 360.0001.
const SAME_DEG: f64 = 1e-3;

pub(super) fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_DEG
}

/// Whether the angles run downwards.
pub(super) fn descending(angles: &[f64]) -> bool {
    angles.len() > 1 && angles[0] > angles[angles.len() - 1]
}

/// Where the angle of an index stands in the text.
fn location(text: &str, start: usize, index: usize) -> Location {
    let mut numbers = Numbers::new(text, start);
    for i in 0..index {
        if numbers.next("", i, index).is_err() {
            break;
        }
    }
    place(text, numbers.peek())
}

/// Refuses angles that neither ascend nor descend, or lie outside of what their system has.
pub(super) fn check(
    which: &'static str,
    angles: &[f64],
    allowed: (f64, f64),
    text: &str,
    start: usize,
    findings: &mut Vec<Finding>,
) -> Result<(), Error> {
    let down = descending(angles);
    let wrong = angles.windows(2).position(|w| if down { w[0] <= w[1] } else { w[0] >= w[1] });
    if let Some(i) = wrong {
        let kind = ErrorKind::OutOfRange {
            found: format!("{} after {}", angles[i + 1], angles[i]),
            field: format!("{which} angle {} of {}", i + 2, angles.len()),
            expected: "angles that ascend".into(),
        };
        return Err(Error::new(location(text, start, i + 1), kind)
            .with_hint("the counts of angles may be wrong, or a number is missing or too many before this one"));
    }
    if let Some(i) = angles.iter().position(|a| *a < allowed.0 - SAME_DEG || *a > allowed.1 + SAME_DEG) {
        let kind = ErrorKind::OutOfRange {
            found: format!("{}°", angles[i]),
            field: format!("{which} angle {} of {}", i + 1, angles.len()),
            expected: format!("{}° to {}° in this photometric type", allowed.0, allowed.1),
        };
        return Err(Error::new(location(text, start, i), kind));
    }
    if down {
        let message =
            format!("the {which} angles run from {}° down to {}°; reversed", angles[0], angles[angles.len() - 1]);
        findings.push(Finding::info("L020", message).at(place(text, Numbers::new(text, start).peek())));
    }
    Ok(())
}

/// What vertical angles a system has, degrees.
pub(super) fn vertical_range(system: System) -> (f64, f64) {
    if system == System::TypeC { (0.0, 180.0) } else { (-90.0, 90.0) }
}

/// What horizontal angles a system has, degrees.
pub(super) fn horizontal_range(system: System) -> (f64, f64) {
    if system == System::TypeC { (0.0, 360.0) } else { (-90.0, 90.0) }
}

/// What stands for the whole turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Planes {
    pub(super) symmetry: Symmetry,
    /// The plane of 360° has to be added.
    pub(super) open: bool,
}

/// The symmetry that ascending horizontal angles mean (LM-63: by the first and the last); the message where they mean none.
pub(super) fn planes(system: System, horizontal: &[f64]) -> Result<Planes, &'static str> {
    let (first, last) = (horizontal[0], horizontal[horizontal.len() - 1]);
    let closed = |symmetry| Ok(Planes { symmetry, open: false });
    if system != System::TypeC {
        return match (horizontal.len(), near(first, 0.0)) {
            (1, _) => Err("two horizontal angles or more in Types A and B, which know no rotational symmetry"),
            (_, true) => closed(Symmetry::Quadrant),
            _ => closed(Symmetry::None),
        };
    }
    if horizontal.len() == 1 {
        return closed(Symmetry::Rotational);
    }
    if near(first, 0.0) {
        if near(last, 90.0) {
            return closed(Symmetry::Quadrant);
        }
        if near(last, 180.0) {
            return closed(Symmetry::BilateralC0);
        }
        if near(last, 360.0) {
            return closed(Symmetry::None);
        }
        let widest = horizontal.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
        if 360.0 - last <= widest.min(90.0) + SAME_DEG {
            return Ok(Planes { symmetry: Symmetry::None, open: true });
        }
    }
    if near(first, 90.0) && near(last, 270.0) {
        return closed(Symmetry::BilateralC90);
    }
    Err("0°, 0° to 90°, 0° to 180°, 90° to 270° or 0° to 360°")
}

/// Angles within a thousandth of a degree of a quarter turn, exactly there.
pub(super) fn snap(angles: &mut [f64]) {
    for angle in angles {
        let quarter = (*angle / 90.0).round() * 90.0;
        if near(*angle, quarter) {
            *angle = quarter;
        }
    }
}

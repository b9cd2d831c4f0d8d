//! From a table to a [`Distribution`]: angle system and symmetry.

use super::super::error::{Error, ErrorKind};
use super::{Goniometer, IntensityTable, Symm};
use crate::finding::Finding;
use crate::luminaire::{Distribution, Symmetry, System};

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6
}

/// The table as distribution, multiplier applied.
pub(super) fn distribution(
    table: &IntensityTable,
    goniometer: Option<Goniometer>,
    findings: &mut Vec<Finding>,
) -> Result<Distribution, Error> {
    let refused = |kind: ErrorKind| Error::new(table.location.clone(), kind);
    let system = system(table, goniometer, findings)?;
    let scaled: Vec<f64> = table.values.iter().map(|v| v * table.multiplier).collect();
    if system != System::TypeC {
        let symmetry = if table.horizontal_deg[0] >= 0.0 { Symmetry::Quadrant } else { Symmetry::None };
        return Distribution::new(system, symmetry, table.horizontal_deg.clone(), table.vertical_deg.clone(), scaled)
            .map_err(|error| refused(error.into()));
    }
    // Planes as the model has them: a turn from 0°; C270 … C90 over C0 folded to C90 … C270.
    let rows = table.vertical_deg.len();
    let turned = |h: f64| if h < -1e-6 { h + 360.0 } else { h };
    let front = |h: f64| turned(h) <= 90.0 + 1e-6 || turned(h) >= 270.0 - 1e-6;
    let has = |end: f64| table.horizontal_deg.iter().any(|h| same(turned(*h), end));
    let over_c0 = table.horizontal_deg.len() > 1
        && table.horizontal_deg.iter().all(|h| front(*h))
        && has(90.0)
        && has(270.0)
        && table.symmetry != Some(Symm::None);
    let mut planes: Vec<(f64, &[f64])> = table
        .horizontal_deg
        .iter()
        .map(|h| if over_c0 { (180.0 - h).rem_euclid(360.0) } else { turned(*h) })
        .zip(scaled.chunks_exact(rows))
        .collect();
    planes.sort_by(|a, b| a.0.total_cmp(&b.0));
    planes.dedup_by(|a, b| over_c0 && same(a.0, b.0));
    let (angles, values): (Vec<f64>, Vec<&[f64]>) = planes.into_iter().unzip();
    let symmetry = symmetry(table, &angles, findings).map_err(refused)?;
    Distribution::new(system, symmetry, angles, table.vertical_deg.clone(), values.concat())
        .map_err(|error| refused(error.into()))
}

/// Whose angles these are. The gonioradiometer tells how was measured; some converters state CIE_A for Type C tables.
fn system(
    table: &IntensityTable,
    goniometer: Option<Goniometer>,
    findings: &mut Vec<Finding>,
) -> Result<System, Error> {
    let (h, v) = (&table.horizontal_deg, &table.vertical_deg);
    let beyond = h.iter().chain(v).any(|a| a.abs() > 90.0 + 1e-6);
    match goniometer {
        Some(stated @ (Goniometer::A | Goniometer::B)) => {
            let (letter, system) = if stated == Goniometer::A { ("A", System::TypeA) } else { ("B", System::TypeB) };
            if !beyond && v[0] < 0.0 && h.len() > 1 {
                return Ok(system);
            }
            let message = format!(
                "the gonioradiometer is of Type {letter}, but the angles ({}° to {}°, {}° to {}°) are those of Type C, as which they were taken",
                h[0],
                h[h.len() - 1],
                v[0],
                v[v.len() - 1]
            );
            findings.push(Finding::info("L310", message).at(table.location.clone()));
        }
        _ if v[0] < -1e-6 => {
            let kind = ErrorKind::OutOfRange {
                found: format!("{}°", v[0]),
                field: "the vertical angles".to_owned(),
                expected: "0° to 180° (Type C), or a gonioradiometer of Type A or B".to_owned(),
            };
            return Err(Error::new(table.location.clone(), kind)
                .with_hint("state IES_A or IES_B as <Type> of the <Gonioradiometer>"));
        }
        _ => {}
    }
    Ok(System::TypeC)
}

/// The symmetry stated, if the planes are those of it; else what the planes tell.
fn symmetry(table: &IntensityTable, angles: &[f64], findings: &mut Vec<Finding>) -> Result<Symmetry, ErrorKind> {
    let (first, last) = (angles[0], angles[angles.len() - 1]);
    let widest = angles.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    let told = if angles.len() == 1 {
        Some(Symmetry::Rotational)
    } else if same(first, 90.0) && same(last, 270.0) {
        Some(Symmetry::BilateralC90)
    } else if !same(first, 0.0) {
        None
    } else if same(last, 90.0) {
        Some(Symmetry::Quadrant)
    } else if same(last, 180.0) {
        Some(Symmetry::BilateralC0)
    } else {
        // The turn may be left open by one step.
        (360.0 - last <= 1.5 * widest).then_some(Symmetry::None)
    };
    let contradiction = |stated: String| ErrorKind::Contradiction {
        first: stated,
        second: format!("{} planes from {first}° to {last}°", angles.len()),
    };
    let stated = match table.symmetry {
        None | Some(Symm::Arbitrary) => {
            let Some(told) = told else { return Err(contradiction("no symmetry stated".to_owned())) };
            let message =
                format!("no symmetry stated; {} from the range of the planes ({first}° to {last}°)", words(told));
            findings.push(Finding::info("L302", message).at(table.location.clone()));
            return Ok(told);
        }
        Some(Symm::None) => Symmetry::None,
        Some(Symm::Bi0) => Symmetry::BilateralC0,
        Some(Symm::Bi90) => Symmetry::BilateralC90,
        Some(Symm::Quad) => Symmetry::Quadrant,
        Some(Symm::Full) => Symmetry::Rotational,
    };
    match told {
        Some(told) if told == stated => Ok(told),
        // All planes, or the only one there is, need no symmetry to be complete.
        Some(told @ (Symmetry::None | Symmetry::Rotational)) => {
            let message = format!(
                "Symm says {}, but the planes ({first}° to {last}°) are {}; the planes were taken",
                words(stated),
                words(told)
            );
            findings.push(Finding::warning("L303", message).at(table.location.clone()));
            Ok(told)
        }
        _ => Err(contradiction(format!("Symm: {}", words(stated)))),
    }
}

fn words(symmetry: Symmetry) -> &'static str {
    match symmetry {
        Symmetry::Rotational => "one plane for all",
        Symmetry::Quadrant => "symmetry in quadrants",
        Symmetry::BilateralC0 => "symmetry about C0–C180",
        Symmetry::BilateralC90 => "symmetry about C90–C270",
        Symmetry::None => "no symmetry",
    }
}

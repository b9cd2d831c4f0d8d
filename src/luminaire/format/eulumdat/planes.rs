//! Between the planes of a file and the model's [`Distribution`].

use super::super::error::Error;
use super::parse::SAME_DEG;
use super::{Eulumdat, Isym, Stored};
use crate::finding::{Checked, Finding, Location};
use crate::luminaire::{Distribution, Symmetry, System};

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_DEG
}

/// The table of a file in candela: each value times `scale`.
pub(super) fn distribution(file: &Eulumdat, scale: f64) -> Result<Checked<Distribution>, Error> {
    let mut findings = Vec::new();
    let mut reordered = false;
    let mut gamma = file.gamma_angles_deg.clone();
    let down = gamma.len() > 1 && gamma[1] < gamma[0];
    if down {
        gamma.reverse();
        reordered = true;
    }
    let plane = |stored: usize| -> Vec<f64> {
        let row = &file.intensities_cd_per_klm[stored * file.gamma_count..(stored + 1) * file.gamma_count];
        let mut row: Vec<f64> = row.iter().map(|v| v * scale).collect();
        if down {
            row.reverse();
        }
        row
    };
    let listed: Vec<f64> = match &file.stored {
        Stored::One => vec![0.0],
        Stored::All => file.plane_angles_deg.clone(),
        Stored::Some(indices) => indices.iter().map(|&i| file.plane_angles_deg[i]).collect(),
    };
    let mut symmetry = match (&file.stored, file.symmetry) {
        (Stored::One, _) => Symmetry::Rotational,
        (Stored::All, _) | (_, Isym::None | Isym::Vertical) => Symmetry::None,
        (_, Isym::C0C180) => Symmetry::BilateralC0,
        (_, Isym::C90C270) => Symmetry::BilateralC90,
        (_, Isym::Both) => Symmetry::Quadrant,
    };
    if symmetry == Symmetry::None && listed.len() == 1 {
        symmetry = Symmetry::Rotational;
        let message = "Isym 0 (no symmetry) with a single plane; taken as symmetric about the vertical axis";
        findings.push(Finding::warning("L210", message).at(Location::line(3)));
    }
    let has_zero = listed.iter().any(|a| same(*a, 0.0));
    let folded = |a: f64| match symmetry {
        Symmetry::Rotational => 0.0,
        // C270 … C0 … C90 stand for their mirror images C270 … C180 … C90.
        Symmetry::BilateralC90 if !(90.0 - SAME_DEG..=270.0 + SAME_DEG).contains(&a.rem_euclid(360.0)) => {
            (180.0 - a).rem_euclid(360.0)
        }
        _ if same(a, 360.0) && has_zero => 360.0,
        _ => a.rem_euclid(360.0),
    };
    let mut planes: Vec<(f64, Vec<f64>)> = listed.iter().enumerate().map(|(i, &a)| (folded(a), plane(i))).collect();
    if symmetry != Symmetry::BilateralC90 && planes.windows(2).any(|w| w[1].0 < w[0].0) {
        reordered = true;
    }
    planes.sort_by(|a, b| a.0.total_cmp(&b.0));
    if symmetry == Symmetry::None && planes[0].0 > SAME_DEG {
        planes.insert(0, (0.0, between(&planes)));
        reordered = true;
    }
    if reordered {
        let message = "angles do not ascend from 0°; the planes were put in order";
        findings.push(Finding::info("L207", message).at(Location::line(27 + 6 * file.lamp_sets.len() as u64 + 10)));
    }
    let (horizontal, values): (Vec<f64>, Vec<Vec<f64>>) = planes.into_iter().unzip();
    let table = Distribution::new(System::TypeC, symmetry, horizontal, gamma, values.concat())
        .map_err(|error| Error::new(Location::default(), error))?;
    Ok(Checked { value: table, findings })
}

/// The plane C0 between the last and the first one listed, which the table is interpolated by anyway.
fn between(planes: &[(f64, Vec<f64>)]) -> Vec<f64> {
    let (first, last) = (&planes[0], &planes[planes.len() - 1]);
    let t = (360.0 - last.0) / (360.0 - last.0 + first.0);
    last.1.iter().zip(&first.1).map(|(a, b)| a + t * (b - a)).collect()
}

/// Planes to be written.
pub(super) struct PlaneSet {
    pub(super) symmetry: Isym,
    /// All C-planes of the full turn, ascending from 0°.
    pub(super) angles_deg: Vec<f64>,
    /// Intensities of the stored planes, in the format's order.
    pub(super) rows: Vec<Vec<f64>>,
    /// Planes that were interpolated to make the set what Isym asks for.
    pub(super) added: usize,
}

/// The planes of a Type C table as the format stores them.
pub(super) fn plane_set(table: &Distribution) -> PlaneSet {
    let given = table.horizontal_deg();
    let row = |c: f64| -> Vec<f64> {
        match given.iter().position(|a| same(*a, c)) {
            Some(i) => table.plane(i).to_vec(),
            None => table.vertical_deg().iter().map(|v| table.at(c, *v)).collect(),
        }
    };
    let mirrored = |axis: f64, angles: &[f64]| {
        let mut all: Vec<f64> = angles.to_vec();
        all.extend(angles.iter().map(|a| (2.0 * axis - a).rem_euclid(360.0)));
        ordered(all)
    };
    match table.symmetry() {
        Symmetry::Rotational => {
            PlaneSet { symmetry: Isym::Vertical, angles_deg: vec![0.0], rows: vec![table.plane(0).to_vec()], added: 0 }
        }
        Symmetry::None => {
            let angles_deg = ordered(given.iter().map(|a| a.rem_euclid(360.0)).collect());
            let rows = angles_deg.iter().map(|c| row(*c)).collect();
            PlaneSet { symmetry: Isym::None, angles_deg, rows, added: 0 }
        }
        Symmetry::BilateralC0 => PlaneSet {
            symmetry: Isym::C0C180,
            angles_deg: mirrored(0.0, given),
            rows: given.iter().map(|c| row(*c)).collect(),
            added: 0,
        },
        Symmetry::Quadrant => PlaneSet {
            symmetry: Isym::Both,
            angles_deg: mirrored(0.0, &mirrored(90.0, given)),
            rows: given.iter().map(|c| row(*c)).collect(),
            added: 0,
        },
        Symmetry::BilateralC90 => {
            // The format finds C270 as plane 3 Mc/4 + 1: the planes need to be the same in all quadrants, C0 among them.
            let half = ordered(given.iter().flat_map(|a| [*a, 360.0 - a]).chain([180.0]).collect());
            let rows = half.iter().rev().map(|c| row(*c)).collect();
            PlaneSet {
                symmetry: Isym::C90C270,
                angles_deg: mirrored(90.0, &half),
                rows,
                added: half.len() - given.len(),
            }
        }
    }
}

/// Ascending, each once.
fn ordered(mut angles: Vec<f64>) -> Vec<f64> {
    // Angles come from decimals of a file: what mirroring adds in the last bits is taken off.
    for a in &mut angles {
        *a = (*a * 1e6).round() / 1e6;
        if *a >= 360.0 {
            *a -= 360.0;
        }
    }
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| same(*a, *b));
    angles
}

/// The distance of angles that are equally spaced over `turn` degrees if one is given (C-planes), else 0.
pub(super) fn step(angles: &[f64], turn: Option<f64>) -> f64 {
    if angles.len() < 2 {
        return 0.0;
    }
    let step = match turn {
        Some(turn) => turn / angles.len() as f64,
        None => (angles[angles.len() - 1] - angles[0]) / (angles.len() - 1) as f64,
    };
    let even = angles.iter().enumerate().all(|(i, a)| (a - angles[0] - step * i as f64).abs() <= SAME_DEG);
    if even { (step * 1e6).round() / 1e6 } else { 0.0 }
}

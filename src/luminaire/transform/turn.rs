//! A luminaire turned about its axes, converted between Types A, B and C, or sampled on another grid: all one sampling, so
//! that nothing is resampled twice.

use glam::{DQuat, DVec3};

use super::super::distribution::{Distribution, Interpolation, Symmetry, System};
use super::super::model::Luminaire;
use super::grid::{Grid, Resampling, Target, affordable, whole_range};
use super::planes::{folded, range, rotated, rotated_planes, tabulated};
use super::{Change, Error, facts, percent};
use crate::finding::{Checked, Finding};

/// A rotation of a luminaire, in its own frame: first about the vertical axis, then the tilt.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Turn {
    /// About the vertical axis, degrees: what was at C is at C plus this.
    pub about_axis_deg: f64,
    /// By how much the photometric axis (nadir) is raised, degrees.
    pub tilt_deg: f64,
    /// Towards which C-plane it is raised, degrees.
    pub tilt_towards_deg: f64,
}

/// More light than this share behind a Type A or B table is refused; less counts as change of flux.
const MOST_BEHIND: f64 = 1e-3;
/// Steps of the Type C table by which the light behind is summed, degrees.
const BEHIND_STEPS_DEG: (f64, f64) = (5.0, 1.0);

impl Turn {
    /// The rotation that takes a direction of the luminaire as it was to where it points afterwards.
    #[must_use]
    pub fn rotation(&self) -> DQuat {
        let (sin, cos) = self.tilt_towards_deg.to_radians().sin_cos();
        let tilt = DQuat::from_axis_angle(DVec3::new(sin, -cos, 0.0), self.tilt_deg.to_radians());
        tilt * DQuat::from_rotation_z(self.about_axis_deg.to_radians())
    }

    fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        if self.about_axis_deg != 0.0 {
            words.push(format!("turned by {}° about the vertical axis", self.about_axis_deg));
        }
        if self.tilt_deg != 0.0 {
            words.push(format!("tilted by {}° towards C{}", self.tilt_deg, self.tilt_towards_deg));
        }
        words
    }

    fn check(&self) -> Result<(), Error> {
        let angles =
            [("rotation", self.about_axis_deg), ("tilt", self.tilt_deg), ("tilt towards", self.tilt_towards_deg)];
        match angles.into_iter().find(|(_, angle)| !angle.is_finite()) {
            Some((what, found)) => Err(Error::Argument { what, found, expected: "a finite angle in degrees" }),
            None => Ok(()),
        }
    }
}

/// The luminaire turned, in the photometric type asked for, on the grid asked for.
///
/// A Type C table that is only turned about its axis keeps its values: its planes are moved, and one is put at C0 where none
/// comes to lie, which changes no value of the bilinear intensity. A table that stays in its own angles and gets another grid is
/// read at the grid's angles. Everything else is read at the directions of the grid, through the rotation. Flux, lamps and power
/// stay; the opening and the housing are turned where that is known to be a body again.
///
/// # Errors
/// [`Error::Behind`] for Types A and B with more than 0.1 % of the flux behind the luminaire; [`Error::Argument`],
/// [`Error::TooLarge`] and [`Error::Table`] for angles and grids that cannot be.
pub fn turn(
    luminaire: &Luminaire,
    turn: &Turn,
    system: System,
    resampling: &Resampling,
) -> Result<Checked<Luminaire>, Error> {
    turn.check()?;
    let before = &luminaire.distribution;
    let mut words = turn.words();
    if system != before.system() {
        words.push(format!("converted from {} to {}", name(before.system()), name(system)));
    }
    let plain = turn.tilt_deg == 0.0 && system == before.system();
    let exact = plain && (system == System::TypeC || turn.about_axis_deg == 0.0);
    let mut findings = Vec::new();
    let mut after = if exact {
        let turned = rotated(before, if system == System::TypeC { turn.about_axis_deg } else { 0.0 })?;
        if turn.about_axis_deg != 0.0 {
            let what = format!("{}; the planes were moved, all entries kept", words.join(", "));
            findings.push(match before.interpolation() {
                Interpolation::Bilinear => Finding::info("L402", what),
                // A plane more at C0 bends the cubic beside it.
                Interpolation::MonotoneCubic => Change::between(before, &turned).finding("L402", &what),
            });
        }
        match &resampling.grid {
            None => turned,
            Some(grid) => {
                let table = resampled(&turned, grid)?;
                let what = format!("resampled ({})", grid.words());
                findings.push(Change::between(before, &table).finding("L401", &what));
                table
            }
        }
    } else {
        let (table, grid) = sampled(before, turn, system, resampling)?;
        let what = format!("{}; sampled ({})", words.join(", "), grid.words());
        findings.push(Change::between(before, &table).finding("L401", &what));
        table
    };
    let flux = after.total_flux();
    let scaled = resampling.keep_flux && flux != 0.0 && flux != before.total_flux();
    if scaled {
        let factor = before.total_flux() / flux;
        after = after.scaled(factor);
        let peak = percent(Change::between(before, &after).peak);
        findings.push(Finding::info("L401", format!("multiplied by {factor:.9} to keep the flux; peak {peak}")));
    }
    let mut value = Luminaire { distribution: after, ..luminaire.clone() };
    if !exact || resampling.grid.is_some() {
        facts::drop_angular_spectra(&mut value, &mut findings);
    } else if turn.about_axis_deg != 0.0
        && let Some(spectra) = &luminaire.angular_spectra
    {
        value.angular_spectra = Some(spectra.map(|table| rotated_planes(table, turn.about_axis_deg))?);
    }
    facts::generated(&mut value, !exact || resampling.grid.is_some(), scaled);
    if turn.about_axis_deg != 0.0 || turn.tilt_deg != 0.0 {
        facts::turned(&mut value, turn, &mut findings);
    }
    Ok(Checked { value, findings })
}

fn name(system: System) -> &'static str {
    match system {
        System::TypeA => "Type A",
        System::TypeB => "Type B",
        System::TypeC => "Type C",
    }
}

/// A table at other angles of its own; the symmetry stays where the planes asked for reach as far as it needs.
fn resampled(d: &Distribution, grid: &Grid) -> Result<Distribution, Error> {
    let v = d.vertical_deg();
    let vertical = grid.vertical.angles("vertical angle", (v[0], v[v.len() - 1]))?;
    let (symmetry, ends) = match (d.system(), d.symmetry()) {
        (System::TypeC, symmetry) => (symmetry, range(symmetry)),
        (_, symmetry) => (symmetry, (d.horizontal_deg()[0], d.horizontal_deg()[d.horizontal_deg().len() - 1])),
    };
    let horizontal = match (symmetry, grid.horizontal.angles("C-plane", ends)) {
        (Symmetry::Rotational, _) => d.horizontal_deg().to_vec(),
        (_, Ok(angles)) if angles.first() == Some(&ends.0) && angles.last() == Some(&ends.1) => angles,
        _ => {
            let all = grid.horizontal.angles("horizontal angle", whole_range(d.system())[0])?;
            affordable(all.len(), vertical.len())?;
            let table = tabulated((d.system(), Symmetry::None), all, &vertical, |h, v| d.at(h, v))?;
            return Ok(folded(&table.with_interpolation(d.interpolation()))?);
        }
    };
    affordable(horizontal.len(), vertical.len())?;
    let table = tabulated((d.system(), symmetry), horizontal, &vertical, |h, v| d.at(h, v))?;
    Ok(table.with_interpolation(d.interpolation()))
}

/// A table read through a rotation, and the grid it was read on.
fn sampled(
    before: &Distribution,
    turn: &Turn,
    system: System,
    resampling: &Resampling,
) -> Result<(Distribution, Grid), Error> {
    let rotation = turn.rotation();
    let back = rotation.inverse();
    let from_behind = turn.tilt_deg != 0.0 || before.system() == System::TypeC;
    // A table of one value per direction: angles and directions of any system are those of an empty one.
    let frame = |system: System| {
        let (symmetry, h) = if system == System::TypeC {
            (Symmetry::None, vec![0.0, 360.0])
        } else {
            (Symmetry::None, vec![-90.0, 90.0])
        };
        tabulated((system, symmetry), h, &[0.0], |_, _| 0.0)
    };
    let own = frame(system)?;
    let value = |h: f64, v: f64| before.towards(back * own.direction(h, v));
    let (_, h, v) = before.peak();
    let peak_deg = own.angles(rotation * before.direction(h, v));
    let mut range = whole_range(system);
    if system == System::TypeC && !from_behind {
        // Types A and B look at one half space.
        range[1].1 = 90.0;
    }
    let target = Target { system, range, value: &value, source: before, peak_deg };
    if system != System::TypeC && from_behind {
        refuse_light_behind(before, back, &frame(System::TypeC)?)?;
    }
    let (table, grid) = match &resampling.grid {
        Some(grid) => (target.on(grid)?, grid.clone()),
        None => target.found()?,
    };
    Ok((folded(&without_dark_rows(&table)?)?, grid))
}

fn refuse_light_behind(before: &Distribution, back: DQuat, frame: &Distribution) -> Result<(), Error> {
    let value = |c: f64, g: f64| before.towards(back * frame.direction(c, g));
    let range = whole_range(System::TypeC);
    let target = Target { system: System::TypeC, range, value: &value, source: before, peak_deg: (0.0, 0.0) };
    let table = target.on(&Grid::steps(BEHIND_STEPS_DEG.0, BEHIND_STEPS_DEG.1))?;
    let share = table.flux_between(90.0, 180.0) / table.total_flux();
    if share > MOST_BEHIND { Err(Error::Behind { share }) } else { Ok(()) }
}

/// A Type C table without the rows above the horizontal where there is no light.
fn without_dark_rows(d: &Distribution) -> Result<Distribution, Error> {
    let v = d.vertical_deg();
    let Some(level) = v.iter().position(|g| *g == 90.0).filter(|_| d.system() == System::TypeC) else {
        return Ok(d.clone());
    };
    let planes = d.horizontal_deg().len();
    if (0..planes).any(|p| d.plane(p)[level + 1..].iter().any(|value| *value != 0.0)) {
        return Ok(d.clone());
    }
    let table = tabulated((d.system(), d.symmetry()), d.horizontal_deg().to_vec(), &v[..=level], |h, g| d.at(h, g))?;
    Ok(table.with_interpolation(d.interpolation()))
}

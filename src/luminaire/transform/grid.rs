//! Grids of directions, and the table of an intensity on them.

use super::super::distribution::{Distribution, System};
use super::planes::{ascending, folded, images, snapped, tabulated};
use super::{Change, Error, MOST_VALUES, TOLERANCE};
use crate::luminaire::Symmetry;

/// One angle of a grid, degrees.
#[derive(Debug, Clone, PartialEq)]
pub enum Axis {
    /// Equal steps from the first angle of the range to the last, which is there in any case.
    Step(f64),
    /// These angles.
    List(Vec<f64>),
}

/// The directions of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// C-planes, or horizontal angles of Types A and B.
    pub horizontal: Axis,
    /// γ, or vertical angles.
    pub vertical: Axis,
}

/// How a table is sampled.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Resampling {
    /// The grid; `None` lets steps be found that keep the flux within [`TOLERANCE`], and puts the peak on the grid.
    pub grid: Option<Grid>,
    /// Multiply the table so that its flux is exactly that of the intensity sampled: the peak then changes by what the flux did.
    pub keep_flux: bool,
}

/// Steps that are tried, degrees: each divides a quarter turn.
const LADDER_DEG: [f64; 6] = [5.0, 2.5, 1.0, 0.5, 0.25, 0.125];
/// C-planes are no nearer than this many steps of γ at first: they converge at the poles.
const FIRST_C_STEP_DEG: f64 = 5.0;
/// A grid of steps found has at most this many values: 0.5° × 0.5° over the sphere.
const MOST_FOUND: usize = 721 * 361;

/// Ends of a system's angles, degrees: horizontal, vertical.
pub(super) fn whole_range(system: System) -> [(f64, f64); 2] {
    if system == System::TypeC { [(0.0, 360.0), (0.0, 180.0)] } else { [(-90.0, 90.0); 2] }
}

impl Axis {
    /// The angles in a range.
    pub(super) fn angles(&self, what: &'static str, (low, high): (f64, f64)) -> Result<Vec<f64>, Error> {
        match self {
            Self::List(list) => {
                let listed = ascending(list.clone());
                match listed.iter().find(|a| !(low..=high).contains(*a)) {
                    Some(found) => {
                        Err(Error::Argument { what, found: *found, expected: "angles of the photometric type" })
                    }
                    None => Ok(listed),
                }
            }
            Self::Step(step) if *step > 0.0 && step.is_finite() => {
                let count = ((high - low) / step).floor();
                if count > MOST_VALUES as f64 {
                    return Err(Error::TooLarge { found: count as usize, most: MOST_VALUES });
                }
                let even = (0..=count as usize).map(|i| snapped(low + step * i as f64));
                Ok(ascending(even.chain([high]).collect()))
            }
            Self::Step(step) => Err(Error::Argument { what, found: *step, expected: "a step above 0°" }),
        }
    }

    fn words(&self) -> String {
        match self {
            Self::Step(step) => format!("by {step}°"),
            Self::List(list) => format!("at {} angles", list.len()),
        }
    }
}

impl Grid {
    pub(super) fn words(&self) -> String {
        format!("horizontal {}, vertical {}", self.horizontal.words(), self.vertical.words())
    }

    pub(super) fn steps(horizontal_deg: f64, vertical_deg: f64) -> Self {
        Self { horizontal: Axis::Step(horizontal_deg), vertical: Axis::Step(vertical_deg) }
    }
}

/// Refuses tables of more values than are worth having.
pub(super) fn affordable(horizontal: usize, vertical: usize) -> Result<(), Error> {
    let found = horizontal.saturating_mul(vertical);
    if found > MOST_VALUES { Err(Error::TooLarge { found, most: MOST_VALUES }) } else { Ok(()) }
}

/// An intensity to be sampled in a system.
pub(super) struct Target<'f> {
    pub(super) system: System,
    /// Ends of the angles to be tabulated, degrees: horizontal, vertical.
    pub(super) range: [(f64, f64); 2],
    /// The intensity at native angles of the system.
    pub(super) value: &'f dyn Fn(f64, f64) -> f64,
    /// The table that the intensity is of: its flux, its peak and its finest steps are those to be kept.
    pub(super) source: &'f Distribution,
    /// Where the peak lies in the system.
    pub(super) peak_deg: (f64, f64),
}

impl Target<'_> {
    /// The table on a grid.
    pub(super) fn on(&self, grid: &Grid) -> Result<Distribution, Error> {
        let horizontal = grid.horizontal.angles("horizontal angle", self.range[0])?;
        let vertical = grid.vertical.angles("vertical angle", self.range[1])?;
        self.at(horizontal, vertical)
    }

    fn at(&self, horizontal: Vec<f64>, vertical: Vec<f64>) -> Result<Distribution, Error> {
        affordable(horizontal.len(), vertical.len())?;
        let table = tabulated((self.system, Symmetry::None), horizontal, &vertical, self.value)?;
        Ok(table.with_interpolation(self.source.interpolation()))
    }

    /// The table on a grid of steps no coarser than the source's, halved until the flux is kept, with lines through the peak
    /// where the steps would lose it.
    pub(super) fn found(&self) -> Result<(Distribution, Grid), Error> {
        let own = typical_step(self.source.vertical_deg());
        let first = LADDER_DEG.iter().position(|step| *step <= own + 1e-9).unwrap_or(LADDER_DEG.len() - 1);
        let mut best = None;
        for (halvings, step) in LADDER_DEG[first..].iter().enumerate() {
            let across = if self.system == System::TypeC {
                (FIRST_C_STEP_DEG / 2f64.powi(halvings as i32)).max(*step)
            } else {
                *step
            };
            let grid = Grid::steps(across, *step);
            let angles = [grid.horizontal.angles("", self.range[0])?, grid.vertical.angles("", self.range[1])?];
            if best.is_some() && angles[0].len() * angles[1].len() > MOST_FOUND {
                break;
            }
            let [horizontal, vertical] = angles.clone();
            let mut table = self.at(horizontal, vertical)?;
            if Change::between(self.source, &table).peak < -TOLERANCE {
                let [horizontal, vertical] = angles;
                let with = |list: Vec<f64>, more: Vec<f64>| ascending(list.into_iter().chain(more).collect());
                // With its images, so that a symmetric table stays so.
                let symmetry = folded(&table)?.symmetry();
                let peaks = peaks(self.system, symmetry, self.peak_deg.0);
                table = self.at(with(horizontal, peaks), with(vertical, vec![snapped(self.peak_deg.1)]))?;
            }
            let kept = Change::between(self.source, &table).flux.abs() <= TOLERANCE;
            best = Some((table, grid));
            if kept {
                break;
            }
        }
        // The ladder has one step at least.
        best.ok_or(Error::Dark)
    }
}

/// A horizontal angle and its images in a symmetry.
fn peaks(system: System, symmetry: Symmetry, horizontal_deg: f64) -> Vec<f64> {
    match (system, symmetry) {
        (System::TypeC, _) => images(symmetry, horizontal_deg),
        (_, Symmetry::Quadrant) => vec![snapped(horizontal_deg), snapped(-horizontal_deg)],
        _ => vec![snapped(horizontal_deg)],
    }
}

/// The median distance of neighbouring angles.
fn typical_step(angles: &[f64]) -> f64 {
    let mut steps: Vec<f64> = angles.windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(LADDER_DEG[0])
}

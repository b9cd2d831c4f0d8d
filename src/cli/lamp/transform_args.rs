//! What `lamp convert` does to a luminaire on the way.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::interpolation::{InterpolationArgs, interpolate};
use super::load::load;
use super::settings::Settings;
use crate::cli::Failure;
use crate::finding::{Checked, Finding};
use crate::luminaire::format::File;
use crate::luminaire::transform::{
    Axis, Change, Grid, Part, Resampling, Scale, TOLERANCE, Turn, merge, scale, symmetrise, turn,
};
use crate::luminaire::{Interpolation, Kind, Luminaire, Symmetry, System};

/// Transformations, done in this order: merge, symmetrise, rotate, tilt, type, resample (these four as one), scale.
#[derive(Debug, Args)]
#[command(next_help_heading = "Transformations (in this order)")]
pub(super) struct TransformArgs {
    /// Add luminaires at the same place, each turned and dimmed by itself: `other.ies,rotate=90,dim=0.5`.
    #[arg(long, value_name = "FILE", num_args = 1.., value_parser = merged)]
    merge: Vec<Merged>,
    /// Average of the symmetric images.
    #[arg(long, value_name = "KIND")]
    symmetrise: Option<Kinds>,
    /// Turn about the vertical axis by degrees: what was at C is at C + DEG. Exact for Type C.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    rotate: Option<f64>,
    /// Raise the photometric axis (nadir) by degrees.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    tilt: Option<f64>,
    /// The C-plane towards which the axis is raised.
    #[arg(long, value_name = "C", default_value_t = 0.0, requires = "tilt", allow_negative_numbers = true)]
    tilt_towards: f64,
    /// Photometric type of the result.
    #[arg(long = "type", value_name = "A|B|C", ignore_case = true)]
    system: Option<Type>,
    /// Other angles: C and γ (H and V of Types A and B), each a step in degrees or angles separated by `/`.
    #[arg(long, value_name = "C,GAMMA", value_parser = grid, allow_hyphen_values = true)]
    resample: Option<Grid>,
    /// Multiply a resampled table so that its flux stays exactly; the peak changes instead.
    #[arg(long)]
    keep_flux: bool,
    /// Multiply all intensities, the lamps' and the declared flux.
    #[arg(long, value_name = "FACTOR", conflicts_with = "scale_to")]
    scale: Option<f64>,
    /// The same, to a flux of the luminaire (`800 lm`, `3 W`, `12 umol/s`) or of each of its lamps (`1000 lm/lamp`).
    #[arg(long, value_name = "FLUX", value_parser = amount)]
    scale_to: Option<(f64, Amount)>,
    #[command(flatten)]
    interpolation: InterpolationArgs,
    /// A file with the angles to keep and the interpolation, as `trade lamp --settings` writes it; the angles are left out first.
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
}

/// Symmetries to be had.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kinds {
    /// About the vertical axis.
    Rotational,
    /// About C0–C180 and C90–C270.
    Quadrant,
    /// About C0–C180.
    BilateralC0,
    /// About C90–C270.
    BilateralC90,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
#[value(rename_all = "verbatim")]
enum Type {
    /// H about the vertical axis, V a latitude: automotive and signal lamps.
    A,
    /// V about the horizontal axis, H a latitude: floodlights.
    B,
    /// C about the vertical axis, γ from nadir: everything else.
    C,
}

/// A luminaire to be added.
#[derive(Debug, Clone)]
struct Merged {
    path: String,
    rotate_deg: f64,
    dim: f64,
}

/// What a flux is of.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Amount {
    Whole(Kind),
    PerLamp,
}

fn merged(text: &str) -> Result<Merged, String> {
    let mut out = Merged { path: text.to_owned(), rotate_deg: 0.0, dim: 1.0 };
    // From the end, for a name may have commas.
    while let Some((path, item)) = out.path.rsplit_once(',') {
        let Some((key, value)) = item.split_once('=') else { break };
        let place = match key {
            "rotate" => &mut out.rotate_deg,
            "dim" => &mut out.dim,
            _ => break,
        };
        *place = value.parse().map_err(|_| format!("`{value}` is no number; expected {key}=NUMBER"))?;
        out.path = path.to_owned();
    }
    Ok(out)
}

fn grid(text: &str) -> Result<Grid, String> {
    let axis = |text: &str| -> Result<Axis, String> {
        let numbers: Result<Vec<f64>, _> = text.split('/').map(|t| t.trim().parse::<f64>()).collect();
        let numbers = numbers.map_err(|_| format!("`{text}` is no step and no list of angles"))?;
        Ok(if let [step] = numbers[..] { Axis::Step(step) } else { Axis::List(numbers) })
    };
    let (c, gamma) = text.split_once(',').ok_or_else(|| {
        format!("`{text}`: expected C and γ separated by a comma, such as `15,2.5` or `15,0/10/30/90`")
    })?;
    Ok(Grid { horizontal: axis(c)?, vertical: axis(gamma)? })
}

fn amount(text: &str) -> Result<(f64, Amount), String> {
    let end = text.find(|c: char| c.is_whitespace() || (c.is_alphabetic() && c != 'e' && c != 'E') || c == 'µ');
    let (number, unit) = text.split_at(end.unwrap_or(text.len()));
    let expected = "expected a flux such as `800 lm`, `1000 lm/lamp`, `3 W` or `12 umol/s`";
    let value: f64 = number.parse().map_err(|_| format!("`{number}` is no number; {expected}"))?;
    let amount = match unit.trim() {
        "lm" => Amount::Whole(Kind::Luminous),
        "lm/lamp" => Amount::PerLamp,
        "W" => Amount::Whole(Kind::Radiant),
        "umol/s" | "µmol/s" | "μmol/s" => Amount::Whole(Kind::Photon),
        other => return Err(format!("`{other}` is no unit of flux; {expected}")),
    };
    Ok((value, amount))
}

impl TransformArgs {
    /// Other files that are read: they must not be overwritten.
    pub(super) fn inputs(&self) -> impl Iterator<Item = &str> {
        self.merge.iter().map(|other| other.path.as_str()).chain(self.settings.iter().filter_map(|p| p.to_str()))
    }

    /// The luminaire of a file with all that was asked for done to it. Tables are written as they are; a reader takes them as
    /// bilinear, and so does the result.
    pub(super) fn apply(&self, mut file: File, repair: bool) -> Result<Checked<Luminaire>, Failure> {
        let message = |error: &dyn std::fmt::Display| Failure::Message(error.to_string());
        let settings = Settings::read(self.settings.as_deref())?;
        let interpolation = self.interpolation.or(settings.interpolation);
        let mut findings = Vec::new();
        interpolate(&mut file, interpolation);
        let mut lamp = noted(settings.thin(&file.luminaire)?, &mut findings);
        if !self.merge.is_empty() {
            let mut others = Vec::with_capacity(self.merge.len());
            for other in &self.merge {
                let mut loaded = load(&other.path, repair).file.map_err(|(message, _)| Failure::Message(message))?;
                findings.extend(loaded.findings);
                interpolate(&mut loaded.value, interpolation);
                others.push(loaded.value.luminaire);
            }
            let first = Part { luminaire: &lamp, rotate_deg: 0.0, dim: 1.0 };
            let rest = self.merge.iter().zip(&others);
            let rest = rest.map(|(m, luminaire)| Part { luminaire, rotate_deg: m.rotate_deg, dim: m.dim });
            let parts: Vec<Part<'_>> = std::iter::once(first).chain(rest).collect();
            lamp = noted(merge(&parts).map_err(|e| message(&e))?, &mut findings);
        }
        if let Some(kind) = self.symmetrise {
            let symmetry = match kind {
                Kinds::Rotational => Symmetry::Rotational,
                Kinds::Quadrant => Symmetry::Quadrant,
                Kinds::BilateralC0 => Symmetry::BilateralC0,
                Kinds::BilateralC90 => Symmetry::BilateralC90,
            };
            lamp = noted(symmetrise(&lamp, symmetry).map_err(|e| message(&e))?, &mut findings);
        }
        let system = match self.system {
            None => lamp.distribution.system(),
            Some(Type::A) => System::TypeA,
            Some(Type::B) => System::TypeB,
            Some(Type::C) => System::TypeC,
        };
        let by = Turn {
            about_axis_deg: self.rotate.unwrap_or(0.0),
            tilt_deg: self.tilt.unwrap_or(0.0),
            tilt_towards_deg: self.tilt_towards,
        };
        let resampling = Resampling { grid: self.resample.clone(), keep_flux: self.keep_flux };
        lamp = noted(turn(&lamp, &by, system, &resampling).map_err(|e| message(&e))?, &mut findings);
        if let Some(by) = self.scaling(lamp.kind)? {
            lamp = noted(scale(&lamp, &by).map_err(|e| message(&e))?, &mut findings);
        }
        if interpolation != Interpolation::Bilinear {
            let bilinear = lamp.distribution.clone().with_interpolation(Interpolation::Bilinear);
            let change = Change::between(&lamp.distribution, &bilinear).flux;
            if change.abs() > TOLERANCE {
                let message = format!(
                    "no format says how its tables are interpolated: read bilinearly, the flux is {:+.3} % of this one off",
                    100.0 * change
                );
                findings.push(Finding::warning("L408", message).hint("resample to smaller steps"));
            }
            lamp.distribution = bilinear;
        }
        Ok(Checked { value: lamp, findings })
    }

    fn scaling(&self, kind: Kind) -> Result<Option<Scale>, Failure> {
        match (self.scale, self.scale_to) {
            (Some(factor), _) => Ok(Some(Scale::Factor(factor))),
            (None, Some((flux, Amount::PerLamp))) => Ok(Some(Scale::FluxPerLamp(flux))),
            (None, Some((flux, Amount::Whole(of)))) if of == kind => Ok(Some(Scale::Flux(flux))),
            (None, Some((_, Amount::Whole(of)))) => {
                let message = format!(
                    "--scale-to: a {of:?} flux of a luminaire with {kind:?} intensities; expected its own unit"
                );
                Err(Failure::Message(message))
            }
            (None, None) => Ok(None),
        }
    }
}

fn noted(checked: Checked<Luminaire>, findings: &mut Vec<Finding>) -> Luminaire {
    findings.extend(checked.findings);
    checked.value
}

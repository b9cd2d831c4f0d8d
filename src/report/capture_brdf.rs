//! A BRDF from photographs as JSON, table and text.

use std::f64::consts::FRAC_1_PI;
use std::fmt::Write;
use std::sync::Arc;

use serde_json::{Map, Value, json};

use super::brdf_fit;
use crate::brdf::table::{Channel, Known};
use crate::capture::brdf::{Bin, Binned, Counts, Filled, Observations, Seen};
use crate::capture::lamp::Pattern;
use crate::capture::setup::Place;
use crate::geometry::direction;
use crate::units::significant;

/// Median of f_r that a relative result is brought to, 1/sr.
pub const RELATIVE_MEDIAN: f64 = 0.3 * FRAC_1_PI;

/// What a picture gave.
#[derive(Debug, Clone, PartialEq)]
pub struct StackSeen {
    /// The stack.
    pub name: String,
    /// Its light by name.
    pub light: String,
    /// Where that is.
    pub place: Place,
    /// How that shines, where it does not shine alike to all sides.
    pub pattern: Option<Arc<Pattern>>,
    /// What became of the pixels.
    pub counts: Counts,
    /// Strength of the light per band, over the radiance of a sample of 1 at 1 s.
    pub strength: Vec<f64>,
    /// Median of |measured/modelled − 1| of the best fit, where there is one.
    pub deviation: Option<f64>,
}

/// What the absolute values rest on.
#[derive(Debug, Clone, PartialEq)]
pub enum Scale {
    /// A diffuse object of known reflectance in the place of the other.
    Reference {
        /// Its reflectance.
        reflectance: Vec<f64>,
        /// Relative standard uncertainty of the scale from that of the reflectance, which all values have in common.
        factor_sd: Vec<f64>,
        /// The largest relative standard error of a light's strength, which the values under that light have in common.
        light_sd: f64,
        /// How far it was from diffuse, relative.
        deviation_rms: f64,
    },
    /// Stated strengths of the lights.
    Strengths {
        /// Radiance of a sample of 1 at 1 s.
        unit_w_per_m2_sr: f64,
    },
    /// Nothing: multiplied by a factor that makes the median [`RELATIVE_MEDIAN`].
    Relative {
        /// The factor.
        factor: f64,
    },
}

/// Bins that were filled on request, and by what.
#[derive(Debug, Clone, PartialEq)]
pub struct Filling {
    /// By what.
    pub by: FilledBy,
    /// The table.
    pub filled: Filled,
}

/// What bins were filled by.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FilledBy {
    /// A fitted model, by its name.
    Model(String),
    /// Principal components, by the checksum of their basis.
    Basis(String),
}

impl std::fmt::Display for FilledBy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Model(name) => write!(f, "the model {name}"),
            Self::Basis(checksum) => write!(f, "the principal components of basis {checksum}"),
        }
    }
}

impl Filling {
    /// Bins measured, inferred and missing.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        [Known::Measured, Known::Inferred, Known::Missing].map(|k| self.filled.count(k))
    }

    fn object(&self) -> Value {
        let [measured, inferred, missing] = self.counts();
        let (kind, key, name) = match &self.by {
            FilledBy::Model(name) => ("model", "model", name),
            FilledBy::Basis(checksum) => ("pca", "basis", checksum),
        };
        json!({
            "kind": kind, key: name, "measured_bins": measured, "inferred_bins": inferred, "missing_bins": missing,
            "inferred_fraction": inferred as f64 / (measured + inferred) as f64,
        })
    }
}

/// Everything there is to tell.
#[derive(Debug, Clone, Copy)]
pub struct Answer<'a> {
    /// What the object is: `sphere`.
    pub object: &'a str,
    /// The pictures.
    pub seen: &'a [StackSeen],
    /// What absolute values rest on.
    pub scale: &'a Scale,
    /// The measurements, or an even draw of very many.
    pub all: &'a Observations,
    /// How many there were.
    pub measurements: usize,
    /// The same in bins.
    pub binned: &'a Binned,
    /// The bins that were filled, where that was asked for.
    pub filling: Option<&'a Filling>,
    /// Fits, where one succeeded.
    pub fits: Option<&'a brdf_fit::Answer<'a>>,
}

fn counts(counts: &Counts) -> Value {
    counts.named().into_iter().map(|(name, n)| (name.to_owned(), n.into())).collect::<Map<String, Value>>().into()
}

pub(super) fn total(seen: &[StackSeen]) -> Vec<(&'static str, usize)> {
    let mut all: Vec<(&'static str, usize)> = Counts::default().named().to_vec();
    for s in seen {
        all.iter_mut().zip(s.counts.named()).for_each(|(a, (_, n))| a.1 += n);
    }
    all
}

/// The result as JSON.
#[must_use]
pub fn object(a: &Answer<'_>) -> Value {
    let stack = |s: &StackSeen| {
        let mut out = json!({"stack": s.name, "pixels": counts(&s.counts)});
        if let Some(deviation) = s.deviation {
            out["deviation_median_relative"] = deviation.into();
        }
        out
    };
    let light = |s: &StackSeen| {
        let mut out = json!({"name": s.light, "strength": s.strength});
        match s.place {
            Place::Near(p) => out["position_m"] = json!(p),
            Place::Distant(d) => out["direction"] = json!(d),
        }
        out
    };
    let scale = match a.scale {
        Scale::Reference { reflectance, factor_sd, light_sd, deviation_rms } => json!({
            "kind": "reference", "absolute": true, "reflectance": reflectance, "reference_factor_sd": factor_sd,
            "light_factor_sd": light_sd, "deviation_rms": deviation_rms,
        }),
        Scale::Strengths { unit_w_per_m2_sr } => {
            json!({"kind": "strengths", "absolute": true, "unit_w_per_m2_sr": unit_w_per_m2_sr})
        }
        Scale::Relative { factor } => json!({"kind": "relative", "absolute": false, "factor": factor}),
    };
    let sum: Map<String, Value> = total(a.seen).into_iter().map(|(name, n)| (name.to_owned(), n.into())).collect();
    let channels: Vec<String> = a.all.channels.iter().map(Channel::to_string).collect();
    let mut out = json!({
        "object": a.object,
        "bands": channels,
        "scale": scale,
        "lights": a.seen.iter().map(light).collect::<Vec<_>>(),
        "stacks": a.seen.iter().map(stack).collect::<Vec<_>>(),
        "pixels": sum,
        "measurements": a.measurements,
        "standard_errors_stated": a.all.has_errors(),
        "bins": {
            "above_horizon": a.binned.above_horizon, "covered": a.binned.covered,
            "rejected_measurements": a.binned.bins.iter().map(|b| b.rejected).sum::<usize>(),
        },
        "coverage_fraction": a.binned.coverage_fraction(),
        "fits": [],
    });
    if a.all.len() < a.measurements {
        out["drawn_measurements"] = a.all.len().into();
    }
    if let Some(filling) = a.filling {
        out["filled"] = filling.object();
    }
    if let (Some(fits), Value::Object(out)) = (a.fits, &mut out) {
        let mut of = brdf_fit::object(fits);
        for key in ["fits", "best", "comparison"] {
            if let Some(value) = of.remove(key) {
                out.insert(key.to_owned(), value);
            }
        }
    }
    out
}

/// The header of the table of all measurements.
#[must_use]
pub fn measurements_header(channels: &[Channel]) -> String {
    let mut out = String::from("stack,x,y,theta_i_deg,theta_o_deg,phi_deg");
    // Writing to a string cannot fail.
    for channel in channels {
        let _ = write!(out, ",f_{channel}_per_sr,standard_error_{channel}_per_sr");
    }
    out.push('\n');
    out
}

/// A measurement as a row of it, times `factor`; φ is that of the camera less that of the light.
pub fn measurement(out: &mut String, stack: &str, seen: &Seen<'_>, factor: f64) {
    let (x, y) = seen.pixel;
    let phi = (direction::phi(seen.outgoing) - direction::phi(seen.incident)).to_degrees().rem_euclid(360.0);
    let [theta_i, theta_o] = [seen.incident, seen.outgoing].map(|d| direction::theta(d).to_degrees());
    let _ = write!(out, "{stack},{x},{y},{theta_i},{theta_o},{phi}");
    for (value, error) in seen.values.iter().zip(seen.errors) {
        let _ = write!(out, ",{},{}", value * factor, error * factor);
    }
    out.push('\n');
}

/// The bins with values, a row each; where bins were filled, a column tells how each is known.
#[must_use]
pub fn csv(a: &Answer<'_>) -> String {
    let mut out = String::from("theta_h_deg,theta_d_deg,phi_d_deg,measurements,rejected");
    if a.filling.is_some() {
        out.push_str(",known");
    }
    // Writing to a string cannot fail.
    for channel in &a.all.channels {
        let _ = write!(out, ",f_{channel}_per_sr,standard_error_{channel}_per_sr");
    }
    out.push('\n');
    let mut row = |number: usize, bin: Option<&Bin>, known: Option<Known>| {
        let at = a.binned.resolution.centre(number);
        let [h, d, p] = [at.theta_h, at.theta_d, at.phi_d].map(f64::to_degrees);
        let _ = write!(out, "{h},{d},{p},{},{}", bin.map_or(0, |b| b.count), bin.map_or(0, |b| b.rejected));
        if let Some(known) = known {
            let _ = write!(out, ",{known}");
        }
        match (bin, a.filling) {
            (Some(bin), _) => {
                for (value, error) in bin.values.iter().zip(&bin.errors) {
                    let error = if error.is_nan() { String::new() } else { error.to_string() };
                    let _ = write!(out, ",{value},{error}");
                }
            }
            (None, Some(f)) => f.filled.table.bin(number).iter().for_each(|value| {
                let _ = write!(out, ",{value},");
            }),
            (None, None) => {}
        }
        out.push('\n');
    };
    match a.filling {
        None => a.binned.bins.iter().for_each(|b| row(b.bin, Some(b), None)),
        Some(f) => {
            let mut measured = a.binned.bins.iter().peekable();
            for (number, known) in f.filled.known.iter().enumerate().filter(|(_, k)| **k != Known::Missing) {
                row(number, measured.next_if(|b| b.bin == number), Some(*known));
            }
        }
    }
    out
}

/// The result for people.
#[must_use]
pub fn text(a: &Answer<'_>) -> String {
    let mut out = String::new();
    let width = a.seen.iter().map(|s| s.name.chars().count()).max().unwrap_or(0).max(5);
    let _ = write!(out, "{:width$}", "stack");
    // What no pixel is masked for is left out.
    let shown: Vec<bool> = total(a.seen).iter().map(|(name, n)| *n > 0 || *name == "valid").collect();
    for ((name, _), _) in total(&[]).iter().zip(&shown).filter(|(_, s)| **s) {
        let _ = write!(out, "{:>17}", name.replace('_', " "));
    }
    out.push('\n');
    let row = |out: &mut String, name: &str, counts: &[(&str, usize)]| {
        let _ = write!(out, "{name:width$}");
        for ((_, n), _) in counts.iter().zip(&shown).filter(|(_, s)| **s) {
            let _ = write!(out, "{n:>17}");
        }
        out.push('\n');
    };
    for s in a.seen {
        row(&mut out, &s.name, &s.counts.named());
    }
    if a.seen.len() > 1 {
        row(&mut out, "all", &total(a.seen));
    }
    let scale = match a.scale {
        Scale::Reference { factor_sd, .. } => {
            let worst = factor_sd.iter().copied().fold(0.0, f64::max);
            let known =
                if worst > 0.0 { format!(", known to {} %", significant(100.0 * worst, 2)) } else { String::new() };
            format!("absolute, from the reference{known}")
        }
        Scale::Strengths { .. } => "absolute, from the stated strengths of the lights".to_owned(),
        Scale::Relative { .. } => "relative: median f_r set to 0.3/π; reflectances are ratios, not values".to_owned(),
    };
    let r = a.binned.resolution;
    let _ = writeln!(
        out,
        "\nscale     {scale}\nbins      {} of {} above the horizon measured ({:.3} %), of {} × {} × {} in θh, θd, φd\n",
        a.binned.covered,
        a.binned.above_horizon,
        100.0 * a.binned.coverage_fraction(),
        r.theta_h,
        r.theta_d,
        r.phi_d
    );
    if let Some(filling) = a.filling {
        let [measured, inferred, _] = filling.counts();
        let _ = writeln!(
            out,
            "filled    {inferred} bins are inferred by {}, beside {measured} measured ones\n",
            filling.by
        );
    }
    if let Some(fits) = a.fits {
        out.push_str(&brdf_fit::text(fits));
    }
    out
}

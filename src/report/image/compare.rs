//! The difference of two images as JSON, CSV and text.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::image::compare::{Difference, Summary};
use crate::image::{Channel, Meaning};
use crate::units::significant;

/// One plane compared.
#[derive(Debug, Clone)]
pub struct Compared {
    /// The channel in the first image, or the photopic quantity.
    pub channel: Channel,
    /// How far the second image is from it.
    pub difference: Difference,
}

/// Colour differences.
#[derive(Debug, Clone)]
pub struct DeltaE {
    /// Y and chromaticity of the white of CIELAB.
    pub white: (f64, [f64; 2]),
    /// ΔE2000, with the quantiles at [`PERCENTILES`].
    pub summary: Summary,
}

/// Percentiles of ΔE2000 that are told.
pub const PERCENTILES: [f64; 3] = [50.0, 95.0, 99.0];

/// All of a comparison.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// The files.
    pub paths: [String; 2],
    /// Columns and rows.
    pub size: (usize, usize),
    /// Bands and other planes.
    pub planes: Vec<Compared>,
    /// The photopic quantity.
    pub luminance: Option<Compared>,
    /// Colour.
    pub delta_e: Option<DeltaE>,
    /// The figure that decides: its name and value, the tolerance, and whether it is met.
    pub verdict: (&'static str, f64, Option<f64>, bool),
}

fn wavelength(channel: &Channel) -> Option<f64> {
    match channel.meaning {
        Meaning::Band { wavelength_nm, .. } => Some(wavelength_nm),
        _ => None,
    }
}

/// A figure that JSON can hold; what has no finite value is absent.
fn put(object: &mut Map<String, Value>, key: &str, value: f64) {
    if value.is_finite() {
        object.insert(key.to_owned(), value.into());
    }
}

fn place(object: &mut Map<String, Value>, key: &str, largest: Option<(f64, [usize; 2])>) {
    if let Some((value, [x, y])) = largest {
        put(object, key, value);
        object.insert(format!("{key}_at"), json!({"x": x, "y": y}));
    }
}

fn number(value: f64) -> String {
    if value.is_finite() { significant(value, 5) } else { "–".to_owned() }
}

impl Compared {
    fn json(&self) -> Value {
        let (channel, d) = (&self.channel, &self.difference);
        let mut row = Map::new();
        row.insert("name".into(), channel.name.as_str().into());
        if let Some(nm) = wavelength(channel) {
            row.insert("wavelength_nm".into(), nm.into());
        }
        row.insert("unit".into(), channel.unit.as_str().into());
        row.insert("pixels".into(), d.pixels.into());
        row.insert("left_out".into(), d.left_out.into());
        put(&mut row, "mean_difference", d.mean());
        put(&mut row, "rmse", d.rmse());
        put(&mut row, "relative_rmse", d.relative_rmse());
        put(&mut row, "mean_relative", d.mean_relative());
        place(&mut row, "max_difference", d.largest);
        place(&mut row, "max_relative", d.largest_relative);
        put(&mut row, "peak", d.peak);
        put(&mut row, "psnr_db", d.psnr_db());
        row.into()
    }
}

impl Comparison {
    /// The result of `image compare --json`.
    #[must_use]
    pub fn json(&self) -> Value {
        let (metric, value, tolerance, passes) = self.verdict;
        let mut out = Map::new();
        out.insert("paths".into(), json!(self.paths));
        out.insert("size_px".into(), json!([self.size.0, self.size.1]));
        out.insert("planes".into(), self.planes.iter().map(Compared::json).collect());
        if let Some(luminance) = &self.luminance {
            out.insert("photopic".into(), luminance.json());
        }
        if let Some(DeltaE { white: (y, xy), summary }) = &self.delta_e {
            let mut colour = Map::new();
            colour.insert("white".into(), json!({"y": y, "chromaticity_xy": xy}));
            colour.insert("pixels".into(), summary.pixels.into());
            colour.insert("left_out".into(), summary.left_out.into());
            put(&mut colour, "mean", summary.mean);
            for (percent, value) in PERCENTILES.iter().zip(&summary.quantiles) {
                put(&mut colour, &format!("p{percent}"), *value);
            }
            place(&mut colour, "max", summary.largest);
            out.insert("delta_e_2000".into(), colour.into());
        }
        out.insert("metric".into(), metric.into());
        put(&mut out, "value", value);
        if let Some(tolerance) = tolerance {
            out.insert("tolerance".into(), tolerance.into());
            out.insert("passes".into(), passes.into());
        }
        out.into()
    }

    /// One row per plane, the photopic quantity last.
    #[must_use]
    pub fn csv(&self) -> Vec<u8> {
        let mut rows = vec![
            [
                "name",
                "wavelength_nm",
                "unit",
                "pixels",
                "left_out",
                "mean_difference",
                "rmse",
                "relative_rmse",
                "mean_relative",
                "max_difference",
                "max_relative",
                "peak",
                "psnr_db",
            ]
            .map(str::to_owned)
            .to_vec(),
        ];
        for Compared { channel, difference: d } in self.planes.iter().chain(&self.luminance) {
            let largest = |l: Option<(f64, [usize; 2])>| l.map_or(f64::NAN, |(v, _)| v);
            let figures = [
                d.mean(),
                d.rmse(),
                d.relative_rmse(),
                d.mean_relative(),
                largest(d.largest),
                largest(d.largest_relative),
                d.peak,
                d.psnr_db(),
            ];
            let cell = |v: f64| if v.is_nan() { String::new() } else { v.to_string() };
            let mut row = vec![
                channel.name.clone(),
                wavelength(channel).map_or_else(String::new, |nm| nm.to_string()),
                channel.unit.clone(),
                d.pixels.to_string(),
                d.left_out.to_string(),
            ];
            row.extend(figures.map(cell));
            rows.push(row);
        }
        super::probe::rows(&rows)
    }

    /// The result as people read it.
    #[must_use]
    pub fn text(&self) -> String {
        let [a, b] = &self.paths;
        let mut out = format!("{b} against {a}: {} × {} pixels\n", self.size.0, self.size.1);
        let percent = |v: f64| if v.is_finite() { format!("{} %", number(100.0 * v)) } else { "–".to_owned() };
        let _ = writeln!(
            out,
            "  {:<16} {:>12} {:>12} {:>12} {:>12} {:>14}  at",
            "plane", "rmse", "relative", "mean rel.", "PSNR, dB", "largest"
        );
        for Compared { channel, difference: d } in self.planes.iter().chain(&self.luminance) {
            let decibels = match d.psnr_db() {
                v if v.is_finite() => format!("{v:.2}"),
                v if v > 0.0 => "∞".to_owned(),
                _ => "–".to_owned(),
            };
            let (largest, at) = d.largest.map_or(("–".into(), String::new()), |(v, [x, y])| {
                (number(v), if v > 0.0 { format!("{x}, {y}") } else { String::new() })
            });
            let _ = writeln!(
                out,
                "  {:<16} {:>12} {:>12} {:>12} {decibels:>12} {largest:>14}  {at}",
                channel.name,
                number(d.rmse()),
                percent(d.relative_rmse()),
                percent(d.mean_relative()),
            );
        }
        if let Some(DeltaE { white: (y, [wx, wy]), summary }) = &self.delta_e {
            let quantiles: Vec<String> =
                PERCENTILES.iter().zip(&summary.quantiles).map(|(p, v)| format!("{p} % {v:.3}")).collect();
            let (largest, at) =
                summary.largest.map_or((f64::NAN, String::new()), |(v, [x, y])| (v, format!(" at {x}, {y}")));
            let _ = writeln!(
                out,
                "  ΔE2000           mean {:.3}, {}, max {largest:.3}{at}\n                   white Y = {}, x, y = {wx:.4}, {wy:.4}",
                summary.mean,
                quantiles.join(", "),
                number(*y)
            );
        }
        let (metric, value, tolerance, passes) = self.verdict;
        if let Some(tolerance) = tolerance {
            let word = if passes { "within" } else { "NOT within" };
            let _ = writeln!(out, "  {metric} = {}: {word} the tolerance {}", number(value), number(tolerance));
        }
        out
    }
}

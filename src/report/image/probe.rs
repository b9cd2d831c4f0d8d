//! `image probe`: figures of parts of an image.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::quantity;
use crate::colorimetry::chromaticity;
use crate::finding::{Finding, Location};
use crate::image::probe::{Line, Measures, Probe, Sample, Shape, Spread};
use crate::image::{Description, Meaning};
use crate::units::significant;

/// What was found in one part of an image, and all that a report says about it.
#[derive(Debug, Clone)]
pub struct Probed {
    path: String,
    name: String,
    /// Name, wavelength (nm) and unit of the channels.
    channels: Vec<(String, Option<f64>, String)>,
    /// Key, name and unit of the photopic quantity.
    photopic: Option<(&'static str, String, String)>,
    percentiles: Vec<f64>,
    part: Part,
}

/// A part of an image and what was found there.
#[derive(Debug, Clone)]
pub enum Part {
    /// A shape.
    Shape {
        /// Which.
        shape: Shape,
        /// Its figures.
        probe: Box<Probe>,
    },
    /// A line.
    Line {
        /// Which.
        line: Line,
        /// Its pixels.
        samples: Vec<Sample>,
    },
}

/// Which table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Table {
    /// Lines where there are any, else spectra where the images have bands, else figures.
    First,
    /// Mean spectra of the shapes.
    Spectra,
    /// Figures of the shapes.
    Figures,
    /// Samples of the lines.
    Profile,
}

impl Probed {
    /// What was found in a part of `image`.
    #[must_use]
    pub fn new(
        path: &str,
        name: String,
        image: &Description,
        measures: &Measures,
        percentiles: &[f64],
        part: Part,
    ) -> Self {
        let channel = |i: &usize| {
            let channel = &image.channels[*i];
            let wavelength_nm = match channel.meaning {
                Meaning::Band { wavelength_nm, .. } => Some(wavelength_nm),
                _ => None,
            };
            (channel.name.clone(), wavelength_nm, channel.unit.clone())
        };
        Self {
            path: path.to_owned(),
            name,
            channels: measures.channels.iter().map(channel).collect(),
            photopic: measures.luminance.as_ref().map(|l| (quantity::key(l), quantity::name(l), l.unit().to_owned())),
            percentiles: percentiles.to_vec(),
            part,
        }
    }

    fn has_bands(&self) -> bool {
        self.channels.first().is_some_and(|c| c.1.is_some())
    }

    /// Pixels that do not count, and why.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        let place = Location::default().in_file(&self.path).of_item(&self.name);
        let mut out = Vec::new();
        match &self.part {
            Part::Shape { probe: p, .. } => {
                let odd = p.nan + p.infinite;
                if odd > 0 {
                    let message = format!(
                        "{odd} of {} pixels have samples that are no numbers ({} NaN, {} infinite) and were left out",
                        p.pixels, p.nan, p.infinite
                    );
                    out.push(Finding::warning("I041", message));
                }
                if let Some(mean) = p.mean_with_negative {
                    let unit = self.photopic.as_ref().map_or("", |(_, _, unit)| unit);
                    let message = format!(
                        "{} of {} pixels are negative and were left out; with them the mean would be {} {unit}",
                        p.negative,
                        p.pixels,
                        significant(mean, 6)
                    );
                    out.push(Finding::warning("I042", message.trim_end().to_owned()));
                }
                if p.counted == 0 {
                    out.push(Finding::error("I043", "no pixel has a value: there are no figures"));
                }
            }
            Part::Line { samples, .. } => {
                let finite = |s: &&Sample| s.channels.iter().chain(&s.luminance).all(|v| v.is_finite());
                let odd = samples.len() - samples.iter().filter(finite).count();
                if odd > 0 {
                    let message = format!("{odd} of {} pixels have samples that are no numbers", samples.len());
                    out.push(Finding::warning("I041", message));
                }
            }
        }
        out.into_iter().map(|f| f.at(place.clone())).collect()
    }

    /// The object in `results[]`.
    #[must_use]
    pub fn json(&self) -> Map<String, Value> {
        let mut out = Map::new();
        let mut set = |key: &str, value: Value| {
            out.insert(key.to_owned(), value);
        };
        set("path", self.path.clone().into());
        set("name", self.name.clone().into());
        match &self.part {
            Part::Shape { shape, probe } => {
                set("shape", shape_json(shape));
                for (key, count) in counts(probe) {
                    set(key, count.into());
                }
                if let Some(solid_angle) = probe.solid_angle_sr {
                    set("solid_angle_sr", solid_angle.into());
                }
                if let Some((key, ..)) = &self.photopic {
                    set(key, probe.luminance.as_ref().map(|l| spread(l, &self.percentiles)).into());
                }
                if let Some(xyz) = probe.xyz {
                    set("xyz", json!(xyz));
                    set("chromaticity_xy", json!(chromaticity::xy(xyz)));
                }
                if self.has_bands() {
                    let wavelengths: Vec<_> = self.channels.iter().filter_map(|c| c.1).collect();
                    let values = (!probe.channels.is_empty()).then_some(&probe.channels);
                    let unit = &self.channels[0].2;
                    set("spectrum", json!({"wavelength_nm": wavelengths, "unit": unit, "values": values}));
                } else {
                    let value = |i: usize| probe.channels.get(i).copied();
                    let channels = self.channels.iter().enumerate();
                    let channels =
                        channels.map(|(i, (name, _, unit))| json!({"name": name, "unit": unit, "mean": value(i)}));
                    set("channels", channels.collect::<Vec<_>>().into());
                }
            }
            Part::Line { line, samples } => {
                let (from, to) = ([line.from.0, line.from.1], [line.to.0, line.to.1]);
                set("shape", json!({"kind": "line", "from_px": from, "to_px": to}));
                if self.has_bands() {
                    set("wavelength_nm", json!(self.channels.iter().filter_map(|c| c.1).collect::<Vec<_>>()));
                } else {
                    set("channels", json!(self.channels.iter().map(|c| &c.0).collect::<Vec<_>>()));
                }
                set("unit", self.channels.first().map(|c| c.2.clone()).into());
                set("samples", samples.iter().map(|s| self.sample(s)).collect::<Vec<_>>().into());
            }
        }
        out
    }

    fn sample(&self, s: &Sample) -> Value {
        // NaN and infinite samples become null.
        let mut out = json!({"x": s.at.0, "y": s.at.1, "distance_px": s.distance_px});
        if let (Some((key, ..)), Some(value)) = (&self.photopic, s.luminance) {
            out[*key] = value.into();
        }
        if let Some(xyz) = s.xyz {
            out["xyz"] = json!(xyz);
        }
        out["values"] = json!(s.channels);
        out
    }

    fn text(&self) -> String {
        let mut out = format!("{}: {}\n", self.path, self.name);
        // Writing to a string does not fail.
        let mut line = |label: &str, value: String| {
            let _ = writeln!(out, "  {label:<22} {value}");
        };
        let (_, name, unit) = self.photopic.clone().unwrap_or_default();
        let show = |v: f64| significant(v, 5);
        match &self.part {
            Part::Shape { shape, probe: p } => {
                let left_out = p.pixels - p.counted;
                let note = if left_out > 0 { format!(", {left_out} of them left out") } else { String::new() };
                line("where", format!("{shape}: {} pixel{}{note}", p.pixels, if p.pixels == 1 { "" } else { "s" }));
                if let Some(solid_angle) = p.solid_angle_sr {
                    line("solid angle", format!("{} sr", show(solid_angle)));
                }
                if let Some(l) = &p.luminance {
                    line(&name, format!("{} {unit}", show(l.mean)));
                    if p.counted > 1 {
                        let at = |(x, y): (usize, usize)| format!("at {x}, {y}");
                        line("minimum", format!("{} {unit} {}", show(l.min), at(l.min_at)));
                        line("maximum", format!("{} {unit} {}", show(l.max), at(l.max_at)));
                        line("standard deviation", format!("{} {unit}", show(l.standard_deviation)));
                        for (percent, value) in self.percentiles.iter().zip(&l.percentiles) {
                            line(&format!("percentile {percent} %"), format!("{} {unit}", show(*value)));
                        }
                        let ratio = |v: Option<f64>| v.map_or_else(|| "–".to_owned(), |v| format!("{v:.4}"));
                        line("uniformity", format!("U0 {} (min/mean), Ud {} (min/max)", ratio(l.u0()), ratio(l.ud())));
                    }
                }
                if let Some(xyz) = p.xyz {
                    line("X, Y, Z", xyz.map(show).join(", "));
                    let xy = chromaticity::xy(xyz).map(|xy| xy.map(|v| format!("{v:.5}")).join(", "));
                    line("x, y", xy.unwrap_or_else(|| "–".to_owned()));
                }
                if !p.channels.is_empty() && self.has_bands() {
                    let peak = (0..p.channels.len()).max_by(|a, b| p.channels[*a].total_cmp(&p.channels[*b]));
                    let peak = peak.unwrap_or(0);
                    let (_, wavelength, unit) = &self.channels[peak];
                    let (at, value) = (wavelength.unwrap_or(f64::NAN), show(p.channels[peak]));
                    let value = format!("{value} {unit}");
                    let bands = p.channels.len();
                    line("spectrum", format!("{bands} bands (--csv, --json), peak {} at {at} nm", value.trim_end()));
                } else {
                    for ((name, _, unit), mean) in self.channels.iter().zip(&p.channels) {
                        line(&format!("channel {name}"), format!("{} {unit}", show(*mean)));
                    }
                }
            }
            Part::Line { line: l, samples } => {
                let ((x0, y0), (x1, y1)) = (l.from, l.to);
                line("where", format!("line from {x0}, {y0} to {x1}, {y1}: {} pixels", samples.len()));
                let heading = format!("{name} [{unit}]");
                let _ = writeln!(out, "  {:>6} {:>6} {:>11}  {heading}", "x", "y", "distance");
                for s in samples {
                    let value = s.luminance.map_or_else(|| "–".to_owned(), show);
                    let _ = writeln!(out, "  {:>6} {:>6} {:>11.2}  {value}", s.at.0, s.at.1, s.distance_px);
                }
            }
        }
        out
    }
}

fn counts(p: &Probe) -> [(&'static str, u64); 5] {
    [("pixels", p.pixels), ("counted", p.counted), ("nan", p.nan), ("infinite", p.infinite), ("negative", p.negative)]
}

fn shape_json(shape: &Shape) -> Value {
    let mut out = json!({"kind": shape.kind()});
    match shape {
        Shape::Pixel(x, y) => out["at_px"] = json!([x, y]),
        Shape::Rectangle(r) => out["rectangle_px"] = json!([r.x, r.y, r.width, r.height]),
        Shape::Polygon(corners) => out["corners_px"] = json!(corners),
        Shape::Circle { centre, radius_px } => {
            out["centre_px"] = json!(centre);
            out["radius_px"] = json!(radius_px);
        }
        Shape::Spot { centre, diameter_deg, .. } => {
            out["centre_px"] = json!(centre);
            out["diameter_deg"] = json!(diameter_deg);
        }
    }
    out
}

fn spread(s: &Spread, percentiles: &[f64]) -> Value {
    let percentiles = percentiles.iter().zip(&s.percentiles).map(|(p, v)| json!({"percent": p, "value": v}));
    json!({
        "mean": s.mean,
        "standard_deviation": s.standard_deviation,
        "min": s.min,
        "min_at_px": s.min_at,
        "max": s.max,
        "max_at_px": s.max_at,
        "percentiles": percentiles.collect::<Vec<_>>(),
        "uniformity_u0": s.u0(),
        "uniformity_ud": s.ud(),
    })
}

/// All parts for people.
#[must_use]
pub fn probe_text(all: &[Probed]) -> String {
    all.iter().map(Probed::text).collect::<Vec<_>>().join("\n")
}

/// All parts as one table.
///
/// # Errors
/// Where there is nothing for the table, or spectra are not of one grid and unit: what to say about it.
pub fn probe_csv(all: &[Probed], table: Table) -> Result<Vec<u8>, String> {
    let line = |p: &&Probed| matches!(p.part, Part::Line { .. });
    let table = match table {
        Table::First if all.iter().any(|p| line(&p)) => Table::Profile,
        Table::First if all.iter().all(Probed::has_bands) => Table::Spectra,
        Table::First => Table::Figures,
        table => table,
    };
    let (lines, shapes): (Vec<_>, Vec<_>) = all.iter().partition(line);
    match table {
        Table::Profile if lines.is_empty() => Err("a table of profiles without lines; expected --line".to_owned()),
        Table::Profile => Ok(rows(&profile_rows(&lines))),
        _ if shapes.is_empty() => Err("a table without shapes; expected --pixel, --rect or another".to_owned()),
        Table::Spectra => spectra_rows(&shapes).map(|r| rows(&r)),
        Table::Figures | Table::First => Ok(rows(&figure_rows(&shapes))),
    }
}

/// A table with its header as CSV.
pub(super) fn rows(rows: &[Vec<String>]) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        // A vector takes every byte, and all rows are alike.
        let _ = writer.write_record(row);
    }
    writer.into_inner().unwrap_or_default()
}

/// A cell; empty where there is no number.
fn cell(value: Option<f64>) -> String {
    value.filter(|v| v.is_finite()).map_or_else(String::new, |v| v.to_string())
}

/// A wavelength column, and one column per shape under `name [unit]`.
fn spectra_rows(shapes: &[&Probed]) -> Result<Vec<Vec<String>>, String> {
    let first = shapes[0];
    if let Some(other) = shapes.iter().find(|s| !s.has_bands()) {
        return Err(format!("{}: found no bands; expected a spectral image, or --csv=figures", other.path));
    }
    let grid = |p: &Probed| p.channels.iter().map(|c| c.1).collect::<Vec<_>>();
    if let Some(other) = shapes.iter().find(|s| grid(s) != grid(first)) {
        let (a, b) = (&first.path, &other.path);
        return Err(format!("{a} and {b} have different bands; expected one table per grid of wavelengths"));
    }
    let several = shapes.iter().any(|s| s.path != first.path);
    let heading = |p: &&Probed| {
        let name = if several { format!("{} {}", p.path, p.name) } else { p.name.clone() };
        let unit = &p.channels[0].2;
        if unit.is_empty() { name } else { format!("{name} [{unit}]") }
    };
    let mut out = vec![std::iter::once("wavelength_nm".to_owned()).chain(shapes.iter().map(heading)).collect()];
    for (i, (_, wavelength, _)) in first.channels.iter().enumerate() {
        let mut row = vec![cell(*wavelength)];
        for shape in shapes {
            let Part::Shape { probe, .. } = &shape.part else { continue };
            row.push(cell(probe.channels.get(i).copied()));
        }
        out.push(row);
    }
    Ok(out)
}

fn figure_rows(shapes: &[&Probed]) -> Vec<Vec<String>> {
    let first = shapes[0];
    let mut header: Vec<String> = ["path", "name", "shape"].map(str::to_owned).to_vec();
    header.extend(["pixels", "counted", "nan", "infinite", "negative", "quantity", "unit"].map(str::to_owned));
    header.extend(["mean", "standard_deviation", "min", "max"].map(str::to_owned));
    header.extend(first.percentiles.iter().map(|p| format!("percentile_{p}")));
    header.extend(["uniformity_u0", "uniformity_ud", "X", "Y", "Z", "x", "y"].map(str::to_owned));
    let mut out = vec![header];
    for shape in shapes {
        let Part::Shape { shape: of, probe: p } = &shape.part else { continue };
        let (_, name, unit) = shape.photopic.clone().unwrap_or_default();
        let mut row = vec![shape.path.clone(), shape.name.clone(), of.kind().to_owned()];
        row.extend(counts(p).map(|(_, count)| count.to_string()));
        row.extend([name, unit]);
        let l = p.luminance.as_ref();
        let figures = [l.map(|l| l.mean), l.map(|l| l.standard_deviation), l.map(|l| l.min), l.map(|l| l.max)];
        row.extend(figures.map(cell));
        row.extend((0..shape.percentiles.len()).map(|i| cell(l.and_then(|l| l.percentiles.get(i).copied()))));
        row.extend([l.and_then(Spread::u0), l.and_then(Spread::ud)].map(cell));
        let xy = p.xyz.and_then(chromaticity::xy);
        row.extend((0..3).map(|k| cell(p.xyz.map(|v| v[k]))));
        row.extend((0..2).map(|k| cell(xy.map(|v| v[k]))));
        out.push(row);
    }
    out
}

fn profile_rows(lines: &[&Probed]) -> Vec<Vec<String>> {
    let first = lines[0];
    let mut header: Vec<String> = ["path", "name", "x", "y", "distance_px"].map(str::to_owned).to_vec();
    header.push(first.photopic.as_ref().map_or("photopic", |p| p.0).to_owned());
    header.extend(["X", "Y", "Z"].map(str::to_owned));
    let mut out = vec![header];
    for line in lines {
        let Part::Line { samples, .. } = &line.part else { continue };
        for s in samples {
            let mut row = vec![line.path.clone(), line.name.clone(), s.at.0.to_string(), s.at.1.to_string()];
            row.push(cell(Some(s.distance_px)));
            row.push(cell(s.luminance));
            row.extend((0..3).map(|k| cell(s.xyz.map(|v| v[k]))));
            out.push(row);
        }
    }
    out
}

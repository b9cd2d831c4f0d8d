//! Compression of BRDF tables as JSON, CSV rows and text.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::brdf::compress::file::{BasisFile, Checksum};
use crate::brdf::compress::{Grid, Score};
use crate::brdf::table::{Channel, Known, Resolution};
use crate::geometry::direction::{phi, theta};
use crate::units::significant;

/// Digits shown for people; JSON and CSV have all.
const DIGITS: usize = 4;
/// Components of which the text tells how much they explain.
const SHOWN: [usize; 7] = [1, 2, 5, 10, 20, 40, 60];

fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}

fn bins_of(r: Resolution) -> [usize; 3] {
    [r.theta_h, r.theta_d, r.phi_d]
}

/// Share of the variance that the first components explain, for each number of them.
fn explained(file: &BasisFile) -> Vec<f64> {
    let mut sum = 0.0;
    let share = |v: &f64| {
        sum += v;
        if file.variance > 0.0 { sum / file.variance } else { 1.0 }
    };
    file.basis.variances().iter().map(share).collect()
}

/// `brdf compress train`, one object.
#[must_use]
pub fn train(file: &BasisFile, checksum: &Checksum) -> Value {
    let mut out = object(json!({
        "basis": checksum.short(),
        "resolution": bins_of(file.grid.resolution()),
        "bins": file.grid.bins().len(),
        "inputs": file.sources.len(),
        "columns": file.columns,
        "components": file.basis.components(),
        "weighted": file.weighted,
        "variance": file.variance,
        "variances": file.basis.variances(),
    }));
    // Weighted variances are not shares of the plain one.
    if !file.weighted {
        out.insert("explained_fraction".to_owned(), explained(file).into());
    }
    out.into()
}

/// The same as rows of a table.
#[must_use]
pub fn train_rows(file: &BasisFile) -> Vec<Vec<String>> {
    let mut out = vec![["component", "variance", "explained_fraction"].map(str::to_owned).to_vec()];
    for (i, (variance, share)) in file.basis.variances().iter().zip(explained(file)).enumerate() {
        let share = if file.weighted { String::new() } else { share.to_string() };
        out.push(vec![(i + 1).to_string(), variance.to_string(), share]);
    }
    out
}

/// The same for people.
#[must_use]
pub fn train_text(path: &str, file: &BasisFile, checksum: &Checksum) -> String {
    let [h, d, p] = bins_of(file.grid.resolution());
    let mut out = format!(
        "{path}: {} components of {} columns from {} inputs\n  basis    {}\n  grid     {h} × {d} × {p} bins, of which {} take part\n",
        file.basis.components(),
        file.columns,
        file.sources.len(),
        checksum.short(),
        file.grid.bins().len()
    );
    if !file.weighted {
        let explained = explained(file);
        for k in SHOWN.into_iter().filter(|k| *k <= explained.len()) {
            // Writing to a string cannot fail.
            let _ = writeln!(
                out,
                "  {k:>2} of them explain {} % of the variance",
                significant(100.0 * explained[k - 1], 5)
            );
        }
    }
    out
}

/// The coefficients of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct Encoded {
    /// What the columns belong to.
    pub channels: Vec<Channel>,
    /// The coefficients of each channel.
    pub coefficients: Vec<Vec<f64>>,
    /// Distance of each channel to what the coefficients give back, where it is known.
    pub rms_ln: Vec<f64>,
}

impl Encoded {
    /// One object.
    #[must_use]
    pub fn json(&self, checksum: &Checksum) -> Map<String, Value> {
        let channels: Vec<String> = self.channels.iter().map(ToString::to_string).collect();
        let mut out =
            object(json!({"basis": checksum.short(), "channels": channels, "coefficients": self.coefficients}));
        if !self.rms_ln.is_empty() {
            out.insert("rms_ln".to_owned(), self.rms_ln.clone().into());
        }
        out
    }

    /// Rows of a table, which `brdf compress decode` reads.
    #[must_use]
    pub fn rows(&self, checksum: &Checksum) -> Vec<Vec<String>> {
        let mut out = vec![["basis", "channel", "component", "coefficient"].map(str::to_owned).to_vec()];
        for (channel, coefficients) in self.channels.iter().zip(&self.coefficients) {
            for (i, c) in coefficients.iter().enumerate() {
                out.push(vec![checksum.short(), channel.to_string(), (i + 1).to_string(), c.to_string()]);
            }
        }
        out
    }

    /// For people.
    #[must_use]
    pub fn text(&self, heading: &str) -> String {
        let count = self.coefficients.first().map_or(0, Vec::len);
        let mut out = format!("{heading}: {count} coefficients per channel\n");
        for (i, channel) in self.channels.iter().enumerate() {
            let rms = self.rms_ln.get(i).map_or(String::new(), |v| format!(", rms of ln {}", significant(*v, DIGITS)));
            let shown: Vec<String> = self.coefficients[i].iter().map(|c| significant(*c, DIGITS)).collect();
            let _ = writeln!(out, "  {channel}{rms}\n    {}", shown.join("  "));
        }
        out
    }
}

/// How many bins of a table are known in which way.
#[must_use]
pub fn known(known: &[Known]) -> Map<String, Value> {
    let count = |k: Known| known.iter().filter(|v| **v == k).count();
    object(json!({
        "measured_bins": count(Known::Measured),
        "inferred_bins": count(Known::Inferred),
        "missing_bins": count(Known::Missing),
    }))
}

/// The same for people, after what was written.
#[must_use]
pub fn known_text(output: &str, counts: &Map<String, Value>) -> String {
    let of = |key: &str| counts.get(key).and_then(Value::as_u64).unwrap_or(0);
    format!(
        "{output}: {} bins measured, {} inferred, {} missing\n",
        of("measured_bins"),
        of("inferred_bins"),
        of("missing_bins")
    )
}

/// θ_i, φ_i, θ_o, φ_o in degrees of the middle of a bin, turned to φ_i = 0.
fn angles_deg(grid: &Grid, bin: usize) -> [f64; 4] {
    let (i, o) = grid.directions(bin);
    let turned = (phi(o) - phi(i)).to_degrees().rem_euclid(360.0);
    [theta(i).to_degrees(), 0.0, theta(o).to_degrees(), turned]
}

/// Columns of `brdf compress directions`; the first four are those of a CSV of points.
const DIRECTIONS: [&str; 6] = ["theta_i_deg", "phi_i_deg", "theta_o_deg", "phi_o_deg", "number", "bin"];

/// Directions to measure, one object.
#[must_use]
pub fn directions(grid: &Grid, chosen: &[usize], checksum: &Checksum) -> Value {
    let row = |(n, bin): (usize, &usize)| {
        let angles = angles_deg(grid, *bin).map(Value::from);
        let numbers = [Value::from(n + 1), Value::from(grid.bins()[*bin])];
        let cells = angles.into_iter().chain(numbers);
        Value::Object(DIRECTIONS.iter().map(|c| (*c).to_owned()).zip(cells).collect())
    };
    json!({"basis": checksum.short(), "rows": chosen.iter().enumerate().map(row).collect::<Vec<_>>()})
}

/// The same as rows of a table.
#[must_use]
pub fn directions_rows(grid: &Grid, chosen: &[usize]) -> Vec<Vec<String>> {
    let mut out = vec![DIRECTIONS.map(str::to_owned).to_vec()];
    for (n, bin) in chosen.iter().enumerate() {
        let mut row: Vec<String> = angles_deg(grid, *bin).map(|a| a.to_string()).to_vec();
        row.extend([(n + 1).to_string(), grid.bins()[*bin].to_string()]);
        out.push(row);
    }
    out
}

/// The same for people.
#[must_use]
pub fn directions_text(grid: &Grid, chosen: &[usize]) -> String {
    let mut out = "  no.   θi [°]   θo [°]   φo − φi [°]\n".to_owned();
    for (n, bin) in chosen.iter().enumerate() {
        let [ti, _, to, turned] = angles_deg(grid, *bin);
        let _ = writeln!(out, "  {:>3} {ti:>8.3} {to:>8.3} {turned:>13.3}", n + 1);
    }
    out
}

/// The value below which a share of the numbers lies, linear between them.
fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the numbers")]
    let below = place as usize;
    let above = (below + 1).min(last);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

/// Median and 90th percentile from components, then from samples.
#[must_use]
pub fn figures(score: &Score) -> [f64; 4] {
    let of = |v: &[f64]| [quantile(v, 0.5), quantile(v, 0.9)];
    let ([a, b], [c, d]) = (of(&score.from_components), of(&score.from_samples));
    [a, b, c, d]
}

const ERROR: [&str; 5] =
    ["count", "components_median_rms_ln", "components_p90_rms_ln", "samples_median_rms_ln", "samples_p90_rms_ln"];

/// `brdf compress error`, one object.
#[must_use]
pub fn error(scores: &[Score]) -> Value {
    let row = |s: &Score| {
        let cells = std::iter::once(Value::from(s.count)).chain(figures(s).map(Value::from));
        Value::Object(ERROR.iter().map(|c| (*c).to_owned()).zip(cells).collect())
    };
    let columns = scores.first().map_or(0, |s| s.from_components.len());
    json!({"columns": columns, "rows": scores.iter().map(row).collect::<Vec<_>>()})
}

/// The same as rows of a table.
#[must_use]
pub fn error_rows(scores: &[Score]) -> Vec<Vec<String>> {
    let mut out = vec![ERROR.map(str::to_owned).to_vec()];
    for s in scores {
        out.push(std::iter::once(s.count.to_string()).chain(figures(s).map(|v| v.to_string())).collect());
    }
    out
}

/// The same for people.
#[must_use]
pub fn error_text(scores: &[Score]) -> String {
    let columns = scores.first().map_or(0, |s| s.from_components.len());
    let mut out = format!(
        "rms of ln of {columns} columns held out in turn: median, and 90 % are below\n  number   from components     from directions\n"
    );
    for s in scores {
        let [a, b, c, d] = figures(s).map(|v| significant(v, DIGITS));
        let _ = writeln!(out, "  {:>6}   {a:>7}  {b:>7}    {c:>7}  {d:>7}", s.count);
    }
    out
}

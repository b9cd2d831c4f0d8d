//! `correct`: the record of what was done, as JSON and as the header of the corrected file; and the file itself.

use std::fmt::Write;

use nalgebra::DMatrix;
use serde_json::{Map, Value, json};

use super::envelope::Input;
use crate::correction::{Corrected, Step, lines::Line, wavelength::Calibration};
use crate::spectrum::Quantity;

/// A corrected spectrum and where it is from.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// The file.
    pub path: String,
    /// The spectrum's name in it.
    pub name: String,
    /// What it is of.
    pub quantity: Quantity,
    /// What was made of it.
    pub corrected: Corrected,
}

fn lines(all: &[Line]) -> Vec<Value> {
    let one = |l: &Line| json!({"element": l.element.map(|e| e.symbol()), "wavelength_nm": l.wavelength_nm});
    all.iter().map(one).collect()
}

fn calibration(c: &Calibration) -> Value {
    let matches: Vec<Value> = c
        .matches
        .iter()
        .map(|m| {
            json!({
                "element": m.line.element.map(|e| e.symbol()),
                "wavelength_nm": m.line.wavelength_nm,
                "position": m.position,
                "fwhm": m.fwhm,
                "residual_nm": m.residual_nm,
            })
        })
        .collect();
    json!({
        "step": "wavelength",
        "coefficients": c.coefficients,
        "standard_errors": c.standard_errors,
        "residual_nm": c.residual_nm,
        "left_out_nm": c.left_out_nm,
        "lines": matches,
        "unused": lines(&c.unused),
    })
}

/// A step as an object.
fn step(s: &Step) -> Value {
    match s {
        Step::Noise(n) => json!({"step": "noise", "read": n.read, "per_unit": n.per_unit, "relative": n.relative}),
        Step::Dark { mean } => json!({"step": "dark", "mean": mean}),
        Step::IntegrationTime(t) => {
            json!({"step": "integration_time", "time_s": t.time_s, "standard_s": t.standard_s})
        }
        Step::StrayLight { largest, relative } => {
            json!({"step": "stray_light", "largest_of_peak": largest, "relative": relative})
        }
        Step::Wavelength(c) => calibration(c),
        Step::Differences { fwhm_nm, coefficient } => {
            json!({"step": "bandpass", "method": "stearns", "fwhm_nm": fwhm_nm, "coefficient": coefficient})
        }
        Step::RichardsonLucy(d) => json!({
            "step": "bandpass",
            "method": "richardson-lucy",
            "fwhm_nm": d.fwhm_nm,
            "iterations": d.iterations,
            "residual_of_peak": d.residual,
            "within_noise": d.within_noise,
        }),
        Step::Smoothing(s) => json!({"step": "smoothing", "window": s.window, "degree": s.degree}),
        Step::Resampling { step_nm, range_nm, interpolation } => json!({
            "step": "resampling",
            "step_nm": step_nm,
            "range_nm": range_nm,
            "interpolation": interpolation.word(),
        }),
    }
}

/// A step in words.
#[must_use]
pub fn words(s: &Step) -> String {
    match s {
        Step::Noise(n) => format!("noise of the samples: u² = {}² + {} S + ({} S)²", n.read, n.per_unit, n.relative),
        Step::Dark { mean } => format!("dark signal subtracted, {mean:.6} on average"),
        Step::IntegrationTime(t) => format!("divided by {} s (u {} s)", t.time_s, t.standard_s),
        Step::StrayLight { largest, relative } => format!(
            "stray light taken out by matrix (Zong 2006), up to {:.3e} of the peak (relative u {relative})",
            largest
        ),
        Step::Wavelength(c) => {
            let polynomial: Vec<String> =
                c.coefficients.iter().zip(&c.standard_errors).map(|(v, u)| format!("{v:.9e} (u {u:.1e})")).collect();
            format!(
                "wavelengths from {} lines, standard deviation {:.4} nm, left out one by one {:.4} nm; polynomial {}",
                c.matches.len(),
                c.residual_nm,
                c.left_out_nm,
                polynomial.join(", ")
            )
        }
        Step::Differences { fwhm_nm, coefficient } => {
            format!(
                "bandwidth of {fwhm_nm} nm corrected by differences (Stearns and Stearns 1988), coefficient {coefficient:.6}"
            )
        }
        Step::RichardsonLucy(d) => {
            let end = match d.within_noise {
                Some(true) => "within the noise",
                Some(false) => "above the noise",
                None => "noise not known",
            };
            format!(
                "bandwidth of {} nm corrected by {} Richardson-Lucy iterations, residual {:.2e} of the peak, {end}",
                d.fwhm_nm, d.iterations, d.residual
            )
        }
        Step::Smoothing(s) => format!("smoothed by Savitzky-Golay, {} samples, degree {}", s.window, s.degree),
        Step::Resampling { step_nm, range_nm, interpolation } => {
            format!("resampled to {}–{} nm by {step_nm} nm, {}", range_nm.0, range_nm.1, interpolation.word())
        }
    }
}

/// The object of a spectrum in `results[]`.
#[must_use]
pub fn json(n: &Named) -> Value {
    let c = &n.corrected;
    let mut out = Map::new();
    out.insert("path".into(), n.path.clone().into());
    out.insert("name".into(), n.name.clone().into());
    out.insert("quantity".into(), n.quantity.word().into());
    out.insert("steps".into(), c.steps.iter().map(step).collect::<Vec<_>>().into());
    out.insert("wavelength_nm".into(), json!(c.spectrum.wavelengths_nm()));
    out.insert("value".into(), json!(c.spectrum.values()));
    if let Some(standard) = &c.standard {
        out.insert("standard_uncertainty".into(), json!(standard));
        out.insert("correlation_factor".into(), json!(c.correlation_factor()));
    }
    Value::Object(out)
}

/// The heading of a column and of its uncertainty, which a reader of spectra understands.
fn headings(n: &Named, several: bool) -> [String; 2] {
    let unit = match n.quantity {
        Quantity::Relative => "a.u.",
        Quantity::Flux => "W/nm",
        Quantity::Intensity => "W/sr/nm",
        Quantity::Irradiance | Quantity::Exitance => "W/m2/nm",
        Quantity::Radiance => "W/m2/sr/nm",
        Quantity::Energy => "J/nm",
        Quantity::Exposure => "J/m2/nm",
    };
    let what = match n.quantity {
        Quantity::Relative => "relative".to_owned(),
        Quantity::Intensity | Quantity::Energy | Quantity::Exposure => format!("radiant {}", n.quantity),
        other => format!("spectral {other}"),
    };
    // Separators and quotes of CSV do not go into a heading.
    let name: String = n.name.chars().filter(|c| !matches!(c, ',' | '"' | '[' | ']' | '\n')).collect();
    let stem = if several && !name.is_empty() { format!("{name} {what}") } else { what };
    [format!("{stem} [{unit}]"), format!("u({stem}) [{unit}]")]
}

/// The corrected spectra as one table, which have the same wavelengths; the record stands above as comments.
#[must_use]
pub fn csv(all: &[Named], inputs: &[Input], title: Option<&str>) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "# photopic {} correct{}",
        env!("CARGO_PKG_VERSION"),
        title.map_or(String::new(), |t| format!(": {t}"))
    );
    for input in inputs {
        let sum = input.sha256.as_ref().map_or(String::new(), |s| format!(" sha256 {s}"));
        let _ = writeln!(out, "# input {}{sum}", input.path);
    }
    for n in all {
        if all.len() > 1 {
            let _ = writeln!(out, "# {} [{}]", n.path, n.name);
        }
        for (i, step) in n.corrected.steps.iter().enumerate() {
            let _ = writeln!(out, "# {}. {}", i + 1, words(step));
            if let Step::Wavelength(c) = step {
                for m in &c.matches {
                    let element = m.line.element.map_or("line", |e| e.symbol());
                    let _ = writeln!(
                        out,
                        "#    {element} {} nm at {:.4}: {:+.4} nm, width {:.3}",
                        m.line.wavelength_nm, m.position, m.residual_nm, m.fwhm
                    );
                }
                for l in &c.unused {
                    let _ = writeln!(
                        out,
                        "#    {} {} nm not used",
                        l.element.map_or("line", |e| e.symbol()),
                        l.wavelength_nm
                    );
                }
            }
        }
    }
    let mut header = vec!["wavelength [nm]".to_owned()];
    for n in all {
        let [value, u] = headings(n, all.len() > 1);
        header.push(value);
        header.extend(n.corrected.standard.as_ref().map(|_| u));
    }
    let _ = writeln!(out, "{}", header.join(","));
    let Some(first) = all.first() else { return out };
    for (i, w) in first.corrected.spectrum.wavelengths_nm().iter().enumerate() {
        let _ = write!(out, "{w}");
        for n in all {
            let _ = write!(out, ",{}", n.corrected.spectrum.values()[i]);
            if let Some(u) = &n.corrected.standard {
                let _ = write!(out, ",{}", u[i]);
            }
        }
        out.push('\n');
    }
    out
}

/// A covariance as a budget takes it: wavelengths in the first row and in the first column.
#[must_use]
pub fn covariance(wavelengths_nm: &[f64], matrix: &DMatrix<f64>) -> String {
    let mut out = "wavelength_nm".to_owned();
    // Writing to a string cannot fail.
    for w in wavelengths_nm {
        let _ = write!(out, ",{w}");
    }
    out.push('\n');
    for (w, row) in wavelengths_nm.iter().zip(matrix.row_iter()) {
        let _ = write!(out, "{w}");
        for v in row.iter() {
            let _ = write!(out, ",{v:e}");
        }
        out.push('\n');
    }
    out
}

//! From words and options to a plan: the files that they name are read here.

use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::{Asked, Interpolation as InterpolationArg, Method as MethodArg};
use crate::cli::Failure;
use crate::cli::convert::single;
use crate::constants::SecondRadiation;
use crate::correction::bandpass::{Bandpass, LineSpread};
use crate::correction::description::{self as words, Description, Interpolation, Method};
use crate::correction::lines::{self, Line};
use crate::correction::stray_light::StrayLight;
use crate::correction::wavelength::LineLamp;
use crate::correction::{Dark, IntegrationTime, Noise, Plan, Resampling, SecondOrder, Smoothing};
use crate::finding::Finding;
use crate::mistake::Mistake;
use crate::report::envelope::Input;
use crate::spectrum::format::Measured;
use crate::spectrum::{Quantity, resample};
use crate::uncertainty::budget::{NotNegative, Positive};

/// Reads a description of corrections.
pub(super) fn read(path: &Path) -> Result<Description, Failure> {
    let place = path.display();
    let text = fs::read_to_string(path)
        .map_err(|e| Failure::Message(format!("{place}: cannot be read: {e}; expected corrections (TOML)")))?;
    Description::parse(&text).map_err(|m| Failure::Message(format!("{place}:{m}")))
}

/// Files that corrections name, relative to the description.
pub(super) struct Loader {
    folder: PathBuf,
    pub(super) inputs: Vec<Input>,
    pub(super) findings: Vec<Finding>,
    /// What the dark spectrum is of: subtracted it can only be from the same.
    pub(super) dark: Option<Quantity>,
}

impl Loader {
    pub(super) fn new(folder: PathBuf) -> Self {
        Self { folder, inputs: Vec::new(), findings: Vec::new(), dark: None }
    }

    /// A path as written in the description; one of the command line is relative to where it was typed.
    fn place(&self, file: &str, in_description: bool) -> String {
        if in_description { self.folder.join(file).display().to_string() } else { file.to_owned() }
    }

    fn spectrum(&mut self, path: &str, quantity: Option<Quantity>) -> Result<Measured, Failure> {
        let read = single(path, None, quantity, SecondRadiation::default());
        let found = read.map_err(|refused| Failure::Message(refused.message))?;
        self.inputs.push(found.input);
        // That values of a dark spectrum are below zero, or relative, is as it should be.
        self.findings.extend(found.findings.into_iter().filter(|f| !["S005", "S010", "S013"].contains(&f.code)));
        Ok(found.measured)
    }

    fn text<T>(&mut self, path: &str, parse: impl Fn(&str) -> Result<T, Mistake>) -> Result<T, Failure> {
        let bytes = fs::read(path).map_err(|e| {
            Failure::Message(format!("{path}: cannot be read: {e}; expected the file that the corrections name"))
        })?;
        let sha256 = Sha256::digest(&bytes).iter().map(|b| format!("{b:02x}")).collect();
        self.inputs.push(Input { path: path.to_owned(), sha256: Some(sha256) });
        parse(&String::from_utf8_lossy(&bytes)).map_err(|m| Failure::Message(format!("{path}:{m}")))
    }
}

/// The plan of a description, with what the command line asks for in place of the sections of the same subject.
///
/// `quantity` is what the user says that the spectra, and the dark one with them, are of.
pub(super) fn build(
    described: &Description,
    asked: &Asked,
    quantity: Option<Quantity>,
    files: &mut Loader,
) -> Result<Plan, Failure> {
    let dark = match (&asked.dark, &described.dark) {
        (Some(file), _) => Some((files.place(file, false), None)),
        (None, Some(d)) => Some((files.place(&d.file, true), d.time_s)),
        (None, None) => None,
    };
    let dark = match dark {
        None => None,
        Some((path, time)) => {
            let found = files.spectrum(&path, quantity)?;
            files.dark = Some(found.quantity);
            Some(Dark { spectrum: found.spectrum, standard: found.standard, time_s: time.map(|t| t.0) })
        }
    };
    let time =
        asked.integration_time.map(|t| words::IntegrationTime { time_s: Positive(t), standard_s: NotNegative(0.0) });
    let order = asked.order_filter.or(described.second_order.map(|s| s.filter_from_nm.0));
    let smoothing = asked.smooth.or(described.smoothing.map(|s| (s.window, s.degree)));
    Ok(Plan {
        noise: described.noise.map(|n| Noise { read: n.read.0, per_unit: n.per_unit.0, relative: n.relative.0 }),
        dark,
        integration_time: time
            .or(described.integration_time)
            .map(|t| IntegrationTime { time_s: t.time_s.0, standard_s: t.standard_s.0 }),
        stray_light: stray_light(described, asked, files)?,
        wavelength: wavelength(described, asked, files)?,
        bandpass: bandpass(described, asked, files)?,
        smoothing: smoothing.map(|(window, degree)| Smoothing { window, degree }),
        resampling: resampling(described, asked),
        second_order: SecondOrder { filter_from_nm: order },
    })
}

fn stray_light(described: &Description, asked: &Asked, files: &mut Loader) -> Result<Option<StrayLight>, Failure> {
    if let Some(file) = &asked.stray_light {
        return files.text(file, |t| StrayLight::parse_matrix(t, 0.0)).map(Some);
    }
    let Some(s) = &described.stray_light else { return Ok(None) };
    let relative = s.relative.0;
    match (&s.matrix, &s.line_spreads, s.in_band_nm) {
        (Some(file), ..) => {
            let path = files.place(file, true);
            files.text(&path, |t| StrayLight::parse_matrix(t, relative)).map(Some)
        }
        (None, Some(file), Some(band)) => {
            let path = files.place(file, true);
            files.text(&path, |t| StrayLight::parse_spreads(t, band.0, relative)).map(Some)
        }
        // A description that was parsed has one of both.
        _ => Ok(None),
    }
}

fn wavelength(described: &Description, asked: &Asked, files: &mut Loader) -> Result<Option<LineLamp>, Failure> {
    let (path, w) = match (&asked.line_lamp, &described.wavelength) {
        (Some(file), _) => {
            let mut w = words::Wavelength::of(file.clone(), asked.element.clone());
            w.degree = asked.degree.map_or(w.degree, usize::from);
            (files.place(file, false), w)
        }
        (None, Some(w)) => (files.place(&w.lamp, true), w.clone()),
        (None, None) => return Ok(None),
    };
    let mut known = lines::of(&w.elements);
    known.extend(w.lines_nm.iter().map(|l| Line { element: None, wavelength_nm: l.0 }));
    known.sort_by(|a, b| a.wavelength_nm.total_cmp(&b.wavelength_nm));
    Ok(Some(LineLamp {
        reading: files.spectrum(&path, Some(Quantity::Relative))?.spectrum,
        lines: known,
        degree: w.degree,
        search_nm: w.search_nm.0,
        threshold: w.threshold.0,
        start: w.start,
    }))
}

fn bandpass(described: &Description, asked: &Asked, files: &mut Loader) -> Result<Option<Bandpass>, Failure> {
    let iterations = described.bandpass.as_ref().map_or(words::ITERATIONS, |b| b.iterations);
    if let Some(fwhm) = asked.fwhm {
        return Ok(Some(match asked.method {
            Some(MethodArg::RichardsonLucy) => {
                Bandpass::RichardsonLucy { spread: LineSpread::triangle(fwhm), iterations }
            }
            Some(MethodArg::Stearns) | None => Bandpass::stearns(fwhm),
        }));
    }
    let Some(b) = &described.bandpass else { return Ok(None) };
    let spread = match &b.line_spread {
        None => None,
        Some(file) => {
            let path = files.place(file, true);
            Some(files.text(&path, LineSpread::parse)?)
        }
    };
    Ok(match (b.method, b.fwhm_nm, spread) {
        (Method::Stearns, Some(fwhm), _) => Some(Bandpass::Differences {
            fwhm_nm: fwhm.0,
            standard_nm: b.standard_nm.0,
            coefficient: b.coefficient.map(|c| c.0),
        }),
        (Method::RichardsonLucy, _, Some(spread)) => Some(Bandpass::RichardsonLucy { spread, iterations }),
        (Method::RichardsonLucy, Some(fwhm), None) => {
            Some(Bandpass::RichardsonLucy { spread: LineSpread::triangle(fwhm.0), iterations })
        }
        // A description that was parsed has a width or a function that suits the method.
        _ => None,
    })
}

fn resampling(described: &Description, asked: &Asked) -> Option<Resampling> {
    let interpolation = match asked.interpolation {
        Some(InterpolationArg::Linear) => Some(Interpolation::Linear),
        Some(InterpolationArg::Sprague) => Some(Interpolation::Sprague),
        Some(InterpolationArg::Cubic) => Some(Interpolation::Cubic),
        None => None,
    };
    let section = described.resampling;
    let (step_nm, range_nm, chosen) = match (asked.resample, section) {
        (Some(step), _) => (step, asked.range, interpolation.unwrap_or_default()),
        (None, Some(r)) => (r.step_nm.0, r.range_nm.map(|[low, high]| (low.0, high.0)), r.interpolation),
        (None, None) => return None,
    };
    let interpolation = match chosen {
        Interpolation::Linear => resample::Interpolation::Linear,
        Interpolation::Sprague => resample::Interpolation::Sprague,
        Interpolation::Cubic => resample::Interpolation::Cubic,
    };
    Some(Resampling { step_nm, range_nm, interpolation })
}

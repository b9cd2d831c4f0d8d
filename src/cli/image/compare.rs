//! `image compare`.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde_json::json;

use super::convert::MeaningArgs;
use super::open::Reading;
use super::save::{Options, format_of, save};
use super::seen::{Look, Seen, settings_json};
use crate::cli::convert::positive;
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::colorimetry::chromaticity::xyz_of_xy;
use crate::colorimetry::rgb::SRGB;
use crate::finding::{Finding, Location};
use crate::image::compare::{Map, Show, differences, matched, summary};
use crate::image::format::envi::Interleave;
use crate::image::format::exr::Depth;
use crate::image::format::picture::Bits;
use crate::image::{Channel, Meaning, Source};
use crate::report::envelope::Envelope;
use crate::report::image::{Compared, Comparison, DeltaE, PERCENTILES, photopic_name};

/// Arguments of `image compare`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
The first image is the reference, a; the second is b. Per plane: the root of the mean (b - a)^2, the same over the root of the \
mean a^2, the mean of |b - a|/|a|, the PSNR with the largest a as its peak, and the largest |b - a| with its pixel. Bands are \
matched by wavelength (within 0.001 nm), other planes by name.

Examples:
  photopic image compare reference.exr render.exr --tolerance 0.01
  photopic image compare reference.exr render.exr --metric delta-e-p95 --tolerance 1 --map difference.exr
  photopic image compare cube.hdr cube.exr --metric bands-relative-rmse --tolerance 1e-6 --json")]
pub(in crate::cli) struct CompareArgs {
    /// The reference.
    a: String,
    /// The image compared with it.
    b: String,
    /// Exit with 1 where the metric is beyond this (below it for PSNR).
    #[arg(long, value_name = "NUMBER", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// What the tolerance is about; by default the relative RMSE of the luminance, or of the worst band where there is none.
    #[arg(long, value_enum)]
    metric: Option<Metric>,
    /// Write the difference of every pixel as an image: .exr, .npy or .hdr (ENVI).
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// What the map shows.
    #[arg(long, value_enum, default_value = "delta-e", requires = "map")]
    map_of: MapOf,
    /// Y of the white of CIELAB, in the unit of the luminance; by default the largest luminance of the reference. Its
    /// chromaticity is that of D65.
    #[arg(long, value_name = "Y", value_parser = positive)]
    lab_white: Option<f64>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    meaning: MeaningArgs,
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One row per plane.
    #[arg(long)]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

fn tolerance(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|v| *v >= 0.0 && v.is_finite());
    number.ok_or_else(|| format!("`{text}`; expected a number of 0 or more"))
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Metric {
    /// Of the luminance: the root of Σ(b − a)²/Σa².
    RelativeRmse,
    /// Of the luminance, in its unit.
    Rmse,
    /// Of the luminance: the mean of |b − a|/|a|.
    MeanRelative,
    /// Of the luminance: the largest |b − a|/|a|.
    MaxRelative,
    /// Of the luminance, dB.
    Psnr,
    /// The relative RMSE of the worst band or plane.
    BandsRelativeRmse,
    /// Mean ΔE2000.
    DeltaEMean,
    /// 95th percentile of ΔE2000.
    #[value(name = "delta-e-p95")]
    DeltaEP95,
    /// Largest ΔE2000.
    DeltaEMax,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MapOf {
    /// CIEDE2000.
    DeltaE,
    /// (b − a)/a of the luminance.
    Relative,
}

impl Metric {
    fn name(self) -> &'static str {
        match self {
            Self::RelativeRmse => "relative-rmse",
            Self::Rmse => "rmse",
            Self::MeanRelative => "mean-relative",
            Self::MaxRelative => "max-relative",
            Self::Psnr => "psnr",
            Self::BandsRelativeRmse => "bands-relative-rmse",
            Self::DeltaEMean => "delta-e-mean",
            Self::DeltaEP95 => "delta-e-p95",
            Self::DeltaEMax => "delta-e-max",
        }
    }

    /// Its value; `None` where the images do not have what it is about.
    fn of(self, found: &Found) -> Option<f64> {
        let luminance = found.luminance.as_ref().map(|l| &l.difference);
        let colour = found.delta_e.as_ref().map(|d| &d.summary);
        let largest = |l: Option<(f64, [usize; 2])>| l.map_or(0.0, |(v, _)| v);
        match self {
            Self::RelativeRmse => luminance.map(|d| d.relative_rmse()),
            Self::Rmse => luminance.map(|d| d.rmse()),
            Self::MeanRelative => luminance.map(|d| d.mean_relative()),
            Self::MaxRelative => luminance.map(|d| largest(d.largest_relative)),
            Self::Psnr => luminance.map(|d| d.psnr_db()),
            Self::BandsRelativeRmse => found
                .planes
                .iter()
                .map(|p| p.difference.relative_rmse())
                .reduce(|a, b| if b > a || b.is_nan() { b } else { a }),
            Self::DeltaEMean => colour.map(|s| s.mean),
            Self::DeltaEP95 => colour.map(|s| s.quantiles[1]),
            Self::DeltaEMax => colour.map(|s| largest(s.largest)),
        }
    }

    fn passes(self, value: f64, tolerance: f64) -> bool {
        if self == Self::Psnr { value >= tolerance } else { value <= tolerance }
    }
}

/// What two images have in common.
struct Found {
    planes: Vec<Compared>,
    luminance: Option<Compared>,
    delta_e: Option<DeltaE>,
    /// How a map shows it, with the white of CIELAB.
    show: Option<Show>,
}

fn failed(error: crate::image::Error) -> Failure {
    Failure::Message(error.to_string())
}

/// Planes with a counterpart of the same unit and, for colours, of the same space.
fn planes(a: &mut Seen, b: &mut Seen, findings: &mut Vec<Finding>) -> Result<Vec<Compared>, Failure> {
    let (left, right) = (a.image().clone(), b.image().clone());
    let (pairs, alone) = matched(&left, &right);
    let unlike = |i: usize, j: usize| {
        let (p, q) = (&left.channels[i], &right.channels[j]);
        p.unit != q.unit || (matches!(p.meaning, Meaning::Primary(_)) && left.rgb != right.rgb)
    };
    let (out, pairs): (Vec<_>, Vec<_>) = pairs.into_iter().partition(|(i, j)| unlike(*i, *j));
    let list = |names: &[String]| match names {
        [first, .., last] if names.len() > 4 => format!("{first} to {last} ({} planes)", names.len()),
        _ => names.join(", "),
    };
    if !alone.is_empty() {
        let message = format!("planes of only one of the images were not compared: {}", list(&alone));
        findings.push(Finding::warning("I051", message));
    }
    if !out.is_empty() {
        let names: Vec<String> = out.iter().map(|(i, _)| left.channels[*i].name.clone()).collect();
        let message = format!("planes of different units or colour spaces were not compared: {}", list(&names));
        findings.push(Finding::warning("I052", message));
    }
    if pairs.is_empty() {
        return Ok(Vec::new());
    }
    let differences = differences(&mut a.source, &mut b.source, &pairs).map_err(failed)?;
    let channels = pairs.iter().map(|(i, _)| left.channels[*i].clone());
    Ok(channels.zip(differences).map(|(channel, difference)| Compared { channel, difference }).collect())
}

fn found(arguments: &CompareArgs, a: &mut Seen, b: &mut Seen, findings: &mut Vec<Finding>) -> Result<Found, Failure> {
    let planes = planes(a, b, findings)?;
    let (y, xyz) = ((a.luminance.clone(), b.luminance.clone()), (a.xyz.clone(), b.xyz.clone()));
    let mut luminance = None;
    match y {
        (Some(of_a), Some(of_b)) if of_a.unit() == of_b.unit() => {
            let (mut a, mut b) = (of_a.of(&mut a.source), of_b.of(&mut b.source));
            let difference = differences(&mut *a, &mut *b, &[(0, 0)]).map_err(failed)?[0];
            let name = photopic_name(&of_a);
            luminance = Some(Compared { channel: Channel::new(name, of_a.unit(), Meaning::Photopic), difference });
        }
        (Some(of_a), Some(of_b)) => {
            let unit = |u: &str| if u.is_empty() { "relative".to_owned() } else { u.to_owned() };
            let message =
                format!("luminance and colour were not compared: {} and {}", unit(of_a.unit()), unit(of_b.unit()));
            findings.push(Finding::warning("I053", message));
        }
        (None, _) | (_, None) => {
            for seen in [&*a, &*b] {
                if let Some(why) = &seen.without {
                    let message = format!("no luminance: {why}");
                    findings.push(Finding::warning("I053", message).at(Location::default().in_file(&seen.path)));
                }
            }
        }
    }
    let (mut delta_e, mut show) = (None, None);
    if let (Some(of_luminance), (Some(of_a), Some(of_b))) = (&luminance, &xyz)
        && let Some(y) = arguments.lab_white.or_else(|| Some(of_luminance.difference.peak).filter(|p| *p > 0.0))
        && let Some(white) = xyz_of_xy(SRGB.white)
    {
        let colours = Show::DeltaE { white: white.map(|v| v * y) };
        let mut map = Map::new(of_a.of(&mut a.source), of_b.of(&mut b.source), colours);
        let summary = summary(&mut map, &PERCENTILES.map(|p| p / 100.0)).map_err(failed)?;
        (delta_e, show) = (Some(DeltaE { white: (y, SRGB.white), summary }), Some(colours));
    }
    let left_out = planes.iter().chain(&luminance).map(|p| p.difference.left_out).max().unwrap_or(0);
    if left_out > 0 {
        let message = format!("{left_out} pixels with samples that are NaN or infinite in either image were left out");
        findings.push(Finding::warning("I050", message));
    }
    Ok(Found { planes, luminance, delta_e, show })
}

fn write_map(
    arguments: &CompareArgs,
    path: &Path,
    a: &mut Seen,
    b: &mut Seen,
    found: &Found,
) -> Result<Vec<Finding>, Failure> {
    let options =
        Options { format: format_of(path, None)?, depth: Depth::Float, interleave: Interleave::Bil, bits: Bits::Eight };
    let missing = |what: &str| {
        Failure::Message(format!("{}: the images have no {what} in common to draw a map of", path.display()))
    };
    let (left, right, show) = match (arguments.map_of, found.show) {
        (MapOf::DeltaE, Some(show)) => (a.xyz.clone(), b.xyz.clone(), show),
        (MapOf::DeltaE, None) => return Err(missing("colour")),
        (MapOf::Relative, _) if found.luminance.is_none() => return Err(missing("luminance")),
        (MapOf::Relative, _) => (a.luminance.clone(), b.luminance.clone(), Show::Relative),
    };
    let (Some(left), Some(right)) = (left, right) else { return Err(missing("colour")) };
    let inputs = [arguments.a.clone(), arguments.b.clone()];
    let mut map = Map::new(left.of(&mut a.source), right.of(&mut b.source), show);
    let findings = save(path, &inputs, &mut map as &mut dyn Source, options)?;
    // What was noticed in the images' own pixels is told once, with them.
    Ok(findings.into_iter().filter(|f| f.code.starts_with("I02")).collect())
}

pub(super) fn run(arguments: &CompareArgs, talk: Talk) -> Result<(), Failure> {
    let inputs = [arguments.a.clone(), arguments.b.clone()];
    let mut sink = Sink::open(arguments.output.as_deref(), &inputs)?;
    let notes = Notes::new(&inputs, talk);
    let settings = arguments.meaning.settings()?;
    let mut described = settings_json(&arguments.meaning, &settings);
    described["tolerance"] = json!(arguments.tolerance);
    let mut envelope = Envelope::begin(Vec::new(), "image compare", &described)?;
    let how = Look {
        reading: &arguments.reading,
        meaning: &arguments.meaning,
        settings: &settings,
        checksums: arguments.json,
    };
    let [mut a, mut b] = [
        Seen::open(std::slice::from_ref(&arguments.a), &how, &notes)?,
        Seen::open(std::slice::from_ref(&arguments.b), &how, &notes)?,
    ];
    let size = |seen: &Seen| (seen.image().width, seen.image().height);
    if size(&a) != size(&b) {
        let (of_a, of_b) = (size(&a), size(&b));
        let message = format!(
            "{}: found {} × {} pixels; expected {} × {} as in {}",
            b.path, of_b.0, of_b.1, of_a.0, of_a.1, a.path
        );
        return Err(Failure::Message(message));
    }
    let mut findings = Vec::new();
    let found = found(arguments, &mut a, &mut b, &mut findings)?;
    if found.planes.is_empty() && found.luminance.is_none() {
        let message = format!(
            "{} and {} have no plane in common, and no luminance; expected images of the same kind",
            a.path, b.path
        );
        return Err(Failure::Message(message));
    }
    let usual = if found.luminance.is_some() { Metric::RelativeRmse } else { Metric::BandsRelativeRmse };
    let metric = arguments.metric.unwrap_or(usual);
    let value = metric.of(&found).ok_or_else(|| {
        Failure::Message(format!("--metric {}: the images do not have what it is about", metric.name()))
    })?;
    let passes = arguments.tolerance.is_none_or(|t| metric.passes(value, t));
    if let Some(path) = &arguments.map {
        findings.extend(write_map(arguments, path, &mut a, &mut b, &found)?);
    }
    notes.progress.finish_and_clear();
    let noticed = [a.noticed(), b.noticed(), findings].concat();
    notes.print(&noticed);
    let comparison = Comparison {
        paths: [a.path.clone(), b.path.clone()],
        size: size(&a),
        planes: found.planes,
        luminance: found.luminance,
        delta_e: found.delta_e,
        verdict: (metric.name(), value, arguments.tolerance, passes),
    };
    [a.inputs, b.inputs].concat().into_iter().for_each(|i| envelope.input(i));
    noticed.into_iter().for_each(|f| envelope.finding(f));
    envelope.result(&comparison.json())?;
    let document = envelope.end()?;
    match (arguments.json, arguments.csv) {
        (true, _) => sink.write_all(&document)?,
        (_, true) => sink.write_all(&comparison.csv())?,
        _ => sink.write_all(comparison.text().as_bytes())?,
    }
    sink.finish(true)?;
    if passes { Ok(()) } else { Err(Failure::No) }
}
